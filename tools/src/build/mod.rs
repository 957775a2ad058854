//! What is written to `data/`: one function per kind of table, and the run that makes them all.
//!
//! The same inputs give the same bytes: nothing of the clock, the machine or the order of threads
//! enters a table. Every table is read back through the `tables` crate before it is reported.

pub(crate) mod aerosol;
pub(crate) mod air;
mod check;
mod ground;
pub(crate) mod light;
mod ozone;

pub use check::{CheckReport, Difference, TableCheck, check, check_some};

use crate::aerosol::bulk::Rule;
use crate::aerosol::recipe::Recipe;
use crate::raw::{RawData, RawError};
use rayon::prelude::*;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use tables::views::{Aerosol, AerosolSource, Biome, Origin};
use tables::{Axis, Field, Kind, Precision, Scale, Table, TableError, Tolerance, views};

/// Why tables could not be made.
#[derive(Debug, thiserror::Error)]
pub enum BuildError {
    /// An input cannot be taken.
    #[error("raw data {0}")]
    Raw(#[from] RawError),
    /// A table cannot be computed, written or read back.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The folder of the tables cannot be made or listed.
    #[error("{}: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A file holds something else than what was written to it.
    #[error("{}: read back other than written: {difference}", path.display())]
    ReadBack {
        /// The file.
        path: PathBuf,
        /// The first difference.
        difference: Box<Difference>,
    },
}

/// One file of `data/`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Target {
    /// The only table of a kind.
    Single(Kind),
    /// The aerosol of a source and biome.
    Aerosol(AerosolSource, Biome),
}

impl Target {
    /// Every file, in the order in which `data/` is listed: [`Kind::ALL`], then the aerosols by source and biome.
    #[must_use]
    pub fn all() -> Vec<Self> {
        let aerosols = AerosolSource::ALL.into_iter().flat_map(|s| Biome::ALL.map(|b| Self::Aerosol(s, b)));
        Kind::ALL.into_iter().map(Self::Single).chain(aerosols).collect()
    }

    /// Name of the file.
    #[must_use]
    pub fn file_name(self) -> String {
        match self {
            Self::Single(kind) => kind.file_name(),
            Self::Aerosol(source, biome) => Aerosol::file_name(source, biome),
        }
    }
}

/// A table that was written and read back.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Built {
    /// Which one.
    pub target: Target,
    /// Size of the file.
    pub bytes: u64,
    /// Time to compute, write and read back; the optics that several aerosols share are not counted.
    pub time: Duration,
}

/// Makes every table of `data_dir` from `raw_dir`, in parallel, and calls `progress` as each is
/// finished. A file is replaced in one step: a run that fails leaves each table either new or as it
/// was. The result is in the order of [`Target::all`].
///
/// # Errors
/// [`BuildError`], of the first table in that order that failed.
pub fn build(raw_dir: &Path, data_dir: &Path, progress: impl Fn(&Built) + Sync) -> Result<Vec<Built>, BuildError> {
    build_some(raw_dir, data_dir, &Target::all(), &Rule::TABLES, progress)
}

/// Makes the tables of `targets` alone, as [`build`] makes all, with a rule for averages over sizes.
///
/// # Errors
/// As [`build`].
pub fn build_some(
    raw_dir: &Path,
    data_dir: &Path,
    targets: &[Target],
    rule: &Rule,
    progress: impl Fn(&Built) + Sync,
) -> Result<Vec<Built>, BuildError> {
    let raw = RawData::from_dir(raw_dir)?;
    std::fs::create_dir_all(data_dir).map_err(|source| BuildError::Folder { path: data_dir.into(), source })?;
    let maker = Maker::new(&raw, targets, rule)?;
    let results: Vec<Result<Built, BuildError>> = targets
        .par_iter()
        .map(|&target| {
            let built = build_one(&maker, data_dir, target)?;
            progress(&built);
            Ok(built)
        })
        .collect();
    results.into_iter().collect()
}

fn build_one(maker: &Maker, data_dir: &Path, target: Target) -> Result<Built, BuildError> {
    let start = Instant::now();
    let path = data_dir.join(target.file_name());
    let table = maker.table(target)?;
    let bytes = tables::file::write(&path, &table)?;
    let back = tables::file::read(&path)?;
    accept(&back).map_err(|e| e.at(&path))?;
    match check::differences(&table, &back).into_iter().next() {
        None => Ok(Built { target, bytes, time: start.elapsed() }),
        Some(difference) => Err(BuildError::ReadBack { path, difference: Box::new(difference) }),
    }
}

/// Computes tables from inputs, and what several of them share only once.
struct Maker<'a> {
    raw: &'a RawData,
    recipes: Vec<Recipe>,
    aerosols: aerosol::Prepared,
}

impl<'a> Maker<'a> {
    fn new(raw: &'a RawData, targets: &[Target], rule: &Rule) -> Result<Self, TableError> {
        let aerosol = |target: &Target| match *target {
            Target::Single(_) => None,
            Target::Aerosol(source, biome) => Some((source, biome)),
        };
        let aerosols: Vec<_> = targets.iter().filter_map(aerosol).collect();
        let recipes = aerosol::recipes(raw, &aerosols)?;
        Ok(Self { raw, aerosols: aerosol::prepare((&raw.aerosol_opac).into(), &recipes, rule)?, recipes })
    }

