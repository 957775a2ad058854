//! O'Neil 2005, "Accurate atmospheric scattering", GPU Gems 2, chapter 16: single scattering on a planet whose air is one exponential.
//!
//! His planet has air as thick as 0.025 of its radius, with a scale height of a quarter of that: on Earth 159 km and 40 km. For these
//! proportions the optical depth from density rho to space along the cosine c is rho scale(c),
//!
//! scale(c) = 0.25 exp(-0.00287 + x (0.459 + x (3.83 + x (-6.80 + x 5.25)))),  x = 1 - c,
//!
//! in units of the vertical thickness (his listing 16-1), so that nothing is tabulated. Depth and phase functions are here
//! Airlight's: every scatterer's vertical optical depth, spread over his profile; what only absorbs (ozone) is left out. He takes molecules
//! and one Henyey-Greenstein aerosol at three wavelengths, which is what `--colour rgb --phase hg` makes of it.
//! Sun above the horizon, observer on the ground, and black below the horizon.

use crate::atmosphere::Medium;
use crate::geometry::{Place, Shape};
use glam::DVec3;

/// Points along the line of sight (his figure 16-3).
pub const STEPS: u32 = 5;

/// Radius of the planet in thicknesses of its air, and the scale height in them.
const RADIUS: f64 = 40.0;
const SCALE_HEIGHT: f64 = 0.25;

/// Scatterers on his planet.
#[derive(Debug)]
pub struct Oneil<const L: usize> {
    /// Scattering of each species at the ground, per thickness, and which component it is.
    species: Vec<(crate::phase::Phase<L>, [f64; L])>,
    /// Extinction by all of them.
    extinction: [f64; L],
    steps: u32,
}

/// His fit.
fn scale(cosine: f64) -> f64 {
    let x = 1.0 - cosine;
    SCALE_HEIGHT * (-0.002_87 + x * (0.459 + x * (3.83 + x * (-6.80 + x * 5.25)))).exp()
}

impl<const L: usize> Oneil<L> {
    pub(super) fn new(medium: &Medium<L>, steps: u32) -> Self {
        let columns = medium.columns(Shape::Flat, Place::above(0.0), DVec3::Z).unwrap_or_default();
        let mut extinction = [0.0; L];
        let mut species = Vec::new();
        for (component, column) in medium.components().iter().zip(columns) {
            if component.scatters() {
                let at_ground = column / SCALE_HEIGHT;
                for j in 0..L {
                    extinction[j] += at_ground * (component.scattering[j] + component.absorption[j]);
                }
                species.push((component.phase.clone(), component.scattering.map(|sigma| at_ground * sigma)));
            }
        }
        Self { species, extinction, steps }
    }

    /// Radiance per unit solar irradiance in sr^-1; the observer's altitude counts for nothing.
    pub(super) fn radiance(&self, from: Place, direction: DVec3, sun: DVec3) -> [f64; L] {
        let cosine = from.up.dot(direction);
        if cosine <= 0.0 {
            return [0.0; L];
        }
        // In thicknesses; the ray leaves the air at the distance `far`.
        let top = RADIUS + 1.0;
        let far = ((RADIUS * cosine).powi(2) + (top - RADIUS) * (top + RADIUS)).sqrt() - RADIUS * cosine;
        let length = far / f64::from(self.steps);
        let mut sum = [0.0; L];
        for i in 0..self.steps {
            let point = from.up * RADIUS + direction * (length * (f64::from(i) + 0.5));
            let radius = point.length();
            let density = (-(radius - RADIUS) / SCALE_HEIGHT).exp();
            let (to_sun, ahead) = (point.dot(sun) / radius, point.dot(direction) / radius);
            let depth = scale(cosine) + density * (scale(to_sun) - scale(ahead));
            for j in 0..L {
                sum[j] += length * density * (-depth * self.extinction[j]).exp();
            }
        }
        let towards = direction.dot(sun);
        let mut radiance = [0.0; L];
        for (phase, scattering) in &self.species {
            let phase = phase.values(towards);
            for j in 0..L {
                radiance[j] += phase[j] * scattering[j] * sum[j];
            }
        }
        radiance
    }
}
