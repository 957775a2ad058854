//! Radiances and fluxes by other programs: `radiances.json` and `radiances-with-aerosol.json`, answered by
//! [`renderer::cases`] and judged as [`crate::judge`] says, group by group.
//!
//! A group is a geometry, an observer, one order of scattering or all, scalar or polarised transfer, a quantity and, on spheres, a
//! band of the sun's zenith angle. Solved tables answer radiances on spheres; path tracing the layers and the core
//! cases on spheres, with so many paths a case; the brute-force judge the core cases by day that are not seen from space, to a given
//! error: where light is rare, its paths are too, and the spread of a few says nothing of the rest.

use crate::judge::{Compared, GROUP_Z, Statistics, WORST_Z, percent};
use crate::{Context, Section, ValidationError, Verdict, references};
use renderer::cases::{self, Effort, Method, Refusal, Settings, Tier};
use renderer::study::{Chart, Point};
use renderer::transport::Estimator;
use serde_json::Value;
use std::collections::BTreeMap;
use std::path::Path;

/// The files, and what stands before the names of their groups.
const FILES: [(&str, &str); 2] = [("radiances.json", "molecules"), ("radiances-with-aerosol.json", "aerosol")];

/// Paths of a traced case, and of a quick one.
const PATHS: (u64, u64) = (16_384, 4096);

/// Relative standard error of a case by the judge.
const JUDGED: f64 = 0.02;

/// And of certificates.
const CERTIFIED: f64 = 0.002;

/// References below this have no relative error: of the solar irradiance 1e-9 is not resolved.
const RESOLVED: f64 = 1e-8;

/// Answers of a method to a part of the cases.
struct Run {
    title: &'static str,
    method: Method,
    effort: Effort,
    takes: fn(&Value) -> bool,
    /// The name of its panel.
    panel: &'static str,
}

fn is(case: &Value, key: &str, word: &str) -> bool {
    case[key].as_str() == Some(word)
}

/// Computes the section.
///
/// # Errors
/// [`ValidationError`] if a reference cannot be read.
pub fn make(context: &Context<'_>) -> Result<Section, ValidationError> {
    let spherical: fn(&Value) -> bool = |case| is(case, "geometry", "spherical");
    let core: fn(&Value) -> bool = |case| is(case, "tier", "core");
    let quick: fn(&Value) -> bool = |case| is(case, "geometry", "spherical") && is(case, "tier", "core");
    let traced: fn(&Value) -> bool = |case| is(case, "geometry", "plane-parallel") || is(case, "tier", "core");
    let bright: fn(&Value) -> bool = |case| {
        let day = case["sza_deg"].as_f64().is_some_and(|zenith| zenith <= 88.0);
        is(case, "tier", "core") && day && !is(case, "observer", "space")
    };
    let certified: fn(&Value) -> bool = |case| {
        is(case, "geometry", "spherical")
            && is(case, "tier", "core")
            && is(case, "orders", "all")
            && is(case, "quantity", "radiance")
    };
    let runs = [
        Run {
            title: "Solved tables",
            method: Method::Solved,
            // Not sampled.
            effort: Effort::Paths(2),
            takes: if context.quick { quick } else { spherical },
            panel: "solved tables",
        },
        Run {
            title: "Paths",
            method: Method::Sampled(Estimator::Paths),
            effort: Effort::Paths(if context.quick { PATHS.1 } else { PATHS.0 }),
            takes: if context.quick { core } else { traced },
            panel: "paths",
        },
        Run {
            title: "Certificates",
            method: Method::Certified,
            effort: Effort::Error(if context.quick { 0.01 } else { CERTIFIED }),
            takes: certified,
            panel: "certificates",
        },
        Run {
            title: "The judge",
            method: Method::Sampled(Estimator::Judge),
            effort: Effort::Error(JUDGED),
            takes: bright,
            panel: "judge",
        },
    ];
    let mut section = Section::default();
    section.say(&format!(
        "Compared: radiances, Stokes parameters and fluxes of given atmospheres, per unit solar irradiance. References: CDISORT with 64 \
         and 128 streams (uncertainty 2e-6 and 1e-5), the corrected tables of Coulson (Natraj, Li & Yung 2009, 1e-5), quadrature of single \
         scattering (1e-7), and on spheres quadrature with backward Monte Carlo for the later orders (median 5e-4 with the sun up, 4e-3 \
         below the horizon, at most 3e-2; its errors are correlated between the suns of one view). Each case has its own \
         uncertainty in the file. A case fails if it is more than {WORST_Z} combined standard errors off, a group of {} or more if \
         the rms of z exceeds {}. Errors of Q and U are relative to I.",
        GROUP_Z.1, GROUP_Z.0
    ));
    let mut points = Vec::new();
    for (k, run) in runs.iter().enumerate() {
        let progress = |share: f64| (context.progress)((k as f64 + share) / runs.len() as f64);
        let (groups, refusals) = answers(context.root, run, &progress)?;
        report(&mut section, run, &groups, &refusals);
        points.extend(curve(run.panel, groups.values().flatten()));
    }
    section.chart(
        "rt",
        Chart {
            title: "Radiances by other programs: differences over their combined uncertainties".into(),
            axes: ["difference / combined standard errors", "cases no further off / %"],
            points,
        },
    );
    Ok(section)
}

