//! `airlight sweep`.

use super::output::println;
use super::progress::{Line, amount, duration};
use super::words::{EstimatorName, count};
use super::{Failure, Outcome};
use crate::sweep::{Bad, Departure, Fault, LAW, Laws, PATHS, Plan, Report, Scene, Traced, laws};
use crate::transport::Estimator;
use clap::Args;
use serde_json::{Value, json};

/// Flags of `airlight sweep`.
#[derive(Debug, Args)]
pub(super) struct SweepArgs {
    /// Number of paths, 1 to 1e15; 1024 for each scene
    #[arg(long, value_name = "N", value_parser = count, default_value = "1e6")]
    pub paths: u64,
    /// Seed of scenes and paths, 0 to 2^64 - 1
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub seed: u64,
    /// Estimator
    #[arg(long, value_name = "METHOD", default_value = "paths")]
    pub method: EstimatorName,
    /// Threads, 1 to 1024; the findings do not depend on it [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Write what was found as JSON
    #[arg(long, conflicts_with = "scene")]
    pub json: bool,
    /// Say nothing but errors: the exit code tells whether all is well
    #[arg(long, conflicts_with_all = ["scene", "json"])]
    pub quiet: bool,
    /// Trace one path of this scene instead, and say what the scene is [default: all scenes]
    #[arg(long, value_name = "N", requires = "path")]
    pub scene: Option<u64>,
    /// Which path, from 0 [default: all paths]
    #[arg(long, value_name = "K", requires = "scene", value_parser = clap::value_parser!(u64).range(..PATHS))]
    pub path: Option<u64>,
}

/// Skies under which the laws are checked.
const SKIES: u64 = 16;

pub(super) fn run(args: &SweepArgs) -> Result<Outcome, Failure> {
    let plan = Plan { seed: args.seed, paths: args.paths, method: args.method.into() };
    let pool = super::pool(args.threads)?;
    if let (Some(scene), Some(path)) = (args.scene, args.path) {
        return pool.install(|| replay(&plan, scene, path));
    }
    let line = Line::new(args.quiet);
    let report = pool
        .install(|| plan.run(&|share| line.show(share, |_| format!("{} paths", amount(share * plan.paths as f64)))));
    line.clear();
    let seconds = line.elapsed().as_secs_f64();
    let laws = pool.install(|| laws(plan.seed, SKIES));
    if args.json {
        println!("{}", json_of(&plan, &report, &laws, seconds));
    }
    if args.json || args.quiet {
        return verdict(report.bad, laws.kept());
    }
    for bad in &report.examples {
        println!("{}: {}", words(&bad.fault), command(&plan, bad));
    }
    let Report { scenes, paths, bad, most_orders, .. } = report;
    println!(
        "{scenes} scenes, {paths} paths of at most {most_orders} orders, {bad} bad, {}, {} paths/s",
        duration(seconds),
        amount(paths as f64 / seconds)
    );
    let say = |law: &str, Departure { relative, scene }: Departure| {
        println!("{law}: to {relative:.1e} under {SKIES} skies, {LAW:.0e} allowed; worst in scene {scene}");
    };
    say("single scattering, from a metre below the top to a metre above", laws.top);
    say("single scattering, from 1e-6 degrees below the horizon to above", laws.horizon);
    say("single scattering, above the horizon against a sum without tables", laws.sum);
    verdict(bad, laws.kept())
}

fn verdict(bad: u64, kept: bool) -> Result<Outcome, Failure> {
    match (bad, kept) {
        (0, true) => Ok(Outcome::Done),
        (0, false) => Err(Failure::error("a law is broken")),
        (bad, _) => Err(Failure::error(format!("{bad} bad paths"))),
    }
}

fn json_of(plan: &Plan, report: &Report, laws: &Laws, seconds: f64) -> Value {
    let bad = report.examples.iter().map(|bad| json!({ "what": words(&bad.fault), "replay": command(plan, bad) }));
    let law = |Departure { relative, scene }: Departure| json!({ "relative": relative, "scene": scene });
    json!({
        "scenes": report.scenes,
        "paths": report.paths,
        "most_orders": report.most_orders,
        "bad": report.bad,
        "examples": bad.collect::<Vec<_>>(),
        "laws": { "allowed": LAW, "skies": SKIES, "top": law(laws.top), "horizon": law(laws.horizon), "sum": law(laws.sum) },
        "took_s": seconds,
    })
}

/// The scene in words, and the one path.
fn replay(plan: &Plan, scene: u64, path: u64) -> Result<Outcome, Failure> {
    println!("{}", Scene::new(plan.seed, scene));
    let Traced { radiance, orders, fault } = plan.replay(scene, path).map_err(|fault| Failure::error(words(&fault)))?;
    println!("radiance {radiance:?} per sr, {orders} orders");
    fault.map_or(Ok(Outcome::Done), |fault| Err(Failure::error(words(&fault))))
}

/// What traces a bad path again.
fn command(plan: &Plan, bad: &Bad) -> String {
    let method = if plan.method == Estimator::Judge { " --method judge" } else { "" };
    format!("airlight sweep --seed {} --scene {} --path {}{method}", plan.seed, bad.scene, bad.path)
}

fn words(fault: &Fault) -> String {
    match fault {
        Fault::NotFinite => "a radiance that is not finite".into(),
        Fault::Negative => "a negative radiance".into(),
        Fault::Endless => "a path without end".into(),
        Fault::Panic => "a panic".into(),
        Fault::Refused(why) => format!("a scene that is refused: {why}"),
    }
}
