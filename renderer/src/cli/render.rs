//! `airlight render`.

use super::args::{OUTPUT, RenderArgs};
use super::output::{eprintln, println};
use super::picture::{Files, Product, has_extension, read_state};
use super::progress::{Line, amount, percent};
use super::words::ShardName;
use super::{Failure, Outcome};
use crate::data::Data;
use crate::film::Film;
use crate::film::exr;
use crate::render::{
    Control, End, Extent, Head, Part, Progress, RenderError, Shard, Sky, State, Summary, certify, disc_layer, empty,
    go_on, receipt, replay,
};
use crate::scene::{Albedo, Scene, SceneError, Spectrum};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// How often the state of a run is kept.
const KEEP_EVERY: Duration = Duration::from_secs(60);

pub(super) fn run(args: &RenderArgs) -> Result<Outcome, Failure> {
    let begin = Instant::now();
    let shard = shard(args)?;
    let (scene, kept) = match &args.resume {
        Some(path) => {
            let state = read_state(path, &args.tables)?;
            (resumed(args, shard, &state, path)?, Some(state))
        }
        None => (scene(args)?, None),
    };
    if args.auto {
        return super::auto::run(args, &scene, begin);
    }
    if args.metric.is_some() {
        return Err(Failure::usage("--metric says what an error of --auto is of: add --auto"));
    }
    if args.files.spectral && scene.method.is_dome() {
        return Err(Failure::usage("a fitted sky has no spectrum: leave out --spectral"));
    }
    if args.certify.is_some() && scene.has_texture() {
        return Err(Failure::usage(
            "--certify asks whether a table solves its equations, and these are of a uniform ground: beside the map of the Earth \
             --method paths is exact",
        ));
    }
    let deadline = args.time.and_then(|time| begin.checked_add(time));
    let part = match kept.as_ref().map(|state| state.head.parts.as_slice()) {
        Some([part]) => *part,
        _ => Part { seed: scene.seed, shard: shard.unwrap_or_default() },
    };
    let extent = Extent { shard: part.shard, deadline };
    let (output, checkpoint) = names(args, shard);
    let files = Files::new(&output, checkpoint.as_deref(), !args.files.no_receipt)?;
    let data = super::data(args.files.data.as_deref())?;
    let pool = super::pool(args.threads)?;
    let folder = super::made(args.keep_tables.as_deref())?;
    let sky = pool.install(|| sky(&scene, &data, folder))?;
    // The picture says what was decided for it.
    let scene = sky.decided(scene);
    if args.certify.is_some() && !sky.is_solved() {
        return Err(Failure::usage("--certify looks at solved tables: leave --method out"));
    }
    if let Some((x, y)) = args.pixel {
        return print_sample(&scene, &sky, (x, y), args.sample);
    }
    files.announce(&args.files);
    let head = Head::new(&scene, &sky, vec![part]);
    let film = start(kept, &scene, &sky, extent, args.resume.as_deref())?;
    let stop = stop_on_interrupt();
    let mut last = Instant::now();
    let mut keep = |film: &Film| {
        if let Some(path) = files.state().filter(|_| last.elapsed() >= KEEP_EVERY) {
            // The last one counts; a picture is worth more than its checkpoint.
            if let Err(error) = tables::file::replace(path, &head.encode(film)) {
                eprintln!("airlight: {}: cannot be written, the run goes on: {error}", path.display());
            }
            last = Instant::now();
        }
    };
    let work = || {
        let (summary, disc) = (Summary::new(&sky, scene.seed, &stop), disc_layer(&scene, &sky));
        let line = Line::new(args.files.quiet);
        let observe = |progress: Progress| {
            line.show(progress.fraction, |elapsed| {
                let rate = amount(progress.samples as f64 / elapsed);
                format!("error {}  {rate} samples/s", percent(progress.error))
            });
        };
        let control = Control { stop: &stop, observe: &observe };
        let rendering = go_on(film, &scene, &sky, extent, control, &mut keep);
        line.clear();
        let verdict = args.certify.and_then(|asked| {
            let line = Line::new(args.files.quiet);
            let observe = |most: f64| line.show(0.0, |_| format!("certificate: off by at most {}", percent(most)));
            let verdict = certify(&scene, &sky, asked, &stop, &observe);
            line.clear();
            verdict
        });
        rendering.map(|rendering| (summary, disc, rendering, verdict))
    };
    let result = pool.install(work);
    let (summary, disc, rendering, verdict) = result.map_err(|error| match error {
        RenderError::NotFinite { x, y, sample } => {
            let command = replay_command(std::env::args(), (x, y), sample);
            Failure::error(format!("{error}; replay it with: {command}"))
        }
        other => Failure::error(other),
    })?;
    let end = rendering.end;
    let scene = as_made(scene, rendering.film.most_blocks(), extent, end);
    let head = Head { scene: scene.portable(), ..head };
    Product { scene: &scene, sky: &sky, summary, disc, rendering, head, verdict, achieved: None }.deliver(
        &files,
        &args.files,
        begin,
        &pool,
    )?;
    if end == End::Stopped {
        let hint = files.state().map_or(String::new(), |path| format!("; --resume {} goes on", path.display()));
        eprintln!("airlight: stopped by Ctrl-C; the picture holds the samples that were taken until then{hint}");
        return Ok(Outcome::Interrupted);
    }
    Ok(Outcome::Done)
}

