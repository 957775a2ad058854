//! What leaving polarisation out costs in a scene: measurements that `airlight study polarisation` stores, and the program carries.
//!
//! Where a scene lies between the measured suns, albedos of the ground, amounts of aerosol and wavelengths, values are linear
//! between them; where it lies outside, nothing is said but why.

use crate::atmosphere::{Air, Depolarisation, Haze, HazePhase};
use crate::scene::Scene;
use crate::transport::Method;
use std::fmt::Write;
use tables::views::{AerosolSource, Biome};

/// Elevations of the sun in degrees, increasing.
pub const SUNS: [f64; 10] = [-6.0, -3.0, 0.0, 3.0, 8.0, 16.0, 30.0, 45.0, 65.0, 90.0];

/// Albedos of the ground, increasing.
pub const ALBEDOS: [f64; 3] = [0.0, 0.3, 0.8];

/// Wavelengths in nm, increasing.
pub const WAVELENGTHS: [f64; 12] =
    [320.0, 350.0, 380.0, 410.0, 440.0, 480.0, 520.0, 560.0, 610.0, 670.0, 760.0, 1000.0];

/// Quantities: luminance, then radiance at each of [`WAVELENGTHS`].
pub const QUANTITIES: usize = 1 + WAVELENGTHS.len();

/// The highest observer in km, the lowest top of the atmosphere in km and the most aerosol, in multiples of the type's own, for which
/// the measurements from 2 m, up to 120 km and of the type's own amount are taken.
const HIGHEST_KM: f64 = 1.0;
const LOWEST_TOP_KM: f64 = 80.0;
const MOST_AEROSOL: f64 = 1.5;

/// The fewest wavelengths of which luminance is made.
const COLOURS: usize = 4;

/// How far scalar transfer is off over the dome of the sky, relative to polarised radiance: shares.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Off {
    /// Root of the mean square over the dome by solid angle.
    pub rms: f64,
    /// In the worst direction, without its sign.
    pub worst: f64,
    /// Standard error of the latter.
    pub error: f64,
}

impl Off {
    /// `share` of the way from here to `other`.
    fn towards(self, other: Self, share: f64) -> Self {
        let mix = |a: f64, b: f64| a + share * (b - a);
        let (rms, worst) = (mix(self.rms, other.rms), mix(self.worst, other.worst));
        Self { rms, worst, error: mix(self.error, other.error) }
    }
}

/// All that is measured: of clear air and of each biome, each of [`SUNS`], each of [`ALBEDOS`], the [`QUANTITIES`].
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    rows: Vec<[Off; QUANTITIES]>,
}

/// Clear air, and every biome.
#[must_use]
pub fn aerosols() -> Vec<Option<Biome>> {
    std::iter::once(None).chain(Biome::ALL.into_iter().map(Some)).collect()
}

/// The word for it in the file.
#[must_use]
pub fn word(aerosol: Option<Biome>) -> &'static str {
    aerosol.map_or("none", Biome::name)
}

/// The rows in their order: aerosol, elevation of the sun in degrees, albedo.
fn keys() -> impl Iterator<Item = (Option<Biome>, f64, f64)> {
    let of_sun = |aerosol, sun| ALBEDOS.into_iter().map(move |albedo| (aerosol, sun, albedo));
    aerosols().into_iter().flat_map(move |aerosol| SUNS.into_iter().flat_map(move |sun| of_sun(aerosol, sun)))
}

impl Measured {
    /// Measures all of it: `measure` gives the quantities of an aerosol, an elevation of the sun and an albedo.
    ///
    /// # Errors
    /// Those of `measure`.
    pub fn by<E>(mut measure: impl FnMut(Option<Biome>, f64, f64) -> Result<[Off; QUANTITIES], E>) -> Result<Self, E> {
        let rows = keys().map(|(aerosol, sun, albedo)| measure(aerosol, sun, albedo));
        Ok(Self { rows: rows.collect::<Result<_, E>>()? })
    }

    /// The measurements that this program carries.
    ///
    /// # Errors
    /// A sentence, if the file is none: a test sees to it that this does not happen.
    pub fn stored() -> Result<Self, String> {
        Self::parse(include_str!("../../measured/polarisation.csv"))
    }

    /// One row.
    #[must_use]
    pub fn of(&self, aerosol: usize, sun: usize, albedo: usize) -> &[Off; QUANTITIES] {
        &self.rows[(aerosol * SUNS.len() + sun) * ALBEDOS.len() + albedo]
    }

