//! Error against size and cost, as tables for charts: `airlight study NAME` writes one, `airlight-tools chart` draws it.

pub mod atlas;
pub mod beside;
pub mod columns;
pub mod ladder;
pub mod neutral_points;
pub mod plans;
pub mod polarisation;
pub mod solved;
pub mod stability;
pub mod strip;
pub mod wavelengths;

use crate::camera::direction_at;
use crate::film::tone;
use crate::plan::HIGH_KM;
use crate::render::RenderError;
use crate::sampling::spiral;
use crate::scene::Scene;
use crate::spectrum::ciede2000;
use glam::DVec3;
use std::f64::consts::PI;
use std::fmt::Write;
use std::sync::atomic::{AtomicUsize, Ordering};
use tables::units::{EARTH_RADIUS_M, KM};

/// Heights z of directions in which one looks, the lowest, the horizon's and the highest: above the horizon from the ground, all around from within the
/// air, at the planet and its air from space.
fn heights(scene: &Scene) -> [f64; 3] {
    let (top, own) = (EARTH_RADIUS_M + scene.top_km * KM, EARTH_RADIUS_M + scene.altitude_km * KM);
    let below = |sine: f64| -((1.0 - sine) * (1.0 + sine)).max(0.0).sqrt();
    let horizon = below(EARTH_RADIUS_M / own);
    match scene.altitude_km {
        _ if top < own => [-1.0, horizon, below(top / own)],
        altitude if altitude > HIGH_KM => [-1.0, horizon, 1.0],
        _ => [0.0, 0.0, 1.0],
    }
}

/// Where one looks ([`heights`]), evenly in solid angle.
fn directions(scene: &Scene, count: u32) -> Vec<DVec3> {
    let [lowest, _, highest] = heights(scene);
    (0..count).map(|i| spiral(i, count, [lowest, highest])).collect()
}

/// Where one looks, closer to the horizon and to the sun's azimuth, where the sky changes most: directions on one side of the sun's plane, for the other
/// is alike, each with its share of the solid angle, together 1. Azimuths go by the golden section, all shifted by a share of the way round.
fn towards_light(scene: &Scene, (count, shift): (u32, f64)) -> Vec<(DVec3, f64)> {
    const GOLDEN: f64 = 0.618_033_988_749_895;
    let [lowest, middle, highest] = heights(scene);
    let first = if lowest < middle { -1.0 } else { 0.0 };
    let of = |i: u32| {
        // z is a square of a number from -1 or 0 to 1, the horizon at 0; the azimuth from the sun a square of one from 0 to 1.
        let s = first + (1.0 - first) * (f64::from(i) + 0.5) / f64::from(count);
        let t = (f64::from(i) * GOLDEN + shift).fract();
        let part = if s > 0.0 { highest - middle } else { middle - lowest };
        let z = middle + part * s * s.abs();
        let share = s.abs() * part * t;
        let level = direction_at(scene.sun_azimuth_deg.to_radians() + PI * t * t, 0.0);
        (level * ((1.0 - z) * (1.0 + z)).sqrt() + DVec3::Z * z, share)
    };
    let all = || (0..count).map(of);
    let whole: f64 = all().map(|(_, share)| share).sum();
    all().map(|(direction, share)| (direction, share / whole)).collect()
}

/// How far colours are off what is right: rms of luminance over its mean, rms of CIEDE2000 as a PNG would show both, exposed for what is right.
/// `shares` are those that directions have of what is looked at, together 1.
fn shown_apart(right: &[[f64; 3]], seen: &[[f64; 3]], shares: &[f64]) -> [f64; 2] {
    let mean = right.iter().zip(shares).map(|(right, share)| share * right[1]).sum::<f64>();
    let all = || right.iter().zip(seen).zip(shares);
    let luminance = all().map(|((r, s), share)| share * (r[1] - s[1]).powi(2)).sum::<f64>();
    let white = tone::automatic_white_of(right.iter().zip(shares).map(|(right, share)| (*share, right[1])));
    let shown = |colour: &[f64; 3]| tone::displayed(*colour, white);
    let colour = all().map(|((r, s), share)| share * ciede2000(shown(r), shown(s)).powi(2)).sum::<f64>();
    [luminance.sqrt() / mean, colour.sqrt()]
}

