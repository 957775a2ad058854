//! Sunlight scattered several times within forward peaks: what delta-M loses near the sun.
//!
//! A phase function is P = P_M + f Q: P_M the series that the table keeps, Q the peak, whose moments q_l are 1 up to the last degree
//! kept and chi_l / f beyond it. For the table's air light scattered by Q goes straight on, and what is scattered once by P (TMS,
//! Nakajima & Tanaka 1988) arrives with that air's extinction. So light scattered once by a peak shows how wide the peak is, but not that
//! it is scattered there again, and it counts twice what the table takes for direct sunlight.
//!
//! Near the sun all ways of light scattered by peaks alone are as long as the straight one. If T is the optical depth of peaks along
//! it, from the top of the air by the place to the eye, light of n such scatterings has the share e^-T T^n / n! (Poisson) and the n-fold
//! convolution of Q, with the moments q_l^n. Against the table's air, which has e^-T taken out, light scattered once by Q
//! stands for all of them if it gets the function
//!
//! G(Theta, T) = e^-T sum_(n >= 1) T^(n-1) / n! Q^(*n)(Theta).
//!
//! To the second order in T that is what Nakajima & Tanaka (1988) call IMS, with the true lengths of a round planet. T here is the mean
//! over the line of sight, weighted by the light scattered once.

use super::depths::{Along, Depths};
use super::harmonics::{MOST_DEGREE, legendre};
use super::line::MOST_SPECIES;
use super::species::{Species, moments};
use crate::atmosphere::{Medium, MediumError};
use crate::geometry::{Place, Shape};
use crate::vectors::{add_product, add_scaled, exp_minus, vectorised};
use glam::DVec3;
use pulp::NullaryFnOnce;
use std::f64::consts::{FRAC_1_PI, PI};

/// Convolutions that are tabulated: twofold and so on; the last stands for all further ones.
const FOLDS: usize = 5;

/// The highest moment of a peak: the squares of those beyond are nothing.
const LAST: usize = 400;

/// Steps of the scattering angle Theta = pi (i / STEPS)^2.
const STEPS: usize = 384;

/// Of a peak that has less of the scattered light nothing is made.
const LEAST: f64 = 1e-3;

/// The peaks of an atmosphere's phase functions.
#[derive(Debug)]
pub(super) struct Aureole<const L: usize> {
    /// Of each species.
    peaks: [Option<Peak<L>>; MOST_SPECIES],
    /// What they scatter.
    depths: Depths<L>,
    /// The highest degree that the table keeps.
    degree: usize,
}

/// The peak of a phase function.
#[derive(Debug)]
struct Peak<const L: usize> {
    /// f Q^(*n) in sr^-1 for n = 2 and further, by angle.
    folds: Vec<[[f64; L]; FOLDS]>,
    /// What the table keeps of the phase function in sr^-1, (1 - f) P_M, as a sum over m of these times cos m Theta.
    kept: Vec<[f64; L]>,
}

impl<const L: usize> Aureole<L> {
    /// Without peaks.
    pub(super) fn none() -> Self {
        Self { peaks: Default::default(), depths: Depths::none(), degree: 0 }
    }

    /// Of the species of a medium from which the peaks were cut.
    pub(super) fn new(species: &[Species<L>], medium: &Medium<L>, shape: Shape) -> Result<Self, MediumError> {
        let mut peaks: [Option<Peak<L>>; MOST_SPECIES] = Default::default();
        let mut scattered = Vec::new();
        for (peak, one) in peaks.iter_mut().zip(species) {
            let straight = one.straight();
            if straight.iter().any(|&f| f > LEAST) {
                *peak = Some(Peak::new(one));
                // What was cut off the cross-section: f of the whole, the rest is 1 - f of it.
                scattered.push((one, std::array::from_fn(|j| one.scattering[j] * straight[j] / (1.0 - straight[j]))));
            }
        }
        let degree = species.iter().map(|one| one.coefficients.len()).max().unwrap_or(0).saturating_sub(1);
        Ok(Self { peaks, depths: Depths::new(&scattered, medium, shape)?, degree })
    }

    /// A line of sight; none where there are no peaks.
    #[inline(always)]
    pub(super) fn along(&self, from: Place, direction: DVec3) -> Option<Along<'_, L>> {
        if self.is_none() { None } else { Some(self.depths.along(from, direction)) }
    }

    /// What a direction, at an angle from the sun with this cosine, shows of the peaks, where their mean depth is T.
    #[inline(always)]
    pub(super) fn towards(&self, cosine: f64, depth: &[f64; L]) -> Widened<'_, L> {
        let cosine = cosine.clamp(-1.0, 1.0);
        // cos 2m Theta = 2 cos^2 m Theta - 1 and its like, so that the chain of products is short.
        let mut multiples = [1.0; MOST_DEGREE + 1];
        multiples[1] = cosine;
        for m in 2..=self.degree {
            let (half, rest) = (multiples[m / 2], multiples[m - m / 2]);
            multiples[m] = 2.0 * half * rest - multiples[m % 2];
        }
        let place = (cosine.acos() / PI).sqrt() * STEPS as f64;
        let below = (place as usize).min(STEPS - 1);
        // e^-T T^(n-1) / n! of n scatterings; the last has what is left of (1 - e^-T) / T.
        let through = exp_minus(*depth);
        let (mut shares, mut term, mut left) = ([[0.0; L]; FOLDS], through, [0.0; L]);
        for j in 0..L {
            left[j] = (1.0 - through[j]) / depth[j].max(1e-6) - through[j];
        }
        for n in 0..FOLDS {
            for j in 0..L {
                term[j] *= depth[j].max(1e-6) * PER[n];
                shares[n][j] = if n + 1 < FOLDS { term[j] } else { left[j] };
                left[j] -= term[j];
            }
        }
        let lost = through.map(|through| through - 1.0);
        Widened { aureole: self, multiples, below, share: place - below as f64, lost, shares }
    }

    /// Whether there are no peaks.
    pub(super) fn is_none(&self) -> bool {
        self.peaks.iter().all(Option::is_none)
    }
}

