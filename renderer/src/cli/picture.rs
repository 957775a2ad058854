//! What every command that makes a picture shares: the files that it reads and writes, and what it says of them.

use super::args::PictureArgs;
use super::output::println;
use super::progress::{amount, duration, percent, size};
use super::{Failure, write};
use crate::clock::{process_s, utc};
use crate::film::{Development, DiscLayer, Estimate, Picture, exr, png, tone};
use crate::render::left_out::{LeftOut, Off};
use crate::render::receipt::{self, Facts, is_receipt};
use crate::render::{Achieved, Head, Part, Rendering, Residual, Shard, Sky, State, Summary, Verdict};
use crate::scene::Scene;
use crate::spectrum::Wavelengths;
use crate::transport::Method;
use crate::transport::rungs::{Rung, Stated};
use glam::DVec3;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::time::{Instant, SystemTime};

/// Where the picture goes, and the state of its run.
pub(super) struct Files {
    exr: PathBuf,
    png: PathBuf,
    receipt: Option<PathBuf>,
    state: Option<PathBuf>,
}

impl Files {
    /// Refuses a name that is not that of an EXR file in a folder that is there, a state under the name of a picture,
    /// a receipt in the place of a file that is none, and whatever cannot be written: better now than after the work.
    pub(super) fn new(exr: &Path, state: Option<&Path>, receipt: bool) -> Result<Self, Failure> {
        let named = |path: &Path, text: &str| Err(Failure::usage(format!("{}: {text}", path.display())));
        if !has_extension(exr, "exr") {
            return named(exr, "the name of the picture must end in .exr");
        }
        if let Some(state) = state.filter(|state| ["exr", "png"].iter().any(|end| has_extension(state, end))) {
            return named(state, "the name of a picture, not of the state of a run");
        }
        let files = Self {
            exr: exr.into(),
            png: exr.with_extension("png"),
            receipt: receipt.then(|| exr.with_extension("json")),
            state: state.map(Path::to_path_buf),
        };
        if let Some(json) = files.receipt.as_ref().filter(|json| std::fs::read(json).is_ok_and(|old| !is_receipt(&old)))
        {
            return named(
                json,
                "is there and no receipt of a picture: name the picture otherwise, or add --no-receipt",
            );
        }
        let all = [Some(files.exr.as_path()), Some(&files.png), files.receipt.as_deref(), state];
        for path in all.into_iter().flatten() {
            let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
            if let Some(folder) = folder.filter(|folder| !folder.is_dir()) {
                return named(folder, "there is no such folder to write to");
            }
            tables::file::check_writable(path).map_err(|error| super::unwritable(path, &error))?;
        }
        Ok(files)
    }

    /// Says which files that are there will be replaced, before the work is done that replaces them.
    pub(super) fn announce(&self, args: &PictureArgs) {
        let all = [Some(&self.exr), Some(&self.png), self.receipt.as_ref(), self.state.as_ref()];
        let old = all.into_iter().flatten().filter(|path| path.exists());
        let old: Vec<String> = old.map(|path| path.display().to_string()).collect();
        if args.talks() && !old.is_empty() {
            println!("replaces    {}", old.join(", "));
        }
    }

    /// Where the picture of polarisation goes, if there is one: `NAME-polarisation.png`.
    fn polarisation(&self) -> PathBuf {
        let mut name = self.exr.file_stem().unwrap_or_default().to_os_string();
        name.push("-polarisation.png");
        self.exr.with_file_name(name)
    }

    /// Where the picture goes.
    pub(super) fn exr(&self) -> &Path {
        &self.exr
    }

    /// Where the picture to look at goes.
    pub(super) fn png(&self) -> &Path {
        &self.png
    }

    /// Where the state of the run goes.
    pub(super) fn state(&self) -> Option<&Path> {
        self.state.as_deref()
    }
}

/// A picture that is ready to be written.
pub(super) struct Product<'a> {
    pub(super) scene: &'a Scene,
    pub(super) sky: &'a Sky,
    pub(super) summary: Summary,
    pub(super) disc: DiscLayer,
    pub(super) rendering: Rendering,
    pub(super) head: Head,
    /// What a certificate says of the tables.
    pub(super) verdict: Option<Verdict>,
    /// What a planned picture has achieved.
    pub(super) achieved: Option<Achieved>,
}

