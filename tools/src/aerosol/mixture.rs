//! External mixtures: each particle of one material, shares by number.

use super::AerosolError;
use super::bulk::{Bulk, QuadratureError};
use super::library::Library;
use super::material::Substances;
use super::recipe::SpeciesRecipe;

/// Optics of a mixture at one wavelength, per particle of the whole.
#[derive(Debug, Clone, PartialEq)]
pub struct Mixed {
    /// Extinction cross-section, m^2.
    pub extinction: f64,
    /// Scattering cross-section, m^2.
    pub scattering: f64,
    /// Absorption cross-section, m^2.
    pub absorption: f64,
    /// Asymmetry parameter, 1.
    pub asymmetry: f64,
    /// Phase function, sr^-1; empty where no angles were asked for.
    pub phase: Vec<f64>,
    /// P12, P33 and P34 over the phase function, 1, at the same angles.
    pub ratios: [Vec<f64>; 3],
    /// Bound on the error of the average over sizes.
    pub error: QuadratureError,
}

impl Mixed {
    /// Single-scattering albedo, 1.
    #[must_use]
    pub fn albedo(&self) -> f64 {
        self.scattering / self.extinction
    }
}

/// Mixes particles by their numbers: C = sum n_i C_i / N, g and the phase function weighted by n_i C_sca,i, N the
/// sum of the n_i. `parts` must not be empty.
#[must_use]
pub fn mix(parts: &[(&Bulk, f64)], cosines: &[f64]) -> Mixed {
    let number: f64 = parts.iter().map(|(_, n)| n).sum();
    let mean = |value: &dyn Fn(&Bulk) -> f64| parts.iter().map(|(bulk, n)| n * value(bulk)).sum::<f64>() / number;
    let extinction = mean(&|b| b.extinction);
    let scattering = mean(&|b| b.scattering);
    let mut matrix: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; cosines.len()]);
    let mut changes = vec![0.0; cosines.len()];
    for (bulk, n) in parts {
        let weight = n / (number * scattering);
        for (sum, value) in matrix.iter_mut().flatten().zip(bulk.matrix.iter().flatten()) {
            *sum += weight * value;
        }
        for (change, value) in changes.iter_mut().zip(&bulk.matrix[0]) {
            *change += weight * value * bulk.error.phase;
        }
    }
    let [phase, ratios @ ..] = matrix;
    let ratios = ratios.map(|element| element.iter().zip(&phase).map(|(e, p)| e / p).collect());
    let error = QuadratureError {
        cross_sections: mean(&|b| b.extinction * b.error.cross_sections) / extinction,
        misplaced: mean(&|b| b.scattering * b.error.misplaced) / scattering,
        phase: changes.iter().zip(&phase).map(|(change, p)| change / p).fold(0.0, f64::max),
    };
    Mixed {
        extinction,
        scattering,
        absorption: mean(&|b| b.absorption),
        asymmetry: mean(&|b| b.scattering * b.asymmetry) / scattering,
        phase,
        ratios,
        error,
    }
}

/// Optics of a species at a relative humidity of its list, one for each wavelength of the library.
///
/// # Errors
/// [`AerosolError::Missing`] if the library lacks one of its particles.
pub fn species<'a>(
    substances: impl Into<Substances<'a>>,
    library: &Library,
    recipe: &SpeciesRecipe,
    humidity_percent: f64,
) -> Result<Vec<Mixed>, AerosolError> {
    let substances = substances.into();
    let mut parts = Vec::with_capacity(recipe.parts.len());
    for (part, number) in &recipe.parts {
        parts.push((library.get(&part.particles(substances, humidity_percent)?)?, *number));
    }
    let at = |w: usize| -> Vec<(&Bulk, f64)> { parts.iter().map(|(bulk, number)| (&bulk[w], *number)).collect() };
    Ok((0..library.wavelengths_nm().len()).map(|w| mix(&at(w), library.cosines())).collect())
}
