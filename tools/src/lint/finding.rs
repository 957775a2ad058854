//! What is wrong, where, and why.

use serde::Serialize;
use std::fmt;

/// How sure a finding is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// Outside what is usual for what the data say they are.
    Warning,
    /// Impossible, or in contradiction with other numbers of the same file.
    Error,
}

/// The tests, by which a finding can be told from another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Check {
    /// Names, units and number of the columns or fields.
    Columns,
    /// Missing values and numbers that are none.
    Missing,
    /// The order of the coordinate, or a coordinate given twice.
    Order,
    /// A value outside its physical range.
    Range,
    /// Two or more quantities that contradict each other.
    Identity,
    /// Scattering and absorption that no particle has together.
    Exchange,
    /// A single-scattering albedo that the named aerosol does not have.
    Albedo,
    /// A cross-section, coefficient or density of another order than the named aerosol has.
    Amount,
    /// A value that leaves the line of its neighbours.
    Smoothness,
}

impl Check {
    /// How much a finding of this kind weighs when causes are compared: what is impossible for all matter
    /// counts more than what is unusual for a named one.
    pub(super) fn weight(self) -> u32 {
        match self {
            Self::Amount => 2,
            Self::Albedo | Self::Smoothness => 3,
            _ => 4,
        }
    }
}

/// One finding.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Finding {
    /// The file as it was given.
    pub file: String,
    /// The columns or fields concerned.
    pub columns: Vec<String>,
    /// Biome, material, layer or key that the columns or rows belong to; empty if there is none.
    pub subject: String,
    /// Line of the file, counted from 1, where the finding belongs to one.
    pub line: Option<u64>,
    /// Coordinate of the value, such as `248 nm`; empty where the finding is about a whole column.
    pub at: String,
    /// How sure it is.
    pub severity: Severity,
    /// The test that failed.
    pub check: Check,
    /// What there is.
    pub found: String,
    /// What there should be.
    pub expected: String,
    /// What there is over what there should be, where an order of magnitude is the matter.
    pub factor: Option<f64>,
    /// The likely cause; empty if none is known.
    pub cause: String,
}

impl Finding {
    /// An error about columns; the rest is filled in by the methods below.
    pub(super) fn new(check: Check, columns: &[&str], found: String, expected: impl Into<String>) -> Self {
        Self {
            file: String::new(),
            columns: columns.iter().map(|&name| name.to_owned()).collect(),
            subject: String::new(),
            line: None,
            at: String::new(),
            severity: Severity::Error,
            check,
            found,
            expected: expected.into(),
            factor: None,
            cause: String::new(),
        }
    }

    pub(super) fn warning(self) -> Self {
        Self { severity: Severity::Warning, ..self }
    }

    pub(super) fn of(self, subject: &str) -> Self {
        Self { subject: subject.to_owned(), ..self }
    }

    pub(super) fn at(self, line: Option<u64>, at: String) -> Self {
        Self { line, at, ..self }
    }

    pub(super) fn off_by(self, factor: f64) -> Self {
        Self { factor: Some(factor), ..self }
    }

    pub(super) fn because(self, cause: impl Into<String>) -> Self {
        Self { cause: cause.into(), ..self }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        f.write_str(match self.severity {
            Severity::Warning => ": warning: ",
            Severity::Error => ": error: ",
        })?;
        if !self.subject.is_empty() {
            write!(f, "{}: ", self.subject)?;
        }
        if !self.columns.is_empty() {
            write!(f, "{}: ", self.columns.join(", "))?;
        }
        if !self.at.is_empty() {
            write!(f, "at {}: ", self.at)?;
        }
        write!(f, "found {}; expected {}", self.found, self.expected)?;
        if !self.cause.is_empty() {
            write!(f, "; likely cause: {}", self.cause)?;
        }
        Ok(())
    }
}
