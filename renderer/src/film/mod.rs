//! What is known of each pixel so far, and the files it is written to.
//!
//! The samples of a pixel come in blocks of one size, which are independent of each other; those of one block need not
//! be. So a film is filled with the means of blocks, and errors come from the spread of these.
//!
//! Every pixel keeps the mean and the spread of its blocks for each wavelength and,
//! apart from them, for R, G, B and Y: the wavelengths of one sample are
//! correlated, so the error of a colour cannot be had from the errors of wavelengths. A film of polarised light has Q and U
//! of each wavelength too.
//! The solar disc is no sample; it is laid over the picture when it is written.

mod develop;
pub mod exr;
pub mod png;
mod raw;
mod read;
pub mod tone;
pub(crate) mod white;

pub use develop::Development;
pub use raw::RawError;
pub use read::Channels;
pub use tone::Tone;
pub use white::{Adaptation, White};

use crate::polarisation::Stokes;
use crate::spectrum::{Colour, linear_srgb, luminance};
use std::collections::BTreeMap;

/// R, G, B and Y follow the wavelengths of a pixel.
const COLOURS: usize = 4;

/// Numbers of a pixel: of N wavelengths I, and Q and U if they are kept, then the colours.
fn channels(wavelengths: usize, stokes: bool) -> usize {
    wavelengths * if stokes { 3 } else { 1 } + COLOURS
}

/// Running statistics of a picture: arrays over pixel (row by row from the top), then
/// channel (I at N wavelengths, then Q and U if they are kept, then R, G, B, Y).
#[derive(Debug, Clone, PartialEq)]
pub struct Film {
    width: u32,
    height: u32,
    irradiance_w_m2_nm: Vec<f64>,
    /// Whether Q and U are kept.
    stokes: bool,
    counts: Vec<u32>,
    means: Vec<f64>,
    /// Sums of squared deviations from the mean.
    squares: Vec<f64>,
}

/// One row of a film; rows can be filled at the same time.
#[derive(Debug)]
pub struct Row<'a> {
    /// Index from the top.
    pub y: u32,
    channels: usize,
    counts: &'a mut [u32],
    means: &'a mut [f64],
    squares: &'a mut [f64],
}

/// A mean and its standard error, sqrt(sum (x - mean)^2 / (n (n - 1))) over n independent numbers (in a film: means of
/// blocks); the error of fewer than two is infinite.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Estimate {
    /// Mean of the numbers.
    pub mean: f64,
    /// Standard error of the mean.
    pub error: f64,
}

/// How well a picture is known, the solar disc left out. All are fractions, 0.01 is 1 %;
/// infinite before every pixel has two blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// sqrt(mean over pixels and wavelengths of the squared standard error of the spectral
    /// radiance) over the mean spectral radiance.
    pub relative: f64,
    /// Median over pixels of the relative standard error of the luminance.
    pub median_luminance: f64,
    /// Median over pixels and wavelengths of the relative standard error of the spectral radiance.
    pub median_spectral: f64,
}

impl Film {
    /// An empty film for N = `irradiance_w_m2_nm.len()` wavelengths; the numbers are the sun's spectral
    /// irradiance there (W m^-2 nm^-1), by which radiance factors become radiances. `stokes`: whether Q and U are kept too.
    #[must_use]
    pub fn new(width: u32, height: u32, irradiance_w_m2_nm: Vec<f64>, stokes: bool) -> Self {
        let pixels = width as usize * height as usize;
        let values = pixels * channels(irradiance_w_m2_nm.len(), stokes);
        Self {
            width,
            height,
            irradiance_w_m2_nm,
            stokes,
            counts: vec![0; pixels],
            means: vec![0.0; values],
            squares: vec![0.0; values],
        }
    }

    /// Bytes that a film of this size takes.
    #[must_use]
    pub fn bytes(width: u32, height: u32, wavelengths: usize, stokes: bool) -> u64 {
        u64::from(width) * u64::from(height) * (4 + 16 * channels(wavelengths, stokes) as u64)
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        (self.width, self.height)
    }

    /// Number of wavelengths N.
    #[must_use]
    pub fn wavelengths(&self) -> usize {
        self.irradiance_w_m2_nm.len()
    }

    /// Whether Q and U are kept.
    #[must_use]
    pub fn keeps_stokes(&self) -> bool {
        self.stokes
    }

    fn channels(&self) -> usize {
        channels(self.wavelengths(), self.stokes)
    }

