//! `airlight bench`.

use super::args::{BenchArgs, BenchName};
use super::output::println;
use super::{Failure, Outcome};
use crate::bench;
use crate::data::Data;
use crate::scene::SceneError;
use std::time::Instant;
use tables::views::Biome;

pub(super) fn run(args: &BenchArgs) -> Result<Outcome, Failure> {
    match args.what {
        BenchName::Anchors => anchors(args),
        BenchName::Solved => solved(args),
    }
}

/// Zenith angles of the sun in degrees beside which solved tables are put.
const SUNS: [f64; 5] = [60.0, 85.0, 90.0, 92.0, 95.0];

fn solved(args: &BenchArgs) -> Result<Outcome, Failure> {
    let data = Data::load(&args.data).map_err(Failure::error)?;
    let all = std::iter::once(None).chain(Biome::ALL.into_iter().map(Some));
    let name = |biome: Option<Biome>| biome.map_or("none", Biome::name);
    let asked: Vec<_> = all.filter(|&biome| args.biome == "all" || args.biome == name(biome)).collect();
    if asked.is_empty() {
        return Err(Failure::error(SceneError::Refused(format!(
            "no biome {:?}: one of them, none or all",
            args.biome
        ))));
    }
    println!(
        "16 wavelengths, {} threads; beside {} paths in each of 54 directions",
        rayon::current_num_threads(),
        args.paths
    );
    for biome in asked {
        let report = bench::solved::measure(&data, biome, &SUNS, args.paths).map_err(Failure::error)?;
        println!(
            "{}: solved in {:.2} s ({:.2} s with a coarser one), {} orders, {:.1} MB; a picture of 320 x 320 {:.2} core-s",
            name(biome),
            report.seconds[0],
            report.seconds[1],
            report.size.0,
            report.size.1 as f64 / 1e6,
            report.picture_seconds
        );
        for sun in report.suns {
            println!(
                "  sun zenith {:>2}  rms {:.3} % (noise {:.3} %), mean {:+.3} %, worst direction {:+.2} %; states {:.3} %",
                sun.sun_zenith_deg,
                100.0 * sun.rms,
                100.0 * sun.noise,
                100.0 * sun.mean,
                100.0 * sun.worst,
                100.0 * sun.stated
            );
        }
    }
    Ok(Outcome::Done)
}

fn anchors(args: &BenchArgs) -> Result<Outcome, Failure> {
    println!("one thread, one wavelength; a picture is {} independent pixels of the sky at 1 % rms", bench::PIXELS);
    for case in bench::cases() {
        let medium = case.medium().map_err(Failure::error)?;
        let start = Instant::now();
        let columns = bench::columns(&medium);
        println!(
            "{} sun zenith {} degrees; tables in {:.3} s, {:.1} MB",
            case.name,
            case.sun_zenith_deg,
            start.elapsed().as_secs_f64(),
            columns.bytes() as f64 / 1e6
        );
        let (mut total, mut count) = (0.0, 0.0);
        for &view in case.views {
            let cost = bench::measure(&case, (&medium, &columns), args.method.into(), view, args.seconds);
            let (radiance, error) = cost.radiance;
            println!(
                "  view zenith {:>2}, azimuth {:>3}  radiance {radiance:.5e} +- {:.3} %  sd of a path {:6.3}  {:6.3} us \
                 a path  {:7.0} paths, {:.3e} s to 1 %",
                view.0,
                view.1,
                100.0 * error / radiance,
                cost.deviation,
                1e6 * cost.seconds_per_path,
                cost.paths_to_1_percent,
                cost.seconds_to_1_percent()
            );
            total += cost.seconds_to_1_percent();
            count += 1.0;
        }
        println!("  picture {:.3e} core-seconds", bench::PIXELS * total / count);
    }
    Ok(Outcome::Done)
}
