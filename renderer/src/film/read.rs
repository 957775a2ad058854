//! Pictures read back: the channels of an EXR file.

use super::EncodeError;
use ::exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use std::collections::BTreeMap;

/// The most pixels of a picture that is read: those of the largest that this program writes.
const MAX_PIXELS: usize = 16_384 * 16_384;

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
    /// [`EncodeError::Exr`] if the bytes are no EXR file that can be read, or a channel has other pixels than the picture.
    pub fn read(bytes: &[u8]) -> Result<Self, EncodeError> {
        let wrong = |text: String| EncodeError::Exr(text);
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_buffered(std::io::Cursor::new(bytes))
            .map_err(|error| wrong(error.to_string()))?;
        let layer = image.layer_data;
        let size = (layer.size.width(), layer.size.height());
        let pixels = size.0.checked_mul(size.1).filter(|pixels| *pixels <= MAX_PIXELS);
        let pixels = pixels.ok_or_else(|| wrong(format!("{} x {} pixels are too many", size.0, size.1)))?;
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
