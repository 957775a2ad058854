//! Random numbers as a pure function of (seed, pixel, sample), and the maps
//! from the unit square that several rooms share.

use glam::DVec3;
use rand_core::Rng;
use rand_pcg::Pcg32;
use sobol_burley::{NUM_DIMENSION_SETS_4D, sample_4d};
use std::f64::consts::TAU;

/// A stream of uniform numbers that depends on (seed, pixel, sample) and on
/// nothing else, so that any path can be replayed and the number of threads
/// does not matter. PCG32 (O'Neill 2014), its state and stream from a
/// SplitMix64 hash of the three (Steele, Lea & Flood 2014).
///
/// A stream may be one point of a scrambled Sobol sequence instead ([`Sampler::sobol`]): its first numbers, those of the
/// early stages of a path, then fill the unit cube more evenly than chance, and each point by
/// itself is still uniform.
#[derive(Debug, Clone)]
pub struct Sampler {
    random: Pcg32,
    point: Option<Point>,
}

/// A point of a Sobol sequence and the next four of its dimensions.
#[derive(Debug, Clone, Copy)]
struct Point {
    index: u32,
    scramble: u32,
    set: u32,
}

/// Points that a Sobol sequence has.
pub const POINTS: u64 = 1 << 16;

impl Sampler {
    /// The stream of one sample of one pixel.
    #[must_use]
    pub fn new(seed: u64, pixel: u64, sample: u64) -> Self {
        let state = mix(mix(mix(seed).wrapping_add(pixel)).wrapping_add(sample));
        let stream = mix(state ^ 0x5851_f42d_4c95_7f2d);
        Self { random: Pcg32::new(state, stream), point: None }
    }

    /// Point `index` (below [`POINTS`]) of replicate `replicate` of a pixel's Sobol sequence, with Owen's scrambling by hashing
    /// (Burley 2020): replicates are independent of each other, the points of one are not.
    #[must_use]
    pub fn sobol(seed: u64, pixel: u64, replicate: u64, index: u32) -> Self {
        let scramble = mix(mix(mix(seed).wrapping_add(pixel)).wrapping_add(replicate) ^ 0x2545_f491_4f6c_dd1d) >> 32;
        Self {
            point: Some(Point { index, scramble: scramble as u32, set: 0 }),
            ..Self::new(seed, pixel, replicate.wrapping_mul(POINTS).wrapping_add(u64::from(index)))
        }
    }

    /// A uniform number in [0, 1): 53 bits.
    #[inline]
    pub fn uniform(&mut self) -> f64 {
        (self.random.next_u64() >> 11) as f64 * (1.0 / (1_u64 << 53) as f64)
    }

    /// Two uniform numbers in [0, 1).
    #[inline]
    pub fn uniform_2d(&mut self) -> [f64; 2] {
        [self.uniform(), self.uniform()]
    }

    /// Goes on with set `set` of four dimensions. Every stage of a path has sets of its own, so that a dimension means the
    /// same for all points: set 0 is the camera's, 1 chooses the wavelength, 2n and 2n + 1 are those of order n.
    #[inline]
    pub fn go_to(&mut self, set: u32) {
        if let Some(point) = &mut self.point {
            point.set = set;
        }
    }

    /// The set that comes next, which says how far a path has come; 0 for a stream that is no point of a sequence.
    #[must_use]
    pub fn set(&self) -> u32 {
        self.point.map_or(0, |point| point.set)
    }

    /// The next four numbers in [0, 1): of the sequence where it has so many dimensions, at random beyond.
    #[inline]
    pub fn four(&mut self) -> [f64; 4] {
        if let Some(point) = &mut self.point
            && point.set < NUM_DIMENSION_SETS_4D
        {
            let four = sample_4d(point.index, point.set, point.scramble);
            point.set += 1;
            // The sequence has 23 bits; below them is chance.
            let fine = self.uniform() * f64::from(f32::EPSILON);
            return four.map(|u| f64::from(u) + fine);
        }
        [self.uniform(), self.uniform(), self.uniform(), self.uniform()]
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

/// Direction `i` of `count` that lie evenly in solid angle at heights z from `highest` down to `lowest`, by steps of the golden angle.
#[must_use]
pub fn spiral(i: u32, count: u32, [lowest, highest]: [f64; 2]) -> DVec3 {
    const GOLDEN: f64 = 2.399_963_229_728_653;
    let z = highest - (highest - lowest) * (f64::from(i) + 0.5) / f64::from(count);
    let (sin, cos) = (f64::from(i) * GOLDEN).sin_cos();
    let level = ((1.0 - z) * (1.0 + z)).sqrt();
    DVec3::new(level * cos, level * sin, z)
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
