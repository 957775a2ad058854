//! Pictures: samples for every pixel, on every thread, until it is enough.
//!
//! Sample s of pixel p is a function of (seed, p, s) alone. A pixel's samples come in blocks of m ([`Scene::block`]),
//! sample s as point s mod m of block s / m, and blocks are added in order: so a picture depends neither on the number
//! of threads nor on where its work was interrupted.

mod achieved;
mod carrier;
mod certify;
mod disc;
mod domes;
#[cfg(test)]
mod honesty;
mod launcher;
pub mod left_out;
mod merge;
pub mod receipt;
mod sample;
mod shard;
mod sky;
mod state;
mod summary;
#[cfg(test)]
mod tests;

pub(crate) use achieved::PACKETS;
pub use achieved::{Achieved, achieved};
pub(crate) use carrier::MOST_ERROR as MOST_TABLE_ERROR;
pub use certify::{Residual, Verdict, certify, certify_table};
pub use disc::disc_layer;
pub use merge::{MergeError, Merged};
pub use sample::replay;
pub use shard::{Part, Shard};
pub use sky::Sky;
pub use state::{Head, State, StateError};
pub use summary::Summary;

use crate::atmosphere::AirError;
use crate::camera::Camera;
use crate::data::DataError;
use crate::film::{EncodeError, Errors, Film, Row};
use crate::scene::{MAX_SPP, Scene, SceneError};
use crate::spectrum::linear_srgb;
use crate::transport::SolveError;
use crate::transport::rungs::Refusal;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::time::Instant;
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
    /// The method does not cover the scene.
    #[error(transparent)]
    Refused(#[from] Refusal),
    /// There is no solved table for the scene.
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// Stored measurements are none.
    #[error("stored measurements: {0}")]
    Measured(String),
    /// A picture cannot be encoded.
    #[error(transparent)]
    Encode(#[from] EncodeError),
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
    /// Share of this run's work that is done, 0 to 1; a guess where an error is to be reached.
    pub fraction: f64,
    /// Samples that this run has taken, all pixels together.
    pub samples: u64,
    /// [`Errors::relative`] after the last pass; infinite before the second block.
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

/// How much of a picture a run makes, beside what the scene says.
#[derive(Debug, Clone, Copy, Default)]
pub struct Extent {
    /// Which of the picture's blocks.
    pub shard: Shard,
    /// When to end, of itself and whole: no pass is begun that would probably not be done by then, once every pixel has
    /// two blocks. With it [`Scene::spp`] and [`Scene::error`] end the run sooner, if they are given.
    pub deadline: Option<Instant>,
}

/// A picture's samples.
#[derive(Debug)]
pub struct Rendering {
    /// The samples.
    pub film: Film,
    /// How well they determine the picture.
    pub errors: Errors,
    /// Why there are no more.
    pub end: End,
}

/// What ended a run.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum End {
    /// Its samples are taken or its error is reached.
    Done,
    /// Its time was up. All pixels have as many samples.
    Time,
    /// It was stopped from outside.
    Stopped,
}

/// No error is believed before so many blocks of each pixel: with fewer, a run could end because its error looks
/// smaller than it is.
pub const LEAST_FOR_ERROR: u32 = 16;

/// Blocks of each pixel that are made in however little time: the fewest with an error.
const LEAST_IN_TIME: u32 = 2;

/// A picture that is still black after so many samples of each pixel is taken for black,
/// whatever error is asked for.
const MOST_IN_THE_DARK: u32 = 1024;

/// A pass over a small picture takes as many samples of each pixel as make this many in all.
const PASS_SAMPLES: u64 = 16_384;

/// Rows between two chances to keep the film.
const BAND: u32 = 256;

/// Renders a valid scene on the current thread pool: pass after pass over all pixels until the
/// samples of [`Scene::spp`] are taken (rounded up to whole blocks), [`Scene::error`] is reached
/// (after 16 blocks at the earliest; a picture without any light ends after 1024 samples) or `control` stops it.
///
/// # Errors
/// [`RenderError::NotFinite`] for the first pixel with such a sample.
pub fn render(scene: &Scene, sky: &Sky, control: Control<'_>) -> Result<Rendering, RenderError> {
    go_on(empty(scene, sky), scene, sky, Extent::default(), control, &mut |_| {})
}

/// The film of a scene before its first sample.
#[must_use]
pub fn empty(scene: &Scene, sky: &Sky) -> Film {
    let (width, height) = scene.size();
    Film::new(width, height, sky.irradiance_w_m2_nm().to_vec(), sky.keeps_stokes())
}

/// As [`render`], for a part of the picture, from a film that this part has filled before; `keep` sees the film now and
/// then. The same samples give the same bits, however often the work was interrupted.
///
/// # Errors
/// As [`render`].
pub fn go_on(
    mut film: Film,
    scene: &Scene,
    sky: &Sky,
    extent: Extent,
    control: Control<'_>,
    keep: &mut dyn FnMut(&Film),
) -> Result<Rendering, RenderError> {
    let (camera, (width, height), block) = (scene.camera(), scene.size(), scene.block());
    let limit = extent.limit(scene);
    let pass_blocks = (PASS_SAMPLES / (u64::from(width) * u64::from(height) * u64::from(block))).max(1) as u32;
    let begin = Instant::now();
    let first = least_blocks(&film, &camera);
    let mut taken = first;
    let mut errors = film.errors();
    // After an interruption some rows are ahead of the others.
    let mut even = film.most_blocks() == taken;
    let end = 'passes: loop {
        let reached = even && is_look(taken) && scene.error.is_some_and(|wanted| errors.relative <= wanted);
        let black = scene.error.is_some()
            && errors.relative.is_infinite()
            && u64::from(taken) * u64::from(block) >= u64::from(MOST_IN_THE_DARK);
        if taken >= limit || reached || black {
            break End::Done;
        }
        let mut until = pass_end(taken, pass_blocks).min(limit);
        if let Some(deadline) = extent.deadline {
            let more = affordable(deadline, begin, taken - first);
            if more == 0 && taken >= LEAST_IN_TIME {
                break End::Time;
            }
            until = until.min(taken.saturating_add(more.max(1)));
        }
        let pass = Pass { sky, camera: &camera, seed: scene.seed, block, shard: extent.shard, until };
        let work = Work { first, taken, limit, error: errors.relative, wanted: scene.error };
        let samples = u64::from(width) * u64::from(height) * u64::from(block);
        let rows_done = AtomicU32::new(0);
        for band in (0..height).step_by(BAND as usize) {
            let rows = film.rows_mut().into_iter().skip(band as usize).take(BAND as usize);
            let failed = rows
                .collect::<Vec<_>>()
                .into_par_iter()
                .filter_map(|row| {
                    if control.stop.load(Ordering::Relaxed) {
                        return None;
                    }
                    let failure = pass.fill(row).err();
                    let rows = rows_done.fetch_add(1, Ordering::Relaxed) + 1;
                    let more = f64::from(rows) / f64::from(height) * f64::from(until - taken);
                    (control.observe)(Progress {
                        fraction: work.fraction(more).max(extent.share_of_time(begin)),
                        samples: (samples as f64 * (f64::from(taken - first) + more)) as u64,
                        error: errors.relative,
                    });
                    failure
                })
                .min_by_key(|(y, x, sample)| (*y, *x, *sample));
            if let Some((y, x, sample)) = failed {
                return Err(RenderError::NotFinite { x, y, sample });
            }
            if control.stop.load(Ordering::Relaxed) {
                break;
            }
            keep(&film);
        }
        errors = film.errors();
        if rows_done.into_inner() < height {
            break 'passes End::Stopped;
        }
        taken = until;
        even = film.most_blocks() == taken;
    };
    Ok(Rendering { film, errors, end })
}

