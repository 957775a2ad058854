//! A line of sight. What does not depend on the sun is found once for all that have the same zenith angle: where the line crosses the levels, the
//! weights of the table's sources there, and the points at which sunlight is summed while the sun is high.

use super::depths::Along;
use super::folded::Folded;
use super::line::{Crossing, Rule, Spread, Stencil, Take, crossings, quadrature};
use super::onward::{Ahead, Dipoles};
use super::view::Seen;
use super::{Reach, Solved};
use crate::atmosphere::{Chord, Columns};
use crate::geometry::Place;
use crate::vectors::{add_product, exp_minus};
use glam::DVec3;
use pulp::NullaryFnOnce;
use std::cell::RefCell;
use std::f64::consts::FRAC_1_PI;
use std::ops::Range;

impl<const L: usize> Points<L> {
    /// Finds the depths of peaks up to the points that are new.
    #[inline(always)]
    fn reach(&mut self, peaks: &Option<Along<'_, L>>) {
        if let Some(peaks) = peaks {
            for i in self.peaks.len()..self.at.len() {
                self.peaks.push(peaks.before(self.at[i]));
            }
        }
    }
}

/// A line of sight before it has an azimuth.
pub(super) struct Sight<'a, const L: usize> {
    pub(super) solved: &'a Solved<L>,
    pub(super) from: Place,
    single: bool,
    chord: Chord<'a, L>,
    /// It passes through the air in front of space.
    passes: bool,
    peaks: Option<Along<'a, L>>,
    ahead: Option<Ahead<'a, L>>,
    /// Intervals between crossings, on one side of the perigee each, up to where nothing more arrives.
    intervals: Vec<(f64, f64)>,
    /// Points of each interval, for every rule by which one was integrated, and sources at the crossings.
    kept: RefCell<Kept<L>>,
    /// Where it crosses levels, what counts there, and which of the weights are those of its moments, s_l S_lm(mu) (folded.rs).
    sources: Vec<(Crossing, Reach, Range<usize>)>,
    weights: Vec<[f32; L]>,
    /// The same for Q and U: where, and the weights of dipoles.
    dipoles: Vec<(Crossing, [[f64; L]; 2])>,
}

/// What is found of a line when it is first asked for.
#[derive(Default)]
struct Kept<const L: usize> {
    /// Of each interval the rules, and which points are theirs; none where it is too dark.
    rules: Vec<Vec<(Parts, Option<Range<usize>>)>>,
    points: Points<L>,
    /// Sums over degrees at each crossing.
    folded: Folded<L>,
}

/// Whether an interval is integrated finely, and the least number of parts.
type Parts = (bool, f64);

/// Points at which what is scattered is known.
#[derive(Default)]
struct Points<const L: usize> {
    /// Distances from the perigee.
    at: Vec<f64>,
    /// Of each point what each species scatters.
    scattered: Vec<[f64; L]>,
    /// Depths of peaks up to it.
    peaks: Vec<[f64; L]>,
}

impl<const L: usize> Take<L> for Points<L> {
    #[inline(always)]
    fn take(&mut self, s: f64, scattered: &[[f64; L]]) {
        self.at.push(s);
        self.scattered.extend_from_slice(scattered);
    }
}

