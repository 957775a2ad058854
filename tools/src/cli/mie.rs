//! The subcommand `mie`.

use clap::Args;
use std::path::PathBuf;
use tools::mie_cases;

/// Arguments of `mie`.
#[derive(Args)]
pub(super) struct MieArgs {
    /// CSV with the columns x, m_re, m_im and possibly id; m = n - ik there, so m_im <= 0
    #[arg(long, value_name = "IN.csv")]
    cases: PathBuf,
    /// CSV to write: id, Qext, Qsca, Qabs, Qback, g, and S1, S2 at 0, 30, 90, 150, 180 degrees (m = n - ik)
    #[arg(long, value_name = "OUT.csv")]
    out: PathBuf,
}

/// Solves the spheres of a file into another.
pub(super) fn solve(args: &MieArgs) -> Result<(), String> {
    let unwritable = |e: std::io::Error| format!("{}: cannot be written: {e}", args.out.display());
    let input =
        std::fs::read_to_string(&args.cases).map_err(|e| format!("{}: cannot be read: {e}", args.cases.display()))?;
    // Better now than after the work.
    tables::file::check_writable(&args.out).map_err(unwritable)?;
    let output = mie_cases::solve(&input).map_err(|e| format!("{}: {e}", args.cases.display()))?;
    tables::file::replace(&args.out, output.as_bytes()).map_err(unwritable)
}
