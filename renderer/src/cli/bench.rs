//! `airlight bench`.

use super::output::println;
use super::{Failure, Outcome};
use crate::atmosphere::{Columns, Medium};
use crate::bench;
use crate::sampling::POINTS;
use crate::scene::SceneError;
use crate::transport::Estimator;
use crate::vectors::{Vectors, take_at_most};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use std::path::PathBuf;
use std::time::Instant;
use tables::views::Biome;

/// Flags of `airlight bench`.
#[derive(Debug, Args)]
pub(super) struct BenchArgs {
    /// What to measure
    #[arg(value_name = "WHAT")]
    pub what: BenchName,
    /// Estimator of the anchors [default: paths and certified]
    #[arg(long, value_name = "METHOD")]
    pub method: Option<BenchMethod>,
    /// Paths in each direction beside solved tables, or of polarised and of scalar transfer
    #[arg(long, value_name = "N", default_value_t = 8192)]
    pub paths: u64,
    /// Folder of the tables [default: those that the program carries]
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    /// Biomes beside which solved tables are put, or in which polarised transfer or certificates are measured: one, none or all
    #[arg(long, value_name = "NAME", default_value = "all")]
    pub biome: String,
    /// Least time for each direction in seconds
    #[arg(long, value_name = "S", default_value_t = 1.0)]
    pub seconds: f64,
    /// Widest vectors that are taken (of x86-64)
    #[arg(long, value_name = "KIND", default_value = "widest")]
    pub vectors: VectorsName,
    /// Write what was measured as JSON, a row for each line
    #[arg(long)]
    pub json: bool,
}

/// What is measured: words as soon as it is known, or rows of JSON in the end.
struct Told {
    rows: Option<Vec<Value>>,
}

impl Told {
    fn new(args: &BenchArgs) -> Self {
        Self { rows: args.json.then(Vec::new) }
    }

    /// A heading, for people alone.
    fn head(&self, words: &str) {
        if self.rows.is_none() {
            println!("{words}");
        }
    }

    fn row(&mut self, row: Value, words: impl FnOnce()) {
        match &mut self.rows {
            Some(rows) => rows.push(row),
            None => words(),
        }
    }

