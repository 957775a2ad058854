//! What the code of the thesis (Gavin 2020; GitHub agavinm/atmosphere-renderer 30664c6a) computed with, errors
//! included: to be drawn dotted beside the tables and to be compared with them, and used for nothing else.
//!
//! The reader of each file in `raw-data/` has the numbers; the rules by which the code made them densities and
//! cross-sections are here. Of the printed thesis, which may differ, only the code is known.

mod compare;

pub(super) use compare::compare;

use super::StudyError;
use crate::column::Parts;
use crate::profile::standard_atmosphere::StandardAtmosphere;
use crate::raw::aerosol_gavin::{self, AerosolGavin, BIOMES};
use crate::raw::bucholtz::Bucholtz;
use crate::raw::ozone_arosa::OzoneArosa;
use crate::raw::ozone_thesis::OzoneThesis;
use crate::raw::us_standard_atmosphere::{Constants, UsStandardAtmosphere};
use std::path::Path;
use tables::units::{DOBSON_UNIT_M2, KM};
use tables::views::Biome;
use tables::{Axis, Curve, Outside, Scale, TableError};

/// Where its atmosphere ends, m.
pub const TOP_M: f64 = 86.0 * KM;

/// Asymmetry parameter of its Henyey-Greenstein phase function, for every biome and wavelength.
pub const ASYMMETRY: f64 = 0.76;

/// Molecules per square metre that it took for a Dobson unit; it is 2.6868e20.
const THESIS_DOBSON_UNIT_M2: f64 = 2.96e20;

/// Geopotential altitude in m' where the layers of its standard atmosphere end; from there it is isothermal.
const LAYERS_END_M: f64 = 84_852.0;

/// Kelvin and pascal of one amagat, and its molecules in m^-3.
const AMAGAT: (f64, f64, f64) = (273.15, 101_325.0, 2.686_780_5e25);

/// Background N_b of its equation 3.9 in m^-3: 2e6 km^-3, which is nothing; 2 cm^-3 was presumably meant.
const BACKGROUND_M3: f64 = 2e6 / (KM * KM * KM);

/// The thesis' atmosphere.
#[derive(Debug, Clone)]
pub struct Thesis {
    temperature_k: Curve,
    pressure_pa: Curve,
    /// Molecules over a square metre, m^-2.
    air_column_m2: f64,
    rayleigh_m2: Curve,
    ozone_m2: Curve,
    arosa: OzoneArosa,
    biomes: Vec<aerosol_gavin::Biome>,
    /// Cross-sections that it took for scattering and for absorption, in the order of [`BIOMES`].
    aerosols_m2: Vec<[Curve; 2]>,
}

