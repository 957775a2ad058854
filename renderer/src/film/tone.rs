//! From luminance to the display: exposure and tone curve.

use super::Picture;
use crate::spectrum::{lab, linear_srgb, luminance, xyz};

/// Luminance in cd/m^2 that just saturates a picture exposed for EV 0 at ISO 100:
/// 78 / (100 * 0.65) (ISO 12232, saturation-based speed; lens transmission 0.65).
const SATURATION_CD_M2: f64 = 1.2;

/// What the logarithmic mean luminance becomes, relative to display white.
const KEY: f64 = 0.22;

/// From here the tone curve bends towards white.
const SHOULDER: f64 = 0.7;

/// How many times beyond display white a colour has faded half-way to white.
const FADE: f64 = 8.0;

/// Luminance in cd/m^2 that becomes display white at an exposure value (ISO 100): 1.2 * 2^EV.
#[must_use]
pub fn white_cd_m2(exposure_ev: f64) -> f64 {
    SATURATION_CD_M2 * exposure_ev.exp2()
}

/// The exposure value at which the logarithmic mean luminance of the picture, the solar disc
/// left out, becomes 22 % of display white. Pixels below a thousandth of the 99th
/// percentile (space, the earth's shadow) do not count. 0 for a black picture.
#[must_use]
pub fn automatic_ev(picture: &Picture<'_>) -> f64 {
    let (width, height) = picture.film.size();
    let mut bright: Vec<f64> = (0..width as usize * height as usize)
        .map(|pixel| picture.film.luminance(pixel).mean)
        .filter(|&y| y > 0.0)
        .collect();
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
    let lit = || luminances.iter().filter(|y| **y > 0.0);
    (lit().map(|y| y.ln()).sum::<f64>() / lit().count() as f64).exp() / KEY
}

/// CIELAB of a colour in XYZ (cd/m^2) as the display shows it, for a white in cd/m^2.
#[must_use]
pub fn displayed(colour: [f64; 3], white_cd_m2: f64) -> [f64; 3] {
    lab(xyz(display(linear_srgb(colour), white_cd_m2)), xyz([1.0; 3]))
}

/// Linear display RGB in 0..=1 of a linear sRGB colour in cd/m^2, for a white in cd/m^2.
///
/// A colour outside the gamut is first mixed with the grey of its luminance until its
/// lowest component is 0. Then the largest component m becomes m up to 0.7, and
/// 1 - 0.3 exp(-(m - 0.7)/0.3) above (slope 1 where they meet, 1 for m without bound); the others
/// follow in proportion, so hue and saturation stay. What exceeds white, m > 1, fades towards it by the share
/// (m - 1) / (m + 7), as film and eye do: the sun is brighter than its aureole, so it must not look darker.
#[must_use]
pub fn display(rgb: [f64; 3], white_cd_m2: f64) -> [f64; 3] {
    let y = luminance(rgb);
    if y <= 0.0 {
        return [0.0; 3];
    }
    let lowest = rgb.into_iter().fold(f64::INFINITY, f64::min);
    let keep = if lowest < 0.0 { y / (y - lowest) } else { 1.0 };
    let inside = rgb.map(|c| ((y + keep * (c - y)) / white_cd_m2).max(0.0));
    let largest = inside.into_iter().fold(0.0, f64::max);
    let shown = if largest > SHOULDER {
        1.0 - (1.0 - SHOULDER) * (-(largest - SHOULDER) / (1.0 - SHOULDER)).exp()
    } else {
        largest
    };
    if largest <= 0.0 {
        return inside;
    }
    let beyond = (largest - 1.0).max(0.0);
    let faded = beyond / (beyond + FADE);
    inside.map(|c| shown * (faded + (1.0 - faded) * c / largest))
}

/// The eight-bit code of a linear display value (IEC 61966-2-1).
#[must_use]
pub fn srgb_byte(linear: f64) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    // 0 to 255 by the clamp.
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curve_is_the_identity_below_and_never_passes_white() {
        let shown = display([30.0, 20.0, 10.0], 100.0);
        // Rounding of the proportions.
        assert!(shown.iter().zip([0.3, 0.2, 0.1]).all(|(a, b)| (a - b).abs() < 1e-15), "{shown:?}");
        let mut last = [0.0; 3];
        for exponent in -8..60 {
            let shown = display([2.0_f64.powi(exponent), 2.0_f64.powi(exponent - 1), 0.0], 1.0);
            assert!(shown.iter().zip(last).all(|(now, before)| *now >= before && *now <= 1.0), "{shown:?}");
            if exponent <= 0 {
                // Up to white proportions stay.
                assert!((shown[1] - 0.5 * shown[0]).abs() < 1e-15 && shown[2] == 0.0, "{shown:?}");
            }
            last = shown;
        }
        assert!(last.iter().all(|c| *c > 1.0 - 1e-12), "a light without bound is white: {last:?}");
    }

    #[test]
    fn a_colour_outside_the_gamut_keeps_its_luminance() {
        let rgb = [-0.1, 0.4, 0.5];
        let shown = display(rgb, 1.0);
        // The luminances of the primaries have ten decimals.
        assert!((luminance(shown) - luminance(rgb)).abs() < 1e-9 && shown[0].abs() < 1e-15, "{shown:?}");
    }

    #[test]
    fn codes_are_those_of_the_standard() {
        // 0.18 is 118, 0.5 is 188 (IEC 61966-2-1).
        assert_eq!([0.0, 0.002, 0.18, 0.5, 1.0, 7.0].map(srgb_byte), [0, 7, 118, 188, 255, 255]);
    }

    #[test]
    fn exposure_values_are_photographic() {
        // EV 15, the sunny day, saturates at 39 322 cd/m^2.
        assert!((white_cd_m2(15.0) - 39_321.6).abs() < 0.1);
    }
}
