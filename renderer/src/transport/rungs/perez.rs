//! Perez, Seals & Michalsky 1993, "All-weather model for sky luminance distribution - preliminary configuration and validation", Solar Energy
//! 50(3), 235-245, with its erratum (51(5), 423).
//!
//! l(Z, gamma) = (1 + a e^(b / cos Z)) (1 + c e^(d gamma) + e cos^2 gamma), whose a to e follow, bin by bin of the clearness, from the sun's zenith angle and
//! the brightness (equations 1 to 8, table 1); scaled so that the dome gives the diffuse illuminance. Clearness and brightness follow
//! from irradiances:
//! epsilon = ((E_d + E_n) / E_d + 1.041 z^3) / (1 + 1.041 z^3), Delta = m E_d / 1367 W/m^2, E_d diffuse on the horizontal, E_n direct on a surface that faces the sun, z the
//! sun's zenith angle in radians, m the relative air mass (Kasten & Young 1989).
//!
//! Here E_d, E_n and the illuminance are those of the isotropic closure ([`super::isotropic`]) from 300 to 1000 nm; the infrared beyond is taken to
//! arrive as it comes, for it is scattered next to nothing, but water vapour and carbon dioxide take a part of it: epsilon is too high by a few
//! percent of itself. No colour: the sky is as white as D65. The sun above 1 degree (below, m and epsilon have no
//! measurements behind them), the observer on the ground; black below the horizon.

use super::{Dome, WHITE};
use glam::DVec3;
use std::f64::consts::TAU;

/// Lower ends of the bins of clearness.
const BINS: [f64; 8] = [1.0, 1.065, 1.23, 1.5, 1.95, 2.8, 4.5, 6.2];

/// Table 1: of each bin x_1 to x_4 of a, b, c, d, e.
const TABLE: [[[f64; 4]; 5]; 8] = [
    [
        [1.3525, -0.2576, -0.2690, -1.4366],
        [-0.7670, 0.0007, 1.2734, -0.1233],
        [2.8000, 0.6004, 1.2375, 1.0000],
        [1.8734, 0.6297, 0.9738, 0.2809],
        [0.0356, -0.1246, -0.5718, 0.9938],
    ],
    [
        [-1.2219, -0.7730, 1.4148, 1.1016],
        [-0.2054, 0.0367, -3.9128, 0.9156],
        [6.9750, 0.1774, 6.4477, -0.1239],
        [-1.5798, -0.5081, -1.7812, 0.1080],
        [0.2624, 0.0672, -0.2190, -0.4285],
    ],
    [
        [-1.1000, -0.2515, 0.8952, 0.0156],
        [0.2782, -0.1812, -4.5000, 1.1766],
        [24.7219, -13.0812, -37.7000, 34.8438],
        [-5.0000, 1.5218, 3.9229, -2.6204],
        [-0.0156, 0.1597, 0.4199, -0.5562],
    ],
    [
        [-0.5484, -0.6654, -0.2672, 0.7117],
        [0.7234, -0.6219, -5.6812, 2.6297],
        [33.3389, -18.3000, -62.2500, 52.0781],
        [-3.5000, 0.0016, 1.1477, 0.1062],
        [0.4659, -0.3296, -0.0876, -0.0329],
    ],
    [
        [-0.6000, -0.3566, -2.5000, 2.3250],
        [0.2937, 0.0496, -5.6812, 1.8415],
        [21.0000, -4.7656, -21.5906, 7.2492],
        [-3.5000, -0.1554, 1.4062, 0.3988],
        [0.0032, 0.0766, -0.0656, -0.1294],
    ],
    [
        [-1.0156, -0.3670, 1.0078, 1.4051],
        [0.2875, -0.5328, -3.8500, 3.3750],
        [14.0000, -0.9999, -7.1406, 7.5469],
        [-3.4000, -0.1078, -1.0750, 1.5702],
        [-0.0672, 0.4016, 0.3017, -0.4844],
    ],
    [
        [-1.0000, 0.0211, 0.5025, -0.5119],
        [-0.3000, 0.1922, 0.7023, -1.6317],
        [19.0000, -5.0000, 1.2438, -1.9094],
        [-4.0000, 0.0250, 0.3844, 0.2656],
        [1.0468, -0.3788, -2.4517, 1.4656],
    ],
    [
        [-1.0500, 0.0289, 0.4260, 0.3590],
        [-0.3250, 0.1156, 0.7781, 0.0025],
        [31.0625, -14.5000, -46.1148, 55.3750],
        [-7.2312, 0.4050, 13.3500, 0.6234],
        [1.5000, -0.6426, 1.8564, 0.5636],
    ],
];

