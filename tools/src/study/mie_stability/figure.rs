//! Heat maps of relative error over size parameter and refractive index.

use super::variants::{self, Group, Quantity, Variant};
use super::{LARGE, column};
use crate::frame::Frame;
use crate::plot::colours::{BLACK, BLUE, GREEN, ORANGE};
use crate::plot::model::{Axis, Cells, Curve, Figure, Key, Panel, Stroke};
use crate::plot::power_of_ten;
use crate::study::Part;
use polars::prelude::PolarsError;

/// The smallest error shown: the last digit of a double.
const SMALLEST: f64 = 1e-16;

/// An error as it is shown: none smaller than [`SMALLEST`], and none where there is none.
fn shown(error: f64) -> f64 {
    if error < SMALLEST { SMALLEST } else { error }
}

impl Quantity {
    /// Its name in words.
    fn words(self) -> &'static str {
        match self {
            Self::Extinction => "extinction",
            Self::Scattering => "scattering",
            Self::Absorption => "absorption",
            Self::Backscatter => "radar backscatter",
            Self::Asymmetry => "asymmetry g",
            Self::Forward => "amplitude at 0°",
            Self::Backward => "amplitude at 180°",
        }
    }
}

/// The figure of a part.
pub(in crate::study) fn figure(part: &Part) -> Result<Figure, PolarsError> {
    if part.name == LARGE {
        return large(&part.frame);
    }
    let groups = variants::groups();
    let group = groups.iter().find(|group| group.name == part.name);
    let group = group.ok_or_else(|| PolarsError::ColumnNotFound(part.name.into()))?;
    let map = Map::new(&part.frame)?;
    let mut rows = panels(group).into_iter().map(|row| map.row(row)).collect::<Result<Vec<_>, _>>()?;
    let mut cells: Vec<&mut Cells> = rows.iter_mut().flatten().filter_map(|panel| panel.cells.as_mut()).collect();
    if cells.iter().flat_map(|cells| &cells.values).any(|(_, error)| error.is_infinite()) {
        for cells in &mut cells {
            cells.infinite = Some("no number".into());
        }
    }
    Ok(Figure::new(format!("{}: relative error against arbitrary precision", group.title), rows))
}

/// What a panel shows, and its title.
type Shown<'a> = (&'a Variant, Quantity, &'a str);

/// The panels of a group: a row for each quantity, or what is alone in two rows.
fn panels(group: &Group) -> Vec<Vec<Shown<'_>>> {
    let row = |&quantity: &Quantity| -> Vec<Shown<'_>> {
        let titled = |v: &'_ Variant| if v.title.is_empty() { quantity.words() } else { v.title };
        group.variants.iter().map(|variant| (variant, quantity, titled(variant))).collect()
    };
    let rows: Vec<Vec<Shown<'_>>> = group.rows.iter().map(row).collect();
    if rows.len() == 2 {
        return rows;
    }
    let all: Vec<Shown<'_>> = rows.into_iter().flatten().collect();
    all.chunks(all.len().div_ceil(2)).map(<[_]>::to_vec).collect()
}

/// The spheres of a frame and their places on the axes.
struct Map<'a> {
    frame: &'a Frame,
    /// Cells (left, bottom, right, top), sphere by sphere.
    places: Vec<(f64, f64, f64, f64)>,
    /// Ends of the axis of size parameters.
    ends: (f64, f64),
    /// Names of refractive indices.
    names: Vec<(f64, String)>,
}

