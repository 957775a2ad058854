//! Refractive index of standard air.
//!
//! Peck and Reeder, J. Opt. Soc. Am. 62, 958 (1972), for dry air at 288.15 K and
//! 1013.25 hPa with 0.033 % carbon dioxide: the four-parameter form, and the
//! five-parameter one that holds further into the ultraviolet, each used where
//! Bucholtz, Applied Optics 34, 2765 (1995) uses it.

use super::outside;
use tables::TableError;

/// Wavelengths in nm for which [`refractivity`] answers: those of Bucholtz' table 2. Peck
/// and Reeder measured from 185 to 1690 nm; Bucholtz carries their formula on to 4000 nm.
pub const RANGE_NM: (f64, f64) = (200.0, 4000.0);

/// Wavelength in nm up to which the five-parameter form is used.
const FIVE_PARAMETERS_UP_TO_NM: f64 = 230.0;

/// Refractivity n - 1 of standard air at a vacuum wavelength lambda in nm, with
/// sigma = 1/lambda in um^-1:
///
/// - above 230 nm, 1e8 (n - 1) = 5791817 / (238.0185 - sigma^2) + 167909 / (57.362 - sigma^2);
/// - up to 230 nm, 1e8 (n - 1) = 8060.51 + 2480990 / (132.274 - sigma^2)
///   + 17455.7 / (39.32957 - sigma^2).
///
/// The forms differ by 8e-6 of n - 1 where they meet.
///
/// # Errors
/// [`TableError::OutOfRange`] outside [`RANGE_NM`].
pub fn refractivity(wavelength_nm: f64) -> Result<f64, TableError> {
    let (low, high) = RANGE_NM;
    if !(low..=high).contains(&wavelength_nm) {
        return Err(outside(wavelength_nm, low, high));
    }
    let sigma_squared = (1e3 / wavelength_nm).powi(2);
    let scaled = if wavelength_nm <= FIVE_PARAMETERS_UP_TO_NM {
        8060.51 + 2_480_990.0 / (132.274 - sigma_squared) + 17_455.7 / (39.329_57 - sigma_squared)
    } else {
        5_791_817.0 / (238.018_5 - sigma_squared) + 167_909.0 / (57.362 - sigma_squared)
    };
    Ok(scaled * 1e-8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_dispersion_formula_agrees() {
        // Edlen, Metrologia 2, 71 (1966), equation 1: air at 288.15 K and 1013.25 hPa with 0.03 %
        // carbon dioxide. The two differ by some 1e-8 of n, 1e-4 of n - 1, from 300 to 1000 nm.
        for wavelength_nm in [300.0, 400.0, 589.3, 1000.0_f64] {
            let s2 = (1e3 / wavelength_nm).powi(2);
            let edlen = 1e-8 * (8342.13 + 2_406_030.0 / (130.0 - s2) + 15_997.0 / (38.9 - s2));
            let found = refractivity(wavelength_nm).expect("in range");
            assert!((found / edlen - 1.0).abs() < 1e-4, "{found} against {edlen} at {wavelength_nm} nm");
        }
    }

    #[test]
    fn the_two_forms_meet() {
        // They were fitted to overlapping data; the step is what their residuals allow.
        let below = refractivity(230.0).expect("in range");
        let above = refractivity(230.0 + 1e-9).expect("in range");
        assert!((above / below - 1.0).abs() < 1e-5, "step {}", above / below - 1.0);
    }

    #[test]
    fn outside_is_refused() {
        for wavelength_nm in [199.9, 4000.1, f64::NAN] {
            assert!(refractivity(wavelength_nm).is_err(), "{wavelength_nm}");
        }
    }
}