impl<'a, const L: usize> Sight<'a, L> {
    /// The line from a place in a unit direction; none where it meets no air.
    #[inline(always)]
    pub(super) fn new(solved: &'a Solved<L>, from: Place, direction: DVec3, single: bool) -> Option<Self> {
        let optics = &*solved.optics;
        let chord = optics.columns.chord(from, direction)?;
        let (begin, end) = chord.ends();
        // All crossings of the line, so that the polynomials also reach over the observer.
        // The other side of a line that cuts the planet is beyond it.
        let backwards = if begin < 0.0 || chord.perigee() >= 0.0 { f64::NEG_INFINITY } else { 0.0 };
        let places = crossings(&chord, &solved.grid.levels, backwards);
        let species = optics.species.len();
        let polarised = solved.is_polarised() && !single;
        let mut all = Self {
            solved,
            from,
            single,
            chord,
            passes: chord.perigee() > 0.0 && begin < 0.0,
            peaks: if single { None } else { optics.aureole.along(from, direction) },
            ahead: polarised.then(|| optics.onward.along(from, direction)),
            intervals: Vec::with_capacity(places.len()),
            kept: RefCell::default(),
            sources: Vec::with_capacity(places.len()),
            weights: Vec::new(),
            dipoles: Vec::new(),
        };
        let mut weights = vec![[0.0; L]; species * places.len()];
        let mut dipoles = vec![[0.0; L]; if polarised { 2 * places.len() } else { 0 }];
        'line: for i in 0..places.len().saturating_sub(1) {
            let (mut a, end) = (places[i].s.max(begin), places[i + 1].s.min(end));
            let polynomials = Stencil::around(i, &places, &solved.grid.walls).through(&places);
            for b in [0.0_f64.min(end), end] {
                if b <= a {
                    continue;
                }
                let spread = (!single).then_some(Spread { polynomials, weights: &mut weights });
                let linear = all.ahead.as_ref().map(|ahead| Dipoles {
                    to: Spread { polynomials, weights: &mut dipoles },
                    optics,
                    ahead,
                });
                let rule = all.chord_rule(a, b);
                let kept = all.kept.get_mut();
                let first = kept.points.at.len();
                let mut taker = ((&mut kept.points, spread), linear);
                if !quadrature(&chord, optics, (a, b), rule, &mut taker) {
                    break 'line;
                }
                kept.points.reach(&all.peaks);
                kept.rules.push(vec![((rule.fine, rule.least), Some(first..kept.points.at.len()))]);
                all.intervals.push((a, b));
                a = b;
            }
        }
        if !single {
            let mut harmonics = Vec::with_capacity(optics.moments.count());
            for (place, weights) in places.iter().zip(weights.chunks_exact(species.max(1))) {
                let Some(reach) = optics.reach(weights) else { continue };
                let (first, zenith) = (all.weights.len(), all.zenith(place));
                optics.add_weights((weights, reach, zenith), &mut harmonics, &mut all.weights);
                all.sources.push((*place, reach, first..all.weights.len()));
            }
            all.kept.get_mut().folded = Folded::new(solved, all.sources.len());
            all.dipoles = places.iter().copied().zip(dipoles.as_chunks::<2>().0.iter().copied()).collect();
        }
        Some(all)
    }

    /// Which points an interval has by a rule; none if it is too dark there.
    #[inline(always)]
    fn points(&self, interval: usize, rule: Rule<'_>) -> Option<Range<usize>> {
        let mut kept = self.kept.borrow_mut();
        let Kept { rules, points, .. } = &mut *kept;
        let parts = (rule.fine, rule.least);
        if let Some((_, range)) = rules[interval].iter().find(|(known, _)| *known == parts) {
            return range.clone();
        }
        let first = points.at.len();
        let lit = quadrature(&self.chord, &self.solved.optics, self.intervals[interval], rule, points);
        points.reach(&self.peaks);
        let range = lit.then_some(first..points.at.len());
        rules[interval].push((parts, range.clone()));
        range
    }

    /// How an interval is integrated with the sun high.
    #[inline(always)]
    fn chord_rule(&self, a: f64, b: f64) -> Rule<'a> {
        let turns = a.abs().min(b.abs()) < 1.0 && a.abs().max(b.abs()) > 2e4;
        Rule { fine: self.passes, least: if turns { 3.0 } else { 1.0 }, bends: &self.solved.grid.bends }
    }

    /// Cosine of the line's zenith angle at a crossing.
    #[inline(always)]
    fn zenith(&self, place: &Crossing) -> f64 {
        (place.s / self.solved.grid.level_radius(place.level)).clamp(-1.0, 1.0)
    }

    /// What is seen in a direction of that zenith angle with a sun, whose light arrives through these columns.
    #[inline(always)]
    pub(super) fn seen(&self, direction: DVec3, sun: DVec3, sunlight: &Columns<L>) -> Seen<L> {
        let Self { solved, from, chord, .. } = self;
        let optics = &*solved.optics;
        let mut seen = Seen::NOTHING;
        let lit = Lit { sight: self, direction, sun, sunlight };
        let cuts = lit.cuts();
        let mut taker = Taker { lit: &lit, seen: &mut seen };
        'line: for (interval, &(from, to)) in self.intervals.iter().enumerate() {
            if !cuts.iter().any(|cut| from < *cut && *cut < to) {
                let rule = if lit.is_high(from, to) { self.chord_rule(from, to) } else { lit.rule(from, to) };
                let Some(range) = self.points(interval, rule) else { break };
                let (count, points) = (optics.species.len(), &self.kept.borrow().points);
                for i in range {
                    let scattered = &points.scattered[i * count..(i + 1) * count];
                    taker.take_behind(points.at[i], scattered, points.peaks.get(i));
                }
                continue;
            }
            let mut a = from;
            for b in cuts.iter().copied().chain([to]) {
                let b = b.min(to);
                if b > a {
                    if !quadrature(chord, optics, (a, b), lit.rule(a, b), &mut taker) {
                        break 'line;
                    }
                    a = b;
                }
            }
        }
        let towards = direction.dot(sun);
        let folded = &mut self.kept.borrow_mut().folded;
        for (number, (place, reach, weights)) in self.sources.iter().enumerate() {
            let r = solved.grid.level_radius(place.level);
            let there = (lit.position(place.s).dot(sun) / r).clamp(-1.0, 1.0);
            let cosines = [self.zenith(place), there, towards];
            let source = folded.source(solved, (number, place, *reach), cosines, &self.weights[weights.clone()]);
            add_product(&mut seen.rest, &source.map(f64::from), &[1.0; L]);
        }
        for (place, weights) in &self.dipoles {
            lit.add_linear(place, weights, &mut seen.linear);
        }
        if chord.ends_on_ground() {
            let through = exp_minus(chord.total());
            let foot = chord.foot(*from, direction);
            let mut light = if self.single { [0.0; L] } else { solved.diffuse_irradiance(foot, sun) };
            let cosine = foot.up.dot(sun);
            if cosine > 0.0
                && let Some(arrives) = sunlight.transmittance(foot, sun)
            {
                for j in 0..L {
                    light[j] += cosine * arrives[j];
                }
            }
            for j in 0..L {
                seen.rest[j] += through[j] * optics.albedo[j] * FRAC_1_PI * light[j];
            }
        }
        seen
    }
}

