//! Scenes drawn at random.

use crate::atmosphere::{Component, Medium, MediumError};
use crate::bench;
use crate::geometry::Shape;
use crate::light::{SunDisc, solar_angular_radius};
use crate::phase::{Phase, Tabulated};
use crate::sampling::{POINTS, Sampler};
use glam::DVec3;
use std::fmt::{Display, Formatter};
use std::sync::Arc;
use tables::units::KM;
use tables::{Axis, Curve, Interpolation, Outside, Scale, TableError};

/// Scenes that share an atmosphere and its tables, which cost more than the paths of one scene.
pub(super) const SHARE: u64 = 32;

/// Altitude in m to which profiles reach.
const REACH_M: f64 = 120.0 * KM;

/// What the air of a scene is, and the planet below it.
#[derive(Debug, Clone, PartialEq)]
pub struct Sky {
    /// Form of the planet.
    pub shape: Shape,
    /// Altitude of the top in m.
    pub top_m: f64,
    /// One wavelength or four in nm, 300 to 1000.
    pub wavelengths_nm: Vec<f64>,
    /// Whether there is ozone.
    pub ozone: bool,
    /// Optical depth of aerosol at the shortest wavelength, 0 to 5; `None` for no aerosol at all.
    pub aerosol: Option<f64>,
    /// Single-scattering albedo of aerosol, 0 to 1.
    pub single_albedo: f64,
    /// Asymmetry parameter of aerosol, 0 to 0.95; `None` for a table with a narrow peak and a gap.
    pub asymmetry: Option<f64>,
    /// Scale height of aerosol in m; `None` for an even layer that ends at 2 km.
    pub scale_m: Option<f64>,
}

/// A scene: a sky, a light, a ground, and a view of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// The air.
    pub sky: Sky,
    /// Elevation of the sun in degrees, -18 to 90; `None` for no sun.
    pub sun_elevation_deg: Option<f64>,
    /// Whether the sun is a parallel beam, not a disc.
    pub beam: bool,
    /// Whether light also enters evenly from all of space.
    pub environment: bool,
    /// Albedo of the ground at the shortest wavelength, 0 to 1.
    pub albedo: f64,
    /// Altitude of the observer in m.
    pub altitude_m: f64,
    /// Zenith angle of the view in degrees, 0 to 180.
    pub view_zenith_deg: f64,
    /// Azimuth of the view in degrees from the sun.
    pub view_azimuth_deg: f64,
}

/// The part of a unit interval that `u` lies in, the parts in proportion to `weights`, and where in it, 0 to 1.
pub(super) fn part<const N: usize>(u: f64, weights: [f64; N]) -> (usize, f64) {
    let mut rest = u * weights.iter().sum::<f64>();
    for (i, weight) in weights.into_iter().enumerate() {
        if rest < weight || i + 1 == N {
            return (i, (rest / weight).min(1.0));
        }
        rest -= weight;
    }
    (0, u)
}

/// Four numbers of thing number `number`, from set `set`.
pub(super) fn four(seed: u64, kind: u64, number: u64, set: u32) -> [f64; 4] {
    let mut sampler = Sampler::sobol(seed, u64::MAX - kind, number / POINTS, (number % POINTS) as u32);
    sampler.go_to(set);
    sampler.four()
}

impl Sky {
    /// Sky number `number` of a seed.
    #[must_use]
    pub fn new(seed: u64, number: u64) -> Self {
        let [radius, top, lanes, wavelength] = four(seed, 0, number, 0);
        let [amount, albedo, particles, layer] = four(seed, 0, number, 1);
        let first = 300.0 + 700.0 * wavelength;
        Self {
            shape: match part(radius, [0.1, 0.9]) {
                (0, _) => Shape::Flat,
                (_, u) => Shape::Sphere { radius_m: 1e5 * 1e5_f64.powf(u) },
            },
            top_m: [60.0, 86.0, 100.0, 120.0][part(top, [1.0; 4]).0] * KM,
            wavelengths_nm: match part(lanes, [0.5, 0.5]) {
                (0, _) => vec![first],
                (_, u) => {
                    (0..4).map(|i| 300.0 + 175.0 * (f64::from(i) + (wavelength + f64::from(i) * u) % 1.0)).collect()
                }
            },
            ozone: !(0.4..=0.6).contains(&lanes),
            aerosol: match part(amount, [0.1, 0.1, 0.3, 0.5]) {
                (0, _) => None,
                (1, _) => Some(0.0),
                (2, u) => Some(1e-4 * 1e4_f64.powf(u)),
                (_, u) => Some(5.0 * u),
            },
            single_albedo: match part(albedo, [0.1, 0.3, 0.6]) {
                (0, _) => 0.0,
                (1, _) => 1.0,
                (_, u) => u,
            },
            asymmetry: match part(particles, [0.3, 0.1, 0.6]) {
                (0, _) => None,
                (1, _) => Some(0.0),
                (_, u) => Some(0.95 * u),
            },
            scale_m: match part(layer, [0.4, 0.6]) {
                (0, _) => None,
                (_, u) => Some(500.0 + 4000.0 * u),
            },
        }
    }

