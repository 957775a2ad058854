//! Figures of how air and ozone scatter and absorb.

use super::colours::{BLACK, BLUE, GREEN, ORANGE, VERMILION};
use super::model::{Axis, Curve, Figure, Key, Panel, Stroke};
use super::{Plot, PlotError, Settings, against_km, points};
use crate::column::{Column, Place, Species};
use crate::data::Data;
use crate::frame::Frame;
use tables::TableError;
use tables::units::{TOP_ALTITUDE_M, WAVELENGTH_RANGE_NM};

/// Temperatures in K at which the cross-section of ozone is shown: warm, and the stratosphere's.
const TEMPERATURES_K: [f64; 2] = [293.0, 223.0];

/// Step in m of the altitudes at which coefficients are shown.
const STEP_M: u32 = 100;

/// Whole wavelengths in nm from one end of the tables to the other.
fn wavelengths() -> Vec<f64> {
    let (low, high) = WAVELENGTH_RANGE_NM;
    (low.ceil() as u32..=high.floor() as u32).map(f64::from).collect()
}

fn wavelength_axis() -> Axis {
    Axis::linear("wavelength / nm", WAVELENGTH_RANGE_NM.0, WAVELENGTH_RANGE_NM.1, 100.0)
}

/// Rayleigh scattering and ozone absorption cross-sections against wavelength.
pub(super) fn cross_sections(data: Data<'_>) -> Result<Plot, PlotError> {
    let (rayleigh, ozone) = (data.rayleigh()?, data.ozone_cross_section()?);
    let nm = wavelengths();
    let scattering: Vec<f64> = nm.iter().map(|&w| rayleigh.cross_section_m2.at(w)).collect::<Result<_, _>>()?;
    let absorption = |kelvin: f64| nm.iter().map(|&w| ozone.cross_section_m2(w, kelvin)).collect::<Result<Vec<_>, _>>();
    let (warm, cold) = (absorption(TEMPERATURES_K[0])?, absorption(TEMPERATURES_K[1])?);
    let curves = vec![
        Curve::new("ozone, absorption, 293 K", VERMILION, points(&nm, &warm)),
        Curve::new("ozone, absorption, 223 K", ORANGE, points(&nm, &cold)).stroke(Stroke::Dashed),
        Curve::new("air, Rayleigh scattering", BLUE, points(&nm, &scattering)),
    ];
    let panel =
        Panel::new(wavelength_axis(), Axis::logarithmic("cross-section of a molecule / m²", 1e-32, 1e-22, 1), curves);
    let frame = Frame::new([
        ("wavelength_nm", nm),
        ("rayleigh_scattering_m2", scattering),
        ("ozone_absorption_293k_m2", warm),
        ("ozone_absorption_223k_m2", cold),
    ])?;
    let title = "Cross-sections of molecules".into();
    Ok(Plot { figure: Figure { title, rows: vec![vec![panel]] }, frame })
}

/// Altitudes in m from the ground to the top.
fn altitudes() -> Vec<f64> {
    (0..=TOP_ALTITUDE_M as u32 / STEP_M).map(|i| f64::from(i * STEP_M)).collect()
}

fn column(data: Data<'_>, settings: &Settings) -> Result<Column, TableError> {
    let place = Place { month: settings.month, latitude_deg: settings.latitude_deg, ..Place::default() };
    Column::read(data, &place)
}

/// Scattering, absorption and extinction coefficients against altitude at one wavelength.
pub(super) fn against_altitude(data: Data<'_>, settings: &Settings) -> Result<Plot, PlotError> {
    let (column, z) = (column(data, settings)?, altitudes());
    let at = |species: Species| -> Result<Vec<f64>, TableError> {
        let value = |&z| Ok(column.coefficients(species, settings.wavelength_nm, z)?.extinction());
        z.iter().map(value).collect()
    };
    let species = [
        ("scattering by molecules", "molecular_scattering_per_m", BLUE, at(Species::Molecules)?),
        ("absorption by ozone", "ozone_absorption_per_m", VERMILION, at(Species::Ozone)?),
    ];
    let extinction = sums(species.iter().map(|(_, _, _, values)| values), z.len());
    let mut curves = vec![Curve::new("extinction", BLACK, against_km(&extinction, &z)).stroke(Stroke::Dashed)];
    let mut columns = vec![("altitude_m", z.clone())];
    for (name, column, colour, values) in species {
        curves.insert(curves.len() - 1, Curve::new(name, colour, against_km(&values, &z)));
        columns.push((column, values));
    }
    columns.push(("extinction_per_m", extinction));
    // Six decades below the power of ten above the largest value.
    let top = 10_f64.powf(curves.iter().flat_map(|c| &c.points).map(|p| p.0).fold(1e-9, f64::max).log10().ceil());
    let panel = Panel::new(
        Axis::logarithmic("coefficient / m⁻¹", top * 1e-6, top, 1),
        Axis::linear("altitude / km", 0.0, 80.0, 10.0),
        curves,
    );
    let title = format!("Coefficients at {} nm, {}", settings.wavelength_nm, settings.place());
    Ok(Plot { figure: Figure { title, rows: vec![vec![panel]] }, frame: Frame::new(columns)? })
}

/// Vertical optical depth against wavelength.
pub(super) fn optical_depth(data: Data<'_>, settings: &Settings) -> Result<Plot, PlotError> {
    let column = column(data, settings)?;
    let nm = wavelengths();
    let depths = |species: Species| -> Result<Vec<f64>, TableError> {
        let value = |&w| Ok(column.optical_depth(species, w, (0.0, TOP_ALTITUDE_M))?.extinction());
        nm.iter().map(value).collect()
    };
    let (molecules, ozone) = (depths(Species::Molecules)?, depths(Species::Ozone)?);
    let total = sums([&molecules, &ozone], nm.len());
    let transmittance: Vec<f64> = total.iter().map(|depth| (-depth).exp()).collect();
    let panel = Panel::new(
        wavelength_axis(),
        Axis::logarithmic("vertical optical depth", 1e-5, 1e1, 1),
        vec![
            Curve::new("scattering by molecules", BLUE, points(&nm, &molecules)),
            Curve::new("absorption by ozone", VERMILION, points(&nm, &ozone)),
            Curve::new("total", BLACK, points(&nm, &total)).stroke(Stroke::Dashed),
        ],
    );
    let below = Panel::new(
        wavelength_axis(),
        Axis::linear("vertical transmittance", 0.0, 1.0, 0.2),
        vec![Curve::new("", GREEN, points(&nm, &transmittance))],
    )
    .key(Key::None);
    let title = format!("From the ground to 120 km, {}, {:.0} DU of ozone", settings.place(), column.ozone_du());
    let frame = Frame::new([
        ("wavelength_nm", nm),
        ("molecular_scattering", molecules),
        ("ozone_absorption", ozone),
        ("total", total),
        ("transmittance", transmittance),
    ])?;
    Ok(Plot { figure: Figure { title, rows: vec![vec![panel.share(1.3), below]] }, frame })
}

/// Sums, value by value.
fn sums<'a>(parts: impl IntoIterator<Item = &'a Vec<f64>>, length: usize) -> Vec<f64> {
    let mut sum = vec![0.0; length];
    for part in parts {
        for (total, value) in sum.iter_mut().zip(part) {
            *total += value;
        }
    }
    sum
}
