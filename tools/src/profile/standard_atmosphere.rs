//! US Standard Atmosphere 1976 against geometric altitude.
//!
//! COESA, U.S. Standard Atmosphere, 1976, NOAA-S/T 76-1562. Up to 86 km from the defining
//! layers; from there to 120 km a table with a step of 1 km.

use crate::raw::us_standard_atmosphere::{Constants, Layer, UsStandardAtmosphere};
use tables::units::TOP_ALTITUDE_M;
use tables::{Axis, Curve, Outside, Scale, TableError};

/// Air at one altitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Air {
    /// Kinetic temperature T, K.
    pub temperature: f64,
    /// Pressure p, Pa.
    pub pressure: f64,
    /// Mass density, kg m^-3.
    pub mass_density: f64,
    /// Number density N of all molecules, m^-3.
    pub number_density: f64,
}

/// The standard atmosphere from 0 to 120 km.
#[derive(Debug, Clone, PartialEq)]
pub struct StandardAtmosphere {
    constants: Constants,
    /// Layers from the ground upwards, each with its pressure at the base, Pa.
    layers: Vec<(Layer, f64)>,
    molar_mass_ratio: Curve,
    upper: Upper,
}

/// The table above the layers.
#[derive(Debug, Clone, PartialEq)]
struct Upper {
    base: f64,
    temperature: Curve,
    pressure: Curve,
    mass_density: Curve,
    number_density: Curve,
}

impl StandardAtmosphere {
    /// From the defining layers, the constants and the table above 86 km. The pressure at the base
    /// of a layer is carried up from P_0 instead of taken rounded from the layers' table.
    ///
    /// # Errors
    /// [`TableError::Inconsistent`] if the rows make no curves, or a layer other than the
    /// last has no lapse rate.
    pub fn new(raw: &UsStandardAtmosphere) -> Result<Self, TableError> {
        let constants = raw.values;
        let mut layers: Vec<(Layer, f64)> = Vec::new();
        let mut pressure = constants.pressure;
        for layer in &raw.layers.rows {
            if let Some(&(below, base_pressure)) = layers.last() {
                pressure = pressure_in_layer(&constants, &below, base_pressure, layer.geopotential_base)?;
            }
            layers.push((*layer, pressure));
        }
        // The last row closes the one below it and is no layer of its own.
        layers.pop();

        let ratio = &raw.molar_mass.rows;
        let ratio_axis = Axis::new("altitude", "m", ratio.iter().map(|row| row.altitude).collect())?;
        let levels = &raw.extension.rows;
        let axis = Axis::new("altitude", "m", levels.iter().map(|level| level.altitude).collect())?;
        let curve = |scale, value: fn(&crate::raw::us_standard_atmosphere::Level) -> f64| {
            Curve::new(axis.clone(), scale, levels.iter().map(value).collect())
        };
        Ok(Self {
            constants,
            layers,
            // Below 80 km the ratio is that at 80 km, 1.
            molar_mass_ratio: Curve::new(
                ratio_axis.beyond(Outside::Hold),
                Scale::Linear,
                ratio.iter().map(|row| row.ratio).collect(),
            )?,
            upper: Upper {
                base: axis.range().0,
                temperature: curve(Scale::Linear, |level| level.temperature)?,
                pressure: curve(Scale::Logarithmic, |level| level.pressure)?,
                mass_density: curve(Scale::Logarithmic, |level| level.mass_density)?,
                number_density: curve(Scale::Logarithmic, |level| level.number_density)?,
            },
        })
    }

    /// The constants of its equations.
    #[must_use]
    pub fn constants(&self) -> &Constants {
        &self.constants
    }

    /// Geometric altitude z in m of the geopotential altitude H in m': z = r_0 H / (r_0 - H) (equation 19).
    #[must_use]
    pub fn geometric(&self, geopotential: f64) -> f64 {
        let r = self.constants.earth_radius;
        r * geopotential / (r - geopotential)
    }

