//! What a picture says about how it was made.

mod json;

pub use json::is_receipt;

use super::left_out::LeftOut;
use super::{Achieved, End, Part, Rendering, Sky, Summary, Verdict};
use crate::atmosphere::AirError;
use crate::film::exr::Attribute;
use crate::scene::Scene;
use serde_json::{Map, Value};

/// What there is to say of a picture.
#[derive(Debug, Clone, Copy)]
pub struct Facts<'a> {
    /// What it is of.
    pub scene: &'a Scene,
    /// What it was made from.
    pub sky: &'a Sky,
    /// The seeds and shards whose samples it has.
    pub parts: &'a [Part],
    /// Its samples.
    pub rendering: &'a Rendering,
    /// Light at the observer's place.
    pub summary: &'a Summary,
    /// Exposure of the PNG, EV at ISO 100.
    pub exposure_ev: f64,
    /// What a certificate says of the tables.
    pub verdict: Option<&'a Verdict>,
    /// What a planned picture has achieved.
    pub achieved: Option<&'a Achieved>,
}

impl<'a> Facts<'a> {
    /// Of a picture without certificate and plan.
    #[must_use]
    pub fn new(
        (scene, sky): (&'a Scene, &'a Sky),
        (parts, rendering): (&'a [Part], &'a Rendering),
        summary: &'a Summary,
        exposure_ev: f64,
    ) -> Self {
        Self { scene, sky, parts, rendering, summary, exposure_ev, verdict: None, achieved: None }
    }

    /// The receipt as JSON: what went in with checksums, optical depths, ozone, air mass, light with its colour temperatures, method, errors, and what was
    /// left out. Every key has the unit of its number, but for pure numbers, and what is not known is null, with the reason beside it. Equal scenes give equal receipts.
    ///
    /// # Errors
    /// [`AirError`] if a table does not reach a wavelength of the scene, which then has no sky either.
    pub fn json(&self) -> Result<Map<String, Value>, AirError> {
        json::receipt(self)
    }

    /// The attributes of the picture's EXR file, names beginning with `airlight.`: program and version, the scene as JSON
    /// (`airlight render` reads it), the seeds and shards whose samples it has, one a line, samples, errors, ozone, illuminances, exposure of the PNG, and
    /// each table with its checksum; with a certificate, the rms error of solved tables and what it is below with 95 % confidence, of Q and U too if the
    /// picture has them; of a planned picture what was asked of which metric, the rms error in random pixels, and what it is above and below, each with
    /// 95 % confidence; without
    /// polarisation, how far that puts luminance and radiance off ([`LeftOut`]), or why it is not known; and the whole receipt ([`RECEIPT`]). No clock, machine or folder.
    ///
    /// # Errors
    /// As [`Facts::json`].
    pub fn attributes(&self) -> Result<Vec<(String, Attribute)>, AirError> {
        let text = Value::Object(self.json()?).to_string();
        let mut attributes = attributes(self);
        attributes.push((RECEIPT.into(), Attribute::Text(text)));
        Ok(attributes)
    }
}

/// The attribute that holds the receipt.
pub const RECEIPT: &str = "airlight.receipt";

/// The attribute that holds the scene.
pub const SCENE: &str = "airlight.scene";

/// The attribute that names the tables, one a line: file, checksum in hexadecimal, title.
pub const TABLES: &str = "airlight.tables";

/// Checksum of the table called `file` in the attribute [`TABLES`]. The file's name may hold blanks.
#[must_use]
pub fn checksum_of(tables: &str, file: &str) -> Option<u32> {
    let rests = tables.lines().filter_map(|line| line.strip_prefix(file)?.strip_prefix(' '));
    rests.filter_map(|rest| u32::from_str_radix(rest.get(..8)?, 16).ok()).next()
}

/// The program and its version.
#[must_use]
pub fn program() -> String {
    format!("airlight {}", env!("CARGO_PKG_VERSION"))
}

/// The tables of a sky, as the attribute [`TABLES`] names them.
#[must_use]
pub fn tables(sky: &Sky) -> String {
    let lines: Vec<String> =
        sky.identities().iter().map(|t| format!("{} {:08x} {}", t.file, t.checksum, t.title)).collect();
    lines.join("\n")
}

