//! Figures of air.

use super::colours::{BLACK, BLUE, GREEN, VERMILION};
use super::grids::{against_km, dotted};
use super::model::{Axis, Curve, Figure, Key, Panel, Stroke};
use super::{Plot, PlotError, Settings};
use crate::data::Data;
use crate::frame::Frame;
use crate::study::thesis::{self, Thesis};
use tables::TableError;
use tables::units::{KM, TOP_ALTITUDE_M};

/// Number density N, pressure p and temperature T of the standard atmosphere, 0 to 120 km, and how far those of the
/// thesis are from them.
pub(super) fn number_density(data: Data<'_>, settings: &Settings, thesis: Option<&Thesis>) -> Result<Plot, PlotError> {
    let air = data.air()?;
    let altitudes = &air.number_density_m3.axis().nodes;
    let (density, pressure, temperature) =
        (air.number_density_m3.values(), air.pressure_pa.values(), air.temperature_k.values());
    let unit = settings.units.density();
    let mut columns = vec![
        settings.units.altitude().column("altitude", altitudes),
        unit.column("number_density", density),
        ("pressure_pa".into(), pressure.to_vec()),
        ("temperature_k".into(), temperature.to_vec()),
    ];
    let altitude = || Axis::linear("altitude / km", 0.0, TOP_ALTITUDE_M / KM, 20.0);
    let panel = |x: Axis, values: &[f64], colour| {
        Panel::new(x, altitude(), vec![Curve::new("", colour, against_km(values, altitudes))]).key(Key::None)
    };
    let label = format!("number density of molecules / {}", unit.sign);
    let factor = unit.factor;
    let mut panels = vec![
        panel(Axis::logarithmic(&label, 1e16 * factor, 1e26 * factor, 2), &unit.of(density), BLUE),
        panel(Axis::logarithmic("pressure / Pa", 1e-4, 1e6, 2), pressure, VERMILION),
        panel(Axis::linear("temperature / K", 150.0, 400.0, 50.0), temperature, GREEN),
    ];
    let title = "Air: US Standard Atmosphere 1976";
    let Some(thesis) = thesis else {
        return Ok(Plot { figure: Figure::new(title, vec![panels]), frame: Frame::new(columns)? });
    };
    let had = |value: &dyn Fn(f64) -> Result<f64, TableError>| -> Result<Vec<f64>, TableError> {
        altitudes.iter().map(|&z| if z > thesis::TOP_M { Ok(f64::NAN) } else { value(z) }).collect()
    };
    let molecules = had(&|z| thesis.molecules_m3(z))?;
    let others = [had(&|z| thesis.pressure_pa(z))?, had(&|z| thesis.temperature_k(z))?];
    columns.push(unit.column("thesis_number_density", &molecules));
    for (panel, values) in panels.iter_mut().zip([&unit.of(&molecules), &others[0], &others[1]]) {
        let points = against_km(values, altitudes);
        panel.curves.push(Curve::new("", BLACK, points).stroke(Stroke::Dotted));
    }
    let departure: Vec<f64> = molecules.iter().zip(density).map(|(had, is)| 100.0 * (had / is - 1.0)).collect();
    let [pressure, temperature] = others;
    columns.extend([("thesis_pressure_pa".into(), pressure), ("thesis_temperature_k".into(), temperature)]);
    columns.push(("thesis_number_density_departure_percent".into(), departure.clone()));
    let error = Curve::new("", BLACK, against_km(&departure, altitudes)).stroke(Stroke::Dotted);
    let label = "departure of the thesis' number density / %";
    panels.push(Panel::new(Axis::linear(label, -25.0, 5.0, 5.0), altitude(), vec![error]).key(Key::None));
    let lower = panels.split_off(2);
    let figure = Figure::new(title, vec![panels, lower]).key(vec![Curve { colour: BLACK, ..dotted() }]);
    Ok(Plot { figure, frame: Frame::new(columns)? })
}
