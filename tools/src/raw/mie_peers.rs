//! Speed and error of Mie solvers, measured side by side by `tools/benches/mie_peers.py`.

use super::{Column, RawError, Row, Source};
use std::path::Path;

/// The file of `mie-peers/`.
#[derive(Debug, Clone, PartialEq)]
pub struct MiePeers {
    /// One row for each solver and task.
    pub speeds: Source<Speed>,
}

impl MiePeers {
    /// Reads the file below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self { speeds: Source::read(raw_dir, "mie-peers/speed.csv")? })
    }
}

/// One solver at one task.
#[derive(Debug, Clone, PartialEq)]
pub struct Speed {
    /// Name of the solver.
    pub solver: String,
    /// `a`, efficiencies and g of 1000 spheres of one index, or `b`, sums over size distributions with a phase function.
    pub task: String,
    /// Spheres in a second on one core.
    pub spheres_per_second: f64,
    /// Largest relative error of any number that the task gives, against arbitrary precision.
    pub largest_relative_error: f64,
}

impl Row for Speed {
    type Record = (String, String, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::text("solver").key(),
            Column::text("task").key(),
            Column::number("spheres_per_second", "s^-1", 1.0, 1e9),
            Column::number("largest_relative_error", "1", 1e-17, 1e3),
        ]
    }

    fn from_record((solver, task, spheres_per_second, largest_relative_error): Self::Record) -> Self {
        Self { solver, task, spheres_per_second, largest_relative_error }
    }
}
