//! Studies: how far numbers that should agree do not.
//!
//! A study computes from `raw-data/` or from reference values that the program carries, and where it compares with what
//! was made of them, from the tables; but for the figures, which draw what [`thesis`] had beside the tables, nothing in
//! Airlight uses what it finds. The figures of a study (with the feature `plot`) are drawn from its numbers.

mod aerosol_tables;
#[cfg(feature = "plot")]
mod figures;
mod interpolation;
mod large_spheres;
mod mie_speed;
mod mie_stability;
mod phase_fits;
mod rayleigh;
mod size_quadrature;
pub mod thesis;

#[cfg(feature = "plot")]
pub use figures::figure;

use crate::aerosol::AerosolError;
use crate::data::Data;
use crate::frame::Frame;
use crate::mie::MieError;
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
    /// A reference value that the program carries cannot be used.
    #[error("reference values {file}: {reason}")]
    Reference {
        /// The file, among those of the tests.
        file: &'static str,
        /// What is wrong with it.
        reason: String,
    },
    /// A sphere cannot be solved.
    #[error(transparent)]
    Mie(#[from] MieError),
    /// The optics of particles cannot be computed.
    #[error(transparent)]
    Aerosol(#[from] AerosolError),
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
    /// Classical algorithms and limits of Mie scattering against arbitrary precision.
    MieStability,
    /// Speed against error of Mie solvers.
    MieSpeed,
    /// Clouds and drops of water: rings and rainbows beside the theories of them.
    LargeSpheres,
    /// Henyey-Greenstein functions fitted to the phase functions of the biomes.
    PhaseFits,
    /// Averages over sizes: error against the number of radii.
    SizeQuadrature,
    /// Aerosol tables: error of radiance against size.
    AerosolTables,
}

impl Name {
    /// Every study.
    pub const ALL: [Self; 9] = [
        Self::Rayleigh,
        Self::Interpolation,
        Self::Thesis,
        Self::MieStability,
        Self::MieSpeed,
        Self::LargeSpheres,
        Self::PhaseFits,
        Self::SizeQuadrature,
        Self::AerosolTables,
    ];

    /// The name by which it is asked for; its files are called `study-NAME`.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Rayleigh => "rayleigh",
            Self::Interpolation => "interpolation",
            Self::Thesis => "thesis",
            Self::MieStability => "mie-stability",
            Self::MieSpeed => "mie-speed",
            Self::LargeSpheres => "large-spheres",
            Self::PhaseFits => "phase-fits",
            Self::SizeQuadrature => "size-quadrature",
            Self::AerosolTables => "aerosol-tables",
        }
    }
}

/// What a study gives.
#[derive(Debug, Clone)]
pub struct Results {
    /// Numbers, each with a figure of its own.
    pub parts: Vec<Part>,
    /// Lines in words, where the numbers lead to a verdict.
    pub remarks: Vec<String>,
}

/// Numbers of a study that one figure shows.
#[derive(Debug, Clone)]
pub struct Part {
    /// What tells its files from those of the other parts; empty where there is but one.
    pub name: &'static str,
    /// The numbers.
    pub frame: Frame,
}

impl From<Frame> for Results {
    /// A study of one part that says all.
    fn from(frame: Frame) -> Self {
        Self { parts: vec![Part { name: "", frame }], remarks: Vec::new() }
    }
}

/// Computes a study from the raw data and the tables made from them. Columns that belong to another abscissa than the
/// first stand beside it with gaps at the end.
///
/// # Errors
/// [`StudyError`].
pub fn make(name: Name, raw_dir: &Path, data: Data<'_>) -> Result<Results, StudyError> {
    match name {
        Name::Rayleigh => rayleigh::compare(raw_dir).map(Results::from),
        Name::Interpolation => interpolation::at_half_nodes(raw_dir).map(Results::from),
        Name::Thesis => thesis::compare(raw_dir, data).map(Results::from),
        Name::MieStability => mie_stability::compare(),
        Name::MieSpeed => mie_speed::measure(raw_dir),
        Name::LargeSpheres => large_spheres::compare(raw_dir),
        Name::PhaseFits => phase_fits::compare(data),
        Name::SizeQuadrature => size_quadrature::compare(raw_dir),
        Name::AerosolTables => aerosol_tables::compare(raw_dir),
    }
}

/// Writes `study-NAME.csv`, or `study-NAME-PART.csv` of each part where there are several, to a folder, which is made if it
/// is not there, and with the feature `plot` the figure as SVG and PNG. Gives the paths.
///
/// # Errors
/// [`StudyError`].
pub fn write(name: Name, results: &Results, folder: &Path) -> Result<Vec<PathBuf>, StudyError> {
    let mut paths = Vec::new();
    for part in &results.parts {
        let stem =
            ["study", name.as_str(), part.name].into_iter().filter(|s| !s.is_empty()).collect::<Vec<_>>().join("-");
        paths.extend(write_part(name, part, &stem, folder)?);
    }
    Ok(paths)
}

#[cfg(feature = "plot")]
fn write_part(name: Name, part: &Part, stem: &str, folder: &Path) -> Result<Vec<PathBuf>, StudyError> {
    let plot = crate::plot::Plot { figure: figure(name, part)?, frame: part.frame.clone() };
    Ok(crate::plot::write(&plot, stem, folder)?.into())
}

#[cfg(not(feature = "plot"))]
fn write_part(_: Name, part: &Part, stem: &str, folder: &Path) -> Result<Vec<PathBuf>, StudyError> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |source| StudyError::Write { path, source }
    };
    std::fs::create_dir_all(folder).map_err(failed(folder))?;
    let path = folder.join(format!("{stem}.csv"));
    tables::file::replace(&path, &part.frame.csv()?).map_err(failed(&path))?;
    Ok(vec![path])
}
