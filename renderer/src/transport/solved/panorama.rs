//! All that an observer sees with a sun, from looks in few directions.
//!
//! What a look sees ([`Seen`]: before the phase functions, which have the narrow features) is smooth in the direction but for the horizon, the
//! edge of the air and lines that touch a layer's edge. Those are circles about the vertical: between two of them it is
//! interpolated from looks on rings of zenith angle, closer towards both ends (theta = a + (b - a) sin^2(pi x / 2), even in x: a
//! root at an end becomes a line), and even in azimuth from the sun, by Lagrange's polynomials through six nodes each way. The phase
//! functions are those of the direction itself.
//!
//! How many looks that takes is found out. Of a part between two edges nine rings are looked at, and those between them; where the nine
//! do not give the radiance of the others to eight times the asked error, which all of them then give to it, each half is such a part, at
//! half as many azimuths if these show the others. Where halves do not end, or have fewer pixels than it would take looks, every direction
//! is looked at by itself.

use super::nodes::{Glance, Interpolation, Nodes};
use super::sight::{Around, Find, Sight};
use super::view::Seen;
use super::{Optics, Solved};
use crate::geometry::Place;
use crate::polarisation::{Frame, Stokes};
use crate::vectors::vectorised;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Intervals of azimuth from the sun to its opposite: at first and at most.
const AZIMUTHS: (usize, usize) = (4, 64);

/// Intervals between rings of a part, before those between them are added.
const RINGS: usize = 8;

/// By how much a polynomial's error falls where nodes lie twice as close: 2^6 where all is smooth, 2^3 where the third derivative is not.
const HALVED: f64 = 8.0;

/// Parts that lie between two edges, and how often each may be halved.
const PARTS: usize = 2;
const HALVES: u32 = 6;

/// Rings stay off edges by this many radians.
const OFF: f64 = 1e-6;

/// Most edges of layers that are heeded.
const MOST_EDGES: usize = 24;

/// The error in its worst direction that a panorama may have of a table that is off by `stated` (rms): as much, within limits, so that
/// its own rms is far less.
#[must_use]
pub fn befitting(stated: f64) -> f64 {
    (2.0 * stated).clamp(5e-4, 4e-3)
}

/// Directions in which a panorama will be looked at.
#[derive(Debug, Clone, Copy)]
pub struct Pixels<'a> {
    /// Some of them, unit vectors.
    pub directions: &'a [DVec3],
    /// For how many each of these stands.
    pub each: usize,
}

/// Radiance in all directions at a place with a sun.
#[derive(Debug)]
pub struct Panorama<const L: usize> {
    from: Place,
    sun: DVec3,
    /// Unit vector to the sun's azimuth.
    ahead: DVec3,
    parts: Vec<Part<L>>,
}

/// Directions between two rings.
#[derive(Debug)]
struct Part<const L: usize> {
    between: Between,
    /// Shares of the way between the edges.
    ends: (f64, f64),
    /// Zenith angle of the second.
    last: f64,
    /// None: it is looked at directly.
    nodes: Option<Nodes<L>>,
}

/// Zenith angles between two edges.
#[derive(Debug, Clone, Copy)]
struct Between(f64, f64);

impl<const L: usize> Panorama<L> {
    /// Unit vector to the sun.
    #[must_use]
    pub fn sun(&self) -> DVec3 {
        self.sun
    }

