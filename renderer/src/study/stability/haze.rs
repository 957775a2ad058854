//! Sun elevation and optical depth of aerosol: every method of the ladder that has a radiance, and the fitted skies by their luminance.

use super::{ASKED_ERROR, Cell, MOST_ERROR, Map, Size, dome, errors, rms};
use crate::atmosphere::{Columns, Haze, Medium, Tolerance};
use crate::bench::{towards, visible};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::light::SunDisc;
use crate::render::{RenderError, Sky, certify_table};
use crate::sampling::Sampler;
use crate::scene::{Scene, SceneError};
use crate::spectrum::{Colour, Wavelengths};
use crate::transport::rungs::{Cheap, Conditions, Rung};
use crate::transport::{self, Estimator, FINER, Method, Problem, Resolution, Solved, Tables};
use glam::DVec3;
use rayon::prelude::*;
use tables::units::{EARTH_RADIUS_M, KM};
use tables::views::Biome;

const SHAPE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

/// Wavelengths, evenly from 380 to 780 nm, and the albedo of the ground.
const WAVELENGTHS: usize = 8;
const ALBEDO: f64 = 0.1;

/// Altitude of the observer in m, and the directions that are looked in.
const EYE_M: f64 = 2.0;
const DIRECTIONS: u32 = 48;

/// Elevations of the sun in degrees.
const SUNS: [f64; 13] = [-15.0, -12.0, -10.0, -8.0, -6.0, -4.0, -2.0, 0.0, 2.0, 8.0, 20.0, 45.0, 90.0];
const FEW_SUNS: [f64; 7] = [-15.0, -12.0, -8.0, -4.0, 0.0, 8.0, 60.0];

/// Optical depths of the aerosol at 550 nm.
const DEPTHS: [f64; 7] = [0.0, 0.03, 0.1, 0.3, 0.8, 1.5, 3.0];
const FEW_DEPTHS: [f64; 4] = [0.0, 0.1, 0.8, 3.0];

/// Finer than any that the renderer takes.
const FINEST: Resolution =
    Resolution { levels: 40, suns: 64, zeniths: [12, 7, 9], parts: 16, degree: 24, change: 2e-5 };

/// Samples of paths.
const SAMPLES: u32 = 16;

/// Where certificates look: elevations of the sun and optical depths; and the rounds that they go.
const CERTIFIED: ([f64; 5], [f64; 3]) = ([-10.0, -5.0, 0.0, 10.0, 60.0], [0.1, 0.8, 3.0]);
const ROUNDS: u32 = 2;

/// Sunlit air of one aerosol and amount, with its methods.
struct Air {
    scene: Scene,
    medium: Medium<WAVELENGTHS>,
    turbidity: f64,
}

impl Air {
    fn new(data: &Data, biome: Biome, depth: f64) -> Result<Self, RenderError> {
        let (biome, aod) = if depth > 0.0 { (Some(biome), Some(depth)) } else { (None, None) };
        let scene = Scene {
            biome,
            aod,
            method: Method::Paths,
            follow_polarisation: Some(false),
            width: Some(1),
            height: Some(1),
            ..Scene::default()
        };
        let sky = Sky::new(&scene, data)?;
        let medium = sky.air().medium(&visible())?;
        let turbidity = 1.0 + sky.air().haze().map_or(0.0, Haze::optical_depth) / sky.air().molecular_depth()?;
        Ok(Self { scene, medium, turbidity })
    }

    /// Whether a method covers a sun.
    fn covers(&self, method: Method, elevation: f64) -> bool {
        let asked = Conditions {
            sun_elevation_deg: elevation,
            altitude_km: EYE_M / KM,
            turbidity: self.turbidity,
            polarised: false,
            flat: false,
        };
        Rung::of(method).covers(&asked).is_ok()
    }
}

