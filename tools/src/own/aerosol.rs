//! An aerosol of one's own: sizes, refractive indices and a vertical profile, through the same Mie solver, averages,
//! angles and error estimates as the biomes.

use super::sheet::{Order, Schema, Sheet};
use super::sun::covers;
use super::units::Quantity;
use super::{Import, OwnError, range};
use crate::aerosol::bulk::Rule;
use crate::aerosol::material::Substances;
use crate::aerosol::recipe::{Part, Particles, Profile, Recipe, SpeciesRecipe};
use crate::aerosol::size::{LogNormal, Sizes, Tabulated};
use crate::build::aerosol as build;
use crate::raw::{RawError, aerosol_opac};
use tables::Provenance;
use tables::units::{KM, TOP_ALTITUDE_M};
use tables::views::{Aerosol, Origin, REFERENCE_WAVELENGTH_NM};

/// Smallest and largest radius, m, of a mode that does not say its own.
const LIMITS: (f64, f64) = (1e-9, 100e-6);

/// By how much shares in the number may miss 1.
const SHARES: f64 = 1e-3;

const MODES: Schema = Schema {
    quantities: &[
        Quantity::MedianRadius,
        Quantity::SigmaG,
        Quantity::Particles,
        Quantity::Share,
        Quantity::SmallestRadius,
        Quantity::LargestRadius,
    ],
    words: Some("material"),
    sorted_by: &[],
    remedy: "",
    most_rows: 100,
};

const SIZES: Schema = Schema {
    quantities: &[Quantity::Radius, Quantity::PerLnRadius, Quantity::PerRadius],
    words: None,
    sorted_by: &[(Quantity::Radius, Order::Up)],
    remedy: "give each radius once, smallest first",
    most_rows: 10_000,
};

const INDEX: Schema = Schema {
    quantities: &[Quantity::Wavelength, Quantity::RealIndex, Quantity::ImaginaryIndex],
    words: None,
    sorted_by: &[(Quantity::Wavelength, Order::Up)],
    remedy: "give each wavelength once, shortest first",
    most_rows: 100_000,
};

const VERTICAL: Schema = Schema {
    quantities: &[Quantity::Altitude, Quantity::Particles, Quantity::Relative],
    words: None,
    sorted_by: &[(Quantity::Altitude, Order::Up)],
    remedy: "give each altitude once, lowest first",
    most_rows: 100_000,
};

/// Log-normal modes.
#[derive(Debug, Clone, PartialEq)]
pub struct Modes {
    /// The file.
    pub provenance: Provenance,
    /// The modes.
    pub modes: Vec<Mode>,
    /// Whether their amounts are number densities in m^-3; else shares that add up to 1.
    pub absolute: bool,
}

/// One log-normal mode.
#[derive(Debug, Clone, PartialEq)]
pub struct Mode {
    /// Its sizes.
    pub sizes: LogNormal,
    /// Its number density in m^-3, or its share in the number.
    pub amount: f64,
    /// Name of its material; the only one if it has none.
    pub material: Option<String>,
}

impl Modes {
    /// Reads the bytes of a file called `name`: one mode a row, with median radius (um, nm) or diameter, `sigma_g`, and
    /// number density (cm^-3, m^-3) or share in the number; possibly the smallest and largest radius (else 0.001 and
    /// 100 um) and a column `material`. Columns called as one of `ignored` are left out.
    ///
    /// # Errors
    /// [`RawError`] with the file, line and column of the first thing that is wrong.
    pub fn parse(name: &str, bytes: &[u8], ignored: &[String]) -> Result<Self, RawError> {
        let sheet = Sheet::parse(name, bytes, ignored, &MODES)?;
        let (_, medians) = sheet.one_of(&[Quantity::MedianRadius])?;
        let (_, sigmas) = sheet.one_of(&[Quantity::SigmaG])?;
        let (amount, amounts) = sheet.one_of(&[Quantity::Particles, Quantity::Share])?;
        let limit = |quantity, row: usize, usual: f64| sheet.column(quantity).map_or(usual, |column| column[row]);
        let mut modes = Vec::with_capacity(sheet.rows());
        for (row, ((&median, &sigma_g), &amount)) in medians.iter().zip(sigmas).zip(amounts).enumerate() {
            let smallest = limit(Quantity::SmallestRadius, row, LIMITS.0);
            let largest = limit(Quantity::LargestRadius, row, LIMITS.1);
            let sizes = LogNormal::new(median, sigma_g, smallest, largest).map_err(|_| {
                let found = format!("{:e} to {:e} um", smallest * 1e6, largest * 1e6);
                sheet.wrong_at(row, Quantity::LargestRadius, "a largest radius above the smallest", found)
            })?;
            let material = sheet.words().get(row).filter(|word| !word.is_empty()).cloned();
            modes.push(Mode { sizes, amount, material });
        }
        let whole: f64 = amounts.iter().sum();
        let absolute = amount == Quantity::Particles;
        if absolute && whole <= 0.0 {
            return Err(sheet.wrong("particles", "no number density above 0"));
        }
        if !absolute && (whole - 1.0).abs() > SHARES {
            return Err(sheet.wrong("shares in the number that add up to 1", format!("{whole}")));
        }
        Ok(Self { provenance: sheet.provenance, modes, absolute })
    }
}