    fn done(self) -> Result<Outcome, Failure> {
        if let Some(rows) = self.rows {
            println!("{}", serde_json::to_string_pretty(&rows).map_err(Failure::error)?);
        }
        Ok(Outcome::Done)
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum VectorsName {
    /// 128 bits: what every processor has
    Plain,
    /// 256 bits
    Avx2,
    /// What this processor has
    Widest,
}

impl From<VectorsName> for Vectors {
    fn from(name: VectorsName) -> Self {
        match name {
            VectorsName::Plain => Self::Plain,
            VectorsName::Avx2 => Self::Avx2,
            VectorsName::Widest => Self::Widest,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum BenchMethod {
    /// Paths on column tables
    Paths,
    /// The brute-force judge
    Judge,
    /// Certificates: fans of rays that end in a solved table, unbiased
    Certified,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum BenchName {
    /// Four skies (450, 680 and 550 nm by day, 450 nm in twilight)
    Anchors,
    /// Solved tables of clear air and of every biome beside the path tracer
    Solved,
    /// Polarised beside scalar transfer in clear air and in every biome
    Polarised,
    /// Certificates of polarised light beside those of radiance alone in clear air and in every biome
    Certificates,
}

pub(super) fn run(args: &BenchArgs) -> Result<Outcome, Failure> {
    take_at_most(args.vectors.into());
    match args.what {
        BenchName::Anchors => anchors(args),
        BenchName::Solved => solved(args),
        BenchName::Polarised => polarised(args),
        BenchName::Certificates => certificates(args),
    }
}

/// The biomes that are asked for; `None` is clear air.
fn biomes(args: &BenchArgs) -> Result<Vec<Option<Biome>>, Failure> {
    let all = std::iter::once(None).chain(Biome::ALL.into_iter().map(Some));
    let asked: Vec<_> = all.filter(|&biome| args.biome == "all" || args.biome == name(biome)).collect();
    if asked.is_empty() {
        return Err(Failure::error(SceneError::Refused(format!(
            "no biome {:?}: one of them, none or all",
            args.biome
        ))));
    }
    Ok(asked)
}

fn name(biome: Option<Biome>) -> &'static str {
    biome.map_or("none", Biome::name)
}

/// Wavelengths in nm of polarised transfer: one, and sixteen over what is seen.
const ONE: [f64; 1] = [450.0];

fn polarised(args: &BenchArgs) -> Result<Outcome, Failure> {
    let data = super::data(args.data.as_deref())?;
    let points = u32::try_from(args.paths / 32).unwrap_or(u32::MAX).clamp(1, POINTS as u32);
    let mut told = Told::new(args);
    told.head("one thread; noise as variance, at equal paths");
    let pool = super::pool(Some(1))?;
    for biome in biomes(args)? {
        let one = bench::medium(&data, biome, &ONE).map_err(Failure::error)?;
        let many = bench::medium(&data, biome, &bench::visible::<16>()).map_err(Failure::error)?;
        told.head(name(biome));
        let tables = (bench::polarised::solve(&one), bench::polarised::solve(&many));
        let tables = (tables.0.map_err(Failure::error)?, tables.1.map_err(Failure::error)?);
        for sun in [30.0, 60.0, 85.0, 92.0] {
            let one = pool.install(|| bench::polarised::measure(&one, &tables.0, sun, points));
            let row = |wavelengths: &str, report| row_polarised(name(biome), sun, wavelengths, report);
            told.row(row("450 nm", &one), || print_polarised(sun, "at 450 nm", &one));
            let many = pool.install(|| bench::polarised::measure(&many, &tables.1, sun, points));
            told.row(row("16", &many), || print_polarised(sun, "at 16 wavelengths", &many));
        }
    }
    told.done()
}

fn row_polarised(biome: &str, sun: f64, wavelengths: &str, report: &bench::polarised::Report) -> Value {
    let [scalar, i, qu] = report.variance;
    json!({
        "biome": biome,
        "sun_zenith_deg": sun,
        "wavelengths": wavelengths,
        "scalar_path_s": report.seconds[0],
        "polarised_path_s": report.seconds[1],
        "noise_i_over_scalar": i / scalar,
        "noise_qu_over_scalar": qu / scalar,
        "cost_over_scalar": report.cost(),
        "degree": report.degree,
        "scalar_off_least": report.scalar.0,
        "scalar_off_most": report.scalar.1,
        "solved_off_i": report.solved[0].sqrt(),
        "solved_off_qu": report.solved[1].sqrt(),
    })
}

fn print_polarised(sun: f64, wavelengths: &str, report: &bench::polarised::Report) {
    let [scalar, i, qu] = report.variance;
    println!(
        "  sun zenith {sun:>2} {wavelengths:17}  {:6.2} us a path for {:6.2}  noise of I {:.2} times, of Q and U {:.2} times  cost {:.2} times  \
         polarised {:4.1} %  scalar {:+.1} to {:+.1} %",
        1e6 * report.seconds[1],
        1e6 * report.seconds[0],
        i / scalar,
        qu / scalar,
        report.cost(),
        100.0 * report.degree,
        100.0 * report.scalar.0,
        100.0 * report.scalar.1
    );
    let percent = |squares: [f64; 2]| squares.map(|square| 100.0 * square.sqrt());
    let ([off_i, off_qu], [noise_i, noise_qu]) = (percent(report.solved), percent(report.noise()));
    println!(
        "                solved table off (rms, of I) by {off_i:.2} % in I, {off_qu:.2} % in Q and U; noise of the paths {noise_i:.2} and {noise_qu:.2} %"
    );
}

/// Elevations of the sun in degrees at which certificates are measured.
const ELEVATIONS: [f64; 4] = [60.0, 10.0, -2.0, -5.0];

fn certificates(args: &BenchArgs) -> Result<Outcome, Failure> {
    let data = super::data(args.data.as_deref())?;
    let mut told = Told::new(args);
    told.head(
        "one thread, 8 wavelengths; costs of equal errors relative to I over those of certificates of radiance alone",
    );
    let pool = super::pool(Some(1))?;
    for biome in biomes(args)? {
        let measure = || bench::certificates::measure(&data, biome, &ELEVATIONS);
        for report in pool.install(measure).map_err(Failure::error)? {
            let ([scalar, polarised], [cost_i, cost_q, cost_u]) = (report.seconds.map(|s| 1e6 * s), report.cost());
            let [radiance, i, q, u] = report.noise.map(|noise| 100.0 * noise.sqrt());
            let row = json!({
                "biome": name(biome),
                "sun_elevation_deg": report.elevation_deg,
                "scalar_fan_s": report.seconds[0],
                "polarised_fan_s": report.seconds[1],
                "noise_scalar": report.noise[0].sqrt(),
                "noise_iqu": report.noise[1..].iter().map(|noise| noise.sqrt()).collect::<Vec<f64>>(),
                "cost_iqu_over_scalar": [cost_i, cost_q, cost_u],
            });
            told.row(row, || {
                println!(
                    "{}: sun at {:>3} degrees  {polarised:4.0} us a fan for {scalar:4.0}  noise of one {i:.2} % of I, {q:.2} of Q, \
                     {u:.2} of U for {radiance:.2} %  cost {cost_i:.2} for I, {cost_q:.2} for Q, {cost_u:.2} for U",
                    name(biome),
                    report.elevation_deg
                );
            });
        }
    }
    told.done()
}

/// Zenith angles of the sun in degrees beside which solved tables are put.
const SUNS: [f64; 5] = [60.0, 85.0, 90.0, 92.0, 95.0];

fn solved(args: &BenchArgs) -> Result<Outcome, Failure> {
    let data = super::data(args.data.as_deref())?;
    let mut told = Told::new(args);
    told.head(&format!(
        "16 wavelengths, {} threads; beside {} paths in each of 54 directions",
        rayon::current_num_threads(),
        args.paths
    ));
    for biome in biomes(args)? {
        let report = bench::solved::measure(&data, biome, &SUNS, args.paths).map_err(Failure::error)?;
        let row = json!({
            "biome": name(biome),
            "solve_s": report.seconds[0],
            "coarser_s": report.seconds[1],
            "orders": report.size.0,
            "size_bytes": report.size.1,
            "domes_per_s": report.domes_per_second,
        });
        told.row(row, || {
            println!(
                "{}: solved in {:.2} s ({:.2} s of it for the coarser table), {} orders, {:.1} MB; {:.0} domes of 160 x 32 a second",
                name(biome),
                report.seconds[0],
                report.seconds[1],
                report.size.0,
                report.size.1 as f64 / 1e6,
                report.domes_per_second
            );
        });
        for sun in report.suns {
            let row = json!({
                "biome": name(biome),
                "sun_zenith_deg": sun.sun_zenith_deg,
                "rms": sun.rms,
                "noise": sun.noise,
                "mean": sun.mean,
                "worst": sun.worst,
                "stated": sun.stated,
                "picture_320_core_s": sun.picture.seconds,
                "looks": sun.picture.looks,
                "picture_off_rms": sun.picture.off[0],
                "picture_off_worst": sun.picture.off[1],
            });
            told.row(row, || {
                println!(
                    "  sun zenith {:>2}  rms {:.3} % (noise {:.3} %), mean {:+.3} %, worst direction {:+.2} %; states {:.3} %; a picture of 320 x 320 {:.2} core-s \
                     ({} looks, {:.4} % off those of each pixel, at most {:.2} %)",
                    sun.sun_zenith_deg,
                    100.0 * sun.rms,
                    100.0 * sun.noise,
                    100.0 * sun.mean,
                    100.0 * sun.worst,
                    100.0 * sun.stated,
                    sun.picture.seconds,
                    sun.picture.looks,
                    100.0 * sun.picture.off[0],
                    100.0 * sun.picture.off[1]
                );
            });
        }
    }
    told.done()
}

fn anchors(args: &BenchArgs) -> Result<Outcome, Failure> {
    let mut told = Told::new(args);
    told.head(&format!(
        "one thread, one wavelength; a picture is {} independent pixels of the sky at 1 % rms",
        bench::PIXELS
    ));
    let pool = super::pool(Some(1))?;
    let methods = args.method.map_or(vec![BenchMethod::Paths, BenchMethod::Certified], |method| vec![method]);
    for case in bench::cases() {
        let medium = case.medium().map_err(Failure::error)?;
        let start = Instant::now();
        let columns = pool.install(|| bench::columns(&medium));
        told.head(&format!(
            "{} sun zenith {} degrees; columns in {:.3} s, {:.1} MB",
            case.name,
            case.sun_zenith_deg,
            start.elapsed().as_secs_f64(),
            columns.bytes() as f64 / 1e6
        ));
        for &method in &methods {
            let estimator = match method {
                BenchMethod::Paths => Estimator::Paths,
                BenchMethod::Judge => Estimator::Judge,
                BenchMethod::Certified => {
                    pool.install(|| certified(&case, (&medium, &columns), args.seconds, &mut told))?;
                    continue;
                }
            };
            let method = if estimator == Estimator::Paths { "paths" } else { "judge" };
            told.head(&format!("  {method}"));
            let costs = case.views.iter().map(|&view| {
                let cost = bench::measure(&case, (&medium, &columns), estimator, view, args.seconds);
                told.row(row_of_cost(&case, &cost, method), || print_cost(&cost, "path"));
                cost.seconds_to_1_percent()
            });
            let total: f64 = costs.sum();
            told.head(&format!("    picture {:.3e} core-seconds", bench::PIXELS * total / case.views.len() as f64));
        }
    }
    told.done()
}

fn row_of_cost(case: &bench::Case, cost: &bench::Cost, method: &str) -> Value {
    json!({
        "case": case.name,
        "sun_zenith_deg": case.sun_zenith_deg,
        "method": method,
        "view_zenith_deg": cost.view.0,
        "view_azimuth_deg": cost.view.1,
        "radiance": cost.radiance.0,
        "radiance_standard_error": cost.radiance.1,
        "deviation_of_one": cost.deviation,
        "each_s": cost.seconds_per_path,
        "paths_to_1_percent": cost.paths_to_1_percent,
        "to_1_percent_s": cost.seconds_to_1_percent(),
    })
}

fn print_cost(cost: &bench::Cost, unit: &str) {
    let (radiance, error) = cost.radiance;
    println!(
        "    view zenith {:>2}, azimuth {:>3}  radiance {radiance:.5e} +- {:.3} %  sd of a {unit} {:6.3}  {:7.3} us each, {:7.0} \
         for 1 %: {:.3e} s",
        cost.view.0,
        cost.view.1,
        100.0 * error / radiance,
        cost.deviation,
        1e6 * cost.seconds_per_path,
        cost.paths_to_1_percent,
        cost.seconds_to_1_percent()
    );
}

fn certified(
    case: &bench::Case,
    (medium, columns): (&Medium<1>, &Columns<1>),
    seconds: f64,
    told: &mut Told,
) -> Result<(), Failure> {
    let start = Instant::now();
    let solved = bench::solve(medium).map_err(Failure::error)?;
    let table = start.elapsed().as_secs_f64();
    let certificate = bench::certificate(case, &solved, columns);
    let before = start.elapsed().as_secs_f64();
    told.head(&format!("  certified; table in {table:.3} s, guide in {:.3} s", before - table));
    let costs = case.views.iter().map(|&view| {
        let cost = bench::measure_certified(&certificate, view, seconds);
        told.row(row_of_cost(case, &cost, "certified"), || print_cost(&cost, "fan"));
        cost.seconds_to_1_percent()
    });
    let total: f64 = costs.sum();
    let picture = bench::PIXELS * total / case.views.len() as f64;
    told.head(&format!("    picture {:.3e} core-seconds, table and guide included", before + picture));
    Ok(())
}
