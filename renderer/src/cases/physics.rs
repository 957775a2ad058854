//! From a case to something that can be sampled.

use super::input::{Case, Layer, Profile};
use super::{Effort, Method, Settings, TABLES};
use crate::atmosphere::{Columns, Component, Medium, Tolerance};
use crate::geometry::{Place, Shape};
use crate::light::SunDisc;
use crate::phase::Phase;
use crate::polarisation::{Frame, Stokes};
use crate::sampling::{Sampler, cosine_hemisphere};
use crate::transport::{
    self, Certificate, Estimator, FINER, Fan, Problem, Resolution, SolveError, Solved, covers_planet,
};
use glam::DVec3;
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::sync::Arc;
use tables::units::{EARTH_RADIUS_M, KM};
use tables::{Axis, Curve, Interpolation, Outside, Scale};

/// Thickness in m given to a plane-parallel layer: only its optical depth counts.
const LAYER_M: f64 = 1000.0;

/// A quantity to estimate.
#[derive(Debug)]
pub(super) struct Estimand {
    medium: Medium<1>,
    tables: Tables,
    shape: Shape,
    albedo: f64,
    sun: SunDisc<1>,
    max_orders: Option<u32>,
    place: Place,
    quantity: Quantity,
    /// Whether transfer is polarised.
    polarised: bool,
    f0: f64,
}

/// Relative error of what solved tables have in common with coarser ones, of single scattering and of all orders.
const UNSEEN: (f64, f64) = (2e-4, 5e-4);

/// Fans of a certificate's pilot, which only tells how many are needed, and the most.
const PILOT_FANS: u32 = 32;
const MOST_FANS: u32 = 1 << 14;

/// What a radiance is found with.
#[derive(Debug)]
enum Tables {
    Columns(Estimator, Arc<Columns<1>>),
    Solved(Arc<Pair>),
    Certified(Arc<Pair>, Arc<Columns<1>>),
}

/// A solved table, and a coarser one that tells how exact it is; none of single scattering, and of what is certified.
#[derive(Debug)]
struct Pair {
    solved: Solved<1>,
    coarse: Option<Solved<1>>,
}

impl Pair {
    fn new(medium: &Medium<1>, shape: Shape, albedo: f64, kind: (bool, bool)) -> Result<Self, SolveError> {
        let (single, polarised) = kind;
        if single {
            return Ok(Self { solved: Solved::single(medium, shape, [albedo])?, coarse: None });
        }
        covers_planet(shape)?;
        let fine = Resolution::FINE;
        let coarser = Resolution { degree: fine.degree, ..Resolution::RENDER };
        let solve = if polarised { Solved::polarised } else { Solved::new };
        let coarse = solve(medium, shape, [albedo], &coarser)?;
        let solved = coarse.again(&fine, None)?;
        Ok(Self { solved, coarse: Some(coarse) })
    }

    /// The usual table alone, for a certificate.
    fn usual(medium: &Medium<1>, shape: Shape, albedo: f64, polarised: bool) -> Result<Self, SolveError> {
        covers_planet(shape)?;
        let solve = if polarised { Solved::polarised } else { Solved::new };
        Ok(Self { solved: solve(medium, shape, [albedo], &Resolution::RENDER)?, coarse: None })
    }
}

/// What is asked at the place.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Quantity {
    /// Radiance looked at, or another Stokes parameter of it.
    Radiance(Look, Parameter),
    /// Irradiance of the beam on a level plane.
    Direct,
    /// Irradiance from everything but the beam on a level plane that faces up.
    Diffuse,
    /// Radiant exitance of the ground.
    Reflected,
    /// Irradiance on a level plane at the top that faces down.
    Upward,
}

/// A direction looked in, with the unit vector towards growing azimuth, which the direction alone does not tell at the zenith.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Look {
    direction: DVec3,
    sideways: DVec3,
}

/// A Stokes parameter, referred to e1 sideways and e2 towards the zenith: Q is horizontal light less vertical.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Parameter {
    I,
    Q,
    U,
}

impl Parameter {
    fn of(self, Stokes { i, q, u }: Stokes) -> f64 {
        match self {
            Self::I => i,
            Self::Q => q,
            Self::U => u,
        }
    }
}

