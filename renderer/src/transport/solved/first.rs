//! The first order: sunlight scattered once, or reflected by the ground, on its way along each line.

use super::Setup;
use super::grid::nearest;
use super::harmonics::legendre;
use super::line::{Rule, Take, crossings, quadrature};
use super::linear::Linear;
use super::onward::Dipoles;
use super::orders::{Gathered, LANES, Turns, azimuth_cosines};
use super::rays::Line;
use crate::geometry::Place;
use crate::vectors::{add_product, add_scaled};
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

/// Linearly between two rows.
#[inline(always)]
fn between<const L: usize>(a: &[f32; L], b: &[f32; L], fraction: f32) -> [f32; L] {
    let (mut between, b) = (*a, *b);
    for j in 0..L {
        between[j] += fraction * (b[j] - between[j]);
    }
    between
}

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
    fn locate(&self, row: usize, cosines: &[f32; LANES]) -> ([i32; LANES], [f32; LANES]) {
        let Row { room, radius, least, scale, .. } = self.rows[row];
        let (mut nodes, mut fractions) = ([0; LANES], [0.0; LANES]);
        for i in 0..LANES {
            let along = radius * cosines[i];
            let root = (room + along * along).sqrt();
            // In the form that adds numbers of one sign.
            let d = if along > 0.0 { room / (root + along) } else { root - along };
            let at = ((d - least) * scale).clamp(0.0, 1.0) * (NODES - 1) as f32;
            let (node, whole) = nearest((at - 0.5).max(0.0).min((NODES - 2) as f32));
            nodes[i] = node;
            fractions[i] = at - whole;
        }
        (nodes, fractions)
    }

    /// Transmittance at altitude number `row`, so far between a node and the next.
    #[inline(always)]
    fn at(&self, row: usize, node: i32, fraction: f32) -> [f32; L] {
        let node = row * NODES + node as usize;
        between(&self.values[node], &self.values[node + 1], fraction)
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
        between(&self.values[species][i], &self.values[species][i + 1], f)
    }
}

/// A crossing of a line with an altitude of [`Sunlight`].
struct Step<const L: usize> {
    row: usize,
    frame: [f32; 2],
    /// Of each species, and of dipoles.
    ways: Vec<Ways<L>>,
}

/// What the air about a crossing scatters, if transmittance to the sun is linear between two crossings and 1 at this one.
#[derive(Clone, Copy)]
struct Ways<const L: usize> {
    /// Before and after the crossing, and their sum.
    before: [f32; L],
    after: [f32; L],
    both: [f32; L],
    /// Half of all that the way from the crossing before scatters.
    half: [f32; L],
}

impl<const L: usize> Ways<L> {
    const NOTHING: Self = Self { before: [0.0; L], after: [0.0; L], both: [0.0; L], half: [0.0; L] };
}

/// Takes the integrals of what is scattered between two crossings times the lines that fall from 1 to 0 and rise from 0 to 1.
struct Hats<'a, const L: usize> {
    from: f64,
    to: f64,
    falling: &'a mut [[f64; L]],
    rising: &'a mut [[f64; L]],
}

impl<const L: usize> Take<L> for Hats<'_, L> {
    #[inline(always)]
    fn take(&mut self, s: f64, scattered: &[[f64; L]]) {
        let share = (s - self.from) / (self.to - self.from);
        for ((falling, rising), one) in self.falling.iter_mut().zip(self.rising.iter_mut()).zip(scattered) {
            for j in 0..L {
                falling[j] += (1.0 - share) * one[j];
                rising[j] += share * one[j];
            }
        }
    }
}

/// Azimuths on half a circle at which it is found out how much sunlight is scattered into a line.
const AZIMUTHS: usize = 8;

