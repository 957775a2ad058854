//! The picture to calculate with: OpenEXR, 32-bit floats, scan lines, lossless (ZIP).
//!
//! | channel | holds |
//! |---|---|
//! | `R`, `G`, `B` | linear sRGB (BT.709 primaries, D65), scaled so that 0.2126 R + 0.7152 G + 0.0722 B is luminance in cd/m^2 (`whiteLuminance` = 1) |
//! | `error.R`, `error.G`, `error.B`, `error.Y` | standard errors of these and of the luminance |
//! | `S0.550,000nm` ... | spectral radiance in W m^-2 sr^-1 nm^-1, on demand; layout of Fichet, Pacanowski & Wilkie, JCGT 10(3), 2021 |
//! | `error.S0.550,000nm` ... | their standard errors |
//! | `S1.550,000nm`, `S2.550,000nm` ... | of a film of polarised light Q and U in the same unit, with errors likewise |
//! | `S3.550,000nm` ... | zero, for readers of the layout want all four: V is not reported |
//! | `DoLP`, `AoLP` | degree (0 to 1) and angle (degrees from e1 towards e2, 0 to 180) of linear polarisation, of I, Q and U weighed by luminance |
//!
//! The solar disc is in the values and not in the errors. Outside the circle of a fisheye
//! everything is zero; the error of a pixel with one block of samples is infinite. The same picture
//! gives the same bytes: no clock is asked, and attributes are in alphabetical order.

use super::{EncodeError, Picture};
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

/// Name of the spectral channel of a Stokes parameter (0 to 3) at a wavelength in nm, to a picometre: `S0.550,000nm`.
#[must_use]
pub fn channel_name(parameter: usize, wavelength_nm: f64) -> String {
    format!("S{parameter}.{}nm", format!("{wavelength_nm:.3}").replace('.', ","))
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
    let known = |pixel: usize, error: f64| if film.blocks(pixel) > 0 { error } else { 0.0 };
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
        let name = channel_name(0, wavelength_nm);
        add(format!("error.{name}"), &|pixel| known(pixel, film.radiance(pixel, index).error));
        add(name, &|pixel| picture.radiance(pixel, index));
        if film.keeps_stokes() {
            for parameter in [1, 2] {
                let name = channel_name(parameter, wavelength_nm);
                let of = |pixel| film.spectral(pixel, parameter, index);
                add(format!("error.{name}"), &|pixel| known(pixel, of(pixel).error));
                add(name, &|pixel| of(pixel).mean);
            }
            add(channel_name(3, wavelength_nm), &|_| 0.0);
        }
    }
    if film.keeps_stokes() {
        add("DoLP".into(), &|pixel| picture.stokes(pixel).unwrap_or_default().degree());
        add("AoLP".into(), &|pixel| picture.stokes(pixel).unwrap_or_default().angle_deg());
    }

    let mut own = LayerAttributes { white_luminance: Some(1.0), ..LayerAttributes::default() };
    if spectral.is_some() {
        own.other.insert(text("spectralLayoutVersion"), AttributeValue::Text(text("1.0")));
        own.other.insert(text("emissiveUnits"), AttributeValue::Text(text("W.m^-2.sr^-1.nm^-1")));
        if film.keeps_stokes() {
            own.other.insert(text("polarisationHandedness"), AttributeValue::Text(text("right")));
        }
    }
    note(&mut own, attributes);
    file((width as usize, height as usize), own, list)
}

/// An EXR file of a map of light: the channels R, G, B alone, the picture's linear sRGB, the disc included, over `white_luminance` in cd/m^2,
/// which the file says of itself (`whiteLuminance`).
///
/// # Errors
/// As [`encode`].
pub fn encode_map(
    picture: &Picture<'_>,
    white_luminance: f64,
    attributes: &[(String, Attribute)],
) -> Result<Vec<u8>, EncodeError> {
    let (width, height) = picture.film.size();
    let pixels: Vec<[f64; 3]> = (0..width as usize * height as usize).map(|pixel| picture.rgb(pixel)).collect();
    let channel = |(c, name): (usize, &str)| {
        let samples = pixels.iter().map(|rgb| (rgb[c] / white_luminance) as f32).collect();
        AnyChannel::new(text(name), FlatSamples::F32(samples))
    };
    let list = ["R", "G", "B"].into_iter().enumerate().map(channel).collect();
    let mut own = LayerAttributes { white_luminance: Some(white_luminance as f32), ..LayerAttributes::default() };
    note(&mut own, attributes);
    file((width as usize, height as usize), own, list)
}