/// The cubic through the four nearest of at least four nodes, constant beyond their ends: the first of them, and their weights.
fn cubic(nodes: &[f64], x: f64) -> (usize, [f64; 4]) {
    let x = x.clamp(nodes[0], nodes[nodes.len() - 1]);
    let first = nodes.partition_point(|&node| node <= x).saturating_sub(2).min(nodes.len() - 4);
    let near = &nodes[first..first + 4];
    let weight = |i: usize| (0..4).filter(|&j| j != i).map(|j| (x - near[j]) / (near[i] - near[j])).product();
    (first, std::array::from_fn(weight))
}

/// Hands 0 to `count` to `work`, `threads` at a time, each in a pool of one thread, so that every time is that of one core.
///
/// # Errors
/// The first that `work` has.
fn on_one_core_each(
    count: usize,
    threads: usize,
    work: &(dyn Fn(usize) -> Result<(), RenderError> + Sync),
) -> Result<(), RenderError> {
    let next = AtomicUsize::new(0);
    let worker = || -> Result<(), RenderError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
        loop {
            let i = next.fetch_add(1, Ordering::Relaxed);
            if i >= count {
                return Ok(());
            }
            pool.install(|| work(i))?;
        }
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.max(1)).map(|_| scope.spawn(worker)).collect();
        workers.into_iter().try_for_each(|worker| match worker.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        })
    })
}

/// Points of curves in panels.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// What is shown.
    pub title: String,
    /// Names of the axes, with units.
    pub axes: [&'static str; 2],
    /// The points, in the order in which they are drawn.
    pub points: Vec<Point>,
}

/// A point of a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// The panel, which is the name of what is plotted.
    pub panel: &'static str,
    /// The curve.
    pub curve: String,
    /// Abscissa and ordinate.
    pub at: [f64; 2],
}

impl Chart {
    /// The chart as CSV: a line with the title behind `# `, a header of `panel`, `curve` and the names of the axes, and a row
    /// for each point.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut csv = format!("# {}\npanel,curve,{},{}\n", self.title, self.axes[0], self.axes[1]);
        for Point { panel, curve, at: [x, y] } in &self.points {
            // Writing to a string does not fail.
            let _ = writeln!(csv, "\"{panel}\",\"{curve}\",{x:.6e},{y:.3e}");
        }
        csv
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_towards_light_have_the_means_of_even_ones() {
        for (altitude_km, sun_azimuth_deg) in [(0.002, 180.0), (8.0, 30.0), (500.0, 250.0)] {
            let scene = Scene { altitude_km, sun_azimuth_deg, ..Scene::default() };
            let sun = direction_at(sun_azimuth_deg.to_radians(), 0.0);
            // Height, a broad lobe about the sun's azimuth, a layer about the level.
            let of = |direction: &DVec3| [direction.z, direction.dot(sun).exp(), (-direction.z.abs() / 0.05).exp()];
            let even = directions(&scene, 100_000);
            for shift in [0.0, 0.5] {
                let few = towards_light(&scene, (256, shift));
                for k in 0..3 {
                    let right = even.iter().map(|direction| of(direction)[k]).sum::<f64>() / 1e5;
                    let found: f64 = few.iter().map(|(direction, share)| share * of(direction)[k]).sum();
                    // 256 directions leave about a hundredth.
                    assert!(
                        (found - right).abs() < 0.015 * right.abs().max(0.7),
                        "{altitude_km} km, {k}: {found} {right}"
                    );
                }
            }
        }
    }

    #[test]
    fn cubics_are_met() {
        let nodes: Vec<f64> = (0..7).map(f64::from).collect();
        let value = |x: f64| 1.0 + x * (2.0 - x * (3.0 - 0.5 * x));
        for x in [0.0, 0.4, 2.5, 5.9, 6.0] {
            let (first, weights) = cubic(&nodes, x);
            let found: f64 = weights.iter().zip(&nodes[first..]).map(|(w, node)| w * value(*node)).sum();
            // Rounding only.
            assert!((found - value(x)).abs() < 1e-12, "{found} at {x}");
        }
        assert_eq!(cubic(&nodes, 9.0), cubic(&nodes, 6.0));
    }
}
