//! Fewer orders: the next field from the last few, such that another order would change it least.
//!
//! The field is the fixed point of x -> g(x), first order plus one more scattering. From the last fields x_i and what
//! became of them, f_i = g(x_i) - x_i, Anderson (1965) takes x = sum_i a_i g(x_i) with sum_i a_i = 1 that makes |sum_i a_i f_i|
//! least: since g is linear, as good as GMRES with as many vectors. Each wavelength has its own a_i. Numbers are weighed by the
//! first order's mean radiance at the same place, so that twilight counts as much as day.

use super::orders::Field;

/// How many fields are kept beside the present one.
const KEPT: usize = 4;

/// Share of the brightest place's light below which a place counts less and less.
const FAINT: f32 = 1e-6;

/// The last fields.
pub(super) struct Mixer<const L: usize> {
    /// 1 / scale of each number, wavelengths together.
    weights: Vec<[f32; L]>,
    kept: Vec<Former<L>>,
}

/// A field that was: g(x) and f.
struct Former<const L: usize> {
    became: Vec<[f32; L]>,
    change: Vec<[f32; L]>,
}

fn numbers<const L: usize>(field: &Field<L>) -> impl Iterator<Item = &[f32; L]> {
    field.moments.iter().chain(&field.ground)
}

impl<const L: usize> Mixer<L> {
    /// For a field with that first order, of so many moments.
    pub(super) fn new(first: &Field<L>, moments: usize) -> Self {
        let mut most = [0.0_f32; L];
        for row in first.moments.iter().step_by(moments) {
            for (most, value) in most.iter_mut().zip(row) {
                *most = most.max(*value);
            }
        }
        let weight = |scale: &[f32; L]| std::array::from_fn(|j| 1.0 / (scale[j].max(0.0) + FAINT * most[j] + 1e-30));
        let mut weights = Vec::with_capacity(first.moments.len() + first.ground.len());
        for place in first.moments.chunks(moments) {
            weights.extend(std::iter::repeat_n(weight(&place[0]), place.len()));
        }
        let suns = first.ground.len();
        weights.extend(first.moments.chunks(moments).take(suns).map(|place| weight(&place[0])));
        Self { weights, kept: Vec::new() }
    }

    /// Root mean square of the weighed change from `field` to `next`, of the wavelength with the largest.
    pub(super) fn change(&self, field: &Field<L>, next: &Field<L>) -> f64 {
        let mut sums = [0.0_f64; L];
        for ((a, b), weight) in numbers(field).zip(numbers(next)).zip(&self.weights) {
            for j in 0..L {
                sums[j] += f64::from((b[j] - a[j]) * weight[j]).powi(2);
            }
        }
        (sums.iter().copied().fold(0.0, f64::max) / self.weights.len() as f64).sqrt()
    }

    /// The field to go on from, after `next` = g(`field`).
    pub(super) fn mix(&mut self, field: Field<L>, next: Field<L>) -> Field<L> {
        let suns = next.ground.len();
        let new: Vec<[f32; L]> = numbers(&next).copied().collect();
        let change: Vec<[f32; L]> =
            numbers(&field).zip(&new).map(|(a, b)| std::array::from_fn(|j| b[j] - a[j])).collect();
        let mut mixed = new.clone();
        let count = self.kept.len();
        if count > 0 {
            // Normal equations of the least squares in the differences f_i - f, for each wavelength.
            let mut matrix = [[[0.0_f64; L]; KEPT + 1]; KEPT];
            for (i, weight) in self.weights.iter().enumerate() {
                let mut rows = [[0.0_f32; L]; KEPT];
                for (row, old) in rows.iter_mut().zip(&self.kept) {
                    *row = std::array::from_fn(|j| (old.change[i][j] - change[i][j]) * weight[j]);
                }
                for a in 0..count {
                    for b in a..count {
                        for j in 0..L {
                            matrix[a][b][j] += f64::from(rows[a][j] * rows[b][j]);
                        }
                    }
                    for j in 0..L {
                        matrix[a][KEPT][j] -= f64::from(rows[a][j] * change[i][j] * weight[j]);
                    }
                }
            }
            let mut shares = [[0.0_f32; L]; KEPT];
            for j in 0..L {
                let solution = solve(count, |a, b| matrix[a.min(b)][a.max(b)][j], |a| matrix[a][KEPT][j]);
                for (share, value) in shares.iter_mut().zip(solution) {
                    share[j] = value as f32;
                }
            }
            for (share, old) in shares.iter().zip(&self.kept) {
                for ((sum, old), new) in mixed.iter_mut().zip(&old.became).zip(&new) {
                    for j in 0..L {
                        sum[j] += share[j] * (old[j] - new[j]);
                    }
                }
            }
        }
        if self.kept.len() == KEPT {
            self.kept.remove(0);
        }
        self.kept.push(Former { became: new, change });
        let ground = mixed.split_off(mixed.len() - suns);
        Field { moments: mixed, ground }
    }
}

/// Solves a small symmetric system by elimination, a little damped.
fn solve(count: usize, matrix: impl Fn(usize, usize) -> f64, right: impl Fn(usize) -> f64) -> [f64; KEPT] {
    let mut rows = [[0.0; KEPT + 1]; KEPT];
    for (a, row) in rows.iter_mut().enumerate().take(count) {
        for (b, value) in row.iter_mut().enumerate().take(count) {
            *value = matrix(a, b) * if a == b { 1.0 + 1e-10 } else { 1.0 };
        }
        row[KEPT] = right(a);
    }
    for pivot in 0..count {
        let scale = rows[pivot][pivot];
        if scale <= 0.0 {
            continue;
        }
        for below in pivot + 1..count {
            let factor = rows[below][pivot] / scale;
            for column in pivot..=KEPT {
                rows[below][column] -= factor * rows[pivot][column];
            }
        }
    }
    let mut solution = [0.0; KEPT];
    for a in (0..count).rev() {
        let known: f64 = (a + 1..count).map(|b| rows[a][b] * solution[b]).sum();
        solution[a] = if rows[a][a] > 0.0 { (rows[a][KEPT] - known) / rows[a][a] } else { 0.0 };
    }
    solution
}
