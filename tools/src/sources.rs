//! Where numbers came from: the tables read and the measured inputs that made them.

use crate::raw;
use crate::sheet::{Series, Sheet, SheetError, Values, json_list};
use crate::text::wrapped;
use serde::{Serialize, Serializer};
use std::path::{Path, PathBuf};
use tables::{Provenance, Table, TableError};

/// Why sources cannot be named, or are not what they should be.
#[derive(Debug, thiserror::Error)]
pub enum SourcesError {
    /// A table cannot be read.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A folder cannot be listed.
    #[error("{}: cannot be listed: {source}", path.display())]
    Folder {
        /// The folder.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// A folder without a table.
    #[error("{}: no table is there", path.display())]
    NoTable {
        /// The folder.
        path: PathBuf,
    },
    /// An input that cannot be read.
    #[error("{}: cannot be read: {source}", path.display())]
    Input {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// Inputs that are not those of the tables.
    #[error("not what the tables were made from: {}", files.join(", "))]
    Changed {
        /// The files.
        files: Vec<String>,
    },
}

/// A table that numbers were taken from.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct TableFile {
    /// Name of the file.
    pub file: String,
    /// What it holds.
    pub title: String,
    /// [`tables::file::checksum`], which pictures carry too; eight hexadecimal digits in files.
    #[serde(serialize_with = "hexadecimal")]
    pub checksum: u32,
}

fn hexadecimal<S: Serializer>(checksum: &u32, to: S) -> Result<S::Ok, S::Error> {
    to.serialize_str(&format!("{checksum:08x}"))
}

/// A measured input and the tables that were made from it.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
pub struct Input {
    /// The file and where it came from.
    #[serde(flatten)]
    pub provenance: Provenance,
    /// Names of the tables' files.
    pub tables: Vec<String>,
}

/// Tables, and their inputs in the order in which the tables first name them.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Sources {
    /// The tables.
    pub tables: Vec<TableFile>,
    /// The inputs; one that changed between two tables stands twice, with either checksum.
    pub inputs: Vec<Input>,
}

impl Sources {
    /// Of the tables of these names in a folder.
    ///
    /// # Errors
    /// [`TableError`], with the path, if a table cannot be read.
    pub fn of(data_dir: &Path, files: &[String]) -> Result<Self, TableError> {
        let mut sources = Self::default();
        for file in files {
            sources.add(&data_dir.join(file), file)?;
        }
        Ok(sources)
    }

    /// Of every `.table` of a folder, by name.
    ///
    /// # Errors
    /// [`SourcesError`] if the folder cannot be listed or has no table, or a table cannot be read.
    pub fn of_folder(data_dir: &Path) -> Result<Self, SourcesError> {
        let failed = |source| SourcesError::Folder { path: data_dir.into(), source };
        let mut files = Vec::new();
        for entry in std::fs::read_dir(data_dir).map_err(failed)? {
            let name = entry.map_err(failed)?.file_name().to_string_lossy().into_owned();
            if name.ends_with(".table") {
                files.push(name);
            }
        }
        if files.is_empty() {
            return Err(SourcesError::NoTable { path: data_dir.into() });
        }
        files.sort();
        Ok(Self::of(data_dir, &files)?)
    }

    /// Of a table alone, and the table.
    ///
    /// # Errors
    /// [`TableError`], with the path, if it cannot be read.
    pub fn of_file(path: &Path) -> Result<(Self, Table), TableError> {
        let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
        let mut sources = Self::default();
        let table = sources.add(path, &name)?;
        Ok((sources, table))
    }

    /// Adds the table of a path, under the name `file`.
    fn add(&mut self, path: &Path, file: &str) -> Result<Table, TableError> {
        let bytes = std::fs::read(path).map_err(|source| TableError::Read { path: path.into(), source })?;
        let table = tables::file::decode(&bytes).map_err(|e| e.at(path))?;
        for provenance in table.provenance.iter().cloned() {
            match self.inputs.iter_mut().find(|input| input.provenance == provenance) {
                Some(input) => input.tables.push(file.into()),
                None => self.inputs.push(Input { provenance, tables: vec![file.into()] }),
            }
        }
        // A file that decodes has a checksum.
        let checksum = tables::file::checksum(&bytes).unwrap_or_default();
        self.tables.push(TableFile { file: file.into(), title: table.title.clone(), checksum });
        Ok(table)
    }

