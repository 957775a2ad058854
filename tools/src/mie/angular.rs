//! The angular functions pi_n = P_n^1(mu) / sin(theta) and tau_n = d P_n^1(mu) / d theta, mu = cos(theta).

use super::MieError;
use super::instructions::Vectors;

/// Angles of one block of a table: a whole number of tiles of every instruction set.
const WIDTH: usize = 24;

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
    /// pi_n + tau_n: of [`WIDTH`] angles after the other, for each order n = 1, 2, ... in turn those of the block.
    plus: Vec<Row>,
    /// pi_n - tau_n, the same.
    minus: Vec<Row>,
}

/// One order's functions at the angles of a block, where no vector crosses a line of the cache.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
struct Row([f64; WIDTH]);

impl AngularTable {
    /// The functions of the orders 1 ..= `terms` at the angles with these cosines.
    ///
    /// # Errors
    /// [`MieError::Cosine`] for a cosine outside -1..=1.
    pub fn new(cosines: &[f64], terms: usize) -> Result<Self, MieError> {
        let length = cosines.len().div_ceil(WIDTH) * terms;
        let (mut plus, mut minus) = (vec![Row([0.0; WIDTH]); length], vec![Row([0.0; WIDTH]); length]);
        for (i, &cosine) in cosines.iter().enumerate() {
            let mut functions = Functions::new(cosine)?;
            let block = i / WIDTH * terms..(i / WIDTH + 1) * terms;
            for (plus, minus) in plus[block.clone()].iter_mut().zip(&mut minus[block]) {
                let (pi, tau) = functions.advance();
                plus.0[i % WIDTH] = pi + tau;
                minus.0[i % WIDTH] = pi - tau;
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
}

/// The scattering matrix summed over spheres, at each angle of a table and some more that fill up its last block:
/// with S+ = S1 + S2 and S- = S1 - S2,
///
/// (|S1|^2 + |S2|^2) / 2 = (|S+|^2 + |S-|^2) / 4, (|S2|^2 - |S1|^2) / 2 = -Re(S+ S-*) / 2,
/// Re(S1 S2*) = (|S+|^2 - |S-|^2) / 4, Im(S2 S1*) = Im(S+ S-*) / 2.
#[derive(Debug, Clone, Default)]
pub(super) struct Matrix {
    /// sum w |S+|^2, w |S-|^2, w Re(S+ S-*), w Im(S+ S-*).
    parts: [Vec<f64>; 4],
}

impl Matrix {
    /// Nothing summed yet.
    pub(super) fn clear(&mut self, table: &AngularTable) {
        for part in &mut self.parts {
            part.clear();
            part.resize(table.cosines.len().next_multiple_of(WIDTH), 0.0);
        }
    }

    /// The four elements in the order above, of `angles` angles.
    pub(super) fn elements(&self, angles: usize) -> [Vec<f64>; 4] {
        let [plus, minus, re, im] = &self.parts;
        let pairs = || plus.iter().zip(minus).take(angles);
        [
            pairs().map(|(p, m)| 0.25 * (p + m)).collect(),
            re.iter().take(angles).map(|r| -0.5 * r).collect(),
            pairs().map(|(p, m)| 0.25 * (p - m)).collect(),
            im.iter().take(angles).map(|i| 0.5 * i).collect(),
        ]
    }

    /// Adds the spheres of the first lanes of a vector, as many as there are weights. `plus` and `minus` hold, for n = 1, 2, ... `count`, the real
    /// parts of (2n + 1) / (n (n + 1)) (a_n + b_n), or of a_n - b_n, in all lanes, then the imaginary parts.
    #[inline(always)]
    pub(super) fn add<S: Vectors>(
        &mut self,
        simd: S,
        table: &AngularTable,
        (plus, minus): (&[f64], &[f64]),
        count: usize,
        weights: &[f64],
    ) {
        // So that the accumulators fit into 32 or 16 registers.
        match S::F64_LANES {
            8 => self.add_by::<S, 4, 16, 3>(simd, table, (plus, minus), count, weights),
            4 => self.add_by::<S, 2, 8, 2>(simd, table, (plus, minus), count, weights),
            _ => self.add_plain(table, (plus, minus), count, weights[0]),
        }
    }

    /// As [`Matrix::add`], of one sphere.
    fn add_plain(&mut self, table: &AngularTable, (plus, minus): (&[f64], &[f64]), count: usize, weight: f64) {
        for first in (0..self.parts[0].len()).step_by(WIDTH) {
            let start = first / WIDTH * table.terms;
            let [p, q] = sums_plain(&table.plus[start..], plus, count);
            let [r, s] = sums_plain(&table.minus[start..], minus, count);
            for j in 0..WIDTH {
                let products = [
                    p[j] * p[j] + q[j] * q[j],
                    r[j] * r[j] + s[j] * s[j],
                    p[j] * r[j] + q[j] * s[j],
                    q[j] * r[j] - p[j] * s[j],
                ];
                for (part, product) in self.parts.iter_mut().zip(products) {
                    part[first + j] += weight * product;
                }
            }
        }
    }

    /// As [`Matrix::add`], by tiles of so many vectors of angles and of half a vector of `SPHERES` spheres, which have
    /// `PAIRS` = 4 `SPHERES` coefficients of each order.
    #[inline(always)]
    fn add_by<S: Vectors, const SPHERES: usize, const PAIRS: usize, const VECTORS: usize>(
        &mut self,
        simd: S,
        table: &AngularTable,
        (plus, minus): (&[f64], &[f64]),
        count: usize,
        weights: &[f64],
    ) {
        let mut all = [0.0; PAIRS];
        all[..weights.len()].copy_from_slice(weights);
        let (plus, minus) = (&plus.as_chunks::<PAIRS>().0[..count], &minus.as_chunks::<PAIRS>().0[..count]);
        let tile = VECTORS * S::F64_LANES;
        for first in (0..table.cosines.len()).step_by(tile) {
            let start = first / WIDTH * table.terms;
            let rows = [&table.plus[start..start + count], &table.minus[start..start + count]];
            let tile = Tile { simd, rows, from: first % WIDTH };
            let [p, q, r, s] = &mut self.parts;
            let mut parts = [
                &mut S::as_mut_simd_f64s(&mut p[first..]).0[..VECTORS],
                &mut S::as_mut_simd_f64s(&mut q[first..]).0[..VECTORS],
                &mut S::as_mut_simd_f64s(&mut r[first..]).0[..VECTORS],
                &mut S::as_mut_simd_f64s(&mut s[first..]).0[..VECTORS],
            ];
            let coefficients = [plus, minus];
            let two = weights.len() > SPHERES;
            if table.cosines.len() - first <= 2 * S::F64_LANES {
                tile.add::<SPHERES, PAIRS, 2, false>(coefficients, &all, &mut parts);
                if two {
                    tile.add::<SPHERES, PAIRS, 2, true>(coefficients, &all, &mut parts);
                }
            } else {
                tile.add::<SPHERES, PAIRS, VECTORS, false>(coefficients, &all, &mut parts);
                if two {
                    tile.add::<SPHERES, PAIRS, VECTORS, true>(coefficients, &all, &mut parts);
                }
            }
        }
    }
}

/// The functions pi_n + tau_n and pi_n - tau_n of the angles of a block from one of them on.
struct Tile<'a, S> {
    simd: S,
    rows: [&'a [Row]; 2],
    from: usize,
}

impl<S: Vectors> Tile<'_, S> {
    /// Adds to the parts of a matrix the spheres of the first or the second half of a vector.
    #[inline(always)]
    fn add<const SPHERES: usize, const PAIRS: usize, const VECTORS: usize, const SECOND: bool>(
        &self,
        coefficients: [&[[f64; PAIRS]]; 2],
        weights: &[f64; PAIRS],
        parts: &mut [&mut [S::f64s]; 4],
    ) {
        let simd = self.simd;
        let ahead = self.sums::<SPHERES, PAIRS, VECTORS, SECOND>(self.rows[0], coefficients[0]);
        let back = self.sums::<SPHERES, PAIRS, VECTORS, SECOND>(self.rows[1], coefficients[1]);
        for i in 0..SPHERES {
            let weight = simd.splat_f64s(weights[if SECOND { SPHERES + i } else { i }]);
            for v in 0..VECTORS {
                let [p, q] = [ahead[i][0][v], ahead[i][1][v]];
                let [r, s] = [back[i][0][v], back[i][1][v]];
                let products = [
                    simd.mul_add_e_f64s(p, p, simd.mul_f64s(q, q)),
                    simd.mul_add_e_f64s(r, r, simd.mul_f64s(s, s)),
                    simd.mul_add_e_f64s(p, r, simd.mul_f64s(q, s)),
                    simd.mul_sub(q, r, simd.mul_f64s(p, s)),
                ];
                for k in 0..4 {
                    parts[k][v] = simd.mul_add_e_f64s(weight, products[k], parts[k][v]);
                }
            }
        }
    }

    /// The sums over the orders of functions times coefficients: of each sphere and vector of angles the real and the
    /// imaginary part. An order's coefficients are the real parts of all spheres, then the imaginary parts.
    #[inline(always)]
    fn sums<const SPHERES: usize, const PAIRS: usize, const VECTORS: usize, const SECOND: bool>(
        &self,
        functions: &[Row],
        coefficients: &[[f64; PAIRS]],
    ) -> [[[S::f64s; VECTORS]; 2]; SPHERES] {
        let first = if SECOND { SPHERES } else { 0 };
        let mut sums = [[[self.simd.splat_f64s(0.0); VECTORS]; 2]; SPHERES];
        for (row, both) in functions.iter().zip(coefficients) {
            let (row, _) = S::as_simd_f64s(&row.0[self.from..self.from + VECTORS * S::F64_LANES]);
            for i in 0..SPHERES {
                for part in 0..2 {
                    let coefficient = self.simd.splat_f64s(both[part * 2 * SPHERES + first + i]);
                    for v in 0..VECTORS {
                        sums[i][part][v] = self.simd.mul_add_e_f64s(coefficient, row[v], sums[i][part][v]);
                    }
                }
            }
        }
        sums
    }
}

/// The same for one sphere and a whole block of angles, by plain loops over arrays, four orders at a time: what
/// compilers turn into the vector instructions that every processor has.
fn sums_plain(functions: &[Row], coefficients: &[f64], count: usize) -> [[f64; WIDTH]; 2] {
    const RUN: usize = 4;
    let (rows, pairs) = (&functions[..count], &coefficients.as_chunks::<2>().0[..count]);
    let mut sums = [[0.0; WIDTH]; 2];
    let (runs, rest) = rows.as_chunks::<RUN>();
    let (pair_runs, pair_rest) = pairs.as_chunks::<RUN>();
    for ([Row(f0), Row(f1), Row(f2), Row(f3)], c) in runs.iter().zip(pair_runs) {
        for part in 0..2 {
            let [c0, c1, c2, c3] = c.map(|pair| pair[part]);
            for (j, sum) in sums[part].iter_mut().enumerate() {
                *sum += (c0 * f0[j] + c1 * f1[j]) + (c2 * f2[j] + c3 * f3[j]);
            }
        }
    }
    for (row, c) in rest.iter().zip(pair_rest) {
        for part in 0..2 {
            for (sum, f) in sums[part].iter_mut().zip(&row.0) {
                *sum += c[part] * f;
            }
        }
    }
    sums
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
