//! Certificates: radiance without bias by Monte Carlo, with a solved table as the tail of every path.
//!
//! Let S_1 be sunlight scattered once at a place, S_2 = K T (S_1 + S_2) what the place scatters of all other light (T carries
//! sources along lines, K scatters), and S any guess at S_2: the table's, to the degree that sources.rs has. Then
//!
//! L = T S_1 + T K T (S_1 + S) + T K T D,  D = S_2 - S = [K T (S_1 + S) - S] + K T D.
//!
//! T S_1 is a quadrature. T K T (S_1 + S) is a mean over points of the line of sight, directions and distances (a *fan*),
//! a smooth integrand that low-discrepancy points do well; and D at some points of it is estimated in the same way: a fan of
//! directions and distances less what the table says, and D at one point of that. D is small where the guess is good, and the
//! mean does not depend on whether it is.
//!
//! Where phase functions have a peak the table's air is one in which the share f of scattered light goes straight on (delta-M).
//! That equation can be kept exact: with the extinction k - f k_s the light L scattered otherwise is
//! K L = k_s int P L d omega - f k_s L, a fan with a straight ray of negative weight; and sunlight, which reaches
//! a place with the extinction k, is scattered there by k_s P, so that S is the table's moments and
//! k_s P (e^-tau' - e^-tau), tau' the depth without f k_s.
//!
//! Polarised light obeys the same equations with vectors for L, S_1 and S and matrices of scattering for P, f k_s L with all
//! Stokes parameters. A weight is then what the observer sees of light at the end of a path, three rows of a Mueller matrix
//! ([`crate::polarisation::Analyser`]). V is followed; the table's is 0. The equation is the exact one, also where the table has
//! another: of the Q and U of particles it is asked for the source of degree 2, and what it takes for not scattered
//! (onward.rs) is in D.

use super::Solved;
use super::fan::Estimate;
use super::guide::{Bins, DIRECTIONS, Guide, Way};
use super::sources::{self, Sources};
use super::species::Species;
use super::tabled::Tabled;
use crate::atmosphere::{Chord, Columns, Tolerance};
use crate::geometry::{Place, Shape};
use crate::polarisation::{Frame, Stokes};
use crate::sampling::spiral;
use crate::transport::radiation::{Polarised, Scalar};
use crate::vectors::vectorised;
use glam::DVec3;

/// How many points a fan has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Fan {
    /// Of the line of sight: points, each with a direction and a distance.
    pub first: u32,
    /// At how many of them the table's error is looked for.
    pub kept: u32,
    /// Directions and distances at each of those, and at every further place.
    pub further: u32,
}

impl Fan {
    /// What is taken for pictures of air with particles: the error of equal work is least.
    pub const USUAL: Self = Self { first: 512, kept: 2, further: 256 };

    /// What is taken for pictures of molecules alone, whose phase function is smooth: there one fan of low-discrepancy points has less noise
    /// than two of half as many.
    pub const SMOOTH: Self = Self { first: 1024, kept: 2, further: 512 };

    /// What is taken where little is asked of a few directions.
    pub const SMALL: Self = Self { first: 128, kept: 2, further: 64 };
}

/// Bins of the line of sight: so many that hardly any straddles the end of a layer.
const SIGHT: usize = 256;

/// A certificate of a solved table for an observer and a sun.
#[derive(Debug)]
pub struct Certificate<'a, const L: usize> {
    pub(super) solved: &'a Solved<L>,
    /// The table cut to the moments of S, where it has more.
    fewer: Option<Solved<L>>,
    truth: Columns<L>,
    /// Columns of the table's air, where that is not the true one.
    scaled: Option<Columns<L>>,
    pub(super) from: Place,
    pub(super) sun: DVec3,
    pub(super) guide: Guide,
}

/// What is seen in a direction, without bias.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Certified<const L: usize> {
    /// Mean in sr^-1 per unit solar irradiance.
    pub mean: [f64; L],
    /// Its variance.
    pub variance: [f64; L],
}

/// A line of sight, prepared.
pub(super) struct View<'c, R: Tabled, const L: usize> {
    pub(super) sources: Sources<'c, L>,
    pub(super) chord: Chord<'c, L>,
    pub(super) direction: DVec3,
    pub(super) frame: R::Frame,
    pub(super) way: Way,
    pub(super) bins: Bins<SIGHT>,
    /// Densities of the light that is scattered into the line of sight, for each entry of the guide that is met along it.
    pub(super) onto: Vec<(usize, Bins<DIRECTIONS>)>,
    /// Of light that is reflected into it, where it ends on a ground that reflects.
    pub(super) foot: Option<Bins<DIRECTIONS>>,
    /// Probability of the ground.
    pub(super) ground: f64,
    /// What the table says is seen.
    pub(super) norm: [f64; L],
    single: [R::Seen; L],
}

impl<'a, const L: usize> Certificate<'a, L> {
    /// For an observer at `from` with the sun, a parallel beam, in the unit direction `sun`. `columns` are those of the medium for which
    /// the table was solved, with nothing cut off.
    #[must_use]
    pub fn new(solved: &'a Solved<L>, columns: Columns<L>, from: Place, sun: DVec3) -> Self {
        let whole = solved.optics.species.iter().all(|one| one.whole.iter().all(|&whole| whole == 1.0));
        let shape = Shape::Sphere { radius_m: solved.grid.radius };
        let scaled = (!whole).then(|| Columns::new(&solved.optics.medium, shape, Tolerance::RENDER));
        // What counts is light as a share of what is seen: the table's mean over all directions.
        const DIRECTIONS: u32 = 32;
        let mut norm = [1e-30; L];
        for i in 0..DIRECTIONS {
            let radiance = solved.radiance(from, spiral(i, DIRECTIONS, [-1.0, 1.0]), sun, false);
            for j in 0..L {
                norm[j] += radiance[j] / f64::from(DIRECTIONS);
            }
        }
        let fewer = solved.up_to(sources::DEGREE);
        let tail = fewer.as_ref().unwrap_or(solved);
        let guide = Guide::new(&Sources { solved: tail, truth: &columns, scaled: scaled.as_ref() }, from, sun, &norm);
        Self { solved, fewer, truth: columns, scaled, from, sun, guide }
    }

