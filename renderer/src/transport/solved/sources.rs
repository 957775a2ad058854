//! Light that places send, by a solved table with the true sunlight: what certificates end in.
//!
//! Any source serves there, so it is one of few moments: those of high degree are up to three quarters of a table but little of its light, and
//! the larger D without them costs less than they would.

use super::aureole::Aureole;
use super::harmonics::Moments;
use super::line::MOST_SPECIES;
use super::orders::Field;
use super::tabled::Tabled;
use super::{Optics, Solved};
use crate::atmosphere::Columns;
use crate::geometry::Place;
use glam::DVec3;
use std::f64::consts::FRAC_1_PI;
use std::sync::Arc;

/// The highest degree of moments that certificates take from tables. In air with particles a round of fans then takes far less time than with
/// all moments and leaves hardly more noise; with those to 8 alone it leaves distinctly more.
pub(super) const DEGREE: usize = 12;

/// Light that a place sends into a direction, per length or from the ground.
#[derive(Debug, Clone, Copy)]
pub(super) struct Source<R: Tabled, const L: usize> {
    /// S_1 + S.
    pub(super) total: [R::Seen; L],
    /// S.
    pub(super) tail: [R::Seen; L],
}

impl<const L: usize> Solved<L> {
    /// The same air and grid with the moments up to a degree, at least 2, if it has others: of use for its sources alone.
    pub(super) fn up_to(&self, degree: usize) -> Option<Self> {
        let all = &self.optics.moments;
        if all.degree() <= degree {
            return None;
        }
        let moments = Moments::new(degree, all.polarised());
        let places: Vec<usize> = (0..moments.count()).filter_map(|i| all.place_of(&moments, i)).collect();
        debug_assert_eq!(places.len(), moments.count());
        let rows = self.field.moments.chunks_exact(all.count());
        let field = Field {
            moments: rows.flat_map(|row| places.iter().map(|&place| row[place])).collect(),
            ground: self.field.ground.clone(),
        };
        let Optics { species, medium, columns, onward, albedo, .. } = &*self.optics;
        let mut species = species.clone();
        species.iter_mut().for_each(|one| one.coefficients.truncate(degree + 1));
        let (medium, columns, onward) = (medium.clone(), columns.clone(), onward.of_places());
        let optics = Optics { moments, species, medium, columns, aureole: Aureole::none(), onward, albedo: *albedo };
        let (grid, resolutions) = (self.grid.clone(), self.resolutions.clone());
        let Self { orders, residual, .. } = *self;
        Some(Self { optics: Arc::new(optics), grid, field, first: None, orders, residual, resolutions })
    }
}

/// The table's sources with the true sunlight.
#[derive(Debug)]
pub(super) struct Sources<'a, const L: usize> {
    pub(super) solved: &'a Solved<L>,
    /// Columns of the true air.
    pub(super) truth: &'a Columns<L>,
    /// Those of the table's air, if that is another.
    pub(super) scaled: Option<&'a Columns<L>>,
}

impl<'a, const L: usize> Sources<'a, L> {
    pub(super) fn optics(&self) -> &Optics<L> {
        &self.solved.optics
    }

    /// Columns of the table's air.
    #[inline(always)]
    pub(super) fn columns(&self) -> &'a Columns<L> {
        self.scaled.unwrap_or(self.truth)
    }

    /// Scattering coefficients of the species, without what goes straight on.
    #[inline(always)]
    pub(super) fn scattering(&self, altitude: f64) -> [[f64; L]; MOST_SPECIES] {
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

    /// The table's source where the species scatter so much.
    #[inline(always)]
    pub(super) fn diffuse<R: Tabled>(
        &self,
        place: Place,
        (direction, frame): (DVec3, R::Frame),
        sun: DVec3,
        scattering: &[[f64; L]; MOST_SPECIES],
        harmonics: &mut Vec<f64>,
    ) -> [R::Seen; L] {
        let solved = self.solved;
        let levels = &solved.grid.levels;
        let above = levels.partition_point(|&level| level <= place.altitude_m).clamp(1, levels.len() - 1);
        let (a, b) = (levels[above - 1], levels[above]);
        let share = ((place.altitude_m - a) / (b - a)) as f32;
        let rows = [(above - 1, 1.0 - share), (above, share)];
        let species = self.optics().species.len();
        R::diffuse(solved, &rows, (place, direction, sun), frame, &scattering[..species], harmonics)
    }

    /// Adds what a metre of air scatters of the sunlight that arrives with the table's extinction, where the phase functions are those.
    #[inline(always)]
    pub(super) fn add_sunlight(
        &self,
        sum: &mut [f64; L],
        (place, sun): (Place, DVec3),
        scattering: &[[f64; L]; MOST_SPECIES],
        phases: &[[f64; L]; MOST_SPECIES],
    ) {
        let Some(through) = self.columns().transmittance(place, sun) else { return };
        let mut total = *sum;
        for ((one, scattering), phase) in self.optics().species.iter().zip(scattering).zip(phases) {
            for j in 0..L {
                total[j] += phase[j] * one.whole[j] * scattering[j] * through[j];
            }
        }
        *sum = total;
    }

    /// Of a metre of air into the direction looked in, referred to `frame`, in m^-1 sr^-1 per unit solar irradiance.
    #[inline(always)]
    pub(super) fn air<R: Tabled>(
        &self,
        place: Place,
        (direction, frame): (DVec3, R::Frame),
        sun: DVec3,
        harmonics: &mut Vec<f64>,
    ) -> Source<R, L> {
        let species = &self.optics().species;
        let scattering = self.scattering(place.altitude_m);
        let tail = self.diffuse::<R>(place, (direction, frame), sun, &scattering, harmonics);
        let mut source = Source { total: tail, tail };
        if let Some([through, truly]) = self.sunlight(place, sun) {
            let (turn, cosine) = (R::plane(frame, direction, sun).0, direction.dot(sun));
            for (one, scattering) in species.iter().zip(&scattering) {
                let natural = R::natural(&one.phase, cosine);
                for j in 0..L {
                    let scattered = natural[j] * (scattering[j] * one.whole[j]);
                    source.total[j] += R::see_scattered(&R::OBSERVER, turn, scattered, through[j]);
                    source.tail[j] += R::see_scattered(&R::OBSERVER, turn, scattered, through[j] - truly[j]);
                }
            }
        }
        source
    }

    /// Of the ground, in sr^-1: natural light.
    #[inline(always)]
    pub(super) fn ground<R: Tabled>(&self, foot: Place, sun: DVec3) -> Source<R, L> {
        let reflected = self.optics().albedo.map(|albedo| albedo * FRAC_1_PI);
        let mut tail = self.solved.diffuse_irradiance(foot, sun);
        let mut total = tail;
        let cosine = foot.up.dot(sun);
        if cosine > 0.0
            && let Some([through, truly]) = self.sunlight(foot, sun)
        {
            for j in 0..L {
                total[j] += cosine * through[j];
                tail[j] += cosine * (through[j] - truly[j]);
            }
        }
        let reflect = |light: [f64; L]| std::array::from_fn(|j| R::see(&R::OBSERVER, reflected[j] * light[j]));
        Source { total: reflect(total), tail: reflect(tail) }
    }
}
