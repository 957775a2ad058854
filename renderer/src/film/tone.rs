//! From luminance to the display: exposure and tone curve.

use crate::spectrum::{lab, linear_srgb, luminance, xyz};
use serde::{Deserialize, Serialize};

/// Luminance in cd/m^2 that just saturates a picture exposed for EV 0 at ISO 100:
/// 78 / (100 * 0.65) (ISO 12232, saturation-based speed; lens transmission 0.65).
const SATURATION_CD_M2: f64 = 1.2;

/// What the logarithmic mean luminance becomes, relative to display white.
const KEY: f64 = 0.22;

/// From here the curve [`Tone::Shoulder`] bends towards white.
const SHOULDER: f64 = 0.7;

/// What [`Tone::Reinhard`] shows as white, in units of display white: two stops more.
const BURNT: f64 = 4.0;

/// How many times beyond display white a colour has faded half-way to white.
const FADE: f64 = 8.0;

/// Luminance in cd/m^2 that becomes display white at an exposure value (ISO 100): 1.2 * 2^EV.
#[must_use]
pub fn white_cd_m2(exposure_ev: f64) -> f64 {
    SATURATION_CD_M2 * exposure_ev.exp2()
}

/// The exposure value at which the logarithmic mean of luminances in cd/m^2 (of a picture without the solar disc, or of several
/// that share it) becomes 22 % of display white. Those below a thousandth of the 99th percentile (space, the earth's shadow) do
/// not count. 0 if there is no light.
#[must_use]
pub fn automatic_ev(luminances: impl IntoIterator<Item = f64>) -> f64 {
    let mut bright: Vec<f64> = luminances.into_iter().filter(|&y| y > 0.0).collect();
    if bright.is_empty() {
        return 0.0;
    }
    let place = (bright.len() - 1) * 99 / 100;
    let floor = 1e-3 * *bright.select_nth_unstable_by(place, f64::total_cmp).1;
    bright.retain(|&y| y >= floor);
    // Summed in pixel order would be the same on every run too; sorting makes it plain.
    bright.sort_unstable_by(f64::total_cmp);
    let mean = bright.iter().map(|y| y.log2()).sum::<f64>() / bright.len() as f64;
    mean - (KEY * SATURATION_CD_M2).log2()
}

/// The luminance in cd/m^2 that becomes display white where the logarithmic mean of these luminances, of those above 0, becomes 22 % of it.
#[must_use]
pub fn automatic_white(luminances: &[f64]) -> f64 {
    automatic_white_of(luminances.iter().map(|y| (1.0, *y)))
}

/// As [`automatic_white`], of pairs of a weight and a luminance.
#[must_use]
pub fn automatic_white_of(weighted: impl Iterator<Item = (f64, f64)>) -> f64 {
    let sums = |(all, logs): (f64, f64), (weight, y): (f64, f64)| (all + weight, logs + weight * y.ln());
    let (all, logs) = weighted.filter(|(_, y)| *y > 0.0).fold((0.0, 0.0), sums);
    (logs / all).exp() / KEY
}

/// CIELAB of a colour in XYZ (cd/m^2) as the display shows it, for a white in cd/m^2.
#[must_use]
pub fn displayed(colour: [f64; 3], white_cd_m2: f64) -> [f64; 3] {
    lab(xyz(Tone::default().display(linear_srgb(colour), white_cd_m2)), xyz([1.0; 3]))
}

/// How a luminance m, in units of display white, is shown: a display ends at 1.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Tone {
    /// As it is up to 0.7, then 1 - 0.3 exp(-(m - 0.7)/0.3): nothing is cut off
    #[default]
    Shoulder,
    /// As it is up to 1, and 1 beyond
    Linear,
    /// m (1 + m/16) / (1 + m), 1 from m = 4 on (Reinhard et al. 2002)
    Reinhard,
    /// Dark tones darker, a long shoulder, 1 from m = 5.6 on (Hable 2010)
    Filmic,
}

/// Hable's curve before it is scaled to end at 1 (J. Hable 2010, "Uncharted 2: HDR lighting", Game Developers Conference; the constants of his
/// "Filmic tonemapping operators", shoulder 0.15, linear 0.50 at an angle of 0.10, toe 0.20 of 0.02 over 0.30).
fn hable(x: f64) -> f64 {
    (x * (0.15 * x + 0.10 * 0.50) + 0.20 * 0.02) / (x * (0.15 * x + 0.50) + 0.20 * 0.30) - 0.02 / 0.30
}

/// Hable's white, and by how much he raises the exposure.
const HABLE: (f64, f64) = (11.2, 2.0);

