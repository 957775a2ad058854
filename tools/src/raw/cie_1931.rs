//! CIE 1931 colour-matching functions of the 2 degree standard observer (ISO/CIE 11664-1).

use super::{Column, RawError, Row, Source};
use std::path::Path;

/// The file of `cie-1931/`.
#[derive(Debug, Clone, PartialEq)]
pub struct Cie1931 {
    /// The functions from 360 to 830 nm by 1 nm.
    pub colour_matching: Source<ColourMatching>,
}

impl Cie1931 {
    /// Reads the file below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self { colour_matching: Source::read(raw_dir, "cie-1931/colour-matching.csv")?.with_rows(471)? })
    }
}

/// The three functions at one wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColourMatching {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// x-bar, y-bar and z-bar, 1.
    pub xyz: [f64; 3],
}

impl Row for ColourMatching {
    type Record = (f64, [f64; 3]);

    fn columns() -> Vec<Column> {
        vec![
            Column::number("wavelength_nm", "nm", 360.0, 830.0).key(),
            Column::number("x_bar", "1", 0.0, 2.0),
            Column::number("y_bar", "1", 0.0, 2.0),
            Column::number("z_bar", "1", 0.0, 2.0),
        ]
    }

    fn from_record((wavelength_nm, xyz): Self::Record) -> Self {
        Self { wavelength_nm, xyz }
    }
}
