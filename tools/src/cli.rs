//! The command line. Results go to standard output, progress and errors to standard error.

mod aerosol;
mod coefficients;
mod examples;
#[cfg(feature = "study")]
mod figures;
mod files;
mod import;
mod lint;
mod mie;
mod output;
mod place;
mod report;

use clap::{Args, Parser, Subcommand};
use std::io::Write;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::{Duration, Instant};
use tools::aerosol::bulk::Rule;
use tools::build::{self, Built, CheckReport, Target};

/// Makes, checks and shows the tables that Airlight's renderer reads.
#[derive(Parser)]
#[command(name = "airlight-tools", version, max_term_width = 100, after_help = examples::PROGRAM)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Make every table from the raw data, or check that the tables are what the raw data make
    #[command(after_help = examples::BUILD)]
    Build(BuildArgs),
    /// Make a table of a file of your own: an aerosol, a radiosonde, an ozone sonde, a solar spectrum, an albedo
    #[command(after_help = examples::IMPORT)]
    Import(import::ImportArgs),
    /// Show what tables or CSV files hold: settings, axes, fields with their ranges, and where it came from
    #[command(after_help = examples::INSPECT)]
    Inspect(files::InspectArgs),
    /// Number densities, cross-sections, coefficients, optical depths and phase functions of the air over a place
    #[command(after_help = examples::COEFFICIENTS)]
    Coefficients(coefficients::CoefficientsArgs),
    /// Write a table as CSV, JSON or Parquet; or the air over a place for Mitsuba, pbrt, Blender, Unreal or Bevy
    #[command(after_help = examples::EXPORT)]
    Export(files::ExportArgs),
    /// Citations and licences of everything that the tables and figures are made from
    #[command(after_help = examples::SOURCES)]
    Sources(files::SourcesArgs),
    /// Scatter light by spheres: efficiencies and amplitudes of every line of a CSV file
    #[command(after_help = examples::MIE)]
    Mie(mie::MieArgs),
    /// The aerosols of data/: extinction, albedo, asymmetry, Angstrom exponent and optical depth of each biome
    #[command(after_help = examples::BIOMES)]
    Biomes(aerosol::BiomesArgs),
    /// Find what cannot be right in tables and CSV files: units, swapped columns, impossible values
    #[command(after_help = examples::LINT)]
    Lint(lint::LintArgs),
    /// Write one page with what the tables hold, all figures and the pictures of the documents: HTML that opens from disk
    #[command(after_help = examples::REPORT)]
    Report(report::ReportArgs),
    /// Write the script that makes a shell complete the words of this program
    Completions(manners::CompletionArgs),
    /// Write manual pages, of the program and of each subcommand
    Man(manners::ManArgs),
    /// Draw what the tables hold: SVG, PNG and CSV of each figure
    #[cfg(feature = "plot")]
    #[command(after_help = examples::PLOT)]
    Plot(figures::PlotArgs),
    /// Draw points of a CSV file, as `airlight study` writes it: SVG and PNG beside it
    #[cfg(feature = "plot")]
    #[command(after_help = examples::CHART)]
    Chart(figures::ChartArgs),
    /// Compute how far numbers that should agree do not: CSV, and SVG and PNG of each study
    #[cfg(feature = "study")]
    #[command(after_help = examples::STUDY)]
    Study(figures::StudyArgs),
}

#[derive(Args)]
struct BuildArgs {
    /// Folder of the measured inputs
    #[arg(long, value_name = "DIR", default_value = "raw-data")]
    raw_data: PathBuf,
    /// Folder of the tables; made if it is not there
    #[arg(long, value_name = "DIR", default_value = "data")]
    data: PathBuf,
    /// Write nothing: rebuild in memory, compare value by value, and fail if anything differs
    #[arg(long)]
    check: bool,
    /// Only the tables whose file name contains this; may be given more than once [default: all]
    #[arg(long, value_name = "TEXT")]
    only: Vec<String>,
    /// Factor on the tolerances of averages over particle sizes, 0.001 to 1000. With 1, cross-sections and g to 1e-6 and phase
    /// functions to 1e-5 where k >= 0.005, 1e-4 and 1e-2 elsewhere; a table says where 12800 and 51200 intervals do not reach that
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = tolerance)]
    tolerance: f64,
    /// Say nothing but errors
    #[arg(long)]
    quiet: bool,
}

/// A factor on tolerances.
fn tolerance(text: &str) -> Result<f64, String> {
    let (low, high) = Rule::FACTORS;
    let factor: f64 = text.parse().map_err(|_| format!("{text:?} is not a number"))?;
    if (low..=high).contains(&factor) { Ok(factor) } else { Err(format!("{factor} is not within {low} to {high}")) }
}

impl BuildArgs {
    /// How finely sizes are resolved.
    fn rule(&self) -> Rule {
        Rule::TABLES.scaled(self.tolerance)
    }

    /// The tables to make or check.
    fn targets(&self) -> Result<Vec<Target>, String> {
        let mut targets = Target::all();
        if !self.only.is_empty() {
            targets.retain(|target| self.only.iter().any(|text| target.file_name().contains(text.as_str())));
        }
        if targets.is_empty() { Err(format!("no table is called {}", self.only.join(" or "))) } else { Ok(targets) }
    }
}

