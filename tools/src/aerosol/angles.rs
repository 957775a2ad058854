//! The angles of the tables.

use tables::views::COSINE;
use tables::{Axis, Interpolation, TableError};

/// Runs of angles: up to this angle in degrees, in so many steps. Dense ahead, where coarse particles scatter as a power of
/// the angle, in the rainbow of clear particles, and towards 180 degrees, for the glory; within a degree they need not be
/// finer than what the sun's disc smooths. `study aerosol-tables` has the cost in radiance.
const RUNS: [(f64, u32); 14] = [
    (0.3, 10),
    (0.6, 6),
    (1.2, 10),
    (2.0, 8),
    (4.4, 16),
    (10.0, 14),
    (16.0, 10),
    (30.0, 14),
    (60.0, 12),
    (132.0, 18),
    (170.0, 38),
    (176.0, 12),
    (178.0, 8),
    (180.0, 16),
];

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
    for (to, steps) in RUNS {
        let steps = parts * steps;
        angles.extend((1..=steps).map(|i| from + (to - from) * f64::from(i) / f64::from(steps)));
        from = to;
    }
    angles.reverse();
    angles
}

/// The axis of the tables: cosines of their angles, cubics between them.
///
/// # Errors
/// As [`Axis::new`], which takes these cosines.
pub fn axis() -> Result<Axis, TableError> {
    Ok(Axis::new(COSINE.0, COSINE.1, cosines(&degrees()))?.between(Interpolation::Cubic))
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_fall_from_180_to_0_and_their_cosines_grow() {
        let angles = degrees();
        assert_eq!((angles[0], angles[angles.len() - 1]), (180.0, 0.0));
        assert!(angles.windows(2).all(|pair| pair[0] > pair[1]));
        let axis = axis().expect("cosines that grow");
        assert_eq!((axis.range(), axis.nodes.len()), ((-1.0, 1.0), angles.len()));
        assert_eq!(cosines(&[180.0, 90.0, 0.0]), [-1.0, 0.0, 1.0]);
    }

    #[test]
    fn finer_angles_keep_the_coarse_ones() {
        let (angles, finer) = (degrees(), finer(3));
        assert!(angles.iter().zip(finer.iter().step_by(3)).all(|(a, b)| (a - b).abs() < 1e-9));
        assert_eq!(finer.len(), 3 * (angles.len() - 1) + 1);
    }
}
