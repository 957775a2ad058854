//! Pictures read back: the channels of an EXR file.

use super::EncodeError;
use ::exr::meta::MetaData;
use ::exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use std::collections::BTreeMap;
use std::io::Cursor;

/// The most pixels of a picture that is read: those of the largest that this program writes.
const MAX_PIXELS: usize = 16_384 * 16_384;

/// Bytes of samples that a byte of a file can stand for, and those that any file may: deflate makes at most 1032 of one.
const MOST_PER_BYTE: usize = 1100;
const FREE_BYTES: usize = 1 << 20;

/// The channels of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Channels {
    /// Width and height in pixels.
    pub size: (usize, usize),
    /// Samples by the name of the channel, row by row from the top.
    pub samples: BTreeMap<String, Vec<f32>>,
}

impl Channels {
    /// Reads the first layer of an EXR file, any compression, with samples of 16 or 32 bits.
    ///
    /// # Errors
    /// [`EncodeError::Exr`] if the bytes are no EXR file that can be read, have more than 2^28 pixels, claim more samples than they can hold, or if
    /// a channel has other pixels than the picture.
    pub fn read(bytes: &[u8]) -> Result<Self, EncodeError> {
        let wrong = |text: String| EncodeError::Exr(text);
        let meta = MetaData::read_from_buffered(Cursor::new(bytes), true).map_err(|error| wrong(error.to_string()))?;
        for header in &meta.headers {
            let pixels = header.layer_size.width().checked_mul(header.layer_size.height());
            let pixels = pixels.filter(|pixels| *pixels <= MAX_PIXELS);
            let pixels = pixels.ok_or_else(|| wrong(format!("more than {MAX_PIXELS} pixels")))?;
            let samples = pixels.saturating_mul(header.channels.bytes_per_pixel);
            if samples > bytes.len().saturating_mul(MOST_PER_BYTE).saturating_add(FREE_BYTES) {
                return Err(wrong(format!(
                    "{pixels} pixels in {} bytes: the file is cut, or its header wrong",
                    bytes.len()
                )));
            }
        }
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(Cursor::new(bytes))
            .map_err(|error| wrong(error.to_string()))?;
        let layer = image.layer_data;
        let size = (layer.size.width(), layer.size.height());
        let pixels = size.0 * size.1;
        let mut samples = BTreeMap::new();
        for channel in layer.channel_data.list {
            let values: Vec<f32> = match channel.sample_data {
                FlatSamples::F32(values) => values,
                FlatSamples::F16(values) => values.iter().map(|value| value.to_f32()).collect(),
                FlatSamples::U32(values) => values.iter().map(|value| *value as f32).collect(),
            };
            let name = channel.name.to_string();
            if values.len() != pixels {
                return Err(wrong(format!("channel {name} has {} of {pixels} pixels", values.len())));
            }
            samples.insert(name, values);
        }
        Ok(Self { size, samples })
    }

    /// Linear sRGB of each pixel; `None` if the picture lacks R, G or B.
    #[must_use]
    pub fn rgb(&self) -> Option<Vec<[f64; 3]>> {
        let [r, g, b] = [self.samples.get("R")?, self.samples.get("G")?, self.samples.get("B")?];
        Some((0..r.len()).map(|i| [r[i], g[i], b[i]].map(f64::from)).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{DiscLayer, Film, Picture, exr};
    use crate::spectrum::Colour;

    /// A picture of 9 x 5 pixels with blocks whose values are their places.
    fn picture() -> Vec<u8> {
        let mut film = Film::new(9, 5, vec![2.0], false);
        for row in &mut film.rows_mut() {
            for x in 0..row.width() {
                let value = f64::from(10 * row.y + x);
                [value, value + 2.0].into_iter().for_each(|v| row.add(x, &[v], [v, 2.0 * v, 3.0]));
            }
        }
        let (disc, colour) = (DiscLayer::new(), Colour::direct());
        let picture = Picture { film: &film, disc: &disc, colour: &colour };
        exr::encode(&picture, Some(&[550.0]), &[]).expect("encodes")
    }

    #[test]
    fn a_picture_is_read_as_it_was_written() {
        let channels = Channels::read(&picture()).expect("a picture");
        assert_eq!(channels.size, (9, 5));
        assert_eq!(channels.rgb().expect("colours")[9 * 4 + 8], [49.0, 98.0, 3.0]);
        assert_eq!((channels.samples["S0.550,000nm"][0], channels.samples["error.R"][7]), (2.0, 1.0));
    }

    #[test]
    fn damage_is_an_error_or_another_picture_and_never_a_panic() {
        let sound = picture();
        for length in (0..sound.len()).step_by(7) {
            assert!(Channels::read(&sound[..length]).is_err(), "{length} bytes were taken");
        }
        // Each byte of the header and the first of the pixels, one bit of it changed.
        for index in 0..sound.len().min(1500) {
            let mut damaged = sound.clone();
            damaged[index] ^= 1 << (index % 8);
            if let Ok(channels) = Channels::read(&damaged) {
                assert!(channels.samples.values().all(|values| values.len() == channels.size.0 * channels.size.1));
            }
        }
    }
}