/// The maps of desert dust and of urban aerosol, and what certificates find of the usual tables of both.
pub(super) fn make(data: &Data, size: Size, progress: &(dyn Fn(f64) + Sync)) -> Result<Vec<Map>, RenderError> {
    let biomes: &[Biome] = match size {
        Size::Full => &[Biome::DesertDust, Biome::Urban],
        Size::Quick => &[Biome::DesertDust],
    };
    let (suns, depths): (&[f64], &[f64]) = match size {
        Size::Full => (&SUNS, &DEPTHS),
        Size::Quick => (&FEW_SUNS, &FEW_DEPTHS),
    };
    let mut maps = Vec::new();
    let mut certified = Vec::new();
    for (i, &biome) in biomes.iter().enumerate() {
        let mut cells = Vec::new();
        for (k, &depth) in depths.iter().enumerate() {
            let air = Air::new(data, biome, depth)?;
            cells.extend(of_air(data, &air, (depth, size), suns)?);
            progress((i as f64 + 0.7 * (k + 1) as f64 / depths.len() as f64) / biomes.len() as f64);
        }
        maps.push(Map {
            name: format!("haze-{}", biome.name()),
            title: format!("{}: rms error of radiance over the dome", biome.name().replace('-', " ")),
            axes: ["sun elevation / degrees", "optical depth at 550 nm"],
            cells,
        });
        if size == Size::Full {
            for (k, depth) in CERTIFIED.1.into_iter().enumerate() {
                certified.extend(certify(&Air::new(data, biome, depth)?, biome, depth)?);
                progress((i as f64 + 0.7 + 0.3 * (k + 1) as f64 / CERTIFIED.1.len() as f64) / biomes.len() as f64);
            }
        }
    }
    if !certified.is_empty() {
        maps.push(Map {
            name: "haze-certified".into(),
            title: "solved tables: rms error over the dome, by certificates".into(),
            axes: ["sun elevation / degrees", "optical depth at 550 nm"],
            cells: certified,
        });
    }
    Ok(maps)
}

/// Of every direction the radiances.
type Seen = Vec<[f64; WAVELENGTHS]>;

