//! Timed tasks that compare Mie solvers: (a) efficiencies of many spheres of one index, (b) sums over size
//! distributions with a phase function. Files in the convention m = n - ik, lengths in um, as other programs write them.

use crate::mie::{
    AngularTable, Efficiencies, Instructions, MieError, RefractiveIndex, SIZE_PARAMETERS, Spheres, terms,
};
use serde::Deserialize;
use serde::de::{Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use std::collections::BTreeMap;
use std::f64::consts::PI;
use std::fmt::Write;
use std::time::{Duration, Instant};
use tables::excerpt;

/// Why a task cannot be done.
#[derive(Debug, thiserror::Error)]
pub enum TaskError {
    /// The input is not what the task takes.
    #[error("{0}")]
    Input(String),
    /// A sphere is out of range.
    #[error(transparent)]
    Sphere(#[from] MieError),
}

/// What a task gave.
#[derive(Debug, Clone, PartialEq)]
pub struct Done {
    /// The results as CSV.
    pub csv: String,
    /// Time of the fastest repeat, without reading and writing; the repeats start from the numbers read.
    pub fastest: Duration,
}

/// Runs `work` `repeats` times, at least once; its last result and the time of its fastest run.
fn timed<T>(repeats: u32, mut work: impl FnMut() -> Result<T, MieError>) -> Result<(T, Duration), MieError> {
    let mut start = Instant::now();
    let mut result = work()?;
    let mut fastest = start.elapsed();
    for _ in 1..repeats {
        start = Instant::now();
        result = work()?;
        fastest = fastest.min(start.elapsed());
    }
    Ok((result, fastest))
}

/// Task (a): efficiencies of spheres of one index.
#[derive(Debug, Clone, PartialEq)]
pub struct Alike {
    m: RefractiveIndex,
    x: Vec<f64>,
}

impl Alike {
    /// Reads a CSV with the columns `x`, `m_re`, `m_im` (m = n - ik, `m_im` <= 0), all of one index.
    ///
    /// # Errors
    /// [`TaskError`] for a malformed input, no sphere, more than one index, or one that is none.
    pub fn parse(text: &str) -> Result<Self, TaskError> {
        // A row of thousands of fields would take many times the memory of its text.
        if let Some(i) = text.lines().position(|line| line.bytes().filter(|&b| b == b',').count() >= MOST_FIELDS) {
            return Err(TaskError::Input(format!(
                "line {}: more than {MOST_FIELDS} fields, x, m_re, m_im are expected",
                i + 1
            )));
        }
        let mut reader = csv::Reader::from_reader(text.as_bytes());
        let mut rows: Vec<(f64, f64, f64)> = Vec::new();
        for row in reader.deserialize() {
            rows.push(row.map_err(|e: csv::Error| TaskError::Input(excerpt(&e.to_string())))?);
        }
        let Some(&(_, n, minus_k)) = rows.first() else { return Err(TaskError::Input("no spheres".into())) };
        if let Some(i) = rows.iter().position(|row| (row.1, row.2) != (n, minus_k)) {
            return Err(TaskError::Input(format!("line {}: another refractive index than in line 2", i + 2)));
        }
        Ok(Self { m: RefractiveIndex::new(n, -minus_k)?, x: rows.iter().map(|row| row.0).collect() })
    }

    /// `Qext`, `Qsca`, `Qabs`, `Qback`, `g` of each sphere in order.
    ///
    /// # Errors
    /// [`MieError`] for a sphere out of range.
    pub fn solve(&self, instructions: Instructions, repeats: u32) -> Result<Done, MieError> {
        let mut solver = Spheres::with(instructions);
        let (found, fastest) = timed(repeats, || solver.efficiencies(self.m, &self.x))?;
        let mut csv = String::from("Qext,Qsca,Qabs,Qback,g\n");
        for Efficiencies { extinction, scattering, absorption, backscatter, asymmetry } in found {
            // Writing to a String does not fail.
            let _ = writeln!(csv, "{extinction:e},{scattering:e},{absorption:e},{backscatter:e},{asymmetry:e}");
        }
        Ok(Done { csv, fastest })
    }
}

/// The most fields of a line.
const MOST_FIELDS: usize = 16;

/// The most numbers of a list of task (b).
const MOST_NUMBERS: usize = 1 << 16;

/// One size distribution of task (b).
#[derive(Debug, Clone, PartialEq, Deserialize)]
struct Mode {
    /// um.
    #[serde(deserialize_with = "numbers")]
    wavelengths: Vec<f64>,
    /// um.
    #[serde(deserialize_with = "numbers")]
    r: Vec<f64>,
    #[serde(deserialize_with = "numbers")]
    w: Vec<f64>,
    m_re: f64,
    m_im: f64,
}

/// A list of at most [`MOST_NUMBERS`].
#[derive(Deserialize)]
#[serde(transparent)]
struct Numbers(#[serde(deserialize_with = "numbers")] Vec<f64>);

/// For `#[serde(deserialize_with)]`: a list of at most [`MOST_NUMBERS`].
fn numbers<'de, D: Deserializer<'de>>(from: D) -> Result<Vec<f64>, D::Error> {
    struct List;
    impl<'de> Visitor<'de> for List {
        type Value = Vec<f64>;

        fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
            write!(f, "a list of at most {MOST_NUMBERS} numbers")
        }

        fn visit_seq<A: SeqAccess<'de>>(self, mut from: A) -> Result<Vec<f64>, A::Error> {
            let mut list = Vec::new();
            while let Some(number) = from.next_element()? {
                if list.len() == MOST_NUMBERS {
                    return Err(A::Error::custom(format_args!("a list of more than {MOST_NUMBERS} numbers")));
                }
                list.push(number);
            }
            list.shrink_to_fit();
            Ok(list)
        }
    }
    from.deserialize_seq(List)
}

/// The input of task (b): the angles, and every other key a mode, the later of two with one name.
#[derive(Default)]
struct Input {
    angles_deg: Option<Vec<f64>>,
    modes: BTreeMap<String, Mode>,
}

impl<'de> Deserialize<'de> for Input {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct Object;
        impl<'de> Visitor<'de> for Object {
            type Value = Input;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("an object of angles_deg and modes")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut from: A) -> Result<Input, A::Error> {
                let mut input = Input::default();
                while let Some(key) = from.next_key::<String>()? {
                    if key == "angles_deg" {
                        input.angles_deg = Some(from.next_value::<Numbers>()?.0);
                    } else {
                        input.modes.insert(key, from.next_value()?);
                    }
                }
                Ok(input)
            }
        }
        from.deserialize_map(Object)
    }
}

