//! What is seen between the looks of a panorama.

use super::Solved;
use super::line::MOST_SPECIES;
use super::view::Seen;
use crate::vectors::add_scaled;
use pulp::NullaryFnOnce;

/// Nodes of a polynomial.
const NODES: usize = 6;

/// Looks at the nodes of a part.
#[derive(Debug)]
pub(super) struct Nodes<const L: usize> {
    pub(super) rings: usize,
    pub(super) azimuths: usize,
    /// [ring][azimuth][`rows`]: what is seen. Without polarisation: the light that is smooth in the direction; the depth of peaks and what
    /// each species of particles scatters once. With it: the rest; peaks; what each species scatters once, as it counts for I and for
    /// Q and U; Q and U.
    values: Vec<[f32; L]>,
    rows: usize,
    /// Which species have rows.
    species: Vec<usize>,
}

impl<const L: usize> Nodes<L> {
    /// Of looks: rings, and on each as many azimuths from the sun's to its opposite; each with the cosine of the angle from the sun.
    pub(super) fn new<'a>(
        rings: impl Iterator<Item = impl Iterator<Item = (f64, &'a Seen<L>)>>,
        solved: &Solved<L>,
    ) -> Self {
        let polarised = solved.is_polarised();
        let all = solved.optics.species.iter().enumerate();
        let species: Vec<_> = all.filter(|(_, one)| polarised || !one.is_molecular()).map(|(index, _)| index).collect();
        let rows = match species.len() {
            count if polarised => 4 + 2 * count,
            0 => 1,
            count => 2 + count,
        };
        let single = |row: &[f64; L]| row.map(|value| value as f32);
        let (mut values, mut count) = (Vec::new(), 0);
        for ring in rings {
            for (towards, seen) in ring {
                values.push(if polarised {
                    single(&seen.rest)
                } else {
                    single(&solved.smooth((&seen.rest, &seen.once), towards))
                });
                if rows > 1 {
                    values.push(single(&seen.peaks));
                }
                values.extend(species.iter().map(|&index| single(&seen.once[index])));
                if polarised {
                    values.extend(species.iter().map(|&index| single(&seen.turned[index])));
                    values.extend(seen.linear.iter().map(single));
                }
            }
            count += 1;
        }
        let azimuths = values.len() / (rows * count) - 1;
        Self { rings: count - 1, azimuths, values, rows, species }
    }
}

/// Weights of Lagrange's polynomial through nodes at 0, 1 and so on.
#[inline(always)]
fn weights(x: f64) -> [f64; NODES] {
    const DIVISORS: [f64; NODES] = [-120.0, 24.0, -12.0, 12.0, -24.0, 120.0];
    let [a, b, c, d, e, f] = [0.0, 1.0, 2.0, 3.0, 4.0, 5.0].map(|node| x - node);
    let (ab, cd, ef) = (a * b, c * d, e * f);
    let products = [b * cd * ef, a * cd * ef, ab * d * ef, ab * c * ef, ab * cd * f, ab * cd * e];
    std::array::from_fn(|k| products[k] / DIVISORS[k])
}

/// The nodes around a place at a share of so many intervals, and their weights: of one ring itself.
#[inline(always)]
fn inside(intervals: usize, share: f64) -> [(usize, f64); NODES] {
    if intervals == 0 {
        let mut one = [(0, 0.0); NODES];
        one[0].1 = 1.0;
        return one;
    }
    let place = share * intervals as f64;
    let first = (place as usize).saturating_sub(NODES / 2 - 1).min(intervals + 1 - NODES);
    let weights = weights(place - first as f64);
    std::array::from_fn(|k| (first + k, weights[k]))
}

/// As [`inside`], where all goes on mirrored at both ends, also of what changes sign there.
#[inline(always)]
fn mirrored(intervals: usize, share: f64) -> [(usize, f64, f64); NODES] {
    let place = share * intervals as f64;
    let first = place.floor() as i64 - (NODES as i64 / 2 - 1);
    let weights = weights(place - first as f64);
    let last = intervals as i64;
    std::array::from_fn(|k| {
        let at = (first + k as i64).abs();
        let odd = if first + k as i64 != at || at > last { -weights[k] } else { weights[k] };
        ((if at > last { 2 * last - at } else { at }) as usize, weights[k], odd)
    })
}

