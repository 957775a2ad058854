//! Ratio tracking: an unbiased estimate of a transmittance.

use crate::atmosphere::Medium;
use crate::geometry::{Ray, Segment};
use crate::sampling::Sampler;

/// An optical depth that lets nothing through, exp(-DARK) = 0: a level ray between planes would collide for ever.
const DARK: f64 = 746.0;

/// Transmittance at every wavelength along `segments` of `ray` as far as the
/// distance `until_m`.
///
/// In each shell the minorant is known and exact, exp(-minorant x length); what
/// is above it is estimated by ratio tracking (Novak, Selle & Jarosz 2014): collisions at
/// the rate of the shell's spread, each multiplying the weight by
/// 1 - (sigma - minorant) / spread, whose expectation is the transmittance of the rest.
pub(super) fn transmittance<const L: usize>(
    medium: &Medium<L>,
    ray: &Ray,
    segments: &[Segment],
    until_m: f64,
    sampler: &mut Sampler,
) -> [f64; L] {
    let mut depth = [0.0; L];
    let mut weight = [1.0; L];
    // Residual optical depth to the next collision.
    let mut ahead = exponential(sampler);
    for &Segment { layer, start_m, end_m } in segments {
        if start_m >= until_m {
            break;
        }
        let end_m = end_m.min(until_m);
        let shell = &medium.shells()[layer];
        for (depth, minorant) in depth.iter_mut().zip(&shell.minorant) {
            *depth += minorant * (end_m - start_m);
        }
        if depth.iter().all(|&depth| depth > DARK) {
            return [0.0; L];
        }
        let mut at = start_m;
        while ahead < shell.spread * (end_m - at) {
            at += ahead / shell.spread;
            let sigma = medium.extinction(layer, ray.altitude_m(at));
            for ((weight, sigma), minorant) in weight.iter_mut().zip(sigma).zip(&shell.minorant) {
                *weight *= 1.0 - (sigma - minorant) / shell.spread;
            }
            ahead = exponential(sampler);
        }
        ahead -= shell.spread * (end_m - at);
    }
    for (weight, depth) in weight.iter_mut().zip(depth) {
        *weight *= (-depth).exp();
    }
    weight
}

/// An exponential variate of mean 1.
pub(super) fn exponential(sampler: &mut Sampler) -> f64 {
    -(1.0 - sampler.uniform()).ln()
}
