//! The sun as a light: a limb-darkened disc, or a parallel beam.

use crate::sampling::around;
use glam::DVec3;
use std::f64::consts::TAU;
use tables::TableError;
use tables::views::Sun;

/// Nominal solar radius in metres (IAU 2015 resolution B3).
pub const SOLAR_RADIUS_M: f64 = 6.957e8;

/// The astronomical unit in metres (IAU 2012 resolution B2).
pub const ASTRONOMICAL_UNIT_M: f64 = 149_597_870_700.0;

/// Angular radius of the sun seen from 1 au in radians, asin(R / au): 0.26645 degrees.
#[must_use]
pub fn solar_angular_radius() -> f64 {
    solar_angular_radius_at(1.0)
}

/// Angular radius of the sun in radians seen from so many astronomical units, asin(R / d).
#[must_use]
pub fn solar_angular_radius_at(distance_au: f64) -> f64 {
    (SOLAR_RADIUS_M / (distance_au * ASTRONOMICAL_UNIT_M)).asin()
}

/// The sun seen from one place, normalised to unit irradiance in each of L wavelengths.
///
/// At the angle theta from the disc's centre the radiance is
/// L_j(theta) = I_j(mu) / (Omega <I_j>) in sr^-1, mu = sqrt(1 - sin^2 theta / sin^2 R) the
/// cosine of the heliocentric angle, R the angular radius, Omega = 2 pi (1 - cos R),
/// I_j(mu) = sum_i a_ij mu^i the limb darkening (Neckel & Labs 1994) and <I_j> its mean
/// over the disc's solid angle, so that the integral of L_j over the disc is 1.
/// (The irradiance of a surface that faces the sun is smaller by R^2/4 = 5e-6.)
///
/// R = 0 is a parallel beam: every sample is its direction, and no direction has a radiance.
#[derive(Debug, Clone, PartialEq)]
pub struct SunDisc<const L: usize> {
    direction: DVec3,
    angular_radius: f64,
    /// 1 - cos R: the disc as a fraction of 2 pi sr.
    cap: f64,
    /// a_ij / <I_j>, by power i.
    profile: Vec<[f64; L]>,
    /// See [`SunDisc::spread`].
    spread: f64,
}

impl<const L: usize> SunDisc<L> {
    /// A disc of `angular_radius` (radians, 0 to below pi/2; 0 for a beam) about the unit
    /// vector `direction` towards its centre, darkened as `sun` says at `wavelengths_nm`.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] for a wavelength that `sun` refuses.
    pub fn new(
        sun: &Sun,
        wavelengths_nm: &[f64; L],
        direction: DVec3,
        angular_radius: f64,
    ) -> Result<Self, TableError> {
        let mut profile: Vec<[f64; L]> = Vec::new();
        for (j, &wavelength_nm) in wavelengths_nm.iter().enumerate() {
            let coefficients = sun.limb_coefficients(wavelength_nm)?;
            profile.resize(profile.len().max(coefficients.len()), [0.0; L]);
            for (row, a) in profile.iter_mut().zip(coefficients) {
                row[j] = a;
            }
        }
        Ok(Self::darkened(direction, angular_radius, profile))
    }

    /// Turns the disc to another centre, a unit vector.
    pub fn turn(&mut self, direction: DVec3) {
        self.direction = direction;
    }

    /// A parallel beam from the unit vector `direction`.
    #[must_use]
    pub fn beam(direction: DVec3) -> Self {
        Self::darkened(direction, 0.0, vec![[1.0; L]])
    }

    /// A disc with the limb darkening sum_i a_ij mu^i, `profile[i][j]` = a_ij.
    #[must_use]
    pub fn darkened(direction: DVec3, angular_radius: f64, mut profile: Vec<[f64; L]>) -> Self {
        let mean = mean_profile(&profile, angular_radius);
        for row in &mut profile {
            for (a, mean) in row.iter_mut().zip(mean) {
                *a /= mean;
            }
        }
        let disc = Self { direction, angular_radius, cap: versine(angular_radius), profile, spread: 0.0 };
        Self { spread: disc.mean_height_squared(), ..disc }
    }

    /// Unit vector towards the disc's centre, in the frame it was given in.
    #[must_use]
    pub fn direction(&self) -> DVec3 {
        self.direction
    }

    /// R in radians.
    #[must_use]
    pub fn angular_radius(&self) -> f64 {
        self.angular_radius
    }