/// Attributes of one's own.
fn note(own: &mut LayerAttributes, attributes: &[(String, Attribute)]) {
    for (name, value) in attributes {
        let value = match value {
            Attribute::Text(value) => AttributeValue::Text(text(value)),
            Attribute::Number(value) => AttributeValue::F64(*value),
            Attribute::Integer(value) => AttributeValue::I32(*value),
        };
        own.other.insert(text(name), value);
    }
}

/// The file of some channels.
fn file(
    size: (usize, usize),
    own: LayerAttributes,
    list: SmallVec<[AnyChannel<FlatSamples>; 4]>,
) -> Result<Vec<u8>, EncodeError> {
    let encoding =
        Encoding { compression: Compression::ZIP16, blocks: Blocks::ScanLines, line_order: LineOrder::Increasing };
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

/// The text of the attribute `name` in the (first) header of the EXR file that `bytes` are; `None` if it has no such
/// text. Only the header is read, and nothing is copied.
///
/// # Errors
/// [`EncodeError::Exr`] if they are no EXR file.
pub fn text_attribute<'a>(bytes: &'a [u8], name: &str) -> Result<Option<&'a str>, EncodeError> {
    let header = bytes.starts_with(&MAGIC).then(|| header(bytes)).flatten();
    let header =
        header.ok_or_else(|| EncodeError::Exr("no EXR file, or one whose header is cut or too long".into()))?;
    let found = header.into_iter().find(|entry| entry.name == name.as_bytes() && entry.kind == b"string");
    Ok(found.and_then(|entry| std::str::from_utf8(entry.value).ok()))
}

/// The first four bytes of an EXR file.
const MAGIC: [u8; 4] = [0x76, 0x2f, 0x31, 0x01];

/// Where the header begins: after magic and version.
const START: usize = 8;

/// The most attributes of a header: fifteen times what a picture of Airlight has.
const MAX_ATTRIBUTES: usize = 512;

/// An attribute as it stands in a file: name 0 type 0 length:i32 value.
struct Entry<'a> {
    whole: &'a [u8],
    name: &'a [u8],
    kind: &'a [u8],
    value: &'a [u8],
}

/// The attributes of the first header up to the empty name that ends it; `None` if the file ends before, or
/// after [`MAX_ATTRIBUTES`].
fn header(bytes: &[u8]) -> Option<Vec<Entry<'_>>> {
    let mut rest = bytes.get(START..)?;
    let mut entries = Vec::new();
    while *rest.first()? != 0 {
        if entries.len() == MAX_ATTRIBUTES {
            return None;
        }
        let (name, after) = text_until_zero(rest)?;
        let (kind, after) = text_until_zero(after)?;
        let (length, after) = after.split_first_chunk::<4>()?;
        let (value, after) = after.split_at_checked(usize::try_from(i32::from_le_bytes(*length)).ok()?)?;
        entries.push(Entry { whole: &rest[..rest.len() - after.len()], name, kind, value });
        rest = after;
    }
    Some(entries)
}

fn text_until_zero(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().position(|&b| b == 0)?;
    Some((&bytes[..end], &bytes[end + 1..]))
}

/// Bytes of a string attribute; OpenEXR takes UTF-8.
fn text(value: &str) -> Text {
    Text::from_slice_unchecked(value.as_bytes())
}

