//! A profile of air of one's own: a radiosonde, a model's column.
//!
//! Between levels the temperature is linear in the geopotential altitude, and the logarithm of the pressure goes
//! as the hydrostatic equation has it for that temperature, stretched to meet both levels.
//!
//! Beyond the levels the standard atmosphere takes over, by its departures from them. With T_s, p_s of the standard:
//!
//! - below the first level z_1 (a station above the sea), T = T_s + (T(z_1) - T_s(z_1));
//! - above the last level z_n, T = T_s + w (T(z_n) - T_s(z_n)), w falling linearly from 1 to 0 over 20 km;
//! - p = q p_s, q continuous at the levels and d ln q / dz = -(g M / R*) (1/T - 1/T_s), g = g_0 (r_0 / (r_0 + z))^2,
//!   M the molar mass in the standard: since the standard is hydrostatic, so is this;
//! - N = N_s q T_s / T.

use super::sheet::{Order, Schema, Sheet};
use super::units::Quantity;
use super::{Import, OwnError};
use crate::build::air;
use crate::profile::standard_atmosphere::{Air, StandardAtmosphere};
use crate::raw::RawError;
use crate::raw::us_standard_atmosphere::UsStandardAtmosphere;
use tables::units::{KM, TOP_ALTITUDE_M};
use tables::views::ALTITUDE;
use tables::{Axis, Kind, Provenance, Table, TableError};

const SCHEMA: Schema = Schema {
    quantities: &[
        Quantity::Altitude,
        Quantity::GeopotentialAltitude,
        Quantity::Pressure,
        Quantity::Temperature,
        Quantity::AirDensity,
    ],
    words: None,
    sorted_by: &[(Quantity::Altitude, Order::Up), (Quantity::GeopotentialAltitude, Order::Up)],
    remedy: "keep the ascent alone, each level once, from the ground upwards",
    most_rows: 100_000,
};

/// Boltzmann's constant, J/K (SI 2019, exact).
const BOLTZMANN: f64 = 1.380_649e-23;

/// How far p and N k T may differ, relative.
const IDEAL_GAS: f64 = 0.01;

/// Above the last level the departure of the temperature fades over this height, m.
const FADE: f64 = 20.0 * KM;

/// The least thickness, m, of the layers in which the hydrostatic equation is checked: rounded pressures of close levels
/// say nothing.
const THICKNESS: f64 = 2.0 * KM;

/// Up to here air is mixed, so that its molar mass is known to the check, m.
const MIXED: f64 = 80.0 * KM;

/// Relative departures of a layer from the hydrostatic equation that are worth a word, and that are refused. Moist air
/// makes 1 %.
const SUSPICIOUS: f64 = 0.02;
const IMPOSSIBLE: f64 = 0.1;

/// The pressure may be so many times that of the standard atmosphere, or one so-manieth.
const STANDARD_FACTOR: f64 = 2.0;

/// Levels of air.
#[derive(Debug, Clone, PartialEq)]
pub struct Sounding {
    sheet: Sheet,
    geopotential: bool,
    altitudes: Vec<f64>,
    temperatures: Vec<f64>,
    pressures: Vec<f64>,
}