    /// Compares the inputs with the files of a folder such as `raw-data/`.
    ///
    /// # Errors
    /// [`SourcesError::Input`] for one that cannot be read, [`SourcesError::Changed`] naming all that differ.
    pub fn check(&self, raw_dir: &Path) -> Result<(), SourcesError> {
        let mut files = Vec::new();
        for Input { provenance, .. } in &self.inputs {
            let path = raw_dir.join(&provenance.file);
            let bytes = std::fs::read(&path).map_err(|source| SourcesError::Input { path, source })?;
            if raw::sha256(&bytes) != provenance.sha256 {
                files.push(provenance.file.clone());
            }
        }
        if files.is_empty() { Ok(()) } else { Err(SourcesError::Changed { files }) }
    }

    /// Tables with their checksums, and the citations of the inputs, for people.
    #[must_use]
    pub fn text(&self) -> String {
        let rows: Vec<Vec<String>> =
            self.tables.iter().map(|t| vec![t.file.clone(), format!("{:08x}", t.checksum), t.title.clone()]).collect();
        let mut text = format!("tables and their checksums\n{}", crate::text::aligned(&rows, 2, |_| false));
        text += "\nfrom\n";
        let mut said: Vec<(&str, &str)> = Vec::new();
        for Input { provenance, .. } in &self.inputs {
            let one = (provenance.citation.as_str(), provenance.licence.as_str());
            if !said.contains(&one) {
                said.push(one);
                text += &format!("  {}\n", wrapped(&format!("{} [{}]", one.0, one.1), 2, 4, WIDTH));
            }
        }
        text
    }
}

/// Characters of a line of citations.
const WIDTH: usize = 100;

/// Something that is used and is neither table nor input: a font, colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
pub struct Other {
    /// What it is.
    pub title: &'static str,
    /// Who made it.
    pub citation: &'static str,
    /// Where it is used.
    pub used_in: &'static str,
    /// Licence or terms.
    pub licence: &'static str,
}

/// What the figures are drawn with.
pub const OTHERS: [Other; 3] = [
    Other {
        title: "DejaVu Sans 2.37, cut down to the letters of the figures",
        citation: "DejaVu fonts, after Bitstream Vera (Bitstream, Inc.) and Arev (Tavmjong Bah)",
        used_in: "tools/assets/DejaVuSans-subset.ttf, inside airlight-tools",
        licence: "Bitstream Vera and Arev licences, changes in the public domain: tools/assets/DejaVu-LICENSE.txt",
    },
    Other {
        title: "Colour map viridis, eleven colours",
        citation: "van der Walt, S., Smith, N., 2015",
        used_in: "figures of a quantity over two axes",
        licence: "CC0",
    },
    Other {
        title: "Colours that colour-blind eyes tell apart",
        citation: "Okabe, M., Ito, K.: Color Universal Design, 2008",
        used_in: "lines of figures",
        licence: "Published numbers (facts)",
    },
];

/// Everything used, for people: each input with its licence and tables, then [`OTHERS`].
#[must_use]
pub fn describe(sources: &Sources) -> String {
    let mut text = String::new();
    let mut section = |heading: &str, rows: &[(&str, &str)]| {
        text += &format!("{heading}\n");
        for (key, value) in rows {
            text += &format!("  {key:8}  {}\n", wrapped(value, 12, 12, WIDTH));
        }
        text.push('\n');
    };
    for Input { provenance: from, tables } in &sources.inputs {
        let rows = [
            ("title", from.title.as_str()),
            ("citation", &from.citation),
            ("read in", &from.source),
            ("licence", &from.licence),
            ("SHA-256", &from.sha256),
            ("used by", &tables.join(" ")),
        ];
        section(&format!("raw-data/{}", from.file), &rows);
    }
    for other in OTHERS {
        section(other.title, &[("by", other.citation), ("used in", other.used_in), ("licence", other.licence)]);
    }
    section("Rust crates", &[("licences", CRATES)]);
    text.pop();
    text
}