/// Everything but the receipt.
fn attributes(facts: &Facts<'_>) -> Vec<(String, Attribute)> {
    let Facts { scene, sky, parts, rendering, summary, exposure_ev, verdict, achieved } = *facts;
    let film = &rendering.film;
    let text = |value: String| Attribute::Text(value);
    let block = scene.block();
    let samples = |n: u32| Attribute::Integer(i32::try_from(n.saturating_mul(block)).unwrap_or(i32::MAX));
    let parts: Vec<String> = parts.iter().map(Part::to_string).collect();
    let haze = sky.air().haze();
    let mut attributes = vec![
        ("airlight.version", text(program())),
        (SCENE, text(scene.to_portable_json())),
        ("airlight.seed", text(scene.seed.to_string())),
        ("airlight.samples_per_pixel_least", samples(film.least_blocks())),
        ("airlight.samples_per_pixel_most", samples(film.most_blocks())),
        ("airlight.samples_per_block", samples(1)),
        ("airlight.parts", text(parts.join("\n"))),
        ("airlight.stopped_early", text(if rendering.end == End::Stopped { "yes" } else { "no" }.into())),
        ("airlight.error", Attribute::Number(rendering.errors.relative)),
        ("airlight.error_median_luminance", Attribute::Number(rendering.errors.median_luminance)),
        ("airlight.error_median_spectral", Attribute::Number(rendering.errors.median_spectral)),
        ("airlight.ozone_du", Attribute::Number(sky.air().ozone_du())),
        ("airlight.illuminance_sun_lux", Attribute::Number(summary.sun_lux)),
        ("airlight.illuminance_sky_lux", Attribute::Number(summary.sky_lux.mean)),
        ("airlight.illuminance_sky_lux_error", Attribute::Number(summary.sky_lux.error)),
        ("airlight.zenith_luminance_cd_m2", Attribute::Number(summary.zenith_cd_m2.mean)),
        ("airlight.zenith_luminance_cd_m2_error", Attribute::Number(summary.zenith_cd_m2.error)),
        ("airlight.exposure_ev", Attribute::Number(exposure_ev)),
        (TABLES, text(tables(sky))),
    ];
    if let Some(verdict) = verdict {
        let names = [
            ["airlight.certified_rms", "airlight.certified_rms_most"],
            ["airlight.certified_rms_q", "airlight.certified_rms_q_most"],
            ["airlight.certified_rms_u", "airlight.certified_rms_u_most"],
        ];
        for ([rms, most], error) in names.into_iter().zip(&verdict.errors) {
            attributes.push((rms, Attribute::Number(error.rms)));
            attributes.push((most, Attribute::Number(error.most)));
        }
    }
    if let Some(Achieved { metric, asked, found, between: [least, most], .. }) = achieved {
        attributes.push(("airlight.achieved_metric", text(metric.name().into())));
        let numbers = [
            ("airlight.achieved_asked", asked),
            ("airlight.achieved_rms", found),
            ("airlight.achieved_rms_least", least),
            ("airlight.achieved_rms_most", most),
        ];
        attributes.extend(numbers.map(|(name, value)| (name, Attribute::Number(*value))));
    }
    if !sky.is_polarised() {
        match LeftOut::of(scene, sky.air(), sky.albedo()) {
            Ok(LeftOut { luminance, radiance, nm }) => {
                if let Some(off) = luminance {
                    attributes.push(("airlight.unpolarised_luminance_rms", Attribute::Number(off.rms)));
                    attributes.push(("airlight.unpolarised_luminance_worst", Attribute::Number(off.worst)));
                }
                attributes.push(("airlight.unpolarised_radiance_rms", Attribute::Number(radiance.rms)));
                attributes.push(("airlight.unpolarised_radiance_worst", Attribute::Number(radiance.worst)));
                attributes.push(("airlight.unpolarised_radiance_nm", Attribute::Number(nm)));
            }
            Err(outside) => attributes.push(("airlight.unpolarised_unknown_for", text(outside))),
        }
    }
    if let Some(haze) = haze {
        attributes.push(("airlight.aerosol_optical_depth_550nm", Attribute::Number(haze.optical_depth())));
        attributes.push(("airlight.visibility_km", Attribute::Number(haze.visibility_km())));
    }
    attributes.into_iter().map(|(name, value)| (name.into(), value)).collect()
}
