//! Reference cases: radiances and fluxes of given profiles, layers and phase
//! functions, read from JSON and answered as a table of values with their errors.
//!
//! Every quantity is per unit solar irradiance perpendicular to a parallel beam. The sun stands at
//! azimuth 0 and zenith angle `sza_deg` at the observer's vertical; the view is the
//! direction looked in, its azimuth counted from the sun's. A case whose `polarization` is `vector` gets polarised
//! transfer: its radiance is I, and `stokes_Q` and `stokes_U` refer to the horizontal (docs/polarisation.md).

mod bounded;
mod input;
mod physics;

pub use input::{CasesError, Suite, Tier, parse, read};

use crate::sampling::{POINTS, Sampler};
use crate::transport::Estimator;
use physics::{Estimand, Sample, Shared};
use rayon::prelude::*;
use std::sync::atomic::{AtomicUsize, Ordering};

/// What answers cases.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// Solved tables, with the error that they state.
    Solved,
    /// Certificates of the usual solved tables ([`crate::transport::Certificate`]): fans that end in them, unbiased.
    Certified,
    /// Paths.
    Sampled(Estimator),
}

/// How much to sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Effort {
    /// Until the standard error of a case is at most this share of its value; of I for a Stokes parameter.
    Error(f64),
    /// That many paths a case, or fans.
    Paths(u64),
}

/// What to answer and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Which cases.
    pub tier: Tier,
    /// What answers.
    pub method: Method,
    /// How much to sample.
    pub effort: Effort,
    /// Seed of the random numbers; case k of the file uses it as pixel k.
    pub seed: u64,
}

/// An answered case.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The case's `id`.
    pub id: String,
    /// Mean of the estimates.
    pub value: f64,
    /// Its standard error.
    pub stderr: f64,
    /// Paths taken, or fans.
    pub paths: u64,
}

/// A case that is not answered.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    /// The case's `id`.
    pub id: String,
    /// Why, in a phrase that equal refusals share.
    pub why: String,
}

/// Everything that was asked of a suite.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Report {
    /// In the order of the file.
    pub answers: Vec<Answer>,
    /// In the order of the file.
    pub refusals: Vec<Refusal>,
}

/// Answers the cases of a tier in parallel; `progress` hears (cases done, cases in all).
/// Equal settings give equal answers, whatever the number of threads.
#[must_use]
pub fn run(suite: &Suite, settings: &Settings, progress: &(dyn Fn(usize, usize) + Sync)) -> Report {
    let cases: Vec<_> = suite.cases.iter().enumerate().filter(|(_, case)| settings.tier.takes(&case.tier)).collect();
    let shared = Shared::new(cases.iter().map(|(_, case)| &***case), &suite.profiles, settings.method);
    let (done, all) = (AtomicUsize::new(0), cases.len());
    let results: Vec<Result<Answer, Refusal>> = cases
        .into_par_iter()
        .map(|(index, case)| {
            let result = physics::prepare(case, &suite.profiles, &shared, settings.method)
                .map(|estimand| estimate(&case.id, &estimand, settings, index as u64))
                .map_err(|why| Refusal { id: case.id.clone(), why });
            progress(done.fetch_add(1, Ordering::Relaxed) + 1, all);
            result
        })
        .collect();
    let mut report = Report::default();
    for result in results {
        match result {
            Ok(answer) => report.answers.push(answer),
            Err(refusal) => report.refusals.push(refusal),
        }
    }
    report
}

/// The answers as CSV: `id,value,stderr`, numbers with all their digits.
#[must_use]
pub fn to_csv(answers: &[Answer]) -> String {
    let mut text = String::from("id,value,stderr\n");
    for Answer { id, value, stderr, .. } in answers {
        let quoted =
            if id.contains([',', '"', '\n']) { format!("\"{}\"", id.replace('"', "\"\"")) } else { id.clone() };
        text.push_str(&format!("{quoted},{value:e},{stderr:e}\n"));
    }
    text
}

/// Independent replicates of a run, each a scrambled Sobol sequence: their spread is the error.
const REPLICATES: u64 = 32;

/// Paths of each replicate of the pilot run, which only tells how many the run itself needs.
const PILOT: u64 = 64;

/// The fewest paths of each replicate of a run: the spread of shorter ones does not tell yet how rare the rare is.
const LEAST: u64 = 256;

/// The most paths that one case may take (minutes): where the asked error needs
/// more, the answer states the error that was reached.
const MOST_PATHS: u64 = 1 << 28;

