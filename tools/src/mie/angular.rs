//! The angular functions pi_n = P_n^1(mu) / sin(theta) and tau_n = d P_n^1(mu) / d theta, mu = cos(theta).

use super::MieError;
use pulp::Simd;

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
        // A row too many, so that rows can begin anywhere in a block.
        let length = cosines.len().next_multiple_of(WIDTH) * terms + WIDTH;
        let (mut plus, mut minus) = (vec![0.0; length], vec![0.0; length]);
        for (i, &cosine) in cosines.iter().enumerate() {
            let mut functions = Functions::new(cosine)?;
            let first = i / WIDTH * WIDTH * terms + i % WIDTH;
            for n in 0..terms {
                let (pi, tau) = functions.advance();
                plus[first + n * WIDTH] = pi + tau;
                minus[first + n * WIDTH] = pi - tau;
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
    pub(super) fn add<S: Simd>(
        &mut self,
        simd: S,
        table: &AngularTable,
        (plus, minus): (&[f64], &[f64]),
        count: usize,
        weights: &[f64],
    ) {
        // So that the accumulators fit into 32 or 16 registers.
        match S::F64_LANES {
            8 => self.add_by::<S, 4, 3>(simd, table, (plus, minus), count, weights),
            4 => self.add_by::<S, 2, 3>(simd, table, (plus, minus), count, weights),
            _ => self.add_plain(table, (plus, minus), count, weights[0]),
        }
    }

    /// As [`Matrix::add`], of one sphere.
    fn add_plain(&mut self, table: &AngularTable, (plus, minus): (&[f64], &[f64]), count: usize, weight: f64) {
        for first in (0..self.parts[0].len()).step_by(WIDTH) {
            let start = first * table.terms;
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

    /// As [`Matrix::add`], by tiles of so many spheres and vectors of angles.
    #[inline(always)]
    fn add_by<S: Simd, const SPHERES: usize, const VECTORS: usize>(
        &mut self,
        simd: S,
        table: &AngularTable,
        (plus, minus): (&[f64], &[f64]),
        count: usize,
        weights: &[f64],
    ) {
        let lanes = S::F64_LANES;
        let tile = VECTORS * lanes;
        let block = WIDTH * table.terms;
        for first in (0..table.cosines.len()).step_by(tile) {
            let start = first / WIDTH * block + first % WIDTH;
            for sphere in (0..weights.len()).step_by(SPHERES) {
                let ahead = sums::<S, SPHERES, VECTORS>(simd, &table.plus[start..], &plus[sphere..], count);
                let back = sums::<S, SPHERES, VECTORS>(simd, &table.minus[start..], &minus[sphere..], count);
                for (i, &weight) in weights[sphere..].iter().enumerate().take(SPHERES) {
                    let weight = simd.splat_f64s(weight);
                    for v in 0..VECTORS {
                        let [p, q] = [ahead[i][0][v], ahead[i][1][v]];
                        let [r, s] = [back[i][0][v], back[i][1][v]];
                        let products = [
                            simd.mul_add_e_f64s(p, p, simd.mul_f64s(q, q)),
                            simd.mul_add_e_f64s(r, r, simd.mul_f64s(s, s)),
                            simd.mul_add_e_f64s(p, r, simd.mul_f64s(q, s)),
                            simd.sub_f64s(simd.mul_f64s(q, r), simd.mul_f64s(p, s)),
                        ];
                        for (part, product) in self.parts.iter_mut().zip(products) {
                            let part = &mut S::as_mut_simd_f64s(&mut part[first..]).0[v];
                            *part = simd.mul_add_e_f64s(weight, product, *part);
                        }
                    }
                }
            }
        }
    }
}

/// The sums over n = 1 ..= `count` of functions times coefficients, for `SPHERES` spheres and a tile of angles: of each
/// sphere and vector of angles the real and the imaginary part.
#[inline(always)]
fn sums<S: Simd, const SPHERES: usize, const VECTORS: usize>(
    simd: S,
    functions: &[f64],
    coefficients: &[f64],
    count: usize,
) -> [[[S::f64s; VECTORS]; 2]; SPHERES] {
    let lanes = S::F64_LANES;
    let mut sums = [[[simd.splat_f64s(0.0); VECTORS]; 2]; SPHERES];
    for (row, both) in functions.as_chunks::<WIDTH>().0.iter().zip(coefficients.chunks(2 * lanes)).take(count) {
        let (row, _) = S::as_simd_f64s(&row[..VECTORS * lanes]);
        let parts = [&both[..SPHERES], &both[lanes..lanes + SPHERES]];
        for i in 0..SPHERES {
            for part in 0..2 {
                let coefficient = simd.splat_f64s(parts[part][i]);
                for v in 0..VECTORS {
                    sums[i][part][v] = simd.mul_add_e_f64s(coefficient, row[v], sums[i][part][v]);
                }
            }
        }
    }
    sums
}

/// The same for one sphere and a whole block of angles, by plain loops over arrays, four orders at a time: what
/// compilers turn into the vector instructions that every processor has.
fn sums_plain(functions: &[f64], coefficients: &[f64], count: usize) -> [[f64; WIDTH]; 2] {
    const RUN: usize = 4;
    let (rows, pairs) = (functions.as_chunks::<WIDTH>().0, coefficients.as_chunks::<2>().0);
    let (rows, pairs) = (&rows[..count], &pairs[..count]);
    let mut sums = [[0.0; WIDTH]; 2];
    let (runs, rest) = rows.as_chunks::<RUN>();
    let (pair_runs, pair_rest) = pairs.as_chunks::<RUN>();
    for ([f0, f1, f2, f3], c) in runs.iter().zip(pair_runs) {
        for part in 0..2 {
            let [c0, c1, c2, c3] = c.map(|pair| pair[part]);
            for (j, sum) in sums[part].iter_mut().enumerate() {
                *sum += (c0 * f0[j] + c1 * f1[j]) + (c2 * f2[j] + c3 * f3[j]);
            }
        }
    }
    for (row, c) in rest.iter().zip(pair_rest) {
        for part in 0..2 {
            for (sum, f) in sums[part].iter_mut().zip(row) {
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
