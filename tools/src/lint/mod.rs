//! Whether the numbers of a table or a CSV file can be what they say they are.
//!
//! Nothing is compared with the file that the numbers should have come from. What a column is follows from its name
//! and unit (`names`), and the numbers are then held against what matter can do (`aerosol`, `limits`), against each
//! other, against their neighbours (`smooth`), and, where a biome is named, against the ranges of Airlight's own
//! tables of it (`known`). A table's fields are judged in the same way (`table`). A cause is what would make the
//! findings go away: an exchange of two columns or a power of ten in one (`repair`).
//!
//! `docs/lint.md` lists the ranges and their sources.

mod aerosol;
mod finding;
mod known;
mod limits;
mod names;
mod pieces;
mod repair;
mod sheet;
mod smooth;
mod table;

pub use finding::{Check, Finding, Severity};
pub use sheet::SheetError;

use pieces::Pieces;
use repair::{Judged, explain};
use sheet::{Sheet, coordinate};
use std::path::{Path, PathBuf};
use tables::{Table, TableError};

/// A file that cannot be judged.
#[derive(Debug, thiserror::Error)]
pub enum LintError {
    /// The operating system refused to read it.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A damaged table, or a file that is none.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A text that is no CSV file with a header row.
    #[error("{}: {source}", path.display())]
    Sheet {
        /// The file.
        path: PathBuf,
        /// What is wrong.
        source: SheetError,
    },
    /// A folder without tables and CSV files.
    #[error("{}: expected tables or CSV files, found none", .0.display())]
    Nothing(PathBuf),
}

/// The files that a path stands for: itself, or, of a folder, every `.table` and `.csv` file in it and below, sorted.
///
/// # Errors
/// [`LintError::Read`] if a folder cannot be listed, [`LintError::Nothing`] if there is none.
pub fn files(path: &Path) -> Result<Vec<PathBuf>, LintError> {
    if !path.is_dir() {
        return Ok(vec![path.to_path_buf()]);
    }
    let mut found = Vec::new();
    let mut folders = vec![path.to_path_buf()];
    while let Some(folder) = folders.pop() {
        let read = |source| LintError::Read { path: folder.clone(), source };
        for entry in std::fs::read_dir(&folder).map_err(read)? {
            let path = entry.map_err(read)?.path();
            let suits = path
                .extension()
                .is_some_and(|end| end.eq_ignore_ascii_case("table") || end.eq_ignore_ascii_case("csv"));
            if path.is_dir() {
                folders.push(path);
            } else if suits {
                found.push(path);
            }
        }
    }
    found.sort();
    if found.is_empty() { Err(LintError::Nothing(path.to_path_buf())) } else { Ok(found) }
}

/// Judges one file: a table by its signature, else a CSV file with one header row, with `# key: value` lines before it
/// or without. The findings are in the order of the tests; none means that nothing is wrong that can be told.
///
/// # Errors
/// [`LintError`] if the file cannot be read, is a damaged table or no CSV file.
pub fn lint(path: &Path) -> Result<Vec<Finding>, LintError> {
    let bytes = std::fs::read(path).map_err(|source| LintError::Read { path: path.to_path_buf(), source })?;
    let is_table = bytes.starts_with(&tables::file::SIGNATURE) || path.extension().is_some_and(|end| end == "table");
    let mut findings = if is_table {
        lint_table(&tables::file::decode(&bytes).map_err(|e| e.at(path))?)
    } else {
        // Names in other encodings are read as far as they go.
        let text = String::from_utf8_lossy(&bytes);
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        let parent = path.parent().and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
        let about = format!("{} {name}", parent.unwrap_or_default());
        lint_csv(&about, &text).map_err(|source| LintError::Sheet { path: path.to_path_buf(), source })?
    };
    for finding in &mut findings {
        finding.file = path.display().to_string();
    }
    Ok(findings)
}

/// Judges a table.
#[must_use]
pub fn lint_table(table: &Table) -> Vec<Finding> {
    let mut findings = table.laws();
    explain(table, &mut findings);
    findings.extend(table::roughness(table));
    finish(findings)
}

