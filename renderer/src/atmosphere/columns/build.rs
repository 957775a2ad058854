//! Making the tables: exact optical depths by quadrature, nodes where interpolation needs them.

use super::{Columns, Rows};
use crate::atmosphere::Medium;
use crate::atmosphere::medium::GAUSS_4;
use crate::geometry::Shape;
use crate::lookup::Lookup;
use crate::vectors::{exp_minus, vectorised};
use pulp::NullaryFnOnce;
use rayon::prelude::*;

/// How exact the tables are to be: nodes are added until the optical depth tau between the start of a row and every
/// node is interpolated to within `depth` x min(e^tau, 10) x max(1, (tau / 14)^2), which changes a transmittance
/// e^-tau by no more than `depth` absolutely and, where it exceeds 1e-6, by ten times `depth` relatively.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Change of a transmittance.
    pub depth: f64,
}

impl Tolerance {
    /// What the renderer takes: transmittances to 2e-5, and 2e-4 relative wherever they exceed 1e-6.
    pub const RENDER: Self = Self { depth: 2e-5 };

    /// What solved tables take: five times as much, which their views do not notice.
    pub const SOLVE: Self = Self { depth: 1e-4 };

    /// Allowed errors of optical depths where they are `tau`.
    #[inline(always)]
    fn allowed<const L: usize>(self, tau: [f64; L]) -> [f64; L] {
        const MOST: f64 = 10.0;
        let growth = exp_minus(tau.map(|tau| -tau.min(MOST)));
        std::array::from_fn(|j| self.depth * growth[j].min(MOST) * (tau[j] / 14.0).powi(2).max(1.0))
    }
}

/// Largest change of the logarithm of a density within one step of the quadrature; four Gauss points then leave 1e-9.
const MOST_CHANGE: f64 = 0.5;

/// The most rows of one cell.
const MOST_ROWS: usize = 200;

/// A step of the quadrature: altitudes in m, within one interval of the medium and one cell of the table.
#[derive(Debug, Clone, Copy)]
struct Step {
    bottom: f64,
    top: f64,
    interval: usize,
}

/// Nodes of Gauss' rule in the altitude over a step: altitudes in m, and extinction coefficients times the weights in m.
struct Nodes<const L: usize> {
    altitudes: [f64; 4],
    depths: [[f64; L]; 4],
}

/// Everything that gives exact optical depths.
struct Exact<'a, const L: usize> {
    medium: &'a Medium<L>,
    shape: Shape,
    steps: Vec<Step>,
    /// Of each step.
    nodes: Vec<Nodes<L>>,
    tolerance: Tolerance,
    /// Altitudes in m at which the extinction jumps.
    jumps: Vec<f64>,
}

/// Optical depths at each node from the start of a line, and the distance of each node from the perigee; nothing below the start.
struct Row<const L: usize> {
    distances: Vec<f64>,
    depths: Vec<[f64; L]>,
    start: [f64; L],
}

impl<const L: usize> Row<L> {
    /// What means at a node count from: the jump `base` below it, or the start of the line if that is higher.
    #[inline(always)]
    fn begins(&self, base: usize) -> (f64, [f64; L]) {
        if self.distances[base] > self.distances[0] {
            (self.distances[base], self.depths[base])
        } else {
            (self.distances[0], [0.0; L])
        }
    }

    /// Mean extinction up to node `k`.
    #[inline(always)]
    fn mean(&self, k: usize, base: usize) -> [f64; L] {
        let (from, before) = self.begins(base);
        let length = self.distances[k] - from;
        if length > 0.0 { std::array::from_fn(|j| (self.depths[k][j] - before[j]) / length) } else { self.start }
    }
}

impl<const L: usize> Columns<L> {
    /// The columns of `medium`.
    #[must_use]
    pub fn new(medium: &Medium<L>, shape: Shape, tolerance: Tolerance) -> Self {
        let mut exact =
            Exact { medium, shape, steps: steps(medium), nodes: Vec::new(), tolerance, jumps: jumps(medium) };
        exact.look_at_steps();
        let nodes = exact.altitudes();
        exact.cut(&nodes);
        let jumps = (0..nodes.len()).filter(|&k| exact.jumps.contains(&nodes[k])).collect();
        let base = |&z: &f64| exact.jumps.iter().rfind(|&&jump| jump < z);
        let index = |jump: &f64| nodes.iter().position(|z| z == jump).unwrap_or(0);
        let bases: Vec<usize> = nodes.iter().map(|z| base(z).map_or(0, index)).collect();
        let extinction = nodes.windows(2).map(|ends| exact.ends(ends[0], ends[1])).collect();
        let (limb, ground) = match shape {
            // One row serves all directions; a second copy closes the cell.
            Shape::Flat => {
                let rows = rows(vec![(0.0, exact.row(0.0, &nodes)), (1.0, exact.row(0.0, &nodes))], &bases);
                (rows.clone(), rows)
            }
            Shape::Sphere { radius_m } => (exact.limb(&nodes, &bases), exact.ground(radius_m, &nodes, &bases)),
        };
        Self { shape, altitudes: Lookup::new(nodes), jumps, bases, extinction, limb, ground }
    }
}

