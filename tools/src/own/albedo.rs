//! The albedo spectrum of a ground of one's own.

use super::sheet::{Order, Schema, Sheet};
use super::units::Quantity;
use super::{Import, OwnError};
use crate::build::air::texts;
use crate::build::field;
use crate::raw::RawError;
use tables::{Axis, Kind, Provenance, Table};

const SCHEMA: Schema = Schema {
    quantities: &[Quantity::Wavelength, Quantity::Albedo],
    words: None,
    sorted_by: &[(Quantity::Wavelength, Order::Up)],
    remedy: "give each wavelength once, shortest first",
    most_rows: 100_000,
};

/// Lambertian albedo against wavelength.
#[derive(Debug, Clone, PartialEq)]
pub struct Spectrum {
    /// The file.
    pub provenance: Provenance,
    /// Wavelengths, nm.
    pub wavelengths_nm: Vec<f64>,
    /// Albedo, 0 to 1.
    pub albedo: Vec<f64>,
}

impl Spectrum {
    /// Reads the bytes of a file called `name`: a column of wavelength (nm, um) and one of albedo (0 to 1, or
    /// `albedo_percent`). Columns called as one of `ignored` are left out.
    ///
    /// # Errors
    /// [`RawError`] with the file, line and column of the first thing that is wrong.
    pub fn parse(name: &str, bytes: &[u8], ignored: &[String]) -> Result<Self, RawError> {
        let sheet = Sheet::parse(name, bytes, ignored, &SCHEMA)?;
        let (_, wavelengths) = sheet.one_of(&[Quantity::Wavelength])?;
        let (_, albedo) = sheet.one_of(&[Quantity::Albedo])?;
        Ok(Self { wavelengths_nm: wavelengths.to_vec(), albedo: albedo.to_vec(), provenance: sheet.provenance })
    }
}

/// The table of one ground called `ground`: the spectrum on its own wavelengths, linear between them. Beyond them it
/// refuses: a picture that needs more wavelengths says so.
///
/// # Errors
/// [`OwnError::Refused`] for a name that is empty, a number (which would be a grey ground) or longer than 64 bytes.
pub fn table(spectrum: &Spectrum, ground: &str) -> Result<Import, OwnError> {
    if ground.trim().is_empty() || ground.len() > 64 || ground.parse::<f64>().is_ok() {
        let text = format!("a ground cannot be called {ground:?}: take a word of 1 to 64 bytes that is no number");
        return Err(OwnError::Refused(text));
    }
    let axis_name = format!("{ground} wavelength");
    let axis = Axis::new(&axis_name, "nm", spectrum.wavelengths_nm.clone())?;
    let (first, last) = axis.range();
    let table = Table {
        kind: Kind::GroundAlbedo,
        title: format!("Spectral albedo of {ground}: {}", spectrum.provenance.title),
        axes: vec![axis],
        // As given, to the last bit.
        fields: vec![field(ground, "1", &[&axis_name], 0.0, spectrum.albedo.clone())],
        settings: texts(&[("beyond the wavelengths", "refused")]),
        provenance: vec![spectrum.provenance.clone()],
    };
    let note = format!("ground {ground}: {} wavelengths from {first} to {last} nm", spectrum.wavelengths_nm.len());
    Ok(Import { table, notes: vec![note] })
}
