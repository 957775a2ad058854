//! Which light is shown as white: chromatic adaptation.

use crate::spectrum::{linear_srgb, xyz};
use schemars::{Schema, SchemaGenerator, json_schema};
use serde::de::Error;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use std::fmt::{Display, Formatter};
use std::str::FromStr;

/// Colour temperatures of daylight in K.
const DAYLIGHT: (f64, f64) = (4000.0, 25_000.0);

/// The white of a picture: what has its chromaticity is shown grey.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub enum White {
    /// That of sRGB, (x, y) = (0.3127, 0.3290): colours are shown as they are.
    #[default]
    D65,
    /// Equal power at every wavelength, (1/3, 1/3).
    E,
    /// The sun above the air.
    Sun,
    /// Daylight of a correlated colour temperature in K, 4000 to 25 000.
    Daylight(f64),
}

/// Rows of the matrix from XYZ to the sharpened cone responses of Bradford: K. M. Lam 1985, "Metamerism and colour constancy"; as in
/// ICC.1:2010, annex E.
const BRADFORD: [[f64; 3]; 3] = [[0.8951, 0.2664, -0.1614], [-0.7502, 1.7135, 0.0367], [0.0389, -0.0685, 1.0296]];

/// Its inverse, to 16 digits.
const FROM_BRADFORD: [[f64; 3]; 3] = [
    [0.986_992_905_466_712_3, -0.147_054_256_420_990_13, 0.159_962_651_663_731_22],
    [0.432_305_269_723_394_6, 0.518_360_271_536_777_6, 0.049_291_228_212_855_59],
    [-0.008_528_664_575_177_328, 0.040_042_821_654_084_86, 0.968_486_695_787_55],
];

fn times(matrix: [[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
    matrix.map(|row| row[0] * v[0] + row[1] * v[1] + row[2] * v[2])
}

impl White {
    /// The word of this white, or the error that says what may stand there.
    fn parse(text: &str) -> Result<Self, String> {
        match text {
            "d65" => return Ok(Self::D65),
            "e" => return Ok(Self::E),
            "sun" => return Ok(Self::Sun),
            _ => {}
        }
        let (low, high) = DAYLIGHT;
        let kelvin = text.strip_suffix(['K', 'k']).and_then(|number| number.parse::<f64>().ok());
        match kelvin {
            Some(kelvin) if (low..=high).contains(&kelvin) => Ok(Self::Daylight(kelvin)),
            Some(kelvin) => Err(format!("daylight of {kelvin} K is not defined; {low}K to {high}K is possible")),
            None => Err(format!(
                "white is {:?}; d65, e, sun or a colour temperature such as 5500K is possible",
                tables::excerpt(text)
            )),
        }
    }

    /// CIE XYZ with Y = 1, the sun above the air having the colour `sun`.
    ///
    /// Daylight: x_D = a/T^3 + b/T^2 + c/T + d by two sets of constants below and above 7000 K, y_D = -3 x_D^2 + 2.87 x_D - 0.275 (CIE 15:2004,
    /// section 3.1).
    #[must_use]
    pub fn xyz(self, sun: [f64; 3]) -> [f64; 3] {
        let of = |x: f64, y: f64| [x / y, 1.0, (1.0 - x - y) / y];
        match self {
            Self::D65 => xyz([1.0; 3]),
            Self::E => [1.0; 3],
            Self::Sun => sun.map(|value| value / sun[1]),
            Self::Daylight(kelvin) => {
                let t = 1e3 / kelvin;
                let x = if kelvin <= 7000.0 {
                    ((-4.6070 * t + 2.9678) * t + 0.099_11) * t + 0.244_063
                } else {
                    ((-2.0064 * t + 1.9018) * t + 0.247_48) * t + 0.237_040
                };
                of(x, (-3.0 * x + 2.87) * x - 0.275)
            }
        }
    }

    /// What adapts an eye from this white to that of the display, the sun above the air having the colour `sun`.
    #[must_use]
    pub fn adaptation(self, sun: [f64; 3]) -> Adaptation {
        let [own, display] = [self.xyz(sun), xyz([1.0; 3])].map(|white| times(BRADFORD, white));
        let gains = std::array::from_fn(|i| display[i] / own[i]);
        Adaptation((self != Self::D65).then_some(gains))
    }
}

/// Gains of the three cone responses, as of von Kries; none where colours stay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Adaptation(Option<[f64; 3]>);

impl Adaptation {
    /// A linear sRGB colour as the adapted eye has it: B^-1 diag(gains) B in XYZ.
    #[must_use]
    pub fn rgb(self, rgb: [f64; 3]) -> [f64; 3] {
        let Some(gains) = self.0 else { return rgb };
        let cones = times(BRADFORD, xyz(rgb));
        linear_srgb(times(FROM_BRADFORD, std::array::from_fn(|i| gains[i] * cones[i])))
    }
}

impl Display for White {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::D65 => f.write_str("d65"),
            Self::E => f.write_str("e"),
            Self::Sun => f.write_str("sun"),
            Self::Daylight(kelvin) => write!(f, "{kelvin}K"),
        }
    }
}