/// Finds a line of sight; none where it meets no air.
pub(super) struct Find<'a, const L: usize> {
    pub(super) solved: &'a Solved<L>,
    pub(super) from: Place,
    pub(super) direction: DVec3,
}

impl<'a, const L: usize> NullaryFnOnce for Find<'a, L> {
    type Output = Option<Sight<'a, L>>;

    #[inline(always)]
    fn call(self) -> Self::Output {
        Sight::new(self.solved, self.from, self.direction, false)
    }
}

/// Looks in directions that have the zenith angle of a line of sight.
pub(super) struct Around<'a, const L: usize> {
    pub(super) sight: Option<&'a Sight<'a, L>>,
    pub(super) directions: &'a [DVec3],
    pub(super) sun: DVec3,
}

impl<const L: usize> NullaryFnOnce for Around<'_, L> {
    type Output = Vec<Seen<L>>;

    #[inline(always)]
    fn call(self) -> Vec<Seen<L>> {
        let Self { sight, directions, sun } = self;
        // (No closures, since those are not always inlined.)
        let mut all = vec![Seen::NOTHING; directions.len()];
        if let Some(sight) = sight {
            let sunlight = &sight.solved.optics.columns;
            for (seen, direction) in all.iter_mut().zip(directions) {
                *seen = sight.seen(*direction, sun, sunlight);
            }
        }
        all
    }
}

