//! Figures of what the tables hold: each as SVG, as PNG, and as a CSV of the numbers shown.
//!
//! A figure is drawn from the written tables, through [`tables::views`], so it shows what a
//! renderer will use. One function makes each, and [`write()`] writes it. What the thesis had stands beside, dotted.

mod aerosol;
mod air;
pub mod atlas;
mod canvas;
pub mod chart;
mod coefficients;
pub mod colours;
mod depth;
mod grids;
pub mod ladder;
mod layout;
mod light;
pub mod model;
mod ozone;
mod picture;
mod settings;
pub mod stability;
mod text;

#[cfg(feature = "study")]
pub(crate) use layout::power_of_ten;
pub use picture::{png, svg};
pub use settings::{Settings, Units};

use crate::data::Data;
use crate::frame::Frame;
use crate::study::thesis::Thesis;
use model::Figure;
use polars::prelude::PolarsError;
use std::path::{Path, PathBuf};
use tables::TableError;
use tables::views::Biome;

/// Why a figure could not be made.
#[derive(Debug, thiserror::Error)]
pub enum PlotError {
    /// A table cannot be read or asked.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The numbers make no CSV.
    #[error("numbers of a figure: {0}")]
    Frame(#[from] PolarsError),
    /// Drawing or encoding failed.
    #[error("drawing: {0}")]
    Drawing(String),
    /// A month that is none, or a latitude, humidity or wavelength that the tables do not have.
    #[error("{name} {value}: {low} to {high} is possible")]
    Outside {
        /// What was asked for.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Lowest value.
        low: f64,
        /// Highest value.
        high: f64,
    },
    /// A figure of aerosols was asked for without any.
    #[error("{figure}: shows the aerosol of a biome, and none is chosen")]
    Clear {
        /// Its name.
        figure: &'static str,
    },
    /// A file or its folder cannot be written.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
}

impl PlotError {
    fn drawing(error: impl std::fmt::Display) -> Self {
        Self::Drawing(error.to_string())
    }
}

/// A figure and the numbers that it shows.
#[derive(Debug, Clone)]
pub struct Plot {
    /// What is drawn.
    pub figure: Figure,
    /// What is written beside it.
    pub frame: Frame,
}

/// The figures, in the order in which they are made. The first five redraw 5.1 to 5.5 of the thesis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Name {
    /// Number density, pressure and temperature of air.
    NumberDensity,
    /// Ozone by month at one latitude.
    OzoneMonths,
    /// Scattering and absorption cross-sections of molecules.
    CrossSections,
    /// Concentration and cross-sections of a biome's aerosol.
    Aerosol,
    /// Scattering, absorption and extinction against altitude.
    Coefficients,
    /// Vertical optical depth against wavelength, by species.
    OpticalDepth,
    /// Single-scattering albedo and asymmetry of the biomes against wavelength.
    AlbedoAsymmetry,
    /// Phase functions of the biomes.
    PhaseFunctions,
    /// Ozone column by month and latitude.
    OzoneLatitudes,
    /// Solar irradiance and limb darkening.
    Sun,
}

impl Name {
    /// Every figure.
    pub const ALL: [Self; 10] = [
        Self::NumberDensity,
        Self::OzoneMonths,
        Self::CrossSections,
        Self::Aerosol,
        Self::Coefficients,
        Self::OpticalDepth,
        Self::AlbedoAsymmetry,
        Self::PhaseFunctions,
        Self::OzoneLatitudes,
        Self::Sun,
    ];

    /// The name by which it is asked for and its files are called.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::NumberDensity => "number-density",
            Self::OzoneMonths => "ozone-months",
            Self::CrossSections => "cross-sections",
            Self::Aerosol => "aerosol",
            Self::Coefficients => "coefficients",
            Self::OpticalDepth => "optical-depth",
            Self::AlbedoAsymmetry => "albedo-asymmetry",
            Self::PhaseFunctions => "phase-functions",
            Self::OzoneLatitudes => "ozone-latitudes",
            Self::Sun => "sun",
        }
    }

    /// Whether it shows nothing in clear air.
    #[must_use]
    pub fn needs_biome(self) -> bool {
        matches!(self, Self::Aerosol | Self::AlbedoAsymmetry | Self::PhaseFunctions)
    }
}

/// Makes the figures of a name from the tables of a folder: one, or one for each biome. Gives their names, that of the
/// biome after a dash. With `thesis`, its values stand beside, dotted.
///
/// # Errors
/// [`PlotError`] if a table cannot be used, a setting lies outside the tables, or a figure of biomes has none.
pub fn make(
    name: Name,
    data: Data<'_>,
    settings: &Settings,
    thesis: Option<&Thesis>,
) -> Result<Vec<(String, Plot)>, PlotError> {
    settings.validate()?;
    let biomes = &settings.biomes;
    if biomes.is_empty() && name.needs_biome() {
        return Err(PlotError::Clear { figure: name.as_str() });
    }
    let of_biome = |biome: &Biome| format!("{}-{biome}", name.as_str());
    let plot = match name {
        Name::Aerosol => {
            let one = |b: &Biome| Ok((of_biome(b), aerosol::of_biome(data, settings, thesis, *b)?));
            return biomes.iter().map(one).collect();
        }
        Name::Coefficients if !biomes.is_empty() => {
            let one = |b: &Biome| {
                let plot = coefficients::against_altitude(data, settings, thesis, Some(*b))?;
                Ok((of_biome(b), plot))
            };
            return biomes.iter().map(one).collect();
        }
        Name::Coefficients => coefficients::against_altitude(data, settings, thesis, None)?,
        Name::NumberDensity => air::number_density(data, settings, thesis)?,
        Name::OzoneMonths => ozone::months(data, settings, thesis)?,
        Name::OzoneLatitudes => ozone::latitudes(data)?,
        Name::CrossSections => coefficients::cross_sections(data, settings, thesis)?,
        Name::OpticalDepth => depth::optical_depth(data, settings, thesis)?,
        Name::AlbedoAsymmetry => aerosol::albedo_asymmetry(data, settings, thesis)?,
        Name::PhaseFunctions => aerosol::phase_functions(data, settings, thesis)?,
        Name::Sun => light::sun(data)?,
    };
    Ok(vec![(name.as_str().to_owned(), plot)])
}

/// Writes `NAME.svg`, `NAME.png` and `NAME.csv` to a folder, which is made if it is not there, each
/// in one step. Gives the paths.
///
/// # Errors
/// [`PlotError`].
pub fn write(plot: &Plot, name: &str, folder: &Path) -> Result<[PathBuf; 3], PlotError> {
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |source| PlotError::Write { path, source }
    };
    std::fs::create_dir_all(folder).map_err(failed(folder))?;
    let paths = ["svg", "png", "csv"].map(|ending| folder.join(format!("{name}.{ending}")));
    let files = [svg(&plot.figure)?, png(&plot.figure)?, plot.frame.csv()?];
    for (path, bytes) in paths.iter().zip(files) {
        tables::file::replace(path, &bytes).map_err(failed(path))?;
    }
    Ok(paths)
}
