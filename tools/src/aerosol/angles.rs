//! The angles of the tables, and the rule by which phase functions are normalised.

use tables::views::integral;

/// Runs of angles: up to this angle in degrees, by this step. Dense ahead, where coarse particles scatter as a power of
/// the angle, and towards 180 degrees, for the glory; within a degree they need not be finer than what the sun's disc
/// smooths. `study aerosol-tables` has the cost in radiance. Each run has an even number of steps.
const RUNS: [(f64, f64); 13] = [
    (0.1, 0.0125),
    (0.3, 0.025),
    (0.6, 0.05),
    (1.2, 0.075),
    (2.0, 0.1),
    (5.0, 0.25),
    (10.0, 0.25),
    (30.0, 0.5),
    (60.0, 1.0),
    (132.0, 2.0),
    (170.0, 1.0),
    (177.0, 0.5),
    (180.0, 0.25),
];

/// Of the angles of phase functions, those of the ratios of the matrix are every so manieth: they have no peaks.
pub const MATRIX_STRIDE: usize = 2;

/// The angles of the tables in degrees, from 180 down to 0, so that their cosines grow.
#[must_use]
pub fn degrees() -> Vec<f64> {
    finer(1)
}

/// The angles of the tables and, in each of their intervals, `parts` - 1 more at equal steps, in the same order.
#[must_use]
pub fn finer(parts: u32) -> Vec<f64> {
    let mut angles = vec![0.0];
    let mut from = 0.0;
    for (to, step) in RUNS {
        let steps = parts * ((to - from) / step).round() as u32;
        angles.extend((1..=steps).map(|i| from + (to - from) * f64::from(i) / f64::from(steps)));
        from = to;
    }
    angles.reverse();
    angles
}

/// Cosines of angles in degrees, -1, 0 and 1 exactly.
#[must_use]
pub fn cosines(degrees: &[f64]) -> Vec<f64> {
    let cosine = |angle: f64| {
        if angle == 180.0 {
            -1.0
        } else if angle == 90.0 {
            0.0
        } else {
            angle.to_radians().cos()
        }
    };
    degrees.iter().map(|&angle| cosine(angle)).collect()
}

/// Makes values at angles of a phase function, whose integral over the sphere is 1, into those of a table, which is linear
/// in the cosine between them, as the renderer takes it, and has the integral 1 too. Returns what the integral of
/// the lines was, less 1.
///
/// A line lies above a convex function, mostly ahead: scaled down as a whole, the function would be too low everywhere
/// else. So each node is lowered by half the excess of the two cells beside it over half their width: the excess of a line
/// over the cubic through the four nearest nodes, and a share in proportion to it of what this leaves of the whole.
pub fn normalise(cosines: &[f64], phase: &mut [f64]) -> f64 {
    let before = integral(cosines, phase) - 1.0;
    let mut excess: Vec<f64> = (0..cosines.len() - 1).map(|cell| excess(cosines, phase, cell)).collect();
    let all: f64 = excess.iter().map(|e| e.abs()).sum();
    let left = before / (2.0 * std::f64::consts::PI) - excess.iter().sum::<f64>();
    if all > 0.0 {
        excess.iter_mut().for_each(|e| *e += left * e.abs() / all);
    }
    for (i, value) in phase.iter_mut().enumerate() {
        let cells = i.saturating_sub(1)..(i + 1).min(excess.len());
        let width = cosines[cells.end] - cosines[cells.start];
        *value -= excess[cells].iter().sum::<f64>() / width;
    }
    // Rounding, or all where the function is a line.
    let whole = integral(cosines, phase);
    phase.iter_mut().for_each(|value| *value /= whole);
    before
}

/// The integral over a cell of a line less that of the cubic through the four nearest nodes (or all, where there are fewer),
/// by Gauss-Legendre quadrature with two points, which is exact for cubics.
fn excess(cosines: &[f64], values: &[f64], cell: usize) -> f64 {
    let (a, b) = (cosines[cell], cosines[cell + 1]);
    let count = cosines.len().min(4);
    let first = cell.saturating_sub(1).min(cosines.len() - count);
    let near = first..first + count;
    let cubic = |c: f64| -> f64 {
        let factor = |i: usize, j: usize| (c - cosines[j]) / (cosines[i] - cosines[j]);
        let weight = |i: usize| near.clone().filter(|&j| j != i).map(|j| factor(i, j)).product::<f64>();
        near.clone().map(|i| weight(i) * values[i]).sum()
    };
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let offset = half / 3.0_f64.sqrt();
    half * (values[cell] + values[cell + 1] - cubic(middle - offset) - cubic(middle + offset))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_fall_from_180_to_0_and_their_cosines_grow() {
        let angles = degrees();
        assert_eq!((angles[0], angles[angles.len() - 1]), (180.0, 0.0));
        assert!(angles.windows(2).all(|pair| pair[0] > pair[1]));
        let cosines = cosines(&angles);
        assert!(cosines.windows(2).all(|pair| pair[0] < pair[1]) && cosines[0] == -1.0 && cosines.contains(&0.0));
    }

    #[test]
    fn runs_have_even_numbers_of_steps() {
        let angles = degrees();
        let coarse: Vec<f64> = angles.iter().copied().step_by(MATRIX_STRIDE).collect();
        assert!(RUNS.iter().all(|(to, _)| coarse.iter().any(|angle| (angle - to).abs() < 1e-9)), "{coarse:?}");
        assert_eq!(coarse.last(), Some(&0.0));
        let finer = finer(3);
        assert!(angles.iter().zip(finer.iter().step_by(3)).all(|(a, b)| (a - b).abs() < 1e-9));
    }

    #[test]
    fn a_normalised_function_keeps_its_share_ahead() {
        // Henyey and Greenstein with g = 0.9: between two cosines lies the share H(b) - H(a) of the light,
        // H = (1 - g^2) / (2 g) / sqrt(1 + g^2 - 2 g c); the value at 90 degrees is known too.
        let g: f64 = 0.9;
        let base = |c: f64| 1.0 + g * g - 2.0 * g * c;
        let value = |c: &f64| (1.0 - g * g) / (4.0 * std::f64::consts::PI * base(*c).powf(1.5));
        let cosines = cosines(&degrees());
        let exact: Vec<f64> = cosines.iter().map(value).collect();
        let mut phase: Vec<f64> = exact.clone();
        let before = normalise(&cosines, &mut phase);
        assert!((integral(&cosines, &phase) - 1.0).abs() < 1e-14);
        // Lines lie above.
        assert!(before > 1e-5 && before < 1e-3, "{before}");
        let ahead = cosines.partition_point(|c| *c < 5.0_f64.to_radians().cos() - 1e-12);
        let share = integral(&cosines[ahead..], &phase[ahead..]);
        let cumulative = |c: f64| (1.0 - g * g) / (2.0 * g) / base(c).sqrt();
        let expected = cumulative(1.0) - cumulative(cosines[ahead]);
        // The half cells at the end of the range are lowered by the next ones.
        assert!((share / expected - 1.0).abs() < 1e-4, "{share} for {expected}");
        for (p, exact) in phase.iter().zip(&exact) {
            // A twelfth of h^2 P'': largest where the steps are largest for the slope.
            assert!((p / exact - 1.0).abs() < 2e-3, "{p} for {exact}");
        }
    }
}
