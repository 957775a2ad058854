//! Solved tables as files: the moments of the field, by a checksum of all that they depend on.
//!
//! A file holds `moment[altitude, sun_zenith, moment_index, lane]` and `irradiance[sun_zenith, lane]` in single precision, as they are in memory, so that
//! what is read is what was solved. Its name has a hash of the atmosphere (densities, cross-sections, phase functions), the planet,
//! the ground, whether light is polarised, the resolution and the program's version; a file of that name that holds something else is an error, not a table.

use super::grid::Grid;
use super::orders::Field;
use super::{Optics, Resolution};
use std::fmt::{Debug, Write};
use std::hash::{DefaultHasher, Hasher};
use std::path::{Path, PathBuf};
use tables::{Axis, Field as Values, Kind, Precision, Scale, Table, TableError, Tolerance};

/// Changes with what a solution computes from the same inputs.
const METHOD: u32 = 5;

/// Hashes what is written to it.
struct Hashed(DefaultHasher);

impl Write for Hashed {
    fn write_str(&mut self, text: &str) -> std::fmt::Result {
        self.0.write(text.as_bytes());
        Ok(())
    }
}

/// A hash of all that a solution depends on: its resolution is the last, those before are of the solutions it began from.
pub(super) fn key<const L: usize>(optics: &Optics<L>, radius: f64, resolutions: &[Resolution]) -> String {
    let mut hashed = Hashed(DefaultHasher::new());
    let Optics { medium, species, albedo, moments, .. } = optics;
    let polarised = moments.polarised();
    let inputs: [&dyn Debug; 8] =
        [&METHOD, &env!("CARGO_PKG_VERSION"), medium, species, albedo, &polarised, &radius, &resolutions];
    for input in inputs {
        // Hashing does not fail.
        let _ = write!(hashed, "{input:?};");
    }
    format!("{:016x}", hashed.0.finish())
}

/// The file of a key.
pub(super) fn path(folder: &Path, key: &str) -> PathBuf {
    folder.join(format!("solved-{key}.table"))
}

/// A solution: its field, the orders it took, and the change that the last of them made.
pub(super) type Solution<const L: usize> = (Field<L>, usize, f64);

/// The names of the two numbers beside the field.
const ORDERS: &str = "orders";
const RESIDUAL: &str = "relative_change_by_the_last_order";
const KEY: &str = "inputs";

/// A solution as a table.
///
/// # Errors
/// [`TableError`] never: the numbers are finite.
pub(super) fn table<const L: usize>(
    (field, orders, residual): &Solution<L>,
    grid: &Grid,
    moments: usize,
    key: &str,
) -> Result<Table, TableError> {
    let count = |n: usize| (0..n).map(|i| i as f64).collect::<Vec<_>>();
    let values = |rows: &[[f32; L]]| rows.iter().flatten().map(|&value| f64::from(value)).collect();
    let zeniths = grid.suns.nodes.iter().map(|chi| chi.to_degrees()).collect();
    let part = |name: &str, unit: &str, axes: &[&str], values: Vec<f64>| Values {
        name: name.into(),
        unit: unit.into(),
        axes: axes.iter().map(|&axis| axis.into()).collect(),
        precision: Precision::F32,
        scale: Scale::Linear,
        tolerance: Tolerance { relative: 0.0, absolute: 0.0 },
        interpolation_error: None,
        values,
    };
    Ok(Table {
        kind: Kind::SolvedSky,
        title: "Moments of diffuse radiance and irradiance of the ground per unit solar irradiance".into(),
        axes: vec![
            Axis::new("altitude", "m", grid.levels.clone())?,
            Axis::new("sun_zenith", "deg", zeniths)?,
            Axis::new("moment_index", "1", count(moments))?,
            Axis::new("lane", "1", count(L))?,
        ],
        fields: vec![
            part("moment", "1", &["altitude", "sun_zenith", "moment_index", "lane"], values(&field.moments)),
            part("irradiance", "1", &["sun_zenith", "lane"], values(&field.ground)),
        ],
        settings: [
            (KEY.into(), key.into()),
            (ORDERS.into(), orders.to_string()),
            (RESIDUAL.into(), format!("{residual:e}")),
        ]
        .into(),
        provenance: Vec::new(),
    })
}

/// The solution in a table that was made for these inputs.
///
/// # Errors
/// [`TableError`] if it is of another kind, for other inputs or another grid.
pub(super) fn solution<const L: usize>(
    table: &Table,
    grid: &Grid,
    moments: usize,
    key: &str,
) -> Result<Solution<L>, TableError> {
    table.expect_kind(Kind::SolvedSky)?;
    let refuse = |text: String| Err(TableError::Inconsistent(text));
    let setting = |name: &str| table.settings.get(name).map(String::as_str);
    if setting(KEY) != Some(key) {
        return refuse(format!("made for other inputs: {:?} instead of {key:?}", setting(KEY).unwrap_or("none")));
    }
    let rows = |field: &Values, count: usize| -> Result<Vec<[f32; L]>, TableError> {
        let (rows, rest) = field.values.as_chunks::<L>();
        if rows.len() != count || !rest.is_empty() {
            let found = field.values.len();
            return Err(TableError::Inconsistent(format!("{}: {found} values instead of {}", field.name, count * L)));
        }
        Ok(rows.iter().map(|row| row.map(|value| value as f32)).collect())
    };
    let suns = grid.suns.count();
    let moment = table.field("moment", "1", &["altitude", "sun_zenith", "moment_index", "lane"])?;
    let ground = table.field("irradiance", "1", &["sun_zenith", "lane"])?;
    let field = Field { moments: rows(moment, grid.levels.len() * suns * moments)?, ground: rows(ground, suns)? };
    let number = |name: &str| setting(name).and_then(|text| text.parse::<f64>().ok());
    let (Some(orders), Some(residual)) = (number(ORDERS), number(RESIDUAL)) else {
        return refuse(format!("{ORDERS} or {RESIDUAL} is missing"));
    };
    Ok((field, orders as usize, residual))
}
