//! Sparse ozone cross-sections that earlier code interpolated between, to compare with: no table
//! is made from them.

use super::{Column, RawError, Row, Source};
use std::path::Path;

/// The file of `ozone-thesis/`.
#[derive(Debug, Clone, PartialEq)]
pub struct OzoneThesis {
    /// Points by wavelength.
    pub cross_sections: Source<CrossSection>,
}

impl OzoneThesis {
    /// Reads the file below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self { cross_sections: Source::read(raw_dir, "ozone-thesis/cross-section.csv")?.with_rows(32)? })
    }
}

/// One point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossSection {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// Absorption cross-section of a molecule of ozone, m^2.
    pub cross_section: f64,
}

impl Row for CrossSection {
    type Record = (f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::number("wavelength_nm", "nm", 200.0, 1100.0).key(),
            Column::number("cross_section_cm2", "cm^2", 1e-25, 1e-16),
        ]
    }

    fn from_record((wavelength_nm, cross_section_cm2): Self::Record) -> Self {
        Self { wavelength_nm, cross_section: cross_section_cm2 * 1e-4 }
    }
}
