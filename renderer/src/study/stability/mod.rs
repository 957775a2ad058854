//! Stability maps: where each method leaves its error bound.
//!
//! Each map has two axes and a panel for each method or setting; each cell has the error that was found beside something finer, how exact
//! that is itself, the bound that the method is meant to keep, what it states of itself, and whether it refuses.

mod asymmetry;
mod haze;
mod mappings;
mod planets;
mod steps;
mod views;
mod wavelengths;

use crate::data::Data;
use crate::render::RenderError;
use crate::sampling::spiral;
use glam::DVec3;
use std::fmt::Write;

pub use super::ladder::Size;

/// What a method is found to do at one place of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// The method and how it is set.
    pub method: String,
    /// Abscissa and ordinate, as they are printed.
    pub at: [String; 2],
    /// Relative error found; none where the method does not answer.
    pub error: Option<f64>,
    /// How exact that is: the error of what it was found beside.
    pub reference: Option<f64>,
    /// What the method is meant to keep, if it promises something.
    pub bound: Option<f64>,
    /// What the method states of itself, if it does.
    pub stated: Option<f64>,
    /// Whether it refuses.
    pub refused: bool,
}

impl Cell {
    fn new(method: impl Into<String>, at: [String; 2]) -> Self {
        let (error, reference, bound, stated) = (None, None, None, None);
        Self { method: method.into(), at, error, reference, bound, stated, refused: false }
    }

    fn found(self, error: f64, reference: f64) -> Self {
        Self { error: Some(error), reference: Some(reference), ..self }
    }

    fn bound(self, bound: f64) -> Self {
        Self { bound: Some(bound), ..self }
    }

    /// With what the method states, and whether it therefore refuses.
    fn stated(self, stated: f64, refused: bool) -> Self {
        // An infinite error says that nothing can be said.
        Self { stated: Some(stated).filter(|stated| stated.is_finite()), refused, ..self }
    }

    fn refused(self) -> Self {
        Self { refused: true, ..self }
    }

    /// Whether the method answers, states an error, and is off by more than twice that and by more than its reference could be.
    #[must_use]
    pub fn states_too_little(&self) -> bool {
        let (Some(error), Some(stated), false) = (self.error, self.stated, self.refused) else { return false };
        error - self.reference.unwrap_or(0.0) > 2.0 * stated
    }

    /// Whether the method answers beyond its bound, neither refusing nor stating so.
    #[must_use]
    pub fn is_silent(&self) -> bool {
        let (Some(error), Some(bound), false) = (self.error, self.bound, self.refused) else { return false };
        let known = self.stated.is_some_and(|stated| 2.0 * stated >= error);
        error - self.reference.unwrap_or(0.0) > bound && !known
    }
}

/// One map.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// What files are called by.
    pub name: String,
    /// What is shown.
    pub title: String,
    /// Names of the axes, with units.
    pub axes: [&'static str; 2],
    /// Its cells; methods and places are drawn in the order in which they first occur, from the left and the bottom.
    pub cells: Vec<Cell>,
}

/// All maps.
#[derive(Debug, Clone, PartialEq)]
pub struct Stability {
    /// In the order in which they are drawn.
    pub maps: Vec<Map>,
}

impl Stability {
    /// As CSV: a title behind `# `, behind another `# ` for each map its name, title and axes; a header, and a row for each cell. Fields
    /// are empty where there is nothing.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut csv = String::from("# Stability maps: where each method leaves its error bound\n");
        for Map { name, title, axes, .. } in &self.maps {
            // Writing to a string does not fail.
            let _ = writeln!(csv, "# {name} | {title} | {} | {}", axes[0], axes[1]);
        }
        csv += "map,method,x,y,error,reference,bound,stated,refused\n";
        let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.2e}"));
        for (map, cell) in self.maps.iter().flat_map(|map| map.cells.iter().map(move |cell| (map, cell))) {
            let [x, y] = &cell.at;
            let numbers = [cell.error, cell.reference, cell.bound, cell.stated].map(number).join(",");
            let _ =
                writeln!(csv, "{},\"{}\",\"{x}\",\"{y}\",{numbers},{}", map.name, cell.method, u8::from(cell.refused));
        }
        csv
    }

    /// For people: of each map and method how many cells keep their bound, refuse, are silently beyond it, or state too little; and the
    /// worst of those that answer.
    #[must_use]
    pub fn summary(&self) -> Vec<String> {
        let mut lines = Vec::new();
        for map in &self.maps {
            lines.push(format!("{}: {}", map.name, map.title));
            let mut methods: Vec<&str> = Vec::new();
            for cell in &map.cells {
                if !methods.contains(&cell.method.as_str()) {
                    methods.push(&cell.method);
                }
            }
            for method in methods {
                lines.push(of_method(method, map));
            }
        }
        lines
    }
}