impl Extent {
    /// Blocks of each pixel that the run never exceeds; none if the shard has none.
    #[must_use]
    pub fn limit(&self, scene: &Scene) -> u32 {
        let open = scene.error.is_some() || self.deadline.is_some();
        let samples = scene.spp.unwrap_or(if open { MAX_SPP } else { scene.default_spp() });
        self.shard.share(samples.div_ceil(scene.block()))
    }

    fn share_of_time(&self, begin: Instant) -> f64 {
        let Some(deadline) = self.deadline else { return 0.0 };
        let all = deadline.saturating_duration_since(begin).as_secs_f64();
        if all > 0.0 { (begin.elapsed().as_secs_f64() / all).min(1.0) } else { 1.0 }
    }
}

/// Blocks that can be made until the deadline at the pace since `begin`, with `done` blocks; before the first, two if
/// there is any time.
fn affordable(deadline: Instant, begin: Instant, done: u32) -> u32 {
    let left = deadline.saturating_duration_since(Instant::now()).as_secs_f64();
    if left > 0.0 && done == 0 {
        return LEAST_IN_TIME;
    }
    // Saturates.
    (left / (begin.elapsed().as_secs_f64() / f64::from(done))) as u32
}

/// The smallest number of blocks of a pixel that shows something.
fn least_blocks(film: &Film, camera: &Camera) -> u32 {
    let (width, height) = film.size();
    let pixels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let shown = pixels.zip(0..).filter(|((x, y), _)| sample::is_shown(camera, *x, *y));
    shown.map(|(_, pixel)| film.blocks(pixel)).min().unwrap_or(u32::MAX)
}

