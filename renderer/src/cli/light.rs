//! `airlight light`.

use super::args::RenderArgs;
use super::output::{eprintln, println};
use super::progress::{Line, amount, duration, percent, size};
use super::render::{sky, stop_on_interrupt};
use super::words::Switch;
use super::{Failure, Outcome};
use crate::convention::Program;
use crate::film::{Development, Picture, exr, png, tone};
use crate::light::solar_angular_radius_at;
use crate::render::receipt::Facts;
use crate::render::{Control, End, Part, Progress, Shard, Sky, Summary, disc_layer, render};
use crate::scene::Scene;
use crate::spectrum::{linear_srgb, luminance};
use clap::Args;
use glam::DVec3;
use serde_json::{Value, json};
use std::path::Path;
use std::time::Instant;

/// Flags of `airlight light`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub(super) struct LightArgs {
    #[command(flatten)]
    pub render: RenderArgs,
    /// Whose orientation, axes and units the map and the sun are in. The sun's disc is in the map only with --sun-disc on; the JSON file
    /// beside the map tells of the sun either way
    #[arg(long = "for", value_name = "PROGRAM", help_heading = "Files")]
    pub program: Program,
}

pub(super) fn run(args: &LightArgs) -> Result<Outcome, Failure> {
    let begin = Instant::now();
    super::sequence::refuse_others(&args.render)?;
    let (scene, files) = (scene(args)?, super::picture::Files::new(&args.render.files.output, None, false)?);
    files.announce(&args.render.files);
    let data = super::data(args.render.files.data.as_deref())?;
    let pool = super::pool(args.render.threads)?;
    let folder = super::made(args.render.keep_tables.as_deref())?;
    let stop = stop_on_interrupt();
    let sky = pool.install(|| sky(&scene, &data, folder))?;
    let scene = sky.decided(scene);
    let line = Line::new(args.render.files.quiet);
    let observe = |progress: Progress| line.show(progress.fraction, |_| format!("error {}", percent(progress.error)));
    let work = || {
        let rendering = render(&scene, &sky, Control { stop: &stop, observe: &observe })?;
        Ok((Summary::new(&sky, scene.seed, &stop), disc_layer(&scene, &sky), rendering))
    };
    let (summary, disc, rendering) =
        pool.install(work).map_err(|error: crate::render::RenderError| Failure::error(error))?;
    line.clear();
    if rendering.end == End::Stopped {
        eprintln!("airlight: stopped by Ctrl-C; nothing is written, for a map without some of its light is none");
        return Ok(Outcome::Interrupted);
    }
    let picture = Picture { film: &rendering.film, disc: &disc, colour: sky.colour() };
    let exposure_ev = scene.exposure_ev.unwrap_or_else(|| tone::automatic_ev(rendering.film.luminances()));
    let parts = [Part { seed: scene.seed, shard: Shard::default() }];
    let facts = Facts::new((&scene, &sky), (&parts, &rendering), &summary, exposure_ev);
    let attributes = facts.attributes().map_err(Failure::error)?;
    let map = exr::encode_map(&picture, args.program.white_luminance(), &attributes).map_err(Failure::error)?;
    let shown = png::encode(&picture, &Development::new(scene.tone, scene.white, sky.sun_white(), exposure_ev))
        .map_err(Failure::error)?;
    let told = words(args.program, &scene, &sky, &summary, files.exr());
    let text = serde_json::to_string_pretty(&told).map_err(Failure::error)? + "\n";
    let json_path = files.exr().with_extension("json");
    let all = [(files.exr(), map.as_slice()), (files.png(), &shown), (&json_path, text.as_bytes())];
    for (path, bytes) in all {
        super::write(path, bytes)?;
    }
    if args.render.files.json {
        super::output::bytes(text.as_bytes());
    }
    if args.render.files.talks() {
        describe(args.program, &scene, &told);
        println!("time        {} on {} threads", duration(begin.elapsed().as_secs_f64()), pool.current_num_threads());
        for (index, (path, bytes)) in all.into_iter().enumerate() {
            let what = if index == 0 { "written    " } else { "           " };
            println!("{what} {} ({})", path.display(), size(bytes.len()));
        }
    }
    Ok(Outcome::Done)
}

