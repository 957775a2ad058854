//! An ozone profile of one's own: a sonde, completed by the climatology of its month and latitude.
//!
//! Below the first level the mixing ratio holds down to the ground; above the last, the profile of the climatology,
//! multiplied so that the density is continuous there.

use super::sheet::{Order, Schema, Sheet};
use super::units::Quantity;
use super::{Import, OwnError, range};
use crate::build::air::texts;
use crate::build::{self, field};
use crate::profile::ozone::{altitude_of_pressure, trapezoidal};
use crate::profile::standard_atmosphere::StandardAtmosphere;
use crate::raw::{RawData, RawError};
use tables::units::{DOBSON_UNIT_M2, KM, TOP_ALTITUDE_M};
use tables::views::{ALTITUDE, LATITUDE, MONTH, OzoneProfile, OzoneProfiles};
use tables::{Axis, Kind, Outside, Provenance, Table};

const SCHEMA: Schema = Schema {
    quantities: &[
        Quantity::Altitude,
        Quantity::GeopotentialAltitude,
        Quantity::Pressure,
        Quantity::Temperature,
        Quantity::OzonePressure,
        Quantity::OzoneMixingRatio,
        Quantity::OzoneDensity,
    ],
    words: None,
    sorted_by: &[
        (Quantity::Altitude, Order::Up),
        (Quantity::GeopotentialAltitude, Order::Up),
        (Quantity::Pressure, Order::Down),
    ],
    remedy: "keep the ascent alone, each level once, from the ground upwards",
    most_rows: 100_000,
};

/// A factor on the climatology beyond which it is worth a word.
const SUSPICIOUS: f64 = 2.0;

/// Levels of ozone.
#[derive(Debug, Clone, PartialEq)]
pub struct Sonde {
    sheet: Sheet,
    ozone: Quantity,
}

/// How a sonde is completed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Completion {
    /// Month, 1 to 12.
    pub month: u8,
    /// Latitude in degrees, north positive, -90 to 90.
    pub latitude_deg: f64,
    /// Whether the altitudes are geopotential, whatever their column is called.
    pub geopotential: bool,
    /// Column in Dobson units, 1 to 1000, to which the whole profile is scaled at the end.
    pub column_du: Option<f64>,
}

impl Sonde {
    /// Reads the bytes of a file called `name`: altitude (m, km) or pressure (Pa, hPa, mbar, kPa) or both; one of
    /// partial pressure (mPa, nbar), mixing ratio by volume (ppmv, ppbv) and number density (m^-3, cm^-3); possibly the
    /// temperature (K, C). Columns called as one of `ignored` are left out.
    ///
    /// # Errors
    /// [`RawError`] with the file, line and column of the first thing that is wrong.
    pub fn parse(name: &str, bytes: &[u8], ignored: &[String]) -> Result<Self, RawError> {
        let sheet = Sheet::parse(name, bytes, ignored, &SCHEMA)?;
        let (ozone, _) =
            sheet.one_of(&[Quantity::OzonePressure, Quantity::OzoneMixingRatio, Quantity::OzoneDensity])?;
        let heights = [Quantity::Altitude, Quantity::GeopotentialAltitude];
        if heights.iter().any(|q| sheet.column(*q).is_some()) {
            sheet.one_of(&heights)?;
        } else if sheet.column(Quantity::Pressure).is_none() {
            sheet.one_of(&[Quantity::Altitude, Quantity::GeopotentialAltitude, Quantity::Pressure])?;
        }
        if sheet.rows() < 2 {
            return Err(sheet.wrong("two levels at least", "one"));
        }
        Ok(Self { sheet, ozone })
    }

