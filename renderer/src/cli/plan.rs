//! `airlight plan`.

use super::args::RenderArgs;
use super::output::println;
use super::progress::amount;
use super::{Failure, Outcome};
use crate::data::Data;
use crate::plan::{Atlas, Candidate, Difference, Evidence, Measured, Metric, Plan, Safe, Spectrum, Traits, outside};
use crate::render::Sky;
use crate::scene::Scene;
use crate::transport::Method;
use crate::transport::rungs::Rung;
use clap::Args;

/// Flags of `airlight plan`.
#[derive(Debug, Args)]
pub(super) struct PlanArgs {
    #[command(flatten)]
    pub render: RenderArgs,
}

pub(super) fn run(args: &PlanArgs) -> Result<Outcome, Failure> {
    let Some(asked) = args.render.error else {
        return Err(Failure::usage("a plan wants an error: add --error 1%"));
    };
    let scene = super::render::scene(&args.render)?;
    let data = super::data(args.render.files.data.as_deref())?;
    let plan = plan(&scene, &data, &args.render, asked.of(args.render.metric.unwrap_or(Metric::Radiance)))?;
    if args.render.files.json {
        println!("{}", json(&plan, &scene));
    } else {
        describe(&plan, &scene).iter().for_each(|line| println!("{line}"));
    }
    Ok(Outcome::Done)
}

/// The plan for a scene.
pub(super) fn plan(scene: &Scene, data: &Data, args: &RenderArgs, asked: f64) -> Result<Plan, Failure> {
    let stored = |error: String| Failure::error(format!("the measurements that this program carries: {error}"));
    let evidence = Evidence::new(&Measured::stored().map_err(stored)?).map_err(stored)?;
    // Its air and ground alone are asked for.
    let air = Scene {
        method: Method::Paths,
        wavelengths_nm: Spectrum::Seen4.wavelengths(),
        colour: crate::spectrum::Scheme::Spectral,
        fineness: None,
        steps: None,
        sky_type: None,
        width: Some(1),
        height: Some(1),
        ..scene.clone()
    };
    let sky: Sky = super::render::sky(&air, data, None)?;
    let traits = Traits::of(scene, &sky);
    let metric = args.metric.unwrap_or(Metric::Radiance);
    Ok(Plan::of(&evidence, scene, (&traits, outside(scene, &traits)), asked, metric))
}

/// The method in words.
fn method(scene: &Scene) -> String {
    let rung = Rung::of(scene.method);
    let grid = scene.fineness.map_or(String::new(), |fineness| format!(", {} tables", fineness.name()));
    let polarised = if scene.polarised() == Some(true) { ", with polarisation" } else { "" };
    let steps = scene.steps.map_or(String::new(), |steps| format!(", {steps} points on a line"));
    let error = scene.error.map_or(String::new(), |error| format!(", until their own error is {:.3} %", 100.0 * error));
    format!("{}{grid}{steps}{polarised}{error}", rung.name)
}

/// The flags of `airlight render` that do what a planned scene says beyond the scene itself.
fn flags(scene: &Scene) -> String {
    let mut flags = format!("--method {}", Rung::of(scene.method).name);
    if let Some(fineness) = scene.fineness {
        flags += &format!(" --fineness {}", fineness.name());
    }
    if let Some(steps) = scene.steps {
        flags += &format!(" --steps {steps}");
    }
    match scene.follow_polarisation {
        Some(true) => flags += " --follow-polarisation",
        Some(false) => flags += " --follow-polarisation=off",
        None => {}
    }
    if let Some(error) = scene.error {
        flags += &format!(" --error {error}");
    }
    if scene.colour == crate::spectrum::Scheme::Spectral
        && scene.wavelengths_nm != crate::spectrum::Wavelengths::default()
    {
        let nm: Vec<String> = scene.wavelengths_nm.nm().iter().map(|nm| format!("{nm:.1}")).collect();
        let even = crate::spectrum::Wavelengths::visible(nm.len()).is_ok_and(|even| even == scene.wavelengths_nm);
        flags += &format!(" --wavelengths {}", if even { nm.len().to_string() } else { nm.join(",") });
    }
    flags
}

