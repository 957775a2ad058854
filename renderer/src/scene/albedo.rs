//! What the ground reflects: Lambertian.

use super::{Scene, SceneError};
use crate::data::Data;
use crate::ground::{self, EARTH};
use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::str::FromStr;
use tables::{Axis, Curve, Scale, TableError, excerpt};

/// What the ground reflects: Lambertian.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Albedo {
    /// The same at every wavelength, 0 to 1.
    Grey(f64),
    /// The spectrum of a ground of the data, by name; [`EARTH`], the map of the Earth; or a CSV file that is still to be read ([`Spectrum::from_csv`]).
    Ground(String),
    /// A spectrum of one's own. Scenes keep its numbers, so that pictures can be made again without the file.
    Spectrum(Spectrum),
}

/// Pairs of wavelength in nm, strictly increasing from above 0, and albedo, 0 to 1: 2 to 100 000 of them. Between two wavelengths the
/// albedo is linear; outside it is not known.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(transparent)]
pub struct Spectrum(Vec<[f64; 2]>);

/// The most pairs of a spectrum.
const MOST: usize = 100_000;

/// The header of a CSV file.
const COLUMNS: [&str; 2] = ["wavelength_nm", "albedo"];

/// What is wrong with a CSV file of albedos.
#[derive(Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {what}")]
pub struct AlbedoError {
    /// Its number, from 1.
    pub line: usize,
    /// What was expected, and what is there.
    pub what: String,
}

impl Spectrum {
    /// Reads a CSV file: remarks (`#`), the header `wavelength_nm,albedo`, then a pair of numbers a line.
    ///
    /// # Errors
    /// [`AlbedoError`] with the first line that is none, or whose numbers cannot be.
    pub fn from_csv(bytes: &[u8]) -> Result<Self, AlbedoError> {
        let fail = |line: usize, what: String| AlbedoError { line, what };
        let before = |error: std::str::Utf8Error| bytes[..error.valid_up_to()].iter().filter(|b| **b == b'\n').count();
        let text = std::str::from_utf8(bytes).map_err(|error| fail(1 + before(error), "UTF-8 is expected".into()))?;
        let lines = text.trim_start_matches('\u{feff}').lines().map(str::trim);
        let mut lines = (1..).zip(lines).filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let cells = |line: &str| line.split(',').map(|cell| cell.trim().to_owned()).collect::<Vec<_>>();
        let (line, header) = lines.next().unwrap_or((1, ""));
        if cells(header) != COLUMNS {
            let found = excerpt(header);
            return Err(fail(line, format!("the columns {} are expected, {found:?} is there", COLUMNS.join(","))));
        }
        let (mut pairs, mut last) = (Vec::new(), line);
        for (line, text) in lines {
            let numbers: Vec<f64> = cells(text).iter().filter_map(|cell| cell.parse().ok()).collect();
            let (2, &[wavelength_nm, albedo]) = (cells(text).len(), numbers.as_slice()) else {
                return Err(fail(line, format!("two numbers are expected, {:?} is there", excerpt(text))));
            };
            let pair = [wavelength_nm, albedo];
            check(pairs.last(), pair).map_err(|what| fail(line, what))?;
            pairs.push(pair);
            last = line;
        }
        number(pairs.len()).map_err(|what| fail(last, what))?;
        Ok(Self(pairs))
    }

    /// # Errors
    /// [`SceneError::Refused`] with the first pair that cannot be.
    pub(super) fn validate(&self) -> Result<(), SceneError> {
        let refuse = |what: String| SceneError::Refused(format!("albedo: {what}"));
        number(self.0.len()).map_err(refuse)?;
        let before = std::iter::once(None).chain(self.0.iter().map(Some));
        before.zip(&self.0).try_for_each(|(before, pair)| check(before, *pair)).map_err(refuse)
    }

    fn curve(&self) -> Result<Curve, TableError> {
        let [nm, albedo] = [0, 1].map(|column| self.0.iter().map(|pair| pair[column]).collect());
        Curve::new(Axis::new("wavelength", "nm", nm)?, Scale::Linear, albedo)
    }
}

