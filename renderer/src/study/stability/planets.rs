//! Radius of the planet, from ten kilometres to where it might be flat: geometry in radii and in altitudes, in single and in double precision;
//! column tables; a plane in their place; solved tables.

use super::{ASKED_ERROR, Cell, MOST_ERROR, Map, Size};
use crate::atmosphere::{AirError, Columns, Tolerance};
use crate::bench::towards;
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::render::{RenderError, certify_table};
use crate::sampling::spiral;
use crate::study::columns::haze;
use crate::transport::{FINER, Resolution, Solved, covers_planet};
use rayon::prelude::*;
use std::ops::{Add, Div, Mul, Sub};

/// Radii in m.
const RADII: [f64; 12] = [1e4, 3e4, 1e5, 3e5, 1e6, 6.371e6, 3e7, 1e8, 1e9, 1e10, 1e11, 1e12];
const FEW_RADII: [f64; 5] = [1e4, 1e6, 6.371e6, 1e9, 1e12];

/// Elevations of rays in degrees.
const ELEVATIONS: [f64; 9] = [0.0, 0.01, 0.03, 0.1, 0.3, 1.0, 10.0, 30.0, 90.0];

/// Elevations of the sun in degrees.
const SUNS: [f64; 6] = [-8.0, -4.0, 0.0, 2.0, 10.0, 60.0];

/// Altitude of the eye in m, that of the top, and the scale height.
const EYE_M: f64 = 1.0;
const TOP_M: f64 = 1e5;
const SCALE_M: f64 = 8e3;

/// What column tables promise of a transmittance.
const COLUMNS: f64 = 1e-4;

/// A number of some precision.
trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {
    fn of(value: f64) -> Self;
    fn value(self) -> f64;
    fn root(self) -> Self;
}

impl Number for f64 {
    fn of(value: f64) -> Self {
        value
    }

    fn value(self) -> f64 {
        self
    }

    fn root(self) -> Self {
        self.max(0.0).sqrt()
    }
}

impl Number for f32 {
    fn of(value: f64) -> Self {
        value as Self
    }

    fn value(self) -> f64 {
        self.into()
    }

    fn root(self) -> Self {
        self.max(0.0).sqrt()
    }
}

/// A sum of two doubles, the second below the last digit of the first: 31 digits (Dekker 1971; products by fused multiplication).
#[derive(Debug, Clone, Copy)]
struct Twofold(f64, f64);

impl Twofold {
    /// Of two numbers with |a| >= |b|.
    fn ordered(a: f64, b: f64) -> Self {
        let sum = a + b;
        Self(sum, b - (sum - a))
    }
}

impl Add for Twofold {
    type Output = Self;

    /// Knuth's sum of the first parts, exactly, and of the rest.
    fn add(self, other: Self) -> Self {
        let sum = self.0 + other.0;
        let part = sum - self.0;
        let rest = (self.0 - (sum - part)) + (other.0 - part);
        Self::ordered(sum, rest + self.1 + other.1)
    }
}

impl Sub for Twofold {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + Self(-other.0, -other.1)
    }
}

impl Mul for Twofold {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        let product = self.0 * other.0;
        let rest = self.0.mul_add(other.0, -product);
        Self::ordered(product, rest + (self.0 * other.1 + self.1 * other.0))
    }
}

impl Div for Twofold {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let first = self.0 / other.0;
        let rest = self - other * Self(first, 0.0);
        Self::ordered(first, rest.0 / other.0)
    }
}

impl Number for Twofold {
    fn of(value: f64) -> Self {
        Self(value, 0.0)
    }

    fn value(self) -> f64 {
        self.0
    }

    /// One step of Newton's from the root of the first part.
    fn root(self) -> Self {
        if self.0 <= 0.0 {
            return Self(0.0, 0.0);
        }
        let first = self.0.sqrt();
        let rest = self - Self(first, 0.0) * Self(first, 0.0);
        Self::ordered(first, rest.0 / (2.0 * first))
    }
}