    /// Geometric altitudes (m) and number densities (m^-3) of its levels from the ground up.
    ///
    /// Pressure alone stands for the altitude at which the standard atmosphere has it; below the sea level of the
    /// standard, it is continued as isothermal. What the file lacks of pressure and temperature is the standard's.
    fn levels(&self, standard: &StandardAtmosphere, geopotential: bool) -> Result<Vec<(f64, f64)>, OwnError> {
        let sheet = &self.sheet;
        let pressures = sheet.column(Quantity::Pressure);
        let temperatures = sheet.column(Quantity::Temperature);
        let geometric = sheet.column(Quantity::Altitude);
        let heights = geometric.or(sheet.column(Quantity::GeopotentialAltitude));
        let ozone = sheet.column(self.ozone).unwrap_or_default();
        let constants = standard.constants();
        let mut levels: Vec<(f64, f64)> = Vec::with_capacity(sheet.rows());
        for (row, &amount) in ozone.iter().enumerate() {
            let z = match (heights, pressures) {
                (Some(heights), _) if geopotential || geometric.is_none() => standard.geometric(heights[row]),
                (Some(heights), _) => heights[row],
                (None, Some(pressures)) => altitude_of_pressure(standard, pressures[row])?,
                (None, None) => return Err(sheet.wrong("a column of altitude or pressure", "none").into()),
            };
            if z > TOP_ALTITUDE_M {
                let expected = format!("an altitude of at most {} km", TOP_ALTITUDE_M / KM);
                let quantity = sheet.one_of(&[Quantity::GeopotentialAltitude, Quantity::Altitude])?.0;
                return Err(sheet.wrong_at(row, quantity, expected, format!("{:.3} km", z / KM)).into());
            }
            let usual = standard.at(z.max(0.0))?;
            let pressure = pressures.map_or(usual.pressure, |p| p[row]);
            let temperature = temperatures.map_or(usual.temperature, |t| t[row]);
            let per_pascal = constants.avogadro / (constants.gas_constant * temperature);
            let density = match self.ozone {
                Quantity::OzonePressure => amount * per_pascal,
                Quantity::OzoneMixingRatio => amount * pressure * per_pascal,
                _ => amount,
            };
            if levels.last().is_some_and(|(below, _)| *below >= z) {
                let expected = format!("a level above that of line {}", sheet.line(row - 1));
                return Err(sheet.wrong_at(row, Quantity::Pressure, expected, format!("{z:.2} m")).into());
            }
            levels.push((z, density));
        }
        // A station below the sea level of the standard: what is at 0 lies between two levels.
        let under = levels.iter().filter(|(z, _)| *z < 0.0).count();
        if under > 0 {
            let [(z, n), (z1, n1)] = match levels.get(under - 1..=under) {
                Some(&[a, b]) => [a, b],
                _ => return Err(sheet.wrong("a level above the sea", "none").into()),
            };
            levels.drain(..under);
            if z1 > 0.0 {
                levels.insert(0, (0.0, n + (n1 - n) * -z / (z1 - z)));
            }
        }
        Ok(levels)
    }
}

