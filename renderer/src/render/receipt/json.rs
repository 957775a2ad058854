//! The receipt as JSON.

use super::{Facts, program};
use crate::atmosphere::{AirError, Depths};
use crate::film::Estimate;
use crate::geometry::Place;
use crate::render::left_out::{LeftOut, Off};
use crate::render::{End, Part};
use crate::scene::Scene;
use crate::spectrum::{ColourTemperature, Locus};
use crate::transport::Method;
use crate::transport::rungs::{Rung, Stated};
use serde_json::{Map, Value, json};
use tables::units::KM;
use tables::views::REFERENCE_WAVELENGTH_NM;

/// The first key of every receipt; its value is the version of the layout.
const KEY: &str = "airlight_receipt";

/// What no method of this program follows.
const NEVER_THERE: [&str; 5] = ["refraction", "clouds", "terrain", "moon, stars and airglow", "inelastic scattering"];

/// Colours from fewer wavelengths than this are none.
const COLOURS: usize = 4;

/// Whether a file is a receipt: so that nothing else is ever overwritten by one.
#[must_use]
pub fn is_receipt(bytes: &[u8]) -> bool {
    serde_json::from_slice::<Value>(bytes).is_ok_and(|value| value.get(KEY).is_some())
}

/// See [`Facts::json`].
pub(super) fn receipt(facts: &Facts<'_>) -> Result<Map<String, Value>, AirError> {
    let Facts { scene, sky, .. } = *facts;
    let tables = sky.identities().iter().map(|table| {
        json!({
            "file": table.file,
            "kind": table.kind.to_string(),
            "title": table.title,
            "own": table.own,
            "crc32": format!("{:08x}", table.checksum),
        })
    });
    let parts = [
        (KEY, json!(1)),
        ("program", json!(program())),
        // A valid scene is JSON.
        ("scene", serde_json::from_str(&scene.to_portable_json()).unwrap_or_default()),
        ("tables", tables.collect()),
        ("sun", sun(facts)?),
        ("atmosphere", atmosphere(facts)?),
        ("ground", json!({ "name": scene.albedo.to_string(), "albedo": sky.albedo() })),
        ("light", light(facts)?),
        ("picture", picture(facts)),
        ("method", method(facts)),
        ("error", error(facts)),
        ("left_out", left_out(facts)),
    ];
    Ok(parts.into_iter().map(|(key, value)| (key.to_owned(), value)).collect())
}

/// Where the sun is, and through how much air it shines.
fn sun(Facts { scene, sky, .. }: &Facts<'_>) -> Result<Value, AirError> {
    let place = Place::above(scene.altitude_km * KM);
    let air_mass = sky.air().air_mass(scene.flat, place, sky.sun_direction())?;
    let mut sun = json!({
        "elevation_deg": scene.sun_elevation_deg,
        "azimuth_deg": scene.sun_azimuth_deg,
        "distance_au": scene.sun_distance_au,
        "air_mass": air_mass,
        "air_mass_is": "column of molecules from the observer towards the sun's centre over that to the zenith, rays straight",
    });
    if air_mass.is_none() {
        let why = if scene.in_space() { "no air above the observer" } else { "the ground is before the sun's centre" };
        sun["air_mass_unknown"] = json!(why);
    }
    sun["air_mass_kasten_young_1989"] = json!(kasten_young(scene));
    Ok(sun)
}

/// The air mass of Kasten & Young 1989, "Revised optical air mass tables and approximation formula", Applied Optics 28(22), equation 3, from sea level, with
/// refraction, 0 to 90 degrees: 1 / (sin h + 0.50572 (h + 6.07995)^-1.6364), h in degrees. `None` for the sun below the horizon or an observer above 100 m.
fn kasten_young(scene: &Scene) -> Option<f64> {
    const HIGHEST_KM: f64 = 0.1;
    let h = scene.sun_elevation_deg;
    let holds = h >= 0.0 && scene.altitude_km <= HIGHEST_KM && !scene.flat;
    holds.then(|| 1.0 / (h.to_radians().sin() + 0.50572 * (h + 6.07995).powf(-1.6364)))
}

