//! From the moments of all light to those of the light that it becomes by one more scattering or reflection.

use super::grid::Suns;
use super::harmonics::{Moments, RAYLEIGH};
use super::rays::{Line, Node};
use std::f32::consts::PI;

/// A diffuse field: all light but the sun's own.
#[derive(Debug, Clone)]
pub(super) struct Field<const L: usize> {
    /// Moments int L S_lm(mu) cos(m phi) d omega, per unit solar irradiance: of a level, of a sun, of each (l, m).
    pub(super) moments: Vec<[f32; L]>,
    /// Irradiance of the ground by diffuse light, for each sun.
    pub(super) ground: Vec<[f32; L]>,
}

/// What a level needs to look around.
pub(super) struct Around<'a, const L: usize> {
    pub(super) lines: &'a [Line<L>],
    pub(super) moments: &'a Moments,
    pub(super) suns: &'a Suns,
    /// Albedo over pi.
    pub(super) reflected: [f32; L],
}

/// The most orders m of cosines.
const MOST_COSINES: usize = super::harmonics::MOST_DEGREE + 1;

impl<const L: usize> Around<'_, L> {
    /// The moments at one level (of a sun, of each (l, m)) of the light that `field` becomes, and, of use at the ground, the
    /// irradiance from above; with so many azimuths on half a circle.
    #[inline(always)]
    pub(super) fn scatter<const AZIMUTHS: usize>(&self, field: &Field<L>) -> (Vec<[f32; L]>, Vec<[f32; L]>) {
        let suns = self.suns.count();
        let cosines = azimuth_cosines::<AZIMUTHS>();
        let mut sum = Gathered::new(self.moments.count(), suns);
        let mut radiance = vec![[[0.0; L]; AZIMUTHS]; suns];
        let (mut rows, mut factors) = (Vec::new(), Vec::new());
        let degree = self.moments.degree() + 1;
        for line in self.lines {
            radiance.fill([[0.0; L]; AZIMUTHS]);
            let turns = Turns::new(line.zenith, &cosines);
            for (node, sources) in line.nodes.iter().zip(line.sources.chunks_exact(degree)) {
                let orders = self.contract(node, sources, field, &mut factors, &mut rows);
                self.gather(&turns, node, &rows, orders, &mut radiance);
            }
            if let Some(foot) = &line.foot {
                let through: [f32; L] = std::array::from_fn(|j| foot.through[j] * self.reflected[j]);
                for (sun, radiance) in self.suns.sines_cosines.iter().zip(&mut radiance) {
                    let (_, there) = turns.seen_from(*sun, foot.frame);
                    let between = self.suns.locate(&there);
                    for (a, sum) in radiance.iter_mut().enumerate() {
                        for (k, weights) in between.weights.iter().enumerate() {
                            let row = &field.ground[between.first[a] as usize + k];
                            for j in 0..L {
                                sum[j] += weights[a] * through[j] * row[j];
                            }
                        }
                    }
                }
            }
            sum.add(line, self.moments, &radiance);
        }
        (sum.moments, sum.ground)
    }

    /// For each sun at the node's level the sources by cosines of m times the azimuth:
    /// sum_l S_lm(zenith) b_l I_lm. Gives how many orders m there are.
    #[inline(always)]
    fn contract(
        &self,
        node: &Node,
        sources: &[[f32; L]],
        field: &Field<L>,
        factors: &mut Vec<[f32; L]>,
        rows: &mut Vec<[f32; L]>,
    ) -> usize {
        let (count, all) = (node.harmonics.len(), self.moments.count());
        let orders = if count == RAYLEIGH { 3 } else { self.moments.degree() + 1 };
        let pairs = &self.moments.pairs()[..count];
        factors.clear();
        for (&(l, _), harmonic) in pairs.iter().zip(&node.harmonics) {
            let mut factor = sources[l];
            for j in 0..L {
                factor[j] *= harmonic;
            }
            factors.push(factor);
        }
        rows.clear();
        rows.resize(self.suns.count() * orders, [0.0; L]);
        let level = &field.moments[node.level * self.suns.count() * all..][..self.suns.count() * all];
        for (here, row) in level.chunks_exact(all).zip(rows.chunks_exact_mut(orders)) {
            for ((&(_, m), factor), moment) in pairs.iter().zip(factors.iter()).zip(here) {
                let row = &mut row[m];
                for j in 0..L {
                    row[j] += factor[j] * moment[j];
                }
            }
        }
        orders
    }

    /// Adds the sources of a node to the radiance of the line, for each sun and azimuth.
    #[inline(always)]
    fn gather<const AZIMUTHS: usize>(
        &self,
        turns: &Turns<AZIMUTHS>,
        node: &Node,
        rows: &[[f32; L]],
        orders: usize,
        radiance: &mut [[[f32; L]; AZIMUTHS]],
    ) {
        let node_sine = ((1.0 - node.zenith) * (1.0 + node.zenith)).max(0.0).sqrt();
        let mut factors = [[1.0_f32; AZIMUTHS]; MOST_COSINES];
        for (sun, radiance) in self.suns.sines_cosines.iter().zip(radiance) {
            let (towards, there) = turns.seen_from(*sun, node.frame);
            let between = self.suns.locate(&there);
            for a in 0..AZIMUTHS {
                let across = node_sine * ((1.0 - there[a]) * (1.0 + there[a])).max(0.0).sqrt();
                let along = towards[a] - node.zenith * there[a];
                factors[1][a] = if across > 1e-6 { (along / across).clamp(-1.0, 1.0) } else { 1.0 };
            }
            for m in 2..orders {
                for a in 0..AZIMUTHS {
                    factors[m][a] = 2.0 * factors[1][a] * factors[m - 1][a] - factors[m - 2][a];
                }
            }
            for (a, sum) in radiance.iter_mut().enumerate() {
                let first = between.first[a] as usize * orders;
                let four = &rows[first..first + 4 * orders];
                let mut total = *sum;
                for (rows, weights) in four.chunks_exact(orders).zip(&between.weights) {
                    for (row, factor) in rows.iter().zip(&factors) {
                        let factor = weights[a] * factor[a];
                        for j in 0..L {
                            total[j] += factor * row[j];
                        }
                    }
                }
                *sum = total;
            }
        }
    }
}