/// Distance between two numbers of blocks at which the error is looked at: a 16th to a 32nd of them. Every look is a
/// chance to end too early, and only few looks are all that a picture needs.
fn look_step(blocks: u32) -> u32 {
    if blocks < LEAST_FOR_ERROR { LEAST_FOR_ERROR } else { 1 << (blocks.ilog2() - 4) }
}

fn is_look(blocks: u32) -> bool {
    blocks > 0 && blocks.is_multiple_of(look_step(blocks))
}

/// Where a pass ends that begins with `taken` blocks of each pixel: at the next look, or sooner.
fn pass_end(taken: u32, pass_blocks: u32) -> u32 {
    let step = look_step(taken);
    (taken / step).saturating_add(1).saturating_mul(step).min(taken.saturating_add(pass_blocks))
}

/// How much there is to do at the beginning of a pass; numbers are blocks of each pixel.
#[derive(Clone, Copy)]
struct Work {
    /// At the beginning of the run.
    first: u32,
    taken: u32,
    limit: u32,
    error: f64,
    wanted: Option<f64>,
}

impl Work {
    /// Share of the work done with `more` blocks of each pixel. The blocks that an error needs go
    /// as its inverse square.
    fn fraction(self, more: f64) -> f64 {
        let [first, taken, limit] = [self.first, self.taken, self.limit].map(f64::from);
        let needed = match self.wanted {
            Some(wanted) if self.error.is_finite() => taken * (self.error / wanted).powi(2),
            Some(_) => 1e3,
            None => limit,
        };
        ((taken + more - first) / (needed.max(taken + 1.0).min(limit) - first)).min(1.0)
    }
}

/// Some blocks of every pixel.
struct Pass<'a> {
    sky: &'a Sky,
    camera: &'a Camera,
    seed: u64,
    block: u32,
    shard: Shard,
    /// Blocks that every pixel is to have.
    until: u32,
}

impl Pass<'_> {
    /// Fills a row; the error is (row, column, sample) of an estimate that is not finite.
    fn fill(&self, mut row: Row<'_>) -> Result<(), (u32, u32, u32)> {
        let (width, y) = (row.width(), row.y);
        let mut values = vec![0.0; self.sky.values()];
        let mut sum = values.clone();
        for x in (0..width).filter(|&x| sample::is_shown(self.camera, x, y)) {
            for count in row.blocks(x)..self.until {
                let first = self.shard.block(count) * self.block;
                sum.fill(0.0);
                for sample in first..first + self.block {
                    let place = sample::Index { seed: self.seed, block: self.block, sample };
                    sample::take(self.sky, self.camera, (width, x, y), place, &mut values);
                    if !values.iter().all(|v| v.is_finite()) {
                        return Err((y, x, sample));
                    }
                    sum.iter_mut().zip(&values).for_each(|(sum, value)| *sum += value);
                }
                sum.iter_mut().for_each(|sum| *sum /= f64::from(self.block));
                row.add(x, &sum, linear_srgb(self.sky.colour().xyz(&sum[..self.sky.wavelengths()])));
            }
        }
        Ok(())
    }
}
