//! The subcommand `lint`.

use super::say;
use clap::{Args, ValueEnum};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use tables::views::{Aerosol, AerosolSource, Biome};
use tools::lint::{self, Finding, LintError, Severity};

/// Arguments of `lint`.
#[derive(Args)]
pub(super) struct LintArgs {
    /// Tables, CSV files with a header row, folders of them, or biomes by name, such as desert-dust
    #[arg(required = true, value_name = "TABLE|CSV|DIR|BIOME")]
    what: Vec<PathBuf>,
    /// Of a biome only the table of this source [default: both]
    #[arg(long, value_enum)]
    source: Option<Source>,
    /// Folder of the tables, for biomes
    #[arg(long, value_name = "DIR", default_value = "data")]
    data: PathBuf,
    /// Print the findings as a JSON array
    #[arg(long)]
    json: bool,
    /// No summary on standard error
    #[arg(long)]
    quiet: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum Source {
    Opac,
    Jaenicke,
}

/// The files that an argument stands for.
fn files(args: &LintArgs, what: &Path) -> Result<Vec<PathBuf>, LintError> {
    let biome = what.to_str().and_then(Biome::from_name).filter(|_| !what.exists());
    let Some(biome) = biome else { return lint::files(what) };
    let sources = match args.source {
        None => AerosolSource::ALL.to_vec(),
        Some(Source::Opac) => vec![AerosolSource::Opac],
        Some(Source::Jaenicke) => vec![AerosolSource::Jaenicke],
    };
    Ok(sources.into_iter().map(|source| args.data.join(Aerosol::file_name(source, biome))).collect())
}

/// Judges everything, prints the findings: 0 if there are none, 1 if there are, 2 if a file cannot be judged.
pub(super) fn run(args: &LintArgs) -> ExitCode {
    match judge(args) {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(sentence) => {
            say(&format!("error: {sentence}"));
            ExitCode::from(2)
        }
    }
}

fn judge(args: &LintArgs) -> Result<bool, String> {
    let mut paths = Vec::new();
    for what in &args.what {
        paths.extend(files(args, what).map_err(|e| e.to_string())?);
    }
    let mut findings = Vec::new();
    for path in &paths {
        findings.extend(lint::lint(path).map_err(|e| e.to_string())?);
    }
    let text = if args.json {
        serde_json::to_string_pretty(&findings).map_err(|e| e.to_string())? + "\n"
    } else {
        findings.iter().map(|finding| format!("{finding}\n")).collect()
    };
    match std::io::stdout().lock().write_all(text.as_bytes()) {
        // A reader that has seen enough, such as `head`.
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => return Err(format!("standard output: {e}")),
        _ => {}
    }
    if !args.quiet {
        say(&summary(paths.len(), &findings));
    }
    Ok(findings.is_empty())
}

fn summary(files: usize, findings: &[Finding]) -> String {
    let errors = findings.iter().filter(|finding| finding.severity == Severity::Error).count();
    let warnings = findings.len() - errors;
    let plural = |n: usize, word: &str| format!("{n} {word}{}", if n == 1 { "" } else { "s" });
    format!("{} checked: {}, {}", plural(files, "file"), plural(errors, "error"), plural(warnings, "warning"))
}
