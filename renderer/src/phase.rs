//! Phase functions: where light goes when it is scattered.
//!
//! Each is a probability density over the sphere in sr^-1, a function of
//! c = cos(scattering angle) alone, so its value is also the density of its
//! samples and the weight of a sample is 1 for the wavelength it was drawn for.
//! Other wavelengths carried by the same path are weighted by the ratio of values.

use crate::lookup::Lookup;
use crate::polarisation::{Natural, Scattering};
use std::f64::consts::PI;
use std::sync::Arc;

/// A phase function at each of `L` wavelengths.
#[derive(Debug, Clone)]
pub enum Phase<const L: usize> {
    /// Rayleigh scattering by molecules that are not spheres (Chandrasekhar
    /// 1960, chapter 1, section 18): 3 / (16 pi (1 + 2 gamma)) ((1 + 3 gamma) + (1 - gamma) c^2),
    /// gamma = rho / (2 - rho), rho the depolarisation of natural light at 90
    /// degrees; 0 <= gamma < 1. gamma = 0 is Rayleigh's own 3 / (16 pi) (1 + c^2).
    Rayleigh {
        /// gamma at each wavelength.
        gamma: [f64; L],
    },
    /// Henyey & Greenstein 1941: (1 - g^2) / (4 pi (1 + g^2 - 2 g c)^(3/2)), |g| < 1
    /// the mean of c.
    HenyeyGreenstein {
        /// Asymmetry parameter at each wavelength.
        g: [f64; L],
    },
    /// A table, linear in c between its nodes: the phase functions of Mie theory.
    Tabulated(Arc<Tabulated<L>>),
}

/// Phase functions on common nodes, with their cumulative distributions.
#[derive(Debug, Clone)]
pub struct Tabulated<const L: usize> {
    /// Cosines of the scattering angle, increasing from -1 to 1.
    cosines: Vec<f64>,
    /// 1 - c of the nodes, increasing: they lie closest at 0, in its root sin(angle / 2) about evenly.
    forwards: Lookup,
    /// Values in sr^-1 at each node.
    values: Vec<[f64; L]>,
    /// 2 pi times the integral of the values from -1 to each node.
    cumulative: Vec<[f64; L]>,
    /// Matrices of scattering in sr^-1 at each node, where they are known.
    matrices: Option<Vec<[Scattering; L]>>,
}

impl<const L: usize> Tabulated<L> {
    /// Phase functions from their values (sr^-1 up to a factor, which
    /// normalisation removes) at increasing `cosines` that begin at -1 and end at 1. `None` if the
    /// nodes are not so, or if a value is negative, not finite, or all of a wavelength are zero.
    #[must_use]
    pub fn new(cosines: Vec<f64>, mut values: Vec<[f64; L]>) -> Option<Self> {
        let ends = cosines.len() >= 2 && cosines[0] == -1.0 && cosines[cosines.len() - 1] == 1.0;
        let sound = values.iter().flatten().all(|v| v.is_finite() && *v >= 0.0);
        if !ends || !sound || cosines.len() != values.len() || !cosines.windows(2).all(|w| w[0] < w[1]) {
            return None;
        }
        let mut cumulative = vec![[0.0; L]; cosines.len()];
        for i in 1..cosines.len() {
            let width = PI * (cosines[i] - cosines[i - 1]);
            for j in 0..L {
                cumulative[i][j] = cumulative[i - 1][j] + width * (values[i - 1][j] + values[i][j]);
            }
        }
        let total = cumulative[cosines.len() - 1];
        if total.iter().any(|&t| t <= 0.0) {
            return None;
        }
        for j in 0..L {
            values.iter_mut().chain(&mut cumulative).for_each(|row| row[j] /= total[j]);
        }
        let forwards = Lookup::new(cosines.iter().rev().map(|c| 1.0 - c).collect());
        Some(Self { cosines, forwards, values, cumulative, matrices: None })
    }