fn of_air(data: &Data, air: &Air, (depth, size): (f64, Size), suns: &[f64]) -> Result<Vec<Cell>, RenderError> {
    let (from, directions) = (Place::above(EYE_M), dome(DIRECTIONS));
    let (medium, albedo) = (&air.medium, [ALBEDO; WAVELENGTHS]);
    let tables =
        |error| Tables::within(error, (from, towards(0.0, 0.0), &[] as &[_]), (medium, SHAPE, albedo, false), None);
    let usual = tables(f64::INFINITY)?;
    let finest = if size == Size::Full { Some(tables(0.0)?) } else { None };
    let best = if size == Size::Full { FINEST } else { Resolution::FINE };
    let reference = Solved::new(medium, SHAPE, albedo, &best)?;
    let cheap = |method| Cheap::new(method, medium, SHAPE, albedo, None);
    let cheap: Vec<_> = [Method::Isotropic, Method::Single, Method::Oneil]
        .into_iter()
        .filter_map(|method| Some((method, cheap(method)?)))
        .collect();
    let columns = Columns::new(medium, SHAPE, Tolerance::RENDER);
    let colour = Colour::new(
        &data.sun,
        &data.observer,
        &data.ozone_cross_section,
        &Wavelengths::visible(WAVELENGTHS).map_err(SceneError::from)?,
    )?;
    let mut cells = Vec::new();
    for &elevation in suns {
        let sun = towards(90.0 - elevation, 0.0);
        let look = |of: &(dyn Fn(DVec3) -> [f64; WAVELENGTHS] + Sync)| -> Seen {
            directions.par_iter().map(|&direction| of(direction)).collect()
        };
        let right = look(&|direction| reference.radiance(from, direction, sun, false));
        let next = finest.as_ref().unwrap_or(&usual);
        let known = FINER * rms(&errors(&look(&|d| next.solved.radiance(from, d, sun, false)), &right));
        let cell = |method: &str| Cell::new(method, [elevation.to_string(), depth.to_string()]);
        let solved = [("solved: usual tables", Some(&usual)), ("solved: finest tables", finest.as_ref())];
        for (name, tables) in solved.into_iter().filter_map(|(name, tables)| Some((name, tables?))) {
            let off = rms(&errors(&look(&|d| tables.solved.radiance(from, d, sun, false)), &right));
            let stated = tables.error(from, sun, &dome(64));
            let refused = stated.is_nan() || stated > MOST_ERROR;
            cells.push(cell(name).found(off, known).bound(ASKED_ERROR).stated(stated, refused));
        }
        let disc = SunDisc::beam(sun);
        let problem = Problem {
            texture: None,
            shape: SHAPE,
            medium,
            columns: &columns,
            albedo,
            sun: Some(&disc),
            environment: None,
            max_orders: None,
        };
        let traced = |pixel: u64, direction| {
            let mut sum = [0.0; WAVELENGTHS];
            for sample in 0..SAMPLES {
                let mut sampler = Sampler::sobol(1, pixel, 0, sample);
                let one = transport::radiance(Estimator::Paths, &problem, from, direction, &mut sampler);
                sum.iter_mut().zip(one).for_each(|(sum, one)| *sum += one / f64::from(SAMPLES));
            }
            sum
        };
        let paths: Seen = (0..).zip(&directions).map(|(pixel, &direction)| traced(pixel, direction)).collect();
        cells.push(cell("paths: 16 samples").found(rms(&errors(&paths, &right)), known));
        for (method, rung) in &cheap {
            let cell = cell(Rung::of(*method).name);
            cells.push(if air.covers(*method, elevation) {
                let off = rms(&errors(&look(&|d| rung.radiance(from, d, sun)), &right));
                let cell = cell.found(off, known);
                match rung.stated(from, sun) {
                    Some(stated) => cell.stated(stated.whole(), false),
                    None => cell,
                }
            } else {
                cell.refused()
            });
        }
        for method in [Method::HosekWilkie, Method::Preetham] {
            let scene = Scene { method, sun_elevation_deg: elevation, ..air.scene.clone() };
            let cell = cell(&format!("{} (luminance)", Rung::of(method).name));
            cells.push(match Sky::new(&scene, data) {
                Ok(sky) => {
                    let lit: Vec<[f64; 1]> = right.iter().map(|factors| [colour.xyz(factors)[1]]).collect();
                    // In the frame of the scene the sun stands elsewhere.
                    let turn = |direction: DVec3| turned(direction, sky.sun_direction());
                    let seen = |d: &DVec3| {
                        let mut xyz = [0.0; 3];
                        sky.radiance(turn(*d), &Sampler::new(1, 0, 0), &mut xyz);
                        [xyz[1]]
                    };
                    cell.found(errors(&directions.iter().map(seen).collect::<Vec<_>>(), &lit)[0], known)
                }
                Err(RenderError::Refused(_)) => cell.refused(),
                Err(other) => return Err(other),
            });
        }
    }
    Ok(cells)
}

/// A direction about the vertical as the sun is turned from x to where it is.
fn turned(direction: DVec3, sun: DVec3) -> DVec3 {
    let Some(ahead) = DVec3::new(sun.x, sun.y, 0.0).try_normalize() else { return direction };
    ahead * direction.x + DVec3::Z.cross(ahead) * direction.y + DVec3::Z * direction.z
}

/// What certificates find of the usual tables.
fn certify(air: &Air, biome: Biome, depth: f64) -> Result<Vec<Cell>, RenderError> {
    let from = Place::above(EYE_M);
    let high = (from, towards(0.0, 0.0), &[] as &[_]);
    let tables = Tables::within(f64::INFINITY, high, (&air.medium, SHAPE, [ALBEDO; WAVELENGTHS], false), None)?;
    let columns = Columns::new(&air.medium, SHAPE, Tolerance::RENDER);
    let mut cells = Vec::new();
    for elevation in CERTIFIED.0 {
        let sun = towards(90.0 - elevation, 0.0);
        let verdict = certify_table(&tables.solved, columns.clone(), (from, sun), &dome(DIRECTIONS), ROUNDS);
        let Some(verdict) = verdict else { continue };
        let stated = tables.error(from, sun, &dome(64));
        let name = biome.name().replace('-', " ");
        let at = [elevation.to_string(), depth.to_string()];
        let cell = Cell::new(format!("{name}, usual tables"), at).bound(ASKED_ERROR);
        let refused = stated.is_nan() || stated > MOST_ERROR;
        let error = &verdict.errors[0];
        cells.push(cell.found(error.rms, error.most - error.rms).stated(stated, refused));
    }
    Ok(cells)
}
