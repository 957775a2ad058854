//! Aerosol: what there is in each biome, how much of it where, and how it scatters and absorbs.

use super::angles::Angles;
use super::{WAVELENGTH, bounded, scalar};
use crate::{Axis, Curve, Field, Interpolation, Kind, Outside, Scale, Table, TableError, excerpt};
use std::fmt;
use std::sync::Arc;

/// The axis of the cosine of the scattering angle, from -1 (backward) to 1 (forward).
pub const COSINE: (&str, &str) = ("cosine", "1");

/// Wavelength in nm at which an amount of aerosol is stated.
pub const REFERENCE_WAVELENGTH_NM: f64 = 550.0;

/// By how much the integral of a phase function on curved axes may miss 1.
const CURVED_INTEGRAL: f64 = 2e-3;

/// The kinds of place that have an aerosol of their own.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "the names say it; docs/aerosols.md has what each is made of")]
pub enum Biome {
    Background,
    DesertDust,
    MaritimeClean,
    MaritimeMineral,
    PolarAntarctic,
    PolarArctic,
    RemoteContinental,
    Rural,
    Urban,
}

impl Biome {
    /// Every biome, in the order of their names.
    pub const ALL: [Self; 9] = [
        Self::Background,
        Self::DesertDust,
        Self::MaritimeClean,
        Self::MaritimeMineral,
        Self::PolarAntarctic,
        Self::PolarArctic,
        Self::RemoteContinental,
        Self::Rural,
        Self::Urban,
    ];

    /// Its name in flags and files, such as `desert-dust`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Background => "background",
            Self::DesertDust => "desert-dust",
            Self::MaritimeClean => "maritime-clean",
            Self::MaritimeMineral => "maritime-mineral",
            Self::PolarAntarctic => "polar-antarctic",
            Self::PolarArctic => "polar-arctic",
            Self::RemoteContinental => "remote-continental",
            Self::Rural => "rural",
            Self::Urban => "urban",
        }
    }

    /// The biome of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|biome| biome.name() == name)
    }
}

impl fmt::Display for Biome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Whose size distributions and mixtures an aerosol has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum AerosolSource {
    /// Hess, Koepke and Schult 1998: the type nearest to the biome, with humidity; plausible by day.
    Opac,
    /// Jaenicke 1993, as in the thesis, dry; hazy.
    Jaenicke,
}

impl AerosolSource {
    /// Both, the default first.
    pub const ALL: [Self; 2] = [Self::Opac, Self::Jaenicke];

    /// Its name in flags and files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Opac => "opac",
            Self::Jaenicke => "jaenicke",
        }
    }

    /// The source of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|source| source.name() == name)
    }
}

impl fmt::Display for AerosolSource {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Where an aerosol comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// A biome after a source.
    Biome(AerosolSource, Biome),
    /// Somebody's own, by a name of theirs.
    Own(String),
}

/// The setting `source` of an aerosol that is somebody's own.
const OWN: &str = "own";

impl Origin {
    /// The settings of its table: `source` and `biome`, or `source` (`own`) and `name`.
    #[must_use]
    pub fn settings(&self) -> [(&'static str, String); 2] {
        match self {
            Self::Biome(source, biome) => [("source", source.to_string()), ("biome", biome.to_string())],
            Self::Own(name) => [("source", OWN.into()), ("name", name.clone())],
        }
    }

    /// The origin that a table's settings say.
    fn from_table(table: &Table) -> Result<Self, TableError> {
        let setting = |key: &'static str| {
            let missing = || TableError::Missing { what: "setting", name: key.into(), kind: table.kind.to_string() };
            table.settings.get(key).map(String::as_str).ok_or_else(missing)
        };
        let unknown =
            |key: &str, name: &str| TableError::Inconsistent(format!("no {key} is called {:?}", excerpt(name)));
        let source = setting("source")?;
        if source == OWN {
            return Ok(Self::Own(setting("name")?.into()));
        }
        let biome = setting("biome")?;
        Ok(Self::Biome(
            AerosolSource::from_name(source).ok_or_else(|| unknown("source", source))?,
            Biome::from_name(biome).ok_or_else(|| unknown("biome", biome))?,
        ))
    }
}

