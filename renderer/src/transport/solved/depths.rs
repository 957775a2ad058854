//! Optical depths of a part of what species scatter: of forward peaks, or of what keeps its polarisation.

use super::line::MOST_SPECIES;
use super::species::Species;
use crate::atmosphere::{Chord, Columns, Component, Medium, MediumError, Tolerance};
use crate::geometry::{Place, Shape};
use crate::phase::Phase;
use glam::DVec3;

/// Species whose lines are followed at once.
const GROUP: usize = 4;
const GROUPS: usize = MOST_SPECIES.div_ceil(GROUP);

/// Depths of some species, all together.
#[derive(Debug)]
pub(super) struct Depths<const L: usize> {
    groups: Vec<Group<L>>,
}

/// Of each species the depth at the wavelength where it is most, and the other wavelengths as shares.
#[derive(Debug)]
struct Group<const L: usize> {
    columns: Columns<GROUP>,
    shares: Vec<[f64; L]>,
}

/// A line through them.
pub(super) struct Along<'a, const L: usize> {
    chords: [Option<(Chord<'a, GROUP>, &'a Group<L>)>; GROUPS],
}

impl<const L: usize> Depths<L> {
    /// Of nothing.
    pub(super) fn none() -> Self {
        Self { groups: Vec::new() }
    }

    /// Of what these species of a medium scatter with these cross-sections.
    pub(super) fn new(
        parts: &[(&Species<L>, [f64; L])],
        medium: &Medium<L>,
        shape: Shape,
    ) -> Result<Self, MediumError> {
        let groups = parts.chunks(GROUP).map(|parts| Group::new(parts, medium, shape));
        Ok(Self { groups: groups.collect::<Result<_, _>>()? })
    }

    #[inline(always)]
    pub(super) fn along(&self, from: Place, direction: DVec3) -> Along<'_, L> {
        let mut along = Along { chords: [const { None }; GROUPS] };
        for (to, group) in along.chords.iter_mut().zip(&self.groups) {
            *to = group.columns.chord(from, direction).map(|chord| (chord, group));
        }
        along
    }
}

impl<const L: usize> Along<'_, L> {
    /// From the beginning of the line to a point of it.
    #[inline(always)]
    pub(super) fn before(&self, s: f64) -> [f64; L] {
        let mut depth = [0.0; L];
        for (chord, group) in self.chords.iter().flatten() {
            depth = group.added(depth, &chord.point(s).depth);
        }
        depth
    }

    /// From a point of it, at that place, to the sun.
    #[inline(always)]
    pub(super) fn after(&self, place: Place, sun: DVec3) -> [f64; L] {
        let mut depth = [0.0; L];
        for (_, group) in self.chords.iter().flatten() {
            if let Some(chord) = group.columns.chord(place, sun) {
                depth = group.added(depth, &chord.total());
            }
        }
        depth
    }
}

impl<const L: usize> Group<L> {
    /// Of at most [`GROUP`] species.
    fn new(parts: &[(&Species<L>, [f64; L])], medium: &Medium<L>, shape: Shape) -> Result<Self, MediumError> {
        let most: Vec<_> = parts.iter().map(|(_, sections)| sections.iter().copied().fold(0.0, f64::max)).collect();
        let component = |k: usize| {
            // Lanes without a species repeat the first.
            let scattering = |lane: usize| if lane == k || (k == 0 && lane >= parts.len()) { most[k] } else { 0.0 };
            Component {
                density: medium.components()[parts[k].0.component].density.clone(),
                scattering: std::array::from_fn(scattering),
                absorption: [0.0; GROUP],
                phase: Phase::Rayleigh { gamma: [0.0; GROUP] },
            }
        };
        let medium = Medium::new((0..parts.len()).map(component).collect(), medium.top_m())?;
        let shares = parts.iter().zip(&most).map(|((_, sections), most)| sections.map(|one| one / most)).collect();
        Ok(Self { columns: Columns::new(&medium, shape, Tolerance::SOLVE), shares })
    }

    /// Adds depths of its species.
    #[inline(always)]
    fn added(&self, sum: [f64; L], depths: &[f64; GROUP]) -> [f64; L] {
        let mut sum = sum;
        for (depth, shares) in depths.iter().zip(&self.shares) {
            for j in 0..L {
                sum[j] += depth * shares[j];
            }
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use super::super::species::whole;
    use super::*;
    use crate::transport::tests::{EARTH, exponential, medium, towards};

    #[test]
    fn depths_of_species_in_groups_add_up_to_those_of_their_sum() {
        // Five species, of which one has a group to itself, beside columns of all together: six tables of depths that are each right to
        // 1e-4 e^depth.
        let top = 6e4;
        let components: Vec<_> = (0..5)
            .map(|k| Component {
                density: exponential(1500.0 * f64::from(k + 1), top),
                scattering: [1e-5 * f64::from(k + 1), 2e-5],
                absorption: [0.0; 2],
                phase: Phase::HenyeyGreenstein { g: [0.5; 2] },
            })
            .collect();
        let air = medium(components, top);
        let species = whole(&air);
        let parts: Vec<_> = species.iter().map(|one| (one, one.scattering)).collect();
        let depths = Depths::new(&parts, &air, EARTH).expect("sound");
        let (from, direction, sun) = (Place::above(2e3), towards(80.0, 20.0), towards(85.0, 0.0));
        let columns = Columns::new(&air, EARTH, Tolerance::SOLVE);
        let chord = columns.chord(from, direction).expect("in the air");
        let along = depths.along(from, direction);
        for s in [0.3, 0.6, 1.0].map(|share| chord.ends().0 + share * (chord.ends().1 - chord.ends().0)) {
            let place = chord.place(from, direction, s);
            let after = columns.chord(place, sun).map_or([0.0; 2], |chord| chord.total());
            let pairs = [(along.before(s), chord.point(s).depth), (along.after(place, sun), after)];
            for (found, right) in pairs.iter().flat_map(|(found, right)| found.iter().zip(right)) {
                assert!((found - right).abs() <= 6e-4 * right.exp(), "{s}: {found:e}, {right:e}");
            }
        }
    }
}
