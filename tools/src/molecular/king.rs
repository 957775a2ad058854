//! King factor and depolarisation of air.
//!
//! For natural light scattered at 90 degrees, rho is the ratio of the intensities polarised
//! parallel and perpendicular to the plane of scattering. The King factor
//! F = (6 + 3 rho) / (6 - 7 rho) is what anisotropy adds to the cross-section, and
//! gamma = rho / (2 - rho) shapes the phase function (Chandrasekhar, Radiative Transfer, 1950,
//! section 18; Bucholtz, Applied Optics 34, 2765, 1995).

use super::refractive_index::RANGE_NM;
use crate::raw::bucholtz;
use tables::{Axis, Curve, Scale, TableError};

/// Depolarisation factor of natural light that belongs to a King factor F:
/// rho = 6 (F - 1) / (3 + 7 F), for F >= 1.
#[must_use]
pub fn depolarisation(king_factor: f64) -> f64 {
    6.0 * (king_factor - 1.0) / (3.0 + 7.0 * king_factor)
}

/// Chandrasekhar's gamma = rho / (2 - rho) of a depolarisation factor rho in 0..=1.
#[must_use]
pub fn gamma(depolarisation: f64) -> f64 {
    depolarisation / (2.0 - depolarisation)
}

/// King factor of air against wavelength: table 1 of Bucholtz (1995), linear between its
/// rows. They are rounded to 0.001, so F is known to 5e-4.
#[derive(Debug, Clone, PartialEq)]
pub struct KingFactor(Curve);

impl KingFactor {
    /// The curve through the rows of table 1. Beyond its last row, at 1000 nm, that row's
    /// value holds up to 4000 nm, as in Bucholtz' own table 2.
    ///
    /// # Errors
    /// [`TableError::Inconsistent`] if the rows make no curve.
    pub fn new(rows: &[bucholtz::KingFactor]) -> Result<Self, TableError> {
        let mut wavelengths: Vec<f64> = rows.iter().map(|row| row.wavelength_nm).collect();
        let mut values: Vec<f64> = rows.iter().map(|row| row.king_factor).collect();
        if let (Some(&last_wavelength), Some(&last)) = (wavelengths.last(), values.last())
            && last_wavelength < RANGE_NM.1
        {
            wavelengths.push(RANGE_NM.1);
            values.push(last);
        }
        Ok(Self(Curve::new(Axis::new("wavelength", "nm", wavelengths)?, Scale::Linear, values)?))
    }

    /// F at a wavelength in nm, from 200 to 4000 nm.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside.
    pub fn at(&self, wavelength_nm: f64) -> Result<f64, TableError> {
        self.0.at(wavelength_nm)
    }
}

/// King factor of dry air after Bates, Planet. Space Sci. 32, 785 (1984), at a wavelength in
/// nm and a volume fraction of carbon dioxide, to compare with. With x the wavelength in um,
/// F(N2) = 1.034 + 3.17e-4 / x^2, F(O2) = 1.096 + 1.385e-3 / x^2 + 1.448e-4 / x^4,
/// F(Ar) = 1, F(CO2) = 1.15, averaged over 78.084, 20.946, 0.934 % and the given share
/// (Bodhaine et al., J. Atmos. Oceanic Technol. 16, 1854, 1999, equations 5, 6 and 23). Meant
/// for 200 to 1000 nm.
#[must_use]
pub fn bates(wavelength_nm: f64, carbon_dioxide: f64) -> f64 {
    let x2 = (wavelength_nm / 1e3).powi(2);
    let gases = [
        (0.78084, 1.034 + 3.17e-4 / x2),
        (0.20946, 1.096 + 1.385e-3 / x2 + 1.448e-4 / (x2 * x2)),
        (0.00934, 1.0),
        (carbon_dioxide, 1.15),
    ];
    let weight: f64 = gases.iter().map(|(share, _)| share).sum();
    gases.iter().map(|(share, factor)| share * factor).sum::<f64>() / weight
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depolarisation_inverts_the_definition_of_the_king_factor() {
        for rho in [0.0, 0.02842, 0.2] {
            let king = (6.0 + 3.0 * rho) / (6.0 - 7.0 * rho);
            // A few roundings.
            assert!((depolarisation(king) - rho).abs() < 1e-15, "rho {rho}");
        }
    }

    #[test]
    fn isotropic_molecules_do_not_depolarise() {
        assert_eq!(depolarisation(1.0), 0.0);
        assert_eq!(gamma(0.0), 0.0);
    }

    #[test]
    fn the_last_row_holds_to_4000_nm_and_outside_is_refused() {
        let row = |wavelength_nm, king_factor| bucholtz::KingFactor {
            wavelength_nm,
            king_factor,
            depolarisation: 0.0,
            gamma: 0.0,
        };
        let king = KingFactor::new(&[row(900.0, 1.049), row(1000.0, 1.047)]).expect("increasing");
        assert!((king.at(950.0).expect("between") - 1.048).abs() < 1e-15);
        assert_eq!(king.at(4000.0).expect("held"), 1.047);
        assert!(king.at(899.0).is_err() && king.at(4001.0).is_err());
        assert!(KingFactor::new(&[]).is_err());
    }
}
