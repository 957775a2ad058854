//! Four skies on which other renderers were timed: what a direction and a picture cost.
//!
//! A planet of radius 6360 km with an atmosphere of 100 km and a ground of albedo 0.2, an eye 200 m up, a parallel
//! sun of unit irradiance. Molecules: tau = 0.008569 l^-4 (1 + 0.0113 l^-2 + 0.00013 l^-4), l the wavelength in
//! um (Hansen & Travis 1974), scale height 8 km, 3 / 16 pi (1 + cos^2). Ozone: 300 DU between 10 and 40 km, a triangle
//! about 25 km, absorbing. Aerosol, in the last case: tau = 0.2 at 550 nm, albedo 0.92, scale height 1.2 km,
//! Henyey-Greenstein 0.76. All as a table of 200 cells, linear between their centres.

pub mod certificates;
pub mod polarised;
pub mod solved;

use crate::atmosphere::{Columns, Component, Medium, MediumError, Tolerance};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::light::SunDisc;
use crate::phase::Phase;
use crate::render::{RenderError, Sky};
use crate::sampling::{POINTS, Sampler};
use crate::scene::Scene;
use crate::transport::{self, Certificate, Estimator, Fan, Method, Problem, Resolution, SolveError, Solved};
use glam::DVec3;
use std::time::Instant;
use tables::units::KM;
use tables::views::Biome;
use tables::{Axis, Curve, Outside, Scale};

const RADIUS_M: f64 = 6360.0 * KM;
const TOP_M: f64 = 100.0 * KM;
pub(crate) const EYE_M: f64 = 200.0;
pub(crate) const ALBEDO: f64 = 0.2;

/// The planet.
pub(crate) const SHAPE: Shape = Shape::Sphere { radius_m: RADIUS_M };

/// Pixels of the width of the picture that costs are given for, a fisheye.
const WIDTH: u32 = 320;

/// Its sky pixels.
pub const PIXELS: f64 = 80_425.0;

/// The directions of its pixels.
pub(crate) fn fisheye() -> Vec<DVec3> {
    let camera = Scene { width: Some(WIDTH), height: Some(WIDTH), ..Scene::default() }.camera();
    let pixels = (0..WIDTH * WIDTH).map(|i| (f64::from(i % WIDTH) + 0.5, f64::from(i / WIDTH) + 0.5));
    pixels.filter_map(|(x, y)| camera.direction(x, y)).collect()
}

/// `L` wavelengths in nm, at least 2, evenly from 380 to 780.
pub(crate) fn visible<const L: usize>() -> [f64; L] {
    std::array::from_fn(|i| 380.0 + 400.0 * i as f64 / (L - 1) as f64)
}

/// The medium of a scene with that biome at `L` wavelengths in nm.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub(crate) fn medium<const L: usize>(
    data: &Data,
    biome: Option<Biome>,
    nm: &[f64; L],
) -> Result<Medium<L>, RenderError> {
    let scene = Scene { biome, method: Method::Paths, ..Scene::default() };
    Ok(Sky::new(&scene, data)?.air().medium(nm)?)
}

/// A sky of the bench.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Case {
    /// What it is called.
    pub name: &'static str,
    /// Zenith angle of the sun in degrees.
    pub sun_zenith_deg: f64,
    /// Vertical optical depth of molecular scattering.
    pub molecules: f64,
    /// Cross-section of ozone in cm^2.
    pub ozone_cm2: f64,
    /// Vertical optical depth of aerosol.
    pub aerosol: f64,
    /// Directions: zenith angle and azimuth from the sun in degrees.
    pub views: &'static [(f64, f64)],
}

/// Rayleigh optical depth at a wavelength in um.
pub(crate) fn molecules(um: f64) -> f64 {
    0.008_569 * um.powi(-4) * (1.0 + 0.0113 * um.powi(-2) + 0.000_13 * um.powi(-4))
}

const DAY: [(f64, f64); 6] = [(0.0, 0.0), (30.0, 90.0), (55.0, 0.0), (60.0, 180.0), (85.0, 90.0), (89.0, 180.0)];
const TWILIGHT: [(f64, f64); 4] = [(0.0, 0.0), (60.0, 0.0), (85.0, 0.0), (85.0, 180.0)];

