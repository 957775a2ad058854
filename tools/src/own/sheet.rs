//! The one reader of people's own files: a header row, numbers, and the same checks as for `raw-data/`.

use super::units::{Quantity, Unit, normalise};
use crate::raw::{Column, Fault, RawError, sha256};
use tables::Provenance;

/// The longest line in bytes: no header of a table of numbers is longer.
const LONGEST_LINE: usize = 16 << 10;

/// The longest number in bytes.
const LONGEST_NUMBER: usize = 64;

/// Which way the numbers of a column go.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Order {
    Up,
    Down,
}

/// What a kind of file may hold.
#[derive(Debug, Clone, Copy)]
pub(super) struct Schema {
    /// The quantities of its columns.
    pub(super) quantities: &'static [Quantity],
    /// Name of a column of words, if it may have one.
    pub(super) words: Option<&'static str>,
    /// By which column the rows are sorted and how: the first of these that is there.
    pub(super) sorted_by: &'static [(Quantity, Order)],
    /// What to do if they are not.
    pub(super) remedy: &'static str,
    /// The most rows.
    pub(super) most_rows: usize,
}

/// One column, converted.
#[derive(Debug, Clone, PartialEq)]
struct Filled {
    quantity: Quantity,
    name: String,
    unit: Unit,
    values: Vec<f64>,
}

/// A file of one's own: columns of numbers in our units, with their lines.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sheet {
    pub(super) provenance: Provenance,
    columns: Vec<Filled>,
    words: Vec<String>,
    lines: Vec<u32>,
}

/// What a column of the file is.
enum Cell {
    /// Index into [`Sheet::columns`].
    Number(usize),
    Words,
    Ignored,
}

impl Sheet {
    /// Reads the bytes of a file called `name` (only the last part of a path is kept). Columns called as one of
    /// `ignored` are left out. Lines that begin with `#` are remarks, of which `# title: ...` and `# source: ...`
    /// go into the table; fields are separated by commas, semicolons or tabs, whichever the header row has.
    ///
    /// Takes at most four times the file and 1 MiB of memory, whatever the file holds.
    pub(super) fn parse(name: &str, bytes: &[u8], ignored: &[String], schema: &Schema) -> Result<Self, RawError> {
        let file = name.rsplit(['/', '\\']).next().unwrap_or(name);
        let text = std::str::from_utf8(bytes).map_err(|_| RawError::new(file, Fault::NotUtf8))?;
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let mut sheet = Self {
            provenance: Provenance {
                file: file.into(),
                title: remark(text, "title").unwrap_or(file).into(),
                citation: Provenance::OWN.into(),
                source: remark(text, "source").unwrap_or(Provenance::OWN).into(),
                licence: "not stated".into(),
                sha256: sha256(bytes),
            },
            columns: Vec::new(),
            words: Vec::new(),
            lines: Vec::new(),
        };
        let (mut cells, mut delimiter) = (Vec::new(), ',');
        for (line, content) in (1_u32..).zip(text.split('\n')) {
            let named = |error: RawError| error.in_file(file).at_line(line.into());
            if content.len() > LONGEST_LINE {
                let expected = format!("lines of at most {LONGEST_LINE} bytes");
                return Err(named(RawError::new(
                    "",
                    Fault::Unexpected { expected, found: format!("one of {}", content.len()) },
                )));
            }
            if content.starts_with('#') || content.trim().is_empty() {
                continue;
            }
            if cells.is_empty() {
                delimiter = ['\t', ';'].into_iter().find(|d| content.contains(*d)).unwrap_or(',');
                cells = sheet.take_header(content.split(delimiter).map(unquoted), ignored, schema).map_err(named)?;
                // A row takes two bytes a column, and more but for a few: so much is never too little by much.
                let room = text.split('\n').count().min(text.len() / (2 * cells.len() + 1) + 1).min(schema.most_rows);
                sheet.lines.reserve_exact(room);
                sheet.columns.iter_mut().for_each(|column| column.values.reserve_exact(room));
                continue;
            }
            sheet.take_row(content.split(delimiter).map(unquoted), &cells, schema, line).map_err(named)?;
        }
        if sheet.lines.is_empty() { Err(RawError::new(file, Fault::NoRows)) } else { Ok(sheet) }
    }