/// Whether a spectrum may have so many pairs.
fn number(pairs: usize) -> Result<(), String> {
    let possible = (2..=MOST).contains(&pairs);
    if possible { Ok(()) } else { Err(format!("{pairs} wavelengths; 2 to {MOST} are possible")) }
}

/// Whether a pair may follow another.
fn check(before: Option<&[f64; 2]>, [wavelength_nm, albedo]: [f64; 2]) -> Result<(), String> {
    let least = before.map_or(0.0, |before| before[0]);
    if !(wavelength_nm.is_finite() && wavelength_nm > least) {
        return Err(format!("wavelength_nm is {wavelength_nm}; more than {least} is expected, they increase"));
    }
    if !(0.0..=1.0).contains(&albedo) {
        return Err(format!("albedo is {albedo}; 0 to 1 is possible"));
    }
    Ok(())
}

impl Scene {
    /// Albedo of the ground at each wavelength.
    ///
    /// # Errors
    /// As [`Scene::albedo_at`].
    pub fn albedo_spectrum(&self, data: &Data) -> Result<Vec<f64>, SceneError> {
        self.albedo_at(data, self.wavelengths().nm())
    }

    /// Whether the ground is the map of the Earth.
    #[must_use]
    pub fn has_texture(&self) -> bool {
        matches!(&self.albedo, Albedo::Ground(name) if name == EARTH)
    }

    /// Albedo of the ground at some wavelengths in nm; of the map of the Earth its mean over the sphere.
    ///
    /// # Errors
    /// [`SceneError::Unknown`] for a ground that the data do not have, [`SceneError::Ground`]
    /// for a wavelength that its spectrum does not reach.
    pub fn albedo_at(&self, data: &Data, wavelengths_nm: &[f64]) -> Result<Vec<f64>, SceneError> {
        let named = |source: TableError| SceneError::Ground { name: self.albedo.to_string(), source };
        let own;
        let spectrum = match &self.albedo {
            Albedo::Grey(value) => return Ok(vec![*value; wavelengths_nm.len()]),
            Albedo::Ground(name) if name == EARTH => {
                return ground::mean_albedo(wavelengths_nm).map_err(SceneError::Refused);
            }
            Albedo::Ground(name) => {
                let grounds = &data.ground_albedo.spectra;
                let known = || grounds.keys().map(String::as_str).chain([EARTH]).collect::<Vec<_>>();
                grounds.get(name).ok_or_else(|| SceneError::unknown("albedo", name, known()))?
            }
            Albedo::Spectrum(spectrum) => {
                own = spectrum.curve().map_err(named)?;
                &own
            }
        };
        wavelengths_nm.iter().map(|&nm| spectrum.at(nm).map_err(named)).collect()
    }
}

/// A number is grey, a string the name of a ground, a sequence a spectrum. (Derived, it would keep whatever else stands there in memory.)
impl<'de> Deserialize<'de> for Albedo {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Ways;
        impl<'de> Visitor<'de> for Ways {
            type Value = Albedo;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a reflectance, the name of a ground, or pairs of wavelength and albedo")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Albedo, E> {
                Ok(Albedo::Grey(value))
            }

            fn visit_u64<E>(self, value: u64) -> Result<Albedo, E> {
                Ok(Albedo::Grey(value as f64))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Albedo, E> {
                Ok(Albedo::Grey(value as f64))
            }

            fn visit_str<E>(self, name: &str) -> Result<Albedo, E> {
                Ok(Albedo::Ground(name.into()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut from: A) -> Result<Albedo, A::Error> {
                let mut pairs = Vec::new();
                while let Some(pair) = from.next_element::<[f64; 2]>()? {
                    pairs.push(pair);
                    if pairs.len() > MOST {
                        return Err(serde::de::Error::custom(format_args!("more than {MOST} wavelengths")));
                    }
                }
                Ok(Albedo::Spectrum(Spectrum(pairs)))
            }
        }
        from.deserialize_any(Ways)
    }
}

/// A number is grey, anything else the name of a ground or of a file.
impl FromStr for Albedo {
    type Err = std::convert::Infallible;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Ok(text.parse().map_or_else(|_| Self::Ground(text.into()), Self::Grey))
    }
}

