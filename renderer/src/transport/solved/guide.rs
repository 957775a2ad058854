//! Where light comes from at a place: a density of directions, from a solved table.

use super::Solved;
use super::glow::Glow;
use super::line::MOST_SPECIES;
use super::lobes::Lobes;
use super::sources::Sources;
use crate::atmosphere::Chord;
use crate::geometry::Place;
use crate::transport::radiation::Scalar;
use crate::vectors::{exp_minus, vectorised};
use glam::DVec3;
use pulp::NullaryFnOnce;
use rayon::prelude::*;
use std::f64::consts::{PI, TAU};

/// Zenith angles: bins above the level, between it and the horizon, below the horizon.
const ZENITHS: [usize; 3] = [10, 4, 6];
const ALL_ZENITHS: usize = ZENITHS[0] + ZENITHS[1] + ZENITHS[2];

/// Azimuths from the sun's all round.
const AZIMUTHS: usize = 16;

pub(super) const DIRECTIONS: usize = ALL_ZENITHS * AZIMUTHS;

/// The middle of a bin by its measure.
const MIDDLE: [f64; 2] = [0.5, 0.5];

/// Distances at which light in a direction is looked at.
const DISTANCES: usize = 16;

/// Every which of them the diffuse light is looked up at, which changes little.
const EACH: usize = 4;

/// The share of all densities that is even.
pub(super) const EVEN: f64 = 0.05;

/// Between the sun's zenith angles for which there is a density, in radians.
const SUN_STEP: f64 = 4.0 * PI / 180.0;

/// How far beyond the observer's horizon vertices count, in radians.
const BEYOND: f64 = 12.0 * PI / 180.0;

/// A density over equal bins of the unit interval.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bins<const N: usize> {
    /// Probability below each bin.
    below: [f32; N],
    /// Density in each.
    density: [f32; N],
}

impl<const N: usize> Bins<N> {
    /// In proportion to masses, with a share that is even.
    pub(super) fn new(masses: [f64; N]) -> Self {
        let sum: f64 = masses.iter().sum();
        let mut bins = Self { below: [0.0; N], density: [1.0; N] };
        let mut below = 0.0;
        for i in 0..N {
            let share = if sum > 0.0 { masses[i] / sum } else { 1.0 / N as f64 };
            bins.below[i] = below as f32;
            bins.density[i] = ((1.0 - EVEN) * share * N as f64 + EVEN) as f32;
            below += f64::from(bins.density[i]) / N as f64;
        }
        bins
    }

    /// The number whose share of probability below is `u`, and the density there; the bin, too.
    #[inline(always)]
    pub(super) fn sample(&self, u: f64) -> (f64, f64, usize) {
        let bin = self.below.partition_point(|&below| f64::from(below) <= u).clamp(1, N) - 1;
        let density = f64::from(self.density[bin]);
        let within = ((u - f64::from(self.below[bin])) * N as f64 / density).clamp(0.0, 1.0 - 1e-9);
        ((bin as f64 + within) / N as f64, density, bin)
    }

    #[inline(always)]
    fn density(&self, bin: usize) -> f64 {
        f64::from(self.density[bin])
    }
}

/// Densities at the levels of a table for some zenith angles of the sun.
#[derive(Debug)]
pub(super) struct Guide {
    first_sun: f64,
    suns: usize,
    /// [sun][level]: directions in which a place sees light.
    entries: Vec<Bins<DIRECTIONS>>,
    lobes: Lobes,
    /// Where in a direction it comes from.
    pub(super) glow: Glow,
}

/// The directions about a place with a sun.
#[derive(Debug, Clone, Copy)]
struct Frame {
    up: DVec3,
    sunward: DVec3,
    across: DVec3,
    /// Cosine of the zenith angle of the horizon.
    horizon: f64,
}

impl Frame {
    #[inline(always)]
    fn new(place: Place, sun: DVec3, radius: f64) -> Self {
        let up = place.up;
        let level = sun - up * up.dot(sun);
        let sunward = if level.length_squared() > 1e-12 { level.normalize() } else { up.any_orthonormal_vector() };
        let ratio = radius / (radius + place.altitude_m);
        Self { up, sunward, across: up.cross(sunward), horizon: -((1.0 - ratio) * (1.0 + ratio)).max(0.0).sqrt() }
    }

    /// Where a zenith bin's part begins, its span, and the bin's number within: mu = begin + span x^2, x within the part.
    #[inline(always)]
    fn part(&self, zenith: usize) -> (f64, f64, usize, usize) {
        let [above, between, below] = ZENITHS;
        if zenith < above {
            (0.0, 1.0, zenith, above)
        } else if zenith < above + between {
            (self.horizon, -self.horizon, zenith - above, between)
        } else {
            (self.horizon, -(1.0 + self.horizon), zenith - above - between, below)
        }
    }