    /// With the matrices of scattering at each node, over their a1. Between nodes every element is linear as the phase
    /// function is, so that a matrix there is a mean of two possible ones. `None` if they are not as many as the
    /// nodes, or not [`Scattering::possible`].
    #[must_use]
    pub fn with_matrices(self, mut ratios: Vec<[Scattering; L]>) -> Option<Self> {
        if ratios.len() != self.cosines.len() {
            return None;
        }
        for (row, values) in ratios.iter_mut().zip(&self.values) {
            for (matrix, &value) in row.iter_mut().zip(values) {
                *matrix = matrix.possible()? * value;
            }
        }
        Some(Self { matrices: Some(ratios), ..self })
    }

    /// Cosines of the scattering angle at the nodes, from -1 to 1.
    #[must_use]
    pub fn cosines(&self) -> &[f64] {
        &self.cosines
    }

    /// Index of a node about `c`, at most the last but one, and the fraction to the next.
    #[inline(always)]
    fn locate(&self, c: f64) -> (usize, f64) {
        let i = self.cosines.len() - 2 - self.forwards.cell(1.0 - c);
        let (a, b) = (self.cosines[i], self.cosines[i + 1]);
        (i, ((c - a) / (b - a)).clamp(0.0, 1.0))
    }

    #[inline(always)]
    fn values(&self, c: f64) -> [f64; L] {
        let (i, f) = self.locate(c);
        let (a, b) = (&self.values[i], &self.values[i + 1]);
        let mut values = [0.0; L];
        for j in 0..L {
            values[j] = a[j] + f * (b[j] - a[j]);
        }
        values
    }

    /// Matrices of scattering; a phase function alone counts as depolarising.
    #[inline]
    fn matrices(&self, c: f64) -> [Scattering; L] {
        let Some(matrices) = &self.matrices else {
            return self.values(c).map(Scattering::depolarising);
        };
        let (i, f) = self.locate(c);
        let (a, b) = (&matrices[i], &matrices[i + 1]);
        std::array::from_fn(|j| a[j] * (1.0 - f) + b[j] * f)
    }

    fn value(&self, lane: usize, c: f64) -> f64 {
        let (i, f) = self.locate(c);
        let (a, b) = (self.values[i][lane], self.values[i + 1][lane]);
        a + f * (b - a)
    }

    /// Inverts the cumulative distribution: the interval by bisection, then
    /// v_a f + (v_b - v_a) f^2 / 2 = s for the fraction f, in the form of the
    /// root that does not cancel, f = 2 s / (v_a + sqrt(v_a^2 + 2 (v_b - v_a) s)).
    fn sample(&self, lane: usize, u: f64) -> f64 {
        let i = self.cumulative.partition_point(|row| row[lane] <= u).clamp(1, self.cosines.len() - 1) - 1;
        let width = self.cosines[i + 1] - self.cosines[i];
        let s = (u - self.cumulative[i][lane]) / (2.0 * PI * width);
        let (a, b) = (self.values[i][lane], self.values[i + 1][lane]);
        let root = a + (a * a + 2.0 * (b - a) * s).max(0.0).sqrt();
        let fraction = if root > 0.0 { (2.0 * s / root).clamp(0.0, 1.0) } else { 0.5 };
        self.cosines[i] + fraction * width
    }
}

/// A scattering angle drawn from a phase function.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PhaseSample {
    /// Cosine of the scattering angle.
    pub cosine: f64,
    /// Density of the direction, sr^-1.
    pub pdf: f64,
    /// Value over density.
    pub weight: f64,
}

impl<const L: usize> Phase<L> {
    /// Value in sr^-1 at every wavelength for the cosine `c` of the scattering angle.
    #[must_use]
    #[inline(always)]
    pub fn values(&self, c: f64) -> [f64; L] {
        match self {
            Self::Rayleigh { gamma } => gamma.map(|gamma| rayleigh(gamma, c)),
            Self::HenyeyGreenstein { g } => g.map(|g| henyey_greenstein(g, c)),
            Self::Tabulated(table) => table.values(c),
        }
    }

    /// Whether it knows what it does to polarisation: Henyey-Greenstein functions, and tables of the phase function alone, do not.
    #[must_use]
    pub fn has_matrix(&self) -> bool {
        match self {
            Self::Rayleigh { .. } => true,
            Self::HenyeyGreenstein { .. } => false,
            Self::Tabulated(table) => table.matrices.is_some(),
        }
    }

