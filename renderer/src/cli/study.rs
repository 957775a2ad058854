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
type MakeChart = fn(&Data, &(dyn Fn(f64) + Sync)) -> Result<Chart, RenderError>;

/// Makes whatever a study makes.
type Make = Box<dyn Fn(&Data, &(dyn Fn(f64) + Sync)) -> Result<Made, RenderError> + Sync>;

pub(super) fn run(args: &StudyArgs) -> Result<Outcome, Failure> {
    if args.quick && !matches!(args.what, StudyName::Ladder | StudyName::Stability) {
        return Err(Failure::usage("--quick belongs to the ladder and to stability: leave it out"));
    }
    let pool = super::pool(args.threads)?;
    let (size, threads) = (if args.quick { Size::Quick } else { Size::Full }, pool.current_num_threads());
    let chart = |make: MakeChart| -> Make { Box::new(move |data, progress| make(data, progress).map(Made::from)) };
    let make: Make = match args.what {
        StudyName::Columns => chart(study::columns::make),
        StudyName::SolvedSuns => chart(study::solved::suns),
        StudyName::PolarisedSuns => chart(study::solved::polarised_suns),
        StudyName::SolvedGrids => chart(study::solved::grids),
        StudyName::NeutralPoints => chart(study::neutral_points::make),
        StudyName::Polarisation => Box::new(|data, progress| {
            let (chart, measured) = study::polarisation::make(data, progress)?;
            Ok(Made { measured: Some(measured.csv().into_bytes()), ..Made::from(chart) })
        }),
        StudyName::Ladder => Box::new(move |data, progress| {
            let ladder = study::ladder::make(data, size, threads, progress)?;
            Ok(Made { bytes: ladder.csv().into_bytes(), rows: ladder.summary(), measured: None })
        }),
        StudyName::Stability => Box::new(move |data, progress| {
            let maps = study::stability::make(data, size, progress)?;
            Ok(Made { bytes: maps.csv().into_bytes(), rows: maps.summary(), measured: None })
        }),
        StudyName::Strip => Box::new(|data, progress| {
            let strip = study::strip::make(data, progress)?;
            Ok(Made { bytes: png::file(strip.size, &strip.pixels)?, rows: of_strip(&strip), measured: None })
        }),
    };
    let ending = if matches!(args.what, StudyName::Strip) { "png" } else { "csv" };
    let path = args.output.clone().unwrap_or_else(|| format!("plots/airlight-{}.{ending}", args.what.as_str()).into());
    tables::file::check_writable(&path).map_err(|e| super::unwritable(&path, &e))?;
    if matches!(args.what, StudyName::Polarisation) {
        tables::file::check_writable(&args.measured).map_err(|e| super::unwritable(&args.measured, &e))?;
    }
    let data = Data::load(&args.data).map_err(Failure::error)?;
    let line = Line::new(args.quiet);
    let progress = |share: f64| line.show(share, |_| args.what.as_str().to_owned());
    let made = pool.install(|| make(&data, &progress)).map_err(Failure::error)?;
    line.clear();
    tables::file::replace(&path, &made.bytes).map_err(|e| super::unwritable(&path, &e))?;
    if let Some(measured) = &made.measured {
        tables::file::replace(&args.measured, measured).map_err(|e| super::unwritable(&args.measured, &e))?;
    }
    if !args.quiet {
        println!("{}", made.rows.join("\n"));
        println!("time        {} on {threads} threads", duration(line.elapsed().as_secs_f64()));
        println!("written     {}", path.display());
        if made.measured.is_some() {
            println!("            {} (build again to carry it)", args.measured.display());
        }
    }
    Ok(Outcome::Done)
}

/// What a study has made: its file, what it says, and measurements to store.
struct Made {
    bytes: Vec<u8>,
    rows: Vec<String>,
    measured: Option<Vec<u8>>,
}

impl From<Chart> for Made {
    fn from(chart: Chart) -> Self {
        Self { bytes: chart.csv().into_bytes(), rows: of_chart(&chart), measured: None }
    }
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