/// A measured size distribution.
#[derive(Debug, Clone, PartialEq)]
pub struct Distribution {
    /// The file.
    pub provenance: Provenance,
    /// The distribution of one particle; [`Tabulated::number`] is the number density in m^-3.
    pub sizes: Tabulated,
}

impl Distribution {
    /// Reads the bytes of a file called `name`: radius (um, nm) or diameter, growing, and one of `dn_dlogr` (decadic),
    /// `dn_dlnr` (cm^-3, m^-3) and `dn_dr` (cm^-3 um^-1), or the same by diameter. Columns called as one of `ignored`
    /// are left out.
    ///
    /// # Errors
    /// [`RawError`] with the file, line and column of the first thing that is wrong.
    pub fn parse(name: &str, bytes: &[u8], ignored: &[String]) -> Result<Self, RawError> {
        let sheet = Sheet::parse(name, bytes, ignored, &SIZES)?;
        let (_, radii) = sheet.one_of(&[Quantity::Radius])?;
        let density = match sheet.one_of(&[Quantity::PerLnRadius, Quantity::PerRadius])? {
            (Quantity::PerRadius, values) => radii.iter().zip(values).map(|(r, n)| r * n).collect(),
            (_, values) => values.to_vec(),
        };
        let sizes = Tabulated::new(radii, &density)
            .map_err(|_| sheet.wrong("two radii or more with particles", "too few radii or no particles"))?;
        Ok(Self { sizes, provenance: sheet.provenance })
    }
}

/// A refractive index n + ik.
#[derive(Debug, Clone, PartialEq)]
pub struct Index {
    /// The file.
    pub provenance: Provenance,
    wavelengths_nm: Vec<f64>,
    n: Vec<f64>,
    k: Vec<f64>,
}

impl Index {
    /// Reads the bytes of a file called `name`: wavelength (nm, um) from 300 nm or less to 1000 nm or more, `n`, and
    /// `k` >= 0. Columns called as one of `ignored` are left out.
    ///
    /// # Errors
    /// [`RawError`] with the file, line and column of the first thing that is wrong.
    pub fn parse(name: &str, bytes: &[u8], ignored: &[String]) -> Result<Self, RawError> {
        let sheet = Sheet::parse(name, bytes, ignored, &INDEX)?;
        let (_, wavelengths) = sheet.one_of(&[Quantity::Wavelength])?;
        let (_, n) = sheet.one_of(&[Quantity::RealIndex])?;
        let (_, k) = sheet.one_of(&[Quantity::ImaginaryIndex])?;
        covers(&sheet, wavelengths)?;
        let (wavelengths_nm, n, k) = (wavelengths.to_vec(), n.to_vec(), k.to_vec());
        Ok(Self { wavelengths_nm, n, k, provenance: sheet.provenance })
    }

    fn rows(&self, material: &str) -> impl Iterator<Item = aerosol_opac::RefractiveIndex> {
        self.wavelengths_nm.iter().zip(&self.n).zip(&self.k).map(move |((&wavelength_nm, &n), &k)| {
            aerosol_opac::RefractiveIndex { material: material.into(), humidity_percent: 0.0, wavelength_nm, n, k }
        })
    }
}

/// A vertical profile.
#[derive(Debug, Clone, PartialEq)]
pub struct Vertical {
    /// The file.
    pub provenance: Provenance,
    /// Whether its values are number densities in m^-3; else they are relative to the ground.
    pub absolute: bool,
    altitudes: Vec<f64>,
    values: Vec<f64>,
}