/// Moments at a level (of a sun, of each (l, m)) of the first order, and, of use at the ground, the irradiance from above; with the phase
/// functions at so many azimuths, a multiple of [`AZIMUTHS`].
///
/// What air scatters into a line changes slowly with its azimuth, only the phase functions do not: it is taken from the few azimuths by the
/// polynomial in the cosine through them, which are Chebyshev's nodes.
#[inline(always)]
pub(super) fn scatter<const L: usize, const DIRECTIONS: usize>(
    setup: &Setup<'_, L>,
    level: usize,
    lines: &[Line<L>],
    sunlight: &Sunlight<L>,
    scattering: &Scattering<L>,
) -> (Vec<[f32; L]>, Vec<[f32; L]>) {
    let suns = &setup.grid.suns;
    let mut light = Light::new(suns.batches::<AZIMUTHS>(), rows(setup));
    let polarised = setup.optics.moments.polarised();
    // Of each line.
    let places = suns.count() * DIRECTIONS;
    let mut radiance = vec![[0.0; L]; lines.len() * places];
    let mut linear = Vec::new();
    for (line, radiance) in lines.iter().zip(radiance.chunks_exact_mut(places)) {
        let steps = steps(setup, level, line.zenith, sunlight);
        let turns = Turns::new::<AZIMUTHS>(line.zenith, suns);
        light.clear();
        for (i, step) in steps.iter().enumerate() {
            light.pass(&turns, sunlight, (i > 0).then(|| &steps[i - 1]), step);
        }
        light.reflect(setup, line, &turns, sunlight);
        light.arrive::<DIRECTIONS>(setup, line, scattering, radiance);
        if polarised {
            light.polarise(setup, line, &turns, &mut linear);
        }
    }
    let mut sum = Gathered::of::<DIRECTIONS>(lines, &setup.optics.moments, suns.count(), &radiance);
    for (line, linear) in lines.iter().zip(linear.chunks_exact(LANES * suns.batches::<AZIMUTHS>())) {
        sum.add_linear::<AZIMUTHS>(line, linear);
    }
    (sum.moments, sum.ground)
}

/// Rows of what is scattered along a line: of each species, and of polarised light those of [`Dipoles`].
fn rows<const L: usize>(setup: &Setup<'_, L>) -> usize {
    setup.optics.species.len() + if setup.optics.moments.polarised() { 2 } else { 0 }
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
    let species = setup.optics.species.len();
    let mut steps: Vec<Step<L>> = Vec::with_capacity(places.len());
    let mut last: Option<f64> = None;
    let rows = rows(setup);
    let (mut falling, mut rising) = (vec![[0.0; L]; rows], vec![[0.0; L]; rows]);
    let ahead = setup.optics.onward.along(Place::above(grid.levels[level]), direction);
    for place in &places {
        falling.fill([0.0; L]);
        rising.fill([0.0; L]);
        if let Some(last) = last {
            let rule = Rule { fine: false, least: 1.0, bends: &grid.bends };
            let ((falling, more_falling), (rising, more_rising)) =
                (falling.split_at_mut(species), rising.split_at_mut(species));
            let linear = (rows > species).then_some(Dipoles {
                to: Hats { from: last, to: place.s, falling: more_falling, rising: more_rising },
                optics: setup.optics,
                ahead: &ahead,
            });
            let mut hats = (Hats { from: last, to: place.s, falling, rising }, linear);
            if !quadrature(&chord, setup.optics, (last, place.s), rule, &mut hats) {
                break;
            }
        }
        last = Some(place.s);
        let mut ways = vec![Ways::NOTHING; rows];
        for (((way, before), falling), rising) in
            ways.iter_mut().zip(steps.last_mut().into_iter().flat_map(|step| &mut step.ways)).zip(&falling).zip(&rising)
        {
            before.after = falling.map(|v| v as f32);
            way.before = rising.map(|v| v as f32);
            for j in 0..L {
                before.both[j] += before.after[j];
                way.both[j] = way.before[j];
                way.half[j] = 0.5 * (before.after[j] + way.before[j]);
            }
        }
        let r = grid.radius + sunlight.altitudes[place.level];
        steps.push(Step { row: place.level, frame: [(start / r) as f32, ((place.s - from) / r) as f32], ways });
    }
    steps
}

