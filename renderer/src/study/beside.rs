//! A whole picture at one wavelength, error against cost: solved tables beside paths and beside Mitsuba 3.
//!
//! The skies are those of [`crate::bench`]. Paths and Mitsuba's take four times as long for half of the error; a table has a picture of its own
//! error. What Mitsuba takes is not measured here: see `CASES`.

use super::solved::dome;
use super::{Chart, Point};
use crate::bench::{self, Case, EYE_M, PIXELS, SHAPE, fisheye, towards};
use crate::data::Data;
use crate::geometry::Place;
use crate::render::{RenderError, certify_table};
use crate::transport::{Estimator, Fineness, Panorama, Pixels, SolveError, Solved};
use std::time::Instant;

/// Of each of [`bench::cases`] what it is, and the core-seconds that a picture takes Mitsuba 3 to a standard error of 1 %: measured once on one
/// core with AVX-512 in its fastest set-up, an `llvm` variant with the air as a grid of 200 cells and `volpath`, as paths a second (608 000, 2.25 million,
/// 103 000, 473 000) and the relative standard deviations of single ones, the mean over the directions of the case.
const CASES: [(&str, f64); 4] = [
    ("clear, 450 nm, sun zenith 60 degrees", 4100.0),
    ("clear, 680 nm, sun zenith 60 degrees", 5000.0),
    ("aerosol, 550 nm, sun zenith 60 degrees", 35_000.0),
    ("clear, 450 nm, sun zenith 95 degrees", 807_000.0),
];

/// Errors of what converges as the root of its time, in %.
const ERRORS: [f64; 3] = [10.0, 1.0, 0.1];

/// Grids of tables, from the coarsest.
const GRIDS: [Fineness; 5] = [Fineness::Coarse, Fineness::Usual, Fineness::Middle, Fineness::Better, Fineness::Fine];

/// Error of a picture beside its table's.
const SHOWN: f64 = 5e-4;

/// Rounds of certificates in each direction of the dome.
const ROUNDS: u32 = 16;

/// Seconds that a direction is measured at least.
const LEAST_S: f64 = 0.5;

/// The chart, measured on one thread.
///
/// # Errors
/// [`RenderError`] never: the skies are sound and the planet round.
pub fn make(_: &Data, progress: &(dyn Fn(f64) + Sync)) -> Result<Chart, RenderError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let mut points = Vec::new();
    for (i, (case, (panel, mitsuba_s))) in bench::cases().into_iter().zip(CASES).enumerate() {
        let (paths_s, tables) = pool.install(|| measured(&case))?;
        let mut add = |curve: &str, at| points.push(Point { panel, curve: curve.to_owned(), at });
        tables.into_iter().for_each(|at| add("solved tables, coarse to fine: bound by certificates", at));
        for (curve, seconds) in [("paths", paths_s), ("Mitsuba 3", mitsuba_s)] {
            ERRORS.into_iter().for_each(|error| add(curve, [seconds / (error * error), error]));
        }
        progress((i + 1) as f64 / CASES.len() as f64);
    }
    Ok(Chart {
        title: "A fisheye of 320 x 320 pixels at one wavelength: its error against what it costs, tables included"
            .to_owned(),
        axes: ["core-seconds", "rms error / %"],
        points,
    })
}

/// Seconds of a picture by paths to 1 %, and of pictures of tables with their errors in %.
fn measured(case: &Case) -> Result<(f64, Vec<[f64; 2]>), RenderError> {
    let medium = case.medium().map_err(SolveError::from)?;
    let columns = bench::columns(&medium);
    let of = |view: &(f64, f64)| {
        bench::measure(case, (&medium, &columns), Estimator::Paths, *view, LEAST_S).seconds_to_1_percent()
    };
    let paths = PIXELS * case.views.iter().map(of).sum::<f64>() / case.views.len() as f64;
    let (from, sun) = (Place::above(EYE_M), towards(case.sun_zenith_deg, 0.0));
    let dome = dome();
    let mut tables = Vec::new();
    for grid in GRIDS {
        let start = Instant::now();
        let pixels = fisheye();
        let solved = Solved::new(&medium, SHAPE, [bench::ALBEDO], &grid.resolution())?;
        let seen = Panorama::new(&solved, from, sun, SHOWN, Pixels { directions: &pixels, each: 1 });
        let sum: f64 = pixels.iter().map(|direction| seen.radiance(&solved, *direction)[0]).sum();
        std::hint::black_box(sum);
        let seconds = start.elapsed().as_secs_f64();
        let verdict = certify_table(&solved, columns.clone(), (from, sun), &dome, ROUNDS);
        tables.extend(verdict.map(|verdict| [seconds, 100.0 * verdict.errors[0].most]));
    }
    Ok((paths, tables))
}
