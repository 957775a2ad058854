//! A table for programs that do not read the format: every axis and field as a [`Sheet`], or whole as JSON.

use crate::sheet::{Series, Sheet, SheetError, Values, json_list};
use crate::sources::Sources;
use serde::Serialize;
use tables::{Axis, Field, Interpolation, Outside, Precision, Scale, Spacing, Table, Tolerance};

/// Why a table cannot be exported so.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// The sheet cannot be made.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// A field that the table does not have.
    #[error("no field is called {name:?}: possible are {}", known.join(", "))]
    NoField {
        /// The name.
        name: String,
        /// Names that there are.
        known: Vec<String>,
    },
    /// Fields that do not fit in one set of rows.
    #[error("its fields do not fit in one set of rows: choose with --field, or take json. Together go {}", sets.join("; "))]
    ManySets {
        /// The fields that go together, and their axes.
        sets: Vec<String>,
    },
}

/// The fields called `names`, or all if there is none.
fn chosen<'a>(table: &'a Table, names: &[String]) -> Result<Vec<&'a Field>, ExportError> {
    let known = || table.fields.iter().map(|field| field.name.clone()).collect();
    if let Some(name) = names.iter().find(|name| !table.fields.iter().any(|field| field.name == **name)) {
        return Err(ExportError::NoField { name: name.clone(), known: known() });
    }
    Ok(table.fields.iter().filter(|field| names.is_empty() || names.contains(&field.name)).collect())
}

/// Fields as columns, in a row for each combination of the nodes of the widest of them, its first axis slowest, and its
/// nodes as the first columns. A field over some of those axes only stands beside them and repeats.
///
/// # Errors
/// [`ExportError::NoField`], or [`ExportError::ManySets`] if a field is over an axis that the widest is not over.
pub fn sheet(table: &Table, names: &[String], sources: Sources) -> Result<Sheet, ExportError> {
    let fields = chosen(table, names)?;
    let widest = fields.iter().rev().max_by_key(|field| field.axes.len());
    let Some(widest) = widest else { return Err(SheetError::Malformed("a table without fields".into()).into()) };
    if !fields.iter().all(|field| field.axes.iter().all(|axis| widest.axes.contains(axis))) {
        return Err(ExportError::ManySets { sets: sets(&fields) });
    }
    let axes: Vec<&Axis> =
        widest.axes.iter().map(|name| table.axis(name)).collect::<Result<_, _>>().map_err(malformed)?;
    let rows = axes.iter().map(|axis| axis.nodes.len()).product();
    // Which node of each axis a row is at: the last axis is the fastest.
    let node = |row: usize, position: usize| {
        let faster: usize = axes[position + 1..].iter().map(|axis| axis.nodes.len()).product();
        row / faster % axes[position].nodes.len()
    };
    let series = |name: &str, unit: &str, meaning: &str, group, values: Vec<f64>| Series {
        name: format!("{name}{}", suffix(unit)),
        label: name.into(),
        unit: unit.into(),
        meaning: meaning.into(),
        group,
        values: Values::Numbers(values.into_iter().map(Some).collect()),
    };
    let mut columns = Vec::new();
    for (position, axis) in axes.iter().enumerate() {
        let values = (0..rows).map(|row| axis.nodes[node(row, position)]).collect();
        columns.push(series(&axis.name, &axis.unit, "axis", None, values));
    }
    for field in &fields {
        let places: Vec<usize> =
            field.axes.iter().filter_map(|name| axes.iter().position(|axis| axis.name == *name)).collect();
        let index = |row| places.iter().fold(0, |index, &p| index * axes[p].nodes.len() + node(row, p));
        let values = (0..rows).map(|row| field.values[index(row)]).collect();
        let over = if field.axes.is_empty() { "one value".into() } else { format!("over {}", field.axes.join(" x ")) };
        columns.push(series(&field.name, &field.unit, &over, Some("fields"), values));
    }
    let settings = table.settings.iter().map(|(key, value)| (key.clone(), value.clone())).collect();
    Ok(Sheet::new(format!("{}: {}", table.kind, table.title), settings, sources, columns)?)
}

fn malformed(error: impl std::fmt::Display) -> SheetError {
    SheetError::Malformed(error.to_string())
}

