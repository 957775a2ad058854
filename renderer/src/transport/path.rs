//! A path: flights, next-event estimation to the sun, scattering, reflection,
//! Russian roulette.

use super::Problem;
use super::carried::Carried;
use super::flight::{Flight, Outcome, Track};
use super::ratio;
use crate::atmosphere::{Local, Medium};
use crate::geometry::{End, Place, Ray, Segment};
use crate::sampling::{Sampler, around, cosine_hemisphere};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// After the first vertex a path lives on with this probability times its
/// weight over the weight at the first vertex, at most 1. The figure balances
/// the variance of the later orders against their cost.
const SURVIVAL: f64 = 4.0;

/// Radiance along one path whose flights `fly` draws.
pub(super) fn trace<const L: usize>(
    problem: &Problem<'_, L>,
    from: Place,
    direction: DVec3,
    hero: usize,
    sampler: &mut Sampler,
    fly: Flight<L>,
) -> [f64; L] {
    let medium = problem.medium;
    let mut sum = [0.0; L];
    let mut carried = Carried::new();
    let (mut place, mut direction) = (from, direction);
    let mut segments = Vec::with_capacity(2 * medium.shells().len());
    let mut first_weight = None;
    let mut order = 0_u32;
    while problem.max_orders.is_none_or(|most| order < most) {
        order += 1;
        let ray = Ray::new(problem.shape, place, direction);
        let end = ray.segments(medium.bounds(), &mut segments);
        let track = Track { ray, segments: &segments, end };
        match fly(problem, &track, hero, &mut carried, &mut sum, sampler) {
            Outcome::Lost => break,
            Outcome::Air(t, local) => {
                place = place.advance(problem.shape, direction, t);
                place.altitude_m = place.altitude_m.clamp(0.0, medium.top_m());
                if let Some((sun, light)) = sunlight(problem, place, &mut segments, sampler) {
                    let phase = mixture(medium, &local, direction.dot(sun));
                    carried.score(&mut sum, |j| phase[j] * light[j]);
                }
                match scatter(medium, &local, hero, direction, &mut carried, sampler) {
                    Some(scattered) => direction = scattered,
                    None => break,
                }
            }
            Outcome::Ground(t) => {
                place = place.advance(problem.shape, direction, t);
                place.altitude_m = 0.0;
                carried.multiply(|j| problem.albedo[j], |_| 1.0);
                if let Some((sun, light)) = sunlight(problem, place, &mut segments, sampler) {
                    let cosine = place.up.dot(sun).max(0.0);
                    carried.score(&mut sum, |j| FRAC_1_PI * cosine * light[j]);
                }
                direction = cosine_hemisphere(place.up, sampler.uniform_2d());
            }
        }
        let weight = carried.weight();
        if weight <= 0.0 {
            break;
        }
        let first = *first_weight.get_or_insert(weight);
        let survival = SURVIVAL * weight / first;
        if survival < 1.0 {
            if sampler.uniform() >= survival {
                break;
            }
            carried.multiply(|_| 1.0 / survival, |_| 1.0);
        }
    }
    sum
}

/// A direction to a point of the sun's disc and the light from it at each
/// wavelength: limb darkening over its mean, times a ratio-tracked
/// transmittance. `None` if there is no sun or the planet is in the way.
fn sunlight<const L: usize>(
    problem: &Problem<'_, L>,
    place: Place,
    segments: &mut Vec<Segment>,
    sampler: &mut Sampler,
) -> Option<(DVec3, [f64; L])> {
    let (sun, limb) = problem.sun?.sample(sampler.uniform_2d());
    let ray = Ray::new(problem.shape, place, sun);
    match ray.segments(problem.medium.bounds(), segments) {
        End::Ground(_) => None,
        End::Space => {
            let through = ratio::transmittance(problem.medium, &ray, segments, f64::INFINITY, sampler);
            Some((sun, std::array::from_fn(|j| limb[j] * through[j])))
        }
    }
}

/// Phase function of the mixture at a point in sr^-1:
/// sum_s sigma_s p_s(c) / sum_s sigma_s over the scattering species.
fn mixture<const L: usize>(medium: &Medium<L>, local: &Local<L>, cosine: f64) -> [f64; L] {
    let mut sum = [0.0; L];
    for (component, density) in scatterers(medium, local) {
        let phase = component.phase.values(cosine);
        for (j, sum) in sum.iter_mut().enumerate() {
            *sum += density * component.scattering[j] * phase[j];
        }
    }
    for (sum, scattering) in sum.iter_mut().zip(local.scattering) {
        *sum = if scattering > 0.0 { *sum / scattering } else { 0.0 };
    }
    sum
}

fn scatterers<'a, const L: usize>(
    medium: &'a Medium<L>,
    local: &'a Local<L>,
) -> impl Iterator<Item = (&'a crate::atmosphere::Component<L>, f64)> {
    medium
        .components()
        .iter()
        .zip(local.densities)
        .filter(|(component, density)| *density > 0.0 && component.scattering.iter().any(|&s| s > 0.0))
}

/// Draws the direction after a scattering: a species by the hero's
/// coefficients, an angle by its phase function. The density of the direction
/// is the hero's mixture, which is its phase function too; other wavelengths
/// get the ratio of theirs to it, in contribution and density alike. `None` where
/// rounding has drawn an angle of no density.
fn scatter<const L: usize>(
    medium: &Medium<L>,
    local: &Local<L>,
    hero: usize,
    direction: DVec3,
    carried: &mut Carried<L>,
    sampler: &mut Sampler,
) -> Option<DVec3> {
    let mut choice = sampler.uniform() * local.scattering[hero];
    let [u, turn] = sampler.uniform_2d();
    let mut chosen = None;
    for (component, density) in scatterers(medium, local) {
        chosen = Some(component);
        choice -= density * component.scattering[hero];
        if choice < 0.0 {
            break;
        }
    }
    let sample = chosen?.phase.sample(hero, u);
    let phase = mixture(medium, local, sample.cosine);
    if phase[hero] <= 0.0 {
        return None;
    }
    carried.multiply_both(|j| phase[j] / phase[hero]);
    Some(around(direction, sample.cosine, turn))
}
