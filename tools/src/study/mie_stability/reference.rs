//! What the variants are compared with: spheres in arbitrary precision, and errors that another program found.

use super::classical::Optics;
use super::variants::Quantity;
use crate::study::StudyError;
use num_complex::Complex64;
use std::collections::HashMap;

/// A file of reference values that the program carries.
struct File {
    name: &'static str,
    text: &'static str,
}

const GRID: File = File { name: "mie-grid.csv", text: include_str!("../../../tests/reference/mie-grid.csv") };
const SPHERES: File = File { name: "spheres.csv", text: include_str!("../../../tests/reference/spheres.csv") };
const SCAN: File = File { name: "mie-scan.csv", text: include_str!("../../../tests/reference/mie-scan.csv") };

/// A sphere of known optics, m = n + ik.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sphere {
    pub(super) x: f64,
    pub(super) n: f64,
    pub(super) k: f64,
    pub(super) exact: Optics,
}

/// A row of a file with the names of its columns.
struct Row<'a> {
    file: &'static str,
    header: &'a csv::StringRecord,
    record: csv::StringRecord,
}

impl Row<'_> {
    fn text(&self, column: &str) -> Result<&str, StudyError> {
        let place = self.header.iter().position(|name| name == column);
        place.and_then(|i| self.record.get(i)).ok_or_else(|| self.error(format!("no column {column:?}")))
    }

    fn number(&self, column: &str) -> Result<f64, StudyError> {
        let text = self.text(column)?;
        text.parse().map_err(|_| self.error(format!("{column}: {text:?} is no number")))
    }

    fn error(&self, reason: String) -> StudyError {
        let line = self.record.position().map_or(0, csv::Position::line);
        StudyError::Reference { file: self.file, reason: format!("line {line}: {reason}") }
    }
}

/// The rows of a file, each made into something.
fn rows<T>(file: &File, make: impl Fn(&Row<'_>) -> Result<T, StudyError>) -> Result<Vec<T>, StudyError> {
    let failed = |e: csv::Error| StudyError::Reference { file: file.name, reason: e.to_string() };
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(file.text.as_bytes());
    let header = reader.headers().map_err(failed)?.clone();
    reader
        .records()
        .map(|record| make(&Row { file: file.name, header: &header, record: record.map_err(failed)? }))
        .collect()
}

fn sphere(row: &Row<'_>, (n, k): (f64, f64), forward: Complex64, backward: Complex64) -> Result<Sphere, StudyError> {
    let exact = Optics {
        extinction: row.number("Qext")?,
        scattering: row.number("Qsca")?,
        absorption: row.number("Qabs")?,
        backscatter: row.number("Qback")?,
        asymmetry: row.number("g")?,
        forward,
        backward,
    };
    Ok(Sphere { x: row.number("x")?, n, k, exact })
}

/// 14 size parameters from 1e-4 to 1e4 by 14 refractive indices, x slowest.
pub(super) fn grid() -> Result<Vec<Sphere>, StudyError> {
    rows(&GRID, |row| {
        let complex = |re, im| Ok::<_, StudyError>(Complex64::new(row.number(re)?, row.number(im)?));
        let index = (row.number("n")?, row.number("k")?);
        sphere(row, index, complex("S_0_re", "S_0_im")?, complex("S1_180_re", "S1_180_im")?)
    })
}

/// 45 spheres with size parameters from 1e-6 to 1e6.
pub(super) fn spheres() -> Result<Vec<Sphere>, StudyError> {
    rows(&SPHERES, |row| {
        // The file has m = n - ik, and with it the conjugates of the amplitudes.
        let complex = |re, im| Ok::<_, StudyError>(Complex64::new(row.number(re)?, -row.number(im)?));
        let index = (row.number("m_re")?, 0.0 - row.number("m_im")?);
        sphere(row, index, complex("S1_0_re", "S1_0_im")?, complex("S1_180_re", "S1_180_im")?)
    })
}

/// Errors of the variants as an independent program found them.
pub(super) struct Scan {
    /// By variant, quantity, and the bits of x, n and k.
    errors: HashMap<(String, String, [u64; 3]), f64>,
}

impl Scan {
    pub(super) fn read(grid: &[Sphere]) -> Result<Self, StudyError> {
        let mut sizes: Vec<f64> = grid.iter().map(|sphere| sphere.x).collect();
        sizes.dedup();
        let lines = rows(&SCAN, |row| {
            let (variant, quantity) = (row.text("variant")?.to_owned(), row.text("quantity")?.to_owned());
            let (n, k) = (row.number("n")?, row.number("k")?);
            let mut found = Vec::new();
            for &x in &sizes {
                let column = x.to_string();
                if !row.text(&column)?.is_empty() {
                    found
                        .push(((variant.clone(), quantity.clone(), [x, n, k].map(f64::to_bits)), row.number(&column)?));
                }
            }
            Ok(found)
        })?;
        Ok(Self { errors: lines.into_iter().flatten().collect() })
    }

    /// The error found for a sphere; `None` where it was 1e-12 or less.
    pub(super) fn error(&self, variant: &str, quantity: Quantity, sphere: &Sphere) -> Option<f64> {
        let place = [sphere.x, sphere.n, sphere.k].map(f64::to_bits);
        self.errors.get(&(variant.to_owned(), quantity.as_str().to_owned(), place)).copied()
    }

    /// Errors in all.
    pub(super) fn len(&self) -> usize {
        self.errors.len()
    }
}
