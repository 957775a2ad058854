//! The subcommands `export`, `inspect` and `sources`.

use super::output;
use super::place::PlaceArgs;
use clap::Args;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use tools::column::Column;
use tools::data::Data;
use tools::numbers::Numbers;
use tools::programs::{Layers, Program};
use tools::sheet::Format;
use tools::sources::Sources;
use tools::{coefficients, export, inspect, sources};

/// In which form, and to where.
#[derive(Args)]
pub(super) struct OutputArgs {
    /// File to write [default: standard output]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Format [default: what the file's name ends in: .txt, .csv, .json, .parquet]
    #[arg(long, value_name = "FORMAT", value_parser = Format::NAMES)]
    format: Option<String>,
    /// Numbers alone: text and CSV without what is said of them
    #[arg(long)]
    pub(super) bare: bool,
}

impl OutputArgs {
    /// The format: as named, else as the file's name ends, else `standard` on standard output.
    pub(super) fn format(&self, standard: Format) -> Result<Format, String> {
        let named = self.format.as_deref().and_then(Format::from_name);
        let format = match (named, &self.output) {
            (Some(format), _) => format,
            (None, Some(path)) => Format::of_file(path).map_err(|e| e.to_string())?,
            (None, None) => standard,
        };
        if format == Format::Parquet && self.output.is_none() {
            return Err("Parquet is not for reading: name a file with --output".into());
        }
        Ok(format)
    }

    pub(super) fn file(&self) -> Option<&Path> {
        self.output.as_deref()
    }
}

/// Arguments of `export`.
#[derive(Args)]
pub(super) struct ExportArgs {
    /// A table, such as data/rayleigh.table
    #[arg(required_unless_present = "program", conflicts_with = "program")]
    file: Option<PathBuf>,
    /// Fields, separated by commas [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',', conflicts_with = "program")]
    field: Vec<String>,
    #[command(flatten)]
    output: OutputArgs,
    /// The air over a place for this program, into the folder --output: phase functions, coefficients and profiles, with their units
    /// [default: none, a table is written]
    #[arg(long = "for", value_name = "PROGRAM", id = "program", requires = "output", conflicts_with_all = ["format", "bare"],
        value_parser = Program::ALL.map(Program::name), help_heading = "The air for another program")]
    program: Option<String>,
    /// Wavelengths in nm, 300 to 1000: a list, a range [default: 550; for pbrt, blender, unreal and bevy 650,550,450, which stand for
    /// red, green and blue]
    #[arg(long, value_name = "NM", requires = "program", help_heading = "The air for another program")]
    wavelength: Option<Numbers>,
    /// Thickness of layers in km, 0.01 to 10
    #[arg(
        long,
        value_name = "KM",
        default_value_t = 0.1,
        requires = "program",
        help_heading = "The air for another program"
    )]
    step: f64,
    #[command(flatten, next_help_heading = "The air for another program")]
    place: PlaceArgs,
}

/// Writes a table in another format; CSV on standard output if nothing else is said. Or the air for a program.
pub(super) fn export(args: &ExportArgs) -> Result<(), String> {
    let file = match (&args.file, args.program.as_deref().and_then(Program::from_name)) {
        (_, Some(program)) => return export_for(program, args),
        (Some(file), None) => file,
        (None, None) => return Err("name a table, or a program with --for".into()),
    };
    let format = args.output.format(Format::Csv)?;
    let (sources, table) = Sources::of_file(file).map_err(|e| e.to_string())?;
    let at = |e: export::ExportError| format!("{}: {e}", file.display());
    let bytes = match format {
        Format::Json => export::json(&table, &args.field, &sources).map_err(at)?.into_bytes(),
        _ => {
            let sheet = export::sheet(&table, &args.field, sources).map_err(at)?;
            sheet.encode(format, args.output.bare).map_err(|e| at(e.into()))?
        }
    };
    output::put(&bytes, args.output.file())
}

