//! `airlight radiance`.

use super::output::println;
use super::progress::{Line, duration};
use super::words::{MethodName, TierName, share};
use super::{Failure, Outcome};
use crate::cases::{self, Effort, Refusal, Report, Settings};
use clap::Args;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Flags of `airlight radiance`.
#[derive(Debug, Args)]
pub(super) struct RadianceArgs {
    /// Cases: JSON; those whose `polarization` is `vector` get polarised transfer
    #[arg(value_name = "CASES.json")]
    pub cases: PathBuf,
    /// Answers to write: CSV with id,value,stderr
    #[arg(short, long, value_name = "ANSWERS.csv")]
    pub output: PathBuf,
    /// Which cases
    #[arg(long, default_value = "core")]
    pub tier: TierName,
    /// What answers
    #[arg(long, value_name = "METHOD", default_value = "paths")]
    pub method: MethodName,
    /// Standard error of each case relative to its value (of Q and U to I), 1e-5 to 1: 1% or 0.01 [default: 1%]
    #[arg(long, value_name = "E", value_parser = share, conflicts_with = "spp")]
    pub error: Option<f64>,
    /// Paths for each case instead, or fans, 2 or more [default: as --error]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(2..))]
    pub spp: Option<u64>,
    /// Seed of the random numbers, 0 to 2^64 - 1
    #[arg(long, value_name = "S", default_value_t = 0)]
    pub seed: u64,
    /// Threads, 1 to 1024; the answers do not depend on it [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}

pub(super) fn run(args: &RadianceArgs) -> Result<Outcome, Failure> {
    let suite = cases::read(&args.cases).map_err(Failure::error)?;
    // Better now than after the work.
    tables::file::check_writable(&args.output).map_err(|e| super::unwritable(&args.output, &e))?;
    let effort = args.spp.map_or(Effort::Error(args.error.unwrap_or(0.01)), Effort::Paths);
    let settings = Settings { tier: args.tier.into(), method: args.method.into(), effort, seed: args.seed };
    let line = Line::new(args.quiet);
    let progress = |done: usize, all: usize| {
        line.show(done as f64 / all.max(1) as f64, |_| format!("{done} of {all} cases"));
    };
    let pool = super::pool(args.threads)?;
    let report = pool.install(|| cases::run(&suite, &settings, &progress));
    line.clear();
    let path = &args.output;
    super::announce(path, args.quiet);
    super::write(path, cases::to_csv(&report.answers).as_bytes())?;
    if !args.quiet {
        describe(&report, settings.method == cases::Method::Certified);
        println!("time        {} on {} threads", duration(line.elapsed().as_secs_f64()), pool.current_num_threads());
        println!("written     {}", path.display());
    }
    Ok(Outcome::Done)
}

/// The most cases that are named beside a reason.
const SHOWN: usize = 5;

/// How many were answered, and the others by the reason why not.
fn describe(report: &Report, fans: bool) {
    let paths: u64 = report.answers.iter().map(|answer| answer.paths).sum();
    println!("answered    {} cases with {paths} {}", report.answers.len(), if fans { "fans" } else { "paths" });
    let mut reasons: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for Refusal { id, why } in &report.refusals {
        reasons.entry(why).or_default().push(id);
    }
    for (why, ids) in reasons {
        let (shown, rest) = ids.split_at(ids.len().min(SHOWN));
        let more = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
        println!("refused     {} cases, {why}: {}{more}", ids.len(), shown.join(", "));
    }
}
