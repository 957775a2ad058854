//! The aerosol of the thesis as its code has it, wrong in the ways that `docs/aerosols.md` lists: only to
//! understand, never to render with.

use super::AerosolError;
use super::material::index;
use super::recipe::thesis_biome;
use crate::mie::Solver;
use crate::raw::aerosol_jaenicke::AerosolJaenicke;
use crate::raw::aerosol_opac::AerosolOpac;
use std::f64::consts::PI;
use tables::views::Biome;

/// Scattering and absorption cross-section in m^2 by the recipe of the thesis: the plain sum, over the three
/// median radii of Jaenicke's modes, of the cross-section of one sphere of each radius, materials weighted by
/// number. Neither the widths nor the numbers of the modes enter.
///
/// # Errors
/// [`AerosolError`] if the data lack a material, or outside its wavelengths.
pub fn cross_sections(
    opac: &AerosolOpac,
    jaenicke: &AerosolJaenicke,
    biome: Biome,
    wavelength_nm: f64,
) -> Result<(f64, f64), AerosolError> {
    let made_of = thesis_biome(biome);
    let mut solver = Solver::new();
    let (mut scattering, mut absorption) = (0.0, 0.0);
    for mode in jaenicke.modes.rows.iter().filter(|mode| mode.aerosol_type == made_of.jaenicke_type) {
        for (material, share) in made_of.materials {
            let m = index(opac, material, 0.0, wavelength_nm)?;
            let r = mode.median_radius;
            let q = solver.sphere(m, 2.0 * PI * r / (wavelength_nm * 1e-9))?.efficiencies();
            scattering += share * PI * r * r * q.scattering;
            absorption += share * PI * r * r * q.absorption;
        }
    }
    Ok((scattering, absorption))
}