/// One estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    pub(super) value: f64,
    /// What its error is judged by: the radiance for a Stokes parameter, else the value itself.
    pub(super) scale: f64,
}

impl Estimand {
    /// The value where no sampling is needed: the beam, and what a black ground reflects.
    pub(super) fn exact(&self) -> Option<f64> {
        match self.quantity {
            Quantity::Direct => Some(self.direct()),
            Quantity::Reflected if self.albedo == 0.0 => Some(0.0),
            Quantity::Reflected if self.max_orders == Some(1) => Some(self.albedo * self.direct()),
            _ => None,
        }
    }

    /// Irradiance of the beam.
    pub(super) fn f0(&self) -> f64 {
        self.f0
    }

    /// The value with its error, if the case is solved rather than sampled.
    pub(super) fn solution(&self) -> Option<(f64, f64)> {
        match (&self.tables, self.quantity) {
            (Tables::Solved(pair), Quantity::Radiance(look, parameter)) => Some(self.solved(pair, look, parameter)),
            _ => None,
        }
    }

    /// A Stokes parameter from solved tables, and its error: [`FINER`] of the distance from the coarser one, and [`UNSEEN`] of the
    /// radiance.
    fn solved(&self, pair: &Pair, look: Look, parameter: Parameter) -> (f64, f64) {
        let Look { direction, sideways } = look;
        let sun = self.sun.direction();
        let look = |solved: &Solved<1>, single: bool| {
            let seen = if self.polarised {
                solved.stokes(self.place, direction, Frame::new(direction, sideways), sun, single)[0]
            } else {
                Stokes { i: solved.radiance(self.place, direction, sun, single)[0], ..Stokes::default() }
            };
            (self.f0 * parameter.of(seen), self.f0 * seen.i)
        };
        match &pair.coarse {
            None => {
                let (value, radiance) = look(&pair.solved, true);
                (value, UNSEEN.0 * radiance)
            }
            Some(coarse) => {
                let (value, radiance) = look(&pair.solved, false);
                (value, (FINER * (value - look(coarse, false).0)).hypot(UNSEEN.1 * radiance))
            }
        }
    }

    /// The mean of fans that end in a solved table, its standard error, and how many fans; if the case is certified. What single
    /// scattering and the columns may be off is in the error: relative to the radiance, and to the sun ([`TABLES`]).
    pub(super) fn certified(&self, settings: &Settings, index: u64) -> Option<(f64, f64, u64)> {
        let (Tables::Certified(pair, columns), Quantity::Radiance(Look { direction, sideways }, parameter)) =
            (&self.tables, self.quantity)
        else {
            return None;
        };
        let certificate = Certificate::new(&pair.solved, Columns::clone(columns), self.place, self.sun.direction());
        let look = (direction, Frame::new(direction, sideways));
        // Mean, variance and radiance.
        let mean = |fans: u32, seed: u64| {
            let both =
                certificate.stokes(look, |seen| [parameter.of(*seen), seen.i], (Fan::SMALL, fans), (seed, index));
            let radiance = || certificate.radiance(direction, Fan::SMALL, fans, seed, index);
            let [found, radiance] = both.unwrap_or_else(|| [radiance(); 2]);
            (found.mean[0], found.variance[0], radiance.mean[0])
        };
        let fans = match settings.effort {
            Effort::Paths(fans) => u32::try_from(fans).unwrap_or(u32::MAX),
            // The pilot is thrown away, so that it does not decide what the mean is.
            Effort::Error(error) => {
                let (_, variance, radiance) = mean(PILOT_FANS, !settings.seed);
                let wanted = (error * radiance).powi(2);
                // A relative error cannot be had of nothing.
                let fans = if wanted > 0.0 { 1.1 * f64::from(PILOT_FANS) * variance / wanted } else { 0.0 };
                fans.ceil().clamp(f64::from(PILOT_FANS), f64::from(MOST_FANS)) as u32
            }
        };
        let (value, variance, radiance) = mean(fans, settings.seed);
        let error = variance.sqrt().hypot(UNSEEN.0 * radiance).hypot(TABLES.1);
        Some((self.f0 * value, self.f0 * error, u64::from(fans)))
    }