    /// For an observer at `from` with the sun, a parallel beam, in the unit direction `sun`, off by about the share `error` of radiance at
    /// most. Where few of the `pixels` lie, they are looked at themselves.
    #[must_use]
    pub fn new(solved: &Solved<L>, from: Place, sun: DVec3, error: f64, pixels: Pixels<'_>) -> Self {
        let level = sun - from.up * sun.dot(from.up);
        let ahead = level.try_normalize().unwrap_or_else(|| from.up.any_orthonormal_vector());
        let mut all = Self { from, sun, ahead, parts: Vec::new() };
        let mut zeniths: Vec<_> = pixels.directions.iter().map(|direction| all.zenith(*direction)).collect();
        zeniths.sort_unstable_by(f64::total_cmp);
        let survey = Survey { all: &all, solved, error, zeniths, each: pixels.each };
        let edges = edges(solved, from);
        let parts = edges.windows(2).flat_map(|ends| (0..PARTS).map(|k| (Between(ends[0], ends[1]), k)));
        let parts: Vec<_> = parts.collect();
        let parts = parts.into_par_iter().flat_map_iter(|(between, k)| {
            survey.part(between, (k as f64 / PARTS as f64, (k + 1) as f64 / PARTS as f64), HALVES)
        });
        let parts = parts.collect();
        all.parts = parts;
        all
    }

    /// Radiance per unit solar irradiance (sr^-1) out of the unit `direction`, as [`Solved::radiance`] of all light.
    #[must_use]
    pub fn radiance(&self, solved: &Solved<L>, direction: DVec3) -> [f64; L] {
        match self.place(direction) {
            Some((nodes, at, _)) => vectorised::<L, _>(Glance { solved, nodes, at, towards: direction.dot(self.sun) }),
            None => solved.radiance(self.from, direction, self.sun, false),
        }
    }

    /// Stokes parameters in `frame`, one of the unit `direction`, as [`Solved::stokes`] of all light.
    #[must_use]
    pub fn stokes(&self, solved: &Solved<L>, direction: DVec3, frame: Frame) -> [Stokes; L] {
        // A vertical line has no azimuth.
        let place = self.place(direction).filter(|_| self.from.up.cross(direction).length() > OFF);
        let Some((nodes, at, right)) = place else {
            return solved.stokes(self.from, direction, frame, self.sun, false);
        };
        let mut seen = vectorised::<L, _>(Interpolation(nodes, at));
        if right {
            seen.linear[1] = seen.linear[1].map(|u| -u);
        }
        solved.show(&seen, (self.from, direction, frame), self.sun, false)
    }

    /// Where a direction is among nodes: shares of the way between rings and from the sun's azimuth to its opposite, and whether it lies
    /// to the right of the sun, where U has the other sign.
    fn place(&self, direction: DVec3) -> Option<(&Nodes<L>, [f64; 2], bool)> {
        let zenith = self.zenith(direction);
        let part = self.parts.iter().find(|part| zenith <= part.last)?;
        let (a, b) = part.ends;
        let share = ((part.between.share(zenith) - a) / (b - a)).clamp(0.0, 1.0);
        let level = direction - self.from.up * direction.dot(self.from.up);
        let (x, y) = (level.dot(self.ahead), level.dot(self.from.up.cross(self.ahead)));
        Some((part.nodes.as_ref()?, [share, y.abs().atan2(x) / PI], y < 0.0))
    }

    /// How many looks it holds.
    #[must_use]
    pub fn looks(&self) -> usize {
        self.parts.iter().flat_map(|part| &part.nodes).map(|nodes| (nodes.rings + 1) * (nodes.azimuths + 1)).sum()
    }

    fn zenith(&self, direction: DVec3) -> f64 {
        let across = direction - self.from.up * direction.dot(self.from.up);
        across.length().atan2(direction.dot(self.from.up))
    }

    /// The direction of a zenith angle and a share of half a circle.
    fn direction(&self, zenith: f64, turn: f64) -> DVec3 {
        let ((sin, cos), (across, along)) = (zenith.sin_cos(), (PI * turn).sin_cos());
        let level = self.ahead * along + self.from.up.cross(self.ahead) * across;
        self.from.up * cos + level * sin
    }
}

impl<const L: usize> Part<L> {
    fn new(between: Between, ends: (f64, f64), nodes: Option<Nodes<L>>) -> Self {
        let last = if ends.1 == 1.0 { between.1 } else { between.at(ends.1) };
        Self { between, ends, last, nodes }
    }
}