    fn header() -> String {
        let mut header = String::from("aerosol,sun_elevation_deg,albedo");
        let names = std::iter::once("luminance".to_owned()).chain(WAVELENGTHS.map(|nm| format!("{nm}nm")));
        for name in names {
            // Writing to a string does not fail.
            let _ = write!(header, ",{name}_rms_percent,{name}_worst_percent,{name}_error_percent");
        }
        header
    }

    /// As the file has it: a header, and a row for each aerosol, sun and albedo, in percent.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut csv = Self::header() + "\n";
        for ((aerosol, sun, albedo), row) in keys().zip(&self.rows) {
            let _ = write!(csv, "{},{sun},{albedo}", word(aerosol));
            for Off { rms, worst, error } in row {
                let _ = write!(csv, ",{:.2},{:.2},{:.2}", 100.0 * rms, 100.0 * worst, 100.0 * error);
            }
            csv.push('\n');
        }
        csv
    }

    /// Reads what [`Measured::csv`] writes.
    ///
    /// # Errors
    /// A sentence with the line: another header, row or number than there must be.
    pub fn parse(csv: &str) -> Result<Self, String> {
        let mut lines = csv.lines();
        if lines.next() != Some(Self::header().as_str()) {
            return Err("line 1: another header than that of this program's study".into());
        }
        let mut rows = Vec::new();
        for (at, (aerosol, sun, albedo)) in (2..).zip(keys()) {
            let wanted = format!("{},{sun},{albedo},", word(aerosol));
            let line = lines.next().ok_or_else(|| format!("line {at}: the row {wanted} is missing"))?;
            let rest = line.strip_prefix(&wanted).ok_or_else(|| format!("line {at}: expected the row {wanted}"))?;
            let numbers: Option<Vec<f64>> = rest.split(',').map(|text| text.parse().ok()).collect();
            let numbers = numbers.filter(|numbers| {
                numbers.len() == 3 * QUANTITIES && numbers.iter().all(|x| x.is_finite() && *x >= 0.0)
            });
            let numbers = numbers.ok_or_else(|| format!("line {at}: expected {} percentages", 3 * QUANTITIES))?;
            let off = |k: usize| [0, 1, 2].map(|i| 0.01 * numbers[3 * k + i]);
            rows.push(std::array::from_fn(|k| {
                let [rms, worst, error] = off(k);
                Off { rms, worst, error }
            }));
        }
        match lines.next() {
            Some(line) => Err(format!("a row too many: {}", tables::excerpt(line))),
            None => Ok(Self { rows }),
        }
    }

    /// A quantity of an aerosol in an amount of so many times the type's own, at an elevation of the sun in degrees and an albedo, all
    /// within what is measured.
    fn at(&self, (aerosol, amount): (usize, f64), sun: f64, albedo: f64, quantity: usize) -> Off {
        let ((s, along_sun), (a, along_albedo)) = (between(&SUNS, sun), between(&ALBEDOS, albedo));
        let of = |aerosol: usize| {
            let at_sun = |s: usize| {
                let [low, high] = [a, a + 1].map(|a| self.of(aerosol, s, a)[quantity]);
                low.towards(high, along_albedo)
            };
            at_sun(s).towards(at_sun(s + 1), along_sun)
        };
        of(0).towards(of(aerosol), amount.min(1.0))
    }
}

/// The interval of increasing nodes that holds x, and the share of it below x.
fn between(nodes: &[f64], x: f64) -> (usize, f64) {
    let i = nodes.partition_point(|&node| node <= x).clamp(1, nodes.len() - 1) - 1;
    (i, (x - nodes[i]) / (nodes[i + 1] - nodes[i]))
}

/// What leaving polarisation out costs in a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftOut {
    /// Of luminance; `None` with fewer than four wavelengths.
    pub luminance: Option<Off>,
    /// Of radiance at the wavelength of the scene at which it is largest.
    pub radiance: Off,
    /// That wavelength in nm.
    pub nm: f64,
}

