//! What a planned picture has achieved: its error in some pixels, against unbiased paths that know nothing of tables.
//!
//! The truth is followed with its polarisation: radiance at the scene's own wavelengths; luminance and colour from a finer set of wavelengths than any plan
//! takes, all moved by one random share of a step. In each
//! of some random pixels two halves A and B of the paths give two independent estimates; with the picture's value P the product (P - A)(P - B) is an
//! unbiased estimate of the squared error, whatever the noise of the paths.

use super::{RenderError, Sky};
use crate::atmosphere::HazePhase;
use crate::data::Data;
use crate::film::tone;
use crate::plan::Metric;
use crate::sampling::Sampler;
use crate::scene::Scene;
use crate::spectrum::{Between, Colour, Wavelengths, ciede2000};
use crate::transport::Method;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, Ordering};

/// Pixels that are looked at. Of so many paths in all the noise of the mean squared error goes as the root of their number.
const PIXELS: usize = 32;

/// Wavelengths of the truth, over which range in nm, and in how many packets they are followed.
const WAVELENGTHS: u32 = 32;
const RANGE_NM: (f64, f64) = (380.0, 780.0);
pub(crate) const PACKETS: u64 = 2;

/// Evenly spread sequences of each half of a pixel's paths, and how many paths one has at least and at most.
const SEQUENCES: u64 = 2;
const POINTS: (u32, u32) = (16, 4096);

/// Standard errors that a number is below, or above, with 95 % confidence.
const CONFIDENT: f64 = 1.645;

/// The number of the estimates' stream: no picture has so many pixels.
const STREAM: u64 = 3 << 40;

/// What was found; errors in the unit of the metric, root mean squares over the pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Achieved {
    /// Of what.
    pub metric: Metric,
    /// What was asked.
    pub asked: f64,
    /// The error that was found, without the noise of the paths.
    pub found: f64,
    /// What it is above, and what it is below, each with 95 % confidence.
    pub between: [f64; 2],
    /// Pixels, and paths in all.
    pub size: (usize, u64),
}

impl Achieved {
    /// Whether the error is above what was asked, with 95 % confidence.
    #[must_use]
    pub fn fails(&self) -> bool {
        self.between[0] > self.asked
    }

    /// Whether it is below, with 95 % confidence.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.between[1] <= self.asked
    }

    /// From squared errors of pixels, of which noise may have made some negative.
    fn of(squares: &[f64], (metric, asked): (Metric, f64), paths: u64) -> Self {
        let count = squares.len() as f64;
        let mean = squares.iter().sum::<f64>() / count;
        let spread = squares.iter().map(|square| (square - mean).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
        let off = CONFIDENT * (spread / count).sqrt();
        let root = |square: f64| square.max(0.0).sqrt();
        let between = [root(mean - off), root(mean + off)];
        Self { metric, asked, found: root(mean), between, size: (squares.len(), paths) }
    }
}

/// The scene of the truth.
fn truth(scene: &Scene, metric: Metric, asked_at: &Wavelengths) -> Scene {
    let (low, high) = RANGE_NM;
    let step = (high - low) / f64::from(WAVELENGTHS);
    let share = Sampler::new(scene.seed, STREAM, 0).uniform();
    let nm = (0..WAVELENGTHS).map(|i| low + (f64::from(i) + share) * step).collect();
    // Increasing, and within the data.
    let moved = || Wavelengths::new(nm).unwrap_or_default();
    Scene {
        method: Method::Paths,
        wavelengths_nm: if metric == Metric::Radiance { asked_at.clone() } else { moved() },
        colour: crate::spectrum::Scheme::Spectral,
        fineness: None,
        steps: None,
        spp: None,
        error: None,
        polarisation: false,
        filter_deg: None,
        follow_polarisation: Some(scene.biome.is_none() || scene.phase == HazePhase::Mie),
        width: Some(1),
        height: Some(1),
        ..scene.clone()
    }
}

/// Looks at random pixels of a picture without noise, with about so many paths in all; none if it shows no light. Radiance is asked for at the wavelengths
/// `asked_at`.
///
/// # Errors
/// As [`Sky::new`].
pub fn achieved(
    (scene, sky): (&Scene, &Sky),
    data: &Data,
    (metric, asked, asked_at): (Metric, f64, &Wavelengths),
    paths: u64,
    stop: &AtomicBool,
) -> Result<Option<Achieved>, RenderError> {
    let truth = truth(scene, metric, asked_at);
    let exact = Sky::new(&truth, data)?;
    let wavelengths = truth.wavelengths();
    let between = Between::new(&data.ozone_cross_section, scene.wavelengths().nm())?;
    let places = wavelengths.nm().iter().map(|&nm| between.weights(nm)).collect::<Result<Vec<_>, _>>()?;
    let directions = pixels(scene, sky);
    if directions.is_empty() {
        return Ok(None);
    }
    let each = paths / (directions.len() as u64 * 2 * SEQUENCES);
    let points = 1 << (each.clamp(u64::from(POINTS.0), u64::from(POINTS.1)).ilog2());
    let looked: Vec<_> = directions
        .par_iter()
        .enumerate()
        .filter(|_| !stop.load(Ordering::Relaxed))
        .map(|(pixel, direction)| {
            let mut picture = vec![0.0; sky.wavelengths()];
            sky.radiance(*direction, &Sampler::new(0, 0, 0), &mut picture);
            let halves =
                [0, 1].map(|half| mean(&exact, *direction, (truth.seed, STREAM + 1 + pixel as u64), half, points));
            (picture, halves)
        })
        .collect();
    if looked.is_empty() {
        return Ok(None);
    }
    let squares = match metric {
        Metric::Radiance => radiance(&looked, &places),
        Metric::Luminance | Metric::Colour => colour(&looked, sky.colour(), exact.colour(), metric),
    };
    let paths = looked.len() as u64 * 2 * SEQUENCES * u64::from(points);
    Ok(Some(Achieved::of(&squares, (metric, asked), paths)))
}

