//! What of light is followed: its radiance alone, or its Stokes parameters. The tracers are written once, for either.

use crate::phase::Phase;
use crate::polarisation::{Analyser, Frame, Natural, Scattering, Stokes, Turn};
use glam::DVec3;
use std::ops::{Add, AddAssign, Mul};

/// Numbers that are added and multiplied by numbers: coefficients of scattering of a mixture.
pub(super) trait Linear: Copy + Default + Add<Output = Self> + Mul<f64, Output = Self> {
    /// The part that makes natural light of natural light: a phase function.
    fn intensity(self) -> f64;
}

impl Linear for f64 {
    #[inline(always)]
    fn intensity(self) -> f64 {
        self
    }
}

impl Linear for Natural {
    #[inline(always)]
    fn intensity(self) -> f64 {
        self.a1
    }
}

impl Linear for Scattering {
    #[inline(always)]
    fn intensity(self) -> f64 {
        self.a1
    }
}

/// A way of following light backwards from the observer.
pub(super) trait Radiation {
    /// What the observer sees at one wavelength.
    type Seen: Copy + Default + AddAssign;
    /// What the observer would see of light at the present end of a path.
    type Contribution: Copy + Mul<f64, Output = Self::Contribution>;
    /// What the contribution refers to.
    type Frame: Copy;
    /// From one frame to that of a plane of scattering.
    type Turn: Copy;
    /// What scattering does.
    type Matrix: Linear;
    /// What scattering does to natural light.
    type Natural: Linear;

    /// The contribution at the observer.
    const OBSERVER: Self::Contribution;

    fn matrices<const L: usize>(phase: &Phase<L>, cosine: f64) -> [Self::Matrix; L];
    fn natural<const L: usize>(phase: &Phase<L>, cosine: f64) -> [Self::Natural; L];
    /// The plane of scattering of light out of `before` into `direction`, to which `frame` belongs.
    fn plane(frame: Self::Frame, direction: DVec3, before: DVec3) -> (Self::Turn, Self::Frame);
    /// The part of natural light that is seen as radiance: at least the part that is seen as anything else.
    fn intensity(contribution: &Self::Contribution) -> f64;
    /// The contribution before a scattering by `matrix` over `density`.
    fn scattered(
        contribution: &Self::Contribution,
        turn: Self::Turn,
        matrix: &Self::Matrix,
        density: f64,
    ) -> Self::Contribution;
    /// The contribution before a reflection by the ground.
    fn reflected(contribution: &Self::Contribution, albedo: f64) -> Self::Contribution;
    /// What is seen of natural light.
    fn see(contribution: &Self::Contribution, light: f64) -> Self::Seen;
    /// What is seen of natural light that was scattered once.
    fn see_scattered(
        contribution: &Self::Contribution,
        turn: Self::Turn,
        scattered: Self::Natural,
        light: f64,
    ) -> Self::Seen;
}

/// Radiance alone: phase functions for matrices of scattering.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scalar;

impl Radiation for Scalar {
    type Seen = f64;
    type Contribution = f64;
    type Frame = ();
    type Turn = ();
    type Matrix = f64;
    type Natural = f64;

    const OBSERVER: f64 = 1.0;

    #[inline(always)]
    fn matrices<const L: usize>(phase: &Phase<L>, cosine: f64) -> [f64; L] {
        phase.values(cosine)
    }

    #[inline(always)]
    fn natural<const L: usize>(phase: &Phase<L>, cosine: f64) -> [f64; L] {
        phase.values(cosine)
    }

    #[inline(always)]
    fn plane((): (), _: DVec3, _: DVec3) -> ((), ()) {
        ((), ())
    }

    #[inline(always)]
    fn intensity(contribution: &f64) -> f64 {
        *contribution
    }

    #[inline(always)]
    fn scattered(contribution: &f64, (): (), matrix: &f64, density: f64) -> f64 {
        contribution * (matrix / density)
    }

    #[inline(always)]
    fn reflected(contribution: &f64, albedo: f64) -> f64 {
        contribution * albedo
    }

    #[inline(always)]
    fn see(contribution: &f64, light: f64) -> f64 {
        contribution * light
    }

    #[inline(always)]
    fn see_scattered(contribution: &f64, (): (), scattered: f64, light: f64) -> f64 {
        contribution * (scattered * light)
    }
}

/// Stokes parameters.
#[derive(Debug, Clone, Copy)]
pub(super) struct Polarised;

impl Radiation for Polarised {
    type Seen = Stokes;
    type Contribution = Analyser;
    type Frame = Frame;
    type Turn = Turn;
    type Matrix = Scattering;
    type Natural = Natural;

