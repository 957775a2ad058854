//! Sizes of particles: log-normal, or tabulated.

use super::AerosolError;
use std::f64::consts::PI;
use tables::Scale;

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

/// A distribution of the radius as measured: n(ln r) at some radii. Between two of them its logarithm is linear in
/// ln r (a power law of the radius), or it itself where one end is zero; nothing smaller or larger.
///
/// It is normalised to 1 over the radii given.
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    ln_r: Vec<f64>,
    density: Vec<f64>,
    number: f64,
}

impl Tabulated {
    /// The distribution with the particles per unit of ln r `density` (any unit) at the radii `radii` in m.
    ///
    /// # Errors
    /// [`AerosolError::Size`] unless there are two radii or more, positive and growing, as many densities, none
    /// negative and not all zero; all finite.
    pub fn new(radii: &[f64], density: &[f64]) -> Result<Self, AerosolError> {
        let finite = radii.iter().chain(density).all(|x| x.is_finite());
        let growing = radii.first().is_some_and(|r| *r > 0.0) && radii.windows(2).all(|pair| pair[0] < pair[1]);
        if !finite || !growing || radii.len() != density.len() || density.iter().any(|n| *n < 0.0) {
            return Err(AerosolError::Size("radii must grow and numbers not be negative".into()));
        }
        let ln_r: Vec<f64> = radii.iter().map(|r| r.ln()).collect();
        let pieces = ln_r.windows(2).zip(density.windows(2));
        let number: f64 = pieces.map(|(x, n)| (x[1] - x[0]) * mean_between(n[0], n[1])).sum();
        if number > 0.0 {
            let density = density.iter().map(|n| n / number).collect();
            return Ok(Self { ln_r, density, number });
        }
        Err(AerosolError::Size("it holds no particles".into()))
    }

    /// The number of particles before it was normalised, in the unit of the densities: the integral of n(ln r).
    #[must_use]
    pub fn number(&self) -> f64 {
        self.number
    }

    fn density(&self, ln_r: f64) -> f64 {
        let above = self.ln_r.partition_point(|&x| x <= ln_r);
        let last = self.ln_r.len() - 1;
        let Some(below) = above.checked_sub(1) else { return 0.0 };
        if below == last {
            // Only the last radius itself is inside.
            return if ln_r > self.ln_r[last] { 0.0 } else { self.density[last] };
        }
        let (a, b) = (self.density[below], self.density[above]);
        let f = (ln_r - self.ln_r[below]) / (self.ln_r[above] - self.ln_r[below]);
        if a > 0.0 && b > 0.0 { Scale::Logarithmic.between(a, b, f) } else { Scale::Linear.between(a, b, f) }
    }
}

/// Mean over a piece of what runs from `a` to `b`, its logarithm linear, or it itself where one end is zero.
fn mean_between(a: f64, b: f64) -> f64 {
    if a > 0.0 && b > 0.0 && a != b { (b - a) / (b / a).ln() } else { 0.5 * (a + b) }
}

/// A distribution of the radius, normalised to one particle.
#[derive(Debug, Clone, PartialEq)]
pub enum Sizes {
    /// A log-normal.
    LogNormal(LogNormal),
    /// As measured.
    Tabulated(Tabulated),
}

impl Sizes {
    /// n(ln r): particles per unit of ln r, of one particle of the whole distribution.
    #[must_use]
    pub fn density(&self, ln_r: f64) -> f64 {
        match self {
            Self::LogNormal(sizes) => sizes.density(ln_r),
            Self::Tabulated(sizes) => sizes.density(ln_r),
        }
    }

    /// In words, for what a table says of it.
    #[must_use]
    pub fn described(&self) -> String {
        match self {
            Self::LogNormal(sizes) => format!("{:.3} um", sizes.median_radius() * 1e6),
            Self::Tabulated(_) => "measured sizes".into(),
        }
    }

    /// ln r between which averages are taken; see [`LogNormal::limits`]. Of a table its first and last radius.
    #[must_use]
    pub fn limits(&self, cut: f64) -> (f64, f64) {
        match self {
            Self::LogNormal(sizes) => sizes.limits(cut),
            Self::Tabulated(sizes) => (sizes.ln_r[0], sizes.ln_r[sizes.ln_r.len() - 1]),
        }
    }
}

impl From<LogNormal> for Sizes {
    fn from(sizes: LogNormal) -> Self {
        Self::LogNormal(sizes)
    }
}

impl From<Tabulated> for Sizes {
    fn from(sizes: Tabulated) -> Self {
        Self::Tabulated(sizes)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tabulated_power_law_is_exact() {
        // n(ln r) = r^-3 from 0.1 to 10 (any unit): the integral is (0.1^-3 - 10^-3) / 3.
        let radii: Vec<f64> = (0..=8).map(|i| 0.1 * 10.0_f64.powf(f64::from(i) / 4.0)).collect();
        let density: Vec<f64> = radii.iter().map(|r| r.powi(-3)).collect();
        let sizes = Tabulated::new(&radii, &density).expect("sound");
        let exact = (1e3 - 1e-3) / 3.0;
        // A few roundings of exp and ln.
        assert!((sizes.number() / exact - 1.0).abs() < 1e-13, "{} for {exact}", sizes.number());
        let at = sizes.density(0.7_f64.ln());
        assert!((at * exact / 0.7_f64.powi(-3) - 1.0).abs() < 1e-12, "{at}");
        let sizes = Sizes::from(sizes);
        let (low, high) = sizes.limits(1e-9);
        assert!(sizes.density(low) > 0.0 && sizes.density(high) > 0.0, "the ends belong to it");
        assert_eq!((sizes.density(low - 1e-9), sizes.density(high + 1e-9)), (0.0, 0.0));
    }

    #[test]
    fn a_table_may_hold_empty_bins_but_not_only_those() {
        let sizes = Tabulated::new(&[1e-7, 1e-6, 1e-5], &[0.0, 2.0, 0.0]).expect("sound");
        // A triangle over two decades of ln r.
        assert!((sizes.number() / (2.0 * 10.0_f64.ln()) - 1.0).abs() < 1e-14);
        for (radii, density) in
            [(vec![1e-7, 1e-6], vec![0.0, 0.0]), (vec![1e-6, 1e-7], vec![1.0, 1.0]), (vec![1e-6], vec![1.0])]
        {
            assert!(Tabulated::new(&radii, &density).is_err(), "{radii:?} {density:?}");
        }
    }

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
