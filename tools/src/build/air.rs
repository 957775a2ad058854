//! Tables of air: the standard atmosphere and Rayleigh scattering.

use super::{field, largest_relative};
use crate::molecular::king;
use crate::molecular::rayleigh::Rayleigh;
use crate::profile::standard_atmosphere::{Air, StandardAtmosphere};
use crate::raw::RawData;
use crate::raw::us_standard_atmosphere::{Level, UsStandardAtmosphere};
use std::collections::BTreeMap;
use tables::units::{TOP_ALTITUDE_M, WAVELENGTH_RANGE_NM};
use tables::views::{ALTITUDE, WAVELENGTH};
use tables::{Axis, Curve, Field, Kind, Provenance, Scale, Table, TableError};

/// Step in m of the altitude axis.
const ALTITUDE_STEP: f64 = 250.0;

/// Fields `temperature`, `pressure` and `number_density` against altitude, at the nodes of [`altitudes`].
pub(super) fn standard_atmosphere(raw: &RawData) -> Result<Table, TableError> {
    let atmosphere = StandardAtmosphere::new(&raw.atmosphere)?;
    let axis = Axis::new(ALTITUDE.0, ALTITUDE.1, altitudes(&atmosphere, &[]))?;
    let fields = profile(&axis, |z| atmosphere.at(z), &raw.atmosphere.extension.rows)?;
    let settings = [
        ("altitude", "geometric; geopotential by the radius of 6356.766 km of the standard"),
        ("below 86 km", "defining layers; molar-mass ratio from 80 km"),
        ("from 86 km", "table with a step of 1 km; its pressure is high by 0.01 % at 90 km to 1.3 % at 120 km"),
    ];
    Ok(Table {
        kind: Kind::StandardAtmosphere,
        title: "US Standard Atmosphere 1976 from 0 to 120 km".into(),
        axes: vec![axis],
        fields,
        settings: texts(&settings),
        provenance: provenance(&raw.atmosphere),
    })
}

/// What the standard atmosphere is made from.
pub(crate) fn provenance(raw: &UsStandardAtmosphere) -> Vec<Provenance> {
    vec![
        raw.layers.provenance.clone(),
        raw.constants.provenance.clone(),
        raw.molar_mass.provenance.clone(),
        raw.extension.provenance.clone(),
    ]
}

/// Altitudes in m every 250 m from 0 to 120 km, the bases of the layers, where the gradient of temperature jumps, and
/// those of `more`.
pub(crate) fn altitudes(atmosphere: &StandardAtmosphere, more: &[f64]) -> Vec<f64> {
    let steps = (TOP_ALTITUDE_M / ALTITUDE_STEP) as u32;
    let mut nodes: Vec<f64> = (0..=steps).map(|i| f64::from(i) * ALTITUDE_STEP).collect();
    nodes.extend(atmosphere.layer_bases());
    nodes.extend(more);
    nodes.sort_by(f64::total_cmp);
    nodes.dedup();
    nodes
}

/// The fields of a profile of air, with their interpolation errors: the largest half-way between nodes, or between
/// the tabulated `levels` that the profile rests on.
pub(crate) fn profile(
    axis: &Axis,
    at: impl Fn(f64) -> Result<Air, TableError>,
    levels: &[Level],
) -> Result<Vec<Field>, TableError> {
    let air: Vec<Air> = axis.nodes.iter().map(|&z| at(z)).collect::<Result<_, _>>()?;
    let make = |name, unit, scale, of_air: fn(&Air) -> f64, of_level: fn(&Level) -> f64| -> Result<Field, TableError> {
        let values: Vec<f64> = air.iter().map(of_air).collect();
        let curve = Curve::new(axis.clone(), scale, values.clone())?;
        let halves = between_nodes(&axis.nodes, |z| Ok((curve.at(z)?, of_air(&at(z)?))))?;
        let error = largest_relative(halves).max(error_of_levels(levels, scale, of_level));
        Ok(Field { scale, interpolation_error: Some(error), ..field(name, unit, &[ALTITUDE.0], error, values) })
    };
    Ok(vec![
        make("temperature", "K", Scale::Linear, |a| a.temperature, |l| l.temperature)?,
        make("pressure", "Pa", Scale::Logarithmic, |a| a.pressure, |l| l.pressure)?,
        make("number_density", "m^-3", Scale::Logarithmic, |a| a.number_density, |l| l.number_density)?,
    ])
}