impl Vertical {
    /// Reads the bytes of a file called `name`: altitude (m, km), growing, and number density (cm^-3, m^-3) or an amount
    /// `relative` to that at the ground (1, percent), such as a profile of extinction. Columns called as one of
    /// `ignored` are left out. The first value, which is not 0, holds down to the ground.
    ///
    /// # Errors
    /// [`RawError`] with the file, line and column of the first thing that is wrong.
    pub fn parse(name: &str, bytes: &[u8], ignored: &[String]) -> Result<Self, RawError> {
        let sheet = Sheet::parse(name, bytes, ignored, &VERTICAL)?;
        let (_, altitudes) = sheet.one_of(&[Quantity::Altitude])?;
        let (quantity, values) = sheet.one_of(&[Quantity::Particles, Quantity::Relative])?;
        if values[0] <= 0.0 {
            let expected = "more than 0 at the lowest altitude, which holds down to the ground";
            return Err(sheet.wrong_at(0, quantity, expected, "0"));
        }
        let (mut altitudes, mut values) = (altitudes.to_vec(), values.to_vec());
        if altitudes[0] > 0.0 {
            altitudes.insert(0, 0.0);
            values.insert(0, values[0]);
        }
        if altitudes.len() < 2 {
            return Err(sheet.wrong("two altitudes at least", "the ground alone"));
        }
        Ok(Self { absolute: quantity == Quantity::Particles, altitudes, values, provenance: sheet.provenance })
    }
}

/// Which sizes.
#[derive(Debug, Clone, PartialEq)]
pub enum OwnSizes {
    /// Log-normal modes.
    Modes(Modes),
    /// A measured distribution.
    Distribution(Distribution),
}

/// Where the particles are.
#[derive(Debug, Clone, PartialEq)]
pub enum OwnProfile {
    /// exp(-z / scale height) from the ground to a top, both in m; a scale height of 99 km stands for a constant.
    Exponential {
        /// Scale height, m.
        scale_height: f64,
        /// Top, m.
        top: f64,
    },
    /// As measured.
    Levels(Vertical),
}

/// An aerosol of one's own.
#[derive(Debug, Clone, PartialEq)]
pub struct OwnAerosol {
    /// Its name.
    pub name: String,
    /// The sizes of its particles.
    pub sizes: OwnSizes,
    /// Refractive indices by the name of their material. A single one stands for every mode without a material.
    pub indices: Vec<(String, Index)>,
    /// Where they are.
    pub profile: OwnProfile,
    /// Number density at the ground in m^-3, where neither modes nor profile have it.
    pub number_density: Option<f64>,
}

impl OwnAerosol {
    /// The refractive indices as the optics take them.
    fn rows(&self) -> Vec<aerosol_opac::RefractiveIndex> {
        self.indices.iter().flat_map(|(material, index)| index.rows(material)).collect()
    }

    fn material(&self, name: Option<&str>) -> Result<String, OwnError> {
        let known: Vec<&str> = self.indices.iter().map(|(known, _)| known.as_str()).collect();
        match (name, &known[..]) {
            (None, [only]) => Ok((*only).into()),
            (Some(name), _) if known.contains(&name) => Ok(name.into()),
            (None, _) => {
                let text = format!("which of the materials {} the particles are of is not said", known.join(", "));
                Err(OwnError::Refused(text))
            }
            (Some(name), _) => {
                let text = format!("material {name:?} has no refractive index; there are {}", known.join(", "));
                Err(OwnError::Refused(text))
            }
        }
    }

    /// The particles with their shares in the number, which add up to 1.
    fn particles(&self) -> Result<Vec<(Particles, f64)>, OwnError> {
        let of = |sizes: Sizes, material: Option<&str>| -> Result<Particles, OwnError> {
            Ok(Particles { material: self.material(material)?, humidity_percent: 0.0, sizes })
        };
        match &self.sizes {
            OwnSizes::Distribution(distribution) => Ok(vec![(of(distribution.sizes.clone().into(), None)?, 1.0)]),
            OwnSizes::Modes(Modes { modes, .. }) => {
                let whole: f64 = modes.iter().map(|mode| mode.amount).sum();
                let some = modes.iter().filter(|mode| mode.amount > 0.0);
                some.map(|m| Ok((of(m.sizes.into(), m.material.as_deref())?, m.amount / whole))).collect()
            }
        }
    }

    /// The number density at the ground in m^-3, from the one place that says it; a measured distribution gives way to
    /// whoever says another.
    fn number(&self) -> Result<f64, OwnError> {
        let refuse = |text: &str| Err(OwnError::Refused(text.into()));
        let of_profile = match &self.profile {
            OwnProfile::Levels(vertical) if vertical.absolute => Some(vertical.values[0]),
            _ => None,
        };
        if let Some(number) = self.number_density {
            range("number-density", number * 1e-6, 1e-6, 1e7, " cm^-3")?;
        }
        match (of_profile, self.number_density, &self.sizes) {
            (Some(_), Some(_), _) => refuse("the profile has number densities: leave out --number-density"),
            (None, Some(_), OwnSizes::Modes(modes)) if modes.absolute => {
                refuse("the modes have number densities: leave out --number-density")
            }
            (Some(number), None, _) | (None, Some(number), _) => Ok(number),
            (None, None, OwnSizes::Distribution(distribution)) => Ok(distribution.sizes.number()),
            (None, None, OwnSizes::Modes(Modes { modes, absolute: true, .. })) => {
                Ok(modes.iter().map(|mode| mode.amount).sum())
            }
            (None, None, OwnSizes::Modes(_)) => {
                refuse("the modes have shares only: say how many particles with --number-density")
            }
        }
    }