impl Thesis {
    /// Reads its numbers, and what its tables were copied from, below `raw_dir`.
    ///
    /// # Errors
    /// [`StudyError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, StudyError> {
        let (ozone, aerosol) = (OzoneThesis::from_dir(raw_dir)?, AerosolGavin::from_dir(raw_dir)?);
        let [temperature_k, pressure_pa] = air(&UsStandardAtmosphere::from_dir(raw_dir)?)?;
        let bucholtz = Bucholtz::from_dir(raw_dir)?.cross_section.rows;
        let spectrum = |points: Vec<(f64, f64)>| {
            let (nm, values) = points.into_iter().unzip();
            Curve::new(Axis::new("wavelength", "nm", nm)?, Scale::Linear, values)
        };
        let rows = &aerosol.cross_sections.rows;
        let mut aerosols_m2 = Vec::new();
        for i in 0..BIOMES.len() {
            // The file has the columns by what they are; the code had them by the other's name.
            let scattering = spectrum(rows.iter().map(|row| (row.wavelength_nm, row.biomes[i].1)).collect())?;
            let absorption = spectrum(rows.iter().map(|row| (row.wavelength_nm, row.biomes[i].0)).collect())?;
            aerosols_m2.push([scattering, absorption]);
        }
        let mut thesis = Self {
            temperature_k,
            pressure_pa,
            air_column_m2: 0.0,
            rayleigh_m2: spectrum(bucholtz.iter().map(|row| (row.wavelength_nm, row.cross_section)).collect())?,
            ozone_m2: spectrum(
                ozone.cross_sections.rows.iter().map(|row| (row.wavelength_nm, row.cross_section)).collect(),
            )?,
            arosa: OzoneArosa::from_dir(raw_dir)?,
            biomes: aerosol.biomes.rows,
            aerosols_m2,
        };
        // Simpson's rule in each km, where p / T is a quotient of two lines: right to 1e-7.
        for i in 0..(TOP_M / KM) as u32 {
            let z = f64::from(i) * KM;
            let at = |z: f64| thesis.molecules_m3(z);
            thesis.air_column_m2 += KM / 6.0 * (at(z)? + 4.0 * at(z + 0.5 * KM)? + at(z + KM)?);
        }
        Ok(thesis)
    }

    /// Temperature in K at an altitude z in m, linear between whole km: that of the standard atmosphere at the
    /// *geopotential* altitude of the same number.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside 0 to 86 km.
    pub fn temperature_k(&self, altitude_m: f64) -> Result<f64, TableError> {
        self.temperature_k.at(altitude_m)
    }

    /// Pressure in Pa, as [`Thesis::temperature_k`].
    ///
    /// # Errors
    /// As there.
    pub fn pressure_pa(&self, altitude_m: f64) -> Result<f64, TableError> {
        self.pressure_pa.at(altitude_m)
    }

    /// Molecules of air in m^-3 at an altitude in m: N = (p / 1013.25 hPa) (273.15 K / T) 2.6867805e25 m^-3, with
    /// these p and T; none outside 0 to 86 km. 19 % too few at 86 km.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] if the altitude is no number.
    pub fn molecules_m3(&self, altitude_m: f64) -> Result<f64, TableError> {
        if outside(altitude_m) {
            return Ok(0.0);
        }
        let (kelvin, pascal, molecules) = AMAGAT;
        Ok(self.pressure_pa(altitude_m)? / pascal * kelvin / self.temperature_k(altitude_m)? * molecules)
    }

    /// Molecules of ozone in m^-3 at an altitude in m in a month, 1 to 12: the column at Arosa in six layers up to
    /// 54 km, with a Dobson unit too large by 10 %, twice the share of the two layers at the top, and the column of
    /// a layer of 9 km taken for the number in each km: 10.5 times the ozone there is.
    ///
    /// # Errors
    /// [`TableError::Inconsistent`] for a month that is none.
    pub fn ozone_m3(&self, month: u8, altitude_m: f64) -> Result<f64, TableError> {
        let layers = &self.arosa.layers.rows;
        let of_layers = self.ozone_layers_m3(month)?;
        let at = layers.iter().position(|layer| (layer.bottom..layer.top).contains(&altitude_m));
        Ok(at.map_or(0.0, |i| of_layers[i]))
    }

    fn ozone_layers_m3(&self, month: u8) -> Result<Vec<f64>, TableError> {
        let row = self.arosa.columns.rows.iter().find(|row| row.month == month);
        let row = row.ok_or_else(|| TableError::Inconsistent(format!("no month {month}")))?;
        let layers = &self.arosa.layers.rows;
        let total: f64 = layers.iter().map(|layer| layer.column).sum();
        let column = row.column / DOBSON_UNIT_M2 * THESIS_DOBSON_UNIT_M2;
        let doubled = |i: usize| if i + 2 < layers.len() { 1.0 } else { 2.0 };
        Ok(layers.iter().enumerate().map(|(i, layer)| column * doubled(i) * layer.column / total / KM).collect())
    }

    /// Particles in m^-3 at an altitude z in m, as many at each for the biome `background`:
    /// N(z) = N(0) (exp(-z / H_p) + N_b / N(0)) (equation 3.9), N(0) with the code's slips of the pen; none outside
    /// 0 to 86 km.
    ///
    /// # Errors
    /// [`TableError::Inconsistent`] if the data lack the biome.
    pub fn particles_m3(&self, biome: Biome, altitude_m: f64) -> Result<f64, TableError> {
        if outside(altitude_m) {
            return Ok(0.0);
        }
        let made_of = self.biome(biome)?;
        let falling = made_of.scale_height.map_or(1.0, |height| (-altitude_m / height).exp());
        Ok(made_of.base_density * falling + BACKGROUND_M3)
    }

    fn biome(&self, biome: Biome) -> Result<&aerosol_gavin::Biome, TableError> {
        let row = self.biomes.iter().find(|row| row.biome == biome.name());
        row.ok_or_else(|| TableError::Inconsistent(format!("the thesis has no biome {biome}")))
    }

    /// Rayleigh cross-section of a molecule in m^2 at a wavelength in nm: Bucholtz' table 2, linear between its rows.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside 200 to 4000 nm.
    pub fn rayleigh_m2(&self, wavelength_nm: f64) -> Result<f64, TableError> {
        self.rayleigh_m2.at(wavelength_nm)
    }

    /// Absorption cross-section of ozone in m^2 at a wavelength in nm: linear between 32 points, over gaps of up to
    /// 116 nm, the point at 248 nm a tenth of what it should be; the same at every temperature.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside 244 to 1046 nm.
    pub fn ozone_m2(&self, wavelength_nm: f64) -> Result<f64, TableError> {
        self.ozone_m2.at(wavelength_nm)
    }

    /// Cross-sections of a particle in m^2 at a wavelength in nm, each taken for the other, as the code has them:
    /// what it calls scattering is absorption. It has them every nm or so and linear between; here every 7 nm.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside 300 to 1000 nm.
    pub fn particle_m2(&self, biome: Biome, wavelength_nm: f64) -> Result<Parts, TableError> {
        let index = BIOMES.iter().position(|name| *name == biome.name());
        let index = index.ok_or_else(|| TableError::Inconsistent(format!("the thesis has no biome {biome}")))?;
        let [scattering, absorption] = &self.aerosols_m2[index];
        Ok(Parts { scattering: scattering.at(wavelength_nm)?, absorption: absorption.at(wavelength_nm)? })
    }

    /// Vertical optical depth from the ground to 86 km at a wavelength in nm, of everything together.
    ///
    /// # Errors
    /// [`TableError`] for a month that is none, or outside 300 to 1000 nm.
    pub fn optical_depth(&self, month: u8, biome: Option<Biome>, wavelength_nm: f64) -> Result<f64, TableError> {
        let layers = self.arosa.layers.rows.iter().zip(self.ozone_layers_m3(month)?);
        let ozone_column: f64 = layers.map(|(layer, density)| density * (layer.top - layer.bottom)).sum();
        let mut depth =
            self.air_column_m2 * self.rayleigh_m2(wavelength_nm)? + ozone_column * self.ozone_m2(wavelength_nm)?;
        if let Some(biome) = biome {
            let made_of = self.biome(biome)?;
            let height = made_of.scale_height.map_or(TOP_M, |h| h * (1.0 - (-TOP_M / h).exp()));
            let particles = made_of.base_density * height + BACKGROUND_M3 * TOP_M;
            depth += particles * self.particle_m2(biome, wavelength_nm)?.extinction();
        }
        Ok(depth)
    }
}

