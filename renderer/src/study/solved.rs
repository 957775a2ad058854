//! Solved tables: their error over the sun's elevation, found by certificates, and against the cost of their grids.

use super::{Chart, Point};
use crate::atmosphere::{Columns, Tolerance};
use crate::bench::{medium, towards, visible};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::render::{RenderError, certify_table};
use crate::sampling::spiral;
use crate::transport::{Fineness, Resolution, Solved, Tables};
use glam::DVec3;
use std::time::Instant;
use tables::units::EARTH_RADIUS_M;
use tables::views::Biome;

const SHAPE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

/// Wavelengths, evenly from 380 to 780 nm, and the albedo of the ground.
const WAVELENGTHS: usize = 8;
const ALBEDO: [f64; WAVELENGTHS] = [0.1; WAVELENGTHS];

/// Altitude of the observer in m.
const EYE_M: f64 = 2.0;

/// Elevations of the sun in degrees.
const SUNS: [f64; 6] = [60.0, 30.0, 10.0, 2.0, 0.0, -5.0];

/// Directions of the dome, and rounds of fans in each.
const DIRECTIONS: u32 = 64;
const ROUNDS: u32 = 6;

/// Panels: what certificates find that the error is below, and what tables state.
const USUAL: [&str; 2] =
    ["usual tables: below, with 95 % confidence (certificates)", "usual tables: stated (from coarser ones)"];
const FINEST: [&str; 2] =
    ["finest tables: below, with 95 % confidence (certificates)", "finest tables: stated (from coarser ones)"];

/// Of polarised light: elevations of the sun in degrees, rounds of fans in clear air and with aerosol, and panels: what certificates find
/// that the errors of I, Q and U are below, and what they find.
const POLARISED_SUNS: [f64; 4] = [60.0, 10.0, 2.0, 0.0];
const POLARISED_ROUNDS: [u32; 2] = [24, 3];
const BELOW: [&str; 3] = ["below: I", "below: Q", "below: U"];
const RMS: [&str; 3] = ["found (rms): I", "found (rms): Q", "found (rms): U"];

/// Directions above the horizon, even in solid angle.
pub(super) fn dome() -> Vec<DVec3> {
    (0..DIRECTIONS).map(|i| spiral(i, DIRECTIONS, [0.0, 1.0])).collect()
}

/// Clear air and the nine biomes.
fn airs() -> Vec<Option<Biome>> {
    std::iter::once(None).chain(Biome::ALL.into_iter().map(Some)).collect()
}

fn curve(biome: Option<Biome>) -> String {
    biome.map_or("clear", Biome::name).to_owned()
}

/// Error of tables as the renderer takes them over the sun's elevation, for clear air and the nine biomes: what certificates find it is
/// below, and what the tables state; of the usual ones, and of the finest.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn suns(data: &Data, progress: &(dyn Fn(f64) + Sync)) -> Result<Chart, RenderError> {
    let all = airs();
    let mut points = Vec::new();
    for (i, &biome) in all.iter().enumerate() {
        let medium = medium::<WAVELENGTHS>(data, biome, &visible())?;
        let columns = Columns::new(&medium, SHAPE, Tolerance::RENDER);
        let from = Place::above(EYE_M);
        // Any error is small enough for the usual tables, none for the finest.
        for (k, (error, [below, stated])) in [(f64::INFINITY, USUAL), (0.0, FINEST)].into_iter().enumerate() {
            let high = (from, towards(90.0 - SUNS[0], 0.0), &[] as &[_]);
            let tables = Tables::within(error, high, (&medium, SHAPE, ALBEDO, false), None)?;
            for (n, &elevation) in SUNS.iter().enumerate() {
                let sun = towards(90.0 - elevation, 0.0);
                let mut add = |panel, value| {
                    points.push(Point { panel, curve: curve(biome), at: [elevation, 100.0 * value] });
                };
                if let Some(verdict) = certify_table(&tables.solved, columns.clone(), (from, sun), &dome(), ROUNDS) {
                    verdict.errors.iter().for_each(|error| add(below, error.most));
                }
                add(stated, tables.error(from, sun, &[]));
                let done = k as f64 + (n + 1) as f64 / SUNS.len() as f64;
                progress((i as f64 + 0.5 * done) / all.len() as f64);
            }
        }
    }
    points.sort_by_key(|point| point.panel);
    Ok(Chart {
        title: "Solved tables over the sun's elevation: error of radiance, 64 directions, 8 wavelengths".to_owned(),
        axes: ["sun elevation / degrees", "relative error / %"],
        points,
    })
}

