//! Some of a table's numbers, as a table of HTML.

use super::escaped;
use crate::text::{shortest, six_digits};
use std::fmt::Write;
use tables::{Axis, Field, Table};

/// Most rows and columns.
const ROWS: usize = 13;
const COLUMNS: usize = 7;

/// Every field at nodes that are spread evenly over its two longest axes, the ends among them; on further axes at the node in the middle, which is
/// named.
pub(super) fn of(table: &Table) -> String {
    table.fields.iter().map(|field| one(table, field)).collect()
}

fn one(table: &Table, field: &Field) -> String {
    let axes: Vec<&Axis> =
        field.axes.iter().filter_map(|name| table.axes.iter().find(|axis| axis.name == *name)).collect();
    let mut longest: Vec<usize> = (0..axes.len()).collect();
    longest.sort_by_key(|&i| std::cmp::Reverse(axes[i].nodes.len()));
    let (down, across) = (longest.first().copied(), longest.get(1).copied());
    let nodes = |axis: Option<usize>, most: usize| axis.map_or(vec![0], |i| spread(axes[i].nodes.len(), most));
    let (rows, columns) = (nodes(down, ROWS), nodes(across, COLUMNS));
    let middle = |i: usize| axes[i].nodes.len() / 2;
    let value = |row: usize, column: usize| {
        let place = |i: usize| match i {
            _ if Some(i) == down => row,
            _ if Some(i) == across => column,
            _ => middle(i),
        };
        // The slowest axis first.
        field.values.get(axes.iter().enumerate().fold(0, |index, (i, axis)| index * axis.nodes.len() + place(i)))
    };
    let mut caption = format!("<code>{}</code> in {}", escaped(&field.name), escaped(&field.unit));
    for &i in longest.iter().skip(2) {
        caption += &format!(", at {} = {}", named(axes[i]), shortest(axes[i].nodes[middle(i)]));
    }
    let head = |axis: Option<usize>| axis.map_or(String::new(), |i| named(axes[i]));
    let mut html = format!("<table><caption>{caption}</caption><tr><th>{}</th>", head(down));
    // Writing to a string does not fail.
    for (k, &column) in columns.iter().enumerate() {
        let what = if k == 0 { head(across) } else { String::new() };
        let node = across.map_or(String::new(), |i| shortest(axes[i].nodes[column]));
        let _ = write!(html, "<th>{what} {node}</th>");
    }
    for &row in &rows {
        let _ = write!(html, "</tr><tr><th>{}</th>", down.map_or(String::new(), |i| shortest(axes[i].nodes[row])));
        for &column in &columns {
            let _ = write!(html, "<td>{}</td>", value(row, column).map_or(String::new(), |value| six_digits(*value)));
        }
    }
    html + "</tr></table>\n"
}

fn named(axis: &Axis) -> String {
    if axis.unit == "1" { escaped(&axis.name) } else { format!("{} ({})", escaped(&axis.name), escaped(&axis.unit)) }
}

/// At most `most` of so many places, evenly, both ends among them.
fn spread(count: usize, most: usize) -> Vec<usize> {
    if count <= most { (0..count).collect() } else { (0..most).map(|i| i * (count - 1) / (most - 1)).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tables::{Kind, Precision, Scale, Tolerance};

    #[test]
    fn numbers_stand_at_their_nodes() {
        let axis = |name: &str, nodes: &[f64]| Axis::new(name, "m", nodes.to_vec()).expect("valid");
        let field = Field {
            name: "density".into(),
            unit: "m^-3".into(),
            axes: ["month", "place", "altitude"].map(String::from).to_vec(),
            precision: Precision::F64,
            scale: Scale::Linear,
            tolerance: Tolerance { relative: 0.0, absolute: 0.0 },
            interpolation_error: None,
            // 100 i + 10 j + k of two, one and three nodes.
            values: vec![0.0, 1.0, 2.0, 100.0, 101.0, 102.0],
        };
        let table = Table {
            kind: Kind::Aerosol,
            title: String::new(),
            axes: vec![axis("month", &[1.0, 7.0]), axis("place", &[5.0]), axis("altitude", &[0.0, 1e3, 2e7])],
            fields: vec![field],
            settings: [].into(),
            provenance: Vec::new(),
        };
        let html = of(&table);
        assert!(html.contains("in m^-3, at place (m) = 5<"), "{html}");
        assert!(html.contains("<tr><th>altitude (m)</th><th>month (m) 1</th><th> 7</th></tr>"), "{html}");
        assert!(html.contains("<tr><th>20000000</th><td>2.00000</td><td>102.000</td></tr>"), "{html}");
        assert_eq!(spread(26, 6), [0, 5, 10, 15, 20, 25]);
    }
}