type Groups = BTreeMap<String, Vec<Compared>>;

fn answers(root: &Path, run: &Run, progress: &(dyn Fn(f64) + Sync)) -> Result<(Groups, Vec<Refusal>), ValidationError> {
    let (mut groups, mut refusals) = (Groups::new(), Vec::new());
    for (i, (file, kind)) in FILES.into_iter().enumerate() {
        let path = references::path(root, file);
        let malformed = |what: String| ValidationError::Reference { path: path.clone(), what };
        let mut all: Value =
            serde_json::from_slice(&references::bytes(&path)?).map_err(|e| malformed(e.to_string()))?;
        let list = all["cases"].as_array().ok_or_else(|| malformed("no list of cases".into()))?.clone();
        let radiances: BTreeMap<String, f64> = list
            .iter()
            .filter(|case| is(case, "quantity", "radiance") && is(case, "polarization", "vector"))
            .filter_map(|case| Some((direction(case), case["value"].as_f64()?)))
            .collect();
        let taken: Vec<Value> = list.into_iter().filter(run.takes).collect();
        all["cases"] = Value::Array(taken.clone());
        let suite = cases::parse(&path, all.to_string().as_bytes())?;
        let settings = Settings { tier: Tier::Full, method: run.method, effort: run.effort, seed: 1 };
        let step =
            |done: usize, all: usize| progress((i as f64 + done as f64 / all.max(1) as f64) / FILES.len() as f64);
        let report = cases::run(&suite, &settings, &step);
        let by_id: BTreeMap<&str, &Value> =
            taken.iter().filter_map(|case| Some((case["id"].as_str()?, case))).collect();
        for answer in report.answers {
            let case = by_id[answer.id.as_str()];
            let number = |key: &str| case[key].as_f64().ok_or_else(|| malformed(format!("{}: no {key}", answer.id)));
            let reference = (number("value")?, number("unc")?);
            let stokes = case["quantity"].as_str().is_some_and(|quantity| quantity.starts_with("stokes"));
            let intensity = if stokes { radiances.get(&direction(case)).copied() } else { None };
            groups.entry(format!("{kind}, {}", group(case))).or_default().push(Compared {
                scale: Some(intensity.unwrap_or(reference.0)).filter(|scale| scale.abs() >= RESOLVED).unwrap_or(0.0),
                found: (answer.value, answer.stderr),
                reference,
                id: answer.id,
            });
        }
        refusals.extend(report.refusals);
    }
    Ok((groups, refusals))
}

/// What tells a direction of a case from others, whatever is asked of it.
fn direction(case: &Value) -> String {
    let keys = ["geometry", "profile", "layers", "sza_deg", "albedo", "observer", "view_zenith_deg", "view_dphi_deg"];
    keys.map(|key| case[key].to_string()).join(" ")
}

fn group(case: &Value) -> String {
    let word = |key: &str| case[key].as_str().unwrap_or("?").to_owned();
    let quantity = word("quantity");
    let quantity = if quantity.starts_with("flux") { "flux".to_owned() } else { quantity.replace("stokes_", "") };
    let orders = if word("orders") == "1" { "one order" } else { "all orders" };
    let transfer = if is(case, "polarization", "any") { String::new() } else { format!(", {}", word("polarization")) };
    let sun = case["sza_deg"].as_f64().unwrap_or(0.0);
    let band = match sun {
        _ if is(case, "geometry", "plane-parallel") => "",
        ..=88.0 => ", sun to 88",
        ..=92.0 => ", sun 88 to 92",
        _ => ", sun beyond 92",
    };
    let from = match word("observer").as_str() {
        "space" => "from space".to_owned(),
        "air" => "from within the air".to_owned(),
        place => format!("from the {place}"),
    };
    format!("{}, {from}, {orders}{transfer}, {quantity}{band}", word("geometry"))
}

