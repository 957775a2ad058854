//! Figures of ozone.

use super::colours;
use super::model::{Axis, Cells, Curve, Figure, Key, Panel};
use super::{MONTHS, Plot, PlotError, Settings, against_km, latitude};
use crate::data::Data;
use crate::frame::Frame;

/// Altitude in km above which there is too little ozone to show.
const TOP_KM: f64 = 60.0;

/// Centres of the latitude bands in degrees, and half of their width.
const BANDS: std::ops::RangeInclusive<i32> = 0..=17;
const HALF_BAND_DEG: f64 = 5.0;

/// Ozone number density against altitude in each month at one latitude.
pub(super) fn months(data: Data<'_>, settings: &Settings) -> Result<Plot, PlotError> {
    let ozone = data.ozone_profiles()?;
    let mut curves = Vec::new();
    let mut columns: Vec<(String, Vec<f64>)> = Vec::new();
    for (month, name) in (1..=12).zip(MONTHS) {
        let profile = ozone.profile(month, settings.latitude_deg)?;
        let density = &profile.number_density_m3;
        let altitudes = &density.axis().nodes;
        if columns.is_empty() {
            columns.push(("altitude_m".into(), altitudes.clone()));
        }
        columns.push((format!("number_density_{}_m3", name.to_lowercase()), density.values().to_vec()));
        // In units of 1e18, which keeps powers out of the axis.
        let scaled: Vec<f64> = density.values().iter().map(|v| v / 1e18).collect();
        let name = format!("{name}, {:.0} DU", profile.column_du);
        curves.push(Curve::new(name, colours::month(month), against_km(&scaled, altitudes)));
    }
    let highest = curves.iter().flat_map(|curve| &curve.points).map(|point| point.0).fold(1.0, f64::max);
    let panel = Panel::new(
        Axis::linear("number density of ozone / 10¹⁸ m⁻³", 0.0, highest.ceil(), 1.0),
        Axis::linear("altitude / km", 0.0, TOP_KM, 10.0),
        curves,
    );
    let title = format!("Ozone by month at {}", latitude(settings.latitude_deg));
    Ok(Plot { figure: Figure { title, rows: vec![vec![panel.key(Key::Beside)]] }, frame: Frame::new(columns)? })
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
    let title = "Ozone column by month and latitude (1 DU = 2.6868 × 10²⁰ m⁻²)".into();
    Ok(Plot { figure: Figure { title, rows: vec![vec![panel]] }, frame: Frame::new(columns)? })
}