    /// The direction at places within a bin, 0 to 1 each, and d omega by these.
    #[inline(always)]
    fn direction(&self, bin: usize, [zenith, azimuth]: [f64; 2]) -> (DVec3, f64) {
        let (begin, span, number, count) = self.part(bin / AZIMUTHS);
        let x = (number as f64 + zenith) / count as f64;
        let mu = (begin + span * x * x).clamp(-1.0, 1.0);
        let (sin, cos) = (((bin % AZIMUTHS) as f64 + azimuth) * TAU / AZIMUTHS as f64).sin_cos();
        let sine = ((1.0 - mu) * (1.0 + mu)).sqrt();
        let direction = self.up * mu + self.sunward * (sine * cos) + self.across * (sine * sin);
        (direction, 2.0 * x * span.abs() / count as f64 * TAU / AZIMUTHS as f64)
    }

    /// The bin of a direction, and d omega by the places within.
    #[inline(always)]
    fn find(&self, direction: DVec3) -> (usize, f64) {
        let mu = direction.dot(self.up);
        let [above, between, below] = ZENITHS;
        let (x, span, first, count) = if mu >= 0.0 {
            (mu.sqrt(), 1.0, 0, above)
        } else if mu >= self.horizon && self.horizon < 0.0 {
            (((mu - self.horizon) / -self.horizon).sqrt(), -self.horizon, above, between)
        } else {
            let span = 1.0 + self.horizon;
            (((self.horizon - mu) / span).max(0.0).sqrt(), span, above + between, below)
        };
        let x = x.min(1.0);
        let zenith = first + ((x * count as f64) as usize).min(count - 1);
        let (a, b) = (direction.dot(self.sunward), direction.dot(self.across));
        let cosine = a / (a * a + b * b).sqrt().max(1e-30);
        let phi = cosine.clamp(-1.0, 1.0).acos();
        let phi = if b < 0.0 { TAU - phi } else { phi };
        let azimuth = ((phi * AZIMUTHS as f64 / TAU) as usize).min(AZIMUTHS - 1);
        (zenith * AZIMUTHS + azimuth, 2.0 * x * span / count as f64 * TAU / AZIMUTHS as f64)
    }
}

/// What a [`Guide`] says at one place.
#[derive(Clone, Copy)]
pub(super) struct Local<'a> {
    /// Which of the guide's.
    pub(super) entry: usize,
    directions: &'a Bins<DIRECTIONS>,
    frame: Frame,
}

impl Guide {
    /// For an observer who sees the sun there: the light of all wavelengths counts by its share of `norm`.
    pub(super) fn new<const L: usize>(sources: &Sources<'_, L>, from: Place, sun: DVec3, norm: &[f64; L]) -> Self {
        let solved = sources.solved;
        let radius = solved.grid.radius;
        let here = from.up.dot(sun).clamp(-1.0, 1.0).acos();
        let reach = BEYOND + (radius / (radius + from.altitude_m)).acos();
        let first_sun = (here - reach).max(0.0);
        let suns = (((here + reach).min(PI) - first_sun) / SUN_STEP).ceil() as usize + 1;
        let levels = &solved.grid.levels;
        let entries = (0..suns * levels.len())
            .into_par_iter()
            .map(|i| {
                let (sin, cos) = (first_sun + SUN_STEP * (i / levels.len()) as f64).sin_cos();
                // Not quite the top, from which nothing is seen upwards.
                let altitude = levels[i % levels.len()].min(0.999 * levels[levels.len() - 1]);
                let (place, sun) = (Place::above(altitude), DVec3::new(sin, 0.0, cos));
                vectorised::<L, _>(Survey { sources, place, sun, norm })
            })
            .collect();
        Self { first_sun, suns, entries, lobes: Lobes::new(&sources.optics().species), glow: Glow::new(sources, norm) }
    }