impl FromStr for White {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        Self::parse(text)
    }
}

impl Serialize for White {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for White {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        Self::parse(&String::deserialize(from)?).map_err(D::Error::custom)
    }
}

/// For the schema of scenes.
pub(crate) fn schema(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string", "pattern": "^(d65|e|sun|[0-9.]+K)$" })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Something like the sun: XYZ in any unit.
    const SUN: [f64; 3] = [1.95e3, 2.0e3, 1.99e3];

    #[test]
    fn a_white_becomes_grey_and_keeps_its_luminance() {
        for white in [White::D65, White::E, White::Sun, White::Daylight(4000.0), White::Daylight(12_000.0)] {
            let [r, g, b] = white.adaptation(SUN).rgb(linear_srgb(white.xyz(SUN).map(|value| 5.0 * value)));
            // The matrices of sRGB have ten decimals.
            assert!([r, g, b].iter().all(|c| (c - 5.0).abs() < 1e-7), "{white}: {r} {g} {b}");
        }
        assert_eq!(White::D65.adaptation(SUN).rgb([0.1, -0.2, 3.0]), [0.1, -0.2, 3.0]);
    }

    #[test]
    fn daylight_has_the_chromaticities_of_the_cie() {
        // D50, D55, D65 and D75 of CIE 15:2004, at their temperatures by today's second radiation constant (1.4388 for 1.4380).
        for (nominal, x, y) in
            [(5000.0, 0.3457, 0.3585), (5500.0, 0.3325, 0.3476), (6500.0, 0.3127, 0.3291), (7500.0, 0.2991, 0.3149)]
        {
            let [big_x, _, z] = White::Daylight(nominal * 1.4388 / 1.4380).xyz(SUN);
            let sum = big_x + 1.0 + z;
            // The published ones have four decimals and rounded temperatures; that of D50 is off by 1.01e-4.
            assert!(
                (big_x / sum - x).abs() < 2e-4 && (1.0 / sum - y).abs() < 2e-4,
                "{nominal}: {} {}",
                big_x / sum,
                1.0 / sum
            );
        }
    }

    #[test]
    fn the_transform_is_undone_by_its_inverse() {
        let there = times(FROM_BRADFORD, times(BRADFORD, [0.3, 0.5, 0.2]));
        assert!(there.iter().zip([0.3, 0.5, 0.2]).all(|(a, b)| (a - b).abs() < 1e-14), "{there:?}");
    }

    #[test]
    fn words_read_back_and_others_are_refused() {
        for word in ["d65", "e", "sun", "5500K", "6503.5K"] {
            assert_eq!(White::parse(word).expect(word).to_string(), word);
        }
        assert!(White::parse("3200K").expect_err("too red").contains("4000K to 25000K"));
        assert!(White::parse("NaNK").is_err() && White::parse("").is_err());
        assert!(White::parse("d55").expect_err("unknown").contains("5500K"));
    }
}