/// The scene in the form of the program's map.
fn scene(args: &LightArgs) -> Result<Scene, Failure> {
    let RenderArgs { camera, fov, view_azimuth, view_elevation, .. } = &args.render;
    let given = [
        ("--camera", camera.is_some()),
        ("--fov", fov.is_some()),
        ("--view-azimuth", view_azimuth.is_some()),
        ("--view-elevation", view_elevation.is_some()),
    ];
    if let Some((flag, _)) = given.into_iter().find(|(_, given)| *given) {
        let name = args.program.name();
        return Err(Failure::usage(format!("{flag}: the map's form and orientation are those of {name}, for --for")));
    }
    let scene = super::render::scene(&args.render)?;
    if scene.polarisation || scene.filter_deg.is_some() {
        return Err(Failure::usage("a map is light without polarisation: leave out --polarisation and --filter"));
    }
    let camera = args.program.projection();
    // A map twice as wide as high, or a square.
    let wide = if args.program == Program::Pbrt { 1 } else { 2 };
    let (width, height) = match (args.render.width, args.render.height) {
        (None, None) => (256 * wide, 256),
        (Some(width), None) => (width, (width / wide).max(1)),
        (None, Some(height)) => (height.saturating_mul(wide), height),
        (Some(width), Some(height)) => (width, height),
    };
    let scene = Scene {
        camera,
        fov_deg: None,
        view_azimuth_deg: Some(args.program.azimuth_deg()),
        view_elevation_deg: None,
        width: Some(width),
        height: Some(height),
        sun_disc: args.render.sun_disc == Some(Switch::On),
        ..scene
    };
    scene.validate()?;
    Ok(scene)
}

/// What the JSON file says.
fn words(program: Program, scene: &Scene, sky: &Sky, summary: &Summary, map: &Path) -> Value {
    let array = |v: DVec3| json!([v.x, v.y, v.z]);
    let [east, north, up] = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| array(program.axes(axis)));
    let towards = program.axes(sky.sun_direction());
    let lux = linear_srgb(sky.colour().xyz(&sky.direct_irradiance_of(sky.sun_direction())));
    let irradiance = lux.map(|lux| lux / program.white_luminance());
    let [radiance_unit, irradiance_unit] = program.units();
    let file = map.file_name().unwrap_or_default().to_string_lossy();
    let radius_deg = solar_angular_radius_at(scene.sun_distance_au).to_degrees();
    json!({
        "for": program.name(),
        "map": {
            "file": file,
            "projection": if program == Program::Pbrt { "equal-area" } else { "latlong" },
            "radiance_unit": radiance_unit,
            "white_luminance_cd_m2": program.white_luminance(),
            "colour": "linear sRGB",
            "sun_disc": scene.sun_disc,
        },
        "axes": { "east": east, "north": north, "up": up },
        "sun": {
            "direction_to_sun": array(towards),
            "azimuth_deg": scene.sun_azimuth_deg,
            "elevation_deg": scene.sun_elevation_deg,
            "angular_radius_deg": radius_deg,
            "normal_irradiance_rgb": irradiance,
            "irradiance_unit": irradiance_unit,
            "normal_illuminance_lux": luminance(lux),
            "horizontal_illuminance_lux": summary.sun_lux,
        },
        "sky": { "horizontal_illuminance_lux": summary.sky_lux.mean },
        "use": how(program, scene, (towards, irradiance), (&file, radius_deg)),
    })
}