/// Ozone, aerosol and vertical optical depths from the ground to the top.
fn atmosphere(Facts { scene, sky, .. }: &Facts<'_>) -> Result<Value, AirError> {
    let air = sky.air();
    let wavelengths = scene.wavelengths();
    let depths = wavelengths.nm().iter().map(|nm| air.depths(*nm)).collect::<Result<Vec<Depths>, AirError>>()?;
    let all = |of: fn(&Depths) -> f64| depths.iter().map(of).collect::<Vec<f64>>();
    let at = air.depths(REFERENCE_WAVELENGTH_NM)?;
    let aerosol = air.haze().map(|haze| {
        let humidities = haze.humidities_percent().into_iter().map(|(name, percent)| (name.to_owned(), json!(percent)));
        json!({
            "name": haze.origin().to_string(),
            "optical_depth_550nm": haze.optical_depth(),
            "times_its_own_amount": haze.factor(),
            "visibility_km": haze.visibility_km(),
            "relative_humidity_percent": humidities.collect::<Map<String, Value>>(),
        })
    });
    Ok(json!({
        "top_km": scene.top_km,
        "ozone_du": air.ozone_du(),
        "optical_depth_550nm": { "molecules": at.molecules, "ozone": at.ozone, "aerosol": at.aerosol },
        "optical_depth": {
            "wavelength_nm": wavelengths.nm(),
            "molecules": all(|depths| depths.molecules),
            "ozone": all(|depths| depths.ozone),
            "aerosol": all(|depths| depths.aerosol),
        },
        "aerosol": aerosol,
    }))
}

/// Illuminances, the zenith, and what colours these have.
fn light(Facts { scene, sky, summary, .. }: &Facts<'_>) -> Result<Value, AirError> {
    let locus = Locus::new(sky.observer())?;
    let both: [f64; 3] = std::array::from_fn(|i| summary.sun_xyz[i] + summary.sky_xyz[i]);
    let colour = |xyz: [f64; 3]| {
        let [x, y] = [0, 1].map(|i| xyz[i] / xyz.iter().sum::<f64>());
        match colourless(scene).map_or_else(|| locus.nearest(xyz), Err) {
            Ok(ColourTemperature { kelvin, duv }) => json!({ "x": x, "y": y, "cct_k": kelvin, "duv": duv }),
            // What is black has no chromaticity: 0 / 0 is null.
            Err(why) if colourless(scene).is_none() => {
                json!({ "x": x, "y": y, "cct_k": null, "duv": null, "unknown": why })
            }
            Err(why) => json!({ "x": null, "y": null, "cct_k": null, "duv": null, "unknown": why }),
        }
    };
    let Estimate { mean: sky_lux, error: sky_error } = summary.sky_lux;
    let Estimate { mean: zenith, error: zenith_error } = summary.zenith_cd_m2;
    Ok(json!({
        "sun_horizontal_illuminance_lux": summary.sun_lux,
        "sky_horizontal_illuminance_lux": sky_lux,
        "sky_horizontal_illuminance_standard_error_lux": sky_error,
        "zenith_luminance_cd_m2": zenith,
        "zenith_luminance_standard_error_cd_m2": zenith_error,
        "colour_is": "CIE 1931 x and y; cct_k: nearest black body in CIE 1960 (u, v), 1000 to 100000 K, within a Duv of 0.05 (CIE 15:2018, 9.5)",
        "colour_of_sun": colour(summary.sun_xyz),
        "colour_of_sky": colour(summary.sky_xyz),
        "colour_of_sun_and_sky": colour(both),
        "colour_of_zenith": colour(summary.zenith_xyz),
    }))
}

/// Why light of this scene has no colour, if it has none.
fn colourless(scene: &Scene) -> Option<String> {
    match scene.method {
        Method::Perez | Method::Cie => Some("this method has luminance alone".into()),
        method if method.is_dome() => None,
        _ if scene.wavelengths().nm().len() < 3 => Some(format!("fewer than {COLOURS} wavelengths")),
        _ if scene.colour == crate::spectrum::Scheme::Spectral && scene.wavelengths().nm().len() < COLOURS => {
            Some(format!("fewer than {COLOURS} wavelengths"))
        }
        _ => None,
    }
}

