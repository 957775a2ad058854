//! Preetham, Shirley & Smits 1999, "A practical analytic model for daylight", appendix A.2: Perez' five-parameter form fitted to
//! computed clear skies, luminance and chromaticity apart.
//!
//! With theta the zenith angle looked at, gamma the angle from the sun, theta_s the sun's zenith angle and T the turbidity,
//! F(theta, gamma) = (1 + A e^(B / cos theta)) (1 + C e^(D gamma) + E cos^2 gamma), v = v_z F(theta, gamma) / F(0, theta_s) for v = Y, x, y.
//!
//! Range: fitted to turbidities from 2 to 6 (their section 4), the sun above the horizon, an observer on the ground. It is known
//! to break down outside: with T below 2 it brightens at the wrong side and turns green, above 6 with a low sun the zenith's luminance goes
//! below zero (Zotti, Wilkie & Purgathofer 2007); within the range, skies away from the sun are too bright.

use super::Dome;
use glam::DVec3;
use std::f64::consts::PI;

/// A, B, C, D, E, each linear in T, of Y, x and y (the tables of A.2): (slope, constant).
const DISTRIBUTION: [[(f64, f64); 5]; 3] = [
    [(0.1787, -1.4630), (-0.3554, 0.4275), (-0.0227, 5.3251), (0.1206, -2.5771), (-0.0670, 0.3703)],
    [(-0.0193, -0.2592), (-0.0665, 0.0008), (-0.0004, 0.2125), (-0.0641, -0.8989), (-0.0033, 0.0452)],
    [(-0.0167, -0.2608), (-0.0950, 0.0092), (-0.0079, 0.2102), (-0.0441, -1.6537), (-0.0109, 0.0529)],
];

/// Chromaticity x and y of the zenith: rows T^2, T, 1; columns theta_s^3, theta_s^2, theta_s, 1.
const ZENITH: [[[f64; 4]; 3]; 2] = [
    [
        [0.001_66, -0.003_75, 0.002_09, 0.0],
        [-0.029_03, 0.063_77, -0.032_02, 0.003_94],
        [0.116_93, -0.211_96, 0.060_52, 0.258_86],
    ],
    [
        [0.002_75, -0.006_10, 0.003_17, 0.0],
        [-0.042_14, 0.089_70, -0.041_53, 0.005_16],
        [0.153_46, -0.267_56, 0.066_70, 0.266_88],
    ],
];

/// A sky.
#[derive(Debug, Clone, PartialEq)]
pub struct Preetham {
    sun: DVec3,
    parameters: [[f64; 5]; 3],
    /// Y (cd/m^2), x and y of the zenith, over F(0, theta_s).
    scales: [f64; 3],
}

/// F.
fn distribution([a, b, c, d, e]: [f64; 5], cosine: f64, gamma: f64) -> f64 {
    (1.0 + a * (b / cosine).exp()) * (1.0 + c * (d * gamma).exp() + e * gamma.cos().powi(2))
}

impl Preetham {
    /// The sky of a turbidity with the sun in that unit direction. Outside its range [`super::Rung::covers`] refuses.
    #[must_use]
    pub fn new(turbidity: f64, sun: DVec3) -> Self {
        let theta = sun.z.clamp(-1.0, 1.0).acos();
        let parameters = DISTRIBUTION.map(|row| row.map(|(slope, constant)| slope * turbidity + constant));
        let zenith = zenith(turbidity, theta);
        let scales = std::array::from_fn(|i| zenith[i] / distribution(parameters[i], 1.0, theta));
        Self { sun, parameters, scales }
    }
}

/// Y in cd/m^2, x and y of the zenith.
fn zenith(turbidity: f64, theta: f64) -> [f64; 3] {
    let chi = (4.0 / 9.0 - turbidity / 120.0) * (PI - 2.0 * theta);
    let kilo = (4.0453 * turbidity - 4.9710) * chi.tan() - 0.2155 * turbidity + 2.4192;
    let powers = [theta.powi(3), theta.powi(2), theta, 1.0];
    let chromaticity = ZENITH.map(|rows| {
        let sums = rows.map(|row| row.iter().zip(powers).map(|(a, power)| a * power).sum::<f64>());
        (sums[0] * turbidity + sums[1]) * turbidity + sums[2]
    });
    [1e3 * kilo, chromaticity[0], chromaticity[1]]
}

impl Dome for Preetham {
    fn xyz(&self, direction: DVec3) -> [f64; 3] {
        if direction.z <= 0.0 {
            return [0.0; 3];
        }
        let gamma = direction.angle_between(self.sun);
        let [luminance, x, y] =
            std::array::from_fn(|i| self.scales[i] * distribution(self.parameters[i], direction.z, gamma));
        [luminance * x / y, luminance, luminance * (1.0 - x - y) / y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::direction_at;

    #[test]
    fn the_zenith_has_the_luminance_of_the_formula() {
        // T = 2, the sun at 45 degrees: chi = (4/9 - 1/60) pi/2 = 0.671952, tan chi = 0.795446, Y = (3.1196 * 0.795446 + 1.9882) kcd/m^2.
        let sky = Preetham::new(2.0, direction_at(0.0, PI / 4.0));
        let [x, y, z] = sky.xyz(DVec3::Z);
        assert!((y - 4469.67).abs() < 0.5, "{y}");
        // Blue: to the lower left of white in the diagram.
        assert!((0.2..0.28).contains(&(x / (x + y + z))) && (0.2..0.29).contains(&(y / (x + y + z))));
    }

    #[test]
    fn the_sky_is_brightest_about_the_sun_and_black_below_the_horizon() {
        let sun = direction_at(0.3, 0.6);
        let sky = Preetham::new(3.0, sun);
        let at = |azimuth: f64, elevation: f64| sky.xyz(direction_at(azimuth, elevation))[1];
        assert!(at(0.3, 0.6) > 3.0 * at(0.3 + PI, 0.6) && at(0.3, 0.6) > at(0.3, 1.0));
        assert_eq!(sky.xyz(DVec3::new(1.0, 0.0, -1e-9)), [0.0; 3]);
        // Mirror images about the sun's meridian.
        assert!((at(0.3 + 1.0, 0.2) / at(0.3 - 1.0, 0.2) - 1.0).abs() < 1e-12);
    }
}