impl Sounding {
    /// Reads the bytes of a file called `name`: altitude (m, km; 0 to 120 km), temperature (K, C), and pressure (Pa,
    /// hPa, mbar, kPa) or number density (m^-3, cm^-3) or both, two levels at least. Columns called as one of
    /// `ignored` are left out.
    ///
    /// The altitude is geometric unless its name or `geopotential` says otherwise. Without a pressure, p = N k T; with
    /// all three, p must be N k T within 1 %, and p and T are taken.
    ///
    /// # Errors
    /// [`RawError`] with the file, line and column of the first thing that is wrong.
    pub fn parse(name: &str, bytes: &[u8], ignored: &[String], geopotential: bool) -> Result<Self, RawError> {
        let sheet = Sheet::parse(name, bytes, ignored, &SCHEMA)?;
        let (altitude, altitudes) = sheet.one_of(&[Quantity::Altitude, Quantity::GeopotentialAltitude])?;
        let (_, temperatures) = sheet.one_of(&[Quantity::Temperature])?;
        let densities = sheet.column(Quantity::AirDensity);
        let pressures = match (sheet.column(Quantity::Pressure), densities) {
            (Some(pressures), None) => pressures.to_vec(),
            (Some(pressures), Some(densities)) => {
                for (row, ((p, n), t)) in pressures.iter().zip(densities).zip(temperatures).enumerate() {
                    let ideal = n * BOLTZMANN * t;
                    if (p / ideal - 1.0).abs() > IDEAL_GAS {
                        let expected = format!("N k T = {ideal:.5e} Pa within {} %", 100.0 * IDEAL_GAS);
                        return Err(sheet.wrong_at(row, Quantity::Pressure, expected, format!("{p:.5e} Pa")));
                    }
                }
                pressures.to_vec()
            }
            (None, Some(densities)) => densities.iter().zip(temperatures).map(|(n, t)| n * BOLTZMANN * t).collect(),
            (None, None) => sheet.one_of(&[Quantity::Pressure, Quantity::AirDensity])?.1.to_vec(),
        };
        if sheet.rows() < 2 {
            return Err(sheet.wrong("two levels at least", "one"));
        }
        if let Some(row) = pressures.windows(2).position(|pair| pair[0] <= pair[1]) {
            let expected = format!("less pressure than in line {}", sheet.line(row));
            let found = format!("{:.5e} Pa after {:.5e} Pa", pressures[row + 1], pressures[row]);
            return Err(sheet.wrong_at(row + 1, Quantity::Pressure, expected, found));
        }
        Ok(Self {
            geopotential: geopotential || altitude == Quantity::GeopotentialAltitude,
            altitudes: altitudes.to_vec(),
            temperatures: temperatures.to_vec(),
            pressures,
            sheet,
        })
    }

    /// Where it comes from.
    #[must_use]
    pub fn provenance(&self) -> &Provenance {
        &self.sheet.provenance
    }
}

/// A sounding completed from 0 to 120 km by the rules of this module.
#[derive(Debug, Clone)]
pub struct Completed<'a> {
    standard: &'a StandardAtmosphere,
    altitudes: Vec<f64>,
    temperatures: Vec<f64>,
    pressures: Vec<f64>,
    /// ln q at nodes below the first level, upwards, the last of them that level.
    below: Vec<(f64, f64)>,
    /// ln q at nodes above the last level, the first of them that level.
    above: Vec<(f64, f64)>,
    hydrostatic: Departure,
}

/// The largest departure of a layer from the hydrostatic equation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Departure {
    /// ln(p_1 / p_2) over (g_0 M_0 / R*) times the integral of dH / T, less 1.
    pub relative: f64,
    /// Lines of the file between which it is.
    pub lines: (u32, u32),
}

impl<'a> Completed<'a> {
    /// Completes the sounding.
    ///
    /// # Errors
    /// [`RawError`] if a pressure is not between half and twice that of the standard atmosphere, or a layer of 2 km
    /// departs by more than 10 % from the hydrostatic equation; [`TableError`] if altitudes are out of range.
    pub fn new(sounding: &Sounding, standard: &'a StandardAtmosphere) -> Result<Self, OwnError> {
        let mut altitudes = sounding.altitudes.clone();
        if sounding.geopotential {
            altitudes.iter_mut().for_each(|z| *z = standard.geometric(*z));
            if let Some(row) = altitudes.iter().position(|z| *z > TOP_ALTITUDE_M) {
                let error = sounding.sheet.wrong_at(
                    row,
                    Quantity::GeopotentialAltitude,
                    format!("a geopotential altitude of at most {:.0} m'", standard.geopotential(TOP_ALTITUDE_M)),
                    format!("{} m'", sounding.altitudes[row]),
                );
                return Err(error.into());
            }
        }
        for (row, (&z, &p)) in altitudes.iter().zip(&sounding.pressures).enumerate() {
            let usual = standard.at(z)?.pressure;
            if !(usual / STANDARD_FACTOR..=usual * STANDARD_FACTOR).contains(&p) {
                let expected = format!(
                    "{:.4e} to {:.4e} Pa at {z:.0} m, half to twice the standard atmosphere",
                    usual / STANDARD_FACTOR,
                    usual * STANDARD_FACTOR
                );
                return Err(sounding.sheet.wrong_at(row, Quantity::Pressure, expected, format!("{p:.4e} Pa")).into());
            }
        }
        let mut completed = Self {
            standard,
            altitudes,
            temperatures: sounding.temperatures.clone(),
            pressures: sounding.pressures.clone(),
            below: Vec::new(),
            above: Vec::new(),
            hydrostatic: Departure { relative: 0.0, lines: (0, 0) },
        };
        completed.hydrostatic = completed.check(&sounding.sheet)?;
        completed.extend()?;
        Ok(completed)
    }

