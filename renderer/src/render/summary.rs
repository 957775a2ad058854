//! A few numbers that anyone can check against the sky outside.

use super::Sky;
use crate::film::Estimate;
use crate::sampling::{Sampler, around, cosine_hemisphere};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::atomic::{AtomicBool, Ordering};

/// Light at the observer's place, whatever the camera looks at.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Illuminance in lux of a level surface by direct sunlight.
    pub sun_lux: f64,
    /// Illuminance in lux of a level surface by the sky.
    pub sky_lux: Estimate,
    /// Luminance of the zenith in cd/m^2.
    pub zenith_cd_m2: Estimate,
    /// CIE XYZ of the direct sunlight on a level surface; Y is `sun_lux`.
    pub sun_xyz: [f64; 3],
    /// CIE XYZ of the light of the sky on a level surface; Y is `sky_lux`.
    pub sky_xyz: [f64; 3],
    /// CIE XYZ of the zenith; Y is `zenith_cd_m2`.
    pub zenith_xyz: [f64; 3],
}

/// Pixel numbers of the two estimates: no picture has so many pixels.
const HEMISPHERE: u64 = 1 << 40;
const ZENITH: u64 = HEMISPHERE + 1;

/// Samples of a scrambled Sobol sequence, and the fewest and the most sequences.
const SEQUENCE: u64 = 64;
const SEQUENCES: (u64, u64) = (16, 2048);

/// The most sequences of a sky without noise: what is left is the quadrature over directions.
const SOLVED: u64 = 64;

/// Standard error that is enough.
const ENOUGH: f64 = 5e-3;

impl Summary {
    /// Computes the summary on the current thread pool: the sun by quadrature
    /// ([`Sky::direct_irradiance`]); the sky as pi times the mean weighted luminance over directions
    /// (half of them about the sun, weighed accordingly); both estimates to 0.5 % standard error or 131 072 samples, in sequences whose
    /// spread is the error, fewer once `stop` is set.
    #[must_use]
    pub fn new(sky: &Sky, seed: u64, stop: &AtomicBool) -> Self {
        let (hemisphere, sky_xyz) =
            estimate(sky, (seed, HEMISPHERE), stop, |sampler| overhead(sky.sun_direction(), sampler));
        let (zenith_cd_m2, zenith_xyz) = estimate(sky, (seed, ZENITH), stop, |_| (DVec3::Z, 1.0));
        let sun_xyz = sky.colour().xyz(&sky.direct_irradiance());
        Self {
            sun_lux: sun_xyz[1],
            sky_lux: Estimate { mean: PI * hemisphere.mean, error: PI * hemisphere.error },
            zenith_cd_m2,
            sun_xyz,
            sky_xyz: sky_xyz.map(|value| PI * value),
            zenith_xyz,
        }
    }
}

/// A direction above, and cos(theta) over pi times its density: half of all are distributed as cos(theta)/pi, half lie close
/// about the sun, evenly in the logarithm of the angle from it, for the sake of the aureole; either kind is weighed by the
/// density of both together.
fn overhead(sun: DVec3, sampler: &mut Sampler) -> (DVec3, f64) {
    const ANGLES: (f64, f64) = (1e-3, PI);
    let [u, v, ..] = sampler.four();
    let span = (ANGLES.1 / ANGLES.0).ln();
    // One number chooses the kind and goes on within it: two dimensions stay as even as they are.
    let direction = if u < 0.5 {
        cosine_hemisphere(DVec3::Z, [2.0 * u, v])
    } else {
        around(sun, (ANGLES.0 * ((2.0 * u - 1.0) * span).exp()).cos(), v)
    };
    let cosine = direction.z.max(0.0);
    if cosine == 0.0 {
        return (direction, 0.0);
    }
    // Exact for small angles.
    let angle = 2.0 * (0.5 * direction.distance(sun)).min(1.0).asin();
    let near = if angle > ANGLES.0 { 1.0 / (2.0 * PI * angle.sin().max(1e-9) * angle * span) } else { 0.0 };
    (direction, cosine / (0.5 * cosine + 0.5 * PI * near))
}

/// Mean weighted luminance over the directions that `draw` gives, and mean weighted XYZ.
fn estimate(
    sky: &Sky,
    (seed, stream): (u64, u64),
    stop: &AtomicBool,
    draw: impl Fn(&mut Sampler) -> (DVec3, f64) + Sync,
) -> (Estimate, [f64; 3]) {
    let (mut count, mut mean, mut squares) = (0.0, 0.0, 0.0);
    let mut colour = [0.0; 3];
    let most = if sky.is_noiseless() { SOLVED } else { SEQUENCES.1 };
    for first in (0..most).step_by(SEQUENCES.0 as usize) {
        // Collected in order and summed by one thread: the same sum for any number of threads.
        let sequences: Vec<[f64; 3]> = (first..first + SEQUENCES.0)
            .into_par_iter()
            .map(|sequence| {
                let mut factors = vec![0.0; sky.wavelengths()];
                let mut sum = [0.0; 3];
                for point in 0..SEQUENCE {
                    let mut sampler = Sampler::sobol(seed, stream, sequence, point as u32);
                    let (direction, weight) = draw(&mut sampler);
                    if weight == 0.0 {
                        continue;
                    }
                    sky.radiance(direction, &sampler, &mut factors);
                    let xyz = sky.colour().xyz(&factors);
                    sum.iter_mut().zip(xyz).for_each(|(sum, value)| *sum += weight * value);
                }
                sum.map(|sum| sum / SEQUENCE as f64)
            })
            .collect();
        for xyz in sequences {
            count += 1.0;
            let y = xyz[1];
            colour.iter_mut().zip(xyz).for_each(|(mean, value)| *mean += (value - *mean) / count);
            let deviation = y - mean;
            mean += deviation / count;
            squares += deviation * (y - mean);
        }
        let known = mean > 0.0 && squares <= (ENOUGH * mean).powi(2) * count * (count - 1.0);
        if known || stop.load(Ordering::Relaxed) {
            break;
        }
    }
    (Estimate { mean, error: (squares / (count * (count - 1.0))).sqrt() }, colour)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_even_sky_has_the_illuminance_of_an_even_sky() {
        // The mean weight is the integral of cos(theta)/pi over the hemisphere, 1; 64 sequences of 64 points leave 1e-3 or so.
        for elevation in [90.0_f64, 20.0, 0.5, -5.0] {
            let (sin, cos) = elevation.to_radians().sin_cos();
            let sun = DVec3::new(0.0, cos, sin);
            let weight = |i: u64| overhead(sun, &mut Sampler::sobol(1, 0, i / SEQUENCE, (i % SEQUENCE) as u32)).1;
            let n = SOLVED * SEQUENCE;
            let mean = (0..n).map(weight).sum::<f64>() / n as f64;
            assert!((mean - 1.0).abs() < 4e-3, "sun at {elevation}: {mean}");
        }
    }
}
