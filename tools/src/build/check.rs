//! Whether `data/` is what `raw-data/` makes: a rebuild in memory, compared value by value.

use super::{BuildError, Maker, Target};
use crate::aerosol::bulk::Rule;
use crate::raw::RawData;
use rayon::prelude::*;
use std::fmt;
use std::path::Path;
use tables::{Axis, Field, Table, TableError};

/// What a check found.
#[derive(Debug)]
pub struct CheckReport {
    /// One entry per file, in the order of [`Target::all`].
    pub tables: Vec<TableCheck>,
    /// Files of the folder that no build writes, sorted.
    pub foreign: Vec<String>,
}

/// What a check found in one table.
#[derive(Debug)]
pub struct TableCheck {
    /// Which one.
    pub target: Target,
    /// Largest |found / rebuilt - 1| of its values, also where all are within their tolerance.
    pub largest_relative: f64,
    /// Everything that differs by more than it may.
    pub differences: Vec<Difference>,
}

impl CheckReport {
    /// Whether nothing differs and nothing is missing or foreign.
    #[must_use]
    pub fn is_clean(&self) -> bool {
        self.foreign.is_empty() && self.tables.iter().all(|table| table.differences.is_empty())
    }
}

/// One thing in which a table differs from the rebuilt one.
#[derive(Debug)]
pub enum Difference {
    /// The file is not there.
    Missing,
    /// The file is no sound table.
    Unreadable(TableError),
    /// Something of the header: what, as rebuilt, as found.
    Header {
        /// What it is, such as `title` or `setting "fit"`.
        what: String,
        /// As rebuilt.
        expected: String,
        /// As found.
        found: String,
    },
    /// Values beyond their tolerance.
    Values {
        /// The field.
        field: String,
        /// How many values are beyond their tolerance.
        count: usize,
        /// How many there are.
        total: usize,
        /// Coordinates of the value that deviates most, in the axes' units.
        place: String,
        /// That value as rebuilt.
        expected: f64,
        /// That value as found.
        found: f64,
    },
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Missing => f.write_str("the file is missing"),
            Self::Unreadable(error) => error.fmt(f),
            Self::Header { what, expected, found } => write!(f, "{what}: {expected} rebuilt, {found} found"),
            Self::Values { field, count, total, place, expected, found } => write!(
                f,
                "{field}: {count} of {total} values beyond their tolerance, most at {place}: \
                 {expected:e} rebuilt, {found:e} found (relative {:.1e})",
                found / expected - 1.0
            ),
        }
    }
}

/// Rebuilds every table in memory, in parallel, and compares it with the file in `data_dir`: each
/// value within its field's tolerance, everything else exactly (but for the axes' nodes, within 1e-12, and
/// measured interpolation errors, within a tenth). Nothing is written. Hidden files, a `README.md` and
/// temporary files of a write (see [`tables::file::replace`]) are not foreign.
///
/// # Errors
/// [`BuildError`] if the inputs cannot be taken or the folder cannot be listed; what is wrong with the
/// tables is in the report.
pub fn check(raw_dir: &Path, data_dir: &Path) -> Result<CheckReport, BuildError> {
    check_some(raw_dir, data_dir, &Target::all(), &Rule::TABLES)
}

/// Compares the tables of `targets` alone, as [`check`] compares all, with a rule for averages over sizes. A file that only another build would write is
/// not foreign.
///
/// # Errors
/// As [`check`].
pub fn check_some(raw_dir: &Path, data_dir: &Path, targets: &[Target], rule: &Rule) -> Result<CheckReport, BuildError> {
    let raw = RawData::from_dir(raw_dir)?;
    let foreign = foreign_files(data_dir).map_err(|source| BuildError::Folder { path: data_dir.into(), source })?;
    let maker = Maker::new(&raw, targets, rule)?;
    let tables: Vec<Result<TableCheck, TableError>> = targets
        .par_iter()
        .map(|&target| {
            let expected = maker.table(target)?;
            let path = data_dir.join(target.file_name());
            if !path.exists() {
                return Ok(TableCheck { target, largest_relative: 0.0, differences: vec![Difference::Missing] });
            }
            Ok(match tables::file::read(&path) {
                Ok(found) => TableCheck {
                    target,
                    largest_relative: largest_relative(&expected, &found),
                    differences: differences(&expected, &found),
                },
                Err(error) => {
                    TableCheck { target, largest_relative: 0.0, differences: vec![Difference::Unreadable(error)] }
                }
            })
        })
        .collect();
    Ok(CheckReport { tables: tables.into_iter().collect::<Result<_, _>>()?, foreign })
}

fn foreign_files(data_dir: &Path) -> std::io::Result<Vec<String>> {
    let known: Vec<String> = Target::all().into_iter().map(Target::file_name).collect();
    let mut foreign = Vec::new();
    for entry in std::fs::read_dir(data_dir)? {
        let name = entry?.file_name().to_string_lossy().into_owned();
        let expected = name.starts_with('.') || name == "README.md" || tables::file::is_temporary(&name);
        if !(expected || known.contains(&name)) {
            foreign.push(name);
        }
    }
    foreign.sort();
    Ok(foreign)
}

