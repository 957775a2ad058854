//! The light source and the eye.

use super::{WAVELENGTH, bounded};
use crate::{Axis, Curve, Field, Kind, Table, TableError};
use std::collections::BTreeMap;

/// The sun at 1 au.
#[derive(Debug, Clone)]
pub struct Sun {
    /// Spectral irradiance perpendicular to the beam above the atmosphere in W m^-2 nm^-1.
    pub irradiance_w_m2_nm: Curve,
    limb_wavelength: Axis,
    limb_darkening: Field,
}

impl Sun {
    /// The sun at another distance than 1 au: irradiance goes with 1/d^2.
    #[must_use]
    pub fn at_distance(&self, distance_au: f64) -> Self {
        Self { irradiance_w_m2_nm: self.irradiance_w_m2_nm.times(distance_au.powi(-2)), ..self.clone() }
    }

    /// Fields `irradiance` (W m^-2 nm^-1) over `wavelength` (nm), and `limb_darkening` (1)
    /// over `limb_wavelength` (nm) and `power` (1): the a_i of I(mu)/I(1) = sum_i a_i mu^i.
    ///
    /// # Errors
    /// [`TableError`] if the table is of another kind, lacks a field, or holds impossible values.
    pub fn from_table(table: &Table) -> Result<Self, TableError> {
        table.expect_kind(Kind::Sun)?;
        let irradiance = table.curve("irradiance", "W m^-2 nm^-1", WAVELENGTH)?;
        Ok(Self {
            irradiance_w_m2_nm: bounded(irradiance, "irradiance", 0.0, 10.0)?,
            limb_wavelength: table.axis("limb_wavelength")?.clone(),
            limb_darkening: table.field("limb_darkening", "1", &["limb_wavelength", "power"])?.clone(),
        })
    }

    /// The coefficients a_i of I(mu)/I(1) = sum_i a_i mu^i at a wavelength in
    /// nm, mu the cosine of the heliocentric angle. They are interpolated
    /// linearly in wavelength, which is the same as interpolating the profile
    /// at each mu; beyond the measured wavelengths the axis' rule holds.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] where the axis refuses.
    pub fn limb_coefficients(&self, wavelength_nm: f64) -> Result<Vec<f64>, TableError> {
        let powers = self.limb_darkening.values.len() / self.limb_wavelength.nodes.len();
        let Some(at) = self.limb_wavelength.locate(wavelength_nm)? else { return Ok(vec![1.0]) };
        let row = |index: usize| &self.limb_darkening.values[index * powers..(index + 1) * powers];
        let next = row(if at.fraction > 0.0 { at.index + 1 } else { at.index });
        Ok(row(at.index).iter().zip(next).map(|(a, b)| a + at.fraction * (b - a)).collect())
    }
}

/// Colour-matching functions.
#[derive(Debug, Clone)]
pub struct Observer {
    /// x-bar, y-bar, z-bar (1) against wavelength; zero outside.
    pub matching: [Curve; 3],
}

impl Observer {
    /// Fields `x_bar`, `y_bar`, `z_bar` (1) over `wavelength` (nm).
    ///
    /// # Errors
    /// [`TableError`] if the table is of another kind, lacks a field, or holds impossible values.
    pub fn from_table(table: &Table) -> Result<Self, TableError> {
        table.expect_kind(Kind::Observer)?;
        let mut axes = BTreeMap::new();
        let mut curve = |name: &str| bounded(table.curve_sharing(name, "1", WAVELENGTH, &mut axes)?, name, 0.0, 3.0);
        Ok(Self { matching: [curve("x_bar")?, curve("y_bar")?, curve("z_bar")?] })
    }
}
