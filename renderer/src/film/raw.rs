//! A film as bytes, so that work can go on later or elsewhere: little-endian, the sun's irradiances (f64), the counts of
//! the pixels (u32), then means and sums of squares of all channels (f64).

use super::{Film, channels};

/// Why bytes are no film.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum RawError {
    /// Another number of bytes than the size of the picture needs.
    #[error("{found} bytes of samples where the picture has {expected}")]
    Length {
        /// Bytes that are needed.
        expected: u64,
        /// Bytes that are there.
        found: u64,
    },
    /// A number that no sample can have made.
    #[error("a mean or a spread that is infinite, negative or no number")]
    Impossible,
}

impl Film {
    /// Appends the film to `bytes`.
    pub fn write(&self, bytes: &mut Vec<u8>) {
        bytes.reserve(self.irradiance_w_m2_nm.len() * 8 + self.counts.len() * 4 + self.means.len() * 16);
        bytes.extend(self.irradiance_w_m2_nm.iter().flat_map(|v| v.to_le_bytes()));
        bytes.extend(self.counts.iter().flat_map(|v| v.to_le_bytes()));
        bytes.extend(self.means.iter().chain(&self.squares).flat_map(|v| v.to_le_bytes()));
    }

    /// The film of that size and number of wavelengths, with Q and U if `stokes`, that `bytes` are. No more memory is taken than they have.
    ///
    /// # Errors
    /// [`RawError`] if it is not a film of this size, or holds what no film can.
    pub fn read(width: u32, height: u32, wavelengths: usize, stokes: bool, bytes: &[u8]) -> Result<Self, RawError> {
        let expected = Self::bytes(width, height, wavelengths, stokes).saturating_add(8 * wavelengths as u64);
        let found = bytes.len() as u64;
        if found != expected {
            return Err(RawError::Length { expected, found });
        }
        // All lengths below are now parts of that of `bytes`.
        let pixels = width as usize * height as usize;
        let (irradiance, rest) = bytes.split_at(8 * wavelengths);
        let (counts, values) = rest.split_at(4 * pixels);
        let (means, squares) = values.split_at(8 * pixels * channels(wavelengths, stokes));
        let film = Self {
            width,
            height,
            irradiance_w_m2_nm: numbers(irradiance),
            stokes,
            counts: counts.as_chunks::<4>().0.iter().map(|b| u32::from_le_bytes(*b)).collect(),
            means: numbers(means),
            squares: numbers(squares),
        };
        let finite = |values: &[f64]| values.iter().all(|v| v.is_finite());
        let positive = |values: &[f64]| values.iter().all(|v| *v >= 0.0);
        let possible = finite(&film.irradiance_w_m2_nm) && finite(&film.means) && finite(&film.squares);
        if possible && positive(&film.irradiance_w_m2_nm) && positive(&film.squares) {
            Ok(film)
        } else {
            Err(RawError::Impossible)
        }
    }
}

fn numbers(bytes: &[u8]) -> Vec<f64> {
    bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_film_reads_back_bit_by_bit_and_damage_is_refused() {
        let mut film = Film::new(2, 1, vec![1.5, 0.5], false);
        for values in [[1.0, 0.1], [2.0, 0.3]] {
            film.rows_mut()[0].add(1, &values, [values[0], -0.25, values[1]]);
        }
        let mut bytes = Vec::new();
        film.write(&mut bytes);
        assert_eq!(Film::read(2, 1, 2, false, &bytes).as_ref(), Ok(&film));
        let (found, expected) = (bytes.len() as u64, bytes.len() as u64 + 4 + 6 * 16);
        assert_eq!(Film::read(3, 1, 2, false, &bytes), Err(RawError::Length { expected, found }));
        // The last number is a sum of squares.
        let last = bytes.len() - 8;
        for wrong in [-1.0, f64::NAN, f64::INFINITY] {
            bytes[last..].copy_from_slice(&f64::to_le_bytes(wrong));
            assert_eq!(Film::read(2, 1, 2, false, &bytes), Err(RawError::Impossible));
        }
    }
}
