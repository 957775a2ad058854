//! `airlight scene`.

use super::output::println;
use super::render::{read_scene, sky};
use super::{Failure, Outcome, unwritable};
use crate::data::Data;
use crate::gallery::{self, presets};
use crate::scene::{Scene, schema};
use clap::Subcommand;
use std::io::Write;
use std::path::{Path, PathBuf};
use tables::excerpt;

/// What `airlight scene` does.
#[derive(Debug, Subcommand)]
pub(super) enum SceneCommand {
    /// Write a scene file with every key, its meaning, unit, range and default, to be filled in
    New {
        /// File to write, which must not be there; standard output if none is given
        #[arg(value_name = "FILE.toml")]
        file: Option<PathBuf>,
        /// Begin with a scene of the gallery [default: the default scene]
        #[arg(long, value_name = "NAME")]
        preset: Option<String>,
        /// List the presets, a line each, and write nothing
        #[arg(long, conflicts_with_all = ["file", "preset"])]
        list: bool,
    },
    /// Say whether scene files can be rendered, and with which tables
    Check {
        /// Scenes: TOML, JSON, or the EXR files of pictures
        #[arg(value_name = "SCENE", required = true)]
        scenes: Vec<PathBuf>,
        /// Folder of the tables [default: those that the program carries]
        #[arg(long, value_name = "DIR")]
        data: Option<PathBuf>,
    },
    /// Show a scene, or that of a picture, as TOML: the keys that are not at their defaults
    Show {
        /// Scene: TOML, JSON, or the EXR file of a picture
        #[arg(value_name = "SCENE")]
        scene: PathBuf,
        /// Every key, with its meaning
        #[arg(long)]
        all: bool,
        /// As JSON
        #[arg(long, conflicts_with = "all")]
        json: bool,
    },
    /// Print the JSON schema of scene files, for editors
    Schema,
}

/// The file of the schema.
const SCHEMA: &str = "scene.schema.json";

/// What a new file begins with.
const HEAD: &str = "\
# A scene of airlight: airlight render FILE.toml
# Every key is here with its default; take the # away from those that shall say something else.

";

pub(super) fn run(command: &SceneCommand) -> Result<Outcome, Failure> {
    match command {
        SceneCommand::New { list: true, .. } => {
            presets().iter().for_each(|panel| println!("{:28} {}", panel.name, panel.line));
            Ok(Outcome::Done)
        }
        SceneCommand::New { file, preset: name, .. } => {
            new(file.as_deref(), &name.as_deref().map_or_else(|| Ok(Scene::default()), preset)?)
        }
        SceneCommand::Check { scenes, data } => {
            let data = super::data(data.as_deref())?;
            scenes.iter().try_for_each(|path| check(path, &data)).map(|()| Outcome::Done)
        }
        SceneCommand::Show { scene, all, json } => {
            let scene = read_scene(scene, &[])?;
            let text = if *json { scene.to_json() } else { scene.to_toml(*all) };
            println!("{}", text.trim_end());
            Ok(Outcome::Done)
        }
        SceneCommand::Schema => {
            println!("{}", serde_json::to_string_pretty(&schema()).map_err(Failure::error)?);
            Ok(Outcome::Done)
        }
    }
}

/// The scene of a preset.
pub(super) fn preset(name: &str) -> Result<Scene, Failure> {
    gallery::preset(name).ok_or_else(|| {
        let all = presets();
        let near = tables::nearest(name, all.iter().map(|panel| panel.name.as_str()));
        let near = near.map_or_else(String::new, |near| format!("; did you mean {near}?"));
        Failure::usage(format!("preset {:?} is not known{near} (airlight scene new --list)", excerpt(name)))
    })
}

/// Writes a scene to a file that is not there yet. With the schema beside it, editors check and complete it (the directive of taplo).
fn new(file: Option<&Path>, scene: &Scene) -> Result<Outcome, Failure> {
    let beside = |path: &Path| path.with_file_name(SCHEMA).is_file();
    let directive = if file.is_some_and(beside) { format!("#:schema {SCHEMA}\n") } else { String::new() };
    let text = format!("{directive}{HEAD}{}", scene.to_toml(true));
    let Some(path) = file else {
        println!("{}", text.trim_end());
        return Ok(Outcome::Done);
    };
    // What is there is somebody's work.
    let made = std::fs::OpenOptions::new().write(true).create_new(true).open(path);
    made.and_then(|mut file| file.write_all(text.as_bytes())).map_err(|error| unwritable(path, &error))?;
    println!("{}", path.display());
    Ok(Outcome::Done)
}

/// Everything but the rendering.
fn check(path: &Path, data: &Data) -> Result<(), Failure> {
    let at = |failure: Failure| Failure { message: format!("{}: {}", path.display(), failure.message), ..failure };
    let scene = read_scene(path, &[])?;
    scene.validate().map_err(|error| at(error.into()))?;
    // Without solving: a single scattering of the same air names the same tables.
    let quick = Scene { method: crate::transport::Method::Single, ..scene.clone() };
    let answers = if scene.method == crate::transport::Method::Solved { &quick } else { &scene };
    sky(answers, data, None).map_err(at)?;
    let (width, height) = scene.size();
    let sun = format!("the sun {:.2} degrees high", scene.sun_elevation_deg);
    println!("{}: {width} x {height} pixels of {} wavelengths, {sun}", path.display(), scene.wavelengths().nm().len());
    Ok(())
}
