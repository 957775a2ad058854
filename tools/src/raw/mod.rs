//! Measured inputs: one reader per source in `raw-data/`, all through [`Source`].
//!
//! Units are converted here and nowhere else: what leaves this module is in SI, but for
//! wavelengths, which are in nm and say so in their names.

mod error;
mod source;

pub mod aerosol_gavin;
pub mod aerosol_jaenicke;
pub mod aerosol_opac;
pub mod bucholtz;
pub mod cie_1931;
pub mod ground_albedo;
pub mod mie_peers;
pub mod ozone_arosa;
pub mod ozone_mcpeters_labow;
pub mod ozone_serdyuchenko;
pub mod ozone_thesis;
pub mod sun;
pub mod us_standard_atmosphere;
pub mod water;

pub use error::{Fault, RawError};
pub(crate) use source::Header;
pub use source::{Column, Row, Source, sha256};

use std::path::Path;

/// Every source of `raw-data/`.
#[derive(Debug, Clone, PartialEq)]
pub struct RawData {
    /// US Standard Atmosphere 1976.
    pub atmosphere: us_standard_atmosphere::UsStandardAtmosphere,
    /// Rayleigh scattering of air.
    pub bucholtz: bucholtz::Bucholtz,
    /// Ozone column and layers at Arosa.
    pub ozone_arosa: ozone_arosa::OzoneArosa,
    /// Ozone climatology by month and latitude.
    pub ozone_mcpeters_labow: ozone_mcpeters_labow::OzoneMcPetersLabow,
    /// Ozone absorption cross-section by temperature.
    pub ozone_serdyuchenko: ozone_serdyuchenko::OzoneSerdyuchenko,
    /// Solar spectrum and limb darkening.
    pub sun: sun::Sun,
    /// Colour-matching functions.
    pub cie_1931: cie_1931::Cie1931,
    /// Spectral albedo of grounds.
    pub ground_albedo: ground_albedo::GroundAlbedo,
    /// Aerosol components and types.
    pub aerosol_opac: aerosol_opac::AerosolOpac,
    /// Aerosol size distributions of the thesis.
    pub aerosol_jaenicke: aerosol_jaenicke::AerosolJaenicke,
    /// Aerosols of the thesis, to compare with.
    pub aerosol_gavin: aerosol_gavin::AerosolGavin,
}

impl RawData {
    /// Reads every source below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`] of the first source that cannot be taken.
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self {
            atmosphere: us_standard_atmosphere::UsStandardAtmosphere::from_dir(raw_dir)?,
            bucholtz: bucholtz::Bucholtz::from_dir(raw_dir)?,
            ozone_arosa: ozone_arosa::OzoneArosa::from_dir(raw_dir)?,
            ozone_mcpeters_labow: ozone_mcpeters_labow::OzoneMcPetersLabow::from_dir(raw_dir)?,
            ozone_serdyuchenko: ozone_serdyuchenko::OzoneSerdyuchenko::from_dir(raw_dir)?,
            sun: sun::Sun::from_dir(raw_dir)?,
            cie_1931: cie_1931::Cie1931::from_dir(raw_dir)?,
            ground_albedo: ground_albedo::GroundAlbedo::from_dir(raw_dir)?,
            aerosol_opac: aerosol_opac::AerosolOpac::from_dir(raw_dir)?,
            aerosol_jaenicke: aerosol_jaenicke::AerosolJaenicke::from_dir(raw_dir)?,
            aerosol_gavin: aerosol_gavin::AerosolGavin::from_dir(raw_dir)?,
        })
    }
}