    /// Matrices of scattering in sr^-1 at every wavelength, a1 the value; depolarising where there is none ([`Phase::has_matrix`]).
    #[must_use]
    #[inline]
    pub fn matrices(&self, c: f64) -> [Scattering; L] {
        match self {
            Self::Rayleigh { gamma } => gamma.map(|gamma| Scattering::rayleigh(gamma, c)),
            Self::HenyeyGreenstein { g } => g.map(|g| Scattering::depolarising(henyey_greenstein(g, c))),
            Self::Tabulated(table) => table.matrices(c),
        }
    }

    /// What becomes of natural light at every wavelength: the first columns of [`Phase::matrices`].
    #[must_use]
    #[inline]
    pub fn natural(&self, c: f64) -> [Natural; L] {
        self.matrices(c).map(|matrix| matrix.natural())
    }

    /// Value in sr^-1 at wavelength number `lane`.
    #[must_use]
    pub fn value(&self, lane: usize, c: f64) -> f64 {
        match self {
            Self::Rayleigh { gamma } => rayleigh(gamma[lane], c),
            Self::HenyeyGreenstein { g } => henyey_greenstein(g[lane], c),
            Self::Tabulated(table) => table.value(lane, c),
        }
    }

    /// Density in sr^-1 of the samples drawn for wavelength number `lane`: the value.
    #[must_use]
    pub fn pdf(&self, lane: usize, c: f64) -> f64 {
        self.value(lane, c)
    }

    /// Draws a scattering angle for wavelength number `lane` by inverting the
    /// cumulative distribution at `u` in [0, 1).
    #[must_use]
    pub fn sample(&self, lane: usize, u: f64) -> PhaseSample {
        let cosine = match self {
            Self::Rayleigh { gamma } => sample_rayleigh(gamma[lane], u),
            Self::HenyeyGreenstein { g } => sample_henyey_greenstein(g[lane], u),
            Self::Tabulated(table) => table.sample(lane, u),
        };
        PhaseSample { cosine, pdf: self.pdf(lane, cosine), weight: 1.0 }
    }
}

fn rayleigh(gamma: f64, c: f64) -> f64 {
    3.0 / (16.0 * PI * (1.0 + 2.0 * gamma)) * ((1.0 + 3.0 * gamma) + (1.0 - gamma) * c * c)
}

/// The cumulative distribution in c is a cubic; setting it to u gives
/// c^3 + 3 p c = 2 q with p = (1 + 3 gamma) / (1 - gamma) > 0 and
/// q = (4 u - 2) (1 + 2 gamma) / (1 - gamma), whose one real root is
/// a - p / a with a^3 = q + sqrt(q^2 + p^3) (Cardano).
/// By symmetry only q >= 0 is solved, where nothing cancels in a.
fn sample_rayleigh(gamma: f64, u: f64) -> f64 {
    let p = (1.0 + 3.0 * gamma) / (1.0 - gamma);
    let q = (4.0 * u - 2.0) * (1.0 + 2.0 * gamma) / (1.0 - gamma);
    let a = (q.abs() + (q * q + p * p * p).sqrt()).cbrt();
    (a - p / a).copysign(q).clamp(-1.0, 1.0)
}

fn henyey_greenstein(g: f64, c: f64) -> f64 {
    let base = 1.0 + g * g - 2.0 * g * c;
    (1.0 - g * g) / (4.0 * PI * base * base.sqrt())
}