/// The medium's intervals, divided so that no density changes much within a step.
fn steps<const L: usize>(medium: &Medium<L>) -> Vec<Step> {
    let mut steps = Vec::new();
    for (interval, ends) in medium.nodes().windows(2).enumerate() {
        let parts = (medium.most_rise(interval) / MOST_CHANGE).ceil().clamp(1.0, 64.0);
        let at = |i: u32| ends[0] + (ends[1] - ends[0]) * f64::from(i) / parts;
        for i in 0..parts as u32 {
            let top = if f64::from(i + 1) < parts { at(i + 1) } else { ends[1] };
            steps.push(Step { bottom: at(i), top, interval });
        }
    }
    steps
}

/// Altitudes at which the extinction jumps.
fn jumps<const L: usize>(medium: &Medium<L>) -> Vec<f64> {
    let nodes = medium.nodes();
    (1..nodes.len() - 1)
        .filter(|&i| {
            let (below, above) = (medium.extinction_in(i - 1, 1.0), medium.extinction_in(i, 0.0));
            below.iter().zip(&above).any(|(a, b)| (a - b).abs() > 1e-9 * (a.abs() + b.abs()))
        })
        .map(|i| nodes[i])
        .collect()
}

/// Packs rows as the tables hold them: mean extinctions, below its start that of the start.
fn rows<const L: usize>(rows: Vec<(f64, Row<L>)>, bases: &[usize]) -> Rows<L> {
    let mut means = Vec::with_capacity(rows.len() * bases.len());
    for (_, row) in &rows {
        means.extend(bases.iter().enumerate().map(|(k, &base)| row.mean(k, base).map(|mean| mean as f32)));
    }
    let starts = rows.iter().map(|(_, row)| row.start).collect();
    let under = vec![None; rows.len()];
    Rows { at: Lookup::new(rows.into_iter().map(|(at, _)| at).collect()), under, means, starts }
}

