//! One fan of a certificate: rays in all directions from points of a line of sight, and from points of those.

use super::certify::{Certificate, Fan, View};
use super::guide::{Bins, DIRECTIONS, Local, Way};
use super::line::MOST_SPECIES;
use super::sources::Source;
use super::tabled::Tabled;
use crate::geometry::Place;
use crate::sampling::{Sampler, around};
use crate::vectors::exp_minus;
use glam::DVec3;
use pulp::NullaryFnOnce;
use std::f64::consts::FRAC_1_PI;

/// A path goes on with this times its importance, within [`CHANCES`]: also where the table says that nothing is.
const SURVIVAL: f64 = 2.0;
const CHANCES: (f64, f64) = (0.05, 1.0);

/// The share of all points that are kept with equal probability.
const DEFENSIVE: f64 = 0.02;

/// The most vertices of a path; light of such orders is nothing.
const MOST: u64 = 200;

/// Where light is scattered or reflected.
#[derive(Clone, Copy)]
struct Vertex<'c, R: Tabled, const L: usize> {
    place: Place,
    /// The direction looked in from the vertex before; none at the ground.
    direction: Option<DVec3>,
    /// What weights at the vertex refer to.
    frame: R::Frame,
    /// Scattering coefficients of the species in the air, without what goes straight on.
    scattering: [[f64; L]; MOST_SPECIES],
    shares: Shares,
    guide: Local<'c>,
}

/// A point of a fan with what it sends.
#[derive(Debug, Clone, Copy)]
struct Reached<R: Tabled, const L: usize> {
    place: Place,
    direction: Option<DVec3>,
    frame: R::Frame,
    /// What the observer sees of light there.
    weight: [R::Contribution; L],
    /// In that frame.
    source: Source<R, L>,
}

impl<R: Tabled, const L: usize> Reached<R, L> {
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

/// One fan.
pub(super) struct Estimate<'a, R: Tabled, const L: usize> {
    pub(super) certificate: &'a Certificate<'a, L>,
    pub(super) view: &'a View<'a, R, L>,
    pub(super) fan: Fan,
    pub(super) seed: u64,
    pub(super) pixel: u64,
    pub(super) number: u32,
}

impl<R: Tabled, const L: usize> NullaryFnOnce for Estimate<'_, R, L> {
    type Output = [R::Seen; L];

    #[inline(always)]
    fn call(self) -> [R::Seen; L] {
        self.fan()
    }
}

