//! Hosek & Wilkie 2012, "An analytic model for full spectral sky-dome radiance", equations 8 to 11, by the crate `hw-skymodel` (MIT;
//! the authors' coefficients under BSD): its RGB data set, linear sRGB in single precision; it has no spectral one.
//!
//! The data are radiances weighed by the colour-matching functions, in W m^-2 sr^-1: times 683 lm/W they are cd/m^2. Range: turbidities
//! from 1 to 10, the sun from 0 to 90 degrees of elevation, albedos from 0 to 1, an observer on the ground; black below the horizon.

use super::{Dome, Refusal};
use crate::spectrum::xyz;
use glam::DVec3;
use hw_skymodel::rgb::{Channel, SkyParams, SkyState};
use tables::units::LUMINOUS_EFFICACY_LM_W;

/// A sky.
#[derive(Debug, Clone, PartialEq)]
pub struct HosekWilkie {
    sun: DVec3,
    state: SkyState,
}

impl HosekWilkie {
    /// The sky of a turbidity over a ground of that albedo in red, green and blue, with the sun in that unit direction.
    ///
    /// # Errors
    /// [`Refusal`] outside the range of the model.
    pub fn new(turbidity: f64, albedo: [f64; 3], sun: DVec3) -> Result<Self, Refusal> {
        let elevation = sun.z.clamp(-1.0, 1.0).asin() as f32;
        // Rounding to single precision must not put a sun at the zenith beyond it.
        let elevation = if elevation > std::f32::consts::FRAC_PI_2 { std::f32::consts::FRAC_PI_2 } else { elevation };
        let params = SkyParams { elevation, turbidity: turbidity as f32, albedo: albedo.map(|a| a as f32) };
        let state = SkyState::new(&params).map_err(|error| Refusal(format!("method hosek-wilkie: {error}")))?;
        Ok(Self { sun, state })
    }
}

impl Dome for HosekWilkie {
    fn xyz(&self, direction: DVec3) -> [f64; 3] {
        if direction.z <= 0.0 {
            return [0.0; 3];
        }
        let (theta, gamma) = (direction.z.min(1.0).acos() as f32, direction.angle_between(self.sun) as f32);
        let of = |channel| LUMINOUS_EFFICACY_LM_W * f64::from(self.state.radiance(theta, gamma, channel));
        xyz([of(Channel::R), of(Channel::G), of(Channel::B)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::direction_at;

    #[test]
    fn the_zenith_of_a_clear_sky_is_blue_and_as_bright_as_skies_are() {
        // Published luminances of clear zeniths with the sun at 45 degrees are 2 to 6 kcd/m^2 (Preetham's formula at T = 2: 4.5).
        let sky = HosekWilkie::new(2.0, [0.1; 3], direction_at(0.0, std::f64::consts::FRAC_PI_4)).expect("in range");
        let [x, y, z] = sky.xyz(DVec3::Z);
        assert!((2e3..6e3).contains(&y), "{y} cd/m2");
        assert!(z > 1.2 * y && x < z, "{x} {y} {z}");
    }

    #[test]
    fn it_refuses_on_both_sides_of_its_range() {
        let of = |turbidity, elevation: f64| HosekWilkie::new(turbidity, [0.1; 3], direction_at(0.0, elevation));
        assert!(of(1.0, 0.5).is_ok() && of(10.0, 0.5).is_ok() && of(0.99, 0.5).is_err() && of(10.1, 0.5).is_err());
        assert!(of(2.0, 0.0).is_ok() && of(2.0, std::f64::consts::FRAC_PI_2).is_ok() && of(2.0, -0.01).is_err());
        assert!(HosekWilkie::new(2.0, [1.1; 3], DVec3::Z).is_err());
    }
}
