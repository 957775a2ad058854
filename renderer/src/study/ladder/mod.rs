//! The ladder: the error and the cost of every method, over scenes from a high sun to twilight, from clear air to haze, from the ground to
//! space.
//!
//! What is right comes from solved tables finer than any that the renderer takes, at 31 wavelengths; how far they are off
//! themselves stands in every row. Errors are those of 64 directions (radiance at the wavelengths that both have, luminance) and of a picture
//! of 64 x 64 pixels (CIEDE2000 as its PNG would show it, exposed for the reference). Costs are core-seconds on one thread: of what is made once for
//! the atmosphere, and of a picture.

mod measure;
mod reference;
mod scenes;

pub use scenes::{Regime, Size};

use crate::data::Data;
use crate::render::RenderError;
use scenes::{Setting, atmospheres, settings};
use std::fmt::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// A method with a setting, on one scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Which part of the world the scene is of.
    pub regime: Regime,
    /// Biome or `none`, and the vertical optical depth of its aerosol at 550 nm.
    pub aerosol: (String, f64),
    /// Elevation of the sun in degrees.
    pub sun_elevation_deg: f64,
    /// Altitude of the observer in km.
    pub altitude_km: f64,
    /// Albedo of the ground.
    pub albedo: f64,
    /// Month.
    pub month: u8,
    /// The method.
    pub method: &'static str,
    /// How it is set.
    pub setting: &'static str,
    /// What came out; nothing if the method does not cover the scene.
    pub found: Option<Found>,
    /// Relative rms error of the reference's radiances, stated by a coarser one.
    pub reference_error: f64,
}

/// Errors and costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Root mean square over directions and wavelengths of the difference over the mean of the wavelength, and the largest relative difference of a
    /// direction (mean over its wavelengths); none of methods without the wavelengths of the reference.
    pub radiance: Option<[f64; 2]>,
    /// Root mean square over directions of the difference in luminance over its mean.
    pub luminance_rms: f64,
    /// Mean CIEDE2000 over the pixels of the picture that show something.
    pub ciede2000: f64,
    /// Exposure of that, EV at ISO 100.
    pub exposure_ev: f64,
    /// Core-seconds for what is made once for the atmosphere and the method.
    pub tables_s: f64,
    /// Core-seconds for a picture of 64 x 64 pixels.
    pub picture_s: f64,
    /// Bytes of the tables.
    pub bytes: usize,
}

/// All rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Ladder {
    /// Atmosphere by atmosphere, setting by setting, scene by scene.
    pub rows: Vec<Row>,
}

/// The header of the CSV.
const HEADER: &str = "regime,aerosol,optical_depth_550nm,sun_elevation_deg,altitude_km,albedo,month,method,setting,radiance_rms,\
                      radiance_worst,luminance_rms,ciede2000,exposure_ev,tables_core_s,picture_core_s,table_bytes,reference_rms";

impl Ladder {
    /// As CSV: a title behind `# `, a header, a row for each; empty fields for what a method does not have.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut csv = format!(
            "# The ladder of methods: errors in 64 directions and a picture of 64 x 64 pixels, core-seconds on one thread\n{HEADER}\n"
        );
        for row in &self.rows {
            let (name, depth) = &row.aerosol;
            // Writing to a string does not fail.
            let _ = write!(
                csv,
                "{},{name},{depth:.4},{},{},{},{},{},\"{}\",",
                row.regime.name(),
                row.sun_elevation_deg,
                row.altitude_km,
                row.albedo,
                row.month,
                row.method,
                row.setting
            );
            let _ = match &row.found {
                None => write!(csv, ",,,,,,,"),
                Some(f) => {
                    let radiance = f.radiance.map_or(",".into(), |[rms, worst]| format!("{rms:.3e},{worst:.3e}"));
                    write!(
                        csv,
                        "{radiance},{:.3e},{:.3},{:.2},{:.3e},{:.3e},{}",
                        f.luminance_rms, f.ciede2000, f.exposure_ev, f.tables_s, f.picture_s, f.bytes
                    )
                }
            };
            let _ = writeln!(csv, ",{:.1e}", row.reference_error);
        }
        csv
    }

    /// For people: of each regime and setting how many scenes it covers, the medians of its errors and costs.
    #[must_use]
    pub fn summary(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for regime in Regime::ALL {
            let here: Vec<&Row> = self.rows.iter().filter(|row| row.regime == regime).collect();
            if here.is_empty() {
                continue;
            }
            lines.push(format!(
                "{:<44} scenes  radiance  luminance  CIEDE2000  tables/core-s  picture/core-s",
                regime.name()
            ));
            let mut seen: Vec<(&str, &str)> = Vec::new();
            for row in &here {
                if seen.contains(&(row.method, row.setting)) {
                    continue;
                }
                seen.push((row.method, row.setting));
                let same = here.iter().filter(|other| (other.method, other.setting) == (row.method, row.setting));
                let all = same.clone().count();
                let found: Vec<&Found> = same.filter_map(|other| other.found.as_ref()).collect();
                let name = format!("  {}: {}", row.method, row.setting);
                if found.is_empty() {
                    lines.push(format!("{name:<44} 0 of {all}"));
                    continue;
                }
                let of = |value: &dyn Fn(&Found) -> f64| median(found.iter().map(|f| value(f)).collect());
                let radiance = match found[0].radiance {
                    Some(_) => format!("{:>7.3} %", 100.0 * of(&|f| f.radiance.map_or(f64::NAN, |r| r[0]))),
                    None => "        -".into(),
                };
                lines.push(format!(
                    "{name:<44} {:>2} of {all:<2} {radiance}  {:>7.3} %  {:>9.2}  {:>13.4}  {:>14.5}",
                    found.len(),
                    100.0 * of(&|f| f.luminance_rms),
                    of(&|f| f.ciede2000),
                    of(&|f| f.tables_s),
                    of(&|f| f.picture_s)
                ));
            }
        }
        let judged = |row: &&Row| row.found.as_ref().and_then(|f| f.radiance).is_some();
        let blunt = |row: &&Row| {
            row.found.as_ref().and_then(|f| f.radiance).is_some_and(|[rms, _]| row.reference_error > 0.1 * rms)
        };
        lines.push(format!(
            "{} of {} errors of radiance are below ten times that of their reference",
            self.rows.iter().filter(judged).filter(blunt).count(),
            self.rows.iter().filter(judged).count()
        ));
        lines
    }
}