impl fmt::Display for Origin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Biome(source, biome) => write!(f, "{biome} ({source})"),
            Self::Own(name) => write!(f, "{name} ({OWN})"),
        }
    }
}

/// Optics of a species at one humidity and wavelength, per particle.
#[derive(Debug, Clone, PartialEq)]
pub struct Optics {
    /// Extinction cross-section in m^2.
    pub extinction_m2: f64,
    /// Scattering cross-section in m^2, at most the extinction.
    pub scattering_m2: f64,
    /// Asymmetry parameter g, the mean cosine of the scattering angle, from the Mie series.
    pub asymmetry: f64,
    /// Phase function in sr^-1 at each of [`Species::cosines`]; taken as linear in the cosine between them, its
    /// integral over the sphere is 1 ([`Angles::phase`]).
    pub phase: Vec<f64>,
}

/// Scattering matrix of a species at one humidity and wavelength, relative to the phase function P11: with I, Q, U, V
/// referred to the plane of scattering, randomly oriented mirror-symmetric particles have P12 = P21, P34 = -P43, and
/// spheres P22 = P11, P44 = P33 (Bohren & Huffman 1983, sections 4.4.4 and 13.6). At each of [`Species::cosines`].
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix {
    /// P12 / P11: the degree of linear polarisation of scattered natural light is its negative.
    pub p12: Vec<f64>,
    /// P33 / P11.
    pub p33: Vec<f64>,
    /// P34 / P11.
    pub p34: Vec<f64>,
}

/// One species: particles that have their sizes and materials in fixed shares, so that one profile
/// and one set of spectra describe them.
#[derive(Debug, Clone)]
pub struct Species {
    /// Name, such as `boundary_layer`.
    pub name: String,
    /// Number density N(z) in m^-3 against altitude in m; zero beyond its axis, up to any altitude.
    pub number_density_m3: Curve,
    /// Relative humidity in percent at which it is by default.
    pub default_humidity_percent: f64,
    wavelength: Arc<Axis>,
    humidity: Axis,
    angles: Arc<Angles>,
    extinction: Field,
    scattering: Field,
    asymmetry: Field,
    /// The phase function, or its logarithm.
    phase: Field,
    matrix: Option<[Field; 3]>,
}

/// The aerosol of a biome after a source, or somebody's own.
#[derive(Debug, Clone)]
pub struct Aerosol {
    /// Where it comes from.
    pub origin: Origin,
    /// The species, lowest first.
    pub species: Vec<Species>,
}

/// What the names of the axes and fields of a species end in, after its own name.
pub mod suffix {
    /// Axis of altitudes, m.
    pub const ALTITUDE: &str = "_altitude";
    /// Axis of relative humidities, percent.
    pub const HUMIDITY: &str = "_humidity";
    /// Field over altitude, m^-3.
    pub const NUMBER_DENSITY: &str = "_number_density";
    /// Field without axes, percent.
    pub const DEFAULT_HUMIDITY: &str = "_default_humidity";
    /// Field over humidity and wavelength, m^2.
    pub const EXTINCTION: &str = "_extinction";
    /// Field over humidity and wavelength, m^2.
    pub const SCATTERING: &str = "_scattering";
    /// Field over humidity and wavelength, 1.
    pub const ASYMMETRY: &str = "_asymmetry";
    /// Field over humidity, wavelength and cosine, sr^-1.
    pub const PHASE: &str = "_phase";
    /// Fields P12, P33 and P34 over P11, over humidity, wavelength and cosine, 1; all or none.
    pub const MATRIX: [&str; 3] = ["_p12", "_p33", "_p34"];
}

impl Aerosol {
    /// Name of the file of a biome and source in `data/`.
    #[must_use]
    pub fn file_name(source: AerosolSource, biome: Biome) -> String {
        format!("{}-{source}-{biome}.table", Kind::Aerosol)
    }