/// The solar constant of the model in W/m^2.
const SOLAR_CONSTANT: f64 = 1367.0;

/// What the sun and the sky send to an observer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Light {
    /// Diffuse irradiance of the horizontal in W/m^2.
    pub diffuse_w_m2: f64,
    /// Direct irradiance of a surface that faces the sun in W/m^2.
    pub direct_w_m2: f64,
    /// Diffuse illuminance of the horizontal in lux.
    pub diffuse_lux: f64,
}

/// A sky.
#[derive(Debug, Clone, PartialEq)]
pub struct Perez {
    sun: DVec3,
    parameters: [f64; 5],
    /// cd/m^2 for l = 1.
    scale: f64,
}

/// Relative optical air mass (Kasten & Young 1989, equation 3).
fn air_mass(zenith_deg: f64) -> f64 {
    1.0 / (zenith_deg.to_radians().cos() + 0.505_72 * (96.079_95 - zenith_deg).powf(-1.6364))
}

/// Clearness and brightness with the sun at that zenith angle in radians.
fn weather(light: &Light, zenith: f64) -> (f64, f64) {
    let cube = 1.041 * zenith.powi(3);
    let clearness = ((light.diffuse_w_m2 + light.direct_w_m2) / light.diffuse_w_m2 + cube) / (1.0 + cube);
    (clearness, air_mass(zenith.to_degrees()) * light.diffuse_w_m2 / SOLAR_CONSTANT)
}

/// a to e.
fn parameters(clearness: f64, brightness: f64, zenith: f64) -> [f64; 5] {
    let bin = BINS.partition_point(|&low| low <= clearness).max(1) - 1;
    let table = &TABLE[bin];
    let mut parameters = table.map(|[x1, x2, x3, x4]| x1 + x2 * zenith + brightness * (x3 + x4 * zenith));
    if bin == 0 {
        let ([c1, c2, c3, c4], [d1, d2, d3, d4]) = (table[2], table[3]);
        parameters[2] = (brightness * (c1 + c2 * zenith)).powf(c3).exp() - c4;
        parameters[3] = -(brightness * (d1 + d2 * zenith)).exp() + d3 + brightness * d4;
    }
    parameters
}

/// l.
fn relative([a, b, c, d, e]: [f64; 5], cosine: f64, gamma: f64) -> f64 {
    (1.0 + a * (b / cosine).exp()) * (1.0 + c * (d * gamma).exp() + e * gamma.cos().powi(2))
}

impl Perez {
    /// The sky that the light makes with the sun in that unit direction.
    #[must_use]
    pub fn new(light: &Light, sun: DVec3) -> Self {
        let zenith = sun.z.clamp(-1.0, 1.0).acos();
        let (clearness, brightness) = weather(light, zenith);
        let parameters = parameters(clearness, brightness, zenith);
        // int l cos Z d omega over the dome, even in cos^2 Z and azimuth from the sun: the midpoint rule.
        const RINGS: u32 = 64;
        const SECTORS: u32 = 64;
        let mut sum = 0.0;
        for i in 0..RINGS {
            let cosine = ((f64::from(i) + 0.5) / f64::from(RINGS)).sqrt();
            for k in 0..SECTORS {
                let azimuth = TAU * (f64::from(k) + 0.5) / f64::from(SECTORS);
                let between = cosine * zenith.cos() + (1.0 - cosine * cosine).sqrt() * zenith.sin() * azimuth.cos();
                sum += relative(parameters, cosine, between.clamp(-1.0, 1.0).acos());
            }
        }
        let illuminance = std::f64::consts::PI * sum / f64::from(RINGS * SECTORS);
        Self { sun, parameters, scale: light.diffuse_lux / illuminance }
    }
}

