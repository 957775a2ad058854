//! Henyey-Greenstein functions in place of phase functions, and what that costs.
//!
//! P_HG(g, mu) = (1 - g^2) / (4 pi (1 + g^2 - 2 g mu)^(3/2)) (Henyey & Greenstein 1941), in sr^-1, integral over the
//! sphere 1; mu the cosine of the scattering angle. Its Legendre moments are chi_l = g^l. Two of them,
//! w P_HG(g_1) + (1 - w) P_HG(g_2), are a double one (Irvine 1965); its moments are w g_1^l + (1 - w) g_2^l.
//!
//! A phase function known at angles is taken as linear in the cosine between them, as the renderer does. What is least
//! in a fit is the rms over the sphere of ln(P_fit / P): every direction counts as much as every other, and a factor
//! too much as much as the same factor too little. Rms of the difference itself would see the forward peak alone.

use crate::mie::gauss_legendre;
use std::f64::consts::PI;
use tables::views::integral;

/// A Henyey-Greenstein function, or two.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Asymmetry of the first.
    pub g1: f64,
    /// Asymmetry of the second.
    pub g2: f64,
    /// Share of the first, 0 to 1; 1 if there is but one.
    pub weight: f64,
}

impl Fit {
    /// A single function.
    #[must_use]
    pub fn single(g: f64) -> Self {
        Self { g1: g, g2: 0.0, weight: 1.0 }
    }

    /// The phase function in sr^-1 at the cosine `mu` of the scattering angle.
    #[must_use]
    pub fn phase(&self, mu: f64) -> f64 {
        let first = self.weight * henyey_greenstein(self.g1, mu);
        if self.weight < 1.0 { first + (1.0 - self.weight) * henyey_greenstein(self.g2, mu) } else { first }
    }

    /// The asymmetry parameter, its mean cosine.
    #[must_use]
    pub fn asymmetry(&self) -> f64 {
        self.weight * self.g1 + (1.0 - self.weight) * self.g2
    }
}

fn henyey_greenstein(g: f64, mu: f64) -> f64 {
    // 1 + g^2 - 2 g mu without cancellation near the peak.
    let below = (1.0 - g) * (1.0 - g) + 2.0 * g * (1.0 - mu);
    (1.0 - g * g) / (4.0 * PI * below * below.sqrt())
}

/// What determines a fit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// One function with the asymmetry of the phase function.
    Single,
    /// One function, its asymmetry fitted.
    FittedSingle,
    /// Two functions with the first three Legendre moments of the phase function (Kattawar 1975).
    Moments,
    /// Two functions with the asymmetry of the phase function, g_2 <= g <= g_1, the other two parameters fitted.
    Double,
    /// Two functions, all three parameters fitted.
    FreeDouble,
}

/// What a fit costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Rms over the sphere of P_fit / P - 1.
    pub relative: f64,
    /// Rms over the sphere of ln(P_fit / P).
    pub logarithmic: f64,
    /// The largest of |P_fit / P - 1| at angles of 10 degrees and more.
    pub worst: f64,
    /// Share of the scattered light that goes elsewhere: half of the integral of |P_fit - P|.
    pub misplaced: f64,
    /// Share of the light scattered by more than 90 degrees, less that of the phase function.
    pub backward: f64,
}

/// Angle in degrees from which [`Errors::worst`] counts: within, the aureole of the sun hides the sky.
pub const WORST_FROM_DEG: f64 = 10.0;

/// A phase function to be fitted.
#[derive(Debug, Clone)]
pub struct Observed<'a> {
    cosines: &'a [f64],
    phase: &'a [f64],
    /// Share of the sphere that belongs to each angle.
    shares: Vec<f64>,
    /// Legendre moments chi_1, chi_2, chi_3.
    moments: [f64; 3],
}

impl<'a> Observed<'a> {
    /// The phase function `phase` (sr^-1, positive) at `cosines` that grow from -1 to 1; its integral over the sphere must
    /// be 1 by the rule of [`integral`], as that of the tables of aerosol is.
    #[must_use]
    pub fn new(cosines: &'a [f64], phase: &'a [f64]) -> Self {
        let mut shares = vec![0.0; cosines.len()];
        for (i, pair) in cosines.windows(2).enumerate() {
            let share = 0.25 * (pair[1] - pair[0]);
            shares[i] += share;
            shares[i + 1] += share;
        }
        Self { cosines, phase, shares, moments: moments(cosines, phase) }
    }