/// Size, samples and exposure.
fn picture(Facts { scene, sky, parts, rendering, exposure_ev, .. }: &Facts<'_>) -> Value {
    let (width, height) = scene.size();
    let block = u64::from(scene.block());
    json!({
        "width_px": width,
        "height_px": height,
        "wavelengths": sky.wavelengths(),
        "samples_per_pixel_least": block * u64::from(rendering.film.least_blocks()),
        "samples_per_pixel_most": block * u64::from(rendering.film.most_blocks()),
        "samples_per_block": block,
        "parts": parts.iter().map(Part::to_string).collect::<Vec<_>>(),
        "stopped_early": rendering.end == End::Stopped,
        "exposure_ev": exposure_ev,
    })
}

/// How radiance was found.
fn method(Facts { scene, sky, .. }: &Facts<'_>) -> Value {
    let rung = Rung::of(scene.method);
    json!({
        "name": rung.name,
        "source": rung.source,
        "without_noise": sky.is_noiseless(),
        "polarisation_followed": sky.is_polarised(),
    })
}

/// How well the picture is known; shares of the mean radiance, or of each luminance or radiance.
fn error(Facts { sky, rendering, verdict, achieved, .. }: &Facts<'_>) -> Value {
    let errors = rendering.errors;
    // Numbers that are infinite are null in JSON: not known from so few samples.
    let mut error = json!({
        "noise_rms_over_mean": errors.relative,
        "noise_median_of_luminance": errors.median_luminance,
        "noise_median_of_radiance": errors.median_spectral,
        "table_rms": sky.table_error(),
    });
    if !errors.relative.is_finite() {
        let why = if sky.is_noiseless() {
            "none: one look at each pixel, without noise"
        } else {
            "fewer than two blocks of samples"
        };
        error["noise_unknown"] = json!(why);
    }
    if let Some(Stated { further, points }) = sky.stated() {
        error["method_rms_over_mean"] = json!(further);
        error["method_points_rms"] = json!(points);
    }
    if let Some(verdict) = verdict {
        let of = |(name, residual): (&str, &crate::render::Residual)| json!({ "of": name, "rms": residual.rms, "rms_at_most_with_95_percent": residual.most });
        error["certified"] = ["I", "Q", "U"].into_iter().zip(&verdict.errors).map(of).collect();
        error["certified_asked"] = json!(verdict.asked);
    }
    if let Some(achieved) = achieved {
        let [least, most] = achieved.between;
        error["achieved"] = json!({
            "metric": achieved.metric.name(),
            "asked": achieved.asked,
            "rms": achieved.found,
            "rms_at_least_with_95_percent": least,
            "rms_at_most_with_95_percent": most,
        });
    }
    error
}

/// What the picture does without.
fn left_out(Facts { scene, sky, .. }: &Facts<'_>) -> Value {
    let mut left_out = json!({
        "by_the_program": NEVER_THERE,
        "by_the_method": Rung::of(scene.method).leaves_out,
    });
    if sky.is_polarised() {
        left_out["polarisation"] = json!(null);
        return left_out;
    }
    let off = |Off { rms, worst, error }: Off| json!({ "rms": rms, "worst": worst, "worst_standard_error": error });
    left_out["polarisation"] = match LeftOut::of(scene, sky.air(), sky.albedo()) {
        Ok(cost) => json!({
            "luminance_off": cost.luminance.map(off),
            "radiance_off": off(cost.radiance),
            "radiance_wavelength_nm": cost.nm,
        }),
        Err(outside) => json!({ "unknown": format!("not measured for {outside}") }),
    };
    left_out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_receipt_is_told_from_other_json() {
        assert!(is_receipt(br#"{"airlight_receipt": 1}"#));
        let others: [&[u8]; 3] = [br#"{"month": 3}"#, br#"{"airlight_receipt": "#, b""];
        assert!(others.iter().all(|bytes| !is_receipt(bytes)));
    }

    #[test]
    fn kasten_and_young_hold_by_day_at_sea_level() {
        let at = |sun_elevation_deg, altitude_km| {
            kasten_young(&Scene { sun_elevation_deg, altitude_km, ..Scene::default() })
        };
        // Their table has 37.92 at the horizon and 1 overhead (0.9997 by the equation).
        assert!((at(0.0, 0.0).expect("day") - 37.92).abs() < 0.01);
        assert!((at(90.0, 0.0).expect("day") - 1.0).abs() < 4e-4);
        assert_eq!([at(-0.1, 0.0), at(30.0, 2.0)], [None, None]);
    }
}
