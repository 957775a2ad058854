//! Numbers of steps: points on the lines of sight of single scattering and of its closure, steps between the levels of solved tables.

use super::{Cell, Map, Size, dome, errors, rms};
use crate::bench::{medium, towards, visible};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::render::RenderError;
use crate::transport::rungs::{Cheap, Rung};
use crate::transport::{Method, Resolution, Solved};
use rayon::prelude::*;
use tables::units::EARTH_RADIUS_M;
use tables::views::Biome;

const SHAPE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };
const WAVELENGTHS: usize = 4;
const ALBEDO: [f64; WAVELENGTHS] = [0.1; WAVELENGTHS];
const EYE_M: f64 = 2.0;
const DIRECTIONS: u32 = 48;

/// Elevations of the sun in degrees.
const SUNS: [f64; 11] = [-10.0, -6.0, -4.0, -2.0, 0.0, 1.0, 2.0, 5.0, 15.0, 30.0, 60.0];

/// Points on a line, and how many are beyond doubt.
const POINTS: [u32; 8] = [2, 4, 8, 16, 32, 64, 128, 256];
const MANY: u32 = 4096;

/// Steps between two levels.
const PARTS: [usize; 6] = [1, 2, 4, 6, 8, 16];

/// The maps of rural air.
pub(super) fn make(data: &Data, _: Size, progress: &(dyn Fn(f64) + Sync)) -> Result<Vec<Map>, RenderError> {
    let medium = medium::<WAVELENGTHS>(data, Some(Biome::Rural), &visible())?;
    let (from, directions) = (Place::above(EYE_M), dome(DIRECTIONS));
    let mut lines = Vec::new();
    for (i, method) in [Method::Single, Method::Isotropic].into_iter().enumerate() {
        let rung = |steps| Cheap::new(method, &medium, SHAPE, ALBEDO, Some(steps));
        let look = |rung: &Cheap<WAVELENGTHS>, elevation: f64| -> Vec<[f64; WAVELENGTHS]> {
            let sun = towards(90.0 - elevation, 0.0);
            directions.par_iter().map(|&direction| rung.radiance(from, direction, sun)).collect()
        };
        let Some(best) = rung(MANY) else { continue };
        let right = SUNS.map(|elevation| look(&best, elevation));
        for (k, points) in POINTS.into_iter().enumerate() {
            let Some(rung) = rung(points) else { continue };
            for (elevation, right) in SUNS.into_iter().zip(&right) {
                let off = rms(&errors(&look(&rung, elevation), right));
                let cell = Cell::new(Rung::of(method).name, [points.to_string(), elevation.to_string()]);
                lines.push(cell.found(off, off / f64::from(MANY / points).powi(2)));
            }
            progress(0.25 * (i as f64 + (k + 1) as f64 / POINTS.len() as f64));
        }
    }
    let best = Solved::new(&medium, SHAPE, ALBEDO, &Resolution { parts: 64, ..Resolution::RENDER })?;
    let mut tables = Vec::new();
    for (k, parts) in PARTS.into_iter().enumerate() {
        let solved = best.again(&Resolution { parts, ..Resolution::RENDER }, None)?;
        for elevation in SUNS {
            let off = solved.difference(&best, from, towards(90.0 - elevation, 0.0));
            let cell = Cell::new("solved", [parts.to_string(), elevation.to_string()]);
            tables.push(cell.found(off, off / (64.0 / parts as f64).powi(2)));
        }
        progress(0.5 + 0.5 * (k + 1) as f64 / PARTS.len() as f64);
    }
    let map = |name: &str, title: &str, abscissa, cells| Map {
        name: name.into(),
        title: title.into(),
        axes: [abscissa, "sun elevation / degrees"],
        cells,
    };
    Ok(vec![
        map("steps-lines", "rural air: what the number of points on a line of sight leaves", "points on a line", lines),
        map("steps-tables", "rural air: what the steps of the first order leave", "steps between two levels", tables),
    ])
}