impl Between {
    /// The zenith angle of a share x of the way: theta = a + (b - a) sin^2(pi x / 2).
    fn at(self, share: f64) -> f64 {
        let (a, b) = (self.0 + OFF, self.1 - OFF);
        a + (b - a) * (0.5 * PI * share).sin().powi(2)
    }

    /// The share of a zenith angle.
    fn share(self, zenith: f64) -> f64 {
        let (a, b) = (self.0 + OFF, self.1 - OFF);
        ((zenith - a) / (b - a)).clamp(0.0, 1.0).sqrt().asin() * 2.0 / PI
    }
}

/// A direction and what is seen there.
type Looked<const L: usize> = (DVec3, Seen<L>);

/// Looks for a panorama.
struct Survey<'a, const L: usize> {
    all: &'a Panorama<L>,
    solved: &'a Solved<L>,
    error: f64,
    /// Zenith angles of some pixels, from small to large, and for how many each stands.
    zeniths: Vec<f64>,
    each: usize,
}

impl<const L: usize> Survey<'_, L> {
    /// How many pixels lie in a part.
    fn pixels(&self, between: Between, ends: (f64, f64)) -> usize {
        let (low, high) = (between.at(ends.0) - OFF, between.at(ends.1) + OFF);
        let first = self.zeniths.partition_point(|zenith| *zenith < low);
        let last = self.zeniths.partition_point(|zenith| *zenith <= high);
        self.each * (last - first)
    }

    /// What looks at a zenith angle have in common.
    fn sight(&self, zenith: f64) -> Option<Sight<'_, L>> {
        let direction = self.all.direction(zenith, 0.0);
        vectorised::<L, _>(Find { solved: self.solved, from: self.all.from, direction })
    }

    /// Looks from one azimuth to its opposite.
    fn ring(&self, zenith: f64, azimuths: usize) -> Vec<Looked<L>> {
        self.around(self.sight(zenith).as_ref(), zenith, azimuths, false)
    }

    /// The same, at every node or between those of half as many.
    fn around(&self, sight: Option<&Sight<'_, L>>, zenith: f64, azimuths: usize, only_odd: bool) -> Vec<Looked<L>> {
        let turns = (0..=azimuths).filter(|i| !only_odd || i % 2 == 1);
        let directions: Vec<_> = turns.map(|i| self.all.direction(zenith, i as f64 / azimuths as f64)).collect();
        let seen = vectorised::<L, _>(Around { sight, directions: &directions, sun: self.all.sun });
        directions.into_iter().zip(seen).collect()
    }

    /// A part, or its halves, which may be halved so often.
    fn part(&self, between: Between, ends: (f64, f64), halves: u32) -> Vec<Part<L>> {
        if self.pixels(between, ends) <= (2 * RINGS + 1) * (AZIMUTHS.0 + 1) {
            return vec![Part::new(between, ends, None)];
        }
        let at = |share: f64| between.at(ends.0 + (ends.1 - ends.0) * share);
        let Some(tried) = self.tried(at) else {
            if halves == 0 {
                return vec![Part::new(between, ends, None)];
            }
            let middle = 0.5 * (ends.0 + ends.1);
            return both(
                || self.part(between, (ends.0, middle), halves - 1),
                || self.part(between, (middle, ends.1), halves - 1),
            );
        };
        let azimuths = tried.last().map_or(AZIMUTHS.0, |(_, ring)| ring.len() - 1);
        let known = |i: usize| {
            tried.iter().find(|(k, ring)| *k == i && ring.len() == azimuths + 1).map(|(_, ring)| ring.clone())
        };
        let look = |i: usize| known(i).unwrap_or_else(|| self.ring(at(i as f64 / (2 * RINGS) as f64), azimuths));
        let all: Vec<_> = (0..=2 * RINGS).into_par_iter().map(look).collect();
        let (rings, new) = apart(all);
        self.halves(between, ends, rings, new, halves)
    }

    /// Some of the rings of a part, which are numbered with those between them, with as many azimuths as all of these need, at least so
    /// the last.
    fn tried(&self, at: impl Fn(f64) -> f64) -> Option<Vec<(usize, Vec<Looked<L>>)>> {
        let (mut tried, mut azimuths) = (Vec::with_capacity(3), AZIMUTHS.0);
        for ring in [RINGS, 1, 2 * RINGS - 1] {
            let looked = self.enough(at(ring as f64 / (2 * RINGS) as f64), azimuths)?;
            azimuths = looked.len() - 1;
            tried.push((ring, looked));
        }
        Some(tried)
    }

    /// A part of which rings, and those between them, are known.
    fn halves(
        &self,
        between: Between,
        ends: (f64, f64),
        rings: Vec<Vec<Looked<L>>>,
        new: Vec<Vec<Looked<L>>>,
        halves: u32,
    ) -> Vec<Part<L>> {
        let azimuths = rings[0].len() - 1;
        let nodes = self.nodes(&rings);
        let share = |i: usize| (2 * i + 1) as f64 / (2 * RINGS) as f64;
        let good = new.iter().enumerate().all(|(i, ring)| {
            let shown = |(j, looked)| self.is_good(&nodes, [share(i), j as f64 / azimuths as f64], looked, HALVED);
            ring.iter().enumerate().all(shown)
        });
        let mut all = interleaved(rings, new);
        if good || halves == 0 {
            let nodes = good.then(|| self.nodes(&all));
            return vec![Part::new(between, ends, nodes)];
        }
        let second = all.split_off(RINGS);
        all.push(second[0].clone());
        let middle = 0.5 * (ends.0 + ends.1);
        let half = |ends: (f64, f64), rings: Vec<Vec<Looked<L>>>| {
            let rings = self.thinned(rings);
            let azimuths = rings[0].len() - 1;
            if self.pixels(between, ends) <= RINGS * (azimuths + 1) {
                return vec![Part::new(between, ends, None)];
            }
            let look = |i| self.ring(between.at(ends.0 + (ends.1 - ends.0) * share(i)), azimuths);
            let new = (0..RINGS).into_par_iter().map(look).collect();
            self.halves(between, ends, rings, new, halves - 1)
        };
        both(|| half((ends.0, middle), all), || half((middle, ends.1), second))
    }

    /// Rings without every other azimuth as often as those that are left show the others.
    fn thinned(&self, rings: Vec<Vec<Looked<L>>>) -> Vec<Vec<Looked<L>>> {
        let (mut azimuths, mut rings) = (rings[0].len() - 1, rings);
        while azimuths > AZIMUTHS.0 {
            let half = azimuths / 2;
            let turn = |j: usize| (2 * j + 1) as f64 / azimuths as f64;
            let few: Vec<Vec<_>> = rings.iter().map(|ring| ring.iter().copied().step_by(2).collect()).collect();
            let are_shown = |(few, ring): (&Vec<Looked<L>>, &Vec<Looked<L>>)| {
                let nodes = self.nodes(std::slice::from_ref(few));
                (0..half).all(|j| self.is_good(&nodes, [0.0, turn(j)], &ring[2 * j + 1], 1.0))
            };
            if !few.iter().zip(&rings).all(are_shown) {
                break;
            }
            (azimuths, rings) = (half, few);
        }
        rings
    }

    /// A ring with as many azimuths as it needs, and at least so many intervals between them.
    fn enough(&self, zenith: f64, least: usize) -> Option<Vec<Looked<L>>> {
        let mut azimuths = least;
        let sight = self.sight(zenith);
        let mut ring = self.around(sight.as_ref(), zenith, azimuths, false);
        while azimuths <= AZIMUTHS.1 {
            let nodes = self.nodes(std::slice::from_ref(&ring));
            let new = self.around(sight.as_ref(), zenith, 2 * azimuths, true);
            let turn = |j: usize| (2 * j + 1) as f64 / (2 * azimuths) as f64;
            if new.iter().enumerate().all(|(j, looked)| self.is_good(&nodes, [0.0, turn(j)], looked, 1.0)) {
                return Some(ring);
            }
            (ring, azimuths) = (interleaved(ring, new), 2 * azimuths);
        }
        None
    }

    fn nodes(&self, rings: &[Vec<Looked<L>>]) -> Nodes<L> {
        let sun = self.all.sun;
        Nodes::new(
            rings.iter().map(|ring| ring.iter().map(|(direction, seen)| (direction.dot(sun), seen))),
            self.solved,
        )
    }

    /// Whether nodes show what is seen, to so many times the asked error.
    fn is_good(&self, nodes: &Nodes<L>, at: [f64; 2], (direction, seen): &Looked<L>, times: f64) -> bool {
        let towards = direction.dot(self.all.sun);
        let found = vectorised::<L, _>(Glance { solved: self.solved, nodes, at, towards });
        let right = self.solved.shade(seen, towards, false);
        let near = |found: &f64, seen: f64, radiance: f64| (found - seen).abs() <= times * self.error * radiance.abs();
        let good = found.iter().zip(right).all(|(found, right)| near(found, right, right));
        if !good || !self.solved.is_polarised() {
            return good;
        }
        let shown = vectorised::<L, _>(Interpolation(nodes, at));
        let rows = shown.linear.iter().zip(&seen.linear);
        rows.flat_map(|(shown, seen)| shown.iter().zip(seen).zip(right)).all(|((a, b), right)| near(a, *b, right))
    }
}

