//! What each biome is made of: particles, amounts, profiles. `docs/aerosols.md` gives the reasons.

use super::AerosolError;
use super::material::Substances;
use super::size::{LogNormal, Sizes};
use crate::raw::aerosol_jaenicke::AerosolJaenicke;
use crate::raw::aerosol_opac::AerosolOpac;
use tables::units::KM;
use tables::views::{AerosolSource, Biome, Origin};
use tables::{Axis, Curve, Outside, Scale, TableError};

/// Relative humidities of the OPAC data, percent.
pub const HUMIDITIES: [f64; 8] = [0.0, 50.0, 70.0, 80.0, 90.0, 95.0, 98.0, 99.0];

/// Smallest radius of Jaenicke's distributions, m: below, a sphere contributes less than 1e-6 of a mode.
const JAENICKE_SMALLEST: f64 = 1e-9;

/// Largest radius of Jaenicke's distributions, m: OPAC's for dry coarse particles. The second mode of desert dust is so
/// wide that its extinction depends on it: 1.06, 1.63, 1.91 and 2.22 km^-1 at 550 nm with 20, 60, 100 and 200 um.
const JAENICKE_LARGEST: f64 = 60e-6;

/// Particles of one material and size distribution.
#[derive(Debug, Clone, PartialEq)]
pub struct Particles {
    /// Name of the material.
    pub material: String,
    /// Relative humidity of its refractive index, percent.
    pub humidity_percent: f64,
    /// Their sizes.
    pub sizes: Sizes,
}

/// A share of a species.
#[derive(Debug, Clone, PartialEq)]
pub enum Part {
    /// A component of OPAC by name, which takes up water if its data say so.
    Component(String),
    /// Particles as they are, dry.
    Mode(Particles),
}

/// Number density against altitude, relative to that at sea level.
#[derive(Debug, Clone, PartialEq)]
pub enum Profile {
    /// exp(-z / scale_height) from `bottom` to `top` (m), nothing outside; the density at sea level is the
    /// factor also where the layer begins higher. A scale height of 99 km stands for a constant.
    Layer {
        /// Lower end, m.
        bottom: f64,
        /// Upper end, m.
        top: f64,
        /// Scale height, m.
        scale_height: f64,
    },
    /// Equation 3.9 of the thesis: exp(-z / scale_height) + floor, from the ground to `top` (m).
    Floor {
        /// Scale height, m.
        scale_height: f64,
        /// Background over the density N(0) of the formula.
        floor: f64,
        /// Upper end, m.
        top: f64,
    },
    /// Values at some altitudes; their logarithms are linear between them, or they themselves if one is zero.
    /// Nothing outside.
    Levels {
        /// Altitudes, m.
        altitudes: Vec<f64>,
        /// Number density relative to that at sea level, 1.
        relative: Vec<f64>,
    },
}

/// One species of a biome.
#[derive(Debug, Clone, PartialEq)]
pub struct SpeciesRecipe {
    /// Name in the table.
    pub name: &'static str,
    /// Number densities at sea level (m^-3) of its parts.
    pub parts: Vec<(Part, f64)>,
    /// Profile of all of them.
    pub profile: Profile,
    /// Relative humidities of its table, percent.
    pub humidities: Vec<f64>,
    /// Relative humidity by default, one of these.
    pub default_humidity: f64,
}

/// The aerosol of a biome, or somebody's own.
#[derive(Debug, Clone, PartialEq)]
pub struct Recipe {
    /// Where it comes from.
    pub origin: Origin,
    /// In words, for the table's settings.
    pub composition: String,
    /// Its species, lowest first.
    pub species: Vec<SpeciesRecipe>,
}

/// The raw data that recipes need.
#[derive(Debug, Clone, Copy)]
pub struct Inputs<'a> {
    /// Components, types, layers, refractive indices.
    pub opac: &'a AerosolOpac,
    /// Modes.
    pub jaenicke: &'a AerosolJaenicke,
}

fn missing(what: String) -> AerosolError {
    AerosolError::Missing { what }
}

