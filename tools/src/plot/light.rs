//! Figures of the sun.

use super::colours::{ORANGE, viridis};
use super::grids::points;
use super::model::{Axis, Curve, Figure, Key, Panel};
use super::{Plot, PlotError};
use crate::data::Data;
use crate::frame::Frame;
use tables::TableError;
use tables::units::WAVELENGTH_RANGE_NM;

/// Wavelengths in nm of the limb darkening shown.
const LIMB_NM: [f64; 5] = [320.0, 400.0, 500.0, 700.0, 1000.0];

/// Tenths of mu that the CSV holds.
const TENTHS: std::ops::RangeInclusive<u8> = 0..=10;

/// Irradiance above the atmosphere, and intensity across the disc.
pub(super) fn sun(data: Data<'_>) -> Result<Plot, PlotError> {
    let sun = data.sun()?;
    let nm = &sun.irradiance_w_m2_nm.axis().nodes;
    let irradiance = sun.irradiance_w_m2_nm.values();
    // I(mu) / I(1), the sum of a_i mu^i.
    let relative = |wavelength_nm: f64, mu: f64| -> Result<f64, TableError> {
        Ok(sun.limb_coefficients(wavelength_nm)?.iter().rev().fold(0.0, |sum, a| sum * mu + a))
    };
    let mut limb = Vec::new();
    for (i, wavelength_nm) in LIMB_NM.into_iter().enumerate() {
        let across = (0..=200).map(|i| f64::from(i) / 200.0);
        let profile = across.map(|r| Ok((r, relative(wavelength_nm, (1.0 - r * r).max(0.0).sqrt())?)));
        let colour = viridis(0.92 * i as f64 / (LIMB_NM.len() - 1) as f64);
        limb.push(Curve::new(format!("{wavelength_nm} nm"), colour, profile.collect::<Result<_, TableError>>()?));
    }
    // As the lines end in the key: the longest wavelength is the brightest at the limb.
    limb.reverse();
    let spectrum = Panel::new(
        Axis::linear("wavelength / nm", WAVELENGTH_RANGE_NM.0, WAVELENGTH_RANGE_NM.1, 100.0),
        Axis::linear("spectral irradiance at 1 au / W m⁻² nm⁻¹", 0.0, 2.4, 0.4),
        vec![Curve::new("", ORANGE, points(nm, irradiance))],
    )
    .key(Key::None);
    let disc = Panel::new(
        Axis::linear("distance from the centre / radius of the disc", 0.0, 1.0, 0.2),
        Axis::linear("intensity / intensity at the centre", 0.0, 1.0, 0.2),
        limb,
    )
    .key(Key::BottomLeft);
    let mut columns =
        vec![("wavelength_nm".to_owned(), nm.clone()), ("irradiance_w_m2_nm".to_owned(), irradiance.to_vec())];
    for tenth in TENTHS {
        let mu = f64::from(tenth) / 10.0;
        let values = nm.iter().map(|&w| relative(w, mu)).collect::<Result<_, _>>()?;
        columns.push((format!("relative_intensity_mu_{mu:.1}"), values));
    }
    let title = "The sun above the atmosphere";
    let rows = vec![vec![spectrum.share(1.35), disc]];
    Ok(Plot { figure: Figure::new(title, rows), frame: Frame::new(columns)? })
}
