//! Legendre polynomials: quadrature, and the moments of phase functions.

use super::{AngularTable, MieError, RefractiveIndex, Spheres, terms};
use std::f64::consts::PI;

/// Nodes and weights of Gauss-Legendre quadrature with `n` points on -1..1, from the largest node down: exact for
/// polynomials up to the degree 2n - 1. Newton's method on P_n from cos(pi (i + 3/4) / (n + 1/2)), weights
/// 2 / ((1 - x^2) P_n'(x)^2) (Abramowitz & Stegun 1964, 25.4.29).
#[must_use]
pub fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |i: usize| {
        let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        // Converges quadratically from so near; the last pass has the slope at the node itself.
        for _ in 0..4 {
            let (value, slope) = polynomial(n, x);
            x -= value / slope;
        }
        let (_, slope) = polynomial(n, x);
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
}

/// P_n(x) and its derivative, for |x| < 1.
fn polynomial(n: usize, x: f64) -> (f64, f64) {
    let (mut p, mut previous) = (1.0, 0.0);
    for k in 0..n {
        let k = k as f64;
        (p, previous) = (((2.0 * k + 1.0) * x * p - k * previous) / (k + 1.0), p);
    }
    (p, n as f64 * (x * p - previous) / (x * x - 1.0))
}

impl Spheres {
    /// The first `count` Legendre moments of the phase function P (integral over the sphere 1) of spheres given as
    /// (size parameter, weight): chi_l = 2 pi integral of P(mu) P_l(mu) d mu, so that
    /// P(mu) = sum (2 l + 1) / (4 pi) chi_l P_l(mu), chi_0 = 1 and chi_1 = g. All are NaN where nothing scatters.
    ///
    /// P is a polynomial of twice the degree of the longest series, so that the quadrature is exact.
    ///
    /// # Errors
    /// [`MieError`] of the first sphere that is out of range.
    pub fn legendre_moments(
        &mut self,
        m: RefractiveIndex,
        spheres: &[(f64, f64)],
        count: usize,
    ) -> Result<Vec<f64>, MieError> {
        let largest = spheres.iter().map(|sphere| sphere.0).fold(0.0, f64::max);
        let order = terms(largest);
        let nodes = gauss_legendre(order + count / 2 + 1);
        let cosines: Vec<f64> = nodes.iter().map(|node| node.0).collect();
        let sums = self.sum(m, spheres.iter().copied(), &AngularTable::new(&cosines, order)?)?;
        let mut moments = vec![0.0; count];
        for (&(x, weight), intensity) in nodes.iter().zip(sums.intensity()) {
            let factor = 2.0 * PI * weight * intensity / sums.scattering;
            let (mut p, mut previous) = (1.0, 0.0);
            for (l, moment) in moments.iter_mut().enumerate() {
                *moment += factor * p;
                let l = l as f64;
                (p, previous) = (((2.0 * l + 1.0) * x * p - l * previous) / (l + 1.0), p);
            }
        }
        Ok(moments)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrature_is_exact_for_polynomials() {
        for n in [1, 2, 5, 64, 1001] {
            let nodes = gauss_legendre(n);
            // One point integrates no square.
            for power in [0, 2, 2 * n as i32 - 2].into_iter().filter(|&power| power < 2 * n as i32) {
                let sum: f64 = nodes.iter().map(|(x, weight)| weight * x.powi(power)).sum();
                let exact = 2.0 / f64::from(power + 1);
                // Rounding of n terms.
                assert!((sum - exact).abs() < 1e-14 * (n as f64).sqrt().max(4.0), "n = {n}, x^{power}: {sum}");
            }
        }
    }

    #[test]
    fn moments_begin_with_one_and_g_and_end() {
        let spheres = [(3.0, 1.0), (20.0, 0.2)];
        let m = RefractiveIndex::new(1.5, 0.01).expect("an index");
        let mut solver = Spheres::new();
        let order = terms(20.0);
        let moments = solver.legendre_moments(m, &spheres, 2 * order + 10).expect("in range");
        let sums = solver.sum(m, spheres, &AngularTable::new(&[], 0).expect("no angles")).expect("in range");
        // Exact quadrature, sums of some fifty terms.
        assert!((moments[0] - 1.0).abs() < 1e-13, "{}", moments[0]);
        assert!((moments[1] - sums.forward / sums.scattering).abs() < 1e-13, "{}", moments[1]);
        // A polynomial of degree 2N has no higher moments.
        assert!(moments[2 * order + 1..].iter().all(|chi| chi.abs() < 1e-13), "{:?}", &moments[2 * order + 1..]);
    }

    #[test]
    fn moments_rebuild_the_phase_function() {
        let m = RefractiveIndex::new(1.33, 0.0).expect("an index");
        let mut solver = Spheres::new();
        let moments = solver.legendre_moments(m, &[(5.0, 1.0)], 2 * terms(5.0) + 2).expect("in range");
        let cosines = [-1.0, -0.2, 0.5, 1.0];
        let table = AngularTable::new(&cosines, terms(5.0)).expect("cosines");
        let sums = solver.sum(m, [(5.0, 1.0)], &table).expect("in range");
        for (x, intensity) in cosines.iter().zip(sums.intensity()) {
            let (mut p, mut previous, mut sum) = (1.0, 0.0, 0.0);
            for (l, chi) in moments.iter().enumerate() {
                let l = l as f64;
                sum += (2.0 * l + 1.0) / (4.0 * PI) * chi * p;
                (p, previous) = (((2.0 * l + 1.0) * x * p - l * previous) / (l + 1.0), p);
            }
            let expected = intensity / sums.scattering;
            // Sums of some thirty terms of alternating sign, up to a thousand times the result.
            assert!((sum / expected - 1.0).abs() < 1e-11, "{x}: {sum}, {expected}");
        }
    }
}
