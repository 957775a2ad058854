//! Scattering by the mixture of species at a point.

use super::carried::Carried;
use super::radiation::{Linear, Radiation};
use crate::atmosphere::{Component, Local, MAX_COMPONENTS, Medium};
use crate::phase::Phase;
use crate::sampling::around;
use glam::DVec3;

/// What scattering by each species makes of natural light at one angle, in sr^-1, times their scattering cross-sections: along a
/// line the angle to the sun does not change.
pub(super) struct Towards<R: Radiation, const L: usize> {
    parts: [[R::Natural; L]; MAX_COMPONENTS],
    count: usize,
}

impl<R: Radiation, const L: usize> Towards<R, L> {
    /// For the scattering angle of that cosine.
    #[inline]
    pub(super) fn new(medium: &Medium<L>, cosine: f64) -> Self {
        let mut parts = [[R::Natural::default(); L]; MAX_COMPONENTS];
        for (part, component) in parts.iter_mut().zip(medium.components()) {
            if component.scatters() {
                let phase = R::natural(&component.phase, cosine);
                for ((part, &sigma), phase) in part.iter_mut().zip(&component.scattering).zip(phase) {
                    *part = phase * sigma;
                }
            }
        }
        Self { parts, count: medium.components().len() }
    }

    /// Scattering coefficient times what scattering by the mixture makes of natural light, in m^-1 sr^-1.
    #[inline]
    pub(super) fn at(&self, local: &Local<L>) -> [R::Natural; L] {
        let mut sum = [R::Natural::default(); L];
        for (part, density) in self.parts[..self.count].iter().zip(local.densities) {
            for (sum, &part) in sum.iter_mut().zip(part) {
                *sum = *sum + part * density;
            }
        }
        sum
    }
}

/// Matrix of scattering of the mixture at a point in sr^-1: sum_s sigma_s P_s(c) / sum_s sigma_s over the scattering species.
#[inline]
fn mixture<R: Radiation, const L: usize>(medium: &Medium<L>, local: &Local<L>, cosine: f64) -> [R::Matrix; L] {
    let mut sum = [R::Matrix::default(); L];
    for (component, density) in medium.components().iter().zip(local.densities) {
        if component.scatters() {
            let matrices = R::matrices(&component.phase, cosine);
            for ((sum, matrix), &sigma) in sum.iter_mut().zip(matrices).zip(&component.scattering) {
                *sum = *sum + matrix * (sigma * density);
            }
        }
    }
    for (sum, scattering) in sum.iter_mut().zip(local.scattering) {
        *sum = *sum * if scattering > 0.0 { scattering.recip() } else { 0.0 };
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
pub(super) fn scatter_with_lobe<R: Radiation, const L: usize>(
    medium: &Medium<L>,
    local: &Local<L>,
    hero: usize,
    direction: DVec3,
    lobe: Lobe,
    carried: &mut Carried<R, L>,
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
    let matrices = mixture::<R, L>(medium, local, direction.dot(scattered).clamp(-1.0, 1.0));
    let tried = shape.value(0, lobe.axis.dot(scattered).clamp(-1.0, 1.0));
    let density = |j: usize| Lobe::SHARE * tried + (1.0 - Lobe::SHARE) * matrices[j].intensity();
    let drawn = density(hero);
    if drawn <= 0.0 {
        return None;
    }
    carried.scatter(direction, scattered, &matrices, density, drawn);
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
/// direction is the phase function of the hero's mixture; other wavelengths get the ratio of theirs
/// to it, and contributions the matrix of each over it. `None` where rounding has drawn an angle of no density.
#[inline]
pub(super) fn scatter<R: Radiation, const L: usize>(
    medium: &Medium<L>,
    local: &Local<L>,
    hero: usize,
    direction: DVec3,
    carried: &mut Carried<R, L>,
    [u, turn]: [f64; 2],
) -> Option<DVec3> {
    let (component, rest) = choose(medium, local, hero, u)?;
    let sample = component.phase.sample(hero, rest);
    let matrices = mixture::<R, L>(medium, local, sample.cosine);
    let drawn = matrices[hero].intensity();
    if drawn <= 0.0 {
        return None;
    }
    let scattered = around(direction, sample.cosine, turn);
    carried.scatter(direction, scattered, &matrices, |j| matrices[j].intensity(), drawn);
    Some(scattered)
}