/// Paths without any light after which a case is taken for dark: a relative error
/// cannot be had of nothing.
const DARK_PATHS: u64 = 1 << 20;

/// Share of a value that the tables may be off, twice what single scattering shows against quadratures, and what of the
/// solar irradiance is not resolved at all: a standard error is never said to be smaller.
const TABLES: (f64, f64) = (5e-5, 1e-9);

/// A pilot measures the variance and is then thrown away, so that
/// the run's own mean does not decide when it stops; if its error still
/// comes out too large, replicates of as many paths are added.
fn estimate(id: &str, estimand: &Estimand, settings: &Settings, index: u64) -> Answer {
    if let Some(value) = estimand.exact() {
        return Answer { id: id.into(), value, stderr: TABLES.1 * estimand.f0(), paths: 0 };
    }
    if let Some((value, stderr)) = estimand.solution() {
        return Answer { id: id.into(), value, stderr, paths: 0 };
    }
    if let Some((value, stderr, fans)) = estimand.certified(settings, index) {
        return Answer { id: id.into(), value, stderr, paths: fans };
    }
    let replicates = |moments: &mut Moments, seed: u64, to: u64, points: u64| {
        for replicate in moments.count..to {
            let mut sum = Sample { value: 0.0, scale: 0.0 };
            for point in 0..points {
                let mut sampler = Sampler::sobol(seed, index, replicate, point as u32);
                let Sample { value, scale } = estimand.sample(&mut sampler);
                sum = Sample { value: sum.value + value, scale: sum.scale + scale };
            }
            moments.add(Sample { value: sum.value / points as f64, scale: sum.scale / points as f64 });
        }
    };
    let mut run = Moments::default();
    let points = match settings.effort {
        Effort::Paths(paths) => {
            // As many replicates as make equal parts of the paths, at least two.
            let count = (2..=REPLICATES.min(paths)).rev().find(|n| paths % n == 0 && paths / n <= POINTS);
            let count = count.unwrap_or_else(|| paths.div_ceil(POINTS));
            replicates(&mut run, settings.seed, count, paths / count);
            paths / count
        }
        Effort::Error(error) => {
            let mut points = PILOT;
            let mut pilot = Moments::default();
            replicates(&mut pilot, !settings.seed, REPLICATES, points);
            let paths = pilot.needed(error).saturating_mul(points).clamp(REPLICATES * LEAST, MOST_PATHS);
            points = (paths / REPLICATES).next_power_of_two().min(POINTS);
            let mut target = paths.div_ceil(points).max(REPLICATES);
            loop {
                replicates(&mut run, settings.seed, target, points);
                if run.scale == 0.0 && run.count * points >= DARK_PATHS {
                    break;
                }
                let reached = run.scale != 0.0 && run.stderr() <= error * run.scale.abs();
                if reached || run.count * points >= MOST_PATHS {
                    break;
                }
                target = run.needed(error).max(run.count + run.count / 4).min(MOST_PATHS / points);
            }
            points
        }
    };
    let (relative, absolute) = TABLES;
    let tables = (relative * run.scale).hypot(absolute * estimand.f0());
    Answer { id: id.into(), value: run.mean, stderr: run.stderr().hypot(tables), paths: run.count * points }
}

/// Count, means and sum of squared deviations (Welford 1962).
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    count: u64,
    mean: f64,
    squares: f64,
    /// Mean of what relative errors refer to.
    scale: f64,
}

impl Moments {
    fn add(&mut self, Sample { value, scale }: Sample) {
        self.count += 1;
        let before = value - self.mean;
        self.mean += before / self.count as f64;
        self.squares += before * (value - self.mean);
        self.scale += (scale - self.scale) / self.count as f64;
    }

    fn variance(&self) -> f64 {
        if self.count > 1 { self.squares / (self.count - 1) as f64 } else { f64::INFINITY }
    }

    fn stderr(&self) -> f64 {
        (self.variance() / self.count.max(1) as f64).sqrt()
    }

    /// Samples for a relative standard error, with a tenth to spare; ten times
    /// more if nothing has been seen yet.
    fn needed(&self, error: f64) -> u64 {
        if self.scale == 0.0 {
            return self.count.saturating_mul(10);
        }
        (1.1 * self.variance() / (error * self.scale).powi(2)).ceil().min(MOST_PATHS as f64) as u64
    }
}

#[cfg(test)]
mod tests;
