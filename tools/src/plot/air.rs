//! Figures of air.

use super::colours::{BLUE, GREEN, VERMILION};
use super::model::{Axis, Curve, Figure, Key, Panel};
use super::{Plot, PlotError, against_km};
use crate::data::Data;
use crate::frame::Frame;
use tables::units::{KM, TOP_ALTITUDE_M};

/// Number density N, pressure p and temperature T of the standard atmosphere, 0 to 120 km.
pub(super) fn number_density(data: Data<'_>) -> Result<Plot, PlotError> {
    let air = data.air()?;
    let altitudes = &air.number_density_m3.axis().nodes;
    let (density, pressure, temperature) =
        (air.number_density_m3.values(), air.pressure_pa.values(), air.temperature_k.values());
    let altitude = |label: &str| Axis::linear(label, 0.0, TOP_ALTITUDE_M / KM, 20.0);
    let panel = |x: Axis, values: &[f64], colour| {
        Panel::new(x, altitude("altitude / km"), vec![Curve::new("", colour, against_km(values, altitudes))])
            .key(Key::None)
    };
    let figure = Figure {
        title: "US Standard Atmosphere 1976".into(),
        rows: vec![vec![
            panel(Axis::logarithmic("number density of molecules / m⁻³", 1e16, 1e26, 2), density, BLUE).share(1.35),
            panel(Axis::logarithmic("pressure / Pa", 1e-4, 1e6, 2), pressure, VERMILION),
            panel(Axis::linear("temperature / K", 150.0, 400.0, 50.0), temperature, GREEN),
        ]],
    };
    let frame = Frame::new([
        ("altitude_m", altitudes.clone()),
        ("number_density_m3", density.to_vec()),
        ("pressure_pa", pressure.to_vec()),
        ("temperature_k", temperature.to_vec()),
    ])?;
    Ok(Plot { figure, frame })
}