/// Takes sunlight scattered once.
struct Taker<'a, const L: usize> {
    lit: &'a Lit<'a, L>,
    seen: &'a mut Seen<L>,
}

impl<const L: usize> Take<L> for Taker<'_, L> {
    #[inline(always)]
    fn take(&mut self, s: f64, scattered: &[[f64; L]]) {
        let before = self.lit.sight.peaks.as_ref().map(|peaks| peaks.before(s));
        self.take_behind(s, scattered, before.as_ref());
    }
}

impl<const L: usize> Taker<'_, L> {
    /// Takes what is scattered at a point behind that depth of peaks.
    #[inline(always)]
    fn take_behind(&mut self, s: f64, scattered: &[[f64; L]], before: Option<&[f64; L]>) {
        let Lit { sight, direction, sun, sunlight } = *self.lit;
        let at = sight.chord.place(sight.from, direction, s);
        let Some(sunlight) = sunlight.transmittance(at, sun) else {
            return;
        };
        let mut depth = [0.0; L];
        if let (Some(peaks), Some(before)) = (&sight.peaks, before) {
            depth = peaks.after(at, sun);
            add_product(&mut depth, before, &[1.0; L]);
        }
        let more = sight.ahead.as_ref().map(|ahead| ahead.more(s));
        let once = self.seen.once.iter_mut().zip(&mut self.seen.turned);
        for (((once, turned), scattered), one) in once.zip(scattered).zip(&sight.solved.optics.species) {
            let arrives: [f64; L] = std::array::from_fn(|j| scattered[j] * sunlight[j]);
            add_product(once, &arrives, &[1.0; L]);
            if let Some(more) = &more {
                add_product(turned, &arrives, more);
            }
            if before.is_some() && !one.is_molecular() {
                add_product(&mut self.seen.peaks, &arrives, &depth);
            }
        }
    }
}

/// Cosine of the sun's zenith angle below which its light may change fast along a line.
const LOW_SUN: f64 = 0.1;

/// Change of the altitude at which sunlight passes the planet, in one part of a line, as a share of that of the top, and most parts for it.
const PASSES: f64 = 0.03;
const MOST_PASSED: f64 = 8.0;

/// Changes of its optical depth that Gauss' rules of two and of four nodes bear (3e-5 and 4e-6 of what there is), most parts for them, and
/// a transmittance that does not count.
const COARSE_DEPTH: f64 = 0.6;
const FINE_DEPTH: f64 = 3.0;
const MOST_GRAZED: f64 = 16.0;
const DIM: f64 = 1e-9;

/// The ends of an interval but a little inside, for they may be the edge of the shadow.
#[inline(always)]
fn inside((a, b): (f64, f64)) -> [f64; 2] {
    const INSET: f64 = 1e-3;
    [a + INSET * (b - a), b - INSET * (b - a)]
}

/// A line of sight with an azimuth and a sun.
pub(super) struct Lit<'a, const L: usize> {
    pub(super) sight: &'a Sight<'a, L>,
    pub(super) direction: DVec3,
    pub(super) sun: DVec3,
    sunlight: &'a Columns<L>,
}

