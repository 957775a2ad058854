//! The picture to calculate with: OpenEXR, 32-bit floats, scan lines, lossless (ZIP).
//!
//! | channel | holds |
//! |---|---|
//! | `R`, `G`, `B` | linear sRGB (BT.709 primaries, D65), scaled so that 0.2126 R + 0.7152 G + 0.0722 B is luminance in cd/m^2 (`whiteLuminance` = 1) |
//! | `error.R`, `error.G`, `error.B`, `error.Y` | standard errors of these and of the luminance |
//! | `S0.550,000nm` ... | spectral radiance in W m^-2 sr^-1 nm^-1, on demand; layout of Fichet, Pacanowski & Wilkie, JCGT 10(3), 2021 |
//! | `error.S0.550,000nm` ... | their standard errors |
//!
//! The solar disc is in the values and not in the errors. Outside the circle of a fisheye
//! everything is zero; the error of a pixel with one sample is infinite. The same picture
//! gives the same bytes: no clock is asked, and attributes are in alphabetical order.

use super::{EncodeError, Picture};
use ::exr::meta::MetaData;
use ::exr::meta::attribute::{AttributeValue, Chromaticities};
use ::exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, Layer, LayerAttributes, LineOrder,
    SmallVec, Text, Vec2, WritableImage,
};

/// The value of an attribute of the file.
#[derive(Debug, Clone, PartialEq)]
pub enum Attribute {
    /// UTF-8 text.
    Text(String),
    /// A 64-bit number.
    Number(f64),
    /// A whole number.
    Integer(i32),
}

/// Name of the spectral channel of a wavelength in nm, to a picometre: `S0.550,000nm`.
#[must_use]
pub fn channel_name(wavelength_nm: f64) -> String {
    format!("S0.{wavelength_nm:.3}nm").replacen('.', "\u{0}", 1).replace('.', ",").replace('\u{0}', ".")
}

/// An EXR file of the picture. `spectral` lists the wavelengths of the film in nm if their channels are
/// wanted. Attributes of the format itself (`dataWindow` and the like) cannot be given.
///
/// # Errors
/// [`EncodeError::Exr`] if the library refuses.
pub fn encode(
    picture: &Picture<'_>,
    spectral: Option<&[f64]>,
    attributes: &[(String, Attribute)],
) -> Result<Vec<u8>, EncodeError> {
    let film = picture.film;
    let (width, height) = film.size();
    let pixels = width as usize * height as usize;
    let mut list: SmallVec<[AnyChannel<FlatSamples>; 4]> = SmallVec::new();
    // Where the picture shows nothing there is nothing to be uncertain of.
    let known = |pixel: usize, error: f64| if film.samples(pixel) > 0 { error } else { 0.0 };
    let mut add = |name: String, value: &dyn Fn(usize) -> f64| {
        let samples = (0..pixels).map(|pixel| value(pixel) as f32).collect();
        list.push(AnyChannel::new(text(&name), FlatSamples::F32(samples)));
    };
    for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
        add(name.into(), &|pixel| picture.rgb(pixel)[c]);
        add(format!("error.{name}"), &|pixel| known(pixel, film.rgb(pixel)[c].error));
    }
    add("error.Y".into(), &|pixel| known(pixel, film.luminance(pixel).error));
    for (index, &wavelength_nm) in spectral.unwrap_or_default().iter().enumerate() {
        let name = channel_name(wavelength_nm);
        add(format!("error.{name}"), &|pixel| known(pixel, film.radiance(pixel, index).error));
        add(name, &|pixel| picture.radiance(pixel, index));
    }

    let mut own = LayerAttributes { white_luminance: Some(1.0), ..LayerAttributes::default() };
    if spectral.is_some() {
        own.other.insert(text("spectralLayoutVersion"), AttributeValue::Text(text("1.0")));
        own.other.insert(text("emissiveUnits"), AttributeValue::Text(text("W.m^-2.sr^-1.nm^-1")));
    }
    for (name, value) in attributes {
        let value = match value {
            Attribute::Text(value) => AttributeValue::Text(text(value)),
            Attribute::Number(value) => AttributeValue::F64(*value),
            Attribute::Integer(value) => AttributeValue::I32(*value),
        };
        own.other.insert(text(name), value);
    }
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
    let size = (width as usize, height as usize);
    let mut image = Image::from_layer(Layer::new(size, own, encoding, AnyChannels::sort(list)));
    image.attributes.chromaticities = Some(Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    });
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.write().non_parallel().to_buffered(&mut bytes).map_err(|e| EncodeError::Exr(e.to_string()))?;
    with_sorted_header(bytes.into_inner()).ok_or_else(|| EncodeError::Exr("its own header cannot be read".into()))
}

