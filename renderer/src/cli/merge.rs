//! `airlight merge`.

use super::args::MergeArgs;
use super::picture::{Files, Product, has_extension, read_state};
use super::render::{sky, stop_on_interrupt};
use super::{Failure, Outcome};
use crate::data::Data;
use crate::film::Film;
use crate::render::{End, Head, Merged, Rendering, Summary, disc_layer};
use std::path::PathBuf;
use std::time::Instant;

pub(super) fn run(args: &MergeArgs) -> Result<Outcome, Failure> {
    let begin = Instant::now();
    let files = Files::new(&args.files.output, args.checkpoint.as_deref())?;
    // A picture stands for the state beside it.
    let beside = |path: &PathBuf| if has_extension(path, "exr") { path.with_extension("state") } else { path.clone() };
    let paths: Vec<PathBuf> = args.states.iter().map(beside).collect();
    let read = |path: &PathBuf| read_state(path, &[]);
    // Twice, so that only one film beside the sum is in memory.
    let heads = paths.iter().map(|path| Ok((path.display().to_string(), read(path)?.head)));
    let heads: Vec<(String, Head)> = heads.collect::<Result<_, Failure>>()?;
    let Some(plan) = Merged::new(&heads).map_err(Failure::usage)? else {
        return Err(Failure::usage("nothing to merge"));
    };
    let mut sum: Option<Film> = None;
    for &index in &plan.order {
        let (path, state) = (&paths[index], read(&paths[index])?);
        let at = |text: String| Failure::error(format!("{}: {text}", path.display()));
        if state.head != heads[index].1 {
            return Err(at("it changed while it was read: merge when its run has ended".into()));
        }
        match &mut sum {
            Some(sum) => sum.merge(&state.film).map_err(|error| at(error.to_string()))?,
            None => sum = Some(state.film),
        }
    }
    let Some(film) = sum else { return Err(Failure::usage("nothing to merge")) };
    let mut head = plan.head(&film);
    head.scene.exposure_ev = args.files.exposure.or(head.scene.exposure_ev);
    head.scene.tone = args.files.tone.unwrap_or(head.scene.tone);
    head.scene.white = args.files.white.unwrap_or(head.scene.white);
    head.scene.validate()?;
    let scene = head.scene.clone();
    let data = Data::load(&args.files.data).map_err(Failure::error)?;
    let sky = sky(&scene, &data, None)?;
    if let Some(difference) = head.difference(&Head::new(&scene, &sky, head.parts.clone())) {
        let folder = args.files.data.display();
        return Err(Failure::usage(format!(
            "the runs were made with other tables than those of {folder}: {difference}"
        )));
    }
    head.scene = scene.portable();
    let pool = super::pool(args.threads)?;
    let stop = stop_on_interrupt();
    let (summary, disc) = pool.install(|| (Summary::new(&sky, scene.seed, &stop), disc_layer(&scene, &sky)));
    let rendering = Rendering { errors: film.errors(), film, end: End::Done };
    Product { scene: &scene, sky: &sky, summary, disc, rendering, head, verdict: None, achieved: None }.deliver(
        &files,
        &args.files,
        begin,
        &pool,
    )?;
    Ok(Outcome::Done)
}