/// The table of a sonde: one profile for every month and latitude, from 0 to 120 km.
///
/// # Errors
/// [`OwnError`] for a month, latitude or column out of range, or a sonde without ozone at its top.
pub fn table(sonde: &Sonde, raw: &RawData, completion: Completion) -> Result<Import, OwnError> {
    let Completion { month, latitude_deg, geopotential, column_du } = completion;
    range("month", month.into(), 1.0, 12.0, "")?;
    range("latitude", latitude_deg, -90.0, 90.0, " degrees")?;
    column_du.map_or(Ok(()), |column| range("column", column, 1.0, 1000.0, " DU"))?;
    let standard = StandardAtmosphere::new(&raw.atmosphere)?;
    let climatology_table = build::table(raw, Kind::OzoneProfiles)?;
    let OzoneProfile { number_density_m3: climatology, column_du: usual } =
        OzoneProfiles::from_table(&climatology_table)?.profile(month, latitude_deg)?;

    let measured = sonde.levels(&standard, geopotential)?;
    let (&(first, lowest), &(last, highest)) = match (measured.first(), measured.last()) {
        (Some(first), Some(last)) => (first, last),
        _ => return Err(sonde.sheet.wrong("a level above the sea", "none").into()),
    };
    let factor = highest / climatology.at(last)?;
    if factor.is_nan() || factor <= 0.0 {
        let row = sonde.sheet.rows() - 1;
        return Err(sonde
            .sheet
            .wrong_at(row, sonde.ozone, "ozone at the last level, where it is continued", "none")
            .into());
    }
    let ratio = lowest / standard.at(first)?.number_density;
    let (mut altitudes, mut densities) = (Vec::new(), Vec::new());
    let nodes = &climatology.axis().nodes;
    for &z in nodes.iter().filter(|z| **z < first) {
        altitudes.push(z);
        densities.push(ratio * standard.at(z)?.number_density);
    }
    altitudes.extend(measured.iter().map(|(z, _)| *z));
    densities.extend(measured.iter().map(|(_, n)| *n));
    for &z in nodes.iter().filter(|z| **z > last) {
        altitudes.push(z);
        densities.push(factor * climatology.at(z)?);
    }
    let whole = trapezoidal(&altitudes, &densities);
    let (heights, numbers): (Vec<f64>, Vec<f64>) = measured.iter().copied().unzip();
    let sounded = trapezoidal(&heights, &numbers);
    let scale = column_du.map_or(1.0, |column| column * DOBSON_UNIT_M2 / whole);
    densities.iter_mut().for_each(|n| *n *= scale);
    let column = scale * whole / DOBSON_UNIT_M2;

    let place = format!("month {month}, latitude {latitude_deg}");
    let levels = format!("{} from {:.3} to {:.3} km", measured.len(), first / KM, last / KM);
    let mut notes = vec![
        format!("ozone column {column:.2} DU, of which the levels hold {:.2} DU", scale * sounded / DOBSON_UNIT_M2),
        format!("levels {levels}; above, the climatology of {place} ({usual:.1} DU) times {factor:.3}"),
    ];
    if !(1.0 / SUSPICIOUS..=SUSPICIOUS).contains(&factor) {
        notes.push(format!("warning: suspicious, the climatology is multiplied by {factor:.3} to meet the last level"));
    }
    if column_du.is_some() {
        notes.push(format!("all of it scaled by {scale:.4} to the column asked for"));
    }
    let has = |quantity: Quantity| sonde.sheet.column(quantity).is_some();
    let altitude = match () {
        () if has(Quantity::GeopotentialAltitude) || (has(Quantity::Altitude) && geopotential) => {
            "geopotential as given, made geometric with r_0 = 6356.766 km"
        }
        () if has(Quantity::Altitude) => "geometric as given",
        () => "where the standard atmosphere has the pressure given",
    };
    let given = |quantity| if has(quantity) { "as given" } else { "of the standard atmosphere" };
    let above = format!("climatology of {place}, times {factor:.4}");
    let scaled = format!("{scale:.6}");
    let settings = [
        ("levels", levels.as_str()),
        ("altitude", altitude),
        ("temperature", given(Quantity::Temperature)),
        ("pressure", given(Quantity::Pressure)),
        ("ozone", sonde.ozone.what()),
        ("below the first level", "its mixing ratio, with the air of the standard atmosphere"),
        ("above the last level", above.as_str()),
        ("scaled by", scaled.as_str()),
        ("month and latitude", "any: there is one profile"),
    ];
    let hold =
        |(name, unit): (&str, &str), node: f64| Axis::new(name, unit, vec![node]).map(|a| a.beyond(Outside::Hold));
    let over = [MONTH.0, LATITUDE.0, ALTITUDE.0];
    let mut provenance: Vec<Provenance> = vec![sonde.sheet.provenance.clone()];
    provenance.extend(climatology_table.provenance);
    let table = Table {
        kind: Kind::OzoneProfiles,
        title: format!("Ozone: {}", sonde.sheet.provenance.title),
        axes: vec![
            hold(MONTH, month.into())?,
            hold(LATITUDE, latitude_deg)?,
            Axis::new(ALTITUDE.0, ALTITUDE.1, altitudes)?,
        ],
        fields: vec![
            field("number_density", "m^-3", &over, 0.0, densities),
            field("column", "DU", &over[..2], 0.0, vec![column]),
        ],
        settings: texts(&settings),
        provenance,
    };
    Ok(Import { table, notes })
}