/// Task (b): sums over size distributions, at some angles.
#[derive(Debug, Clone, PartialEq)]
pub struct Distributions {
    cosines: Vec<f64>,
    /// By name, with the index of each.
    modes: Vec<(String, RefractiveIndex, Mode)>,
    /// Largest size parameter.
    largest: f64,
}

impl Distributions {
    /// Reads JSON `{"angles_deg": [...], NAME: {"wavelengths": [um], "r": [um], "w": [...], "m_re", "m_im"}, ...}`.
    ///
    /// # Errors
    /// [`TaskError`] for a malformed input or a size parameter out of range.
    pub fn parse(text: &str) -> Result<Self, TaskError> {
        let input: Input = serde_json::from_str(text).map_err(|e| TaskError::Input(excerpt(&e.to_string())))?;
        let angles_deg = input.angles_deg.ok_or_else(|| TaskError::Input("no angles_deg".into()))?;
        let (mut modes, mut largest) = (Vec::with_capacity(input.modes.len()), 0.0_f64);
        for (name, mode) in input.modes {
            if mode.r.len() != mode.w.len() || mode.r.is_empty() {
                let (r, w) = (mode.r.len(), mode.w.len());
                let name = excerpt(&name);
                return Err(TaskError::Input(format!("{name}: {r} radii and {w} weights; as many of each are needed")));
            }
            for x in
                mode.wavelengths.iter().flat_map(|wavelength| mode.r.iter().map(move |r| 2.0 * PI * r / wavelength))
            {
                // The solver refuses the same, but a table comes first, and the largest tells its length.
                if !(SIZE_PARAMETERS.0..=SIZE_PARAMETERS.1).contains(&x) {
                    return Err(MieError::Size { x }.into());
                }
                largest = largest.max(x);
            }
            modes.push((name, RefractiveIndex::new(mode.m_re, -mode.m_im)?, mode));
        }
        Ok(Self { cosines: angles_deg.into_iter().map(cosine).collect(), modes, largest })
    }

    /// For each mode and wavelength `mode`, `iw`, `Cext` and `Csca` (sum of w pi r^2 Q in um^2), `g`, and at each angle j
    /// `Pj` = sum of w (|S1|^2 + |S2|^2) / 2.
    ///
    /// # Errors
    /// [`MieError`] for a sphere out of range.
    pub fn solve(&self, instructions: Instructions, repeats: u32) -> Result<Done, MieError> {
        let each = |(_, m, mode): &'_ (String, RefractiveIndex, Mode), solver: &mut Spheres, table: &AngularTable| {
            let sums = |wavelength: &f64| {
                let k = 2.0 * PI / wavelength;
                solver.sum(*m, mode.r.iter().zip(&mode.w).map(|(r, w)| (k * r, *w)), table)
            };
            mode.wavelengths.iter().map(sums).collect::<Result<Vec<_>, _>>()
        };
        let mut solver = Spheres::with(instructions);
        let (found, fastest) = timed(repeats, || {
            // The table of angular functions is part of the work.
            let table = AngularTable::new(&self.cosines, terms(self.largest))?;
            self.modes.iter().map(|mode| each(mode, &mut solver, &table)).collect::<Result<Vec<_>, _>>()
        })?;
        let mut csv = String::from("mode,iw,Cext,Csca,g");
        for j in 0..self.cosines.len() {
            let _ = write!(csv, ",P{j}");
        }
        csv.push('\n');
        for ((name, _, mode), found) in self.modes.iter().zip(&found) {
            for (i, (wavelength, sums)) in mode.wavelengths.iter().zip(found).enumerate() {
                let area = (wavelength / (2.0 * PI)).powi(2);
                let (extinction, scattering) = (area * sums.extinction, area * sums.scattering);
                let _ = write!(csv, "{name},{i},{extinction:e},{scattering:e},{:e}", sums.forward / sums.scattering);
                for p in sums.intensity() {
                    let _ = write!(csv, ",{p:e}");
                }
                csv.push('\n');
            }
        }
        Ok(Done { csv, fastest })
    }
}

/// The cosine of an angle in degrees, exact where it is a whole number.
fn cosine(degrees: f64) -> f64 {
    if degrees == 90.0 { 0.0 } else { degrees.to_radians().cos() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_radius_out_of_range_is_refused_by_the_reader() {
        let input = r#"{"angles_deg": [0.0, 90.0], "dust": {"wavelengths": [0.5], "r": [1e30], "w": [1.0], "m_re": 1.5, "m_im": -0.01}}"#;
        let error = Distributions::parse(input).expect_err("too large");
        assert!(error.to_string().starts_with("size parameter 12566370"), "{error}");
    }
}