impl<const L: usize> Exact<'_, L> {
    /// Extinction coefficients at an altitude of an interval.
    fn extinction(&self, interval: usize, altitude: f64) -> [f64; L] {
        let nodes = self.medium.nodes();
        let (a, b) = (nodes[interval], nodes[interval + 1]);
        self.medium.extinction_in(interval, ((altitude - a) / (b - a)).clamp(0.0, 1.0))
    }

    /// Extinction coefficients at the bottom and the top of a cell of the table, from inside.
    fn ends(&self, bottom: f64, top: f64) -> [[f64; L]; 2] {
        let first = self.steps.partition_point(|s| s.top <= bottom);
        let last = self.steps.partition_point(|s| s.bottom < top) - 1;
        [self.extinction(self.steps[first].interval, bottom), self.extinction(self.steps[last].interval, top)]
    }

    /// Makes no step reach over a node.
    fn cut(&mut self, nodes: &[f64]) {
        let mut cut = Vec::with_capacity(self.steps.len() + nodes.len());
        let mut node = 0;
        for &step in &self.steps {
            let mut rest = step;
            while node < nodes.len() && nodes[node] < rest.top {
                if nodes[node] > rest.bottom {
                    cut.push(Step { top: nodes[node], ..rest });
                    rest.bottom = nodes[node];
                }
                node += 1;
            }
            cut.push(rest);
        }
        self.steps = cut;
        self.look_at_steps();
    }

    /// Makes the nodes of all steps.
    fn look_at_steps(&mut self) {
        let nodes = self.steps.iter().map(|step| {
            let (middle, half) = (0.5 * (step.bottom + step.top), 0.5 * (step.top - step.bottom));
            let altitudes = GAUSS_4.map(|(x, _)| middle + half * x);
            let depth = |i: usize| self.extinction(step.interval, altitudes[i]).map(|e| GAUSS_4[i].1 * half * e);
            Nodes { altitudes, depths: std::array::from_fn(depth) }
        });
        self.nodes = nodes.collect();
    }

    /// Distance from the perigee `p` to the altitude `h` in m.
    #[inline(always)]
    fn distance(&self, p: f64, h: f64) -> f64 {
        match self.shape {
            Shape::Flat => h,
            Shape::Sphere { radius_m } => ((h - p) * (2.0 * radius_m + h + p)).max(0.0).sqrt(),
        }
    }

    /// Altitude at the distance `s` from the perigee `p`.
    fn altitude(&self, p: f64, s: f64) -> f64 {
        match self.shape {
            Shape::Flat => s,
            Shape::Sphere { radius_m } => {
                let r = radius_m + p;
                p + s * s / (r + (r * r + s * s).sqrt())
            }
        }
    }

    /// Optical depths of step `i`, added to `depths`. Far above the perigee the distance is so smooth in the altitude that Gauss' rule in
    /// the altitude does as well as in the distance, with nodes that serve all lines: from twice the height of a step on to 1e-8.
    #[inline(always)]
    fn add_whole_step(&self, p: f64, i: usize, depths: &mut [f64; L]) {
        const FAR: f64 = 2.0;
        let step = self.steps[i];
        if step.bottom - p < FAR * (step.top - step.bottom) {
            return self.add_step(p, p, step, depths);
        }
        let Nodes { altitudes, depths: nodes } = &self.nodes[i];
        for (stretch, node) in altitudes.map(|h| self.stretch(p, h)).into_iter().zip(nodes) {
            for j in 0..L {
                depths[j] += stretch * node[j];
            }
        }
    }

    /// Optical depths of one step above the altitude `from`, added to `depths`.
    fn add_step(&self, p: f64, from: f64, step: Step, depths: &mut [f64; L]) {
        let (a, b) = (self.distance(p, step.bottom.max(from)), self.distance(p, step.top));
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        for (x, weight) in GAUSS_4 {
            let extinction = self.extinction(step.interval, self.altitude(p, middle + half * x));
            for (depth, extinction) in depths.iter_mut().zip(extinction) {
                *depth += weight * half * extinction;
            }
        }
    }

    /// The row of the line with perigee `p`: from the perigee, or from the ground if that is below it.
    fn row(&self, p: f64, nodes: &[f64]) -> Row<L> {
        vectorised::<L, _>(OneRow { exact: self, p, nodes })
    }

    #[inline(always)]
    fn integrate(&self, p: f64, nodes: &[f64]) -> Row<L> {
        let from = p.max(0.0);
        let mut depths = vec![[0.0; L]; nodes.len()];
        let mut sum = [0.0; L];
        let first = self.steps.partition_point(|s| s.top <= from).min(self.steps.len() - 1);
        let mut node = nodes.partition_point(|&z| z <= from);
        for (i, step) in self.steps.iter().enumerate().skip(first) {
            if step.bottom < from {
                self.add_step(p, from, *step, &mut sum);
            } else {
                self.add_whole_step(p, i, &mut sum);
            }
            if node < nodes.len() && step.top >= nodes[node] {
                depths[node] = sum;
                node += 1;
            }
        }
        let distances = nodes.iter().map(|&z| self.distance(p, z.max(p))).collect();
        Row { distances, depths, start: self.extinction(self.steps[first].interval, from) }
    }

    /// Nodes of altitude: jumps, and bisection until the means between them hold.
    fn altitudes(&self) -> Vec<f64> {
        let intervals = self.medium.nodes();
        let mut kept = vec![0.0];
        let mut at = 0;
        for i in 1..intervals.len() {
            if i + 1 == intervals.len() || self.jumps.contains(&intervals[i]) {
                self.divide(intervals[at], intervals[i], 0, &mut kept);
                at = i;
            }
        }
        kept
    }

    /// Appends to `kept` the nodes in (bottom, top] that are needed.
    fn divide(&self, bottom: f64, top: f64, depth: u32, kept: &mut Vec<f64>) {
        const DEEPEST: u32 = 12;
        if depth == DEEPEST || self.cell_holds(bottom, top) {
            kept.push(top);
            return;
        }
        // At a kink of the profile if there is one near the middle.
        let middle = 0.5 * (bottom + top);
        let nodes = self.medium.nodes();
        let i = nodes.partition_point(|&z| z < middle);
        let near = [i.saturating_sub(1), i].map(|i| nodes[i.min(nodes.len() - 1)]);
        let middle = near
            .into_iter()
            .filter(|z| (z - middle).abs() < 0.25 * (top - bottom))
            .min_by(|a, b| (a - middle).abs().total_cmp(&(b - middle).abs()))
            .unwrap_or(middle);
        self.divide(bottom, middle, depth + 1, kept);
        self.divide(middle, top, depth + 1, kept);
    }

    /// Whether the means between two altitudes are as good as asked at seven places between, on lines that begin in
    /// the cell, below it, far below it, and on steeper ones.
    fn cell_holds(&self, bottom: f64, top: f64) -> bool {
        const PARTS: u32 = 8;
        let [low, high] = self.ends(bottom, top);
        let thickness = top - bottom;
        let mut lines = vec![0.0];
        if let Shape::Sphere { radius_m } = self.shape {
            lines.extend([0.0, 0.02, 0.3, 1.0, 4.0].map(|cells| bottom - cells * thickness));
            lines.extend([5e-4, 5e-3, 5e-2, 0.999].map(|share| -share * radius_m));
        }
        // Planes are crossed at any slant.
        let slant = if self.shape == Shape::Flat { 10.0 } else { 1.0 };
        // Depths count from the last jump.
        let base = self.jumps.iter().rfind(|&&jump| jump <= bottom).map_or(0.0, |&jump| jump);
        lines.into_iter().all(|p| {
            let start = p.max(base);
            let origin = self.distance(p, start);
            let mut depths = [[0.0; L]; PARTS as usize + 1];
            self.add_between(p, start, bottom, &mut depths[0]);
            for i in 1..=PARTS as usize {
                let [from, to] = [i - 1, i].map(|i| bottom + thickness * i as f64 / f64::from(PARTS));
                depths[i] = depths[i - 1];
                self.add_between(p, from, to, &mut depths[i]);
            }
            let length = |h: f64| self.distance(p, h) - origin;
            let (a, b) = (length(bottom), length(top));
            (1..PARTS).all(|i| {
                let t = f64::from(i) / f64::from(PARTS);
                let here = length(bottom + t * thickness);
                let [[between, _], [from_start, _]] = [between_weights(t), from_start_weights(t)];
                (0..L).all(|j| {
                    let upper = depths[PARTS as usize][j] / b;
                    let upper_slope = (high[j] - upper) * thickness * self.stretch(p, top) / b;
                    let lower = if a > 0.0 { depths[0][j] / a } else { low[j] };
                    let (weights, lower_slope) = if a <= 0.0 || (p > base && bottom - p < thickness) {
                        (from_start, 0.0)
                    } else {
                        (between, (low[j] - lower) * thickness * self.stretch(p, bottom) / a)
                    };
                    let [w, x, y, z] = weights;
                    let mean = w * lower + x * upper + y * lower_slope + z * upper_slope;
                    slant * (mean * here - depths[i as usize][j]).abs() <= self.tolerance.depth
                })
            })
        })
    }

    /// Optical depths of the line with perigee `p` between two altitudes, added to `depths`.
    fn add_between(&self, p: f64, from: f64, to: f64, depths: &mut [f64; L]) {
        let first = self.steps.partition_point(|s| s.top <= from).min(self.steps.len() - 1);
        for (i, &step) in self.steps.iter().enumerate().skip(first).take_while(|(_, s)| s.bottom < to) {
            if step.bottom < from || step.top > to {
                self.add_step(p, from, Step { top: step.top.min(to), ..step }, depths);
            } else {
                self.add_whole_step(p, i, depths);
            }
        }
    }

    /// ds/dh at an altitude of the line with perigee `p`.
    #[inline(always)]
    fn stretch(&self, p: f64, h: f64) -> f64 {
        match self.shape {
            Shape::Flat => 1.0,
            Shape::Sphere { radius_m } => (radius_m + h) / self.distance(p, h),
        }
    }

    /// Whether the row in the middle of two is their mean, as seen from the start of the line and from the top; `from` is
    /// the first node that counts.
    fn mean_holds(&self, rows: [&Row<L>; 3], bases: &[usize], from: usize) -> bool {
        vectorised::<L, _>(MeanHolds { exact: self, rows, bases, from })
    }

    #[inline(always)]
    fn compare(&self, [row_a, row_b, middle]: [&Row<L>; 3], bases: &[usize], from: usize) -> bool {
        let last = bases.len() - 1;
        let mut depths = middle.depths.clone();
        for k in from..=last {
            let base = bases[k];
            let (a, b) = (row_a.mean(k, base), row_b.mean(k, base));
            let (begin, _) = middle.begins(base);
            let counts_from_jump = begin > middle.distances[0];
            depths[k] = std::array::from_fn(|j| {
                let before = if counts_from_jump { depths[base][j] } else { 0.0 };
                before + 0.5 * (a[j] + b[j]) * (middle.distances[k] - begin)
            });
        }
        let off = |k: usize, j: usize| depths[k][j] - middle.depths[k][j];
        let whole = middle.depths[last];
        (from..=last).all(|k| {
            let depth = middle.depths[k];
            let [before, beyond] =
                [self.tolerance.allowed(depth), self.tolerance.allowed(std::array::from_fn(|j| whole[j] - depth[j]))];
            (0..L).all(|j| off(k, j).abs() <= before[j] && (off(last, j) - off(k, j)).abs() <= beyond[j])
        })
    }

    /// Rows between two, wherever their mean does not hold; `from` is the first node that counts.
    fn refine(
        &self,
        (a, row_a): (f64, Row<L>),
        (b, row_b): (f64, Row<L>),
        perigee: &(dyn Fn(f64) -> f64 + Sync),
        (nodes, bases): (&[f64], &[usize]),
        from: usize,
    ) -> Vec<(f64, Row<L>)> {
        let mut done = vec![(a, row_a)];
        let mut todo = vec![(b, row_b)];
        while let Some((x, row)) = todo.pop() {
            let (last, last_row) = &done[done.len() - 1];
            let middle = 0.5 * (last + x);
            let fits = done.len() + todo.len() >= MOST_ROWS || middle <= *last || middle >= x;
            let between = if fits { None } else { Some(self.row(perigee(middle), nodes)) };
            match between {
                Some(between) if !self.mean_holds([last_row, &row, &between], bases, from) => {
                    todo.push((x, row));
                    todo.push((middle, between));
                }
                _ => done.push((x, row)),
            }
        }
        done
    }

    /// Rows for lines above the ground: every node of altitude is a perigee, with others between.
    ///
    /// On a line that turns at p below a jump at z, what lies below the jump is crossed over a length that goes as
    /// q = sqrt(z - p), and with it all depths above: in such a cell rows go by -q instead of p.
    fn limb(&self, nodes: &[f64], bases: &[usize]) -> Rows<L> {
        let cells: Vec<Vec<(f64, Row<L>)>> = (0..nodes.len() - 1)
            .into_par_iter()
            .map(|i| {
                let (bottom, top) = (nodes[i], nodes[i + 1]);
                if !self.jumps.contains(&top) {
                    let [a, b] = [bottom, top].map(|p| (p, self.row(p, nodes)));
                    let mut rows = self.refine(a, b, &|p| p, (nodes, bases), i + 1);
                    rows.pop();
                    return rows;
                }
                // The upper row still begins below the jump.
                let below = top.next_down();
                let perigee = |x: f64| (top - x * x).clamp(bottom, below);
                let [a, b] = [bottom, below].map(|p| (-(top - p).sqrt(), self.row(p, nodes)));
                let mut rows = self.refine(a, b, &perigee, (nodes, bases), i + 1);
                for (x, _) in &mut rows {
                    *x = perigee(*x);
                }
                rows
            })
            .collect();
        let top = nodes[nodes.len() - 1];
        let mut under = Vec::new();
        for (rows, &above) in cells.iter().zip(&nodes[1..]) {
            let jump = self.jumps.contains(&above).then_some(above);
            under.extend(rows.iter().map(|_| jump));
            // Nothing lies between the last row of a cell under a jump and the jump itself.
            if let (Some(last), Some(_)) = (under.last_mut(), jump) {
                *last = None;
            }
        }
        under.push(None);
        let mut all: Vec<_> = cells.into_iter().flatten().collect();
        all.push((top, self.row(top, nodes)));
        Rows { under, ..rows(all, bases) }
    }

    /// Rows for lines that cut the planet, by the cosine of the zenith angle at the ground.
    fn ground(&self, radius_m: f64, nodes: &[f64], bases: &[usize]) -> Rows<L> {
        // Close enough that the middle of two tells of all between.
        const FIRST: usize = 32;
        let cosines: Vec<f64> = (0..=FIRST).map(|i| (i as f64 / FIRST as f64).powi(3)).collect();
        let perigee = |mu: f64| -radius_m * mu * mu / (1.0 + ((1.0 - mu) * (1.0 + mu)).sqrt());
        let cells: Vec<Vec<(f64, Row<L>)>> = cosines
            .par_windows(2)
            .map(|ends| {
                let [a, b] = [ends[0], ends[1]].map(|mu| (mu, self.row(perigee(mu), nodes)));
                let mut rows = self.refine(a, b, &perigee, (nodes, bases), 1);
                rows.pop();
                rows
            })
            .collect();
        let mut all: Vec<_> = cells.into_iter().flatten().collect();
        all.push((1.0, self.row(perigee(1.0), nodes)));
        rows(all, bases)
    }
}

