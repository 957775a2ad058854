//! US Standard Atmosphere 1976 (COESA 1976): defining layers, constants, published profile.

use super::{Column, Fault, RawError, Row, Source};
use std::path::Path;
use tables::units::KM;

/// The files of `us-standard-atmosphere-1976/`.
#[derive(Debug, Clone, PartialEq)]
pub struct UsStandardAtmosphere {
    /// The seven defining layers, and the level that closes the last.
    pub layers: Source<Layer>,
    /// The constants, as rows.
    pub constants: Source<ConstantRow>,
    /// Molar-mass ratio from 80 to 86 km.
    pub molar_mass: Source<MolarMass>,
    /// Profile from 0 to 86 km, to compare with.
    pub profile: Source<Level>,
    /// Profile from 86 to 120 km, which is data here.
    pub extension: Source<Level>,
    /// The constants that the equations need.
    pub values: Constants,
}

impl UsStandardAtmosphere {
    /// Reads the files below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`], also for a constant that is missing or in another unit.
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        let constants = Source::read(raw_dir, "us-standard-atmosphere-1976/constants.csv")?;
        let extension: Source<ExtensionLevel> = Source::read(raw_dir, "us-standard-atmosphere-1976/to-120km.csv")?;
        Ok(Self {
            layers: Source::read(raw_dir, "us-standard-atmosphere-1976/layers.csv")?,
            values: Constants::from_rows(&constants)?,
            constants,
            molar_mass: Source::read(raw_dir, "us-standard-atmosphere-1976/molar-mass.csv")?,
            profile: Source::read(raw_dir, "us-standard-atmosphere-1976/profile.csv")?,
            extension: Source {
                provenance: extension.provenance,
                rows: extension.rows.into_iter().map(|level| level.0).collect(),
            },
        })
    }
}

/// One defining layer: linear molecular-scale temperature in geopotential altitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layer {
    /// Geopotential altitude of the base, m'.
    pub geopotential_base: f64,
    /// Geometric altitude of the base, m.
    pub geometric_base: f64,
    /// Molecular-scale temperature at the base, K.
    pub base_temperature: f64,
    /// Gradient of the molecular-scale temperature, K/m'; none for the level that closes the table.
    pub lapse_rate: Option<f64>,
    /// Pressure at the base, Pa, rounded.
    pub base_pressure: f64,
}

impl Row for Layer {
    type Record = (f64, f64, f64, f64, Option<f64>, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::number("layer", "1", 0.0, 7.0).key(),
            Column::number("geopotential_base_km", "km", 0.0, 90.0),
            Column::number("geometric_base_km", "km", 0.0, 90.0),
            Column::number("base_molecular_temperature_k", "K", 100.0, 400.0),
            Column::optional("lapse_rate_k_per_km", "K km^-1", -10.0, 10.0),
            Column::number("base_pressure_pa", "Pa", 0.1, 110_000.0),
        ]
    }

    fn from_record((_, geopotential_km, geometric_km, base_temperature, rate, base_pressure): Self::Record) -> Self {
        Self {
            geopotential_base: geopotential_km * KM,
            geometric_base: geometric_km * KM,
            base_temperature,
            lapse_rate: rate.map(|per_km| per_km / KM),
            base_pressure,
        }
    }
}

/// Ratio of the mean molar mass of air to its value at sea level.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MolarMass {
    /// Geometric altitude, m.
    pub altitude: f64,
    /// M / M_0.
    pub ratio: f64,
}

impl Row for MolarMass {
    type Record = (f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::number("geometric_altitude_km", "km", 80.0, 86.0).key(),
            Column::number("molar_mass_ratio", "1", 0.9, 1.0),
        ]
    }

    fn from_record((altitude_km, ratio): Self::Record) -> Self {
        Self { altitude: altitude_km * KM, ratio }
    }
}

/// One level of a tabulated profile.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Level {
    /// Geometric altitude, m.
    pub altitude: f64,
    /// Kinetic temperature, K.
    pub temperature: f64,
    /// Pressure, Pa.
    pub pressure: f64,
    /// Mass density, kg m^-3.
    pub mass_density: f64,
    /// Number density of all molecules, m^-3.
    pub number_density: f64,
}

