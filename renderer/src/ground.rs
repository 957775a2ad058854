//! The Earth's ground: NASA's Blue Marble as albedo.
//!
//! The picture (`raw-data/blue-marble/`) is a map of the Earth without clouds in even steps of longitude and latitude. Its red, green and blue
//! were made of the reflectances that MODIS measured about 645, 555 and 469 nm (its bands 1, 4 and 3; Stoeckli et al. 2005, The Blue Marble
//! Next Generation), so that is what they are taken for here, with the curve of sRGB undone: the albedo is linear between the three
//! wavelengths and constant beyond them. So it lies between 0 and 1 at every wavelength, and grey stays grey. It is a picture and no
//! measurement: contrast and the sea were worked on by hand, it has no seasons and no glint of the sun, and what albedo is above 645 nm,
//! where plants are bright, it does not know.

use crate::geometry::Place;
use glam::{DMat3, DVec3};
use std::sync::{Arc, LazyLock};

/// The name of this ground in scenes.
pub const EARTH: &str = "earth";

/// The map as it is in `raw-data/`, which the program is built with.
const MAP: &[u8] = include_bytes!("../../raw-data/blue-marble/earth.png");

/// Wavelengths in nm of the blue, the green and the red of the map: middles of bands 3, 4 and 1 of MODIS.
const BANDS_NM: [f64; 3] = [469.0, 555.0, 645.0];

/// Albedo over the Earth in three bands, bilinear between the middles of its pixels.
#[derive(Debug)]
pub struct Map {
    width: usize,
    height: usize,
    /// In blue, green and red, row by row from the north, from 180 degrees west.
    pixels: Vec<[f32; 3]>,
}

impl Map {
    /// The map that the program is built with.
    ///
    /// # Errors
    /// A sentence if it is no PNG of red, green and blue: the program was built with another.
    pub fn earth() -> Result<Arc<Self>, String> {
        static EARTH: LazyLock<Result<Arc<Map>, String>> =
            LazyLock::new(|| Map::decode(MAP).map(Arc::new).map_err(|error| format!("the map of the Earth: {error}")));
        EARTH.clone()
    }

    fn decode(bytes: &[u8]) -> Result<Self, String> {
        let mut reader = ::png::Decoder::new(std::io::Cursor::new(bytes)).read_info().map_err(|e| e.to_string())?;
        let size = reader.output_buffer_size().ok_or("too large")?;
        let mut buffer = vec![0; size];
        let info = reader.next_frame(&mut buffer).map_err(|e| e.to_string())?;
        if (info.color_type, info.bit_depth) != (::png::ColorType::Rgb, ::png::BitDepth::Eight) {
            return Err(format!("eight-bit RGB is expected, {:?} of {:?} is there", info.color_type, info.bit_depth));
        }
        let pixels = buffer.as_chunks::<3>().0.iter().map(|&[r, g, b]| [b, g, r].map(|code| linear(code) as f32));
        Ok(Self { width: info.width as usize, height: info.height as usize, pixels: pixels.collect() })
    }

    /// Albedo in blue, green and red at latitude and longitude in radians.
    #[must_use]
    pub fn at(&self, latitude: f64, longitude: f64) -> [f64; 3] {
        use std::f64::consts::{FRAC_PI_2, PI, TAU};
        let x = ((longitude + PI) / TAU).rem_euclid(1.0) * self.width as f64 - 0.5;
        let y = ((FRAC_PI_2 - latitude) / PI * self.height as f64 - 0.5).clamp(0.0, (self.height - 1) as f64);
        let (column, row) = (x.floor(), y.floor());
        let (right, down) = (x - column, y - row);
        // Round the Earth across; the last row is its own neighbour.
        let columns = [column, column + 1.0].map(|i| i.rem_euclid(self.width as f64) as usize % self.width);
        let rows = [row as usize, (row as usize + 1).min(self.height - 1)];
        let [a, b, c, d] =
            [(0, 0), (0, 1), (1, 0), (1, 1)].map(|(i, j)| self.pixels[rows[i] * self.width + columns[j]]);
        std::array::from_fn(|k| {
            let [a, b, c, d] = [a, b, c, d].map(|pixel| f64::from(pixel[k]));
            (1.0 - down) * ((1.0 - right) * a + right * b) + down * ((1.0 - right) * c + right * d)
        })
    }

    /// Mean over the sphere.
    #[must_use]
    pub fn mean(&self) -> [f64; 3] {
        let (mut sum, mut area) = ([0.0; 3], 0.0);
        for (y, row) in self.pixels.chunks_exact(self.width).enumerate() {
            let weight = (std::f64::consts::PI * (y as f64 + 0.5) / self.height as f64).sin();
            for pixel in row {
                (0..3).for_each(|k| sum[k] += weight * f64::from(pixel[k]));
                area += weight;
            }
        }
        sum.map(|sum| sum / area)
    }
}

/// Linear light of an eight-bit code (IEC 61966-2-1).
fn linear(code: u8) -> f64 {
    let x = f64::from(code) / 255.0;
    if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
}

/// Shares of the three bands in the albedo at a wavelength.
fn shares(wavelength_nm: f64) -> [f64; 3] {
    let [blue, green, red] = BANDS_NM;
    let between = |a: f64, b: f64| ((wavelength_nm - a) / (b - a)).clamp(0.0, 1.0);
    let (up, down) = (between(blue, green), between(green, red));
    [1.0 - up, up - down, down]
}