impl Dome for Perez {
    fn xyz(&self, direction: DVec3) -> [f64; 3] {
        if direction.z <= 0.0 {
            return [0.0; 3];
        }
        let luminance = self.scale * relative(self.parameters, direction.z, direction.angle_between(self.sun));
        WHITE.map(|white| luminance * white)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::direction_at;

    /// Direct and diffuse irradiance in W/m^2 and the sun's zenith angle in degrees, with epsilon, Delta, a to e and l at the zenith and at
    /// 60 degrees from it, 40 from the sun: by perezsky 1.0.0 (PyPI, MIT), with the solar constant 1367 W/m^2 and without its
    /// corrections.
    #[rustfmt::skip]
    const BY_PEREZSKY: [([f64; 3], [f64; 9]); 4] = [
        ([850.0, 90.0, 35.0],
         [8.63314425, 0.08031359, -0.98051958, -0.19176932, 21.21804959, -5.88102863, 1.28420281, 0.46613439, 0.69791324]),
        ([120.0, 200.0, 70.0],
         [1.20701413, 0.42474713, -0.99371597, -1.34738395, 9.86608208, -2.90107678, 0.02912065, 0.95563653, 2.16323932]),
        ([5.0, 100.0, 50.0],
         [1.02955398, 0.11363619, 0.95467118, -0.63391202, 0.34951182, -0.31124616, -0.03955973, 1.88313362, 1.59605267]),
        ([400.0, 250.0, 60.0],
         [1.72877526, 0.36472071, -1.07083574, -0.99552995, 11.36175068, -3.03917306, 0.0762285, 0.90058892, 2.05429529]),
    ];

    #[test]
    fn numbers_are_those_of_an_independent_implementation() {
        for ([direct_w_m2, diffuse_w_m2, zenith_deg], expected) in BY_PEREZSKY {
            let zenith = zenith_deg.to_radians();
            let light = Light { diffuse_w_m2, direct_w_m2, diffuse_lux: 1.0 };
            let (clearness, brightness) = weather(&light, zenith);
            let found = parameters(clearness, brightness, zenith);
            let [a, b, c, d, e] = found;
            let at =
                [(1.0, zenith), (0.5, 40.0_f64.to_radians())].map(|(cosine, gamma)| relative(found, cosine, gamma));
            for (found, expected) in [clearness, brightness, a, b, c, d, e, at[0], at[1]].into_iter().zip(expected) {
                // Eight digits were printed.
                assert!((found - expected).abs() < 1e-7, "{found} for {expected}");
            }
        }
    }

    #[test]
    fn the_dome_gives_its_illuminance() {
        let light = Light { diffuse_w_m2: 90.0, direct_w_m2: 850.0, diffuse_lux: 12e3 };
        let sky = Perez::new(&light, direction_at(0.4, 55.0_f64.to_radians()));
        // Another rule: even in Z and azimuth.
        const N: u32 = 180;
        let mut sum = 0.0;
        for i in 0..N {
            let elevation = std::f64::consts::FRAC_PI_2 * (f64::from(i) + 0.5) / f64::from(N);
            for k in 0..N {
                let direction = direction_at(TAU * f64::from(k) / f64::from(N), elevation);
                sum += sky.xyz(direction)[1] * elevation.cos() * elevation.sin();
            }
        }
        let illuminance = sum * std::f64::consts::FRAC_PI_2 * TAU / f64::from(N * N);
        // The kink of e^(d gamma) at the sun limits both rules.
        assert!((illuminance / 12e3 - 1.0).abs() < 2e-3, "{illuminance}");
    }
}
