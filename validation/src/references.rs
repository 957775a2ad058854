//! Reading of `validation/references/`: each file as its README describes it.

use crate::ValidationError;
use std::path::{Path, PathBuf};

/// A file of `validation/references/`.
#[must_use]
pub fn path(root: &Path, file: &str) -> PathBuf {
    root.join("validation/references").join(file)
}

/// The bytes of a file.
///
/// # Errors
/// [`ValidationError::Reference`] if it cannot be read.
pub fn bytes(path: &Path) -> Result<Vec<u8>, ValidationError> {
    std::fs::read(path)
        .map_err(|e| ValidationError::Reference { path: path.into(), what: format!("cannot be read: {e}") })
}

/// A table of named columns; lines that begin with `#` are remarks.
#[derive(Debug, Clone, PartialEq)]
pub struct Sheet {
    path: PathBuf,
    header: Vec<String>,
    rows: Vec<Vec<String>>,
}

impl Sheet {
    /// Reads CSV.
    ///
    /// # Errors
    /// [`ValidationError::Reference`] if it cannot be read, is no CSV, or has lines of several lengths.
    pub fn read(path: &Path) -> Result<Self, ValidationError> {
        let bytes = bytes(path)?;
        let failed = |e: csv::Error| ValidationError::Reference { path: path.into(), what: e.to_string() };
        let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(&bytes[..]);
        let header = reader.headers().map_err(failed)?.iter().map(str::to_owned).collect();
        let rows = reader.records().map(|row| Ok(row.map_err(failed)?.iter().map(str::to_owned).collect()));
        Ok(Self { path: path.into(), header, rows: rows.collect::<Result<_, ValidationError>>()? })
    }

    /// How many rows.
    #[must_use]
    pub fn len(&self) -> usize {
        self.rows.len()
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// The names of the columns.
    #[must_use]
    pub fn header(&self) -> &[String] {
        &self.header
    }

    /// A cell.
    ///
    /// # Errors
    /// [`ValidationError::Reference`] if there is no such column or row.
    pub fn text(&self, row: usize, column: &str) -> Result<&str, ValidationError> {
        let at = self.header.iter().position(|name| name == column);
        let cell = at.and_then(|i| self.rows.get(row)?.get(i));
        cell.map(String::as_str).ok_or_else(|| self.failed(row, format!("no column {column}")))
    }

    /// A number.
    ///
    /// # Errors
    /// As [`Sheet::text`], and if it is none.
    pub fn number(&self, row: usize, column: &str) -> Result<f64, ValidationError> {
        let text = self.text(row, column)?;
        let number = text.trim().parse::<f64>().ok().filter(|x| x.is_finite());
        number.ok_or_else(|| self.failed(row, format!("{column}: expected a number, found {text}")))
    }

    /// All numbers of a column.
    ///
    /// # Errors
    /// As [`Sheet::number`].
    pub fn column(&self, column: &str) -> Result<Vec<f64>, ValidationError> {
        (0..self.len()).map(|row| self.number(row, column)).collect()
    }

    fn failed(&self, row: usize, what: String) -> ValidationError {
        ValidationError::Reference { path: self.path.clone(), what: format!("row {}: {what}", row + 1) }
    }
}
