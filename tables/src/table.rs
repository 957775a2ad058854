//! A table in memory: axes, fields, settings and where the numbers came from.

use crate::{Axis, Curve, TableError, excerpt};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;

/// The most bytes of a name or a unit.
const MAX_NAME: usize = 100;

/// What a table holds. [`crate::views`] has the typed reading of each.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Kind {
    /// Temperature, pressure and number density of air against altitude.
    StandardAtmosphere,
    /// Rayleigh cross-section, King factor and gamma against wavelength.
    Rayleigh,
    /// Absorption cross-section of ozone against wavelength, a polynomial in temperature.
    OzoneCrossSection,
    /// Ozone number density by month, latitude and altitude, and its columns.
    OzoneProfiles,
    /// Ozone number density by month and altitude in homogeneous layers, and its columns.
    OzoneLayers,
    /// Solar irradiance at 1 au and limb darkening.
    Sun,
    /// Colour-matching functions.
    Observer,
    /// Spectral albedo of grounds.
    GroundAlbedo,
    /// The aerosol of one biome: profiles, cross-sections and phase functions of its species.
    Aerosol,
    /// The diffuse field of a scene, as the renderer keeps it for later pictures; no part of `data/`.
    SolvedSky,
}

impl std::fmt::Display for Kind {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::StandardAtmosphere => "standard-atmosphere",
            Self::Rayleigh => "rayleigh",
            Self::OzoneCrossSection => "ozone-cross-section",
            Self::OzoneProfiles => "ozone-profiles",
            Self::OzoneLayers => "ozone-layers",
            Self::Sun => "sun",
            Self::Observer => "observer",
            Self::GroundAlbedo => "ground-albedo",
            Self::SolvedSky => "solved-sky",
            Self::Aerosol => "aerosol",
        })
    }
}

impl Kind {
    /// Every kind of which `data/` has one file, in the order in which it is listed. Of [`Kind::Aerosol`] there is one
    /// for each source and biome: see [`crate::views::Aerosol::file_name`].
    pub const ALL: [Self; 8] = [
        Self::StandardAtmosphere,
        Self::Rayleigh,
        Self::OzoneCrossSection,
        Self::OzoneProfiles,
        Self::OzoneLayers,
        Self::Sun,
        Self::Observer,
        Self::GroundAlbedo,
    ];

    /// Name of the file of a kind of [`Kind::ALL`] in `data/`: the kind and `.table`.
    #[must_use]
    pub fn file_name(self) -> String {
        format!("{self}.table")
    }
}

/// How a number of the payload is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// IEEE 754 binary32, little-endian.
    F32,
    /// IEEE 754 binary64, little-endian.
    F64,
}

impl Precision {
    /// Bytes of one number.
    #[must_use]
    pub fn bytes(self) -> usize {
        match self {
            Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// What is linear between nodes: the value or its logarithm.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Scale {
    /// The value itself.
    Linear,
    /// Its natural logarithm; every value is then positive.
    Logarithmic,
}

/// How far a value may lie from the one computed again from the same inputs
/// (another machine's last bits, the storage precision): |a - b| <= absolute + relative |b|.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerance {
    /// Relative part.
    pub relative: f64,
    /// Absolute part, in the field's unit.
    pub absolute: f64,
}

impl Tolerance {
    /// Whether `found` lies within the tolerance of `expected`.
    #[must_use]
    pub fn allows(self, expected: f64, found: f64) -> bool {
        (expected - found).abs() <= self.absolute + self.relative * expected.abs()
    }
}

/// Values over the product of some axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    /// Name in the field's standard terms, such as `number_density`.
    pub name: String,
    /// Unit of the values, such as `m^-3`; `1` when there is none.
    pub unit: String,
    /// Names of its axes, slowest first: value index = (i_0 * n_1 + i_1) * n_2 + i_2 ...
    pub axes: Vec<String>,
    /// Stored precision.
    pub precision: Precision,
    /// What is linear between nodes.
    pub scale: Scale,
    /// How exactly a rebuild must agree.
    pub tolerance: Tolerance,
    /// Measured error of interpolating between nodes, relative to the value (of an asymmetry: absolute),
    /// or `None` where the nodes themselves are the data.
    pub interpolation_error: Option<f64>,
    /// The values.
    pub values: Vec<f64>,
}

/// One input of a table.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Provenance {
    /// Path below `raw-data/`, with forward slashes; of an own input the name of the file alone.
    pub file: String,
    /// What the file holds.
    pub title: String,
    /// Publication, or [`Provenance::OWN`].
    pub citation: String,
    /// Where the numbers were read.
    pub source: String,
    /// Licence or terms.
    pub licence: String,
    /// SHA-256 of the file in lower-case hexadecimal.
    pub sha256: String,
}

impl Provenance {
    /// The citation of a file that somebody made for themselves.
    pub const OWN: &str = "own input";

    /// Whether the file is somebody's own and none of `raw-data/`.
    #[must_use]
    pub fn is_own(&self) -> bool {
        self.citation == Self::OWN
    }
}

/// A table: what a file of `data/` holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    /// What it is.
    pub kind: Kind,
    /// One sentence for people.
    pub title: String,
    /// The axes that its fields share.
    pub axes: Vec<Axis>,
    /// The fields.
    pub fields: Vec<Field>,
    /// Choices that made the numbers what they are, by name.
    pub settings: BTreeMap<String, String>,
    /// The inputs.
    pub provenance: Vec<Provenance>,
}

