//! Fewer orders: the next field from the last few, such that another order would change it least.
//!
//! The field is the fixed point of x -> g(x), first order plus one more scattering. From the last fields x_i and what
//! became of them, f_i = g(x_i) - x_i, Anderson (1965) takes x = sum_i a_i g(x_i) with sum_i a_i = 1 that makes |sum_i a_i f_i|
//! least: since g is linear, as good as GMRES with as many vectors. Each wavelength has its own a_i. Numbers are weighed by the
//! mean radiance at the same place, so that twilight counts as much as day.
//!
//! And since g is linear, sum_i a_i f_i is what another order would change sum_i a_i x_i by, which is known without one.

use super::orders::Field;
use crate::vectors::{add_product, vectorised};
use pulp::NullaryFnOnce;

/// How many fields are kept beside the present one.
const KEPT: usize = 4;

/// Share of the brightest place's light below which a place counts less and less: with the sun some 8 degrees below the horizon.
const FAINT: f32 = 3e-6;

/// The last fields.
pub(super) struct Mixer<const L: usize> {
    /// Moments at a place.
    moments: usize,
    /// 1 / scale of the numbers at each place.
    weights: Vec<[f32; L]>,
    kept: Vec<Former<L>>,
}

/// A field that was: g(x), and f of the moments.
struct Former<const L: usize> {
    became: Field<L>,
    change: Vec<[f32; L]>,
}

/// Of each wavelength the normal equations of a_i in the differences f_i - f, their right sides last, and the square of f.
struct Sums<const L: usize> {
    matrix: [[[f64; L]; KEPT + 1]; KEPT],
    square: [f64; L],
}

impl<const L: usize> Mixer<L> {
    /// For fields like this one, of so many moments at a place.
    pub(super) fn new(field: &Field<L>, moments: usize) -> Self {
        let mut most = [0.0_f32; L];
        for row in field.moments.iter().step_by(moments) {
            for (most, value) in most.iter_mut().zip(row) {
                *most = most.max(*value);
            }
        }
        let weight = |mean: &[f32; L]| std::array::from_fn(|j| 1.0 / (mean[j].abs() + FAINT * most[j] + 1e-30));
        Self { moments, weights: field.moments.iter().step_by(moments).map(weight).collect(), kept: Vec::new() }
    }

    /// The field to go on from, after `next` = g(`field`), and by how much another order would change the mixture of the fields
    /// from which it comes: root mean square of the weighed change, of the wavelength with the largest.
    pub(super) fn mix(&mut self, field: Field<L>, next: Field<L>) -> (Field<L>, f64) {
        let change = vectorised::<L, _>(Change { moments: field.moments, next: &next.moments });
        let sums = vectorised::<L, _>(Equations { mixer: self, change: &change });
        let count = self.kept.len();
        let mut shares = [[0.0_f32; L]; KEPT];
        let mut worst = 0.0_f64;
        for j in 0..L {
            let Sums { matrix, square } = &sums;
            let solution = solve(count, |a, b| matrix[a.min(b)][a.max(b)][j], |a| matrix[a][KEPT][j]);
            let mut left = square[j];
            for ((share, value), row) in shares.iter_mut().zip(solution).zip(matrix) {
                share[j] = value as f32;
                left -= value * row[KEPT][j];
            }
            worst = worst.max(left);
        }
        let mixed = vectorised::<L, _>(Mixture { kept: &self.kept, shares, next: &next });
        if self.kept.len() == KEPT {
            self.kept.remove(0);
        }
        let residual = (worst / change.len() as f64).sqrt();
        self.kept.push(Former { became: next, change });
        (mixed, residual)
    }
}

/// f = g(x) - x, in the place of x.
struct Change<'a, const L: usize> {
    moments: Vec<[f32; L]>,
    next: &'a [[f32; L]],
}

impl<const L: usize> NullaryFnOnce for Change<'_, L> {
    type Output = Vec<[f32; L]>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        let mut change = self.moments;
        for (change, next) in change.iter_mut().zip(self.next) {
            for j in 0..L {
                change[j] = next[j] - change[j];
            }
        }
        change
    }
}

struct Equations<'a, const L: usize> {
    mixer: &'a Mixer<L>,
    change: &'a [[f32; L]],
}

impl<const L: usize> NullaryFnOnce for Equations<'_, L> {
    type Output = Sums<L>;

    /// Sums over places in double precision of sums over their moments in single.
    #[inline(always)]
    fn call(self) -> Sums<L> {
        let Mixer { moments, weights, kept } = self.mixer;
        let mut sums = Sums { matrix: [[[0.0; L]; KEPT + 1]; KEPT], square: [0.0; L] };
        let mut here = [[[0.0_f32; L]; KEPT + 1]; KEPT];
        let mut rows = [[0.0_f32; L]; KEPT];
        for ((place, change), weight) in self.change.chunks(*moments).enumerate().zip(weights) {
            let mut square = [0.0_f32; L];
            here.fill([[0.0; L]; KEPT + 1]);
            for (i, change) in change.iter().enumerate() {
                for (row, old) in rows.iter_mut().zip(kept) {
                    let (old, mut difference) = (&old.change[place * moments + i], [0.0; L]);
                    for j in 0..L {
                        difference[j] = (old[j] - change[j]) * weight[j];
                    }
                    *row = difference;
                }
                let mut weighed = [0.0; L];
                for j in 0..L {
                    weighed[j] = change[j] * weight[j];
                }
                add_product(&mut square, &weighed, &weighed);
                for a in 0..kept.len() {
                    for b in a..kept.len() {
                        add_product(&mut here[a][b], &rows[a], &rows[b]);
                    }
                    add_product(&mut here[a][KEPT], &rows[a], &weighed);
                }
            }
            for (sums, here) in sums.matrix.iter_mut().flatten().zip(here.iter().flatten()) {
                for j in 0..L {
                    sums[j] += f64::from(here[j]);
                }
            }
            for j in 0..L {
                sums.square[j] += f64::from(square[j]);
            }
        }
        for row in &mut sums.matrix {
            for right in &mut row[KEPT] {
                *right = -*right;
            }
        }
        sums
    }
}

struct Mixture<'a, const L: usize> {
    kept: &'a [Former<L>],
    shares: [[f32; L]; KEPT],
    next: &'a Field<L>,
}

impl<const L: usize> NullaryFnOnce for Mixture<'_, L> {
    type Output = Field<L>;

    #[inline(always)]
    fn call(self) -> Field<L> {
        let mut mixed = self.next.clone();
        for (share, Former { became, .. }) in self.shares.iter().zip(self.kept) {
            let moments = mixed.moments.iter_mut().zip(&became.moments).zip(&self.next.moments);
            let ground = mixed.ground.iter_mut().zip(&became.ground).zip(&self.next.ground);
            for ((sum, old), new) in moments.chain(ground) {
                for j in 0..L {
                    sum[j] += share[j] * (old[j] - new[j]);
                }
            }
        }
        mixed
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
