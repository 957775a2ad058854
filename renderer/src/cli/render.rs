//! `airlight render`.

use super::args::RenderArgs;
use super::output::{eprintln, println};
use super::progress::{Line, amount, duration, percent, size};
use super::{Failure, Outcome};
use crate::data::Data;
use crate::film::{DiscLayer, Estimate, Picture, exr, png, tone};
use crate::render::{Control, RenderError, Rendering, Sky, Summary, disc_layer, receipt, render, replay};
use crate::scene::Scene;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

pub(super) fn run(args: &RenderArgs) -> Result<Outcome, Failure> {
    let base = args.scene.as_deref().map_or_else(|| Ok(Scene::default()), |path| read_scene(path, &args.tables))?;
    let scene = args.scene(base)?;
    let files = Files::new(&args.output)?;
    let data = Data::load(&args.data).map_err(Failure::error)?;
    let sky = Sky::new(&scene, &data).map_err(|error| match error {
        RenderError::Scene(error) => error.into(),
        RenderError::Air(error) => Failure::usage(error),
        other => Failure::error(other),
    })?;
    if let Some((x, y)) = args.pixel {
        return print_sample(&scene, &sky, (x, y), args.sample);
    }
    let pool = super::pool(args.threads)?;
    let stop = stop_on_interrupt();
    let line = Line::new(args.quiet);
    let observe = |progress: crate::render::Progress| {
        line.show(progress.fraction, |elapsed| {
            let rate = amount(progress.samples as f64 / elapsed);
            format!("error {}  {rate} samples/s", percent(progress.error))
        });
    };
    let work = || -> Result<(Summary, DiscLayer, Rendering), RenderError> {
        let rendering = render(&scene, &sky, Control { stop: &stop, observe: &observe })?;
        let summary = Summary::new(&sky, scene.seed, &stop);
        Ok((summary, disc_layer(&scene, &sky), rendering))
    };
    let (summary, disc, rendering) = pool.install(work).map_err(|error| match error {
        RenderError::NotFinite { x, y, sample } => {
            let words: Vec<String> = std::env::args().collect();
            Failure::error(format!("{error}; replay it with: {} --pixel {x},{y} --sample {sample}", words.join(" ")))
        }
        other => Failure::error(other),
    })?;
    line.clear();

    let picture = Picture { film: &rendering.film, disc: &disc, colour: sky.colour() };
    let exposure_ev = scene.exposure_ev.unwrap_or_else(|| tone::automatic_ev(&picture));
    let attributes = receipt::receipt(&scene, &sky, &rendering, &summary, exposure_ev);
    let spectral = args.spectral.then_some(scene.wavelengths_nm.nm());
    let exr = exr::encode(&picture, spectral, &attributes).map_err(Failure::error)?;
    let png = png::encode(&picture, exposure_ev).map_err(Failure::error)?;
    write(&files.exr, &exr)?;
    write(&files.png, &png)?;
    if !args.quiet {
        describe(&scene, &sky, &summary, &rendering);
        println!("time        {} on {} threads", duration(line.elapsed().as_secs_f64()), pool.current_num_threads());
        println!("written     {} ({})", files.exr.display(), size(exr.len()));
        println!("            {} ({}, EV {exposure_ev:.1})", files.png.display(), size(png.len()));
    }
    if rendering.stopped {
        eprintln!("airlight: stopped by Ctrl-C; the picture holds the samples that were taken until then");
        return Ok(Outcome::Interrupted);
    }
    Ok(Outcome::Done)
}

/// A scene from JSON, or from the EXR file of a picture. Its own tables are found and, of a picture, must be what they
/// were, unless `tables` come in their place.
fn read_scene(path: &Path, tables: &[String]) -> Result<Scene, Failure> {
    let at = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let bytes = std::fs::read(path).map_err(|error| Failure::error(at(&format!("cannot be read: {error}"))))?;
    let attribute = |name: &str| exr::text_attribute(&bytes, name).map_err(|error| Failure::usage(at(&error)));
    let (json, made_with) = if has_extension(path, "exr") {
        let json = attribute(receipt::SCENE)?;
        let json = json.ok_or_else(|| Failure::usage(at(&"a picture that carries no scene")))?;
        (json, Some(attribute(receipt::TABLES)?.unwrap_or_default()))
    } else {
        (std::str::from_utf8(&bytes).map_err(|error| Failure::usage(at(&error)))?, None)
    };
    let mut scene = Scene::from_json(json).map_err(|error| Failure::usage(at(&error)))?;
    if tables.is_empty() {
        for table in &mut scene.tables {
            *table = find_table(table, path, made_with)?;
        }
    }
    Ok(scene)
}

/// Where the own table of a scene is: as it is written, from the current folder or from that of the scene, or by its
/// name alone beside the scene. Of a picture (`made_with` are its tables) it must have the checksum that it had.
fn find_table(table: &str, scene: &Path, made_with: Option<&str>) -> Result<String, Failure> {
    let folder = scene.parent().unwrap_or(Path::new(""));
    let name = Path::new(table).file_name().unwrap_or_default();
    let places = [PathBuf::from(table), folder.join(table), folder.join(name)];
    let at = |text: String| Failure::error(format!("{}: {text}", scene.display()));
    let Some(found) = places.into_iter().find(|place| place.is_file()) else {
        return Err(at(format!(
            "its own table {table} is neither in the current folder nor beside it: name it with --table"
        )));
    };
    if let Some(made_with) = made_with {
        let bytes = std::fs::read(&found).map_err(|error| at(format!("{}: {error}", found.display())))?;
        let (was, is) = (receipt::checksum_of(made_with, &name.to_string_lossy()), tables::file::checksum(&bytes));
        if was != is {
            let hex = |sum: Option<u32>| sum.map_or("none".into(), |sum| format!("{sum:08x}"));
            return Err(at(format!(
                "its own table {table} had the checksum {}, {} has {}: bring back the one it was made with, or name \
                 this one with --table",
                hex(was),
                found.display(),
                hex(is)
            )));
        }
    }
    found.into_os_string().into_string().map_err(|path| at(format!("{path:?} is not UTF-8")))
}

