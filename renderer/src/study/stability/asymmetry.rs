//! Asymmetry of a haze of Henyey and Greenstein: solved tables by their degree and by the angle from the sun, paths, and tabulated
//! phase functions.

use super::{ASKED_ERROR, Cell, Map, Size, rms};
use crate::atmosphere::{Columns, Component, Medium, Tolerance};
use crate::bench::towards;
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::light::SunDisc;
use crate::phase::{Phase, Tabulated};
use crate::render::RenderError;
use crate::sampling::Sampler;
use crate::transport::{self, Estimator, Problem, Resolution, Solved, Tables};
use rayon::prelude::*;
use std::f64::consts::PI;
use tables::units::{EARTH_RADIUS_M, KM};
use tables::{Axis, Curve, Outside, Scale};

const SHAPE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };
const TOP_M: f64 = 60.0 * KM;
const EYE_M: f64 = 2.0;
const ALBEDO: f64 = 0.1;

/// Vertical optical depths and scale heights in m of molecules and of haze, and the share that haze scatters.
const MOLECULES: (f64, f64) = (0.1, 8e3);
const HAZE: (f64, f64) = (0.3, 2e3);
const SCATTERED: f64 = 0.95;

/// Asymmetries.
const G: [f64; 13] = [0.0, 0.3, 0.5, 0.6, 0.7, 0.76, 0.82, 0.88, 0.93, 0.96, 0.98, 0.99, 0.999];
const FEW_G: [f64; 5] = [0.0, 0.5, 0.76, 0.93, 0.99];

/// Zenith angle of the sun, and angles from it of the views, on both sides of it and down to the horizon.
const SUN_ZENITH: f64 = 50.0;
const ANGLES: [f64; 8] = [1.0, 2.0, 4.0, 8.0, 15.0, 30.0, 60.0, 90.0];

/// Degrees of moments.
const DEGREES: [usize; 6] = [2, 6, 10, 14, 20, 24];

/// Paths of a view: sequences, and points of each.
const PATHS: (u64, u32) = (32, 2048);
const FEW_PATHS: (u64, u32) = (16, 512);

/// Angles at which a phase function is tabulated, evenly.
const NODES: [u32; 6] = [91, 181, 361, 721, 1801, 3601];

fn medium(g: f64) -> Result<Medium<1>, RenderError> {
    let axis = Axis::uniform("altitude", "m", 0.0, TOP_M / 200.0, 201).map_err(crate::atmosphere::AirError::from)?;
    let component = |(depth, scale): (f64, f64), scattered: f64, phase| {
        let density = axis.nodes.iter().map(|z| (-z / scale).exp()).collect();
        let density = Curve::new(axis.clone().beyond(Outside::Zero), Scale::Logarithmic, density)?;
        let extinction = depth / (scale * (1.0 - (-TOP_M / scale).exp()));
        let (scattering, absorption) = ([scattered * extinction], [(1.0 - scattered) * extinction]);
        Ok::<_, crate::atmosphere::AirError>(Component { density, scattering, absorption, phase })
    };
    let components = vec![
        component(MOLECULES, 1.0, Phase::Rayleigh { gamma: [0.015] })?,
        component(HAZE, SCATTERED, Phase::HenyeyGreenstein { g: [g] })?,
    ];
    Ok(Medium::new(components, TOP_M).map_err(crate::atmosphere::AirError::from)?)
}

/// What paths find in a view: mean, its standard error, and the relative standard deviation of one path.
struct Found {
    mean: f64,
    error: f64,
    deviation: f64,
}

