//! The air over one place: what there is at each altitude and what it does to light, from the written tables.
//!
//! Coefficient = number density x cross-section: beta_s(z, lambda) = N_s(z) sigma_s(lambda, T(z)), summed over
//! the species s. Only the cross-section of ozone depends on the temperature.

use crate::data::Data;
use tables::views::{self, AerosolSource, Biome, OzoneCrossSection, OzoneProfile, Rayleigh, StandardAtmosphere};
use tables::{Curve, Kind, TableError};

/// What chooses the air over a place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Month, 1 to 12: which ozone.
    pub month: u8,
    /// Latitude in degrees, north positive, -90 to 90: which ozone.
    pub latitude_deg: f64,
    /// Aerosol, in its own amount; none for clear air.
    pub biome: Option<Biome>,
    /// Whose optics the aerosol has.
    pub source: AerosolSource,
    /// Relative humidity in percent of the species that take it, 0 to 99; their own if `None`.
    pub humidity_percent: Option<f64>,
}

impl Default for Place {
    /// Clear air in June at 45 degrees north; OPAC where an aerosol is put in.
    fn default() -> Self {
        Self { month: 6, latitude_deg: 45.0, biome: None, source: AerosolSource::Opac, humidity_percent: None }
    }
}

impl Place {
    /// Names of the files of the tables that it needs.
    #[must_use]
    pub fn table_files(&self) -> Vec<String> {
        let air = [Kind::StandardAtmosphere, Kind::Rayleigh, Kind::OzoneProfiles, Kind::OzoneCrossSection];
        let aerosol = self.biome.map(|biome| views::Aerosol::file_name(self.source, biome));
        air.map(Kind::file_name).into_iter().chain(aerosol).collect()
    }
}

/// A kind of particle in the air.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Species {
    /// Molecules of air, which scatter.
    Molecules,
    /// Ozone, which absorbs.
    Ozone,
    /// The species of that index of the aerosol, lowest first, which scatters and absorbs; an index that
    /// [`Column::aerosols`] does not give panics.
    Aerosol(usize),
}

/// A pair of what is scattered and what is absorbed: cross-sections (m^2), coefficients (m^-1) or optical depths (1).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Parts {
    /// Scattered part.
    pub scattering: f64,
    /// Absorbed part.
    pub absorption: f64,
}

impl Parts {
    /// Scattering and absorption together.
    #[must_use]
    pub fn extinction(self) -> f64 {
        self.scattering + self.absorption
    }

    /// Both parts times a factor.
    #[must_use]
    pub fn times(self, factor: f64) -> Self {
        Self { scattering: factor * self.scattering, absorption: factor * self.absorption }
    }
}

/// Henyey and Greenstein's phase function of the asymmetry parameter g, in sr^-1, at a cosine mu of the scattering
/// angle: (1 - g^2) / (4 pi (1 + g^2 - 2 g mu)^(3/2)).
#[must_use]
pub fn henyey_greenstein(asymmetry: f64, cosine: f64) -> f64 {
    let g = asymmetry;
    (1.0 - g * g) / (4.0 * std::f64::consts::PI * (1.0 + g * g - 2.0 * g * cosine).powf(1.5))
}

impl std::iter::Sum for Parts {
    fn sum<I: Iterator<Item = Self>>(parts: I) -> Self {
        parts.fold(Self::default(), |a, b| Self {
            scattering: a.scattering + b.scattering,
            absorption: a.absorption + b.absorption,
        })
    }
}

/// The air over one place.
#[derive(Debug, Clone)]
pub struct Column {
    air: StandardAtmosphere,
    rayleigh: Rayleigh,
    ozone: OzoneProfile,
    ozone_cross_section: OzoneCrossSection,
    aerosol: Vec<views::Species>,
    humidity_percent: Option<f64>,
}

impl Column {
    /// Reads the tables that `place` needs.
    ///
    /// # Errors
    /// [`TableError`] if one cannot be used, or does not have that month.
    pub fn read(data: Data<'_>, place: &Place) -> Result<Self, TableError> {
        Ok(Self {
            air: data.air()?,
            rayleigh: data.rayleigh()?,
            ozone: data.ozone_profiles()?.profile(place.month, place.latitude_deg)?,
            ozone_cross_section: data.ozone_cross_section()?,
            aerosol: match place.biome {
                Some(biome) => data.aerosol(place.source, biome)?.species,
                None => Vec::new(),
            },
            humidity_percent: place.humidity_percent,
        })
    }

