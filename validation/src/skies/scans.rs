//! The scans as they were measured, and where the sun stood.

use super::{LEFT_OUT, NEAR_DEG};
use crate::beam::MASKED;
use crate::references::{Sheet, path};
use crate::{Context, ValidationError};
use glam::DVec3;
use renderer::camera::direction_at;
use renderer::scene::{Moment, SunPlace};
use std::collections::BTreeMap;

/// Latitude and longitude of Ithaca NY in degrees.
pub(super) const PLACE: (f64, f64) = (42.4434, -76.4820);

/// Middle of the band in nm by which the turn is found.
const TURN_NM: f64 = 550.0;

/// The index of the direction that is left out of every scan.
const FIRST: &str = "0";

/// The most degrees that the instrument may be turned.
const MOST_TURN: i32 = 30;

/// A direction of a scan.
pub(super) struct Look {
    /// Looked in.
    pub(super) direction: DVec3,
    /// Azimuth clockwise from north and elevation in degrees.
    pub(super) at_deg: (f64, f64),
    /// By band, W m^-2 sr^-1 nm^-1.
    pub(super) radiance: Vec<f64>,
}

/// A scan.
pub(super) struct Scan {
    /// As the file has it, EDT.
    pub(super) time: String,
    /// The sun.
    pub(super) sun: SunPlace,
    /// The directions.
    pub(super) looks: Vec<Look>,
}

impl Scan {
    /// The day, such as 2013-05-27.
    pub(super) fn day(&self) -> &str {
        self.time.split('T').next().unwrap_or_default()
    }

    /// The time for a reader.
    pub(super) fn name(&self) -> String {
        self.time.strip_suffix(":00").unwrap_or(&self.time).replace('T', " ")
    }

    fn moment(&self) -> Result<Moment, ValidationError> {
        format!("{}-04:00", self.time).parse().map_err(|what| renderer::scene::SceneError::Refused(what).into())
    }

    /// The month, 1 to 12.
    pub(super) fn month(&self) -> Result<u8, ValidationError> {
        Ok(self.moment()?.month())
    }

    /// The sun at the time of the file.
    fn sun_then(&self) -> Result<SunPlace, ValidationError> {
        Ok(self.moment()?.sun(PLACE.0, PLACE.1)?)
    }

    /// Degrees of a direction from the sun.
    pub(super) fn off_sun_deg(&self, look: &Look) -> f64 {
        let sun = direction_at(self.sun.azimuth_deg.to_radians(), self.sun.elevation_deg.to_radians());
        look.direction.angle_between(sun).to_degrees()
    }

    /// Whether a direction is far enough from the sun to be judged.
    pub(super) fn far(&self, look: &Look) -> bool {
        self.off_sun_deg(look) >= NEAR_DEG
    }
}

/// The scans that are not left out, with the sun where it stood at the times of the file, and the middles of the bands in nm.
pub(super) fn read(context: &Context<'_>) -> Result<(Vec<Scan>, Vec<f64>), ValidationError> {
    let sheet = Sheet::read(&path(context.root, "sky-scans.csv"))?;
    let bands: Vec<(String, f64)> = sheet
        .header()
        .iter()
        .filter_map(|name| Some((name.clone(), name.strip_prefix('L')?.split("nm").next()?.parse().ok()?)))
        .collect();
    let mut scans: Vec<Scan> = Vec::new();
    for row in 0..sheet.len() {
        let time = sheet.text(row, "local_time_EDT")?;
        if time == LEFT_OUT || sheet.text(row, "index")? == FIRST {
            continue;
        }
        let number = |column: &str| sheet.number(row, column);
        if scans.last().is_none_or(|scan| scan.time != time) {
            let unknown = SunPlace { elevation_deg: 0.0, azimuth_deg: 0.0, distance_au: 1.0 };
            let mut scan = Scan { time: time.to_owned(), sun: unknown, looks: Vec::new() };
            scan.sun = scan.sun_then()?;
            scans.push(scan);
        }
        let at_deg = ((-number("file_azimuth_deg_ccw_from_N")?).rem_euclid(360.0), number("elevation_deg")?);
        let direction = direction_at(at_deg.0.to_radians(), at_deg.1.to_radians());
        let radiance = bands.iter().map(|(name, _)| number(name)).collect::<Result<_, _>>()?;
        if let Some(scan) = scans.last_mut() {
            scan.looks.push(Look { direction, at_deg, radiance });
        }
    }
    Ok((scans, bands.into_iter().map(|(_, nm)| nm).collect()))
}

/// Whether gases that are not modelled absorb in a band of 10 nm about that wavelength.
pub(super) fn masked(nm: f64) -> bool {
    MASKED.iter().any(|&(low, high)| nm + 5.0 > low && nm - 5.0 < high)
}

