//! A sum along the line of sight, for methods on Airlight's own atmosphere.

use super::isotropic::Further;
use crate::atmosphere::{Chord, Columns, Local, MAX_COMPONENTS, Medium, Tolerance};
use crate::geometry::{Place, Shape};
use crate::vectors::exp_minus;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;

/// Points on a line of sight if nothing is said.
pub const STEPS: u32 = 32;

/// An atmosphere over its ground, and how finely lines through it are divided.
#[derive(Debug)]
pub(super) struct Air<const L: usize> {
    medium: Medium<L>,
    columns: Columns<L>,
    albedo: [f64; L],
    steps: u32,
}

/// A point of a line of sight.
pub(super) struct At<const L: usize> {
    pub(super) place: Place,
    pub(super) local: Local<L>,
    /// Transmittance from the observer, times the length that the point stands for in m.
    pub(super) weight: [f64; L],
}

impl<const L: usize> Air<L> {
    pub(super) fn new(medium: &Medium<L>, shape: Shape, albedo: [f64; L], steps: u32) -> Self {
        Self { medium: medium.clone(), columns: Columns::new(medium, shape, Tolerance::RENDER), albedo, steps }
    }

    /// Points on a line of sight.
    pub(super) fn steps(&self) -> u32 {
        self.steps
    }

    pub(super) fn columns(&self) -> &Columns<L> {
        &self.columns
    }

    pub(super) fn medium(&self) -> &Medium<L> {
        &self.medium
    }

    /// Sunlight at a place over that outside the air; none in the planet's shadow.
    pub(super) fn sunlight(&self, place: Place, sun: DVec3) -> Option<[f64; L]> {
        self.columns.transmittance(place, sun)
    }

    /// Hands the points of the ray from `from` in the unit `direction` to `take`, `steps` of them, and gives its chord.
    ///
    /// Each arm of the line, from its lowest point l to an end e, is divided evenly in u, s = l + (e - l) u^2: the air is dense
    /// below. Points are the middles (midpoint rule).
    pub(super) fn march(
        &self,
        from: Place,
        direction: DVec3,
        steps: u32,
        mut take: impl FnMut(At<L>),
    ) -> Option<Chord<'_, L>> {
        let chord = self.columns.chord(from, direction)?;
        let (begin, end) = chord.ends();
        let lowest = if begin >= 0.0 { begin } else { end.min(0.0) };
        let arms = [(lowest, begin), (lowest, end)];
        let arms = arms.iter().filter(|(low, high)| low != high);
        let each = (steps / arms.clone().count().max(1) as u32).max(1);
        for &(low, high) in arms {
            for i in 0..each {
                let u = (f64::from(i) + 0.5) / f64::from(each);
                let s = low + (high - low) * u * u;
                let length = 2.0 * (high - low).abs() * u / f64::from(each);
                let place = chord.place(from, direction, s);
                let weight = exp_minus(chord.point(s).depth).map(|through| through * length);
                take(At { place, local: self.medium.local_at(place.altitude_m), weight });
            }
        }
        Some(chord)
    }

    /// Radiance per unit solar irradiance, with that many points on the line: at each sunlight scattered once, and `more` light scattered
    /// evenly (sr^-1); at the end sunlight that the ground reflects.
    pub(super) fn radiance(
        &self,
        (from, direction): (Place, DVec3),
        sun: DVec3,
        steps: u32,
        more: Option<&Further<L>>,
    ) -> [f64; L] {
        let towards = Towards::new(&self.medium, direction.dot(sun));
        let mut sum = [0.0; L];
        let chord = self.march(from, direction, steps, |At { place, local, weight }| {
            if let Some(sunlight) = self.sunlight(place, sun) {
                let scattered = towards.at(&local);
                for j in 0..L {
                    sum[j] += weight[j] * scattered[j] * sunlight[j];
                }
            }
            if let Some(more) = &more {
                let field = more.at(place.altitude_m, place.up.dot(sun));
                for j in 0..L {
                    sum[j] += weight[j] * local.scattering[j] * field[j];
                }
            }
        });
        if let Some(chord) = chord.filter(Chord::ends_on_ground) {
            let through = exp_minus(chord.total());
            let reflected = self.reflected(chord.foot(from, direction), sun);
            for j in 0..L {
                sum[j] += through[j] * reflected[j];
            }
        }
        sum
    }

    /// Radiance of the ground in sunlight per unit solar irradiance.
    pub(super) fn reflected(&self, foot: Place, sun: DVec3) -> [f64; L] {
        let cosine = foot.up.dot(sun);
        let lit = if cosine > 0.0 { self.sunlight(foot, sun) } else { None };
        lit.map_or([0.0; L], |light| std::array::from_fn(|j| self.albedo[j] * FRAC_1_PI * cosine * light[j]))
    }
}

/// Phase functions of all species at one angle, times their cross-sections in m^2 sr^-1.
struct Towards<const L: usize> {
    parts: [[f64; L]; MAX_COMPONENTS],
    count: usize,
}

impl<const L: usize> Towards<L> {
    fn new(medium: &Medium<L>, cosine: f64) -> Self {
        let mut parts = [[0.0; L]; MAX_COMPONENTS];
        for (part, component) in parts.iter_mut().zip(medium.components()) {
            if component.scatters() {
                let phase = component.phase.values(cosine);
                *part = std::array::from_fn(|j| phase[j] * component.scattering[j]);
            }
        }
        Self { parts, count: medium.components().len() }
    }

    /// Scattering coefficient times phase function in m^-1 sr^-1.
    fn at(&self, local: &Local<L>) -> [f64; L] {
        let mut sum = [0.0; L];
        for (part, density) in self.parts[..self.count].iter().zip(local.densities) {
            for j in 0..L {
                sum[j] += part[j] * density;
            }
        }
        sum
    }
}