/// For each set of axes, in the order of the table, its fields.
fn sets(fields: &[&Field]) -> Vec<String> {
    let mut sets: Vec<(&[String], Vec<&str>)> = Vec::new();
    for field in fields {
        match sets.iter_mut().find(|(axes, _)| *axes == field.axes) {
            Some((_, names)) => names.push(&field.name),
            None => sets.push((&field.axes, vec![&field.name])),
        }
    }
    sets.into_iter().map(|(_, names)| names.join(", ")).collect()
}

/// What a unit adds to a name: `_nm`, `_m2`, `_per_m3` of m^-3, `_W_per_m2_per_nm`; nothing for a number.
fn suffix(unit: &str) -> String {
    let part = |word: &str| match word.split_once("^-") {
        Some((base, "1")) => format!("_per_{base}"),
        Some((base, power)) => format!("_per_{base}{power}"),
        None => format!("_{}", word.replace('^', "")),
    };
    if unit == "1" { String::new() } else { unit.split_whitespace().map(part).collect() }
}

/// The whole table as a JSON object: `kind`, `title`, `settings`, `provenance`, `tables` (the file and its checksum), `axes`
/// with their `nodes`, and the fields called `names` (all if there is none) with their `shape` and `values`, last axis
/// fastest. Keys are those of the header in `docs/table-format.md`.
///
/// # Errors
/// [`ExportError::NoField`].
pub fn json(table: &Table, names: &[String], sources: &Sources) -> Result<String, ExportError> {
    document(table, &chosen(table, names)?, sources, true)
}

/// As [`json`], with `range` in place of nodes and values.
///
/// # Errors
/// [`ExportError::Sheet`] if that cannot be JSON.
pub fn json_header(table: &Table, sources: &Sources) -> Result<String, ExportError> {
    document(table, &chosen(table, &[])?, sources, false)
}

fn document(table: &Table, fields: &[&Field], sources: &Sources, values: bool) -> Result<String, ExportError> {
    let axes = table.axes.iter().map(|axis| AxisDocument {
        name: &axis.name,
        unit: &axis.unit,
        length: axis.nodes.len(),
        spacing: axis.spacing,
        interpolation: axis.interpolation,
        outside: axis.outside,
        range: range(&axis.nodes),
        nodes: values.then_some(&axis.nodes),
    });
    let length = |name: &String| table.axis(name).map_or(0, |axis| axis.nodes.len());
    let fields = fields.iter().map(|field| FieldDocument {
        name: &field.name,
        unit: &field.unit,
        axes: &field.axes,
        shape: field.axes.iter().map(length).collect(),
        precision: field.precision,
        scale: field.scale,
        tolerance: field.tolerance,
        interpolation_error: field.interpolation_error,
        range: range(&field.values),
        values: values.then_some(&field.values),
    });
    Ok(format!(
        "{{\n\"kind\": {},\n\"title\": {},\n\"settings\": {},\n\"tables\": {},\n\"provenance\": {},\n\"axes\": {},\n\"fields\": {}\n}}\n",
        serde_json::to_string(&table.kind).map_err(malformed)?,
        serde_json::to_string(&table.title).map_err(malformed)?,
        serde_json::to_string(&table.settings).map_err(malformed)?,
        json_list(&sources.tables)?,
        json_list(&table.provenance)?,
        json_list(axes)?,
        json_list(fields)?,
    ))
}

/// Lowest and highest of values.
pub(crate) fn range(values: &[f64]) -> (f64, f64) {
    values.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &x| (low.min(x), high.max(x)))
}

#[derive(Serialize)]
struct AxisDocument<'a> {
    name: &'a str,
    unit: &'a str,
    length: usize,
    spacing: Spacing,
    interpolation: Interpolation,
    outside: Outside,
    range: (f64, f64),
    #[serde(skip_serializing_if = "Option::is_none")]
    nodes: Option<&'a Vec<f64>>,
}

#[derive(Serialize)]
struct FieldDocument<'a> {
    name: &'a str,
    unit: &'a str,
    axes: &'a [String],
    shape: Vec<usize>,
    precision: Precision,
    scale: Scale,
    tolerance: Tolerance,
    interpolation_error: Option<f64>,
    range: (f64, f64),
    #[serde(skip_serializing_if = "Option::is_none")]
    values: Option<&'a Vec<f64>>,
}

#[cfg(test)]
mod tests;