    /// Every species: molecules, ozone, then those of the aerosol, lowest first.
    #[must_use]
    pub fn species(&self) -> Vec<Species> {
        [Species::Molecules, Species::Ozone].into_iter().chain(self.aerosols()).collect()
    }

    /// Those of the aerosol.
    #[must_use]
    pub fn aerosols(&self) -> Vec<Species> {
        (0..self.aerosol.len()).map(Species::Aerosol).collect()
    }

    /// Its name: `molecules`, `ozone`, or that of the aerosol's species in its table.
    #[must_use]
    pub fn name(&self, species: Species) -> &str {
        match species {
            Species::Molecules => "molecules",
            Species::Ozone => "ozone",
            Species::Aerosol(i) => &self.aerosol[i].name,
        }
    }

    /// Temperature, pressure and number density of air.
    #[must_use]
    pub fn air(&self) -> &StandardAtmosphere {
        &self.air
    }

    /// King factor and gamma of air.
    #[must_use]
    pub fn rayleigh(&self) -> &Rayleigh {
        &self.rayleigh
    }

    /// Lowest and highest wavelength in nm of which the tables of molecules and ozone both speak; those of the aerosol
    /// may end before.
    #[must_use]
    pub fn wavelength_range_nm(&self) -> (f64, f64) {
        let (a, b) = self.rayleigh.cross_section_m2.axis().range();
        let (c, d) = self.ozone_cross_section.coefficients[0].axis().range();
        (a.max(c), b.min(d))
    }

    /// Vertical column of ozone in Dobson units.
    #[must_use]
    pub fn ozone_du(&self) -> f64 {
        self.ozone.column_du
    }

    /// Relative humidity in percent at which a species is; `None` for molecules and ozone.
    #[must_use]
    pub fn humidity_percent(&self, species: Species) -> Option<f64> {
        match species {
            Species::Aerosol(i) => Some(self.aerosol[i].humidity(self.humidity_percent)),
            Species::Molecules | Species::Ozone => None,
        }
    }

    /// Number density in m^-3 against altitude in m.
    #[must_use]
    pub fn density(&self, species: Species) -> &Curve {
        match species {
            Species::Molecules => &self.air.number_density_m3,
            Species::Ozone => &self.ozone.number_density_m3,
            Species::Aerosol(i) => &self.aerosol[i].number_density_m3,
        }
    }

    /// Cross-sections of one particle in m^2 at a wavelength in nm, and for ozone at the temperature of the air
    /// at an altitude in m.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside the wavelengths, altitudes or humidities of the tables.
    pub fn cross_sections(&self, species: Species, wavelength_nm: f64, altitude_m: f64) -> Result<Parts, TableError> {
        Ok(match species {
            Species::Molecules => {
                Parts { scattering: self.rayleigh.cross_section_m2.at(wavelength_nm)?, absorption: 0.0 }
            }
            Species::Ozone => {
                let kelvin = self.air.temperature_k.at(altitude_m)?;
                let absorption = self.ozone_cross_section.cross_section_m2(wavelength_nm, kelvin)?;
                Parts { scattering: 0.0, absorption }
            }
            Species::Aerosol(i) => {
                let particles = &self.aerosol[i];
                let humidity = particles.humidity(self.humidity_percent);
                let (extinction, scattering) = particles.cross_sections(humidity, wavelength_nm)?;
                Parts { scattering, absorption: extinction - scattering }
            }
        })
    }

    /// Coefficients in m^-1 at a wavelength in nm and an altitude in m.
    ///
    /// # Errors
    /// As [`Column::cross_sections`].
    pub fn coefficients(&self, species: Species, wavelength_nm: f64, altitude_m: f64) -> Result<Parts, TableError> {
        let density = self.density(species).at(altitude_m)?;
        Ok(self.cross_sections(species, wavelength_nm, altitude_m)?.times(density))
    }

    /// Coefficients in m^-1 of the whole aerosol at a wavelength in nm and an altitude in m.
    ///
    /// # Errors
    /// As [`Column::cross_sections`].
    pub fn aerosol_coefficients(&self, wavelength_nm: f64, altitude_m: f64) -> Result<Parts, TableError> {
        self.aerosols().into_iter().map(|species| self.coefficients(species, wavelength_nm, altitude_m)).sum()
    }