    /// The rows from the top, to be filled in any order.
    #[must_use]
    pub fn rows_mut(&mut self) -> Vec<Row<'_>> {
        let (width, channels) = (self.width as usize, self.channels());
        let values = width * channels;
        let parts =
            self.counts.chunks_mut(width).zip(self.means.chunks_mut(values)).zip(self.squares.chunks_mut(values));
        (0..).zip(parts).map(|(y, ((counts, means), squares))| Row { y, channels, counts, means, squares }).collect()
    }

    /// Blocks that pixel `pixel` (row by row) has; none where the picture shows nothing.
    #[must_use]
    pub fn blocks(&self, pixel: usize) -> u32 {
        self.counts[pixel]
    }

    /// The largest number of blocks of a pixel.
    #[must_use]
    pub fn most_blocks(&self) -> u32 {
        self.counts.iter().copied().max().unwrap_or(0)
    }

    /// The smallest number of blocks of a pixel that has any.
    #[must_use]
    pub fn least_blocks(&self) -> u32 {
        self.counts.iter().copied().filter(|&n| n > 0).min().unwrap_or(0)
    }

    /// Adds the blocks of another film of the same size and wavelengths, all independent of those that are here.
    ///
    /// With d the difference of the means and n, m the numbers of blocks: mean += d m / (n + m);
    /// squares += other squares + d^2 n m / (n + m) (Chan, Golub & LeVeque 1983).
    ///
    /// # Errors
    /// [`OtherFilm`] if size, wavelengths or what is kept differ; then nothing is added.
    pub fn merge(&mut self, other: &Self) -> Result<(), OtherFilm> {
        let what = |film: &Self| (film.size(), film.stokes);
        let same = what(self) == what(other) && self.irradiance_w_m2_nm == other.irradiance_w_m2_nm;
        let sum = |(n, m): (&u32, &u32)| n.checked_add(*m);
        let counts: Option<Vec<u32>> = self.counts.iter().zip(&other.counts).map(sum).collect();
        let Some(counts) = counts.filter(|_| same) else { return Err(OtherFilm) };
        let channels = self.channels();
        for pixel in 0..self.counts.len() {
            let (n, m) = (f64::from(self.counts[pixel]), f64::from(other.counts[pixel]));
            if m == 0.0 {
                continue;
            }
            for index in pixel * channels..(pixel + 1) * channels {
                let difference = other.means[index] - self.means[index];
                self.means[index] += difference * (m / (n + m));
                self.squares[index] += other.squares[index] + difference * difference * (n * m / (n + m));
            }
        }
        self.counts = counts;
        Ok(())
    }

    fn estimate(&self, pixel: usize, channel: usize) -> Estimate {
        let n = f64::from(self.counts[pixel]);
        let index = pixel * self.channels() + channel;
        let error = if n > 1.0 { (self.squares[index] / (n * (n - 1.0))).sqrt() } else { f64::INFINITY };
        Estimate { mean: self.means[index], error }
    }

    /// Spectral radiance in W m^-2 sr^-1 nm^-1 of a pixel at wavelength `index`.
    #[must_use]
    pub fn radiance(&self, pixel: usize, index: usize) -> Estimate {
        self.spectral(pixel, 0, index)
    }

    /// Q and U in W m^-2 sr^-1 nm^-1 of a pixel at wavelength `index`; `None` of a film that does not keep them.
    #[must_use]
    pub fn polarised(&self, pixel: usize, index: usize) -> Option<[Estimate; 2]> {
        self.stokes.then(|| [1, 2].map(|parameter| self.spectral(pixel, parameter, index)))
    }

    /// Stokes parameter number `parameter` (I, Q, U) in W m^-2 sr^-1 nm^-1.
    fn spectral(&self, pixel: usize, parameter: usize, index: usize) -> Estimate {
        let Estimate { mean, error } = self.estimate(pixel, parameter * self.wavelengths() + index);
        let irradiance = self.irradiance_w_m2_nm[index];
        Estimate { mean: mean * irradiance, error: error * irradiance }
    }

    /// The mean radiance factors in sr^-1 of Stokes parameter number `parameter` (I, Q, U).
    fn factors(&self, pixel: usize, parameter: usize) -> &[f64] {
        let first = pixel * self.channels() + parameter * self.wavelengths();
        &self.means[first..first + self.wavelengths()]
    }

    /// Linear sRGB of a pixel; white at 1 cd/m^2 is (1, 1, 1).
    #[must_use]
    pub fn rgb(&self, pixel: usize) -> [Estimate; 3] {
        let first = self.channels() - COLOURS;
        [first, first + 1, first + 2].map(|channel| self.estimate(pixel, channel))
    }

    /// Luminance of a pixel in cd/m^2.
    #[must_use]
    pub fn luminance(&self, pixel: usize) -> Estimate {
        self.estimate(pixel, self.channels() - 1)
    }

    /// Number of pixels.
    #[must_use]
    pub fn pixels(&self) -> usize {
        self.counts.len()
    }

    /// Luminance of each pixel in cd/m^2.
    pub fn luminances(&self) -> impl Iterator<Item = f64> {
        (0..self.pixels()).map(|pixel| self.luminance(pixel).mean)
    }

    /// How well the picture is known. Pixels outside the picture do not count, and neither
    /// do black ones in the medians.
    #[must_use]
    pub fn errors(&self) -> Errors {
        let (mut radiance, mut squared) = (0.0, 0.0);
        let (mut count, mut of_luminance, mut of_radiance) = (0.0, Vec::new(), Vec::new());
        for pixel in (0..self.counts.len()).filter(|&pixel| self.counts[pixel] > 0) {
            for index in 0..self.wavelengths() {
                let Estimate { mean, error } = self.radiance(pixel, index);
                radiance += mean;
                squared += error * error;
                count += 1.0;
                of_radiance.push(error / mean);
            }
            let Estimate { mean, error } = self.luminance(pixel);
            of_luminance.push(error / mean);
        }
        Errors {
            // Nothing seen yet says nothing of the error.
            relative: if radiance == 0.0 { f64::INFINITY } else { (squared / count).sqrt() / (radiance / count) },
            median_luminance: median(of_luminance),
            median_spectral: median(of_radiance),
        }
    }
}

