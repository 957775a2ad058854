//! Refractive indices of aerosol materials.

use super::AerosolError;
use crate::mie::RefractiveIndex;
use crate::raw::aerosol_opac::{self, AerosolOpac, Component};

/// What particles can be made of: OPAC's, or somebody's own.
#[derive(Debug, Clone, Copy)]
pub struct Substances<'a> {
    /// Refractive indices of materials, those of one material and humidity by growing wavelength.
    pub indices: &'a [aerosol_opac::RefractiveIndex],
    /// Components that are known by name.
    pub components: &'a [Component],
}

impl<'a> From<&'a AerosolOpac> for Substances<'a> {
    fn from(opac: &'a AerosolOpac) -> Self {
        Self { indices: &opac.refractive_index.rows, components: &opac.components.rows }
    }
}

/// Refractive index of a material at a relative humidity of its data, and a wavelength in nm: n linear in the
/// wavelength, k by its logarithm (linear where an end is zero), since k falls by decades between neighbours.
/// Below the first wavelength (OPAC: 250 nm) and above the last nothing is known: that is an error.
///
/// # Errors
/// [`AerosolError::Missing`] for an unknown material or humidity, [`AerosolError::Wavelength`] out of range.
pub fn index<'a>(
    substances: impl Into<Substances<'a>>,
    material: &str,
    humidity_percent: f64,
    wavelength_nm: f64,
) -> Result<RefractiveIndex, AerosolError> {
    let mut rows = substances
        .into()
        .indices
        .iter()
        .filter(|row| row.material == material && row.humidity_percent == humidity_percent)
        .peekable();
    if rows.peek().is_none() {
        let what = format!("refractive index of {material} at {humidity_percent} % humidity");
        return Err(AerosolError::Missing { what });
    }
    let outside = || AerosolError::Wavelength { material: material.into(), wavelength_nm };
    let mut below = rows.next().filter(|row| row.wavelength_nm <= wavelength_nm).ok_or_else(outside)?;
    for above in rows {
        if above.wavelength_nm > wavelength_nm {
            let f = (wavelength_nm - below.wavelength_nm) / (above.wavelength_nm - below.wavelength_nm);
            let n = below.n + f * (above.n - below.n);
            let k = if below.k > 0.0 && above.k > 0.0 {
                below.k * (above.k / below.k).powf(f)
            } else {
                below.k + f * (above.k - below.k)
            };
            return Ok(RefractiveIndex::new(n, k)?);
        }
        below = above;
    }
    if below.wavelength_nm == wavelength_nm { Ok(RefractiveIndex::new(below.n, below.k)?) } else { Err(outside()) }
}
