//! People's own inputs: from a CSV file of theirs to a table that the renderer takes like its own.
//!
//! One file per kind: [`aerosol`], [`atmosphere`], [`ozone`], [`sun`], [`albedo`]. Each has a type that is read by
//! `parse(name, bytes, ignored)`, with the checks that the files of `raw-data/` get, and a function that makes the
//! table. `docs/own-inputs.md` has an example of each.

pub mod aerosol;
pub mod albedo;
pub mod atmosphere;
pub mod ozone;
pub mod sun;

mod sheet;
mod units;

use crate::aerosol::AerosolError;
use crate::raw::RawError;
use std::path::Path;
use tables::{Table, TableError};

/// Why no table can be made of somebody's own input.
#[derive(Debug, thiserror::Error)]
pub enum OwnError {
    /// A file cannot be taken.
    #[error(transparent)]
    Input(#[from] RawError),
    /// Numbers that make no table.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Particles whose optics cannot be computed.
    #[error(transparent)]
    Aerosol(#[from] AerosolError),
    /// Choices that do not go together, or one that is out of its range.
    #[error("{0}")]
    Refused(String),
}

/// A table made of somebody's own input, and what there is to say about it.
#[derive(Debug, Clone, PartialEq)]
pub struct Import {
    /// The table.
    pub table: Table,
    /// What was found, one sentence each.
    pub notes: Vec<String>,
}

impl Import {
    /// Reads the table through the view of its kind, as the renderer will, and writes it under `path` in one step.
    /// Gives the size in bytes.
    ///
    /// # Errors
    /// [`TableError`] if the view refuses it or the file cannot be written.
    pub fn write(&self, path: &Path) -> Result<u64, TableError> {
        crate::build::accept(&self.table)?;
        tables::file::write(path, &self.table)
    }
}

/// Refuses what is not in `low..=high`.
fn range(what: &str, value: f64, low: f64, high: f64, unit: &str) -> Result<(), OwnError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(OwnError::Refused(format!("{what} is {value}; {low} to {high}{unit} is possible")))
}