    /// mu_0 exp(-tau) F_0 at the place.
    fn direct(&self) -> f64 {
        let sun = self.sun.direction();
        let [through] = self.medium.transmittance(self.shape, self.place, sun);
        self.f0 * self.place.up.dot(sun).max(0.0) * through
    }

    /// One unbiased estimate. A flux is pi times the mean radiance over directions with
    /// the density cos(theta)/pi.
    pub(super) fn sample(&self, sampler: &mut Sampler) -> Sample {
        let flux = |facing: DVec3, sampler: &mut Sampler| {
            let [u, v, ..] = sampler.four();
            let direction = cosine_hemisphere(facing, [u, v]);
            PI * self.stokes(Look { direction, sideways: direction.any_orthonormal_vector() }, sampler).i
        };
        let value = match self.quantity {
            Quantity::Radiance(look, parameter) => {
                let seen = self.stokes(look, sampler);
                return Sample { value: parameter.of(seen), scale: seen.i };
            }
            Quantity::Direct => self.direct(),
            Quantity::Diffuse => flux(self.place.up, sampler),
            // The reflection is an order of its own: see `stokes`.
            Quantity::Reflected => self.albedo * (self.direct() + flux(self.place.up, sampler)),
            Quantity::Upward => flux(-self.place.up, sampler),
        };
        Sample { value, scale: value }
    }

    /// What is seen in a direction; scalar transfer knows only I.
    fn stokes(&self, look: Look, sampler: &mut Sampler) -> Stokes {
        let Look { direction, sideways } = look;
        let (estimator, columns) = match &self.tables {
            Tables::Columns(estimator, columns) => (*estimator, columns),
            Tables::Solved(_) | Tables::Certified(..) => {
                unreachable!("only radiances are solved, and those are not sampled")
            }
        };
        let problem = Problem {
            texture: None,
            shape: self.shape,
            medium: &self.medium,
            columns,
            albedo: [self.albedo],
            sun: Some(&self.sun),
            environment: None,
            max_orders: self.max_orders.map(|n| if self.quantity == Quantity::Reflected { n - 1 } else { n }),
        };
        let mut seen = Stokes::default();
        if self.polarised {
            let frame = Frame::new(direction, sideways);
            [seen] = transport::stokes(estimator, &problem, self.place, direction, frame, sampler);
        } else {
            [seen.i] = transport::radiance(estimator, &problem, self.place, direction, sampler);
        }
        Stokes { i: self.f0 * seen.i, q: self.f0 * seen.q, u: self.f0 * seen.u }
    }
}

/// What several cases share, since it depends on the profile, the planet and the ground and on nothing else: columns, and
/// solved tables where they are asked for.
#[derive(Debug, Default)]
pub(super) struct Shared {
    columns: BTreeMap<(String, u64), Arc<Columns<1>>>,
    solved: BTreeMap<Ground, Arc<Pair>>,
}

/// Profile, radius, ground, and whatever else a solution depends on.
type Ground = (String, u64, u64, String);

impl Shared {
    fn key(case: &Case) -> Option<(String, u64)> {
        let profile = case.profile.clone()?;
        (case.geometry == "spherical").then(|| (profile, case.planet_radius_km.map_or(0, f64::to_bits)))
    }

    fn ground_key(case: &Case) -> Option<Ground> {
        let phase = format!("{:?} {} {:?}", case.phase, case.orders, polarised(case));
        Self::key(case).map(|(profile, radius)| (profile, radius, case.albedo.to_bits(), phase))
    }

