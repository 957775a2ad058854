//! Values between scattered points, with what they may be off: kriging (Rasmussen & Williams 2006, Gaussian Processes for Machine Learning,
//! algorithm 2.1; equations 5.10 to 5.12 for points left out).
//!
//! Values y_i at points x_i are taken for samples of a random function of mean m and covariance s^2 k(x, x'). With K_ij = k(x_i, x_j),
//! plus the share of noise on the diagonal, at another point the mean is m + k^T K^-1 (y - m) and the variance s^2 (k(x, x) - k^T K^-1 k).

use crate::cholesky::Cholesky;

/// A covariance of any two of the points, factorised.
#[derive(Debug, Clone)]
pub(super) struct Kriging(Cholesky);

/// Variance that is no function of the point, over that which is.
const NOISE: f64 = 0.02;

impl Kriging {
    /// Of `count` points with that covariance, 1 of a point with itself.
    pub(super) fn new(count: usize, covariance: impl Fn(usize, usize) -> f64) -> Self {
        Self(Cholesky::new(count, |i, j| covariance(i, j) + if i == j { NOISE } else { 0.0 }))
    }

    /// K^-1 b.
    pub(super) fn solve(&self, b: &[f64]) -> Vec<f64> {
        self.0.solve(b)
    }

    /// What the covariances `k` with the points leave of a variance of 1, noise included.
    pub(super) fn variance(&self, k: &[f64]) -> f64 {
        (1.0 + NOISE - self.0.forwards(k).iter().map(|x| x * x).sum::<f64>()).max(NOISE)
    }
}

/// Mean of the values, K^-1 (y - m), and s.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    mean: f64,
    weights: Vec<f64>,
    scale: f64,
}

impl Fit {
    /// Of values at the points.
    pub(super) fn new(kriging: &Kriging, values: &[f64]) -> Self {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let off: Vec<f64> = values.iter().map(|value| value - mean).collect();
        let weights = kriging.solve(&off);
        let scale = (off.iter().zip(&weights).map(|(a, b)| a * b).sum::<f64>() / count).max(1e-12).sqrt();
        Self { mean, weights, scale }
    }

    /// Mean and standard deviation where the covariances with the points are `k` and leave the `variance`.
    pub(super) fn at(&self, k: &[f64], variance: f64) -> (f64, f64) {
        let mean = self.mean + self.weights.iter().zip(k).map(|(w, k)| w * k).sum::<f64>();
        (mean, self.scale * variance.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_met_at_points_and_uncertain_away_from_them() {
        let points: Vec<f64> = (0..12).map(f64::from).collect();
        let covariance = |a: f64, b: f64| (-0.5 * ((a - b) / 2.0).powi(2)).exp();
        let kriging = Kriging::new(points.len(), |i, j| covariance(points[i], points[j]));
        let values: Vec<f64> = points.iter().map(|x| (0.5 * x).sin()).collect();
        let fit = Fit::new(&kriging, &values);
        let at = |x: f64| {
            let k: Vec<f64> = points.iter().map(|&p| covariance(p, x)).collect();
            fit.at(&k, kriging.variance(&k))
        };
        // The noise of 2 % keeps the mean off the points a little.
        assert!((at(4.0).0 - 2.0_f64.sin()).abs() < 0.03 && (at(4.5).0 - 2.25_f64.sin()).abs() < 0.03);
        assert!(at(30.0).1 > 3.0 * at(4.5).1, "{:?} {:?}", at(30.0), at(4.5));
    }
}
