//! A solar spectrum of one's own.

use super::sheet::{Order, Schema, Sheet};
use super::units::Quantity;
use super::{Import, OwnError};
use crate::build::{field, light};
use crate::raw::{self, RawError};
use tables::Provenance;
use tables::units::WAVELENGTH_RANGE_NM;
use tables::views::WAVELENGTH;

const SCHEMA: Schema = Schema {
    quantities: &[Quantity::Wavelength, Quantity::Irradiance],
    words: None,
    sorted_by: &[(Quantity::Wavelength, Order::Up)],
    remedy: "give each wavelength once, shortest first",
    most_rows: 2_000_000,
};

/// Spectral irradiance at 1 au against (vacuum) wavelength.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// The file.
    pub provenance: Provenance,
    /// Wavelengths, nm.
    pub wavelengths_nm: Vec<f64>,
    /// Irradiance, W m^-2 nm^-1.
    pub irradiance: Vec<f64>,
}

impl Spectrum {
    /// Reads the bytes of a file called `name`: a column of wavelength (nm, um) and one of irradiance (W, mW or
    /// photons s^-1 per m^2 and nm, W per m^2 and um, photons s^-1 per cm^2 and nm), from 300 nm or less to 1000 nm or
    /// more. Columns called as one of `ignored` are left out.
    ///
    /// # Errors
    /// [`RawError`] with the file, line and column of the first thing that is wrong.
    pub fn parse(name: &str, bytes: &[u8], ignored: &[String]) -> Result<Self, RawError> {
        let sheet = Sheet::parse(name, bytes, ignored, &SCHEMA)?;
        let (_, wavelengths) = sheet.one_of(&[Quantity::Wavelength])?;
        let (_, irradiance) = sheet.one_of(&[Quantity::Irradiance])?;
        covers(&sheet, wavelengths)?;
        if irradiance.iter().all(|&value| value == 0.0) {
            return Err(sheet.wrong("a sun that shines", "no irradiance above 0"));
        }
        Ok(Self { wavelengths_nm: wavelengths.to_vec(), irradiance: irradiance.to_vec(), provenance: sheet.provenance })
    }
}

/// Refuses wavelengths that do not reach over those of the tables: nothing is extrapolated.
pub(super) fn covers(sheet: &Sheet, wavelengths_nm: &[f64]) -> Result<(), RawError> {
    let (low, high) = WAVELENGTH_RANGE_NM;
    let (first, last) = (wavelengths_nm[0], wavelengths_nm[wavelengths_nm.len() - 1]);
    if first <= low && last >= high {
        return Ok(());
    }
    Err(sheet.wrong(
        format!("wavelengths over all of {low} to {high} nm, since nothing is extrapolated"),
        format!("{first} to {last} nm"),
    ))
}

/// The table of the spectrum, at its own wavelengths from the last below 300 nm to the first above 1000 nm, with the
/// limb darkening of `raw`.
///
/// # Errors
/// [`OwnError`] if the spectrum makes no table.
pub fn table(spectrum: &Spectrum, raw: &raw::sun::Sun) -> Result<Import, OwnError> {
    let (low, high) = WAVELENGTH_RANGE_NM;
    let all = &spectrum.wavelengths_nm;
    let first = all.partition_point(|&nm| nm <= low).saturating_sub(1);
    let last = all.partition_point(|&nm| nm < high).min(all.len() - 1);
    let (wavelengths, values) = (all[first..=last].to_vec(), spectrum.irradiance[first..=last].to_vec());
    let pairs = wavelengths.windows(2).zip(values.windows(2));
    let visible = pairs.filter(|(nm, _)| nm[0] >= low && nm[1] <= high);
    let total: f64 = visible.map(|(nm, e)| 0.5 * (nm[1] - nm[0]) * (e[0] + e[1])).sum();
    let note = format!(
        "{} wavelengths from {} to {} nm kept, {total:.1} W/m2 between {low} and {high} nm",
        wavelengths.len(),
        wavelengths[0],
        wavelengths[wavelengths.len() - 1]
    );
    // As given, to the last bit.
    let irradiance = field("irradiance", "W m^-2 nm^-1", &[WAVELENGTH.0], 0.0, values);
    let title = format!("Solar irradiance: {}", spectrum.provenance.title);
    let table = light::sun_of(&title, (wavelengths, irradiance), &spectrum.provenance, &raw.limb_darkening)?;
    Ok(Import { table, notes: vec![note] })
}