    /// Makes what the method needs for those cases that are not refused for their air.
    pub(super) fn new<'a>(
        cases: impl Iterator<Item = &'a Case>,
        profiles: &BTreeMap<String, Profile>,
        method: Method,
    ) -> Self {
        let mut shared = Self::default();
        for case in cases {
            let (Some(key), Some(ground)) = (Self::key(case), Self::ground_key(case)) else { continue };
            // What is refused needs no table.
            let answers = match method {
                Method::Solved => true,
                Method::Certified => case.orders == "all",
                Method::Sampled(_) => false,
            };
            let solves = answers && !shared.solved.contains_key(&ground);
            let columns = method != Method::Solved && !shared.columns.contains_key(&key);
            if !solves && !columns {
                continue;
            }
            let Ok((shape, medium)) = air(case, profiles) else { continue };
            if columns {
                shared.columns.insert(key, Arc::new(Columns::new(&medium, shape, Tolerance::RENDER)));
            }
            if solves {
                let polarised = polarised(case) == Ok(true);
                let pair = if method == Method::Certified {
                    Pair::usual(&medium, shape, case.albedo, polarised)
                } else {
                    Pair::new(&medium, shape, case.albedo, (case.orders == "1", polarised))
                };
                if let Ok(pair) = pair {
                    shared.solved.insert(ground, Arc::new(pair));
                }
            }
        }
        shared
    }

    fn columns(&self, case: &Case, shape: Shape, medium: &Medium<1>) -> Arc<Columns<1>> {
        let ready = Self::key(case).and_then(|key| self.columns.get(&key)).cloned();
        ready.unwrap_or_else(|| Arc::new(Columns::new(medium, shape, Tolerance::RENDER)))
    }

    fn solved(&self, case: &Case) -> Option<Arc<Pair>> {
        Self::ground_key(case).and_then(|key| self.solved.get(&key)).cloned()
    }
}

/// Radii in km over which column tables keep their transmittances (`airlight study stability`, planets-columns).
const PLANETS_KM: (f64, f64) = (10.0, 1e7);

/// The planet's form and the atmosphere of a case.
fn air(case: &Case, profiles: &BTreeMap<String, Profile>) -> Result<(Shape, Medium<1>), String> {
    match case.geometry.as_str() {
        "plane-parallel" => {
            let layers = case.layers.as_ref().ok_or("a plane-parallel case needs layers")?;
            Ok((Shape::Flat, layered(layers)?))
        }
        "spherical" => {
            let radius_m = case.planet_radius_km.map_or(EARTH_RADIUS_M, |km| km * KM);
            ranged("planet_radius_km", radius_m / KM, PLANETS_KM.0, PLANETS_KM.1)?;
            let name = case.profile.as_ref().ok_or("a spherical case needs a profile")?;
            let profile = profiles.get(name).ok_or_else(|| format!("no profile named {name:?} in the file"))?;
            Ok((Shape::Sphere { radius_m }, spherical(profile, case.phase.as_deref())?))
        }
        other => Err(format!("geometry {other:?} is neither plane-parallel nor spherical")),
    }
}

/// Whether transfer is polarised.
fn polarised(case: &Case) -> Result<bool, String> {
    let stokes = case.quantity.starts_with("stokes_");
    match case.polarization.as_str() {
        "vector" => Ok(true),
        "any" => Ok(stokes),
        "scalar" if stokes => Err("scalar transfer has no Stokes parameters".into()),
        "scalar" => Ok(false),
        other => Err(format!("polarization {other:?} is neither scalar, vector nor any")),
    }
}

