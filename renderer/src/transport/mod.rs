//! Radiance along a ray: methods behind one interface, from exact and slow to
//! cheaper.
//!
//! Everything here is per unit solar irradiance, so a radiance is in sr^-1, and
//! carries `L` wavelengths at once. A path is drawn for one of them, the hero,
//! chosen at random; along the path f_j is the measurement contribution of
//! wavelength j over the density p_h of the path for the hero, and r_j = p_j / p_h
//! that path's density for wavelength j as hero. The estimate
//! f_j / mean_k(r_k)
//! is then the balance heuristic over all choices of the hero (Wilkie et al. 2014;
//! Miller, Georgiev & Jarosz 2019): unbiased at every wavelength, and finite
//! wherever some wavelength would have drawn the path.

mod carried;
mod judge;
mod paths;
mod radiation;
mod ratio;
pub mod rungs;
mod scatter;
mod solved;

use crate::atmosphere::{Columns, Medium};
use crate::geometry::{Place, Shape};
use crate::ground::Texture;
use crate::light::SunDisc;
use crate::polarisation::{Frame, Stokes};
use crate::sampling::{Sampler, spiral};
use glam::DVec3;
pub use radiation::Pair;
use radiation::{Both, Polarised, Radiation, Scalar};
pub use solved::{
    Certificate, Certified, FINER, Fan, Fineness, Panorama, Pixels, Resolution, SolveError, Solved, Tables, befitting,
    covers_planet,
};

use serde::{Deserialize, Serialize};

/// How radiance is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// From a solved table ([`Solved`]): without noise; for a uniform ground.
    Solved,
    /// By [`Estimator::Paths`].
    Paths,
    /// By [`Estimator::Judge`].
    Judge,
    /// Light scattered once ([`rungs::single`]).
    Single,
    /// With an isotropic closure of all further orders ([`rungs::isotropic`]).
    Isotropic,
    /// On O'Neil's exponential planet ([`rungs::oneil`]).
    Oneil,
    /// A fitted clear sky ([`rungs::preetham`]).
    Preetham,
    /// A fitted clear sky ([`rungs::hosek_wilkie`]).
    HosekWilkie,
    /// A standard sky ([`rungs::cie`]).
    Cie,
    /// An all-weather sky ([`rungs::perez`]).
    Perez,
}

impl Method {
    /// All of them, from exact to rough.
    pub const ALL: [Self; 10] = [
        Self::Judge,
        Self::Paths,
        Self::Solved,
        Self::Isotropic,
        Self::Single,
        Self::Oneil,
        Self::HosekWilkie,
        Self::Preetham,
        Self::Perez,
        Self::Cie,
    ];

    /// Its estimator; none for methods without noise.
    #[must_use]
    pub fn estimator(self) -> Option<Estimator> {
        match self {
            Self::Paths => Some(Estimator::Paths),
            Self::Judge => Some(Estimator::Judge),
            _ => None,
        }
    }

    /// Whether it is a fitted sky ([`rungs::Dome`]): a colour of each direction above the horizon, and no spectrum.
    #[must_use]
    pub fn is_dome(self) -> bool {
        matches!(self, Self::Preetham | Self::HosekWilkie | Self::Cie | Self::Perez)
    }
}

/// How radiance is estimated from random numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Estimator {
    /// The brute-force judge: analog free flights by delta tracking. Unbiased,
    /// with nothing clever in it; slow where the air is thin.
    Judge,
    /// Paths on column tables: flights by inversion, forced collisions, single scattering by quadrature. Unbiased but for the
    /// interpolation of the tables.
    Paths,
}

