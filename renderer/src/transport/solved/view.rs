//! What is seen: sunlight scattered once and the table's sources, integrated along the line of sight (sight.rs).

use super::grid::Between;
use super::harmonics::MOST_DEGREE;
use super::line::MOST_SPECIES;
use super::sight::Sight;
use super::{Optics, Solved};
use crate::atmosphere::Columns;
use crate::geometry::Place;
use crate::light::SunDisc;
use crate::polarisation::{Analyser, Frame, Natural, Stokes};
use crate::vectors::{add_product, vectorised};
use glam::DVec3;
use pulp::NullaryFnOnce;

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
        self.with_particles(&self.smooth((&seen.rest, &seen.once), towards), (&seen.peaks, &seen.once), towards, single)
    }

    /// The part of it that is smooth in the direction, all but sunlight scattered once by particles: of [`Seen`] the rest, and what each
    /// species scatters once.
    #[inline(always)]
    pub(super) fn smooth(&self, (rest, once): (&[f64; L], &[[f64; L]; MOST_SPECIES]), towards: f64) -> [f64; L] {
        let mut sum = *rest;
        for (one, once) in self.optics.species.iter().zip(once).filter(|(one, _)| one.is_molecular()) {
            let mut phase = one.phase.values(towards);
            for j in 0..L {
                phase[j] *= one.whole[j];
            }
            add_product(&mut sum, &phase, once);
        }
        sum
    }

    /// That and the rest: of [`Seen`] the depth of peaks, and what each species scatters once.
    #[inline(always)]
    pub(super) fn with_particles(
        &self,
        smooth: &[f64; L],
        (peaked, once): (&[f64; L], &[[f64; L]; MOST_SPECIES]),
        towards: f64,
        single: bool,
    ) -> [f64; L] {
        let Optics { species, aureole, .. } = &*self.optics;
        let mut peaks = None;
        if !single && !aureole.is_none() {
            let mut depth = [0.0; L];
            let mut whole = [0.0; L];
            for (_, once) in species.iter().zip(once).filter(|(one, _)| !one.is_molecular()) {
                add_product(&mut whole, once, &[1.0; L]);
            }
            for j in 0..L {
                // Between looks in the dark a polynomial may have a little of one without the other.
                depth[j] = if whole[j] > 0.0 { (peaked[j] / whole[j]).max(0.0) } else { 0.0 };
            }
            peaks = Some(aureole.towards(towards, &depth));
        }
        let mut sum = *smooth;
        for (i, (one, once)) in species.iter().zip(once).enumerate().filter(|(_, (one, _))| !one.is_molecular()) {
            let mut phase = one.phase.values(towards);
            // (No closure, since those are not always inlined.)
            if let Some(peaks) = &peaks {
                phase = peaks.widen(i, phase);
            }
            for j in 0..L {
                phase[j] *= one.whole[j];
            }
            add_product(&mut sum, &phase, once);
        }
        sum
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
        let Some(reach) = self.optics.reach(weights) else { return [0.0; L] };
        self.optics.moments.at(zenith, harmonics);
        let mut sources = [[0.0_f32; L]; MOST_DEGREE + 2];
        self.optics.add_sources(weights, &mut sources[..reach.sources]);
        let mut total = [0.0_f32; L];
        let Between { first: [first], weights: lagrange } = self.grid.suns.locate(&[there as f32]);
        let lagrange = lagrange.map(|weight| weight[0]);
        if lagrange == [0.0; 4] {
            return total;
        }
        let cosines = cosines(azimuth_cosine(zenith, there, towards), reach.degree);
        let (suns, moments) = (self.grid.suns.count(), self.optics.moments.count());
        for &(level, share) in levels {
            let lagrange = lagrange.map(|weight| share * weight);
            let from = (level * suns + first as usize) * moments;
            let rows = &self.field.moments[from..from + 4 * moments];
            let (below, above) = rows.split_at(2 * moments);
            let ((a, b), (c, d)) = (below.split_at(moments), above.split_at(moments));
            let all = &self.optics.moments;
            let pairs = all.pairs()[..reach.count].iter().zip(all.sources()).zip(&*harmonics);
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

/// Cosine of the azimuth of a direction looked in from the sun's: of its zenith angle, of the sun's, and of the angle between the two the
/// cosines are given. 1 where one of them is vertical.
#[inline(always)]
pub(super) fn azimuth_cosine(zenith: f64, there: f64, towards: f64) -> f64 {
    let across = ((1.0 - zenith) * (1.0 + zenith) * (1.0 - there) * (1.0 + there)).max(0.0).sqrt();
    if across > 1e-9 { ((towards - zenith * there) / across).clamp(-1.0, 1.0) } else { 1.0 }
}

/// Cosines of the multiples m of an angle, from 0 to `degree`, at least 1; 1 beyond.
#[inline(always)]
pub(super) fn cosines(cosine: f64, degree: usize) -> [f64; MOST_DEGREE + 1] {
    let mut cosines = [1.0; MOST_DEGREE + 1];
    cosines[1] = cosine;
    for m in 2..=degree {
        cosines[m] = 2.0 * cosine * cosines[m - 1] - cosines[m - 2];
    }
    cosines
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
        let Self { solved, from, direction, sun, single, sunlight } = self;
        Sight::new(solved, from, direction, single).map_or(Seen::NOTHING, |sight| sight.seen(direction, sun, sunlight))
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
    pub(super) const NOTHING: Self = Self {
        rest: [0.0; L],
        once: [[0.0; L]; MOST_SPECIES],
        turned: [[0.0; L]; MOST_SPECIES],
        peaks: [0.0; L],
        linear: [[0.0; L]; 2],
    };
}
