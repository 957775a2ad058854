//! Aerosols of OPAC: Hess, Koepke and Schult, Bull. Amer. Meteor. Soc. 79, 831 (1998).

use super::{Column, RawError, Row, Source};
use std::path::Path;
use tables::units::KM;

/// The files of `aerosol-opac-1998/`.
#[derive(Debug, Clone, PartialEq)]
pub struct AerosolOpac {
    /// Refractive indices of the materials by humidity and wavelength.
    pub refractive_index: Source<RefractiveIndex>,
    /// Size distributions of the components by humidity.
    pub components: Source<Component>,
    /// Number densities of the components in the types.
    pub types: Source<TypeShare>,
    /// Layers of the types.
    pub layers: Source<Layer>,
    /// Optics of the components, to compare with.
    pub optics: Source<ComponentOptics>,
    /// Optics of the types at sea level, to compare with.
    pub types_at_ground: Source<TypeAtGround>,
}

impl AerosolOpac {
    /// Reads the files below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self {
            refractive_index: Source::read(raw_dir, "aerosol-opac-1998/refractive-index.csv")?,
            components: Source::read(raw_dir, "aerosol-opac-1998/components.csv")?,
            types: Source::read(raw_dir, "aerosol-opac-1998/types.csv")?,
            layers: Source::read(raw_dir, "aerosol-opac-1998/layers.csv")?,
            optics: Source::read(raw_dir, "aerosol-opac-1998/optics.csv")?,
            types_at_ground: Source::read(raw_dir, "aerosol-opac-1998/types-at-ground.csv")?,
        })
    }
}

fn humidity() -> Column {
    Column::number("relative_humidity_percent", "percent", 0.0, 99.0).key()
}

/// Refractive index of a material at one humidity and wavelength.
#[derive(Debug, Clone, PartialEq)]
pub struct RefractiveIndex {
    /// Name of the material.
    pub material: String,
    /// Relative humidity, percent.
    pub humidity_percent: f64,
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// Real part.
    pub n: f64,
    /// Imaginary part; k >= 0 absorbs.
    pub k: f64,
}

impl Row for RefractiveIndex {
    type Record = (String, f64, f64, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::text("material").key(),
            humidity(),
            Column::number("wavelength_um", "um", 0.2, 40.0).key(),
            Column::number("n", "1", 0.2, 5.0),
            Column::number("k", "1", 0.0, 3.0),
        ]
    }

    fn from_record((material, humidity_percent, wavelength_um, n, k): Self::Record) -> Self {
        Self { material, humidity_percent, wavelength_nm: wavelength_um * 1e3, n, k }
    }
}

/// Log-normal size distribution of a component at one humidity.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// Name of the component, such as `waso`.
    pub component: String,
    /// Name of its material.
    pub material: String,
    /// Relative humidity, percent.
    pub humidity_percent: f64,
    /// Median radius of the number distribution, m.
    pub median_radius: f64,
    /// Geometric standard deviation, 1.
    pub sigma_g: f64,
    /// Smallest radius, m.
    pub smallest_radius: f64,
    /// Largest radius, m.
    pub largest_radius: f64,
    /// Mass density, kg m^-3.
    pub mass_density: f64,
}

impl Row for Component {
    type Record = (String, String, f64, f64, f64, f64, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::text("component").key(),
            Column::text("material"),
            humidity(),
            Column::number("r_mod_um", "um", 1e-3, 20.0),
            Column::number("sigma_g", "1", 1.0, 5.0),
            Column::number("r_min_um", "um", 1e-3, 1.0),
            Column::number("r_max_um", "um", 1.0, 100.0),
            Column::number("density_kg_m3", "kg m^-3", 500.0, 5000.0),
        ]
    }

    fn from_record(
        (component, material, humidity_percent, r_mod, sigma_g, r_min, r_max, density): Self::Record,
    ) -> Self {
        Self {
            component,
            material,
            humidity_percent,
            median_radius: r_mod * 1e-6,
            sigma_g,
            smallest_radius: r_min * 1e-6,
            largest_radius: r_max * 1e-6,
            mass_density: density,
        }
    }
}

/// Number density of one component in a type.
#[derive(Debug, Clone, PartialEq)]
pub struct TypeShare {
    /// Name of the type, such as `urban`.
    pub aerosol_type: String,
    /// Name of the component.
    pub component: String,
    /// Number density at sea level, m^-3.
    pub number_density: f64,
}

