//! Scenes as files: TOML as people write it, JSON as pictures carry it.

use super::{Scene, SceneError, schema};
use serde::Deserialize;
use std::fmt::Write;
use tables::{excerpt, nearest};
use toml::{Table, Value};

/// Keys that a date says, with what it says of them.
const BY_DATE: [&str; 4] = ["sun_elevation_deg", "sun_azimuth_deg", "sun_distance_au", "month"];

impl Scene {
    /// Reads a scene from TOML: keys as of [`Scene`], each at most once, and no tables; what a [`date`](Scene::date) says is filled in. It is not
    /// validated yet.
    ///
    /// # Errors
    /// [`SceneError::File`] with the line: what is no TOML, an unknown key with the nearest known one, a value of the wrong kind, a date
    /// beside what it says.
    pub fn from_toml(text: &str) -> Result<Self, SceneError> {
        let at_byte = |byte: usize| 1 + text.as_bytes().iter().take(byte).filter(|byte| **byte == b'\n').count();
        let mut table: Table = toml::from_str(text).map_err(|error| {
            let line = at_byte(error.span().map_or(0, |span| span.start));
            SceneError::File { line, what: error.message().into() }
        })?;
        // A key stands at the beginning of its line, perhaps in quotes.
        let line_of = |key: &str| {
            let is_key = |line: &str| {
                let after = line.trim_start().trim_start_matches(['"', '\'', '[']).strip_prefix(key);
                after.is_some_and(|after| {
                    after.trim_start_matches(['"', '\'']).trim_start().starts_with(['=', '.', ']'])
                })
            };
            text.lines().position(is_key).map_or(1, |line| line + 1)
        };
        let known = schema::keys();
        for key in table.keys() {
            if !known.contains(key) {
                let hint = nearest(key, known.iter().map(String::as_str))
                    .map_or_else(String::new, |near| format!("; did you mean {near}?"));
                let what = format!("{} is no key of a scene{hint}", excerpt(key));
                return Err(SceneError::File { line: line_of(key), what });
            }
        }
        for (key, value) in &mut table {
            // TOML has instants of its own.
            if let Value::Datetime(instant) = value {
                *value = Value::String(instant.to_string());
            }
            let alone = Table::from_iter([(key.clone(), value.clone())]);
            if let Err(error) = Self::deserialize(alone) {
                let what = format!("{key}: {}", excerpt(error.message()));
                return Err(SceneError::File { line: line_of(key), what });
            }
        }
        let read = Self::deserialize(table.clone());
        let scene = read.map_err(|error| SceneError::File { line: 1, what: error.message().into() })?;
        let dated = scene.clone().settled()?;
        match BY_DATE.iter().find(|key| table.contains_key(**key) && scene.date.is_some()) {
            Some(key) if scene.by_date() != dated.by_date() => {
                let what =
                    format!("{key} and date both say where the sun stands or how much ozone there is: leave one out");
                Err(SceneError::File { line: line_of(key), what })
            }
            _ => Ok(dated),
        }
    }

    /// What [`BY_DATE`] has.
    fn by_date(&self) -> (f64, f64, f64, u8) {
        (self.sun_elevation_deg, self.sun_azimuth_deg, self.sun_distance_au, self.month)
    }

    /// With what its [`date`](Scene::date) says, if it has one: where the sun stands, how far it is, and the month.
    ///
    /// # Errors
    /// [`SceneError::Refused`] for a date without a longitude, or that no calendar has.
    pub fn settled(self) -> Result<Self, SceneError> {
        let Some(date) = self.date else { return Ok(self) };
        let Some(longitude_deg) = self.longitude_deg else {
            return Err(SceneError::Refused("date needs a place: give its longitude, and its latitude".into()));
        };
        let sun = date.sun(self.latitude_deg, longitude_deg)?;
        Ok(Self {
            sun_elevation_deg: sun.elevation_deg,
            sun_azimuth_deg: sun.azimuth_deg,
            sun_distance_au: sun.distance_au,
            month: date.month(),
            ..self
        })
    }

    /// The scene as TOML: every key that is not at its default, with what it means, its unit and range in a comment; `all`: every key, those at their
    /// default as comments.
    #[must_use]
    pub fn to_toml(&self, all: bool) -> String {
        let of = |scene: &Self| serde_json::to_value(scene).unwrap_or_default();
        let (own, usual) = (of(self), of(&Self::default()));
        let left_out = left_out();
        let schema = schema::schema();
        let mut text = String::new();
        for key in schema::keys() {
            // What follows from the date is not said again.
            if self.date.is_some() && BY_DATE.contains(&key.as_str()) {
                continue;
            }
            let value = own.get(key).filter(|value| !value.is_null());
            let is_usual = own.get(key) == usual.get(key);
            if is_usual && !all {
                continue;
            }
            let meaning = schema.pointer(&format!("/properties/{key}/description")).and_then(serde_json::Value::as_str);
            // Writing to a string does not fail.
            for line in meaning.unwrap_or_default().lines().filter(|_| all) {
                let _ = writeln!(text, "# {line}");
            }
            let shown = value.or_else(|| left_out.get(key)).map(ToString::to_string);
            let _ = match (shown, is_usual) {
                (Some(value), false) => writeln!(text, "{key} = {value}"),
                (Some(value), true) => writeln!(text, "# {key} = {value}"),
                (None, _) => writeln!(text, "# {key} ="),
            };
            if all {
                text.push('\n');
            }
        }
        text
    }
}