impl Part {
    /// The particles of this part at a relative humidity of [`HUMIDITIES`]; dry ones where it takes up no water.
    ///
    /// # Errors
    /// [`AerosolError`] if the data lack the component.
    pub fn particles<'a>(
        &self,
        substances: impl Into<Substances<'a>>,
        humidity_percent: f64,
    ) -> Result<Particles, AerosolError> {
        let name = match self {
            Self::Mode(particles) => return Ok(particles.clone()),
            Self::Component(name) => name,
        };
        let components = substances.into().components;
        let at = |humidity: f64| components.iter().find(|c| c.component == *name && c.humidity_percent == humidity);
        let grows = components.iter().any(|c| c.component == *name && c.humidity_percent > 0.0);
        let row = at(if grows { humidity_percent } else { 0.0 })
            .ok_or_else(|| missing(format!("component {name} at {humidity_percent} % humidity")))?;
        Ok(Particles {
            material: row.material.clone(),
            humidity_percent: row.humidity_percent,
            sizes: LogNormal::new(row.median_radius, row.sigma_g, row.smallest_radius, row.largest_radius)?.into(),
        })
    }
}

/// Every kind of particles that these recipes need at the humidities (percent) that `of` chooses.
///
/// # Errors
/// As [`Part::particles`].
pub fn particles<'a, 's>(
    substances: impl Into<Substances<'s>>,
    recipes: &'a [Recipe],
    of: impl Fn(&'a SpeciesRecipe) -> &'a [f64],
) -> Result<Vec<Particles>, AerosolError> {
    let substances = substances.into();
    let mut all = Vec::new();
    for species in recipes.iter().flat_map(|recipe| &recipe.species) {
        for &humidity in of(species) {
            for (part, _) in &species.parts {
                all.push(part.particles(substances, humidity)?);
            }
        }
    }
    Ok(all)
}

impl Profile {
    /// The number density in m^-3 against altitude in m, for a density `at_sea_level`.
    ///
    /// A layer's logarithm is linear, so two nodes are exact. Equation 3.9 has ten nodes in each scale height
    /// up to the twelfth and one at its top: logarithmic interpolation is high by at most 1.3e-3, where the
    /// density has fallen to a few floors.
    ///
    /// # Errors
    /// [`TableError`] if the numbers make no curve.
    pub fn curve(&self, axis: &str, at_sea_level: f64) -> Result<Curve, TableError> {
        let (nodes, density): (Vec<f64>, Box<dyn Fn(f64) -> f64>) = match *self {
            Self::Levels { ref altitudes, ref relative } => {
                let values: Vec<f64> = relative.iter().map(|value| at_sea_level * value).collect();
                let scale = if values.contains(&0.0) { Scale::Linear } else { Scale::Logarithmic };
                return Curve::new(Axis::new(axis, "m", altitudes.clone())?.beyond(Outside::Zero), scale, values);
            }
            Self::Layer { bottom, top, scale_height } if scale_height >= 99.0 * KM => {
                (vec![bottom, top], Box::new(move |_| 1.0))
            }
            Self::Layer { bottom, top, scale_height } => {
                (vec![bottom, top], Box::new(move |z: f64| (-z / scale_height).exp()))
            }
            Self::Floor { scale_height, floor, top } => {
                let mut nodes: Vec<f64> = (0..=120).map(|i| f64::from(i) * 0.1 * scale_height).collect();
                nodes.retain(|z| *z < top);
                nodes.push(top);
                (nodes, Box::new(move |z: f64| (-z / scale_height).exp() + floor))
            }
        };
        let values = nodes.iter().map(|&z| at_sea_level * density(z)).collect();
        Curve::new(Axis::new(axis, "m", nodes)?.beyond(Outside::Zero), Scale::Logarithmic, values)
    }
}

/// The recipe of a biome after a source.
///
/// # Errors
/// [`AerosolError::Missing`] if the data lack a type, layer or mode.
pub fn recipe(inputs: Inputs, source: AerosolSource, biome: Biome) -> Result<Recipe, AerosolError> {
    match source {
        AerosolSource::Opac => opac(inputs.opac, biome),
        AerosolSource::Jaenicke => jaenicke(inputs, biome),
    }
}

/// The type of OPAC that stands for a biome; background is the free troposphere down to the ground.
#[must_use]
pub fn opac_type(biome: Biome) -> &'static str {
    match biome {
        Biome::Background => "free_troposphere",
        Biome::DesertDust => "desert",
        Biome::MaritimeClean => "maritime_clean",
        Biome::MaritimeMineral => "maritime_tropical",
        Biome::PolarAntarctic => "antarctic",
        Biome::PolarArctic => "arctic",
        Biome::RemoteContinental => "continental_clean",
        Biome::Rural => "continental_average",
        Biome::Urban => "urban",
    }
}

