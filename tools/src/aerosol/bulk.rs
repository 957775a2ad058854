//! Averages of single spheres over a size distribution.

use super::AerosolError;
use super::size::LogNormal;
use crate::mie::{AngularTable, RefractiveIndex, SIZE_PARAMETERS, Solver, Sums, sum};
use std::f64::consts::PI;

/// How finely sizes are resolved: nested trapezoidal rules in ln r, each with twice the intervals of the one
/// before, until two in a row agree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// Intervals of the first rule.
    pub first: u32,
    /// The most intervals.
    pub most: u32,
    /// Largest relative change of extinction, scattering and g that ends the doubling.
    pub cross_sections: f64,
    /// Largest relative change of the phase function, over all angles, that ends it.
    pub phase: f64,
}

/// Optics of particles of one material and size distribution, per particle.
#[derive(Debug, Clone, PartialEq)]
pub struct Bulk {
    /// Extinction cross-section, m^2.
    pub extinction: f64,
    /// Scattering cross-section, m^2.
    pub scattering: f64,
    /// Absorption cross-section, m^2; its own sum, not a difference.
    pub absorption: f64,
    /// Asymmetry parameter, 1.
    pub asymmetry: f64,
    /// Differential scattering cross-section for unpolarised light, m^2 sr^-1, at the angles asked for; its
    /// integral over the sphere is `scattering`.
    pub differential: Vec<f64>,
    /// How well it is known.
    pub error: QuadratureError,
}

/// What the last doubling of the nodes changed: a cautious estimate of what is left.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct QuadratureError {
    /// Largest relative change of extinction and scattering cross-section.
    pub cross_sections: f64,
    /// Largest relative change of the differential cross-section, over the angles.
    pub phase: f64,
}

/// Averages spheres of index `m` over `sizes` at a wavelength in m, at the angles of `angles` (which may be none).
///
/// C = integral of n(ln r) pi r^2 Q(2 pi r / lambda) d ln r by the rules of `rule`; the error is what the last
/// doubling changed. Radii below x = 1e-6 do not count.
///
/// # Errors
/// [`AerosolError::Mie`] if a sphere cannot be solved.
pub fn average(
    m: RefractiveIndex,
    sizes: &LogNormal,
    wavelength: f64,
    angles: &AngularTable,
    rule: &Rule,
    solver: &mut Solver,
) -> Result<Bulk, AerosolError> {
    let wave_number = 2.0 * PI / wavelength;
    let (low, high) = sizes.limits();
    let low = low.max((SIZE_PARAMETERS.0 * 1.001 / wave_number).ln());
    let mut nodes = |from: u32, every: u32, intervals: u32| -> Result<Sums, AerosolError> {
        let h = (high - low) / f64::from(intervals);
        let spheres = (from..=intervals).step_by(every as usize).map(|i| {
            let ln_r = low + f64::from(i) * h;
            let end = if i == 0 || i == intervals { 0.5 } else { 1.0 };
            (wave_number * ln_r.exp(), end * sizes.density(ln_r))
        });
        Ok(sum(m, spheres, angles, solver)?)
    };
    let mut intervals = rule.first;
    // The sums without the factor h of the rule.
    let mut total = nodes(0, 1, intervals)?;
    loop {
        let coarse = total.clone();
        intervals *= 2;
        total.add(&nodes(1, 2, intervals)?, 1.0);
        let relative = |coarse: f64, fine: f64| if fine == 0.0 { 0.0 } else { (2.0 * coarse / fine - 1.0).abs() };
        let phase = coarse.intensity.iter().zip(&total.intensity).map(|(a, b)| relative(*a, *b)).fold(0.0, f64::max);
        let cross_sections =
            relative(coarse.extinction, total.extinction).max(relative(coarse.scattering, total.scattering));
        let asymmetry = (coarse.forward / coarse.scattering - total.forward / total.scattering).abs();
        let good = cross_sections.max(asymmetry) < rule.cross_sections && phase < rule.phase;
        if good || 2 * intervals > rule.most {
            let h = (high - low) / f64::from(intervals);
            let scale = h / (wave_number * wave_number);
            return Ok(Bulk {
                extinction: scale * total.extinction,
                scattering: scale * total.scattering,
                absorption: scale * total.absorption,
                asymmetry: total.forward / total.scattering,
                differential: total.intensity.iter().map(|i| scale * i).collect(),
                error: QuadratureError { cross_sections, phase },
            });
        }
    }
}
