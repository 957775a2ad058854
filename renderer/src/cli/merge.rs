//! `airlight merge`.

use super::args::PictureArgs;
use super::output::println;
use super::picture::{Files, Product, has_extension, read_state};
use super::render::{sky, stop_on_interrupt};
use super::{Failure, Outcome};
use crate::film::Film;
use crate::render::{End, Head, Merged, Part, Rendering, Shard, Summary, disc_layer};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;

/// Flags of `airlight merge`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub(super) struct MergeArgs {
    /// States of runs (--checkpoint, --shard), or their pictures with the states beside them (sky.exr: sky.state)
    #[arg(value_name = "STATE", required = true)]
    pub states: Vec<PathBuf>,
    #[command(flatten)]
    pub files: PictureArgs,
    /// Write the state of the whole too, to be merged with more [default: none]
    #[arg(long, value_name = "FILE", help_heading = "Files")]
    pub checkpoint: Option<PathBuf>,
    /// Threads, 1 to 1024; the picture does not depend on it [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), help_heading = "Files")]
    pub threads: Option<u16>,
}

pub(super) fn run(args: &MergeArgs) -> Result<Outcome, Failure> {
    let begin = Instant::now();
    let files = Files::new(&args.files.output, args.checkpoint.as_deref(), !args.files.no_receipt)?;
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
    let data = super::data(args.files.data.as_deref())?;
    let sky = sky(&scene, &data, None)?;
    if let Some(difference) = head.difference(&Head::new(&scene, &sky, head.parts.clone())) {
        let whose = match &args.files.data {
            Some(folder) => format!("those of {}", folder.display()),
            None => "the program carries, name theirs with --data".into(),
        };
        return Err(Failure::usage(format!("the runs were made with other tables than {whose}: {difference}")));
    }
    head.scene = scene.portable();
    if let Some(missing) = missing(&head.parts).filter(|_| args.files.talks()) {
        println!("incomplete  {missing}");
    }
    files.announce(&args.files);
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

/// The shards that are not there, where all parts are shards of one seed and number.
fn missing(parts: &[Part]) -> Option<String> {
    const SHOWN: usize = 8;
    let first = parts.first()?;
    let of = first.shard.of();
    if parts.iter().any(|part| part.seed != first.seed || part.shard.of() != of) {
        return None;
    }
    let there = |index: &u32| parts.iter().any(|part| Shard::new(*index, of) == Ok(part.shard));
    let missing: Vec<String> = (1..=of).filter(|index| !there(index)).map(|index| format!("{index}/{of}")).collect();
    let more = if missing.len() > SHOWN { format!(" and {} more", missing.len() - SHOWN) } else { String::new() };
    let shown = missing.iter().take(SHOWN).cloned().collect::<Vec<_>>().join(", ");
    (!missing.is_empty()).then(|| format!("without {} of {of} shards: {shown}{more}", missing.len()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_that_are_missing_are_named() {
        let part = |seed, index, of| Part { seed, shard: Shard::new(index, of).expect("possible") };
        assert_eq!(missing(&[part(0, 1, 3), part(0, 2, 3), part(0, 3, 3)]), None);
        let found = missing(&[part(0, 1, 4), part(0, 3, 4)]);
        assert_eq!(found.as_deref(), Some("without 2 of 4 shards: 2/4, 4/4"));
        assert_eq!(missing(&[part(0, 1, 1), part(1, 1, 2)]), None, "seeds are whole pictures of their own");
    }
}
