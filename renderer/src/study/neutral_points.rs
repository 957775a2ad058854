//! Where the sky has no polarisation: the points of Arago, Babinet and Brewster on the sun's vertical.
//!
//! On the great circle through the sun and the zenith U is zero for reasons of symmetry, so that a neutral point is a zero
//! of Q, horizontal light less vertical. A place on the circle is its angle in degrees from the horizon below the sun, 90
//! at the zenith, 180 at the horizon opposite. Light scattered once has Q > 0 everywhere but at the sun and opposite it;
//! later orders add Q < 0 about both, and the zeros move away from there: Babinet's point above the sun, Brewster's below
//! it, Arago's above the antisolar point (Chandrasekhar & Elbert 1954; Coulson 1988, chapter 5).

use super::{Chart, Point};
use crate::atmosphere::{Columns, Tolerance};
use crate::bench::{medium, towards};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::light::SunDisc;
use crate::polarisation::Frame;
use crate::render::RenderError;
use crate::sampling::Sampler;
use crate::transport::{self, Estimator, Problem};
use glam::DVec3;
use rayon::prelude::*;
use tables::units::EARTH_RADIUS_M;

/// A zero of Q on the sun's vertical.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Zero {
    /// Its place in degrees from the horizon below the sun.
    pub along_deg: f64,
    /// Whether Q grows there with that angle.
    pub rises: bool,
    /// Standard error of the place in degrees.
    pub error_deg: f64,
}

/// A neutral point by its discoverer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Name {
    /// Above the antisolar point.
    Arago,
    /// Above the sun.
    Babinet,
    /// Below the sun.
    Brewster,
}

impl Name {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Arago, Self::Babinet, Self::Brewster];

    /// Degrees of a zero from the antisolar point or the sun, whose elevation is given in degrees; `None` if it is another point.
    #[must_use]
    pub fn distance(self, zero: &Zero, sun_elevation_deg: f64) -> Option<f64> {
        let above_the_sun = zero.along_deg - sun_elevation_deg;
        match (self, zero.rises) {
            (Self::Arago, false) if above_the_sun > 90.0 => Some(180.0 - above_the_sun),
            (Self::Babinet, true) if (0.0..90.0).contains(&above_the_sun) => Some(above_the_sun),
            (Self::Brewster, false) if above_the_sun < 0.0 => Some(-above_the_sun),
            _ => None,
        }
    }
}

/// Sequences of random numbers whose spread is the error.
const REPLICATES: usize = 16;

/// Nodes of a parabola in degrees from its middle.
const NODES: [f64; 9] = [-4.0, -3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0, 4.0];

/// Nodes of the search in degrees, the errors at which Q is taken to be known, and the most degrees between two such.
const STEP: usize = 2;
const SIGNIFICANT: f64 = 4.0;
const GAP: f64 = 16.0;

/// The lowest and the highest place that is looked at.
const ENDS: (f64, f64) = (1.0, 179.0);

/// Q over mean I of each sequence, at each wavelength.
type Ratios<const L: usize> = [[f64; L]; REPLICATES];

/// Q over I at a place of the sun's vertical by sequences of `points` paths, the sun at azimuth 0. Every place gets the same
/// random numbers, so that differences between places are better known than the values.
fn ratios<const L: usize>(problem: &Problem<'_, L>, from: Place, along_deg: f64, points: u32) -> Ratios<L> {
    let direction = towards(90.0 - along_deg, 0.0);
    let frame = Frame::new(direction, DVec3::Y);
    let (mut q, mut i) = ([[0.0; L]; REPLICATES], [0.0; L]);
    for (replicate, q) in (0..).zip(&mut q) {
        for point in 0..points {
            let mut sampler = Sampler::sobol(0, 0, replicate, point);
            let seen = transport::stokes(Estimator::Paths, problem, from, direction, frame, &mut sampler);
            for (j, seen) in seen.into_iter().enumerate() {
                q[j] += seen.q;
                i[j] += seen.i / REPLICATES as f64;
            }
        }
    }
    q.map(|q| std::array::from_fn(|j| if i[j] > 0.0 { q[j] / i[j] } else { 0.0 }))
}

/// Mean and its standard error.
fn mean_and_error(values: [f64; REPLICATES]) -> (f64, f64) {
    let n = REPLICATES as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
    (mean, (squares / (n * (n - 1.0))).sqrt())
}

/// The zero of Q within four degrees of `about`, at each wavelength, by sequences of `points` paths at nine places: that of the
/// parabola nearest to Q / I there. Its error is that of the parabola's value over its slope.
#[must_use]
pub fn zero<const L: usize>(problem: &Problem<'_, L>, from: Place, about: f64, points: u32) -> [Option<Zero>; L] {
    let half = NODES[NODES.len() - 1];
    let middle = about.clamp(ENDS.0 + half, ENDS.1 - half);
    let seen: Vec<Ratios<L>> = NODES.par_iter().map(|node| ratios(problem, from, middle + node, points)).collect();
    std::array::from_fn(|j| {
        let of = |replicate: usize, x: f64| parabola(|node| seen[node][replicate][j], x);
        let all = |x: f64| mean_and_error(std::array::from_fn(|replicate| of(replicate, x)));
        let (mut low, mut high) = (-half, half);
        let rises = all(high).0 > 0.0;
        if (all(low).0 > 0.0) == rises {
            return None;
        }
        // Bisection to 1e-12 of the interval.
        for _ in 0..40 {
            let x = 0.5 * (low + high);
            if (all(x).0 > 0.0) == rises { high = x } else { low = x }
        }
        const STEP: f64 = 1e-3;
        let slope = (all(low + STEP).0 - all(low - STEP).0) / (2.0 * STEP);
        Some(Zero { along_deg: middle + low, rises, error_deg: all(low).1 / slope.abs() })
    })
}

