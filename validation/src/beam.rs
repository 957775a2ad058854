//! Direct sunlight beside ASTM G173: the sun at a zenith angle of 48.19 degrees (air mass 1.5) over the US standard atmosphere,
//! ozone 0.3438 cm, a rural aerosol of optical depth 0.084 at 500 nm, by SMARTS 2.9.2 (Gueymard 2001, Solar Energy 71, 325).
//!
//! Compared is the transmittance, direct over extraterrestrial, nanometre by nanometre. Airlight has neither water vapour nor
//! oxygen nor carbon dioxide: what they absorb is left out (`MASKED`). The aerosol is OPAC's average continental one,
//! whose optical depth is brought to 0.084 at 500 nm; the standard's is that of Shettle & Fenn. The standard's column contains the light of the sky
//! within 2.5 degrees of the sun, under one percent here, and nitrogen dioxide, which takes as much at 400 nm. SMARTS was found within
//! 2 % of measurements and of other programs where absorption is weak; that is taken for its uncertainty.

use crate::judge::{percent, spread, within};
use crate::references::{Sheet, path};
use crate::{Context, Section, ValidationError, Verdict};
use renderer::render::Sky;
use renderer::scene::Scene;
use renderer::spectrum::Wavelengths;
use renderer::study::{Chart, Point};
use renderer::transport::Method;
use tables::views::Biome;

/// Where gases that Airlight does not have absorb, in nm.
pub(crate) const MASKED: [(f64, f64); 5] =
    [(686.0, 697.0), (715.0, 740.0), (757.0, 770.0), (810.0, 840.0), (890.0, 1000.0)];

/// Bands of the table, in nm.
const BANDS: [(f64, f64); 7] =
    [(300.0, 320.0), (320.0, 360.0), (360.0, 400.0), (400.0, 500.0), (500.0, 600.0), (600.0, 700.0), (700.0, 1000.0)];

/// Wavelengths in nm between absorption bands, and in weak bands of the oxygen dimer (Greenblatt et al. 1990, J. Geophys. Res. 95, 18577) and of water vapour.
const WINDOWS: [f64; 13] = [320.0, 340.0, 400.0, 420.0, 450.0, 500.0, 550.0, 610.0, 670.0, 750.0, 780.0, 860.0, 880.0];
const DIMER: [f64; 2] = [577.0, 630.0];
const WATER: [f64; 4] = [590.0, 650.0, 700.0, 710.0];

/// The uncertainty of the reference.
const UNCERTAINTY: f64 = 0.02;

/// Zenith angle of the sun in degrees, ozone in Dobson units, optical depth of the aerosol at 500 nm.
const CONDITIONS: (f64, f64, f64) = (48.19, 343.8, 0.084);

fn scene(aod: Option<f64>, nm: &[f64]) -> Result<Scene, ValidationError> {
    Ok(Scene {
        sun_elevation_deg: 90.0 - CONDITIONS.0,
        ozone_du: Some(CONDITIONS.1),
        biome: aod.map(|_| Biome::Rural),
        aod,
        altitude_km: 0.0,
        wavelengths_nm: Wavelengths::new(nm.to_vec())?,
        method: Method::Single,
        follow_polarisation: Some(false),
        ..Scene::default()
    })
}

/// Transmittance to the sun.
fn transmittance(context: &Context<'_>, aod: Option<f64>, nm: &[f64]) -> Result<Vec<f64>, ValidationError> {
    let sky = Sky::new(&scene(aod, nm)?, context.data)?;
    Ok(sky.direct_irradiance_of(sky.sun_direction()))
}

