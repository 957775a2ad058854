//! `airlight sequence`.

use super::args::RenderArgs;
use super::output::{eprintln, println};
use super::picture::has_extension;
use super::progress::{Line, duration, percent};
use super::render::{failure, stop_on_interrupt};
use super::{Failure, Outcome};
use crate::film::{Development, Picture, exr, png};
use crate::render::receipt::Facts;
use crate::render::{Control, End, Part, RenderError, Shard, Sky, Summary, disc_layer, render};
use crate::scene::{Moment, Scene};
use crate::sequence::{Course, Sequence, Track, steepest};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// Flags of `airlight sequence`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub(super) struct SequenceArgs {
    #[command(flatten)]
    pub render: RenderArgs,
    /// What happens
    #[arg(long, value_name = "WHAT", default_value = "sunset", conflicts_with_all = ["vary", "until"], help_heading = "Frames")]
    pub what: CourseName,
    /// Let a key of the scene go from one value to another instead: sun_elevation_deg, sun_azimuth_deg, altitude_km,
    /// view_azimuth_deg, view_elevation_deg or fov_deg; more than once for more keys [default: as --what]
    #[arg(long, value_name = "KEY=FROM:TO", conflicts_with = "until", help_heading = "Frames")]
    pub vary: Vec<Track>,
    /// Go from --date to this instant instead, at most two days later [default: as --what]
    #[arg(long, value_name = "INSTANT", help_heading = "Frames")]
    pub until: Option<Moment>,
    /// How many frames, 1 to 100000
    #[arg(long, value_name = "N", default_value_t = 48, value_parser = clap::value_parser!(u32).range(1..=100_000), help_heading = "Frames")]
    pub frames: u32,
    /// Leave frames alone whose files are there: they are whole, and exposures do not depend on them
    #[arg(long, help_heading = "Frames")]
    pub skip_existing: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum CourseName {
    /// From civil dawn to civil dusk of --date at --latitude and --longitude
    Day,
    /// The sun from 10 degrees above the horizon to 6 below, with a date as on its afternoon
    Sunset,
    /// From the ground (2 m) to space (400 km), the horizon in the middle
    Ascent,
}

pub(super) fn run(args: &SequenceArgs) -> Result<Outcome, Failure> {
    let begin = Instant::now();
    refuse_others(&args.render)?;
    if args.render.files.json {
        return Err(Failure::usage("--json is for one picture: frames that end in .exr hold their receipts"));
    }
    let scene = super::render::scene(&args.render)?;
    let course = match (&args.until, args.vary.as_slice(), args.what) {
        (Some(end), ..) => Course::Until(*end),
        (None, [_, ..], _) => Course::Tracks(args.vary.clone()),
        (_, _, CourseName::Day) => Course::Day,
        (_, _, CourseName::Sunset) => Course::Sunset,
        (_, _, CourseName::Ascent) => Course::Ascent,
    };
    let frames = course.frames(&scene, args.frames as usize)?;
    let names = Names::new(&args.render.files.output)?;
    let data = super::data(args.render.files.data.as_deref())?;
    let pool = super::pool(args.render.threads)?;
    let folder = super::made(args.render.keep_tables.as_deref())?;
    let stop = stop_on_interrupt();
    let line = Line::new(args.render.files.quiet);
    let look = |share: f64| line.show(share, |_| "exposures".into());
    let prepared = pool.install(|| Sequence::prepare(frames, &data, folder, &stop, &look)).map_err(failure)?;
    line.clear();
    let Some(Sequence { frames, mut sky, solved, table_error }) = prepared else { return Ok(interrupted(0, &names)) };
    let prepared_s = begin.elapsed().as_secs_f64();
    let old = (0..frames.len()).filter(|index| names.path(*index).exists()).count();
    if old > 0 && !args.skip_existing && !args.render.files.quiet {
        println!("replaces    {old} of {} frames", frames.len());
    }
    let (line, mut made) = (Line::new(args.render.files.quiet), 0_u32);
    for (index, frame) in frames.iter().enumerate() {
        let path = names.path(index);
        if args.skip_existing && path.is_file() {
            continue;
        }
        line.show(index as f64 / frames.len() as f64, |_| format!("frame {} of {}", index + 1, frames.len()));
        let bytes = pool.install(|| encode(frame, &mut sky, args, &path, &stop)).map_err(failure)?;
        let Some(bytes) = bytes else {
            line.clear();
            return Ok(interrupted(index, &names));
        };
        super::write(&path, &bytes)?;
        made += 1;
    }
    line.clear();
    if !args.render.files.quiet {
        describe(&frames, (solved, table_error), prepared_s);
        let (whole_s, count) = (begin.elapsed().as_secs_f64(), f64::from(made.max(1)));
        let each = duration((whole_s - prepared_s) / count);
        println!("time        {}, {each} a frame, on {} threads", duration(whole_s), pool.current_num_threads());
        let (first, last) = (names.path(0), names.path(frames.len() - 1));
        println!("written     {made} of {} frames, {} to {}", frames.len(), first.display(), last.display());
    }
    Ok(Outcome::Done)
}