/// The file with the attributes of its header in alphabetical order. The library writes
/// them in the order of a hash map, another one each time; moving them leaves
/// every offset of the file as it was.
fn with_sorted_header(mut bytes: Vec<u8>) -> Option<Vec<u8>> {
    let mut attributes: Vec<&[u8]> = header(&bytes)?.into_iter().map(|entry| entry.whole).collect();
    attributes.sort();
    let sorted = attributes.concat();
    bytes[START..START + sorted.len()].copy_from_slice(&sorted);
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
        let (sun, observer, ozone) = test_data::light();
        let colour = Colour::new(&sun, &observer, &ozone, &wavelengths).expect("in range");
        let mut film = Film::new(3, 2, vec![2.0, 1.5], false);
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

    /// The layer of a file, and the last pixel of a channel.
    fn decoded(bytes: Vec<u8>) -> Layer<AnyChannels<FlatSamples>> {
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(std::io::Cursor::new(bytes))
            .expect("an EXR file");
        image.layer_data
    }

    fn last(layer: &Layer<AnyChannels<FlatSamples>>, name: &str) -> f32 {
        let channel = layer.channel_data.list.iter().find(|c| c.name.eq(name)).expect("there");
        channel.sample_data.values_as_f32().last().expect("pixels")
    }

    #[test]
    fn polarised_light_is_read_back() {
        let wavelengths = Wavelengths::new(vec![550.0]).expect("valid");
        let (sun, observer, ozone) = test_data::light();
        let colour = Colour::new(&sun, &observer, &ozone, &wavelengths).expect("in range");
        let mut film = Film::new(1, 1, vec![2.0], true);
        for u in [2.0, 4.0] {
            film.rows_mut()[0].add(0, &[10.0, -4.0, u], [1.0; 3]);
        }
        let encoded = |factor| {
            let disc = DiscLayer::from([(0, vec![factor])]);
            let picture = Picture { film: &film, disc: &disc, colour: &colour };
            decoded(encode(&picture, Some(wavelengths.nm()), &[]).expect("encodes"))
        };
        let layer = encoded(0.0);
        let names = ["S0.550,000nm", "S1.550,000nm", "S2.550,000nm", "S3.550,000nm", "error.S2.550,000nm"];
        assert_eq!(names.map(|name| last(&layer, name)), [20.0, -8.0, 6.0, 0.0, 2.0]);
        // Half of I; 2 angle = 180 - atan(3/4) degrees.
        let angle = 0.5 * (180.0 - 0.75_f32.atan().to_degrees());
        assert!((last(&layer, "DoLP") - 0.5).abs() < 1e-6 && (last(&layer, "AoLP") - angle).abs() < 1e-4);
        assert_eq!(layer.attributes.other[&text("polarisationHandedness")], AttributeValue::Text(text("right")));
        // The sun's disc is natural light.
        let layer = encoded(15.0);
        assert!((last(&layer, "DoLP") - 0.2).abs() < 1e-6 && last(&layer, "S1.550,000nm") == -8.0);
    }

    #[test]
    fn what_is_written_is_read_back() {
        let layer = decoded(encoded());
        let value = |name: &str| last(&layer, name);
        assert!(layer.channel_data.list.iter().all(|c| !c.name.eq("DoLP")), "of radiance alone there is none");
        assert_eq!(value("error.R"), 5.0);
        assert_eq!(value("S0.450,000nm"), 4.0 + 14.0);
        assert_eq!(value("error.S0.450,000nm"), 2.0);
        // The disc is beyond half precision and kept.
        assert_eq!(value("S0.550,250nm"), 6.0 + 1.05e7);
        assert_eq!(value("error.S0.550,250nm"), 0.0);
        assert!(value("G") > 1e4);
        let bytes = encoded();
        let attribute = |name| text_attribute(&bytes, name).expect("an EXR file");
        assert_eq!(attribute("airlight.scene"), Some("{\"latitude\":\"45°\"}"));
        assert_eq!(attribute("airlight.none"), None);
        for length in 0..bytes.len().min(300) {
            assert!(text_attribute(&bytes[..length], "airlight.scene").is_err(), "{length} bytes were taken");
        }
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