/// Errors of the usual tables of polarised light by day, clear air and the nine biomes: what certificates find, of I, Q and U, relative to I.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn polarised_suns(data: &Data, progress: &(dyn Fn(f64) + Sync)) -> Result<Chart, RenderError> {
    let all = airs();
    let mut points = Vec::new();
    for (i, &biome) in all.iter().enumerate() {
        let medium = medium::<WAVELENGTHS>(data, biome, &visible())?;
        let columns = Columns::new(&medium, SHAPE, Tolerance::RENDER);
        let solved = Solved::polarised(&medium, SHAPE, ALBEDO, &Resolution::RENDER)?;
        let rounds = POLARISED_ROUNDS[usize::from(biome.is_some())];
        for (n, &elevation) in POLARISED_SUNS.iter().enumerate() {
            let at = (Place::above(EYE_M), towards(90.0 - elevation, 0.0));
            if let Some(verdict) = certify_table(&solved, columns.clone(), at, &dome(), rounds) {
                for (error, (below, rms)) in verdict.errors.iter().zip(BELOW.into_iter().zip(RMS)) {
                    for (panel, value) in [(below, error.most), (rms, error.rms)] {
                        points.push(Point { panel, curve: curve(biome), at: [elevation, 100.0 * value] });
                    }
                }
            }
            progress((i as f64 + (n + 1) as f64 / POLARISED_SUNS.len() as f64) / all.len() as f64);
        }
    }
    points.sort_by_key(|point| point.panel);
    Ok(Chart {
        title: "Solved tables of polarised light: errors found, and what they are below with 95 % confidence"
            .to_owned(),
        axes: ["sun elevation / degrees", "error relative to I / %"],
        points,
    })
}

/// The renderer's resolution with one part replaced by its number i of four.
type Vary = fn(Resolution, usize) -> Resolution;

/// What is varied.
const VARIED: [(&str, Vary); 6] = [
    ("levels", |r, i| Resolution { levels: [8, 12, 16, 24][i], ..r }),
    ("suns", |r, i| Resolution { suns: [20, 28, 40, 56][i], ..r }),
    ("zenith angles", |r, i| Resolution { zeniths: [[3, 2, 2], [4, 3, 3], [6, 3, 4], [9, 5, 7]][i], ..r }),
    ("steps between levels", |r, i| Resolution { parts: [1, 3, 6, 12][i], ..r }),
    ("degree of moments", |r, i| Resolution { degree: [4, 8, 14, 20][i], ..r }),
    ("change by the last order", |r, i| Resolution { change: [3e-2, 5e-3, 5e-4, 5e-5][i], ..r }),
];

/// Panels, and zenith angles of the sun in degrees.
const SEEN: [(&str, f64); 3] = [("sun at 30 degrees", 60.0), ("sun at 0 degrees", 90.0), ("sun at -5 degrees", 95.0)];

/// Error against cost: one part of the resolution at a time coarser or finer than the renderer's, and the grids that have names, in desert dust,
/// against a table that is finer in everything. On one thread.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn grids(data: &Data, progress: &(dyn Fn(f64) + Sync)) -> Result<Chart, RenderError> {
    let medium = medium::<WAVELENGTHS>(data, Some(Biome::DesertDust), &visible())?;
    let best = Resolution { levels: 32, suns: 64, zeniths: [12, 7, 9], parts: 16, degree: 24, change: 2e-5 };
    let reference = Solved::new(&medium, SHAPE, ALBEDO, &best)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let named = Fineness::ALL.into_iter().filter(|grid| *grid != Fineness::Finest);
    let varied = VARIED.iter().flat_map(|(name, vary)| (0..4).map(|i| (*name, vary(Resolution::RENDER, i))));
    let all: Vec<_> = varied.chain(named.map(|grid| ("grids by name", grid.resolution()))).collect();
    let mut rows = Vec::new();
    for (name, resolution) in &all {
        let start = Instant::now();
        let solved = pool.install(|| Solved::new(&medium, SHAPE, ALBEDO, resolution))?;
        let seconds = start.elapsed().as_secs_f64();
        let off = SEEN.map(|(_, zenith)| solved.difference(&reference, Place::above(EYE_M), towards(zenith, 0.0)));
        rows.push((*name, seconds, off));
        progress(rows.len() as f64 / all.len() as f64);
    }
    let point = |panel, k: usize| {
        rows.iter().map(move |&(name, seconds, off)| Point {
            panel,
            curve: String::from(name),
            at: [seconds, 100.0 * off[k]],
        })
    };
    let points = (0..).zip(SEEN).flat_map(|(k, (panel, _))| point(panel, k)).collect();
    Ok(Chart {
        title: "Solved tables of desert dust, 8 wavelengths: difference from a finer one against the time to solve"
            .to_owned(),
        axes: ["core-seconds", "rms difference over mean / %"],
        points,
    })
}