/// A plan in lines.
pub(super) fn describe(plan: &Plan, scene: &Scene) -> Vec<String> {
    let (metric, planned) = (plan.metric, plan.scene(scene));
    let mut lines = vec![format!("asked       {} of {}", metric.show(plan.asked), metric.name())];
    match &plan.safe {
        Some(Safe::Outside(what)) => lines.push(format!(
            "outside     what was measured does not hold {what}: the most exact way that there is, and nothing predicted"
        )),
        Some(Safe::Exact) if plan.candidate.is_some() => {
            lines.push("unsure      the most exact table is likely to meet this error, but not by the margin".into());
        }
        Some(Safe::Exact) => lines.push("            no table is that exact here: paths".into()),
        None => {}
    }
    lines.push(format!("method      {}", method(&planned)));
    let nm = planned.wavelengths();
    let (first, last) = (nm.nm().first().copied().unwrap_or(0.0), nm.nm().last().copied().unwrap_or(0.0));
    lines.push(format!("wavelengths {} from {first:.0} to {last:.0} nm", nm.nm().len()));
    if let Some([likely, bound]) = plan.error() {
        lines.push(format!(
            "predicted   off by {}, at most {} with a margin of {:.1} standard deviations",
            metric.show(likely),
            metric.show(bound),
            plan.margin
        ));
    }
    if let Some([solve, picture]) = plan.cost() {
        let (width, height) = scene.size();
        lines.push(format!(
            "cost        {} core-seconds for tables, {} for a picture of {width} x {height}, as measured",
            amount(solve),
            amount(picture)
        ));
    }
    for (what, [without, with]) in plan.left_out() {
        lines.push(format!("left out    {what}: off by {} without, {} with", metric.show(without), metric.show(with)));
    }
    lines.extend(negligible(plan));
    lines.push(format!("render      {}", flags(&planned)));
    lines
}

/// Parts of the world that could be left out too: those which change less than a quarter of the asked error on the scene of the atlas that is most like this
/// one. They save nothing.
fn negligible(plan: &Plan) -> Vec<String> {
    const SHARE: f64 = 0.25;
    if plan.prediction.is_none() {
        return Vec::new();
    }
    let Ok(atlas) = Atlas::stored() else { return Vec::new() };
    let near = atlas.near(&plan.traits);
    // Clear air has no aerosol to say anything of.
    let speaks = |row: &&Difference| plan.traits.biome.is_some() || !row.term.starts_with("aerosol");
    let small = near.into_iter().filter(|row| row.is_of_the_world()).filter(speaks);
    let small =
        small.map(|row| (row, row.change[plan.metric as usize])).filter(|(_, change)| *change < SHARE * plan.asked);
    small.map(|(row, change)| format!("negligible  {}: {}", row.term, plan.metric.show(change))).collect()
}

/// A plan as JSON.
fn json(plan: &Plan, scene: &Scene) -> String {
    let planned = plan.scene(scene);
    let left_out: Vec<_> = plan
        .left_out()
        .into_iter()
        .map(|(what, [without, with])| serde_json::json!({ "what": what, "error": without, "error_with_it": with }))
        .collect();
    let outside = match &plan.safe {
        Some(Safe::Outside(what)) => Some(what.clone()),
        _ => None,
    };
    let value = serde_json::json!({
        "asked": plan.asked,
        "metric": plan.metric,
        "rung": plan.candidate.map_or("paths".into(), Candidate::name),
        "method": Rung::of(planned.method).name,
        "fineness": planned.fineness,
        "polarised": planned.polarised() == Some(true),
        "wavelengths_nm": planned.wavelengths(),
        "predicted": plan.error().map(|[likely, _]| likely),
        "predicted_at_most": plan.error().map(|[_, bound]| bound),
        "margin_standard_deviations": plan.margin,
        "core_seconds": plan.cost().map(|cost| cost.iter().sum::<f64>()),
        "left_out": left_out,
        "outside": outside,
        "meets_by_margin": plan.safe.is_none(),
        "scene": planned.portable(),
    });
    value.to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Measured;

    fn lines(scene: &Scene, traits: &Traits, asked: f64, metric: Metric) -> Vec<String> {
        let evidence = Evidence::new(&Measured::stored().expect("parses")).expect("enough");
        let plan = Plan::of(&evidence, scene, (traits, outside(scene, traits)), asked, metric);
        serde_json::from_str::<serde_json::Value>(&json(&plan, scene)).expect("JSON");
        describe(&plan, scene)
    }

    #[test]
    fn a_plan_says_what_is_left_out_with_its_number() {
        let scene = Scene::default();
        let clear = Traits {
            biome: None,
            optical_depth: 0.0,
            sun_elevation_deg: 30.0,
            altitude_km: 0.002,
            albedo: 0.1,
            ozone_du: 343.1,
        };
        for (asked, metric) in [(0.05, Metric::Luminance), (0.01, Metric::Radiance), (1.0, Metric::Colour)] {
            let lines = lines(&scene, &clear, asked, metric);
            let has = |start: &str| lines.iter().any(|line| line.starts_with(start));
            for start in ["asked", "method", "wavelengths", "predicted", "cost", "left out", "negligible", "render"] {
                assert!(has(start), "{start}: {lines:?}");
            }
        }
        let low = Traits { sun_elevation_deg: -10.0, ..clear };
        let scene = Scene { sun_elevation_deg: -10.0, ..scene };
        let lines = lines(&scene, &low, 0.01, Metric::Radiance);
        assert!(
            lines[1].contains("the sun below -8 degrees") && !lines.iter().any(|line| line.starts_with("predicted"))
        );
    }
}
