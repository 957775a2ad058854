//! `airlight sweep`.

use super::args::SweepArgs;
use super::output::println;
use super::progress::{Line, amount, duration};
use super::{Failure, Outcome};
use crate::sweep::{Bad, Departure, Fault, LAW, Plan, Report, Scene, Traced, laws};
use crate::transport::Estimator;

/// Skies under which the laws are checked.
const SKIES: u64 = 16;

pub(super) fn run(args: &SweepArgs) -> Result<Outcome, Failure> {
    let plan = Plan { seed: args.seed, paths: args.paths, method: args.method.into() };
    let pool = super::pool(args.threads)?;
    if let (Some(scene), Some(path)) = (args.scene, args.path) {
        return pool.install(|| replay(&plan, scene, path));
    }
    let line = Line::new(false);
    let report = pool
        .install(|| plan.run(&|share| line.show(share, |_| format!("{} paths", amount(share * plan.paths as f64)))));
    line.clear();
    for bad in &report.examples {
        println!("{}: {}", words(&bad.fault), command(&plan, bad));
    }
    let seconds = line.elapsed().as_secs_f64();
    let Report { scenes, paths, bad, most_orders, .. } = report;
    println!(
        "{scenes} scenes, {paths} paths of at most {most_orders} orders, {bad} bad, {}, {} paths/s",
        duration(seconds),
        amount(paths as f64 / seconds)
    );
    let laws = pool.install(|| laws(plan.seed, SKIES));
    let say = |law: &str, Departure { relative, scene }: Departure| {
        println!("{law}: to {relative:.1e} under {SKIES} skies, {LAW:.0e} allowed; worst in scene {scene}");
    };
    say("single scattering, from a metre below the top to a metre above", laws.top);
    say("single scattering, from 1e-6 degrees below the horizon to above", laws.horizon);
    say("single scattering, above the horizon against a sum without tables", laws.sum);
    match (bad, laws.kept()) {
        (0, true) => Ok(Outcome::Done),
        (0, false) => Err(Failure::error("a law is broken")),
        (bad, _) => Err(Failure::error(format!("{bad} bad paths"))),
    }
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
