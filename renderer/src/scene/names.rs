//! The words a scene is described with.

use serde::{Deserialize, Serialize};

/// Which projection a picture has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum CameraKind {
    /// Equidistant fisheye
    Fisheye,
    /// Perspective, straight lines stay straight
    Pinhole,
    /// The whole sphere, azimuth across and elevation down
    Latlong,
    /// The whole sphere as a square, folded from an octahedron, every pixel of the same solid angle: environment maps of pbrt-v4
    EqualArea,
}

impl CameraKind {
    /// Whether it shows the whole sphere, whatever the view's elevation.
    #[must_use]
    pub fn is_whole(self) -> bool {
        matches!(self, Self::Latlong | Self::EqualArea)
    }
}

/// Form of the sun as a light.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum SunShape {
    /// A disc that is darker towards its limb, as measured
    #[default]
    Disc,
    /// A disc as bright at its limb as in its middle
    Even,
    /// A point: all light from one direction, and no disc to be seen
    Point,
}

/// Words for aerosols in scene files: the names of the tables, and `none`.
pub(crate) mod word {
    use serde::{Deserialize, Deserializer, Serializer};
    use tables::views::{AerosolSource, Biome};
    use tables::{excerpt, nearest};

    /// What stands for no aerosol.
    pub(crate) const NONE: &str = "none";

    /// The biome of a name, or none of it; the error names the nearest.
    pub(crate) fn biome(name: &str) -> Result<Option<Biome>, String> {
        if name == NONE {
            return Ok(None);
        }
        let known = Biome::ALL.map(Biome::name);
        Biome::from_name(name).map(Some).ok_or_else(|| unknown("biome", name, known.into_iter().chain([NONE])))
    }

    /// The source of a name; the error names the nearest.
    pub(crate) fn source(name: &str) -> Result<AerosolSource, String> {
        let known = AerosolSource::ALL.map(AerosolSource::name);
        AerosolSource::from_name(name).ok_or_else(|| unknown("aerosol source", name, known))
    }

    fn unknown(what: &str, name: &str, known: impl IntoIterator<Item = &'static str> + Clone) -> String {
        let found = excerpt(name);
        match nearest(name, known.clone()) {
            Some(near) => format!("{what} {found:?} is not known; did you mean {near}?"),
            None => {
                format!("{what} {found:?} is not known; known are {}", Vec::from_iter(known).join(", "))
            }
        }
    }

    /// For `#[serde(with)]`: a biome or `none`.
    pub(in crate::scene) mod biome_or_none {
        use super::*;

        pub(in crate::scene) fn serialize<S: Serializer>(biome: &Option<Biome>, to: S) -> Result<S::Ok, S::Error> {
            to.serialize_str(biome.map_or(NONE, Biome::name))
        }

        pub(in crate::scene) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Option<Biome>, D::Error> {
            biome(&String::deserialize(from)?).map_err(serde::de::Error::custom)
        }
    }

    /// For `#[serde(with)]`: the source of an aerosol's optics.
    pub(in crate::scene) mod aerosol_source {
        use super::*;

        pub(in crate::scene) fn serialize<S: Serializer>(source: &AerosolSource, to: S) -> Result<S::Ok, S::Error> {
            to.serialize_str(source.name())
        }

        pub(in crate::scene) fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<AerosolSource, D::Error> {
            source(&String::deserialize(from)?).map_err(serde::de::Error::custom)
        }
    }
}
