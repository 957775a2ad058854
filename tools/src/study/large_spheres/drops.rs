//! Phase functions of water drops with a distribution of sizes.

use crate::aerosol::angles;
use crate::mie::{AngularTable, MieError, RefractiveIndex, Spheres, Sums, terms};
use rayon::prelude::*;
use std::f64::consts::PI;

/// The gamma distribution of Hansen and Travis (Space Sci. Rev. 16, 527, 1974, equation 2.56),
/// n(r) proportional to r^((1 - 3b) / b) exp(-r / (a b)): a in m is the mean radius weighted with the cross-section
/// pi r^2, b the variance so weighted over a^2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Gamma {
    /// Effective radius a, m.
    pub(super) radius: f64,
    /// Effective variance b, 1.
    pub(super) variance: f64,
}

impl Gamma {
    /// n(r) over its value at the radius a, at t = r / a.
    fn density(self, t: f64) -> f64 {
        let b = self.variance;
        ((1.0 - 3.0 * b) / b * t.ln() - (t - 1.0) / b).exp()
    }

    /// r / a between which drops are counted: r^2 n(r) has a standard deviation sqrt(b) around 1 and a tail towards
    /// large drops, which grow by another r^2 ahead.
    fn limits(self) -> (f64, f64) {
        let b = self.variance;
        ((1.0 - 6.0 * b.sqrt()).max(0.02), 1.0 + 6.0 * b.sqrt() + 16.0 * b)
    }

    /// Mean radius in m weighted with the light that is diffracted straight ahead, r^4 n(r).
    pub(super) fn diffracting_radius(self) -> f64 {
        self.radius * (1.0 + 2.0 * self.variance)
    }
}

/// A phase function.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Averaged {
    /// At each angle, sr^-1; its integral over the sphere is 1 by the Mie series.
    pub(super) phase: Vec<f64>,
    /// The same by every other size alone, the first and the second.
    pub(super) halves: [Vec<f64>; 2],
    /// Asymmetry parameter.
    pub(super) asymmetry: f64,
}

/// Sizes of one task. Tasks do not depend on the number of threads, so neither does the order of the sums.
const TASK: usize = 64;

/// Averages drops of index `m` at a wavelength in m over `sizes` at `angles` by the trapezoidal rule with the `step`
/// given in the size parameter.
///
/// # Errors
/// [`MieError`].
pub(super) fn average(
    m: RefractiveIndex,
    sizes: Gamma,
    wavelength: f64,
    angles: &AngularTable,
    step: f64,
) -> Result<Averaged, MieError> {
    let x = 2.0 * PI * sizes.radius / wavelength;
    let (low, high) = sizes.limits();
    let intervals = ((high - low) * x / step).ceil() as usize;
    let nodes: Vec<(f64, f64)> = (0..=intervals)
        .map(|i| low + (high - low) * i as f64 / intervals as f64)
        .map(|t| (t * x, sizes.density(t)))
        .collect();
    let count = angles.cosines().len();
    let sum = |first: usize| -> Result<Sums, MieError> {
        let own: Vec<(f64, f64)> = nodes.iter().copied().skip(first).step_by(2).collect();
        let tasks: Vec<Sums> = own
            .par_chunks(TASK)
            .map_init(Spheres::new, |solver, task| solver.sum(m, task.iter().copied(), angles))
            .collect::<Result<_, _>>()?;
        let mut total = Sums::zero(count);
        for task in &tasks {
            total.add(task, 1.0);
        }
        Ok(total)
    };
    let halves = [sum(0)?, sum(1)?];
    let mut all = halves[0].clone();
    all.add(&halves[1], 1.0);
    let phase = |sums: &Sums| sums.intensity().iter().map(|i| i / sums.scattering).collect();
    Ok(Averaged { phase: phase(&all), halves: halves.each_ref().map(phase), asymmetry: all.forward / all.scattering })
}

/// Functions at the angles (degrees) for the largest drop of `sizes` at the shortest wavelength in m.
///
/// # Errors
/// [`MieError`].
pub(super) fn table(degrees: &[f64], sizes: Gamma, shortest: f64) -> Result<AngularTable, MieError> {
    let largest = 2.0 * PI * sizes.radius * sizes.limits().1 / shortest;
    AngularTable::new(&angles::cosines(degrees), terms(1.001 * largest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn mean_and_variance_are_the_effective_ones_and_the_limits_leave_nothing_out() {
        for b in [1e-4, 0.01, 0.1] {
            let sizes = Gamma { radius: 1e-5, variance: b };
            let (low, high) = sizes.limits();
            let steps = 4000;
            let t = |i: u32| low + (high - low) * f64::from(i) / f64::from(steps);
            let moment = |power: i32| (0..=steps).map(|i| t(i).powi(power) * sizes.density(t(i))).sum::<f64>();
            let mean = moment(3) / moment(2);
            let variance = moment(4) / moment(2) - mean * mean;
            // What is cut off is below 1e-6 of the moments.
            assert!((mean - 1.0).abs() < 1e-6, "b = {b}: {mean}");
            assert!((variance / b - 1.0).abs() < 1e-4, "b = {b}: {variance}");
            let ahead = moment(5) / moment(4) * sizes.radius;
            assert!((ahead / sizes.diffracting_radius() - 1.0).abs() < 1e-5, "b = {b}: {ahead}");
        }
    }

    #[test]
    fn phase_functions_are_normalised() {
        let sizes = Gamma { radius: 2e-6, variance: 0.05 };
        // The diffraction peak of x = 23 is 10 degrees wide.
        let degrees: Vec<f64> = (0..=720).rev().map(|i| f64::from(i) * 0.25).collect();
        let m = RefractiveIndex::new(1.333, 0.0).expect("an index");
        let table = table(&degrees, sizes, 550e-9).expect("angles");
        let found = average(m, sizes, 550e-9, &table, 0.5).expect("in range");
        let whole = tables::views::integral(table.cosines(), &found.phase);
        // The trapezoidal rule of 0.25 degrees in a peak of 10.
        assert!((whole - 1.0).abs() < 2e-3, "{whole}");
    }
}