/// Everything in which `found` differs from `expected` by more than it may.
pub(super) fn differences(expected: &Table, found: &Table) -> Vec<Difference> {
    let mut result = Vec::new();
    let mut compare = |what: &str, expected: String, found: String| {
        if expected != found {
            result.push(Difference::Header { what: what.into(), expected, found });
        }
    };
    compare("kind", expected.kind.to_string(), found.kind.to_string());
    compare("title", quoted(&expected.title), quoted(&found.title));
    for key in expected.settings.keys().chain(found.settings.keys().filter(|k| !expected.settings.contains_key(*k))) {
        let value = |table: &Table| table.settings.get(key).map_or("none".into(), |v| quoted(v));
        compare(&format!("setting {key:?}"), value(expected), value(found));
    }
    let files = |table: &Table| table.provenance.iter().map(|p| p.file.as_str()).collect::<Vec<_>>().join(", ");
    compare("inputs", files(expected), files(found));
    for (a, b) in expected.provenance.iter().zip(&found.provenance).filter(|(a, b)| a.file == b.file) {
        if a.sha256 == b.sha256 {
            compare(&format!("provenance of {}", a.file), format!("{a:?}"), format!("{b:?}"));
        } else {
            compare(&format!("SHA-256 of {}", a.file), a.sha256.clone(), b.sha256.clone());
        }
    }
    compare("axes", outline_of_axes(expected), outline_of_axes(found));
    compare("fields", outline_of_fields(expected), outline_of_fields(found));
    if outline_of_axes(expected) != outline_of_axes(found) || outline_of_fields(expected) != outline_of_fields(found) {
        // Values cannot be set against each other.
        return result;
    }
    for (a, b) in expected.axes.iter().zip(&found.axes) {
        if let Some((x, y)) = a.nodes.iter().zip(&b.nodes).find(|(x, y)| (*x - *y).abs() > 1e-12 * x.abs()) {
            let (expected, found) = (x.to_string(), y.to_string());
            result.push(Difference::Header { what: format!("node of axis {:?}", a.name), expected, found });
        }
    }
    for (a, b) in expected.fields.iter().zip(&found.fields) {
        let (x, y) = (a.interpolation_error.unwrap_or(0.0), b.interpolation_error.unwrap_or(0.0));
        if (x - y).abs() > 0.1 * x {
            let (expected, found) = (x.to_string(), y.to_string());
            result.push(Difference::Header { what: format!("interpolation error of {:?}", a.name), expected, found });
        }
        result.extend(values(expected, a, b));
    }
    result
}

fn quoted(text: &str) -> String {
    format!("{text:?}")
}

fn outline_of_axes(table: &Table) -> String {
    let one = |a: &Axis| {
        format!(
            "{} in {}, {} nodes, {:?}, {:?}, outside {:?}",
            a.name,
            a.unit,
            a.nodes.len(),
            a.spacing,
            a.interpolation,
            a.outside
        )
    };
    table.axes.iter().map(one).collect::<Vec<_>>().join("; ")
}

fn outline_of_fields(table: &Table) -> String {
    let one = |f: &Field| {
        let Field { name, unit, axes, precision, scale, .. } = f;
        format!("{name} in {unit} over {}, {precision:?}, {scale:?}", axes.join(" x "))
    };
    table.fields.iter().map(one).collect::<Vec<_>>().join("; ")
}

/// The values of a field beyond the tolerance of the rebuilt one, if any.
fn values(table: &Table, expected: &Field, found: &Field) -> Option<Difference> {
    let excess =
        |(a, b): (&f64, &f64)| (a - b).abs() / (expected.tolerance.absolute + expected.tolerance.relative * a.abs());
    let beyond = expected
        .values
        .iter()
        .zip(&found.values)
        .enumerate()
        .filter(|(_, (a, b))| !expected.tolerance.allows(**a, **b));
    let count = beyond.clone().count();
    let (index, (a, b)) = beyond.max_by(|x, y| excess(x.1).total_cmp(&excess(y.1)))?;
    Some(Difference::Values {
        field: expected.name.clone(),
        count,
        total: expected.values.len(),
        place: place(table, expected, index),
        expected: *a,
        found: *b,
    })
}

/// The coordinates of a value, such as `month 3, altitude 12000 m`.
fn place(table: &Table, field: &Field, mut index: usize) -> String {
    let mut parts = Vec::new();
    for axis in field.axes.iter().rev().filter_map(|name| table.axis(name).ok()) {
        let unit = if axis.unit == "1" { String::new() } else { format!(" {}", axis.unit) };
        parts.push(format!("{} {}{unit}", axis.name, axis.nodes[index % axis.nodes.len()]));
        index /= axis.nodes.len();
    }
    parts.reverse();
    if parts.is_empty() { "its only value".into() } else { parts.join(", ") }
}

/// Largest |found / rebuilt - 1| over the values of fields that both have.
fn largest_relative(expected: &Table, found: &Table) -> f64 {
    let pairs = expected.fields.iter().zip(&found.fields).flat_map(|(a, b)| a.values.iter().zip(&b.values));
    pairs.filter(|(a, b)| a != b).map(|(a, b)| (b / a - 1.0).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
#[path = "check_tests.rs"]
mod tests;