impl Row for TypeShare {
    type Record = (String, String, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::text("aerosol_type").key(),
            Column::text("component").key(),
            Column::number("number_density_cm-3", "cm^-3", 1e-4, 1e6),
        ]
    }

    fn from_record((aerosol_type, component, per_cm3): Self::Record) -> Self {
        Self { aerosol_type, component, number_density: per_cm3 * 1e6 }
    }
}

/// One layer of a type.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Name of the type.
    pub aerosol_type: String,
    /// Name of the layer: `mixing_layer`, `free_troposphere` or `stratosphere`.
    pub layer: String,
    /// Lower end, m.
    pub bottom: f64,
    /// Upper end, m.
    pub top: f64,
    /// Scale height, m; 99 km stands for a constant density.
    pub scale_height: f64,
}

impl Row for Layer {
    type Record = (String, String, f64, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::text("aerosol_type").key(),
            Column::text("layer").key(),
            Column::number("bottom_km", "km", 0.0, 50.0),
            Column::number("top_km", "km", 0.0, 50.0),
            Column::number("scale_height_km", "km", 0.1, 99.0),
        ]
    }

    fn from_record((aerosol_type, layer, bottom, top, scale_height): Self::Record) -> Self {
        Self { aerosol_type, layer, bottom: bottom * KM, top: top * KM, scale_height: scale_height * KM }
    }
}

/// Optics of a component at one humidity and wavelength, per particle.
#[derive(Debug, Clone, PartialEq)]
pub struct ComponentOptics {
    /// Name of the component.
    pub component: String,
    /// Relative humidity, percent.
    pub humidity_percent: f64,
    /// Wavelength, nm.
    pub wavelength_nm: f64,
    /// Extinction cross-section, m^2.
    pub extinction: f64,
    /// Scattering cross-section, m^2.
    pub scattering: f64,
    /// Absorption cross-section, m^2.
    pub absorption: f64,
    /// Single-scattering albedo, 1.
    pub albedo: f64,
    /// Asymmetry parameter, 1.
    pub asymmetry: f64,
}

/// km^-1 per cm^-3 in m^2: 1e-3 m^-1 over 1e6 m^-3.
const PER_KM_PER_CM3: f64 = 1e-9;

impl Row for ComponentOptics {
    type Record = (String, f64, f64, f64, f64, f64, f64, f64);

    fn columns() -> Vec<Column> {
        let unit = "km^-1 cm^3";
        vec![
            Column::text("component").key(),
            humidity(),
            Column::number("wavelength_um", "um", 0.2, 40.0).key(),
            Column::number("extinction_km-1_per_cm-3", unit, 1e-12, 10.0),
            Column::number("scattering_km-1_per_cm-3", unit, 1e-15, 10.0),
            Column::number("absorption_km-1_per_cm-3", unit, 0.0, 10.0),
            Column::number("single_scattering_albedo", "1", 0.0, 1.0),
            Column::number("asymmetry", "1", -1.0, 1.0),
        ]
    }

    fn from_record(record: Self::Record) -> Self {
        let (component, humidity_percent, wavelength_um, extinction, scattering, absorption, albedo, asymmetry) =
            record;
        Self {
            component,
            humidity_percent,
            wavelength_nm: wavelength_um * 1e3,
            extinction: extinction * PER_KM_PER_CM3,
            scattering: scattering * PER_KM_PER_CM3,
            absorption: absorption * PER_KM_PER_CM3,
            albedo,
            asymmetry,
        }
    }
}

/// Optics of a type at sea level, 550 nm and one humidity.
#[derive(Debug, Clone, PartialEq)]
pub struct TypeAtGround {
    /// Name of the type.
    pub aerosol_type: String,
    /// Relative humidity, percent.
    pub humidity_percent: f64,
    /// Extinction coefficient, m^-1.
    pub extinction: f64,
    /// Single-scattering albedo, 1.
    pub albedo: f64,
    /// Asymmetry parameter, 1.
    pub asymmetry: f64,
}

impl Row for TypeAtGround {
    type Record = (String, f64, f64, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::text("aerosol_type").key(),
            humidity(),
            Column::number("extinction_550nm_km-1", "km^-1", 1e-5, 10.0),
            Column::number("single_scattering_albedo_550nm", "1", 0.0, 1.0),
            Column::number("asymmetry_550nm", "1", -1.0, 1.0),
        ]
    }

    fn from_record((aerosol_type, humidity_percent, per_km, albedo, asymmetry): Self::Record) -> Self {
        Self { aerosol_type, humidity_percent, extinction: per_km / KM, albedo, asymmetry }
    }
}