/// The map and the sun as the program takes them.
fn how(
    program: Program,
    scene: &Scene,
    (towards, irradiance): (DVec3, [f64; 3]),
    (file, radius_deg): (&str, f64),
) -> Value {
    let strongest = irradiance.into_iter().fold(0.0, f64::max);
    let colour = irradiance.map(|c| if strongest > 0.0 { (c / strongest).max(0.0) } else { 0.0 });
    let travels = -towards;
    match program {
        // A sun lamp shines along its -z: Rz(180 - azimuth) Rx(90 - elevation) turns z to the sun.
        Program::Blender => json!({
            "world": "Environment Texture, Equirectangular, colour space Linear Rec.709, Strength 1, no rotation",
            "sun_lamp": {
                "rotation_euler_deg": [90.0 - scene.sun_elevation_deg, 0.0, 180.0 - scene.sun_azimuth_deg],
                "strength": strongest,
                "color": colour,
                "angle_deg": 2.0 * radius_deg,
            },
        }),
        Program::Mitsuba => json!({
            "envmap": { "type": "envmap", "filename": file },
            "directional": {
                "type": "directional",
                "direction": [travels.x, travels.y, travels.z],
                "irradiance": { "type": "rgb", "value": irradiance },
            },
        }),
        Program::Pbrt => json!({
            "infinite": format!("LightSource \"infinite\" \"string filename\" [ \"{file}\" ]"),
            "distant": format!(
                "LightSource \"distant\" \"point3 from\" [ {} {} {} ] \"point3 to\" [ 0 0 0 ] \"rgb L\" [ {} {} {} ]",
                towards.x, towards.y, towards.z, irradiance[0], irradiance[1], irradiance[2]
            ),
        }),
        // Its intensity times its colour, whose largest channel is 1, are the channels of the irradiance.
        // A directional light shines along its x: yaw about z from north (x) to east (y), pitch upwards.
        Program::Unreal => json!({
            "sky_light": "SLS Specified Cubemap of the map imported as a cubemap, Source Cubemap Angle 0, Intensity Scale 1",
            "directional_light": {
                "rotation_deg": {
                    "pitch": -scene.sun_elevation_deg,
                    "yaw": (scene.sun_azimuth_deg + 180.0).rem_euclid(360.0),
                    "roll": 0.0,
                },
                "intensity_lux": strongest,
                "light_color_linear": colour,
                "source_angle_deg": 2.0 * radius_deg,
            },
        }),
    }
}

fn describe(program: Program, scene: &Scene, told: &Value) {
    let three = |value: &Value, decimals: usize| {
        let numbers = value.as_array().into_iter().flatten().filter_map(Value::as_f64);
        numbers.map(|x| if decimals > 0 { format!("{x:.decimals$}") } else { amount(x) }).collect::<Vec<_>>().join(", ")
    };
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let number = |value: &Value| value.as_f64().unwrap_or_default();
    let (axes, sun, map) = (&told["axes"], &told["sun"], &told["map"]);
    let (width, height) = scene.size();
    let disc = if scene.sun_disc { "with the sun's disc: add no other sun" } else { "without the sun's disc" };
    println!("for         {}: {} of {width} x {height}, {disc}", program.name(), text(&map["projection"]));
    println!("radiance    linear sRGB in {}", text(&map["radiance_unit"]));
    println!(
        "axes        east ({}), north ({}), up ({})",
        three(&axes["east"], 1),
        three(&axes["north"], 1),
        three(&axes["up"], 1)
    );
    println!("to the sun  ({})", three(&sun["direction_to_sun"], 5));
    println!(
        "sun         {} on a surface that faces it: RGB ({}), {} lux; radius {:.4} degrees",
        text(&sun["irradiance_unit"]),
        three(&sun["normal_irradiance_rgb"], 0),
        amount(number(&sun["normal_illuminance_lux"])),
        number(&sun["angular_radius_deg"])
    );
    println!(
        "illuminance sun {} lux, sky {} lux on the horizontal",
        amount(number(&sun["horizontal_illuminance_lux"])),
        amount(number(&told["sky"]["horizontal_illuminance_lux"]))
    );
}
