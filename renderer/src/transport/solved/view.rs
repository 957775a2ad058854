//! What is seen: sunlight scattered once and the table's sources, integrated along the line of sight.

use super::aureole::Through;
use super::grid::Between;
use super::harmonics::MOST_DEGREE;
use super::line::{Crossing, MOST_SPECIES, Rule, Spread, Stencil, Take, crossings, quadrature};
use super::onward::{Ahead, Dipoles};
use super::{Optics, Solved};
use crate::atmosphere::{Chord, Columns};
use crate::geometry::Place;
use crate::light::SunDisc;
use crate::polarisation::{Analyser, Frame, Natural, Stokes};
use crate::vectors::{exp_minus, vectorised};
use glam::DVec3;
use pulp::NullaryFnOnce;
use std::f64::consts::FRAC_1_PI;

impl<const L: usize> Solved<L> {
    /// Radiance per unit solar irradiance (sr^-1) that arrives at `from` out of the unit `direction` (the direction looked in)
    /// with the sun, a parallel beam, in the unit direction `sun`; without the sun itself. With `single`, of sunlight
    /// scattered or reflected once.
    #[must_use]
    pub fn radiance(&self, from: Place, direction: DVec3, sun: DVec3, single: bool) -> [f64; L] {
        self.seen_as_light(Look { solved: self, from, direction, sun, single, sunlight: &self.optics.columns })
    }

    /// Radiance of sunlight scattered or reflected once that arrives where it is with the extinction of these columns; from there on it
    /// is that of the table's air.
    pub(super) fn radiance_of_sunlight(
        &self,
        from: Place,
        direction: DVec3,
        sun: DVec3,
        sunlight: &Columns<L>,
    ) -> [f64; L] {
        self.seen_as_light(Look { solved: self, from, direction, sun, single: true, sunlight })
    }

    fn seen_as_light(&self, look: Look<'_, L>) -> [f64; L] {
        let (towards, single) = (look.direction.dot(look.sun), look.single);
        let seen = &vectorised::<L, _>(look);
        vectorised::<L, _>(Shade { solved: self, seen, towards, single })
    }

    /// As [`Solved::radiance`], its Stokes parameters in `frame`, one of `direction`. A table that was solved without polarisation knows Q
    /// and U of sunlight scattered once alone; phase functions without a matrix count as depolarising.
    #[must_use]
    pub fn stokes(&self, from: Place, direction: DVec3, frame: Frame, sun: DVec3, single: bool) -> [Stokes; L] {
        let sunlight = &self.optics.columns;
        let seen = vectorised::<L, _>(Look { solved: self, from, direction, sun, single, sunlight });
        self.show(&seen, (from, direction, frame), sun, single)
    }

    /// Stokes parameters in a frame of what is seen in a direction.
    pub(super) fn show(
        &self,
        seen: &Seen<L>,
        (from, direction, frame): (Place, DVec3, Frame),
        sun: DVec3,
        single: bool,
    ) -> [Stokes; L] {
        let towards = direction.dot(sun);
        let whole = self.shade(seen, towards, single);
        // Light scattered once keeps the polarisation of its matrix, also in the peak that the table takes for straight on.
        let mut once = [0.0; L];
        let light = if self.is_polarised() && !single { &seen.turned } else { &seen.once };
        for (one, light) in self.optics.species.iter().zip(light) {
            let matrix = one.phase.natural(towards);
            for j in 0..L {
                once[j] += matrix[j].b1 * one.whole[j] * light[j];
            }
        }
        let level = Frame::level(from.up, direction);
        let (plane, turn) = (frame.of_scattering(direction, sun).0, level.turn_to(frame, direction));
        std::array::from_fn(|j| {
            let [q, u] = seen.linear.map(|row| row[j]);
            let mut sum = Stokes { i: 0.0, q, u }.turned(turn);
            sum += Analyser::OBSERVER.once_scattered(plane, Natural { a1: whole[j], b1: once[j] }, 1.0);
            sum
        })
    }

    /// Suns, as parallel beams, whose mean stands for the disc. Where it is low its upper and lower parts lie differently deep in
    /// twilight: two suns as far above and below its centre as the disc spreads give the mean to fourth order.
    #[must_use]
    pub fn suns(&self, from: Place, sun: &SunDisc<L>) -> Vec<DVec3> {
        let centre = sun.direction();
        let high = from.altitude_m < DEEP * self.optics.medium.top_m() && centre.dot(from.up) > HIGH_SUN;
        let across = centre.cross(from.up).try_normalize();
        let (false, Some(across)) = (high, across) else { return vec![centre] };
        let (sin, cos) = sun.spread().sqrt().sin_cos();
        let upwards = across.cross(centre) * sin;
        [upwards, -upwards].map(|off| centre * cos + off).to_vec()
    }