/// Sunlight scattered into a line, for each sun and azimuth: transmittance to the sun is taken for linear between two crossings.
struct Light<const L: usize> {
    /// Of each species, and of dipoles, in turn for each batch.
    sums: Vec<[[f32; L]; LANES]>,
    /// How far above the horizon the suns of each batch were at the crossing before.
    above: Vec<[f32; LANES]>,
    /// By the ground.
    reflected: Vec<[[f32; L]; LANES]>,
}

impl<const L: usize> Light<L> {
    fn new(batches: usize, rows: usize) -> Self {
        Self {
            sums: vec![[[0.0; L]; LANES]; batches * rows],
            above: vec![[0.0; LANES]; batches],
            reflected: vec![[[0.0; L]; LANES]; batches],
        }
    }

    fn clear(&mut self) {
        self.sums.fill([[0.0; L]; LANES]);
    }

    /// Adds what is scattered about a crossing.
    #[inline(always)]
    fn pass(&mut self, turns: &Turns, sunlight: &Sunlight<L>, before: Option<&Step<L>>, step: &Step<L>) {
        let states = self.above.iter_mut().zip(self.sums.chunks_exact_mut(step.ways.len().max(1)));
        for (batch, (above, sums)) in turns.batches.iter().zip(states) {
            let there = batch.there(step.frame);
            let mut now = [0.0; LANES];
            for i in 0..LANES {
                now[i] = sunlight.above(step.row, there[i]);
            }
            let last = std::mem::replace(above, now);
            let lit = |above: &[f32; LANES]| above.iter().filter(|above| **above > 0.0).count();
            let (lit, was_lit) = (lit(&now), if before.is_some() { lit(&last) } else { lit(&now) });
            if lit == 0 && was_lit == 0 {
                continue;
            }
            let (nodes, fractions) = sunlight.locate(step.row, &there);
            if lit == LANES && was_lit == LANES {
                for i in 0..LANES {
                    let through = sunlight.at(step.row, nodes[i], fractions[i]);
                    for (sum, way) in sums.iter_mut().zip(&step.ways) {
                        add_product(&mut sum[i], &way.both, &through);
                    }
                }
                continue;
            }
            for i in 0..LANES {
                let through = sunlight.at(step.row, nodes[i], fractions[i]);
                match (now[i] > 0.0, before) {
                    (true, Some(_)) if last[i] <= 0.0 => {
                        // The sun rose on the way: only its last part is lit.
                        let share = now[i] / (now[i] - last[i]);
                        let horizon = sunlight.at_horizon(step.row);
                        for (sum, way) in sums.iter_mut().zip(&step.ways) {
                            for j in 0..L {
                                sum[i][j] +=
                                    way.half[j] * share * (through[j] + horizon[j]) + way.after[j] * through[j];
                            }
                        }
                    }
                    (true, _) => {
                        for (sum, way) in sums.iter_mut().zip(&step.ways) {
                            add_product(&mut sum[i], &way.both, &through);
                        }
                    }
                    (false, Some(before)) if last[i] > 0.0 => {
                        // The sun set on the way, and the crossing before counted for all of it.
                        let (nodes, fractions) = sunlight.locate(before.row, &batch.there(before.frame));
                        let through = sunlight.at(before.row, nodes[i], fractions[i]);
                        let share = last[i] / (last[i] - now[i]);
                        let horizon = sunlight.at_horizon(before.row);
                        for ((sum, way), before) in sums.iter_mut().zip(&step.ways).zip(&before.ways) {
                            for j in 0..L {
                                sum[i][j] +=
                                    way.half[j] * share * (through[j] + horizon[j]) - before.after[j] * through[j];
                            }
                        }
                    }
                    _ => {}
                }
            }
        }
    }

    /// Adds Q and U of what molecules scatter to those of other lines.
    #[inline(always)]
    fn polarise(&mut self, setup: &Setup<'_, L>, line: &Line<L>, turns: &Turns, linear: &mut Vec<Linear<L>>) {
        let rows = rows(setup);
        for (batch, sums) in turns.batches.iter().zip(self.sums.chunks_exact(rows)) {
            let shares = batch.sunlight(line.zenith as f32);
            // Sunlight is natural: times beta.
            linear.extend(sums[rows - 1].iter().zip(shares).map(|(sum, shares)| {
                let mut light = [[0.0; L]; 2];
                for (row, share) in light.iter_mut().zip(shares) {
                    add_scaled(row, share, sum);
                }
                light
            }));
        }
    }

