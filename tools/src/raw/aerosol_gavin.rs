//! What the thesis of Gavin (2020) and its code had for aerosols: to compare with, and to explain.

use super::{Column, RawError, Row, Source};
use std::path::Path;
use tables::units::KM;

/// Biomes of the thesis, in the order of the columns of the cross-sections.
pub const BIOMES: [&str; 9] = [
    "background",
    "desert-dust",
    "maritime-clean",
    "maritime-mineral",
    "polar-antarctic",
    "polar-arctic",
    "remote-continental",
    "rural",
    "urban",
];

/// The files of `aerosol-gavin-2020/`.
#[derive(Debug, Clone, PartialEq)]
pub struct AerosolGavin {
    /// Densities, scale heights and what follows from them.
    pub biomes: Source<Biome>,
    /// Cross-sections.
    pub cross_sections: Source<CrossSections>,
}

impl AerosolGavin {
    /// Reads the files below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self {
            biomes: Source::read(raw_dir, "aerosol-gavin-2020/biomes.csv")?.with_rows(BIOMES.len())?,
            cross_sections: Source::read(raw_dir, "aerosol-gavin-2020/cross-sections.csv")?,
        })
    }
}

/// Constants of one biome.
#[derive(Debug, Clone, PartialEq)]
pub struct Biome {
    /// Name.
    pub biome: String,
    /// Type of Jaenicke whose sizes it takes.
    pub jaenicke_type: String,
    /// Number density at the ground, m^-3, as printed in the code.
    pub base_density: f64,
    /// Scale height, m; none for background, which is constant.
    pub scale_height: Option<f64>,
    /// Density of the background, m^-3, as probably meant.
    pub background_density: f64,
    /// Extinction at the ground at 550 nm, m^-1, as it follows from density and cross-sections.
    pub ground_extinction: f64,
    /// Single-scattering albedo at 550 nm.
    pub albedo: f64,
}

impl Row for Biome {
    type Record = (String, String, f64, Option<f64>, f64, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::text("biome").key(),
            Column::text("jaenicke_type"),
            Column::number("base_density_cm-3", "cm^-3", 1.0, 1e6),
            Column::optional("scale_height_km", "km", 0.1, 99.0),
            Column::number("background_density_cm-3", "cm^-3", 0.0, 100.0),
            Column::number("ground_extinction_550nm_km-1", "km^-1", 1e-6, 1e5),
            Column::number("single_scattering_albedo_550nm", "1", 0.0, 1.0),
        ]
    }

    fn from_record(record: Self::Record) -> Self {
        let (biome, jaenicke_type, base, scale_height_km, background, per_km, albedo) = record;
        Self {
            biome,
            jaenicke_type,
            base_density: base * 1e6,
            scale_height: scale_height_km.map(|h| h * KM),
            background_density: background * 1e6,
            ground_extinction: per_km / KM,
            albedo,
        }
    }
}

/// Cross-sections of all biomes at one wavelength.
#[derive(Debug, Clone, PartialEq)]
pub struct CrossSections {
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// Scattering and absorption cross-section per particle of each biome of [`BIOMES`], m^2.
    pub biomes: [(f64, f64); 9],
}

impl Row for CrossSections {
    type Record = (f64, [f64; 18]);

    fn columns() -> Vec<Column> {
        let pair = |biome: &&str| {
            let [s, a] = ["scattering", "absorption"].map(|what| format!("{biome}_{what}_km2"));
            [Column::number(&s, "km^2", 0.0, 1e-10), Column::number(&a, "km^2", 0.0, 1e-10)]
        };
        let wavelength = Column::number("wavelength_nm", "nm", 250.0, 1000.0).key();
        std::iter::once(wavelength).chain(BIOMES.iter().flat_map(pair)).collect()
    }

    fn from_record((wavelength_nm, km2): Self::Record) -> Self {
        Self { wavelength_nm, biomes: std::array::from_fn(|i| (km2[2 * i] * KM * KM, km2[2 * i + 1] * KM * KM)) }
    }
}