/// Makes a case ready, or says in a phrase why it is refused.
pub(super) fn prepare(
    case: &Case,
    profiles: &BTreeMap<String, Profile>,
    shared: &Shared,
    method: Method,
) -> Result<Estimand, String> {
    let polarised = polarised(case)?;
    let max_orders = match case.orders.as_str() {
        "all" => None,
        text => Some(
            text.parse()
                .ok()
                .filter(|&n| n > 0)
                .ok_or_else(|| format!("orders must be \"all\" or a number from 1, not {text:?}"))?,
        ),
    };
    ranged("sza_deg", case.sza_deg, 0.0, 180.0)?;
    ranged("albedo", case.albedo, 0.0, 1.0)?;
    ranged("F0", case.f0, 0.0, f64::MAX)?;
    let (shape, medium) = air(case, profiles)?;
    if polarised && !medium.polarises() {
        return Err("a phase function hg has no scattering matrix, so no polarised transfer".into());
    }
    // A flux is that of the place in its name.
    let altitude_m = match (case.quantity.as_str(), case.observer.as_str(), case.observer_alt_km) {
        ("flux_up_top", ..) => medium.top_m(),
        (flux, ..) if flux.starts_with("flux") => 0.0,
        (_, "top", None) => medium.top_m(),
        (_, "ground" | "bottom", None) => 0.0,
        (_, _, Some(km)) => km * KM,
        (_, other, None) => return Err(format!("observer {other:?} needs observer_alt_km")),
    };
    ranged("observer_alt_km", altitude_m / KM, 0.0, 1e9)?;
    let (sin, cos) = case.sza_deg.to_radians().sin_cos();
    let quantity = match case.quantity.as_str() {
        "radiance" | "stokes_I" => Quantity::Radiance(view(case)?, Parameter::I),
        "stokes_Q" => Quantity::Radiance(view(case)?, Parameter::Q),
        "stokes_U" => Quantity::Radiance(view(case)?, Parameter::U),
        "flux_down_direct_ground" => Quantity::Direct,
        "flux_down_diffuse_ground" => Quantity::Diffuse,
        "flux_up_ground" => Quantity::Reflected,
        "flux_up_top" => Quantity::Upward,
        other => return Err(format!("quantity {other:?} is not offered")),
    };
    let tables = match method {
        Method::Sampled(estimator) => Tables::Columns(estimator, shared.columns(case, shape, &medium)),
        Method::Certified if max_orders.is_some() => return Err("certificates are of all orders".into()),
        Method::Solved | Method::Certified => {
            if max_orders.is_some_and(|orders| orders > 1) {
                return Err("a solved table has one order or all".into());
            }
            if !matches!(quantity, Quantity::Radiance(..)) {
                return Err("solved tables answer radiances".into());
            }
            let pair = shared.solved(case).ok_or("solved tables need a round planet")?;
            if method == Method::Certified {
                Tables::Certified(pair, shared.columns(case, shape, &medium))
            } else {
                Tables::Solved(pair)
            }
        }
    };
    Ok(Estimand {
        tables,
        medium,
        shape,
        albedo: case.albedo,
        sun: SunDisc::beam(DVec3::new(sin, 0.0, cos)),
        max_orders,
        place: Place::above(altitude_m),
        quantity,
        polarised,
        f0: case.f0,
    })
}

fn view(case: &Case) -> Result<Look, String> {
    let zenith = case.view_zenith_deg.ok_or("a radiance needs view_zenith_deg")?;
    let azimuth = case.view_dphi_deg.ok_or("a radiance needs view_dphi_deg")?;
    ranged("view_zenith_deg", zenith, 0.0, 180.0)?;
    ranged("view_dphi_deg", azimuth, -360.0, 360.0)?;
    if case.geometry == "plane-parallel" && zenith == 90.0 {
        return Err("a level view in plane-parallel layers never ends".into());
    }
    let (sin, cos) = zenith.to_radians().sin_cos();
    let (sin_azimuth, cos_azimuth) = azimuth.to_radians().sin_cos();
    Ok(Look {
        direction: DVec3::new(sin * cos_azimuth, sin * sin_azimuth, cos),
        sideways: DVec3::new(-sin_azimuth, cos_azimuth, 0.0),
    })
}

fn ranged(name: &str, value: f64, low: f64, high: f64) -> Result<(), String> {
    if (low..=high).contains(&value) {
        Ok(())
    } else {
        Err(format!("{name} must be from {low} to {high}, not {value}"))
    }
}

/// A phase function of the files: `rayleigh` with the depolarisation rho, gamma = rho / (2 - rho), or
/// `hg` with g.
fn phase(kind: &str, parameter: f64) -> Result<Phase<1>, String> {
    match kind {
        "rayleigh" => {
            ranged("depolarisation", parameter, 0.0, 0.9)?;
            Ok(Phase::Rayleigh { gamma: [parameter / (2.0 - parameter)] })
        }
        "hg" => {
            ranged("g", parameter, -0.9999, 0.9999)?;
            Ok(Phase::HenyeyGreenstein { g: [parameter] })
        }
        other => Err(format!("phase function {other:?} is neither rayleigh nor hg")),
    }
}