/// The scene of the flags, laid over that of the file.
pub(super) fn scene(args: &RenderArgs) -> Result<Scene, Failure> {
    let base = match (&args.scene, &args.preset) {
        (Some(path), _) => read_scene(path, &args.tables)?,
        (None, Some(name)) => super::scene::preset(name)?,
        (None, None) => Scene::default(),
    };
    let mut scene = args.scene(base)?;
    read_albedo(&mut scene, None)?;
    Ok(scene)
}

/// Reads the spectrum of the ground if the scene names a CSV file, from the current folder or that of the scene's `file`: the
/// scene then has the numbers themselves.
fn read_albedo(scene: &mut Scene, file: Option<&Path>) -> Result<(), Failure> {
    let Albedo::Ground(name) = &scene.albedo else { return Ok(()) };
    if !has_extension(Path::new(name), "csv") {
        return Ok(());
    }
    let beside = file.and_then(Path::parent).map(|folder| folder.join(name)).filter(|path| path.is_file());
    let path = beside.unwrap_or_else(|| name.into());
    let text = std::fs::read(&path).map_err(|error| Failure::error(format!("{}: {error}", path.display())))?;
    let spectrum = Spectrum::from_csv(&text);
    scene.albedo = Albedo::Spectrum(spectrum.map_err(|error| Failure::usage(format!("{}: {error}", path.display())))?);
    Ok(())
}

/// The scene turned into something that answers.
pub(super) fn sky(scene: &Scene, data: &Data, kept: Option<&Path>) -> Result<Sky, Failure> {
    Sky::kept(scene, data, kept).map_err(failure)
}

/// What cannot be rendered as asked is the asker's, all else the run's.
pub(super) fn failure(error: RenderError) -> Failure {
    match error {
        RenderError::Scene(error) => error.into(),
        RenderError::Air(error) => Failure::usage(error),
        RenderError::Refused(error) => Failure::usage(error),
        other => Failure::error(other),
    }
}

