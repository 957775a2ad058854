//! Columns of numbers with what they mean: the form in which CSV files and tables are judged.

use super::finding::{Check, Finding};
use super::names::{Dimension, Meaning, Quantity, biome, meaning, unit, unit_in_name};
use crate::records::MAX_FIELDS;
use std::ops::Range;
use tables::excerpt;
use tables::views::Biome;

/// One column.
#[derive(Debug, Clone)]
pub(super) struct Column {
    pub(super) name: String,
    pub(super) meaning: Meaning,
    /// Numbers as in the file; NaN where there is none.
    pub(super) values: Vec<f64>,
    /// The fields of a column of words.
    pub(super) texts: Vec<String>,
}

impl Column {
    /// A column of a table: the field's own name, and what its kind says that it means. Values are in SI,
    /// wavelengths in nm.
    pub(super) fn of_table(
        name: &str,
        quantity: Quantity,
        dimension: Dimension,
        subject: &str,
        values: &[f64],
    ) -> Self {
        let meaning = Meaning {
            quantity,
            subject: subject.to_owned(),
            biome: None,
            unit: Some(super::names::Unit { dimension, factor: 1.0 }),
            at_nm: None,
            words: Vec::new(),
        };
        Self { name: name.to_owned(), meaning, values: values.to_vec(), texts: Vec::new() }
    }

    /// Value of a row in SI.
    pub(super) fn si(&self, row: usize) -> f64 {
        self.values[row] * self.meaning.factor()
    }
}

/// Rows that belong together: one material at one humidity, one month.
#[derive(Debug, Clone)]
pub(super) struct Block {
    pub(super) rows: Range<usize>,
    /// The keys, in words.
    pub(super) label: String,
    pub(super) biome: Option<Biome>,
}

/// A file, or the fields of a table that share their axes.
#[derive(Debug, Clone)]
pub(super) struct Sheet {
    /// Name and title of the file, lower case, for what it is about.
    pub(super) about: String,
    pub(super) columns: Vec<Column>,
    /// Line of the file of each row; empty for tables.
    pub(super) lines: Vec<u64>,
    pub(super) blocks: Vec<Block>,
    /// Wavelength of each row in nm, if there is one.
    pub(super) nm: Option<Vec<f64>>,
    /// Of the fields of an aerosol's table, what they are of.
    pub(super) species: Option<Species>,
}

/// The species of a biome's table that a sheet is of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Species {
    pub(super) biome: Biome,
    pub(super) layer: super::aerosol::Layer,
}

impl Sheet {
    /// The first column of a quantity.
    pub(super) fn find(&self, quantity: Quantity) -> Option<&Column> {
        self.columns.iter().find(|c| c.meaning.quantity == quantity)
    }

    /// The coordinate of a row in words, such as `248 nm`.
    pub(super) fn at(&self, row: usize) -> String {
        if let Some(c) = self.find(Quantity::Wavelength) {
            return format!("{} nm", round(self.wavelength_nm(c, row)));
        }
        self.find(Quantity::Altitude).map_or(String::new(), |c| format!("{} m", round(c.si(row))))
    }

    /// Wavelength of a row in nm; a column without a unit is in nm, or in um where all its numbers are below 100.
    pub(super) fn wavelength_nm(&self, column: &Column, row: usize) -> f64 {
        match column.meaning.unit {
            Some(unit) if unit.dimension == Dimension::Length && !self.lines.is_empty() => {
                column.values[row] * unit.factor * 1e9
            }
            Some(_) => column.values[row],
            None if column.values.iter().all(|v| *v < 100.0) => column.values[row] * 1e3,
            None => column.values[row],
        }
    }

    /// Reads the wavelengths again, after the columns have changed.
    pub(super) fn refresh(&mut self) {
        let column = self.find(Quantity::Wavelength);
        self.nm = column.map(|c| (0..c.values.len()).map(|row| self.wavelength_nm(c, row)).collect());
    }

    pub(super) fn line(&self, row: usize) -> Option<u64> {
        self.lines.get(row).copied()
    }

    pub(super) fn is_about(&self, word: &str) -> bool {
        self.about.contains(word)
    }
}

/// A number in few digits.
pub(super) fn round(x: f64) -> String {
    if x == 0.0 || (1e-3..1e7).contains(&x.abs()) {
        let text = format!("{x:.4}");
        text.trim_end_matches('0').trim_end_matches('.').to_owned()
    } else {
        format!("{x:.3e}")
    }
}

/// The most rows of another length than the header row before a text is no sheet, and the most places without a number
/// that are counted in a column of a piece.
const MOST_MISFITS: usize = 100;

/// Why a text is no sheet.
#[derive(Debug, thiserror::Error)]
pub enum SheetError {
    /// No header row or no rows.
    #[error("no rows: expected a header row and rows of numbers")]
    Empty,
    /// A first row of numbers alone.
    #[error("line {0}: expected a header row with names, found numbers")]
    NoHeader(u64),
    /// A row that CSV does not allow.
    #[error("malformed CSV: {0}")]
    Malformed(String),
}