    /// Radiance of what is seen at an angle from the sun with this cosine.
    #[inline(always)]
    pub(super) fn shade(&self, seen: &Seen<L>, towards: f64, single: bool) -> [f64; L] {
        let Optics { species, aureole, .. } = &*self.optics;
        let mut depth = [0.0; L];
        if !single {
            let mut whole = [0.0; L];
            for (_, once) in species.iter().zip(&seen.once).filter(|(one, _)| !one.is_molecular()) {
                for j in 0..L {
                    whole[j] += once[j];
                }
            }
            for j in 0..L {
                // Between looks in the dark a polynomial may have a little of one without the other.
                depth[j] = if whole[j] > 0.0 { (seen.peaks[j] / whole[j]).max(0.0) } else { 0.0 };
            }
        }
        let mut sum = seen.rest;
        for (i, (one, once)) in species.iter().zip(&seen.once).enumerate() {
            let phase = if single { one.phase.values(towards) } else { aureole.phase(i, one, towards, &depth) };
            for j in 0..L {
                sum[j] += phase[j] * one.whole[j] * once[j];
            }
        }
        sum
    }

    #[inline(always)]
    pub(super) fn look(&self, look: &Look<'_, L>) -> Seen<L> {
        let Look { from, direction, sun, single, sunlight, .. } = *look;
        let mut seen = Seen::NOTHING;
        let Some(chord) = self.optics.columns.chord(from, direction) else { return seen };
        let (begin, end) = chord.ends();
        let sight = Sight { solved: self, chord: &chord, from, direction, sun, sunlight };
        let towards = direction.dot(sun);
        // All crossings of the line, so that the polynomials also reach over the observer.
        // The other side of a line that cuts the planet is beyond it.
        let backwards = if begin < 0.0 || chord.perigee() >= 0.0 { f64::NEG_INFINITY } else { 0.0 };
        let places = crossings(&chord, &self.grid.levels, backwards);
        let species = &self.optics.species;
        let mut weights = vec![[0.0; L]; species.len() * places.len()];
        let polarised = self.is_polarised() && !single;
        let mut dipoles = vec![[0.0; L]; if polarised { 2 * places.len() } else { 0 }];
        let ahead = polarised.then(|| self.optics.onward.along(from, direction));
        let through = if single { None } else { self.optics.aureole.along(from, direction) };
        // The line passes through the air in front of space.
        let passes = chord.perigee() > 0.0 && begin < 0.0;
        let cuts = sight.cuts();
        'line: for i in 0..places.len().saturating_sub(1) {
            let (mut a, end) = (places[i].s.max(begin), places[i + 1].s.min(end));
            let stencil = Stencil::around(i, &places, &self.grid.walls);
            let taker = Taker {
                sight: &sight,
                through: through.as_ref(),
                ahead: ahead.as_ref(),
                spread: (!single).then_some(Spread { places: &places, stencil, weights: &mut weights }),
                seen: &mut seen,
            };
            let linear = ahead.as_ref().map(|ahead| Dipoles {
                to: Spread { places: &places, stencil, weights: &mut dipoles },
                optics: &self.optics,
                ahead,
            });
            let mut taker = (taker, linear);
            for b in cuts.iter().copied().chain([end]) {
                let b = b.min(end);
                if b > a {
                    let rule = sight.rule(a, b, passes);
                    if !quadrature(&chord, &self.optics, (a, b), rule, &mut taker) {
                        break 'line;
                    }
                    a = b;
                }
            }
        }
        if !single {
            let mut harmonics = Vec::with_capacity(self.optics.moments.count());
            for (place, weights) in places.iter().zip(weights.chunks_exact(species.len().max(1))) {
                sight.add_sources(place, weights, towards, &mut harmonics, &mut seen.rest);
            }
            for (place, weight) in places.iter().zip(dipoles.as_chunks::<2>().0) {
                sight.add_linear(place, weight, &mut seen.linear);
            }
        }
        if chord.ends_on_ground() {
            let through = exp_minus(chord.total());
            let foot = chord.foot(from, direction);
            let mut light = if single { [0.0; L] } else { self.diffuse_irradiance(foot, sun) };
            let cosine = foot.up.dot(sun);
            if cosine > 0.0
                && let Some(arrives) = sunlight.transmittance(foot, sun)
            {
                for j in 0..L {
                    light[j] += cosine * arrives[j];
                }
            }
            for j in 0..L {
                seen.rest[j] += through[j] * self.optics.albedo[j] * FRAC_1_PI * light[j];
            }
        }
        seen
    }

    /// Irradiance of the ground at a place of it, per unit solar irradiance.
    #[must_use]
    pub fn ground_irradiance(&self, foot: Place, sun: DVec3) -> [f64; L] {
        let mut light = self.diffuse_irradiance(foot, sun);
        let cosine = foot.up.dot(sun);
        if cosine > 0.0
            && let Some(arrives) = self.optics.columns.transmittance(foot, sun)
        {
            for j in 0..L {
                light[j] += cosine * arrives[j];
            }
        }
        light
    }

    /// Irradiance of the ground at a place of it by all light but the sun's own.
    #[inline(always)]
    pub(super) fn diffuse_irradiance(&self, foot: Place, sun: DVec3) -> [f64; L] {
        let mut light = [0.0; L];
        let Between { first: [first], weights } = self.grid.suns.locate(&[foot.up.dot(sun) as f32]);
        for (row, weight) in self.field.ground[first as usize..].iter().zip(weights) {
            for j in 0..L {
                light[j] += f64::from(weight[0] * row[j]);
            }
        }
        light
    }

    /// Sources of diffuse light where the species have these weights: moments between levels, each with its share, in a direction looked
    /// in; the cosines of its zenith angle, of the sun's, and of the angle between the two.
    #[inline(always)]
    pub(super) fn diffuse(
        &self,
        levels: &[(usize, f32)],
        [zenith, there, towards]: [f64; 3],
        weights: &[[f64; L]],
        harmonics: &mut Vec<f64>,
    ) -> [f32; L] {
        let mut total = [0.0_f32; L];
        let Some(reach) = self.optics.reach(weights) else { return total };
        let Between { first: [first], weights: lagrange } = self.grid.suns.locate(&[there as f32]);
        let lagrange = lagrange.map(|weight| weight[0]);
        if lagrange == [0.0; 4] {
            return total;
        }
        let across = ((1.0 - zenith) * (1.0 + zenith) * (1.0 - there) * (1.0 + there)).max(0.0).sqrt();
        let turn = if across > 1e-9 { ((towards - zenith * there) / across).clamp(-1.0, 1.0) } else { 1.0 };
        self.optics.moments.at(zenith, harmonics);
        let mut sources = [[0.0_f32; L]; MOST_DEGREE + 2];
        self.optics.add_sources(weights, &mut sources[..reach.sources]);
        let mut cosines = [1.0; MOST_DEGREE + 1];
        cosines[1] = turn;
        for m in 2..=reach.degree {
            cosines[m] = 2.0 * turn * cosines[m - 1] - cosines[m - 2];
        }
        let (suns, moments) = (self.grid.suns.count(), self.optics.moments.count());
        for &(level, share) in levels {
            let lagrange = lagrange.map(|weight| share * weight);
            let from = (level * suns + first as usize) * moments;
            let rows = &self.field.moments[from..from + 4 * moments];
            let (below, above) = rows.split_at(2 * moments);
            let ((a, b), (c, d)) = (below.split_at(moments), above.split_at(moments));
            let all = &self.optics.moments;
            let pairs = all.pairs()[..reach.count].iter().zip(all.sources()).zip(harmonics.iter());
            for (((((&(_, m), &source), harmonic), (a, b)), c), d) in pairs.zip(a.iter().zip(b)).zip(c).zip(d) {
                let factor = (harmonic * cosines[m]) as f32;
                let source = &sources[source];
                for j in 0..L {
                    let moment = (lagrange[0] * a[j] + lagrange[1] * b[j]) + (lagrange[2] * c[j] + lagrange[3] * d[j]);
                    total[j] += factor * source[j] * moment;
                }
            }
        }
        total
    }
}