    /// Settings `biome` and `source`, or `source` (`own`) and `name`; axes `wavelength` (nm) and `cosine` (1, from -1 to 1); for each species S the
    /// axes `S_altitude` (m), `S_humidity` (percent) and the fields `S_number_density` (m^-3) over altitude,
    /// `S_default_humidity` (percent) without axes, `S_extinction`, `S_scattering` (m^2) and `S_asymmetry` (1)
    /// over humidity and wavelength, `S_phase` (sr^-1) over humidity, wavelength and cosine, and, in every
    /// species or in none, `S_p12`, `S_p33`, `S_p34` (1) over the same. Further fields (errors) are allowed. Each axis of
    /// the optics is linear, parabolic or cubic and refuses outside; the phase function is logarithmic if that of the
    /// cosine is not linear, and else all are.
    ///
    /// # Errors
    /// [`TableError`] if the table is of another kind, lacks a field, or holds impossible values: a negative
    /// density or cross-section, more scattering than extinction, a phase function that is
    /// negative or whose integral is off 1 by more than 1e-5, or a ratio of the matrix beyond -1 to 1.
    pub fn from_table(table: &Table) -> Result<Self, TableError> {
        table.expect_kind(Kind::Aerosol)?;
        let origin = Origin::from_table(table)?;
        let names = table.fields.iter().filter_map(|field| field.name.strip_suffix(suffix::NUMBER_DENSITY));
        let wavelength = Arc::new(refusing_axis(table, WAVELENGTH.0, WAVELENGTH.1)?.clone());
        let angles = Arc::new(Angles::new(table.axis(COSINE.0)?)?);
        let species = names.map(|name| Species::from_table(table, name, &wavelength, &angles));
        let species = species.collect::<Result<Vec<_>, _>>()?;
        if species.is_empty() {
            return Err(TableError::Inconsistent("no species".into()));
        }
        Ok(Self { origin, species })
    }

    /// Vertical optical depth at a wavelength in nm. `humidity_percent` replaces the default humidity of those
    /// species that take it (see [`Species::humidity`]).
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside the table's wavelengths or humidities.
    pub fn optical_depth(&self, humidity_percent: Option<f64>, wavelength_nm: f64) -> Result<f64, TableError> {
        let one = |s: &Species| -> Result<f64, TableError> {
            Ok(s.column_m2() * s.cross_sections(s.humidity(humidity_percent), wavelength_nm)?.0)
        };
        self.species.iter().map(one).sum()
    }

    /// The type's own amount: its optical depth at 550 nm at the default humidities.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] if the table does not reach 550 nm.
    pub fn own_optical_depth(&self) -> Result<f64, TableError> {
        self.optical_depth(None, REFERENCE_WAVELENGTH_NM)
    }

    /// Extinction coefficient in m^-1 at altitude 0, for a visibility. Arguments as for [`Aerosol::optical_depth`].
    ///
    /// # Errors
    /// As [`Aerosol::optical_depth`].
    pub fn ground_extinction(&self, humidity_percent: Option<f64>, wavelength_nm: f64) -> Result<f64, TableError> {
        let one = |s: &Species| -> Result<f64, TableError> {
            let (extinction, _) = s.cross_sections(s.humidity(humidity_percent), wavelength_nm)?;
            Ok(s.number_density_m3.at(0.0)? * extinction)
        };
        self.species.iter().map(one).sum()
    }
}

/// An axis of the optics: in `unit`, linear or curved, refusing outside.
fn refusing_axis<'a>(table: &'a Table, name: &str, unit: &str) -> Result<&'a Axis, TableError> {
    let axis = table.axis(name)?;
    let between = axis.interpolation == Interpolation::Linear || axis.interpolation.is_curved();
    if axis.unit == unit && axis.outside == Outside::Error && between {
        return Ok(axis);
    }
    Err(TableError::Inconsistent(format!("axis {name:?} must be in {unit:?}, not a step, and refuse outside")))
}