impl Product<'_> {
    /// Writes the files, and says what they are.
    pub(super) fn deliver(
        &self,
        files: &Files,
        args: &PictureArgs,
        begin: Instant,
        pool: &rayon::ThreadPool,
    ) -> Result<(), Failure> {
        let Self { scene, sky, summary, disc, rendering, head, verdict, achieved } = self;
        let picture = Picture { film: &rendering.film, disc, colour: sky.colour() };
        let exposure_ev = scene.exposure_ev.unwrap_or_else(|| tone::automatic_ev(rendering.film.luminances()));
        let development = Development::new(scene.tone, scene.white, sky.sun_white(), exposure_ev);
        let facts = Facts {
            verdict: verdict.as_ref(),
            achieved: achieved.as_ref(),
            ..Facts::new((scene, sky), (&head.parts, rendering), summary, exposure_ev)
        };
        let attributes = facts.attributes().map_err(Failure::error)?;
        let spectral = (args.spectral || scene.polarisation).then(|| scene.wavelengths());
        let exr = exr::encode(&picture, spectral.as_ref().map(Wavelengths::nm), &attributes).map_err(Failure::error)?;
        let png = png::encode(&picture, &development).map_err(Failure::error)?;
        let polarisation = match png::encode_polarisation(&picture) {
            Some(png) => Some((files.polarisation(), png.map_err(Failure::error)?)),
            None => None,
        };
        // First what cannot be made again at once.
        if let Some(path) = files.state() {
            write(path, &head.encode(&rendering.film))?;
        }
        write(&files.exr, &exr)?;
        write(&files.png, &png)?;
        if let Some((path, png)) = &polarisation {
            write(path, png)?;
        }
        if files.receipt.is_some() || args.json {
            let written = [(&files.exr, &exr), (&files.png, &png)].into_iter();
            let written = written.chain(polarisation.as_ref().map(|(path, png)| (path, png)));
            let receipt = self.receipt(&facts, written, begin, pool)?;
            if let Some(path) = &files.receipt {
                write(path, &receipt)?;
            }
            if args.json {
                super::output::bytes(&receipt);
            }
        }
        if args.talks() {
            describe(scene, sky, summary, rendering, &head.parts);
            if !scene.polarisation && scene.filter_deg.is_none() {
                describe_left_out(&LeftOut::of(scene, sky.air(), sky.albedo()), sky.is_polarised());
            }
            if let Some(verdict) = verdict {
                describe_verdict(verdict, sky.sun_direction(), scene.filter_deg.is_some());
            }
            if let Some(achieved) = achieved {
                println!("achieved    {}", super::auto::words(achieved));
            }
            println!(
                "time        {} on {} threads",
                duration(begin.elapsed().as_secs_f64()),
                pool.current_num_threads()
            );
            println!("written     {} ({})", files.exr.display(), size(exr.len()));
            println!("            {} ({}, EV {exposure_ev:.1})", files.png.display(), size(png.len()));
            if let Some((path, png)) = &polarisation {
                println!("            {} ({}, degree and angle of polarisation)", path.display(), size(png.len()));
            }
            if let Some(path) = &files.receipt {
                println!("            {} (the receipt)", path.display());
            }
            if let Some(path) = files.state() {
                println!("            {} (the state of the run)", path.display());
            }
        }
        Ok(())
    }

    /// The receipt beside the picture: that of the EXR file, then the files with their checksums, then the time.
    fn receipt<'f>(
        &self,
        facts: &Facts<'_>,
        written: impl Iterator<Item = (&'f PathBuf, &'f Vec<u8>)>,
        begin: Instant,
        pool: &rayon::ThreadPool,
    ) -> Result<Vec<u8>, Failure> {
        let mut receipt = facts.json().map_err(Failure::error)?;
        let files = written.map(|(path, bytes)| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            json!({ "file": name, "size_bytes": bytes.len(), "crc32": format!("{:08x}", crc32fast::hash(bytes)) })
        });
        receipt.insert("files".into(), files.collect());
        let time = json!({
            "written_utc": utc(SystemTime::now()),
            "took_s": begin.elapsed().as_secs_f64(),
            "took_core_s": process_s(),
            "threads": pool.current_num_threads(),
        });
        receipt.insert("time".into(), time);
        Ok((serde_json::to_string_pretty(&receipt).map_err(Failure::error)? + "\n").into_bytes())
    }
}

/// The state of a run. Its own tables are found, and must be what they were, unless `tables` come in their place.
pub(super) fn read_state(path: &Path, tables: &[String]) -> Result<State, Failure> {
    let at = |error: &dyn std::fmt::Display| Failure::error(format!("{}: {error}", path.display()));
    let bytes = std::fs::read(path).map_err(|error| at(&format!("cannot be read: {error}")))?;
    let mut state = State::decode(&bytes).map_err(|error| at(&error))?;
    if tables.is_empty() {
        for table in &mut state.head.scene.tables {
            *table = find_table(table, path, Some(&state.head.tables))?;
        }
    }
    Ok(state)
}

/// Where the own table of a scene is: as it is written, from the current folder or from that of the scene, or by its
/// name alone beside the scene. Of a picture (`made_with` are its tables) it must have the checksum that it had.
pub(super) fn find_table(table: &str, scene: &Path, made_with: Option<&str>) -> Result<String, Failure> {
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

pub(super) fn has_extension(path: &Path, wanted: &str) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case(wanted))
}

