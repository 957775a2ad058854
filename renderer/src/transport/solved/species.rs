//! What scatters, prepared for moments: Legendre coefficients with the forward peak cut off.
//!
//! A phase function is P(c) = sum_l b_l P_l(c), b_l = (2l + 1) / (4 pi) chi_l with chi_0 = 1. Of one that has more moments
//! than the table keeps, the share f = chi_(degree + 1) is taken for light that goes straight on (the delta-M method,
//! Wiscombe 1977): chi'_l = (chi_l - f) / (1 - f), and of the scattering cross-section 1 - f is left.

use crate::atmosphere::{Component, GAUSS_4, Medium, MediumError};
use crate::phase::{Phase, Tabulated};
use crate::vectors::vectorised;
use pulp::NullaryFnOnce;
use std::f64::consts::{FRAC_1_PI, PI};

/// A component that scatters.
#[derive(Debug, Clone)]
pub(super) struct Species<const L: usize> {
    /// Which component of the medium.
    pub(super) component: usize,
    /// Scattering cross-section that is left.
    pub(super) scattering: [f64; L],
    /// b_l for l = 0 ..= degree, in sr^-1.
    pub(super) coefficients: Vec<[f64; L]>,
    /// 1 / (1 - f).
    pub(super) whole: [f64; L],
    /// The phase function itself.
    pub(super) phase: Phase<L>,
}

impl<const L: usize> Species<L> {
    /// Whether degrees above 2 count.
    pub(super) fn is_molecular(&self) -> bool {
        matches!(self.phase, Phase::Rayleigh { .. })
    }

    /// f, the share of scattered light that goes straight on.
    pub(super) fn straight(&self) -> [f64; L] {
        self.whole.map(|whole| 1.0 - 1.0 / whole)
    }
}

/// Degrees that the components need: 2 for molecules alone, else `degree`.
pub(super) fn degree_of<const L: usize>(medium: &Medium<L>, degree: usize) -> usize {
    let peaked = |c: &Component<L>| c.scatters() && !matches!(c.phase, Phase::Rayleigh { .. });
    if medium.components().iter().any(peaked) { degree } else { 2 }
}

/// The scatterers of a medium with nothing cut off, for single scattering: without coefficients.
pub(super) fn whole<const L: usize>(medium: &Medium<L>) -> Vec<Species<L>> {
    let scatterers = medium.components().iter().enumerate().filter(|(_, c)| c.scatters());
    let species = scatterers.map(|(component, c)| Species {
        component,
        scattering: c.scattering,
        coefficients: Vec::new(),
        whole: [1.0; L],
        phase: c.phase.clone(),
    });
    species.collect()
}

/// The scatterers of a medium, and the medium in which the light that they send straight on is not scattered.
pub(super) fn scaled<const L: usize>(
    medium: &Medium<L>,
    degree: usize,
) -> Result<(Vec<Species<L>>, Medium<L>), MediumError> {
    let mut all = Vec::new();
    let mut components = medium.components().to_vec();
    for (index, component) in components.iter_mut().enumerate().filter(|(_, c)| c.scatters()) {
        let chi = moments(&component.phase, degree + 1);
        let straight: [f64; L] = chi[degree + 1].map(|f| f.clamp(0.0, 0.99));
        let coefficients = (0..=degree).map(|l| {
            let weight = (2.0 * l as f64 + 1.0) * 0.25 * FRAC_1_PI;
            std::array::from_fn(|j| weight * (chi[l][j] - straight[j]) / (1.0 - straight[j]))
        });
        for (sigma, f) in component.scattering.iter_mut().zip(straight) {
            *sigma *= 1.0 - f;
        }
        all.push(Species {
            component: index,
            scattering: component.scattering,
            coefficients: coefficients.collect(),
            whole: straight.map(|f| 1.0 / (1.0 - f)),
            phase: component.phase.clone(),
        });
    }
    Ok((all, Medium::new(components, medium.top_m())?))
}