    /// Coefficients at each wavelength.
    pub(super) fn medium<const L: usize>(&self) -> Result<Medium<L>, MediumError> {
        let um: [f64; L] = std::array::from_fn(|j| self.wavelengths_nm[j] * 1e-3);
        let molecules = um.map(bench::molecules);
        let mut components =
            vec![component(exponential(8.0 * KM)?, molecules, [0.0; L], Phase::Rayleigh { gamma: [0.015; L] })];
        if self.ozone {
            let axis = Axis::new("altitude", "m", vec![10.0 * KM, 25.0 * KM, 40.0 * KM])?.beyond(Outside::Zero);
            let density = Curve::new(axis, Scale::Linear, vec![0.0, 1.0, 0.0])?;
            // 300 DU of something like ozone: the Chappuis band, and the ultraviolet tail.
            let band = |um: f64| 5e-21 * (-((um - 0.6) / 0.07).powi(2)).exp() + 4e-19 * (-(um - 0.3) / 0.008).exp();
            components.push(component(
                density,
                [0.0; L],
                um.map(|um| 8.06e18 * band(um)),
                Phase::Rayleigh { gamma: [0.0; L] },
            ));
        }
        if let Some(depth) = self.aerosol {
            let depth = um.map(|x| depth * (x / um[0]).powf(-1.3));
            let phase = match self.asymmetry {
                Some(g) => Phase::HenyeyGreenstein { g: std::array::from_fn(|j| g * (1.0 - 0.05 * j as f64)) },
                None => peaked()?,
            };
            let density = match self.scale_m {
                Some(scale) => exponential(scale)?,
                None => {
                    let axis = Axis::new("altitude", "m", vec![0.0, 2.0 * KM])?.between(Interpolation::Step);
                    Curve::new(axis.beyond(Outside::Zero), Scale::Linear, vec![1.0, 1.0])?
                }
            };
            let (scatters, absorbs) = (self.single_albedo, 1.0 - self.single_albedo);
            components.push(component(density, depth.map(|d| d * scatters), depth.map(|d| d * absorbs), phase));
        }
        Medium::new(components, self.top_m)
    }
}

/// A component of given vertical optical depths.
fn component<const L: usize>(density: Curve, scatters: [f64; L], absorbs: [f64; L], phase: Phase<L>) -> Component<L> {
    let total = density.total();
    Component { density, scattering: scatters.map(|d| d / total), absorption: absorbs.map(|d| d / total), phase }
}

fn exponential(scale_m: f64) -> Result<Curve, TableError> {
    let axis = Axis::uniform("altitude", "m", 0.0, KM, (REACH_M / KM) as usize + 1)?;
    // What is so thin is nothing to the light, and something to the logarithm.
    let values = axis.nodes.iter().map(|z| (-z / scale_m).exp().max(1e-30)).collect();
    Curve::new(axis, Scale::Logarithmic, values)
}

/// A phase function with a peak of half a degree, a stretch of nothing, and a glory.
fn peaked<const L: usize>() -> Result<Phase<L>, MediumError> {
    let nodes = [(-1.0, 0.5), (-0.98, 0.1), (-0.3, 0.0), (-0.1, 0.0), (0.9, 1.0), (0.9999, 2e3), (1.0, 1e5)];
    let (cosines, values) = nodes.iter().map(|&(c, v)| (c, [v; L])).unzip();
    let table = Tabulated::new(cosines, values).ok_or_else(|| MediumError::Impossible("an unsound phase".into()))?;
    Ok(Phase::Tabulated(Arc::new(table)))
}

/// Zenith angle in degrees of the ground's horizon, or of the lowest altitude `lowest_m` of a line, seen from an altitude.
pub(super) fn grazing(shape: Shape, altitude_m: f64, lowest_m: f64) -> f64 {
    let Shape::Sphere { radius_m } = shape else { return 90.0 };
    let (r, p) = (radius_m + altitude_m, radius_m + lowest_m);
    90.0 + ((altitude_m - lowest_m).max(0.0) * (r + p)).sqrt().atan2(p).to_degrees()
}

/// Unit vector of a zenith angle and an azimuth in degrees; level and vertical exactly.
pub(super) fn towards(zenith_deg: f64, azimuth_deg: f64) -> DVec3 {
    let ((sin, cos), (sin_a, cos_a)) = (zenith_deg.to_radians().sin_cos(), azimuth_deg.to_radians().sin_cos());
    match zenith_deg {
        0.0 => DVec3::Z,
        90.0 => DVec3::new(cos_a, sin_a, 0.0),
        180.0 => -DVec3::Z,
        _ => DVec3::new(sin * cos_a, sin * sin_a, cos),
    }
}

