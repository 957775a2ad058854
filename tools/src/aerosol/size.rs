//! Sizes of particles.

use super::AerosolError;
use std::f64::consts::PI;

/// Standard deviations of ln r, beyond the radii that matter, at which an average is cut off: the Gaussian
/// is 7e-10 there.
const REACH: f64 = 6.5;

/// A log-normal distribution of the radius: the number of particles per interval of ln r is
/// n(ln r) = exp(-ln^2(r / r_m) / (2 s^2)) / (sqrt(2 pi) s), s = ln sigma_g, for r_min <= r <= r_max, else 0.
///
/// It is normalised to 1 over all radii, as OPAC and Jaenicke state it: what is cut off is missing, so
/// that the number density of a component counts particles that the limits leave out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LogNormal {
    median: f64,
    s: f64,
    smallest: f64,
    largest: f64,
}

impl LogNormal {
    /// A distribution with the median radius (of the number) `median` in m and the geometric standard deviation
    /// `sigma_g`, cut off at the radii `smallest` and `largest` in m.
    ///
    /// # Errors
    /// [`AerosolError::Size`] unless 0 < smallest < largest, 0 < median and 1 < sigma_g, all finite.
    pub fn new(median: f64, sigma_g: f64, smallest: f64, largest: f64) -> Result<Self, AerosolError> {
        let sound = median > 0.0 && sigma_g > 1.0 && smallest > 0.0 && smallest < largest;
        if sound && [median, sigma_g, largest].iter().all(|x| x.is_finite()) {
            return Ok(Self { median, s: sigma_g.ln(), smallest, largest });
        }
        Err(AerosolError::Size(format!("median {median} m, sigma_g {sigma_g}, {smallest} to {largest} m")))
    }

    /// Median radius of the number distribution, m.
    #[must_use]
    pub fn median_radius(&self) -> f64 {
        self.median
    }

    /// n(ln r): particles per unit of ln r, of one particle of the whole distribution; the limits are not applied.
    #[must_use]
    pub fn density(&self, ln_r: f64) -> f64 {
        let t = (ln_r - self.median.ln()) / self.s;
        (-0.5 * t * t).exp() / ((2.0 * PI).sqrt() * self.s)
    }

    /// ln r between which averages are taken: the limits of the distribution, or narrower where the rest is
    /// below 1e-8 of any cross-section. r^p n(ln r) has its maximum at ln r_m + p s^2; cross-sections grow as
    /// r^2 (p = 2) where spheres are large and fall at least as r^3 (p = 3) where they are small.
    #[must_use]
    pub fn limits(&self) -> (f64, f64) {
        let ln = self.median.ln();
        let low = ln + (3.0 * self.s - REACH) * self.s;
        let high = ln + (2.0 * self.s + REACH) * self.s;
        (low.max(self.smallest.ln()), high.min(self.largest.ln()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn moments_are_their_closed_forms() {
        // Hatch and Choate: the mean of r^p is r_m^p exp(p^2 s^2 / 2).
        let sizes = LogNormal::new(0.1e-6, 2.0, 1e-12, 1.0).expect("sound");
        let s = 2.0_f64.ln();
        for p in [0.0_f64, 1.0, 2.0, 3.0] {
            let (low, high) = (0.1e-6_f64.ln() - 12.0, 0.1e-6_f64.ln() + 12.0);
            let h = (high - low) / 2000.0;
            let mean: f64 =
                (0..=2000).map(|i| low + f64::from(i) * h).map(|x| h * (p * x).exp() * sizes.density(x)).sum();
            let exact = 0.1e-6_f64.powf(p) * (0.5 * p * p * s * s).exp();
            // The trapezoidal rule is exact to rounding here.
            assert!((mean / exact - 1.0).abs() < 1e-12, "moment {p}: {mean} for {exact}");
        }
    }

    #[test]
    fn what_the_limits_leave_out_is_negligible() {
        let sizes = LogNormal::new(0.1e-6, 2.0, 1e-12, 1.0).expect("sound");
        let (low, high) = sizes.limits();
        let weight = |x: f64, p: f64| (p * x).exp() * sizes.density(x);
        let s2 = 2.0_f64.ln().powi(2);
        let peak = |p: f64| weight(0.1e-6_f64.ln() + p * s2, p);
        // exp(-6.5^2 / 2) = 7e-10 of the maximum.
        assert!(weight(low, 3.0) < 1e-9 * peak(3.0) && weight(high, 2.0) < 1e-9 * peak(2.0));
        let cut = LogNormal::new(0.1e-6, 2.0, 0.05e-6, 1e-6).expect("sound").limits();
        assert_eq!(cut, (0.05e-6_f64.ln(), 1e-6_f64.ln()));
    }

    #[test]
    fn impossible_sizes_are_refused() {
        for (median, sigma, low, high) in
            [(0.0, 2.0, 1e-9, 1e-6), (1e-7, 1.0, 1e-9, 1e-6), (1e-7, 2.0, 1e-6, 1e-9), (f64::NAN, 2.0, 1e-9, 1e-6)]
        {
            assert!(LogNormal::new(median, sigma, low, high).is_err(), "{median} {sigma} {low} {high}");
        }
    }
}
