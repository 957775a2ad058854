//! The angles of the tables, and the rule by which phase functions are normalised.

use tables::views::integral;

/// Runs of angles: up to this angle in degrees, by this step. Dense ahead, for the diffraction peak of
/// coarse particles (its width is some 60/x degrees), and towards 180 degrees, for the glory.
const RUNS: [(f64, f64); 10] = [
    (0.1, 0.01),
    (0.3, 0.02),
    (0.6, 0.05),
    (2.0, 0.1),
    (5.0, 0.25),
    (10.0, 0.5),
    (30.0, 1.0),
    (130.0, 2.0),
    (170.0, 1.0),
    (180.0, 0.5),
];

/// The angles of the tables in degrees, from 180 down to 0, so that their cosines grow.
#[must_use]
pub fn degrees() -> Vec<f64> {
    let mut angles = vec![0.0];
    let mut from = 0.0;
    for (to, step) in RUNS {
        let steps = ((to - from) / step).round() as u32;
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

/// Divides a phase function by its integral over the sphere, taken as linear in the cosine between the
/// angles as the renderer does, and returns that integral less 1: what the angles miss.
pub fn normalise(cosines: &[f64], phase: &mut [f64]) -> f64 {
    let whole = integral(cosines, phase);
    for value in phase.iter_mut() {
        *value /= whole;
    }
    whole - 1.0
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
    fn a_normalised_function_integrates_to_one() {
        let cosines = cosines(&degrees());
        let mut phase: Vec<f64> = cosines.iter().map(|c| 3.0 * (1.0 + c * c)).collect();
        let before = normalise(&cosines, &mut phase);
        // The integral of 3 (1 + c^2) is 16 pi; the trapezoidal rule over steps of 2 degrees is high by 2e-4.
        assert!((before - (16.0 * std::f64::consts::PI - 1.0)).abs() < 1e-2, "{before}");
        assert!((integral(&cosines, &phase) - 1.0).abs() < 1e-14);
    }
}