/// Sine of an elevation above which the sun is as good as a point, for observers within this share of the height of the
/// atmosphere.
const HIGH_SUN: f64 = 0.2;
const DEEP: f64 = 0.2;

/// A look along a line of sight.
pub(super) struct Look<'a, const L: usize> {
    pub(super) solved: &'a Solved<L>,
    pub(super) from: Place,
    pub(super) direction: DVec3,
    pub(super) sun: DVec3,
    pub(super) single: bool,
    /// Through which sunlight arrives.
    pub(super) sunlight: &'a Columns<L>,
}

impl<const L: usize> NullaryFnOnce for Look<'_, L> {
    type Output = Seen<L>;

    #[inline(always)]
    fn call(self) -> Seen<L> {
        self.solved.look(&self)
    }
}

/// Radiance of what is seen.
struct Shade<'a, const L: usize> {
    solved: &'a Solved<L>,
    seen: &'a Seen<L>,
    towards: f64,
    single: bool,
}

impl<const L: usize> NullaryFnOnce for Shade<'_, L> {
    type Output = [f64; L];

    #[inline(always)]
    fn call(self) -> [f64; L] {
        self.solved.shade(self.seen, self.towards, self.single)
    }
}

/// What a look sees, before the phase functions of sunlight scattered once.
#[derive(Debug, Clone, Copy)]
pub(super) struct Seen<const L: usize> {
    /// Radiance of all other light.
    pub(super) rest: [f64; L],
    /// Of each species the integral of its scattering coefficient times the transmittances to the eye and to the sun.
    pub(super) once: [[f64; L]; MOST_SPECIES],
    /// Of polarised light the same as it counts for Q and U.
    pub(super) turned: [[f64; L]; MOST_SPECIES],
    /// Sum of that over the species with peaks, times the depth of peaks.
    pub(super) peaks: [f64; L],
    /// Q and U of the table's light, referred to the horizontal ([`horizontal`]).
    pub(super) linear: [[f64; L]; 2],
}