    /// The fans of which equal work leaves the least error in pictures.
    #[must_use]
    pub fn fan(&self) -> Fan {
        if self.solved.optics.species.iter().all(Species::is_molecular) { Fan::SMOOTH } else { Fan::USUAL }
    }

    fn sources(&self) -> Sources<'_, L> {
        let solved = self.fewer.as_ref().unwrap_or(self.solved);
        Sources { solved, truth: &self.truth, scaled: self.scaled.as_ref() }
    }

    /// Where the observer is, and the direction to the sun.
    #[must_use]
    pub fn observer(&self) -> (Place, DVec3) {
        (self.from, self.sun)
    }

    /// Radiance by scalar transfer out of the unit `direction`: the mean of `fans` independent fans, at least 2, and its variance.
    #[must_use]
    pub fn radiance(&self, direction: DVec3, fan: Fan, fans: u32, seed: u64, pixel: u64) -> Certified<L> {
        let [certified] = self.means::<Scalar, 1>((direction, ()), |radiance| [*radiance], (fan, fans), (seed, pixel));
        certified
    }

    /// As [`Certificate::radiance`], by polarised transfer: each of `of`, which are linear in the Stokes parameters of light referred to
    /// `frame`, one of `direction`. Phase functions without a matrix count as depolarising. `None` if the table was solved without
    /// polarisation.
    #[must_use]
    pub fn stokes<const N: usize>(
        &self,
        look: (DVec3, Frame),
        of: impl Fn(&Stokes) -> [f64; N],
        fans: (Fan, u32),
        random: (u64, u64),
    ) -> Option<[Certified<L>; N]> {
        self.solved.is_polarised().then(|| self.means::<Polarised, N>(look, of, fans, random))
    }

    fn means<R: Tabled, const N: usize>(
        &self,
        look: (DVec3, R::Frame),
        of: impl Fn(&R::Seen) -> [f64; N],
        (fan, fans): (Fan, u32),
        (seed, pixel): (u64, u64),
    ) -> [Certified<L>; N] {
        let mut all = [Certified { mean: [0.0; L], variance: [0.0; L] }; N];
        let Some(view) = self.view::<R>(look) else { return all };
        for number in 0..fans {
            let value = vectorised::<L, _>(Estimate { certificate: self, view: &view, fan, seed, pixel, number });
            for j in 0..L {
                for (Certified { mean, variance: squares }, value) in all.iter_mut().zip(of(&value[j])) {
                    let off = value - mean[j];
                    mean[j] += off / f64::from(number + 1);
                    squares[j] += off * (value - mean[j]);
                }
            }
        }
        let n = f64::from(fans.max(2));
        for j in 0..L {
            for (one, single) in all.iter_mut().zip(of(&view.single[j])) {
                one.mean[j] += single;
                one.variance[j] /= n * (n - 1.0);
            }
        }
        all
    }

    fn view<R: Tabled>(&self, (direction, frame): (DVec3, R::Frame)) -> Option<View<'_, R, L>> {
        let sources = self.sources();
        let chord = sources.columns().chord(self.from, direction)?;
        let norm = self.solved.radiance(self.from, direction, self.sun, false).map(|light| light.max(1e-30));
        let way = Way::new(&chord, self.solved.grid.radius);
        let counts = |light: [f64; L]| -> f64 { (0..L).map(|j| (light[j] / norm[j]).powi(2)).sum::<f64>().sqrt() };
        let (mut harmonics, mut onto) = (Vec::new(), Vec::<(usize, Bins<DIRECTIONS>)>::new());
        let masses: [f64; SIGHT] = std::array::from_fn(|i| {
            let (s, stretch) = way.at(&chord, (i as f64 + 0.5) / SIGHT as f64);
            let through = chord.point(s).depth.map(|depth| (-depth).exp());
            let place = chord.place(self.from, direction, s);
            let source = sources.air::<Scalar>(place, (direction, ()), self.sun, &mut harmonics);
            let local = self.guide.at(self.solved, place, self.sun);
            if onto.iter().all(|&(entry, _)| entry != local.entry) {
                let scattering = sources.scattering(place.altitude_m);
                onto.push((local.entry, self.guide.scattered(&local, &scattering, direction)));
            }
            counts(std::array::from_fn(|j| through[j] * source.tail[j] * stretch))
        });
        let (mut ground, mut foot) = (0.0, None);
        if chord.ends_on_ground() && self.solved.optics.albedo.iter().any(|&albedo| albedo > 0.0) {
            let place = chord.foot(self.from, direction);
            let source = sources.ground::<Scalar>(place, self.sun);
            let local = self.guide.at(self.solved, place, self.sun);
            foot = Some(local.reflected());
            let total = chord.total();
            let seen = counts(std::array::from_fn(|j| (-total[j]).exp() * source.tail[j]));
            let air = masses.iter().sum::<f64>() / SIGHT as f64;
            ground = (seen / (seen + air).max(1e-300)).clamp(0.05, 0.95);
        }
        let single = R::single(self.solved, self.from, (direction, frame), self.sun, &self.truth);
        Some(View { chord, direction, frame, way, bins: Bins::new(masses), onto, foot, ground, norm, single, sources })
    }
}
