//! What is seen between the looks of a panorama.

use super::Solved;
use super::line::MOST_SPECIES;
use super::view::Seen;
use pulp::NullaryFnOnce;

/// Nodes of a polynomial.
const NODES: usize = 6;

/// Looks at the nodes of a part.
#[derive(Debug)]
pub(super) struct Nodes<const L: usize> {
    pub(super) rings: usize,
    pub(super) azimuths: usize,
    /// [ring][azimuth][`rows`]: what is seen.
    values: Vec<[f32; L]>,
    rows: usize,
    species: usize,
}

impl<const L: usize> Nodes<L> {
    /// Of looks: rings, and on each as many azimuths from the sun's to its opposite.
    pub(super) fn new<'a>(rings: impl Iterator<Item = impl Iterator<Item = &'a Seen<L>>>, solved: &Solved<L>) -> Self {
        let species = solved.optics.species.len();
        let polarised = solved.is_polarised();
        let rows = if polarised { 4 + 2 * species } else { 2 + species };
        let single = |row: &[f64; L]| row.map(|value| value as f32);
        let (mut values, mut count) = (Vec::new(), 0);
        for ring in rings {
            for seen in ring {
                values.extend([single(&seen.rest), single(&seen.peaks)]);
                values.extend(seen.once[..species].iter().map(single));
                if polarised {
                    values.extend(seen.turned[..species].iter().map(single));
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
        self.solved.shade(&self.nodes.seen(self.at), self.towards, false)
    }
}

/// What nodes say of a direction, before the phase functions.
pub(super) struct Interpolation<'a, const L: usize>(pub(super) &'a Nodes<L>, pub(super) [f64; 2]);

impl<const L: usize> NullaryFnOnce for Interpolation<'_, L> {
    type Output = Seen<L>;

    #[inline(always)]
    fn call(self) -> Seen<L> {
        self.0.seen(self.1)
    }
}

impl<const L: usize> Nodes<L> {
    #[inline(always)]
    fn seen(&self, [ring, azimuth]: [f64; 2]) -> Seen<L> {
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
        let mut values = [[0.0_f32; L]; 2 * MOST_SPECIES + 4];
        let last = 3 + 2 * self.species;
        for (row, value) in values.iter_mut().enumerate().take(self.rows) {
            // The last row is U.
            let weights = if row == last { &odd } else { &even };
            // Two sums, so that neither waits for itself.
            let (mut first, mut second) = ([0.0_f32; L], [0.0_f32; L]);
            for k in 0..NODES * NODES / 2 {
                let (a, b) = (&self.values[places[2 * k] + row], &self.values[places[2 * k + 1] + row]);
                for j in 0..L {
                    first[j] += weights[2 * k] * a[j];
                }
                for j in 0..L {
                    second[j] += weights[2 * k + 1] * b[j];
                }
            }
            for j in 0..L {
                value[j] = first[j] + second[j];
            }
        }
        let [rest, peaks, others @ ..] = values.map(|row| row.map(f64::from));
        let (mut once, mut turned) = ([[0.0; L]; MOST_SPECIES], [[0.0; L]; MOST_SPECIES]);
        once[..self.species].copy_from_slice(&others[..self.species]);
        turned[..self.species].copy_from_slice(&others[self.species..2 * self.species]);
        Seen { rest, peaks, once, turned, linear: [others[2 * self.species], others[2 * self.species + 1]] }
    }
}
