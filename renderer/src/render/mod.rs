//! Pictures: samples for every pixel, on every thread, until it is enough.
//!
//! Sample s of pixel p is a function of (seed, p, s) alone, and a pixel's samples are
//! added in order, so a picture does not depend on the number of threads.

mod disc;
pub mod receipt;
mod sky;
mod summary;
#[cfg(test)]
mod tests;

pub use disc::disc_layer;
pub use sky::Sky;
pub use summary::Summary;

use crate::atmosphere::AirError;
use crate::camera::Camera;
use crate::data::DataError;
use crate::film::{Errors, Film, Row};
use crate::sampling::Sampler;
use crate::scene::{Scene, SceneError};
use crate::spectrum::linear_srgb;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use tables::TableError;

/// Why a picture cannot be made.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// The scene asks for what is not there.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// The atmosphere cannot be made.
    #[error(transparent)]
    Air(#[from] AirError),
    /// A table that only this scene needs is absent or cannot be used.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A table does not reach.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The threads cannot be started.
    #[error("the threads cannot be started: {0}")]
    Threads(#[from] rayon::ThreadPoolBuildError),
    /// An estimate is infinite or no number: a bug, and how to find it again.
    #[error("sample {sample} of pixel {x},{y} is not finite")]
    NotFinite {
        /// Column.
        x: u32,
        /// Row.
        y: u32,
        /// Sample.
        sample: u32,
    },
}

/// How far a picture is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// Share of the work that is done, 0 to 1; a guess where an error is to be reached.
    pub fraction: f64,
    /// Samples taken so far, all pixels together.
    pub samples: u64,
    /// [`Errors::relative`] after the last pass; infinite before the second sample.
    pub error: f64,
}

/// What a rendering hears from outside and tells it.
#[derive(Clone, Copy)]
pub struct Control<'a> {
    /// Set to stop: rows that are under way are finished, no others begun.
    pub stop: &'a AtomicBool,
    /// Called after each row, from any thread.
    pub observe: &'a (dyn Fn(Progress) + Sync),
}

/// A picture's samples.
#[derive(Debug)]
pub struct Rendering {
    /// The samples.
    pub film: Film,
    /// How well they determine the picture.
    pub errors: Errors,
    /// Whether it was stopped before its samples or its error were reached.
    pub stopped: bool,
}

/// No error is believed before so many samples of each pixel.
const LEAST_FOR_ERROR: u32 = 8;

/// A picture that is still black after so many samples of each pixel is taken for black,
/// whatever error is asked for.
const MOST_IN_THE_DARK: u32 = 1024;

/// A pass over a small picture takes as many samples of each pixel as make this many in all.
const PASS_SAMPLES: usize = 16_384;

/// Renders a valid scene on the current thread pool: pass after pass over all pixels until the
/// samples of [`Scene::spp_limit`] are taken, [`Scene::error`] is reached
/// (after 8 samples at the earliest; a picture without any light ends after 1024) or `control` stops it.
///
/// # Errors
/// [`RenderError::NotFinite`] for the first pixel with such a sample.
pub fn render(scene: &Scene, sky: &Sky, control: Control<'_>) -> Result<Rendering, RenderError> {
    let (width, height) = scene.size();
    let camera = scene.camera();
    let mut film = Film::new(width, height, sky.irradiance_w_m2_nm().to_vec());
    let mut errors = film.errors();
    let limit = scene.spp_limit().unwrap_or(u32::MAX);
    let pixels = width as usize * height as usize;
    let per_pass = u32::try_from(PASS_SAMPLES / pixels).unwrap_or(1).max(1);
    let cut = AtomicBool::new(false);
    let mut taken = 0;
    while taken < limit {
        let samples = taken..(taken + per_pass).min(limit);
        let pass = Pass { sky, camera: &camera, seed: scene.seed, samples: samples.clone() };
        let work = Work { taken, limit, error: errors.relative, wanted: scene.error };
        let rows_done = AtomicU32::new(0);
        let failed = film
            .rows_mut()
            .into_par_iter()
            .filter_map(|row| {
                if control.stop.load(Ordering::Relaxed) {
                    cut.store(true, Ordering::Relaxed);
                    return None;
                }
                let failure = pass.fill(row).err();
                let rows = rows_done.fetch_add(1, Ordering::Relaxed) + 1;
                let more = f64::from(rows) / f64::from(height) * f64::from(samples.end - samples.start);
                let samples = (pixels as f64 * (f64::from(taken) + more)) as u64;
                (control.observe)(Progress { fraction: work.fraction(more), samples, error: errors.relative });
                failure
            })
            .min_by_key(|(y, x, sample)| (*y, *x, *sample));
        if let Some((y, x, sample)) = failed {
            return Err(RenderError::NotFinite { x, y, sample });
        }
        taken = samples.end;
        errors = film.errors();
        let reached = taken >= LEAST_FOR_ERROR && scene.error.is_some_and(|wanted| errors.relative <= wanted);
        let black = scene.error.is_some() && errors.relative.is_infinite() && taken >= MOST_IN_THE_DARK;
        if reached || black || cut.load(Ordering::Relaxed) {
            break;
        }
    }
    Ok(Rendering { film, errors, stopped: cut.into_inner() })
}

