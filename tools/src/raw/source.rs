//! The one reader of every file in `raw-data/`.
//!
//! A source is a CSV file in UTF-8 that begins with `# key: value` lines: `title`,
//! `citation`, `source` (where the numbers were read), `retrieved`, `licence`,
//! `changes`, and one `# unit <column>: <unit>` for each column; then the header row
//! and the rows. A type that implements [`Row`] declares the columns it wants, with
//! their units and sensible ranges, and how a line becomes SI.

use super::{Fault, RawError};
use crate::records::Records;
use csv::StringRecord;
use serde::de::DeserializeOwned;
use sha2::{Digest, Sha256};
use std::path::Path;
use tables::{Provenance, excerpt};

/// A type that is read from one line of a source.
pub trait Row: Sized {
    /// The line as it stands, in the file's units, fields in the order of the columns.
    type Record: DeserializeOwned;

    /// The columns, in the file's order.
    fn columns() -> Vec<Column>;

    /// The line in the units of the program.
    fn from_record(record: Self::Record) -> Self;
}

/// What a row type expects of one column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    name: String,
    unit: &'static str,
    content: Content,
    key: bool,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Content {
    Text,
    Number { low: f64, high: f64, optional: bool },
}

impl Column {
    /// A number from `low` to `high`, both in `unit` and both allowed.
    #[must_use]
    pub fn number(name: &str, unit: &'static str, low: f64, high: f64) -> Self {
        let content = Content::Number { low, high, optional: false };
        Self { name: name.into(), unit, content, key: false }
    }

    /// As [`Column::number`], but a field may be empty: no data.
    #[must_use]
    pub fn optional(name: &str, unit: &'static str, low: f64, high: f64) -> Self {
        let content = Content::Number { low, high, optional: true };
        Self { content, ..Self::number(name, unit, low, high) }
    }

    /// Any text.
    #[must_use]
    pub fn text(name: &str) -> Self {
        Self { name: name.into(), unit: "text", content: Content::Text, key: false }
    }

    /// The same column as one of the keys by which the rows are sorted: from one row to
    /// the next, the first key that changes must grow (a text key may change to any other),
    /// and one of them must change.
    #[must_use]
    pub fn key(self) -> Self {
        Self { key: true, ..self }
    }
}

/// A source read, checked and converted.
#[derive(Debug, Clone, PartialEq)]
pub struct Source<R> {
    /// Where the numbers came from, with the checksum of the file.
    pub provenance: Provenance,
    /// The rows, at least one.
    pub rows: Vec<R>,
}

impl<R: Row> Source<R> {
    /// Reads `raw_dir/file`; `file` is the path below `raw-data/`, with forward slashes.
    ///
    /// # Errors
    /// [`RawError`] with the file, line and column of the first thing that is wrong.
    pub fn read(raw_dir: &Path, file: &str) -> Result<Self, RawError> {
        let bytes = std::fs::read(raw_dir.join(file)).map_err(|e| RawError::new(file, Fault::Unreadable(e)))?;
        Self::parse(file, &bytes)
    }

    /// Reads the bytes of a source called `file`. Takes at most three times their memory and 1 MiB.
    ///
    /// # Errors
    /// As [`Source::read`].
    pub fn parse(file: &str, bytes: &[u8]) -> Result<Self, RawError> {
        let text = std::str::from_utf8(bytes).map_err(|_| RawError::new(file, Fault::NotUtf8))?;
        let header = Header::parse(file, text)?;
        let rows = parse_rows::<R>(file, text, &header)?;
        let provenance = Provenance {
            file: file.into(),
            title: header.get(file, "title")?,
            citation: header.get(file, "citation")?,
            source: header.get(file, "source")?,
            licence: header.get(file, "licence")?,
            sha256: sha256(bytes),
        };
        for key in ["retrieved", "changes"] {
            header.get(file, key)?;
        }
        Ok(Self { provenance, rows })
    }

    /// The same source if it has exactly `expected` rows.
    ///
    /// # Errors
    /// [`Fault::WrongCount`].
    pub fn with_rows(self, expected: usize) -> Result<Self, RawError> {
        let found = self.rows.len();
        if found == expected {
            Ok(self)
        } else {
            Err(RawError::new(&self.provenance.file, Fault::WrongCount { expected, found }))
        }
    }
}

/// SHA-256 of bytes in lower-case hexadecimal.
#[must_use]
pub fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// The `# key: value` lines.
pub(crate) struct Header<'a> {
    /// All of them, line ends included.
    pub(crate) text: &'a str,
    /// Number of lines of the header.
    pub(crate) lines: u64,
}

impl<'a> Header<'a> {
    pub(crate) fn parse(file: &str, text: &'a str) -> Result<Self, RawError> {
        let (mut lines, mut length) = (0, 0);
        for line in text.split_inclusive('\n').take_while(|line| line.starts_with('#')) {
            lines += 1;
            length += line.len();
            if entry(line).is_none() {
                let found = excerpt(line.trim_start_matches('#').trim());
                return Err(RawError::new(file, Fault::MalformedHeader { found }).at_line(lines));
            }
        }
        Ok(Self { text: &text[..length], lines })
    }

    /// Keys and values, in order.
    pub(crate) fn entries(&self) -> impl Iterator<Item = (&'a str, &'a str)> {
        self.text.lines().filter_map(entry)
    }

