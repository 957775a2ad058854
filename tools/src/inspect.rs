//! A table in words, for people.

use std::fmt::Write;
use tables::{Axis, Field, Table};

/// Title, settings, axes, fields with their ranges, and provenance, as aligned text that ends with
/// a line end.
#[must_use]
pub fn describe(table: &Table) -> String {
    let mut text = format!("{}: {}\n", table.kind, table.title);
    section(
        &mut text,
        "settings",
        table.settings.iter().map(|(key, value)| vec![key.clone(), value.clone()]).collect(),
    );
    section(&mut text, "axes", table.axes.iter().map(axis).collect());
    section(&mut text, "fields", table.fields.iter().map(field).collect());
    for input in &table.provenance {
        let rows = [
            ("title", &input.title),
            ("citation", &input.citation),
            ("read in", &input.source),
            ("licence", &input.licence),
            ("SHA-256", &input.sha256),
        ];
        let rows = rows.into_iter().map(|(key, value)| vec![key.to_owned(), value.clone()]).collect();
        let folder = if input.is_own() { "" } else { "raw-data/" };
        section(&mut text, &format!("from {folder}{}", input.file), rows);
    }
    text
}

/// A heading and rows in aligned columns; nothing if there are no rows.
fn section(text: &mut String, heading: &str, rows: Vec<Vec<String>>) {
    if rows.is_empty() {
        return;
    }
    let _ = writeln!(text, "\n{heading}"); // writing to a String does not fail
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |i: usize| rows.iter().filter_map(|row| row.get(i)).map(|cell| cell.chars().count()).max().unwrap_or(0);
    let widths: Vec<usize> = (0..columns).map(width).collect();
    for row in &rows {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:width$}")).collect();
        let _ = writeln!(text, "  {}", cells.join("  ").trim_end());
    }
}

fn axis(axis: &Axis) -> Vec<String> {
    let (low, high) = axis.range();
    vec![
        axis.name.clone(),
        format!("{low} to {high}{}", suffix(&axis.unit)),
        format!("{} nodes", axis.nodes.len()),
        format!("{:?} spacing", axis.spacing).to_lowercase(),
        format!("between: {:?}", axis.interpolation).to_lowercase(),
        format!("outside: {:?}", axis.outside).to_lowercase(),
    ]
}

fn field(field: &Field) -> Vec<String> {
    let low = field.values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = field.values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let range = if low == high { number(low) } else { format!("{} to {}", number(low), number(high)) };
    let error = field.interpolation_error.map_or("nodes are the data".into(), |e| format!("interpolation error {e:e}"));
    vec![
        field.name.clone(),
        format!("{range}{}", suffix(&field.unit)),
        if field.axes.is_empty() { "one value".into() } else { format!("over {}", field.axes.join(" x ")) },
        format!("{:?}", field.precision).to_lowercase(),
        format!("{:?}", field.scale).to_lowercase(),
        error,
    ]
}

/// Six digits, in powers of ten where they are shorter to read.
fn number(x: f64) -> String {
    if x == 0.0 || (1e-3..1e6).contains(&x.abs()) {
        let decimals = 5 - x.abs().max(1.0).log10() as i32;
        format!("{x:.*}", decimals.max(0) as usize)
    } else {
        format!("{x:.5e}")
    }
}

/// A unit after a space; nothing for none.
fn suffix(unit: &str) -> String {
    if unit == "1" { String::new() } else { format!(" {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeMap;
    use tables::{Kind, Precision, Scale, Tolerance};

    #[test]
    fn a_table_is_described_in_aligned_lines() {
        let table = Table {
            kind: Kind::Observer,
            title: "a title".into(),
            axes: vec![Axis::uniform("wavelength", "nm", 360.0, 1.0, 3).expect("valid")],
            fields: vec![Field {
                name: "x_bar".into(),
                unit: "1".into(),
                axes: vec!["wavelength".into()],
                precision: Precision::F64,
                scale: Scale::Linear,
                tolerance: Tolerance { relative: 0.0, absolute: 0.0 },
                interpolation_error: None,
                values: vec![0.0, 1.5, 1e-7],
            }],
            settings: BTreeMap::from([("a".into(), "b".into()), ("long".into(), "c".into())]),
            provenance: Vec::new(),
        };
        let expected = "observer: a title\n\nsettings\n  a     b\n  long  c\n\naxes\n  wavelength  360 to 362 nm  3 nodes  \
            uniform spacing  between: linear  outside: error\n\nfields\n  x_bar  0.00000 to 1.50000  over wavelength  f64  \
            linear  nodes are the data\n";
        assert_eq!(describe(&table), expected);
    }

    #[test]
    fn numbers_have_six_digits() {
        assert_eq!(number(101_325.0), "101325");
        assert_eq!(number(0.05), "0.05000");
        assert_eq!(number(2.546972e25), "2.54697e25");
        assert_eq!(number(-288.15), "-288.150");
    }
}