impl Species {
    fn from_table(table: &Table, name: &str, wavelength: &Arc<Axis>, angles: &Arc<Angles>) -> Result<Self, TableError> {
        let full = |end: &str| format!("{name}{end}");
        let (altitude, humidity) = (full(suffix::ALTITUDE), full(suffix::HUMIDITY));
        let spectral = |end: &str, unit: &str| -> Result<Field, TableError> {
            table.field(&full(end), unit, &[&humidity, WAVELENGTH.0]).cloned()
        };
        let density = table.curve(&full(suffix::NUMBER_DENSITY), "m^-3", (&altitude, "m"))?;
        if density.axis().outside != Outside::Zero {
            return Err(TableError::Inconsistent(format!("axis {altitude:?} must be zero outside")));
        }
        let over = [humidity.as_str(), WAVELENGTH.0, COSINE.0];
        let has = |end: &str| table.fields.iter().any(|field| field.name == full(end));
        let matrix = if suffix::MATRIX.iter().any(|end| has(end)) {
            let [p12, p33, p34] = suffix::MATRIX.map(|end| table.field(&full(end), "1", &over).cloned());
            Some([p12?, p33?, p34?])
        } else {
            None
        };
        let species = Self {
            name: name.into(),
            number_density_m3: bounded(density, name, 0.0, 1e13)?,
            default_humidity_percent: scalar(table, &full(suffix::DEFAULT_HUMIDITY), "percent")?,
            wavelength: Arc::clone(wavelength),
            humidity: refusing_axis(table, &humidity, "percent")?.clone(),
            angles: Arc::clone(angles),
            extinction: spectral(suffix::EXTINCTION, "m^2")?,
            scattering: spectral(suffix::SCATTERING, "m^2")?,
            asymmetry: spectral(suffix::ASYMMETRY, "1")?,
            phase: table.field(&full(suffix::PHASE), "sr^-1", &over)?.clone(),
            matrix,
        };
        species.validate(table.axis(COSINE.0)?)?;
        Ok(species)
    }

    fn validate(&self, cosine: &Axis) -> Result<(), TableError> {
        let fail = |text: &str| Err(TableError::Inconsistent(format!("species {:?}: {text}", self.name)));
        if self.humidity.locate(self.default_humidity_percent).is_err() {
            return fail("the default humidity is not on its axis");
        }
        for (extinction, scattering) in self.extinction.values.iter().zip(&self.scattering.values) {
            // Rounding to single precision.
            if !(*scattering > 0.0 && *scattering <= extinction * (1.0 + 2e-7)) {
                return fail("scattering must be positive and at most the extinction");
            }
        }
        if self.asymmetry.values.iter().any(|g| !(-1.0..=1.0).contains(g)) {
            return fail("an asymmetry is outside -1 to 1");
        }
        // Curves have to be of logarithms to stay above zero; lines are drawn from as they are.
        let curved = cosine.interpolation.is_curved();
        let others = self.wavelength.interpolation.is_curved() || self.humidity.interpolation.is_curved();
        if curved != (self.phase.scale == Scale::Logarithmic) || others && !curved {
            return fail("a phase function is logarithmic if the cosine is not linear, and else linear throughout");
        }
        let allowed = if curved { CURVED_INTEGRAL } else { 1e-5 };
        for (i, phase) in self.phase.values.chunks(cosine.nodes.len()).enumerate() {
            let (_, off) = self.angles.phase(self.row(&[(i, 1.0)], &self.phase));
            if phase.iter().any(|p| *p < 0.0) || off.is_nan() || off.abs() > allowed {
                return fail("a phase function is negative or its integral is not 1");
            }
        }
        let mut ratios = self.matrix.iter().flatten().flat_map(|field| &field.values);
        // Rounding to single precision.
        if ratios.any(|ratio| ratio.abs() > 1.0 + 2e-7) {
            return fail("a ratio of the scattering matrix is outside -1 to 1");
        }
        Ok(())
    }

    /// Cosines of the angles of the phase function and the scattering matrix, from -1 (backward) to 1 (forward): those
    /// of the table, and more where its axis is not linear ([`Angles`]).
    #[must_use]
    pub fn cosines(&self) -> &[f64] {
        self.angles.cosines()
    }

    /// Lowest and highest relative humidity in percent; equal if the species does not take up water here.
    #[must_use]
    pub fn humidity_range_percent(&self) -> (f64, f64) {
        self.humidity.range()
    }

