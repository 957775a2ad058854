//! Certificates: radiance without bias by Monte Carlo, with a solved table as the tail of every path.
//!
//! Let S_1 be sunlight scattered once at a place, S_2 = K T (S_1 + S_2) what the place scatters of all other light (T carries
//! sources along lines, K scatters), and S the table's S_2. Then for any S
//!
//! L = T S_1 + T K T (S_1 + S) + T K T D,  D = S_2 - S = [K T (S_1 + S) - S] + K T D.
//!
//! T S_1 is a quadrature. T K T (S_1 + S) is a mean over points of the line of sight, directions and distances (a *fan*),
//! a smooth integrand that low-discrepancy points do well; and D at some points of it is estimated in the same way: a fan of
//! directions and distances less what the table says, and D at one point of that. D is small if the table is good, and the
//! mean does not depend on whether it is.
//!
//! Where phase functions have a peak the table's air is one in which the share f of scattered light goes straight on (delta-M).
//! That equation can be kept exact: with the extinction k - f k_s the light L scattered otherwise is
//! K L = k_s int P L d omega - f k_s L, a fan with a straight ray of negative weight; and sunlight, which reaches
//! a place with the extinction k, is scattered there by k_s P, so that S is the table's moments and
//! k_s P (e^-tau' - e^-tau), tau' the depth without f k_s.

use super::guide::{Bins, Guide, Local, Way};
use super::line::MOST_SPECIES;
use super::{Optics, Solved};
use crate::atmosphere::{Chord, Columns, Tolerance};
use crate::geometry::{Place, Shape};
use crate::sampling::{Sampler, around, spiral};
use crate::vectors::{exp_minus, vectorised};
use glam::DVec3;
use pulp::NullaryFnOnce;
use std::f64::consts::FRAC_1_PI;

/// How many points a fan has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fan {
    /// Of the line of sight: points, each with a direction and a distance.
    pub first: u32,
    /// At how many of them the table's error is looked for.
    pub kept: u32,
    /// Directions and distances at each of those, and at every further place.
    pub further: u32,
}

impl Fan {
    /// What is taken.
    pub const USUAL: Self = Self { first: 128, kept: 2, further: 64 };
}

/// A path goes on with this times its importance, within [`CHANCES`]: also where the table says that nothing is.
const SURVIVAL: f64 = 2.0;
const CHANCES: (f64, f64) = (0.05, 1.0);

/// Bins of the line of sight.
const SIGHT: usize = 48;

/// The share of all points that are kept with equal probability.
const DEFENSIVE: f64 = 0.02;

/// The most vertices of a path; light of such orders is nothing.
const MOST: u64 = 200;

/// Light that a place sends into a direction, per length or from the ground.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<const L: usize> {
    /// S_1 + S.
    pub(super) total: [f64; L],
    /// S.
    tail: [f64; L],
}

/// The table's sources with the true sunlight.
#[derive(Debug)]
pub(super) struct Sources<'a, const L: usize> {
    pub(super) solved: &'a Solved<L>,
    /// Columns of the true air.
    truth: &'a Columns<L>,
    /// Those of the table's air, if that is another.
    scaled: Option<&'a Columns<L>>,
}

impl<'a, const L: usize> Sources<'a, L> {
    fn optics(&self) -> &Optics<L> {
        &self.solved.optics
    }

