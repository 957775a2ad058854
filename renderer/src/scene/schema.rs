//! The JSON schema of scene files, for editors and for checks of keys.

use super::Scene;
use schemars::{Schema, SchemaGenerator, json_schema};
use serde::Serialize;
use std::sync::LazyLock;
use tables::views::{AerosolSource, Biome};

/// The schema of a scene (JSON Schema 2020-12): each key with its meaning, unit, range and default.
#[must_use]
pub fn schema() -> Schema {
    schemars::schema_for!(Scene)
}

/// All keys of a scene, in the order of its fields.
pub(super) fn keys() -> &'static [String] {
    static KEYS: LazyLock<Vec<String>> = LazyLock::new(|| {
        let properties = schema().get("properties").and_then(serde_json::Value::as_object).cloned();
        properties.unwrap_or_default().into_iter().map(|(key, _)| key).collect()
    });
    &KEYS
}

/// One of some words.
fn words<T: Serialize>(words: &[T]) -> Schema {
    json_schema!({ "type": "string", "enum": words })
}

pub(super) fn biome(_: &mut SchemaGenerator) -> Schema {
    words(&Biome::ALL.map(Biome::name).into_iter().chain([super::names::word::NONE]).collect::<Vec<_>>())
}

pub(super) fn aerosol_source(_: &mut SchemaGenerator) -> Schema {
    words(&AerosolSource::ALL.map(AerosolSource::name))
}

pub(super) fn method(_: &mut SchemaGenerator) -> Schema {
    words(&crate::transport::Method::ALL)
}

pub(super) fn albedo(_: &mut SchemaGenerator) -> Schema {
    let pair = json_schema!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 });
    json_schema!({ "anyOf": [
        { "type": "number", "minimum": 0, "maximum": 1 },
        { "type": "string" },
        { "type": "array", "items": pair, "minItems": 2 },
    ] })
}

pub(super) fn wavelengths(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "items": { "type": "number" }, "minItems": 1 })
}

pub(super) fn date(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": ["string", "null"], "format": "date-time" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_file_of_the_schema_is_what_the_command_prints() {
        let file = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/scene.schema.json");
        let printed = format!("{}\n", serde_json::to_string_pretty(&schema()).expect("a schema"));
        let kept = std::fs::read_to_string(file).expect("scenes/scene.schema.json");
        assert!(kept == printed, "airlight scene schema > scenes/scene.schema.json");
    }
}