    /// Number density in m^-3 of the whole aerosol at an altitude in m.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] if the altitude is no number.
    pub fn aerosol_density(&self, altitude_m: f64) -> Result<f64, TableError> {
        self.aerosols().into_iter().map(|species| self.density(species).at(altitude_m)).sum()
    }

    /// Asymmetry parameter g of the whole aerosol at a wavelength in nm and an altitude in m: the mean of its species',
    /// weighted with their scattering coefficients. 0 where there is none.
    ///
    /// # Errors
    /// As [`Column::cross_sections`].
    pub fn aerosol_asymmetry(&self, wavelength_nm: f64, altitude_m: f64) -> Result<f64, TableError> {
        let (mut forward, mut all) = (0.0, 0.0);
        for species in self.aerosols() {
            let scattering = self.coefficients(species, wavelength_nm, altitude_m)?.scattering;
            forward += scattering * self.asymmetry(species, wavelength_nm)?.unwrap_or(0.0);
            all += scattering;
        }
        Ok(if all > 0.0 { forward / all } else { 0.0 })
    }

    /// Phase function in sr^-1 of the whole aerosol, weighted like [`Column::aerosol_asymmetry`], at each cosine of the
    /// scattering angle. Zeros where there is none.
    ///
    /// # Errors
    /// As [`Column::phase`].
    pub fn aerosol_phase(&self, wavelength_nm: f64, altitude_m: f64, cosines: &[f64]) -> Result<Vec<f64>, TableError> {
        let (mut sum, mut all) = (vec![0.0; cosines.len()], 0.0);
        for species in self.aerosols() {
            let scattering = self.coefficients(species, wavelength_nm, altitude_m)?.scattering;
            let Some(phase) = self.phase(species, wavelength_nm, cosines)? else { continue };
            for (total, value) in sum.iter_mut().zip(phase) {
                *total += scattering * value;
            }
            all += scattering;
        }
        Ok(if all > 0.0 { sum.into_iter().map(|value| value / all).collect() } else { sum })
    }

    /// Vertical optical depth between two altitudes in m at a wavelength in nm. The integral is exact for the
    /// tables' own interpolation.
    ///
    /// # Errors
    /// As [`Column::cross_sections`].
    pub fn optical_depth(
        &self,
        species: Species,
        wavelength_nm: f64,
        (low_m, high_m): (f64, f64),
    ) -> Result<Parts, TableError> {
        let density = self.density(species);
        if species != Species::Ozone {
            let column = density.integral(low_m, high_m)?;
            return Ok(self.cross_sections(species, wavelength_nm, low_m)?.times(column));
        }
        // Between nodes N and T are linear and sigma is a parabola in T: a cubic, for which Simpson's rule is exact.
        let inside = |z: &f64| (low_m..=high_m).contains(z);
        let nodes = density.axis().nodes.iter().chain(&self.air.temperature_k.axis().nodes).copied();
        let mut nodes: Vec<f64> = nodes.filter(inside).chain([low_m, high_m]).collect();
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        let mut depth = Parts::default();
        for pair in nodes.windows(2) {
            let (a, b) = (pair[0], pair[1]);
            let at = |z: f64| self.coefficients(species, wavelength_nm, z).map(|parts| parts.absorption);
            depth.absorption += (b - a) / 6.0 * (at(a)? + 4.0 * at(0.5 * (a + b))? + at(b)?);
        }
        Ok(depth)
    }

    /// Asymmetry parameter g at a wavelength in nm; 0 for molecules, `None` for ozone, which does not scatter.
    ///
    /// # Errors
    /// As [`Column::cross_sections`].
    pub fn asymmetry(&self, species: Species, wavelength_nm: f64) -> Result<Option<f64>, TableError> {
        match species {
            Species::Molecules => Ok(Some(0.0)),
            Species::Ozone => Ok(None),
            Species::Aerosol(i) => {
                let particles = &self.aerosol[i];
                Ok(Some(particles.optics(particles.humidity(self.humidity_percent), wavelength_nm)?.asymmetry))
            }
        }
    }