    const OBSERVER: Analyser = Analyser::OBSERVER;

    #[inline(always)]
    fn matrices<const L: usize>(phase: &Phase<L>, cosine: f64) -> [Scattering; L] {
        phase.matrices(cosine)
    }

    #[inline(always)]
    fn natural<const L: usize>(phase: &Phase<L>, cosine: f64) -> [Natural; L] {
        phase.natural(cosine)
    }

    #[inline(always)]
    fn plane(frame: Frame, direction: DVec3, before: DVec3) -> (Turn, Frame) {
        frame.of_scattering(direction, before)
    }

    #[inline(always)]
    fn intensity(contribution: &Analyser) -> f64 {
        contribution.intensity()
    }

    #[inline(always)]
    fn scattered(contribution: &Analyser, turn: Turn, matrix: &Scattering, density: f64) -> Analyser {
        contribution.scattered(turn, &(*matrix * density.recip()))
    }

    #[inline(always)]
    fn reflected(contribution: &Analyser, albedo: f64) -> Analyser {
        contribution.reflected(albedo)
    }

    #[inline(always)]
    fn see(contribution: &Analyser, light: f64) -> Stokes {
        contribution.natural(light)
    }

    #[inline(always)]
    fn see_scattered(contribution: &Analyser, turn: Turn, scattered: Natural, light: f64) -> Stokes {
        contribution.once_scattered(turn, scattered, light)
    }
}

/// Radiance alone and Stokes parameters along the same paths: where the two are alike their noise is too, so that their
/// difference is known better than either.
pub(super) struct Both;

/// What is seen of light in scalar and in polarised transfer.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Pair {
    /// Radiance by scalar transfer.
    pub scalar: f64,
    /// Its Stokes parameters by polarised transfer.
    pub stokes: Stokes,
}

impl AddAssign for Pair {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        self.scalar += other.scalar;
        self.stokes += other.stokes;
    }
}

/// Contributions in scalar and in polarised transfer.
#[derive(Clone, Copy)]
pub(super) struct Contributions(f64, Analyser);

impl Mul<f64> for Contributions {
    type Output = Self;
    #[inline(always)]
    fn mul(self, factor: f64) -> Self {
        Self(self.0 * factor, self.1 * factor)
    }
}

impl Radiation for Both {
    type Seen = Pair;
    type Contribution = Contributions;
    type Frame = Frame;
    type Turn = Turn;
    type Matrix = Scattering;
    type Natural = Natural;

    const OBSERVER: Contributions = Contributions(Scalar::OBSERVER, Polarised::OBSERVER);

    #[inline(always)]
    fn matrices<const L: usize>(phase: &Phase<L>, cosine: f64) -> [Scattering; L] {
        Polarised::matrices(phase, cosine)
    }

    #[inline(always)]
    fn natural<const L: usize>(phase: &Phase<L>, cosine: f64) -> [Natural; L] {
        Polarised::natural(phase, cosine)
    }

    #[inline(always)]
    fn plane(frame: Frame, direction: DVec3, before: DVec3) -> (Turn, Frame) {
        Polarised::plane(frame, direction, before)
    }

    /// The larger of the two: no path ends that either would have gone on with.
    #[inline(always)]
    fn intensity(Contributions(scalar, analyser): &Contributions) -> f64 {
        scalar.max(analyser.intensity())
    }

    #[inline(always)]
    fn scattered(
        Contributions(scalar, analyser): &Contributions,
        turn: Turn,
        matrix: &Scattering,
        density: f64,
    ) -> Contributions {
        Contributions(
            Scalar::scattered(scalar, (), &matrix.a1, density),
            Polarised::scattered(analyser, turn, matrix, density),
        )
    }

    #[inline(always)]
    fn reflected(Contributions(scalar, analyser): &Contributions, albedo: f64) -> Contributions {
        Contributions(Scalar::reflected(scalar, albedo), Polarised::reflected(analyser, albedo))
    }

    #[inline(always)]
    fn see(Contributions(scalar, analyser): &Contributions, light: f64) -> Pair {
        Pair { scalar: Scalar::see(scalar, light), stokes: Polarised::see(analyser, light) }
    }

    #[inline(always)]
    fn see_scattered(
        Contributions(scalar, analyser): &Contributions,
        turn: Turn,
        scattered: Natural,
        light: f64,
    ) -> Pair {
        Pair {
            scalar: Scalar::see_scattered(scalar, (), scattered.a1, light),
            stokes: Polarised::see_scattered(analyser, turn, scattered, light),
        }
    }
}
