//! What is right: solved tables finer than any that the renderer takes.

use super::Size;
use crate::atmosphere::{Air, Haze};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::light::{SunDisc, solar_angular_radius};
use crate::render::{RenderError, Sky};
use crate::scene::Scene;
use crate::spectrum::{Colour, Wavelengths};
use crate::study::directions;
use crate::transport::{FINER, Method, Resolution, Solved};
use glam::DVec3;
use std::ops::Range;
use tables::units::{EARTH_RADIUS_M, KM};

/// Wavelengths of the reference: 4, 6, 11 and 16 even ones are among them.
pub(super) const WAVELENGTHS: usize = 31;

/// Lanes of a packet.
const LANES: usize = 16;

/// Directions that are looked in.
pub(super) const DIRECTIONS: u32 = 64;

const SHAPE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

/// Tables of an atmosphere, packet by packet.
pub(super) struct Reference {
    packets: Vec<(Range<usize>, [f64; LANES], Solved<LANES>)>,
    /// Coarser ones of the first packet, from which the error follows.
    coarser: Solved<LANES>,
    optical_depth: f64,
}

/// What is seen of one scene.
pub(super) struct Right {
    pub(super) directions: Vec<DVec3>,
    /// Of each direction the radiance factors in sr^-1 at all wavelengths, and XYZ.
    pub(super) radiances: Vec<Vec<f64>>,
    pub(super) colours: Vec<[f64; 3]>,
    /// XYZ of every pixel of the picture that shows something, with its direction.
    pub(super) pixels: Vec<(DVec3, [f64; 3])>,
    /// Relative rms error that the tables state.
    pub(super) error: f64,
}

impl Reference {
    /// Solves for the air and the ground of a scene.
    pub(super) fn new(data: &Data, size: Size, scene: &Scene) -> Result<Self, RenderError> {
        let resolutions = match size {
            Size::Full => [Resolution::FINEST, Resolution::FINE],
            Size::Quick => [Resolution::FINE, Resolution::RENDER],
        };
        let small = Scene { method: Method::Paths, width: Some(1), height: Some(1), ..scene.clone() };
        let sky = Sky::new(&small, data)?;
        let air: &Air = sky.air();
        let wavelengths = Wavelengths::visible(WAVELENGTHS).unwrap_or_default();
        let mut packets = Vec::new();
        for packet in wavelengths.packets() {
            let nm: [f64; LANES] = wavelengths.lanes(&packet);
            let ground = scene.albedo_at(data, &nm)?;
            let medium = air.medium(&nm)?;
            let solved = Solved::new(&medium, SHAPE, std::array::from_fn(|j| ground[j]), &resolutions[0])?;
            packets.push((packet.range, nm, solved));
        }
        // All wavelengths are on one grid: those of the first packet, the blue ones, are the hardest.
        let coarser = packets[0].2.again(&resolutions[1], None)?;
        Ok(Self { packets, coarser, optical_depth: air.haze().map_or(0.0, Haze::optical_depth) })
    }

    pub(super) fn optical_depth(&self) -> f64 {
        self.optical_depth
    }

    /// Radiance factors of some directions at all wavelengths, the sun a disc.
    fn radiances(&self, data: &Data, scene: &Scene, directions: &[DVec3]) -> Result<Vec<Vec<f64>>, RenderError> {
        let (place, sun) = (Place::above(scene.altitude_km * KM), scene.sun_direction());
        let mut factors = vec![vec![0.0; WAVELENGTHS]; directions.len()];
        for (range, nm, solved) in &self.packets {
            let suns = solved.suns(place, &SunDisc::new(&data.sun, nm, sun, solar_angular_radius())?);
            for (factors, direction) in factors.iter_mut().zip(directions) {
                for sun in &suns {
                    let seen = solved.radiance(place, *direction, *sun, false);
                    for (factor, seen) in factors[range.clone()].iter_mut().zip(seen) {
                        *factor += seen / suns.len() as f64;
                    }
                }
            }
        }
        Ok(factors)
    }

    /// What is seen of a scene with this air and ground.
    pub(super) fn seen(&self, data: &Data, scene: &Scene) -> Result<Right, RenderError> {
        let wavelengths = Wavelengths::visible(WAVELENGTHS).unwrap_or_default();
        let colour = Colour::new(&data.sun, &data.observer, &data.ozone_cross_section, &wavelengths)?;
        let directions = directions(scene, DIRECTIONS);
        let radiances = self.radiances(data, scene, &directions)?;
        let colours = radiances.iter().map(|factors| colour.xyz(factors)).collect();
        let (camera, (width, height)) = (scene.camera(), scene.size());
        let middles = (0..height).flat_map(|y| (0..width).map(move |x| (f64::from(x) + 0.5, f64::from(y) + 0.5)));
        let shown: Vec<DVec3> = middles.filter_map(|(x, y)| camera.direction(x, y)).collect();
        let pixels = self.radiances(data, scene, &shown)?;
        let pixels = shown.into_iter().zip(pixels.iter().map(|factors| colour.xyz(factors))).collect();
        let (place, sun) = (Place::above(scene.altitude_km * KM), scene.sun_direction());
        let error = FINER * self.packets[0].2.difference(&self.coarser, place, sun);
        Ok(Right { directions, radiances, colours, pixels, error })
    }
}
