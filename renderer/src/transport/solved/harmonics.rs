//! Angular moments: real spherical harmonics that are even in the azimuth.
//!
//! With the semi-normalised functions of Schmidt,
//! S_lm(mu) = sqrt((2 - delta_m0) (l - m)! / (l + m)!) P_l^m(mu) without the sign (-1)^m,
//! the addition theorem has no factors: for two directions with the azimuths phi and phi'
//! P_l(cos Theta) = sum_m S_lm(mu) S_lm(mu') cos(m (phi - phi')).

use std::ops::Range;

/// Number of the moments that molecules need: (l, m) = (0, 0), (2, 0), (2, 1), (2, 2).
pub(super) const RAYLEIGH: usize = 4;

/// The moments of a field, those that molecules need first, then by their orders m.
#[derive(Debug, Clone)]
pub(super) struct Moments {
    /// Degree l and order m of each.
    pairs: Vec<(usize, usize)>,
    /// Which of them follow each other with the same m.
    runs: Vec<(usize, Range<usize>)>,
    /// Which source each goes with: its degree, but see [`Moments::apart`].
    sources: Vec<usize>,
    degree: usize,
    polarised: bool,
    /// Of m and of l.
    steps: Vec<Step>,
    /// Moments that have the function of an earlier one.
    twins: Vec<(usize, usize)>,
}

impl Moments {
    /// All degrees up to `degree`, but for 1 where 2 is the last: molecules do without. Of polarised light the first are those of vector
    /// harmonics, and other scatterers have their own of degree 2 beside them.
    pub(super) fn new(degree: usize, polarised: bool) -> Self {
        let mut pairs = vec![(0, 0), (2, 0), (2, 1), (2, 2)];
        if degree > 2 {
            let all = (0..=degree).flat_map(|m| (m..=degree).map(move |l| (l, m)));
            pairs.extend(all.filter(|&(l, _)| l == 1 || l > 2 || (l == 2 && polarised)));
        }
        let degree = degree.max(2);
        let mut runs: Vec<(usize, Range<usize>)> = Vec::new();
        for (i, &(_, m)) in pairs.iter().enumerate() {
            match runs.last_mut() {
                Some((last, run)) if *last == m => run.end = i + 1,
                _ => runs.push((m, i..i + 1)),
            }
        }
        let step = |m: usize, l: usize| {
            if l < m { Step::default() } else { Step::to(l, m, pairs.iter().position(|pair| *pair == (l, m))) }
        };
        let steps = (0..=degree).flat_map(|m| (0..=degree).map(move |l| (m, l))).map(|(m, l)| step(m, l)).collect();
        let twin = |i: usize| Some((pairs[..RAYLEIGH].iter().position(|pair| *pair == pairs[i])?, i));
        // In the order of m, since the pairs are.
        let twins: Vec<_> = (RAYLEIGH..pairs.len()).filter_map(twin).collect();
        let source = |i: usize| if twins.iter().any(|(_, twin)| *twin == i) { degree + 1 } else { pairs[i].0 };
        let sources = (0..pairs.len()).map(source).collect();
        Self { pairs, runs, sources, degree, polarised, steps, twins }
    }

    /// Whether they are of polarised light.
    pub(super) fn polarised(&self) -> bool {
        self.polarised
    }

    /// Which source each goes with: those of the degrees, and that which is [`Moments::apart`].
    pub(super) fn sources(&self) -> &[usize] {
        &self.sources
    }

    /// Where radiance has its own moment (2, m) beside that of vector harmonics.
    pub(super) fn twin(&self, m: usize) -> Option<usize> {
        self.twins.get(m).map(|(_, twin)| *twin)
    }

    /// How many sources there are.
    pub(super) fn width(&self) -> usize {
        self.apart().unwrap_or(self.degree) + 1
    }

    /// Which of these moments is that moment of others.
    pub(super) fn place_of(&self, others: &Self, moment: usize) -> Option<usize> {
        let of = |moments: &Self, i: usize| (moments.pairs[i], moments.twins.iter().any(|(_, twin)| *twin == i));
        (0..self.count()).find(|&i| of(self, i) == of(others, moment))
    }

    /// The source of degree 2 of all scatterers but molecules, if they have their own.
    pub(super) fn apart(&self) -> Option<usize> {
        (!self.twins.is_empty()).then_some(self.degree + 1)
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.pairs.len()
    }