fn level_columns() -> Vec<Column> {
    vec![
        Column::number("geometric_altitude_km", "km", 0.0, 120.0).key(),
        Column::number("temperature_k", "K", 100.0, 500.0),
        Column::number("pressure_pa", "Pa", 1e-4, 110_000.0),
        Column::number("density_kg_m3", "kg m^-3", 1e-9, 1.5),
        Column::number("number_density_m3", "m^-3", 1e16, 3e25),
    ]
}

impl Row for Level {
    type Record = (f64, f64, f64, f64, f64, f64);

    fn columns() -> Vec<Column> {
        let mut columns = level_columns();
        columns.insert(1, Column::number("geopotential_altitude_km", "km", 0.0, 90.0));
        columns
    }

    fn from_record((altitude_km, _, temperature, pressure, mass_density, number_density): Self::Record) -> Self {
        Self { altitude: altitude_km * KM, temperature, pressure, mass_density, number_density }
    }
}

/// As [`Level`], without the geopotential altitude, which stops to matter above 86 km.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ExtensionLevel(pub Level);

impl Row for ExtensionLevel {
    type Record = (f64, f64, f64, f64, f64);

    fn columns() -> Vec<Column> {
        level_columns()
    }

    fn from_record((altitude_km, temperature, pressure, mass_density, number_density): Self::Record) -> Self {
        Self(Level { altitude: altitude_km * KM, temperature, pressure, mass_density, number_density })
    }
}

/// A constant with its unit, as the file has it.
#[derive(Debug, Clone, PartialEq)]
pub struct ConstantRow {
    /// Name.
    pub name: String,
    /// Value in `unit`.
    pub value: f64,
    /// Unit.
    pub unit: String,
}

impl Row for ConstantRow {
    type Record = (String, f64, String);

    fn columns() -> Vec<Column> {
        vec![
            Column::text("name").key(),
            Column::number("value", "see the column unit", 1e-30, 1e30),
            Column::text("unit"),
        ]
    }

    fn from_record((name, value, unit): Self::Record) -> Self {
        Self { name, value, unit }
    }
}

/// The constants of 1976 that the equations need.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Constants {
    /// Effective radius r_0 of the Earth, m.
    pub earth_radius: f64,
    /// Standard gravity g_0, m s^-2 (and m^2 s^-2 per geopotential metre).
    pub gravity: f64,
    /// Gas constant R*, J kmol^-1 K^-1.
    pub gas_constant: f64,
    /// Mean molar mass of air at sea level M_0, kg kmol^-1.
    pub molar_mass: f64,
    /// Pressure at sea level P_0, Pa.
    pub pressure: f64,
    /// Avogadro constant N_A, kmol^-1.
    pub avogadro: f64,
    /// Number density N_s of air at 288.15 K and 1013.25 hPa to which refractive indices
    /// refer, m^-3 (the value of Bucholtz 1995).
    pub standard_number_density: f64,
}

impl Constants {
    fn from_rows(source: &Source<ConstantRow>) -> Result<Self, RawError> {
        let find = |name: &str, unit: &str| {
            let wrong = |found: String| {
                let expected = format!("a constant {name} in {unit}");
                RawError::new(&source.provenance.file, Fault::Unexpected { expected, found })
            };
            let row = source.rows.iter().find(|row| row.name == name).ok_or_else(|| wrong("none".into()))?;
            if row.unit == unit { Ok(row.value) } else { Err(wrong(format!("it in {}", row.unit))) }
        };
        Ok(Self {
            earth_radius: find("effective_earth_radius", "km")? * KM,
            gravity: find("sea_level_gravity", "m s^-2")?,
            gas_constant: find("gas_constant", "J kmol^-1 K^-1")?,
            molar_mass: find("sea_level_molar_mass", "kg kmol^-1")?,
            pressure: find("sea_level_pressure", "Pa")?,
            avogadro: find("avogadro_1976", "kmol^-1")?,
            standard_number_density: find("loschmidt_288_15K_1013_25hPa_bucholtz", "m^-3")?,
        })
    }
}