    /// Omega in steradians.
    #[must_use]
    pub fn solid_angle(&self) -> f64 {
        TAU * self.cap
    }

    /// A direction to the disc, uniform in solid angle for `u` uniform in the unit square,
    /// with the weights I_j(mu) / <I_j>, whose expectation is 1: the light that arrives
    /// through the disc is the mean of weight times what the direction lets through.
    #[inline]
    #[must_use]
    pub fn sample(&self, u: [f64; 2]) -> (DVec3, [f64; L]) {
        if self.cap == 0.0 {
            return (self.direction, [1.0; L]);
        }
        let versine = u[0] * self.cap;
        (around(self.direction, 1.0 - versine, u[1]), self.weight(versine))
    }

    /// Mean of the square of the angle (radians) by which a point of the disc lies above or below its centre, by brightness:
    /// R^2 / 4 of an even disc; mean over the wavelengths.
    #[must_use]
    pub fn spread(&self) -> f64 {
        self.spread
    }

    /// [`SunDisc::spread`] by the midpoint rule in the square of the radius.
    fn mean_height_squared(&self) -> f64 {
        const RINGS: u32 = 64;
        let ring = |i: u32| {
            let versine = self.cap * (f64::from(i) + 0.5) / f64::from(RINGS);
            // Half of theta^2 = 2 (1 - cos theta).
            versine * self.weight(versine).iter().sum::<f64>() / L as f64
        };
        if self.cap > 0.0 { (0..RINGS).map(ring).sum::<f64>() / f64::from(RINGS) } else { 0.0 }
    }

    /// Radiance in sr^-1 per unit irradiance in the unit vector `direction`; `None` off the
    /// disc, and everywhere for a beam.
    #[must_use]
    pub fn radiance(&self, direction: DVec3) -> Option<[f64; L]> {
        // |a - b|^2 / 2 = 1 - cos: exact for small angles, where the dot product is not.
        let versine = 0.5 * direction.distance_squared(self.direction);
        (versine < self.cap).then(|| self.weight(versine).map(|w| w / self.solid_angle()))
    }

    /// I_j / <I_j> where 1 - cos theta = `versine`.
    fn weight(&self, versine: f64) -> [f64; L] {
        let mu = (1.0 - sine_squared(versine) / sine_squared(self.cap)).max(0.0).sqrt();
        horner(&self.profile, mu)
    }
}

/// 1 - cos x without cancellation.
fn versine(angle: f64) -> f64 {
    let half = (0.5 * angle).sin();
    2.0 * half * half
}

/// sin^2 of the angle whose versine is given.
fn sine_squared(versine: f64) -> f64 {
    versine * (2.0 - versine)
}

/// sum_i a_ij mu^i for each j.
fn horner<const L: usize>(profile: &[[f64; L]], mu: f64) -> [f64; L] {
    let mut sum = [0.0; L];
    for row in profile.iter().rev() {
        for (s, a) in sum.iter_mut().zip(row) {
            *s = *s * mu + a;
        }
    }
    sum
}

