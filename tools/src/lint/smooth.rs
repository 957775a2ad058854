//! Values that leave the line of their neighbours.

use super::finding::{Check, Finding};
use super::names::Quantity;
use super::sheet::{Column, Sheet, coordinate, round};

/// How far a value may be from both of its neighbours, as a factor, where these agree within the second one. Spectral
/// lines of the sun and bands of ozone stay below at the steps at which they are tabulated.
const SPIKE: (f64, f64) = (4.0, 1.8);

/// Smallest departure that can be an error of one value in a smooth profile, relative.
const PROFILE: f64 = 0.015;

/// Smallest departure that can be an error of one value in a smooth spectrum, relative.
const SPECTRUM: f64 = 0.10;

/// Where spectra are no longer smooth: resonances of matter, and the noise of ozone's absorption.
const INFRARED_NM: f64 = 1050.0;

/// By how much such a departure must stand out of those of all other rows.
const OUTSTANDING: f64 = 8.0;

/// The findings of a sheet: spikes in all spectra and profiles, small slips in those that are smooth elsewhere.
pub(super) fn laws(sheet: &Sheet) -> Vec<Finding> {
    let Some(along) = coordinate(&sheet.columns) else { return Vec::new() };
    let mut findings = Vec::new();
    let judged = |c: &&Column| {
        c.name != along.name
            && c.texts.is_empty()
            && !matches!(c.meaning.quantity, Quantity::Key | Quantity::Humidity | Quantity::Other | Quantity::Limb(_))
    };
    for column in sheet.columns.iter().filter(judged) {
        for block in &sheet.blocks {
            let judged = |row: &usize| {
                along.meaning.quantity == Quantity::Altitude || sheet.wavelength_nm(along, *row) < INFRARED_NM
            };
            let rows: Vec<usize> = block.rows.clone().filter(|row| column.values[*row] > 0.0 && judged(row)).collect();
            let whole = rows.len() == block.rows.clone().filter(judged).count();
            let points: Vec<(f64, f64)> =
                rows.iter().map(|row| (along.values[*row], column.values[*row].ln())).collect();
            let profile = along.meaning.quantity == Quantity::Altitude;
            let off = spikes(&points)
                .into_iter()
                .chain(whole.then(|| slip(&points, if profile { PROFILE } else { SPECTRUM })).flatten());
            let mut seen = Vec::new();
            for (i, line) in off {
                if seen.contains(&i) {
                    continue;
                }
                seen.push(i);
                let (row, factor) = (rows[i], (points[i].1 - line).exp());
                let found = format!("{}, {} of the line of its neighbours", round(column.values[row]), times(factor));
                let finding =
                    Finding::new(Check::Smoothness, &[&column.name], found, format!("about {}", round(line.exp())));
                let power = factor.log10().round();
                let slipped = power != 0.0 && (factor.log10() - power).abs() < 0.12;
                let cause = if slipped { format!("a decimal slipped by 10^{power}") } else { "a wrong digit".into() };
                findings.push(finding.of(&block.label).at(sheet.line(row), sheet.at(row)).because(cause));
            }
        }
    }
    findings
}

fn times(factor: f64) -> String {
    if factor >= 1.0 { format!("{factor:.3} times") } else { format!("1/{:.3}", 1.0 / factor) }
}

/// The logarithm at an inner point on the line through its neighbours.
fn line(points: &[(f64, f64)], i: usize) -> f64 {
    let ((x0, y0), (x, _), (x1, y1)) = (points[i - 1], points[i], points[i + 1]);
    y0 + (y1 - y0) * (x - x0) / (x1 - x0)
}

/// Points far from both of their neighbours on the same side, which lie near and agree.
fn spikes(points: &[(f64, f64)]) -> Vec<(usize, f64)> {
    let inner = (1..points.len().saturating_sub(1)).filter(|&i| {
        let ((x0, a), (_, y), (x1, b)) = (points[i - 1], points[i], points[i + 1]);
        let (up, down) = (y - a.max(b), a.min(b) - y);
        x1 / x0 < 1.2 && up.max(down) > SPIKE.0.ln() && (a - b).abs() < SPIKE.1.ln()
    });
    inner.map(|i| (i, line(points, i))).collect()
}

/// The one point whose error shows in its own second difference and, halved and turned round, in those of both of its
/// neighbours, far above all others.
fn slip(points: &[(f64, f64)], least: f64) -> Option<(usize, f64)> {
    if points.len() < 9 {
        return None;
    }
    let residuals: Vec<f64> = (1..points.len() - 1).map(|i| points[i].1 - line(points, i)).collect();
    let mut sizes: Vec<f64> = residuals.iter().map(|r| r.abs()).collect();
    sizes.sort_by(f64::total_cmp);
    let (middle, fourth) = (sizes[sizes.len() / 2], sizes[sizes.len().saturating_sub(4)]);
    let (i, &r) = residuals.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))?;
    let halved = |j: Option<&f64>| j.is_none_or(|x| (x + 0.5 * r).abs() < 0.2 * r.abs());
    let alone = r.abs() > least && r.abs() > OUTSTANDING * middle && r.abs() > 3.0 * fourth;
    let before = if i == 0 { None } else { residuals.get(i - 1) };
    (alone && halved(before) && halved(residuals.get(i + 1))).then(|| (i + 1, line(points, i + 1)))
}