impl Tone {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Shoulder, Self::Linear, Self::Reinhard, Self::Filmic];

    /// The curve: 0 for m = 0, never falling, at most 1. Equation 4 of E. Reinhard, M. Stark, P. Shirley & J. Ferwerda 2002,
    /// "Photographic tone reproduction for digital images", is that of `Reinhard`, with 4 for its L_white.
    #[must_use]
    pub fn curve(self, m: f64) -> f64 {
        let shown = match self {
            Self::Shoulder if m > SHOULDER => 1.0 - (1.0 - SHOULDER) * (-(m - SHOULDER) / (1.0 - SHOULDER)).exp(),
            Self::Shoulder | Self::Linear => m,
            Self::Reinhard => m.min(BURNT) * (1.0 + m.min(BURNT) / (BURNT * BURNT)) / (1.0 + m.min(BURNT)),
            Self::Filmic => {
                let (white, raised) = HABLE;
                hable((raised * m).min(white)) / hable(white)
            }
        };
        shown.min(1.0)
    }

    /// Linear display RGB in 0..=1 of a linear sRGB colour in cd/m^2, for a white in cd/m^2.
    ///
    /// A colour outside the gamut is first mixed with the grey of its luminance until its
    /// lowest component is 0. Then the largest component m becomes [`Tone::curve`] of it; the others
    /// follow in proportion, so hue and saturation stay. What exceeds white, m > 1, fades towards it by the share
    /// (m - 1) / (m + 7), as film and eye do: the sun is brighter than its aureole, so it must not look darker.
    #[must_use]
    pub fn display(self, rgb: [f64; 3], white_cd_m2: f64) -> [f64; 3] {
        let y = luminance(rgb);
        if y <= 0.0 {
            return [0.0; 3];
        }
        let lowest = rgb.into_iter().fold(f64::INFINITY, f64::min);
        let keep = if lowest < 0.0 { y / (y - lowest) } else { 1.0 };
        let inside = rgb.map(|c| ((y + keep * (c - y)) / white_cd_m2).max(0.0));
        let largest = inside.into_iter().fold(0.0, f64::max);
        if largest <= 0.0 {
            return inside;
        }
        let shown = self.curve(largest);
        let beyond = (largest - 1.0).max(0.0);
        let faded = beyond / (beyond + FADE);
        inside.map(|c| shown * (faded + (1.0 - faded) * c / largest))
    }
}

/// The code of a linear display value on a scale from 0 to 255, before it is rounded (IEC 61966-2-1).
#[must_use]
pub fn srgb_code(linear: f64) -> f64 {
    let x = linear.clamp(0.0, 1.0);
    255.0 * if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_begin_at_black_never_fall_and_end_at_white() {
        for tone in Tone::ALL {
            let curve = |k: i32| tone.curve(f64::from(k) / 128.0);
            assert_eq!(curve(0), 0.0, "{tone:?}");
            assert!((1..2048).all(|k| (curve(k - 1)..=1.0).contains(&curve(k))), "{tone:?} never falls");
            // The shoulder comes within exp(-300) of it, all others reach it, but for rounding.
            assert!((tone.curve(100.0) - 1.0).abs() < 1e-12, "{tone:?}");
        }
    }

    #[test]
    fn curves_have_the_points_of_their_sources() {
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-12, "{a} is not {b}");
        near(Tone::Linear.curve(0.3), 0.3);
        near(Tone::Shoulder.curve(0.7), 0.7);
        near(Tone::Shoulder.curve(1.0), 1.0 - 0.3 / std::f64::consts::E);
        // 1 (1 + 1/16) / 2, and white at 4.
        near(Tone::Reinhard.curve(1.0), 17.0 / 32.0);
        near(Tone::Reinhard.curve(4.0), 1.0);
        // What docs/display.md says of the mean luminance, to its three digits.
        assert_eq!(Tone::ALL.map(|tone| (1e3 * tone.curve(KEY)).round()), [220.0, 220.0, 183.0, 154.0]);
        // Hable's white is 11.2 at twice the exposure; 0.5 is 1 for him: (0.204 / 0.71 - 1/15) / 0.725130....
        near(Tone::Filmic.curve(5.6), 1.0);
        let white = (11.2 * 1.73 + 0.004) / (11.2 * 2.18 + 0.06) - 1.0 / 15.0;
        near(Tone::Filmic.curve(0.5), (0.204 / 0.71 - 1.0 / 15.0) / white);
    }

    #[test]
    fn colours_keep_their_proportions_up_to_white() {
        for tone in Tone::ALL {
            let mut last = [0.0; 3];
            for exponent in -8..60 {
                let shown = tone.display([2.0_f64.powi(exponent), 2.0_f64.powi(exponent - 1), 0.0], 1.0);
                assert!(shown.iter().zip(last).all(|(now, before)| *now >= before && *now <= 1.0), "{shown:?}");
                if exponent <= 0 {
                    assert!((shown[1] - 0.5 * shown[0]).abs() < 1e-15 && shown[2] == 0.0, "{shown:?}");
                }
                last = shown;
            }
            assert!(last.iter().all(|c| *c > 1.0 - 1e-12), "a light without bound is white: {last:?}");
        }
    }

    #[test]
    fn a_colour_outside_the_gamut_keeps_its_luminance() {
        let rgb = [-0.1, 0.4, 0.5];
        let shown = Tone::Shoulder.display(rgb, 1.0);
        // The luminances of the primaries have ten decimals.
        assert!((luminance(shown) - luminance(rgb)).abs() < 1e-9 && shown[0].abs() < 1e-15, "{shown:?}");
    }

    #[test]
    fn codes_are_those_of_the_standard() {
        // 0.18 is 118, 0.5 is 188 (IEC 61966-2-1).
        let codes = [0.0, 0.002, 0.18, 0.5, 1.0, 7.0].map(|linear| srgb_code(linear).round());
        assert_eq!(codes, [0.0, 7.0, 118.0, 188.0, 255.0, 255.0]);
    }

    #[test]
    fn exposure_values_are_photographic() {
        // EV 15, the sunny day, saturates at 39 322 cd/m^2.
        assert!((white_cd_m2(15.0) - 39_321.6).abs() < 0.1);
    }
}
