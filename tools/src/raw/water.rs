//! Refractive index of liquid water: Hale and Querry, Applied Optics 12, 555 (1973).

use super::{Column, RawError, Row, Source};
use std::path::Path;

/// The file of `water-hale-1973/`.
#[derive(Debug, Clone, PartialEq)]
pub struct Water {
    /// Refractive index by wavelength, 200 to 4000 nm.
    pub refractive_index: Source<WaterIndex>,
}

impl Water {
    /// Reads the file below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self { refractive_index: Source::read(raw_dir, "water-hale-1973/refractive-index.csv")?.with_rows(64)? })
    }
}

/// Refractive index n + ik of water at one wavelength; k >= 0 absorbs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WaterIndex {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// Real part.
    pub n: f64,
    /// Imaginary part.
    pub k: f64,
}

impl Row for WaterIndex {
    type Record = (f64, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::number("wavelength_um", "um", 0.2, 4.0).key(),
            Column::number("n", "1", 1.1, 1.5),
            Column::number("k", "1", 0.0, 0.3),
        ]
    }

    fn from_record((wavelength_um, n, k): Self::Record) -> Self {
        Self { wavelength_nm: wavelength_um * 1e3, n, k }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn water_is_that_of_refractometers() {
        let raw = Path::new(env!("CARGO_MANIFEST_DIR")).join("../raw-data");
        let rows = Water::from_dir(&raw).expect("sound").refractive_index.rows;
        // Refractometers find 1.3325 for the sodium line, 589.3 nm, at 25 degrees; three decimals are given.
        let near = |nm: f64| rows.iter().find(|row| (row.wavelength_nm - nm).abs() < 1e-6).expect("a row").n;
        let (below, above) = (near(575.0), near(600.0));
        assert!(above <= 1.3325 + 5e-4 && 1.3325 - 5e-4 <= below, "{below}, {above}");
        // Dispersion is normal where water is clear.
        let clear = rows.iter().filter(|row| row.wavelength_nm <= 1000.0).map(|row| row.n).collect::<Vec<_>>();
        assert!(clear.windows(2).all(|pair| pair[1] <= pair[0]));
    }
}
