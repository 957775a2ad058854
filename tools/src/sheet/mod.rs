//! A sheet: columns of numbers and words with their units and meanings, what chose them and where they came from; and
//! its forms as text, CSV, JSON and Parquet.
//!
//! A number in CSV and JSON has the shortest digits that give the double back, in Parquet it is the double; in text it
//! has six digits. A value that does not exist is empty in CSV, `null` in JSON and Parquet, `-` in text.

mod form;
#[cfg(feature = "parquet")]
mod parquet;
mod text;

pub use form::json_list;

use crate::sources::Sources;
use std::path::Path;

/// Why a sheet cannot be written.
#[derive(Debug, thiserror::Error)]
pub enum SheetError {
    /// The name of a file says nothing of its format.
    #[error("{file}: which format? name it with --format, or end the name in .txt, .csv, .json or .parquet")]
    NoFormat {
        /// The file.
        file: String,
    },
    /// This program was built without Parquet.
    #[error("this program was built without Parquet: text, csv and json are possible")]
    NoParquet,
    /// Columns that make no sheet, or that a library does not take.
    #[error("{0}")]
    Malformed(String),
}

/// What a sheet is written as.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Aligned columns for people.
    Text,
    /// Comma-separated values behind `# key: value` lines, as the files of `raw-data/`.
    Csv,
    /// One JSON object.
    Json,
    /// Apache Parquet.
    Parquet,
}

impl Format {
    /// The names of all in flags.
    pub const NAMES: [&'static str; 4] = ["text", "csv", "json", "parquet"];

    /// The format of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        let all = [Self::Text, Self::Csv, Self::Json, Self::Parquet];
        Self::NAMES.iter().zip(all).find(|(known, _)| **known == name).map(|(_, format)| format)
    }

    /// The format that the ending of a file's name says: `.txt`, `.csv`, `.json`, `.parquet`.
    ///
    /// # Errors
    /// [`SheetError::NoFormat`] for any other.
    pub fn of_file(path: &Path) -> Result<Self, SheetError> {
        let ending = path.extension().and_then(|ending| ending.to_str()).map(str::to_lowercase);
        let format = match ending.as_deref() {
            Some("txt") => Some(Self::Text),
            Some(ending) => Self::from_name(ending).filter(|format| *format != Self::Text),
            None => None,
        };
        format.ok_or_else(|| SheetError::NoFormat { file: path.display().to_string() })
    }
}

/// Values of a column, one for each row.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Finite numbers; `None` where there is none.
    Numbers(Vec<Option<f64>>),
    /// Words.
    Words(Vec<String>),
}

impl Values {
    /// Number of rows.
    #[must_use]
    pub fn len(&self) -> usize {
        match self {
            Self::Numbers(values) => values.len(),
            Self::Words(values) => values.len(),
        }
    }

    /// Whether there is no row.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

/// A column.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Its name in files, which ends in its unit.
    pub name: String,
    /// Its name in text, below the heading of its group and above its unit.
    pub label: String,
    /// Its unit; `1` for a number without, `text` for words.
    pub unit: String,
    /// What it means, in one phrase.
    pub meaning: String,
    /// Under which heading it stands in text; `None` for a key, which stands in all of them.
    pub group: Option<&'static str>,
    /// Its values.
    pub values: Values,
}

/// Columns of equal length, and what there is to say of them.
#[derive(Debug, Clone)]
pub struct Sheet {
    /// One phrase.
    pub title: String,
    /// What chose the numbers, in order.
    pub settings: Vec<(String, String)>,
    /// Tables and inputs that the numbers came from.
    pub sources: Sources,
    /// The columns.
    pub columns: Vec<Series>,
}

impl Sheet {
    /// A sheet whose columns are checked.
    ///
    /// # Errors
    /// [`SheetError::Malformed`] if there is no column, lengths differ, a name is used twice or a number is not finite.
    pub fn new(
        title: String,
        settings: Vec<(String, String)>,
        sources: Sources,
        columns: Vec<Series>,
    ) -> Result<Self, SheetError> {
        let fail = |text: String| Err(SheetError::Malformed(text));
        let Some(first) = columns.first() else { return fail("a sheet without columns".into()) };
        for (i, column) in columns.iter().enumerate() {
            if column.values.len() != first.values.len() {
                return fail(format!("columns {:?} and {:?} differ in length", first.name, column.name));
            }
            if columns[..i].iter().any(|other| other.name == column.name) {
                return fail(format!("two columns are called {:?}", column.name));
            }
            if let Values::Numbers(values) = &column.values
                && values.iter().flatten().any(|value| !value.is_finite())
            {
                return fail(format!("column {:?} holds a number that is not finite", column.name));
            }
        }
        Ok(Self { title, settings, sources, columns })
    }

    /// Number of rows.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.columns[0].values.len()
    }

    /// The bytes of the sheet in a format; with `bare`, text and CSV without what is said of the numbers.
    ///
    /// # Errors
    /// [`SheetError::NoParquet`], or [`SheetError::Malformed`] for what a library does not take.
    pub fn encode(&self, format: Format, bare: bool) -> Result<Vec<u8>, SheetError> {
        match format {
            Format::Text => Ok(self.text(bare).into_bytes()),
            Format::Csv => self.csv(bare),
            Format::Json => self.json().map(String::into_bytes),
            #[cfg(feature = "parquet")]
            Format::Parquet => self.parquet(),
            #[cfg(not(feature = "parquet"))]
            Format::Parquet => Err(SheetError::NoParquet),
        }
    }
}

#[cfg(test)]
mod tests;