/// The scene of a run that goes on: that of its state, but for what decides when it ends and how it is looked at.
fn resumed(args: &RenderArgs, shard: Option<Shard>, state: &State, path: &Path) -> Result<Scene, Failure> {
    let refuse = |text: String| Err(Failure::usage(format!("{}: {text}", path.display())));
    let was = &state.head.scene;
    let [part] = state.head.parts[..] else {
        return refuse("a merged state has no run that could go on: render more seeds or shards and merge them".into());
    };
    if let Some(shard) = shard.filter(|shard| *shard != part.shard) {
        return refuse(format!("it is shard {}, not {shard}", part.shard));
    }
    let mut scene = args.scene(was.clone())?;
    read_albedo(&mut scene, None)?;
    // Another effort does not change the blocks, but they are said only where they are not the default.
    if args.block.is_none() && scene.block() != was.block() {
        scene.block = Some(was.block());
    }
    if scene.seed != was.seed {
        return refuse(format!("its seed is {}, not {}", was.seed, scene.seed));
    }
    match was.difference(&scene) {
        Some(difference) => refuse(format!("a run goes on with its own scene: {difference}")),
        None => Ok(scene),
    }
}

/// The shard that is asked for; said if a launcher tells it.
fn shard(args: &RenderArgs) -> Result<Option<Shard>, Failure> {
    match args.shard {
        None => Ok(None),
        Some(ShardName::Given(shard)) => Ok(Some(shard)),
        Some(ShardName::Env) => {
            let told = Shard::of_launcher(&|name| std::env::var(name).ok());
            let (shard, words) = told.map_err(|error| Failure::usage(format!("--shard env: {error}")))?;
            if args.files.talks() {
                println!("shard       {shard}, by {words}");
            }
            Ok(Some(shard))
        }
    }
}

/// Where the picture goes, and the state of its run. Shards that a launcher numbers are started with the same words, and those without a name have the
/// same one: each gets its own.
fn names(args: &RenderArgs, shard: Option<Shard>) -> (PathBuf, Option<PathBuf>) {
    let (output, checkpoint) = (&args.files.output, args.checkpoint.as_ref());
    let of_launcher = args.shard == Some(ShardName::Env);
    let own = |file: &PathBuf| match shard {
        Some(shard) if of_launcher || file == Path::new(OUTPUT) => shard.name(file),
        _ => file.clone(),
    };
    let picture = own(output);
    let beside = shard.map(|_| picture.with_extension("state"));
    let state = checkpoint.map(own).or_else(|| args.resume.clone()).or(beside);
    (picture, state)
}

/// The film to begin with.
fn start(kept: Option<State>, scene: &Scene, sky: &Sky, extent: Extent, path: Option<&Path>) -> Result<Film, Failure> {
    let limit = extent.limit(scene);
    if limit == 0 {
        let blocks = "fewer blocks than shards: ask for more --spp, or a smaller --block";
        return Err(SceneError::Refused(format!("shard {} would be empty, {blocks}", extent.shard)).into());
    }
    let (Some(State { head, film }), Some(path)) = (kept, path) else { return Ok(empty(scene, sky)) };
    let at = |text: String| Failure::usage(format!("{}: {text}", path.display()));
    if let Some(difference) = head.difference(&Head::new(scene, sky, head.parts.clone())) {
        return Err(at(difference));
    }
    if film.most_blocks() > limit {
        let samples = film.most_blocks() * scene.block();
        return Err(at(format!(
            "it has {samples} samples per pixel already: ask for more --spp, an --error or --time"
        )));
    }
    Ok(film)
}

/// The scene that makes a picture again: where the time decided, it says how many samples that were.
fn as_made(scene: Scene, blocks: u32, extent: Extent, end: End) -> Scene {
    if end != End::Time {
        return scene;
    }
    let block = scene.block();
    Scene { spp: Some(extent.shard.whole(blocks) * block), block: Some(block), error: None, ..scene }
}

/// The command that prints one sample of a picture, from the words of the one that made it.
fn replay_command(words: impl Iterator<Item = String>, (x, y): (u32, u32), sample: u32) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./,:=%+@".contains(c);
    let quoted = |word: String| {
        if !word.is_empty() && word.chars().all(plain) { word } else { format!("'{}'", word.replace('\'', "'\\''")) }
    };
    let words: Vec<String> = words.map(quoted).collect();
    format!("{} --pixel {x},{y} --sample {sample}", words.join(" "))
}

