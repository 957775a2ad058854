//! Spheres from a CSV file, solved into another: the interface of the Mie solver to other programs.
//!
//! In these files m = n - ik, as most published tables have it: `m_im` is -k, and a positive one is refused. Amplitudes
//! are those of Wiscombe (1980), the complex conjugates of what [`crate::mie`] computes.

use crate::mie::{MieError, RefractiveIndex, Solver};
use std::fmt::Write;

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

/// Solves the spheres of a CSV text with the columns `x`, `m_re`, `m_im` (m = n - ik, `m_im` <= 0) and possibly
/// `id`; further columns are ignored. The result has a line for each, in order, with the columns `id`
/// (copied, or counted from 1), `Qext`, `Qsca`, `Qabs`, `Qback`, `g`, and `S1_T_re`, `S1_T_im`, `S2_T_re`,
/// `S2_T_im` for each angle T of 0, 30, 90, 150, 180 degrees, all in the shortest digits that give the double back.
///
/// # Errors
/// [`CasesError`] for the first line that cannot be taken.
pub fn solve(input: &str) -> Result<String, CasesError> {
    let bad = |e: csv::Error| CasesError::Input(e.to_string());
    let mut reader = csv::Reader::from_reader(input.as_bytes());
    let headers = reader.headers().map_err(bad)?.clone();
    let column = |name: &str| headers.iter().position(|h| h == name);
    let needed = |name: &str| column(name).ok_or_else(|| CasesError::Input(format!("no column {name:?}")));
    let (x, n, minus_k, id) = (needed("x")?, needed("m_re")?, needed("m_im")?, column("id"));

    let mut text = String::from("id,Qext,Qsca,Qabs,Qback,g");
    for (angle, _) in ANGLES {
        let _ = write!(text, ",S1_{angle}_re,S1_{angle}_im,S2_{angle}_re,S2_{angle}_im"); // to a String: does not fail
    }
    text.push('\n');
    let mut solver = Solver::new();
    for (i, record) in reader.records().enumerate() {
        let record = record.map_err(bad)?;
        let line = record.position().map_or(0, csv::Position::line);
        let number = |column: usize| {
            let field = record.get(column).unwrap_or_default();
            field.trim().parse::<f64>().map_err(|_| CasesError::Input(format!("line {line}: {field:?} is no number")))
        };
        let id = id.and_then(|c| record.get(c)).map_or_else(|| (i + 1).to_string(), str::to_owned);
        let values = one(&mut solver, number(x)?, number(n)?, -number(minus_k)?)
            .map_err(|source| CasesError::Sphere { line, source })?;
        let _ = write!(text, "{id}");
        for value in values {
            let _ = write!(text, ",{value:e}");
        }
        text.push('\n');
    }
    Ok(text)
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
    fn lines_are_numbered_where_they_have_no_id_and_angles_have_their_columns() {
        let text = solve("x,m_re,m_im\n1,1.5,-0.1\n2,1.33,0\n").expect("two spheres");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 3);
        assert!(lines.iter().all(|line| line.split(',').count() == 6 + 20), "{text}");
        assert!(lines[2].starts_with("2,"), "{text}");
    }
}
