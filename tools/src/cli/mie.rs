//! The subcommand `mie`.

use super::output::{print, put};
use clap::{Args, ValueEnum};
use std::path::PathBuf;
use tools::mie::Instructions;
use tools::mie_cases;
use tools::mie_tasks::{Alike, Distributions};

/// Arguments of `mie`.
#[derive(Args)]
pub(super) struct MieArgs {
    /// CSV with the columns x, m_re, m_im and possibly id; m = n - ik there, so m_im <= 0
    #[arg(long, alias = "in", value_name = "IN.csv")]
    cases: PathBuf,
    /// CSV to write: id, Qext, Qsca, Qabs, Qback, g, and S1, S2 at 0, 30, 90, 150, 180 degrees (m = n - ik)
    #[arg(long, value_name = "OUT.csv")]
    out: PathBuf,
    /// What is asked: cases, spheres one by one; a, efficiencies of many spheres of one index; b, sums over size
    /// distributions (JSON). a and b print the time of the fastest repeat as JSON
    #[arg(long, value_enum, default_value = "cases")]
    task: Task,
    /// How often a and b are done for the time, 1 or more
    #[arg(long, value_name = "N", default_value_t = 1)]
    repeat: u32,
    /// Instruction set of a and b: plain, avx2 or avx512 [default: the widest of this processor]
    #[arg(long, value_name = "SET", value_parser = instructions)]
    instructions: Option<Instructions>,
}

/// What can be asked of `mie`.
#[derive(Clone, Copy, ValueEnum)]
enum Task {
    Cases,
    A,
    B,
}

fn instructions(name: &str) -> Result<Instructions, String> {
    let available = Instructions::available();
    let asked = Instructions::from_name(name).filter(|set| available.contains(set));
    let names = || available.iter().map(|set| set.name()).collect::<Vec<_>>().join(", ");
    asked.ok_or_else(|| format!("this processor has {}", names()))
}

/// Solves the spheres of a file into another.
pub(super) fn solve(args: &MieArgs) -> Result<(), String> {
    let named = |e: &dyn std::fmt::Display| format!("{}: {e}", args.cases.display());
    let input = std::fs::read_to_string(&args.cases).map_err(|e| named(&format!("cannot be read: {e}")))?;
    // Better now than after the work.
    tables::file::check_writable(&args.out).map_err(|e| format!("{}: cannot be written: {e}", args.out.display()))?;
    let write = |csv: &str| put(csv.as_bytes(), Some(&args.out));
    let set = args.instructions.unwrap_or_else(Instructions::best);
    let done = match args.task {
        Task::Cases => return write(&mie_cases::solve(&input).map_err(|e| named(&e))?),
        Task::A => Alike::parse(&input).and_then(|task| Ok(task.solve(set, args.repeat)?)),
        Task::B => Distributions::parse(&input).and_then(|task| Ok(task.solve(set, args.repeat)?)),
    };
    let done = done.map_err(|e| named(&e))?;
    write(&done.csv)?;
    let line = format!("{{\"seconds_min\": {:e}, \"instructions\": \"{set}\"}}\n", done.fastest.as_secs_f64());
    print(line.as_bytes())
}
