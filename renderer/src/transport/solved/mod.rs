//! Solved tables: the diffuse field of a spherically symmetric atmosphere, once for every sun and observer.
//!
//! In concentric shells over a uniform ground the diffuse radiance at a place depends on its altitude h and on the
//! zenith angle chi of the sun there; where the place lies does not matter otherwise. And of its dependence on direction
//! scattering keeps only the moments that the phase functions have: with P_s(c) = sum_l b_l P_l(c) of species s,
//!
//! J(omega) = sum_s k_s(h) sum_l b_l sum_m S_lm(mu) cos(m phi) I_lm(h, chi),  I_lm = int L S_lm(mu) cos(m phi) d omega
//!
//! is what a metre of air sends into the direction looked in (mu the cosine of its zenith angle, phi its azimuth from the
//! sun's, k_s the scattering coefficient; mirror symmetry leaves the cosines). For molecules these are four numbers, and exact. The table
//! holds them at some altitudes and suns, together with the irradiance of the ground; the field follows order after order:
//! the moments of one are integrated along lines in all directions, and give those of the next.
//!
//! Of polarised light molecules need four numbers too, with vector harmonics (linear.rs).
//!
//! What is seen is integrated along the line of sight: sunlight scattered once with the phase functions themselves, and the
//! table's sources. Radiance is never interpolated.

mod aureole;
mod certify;
mod depths;
mod fan;
mod file;
mod first;
mod folded;
mod glow;
mod grid;
mod guide;
mod harmonics;
mod line;
mod linear;
mod lobes;
mod mix;
mod nodes;
mod onward;
mod orders;
mod panorama;
mod rays;
mod sight;
mod solve;
mod sources;
mod species;
mod start;
mod tabled;
#[cfg(test)]
mod tests;
mod view;

pub use certify::{Certificate, Certified, Fan};
pub use grid::{Fineness, Resolution};
pub use panorama::{Panorama, Pixels, befitting};

use super::directions;
use crate::atmosphere::{Columns, Medium, MediumError, Tolerance};
use crate::geometry::{Place, Shape};
use aureole::Aureole;
use glam::DVec3;
use grid::Grid;
use harmonics::{MOST_DEGREE, Moments, RAYLEIGH};
use onward::Onward;
use orders::Field;
use solve::Setup;
use species::Species;
use std::path::Path;
use std::sync::Arc;
use tables::TableError;