fn outside(altitude_m: f64) -> bool {
    !(0.0..=TOP_M).contains(&altitude_m)
}

/// Temperature and pressure at whole km, taken at geopotential altitudes of that number: those of the layers, and
/// from 84.852 km' on isothermal.
fn air(raw: &UsStandardAtmosphere) -> Result<[Curve; 2], StudyError> {
    let atmosphere = StandardAtmosphere::new(raw)?;
    let Constants { earth_radius: r, gravity, gas_constant, molar_mass, .. } = raw.values;
    let (mut nodes, mut temperatures, mut pressures) = (Vec::new(), Vec::new(), Vec::new());
    for i in 0..=(TOP_M / KM) as u32 {
        let height = f64::from(i) * KM;
        let end = height.min(LAYERS_END_M);
        let air = atmosphere.at(r * end / (r - end))?;
        // The molecular-scale temperature; the kinetic one is lower from 80 km on.
        let temperature = air.pressure * molar_mass / (gas_constant * air.mass_density);
        let scale_height = gas_constant * temperature / (molar_mass * gravity);
        nodes.push(height);
        temperatures.push(temperature);
        pressures.push(air.pressure * (-(height - end) / scale_height).exp());
    }
    let axis = Axis::new("altitude", "m", nodes)?.beyond(Outside::Error);
    Ok([Curve::new(axis.clone(), Scale::Linear, temperatures)?, Curve::new(axis, Scale::Linear, pressures)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn thesis() -> Thesis {
        Thesis::from_dir(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../raw-data")).expect("sound")
    }

    #[test]
    fn air_is_that_of_the_geopotential_altitude() {
        let thesis = thesis();
        // Values that stand in the code, to their digits.
        for (z, kelvin, pascal) in [(20e3, 216.65, 5474.89), (50e3, 270.65, 75.9448), (86e3, 186.946, 0.302723)] {
            let (t, p) = (thesis.temperature_k(z).expect("inside"), thesis.pressure_pa(z).expect("inside"));
            assert!((t - kelvin).abs() < 1e-3 && (p / pascal - 1.0).abs() < 2e-5, "{t} K, {p} Pa at {z} m");
        }
        assert_eq!(thesis.molecules_m3(86.1e3).expect("above"), 0.0);
        assert!(thesis.temperature_k(86.1e3).is_err());
    }

    #[test]
    fn ozone_is_ten_and_a_half_times_too_much() {
        let thesis = thesis();
        for row in &thesis.arosa.columns.rows {
            let layers = thesis.arosa.layers.rows.iter();
            let sum: f64 =
                layers.map(|l| thesis.ozone_m3(row.month, l.bottom).expect("a month") * (l.top - l.bottom)).sum();
            // 9 x 2.96 / 2.6867805 x 222 / 210.
            assert!((sum / row.column - 10.4818).abs() < 1e-4, "{}", sum / row.column);
        }
        assert!(thesis.ozone_m3(13, 0.0).is_err());
    }

    #[test]
    fn scattering_and_absorption_are_swapped() {
        let thesis = thesis();
        for row in &thesis.biomes {
            let biome = Biome::from_name(&row.biome).expect("a biome");
            let parts = thesis.particle_m2(biome, 550.0).expect("inside");
            // The file gives both for the columns as they should be, to four digits; the ripples of the single polar
            // sphere between the wavelengths that we have, every 7 nm, are worth 1.4 %.
            assert!((parts.absorption / parts.extinction() - row.albedo).abs() < 2e-3, "{biome}: {parts:?}");
            let extinction = thesis.particles_m3(biome, 0.0).expect("a biome") * parts.extinction();
            assert!((extinction / row.ground_extinction - 1.0).abs() < 0.02, "{biome}: {extinction}");
        }
    }

    #[test]
    fn the_optical_depth_is_the_sum_of_its_coefficients() {
        let thesis = thesis();
        for biome in [None, Some(Biome::Background), Some(Biome::Urban)] {
            let sum: f64 = (0..8600)
                .map(|i| {
                    let z = 5.0 + 10.0 * f64::from(i);
                    let aerosol = biome.map_or(0.0, |b| {
                        thesis.particles_m3(b, z).expect("a biome")
                            * thesis.particle_m2(b, 600.0).expect("inside").extinction()
                    });
                    let molecules =
                        thesis.molecules_m3(z).expect("inside") * thesis.rayleigh_m2(600.0).expect("inside");
                    let ozone = thesis.ozone_m3(4, z).expect("a month") * thesis.ozone_m2(600.0).expect("inside");
                    10.0 * (aerosol + molecules + ozone)
                })
                .sum();
            let depth = thesis.optical_depth(4, biome, 600.0).expect("inside");
            // The midpoint rule over 10 m of what falls by e in 730 m or more: 10^2 / (24 x 730^2) = 8e-6.
            assert!((sum / depth - 1.0).abs() < 1e-5, "{biome:?}: {sum} for {depth}");
        }
    }
}