/// Transported mineral (OPAC's `mitr`) over the sea in maritime-mineral: number density at sea level, m^-3.
const TRANSPORTED_MINERAL: f64 = 10e6;

/// Its profile: that of OPAC's desert layer, over which it came.
const TRANSPORTED_LAYER: Profile = Profile::Layer { bottom: 0.0, top: 6.0 * KM, scale_height: 2.0 * KM };

/// The layers of one type of OPAC: of the type itself, of the free troposphere and of the stratosphere above.
///
/// # Errors
/// [`AerosolError::Missing`].
pub fn opac_species(opac: &AerosolOpac, aerosol_type: &str) -> Result<Vec<SpeciesRecipe>, AerosolError> {
    Ok(vec![
        layer(opac, "boundary_layer", aerosol_type, profile(opac, aerosol_type, "mixing_layer")?, Some(80.0))?,
        free_troposphere(opac, profile(opac, aerosol_type, "free_troposphere")?)?,
        stratosphere(opac, profile(opac, aerosol_type, "stratosphere")?)?,
    ])
}

fn opac(opac: &AerosolOpac, biome: Biome) -> Result<Recipe, AerosolError> {
    let name = opac_type(biome);
    let mut composition = format!("OPAC type {name}, free troposphere and stratosphere above");
    let species = match biome {
        Biome::Background => {
            composition = "OPAC free troposphere from the ground to 12 km, stratosphere above".into();
            let profile = Profile::Layer { bottom: 0.0, top: 12.0 * KM, scale_height: 8.0 * KM };
            let mut lower = layer(opac, "free_troposphere", name, profile, Some(50.0))?;
            lower.default_humidity = 50.0;
            vec![lower, stratosphere(opac, high_layer())?]
        }
        Biome::MaritimeMineral => {
            composition = format!(
                "OPAC type {name} and transported mineral, {} cm^-3 at sea level, scale height 2 km, up to 6 km",
                TRANSPORTED_MINERAL * 1e-6
            );
            let mut species = opac_species(opac, name)?;
            let part = (Part::Component("mitr".into()), TRANSPORTED_MINERAL);
            let (humidities, default_humidity) = (vec![0.0], 0.0);
            let name = "transported_mineral";
            species.insert(
                1,
                SpeciesRecipe { name, parts: vec![part], profile: TRANSPORTED_LAYER, humidities, default_humidity },
            );
            species
        }
        _ => opac_species(opac, name)?,
    };
    Ok(Recipe { origin: Origin::Biome(AerosolSource::Opac, biome), composition, species })
}

/// The stratosphere of OPAC above the background.
fn high_layer() -> Profile {
    Profile::Layer { bottom: 12.0 * KM, top: 35.0 * KM, scale_height: 99.0 * KM }
}

fn free_troposphere(opac: &AerosolOpac, profile: Profile) -> Result<SpeciesRecipe, AerosolError> {
    let mut species = layer(opac, "free_troposphere", "free_troposphere", profile, None)?;
    (species.humidities, species.default_humidity) = (vec![50.0], 50.0);
    Ok(species)
}

fn stratosphere(opac: &AerosolOpac, profile: Profile) -> Result<SpeciesRecipe, AerosolError> {
    layer(opac, "stratosphere", "stratosphere", profile, None)
}

/// The components of a type in one layer; at every humidity if one is the default, else dry.
fn layer(
    opac: &AerosolOpac,
    name: &'static str,
    aerosol_type: &str,
    profile: Profile,
    default_humidity: Option<f64>,
) -> Result<SpeciesRecipe, AerosolError> {
    let shares = opac.types.rows.iter().filter(|row| row.aerosol_type == aerosol_type);
    let parts: Vec<_> = shares.map(|row| (Part::Component(row.component.clone()), row.number_density)).collect();
    if parts.is_empty() {
        return Err(missing(format!("aerosol type {aerosol_type}")));
    }
    let humidities = if default_humidity.is_some() { HUMIDITIES.to_vec() } else { vec![0.0] };
    Ok(SpeciesRecipe { name, parts, profile, humidities, default_humidity: default_humidity.unwrap_or(0.0) })
}