    fn table(&self, target: Target) -> Result<Table, TableError> {
        match target {
            Target::Single(kind) => table(self.raw, kind),
            Target::Aerosol(source, biome) => {
                let recipe = self.recipes.iter().find(|recipe| recipe.origin == Origin::Biome(source, biome));
                let none = || TableError::Inconsistent(format!("no recipe of {source} for {biome}"));
                let provenance = aerosol::provenance(self.raw, source);
                aerosol::table((&self.raw.aerosol_opac).into(), &self.aerosols, recipe.ok_or_else(none)?, provenance)
            }
        }
    }
}

/// The table of a kind of which there is one, computed from the inputs.
///
/// # Errors
/// [`TableError`] if the inputs make no valid table of that kind, or for [`Kind::Aerosol`], of which there are many.
pub fn table(raw: &RawData, kind: Kind) -> Result<Table, TableError> {
    match kind {
        Kind::StandardAtmosphere => air::standard_atmosphere(raw),
        Kind::Rayleigh => air::rayleigh(raw),
        Kind::OzoneCrossSection => ozone::cross_section(raw),
        Kind::OzoneProfiles => ozone::profiles(raw),
        Kind::OzoneLayers => ozone::layers(raw),
        Kind::Sun => light::sun(raw),
        Kind::Observer => light::observer(raw),
        Kind::GroundAlbedo => ground::albedo(raw),
        Kind::Aerosol => Err(TableError::Inconsistent("an aerosol table needs a source and a biome".into())),
        Kind::SolvedSky => Err(TableError::Inconsistent("a solved sky is the renderer's".into())),
    }
}

/// Reads a table through the typed view of its kind, as the renderer will.
pub(crate) fn accept(table: &Table) -> Result<(), TableError> {
    match table.kind {
        Kind::StandardAtmosphere => views::StandardAtmosphere::from_table(table).map(drop),
        Kind::Rayleigh => views::Rayleigh::from_table(table).map(drop),
        Kind::OzoneCrossSection => views::OzoneCrossSection::from_table(table).map(drop),
        Kind::OzoneProfiles => views::OzoneProfiles::from_table(table).map(drop),
        Kind::OzoneLayers => views::OzoneLayers::from_table(table).map(drop),
        Kind::Sun => views::Sun::from_table(table).map(drop),
        Kind::Observer => views::Observer::from_table(table).map(drop),
        Kind::GroundAlbedo => views::GroundAlbedo::from_table(table).map(drop),
        Kind::Aerosol => views::Aerosol::from_table(table).map(drop),
        Kind::SolvedSky => Ok(()),
    }
}

/// Single precision where its rounding, 6e-8, is a hundred times below the error that the values
/// have anyway (of interpolation, or of the data), else double.
fn precision(relative_error: f64) -> Precision {
    if relative_error > 6e-6 { Precision::F32 } else { Precision::F64 }
}

/// A field over named axes, linear between nodes, stored for values with the given relative error.
pub(crate) fn field(name: &str, unit: &str, axes: &[&str], relative_error: f64, values: Vec<f64>) -> Field {
    let precision = precision(relative_error);
    // Storage rounds by half of this; and exp, ln and powf differ between machines by a few 1e-16,
    // which sums and powers raise to some 1e-13.
    let relative = match precision {
        Precision::F32 => f64::from(f32::EPSILON),
        Precision::F64 => 1e-12,
    };
    Field {
        name: name.into(),
        unit: unit.into(),
        axes: axes.iter().map(|&axis| axis.into()).collect(),
        precision,
        scale: Scale::Linear,
        tolerance: Tolerance { relative, absolute: 0.0 },
        interpolation_error: None,
        values,
    }
}

/// The months 1 to 12; nothing between.
fn months() -> Result<Axis, TableError> {
    Ok(Axis::uniform(views::MONTH.0, views::MONTH.1, 1.0, 1.0, 12)?.between(tables::Interpolation::Node))
}

/// Two significant digits, so that the last bits of a machine do not show in a header.
pub(crate) fn two_digits(x: f64) -> f64 {
    format!("{x:.1e}").parse().unwrap_or(x)
}

/// Largest |a / b - 1| of (a, b), to two digits.
pub(crate) fn largest_relative(pairs: impl IntoIterator<Item = (f64, f64)>) -> f64 {
    two_digits(pairs.into_iter().map(|(a, b)| (a / b - 1.0).abs()).fold(0.0, f64::max))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn single_precision_is_for_values_that_are_not_known_better() {
        assert_eq!(precision(1e-3), Precision::F32);
        assert_eq!(precision(1e-7), Precision::F64);
    }

    #[test]
    fn numbers_of_a_header_keep_two_digits() {
        assert_eq!(two_digits(2.284e-5), 2.3e-5);
        assert_eq!(two_digits(0.0), 0.0);
    }
}
