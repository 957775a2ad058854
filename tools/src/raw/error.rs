//! What can be wrong with a measured input: where, what was expected, what was found.

use tables::excerpt;

/// An input file that cannot be taken: the file, the place in it, and what is wrong there.
#[derive(Debug, thiserror::Error)]
#[error("{}", self.describe())]
pub struct RawError {
    /// Path below `raw-data/`, with forward slashes; of an own input the name of the file alone.
    pub file: String,
    /// Line, counted from 1, where the fault belongs to one.
    pub line: Option<u64>,
    /// Column, where the fault belongs to one.
    pub column: Option<String>,
    /// What is wrong.
    pub fault: Box<Fault>,
}

/// The kinds of fault in an input file.
#[derive(Debug, thiserror::Error)]
pub enum Fault {
    /// The operating system refused to read the file.
    #[error("cannot be read: {0}")]
    Unreadable(std::io::Error),
    /// The bytes are not UTF-8.
    #[error("expected UTF-8 text, found other bytes")]
    NotUtf8,
    /// A line that begins with `#` but is not `# key: value`.
    #[error("expected \"# key: value\", found {found:?}")]
    MalformedHeader {
        /// The line without its `#`.
        found: String,
    },
    /// A key that the header must have.
    #[error("expected a header line \"# {key}: ...\", found none")]
    MissingKey {
        /// The key.
        key: String,
    },
    /// A column of another name than the one that the reader needs there.
    #[error("expected this name as column {position}, found {found:?}")]
    MissingColumn {
        /// Position counted from 1.
        position: usize,
        /// What the header row has there; empty if it ends before.
        found: String,
    },
    /// A column too many.
    #[error("expected no further column")]
    UnexpectedColumn,
    /// A unit other than the one that the reader converts from.
    #[error("expected the unit {expected:?}, found {found:?}")]
    UnexpectedUnit {
        /// Unit that the reader converts from.
        expected: String,
        /// Unit in the header; empty if there is none.
        found: String,
    },
    /// A row that does not fit its columns.
    #[error("malformed row: {found}")]
    MalformedRow {
        /// What does not fit.
        found: String,
    },
    /// A field that is no number.
    #[error("expected a number, found {found:?}")]
    NotANumber {
        /// The field.
        found: String,
    },
    /// A number that is infinite or NaN.
    #[error("expected a finite number, found {found:?}")]
    NotFinite {
        /// The field.
        found: String,
    },
    /// A number outside what is physically sensible.
    #[error("expected {low} to {high}{}, found {found}", suffix(unit))]
    OutOfRange {
        /// Lowest value allowed.
        low: f64,
        /// Highest value allowed.
        high: f64,
        /// Unit of the column.
        unit: String,
        /// The field.
        found: String,
    },
    /// A key that does not grow from one row to the next.
    #[error("expected more than {previous} of the row before, found {found}")]
    NotIncreasing {
        /// The key one row before.
        previous: String,
        /// The key.
        found: String,
    },
    /// A column that the reader of an own input does not understand.
    #[error("expected one of {understood}, or that it is left out (--ignore){hint}")]
    UnknownColumn {
        /// Names that are understood.
        understood: String,
        /// What was probably meant, after a semicolon; or nothing.
        hint: String,
    },
    /// A row of an own input that does not go on from the one before.
    #[error("expected {wanted} than in line {line}, found {found}: {remedy}")]
    OutOfOrder {
        /// `more` or `less`.
        wanted: &'static str,
        /// Line of the row before.
        line: u64,
        /// The field.
        found: String,
        /// What to do.
        remedy: &'static str,
    },
    /// No row after the header row, or no header row.
    #[error("expected at least one row, found none")]
    NoRows,
    /// Another number of rows than the source has.
    #[error("expected {expected} rows, found {found}")]
    WrongCount {
        /// Rows of the source.
        expected: usize,
        /// Rows in the file.
        found: usize,
    },
    /// A value that contradicts what the source says elsewhere.
    #[error("expected {expected}, found {found}")]
    Unexpected {
        /// What the reader needs.
        expected: String,
        /// What the file has.
        found: String,
    },
}

impl RawError {
    pub(crate) fn new(file: &str, fault: Fault) -> Self {
        Self { file: file.into(), line: None, column: None, fault: Box::new(fault) }
    }

    pub(crate) fn in_file(self, file: &str) -> Self {
        Self { file: file.into(), ..self }
    }

    pub(crate) fn at_line(self, line: u64) -> Self {
        Self { line: Some(line), ..self }
    }

    pub(crate) fn in_column(self, column: &str) -> Self {
        Self { column: Some(column.into()), ..self }
    }

    fn describe(&self) -> String {
        let mut text = self.file.clone();
        if let Some(line) = self.line {
            text += &format!(", line {line}");
        }
        if let Some(column) = &self.column {
            text += &format!(", column {}", excerpt(&format!("{column:?}")));
        }
        format!("{text}: {}", self.fault)
    }
}

/// The unit after a space; nothing for a number without unit.
fn suffix(unit: &str) -> String {
    if unit == "1" { String::new() } else { format!(" {unit}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_columns_are_cut() {
        let error = |name: &str| RawError::new("a.csv", Fault::NotUtf8).in_column(name).to_string();
        assert!(error("h").contains("column \"h\": "));
        // Also of characters that are written with six.
        assert!(["\"", "\u{1e}"].iter().all(|odd| error(&odd.repeat(5000)).len() < 1000));
    }
}