/// [`Exact::row`] as work for vectors.
struct OneRow<'a, const L: usize> {
    exact: &'a Exact<'a, L>,
    p: f64,
    nodes: &'a [f64],
}

impl<const L: usize> NullaryFnOnce for OneRow<'_, L> {
    type Output = Row<L>;

    #[inline(always)]
    fn call(self) -> Row<L> {
        self.exact.integrate(self.p, self.nodes)
    }
}

/// [`Exact::mean_holds`] as work for vectors.
struct MeanHolds<'a, const L: usize> {
    exact: &'a Exact<'a, L>,
    rows: [&'a Row<L>; 3],
    bases: &'a [usize],
    from: usize,
}

impl<const L: usize> NullaryFnOnce for MeanHolds<'_, L> {
    type Output = bool;

    #[inline(always)]
    fn call(self) -> bool {
        self.exact.compare(self.rows, self.bases, self.from)
    }
}

/// The cubic with given values and derivatives at both ends of [0, 1]: the weights of (value at 0, at 1, derivative at 0,
/// at 1) in its value at t, and in its derivative.
#[inline]
pub(super) fn between_weights(t: f64) -> [[f64; 4]; 2] {
    let rest = 1.0 - t;
    let (rise, bend) = (t * t * (3.0 - 2.0 * t), 6.0 * t * rest);
    [[1.0 - rise, rise, t * rest * rest, -t * t * rest], [-bend, bend, rest * (1.0 - 3.0 * t), t * (3.0 * t - 2.0)]]
}

