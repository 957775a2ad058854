//! Random numbers as a pure function of (seed, pixel, sample), and the maps
//! from the unit square that several rooms share.

use glam::DVec3;
use rand_core::Rng;
use rand_pcg::Pcg32;
use std::f64::consts::TAU;

/// A stream of uniform numbers that depends on (seed, pixel, sample) and on
/// nothing else, so that any path can be replayed and the number of threads
/// does not matter. PCG32 (O'Neill 2014), its state and stream from a
/// SplitMix64 hash of the three (Steele, Lea & Flood 2014).
#[derive(Debug, Clone)]
pub struct Sampler(Pcg32);

impl Sampler {
    /// The stream of one sample of one pixel.
    #[must_use]
    pub fn new(seed: u64, pixel: u64, sample: u64) -> Self {
        let state = mix(mix(mix(seed).wrapping_add(pixel)).wrapping_add(sample));
        let stream = mix(state ^ 0x5851_f42d_4c95_7f2d);
        Self(Pcg32::new(state, stream))
    }

    /// A uniform number in [0, 1): 53 bits.
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        (self.0.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// Two uniform numbers in [0, 1).
    #[inline]
    pub fn uniform_2d(&mut self) -> [f64; 2] {
        [self.uniform(), self.uniform()]
    }
}

/// SplitMix64's step and finaliser: a bijection of 64-bit words in which every
/// input bit reaches every output bit.
fn mix(x: u64) -> u64 {
    let x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// The unit vector at polar angle acos(`cosine`) from the unit vector `axis`
/// and azimuth `turn` (a fraction of a full turn, from an arbitrary origin).
#[must_use]
pub fn around(axis: DVec3, cosine: f64, turn: f64) -> DVec3 {
    let (tangent, bitangent) = axis.any_orthonormal_pair();
    let sine = ((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt();
    let (sin, cos) = (TAU * turn).sin_cos();
    (tangent * (sine * cos) + bitangent * (sine * sin) + axis * cosine).normalize()
}

/// A direction with density cos(theta)/pi about `normal` (Lambert's law).
#[must_use]
pub fn cosine_hemisphere(normal: DVec3, [u, v]: [f64; 2]) -> DVec3 {
    around(normal, (1.0 - u).sqrt(), v)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_arguments_give_equal_streams_and_others_do_not() {
        let stream = |seed, pixel, sample| {
            let mut sampler = Sampler::new(seed, pixel, sample);
            [(); 4].map(|()| sampler.uniform())
        };
        assert_eq!(stream(1, 2, 3), stream(1, 2, 3));
        for other in [stream(2, 2, 3), stream(1, 3, 3), stream(1, 2, 4), stream(1, 3, 2)] {
            assert_ne!(stream(1, 2, 3), other);
        }
    }

    #[test]
    fn first_numbers_of_neighbouring_pixels_are_uniform_and_independent() {
        // Mean 1/2 and mean product of neighbours 1/4; five standard errors of n = 20000.
        let n = 20_000_u32;
        let first = |pixel: u32| Sampler::new(7, u64::from(pixel), 0).uniform();
        let (mut sum, mut product) = (0.0, 0.0);
        for pixel in 0..n {
            sum += first(pixel);
            product += first(pixel) * first(pixel + 1);
        }
        let root = f64::from(n).sqrt();
        assert!((sum / f64::from(n) - 0.5).abs() < 5.0 * (1.0_f64 / 12.0).sqrt() / root);
        assert!((product / f64::from(n) - 0.25).abs() < 5.0 * (7.0_f64 / 144.0).sqrt() / root);
    }

    #[test]
    fn directions_around_an_axis_have_the_asked_cosine() {
        let axis = DVec3::new(0.3, -0.5, 0.2).normalize();
        for cosine in [-1.0, -0.4, 0.0, 0.7, 1.0] {
            let d = around(axis, cosine, 0.37);
            assert!((d.dot(axis) - cosine).abs() < 1e-14 && (d.length() - 1.0).abs() < 1e-14);
        }
    }
}
