//! The sun's own image, without noise.

use super::Sky;
use crate::film::DiscLayer;
use crate::light::solar_angular_radius;
use crate::scene::Scene;
use rayon::prelude::*;

/// Points across the radius of the disc, and the fewest and most points across a pixel.
const ACROSS_RADIUS: f64 = 32.0;
const ACROSS_PIXEL: (f64, f64) = (4.0, 96.0);

/// What the solar disc adds to each pixel, in sr^-1 per unit solar irradiance: the mean over a
/// grid of points in the pixel of the disc's radiance times the transmittance of the air, the
/// points at most 1/32 of the disc's radius apart (96 across a pixel at most). Empty if the disc
/// is not to be seen. Points outside the circle of a fisheye do not count.
#[must_use]
pub fn disc_layer(scene: &Scene, sky: &Sky) -> DiscLayer {
    if !scene.sun_disc {
        return DiscLayer::new();
    }
    let camera = scene.camera();
    let (width, height) = scene.size();
    let radius = solar_angular_radius();
    let pixel = |x: u32, y: u32| -> Option<Vec<f64>> {
        let middle = camera.direction(f64::from(x) + 0.5, f64::from(y) + 0.5)?;
        let reach = camera.pixel_radius(x, y)?;
        if middle.angle_between(sky.sun_direction()) > radius + reach {
            return None;
        }
        let points = (2.0 * reach / radius * ACROSS_RADIUS).clamp(ACROSS_PIXEL.0, ACROSS_PIXEL.1).ceil() as u32;
        let mut factors = vec![0.0; sky.wavelengths()];
        let (mut inside, mut lit) = (0.0, false);
        for j in 0..points {
            for i in 0..points {
                let at = |origin: u32, k: u32| f64::from(origin) + (f64::from(k) + 0.5) / f64::from(points);
                let Some(direction) = camera.direction(at(x, i), at(y, j)) else { continue };
                inside += 1.0;
                lit |= sky.add_disc(direction, 1.0, &mut factors);
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
