//! Angular moments: real spherical harmonics that are even in the azimuth.
//!
//! With the semi-normalised functions of Schmidt,
//! S_lm(mu) = sqrt((2 - delta_m0) (l - m)! / (l + m)!) P_l^m(mu) without the sign (-1)^m,
//! the addition theorem has no factors: for two directions with the azimuths phi and phi'
//! P_l(cos Theta) = sum_m S_lm(mu) S_lm(mu') cos(m (phi - phi')).

/// Number of the moments that molecules need: (l, m) = (0, 0), (2, 0), (2, 1), (2, 2).
pub(super) const RAYLEIGH: usize = 4;

/// The moments of a field, those that molecules need first.
#[derive(Debug, Clone)]
pub(super) struct Moments {
    /// Degree l and order m of each.
    pairs: Vec<(usize, usize)>,
    degree: usize,
}

impl Moments {
    /// All degrees up to `degree`, but for 1 where 2 is the last: molecules do without.
    pub(super) fn new(degree: usize) -> Self {
        let mut pairs = vec![(0, 0), (2, 0), (2, 1), (2, 2)];
        if degree > 2 {
            pairs.extend([(1, 0), (1, 1)]);
            pairs.extend((3..=degree).flat_map(|l| (0..=l).map(move |m| (l, m))));
        }
        Self { pairs, degree: degree.max(2) }
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

    /// S_lm(mu) of each.
    pub(super) fn at(&self, mu: f64, values: &mut Vec<f64>) {
        let sine = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
        let width = self.degree + 1;
        // S_lm at [m * width + l].
        let mut table = [0.0; (MOST_DEGREE + 1) * (MOST_DEGREE + 1)];
        let mut diagonal = 1.0;
        for m in 0..width {
            if m > 0 {
                let m = m as f64;
                diagonal *= sine * if m > 1.0 { ((2.0 * m - 1.0) / (2.0 * m)).sqrt() } else { 1.0 };
            }
            let row = &mut table[m * width..(m + 1) * width];
            row[m] = diagonal;
            for l in m + 1..width {
                let before = if l > m + 1 { row[l - 2] } else { 0.0 };
                let (lf, mf) = (l as f64, m as f64);
                let root = ((lf - 1.0) * (lf - 1.0) - mf * mf).sqrt();
                row[l] = ((2.0 * lf - 1.0) * mu * row[l - 1] - root * before) / (lf * lf - mf * mf).sqrt();
            }
        }
        values.clear();
        values.extend(self.pairs.iter().map(|&(l, m)| table[m * width + l]));
    }
}

/// The highest degree that is possible.
pub(super) const MOST_DEGREE: usize = 24;

/// Legendre polynomials P_0 to P_degree at `c`.
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
        let moments = Moments::new(12);
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