    /// The relative humidity in percent that holds for it if `asked` is asked for: that, where the species has
    /// more than one humidity, else (and for none) its default.
    #[must_use]
    pub fn humidity(&self, asked: Option<f64>) -> f64 {
        asked.filter(|_| self.humidity.nodes.len() > 1).unwrap_or(self.default_humidity_percent)
    }

    /// Vertical column of particles in m^-2: the integral of the number density, exact for its interpolation.
    #[must_use]
    pub fn column_m2(&self) -> f64 {
        self.number_density_m3.total()
    }

    /// Extinction and scattering cross-section per particle in m^2, by the rules of their fields and axes: logarithms,
    /// in our tables linear in humidity (percent) and parabolic in wavelength (nm).
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside either axis.
    pub fn cross_sections(&self, humidity_percent: f64, wavelength_nm: f64) -> Result<(f64, f64), TableError> {
        let nodes = self.nodes(humidity_percent, wavelength_nm)?;
        let extinction = mix(&nodes, &self.extinction);
        Ok((extinction, mix(&nodes, &self.scattering).min(extinction)))
    }

    /// Optics at a relative humidity (percent) and wavelength (nm), as [`Species::cross_sections`].
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside either axis.
    pub fn optics(&self, humidity_percent: f64, wavelength_nm: f64) -> Result<Optics, TableError> {
        let (extinction_m2, scattering_m2) = self.cross_sections(humidity_percent, wavelength_nm)?;
        let nodes = self.nodes(humidity_percent, wavelength_nm)?;
        let asymmetry = mix(&nodes, &self.asymmetry).clamp(-1.0, 1.0);
        let (phase, _) = self.angles.phase(self.row(&nodes, &self.phase));
        Ok(Optics { extinction_m2, scattering_m2, asymmetry, phase })
    }

    /// The scattering matrix at a relative humidity (percent) and wavelength (nm), its ratios as
    /// [`Species::cross_sections`] and kept within -1 to 1; `None` if the table has none.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside either axis.
    pub fn matrix(&self, humidity_percent: f64, wavelength_nm: f64) -> Result<Option<Matrix>, TableError> {
        let nodes = self.nodes(humidity_percent, wavelength_nm)?;
        Ok(self.matrix.as_ref().map(|fields| {
            let ratio = |field| self.row(&nodes, field).into_iter().map(|ratio| ratio.clamp(-1.0, 1.0)).collect();
            let [p12, p33, p34] = fields.each_ref().map(ratio);
            Matrix { p12, p33, p34 }
        }))
    }

    /// Rows of humidity and wavelength around a place, with their weights.
    fn nodes(&self, humidity_percent: f64, wavelength_nm: f64) -> Result<Vec<(usize, f64)>, TableError> {
        let wavelengths = self.wavelength.weights(wavelength_nm)?;
        let humidities = self.humidity.weights(humidity_percent)?;
        let row = |h: usize, w: usize| h * self.wavelength.nodes.len() + w;
        let all = humidities.iter().flat_map(|(h, a)| wavelengths.iter().map(move |(w, b)| (row(*h, *w), a * b)));
        Ok(all.collect())
    }

    /// A field over cosines at rows with these weights, at each of [`Species::cosines`].
    fn row(&self, nodes: &[(usize, f64)], field: &Field) -> Vec<f64> {
        let length = self.angles.nodes();
        let mut sums = vec![0.0; length];
        for (row, weight) in nodes {
            for (sum, value) in sums.iter_mut().zip(&field.values[row * length..(row + 1) * length]) {
                *sum += weight * field.scale.of(*value);
            }
        }
        self.angles.between(field.scale, &sums)
    }
}

/// The weighted mean of a field without further axes, on its scale.
fn mix(nodes: &[(usize, f64)], field: &Field) -> f64 {
    match *nodes {
        [(row, _)] => field.values[row],
        _ => field.scale.back(nodes.iter().map(|(row, weight)| weight * field.scale.of(field.values[*row])).sum()),
    }
}

#[cfg(test)]
#[path = "aerosol_tests.rs"]
mod tests;
