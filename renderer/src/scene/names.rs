//! The words a scene is described with.

use serde::{Deserialize, Serialize};

/// Which projection a picture has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum CameraKind {
    /// Equidistant fisheye
    Fisheye,
    /// Perspective, straight lines stay straight
    Pinhole,
    /// The whole sphere, azimuth across and elevation down
    Latlong,
}

/// The kinds of aerosol that flags and files name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
#[allow(missing_docs, reason = "the names are the documentation")]
pub enum Biome {
    None,
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

/// The known name nearest to `name` (Jaro-Winkler similarity of at least 0.7).
#[must_use]
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = name.to_lowercase();
    known
        .into_iter()
        .map(|candidate| (strsim::jaro_winkler(&name, candidate), candidate))
        .filter(|(similarity, _)| *similarity >= 0.7)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_misspelt_name_finds_its_neighbour() {
        let grounds = ["dry-soil", "ocean", "wet-soil"];
        assert_eq!(nearest("Oceen", grounds), Some("ocean"));
        assert_eq!(nearest("drysoil", grounds), Some("dry-soil"));
        assert_eq!(nearest("xyz", grounds), None);
    }
}
