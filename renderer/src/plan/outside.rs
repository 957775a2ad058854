//! In what a scene differs from all that was measured.

use super::Traits;
use crate::atmosphere::{Depolarisation, HazePhase};
use crate::scene::{Scene, SunShape};
use crate::spectrum::{Scheme, Wavelengths};
use tables::views::AerosolSource;

/// Elevations of the sun in degrees within which scenes are measured.
pub(super) const SUNS: (f64, f64) = (-8.0, 90.0);

/// The thickest aerosol, as optical depth at 550 nm.
pub(super) const THICKEST: f64 = 0.8;

/// Altitudes of observers in km: within the lower air, and above all of it.
pub(super) const AIR_KM: f64 = 15.0;
pub(super) const SPACE_KM: f64 = 120.0;

/// The lowest top of the atmosphere in km that is taken for the measured one, 120 km.
const LOWEST_TOP_KM: f64 = 100.0;

/// The first thing in which a scene lies outside what was measured, a phrase; none of a scene within.
#[must_use]
pub fn outside(scene: &Scene, traits: &Traits) -> Option<String> {
    let hazy = scene.biome.is_some();
    let altitude = traits.altitude_km;
    let refusals = [
        (!scene.tables.is_empty(), "own tables".to_owned()),
        (hazy && scene.phase == HazePhase::HenyeyGreenstein, "Henyey-Greenstein functions".into()),
        (hazy && scene.aerosol_source != AerosolSource::Opac, "this source of aerosol".into()),
        (scene.humidity_percent.is_some(), "another humidity than the type's own".into()),
        (scene.orders.is_some(), "some orders alone".into()),
        (scene.flat, "a planet that is a plane".into()),
        (scene.has_texture(), "a ground that is a map".into()),
        (scene.depolarisation != Depolarisation::default(), "air without depolarisation".into()),
        (scene.sun_shape != SunShape::Disc, "a sun of another form".into()),
        (scene.colour != Scheme::Spectral, "colours of a few wavelengths' own".into()),
        (scene.wavelengths_nm != Wavelengths::default(), "wavelengths of its own".into()),
        (scene.top_km < LOWEST_TOP_KM, format!("a top below {LOWEST_TOP_KM} km")),
        (traits.sun_elevation_deg < SUNS.0, format!("the sun below {} degrees", SUNS.0)),
        (traits.optical_depth > THICKEST, format!("an optical depth of aerosol above {THICKEST}")),
        (altitude > AIR_KM && altitude < SPACE_KM, format!("an observer between {AIR_KM} and {SPACE_KM} km")),
    ];
    refusals.into_iter().find(|(outside, _)| *outside).map(|(_, what)| what)
}