/// Middles of random pixels, evenly spread over the picture (R_2 of Roberts 2018, moved by a random amount), in which there is light.
fn pixels(scene: &Scene, sky: &Sky) -> Vec<DVec3> {
    const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_3];
    const TRIES: u32 = 20_000;
    let (camera, (width, height)) = (scene.camera(), scene.size());
    let first = Sampler::new(scene.seed, STREAM, 1).uniform_2d();
    let mut factors = vec![0.0; sky.wavelengths()];
    let places = (0..TRIES).filter_map(|i| {
        let at = |k: usize, size: u32| ((first[k] + STEPS[k] * f64::from(i)).fract() * f64::from(size)).floor() + 0.5;
        camera.direction(at(0, width), at(1, height))
    });
    let lit = places.filter(|direction| {
        sky.radiance(*direction, &Sampler::new(0, 0, 0), &mut factors);
        factors.iter().all(|&light| light > 0.0)
    });
    lit.take(PIXELS).collect()
}

/// Mean radiance factors of one half, of sequences of so many paths.
fn mean(exact: &Sky, direction: DVec3, (seed, pixel): (u64, u64), half: u64, points: u32) -> Vec<f64> {
    let mut sum = vec![0.0; exact.wavelengths()];
    let mut factors = sum.clone();
    let count = SEQUENCES as f64 * f64::from(points);
    for sequence in 0..SEQUENCES {
        for point in 0..points {
            exact.radiance(direction, &Sampler::sobol(seed, pixel, 2 * sequence + half, point), &mut factors);
            sum.iter_mut().zip(&factors).for_each(|(sum, factor)| *sum += factor / count);
        }
    }
    sum
}

/// What the picture has, and two estimates of the truth.
type Looked = (Vec<f64>, [Vec<f64>; 2]);

/// Squared errors of radiance, over the mean of each wavelength, which follows from those of the picture by these weights.
fn radiance(looked: &[Looked], places: &[Vec<f64>]) -> Vec<f64> {
    let filled: Vec<Vec<f64>> = looked
        .iter()
        .map(|(picture, _)| {
            let at = |weights: &Vec<f64>| weights.iter().zip(picture).map(|(w, v)| w * v).sum::<f64>();
            places.iter().map(at).collect()
        })
        .collect();
    let mean = |j: usize| filled.iter().map(|picture| picture[j]).sum::<f64>() / filled.len() as f64;
    let means: Vec<f64> = (0..places.len()).map(mean).collect();
    let square = |(picture, (_, [a, b])): (&Vec<f64>, &Looked)| {
        let of = |j: usize| (picture[j] - a[j]) * (picture[j] - b[j]) / (means[j] * means[j]);
        (0..means.len()).map(of).sum::<f64>() / means.len() as f64
    };
    filled.iter().zip(looked).map(square).collect()
}

/// Squared errors of luminance, over its mean, or of colour. CIEDE2000 is no difference of numbers; for small errors its square is a quadratic form, so
/// that of the picture from the mean of both halves is too large by a quarter of that of the halves.
fn colour(looked: &[Looked], seen: &Colour, exact: &Colour, metric: Metric) -> Vec<f64> {
    let xyz: Vec<[[f64; 3]; 3]> =
        looked.iter().map(|(picture, [a, b])| [seen.xyz(picture), exact.xyz(a), exact.xyz(b)]).collect();
    let luminances: Vec<f64> = xyz.iter().map(|[picture, ..]| picture[1]).collect();
    if metric == Metric::Luminance {
        let mean = luminances.iter().sum::<f64>() / luminances.len() as f64;
        return xyz.iter().map(|[p, a, b]| (p[1] - a[1]) * (p[1] - b[1]) / (mean * mean)).collect();
    }
    let white = tone::automatic_white(&luminances);
    let shown = |colour: [f64; 3]| tone::displayed(colour, white);
    let square = |[p, a, b]: &[[f64; 3]; 3]| {
        let middle = std::array::from_fn(|i| 0.5 * (a[i] + b[i]));
        ciede2000(shown(*p), shown(middle)).powi(2) - 0.25 * ciede2000(shown(*a), shown(*b)).powi(2)
    };
    xyz.iter().map(square).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_of_the_paths_is_no_error_of_the_picture() {
        // A picture 1 % too bright everywhere; estimates with a noise of 20 %, independent in the two halves.
        let mut random = Sampler::new(1, 2, 3);
        let mut noise = || 0.2 * (2.0 * random.uniform() - 1.0);
        let looked: Vec<Looked> =
            (0..20_000).map(|_| (vec![1.01], [vec![1.0 + noise()], vec![1.0 + noise()]])).collect();
        let found = Achieved::of(&radiance(&looked, &[vec![1.0]]), (Metric::Radiance, 0.005), 0);
        // Squares have the spread of a product of two such noises, 0.2^2 / 3 = 0.0133, over sqrt(20 000): 1e-4, the error squared itself; the
        // interval holds the truth and not much more.
        assert!(found.between[0] <= 0.0099 && found.between[1] > 0.0099 && found.between[1] < 0.02, "{found:?}");
        assert!(!found.holds());
    }
}