impl<const L: usize> Seen<L> {
    const NOTHING: Self = Self {
        rest: [0.0; L],
        once: [[0.0; L]; MOST_SPECIES],
        turned: [[0.0; L]; MOST_SPECIES],
        peaks: [0.0; L],
        linear: [[0.0; L]; 2],
    };
}

/// Takes sunlight scattered once, and the weights of the table's sources.
struct Taker<'a, const L: usize> {
    sight: &'a Sight<'a, L>,
    through: Option<&'a Through<'a, L>>,
    ahead: Option<&'a Ahead<'a, L>>,
    spread: Option<Spread<'a, L>>,
    seen: &'a mut Seen<L>,
}

impl<const L: usize> Take<L> for Taker<'_, L> {
    #[inline(always)]
    fn take(&mut self, s: f64, scattered: &[[f64; L]]) {
        if let Some(spread) = &mut self.spread {
            spread.take(s, scattered);
        }
        let Sight { solved, chord, from, direction, sun, sunlight } = *self.sight;
        let place = chord.place(from, direction, s);
        let Some(sunlight) = sunlight.transmittance(place, sun) else {
            return;
        };
        let depth = self.through.map(|through| through.depth(s, place, sun));
        let more = self.ahead.map(|ahead| ahead.more(s));
        let once = self.seen.once.iter_mut().zip(&mut self.seen.turned);
        for (((once, turned), scattered), one) in once.zip(scattered).zip(&solved.optics.species) {
            for j in 0..L {
                once[j] += scattered[j] * sunlight[j];
            }
            if let Some(more) = &more {
                for j in 0..L {
                    turned[j] += scattered[j] * sunlight[j] * more[j];
                }
            }
            if let Some(depth) = &depth
                && !one.is_molecular()
            {
                for j in 0..L {
                    self.seen.peaks[j] += scattered[j] * sunlight[j] * depth[j];
                }
            }
        }
    }
}

/// Cosine of the sun's zenith angle below which its light may change fast along a line.
const LOW_SUN: f64 = 0.1;

/// Change of the altitude at which sunlight passes the planet, in one part of a line, as a share of that of the top, and most parts for it.
const PASSES: f64 = 0.02;
const MOST_PASSED: f64 = 8.0;

/// Changes of its optical depth that Gauss' rules of two and of four nodes bear (1e-6 and 4e-6), most parts for them, and a
/// transmittance that does not count.
const COARSE_DEPTH: f64 = 0.25;
const FINE_DEPTH: f64 = 3.0;
const MOST_GRAZED: f64 = 16.0;
const DIM: f64 = 1e-9;

/// Sunlight at an end of an interval, which may be the edge of the shadow, is that so far inside.
const INSET: f64 = 1e-3;

