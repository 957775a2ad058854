//! Averages of single spheres over a size distribution.

use super::AerosolError;
use super::quadrature::{ABSORBING, Nodes};
use super::size::Sizes;
use crate::mie::{AngularTable, RefractiveIndex, SIZE_PARAMETERS, Spheres, Sums};
use std::f64::consts::PI;
use std::fmt;

/// Share of the tolerance of cross-sections that the limits of integration may cut off.
const CUT: f64 = 0.1;

/// How well averages are wanted.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Relative error of extinction and scattering cross-section, and error of g.
    pub cross_sections: f64,
    /// Relative error of the differential cross-section at any angle.
    pub phase: f64,
    /// The most intervals that are spent on it.
    pub most: u32,
}

/// How finely sizes are resolved: nested rules in ln r, each with twice the intervals of the one before, until the error
/// is below the tolerance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rule {
    /// Intervals of the first rule.
    pub first: u32,
    /// What is wanted of particles that absorb, k >= [`ABSORBING`]: their resonances are damped.
    pub absorbing: Tolerance,
    /// What is wanted of the rest.
    pub clear: Tolerance,
}

impl Rule {
    /// Least and largest factor on the tolerances that [`Rule::scaled`] takes.
    pub const FACTORS: (f64, f64) = (1e-3, 1e3);

    /// What the tables are made with.
    pub const TABLES: Self = Self {
        first: 50,
        absorbing: Tolerance { cross_sections: 1e-6, phase: 1e-5, most: 12_800 },
        clear: Tolerance { cross_sections: 1e-4, phase: 1e-2, most: 51_200 },
    };

    /// The same rule with its tolerances times `factor`, of [`Rule::FACTORS`].
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        let scaled =
            |t: Tolerance| Tolerance { cross_sections: factor * t.cross_sections, phase: factor * t.phase, ..t };
        Self { absorbing: scaled(self.absorbing), clear: scaled(self.clear), ..self }
    }

    /// What is wanted of spheres of index `m`.
    #[must_use]
    pub fn tolerance(&self, m: RefractiveIndex) -> Tolerance {
        if m.k() >= ABSORBING { self.absorbing } else { self.clear }
    }

    /// ln r between which `sizes` are averaged for this tolerance: beyond lies at most a tenth of it (see
    /// [`Sizes::limits`]).
    #[must_use]
    pub fn limits(sizes: &Sizes, tolerance: Tolerance) -> (f64, f64) {
        sizes.limits(CUT * tolerance.cross_sections)
    }
}

impl fmt::Display for Rule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let told = |t: Tolerance| {
            let Tolerance { cross_sections, phase, most } = t;
            format!("{cross_sections:e} in cross-sections and g, {phase:e} in phase functions, up to {most} intervals")
        };
        write!(f, "{} where k >= {ABSORBING}; {} elsewhere", told(self.absorbing), told(self.clear))
    }
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
    /// Scattering matrix as differential cross-sections, m^2 sr^-1, at the angles asked for: S11 (natural light; its
    /// integral over the sphere is `scattering`), S12, S33, S34 as in [`Sums::matrix`].
    pub matrix: [Vec<f64>; 4],
    /// How well it is known.
    pub error: QuadratureError,
    /// Whether that is within the tolerance.
    pub reached: bool,
    /// Intervals of the last rule.
    pub intervals: u32,
}

/// What the last doubling of the nodes changed, or half of what the one before changed if that is more: a cautious
/// estimate of what is left, since two rules can agree by chance. What the limits of integration may cut off is added to `cross_sections` and `phase`.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct QuadratureError {
    /// Largest of the relative changes of extinction and scattering cross-section and of the change of g.
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
/// C = integral of n(ln r) pi r^2 Q(2 pi r / lambda) d ln r by the rules of `rule`, with the nodes that suit the spheres
/// ([`Nodes::suiting`]); the error is that of [`QuadratureError`]. Radii below x = 1e-6 do not count.
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
    let tolerance = rule.tolerance(m);
    let (low, high) = Rule::limits(sizes, tolerance);
    let low = low.max((SIZE_PARAMETERS.0 * 1.001 / wave_number).ln());
    let nodes = Nodes::suiting(m, sizes, (low, high), wave_number);
    let mut sum = |from: u32, every: u32, intervals: u32| -> Result<Sums, AerosolError> {
        let all = (from..=intervals).step_by(every as usize).map(|i| nodes.node(i, intervals));
        let spheres = all.filter(|(_, weight)| *weight > 0.0).map(|(u, weight)| {
            let ln_r = low + u * (high - low);
            (wave_number * ln_r.exp(), weight * sizes.density(ln_r))
        });
        Ok(solver.sum(m, spheres, angles)?)
    };
    let mut intervals = rule.first;
    // The sums without the factor h of the rule.
    let mut total = sum(0, 1, intervals)?;
    let mut before: Option<QuadratureError> = None;
    loop {
        let coarse = total.clone();
        intervals *= 2;
        total.add(&sum(1, 2, intervals)?, 1.0);
        let change = changes(&coarse, &total, angles.cosines());
        // Two rules can agree by chance: the doubling before has its say.
        let mut error = before.map_or(change, |before| change.or_half_of(before));
        error.cross_sections += CUT * tolerance.cross_sections;
        error.phase += CUT * tolerance.cross_sections;
        let good = error.cross_sections <= tolerance.cross_sections && error.phase <= tolerance.phase;
        let reached = before.is_some() && good;
        before = Some(change);
        if reached || 2 * intervals > tolerance.most {
            let scale = (high - low) / f64::from(intervals) / (wave_number * wave_number);
            return Ok(Bulk {
                extinction: scale * total.extinction,
                scattering: scale * total.scattering,
                absorption: scale * total.absorption,
                asymmetry: total.forward / total.scattering,
                matrix: total.matrix.map(|element| element.iter().map(|s| scale * s).collect()),
                error,
                reached,
                intervals,
            });
        }
    }
}

impl QuadratureError {
    fn or_half_of(self, before: Self) -> Self {
        Self {
            cross_sections: self.cross_sections.max(0.5 * before.cross_sections),
            misplaced: self.misplaced.max(0.5 * before.misplaced),
            phase: self.phase.max(0.5 * before.phase),
        }
    }
}

/// Compares the sums of a rule with those of twice the intervals, both without their factor h.
fn changes(coarse: &Sums, fine: &Sums, cosines: &[f64]) -> QuadratureError {
    let relative = |coarse: f64, fine: f64| if fine == 0.0 { 0.0 } else { (2.0 * coarse / fine - 1.0).abs() };
    let pairs = || coarse.intensity().iter().zip(fine.intensity());
    let moved: Vec<f64> = pairs().map(|(a, b)| (a / coarse.scattering - b / fine.scattering).abs()).collect();
    let asymmetry = (coarse.forward / coarse.scattering - fine.forward / fine.scattering).abs();
    let optics = relative(coarse.extinction, fine.extinction).max(relative(coarse.scattering, fine.scattering));
    QuadratureError {
        cross_sections: optics.max(asymmetry),
        misplaced: 0.5 * tables::views::integral(cosines, &moved),
        phase: pairs().map(|(a, b)| relative(*a, *b)).fold(0.0, f64::max),
    }
}