    /// Legendre moments chi_1 = g, chi_2 and chi_3, chi_l = 2 pi integral of P(mu) P_l(mu) d mu.
    #[must_use]
    pub fn moments(&self) -> [f64; 3] {
        self.moments
    }

    /// Share of the light scattered by more than 90 degrees; 0 must be one of the cosines.
    #[must_use]
    pub fn backward(&self) -> f64 {
        backward(self.cosines, self.phase)
    }

    /// Fits a form. `None` if no two functions have those moments, which concerns [`Form::Moments`] alone.
    #[must_use]
    pub fn fit(&self, form: Form) -> Option<Fit> {
        let g = self.moments[0];
        // Of any real number a share between low and high.
        let between = |low: f64, high: f64, u: f64| low + (high - low) / (1.0 + (-u).exp());
        // Not quite 1, where the peak would fall between the angles.
        let largest = 0.999;
        match form {
            Form::Single => Some(Fit::single(g)),
            Form::FittedSingle => Some(self.least(&[[0.0], [2.0]], |[u]| Fit::single(between(-largest, largest, u)))),
            Form::Moments => two_functions(self.moments),
            Form::Double => {
                let starts = [[0.0, 0.0], [-2.0, 2.0], [2.0, -2.0], [-2.0, -2.0]];
                Some(self.least(&starts, |[u, v]| {
                    let (g1, g2) = (between(g, largest, u), between(-largest, g, v));
                    Fit { g1, g2, weight: (g - g2) / (g1 - g2) }
                }))
            }
            Form::FreeDouble => {
                let starts = [[1.0, 0.0, 2.0], [3.0, 1.0, 0.0], [1.0, -2.0, 3.0], [2.0, 0.0, -2.0]];
                Some(self.least(&starts, |[u, v, w]| {
                    let (a, b) = (between(-largest, largest, u), between(-largest, largest, v));
                    let share = between(0.0, 1.0, w);
                    // The larger asymmetry first.
                    let (g1, g2, weight) = if a >= b { (a, b, share) } else { (b, a, 1.0 - share) };
                    Fit { g1, g2, weight }
                }))
            }
        }
    }

    /// Mean square over the sphere of ln(P_fit / P).
    fn square(&self, fit: &Fit) -> f64 {
        let angles = self.cosines.iter().zip(self.phase).zip(&self.shares);
        angles.map(|((&mu, p), share)| share * (fit.phase(mu) / p).ln().powi(2)).sum()
    }

    /// The best of the fits that the search reaches from these starts.
    fn least<const N: usize>(&self, starts: &[[f64; N]], fit: impl Fn([f64; N]) -> Fit) -> Fit {
        let cost = |parameters: [f64; N]| self.square(&fit(parameters));
        let found = starts.iter().map(|&start| nelder_mead(start, cost)).min_by(|a, b| a.1.total_cmp(&b.1));
        fit(found.map_or(starts[0], |(parameters, _)| parameters))
    }

    /// What a fit costs.
    #[must_use]
    pub fn errors(&self, fit: &Fit) -> Errors {
        let values: Vec<f64> = self.cosines.iter().map(|&mu| fit.phase(mu)).collect();
        let relative: Vec<f64> = values.iter().zip(self.phase).map(|(v, p)| v / p - 1.0).collect();
        let mean_square: f64 = relative.iter().zip(&self.shares).map(|(r, share)| share * r * r).sum();
        let moved: Vec<f64> = values.iter().zip(self.phase).map(|(v, p)| (v - p).abs()).collect();
        // Room for the rounding of the cosine.
        let from = WORST_FROM_DEG.to_radians().cos() + 1e-9;
        let beyond = self.cosines.iter().zip(&relative).filter(|(mu, _)| **mu <= from);
        Errors {
            relative: mean_square.sqrt(),
            logarithmic: self.square(fit).sqrt(),
            worst: beyond.map(|(_, r)| r.abs()).fold(0.0, f64::max),
            misplaced: 0.5 * integral(self.cosines, &moved),
            backward: backward(self.cosines, &values) - self.backward(),
        }
    }
}

fn backward(cosines: &[f64], phase: &[f64]) -> f64 {
    let count = cosines.partition_point(|&mu| mu <= 0.0);
    integral(&cosines[..count], &phase[..count])
}