    /// The highest degree.
    pub(super) fn degree(&self) -> usize {
        self.degree
    }

    /// Degree and order of each.
    pub(super) fn pairs(&self) -> &[(usize, usize)] {
        &self.pairs
    }

    /// How many come before the first of an order m of so many or more: all with fewer.
    pub(super) fn count_below(&self, orders: usize) -> usize {
        self.pairs.iter().position(|&(_, m)| m >= orders.max(3)).unwrap_or(self.pairs.len())
    }

    /// Of the first `count`, which follow each other with the same m.
    #[inline(always)]
    pub(super) fn runs(&self, count: usize) -> impl Iterator<Item = (usize, Range<usize>)> {
        self.runs.iter().take_while(move |(_, run)| run.start < count).map(|(m, run)| (*m, run.clone()))
    }

    /// S_lm(mu) of each: S_mm = sqrt((2m - 1) / (2m)) sin S_(m-1)(m-1), and from there
    /// sqrt(l^2 - m^2) S_lm = (2l - 1) mu S_(l-1)m - sqrt((l - 1)^2 - m^2) S_(l-2)m.
    #[inline(always)]
    pub(super) fn at(&self, mu: f64, values: &mut Vec<f64>) {
        let sine = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
        let width = self.degree + 1;
        values.clear();
        values.resize(self.pairs.len(), 0.0);
        let mut diagonal = 1.0;
        for (m, steps) in self.steps.chunks_exact(width).enumerate() {
            diagonal *= if m > 0 { sine * steps[m].by_mu } else { 1.0 };
            let (mut before, mut value) = (0.0, diagonal);
            for (l, step) in steps.iter().enumerate().skip(m) {
                if l > m {
                    (before, value) = (value, step.by_mu * mu * value - step.by_before * before);
                }
                if let Some(place) = step.place {
                    values[place] = value;
                }
            }
        }
        for &(first, twin) in &self.twins {
            values[twin] = values[first];
        }
    }
}

/// One step of the recurrences: to (l, m) from (l - 1, m) and (l - 2, m), or to (m, m) from (m - 1, m - 1).
#[derive(Debug, Clone, Copy, Default)]
struct Step {
    by_mu: f64,
    by_before: f64,
    /// Where the value belongs among the pairs.
    place: Option<usize>,
}

impl Step {
    fn to(l: usize, m: usize, place: Option<usize>) -> Self {
        let (n, k) = (l as f64, m as f64);
        if l == m {
            let by_mu = if m > 1 { ((2.0 * k - 1.0) / (2.0 * k)).sqrt() } else { 1.0 };
            return Self { by_mu, by_before: 0.0, place };
        }
        let root = (n * n - k * k).sqrt();
        let before = ((n - 1.0) * (n - 1.0) - k * k).max(0.0).sqrt();
        Self { by_mu: (2.0 * n - 1.0) / root, by_before: before / root, place }
    }
}

/// The highest degree that is possible.
pub(super) const MOST_DEGREE: usize = 24;

/// Legendre polynomials P_0 to P_degree at `c`.
#[inline(always)]
pub(super) fn legendre(degree: usize, c: f64) -> Vec<f64> {
    let mut values = vec![1.0, c];
    for l in 2..=degree {
        let n = l as f64;
        values.push(((2.0 * n - 1.0) * c * values[l - 1] - (n - 1.0) * values[l - 2]) / n);
    }
    values.truncate(degree + 1);
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_addition_theorem_holds() {
        let moments = Moments::new(12, false);
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for (mu, nu, phi) in [(0.3, -0.9, 0.7_f64), (1.0, 0.2, 2.0), (-0.5, -0.5, 3.1), (0.0, 0.99, 1.2)] {
            moments.at(mu, &mut a);
            moments.at(nu, &mut b);
            let cosine = mu * nu + ((1.0_f64 - mu * mu) * (1.0 - nu * nu)).sqrt() * phi.cos();
            let exact = legendre(12, cosine);
            for (l, exact) in exact.iter().enumerate() {
                let pairs = moments.pairs().iter().zip(a.iter().zip(&b)).filter(|((k, _), _)| *k == l);
                let sum: f64 = pairs.map(|((_, m), (a, b))| a * b * (*m as f64 * phi).cos()).sum();
                // Rounding of recurrences of twelve steps.
                assert!((sum - exact).abs() < 1e-13, "degree {l}: {sum}, {exact}");
            }
        }
    }
}