    fn vertical(&self) -> Result<Profile, OwnError> {
        match &self.profile {
            OwnProfile::Exponential { scale_height, top } => {
                range("scale-height", scale_height / KM, 0.05, 99.0, " km")?;
                range("top", top / KM, 0.05, TOP_ALTITUDE_M / KM, " km")?;
                Ok(Profile::Layer { bottom: 0.0, top: *top, scale_height: *scale_height })
            }
            OwnProfile::Levels(vertical) => {
                let ground = if vertical.absolute { vertical.values[0] } else { 1.0 };
                let relative = vertical.values.iter().map(|value| value / ground).collect();
                Ok(Profile::Levels { altitudes: vertical.altitudes.clone(), relative })
            }
        }
    }
}

/// Six significant digits, for people.
fn six_digits(x: f64) -> f64 {
    format!("{x:.5e}").parse().unwrap_or(x)
}

/// The table of an aerosol: one dry species, with the axes, angles and error estimates of the biomes.
///
/// # Errors
/// [`OwnError`] if its parts do not go together, or a sphere cannot be solved.
pub fn table(own: &OwnAerosol) -> Result<Import, OwnError> {
    if own.name.trim().is_empty() || own.name.len() > 64 {
        return Err(OwnError::Refused("an aerosol needs a name of 1 to 64 bytes".into()));
    }
    let (particles, number) = (own.particles()?, own.number()?);
    let used = |material: &str| particles.iter().any(|(one, _)| one.material == material);
    if let Some((material, _)) = own.indices.iter().find(|(material, _)| !used(material)) {
        return Err(OwnError::Refused(format!("there is a refractive index of {material:?}, but no particles of it")));
    }
    let modes = particles.len();
    let species = SpeciesRecipe {
        name: "aerosol",
        parts: particles.into_iter().map(|(one, share)| (Part::Mode(one), share * number)).collect(),
        profile: own.vertical()?,
        humidities: vec![0.0],
        default_humidity: 0.0,
    };
    let sizes = match &own.sizes {
        OwnSizes::Modes(_) => format!("{modes} log-normal modes"),
        OwnSizes::Distribution(_) => "a size distribution as measured, power laws between its radii".into(),
    };
    let materials: Vec<&str> = own.indices.iter().map(|(name, _)| name.as_str()).collect();
    let composition = format!("{sizes} of {}", materials.join(", "));
    let recipe = Recipe { origin: Origin::Own(own.name.clone()), composition, species: vec![species] };
    let rows = own.rows();
    let substances = Substances { indices: &rows, components: &[] };
    let prepared = build::prepare(substances, std::slice::from_ref(&recipe), &Rule::TABLES)?;
    let mut provenance = vec![match &own.sizes {
        OwnSizes::Modes(modes) => modes.provenance.clone(),
        OwnSizes::Distribution(distribution) => distribution.provenance.clone(),
    }];
    provenance.extend(own.indices.iter().map(|(_, index)| index.provenance.clone()));
    if let OwnProfile::Levels(vertical) = &own.profile {
        provenance.push(vertical.provenance.clone());
    }
    let table = build::table(substances, &prepared, &recipe, provenance)?;
    let seen = Aerosol::from_table(&table)?;
    let optics = seen.species[0].optics(0.0, REFERENCE_WAVELENGTH_NM)?;
    let notes = vec![
        format!(
            "{} particles per cm3 at the ground, optical depth {:.4} at 550 nm, extinction at the ground {:.4} per km",
            six_digits(number * 1e-6),
            seen.own_optical_depth()?,
            seen.ground_extinction(None, REFERENCE_WAVELENGTH_NM)? * KM
        ),
        format!(
            "single-scattering albedo {:.4}, asymmetry {:.4}; quadrature error of a cross-section at most {}",
            optics.scattering_m2 / optics.extinction_m2,
            optics.asymmetry,
            table.settings.get("largest quadrature error of a cross-section").map_or("unknown", String::as_str)
        ),
    ];
    Ok(Import { table, notes })
}
