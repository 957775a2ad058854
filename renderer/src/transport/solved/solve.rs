//! The solution: order after order, from the field of another grid if there is one, until another order changes nothing that counts.

use super::first::{self, Scattering, Sunlight};
use super::grid::Grid;
use super::mix::Mixer;
use super::orders::{AZIMUTHS, Around, FEW_AZIMUTHS, Field};
use super::rays::{Line, Lines};
use super::{Optics, Resolution, Solved, file, start};
use crate::vectors::vectorised;
use pulp::NullaryFnOnce;
use rayon::prelude::*;
use std::f64::consts::FRAC_1_PI;

/// The most orders.
const MOST_ORDERS: usize = 60;

/// What all parts of the solution share.
pub(super) struct Setup<'a, const L: usize> {
    pub(super) grid: &'a Grid,
    pub(super) optics: &'a Optics<L>,
}

impl<const L: usize> Setup<'_, L> {
    /// The solution on a grid of that resolution, begun at the field of another one; and its first order.
    pub(super) fn solve(&self, resolution: &Resolution, from: Option<&Solved<L>>) -> (file::Solution<L>, Field<L>) {
        let lines = self.lines(resolution);
        let first = self.first(resolution, &lines);
        let reflected = self.optics.albedo.map(|a| (a * FRAC_1_PI) as f32);
        let (moments, suns) = (&self.optics.moments, &self.grid.suns);
        let mut field = match from {
            Some(from) => start::carried(from, self.grid, moments, &first),
            None => first.clone(),
        };
        let mut mixer = None;
        let mut orders = 1;
        loop {
            let mut next = self.collect(&|level| {
                let around = Around { lines: &lines[level], moments, suns, reflected };
                vectorised::<L, _>(Next { around, field: &field })
            });
            orders += 1;
            vectorised::<L, _>(Add { field: &mut next, other: &first });
            // Of the first order alone much is dark that is not so in the end.
            let mixer = mixer.get_or_insert_with(|| Mixer::new(&next, moments.count()));
            let residual;
            (field, residual) = mixer.mix(field, next);
            if residual <= resolution.change || orders >= MOST_ORDERS {
                return ((field, orders, residual), first);
            }
        }
    }

    /// The first order alone.
    pub(super) fn single(&self, resolution: &Resolution) -> Field<L> {
        self.first(resolution, &self.lines(resolution))
    }

    /// The lines of each level.
    fn lines(&self, resolution: &Resolution) -> Vec<Lines<L>> {
        let levels = (0..self.grid.levels.len()).into_par_iter();
        levels.map(|level| Lines::new(self, level, &self.grid.zeniths(level, resolution.zeniths))).collect()
    }

    fn first(&self, resolution: &Resolution, lines: &[Lines<L>]) -> Field<L> {
        let (sunlight, scattering) = (Sunlight::new(self, resolution.parts), Scattering::new(self));
        self.collect(&|level| {
            vectorised::<L, _>(First {
                setup: self,
                level,
                lines: &lines[level].lines,
                sunlight: &sunlight,
                scattering: &scattering,
            })
        })
    }

    /// A field from what each level has of it.
    fn collect(&self, at: &(dyn Fn(usize) -> Moved<L> + Sync)) -> Field<L> {
        let mut parts: Vec<_> = (0..self.grid.levels.len()).into_par_iter().map(at).collect();
        let ground = std::mem::take(&mut parts[0].1);
        let mut moments = Vec::with_capacity(parts.len() * parts[0].0.len());
        parts.iter().for_each(|(part, _)| moments.extend_from_slice(part));
        Field { moments, ground }
    }
}

/// Moments at a level, and irradiance from above.
type Moved<const L: usize> = (Vec<[f32; L]>, Vec<[f32; L]>);

/// The first order at one level.
pub(super) struct First<'a, const L: usize> {
    pub(super) setup: &'a Setup<'a, L>,
    pub(super) level: usize,
    pub(super) lines: &'a [Line<L>],
    pub(super) sunlight: &'a Sunlight<L>,
    pub(super) scattering: &'a Scattering<L>,
}

impl<const L: usize> NullaryFnOnce for First<'_, L> {
    type Output = Moved<L>;

    #[inline(always)]
    fn call(self) -> Moved<L> {
        let Self { setup, level, lines, sunlight, scattering } = self;
        if setup.optics.moments.degree() > 2 {
            first::scatter::<L, 16>(setup, level, lines, sunlight, scattering)
        } else {
            first::scatter::<L, 8>(setup, level, lines, sunlight, scattering)
        }
    }
}

/// Another order at one level.
pub(super) struct Next<'a, const L: usize> {
    pub(super) around: Around<'a, L>,
    pub(super) field: &'a Field<L>,
}

impl<const L: usize> NullaryFnOnce for Next<'_, L> {
    type Output = Moved<L>;

    #[inline(always)]
    fn call(self) -> Moved<L> {
        if self.around.moments.degree() > 2 {
            self.around.scatter::<AZIMUTHS>(self.field)
        } else {
            self.around.scatter::<FEW_AZIMUTHS>(self.field)
        }
    }
}

/// Adds another field to one.
struct Add<'a, const L: usize> {
    field: &'a mut Field<L>,
    other: &'a Field<L>,
}

impl<const L: usize> NullaryFnOnce for Add<'_, L> {
    type Output = ();

    #[inline(always)]
    fn call(self) {
        let Self { field, other } = self;
        let all = field.moments.iter_mut().chain(&mut field.ground).zip(other.moments.iter().chain(&other.ground));
        for (sum, row) in all {
            for j in 0..L {
                sum[j] += row[j];
            }
        }
    }
}
