//! What a scene will come to.

use super::looks::samples;
use super::{Finding, Looks, Trouble};
use crate::film::{Film, tone};
use crate::scene::{CameraKind, Scene, SceneError, horizon_dip};
use crate::spectrum::Scheme;
use crate::transport::Method;
use tables::units::KM;

/// Elevation of the sun in degrees below which no sunlight is left in the sky: the end of astronomical twilight.
const NIGHT_DEG: f64 = -18.0;

/// Stops between an exposure and the automatic one that make a picture black or white.
const STOPS: f64 = 3.0;

/// Share of the looks that end on the ground, or see nothing, from which on that is the picture.
const MOST: f64 = 0.9;

/// Noise that is seen.
const NOISE: f64 = 0.05;

/// Core-seconds, samples of each pixel, bytes of a film and wavelengths that are many.
const LONG_S: f64 = 600.0;
const MANY_SAMPLES: f64 = 1e5;
const LARGE_BYTES: u64 = 2 << 30;
const MANY_WAVELENGTHS: usize = 64;

/// An error that tables seldom state.
const LEAST_TABLE_ERROR: f64 = 0.002;

/// Wavelengths in nm that the eye sees, nearly all of what it does, and the fewest of which a colour is made.
const EYE_NM: (f64, f64) = (430.0, 680.0);
const COLOURS: usize = 4;

/// A finding for a scene that is refused, or cannot even be read.
#[must_use]
pub fn unreadable(error: &str) -> Finding {
    let remedy = "airlight scene new writes a file with every key and its range";
    Finding::new(Trouble::Refused, error, remedy)
}

/// What is wrong with a scene, by what it says and by what was seen of it, if anything was.
#[must_use]
pub fn of_scene(scene: &Scene, looks: Option<&Looks>) -> Vec<Finding> {
    let mut findings: Vec<Finding> = underground(scene).into_iter().collect();
    if let Err(error) = scene.validate()
        && findings.is_empty()
    {
        findings.push(refused(&error));
    }
    findings.extend(night(scene));
    if let Some(looks) = looks {
        findings.extend(view(scene, looks));
        findings.extend(exposure(scene, looks));
        findings.extend(noise(scene, looks));
        findings.extend(effort(scene, looks));
    }
    findings.extend(wavelengths(scene));
    findings.extend(work(scene));
    findings
}

fn refused(error: &SceneError) -> Finding {
    unreadable(&error.to_string())
}

/// An observer below the ground.
fn underground(scene: &Scene) -> Option<Finding> {
    let below = scene.altitude_km < 0.0;
    let what = format!("the observer is {} km below the ground", -scene.altitude_km);
    below.then(|| {
        Finding::new(
            Trouble::Refused,
            what,
            "altitudes count from the ground: altitude_km = 0.002, or --altitude 0.002",
        )
    })
}

/// No sun on anything that is seen.
fn night(scene: &Scene) -> Option<Finding> {
    // Seen from above the sun sets later.
    let dip = horizon_dip(scene.altitude_km.max(0.0) * KM).to_degrees();
    let above_horizon = scene.sun_elevation_deg + dip;
    let what = format!(
        "the sun stands {:.1} degrees below the horizon, the air has no sunlight when that is more than {}, and there are no moon and stars here",
        -above_horizon, -NIGHT_DEG
    );
    (above_horizon < NIGHT_DEG).then(|| Finding::new(Trouble::Black, what, "raise the sun: --sun-elevation -6"))
}

/// A camera that looks into the ground, or past the planet.
fn view(scene: &Scene, looks: &Looks) -> Vec<Finding> {
    let all = looks.luminances.len();
    let share = |count: usize| count as f64 / all.max(1) as f64;
    let (_, elevation) = scene.view_deg();
    let dark = looks.luminances.iter().filter(|y| **y <= 0.0).count();
    let mut found = Vec::new();
    if !scene.in_space() && share(looks.to_ground) >= MOST {
        let what =
            format!("{} of {all} looks end on the ground: the view is {elevation} degrees high", looks.to_ground);
        found.push(Finding::new(Trouble::Black, what, "look up: --view-elevation 10"));
    }
    if scene.in_space() && scene.sun_elevation_deg > NIGHT_DEG && share(dark) >= MOST {
        let dip = -horizon_dip(scene.altitude_km * KM).to_degrees();
        let what = format!("{dark} of {all} looks see neither air nor ground");
        let remedy = match scene.camera {
            CameraKind::Pinhole | CameraKind::Fisheye => format!("the horizon is at --view-elevation {dip:.1}"),
            CameraKind::Latlong | CameraKind::EqualArea => {
                format!("the horizon is {dip:.1} degrees high: take --camera pinhole")
            }
        };
        found.push(Finding::new(Trouble::Black, what, remedy));
    }
    found
}

