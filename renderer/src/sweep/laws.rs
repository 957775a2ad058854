//! Laws of single scattering that hold whatever the scene; what the noise of an estimate explains is not counted.
//!
//! *Empty space changes nothing.* On one line of sight a radiance is the same from everywhere above the air, and from
//! just below the top it lacks what the last metre of air adds: observers a metre below, at and a metre above the top agree.
//!
//! *The horizon has no seam.* Over a black ground a line that just misses the ground and one that just meets it are the
//! same as far as the foot of the lower. So the radiance above the horizon is that below it, and what the upper line
//! collects beyond the foot, dimmed on the way. The latter, and the whole of the upper line too, is summed
//! here without tables of columns.

use super::scene::{SHARE, Scene, four, grazing, towards};
use super::{World, transport};
use crate::atmosphere::Medium;
use crate::geometry::{End, Place, Ray, Shape};
use crate::light::SunDisc;
use crate::sampling::Sampler;
use crate::transport::{Estimator, Problem};
use glam::DVec3;
use rayon::prelude::*;
use tables::units::KM;

/// Largest relative departure from a law that interpolation and quadrature may make.
pub const LAW: f64 = 1e-3;

/// Independent Sobol sequences that a radiance is the mean of.
const REPLICATES: u32 = 8;

/// Standard errors by which the noise of an estimate may miss: chance does so in less than one of 1e5, for the tails of
/// eight sequences are Student's.
const NOISE: f64 = 10.0;

/// Points of each sequence, for each wavelength.
const POINTS: u32 = 1024;

/// Cells of a sum without tables, on either side of the foot.
const CELLS: u32 = 4096;

/// How far from the horizon in degrees.
const HAIR_DEG: f64 = 1e-6;

/// The largest departure from a law, relative to the radiance, and where.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Departure {
    /// Share of the radiance.
    pub relative: f64,
    /// Number of the scene whose sky, sun and azimuth these are.
    pub scene: u64,
}

/// How well the laws are kept.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Laws {
    /// Radiances across the top.
    pub top: Departure,
    /// Radiances across the horizon.
    pub horizon: Departure,
    /// A radiance just above the horizon against the sum without tables.
    pub sum: Departure,
}

impl Departure {
    fn or(self, other: Self) -> Self {
        if self.relative >= other.relative { self } else { other }
    }
}

impl Laws {
    /// Whether all are kept to within [`LAW`].
    #[must_use]
    pub fn kept(&self) -> bool {
        [self.top, self.horizon, self.sum].iter().all(|departure| departure.relative <= LAW)
    }

    fn or(self, other: Self) -> Self {
        Self { top: self.top.or(other.top), horizon: self.horizon.or(other.horizon), sum: self.sum.or(other.sum) }
    }
}

/// The laws under the first `skies` skies of a seed.
#[must_use]
pub fn laws(seed: u64, skies: u64) -> Laws {
    let under = |number: u64| {
        let scene = Scene::new(seed, number * SHARE);
        match scene.sky.wavelengths_nm.len() {
            1 => check::<1>(scene, seed, number),
            _ => check::<4>(scene, seed, number),
        }
    };
    (0..skies).into_par_iter().map(under).reduce(Laws::default, Laws::or)
}

fn check<const L: usize>(scene: Scene, seed: u64, number: u64) -> Laws {
    let depart = |relative: f64| Departure { relative, scene: number * SHARE };
    // A sky that is refused keeps no law.
    let Ok(world) = World::<L>::new(&scene.sky) else {
        return Laws { top: depart(f64::INFINITY), ..Laws::default() };
    };
    let scene = Scene { environment: false, ..scene };
    let [side, height, elevation, _] = four(seed, 2, number, 0);
    let mut laws = Laws { top: depart(across_top(&world, &scene, side, height)), ..Laws::default() };
    if let Shape::Sphere { .. } = scene.sky.shape {
        // A sun that all of the line sees, or on small planets some of it.
        let scene = Scene { sun_elevation_deg: Some(5.0 + 80.0 * elevation), beam: true, albedo: 0.0, ..scene };
        for altitude in [1.0, 2.0 * KM] {
            let [horizon, sum] = across_horizon(&world, &scene, altitude).map(depart);
            laws = laws.or(Laws { horizon, sum, ..Laws::default() });
        }
    }
    laws
}

/// Singly scattered radiance in sr^-1, and its standard error.
fn single<const L: usize>(problem: &Problem<'_, L>, from: Place, direction: DVec3) -> [[f64; L]; 2] {
    let points = POINTS * L as u32;
    let (mut sum, mut squares) = ([0.0; L], [0.0; L]);
    for replicate in 0..REPLICATES {
        let mut mean = [0.0; L];
        for point in 0..points {
            let mut sampler = Sampler::sobol(0, 0, u64::from(replicate), point);
            let radiance = transport::radiance(Estimator::Paths, problem, from, direction, &mut sampler);
            for (mean, radiance) in mean.iter_mut().zip(radiance) {
                *mean += radiance / f64::from(points);
            }
        }
        for j in 0..L {
            sum[j] += mean[j];
            squares[j] += mean[j] * mean[j];
        }
    }
    let n = f64::from(REPLICATES);
    let mean = sum.map(|sum| sum / n);
    let error = std::array::from_fn(|j| ((squares[j] / n - mean[j] * mean[j]).max(0.0) / (n - 1.0)).sqrt());
    [mean, error]
}