fn profile(opac: &AerosolOpac, aerosol_type: &str, layer: &str) -> Result<Profile, AerosolError> {
    let row = opac.layers.rows.iter().find(|row| row.aerosol_type == aerosol_type && row.layer == layer);
    let row = row.ok_or_else(|| missing(format!("layer {layer} of aerosol type {aerosol_type}")))?;
    Ok(Profile::Layer { bottom: row.bottom, top: row.top, scale_height: row.scale_height })
}

/// What a biome of the thesis is made of: type of Jaenicke, shares of materials in the number, scale height in m.
pub(super) struct ThesisBiome {
    pub(super) jaenicke_type: &'static str,
    pub(super) materials: &'static [(&'static str, f64)],
    scale_height: Option<f64>,
}

/// Shares as recovered from the tables of the thesis' code by least squares, made to add up to 1.
pub(super) fn thesis_biome(biome: Biome) -> ThesisBiome {
    let (jaenicke_type, materials, scale_height): (_, &'static [(&str, f64)], _) = match biome {
        Biome::Background => ("background", &[("sulfate", 1.0)], None),
        Biome::DesertDust => ("desert_dust_storm", &[("mineral", 1.0)], Some(2.0 * KM)),
        Biome::MaritimeClean => ("maritime", &[("sulfate", 0.9), ("sea_salt", 0.1)], Some(0.9 * KM)),
        Biome::MaritimeMineral => ("maritime", &[("sea_salt", 0.54), ("soot", 0.46)], Some(2.0 * KM)),
        Biome::PolarAntarctic => ("polar", &[("sulfate", 0.995), ("mineral", 0.005)], Some(30.0 * KM)),
        Biome::PolarArctic => ("polar", &[("sea_salt", 0.49), ("mineral", 0.255), ("soot", 0.255)], Some(30.0 * KM)),
        Biome::RemoteContinental => ("remote_continental", &[("water_soluble", 1.0)], Some(0.73 * KM)),
        Biome::Rural => ("rural", &[("water_soluble", 0.94), ("soot", 0.06)], Some(0.73 * KM)),
        Biome::Urban => ("urban", &[("water_soluble", 0.59), ("soot", 0.41)], Some(0.73 * KM)),
    };
    ThesisBiome { jaenicke_type, materials, scale_height }
}

/// The background N_b of equation 3.9, 2 cm^-3 in m^-3.
const THESIS_BACKGROUND: f64 = 2e6;

/// The top of the atmosphere of the thesis, m.
const THESIS_TOP: f64 = 86.0 * KM;

fn jaenicke(inputs: Inputs, biome: Biome) -> Result<Recipe, AerosolError> {
    let ThesisBiome { jaenicke_type, materials, scale_height } = thesis_biome(biome);
    let mut parts = Vec::new();
    for mode in inputs.jaenicke.modes.rows.iter().filter(|mode| mode.aerosol_type == jaenicke_type) {
        for (material, share) in materials {
            let sigma_g = 10.0_f64.powf(mode.log10_sigma);
            let sizes = LogNormal::new(mode.median_radius, sigma_g, JAENICKE_SMALLEST, JAENICKE_LARGEST)?;
            let particles = Particles { material: (*material).to_owned(), humidity_percent: 0.0, sizes: sizes.into() };
            parts.push((Part::Mode(particles), mode.number_density * share));
        }
    }
    if parts.is_empty() {
        return Err(missing(format!("type {jaenicke_type} of Jaenicke")));
    }
    let at_ground: f64 = parts.iter().map(|(_, number)| number).sum();
    let profile = match scale_height {
        Some(scale_height) => Profile::Floor { scale_height, floor: THESIS_BACKGROUND / at_ground, top: THESIS_TOP },
        None => Profile::Layer { bottom: 0.0, top: 12.0 * KM, scale_height: 8.0 * KM },
    };
    let mut species =
        vec![SpeciesRecipe { name: "aerosol", parts, profile, humidities: vec![0.0], default_humidity: 0.0 }];
    if scale_height.is_none() {
        species.push(stratosphere(inputs.opac, high_layer())?);
    }
    let shares: Vec<String> = materials.iter().map(|(material, share)| format!("{share} {material}")).collect();
    let composition = format!("Jaenicke's {jaenicke_type}, dry, in the number {}", shares.join(" + "));
    Ok(Recipe { origin: Origin::Biome(AerosolSource::Jaenicke, biome), composition, species })
}
