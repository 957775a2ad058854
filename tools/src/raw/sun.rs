//! The Sun at 1 au: spectrum (ASTM E490-00a and G173-03) and limb darkening (Neckel and
//! Labs, Solar Physics 153, 91, 1994).

use super::{Column, RawError, Row, Source};
use std::path::Path;

/// Number of coefficients of the limb darkening.
pub const COEFFICIENTS: usize = 6;

/// The files of `sun/`.
#[derive(Debug, Clone, PartialEq)]
pub struct Sun {
    /// Spectrum from 200 to 4000 nm.
    pub spectrum: Source<Irradiance>,
    /// Limb darkening from 303 to 1099 nm.
    pub limb_darkening: Source<LimbDarkening>,
}

impl Sun {
    /// Reads the files below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self {
            spectrum: Source::read(raw_dir, "sun/spectrum.csv")?,
            limb_darkening: Source::read(raw_dir, "sun/limb-darkening.csv")?,
        })
    }
}

/// One point of the spectrum.
#[derive(Debug, Clone, PartialEq)]
pub struct Irradiance {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// Spectral irradiance, W m^-2 nm^-1.
    pub irradiance: f64,
    /// Standard that the value is from.
    pub standard: String,
}

impl Row for Irradiance {
    type Record = (f64, f64, String);

    fn columns() -> Vec<Column> {
        vec![
            Column::number("wavelength_nm", "nm", 100.0, 10_000.0).key(),
            Column::number("irradiance_w_m2_nm", "W m^-2 nm^-1", 0.0, 3.0),
            Column::text("source"),
        ]
    }

    fn from_record((wavelength_nm, irradiance, standard): Self::Record) -> Self {
        Self { wavelength_nm, irradiance, standard }
    }
}

/// Limb darkening at one wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LimbDarkening {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// a_0 to a_5 of I(mu) / I(1) = sum a_i mu^i, mu the cosine of the heliocentric angle, 1.
    pub coefficients: [f64; COEFFICIENTS],
    /// Mean intensity of the disc over that of its centre as printed, 1.
    pub disc_mean: f64,
}

impl LimbDarkening {
    /// I(mu) / I(1) = sum a_i mu^i.
    #[must_use]
    pub fn relative_intensity(&self, mu: f64) -> f64 {
        self.coefficients.iter().rev().fold(0.0, |sum, a| sum * mu + a)
    }

    /// Mean over the disc of I(mu) / I(1): 2 int_0^1 mu I(mu) dmu = sum 2 a_i / (i + 2).
    #[must_use]
    pub fn computed_disc_mean(&self) -> f64 {
        self.coefficients.iter().zip(2_u8..).map(|(a, n)| 2.0 * a / f64::from(n)).sum()
    }
}

impl Row for LimbDarkening {
    type Record = (f64, [f64; COEFFICIENTS], f64);

    fn columns() -> Vec<Column> {
        let mut columns = vec![Column::number("wavelength_nm", "nm", 300.0, 1100.0).key()];
        columns.extend((0..COEFFICIENTS).map(|i| Column::number(&format!("a{i}"), "1", -10.0, 10.0)));
        columns.push(Column::number("disc_mean_over_centre", "1", 0.5, 1.0));
        columns
    }

    fn from_record((wavelength_nm, coefficients, disc_mean): Self::Record) -> Self {
        Self { wavelength_nm, coefficients, disc_mean }
    }
}