/// Computes the section.
///
/// # Errors
/// [`ValidationError`] if the reference or a table cannot be read.
pub fn make(context: &Context<'_>) -> Result<Section, ValidationError> {
    let sheet = Sheet::read(&path(context.root, "direct-beam.csv"))?;
    let nm = sheet.column("wavelength_nm")?;
    // The ratio of optical depths at 500 and 550 nm, which the amount does not change, by Beer's law along the same path.
    let pair = [500.0, 550.0];
    let [clear, hazy] = [transmittance(context, None, &pair)?, transmittance(context, Some(0.1), &pair)?];
    let slant = |i: usize| (clear[i] / hazy[i]).ln();
    let aod = CONDITIONS.2 * slant(1) / slant(0);
    let found = transmittance(context, Some(aod), &nm)?;
    let (direct, above) = (sheet.column("direct_w_m2_nm")?, sheet.column("extraterrestrial_w_m2_nm")?);
    let mut section = Section::default();
    section.say(&format!(
        "Compared: the transmittance of the direct beam with the sun at a zenith angle of {} degrees, ozone {} DU and an aerosol of optical depth {} \
         at 500 nm (here OPAC's average continental one, {aod:.4} at 550 nm). Reference: ASTM G173-03, direct over extraterrestrial, uncertain by \
         about {:.0} % where absorption is weak (Gueymard 2001). Left out, since Airlight has no water vapour, oxygen and carbon dioxide: {}. The reference \
         contains the light of the sky within 2.5 degrees of the sun and nitrogen dioxide; its aerosol is that of Shettle & Fenn.",
        CONDITIONS.0,
        CONDITIONS.1,
        CONDITIONS.2,
        100.0 * UNCERTAINTY,
        MASKED.map(|(low, high)| format!("{low} to {high} nm")).join(", ")
    ));
    let mut points = Vec::new();
    let mut errors: Vec<(f64, f64)> = Vec::new();
    for (i, &nm) in nm.iter().enumerate() {
        let reference = direct[i] / above[i];
        let masked = MASKED.iter().any(|&(low, high)| (low..=high).contains(&nm));
        if nm >= 320.0 && nm % 5.0 == 0.0 {
            let point = |curve: &str, value| Point { panel: "transmittance", curve: curve.into(), at: [nm, value] };
            points.push(point("Airlight", found[i]));
            points.push(point("ASTM G173", reference));
        }
        if !masked {
            errors.push((nm, found[i] / reference - 1.0));
        }
    }
    let mut rows = Vec::new();
    let mut failing = Vec::new();
    for (low, high) in BANDS {
        let of: Vec<f64> = errors.iter().filter(|e| (low..high).contains(&e.0)).map(|e| e.1).collect();
        let (count, bias, rms, worst) = spread(of);
        rows.push(vec![
            format!("{low} to {high}"),
            count.to_string(),
            percent(bias, 2),
            format!("{:.2}", 100.0 * rms),
            percent(worst, 1),
            format!("{:.2}", rms / UNCERTAINTY),
        ]);
        if !within(rms, UNCERTAINTY) {
            failing.push(format!("{low} to {high} nm: rms {:.1} %, worst {} %", 100.0 * rms, percent(worst, 1)));
        }
    }
    section.table(&["band / nm", "wavelengths", "bias %", "rms %", "worst %", "rms z"], &rows);
    crate::mie::fails(&mut section, &failing);
    let at = |wanted: f64| nm.iter().position(|&nm| nm == wanted);
    let row = |&wanted: &f64| {
        let i = at(wanted)?;
        let reference = direct[i] / above[i];
        Some((wanted, found[i], reference, found[i] / reference - 1.0))
    };
    section.say(
        "In the windows between bands the two agree; in weak bands of oxygen, its dimer and water vapour, which the list above does not leave out, the reference is \
         darker:",
    );
    let mut rows = Vec::new();
    for (kind, list) in [("window", &WINDOWS[..]), ("oxygen and its dimer", &DIMER[..]), ("water vapour", &WATER[..])] {
        for (nm, found, reference, error) in list.iter().filter_map(row) {
            rows.push(vec![
                format!("{nm}"),
                kind.into(),
                format!("{found:.4}"),
                format!("{reference:.4}"),
                percent(error, 2),
            ]);
        }
    }
    section.table(&["wavelength / nm", "", "transmittance", "reference", "difference %"], &rows);
    let (count, bias, rms, worst) = spread(WINDOWS.iter().filter_map(row).map(|row| row.3));
    section.find(
        "direct sunlight in windows, 320 to 880 nm",
        format!(
            "{count} wavelengths: bias {} %, rms {:.2} %, worst {} %",
            percent(bias, 2),
            100.0 * rms,
            percent(worst, 2)
        ),
        "ASTM G173-03",
        Verdict::of(within(worst, UNCERTAINTY)),
    );
    for (nm, error) in &errors {
        if nm.fract() == 0.0 && *nm >= 320.0 {
            points.push(Point { panel: "difference / %", curve: "Airlight".into(), at: [*nm, 100.0 * error] });
        }
    }
    let visible = |e: &&(f64, f64)| (400.0..686.0).contains(&e.0);
    let (count, bias, rms, _) = spread(errors.iter().filter(visible).map(|e| e.1));
    section.find(
        "direct sunlight, 300 to 890 nm",
        format!(
            "400 to 686 nm, {count} wavelengths: bias {} %, rms {:.2} %; {} of {} bands beyond {:.0} %",
            percent(bias, 2),
            100.0 * rms,
            failing.len(),
            BANDS.len(),
            100.0 * UNCERTAINTY
        ),
        "ASTM G173-03",
        Verdict::of(failing.is_empty()),
    );
    let title = "Direct sunlight at air mass 1.5 beside ASTM G173".into();
    section.chart("beam", Chart { title, axes: ["wavelength / nm", "transmittance or difference"], points });
    Ok(section)
}
