//! Values between scattered points, with what they may be off: kriging (Rasmussen & Williams 2006, Gaussian Processes for Machine Learning,
//! algorithm 2.1; equations 5.10 to 5.12 for points left out).
//!
//! Values y_i at points x_i are taken for samples of a random function of mean m and covariance s^2 k(x, x'). With K_ij = k(x_i, x_j),
//! plus the share of noise on the diagonal, at another point the mean is m + k^T K^-1 (y - m) and the variance s^2 (k(x, x) - k^T K^-1 k).

use crate::cholesky::Cholesky;
use std::ops::Range;

/// A covariance of any two of the points, factorised.
#[derive(Debug, Clone)]
pub(super) struct Kriging(Cholesky);

/// Variance that is no function of the point, over that which is.
const NOISE: f64 = 0.005;

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

    /// Some of the points, predicted from the others.
    pub(super) fn without(&self, points: Range<usize>) -> Without {
        let columns: Vec<_> = points.clone().map(|i| self.0.column(i)).collect();
        let block = Cholesky::new(points.len(), |i, j| Cholesky::inverse((i, &columns[i]), (j, &columns[j])));
        let own: Vec<_> = (0..points.len()).map(|i| block.column(i)).collect();
        let variances = own.iter().enumerate().map(|(i, own)| Cholesky::inverse((i, own), (i, own))).collect();
        Without { points, block, variances }
    }
}

/// Points left out together: with their block B of K^-1 the others predict y - B^-1 (K^-1 (y - m)), of the variance s^2 (B^-1)_ii. Of a
/// single point that is equation 5.12; m and s are those of all.
#[derive(Debug, Clone)]
pub(super) struct Without {
    pub(super) points: Range<usize>,
    /// B.
    block: Cholesky,
    /// The diagonal of B^-1: what the others leave of a variance of 1.
    pub(super) variances: Vec<f64>,
}

impl Without {
    /// Mean and standard deviation at each of the points.
    pub(super) fn predicted(&self, fit: &Fit) -> Vec<(f64, f64)> {
        let off = self.block.solve(&fit.weights[self.points.clone()]);
        let values = &fit.values[self.points.clone()];
        let means = values.iter().zip(off).map(|(value, off)| value - off);
        means.zip(&self.variances).map(|(mean, variance)| (mean, fit.scale * variance.sqrt())).collect()
    }
}

/// Values y, their mean m, K^-1 (y - m), and s.
#[derive(Debug, Clone)]
pub(super) struct Fit {
    pub(super) values: Vec<f64>,
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
        Self { values: values.to_vec(), mean, weights, scale }
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
        // The noise keeps the mean off the points a little.
        assert!((at(4.0).0 - 2.0_f64.sin()).abs() < 0.03 && (at(4.5).0 - 2.25_f64.sin()).abs() < 0.03);
        assert!(at(30.0).1 > 3.0 * at(4.5).1, "{:?} {:?}", at(30.0), at(4.5));
    }

    #[test]
    fn points_left_out_are_predicted_as_if_they_had_never_been() {
        let points: Vec<f64> = (0..9).map(|i| f64::from(i * i) / 8.0).collect();
        let covariance = |a: f64, b: f64| (-(a - b).abs() / 2.0).exp();
        let values: Vec<f64> = points.iter().map(|x| x.cos()).collect();
        let (all, left_out) = (Kriging::new(9, |i, j| covariance(points[i], points[j])), 3..6);
        let fit = Fit::new(&all, &values);
        let others: Vec<usize> = (0..9).filter(|i| !left_out.contains(i)).collect();
        let few = Kriging::new(others.len(), |i, j| covariance(points[others[i]], points[others[j]]));
        // With the mean and the scale of all.
        let off: Vec<f64> = others.iter().map(|&i| values[i] - fit.mean).collect();
        let fewer = Fit { values: Vec::new(), mean: fit.mean, weights: few.solve(&off), scale: fit.scale };
        for (i, (mean, deviation)) in left_out.clone().zip(all.without(left_out).predicted(&fit)) {
            let k: Vec<f64> = others.iter().map(|&j| covariance(points[i], points[j])).collect();
            let right = fewer.at(&k, few.variance(&k));
            assert!(
                (mean - right.0).abs() < 1e-12 && (deviation - right.1).abs() < 1e-12,
                "{mean} {deviation} {right:?}"
            );
        }
    }
}
