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
        if self.begins.len() < row + suns.count() {
            self.begins.resize(row + suns.count(), 0);
        }
        let mut begins = [0; 4];
        for (k, begin) in begins.iter_mut().enumerate() {
            let sun = first as usize + k;
            let mut known = self.begins[row + sun];
            if known == 0 {
                known = self.sums.len() as u32 + 1;
                self.begins[row + sun] = known;
                self.fold(solved, place.level * suns.count() + sun, reach, weights);
            }
            *begin = known as usize - 1;
        }
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

    /// Adds the F_m of a place of the table.
    #[inline(always)]
    fn fold(&mut self, solved: &Solved<L>, place: usize, reach: Reach, weights: &[[f32; L]]) {
        let (moments, count) = (&solved.optics.moments, solved.optics.moments.count());
        let here = &solved.field.moments[place * count..][..reach.count];
        let mut sums = [[0.0_f32; L]; MOST_DEGREE + 1];
        for (m, run) in moments.runs(reach.count) {
            let mut sum = sums[m];
            for (weight, moment) in weights[run.clone()].iter().zip(&here[run]) {
                for j in 0..L {
                    sum[j] += weight[j] * moment[j];
                }
            }
            sums[m] = sum;
        }
        self.sums.extend_from_slice(&sums[..=reach.degree]);
    }
}