/// The file of a frame; nothing if it was stopped.
fn encode(
    scene: &Scene,
    sky: &mut Sky,
    args: &SequenceArgs,
    path: &Path,
    stop: &AtomicBool,
) -> Result<Option<Vec<u8>>, RenderError> {
    sky.turn(scene)?;
    let disc = disc_layer(scene, sky);
    let rendering = render(scene, sky, Control { stop, observe: &|_| {} })?;
    if rendering.end == End::Stopped {
        return Ok(None);
    }
    let picture = Picture { film: &rendering.film, disc: &disc, colour: sky.colour() };
    let exposure_ev = scene.exposure_ev.unwrap_or_default();
    if has_extension(path, "png") {
        return Ok(Some(png::encode(
            &picture,
            &Development::new(scene.tone, scene.white, sky.sun_white(), exposure_ev),
        )?));
    }
    let summary = Summary::new(sky, scene.seed, stop);
    let parts = [Part { seed: scene.seed, shard: Shard::default() }];
    let facts = Facts::new((scene, sky), (&parts, &rendering), &summary, exposure_ev);
    let attributes = facts.attributes()?;
    let wavelengths = (args.render.files.spectral || scene.polarisation).then(|| scene.wavelengths());
    Ok(Some(exr::encode(&picture, wavelengths.as_ref().map(|all| all.nm()), &attributes)?))
}

fn interrupted(index: usize, names: &Names) -> Outcome {
    let next = names.path(index);
    eprintln!("airlight: stopped by Ctrl-C before {}; --skip-existing goes on", next.display());
    Outcome::Interrupted
}

/// Flags that say something of one picture alone.
pub(super) fn refuse_others(args: &RenderArgs) -> Result<(), Failure> {
    let given = [
        ("--auto", args.auto),
        ("--time", args.time.is_some()),
        ("--shard", args.shard.is_some()),
        ("--checkpoint", args.checkpoint.is_some()),
        ("--resume", args.resume.is_some()),
        ("--pixel", args.pixel.is_some()),
        ("--certify", args.certify.is_some()),
        ("--metric", args.metric.is_some()),
    ];
    match given.into_iter().find(|(_, given)| *given) {
        Some((flag, _)) => Err(Failure::usage(format!("{flag} is for one picture: airlight render"))),
        None => Ok(()),
    }
}

/// The names of the frames: a run of # in the given name is their number; without one it stands before the extension.
struct Names {
    before: String,
    digits: usize,
    after: String,
    folder: PathBuf,
}

impl Names {
    fn new(output: &Path) -> Result<Self, Failure> {
        let named = |text: &str| Failure::usage(format!("{}: {text}", output.display()));
        if !["png", "exr"].iter().any(|end| has_extension(output, end)) {
            return Err(named("the names of frames must end in .png or .exr"));
        }
        let folder = output.parent().unwrap_or(Path::new("")).to_path_buf();
        if !folder.as_os_str().is_empty() && !folder.is_dir() {
            return Err(named("there is no such folder to write to"));
        }
        let name = output.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let (before, digits, after) = match name.find('#') {
            Some(first) => {
                let digits = name[first..].chars().take_while(|c| *c == '#').count();
                (name[..first].to_owned(), digits, name[first + digits..].to_owned())
            }
            None => {
                let dot = name.rfind('.').unwrap_or(name.len());
                (format!("{}-", &name[..dot]), 4, name[dot..].to_owned())
            }
        };
        let names = Self { before, digits, after, folder };
        tables::file::check_writable(&names.path(0)).map_err(|error| super::unwritable(&names.path(0), &error))?;
        Ok(names)
    }

    /// From 0.
    fn path(&self, index: usize) -> PathBuf {
        self.folder.join(format!("{}{index:0width$}{}", self.before, self.after, width = self.digits))
    }
}

fn describe(frames: &[Scene], (solved, table_error): (u32, Option<f64>), prepared_s: f64) {
    let (Some(first), Some(last)) = (frames.first(), frames.last()) else { return };
    let range =
        |of: fn(&Scene) -> f64, decimals: usize| format!("{:.*} to {:.*}", decimals, of(first), decimals, of(last));
    println!(
        "sun         elevation {} degrees, azimuth {} degrees",
        range(|s| s.sun_elevation_deg, 2),
        range(|s| s.sun_azimuth_deg, 2)
    );
    println!("observer    {} km", range(|s| s.altitude_km, 3));
    let exposures: Vec<f64> = frames.iter().map(|frame| frame.exposure_ev.unwrap_or_default()).collect();
    println!(
        "exposure    EV {}, at most {:.2} EV from frame to frame",
        range(|s| s.exposure_ev.unwrap_or_default(), 1),
        steepest(&exposures)
    );
    let times = if solved == 1 { "once".into() } else { format!("{solved} times") };
    match table_error {
        Some(error) => {
            println!("table       solved {times} for all frames, off by at most about {} (rms)", percent(error))
        }
        None if solved > 0 => println!("table       solved {times} for all frames"),
        None => {}
    }
    println!("prepared    tables and exposures in {}", duration(prepared_s));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_numbered_where_the_name_says() {
        let name = |output: &str, index| {
            let names = Names::new(Path::new(output)).unwrap_or_else(|failure| panic!("{}", failure.message));
            names.path(index).display().to_string()
        };
        assert_eq!(name("frame-####.png", 7), "frame-0007.png");
        assert_eq!(name("a#b.exr", 12), "a12b.exr");
        assert_eq!(name("day.png", 3), "day-0003.png");
        let refusal =
            |output: &str| Names::new(Path::new(output)).map_or_else(|failure| failure.message, |_| "taken".into());
        assert!(refusal("frame-####.jpg").contains(".png or .exr"));
        assert!(refusal("no-such-folder/##.png").contains("no such folder"));
    }
}
