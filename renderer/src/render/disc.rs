//! The sun's own image, without noise.

use super::Sky;
use crate::film::DiscLayer;
use crate::light::solar_angular_radius_at;
use crate::scene::Scene;
use rayon::prelude::*;

/// Points across the radius of the disc, and the fewest points across a pixel. Pixels that would so have more
/// than [`MANY`] make do with the coarse number, and with no more than [`MOST`].
const ACROSS_RADIUS: f64 = 32.0;
const COARSE: f64 = 8.0;
const LEAST: f64 = 4.0;
const MANY: f64 = 96.0;
const MOST: f64 = 4096.0;

/// What the solar disc adds to each pixel, in sr^-1 per unit solar irradiance: the mean over a
/// grid of points in the pixel of the disc's radiance times the transmittance of the air, the
/// points 1/32 of the disc's radius apart; 1/8 in pixels larger than the disc, and 4096 across and
/// down at most. Empty if the disc is not to be seen. Points outside the circle of a fisheye do not count.
#[must_use]
pub fn disc_layer(scene: &Scene, sky: &Sky) -> DiscLayer {
    if !scene.sun_disc {
        return DiscLayer::new();
    }
    let camera = scene.camera();
    let (width, height) = scene.size();
    let radius = solar_angular_radius_at(scene.sun_distance_au);
    let pixel = |x: u32, y: u32| -> Option<Vec<f64>> {
        let middle = camera.direction(f64::from(x) + 0.5, f64::from(y) + 0.5)?;
        let reach = camera.pixel_radius(x, y)?;
        if middle.angle_between(sky.sun_direction()) > radius + reach {
            return None;
        }
        // A pixel may be much wider than it is high.
        let (x, y) = (f64::from(x), f64::from(y));
        let points = |ends: [(f64, f64); 2]| {
            let halves = ends.map(|(x, y)| camera.direction(x, y).map_or(reach, |end| end.angle_between(middle)));
            let radii = (halves[0] + halves[1]) / radius;
            (radii * ACROSS_RADIUS).clamp(LEAST, MANY).max(radii * COARSE).min(MOST).ceil() as u32
        };
        let across = points([(x, y + 0.5), (x + 1.0, y + 0.5)]);
        let down = points([(x + 0.5, y), (x + 0.5, y + 1.0)]);
        let mut factors = vec![0.0; sky.wavelengths()];
        // Sunlight is natural.
        let weight = sky.passes();
        let (mut inside, mut lit) = (0.0, false);
        let at = |k: u32, points: u32| (f64::from(k) + 0.5) / f64::from(points);
        for j in 0..down {
            for i in 0..across {
                let Some(direction) = camera.direction(x + at(i, across), y + at(j, down)) else { continue };
                inside += 1.0;
                lit |= sky.add_disc(direction, weight, &mut factors);
            }
        }
        lit.then(|| factors.iter().map(|f| f / inside).collect())
    };
    (0..height)
        .into_par_iter()
        .flat_map_iter(|y| {
            let index = move |x: u32| y as usize * width as usize + x as usize;
            let pixel = &pixel;
            (0..width).filter_map(move |x| pixel(x, y).map(|factors| (index(x), factors)))
        })
        .collect()
}
