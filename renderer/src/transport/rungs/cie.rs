//! The standard general skies of CIE S 011/E:2003 (ISO 15469:2004): fifteen relative luminance distributions.
//!
//! L(Z, chi) / L_z = f(chi) phi(Z) / (f(Z_s) phi(0)), phi(Z) = 1 + a e^(b / cos Z), f(chi) = 1 + c (e^(d chi) - e^(d pi/2)) + e cos^2 chi, Z the zenith
//! angle looked at, chi the angle from the sun, Z_s the sun's zenith angle. Table 1 of the standard joins six gradations and six
//! indicatrices. The luminance L_z of the zenith is not part of it: here it is that of the isotropic closure ([`super::isotropic`]). No colour: the
//! sky is as white as D65. Types 1 to 6 are overcast, 12 is the clear sky of low turbidity, 13 that of polluted air. The sun
//! above the horizon, the observer on the ground; black below the horizon.

use super::{Dome, WHITE};
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// The type taken if nothing is said: the CIE standard clear sky, low luminance turbidity.
pub const CLEAR: u8 = 12;

/// Gradations I to VI: a, b.
const GRADATIONS: [[f64; 2]; 6] =
    [[4.0, -0.70], [1.1, -0.80], [0.0, -1.00], [-1.0, -0.55], [-1.0, -0.32], [-1.0, -0.15]];

/// Indicatrices 1 to 6: c, d, e.
const INDICATRICES: [[f64; 3]; 6] = [
    [0.0, -1.0, 0.0],
    [2.0, -1.5, 0.15],
    [5.0, -2.5, 0.30],
    [10.0, -3.0, 0.45],
    [16.0, -3.0, 0.30],
    [24.0, -2.8, 0.15],
];

/// Gradation and indicatrix of types 1 to 15, counted from 1.
const TYPES: [(usize, usize); 15] = [
    (1, 1),
    (1, 2),
    (2, 1),
    (2, 2),
    (3, 1),
    (3, 2),
    (3, 3),
    (3, 4),
    (4, 2),
    (4, 3),
    (4, 4),
    (5, 4),
    (5, 5),
    (6, 5),
    (6, 6),
];

/// A sky.
#[derive(Debug, Clone, PartialEq)]
pub struct Cie {
    sun: DVec3,
    gradation: [f64; 2],
    indicatrix: [f64; 3],
    /// L_z / (f(Z_s) phi(0)) in cd/m^2.
    scale: f64,
}

/// phi.
fn gradation([a, b]: [f64; 2], cosine: f64) -> f64 {
    1.0 + a * (b / cosine).exp()
}

/// f.
fn indicatrix([c, d, e]: [f64; 3], chi: f64) -> f64 {
    1.0 + c * ((d * chi).exp() - (d * FRAC_PI_2).exp()) + e * chi.cos().powi(2)
}

impl Cie {
    /// The sky of a type, 1 to 15, with the sun in that unit direction and that luminance of the zenith in cd/m^2; none of another
    /// type.
    #[must_use]
    pub fn new(kind: u8, sun: DVec3, zenith_cd_m2: f64) -> Option<Self> {
        let &(i, k) = TYPES.get(usize::from(kind).checked_sub(1)?)?;
        let (gradation_of, indicatrix_of) = (GRADATIONS[i - 1], INDICATRICES[k - 1]);
        let at_zenith = gradation(gradation_of, 1.0) * indicatrix(indicatrix_of, sun.z.clamp(-1.0, 1.0).acos());
        Some(Self { sun, gradation: gradation_of, indicatrix: indicatrix_of, scale: zenith_cd_m2 / at_zenith })
    }
}

impl Dome for Cie {
    fn xyz(&self, direction: DVec3) -> [f64; 3] {
        if direction.z <= 0.0 {
            return [0.0; 3];
        }
        let chi = direction.angle_between(self.sun);
        let luminance = self.scale * gradation(self.gradation, direction.z) * indicatrix(self.indicatrix, chi);
        WHITE.map(|white| luminance * white)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::direction_at;

    fn luminance(kind: u8, sun: DVec3, direction: DVec3) -> f64 {
        Cie::new(kind, sun, 1.0).expect("a type").xyz(direction)[1]
    }

    #[test]
    fn every_zenith_has_its_luminance_and_there_are_fifteen_types() {
        let sun = direction_at(1.0, 0.7);
        assert!((1..=15).all(|kind| (luminance(kind, sun, DVec3::Z) - 1.0).abs() < 1e-12));
        assert!(Cie::new(0, sun, 1.0).is_none() && Cie::new(16, sun, 1.0).is_none());
    }

    #[test]
    fn types_have_the_gradations_that_they_are_named_for() {
        let (sun, horizon) = (direction_at(0.0, 0.9), direction_at(2.0, 1e-6));
        // Type 5 is the sky of uniform luminance; type 1, overcast and steep, is 1 / (1 + 4 e^-0.7) = 0.33486 at the horizon whatever the
        // azimuth: the traditional third.
        assert!((luminance(5, sun, horizon) - 1.0).abs() < 1e-12);
        assert!((luminance(1, sun, horizon) - 0.334_858).abs() < 1e-6, "{}", luminance(1, sun, horizon));
        // Type 12 at 60 degrees from the zenith and from the sun at 60 degrees, by hand: phi = 1 - e^(-0.64) = 0.472708 over 1 - e^(-0.32) =
        // 0.273851; f(pi/3) = 1 + 10 (e^-pi - e^(-1.5 pi)) + 0.45/4 = 1.454804 both at the zenith and there.
        let sun = direction_at(0.0, FRAC_PI_2 - 60.0_f64.to_radians());
        let azimuth = (1.0_f64 / 3.0).acos();
        let there = direction_at(azimuth, 30.0_f64.to_radians());
        assert!((there.angle_between(sun).to_degrees() - 60.0).abs() < 1e-9);
        assert!((luminance(12, sun, there) - 1.726_149).abs() < 1e-6, "{}", luminance(12, sun, there));
    }
}