/// The first three Legendre moments of a function linear in the cosine between angles: three points of Gauss-Legendre
/// quadrature in each interval are exact for the products with P_3.
fn moments(cosines: &[f64], phase: &[f64]) -> [f64; 3] {
    let nodes = gauss_legendre(3);
    let mut moments = [0.0; 3];
    for (mu, p) in cosines.windows(2).zip(phase.windows(2)) {
        let half = 0.5 * (mu[1] - mu[0]);
        for &(t, weight) in &nodes {
            let f = 0.5 * (1.0 + t);
            let (x, value) = (mu[0] + f * (mu[1] - mu[0]), p[0] + f * (p[1] - p[0]));
            let polynomials = [x, 1.5 * x * x - 0.5, (2.5 * x * x - 1.5) * x];
            for (moment, polynomial) in moments.iter_mut().zip(polynomials) {
                *moment += 2.0 * PI * half * weight * value * polynomial;
            }
        }
    }
    moments
}

/// Two functions with the moments g, h, t: w g_1^l + (1 - w) g_2^l = chi_l, so that g_1 and g_2 are the roots of
/// (h - g^2) z^2 - (t - g h) z + (g t - h^2) = 0 (Kattawar, J. Quant. Spectrosc. Radiat. Transfer 15, 839, 1975).
/// `None` unless both lie between -1 and 1.
fn two_functions([g, h, t]: [f64; 3]) -> Option<Fit> {
    let (a, b, c) = (h - g * g, t - g * h, g * t - h * h);
    if a <= 0.0 {
        return None;
    }
    let root = (b * b - 4.0 * a * c).sqrt();
    let (g1, g2) = ((b + root) / (2.0 * a), (b - root) / (2.0 * a));
    let weight = (g - g2) / (g1 - g2);
    (g1 < 1.0 && g2 > -1.0 && (0.0..=1.0).contains(&weight)).then_some(Fit { g1, g2, weight })
}

