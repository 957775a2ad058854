//! From the moments of all light to those of the light that it becomes by one more scattering or reflection.

use super::grid::Suns;
use super::harmonics::{Moments, RAYLEIGH};
use super::rays::{Foot, Line, Lines, Node};
use crate::vectors::{add_product, add_scaled};
use std::f32::consts::PI;

/// A diffuse field: all light but the sun's own.
#[derive(Debug, Clone)]
pub(super) struct Field<const L: usize> {
    /// Moments int L S_lm(mu) cos(m phi) d omega, per unit solar irradiance: of a level, of a sun, of each (l, m).
    pub(super) moments: Vec<[f32; L]>,
    /// Irradiance of the ground by diffuse light, for each sun.
    pub(super) ground: Vec<[f32; L]>,
}

/// Azimuths on half a circle of further orders, where there are molecules alone, and else. As many orders m are told apart by them: in
/// an atmosphere that is nearly plane each m goes its own way, so those beyond are left as the first order has them.
pub(super) const FEW_AZIMUTHS: usize = 4;
pub(super) const AZIMUTHS: usize = 8;

/// What a level needs to look around.
pub(super) struct Around<'a, const L: usize> {
    pub(super) lines: &'a Lines<L>,
    pub(super) moments: &'a Moments,
    pub(super) suns: &'a Suns,
    /// Albedo over pi.
    pub(super) reflected: [f32; L],
}

/// The most orders m of cosines.
const MOST_COSINES: usize = super::harmonics::MOST_DEGREE + 1;

impl<const L: usize> Around<'_, L> {
    /// The moments at one level (of a sun, of each (l, m)) of the light that `field` becomes, and, of use at the ground, the
    /// irradiance from above.
    #[inline(always)]
    pub(super) fn scatter<const AZIMUTHS: usize>(&self, field: &Field<L>) -> (Vec<[f32; L]>, Vec<[f32; L]>) {
        let suns = self.suns.count();
        let turns: Vec<_> =
            self.lines.lines.iter().map(|line| Turns::new::<AZIMUTHS>(line.zenith, self.suns)).collect();
        // Of each line, sun and azimuth.
        let places = LANES * self.suns.batches::<AZIMUTHS>();
        let mut radiance = vec![[0.0; L]; self.lines.lines.len() * places];
        let mut linear = vec![[[0.0; L]; 2]; if self.moments.polarised() { radiance.len() } else { 0 }];
        let mut factors = Vec::new();
        let (mut few, mut many) = (vec![[[0.0; L]; 3]; suns], vec![[[0.0; L]; AZIMUTHS]; suns]);
        for node in &self.lines.nodes {
            let radiance = &mut radiance[node.line * places..(node.line + 1) * places];
            if node.harmonics.len() == RAYLEIGH {
                self.contract(node, field, &mut factors, &mut few);
                self.gather(&turns[node.line], node, &few, radiance);
            } else {
                self.contract(node, field, &mut factors, &mut many);
                self.gather(&turns[node.line], node, &many, radiance);
            }
            if let Some(linear) = linear.get_mut(node.line * places..(node.line + 1) * places) {
                self.polarise(&turns[node.line], node, field, linear);
            }
        }
        for ((line, turns), radiance) in self.lines.lines.iter().zip(&turns).zip(radiance.chunks_exact_mut(places)) {
            if let Some(foot) = &line.foot {
                self.reflect(turns, foot, field, radiance);
            }
        }
        let mut sum = Gathered::of::<AZIMUTHS>(&self.lines.lines, self.moments, suns, &radiance);
        for (line, linear) in self.lines.lines.iter().zip(linear.chunks_exact(places)) {
            sum.add_linear::<AZIMUTHS>(line, linear);
        }
        (sum.moments, sum.ground)
    }

    /// For each sun at the node's level the sources by cosines of m times the azimuth:
    /// sum_l S_lm(zenith) b_l I_lm.
    #[inline(always)]
    fn contract<const ORDERS: usize>(
        &self,
        node: &Node<L>,
        field: &Field<L>,
        factors: &mut Vec<[f32; L]>,
        rows: &mut [[[f32; L]; ORDERS]],
    ) {
        let (count, all) = (node.harmonics.len(), self.moments.count());
        factors.clear();
        for (&source, harmonic) in self.moments.sources().iter().zip(&node.harmonics) {
            factors.push(node.sources[source].map(|source| source * harmonic));
        }
        let level = &field.moments[node.level * self.suns.count() * all..][..self.suns.count() * all];
        rows.fill([[0.0; L]; ORDERS]);
        // Two suns at a time: each factor is read once for both.
        for (here, rows) in level.chunks(2 * all).zip(rows.chunks_mut(2)) {
            let (one, other) = here.split_at(all);
            for (m, run) in self.moments.runs(count) {
                match rows {
                    [row] => {
                        for (factor, moment) in factors[run.clone()].iter().zip(&one[run]) {
                            add_product(&mut row[m], factor, moment);
                        }
                    }
                    [row, other_row] => {
                        let (mut sum, mut other_sum) = (row[m], other_row[m]);
                        for ((factor, a), b) in factors[run.clone()].iter().zip(&one[run.clone()]).zip(&other[run]) {
                            add_product(&mut sum, factor, a);
                            add_product(&mut other_sum, factor, b);
                        }
                        (row[m], other_row[m]) = (sum, other_sum);
                    }
                    _ => {}
                }
            }
        }
    }

    /// Adds the sources of a node to the radiance of its line, for each sun and azimuth.
    #[inline(always)]
    fn gather<const ORDERS: usize>(
        &self,
        turns: &Turns,
        node: &Node<L>,
        rows: &[[[f32; L]; ORDERS]],
        radiance: &mut [[f32; L]],
    ) {
        let batches = turns.batches.iter().zip(radiance.as_chunks_mut::<LANES>().0);
        for (batch, radiance) in batches {
            let there = batch.there(node.frame);
            let between = self.suns.locate(&there);
            let cosines = waves::<ORDERS, LANES>(batch.cosines(node.zenith, &there));
            for (i, sum) in radiance.iter_mut().enumerate() {
                let first = between.first[i] as usize;
                let [a, b, c, d] = between.weights.map(|weights| weights[i]);
                let [p, q, r, s] = [0, 1, 2, 3].map(|k| &rows[first + k]);
                let mut total = *sum;
                for m in 0..ORDERS {
                    let cosine = cosines[m][i];
                    for j in 0..L {
                        total[j] += cosine * ((a * p[m][j] + b * q[m][j]) + (c * r[m][j] + d * s[m][j]));
                    }
                }
                *sum = total;
            }
        }
    }

    /// Adds the diffuse light that the ground reflects into a line, for each sun and azimuth.
    #[inline(always)]
    fn reflect(&self, turns: &Turns, foot: &Foot<L>, field: &Field<L>, radiance: &mut [[f32; L]]) {
        let through: [f32; L] = std::array::from_fn(|j| foot.through[j] * self.reflected[j]);
        for (batch, radiance) in turns.batches.iter().zip(radiance.as_chunks_mut::<LANES>().0) {
            let between = self.suns.locate(&batch.there(foot.frame));
            for (i, sum) in radiance.iter_mut().enumerate() {
                for (k, weights) in between.weights.iter().enumerate() {
                    let row = &field.ground[between.first[i] as usize + k];
                    for j in 0..L {
                        sum[j] += weights[i] * through[j] * row[j];
                    }
                }
            }
        }
    }
}

