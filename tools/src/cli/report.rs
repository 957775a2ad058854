//! The subcommand `report`.

use super::{output, say, size};
use clap::Args;
use std::path::PathBuf;
use tools::report::{self, Folders};

/// Arguments of `report`.
#[derive(Args)]
pub(super) struct ReportArgs {
    /// Page to write
    #[arg(short, long, value_name = "FILE.html", default_value = "report.html")]
    output: PathBuf,
    /// Folder of the tables
    #[arg(long, value_name = "DIR", default_value = "data")]
    data: PathBuf,
    /// Folder of the figures
    #[arg(long, value_name = "DIR", default_value = "plots")]
    plots: PathBuf,
    /// Folder of the documents
    #[arg(long, value_name = "DIR", default_value = "docs")]
    docs: PathBuf,
    /// Say nothing but errors
    #[arg(long)]
    quiet: bool,
}

/// Writes the page.
pub(super) fn write(args: &ReportArgs) -> Result<(), String> {
    let folders = Folders { data: &args.data, plots: &args.plots, docs: &args.docs };
    let page = report::html(folders).map_err(|e| e.to_string())?;
    if !args.quiet {
        output::announce(&args.output);
    }
    tables::file::replace(&args.output, page.as_bytes())
        .map_err(|e| format!("{}: cannot be written: {e}", args.output.display()))?;
    if !args.quiet {
        say(&format!("{}  {}", args.output.display(), size(page.len() as u64)));
    }
    Ok(())
}