/// 1 / n for n = 2 and further.
const PER: [f64; FOLDS] = [1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0, 1.0 / 5.0, 1.0 / 6.0];

/// What a direction shows of the peaks of all species.
pub(super) struct Widened<'a, const L: usize> {
    aureole: &'a Aureole<L>,
    /// cos m Theta of the angle from the sun.
    multiples: [f64; MOST_DEGREE + 1],
    /// Between which tabulated angles, and the share of the second.
    below: usize,
    share: f64,
    /// e^-T - 1.
    lost: [f64; L],
    /// Of n >= 2 scatterings by peaks, over T.
    shares: [[f64; L]; FOLDS],
}

impl<const L: usize> Widened<'_, L> {
    /// What stands for the phase function of a species, given that itself, in sr^-1.
    #[inline(always)]
    pub(super) fn widen(&self, index: usize, phase: [f64; L]) -> [f64; L] {
        let mut phase = phase;
        let Some(peak) = &self.aureole.peaks[index] else { return phase };
        let mut kept = [0.0; L];
        for (cosine, row) in self.multiples.iter().zip(&peak.kept) {
            add_scaled(&mut kept, *cosine, row);
        }
        let (a, b) = (&peak.folds[self.below], &peak.folds[self.below + 1]);
        for j in 0..L {
            phase[j] += self.lost[j] * (phase[j] - kept[j]);
        }
        for (shares, (a, b)) in self.shares.iter().zip(a.iter().zip(b)) {
            let mut fold = a.map(|one| one * (1.0 - self.share));
            add_scaled(&mut fold, self.share, b);
            add_product(&mut phase, shares, &fold);
        }
        phase
    }
}

impl<const L: usize> Peak<L> {
    fn new(species: &Species<L>) -> Self {
        let straight = species.straight();
        let chi = moments(&species.phase, LAST);
        let kept = species.coefficients.len();
        let peak: Vec<[f64; L]> =
            (0..=LAST)
                .map(|l| {
                    std::array::from_fn(|j| {
                        if l < kept { 1.0 } else { (chi[l][j] / straight[j].max(1e-12)).clamp(-1.0, 1.0) }
                    })
                })
                .collect();
        let folds = vectorised::<L, _>(Convolutions { peak: &peak, straight });
        Self { folds, kept: multiples(species) }
    }
}

/// sum (1 - f) b_l P_l(cos Theta) of a species as a sum over m of factors of cos m Theta:
/// P_l(cos Theta) = sum_(k = 0)^l g_k g_(l - k) cos (l - 2k) Theta with g_k = (2k)! / (2^k k!)^2 (Abramowitz & Stegun, 22.3.13).
fn multiples<const L: usize>(species: &Species<L>) -> Vec<[f64; L]> {
    let mut factors = vec![[0.0; L]; species.coefficients.len()];
    let mut g = vec![1.0];
    for k in 1..factors.len() {
        g.push(g[k - 1] * (2 * k - 1) as f64 / (2 * k) as f64);
    }
    for (l, row) in species.coefficients.iter().enumerate() {
        for k in 0..=l {
            let factor = &mut factors[l.abs_diff(2 * k)];
            for j in 0..L {
                factor[j] += g[k] * g[l - k] * row[j] / species.whole[j];
            }
        }
    }
    factors
}

/// f Q^(*n) from the moments of Q, as work for vectors.
struct Convolutions<'a, const L: usize> {
    peak: &'a [[f64; L]],
    straight: [f64; L],
}

impl<const L: usize> NullaryFnOnce for Convolutions<'_, L> {
    type Output = Vec<[[f64; L]; FOLDS]>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let mut folds = Vec::with_capacity(STEPS + 1);
        for i in 0..=STEPS {
            let angle = PI * (i as f64 / STEPS as f64).powi(2);
            let mut sums = [[0.0; L]; FOLDS];
            for ((l, p), q) in (0..).zip(legendre(LAST, angle.cos())).zip(self.peak) {
                let weight = f64::from(2 * l + 1) * 0.25 * FRAC_1_PI * p;
                let (q, mut power) = (*q, self.straight);
                for j in 0..L {
                    power[j] *= weight * q[j];
                }
                for sum in &mut sums {
                    let mut total = *sum;
                    for j in 0..L {
                        power[j] *= q[j];
                        total[j] += power[j];
                    }
                    *sum = total;
                }
            }
            folds.push(sums);
        }
        folds
    }
}