    /// The sunlight that the ground reflects into the line.
    #[inline(always)]
    fn reflect(&mut self, setup: &Setup<'_, L>, line: &Line<L>, turns: &Turns, sunlight: &Sunlight<L>) {
        self.reflected.fill([[0.0; L]; LANES]);
        let Some(foot) = &line.foot else { return };
        for (batch, reflected) in turns.batches.iter().zip(&mut self.reflected) {
            let there = batch.there(foot.frame);
            let (nodes, fractions) = sunlight.locate(0, &there);
            for i in 0..LANES {
                if there[i] > 0.0 {
                    let through = sunlight.at(0, nodes[i], fractions[i]);
                    let factor = there[i] * FRAC_1_PI as f32;
                    for j in 0..L {
                        reflected[i][j] += factor * setup.optics.albedo[j] as f32 * foot.through[j] * through[j];
                    }
                }
            }
        }
    }

    /// Makes radiance of it, of each sun and so many azimuths.
    #[inline(always)]
    fn arrive<const DIRECTIONS: usize>(
        &self,
        setup: &Setup<'_, L>,
        line: &Line<L>,
        scattering: &Scattering<L>,
        radiance: &mut [[f32; L]],
    ) {
        let (species, rows) = (setup.optics.species.len(), rows(setup));
        let shares = shares::<DIRECTIONS>();
        let turned = azimuth_cosines::<DIRECTIONS>();
        let sine = ((1.0 - line.zenith) * (1.0 + line.zenith)).max(0.0).sqrt() as f32;
        let suns = setup.grid.suns.sines_cosines.iter().zip(radiance.as_chunks_mut::<DIRECTIONS>().0);
        for (sun, ((sin, cos), radiance)) in suns.enumerate() {
            // Where this sun's azimuths are among the lanes of its batch.
            let (batch, lane) = (sun * AZIMUTHS / LANES, sun * AZIMUTHS % LANES);
            let reflected = &self.reflected[batch][lane..lane + AZIMUTHS];
            let sums = &self.sums[batch * rows..batch * rows + species];
            for (i, radiance) in radiance.iter_mut().enumerate() {
                let towards = cos * line.zenith as f32 + sin * sine * turned[i];
                *radiance = at(&shares[i], reflected);
                for (index, sums) in sums.iter().enumerate() {
                    let phase = scattering.at(index, towards);
                    add_product(radiance, &phase, &at(&shares[i], &sums[lane..lane + AZIMUTHS]));
                }
            }
        }
    }
}

/// Sum of the values at all azimuths, each with its share.
#[inline(always)]
fn at<const L: usize>(shares: &[f32; AZIMUTHS], values: &[[f32; L]]) -> [f32; L] {
    let mut sum = [0.0; L];
    for (share, value) in shares.iter().zip(values) {
        add_scaled(&mut sum, *share, value);
    }
    sum
}

/// For each of so many azimuths what it has of the values at the few: of the polynomial in the cosine through
/// n of Chebyshev's nodes, (1 + 2 sum_(0 < m < n) cos(m phi) cos(m phi_a)) / n; one of them itself where the two are the same.
fn shares<const DIRECTIONS: usize>() -> [[f32; AZIMUTHS]; DIRECTIONS] {
    let azimuth = |i: usize, count: usize| (i as f64 + 0.5) / count as f64 * std::f64::consts::PI;
    std::array::from_fn(|i| {
        std::array::from_fn(|a| {
            let (here, node) = (azimuth(i, DIRECTIONS), azimuth(a, AZIMUTHS));
            let waves: f64 = (1..AZIMUTHS).map(|m| (m as f64 * here).cos() * (m as f64 * node).cos()).sum();
            ((1.0 + 2.0 * waves) / AZIMUTHS as f64) as f32
        })
    })
}
