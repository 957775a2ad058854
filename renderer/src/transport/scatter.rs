//! Scattering by the mixture of species at a point.

use super::carried::Carried;
use crate::atmosphere::{Component, Local, MAX_COMPONENTS, Medium};
use crate::phase::Phase;
use crate::sampling::around;
use glam::DVec3;

/// Phase functions in sr^-1 of all species for one angle, times their scattering cross-sections: along a line the
/// angle to the sun does not change.
pub(super) struct Towards<const L: usize> {
    parts: [[f64; L]; MAX_COMPONENTS],
    count: usize,
}

impl<const L: usize> Towards<L> {
    /// For the scattering angle of that cosine.
    #[inline]
    pub(super) fn new(medium: &Medium<L>, cosine: f64) -> Self {
        let mut parts = [[0.0; L]; MAX_COMPONENTS];
        for (part, component) in parts.iter_mut().zip(medium.components()) {
            if component.scatters() {
                let phase = component.phase.values(cosine);
                for ((part, sigma), phase) in part.iter_mut().zip(&component.scattering).zip(phase) {
                    *part = sigma * phase;
                }
            }
        }
        Self { parts, count: medium.components().len() }
    }

    /// Scattering coefficient times the phase function of the mixture in m^-1 sr^-1.
    #[inline]
    pub(super) fn at(&self, local: &Local<L>) -> [f64; L] {
        let mut sum = [0.0; L];
        for (part, density) in self.parts[..self.count].iter().zip(local.densities) {
            for (sum, part) in sum.iter_mut().zip(part) {
                *sum += density * part;
            }
        }
        sum
    }
}

/// Phase function of the mixture at a point in sr^-1: sum_s sigma_s p_s(c) / sum_s sigma_s over the scattering species.
#[inline]
pub(super) fn mixture<const L: usize>(medium: &Medium<L>, local: &Local<L>, cosine: f64) -> [f64; L] {
    let mut sum = Towards::new(medium, cosine).at(local);
    for (sum, scattering) in sum.iter_mut().zip(local.scattering) {
        *sum = if scattering > 0.0 { *sum / scattering } else { 0.0 };
    }
    sum
}

/// A lobe of directions that is tried beside the phase function: a Henyey-Greenstein function of g = `asymmetry` about the
/// unit vector `axis`, with probability [`Lobe::SHARE`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Lobe {
    pub(super) axis: DVec3,
}

impl Lobe {
    const SHARE: f64 = 0.4;
    const ASYMMETRY: f64 = 0.7;

    fn shape<const L: usize>() -> Phase<L> {
        Phase::HenyeyGreenstein { g: [Self::ASYMMETRY; L] }
    }
}

/// As [`scatter`], but a direction is drawn from the lobe with its share; both densities count, whichever drew it.
#[inline]
pub(super) fn scatter_with_lobe<const L: usize>(
    medium: &Medium<L>,
    local: &Local<L>,
    hero: usize,
    direction: DVec3,
    lobe: Lobe,
    carried: &mut Carried<L>,
    [u, turn]: [f64; 2],
) -> Option<DVec3> {
    let shape = Lobe::shape::<1>();
    let scattered = if u < Lobe::SHARE {
        around(lobe.axis, shape.sample(0, u / Lobe::SHARE).cosine, turn)
    } else {
        let rest = (u - Lobe::SHARE) / (1.0 - Lobe::SHARE);
        let (component, rest) = choose(medium, local, hero, rest)?;
        around(direction, component.phase.sample(hero, rest).cosine, turn)
    };
    let phase = mixture(medium, local, direction.dot(scattered).clamp(-1.0, 1.0));
    let tried = shape.value(0, lobe.axis.dot(scattered).clamp(-1.0, 1.0));
    let density = phase.map(|phase| Lobe::SHARE * tried + (1.0 - Lobe::SHARE) * phase);
    if density[hero] <= 0.0 {
        return None;
    }
    carried.multiply(|j| phase[j] / density[hero], |j| density[j] / density[hero]);
    Some(scattered)
}

/// A species by the hero's coefficients, and what is left of the random number.
#[inline]
fn choose<'a, const L: usize>(
    medium: &'a Medium<L>,
    local: &Local<L>,
    hero: usize,
    u: f64,
) -> Option<(&'a Component<L>, f64)> {
    let mut choice = u * local.scattering[hero];
    let mut chosen = None;
    for (component, density) in medium.components().iter().zip(local.densities) {
        let share = density * component.scattering[hero];
        if share > 0.0 {
            chosen = Some((component, (choice / share).clamp(0.0, 1.0 - f64::EPSILON)));
            choice -= share;
            if choice < 0.0 {
                break;
            }
        }
    }
    chosen
}

/// Draws the direction after a scattering: a species by the hero's coefficients, an angle by its phase function. `u` in
/// [0, 1) chooses the species and, stretched, the angle; `turn` the azimuth. The density of the
/// direction is the hero's mixture, which is its phase function too; other wavelengths get the ratio of theirs
/// to it, in contribution and density alike. `None` where rounding has drawn an angle of no density.
#[inline]
pub(super) fn scatter<const L: usize>(
    medium: &Medium<L>,
    local: &Local<L>,
    hero: usize,
    direction: DVec3,
    carried: &mut Carried<L>,
    [u, turn]: [f64; 2],
) -> Option<DVec3> {
    let (component, rest) = choose(medium, local, hero, u)?;
    let sample = component.phase.sample(hero, rest);
    let phase = mixture(medium, local, sample.cosine);
    if phase[hero] <= 0.0 {
        return None;
    }
    carried.multiply_both(|j| phase[j] / phase[hero]);
    Some(around(direction, sample.cosine, turn))
}