/// What was rendered.
fn describe(scene: &Scene, sky: &Sky, summary: &Summary, rendering: &Rendering, parts: &[Part]) {
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
        let spread = if mean > 0.0 && error > 0.0 { format!(" (+- {})", percent(error / mean)) } else { String::new() };
        format!("{} {unit}{spread}", amount(mean))
    };
    let place = if scene.in_space() { ", above the atmosphere: nothing overhead" } else { "" };
    println!("observer    {} km{place}", scene.altitude_km);
    println!("illuminance sun {} lux, sky {} on the horizontal", amount(summary.sun_lux), of(summary.sky_lux, "lux"));
    println!("zenith      {}", of(summary.zenith_cd_m2, "cd/m2"));
    let (film, errors) = (&rendering.film, rendering.errors);
    let block = scene.block();
    let [least, most] = [film.least_blocks(), film.most_blocks()].map(|blocks| u64::from(blocks) * u64::from(block));
    let samples = if least == most { most.to_string() } else { format!("{least} to {most}") };
    let blocks = if block > 1 { format!(" in blocks of {block}") } else { String::new() };
    let (seed, parts) = match parts {
        [part] if part.shard == Shard::default() => (format!(", seed {}", part.seed), &[][..]),
        _ => (String::new(), parts),
    };
    let channels = if scene.method.is_dome() { "X, Y, Z".into() } else { format!("{} wavelengths", sky.wavelengths()) };
    println!("picture     {width} x {height}, {channels}, {samples} samples per pixel{blocks}{seed}");
    if sky.is_noiseless() && scene.method != Method::Solved {
        let rung = Rung::of(scene.method);
        println!("method      {}: {}", rung.name, rung.source);
        println!("            leaves out {}", rung.leaves_out);
        match sky.stated() {
            Some(Stated { further, points }) => println!(
                "            light scattered or reflected again is about {} (rms over mean radiance); points on a line leave {}",
                percent(further),
                percent(points)
            ),
            None => println!("            states no error: its atmosphere is another"),
        }
    }
    for part in parts {
        println!("            {part}");
    }
    if let Some(spp) = scene.spp.filter(|spp| scene.error.is_none() && !spp.is_multiple_of(block)) {
        println!("            ({spp} are not whole blocks, which are rounded up)");
    }
    if let Some(error) = sky.table_error() {
        println!(
            "table       solved for every sun and observer, off by about {} (rms, from a coarser one)",
            percent(error)
        );
    }
    if errors.relative.is_infinite() && sky.is_noiseless() {
        return;
    }
    println!(
        "error       {} (rms over mean radiance); median standard error {} of luminance, {} of spectral radiance",
        percent(errors.relative),
        percent(errors.median_luminance),
        percent(errors.median_spectral)
    );
}

/// What it costs, or would cost where polarisation is followed, to leave it out, or in what the scene lies outside the measurements.
fn describe_left_out(left_out: &Result<LeftOut, String>, followed: bool) {
    let of = |Off { rms, worst, error }: Off| {
        let [rms, worst, error] = [rms, worst, error].map(percent);
        format!("off by {rms} (rms over the sky), at worst {worst} (+- {error})")
    };
    let begin = if followed { "polarised   followed; without it " } else { "unpolarised " };
    match left_out {
        Ok(LeftOut { luminance, radiance, nm }) => {
            let luminance = luminance.map_or(String::new(), |off| format!("luminance {}\n            ", of(off)));
            println!("{begin}{luminance}radiance at {nm:.0} nm {}", of(*radiance));
        }
        Err(outside) if followed => println!("polarised   followed; what it is worth was not measured for {outside}"),
        Err(outside) => println!("unpolarised what that costs was not measured for {outside}"),
    }
}

/// What a certificate found, with the sun in that direction, of light that was `filtered` or not.
fn describe_verdict(verdict: &Verdict, sun: DVec3, filtered: bool) {
    let Verdict { asked, ref errors, size: (directions, fans) } = *verdict;
    let Some(Residual { rms, most, mean, worst, worst_direction, .. }) = errors.first().copied() else { return };
    let (high, away) = (worst_direction.z.asin().to_degrees(), worst_direction.angle_between(sun).to_degrees());
    let signed = |share: f64| format!("{}{}", if share < 0.0 { "-" } else { "+" }, percent(share.abs()));
    let stokes = errors.len() > 1;
    let what = match (stokes, filtered) {
        (true, _) => "I is ",
        (false, true) => "behind the filter ",
        (false, false) => "",
    };
    let beyond = match (stokes, verdict.holds()) {
        (false, true) => "below",
        (true, true) => "all three below",
        (false, false) => "not shown to be below",
        (true, false) => "not all three shown to be below",
    };
    let asked = percent(asked);
    println!(
        "certified   {what}off by {} (rms), at most {} with 95 % confidence: {beyond} the asked {asked}",
        percent(rms),
        percent(most)
    );
    for (name, error) in ["Q", "U"].into_iter().zip(&errors[1..]) {
        println!("            {name} is off by {} of I (rms), at most {}", percent(error.rms), percent(error.most));
    }
    let of = if stokes { " of I" } else { "" };
    println!(
        "            mean{of} {} +- {}; {directions} directions, {} fans of rays",
        signed(mean.0),
        percent(mean.1),
        amount(fans as f64)
    );
    println!(
        "            worst direction{of}, {high:.1} degrees high and {away:.1} from the sun: {} +- {}",
        signed(worst.0),
        percent(worst.1)
    );
}
