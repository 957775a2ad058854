//! The difference of two pictures as a picture.

use crate::film::Channels;
use crate::spectrum::luminance;

/// Ends of the colours in eight-bit sRGB, the second picture darker and brighter; white is no difference (RdBu of ColorBrewer 2.0, C. Brewer 2013).
pub const DIFFERING: [[u8; 3]; 2] = [[33, 102, 172], [178, 24, 43]];

/// Where one of the pictures is not finite.
const NOT_FINITE: [u8; 3] = [0, 200, 0];

/// Rows of the bar below the picture, and of the white line above it.
const BAR: usize = 12;
const LINE: usize = 2;

/// The share of the pixels that the scale holds if none is given.
const HELD: f64 = 0.99;

/// A picture of differences.
#[derive(Debug, Clone, PartialEq)]
pub struct Shown {
    /// Width and height in pixels, with the bar.
    pub size: (u32, u32),
    /// Eight-bit sRGB.
    pub pixels: Vec<u8>,
    /// The difference of luminance, over the mean of the first picture, that the ends of the colours stand for.
    pub scale: f64,
}

/// The difference of luminance, b - a over the mean of a, in each pixel from blue (b is darker) over white to red (brighter), and below it a
/// bar from -`scale` to `scale`. Without a scale the least of 1, 2, 5 times a power of ten that holds 99 % of the pixels. `None` without R, G and B or if
/// sizes differ.
#[must_use]
pub fn difference_picture(a: &Channels, b: &Channels, scale: Option<f64>) -> Option<Shown> {
    let (a_rgb, b_rgb) = (a.rgb()?, b.rgb()?);
    if a.size != b.size {
        return None;
    }
    let (width, height) = a.size;
    let of_a: Vec<f64> = a_rgb.into_iter().map(luminance).collect();
    let lit = of_a.iter().filter(|y| y.is_finite());
    let mean = lit.clone().sum::<f64>() / lit.count().max(1) as f64;
    let off: Vec<f64> = of_a
        .iter()
        .zip(b_rgb.into_iter().map(luminance))
        .map(|(a, b)| if *a == b { 0.0 } else { (b - a) / mean })
        .collect();
    let scale = scale.unwrap_or_else(|| round_scale(&off));
    let mut pixels: Vec<u8> = off.iter().flat_map(|off| colour(off / scale)).collect();
    pixels.extend(std::iter::repeat_n(255, 3 * width * LINE));
    let bar = (0..width).flat_map(|x| colour(2.0 * (x as f64 + 0.5) / width as f64 - 1.0));
    let bar: Vec<u8> = bar.collect();
    pixels.extend(bar.repeat(BAR));
    // No side of a picture that is read exceeds 2^28.
    Some(Shown { size: (width as u32, (height + LINE + BAR) as u32), pixels, scale })
}

/// The colour of a difference over the scale.
fn colour(share: f64) -> [u8; 3] {
    if !share.is_finite() {
        return NOT_FINITE;
    }
    let end = DIFFERING[usize::from(share > 0.0)];
    end.map(|end| (255.0 + share.abs().min(1.0) * (f64::from(end) - 255.0)).round() as u8)
}

/// The least of 1, 2, 5 times a power of ten that is at least the 99th percentile; 1e-6 for equal pictures.
fn round_scale(off: &[f64]) -> f64 {
    const LEAST: f64 = 1e-6;
    let mut sizes: Vec<f64> = off.iter().map(|off| off.abs()).filter(|off| off.is_finite()).collect();
    sizes.sort_by(f64::total_cmp);
    let place = (sizes.len() as f64 * HELD) as usize;
    let held = sizes.get(place.min(sizes.len().saturating_sub(1))).copied().unwrap_or(0.0).max(LEAST);
    let ten = 10.0_f64.powf(held.log10().floor());
    // A hair of room for the logarithm's rounding.
    [1.0, 2.0, 5.0, 10.0]
        .map(|step| step * ten)
        .into_iter()
        .find(|scale| *scale >= held * (1.0 - 1e-12))
        .unwrap_or(held)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::tests::picture;

    #[test]
    fn scales_are_round_and_hold_the_differences() {
        let held = |largest: f64| round_scale(&vec![largest; 200]);
        for (largest, expected) in [(0.013, 0.02), (0.02, 0.02), (0.3, 0.5), (0.7, 1.0), (0.0, 1e-6)] {
            assert!((held(largest) / expected - 1.0).abs() < 1e-9, "{largest}: {}", held(largest));
        }
    }

    #[test]
    fn darker_is_blue_brighter_red_and_equal_white() {
        let grey = |y: [f32; 4]| picture(&[("R", y), ("G", y), ("B", y)]);
        let shown = difference_picture(&grey([1.0; 4]), &grey([0.9, 1.0, 1.1, f32::NAN]), Some(0.1)).expect("alike");
        let pixel = |index: usize| &shown.pixels[3 * index..3 * index + 3];
        // 0.1 in 32 bits is not quite the scale: within one step of a byte.
        let near = |index: usize, colour: [u8; 3]| pixel(index).iter().zip(colour).all(|(a, b)| a.abs_diff(b) <= 1);
        assert!(near(0, DIFFERING[0]) && near(2, DIFFERING[1]), "{:?} {:?}", pixel(0), pixel(2));
        assert!(pixel(1) == [255; 3] && pixel(3) == NOT_FINITE);
        // The bar below, from blue to red.
        assert_eq!(shown.size, (2, 2 + 14));
        assert!(pixel(2 * 10)[2] > pixel(2 * 10)[0] && pixel(2 * 10 + 1)[0] > pixel(2 * 10 + 1)[2]);
    }
}
