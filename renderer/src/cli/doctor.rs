//! `airlight doctor`.

use super::output::println;
use super::picture::has_extension;
use super::progress::amount;
use super::render::read_scene;
use super::{Failure, Outcome};
use crate::doctor::{Finding, Looks, Seen, of_picture, of_scene, unreadable};
use crate::film::{Channels, exr, tone};
use crate::render::receipt;
use crate::scene::Scene;
use clap::Args;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};

/// Flags of `airlight doctor`.
#[derive(Debug, Args)]
pub(super) struct DoctorArgs {
    /// Scene (TOML, JSON, XML of the thesis) or picture (EXR), which carries its scene
    #[arg(value_name = "SCENE|PICTURE")]
    pub file: PathBuf,
    /// Folder of the tables [default: those that the program carries]
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    /// Threads for the looks, 1 to 1024 [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Write the findings as JSON
    #[arg(long)]
    pub json: bool,
    /// Say nothing but findings: nothing at all where nothing is wrong
    #[arg(long, conflicts_with = "json")]
    pub quiet: bool,
}

pub(super) fn run(args: &DoctorArgs) -> Result<Outcome, Failure> {
    let path = args.file.as_path();
    let mut findings = Vec::new();
    let scene = if has_extension(path, "exr") {
        let (of_pixels, scene) = picture(path)?;
        findings.extend(of_pixels);
        scene
    } else {
        // A file that is not there is no scene; one that says what cannot be is a finding.
        std::fs::metadata(path)
            .map_err(|error| Failure::error(format!("{}: cannot be read: {error}", path.display())))?;
        match read_scene(path, &[]) {
            Ok(scene) => Some(scene),
            Err(failure) => {
                findings.push(unreadable(&failure.message));
                None
            }
        }
    };
    let mut looks = None;
    if let Some(scene) = &scene {
        match look(scene, args) {
            Ok(seen) => looks = seen,
            Err(failure) => findings.push(unreadable(&failure.message)),
        }
        for finding in of_scene(scene, looks.as_ref()) {
            // One thing may be seen in the pixels and foreseen by the scene.
            if !findings.iter().any(|other: &Finding| other.trouble == finding.trouble && other.what == finding.what) {
                findings.push(finding);
            }
        }
    }
    if args.json {
        println!("{}", serde_json::to_string_pretty(&json_of(&findings, looks.as_ref())).map_err(Failure::error)?);
        return Ok(Outcome::Done);
    }
    for Finding { trouble, what, remedy } in &findings {
        println!("{:11} {what}", trouble.name());
        println!("            {remedy}");
    }
    if args.quiet {
        return Ok(Outcome::Done);
    }
    if findings.is_empty() {
        println!("fine        nothing was found wrong");
    }
    looks.iter().for_each(describe);
    Ok(Outcome::Done)
}

/// What the pixels of a picture tell, and its scene if it carries one.
fn picture(path: &Path) -> Result<(Vec<Finding>, Option<Scene>), Failure> {
    let at = |error: &dyn std::fmt::Display| Failure::error(format!("{}: {error}", path.display()));
    let bytes = std::fs::read(path).map_err(|error| at(&format!("cannot be read: {error}")))?;
    let channels = Channels::read(&bytes).map_err(|error| at(&format!("no picture that can be looked at: {error}")))?;
    let told = exr::text_attribute(&bytes, receipt::RECEIPT).map_err(|error| at(&error))?;
    let told: Value = told.and_then(|text| serde_json::from_str(text).ok()).unwrap_or_default();
    let automatic = || {
        let luminances = channels.rgb().unwrap_or_default().into_iter().map(crate::spectrum::luminance);
        tone::automatic_ev(luminances.filter(|y| y.is_finite()))
    };
    let seen = Seen {
        exposure_ev: told["picture"]["exposure_ev"].as_f64().unwrap_or_else(automatic),
        samples: told["picture"]["samples_per_pixel_least"].as_f64(),
        noiseless: told["method"]["without_noise"].as_bool().unwrap_or(false),
        stopped: told["picture"]["stopped_early"].as_bool().unwrap_or(false),
    };
    let findings = of_picture(&channels, &seen).map_err(|error| at(&error))?;
    let carries = exr::text_attribute(&bytes, receipt::SCENE).map_err(|error| at(&error))?.is_some();
    Ok((findings, if carries { Some(read_scene(path, &[])?) } else { None }))
}

/// A few quick looks; none at a scene that cannot be.
fn look(scene: &Scene, args: &DoctorArgs) -> Result<Option<Looks>, Failure> {
    if scene.validate().is_err() {
        return Ok(None);
    }
    let data = super::data(args.data.as_deref())?;
    let pool = super::pool(args.threads)?;
    pool.install(|| Looks::take(scene, &data)).map(Some).map_err(super::render::failure)
}

fn describe(looks: &Looks) {
    let lit = looks.luminances.iter().copied();
    let (least, most) = lit.fold((f64::INFINITY, 0.0_f64), |(least, most), y| (least.min(y), most.max(y)));
    println!(
        "seen        {} looks, {} of them at the ground; {} to {} cd/m2, automatic exposure EV {:.1}",
        looks.luminances.len(),
        looks.to_ground,
        amount(least),
        amount(most),
        tone::automatic_ev(looks.luminances.iter().copied())
    );
    match &looks.cost {
        Ok(cost) => println!(
            "cost        about {} core-seconds for what is made once and {} for the picture, by stored measurements",
            amount(cost.once_s),
            amount(cost.picture_s)
        ),
        Err(outside) => println!("cost        not known: what was measured does not hold {outside}"),
    }
}

fn json_of(findings: &[Finding], looks: Option<&Looks>) -> Value {
    let all = findings
        .iter()
        .map(|Finding { trouble, what, remedy }| json!({ "trouble": trouble.name(), "what": what, "remedy": remedy }));
    json!({
        "findings": all.collect::<Vec<_>>(),
        "looks": looks.map(|looks| json!({
            "looks": looks.luminances.len(),
            "to_ground": looks.to_ground,
            "luminance_mean_cd_m2": looks.mean(),
            "exposure_automatic_ev": tone::automatic_ev(looks.luminances.iter().copied()),
            "predicted_once_core_s": looks.cost.as_ref().ok().map(|cost| cost.once_s),
            "predicted_picture_core_s": looks.cost.as_ref().ok().map(|cost| cost.picture_s),
            "not_predicted_for": looks.cost.as_ref().err(),
        })),
    })
}