impl<const L: usize> Lit<'_, L> {
    /// Where the line is divided: at the edge of the planet's shadow, and where the sunlight that arrives touches the edge of a
    /// layer on its way, from where on it is taken from a beam as the root of the distance.
    fn cuts(&self) -> Vec<f64> {
        let edges = std::iter::once(&0.0).chain(&self.sight.solved.grid.edges);
        let touched = edges.flat_map(|altitude| self.grazes(*altitude));
        let mut cuts: Vec<f64> = touched.filter(|s| s.is_finite() && self.position(*s).dot(self.sun) < 0.0).collect();
        cuts.sort_by(f64::total_cmp);
        cuts
    }

    /// Where the line passes the cylinder about the axis to the sun of the light that passes the planet at an altitude:
    /// |p|^2 - (p . sun)^2 = (R + h)^2, a quadratic in the distance from the perigee. Infinite where it does not.
    fn grazes(&self, altitude: f64) -> [f64; 2] {
        let radius = self.sight.solved.grid.radius;
        let perigee = self.position(0.0);
        let across = perigee - self.sun * perigee.dot(self.sun);
        let along = self.direction - self.sun * self.direction.dot(self.sun);
        let (a, b) = (along.length_squared(), across.dot(along));
        let c = across.length_squared() - (radius + altitude).powi(2);
        let root = b * b - a * c;
        if a < 1e-12 || root < 0.0 {
            return [f64::INFINITY; 2];
        }
        let root = root.sqrt();
        [(-b - root) / a, (-b + root) / a]
    }

    /// The ends of an interval, as far inside as [`inside`] has them.
    #[inline(always)]
    fn ends(&self, a: f64, b: f64) -> [Place; 2] {
        let sight = self.sight;
        inside((a, b)).map(|s| sight.chord.place(sight.from, self.direction, s))
    }

    /// Whether sunlight changes little along an interval.
    #[inline(always)]
    fn is_high(&self, a: f64, b: f64) -> bool {
        self.ends(a, b).iter().all(|place| place.up.dot(self.sun) > LOW_SUN)
    }

    /// How an interval is integrated where the sun is low: finely enough for the altitude at which its light passes the planet, and for
    /// what the air leaves of it.
    #[inline(always)]
    fn rule(&self, a: f64, b: f64) -> Rule<'_> {
        let sight = self.sight;
        let Rule { fine, least, bends } = sight.chord_rule(a, b);
        let ends = self.ends(a, b);
        let radius = sight.solved.grid.radius;
        let [at_a, at_b] = ends.map(|place| {
            let position = place.up * (radius + place.altitude_m);
            (position - self.sun * position.dot(self.sun)).length()
        });
        // Sunlight that passes through a layer with bends changes faster.
        let step = if bends.is_empty() { PASSES } else { 0.4 * PASSES };
        let passed = (at_a - at_b).abs() / (step * sight.solved.optics.medium.top_m());
        let grazed = self.grazed(ends);
        let parts = passed.ceil().min(MOST_PASSED).max((grazed / FINE_DEPTH).ceil().min(MOST_GRAZED));
        Rule { fine: fine || grazed > COARSE_DEPTH, least: parts.max(least), bends }
    }

    /// How much the optical depth of sunlight changes between two places, as far as it counts. Gauss' rule of four nodes is off by
    /// d^8 T / 1.8e9 of a transmittance that falls by exp(-d) from T: so the change is weighted with T^(1/8).
    #[inline(always)]
    fn grazed(&self, ends: [Place; 2]) -> f64 {
        let [from, to] = ends.map(|place| self.sunlight.transmittance(place, self.sun).unwrap_or([0.0; L]));
        let mut most = 0.0_f64;
        for (from, to) in from.into_iter().zip(to) {
            let (low, high) = (from.min(to).max(DIM), from.max(to).max(DIM));
            most = most.max((high / low).ln() * high.sqrt().sqrt().sqrt());
        }
        most
    }

    /// A point of the line, from the planet's centre.
    #[inline(always)]
    pub(super) fn position(&self, s: f64) -> DVec3 {
        let Sight { solved, from, chord, .. } = self.sight;
        from.up * (solved.grid.radius + from.altitude_m) + self.direction * chord.travelled(s)
    }
}
