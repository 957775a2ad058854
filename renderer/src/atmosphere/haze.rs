//! The aerosol of a biome in the amount that a scene asks for.

use super::{AirError, Component};
use crate::phase::{Phase, Tabulated};
use crate::polarisation::Scattering;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use tables::TableError;
use tables::units::KM;
use tables::views::{Aerosol, Matrix, Origin, REFERENCE_WAVELENGTH_NM, Species};

/// Koschmieder's constant for a contrast threshold of 2 %: visibility = 3.912 / extinction.
pub const KOSCHMIEDER: f64 = 3.912;

/// How much aerosol there is. Every species of the biome is multiplied alike.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Amount {
    /// As much as the type has.
    Own,
    /// So much that the vertical optical depth at 550 nm is this: that of the whole column, of which a
    /// lower top of the scene cuts off a part.
    OpticalDepth(f64),
    /// So much that the visibility in km is this: 3.912 over the extinction coefficient of
    /// aerosol and molecules at the ground at 550 nm (Koschmieder 1924).
    VisibilityKm(f64),
    /// This many times the type's own.
    Turbidity(f64),
}

/// Where aerosol scatters to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum HazePhase {
    /// The phase function of Mie theory from the table.
    Mie,
    /// Henyey-Greenstein of the same asymmetry.
    HenyeyGreenstein,
}

/// What chooses an aerosol, beside the table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HazeSettings {
    /// Relative humidity in percent of the species that take it; `None` for their own.
    pub humidity_percent: Option<f64>,
    /// How much of it.
    pub amount: Amount,
    /// Its phase function.
    pub phase: HazePhase,
}

/// An aerosol, before any wavelength is chosen.
#[derive(Debug, Clone)]
pub struct Haze {
    aerosol: Aerosol,
    settings: HazeSettings,
    factor: f64,
    optical_depth: f64,
    visibility_km: f64,
}

impl Haze {
    /// Takes as much of `aerosol` as `settings` say. `molecular` is the extinction coefficient of the air
    /// at the ground at 550 nm in m^-1, for the visibility.
    ///
    /// # Errors
    /// [`AirError`] for a humidity that the table does not have, or a visibility that molecules alone do not allow.
    pub fn new(aerosol: Aerosol, settings: HazeSettings, molecular: f64) -> Result<Self, AirError> {
        let humidity = settings.humidity_percent;
        if let Some(percent) = humidity {
            let takes = |s: &Species| s.humidity_range_percent().0 < s.humidity_range_percent().1;
            if !aerosol.species.iter().any(takes) {
                return Err(AirError::Dry { aerosol: aerosol.origin.to_string(), percent });
            }
        }
        let own_depth = aerosol.optical_depth(humidity, REFERENCE_WAVELENGTH_NM)?;
        let own_extinction = aerosol.ground_extinction(humidity, REFERENCE_WAVELENGTH_NM)?;
        let factor = match settings.amount {
            Amount::Own => 1.0,
            Amount::OpticalDepth(asked) => asked / own_depth,
            Amount::Turbidity(factor) => factor,
            Amount::VisibilityKm(km) => {
                let wanted = KOSCHMIEDER / (km * KM) - molecular;
                if wanted < 0.0 {
                    return Err(AirError::TooClear { asked_km: km, clean_km: KOSCHMIEDER / molecular / KM });
                }
                wanted / own_extinction
            }
        };
        Ok(Self {
            settings,
            factor,
            optical_depth: factor * own_depth,
            visibility_km: KOSCHMIEDER / (factor * own_extinction + molecular) / KM,
            aerosol,
        })
    }

    /// Where the aerosol comes from.
    #[must_use]
    pub fn origin(&self) -> &Origin {
        &self.aerosol.origin
    }

    /// Vertical optical depth at 550 nm of the whole column, whatever the top of the scene.
    #[must_use]
    pub fn optical_depth(&self) -> f64 {
        self.optical_depth
    }

    /// Visibility at the ground in km, molecules included.
    #[must_use]
    pub fn visibility_km(&self) -> f64 {
        self.visibility_km
    }

    /// How many times the type's own amount there is.
    #[must_use]
    pub fn factor(&self) -> f64 {
        self.factor
    }

    /// Relative humidity in percent of each species by name, lowest first.
    #[must_use]
    pub fn humidities_percent(&self) -> Vec<(&str, f64)> {
        let asked = self.settings.humidity_percent;
        self.aerosol.species.iter().map(|s| (s.name.as_str(), s.humidity(asked))).collect()
    }

    /// Its species at `L` wavelengths in nm.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] for a wavelength outside the table.
    pub(super) fn components<const L: usize>(&self, nm: &[f64; L]) -> Result<Vec<Component<L>>, TableError> {
        self.aerosol.species.iter().map(|species| self.component(species, nm)).collect()
    }

    /// The amount multiplies the cross-sections, which are products with the density in any case.
    fn component<const L: usize>(&self, species: &Species, nm: &[f64; L]) -> Result<Component<L>, TableError> {
        let humidity = species.humidity(self.settings.humidity_percent);
        let (mut scattering, mut absorption, mut g) = ([0.0; L], [0.0; L], [0.0; L]);
        let count = species.cosines().len();
        let mut values = vec![[0.0; L]; count];
        let mut ratios = Some(vec![[Scattering::default(); L]; count]);
        for (lane, &nm) in nm.iter().enumerate() {
            let optics = species.optics(humidity, nm)?;
            scattering[lane] = self.factor * optics.scattering_m2;
            absorption[lane] = self.factor * (optics.extinction_m2 - optics.scattering_m2);
            g[lane] = optics.asymmetry;
            for (row, value) in values.iter_mut().zip(optics.phase) {
                row[lane] = value;
            }
            match (&mut ratios, species.matrix(humidity, nm)?) {
                (Some(ratios), Some(Matrix { p12, p33, p34 })) => {
                    for (i, row) in ratios.iter_mut().enumerate() {
                        row[lane] = Scattering::of_spheres(1.0, [p12[i], p33[i], p34[i]]);
                    }
                }
                _ => ratios = None,
            }
        }
        let phase = match self.settings.phase {
            HazePhase::HenyeyGreenstein => Phase::HenyeyGreenstein { g },
            HazePhase::Mie => {
                let unsound =
                    |what: &str| TableError::Inconsistent(format!("the {what} of {:?} are not sound", species.name));
                let mut table =
                    Tabulated::new(species.cosines().to_vec(), values).ok_or_else(|| unsound("phase functions"))?;
                if let Some(ratios) = ratios {
                    table = table.with_matrices(ratios).ok_or_else(|| unsound("scattering matrices"))?;
                }
                Phase::Tabulated(Arc::new(table))
            }
        };
        Ok(Component { density: species.number_density_m3.clone(), scattering, absorption, phase })
    }
}
