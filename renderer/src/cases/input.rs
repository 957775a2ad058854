//! The file of cases as it stands, before any physics.

use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

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
    #[error("{}: not a file of cases: {source}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// What is wrong and where.
        source: serde_json::Error,
    },
    /// The same identifier twice.
    #[error("{}: two cases named {id:?}", path.display())]
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
    #[serde(default)]
    pub(super) profiles: BTreeMap<String, Profile>,
    pub(super) cases: Vec<Case>,
}

/// A piecewise linear atmosphere of a spherical planet.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Profile {
    pub(super) z_km: Vec<f64>,
    /// One kind of scatterer with its absorber...
    pub(super) scattering_per_km: Option<Vec<f64>>,
    pub(super) absorption_per_km: Option<Vec<f64>>,
    /// ...or several components.
    pub(super) components: Option<Components>,
}

/// Components as a list or by name.
#[derive(Debug, Clone, Deserialize)]
#[serde(untagged)]
pub(super) enum Components {
    List(Vec<ProfileComponent>),
    Named(BTreeMap<String, ProfileComponent>),
}

impl Components {
    pub(super) fn all(&self) -> Vec<&ProfileComponent> {
        match self {
            Self::List(list) => list.iter().collect(),
            Self::Named(map) => map.values().collect(),
        }
    }
}

#[derive(Debug, Clone, Deserialize)]
pub(super) struct ProfileComponent {
    pub(super) scattering_per_km: Vec<f64>,
    pub(super) absorption_per_km: Vec<f64>,
    pub(super) phase: (String, f64),
}

/// A homogeneous layer of a plane-parallel atmosphere.
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Layer {
    pub(super) tau: f64,
    pub(super) ssa: f64,
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
    pub(super) layers: Option<Vec<Layer>>,
    pub(super) profile: Option<String>,
    pub(super) planet_radius_km: Option<f64>,
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

/// Reads a file of cases.
///
/// # Errors
/// [`CasesError`] if it cannot be read, is not of the form, or names a case twice.
pub fn read(path: &Path) -> Result<Suite, CasesError> {
    let text = std::fs::read(path).map_err(|source| CasesError::Read { path: path.into(), source })?;
    let suite: Suite =
        serde_json::from_slice(&text).map_err(|source| CasesError::Malformed { path: path.into(), source })?;
    let mut seen = std::collections::BTreeSet::new();
    for case in &suite.cases {
        if !seen.insert(&case.id) {
            return Err(CasesError::Twice { path: path.into(), id: case.id.clone() });
        }
    }
    Ok(suite)
}
