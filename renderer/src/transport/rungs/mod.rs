//! The ladder: every method that this renderer has, from exact and slow to cheap and rough, each with its source, what it leaves
//! out, and the range outside which it refuses.
//!
//! The upper rungs ([`Method::Judge`], [`Method::Paths`], [`Method::Solved`]) live beside this folder. Here are the lower ones, of
//! two kinds. Methods on Airlight's own atmosphere ([`Cheap`]) give the radiance factor at every wavelength: single scattering
//! ([`single`]), the isotropic closure of all further orders ([`isotropic`]), O'Neil's exponential planet ([`oneil`]). Fitted
//! skies ([`Dome`]) give a colour or a luminance alone, over the horizon alone: [`preetham`], [`hosek_wilkie`], [`cie`], [`perez`].
//! They are here to be compared with.

pub mod cie;
pub mod hosek_wilkie;
pub mod isotropic;
mod ladder;
mod march;
pub mod oneil;
pub mod perez;
pub mod preetham;
pub mod single;
mod stated;
#[cfg(test)]
mod tests;

pub use ladder::{Conditions, LADDER, Refusal, Rung};
pub use march::STEPS;
pub use stated::Stated;

use crate::atmosphere::Medium;
use crate::geometry::{Place, Shape};
use crate::transport::Method;
use glam::DVec3;
use isotropic::{Further, Isotropic};
use march::Air;
use oneil::Oneil;
use std::fmt::Debug;

/// A cheap method at `L` wavelengths.
#[derive(Debug)]
pub struct Cheap<const L: usize>(Kind<L>);

#[derive(Debug)]
enum Kind<const L: usize> {
    Single(Box<Air<L>>),
    Isotropic(Box<Isotropic<L>>),
    Oneil(Box<Oneil<L>>),
}

impl<const L: usize> Cheap<L> {
    /// Prepares `method` for an atmosphere over a ground of the Lambertian `albedo`, with that many points on each line of sight
    /// (the method's own number if `None`); none of a method that is no [`Cheap`].
    #[must_use]
    pub fn new(method: Method, medium: &Medium<L>, shape: Shape, albedo: [f64; L], steps: Option<u32>) -> Option<Self> {
        let air = || Air::new(medium, shape, albedo, steps.unwrap_or(STEPS));
        Some(Self(match method {
            Method::Single => Kind::Single(Box::new(air())),
            Method::Isotropic => Kind::Isotropic(Box::new(Isotropic::new(air()))),
            Method::Oneil => Kind::Oneil(Box::new(Oneil::new(medium, steps.unwrap_or(oneil::STEPS)))),
            _ => return None,
        }))
    }

    /// Radiance per unit solar irradiance (sr^-1) that arrives at `from` out of the unit `direction` (the direction looked in), of
    /// a parallel sun in the unit direction `sun`; without the sun itself.
    #[must_use]
    pub fn radiance(&self, from: Place, direction: DVec3, sun: DVec3) -> [f64; L] {
        match &self.0 {
            Kind::Single(air) => single::radiance(air, from, direction, sun),
            Kind::Isotropic(isotropic) => isotropic.radiance(from, direction, sun),
            Kind::Oneil(oneil) => oneil.radiance(from, direction, sun),
        }
    }

    /// What the method states of its own error at an observer with the sun in that unit direction; none of O'Neil's planet, which is another
    /// atmosphere. See [`Stated`].
    #[must_use]
    pub fn stated(&self, from: Place, sun: DVec3) -> Option<Stated> {
        match &self.0 {
            Kind::Single(air) => Some(Stated::of(air, &Further::new(air), from, sun)),
            Kind::Isotropic(isotropic) => Some(Stated::of(&isotropic.air, &isotropic.further, from, sun)),
            Kind::Oneil(_) => None,
        }
    }

    /// Bytes of its tables.
    #[must_use]
    pub fn bytes(&self) -> usize {
        match &self.0 {
            Kind::Single(air) => air.columns().bytes(),
            Kind::Isotropic(isotropic) => isotropic.bytes(),
            Kind::Oneil(_) => 0,
        }
    }
}

/// A fitted sky for one sun: a colour of every direction.
pub trait Dome: Debug + Send + Sync {
    /// CIE XYZ (1931, 2 degrees) that arrives out of the unit `direction`, of which z is the cosine of the zenith angle; Y is
    /// luminance in cd/m^2. Black below the horizon, of which fitted skies know nothing.
    fn xyz(&self, direction: DVec3) -> [f64; 3];
}

/// CIE XYZ of the white of D65, chromaticity (0.3127, 0.3290), of luminance 1: the colour of a sky that has only a luminance.
const WHITE: [f64; 3] = [0.3127 / 0.3290, 1.0, (1.0 - 0.3127 - 0.3290) / 0.3290];