impl Table {
    /// Checks the axes, that names are unique and no longer than 100 bytes, as units are, that each field has as many
    /// finite values as its axes have nodes, and that logarithmic fields are positive.
    ///
    /// # Errors
    /// [`TableError::Inconsistent`] naming what is wrong.
    pub fn validate(&self) -> Result<(), TableError> {
        let fail = |text: String| Err(TableError::Inconsistent(text));
        let units = self.axes.iter().map(|a| &a.unit).chain(self.fields.iter().map(|f| &f.unit));
        let names = self.axes.iter().map(|a| &a.name).chain(self.fields.iter().map(|f| &f.name));
        if let Some(long) = names.chain(units).find(|name| name.len() > MAX_NAME) {
            return fail(format!("a name or unit of more than {MAX_NAME} bytes: {:?}", excerpt(long)));
        }
        let mut names: Vec<&str> = Vec::new();
        for name in self.axes.iter().map(|a| &a.name).chain(self.fields.iter().map(|f| &f.name)) {
            if names.contains(&name.as_str()) {
                return fail(format!("two axes or fields named {name:?}"));
            }
            names.push(name);
        }
        for axis in &self.axes {
            axis.validate()?;
        }
        for field in &self.fields {
            let expected = self.length_of(&field.name, &field.axes)?;
            if field.values.len() != expected {
                return fail(format!(
                    "field {:?}: {} values where its axes make {expected}",
                    field.name,
                    field.values.len()
                ));
            }
            if let Some(i) = field.values.iter().position(|v| !v.is_finite()) {
                return fail(format!("field {:?}: value {i} is not finite", field.name));
            }
            if field.scale == Scale::Logarithmic && field.values.iter().any(|&v| v <= 0.0) {
                return fail(format!("field {:?}: a value on a logarithmic scale is not positive", field.name));
            }
            let Tolerance { relative, absolute } = field.tolerance;
            if !(relative >= 0.0 && absolute >= 0.0 && relative.is_finite() && absolute.is_finite()) {
                return fail(format!("field {:?}: a tolerance is negative or not finite", field.name));
            }
        }
        Ok(())
    }

    /// Number of values that a field over the named axes holds.
    fn length_of(&self, field: &str, axes: &[String]) -> Result<usize, TableError> {
        axes.iter().try_fold(1_usize, |length, name| {
            let axis = self.axis(name)?;
            length
                .checked_mul(axis.nodes.len())
                .ok_or_else(|| TableError::Inconsistent(format!("field {field:?}: its axes overflow")))
        })
    }

    /// Refuses a table of another kind.
    ///
    /// # Errors
    /// [`TableError::WrongKind`].
    pub fn expect_kind(&self, kind: Kind) -> Result<(), TableError> {
        if self.kind == kind {
            Ok(())
        } else {
            Err(TableError::WrongKind { expected: kind.to_string(), found: self.kind.to_string() })
        }
    }

    /// The axis of that name.
    ///
    /// # Errors
    /// [`TableError::Missing`].
    pub fn axis(&self, name: &str) -> Result<&Axis, TableError> {
        self.axes.iter().find(|a| a.name == name).ok_or_else(|| self.missing("axis", name))
    }

    /// The field of that name, which must be in `unit` and over the axes `axes`.
    ///
    /// # Errors
    /// [`TableError::Missing`], [`TableError::WrongUnit`] or [`TableError::Inconsistent`].
    pub fn field(&self, name: &str, unit: &str, axes: &[&str]) -> Result<&Field, TableError> {
        let field = self.fields.iter().find(|f| f.name == name).ok_or_else(|| self.missing("field", name))?;
        if field.unit != unit {
            return Err(TableError::WrongUnit { name: name.into(), expected: unit.into(), found: field.unit.clone() });
        }
        if field.axes != axes {
            let found = excerpt(&format!("{:?}", field.axes));
            return Err(TableError::Inconsistent(format!("field {name:?} is over {found}, {axes:?} is needed")));
        }
        Ok(field)
    }

    /// The field of that name over one axis, as a curve.
    ///
    /// # Errors
    /// As [`Table::field`], and [`TableError::WrongUnit`] for the axis.
    pub fn curve(&self, name: &str, unit: &str, axis: (&str, &str)) -> Result<Curve, TableError> {
        self.curve_sharing(name, unit, axis, &mut BTreeMap::new())
    }

    /// As [`Table::curve`], for a view of many curves over the same axis: each axis is copied once, into `shared`.
    pub(crate) fn curve_sharing<'a>(
        &'a self,
        name: &str,
        unit: &str,
        (axis, axis_unit): (&str, &str),
        shared: &mut BTreeMap<&'a str, Arc<Axis>>,
    ) -> Result<Curve, TableError> {
        let field = self.field(name, unit, &[axis])?;
        let found = self.axis(axis)?;
        if found.unit != axis_unit {
            let (expected, found) = (axis_unit.into(), found.unit.clone());
            return Err(TableError::WrongUnit { name: axis.into(), expected, found });
        }
        let axis = shared.entry(&found.name).or_insert_with(|| Arc::new(found.clone()));
        Curve::new(Arc::clone(axis), field.scale, field.values.clone())
    }

    fn missing(&self, what: &'static str, name: &str) -> TableError {
        TableError::Missing { what, name: excerpt(name), kind: self.kind.to_string() }
    }
}