/// Albedo of the mean of the map at a wavelength in nm: that of the uniform ground that stands for it.
///
/// # Errors
/// As [`Map::earth`].
pub fn mean_albedo(wavelengths_nm: &[f64]) -> Result<Vec<f64>, String> {
    let mean = Map::earth()?.mean();
    Ok(wavelengths_nm.iter().map(|&nm| weighed(mean, shares(nm))).collect())
}

fn weighed(bands: [f64; 3], shares: [f64; 3]) -> f64 {
    bands.iter().zip(shares).map(|(band, share)| band * share).sum()
}

/// The map seen by an observer, at `L` wavelengths.
#[derive(Debug, Clone)]
pub struct Texture<const L: usize> {
    map: Arc<Map>,
    /// From the observer's frame (x east, y north, z up) to the Earth's (x to 0 N 0 E, y to 0 N 90 E, z to the north pole).
    to_earth: DMat3,
    shares: [[f64; 3]; L],
}

impl<const L: usize> Texture<L> {
    /// As seen from above latitude and longitude in degrees.
    ///
    /// # Errors
    /// As [`Map::earth`].
    pub fn earth(latitude_deg: f64, longitude_deg: f64, wavelengths_nm: &[f64; L]) -> Result<Self, String> {
        let ((sin_b, cos_b), (sin_l, cos_l)) =
            (latitude_deg.to_radians().sin_cos(), longitude_deg.to_radians().sin_cos());
        let east = DVec3::new(-sin_l, cos_l, 0.0);
        let north = DVec3::new(-sin_b * cos_l, -sin_b * sin_l, cos_b);
        let up = DVec3::new(cos_b * cos_l, cos_b * sin_l, sin_b);
        let shares = std::array::from_fn(|j| shares(wavelengths_nm[j]));
        Ok(Self { map: Map::earth()?, to_earth: DMat3::from_cols(east, north, up), shares })
    }

    /// Albedo of the ground at a place.
    #[must_use]
    pub fn albedo(&self, foot: Place) -> [f64; L] {
        let up = self.to_earth * foot.up;
        let bands = self.map.at(up.z.clamp(-1.0, 1.0).asin(), up.y.atan2(up.x));
        std::array::from_fn(|j| weighed(bands, self.shares[j]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Blue, green and red above a place in degrees.
    fn seen(latitude: f64, longitude: f64) -> [f64; 3] {
        Map::earth().expect("a map").at(latitude.to_radians(), longitude.to_radians())
    }

    #[test]
    fn lands_and_seas_are_where_they_are() {
        // The bounds are far from what the map has there: sand above 0.2, open sea below 0.03, snow above 0.5.
        let [blue, _, red] = seen(24.0, 12.0);
        assert!(red > 0.2 && red > 1.5 * blue, "the Sahara: {red} {blue}");
        for (latitude, longitude) in [(0.0, -140.0), (-30.0, 80.0), (40.0, -40.0), (0.0, 180.0)] {
            let [blue, _, red] = seen(latitude, longitude);
            assert!(red < 0.03 && blue > red, "the sea at {latitude} {longitude}: {red} {blue}");
        }
        assert!(seen(-80.0, 60.0)[0] > 0.5 && seen(73.0, -40.0)[0] > 0.5, "the ice");
        let [blue, green, _] = seen(-5.0, -62.0);
        assert!(green > blue && green < 0.2, "the Amazon");
        let [_, _, red] = seen(-25.0, 130.0);
        assert!(red > 0.1, "Australia");
    }

    #[test]
    fn an_observer_sees_what_is_below_and_around() {
        let texture = Texture::<3>::earth(24.0, 12.0, &BANDS_NM).expect("a map");
        let below = texture.albedo(Place::above(0.0));
        assert!(below.iter().zip(seen(24.0, 12.0)).all(|(a, b)| (a - b).abs() < 1e-6), "{below:?}");
        // Twenty degrees to the north and to the east of it.
        let (sin, cos) = 20.0_f64.to_radians().sin_cos();
        let at = |up: DVec3| texture.albedo(Place { altitude_m: 0.0, up });
        let north = at(DVec3::new(0.0, sin, cos));
        assert!(north.iter().zip(seen(44.0, 12.0)).all(|(a, b)| (a - b).abs() < 1e-6), "{north:?}");
        // Of a great circle: sin b = sin 24 cos 20, tan(l - 12) = tan 20 / cos 24.
        let (b, l) = ((24.0_f64.to_radians().sin() * cos).asin(), (sin / (cos * 24.0_f64.to_radians().cos())).atan());
        let expected = seen(b.to_degrees(), 12.0 + l.to_degrees());
        assert!(at(DVec3::new(sin, 0.0, cos)).iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-6));
    }

    #[test]
    fn albedo_is_linear_between_the_bands_and_grey_stays_grey() {
        for nm in [300.0, 469.0, 500.0, 555.0, 600.0, 645.0, 1000.0] {
            // Sums of shares that cancel but for rounding.
            assert!((weighed([0.3; 3], shares(nm)) - 0.3).abs() < 1e-15, "{nm}");
        }
        assert_eq!((shares(400.0), shares(512.0), shares(900.0)), ([1.0, 0.0, 0.0], [0.5, 0.5, 0.0], [0.0, 0.0, 1.0]));
        let mean = mean_albedo(&[469.0, 555.0, 645.0]).expect("a map");
        assert!(mean.iter().all(|albedo| (0.05..0.15).contains(albedo)), "{mean:?}");
    }
}
