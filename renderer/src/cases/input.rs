//! The file of cases as it stands, before any physics.

use super::bounded;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{BufReader, Read};
use std::path::{Path, PathBuf};
use tables::excerpt;

/// Which cases of a file are asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Tier {
    /// The quick subset: cases marked `core`.
    Core,
    /// All of them.
    Full,
}

impl Tier {
    pub(super) fn takes(self, tier: &str) -> bool {
        self == Self::Full || tier == "core"
    }
}

/// Why a file of cases cannot be read.
#[derive(Debug, thiserror::Error)]
pub enum CasesError {
    /// The system refused.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Not JSON, or not of the expected form; the message has line and column.
    #[error("{}: not a file of cases: {}", path.display(), excerpt(&source.to_string()))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong and where.
        source: serde_json::Error,
    },
    /// The same identifier twice.
    #[error("{}: two cases named {:?}", path.display(), excerpt(id))]
    Twice {
        /// The file.
        path: PathBuf,
        /// The identifier.
        id: String,
    },
}

/// A file of cases.
#[derive(Debug, Clone, Deserialize)]
pub struct Suite {
    /// Profiles by name.
    #[serde(default, deserialize_with = "bounded::map")]
    pub(super) profiles: BTreeMap<String, Profile>,
    #[expect(clippy::vec_box, reason = "the list grows by doubling, which must not double the cases themselves")]
    pub(super) cases: Vec<Box<Case>>,
}

/// A piecewise linear atmosphere of a spherical planet.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Profile {
    #[serde(deserialize_with = "bounded::list")]
    pub(super) z_km: Vec<f64>,
    /// One kind of scatterer with its absorber...
    #[serde(default, deserialize_with = "bounded::optional_list")]
    pub(super) scattering_per_km: Option<Vec<f64>>,
    #[serde(default, deserialize_with = "bounded::optional_list")]
    pub(super) absorption_per_km: Option<Vec<f64>>,
    /// ...or several components.
    pub(super) components: Option<Components>,
}

/// Components, from a list or by name.
#[derive(Debug, Clone)]
pub(super) struct Components(Vec<ProfileComponent>);

impl Components {
    pub(super) fn all(&self) -> &[ProfileComponent] {
        &self.0
    }
}

impl<'de> Deserialize<'de> for Components {
    fn deserialize<D: serde::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        bounded::list_or_values(from).map(Self)
    }
}

#[derive(Debug, Clone, Deserialize)]
pub(super) struct ProfileComponent {
    #[serde(deserialize_with = "bounded::list")]
    pub(super) scattering_per_km: Vec<f64>,
    #[serde(deserialize_with = "bounded::list")]
    pub(super) absorption_per_km: Vec<f64>,
    pub(super) phase: (String, f64),
}

/// A homogeneous layer of a plane-parallel atmosphere.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Layer {
    pub(super) tau: f64,
    pub(super) ssa: f64,
    #[serde(deserialize_with = "bounded::list")]
    pub(super) phase: Vec<(f64, String, f64)>,
}

/// One case. Keys that only inform are passed over.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Case {
    pub(super) id: String,
    pub(super) geometry: String,
    pub(super) quantity: String,
    #[serde(default = "scalar")]
    pub(super) polarization: String,
    pub(super) orders: String,
    #[serde(default, deserialize_with = "bounded::optional_list")]
    pub(super) layers: Option<Vec<Layer>>,
    pub(super) profile: Option<String>,
    pub(super) planet_radius_km: Option<f64>,
    #[serde(default, deserialize_with = "bounded::optional_list")]
    pub(super) phase: Option<Vec<(f64, String, f64)>>,
    pub(super) sza_deg: f64,
    pub(super) albedo: f64,
    pub(super) observer: String,
    pub(super) observer_alt_km: Option<f64>,
    pub(super) view_zenith_deg: Option<f64>,
    pub(super) view_dphi_deg: Option<f64>,
    #[serde(rename = "F0", default = "one")]
    pub(super) f0: f64,
    #[serde(default)]
    pub(super) tier: String,
}

fn scalar() -> String {
    "scalar".into()
}

fn one() -> f64 {
    1.0
}

/// Reads a file of cases. It is never in memory as a whole; what it says takes at most four times its size and 1 MiB.
///
/// # Errors
/// [`CasesError`] if it cannot be read, is not of the form, or names a case twice.
pub fn read(path: &Path) -> Result<Suite, CasesError> {
    let file = File::open(path).map_err(|source| CasesError::Read { path: path.into(), source })?;
    parse(path, BufReader::new(file))
}

/// Reads cases from a stream, which errors call `path`.
///
/// # Errors
/// As [`read`].
pub fn parse(path: &Path, stream: impl Read) -> Result<Suite, CasesError> {
    let suite: Suite = serde_json::from_reader(stream).map_err(|source| match source.io_error_kind() {
        Some(_) => CasesError::Read { path: path.into(), source: source.into() },
        None => CasesError::Malformed { path: path.into(), source },
    })?;
    let mut seen = BTreeSet::new();
    match suite.cases.iter().find(|case| !seen.insert(&case.id)) {
        Some(twice) => Err(CasesError::Twice { path: path.into(), id: twice.id.clone() }),
        None => Ok(suite),
    }
}