/// The parts of two halves, which are found at the same time.
fn both<const L: usize>(
    first: impl FnOnce() -> Vec<Part<L>> + Send,
    second: impl FnOnce() -> Vec<Part<L>> + Send,
) -> Vec<Part<L>> {
    let (mut parts, more) = rayon::join(first, second);
    parts.extend(more);
    parts
}

/// Every other one, and those between them.
fn apart<T>(all: Vec<T>) -> (Vec<T>, Vec<T>) {
    let (mut even, mut odd) = (Vec::with_capacity(all.len() / 2 + 1), Vec::with_capacity(all.len() / 2));
    for (i, one) in all.into_iter().enumerate() {
        if i % 2 == 0 { even.push(one) } else { odd.push(one) }
    }
    (even, odd)
}

/// The old ones with a new one between each two.
fn interleaved<T>(old: Vec<T>, new: Vec<T>) -> Vec<T> {
    let mut all = Vec::with_capacity(old.len() + new.len());
    let mut new = new.into_iter();
    for one in old {
        all.push(one);
        all.extend(new.next());
    }
    all
}

/// Zenith angles of the edges: of the ground, the air and its layers, with both ends.
fn edges<const L: usize>(solved: &Solved<L>, from: Place) -> Vec<f64> {
    let Optics { medium, .. } = &*solved.optics;
    let radius = solved.grid.radius;
    let layers = medium.jumps().into_iter().chain(medium.bends()).take(MOST_EDGES);
    let altitudes = [0.0, medium.top_m()].into_iter().chain(layers);
    let touched = altitudes.filter(|altitude| *altitude <= from.altitude_m).map(|altitude| {
        // The dip below the horizontal of the tangent to R + a, seen from R + h; nothing cancels in its opposite side.
        let (below, sum) = (from.altitude_m - altitude, 2.0 * radius + from.altitude_m + altitude);
        0.5 * PI + (below * sum).sqrt().atan2(radius + altitude)
    });
    // Also of what lines touch behind the observer: there one that rises from the ground crosses no levels.
    let mut edges: Vec<f64> = touched.flat_map(|edge| [PI - edge, edge]).chain([0.0, PI]).collect();
    edges.sort_by(f64::total_cmp);
    edges.dedup_by(|b, a| *b - *a < 4.0 * OFF);
    edges
}
