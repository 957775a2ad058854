//! Fitted skies of a scene.

use super::RenderError;
use crate::atmosphere::Air;
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::scene::Scene;
use crate::spectrum::{Colour, Wavelengths};
use crate::transport::Method;
use crate::transport::rungs::cie::{CLEAR, Cie};
use crate::transport::rungs::hosek_wilkie::HosekWilkie;
use crate::transport::rungs::perez::{Light, Perez};
use crate::transport::rungs::preetham::Preetham;
use crate::transport::rungs::{Cheap, Dome, Refusal};
use glam::DVec3;
use std::f64::consts::{PI, TAU};
use tables::TableError;
use tables::units::{EARTH_RADIUS_M, KM};

/// Wavelengths in nm at which red, green and blue of the model of Hosek & Wilkie see the ground.
const RGB_NM: [f64; 3] = [610.0, 550.0, 465.0];

/// Ends and number of the wavelengths of irradiances.
const BAND_NM: (f64, f64) = (300.0, 1000.0);
const BAND: usize = 16;

/// The fitted sky of a valid scene whose turbidity is that.
///
/// # Errors
/// [`RenderError`] outside the range of the model, or where tables do not reach.
pub(super) fn dome(scene: &Scene, data: &Data, air: &Air, turbidity: f64) -> Result<Box<dyn Dome>, RenderError> {
    let sun = scene.sun_direction();
    Ok(match scene.method {
        Method::Preetham => Box::new(Preetham::new(turbidity, sun)),
        Method::HosekWilkie => {
            let albedo = scene.albedo_at(data, &RGB_NM)?;
            Box::new(HosekWilkie::new(turbidity, [albedo[0], albedo[1], albedo[2]], sun)?)
        }
        Method::Cie => {
            let near =
                Near::new(scene, data, air, Wavelengths::visible(BAND).map_err(crate::scene::SceneError::from)?.nm())?;
            let zenith = near.colour.xyz(&near.radiance(DVec3::Z))[1];
            let kind = scene.sky_type.unwrap_or(CLEAR);
            Box::new(Cie::new(kind, sun, zenith).ok_or_else(|| Refusal(format!("sky type {kind}; 1 to 15 are known")))?)
        }
        Method::Perez => Box::new(Perez::new(&light(scene, data, air)?, sun)),
        other => return Err(Refusal(format!("{other:?} is no fitted sky")).into()),
    })
}

/// What a fitted sky is scaled by: the isotropic closure of the scene's air at [`BAND`] wavelengths.
struct Near {
    cheap: Cheap<BAND>,
    place: Place,
    sun: DVec3,
    colour: Colour,
    /// Transmittance to the sun.
    direct: [f64; BAND],
}

impl Near {
    fn new(scene: &Scene, data: &Data, air: &Air, nm: &[f64]) -> Result<Self, RenderError> {
        let lanes: [f64; BAND] = std::array::from_fn(|i| nm[i]);
        let shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };
        let (medium, ground) = (air.medium(&lanes)?, scene.albedo_at(data, nm)?);
        let albedo = std::array::from_fn(|i| ground[i]);
        let (place, sun) = (Place::above(scene.altitude_km * KM), scene.sun_direction());
        let direct = medium.transmittance(shape, place, sun);
        let cheap = Cheap::new(Method::Isotropic, &medium, shape, albedo, None);
        let cheap = cheap.ok_or_else(|| Refusal("there is no isotropic closure".into()))?;
        let wavelengths = Wavelengths::new(nm.to_vec()).map_err(crate::scene::SceneError::from)?;
        let colour = Colour::new(&data.sun, &data.observer, &data.ozone_cross_section, &wavelengths)?;
        Ok(Self { cheap, place, sun, colour, direct })
    }

    fn radiance(&self, direction: DVec3) -> [f64; BAND] {
        self.cheap.radiance(self.place, direction, self.sun)
    }
}

/// Irradiances and illuminance of the scene, by the isotropic closure.
fn light(scene: &Scene, data: &Data, air: &Air) -> Result<Light, RenderError> {
    let step = (BAND_NM.1 - BAND_NM.0) / (BAND - 1) as f64;
    let nm: Vec<f64> = (0..BAND).map(|i| BAND_NM.0 + step * i as f64).collect();
    let near = Near::new(scene, data, air, &nm)?;
    // Even in cos^2 of the zenith angle and in azimuth: the midpoint rule.
    const RINGS: u32 = 16;
    const SECTORS: u32 = 32;
    let mut diffuse = [0.0; BAND];
    for i in 0..RINGS {
        let cosine = ((f64::from(i) + 0.5) / f64::from(RINGS)).sqrt();
        let sine = (1.0 - cosine * cosine).sqrt();
        for k in 0..SECTORS {
            let (sin, cos) = (TAU * (f64::from(k) + 0.5) / f64::from(SECTORS)).sin_cos();
            let seen = near.radiance(DVec3::new(sine * cos, sine * sin, cosine));
            for j in 0..BAND {
                diffuse[j] += PI * seen[j] / f64::from(RINGS * SECTORS);
            }
        }
    }
    // int f E d lambda over the band, f linear between its wavelengths, and E alone, at every nanometre.
    let (mut diffuse_w_m2, mut direct_w_m2, mut band_w_m2) = (0.0, 0.0, 0.0);
    for i in 0..(BAND_NM.1 - BAND_NM.0) as u32 {
        let at = f64::from(i) + 0.5;
        let (node, share) = ((at / step) as usize, (at / step).fract());
        let between = |of: &[f64; BAND]| of[node] + share * (of[(node + 1).min(BAND - 1)] - of[node]);
        let sun = data.sun.irradiance_w_m2_nm.at(BAND_NM.0 + at)?;
        diffuse_w_m2 += sun * between(&diffuse);
        direct_w_m2 += sun * between(&near.direct);
        band_w_m2 += sun;
    }
    let beyond = (total_irradiance(data)? - band_w_m2).max(0.0);
    Ok(Light { diffuse_w_m2, direct_w_m2: direct_w_m2 + beyond, diffuse_lux: near.colour.xyz(&diffuse)[1] })
}

/// The sun's irradiance in W/m^2 from 300 nm to the end of its table.
fn total_irradiance(data: &Data) -> Result<f64, TableError> {
    let curve = &data.sun.irradiance_w_m2_nm;
    let nodes = &curve.axis().nodes;
    let mut sum = 0.0;
    for ends in nodes.windows(2).filter(|ends| ends[0] >= BAND_NM.0) {
        sum += 0.5 * (ends[1] - ends[0]) * (curve.at(ends[0])? + curve.at(ends[1])?);
    }
    Ok(sum)
}
