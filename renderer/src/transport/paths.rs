//! Paths on column tables: every flight is drawn by inverting a column, every transmittance is one look-up.
//!
//! Single scattering is integrated along the line of sight ([`line`]): a quadrature, whose nodes the random numbers
//! shift. Monte Carlo does the rest. By day later orders see the sun from the path's own vertices; where the
//! sun is low ([`LOW_SUN`]) only a part of each line is lit, the vertices are seldom there, and every line is integrated.

use super::Problem;
use super::carried::{Carried, SURVIVAL};
use super::radiation::{Linear, Radiation};
use super::scatter::{Lobe, Towards, scatter, scatter_with_lobe};
use crate::atmosphere::Chord;
use crate::geometry::{Place, Shape};
use crate::sampling::{Sampler, cosine_hemisphere};
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// The least and largest probability with which a flight towards a reflecting ground is made to end in the air.
const AIR_OR_GROUND: (f64, f64) = (0.1, 0.9);

/// The sun counts as low on a line if the sine of its elevation is below this at either end.
const LOW_SUN: f64 = 0.05;

/// Nodes on the line of sight by day: more would make single scattering smoother than the later orders let be seen.
const DAY: u32 = 2;

/// Nodes on each line where the sun is low.
const LOW: u32 = 8;

/// What is seen along one path, in `frame`.
pub(super) fn trace<R: Radiation, const L: usize>(
    problem: &Problem<'_, L>,
    from: Place,
    (direction, frame): (DVec3, R::Frame),
    hero: usize,
    sampler: &mut Sampler,
) -> [R::Seen; L] {
    let mut sum = [R::Seen::default(); L];
    let mut carried = Carried::<R, L>::new(frame);
    let (mut place, mut direction) = (from, direction);
    let mut first_weight = None;
    let mut order = 0_u32;
    while problem.max_orders.is_none_or(|most| order < most) {
        order += 1;
        sampler.go_to(2 * order);
        let [comb, disc, limb, flight] = sampler.four();
        let [angle, turn, survival, _] = sampler.four();
        let Some(chord) = problem.columns.chord(place, direction) else {
            if let Some(environment) = problem.environment {
                carried.score(&mut sum, |j| environment[j]);
            }
            break;
        };
        let total = chord.total();
        if let (Some(environment), false) = (problem.environment, chord.ends_on_ground()) {
            carried.score(&mut sum, |j| environment[j] * (-total[j]).exp());
        }
        let sun = problem.sun.map(|sun| sun.sample([disc, limb]));
        let low = sun.is_some_and(|(sun, _)| sun_is_low(problem.shape, &chord, place, direction, sun));
        if let Some((sun, light)) = &sun
            && (order == 1 || low)
        {
            let quadrature = Quadrature { low, hero, nodes: if low { LOW } else { DAY }, comb };
            line(problem, &chord, (place, direction), (*sun, light), quadrature, &carried, &mut sum);
        }
        let reflects = chord.ends_on_ground() && problem.albedo.iter().any(|&albedo| albedo > 0.0);
        if reflects {
            // What the ground sends straight on, of the sun and of the environment's own reflection by the path.
            let ground = chord.foot(place, direction);
            if let Some((sun, light)) = &sun {
                let cosine = ground.up.dot(*sun);
                if cosine > 0.0
                    && let Some(through) = problem.columns.transmittance(ground, *sun)
                {
                    let albedo = problem.albedo_at(ground);
                    carried.score(&mut sum, |j| {
                        (-total[j]).exp() * albedo[j] * FRAC_1_PI * cosine * light[j] * through[j]
                    });
                }
            }
        }
        if problem.max_orders == Some(order) {
            break;
        }
        match fly(&chord, &total, reflects, hero, flight, &mut carried) {
            None => break,
            Some(Vertex::Ground) => {
                place = chord.foot(place, direction);
                carried.reflect(&problem.albedo_at(place));
                direction = cosine_hemisphere(place.up, [angle, turn]);
            }
            Some(Vertex::Air(s)) => {
                place = chord.place(place, direction, s);
                let local = problem.medium.local_at(place.altitude_m);
                if order > 1
                    && !low
                    && let Some((sun, light)) = &sun
                    && let Some(through) = problem.columns.transmittance(place, *sun)
                {
                    let scattered = Towards::<R, L>::new(problem.medium, direction.dot(*sun)).at(&local);
                    let turn = carried.turn(direction, *sun);
                    carried.score_scattered(&mut sum, turn, &scattered, |j| light[j] * through[j]);
                }
                carried.multiply(|j| local.scattering[j], |_| 1.0);
                let scattered = match sunward(place, sun.map(|(sun, _)| sun)) {
                    Some(lobe) => {
                        scatter_with_lobe(problem.medium, &local, hero, direction, lobe, &mut carried, [angle, turn])
                    }
                    None => scatter(problem.medium, &local, hero, direction, &mut carried, [angle, turn]),
                };
                match scattered {
                    Some(scattered) => direction = scattered,
                    None => break,
                }
            }
        }
        let weight = carried.weight();
        if weight <= 0.0 {
            break;
        }
        let first = *first_weight.get_or_insert(weight);
        let chance = SURVIVAL * weight / first;
        if chance < 1.0 {
            if survival >= chance {
                break;
            }
            carried.multiply(|_| 1.0 / chance, |_| 1.0);
        }
    }
    sum
}

