//! The fitted skies beside the scans: errors by scan, wavelength and direction.

use super::scans::{Scan, masked};
use super::{BRUNETON_NM, NM, factors, irradiance};
use crate::judge::{percent, spread};
use crate::{Context, Section, ValidationError, Verdict};
use renderer::study::{Chart, Point};
use tables::views::Biome;

/// Model and measurement of a scan's directions in the bands that are not left out: index of the band, both.
pub(super) type Pairs = Vec<(usize, Vec<(f64, f64)>)>;

/// The fitted sky beside each scan of a day.
pub(super) fn compare(
    context: &Context<'_>,
    scans: &[&Scan],
    air: (Biome, f64, f64),
    bands: &[f64],
) -> Result<Vec<(String, Pairs)>, ValidationError> {
    let (first, last, count) = NM;
    let step = (last - first) / (count - 1) as f64;
    let nm: Vec<f64> = (0..count).map(|i| first + step * i as f64).collect();
    let sun = irradiance(context, scans.first().map_or(1.0, |scan| scan.sun.distance_au), bands)?;
    let seen = factors(context, scans, air, &nm, false)?;
    let mut all = Vec::new();
    for (scan, seen) in scans.iter().zip(seen) {
        let mut pairs = Pairs::new();
        for (band, &at) in bands.iter().enumerate().filter(|(_, at)| !masked(**at) && **at <= last) {
            let node = (((at - first) / step) as usize).min(count - 2);
            let share = (at - nm[node]) / step;
            // Lines of the logarithms: f is a power of the wavelength but for ozone.
            let between = |f: &[f64]| (f[node].ln() + share * (f[node + 1].ln() - f[node].ln())).exp();
            let of = scan.looks.iter().zip(&seen).map(|(look, f)| (between(f) * sun[band], look.radiance[band]));
            pairs.push((band, of.collect()));
        }
        all.push((scan.time.clone(), pairs));
    }
    Ok(all)
}

/// Root mean square of the differences in mW m^-2 sr^-1 nm^-1 over directions and wavelengths up to 720 nm, as Bruneton 2017 has it.
fn bruneton(pairs: &Pairs, bands: &[f64], keep: impl Fn(usize) -> bool) -> f64 {
    let within = pairs.iter().filter(|(band, _)| bands[*band] <= BRUNETON_NM);
    let all =
        within.flat_map(|(_, of)| of.iter().enumerate().filter(|(i, _)| keep(*i)).map(|(_, (a, b))| 1e3 * (a - b)));
    spread(all).2
}

pub(super) fn report(section: &mut Section, scans: &[Scan], bands: &[f64], errors: &[(String, Pairs)], fits: &str) {
    let far = |k: usize, i: usize| scans[k].far(&scans[k].looks[i]);
    let relative = |k: usize, pairs: &Pairs| -> Vec<f64> {
        let all = pairs.iter().flat_map(|(_, of)| of.iter().enumerate());
        all.filter(|(i, _)| far(k, *i)).map(|(_, (model, measured))| model / measured - 1.0).collect()
    };
    let (mut rows, mut sums) = (Vec::new(), [0.0; 2]);
    for (k, (_, pairs)) in errors.iter().enumerate() {
        let (count, bias, rms, worst) = spread(relative(k, pairs));
        let all = bruneton(pairs, bands, |_| true);
        let without = bruneton(pairs, bands, |i| far(k, i));
        sums = [sums[0] + all * all, sums[1] + without * without];
        let near = scans[k].looks.iter().map(|look| scans[k].off_sun_deg(look)).fold(f64::INFINITY, f64::min);
        rows.push(vec![
            scans[k].name(),
            format!("{:.1}", 90.0 - scans[k].sun.elevation_deg),
            format!("{near:.1}"),
            count.to_string(),
            percent(bias, 1),
            format!("{:.1}", 100.0 * rms),
            percent(worst, 0),
            format!("{without:.1}"),
            format!("{all:.1}"),
        ]);
    }
    section.say("### Errors of the fitted skies");
    section.table(
        &[
            "scan",
            "sun's zenith angle",
            "nearest direction to the sun / degrees",
            "values",
            "bias %",
            "rms %",
            "worst %",
            "rms / mW m^-2 sr^-1 nm^-1",
            "all directions",
        ],
        &rows,
    );
    let n = errors.len().max(1) as f64;
    let total = sums.map(|sum| (sum / n).sqrt());
    section.say(&format!(
        "Summed as Bruneton 2017 does, 360 to {BRUNETON_NM} nm: {:.1} mW m^-2 sr^-1 nm^-1 over all scans ({:.1} with the directions near the sun). His \
         figures for eight models and libRadtran stand in the paper's figures for single scans of one of these days, with other wavelengths and an aerosol fitted \
         otherwise; they are not repeated here.",
        total[1], total[0]
    ));
    by_wavelength(section, scans, bands, errors);
    by_direction(section, scans, errors);
    let all: Vec<f64> = errors.iter().enumerate().flat_map(|(k, (_, pairs))| relative(k, pairs)).collect();
    let (count, bias, rms, _) = spread(all);
    section.find(
        "measured skies, 360 to 880 nm",
        format!(
            "{count} values: bias {} %, rms {:.1} %; {:.1} mW m^-2 sr^-1 nm^-1 summed as Bruneton 2017 does ({fits})",
            percent(bias, 1),
            100.0 * rms,
            total[1]
        ),
        "Kider et al. 2014, fitted",
        Verdict::Unstated,
    );
}

