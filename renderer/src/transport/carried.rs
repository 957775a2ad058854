//! What a path carries from vertex to vertex.

use super::radiation::Radiation;
use glam::DVec3;

/// After the first vertex a path lives on with this probability times its weight over the weight at the first
/// vertex, at most 1. The figure balances the variance of the later orders against their cost.
pub(super) const SURVIVAL: f64 = 4.0;

/// What a path carries: f_j and r_j of the module's head, and the frame that f_j refers to.
pub(super) struct Carried<R: Radiation, const L: usize> {
    contribution: [R::Contribution; L],
    density: [f64; L],
    frame: R::Frame,
}

impl<R: Radiation, const L: usize> Carried<R, L> {
    pub(super) fn new(frame: R::Frame) -> Self {
        Self { contribution: [R::OBSERVER; L], density: [1.0; L], frame }
    }

    /// Multiplies contribution and density by factors of each wavelength.
    pub(super) fn multiply(&mut self, contribution: impl Fn(usize) -> f64, density: impl Fn(usize) -> f64) {
        for j in 0..L {
            self.contribution[j] = self.contribution[j] * contribution(j);
            self.density[j] *= density(j);
        }
    }

    /// Multiplies both by the same factor: something was drawn exactly as light would have.
    pub(super) fn multiply_both(&mut self, factor: impl Fn(usize) -> f64) {
        for j in 0..L {
            let factor = factor(j);
            self.contribution[j] = self.contribution[j] * factor;
            self.density[j] *= factor;
        }
    }

    /// A scattering of light out of `before` into `direction` by `matrices`, `before` drawn with `densities` of which the
    /// hero's is `drawn`.
    #[inline]
    pub(super) fn scatter(
        &mut self,
        direction: DVec3,
        before: DVec3,
        matrices: &[R::Matrix; L],
        densities: impl Fn(usize) -> f64,
        drawn: f64,
    ) {
        let (turn, frame) = R::plane(self.frame, direction, before);
        for j in 0..L {
            self.contribution[j] = R::scattered(&self.contribution[j], turn, &matrices[j], drawn);
            self.density[j] *= densities(j) / drawn;
        }
        self.frame = frame;
    }

    /// A reflection by a Lambertian ground: any frame is as good as another after it.
    #[inline]
    pub(super) fn reflect(&mut self, albedo: &[f64; L]) {
        for (contribution, &albedo) in self.contribution.iter_mut().zip(albedo) {
            *contribution = R::reflected(contribution, albedo);
        }
    }

    /// From the path's frame to the plane in which light out of `before` is scattered into `direction`.
    #[inline]
    pub(super) fn turn(&self, direction: DVec3, before: DVec3) -> R::Turn {
        R::plane(self.frame, direction, before).0
    }

    /// 1 / mean of r_k.
    fn balance(&self) -> f64 {
        self.balance_with(|_| 1.0)
    }

    /// As [`Carried::balance`], with factors of the densities.
    #[inline]
    fn balance_with(&self, factor: impl Fn(usize) -> f64) -> f64 {
        L as f64 / (0..L).map(|k| self.density[k] * factor(k)).sum::<f64>()
    }

    /// Adds f_j / mean(r_k) times natural `light` to `sum`.
    pub(super) fn score(&self, sum: &mut [R::Seen; L], light: impl Fn(usize) -> f64) {
        let balance = self.balance();
        for (j, sum) in sum.iter_mut().enumerate() {
            *sum += R::see(&self.contribution[j], balance * light(j));
        }
    }

    /// As [`Carried::score`], of natural `light` that was `scattered` once more, in the plane that `turn` leads to.
    #[inline]
    pub(super) fn score_scattered(
        &self,
        sum: &mut [R::Seen; L],
        turn: R::Turn,
        scattered: &[R::Natural; L],
        light: impl Fn(usize) -> f64,
    ) {
        self.score_drawn(sum, turn, scattered, light, |_| 1.0);
    }

    /// As [`Carried::score_scattered`], of a place drawn with a density of each wavelength over the hero's.
    #[inline]
    pub(super) fn score_drawn(
        &self,
        sum: &mut [R::Seen; L],
        turn: R::Turn,
        scattered: &[R::Natural; L],
        light: impl Fn(usize) -> f64,
        density: impl Fn(usize) -> f64,
    ) {
        let balance = self.balance_with(density);
        for (j, sum) in sum.iter_mut().enumerate() {
            *sum += R::see_scattered(&self.contribution[j], turn, scattered[j], balance * light(j));
        }
    }

    /// Largest weight of a wavelength.
    pub(super) fn weight(&self) -> f64 {
        self.balance() * self.contribution.iter().map(R::intensity).fold(0.0, f64::max)
    }
}