/// How far the azimuths of a scan are turned, by its symmetry: degrees to add to the sun's azimuth to have it in those of the file, and the
/// asymmetry with and without, rms of ln L left over right.
pub(super) struct Turn {
    pub(super) degrees: f64,
    pub(super) asymmetry: f64,
    pub(super) asymmetry_as_stated: f64,
}

impl Turn {
    /// Of a scan. A clear sky is symmetric about the sun's vertical whatever is in the air: of each ring of one elevation, the mean square of
    /// ln L(a + x) - ln L(a - x) over x from 5 to 175 degrees is least where a is the sun's azimuth.
    pub(super) fn of(scan: &Scan, bands: &[f64]) -> Self {
        let band = bands.iter().position(|&nm| nm == TURN_NM).unwrap_or(0);
        let rings = rings(scan, band);
        let at = |degrees: f64| {
            let squares: f64 = rings.iter().map(|ring| asymmetry(ring, scan.sun.azimuth_deg + degrees)).sum();
            (squares / rings.len().max(1) as f64).sqrt()
        };
        let mut best = Self { degrees: 0.0, asymmetry: at(0.0), asymmetry_as_stated: at(0.0) };
        for degrees in (-MOST_TURN..=MOST_TURN).map(f64::from) {
            let asymmetry = at(degrees);
            if asymmetry < best.asymmetry {
                best = Self { degrees, asymmetry, ..best };
            }
        }
        best
    }
}

/// Azimuths in degrees, rising, and logarithms of radiance.
type Ring = Vec<(f64, f64)>;

/// The rings of one elevation with eight directions or more.
fn rings(scan: &Scan, band: usize) -> Vec<Ring> {
    let mut rings: BTreeMap<u64, Ring> = BTreeMap::new();
    for look in &scan.looks {
        rings.entry(look.at_deg.1.to_bits()).or_default().push((look.at_deg.0, look.radiance[band].ln()));
    }
    let mut rings: Vec<Ring> = rings.into_values().filter(|ring| ring.len() >= 8).collect();
    for ring in &mut rings {
        ring.sort_by(|a, b| a.0.total_cmp(&b.0));
    }
    rings
}

fn asymmetry(ring: &Ring, azimuth: f64) -> f64 {
    let steps = (1..=35).map(|i| 5.0 * f64::from(i));
    steps.map(|x| (around(ring, azimuth + x) - around(ring, azimuth - x)).powi(2)).sum::<f64>() / 35.0
}

/// Between the azimuths of a ring, which closes, by lines.
fn around(ring: &Ring, azimuth: f64) -> f64 {
    let azimuth = azimuth.rem_euclid(360.0);
    let next = ring.partition_point(|(a, _)| *a <= azimuth);
    let n = ring.len();
    let ((a, low), (b, high)) = (ring[(next + n - 1) % n], ring[next % n]);
    let (width, along) = ((b - a).rem_euclid(360.0), (azimuth - a).rem_euclid(360.0));
    low + (high - low) * along / width
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bands_that_touch_absorption_are_left_out() {
        let left: Vec<f64> = (36..=100).map(|i| 10.0 * f64::from(i)).filter(|&nm| !masked(nm)).collect();
        // By hand from the limits: 690 and 700; 720 to 740; 760 and 770; 810 to 840; 890 to 1000.
        assert_eq!(left.len(), 65 - 2 - 3 - 2 - 4 - 12);
        assert!([680.0, 710.0, 750.0, 780.0, 800.0, 850.0, 880.0].iter().all(|nm| left.contains(nm)));
    }

    /// A scan of one ring, the brighter the nearer to that azimuth.
    fn scan(about: f64) -> Scan {
        let looks = (0..24).map(|i| 15.0 * f64::from(i)).map(|azimuth| Look {
            direction: DVec3::Z,
            at_deg: (azimuth, 30.0),
            radiance: vec![(azimuth - about).to_radians().cos().exp()],
        });
        let sun = SunPlace { elevation_deg: 0.0, azimuth_deg: 0.0, distance_au: 1.0 };
        Scan { time: "2013-05-27T09:30:00".into(), sun, looks: looks.collect() }
    }

    #[test]
    fn the_sun_stands_at_stated_times_where_the_file_has_it() {
        // Zenith angle 48.934, azimuth 98.148: three decimals and another algorithm.
        let sun = scan(0.0).sun_then().expect("a date");
        assert!((90.0 - sun.elevation_deg - 48.934).abs() < 0.02 && (sun.azimuth_deg - 98.148).abs() < 0.02, "{sun:?}");
    }

    #[test]
    fn a_turned_instrument_is_found() {
        let turn = Turn::of(&scan(-14.0), &[550.0]);
        // To the step of a degree; lines between directions that are 15 degrees apart leave an asymmetry.
        assert!((turn.degrees + 14.0).abs() <= 1.0, "{}", turn.degrees);
        assert!(turn.asymmetry < 0.02 && turn.asymmetry_as_stated > 0.1);
    }
}
