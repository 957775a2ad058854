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

    /// Of L^-1 the column of that number, from its row on: above it there is nothing.
    pub(crate) fn column(&self, number: usize) -> Vec<f64> {
        let mut x: Vec<f64> = Vec::with_capacity(self.count() - number);
        for row in &self.rows[number..] {
            let unit = f64::from(u8::from(x.is_empty()));
            x.push((unit - dot(&x, &row[number..])) / row[number + x.len()]);
        }
        x
    }

    /// (K^-1)_ij = sum_k (L^-1)_ki (L^-1)_kj, by such columns of i and of j.
    pub(crate) fn inverse((i, one): (usize, &[f64]), (j, other): (usize, &[f64])) -> f64 {
        let first = i.max(j);
        dot(&one[first - i..], &other[first - j..])
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
        for (i, row) in self.rows.iter().enumerate().rev() {
            let found = x[i] / row[i];
            x[i] = found;
            x.iter_mut().zip(&row[..i]).for_each(|(x, one)| *x -= one * found);
        }
        x
    }
}

/// The sum of the products of what both have: eight sums side by side, as vectors have them.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let count = a.len().min(b.len());
    let ((a, a_rest), (b, b_rest)) = (a[..count].as_chunks::<8>(), b[..count].as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (a, b) in a.iter().zip(b) {
        for j in 0..8 {
            sums[j] += a[j] * b[j];
        }
    }
    sums.iter().sum::<f64>() + a_rest.iter().zip(b_rest).map(|(a, b)| a * b).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_equations_are_solved_too() {
        // K_ij = r^|i - j| has the inverse (1 + r^2) / (1 - r^2) on the diagonal, 1 / (1 - r^2) at its ends, -r / (1 - r^2) beside it: to the
        // rounding of some forty steps.
        const COUNT: usize = 37;
        let r = 0.7_f64;
        let all = Cholesky::new(COUNT, |i, j| r.powi(i.abs_diff(j) as i32));
        let right = |i: usize, j: usize| match i.abs_diff(j) {
            0 if i.is_multiple_of(COUNT - 1) => 1.0 / (1.0 - r * r),
            0 => (1.0 + r * r) / (1.0 - r * r),
            1 => -r / (1.0 - r * r),
            _ => 0.0,
        };
        let columns: Vec<_> = (0..COUNT).map(|j| all.column(j)).collect();
        for j in [0, 20, COUNT - 1] {
            let unit: Vec<f64> = (0..COUNT).map(|i| f64::from(u8::from(i == j))).collect();
            for (i, x) in all.solve(&unit).into_iter().enumerate() {
                let inverse = Cholesky::inverse((i, &columns[i]), (j, &columns[j]));
                assert!((x - right(i, j)).abs() < 1e-13 && (inverse - x).abs() < 1e-13, "{i} {j}: {x} {inverse}");
            }
        }
    }

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
