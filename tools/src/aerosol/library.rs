//! The optics of many kinds of particles at many wavelengths, computed once and in parallel.

use super::AerosolError;
use super::bulk::{Bulk, Rule, average};
use super::material::{Substances, index};
use super::recipe::Particles;
use crate::mie::{AngularTable, Spheres, terms};
use rayon::prelude::*;
use std::f64::consts::PI;

/// Particles and their optics at each wavelength.
#[derive(Debug, Clone)]
pub struct Library {
    wavelengths_nm: Vec<f64>,
    cosines: Vec<f64>,
    entries: Vec<(Particles, Vec<Bulk>)>,
}

impl Library {
    /// Computes every one of `particles` (which may repeat) at every wavelength in nm and at the angles with these
    /// cosines. The result does not depend on the number of threads.
    ///
    /// # Errors
    /// [`AerosolError`], of the first that fails.
    pub fn new<'a>(
        substances: impl Into<Substances<'a>>,
        particles: impl IntoIterator<Item = Particles>,
        wavelengths_nm: &[f64],
        cosines: &[f64],
        rule: &Rule,
    ) -> Result<Self, AerosolError> {
        let substances = substances.into();
        let mut distinct: Vec<Particles> = Vec::new();
        for one in particles {
            if !distinct.contains(&one) {
                distinct.push(one);
            }
        }
        let shortest = wavelengths_nm.iter().copied().fold(f64::INFINITY, f64::min) * 1e-9;
        let limit = |p: &Particles| [rule.absorbing, rule.clear].map(|t| Rule::limits(&p.sizes, t).1.exp());
        let largest = distinct.iter().flat_map(limit).fold(0.0, f64::max);
        let angles = AngularTable::new(cosines, terms(1.001 * 2.0 * PI * largest / shortest))?;
        let jobs: Vec<(usize, usize)> =
            (0..distinct.len()).flat_map(|p| (0..wavelengths_nm.len()).map(move |w| (p, w))).collect();
        let done: Vec<Result<Bulk, AerosolError>> = jobs
            .par_iter()
            // Jobs differ a thousandfold: each is up to whoever is free.
            .with_max_len(1)
            .map_init(Spheres::new, |solver, &(p, w)| {
                let (particles, wavelength_nm) = (&distinct[p], wavelengths_nm[w]);
                let m = index(substances, &particles.material, particles.humidity_percent, wavelength_nm)?;
                average(m, &particles.sizes, wavelength_nm * 1e-9, &angles, rule, solver)
            })
            .collect();
        let mut done = done.into_iter();
        let mut entries = Vec::with_capacity(distinct.len());
        for particles in distinct {
            let optics = done.by_ref().take(wavelengths_nm.len()).collect::<Result<Vec<_>, _>>()?;
            entries.push((particles, optics));
        }
        Ok(Self { wavelengths_nm: wavelengths_nm.to_vec(), cosines: cosines.to_vec(), entries })
    }

    /// The wavelengths in nm.
    #[must_use]
    pub fn wavelengths_nm(&self) -> &[f64] {
        &self.wavelengths_nm
    }

    /// The cosines of the angles.
    #[must_use]
    pub fn cosines(&self) -> &[f64] {
        &self.cosines
    }

    /// The optics of these particles, one for each wavelength.
    ///
    /// # Errors
    /// [`AerosolError::Missing`] if they were not computed.
    pub fn get(&self, particles: &Particles) -> Result<&[Bulk], AerosolError> {
        let found = self.entries.iter().find(|(key, _)| key == particles);
        let what =
            || format!("optics of particles of {} at {} % humidity", particles.material, particles.humidity_percent);
        found.map(|(_, optics)| optics.as_slice()).ok_or_else(|| AerosolError::Missing { what: what() })
    }
}
