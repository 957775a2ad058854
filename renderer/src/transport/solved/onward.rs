//! Polarised light that particles scatter on.
//!
//! Particles scatter mostly forwards, and what goes forwards keeps its polarisation. Light whose Q and U have the form of generalised
//! spherical functions of degree l, even in the azimuth as the vector harmonics of molecules are, keeps in scattering the share
//!
//! h_l = 2 pi int [(a2 + a3)/2 d^l_22 + (a2 - a3)/2 d^l_2-2] dc,
//! d^2_22 = ((1 + c)/2)^2, d^3_22 = d^2_22 (3c - 2), d^2_2-2 = ((1 - c)/2)^2
//!
//! (Hovenier, van der Mee & Domke 2004, chapter 2 and appendix B). As delta-M does with radiance, the share o = 2 pi int (a2 + a3)/2 d^3_22 dc of Q and U, of the
//! first degree beyond those of molecules, counts as not scattered. What is left of degree 2 is exact: with the moments E_2m = M_2m - I_2m
//! of Q and U and I_2m of radiance, particles send alpha E_2m + beta I_2m where molecules send b_2 (E_2m + I_2m),
//! alpha = 5/(24 pi) (h_2 - o), beta = -(5/8) int b1 (1 - c^2) dc. Higher degrees are lost, and so is what turns Q and U into radiance.

use super::Optics;
use super::depths::{Along, Depths};
use super::line::Take;
use super::species::Species;
use crate::atmosphere::{GAUSS_4, Medium, MediumError};
use crate::geometry::{Place, Shape};
use crate::phase::Phase;
use crate::vectors::exp_minus;
use glam::DVec3;
use std::f64::consts::PI;

/// A share less than this is none.
const LEAST: f64 = 1e-3;

/// What is scattered on.
#[derive(Debug)]
pub(super) struct Onward<const L: usize> {
    depths: Depths<L>,
    /// alpha and beta of each species.
    kernels: Vec<[[f64; L]; 2]>,
    /// alpha where nothing but the peak counts as not scattered: 5/(24 pi) h_2.
    full: Vec<[f64; L]>,
}

/// A line through it.
pub(super) struct Ahead<'a, const L: usize>(Along<'a, L>);

impl<const L: usize> Onward<L> {
    /// Of no species.
    pub(super) fn none() -> Self {
        Self { depths: Depths::none(), kernels: Vec::new(), full: Vec::new() }
    }

    /// Of the species of a medium from which peaks were cut: those go on already.
    pub(super) fn new(species: &[Species<L>], medium: &Medium<L>, shape: Shape) -> Result<Self, MediumError> {
        let (mut all, mut scattered) = (Self::none(), Vec::new());
        for one in species {
            if one.is_molecular() {
                all.kernels.push([one.coefficients[2]; 2]);
                all.full.push(one.coefficients[2]);
                continue;
            }
            let ([ahead, second, natural], straight) = (integrals(&one.phase), one.straight());
            let left =
                |share: [f64; L]| -> [f64; L] { std::array::from_fn(|j| (share[j] - straight[j]) * one.whole[j]) };
            let (on, second) = (left(ahead).map(|share| share.clamp(0.0, 1.0)), left(second));
            let alpha = |share: f64, j: usize| 5.0 / (24.0 * PI) * share * f64::from(natural[j] != 0.0);
            all.full.push(std::array::from_fn(|j| alpha(second[j], j)));
            all.kernels.push([
                std::array::from_fn(|j| alpha(second[j] - on[j], j)),
                std::array::from_fn(|j| -0.625 * natural[j] * one.whole[j]),
            ]);
            if on.iter().any(|&share| share > LEAST) {
                scattered.push((one, std::array::from_fn(|j| on[j] * one.scattering[j])));
            }
        }
        all.depths = Depths::new(&scattered, medium, shape)?;
        Ok(all)
    }

    /// What it says of places, without lines.
    pub(super) fn of_places(&self) -> Self {
        Self { depths: Depths::none(), kernels: self.kernels.clone(), full: self.full.clone() }
    }

    /// Sums over the species of their scattering coefficients times alpha and beta, with nothing of Q and U but the peak for not
    /// scattered.
    #[inline(always)]
    pub(super) fn scattered(&self, scattering: &[[f64; L]]) -> [[f64; L]; 2] {
        let mut sums = [[0.0; L]; 2];
        for (([_, beta], alpha), scattering) in self.kernels.iter().zip(&self.full).zip(scattering) {
            for j in 0..L {
                sums[0][j] += alpha[j] * scattering[j];
                sums[1][j] += beta[j] * scattering[j];
            }
        }
        sums
    }

    #[inline(always)]
    pub(super) fn along(&self, from: Place, direction: DVec3) -> Ahead<'_, L> {
        Ahead(self.depths.along(from, direction))
    }
}

impl<const L: usize> Ahead<'_, L> {
    /// What of Q and U arrives from a point of the line, over what of radiance does.
    #[inline(always)]
    pub(super) fn more(&self, s: f64) -> [f64; L] {
        // It is more by what counts as not scattered: exp(+depth).
        let mut depth = self.0.before(s);
        for one in &mut depth {
            *one = -*one;
        }
        exp_minus(depth)
    }
}

/// o, h_2 and int b1 (1 - c^2) dc at every wavelength; without a matrix 0.
fn integrals<const L: usize>(phase: &Phase<L>) -> [[f64; L]; 3] {
    let mut sums = [[0.0; L]; 3];
    let Phase::Tabulated(table) = phase else { return sums };
    for ends in table.cosines().windows(2) {
        let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
        for (x, weight) in GAUSS_4 {
            let (c, weight) = (middle + half * x, weight * half);
            let (on, back) = (0.25 * (1.0 + c) * (1.0 + c), 0.25 * (1.0 - c) * (1.0 - c));
            for (j, matrix) in phase.matrices(c).into_iter().enumerate() {
                let (same, other) = (PI * weight * (matrix.a2 + matrix.a3), PI * weight * (matrix.a2 - matrix.a3));
                sums[0][j] += same * on * (3.0 * c - 2.0);
                sums[1][j] += same * on + other * back;
                sums[2][j] += weight * matrix.b1 * (1.0 - c * c);
            }
        }
    }
    sums
}

/// Gives on what is scattered as it counts for Q and U: times alpha, and times beta.
pub(super) struct Dipoles<'a, T, const L: usize> {
    pub(super) to: T,
    pub(super) optics: &'a Optics<L>,
    pub(super) ahead: &'a Ahead<'a, L>,
}

impl<T: Take<L>, const L: usize> Take<L> for Dipoles<'_, T, L> {
    #[inline(always)]
    fn take(&mut self, s: f64, scattered: &[[f64; L]]) {
        let mut sums = [[0.0; L]; 2];
        for (kernels, scattered) in self.optics.onward.kernels.iter().zip(scattered) {
            for (sum, kernel) in sums.iter_mut().zip(kernels) {
                for j in 0..L {
                    sum[j] += kernel[j] * scattered[j];
                }
            }
        }
        let more = self.ahead.more(s);
        for sum in &mut sums {
            for j in 0..L {
                sum[j] *= more[j];
            }
        }
        self.to.take(s, &sums);
    }
}