/// Largest at a wavelength of what |a - b| exceeds `noise` by, in shares of `whole`.
fn apart<const L: usize>(a: &[f64; L], b: &[f64; L], noise: &[f64; L], whole: &[f64; L]) -> f64 {
    let relative = |j: usize| if a[j] == b[j] { 0.0 } else { ((a[j] - b[j]).abs() - noise[j]).max(0.0) / whole[j] };
    // Not a number is the largest departure.
    (0..L).map(relative).fold(0.0, |most, r| if r <= most { most } else { r })
}

/// Looks down (`side` below 1/2) or at the limb, no closer to the top than a tenth of its altitude, from three places of one line.
fn across_top<const L: usize>(world: &World<L>, scene: &Scene, side: f64, height: f64) -> f64 {
    let (shape, top) = (scene.sky.shape, scene.sky.top_m);
    let zenith = if side < 0.5 || shape == Shape::Flat {
        let horizon = grazing(shape, top, 0.0).max(91.0);
        horizon + height * (180.0 - horizon)
    } else {
        grazing(shape, top, 0.9 * top * height)
    };
    let direction = towards(zenith, scene.view_azimuth_deg);
    let scene = Scene { sun_elevation_deg: scene.sun_elevation_deg.or(Some(30.0)), ..scene.clone() };
    let sun = scene.sun();
    let problem = Problem { max_orders: Some(1), ..world.problem(&scene, sun.as_ref()) };
    let at = |above: f64| {
        let place = Place::above(top).advance(shape, direction, above / direction.z);
        single(&problem, if above == 0.0 { Place::above(top) } else { place }, direction)[0]
    };
    let [below, edge, above] = [-1.0, 0.0, 1.0].map(at);
    // All three have the same random numbers, so noise does not part them.
    let none = [0.0; L];
    apart(&below, &edge, &none, &edge).max(apart(&above, &edge, &none, &edge))
}

/// Departures from the law of the horizon and from the sum.
fn across_horizon<const L: usize>(world: &World<L>, scene: &Scene, altitude_m: f64) -> [f64; 2] {
    let (shape, place) = (scene.sky.shape, Place::above(altitude_m));
    let horizon = grazing(shape, altitude_m, 0.0);
    let [upper, lower] = [-HAIR_DEG, HAIR_DEG].map(|hair| towards(horizon + hair, scene.view_azimuth_deg));
    let mut segments = Vec::new();
    let End::Ground(foot) = Ray::new(shape, place, lower).segments(world.medium.bounds(), &mut segments) else {
        return [f64::INFINITY; 2];
    };
    let End::Space = Ray::new(shape, place, upper).segments(world.medium.bounds(), &mut segments) else {
        return [f64::INFINITY; 2];
    };
    let end = segments.last().map_or(foot, |segment| segment.end_m);
    let Some(sun) = scene.sun() else { return [f64::INFINITY; 2] };
    let mut walk = Walk { medium: &world.medium, shape, place, direction: upper, sun: &sun, depth: [0.0; L] };
    let (near, far) = (walk.sum(0.0, foot), walk.sum(foot, end));
    let whole = std::array::from_fn(|j| near[j] + far[j]);
    let problem = Problem { max_orders: Some(1), ..world.problem(scene, Some(&sun)) };
    let [[above, error], [below, error_below]] = [upper, lower].map(|direction| single(&problem, place, direction));
    let joined = std::array::from_fn(|j| below[j] + far[j]);
    let noise = error.map(|error| NOISE * error);
    let both = std::array::from_fn(|j| NOISE * error[j].hypot(error_below[j]));
    [apart(&above, &joined, &both, &whole), apart(&above, &whole, &noise, &whole)]
}

/// A line of sight without tables.
struct Walk<'a, const L: usize> {
    medium: &'a Medium<L>,
    shape: Shape,
    place: Place,
    direction: DVec3,
    sun: &'a SunDisc<L>,
    /// Optical depth so far.
    depth: [f64; L],
}

impl<const L: usize> Walk<'_, L> {
    /// Singly scattered radiance in sr^-1 that comes from between two distances in m, in cells that are narrow at the
    /// beginning and even in themselves.
    fn sum(&mut self, from: f64, to: f64) -> [f64; L] {
        let mut sum = [0.0; L];
        let sun = self.sun.direction();
        let at = |i: u32| from + (to - from) * (f64::from(i) / f64::from(CELLS)).powi(4);
        for i in 0..CELLS {
            let length = at(i + 1) - at(i);
            let there = self.place.advance(self.shape, self.direction, at(i) + 0.5 * length);
            let local = self.medium.local_at(there.altitude_m);
            let through = self.medium.transmittance(self.shape, there, sun);
            for j in 0..L {
                let depth = local.extinction[j] * length;
                let phase = |(density, component): (f64, &crate::atmosphere::Component<L>)| {
                    density * component.scattering[j] * component.phase.value(j, self.direction.dot(sun))
                };
                let scattered: f64 = local.densities.into_iter().zip(self.medium.components()).map(phase).sum();
                // (1 - e^-x) / x of the cell's own depth.
                let share = if depth > 0.0 { -(-depth).exp_m1() / depth } else { 1.0 };
                sum[j] += (-self.depth[j]).exp() * scattered * through[j] * length * share;
                self.depth[j] += depth;
            }
        }
        sum
    }
}
