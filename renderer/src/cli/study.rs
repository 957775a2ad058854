//! `airlight study`.

use super::args::{StudyArgs, StudyName};
use super::output::println;
use super::progress::{Line, duration};
use super::{Failure, Outcome};
use crate::data::Data;
use crate::film::png;
use crate::render::RenderError;
use crate::study::ladder::Size;
use crate::study::{self, Chart};

/// Makes a chart from the data; hears of progress.
type Make = fn(&Data, &(dyn Fn(f64) + Sync)) -> Result<Chart, RenderError>;

pub(super) fn run(args: &StudyArgs) -> Result<Outcome, Failure> {
    let make: Option<Make> = match args.what {
        StudyName::Columns => Some(study::columns::make),
        StudyName::SolvedSuns => Some(study::solved::suns),
        StudyName::SolvedGrids => Some(study::solved::grids),
        StudyName::Ladder | StudyName::Strip => None,
    };
    if args.quick && !matches!(args.what, StudyName::Ladder) {
        return Err(Failure::usage("--quick belongs to the ladder: leave it out"));
    }
    let ending = if matches!(args.what, StudyName::Strip) { "png" } else { "csv" };
    let path = args.output.clone().unwrap_or_else(|| format!("plots/airlight-{}.{ending}", args.what.as_str()).into());
    tables::file::check_writable(&path).map_err(|e| super::unwritable(&path, &e))?;
    let data = Data::load(&args.data).map_err(Failure::error)?;
    let line = Line::new(args.quiet);
    let progress = |share: f64| line.show(share, |_| args.what.as_str().to_owned());
    let pool = super::pool(args.threads)?;
    let (bytes, rows) = pool
        .install(|| match make {
            Some(make) => make(&data, &progress).map(|chart| (chart.csv().into_bytes(), of_chart(&chart))),
            None if matches!(args.what, StudyName::Ladder) => {
                let size = if args.quick { Size::Quick } else { Size::Full };
                let ladder = study::ladder::make(&data, size, pool.current_num_threads(), &progress)?;
                Ok((ladder.csv().into_bytes(), ladder.summary()))
            }
            None => study::strip::make(&data, &progress).and_then(|strip| {
                let bytes = png::file(strip.size, &strip.pixels)?;
                Ok((bytes, of_strip(&strip)))
            }),
        })
        .map_err(Failure::error)?;
    line.clear();
    tables::file::replace(&path, &bytes).map_err(|e| super::unwritable(&path, &e))?;
    if !args.quiet {
        println!("{}", rows.join("\n"));
        println!("time        {} on {} threads", duration(line.elapsed().as_secs_f64()), pool.current_num_threads());
        println!("written     {}", path.display());
    }
    Ok(Outcome::Done)
}

/// The points, under the names of their panels.
fn of_chart(chart: &Chart) -> Vec<String> {
    let (mut rows, mut panel) = (Vec::new(), "");
    for point in &chart.points {
        if point.panel != panel {
            panel = point.panel;
            rows.push(panel.to_owned());
        }
        rows.push(format!("  {:<45} {} {:.3}  {:.1e}", point.curve, chart.axes[0], point.at[0], point.at[1]));
    }
    rows
}

fn of_strip(strip: &study::strip::Strip) -> Vec<String> {
    let mut rows = vec![format!("tables      {:.3} s", strip.solve_seconds)];
    rows.extend(strip.skies.iter().map(|sky| {
        let (elevation, seconds, stated) = (sky.elevation_deg, sky.seconds, 100.0 * sky.table_error);
        format!(
            "  sun at {elevation:>5.1} degrees  {seconds:.3} s  EV {:.1}  tables off by {stated:.2} %",
            sky.exposure_ev
        )
    }));
    rows
}
