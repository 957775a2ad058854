//! Free flights: from a vertex to the next one, in the air or on the ground.

use super::Problem;
use super::carried::Carried;
use super::ratio::{self, exponential};
use crate::atmosphere::Local;
use crate::geometry::{End, Ray, Segment};
use crate::sampling::Sampler;

/// A ray with its parts in the shells of the medium and its end.
pub(super) struct Track<'a> {
    pub(super) ray: Ray,
    pub(super) segments: &'a [Segment],
    pub(super) end: End,
}

/// Where a flight ended; [`Carried`] has its weights.
pub(super) enum Outcome<const L: usize> {
    /// A collision in the air at a distance in m, with the coefficients there.
    Air(f64, Box<Local<L>>),
    /// The ground at a distance in m.
    Ground(f64),
    /// Absorbed, or gone to space.
    Lost,
}

/// A rule that draws the end of a flight and multiplies what the path carries.
pub(super) type Flight<const L: usize> =
    fn(&Problem<'_, L>, &Track<'_>, usize, &mut Carried<L>, &mut [f64; L], &mut Sampler) -> Outcome<L>;

/// Delta tracking (Woodcock 1965; Coleman 1968): tentative collisions at the
/// rate of the hero's majorant, each scattering, absorbing or null with the
/// hero's probabilities.
///
/// Between tentative collisions the density and the contribution of wavelength
/// j share the factor exp(-majorant_j x distance). A scattering multiplies
/// both by sigma_s,j, a null collision both by majorant_j - sigma_t,j; so f_j and r_j
/// stay equal as long as the path flies.
pub(super) fn delta<const L: usize>(
    problem: &Problem<'_, L>,
    track: &Track<'_>,
    hero: usize,
    carried: &mut Carried<L>,
    escaped: &mut [f64; L],
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

/// The least and largest probability with which a flight towards a reflecting
/// ground is made to end in the air.
const AIR_OR_GROUND: (f64, f64) = (0.1, 0.9);

/// A flight that always counts: towards space it ends in the air; towards the ground it
/// ends in the air with the probability that the majorant says, kept
/// within [`AIR_OR_GROUND`], or on the ground (always in the air if the ground is black).
///
/// In the air the distance has the density
/// m_j(t) exp(-M_j(t)) / (1 - exp(-M_j)), m_j the majorant and M_j(t) its optical
/// depth, inverted for the hero; the contribution is
/// sigma_s,j(t) T_j(t) with the transmittance T_j by ratio tracking. Light from the
/// environment is scored on the way.
pub(super) fn forced<const L: usize>(
    problem: &Problem<'_, L>,
    track: &Track<'_>,
    hero: usize,
    carried: &mut Carried<L>,
    escaped: &mut [f64; L],
    sampler: &mut Sampler,
) -> Outcome<L> {
    let shells = problem.medium.shells();
    let total = optical_depth(problem, track.segments, f64::INFINITY);
    let collision = total.map(|depth| -(-depth).exp_m1());
    let mut probability = [1.0; L];
    match track.end {
        End::Space => {
            if let Some(environment) = problem.environment {
                let through = ratio::transmittance(problem.medium, &track.ray, track.segments, f64::INFINITY, sampler);
                carried.score(escaped, |j| environment[j] * through[j]);
            }
        }
        End::Ground(t) => {
            if problem.albedo.iter().any(|&albedo| albedo > 0.0) {
                probability = collision.map(|p| p.clamp(AIR_OR_GROUND.0, AIR_OR_GROUND.1));
                if total[hero] == 0.0 || sampler.uniform() >= probability[hero] {
                    let of_ground = |p: f64, depth: f64| if depth == 0.0 { 1.0 } else { 1.0 - p };
                    let chosen = of_ground(probability[hero], total[hero]);
                    let through = ratio::transmittance(problem.medium, &track.ray, track.segments, t, sampler);
                    carried.multiply(|j| through[j] / chosen, |j| of_ground(probability[j], total[j]) / chosen);
                    return Outcome::Ground(t);
                }
            }
        }
    }
    if collision[hero] <= 0.0 {
        return Outcome::Lost;
    }
    // Invert: M(t) = -ln(1 - u (1 - exp(-M))).
    let target = -(-sampler.uniform() * collision[hero]).ln_1p();
    let Some((layer, t)) = invert(problem, track.segments, hero, target) else { return Outcome::Lost };
    let local = problem.medium.local(layer, track.ray.altitude_m(t));
    let depth = optical_depth(problem, track.segments, t);
    let density: [f64; L] = std::array::from_fn(|j| {
        if collision[j] > 0.0 {
            probability[j] * shells[layer].majorant[j] * (-depth[j]).exp() / collision[j]
        } else {
            0.0
        }
    });
    let through = ratio::transmittance(problem.medium, &track.ray, track.segments, t, sampler);
    carried.multiply(|j| through[j] * local.scattering[j] / density[hero], |j| density[j] / density[hero]);
    Outcome::Air(t, Box::new(local))
}

/// Optical depth of the majorants along `segments` as far as `until_m`.
fn optical_depth<const L: usize>(problem: &Problem<'_, L>, segments: &[Segment], until_m: f64) -> [f64; L] {
    let mut depth = [0.0; L];
    for &Segment { layer, start_m, end_m } in segments {
        if start_m >= until_m {
            break;
        }
        let length = end_m.min(until_m) - start_m;
        for (depth, majorant) in depth.iter_mut().zip(&problem.medium.shells()[layer].majorant) {
            *depth += majorant * length;
        }
    }
    depth
}

/// Layer and distance at which the hero's majorant optical depth is `target`.
fn invert<const L: usize>(
    problem: &Problem<'_, L>,
    segments: &[Segment],
    hero: usize,
    target: f64,
) -> Option<(usize, f64)> {
    let mut left = target;
    let mut last = None;
    for &Segment { layer, start_m, end_m } in segments {
        let majorant = problem.medium.shells()[layer].majorant[hero];
        let depth = majorant * (end_m - start_m);
        if majorant > 0.0 {
            if left <= depth {
                return Some((layer, start_m + left / majorant));
            }
            // Rounding of the sum can leave the target just past the end.
            last = Some((layer, end_m));
        }
        left -= depth;
    }
    last
}