fn trace(problem: &Problem<'_, 1>, angle: f64, (sequences, points): (u64, u32)) -> Found {
    let direction = towards(SUN_ZENITH - angle, 0.0);
    let (mut sums, mut squares) = (Vec::new(), 0.0);
    for sequence in 0..sequences {
        let mut sum = 0.0;
        for point in 0..points {
            let mut sampler = Sampler::sobol(1, 0, sequence, point);
            let [one] = transport::radiance(Estimator::Paths, problem, Place::above(EYE_M), direction, &mut sampler);
            sum += one;
            squares += one * one;
        }
        sums.push(sum / f64::from(points));
    }
    let n = sequences as f64;
    let mean = sums.iter().sum::<f64>() / n;
    let spread = sums.iter().map(|sum| (sum - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let deviation = (squares / (n * f64::from(points)) / (mean * mean) - 1.0).max(0.0).sqrt();
    Found { mean, error: (spread / n).sqrt() / mean, deviation }
}

/// The maps.
pub(super) fn make(_: &Data, size: Size, progress: &(dyn Fn(f64) + Sync)) -> Result<Vec<Map>, RenderError> {
    let (all, paths): (&[f64], _) = match size {
        Size::Full => (&G, PATHS),
        Size::Quick => (&FEW_G, FEW_PATHS),
    };
    let (mut degrees, mut angles) = (Vec::new(), Vec::new());
    for (k, &g) in all.iter().enumerate() {
        let medium = medium(g)?;
        let (by_degree, by_angle) = of_asymmetry(&medium, g, paths)?;
        degrees.extend(by_degree);
        angles.extend(by_angle);
        progress((k + 1) as f64 / all.len() as f64);
    }
    let map = |name: &str, title: &str, axes, cells| Map { name: name.into(), title: title.into(), axes, cells };
    Ok(vec![
        map(
            "asymmetry-degrees",
            "haze of optical depth 0.3: solved tables beside paths, rms over eight directions from 1 to 90 degrees off the sun",
            ["asymmetry g", "degree of the moments"],
            degrees,
        ),
        map(
            "asymmetry-angles",
            "haze of optical depth 0.3: error in each direction, and the spread of one path",
            ["asymmetry g", "angle from the sun / degrees"],
            angles,
        ),
        map(
            "asymmetry-tables",
            "phase functions tabulated at even angles, linear in the cosine: what they are off",
            ["asymmetry g", "angles from 0 to 180 degrees"],
            all.iter().flat_map(|&g| NODES.into_iter().flat_map(move |nodes| tabulated(g, nodes))).collect(),
        ),
    ])
}

fn of_asymmetry(medium: &Medium<1>, g: f64, paths: (u64, u32)) -> Result<(Vec<Cell>, Vec<Cell>), RenderError> {
    let (from, sun) = (Place::above(EYE_M), towards(SUN_ZENITH, 0.0));
    let columns = Columns::new(medium, SHAPE, Tolerance::RENDER);
    let disc = SunDisc::beam(sun);
    let problem = Problem {
        texture: None,
        shape: SHAPE,
        medium,
        columns: &columns,
        albedo: [ALBEDO],
        sun: Some(&disc),
        environment: None,
        max_orders: None,
    };
    let right: Vec<Found> = ANGLES.par_iter().map(|&angle| trace(&problem, angle, paths)).collect();
    let known = rms(&right.iter().map(|found| found.error).collect::<Vec<_>>());
    let off = |solved: &Solved<1>| -> Vec<f64> {
        let one = |(angle, found): (&f64, &Found)| {
            let [seen] = solved.radiance(from, towards(SUN_ZENITH - angle, 0.0), sun, false);
            seen / found.mean - 1.0
        };
        ANGLES.iter().zip(&right).map(one).collect()
    };
    let mut by_degree = Vec::new();
    for degree in DEGREES {
        // No finer than the degree asks for: what is left is what the moments leave.
        let solved = Solved::new(medium, SHAPE, [ALBEDO], &Resolution { degree, ..Resolution::RENDER })?;
        let cell = Cell::new("solved", [g.to_string(), degree.to_string()]);
        by_degree.push(cell.found(rms(&off(&solved)), known).bound(ASKED_ERROR));
    }
    let mut by_angle = Vec::new();
    for (name, error) in [("solved: usual tables", f64::INFINITY), ("solved: finest tables", 0.0)] {
        let tables = Tables::within(error, (from, sun, &[]), (medium, SHAPE, [ALBEDO], false), None)?;
        let stated = tables.error(from, sun, &[]);
        for ((angle, off), found) in ANGLES.iter().zip(off(&tables.solved)).zip(&right) {
            let cell = Cell::new(name, [g.to_string(), angle.to_string()]);
            by_angle.push(cell.found(off.abs(), found.error).bound(ASKED_ERROR).stated(stated, false));
        }
    }
    for (angle, found) in ANGLES.iter().zip(&right) {
        let cell = Cell::new("paths: deviation of one", [g.to_string(), angle.to_string()]);
        by_angle.push(cell.found(found.deviation, 0.0));
    }
    Ok((by_degree, by_angle))
}

/// A tabulated function beside what it tabulates: what its values integrate to before they are normalised, the mean cosine, and the value
/// half-way between two nodes, where it is worst.
fn tabulated(g: f64, nodes: u32) -> Vec<Cell> {
    let haze = Phase::<1>::HenyeyGreenstein { g: [g] };
    let angle = |i: f64| PI * i / f64::from(nodes - 1);
    let mut cosines: Vec<f64> = (0..nodes).rev().map(|i| angle(f64::from(i)).cos()).collect();
    // Rounding leaves cos(pi) and cos(0) as they are.
    cosines[0] = -1.0;
    let values: Vec<[f64; 1]> = cosines.iter().map(|&c| haze.values(c)).collect();
    let trapezium = |of: &dyn Fn(usize) -> f64| {
        (1..cosines.len()).map(|i| PI * (cosines[i] - cosines[i - 1]) * (of(i - 1) + of(i))).sum::<f64>()
    };
    let sum = trapezium(&|i| values[i][0]);
    let Some(table) = Tabulated::new(cosines.clone(), values.clone()) else { return Vec::new() };
    let table = Phase::Tabulated(std::sync::Arc::new(table));
    // Of a line between two nodes, exactly.
    let mean: f64 = (1..cosines.len())
        .map(|i| {
            let (a, b, v, w) = (cosines[i - 1], cosines[i], table.value(0, cosines[i - 1]), table.value(0, cosines[i]));
            2.0 * PI * (b - a) * (v * (2.0 * a + b) + w * (a + 2.0 * b)) / 6.0
        })
        .sum();
    let between = (0..nodes - 1).map(|i| {
        let c = angle(f64::from(i) + 0.5).cos();
        (table.value(0, c) / haze.value(0, c) - 1.0).abs()
    });
    let cell = |method: &str, error: f64| Cell::new(method, [g.to_string(), nodes.to_string()]).found(error, 0.0);
    vec![
        cell("integral before normalisation", (sum - 1.0).abs()),
        cell("mean cosine", (mean - g).abs()),
        cell("value between nodes", between.fold(0.0, f64::max)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_of_a_smooth_function_is_right_and_of_a_peak_is_not() {
        let error = |g, nodes| tabulated(g, nodes)[0].error.expect("found");
        // The trapezium rule in the cosine with steps h of the angle: h^2 / 12 of the second derivative.
        assert!(error(0.5, 1801) < 1e-5 && error(0.5, 181) > 5.0 * error(0.5, 361) / 2.0);
        // A peak of 0.001 radians on a grid of a degree.
        assert!(error(0.999, 181) > 1.0, "{}", error(0.999, 181));
    }
}
