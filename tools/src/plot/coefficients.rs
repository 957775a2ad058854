//! Figures of how air, ozone and aerosols scatter and absorb.

use super::colours::{BLACK, BLUE, GREEN, ORANGE, PURPLE, VERMILION};
use super::grids::{against_km, altitudes, decades, dotted, points, wavelength_axis, wavelengths};
use super::model::{Axis, Curve, Figure, Key, Panel, Stroke};
use super::settings::words;
use super::{Plot, PlotError, Settings};
use crate::column::{Column, Parts, Species};
use crate::data::Data;
use crate::frame::Frame;
use crate::study::thesis::Thesis;
use tables::TableError;
use tables::views::Biome;

/// Temperatures in K at which the cross-section of ozone is shown: warm, and the stratosphere's.
const TEMPERATURES_K: [f64; 2] = [293.0, 223.0];

/// Rayleigh scattering and ozone absorption cross-sections against wavelength, and what those of the thesis are over
/// them.
pub(super) fn cross_sections(data: Data<'_>, settings: &Settings, thesis: Option<&Thesis>) -> Result<Plot, PlotError> {
    let (rayleigh, ozone) = (data.rayleigh()?, data.ozone_cross_section()?);
    let nm = wavelengths();
    let unit = settings.units.cross_section();
    let along = |value: &dyn Fn(f64) -> Result<f64, TableError>| -> Result<Vec<f64>, TableError> {
        nm.iter().map(|&w| value(w)).collect()
    };
    let scattering = along(&|w| rayleigh.cross_section_m2.at(w))?;
    let [warm, cold] = TEMPERATURES_K.map(|kelvin| along(&|w| ozone.cross_section_m2(w, kelvin)));
    let (warm, cold) = (warm?, cold?);
    let curve = |name: &str, colour, values: &[f64]| Curve::new(name, colour, points(&nm, &unit.of(values)));
    let mut curves = vec![
        curve("ozone, absorption, 293 K", VERMILION, &warm),
        curve("ozone, absorption, 223 K", ORANGE, &cold).stroke(Stroke::Dashed),
        curve("air, Rayleigh scattering", BLUE, &scattering),
    ];
    let mut columns = vec![
        ("wavelength_nm".to_owned(), nm.clone()),
        unit.column("rayleigh_scattering", &scattering),
        unit.column("ozone_absorption_293k", &warm),
        unit.column("ozone_absorption_223k", &cold),
    ];
    let mut row = Vec::new();
    if let Some(thesis) = thesis {
        let (air, ozone) = (along(&|w| thesis.rayleigh_m2(w))?, along(&|w| thesis.ozone_m2(w))?);
        columns
            .extend([unit.column("thesis_rayleigh_scattering", &air), unit.column("thesis_ozone_absorption", &ozone)]);
        curves.push(curve("", BLUE, &air).stroke(Stroke::Dotted));
        curves.push(curve("", VERMILION, &ozone).stroke(Stroke::Dotted));
        curves.push(dotted());
        let ratio = |had: &[f64], is: &[f64]| had.iter().zip(is).map(|(a, b)| a / b).collect::<Vec<_>>();
        let ratios = vec![
            Curve::new("ozone, 293 K", VERMILION, points(&nm, &ratio(&ozone, &warm))).stroke(Stroke::Dotted),
            Curve::new("air", BLUE, points(&nm, &ratio(&air, &scattering))).stroke(Stroke::Dotted),
        ];
        let axis = Axis::logarithmic("thesis / tables", 1e-1, 1e3, 1);
        row.push(Panel::new(wavelength_axis(200.0), axis, ratios).share(0.6));
    }
    let label = format!("cross-section of a molecule / {}", unit.sign);
    let axis = Axis::logarithmic(&label, 1e-32 * unit.factor, 1e-22 * unit.factor, 1);
    row.insert(0, Panel::new(wavelength_axis(100.0), axis, curves));
    let title = "Cross-sections of molecules";
    Ok(Plot { figure: Figure::new(title, vec![row]), frame: Frame::new(columns)? })
}

/// Names, columns and colours of what is added up to extinction, in this order everywhere.
const SUMMANDS: [(&str, &str, super::model::Colour); 4] = [
    ("scattering by molecules", "molecular_scattering", BLUE),
    ("scattering by aerosol", "aerosol_scattering", GREEN),
    ("absorption by aerosol", "aerosol_absorption", PURPLE),
    ("absorption by ozone", "ozone_absorption", VERMILION),
];