    /// Phase function in sr^-1 at each cosine of the scattering angle; `None` for ozone, which does not scatter.
    ///
    /// Of molecules P = 3 / (16 pi (1 + 2 gamma)) ((1 + 3 gamma) + (1 - gamma) cos^2) (Bucholtz 1995, equation 12,
    /// normalised to 1); of aerosol linear in the cosine between those of [`views::Species::cosines`].
    ///
    /// # Errors
    /// As [`Column::cross_sections`], and for a cosine outside -1..=1.
    pub fn phase(&self, species: Species, wavelength_nm: f64, cosines: &[f64]) -> Result<Option<Vec<f64>>, TableError> {
        match species {
            Species::Molecules => {
                let gamma = self.rayleigh.gamma.at(wavelength_nm)?;
                let factor = 3.0 / (16.0 * std::f64::consts::PI * (1.0 + 2.0 * gamma));
                let value = |c: &f64| factor * ((1.0 + 3.0 * gamma) + (1.0 - gamma) * c * c);
                Ok(Some(cosines.iter().map(value).collect()))
            }
            Species::Ozone => Ok(None),
            Species::Aerosol(i) => {
                let particles = &self.aerosol[i];
                let optics = particles.optics(particles.humidity(self.humidity_percent), wavelength_nm)?;
                let axis = tables::Axis::new("cosine", "1", particles.cosines().to_vec())?;
                let curve = Curve::new(axis, tables::Scale::Linear, optics.phase)?;
                cosines.iter().map(|&c| curve.at(c)).collect::<Result<_, _>>().map(Some)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn column(biome: Option<Biome>) -> Column {
        let data = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../data"));
        Column::read(Data(data), &Place { biome, ..Place::default() }).expect("tables")
    }

    #[test]
    fn optical_depths_of_parts_add_up_to_that_of_the_whole() {
        let column = column(Some(Biome::DesertDust));
        assert_eq!(column.species().len(), 2 + column.aerosols().len());
        for species in column.species() {
            let depth = |low, high| column.optical_depth(species, 550.0, (low, high)).expect("inside").extinction();
            let (whole, parts) = (depth(0.0, 120e3), depth(0.0, 3.3e3) + depth(3.3e3, 25e3) + depth(25e3, 120e3));
            // Rounding of sums of some hundred terms.
            assert!((parts / whole - 1.0).abs() < 1e-12, "{}: {parts} for {whole}", column.name(species));
        }
    }

    #[test]
    fn optical_depth_is_the_integral_of_the_coefficient() {
        let column = column(Some(Biome::Urban));
        for species in column.species() {
            let exact = column.optical_depth(species, 600.0, (500.0, 1500.0)).expect("inside").extinction();
            let sum: f64 = (0..1000)
                .map(|i| column.coefficients(species, 600.0, 500.5 + f64::from(i)).expect("inside").extinction())
                .sum();
            // The midpoint rule over metres of a function that changes over kilometres: 1e-7; a layer may begin between.
            assert!((sum / exact - 1.0).abs() < 1e-6 || exact == 0.0, "{}: {sum} for {exact}", column.name(species));
        }
    }

    #[test]
    fn the_whole_aerosol_is_the_mean_of_its_species() {
        let column = column(Some(Biome::MaritimeMineral));
        let cosines: Vec<f64> = (0..=20_000).map(|i| -1.0 + f64::from(i) * 1e-4).collect();
        let phase = column.aerosol_phase(550.0, 0.0, &cosines).expect("inside");
        let g = column.aerosol_asymmetry(550.0, 0.0).expect("inside");
        let weighted: Vec<f64> = phase.iter().zip(&cosines).map(|(p, c)| p * c).collect();
        // The table has narrower steps at the forward peak than these 1e-4, by which the integral is off 2e-3, and g
        // with it; the tables' own g is of the series, not of the phase function.
        assert!((tables::views::integral(&cosines, &phase) - 1.0).abs() < 5e-3);
        assert!((tables::views::integral(&cosines, &weighted) - g).abs() < 5e-3);
        let henyey: Vec<f64> = cosines.iter().map(|&c| henyey_greenstein(0.5, c)).collect();
        // The trapezoidal rule over steps of 1e-4 of a function with a second derivative of 20: 2e-8.
        assert!((tables::views::integral(&cosines, &henyey) - 1.0).abs() < 1e-7);
    }

    #[test]
    fn the_phase_function_of_molecules_integrates_to_one() {
        let cosines: Vec<f64> = (0..=2000).map(|i| -1.0 + f64::from(i) * 1e-3).collect();
        let phase = column(None).phase(Species::Molecules, 550.0, &cosines).expect("inside").expect("it scatters");
        // The trapezoidal rule on c^2 over steps of 1e-3 is high by 1e-6 / 6 of it.
        assert!((tables::views::integral(&cosines, &phase) - 1.0).abs() < 2e-7);
    }
}