/// The text of the attribute `name` in the EXR file that `bytes` are; `None` if it has no such text.
///
/// # Errors
/// [`EncodeError::Exr`] if they are no EXR file.
pub fn text_attribute(bytes: &[u8], name: &str) -> Result<Option<String>, EncodeError> {
    let meta = MetaData::read_from_buffered(std::io::Cursor::new(bytes), false)
        .map_err(|error| EncodeError::Exr(error.to_string()))?;
    let value = meta.headers.first().and_then(|header| header.own_attributes.other.get(&text(name)));
    Ok(match value {
        Some(AttributeValue::Text(value)) => String::from_utf8(value.as_slice().to_vec()).ok(),
        _ => None,
    })
}

/// Bytes of a string attribute; OpenEXR takes UTF-8.
fn text(value: &str) -> Text {
    Text::from_slice_unchecked(value.as_bytes())
}

/// The file with the attributes of its header in alphabetical order. The library writes
/// them in the order of a hash map, another one each time; moving them leaves
/// every offset of the file as it was. A header is magic and version (8 bytes), then
/// attributes (name 0 type 0 length:i32 value) up to an empty name.
fn with_sorted_header(mut bytes: Vec<u8>) -> Option<Vec<u8>> {
    const START: usize = 8;
    let mut at = START;
    let mut attributes: Vec<Vec<u8>> = Vec::new();
    while *bytes.get(at)? != 0 {
        let start = at;
        for _name_and_type in 0..2 {
            at += bytes.get(at..)?.iter().position(|&b| b == 0)? + 1;
        }
        let length = i32::from_le_bytes(*bytes.get(at..)?.first_chunk::<4>()?);
        at = at.checked_add(4)?.checked_add(usize::try_from(length).ok()?)?;
        attributes.push(bytes.get(start..at)?.to_vec());
    }
    attributes.sort();
    bytes[START..at].copy_from_slice(&attributes.concat());
    Some(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::film::{DiscLayer, Film};
    use crate::spectrum::{Colour, Wavelengths};
    use crate::test_data;
    use ::exr::prelude::{ReadChannels, ReadLayers, read};

    fn encoded() -> Vec<u8> {
        let wavelengths = Wavelengths::new(vec![450.0, 550.25]).expect("valid");
        let (sun, observer) = test_data::light();
        let colour = Colour::new(&sun, &observer, &wavelengths).expect("in range");
        let mut film = Film::new(3, 2, vec![2.0, 1.5]);
        let mut rows = film.rows_mut();
        for (value, red) in [(1.0, 10.0), (3.0, 20.0)] {
            rows[1].add(2, &[value, 4.0], [red, 5.0, 6.0]);
        }
        let disc = DiscLayer::from([(5, vec![7.0, 7e6])]);
        let picture = Picture { film: &film, disc: &disc, colour: &colour };
        let attributes: Vec<(String, Attribute)> = (0..20)
            .map(|i| (format!("airlight.{i}"), Attribute::Integer(i)))
            .chain([("airlight.scene".into(), Attribute::Text("{\"latitude\":\"45°\"}".into()))])
            .collect();
        encode(&picture, Some(wavelengths.nm()), &attributes).expect("encodes")
    }

    #[test]
    fn what_is_written_is_read_back() {
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(std::io::Cursor::new(encoded()))
            .expect("an EXR file");
        let layer = image.layer_data;
        let value = |name: &str| -> f32 {
            let channel = layer.channel_data.list.iter().find(|c| c.name.eq(name)).expect("there");
            channel.sample_data.values_as_f32().last().expect("pixels")
        };
        assert_eq!(value("error.R"), 5.0);
        assert_eq!(value("S0.450,000nm"), 4.0 + 14.0);
        assert_eq!(value("error.S0.450,000nm"), 2.0);
        // The disc is beyond half precision and kept.
        assert_eq!(value("S0.550,250nm"), 6.0 + 1.05e7);
        assert_eq!(value("error.S0.550,250nm"), 0.0);
        assert!(value("G") > 1e4);
        let attribute = |name| text_attribute(&encoded(), name).expect("an EXR file");
        assert_eq!(attribute("airlight.scene").as_deref(), Some("{\"latitude\":\"45°\"}"));
        assert_eq!(attribute("airlight.none"), None);
        assert!(text_attribute(b"no such file", "airlight.scene").is_err());
        assert_eq!(layer.attributes.other[&text("emissiveUnits")], AttributeValue::Text(text("W.m^-2.sr^-1.nm^-1")));
    }

    #[test]
    fn the_same_picture_gives_the_same_bytes() {
        let first = encoded();
        // Each encoding has a hash map with other keys inside.
        assert!((0..4).all(|_| encoded() == first));
    }
}
