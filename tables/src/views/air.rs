//! Air: its profile and how it scatters.

use super::{ALTITUDE, WAVELENGTH, bounded};
use crate::{Curve, Kind, Table, TableError};
use std::collections::BTreeMap;

/// Temperature, pressure and number density against geometric altitude.
#[derive(Debug, Clone)]
pub struct StandardAtmosphere {
    /// Kinetic temperature T(z) in K, linear between nodes.
    pub temperature_k: Curve,
    /// Pressure p(z) in Pa, its logarithm linear between nodes.
    pub pressure_pa: Curve,
    /// Number density N(z) in m^-3, its logarithm linear between nodes.
    pub number_density_m3: Curve,
}

impl StandardAtmosphere {
    /// Fields `temperature` (K), `pressure` (Pa), `number_density` (m^-3) over `altitude` (m).
    ///
    /// # Errors
    /// [`TableError`] if the table is of another kind, lacks a field, or holds impossible values.
    pub fn from_table(table: &Table) -> Result<Self, TableError> {
        table.expect_kind(Kind::StandardAtmosphere)?;
        let mut axes = BTreeMap::new();
        let mut curve = |name: &str, unit: &str, low: f64, high: f64| {
            bounded(table.curve_sharing(name, unit, ALTITUDE, &mut axes)?, name, low, high)
        };
        Ok(Self {
            temperature_k: curve("temperature", "K", 50.0, 3000.0)?,
            pressure_pa: curve("pressure", "Pa", 0.0, 1e8)?,
            number_density_m3: curve("number_density", "m^-3", 0.0, 1e28)?,
        })
    }
}

/// Rayleigh scattering by air against vacuum wavelength.
#[derive(Debug, Clone)]
pub struct Rayleigh {
    /// Scattering cross-section of one molecule in m^2, its logarithm linear between nodes.
    pub cross_section_m2: Curve,
    /// King factor F_k (1 for isotropic molecules), linear between nodes.
    pub king_factor: Curve,
    /// Chandrasekhar's gamma = rho / (2 - rho), rho the depolarisation of
    /// natural light scattered at 90 degrees; linear between nodes.
    pub gamma: Curve,
}

impl Rayleigh {
    /// Fields `cross_section` (m^2), `king_factor` (1), `gamma` (1) over `wavelength` (nm).
    ///
    /// # Errors
    /// [`TableError`] if the table is of another kind, lacks a field, or holds impossible values.
    pub fn from_table(table: &Table) -> Result<Self, TableError> {
        table.expect_kind(Kind::Rayleigh)?;
        let mut axes = BTreeMap::new();
        let mut curve = |name: &str, unit: &str, low: f64, high: f64| {
            bounded(table.curve_sharing(name, unit, WAVELENGTH, &mut axes)?, name, low, high)
        };
        Ok(Self {
            cross_section_m2: curve("cross_section", "m^2", 0.0, 1e-20)?,
            king_factor: curve("king_factor", "1", 1.0, 2.0)?,
            gamma: curve("gamma", "1", 0.0, 0.5)?,
        })
    }
}
