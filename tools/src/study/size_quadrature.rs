//! Averages over sizes: error against the number of radii, for several rules and kinds of particles.

use super::{Part, Results, StudyError};
use crate::aerosol::angles::{cosines, degrees};
use crate::aerosol::bulk::Rule;
use crate::aerosol::material::index;
use crate::aerosol::quadrature::Nodes;
use crate::aerosol::recipe::{Part as Component, Particles};
use crate::frame::Frame;
use crate::mie::{AngularTable, RefractiveIndex, Spheres, Sums, gauss_legendre, terms};
use crate::raw::RawData;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::path::Path;

/// Components of OPAC with their humidity in percent, from smooth to rough: key and words for columns and figures.
pub(super) const PARTICLES: [(&str, &str, f64, &str); 6] = [
    ("soot", "soot", 0.0, "soot"),
    ("water_soluble", "waso", 80.0, "water-soluble, 80 %"),
    ("mineral", "micm", 0.0, "mineral, coarse"),
    ("sulfate", "suso", 0.0, "sulfate, stratosphere"),
    ("sea_salt_fine", "ssam", 80.0, "sea salt, fine, 80 %"),
    ("sea_salt_coarse", "sscm", 80.0, "sea salt, coarse, 80 %"),
];

/// Wavelength in m: the shortest of the tables, where spheres are largest.
const WAVELENGTH: f64 = 300e-9;

/// Numbers of intervals (of Gauss-Legendre: of nodes).
const INTERVALS: [u32; 9] = [25, 50, 100, 200, 400, 800, 1600, 3200, 6400];

/// Intervals of the rule against which errors are measured.
const REFERENCE: u32 = 102_400;

/// A rule of integration over 0..1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quadrature {
    /// [`Nodes::Uniform`].
    Uniform,
    /// [`Nodes::Periodic`].
    Periodic,
    /// [`Nodes::gathered`].
    Gathered,
    /// Clenshaw and Curtis 1960: exact for the polynomial through cos(pi j / n).
    ClenshawCurtis,
    /// Gauss and Legendre; its nodes are not nested.
    GaussLegendre,
}

impl Quadrature {
    /// All that are compared.
    pub(super) const ALL: [Self; 5] =
        [Self::Uniform, Self::Periodic, Self::Gathered, Self::ClenshawCurtis, Self::GaussLegendre];

    /// Its name in columns.
    pub(super) fn key(self) -> &'static str {
        match self {
            Self::Uniform => "uniform",
            Self::Periodic => "periodic",
            Self::Gathered => "gathered",
            Self::ClenshawCurtis => "clenshaw_curtis",
            Self::GaussLegendre => "gauss_legendre",
        }
    }

    /// Nodes and weights, for the sizes of an average.
    fn nodes(self, average: &Average, n: u32) -> Vec<(f64, f64)> {
        let nested = |nodes: Nodes| {
            let all = (0..=n).map(|i| nodes.node(i, n)).filter(|(_, weight)| *weight > 0.0);
            all.map(|(u, weight)| (u, weight / f64::from(n))).collect()
        };
        match self {
            Self::Uniform => nested(Nodes::Uniform),
            Self::Periodic => nested(Nodes::Periodic),
            Self::Gathered => nested(Nodes::gathered(&average.particles.sizes, average.limits)),
            Self::ClenshawCurtis => clenshaw_curtis(n as usize),
            Self::GaussLegendre => {
                gauss_legendre(n as usize).into_iter().map(|(x, weight)| (0.5 * (1.0 + x), 0.5 * weight)).collect()
            }
        }
    }
}

/// Nodes cos(pi j / n), j = 0 ..= n, and their weights on 0..1:
/// w_j = c_j / n (1 - sum over k = 1 ..= n/2 of b_k / (4 k^2 - 1) cos(2 pi j k / n)) / 2, c_j = 1 at the ends, else 2,
/// b_k = 1 for k = n/2, else 2 (Waldvogel, BIT 46, 195, 2006); n even or odd.
fn clenshaw_curtis(n: usize) -> Vec<(f64, f64)> {
    let cosines: Vec<f64> = (0..n).map(|i| (2.0 * PI * i as f64 / n as f64).cos()).collect();
    let weight = |j: usize| {
        let term = |k: usize| {
            let b = if 2 * k == n { 1.0 } else { 2.0 };
            b / (4.0 * (k * k) as f64 - 1.0) * cosines[j * k % n]
        };
        let c = if j == 0 || j == n { 1.0 } else { 2.0 };
        0.5 * c / n as f64 * (1.0 - (1..=n / 2).map(term).sum::<f64>())
    };
    (0..=n).map(|j| (0.5 * (1.0 + (PI * j as f64 / n as f64).cos()), weight(j))).collect()
}

/// Particles at the wavelength of the study.
struct Average {
    m: RefractiveIndex,
    particles: Particles,
    limits: (f64, f64),
}

impl Average {
    fn new(raw: &RawData, component: &str, humidity: f64) -> Result<Self, StudyError> {
        let opac = &raw.aerosol_opac;
        let particles = Component::Component(component.into()).particles(opac, humidity)?;
        let m = index(opac, &particles.material, particles.humidity_percent, WAVELENGTH * 1e9)?;
        let limits = Rule::limits(&particles.sizes, Rule::TABLES.absorbing);
        Ok(Self { m, particles, limits })
    }

