//! Phase functions: where light goes when it is scattered.
//!
//! Each is a probability density over the sphere in sr^-1, a function of
//! c = cos(scattering angle) alone, so its value is also the density of its
//! samples and the weight of a sample is 1 for the wavelength it was drawn for.
//! Other wavelengths carried by the same path are weighted by the ratio of values.

use std::f64::consts::PI;

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
    pub fn values(&self, c: f64) -> [f64; L] {
        match self {
            Self::Rayleigh { gamma } => gamma.map(|gamma| rayleigh(gamma, c)),
            Self::HenyeyGreenstein { g } => g.map(|g| henyey_greenstein(g, c)),
        }
    }

    /// Value in sr^-1 at wavelength number `lane`.
    #[must_use]
    pub fn value(&self, lane: usize, c: f64) -> f64 {
        match self {
            Self::Rayleigh { gamma } => rayleigh(gamma[lane], c),
            Self::HenyeyGreenstein { g } => henyey_greenstein(g[lane], c),
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
        all
    }

    /// 2 pi times the integral over c of f, by the midpoint rule on n cells.
    fn over_sphere(n: u32, f: impl Fn(f64) -> f64) -> f64 {
        let h = 2.0 / f64::from(n);
        2.0 * PI * h * (0..n).map(|i| f(-1.0 + (f64::from(i) + 0.5) * h)).sum::<f64>()
    }

    #[test]
    fn values_integrate_to_one_and_give_the_mean_cosine() {
        for (name, phase, g) in all() {
            // The midpoint rule's error is below 1e-7 for the sharpest peak (g = 0.95).
            let integral = over_sphere(2_000_000, |c| phase.value(0, c));
            let mean = over_sphere(2_000_000, |c| c * phase.value(0, c));
            assert!((integral - 1.0).abs() < 1e-7, "{name}: integral {integral}");
            assert!((mean - g).abs() < 1e-7, "{name}: mean cosine {mean}");
        }
    }

    #[test]
    fn samples_invert_the_cumulative_distribution() {
        for (name, phase, g) in all() {
            for i in 0..=40 {
                let u = f64::from(i) / 40.0;
                let c = phase.sample(0, u).cosine;
                let n = 200_000;
                let h = (c + 1.0) / f64::from(n);
                let below: f64 = 2.0 * PI * h * (0..n).map(|k| phase.value(0, -1.0 + (f64::from(k) + 0.5) * h)).sum::<f64>();
                // The midpoint rule, and the expansion for small g: g^2.
                let tolerance = if g.abs() < 1e-3 { 2e-6 } else { 1e-6 };
                assert!((below - u).abs() < tolerance, "{name}: cumulative {below} at u = {u}");
            }
        }
    }

    #[test]
    fn samples_pass_chi_square_against_the_density() {
        // 64 cells of equal probability by the cumulative midpoint; with 63
        // degrees of freedom chi-square exceeds 123 with probability 1e-5 by the
        // Wilson-Hilferty approximation; 10 phase functions, fixed seeds.
        const CELLS: usize = 64;
        const N: u32 = 64_000;
        for (k, (name, phase, _)) in all().into_iter().enumerate() {
            let n = 4_000_000;
            let h = 2.0 / f64::from(n);
            let mut edges = Vec::with_capacity(CELLS);
            let mut below = 0.0;
            for i in 0..n {
                below += 2.0 * PI * h * phase.pdf(0, -1.0 + (f64::from(i) + 0.5) * h);
                if below >= (edges.len() + 1) as f64 / CELLS as f64 {
                    edges.push(-1.0 + f64::from(i + 1) * h);
                }
            }
            edges.truncate(CELLS - 1);
            let mut counts = [0.0_f64; CELLS];
            let mut sampler = crate::sampling::Sampler::new(11, k as u64, 0);
            for _ in 0..N {
                let c = phase.sample(0, sampler.next()).cosine;
                counts[edges.partition_point(|&e| e <= c)] += 1.0;
            }
            let expected = f64::from(N) / CELLS as f64;
            let chi2: f64 = counts.iter().map(|n| (n - expected).powi(2) / expected).sum();
            assert!(chi2 < 123.0, "{name}: chi-square {chi2} with {} degrees of freedom", CELLS - 1);
        }
    }

    #[test]
    fn lanes_are_independent() {
        let phase = Phase::HenyeyGreenstein { g: [0.1, 0.9] };
        let both = phase.values(0.5);
        assert_eq!(both, [henyey_greenstein(0.1, 0.5), henyey_greenstein(0.9, 0.5)]);
        assert_eq!(phase.value(1, 0.5), both[1]);
    }
}
