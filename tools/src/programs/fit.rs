//! Profiles of few numbers, for programs that know no others.

use super::{KM, Layered, Layers};

/// An exponential profile b exp(-z / H).
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Exponential {
    /// H in km: the mean altitude of what scatters or absorbs.
    pub(super) scale_km: f64,
}

/// A profile that rises and falls linearly about a tip.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tent {
    /// Altitude of the tip in km: the mean altitude.
    pub(super) tip_km: f64,
    /// Half its width in km: sqrt(6) times the standard deviation of the altitude.
    pub(super) half_km: f64,
}

/// Mean altitude in km and its standard deviation, weighted with extinction at the second wavelength.
fn moments(layers: &Layers, species: &[&Layered]) -> (f64, f64) {
    let (mut all, mut first, mut second) = (0.0, 0.0, 0.0);
    for i in 0..layers.count {
        let z = (i as f64 + 0.5) * layers.step_m / KM;
        let weight: f64 = species.iter().map(|one| one.scattering[1][i] + one.absorption[1][i]).sum();
        all += weight;
        first += weight * z;
        second += weight * z * z;
    }
    let mean = first / all;
    (mean, (second / all - mean * mean).max(0.0).sqrt())
}

impl Exponential {
    /// With the same mean altitude.
    pub(super) fn of(layers: &Layers, species: &[&Layered]) -> Self {
        Self { scale_km: moments(layers, species).0 }
    }

    /// What stands before it for a vertical optical depth up to `top_km`, in km^-1.
    pub(super) fn at_ground(self, depth: f64, top_km: f64) -> f64 {
        depth / (self.scale_km * (1.0 - (-top_km / self.scale_km).exp()))
    }
}

impl Tent {
    /// With the same mean altitude and spread; both ends above the ground.
    pub(super) fn of(layers: &Layers, species: &[&Layered]) -> Self {
        let (tip_km, spread) = moments(layers, species);
        Self { tip_km, half_km: (6.0_f64.sqrt() * spread).min(tip_km) }
    }

    /// Its value at the tip for a vertical optical depth, in km^-1.
    pub(super) fn at_tip(self, depth: f64) -> f64 {
        depth / self.half_km
    }
}