/// Homogeneous layers, listed from the top down: each phase function of each
/// layer is a component, present in that layer alone.
fn layered(layers: &[Layer]) -> Result<Medium<1>, String> {
    let count = layers.len();
    if count == 0 {
        return Err("no layers".into());
    }
    let top = count as f64 * LAYER_M;
    let mut components = Vec::new();
    for (from_top, layer) in layers.iter().enumerate() {
        ranged("tau", layer.tau, 0.0, 1e6)?;
        ranged("ssa", layer.ssa, 0.0, 1.0)?;
        let weights = total_weight(&layer.phase)?;
        let bottom = (count - 1 - from_top) as f64 * LAYER_M;
        let density = slab(bottom, bottom + LAYER_M)?;
        for (weight, kind, parameter) in &layer.phase {
            let share = weight / weights * layer.tau / LAYER_M;
            components.push(Component {
                density: density.clone(),
                scattering: [share * layer.ssa],
                absorption: [share * (1.0 - layer.ssa)],
                phase: phase(kind, *parameter)?,
            });
        }
    }
    Medium::new(components, top).map_err(|e| e.to_string())
}

/// The sum of the weights of phase functions, which must be 1.
fn total_weight(phases: &[(f64, String, f64)]) -> Result<f64, String> {
    let sum: f64 = phases.iter().map(|(weight, ..)| weight).sum();
    if phases.iter().any(|(weight, ..)| *weight < 0.0) || !(1.0 - 1e-6..=1.0 + 1e-6).contains(&sum) {
        return Err(format!("the weights of phase functions must be positive and add up to 1, not {sum}"));
    }
    Ok(sum)
}

/// 1 between two altitudes in m and 0 elsewhere.
fn slab(bottom: f64, top: f64) -> Result<Curve, String> {
    let axis = Axis::new("altitude", "m", vec![bottom, top]).map_err(|e| e.to_string())?;
    let axis = axis.between(Interpolation::Step).beyond(Outside::Zero);
    Curve::new(axis, Scale::Linear, vec![1.0, 1.0]).map_err(|e| e.to_string())
}

/// A piecewise linear profile, with one mixture of phase functions for all of it or
/// components that have their own.
fn spherical(profile: &Profile, phases: Option<&[(f64, String, f64)]>) -> Result<Medium<1>, String> {
    let axis = Axis::new("altitude", "m", profile.z_km.iter().map(|z| z * KM).collect()).map_err(|e| e.to_string())?;
    let axis = axis.beyond(Outside::Zero);
    let top = axis.range().1;
    let curve = |per_km: &[f64], share: f64| -> Result<Curve, String> {
        if per_km.iter().any(|&v| v < 0.0) {
            return Err("a coefficient of the profile is negative".into());
        }
        Curve::new(axis.clone(), Scale::Linear, per_km.iter().map(|v| share * v / KM).collect())
            .map_err(|e| e.to_string())
    };
    let mut components = Vec::new();
    let mut add = |per_km: &[f64], share: f64, scattering: f64, phase: Phase<1>| -> Result<(), String> {
        if per_km.iter().any(|&v| v != 0.0) {
            components.push(Component {
                density: curve(per_km, share)?,
                scattering: [scattering],
                absorption: [1.0 - scattering],
                phase,
            });
        }
        Ok(())
    };
    let none = Phase::Rayleigh { gamma: [0.0] };
    if let Some(parts) = &profile.components {
        for part in parts.all() {
            if part.scattering_per_km.iter().any(|&v| v != 0.0) {
                add(&part.scattering_per_km, 1.0, 1.0, phase(&part.phase.0, part.phase.1)?)?;
            }
            add(&part.absorption_per_km, 1.0, 0.0, none.clone())?;
        }
    } else {
        let scattering =
            profile.scattering_per_km.as_ref().ok_or("the profile has neither scattering_per_km nor components")?;
        let phases = phases.ok_or("a case with a plain profile needs a phase")?;
        let weights = total_weight(phases)?;
        for (weight, kind, parameter) in phases {
            add(scattering, weight / weights, 1.0, phase(kind, *parameter)?)?;
        }
        if let Some(absorption) = &profile.absorption_per_km {
            add(absorption, 1.0, 0.0, none)?;
        }
    }
    Medium::new(components, top).map_err(|e| e.to_string())
}