    /// At a place, with the sun there.
    #[inline(always)]
    pub(super) fn at<const L: usize>(&self, solved: &Solved<L>, place: Place, sun: DVec3) -> Local<'_> {
        let chi = place.up.dot(sun).clamp(-1.0, 1.0).acos();
        let at = ((chi - self.first_sun) / SUN_STEP).round().clamp(0.0, (self.suns - 1) as f64) as usize;
        let levels = &solved.grid.levels;
        let above = levels.partition_point(|&level| level < place.altitude_m).clamp(1, levels.len() - 1);
        let nearer = place.altitude_m - levels[above - 1] < levels[above] - place.altitude_m;
        let level = if nearer { above - 1 } else { above };
        let entry = at * levels.len() + level;
        Local { entry, directions: &self.entries[entry], frame: Frame::new(place, sun, solved.grid.radius) }
    }

    /// Densities of light that is scattered at a place into a direction looked `ahead` in, where the species have these scattering
    /// coefficients.
    #[inline(always)]
    pub(super) fn scattered<const L: usize>(
        &self,
        local: &Local<'_>,
        scattering: &[[f64; L]; MOST_SPECIES],
        ahead: DVec3,
    ) -> Bins<DIRECTIONS> {
        let scattering = scattering.map(|one| one.iter().sum::<f64>() as f32);
        local.times(|from| self.lobes.scattered(&scattering, ahead.dot(from)))
    }
}

/// What is seen from a place with a sun.
struct Survey<'a, const L: usize> {
    sources: &'a Sources<'a, L>,
    place: Place,
    sun: DVec3,
    norm: &'a [f64; L],
}

impl<const L: usize> NullaryFnOnce for Survey<'_, L> {
    type Output = Bins<DIRECTIONS>;

    #[inline(always)]
    fn call(self) -> Bins<DIRECTIONS> {
        let Self { sources, place, sun, norm } = self;
        let frame = Frame::new(place, sun, sources.solved.grid.radius);
        let mut harmonics = Vec::new();
        let mut masses = [0.0; DIRECTIONS];
        let counts = |light: &[f64; L]| -> f64 { (0..L).map(|j| light[j] / norm[j]).sum::<f64>().max(0.0) };
        for bin in 0..DIRECTIONS {
            // The other side of the sun is like this one.
            let (row, azimuth) = (bin - bin % AZIMUTHS, bin % AZIMUTHS);
            if 2 * azimuth >= AZIMUTHS {
                masses[bin] = masses[row + AZIMUTHS - 1 - azimuth];
                continue;
            }
            let (direction, width) = frame.direction(bin, MIDDLE);
            let Some(chord) = sources.columns().chord(place, direction) else { continue };
            let way = Way::new(&chord, sources.solved.grid.radius);
            let mut phases = [[0.0; L]; MOST_SPECIES];
            for (phase, one) in phases.iter_mut().zip(&sources.optics().species) {
                *phase = one.phase.values(direction.dot(sun));
            }
            let (mut diffuse, mut scattered) = ([0.0; L], 0.0);
            let mut seen = 0.0;
            for i in 0..DISTANCES {
                let (s, stretch) = way.at(&chord, (i as f64 + 0.5) / DISTANCES as f64);
                let through = exp_minus(chord.point(s).depth);
                let there = chord.place(place, direction, s);
                let scattering = sources.scattering(there.altitude_m);
                let all: f64 = scattering.iter().flatten().sum();
                if i % EACH == 0 || scattered <= 0.0 {
                    diffuse = sources.diffuse::<Scalar>(there, (direction, ()), sun, &scattering, &mut harmonics);
                    scattered = all;
                }
                let mut light = diffuse.map(|light| if scattered > 0.0 { light * all / scattered } else { 0.0 });
                sources.add_sunlight(&mut light, (there, sun), &scattering, &phases);
                for j in 0..L {
                    light[j] *= through[j] * stretch;
                }
                seen += counts(&light) / DISTANCES as f64;
            }
            if chord.ends_on_ground() {
                let source = sources.ground::<Scalar>(chord.foot(place, direction), sun);
                let total = chord.total();
                seen += counts(&std::array::from_fn(|j| (-total[j]).exp() * source.total[j]));
            }
            masses[bin] = seen * width;
        }
        Bins::new(masses)
    }
}

impl Local<'_> {
    /// Densities of light that is reflected by a level ground there.
    #[inline(always)]
    pub(super) fn reflected(&self) -> Bins<DIRECTIONS> {
        self.times(|from| from.dot(self.frame.up).max(0.0))
    }

    /// Densities in proportion to these times another number.
    #[inline(always)]
    fn times(&self, other: impl Fn(DVec3) -> f64) -> Bins<DIRECTIONS> {
        Bins::new(std::array::from_fn(|bin| self.directions.density(bin) * other(self.frame.direction(bin, MIDDLE).0)))
    }

    /// With other densities.
    #[inline(always)]
    pub(super) fn with<'b>(&self, directions: &'b Bins<DIRECTIONS>) -> Local<'b> {
        Local { directions, ..*self }
    }

    /// Draws a direction; its density in sr^-1, too.
    #[inline(always)]
    pub(super) fn sample(&self, [u, v]: [f64; 2]) -> (DVec3, f64) {
        let (x, density, bin) = self.directions.sample(u);
        let within = (x * DIRECTIONS as f64).fract();
        let (direction, width) = self.frame.direction(bin, [within, v]);
        (direction, density / DIRECTIONS as f64 / width.max(1e-30))
    }

    /// What the density of a direction is, in sr^-1.
    #[inline(always)]
    pub(super) fn density(&self, direction: DVec3) -> f64 {
        let (bin, width) = self.frame.find(direction);
        self.directions.density(bin) / DIRECTIONS as f64 / width.max(1e-30)
    }
}

