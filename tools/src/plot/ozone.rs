//! Figures of ozone.

use super::colours;
use super::grids::{self, against_km, with_thesis_layers};
use super::model::{Axis, Cells, Curve, Figure, Key, Panel, Stroke};
use super::settings::{MONTHS, Units, latitude};
use super::{Plot, PlotError, Settings};
use crate::data::Data;
use crate::frame::Frame;
use crate::study::thesis::Thesis;

/// Altitude in km above which there is too little ozone to show.
const TOP_KM: f64 = 60.0;

/// Centres of the latitude bands in degrees, and half of their width.
const BANDS: std::ops::RangeInclusive<i32> = 0..=17;
const HALF_BAND_DEG: f64 = 5.0;

/// Ozone number density against altitude in each month at one latitude, and on a logarithmic axis beside that of the
/// thesis, which is the same at every latitude.
pub(super) fn months(data: Data<'_>, settings: &Settings, thesis: Option<&Thesis>) -> Result<Plot, PlotError> {
    let ozone = data.ozone_profiles()?;
    let unit = settings.units.density();
    let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
    let (mut curves, mut dotted, mut altitudes) = (Vec::new(), Vec::new(), Vec::new());
    for (month, name) in (1..=12).zip(MONTHS) {
        let profile = ozone.profile(month, settings.place.latitude_deg)?;
        if columns.is_empty() {
            altitudes = with_thesis_layers(profile.number_density_m3.axis().nodes.clone());
            columns.push(settings.units.altitude().column("altitude", &altitudes));
        }
        let density: Vec<f64> = altitudes.iter().map(|&z| profile.number_density_m3.at(z)).collect::<Result<_, _>>()?;
        let lower = name.to_lowercase();
        columns.push(unit.column(&format!("number_density_{lower}"), &density));
        let key = format!("{name}, {:.0} DU", profile.column_du);
        curves.push(Curve::new(key, colours::month(month), against_km(&unit.of(&density), &altitudes)));
        if let Some(thesis) = thesis {
            let had: Vec<f64> = altitudes.iter().map(|&z| thesis.ozone_m3(month, z)).collect::<Result<_, _>>()?;
            let curve = Curve::new("", colours::month(month), against_km(&unit.of(&had), &altitudes));
            dotted.push(((format!("thesis_number_density_{lower}"), had), curve.stroke(Stroke::Dotted)));
        }
    }
    // In units of 1e18 m^-3, which keeps powers out of the axis.
    let scale = 1e18 * unit.factor;
    let scaled = curves.iter().map(|curve| Curve {
        points: curve.points.iter().map(|&(n, z)| (n / scale, z)).collect(),
        name: if thesis.is_some() { String::new() } else { curve.name.clone() },
        ..curve.clone()
    });
    let scaled: Vec<Curve> = scaled.collect();
    let highest = scaled.iter().flat_map(|curve| &curve.points).map(|point| point.0).fold(1.0, f64::max);
    let altitude = || Axis::linear("altitude / km", 0.0, TOP_KM, 10.0);
    let power = if settings.units == Units::Si { "10¹⁸" } else { "10²⁷" };
    let label = format!("number density of ozone / {power} {}", unit.sign);
    let linear = Panel::new(Axis::linear(&label, 0.0, highest.ceil(), 1.0), altitude(), scaled).key(Key::Beside);
    let place = latitude(settings.place.latitude_deg);
    let title = format!("Ozone by month at {place}");
    if thesis.is_none() {
        return Ok(Plot { figure: Figure::new(title, vec![vec![linear]]), frame: Frame::new(columns)? });
    }
    for ((name, values), curve) in dotted {
        columns.push(unit.column(&name, &values));
        curves.push(curve);
    }
    curves.push(grids::dotted());
    let label = format!("number density of ozone / {}", unit.sign);
    let axis = Axis::logarithmic(&label, 1e16 * unit.factor, 1e20 * unit.factor, 1);
    let logarithmic = Panel::new(axis, altitude(), curves).key(Key::Beside);
    let rows = vec![vec![linear.key(Key::None), logarithmic]];
    let title = format!("{title}; thesis: Arosa, 47° N, times 10.5");
    Ok(Plot { figure: Figure::new(title, rows), frame: Frame::new(columns)? })
}

/// Ozone column by month and latitude.
pub(super) fn latitudes(data: Data<'_>) -> Result<Plot, PlotError> {
    let ozone = data.ozone_profiles()?;
    let bands: Vec<f64> = BANDS.map(|band| f64::from(10 * band - 85)).collect();
    let mut values = Vec::new();
    let mut columns = vec![("latitude_deg".to_owned(), bands.clone())];
    for (month, name) in (1..=12).zip(MONTHS) {
        let mut column_du = Vec::new();
        for &band in &bands {
            let column = ozone.profile(month, band)?.column_du;
            let m = f64::from(month);
            values.push(((m - 0.5, band - HALF_BAND_DEG, m + 0.5, band + HALF_BAND_DEG), column));
            column_du.push(column);
        }
        columns.push((format!("column_{}_du", name.to_lowercase()), column_du));
    }
    let month_names = (1..=12).zip(MONTHS).map(|(m, name)| (f64::from(m), name.chars().take(3).collect())).collect();
    let degrees = (-3..=3).map(|i| (f64::from(30 * i), latitude(f64::from(30 * i)))).collect();
    let panel = Panel {
        cells: Some(Cells::new(Axis::linear("ozone column / DU", 150.0, 450.0, 50.0), values)),
        ..Panel::new(
            Axis::linear("month", 0.5, 12.5, 1.0).named(month_names),
            Axis::linear("latitude", -90.0, 90.0, 30.0).named(degrees),
            Vec::new(),
        )
    };
    let title = "Ozone column by month and latitude (1 DU = 2.6868 × 10²⁰ m⁻²)";
    Ok(Plot { figure: Figure::new(title, vec![vec![panel]]), frame: Frame::new(columns)? })
}