/// Where the light is when the sun is low: along the horizon below which it has gone.
#[inline(always)]
fn sunward(place: Place, sun: Option<DVec3>) -> Option<Lobe> {
    let sun = sun?;
    let sine = place.up.dot(sun);
    if sine >= 0.0 {
        return None;
    }
    let level = (sun - place.up * sine).try_normalize()?;
    Some(Lobe { axis: (level + place.up * 0.1).normalize() })
}

/// Where a flight ends.
enum Vertex {
    /// In the air, at a point of the chord.
    Air(f64),
    Ground,
}

/// A flight that always counts: towards space it ends in the air; towards a ground that reflects it ends in the air with the
/// probability that the hero's optical depth says, kept within [`AIR_OR_GROUND`], or on the ground.
///
/// In the air the distance has the density sigma_j(s) exp(-tau_j(s)) / (1 - exp(-tau_j)), inverted for the hero;
/// the contribution gets exp(-tau_j(s)), the scattering coefficient is left to the vertex.
#[inline]
fn fly<R: Radiation, const L: usize>(
    chord: &Chord<'_, L>,
    total: &[f64; L],
    reflects: bool,
    hero: usize,
    u: f64,
    carried: &mut Carried<R, L>,
) -> Option<Vertex> {
    let collision = total.map(|depth| -(-depth).exp_m1());
    let mut probability = [1.0; L];
    let mut u = u;
    if reflects {
        probability = collision.map(|p| if p > 0.0 { p.clamp(AIR_OR_GROUND.0, AIR_OR_GROUND.1) } else { 0.0 });
        let air = probability[hero];
        if u >= air {
            carried.multiply(|j| (-total[j]).exp() / (1.0 - air), |j| (1.0 - probability[j]) / (1.0 - air));
            return Some(Vertex::Ground);
        }
        u /= air;
    }
    if collision[hero] <= 0.0 {
        return None;
    }
    let (s, point) = chord.at_depth(hero, -(-u * collision[hero]).ln_1p());
    let through = point.depth.map(|depth| (-depth).exp());
    let density: [f64; L] = std::array::from_fn(|j| {
        if collision[j] > 0.0 { probability[j] * point.slope[j].max(0.0) * through[j] / collision[j] } else { 0.0 }
    });
    if density[hero] <= 0.0 {
        return None;
    }
    carried.multiply(|j| through[j] / density[hero], |j| density[j] / density[hero]);
    Some(Vertex::Air(s))
}

/// Whether the sun is low ([`LOW_SUN`]) at an end of a chord.
#[inline(always)]
fn sun_is_low<const L: usize>(shape: Shape, chord: &Chord<'_, L>, place: Place, direction: DVec3, sun: DVec3) -> bool {
    let Shape::Sphere { radius_m } = shape else { return false };
    let (from, to) = chord.ends();
    let (along, across) = (place.up.dot(sun) * (radius_m + place.altitude_m), direction.dot(sun));
    [from, to].iter().any(|&s| along + across * chord.travelled(s) < LOW_SUN * (radius_m + chord.altitude(s)))
}

