//! Spectral albedo of soils (PROSAIL) and of a flat sea under diffuse light (Fresnel).

use super::{Column, RawError, Row, Source};
use std::path::Path;

/// The file of `ground-albedo/`.
#[derive(Debug, Clone, PartialEq)]
pub struct GroundAlbedo {
    /// Spectra from 300 to 1000 nm by 5 nm.
    pub spectra: Source<Albedo>,
}

impl GroundAlbedo {
    /// Reads the file below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self { spectra: Source::read(raw_dir, "ground-albedo/spectra.csv")? })
    }
}

/// Albedo at one wavelength, each 0 to 1; none where there are no data.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Albedo {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// Dry soil; from 400 nm.
    pub dry_soil: Option<f64>,
    /// Wet soil; from 400 nm.
    pub wet_soil: Option<f64>,
    /// Surface of a flat sea under diffuse light, without light from under water.
    pub ocean: f64,
}

impl Row for Albedo {
    type Record = (f64, Option<f64>, Option<f64>, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::number("wavelength_nm", "nm", 300.0, 1000.0).key(),
            Column::optional("reflectance_prosail_dry_soil", "1", 0.0, 1.0),
            Column::optional("reflectance_prosail_wet_soil", "1", 0.0, 1.0),
            Column::number("reflectance_ocean_fresnel_diffuse", "1", 0.0, 1.0),
        ]
    }

    fn from_record((wavelength_nm, dry_soil, wet_soil, ocean): Self::Record) -> Self {
        Self { wavelength_nm, dry_soil, wet_soil, ocean }
    }
}
