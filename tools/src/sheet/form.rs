//! A sheet as CSV and as JSON.

use super::{Sheet, SheetError, Values};
use crate::text::shortest;
use serde::Serialize;
use serde::ser::{SerializeMap, Serializer};

fn malformed(error: impl std::fmt::Display) -> SheetError {
    SheetError::Malformed(error.to_string())
}

impl Sheet {
    /// `# key: value` lines as in the files of `raw-data/`, the header row, the rows; with `bare`, the last two alone.
    pub(super) fn csv(&self, bare: bool) -> Result<Vec<u8>, SheetError> {
        let mut bytes = if bare { Vec::new() } else { self.comments().into_bytes() };
        let mut writer = csv::Writer::from_writer(&mut bytes);
        writer.write_record(self.columns.iter().map(|column| &column.name)).map_err(malformed)?;
        for row in 0..self.rows() {
            let cell = |values: &Values| match values {
                Values::Numbers(values) => values[row].map(shortest).unwrap_or_default(),
                Values::Words(words) => words[row].clone(),
            };
            writer.write_record(self.columns.iter().map(|column| cell(&column.values))).map_err(malformed)?;
        }
        writer.flush().map_err(malformed)?;
        drop(writer);
        Ok(bytes)
    }

    fn comments(&self) -> String {
        let mut text = String::new();
        let mut line = |key: &str, value: &str| {
            // One line each, whatever the words hold.
            text += &format!("# {key}: {value}").replace(['\n', '\r'], " ");
            text.push('\n');
        };
        line("title", &self.title);
        for (key, value) in &self.settings {
            line(key, value);
        }
        for table in &self.sources.tables {
            line(&format!("table {}", table.file), &format!("checksum {:08x}, {}", table.checksum, table.title));
        }
        for input in &self.sources.inputs {
            let from = &input.provenance;
            line(&format!("input {}", from.file), &format!("SHA-256 {}", from.sha256));
            line("citation", &from.citation);
            line("licence", &from.licence);
        }
        for column in &self.columns {
            line(&format!("unit {}", column.name), &column.unit);
        }
        for column in &self.columns {
            line(&format!("column {}", column.name), &column.meaning);
        }
        text
    }

    /// An object of `title`, `settings` (object of strings), `tables`, `sources`, `columns` (name, unit, meaning) and
    /// `rows` (one object a row, its keys the names of the columns), a row a line.
    pub(super) fn json(&self) -> Result<String, SheetError> {
        let settings: std::collections::BTreeMap<_, _> = self.settings.iter().map(|(k, v)| (k, v)).collect();
        let columns = self.columns.iter().map(|c| About { name: &c.name, unit: &c.unit, meaning: &c.meaning });
        Ok(format!(
            "{{\n\"title\": {},\n\"settings\": {},\n\"tables\": {},\n\"sources\": {},\n\"columns\": {},\n\"rows\": {}\n}}\n",
            serde_json::to_string(&self.title).map_err(malformed)?,
            serde_json::to_string(&settings).map_err(malformed)?,
            json_list(&self.sources.tables)?,
            json_list(&self.sources.inputs)?,
            json_list(columns)?,
            json_list((0..self.rows()).map(|row| Row { sheet: self, row }))?,
        ))
    }

    /// What [`Sheet::json`] says but for the rows, in one line: what a Parquet file carries.
    #[cfg(feature = "parquet")]
    pub(super) fn about(&self) -> Result<String, SheetError> {
        let columns: Vec<_> =
            self.columns.iter().map(|c| About { name: &c.name, unit: &c.unit, meaning: &c.meaning }).collect();
        let settings: std::collections::BTreeMap<_, _> = self.settings.iter().map(|(k, v)| (k, v)).collect();
        let about = serde_json::json!({
            "title": self.title,
            "settings": settings,
            "tables": self.sources.tables,
            "sources": self.sources.inputs,
            "columns": columns,
        });
        Ok(about.to_string())
    }
}

/// A JSON list with an item a line.
///
/// # Errors
/// [`SheetError::Malformed`] for an item that cannot be JSON.
pub fn json_list<T: Serialize>(items: impl IntoIterator<Item = T>) -> Result<String, SheetError> {
    let lines: Result<Vec<String>, _> = items.into_iter().map(|item| serde_json::to_string(&item)).collect();
    let lines = lines.map_err(malformed)?;
    Ok(if lines.is_empty() { "[]".into() } else { format!("[\n{}\n]", lines.join(",\n")) })
}

#[derive(Serialize)]
struct About<'a> {
    name: &'a str,
    unit: &'a str,
    meaning: &'a str,
}

/// One row as an object.
struct Row<'a> {
    sheet: &'a Sheet,
    row: usize,
}

impl Serialize for Row<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let mut map = to.serialize_map(Some(self.sheet.columns.len()))?;
        for column in &self.sheet.columns {
            match &column.values {
                Values::Numbers(values) => map.serialize_entry(&column.name, &values[self.row])?,
                Values::Words(words) => map.serialize_entry(&column.name, &words[self.row])?,
            }
        }
        map.end()
    }
}