    fn take_header<'t>(
        &mut self,
        names: impl Iterator<Item = &'t str>,
        ignored: &[String],
        schema: &Schema,
    ) -> Result<Vec<Cell>, RawError> {
        let mut cells = Vec::new();
        for name in names {
            if ignored.iter().any(|other| other == name) {
                cells.push(Cell::Ignored);
                continue;
            }
            let plain = normalise(name);
            if schema.words.is_some_and(|words| words == plain) {
                cells.push(Cell::Words);
                continue;
            }
            let known = schema.quantities.iter().find_map(|q| q.unit_of(&plain).map(|unit| (*q, unit)));
            let (quantity, unit) = known.ok_or_else(|| unknown(name, &plain, schema))?;
            if let Some(other) = self.columns.iter().find(|column| column.quantity == quantity) {
                let expected = format!("one column of {}", quantity.what());
                let fault = Fault::Unexpected { expected, found: format!("{:?} and this (leave one out)", other.name) };
                return Err(RawError::new("", fault).in_column(name));
            }
            cells.push(Cell::Number(self.columns.len()));
            self.columns.push(Filled { quantity, name: name.into(), unit, values: Vec::new() });
        }
        Ok(cells)
    }

    fn take_row<'t>(
        &mut self,
        fields: impl Iterator<Item = &'t str> + Clone,
        cells: &[Cell],
        schema: &Schema,
        line: u32,
    ) -> Result<(), RawError> {
        let malformed = |found: String| RawError::new("", Fault::MalformedRow { found });
        let found = fields.clone().count();
        if found != cells.len() {
            return Err(malformed(format!("{found} fields where there are {} columns", cells.len())));
        }
        if self.lines.len() == schema.most_rows {
            return Err(malformed(format!("it is one more than {} rows", schema.most_rows)));
        }
        for (field, cell) in fields.clone().zip(cells) {
            match cell {
                Cell::Ignored => {}
                Cell::Words => self.words.push(field.into()),
                Cell::Number(index) => {
                    let column = &mut self.columns[*index];
                    let value = number(column, field).map_err(|fault| named(fault, &column.name))?;
                    column.values.push(value);
                }
            }
        }
        self.lines.push(line);
        self.energies_of_photons();
        let sorted_by = schema.sorted_by.iter().find_map(|(q, order)| Some((self.find(*q)?, *order)));
        let Some((column, order)) = sorted_by else { return Ok(()) };
        let [.., before, now] = column.values[..] else { return Ok(()) };
        if if order == Order::Up { before < now } else { before > now } {
            return Ok(());
        }
        let index = self.columns.iter().position(|other| other.quantity == column.quantity).unwrap_or_default();
        let at = cells.iter().position(|cell| matches!(cell, Cell::Number(i) if *i == index)).unwrap_or_default();
        let fault = Fault::OutOfOrder {
            wanted: if order == Order::Up { "more" } else { "less" },
            line: self.lines[self.lines.len() - 2].into(),
            found: fields.clone().nth(at).unwrap_or_default().into(),
            remedy: schema.remedy,
        };
        Err(named(fault, &column.name))
    }

    /// Photons of the last row into energies, which takes its wavelength.
    fn energies_of_photons(&mut self) {
        let wavelength = self.find(Quantity::Wavelength).and_then(|column| column.values.last().copied());
        let Some(wavelength) = wavelength else { return };
        for column in self.columns.iter_mut().filter(|column| column.quantity == Quantity::Irradiance) {
            if let Some(last) = column.values.last_mut() {
                *last = column.unit.convert(*last, wavelength);
            }
        }
    }

    fn find(&self, quantity: Quantity) -> Option<&Filled> {
        self.columns.iter().find(|column| column.quantity == quantity)
    }

    /// The numbers of a column, if it is there.
    pub(super) fn column(&self, quantity: Quantity) -> Option<&[f64]> {
        self.find(quantity).map(|column| column.values.as_slice())
    }

    /// The numbers of a column of one of these quantities, of which there must be exactly one.
    pub(super) fn one_of(&self, quantities: &[Quantity]) -> Result<(Quantity, &[f64]), RawError> {
        let found: Vec<&Filled> = quantities.iter().filter_map(|q| self.find(*q)).collect();
        if let [one] = found[..] {
            return Ok((one.quantity, &one.values));
        }
        let names: Vec<String> = quantities.iter().flat_map(|q| q.usual_names()).collect();
        let what: Vec<&str> = quantities.iter().map(|q| q.what()).collect();
        let found = found.iter().map(|column| format!("{:?}", column.name)).collect::<Vec<_>>().join(" and ");
        Err(self.wrong(
            format!("one column of {} ({})", what.join(" or "), names.join(", ")),
            if found.is_empty() { "none".into() } else { found },
        ))
    }

    /// The words of its rows; empty if it has no such column.
    pub(super) fn words(&self) -> &[String] {
        &self.words
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.lines.len()
    }

    /// Line of a row, both counted from where they begin: lines from 1, rows from 0.
    pub(super) fn line(&self, row: usize) -> u32 {
        self.lines.get(row).copied().unwrap_or_default()
    }

    /// What is wrong with the whole file.
    pub(super) fn wrong(&self, expected: impl Into<String>, found: impl Into<String>) -> RawError {
        RawError::new(&self.provenance.file, Fault::Unexpected { expected: expected.into(), found: found.into() })
    }

    /// What is wrong in a row.
    pub(super) fn wrong_at(
        &self,
        row: usize,
        quantity: Quantity,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> RawError {
        let error = self.wrong(expected, found).at_line(self.line(row).into());
        match self.find(quantity) {
            Some(column) => error.in_column(&column.name),
            None => error,
        }
    }
}

