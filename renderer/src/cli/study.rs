//! `airlight study`.

use super::output::{eprintln, println};
use super::progress::{Line, duration};
use super::{Failure, Outcome};
use crate::data::Data;
use crate::film::png;
use crate::plan::{Evidence, Measured};
use crate::render::RenderError;
use crate::study::ladder::Size;
use crate::study::{self, Chart, plans};
use clap::{Args, ValueEnum};
use std::path::{Path, PathBuf};

/// Flags of `airlight study`.
#[derive(Debug, Args)]
pub(super) struct StudyArgs {
    /// What to study
    #[arg(value_name = "WHAT")]
    pub what: StudyName,
    /// Of the ladder 18 scenes and the main settings alone, in a minute or two; of stability fewer cells, in one or two; of plans and
    /// held-out the first ten atmospheres
    #[arg(long)]
    pub quick: bool,
    /// Go on with plans or held-out where the study was stopped: atmospheres that are in the file stay
    #[arg(long)]
    pub resume: bool,
    /// CSV to write, or PNG [default: plots/airlight-WHAT.csv, or .png]
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Where `polarisation`, `atlas`, `plans` and `held-out` store their measurements, which the program is built with
    /// [default: renderer/measured/WHAT.csv]
    #[arg(long, value_name = "FILE")]
    pub measured: Option<PathBuf>,
    /// Folder of the tables [default: those that the program carries]
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    /// Threads, 1 to 1024 [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum StudyName {
    /// Column tables: transmittance and single scattering against size, beside the maps of others
    Columns,
    /// Solved tables of clear air and the nine biomes: error over the sun's elevation, by certificates
    SolvedSuns,
    /// As solved-suns, by day, of polarised light: errors of I, Q and U relative to I
    PolarisedSuns,
    /// Solved tables: error against the time to solve, for grids, moments and orders
    SolvedGrids,
    /// A picture of four skies at one wavelength: error against cost of solved tables, of paths, and of Mitsuba 3 as it was measured
    Beside,
    /// Every method: error against cost over 60 scenes, from day to twilight, from the ground to space (eight minutes on two cores)
    Ladder,
    /// Where each method leaves its error bound: maps over sun and haze, altitude and view, asymmetry, radius, wavelength, steps, mappings
    Stability,
    /// Skies from one solution, the sun from 60 to -12 degrees, with the time of each: a strip of fisheyes (PNG)
    Strip,
    /// Where clear skies have no polarisation over the sun's elevation: the points of Arago, Babinet and Brewster
    NeutralPoints,
    /// What plans are made from: errors and costs of every rung on 1440 scenes (an hour and a half of a core; each atmosphere is stored when it is done)
    Plans,
    /// The same of 102 other scenes, by which plans are judged (7 core-minutes)
    HeldOut,
    /// How good plans are: those of the held-out scenes beside what is true, by what is stored
    Planner,
    /// What leaving out each part of the model changes, on thirty scenes (6 core-minutes)
    Atlas,
    /// How many wavelengths a colour takes, and what is best taken for the spectrum between them (one core-minute)
    Wavelengths,
    /// What leaving polarisation out costs over the sun's elevation, in clear air and the nine biomes: scalar beside polarised radiance
    Polarisation,
}

impl StudyName {
    pub(super) fn as_str(self) -> &'static str {
        match self {
            Self::Columns => "columns",
            Self::Beside => "beside",
            Self::Ladder => "ladder",
            Self::SolvedSuns => "solved-suns",
            Self::PolarisedSuns => "polarised-suns",
            Self::SolvedGrids => "solved-grids",
            Self::Stability => "stability",
            Self::Strip => "strip",
            Self::Plans => "plans",
            Self::HeldOut => "held-out",
            Self::Planner => "planner",
            Self::Atlas => "atlas",
            Self::NeutralPoints => "neutral-points",
            Self::Wavelengths => "wavelengths",
            Self::Polarisation => "polarisation",
        }
    }
}

/// Makes a chart from the data; hears of progress.
type MakeChart = fn(&Data, &(dyn Fn(f64) + Sync)) -> Result<Chart, RenderError>;

/// Makes whatever a study makes.
type Make = Box<dyn Fn(&Data, &(dyn Fn(f64) + Sync)) -> Result<Made, RenderError> + Sync>;