/// A scene from TOML, JSON or XML of the thesis, or from the EXR file of a picture. Its own tables are found and, of a picture, must be what they
/// were, unless `tables` come in their place.
pub(super) fn read_scene(path: &Path, tables: &[String]) -> Result<Scene, Failure> {
    let at = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let bytes = std::fs::read(path).map_err(|error| Failure::error(at(&format!("cannot be read: {error}"))))?;
    let attribute = |name: &str| exr::text_attribute(&bytes, name).map_err(|error| Failure::usage(at(&error)));
    let (text, made_with) = if has_extension(path, "exr") {
        let json = attribute(receipt::SCENE)?;
        let json = json.ok_or_else(|| Failure::usage(at(&"a picture that carries no scene")))?;
        (json, Some(attribute(receipt::TABLES)?.unwrap_or_default()))
    } else {
        (std::str::from_utf8(&bytes).map_err(|error| Failure::usage(at(&error)))?, None)
    };
    let read = if has_extension(path, "xml") {
        let folder = path.parent().unwrap_or(Path::new("."));
        Scene::from_mitsuba(text, folder).map(|imported| {
            imported.notes.iter().for_each(|note| eprintln!("airlight: {}: {note}", path.display()));
            imported.scene
        })
    } else if has_extension(path, "toml") {
        Scene::from_toml(text)
    } else {
        Scene::from_json(text)
    };
    let mut scene = read.map_err(|error| Failure::usage(at(&error)))?;
    read_albedo(&mut scene, Some(path))?;
    if tables.is_empty() {
        for table in &mut scene.tables {
            *table = super::picture::find_table(table, path, made_with)?;
        }
    }
    Ok(scene)
}

/// A flag that Ctrl-C sets; a second Ctrl-C ends the program at once.
pub(super) fn stop_on_interrupt() -> Arc<AtomicBool> {
    let stop = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&stop);
    let handler = move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
    };
    // Without a handler Ctrl-C ends the program as it always does.
    if ctrlc::set_handler(handler).is_err() {
        eprintln!("airlight: Ctrl-C will end the program without a picture");
    }
    stop
}

/// One sample, number by number.
fn print_sample(scene: &Scene, sky: &Sky, (x, y): (u32, u32), sample: u32) -> Result<Outcome, Failure> {
    let (width, height) = scene.size();
    if x >= width || y >= height {
        return Err(Failure::usage(format!("pixel is {x},{y}; 0,0 to {},{} is possible", width - 1, height - 1)));
    }
    let Some((direction, values)) = replay(scene, sky, x, y, sample) else {
        return Err(Failure::usage(format!("pixel {x},{y} lies outside the picture's circle")));
    };
    println!("direction east {}, north {}, up {}", direction.x, direction.y, direction.z);
    let parameters: Vec<&[f64]> = values.chunks(sky.wavelengths()).collect();
    let more = if parameters.len() > 1 { ",q_per_solar_irradiance_sr,u_per_solar_irradiance_sr" } else { "" };
    println!("wavelength_nm,radiance_w_m2_sr_nm,radiance_per_solar_irradiance_sr{more}");
    for (index, (nm, irradiance)) in scene.wavelengths_nm.nm().iter().zip(sky.irradiance_w_m2_nm()).enumerate() {
        let factors: String = parameters.iter().map(|values| format!(",{:e}", values[index])).collect();
        println!("{nm},{:e}{factors}", values[index] * irradiance);
    }
    Ok(Outcome::Done)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_replay_of_a_sample_is_a_command_for_a_shell() {
        let words = ["airlight", "render", "--table", "my haze's.table", "--error", "1%"].map(String::from);
        assert_eq!(
            replay_command(words.into_iter(), (3, 4), 5),
            r"airlight render --table 'my haze'\''s.table' --error 1% --pixel 3,4 --sample 5"
        );
    }
}