/// One line of the summary.
fn of_method(method: &str, map: &Map) -> String {
    let cells: Vec<&Cell> = map.cells.iter().filter(|cell| cell.method == method).collect();
    let count = |of: &dyn Fn(&Cell) -> bool| cells.iter().filter(|cell| of(cell)).count();
    let within = |cell: &Cell| cell.error.zip(cell.bound).is_some_and(|(error, bound)| error <= bound);
    let worst = cells.iter().filter(|cell| !cell.refused).filter_map(|cell| Some((cell.error?, *cell)));
    let worst = worst.max_by(|a, b| a.0.total_cmp(&b.0));
    let mut line = format!("  {method:<44} {:>3} cells", cells.len());
    if cells.iter().any(|cell| cell.bound.is_some()) {
        line += &format!(", {:>3} within the bound", count(&|cell| !cell.refused && within(cell)));
        line += &format!(", {} silently beyond", count(&Cell::is_silent));
    }
    if cells.iter().any(|cell| cell.stated.is_some()) {
        line += &format!(", {} state less than half", count(&Cell::states_too_little));
    }
    line += &format!(", {} refused", count(&|cell| cell.refused));
    if let Some((error, cell)) = worst {
        line += &format!("; worst {error:.1e} at {}, {}", cell.at[0], cell.at[1]);
        if let Some(stated) = cell.stated {
            line += &format!(" (states {stated:.1e})");
        }
    }
    line
}

/// Makes one map, or some of one kind; is told of progress.
type Make = fn(&Data, Size, &(dyn Fn(f64) + Sync)) -> Result<Vec<Map>, RenderError>;

/// The makers, and their shares of the time.
const MAKERS: [(Make, f64); 7] = [
    (haze::make, 0.55),
    (views::make, 0.15),
    (asymmetry::make, 0.1),
    (planets::make, 0.08),
    (wavelengths::make, 0.05),
    (steps::make, 0.04),
    (mappings::make, 0.03),
];

/// Makes all maps. `progress` is told the share that is done.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn make(data: &Data, size: Size, progress: &(dyn Fn(f64) + Sync)) -> Result<Stability, RenderError> {
    let (mut maps, mut before) = (Vec::new(), 0.0);
    for (make, share) in MAKERS {
        maps.extend(make(data, size, &|done| progress(before + share * done))?);
        before += share;
        progress(before);
    }
    Ok(Stability { maps })
}

/// The error that a solved table may state before pictures refuse it, and the one that they ask for if nothing is said.
const MOST_ERROR: f64 = crate::render::MOST_TABLE_ERROR;
const ASKED_ERROR: f64 = 0.01;

/// Directions above the horizon, even in solid angle.
fn dome(count: u32) -> Vec<DVec3> {
    (0..count).map(|i| spiral(i, count, [0.0, 1.0])).collect()
}

/// Of each wavelength the root mean square of the differences over the mean of what is right; 0 where that is dark.
fn errors<const L: usize>(found: &[[f64; L]], right: &[[f64; L]]) -> [f64; L] {
    std::array::from_fn(|j| {
        let mean = right.iter().map(|row| row[j]).sum::<f64>() / right.len() as f64;
        let square = found.iter().zip(right).map(|(a, b)| (a[j] - b[j]).powi(2)).sum::<f64>() / right.len() as f64;
        if mean > 0.0 { square.sqrt() / mean } else { 0.0 }
    })
}

/// Root of the mean of squares.
fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cell(error: f64, bound: f64, stated: Option<f64>, refused: bool) -> Cell {
        let cell = Cell::new("solved", ["1".into(), "2".into()]).found(error, 1e-4).bound(bound);
        Cell { stated, refused, ..cell }
    }

    #[test]
    fn silent_is_what_neither_refuses_nor_states() {
        assert!(!cell(0.005, 0.01, None, false).is_silent(), "within the bound");
        assert!(cell(0.05, 0.01, None, false).is_silent());
        assert!(cell(0.05, 0.01, Some(0.02), false).is_silent(), "states less than half");
        assert!(!cell(0.05, 0.01, Some(0.03), false).is_silent());
        assert!(!cell(0.05, 0.01, None, true).is_silent(), "refused");
        assert!(cell(0.05, 0.01, Some(0.02), false).states_too_little());
        assert!(!cell(0.05, 0.01, Some(0.03), false).states_too_little());
    }

    #[test]
    fn every_row_has_as_many_fields_as_the_header() {
        let bare = Cell::new("a, b", ["0".into(), "x".into()]).refused();
        let cells = vec![cell(0.1, 0.01, Some(0.2), false), bare];
        let map = Map { name: "m".into(), title: "t".into(), axes: ["x", "y"], cells };
        let maps = Stability { maps: vec![map] };
        let csv = maps.csv();
        let mut lines = csv.lines().skip_while(|line| line.starts_with('#'));
        let commas = |line: &str| line.replace("a, b", "").matches(',').count();
        let header = commas(lines.next().expect("a header"));
        assert!(lines.clone().count() == 2 && lines.all(|line| commas(line) == header), "{csv}");
        assert!(maps.summary().iter().any(|line| line.contains("1 refused")));
    }
}