/// A line of sight with a sun.
pub(super) struct Sight<'a, const L: usize> {
    pub(super) solved: &'a Solved<L>,
    chord: &'a Chord<'a, L>,
    pub(super) from: Place,
    pub(super) direction: DVec3,
    pub(super) sun: DVec3,
    sunlight: &'a Columns<L>,
}

impl<const L: usize> Sight<'_, L> {
    /// Where the line is divided: at its perigee, at the edge of the planet's shadow, and where the sunlight that arrives touches the edge of a
    /// layer on its way, from where on it is taken from a beam as the root of the distance.
    fn cuts(&self) -> Vec<f64> {
        let touched = self.solved.grid.edges.iter().flat_map(|altitude| self.grazes(*altitude));
        let dusk = touched.filter(|s| s.is_finite() && self.position(*s).dot(self.sun) < 0.0);
        let mut cuts: Vec<f64> = self.grazes(0.0).into_iter().chain([0.0]).chain(dusk).collect();
        cuts.sort_by(f64::total_cmp);
        cuts
    }

    /// Where the line passes the cylinder about the axis to the sun of the light that passes the planet at an altitude:
    /// |p|^2 - (p . sun)^2 = (R + h)^2, a quadratic in the distance from the perigee. Infinite where it does not.
    fn grazes(&self, altitude: f64) -> [f64; 2] {
        let start = self.from.up * (self.solved.grid.radius + self.from.altitude_m);
        let perigee = start + self.direction * self.chord.travelled(0.0);
        let across = perigee - self.sun * perigee.dot(self.sun);
        let along = self.direction - self.sun * self.direction.dot(self.sun);
        let (a, b) = (along.length_squared(), across.dot(along));
        let c = across.length_squared() - (self.solved.grid.radius + altitude).powi(2);
        let root = b * b - a * c;
        if a < 1e-12 || root < 0.0 {
            return [f64::INFINITY; 2];
        }
        let root = root.sqrt();
        [(-b - root) / a, (-b + root) / a]
    }

    /// How an interval is integrated: where the sun is low, finely enough for the altitude at which its light passes the planet, and for
    /// what the air leaves of it.
    #[inline(always)]
    fn rule(&self, a: f64, b: f64, passes: bool) -> Rule<'_> {
        let bends = &self.solved.grid.bends;
        let turns = a.abs().min(b.abs()) < 1.0 && a.abs().max(b.abs()) > 2e4;
        let least = if turns { 3.0_f64 } else { 1.0 };
        let ends = [a + INSET * (b - a), b - INSET * (b - a)].map(|s| self.chord.place(self.from, self.direction, s));
        if ends.iter().all(|place| place.up.dot(self.sun) > LOW_SUN) {
            return Rule { fine: passes, least, bends };
        }
        let radius = self.solved.grid.radius;
        let [at_a, at_b] = ends.map(|place| {
            let position = place.up * (radius + place.altitude_m);
            (position - self.sun * position.dot(self.sun)).length()
        });
        // Sunlight that passes through a layer with bends changes faster.
        let step = if bends.is_empty() { PASSES } else { 0.3 * PASSES };
        let passed = (at_a - at_b).abs() / (step * self.solved.optics.medium.top_m());
        let grazed = self.grazed(ends);
        let parts = passed.ceil().min(MOST_PASSED).max((grazed / FINE_DEPTH).ceil().min(MOST_GRAZED));
        Rule { fine: passes || grazed > COARSE_DEPTH, least: parts.max(least), bends }
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
        let start = self.from.up * (self.solved.grid.radius + self.from.altitude_m);
        start + self.direction * self.chord.travelled(s)
    }

    /// Adds the sources at a crossing, with the weights of the species there.
    #[inline(always)]
    fn add_sources(
        &self,
        place: &Crossing,
        weights: &[[f64; L]],
        towards: f64,
        harmonics: &mut Vec<f64>,
        sum: &mut [f64; L],
    ) {
        let r = self.solved.grid.level_radius(place.level);
        let there = (self.position(place.s).dot(self.sun) / r).clamp(-1.0, 1.0);
        let zenith = (place.s / r).clamp(-1.0, 1.0);
        let total = self.solved.diffuse(&[(place.level, 1.0)], [zenith, there, towards], weights, harmonics);
        for j in 0..L {
            sum[j] += f64::from(total[j]);
        }
    }
}
