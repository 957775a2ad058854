//! Ozone absorption cross-section as a polynomial in temperature.
//!
//! At each wavelength sigma(T) = s_0 + s_1 (T - T_0) + s_2 (T - T_0)^2 is fitted by least
//! squares to the 11 measured temperatures of Serdyuchenko et al., Atmos. Meas. Tech. 7, 625
//! (2014). Wavelength and temperature are so kept apart, which the column tables of a renderer
//! need. It is the form that Bass and Paur introduced (Atmospheric Ozone, Reidel, 1985, p. 606).

use crate::raw::ozone_serdyuchenko::{CrossSections, TEMPERATURES, TEMPERATURES_K};

/// T_0 in K: the mean of the measured temperatures, where the fit is best conditioned.
pub const REFERENCE_TEMPERATURE_K: f64 = 243.0;

/// Cross-section at one wavelength against temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TemperaturePolynomial {
    /// Wavelength in vacuum, nm.
    pub wavelength_nm: f64,
    /// s_0 in m^2, s_1 in m^2 K^-1, s_2 in m^2 K^-2.
    pub coefficients: [f64; 3],
}

impl TemperaturePolynomial {
    /// The least-squares parabola through `values` in m^2 at [`TEMPERATURES_K`].
    ///
    /// The temperatures lie symmetrically about T_0 = [`REFERENCE_TEMPERATURE_K`], so the sums of
    /// odd powers of d = T - T_0 vanish and the normal equations part: with S_k = sum d^k,
    /// s_1 = sum(sigma d) / S_2,
    /// s_2 = (sum(sigma d^2) - S_2 sum(sigma) / n) / (S_4 - S_2^2 / n),
    /// s_0 = (sum(sigma) - s_2 S_2) / n.
    #[must_use]
    pub fn fit(wavelength_nm: f64, values: &[f64; TEMPERATURES]) -> Self {
        let n = TEMPERATURES as f64;
        let moment = |weights: &[f64; TEMPERATURES], power: i32| -> f64 {
            let differences = TEMPERATURES_K.map(|t| (t - REFERENCE_TEMPERATURE_K).powi(power));
            weights.iter().zip(differences).map(|(w, d)| w * d).sum()
        };
        let ones = [1.0; TEMPERATURES];
        let (second, fourth) = (moment(&ones, 2), moment(&ones, 4));
        let sum = moment(values, 0);
        let s1 = moment(values, 1) / second;
        let s2 = (moment(values, 2) - second * sum / n) / (fourth - second * second / n);
        let s0 = (sum - s2 * second) / n;
        Self { wavelength_nm, coefficients: [s0, s1, s2] }
    }

    /// sigma in m^2 at a temperature in K. Measured from 193 to 293 K; outside, the parabola
    /// goes on (the standard atmosphere has 187 K at 86 km, where there is no ozone to speak of).
    #[must_use]
    pub fn at(&self, temperature: f64) -> f64 {
        let d = temperature - REFERENCE_TEMPERATURE_K;
        let [s0, s1, s2] = self.coefficients;
        s0 + d * (s1 + d * s2)
    }
}

/// The polynomials of a range of wavelengths, with what was done to get them and how well they fit.
#[derive(Debug, Clone, PartialEq)]
pub struct OzoneFit {
    /// One polynomial for each wavelength measured within the range.
    pub polynomials: Vec<TemperaturePolynomial>,
    /// Measured cells within the range.
    pub cells: usize,
    /// Cells that were not positive, which is noise, and were set to zero before the fit.
    pub clamped: usize,
    /// Distance of the polynomials from the cells.
    pub residual: Residual,
}

/// Distance between fitted and measured values, over all cells of a range.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Residual {
    /// Largest |fit - measured|, m^2.
    pub largest: f64,
    /// Root mean square of fit - measured, m^2.
    pub rms: f64,
    /// Largest |fit / measured - 1|, over the cells that were not clamped.
    pub largest_relative: f64,
    /// Wavelength of the largest relative one, nm.
    pub largest_relative_at_nm: f64,
    /// Root mean square of fit / measured - 1, over the cells that were not clamped.
    pub rms_relative: f64,
}

/// Fits each row with a wavelength in `low_nm..=high_nm`. Cells that are not positive are
/// set to zero and counted; with no row in the range the result is empty.
#[must_use]
pub fn fit(rows: &[CrossSections], low_nm: f64, high_nm: f64) -> OzoneFit {
    let mut result = OzoneFit { polynomials: Vec::new(), cells: 0, clamped: 0, residual: Residual::default() };
    let (mut squares, mut relative_squares) = (0.0, 0.0);
    for row in rows.iter().filter(|row| (low_nm..=high_nm).contains(&row.wavelength_nm)) {
        let values = row.cross_sections.map(|sigma| sigma.max(0.0));
        let polynomial = TemperaturePolynomial::fit(row.wavelength_nm, &values);
        for (temperature, measured) in TEMPERATURES_K.into_iter().zip(values) {
            let difference = polynomial.at(temperature) - measured;
            let residual = &mut result.residual;
            result.cells += 1;
            squares += difference * difference;
            residual.largest = residual.largest.max(difference.abs());
            if measured == 0.0 {
                result.clamped += 1;
                continue;
            }
            let relative = (difference / measured).abs();
            relative_squares += relative * relative;
            if relative > residual.largest_relative {
                (residual.largest_relative, residual.largest_relative_at_nm) = (relative, row.wavelength_nm);
            }
        }
        result.polynomials.push(polynomial);
    }
    result.residual.rms = (squares / result.cells.max(1) as f64).sqrt();
    result.residual.rms_relative = (relative_squares / (result.cells - result.clamped).max(1) as f64).sqrt();
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(wavelength_nm: f64, sigma: impl Fn(f64) -> f64) -> CrossSections {
        CrossSections { wavelength_nm, cross_sections: TEMPERATURES_K.map(sigma) }
    }

    #[test]
    fn a_parabola_is_recovered() {
        let sigma = |t: f64| 3e-23 + 2e-26 * (t - 243.0) + 5e-28 * (t - 243.0).powi(2);
        let found = TemperaturePolynomial::fit(320.0, &TEMPERATURES_K.map(sigma)).coefficients;
        for (found, expected) in found.into_iter().zip([3e-23, 2e-26, 5e-28]) {
            // Sums of 11 terms: a few 1e-16, amplified by the cancellation in s_2.
            assert!((found / expected - 1.0).abs() < 1e-12, "{found} for {expected}");
        }
    }

    #[test]
    fn the_reference_is_the_mean_of_the_temperatures_and_they_are_symmetric() {
        let odd = |power| TEMPERATURES_K.iter().map(|t| (t - REFERENCE_TEMPERATURE_K).powi(power)).sum::<f64>();
        assert_eq!((odd(1), odd(3)), (0.0, 0.0));
    }

    #[test]
    fn cells_that_are_not_positive_are_clamped_and_counted() {
        let rows = [row(300.0, |_| 1e-22), row(301.0, |t| if t < 200.0 { -1e-26 } else { 1e-24 })];
        let found = fit(&rows, 300.0, 301.0);
        assert_eq!((found.polynomials.len(), found.cells, found.clamped), (2, 22, 1));
        assert!(found.residual.largest_relative.is_finite());
        assert_eq!(fit(&rows, 300.0, 300.0).clamped, 0, "only the range counts");
        assert_eq!(fit(&rows, 400.0, 500.0).cells, 0);
    }
}
