//! Where a solution begins: at the field of another grid, carried over to its own.
//!
//! The fixed point of all orders does not depend on where they start, only their number does: what a coarser grid has of all orders but
//! the first is right to a few percent, and each order leaves a share of that. Between its levels and suns this is the cubic in
//! altitude^0.4, about in which levels are even, and in the suns' u(chi) (grid.rs); of the mean radiance it is that of the logarithm, for
//! in twilight light falls by decades from sun to sun, and of the other moments that of their share of it.

use super::Solved;
use super::grid::{Between, Grid};
use super::harmonics::Moments;
use super::line::{Crossing, Stencil};
use super::orders::Field;
use super::solve::Setup;
use crate::vectors::add_product;

/// Mean radiances at or below this have no logarithm.
const DARK: f32 = 1e-30;

/// A place of the other grid, by its number, and its share.
type Shared = (usize, f32);

/// What `from` has of all orders but the first, between its places, with the first order on another grid with other moments.
pub(super) fn carried<const L: usize>(from: &Solved<L>, grid: &Grid, moments: &Moments, first: &Field<L>) -> Field<L> {
    let (old, theirs, further) = (&from.grid, &from.optics.moments, from.further());
    let (count, width) = (moments.count(), theirs.count());
    let places: Vec<Crossing> =
        old.levels.iter().enumerate().map(|(level, h)| Crossing { level, s: measure(*h) }).collect();
    let same: Vec<_> = (0..count).filter_map(|i| Some((i, theirs.place_of(moments, i)?))).collect();
    let suns: Vec<Vec<Shared>> = grid.suns.nodes.iter().map(|chi| suns_about(*chi, old)).collect();
    let mut field = first.clone();
    for (rows, h) in field.moments.chunks_exact_mut(count * suns.len()).zip(&grid.levels) {
        let levels = levels_about(measure(*h), &places, &old.walls);
        for (row, suns) in rows.chunks_exact_mut(count).zip(&suns) {
            let about = levels.iter().flat_map(|&(level, a)| {
                suns.iter().map(move |&(sun, b)| ((level * old.suns.count() + sun) * width, a * b))
            });
            let about: Vec<Shared> = about.collect();
            let shares = shares(&about, &further.moments);
            for &(here, there) in &same {
                for ((place, _), share) in about.iter().zip(&shares) {
                    add_product(&mut row[here], share, &further.moments[place + there]);
                }
            }
        }
    }
    for (value, about) in field.ground.iter_mut().zip(&suns) {
        for ((sun, _), share) in about.iter().zip(&shares(about, &further.ground)) {
            add_product(value, share, &further.ground[*sun]);
        }
    }
    field
}

impl<const L: usize> Solved<L> {
    /// All orders but the first, which is found again where the solution comes from a file.
    fn further(&self) -> Field<L> {
        let found;
        let first = if let Some(first) = &self.first {
            first
        } else {
            let resolution = self.resolutions[self.resolutions.len() - 1].about(&self.optics.moments);
            found = Setup { grid: &self.grid, optics: &self.optics }.single(&resolution);
            &found
        };
        let less = |all: &[[f32; L]], first: &[[f32; L]]| {
            all.iter().zip(first).map(|(a, b)| std::array::from_fn(|j| a[j] - b[j])).collect()
        };
        Field { moments: less(&self.field.moments, &first.moments), ground: less(&self.field.ground, &first.ground) }
    }
}

fn measure(altitude: f64) -> f64 {
    altitude.powf(0.4)
}

/// The levels about a place, on one side of a wall.
fn levels_about(at: f64, places: &[Crossing], walls: &[bool]) -> Vec<Shared> {
    let interval = places.partition_point(|place| place.s <= at).clamp(1, places.len() - 1) - 1;
    let stencil = Stencil::around(interval, places, walls);
    let weights = stencil.through(places).weights(at);
    (stencil.first..).zip(weights).take(stencil.count).map(|(level, weight)| (level, weight as f32)).collect()
}

fn suns_about(chi: f64, old: &Grid) -> Vec<Shared> {
    let Between { first: [first], weights } = old.suns.locate(&[chi.cos() as f32]);
    (first as usize..).zip(weights).map(|(sun, [weight])| (sun, weight)).collect()
}

/// What a place takes of each of the others, such that of their mean radiances it has what the polynomial of the logarithm has there; what
/// the polynomial itself has where one of them is dark.
fn shares<const L: usize>(about: &[Shared], means: &[[f32; L]]) -> Vec<[f32; L]> {
    let (mut logarithm, mut lit) = ([0.0; L], [true; L]);
    for &(place, weight) in about {
        for (j, value) in means[place].iter().enumerate() {
            lit[j] &= *value > DARK;
            logarithm[j] += weight * value.max(DARK).ln();
        }
    }
    let here = logarithm.map(f32::exp);
    let share = |&(place, weight): &Shared| {
        std::array::from_fn(|j| if lit[j] { weight * here[j] / means[place][j] } else { weight })
    };
    about.iter().map(share).collect()
}
