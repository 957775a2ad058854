//! A table, or a CSV file of ours, in words, for people.

use crate::export::range;
use crate::raw::{Fault, Header, RawError};
use crate::records::Records;
use crate::text::{aligned, six_digits};
use std::collections::BTreeSet;
use std::hash::{DefaultHasher, Hash, Hasher};
use tables::{Axis, Field, Table, excerpt};

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

/// What a CSV file of ours holds (of `raw-data/`, or written by this program): its `# key: value` lines, and the range
/// or the number of different words of each column, as text that ends with a line end.
///
/// # Errors
/// [`RawError`] with the line of what is no CSV, or of a row whose length differs from the first.
pub fn describe_csv(file: &str, bytes: &[u8]) -> Result<String, RawError> {
    let fail = |fault| RawError::new(file, fault);
    let content = std::str::from_utf8(bytes).map_err(|_| fail(Fault::NotUtf8))?;
    let header = Header::parse(file, content)?;
    let mut records = Records::new(&content[header.text.len()..]);
    let malformed = |(line, found): (u64, String)| fail(Fault::MalformedRow { found }).at_line(header.lines + line);
    let mut record = csv::StringRecord::new();
    if records.read(&mut record).map_err(malformed)?.is_none() {
        return Err(fail(Fault::NoRows));
    }
    let names: Vec<String> = record.iter().map(excerpt).collect();
    let mut columns = vec![Contents::default(); names.len()];
    let mut rows = 0;
    while let Some(line) = records.read(&mut record).map_err(malformed)? {
        if record.len() != names.len() {
            let found = format!("{} fields where there are {} columns", record.len(), names.len());
            return Err(malformed((line, found)));
        }
        rows += 1;
        for (column, cell) in columns.iter_mut().zip(&record) {
            column.add(cell);
        }
    }
    if rows == 0 {
        return Err(fail(Fault::NoRows));
    }
    let said = header.entries().filter(|(key, _)| !key.starts_with("unit "));
    let said: Vec<_> = said.map(|(key, value)| vec![excerpt(key), excerpt(value)]).collect();
    let mut text = aligned(&said, 0, |_| false);
    let column = |(name, contents): (&String, Contents)| {
        let unit = header.find(&format!("unit {name}")).filter(|unit| *unit != "text").unwrap_or("1");
        let empty = if contents.empty == 0 { String::new() } else { format!("{} empty", contents.empty) };
        vec![name.clone(), contents.described(unit), empty]
    };
    section(&mut text, &format!("{rows} rows"), names.iter().zip(columns).map(column).collect());
    Ok(text)
}

/// What the cells of a column are.
#[derive(Clone)]
struct Contents {
    empty: usize,
    /// Lowest and highest number.
    range: (f64, f64),
    /// Cells that are no numbers, and up to [`MOST_WORDS`] different ones of all, by their hashes.
    words: usize,
    different: BTreeSet<u64>,
}

/// The most different words that are counted.
const MOST_WORDS: usize = 1000;

impl Default for Contents {
    fn default() -> Self {
        Self { empty: 0, range: (f64::INFINITY, f64::NEG_INFINITY), words: 0, different: BTreeSet::new() }
    }
}

impl Contents {
    fn add(&mut self, cell: &str) {
        if cell.is_empty() {
            self.empty += 1;
            return;
        }
        match cell.parse::<f64>() {
            Ok(number) => self.range = (self.range.0.min(number), self.range.1.max(number)),
            Err(_) => self.words += 1,
        }
        if self.different.len() <= MOST_WORDS {
            let mut hasher = DefaultHasher::new();
            cell.hash(&mut hasher);
            self.different.insert(hasher.finish());
        }
    }

    fn described(&self, unit: &str) -> String {
        if self.words == 0 && self.range.0 <= self.range.1 {
            return ranged(self.range) + &suffix(&excerpt(unit));
        }
        let count = self.different.len();
        if count > MOST_WORDS { format!("more than {MOST_WORDS} words") } else { format!("{count} words") }
    }
}

/// A heading and rows in aligned columns; nothing if there are no rows.
fn section(text: &mut String, heading: &str, rows: Vec<Vec<String>>) {
    if !rows.is_empty() {
        *text += &format!("\n{heading}\n{}", aligned(&rows, 2, |_| false));
    }
}

/// One number, or the lowest and the highest.
fn ranged((low, high): (f64, f64)) -> String {
    if low == high { six_digits(low) } else { format!("{} to {}", six_digits(low), six_digits(high)) }
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
    let error = field.interpolation_error.map_or("nodes are the data".into(), |e| format!("interpolation error {e:e}"));
    vec![
        field.name.clone(),
        ranged(range(&field.values)) + &suffix(&field.unit),
        if field.axes.is_empty() { "one value".into() } else { format!("over {}", field.axes.join(" x ")) },
        format!("{:?}", field.precision).to_lowercase(),
        format!("{:?}", field.scale).to_lowercase(),
        error,
    ]
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
    fn a_csv_is_described_by_its_header_and_its_columns() {
        let text = "# title: a title\n# unit x_nm: nm\n# unit name: text\nx_nm,name,y\n300,a,\n310.5,b,2\n320,a,\n";
        let expected = "title  a title\n\n3 rows\n  x_nm  300.000 to 320.000 nm\n  name  2 words\n  y     2.00000                2 empty\n";
        assert_eq!(describe_csv("a.csv", text.as_bytes()).expect("a CSV"), expected);
        let error = describe_csv("a.csv", b"# title: a\nx,y\n1,2\n1\n").expect_err("a short row").to_string();
        assert!(error.starts_with("a.csv, line 4: malformed row"), "{error}");
        assert!(describe_csv("a.csv", b"x,y\n").is_err(), "a file without rows was taken");
    }
}