/// An exposure that is not that of the light.
fn exposure(scene: &Scene, looks: &Looks) -> Option<Finding> {
    let asked = scene.exposure_ev?;
    if looks.mean() <= 0.0 {
        return None;
    }
    let right = tone::automatic_ev(looks.luminances.iter().copied());
    let off = asked - right;
    let (trouble, word) = if off > 0.0 { (Trouble::Black, "darker") } else { (Trouble::BlownOut, "brighter") };
    let what = format!(
        "exposure {asked} EV shows the mean luminance of {:.3e} cd/m2 {:.1} stops {word} than the automatic one",
        looks.mean(),
        off.abs()
    );
    (off.abs() > STOPS).then(|| Finding::new(trouble, what, format!("leave it out, or --exposure {right:.1}")))
}

/// Noise of traced pictures.
fn noise(scene: &Scene, looks: &Looks) -> Option<Finding> {
    let cost = looks.cost.as_ref().ok().filter(|_| scene.method == Method::Paths)?;
    let samples = samples(scene, cost.spread);
    let noise = cost.spread / samples.sqrt();
    let what = format!("{samples:.0} samples leave a noise of about {:.1} % of luminance in a pixel", 100.0 * noise);
    let needed = (cost.spread / NOISE).powi(2).ceil();
    let remedy = format!("--spp {needed} for {} %, or leave --method out: solved tables have no noise", 100.0 * NOISE);
    (noise > 1.001 * NOISE && scene.error.is_none_or(|error| noise > 1.1 * error))
        .then(|| Finding::new(Trouble::Noisy, what, remedy))
}

/// More work than anybody waits for.
fn effort(scene: &Scene, looks: &Looks) -> Vec<Finding> {
    let mut found = Vec::new();
    if let Ok(cost) = &looks.cost {
        let core_s = cost.once_s + cost.picture_s;
        if core_s > LONG_S {
            let what = format!("about {core_s:.0} core-seconds are predicted");
            found.push(Finding::new(
                Trouble::Slow,
                what,
                "fewer pixels (--width, --height), a larger --error, or shards on several machines (--shard)",
            ));
        }
        let needed =
            scene.error.filter(|_| scene.method == Method::Paths).map(|error| (error, samples(scene, cost.spread)));
        if let Some((error, needed)) = needed.filter(|(_, needed)| *needed > MANY_SAMPLES) {
            let what = format!("an error of {} % needs about {needed:.0} samples of each pixel", 100.0 * error);
            found.push(Finding::new(Trouble::Slow, what, "ask for --error 1%, or take solved tables and --certify"));
        }
    }
    found
}

/// Colours that are none.
fn wavelengths(scene: &Scene) -> Option<Finding> {
    if scene.colour != Scheme::Spectral || scene.method.is_dome() {
        return None;
    }
    let wavelengths = scene.wavelengths();
    let nm = wavelengths.nm();
    let (first, last) = (nm[0], nm[nm.len() - 1]);
    let what = if nm.len() < COLOURS {
        format!(
            "{} wavelengths make no colour: R, G and B take the light to be alike between and beyond them",
            nm.len()
        )
    } else if first > EYE_NM.0 || last < EYE_NM.1 {
        format!(
            "the wavelengths reach from {first} to {last} nm, the eye sees {} to {} nm: R, G and B take the light beyond to be that of the last",
            EYE_NM.0, EYE_NM.1
        )
    } else {
        return None;
    };
    Some(Finding::new(Trouble::Colour, what, "--wavelengths 16 for colour; --spectral writes the channels themselves"))
}

/// What makes a method slow, whatever it costs exactly.
fn work(scene: &Scene) -> Vec<Finding> {
    let mut found = Vec::new();
    let mut slow = |what: String, remedy: &str| found.push(Finding::new(Trouble::Slow, what, remedy));
    if scene.method == Method::Judge {
        let samples = scene.spp.unwrap_or_else(|| scene.default_spp());
        slow(
            format!("the judge tracks each of {samples} samples step by step against the densest air"),
            "--method paths has the same answers from tables",
        );
    }
    if scene.has_texture() {
        let (width, height) = scene.size();
        slow(
            format!(
                "the map of the Earth is looked up from each of {} pixels and each bounce",
                u64::from(width) * u64::from(height)
            ),
            "--albedo 0.2 for a draft",
        );
    }
    let count = scene.channels();
    if count > MANY_WAVELENGTHS {
        slow(
            format!("{count} wavelengths are followed in {} packets of 16", count.div_ceil(16)),
            "colour wants no more than --wavelengths 16",
        );
    }
    if scene.method == Method::Solved && scene.fineness.is_none() && scene.table_error < LEAST_TABLE_ERROR {
        slow(
            format!(
                "a table error of {} % is less than most grids state: all of them are solved in turn",
                100.0 * scene.table_error
            ),
            "ask for --table-error 0.2%, or --method paths --error",
        );
    }
    let (width, height) = scene.size();
    let bytes = Film::bytes(width, height, scene.channels(), scene.polarisation);
    if bytes > LARGE_BYTES {
        slow(
            format!("the film of {width} x {height} pixels takes {:.1} GB of memory", bytes as f64 / 1e9),
            "fewer pixels or wavelengths",
        );
    }
    found
}