    /// Compares layers of 2 km, or all of a shorter sounding, with the hydrostatic equation.
    fn check(&self, sheet: &Sheet) -> Result<Departure, OwnError> {
        let constants = self.standard.constants();
        let per_kelvin = constants.gravity * constants.molar_mass / constants.gas_constant;
        let mut worst = Departure { relative: 0.0, lines: (sheet.line(0), sheet.line(0)) };
        let mixed = self.altitudes.partition_point(|&z| z <= MIXED);
        let (mut from, mut expected) = (0, 0.0);
        for row in 1..mixed {
            let rise = self.geopotential(row) - self.geopotential(row - 1);
            let (cold, warm) = (self.temperatures[row - 1], self.temperatures[row]);
            expected += per_kelvin * rise / logarithmic_mean(cold, warm);
            let short = self.altitudes[row] - self.altitudes[from] < THICKNESS;
            if short && !(from == 0 && row + 1 == mixed) {
                continue;
            }
            let relative = (self.pressures[from] / self.pressures[row]).ln() / expected - 1.0;
            if relative.abs() > worst.relative.abs() {
                worst = Departure { relative, lines: (sheet.line(from), sheet.line(row)) };
            }
            (from, expected) = (row, 0.0);
        }
        if worst.relative.abs() <= IMPOSSIBLE {
            return Ok(worst);
        }
        let (first, last) = worst.lines;
        Err(sheet
            .wrong(
                format!("pressures that fall as the weight of the air between, within {} %", 100.0 * IMPOSSIBLE),
                format!("{:+.1} % from line {first} to line {last}", 100.0 * worst.relative),
            )
            .into())
    }

    fn geopotential(&self, level: usize) -> f64 {
        self.standard.geopotential(self.altitudes[level])
    }

    /// Integrates ln q downwards and upwards from the ends of the sounding.
    fn extend(&mut self) -> Result<(), OwnError> {
        let last = self.altitudes.len() - 1;
        let (low, high) = (self.altitudes[0], self.altitudes[last]);
        let start = |level: usize| -> Result<(f64, f64), TableError> {
            let z = self.altitudes[level];
            Ok((z, (self.pressures[level] / self.standard.at(z)?.pressure).ln()))
        };
        let (mut below, mut above) = (vec![start(0)?], vec![start(last)?]);
        let nodes = air::altitudes(self.standard, &[]);
        for (nodes, chain) in [
            (nodes.iter().rev().filter(|z| **z < low).collect::<Vec<_>>(), &mut below),
            (nodes.iter().filter(|z| **z > high).collect(), &mut above),
        ] {
            for &z in nodes {
                let (from, ln_q) = chain[chain.len() - 1];
                chain.push((z, ln_q + self.change(from, z)?));
            }
        }
        below.reverse();
        (self.below, self.above) = (below, above);
        Ok(())
    }

    /// Change of ln q from one altitude to another by Simpson's rule: over 250 m it is exact to some 1e-9.
    fn change(&self, from: f64, to: f64) -> Result<f64, TableError> {
        let slope = |z: f64| -> Result<f64, TableError> {
            let constants = self.standard.constants();
            let standard = self.standard.at(z)?;
            let fall = constants.earth_radius / (constants.earth_radius + z);
            let molar_mass = standard.mass_density / standard.number_density * constants.avogadro;
            let weight = constants.gravity * fall * fall * molar_mass / constants.gas_constant;
            Ok(-weight * (1.0 / self.outer_temperature(z)? - 1.0 / standard.temperature))
        };
        Ok((to - from) / 6.0 * (slope(from)? + 4.0 * slope(0.5 * (from + to))? + slope(to)?))
    }

    /// Temperature below the first and above the last level.
    fn outer_temperature(&self, z: f64) -> Result<f64, TableError> {
        let last = self.altitudes.len() - 1;
        let low = z <= self.altitudes[0];
        let level = if low { 0 } else { last };
        let departure = self.temperatures[level] - self.standard.at(self.altitudes[level])?.temperature;
        let weight = if low { 1.0 } else { (1.0 - (z - self.altitudes[last]) / FADE).max(0.0) };
        Ok(self.standard.at(z)?.temperature + weight * departure)
    }

