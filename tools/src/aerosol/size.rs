//! Sizes of particles.

use super::AerosolError;
use std::f64::consts::PI;

/// Powers of the radius whose shares bound what an average cuts off below and above: cross-sections of small spheres grow
/// at least as r^2, and of spheres beyond the Rayleigh regime nothing grows faster than the intensity ahead, as r^4.
const POWERS: (f64, f64) = (2.0, 4.0);

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

    /// Standard deviation s of ln r.
    #[must_use]
    pub fn deviation(&self) -> f64 {
        self.s
    }

    /// Where r^`power` n(ln r) has its maximum: ln r_m + p s^2.
    #[must_use]
    pub fn peak(&self, power: f64) -> f64 {
        self.median.ln() + power * self.s * self.s
    }

    /// n(ln r): particles per unit of ln r, of one particle of the whole distribution; the limits are not applied.
    #[must_use]
    pub fn density(&self, ln_r: f64) -> f64 {
        let t = (ln_r - self.median.ln()) / self.s;
        (-0.5 * t * t).exp() / ((2.0 * PI).sqrt() * self.s)
    }

    /// ln r between which averages are taken: the limits of the distribution, or narrower where what lies beyond is at
    /// most the share `cut` (0 < cut < 0.5) of any average. Of the mean of r^p, whose density is a Gaussian about
    /// ln r_m + p s^2, the share beyond t standard deviations is below exp(-t^2 / 2) / 2; the limits have that share of
    /// r^2 below and of r^4 above.
    #[must_use]
    pub fn limits(&self, cut: f64) -> (f64, f64) {
        let reach = (-2.0 * (2.0 * cut).ln()).sqrt();
        let low = self.peak(POWERS.0) - reach * self.s;
        let high = self.peak(POWERS.1) + reach * self.s;
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
    fn limits_leave_out_no_more_than_asked() {
        let sizes = LogNormal::new(0.1e-6, 2.0, 1e-12, 1.0).expect("sound");
        let s = 2.0_f64.ln();
        for cut in [1e-3, 1e-5, 1e-7] {
            let (low, high) = sizes.limits(cut);
            // Shares of r^2 and r^4 beyond the limits, by the trapezoidal rule from there to where nothing is left.
            let beyond = |p: f64, from: f64, to: f64| {
                let h = (to - from) / 4000.0;
                let whole = 0.1e-6_f64.powf(p) * (0.5 * p * p * s * s).exp();
                let sum: f64 =
                    (0..=4000).map(|i| from + f64::from(i) * h).map(|x| (p * x).exp() * sizes.density(x)).sum();
                h.abs() * sum / whole
            };
            for share in [beyond(2.0, low, low - 10.0), beyond(4.0, high, high + 10.0)] {
                // exp(-t^2 / 2) / 2 is 2.5 to 7 times the share in this range of t.
                assert!(share < cut && share > 0.1 * cut, "{share:e} of {cut:e}");
            }
        }
        let cut = LogNormal::new(0.1e-6, 2.0, 0.05e-6, 1e-6).expect("sound").limits(1e-7);
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