    /// Columns of the table's air.
    #[inline(always)]
    pub(super) fn columns(&self) -> &'a Columns<L> {
        self.scaled.unwrap_or(self.truth)
    }

    /// Scattering coefficients of the species, without what goes straight on.
    #[inline(always)]
    fn scattering(&self, altitude: f64) -> [[f64; L]; MOST_SPECIES] {
        let densities = self.optics().medium.densities_at(altitude);
        let mut scattering = [[0.0; L]; MOST_SPECIES];
        for (all, one) in scattering.iter_mut().zip(&self.optics().species) {
            let density = densities[one.component];
            *all = one.scattering.map(|sigma| density * sigma);
        }
        scattering
    }

    /// Sunlight that arrives with the table's extinction and with the true one; none in the planet's shadow.
    #[inline(always)]
    fn sunlight(&self, place: Place, sun: DVec3) -> Option<[[f64; L]; 2]> {
        let truly = self.truth.transmittance(place, sun)?;
        let Some(scaled) = self.scaled else { return Some([truly; 2]) };
        Some([scaled.transmittance(place, sun)?, truly])
    }

    /// Of a metre of air into the direction looked in, in m^-1 sr^-1 per unit solar irradiance.
    #[inline(always)]
    pub(super) fn air(&self, place: Place, direction: DVec3, sun: DVec3, harmonics: &mut Vec<f64>) -> Source<L> {
        let (solved, species) = (self.solved, &self.optics().species);
        let scattering = self.scattering(place.altitude_m);
        let levels = &solved.grid.levels;
        let above = levels.partition_point(|&level| level <= place.altitude_m).clamp(1, levels.len() - 1);
        let (a, b) = (levels[above - 1], levels[above]);
        let share = ((place.altitude_m - a) / (b - a)) as f32;
        let cosines = [place.up.dot(direction), place.up.dot(sun), direction.dot(sun)];
        let rows = [(above - 1, 1.0 - share), (above, share)];
        let diffuse = solved.diffuse(&rows, cosines, &scattering[..species.len()], harmonics);
        let tail = diffuse.map(f64::from);
        let mut source = Source { total: tail, tail };
        if let Some([through, truly]) = self.sunlight(place, sun) {
            for (one, scattering) in species.iter().zip(&scattering) {
                let phase = one.phase.values(cosines[2]);
                for j in 0..L {
                    let scattered = scattering[j] * one.whole[j] * phase[j];
                    source.total[j] += scattered * through[j];
                    source.tail[j] += scattered * (through[j] - truly[j]);
                }
            }
        }
        source
    }

    /// Of the ground, in sr^-1.
    #[inline(always)]
    pub(super) fn ground(&self, foot: Place, sun: DVec3) -> Source<L> {
        let reflected = self.optics().albedo.map(|albedo| albedo * FRAC_1_PI);
        let tail = self.solved.diffuse_irradiance(foot, sun);
        let mut source = Source { total: tail, tail };
        let cosine = foot.up.dot(sun);
        if cosine > 0.0
            && let Some([through, truly]) = self.sunlight(foot, sun)
        {
            for j in 0..L {
                source.total[j] += cosine * through[j];
                source.tail[j] += cosine * (through[j] - truly[j]);
            }
        }
        let reflect = |light: [f64; L]| std::array::from_fn(|j| reflected[j] * light[j]);
        Source { total: reflect(source.total), tail: reflect(source.tail) }
    }
}

/// Where light is scattered or reflected.
#[derive(Clone, Copy)]
struct Vertex<'c, const L: usize> {
    place: Place,
    /// The direction looked in from the vertex before; none at the ground.
    direction: Option<DVec3>,
    /// Scattering coefficients of the species in the air, without what goes straight on.
    scattering: [[f64; L]; MOST_SPECIES],
    shares: Shares,
    guide: Local<'c>,
}

/// A point of a fan with what it sends.
#[derive(Debug, Clone, Copy)]
struct Reached<const L: usize> {
    place: Place,
    direction: Option<DVec3>,
    weight: [f64; L],
    source: Source<L>,
}

impl<const L: usize> Reached<L> {
    fn times(&self, factor: f64) -> Self {
        Self { weight: self.weight.map(|weight| weight * factor), ..*self }
    }
}

/// Shares of the ways in which directions are drawn at a vertex: straight on, by the phase functions about the direction looked
/// in and about the sun, and by the guide.
#[derive(Debug, Clone, Copy)]
struct Shares {
    straight: f64,
    forward: f64,
    sunward: f64,
}

/// A certificate of a solved table for an observer and a sun.
#[derive(Debug)]
pub struct Certificate<'a, const L: usize> {
    solved: &'a Solved<L>,
    truth: Columns<L>,
    /// Columns of the table's air, where that is not the true one.
    scaled: Option<Columns<L>>,
    from: Place,
    sun: DVec3,
    guide: Guide,
}

/// Radiance in a direction, without bias.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certified<const L: usize> {
    /// Mean in sr^-1 per unit solar irradiance.
    pub mean: [f64; L],
    /// Its variance.
    pub variance: [f64; L],
}

