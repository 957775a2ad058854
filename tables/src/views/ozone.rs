//! Ozone: how much of it there is where, and how it absorbs.

use super::{ALTITUDE, LATITUDE, MONTH, WAVELENGTH, scalar};
use crate::{Axis, Curve, Field, Kind, Outside, Scale, Table, TableError};
use std::collections::BTreeMap;

/// Absorption cross-section of ozone, sigma(lambda, T) = s_0 + s_1 (T - T_0) + s_2 (T - T_0)^2.
///
/// Temperature and wavelength are so kept apart: the absorption coefficient is
/// N s_0 + N (T - T_0) s_1 + N (T - T_0)^2 s_2, three products of a profile and a spectrum.
#[derive(Debug, Clone)]
pub struct OzoneCrossSection {
    /// T_0 in K.
    pub reference_temperature_k: f64,
    /// s_0 in m^2, s_1 in m^2 K^-1, s_2 in m^2 K^-2, linear between nodes.
    pub coefficients: [Curve; 3],
}

impl OzoneCrossSection {
    /// Fields `sigma_0` (m^2), `sigma_1` (m^2 K^-1), `sigma_2` (m^2 K^-2) over
    /// `wavelength` (nm), and `reference_temperature` (K) without axes.
    ///
    /// # Errors
    /// [`TableError`] if the table is of another kind or lacks a field.
    pub fn from_table(table: &Table) -> Result<Self, TableError> {
        table.expect_kind(Kind::OzoneCrossSection)?;
        let mut axes = BTreeMap::new();
        let mut curve = |name: &str, unit: &str| table.curve_sharing(name, unit, WAVELENGTH, &mut axes);
        Ok(Self {
            reference_temperature_k: scalar(table, "reference_temperature", "K")?,
            coefficients: [curve("sigma_0", "m^2")?, curve("sigma_1", "m^2 K^-1")?, curve("sigma_2", "m^2 K^-2")?],
        })
    }

    /// Cross-section in m^2 at a wavelength in nm and a temperature in K.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside the table's wavelengths. The
    /// temperature is not bounded here; the data end at 193 and 293 K.
    pub fn cross_section_m2(&self, wavelength_nm: f64, temperature_k: f64) -> Result<f64, TableError> {
        let dt = temperature_k - self.reference_temperature_k;
        let [s0, s1, s2] = &self.coefficients;
        Ok(s0.at(wavelength_nm)? + dt * (s1.at(wavelength_nm)? + dt * s2.at(wavelength_nm)?))
    }
}

/// Ozone number density against altitude with its column.
#[derive(Debug, Clone)]
pub struct OzoneProfile {
    /// Number density in m^-3.
    pub number_density_m3: Curve,
    /// Vertical column in Dobson units, as published (profiles integrate to it).
    pub column_du: f64,
}

/// Monthly ozone by latitude: (month, latitude, altitude).
#[derive(Debug, Clone)]
pub struct OzoneProfiles {
    month: Axis,
    latitude: Axis,
    altitude: Axis,
    number_density: Field,
    column: Field,
}

impl OzoneProfiles {
    /// Fields `number_density` (m^-3) over `month`, `latitude` (deg), `altitude` (m),
    /// and `column` (DU) over `month`, `latitude`.
    ///
    /// # Errors
    /// [`TableError`] if the table is of another kind, lacks a field, or holds a negative density.
    pub fn from_table(table: &Table) -> Result<Self, TableError> {
        table.expect_kind(Kind::OzoneProfiles)?;
        let number_density = table.field("number_density", "m^-3", &[MONTH.0, LATITUDE.0, ALTITUDE.0])?.clone();
        non_negative(&number_density)?;
        Ok(Self {
            month: table.axis(MONTH.0)?.clone(),
            latitude: table.axis(LATITUDE.0)?.clone(),
            altitude: table.axis(ALTITUDE.0)?.clone(),
            number_density,
            column: table.field("column", "DU", &[MONTH.0, LATITUDE.0])?.clone(),
        })
    }

    /// Whether there is one profile only, which holds in every month at every latitude: a sonde's.
    #[must_use]
    pub fn is_single(&self) -> bool {
        let one = |axis: &Axis| axis.nodes.len() == 1 && axis.outside == Outside::Hold;
        one(&self.month) && one(&self.latitude)
    }

    /// The profile of a month (1 to 12) at a latitude in degrees, linear
    /// between the centres of the latitude bands; beyond the last centre the
    /// axis' rule holds.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] for a month that is none.
    pub fn profile(&self, month: u8, latitude_deg: f64) -> Result<OzoneProfile, TableError> {
        let heights = self.altitude.nodes.len();
        let nowhere = || TableError::Inconsistent("month and latitude axes must refuse or hold outside".into());
        let m = self.month.locate(f64::from(month))?.ok_or_else(nowhere)?;
        let l = self.latitude.locate(latitude_deg)?.ok_or_else(nowhere)?;
        let row = m.index * self.latitude.nodes.len() + l.index;
        let next = if l.fraction > 0.0 { row + 1 } else { row };
        let mix = |a: f64, b: f64| a + l.fraction * (b - a);
        let density = |row: usize| &self.number_density.values[row * heights..(row + 1) * heights];
        let values = density(row).iter().zip(density(next)).map(|(&a, &b)| mix(a, b)).collect();
        Ok(OzoneProfile {
            number_density_m3: Curve::new(self.altitude.clone(), Scale::Linear, values)?,
            column_du: mix(self.column.values[row], self.column.values[next]),
        })
    }
}

/// Monthly ozone of one station in homogeneous layers: (month, altitude).
#[derive(Debug, Clone)]
pub struct OzoneLayers {
    month: Axis,
    altitude: Axis,
    number_density: Field,
    column: Field,
}

impl OzoneLayers {
    /// Fields `number_density` (m^-3) over `month`, `altitude` (m; a step axis), and
    /// `column` (DU) over `month`.
    ///
    /// # Errors
    /// [`TableError`] if the table is of another kind, lacks a field, or holds a negative density.
    pub fn from_table(table: &Table) -> Result<Self, TableError> {
        table.expect_kind(Kind::OzoneLayers)?;
        let number_density = table.field("number_density", "m^-3", &[MONTH.0, ALTITUDE.0])?.clone();
        non_negative(&number_density)?;
        Ok(Self {
            month: table.axis(MONTH.0)?.clone(),
            altitude: table.axis(ALTITUDE.0)?.clone(),
            number_density,
            column: table.field("column", "DU", &[MONTH.0])?.clone(),
        })
    }

    /// The profile of a month (1 to 12).
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] for a month that is none.
    pub fn profile(&self, month: u8) -> Result<OzoneProfile, TableError> {
        let heights = self.altitude.nodes.len();
        let nowhere = || TableError::Inconsistent("the month axis must refuse outside".into());
        let row = self.month.locate(f64::from(month))?.ok_or_else(nowhere)?.index;
        let values = self.number_density.values[row * heights..(row + 1) * heights].to_vec();
        Ok(OzoneProfile {
            number_density_m3: Curve::new(self.altitude.clone(), Scale::Linear, values)?,
            column_du: self.column.values[row],
        })
    }
}

fn non_negative(field: &Field) -> Result<(), TableError> {
    match field.values.iter().find(|v| **v < 0.0) {
        None => Ok(()),
        Some(v) => {
            Err(TableError::Inconsistent(format!("field {:?} holds {v}; a density is not negative", field.name)))
        }
    }
}