/// How altitudes along a ray are found.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Geometry {
    /// r^2 = r_0^2 + 2 r_0 mu t + t^2, h = r - R.
    Radii,
    /// h = h_0 + t (2 r_0 mu + t) / (r_0 + r), as in [`crate::geometry`].
    Altitudes,
}

/// Optical depth to space of an exponential atmosphere of unit density at the ground, in m: midpoints of t = t_top u^2 along the ray, the
/// same for every precision.
fn depth<N: Number>(geometry: Geometry, radius: f64, mu: f64) -> f64 {
    const PARTS: u32 = 512;
    let [radius, eye, top, mu] = [radius, EYE_M, TOP_M, mu].map(N::of);
    let two = N::of(2.0);
    let r0 = radius + eye;
    let b = r0 * mu;
    let end = match geometry {
        Geometry::Radii => {
            let r1 = radius + top;
            (b * b - r0 * r0 + r1 * r1).root() - b
        }
        Geometry::Altitudes => {
            let c = (top - eye) * (two * radius + eye + top);
            c / (b + (b * b + c).root())
        }
    };
    (0..PARTS)
        .map(|i| {
            let u = (f64::from(i) + 0.5) / f64::from(PARTS);
            let t = end * N::of(u * u);
            let altitude = match geometry {
                Geometry::Radii => (r0 * r0 + two * b * t + t * t).root() - radius,
                Geometry::Altitudes => {
                    let gain = t * (two * b + t);
                    eye + gain / (r0 + (r0 * r0 + gain).root())
                }
            };
            end.value() * 2.0 * u / f64::from(PARTS) * (-altitude.value() / SCALE_M).exp()
        })
        .sum()
}

/// The maps.
pub(super) fn make(_: &Data, size: Size, progress: &(dyn Fn(f64) + Sync)) -> Result<Vec<Map>, RenderError> {
    let radii: &[f64] = if size == Size::Full { &RADII } else { &FEW_RADII };
    let geometry = radii.iter().flat_map(|&radius| ELEVATIONS.into_iter().flat_map(move |e| of_geometry(radius, e)));
    let geometry = geometry.collect();
    let (mut columns, mut solved) = (Vec::new(), Vec::new());
    for (k, &radius) in radii.iter().enumerate() {
        columns.extend(of_columns(radius)?);
        solved.extend(of_solved(radius, size)?);
        progress((k + 1) as f64 / radii.len() as f64);
    }
    let map = |name: &str, title: &str, ordinate, cells| Map {
        name: name.into(),
        title: title.into(),
        axes: ["radius / km", ordinate],
        cells,
    };
    let elevation = "elevation of the ray / degrees";
    Ok(vec![
        map(
            "planets-geometry",
            "relative error of the optical depth to space from 1 m, by rounding alone",
            elevation,
            geometry,
        ),
        map(
            "planets-columns",
            "error of transmittances to space from 1 m to 30 km, haze that ends at 2 km",
            elevation,
            columns,
        ),
        map(
            "planets-solved",
            "solved tables, haze that ends at 2 km: rms error over the dome, by certificates",
            "sun elevation / degrees",
            solved,
        ),
    ])
}

fn place(radius: f64, elevation: f64) -> [String; 2] {
    let km = radius / 1e3;
    [if km < 1e5 { km.to_string() } else { format!("{km:e}") }, elevation.to_string()]
}

fn of_geometry(radius: f64, elevation: f64) -> Vec<Cell> {
    // What single precision can hold is the same number to all.
    let at = place(radius, elevation);
    let [radius, mu] = [radius, elevation.to_radians().sin()].map(|value| f64::from(value as f32));
    let right = depth::<Twofold>(Geometry::Altitudes, radius, mu);
    let cell = |name: &str, found: f64| {
        let off = if found.is_finite() { (found / right - 1.0).abs() } else { f64::INFINITY };
        Cell::new(name, at.clone()).found(off.min(1e9), 1e-15)
    };
    vec![
        cell("radii, single precision", depth::<f32>(Geometry::Radii, radius, mu)),
        cell("altitudes, single precision", depth::<f32>(Geometry::Altitudes, radius, mu)),
        cell("radii, double precision", depth::<f64>(Geometry::Radii, radius, mu)),
        cell("altitudes, double precision", depth::<f64>(Geometry::Altitudes, radius, mu)).bound(1e-12),
    ]
}