/// A line of sight, prepared.
struct View<'c, const L: usize> {
    sources: Sources<'c, L>,
    chord: Chord<'c, L>,
    direction: DVec3,
    way: Way,
    bins: Bins<SIGHT>,
    /// Probability of the ground.
    ground: f64,
    /// What the table says is seen.
    norm: [f64; L],
    single: [f64; L],
}

impl<'a, const L: usize> Certificate<'a, L> {
    /// For an observer at `from` with the sun, a parallel beam, in the unit direction `sun`. `columns` are those of the medium for which
    /// the table was solved, with nothing cut off.
    #[must_use]
    pub fn new(solved: &'a Solved<L>, columns: Columns<L>, from: Place, sun: DVec3) -> Self {
        let whole = solved.optics.species.iter().all(|one| one.whole.iter().all(|&whole| whole == 1.0));
        let shape = Shape::Sphere { radius_m: solved.grid.radius };
        let scaled = (!whole).then(|| Columns::new(&solved.optics.medium, shape, Tolerance::RENDER));
        // What counts is light as a share of what is seen: the table's mean over all directions.
        const DIRECTIONS: u32 = 32;
        let mut norm = [1e-30; L];
        for i in 0..DIRECTIONS {
            let radiance = solved.radiance(from, spiral(i, DIRECTIONS, [-1.0, 1.0]), sun, false);
            for j in 0..L {
                norm[j] += radiance[j] / f64::from(DIRECTIONS);
            }
        }
        let guide = Guide::new(&Sources { solved, truth: &columns, scaled: scaled.as_ref() }, from, sun, &norm);
        Self { solved, truth: columns, scaled, from, sun, guide }
    }

    fn sources(&self) -> Sources<'_, L> {
        Sources { solved: self.solved, truth: &self.truth, scaled: self.scaled.as_ref() }
    }

    /// Where the observer is, and the direction to the sun.
    #[must_use]
    pub fn observer(&self) -> (Place, DVec3) {
        (self.from, self.sun)
    }

    /// Radiance out of the unit `direction`: the mean of `fans` independent fans, at least 2, and its variance.
    #[must_use]
    pub fn radiance(&self, direction: DVec3, fan: Fan, fans: u32, seed: u64, pixel: u64) -> Certified<L> {
        let Some(view) = self.view(direction) else { return Certified { mean: [0.0; L], variance: [0.0; L] } };
        let (mut mean, mut squares) = ([0.0; L], [0.0; L]);
        for number in 0..fans {
            let value = vectorised::<L, _>(Estimate { certificate: self, view: &view, fan, seed, pixel, number });
            for j in 0..L {
                let off = value[j] - mean[j];
                mean[j] += off / f64::from(number + 1);
                squares[j] += off * (value[j] - mean[j]);
            }
        }
        let n = f64::from(fans.max(2));
        let variance = squares.map(|squares| squares / (n * (n - 1.0)));
        Certified { mean: std::array::from_fn(|j| view.single[j] + mean[j]), variance }
    }

    fn view(&self, direction: DVec3) -> Option<View<'_, L>> {
        let sources = self.sources();
        let chord = sources.columns().chord(self.from, direction)?;
        let norm = self.solved.radiance(self.from, direction, self.sun, false).map(|light| light.max(1e-30));
        let way = Way::new(&chord, self.solved.grid.radius);
        let counts = |light: [f64; L]| -> f64 { (0..L).map(|j| light[j].abs() / norm[j]).sum() };
        let mut harmonics = Vec::new();
        let masses: [f64; SIGHT] = std::array::from_fn(|i| {
            let (s, stretch) = way.at(&chord, (i as f64 + 0.5) / SIGHT as f64);
            let through = chord.point(s).depth.map(|depth| (-depth).exp());
            let source = sources.air(chord.place(self.from, direction, s), direction, self.sun, &mut harmonics);
            counts(std::array::from_fn(|j| through[j] * source.tail[j] * stretch))
        });
        let mut ground = 0.0;
        if chord.ends_on_ground() && self.solved.optics.albedo.iter().any(|&albedo| albedo > 0.0) {
            let source = sources.ground(chord.foot(self.from, direction), self.sun);
            let total = chord.total();
            let seen = counts(std::array::from_fn(|j| (-total[j]).exp() * source.tail[j]));
            let air = masses.iter().sum::<f64>() / SIGHT as f64;
            ground = (seen / (seen + air).max(1e-300)).clamp(0.05, 0.95);
        }
        let single = self.solved.radiance_of_sunlight(self.from, direction, self.sun, &self.truth);
        Some(View { chord, direction, way, bins: Bins::new(masses), ground, norm, single, sources })
    }
}

