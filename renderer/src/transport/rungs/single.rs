//! Single scattering: Nishita, Sirai, Tadamura & Nakamae 1993, "Display of the Earth taking into account atmospheric scattering",
//! section 3, on Airlight's own profiles, spectra and phase functions.
//!
//! L = int T(0, s) sum_i k_i(s) P_i(theta) T_sun(s) ds + T(end) albedo/pi cos(chi) T_sun: sunlight that one molecule, one particle or the
//! ground turns to the eye. Nishita et al. take two exponential profiles and sum along the line between shells, with optical
//! depths to the sun from a table; here transmittances come from column tables, to 2e-5, and the sum has [`super::STEPS`] points
//! (20 give a few tenths of a percent by day). Any sun, observer and air; with the sun low, the edge of the planet's shadow
//! falls between two points.

use super::march::Air;
use crate::geometry::Place;
use glam::DVec3;

/// Radiance per unit solar irradiance in sr^-1.
pub(super) fn radiance<const L: usize>(air: &Air<L>, from: Place, direction: DVec3, sun: DVec3) -> [f64; L] {
    air.radiance((from, direction), sun, air.steps(), None)
}