/// How a line is integrated.
#[derive(Clone, Copy)]
struct Quadrature {
    /// Whether the sun is low.
    low: bool,
    hero: usize,
    /// Number of nodes.
    nodes: u32,
    /// Their place within equal shares of the density, 0 to 1.
    comb: f64,
}

/// Adds to `sum` the sunlight that one scattering on the chord sends along it.
///
/// The nodes lie at the quantiles (i + comb) / nodes of a density on the stretches outside the planet's shadow: where
/// the sun is low, of the guide ([`Guide`]), which all wavelengths share. By day wavelength j would choose
/// q_j(s) = sigma_j exp(-tau_j) / M_j, M_j the integral of the numerator; the hero's is
/// taken, and weighted by the balance heuristic like everything else.
#[inline]
fn line<R: Radiation, const L: usize>(
    problem: &Problem<'_, L>,
    chord: &Chord<'_, L>,
    (place, direction): (Place, DVec3),
    (sun, light): (DVec3, &[f64; L]),
    quadrature: Quadrature,
    carried: &Carried<R, L>,
    sum: &mut [R::Seen; L],
) {
    let (stretches, count) = lit(problem.shape, chord, place, direction, sun);
    let towards = Towards::<R, L>::new(problem.medium, direction.dot(sun));
    let sight = Sight { problem, chord, place, direction, sun, towards };
    let turn = carried.turn(direction, sun);
    let share = 1.0 / f64::from(quadrature.nodes);
    let quantiles = (0..quadrature.nodes).map(|i| (f64::from(i) + quadrature.comb) * share);
    if quadrature.low {
        let Some(guide) = Guide::new(&sight, &stretches[..count]) else { return };
        for u in quantiles {
            let (s, density) = guide.sample(u);
            if let Some(Seen { scattered, through }) = sight.at(s) {
                let arrives = sight.arrives(s);
                carried
                    .score_scattered(sum, turn, &scattered, |j| share * arrives[j] * light[j] * through[j] / density);
            }
        }
        return;
    }
    // By day the whole chord is lit, or all of it that matters.
    let Some(&(from, to)) = stretches[..count].iter().max_by(|a, b| (a.1 - a.0).total_cmp(&(b.1 - b.0))) else {
        return;
    };
    let (start, end) = (chord.point(from).depth, chord.point(to).depth);
    let mass: [f64; L] = std::array::from_fn(|j| between(start[j], end[j]));
    let hero = quadrature.hero;
    if mass[hero] <= 0.0 {
        return;
    }
    for u in quantiles {
        // exp(-tau) = exp(-tau_a) - u M, as a depth past the beginning.
        let past = -(-u * mass[hero] * start[hero].exp()).max(-1.0).ln_1p();
        let (s, point) = chord.at_depth(hero, start[hero] + past);
        // Rounding can pass the end of what is lit.
        let (s, point) =
            if s >= from && s <= to { (s, point) } else { (s.clamp(from, to), chord.point(s.clamp(from, to))) };
        let Some(Seen { scattered, through }) = sight.at(s) else { continue };
        let arrives = point.depth.map(|depth| (-depth).exp());
        let slope = point.slope.map(|slope| slope.max(0.0));
        let density: [f64; L] =
            std::array::from_fn(|j| if mass[j] > 0.0 { slope[j] * arrives[j] / mass[j] } else { 0.0 });
        if density[hero] <= 0.0 {
            continue;
        }
        let arrives = |j: usize| arrives[j] / density[hero] * share * light[j] * through[j];
        carried.score_drawn(sum, turn, &scattered, arrives, |j| density[j] / density[hero]);
    }
}

/// A chord looked along, with the sun somewhere.
struct Sight<'a, R: Radiation, const L: usize> {
    problem: &'a Problem<'a, L>,
    chord: &'a Chord<'a, L>,
    place: Place,
    direction: DVec3,
    sun: DVec3,
    towards: Towards<R, L>,
}

