//! Rayleigh scattering cross-section of a molecule of air.
//!
//! Bucholtz, Applied Optics 34, 2765 (1995), with the refractive index of
//! [`super::refractive_index`] and the King factor of [`super::king`].

use super::king::KingFactor;
use super::outside;
use super::refractive_index::{RANGE_NM, refractivity};
use crate::raw::bucholtz::{Bucholtz, CrossSection, Fit, Quantity};
use std::f64::consts::PI;
use tables::TableError;

/// Rayleigh scattering of air.
#[derive(Debug, Clone, PartialEq)]
pub struct Rayleigh {
    king_factor: KingFactor,
    standard_number_density: f64,
}

impl Rayleigh {
    /// From table 1 of Bucholtz and N_s in m^-3, the number density of the air to which the
    /// refractive index belongs (288.15 K, 1013.25 hPa: 2.54743e25 m^-3).
    ///
    /// # Errors
    /// [`TableError::Inconsistent`] if the rows of table 1 make no curve.
    pub fn new(raw: &Bucholtz, standard_number_density: f64) -> Result<Self, TableError> {
        Ok(Self { king_factor: KingFactor::new(&raw.king_factor.rows)?, standard_number_density })
    }

    /// King factor F of air, 1.
    #[must_use]
    pub fn king_factor(&self) -> &KingFactor {
        &self.king_factor
    }

    /// Scattering cross-section in m^2 at a vacuum wavelength lambda in nm:
    ///
    /// sigma = 24 pi^3 (n^2 - 1)^2 F / (lambda^4 N_s^2 (n^2 + 2)^2)
    ///
    /// with n the refractive index of air of the number density N_s, F the King factor, and
    /// lambda in m. The ratio ((n^2 - 1) / (n^2 + 2)) / N_s, and so sigma, does not depend on
    /// the density of the air (Lorentz and Lorenz). Against Bucholtz' table 2 the largest
    /// difference is 0.04 %, which is the rounding of its last digit.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside 200 to 4000 nm.
    pub fn cross_section(&self, wavelength_nm: f64) -> Result<f64, TableError> {
        let r = refractivity(wavelength_nm)?;
        let king = self.king_factor.at(wavelength_nm)?;
        // n^2 - 1 = r (r + 2) keeps the digits that 1 + r would lose.
        let n2_minus_1 = r * (r + 2.0);
        let lorentz = n2_minus_1 / (n2_minus_1 + 3.0);
        let wavelength = wavelength_nm * 1e-9;
        Ok(24.0 * PI.powi(3) * (lorentz / self.standard_number_density).powi(2) * king / wavelength.powi(4))
    }

    /// How far [`Rayleigh::cross_section`] is from the rows of table 2.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] for a row outside 200 to 4000 nm.
    pub fn compare(&self, rows: &[CrossSection]) -> Result<Departure, TableError> {
        departure(rows, |wavelength_nm| self.cross_section(wavelength_nm))
    }
}

/// Bucholtz' fit (table 3) of a quantity at a wavelength in nm, to compare with:
/// a x^-(b + c x + d / x), x the wavelength in um; in m^2, m^-1 or 1 according to the
/// quantity. At 500 nm, where two ranges meet, the lower is taken. The fit departs from table 2
/// by up to 0.43 %, at 200 nm.
///
/// # Errors
/// [`TableError::OutOfRange`] outside the ranges of the fit, 200 to 4000 nm.
pub fn fitted(fits: &[Fit], quantity: Quantity, wavelength_nm: f64) -> Result<f64, TableError> {
    let fit = fits
        .iter()
        .find(|f| f.quantity == quantity && (f.wavelength_min_nm..=f.wavelength_max_nm).contains(&wavelength_nm))
        .ok_or_else(|| outside(wavelength_nm, RANGE_NM.0, RANGE_NM.1))?;
    let x = wavelength_nm / 1e3;
    Ok(fit.a * x.powf(-(fit.b + fit.c * x + fit.d / x)))
}

/// How far computed values are from tabulated ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Departure {
    /// Number of values compared.
    pub count: usize,
    /// Largest |computed / tabulated - 1|.
    pub largest: f64,
    /// Wavelength of the largest, nm.
    pub largest_at_nm: f64,
    /// Root mean square of computed / tabulated - 1.
    pub rms: f64,
}

/// How far `computed` is from the cross-sections of table 2 of Bucholtz.
///
/// # Errors
/// The first error of `computed`.
pub fn departure(
    rows: &[CrossSection],
    computed: impl Fn(f64) -> Result<f64, TableError>,
) -> Result<Departure, TableError> {
    let mut result = Departure { count: rows.len(), largest: 0.0, largest_at_nm: 0.0, rms: 0.0 };
    let mut squares = 0.0;
    for row in rows {
        let relative = computed(row.wavelength_nm)? / row.cross_section - 1.0;
        squares += relative * relative;
        if relative.abs() > result.largest {
            (result.largest, result.largest_at_nm) = (relative.abs(), row.wavelength_nm);
        }
    }
    result.rms = (squares / rows.len().max(1) as f64).sqrt();
    Ok(result)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_departure_finds_the_largest_and_the_mean_square() {
        let row =
            |wavelength_nm, cross_section| CrossSection { wavelength_nm, cross_section, scattering_coefficient: 0.0 };
        let found = departure(&[row(300.0, 1.0), row(400.0, 2.0)], |_| Ok(1.0)).expect("no error");
        assert_eq!((found.count, found.largest, found.largest_at_nm), (2, 0.5, 400.0));
        assert!((found.rms - 0.125_f64.sqrt()).abs() < 1e-15, "{}", found.rms);
    }

    #[test]
    fn a_wavelength_that_no_fit_covers_is_refused() {
        assert!(fitted(&[], Quantity::CrossSection, 500.0).is_err());
    }
}
