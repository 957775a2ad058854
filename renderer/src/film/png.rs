//! The picture to look at: eight-bit sRGB.

use super::{EncodeError, Picture, tone};

/// A PNG file of the picture at an exposure value (see [`tone::white_cd_m2`]); black where it shows nothing.
///
/// # Errors
/// [`EncodeError::Png`] if the library refuses.
pub fn encode(picture: &Picture<'_>, exposure_ev: f64) -> Result<Vec<u8>, EncodeError> {
    file(picture.film.size(), &pixels(picture, exposure_ev))
}

/// Its pixels, row by row, three bytes each.
#[must_use]
pub fn pixels(picture: &Picture<'_>, exposure_ev: f64) -> Vec<u8> {
    let (width, height) = picture.film.size();
    let white = tone::white_cd_m2(exposure_ev);
    (0..width as usize * height as usize)
        .flat_map(|pixel| tone::display(picture.rgb(pixel), white).map(tone::srgb_byte))
        .collect()
}

/// A PNG file of eight-bit sRGB pixels, row by row.
///
/// # Errors
/// [`EncodeError::Png`] if the library refuses.
pub fn file((width, height): (u32, u32), pixels: &[u8]) -> Result<Vec<u8>, EncodeError> {
    let mut bytes = Vec::new();
    let mut encoder = ::png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(::png::ColorType::Rgb);
    encoder.set_depth(::png::BitDepth::Eight);
    encoder.set_source_srgb(::png::SrgbRenderingIntent::Perceptual);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{DiscLayer, Film};
    use crate::spectrum::{Colour, Wavelengths};
    use crate::test_data;

    #[test]
    fn pixels_are_read_back_as_they_were_shown() {
        let wavelengths = Wavelengths::visible(1).expect("valid");
        let (sun, observer) = test_data::light();
        let colour = Colour::new(&sun, &observer, &wavelengths).expect("in range");
        let mut film = Film::new(2, 1, vec![1.0]);
        film.rows_mut()[0].add(1, &[1.0], [100.0, 50.0, 25.0]);
        let picture = Picture { film: &film, disc: &DiscLayer::new(), colour: &colour };
        let ev = (200.0_f64 / 1.2).log2();
        let bytes = encode(&picture, ev).expect("encodes");
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
        let mut pixels = vec![0; 6];
        reader.next_frame(&mut pixels).expect("a frame");
        assert_eq!(pixels, [0, 0, 0, 188, 137, 99]);
    }
}