/// One fan.
struct Estimate<'a, const L: usize> {
    certificate: &'a Certificate<'a, L>,
    view: &'a View<'a, L>,
    fan: Fan,
    seed: u64,
    pixel: u64,
    number: u32,
}

impl<const L: usize> NullaryFnOnce for Estimate<'_, L> {
    type Output = [f64; L];

    #[inline(always)]
    fn call(self) -> [f64; L] {
        self.fan()
    }
}

impl<const L: usize> Estimate<'_, L> {
    /// The fan of the line of sight, and those of the points that are kept: all by the same loop, so that its code is there once.
    #[inline(always)]
    fn fan(&self) -> [f64; L] {
        let fan = self.fan;
        let (mut sum, mut harmonics) = ([0.0; L], Vec::new());
        let mut reached = Vec::with_capacity(2 * fan.first.max(fan.further) as usize);
        let mut random = Sampler::new(self.seed, self.pixel, (1 << 63) | u64::from(self.number));
        // A path of each kept point: the point, the path's number and how many fans it has had.
        let mut paths: Vec<(Reached<L>, u64, u64)> = Vec::new();
        let mut now: Option<(Reached<L>, u64, u64)> = None;
        loop {
            let (points, branch) = match &now {
                None => (fan.first, 0),
                Some((_, path, depth)) => (fan.further, (path << 10) | depth),
            };
            let share = 1.0 / f64::from(points);
            let kept = now
                .as_ref()
                .map(|(one, ..)| (self.vertex(one.place, one.direction), one.weight.map(|weight| weight * share)));
            reached.clear();
            for point in 0..points {
                let stream = (u64::from(self.number) << 20) | branch;
                let mut sampler = Sampler::sobol(self.seed, self.pixel, stream, point);
                sampler.go_to(2);
                let [along, u, v, distance] = sampler.four();
                let (vertex, weight) = kept.unwrap_or_else(|| {
                    let (vertex, weight) = self.first(along);
                    (vertex, weight.map(|weight| weight * share))
                });
                self.child(&vertex, [u, v, distance], &weight, &mut reached, &mut harmonics);
            }
            for one in &reached {
                for j in 0..L {
                    sum[j] += one.weight[j] * one.source.total[j];
                }
            }
            let importance = self.importance(&reached);
            match now {
                None => {
                    let chosen = systematic(&importance, fan.kept, random.uniform());
                    let path = |(number, (index, probability)): (u64, (usize, f64))| {
                        (reached[index].times(1.0 / (f64::from(fan.kept) * probability)), number, 1)
                    };
                    paths.extend((0..).zip(chosen).map(path));
                }
                // D: less what the table says; it goes on with a probability by what it contributes.
                Some((one, path, depth)) => {
                    for j in 0..L {
                        sum[j] -= one.weight[j] * one.source.tail[j];
                    }
                    let whole: f64 = importance.iter().sum();
                    let chance = (SURVIVAL * f64::from(fan.kept) * whole).clamp(CHANCES.0, CHANCES.1);
                    if depth < MOST
                        && random.uniform() < chance
                        && let Some(&(index, probability)) = systematic(&importance, 1, random.uniform()).first()
                    {
                        paths.push((reached[index].times(1.0 / (probability * chance)), path, depth + 1));
                    }
                }
            }
            now = paths.pop();
            if now.is_none() {
                return sum;
            }
        }
    }

    /// A vertex on the line of sight, and its weight.
    #[inline(always)]
    fn first(&self, u: f64) -> (Vertex<'_, L>, [f64; L]) {
        let view = self.view;
        if u < view.ground {
            let total = view.chord.total();
            let weight = exp_minus(total).map(|through| through / view.ground);
            return (self.vertex(view.chord.foot(self.certificate.from, view.direction), None), weight);
        }
        let (v, density, _) = view.bins.sample((u - view.ground) / (1.0 - view.ground));
        let (s, stretch) = view.way.at(&view.chord, v);
        let factor = stretch / (density * (1.0 - view.ground));
        let weight = exp_minus(view.chord.point(s).depth).map(|through| through * factor);
        let place = view.chord.place(self.certificate.from, view.direction, s);
        (self.vertex(place, Some(view.direction)), weight)
    }

    #[inline(always)]
    fn vertex(&self, place: Place, direction: Option<DVec3>) -> Vertex<'_, L> {
        let scattering =
            if direction.is_some() { self.view.sources.scattering(place.altitude_m) } else { [[0.0; L]; MOST_SPECIES] };
        let Certificate { solved, sun, guide, .. } = self.certificate;
        Vertex { place, direction, scattering, shares: self.shares(&scattering), guide: guide.at(solved, place, *sun) }
    }

    /// What each point contributes, as a share of what is seen.
    #[inline(always)]
    fn importance(&self, reached: &[Reached<L>]) -> Vec<f64> {
        let norm = &self.view.norm;
        reached
            .iter()
            .map(|one| (0..L).map(|j| (one.weight[j] * one.source.tail[j]).abs() / norm[j]).sum::<f64>() / L as f64)
            .collect()
    }

    /// What a vertex sends of light from a direction, without the straight ray.
    #[inline(always)]
    fn kernel(&self, vertex: &Vertex<'_, L>, direction: DVec3) -> [f64; L] {
        let optics = self.view.sources.optics();
        let Some(before) = vertex.direction else {
            let cosine = vertex.place.up.dot(direction).max(0.0) * FRAC_1_PI;
            return optics.albedo.map(|albedo| albedo * cosine);
        };
        let cosine = before.dot(direction).clamp(-1.0, 1.0);
        let mut kernel = [0.0; L];
        for (one, scattering) in optics.species.iter().zip(&vertex.scattering) {
            let phase = one.phase.values(cosine);
            for j in 0..L {
                kernel[j] += scattering[j] * one.whole[j] * phase[j];
            }
        }
        kernel
    }

    /// How directions are drawn.
    #[inline(always)]
    fn shares(&self, scattering: &[[f64; L]; MOST_SPECIES]) -> Shares {
        let (mut all, mut peaked, mut straight) = (0.0, 0.0, 0.0);
        for (one, scattering) in self.view.sources.optics().species.iter().zip(scattering) {
            for j in 0..L {
                let whole = scattering[j] * one.whole[j];
                all += whole;
                peaked += if one.is_molecular() { 0.0 } else { whole };
                straight += whole - scattering[j];
            }
        }
        if all <= 0.0 || peaked <= 0.0 {
            return Shares { straight: 0.0, forward: 0.0, sunward: 0.0 };
        }
        let straight = straight / (all + straight);
        let rest = 1.0 - straight;
        Shares { straight, forward: 0.5 * rest * peaked / all, sunward: 0.25 * rest * peaked / all }
    }

    /// The mean over wavelengths and peaked species of the phase function.
    #[inline(always)]
    fn peak(&self, vertex: &Vertex<'_, L>, cosine: f64) -> f64 {
        let (mut sum, mut all) = (0.0, 0.0);
        for (one, scattering) in self.view.sources.optics().species.iter().zip(&vertex.scattering) {
            if !one.is_molecular() {
                let phase = one.phase.values(cosine.clamp(-1.0, 1.0));
                let weight: f64 = scattering.iter().sum();
                sum += weight * phase.iter().sum::<f64>() / L as f64;
                all += weight;
            }
        }
        if all > 0.0 { sum / all } else { 0.0 }
    }

    /// Draws a direction about an axis with the density [`Estimate::peak`].
    #[inline(always)]
    fn about(&self, vertex: &Vertex<'_, L>, axis: DVec3, u: f64, turn: f64) -> DVec3 {
        let species = &self.view.sources.optics().species;
        let weight =
            |i: usize| -> f64 { if species[i].is_molecular() { 0.0 } else { vertex.scattering[i].iter().sum() } };
        let all: f64 = (0..species.len()).map(weight).sum();
        let mut choice = u * all;
        let mut chosen = None;
        for i in 0..species.len() {
            let share = weight(i);
            if share > 0.0 {
                chosen = Some((i, (choice / share).clamp(0.0, 1.0 - 1e-12)));
                choice -= share;
                if choice < 0.0 {
                    break;
                }
            }
        }
        let Some((i, rest)) = chosen else { return axis };
        let lane = ((rest * L as f64) as usize).min(L - 1);
        let u = rest * L as f64 - lane as f64;
        around(axis, species[i].phase.sample(lane, u.clamp(0.0, 1.0 - 1e-12)).cosine, turn)
    }

    /// Follows a ray from a vertex: a point in the air, and the ground where it ends there.
    #[inline(always)]
    fn child(
        &self,
        vertex: &Vertex<'_, L>,
        [u, turn, distance]: [f64; 3],
        weight: &[f64; L],
        reached: &mut Vec<Reached<L>>,
        harmonics: &mut Vec<f64>,
    ) {
        let (sources, sun) = (&self.view.sources, self.certificate.sun);
        let Vertex { shares, guide, .. } = vertex;
        let ahead = vertex.direction.unwrap_or(vertex.place.up);
        let guided = 1.0 - shares.straight - shares.forward - shares.sunward;
        let (direction, found, factors);
        if u < shares.straight {
            direction = ahead;
            found = guide.find(direction);
            let mut straight = [0.0; L];
            for (one, scattering) in sources.optics().species.iter().zip(&vertex.scattering) {
                for j in 0..L {
                    straight[j] -= scattering[j] * (one.whole[j] - 1.0) / shares.straight;
                }
            }
            factors = straight;
        } else {
            let u = u - shares.straight;
            (direction, found) = if u < shares.forward {
                let direction = self.about(vertex, ahead, u / shares.forward, turn);
                (direction, guide.find(direction))
            } else if u < shares.forward + shares.sunward {
                let direction = self.about(vertex, sun, (u - shares.forward) / shares.sunward, turn);
                (direction, guide.find(direction))
            } else {
                guide.sample([((u - shares.forward - shares.sunward) / guided).clamp(0.0, 1.0 - 1e-12), turn])
            };
            let mut density = guided * found.density;
            if shares.forward > 0.0 {
                density += shares.forward * self.peak(vertex, ahead.dot(direction));
                density += shares.sunward * self.peak(vertex, sun.dot(direction));
            }
            if density <= 0.0 {
                return;
            }
            factors = self.kernel(vertex, direction).map(|kernel| kernel / density);
        }
        let weight: [f64; L] = std::array::from_fn(|j| weight[j] * factors[j]);
        if weight == [0.0; L] {
            return;
        }
        let Some(chord) = sources.columns().chord(vertex.place, direction) else { return };
        if chord.ends_on_ground() && sources.optics().albedo.iter().any(|&albedo| albedo > 0.0) {
            let place = chord.foot(vertex.place, direction);
            let through = exp_minus(chord.total());
            let weight = std::array::from_fn(|j| weight[j] * through[j]);
            reached.push(Reached { place, direction: None, weight, source: sources.ground(place, sun) });
        }
        let way = Way::new(&chord, sources.solved.grid.radius);
        let (v, density, _) = guide.distances(found).sample(distance);
        let (s, stretch) = way.at(&chord, v);
        let through = exp_minus(chord.point(s).depth);
        let weight = std::array::from_fn(|j| weight[j] * through[j] * stretch / density);
        let place = chord.place(vertex.place, direction, s);
        let source = sources.air(place, direction, sun, harmonics);
        reached.push(Reached { place, direction: Some(direction), weight, source });
    }
}

/// Chooses `count` indices with probabilities in proportion to the importance, a share of them even, by equal steps from a random
/// offset; all evenly where there is none. None of nothing.
fn systematic(importance: &[f64], count: u32, offset: f64) -> Vec<(usize, f64)> {
    if importance.is_empty() {
        return Vec::new();
    }
    let whole: f64 = importance.iter().sum();
    let share = if whole > 0.0 { DEFENSIVE } else { 1.0 };
    let even = share / importance.len() as f64;
    let probability = |i: usize| if whole > 0.0 { (1.0 - share) * importance[i] / whole + even } else { even };
    let mut chosen = Vec::with_capacity(count as usize);
    let (mut below, mut i) = (0.0, 0);
    for k in 0..count {
        let wanted = (f64::from(k) + offset) / f64::from(count);
        while i + 1 < importance.len() && below + probability(i) <= wanted {
            below += probability(i);
            i += 1;
        }
        chosen.push((i, probability(i)));
    }
    chosen
}