/// A minimum near `start`, and its value, by the simplex of Nelder and Mead (Comput. J. 7, 308, 1965): reflection 1,
/// expansion 2, contraction and shrinking 1/2, until the values differ by less than 1e-12 of themselves, but after 2000
/// steps at the latest. The same steps on every run.
fn nelder_mead<const N: usize>(start: [f64; N], cost: impl Fn([f64; N]) -> f64) -> ([f64; N], f64) {
    const MOST_STEPS: usize = 2000;
    let at = |p: [f64; N]| (p, cost(p));
    let mut simplex = vec![at(start)];
    for i in 0..N {
        let mut p = start;
        p[i] += 1.0;
        simplex.push(at(p));
    }
    for _ in 0..MOST_STEPS {
        simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
        let (best, worst) = (simplex[0], simplex[N]);
        if worst.1 - best.1 <= 1e-12 * best.1.abs() {
            break;
        }
        let centre: [f64; N] = std::array::from_fn(|i| simplex[..N].iter().map(|(p, _)| p[i]).sum::<f64>() / N as f64);
        let along = |factor: f64| at(std::array::from_fn(|i| centre[i] + factor * (worst.0[i] - centre[i])));
        let reflected = along(-1.0);
        let new = if reflected.1 < best.1 {
            let expanded = along(-2.0);
            if expanded.1 < reflected.1 { expanded } else { reflected }
        } else if reflected.1 < simplex[N - 1].1 {
            reflected
        } else {
            along(if reflected.1 < worst.1 { -0.5 } else { 0.5 })
        };
        if new.1 < worst.1 {
            simplex[N] = new;
        } else {
            for vertex in &mut simplex[1..] {
                *vertex = at(std::array::from_fn(|i| 0.5 * (best.0[i] + vertex.0[i])));
            }
        }
    }
    simplex.sort_by(|a, b| a.1.total_cmp(&b.1));
    simplex[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::aerosol::angles;
    use tables::views::Angles;

    /// A function at the angles at which the tables' are given, its integral 1.
    fn made_whole(function: impl Fn(f64) -> f64) -> (Vec<f64>, Vec<f64>) {
        let angles = Angles::new(&angles::axis().expect("sound")).expect("whole");
        let (phase, _) = angles.phase(angles.cosines().iter().map(|&mu| function(mu)).collect());
        (angles.cosines().to_vec(), phase)
    }

    fn sampled(fit: Fit) -> (Vec<f64>, Vec<f64>) {
        made_whole(|mu| fit.phase(mu))
    }

    #[test]
    fn moments_are_powers_of_the_asymmetry() {
        let fit = Fit { g1: 0.8, g2: -0.4, weight: 0.9 };
        let (cosines, phase) = sampled(fit);
        let moments = Observed::new(&cosines, &phase).moments();
        assert!((fit.asymmetry() - 0.68).abs() < 1e-15);
        for (l, moment) in (1..).zip(moments) {
            let expected = fit.weight * fit.g1.powi(l) + (1.0 - fit.weight) * fit.g2.powi(l);
            // Straight lines between the angles of the tables.
            assert!((moment - expected).abs() < 2e-4, "chi_{l}: {moment}, {expected}");
        }
    }

    #[test]
    fn forms_find_the_function_that_they_contain() {
        let single = Fit::single(0.7);
        let double = Fit { g1: 0.85, g2: -0.5, weight: 0.92 };
        for (fit, forms) in [
            (single, &[Form::Single, Form::FittedSingle][..]),
            (double, &[Form::Moments, Form::Double, Form::FreeDouble][..]),
        ] {
            let (cosines, phase) = sampled(fit);
            let observed = Observed::new(&cosines, &phase);
            for &form in forms {
                let found = observed.fit(form).expect("a fit");
                let close = |a: f64, b: f64| (a - b).abs() < 5e-3;
                // The moments of straight lines differ by 2e-4, and those of two functions stress that.
                assert!(close(found.g1, fit.g1) && close(found.weight, fit.weight), "{form:?}: {found:?}");
                assert!(fit.weight == 1.0 || close(found.g2, fit.g2), "{form:?}: {found:?}");
                let errors = observed.errors(&found);
                assert!(errors.misplaced < 2e-3 && errors.logarithmic < 5e-3, "{form:?}: {errors:?}");
            }
        }
    }

    #[test]
    fn errors_of_isotropic_scattering_are_their_closed_forms() {
        // In place of P = (2 + mu) / 8 pi: half of the integral of |mu| / 8 pi over the sphere is 1/8, P sends 3/8 of the
        // light back, and the relative error is -mu / (2 + mu).
        let cosines: Vec<f64> = (-1000..=1000).map(|i| f64::from(i) / 1000.0).collect();
        let isotropic = Fit::single(0.0);
        let phase: Vec<f64> = cosines.iter().map(|mu| (2.0 + mu) / (8.0 * PI)).collect();
        let observed = Observed::new(&cosines, &phase);
        let errors = observed.errors(&isotropic);
        // integral of (1 - 2/t)^2 dt from 1 to 3, t = 2 + mu: 2 - 4 ln 3 + 4 (1 - 1/3).
        let rms = (0.5 * (2.0 - 4.0 * 3.0_f64.ln() + 8.0 / 3.0)).sqrt();
        // The trapezoidal rule of 2000 intervals.
        assert!((errors.relative - rms).abs() < 1e-5, "{errors:?}, {rms}");
        assert!((errors.misplaced - 0.125).abs() < 1e-6, "{errors:?}");
        assert!((errors.backward - 0.125).abs() < 1e-6 && (observed.backward() - 0.375).abs() < 1e-6, "{errors:?}");
        // 2 / (2 + mu) - 1 is largest straight back.
        assert!((errors.worst - 1.0).abs() < 1e-12, "{errors:?}");
        assert!((observed.moments()[0] - 1.0 / 6.0).abs() < 1e-12);
    }

    #[test]
    fn fits_are_minima() {
        // Something that none of the forms contains.
        let (cosines, phase) = made_whole(|mu| (3.0 * mu).exp() + 0.3 * mu * mu + 0.1);
        let observed = Observed::new(&cosines, &phase);
        let square = |fit: Fit| observed.square(&fit);
        let single = observed.fit(Form::FittedSingle).expect("a fit");
        let free = observed.fit(Form::FreeDouble).expect("a fit");
        for step in [-1e-3, 1e-3] {
            assert!(square(Fit::single(single.g1 + step)) > square(single));
            for moved in [
                Fit { g1: free.g1 + step, ..free },
                Fit { g2: free.g2 + step, ..free },
                Fit { weight: free.weight + step, ..free },
            ] {
                assert!(square(moved) > square(free), "{moved:?}, {free:?}");
            }
        }
        // The more a form may, the less is left.
        let left =
            [Form::Single, Form::FittedSingle, Form::FreeDouble].map(|f| square(observed.fit(f).expect("a fit")));
        assert!(left[0] >= left[1] && left[1] > left[2], "{left:?}");
        let double = observed.fit(Form::Double).expect("a fit");
        assert!(square(double) >= left[2] && (double.asymmetry() - observed.moments()[0]).abs() < 1e-12);
    }

    #[test]
    fn moments_that_no_two_functions_have_give_no_fit() {
        // chi_2 < g^2.
        assert_eq!(two_functions([0.5, 0.2, 0.1]), None);
    }
}