/// Mean of the limb darkening over the disc's solid angle. With sin^2 theta = sin^2 R (1 - mu^2)
/// the solid angle is d omega = 2 pi sin^2 R mu d mu / cos theta, so
/// <I> = sin^2 R / (1 - cos R) * integral over mu in 0..1 of I(mu) mu / cos theta
/// (for R = 0: sum_i 2 a_i / (i + 2)); by Simpson's rule, 10^-11 here.
fn mean_profile<const L: usize>(profile: &[[f64; L]], angular_radius: f64) -> [f64; L] {
    const STEPS: u32 = 256;
    let cap = versine(angular_radius);
    let sine2 = sine_squared(cap);
    let mut sum = [0.0; L];
    for k in 0..=STEPS {
        let mu = f64::from(k) / f64::from(STEPS);
        let simpson = if k == 0 || k == STEPS { 1.0 } else { f64::from(2 + 2 * (k % 2)) };
        let cosine = (1.0 - sine2 * (1.0 - mu * mu)).sqrt();
        let share = simpson * mu / (cosine * 3.0 * f64::from(STEPS)) * (2.0 - cap);
        for (s, i) in sum.iter_mut().zip(horner(profile, mu)) {
            *s += share * i;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two darkenings like the sun's at 450 and 1000 nm.
    fn profile() -> Vec<[f64; 2]> {
        vec![[0.26, 0.50], [1.27, 0.92], [-1.30, -0.78], [1.38, 0.53], [-0.85, -0.22], [0.24, 0.05]]
    }

    fn discs() -> [SunDisc<2>; 2] {
        let direction = DVec3::new(0.3, -0.5, 0.2).normalize();
        // The sun's own size, and one where the curvature of the sphere matters.
        [solar_angular_radius(), 0.6].map(|r| SunDisc::darkened(direction, r, profile()))
    }

    #[test]
    fn the_sun_is_half_a_degree_wide() {
        // R/au = 4.650467e-3: 959.23 seconds of arc.
        assert!((solar_angular_radius().to_degrees() * 3600.0 - 959.23).abs() < 0.01);
    }

    #[test]
    fn an_even_disc_spreads_by_half_its_radius() {
        // <y^2> = R^2/4 but for the curvature of the sphere, R^2/12 of itself = 2e-6, and the rule, which is exact here. A disc
        // that is darker at the limb spreads less.
        let radius = solar_angular_radius();
        let even = SunDisc::darkened(DVec3::Z, radius, vec![[1.0]]);
        assert!((even.spread() / (0.25 * radius * radius) - 1.0).abs() < 1e-5, "{}", even.spread());
        assert!(discs()[0].spread() < 0.97 * even.spread() && SunDisc::<1>::beam(DVec3::Z).spread() == 0.0);
    }

    #[test]
    fn weights_have_mean_one() {
        for disc in discs() {
            // Midpoint rule over u[0]; near the limb the integrand goes as sqrt, error n^-1.5.
            let n = 20_000;
            let mut mean = [0.0; 2];
            for k in 0..n {
                let (_, w) = disc.sample([(f64::from(k) + 0.5) / f64::from(n), 0.3]);
                mean = [mean[0] + w[0] / f64::from(n), mean[1] + w[1] / f64::from(n)];
            }
            assert!(mean.iter().all(|m| (m - 1.0).abs() < 1e-6), "{mean:?}");
        }
    }

    #[test]
    fn the_mean_of_a_small_disc_is_the_closed_form() {
        let mean = mean_profile(&profile(), 0.0);
        for j in 0..2 {
            let exact: f64 = profile().iter().zip(0..).map(|(a, i)| 2.0 * a[j] / f64::from(i + 2)).sum();
            assert!((mean[j] - exact).abs() < 1e-9, "{} for {exact}", mean[j]);
        }
    }

    #[test]
    fn radiance_integrates_to_one_over_the_disc() {
        for disc in discs() {
            let n = 4000;
            let cap = 1.0 - disc.angular_radius().cos();
            let mut sum = [0.0; 2];
            for k in 0..n {
                let cosine = 1.0 - cap * (f64::from(k) + 0.5) / f64::from(n);
                let radiance = disc.radiance(around(disc.direction(), cosine, 0.7)).expect("inside");
                for (s, r) in sum.iter_mut().zip(radiance) {
                    *s += r * TAU * cap / f64::from(n);
                }
            }
            // Midpoint rule, and for the small disc 1 - cos R lost to rounding here (1e-11).
            assert!(sum.iter().all(|s| (s - 1.0).abs() < 1e-5), "{sum:?}");
        }
    }

    #[test]
    fn samples_lie_on_the_disc_and_carry_its_radiance() {
        for disc in discs() {
            for k in 0..200 {
                let u = [f64::from(k) / 200.0, (f64::from(k) * 0.618).fract()];
                let (direction, weight) = disc.sample(u);
                let radiance = disc.radiance(direction).expect("inside");
                for j in 0..2 {
                    // Rounding of a unit vector (1e-16) against a disc of 5e-3: mu near the limb.
                    assert!((radiance[j] * disc.solid_angle() - weight[j]).abs() < 1e-4, "{k}");
                }
            }
        }
    }

    #[test]
    fn the_limb_is_dark_and_beyond_it_is_nothing() {
        let disc = &discs()[0];
        let at = |share: f64| disc.radiance(around(disc.direction(), (share * disc.angular_radius()).cos(), 0.1));
        let [centre, near_limb] = [at(0.0), at(0.999)].map(|r| r.expect("inside")[0]);
        assert!(near_limb < 0.5 * centre && near_limb > 0.2 * centre);
        assert_eq!(at(1.001), None);
    }

    #[test]
    fn a_beam_is_one_direction() {
        let beam = SunDisc::<3>::beam(DVec3::Z);
        assert_eq!(beam.sample([0.3, 0.9]), (DVec3::Z, [1.0; 3]));
        assert_eq!(beam.radiance(DVec3::Z), None);
    }
}
