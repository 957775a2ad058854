//! Averages of single spheres over a size distribution.

use super::AerosolError;
use super::size::Sizes;
use crate::mie::{AngularTable, RefractiveIndex, SIZE_PARAMETERS, Spheres, Sums};
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
    /// Largest share of the scattered light that may still go elsewhere (see [`QuadratureError::misplaced`]).
    pub misplaced: f64,
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

/// What the last doubling of the nodes changed, or a quarter of what the one before changed if that is more: a cautious
/// estimate of what is left.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct QuadratureError {
    /// Largest relative change of extinction and scattering cross-section.
    pub cross_sections: f64,
    /// Share of the scattered light that went into other directions: half the integral over the sphere of the
    /// absolute change of the phase function.
    pub misplaced: f64,
    /// Largest relative change of the differential cross-section, over the angles: where little light goes, as a
    /// rule near 180 degrees.
    pub phase: f64,
}

/// Averages spheres of index `m` over `sizes` at a wavelength in m, at the angles of `angles` (which may be none).
///
/// C = integral of n(ln r) pi r^2 Q(2 pi r / lambda) d ln r by the rules of `rule`; the error is that of
/// [`QuadratureError`]. Radii below x = 1e-6 do not count.
///
/// # Errors
/// [`AerosolError::Mie`] if a sphere cannot be solved.
pub fn average(
    m: RefractiveIndex,
    sizes: &Sizes,
    wavelength: f64,
    angles: &AngularTable,
    rule: &Rule,
    solver: &mut Spheres,
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
        Ok(solver.sum(m, spheres, angles)?)
    };
    let mut intervals = rule.first;
    // The sums without the factor h of the rule.
    let mut total = nodes(0, 1, intervals)?;
    let mut before: Option<Changes> = None;
    loop {
        let coarse = total.clone();
        intervals *= 2;
        total.add(&nodes(1, 2, intervals)?, 1.0);
        let change = changes(&coarse, &total, angles.cosines());
        // Two rules can agree by chance: the doubling before has its say.
        let error = before.map_or(change, |before: Changes| change.or_a_quarter_of(before));
        let good = before.is_some()
            && error.optics.max(error.asymmetry) < rule.cross_sections
            && error.misplaced < rule.misplaced;
        before = Some(change);
        if good || 2 * intervals > rule.most {
            let h = (high - low) / f64::from(intervals);
            let scale = h / (wave_number * wave_number);
            return Ok(Bulk {
                extinction: scale * total.extinction,
                scattering: scale * total.scattering,
                absorption: scale * total.absorption,
                asymmetry: total.forward / total.scattering,
                differential: total.intensity().iter().map(|i| scale * i).collect(),
                error: QuadratureError { cross_sections: error.optics, misplaced: error.misplaced, phase: error.phase },
            });
        }
    }
}

/// What a doubling of the nodes changed: cross-sections, g, and the parts of [`QuadratureError`] about angles.
#[derive(Debug, Clone, Copy)]
struct Changes {
    optics: f64,
    asymmetry: f64,
    misplaced: f64,
    phase: f64,
}

impl Changes {
    fn or_a_quarter_of(self, before: Self) -> Self {
        Self {
            optics: self.optics.max(0.25 * before.optics),
            asymmetry: self.asymmetry.max(0.25 * before.asymmetry),
            misplaced: self.misplaced.max(0.25 * before.misplaced),
            phase: self.phase.max(0.25 * before.phase),
        }
    }
}

/// Compares the sums of a rule with those of twice the intervals, both without their factor h.
fn changes(coarse: &Sums, fine: &Sums, cosines: &[f64]) -> Changes {
    let relative = |coarse: f64, fine: f64| if fine == 0.0 { 0.0 } else { (2.0 * coarse / fine - 1.0).abs() };
    let pairs = || coarse.intensity().iter().zip(fine.intensity());
    let moved: Vec<f64> = pairs().map(|(a, b)| (a / coarse.scattering - b / fine.scattering).abs()).collect();
    Changes {
        optics: relative(coarse.extinction, fine.extinction).max(relative(coarse.scattering, fine.scattering)),
        asymmetry: (coarse.forward / coarse.scattering - fine.forward / fine.scattering).abs(),
        misplaced: 0.5 * tables::views::integral(cosines, &moved),
        phase: pairs().map(|(a, b)| relative(*a, *b)).fold(0.0, f64::max),
    }
}
