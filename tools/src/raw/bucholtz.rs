//! Rayleigh scattering of air: tables 1 to 3 of Bucholtz, Applied Optics 34, 2765 (1995).

use super::{Column, RawError, Row, Source};
use serde::Deserialize;
use std::path::Path;

/// The files of `bucholtz-1995/`.
#[derive(Debug, Clone, PartialEq)]
pub struct Bucholtz {
    /// Table 1, which is data here.
    pub king_factor: Source<KingFactor>,
    /// Table 2, to compare with.
    pub cross_section: Source<CrossSection>,
    /// Table 3, to compare with.
    pub fit: Source<Fit>,
}

impl Bucholtz {
    /// Reads the files below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self {
            king_factor: Source::read(raw_dir, "bucholtz-1995/king-factor.csv")?,
            cross_section: Source::read(raw_dir, "bucholtz-1995/cross-section.csv")?,
            fit: Source::read(raw_dir, "bucholtz-1995/fit.csv")?,
        })
    }
}

/// A row of table 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KingFactor {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// King factor F, 1.
    pub king_factor: f64,
    /// Depolarisation factor for natural light rho, 1.
    pub depolarisation: f64,
    /// gamma = rho / (2 - rho), 1.
    pub gamma: f64,
}

impl Row for KingFactor {
    type Record = (f64, f64, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::number("wavelength_nm", "nm", 200.0, 4000.0).key(),
            Column::number("king_factor", "1", 1.0, 1.2),
            Column::number("depolarization_factor", "1", 0.0, 0.1),
            Column::number("gamma", "1", 0.0, 0.1),
        ]
    }

    fn from_record((wavelength_nm, king_factor, depolarisation, gamma): Self::Record) -> Self {
        Self { wavelength_nm, king_factor, depolarisation, gamma }
    }
}

/// A row of table 2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CrossSection {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// Scattering cross-section of a molecule of air, m^2.
    pub cross_section: f64,
    /// Scattering coefficient of air at 288.15 K and 1013.25 hPa, m^-1.
    pub scattering_coefficient: f64,
}

impl Row for CrossSection {
    type Record = (f64, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::number("wavelength_nm", "nm", 200.0, 4000.0).key(),
            Column::number("cross_section_m2", "m^2", 1e-34, 1e-28),
            Column::number("volume_scattering_coefficient_km-1", "km^-1", 1e-6, 1.0),
        ]
    }

    fn from_record((wavelength_nm, cross_section, per_km): Self::Record) -> Self {
        Self { wavelength_nm, cross_section, scattering_coefficient: per_km / tables::units::KM }
    }
}

/// What a row of table 3 fits, and the unit of its factor a.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Scattering cross-section of a molecule.
    CrossSection,
    /// Scattering coefficient of air at 288.15 K and 1013.25 hPa.
    VolumeScatteringCoefficient,
    /// Optical depth of the US Standard Atmosphere.
    OpticalDepthUs76,
}

/// The unit column of table 3; any other unit is a malformed row.
#[derive(Debug, Clone, Copy, Deserialize)]
pub enum FitUnit {
    /// Square centimetre.
    #[serde(rename = "cm^2")]
    SquareCentimetre,
    /// Per kilometre.
    #[serde(rename = "km^-1")]
    PerKilometre,
    /// No unit.
    #[serde(rename = "1")]
    One,
}

/// A row of table 3: `value = a x^-(b + c x + d / x)`, x the wavelength in um.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// What is fitted.
    pub quantity: Quantity,
    /// Shortest wavelength of the fit, nm.
    pub wavelength_min_nm: f64,
    /// Longest wavelength of the fit, nm.
    pub wavelength_max_nm: f64,
    /// Factor a, in m^2, m^-1 or 1 according to the quantity.
    pub a: f64,
    /// Exponent b, 1.
    pub b: f64,
    /// Exponent c, um^-1.
    pub c: f64,
    /// Exponent d, um.
    pub d: f64,
}

impl Row for Fit {
    type Record = (Quantity, FitUnit, f64, f64, f64, f64, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::text("quantity").key(),
            Column::text("unit"),
            Column::number("wavelength_min_um", "um", 0.2, 4.0).key(),
            Column::number("wavelength_max_um", "um", 0.2, 4.0),
            Column::number("a", "see the column unit", 1e-30, 1.0),
            Column::number("b", "1", 3.0, 5.0),
            Column::number("c", "um^-1", 0.0, 2.0),
            Column::number("d", "um", 0.0, 1.0),
        ]
    }

    fn from_record((quantity, unit, min_um, max_um, a, b, c, d): Self::Record) -> Self {
        let a = match unit {
            FitUnit::SquareCentimetre => a * 1e-4,
            FitUnit::PerKilometre => a * 1e-3,
            FitUnit::One => a,
        };
        Self { quantity, wavelength_min_nm: min_um * 1e3, wavelength_max_nm: max_um * 1e3, a, b, c, d }
    }
}