    /// Geopotential altitude H in m' of the geometric altitude z in m: H = r_0 z / (r_0 + z), with
    /// r_0 = 6356.766 km (equation 18).
    #[must_use]
    pub fn geopotential(&self, altitude: f64) -> f64 {
        let r = self.constants.earth_radius;
        r * altitude / (r + altitude)
    }

    /// Geometric altitudes in m of the bases of the layers: where the gradient of temperature jumps.
    #[must_use]
    pub fn layer_bases(&self) -> Vec<f64> {
        self.layers.iter().map(|(layer, _)| self.geometric(layer.geopotential_base)).collect()
    }

    /// Air at the geometric altitude z in m, from 0 to 120 km.
    ///
    /// Below 86 km, with H the geopotential altitude, in the layer b with base H_b:
    ///
    /// - molecular-scale temperature T_M = T_b + L_b (H - H_b) (equation 23),
    /// - pressure p = p_b (T_b / T_M)^(g_0 M_0 / (R* L_b)), or
    ///   p_b exp(-g_0 M_0 (H - H_b) / (R* T_b)) where L_b = 0 (equations 33a, 33b),
    /// - mass density p M_0 / (R* T_M) (equation 42),
    /// - kinetic temperature T = T_M M / M_0 (equation 22), M / M_0 linear between the values
    ///   given from 80 to 86 km and 1 below,
    /// - number density N = N_A p / (R* T).
    ///
    /// From 86 km on, the table with a step of 1 km, T linear and the logarithms of the others linear
    /// in z. Its pressures are high by 0.01 % at 90 km to 1.3 % at 120 km against the publication.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside 0 to 120 km.
    pub fn at(&self, altitude: f64) -> Result<Air, TableError> {
        if !(0.0..=TOP_ALTITUDE_M).contains(&altitude) {
            let axis = "altitude".into();
            return Err(TableError::OutOfRange {
                axis,
                value: altitude,
                low: 0.0,
                high: TOP_ALTITUDE_M,
                unit: "m".into(),
            });
        }
        if altitude >= self.upper.base {
            return Ok(Air {
                temperature: self.upper.temperature.at(altitude)?,
                pressure: self.upper.pressure.at(altitude)?,
                mass_density: self.upper.mass_density.at(altitude)?,
                number_density: self.upper.number_density.at(altitude)?,
            });
        }
        let height = self.geopotential(altitude);
        let above = self.layers.partition_point(|(layer, _)| layer.geopotential_base <= height);
        let (layer, base_pressure) = self.layers[above.saturating_sub(1)];
        let Constants { gas_constant, molar_mass, avogadro, .. } = self.constants;
        let molecular_temperature = molecular_temperature(&layer, height)?;
        let temperature = molecular_temperature * self.molar_mass_ratio.at(altitude)?;
        let pressure = pressure_in_layer(&self.constants, &layer, base_pressure, height)?;
        Ok(Air {
            temperature,
            pressure,
            mass_density: pressure * molar_mass / (gas_constant * molecular_temperature),
            number_density: avogadro * pressure / (gas_constant * temperature),
        })
    }
}

fn lapse_rate(layer: &Layer) -> Result<f64, TableError> {
    layer.lapse_rate.ok_or_else(|| {
        TableError::Inconsistent(format!("the layer from {} m' has no lapse rate", layer.geopotential_base))
    })
}

fn molecular_temperature(layer: &Layer, geopotential: f64) -> Result<f64, TableError> {
    Ok(layer.base_temperature + lapse_rate(layer)? * (geopotential - layer.geopotential_base))
}

fn pressure_in_layer(
    constants: &Constants,
    layer: &Layer,
    base_pressure: f64,
    geopotential: f64,
) -> Result<f64, TableError> {
    let lapse = lapse_rate(layer)?;
    let rise = geopotential - layer.geopotential_base;
    let per_kelvin = constants.gravity * constants.molar_mass / constants.gas_constant;
    Ok(if lapse == 0.0 {
        base_pressure * (-per_kelvin * rise / layer.base_temperature).exp()
    } else {
        base_pressure * (layer.base_temperature / molecular_temperature(layer, geopotential)?).powf(per_kelvin / lapse)
    })
}