/// Largest errors of transmittance from some altitudes: by column tables, and between planes.
fn of_columns(radius: f64) -> Result<Vec<Cell>, RenderError> {
    const FROM: [f64; 4] = [1.0, 1999.0, 2001.0, 3e4];
    let (medium, shape) = (haze().map_err(AirError::from)?, Shape::Sphere { radius_m: radius });
    let columns = Columns::new(&medium, shape, Tolerance::RENDER);
    let cells = ELEVATIONS.par_iter().flat_map_iter(|&elevation| {
        let direction = towards(90.0 - elevation, 0.0);
        let (mut table, mut plane) = (0.0_f64, 0.0_f64);
        for altitude in FROM {
            let from = Place::above(altitude);
            let [right] = medium.transmittance(shape, from, direction);
            let [found] = columns.transmittance(from, direction).unwrap_or([0.0]);
            let [flat] = medium.transmittance(Shape::Flat, from, direction);
            (table, plane) = (table.max((found - right).abs()), plane.max((flat - right).abs()));
        }
        let cell = |name: &str, off: f64| Cell::new(name, place(radius, elevation)).found(off, 1e-9);
        [cell("column tables", table).bound(COLUMNS), cell("a plane instead", plane)]
    });
    Ok(cells.collect())
}

fn of_solved(radius: f64, size: Size) -> Result<Vec<Cell>, RenderError> {
    let (medium, shape) = (haze().map_err(AirError::from)?, Shape::Sphere { radius_m: radius });
    let (directions, rounds) = if size == Size::Full { (32, 8) } else { (32, 2) };
    let dome: Vec<_> = (0..directions).map(|i| spiral(i, directions, [0.0, 1.0])).collect();
    let columns = Columns::new(&medium, shape, Tolerance::RENDER);
    let from = Place::above(2.0);
    let solved = Solved::new(&medium, shape, [0.1], &Resolution::RENDER)?;
    let coarser = solved.again(&Resolution::COARSE, None)?;
    let covered = covers_planet(shape).is_ok();
    let mut cells = Vec::new();
    for elevation in SUNS {
        let sun = towards(90.0 - elevation, 0.0);
        let stated = FINER * solved.difference(&coarser, from, sun);
        let refused = !covered || stated.is_nan() || stated > MOST_ERROR;
        let cell = Cell::new("solved: usual tables", place(radius, elevation)).bound(ASKED_ERROR);
        let verdict = certify_table(&solved, columns.clone(), (from, sun), &dome, rounds);
        // In the dark there is nothing to be wrong.
        let Some(verdict) = verdict else { continue };
        let error = &verdict.errors[0];
        cells.push(cell.found(error.rms, error.most - error.rms).stated(stated, refused));
    }
    Ok(cells)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twofold_numbers_have_thirty_digits() {
        let third = Twofold::of(1.0) / Twofold::of(3.0);
        let off = third * Twofold::of(3.0) - Twofold::of(1.0);
        assert!(off.value().abs() < 1e-31, "{off:?}");
        let root = Twofold::of(2.0).root();
        let off = root * root - Twofold::of(2.0);
        assert!(off.value().abs() < 1e-30, "{off:?}");
    }

    #[test]
    fn altitudes_keep_in_single_precision_what_radii_lose() {
        // On the Earth radii are told apart by half a metre, squares of them by 4e6 m^2: 2e-5 of the depth of a scale height.
        let error = |name: &str| {
            let cells = of_geometry(6.371e6, 0.01);
            cells.iter().find(|cell| cell.method == name).and_then(|cell| cell.error).expect("found")
        };
        assert!(error("radii, single precision") > 5e-6 && error("altitudes, single precision") < 1e-7);
        assert!(error("altitudes, double precision") < 1e-13);
    }
}
