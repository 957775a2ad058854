//! A whole picture at one wavelength, error against cost: solved tables beside paths and beside Mitsuba 3.
//!
//! The skies are those of [`crate::bench`], on which Mitsuba 3 was timed (its fastest set-up, `llvm` with the air as a grid, `volpath`; core-seconds of
//! one core). A picture is a fisheye
//! of 320 x 320. Paths and Mitsuba's take four times as long for half of the error; a table has a picture of its own error.

use super::{Chart, Point};
use crate::bench::{self, Case, EYE_M, PIXELS, SHAPE, towards};
use crate::camera::Camera;
use crate::data::Data;
use crate::geometry::Place;
use crate::render::{RenderError, certify_table};
use crate::sampling::spiral;
use crate::scene::Scene;
use crate::transport::{Estimator, Fineness, Panorama, SolveError, Solved};
use glam::DVec3;
use std::time::Instant;

/// Cases by name: what they are, and the core-seconds that a picture takes Mitsuba 3 to a standard error of 1 %.
const CASES: [(&str, &str, f64); 3] = [
    ("D450", "clear, 450 nm, sun zenith 60", 4100.0),
    ("A550", "aerosol, 550 nm, sun zenith 60", 35_000.0),
    ("T450", "clear, 450 nm, sun zenith 95", 807_000.0),
];

/// Errors of what converges as the root of its time, in %.
const ERRORS: [f64; 3] = [10.0, 1.0, 0.1];

/// Grids of tables, from the coarsest.
const GRIDS: [Fineness; 4] = [Fineness::Coarse, Fineness::Usual, Fineness::Middle, Fineness::Fine];

/// Error of a picture beside its table's.
const SHOWN: f64 = 5e-4;

/// Pixels of a picture's width.
const WIDTH: u32 = 320;

/// Directions in which certificates look, and their rounds.
const DIRECTIONS: u32 = 64;
const ROUNDS: u32 = 32;

/// Seconds that a direction is measured at least.
const LEAST_S: f64 = 0.5;

/// The chart, measured on one thread.
///
/// # Errors
/// [`RenderError`] never: the skies are sound and the planet round.
pub fn make(_: &Data, progress: &(dyn Fn(f64) + Sync)) -> Result<Chart, RenderError> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let mut points = Vec::new();
    for (i, (name, panel, mitsuba_s)) in CASES.into_iter().enumerate() {
        let case = bench::cases().into_iter().find(|case| case.name == name);
        let Some(case) = case else { continue };
        let (paths_s, tables) = pool.install(|| measured(&case))?;
        let mut add = |curve: &str, at| points.push(Point { panel, curve: curve.to_owned(), at });
        tables.into_iter().for_each(|at| add("solved tables: coarse, usual, middle, fine", at));
        for (curve, seconds) in [("paths", paths_s), ("Mitsuba 3", mitsuba_s)] {
            ERRORS.into_iter().for_each(|error| add(curve, [seconds / (error * error), error]));
        }
        progress((i + 1) as f64 / CASES.len() as f64);
    }
    Ok(Chart {
        title: "A fisheye of 320 x 320 pixels at one wavelength: its error against what it costs, tables included"
            .to_owned(),
        axes: ["core-seconds", "rms error / % (tables: bounds by certificates)"],
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
    let dome: Vec<DVec3> = (0..DIRECTIONS).map(|i| spiral(i, DIRECTIONS, [0.0, 1.0])).collect();
    let pixels = pixels();
    let mut tables = Vec::new();
    for grid in GRIDS {
        let start = Instant::now();
        let solved = Solved::new(&medium, SHAPE, [bench::ALBEDO], &grid.resolution())?;
        let seen = Panorama::new(&solved, from, sun, SHOWN, &pixels);
        let sum: f64 = pixels.iter().map(|direction| seen.radiance(&solved, *direction)[0]).sum();
        std::hint::black_box(sum);
        let seconds = start.elapsed().as_secs_f64();
        let verdict = certify_table(&solved, columns.clone(), (from, sun), &dome, ROUNDS);
        tables.extend(verdict.map(|verdict| [seconds, 100.0 * verdict.errors[0].most]));
    }
    Ok((paths, tables))
}

/// Directions of the picture's pixels.
fn pixels() -> Vec<DVec3> {
    let camera: Camera = Scene { width: Some(WIDTH), height: Some(WIDTH), ..Scene::default() }.camera();
    let pixels = (0..WIDTH * WIDTH).map(|i| (f64::from(i % WIDTH) + 0.5, f64::from(i / WIDTH) + 0.5));
    pixels.filter_map(|(x, y)| camera.direction(x, y)).collect()
}