/// The sheet of a CSV file, with `# key: value` lines before the header row or without, and what is wrong with its
/// form.
pub(super) fn parse(name: &str, text: &str) -> Result<(Sheet, Vec<Finding>), SheetError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut about = name.to_lowercase();
    let (mut header_lines, mut length) = (0, 0);
    let mut units: Vec<(String, String)> = Vec::new();
    for line in text.split_inclusive('\n').take_while(|line| line.starts_with('#')) {
        header_lines += 1;
        length += line.len();
        let Some((key, value)) = line[1..].split_once(':') else { continue };
        match key.trim().strip_prefix("unit ") {
            Some(column) => units.push((column.trim().to_owned(), value.trim().to_owned())),
            None if key.trim() == "title" => about += &excerpt(value).to_lowercase(),
            None => {}
        }
    }
    let body = &text[length..];
    let first = body.lines().next().unwrap_or_default();
    let delimiter = [',', ';', '\t'].into_iter().max_by_key(|d| first.matches(*d).count()).unwrap_or(',');
    let mut reader = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .delimiter(delimiter as u8)
        .trim(csv::Trim::All)
        .from_reader(body.as_bytes());
    let mut records = reader.records();
    let malformed = |e: csv::Error| SheetError::Malformed(e.to_string());
    let header = records.next().ok_or(SheetError::Empty)?.map_err(malformed)?;
    let header: csv::StringRecord = header.iter().map(excerpt).collect::<Vec<_>>().into();
    if header.iter().all(|name| name.parse::<f64>().is_ok()) {
        return Err(SheetError::NoHeader(header_lines + 1));
    }
    if header.len() > MAX_FIELDS {
        return Err(SheetError::Malformed(format!("a header row of more than {MAX_FIELDS} fields")));
    }
    let (mut findings, mut misfits) = (Vec::new(), 0);
    let mut fields: Vec<Vec<String>> = vec![Vec::new(); header.len()];
    let mut lines = Vec::new();
    for record in records {
        let record = record.map_err(malformed)?;
        let line = header_lines + record.position().map_or(0, csv::Position::line);
        if record.len() != header.len() {
            misfits += 1;
            if misfits > MOST_MISFITS {
                let why = format!("more than {MOST_MISFITS} rows whose fields are not those of the header row");
                return Err(SheetError::Malformed(why));
            }
            let found = format!("{} fields", record.len());
            let expected = format!("{} as in the header row", header.len());
            findings.push(Finding::new(Check::Columns, &[], found, expected).at(Some(line), String::new()));
            continue;
        }
        lines.push(line);
        for (column, field) in fields.iter_mut().zip(&record) {
            column.push(excerpt(field));
        }
    }
    if lines.is_empty() {
        return Err(SheetError::Empty);
    }
    let mut columns = Vec::with_capacity(header.len());
    for (i, (name, fields)) in header.iter().zip(fields).enumerate() {
        if header.iter().take(i).any(|other| other == name) {
            findings.push(Finding::new(Check::Columns, &[name], "the name twice".into(), "one column of a name"));
        }
        let stated = units.iter().find(|(column, _)| column == name).and_then(|(_, text)| unit(text));
        if let (Some(a), Some(b)) = (stated, unit_in_name(name))
            && a.dimension != Dimension::One
            && (a.dimension != b.dimension || (a.factor / b.factor - 1.0).abs() > 1e-9)
        {
            let found = format!("another unit in the name than in the line `# unit {name}`");
            findings.push(Finding::new(Check::Columns, &[name], found, "the same unit in both"));
        }
        let before = findings.len();
        columns.push(column(name, meaning(name, stated), fields, &lines, &mut findings));
        if header.iter().any(|name| name == "unit") {
            // A list of constants, whose values may be words.
            findings.truncate(before);
        }
    }
    let blocks = blocks(&columns, lines.len());
    let mut sheet = Sheet { about, columns, lines, blocks, nm: None, species: None };
    sheet.refresh();
    findings.extend(form(&sheet));
    Ok((sheet, findings))
}

/// A column of numbers, or of words if most of its fields are none.
fn column(name: &str, mut meaning: Meaning, fields: Vec<String>, lines: &[u64], findings: &mut Vec<Finding>) -> Column {
    let numbers: Vec<Option<f64>> = fields.iter().map(|f| f.parse().ok()).collect();
    let filled = fields.iter().filter(|f| !f.is_empty()).count();
    if numbers.iter().flatten().count() * 5 < filled * 4 || filled == 0 {
        meaning.quantity = Quantity::Text;
        return Column { name: name.into(), meaning, values: vec![f64::NAN; fields.len()], texts: fields };
    }
    let mut values = Vec::with_capacity(fields.len());
    let mut misfits = 0;
    for ((field, number), &line) in fields.iter().zip(numbers).zip(lines) {
        let fits = field.is_empty() || number.is_some_and(f64::is_finite);
        misfits += usize::from(!fits);
        if !fits && misfits <= MOST_MISFITS {
            let found = format!("{field:?}");
            findings
                .push(Finding::new(Check::Missing, &[name], found, "a finite number").at(Some(line), String::new()));
        }
        values.push(number.filter(|v| v.is_finite()).unwrap_or(f64::NAN));
    }
    Column { name: name.into(), meaning, values, texts: Vec::new() }
}

