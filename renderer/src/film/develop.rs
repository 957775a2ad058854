//! From light to the eight bits of a display.

use super::tone::{srgb_code, white_cd_m2};
use super::{Adaptation, Tone, White};

/// How a picture is shown: white, exposure and tone curve.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Development {
    adaptation: Adaptation,
    white_cd_m2: f64,
    tone: Tone,
}

/// Width of the dither's pattern in pixels, a power of two.
const PATTERN: u32 = 8;

impl Development {
    /// At an exposure value (see [`white_cd_m2`]), the sun above the air having the colour `sun` in XYZ.
    #[must_use]
    pub fn new(tone: Tone, white: White, sun: [f64; 3], exposure_ev: f64) -> Self {
        Self { adaptation: white.adaptation(sun), white_cd_m2: white_cd_m2(exposure_ev), tone }
    }

    /// The bytes of the pixels of a picture of that width, row by row, from linear sRGB in cd/m^2.
    ///
    /// Codes between two whole numbers are dithered, rounded up in as large a share of the pixels around as they lie above the lower one: a
    /// twilight's slow gradient would else show steps. A code c becomes floor(c + t), t the pixel's threshold, so that whole codes,
    /// black and white stay.
    #[must_use]
    pub fn bytes(&self, width: u32, rgb: impl IntoIterator<Item = [f64; 3]>) -> Vec<u8> {
        let places = (0..).flat_map(|y| (0..width).map(move |x| (x, y)));
        let shown = rgb.into_iter().map(|rgb| self.tone.display(self.adaptation.rgb(rgb), self.white_cd_m2));
        // 0 to 255, since codes are at most 255 and thresholds below 1.
        let byte = |linear: f64, (x, y): (u32, u32)| (srgb_code(linear) + threshold(x, y)).floor() as u8;
        shown.zip(places).flat_map(|(shown, place)| shown.map(|linear| byte(linear, place))).collect()
    }
}

/// The threshold of a pixel, from 1/128 to 127/128 in steps of 1/64: each of 64 once in every square of eight by eight pixels, neighbours far apart
/// (B. E. Bayer 1973, "An optimum method for two-level rendition of continuous-tone pictures"). Its binary digits after the point are, from
/// the first, those of x xor y and of y in turn, each beginning with its last digit.
fn threshold(x: u32, y: u32) -> f64 {
    let (mut value, mut unit) = (0.5 / f64::from(PATTERN * PATTERN), 0.5);
    for bit in 0..PATTERN.ilog2() {
        for digit in [(x ^ y) >> bit & 1, y >> bit & 1] {
            value += unit * f64::from(digit);
            unit *= 0.5;
        }
    }
    value
}

#[cfg(test)]
mod tests {
    use super::*;

    const SUN: [f64; 3] = [0.95, 1.0, 1.0];

    #[test]
    fn every_threshold_comes_once() {
        let mut all: Vec<f64> = (0..PATTERN).flat_map(|y| (0..PATTERN).map(move |x| threshold(x, y))).collect();
        all.sort_by(f64::total_cmp);
        let even = |(k, t): (i32, &f64)| *t == (f64::from(k) + 0.5) / 64.0;
        assert!((0..).zip(&all).all(even), "{all:?}");
    }

    #[test]
    fn a_gradient_keeps_its_mean_and_black_and_white_stay() {
        let development = Development::new(Tone::Linear, White::D65, SUN, 0.0);
        // A grey of 100.3 on the scale of 255, by the inverse of the standard's curve, in 64 pixels; 1.2 cd/m^2 is white.
        let linear = ((100.3 / 255.0 + 0.055) / 1.055_f64).powf(2.4);
        let bytes = development.bytes(8, std::iter::repeat_n([1.2 * linear; 3], 64));
        let mean = bytes.iter().map(|b| f64::from(*b)).sum::<f64>() / bytes.len() as f64;
        // Thresholds are 1/64 apart.
        assert!((mean - 100.3).abs() < 0.01 && bytes.iter().all(|b| [100, 101].contains(b)), "{mean}");
        assert!(development.bytes(8, std::iter::repeat_n([0.0; 3], 64)).iter().all(|b| *b == 0));
        assert!(development.bytes(8, std::iter::repeat_n([9.0; 3], 64)).iter().all(|b| *b == 255));
    }

    #[test]
    fn what_is_white_is_shown_grey() {
        let light = crate::spectrum::linear_srgb(White::Sun.xyz(SUN).map(|value| 0.3 * value));
        let grey = |white| Development::new(Tone::Shoulder, white, SUN, 0.0).bytes(1, [light]);
        let adapted = grey(White::Sun);
        assert!(adapted.iter().all(|b| *b == adapted[0]), "{adapted:?}");
        assert!(grey(White::D65).iter().any(|b| *b != adapted[0]));
    }
}
