//! Tables of the light source and the eye: values as published, on their own nodes.

use super::air::texts;
use super::field;
use crate::raw::sun::{COEFFICIENTS, LimbDarkening};
use crate::raw::{RawData, Source};
use tables::units::WAVELENGTH_RANGE_NM;
use tables::views::WAVELENGTH;
use tables::{Axis, Field, Interpolation, Kind, Outside, Provenance, Table, TableError};

/// Fields `irradiance` against wavelength and `limb_darkening` by wavelength and power.
pub(super) fn sun(raw: &RawData) -> Result<Table, TableError> {
    let (low, high) = WAVELENGTH_RANGE_NM;
    let inside = |wavelength_nm: f64| (low..=high).contains(&wavelength_nm);
    let (wavelengths, irradiance): (Vec<f64>, Vec<f64>) = raw
        .sun
        .spectrum
        .rows
        .iter()
        .filter(|row| inside(row.wavelength_nm))
        .map(|row| (row.wavelength_nm, row.irradiance))
        .unzip();
    let title = "Solar irradiance outside the atmosphere and limb darkening";
    // Published to 3 or 4 digits.
    let irradiance = field("irradiance", "W m^-2 nm^-1", &[WAVELENGTH.0], 1e-4, irradiance);
    sun_of(title, (wavelengths, irradiance), &raw.sun.spectrum.provenance, &raw.sun.limb_darkening)
}

/// The table of a solar spectrum, at wavelengths in nm, with measured limb darkening.
pub(crate) fn sun_of(
    title: &str,
    (wavelengths, irradiance): (Vec<f64>, Field),
    spectrum: &Provenance,
    limb_darkening: &Source<LimbDarkening>,
) -> Result<Table, TableError> {
    let limb = &limb_darkening.rows;
    let limb_wavelengths = limb.iter().map(|row| row.wavelength_nm).collect();
    let settings = [
        ("distance", "1 au"),
        (
            "limb darkening",
            "I(mu) / I(1) = sum of a_i mu^i, i the power; below the first wavelength its coefficients hold",
        ),
    ];
    Ok(Table {
        kind: Kind::Sun,
        title: title.into(),
        axes: vec![
            Axis::new(WAVELENGTH.0, WAVELENGTH.1, wavelengths)?,
            Axis::new("limb_wavelength", "nm", limb_wavelengths)?.beyond(Outside::Hold),
            Axis::uniform("power", "1", 0.0, 1.0, COEFFICIENTS)?.between(Interpolation::Node),
        ],
        fields: vec![
            irradiance,
            // Published to 5 decimals.
            field(
                "limb_darkening",
                "1",
                &["limb_wavelength", "power"],
                1e-5,
                limb.iter().flat_map(|row| row.coefficients).collect(),
            ),
        ],
        settings: texts(&settings),
        provenance: vec![spectrum.clone(), limb_darkening.provenance.clone()],
    })
}

/// Fields `x_bar`, `y_bar` and `z_bar` against wavelength, zero outside.
pub(super) fn observer(raw: &RawData) -> Result<Table, TableError> {
    let source = &raw.cie_1931.colour_matching;
    let wavelengths = source.rows.iter().map(|row| row.wavelength_nm).collect();
    // Published to 7 digits.
    let function =
        |name, i: usize| field(name, "1", &[WAVELENGTH.0], 1e-7, source.rows.iter().map(|row| row.xyz[i]).collect());
    Ok(Table {
        kind: Kind::Observer,
        title: "CIE 1931 colour-matching functions, 2 degrees".into(),
        axes: vec![Axis::new(WAVELENGTH.0, WAVELENGTH.1, wavelengths)?.beyond(Outside::Zero)],
        fields: vec![function("x_bar", 0), function("y_bar", 1), function("z_bar", 2)],
        settings: texts(&[]),
        provenance: vec![source.provenance.clone()],
    })
}
