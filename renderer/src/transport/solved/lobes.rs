//! What scatterers send on by each angle, roughly, for densities of directions.

use super::line::MOST_SPECIES;
use super::species::Species;

/// Nodes, even in the sine of half the angle.
const NODES: usize = 256;

/// Half of 8 degrees, the angle within which phase functions count as flat: about a third of a bin of directions (22.5 degrees of azimuth).
/// Narrower peaks are drawn by themselves.
const NARROW: f64 = 4.0 * std::f64::consts::PI / 180.0;

/// Phase functions of the species, the means over wavelengths.
#[derive(Debug)]
pub(super) struct Lobes {
    species: Vec<[f32; NODES]>,
}

impl Lobes {
    pub(super) fn new<const L: usize>(species: &[Species<L>]) -> Self {
        let lobe = |one: &Species<L>| {
            std::array::from_fn(|node| {
                let sine = (node as f64 / (NODES - 1) as f64).max(NARROW.sin());
                let phase = one.phase.values(1.0 - 2.0 * sine * sine);
                ((0..L).map(|j| phase[j] * one.whole[j]).sum::<f64>() / L as f64) as f32
            })
        };
        Self { species: species.iter().map(lobe).collect() }
    }

    /// In proportion to what is scattered by an angle with this cosine where the species have these scattering coefficients, without
    /// what goes straight on.
    #[inline(always)]
    pub(super) fn scattered(&self, scattering: &[f32; MOST_SPECIES], cosine: f64) -> f64 {
        let node = ((0.5 - 0.5 * cosine).clamp(0.0, 1.0).sqrt() * (NODES - 1) as f64 + 0.5) as usize;
        self.species.iter().zip(scattering).map(|(lobe, scattering)| f64::from(lobe[node] * scattering)).sum()
    }
}
