//! Aerosols: from size distributions and refractive indices to cross-sections and phase functions of
//! mixtures, and the biomes made of them.
//!
//! [`size`] has the distributions of radii, log-normal or tabulated; [`bulk`] averages single spheres of [`crate::mie`]
//! over them by the rules of [`quadrature`]; [`material`] interpolates refractive indices; [`angles`] has the angles of
//! the tables and the rule of
//! normalisation; [`recipe`] says what each biome is made of, after each source; [`library`] computes all
//! particles of some recipes in parallel; [`mixture`] mixes them; [`fit`] fits phase functions; [`thesis`] reproduces the numbers
//! of the thesis, wrong as they are, so that each correction is a number.

pub mod angles;
pub mod bulk;
pub mod fit;
pub mod library;
pub mod material;
pub mod mixture;
pub mod quadrature;
pub mod recipe;
pub mod size;
pub mod thesis;

use crate::mie::MieError;

/// Why the optics of an aerosol cannot be computed.
#[derive(Debug, thiserror::Error)]
pub enum AerosolError {
    /// A sphere that the solver refuses.
    #[error(transparent)]
    Mie(#[from] MieError),
    /// A material, component, type or layer that the data lack.
    #[error("no {what} in the raw data")]
    Missing {
        /// What, in words.
        what: String,
    },
    /// A wavelength beyond the data of a material.
    #[error("{material} has no refractive index at {wavelength_nm} nm")]
    Wavelength {
        /// The material.
        material: String,
        /// The wavelength.
        wavelength_nm: f64,
    },
    /// A size distribution that is none.
    #[error("size distribution: {0}")]
    Size(String),
}
