//! Studies: how far numbers that should agree do not.
//!
//! A study computes from `raw-data/`, and where it compares with what was made of them, from the tables; but for the
//! figures, which draw what [`thesis`] had beside the tables, nothing in Airlight uses what it finds. The `figure` of
//! a study (with the feature `plot`) is drawn from its numbers.

#[cfg(feature = "plot")]
mod figures;
mod interpolation;
mod rayleigh;
pub mod thesis;

#[cfg(feature = "plot")]
pub use figures::figure;

use crate::data::Data;
use crate::frame::Frame;
use crate::raw::RawError;
use polars::prelude::PolarsError;
use std::path::{Path, PathBuf};
use tables::TableError;

/// Why a study could not be made.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// An input cannot be taken.
    #[error("raw data {0}")]
    Raw(#[from] RawError),
    /// A value cannot be computed.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The numbers make no CSV.
    #[error("numbers of a study: {0}")]
    Frame(#[from] PolarsError),
    /// The figure cannot be drawn or written.
    #[cfg(feature = "plot")]
    #[error(transparent)]
    Plot(#[from] crate::plot::PlotError),
    /// A file or its folder cannot be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

/// The studies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Name {
    /// Bucholtz' formula against his table 2 and his fit.
    Rayleigh,
    /// What interpolation between the nodes of the tables misses.
    Interpolation,
    /// Ozone, air and aerosols of the thesis' code against those of the tables.
    Thesis,
}

impl Name {
    /// Every study.
    pub const ALL: [Self; 3] = [Self::Rayleigh, Self::Interpolation, Self::Thesis];

    /// The name by which it is asked for; its files are called `study-NAME`.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Rayleigh => "rayleigh",
            Self::Interpolation => "interpolation",
            Self::Thesis => "thesis",
        }
    }
}

/// Computes a study from the raw data and the tables made from them. Columns that belong to another abscissa than the first stand
/// beside it with gaps at the end.
///
/// # Errors
/// [`StudyError`].
pub fn make(name: Name, raw_dir: &Path, data: Data<'_>) -> Result<Frame, StudyError> {
    match name {
        Name::Rayleigh => rayleigh::compare(raw_dir),
        Name::Interpolation => interpolation::at_half_nodes(raw_dir),
        Name::Thesis => thesis::compare(raw_dir, data),
    }
}

/// Writes `study-NAME.csv` to a folder, which is made if it is not there, and with the feature `plot`
/// the figure as SVG and PNG. Gives the paths.
///
/// # Errors
/// [`StudyError`].
pub fn write(name: Name, frame: &Frame, folder: &Path) -> Result<Vec<PathBuf>, StudyError> {
    let stem = format!("study-{}", name.as_str());
    #[cfg(feature = "plot")]
    {
        let plot = crate::plot::Plot { figure: figure(name, frame)?, frame: frame.clone() };
        Ok(crate::plot::write(&plot, &stem, folder)?.into())
    }
    #[cfg(not(feature = "plot"))]
    {
        let failed = |path: &Path| {
            let path = path.to_path_buf();
            move |source| StudyError::Write { path, source }
        };
        std::fs::create_dir_all(folder).map_err(failed(folder))?;
        let path = folder.join(format!("{stem}.csv"));
        tables::file::replace(&path, &frame.csv()?).map_err(failed(&path))?;
        Ok(vec![path])
    }
}