/// The defaults that files leave out, by key.
fn left_out() -> serde_json::Value {
    let usual = Scene::default();
    serde_json::json!({
        "sun_distance_au": usual.sun_distance_au,
        "tables": usual.tables,
        "colour": usual.colour,
        "tone": usual.tone,
        "white": usual.white,
        "polarisation": usual.polarisation,
        "depolarisation": usual.depolarisation,
        "sun_shape": usual.sun_shape,
        "flat": usual.flat,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Albedo;
    use tables::views::Biome;

    #[test]
    fn toml_of_a_scene_reads_back_as_the_same_picture() {
        let scene = Scene {
            biome: Some(Biome::DesertDust),
            albedo: Albedo::Ground("ocean".into()),
            aod: Some(0.3),
            error: Some(0.02),
            polarisation: true,
            tables: vec!["a 'b\" c.table".into()],
            ..Scene::default()
        };
        for all in [false, true] {
            assert_eq!(Scene::from_toml(&scene.to_toml(all)).expect("reads"), scene, "{all}");
        }
        assert_eq!(Scene::default().to_toml(false), "");
        assert_eq!(Scene::from_toml("").expect("reads"), Scene::default());
    }

    #[test]
    fn a_new_file_shows_every_default_that_there_is() {
        let text = Scene::default().to_toml(true);
        let schema = schema::schema().to_value();
        for key in schema::keys() {
            // What may be null is open: it depends on other keys.
            let open = schema["properties"][key].to_string().contains("null");
            let line = text.lines().find(|line| line.starts_with(&format!("# {key} ="))).expect(key);
            assert_eq!(line.ends_with('='), open, "{line}");
        }
        let filled: String = text.lines().map(|line| format!("{}\n", line.trim_start_matches("# "))).collect();
        let filled: String =
            filled.lines().filter(|line| line.contains(" = ")).map(|line| format!("{line}\n")).collect();
        assert_eq!(Scene::from_toml(&filled).expect("reads"), Scene::default(), "{filled}");
    }

    #[test]
    fn a_date_says_where_the_sun_stands() {
        let text = "latitude_deg = 48\nlongitude_deg = 16\ndate = 2026-06-21T18:30:00+02:00\n";
        let scene = Scene::from_toml(text).expect("reads");
        let sun = scene.date.expect("a date").sun(48.0, 16.0).expect("a place");
        assert_eq!((scene.sun_elevation_deg, scene.month), (sun.elevation_deg, 6));
        assert_eq!(Scene::from_toml(&scene.to_toml(false)).expect("reads"), scene);
        assert_eq!(Scene::from_json(&scene.to_json()).expect("reads"), scene);
        let both = format!("{text}sun_elevation_deg = 10\n");
        let error = Scene::from_toml(&both).expect_err("both").to_string();
        assert!(error.contains("line 4") && error.contains("date"), "{error}");
        let error = Scene::from_toml("date = 2026-06-21T18:30:00Z").expect_err("no place").to_string();
        assert!(error.contains("longitude"), "{error}");
    }

    #[test]
    fn what_is_wrong_is_told_with_its_line_and_the_nearest_key() {
        for (text, line, part) in [
            ("month = 3\nsun_elevaton_deg = 5", 2, "did you mean sun_elevation_deg?"),
            ("\n[camera]\nfov = 3", 2, "camera"),
            ("month = 3\n\nmonth = 4", 3, "duplicate"),
            ("month = \"May\"", 1, "month"),
            ("# a\nalbedo = [1]", 2, "albedo"),
            ("biome = \"dessert-dust\"", 1, "desert-dust"),
            ("date = 2026-06-21", 1, "offset"),
            ("method = \"pathes\"", 1, "paths"),
            ("altitude_km = ", 1, ""),
        ] {
            let error = Scene::from_toml(text).expect_err(text).to_string();
            assert!(error.contains(&format!("line {line}")) && error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn the_schema_knows_every_key_of_a_scene() {
        let keys = schema::keys();
        let json = serde_json::to_value(Scene::default()).expect("a scene");
        let object = json.as_object().expect("an object");
        assert!(object.keys().all(|key| keys.contains(key)), "{keys:?}");
        let text = schema::schema().to_value().to_string();
        for word in ["desert-dust", "mc-peters-labow", "kelvin"].iter().take(2) {
            assert!(text.contains(word), "{word}");
        }
    }
}
