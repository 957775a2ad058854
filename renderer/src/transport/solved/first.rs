//! The first order: sunlight scattered once, or reflected by the ground, on its way along each line.

use super::Setup;
use super::harmonics::legendre;
use super::line::{MOST_SPECIES, Rule, Sum, crossings, quadrature};
use super::orders::{Gathered, Turns, azimuth_cosines};
use super::rays::Line;
use crate::geometry::Place;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::FRAC_1_PI;

/// Sunlight at many altitudes: transmittance to the sun.
///
/// At radius r the place in a row is x = (d - d_least) / (d_most - d_least), d the distance to the top of the atmosphere
/// towards the sun: even in x the nodes are close where transmittance changes fast, and the last belongs to the sun that touches
/// the horizon (the mapping of Bruneton & Neyret 2008).
pub(super) struct Sunlight<const L: usize> {
    /// Altitudes in m, increasing.
    altitudes: Vec<f64>,
    rows: Vec<Row>,
    values: Vec<[f32; L]>,
}

/// Where the numbers of a radius lie.
#[derive(Debug, Clone, Copy)]
struct Row {
    /// (r_top^2 - r^2) / r_top^2 and r / r_top.
    room: f32,
    radius: f32,
    /// d_least and 1 / (d_most - d_least), in r_top.
    least: f32,
    scale: f32,
    /// Cosine of the zenith angle of a sun that touches the horizon.
    horizon: f32,
}

/// Nodes of a row.
const NODES: usize = 384;

impl<const L: usize> Sunlight<L> {
    /// Sunlight at the levels and at `parts - 1` altitudes between each two.
    pub(super) fn new(setup: &Setup<'_, L>, parts: usize) -> Self {
        let levels = &setup.grid.levels;
        let mut altitudes = Vec::new();
        for ends in levels.windows(2) {
            altitudes.extend((0..parts).map(|i| ends[0] + (ends[1] - ends[0]) * i as f64 / parts as f64));
        }
        altitudes.extend(levels.last());
        let (bottom, top) = (setup.grid.radius, setup.grid.radius + altitudes[altitudes.len() - 1]);
        let row = |h: &f64| {
            let r = bottom + h;
            let room = ((top - r) * (top + r)).max(0.0);
            let low = ((r - bottom) * (r + bottom)).max(0.0).sqrt();
            let least = top - r;
            let most = low + ((top - bottom) * (top + bottom)).sqrt();
            (r, room, least, most, -low / r)
        };
        let values: Vec<Vec<[f32; L]>> = altitudes
            .par_iter()
            .map(|h| {
                let (r, room, least, most, horizon) = row(h);
                let node = |i: usize| {
                    let d = least + (most - least) * i as f64 / (NODES - 1) as f64;
                    let cosine = if d > 0.0 { (room - d * d) / (2.0 * r * d) } else { 1.0 };
                    // A sun on the horizon itself would be hidden by rounding.
                    let cosine = cosine.clamp(horizon + 1e-9, 1.0);
                    let direction = DVec3::new(((1.0 - cosine) * (1.0 + cosine)).sqrt(), 0.0, cosine);
                    let through = setup.optics.columns.transmittance(Place::above(*h), direction);
                    through.map_or([0.0; L], |through| through.map(|t| t as f32))
                };
                (0..NODES).map(node).collect()
            })
            .collect();
        let rows = altitudes.iter().map(|h| {
            let (r, room, least, most, horizon) = row(h);
            Row {
                room: (room / (top * top)) as f32,
                radius: (r / top) as f32,
                least: (least / top) as f32,
                scale: (top / (most - least)) as f32,
                horizon: horizon as f32,
            }
        });
        Self { rows: rows.collect(), values: values.concat(), altitudes }
    }

    /// Where in a row the suns of these cosines are: the node before each, and the fraction to the next.
    #[inline(always)]
    fn locate<const N: usize>(&self, row: usize, cosines: &[f32; N]) -> ([i32; N], [f32; N]) {
        let Row { room, radius, least, scale, .. } = self.rows[row];
        let (mut nodes, mut fractions) = ([0; N], [0.0; N]);
        for i in 0..N {
            let along = radius * cosines[i];
            let root = (room + along * along).sqrt();
            // In the form that adds numbers of one sign.
            let d = if along > 0.0 { room / (root + along) } else { root - along };
            let at = ((d - least) * scale).clamp(0.0, 1.0) * (NODES - 1) as f32;
            let node = at.min((NODES - 2) as f32) as i32;
            nodes[i] = node;
            fractions[i] = at - node as f32;
        }
        (nodes, fractions)
    }