/// Why a scene has no solved table.
#[derive(Debug, thiserror::Error)]
pub enum SolveError {
    /// The table is too far off for this sun.
    #[error("the solved table would be off by {}: take --method paths (the sun is too low for it, or the air too thick)", off(*.0))]
    Inexact(f64),
    /// The method does not cover it.
    #[error("{0}")]
    Refused(&'static str),
    /// The atmosphere without its forward peaks is impossible.
    #[error(transparent)]
    Medium(#[from] MediumError),
    /// A kept table cannot be read or written.
    #[error(transparent)]
    Kept(#[from] TableError),
}

fn off(error: f64) -> String {
    if error.is_finite() { format!("{:.0} %", 100.0 * error) } else { "more than can be said".into() }
}

/// The diffuse field of an atmosphere over a uniform ground, at `L` wavelengths.
#[derive(Debug)]
pub struct Solved<const L: usize> {
    optics: Arc<Optics<L>>,
    grid: Grid,
    field: Field<L>,
    /// What of it is the first order, if it is known.
    first: Option<Field<L>>,
    orders: usize,
    residual: f64,
    /// The resolutions from whose fields it began, the last last, and its own.
    resolutions: Vec<Resolution>,
}

/// An atmosphere without its forward peaks, over a uniform ground.
#[derive(Debug)]
struct Optics<const L: usize> {
    moments: Moments,
    species: Vec<Species<L>>,
    medium: Medium<L>,
    columns: Columns<L>,
    aureole: Aureole<L>,
    /// Of polarised light.
    onward: Onward<L>,
    albedo: [f64; L],
}

/// Share of the largest weight of a crossing below which a species that is no molecule is taken for one: the degrees above 2
/// are left out.
const FAINT: f64 = 1e-3;

/// How many moments count at a crossing, their highest degree, and how many sources they go with.
#[derive(Debug, Clone, Copy)]
struct Reach {
    count: usize,
    degree: usize,
    sources: usize,
}

impl<const L: usize> Optics<L> {
    /// By how much scattering that is taken to go straight on outweighs the rest, f / (1 - f) - 1 where that is positive: 0 unless phase
    /// functions have most of their light in moments beyond the last.
    fn in_peaks(&self) -> [f64; L] {
        self.mean_of_straight(self.species.iter(), |f| (f / (1.0 - f) - 1.0).max(0.0))
    }

    /// The share f of what particles scatter that is taken to go straight on, in moments beyond the last; 0 without particles.
    fn beyond_moments(&self) -> [f64; L] {
        self.mean_of_straight(self.species.iter().filter(|one| !one.is_molecular()), |f| f)
    }

    /// The mean over species of a function of their share f, weighed by what they scatter above the ground.
    fn mean_of_straight<'a>(&self, species: impl Iterator<Item = &'a Species<L>>, of: impl Fn(f64) -> f64) -> [f64; L] {
        let columns = self.medium.columns(Shape::Flat, Place::above(0.0), DVec3::Z).unwrap_or_default();
        let (mut sum, mut whole) = ([0.0; L], [0.0; L]);
        for one in species {
            for (j, f) in one.straight().into_iter().enumerate() {
                let scattered = columns[one.component] * one.scattering[j] * one.whole[j];
                whole[j] += scattered;
                sum[j] += scattered * of(f);
            }
        }
        std::array::from_fn(|j| if whole[j] > 0.0 { sum[j] / whole[j] } else { 0.0 })
    }

    /// What tables hide whose grid leaves out so much of what [`Resolution::RENDER`] does: always, and besides with a low sun.
    fn hidden(&self, grid: f64) -> [[f64; L]; 2] {
        if self.moments.degree() <= 2 {
            return [[0.0; L]; 2];
        }
        let besides = self.beyond_moments().map(|share| grid * HIDDEN_OF_PARTICLES * share);
        let in_peaks = self.in_peaks();
        [std::array::from_fn(|j| grid * HIDDEN + besides[j] + HIDDEN_IN_PEAKS * in_peaks[j]), besides]
    }

    /// Which moments count where the species have these weights; none if they have none.
    #[inline(always)]
    fn reach(&self, weights: &[[f64; L]]) -> Option<Reach> {
        let largest = weights.iter().flatten().fold(0.0_f64, |most, w| most.max(w.abs()));
        let counts = |weights: &[f64; L]| weights.iter().any(|w| w.abs() > FAINT * largest);
        let peaked = self.species.iter().zip(weights).any(|(one, weights)| !one.is_molecular() && counts(weights));
        let moments = &self.moments;
        let reach = if peaked {
            Reach { count: moments.count(), degree: moments.degree(), sources: moments.width() }
        } else {
            Reach { count: RAYLEIGH, degree: 2, sources: 3 }
        };
        (largest > 0.0).then_some(reach)
    }

    /// Adds of each moment that counts what it sends in a direction of that zenith angle (its cosine) where the species have these weights:
    /// s_l S_lm(mu). The harmonics are of use again.
    #[inline(always)]
    fn add_weights(
        &self,
        (weights, reach, zenith): (&[[f64; L]], Reach, f64),
        harmonics: &mut Vec<f64>,
        all: &mut Vec<[f32; L]>,
    ) {
        self.moments.at(zenith, harmonics);
        let mut sources = [[0.0; L]; MOST_DEGREE + 2];
        self.add_sources(weights, &mut sources[..reach.sources]);
        for (harmonic, &source) in harmonics.iter().zip(self.moments.sources()).take(reach.count) {
            let mut weight = sources[source];
            for one in &mut weight {
                *one *= *harmonic as f32;
            }
            all.push(weight);
        }
    }

    /// Adds to each source, of the degree l, the sum over the species of b_l times their weights; b_2 of those that are no molecules may
    /// have a source apart.
    #[inline(always)]
    fn add_sources(&self, weights: &[[f64; L]], sources: &mut [[f32; L]]) {
        for (one, weights) in self.species.iter().zip(weights) {
            let apart = self.moments.apart().filter(|_| !one.is_molecular());
            for (l, coefficients) in one.coefficients.iter().enumerate() {
                let place = if l == 2 { apart.unwrap_or(l) } else { l };
                let Some(source) = sources.get_mut(place) else { continue };
                for j in 0..L {
                    source[j] += (weights[j] * coefficients[j]) as f32;
                }
            }
        }
    }
}

impl Resolution {
    /// What the renderer takes.
    pub const RENDER: Self = Self { levels: 16, suns: 40, zeniths: [6, 3, 4], parts: 6, degree: 14, change: 5e-4 };

    /// What reference cases take: also the twilight limb seen from space.
    pub const FINE: Self = Self { levels: 36, suns: 48, zeniths: [10, 6, 8], parts: 8, degree: 20, change: 2e-4 };

    /// A coarser one, whose distance from [`Resolution::RENDER`] tells how far that is from the truth.
    pub const COARSE: Self = Self { levels: 12, suns: 30, zeniths: [4, 3, 3], parts: 4, degree: 14, change: 5e-4 };

    /// Twice as exact with aerosol as [`Resolution::COARSE`]: of a grid, directions and moments cost least for what they gain, then steps, suns, levels
    /// (`airlight study solved-grids`).
    pub const LIGHT: Self = Self { levels: 12, suns: 30, zeniths: [7, 4, 5], parts: 6, degree: 20, change: 5e-4 };

    /// With all moments, and more of the rest.
    pub const MIDDLE: Self = Self { levels: 14, suns: 36, zeniths: [8, 4, 6], parts: 8, degree: 24, change: 3e-4 };

    /// With the directions of [`Resolution::FINE`].
    pub const GOOD: Self = Self { levels: 18, suns: 36, zeniths: [10, 6, 8], parts: 8, degree: 24, change: 2e-4 };

    /// With its suns, too. It has few levels for haze with a sharp end, an error that it shares with [`Resolution::RENDER`]: tables that state their
    /// error go on to [`Resolution::FINE`] instead.
    pub const BETTER: Self = Self { levels: 24, suns: 48, zeniths: [10, 6, 8], parts: 8, degree: 24, change: 2e-4 };

    /// Finer than [`Resolution::FINE`] in everything: what the others are judged by.
    pub const FINEST: Self = Self { levels: 40, suns: 64, zeniths: [12, 7, 9], parts: 12, degree: 24, change: 1e-4 };

    /// Where phase functions have peaks: higher moments want closer directions, layers more levels.
    fn about(self, moments: &Moments) -> Self {
        if moments.degree() <= 2 {
            return self;
        }
        Self { levels: self.levels + 4, zeniths: self.zeniths.map(|n| n + n / 2), ..self }
    }
}

/// Solved tables of an atmosphere, as fine as an error asks for.
#[derive(Debug)]
pub struct Tables<const L: usize> {
    /// The finest.
    pub solved: Solved<L>,
    /// The next coarser, from which the error of the finest follows.
    coarser: Solved<L>,
    /// What the two do not show, of each wavelength: always, and besides with a low sun.
    hidden: [[f64; L]; 2],
}

/// What [`Resolution::RENDER`] and the one below it leave out alike where phase functions have peaks, moments beyond the last: something
/// always, a share of what particles scatter there ([`Optics::beyond_moments`]), as much again with a low sun, when it is a bright band at the
/// horizon; and a share of what goes straight on where most light does ([`Optics::in_peaks`]). By certificates (`airlight study solved-suns`).
const HIDDEN: f64 = 2e-3;
const HIDDEN_OF_PARTICLES: f64 = 1.7e-2;
const HIDDEN_IN_PEAKS: f64 = 3e-3;

/// How much of the first two [`Resolution::FINE`] and [`Resolution::FINEST`] still hide.
const FINE_HIDES: f64 = 1.0 / 3.0;
const FINEST_HIDES: f64 = 1.0 / 6.0;

/// Errors that ask for [`Resolution::FINEST`], whose cost few are worth.
const FINEST_BELOW: f64 = 3e-3;

/// How low a sun is that shows the band at the horizon, 0 to 1: elevations in degrees at which it begins, is whole from and to, and ends. (In
/// twilight grids differ by more than moments hide.)
fn lowness(from: Place, sun: DVec3) -> f64 {
    const ELEVATIONS: [f64; 4] = [14.0, 6.0, -2.0, -4.0];
    let [begins, from_here, to_here, ends] = ELEVATIONS;
    let elevation = from.up.dot(sun).clamp(-1.0, 1.0).asin().to_degrees();
    ((begins - elevation) / (begins - from_here)).clamp(0.0, 1.0)
        * ((elevation - ends) / (to_here - ends)).clamp(0.0, 1.0)
}

impl<const L: usize> Tables<L> {
    /// Solves for `air` (medium, form of the planet, albedo of the ground; whether of polarised light or of radiance alone) on finer grids
    /// until the table states at most this error for an observer, a sun and the directions of a picture ([`Tables::error`]), or there is
    /// none finer; the finest is taken for errors below 0.3 % alone. `kept` as in [`Solved::kept`].
    ///
    /// # Errors
    /// As [`Solved::kept`].
    pub fn within(
        error: f64,
        (from, sun, looks): (Place, DVec3, &[DVec3]),
        air: (&Medium<L>, Shape, [f64; L], bool),
        kept: Option<&Path>,
    ) -> Result<Self, SolveError> {
        covers_planet(air.1)?;
        let coarser = Solved::of(air, &Resolution::COARSE, kept)?;
        let solved = coarser.again(&Resolution::RENDER, kept)?;
        let hidden = solved.optics.hidden(1.0);
        let usual = Self { solved, coarser, hidden };
        if usual.error(from, sun, looks) <= error {
            return Ok(usual.settled());
        }
        let solved = Solved::begun(air, &Resolution::FINE, Some(&usual.solved), kept)?;
        let hidden = solved.optics.hidden(FINE_HIDES);
        let fine = Self { solved, coarser: usual.solved, hidden };
        // A low sun may ask for more than any grid has: the finest is for those that ask for what moments hide.
        if error > FINEST_BELOW || fine.error(from, sun, looks) <= error {
            return Ok(fine.settled());
        }
        let solved = Solved::begun(air, &Resolution::FINEST, Some(&fine.solved), kept)?;
        let hidden = solved.optics.hidden(FINEST_HIDES);
        Ok(Self { solved, coarser: fine.solved, hidden }.settled())
    }

    /// With nothing kept from which others would begin.
    fn settled(mut self) -> Self {
        (self.solved.first, self.coarser.first) = (None, None);
        self
    }

    /// What the table states: how far it is off at an observer with the sun in that unit direction, rms over the wavelengths and the
    /// directions looked in; all about the observer if there are none ([`Solved::difference`]).
    #[must_use]
    pub fn error(&self, from: Place, sun: DVec3, looks: &[DVec3]) -> f64 {
        mean_square(&self.errors(from, sun, looks)).sqrt()
    }

    /// As [`Tables::error`], of each wavelength.
    #[must_use]
    pub fn errors(&self, from: Place, sun: DVec3, looks: &[DVec3]) -> [f64; L] {
        let off = self.solved.differences(&self.coarser, from, sun, looks);
        let ([always, besides], low) = (self.hidden, lowness(from, sun));
        std::array::from_fn(|j| (FINER * off[j]).hypot(always[j] + low * besides[j]))
    }
}

/// What a solution is off, of what it differs from one on the next coarser grid: that is off by two to four times as much.
pub const FINER: f64 = 0.5;

/// Why planes are refused.
const ROUND: &str = "solved tables need a round planet: take --method paths";

/// Radii in m of the planets whose tables are as exact as those of the Earth: suns are crowded where they set, over an angle that
/// goes as the root of the height of the air over the radius, which must be neither all of the sky nor next to none of it.
const LEAST_RADIUS_M: f64 = 3e5;
const MOST_RADIUS_M: f64 = 1e8;

/// Why other radii are refused.
const RADII: &str = "solved tables are of planets with radii from 300 to 100 000 km: take --method paths";

/// Whether solved tables state their errors honestly over a planet of that form (`airlight study stability`, planets-solved).
///
/// # Errors
/// [`SolveError::Refused`] with the radii, or of a plane.
pub fn covers_planet(shape: Shape) -> Result<(), SolveError> {
    match shape {
        Shape::Flat => Err(SolveError::Refused(ROUND)),
        Shape::Sphere { radius_m } if (LEAST_RADIUS_M..=MOST_RADIUS_M).contains(&radius_m) => Ok(()),
        Shape::Sphere { .. } => Err(SolveError::Refused(RADII)),
    }
}

/// Why a resolution is refused.
const SIZES: &str = "a solved table has at least 4 levels, 4 suns and 1 step between levels, and degrees up to 24";

impl<const L: usize> Solved<L> {
    /// Solves for `medium` over a planet of that shape whose ground has the Lambertian `albedo`.
    ///
    /// # Errors
    /// [`SolveError::Refused`] between planes, or of a resolution that is too small or has too high a degree.
    pub fn new(
        medium: &Medium<L>,
        shape: Shape,
        albedo: [f64; L],
        resolution: &Resolution,
    ) -> Result<Self, SolveError> {
        Self::kept(medium, shape, albedo, resolution, None)
    }

    /// As [`Solved::new`], of polarised light: exact for molecules; of what other scatterers make of light that was scattered before, Q and
    /// U are kept to degree 2 (docs/solver.md).
    ///
    /// # Errors
    /// As [`Solved::new`].
    pub fn polarised(
        medium: &Medium<L>,
        shape: Shape,
        albedo: [f64; L],
        resolution: &Resolution,
    ) -> Result<Self, SolveError> {
        Self::of((medium, shape, albedo, true), resolution, None)
    }

    /// As [`Solved::new`], but the table is taken from the folder `kept` if it is there, by a checksum of all that it depends on, and
    /// written to it if it is not.
    ///
    /// # Errors
    /// As [`Solved::new`], and [`SolveError::Kept`].
    pub fn kept(
        medium: &Medium<L>,
        shape: Shape,
        albedo: [f64; L],
        resolution: &Resolution,
        kept: Option<&Path>,
    ) -> Result<Self, SolveError> {
        Self::of((medium, shape, albedo, false), resolution, kept)
    }

    /// As [`Solved::kept`], of polarised light or of radiance alone.
    ///
    /// # Errors
    /// As [`Solved::kept`].
    pub fn of(
        air: (&Medium<L>, Shape, [f64; L], bool),
        resolution: &Resolution,
        kept: Option<&Path>,
    ) -> Result<Self, SolveError> {
        Self::begun(air, resolution, None, kept)
    }

    /// As [`Solved::of`], beginning at the field of another solution.
    fn begun(
        (medium, shape, albedo, polarised): (&Medium<L>, Shape, [f64; L], bool),
        resolution: &Resolution,
        from: Option<&Self>,
        kept: Option<&Path>,
    ) -> Result<Self, SolveError> {
        let Shape::Sphere { radius_m } = shape else { return Err(SolveError::Refused(ROUND)) };
        if resolution.levels < 4 || resolution.suns < 4 || resolution.parts < 1 || resolution.degree > MOST_DEGREE {
            return Err(SolveError::Refused(SIZES));
        }
        let degree = species::degree_of(medium, resolution.degree);
        let (species, medium) = species::scaled(medium, degree)?;
        let columns = Columns::new(&medium, shape, Tolerance::SOLVE);
        let aureole = Aureole::new(&species, &medium, shape)?;
        let onward = if polarised { Onward::new(&species, &medium, shape)? } else { Onward::none() };
        let moments = Moments::new(degree, polarised);
        let optics = Optics { moments, species, medium, columns, aureole, onward, albedo };
        Self::with(Arc::new(optics), radius_m, resolution, from, kept)
    }

    /// The first order alone, with nothing cut off the phase functions: only [`Solved::radiance`] with `single` is of use.
    ///
    /// # Errors
    /// As [`Solved::new`].
    pub fn single(medium: &Medium<L>, shape: Shape, albedo: [f64; L]) -> Result<Self, SolveError> {
        let Shape::Sphere { radius_m } = shape else { return Err(SolveError::Refused(ROUND)) };
        let (medium, columns) = (medium.clone(), Columns::new(medium, shape, Tolerance::RENDER));
        let grid = Grid::new(&medium, radius_m, &Resolution::FINE);
        let species = species::whole(&medium);
        let (moments, aureole) = (Moments::new(2, false), Aureole::none());
        let onward = Onward::none();
        let optics = Optics { moments, species, medium, columns, aureole, onward, albedo };
        let field = Field { moments: Vec::new(), ground: Vec::new() };
        let resolutions = vec![Resolution::FINE];
        Ok(Self { optics: Arc::new(optics), grid, field, first: None, orders: 1, residual: 0.0, resolutions })
    }

    fn with(
        optics: Arc<Optics<L>>,
        radius: f64,
        resolution: &Resolution,
        from: Option<&Self>,
        kept: Option<&Path>,
    ) -> Result<Self, SolveError> {
        let fine = resolution.about(&optics.moments);
        let grid = Grid::new(&optics.medium, radius, &fine);
        let solve = || {
            let (solution, first) = Setup { grid: &grid, optics: &optics }.solve(&fine, from);
            (solution, Some(first))
        };
        let mut resolutions = from.map_or_else(Vec::new, |from| from.resolutions.clone());
        resolutions.push(*resolution);
        let ((field, orders, residual), first) = match kept {
            None => solve(),
            Some(folder) => {
                let (key, moments) = (file::key(&optics, radius, &resolutions), optics.moments.count());
                let path = file::path(folder, &key);
                if path.exists() {
                    let solution = file::solution(&tables::file::read(&path)?, &grid, moments, &key);
                    (solution.map_err(|error| error.at(&path))?, None)
                } else {
                    let solution = solve();
                    tables::file::write(&path, &file::table(&solution.0, &grid, moments, &key)?)?;
                    solution
                }
            }
        };
        Ok(Self { optics, grid, field, first, orders, residual, resolutions })
    }

    /// The same atmosphere solved again, with as many moments, on another grid, beginning at this field; or taken from a folder as by [`Solved::kept`].
    ///
    /// # Errors
    /// [`SolveError::Kept`], which is none without a folder.
    pub fn again(&self, resolution: &Resolution, kept: Option<&Path>) -> Result<Self, SolveError> {
        Self::with(Arc::clone(&self.optics), self.grid.radius, resolution, Some(self), kept)
    }

    /// Root mean square over 64 directions and all wavelengths of the difference to the radiances of another solution of the same
    /// atmosphere, over the lesser of their means at the wavelength, at an observer with the sun in that unit direction; of the directions in
    /// which the planet lies if the observer is above its air. 0 where both are dark, infinite where one is.
    #[must_use]
    pub fn difference(&self, other: &Self, from: Place, sun: DVec3) -> f64 {
        mean_square(&self.differences(other, from, sun, &[])).sqrt()
    }

    /// As [`Solved::difference`], of each wavelength, in certain directions if there are any.
    fn differences(&self, other: &Self, from: Place, sun: DVec3, looks: &[DVec3]) -> [f64; L] {
        let (mut squares, mut means) = ([0.0; L], [[0.0; L]; 2]);
        let shape = Shape::Sphere { radius_m: self.grid.radius };
        let around: Vec<DVec3>;
        let looks = if looks.is_empty() {
            around = directions(from, shape, self.optics.medium.top_m()).collect();
            &around
        } else {
            looks
        };
        for &direction in looks {
            let [a, b] = [self, other].map(|solved| solved.radiance(from, direction, sun, false));
            for j in 0..L {
                squares[j] += (a[j] - b[j]).powi(2) / looks.len() as f64;
                means[0][j] += a[j] / looks.len() as f64;
                means[1][j] += b[j] / looks.len() as f64;
            }
        }
        std::array::from_fn(|j| {
            let mean = means[0][j].min(means[1][j]);
            // Nothing is off where both are dark; where only one is, or cubics swing below zero, nothing is known.
            if squares[j] == 0.0 {
                0.0
            } else if mean > 0.0 {
                squares[j].sqrt() / mean
            } else {
                f64::INFINITY
            }
        })
    }

    /// Orders of scattering that were computed, and the relative change that the last of them made.
    #[must_use]
    pub fn convergence(&self) -> (usize, f64) {
        (self.orders, self.residual)
    }

    /// Whether it is of polarised light.
    #[must_use]
    pub fn is_polarised(&self) -> bool {
        self.optics.moments.polarised()
    }

    /// Bytes of the moments.
    #[must_use]
    pub fn bytes(&self) -> usize {
        4 * L * (self.field.moments.len() + self.field.ground.len())
    }
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>() / values.len() as f64
}