/// Pairs of what `f` gives half-way between the nodes.
fn between_nodes(
    nodes: &[f64],
    f: impl Fn(f64) -> Result<(f64, f64), TableError>,
) -> Result<Vec<(f64, f64)>, TableError> {
    nodes.windows(2).map(|pair| f(0.5 * (pair[0] + pair[1]))).collect()
}

/// Error of interpolating between the levels of a table: a quarter of what interpolation over two
/// steps misses the level between them by, since the error goes with the square of the step.
fn error_of_levels(levels: &[Level], scale: Scale, value: fn(&Level) -> f64) -> f64 {
    let over_two_steps = levels.windows(3).map(|l| (scale.between(value(&l[0]), value(&l[2]), 0.5), value(&l[1])));
    largest_relative(over_two_steps.map(|(a, b)| (b + 0.25 * (a - b), b)))
}

/// Fields `cross_section`, `king_factor` and `gamma` against wavelength, every nm.
pub(super) fn rayleigh(raw: &RawData) -> Result<Table, TableError> {
    let air = Rayleigh::new(&raw.bucholtz, raw.atmosphere.values.standard_number_density)?;
    let (low, high) = WAVELENGTH_RANGE_NM;
    let axis = Axis::uniform(WAVELENGTH.0, WAVELENGTH.1, low, 1.0, (high - low) as usize + 1)?;
    let cross_section: Vec<f64> = axis.nodes.iter().map(|&w| air.cross_section(w)).collect::<Result<_, _>>()?;
    let king_factor: Vec<f64> = axis.nodes.iter().map(|&w| air.king_factor().at(w)).collect::<Result<_, _>>()?;
    let gamma = king_factor.iter().map(|&f| king::gamma(king::depolarisation(f))).collect();

    let curve = Curve::new(axis.clone(), Scale::Logarithmic, cross_section.clone())?;
    let error = largest_relative(between_nodes(&axis.nodes, |w| Ok((curve.at(w)?, air.cross_section(w)?)))?);
    let over = [WAVELENGTH.0];
    // The rows of the King factor are its nodes too, and both lie on whole nm: nothing is lost
    // between them. They are rounded to 0.001.
    let king_error = 5e-4;
    let departure = air.compare(&raw.bucholtz.cross_section.rows)?;
    let settings = [
        ("formula", "Lorentz and Lorenz, as in Bucholtz 1995".to_owned()),
        ("refractive index", "Peck and Reeder 1972, four parameters".to_owned()),
        (
            "number density at 288.15 K and 1013.25 hPa",
            format!("{:e} m^-3", raw.atmosphere.values.standard_number_density),
        ),
        ("largest relative departure from Bucholtz' table 2", format!("{:.1e}", departure.largest)),
    ];
    Ok(Table {
        kind: Kind::Rayleigh,
        title: "Rayleigh scattering by a molecule of air".into(),
        axes: vec![axis],
        fields: vec![
            Field {
                scale: Scale::Logarithmic,
                interpolation_error: Some(error),
                ..field("cross_section", "m^2", &over, error, cross_section)
            },
            field("king_factor", "1", &over, king_error, king_factor),
            field("gamma", "1", &over, king_error, gamma),
        ],
        settings: settings.into_iter().map(|(key, value)| (key.to_owned(), value)).collect(),
        provenance: vec![raw.bucholtz.king_factor.provenance.clone(), raw.atmosphere.constants.provenance.clone()],
    })
}

/// Settings from pairs of texts.
pub(crate) fn texts(pairs: &[(&str, &str)]) -> BTreeMap<String, String> {
    pairs.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
}
