//! The pictures to look at: eight-bit sRGB.

use super::{Development, EncodeError, Picture};
use crate::polarisation::Stokes;

/// A PNG file of the picture, developed so; black where it shows nothing.
///
/// # Errors
/// [`EncodeError::Png`] if the library refuses.
pub fn encode(picture: &Picture<'_>, development: &Development) -> Result<Vec<u8>, EncodeError> {
    file(picture.film.size(), &pixels(picture, development))
}

/// Its pixels, row by row, three bytes each.
#[must_use]
pub fn pixels(picture: &Picture<'_>, development: &Development) -> Vec<u8> {
    development.bytes(picture.film.size().0, picture.rgbs())
}

/// From this degree of linear polarisation on the hue of its angle is shown in full; below it fades to black, for the angle of
/// natural light is noise.
const FULL_HUE: f64 = 0.1;

/// A PNG file of the picture's linear polarisation, twice as wide: on the left the degree, black 0 and white 1 in even steps of
/// grey, on the right the angle as hue, red along e1 (horizontal), then yellow, green, at 90 degrees cyan, blue, magenta and
/// red again. `None` of a film that keeps no Stokes parameters.
#[must_use]
pub fn encode_polarisation(picture: &Picture<'_>) -> Option<Result<Vec<u8>, EncodeError>> {
    let (width, height) = picture.film.size();
    let stokes: Vec<Stokes> = (0..width as usize * height as usize).map_while(|pixel| picture.stokes(pixel)).collect();
    let rows = picture.film.keeps_stokes().then(|| stokes.chunks(width as usize))?;
    let pixels = rows.flat_map(|row| row.iter().map(degree_bytes).chain(row.iter().map(angle_bytes)));
    let pixels: Vec<u8> = pixels.flatten().collect();
    Some(file((2 * width, height), &pixels))
}

fn byte(share: f64) -> u8 {
    (255.0 * share).round().clamp(0.0, 255.0) as u8
}

/// A pixel of the degree of polarisation, as [`encode_polarisation`] shows it.
#[must_use]
pub fn degree_bytes(seen: &Stokes) -> [u8; 3] {
    [byte(seen.degree()); 3]
}

/// A pixel of the angle of polarisation, as [`encode_polarisation`] shows it.
#[must_use]
pub fn angle_bytes(seen: &Stokes) -> [u8; 3] {
    let strength = (seen.degree() / FULL_HUE).min(1.0);
    hue(seen.angle_deg() / 180.0).map(|share| byte(share * strength))
}

/// Red, green and blue, 0 to 1, of a hue: 0 red, 1/3 green, 2/3 blue, lines between.
fn hue(turn: f64) -> [f64; 3] {
    [0.0, 1.0 / 3.0, 2.0 / 3.0].map(|own| {
        let apart = (turn - own).abs();
        (2.0 - 6.0 * apart.min(1.0 - apart)).clamp(0.0, 1.0)
    })
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
    use crate::film::{DiscLayer, Film, Tone, White};
    use crate::spectrum::{Colour, Wavelengths};
    use crate::test_data;

    #[test]
    fn pixels_are_read_back_as_they_were_shown() {
        let wavelengths = Wavelengths::visible(1).expect("valid");
        let (sun, observer, ozone) = test_data::light();
        let colour = Colour::new(&sun, &observer, &ozone, &wavelengths).expect("in range");
        let mut film = Film::new(2, 1, vec![1.0], false);
        film.rows_mut()[0].add(1, &[1.0], [100.0, 50.0, 25.0]);
        let picture = Picture { film: &film, disc: &DiscLayer::new(), colour: &colour };
        let development = Development::new(Tone::Shoulder, White::D65, [1.0; 3], (200.0_f64 / 1.2).log2());
        // 187.52, 136.96 and 99.09, rounded up from 0.49 on by the pixel's threshold.
        assert_eq!(decoded(&encode(&picture, &development).expect("encodes")), [0, 0, 0, 188, 137, 99]);
        assert!(encode_polarisation(&picture).is_none());
    }

    fn decoded(bytes: &[u8]) -> Vec<u8> {
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(bytes)).read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
        reader.next_frame(&mut pixels).expect("a frame");
        pixels
    }

    #[test]
    fn polarisation_is_grey_by_degree_and_coloured_by_angle() {
        let wavelengths = Wavelengths::visible(1).expect("valid");
        let (sun, observer, ozone) = test_data::light();
        let colour = Colour::new(&sun, &observer, &ozone, &wavelengths).expect("in range");
        let mut film = Film::new(4, 1, vec![1.0], true);
        // Horizontal, at 60 degrees, vertical and weak, natural.
        let (sin, cos) = 120_f64.to_radians().sin_cos();
        for (x, [q, u]) in (0..).zip([[1.0, 0.0], [0.6 * cos, 0.6 * sin], [-0.05, 0.0], [0.0, 0.0]]) {
            film.rows_mut()[0].add(x, &[1.0, q, u], [100.0; 3]);
        }
        let picture = Picture { film: &film, disc: &DiscLayer::new(), colour: &colour };
        let pixels = decoded(&encode_polarisation(&picture).expect("kept").expect("encodes"));
        let (degree, angle) = pixels.split_at(12);
        assert_eq!(degree, [[255; 3], [153; 3], [13; 3], [0; 3]].concat());
        assert_eq!(angle, [[255, 0, 0], [0, 255, 0], [0, 128, 128], [0, 0, 0]].concat());
    }
}
