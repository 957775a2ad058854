//! Ozone number density against geometric altitude.
//!
//! Two sources: the climatology of McPeters, Labow and Logan, J. Geophys. Res. 112, D05308
//! (2007), by month and latitude; and the monthly column at Arosa (Duetsch 1974) spread over
//! six homogeneous layers (Ramanathan and Kulkarni 1953).

use super::standard_atmosphere::StandardAtmosphere;
use crate::raw::ozone_arosa::OzoneArosa;
use crate::raw::ozone_mcpeters_labow::{BANDS, LEVELS, OzoneMcPetersLabow};
use tables::units::{KM, TOP_ALTITUDE_M};
use tables::{Axis, Curve, Outside, Scale, TableError};

/// Pressure in Pa at pressure altitude 0.
const REFERENCE_PRESSURE: f64 = 101_325.0;

/// Rise of pressure altitude in m for a fall of pressure by a factor of ten.
const DECADE: f64 = 16.0 * KM;

/// Pressure altitudes in m between which the fall of ozone is measured that goes on above.
const EXTENSION: (f64, f64) = (55.0 * KM, 60.0 * KM);

/// Pressure altitude in m of a pressure p in Pa: z* = 16 km log10(1013.25 hPa / p), the vertical
/// coordinate of the climatology.
#[must_use]
pub fn pressure_altitude(pressure: f64) -> f64 {
    DECADE * (REFERENCE_PRESSURE / pressure).log10()
}

/// Ozone of one month in one latitude band, before it is scaled to the published column.
#[derive(Debug, Clone, PartialEq)]
pub struct ClimatologicalProfile<'a> {
    atmosphere: &'a StandardAtmosphere,
    mixing_ratio: Curve,
    /// Geometric altitude in m, number density in m^-3 and scale height in m of the extension.
    extension: (f64, f64, f64),
}

impl<'a> ClimatologicalProfile<'a> {
    /// The profile of a month (1 to 12) in a band (0 to 17, south to north).
    ///
    /// A mixing ratio of zero at the lowest levels is a gap of the source and takes the value of
    /// the next level above.
    ///
    /// # Errors
    /// [`TableError::Inconsistent`] for a month or band that is none, or data that give no falling
    /// density at the top.
    pub fn new(
        raw: &OzoneMcPetersLabow,
        atmosphere: &'a StandardAtmosphere,
        month: usize,
        band: usize,
    ) -> Result<Self, TableError> {
        let fail = |what: &str| TableError::Inconsistent(format!("ozone of month {month}, band {band}: {what}"));
        let rows = month
            .checked_sub(1)
            .and_then(|m| raw.mixing_ratio.rows.get(m * LEVELS..(m + 1) * LEVELS))
            .filter(|_| band < BANDS)
            .ok_or_else(|| fail("no such month or band"))?;
        let mut values: Vec<f64> = rows.iter().map(|row| row.mixing_ratios[band]).collect();
        let first = values.iter().position(|&ratio| ratio > 0.0).ok_or_else(|| fail("no data"))?;
        let lowest = values[first];
        values[..first].fill(lowest);
        // Rounding can put z* of the ground a hair below zero.
        let axis = Axis::new("pressure altitude", "m", rows.iter().map(|row| row.pressure_altitude).collect())?
            .beyond(Outside::Hold);
        let mixing_ratio = Curve::new(axis, Scale::Linear, values)?;

        let (low, high) = (geometric(atmosphere, EXTENSION.0)?, geometric(atmosphere, EXTENSION.1)?);
        let density = |altitude: f64, level: f64| -> Result<f64, TableError> {
            Ok(mixing_ratio.at(level)? * atmosphere.at(altitude)?.number_density)
        };
        let (below, top) = (density(low, EXTENSION.0)?, density(high, EXTENSION.1)?);
        if !(top > 0.0 && below > top) {
            return Err(fail("the density does not fall at the top"));
        }
        let scale_height = (high - low) / (below / top).ln();
        Ok(Self { atmosphere, mixing_ratio, extension: (high, top, scale_height) })
    }

    /// Number density in m^-3 at the geometric altitude z in m, from 0 to 120 km.
    ///
    /// Up to z* = 60 km it is the mixing ratio, linear in the pressure altitude z*, times the number
    /// density of air, both at the pressure of the standard atmosphere at z. Above, it falls
    /// exponentially with the mean scale height between z* = 55 and 60 km.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside 0 to 120 km.
    pub fn number_density(&self, altitude: f64) -> Result<f64, TableError> {
        let air = self.atmosphere.at(altitude)?;
        let (top, density, scale_height) = self.extension;
        if altitude > top {
            return Ok(density * (-(altitude - top) / scale_height).exp());
        }
        Ok(self.mixing_ratio.at(pressure_altitude(air.pressure))? * air.number_density)
    }
}