/// A line turned about the vertical of its beginning.
pub(super) struct Turns<const AZIMUTHS: usize> {
    zenith: f32,
    /// Sine of the zenith angle times the cosine of each azimuth.
    level: [f32; AZIMUTHS],
}

impl<const AZIMUTHS: usize> Turns<AZIMUTHS> {
    #[inline(always)]
    pub(super) fn new(zenith: f64, cosines: &[f32; AZIMUTHS]) -> Self {
        let sine = ((1.0 - zenith) * (1.0 + zenith)).max(0.0).sqrt() as f32;
        Self { zenith: zenith as f32, level: cosines.map(|cosine| sine * cosine) }
    }

    /// For each azimuth the cosines of the angle between line and sun and of the sun's zenith angle at a place of the line.
    #[inline(always)]
    pub(super) fn seen_from(&self, (sin, cos): (f32, f32), frame: [f32; 2]) -> ([f32; AZIMUTHS], [f32; AZIMUTHS]) {
        let (mut towards, mut there) = ([0.0; AZIMUTHS], [0.0; AZIMUTHS]);
        for a in 0..AZIMUTHS {
            towards[a] = cos * self.zenith + sin * self.level[a];
            there[a] = frame[0] * cos + frame[1] * towards[a];
        }
        (towards, there)
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
    harmonics: Vec<f64>,
}

impl<const L: usize> Gathered<L> {
    pub(super) fn new(moments: usize, suns: usize) -> Self {
        Self { moments: vec![[0.0; L]; moments * suns], ground: vec![[0.0; L]; suns], harmonics: Vec::new() }
    }

    /// Adds the radiance (of each sun and azimuth) that arrives along a line.
    #[inline(always)]
    pub(super) fn add<const AZIMUTHS: usize>(
        &mut self,
        line: &Line<L>,
        moments: &Moments,
        radiance: &[[[f32; L]; AZIMUTHS]],
    ) {
        moments.at(line.zenith, &mut self.harmonics);
        let cosines = azimuth_cosines::<AZIMUTHS>();
        // Twice for the other half of the circle.
        let weight = line.weight as f32 * 2.0 * PI / AZIMUTHS as f32;
        // A rule with so many azimuths would take the low orders of the radiance for higher moments.
        let orders = (moments.degree() + 1).min(AZIMUTHS);
        let count = moments.count();
        let mut turned = [[0.0_f32; L]; MOST_COSINES];
        for (sun, radiance) in radiance.iter().enumerate() {
            turned[..orders].fill([0.0; L]);
            for (radiance, cosine) in radiance.iter().zip(&cosines) {
                let (mut before, mut factor) = (*cosine, 1.0_f32);
                for row in &mut turned[..orders] {
                    for j in 0..L {
                        row[j] += factor * radiance[j];
                    }
                    (before, factor) = (factor, 2.0 * cosine * factor - before);
                }
            }
            let here = &mut self.moments[sun * count..(sun + 1) * count];
            for ((sum, &(_, m)), harmonic) in here.iter_mut().zip(moments.pairs()).zip(&self.harmonics) {
                if m >= orders {
                    continue;
                }
                let factor = weight * *harmonic as f32;
                for j in 0..L {
                    sum[j] += factor * turned[m][j];
                }
            }
            if line.zenith > 0.0 {
                let factor = weight * line.zenith as f32;
                for j in 0..L {
                    self.ground[sun][j] += factor * turned[0][j];
                }
            }
        }
    }
}