/// The cases: by day at 450 and 680 nm, in twilight at 450 nm, and with aerosol at 550 nm.
#[must_use]
pub fn cases() -> [Case; 4] {
    let case = |name, sun_zenith_deg, um, ozone_cm2, aerosol, views| Case {
        name,
        sun_zenith_deg,
        molecules: molecules(um),
        ozone_cm2,
        aerosol,
        views,
    };
    [
        case("D450", 60.0, 0.45, 1.7e-22, 0.0, &DAY as &[_]),
        case("D680", 60.0, 0.68, 1.36e-21, 0.0, &DAY),
        case("A550", 60.0, 0.55, 3.3e-21, 0.2, &DAY),
        case("T450", 95.0, 0.45, 1.7e-22, 0.0, &TWILIGHT),
    ]
}

impl Case {
    /// The medium at its one wavelength.
    ///
    /// # Errors
    /// [`MediumError`] never: the coefficients are sound.
    pub fn medium(&self) -> Result<Medium<1>, MediumError> {
        const CELLS: u32 = 200;
        let cell = TOP_M / f64::from(CELLS);
        let mut nodes = vec![0.0];
        nodes.extend((0..CELLS).map(|i| (f64::from(i) + 0.5) * cell));
        nodes.push(TOP_M);
        // The outer half cells hold the value of their centres.
        let held = |z: f64| z.clamp(0.5 * cell, TOP_M - 0.5 * cell);
        let axis = Axis::new("altitude", "m", nodes)?.beyond(Outside::Zero);
        let curve = |density: &dyn Fn(f64) -> f64| {
            Curve::new(axis.clone(), Scale::Linear, axis.nodes.iter().map(|&z| density(held(z))).collect())
        };
        let exponential = |scale: f64| move |z: f64| (-z / scale).exp() / scale;
        let triangle = |z: f64| (1.0 - (z - 25.0 * KM).abs() / (15.0 * KM)).max(0.0) / (15.0 * KM);
        let isotropic = Phase::Rayleigh { gamma: [0.0] };
        let component = |density, scattering, absorption, phase| Component {
            density,
            scattering: [scattering],
            absorption: [absorption],
            phase,
        };
        // 300 DU are 8.06e18 molecules over each cm^2.
        let mut components = vec![
            component(curve(&exponential(8.0 * KM))?, self.molecules, 0.0, isotropic.clone()),
            component(curve(&triangle)?, 0.0, self.ozone_cm2 * 8.06e18, isotropic),
        ];
        if self.aerosol > 0.0 {
            let phase = Phase::HenyeyGreenstein { g: [0.76] };
            let density = curve(&exponential(1.2 * KM))?;
            components.push(component(density, 0.92 * self.aerosol, 0.08 * self.aerosol, phase));
        }
        Medium::new(components, TOP_M)
    }
}

/// What one direction costs on one thread.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cost {
    /// Zenith angle and azimuth from the sun in degrees.
    pub view: (f64, f64),
    /// Radiance per unit solar irradiance in sr^-1, and its standard error.
    pub radiance: (f64, f64),
    /// Relative standard deviation of one path by itself.
    pub deviation: f64,
    /// Seconds a path, the least of several batches.
    pub seconds_per_path: f64,
    /// Seconds of the direction before its first path.
    pub seconds_before: f64,
    /// Paths of one low-discrepancy sequence for a relative standard error of 1 %.
    pub paths_to_1_percent: f64,
}

impl Cost {
    /// Seconds for a relative standard error of 1 %.
    #[must_use]
    pub fn seconds_to_1_percent(&self) -> f64 {
        self.seconds_before + self.seconds_per_path * self.paths_to_1_percent
    }
}

/// Independent sequences whose spread is the error of one, of fewer points than [`LONG`] and of more.
const REPLICATES: (u64, u64) = (256, 32);

/// Points of a sequence that is long.
const LONG: u64 = 1024;

