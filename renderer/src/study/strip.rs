//! Skies from one solution: a strip of fisheyes with the sun from high to below the horizon, and the time of each.

use crate::data::Data;
use crate::film::{Development, DiscLayer, Picture, png, tone};
use crate::render::{Control, RenderError, Sky, render};
use crate::scene::Scene;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Elevations of the sun in degrees.
const SUNS: [f64; 13] = [60.0, 54.0, 48.0, 42.0, 36.0, 30.0, 24.0, 18.0, 12.0, 6.0, 0.0, -6.0, -12.0];

/// Width and height of each sky in pixels.
const SIDE: u32 = 160;

/// A strip of skies.
#[derive(Debug)]
pub struct Strip {
    /// Seconds to make the tables.
    pub solve_seconds: f64,
    /// Of each sky.
    pub skies: Vec<One>,
    /// Eight-bit sRGB pixels, row by row, and the size.
    pub pixels: Vec<u8>,
    /// Width and height.
    pub size: (u32, u32),
}

/// A sky of a strip.
#[derive(Debug, Clone, Copy)]
pub struct One {
    /// The sun's elevation in degrees.
    pub elevation_deg: f64,
    /// Seconds from the tables to the picture.
    pub seconds: f64,
    /// Exposure in EV at ISO 100.
    pub exposure_ev: f64,
    /// Relative error that the tables state.
    pub table_error: f64,
}

/// Renders clear skies at 16 wavelengths from the ground, each with an automatic exposure; the tables are solved once.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes, or the tables do not reach as far.
pub fn make(data: &Data, progress: &(dyn Fn(f64) + Sync)) -> Result<Strip, RenderError> {
    let scene = |elevation: f64| Scene {
        sun_elevation_deg: elevation,
        width: Some(SIDE),
        height: Some(SIDE),
        sun_disc: false,
        ..Scene::default()
    };
    let start = Instant::now();
    // Of one pixel: nothing is looked at yet.
    let mut sky = Sky::new(&Scene { width: Some(1), height: Some(1), ..scene(SUNS[0]) }, data)?;
    let solve_seconds = start.elapsed().as_secs_f64();
    let size = (SIDE * SUNS.len() as u32, SIDE);
    let mut pixels = vec![0; 3 * size.0 as usize * size.1 as usize];
    let mut skies = Vec::new();
    for (i, elevation) in SUNS.into_iter().enumerate() {
        let start = Instant::now();
        let scene = scene(elevation);
        sky.turn(&scene)?;
        let rendering = render(&scene, &sky, Control { stop: &AtomicBool::new(false), observe: &|_| {} })?;
        let seconds = start.elapsed().as_secs_f64();
        let picture = Picture { film: &rendering.film, disc: &DiscLayer::new(), colour: sky.colour() };
        let exposure = tone::automatic_ev(rendering.film.luminances());
        let development = Development::new(scene.tone, scene.white, sky.sun_white(), exposure);
        for (y, row) in png::pixels(&picture, &development).chunks_exact(3 * SIDE as usize).enumerate() {
            let first = 3 * (y * size.0 as usize + i * SIDE as usize);
            pixels[first..first + row.len()].copy_from_slice(row);
        }
        let table_error = sky.table_error().unwrap_or(f64::NAN);
        skies.push(One { elevation_deg: elevation, seconds, exposure_ev: exposure, table_error });
        progress((i + 1) as f64 / SUNS.len() as f64);
    }
    Ok(Strip { solve_seconds, skies, pixels, size })
}
