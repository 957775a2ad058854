//! The brute-force judge: analog free flights by delta tracking, next-event estimation to the sun by ratio tracking,
//! Russian roulette. It knows no table of columns.

use super::Problem;
use super::carried::{Carried, SURVIVAL};
use super::radiation::Radiation;
use super::ratio::{self, exponential};
use super::scatter::{Towards, scatter};
use crate::atmosphere::Local;
use crate::geometry::{End, Place, Ray, Segment};
use crate::sampling::{Sampler, cosine_hemisphere};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// What is seen along one path, in `frame`.
pub(super) fn trace<R: Radiation, const L: usize>(
    problem: &Problem<'_, L>,
    from: Place,
    (direction, frame): (DVec3, R::Frame),
    hero: usize,
    sampler: &mut Sampler,
) -> [R::Seen; L] {
    let medium = problem.medium;
    let mut sum = [R::Seen::default(); L];
    let mut carried = Carried::<R, L>::new(frame);
    let (mut place, mut direction) = (from, direction);
    let mut segments = Vec::with_capacity(2 * medium.shells().len());
    let mut first_weight = None;
    let mut order = 0_u32;
    while problem.max_orders.is_none_or(|most| order < most) {
        order += 1;
        sampler.go_to(2 * order);
        let ray = Ray::new(problem.shape, place, direction);
        let end = ray.segments(medium.bounds(), &mut segments);
        let track = Track { ray, segments: &segments, end };
        match fly(problem, &track, hero, &mut carried, &mut sum, sampler) {
            Outcome::Lost => break,
            Outcome::Air(t, local) => {
                place = place.advance(problem.shape, direction, t);
                place.altitude_m = place.altitude_m.clamp(0.0, medium.top_m());
                if let Some((sun, light)) = sunlight(problem, place, &mut segments, sampler) {
                    let scattered = Towards::<R, L>::new(medium, direction.dot(sun)).at(&local);
                    let turn = carried.turn(direction, sun);
                    carried.score_scattered(&mut sum, turn, &scattered, |j| {
                        if local.scattering[j] > 0.0 { light[j] / local.scattering[j] } else { 0.0 }
                    });
                }
                match scatter(medium, &local, hero, direction, &mut carried, sampler.uniform_2d()) {
                    Some(scattered) => direction = scattered,
                    None => break,
                }
            }
            Outcome::Ground(t) => {
                place = place.advance(problem.shape, direction, t);
                place.altitude_m = 0.0;
                carried.reflect(&problem.albedo_at(place));
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

/// A ray with its parts in the shells of the medium and its end.
struct Track<'a> {
    ray: Ray,
    segments: &'a [Segment],
    end: End,
}

/// Where a flight ended; [`Carried`] has its weights.
enum Outcome<const L: usize> {
    /// A collision in the air at a distance in m, with the coefficients there.
    Air(f64, Box<Local<L>>),
    /// The ground at a distance in m.
    Ground(f64),
    /// Absorbed, or gone to space.
    Lost,
}

/// Delta tracking (Woodcock 1965; Coleman 1968): tentative collisions at the
/// rate of the hero's majorant, each scattering, absorbing or null with the
/// hero's probabilities.
///
/// Between tentative collisions the density and the contribution of wavelength
/// j share the factor exp(-majorant_j x distance). A scattering multiplies
/// both by sigma_s,j, a null collision both by majorant_j - sigma_t,j; so f_j and r_j
/// stay equal as long as the path flies.
fn fly<R: Radiation, const L: usize>(
    problem: &Problem<'_, L>,
    track: &Track<'_>,
    hero: usize,
    carried: &mut Carried<R, L>,
    escaped: &mut [R::Seen; L],
    sampler: &mut Sampler,
) -> Outcome<L> {
    let mut depth = [0.0; L];
    let mut factor = [1.0; L];
    let mut ahead = exponential(sampler);
    for &Segment { layer, start_m, end_m } in track.segments {
        let majorant = &problem.medium.shells()[layer].majorant;
        let mut at = start_m;
        while ahead < majorant[hero] * (end_m - at) {
            let step = ahead / majorant[hero];
            at += step;
            for (depth, majorant) in depth.iter_mut().zip(majorant) {
                *depth += majorant * step;
            }
            let local = problem.medium.local(layer, track.ray.altitude_m(at));
            let (scattering, extinction) = (local.scattering[hero], local.extinction[hero]);
            let choice = sampler.uniform() * majorant[hero];
            if choice < scattering {
                carried
                    .multiply_both(|j| factor[j] * (depth[hero] - depth[j]).exp() * local.scattering[j] / scattering);
                return Outcome::Air(at, Box::new(local));
            }
            if choice < extinction {
                return Outcome::Lost;
            }
            let null = majorant[hero] - extinction;
            for (j, factor) in factor.iter_mut().enumerate() {
                *factor *= (majorant[j] - local.extinction[j]).max(0.0) / null;
            }
            ahead = exponential(sampler);
        }
        ahead -= majorant[hero] * (end_m - at);
        for (depth, majorant) in depth.iter_mut().zip(majorant) {
            *depth += majorant * (end_m - at);
        }
    }
    carried.multiply_both(|j| factor[j] * (depth[hero] - depth[j]).exp());
    match track.end {
        End::Ground(t) => Outcome::Ground(t),
        End::Space => {
            if let Some(environment) = problem.environment {
                carried.score(escaped, |j| environment[j]);
            }
            Outcome::Lost
        }
    }
}
