//! `airlight study`.

use super::args::{StudyArgs, StudyName};
use super::output::println;
use super::progress::{Line, duration};
use super::{Failure, Outcome};
use crate::data::Data;
use crate::study;

pub(super) fn run(args: &StudyArgs) -> Result<Outcome, Failure> {
    let path = args.output.clone().unwrap_or_else(|| format!("plots/airlight-{}.csv", args.what.as_str()).into());
    tables::file::check_writable(&path).map_err(|e| super::unwritable(&path, &e))?;
    let data = Data::load(&args.data).map_err(Failure::error)?;
    let line = Line::new(args.quiet);
    let progress = |share: f64| line.show(share, |_| args.what.as_str().to_owned());
    let pool = super::pool(args.threads)?;
    let chart = pool
        .install(|| match args.what {
            StudyName::Columns => study::columns::make(&data, &progress),
            StudyName::SolvedSuns => study::solved::suns(&data, &progress),
            StudyName::SolvedGrids => study::solved::grids(&data, &progress),
        })
        .map_err(Failure::error)?;
    line.clear();
    tables::file::replace(&path, chart.csv().as_bytes()).map_err(|e| super::unwritable(&path, &e))?;
    if !args.quiet {
        let mut panel = "";
        for point in &chart.points {
            if point.panel != panel {
                println!("{}", point.panel);
                panel = point.panel;
            }
            println!("  {:<45} {} {:.3}  {:.1e}", point.curve, chart.axes[0], point.at[0], point.at[1]);
        }
        println!("time        {} on {} threads", duration(line.elapsed().as_secs_f64()), pool.current_num_threads());
        println!("written     {}", path.display());
    }
    Ok(Outcome::Done)
}