/// The median; no number of none.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(f64::NAN)
}

/// Climbs the ladder with that many threads, each with atmospheres of its own, so that every time is that of one core.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn make(data: &Data, size: Size, threads: usize, progress: &(dyn Fn(f64) + Sync)) -> Result<Ladder, RenderError> {
    let (air, settings) = (atmospheres(size), settings(size));
    let total = air.iter().map(|air| air.scenes.len() * (settings.len() + 1)).sum::<usize>() as f64;
    let done = AtomicUsize::new(0);
    let rows: Mutex<Vec<(usize, Vec<Row>)>> = Mutex::new(Vec::new());
    super::on_one_core_each(air.len(), threads, &|i| {
        let step = || {
            let done = done.fetch_add(1, Ordering::Relaxed) + 1;
            progress(done as f64 / total);
        };
        let made = one(data, size, &air[i], &settings, &step)?;
        // A thread that panicked takes the study with it.
        rows.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((i, made));
        Ok(())
    })?;
    let mut rows = rows.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    rows.sort_by_key(|(i, _)| *i);
    Ok(Ladder { rows: rows.into_iter().flat_map(|(_, rows)| rows).collect() })
}

/// All settings on all scenes of an atmosphere.
fn one(
    data: &Data,
    size: Size,
    atmosphere: &scenes::Atmosphere,
    settings: &[Setting],
    step: &dyn Fn(),
) -> Result<Vec<Row>, RenderError> {
    let reference = reference::Reference::new(data, size, &atmosphere.scenes[0])?;
    let mut right = Vec::new();
    for scene in &atmosphere.scenes {
        right.push(reference.seen(data, scene)?);
        step();
    }
    let mut rows = Vec::new();
    for setting in settings {
        let found = measure::measure(data, setting, &atmosphere.scenes, &right, step)?;
        for ((scene, right), found) in atmosphere.scenes.iter().zip(&right).zip(found) {
            rows.push(Row {
                regime: Regime::of(scene, reference.optical_depth()),
                aerosol: (atmosphere.name.to_owned(), reference.optical_depth()),
                sun_elevation_deg: scene.sun_elevation_deg,
                altitude_km: scene.altitude_km,
                albedo: atmosphere.albedo,
                month: scene.month,
                method: setting.method(),
                setting: setting.name,
                found,
                reference_error: right.error,
            });
        }
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(found: Option<Found>) -> Row {
        Row {
            regime: Regime::Day,
            aerosol: ("none".into(), 0.0),
            sun_elevation_deg: 30.0,
            altitude_km: 0.002,
            albedo: 0.1,
            month: 6,
            method: "single",
            setting: "32 points",
            found,
            reference_error: 1e-4,
        }
    }

    #[test]
    fn every_row_has_as_many_fields_as_the_header() {
        let found = Found {
            radiance: None,
            luminance_rms: 0.1,
            ciede2000: 2.0,
            exposure_ev: 12.0,
            tables_s: 0.0,
            picture_s: 1e-3,
            bytes: 0,
        };
        let spectral = Found { radiance: Some([0.1, 0.2]), ..found };
        let ladder = Ladder { rows: vec![row(None), row(Some(found)), row(Some(spectral))] };
        let csv = ladder.csv();
        let fields = |line: &str| line.split(',').count();
        let mut lines = csv.lines().skip(1);
        let header = fields(lines.next().expect("a header"));
        assert!(lines.clone().count() == 3 && lines.all(|line| fields(line) == header), "{csv}");
        assert!(ladder.summary().iter().any(|line| line.contains("2 of 3")));
        assert!(ladder.summary().iter().any(|line| line.starts_with("0 of 1 errors")));
    }
}
