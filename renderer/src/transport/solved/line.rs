//! One line through the shells: where it crosses the levels, and light scattered into it, weighted and attenuated.

use super::Optics;
use crate::atmosphere::{Chord, GAUSS_4};
use crate::vectors::exp_minus;

/// A crossing of a line with a level.
#[derive(Debug, Clone, Copy)]
pub(super) struct Crossing {
    /// Which level.
    pub(super) level: usize,
    /// Distance from the line's perigee in m, as points of a [`Chord`] are named.
    pub(super) s: f64,
}

/// Crossings nearer to each other than this, in m, are one.
const SAME_M: f64 = 1e-2;

/// The crossings of the chord's line with the `levels` (altitudes in m) between `from` and the chord's end, in order.
pub(super) fn crossings<const L: usize>(chord: &Chord<'_, L>, levels: &[f64], from: f64) -> Vec<Crossing> {
    let mut all: Vec<Crossing> = Vec::with_capacity(2 * levels.len());
    let (_, to) = chord.ends();
    let mut push = |level: usize, s: f64| {
        if s >= from - SAME_M && s <= to + SAME_M && all.last().is_none_or(|last| s > last.s + SAME_M) {
            all.push(Crossing { level, s });
        }
    };
    let perigee = chord.perigee();
    if from < 0.0 {
        for (level, &h) in levels.iter().enumerate().rev().filter(|(_, h)| **h >= perigee) {
            push(level, -chord.distance(h));
        }
    }
    if to > 0.0 {
        for (level, &h) in levels.iter().enumerate().filter(|(_, h)| **h >= perigee) {
            push(level, chord.distance(h));
        }
    }
    all
}

/// Lagrange's polynomial through up to four of the places around an interval.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stencil {
    /// The first of them.
    pub(super) first: usize,
    /// How many, at least one.
    pub(super) count: usize,
}

impl Stencil {
    /// Around the interval between places `i` and `i + 1`, not beyond a wall.
    pub(super) fn around(i: usize, places: &[Crossing], walls: &[bool]) -> Self {
        let wall = |k: &usize| walls[places[*k].level];
        let low = (0..=i).rev().find(wall).unwrap_or(0);
        let high = (i + 1..places.len()).find(wall).unwrap_or(places.len() - 1);
        let count = (high + 1 - low).min(4);
        Self { first: i.saturating_sub(1).max(low).min(high + 1 - count), count }
    }

    /// The polynomials through these places.
    pub(super) fn through(self, places: &[Crossing]) -> Lagrange {
        let (mut at, mut factors) = ([0.0; 4], [0.0; 4]);
        let places = &places[self.first..self.first + self.count];
        for (k, place) in places.iter().enumerate() {
            let others = places.iter().enumerate().filter(|(i, _)| *i != k);
            at[k] = place.s;
            factors[k] = 1.0 / others.map(|(_, other)| place.s - other.s).product::<f64>();
        }
        Lagrange { stencil: self, at, factors }
    }
}

/// Lagrange's polynomials l_k(s) = prod_(i != k) (s - s_i) / (s_k - s_i) of a stencil.
#[derive(Debug, Clone, Copy)]
pub(super) struct Lagrange {
    pub(super) stencil: Stencil,
    /// s_k, and prod_(i != k) 1 / (s_k - s_i); 0 beyond the stencil.
    at: [f64; 4],
    factors: [f64; 4],
}

impl Lagrange {
    /// Their values at `s`, 0 beyond the stencil.
    #[inline(always)]
    pub(super) fn weights(&self, s: f64) -> [f64; 4] {
        // Of places that are not there the differences are 1.
        let count = self.stencil.count;
        let [u, v, w, x] = std::array::from_fn(|k| if k < count { s - self.at[k] } else { 1.0 });
        let [a, b, c, d] = self.factors;
        let (uv, wx) = (u * v, w * x);
        [a * v * wx, b * u * wx, c * uv * x, d * uv * w]
    }
}

/// What becomes of the points of a quadrature along a chord. (No closure, since those are not always inlined.)
pub(super) trait Take<const L: usize> {
    /// A point, and of each species the weight of the point in m, times the transmittance to the chord's beginning, times the
    /// scattering coefficient.
    fn take(&mut self, s: f64, scattered: &[[f64; L]]);
}

impl<T: Take<L>, const L: usize> Take<L> for &mut T {
    #[inline(always)]
    fn take(&mut self, s: f64, scattered: &[[f64; L]]) {
        (**self).take(s, scattered);
    }
}

impl<A: Take<L>, B: Take<L>, const L: usize> Take<L> for (A, Option<B>) {
    #[inline(always)]
    fn take(&mut self, s: f64, scattered: &[[f64; L]]) {
        self.0.take(s, scattered);
        if let Some(other) = &mut self.1 {
            other.take(s, scattered);
        }
    }
}

/// Takes the sum over all points times Lagrange's polynomials through the crossings around an interval: weights of the
/// crossings in the integral of what lies between.
pub(super) struct Spread<'a, const L: usize> {
    pub(super) polynomials: Lagrange,
    /// Of each crossing in turn those of each species.
    pub(super) weights: &'a mut [[f64; L]],
}

