//! A symmetric positive definite matrix, factorised (Golub & Van Loan 2013, Matrix Computations, section 4.2).

/// L of K = L L^T.
#[derive(Debug, Clone)]
pub(crate) struct Cholesky {
    /// Row by row, up to the diagonal.
    rows: Vec<Vec<f64>>,
}

impl Cholesky {
    /// Of a matrix of `count` rows with the elements K_ij for j up to i. What rounding leaves of a pivot is never below what it may be off.
    pub(crate) fn new(count: usize, element: impl Fn(usize, usize) -> f64) -> Self {
        let mut rows: Vec<Vec<f64>> = Vec::with_capacity(count);
        for i in 0..count {
            let mut row = vec![0.0; i + 1];
            for j in 0..i {
                row[j] = (element(i, j) - dot(&row[..j], &rows[j])) / rows[j][j];
            }
            let diagonal = element(i, i);
            row[i] = (diagonal - dot(&row[..i], &row[..i])).max(f64::EPSILON * diagonal).sqrt();
            rows.push(row);
        }
        Self { rows }
    }

    /// How many rows it has.
    pub(crate) fn count(&self) -> usize {
        self.rows.len()
    }

    /// L^-1 b.
    pub(crate) fn forwards(&self, b: &[f64]) -> Vec<f64> {
        let mut x: Vec<f64> = Vec::with_capacity(b.len());
        for (row, b) in self.rows.iter().zip(b) {
            x.push((b - dot(&x, row)) / row[x.len()]);
        }
        x
    }

    /// K^-1 b.
    pub(crate) fn solve(&self, b: &[f64]) -> Vec<f64> {
        let mut x = self.forwards(b);
        for i in (0..x.len()).rev() {
            let sum: f64 = (i + 1..x.len()).map(|k| self.rows[k][i] * x[k]).sum();
            x[i] = (x[i] - sum) / self.rows[i][i];
        }
        x
    }
}

/// The sum of the products of what both have.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_solved_for_fulfils_the_equations() {
        // Hilbert's matrix of 5 x 5: its condition is 5e5, so 1e-16 becomes some 1e-11.
        let element = |i: usize, j: usize| 1.0 / (i + j + 1) as f64;
        let x = Cholesky::new(5, element).solve(&[1.0, -2.0, 0.5, 3.0, 1.5]);
        for (i, b) in [1.0, -2.0, 0.5, 3.0, 1.5].into_iter().enumerate() {
            let sum: f64 = (0..5).map(|j| element(i, j) * x[j]).sum();
            assert!((sum - b).abs() < 1e-10, "{sum} for {b}");
        }
    }
}