impl<R: Tabled, const L: usize> Estimate<'_, R, L> {
    /// The fan of the line of sight, and those of the points that are kept: all by the same loop, so that its code is there once.
    #[inline(always)]
    fn fan(&self) -> [R::Seen; L] {
        let fan = self.fan;
        let (mut sum, mut harmonics) = ([R::Seen::default(); L], Vec::new());
        let mut reached = Vec::with_capacity(2 * fan.first.max(fan.further) as usize);
        let mut random = Sampler::new(self.seed, self.pixel, (1 << 63) | u64::from(self.number));
        // A path of each kept point: the point, the path's number and how many fans it has had.
        let mut paths: Vec<(Reached<R, L>, u64, u64)> = Vec::new();
        let mut now: Option<(Reached<R, L>, u64, u64)> = None;
        loop {
            let (points, branch) = match &now {
                None => (fan.first, 0),
                Some((_, path, depth)) => (fan.further, (path << 10) | depth),
            };
            let share = 1.0 / f64::from(points);
            let vertex = now.as_ref().map(|(one, ..)| self.vertex(one.place, one.direction, one.frame));
            let onto = vertex.as_ref().map(|vertex| self.onto(vertex));
            let kept = now.as_ref().zip(vertex.zip(onto.as_ref())).map(|((one, ..), (vertex, onto))| {
                let vertex = Vertex { guide: vertex.guide.with(onto), ..vertex };
                (vertex, one.weight.map(|weight| weight * share))
            });
            reached.clear();
            for point in 0..points {
                let stream = (u64::from(self.number) << 20) | branch;
                let mut sampler = Sampler::sobol(self.seed, self.pixel, stream, point);
                sampler.go_to(2);
                let [along, u, v, distance] = sampler.four();
                let (vertex, weight) = kept.unwrap_or_else(|| {
                    let (vertex, weight) = self.first(along);
                    (vertex, weight.map(|weight| R::OBSERVER * (weight * share)))
                });
                self.child(&vertex, [u, v, distance], &weight, &mut reached, &mut harmonics);
            }
            for one in &reached {
                for j in 0..L {
                    sum[j] += R::see_light(&one.weight[j], &one.source.total[j]);
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
                        sum[j] += R::see_light(&(one.weight[j] * -1.0), &one.source.tail[j]);
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
    fn first(&self, u: f64) -> (Vertex<'_, R, L>, [f64; L]) {
        let view = self.view;
        if let Some(onto) = &view.foot
            && u < view.ground
        {
            let total = view.chord.total();
            let weight = exp_minus(total).map(|through| through / view.ground);
            let foot = view.chord.foot(self.certificate.from, view.direction);
            let vertex = self.vertex(foot, None, view.frame);
            return (Vertex { guide: vertex.guide.with(onto), ..vertex }, weight);
        }
        let (v, density, _) = view.bins.sample((u - view.ground) / (1.0 - view.ground));
        let (s, stretch) = view.way.at(&view.chord, v);
        let factor = stretch / (density * (1.0 - view.ground));
        let weight = exp_minus(view.chord.point(s).depth).map(|through| through * factor);
        let place = view.chord.place(self.certificate.from, view.direction, s);
        let vertex = self.vertex(place, Some(view.direction), view.frame);
        let onto = view.onto.iter().find(|(entry, _)| *entry == vertex.guide.entry);
        let guide = onto.map_or(vertex.guide, |(_, onto)| vertex.guide.with(onto));
        (Vertex { guide, ..vertex }, weight)
    }

    /// Densities of the light that is scattered or reflected on at a vertex.
    #[inline(always)]
    fn onto(&self, Vertex { direction, scattering, guide, .. }: &Vertex<'_, R, L>) -> Bins<DIRECTIONS> {
        direction.map_or_else(|| guide.reflected(), |ahead| self.certificate.guide.scattered(guide, scattering, ahead))
    }

    #[inline(always)]
    fn vertex(&self, place: Place, direction: Option<DVec3>, frame: R::Frame) -> Vertex<'_, R, L> {
        let scattering =
            if direction.is_some() { self.view.sources.scattering(place.altitude_m) } else { [[0.0; L]; MOST_SPECIES] };
        let Certificate { solved, sun, guide, .. } = self.certificate;
        let guide = guide.at(solved, place, *sun);
        Vertex { place, direction, frame, scattering, shares: self.shares(&scattering), guide }
    }

    /// What each point contributes, as a share of what is seen: of radiance, which no other Stokes parameter exceeds.
    #[inline(always)]
    fn importance(&self, reached: &[Reached<R, L>]) -> Vec<f64> {
        let norm = &self.view.norm;
        let counts = |one: &Reached<R, L>, j: usize| {
            (R::intensity(&one.weight[j]) * R::radiance(&one.source.tail[j])).abs() / norm[j]
        };
        reached.iter().map(|one| ((0..L).map(|j| counts(one, j).powi(2)).sum::<f64>() / L as f64).sqrt()).collect()
    }

    /// The weight of light from a direction that was drawn with a density, without the straight ray, and its frame.
    #[inline(always)]
    fn scattered(
        &self,
        vertex: &Vertex<'_, R, L>,
        direction: DVec3,
        weight: &[R::Contribution; L],
        density: f64,
    ) -> ([R::Contribution; L], R::Frame) {
        let optics = self.view.sources.optics();
        let Some(before) = vertex.direction else {
            let cosine = vertex.place.up.dot(direction).max(0.0) * FRAC_1_PI;
            let reflected = |j: usize| R::reflected(&weight[j], optics.albedo[j] * cosine / density);
            return (std::array::from_fn(reflected), vertex.frame);
        };
        let cosine = before.dot(direction).clamp(-1.0, 1.0);
        let (turn, frame) = R::plane(vertex.frame, before, direction);
        let mut kernel = [R::Matrix::default(); L];
        for (one, scattering) in optics.species.iter().zip(&vertex.scattering) {
            let matrices = R::matrices(&one.phase, cosine);
            for j in 0..L {
                kernel[j] = kernel[j] + matrices[j] * (scattering[j] * one.whole[j]);
            }
        }
        (std::array::from_fn(|j| R::scattered(&weight[j], turn, &kernel[j], density)), frame)
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
        Shares { straight, forward: 0.6 * rest * peaked / all, sunward: 0.1 * rest * peaked / all }
    }

    /// The mean over wavelengths and peaked species of the phase function.
    #[inline(always)]
    fn peak(&self, vertex: &Vertex<'_, R, L>, cosine: f64) -> f64 {
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
    fn about(&self, vertex: &Vertex<'_, R, L>, axis: DVec3, u: f64, turn: f64) -> DVec3 {
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
        vertex: &Vertex<'_, R, L>,
        [u, turn, distance]: [f64; 3],
        weight: &[R::Contribution; L],
        reached: &mut Vec<Reached<R, L>>,
        harmonics: &mut Vec<f64>,
    ) {
        let (sources, sun) = (&self.view.sources, self.certificate.sun);
        let Vertex { shares, guide, .. } = vertex;
        let ahead = vertex.direction.unwrap_or(vertex.place.up);
        let guided = 1.0 - shares.straight - shares.forward - shares.sunward;
        let (direction, frame);
        let carried: [R::Contribution; L];
        if u < shares.straight {
            direction = ahead;
            let mut straight = [0.0; L];
            for (one, scattering) in sources.optics().species.iter().zip(&vertex.scattering) {
                for j in 0..L {
                    straight[j] -= scattering[j] * (one.whole[j] - 1.0) / shares.straight;
                }
            }
            (carried, frame) = (std::array::from_fn(|j| weight[j] * straight[j]), vertex.frame);
        } else {
            let u = u - shares.straight;
            let mut density;
            if u < shares.forward + shares.sunward {
                direction = if u < shares.forward {
                    self.about(vertex, ahead, u / shares.forward, turn)
                } else {
                    self.about(vertex, sun, (u - shares.forward) / shares.sunward, turn)
                };
                density = guided * guide.density(direction);
            } else {
                let u = ((u - shares.forward - shares.sunward) / guided).clamp(0.0, 1.0 - 1e-12);
                (direction, density) = guide.sample([u, turn]);
                density *= guided;
            }
            if shares.forward > 0.0 {
                density += shares.forward * self.peak(vertex, ahead.dot(direction));
                density += shares.sunward * self.peak(vertex, sun.dot(direction));
            }
            if density <= 0.0 {
                return;
            }
            (carried, frame) = self.scattered(vertex, direction, weight, density);
        }
        if carried.iter().all(|weight| R::intensity(weight) == 0.0) {
            return;
        }
        let Some(chord) = sources.columns().chord(vertex.place, direction) else { return };
        if chord.ends_on_ground() && sources.optics().albedo.iter().any(|&albedo| albedo > 0.0) {
            let place = chord.foot(vertex.place, direction);
            let through = exp_minus(chord.total());
            let weight = std::array::from_fn(|j| carried[j] * through[j]);
            reached.push(Reached { place, direction: None, frame, weight, source: sources.ground(place, sun) });
        }
        let way = Way::new(&chord, sources.solved.grid.radius);
        let glow = &self.certificate.guide.glow;
        let (v, density) = glow.draw(sources, (&chord, &way), (vertex.place, direction), sun, distance);
        let (s, stretch) = way.at(&chord, v);
        let through = exp_minus(chord.point(s).depth);
        let weight = std::array::from_fn(|j| R::carried(&carried[j], through[j], stretch, density));
        let place = chord.place(vertex.place, direction, s);
        let source = sources.air(place, (direction, frame), sun, harmonics);
        reached.push(Reached { place, direction: Some(direction), frame, weight, source });
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