impl<'a> Map<'a> {
    fn new(frame: &'a Frame) -> Result<Self, PolarsError> {
        let (x, n, k) = (frame.column("x")?, frame.column("n")?, frame.column("k")?);
        let distinct = |values: &[f64]| {
            let mut values = values.to_vec();
            values.sort_by(f64::total_cmp);
            values.dedup();
            values
        };
        let sizes = distinct(&x);
        // Half-way between neighbours, and as far beyond the ends.
        let middles: Vec<f64> = sizes.windows(2).map(|pair| (pair[0] * pair[1]).sqrt()).collect();
        let ([low, .., high], [first, .., last]) = (&sizes[..], &middles[..]) else {
            return Err(PolarsError::NoData("fewer than three size parameters".into()));
        };
        let ends = (low * low / first, high * high / last);
        let edges: Vec<f64> = std::iter::once(ends.0).chain(middles).chain([ends.1]).collect();
        // From clear to black, and by n.
        let mut indices: Vec<(f64, f64)> = k.iter().copied().zip(n.iter().copied()).collect();
        indices.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
        indices.dedup();
        let place = |((x, n), k): ((&f64, &f64), &f64)| {
            let column = sizes.iter().position(|size| size == x).unwrap_or(0);
            let row = indices.iter().position(|index| *index == (*k, *n)).unwrap_or(0) as f64;
            (edges[column], row, edges[column + 1], row + 1.0)
        };
        let places = x.iter().zip(&n).zip(&k).map(place).collect();
        let names = (0..).zip(&indices).map(|(row, &(k, n))| (f64::from(row) + 0.5, name(n, k))).collect();
        Ok(Self { frame, places, ends, names })
    }

    fn row(&self, shown: Vec<Shown<'_>>) -> Result<Vec<Panel>, PolarsError> {
        let (last, decades) = (shown.len() - 1, if shown.len() > 3 { 4 } else { 2 });
        let panel = |(i, shown)| {
            let size = Axis::logarithmic("size parameter", self.ends.0, self.ends.1, decades);
            self.panel(shown, size, i == 0, i == last)
        };
        shown.into_iter().enumerate().map(panel).collect()
    }

    fn panel(
        &self,
        (variant, quantity, title): Shown<'_>,
        size: Axis,
        first: bool,
        last: bool,
    ) -> Result<Panel, PolarsError> {
        let errors = self.frame.column(&column(variant.key, quantity))?;
        let values = self.places.iter().copied().zip(errors.into_iter().map(shown));
        let scale = Axis::logarithmic("relative error", SMALLEST, 1.0, 4);
        let cells = Cells { numbered: false, bar: last, ..Cells::new(scale, values.collect()) };
        let blank = |(place, _): &(f64, String)| (*place, String::new());
        let (label, names) = if first {
            // Where the titles are quantities, they name them.
            let of = if variant.title.is_empty() { String::new() } else { format!("{} by ", quantity.words()) };
            (format!("{of}refractive index"), self.names.clone())
        } else {
            (String::new(), self.names.iter().map(blank).collect())
        };
        let rows = self.names.len() as f64;
        Ok(Panel {
            cells: Some(cells),
            ..Panel::new(size, Axis::linear(&label, 0.0, rows, 1.0).named(names), Vec::new()).titled(title)
        })
    }
}

/// A refractive index in words.
fn name(n: f64, k: f64) -> String {
    if k == 0.0 {
        return n.to_string();
    }
    let power = k.log10();
    // Powers of ten are short.
    let imaginary = if k < 0.01 { power_of_ten(power.round() as i32) } else { k.to_string() };
    format!("{n} + {imaginary}i").replace(" + 1i", " + i")
}

/// Errors against the size parameter of spheres up to x = 1e6.
fn large(frame: &Frame) -> Result<Figure, PolarsError> {
    let x = frame.column("x")?;
    let panel = |quantity: Quantity| -> Result<Panel, PolarsError> {
        let mut curves = Vec::new();
        for (variant, colour) in variants::large().iter().zip([ORANGE, BLUE, BLACK, GREEN]) {
            let errors = frame.column(&column(variant.key, quantity))?;
            let points = x.iter().copied().zip(errors.into_iter().map(shown)).collect();
            curves.push(Curve::new(variant.title, colour, points).stroke(Stroke::Marks));
        }
        let key = if quantity == Quantity::Extinction { Key::TopLeft } else { Key::None };
        Ok(Panel::new(
            Axis::logarithmic("size parameter", 1e-7, 1e7, 2),
            Axis::logarithmic("relative error", SMALLEST, 1e-6, 2),
            curves,
        )
        .titled(quantity.words())
        .key(key))
    };
    let row = |a, b| Ok::<_, PolarsError>(vec![panel(a)?, panel(b)?]);
    let rows = vec![row(Quantity::Extinction, Quantity::Asymmetry)?, row(Quantity::Forward, Quantity::Backward)?];
    Ok(Figure::new("45 spheres up to x = 10⁶: what angular functions and sums lose", rows))
}
