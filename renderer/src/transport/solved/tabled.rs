//! What of light a table knows and a certificate follows: radiance alone, or I, Q and U. Certificates are written once, for either.

use super::Solved;
use super::view::Look;
use crate::atmosphere::Columns;
use crate::geometry::Place;
use crate::polarisation::{Analyser, Frame, Stokes};
use crate::transport::radiation::{Polarised, Radiation, Scalar};
use crate::vectors::vectorised;
use glam::DVec3;
use std::fmt::Debug;

/// Light of a solved table, followed backwards from an observer.
pub(super) trait Tabled:
    Radiation<Seen: Debug + Send, Contribution: Debug, Frame: Debug + Sync> + Copy + Debug
{
    /// What is seen of light that is referred to the contribution's frame.
    fn see_light(contribution: &Self::Contribution, light: &Self::Seen) -> Self::Seen;

    /// What is seen of light that arrives with the transmittance `through` from a place of which a metre stands for `stretch` over `density`.
    fn carried(contribution: &Self::Contribution, through: f64, stretch: f64, density: f64) -> Self::Contribution;

    /// Its radiance.
    fn radiance(light: &Self::Seen) -> f64;

    /// The table's source in a frame of the direction looked in: at a place between levels, each with its share, where the species
    /// scatter by these coefficients, with the sun in that direction.
    fn diffuse<const L: usize>(
        solved: &Solved<L>,
        levels: &[(usize, f32)],
        at: (Place, DVec3, DVec3),
        frame: Self::Frame,
        scattering: &[[f64; L]],
        harmonics: &mut Vec<f64>,
    ) -> [Self::Seen; L];

    /// Sunlight scattered or reflected once that arrives at a place out of a direction, as by [`Solved::radiance_of_sunlight`].
    fn single<const L: usize>(
        solved: &Solved<L>,
        from: Place,
        look: (DVec3, Self::Frame),
        sun: DVec3,
        sunlight: &Columns<L>,
    ) -> [Self::Seen; L];
}

/// The table's source of radiance.
#[inline(always)]
fn radiance<const L: usize>(
    solved: &Solved<L>,
    levels: &[(usize, f32)],
    (place, direction, sun): (Place, DVec3, DVec3),
    scattering: &[[f64; L]],
    harmonics: &mut Vec<f64>,
) -> [f64; L] {
    let cosines = [place.up.dot(direction), place.up.dot(sun), direction.dot(sun)];
    solved.diffuse(levels, cosines, scattering, harmonics).map(f64::from)
}

impl Tabled for Scalar {
    #[inline(always)]
    fn see_light(contribution: &f64, light: &f64) -> f64 {
        contribution * light
    }

    #[inline(always)]
    fn carried(contribution: &f64, through: f64, stretch: f64, density: f64) -> f64 {
        contribution * through * stretch / density
    }

    #[inline(always)]
    fn radiance(light: &f64) -> f64 {
        *light
    }

    #[inline(always)]
    fn diffuse<const L: usize>(
        solved: &Solved<L>,
        levels: &[(usize, f32)],
        at: (Place, DVec3, DVec3),
        (): (),
        scattering: &[[f64; L]],
        harmonics: &mut Vec<f64>,
    ) -> [f64; L] {
        radiance(solved, levels, at, scattering, harmonics)
    }

    fn single<const L: usize>(
        solved: &Solved<L>,
        from: Place,
        (direction, ()): (DVec3, ()),
        sun: DVec3,
        sunlight: &Columns<L>,
    ) -> [f64; L] {
        solved.radiance_of_sunlight(from, direction, sun, sunlight)
    }
}

impl Tabled for Polarised {
    #[inline(always)]
    fn see_light(contribution: &Analyser, light: &Stokes) -> Stokes {
        contribution.see(light)
    }

    #[inline(always)]
    fn carried(contribution: &Analyser, through: f64, stretch: f64, density: f64) -> Analyser {
        *contribution * (through * stretch / density)
    }

    #[inline(always)]
    fn radiance(light: &Stokes) -> f64 {
        light.i
    }

    #[inline(always)]
    fn diffuse<const L: usize>(
        solved: &Solved<L>,
        levels: &[(usize, f32)],
        at: (Place, DVec3, DVec3),
        frame: Frame,
        scattering: &[[f64; L]],
        harmonics: &mut Vec<f64>,
    ) -> [Stokes; L] {
        let i = radiance(solved, levels, at, scattering, harmonics);
        let (level, [q, u]) = solved.diffuse_linear(levels, at, scattering);
        let turn = level.turn_to(frame, at.1);
        std::array::from_fn(|j| Stokes { i: i[j], q: f64::from(q[j]), u: f64::from(u[j]) }.turned(turn))
    }

    fn single<const L: usize>(
        solved: &Solved<L>,
        from: Place,
        (direction, frame): (DVec3, Frame),
        sun: DVec3,
        sunlight: &Columns<L>,
    ) -> [Stokes; L] {
        let seen = vectorised::<L, _>(Look { solved, from, direction, sun, single: true, sunlight });
        solved.show(&seen, (from, direction, frame), sun, true)
    }
}
