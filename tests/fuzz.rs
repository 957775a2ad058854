//! `airlight-fuzz`: readers under mutated inputs, for as long as is asked.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a program that reports figures")]

use airlight_tests::mutation::{Figures, Plan, input, memory, probe, replay_command, run, targets};
use airlight_tests::root;
use clap::Parser;
use std::process::ExitCode;
use std::time::{Duration, Instant};

#[global_allocator]
static MEMORY: memory::Counting = memory::Counting;

/// Feeds every reader of files with mutated inputs: no panic, no hang (20 s), memory at most 4 times the file and
/// 1 MiB, errors of at most 4096 bytes. The same seed gives the same inputs.
#[derive(Parser)]
struct Cli {
    /// Seconds to run, 1 or more [default: until --inputs are done]
    #[arg(long)]
    seconds: Option<u64>,
    /// Inputs of each reader; with --seconds the most of them [default: 2000, with --seconds no limit]
    #[arg(long)]
    inputs: Option<u64>,
    /// Seed of the mutations, 0 to 2^64 - 1
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Threads, 1 or more [default: all processors]
    #[arg(long)]
    threads: Option<usize>,
    /// Only readers whose name contains this
    #[arg(long, default_value = "")]
    target: String,
    /// Run this one input alone, by its number
    #[arg(long)]
    replay: Option<u64>,
}

fn main() -> ExitCode {
    let cli = Cli::parse();
    let mut targets = targets();
    targets.retain(|target| target.name.contains(&cli.target));
    if targets.is_empty() {
        eprintln!("airlight-fuzz: no reader is called {}", cli.target);
        return ExitCode::from(2);
    }
    if let Some(index) = cli.replay {
        for target in &targets {
            let bytes = input(target, cli.seed, index);
            println!("{}: {} bytes: {:?}", target.name, bytes.len(), probe(target, &bytes));
        }
        return ExitCode::SUCCESS;
    }
    let threads = cli.threads.or_else(|| std::thread::available_parallelism().ok().map(Into::into)).unwrap_or(1).max(1);
    let inputs = cli.inputs.unwrap_or(if cli.seconds.is_some() { u64::MAX } else { 2000 });
    let plan = Plan { seed: cli.seed, inputs, time: cli.seconds.map(Duration::from_secs), threads };
    let folder = root().join("target/fuzz");
    let start = Instant::now();
    let (figures, failures) = run(&targets, plan, &folder, |sentence| eprintln!("airlight-fuzz: {sentence}"));
    println!(
        "| reader | inputs | read | refused | most memory, % of 4 files + 1 MiB | slowest, ms | longest error, bytes | largest input, kB |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    let mut all = Figures::default();
    let line = |name: &str, f: &Figures| {
        println!(
            "| {name} | {} | {} | {} | {:.0} | {:.1} | {} | {} |",
            f.inputs,
            f.accepted,
            f.inputs - f.accepted,
            100.0 * f.memory,
            1e3 * f.slowest.as_secs_f64(),
            f.longest_error,
            f.largest / 1000
        );
    };
    for (target, figures) in targets.iter().zip(&figures) {
        line(&target.name, figures);
        all.merge(figures);
    }
    line("all", &all);
    println!(
        "seed {}, {:.0} s on {threads} threads, {} failures",
        cli.seed,
        start.elapsed().as_secs_f64(),
        failures.len()
    );
    for failure in &failures {
        let name = &targets[failure.target].name;
        eprintln!("airlight-fuzz: {name}: {}: {}", failure.what, replay_command(name, cli.seed, failure.index));
    }
    if failures.is_empty() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