/// At x the parabola that is nearest, by least squares, to the values at the [`NODES`]: a sum of the polynomials 1, x and
/// x^2 - mean of x^2, which are orthogonal on nodes that lie evenly about 0.
fn parabola(values: impl Fn(usize) -> f64, x: f64) -> f64 {
    let square = NODES.iter().map(|t| t * t).sum::<f64>() / NODES.len() as f64;
    let basis = |t: f64| [1.0, t, t * t - square];
    let at = basis(x);
    (0..3)
        .map(|k| {
            let norm: f64 = NODES.iter().map(|&t| basis(t)[k].powi(2)).sum();
            let along: f64 = (0..NODES.len()).map(|i| values(i) * basis(NODES[i])[k]).sum();
            at[k] * along / norm
        })
        .sum()
}

/// All zeros of Q on the sun's vertical at each wavelength, from the horizon below the sun: looked for in steps of two degrees by
/// a quarter of `points` paths, found by [`zero`].
#[must_use]
pub fn zeros<const L: usize>(problem: &Problem<'_, L>, from: Place, points: u32) -> [Vec<Zero>; L] {
    let places: Vec<f64> = (1..180).step_by(STEP).map(f64::from).collect();
    let seen: Vec<Ratios<L>> =
        places.par_iter().map(|&along| ratios(problem, from, along, (points / 4).max(1))).collect();
    let mut found: [Vec<Zero>; L] = std::array::from_fn(|_| Vec::new());
    let mut about: Vec<(usize, f64)> = Vec::new();
    for j in 0..L {
        let mut last: Option<(f64, f64)> = None;
        for (&along, seen) in places.iter().zip(&seen) {
            let (q, error) = mean_and_error(seen.map(|ratio| ratio[j]));
            if q.abs() < SIGNIFICANT * error {
                continue;
            }
            if let Some((before, was)) = last
                && was * q < 0.0
                && along - before < GAP
            {
                about.push((j, before + (along - before) * was / (was - q)));
            }
            last = Some((along, q));
        }
    }
    // One look serves all wavelengths whose zeros are close to each other.
    about.sort_by(|a, b| a.1.total_cmp(&b.1));
    let mut rest = &about[..];
    while let Some(&(_, first)) = rest.first() {
        let close = rest.iter().take_while(|(_, along)| along - first < 2.0).count();
        let middle = 0.5 * (first + rest[close - 1].1);
        let found_here = zero(problem, from, middle, points);
        for &(j, _) in &rest[..close] {
            found[j].extend(found_here[j]);
        }
        rest = &rest[close..];
    }
    found
}

/// Elevations of the sun in degrees.
const SUNS: [f64; 12] = [-4.0, -2.0, 0.0, 2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0, 60.0];

/// Wavelengths in nm, and albedos of the ground.
const WAVELENGTHS: [f64; 4] = [360.0, 450.0, 550.0, 700.0];
const ALBEDOS: [f64; 2] = [0.1, 0.8];

/// Paths of a sequence.
const PATHS: u32 = 1024;

/// Panels: distance, and its error.
const PANELS: [[&str; 2]; 3] = [
    ["Arago's point: above the antisolar point", "Arago's point: standard error"],
    ["Babinet's point: above the sun", "Babinet's point: standard error"],
    ["Brewster's point: below the sun", "Brewster's point: standard error"],
];

/// The neutral points of clear air over the sun's elevation, seen from 2 m: distances from the sun or the antisolar point, and
/// their standard errors. The sun is a parallel beam. A point below the horizon, or nearer to it than a degree, is left out.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn make(data: &Data, progress: &(dyn Fn(f64) + Sync)) -> Result<Chart, RenderError> {
    let shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };
    let medium = medium(data, None, &WAVELENGTHS)?;
    let columns = Columns::new(&medium, shape, Tolerance::RENDER);
    let mut points = Vec::new();
    for (k, albedo) in ALBEDOS.into_iter().enumerate() {
        for (n, elevation) in SUNS.into_iter().enumerate() {
            let disc = SunDisc::beam(towards(90.0 - elevation, 0.0));
            let problem = Problem {
                texture: None,
                shape,
                medium: &medium,
                columns: &columns,
                albedo: [albedo; 4],
                sun: Some(&disc),
                environment: None,
                max_orders: None,
            };
            for (nm, zeros) in WAVELENGTHS.iter().zip(zeros(&problem, Place::above(2.0), PATHS)) {
                for (name, [distance, error]) in Name::ALL.into_iter().zip(PANELS) {
                    let found = zeros.iter().find_map(|zero| Some((name.distance(zero, elevation)?, zero.error_deg)));
                    let Some(found) = found else { continue };
                    let curve = || format!("{nm} nm, albedo {albedo}");
                    points.push(Point { panel: distance, curve: curve(), at: [elevation, found.0] });
                    points.push(Point { panel: error, curve: curve(), at: [elevation, found.1] });
                }
            }
            progress((k as f64 + (n + 1) as f64 / SUNS.len() as f64) / ALBEDOS.len() as f64);
        }
    }
    let order =
        |panel: &str| [0, 1].map(|k| PANELS.iter().position(|panels| panels[k] == panel).map_or(9, |i| i + 3 * k));
    points.sort_by_key(|point| order(point.panel));
    Ok(Chart {
        title: "Neutral points of clear air over the sun's elevation".to_owned(),
        axes: ["sun elevation / degrees", "degrees"],
        points,
    })
}

#[cfg(test)]
mod tests;