impl LeftOut {
    /// Of a scene with that air, over a ground that reflects so much at each of its wavelengths, by the stored measurements.
    ///
    /// # Errors
    /// In what the scene lies outside what was measured, a phrase.
    pub fn of(scene: &Scene, air: &Air, albedos: &[f64]) -> Result<Self, String> {
        let amount = air.haze().map_or(0.0, Haze::factor);
        let nm = scene.wavelengths_nm.nm();
        inside(scene, amount)?;
        let measured = Measured::stored()?;
        let aerosol = aerosols().iter().position(|&aerosol| aerosol == scene.biome).unwrap_or(0);
        let at =
            |albedo: f64, quantity: usize| measured.at((aerosol, amount), scene.sun_elevation_deg, albedo, quantity);
        let mut worst = (Off::default(), nm[0]);
        let mut mean = 0.0;
        for (&nm, &albedo) in nm.iter().zip(albedos) {
            let (i, share) = between(&WAVELENGTHS, nm);
            let off = at(albedo, 1 + i).towards(at(albedo, 2 + i), share);
            if off.rms <= 0.0 {
                return Err(format!("{nm} nm with this aerosol and sun: noise hides it"));
            }
            if off.rms > worst.0.rms {
                worst = (off, nm);
            }
            mean += albedo / albedos.len() as f64;
        }
        let luminance = (nm.len() >= COLOURS).then(|| at(mean, 0));
        Ok(Self { luminance, radiance: worst.0, nm: worst.1 })
    }

    /// Whether a picture that is to be off by no more than `error` needs polarisation.
    ///
    /// Polarised transfer takes c times as long for equal noise. Without it the noise must leave room for what is left out, b (rms):
    /// the whole is `error` E with the noise sqrt(E^2 - b^2), which takes E^2 / (E^2 - b^2) times as long. That is more than c where
    /// b > E sqrt(1 - 1 / c): 0.6 E for the c of 16 wavelengths, 1.3 to 1.9 (`airlight bench polarised`). Solved pictures, whose
    /// tables take 1.7 times as long, leave the same room.
    #[must_use]
    pub fn calls_for_polarisation(&self, error: f64) -> bool {
        const COST: f64 = 1.6;
        self.luminance.unwrap_or(self.radiance).rms > error * (1.0 - 1.0 / COST).sqrt()
    }
}

/// Whether the method of a scene follows polarisation: that of all orders does.
pub(super) fn can_follow(scene: &Scene) -> bool {
    scene.method == Method::Solved || scene.method.estimator().is_some()
}

/// Whether light is followed with its polarisation in a scene that does not say: by methods of all orders, unless leaving it out is known
/// to cost less than the error that is asked.
pub(super) fn is_followed(scene: &Scene, air: &Air, albedo: &[f64]) -> bool {
    let known = air.haze().is_none() || scene.phase == HazePhase::Mie;
    can_follow(scene)
        && known
        && LeftOut::of(scene, air, albedo).map_or(true, |left_out| left_out.calls_for_polarisation(scene.asked_error()))
}