/// The coefficients in m^-1 of [`SUMMANDS`] and their sum, against altitude.
type Profiles = [Vec<f64>; 5];

fn profiles(
    altitudes: &[f64],
    at: impl Fn(f64) -> Result<(f64, Parts, f64), TableError>,
) -> Result<Profiles, TableError> {
    let mut profiles = Profiles::default();
    for &z in altitudes {
        let (molecules, aerosol, ozone) = at(z)?;
        let values = [molecules, aerosol.scattering, aerosol.absorption, ozone];
        let sum = values.iter().sum();
        for (profile, value) in profiles.iter_mut().zip(values.into_iter().chain([sum])) {
            profile.push(value);
        }
    }
    Ok(profiles)
}

/// Scattering, absorption and extinction coefficients against altitude at one wavelength, with the aerosol of a
/// biome or in clear air: the whole atmosphere, and its lowest part.
pub(super) fn against_altitude(
    data: Data<'_>,
    settings: &Settings,
    thesis: Option<&Thesis>,
    biome: Option<Biome>,
) -> Result<Plot, PlotError> {
    let column = Column::read(data, &settings.with(biome))?;
    let (z, nm) = (altitudes(&column), settings.wavelength_nm);
    let ours = profiles(&z, |z| {
        let molecules = column.coefficients(Species::Molecules, nm, z)?.scattering;
        let ozone = column.coefficients(Species::Ozone, nm, z)?.absorption;
        Ok((molecules, column.aerosol_coefficients(nm, z)?, ozone))
    })?;
    let theirs = thesis.map(|thesis| {
        profiles(&z, |z| {
            let aerosol = match biome {
                Some(biome) => thesis.particle_m2(biome, nm)?.times(thesis.particles_m3(biome, z)?),
                None => Parts::default(),
            };
            let molecules = thesis.rayleigh_m2(nm)? * thesis.molecules_m3(z)?;
            Ok((molecules, aerosol, thesis.ozone_m2(nm)? * thesis.ozone_m3(settings.place.month, z)?))
        })
    });
    let theirs = theirs.transpose()?;

    let unit = settings.units.coefficient();
    let mut columns = vec![settings.units.altitude().column("altitude", &z)];
    let (mut curves, mut key) = (Vec::new(), Vec::new());
    let sum = ("extinction", "extinction", BLACK);
    for (prefix, profiles) in [("", Some(&ours)), ("thesis_", theirs.as_ref())] {
        for ((name, column, colour), values) in SUMMANDS.into_iter().chain([sum]).zip(profiles.into_iter().flatten()) {
            if values.iter().all(|value| *value == 0.0) {
                continue;
            }
            columns.push(unit.column(&format!("{prefix}{column}"), values));
            let stroke = match (prefix, name) {
                ("thesis_", _) => Stroke::Dotted,
                (_, "extinction") => Stroke::Dashed,
                _ => Stroke::Solid,
            };
            let curve = Curve::new("", colour, against_km(&unit.of(values), &z)).stroke(stroke);
            if prefix.is_empty() {
                key.push(Curve { name: name.into(), points: Vec::new(), ..curve.clone() });
            }
            curves.push(curve);
        }
    }
    if theirs.is_some() {
        key.push(dotted());
    }
    let label = format!("coefficient / {}", unit.sign);
    let all = ours.iter().chain(theirs.iter().flatten()).flatten().map(|v| v * unit.factor).collect::<Vec<_>>();
    // As many decades as make the highest six of what the tables hold visible.
    let low = decades(&label, &unit.of(&ours[4]), 6).range.0;
    let high = decades(&label, &all, 1).range.1;
    let panel = |top: f64, step: f64| {
        Panel::new(
            Axis::logarithmic(&label, low, high, 1),
            Axis::linear("altitude / km", 0.0, top, step),
            curves.clone(),
        )
        .key(Key::None)
    };
    let place = match biome {
        Some(biome) => format!("{} ({}), {}", words(biome), settings.aerosol([&column]), settings.season()),
        None => format!("clear air, {}", settings.season()),
    };
    let figure =
        Figure::new(format!("Coefficients at {nm} nm: {place}"), vec![vec![panel(90.0, 10.0), panel(15.0, 3.0)]]);
    Ok(Plot { figure: figure.key(key), frame: Frame::new(columns)? })
}