impl Scene {
    /// Scene number `number` of a seed.
    #[must_use]
    pub fn new(seed: u64, number: u64) -> Self {
        Self::under(Sky::new(seed, number / SHARE), seed, number)
    }

    pub(super) fn under(sky: Sky, seed: u64, number: u64) -> Self {
        let [sun, view, where_to, height] = four(seed, 1, number, 0);
        let [turn, ground, light, fine] = four(seed, 1, number, 1);
        let top = sky.top_m;
        let heights =
            [0.0, 1e-3, 1.0, 2.0 * KM, 20.0 * KM, top - 1e-3, top.next_down(), top, 400.0 * KM, 36_000.0 * KM];
        let altitude_m = heights[part(height, [1.0, 1.0, 1.0, 1.0, 1.0, 0.5, 0.5, 1.0, 1.0, 1.0]).0];
        let sun_elevation_deg = match part(sun, [0.05, 0.05, 0.9]) {
            (0, _) => 0.0,
            (1, _) => 90.0,
            (_, u) => -18.0 + 108.0 * u,
        };
        let mut view_azimuth_deg = match part(turn, [0.15, 0.15, 0.7]) {
            (0, _) => 0.0,
            (1, _) => 180.0,
            (_, u) => 360.0 * u,
        };
        let view_zenith_deg = match part(view, [0.1, 0.35, 0.2, 0.05, 0.3]) {
            (0, _) => [0.0, 90.0, 180.0][part(where_to, [1.0; 3]).0],
            // From 1e-10 to 0.1 degrees above or below the horizon.
            (1, _) => {
                let (side, u) = part(where_to, [1.0, 1.0]);
                grazing(sky.shape, altitude_m, 0.0) + (2.0 * side as f64 - 1.0) * 10_f64.powf(9.0 * u - 10.0)
            }
            // By the lowest altitude of the line: what far observers see of the air.
            (2, _) => grazing(sky.shape, altitude_m, top * (1.2 * where_to - 0.2)),
            (3, _) => {
                view_azimuth_deg = 0.0;
                90.0 - sun_elevation_deg
            }
            (_, _) => 180.0 * where_to,
        };
        let (light, _) = part(light, [0.6, 0.2, 0.1, 0.1]);
        Self {
            sky,
            sun_elevation_deg: (light < 3).then_some(sun_elevation_deg),
            beam: light == 1,
            environment: light >= 2,
            albedo: match part(ground, [0.15, 0.15, 0.7]) {
                (0, _) => 0.0,
                (1, _) => 1.0,
                (_, _) => fine,
            },
            altitude_m,
            view_zenith_deg,
            view_azimuth_deg,
        }
    }

    pub(super) fn sun<const L: usize>(&self) -> Option<SunDisc<L>> {
        let direction = towards(90.0 - self.sun_elevation_deg?, 0.0);
        let darkened = || SunDisc::darkened(direction, solar_angular_radius(), vec![[0.3; L], [0.7; L]]);
        Some(if self.beam { SunDisc::beam(direction) } else { darkened() })
    }
}

impl Display for Scene {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { sky, altitude_m, albedo, view_zenith_deg, view_azimuth_deg, .. } = self;
        match sky.shape {
            Shape::Flat => write!(f, "a plane")?,
            Shape::Sphere { radius_m } => write!(f, "a planet of radius {} km", radius_m / KM)?,
        }
        write!(f, ", ground albedo {albedo}, air up to {} km, {:?} nm", sky.top_m / KM, sky.wavelengths_nm)?;
        write!(f, ", {} ozone", if sky.ozone { "with" } else { "without" })?;
        match sky.aerosol {
            None => write!(f, ", no aerosol")?,
            Some(depth) => {
                write!(f, ", aerosol of optical depth {depth}, single-scattering albedo {}", sky.single_albedo)?;
                match sky.asymmetry {
                    Some(g) => write!(f, ", Henyey-Greenstein {g}")?,
                    None => write!(f, ", a table with a peak")?,
                }
                match sky.scale_m {
                    Some(scale) => write!(f, ", scale height {scale} m")?,
                    None => write!(f, ", a layer up to 2 km")?,
                }
            }
        }
        match (self.sun_elevation_deg, self.beam) {
            (None, _) => write!(f, "; no sun")?,
            (Some(deg), true) => write!(f, "; a parallel sun at elevation {deg} degrees")?,
            (Some(deg), false) => write!(f, "; the sun's disc at elevation {deg} degrees")?,
        }
        write!(f, "{}", if self.environment { ", light from all of space" } else { "" })?;
        write!(f, "; seen from {altitude_m} m at zenith angle {view_zenith_deg}, azimuth {view_azimuth_deg} degrees")
    }
}