/// Altitudes in m at which the climatology is best tabulated, from 0 to 120 km: where the mixing
/// ratio is given (z* = 0, 1, ... 60 km through the standard atmosphere, to the millimetre), so that
/// its kinks are nodes, and every whole kilometre above.
///
/// # Errors
/// [`TableError::OutOfRange`] if the standard atmosphere ends too low.
pub fn climatology_levels(atmosphere: &StandardAtmosphere) -> Result<Vec<f64>, TableError> {
    let mut levels: Vec<f64> = Vec::new();
    for i in 0..LEVELS {
        levels.push((geometric(atmosphere, i as f64 * KM)? * 1e3).round() / 1e3);
    }
    let top = levels.last().copied().unwrap_or(0.0);
    let mut altitude = (top / KM).ceil() * KM;
    while altitude <= TOP_ALTITUDE_M {
        if altitude > top {
            levels.push(altitude);
        }
        altitude += KM;
    }
    Ok(levels)
}

/// Geometric altitude in m of a pressure altitude in m in the standard atmosphere, by bisection
/// to the last bits (pressure falls strictly with altitude).
fn geometric(atmosphere: &StandardAtmosphere, level: f64) -> Result<f64, TableError> {
    let (mut low, mut high) = (0.0, TOP_ALTITUDE_M);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if pressure_altitude(atmosphere.at(middle)?.pressure) < level {
            low = middle;
        } else {
            high = middle;
        }
    }
    Ok(0.5 * (low + high))
}

/// Geometric altitude in m at which the standard atmosphere has the pressure p in Pa. Above the pressure P_0 at sea
/// level it is negative, (R* T_0 / (g_0 M_0)) ln(P_0 / p), T_0 the temperature there.
///
/// # Errors
/// [`TableError::OutOfRange`] if the standard atmosphere ends too low.
pub fn altitude_of_pressure(atmosphere: &StandardAtmosphere, pressure: f64) -> Result<f64, TableError> {
    let ground = atmosphere.at(0.0)?;
    if pressure <= ground.pressure {
        return geometric(atmosphere, pressure_altitude(pressure));
    }
    let constants = atmosphere.constants();
    let scale_height = constants.gas_constant * ground.temperature / (constants.gravity * constants.molar_mass);
    Ok(scale_height * (ground.pressure / pressure).ln())
}

/// Number densities at a grid of altitudes, scaled to a column.
#[derive(Debug, Clone, PartialEq)]
pub struct ScaledProfile {
    /// Number density at each altitude, m^-3.
    pub number_density: Vec<f64>,
    /// Factor that the values were multiplied with.
    pub factor: f64,
}

/// A profile at `altitudes` in m, scaled so that the integral of its linear interpolation, the
/// trapezoidal sum, is `column` in m^-2.
///
/// # Errors
/// [`TableError::OutOfRange`] for an altitude outside 0 to 120 km, [`TableError::Inconsistent`] if
/// the profile has no column to scale.
pub fn scaled(
    profile: &ClimatologicalProfile<'_>,
    altitudes: &[f64],
    column: f64,
) -> Result<ScaledProfile, TableError> {
    let density: Vec<f64> = altitudes.iter().map(|&z| profile.number_density(z)).collect::<Result<_, _>>()?;
    let sum = trapezoidal(altitudes, &density);
    if sum <= 0.0 {
        return Err(TableError::Inconsistent("an ozone profile without a column cannot be scaled".into()));
    }
    let factor = column / sum;
    Ok(ScaledProfile { number_density: density.into_iter().map(|n| n * factor).collect(), factor })
}

/// Integral of the function that is linear between `values` at `nodes`: sum of
/// (x_(i+1) - x_i) (v_i + v_(i+1)) / 2.
#[must_use]
pub fn trapezoidal(nodes: &[f64], values: &[f64]) -> f64 {
    nodes.windows(2).zip(values.windows(2)).map(|(x, v)| 0.5 * (x[1] - x[0]) * (v[0] + v[1])).sum()
}

/// Bases of the homogeneous layers at Arosa in m, and last the top of the highest.
#[must_use]
pub fn arosa_levels(raw: &OzoneArosa) -> Vec<f64> {
    let layers = &raw.layers.rows;
    layers.iter().map(|layer| layer.bottom).chain(layers.last().map(|layer| layer.top)).collect()
}

/// Number density in m^-3 in each layer at Arosa for a total column in m^-2:
/// the layer's share of the column over its thickness. The share is the layer's printed column
/// over the sum of all of them (210 DU).
#[must_use]
pub fn arosa_densities(raw: &OzoneArosa, column: f64) -> Vec<f64> {
    let layers = &raw.layers.rows;
    let total: f64 = layers.iter().map(|layer| layer.column).sum();
    layers.iter().map(|layer| column * (layer.column / total) / (layer.top - layer.bottom)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tenth_of_the_pressure_is_16_km_up() {
        assert_eq!(pressure_altitude(101_325.0), 0.0);
        // One rounding of the logarithm.
        assert!((pressure_altitude(10_132.5) - 16_000.0).abs() < 1e-9);
    }

    #[test]
    fn the_trapezoidal_sum_of_a_line_is_exact() {
        assert_eq!(trapezoidal(&[0.0, 1.0, 4.0], &[1.0, 2.0, 5.0]), 12.0);
        assert_eq!(trapezoidal(&[1.0], &[3.0]), 0.0);
    }
}