/// With s = 2u - 1 the cumulative distribution inverts to
/// 2 g c = 1 + g^2 - ((1 - g^2) / (1 + g s))^2; below |g| = 1e-3 its first order in g,
/// c = s + 3/2 g (1 - s^2), is right to g^2 and does not divide by g.
fn sample_henyey_greenstein(g: f64, u: f64) -> f64 {
    let s = 2.0 * u - 1.0;
    if g.abs() < 1e-3 {
        return (s + 1.5 * g * (1.0 - s * s)).clamp(-1.0, 1.0);
    }
    let ratio = (1.0 - g * g) / (1.0 + g * s);
    ((1.0 + g * g - ratio * ratio) / (2.0 * g)).clamp(-1.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// One of each, at the ends and the middle of their ranges.
    fn all() -> Vec<(String, Phase<1>, f64)> {
        let mut all = Vec::new();
        for gamma in [0.0, 0.0143, 0.2, 0.9] {
            all.push((format!("Rayleigh, gamma {gamma}"), Phase::Rayleigh { gamma: [gamma] }, 0.0));
        }
        for g in [-0.5, 0.0, 5e-4, 0.3, 0.76, 0.95] {
            all.push((format!("Henyey-Greenstein, g {g}"), Phase::HenyeyGreenstein { g: [g] }, g));
        }
        let (table, g) = peaked();
        all.push(("table with a forward peak, a glory and a gap".into(), Phase::Tabulated(Arc::new(table)), g));
        all
    }

    /// A table with values over five decades, a jump in slope and a stretch of zero, and its mean cosine:
    /// the integral of c (v_a + (v_b - v_a) (c - a) / (b - a)) over each interval.
    fn peaked() -> (Tabulated<1>, f64) {
        let nodes = [
            (-1.0, 0.5),
            (-0.98, 0.1),
            (-0.3, 0.0),
            (-0.1, 0.0),
            (0.4, 0.2),
            (0.9, 1.0),
            (0.99, 30.0),
            (0.9999, 2000.0),
            (1.0, 1e4),
        ];
        let (cosines, values) = nodes.iter().map(|&(c, v)| (c, [v])).unzip();
        let table = Tabulated::new(cosines, values).expect("sound");
        let moment = |i: usize| {
            let (a, b) = (table.cosines[i], table.cosines[i + 1]);
            let (v, w) = (table.values[i][0], table.values[i + 1][0]);
            2.0 * PI * (b - a) * (v * (2.0 * a + b) + w * (a + 2.0 * b)) / 6.0
        };
        let g = (0..table.cosines.len() - 1).map(moment).sum();
        (table, g)
    }

    /// 2 pi times the integral of f(c) from -1 to `end`, by Simpson's rule on 400 cells between the places
    /// where one of the phase functions above has a corner or a peak: exact for lines, 1e-9 for the rest.
    fn integral(end: f64, f: impl Fn(f64) -> f64) -> f64 {
        const CORNERS: [f64; 13] = [-1.0, -0.999, -0.98, -0.9, -0.3, -0.1, 0.4, 0.9, 0.98, 0.99, 0.996, 0.9999, 1.0];
        const CELLS: u32 = 400;
        let cell = |a: f64, b: f64| (b - a) / 6.0 * (f(a) + 4.0 * f(0.5 * (a + b)) + f(b));
        let stretch = |a: f64, b: f64| -> f64 {
            let at = |i: u32| a + (b - a) * f64::from(i) / f64::from(CELLS);
            (0..CELLS).map(|i| cell(at(i), at(i + 1))).sum()
        };
        2.0 * PI * CORNERS.windows(2).filter(|w| w[0] < end).map(|w| stretch(w[0], w[1].min(end))).sum::<f64>()
    }

    #[test]
    fn values_integrate_to_one_and_give_the_mean_cosine() {
        for (name, phase, g) in all() {
            let norm = integral(1.0, |c| phase.value(0, c));
            let mean = integral(1.0, |c| c * phase.value(0, c));
            assert!((norm - 1.0).abs() < 1e-8, "{name}: integral {norm}");
            assert!((mean - g).abs() < 1e-8, "{name}: mean cosine {mean}");
        }
    }

    #[test]
    fn samples_invert_the_cumulative_distribution() {
        for (name, phase, g) in all() {
            for i in 0..=40 {
                let u = f64::from(i) / 40.0;
                let c = phase.sample(0, u).cosine;
                let below = integral(c, |c| phase.value(0, c));
                // The quadrature; the expansion for small g leaves g^2.
                let tolerance = if g.abs() < 1e-3 { 2e-6 } else { 1e-8 };
                assert!((below - u).abs() < tolerance, "{name}: cumulative {below} at u = {u}");
            }
        }
    }

    #[test]
    fn samples_pass_chi_square_against_the_density() {
        // 64 cells of equal probability by the cumulative midpoint; with 63
        // degrees of freedom chi-square exceeds 123 with probability 1e-5 by the
        // Wilson-Hilferty approximation; 11 phase functions, fixed seeds.
        const CELLS: usize = 64;
        const N: u32 = 64_000;
        for (k, (name, phase, _)) in all().into_iter().enumerate() {
            let edge = |k: usize| {
                let (mut low, mut high) = (-1.0, 1.0);
                for _ in 0..30 {
                    let middle = 0.5 * (low + high);
                    let below = integral(middle, |c| phase.pdf(0, c));
                    if below < k as f64 / CELLS as f64 { low = middle } else { high = middle }
                }
                low
            };
            let edges: Vec<f64> = (1..CELLS).map(edge).collect();
            let mut counts = [0.0_f64; CELLS];
            let mut sampler = crate::sampling::Sampler::new(11, k as u64, 0);
            for _ in 0..N {
                let c = phase.sample(0, sampler.uniform()).cosine;
                counts[edges.partition_point(|&e| e <= c)] += 1.0;
            }
            let expected = f64::from(N) / CELLS as f64;
            let chi2: f64 = counts.iter().map(|n| (n - expected).powi(2) / expected).sum();
            assert!(chi2 < 123.0, "{name}: chi-square {chi2} with {} degrees of freedom", CELLS - 1);
        }
    }

    #[test]
    fn unsound_tables_are_refused() {
        for (cosines, values) in [
            (vec![-1.0, 1.0], vec![[1.0]]),
            (vec![-1.0, 0.5], vec![[1.0], [1.0]]),
            (vec![-1.0, 0.5, 0.5, 1.0], vec![[1.0]; 4]),
            (vec![-1.0, 1.0], vec![[1.0], [-1.0]]),
            (vec![-1.0, 1.0], vec![[1.0], [f64::NAN]]),
            (vec![-1.0, 1.0], vec![[0.0], [0.0]]),
        ] {
            assert!(Tabulated::new(cosines.clone(), values.clone()).is_none(), "{cosines:?}, {values:?}");
        }
    }

    #[test]
    fn matrices_go_with_the_phase_function() {
        let (table, _) = peaked();
        let nodes = table.cosines().len();
        let ratios = |row: [f64; 3]| vec![[Scattering::of_spheres(1.0, row)]; nodes];
        let with = table.clone().with_matrices(ratios([-0.3, 0.8, 0.5])).expect("possible");
        for c in [-1.0, -0.97, 0.1, 0.95, 0.99995, 1.0] {
            let p11 = table.value(0, c);
            let [matrix] = with.matrices(c);
            let expected = Scattering::of_spheres(p11, [-0.3, 0.8, 0.5].map(|ratio| ratio * p11));
            let off = matrix + expected * -1.0;
            // Lines between the same nodes: rounding.
            for off in [off.a1, off.a2, off.a3, off.a4, off.b1, off.b2] {
                assert!(off.abs() <= 1e-14 * p11, "{matrix:?} for {expected:?}");
            }
            assert_eq!(table.matrices(c), [Scattering::depolarising(p11)]);
        }
        assert!(table.clone().with_matrices(ratios([0.9, 0.9, 0.0])).is_none(), "impossible");
        assert!(table.clone().with_matrices(ratios([0.0; 3])[1..].to_vec()).is_none(), "too few");
        assert!(table.with_matrices(ratios([f64::NAN, 0.0, 0.0])).is_none(), "no number");
    }

    #[test]
    fn lanes_are_independent() {
        let phase = Phase::HenyeyGreenstein { g: [0.1, 0.9] };
        let both = phase.values(0.5);
        assert_eq!(both, [henyey_greenstein(0.1, 0.5), henyey_greenstein(0.9, 0.5)]);
        assert_eq!(phase.value(1, 0.5), both[1]);
    }
}