    /// Transmittance at altitude number `row`, so far between a node and the next.
    #[inline(always)]
    fn at(&self, row: usize, node: i32, fraction: f32) -> [f32; L] {
        let node = row * NODES + node as usize;
        let (a, b) = (&self.values[node], &self.values[node + 1]);
        std::array::from_fn(|j| a[j] + fraction * (b[j] - a[j]))
    }

    /// Transmittance to a sun on the horizon.
    #[inline(always)]
    fn at_horizon(&self, row: usize) -> &[f32; L] {
        &self.values[row * NODES + NODES - 1]
    }

    /// How far the sun is above the horizon, as a difference of cosines.
    #[inline(always)]
    fn above(&self, row: usize, cosine: f32) -> f32 {
        cosine - self.rows[row].horizon
    }
}

/// Values of the phase functions that the moments stand for, between these cosines.
pub(super) struct Scattering<const L: usize> {
    /// Of each species, at equal steps of the cosine.
    values: Vec<Vec<[f32; L]>>,
}

impl<const L: usize> Scattering<L> {
    const STEPS: usize = 4096;

    pub(super) fn new(setup: &Setup<'_, L>) -> Self {
        let degree = setup.optics.moments.degree();
        let polynomials: Vec<Vec<f64>> =
            (0..=Self::STEPS).map(|i| legendre(degree, 2.0 * i as f64 / Self::STEPS as f64 - 1.0)).collect();
        let values = setup.optics.species.iter().map(|one| {
            let value = |p: &Vec<f64>| {
                let mut sum = [0.0; L];
                for (b, p) in one.coefficients.iter().zip(p) {
                    for j in 0..L {
                        sum[j] += b[j] * p;
                    }
                }
                sum.map(|v| v as f32)
            };
            polynomials.iter().map(value).collect()
        });
        Self { values: values.collect() }
    }

    #[inline(always)]
    fn at(&self, species: usize, cosine: f32) -> [f32; L] {
        let at = (0.5 * (cosine + 1.0)).clamp(0.0, 1.0) * Self::STEPS as f32;
        let i = (at as usize).min(Self::STEPS - 1);
        let f = at - i as f32;
        let (a, b) = (&self.values[species][i], &self.values[species][i + 1]);
        std::array::from_fn(|j| a[j] + f * (b[j] - a[j]))
    }
}

/// A crossing of a line with an altitude of [`Sunlight`].
struct Step<const L: usize> {
    row: usize,
    frame: [f32; 2],
    /// What the way from the crossing before scatters, and that to the next, half of each: of each species.
    before: Vec<[f32; L]>,
    after: Vec<[f32; L]>,
}

/// Moments at a level (of a sun, of each (l, m)) of the first order, and, of use at the ground, the irradiance from above.
#[inline(always)]
pub(super) fn scatter<const L: usize, const AZIMUTHS: usize>(
    setup: &Setup<'_, L>,
    level: usize,
    lines: &[Line<L>],
    sunlight: &Sunlight<L>,
    scattering: &Scattering<L>,
) -> (Vec<[f32; L]>, Vec<[f32; L]>) {
    let suns = &setup.grid.suns;
    let mut sum = Gathered::new(setup.optics.moments.count(), suns.count());
    let mut radiance = vec![[[0.0; L]; AZIMUTHS]; suns.count()];
    for line in lines {
        let steps = steps(setup, level, line.zenith, sunlight);
        along(setup, line, &steps, sunlight, scattering, &mut radiance);
        sum.add(line, &setup.optics.moments, &radiance);
    }
    (sum.moments, sum.ground)
}

#[inline(always)]
fn steps<const L: usize>(setup: &Setup<'_, L>, level: usize, zenith: f64, sunlight: &Sunlight<L>) -> Vec<Step<L>> {
    let grid = setup.grid;
    let direction = DVec3::new(((1.0 - zenith) * (1.0 + zenith)).sqrt(), 0.0, zenith);
    let Some(chord) = setup.optics.columns.chord(Place::above(grid.levels[level]), direction) else {
        return Vec::new();
    };
    let from = chord.ends().0;
    let places = crossings(&chord, &sunlight.altitudes, from);
    let start = grid.level_radius(level);
    let nothing = vec![[0.0; L]; setup.optics.species.len()];
    let mut steps: Vec<Step<L>> = Vec::with_capacity(places.len());
    let mut last: Option<f64> = None;
    for place in &places {
        let mut scattered = vec![[0.0; L]; setup.optics.species.len()];
        if let Some(last) = last {
            let ends = (last, place.s);
            let rule = Rule { fine: false, least: 1.0, bends: &grid.bends };
            let lit = quadrature(&chord, setup.optics, ends, rule, &mut Sum(&mut scattered));
            if !lit {
                break;
            }
        }
        last = Some(place.s);
        let r = grid.radius + sunlight.altitudes[place.level];
        let half: Vec<[f32; L]> = scattered.into_iter().map(|row| row.map(|v| 0.5 * v as f32)).collect();
        if let Some(step) = steps.last_mut() {
            step.after.clone_from(&half);
        }
        steps.push(Step {
            row: place.level,
            frame: [(start / r) as f32, ((place.s - from) / r) as f32],
            before: half,
            after: nothing.clone(),
        });
    }
    steps
}