fn by_wavelength(section: &mut Section, scans: &[Scan], bands: &[f64], errors: &[(String, Pairs)]) {
    let mut points = Vec::new();
    let mut rows = Vec::new();
    for (band, &nm) in bands.iter().enumerate() {
        let mut all = Vec::new();
        for (k, (_, pairs)) in errors.iter().enumerate() {
            let Some((_, of)) = pairs.iter().find(|(b, _)| *b == band) else { continue };
            let here: Vec<f64> =
                (0..of.len()).filter(|&i| scans[k].far(&scans[k].looks[i])).map(|i| of[i].0 / of[i].1 - 1.0).collect();
            let (_, bias, rms, _) = spread(here.iter().copied());
            let curve = scans[k].name();
            points.push(Point { panel: "mean over directions", curve: curve.clone(), at: [nm, 100.0 * bias] });
            points.push(Point { panel: "rms over directions", curve, at: [nm, 100.0 * rms] });
            all.extend(here);
        }
        if !all.is_empty() && nm % 40.0 == 0.0 {
            let (count, bias, rms, worst) = spread(all);
            rows.push(vec![
                format!("{nm}"),
                count.to_string(),
                percent(bias, 1),
                format!("{:.1}", 100.0 * rms),
                percent(worst, 0),
            ]);
        }
    }
    points.sort_by_key(|point| point.panel);
    section.say(
        "By wavelength, all scans (every band is in the chart). The albedo is one for all wavelengths, while plants reflect several times as much beyond 700 nm.",
    );
    section.table(&["wavelength / nm", "values", "bias %", "rms %", "worst %"], &rows);
    let title = "Measured skies: relative differences by wavelength".into();
    section.chart("skies-wavelength", Chart { title, axes: ["wavelength / nm", "model less measured / %"], points });
}

/// Bands of the angle from the sun and of the elevation, in degrees.
const FROM_SUN: [(f64, f64); 6] =
    [(5.0, 15.0), (15.0, 30.0), (30.0, 60.0), (60.0, 90.0), (90.0, 120.0), (120.0, 180.0)];
const ELEVATIONS: [(f64, f64); 4] = [(0.0, 20.0), (20.0, 40.0), (40.0, 60.0), (60.0, 90.1)];

fn by_direction(section: &mut Section, scans: &[Scan], errors: &[(String, Pairs)]) {
    // Of each direction the mean over the bands.
    let mut looks = Vec::new();
    let mut points = Vec::new();
    for (k, (_, pairs)) in errors.iter().enumerate() {
        let mut of: Vec<(f64, f64)> = Vec::new();
        for (i, look) in scans[k].looks.iter().enumerate() {
            let (_, bias, rms, _) = spread(pairs.iter().map(|(_, of)| of[i].0 / of[i].1 - 1.0));
            let elevation = look.direction.z.asin().to_degrees();
            if scans[k].far(look) {
                let from_sun = scans[k].off_sun_deg(look);
                looks.push((from_sun, elevation, bias, rms));
                of.push((from_sun, bias));
            }
        }
        for (low, high) in (0..18).map(|i| (5.0 + 10.0 * f64::from(i), 15.0 + 10.0 * f64::from(i))) {
            let (count, mean, ..) = spread(of.iter().filter(|at| (low..high).contains(&at.0)).map(|at| at.1));
            if count > 0 {
                let at = [0.5 * (low + high), 100.0 * mean];
                points.push(Point { panel: "mean over wavelengths and over 10 degrees", curve: scans[k].name(), at });
            }
        }
    }
    let mut rows = Vec::new();
    let mut row = |name: String, of: Vec<&(f64, f64, f64, f64)>| {
        let (count, bias, rms, worst) = spread(of.iter().map(|look| look.2));
        rows.push(vec![name, count.to_string(), percent(bias, 1), format!("{:.1}", 100.0 * rms), percent(worst, 0)]);
    };
    for (low, high) in FROM_SUN {
        let of = looks.iter().filter(|look| (low..high).contains(&look.0)).collect();
        row(format!("{low} to {high} degrees from the sun"), of);
    }
    for (low, high) in ELEVATIONS {
        let of = looks.iter().filter(|look| (low..high).contains(&look.1)).collect();
        row(format!("elevation {low} to {} degrees", high.floor()), of);
    }
    section.say("By direction, each a mean over wavelengths:");
    section.table(&["directions", "values", "bias %", "rms %", "worst %"], &rows);
    let title = "Measured skies: relative differences by direction".into();
    section.chart(
        "skies-direction",
        Chart { title, axes: ["angle from the sun / degrees", "model less measured / %"], points },
    );
}
