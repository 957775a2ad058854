//! Error against size and cost, as tables for charts: `airlight study NAME` writes one, `airlight-tools chart` draws it.

pub mod atlas;
pub mod columns;
pub mod ladder;
pub mod neutral_points;
pub mod plans;
pub mod polarisation;
pub mod solved;
pub mod stability;
pub mod strip;

use std::fmt::Write;

/// Points of curves in panels.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// What is shown.
    pub title: String,
    /// Names of the axes, with units.
    pub axes: [&'static str; 2],
    /// The points, in the order in which they are drawn.
    pub points: Vec<Point>,
}

/// A point of a curve.
#[derive(Debug, Clone, PartialEq)]
pub struct Point {
    /// The panel, which is the name of what is plotted.
    pub panel: &'static str,
    /// The curve.
    pub curve: String,
    /// Abscissa and ordinate.
    pub at: [f64; 2],
}

impl Chart {
    /// The chart as CSV: a line with the title behind `# `, a header of `panel`, `curve` and the names of the axes, and a row
    /// for each point.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut csv = format!("# {}\npanel,curve,{},{}\n", self.title, self.axes[0], self.axes[1]);
        for Point { panel, curve, at: [x, y] } in &self.points {
            // Writing to a string does not fail.
            let _ = writeln!(csv, "\"{panel}\",\"{curve}\",{x:.6e},{y:.3e}");
        }
        csv
    }
}
