//! The angular functions pi_n = P_n^1(mu) / sin(theta) and tau_n = d P_n^1(mu) / d theta, mu = cos(theta).

use super::MieError;

/// Orders that are summed at once.
pub(super) const RUN: usize = 4;

/// pi_n and tau_n at one angle, n = 1, 2, 3, ... in turn.
///
/// In the form of Wiscombe (1980): with s = mu pi_n and t = s - pi_(n-1),
/// tau_n = n t - pi_(n-1) and pi_(n+1) = s + (1 + 1/n) t. At mu = 1 and -1 only whole
/// numbers occur, up to 2^53 exactly.
#[derive(Debug, Clone)]
pub(super) struct Functions {
    cosine: f64,
    n: f64,
    previous: f64,
    current: f64,
}

impl Functions {
    /// Before n = 1.
    pub(super) fn new(cosine: f64) -> Result<Self, MieError> {
        if (-1.0..=1.0).contains(&cosine) {
            Ok(Self { cosine, n: 1.0, previous: 0.0, current: 1.0 })
        } else {
            Err(MieError::Cosine { cosine })
        }
    }

    /// (2n + 1) / (n (n + 1)) of the n whose functions come next.
    #[inline]
    pub(super) fn weight(&self) -> f64 {
        (2.0 * self.n + 1.0) / (self.n * (self.n + 1.0))
    }

    /// pi_n and tau_n, and on to n + 1.
    #[inline]
    pub(super) fn advance(&mut self) -> (f64, f64) {
        let s = self.cosine * self.current;
        let t = s - self.previous;
        let result = (self.current, self.n * t - self.previous);
        self.previous = self.current;
        self.current = s + t + t / self.n;
        self.n += 1.0;
        result
    }
}

/// pi_n + tau_n and pi_n - tau_n at many angles, for sums over many spheres.
#[derive(Debug, Clone)]
pub struct AngularTable {
    cosines: Vec<f64>,
    terms: usize,
    /// pi_n + tau_n at all angles, for each order, up to a whole number of runs.
    plus: Vec<f64>,
    /// pi_n - tau_n, the same.
    minus: Vec<f64>,
}

impl AngularTable {
    /// The functions of the orders 1 ..= `terms` at the angles with these cosines.
    ///
    /// # Errors
    /// [`MieError::Cosine`] for a cosine outside -1..=1.
    pub fn new(cosines: &[f64], terms: usize) -> Result<Self, MieError> {
        let mut functions = cosines.iter().map(|&c| Functions::new(c)).collect::<Result<Vec<_>, _>>()?;
        let length = terms.next_multiple_of(RUN) * cosines.len();
        let (mut plus, mut minus) = (Vec::with_capacity(length), Vec::with_capacity(length));
        for _ in 0..terms.next_multiple_of(RUN) {
            for functions in &mut functions {
                let (pi, tau) = functions.advance();
                plus.push(pi + tau);
                minus.push(pi - tau);
            }
        }
        Ok(Self { cosines: cosines.to_vec(), terms, plus, minus })
    }

    /// Cosines of the angles.
    #[must_use]
    pub fn cosines(&self) -> &[f64] {
        &self.cosines
    }

    /// Orders that it holds.
    #[must_use]
    pub fn terms(&self) -> usize {
        self.terms
    }

    /// pi_n + tau_n and pi_n - tau_n of one run of orders after the other, each order's angles in a row.
    pub(super) fn runs(&self) -> impl Iterator<Item = (&[f64], &[f64])> {
        let length = (RUN * self.cosines.len()).max(1);
        self.plus.chunks_exact(length).zip(self.minus.chunks_exact(length))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn low_orders_are_their_closed_forms() {
        // Bohren & Huffman 1983, section 4.3.1: pi_2 = 3 mu, pi_3 = (15 mu^2 - 3)/2, tau_1 = mu,
        // tau_2 = 3 cos(2 theta), tau_3 = mu (45 mu^2 - 33)/2.
        for theta in [0.0_f64, 0.3, 1.2, 2.9] {
            let mu = theta.cos();
            let mut f = Functions::new(mu).expect("a cosine");
            let found = [f.advance(), f.advance(), f.advance()];
            let exact = [
                (1.0, mu),
                (3.0 * mu, 3.0 * (2.0 * theta).cos()),
                ((15.0 * mu * mu - 3.0) / 2.0, mu * (45.0 * mu * mu - 33.0) / 2.0),
            ];
            for (n, (found, exact)) in found.into_iter().zip(exact).enumerate() {
                // Rounding of sums of two terms below 25.
                let close = (found.0 - exact.0).abs() < 2e-14 && (found.1 - exact.1).abs() < 2e-14;
                assert!(close, "order {} at {theta}: {found:?}, {exact:?}", n + 1);
            }
        }
    }

    #[test]
    fn both_ends_are_whole_numbers() {
        let (mut ahead, mut back) = (Functions::new(1.0).expect("a cosine"), Functions::new(-1.0).expect("a cosine"));
        for n in 1..=3000_u32 {
            let value = f64::from(n) * (f64::from(n) + 1.0) / 2.0;
            let sign = if n % 2 == 1 { 1.0 } else { -1.0 };
            assert_eq!(ahead.advance(), (value, value), "order {n}");
            assert_eq!(back.advance(), (sign * value, -sign * value), "order {n}");
        }
    }

    #[test]
    fn what_is_no_cosine_is_refused() {
        assert!(AngularTable::new(&[0.0, 1.1], 3).is_err() && Functions::new(f64::NAN).is_err());
    }
}
