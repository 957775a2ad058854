//! `airlight render --auto`: plan, render, look whether it is as exact as asked, and go on if it is not.

use super::args::RenderArgs;
use super::output::println;
use super::picture::{Files, Product};
use super::progress::{Line, amount, percent};
use super::render::{sky, stop_on_interrupt};
use super::{Failure, Outcome};
use crate::clock::process_s;
use crate::plan::Metric;
use crate::render::{
    Achieved, Control, End, Extent, Head, Part, Progress, Shard, Summary, achieved, disc_layer, empty, go_on,
};
use crate::scene::Scene;
use std::sync::atomic::Ordering;
use std::time::Instant;

pub(super) fn run(args: &RenderArgs, scene: &Scene, begin: Instant) -> Result<Outcome, Failure> {
    let metric = args.metric.unwrap_or(Metric::Radiance);
    let asked = args.error.map_or(0.01, |error| error.of(metric));
    let files = Files::new(&args.files.output, None, !args.files.no_receipt)?;
    files.announce(&args.files);
    let data = super::data(args.files.data.as_deref())?;
    let pool = super::pool(args.threads)?;
    let folder = super::made(args.keep_tables.as_deref())?;
    let stop = stop_on_interrupt();
    let mut plan = pool.install(|| super::plan::plan(scene, &data, args, asked))?;
    loop {
        if args.files.talks() {
            super::plan::describe(&plan, scene).iter().for_each(|line| println!("{line}"));
        }
        let planned = plan.scene(scene);
        planned.validate()?;
        let sky = pool.install(|| sky(&planned, &data, folder))?;
        let part = Part { seed: planned.seed, shard: Shard::default() };
        let head = Head::new(&planned, &sky, vec![part]);
        let work = || {
            let (summary, disc) = (Summary::new(&sky, planned.seed, &stop), disc_layer(&planned, &sky));
            let line = Line::new(args.files.quiet);
            let observe =
                |progress: Progress| line.show(progress.fraction, |_| format!("error {}", percent(progress.error)));
            let control = Control { stop: &stop, observe: &observe };
            let rendering = go_on(empty(&planned, &sky), &planned, &sky, Extent::default(), control, &mut |_| {})?;
            line.clear();
            // Paths state their own error.
            let stopped = rendering.end == End::Stopped || stop.load(Ordering::Relaxed);
            let before = process_s();
            let found = if sky.is_noiseless() && !stopped {
                achieved((&planned, &sky), &data, (metric, asked, &scene.wavelengths()), plan.checking_paths(), &stop)?
            } else {
                None
            };
            Ok((summary, disc, rendering, (found, process_s() - before)))
        };
        let (summary, disc, rendering, (found, check_s)) =
            pool.install(work).map_err(|error: crate::render::RenderError| Failure::error(error))?;
        if let Some(found) = &found
            && found.fails()
            && let Some(next) = plan.up(scene)
        {
            if args.files.talks() {
                println!("check       {}: a more exact plan", words(found));
            }
            plan = next;
            continue;
        }
        if found.is_some() && args.files.talks() {
            println!("check       {} core-seconds", amount(check_s));
        }
        let end = rendering.end;
        let (scene, head) = (&planned, Head { scene: planned.portable(), ..head });
        Product { scene, sky: &sky, summary, disc, rendering, head, verdict: None, achieved: found }.deliver(
            &files,
            &args.files,
            begin,
            &pool,
        )?;
        return Ok(if end == End::Stopped { Outcome::Interrupted } else { Outcome::Done });
    }
}

/// What the check found.
pub(super) fn words(found: &Achieved) -> String {
    let Achieved { metric, asked, found: error, between: [least, most], size: (pixels, paths) } = *found;
    let verdict = match (found.holds(), found.fails()) {
        (true, _) => "below",
        (_, true) => "above",
        _ => "not shown to be below or above",
    };
    format!(
        "{} off by {} (rms), from {} to {} with 90 % confidence, at most the latter with 95 %: {verdict} the asked {}; {pixels} pixels, {} paths",
        metric.name(),
        metric.show(error),
        metric.show(least),
        metric.show(most),
        metric.show(asked),
        amount(paths as f64)
    )
}