/// Median of the numbers that are numbers; NaN if there are none.
fn median(mut values: Vec<f64>) -> f64 {
    values.retain(|v| !v.is_nan());
    if values.is_empty() {
        return f64::NAN;
    }
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}

impl Row<'_> {
    /// Adds one block to pixel `x`: mean radiance factors in sr^-1 at the wavelengths (I, then Q and U if they are kept)
    /// and their linear sRGB.
    ///
    /// Welford's update: d = x - mean; mean += d / n; squares += d (x - mean).
    pub fn add(&mut self, x: u32, factors: &[f64], rgb: [f64; 3]) {
        let x = x as usize;
        self.counts[x] += 1;
        let weight = 1.0 / f64::from(self.counts[x]);
        let own = x * self.channels..(x + 1) * self.channels;
        let [r, g, b] = rgb;
        let block = factors.iter().copied().chain([r, g, b, luminance(rgb)]);
        for ((mean, squares), value) in self.means[own.clone()].iter_mut().zip(&mut self.squares[own]).zip(block) {
            let deviation = value - *mean;
            *mean += deviation * weight;
            *squares += deviation * (value - *mean);
        }
    }

    /// Blocks that pixel `x` has.
    #[must_use]
    pub fn blocks(&self, x: u32) -> u32 {
        self.counts[x as usize]
    }

    /// Pixels in the row.
    #[must_use]
    pub fn width(&self) -> u32 {
        // A film's width is a u32.
        self.counts.len() as u32
    }
}

/// Two films that are not of the same picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("the films differ in size, wavelengths or what they keep, or have too many blocks together")]
pub struct OtherFilm;

/// The sun's own image: by pixel, the radiance factors in sr^-1 that its disc adds.
pub type DiscLayer = BTreeMap<usize, Vec<f64>>;

/// A film with the solar disc on it.
#[derive(Debug, Clone, Copy)]
pub struct Picture<'a> {
    /// The sky and the ground.
    pub film: &'a Film,
    /// The sun; empty if it is not to be seen.
    pub disc: &'a DiscLayer,
    /// What colour the disc's radiance factors have.
    pub colour: &'a Colour,
}

impl Picture<'_> {
    /// Linear sRGB of a pixel in cd/m^2, the disc included.
    #[must_use]
    pub fn rgb(&self, pixel: usize) -> [f64; 3] {
        let sky = self.film.rgb(pixel).map(|estimate| estimate.mean);
        let Some(factors) = self.disc.get(&pixel) else { return sky };
        let sun = linear_srgb(self.colour.xyz(factors));
        [sky[0] + sun[0], sky[1] + sun[1], sky[2] + sun[2]]
    }

    /// Linear sRGB of all pixels in cd/m^2, row by row, the disc included.
    pub fn rgbs(&self) -> impl Iterator<Item = [f64; 3]> {
        (0..self.film.pixels()).map(|pixel| self.rgb(pixel))
    }

    /// Spectral radiance in W m^-2 sr^-1 nm^-1 of a pixel at wavelength `index`, the disc included.
    #[must_use]
    pub fn radiance(&self, pixel: usize, index: usize) -> f64 {
        let sun = self.disc.get(&pixel).map_or(0.0, |factors| factors[index]);
        self.film.radiance(pixel, index).mean + sun * self.film.irradiance_w_m2_nm[index]
    }

    /// Stokes parameters of a pixel in luminance (cd/m^2), the disc, whose light is natural, included; `None` of a film that
    /// keeps none. Each is its spectrum weighed as the eye weighs light.
    #[must_use]
    pub fn stokes(&self, pixel: usize) -> Option<Stokes> {
        let weighed = |factors: &[f64]| self.colour.xyz(factors)[1];
        let [i, q, u] = self.film.stokes.then(|| [0, 1, 2].map(|k| weighed(self.film.factors(pixel, k))))?;
        let sun = self.disc.get(&pixel).map_or(0.0, |factors| weighed(factors));
        Some(Stokes { i: i + sun, q, u })
    }
}