/// A chord by a number v from 0 to 1 that is even in the root of the height above its lowest point, before that negative:
/// close steps where the air is dense.
#[derive(Debug, Clone, Copy)]
pub(super) struct Way {
    /// The lowest altitude of the chord in m.
    pub(super) lowest: f64,
    /// The root at both ends, in m^0.5.
    pub(super) first: f64,
    pub(super) last: f64,
    /// Of the planet, in m.
    pub(super) radius: f64,
}

impl Way {
    #[inline(always)]
    pub(super) fn new<const L: usize>(chord: &Chord<'_, L>, radius: f64) -> Self {
        let (from, to) = chord.ends();
        let lowest = chord.altitude(0.0_f64.clamp(from, to));
        let root = |s: f64| (chord.altitude(s) - lowest).max(0.0).sqrt();
        let first = if from < 0.0 { -root(from) } else { 0.0 };
        let last = if to > 0.0 { root(to) } else { 0.0 };
        Self { lowest, first, last, radius }
    }

    /// The place on the chord, and ds/dv.
    #[inline(always)]
    pub(super) fn at<const L: usize>(&self, chord: &Chord<'_, L>, v: f64) -> (f64, f64) {
        let q = self.first + v * (self.last - self.first);
        let altitude = self.lowest + q * q;
        let distance = chord.distance(altitude);
        let (from, to) = chord.ends();
        let falls = q < 0.0 || to <= 0.0;
        let s = (if falls { -distance } else { distance }).clamp(from, to);
        // ds/dq = 2 q (R + h) / s, at the perigee sqrt(2 (R + p)).
        let r = self.radius + altitude;
        let slope = if distance > 1e-3 { 2.0 * q.abs() * r / distance } else { (2.0 * r).sqrt() };
        (s, slope * (self.last - self.first))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_found_in_the_bins_that_they_come_from() {
        let place = Place { altitude_m: 3000.0, up: DVec3::new(0.1, 0.2, 0.97).normalize() };
        let frame = Frame::new(place, DVec3::new(0.9, 0.1, 0.3).normalize(), 6.371e6);
        for bin in 0..DIRECTIONS {
            for within in [[0.01, 0.3], [0.5, 0.77], [0.99, 0.1]] {
                let (direction, width) = frame.direction(bin, within);
                let (found, again) = frame.find(direction);
                assert_eq!(found, bin);
                // Below the horizon mu is a difference of numbers near each other.
                assert!((again / width - 1.0).abs() < 1e-6, "{bin} {within:?}: {again} for {width}");
            }
        }
    }

    #[test]
    fn widths_of_directions_fill_the_sphere() {
        let frame = Frame::new(Place::above(2e4), DVec3::X, 6.371e6);
        const STEPS: u32 = 20;
        let middle = |i: u32| (f64::from(i) + 0.5) / f64::from(STEPS);
        let all: f64 = (0..DIRECTIONS)
            .flat_map(|bin| (0..STEPS).map(move |i| frame.direction(bin, [middle(i), 0.2]).1 / f64::from(STEPS)))
            .sum();
        // The midpoint rule is exact for lines.
        assert!((all - 2.0 * TAU).abs() < 1e-9, "{all}");
    }

    #[test]
    fn bins_are_sampled_by_their_density() {
        let bins = Bins::new([1.0, 0.0, 3.0, 2.0]);
        let mut sum = 0.0;
        for i in 0..10_000 {
            let (x, density, bin) = bins.sample((f64::from(i) + 0.5) / 1e4);
            assert_eq!((x * 4.0) as usize, bin);
            assert!((density - f64::from(bins.density[bin])).abs() < 1e-12);
            // int x^2 dx
            sum += x * x / density / 1e4;
        }
        // Of an empty bin with 5 % / 4 of all density 125 steps are left.
        assert!((sum - 1.0 / 3.0).abs() < 1e-3, "{sum}");
    }
}