/// What light travels through.
#[derive(Debug)]
pub struct Problem<'a, const L: usize> {
    /// Form of the planet.
    pub shape: Shape,
    /// The atmosphere.
    pub medium: &'a Medium<L>,
    /// Its columns.
    pub columns: &'a Columns<L>,
    /// Lambertian albedo of the ground, 0 to 1; of a ground with a texture its mean.
    pub albedo: [f64; L],
    /// What the ground reflects at each of its places; `None` of a uniform one.
    pub texture: Option<&'a Texture<L>>,
    /// The sun, above the atmosphere, in the frame of the observer; `None` for none.
    pub sun: Option<&'a SunDisc<L>>,
    /// Radiance that enters from every direction of space, per unit solar
    /// irradiance (sr^-1); `None` for black space.
    pub environment: Option<[f64; L]>,
    /// The largest number of scatterings and reflections of a path, `None` for
    /// all. 1 is single scattering and light reflected by the ground straight to the eye.
    pub max_orders: Option<u32>,
}

impl<const L: usize> Problem<'_, L> {
    /// Albedo of the ground at a place of it.
    #[inline(always)]
    pub(crate) fn albedo_at(&self, foot: Place) -> [f64; L] {
        self.texture.map_or(self.albedo, |texture| texture.albedo(foot))
    }
}

/// One unbiased estimate of the radiance per unit solar irradiance (sr^-1) that arrives at
/// `from` out of the unit `direction` (the direction looked in), without the
/// solar disc itself. Equal streams give equal estimates.
#[must_use]
pub fn radiance<const L: usize>(
    estimator: Estimator,
    problem: &Problem<'_, L>,
    from: Place,
    direction: DVec3,
    sampler: &mut Sampler,
) -> [f64; L] {
    trace::<Scalar, L>(estimator, problem, from, (direction, ()), sampler)
}

/// As [`radiance`], its Stokes parameters in `frame`. Phase functions without a matrix count as depolarising: who wants none asks
/// [`Medium::polarises`] before.
#[must_use]
pub fn stokes<const L: usize>(
    estimator: Estimator,
    problem: &Problem<'_, L>,
    from: Place,
    direction: DVec3,
    frame: Frame,
    sampler: &mut Sampler,
) -> [Stokes; L] {
    trace::<Polarised, L>(estimator, problem, from, (direction, frame), sampler)
}

/// One unbiased estimate of the same by scalar transfer and of its Stokes parameters in `frame`, along one path: of the difference
/// that polarisation makes the noise is far less than that of either.
#[must_use]
pub fn both<const L: usize>(
    estimator: Estimator,
    problem: &Problem<'_, L>,
    from: Place,
    direction: DVec3,
    frame: Frame,
    sampler: &mut Sampler,
) -> [Pair; L] {
    trace::<Both, L>(estimator, problem, from, (direction, frame), sampler)
}

/// How many directions are looked in to tell how far a method is off.
const DIRECTIONS: u32 = 64;

/// Directions about an observer, even in solid angle: all around, or from above the air those in which it lies.
fn directions(from: Place, shape: Shape, top_m: f64) -> impl Iterator<Item = DVec3> {
    (0..DIRECTIONS).map(move |i| spiral(i, DIRECTIONS, [-1.0, highest(from, shape, top_m)]))
}

/// Cosine of the least zenith angle at which an observer sees air that ends at `top_m`.
pub(crate) fn highest(from: Place, shape: Shape, top_m: f64) -> f64 {
    match shape {
        Shape::Sphere { radius_m } if from.altitude_m > top_m => {
            let sine = (radius_m + top_m) / (radius_m + from.altitude_m);
            -((1.0 - sine) * (1.0 + sine)).sqrt()
        }
        _ => 1.0,
    }
}

fn trace<R: Radiation, const L: usize>(
    estimator: Estimator,
    problem: &Problem<'_, L>,
    from: Place,
    look: (DVec3, R::Frame),
    sampler: &mut Sampler,
) -> [R::Seen; L] {
    sampler.go_to(1);
    let hero = ((sampler.four()[0] * L as f64) as usize).min(L - 1);
    match estimator {
        Estimator::Judge => judge::trace::<R, L>(problem, from, look, hero, sampler),
        Estimator::Paths => paths::trace::<R, L>(problem, from, look, hero, sampler),
    }
}

#[cfg(test)]
mod tests;