/// What nodes say of a direction.
pub(super) struct Glance<'a, const L: usize> {
    pub(super) solved: &'a Solved<L>,
    pub(super) nodes: &'a Nodes<L>,
    pub(super) at: [f64; 2],
    pub(super) towards: f64,
}

impl<const L: usize> NullaryFnOnce for Glance<'_, L> {
    type Output = [f64; L];

    #[inline(always)]
    fn call(self) -> [f64; L] {
        let Self { solved, nodes, at, towards } = self;
        let count = if nodes.species.is_empty() { 1 } else { 2 + nodes.species.len() };
        let [mut smooth, peaks, once @ ..] = nodes.rows::<{ 2 + MOST_SPECIES }>(at, count);
        if nodes.species.is_empty() {
            return smooth;
        }
        let once = nodes.of_species(&once);
        if nodes.is_polarised() {
            smooth = solved.smooth((&smooth, &once), towards);
        }
        solved.with_particles(&smooth, (&peaks, &once), towards, false)
    }
}

/// What nodes of polarised light say of a direction, before the phase functions.
pub(super) struct Interpolation<'a, const L: usize>(pub(super) &'a Nodes<L>, pub(super) [f64; 2]);

impl<const L: usize> NullaryFnOnce for Interpolation<'_, L> {
    type Output = Seen<L>;

    #[inline(always)]
    fn call(self) -> Seen<L> {
        self.0.seen(self.1)
    }
}

impl<const L: usize> Nodes<L> {
    /// Of polarised light.
    #[inline(always)]
    fn seen(&self, at: [f64; 2]) -> Seen<L> {
        let [rest, peaks, others @ ..] = self.rows::<{ 4 + 2 * MOST_SPECIES }>(at, self.rows);
        let (once, others) = others.split_at(self.species.len());
        let (turned, linear) = others.split_at(self.species.len());
        Seen {
            rest,
            peaks,
            once: self.of_species(once),
            turned: self.of_species(turned),
            linear: [linear[0], linear[1]],
        }
    }

    /// Rows of the species that have one, zero of others.
    #[inline(always)]
    fn of_species(&self, rows: &[[f64; L]]) -> [[f64; L]; MOST_SPECIES] {
        let mut all = [[0.0; L]; MOST_SPECIES];
        for (row, &index) in rows.iter().zip(&self.species) {
            all[index] = *row;
        }
        all
    }

    /// The first `count` rows at a place, and zeros.
    #[inline(always)]
    fn rows<const N: usize>(&self, [ring, azimuth]: [f64; 2], count: usize) -> [[f64; L]; N] {
        let (along, across) = (inside(self.rings, ring), mirrored(self.azimuths, azimuth));
        let (mut places, mut even, mut odd) = ([0; NODES * NODES], [0.0; NODES * NODES], [0.0; NODES * NODES]);
        for i in 0..NODES {
            for k in 0..NODES {
                let ((ring, a), (azimuth, b, c)) = (along[i], across[k]);
                places[i * NODES + k] = (ring * (self.azimuths + 1) + azimuth) * self.rows;
                even[i * NODES + k] = (a * b) as f32;
                odd[i * NODES + k] = (a * c) as f32;
            }
        }
        let mut rows = [[0.0; L]; N];
        // The last row of polarised light is U.
        let even_rows = if self.is_polarised() { count.min(self.rows - 1) } else { count };
        let mut row = 0;
        while row + 4 <= even_rows {
            let sums: [_; 4] = self.sums(row, &places, &even);
            rows[row..row + 4].copy_from_slice(&sums);
            row += 4;
        }
        while row < count {
            let weights = if row < even_rows { &even } else { &odd };
            [rows[row]] = self.sums(row, &places, weights);
            row += 1;
        }
        rows
    }

    /// Of the rows from one on, the sums over nodes, which begin at these places.
    #[inline(always)]
    fn sums<const N: usize>(
        &self,
        first: usize,
        places: &[usize; NODES * NODES],
        weights: &[f32; NODES * NODES],
    ) -> [[f64; L]; N] {
        let mut sums = [[0.0_f32; L]; N];
        for k in 0..NODES * NODES {
            let rows = &self.values[places[k] + first..][..N];
            for i in 0..N {
                add_scaled(&mut sums[i], weights[k], &rows[i]);
            }
        }
        sums.map(|row| row.map(f64::from))
    }

    fn is_polarised(&self) -> bool {
        self.rows > 2 + self.species.len()
    }
}
