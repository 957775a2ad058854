//! What single scattering and its closure state of their own errors.

use super::isotropic::Further;
use super::march::Air;
use crate::geometry::Place;
use crate::transport::{DIRECTIONS, directions};
use glam::DVec3;

/// Errors in 64 directions about an observer, root mean squares over directions and wavelengths of the difference over the mean of the
/// wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stated {
    /// Light scattered twice or more as the isotropic closure has it: what `single` leaves out, and what `isotropic` only guesses.
    pub further: f64,
    /// What the number of points on a line leaves: 4/3 of the change by twice as many, for the midpoint rule's error falls as the
    /// square of their distance.
    pub points: f64,
}

impl Stated {
    pub(super) fn of<const L: usize>(air: &Air<L>, further: &Further<L>, from: Place, sun: DVec3) -> Self {
        let steps = air.steps();
        let (mut whole, mut squares) = ([0.0; L], [[0.0; L]; 2]);
        for direction in directions(from, air.columns().shape(), air.medium().top_m()) {
            let look = |steps, further| air.radiance((from, direction), sun, steps, further);
            let (once, all, finer) = (look(steps, None), look(steps, Some(further)), look(2 * steps, Some(further)));
            for j in 0..L {
                whole[j] += finer[j];
                squares[0][j] += (all[j] - once[j]).powi(2);
                squares[1][j] += (4.0 / 3.0 * (finer[j] - all[j])).powi(2);
            }
        }
        let [further, points] = squares.map(|squares| {
            let lit = squares.iter().zip(whole).filter(|(_, whole)| *whole > 0.0);
            // Sums instead of means over the directions.
            let sum = lit.fold(0.0, |sum, (square, whole)| sum + f64::from(DIRECTIONS) * square / (whole * whole));
            (sum / L as f64).sqrt()
        });
        Self { further, points }
    }

    /// Both together.
    #[must_use]
    pub fn whole(&self) -> f64 {
        self.further.hypot(self.points)
    }
}