    /// Air at the geometric altitude z in m, from 0 to 120 km.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside.
    pub fn at(&self, z: f64) -> Result<Air, TableError> {
        let standard = self.standard.at(z)?;
        let last = self.altitudes.len() - 1;
        let (temperature, pressure) = if z < self.altitudes[0] {
            let node = self.below[self.below.partition_point(|(node, _)| *node < z)];
            (self.outer_temperature(z)?, standard.pressure * (node.1 + self.change(node.0, z)?).exp())
        } else if z > self.altitudes[last] {
            let node = self.above[self.above.partition_point(|(node, _)| *node <= z) - 1];
            (self.outer_temperature(z)?, standard.pressure * (node.1 + self.change(node.0, z)?).exp())
        } else {
            self.inner(z)
        };
        let number_density =
            standard.number_density * (pressure / standard.pressure) * (standard.temperature / temperature);
        let mass_density = standard.mass_density * number_density / standard.number_density;
        Ok(Air { temperature, pressure, mass_density, number_density })
    }

    /// Temperature and pressure between levels.
    fn inner(&self, z: f64) -> (f64, f64) {
        let i = (self.altitudes.partition_point(|&level| level <= z) - 1).min(self.altitudes.len() - 2);
        let (cold, warm) = (self.temperatures[i], self.temperatures[i + 1]);
        let (low, high) = (self.geopotential(i), self.geopotential(i + 1));
        let f = (self.standard.geopotential(z) - low) / (high - low);
        let temperature = cold + f * (warm - cold);
        let risen = f * logarithmic_mean(cold, warm) / logarithmic_mean(cold, temperature);
        (temperature, self.pressures[i] * (self.pressures[i + 1] / self.pressures[i]).powf(risen))
    }

    /// The largest departure from the hydrostatic equation in layers of 2 km.
    #[must_use]
    pub fn hydrostatic(&self) -> Departure {
        self.hydrostatic
    }
}

/// (b - a) / ln(b / a): the mean temperature that the hydrostatic equation asks for where it goes linearly from a to b.
fn logarithmic_mean(a: f64, b: f64) -> f64 {
    let relative = (b - a) / a;
    // The series where the quotient would lose digits: its next term is relative^3 / 24.
    if relative.abs() < 1e-4 { a * (1.0 + relative / 2.0 - relative * relative / 12.0) } else { (b - a) / (b / a).ln() }
}

/// The table of a sounding, completed to 120 km; see this module for the rules.
///
/// # Errors
/// As [`Completed::new`].
pub fn table(sounding: &Sounding, raw: &UsStandardAtmosphere) -> Result<Import, OwnError> {
    let standard = StandardAtmosphere::new(raw)?;
    let completed = Completed::new(sounding, &standard)?;
    let axis = Axis::new(ALTITUDE.0, ALTITUDE.1, air::altitudes(&standard, &completed.altitudes))?;
    let fields = air::profile(&axis, |z| completed.at(z), &raw.extension.rows)?;
    let (low, high) = (completed.altitudes[0] / KM, completed.altitudes[completed.altitudes.len() - 1] / KM);
    let Departure { relative, lines: (first, last) } = completed.hydrostatic();
    let departure = format!("{:+.2} % between lines {first} and {last}", 100.0 * relative);
    let levels = format!("{} from {low:.3} to {high:.3} km", completed.altitudes.len());
    let altitude = if sounding.geopotential {
        "geopotential as given, made geometric with r_0 = 6356.766 km"
    } else {
        "geometric as given"
    };
    let density = match (sounding.sheet.column(Quantity::Pressure), sounding.sheet.column(Quantity::AirDensity)) {
        (Some(_), Some(_)) => "p / (k T); the one given agrees within 1 %",
        (None, _) => "as given, p = N k T",
        (Some(_), None) => "p / (k T)",
    };
    let settings = [
        ("levels", levels.as_str()),
        ("altitude", altitude),
        ("number density", density),
        ("between levels", "temperature linear in geopotential altitude, pressure hydrostatic in shape through both"),
        ("below the first level", "standard atmosphere with the departure of temperature there; hydrostatic"),
        (
            "above the last level",
            "standard atmosphere with the departure of temperature there, which fades over 20 km; hydrostatic",
        ),
        ("largest departure of 2 km from the hydrostatic equation", departure.as_str()),
    ];
    let mut notes = vec![format!("levels {levels}, the standard atmosphere's departures beyond")];
    let word = if relative.abs() > SUSPICIOUS { "warning: suspicious, " } else { "" };
    notes.push(format!("{word}largest departure from the hydrostatic equation {departure}"));
    let mut provenance = vec![sounding.provenance().clone()];
    provenance.extend(air::provenance(raw));
    let table = Table {
        kind: Kind::StandardAtmosphere,
        title: format!("Air: {}", sounding.provenance().title),
        axes: vec![axis],
        fields,
        settings: air::texts(&settings),
        provenance,
    };
    Ok(Import { table, notes })
}
