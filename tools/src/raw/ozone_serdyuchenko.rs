//! Ozone absorption cross-section at 11 temperatures: Serdyuchenko et al., Atmos. Meas.
//! Tech. 7, 625 (2014).

use super::{Column, RawError, Row, Source};
use std::path::Path;

/// Number of temperatures.
pub const TEMPERATURES: usize = 11;

/// The temperatures, K.
pub const TEMPERATURES_K: [f64; TEMPERATURES] =
    [193.0, 203.0, 213.0, 223.0, 233.0, 243.0, 253.0, 263.0, 273.0, 283.0, 293.0];

/// The file of `ozone-serdyuchenko-2014/`.
#[derive(Debug, Clone, PartialEq)]
pub struct OzoneSerdyuchenko {
    /// Cross-sections from 214 to 1099 nm by 1 nm.
    pub cross_sections: Source<CrossSections>,
}

impl OzoneSerdyuchenko {
    /// Reads the file below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self { cross_sections: Source::read(raw_dir, "ozone-serdyuchenko-2014/cross-section.csv")? })
    }
}

/// Cross-sections at one wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossSections {
    /// Wavelength in vacuum, nm.
    pub wavelength_nm: f64,
    /// Absorption cross-section at each of [`TEMPERATURES_K`], m^2; the noise of the
    /// measurement makes some of the weakest negative.
    pub cross_sections: [f64; TEMPERATURES],
}

impl Row for CrossSections {
    type Record = (f64, [f64; TEMPERATURES]);

    fn columns() -> Vec<Column> {
        let wavelength = Column::number("wavelength_nm", "nm", 200.0, 1100.0).key();
        let cells = TEMPERATURES_K
            .iter()
            .map(|temperature| Column::number(&format!("cross_section_m2_{temperature}k"), "m^2", -1e-26, 2e-21));
        std::iter::once(wavelength).chain(cells).collect()
    }

    fn from_record((wavelength_nm, cross_sections): Self::Record) -> Self {
        Self { wavelength_nm, cross_sections }
    }
}