/// Why a picture cannot be encoded, or read.
#[derive(Debug, thiserror::Error)]
pub enum EncodeError {
    /// The EXR library refused.
    #[error("EXR: {0}")]
    Exr(String),
    /// The PNG library refused.
    #[error("PNG: {0}")]
    Png(#[from] ::png::EncodingError),
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film_of(samples: &[[f64; 2]]) -> Film {
        let mut film = Film::new(2, 1, vec![2.0, 3.0], false);
        let mut rows = film.rows_mut();
        for s in samples {
            rows[0].add(1, s, [s[0], s[1], 0.0]);
        }
        film
    }

    #[test]
    fn mean_and_standard_error_are_those_of_the_samples() {
        // Samples 1, 2, 6: mean 3, squared deviations 4 + 1 + 9 = 14, error sqrt(14 / 6).
        // The offset of 1e8 would cost a plain sum of squares all of its digits.
        for offset in [0.0, 1e8] {
            let film = film_of(&[[offset + 1.0, 5.0], [offset + 2.0, 5.0], [offset + 6.0, 5.0]]);
            let red = film.rgb(1)[0];
            assert!((red.mean - offset - 3.0).abs() < 1e-7 && (red.error - (14.0_f64 / 6.0).sqrt()).abs() < 1e-7);
            let radiance = film.radiance(1, 0);
            assert!((radiance.mean - 2.0 * red.mean).abs() < 1e-6 && (radiance.error - 2.0 * red.error).abs() < 1e-6);
            assert_eq!(film.radiance(1, 1), Estimate { mean: 15.0, error: 0.0 });
        }
    }

    #[test]
    fn films_merge_to_the_film_of_all_their_blocks() {
        // Cancellation would show with the offset; the tolerance is some roundings of it.
        let blocks: Vec<[f64; 2]> = (0..9).map(|i| [1e3 + f64::from(i * i % 7), f64::from(i)]).collect();
        let whole = film_of(&blocks);
        for cut in 0..=blocks.len() {
            let mut film = film_of(&blocks[..cut]);
            film.merge(&film_of(&blocks[cut..])).expect("the same size");
            assert_eq!(film.blocks(1), 9);
            for index in 0..2 {
                let (got, expected) = (film.radiance(1, index), whole.radiance(1, index));
                assert!(
                    (got.mean / expected.mean - 1.0).abs() < 1e-12 && (got.error / expected.error - 1.0).abs() < 1e-12
                );
            }
        }
        assert_eq!(whole.clone().merge(&Film::new(2, 1, vec![2.0, 3.5], false)), Err(OtherFilm));
        assert_eq!(whole.clone().merge(&Film::new(1, 2, vec![2.0, 3.0], false)), Err(OtherFilm));
        assert_eq!(whole.clone().merge(&Film::new(2, 1, vec![2.0, 3.0], true)), Err(OtherFilm));
    }

    #[test]
    fn the_error_of_luminance_heeds_that_channels_vary_together() {
        // Green falls as red rises, so that Y = 0.2126 R + 0.7152 G stays constant.
        let green = |red: f64| (1.0 - 0.212_639_005_9 * red) / 0.715_168_678_8;
        let film = film_of(&[1.0, 2.0, 4.0].map(|red| [red, green(red)]));
        let y = film.luminance(1);
        assert!((y.mean - 1.0).abs() < 1e-12 && y.error < 1e-12 && film.rgb(1)[1].error > 0.1);
    }

    #[test]
    fn the_error_of_a_picture_is_rms_error_over_mean() {
        let film = film_of(&[[1.0, 1.0], [3.0, 1.0]]);
        // Radiances 2 * 2 = 4 with error 2 * 1, and 3 with error 0; pixel 0 has no samples.
        let errors = film.errors();
        assert!((errors.relative - 2.0_f64.sqrt() / 3.5).abs() < 1e-12, "{errors:?}");
        assert!((errors.median_spectral - 0.5).abs() < 1e-12 && film.most_blocks() == 2);
        assert!(film_of(&[[1.0, 1.0]]).errors().relative.is_infinite());
    }
}