pub(super) fn run(args: &StudyArgs) -> Result<Outcome, Failure> {
    let has_quick =
        matches!(args.what, StudyName::Ladder | StudyName::Stability | StudyName::Plans | StudyName::HeldOut);
    if args.quick && !has_quick {
        return Err(Failure::usage("--quick belongs to ladder, stability, plans and held-out: leave it out"));
    }
    if args.resume && !matches!(args.what, StudyName::Plans | StudyName::HeldOut) {
        return Err(Failure::usage("--resume belongs to plans and held-out: leave it out"));
    }
    let pool = super::pool(args.threads)?;
    let measured = measured(args);
    match args.what {
        StudyName::Plans => return measure_plans(args, plans::Set::Measured, &measured, pool.current_num_threads()),
        StudyName::HeldOut => return measure_plans(args, plans::Set::HeldOut, &measured, pool.current_num_threads()),
        _ => {}
    }
    let (size, threads) = (if args.quick { Size::Quick } else { Size::Full }, pool.current_num_threads());
    let chart = |make: MakeChart| -> Make { Box::new(move |data, progress| make(data, progress).map(Made::from)) };
    let make: Make = match args.what {
        StudyName::Columns => chart(study::columns::make),
        StudyName::Beside => chart(study::beside::make),
        StudyName::SolvedSuns => chart(study::solved::suns),
        StudyName::PolarisedSuns => chart(study::solved::polarised_suns),
        StudyName::SolvedGrids => chart(study::solved::grids),
        StudyName::NeutralPoints => chart(study::neutral_points::make),
        StudyName::Wavelengths => chart(study::wavelengths::make),
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
        StudyName::Planner => Box::new(|_, _| {
            let (rows, chart) = judged().map_err(RenderError::Measured)?;
            Ok(Made { rows, ..Made::from(chart) })
        }),
        StudyName::Atlas => Box::new(|data, progress| {
            let atlas = study::atlas::make(data, progress)?;
            let bytes = atlas.csv().into_bytes();
            Ok(Made { rows: study::atlas::summary(&atlas), measured: Some(bytes.clone()), bytes })
        }),
        // Measured above.
        StudyName::Plans | StudyName::HeldOut => return Ok(Outcome::Done),
        StudyName::Strip => Box::new(|data, progress| {
            let strip = study::strip::make(data, progress)?;
            Ok(Made { bytes: png::file(strip.size, &strip.pixels)?, rows: of_strip(&strip), measured: None })
        }),
    };
    let ending = if matches!(args.what, StudyName::Strip) { "png" } else { "csv" };
    let path = args.output.clone().unwrap_or_else(|| format!("plots/airlight-{}.{ending}", args.what.as_str()).into());
    tables::file::check_writable(&path).map_err(|e| super::unwritable(&path, &e))?;
    if matches!(args.what, StudyName::Polarisation | StudyName::Atlas) {
        tables::file::check_writable(&measured).map_err(|e| super::unwritable(&measured, &e))?;
    }
    let data = super::data(args.data.as_deref())?;
    let line = Line::new(args.quiet);
    let progress = |share: f64| line.show(share, |_| args.what.as_str().to_owned());
    let made = pool.install(|| make(&data, &progress)).map_err(Failure::error)?;
    line.clear();
    super::announce(&path, args.quiet);
    super::write(&path, &made.bytes)?;
    if let Some(bytes) = &made.measured {
        super::announce(&measured, args.quiet);
        super::write(&measured, bytes)?;
    }
    if !args.quiet {
        println!("{}", made.rows.join("\n"));
        println!("time        {} on {threads} threads", duration(line.elapsed().as_secs_f64()));
        println!("written     {}", path.display());
        if made.measured.is_some() {
            println!("            {} (build again to carry it)", measured.display());
        }
    }
    Ok(Outcome::Done)
}

/// Where measurements go.
fn measured(args: &StudyArgs) -> PathBuf {
    args.measured.clone().unwrap_or_else(|| format!("renderer/measured/{}.csv", args.what.as_str()).into())
}

/// Plans judged by the scenes kept apart, both as stored.
fn judged() -> Result<(Vec<String>, Chart), String> {
    let held_out = Measured::held_out()?;
    if held_out.rows.is_empty() {
        return Err("no scenes are kept apart: run airlight study held-out, and build again".into());
    }
    Ok(plans::judge(&Evidence::new(&Measured::stored()?)?, &held_out))
}

/// Measures what plans are made from or judged by, and stores it after each atmosphere.
fn measure_plans(args: &StudyArgs, set: plans::Set, path: &Path, threads: usize) -> Result<Outcome, Failure> {
    const QUICK: usize = 10;
    tables::file::check_writable(path).map_err(|e| super::unwritable(path, &e))?;
    super::announce(path, args.quiet);
    let data = super::data(args.data.as_deref())?;
    let line = Line::new(args.quiet);
    let atmospheres = if args.quick { QUICK } else { set.size().0 };
    let progress = |share: f64| line.show(share, |_| args.what.as_str().to_owned());
    let keep = |measured: &Measured| {
        // What is measured in the end counts.
        if let Err(error) = tables::file::replace(path, measured.csv().as_bytes()) {
            eprintln!("airlight: {}: cannot be written, the study goes on: {error}", path.display());
        }
    };
    // A study that was stopped goes on.
    let known = std::fs::read_to_string(path).ok().filter(|_| args.resume).map(|csv| Measured::parse(&csv));
    let known = known.transpose().map_err(|error| Failure::error(format!("{}: {error}", path.display())))?;
    let known = known.unwrap_or_default();
    let found = plans::measure(&data, (set, atmospheres, known), threads, &progress, &keep).map_err(Failure::error)?;
    line.clear();
    super::write(path, found.csv().as_bytes())?;
    if !args.quiet {
        println!("{} scenes of {atmospheres} atmospheres", found.rows.len());
        println!("time        {} on {threads} threads", duration(line.elapsed().as_secs_f64()));
        println!("written     {} (build again to carry it)", path.display());
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