/// Judges the text of a CSV file; `about` is its name, from which follows what a bare `cross_section` is of.
///
/// # Errors
/// [`SheetError`] if it has no header row or no rows.
pub fn lint_csv(about: &str, text: &str) -> Result<Vec<Finding>, SheetError> {
    let mut findings: Vec<Finding> = Vec::new();
    for piece in Pieces::new(text) {
        let (sheet, mut found) = sheet::parse(about, &piece.text)?;
        let mut laws = sheet.laws();
        explain(&sheet, &mut laws);
        found.extend(laws);
        found.extend(smooth::laws(&sheet));
        for finding in &mut found {
            finding.line = finding.line.map(|line| piece.line(line));
        }
        // What is said of the header, or of the rows that two pieces share, is said once.
        found.retain(|finding| !findings.contains(finding));
        findings.extend(found);
        findings = finish(findings);
    }
    Ok(findings)
}

impl Judged for Sheet {
    fn names(&self) -> Vec<String> {
        self.columns.iter().map(|column| column.name.clone()).collect()
    }

    fn related(&self, i: usize, j: usize) -> bool {
        let (a, b) = (&self.columns[i].meaning, &self.columns[j].meaning);
        a.quantity == b.quantity || a.subject == b.subject
    }

    fn exchange(&mut self, i: usize, j: usize) -> bool {
        let along = coordinate(&self.columns).map(|c| c.name.clone());
        let fixed = |i: usize| !self.columns[i].texts.is_empty() || Some(&self.columns[i].name) == along.as_ref();
        if fixed(i) || fixed(j) {
            return false;
        }
        let values = std::mem::take(&mut self.columns[i].values);
        self.columns[i].values = std::mem::replace(&mut self.columns[j].values, values);
        true
    }

    fn scale(&mut self, i: usize, factor: f64) {
        self.columns[i].values.iter_mut().for_each(|value| *value *= factor);
        self.refresh();
    }

    fn laws(&self) -> Vec<Finding> {
        let mut findings = aerosol::laws(self);
        findings.extend(limits::laws(self));
        findings
    }
}

/// Findings of one kind about one set of columns beyond which they are counted instead of listed.
const LISTED: usize = 12;

/// Gives amounts a common cause, and lists no test more than [`LISTED`] times for the same columns.
fn finish(mut findings: Vec<Finding>) -> Vec<Finding> {
    let factors: Vec<f64> =
        findings.iter().filter(|f| f.check == Check::Amount && f.cause.is_empty()).filter_map(|f| f.factor).collect();
    let (low, high) = factors.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), f| (l.min(*f), h.max(*f)));
    let power = ((low * high).log10() / 2.0).round();
    let cause = if high > 30.0 * low {
        format!(
            "not one slip of units, for the factors are {low:.2} to {high:.0}: cross-sections of other particles, such as single \
             spheres added up without the widths and numbers of their distribution"
        )
    } else if factors.len() > 1 && power.abs() >= 2.0 {
        format!("about 1e{power} times what it should be throughout: a slip of units")
    } else if power.abs() >= 2.0 && (low.log10() - power).abs() < 0.3 {
        format!("about 1e{power} times what it should be: a slip of units?")
    } else {
        "particles of other sizes, or numbers that do not belong together".into()
    };
    for finding in findings.iter_mut().filter(|f| f.check == Check::Amount && f.cause.is_empty() && f.factor.is_some())
    {
        finding.cause.clone_from(&cause);
    }
    let mut listed: Vec<Finding> = Vec::new();
    let mut hidden: Vec<usize> = Vec::new();
    for finding in findings {
        let alike: Vec<usize> = (0..listed.len())
            .filter(|i| listed[*i].check == finding.check && listed[*i].columns == finding.columns)
            .collect();
        if alike.len() < LISTED {
            listed.push(finding);
            hidden.push(0);
        } else {
            hidden[alike[LISTED - 1]] += 1;
        }
    }
    for (finding, count) in listed.iter_mut().zip(hidden).filter(|(_, count)| *count > 0) {
        finding.found += &format!(" (and {count} more such places)");
    }
    listed
}

#[cfg(test)]
mod tests;
