//! Sources where a line of sight crosses the levels of a table, for all azimuths and suns: what lines of one zenith angle have in common.
//!
//! At a crossing these lines have the same weights s_l of the degrees and the same S_lm(mu); only the azimuth phi and the sun's zenith angle
//! there differ. So the sums over l
//!
//! F_m = sum_l s_l S_lm(mu) I_lm
//!
//! are done once for each zenith angle chi of the table that is asked for, and J = sum_m cos(m phi) F_m of each line has few terms.

use super::grid::Between;
use super::harmonics::MOST_DEGREE;
use super::line::Crossing;
use super::view::{azimuth_cosine, cosines};
use super::{Reach, Solved};

/// F_m at the crossings of a line, found when they are first asked for.
#[derive(Default)]
pub(super) struct Folded<const L: usize> {
    /// [crossing][sun of the table]: one more than where its F_m begin, 0 if they are not known.
    begins: Vec<u32>,
    /// Those of each m.
    sums: Vec<[f32; L]>,
}

impl<const L: usize> Folded<L> {
    /// Of so many crossings: with room for what one look asks for, four suns at each.
    pub(super) fn new(solved: &Solved<L>, crossings: usize) -> Self {
        let room = 4 * crossings * (solved.optics.moments.degree() + 1);
        Self { begins: vec![0; crossings * solved.grid.suns.count()], sums: Vec::with_capacity(room) }
    }

    /// J at a crossing of that number, in a direction looked in; of its zenith angle there, of the sun's, and of the angle between the two the
    /// cosines are given, and s_l S_lm(mu) of each moment.
    #[inline(always)]
    pub(super) fn source(
        &mut self,
        solved: &Solved<L>,
        (number, place, reach): (usize, &Crossing, Reach),
        [zenith, there, towards]: [f64; 3],
        weights: &[[f32; L]],
    ) -> [f32; L] {
        let mut total = [0.0_f32; L];
        let suns = &solved.grid.suns;
        let Between { first: [first], weights: lagrange } = suns.locate(&[there as f32]);
        let lagrange = lagrange.map(|weight| weight[0]);
        if lagrange == [0.0; 4] {
            return total;
        }
        let (orders, row) = (reach.degree + 1, number * suns.count());
        let (place, row) = (place.level * suns.count() + first as usize, row + first as usize);
        if self.begins[row..row + 4] == [0; 4] {
            self.fold::<4>(solved, (row, place), reach, weights);
        } else {
            for k in 0..4 {
                if self.begins[row + k] == 0 {
                    self.fold::<1>(solved, (row + k, place + k), reach, weights);
                }
            }
        }
        let begins = [0, 1, 2, 3].map(|k| self.begins[row + k] as usize - 1);
        let cosines = cosines(azimuth_cosine(zenith, there, towards), reach.degree);
        let [a, b, c, d] = begins.map(|begin| &self.sums[begin..begin + orders]);
        for ((((cosine, a), b), c), d) in cosines.iter().zip(a).zip(b).zip(c).zip(d) {
            let cosine = *cosine as f32;
            for j in 0..L {
                let sum = (lagrange[0] * a[j] + lagrange[1] * b[j]) + (lagrange[2] * c[j] + lagrange[3] * d[j]);
                total[j] += cosine * sum;
            }
        }
        total
    }

    /// Adds the F_m of so many suns that follow each other, from a row and a place of the table on.
    #[inline(always)]
    fn fold<const N: usize>(
        &mut self,
        solved: &Solved<L>,
        (row, place): (usize, usize),
        reach: Reach,
        weights: &[[f32; L]],
    ) {
        let (moments, count) = (&solved.optics.moments, solved.optics.moments.count());
        let here = &solved.field.moments[place * count..][..N * count];
        let mut sums = [[[0.0_f32; L]; MOST_DEGREE + 1]; N];
        for (m, run) in moments.runs(reach.count) {
            let mut own = [[0.0_f32; L]; N];
            for i in run {
                let weight = &weights[i];
                for k in 0..N {
                    let moment = &here[k * count + i];
                    for j in 0..L {
                        own[k][j] += weight[j] * moment[j];
                    }
                }
            }
            for k in 0..N {
                for j in 0..L {
                    sums[k][m][j] += own[k][j];
                }
            }
        }
        for (k, sums) in sums.iter().enumerate() {
            self.begins[row + k] = self.sums.len() as u32 + 1;
            self.sums.extend_from_slice(&sums[..=reach.degree]);
        }
    }
}