/// Writes the files of a program into a folder.
fn export_for(program: Program, args: &ExportArgs) -> Result<(), String> {
    let Some(folder) = args.output.file() else { return Err("name a folder with --output".into()) };
    let place = args.place.place()?;
    let data = Data(&args.place.data);
    let column = Column::read(data, &place).map_err(|e| e.to_string())?;
    let sources = Sources::of(data.0, &place.table_files()).map_err(|e| e.to_string())?;
    let settings = coefficients::settings(&column, &place).map_err(|e| e.to_string())?;
    let wavelengths = args.wavelength.as_ref().map_or(program.wavelengths_nm(), |numbers| &numbers.0);
    let layers = Layers::new(&column, (wavelengths, args.step), settings, sources).map_err(|e| e.to_string())?;
    let files = layers.files(program).map_err(|e| e.to_string())?;
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: cannot be made: {e}", folder.display()))?;
    for (name, bytes) in &files {
        output::put(bytes, Some(&folder.join(name)))?;
    }
    let names: Vec<&str> = files.iter().map(|(name, _)| name.as_str()).collect();
    output::print(format!("{}: {}\n", folder.display(), names.join(", ")).as_bytes())
}

/// Arguments of `inspect`.
#[derive(Args)]
pub(super) struct InspectArgs {
    /// Tables, such as data/rayleigh.table, or CSV files of raw-data/ or of this program
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// JSON, an object for each table; not for CSV files
    #[arg(long)]
    json: bool,
}

/// Shows what files hold.
pub(super) fn show(args: &InspectArgs) -> Result<(), String> {
    let parts: Vec<String> = args.files.iter().map(|file| one(file, args.json)).collect::<Result<_, _>>()?;
    output::print(parts.join(if args.json { "" } else { "\n" }).as_bytes())
}

fn one(file: &Path, json: bool) -> Result<String, String> {
    let bytes = std::fs::read(file).map_err(|e| format!("{}: cannot be read: {e}", file.display()))?;
    if !json && file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("csv")) {
        let name = file.display().to_string();
        let described = inspect::describe_csv(&name, &bytes).map_err(|e| e.to_string())?;
        return Ok(format!("{name}: {} bytes, SHA-256 {}\n\n{described}", bytes.len(), tools::raw::sha256(&bytes)));
    }
    let (sources, table) = Sources::of_file(file).map_err(|e| e.to_string())?;
    if json {
        return export::json_header(&table, &sources).map_err(|e| format!("{}: {e}", file.display()));
    }
    let mut text = inspect::describe(&table);
    for entry in &sources.tables {
        // Writing to a String does not fail.
        let _ = writeln!(text, "\n{}: {} bytes, checksum {:08x}", file.display(), bytes.len(), entry.checksum);
    }
    Ok(text)
}

/// Arguments of `sources`.
#[derive(Args)]
pub(super) struct SourcesArgs {
    /// Folder of the tables
    #[arg(long, value_name = "DIR", default_value = "data")]
    data: PathBuf,
    /// Format
    #[arg(long, value_name = "FORMAT", default_value = "text", value_parser = ["text", "csv", "json"])]
    format: String,
    /// Folder of the measured inputs: compare each with its checksum in the tables, and fail if one differs
    /// [default: not compared]
    #[arg(long, value_name = "DIR")]
    raw_data: Option<PathBuf>,
}

/// Names everything used.
pub(super) fn name_sources(args: &SourcesArgs) -> Result<(), String> {
    let found = Sources::of_folder(&args.data).map_err(|e| e.to_string())?;
    let bytes = match args.format.as_str() {
        "json" => sources::json(&found).map(String::into_bytes),
        "csv" => sources::sheet(&found).and_then(|sheet| sheet.encode(Format::Csv, true)),
        _ => Ok(sources::describe(&found).into_bytes()),
    };
    output::print(&bytes.map_err(|e| e.to_string())?)?;
    match &args.raw_data {
        Some(folder) => found.check(folder).map_err(|e| e.to_string()),
        None => Ok(()),
    }
}