/// Whether a column tells rows apart.
fn is_key(column: &Column) -> bool {
    matches!(column.meaning.quantity, Quantity::Text | Quantity::Key | Quantity::Humidity)
}

/// The coordinate of a sheet.
pub(super) fn coordinate(columns: &[Column]) -> Option<&Column> {
    let find = |q: Quantity| columns.iter().find(|c| c.meaning.quantity == q);
    find(Quantity::Wavelength).or_else(|| find(Quantity::Altitude))
}

/// Runs of rows with the same keys; without a coordinate each row with keys is a block of its own.
fn blocks(columns: &[Column], rows: usize) -> Vec<Block> {
    let along = coordinate(columns).is_some();
    let keys = |row: usize| -> Vec<String> {
        let one = |c: &Column| {
            if c.meaning.quantity == Quantity::Text {
                c.texts[row].clone()
            } else {
                format!("{} {}", c.name, round(c.values[row]))
            }
        };
        // Words that come after the numbers are remarks, such as the source of a value.
        let before = columns
            .iter()
            .take_while(|c| !along || !matches!(c.meaning.quantity, Quantity::Wavelength | Quantity::Altitude));
        before.filter(|c| is_key(c)).map(one).collect()
    };
    let mut blocks: Vec<Block> = Vec::new();
    for row in 0..rows {
        let label = keys(row).join(", ");
        match blocks.last_mut() {
            Some(last) if last.label == label => last.rows.end = row + 1,
            _ => blocks.push(Block { rows: row..row + 1, biome: biome(&label), label }),
        }
    }
    blocks
}

/// The order of the coordinate, gaps, and columns that are the same.
fn form(sheet: &Sheet) -> Vec<Finding> {
    let mut findings = Vec::new();
    if let Some(column) = coordinate(&sheet.columns) {
        for block in &sheet.blocks {
            let rows: Vec<usize> = block.rows.clone().collect();
            let falling = rows.len() > 2 && column.values[rows[1]] < column.values[rows[0]];
            for pair in rows.windows(2) {
                let (a, b) = (column.values[pair[0]], column.values[pair[1]]);
                let (a, b) = if falling { (-a, -b) } else { (a, b) };
                if b <= a {
                    let found = if a == b {
                        format!("{} twice", round(a.abs()))
                    } else {
                        format!("{} after {}", round(b.abs()), round(a.abs()))
                    };
                    let finding =
                        Finding::new(Check::Order, &[&column.name], found, "one row for each coordinate, in order");
                    findings.push(finding.of(&block.label).at(sheet.line(pair[1]), String::new()));
                }
            }
            for other in sheet.columns.iter().filter(|c| c.texts.is_empty()) {
                let there = |row: &usize| !other.values[*row].is_nan();
                let (Some(first), Some(last)) = (rows.iter().position(there), rows.iter().rposition(there)) else {
                    continue;
                };
                if let Some(row) = rows[first..=last].iter().find(|row| !there(row)) {
                    let finding = Finding::new(
                        Check::Missing,
                        &[&other.name],
                        "no number".into(),
                        "one between the rows before and after",
                    );
                    findings.push(finding.of(&block.label).at(sheet.line(*row), sheet.at(*row)).warning());
                }
            }
        }
    }
    // Spectra of which no column says what it is cannot be judged.
    let along = sheet.find(Quantity::Wavelength).map(|c| c.name.clone());
    let others: Vec<&Column> =
        sheet.columns.iter().filter(|c| c.texts.is_empty() && Some(&c.name) != along.as_ref()).collect();
    if along.is_some() && others.iter().all(|c| c.meaning.quantity == Quantity::Other) && !others.is_empty() {
        let names: Vec<&str> = others.iter().map(|c| c.name.as_str()).collect();
        let found = "names that say no quantity".to_owned();
        findings.push(Finding::new(Check::Columns, &names, found, "names such as urban_scattering_m2").warning());
    }
    for (i, a) in sheet.columns.iter().enumerate() {
        for b in &sheet.columns[i + 1..] {
            let varies = a.values.windows(2).any(|v| v[0] != v[1]);
            if varies && a.values.len() > 4 && a.values == b.values {
                let finding = Finding::new(
                    Check::Columns,
                    &[&a.name, &b.name],
                    "the same numbers in both".into(),
                    "columns that differ",
                );
                findings.push(finding.warning());
            }
        }
    }
    findings
}
