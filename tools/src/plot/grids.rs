//! Where figures ask the tables, and axes that fit the answers.

use super::colours::{BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION};
use super::model::{Axis, Colour, Curve, Stroke};
use crate::column::{Column, Species};
use crate::study::thesis;
use tables::units::{KM, TOP_ALTITUDE_M, WAVELENGTH_RANGE_NM};

/// Step in m of the altitudes shown.
const STEP_M: f64 = 500.0;

/// How far in m below and above a jump a profile is asked.
const BESIDE_M: f64 = 1.0;

/// Up to this wavelength in nm every nm is asked, for the bands of ozone.
const DENSE_UP_TO_NM: f64 = 360.0;

/// Step in nm beyond, for what is smooth there.
const SPARSE_NM: f64 = 5.0;

/// Altitudes in m from the ground to the top, and just below and above the ends of the aerosol's layers and of those
/// of the thesis, where profiles jump.
pub(super) fn altitudes(column: &Column) -> Vec<f64> {
    let mut ends = vec![thesis::TOP_M];
    for species in column.aerosols() {
        let (low, high) = column.density(species).axis().range();
        ends.extend([low, high]);
    }
    let steps = (0..=(TOP_ALTITUDE_M / STEP_M) as u32).map(|i| f64::from(i) * STEP_M);
    with_jumps(steps.collect(), ends.into_iter().chain(thesis_layers()))
}

/// `altitudes` in m with those where the layers of the thesis' ozone jump.
pub(super) fn with_thesis_layers(altitudes: Vec<f64>) -> Vec<f64> {
    with_jumps(altitudes, thesis_layers())
}

/// Bounds in m between the thesis' layers of ozone.
fn thesis_layers() -> impl Iterator<Item = f64> {
    (1..=6).map(|i| f64::from(i) * 9.0 * KM)
}

fn with_jumps(mut altitudes: Vec<f64>, jumps: impl IntoIterator<Item = f64>) -> Vec<f64> {
    for jump in jumps.into_iter().filter(|z| *z > 0.0 && *z < TOP_ALTITUDE_M) {
        altitudes.retain(|z| (z - jump).abs() > BESIDE_M);
        altitudes.extend([jump - BESIDE_M, jump + BESIDE_M]);
    }
    altitudes.sort_by(f64::total_cmp);
    altitudes
}

/// Whole wavelengths in nm from one end of the tables to the other.
pub(super) fn wavelengths() -> Vec<f64> {
    let (low, high) = WAVELENGTH_RANGE_NM;
    (low.ceil() as u32..=high.floor() as u32).map(f64::from).collect()
}

/// Fewer wavelengths in nm, for what is smooth beyond the bands of ozone.
pub(super) fn sparse_wavelengths() -> Vec<f64> {
    wavelengths().into_iter().filter(|nm| *nm <= DENSE_UP_TO_NM || nm % SPARSE_NM == 0.0).collect()
}

/// The axis of wavelengths with a number every `step` nm.
pub(super) fn wavelength_axis(step: f64) -> Axis {
    Axis::linear("wavelength / nm", WAVELENGTH_RANGE_NM.0, WAVELENGTH_RANGE_NM.1, step)
}

/// Points (value, altitude in km) of values at altitudes in m.
pub(super) fn against_km(values: &[f64], altitudes: &[f64]) -> Vec<(f64, f64)> {
    values.iter().zip(altitudes).map(|(&v, &z)| (v, z / KM)).collect()
}

/// Points (x, y).
pub(super) fn points(x: &[f64], y: &[f64]) -> Vec<(f64, f64)> {
    x.iter().copied().zip(y.iter().copied()).collect()
}

/// What a key says of dotted lines.
pub(super) fn dotted() -> Curve {
    Curve::new("dotted: the thesis' code", GREY, Vec::new()).stroke(Stroke::Dotted)
}

/// A logarithmic axis of whole decades that hold all positive values, but at most `most` decades below the highest.
pub(super) fn decades<'a>(label: &str, values: impl IntoIterator<Item = &'a f64>, most: i32) -> Axis {
    let positive = values.into_iter().copied().filter(|v| *v > 0.0 && v.is_finite());
    let (low, high) = positive.fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(v), high.max(v)));
    if high <= 0.0 {
        return Axis::logarithmic(label, 0.1, 1.0, 1);
    }
    let top = (high * 1.0001).log10().ceil() as i32;
    let bottom = (low.log10().floor() as i32).clamp(top - most, top - 1);
    Axis::logarithmic(label, 10_f64.powi(bottom), 10_f64.powi(top), if top - bottom > 12 { 2 } else { 1 })
}

/// A linear axis from 0 that holds `highest`, with four to ten steps of 1, 2 or 5 times a power of ten.
pub(super) fn from_zero(label: &str, highest: f64) -> Axis {
    let power = 10_f64.powf((highest / 5.0).log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|s| highest / s <= 6.0).unwrap_or(power);
    Axis::linear(label, 0.0, (highest / step).ceil() * step, step)
}

/// Colour of a species in every figure that shows it.
pub(super) fn colour(column: &Column, species: Species) -> Colour {
    match (species, column.name(species)) {
        (Species::Molecules, _) => BLUE,
        (Species::Ozone, _) => VERMILION,
        (_, "free_troposphere") => SKY,
        (_, "stratosphere") => PURPLE,
        (_, "transported_mineral") => GREEN,
        _ => ORANGE,
    }
}

/// A species in words: "boundary layer".
pub(super) fn words(column: &Column, species: Species) -> String {
    column.name(species).replace('_', " ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_hold_their_values() {
        assert_eq!(decades("", &[0.0, 2e-4, 3e2], 10).range, (1e-4, 1e3));
        assert_eq!(decades("", &[1e-9, 1.0], 4).range, (1e-3, 1e1));
        assert_eq!(decades("", &[0.0], 4).range, (0.1, 1.0));
        let axis = from_zero("", 2.3);
        assert_eq!((axis.range, axis.step), ((0.0, 2.5), 0.5));
        assert_eq!(from_zero("", 0.12).step, 0.02);
    }

    #[test]
    fn jumps_are_asked_from_both_sides() {
        assert_eq!(with_jumps(vec![0.0, 2000.0, 3000.0], [2000.0, 0.0]), [0.0, 1999.0, 2001.0, 3000.0]);
    }
}