impl<const L: usize> Take<L> for Spread<'_, L> {
    #[inline(always)]
    fn take(&mut self, s: f64, scattered: &[[f64; L]]) {
        let (Stencil { first, count }, shares) = (self.polynomials.stencil, self.polynomials.weights(s));
        let nodes = self.weights.chunks_exact_mut(scattered.len()).skip(first);
        for (node, share) in nodes.take(count).zip(shares) {
            for (sum, one) in node.iter_mut().zip(scattered) {
                for j in 0..L {
                    sum[j] += share * one[j];
                }
            }
        }
    }
}

/// How an interval is integrated.
#[derive(Debug, Clone, Copy)]
pub(super) struct Rule<'a> {
    /// With Gauss' rule of four nodes rather than two.
    pub(super) fine: bool,
    /// The least number of parts of the interval.
    pub(super) least: f64,
    /// Altitudes in m at which the interval is divided.
    pub(super) bends: &'a [f64],
}

/// Optical depth beyond which nothing more is looked for: a transmittance of 1e-9.
const DARK: f64 = 20.7;

/// Most parts that an interval is divided into for its optical depth, and how much of it a part may have.
const MOST_PARTS: (f64, f64) = (8.0, 0.8);

/// Gauss' rule with two nodes on -1 to 1.
const GAUSS_2: [(f64, f64); 2] = [(-0.577_350_269_189_625_8, 1.0), (0.577_350_269_189_625_8, 1.0)];

/// Gives `take` the points of Gauss' rule (four nodes, or two) in the interval `from` to `to` of a chord, divided
/// into parts, more where it is optically thick. False once it is too dark for anything to arrive, or where nothing scatters.
#[inline(always)]
pub(super) fn quadrature<const L: usize>(
    chord: &Chord<'_, L>,
    optics: &Optics<L>,
    (from, to): (f64, f64),
    Rule { fine, least, bends }: Rule<'_>,
    take: &mut impl Take<L>,
) -> bool {
    let species = &optics.species;
    if species.is_empty() {
        return false;
    }
    let (start, end) = (chord.point(from).depth, chord.point(to).depth);
    let mut thick = 0.0_f64;
    let mut lit = false;
    for (start, end) in start.into_iter().zip(end) {
        if start < DARK {
            lit = true;
            thick = thick.max((end - start).min(12.0));
        }
    }
    if !lit {
        return false;
    }
    let (most, each) = MOST_PARTS;
    let parts = (thick / each).ceil().clamp(1.0, most).max(least);
    let mut scattered = [[0.0; L]; MOST_SPECIES];
    let rule: &[(f64, f64)] = if fine { &GAUSS_4 } else { &GAUSS_2 };
    // Where the interval is divided, before and after the perigee.
    let mut ends = [to; MOST_BENDS + 1];
    let mut count = 0;
    if !bends.is_empty() {
        let (low, high) = (from.abs().min(to.abs()), from.abs().max(to.abs()));
        let low = if from < 0.0 && to > 0.0 { 0.0 } else { low };
        for distance in bends.iter().filter(|h| **h > chord.perigee()).map(|h| chord.distance(*h)) {
            for s in [-distance, distance] {
                if distance > low && distance < high && s > from && s < to && count < MOST_BENDS {
                    ends[count] = s;
                    count += 1;
                }
            }
        }
        ends[..count].sort_by(f64::total_cmp);
    }
    let mut start = from;
    for &end in &ends[..=count] {
        let parts = (parts * (end - start) / (to - from)).ceil().max(1.0);
        let half = 0.5 * (end - start) / parts;
        for part in 0..parts as u32 {
            let middle = start + half * f64::from(2 * part + 1);
            for &(x, weight) in rule {
                let s = middle + half * x;
                let through = exp_minus(chord.point(s).depth);
                let densities = optics.medium.densities_at(chord.altitude(s));
                for (row, one) in scattered.iter_mut().zip(species) {
                    let factor = weight * half * densities[one.component];
                    *row = std::array::from_fn(|j| factor * one.scattering[j] * through[j]);
                }
                take.take(s, &scattered[..species.len()]);
            }
        }
        start = end;
    }
    true
}

/// The most bends in one interval; further ones are not heeded.
const MOST_BENDS: usize = 16;

/// The most species that scatter.
pub(super) const MOST_SPECIES: usize = crate::atmosphere::MAX_COMPONENTS;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_do_not_reach_over_walls() {
        let places: Vec<Crossing> = (0..9).map(|level| Crossing { level, s: level as f64 }).collect();
        let of = |i: usize, walls: &[usize]| {
            let walls: Vec<bool> = (0..9).map(|level| walls.contains(&level)).collect();
            let Stencil { first, count } = Stencil::around(i, &places, &walls);
            (first, count)
        };
        let all: Vec<_> = (0..8).map(|i| of(i, &[4])).collect();
        assert_eq!(all, [(0, 4), (0, 4), (1, 4), (1, 4), (4, 4), (4, 4), (5, 4), (5, 4)]);
        // Of a layer with one level inside a parabola is left, of one with none a line.
        assert_eq!((of(4, &[4, 6]), of(5, &[4, 6])), ((4, 3), (4, 3)));
        assert_eq!(of(4, &[4, 5]), (4, 2));
    }
}