/// What a point of a chord sends along it.
struct Seen<R: Radiation, const L: usize> {
    /// Scattering coefficient times what scattering makes of natural light.
    scattered: [R::Natural; L],
    /// Transmittance to the sun.
    through: [f64; L],
}

impl<R: Radiation, const L: usize> Sight<'_, R, L> {
    /// `None` if the planet hides the sun.
    #[inline]
    fn at(&self, s: f64) -> Option<Seen<R, L>> {
        let there = self.chord.place(self.place, self.direction, s);
        let through = self.problem.columns.transmittance(there, self.sun)?;
        Some(Seen { scattered: self.towards.at(&self.problem.medium.local_at(there.altitude_m)), through })
    }

    /// Transmittance between a point and the chord's beginning.
    #[inline]
    fn arrives(&self, s: f64) -> [f64; L] {
        self.chord.point(s).depth.map(|depth| (-depth).exp())
    }
}

/// A density along a chord like that of the singly scattered sunlight itself: linear between points at which this is
/// computed, and nowhere below a share of its mean, so that what happens between them is not lost.
struct Guide {
    places: [f64; GUIDE_POINTS],
    /// Densities at the points and the probability below each.
    densities: [f64; GUIDE_POINTS],
    below: [f64; GUIDE_POINTS],
    count: usize,
}

/// The most points of a guide.
const GUIDE_POINTS: usize = 24;

/// The least density of a guide as a share of its mean.
const LEAST: f64 = 0.05;

impl Guide {
    /// `None` if no light comes from anywhere.
    fn new<R: Radiation, const L: usize>(sight: &Sight<'_, R, L>, stretches: &[(f64, f64)]) -> Option<Self> {
        let mut guide =
            Self { places: [0.0; GUIDE_POINTS], densities: [0.0; GUIDE_POINTS], below: [0.0; GUIDE_POINTS], count: 0 };
        let mut light = [[0.0; L]; GUIDE_POINTS];
        let each = GUIDE_POINTS / stretches.len().max(1);
        for &(from, to) in stretches {
            for i in 0..each {
                let s = spread(sight.chord, from, to, i as f64 / (each - 1) as f64);
                let at = guide.count;
                guide.places[at] = s;
                if let Some(Seen { scattered, through }) = sight.at(s) {
                    let arrives = sight.arrives(s);
                    light[at] = std::array::from_fn(|j| arrives[j] * scattered[j].intensity() * through[j]);
                }
                guide.count += 1;
            }
        }
        // Every wavelength counts by its share of its own light.
        let joined = |i: usize| i + 1 < guide.count && !(i + 1).is_multiple_of(each);
        let mut whole = [0.0; L];
        for i in (0..guide.count).filter(|&i| joined(i)) {
            let width = guide.places[i + 1] - guide.places[i];
            for j in 0..L {
                whole[j] += 0.5 * width * (light[i][j] + light[i + 1][j]);
            }
        }
        let length: f64 = stretches.iter().map(|(from, to)| to - from).sum();
        let lanes = whole.iter().filter(|&&w| w > 0.0).count() as f64;
        if lanes == 0.0 || length <= 0.0 {
            return None;
        }
        for (density, light) in guide.densities.iter_mut().zip(&light[..guide.count]) {
            let own: f64 = (0..L).filter(|&j| whole[j] > 0.0).map(|j| light[j] / whole[j]).sum();
            *density = (1.0 - LEAST) * own / lanes + LEAST / length;
        }
        for i in 1..guide.count {
            let width = guide.places[i] - guide.places[i - 1];
            let mean = 0.5 * (guide.densities[i] + guide.densities[i - 1]);
            guide.below[i] = guide.below[i - 1] + if joined(i - 1) { width * mean } else { 0.0 };
        }
        Some(guide)
    }

