//! Wavelength, from where ozone leaves no sunlight to where air hardly scatters: solved tables, closures, and what they state.

use super::{ASKED_ERROR, Cell, MOST_ERROR, Map, Size, dome, errors, rms};
use crate::bench::{medium, towards};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::render::RenderError;
use crate::transport::rungs::{Cheap, Rung};
use crate::transport::{FINER, Method, Resolution, Solved, Tables};
use rayon::prelude::*;
use tables::units::EARTH_RADIUS_M;

const SHAPE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

/// Wavelengths in nm.
const NM: [f64; 16] =
    [300.0, 305.0, 310.0, 315.0, 320.0, 330.0, 340.0, 360.0, 400.0, 450.0, 500.0, 550.0, 600.0, 700.0, 850.0, 1000.0];

/// Elevations of the sun in degrees.
const SUNS: [f64; 11] = [-12.0, -8.0, -6.0, -4.0, -2.0, 0.0, 2.0, 5.0, 15.0, 30.0, 60.0];

const EYE_M: f64 = 2.0;
const ALBEDO: [f64; 16] = [0.1; 16];
const DIRECTIONS: u32 = 48;

/// Finer than any that the renderer takes.
const FINEST: Resolution =
    Resolution { levels: 48, suns: 72, zeniths: [14, 8, 10], parts: 16, degree: 2, change: 2e-5 };

/// The map of clear air.
pub(super) fn make(data: &Data, size: Size, progress: &(dyn Fn(f64) + Sync)) -> Result<Vec<Map>, RenderError> {
    let medium = medium::<16>(data, None, &NM)?;
    let best = if size == Size::Full { FINEST } else { Resolution::FINE };
    let reference = Solved::new(&medium, SHAPE, ALBEDO, &best)?;
    progress(0.5);
    let (from, directions) = (Place::above(EYE_M), dome(DIRECTIONS));
    let tables =
        |error| Tables::within(error, (from, towards(0.0, 0.0), &[] as &[_]), (&medium, SHAPE, ALBEDO, false), None);
    let mut solved = vec![("solved: usual tables", tables(f64::INFINITY)?)];
    if size == Size::Full {
        solved.push(("solved: finest tables", tables(0.0)?));
    }
    let cheap = [Method::Isotropic, Method::Single]
        .into_iter()
        .filter_map(|method| Some((Rung::of(method).name, Cheap::new(method, &medium, SHAPE, ALBEDO, None)?)));
    let cheap: Vec<_> = cheap.collect();
    let next = if size == Size::Full { Resolution::FINE } else { Resolution::RENDER };
    let next = reference.again(&next, None)?;
    let mut cells = Vec::new();
    for (k, elevation) in SUNS.into_iter().enumerate() {
        let sun = towards(90.0 - elevation, 0.0);
        let look = |solved: &Solved<16>| -> Vec<[f64; 16]> {
            directions.par_iter().map(|&direction| solved.radiance(from, direction, sun, false)).collect()
        };
        let right = look(&reference);
        let known = errors(&look(&next), &right).map(|off| FINER * off);
        let cell = |name: &str, j: usize| Cell::new(name, [NM[j].to_string(), elevation.to_string()]);
        for (name, tables) in &solved {
            let off = errors(&look(&tables.solved), &right);
            let stated = tables.errors(from, sun, &[]);
            let whole = rms(&stated);
            for j in 0..NM.len() {
                let cell = cell(name, j).found(off[j], known[j]).bound(ASKED_ERROR);
                cells.push(cell.stated(stated[j], whole.is_nan() || whole > MOST_ERROR));
            }
        }
        for (name, rung) in &cheap {
            let seen: Vec<[f64; 16]> = directions.par_iter().map(|&d| rung.radiance(from, d, sun)).collect();
            let off = errors(&seen, &right);
            cells.extend((0..NM.len()).map(|j| cell(name, j).found(off[j], known[j])));
        }
        progress(0.5 + 0.5 * (k + 1) as f64 / SUNS.len() as f64);
    }
    Ok(vec![Map {
        name: "wavelengths".into(),
        title: "clear air: rms error of radiance over the dome, each wavelength by itself".into(),
        axes: ["wavelength / nm", "sun elevation / degrees"],
        cells,
    }])
}