/// As [`between_weights`], of the parabola that does not know the derivative at 0.
#[inline]
pub(super) fn from_start_weights(t: f64) -> [[f64; 4]; 2] {
    let rest = 1.0 - t;
    [[rest * rest, t * (2.0 - t), 0.0, -t * rest], [-2.0 * rest, 2.0 * rest, 0.0, 2.0 * t - 1.0]]
}

#[cfg(test)]
mod tests {
    use super::super::tests::{EARTH, medium};
    use super::*;

    fn exact(medium: &Medium<2>) -> Exact<'_, 2> {
        let (steps, jumps) = (steps(medium), jumps(medium));
        let mut exact = Exact { medium, shape: EARTH, steps, nodes: Vec::new(), tolerance: Tolerance::RENDER, jumps };
        exact.look_at_steps();
        exact
    }

    #[test]
    fn nodes_in_altitude_are_as_good_as_in_distance() {
        // Steps from twice their height above the perigee on: 1e-8 of Gauss' rule for a root, and its rounding.
        let medium = medium();
        let exact = exact(&medium);
        let mut far = 0;
        for p in [-6e6, -3e4, -100.0, 0.0, 1.5e3, 2.2e4, 6e4] {
            for (i, step) in exact.steps.iter().enumerate().filter(|(_, step)| step.bottom >= p) {
                let (mut a, mut b) = ([0.0; 2], [0.0; 2]);
                exact.add_whole_step(p, i, &mut a);
                exact.add_step(p, p, *step, &mut b);
                far += usize::from(a != b);
                for j in 0..2 {
                    assert!((a[j] - b[j]).abs() <= 2e-8 * b[j], "perigee {p}, {step:?}: {a:?}, {b:?}");
                }
            }
        }
        assert!(far > 100, "only {far} steps told the two apart");
    }

    #[test]
    fn the_width_of_vectors_makes_no_difference() {
        let medium = medium();
        let mut exact = exact(&medium);
        let nodes = exact.altitudes();
        exact.cut(&nodes);
        for p in [-1e5, 0.0, 3e3] {
            let (wide, plain) = (exact.row(p, &nodes), exact.integrate(p, &nodes));
            assert_eq!((wide.distances, wide.depths), (plain.distances, plain.depths));
        }
    }
}