fn has_extension(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

/// Where the picture goes.
struct Files {
    exr: PathBuf,
    png: PathBuf,
}

impl Files {
    /// Refuses a name that is not that of an EXR file in a folder that is there.
    fn new(exr: &Path) -> Result<Self, Failure> {
        if !has_extension(exr, "exr") {
            return Err(Failure::usage(format!("{}: the name of the picture must end in .exr", exr.display())));
        }
        let folder = exr.parent().filter(|folder| !folder.as_os_str().is_empty());
        if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
            return Err(Failure::usage(format!("{}: there is no such folder to write to", folder.display())));
        }
        // Better now than after the work.
        let files = Self { exr: exr.into(), png: exr.with_extension("png") };
        for path in [&files.exr, &files.png] {
            tables::file::check_writable(path).map_err(|error| super::unwritable(path, &error))?;
        }
        Ok(files)
    }
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), Failure> {
    tables::file::replace(path, bytes).map_err(|error| super::unwritable(path, &error))
}

/// A flag that Ctrl-C sets; a second Ctrl-C ends the program at once.
fn stop_on_interrupt() -> Arc<AtomicBool> {
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

/// What was rendered.
fn describe(scene: &Scene, sky: &Sky, summary: &Summary, rendering: &Rendering) {
    let (width, height) = scene.size();
    println!("sun         elevation {} degrees, azimuth {} degrees", scene.sun_elevation_deg, scene.sun_azimuth_deg);
    let place = if sky.any_place() {
        "own profile; month and latitude make no difference".into()
    } else {
        format!("month {}, latitude {}", scene.month, scene.latitude_deg)
    };
    println!(
        "air         molecules and ozone {:.1} DU ({place}), top {} km, ground albedo {}",
        sky.air().ozone_du(),
        scene.top_km,
        scene.albedo
    );
    for table in sky.identities().iter().filter(|table| table.own) {
        println!("own table   {} {:08x}, {}: {}", table.file, table.checksum, table.kind, table.title);
    }
    if let Some(haze) = sky.air().haze() {
        let humidities: Vec<String> =
            haze.humidities_percent().iter().map(|(name, rh)| format!("{} {rh} %", name.replace('_', " "))).collect();
        println!(
            "aerosol     {}, optical depth {:.3} at 550 nm, {:.3} times the type's own, visibility {:.1} km",
            haze.origin(),
            haze.optical_depth(),
            haze.factor(),
            haze.visibility_km()
        );
        println!("            relative humidity: {}", humidities.join(", "));
    }
    let of = |Estimate { mean, error }: Estimate, unit: &str| {
        let spread = if mean > 0.0 { format!(" (+- {})", percent(error / mean)) } else { String::new() };
        format!("{} {unit}{spread}", amount(mean))
    };
    let place = if scene.in_space() { ", above the atmosphere: nothing overhead" } else { "" };
    println!("observer    {} km{place}", scene.altitude_km);
    println!("illuminance sun {} lux, sky {} on the horizontal", amount(summary.sun_lux), of(summary.sky_lux, "lux"));
    println!("zenith      {}", of(summary.zenith_cd_m2, "cd/m2"));
    let (film, errors) = (&rendering.film, rendering.errors);
    let (least, most) = (film.least_samples(), film.most_samples());
    let samples = if least == most { most.to_string() } else { format!("{least} to {most}") };
    println!(
        "picture     {width} x {height}, {} wavelengths, {samples} samples per pixel, seed {}",
        sky.wavelengths(),
        scene.seed
    );
    println!(
        "error       {} (rms over mean radiance); median standard error {} of luminance, {} of spectral radiance",
        percent(errors.relative),
        percent(errors.median_luminance),
        percent(errors.median_spectral)
    );
}

/// One sample, number by number.
fn print_sample(scene: &Scene, sky: &Sky, (x, y): (u32, u32), sample: u32) -> Result<Outcome, Failure> {
    let (width, height) = scene.size();
    if x >= width || y >= height {
        return Err(Failure::usage(format!("pixel is {x},{y}; 0,0 to {},{} is possible", width - 1, height - 1)));
    }
    let Some((direction, factors)) = replay(scene, sky, x, y, sample) else {
        return Err(Failure::usage(format!("pixel {x},{y} lies outside the picture's circle")));
    };
    println!("direction east {}, north {}, up {}", direction.x, direction.y, direction.z);
    println!("wavelength_nm,radiance_w_m2_sr_nm,radiance_per_solar_irradiance_sr");
    for ((nm, factor), irradiance) in scene.wavelengths_nm.nm().iter().zip(factors).zip(sky.irradiance_w_m2_nm()) {
        println!("{nm},{:e},{factor:e}", factor * irradiance);
    }
    Ok(Outcome::Done)
}
