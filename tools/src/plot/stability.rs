//! Maps of errors: a panel for each method, colours for the error, grey where it refuses, a line where it leaves its bound, and a mark where
//! it states less than half of its error.

use super::colours::{BLACK, VERMILION};
use super::model::{Axis, Cells, Curve, Figure, Key, Panel, Stroke};
use crate::stability::{Cell, Map};

/// The most panels of a row.
const ACROSS: usize = 4;

/// The most names along an abscissa of so many panels in a row.
const NAMES: [usize; 4] = [19, 10, 7, 6];

/// The least and the largest error that have a colour of their own.
const LEAST: f64 = 1e-16;
const MOST: f64 = 1.0;

/// The figure of a map.
#[must_use]
pub fn figure(map: &Map) -> Figure {
    let scale = scale(map);
    let across = map.methods.len().div_ceil(map.methods.len().div_ceil(ACROSS));
    let rows = map.methods.chunks(across).map(|row| {
        let last = row.len() - 1;
        row.iter().enumerate().map(|(i, method)| panel(map, method, &scale, (i == 0, i == last), across)).collect()
    });
    let mut key = Vec::new();
    let all = || map.methods.iter().flat_map(|(_, cells)| cells);
    if all().any(|cell| cell.bound.is_some()) {
        key.push(Curve::new("where the method leaves its bound", BLACK, Vec::new()));
    }
    if all().any(states_too_little) {
        key.push(Curve::new("states less than half of its error", VERMILION, Vec::new()).stroke(Stroke::Marks));
    }
    Figure::new(map.title.as_str(), rows.collect()).key(key)
}

/// The colours of a map: whole decades that hold its errors, at most 1.
fn scale(map: &Map) -> Axis {
    let errors = map.methods.iter().flat_map(|(_, cells)| cells).filter_map(shown);
    let (low, high) = errors.filter(|error| *error > 0.0).fold((MOST, LEAST), |(a, b), e| (a.min(e), b.max(e)));
    let high = high.min(MOST).log10().ceil();
    let low = low.max(LEAST).log10().floor().min(high - 1.0);
    let decades = ((high - low) / 6.0).ceil().max(1.0);
    Axis::logarithmic("relative error", 10_f64.powf(low), 10_f64.powf(high), decades as u32)
}

/// An error as it is shown: none below what its reference can tell.
fn shown(cell: &Cell) -> Option<f64> {
    Some(cell.error?.max(cell.reference.unwrap_or(0.0)))
}

fn states_too_little(cell: &Cell) -> bool {
    let (Some(error), Some(stated), false) = (cell.error, cell.stated, cell.refused) else { return false };
    error - cell.reference.unwrap_or(0.0) > 2.0 * stated
}

/// Places with names, one step apart.
fn axis(label: &str, places: &[String], most: usize) -> Axis {
    let every = places.len().div_ceil(most);
    let names = places.iter().enumerate().filter(|(i, _)| i.is_multiple_of(every));
    let names = names.map(|(i, name)| (i as f64 + 0.5, short(name).replace('-', "\u{2212}")));
    Axis::linear(label, 0.0, places.len() as f64, 1.0).named(names.collect())
}

/// A large number with its power of ten.
fn short(name: &str) -> String {
    match name.parse::<f64>() {
        Ok(number) if number.abs() >= 1e4 => format!("{number:e}"),
        _ => name.to_owned(),
    }
}

fn panel(
    map: &Map,
    (name, cells): &(String, Vec<Cell>),
    scale: &Axis,
    (first, last): (bool, bool),
    across: usize,
) -> Panel {
    let square = |[x, y]: [usize; 2]| (x as f64, y as f64, x as f64 + 1.0, y as f64 + 1.0);
    let value = |cell: &Cell| match shown(cell).filter(|_| !cell.refused) {
        Some(error) => error.max(scale.range.0),
        None if cell.refused => f64::INFINITY,
        None => f64::NAN,
    };
    let values = cells.iter().map(|cell| (square(cell.at), value(cell))).collect();
    let refused = map.methods.iter().flat_map(|(_, cells)| cells).any(|cell| cell.refused);
    let drawn = Cells { numbered: false, bar: last, ..Cells::new(scale.clone(), values) };
    let drawn = Cells { infinite: refused.then(|| "refused".into()), ..drawn };
    let x = axis(&map.axes[0], &map.places[0], NAMES[across - 1]);
    let mut y = axis(&map.axes[1], &map.places[1], 24);
    if !first {
        y = Axis { label: String::new(), ..y };
        y.names.iter_mut().for_each(|(_, name)| name.clear());
    }
    let marks = cells.iter().filter(|cell| states_too_little(cell));
    let marks = marks.map(|cell| (cell.at[0] as f64 + 0.5, cell.at[1] as f64 + 0.5)).collect();
    let curves = vec![Curve::new("", BLACK, outline(cells)), Curve::new("", VERMILION, marks).stroke(Stroke::Marks)];
    Panel { cells: Some(drawn), ..Panel::new(x, y, curves).titled(name.as_str()).key(Key::None) }
}

/// Edges between cells within their bounds and neighbours beyond theirs, where the method answers; breaks between them.
fn outline(cells: &[Cell]) -> Vec<(f64, f64)> {
    const BREAK: (f64, f64) = (f64::NAN, f64::NAN);
    let beyond = |cell: &Cell| Some(cell.error? > cell.bound?).filter(|_| !cell.refused);
    let mut edges = Vec::new();
    for a in cells {
        for b in cells {
            let ([x, y], [to_x, to_y]) = (a.at, b.at);
            let beside = to_x == x + 1 && to_y == y;
            let above = to_x == x && to_y == y + 1;
            let differ = beyond(a).zip(beyond(b)).is_some_and(|(a, b)| a != b);
            if differ && (beside || above) {
                let corner = (x as f64 + 1.0, y as f64 + 1.0);
                let other = if beside { (corner.0, corner.1 - 1.0) } else { (corner.0 - 1.0, corner.1) };
                edges.extend([other, corner, BREAK]);
            }
        }
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stability::parse;

    #[test]
    fn cells_have_colours_and_edges_where_bounds_are_left() {
        let text = "# t\n# m | Errors | sun | depth\nmap,method,x,y,error,reference,bound,stated,refused\n\
                    m,a,60,0,1e-3,0,0.01,2e-3,0\nm,a,0,0,0.05,0,0.01,0.01,0\nm,a,60,1,2e-3,0,0.01,2e-3,0\nm,a,0,1,,,,,1\n";
        let maps = parse("s.csv", text.as_bytes()).expect("maps");
        let figure = figure(&maps[0]);
        let panel = &figure.rows[0][0];
        let cells = panel.cells.as_ref().expect("cells");
        assert_eq!(cells.scale.range, (1e-3, 0.1));
        assert!(cells.values[3].1.is_infinite() && cells.infinite.is_some());
        // One edge, between the two below; one mark, of 5 % where 1 % is stated.
        assert_eq!(panel.curves[0].points[..2], [(1.0, 0.0), (1.0, 1.0)]);
        assert_eq!(panel.curves[0].points.len(), 3);
        assert_eq!(panel.curves[1].points, [(1.5, 0.5)]);
        assert_eq!(figure.key.len(), 2);
        let names: Vec<&str> = panel.x.names.iter().map(|(_, name)| name.as_str()).collect();
        assert_eq!(names, ["60", "0"]);
    }
}
