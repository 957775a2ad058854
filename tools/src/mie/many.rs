//! A weighted sum over many spheres of one refractive index.

use super::angular::LANES;
use super::{AngularTable, MieError, RefractiveIndex, Solver};
use std::f64::consts::PI;

/// Spheres whose amplitudes are summed together, so that the angular functions of a block of angles are
/// fetched once for all of them.
const BATCH: usize = 16;

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
        batch[filled].fill(sphere.a().iter().zip(sphere.b()));
        filled += 1;
        if filled == BATCH {
            add_intensities(&batch, angles, &mut sums.intensity);
            filled = 0;
        }
    }
    add_intensities(&batch[..filled], angles, &mut sums.intensity);
    Ok(sums)
}

/// Real and imaginary parts of (2n + 1) / (n (n + 1)) (a_n + b_n) and of the same with a_n - b_n.
#[derive(Default)]
struct Scaled {
    weight: f64,
    coefficients: Vec<[f64; 4]>,
}

impl Scaled {
    fn fill<'a>(&mut self, ab: impl Iterator<Item = (&'a num_complex::Complex64, &'a num_complex::Complex64)>) {
        self.coefficients.clear();
        self.coefficients.extend(ab.enumerate().map(|(i, (a, b))| {
            let n = (i + 1) as f64;
            let weight = (2.0 * n + 1.0) / (n * (n + 1.0));
            let (sum, difference) = ((a + b) * weight, (a - b) * weight);
            [sum.re, sum.im, difference.re, difference.im]
        }));
    }
}

/// With S+ = S1 + S2 = sum (a + b)(pi + tau) and S- = S1 - S2 = sum (a - b)(pi - tau), each times
/// (2n + 1) / (n (n + 1)): (|S1|^2 + |S2|^2) / 2 = (|S+|^2 + |S-|^2) / 4.
fn add_intensities(spheres: &[Scaled], angles: &AngularTable, intensity: &mut [f64]) {
    for (block, out) in angles.blocks().zip(intensity.chunks_mut(LANES)) {
        for sphere in spheres {
            let [plus_re, plus_im, minus_re, minus_im] = amplitudes(block, &sphere.coefficients);
            for (lane, out) in out.iter_mut().enumerate() {
                let plus = plus_re[lane] * plus_re[lane] + plus_im[lane] * plus_im[lane];
                let minus = minus_re[lane] * minus_re[lane] + minus_im[lane] * minus_im[lane];
                *out += 0.25 * sphere.weight * (plus + minus);
            }
        }
    }
}

/// Real and imaginary parts of S+ and S- at the angles of a block.
#[inline]
fn amplitudes(block: &[[[f64; LANES]; 2]], coefficients: &[[f64; 4]]) -> [[f64; LANES]; 4] {
    let mut sums = [[0.0; LANES]; 4];
    for ([plus, minus], c) in block.iter().zip(coefficients) {
        for lane in 0..LANES {
            sums[0][lane] += c[0] * plus[lane];
            sums[1][lane] += c[1] * plus[lane];
            sums[2][lane] += c[2] * minus[lane];
            sums[3][lane] += c[3] * minus[lane];
        }
    }
    sums
}