/// chi_l = 2 pi int P(c) P_l(c) dc for l = 0 ..= `last`.
pub(super) fn moments<const L: usize>(phase: &Phase<L>, last: usize) -> Vec<[f64; L]> {
    match phase {
        Phase::Rayleigh { gamma } => {
            let mut chi = vec![[0.0; L]; last + 1];
            chi[0] = [1.0; L];
            // 4 pi / 5 of the coefficient (1 - gamma) / (8 pi (1 + 2 gamma)) of P_2.
            chi[2] = gamma.map(|gamma| (1.0 - gamma) / (10.0 * (1.0 + 2.0 * gamma)));
            chi
        }
        Phase::HenyeyGreenstein { g } => (0..=last).map(|l| g.map(|g| g.powi(l as i32))).collect(),
        Phase::Tabulated(table) => vectorised::<L, _>(Tabulation { table, phase, last }),
    }
}

/// The moments of a tabulated phase function, as work for vectors.
struct Tabulation<'a, const L: usize> {
    table: &'a Tabulated<L>,
    phase: &'a Phase<L>,
    last: usize,
}

impl<const L: usize> NullaryFnOnce for Tabulation<'_, L> {
    type Output = Vec<[f64; L]>;

    /// Between two nodes the phase function is a line: the rule is exact for degrees up to 6, and the nodes lie far closer than a
    /// polynomial of these degrees bends.
    #[inline(always)]
    fn call(self) -> Vec<[f64; L]> {
        // P_l = (2 - 1/l) c P_(l-1) - (1 - 1/l) P_(l-2).
        let shares: Vec<f64> = (0..=self.last).map(|l| 1.0 / (l as f64).max(1.0)).collect();
        let mut chi = vec![[0.0; L]; self.last + 1];
        for ends in self.table.cosines().windows(2) {
            let (middle, half) = (0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0]));
            let cosines = GAUSS_4.map(|(x, _)| middle + half * x);
            let mut values = [[0.0; L]; 4];
            for k in 0..4 {
                values[k] = self.phase.values(cosines[k]).map(|value| 2.0 * PI * GAUSS_4[k].1 * half * value);
            }
            let (mut before, mut legendre) = ([0.0; 4], [1.0; 4]);
            for (l, (chi, share)) in chi.iter_mut().zip(&shares).enumerate() {
                if l > 0 {
                    for k in 0..4 {
                        let next = (2.0 - share) * cosines[k] * legendre[k] - (1.0 - share) * before[k];
                        (before[k], legendre[k]) = (legendre[k], next);
                    }
                }
                let mut sum = *chi;
                for k in 0..4 {
                    for j in 0..L {
                        sum[j] += legendre[k] * values[k][j];
                    }
                }
                *chi = sum;
            }
        }
        chi
    }
}

#[cfg(test)]
mod tests {
    use super::super::harmonics::legendre;
    use super::*;
    use std::sync::Arc;

    #[test]
    fn moments_give_the_phase_function_back() {
        let rayleigh = Phase::Rayleigh { gamma: [0.02] };
        let g = 0.5;
        let haze = Phase::HenyeyGreenstein { g: [g] };
        for (phase, degree, tolerance) in [(rayleigh, 2, 1e-15), (haze, 40, 1e-10)] {
            let chi = moments::<1>(&phase, degree);
            for c in [-1.0, -0.3, 0.2, 0.9, 1.0] {
                let sum: f64 = (0..)
                    .zip(legendre(degree, c))
                    .zip(&chi)
                    .map(|((l, p), chi)| (2.0 * f64::from(l) + 1.0) / (4.0 * PI) * chi[0] * p)
                    .sum();
                // The series of Henyey and Greenstein goes on with 81 g^41.
                assert!((sum - phase.value(0, c)).abs() < tolerance, "{sum}, {}", phase.value(0, c));
            }
        }
    }

    #[test]
    fn a_table_has_the_moments_of_what_it_tabulates() {
        let haze = Phase::HenyeyGreenstein { g: [0.5] };
        let cosines: Vec<f64> = (0..=4000).map(|i| -(PI * f64::from(i) / 4000.0).cos()).collect();
        let values = cosines.iter().map(|&c| haze.values(c)).collect();
        let table = Phase::Tabulated(Arc::new(Tabulated::new(cosines, values).expect("sound")));
        for (l, (a, b)) in moments::<1>(&table, 12).iter().zip(moments::<1>(&haze, 12)).enumerate() {
            // Chords instead of the curve, at steps of 0.0008.
            assert!((a[0] - b[0]).abs() < 1e-6, "moment {l}: {a:?}, {b:?}");
        }
    }
}