/// Suns and azimuths that are worked on together: some azimuths of each of a few suns.
pub(super) const LANES: usize = 16;

/// A line turned about the vertical of its beginning, under all suns; their number is filled up with the last one.
pub(super) struct Turns {
    pub(super) batches: Vec<Batch>,
}

/// Some suns and azimuths.
pub(super) struct Batch {
    /// Cosine of the sun's zenith angle at the beginning, and of the angle between line and sun.
    pub(super) cosine: [f32; LANES],
    pub(super) towards: [f32; LANES],
}

impl Suns {
    /// How many batches all suns make with so many azimuths, a divisor of [`LANES`].
    pub(super) fn batches<const AZIMUTHS: usize>(&self) -> usize {
        (self.count() * AZIMUTHS).div_ceil(LANES)
    }
}

impl Turns {
    #[inline(always)]
    pub(super) fn new<const AZIMUTHS: usize>(zenith: f64, suns: &Suns) -> Self {
        let sine = ((1.0 - zenith) * (1.0 + zenith)).max(0.0).sqrt() as f32;
        let level = azimuth_cosines::<AZIMUTHS>().map(|cosine| sine * cosine);
        let zenith = zenith as f32;
        let last = suns.count() - 1;
        let batch = |i: usize| {
            let place = |lane: usize| {
                let (sin, cos) = suns.sines_cosines[((i * LANES + lane) / AZIMUTHS).min(last)];
                (cos, cos * zenith + sin * level[lane % AZIMUTHS])
            };
            Batch {
                cosine: std::array::from_fn(|lane| place(lane).0),
                towards: std::array::from_fn(|lane| place(lane).1),
            }
        };
        Self { batches: (0..suns.batches::<AZIMUTHS>()).map(batch).collect() }
    }
}

impl Batch {
    /// Cosines of the sun's zenith angle at a place of the line.
    #[inline(always)]
    pub(super) fn there(&self, frame: [f32; 2]) -> [f32; LANES] {
        let mut there = [0.0; LANES];
        for i in 0..LANES {
            there[i] = frame[0] * self.cosine[i] + frame[1] * self.towards[i];
        }
        there
    }