    /// Sums by a rule.
    fn by(
        &self,
        (rule, n): (Quadrature, u32),
        angles: &AngularTable,
        solver: &mut Spheres,
    ) -> Result<Sums, StudyError> {
        let (low, high) = self.limits;
        let spheres = rule.nodes(self, n).into_iter().map(|(u, weight)| {
            let ln_r = low + u * (high - low);
            (2.0 * PI / WAVELENGTH * ln_r.exp(), weight * self.particles.sizes.density(ln_r))
        });
        Ok(solver.sum(self.m, spheres, angles)?)
    }
}

/// Largest error of extinction, scattering (relative) and g, and largest relative error of the intensity at an angle.
fn errors(found: &Sums, exact: &Sums) -> (f64, f64) {
    let relative = |a: f64, b: f64| (a / b - 1.0).abs();
    let asymmetry = (found.forward / found.scattering - exact.forward / exact.scattering).abs();
    let optics = relative(found.extinction, exact.extinction).max(relative(found.scattering, exact.scattering));
    let pairs = found.intensity().iter().zip(exact.intensity());
    (optics.max(asymmetry), pairs.map(|(a, b)| relative(*a, *b)).fold(0.0, f64::max))
}

/// Names of the parts: errors of cross-sections and g, and of the phase function.
pub(super) const PARTS: [&str; 2] = ["cross-sections", "phase"];

/// The column of some particles and a rule.
pub(super) fn column(particles: &str, rule: Quadrature) -> String {
    format!("{particles}_{}", rule.key())
}

/// Errors at 300 nm against the number of radii, at the angles of the tables.
pub(super) fn compare(raw_dir: &Path) -> Result<Results, StudyError> {
    let raw = RawData::from_dir(raw_dir)?;
    let averages = PARTICLES
        .iter()
        .map(|(_, component, humidity, _)| Average::new(&raw, component, *humidity))
        .collect::<Result<Vec<_>, _>>()?;
    let largest = averages.iter().map(|a| a.limits.1.exp()).fold(0.0, f64::max);
    let angles = AngularTable::new(&cosines(&degrees()), terms(1.001 * 2.0 * PI / WAVELENGTH * largest))?;
    let exact: Vec<Sums> = averages
        .par_iter()
        .map(|average| average.by((Quadrature::Periodic, REFERENCE), &angles, &mut Spheres::new()))
        .collect::<Result<_, _>>()?;
    let rules: Vec<_> = Quadrature::ALL.into_iter().flat_map(|rule| INTERVALS.map(|n| (rule, n))).collect();
    // One row for each rule and number, one pair of errors for each kind of particles.
    let found: Vec<Vec<(f64, f64)>> = rules
        .par_iter()
        .map_init(Spheres::new, |solver, &rule| {
            let one = |(average, exact): (&Average, &Sums)| Ok(errors(&average.by(rule, &angles, solver)?, exact));
            averages.iter().zip(&exact).map(one).collect::<Result<Vec<_>, StudyError>>()
        })
        .collect::<Result<_, _>>()?;
    let part = |name, of: fn(&(f64, f64)) -> f64| -> Result<Part, StudyError> {
        let mut columns = vec![("radii".to_owned(), INTERVALS.map(f64::from).to_vec())];
        for (p, (key, ..)) in PARTICLES.iter().enumerate() {
            for (rule, rows) in Quadrature::ALL.into_iter().zip(found.chunks(INTERVALS.len())) {
                columns.push((column(key, rule), rows.iter().map(|row| of(&row[p])).collect()));
            }
        }
        Ok(Part { name, frame: Frame::new(columns)? })
    };
    let parts = vec![part(PARTS[0], |errors| errors.0)?, part(PARTS[1], |errors| errors.1)?];
    Ok(Results { parts, remarks: Vec::new() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clenshaw_curtis_is_exact_for_polynomials() {
        for n in [5, 8] {
            for power in 0..=5 {
                let sum: f64 = clenshaw_curtis(n).iter().map(|(u, weight)| weight * u.powi(power)).sum();
                // The mean of u^p over 0..1; rounding.
                assert!((sum * f64::from(power + 1) - 1.0).abs() < 1e-14, "u^{power} with n = {n}: {sum}");
            }
        }
    }

    #[test]
    fn all_rules_find_the_average_of_a_smooth_integrand() {
        let raw = RawData::from_dir(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../raw-data")).expect("sound");
        let soot = Average::new(&raw, "soot", 0.0).expect("soot");
        let none = AngularTable::new(&[], 0).expect("no angle");
        let mut solver = Spheres::new();
        let mut by = |rule: Quadrature, n| soot.by((rule, n), &none, &mut solver).expect("in range");
        let exact = by(Quadrature::Periodic, 6400);
        for rule in Quadrature::ALL {
            // Two still have their error at the limits, which falls as h^2.
            let limit = if matches!(rule, Quadrature::Uniform | Quadrature::Gathered) { 1e-5 } else { 1e-10 };
            let (error, _) = errors(&by(rule, 400), &exact);
            assert!(error < limit, "{rule:?}: {error:e}");
        }
    }
}
