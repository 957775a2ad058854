//! `airlight bench`.

use super::args::{BenchArgs, BenchName};
use super::output::println;
use super::{Failure, Outcome};
use crate::bench;
use std::time::Instant;

pub(super) fn run(args: &BenchArgs) -> Result<Outcome, Failure> {
    let BenchName::Anchors = args.what;
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