    /// Cosines of the azimuth of a line with the cosine `zenith`, from the sun's, at such a place.
    #[inline(always)]
    pub(super) fn cosines(&self, zenith: f32, there: &[f32; LANES]) -> [f32; LANES] {
        let sine = ((1.0 - zenith) * (1.0 + zenith)).max(0.0).sqrt();
        let mut cosines = [1.0; LANES];
        for i in 0..LANES {
            let across = sine * ((1.0 - there[i]) * (1.0 + there[i])).max(0.0).sqrt();
            let along = self.towards[i] - zenith * there[i];
            cosines[i] = if across > 1e-6 { (along / across).clamp(-1.0, 1.0) } else { 1.0 };
        }
        cosines
    }
}

/// Cosines of the midpoints of equal parts of half a circle.
pub(super) fn azimuth_cosines<const AZIMUTHS: usize>() -> [f32; AZIMUTHS] {
    std::array::from_fn(|a| ((a as f32 + 0.5) / AZIMUTHS as f32 * PI).cos())
}

/// Moments of radiance at a level, and the irradiance from above.
pub(super) struct Gathered<const L: usize> {
    pub(super) moments: Vec<[f32; L]>,
    pub(super) ground: Vec<[f32; L]>,
}

impl<const L: usize> Gathered<L> {
    /// Of the radiance that arrives along lines: of each in turn that of each sun at so many azimuths, an even number up to
    /// [`LANES`]; what fills up its batches is left out.
    #[inline(always)]
    pub(super) fn of<const AZIMUTHS: usize>(
        lines: &[Line<L>],
        moments: &Moments,
        suns: usize,
        radiance: &[[f32; L]],
    ) -> Self {
        let (count, per_line) = (moments.count(), radiance.len() / lines.len().max(1));
        let mut all = Self { moments: vec![[0.0; L]; count * suns], ground: vec![[0.0; L]; suns] };
        // A rule with so many azimuths would take the low orders of the radiance for higher moments.
        let orders = (moments.degree() + 1).min(AZIMUTHS);
        let kept = moments.count_below(orders);
        // Of each moment what it has of each line; twice for the other half of the circle.
        let mut shares = vec![0.0; kept * lines.len()];
        let mut harmonics = Vec::new();
        let weight = |line: &Line<L>| line.weight as f32 * 2.0 * PI / AZIMUTHS as f32;
        for (k, line) in lines.iter().enumerate() {
            moments.at(line.zenith, &mut harmonics);
            for (shares, harmonic) in shares.chunks_exact_mut(lines.len()).zip(&harmonics) {
                shares[k] = weight(line) * *harmonic as f32;
            }
        }
        let waves = waves::<MOST_COSINES, AZIMUTHS>(azimuth_cosines());
        // Of each order m and line the sum of cos(m phi) times the radiance.
        let mut turned = vec![[0.0; L]; orders * lines.len()];
        let here = all.moments.chunks_exact_mut(count).zip(&mut all.ground);
        for (sun, (here, ground)) in here.enumerate() {
            for (k, radiance) in radiance.chunks_exact(per_line).enumerate() {
                let radiance = &radiance[sun * AZIMUTHS..(sun + 1) * AZIMUTHS];
                // cos(m (pi - phi)) is cos(m phi) or its negative.
                let mut pairs = [[[0.0; L]; 2]; LANES / 2];
                for (pair, (a, b)) in pairs.iter_mut().zip(radiance.iter().zip(radiance.iter().rev())) {
                    for j in 0..L {
                        (pair[0][j], pair[1][j]) = (a[j] + b[j], a[j] - b[j]);
                    }
                }
                for (m, waves) in waves.iter().enumerate().take(orders) {
                    let mut sum = [0.0; L];
                    for (wave, pair) in waves.iter().zip(&pairs).take(AZIMUTHS / 2) {
                        add_scaled(&mut sum, *wave, &pair[m % 2]);
                    }
                    turned[m * lines.len() + k] = sum;
                }
            }
            for (m, run) in moments.runs(kept) {
                let turned = &turned[m * lines.len()..(m + 1) * lines.len()];
                for (value, shares) in
                    here[run.clone()].iter_mut().zip(shares.chunks_exact(lines.len()).skip(run.start))
                {
                    let mut sum = [0.0; L];
                    for (share, row) in shares.iter().zip(turned) {
                        add_scaled(&mut sum, *share, row);
                    }
                    *value = sum;
                }
            }
            for (line, row) in lines.iter().zip(&turned).filter(|(line, _)| line.zenith > 0.0) {
                add_scaled(ground, weight(line) * line.zenith as f32, row);
            }
        }
        all
    }
}

/// Cosines of m times the angles that have these cosines, for m below `ORDERS`, at least 2.
#[inline(always)]
fn waves<const ORDERS: usize, const N: usize>(cosines: [f32; N]) -> [[f32; N]; ORDERS] {
    let mut waves = [[1.0; N]; ORDERS];
    waves[1] = cosines;
    for m in 2..ORDERS {
        for i in 0..N {
            waves[m][i] = 2.0 * cosines[i] * waves[m - 1][i] - waves[m - 2][i];
        }
    }
    waves
}
