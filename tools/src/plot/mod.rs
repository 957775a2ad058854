//! Figures of what the tables hold: each as SVG, as PNG, and as a CSV of the numbers shown.
//!
//! A figure is drawn from the written tables, through [`tables::views`], so it shows what a
//! renderer will use. One function makes each, and [`write()`] writes it.

mod air;
mod canvas;
mod coefficients;
pub mod colours;
mod layout;
mod light;
pub mod model;
mod ozone;
mod picture;
mod text;

#[cfg(feature = "study")]
pub(crate) use layout::power_of_ten;
pub use picture::{png, svg};

use crate::data::Data;
use crate::frame::Frame;
use model::Figure;
use polars::prelude::PolarsError;
use std::path::{Path, PathBuf};
use tables::TableError;

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
    /// A month that is none, or a latitude or wavelength that the tables do not have.
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

/// The figures, in the order in which they are made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Name {
    /// Number density, pressure and temperature of air.
    NumberDensity,
    /// Ozone by month at one latitude.
    OzoneMonths,
    /// Ozone column by month and latitude.
    OzoneLatitudes,
    /// Scattering and absorption cross-sections.
    CrossSections,
    /// Scattering, absorption and extinction against altitude.
    Coefficients,
    /// Vertical optical depth against wavelength.
    OpticalDepth,
    /// Solar irradiance and limb darkening.
    Sun,
}

impl Name {
    /// Every figure.
    pub const ALL: [Self; 7] = [
        Self::NumberDensity,
        Self::OzoneMonths,
        Self::OzoneLatitudes,
        Self::CrossSections,
        Self::Coefficients,
        Self::OpticalDepth,
        Self::Sun,
    ];

    /// The name by which it is asked for and its files are called.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::NumberDensity => "number-density",
            Self::OzoneMonths => "ozone-months",
            Self::OzoneLatitudes => "ozone-latitudes",
            Self::CrossSections => "cross-sections",
            Self::Coefficients => "coefficients",
            Self::OpticalDepth => "optical-depth",
            Self::Sun => "sun",
        }
    }
}

/// What a figure that shows one case shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settings {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// Month, 1 to 12.
    pub month: u8,
    /// Latitude, degrees, north positive.
    pub latitude_deg: f64,
}

impl Default for Settings {
    /// Green light in June at 45 degrees north.
    fn default() -> Self {
        Self { wavelength_nm: 550.0, month: 6, latitude_deg: 45.0 }
    }
}

impl Settings {
    /// Refuses what the tables do not have.
    fn validate(&self) -> Result<(), PlotError> {
        let (short, long) = tables::units::WAVELENGTH_RANGE_NM;
        for (name, value, low, high) in [
            ("wavelength in nm", self.wavelength_nm, short, long),
            ("month", f64::from(self.month), 1.0, 12.0),
            ("latitude in degrees", self.latitude_deg, -90.0, 90.0),
        ] {
            if !(low..=high).contains(&value) {
                return Err(PlotError::Outside { name, value, low, high });
            }
        }
        Ok(())
    }

    /// The case in words: "June, 45° N".
    fn place(&self) -> String {
        let month = MONTHS[usize::from(self.month.clamp(1, 12)) - 1];
        format!("{month}, {}", latitude(self.latitude_deg))
    }
}

/// Names of the months.
const MONTHS: [&str; 12] = [
    "January",
    "February",
    "March",
    "April",
    "May",
    "June",
    "July",
    "August",
    "September",
    "October",
    "November",
    "December",
];

/// A latitude in words.
fn latitude(degrees: f64) -> String {
    let side = if degrees < 0.0 { " S" } else { " N" };
    format!("{}°{}", degrees.abs(), if degrees == 0.0 { "" } else { side })
}

/// Makes a figure from the tables of a folder.
///
/// # Errors
/// [`PlotError`] if a table cannot be used or a setting lies outside the tables.
pub fn make(name: Name, data: Data<'_>, settings: &Settings) -> Result<Plot, PlotError> {
    settings.validate()?;
    match name {
        Name::NumberDensity => air::number_density(data),
        Name::OzoneMonths => ozone::months(data, settings),
        Name::OzoneLatitudes => ozone::latitudes(data),
        Name::CrossSections => coefficients::cross_sections(data),
        Name::Coefficients => coefficients::against_altitude(data, settings),
        Name::OpticalDepth => coefficients::optical_depth(data, settings),
        Name::Sun => light::sun(data),
    }
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

/// Points (value, altitude in km) of values at altitudes in m.
fn against_km(values: &[f64], altitudes: &[f64]) -> Vec<(f64, f64)> {
    values.iter().zip(altitudes).map(|(&v, &z)| (v, z / tables::units::KM)).collect()
}

/// Points (x, y).
fn points(x: &[f64], y: &[f64]) -> Vec<(f64, f64)> {
    x.iter().copied().zip(y.iter().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_in_words() {
        assert_eq!(Settings::default().place(), "June, 45° N");
        assert_eq!([latitude(-12.5), latitude(0.0)], ["12.5° S", "0°"]);
    }

    #[test]
    fn settings_outside_the_tables_are_refused() {
        let ok = Settings::default();
        assert!(ok.validate().is_ok());
        assert!(Settings { month: 13, ..ok }.validate().is_err());
        assert!(Settings { wavelength_nm: f64::NAN, ..ok }.validate().is_err());
        let error = Settings { latitude_deg: 91.0, ..ok }.validate().expect_err("outside");
        assert_eq!(error.to_string(), "latitude in degrees 91: -90 to 90 is possible");
    }
}
