//! The command `airlight`.
//!
//! Results go to files, and what they are to standard output; progress and errors
//! go to standard error. Exit codes stand below the help.

mod args;
mod auto;
mod bench;
mod compare;
mod doctor;
mod examples;
mod gallery;
mod light;
mod merge;
mod output;
mod picture;
mod plan;
mod progress;
mod radiance;
mod render;
mod scene;
mod sequence;
mod study;
mod sweep;
mod words;

use crate::scene::SceneError;
use clap::Parser;
use std::process::ExitCode;

/// Renders the sky of a spherical planet from optical tables.
#[derive(Debug, Parser)]
#[command(name = "airlight", version, max_term_width = 100, after_help = examples::PROGRAM)]
enum Command {
    /// Render a picture: EXR to calculate with, PNG to look at
    #[command(after_help = examples::RENDER)]
    Render(Box<args::RenderArgs>),
    /// Say how a picture is made cheapest within an error, by stored measurements: method, wavelengths, what is left out and why that may be.
    /// Takes the flags of render
    #[command(after_help = examples::PLAN)]
    Plan(Box<plan::PlanArgs>),
    /// Render a day, a sunset, an ascent or any course of sun, observer and camera as numbered frames without flicker, from tables that
    /// are solved once. Takes the flags of render
    #[command(after_help = examples::SEQUENCE)]
    Sequence(Box<sequence::SequenceArgs>),
    /// Write the light of a sky for another renderer: an environment map in its orientation, and the sun apart. Takes the flags of render
    #[command(after_help = examples::LIGHT)]
    Light(Box<light::LightArgs>),
    /// Write, check and show scene files
    #[command(subcommand, after_help = examples::SCENE)]
    Scene(scene::SceneCommand),
    /// Render the figures of the gallery: the counterparts of those of the thesis, and others
    #[command(after_help = examples::GALLERY)]
    Gallery(gallery::GalleryArgs),
    /// Put runs with different seeds or shards together as one picture
    #[command(after_help = examples::MERGE)]
    Merge(merge::MergeArgs),
    /// Say how far two pictures of one scene differ: relative errors, standard errors, colours
    #[command(after_help = examples::COMPARE)]
    Compare(compare::CompareArgs),
    /// Say why a picture is black, noisy, blown out or slow, or would be, each with its number and a remedy
    #[command(after_help = examples::DOCTOR)]
    Doctor(doctor::DoctorArgs),
    /// Answer a file of reference cases: radiances with their standard errors
    #[command(after_help = examples::RADIANCE)]
    Radiance(radiance::RadianceArgs),
    /// Measure what a direction and a picture cost on skies that other renderers were timed on
    #[command(after_help = examples::BENCH)]
    Bench(bench::BenchArgs),
    /// Compute how errors go with size and cost: CSV, which airlight-tools chart draws
    #[command(after_help = examples::STUDY)]
    Study(study::StudyArgs),
    /// Trace paths through scenes drawn at random, and report any that is not finite, negative or endless
    #[command(after_help = examples::SWEEP)]
    Sweep(sweep::SweepArgs),
    /// Write the script that makes a shell complete the words of this program
    Completions(manners::CompletionArgs),
    /// Write manual pages, of the program and of each subcommand
    Man(manners::ManArgs),
}

/// What a command ends in, short of an error.
enum Outcome {
    Done,
    Interrupted,
    /// What was compared differs by more than was asked.
    Differs,
}

/// Why a command fails: one sentence and an exit code.
struct Failure {
    message: String,
    code: u8,
}

impl Failure {
    fn usage(message: impl std::fmt::Display) -> Self {
        Self { message: message.to_string(), code: 2 }
    }

    fn error(message: impl std::fmt::Display) -> Self {
        Self { message: message.to_string(), code: 1 }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        Self::usage(error)
    }
}

/// Runs the program with the arguments of the process.
#[must_use]
pub fn main() -> ExitCode {
    let outcome = match Command::parse() {
        Command::Render(args) => render::run(&args),
        Command::Plan(args) => plan::run(&args),
        Command::Light(args) => light::run(&args),
        Command::Sequence(args) => sequence::run(&args),
        Command::Scene(command) => scene::run(&command),
        Command::Gallery(args) => gallery::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Doctor(args) => doctor::run(&args),
        Command::Radiance(args) => radiance::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Study(args) => study::run(&args),
        Command::Sweep(args) => sweep::run(&args),
        Command::Completions(args) => {
            output::bytes(&manners::completions::<Command>(args.shell));
            Ok(Outcome::Done)
        }
        Command::Man(args) => man(&args),
    };
    match outcome.and_then(|outcome| output::finish().map(|()| outcome)) {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Interrupted) => ExitCode::from(130),
        Ok(Outcome::Differs) => ExitCode::from(1),
        Err(Failure { message, code }) => {
            output::eprintln!("airlight: {message}");
            ExitCode::from(code)
        }
    }
}

/// Writes the manual pages.
fn man(args: &manners::ManArgs) -> Result<Outcome, Failure> {
    let written = manners::put_pages::<Command>(args.folder.as_deref(), tables::file::replace);
    for path in written.map_err(|(path, error)| unwritable(&path, &error))? {
        output::println!("{}", path.display());
    }
    Ok(Outcome::Done)
}

/// Says that a file which is there will be replaced.
fn announce(path: &std::path::Path, quiet: bool) {
    if !quiet && path.exists() {
        output::println!("replaces    {}", path.display());
    }
}

/// Writes a file whole.
fn write(path: &std::path::Path, bytes: &[u8]) -> Result<(), Failure> {
    tables::file::replace(path, bytes).map_err(|error| unwritable(path, &error))
}

/// A file that cannot be written.
fn unwritable(path: &std::path::Path, error: &std::io::Error) -> Failure {
    Failure::error(format!("{}: cannot be written: {error}", path.display()))
}

/// The tables of a folder, or those that the program carries.
fn data(folder: Option<&std::path::Path>) -> Result<crate::data::Data, Failure> {
    folder.map_or_else(crate::data::Data::carried, crate::data::Data::load).map_err(Failure::error)
}

/// The folder, made if it is named and not there.
fn made(folder: Option<&std::path::Path>) -> Result<Option<&std::path::Path>, Failure> {
    if let Some(folder) = folder {
        std::fs::create_dir_all(folder).map_err(|error| unwritable(folder, &error))?;
    }
    Ok(folder)
}

/// A name that nothing has, with the nearest known one, or all of them.
fn unknown<'a>(what: &str, name: &str, known: impl IntoIterator<Item = &'a str> + Clone) -> Failure {
    let hint = match tables::nearest(name, known.clone()) {
        Some(near) => format!("; did you mean {near}?"),
        None => format!("; known are {}", known.into_iter().collect::<Vec<_>>().join(", ")),
    };
    Failure::usage(format!("{what} {:?} is not known{hint}", tables::excerpt(name)))
}

/// A pool of that many threads, all processors if `None`.
fn pool(threads: Option<u16>) -> Result<rayon::ThreadPool, Failure> {
    let threads = threads.map_or(0, usize::from);
    rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(Failure::error)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn every_flag_with_a_value_says_what_holds_without_it_and_every_command_has_examples() {
        Command::command().debug_assert();
        assert_eq!(manners::silent::<Command>(), Vec::<String>::new());
    }
}