/// Parses the arguments and does what they say: 0 on success, 1 with one sentence on failure, 2 for
/// arguments that make no sense.
pub(crate) fn run() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Build(args) if args.check => check_tables(&args),
        Command::Build(args) => build_tables(&args),
        Command::Import(args) => import::import(&args),
        Command::Inspect(args) => files::show(&args),
        Command::Coefficients(args) => coefficients::write(&args),
        Command::Export(args) => files::export(&args),
        Command::Sources(args) => files::name_sources(&args),
        Command::Mie(args) => mie::solve(&args),
        Command::Biomes(args) => aerosol::biomes(&args),
        Command::Lint(args) => return lint::run(&args),
        Command::Report(args) => report::write(&args),
        Command::Completions(args) => output::print(&manners::completions::<Cli>(args.shell)),
        Command::Man(args) => man(&args),
        #[cfg(feature = "plot")]
        Command::Plot(args) => figures::draw(&args),
        #[cfg(feature = "plot")]
        Command::Chart(args) => figures::chart(&args),
        #[cfg(feature = "study")]
        Command::Study(args) => figures::study(&args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(sentence) => {
            say(&format!("error: {sentence}"));
            ExitCode::FAILURE
        }
    }
}

/// Writes the manual pages.
fn man(args: &manners::ManArgs) -> Result<(), String> {
    let written = manners::put_pages::<Cli>(args.folder.as_deref(), tables::file::replace);
    for path in written.map_err(|(path, error)| format!("{}: cannot be written: {error}", path.display()))? {
        output::print(format!("{}\n", path.display()).as_bytes())?;
    }
    Ok(())
}

/// A line on standard error. That nobody reads it is no reason to fail.
fn say(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// The path of a table, padded so that what follows stands in columns.
fn padded(args: &BuildArgs, name: &str) -> String {
    let path = |name: &str| args.data.join(name).display().to_string();
    let width = Target::all().into_iter().map(|target| path(&target.file_name()).chars().count()).max().unwrap_or(0);
    format!("{:width$}", path(name))
}

fn build_tables(args: &BuildArgs) -> Result<(), String> {
    let start = Instant::now();
    let progress = |built: &Built| {
        if !args.quiet {
            let path = padded(args, &built.target.file_name());
            say(&format!("{path}  {:>9}  {}", size(built.bytes), seconds(built.time)));
        }
    };
    let built = build::build_some(&args.raw_data, &args.data, &args.targets()?, &args.rule(), progress)
        .map_err(|e| e.to_string())?;
    if !args.quiet {
        let total = built.iter().map(|table| table.bytes).sum();
        say(&format!("{} tables, {} in {}", built.len(), size(total), seconds(start.elapsed())));
    }
    Ok(())
}

fn check_tables(args: &BuildArgs) -> Result<(), String> {
    let start = Instant::now();
    let report =
        build::check_some(&args.raw_data, &args.data, &args.targets()?, &args.rule()).map_err(|e| e.to_string())?;
    if !args.quiet {
        for table in &report.tables {
            let path = padded(args, &table.target.file_name());
            let verdict = if table.differences.is_empty() { "as rebuilt" } else { "differs" };
            say(&format!("{path}  {verdict:<10}  largest relative deviation {:.1e}", table.largest_relative));
            for difference in &table.differences {
                say(&format!("    {difference}"));
            }
        }
        for name in &report.foreign {
            say(&format!("{}  foreign     no build writes this file", padded(args, name)));
        }
        say(&format!("{} tables checked in {}", report.tables.len(), seconds(start.elapsed())));
    }
    if report.is_clean() { Ok(()) } else { Err(verdict(args, &report)) }
}

/// One sentence on a check that failed.
fn verdict(args: &BuildArgs, report: &CheckReport) -> String {
    let bad: Vec<String> =
        report.tables.iter().filter(|t| !t.differences.is_empty()).map(|t| t.target.file_name()).collect();
    let mut parts = Vec::new();
    if !bad.is_empty() {
        parts.push(format!("{} not what {} makes", bad.join(", "), args.raw_data.display()));
    }
    if !report.foreign.is_empty() {
        parts.push(format!("{} written by no build", report.foreign.join(", ")));
    }
    format!("{}: {}", args.data.display(), parts.join("; "))
}

fn size(bytes: u64) -> String {
    format!("{:.1} kB", bytes as f64 / 1e3)
}

fn seconds(time: Duration) -> String {
    format!("{:.2} s", time.as_secs_f64())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn every_flag_with_a_value_says_what_holds_without_it_and_every_command_has_examples() {
        Cli::command().debug_assert();
        assert_eq!(manners::silent::<Cli>(), Vec::<String>::new());
    }

    #[test]
    fn factors_on_tolerances_are_refused_beyond_their_range() {
        assert_eq!(tolerance("0.5"), Ok(0.5));
        assert!(["0", "-1", "1e4", "NaN", "much"].iter().all(|text| tolerance(text).is_err()));
    }

    #[test]
    fn sizes_and_times_are_short() {
        assert_eq!(size(123_456), "123.5 kB");
        assert_eq!(seconds(Duration::from_millis(1234)), "1.23 s");
    }
}