    pub(crate) fn find(&self, key: &str) -> Option<&'a str> {
        self.entries().find(|(k, v)| *k == key && !v.is_empty()).map(|(_, v)| v)
    }

    fn get(&self, file: &str, key: &str) -> Result<String, RawError> {
        self.find(key).map(str::to_owned).ok_or_else(|| RawError::new(file, Fault::MissingKey { key: key.into() }))
    }
}

/// Key and value of a line of the header.
fn entry(line: &str) -> Option<(&str, &str)> {
    line.strip_prefix('#')?.split_once(':').map(|(key, value)| (key.trim(), value.trim()))
}

/// Memory in bytes that the rows of any file may take; beyond it, twice the file.
const ROWS: usize = 1 << 19;

fn parse_rows<R: Row>(file: &str, text: &str, header: &Header) -> Result<Vec<R>, RawError> {
    let columns = R::columns();
    let malformed = |found: String| RawError::new(file, Fault::MalformedRow { found: excerpt(&found) });
    let most = (ROWS + 2 * text.len()) / size_of::<R>().max(1);
    let mut records = Records::new(&text[header.text.len()..]);
    let (mut previous, mut record) = (StringRecord::new(), StringRecord::new());
    let mut rows = Vec::with_capacity(most.min(text.lines().count()));
    let mut is_header_row = true;
    while let Some(line) = records.read(&mut record).map_err(|(line, e)| malformed(e).at_line(header.lines + line))? {
        let line = header.lines + line;
        if is_header_row {
            check_header_row(&columns, &record, header).map_err(|e| e.in_file(file).at_line(line))?;
            is_header_row = false;
            continue;
        }
        let before = Some(&previous).filter(|_| !rows.is_empty());
        check_record(&columns, &record, before).map_err(|e| e.in_file(file).at_line(line))?;
        if rows.len() >= most {
            return Err(malformed(format!("more than {most} rows in {} bytes", text.len())).at_line(line));
        }
        let typed = record.deserialize(None).map_err(|e| malformed(e.to_string()).at_line(line))?;
        rows.push(R::from_record(typed));
        std::mem::swap(&mut previous, &mut record);
    }
    if rows.is_empty() { Err(RawError::new(file, Fault::NoRows)) } else { Ok(rows) }
}

/// Names and units of the header row against those declared.
fn check_header_row(columns: &[Column], names: &StringRecord, header: &Header) -> Result<(), RawError> {
    for (i, column) in columns.iter().enumerate() {
        let found = names.get(i).unwrap_or_default();
        if found != column.name {
            let fault = Fault::MissingColumn { position: i + 1, found: excerpt(found) };
            return Err(RawError::new("", fault).in_column(&column.name));
        }
        let unit = header.find(&format!("unit {found}"));
        if unit != Some(column.unit) {
            let fault =
                Fault::UnexpectedUnit { expected: column.unit.into(), found: excerpt(unit.unwrap_or_default()) };
            return Err(RawError::new("", fault).in_column(&column.name));
        }
    }
    match names.get(columns.len()) {
        Some(found) => Err(RawError::new("", Fault::UnexpectedColumn).in_column(&excerpt(found))),
        None => Ok(()),
    }
}

/// One row against the declared columns, and its keys against those of the row before.
fn check_record(columns: &[Column], record: &StringRecord, previous: Option<&StringRecord>) -> Result<(), RawError> {
    if record.len() != columns.len() {
        let found = format!("{} fields where there are {} columns", record.len(), columns.len());
        return Err(RawError::new("", Fault::MalformedRow { found }));
    }
    for (column, field) in columns.iter().zip(record) {
        column.check(field).map_err(|fault| RawError::new("", fault).in_column(&column.name))?;
    }
    let Some(previous) = previous else { return Ok(()) };
    let mut keys = columns.iter().zip(previous).zip(record).filter(|((column, _), _)| column.key).peekable();
    while let Some(((column, before), now)) = keys.next() {
        let grows = match column.content {
            Content::Text => before != now,
            Content::Number { .. } => matches!((before.parse::<f64>(), now.parse::<f64>()), (Ok(a), Ok(b)) if a < b),
        };
        if grows {
            return Ok(());
        }
        let same = match column.content {
            Content::Text => true,
            Content::Number { .. } => before.parse::<f64>().ok() == now.parse::<f64>().ok(),
        };
        if !same || keys.peek().is_none() {
            let fault = Fault::NotIncreasing { previous: excerpt(before), found: excerpt(now) };
            return Err(RawError::new("", fault).in_column(&column.name));
        }
    }
    Ok(())
}

impl Column {
    fn check(&self, field: &str) -> Result<(), Fault> {
        match self.content {
            Content::Text => Ok(()),
            Content::Number { optional: true, .. } if field.is_empty() => Ok(()),
            Content::Number { .. } => self.value(field).map(drop),
        }
    }

    /// The number that a field of this column is; of a text column any number.
    pub(crate) fn value(&self, field: &str) -> Result<f64, Fault> {
        let (low, high) = match self.content {
            Content::Number { low, high, .. } => (low, high),
            Content::Text => (f64::NEG_INFINITY, f64::INFINITY),
        };
        let value: f64 = field.parse().map_err(|_| Fault::NotANumber { found: excerpt(field) })?;
        if !value.is_finite() {
            return Err(Fault::NotFinite { found: excerpt(field) });
        }
        if value < low || value > high {
            return Err(Fault::OutOfRange { low, high, unit: self.unit.into(), found: excerpt(field) });
        }
        Ok(value)
    }
}

#[cfg(test)]
#[path = "source_tests.rs"]
mod tests;
