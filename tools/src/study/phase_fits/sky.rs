//! What another phase function of the aerosol does to the sky, by single scattering.

use crate::aerosol::fit::Fit;
use crate::column::{Column, Species};
use crate::study::StudyError;
use std::f64::consts::PI;
use tables::units::TOP_ALTITUDE_M;
use tables::views::integral;

/// Elevation of the sun in degrees.
pub(super) const SUN_ELEVATION_DEG: f64 = 30.0;

/// Directions nearer to the sun than this, in degrees, do not count.
const FROM_SUN_DEG: f64 = 10.0;

/// Directions: in the sine of the elevation, and in azimuth over half a turn (the other half is the same).
const HEIGHTS: u32 = 20;
const AZIMUTHS: u32 = 36;

/// Relative error of the radiance of the sky.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct SkyError {
    /// Rms over the sky, each solid angle alike.
    pub(super) rms: f64,
    /// Mean over the sky.
    pub(super) mean: f64,
}

/// Scattering optical depths from the ground to the top, and phase functions in sr^-1, of what scatters over a place.
#[derive(Debug, Clone)]
pub(super) struct Sky {
    /// Cosines of the angles.
    pub(super) cosines: Vec<f64>,
    /// Optical depth of molecules, times their phase function.
    molecules: Vec<f64>,
    /// Optical depth of scattering by aerosol.
    aerosol_depth: f64,
    /// Phase function of the aerosol, each species weighted with its optical depth of scattering; its integral is 1.
    pub(super) aerosol: Vec<f64>,
}

impl Sky {
    /// The sky of a column at a wavelength in nm, with the phase functions at `cosines`, which should be those of the
    /// aerosol's table.
    pub(super) fn new(column: &Column, wavelength_nm: f64, cosines: &[f64]) -> Result<Self, StudyError> {
        let scattered = |species: Species| -> Result<(f64, Vec<f64>), StudyError> {
            let depth = column.optical_depth(species, wavelength_nm, (0.0, TOP_ALTITUDE_M))?.scattering;
            Ok((depth, column.phase(species, wavelength_nm, cosines)?.unwrap_or_default()))
        };
        let (depth, phase) = scattered(Species::Molecules)?;
        let molecules = phase.iter().map(|p| depth * p).collect();
        let (mut aerosol_depth, mut aerosol) = (0.0, vec![0.0; cosines.len()]);
        for species in column.aerosols() {
            let (depth, phase) = scattered(species)?;
            aerosol_depth += depth;
            for (sum, p) in aerosol.iter_mut().zip(phase) {
                *sum += depth * p;
            }
        }
        // The tables round to single precision.
        let whole = integral(cosines, &aerosol);
        for p in &mut aerosol {
            *p /= whole;
        }
        Ok(Self { cosines: cosines.to_vec(), molecules, aerosol_depth, aerosol })
    }

    /// What a fit does to the sky with the sun at 30 degrees. Of first order in the optical depth the radiance in the
    /// direction at the angle Theta from the sun is E / sin(elevation) times the sum over what scatters of
    /// tau P(cos Theta): the ratio of two such radiances depends on Theta alone, not on profiles.
    pub(super) fn error(&self, fit: &Fit) -> SkyError {
        let ratio: Vec<f64> = (0..self.cosines.len())
            .map(|i| {
                let true_sky = self.molecules[i] + self.aerosol_depth * self.aerosol[i];
                self.aerosol_depth * (fit.phase(self.cosines[i]) - self.aerosol[i]) / true_sky
            })
            .collect();
        let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
        let sun = SUN_ELEVATION_DEG.to_radians();
        for height in 0..HEIGHTS {
            let sine = (f64::from(height) + 0.5) / f64::from(HEIGHTS);
            for turn in 0..AZIMUTHS {
                let azimuth = PI * (f64::from(turn) + 0.5) / f64::from(AZIMUTHS);
                let mu = sine * sun.sin() + (1.0 - sine * sine).sqrt() * sun.cos() * azimuth.cos();
                if mu > FROM_SUN_DEG.to_radians().cos() {
                    continue;
                }
                let above = self.cosines.partition_point(|&c| c < mu).clamp(1, self.cosines.len() - 1);
                let f = (mu - self.cosines[above - 1]) / (self.cosines[above] - self.cosines[above - 1]);
                let error = ratio[above - 1] + f * (ratio[above] - ratio[above - 1]);
                count += 1.0;
                sum += error;
                squares += error * error;
            }
        }
        SkyError { rms: (squares / count).sqrt(), mean: sum / count }
    }
}