fn report(section: &mut Section, run: &Run, groups: &Groups, refusals: &[Refusal]) {
    let all: Vec<&Compared> = groups.values().flatten().collect();
    let sampling = match (run.method, run.effort) {
        (Method::Solved, _) => {
            "each with the error that the tables state by themselves (from a coarser one)".to_owned()
        }
        (_, Effort::Paths(paths)) => format!("{paths} paths a case"),
        (_, Effort::Error(error)) => format!("each to a standard error of {} %", 100.0 * error),
    };
    section.say(&format!("### {}\n\n{} cases, {sampling}.", run.title, all.len()));
    let mut rows = Vec::new();
    let mut wide = Vec::new();
    for (name, cases) in groups {
        let found = Statistics::of(&cases.iter().collect::<Vec<_>>());
        if found.fails() {
            wide.push(name.clone());
        }
        rows.push(row(name, &found));
    }
    section.table(&["group", "cases", "bias (error) %", "rms %", "worst %", "rms z", "largest z"], &rows);
    let failing: Vec<&&Compared> = all.iter().filter(|case| case.fails()).collect();
    if failing.is_empty() && wide.is_empty() {
        section.say("No case and no group fails.");
    }
    for name in &wide {
        section.say(&format!("Fails: the group *{name}*, by the rms of its z."));
    }
    for case in &failing {
        section.say(&format!(
            "Fails: `{}`, found {:.4e} +- {:.1e}, reference {:.4e} +- {:.1e}, {} %, z {:+.1}.",
            case.id,
            case.found.0,
            case.found.1,
            case.reference.0,
            case.reference.1,
            percent(case.relative(), 2),
            case.z()
        ));
    }
    let mut reasons: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for refusal in refusals {
        reasons.entry(&refusal.why).or_default().push(&refusal.id);
    }
    for (why, ids) in reasons {
        section.say(&format!("Refused: {} cases ({why}), such as `{}`.", ids.len(), ids[0]));
    }
    let total = Statistics::of(&all);
    section.find(
        format!("radiances, {}", run.title.to_lowercase()),
        format!(
            "{} cases: rms {:.2} %, rms z {:.2}, {} beyond {WORST_Z} standard errors, {} groups too wide",
            total.count,
            100.0 * total.rms,
            total.rms_z,
            failing.len(),
            wide.len()
        ),
        "discrete ordinates, Natraj et al. 2009, quadrature, Monte Carlo",
        Verdict::of(failing.is_empty() && wide.is_empty()),
    );
}

fn row(name: &str, found: &Statistics) -> Vec<String> {
    vec![
        name.to_owned(),
        found.count.to_string(),
        format!("{} ({:.3})", percent(found.bias, 3), 100.0 * found.bias_error),
        format!("{:.3}", 100.0 * found.rms),
        percent(found.worst, 2),
        format!("{:.2}", found.rms_z),
        format!("{:.1}", found.max_z),
    ]
}

/// The most points of a curve.
const MOST: usize = 200;

/// How many cases are no further off than |z|, in percent, and how many normal deviates.
fn curve<'a>(panel: &'static str, cases: impl Iterator<Item = &'a Compared>) -> Vec<Point> {
    let mut z: Vec<f64> = cases.map(|case| case.z().abs()).collect();
    z.sort_by(f64::total_cmp);
    let step = z.len().div_ceil(MOST).max(1);
    let found = (0..z.len()).filter(|i| (i + 1) % step == 0 || i + 1 == z.len());
    let point = |curve: &str, x: f64, y: f64| Point { panel, curve: curve.into(), at: [x, 100.0 * y] };
    let mut points: Vec<Point> = found.map(|i| point("found", z[i], (i + 1) as f64 / z.len() as f64)).collect();
    points.extend((0..=40).map(|i| f64::from(i) / 10.0).map(|x| point("normal deviates", x, within(x))));
    points
}

/// The share of normal deviates within +-x: the integral of the density by Simpson's rule in steps of 0.01 at most.
fn within(x: f64) -> f64 {
    let steps = 2 * (50.0 * x).ceil().max(1.0) as usize;
    let h = x / steps as f64;
    let density = |i: usize| (-0.5 * (h * i as f64).powi(2)).exp();
    let inner: f64 = (1..steps).map(|i| if i % 2 == 1 { 4.0 } else { 2.0 } * density(i)).sum();
    (2.0 / std::f64::consts::PI).sqrt() * h / 3.0 * (density(0) + inner + density(steps))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_normal_deviates_are_those_of_every_table() {
        // Four digits of tables of the error function.
        for (x, share) in [(0.0, 0.0), (1.0, 0.6827), (2.0, 0.9545), (3.0, 0.9973)] {
            assert!((within(x) - share).abs() < 5e-5, "{x}: {}", within(x));
        }
    }

    #[test]
    fn references_hold_as_many_cases_as_their_readme_says() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        for ((file, _), (all, core)) in FILES.into_iter().zip([(3840, 893), (159, 53)]) {
            let text = references::bytes(&references::path(&root, file)).expect("read");
            let value: Value = serde_json::from_slice(&text).expect("JSON");
            let cases = value["cases"].as_array().expect("a list");
            assert_eq!(cases.len(), all, "{file}");
            assert_eq!(cases.iter().filter(|case| is(case, "tier", "core")).count(), core, "{file}");
            assert!(cases.iter().all(|case| case["unc"].as_f64().is_some_and(|unc| unc > 0.0)), "{file}");
        }
    }
}