fn named(fault: Fault, column: &str) -> RawError {
    RawError::new("", fault).in_column(column)
}

/// A field without the blanks and quotes around it, which some programs put around every word. Nothing that is meant
/// here needs quotes, so none can swallow the rest of a file.
fn unquoted(field: &str) -> &str {
    let field = field.trim();
    field.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')).map_or(field, str::trim)
}

/// The value of the first remark `# key: value`, if it has one.
fn remark<'t>(text: &'t str, key: &str) -> Option<&'t str> {
    let remarks = text.split('\n').filter_map(|line| line.strip_prefix('#')?.split_once(':'));
    remarks
        .map(|(name, value)| (name.trim(), value.trim()))
        .find(|(name, value)| *name == key && !value.is_empty())
        .map(|(_, value)| value)
}

/// A number of a column, checked; in our unit, but for photons, which wait for their wavelength.
fn number(column: &Filled, field: &str) -> Result<f64, Fault> {
    if field.len() > LONGEST_NUMBER {
        return Err(Fault::NotANumber { found: field.chars().take(LONGEST_NUMBER).chain(['…']).collect() });
    }
    let (low, high) = column.unit.range(column.quantity);
    let checked = Column::number("", column.unit.symbol, low, high).value(field).map_err(|fault| match fault {
        Fault::OutOfRange { found, .. } if column.quantity == Quantity::ImaginaryIndex && found.starts_with('-') => {
            Fault::Unexpected { expected: "k >= 0: m = n + ik, k absorbs; change the sign of n - ik".into(), found }
        }
        other => other,
    })?;
    Ok(if column.quantity == Quantity::Irradiance { checked } else { column.unit.convert(checked, 0.0) })
}

/// A column that is not understood.
fn unknown(name: &str, plain: &str, schema: &Schema) -> RawError {
    let mut understood: Vec<String> = schema.quantities.iter().flat_map(|q| q.usual_names()).collect();
    understood.extend(schema.words.map(String::from));
    let unitless = schema.quantities.iter().find(|q| q.lacks_unit(plain));
    let mut store = Vec::new();
    let hint = match unitless {
        Some(quantity) => format!("; name the unit of this one: {}", quantity.usual_names().join(" or ")),
        None => match Quantity::nearest(schema.quantities, plain, &mut store) {
            Some(near) if plain.len() <= LONGEST_NUMBER => format!("; did you mean {near}?"),
            _ => String::new(),
        },
    };
    named(Fault::UnknownColumn { understood: understood.join(", "), hint }, name)
}

#[cfg(test)]
#[path = "sheet_tests.rs"]
mod tests;