/// Measures one direction of a case: sequences of 1, 2, 4 ... points, 256 of each length, or 32 where they are long, until
/// their spread is below 1 % (between two lengths by a power law) and `seconds` have passed.
#[must_use]
pub fn measure(
    case: &Case,
    (medium, columns): (&Medium<1>, &Columns<1>),
    method: Estimator,
    view: (f64, f64),
    seconds: f64,
) -> Cost {
    let sun = SunDisc::beam(towards(case.sun_zenith_deg, 0.0));
    let problem = Problem {
        texture: None,
        shape: SHAPE,
        medium,
        columns,
        albedo: [ALBEDO],
        sun: Some(&sun),
        environment: None,
        max_orders: None,
    };
    let (place, direction) = (Place::above(EYE_M), towards(view.0, view.1));
    let start = Instant::now();
    let mut cost = Cost {
        view,
        radiance: (0.0, f64::INFINITY),
        deviation: 0.0,
        seconds_per_path: f64::INFINITY,
        seconds_before: 0.0,
        paths_to_1_percent: f64::NAN,
    };
    let mut last: Option<(f64, f64)> = None;
    let mut points = 1_u64;
    while points <= POINTS {
        let (mut mean, mut squares) = (0.0, 0.0);
        let replicates = if points < LONG { REPLICATES.0 } else { REPLICATES.1 };
        for replicate in 0..replicates {
            let batch = Instant::now();
            let sum: f64 = (0..points)
                .map(|point| {
                    let mut sampler = Sampler::sobol(points, 0, replicate, point as u32);
                    transport::radiance(method, &problem, place, direction, &mut sampler)[0]
                })
                .sum();
            // Short batches are timed with the clock's own steps.
            if points >= 32 {
                cost.seconds_per_path = cost.seconds_per_path.min(batch.elapsed().as_secs_f64() / points as f64);
            }
            let value = sum / points as f64;
            let off = value - mean;
            mean += off / (replicate + 1) as f64;
            squares += off * (value - mean);
        }
        let spread = (squares / (replicates - 1) as f64).sqrt();
        cost.radiance = (mean, spread / (replicates as f64).sqrt());
        let relative = spread / mean;
        if points == 1 {
            cost.deviation = relative;
        }
        if cost.paths_to_1_percent.is_nan() && relative <= 0.01 {
            cost.paths_to_1_percent = match last {
                Some((fewer, before)) => {
                    // relative = c n^-a between the two.
                    let power = (before / relative).ln() / (points as f64 / fewer).ln();
                    fewer * (before / 0.01).powf(1.0 / power)
                }
                None => 1.0,
            };
        }
        last = Some((points as f64, relative));
        let enough = !cost.paths_to_1_percent.is_nan() && points >= 64;
        if enough && start.elapsed().as_secs_f64() >= seconds {
            break;
        }
        points *= 2;
    }
    cost
}

/// The solved table of a case.
///
/// # Errors
/// [`SolveError`] never: the planet is round.
pub fn solve(medium: &Medium<1>) -> Result<Solved<1>, SolveError> {
    Solved::new(medium, SHAPE, [ALBEDO], &Resolution::RENDER)
}

/// The certificate of a table for a case's observer and sun.
#[must_use]
pub fn certificate<'a>(case: &Case, solved: &'a Solved<1>, columns: &Columns<1>) -> Certificate<'a, 1> {
    Certificate::new(solved, columns.clone(), Place::above(EYE_M), towards(case.sun_zenith_deg, 0.0))
}

/// Measures one direction by a certificate: fans, at least 64, until `seconds` have passed. A path is a fan here.
#[must_use]
pub fn measure_certified(certificate: &Certificate<'_, 1>, view: (f64, f64), seconds: f64) -> Cost {
    let direction = towards(view.0, view.1);
    let time = |fans: u32| {
        let start = Instant::now();
        let found = certificate.radiance(direction, Fan::SMALL, fans, 0, 0);
        (start.elapsed().as_secs_f64(), found)
    };
    let least = |fans: u32, times: u32| (0..times).map(|_| time(fans).0).fold(f64::INFINITY, f64::min);
    // What one more fan takes, and what comes before the first.
    let (few, many) = (least(2, 16), least(34, 4));
    let each = (many - few) / 32.0;
    let before = (few - 2.0 * each).max(0.0);
    let fans = ((seconds / each) as u32).clamp(64, 1 << 16);
    let (_, found) = time(fans);
    let (mean, error) = (found.mean[0], found.variance[0].sqrt());
    let deviation = error * f64::from(fans).sqrt() / mean;
    Cost {
        view,
        radiance: (mean, error),
        deviation,
        seconds_per_path: each,
        seconds_before: before,
        paths_to_1_percent: (deviation / 0.01).powi(2).max(1.0),
    }
}

/// The direction of a zenith angle and an azimuth from the sun, in degrees.
pub(crate) fn towards(zenith: f64, azimuth: f64) -> DVec3 {
    let ((sin, cos), (sin_a, cos_a)) = (zenith.to_radians().sin_cos(), azimuth.to_radians().sin_cos());
    DVec3::new(sin * cos_a, sin * sin_a, cos)
}

/// The columns of a case's medium.
#[must_use]
pub fn columns(medium: &Medium<1>) -> Columns<1> {
    Columns::new(medium, SHAPE, Tolerance::RENDER)
}