impl std::fmt::Display for Albedo {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Grey(value) => value.fmt(f),
            Self::Ground(name) => f.write_str(name),
            Self::Spectrum(Spectrum(pairs)) => match (pairs.first(), pairs.last()) {
                (Some([from, _]), Some([to, _])) => {
                    write!(f, "by a spectrum of {} wavelengths, {from} to {to} nm", pairs.len())
                }
                _ => f.write_str("by an empty spectrum"),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spectrum::Wavelengths;
    use std::path::Path;

    const GRASS: &str = "# title: grass\n\nwavelength_nm, albedo\n350,0.02\n550,0.1\n680,0.04\n800,0.45\n";

    fn grass() -> Scene {
        Scene { albedo: Albedo::Spectrum(Spectrum::from_csv(GRASS.as_bytes()).expect("reads")), ..Scene::default() }
    }

    #[test]
    fn a_spectrum_is_linear_between_its_wavelengths_and_refused_outside() {
        let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
        // 0.02 + 0.08 / 4 and 0.1 - 0.06 * 30 / 130, to rounding.
        let albedo = grass().albedo_at(&data, &[350.0, 400.0, 580.0]).expect("in range");
        assert!(
            albedo.iter().zip([0.02, 0.04, 0.1 - 0.06 * 3.0 / 13.0]).all(|(a, b)| (a - b).abs() < 1e-15),
            "{albedo:?}"
        );
        let error = grass().albedo_at(&data, &[810.0]).expect_err("outside").to_string();
        assert!(error.contains("810") && error.contains("800"), "{error}");
        let scene = Scene { wavelengths_nm: Wavelengths::new(vec![350.0, 800.0]).expect("valid"), ..grass() };
        assert_eq!(scene.albedo_spectrum(&data).expect("in range"), [0.02, 0.45]);
    }

    #[test]
    fn a_scene_carries_the_numbers_of_its_spectrum() {
        let scene = grass();
        scene.validate().expect("valid");
        assert_eq!(Scene::from_json(&scene.to_json()).expect("reads"), scene);
        assert_eq!(Scene::from_toml(&scene.to_toml(false)).expect("reads"), scene);
        let whole = Scene::from_toml("albedo = [[350, 0], [800, 1]]").expect("whole numbers are numbers");
        assert_eq!(whole.albedo, Albedo::Spectrum(Spectrum(vec![[350.0, 0.0], [800.0, 1.0]])));
        let falling = Scene::from_toml("albedo = [[350, 0], [350, 1]]").expect("reads");
        assert!(falling.validate().expect_err("no spectrum").to_string().contains("more than 350"));
    }

    #[test]
    fn what_is_wrong_with_a_file_is_said_with_its_line() {
        for (text, line, part) in [
            ("", 1, "wavelength_nm,albedo"),
            ("nm,albedo\n400,0.1", 1, "\"nm,albedo\" is there"),
            ("wavelength_nm,albedo\n400,0.1", 2, "2 to 100000"),
            ("wavelength_nm,albedo\n400,0.1\n500,x", 3, "\"500,x\""),
            ("wavelength_nm,albedo\n400,0.1,7\n500,1", 2, "two numbers"),
            ("wavelength_nm,albedo\n400,0.1\n# a\n500,1.5", 4, "albedo is 1.5"),
            ("wavelength_nm,albedo\n400,0.1\n400,0.2", 3, "more than 400"),
            ("wavelength_nm,albedo\n400,0.1\nNaN,0.2", 3, "wavelength_nm is NaN"),
            ("wavelength_nm,albedo\n400,NaN", 2, "albedo is NaN"),
        ] {
            let error = Spectrum::from_csv(text.as_bytes()).expect_err(text);
            assert!(error.line == line && error.what.contains(part), "{text}: {error}");
        }
        assert_eq!(Spectrum::from_csv(b"wavelength_nm,albedo\n\xff").expect_err("no UTF-8").line, 2);
    }
}
