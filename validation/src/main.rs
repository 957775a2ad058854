//! `airlight-validate`: writes the validation report.
#![allow(clippy::print_stdout, clippy::print_stderr, reason = "the main file of a program")]

use airlight_validation::{Context, Name, report};
use clap::Parser;
use renderer::data::Data;
use std::io::{IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Compares Airlight with published and independent answers and writes the report with the points of its charts
#[derive(Debug, Parser)]
#[command(name = "airlight-validate", version)]
struct Args {
    /// Only these sections, printed and not written
    #[arg(long, value_name = "SECTION", num_args = 1.., value_parser = section)]
    only: Vec<Name>,
    /// Name the sections
    #[arg(long, conflicts_with_all = ["only", "quick", "check"])]
    list: bool,
    /// Core cases and fewer samples; printed and not written
    #[arg(long)]
    quick: bool,
    /// Write nothing; fail if the report does not hold what is found, of all sections or of those of --only
    #[arg(long, conflicts_with = "quick")]
    check: bool,
    /// The report [default: docs/validation.md of the root]
    #[arg(short, long, value_name = "FILE.md")]
    output: Option<PathBuf>,
    /// Root of the project, with data/, raw-data/, plots/ and validation/
    #[arg(long, value_name = "DIR", default_value = ".")]
    root: PathBuf,
}

fn section(text: &str) -> Result<Name, String> {
    let names = Name::ALL.map(Name::as_str).join(", ");
    Name::ALL.into_iter().find(|name| name.as_str() == text).ok_or_else(|| format!("the sections are {names}"))
}

/// A line on standard error that is written over again and again, if that is a terminal.
struct Line {
    shown: bool,
    name: Mutex<(&'static str, Instant)>,
}

impl Line {
    fn begin(&self, name: Name) {
        if let Ok(mut state) = self.name.lock() {
            *state = (name.as_str(), Instant::now());
        }
        self.write(name.as_str(), 0.0);
    }

    fn show(&self, share: f64) {
        let Ok(mut state) = self.name.try_lock() else { return };
        if state.1.elapsed() >= Duration::from_millis(100) {
            state.1 = Instant::now();
            self.write(state.0, share);
        }
    }

    /// Progress that cannot be shown is no reason to stop.
    fn write(&self, name: &str, share: f64) {
        if self.shown {
            let _ = write!(std::io::stderr(), "\r\x1b[K{name} {:3.0} %", 100.0 * share);
        }
    }

    fn clear(&self) {
        if self.shown {
            let _ = write!(std::io::stderr(), "\r\x1b[K");
        }
    }
}

fn run(args: &Args) -> Result<(), String> {
    if args.list {
        for name in Name::ALL {
            println!("{:10} {}", name.as_str(), name.title());
        }
        return Ok(());
    }
    let root = &args.root;
    if !root.join("data").is_dir() {
        return Err(format!("{}: no folder data there: name the root of the project with --root", root.display()));
    }
    if !args.only.is_empty() && !args.check && args.output.is_some() {
        return Err("sections of --only are printed: leave out --output".into());
    }
    let output = args.output.clone().unwrap_or_else(|| root.join("docs/validation.md"));
    let writes = args.only.is_empty() && !args.check && (!args.quick || args.output.is_some());
    if writes {
        // Better now than after the work.
        tables::file::check_writable(&output).map_err(|e| unwritable(&output, &e))?;
    }
    let data = Data::load(&root.join("data")).map_err(|e| e.to_string())?;
    let line = Line { shown: std::io::stderr().is_terminal(), name: Mutex::new(("", Instant::now())) };
    let context = Context { root, data: &data, quick: args.quick, progress: &|share| line.show(share) };
    let names = if args.only.is_empty() { &Name::ALL[..] } else { &args.only };
    let all = report::sections(&context, names, &|name| line.begin(name));
    line.clear();
    let all = all.map_err(|e| e.to_string())?;
    if args.check {
        let page =
            std::fs::read_to_string(&output).map_err(|e| format!("{}: cannot be read: {e}", output.display()))?;
        let missing: Vec<&str> = report::missing(&page, &all).into_iter().map(Name::as_str).collect();
        return if missing.is_empty() {
            println!("{}: as found", output.display());
            Ok(())
        } else {
            Err(format!("{}: found otherwise: {}", output.display(), missing.join(", ")))
        };
    }
    if !writes {
        for (name, section) in &all {
            println!("{}", report::one(*name, section));
            println!("{}", report::findings(section.findings.iter().map(|finding| (*name, finding))));
        }
        return Ok(());
    }
    for (name, chart) in report::charts(&all) {
        let path = root.join("plots").join(name);
        tables::file::replace(&path, chart.csv().as_bytes()).map_err(|e| unwritable(&path, &e))?;
        println!("written {}", path.display());
    }
    tables::file::replace(&output, report::page(&all).as_bytes()).map_err(|e| unwritable(&output, &e))?;
    println!("written {}", output.display());
    Ok(())
}

fn unwritable(path: &Path, error: &std::io::Error) -> String {
    format!("{}: cannot be written: {error}", path.display())
}

fn main() -> ExitCode {
    match run(&Args::parse()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(what) => {
            eprintln!("error: {what}");
            ExitCode::FAILURE
        }
    }
}