/// Refuses what was not measured.
fn inside(scene: &Scene, amount: f64) -> Result<(), String> {
    let nm = scene.wavelengths_nm.nm();
    let (first, last) = (WAVELENGTHS[0], WAVELENGTHS[WAVELENGTHS.len() - 1]);
    let refusals = [
        (!scene.tables.is_empty(), "own tables".to_owned()),
        (scene.biome.is_some() && scene.phase == HazePhase::HenyeyGreenstein, "Henyey-Greenstein functions".into()),
        (scene.biome.is_some() && scene.aerosol_source != AerosolSource::Opac, "this source of aerosol".into()),
        (
            scene.method.estimator().is_none() && scene.method != Method::Solved,
            "methods of less than all orders".into(),
        ),
        (scene.orders.is_some(), "some orders alone".into()),
        (scene.flat, "a planet that is a plane".into()),
        (scene.depolarisation != Depolarisation::default(), "air without depolarisation".into()),
        (scene.humidity_percent.is_some(), "another humidity than the type's own".into()),
        (amount > MOST_AEROSOL, format!("more than {MOST_AEROSOL} times the type's own aerosol")),
        (scene.sun_elevation_deg < SUNS[0], format!("the sun below {} degrees", SUNS[0])),
        (scene.altitude_km > HIGHEST_KM, format!("an observer above {HIGHEST_KM} km")),
        (scene.top_km < LOWEST_TOP_KM, format!("a top below {LOWEST_TOP_KM} km")),
        (nm.iter().any(|nm| !(first..=last).contains(nm)), format!("wavelengths below {first} nm")),
    ];
    match refusals.into_iter().find(|(outside, _)| *outside) {
        Some((_, what)) => Err(what),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_stored_measurements_cover_what_they_say() {
        let measured = Measured::stored().expect("parses");
        assert_eq!(measured.rows.len(), 10 * SUNS.len() * ALBEDOS.len());
        assert_eq!(Measured::parse(&measured.csv()), Ok(measured.clone()));
        for ((aerosol, sun, albedo), row) in keys().zip(&measured.rows) {
            let what = format!("{} {sun} {albedo}", word(aerosol));
            // Rms over the dome, which has far less noise than one direction, stays below 10 % everywhere.
            assert!(row.iter().all(|off| off.rms < 0.1 && off.worst < 0.3), "{what}: {row:?}");
            // By day the worst direction of luminance is known within 0.5 %.
            assert!(sun < 16.0 || row[0].error < 0.005, "{what}: {:?}", row[0]);
        }
        // In the blue of a clear day over dark ground, where light is scattered twice and polarised most, several percent
        // (Mishchenko, Lacis & Travis 1994 have up to 10).
        let blue = measured.at((0, 0.0), 45.0, 0.0, 5);
        assert!(blue.rms > 0.01 && blue.worst > 0.03, "{blue:?}");
        // Far in the red next to nothing is scattered twice.
        assert!(measured.at((0, 0.0), 45.0, 0.0, QUANTITIES - 1).rms < 0.3 * blue.rms);
    }

    #[test]
    fn values_are_linear_between_what_is_measured() {
        let off = |x: f64| Off { rms: x, worst: 2.0 * x, error: 0.0 };
        let value = |aerosol: Option<Biome>, sun: f64, albedo: f64| {
            (if aerosol.is_none() { 0.1 } else { 0.3 }) + 1e-3 * sun + 1e-2 * albedo
        };
        let measured = Measured::by(|aerosol, sun, albedo| Ok::<_, ()>([off(value(aerosol, sun, albedo)); QUANTITIES]));
        let measured = measured.expect("measured");
        let found = measured.at((3, 0.5), 52.0, 0.7, 2);
        assert!((found.rms - (0.2 + 0.052 + 0.007)).abs() < 1e-12, "{found:?}");
        assert!((measured.at((0, 0.0), 90.0, 0.8, 0).worst - 2.0 * (0.1 + 0.09 + 0.008)).abs() < 1e-12);
        assert_eq!(between(&SUNS, -6.0), (0, 0.0));
        assert_eq!(between(&SUNS, 90.0), (SUNS.len() - 2, 1.0));
    }

    #[test]
    fn an_exact_picture_calls_for_polarisation() {
        let off = Off { rms: 0.02, worst: 0.05, error: 0.001 };
        let left_out = LeftOut { luminance: Some(off), radiance: Off::default(), nm: 450.0 };
        // 2 % is 0.61 of 3.27 %.
        assert!(left_out.calls_for_polarisation(0.032) && !left_out.calls_for_polarisation(0.033));
        assert!(!LeftOut { luminance: None, ..left_out }.calls_for_polarisation(1e-5));
    }

    #[test]
    fn what_is_no_measurement_is_refused_with_its_line() {
        let csv = Measured::stored().expect("parses").csv();
        assert!(Measured::parse("aerosol\n").is_err_and(|e| e.starts_with("line 1")));
        let short: String = csv.lines().take(9).map(|line| format!("{line}\n")).collect();
        assert!(Measured::parse(&short).is_err_and(|e| e.starts_with("line 10") && e.contains("missing")));
        let (header, rows) = csv.split_once('\n').expect("lines");
        let broken = format!("{header}\n{}", rows.replacen("none,-6,0,", "none,-6,0,x", 1));
        assert!(Measured::parse(&broken).is_err_and(|e| e.starts_with("line 2") && e.contains("percentages")));
    }

    #[test]
    fn a_scene_outside_is_told_so() {
        let outside = |change: fn(&mut Scene), amount: f64| {
            let mut scene = Scene::default();
            change(&mut scene);
            inside(&scene, amount).err()
        };
        assert_eq!(outside(|_| {}, 1.0), None);
        let hg = |s: &mut Scene| (s.biome, s.phase) = (Some(Biome::Urban), HazePhase::HenyeyGreenstein);
        assert!(outside(hg, 1.0).is_some_and(|why| why.contains("Henyey")));
        assert!(outside(|_| {}, 3.0).is_some_and(|why| why.contains("1.5 times")));
        assert!(outside(|s| s.altitude_km = 400.0, 0.0).is_some_and(|why| why.contains("above 1 km")));
        assert!(outside(|s| s.sun_elevation_deg = -8.0, 0.0).is_some_and(|why| why.contains("-6 degrees")));
    }
}
