//! What a path carries from vertex to vertex.

/// After the first vertex a path lives on with this probability times its weight over the weight at the first
/// vertex, at most 1. The figure balances the variance of the later orders against their cost.
pub(super) const SURVIVAL: f64 = 4.0;

/// What a path carries: f_j and r_j of the module's head.
#[derive(Debug, Clone, Copy)]
pub(super) struct Carried<const L: usize> {
    contribution: [f64; L],
    density: [f64; L],
}

impl<const L: usize> Carried<L> {
    pub(super) fn new() -> Self {
        Self { contribution: [1.0; L], density: [1.0; L] }
    }

    /// Multiplies contribution and density by factors of each wavelength.
    pub(super) fn multiply(&mut self, contribution: impl Fn(usize) -> f64, density: impl Fn(usize) -> f64) {
        for j in 0..L {
            self.contribution[j] *= contribution(j);
            self.density[j] *= density(j);
        }
    }

    /// Multiplies both by the same factor: something was drawn exactly as light would have.
    pub(super) fn multiply_both(&mut self, factor: impl Fn(usize) -> f64) {
        for j in 0..L {
            let factor = factor(j);
            self.contribution[j] *= factor;
            self.density[j] *= factor;
        }
    }

    /// 1 / mean of r_k.
    fn balance(&self) -> f64 {
        L as f64 / self.density.iter().sum::<f64>()
    }

    /// Adds f_j / mean(r_k) times `light` to `sum`.
    pub(super) fn score(&self, sum: &mut [f64; L], light: impl Fn(usize) -> f64) {
        let balance = self.balance();
        for (j, sum) in sum.iter_mut().enumerate() {
            *sum += self.contribution[j] * balance * light(j);
        }
    }

    /// Largest weight of a wavelength.
    pub(super) fn weight(&self) -> f64 {
        self.balance() * self.contribution.iter().copied().fold(0.0, f64::max)
    }
}
