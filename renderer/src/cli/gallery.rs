//! `airlight gallery`.

use super::output::println;
use super::progress::{Line, duration, percent, size};
use super::render::stop_on_interrupt;
use super::{Failure, Outcome};
use crate::film::png;
use crate::gallery::{Exposure, Figure, Made, Work, figures, make};
use crate::render::{Control, Progress};
use clap::Args;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Flags of `airlight gallery`.
#[derive(Debug, Args)]
pub(super) struct GalleryArgs {
    /// Figures, by their names or the numbers of the thesis (6.4) [default: all]
    #[arg(value_name = "NAME")]
    pub names: Vec<String>,
    /// List the figures, and render nothing
    #[arg(long)]
    pub list: bool,
    /// Folder to write NAME.png to; it is made if it is not there
    #[arg(short, long, value_name = "DIR", default_value = "gallery")]
    pub output: PathBuf,
    /// Pixels of the longer side of each picture of a figure, 16 to 4096 [default: 128 to 640]
    #[arg(long, value_name = "PX", value_parser = clap::value_parser!(u32).range(16..=4096))]
    pub size: Option<u32>,
    /// Folder of the tables [default: those that the program carries]
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    /// Keep solved tables in this folder, and take them from there [default: none are kept]
    #[arg(long, value_name = "DIR")]
    pub keep_tables: Option<PathBuf>,
    /// Threads, 1 to 1024; the pictures do not depend on it [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}

pub(super) fn run(args: &GalleryArgs) -> Result<Outcome, Failure> {
    let wanted = wanted(&args.names)?;
    if args.list {
        wanted.iter().for_each(|figure| println!("{:15} {}{}", figure.name, figure.caption, counterpart(figure)));
        return Ok(Outcome::Done);
    }
    super::made(Some(&args.output))?;
    super::made(args.keep_tables.as_deref())?;
    let data = super::data(args.data.as_deref())?;
    let pool = super::pool(args.threads)?;
    let (stop, begin) = (stop_on_interrupt(), Instant::now());
    for (index, figure) in wanted.iter().enumerate() {
        let (start, line) = (Instant::now(), Line::new(args.quiet));
        let figure = args.size.map_or_else(|| figure.clone(), |side| figure.clone().sized(side));
        let observe = |progress: Progress| {
            line.show(progress.fraction, |_| format!("{} ({} of {})", figure.name, index + 1, wanted.len()));
        };
        let control = Control { stop: &stop, observe: &observe };
        let work = Work { data: &data, kept: args.keep_tables.as_deref(), control };
        let made = pool.install(|| make(&figure, work));
        line.clear();
        let Some(made) = made.map_err(|error| Failure::error(format!("{}: {error}", figure.name)))? else {
            return Ok(Outcome::Interrupted);
        };
        let path = args.output.join(format!("{}.png", figure.name));
        super::announce(&path, args.quiet);
        let bytes = deliver(&path, &made)?;
        if !args.quiet {
            let time = duration(start.elapsed().as_secs_f64());
            println!("{:15} {time:>10}  {:>7}  {}", figure.name, size(bytes), exposures(&figure, &made));
        }
    }
    if !args.quiet {
        let all = duration(begin.elapsed().as_secs_f64());
        println!("{:15} {all:>10}  on {} threads, in {}", "all", pool.current_num_threads(), args.output.display());
    }
    Ok(Outcome::Done)
}

/// The figures of these names, all if there are none.
fn wanted(names: &[String]) -> Result<Vec<Figure>, Failure> {
    let all = figures();
    if names.is_empty() {
        return Ok(all);
    }
    let named = |name: &String| {
        let found = all.iter().find(|figure| figure.name == name || figure.thesis == Some(name));
        found.cloned().ok_or_else(|| super::unknown("figure", name, all.iter().map(|figure| figure.name)))
    };
    names.iter().map(named).collect()
}

fn counterpart(figure: &Figure) -> String {
    figure.thesis.map_or(String::new(), |number| format!(" (figure {number} of the thesis)"))
}

fn deliver(path: &Path, made: &Made) -> Result<usize, Failure> {
    let bytes = png::file(made.size, &made.pixels).map_err(Failure::error)?;
    super::write(path, &bytes)?;
    Ok(bytes.len())
}

/// What the pictures were exposed for, and what their tables state.
fn exposures(figure: &Figure, made: &Made) -> String {
    let step = match figure.exposure {
        Exposure::Figure => made.exposures_ev.len().max(1),
        Exposure::Row => figure.columns,
        Exposure::Panel => 1,
    };
    let exposures: Vec<String> = made.exposures_ev.iter().step_by(step).map(|ev| format!("{ev:.1}")).collect();
    format!("EV {}; tables off by {} at most", exposures.join(", "), percent(made.table_error))
}
