//! Tri-modal size distributions of Jaenicke, Tropospheric aerosols (1993).

use super::{Column, RawError, Row, Source};
use std::path::Path;

/// The file of `aerosol-jaenicke-1993/`.
#[derive(Debug, Clone, PartialEq)]
pub struct AerosolJaenicke {
    /// Three modes of each type.
    pub modes: Source<Mode>,
}

impl AerosolJaenicke {
    /// Reads the file below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self { modes: Source::read(raw_dir, "aerosol-jaenicke-1993/modes.csv")? })
    }
}

/// One log-normal mode of a type.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// Name of the type, such as `urban`.
    pub aerosol_type: String,
    /// 1, 2 or 3.
    pub mode: u8,
    /// Number density, m^-3.
    pub number_density: f64,
    /// Median radius of the number distribution, m.
    pub median_radius: f64,
    /// Standard deviation of log10 of the radius, 1.
    pub log10_sigma: f64,
}

impl Row for Mode {
    type Record = (String, u8, f64, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::text("aerosol_type").key(),
            Column::number("mode", "1", 1.0, 3.0).key(),
            Column::number("number_density_cm-3", "cm^-3", 1e-5, 1e6),
            Column::number("median_radius_um", "um", 1e-4, 100.0),
            Column::number("log10_sigma", "1", 0.01, 1.0),
        ]
    }

    fn from_record((aerosol_type, mode, per_cm3, radius_um, log10_sigma): Self::Record) -> Self {
        Self { aerosol_type, mode, number_density: per_cm3 * 1e6, median_radius: radius_um * 1e-6, log10_sigma }
    }
}