/// How much there is to do at the beginning of a pass.
#[derive(Clone, Copy)]
struct Work {
    taken: u32,
    limit: u32,
    error: f64,
    wanted: Option<f64>,
}

impl Work {
    /// Share of the work done with `more` samples of each pixel. The samples that an error needs go
    /// as its inverse square.
    fn fraction(self, more: f64) -> f64 {
        let taken = f64::from(self.taken);
        let needed = match self.wanted {
            Some(wanted) if self.error.is_finite() => (taken * (self.error / wanted).powi(2)).max(taken + 1.0),
            Some(_) => f64::from(self.limit).min(1e3),
            None => f64::INFINITY,
        };
        ((taken + more) / needed.min(f64::from(self.limit))).min(1.0)
    }
}

/// Some samples of every pixel.
struct Pass<'a> {
    sky: &'a Sky,
    camera: &'a Camera,
    seed: u64,
    samples: std::ops::Range<u32>,
}

impl Pass<'_> {
    /// Fills a row; the error is (row, column, sample) of an estimate that is not finite.
    fn fill(&self, mut row: Row<'_>) -> Result<(), (u32, u32, u32)> {
        let width = row.width();
        let mut factors = vec![0.0; self.sky.wavelengths()];
        for x in 0..width {
            if self.camera.direction(f64::from(x) + 0.5, f64::from(row.y) + 0.5).is_none() {
                continue;
            }
            for sample in self.samples.clone() {
                one_sample(self.sky, self.camera, (width, x, row.y), (self.seed, sample), &mut factors);
                let rgb = linear_srgb(self.sky.colour().xyz(&factors));
                if !factors.iter().chain(&rgb).all(|v| v.is_finite()) {
                    return Err((row.y, x, sample));
                }
                row.add(x, &factors, rgb);
            }
        }
        Ok(())
    }
}

/// Radiance factors (sr^-1) of one sample of pixel (`x`, `y`) of a valid scene, as the picture took it;
/// `None` where the picture shows nothing.
#[must_use]
pub fn replay(scene: &Scene, sky: &Sky, x: u32, y: u32, sample: u32) -> Option<(DVec3, Vec<f64>)> {
    let camera = scene.camera();
    camera.direction(f64::from(x) + 0.5, f64::from(y) + 0.5)?;
    let mut factors = vec![0.0; sky.wavelengths()];
    let direction = one_sample(sky, &camera, (scene.size().0, x, y), (scene.seed, sample), &mut factors);
    Some((direction, factors))
}

/// One sample of pixel (`x`, `y`) of a picture of some width, and the direction it looked in.
fn one_sample(
    sky: &Sky,
    camera: &Camera,
    (width, x, y): (u32, u32, u32),
    (seed, sample): (u64, u32),
    factors: &mut [f64],
) -> DVec3 {
    let pixel = u64::from(y) * u64::from(width) + u64::from(x);
    let mut sampler = Sampler::new(seed, pixel, u64::from(sample));
    let direction = within(camera, x, y, &mut sampler);
    sky.radiance(direction, &sampler, factors);
    direction
}

/// A direction uniformly distributed over the part of the pixel that lies in the picture. The
/// pixel's middle does, so half of all draws or nearly so are good, and sixty-four bad ones in a
/// row do not happen.
fn within(camera: &Camera, x: u32, y: u32, sampler: &mut Sampler) -> DVec3 {
    let (left, top) = (f64::from(x), f64::from(y));
    (0..64)
        .find_map(|_| {
            let [u, v] = sampler.uniform_2d();
            camera.direction(left + u, top + v)
        })
        .or_else(|| camera.direction(left + 0.5, top + 0.5))
        .unwrap_or(DVec3::Z)
}