/// The inputs and [`OTHERS`] as columns of words.
///
/// # Errors
/// [`SheetError`] if they make no sheet.
pub fn sheet(sources: &Sources) -> Result<Sheet, SheetError> {
    let inputs = sources.inputs.iter().map(|Input { provenance: from, tables }| {
        let file = format!("raw-data/{}", from.file);
        [&file, &from.title, &from.citation, &from.source, &from.licence, &from.sha256, &tables.join(" ")]
            .map(String::clone)
    });
    let others = OTHERS
        .iter()
        .map(|other| ["", other.title, other.citation, other.used_in, other.licence, "", ""].map(String::from));
    let rows: Vec<[String; 7]> = inputs.chain(others).collect();
    let names = [
        ("file", "file of the input"),
        ("title", "what it is"),
        ("citation", "publication or maker"),
        ("source", "where it was read or is used"),
        ("licence", "licence or terms"),
        ("sha256", "SHA-256 of the file"),
        ("tables", "tables made from it, separated by spaces"),
    ];
    let column = |(i, (name, meaning)): (usize, (&str, &str))| Series {
        name: name.into(),
        label: name.into(),
        unit: "text".into(),
        meaning: meaning.into(),
        group: Some("sources"),
        values: Values::Words(rows.iter().map(|row| row[i].clone()).collect()),
    };
    let columns = names.into_iter().enumerate().map(column).collect();
    Sheet::new("Everything used".into(), Vec::new(), Sources::default(), columns)
}

/// How to list the crates and their licences: they change with `Cargo.lock`, so Cargo says it best.
const CRATES: &str = "cargo tree --workspace --edges normal --prefix none --format '{p}: {l}'";

/// Everything used, as JSON: an object of `tables`, `inputs`, `others` and `crates`, the command that lists them.
///
/// # Errors
/// [`SheetError`] if that cannot be JSON.
pub fn json(sources: &Sources) -> Result<String, SheetError> {
    Ok(format!(
        "{{\n\"tables\": {},\n\"inputs\": {},\n\"others\": {},\n\"crates\": {}\n}}\n",
        json_list(&sources.tables)?,
        json_list(&sources.inputs)?,
        json_list(OTHERS)?,
        json_list([CRATES])?
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn folder(name: &str) -> PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name)
    }

    #[test]
    fn every_input_is_named_once_with_the_tables_that_use_it() {
        let sources = Sources::of_folder(&folder("data")).expect("tables");
        assert_eq!(sources.tables.len(), crate::build::Target::all().len());
        let text = describe(&sources);
        for input in &sources.inputs {
            let heading = format!("raw-data/{}\n", input.provenance.file);
            assert_eq!(text.matches(&heading).count(), 1, "{heading}");
            assert!(!input.provenance.licence.is_empty() && !input.tables.is_empty(), "{heading}");
        }
        let named =
            |t: &TableFile| Sources::of_file(&folder("data").join(&t.file)).expect("a table").1.provenance.len();
        let (uses, named): (usize, usize) =
            (sources.inputs.iter().map(|i| i.tables.len()).sum(), sources.tables.iter().map(named).sum());
        assert_eq!(uses, named);
        assert!(text.contains("DejaVu") && text.lines().all(|line| line.chars().count() <= 140), "{text}");
    }

    #[test]
    fn inputs_are_compared_with_what_the_tables_were_made_from() {
        let mut sources = Sources::of(&folder("data"), &["rayleigh.table".into()]).expect("a table");
        sources.check(&folder("raw-data")).expect("unchanged");
        sources.inputs[0].provenance.sha256 = "00".into();
        let error = sources.check(&folder("raw-data")).expect_err("changed").to_string();
        assert_eq!(error, format!("not what the tables were made from: {}", sources.inputs[0].provenance.file));
        assert!(matches!(sources.check(&folder("data")), Err(SourcesError::Input { .. })));
        assert!(matches!(Sources::of_folder(&folder("docs")), Err(SourcesError::NoTable { .. })));
    }
}