    /// The place at quantile `u`, and the density there.
    #[inline]
    fn sample(&self, u: f64) -> (f64, f64) {
        let whole = self.below[self.count - 1];
        let wanted = u * whole;
        let i = self.below[..self.count].partition_point(|&b| b <= wanted).clamp(1, self.count - 1) - 1;
        let (a, b) = (self.densities[i], self.densities[i + 1]);
        let width = self.places[i + 1] - self.places[i];
        // The integral of a line, inverted in the form that does not cancel.
        let part = (wanted - self.below[i]) / width;
        let fraction = (2.0 * part / (a + (a * a + 2.0 * (b - a) * part).max(0.0).sqrt())).clamp(0.0, 1.0);
        (self.places[i] + fraction * width, (a + fraction * (b - a)) / whole)
    }
}

/// The place at share `t` of a stretch, closer together where it is low: uniform in the root of the height above its lowest point.
#[inline(always)]
fn spread<const L: usize>(chord: &Chord<'_, L>, from: f64, to: f64, t: f64) -> f64 {
    if t <= 0.0 {
        return from;
    }
    if t >= 1.0 {
        return to;
    }
    let lowest = chord.altitude(0.0_f64.clamp(from, to));
    let root = |s: f64| (chord.altitude(s) - lowest).max(0.0).sqrt();
    // Falling towards the perigee counts as negative.
    let (a, b) = (if from < 0.0 { -root(from) } else { 0.0 }, if to > 0.0 { root(to) } else { 0.0 });
    let v = a + t * (b - a);
    let falls = v < 0.0 || to <= 0.0;
    let s = chord.distance(lowest + v * v);
    (if falls { -s } else { s }).clamp(from, to)
}

/// exp(-a) - exp(-b) without cancellation.
#[inline(always)]
fn between(a: f64, b: f64) -> f64 {
    -(-a).exp() * (a - b).min(0.0).exp_m1()
}

/// The stretches of a chord outside the planet's shadow: at most two, for the shadow is convex. A hair of the shadow is
/// counted as light, so that rounding loses none; what is dark there finds the planet in the way.
#[inline(always)]
fn lit<const L: usize>(
    shape: Shape,
    chord: &Chord<'_, L>,
    place: Place,
    direction: DVec3,
    sun: DVec3,
) -> ([(f64, f64); 2], usize) {
    let (from, to) = chord.ends();
    let whole = ([(from, to), (0.0, 0.0)], usize::from(to > from));
    let Shape::Sphere { radius_m } = shape else {
        return if place.up.dot(sun) > 0.0 { whole } else { ([(0.0, 0.0); 2], 0) };
    };
    let radius = radius_m * (1.0 - 1e-9);
    // x(t) = x_0 + t d; in the shadow x . sun < 0 and |x - (x . sun) sun| < R.
    let start = place.up * (radius_m + place.altitude_m);
    let (along, across) = (start.dot(sun), direction.dot(sun));
    let (x, d) = (start - sun * along, direction - sun * across);
    let (a, b, c) = (d.length_squared(), x.dot(d), x.length_squared() - radius * radius);
    let discriminant = b * b - a * c;
    // The part of the line, in distance from its beginning, in the cylinder.
    let (mut enters, mut leaves) = if a <= 1e-18 {
        if c < 0.0 { (f64::NEG_INFINITY, f64::INFINITY) } else { return whole }
    } else if discriminant <= 0.0 {
        return whole;
    } else {
        let root = discriminant.sqrt();
        // The root without cancellation, and the other by their product c / a.
        let far = if b > 0.0 { (-b - root) / a } else { (-b + root) / a };
        let near = if far == 0.0 { 0.0 } else { c / (a * far) };
        (far.min(near), far.max(near))
    };
    // And behind the planet.
    if across.abs() > 1e-18 {
        let terminator = -along / across;
        if across > 0.0 { leaves = leaves.min(terminator) } else { enters = enters.max(terminator) }
    } else if along >= 0.0 {
        return whole;
    }
    let offset = chord.travelled(0.0);
    let (enters, leaves) = (enters - offset, leaves - offset);
    if leaves <= enters || leaves <= from || enters >= to {
        return whole;
    }
    let mut stretches = [(0.0, 0.0); 2];
    let mut count = 0;
    if enters > from {
        stretches[count] = (from, enters);
        count += 1;
    }
    if leaves < to {
        stretches[count] = (leaves, to);
        count += 1;
    }
    (stretches, count)
}