/// Radiance along a line, for each sun and azimuth: transmittance to the sun is taken for linear between two crossings.
#[inline(always)]
fn along<const L: usize, const AZIMUTHS: usize>(
    setup: &Setup<'_, L>,
    line: &Line<L>,
    steps: &[Step<L>],
    sunlight: &Sunlight<L>,
    scattering: &Scattering<L>,
    radiance: &mut [[[f32; L]; AZIMUTHS]],
) {
    let turns = Turns::new(line.zenith, &azimuth_cosines::<AZIMUTHS>());
    let species = setup.optics.species.len();
    let mut sums = [[[0.0_f32; L]; MOST_SPECIES]; AZIMUTHS];
    for (sun, radiance) in setup.grid.suns.sines_cosines.iter().zip(radiance) {
        for sums in &mut sums {
            sums[..species].fill([0.0; L]);
        }
        // How far above the horizon the sun was at the crossing before.
        let mut last = [0.0_f32; AZIMUTHS];
        for (i, step) in steps.iter().enumerate() {
            let (_, there) = turns.seen_from(*sun, step.frame);
            let (nodes, fractions) = sunlight.locate(step.row, &there);
            for a in 0..AZIMUTHS {
                let above = sunlight.above(step.row, there[a]);
                let sums = &mut sums[a][..species];
                if above > 0.0 {
                    let through = sunlight.at(step.row, nodes[a], fractions[a]);
                    // If the sun rose or sets on the way, that way's part has to be cut.
                    let rose = i > 0 && last[a] <= 0.0;
                    if rose {
                        let share = above / (above - last[a]);
                        let horizon = sunlight.at_horizon(step.row);
                        for ((sum, before), after) in sums.iter_mut().zip(&step.before).zip(&step.after) {
                            for j in 0..L {
                                sum[j] += before[j] * share * (through[j] + horizon[j]) + after[j] * through[j];
                            }
                        }
                    } else {
                        for ((sum, before), after) in sums.iter_mut().zip(&step.before).zip(&step.after) {
                            for j in 0..L {
                                sum[j] += (before[j] + after[j]) * through[j];
                            }
                        }
                    }
                } else if i > 0 && last[a] > 0.0 {
                    // The crossing before counted for all the way to here.
                    let before = &steps[i - 1];
                    let (_, there) = turns.seen_from(*sun, before.frame);
                    let (nodes, fractions) = sunlight.locate(before.row, &there);
                    let through = sunlight.at(before.row, nodes[a], fractions[a]);
                    let share = last[a] / (last[a] - above);
                    let horizon = sunlight.at_horizon(before.row);
                    for (sum, way) in sums.iter_mut().zip(&step.before) {
                        for j in 0..L {
                            sum[j] += way[j] * (share * (through[j] + horizon[j]) - through[j]);
                        }
                    }
                }
                last[a] = above;
            }
        }
        let (towards, _) = turns.seen_from(*sun, [1.0, 0.0]);
        for a in 0..AZIMUTHS {
            let mut total = [0.0_f32; L];
            for (index, sum) in sums[a][..species].iter().enumerate() {
                let phase = scattering.at(index, towards[a]);
                for j in 0..L {
                    total[j] += phase[j] * sum[j];
                }
            }
            radiance[a] = total;
        }
        if let Some(foot) = &line.foot {
            let (_, there) = turns.seen_from(*sun, foot.frame);
            let (nodes, fractions) = sunlight.locate(0, &there);
            for a in 0..AZIMUTHS {
                if there[a] > 0.0 {
                    let through = sunlight.at(0, nodes[a], fractions[a]);
                    let factor = there[a] * FRAC_1_PI as f32;
                    for j in 0..L {
                        radiance[a][j] += factor * setup.optics.albedo[j] as f32 * foot.through[j] * through[j];
                    }
                }
            }
        }
    }
}
