//! A weighted sum over many spheres of one refractive index.

use super::angular::RUN;
use super::{AngularTable, MieError, RefractiveIndex, Solver};
use num_complex::Complex64;
use std::f64::consts::PI;

/// Spheres whose amplitudes are summed together, so that each run of angular functions is fetched once for
/// all of them.
const BATCH: usize = 8;

/// Sums over spheres i with weights w_i. Cross-sections are in units of the square of the wave number's
/// inverse: multiply by (lambda / 2 pi)^2 for m^2.
#[derive(Debug, Clone, PartialEq)]
pub struct Sums {
    /// sum w_i pi x_i^2 Qext.
    pub extinction: f64,
    /// sum w_i pi x_i^2 Qsca.
    pub scattering: f64,
    /// sum w_i pi x_i^2 Qabs.
    pub absorption: f64,
    /// sum w_i pi x_i^2 Qsca g.
    pub forward: f64,
    /// sum w_i (|S1|^2 + |S2|^2) / 2 at each angle. Its integral over the sphere is `scattering`.
    pub intensity: Vec<f64>,
}

impl Sums {
    /// Nothing summed yet, at `angles` angles.
    #[must_use]
    pub fn zero(angles: usize) -> Self {
        Self { extinction: 0.0, scattering: 0.0, absorption: 0.0, forward: 0.0, intensity: vec![0.0; angles] }
    }

    /// Adds `factor` times `other`, which has as many angles (further ones are left out).
    pub fn add(&mut self, other: &Self, factor: f64) {
        self.extinction += factor * other.extinction;
        self.scattering += factor * other.scattering;
        self.absorption += factor * other.absorption;
        self.forward += factor * other.forward;
        for (sum, term) in self.intensity.iter_mut().zip(&other.intensity) {
            *sum += factor * term;
        }
    }
}

/// Sums over spheres of index `m` given as (size parameter, weight). With a table of no angles only the
/// efficiencies are computed. After the largest sphere nothing is allocated but the result.
///
/// # Errors
/// [`MieError`] of the first sphere that cannot be solved, or [`MieError::Terms`] if the table is too small.
pub fn sum(
    m: RefractiveIndex,
    spheres: impl IntoIterator<Item = (f64, f64)>,
    angles: &AngularTable,
    solver: &mut Solver,
) -> Result<Sums, MieError> {
    let mut sums = Sums::zero(angles.cosines().len());
    let mut batch: Vec<Scaled> = Vec::new();
    let mut filled = 0;
    for (x, weight) in spheres {
        let sphere = solver.sphere(m, x)?;
        let q = sphere.efficiencies();
        let area = weight * PI * x * x;
        sums.extinction += area * q.extinction;
        sums.scattering += area * q.scattering;
        sums.absorption += area * q.absorption;
        if q.scattering > 0.0 {
            sums.forward += area * q.scattering * q.asymmetry;
        }
        if angles.cosines().is_empty() {
            continue;
        }
        let needed = sphere.a().len();
        if needed > angles.terms() {
            return Err(MieError::Terms { needed, available: angles.terms() });
        }
        if filled == batch.len() {
            batch.push(Scaled::default());
        }
        batch[filled].weight = weight;
        batch[filled].fill(sphere.a().iter().zip(sphere.b()), angles.cosines().len());
        filled += 1;
        if filled == BATCH {
            add_intensities(&mut batch, angles, &mut sums.intensity);
            filled = 0;
        }
    }
    add_intensities(&mut batch[..filled], angles, &mut sums.intensity);
    Ok(sums)
}

/// A sphere whose amplitudes are being summed.
#[derive(Default)]
struct Scaled {
    weight: f64,
    /// Real and imaginary parts of (2n + 1) / (n (n + 1)) (a_n + b_n), then of the same with a_n - b_n; in runs,
    /// the last filled up with zeros.
    coefficients: Vec<[f64; 4]>,
    /// Real and imaginary part of S+ and of S- at each angle.
    amplitudes: [Vec<f64>; 4],
}

impl Scaled {
    fn fill<'a>(&mut self, ab: impl Iterator<Item = (&'a Complex64, &'a Complex64)>, angles: usize) {
        self.coefficients.clear();
        self.coefficients.extend(ab.enumerate().map(|(i, (a, b))| {
            let n = (i + 1) as f64;
            let weight = (2.0 * n + 1.0) / (n * (n + 1.0));
            let (sum, difference) = ((a + b) * weight, (a - b) * weight);
            [sum.re, sum.im, difference.re, difference.im]
        }));
        self.coefficients.resize(self.coefficients.len().next_multiple_of(RUN), [0.0; 4]);
        for part in &mut self.amplitudes {
            part.clear();
            part.resize(angles, 0.0);
        }
    }
}

/// With S+ = S1 + S2 = sum (a + b)(pi + tau) and S- = S1 - S2 = sum (a - b)(pi - tau), each times
/// (2n + 1) / (n (n + 1)): (|S1|^2 + |S2|^2) / 2 = (|S+|^2 + |S-|^2) / 4.
fn add_intensities(spheres: &mut [Scaled], angles: &AngularTable, intensity: &mut [f64]) {
    let longest = spheres.iter().map(|sphere| sphere.coefficients.len() / RUN).max().unwrap_or(0);
    for (run, (plus, minus)) in angles.runs().take(longest).enumerate() {
        for Scaled { coefficients, amplitudes, .. } in spheres.iter_mut() {
            let Some(c) = coefficients.get(run * RUN..(run + 1) * RUN) else { continue };
            let of = |part: usize| std::array::from_fn(|order| c[order][part]);
            let [plus_re, plus_im, minus_re, minus_im] = amplitudes;
            add_run(plus_re, plus_im, plus, of(0), of(1));
            add_run(minus_re, minus_im, minus, of(2), of(3));
        }
    }
    for Scaled { weight, amplitudes, .. } in spheres {
        for part in amplitudes {
            for (sum, value) in intensity.iter_mut().zip(part) {
                *sum += 0.25 * *weight * *value * *value;
            }
        }
    }
}

/// Adds to `re` and `im`, at each angle, the functions of one run of orders times their coefficients. Slices of one
/// length and a plain loop: this is what compilers turn into vector instructions.
#[inline(never)]
fn add_run(re: &mut [f64], im: &mut [f64], functions: &[f64], real: [f64; RUN], imaginary: [f64; RUN]) {
    let angles = re.len();
    let im = &mut im[..angles];
    let (f0, rest) = functions.split_at(angles);
    let (f1, rest) = rest.split_at(angles);
    let (f2, f3) = rest.split_at(angles);
    let f3 = &f3[..angles];
    for j in 0..angles {
        re[j] += (real[0] * f0[j] + real[1] * f1[j]) + (real[2] * f2[j] + real[3] * f3[j]);
        im[j] += (imaginary[0] * f0[j] + imaginary[1] * f1[j]) + (imaginary[2] * f2[j] + imaginary[3] * f3[j]);
    }
}
