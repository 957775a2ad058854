//! Spheres from a CSV file, solved into another: the interface of the Mie solver to other programs.
//!
//! In these files m = n - ik, as most published tables have it: `m_im` is -k, and a positive one is refused. Amplitudes
//! are those of Wiscombe (1980), the complex conjugates of what [`crate::mie`] computes.

use crate::mie::{MieError, RefractiveIndex, Solver};
use crate::records::Records;
use csv::StringRecord;
use std::borrow::Cow;
use std::fmt::Write;
use tables::excerpt;

/// Angles in degrees at which amplitudes are given, with their cosines.
const ANGLES: [(u32, f64); 5] =
    [(0, 1.0), (30, 0.866_025_403_784_438_6), (90, 0.0), (150, -0.866_025_403_784_438_6), (180, -1.0)];

/// Why spheres of a file cannot be solved.
#[derive(Debug, thiserror::Error)]
pub enum CasesError {
    /// The input is no CSV with the columns needed.
    #[error("{0}")]
    Input(String),
    /// A sphere that is out of range.
    #[error("line {line}: {source}")]
    Sphere {
        /// Line of the input, counted from 1.
        line: u64,
        /// What is wrong with it.
        source: MieError,
    },
}

/// A sphere of a file, as it is written there.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// Line of the file, counted from 1.
    pub line: u64,
    /// Its `id`, or its number counted from 1.
    pub id: String,
    /// Size parameter, 1.
    pub x: f64,
    /// Real part of the refractive index, 1.
    pub n: f64,
    /// Imaginary part k of n + ik, 1: the negative of the file's `m_im`.
    pub k: f64,
}

/// The spheres of a CSV text, read one by one.
pub struct Cases<'a> {
    records: Records<'a>,
    record: StringRecord,
    x: usize,
    n: usize,
    minus_k: usize,
    id: Option<usize>,
    columns: usize,
    read: usize,
}

impl<'a> Cases<'a> {
    /// The spheres of a text with the columns `x`, `m_re`, `m_im` (m = n - ik) and possibly `id`; further columns are
    /// ignored. Only the header row is read here.
    ///
    /// # Errors
    /// [`CasesError::Input`] if a column is missing.
    pub fn new(text: &'a str) -> Result<Self, CasesError> {
        let (mut records, mut headers) = (Records::new(text), StringRecord::new());
        records.read(&mut headers).map_err(malformed)?;
        let column = |name: &str| headers.iter().position(|h| h == name);
        let needed = |name: &str| column(name).ok_or_else(|| CasesError::Input(format!("no column {name:?}")));
        let (x, n, minus_k, id) = (needed("x")?, needed("m_re")?, needed("m_im")?, column("id"));
        Ok(Self { records, record: StringRecord::new(), x, n, minus_k, id, columns: headers.len(), read: 0 })
    }

    fn number(&self, line: u64, column: usize) -> Result<f64, CasesError> {
        let field = self.record.get(column).unwrap_or_default();
        let wrong = |_| CasesError::Input(format!("line {line}: {:?} is no number", excerpt(field)));
        field.trim().parse().map_err(wrong)
    }
}

/// Each sphere, or what is wrong with its line: a field that is no number, fields too many or too few.
impl Iterator for Cases<'_> {
    type Item = Result<Case, CasesError>;

    fn next(&mut self) -> Option<Self::Item> {
        let line = match self.records.read(&mut self.record) {
            Ok(line) => line?,
            Err(error) => return Some(Err(malformed(error))),
        };
        if self.record.len() != self.columns {
            let found = format!("{} fields where there are {} columns", self.record.len(), self.columns);
            return Some(Err(malformed((line, found))));
        }
        self.read += 1;
        let id =
            self.id.and_then(|column| self.record.get(column)).map_or_else(|| self.read.to_string(), str::to_owned);
        let case = |x, n, minus_k: f64| Case { line, id, x, n, k: -minus_k };
        let number = |column| self.number(line, column);
        Some(number(self.x).and_then(|x| Ok(case(x, number(self.n)?, number(self.minus_k)?))))
    }
}

fn malformed((line, found): (u64, String)) -> CasesError {
    CasesError::Input(format!("line {line}: {found}"))
}

/// Solves the spheres of a CSV text (see [`Cases`]; `m_im` <= 0). The result has a line for each, in order, with the
/// columns `id`, `Qext`, `Qsca`, `Qabs`, `Qback`, `g`, and `S1_T_re`, `S1_T_im`, `S2_T_re`,
/// `S2_T_im` for each angle T of 0, 30, 90, 150, 180 degrees, all in the shortest digits that give the double back.
///
/// # Errors
/// [`CasesError`] for the first line that cannot be taken.
pub fn solve(input: &str) -> Result<String, CasesError> {
    let cases = Cases::new(input)?;
    let mut text = String::from("id,Qext,Qsca,Qabs,Qback,g");
    for (angle, _) in ANGLES {
        let _ = write!(text, ",S1_{angle}_re,S1_{angle}_im,S2_{angle}_re,S2_{angle}_im"); // to a String: does not fail
    }
    text.push('\n');
    let mut solver = Solver::new();
    for case in cases {
        let Case { line, id, x, n, k } = case?;
        let values = one(&mut solver, x, n, k).map_err(|source| CasesError::Sphere { line, source })?;
        text += &quoted(&id);
        for value in values {
            let _ = write!(text, ",{value:e}");
        }
        text.push('\n');
    }
    Ok(text)
}

/// A field of a CSV file, in quotes where it needs them.
fn quoted(field: &str) -> Cow<'_, str> {
    if field.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", field.replace('"', "\"\"")).into()
    } else {
        field.into()
    }
}

fn one(solver: &mut Solver, x: f64, n: f64, k: f64) -> Result<Vec<f64>, MieError> {
    let sphere = solver.sphere(RefractiveIndex::new(n, k)?, x)?;
    let q = sphere.efficiencies();
    let mut values = vec![q.extinction, q.scattering, q.absorption, q.backscatter, q.asymmetry];
    for (_, cosine) in ANGLES {
        let s = sphere.amplitudes(cosine)?;
        values.extend([s.s1.re, -s.s1.im, s.s2.re, -s.s2.im]);
    }
    Ok(values)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_positive_imaginary_part_is_refused_with_its_line() {
        let error = solve("id,x,m_re,m_im\n1,1.0,1.5,0.0\n2,1.0,1.5,0.1\n").expect_err("k < 0").to_string();
        assert!(error.starts_with("line 3: refractive index 1.5 + (-0.1)i: k must not be negative"), "{error}");
        assert!(solve("x,m_re\n1,1.5\n").is_err(), "a missing column was taken");
        assert!(solve("x,m_re,m_im\n1,1.5,a\n").is_err(), "a word was taken for a number");
    }

    #[test]
    fn an_id_comes_out_as_the_field_that_it_was() {
        let text = solve("id,x,m_re,m_im\n\"a,\"\"b\"\"\",1,1.5,0\n").expect("a sphere");
        let mut records = Records::new(&text);
        let mut record = StringRecord::new();
        records.read(&mut record).expect("a header row");
        records.read(&mut record).expect("a row");
        assert_eq!((record.len(), &record[0]), (6 + 20, "a,\"b\""));
    }

    #[test]
    fn lines_are_numbered_where_they_have_no_id_and_angles_have_their_columns() {
        let text = solve("x,m_re,m_im\n1,1.5,-0.1\n2,1.33,0\n").expect("two spheres");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines.iter().all(|line| line.split(',').count() == 6 + 20), "{text}");
        assert!(lines[2].starts_with("2,"), "{text}");
    }
}
