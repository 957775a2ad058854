//! Sequences: many frames of one atmosphere, whose tables are solved once, exposed without flicker.

mod course;
mod exposure;

pub use course::{Course, Track};
pub use exposure::{smooth, steepest};

use crate::data::Data;
use crate::film::tone;
use crate::render::{Control, RenderError, Sky, render};
use crate::scene::Scene;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// The largest side in pixels of the small pictures by which frames are exposed.
const PREVIEW: u32 = 48;

/// Frames that can be rendered one after the other.
#[derive(Debug)]
pub struct Sequence {
    /// The scenes of the frames, each with the exposure of its PNG.
    pub frames: Vec<Scene>,
    /// What [`Sky::turn`] turns to each of them.
    pub sky: Sky,
    /// How often tables were solved: once, or once more on a finer grid that some frame asked for.
    pub solved: u32,
    /// The largest error that the tables state for a frame; `None` of other methods, and of a grid that was chosen.
    pub table_error: Option<f64>,
}

impl Sequence {
    /// Prepares the frames of valid scenes that differ in the sun, the observer and the camera alone: solves the tables for the
    /// lowest sun, looks at each frame in a small picture, solves again for the frame for which the tables state most if that is
    /// more than [`Scene::table_error`], and gives each frame its exposure: its own where the scene has one, else the automatic
    /// ones of the small pictures ([`tone::automatic_ev`]), made [`smooth`]. `None` if it was stopped. `seen` hears the share of frames
    /// that were looked at.
    ///
    /// # Errors
    /// As [`Sky::kept`] and [`Sky::turn`].
    pub fn prepare(
        mut frames: Vec<Scene>,
        data: &Data,
        kept: Option<&Path>,
        stop: &AtomicBool,
        seen: &(dyn Fn(f64) + Sync),
    ) -> Result<Option<Self>, RenderError> {
        let small: Vec<Scene> = frames.iter().map(preview).collect();
        let lowest = |a: &&Scene, b: &&Scene| a.sun_elevation_deg.total_cmp(&b.sun_elevation_deg);
        let Some(hardest) = small.iter().min_by(lowest) else { return Ok(None) };
        let mut sky = Sky::kept(hardest, data, kept)?;
        let mut solved = u32::from(sky.is_solved());
        let (mut automatic, mut worst): (Vec<f64>, Option<(f64, &Scene)>) = (Vec::new(), None);
        for (i, scene) in small.iter().enumerate() {
            if stop.load(Ordering::Relaxed) {
                return Ok(None);
            }
            sky.turn(scene)?;
            if let Some(error) = sky.table_error().filter(|error| worst.is_none_or(|(most, _)| *error > most)) {
                worst = Some((error, scene));
            }
            let rendering = render(scene, &sky, Control { stop, observe: &|_| {} })?;
            automatic.push(tone::automatic_ev(rendering.film.luminances()));
            seen((i + 1) as f64 / small.len() as f64);
        }
        let mut table_error = worst.map(|(error, _)| error);
        if let Some((_, scene)) = worst.filter(|(error, scene)| *error > scene.table_error) {
            // Only a finer grid than the one that is there can state less.
            let finer = Sky::kept(scene, data, kept)?;
            solved += 1;
            table_error = finer.table_error();
            sky = finer;
        }
        for (frame, ev) in frames.iter_mut().zip(smooth(&automatic)) {
            frame.exposure_ev.get_or_insert(ev);
            *frame = sky.decided(frame.clone());
        }
        Ok(Some(Self { frames, sky, solved, table_error }))
    }
}

/// The scene in a picture of at most [`PREVIEW`] pixels a side, one sample a pixel.
fn preview(scene: &Scene) -> Scene {
    let (width, height) = scene.size();
    let scale = f64::from(PREVIEW) / f64::from(width.max(height));
    let side = |pixels: u32| Some(((f64::from(pixels) * scale).round() as u32).clamp(1, pixels));
    Scene { width: side(width), height: side(height), spp: Some(1), block: None, error: None, ..scene.clone() }
}

#[cfg(test)]
mod tests;
