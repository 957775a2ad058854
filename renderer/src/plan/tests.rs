//! Laws of plans.

use super::*;
use crate::data::Data;
use crate::render::achieved;
use crate::sampling::{Sampler, spiral};
use crate::spectrum::Wavelengths;
use crate::transport::{Fineness, Method};
use std::path::Path;
use std::sync::LazyLock;
use std::sync::atomic::AtomicBool;

fn evidence() -> &'static Evidence {
    static EVIDENCE: LazyLock<Evidence> =
        LazyLock::new(|| Evidence::new(&Measured::stored().expect("parses")).expect("enough"));
    &EVIDENCE
}

fn traits(sun_elevation_deg: f64, biome: Option<Biome>, optical_depth: f64) -> Traits {
    Traits { biome, optical_depth, sun_elevation_deg, altitude_km: 0.002, albedo: 0.1, ozone_du: 343.1 }
}

fn some() -> Vec<Traits> {
    vec![
        traits(40.0, None, 0.0),
        traits(3.0, Some(Biome::Rural), 0.2),
        traits(-5.0, Some(Biome::DesertDust), 0.4),
        Traits { altitude_km: 700.0, ..traits(30.0, Some(Biome::MaritimeClean), 0.1) },
    ]
}

#[test]
fn stored_measurements_are_what_the_study_writes() {
    for measured in [Measured::stored(), Measured::held_out()] {
        let measured = measured.expect("parses");
        assert_eq!(Measured::parse(&measured.csv()), Ok(measured));
    }
    assert!(Measured::parse("x\n").is_err_and(|e| e.starts_with("line 1")));
    let csv = Measured::stored().expect("parses").csv();
    let short: String = csv.lines().take(4).map(|line| format!("{line}\n")).collect();
    let broken = short.replacen(",0.002,", ",high,", 1);
    assert!(Measured::parse(&broken).is_err_and(|e| e.starts_with("line 3")), "{broken:.60}");
    // An atmosphere's scenes are left out together.
    let lines: Vec<&str> = csv.lines().collect();
    let apart = [&lines[..3], &lines[lines.len() - 1..], &lines[3..4]].concat().join("\n");
    assert!(Measured::parse(&apart).is_err_and(|e| e.starts_with("line 5: atmosphere")));
}

#[test]
fn stored_margins_are_those_of_the_measurements() {
    let measured = Measured::stored().expect("parses");
    // The file has two decimals, and errors with three digits.
    let found = margins(&measured).expect("atmospheres");
    assert!((0..3).all(|i| (found[i] - measured.margins[i]).abs() < 0.006), "{found:?} {:?}", measured.margins);
}

#[test]
fn a_wrong_picture_fails_its_check_and_a_right_one_does_not() {
    static NEVER: AtomicBool = AtomicBool::new(false);
    let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
    let scene = Scene { width: Some(16), height: Some(16), fineness: Some(Fineness::Usual), ..Scene::default() };
    let found = |made: &Scene, metric: Metric| {
        let sky = Sky::new(made, &data).expect("a sky");
        let asked = (metric, metric.unit(0.05), &scene.wavelengths());
        achieved((&scene, &sky), &data, asked, 8192, &NEVER).expect("a truth").expect("light")
    };
    for metric in Metric::ALL {
        // Polarisation left out is 2 % and less.
        assert!(!found(&scene, metric).fails(), "{:?}", found(&scene, metric));
        let bright = Scene { albedo: Albedo::Grey(1.0), ..scene.clone() };
        assert!(found(&bright, metric).fails(), "{:?}", found(&bright, metric));
    }
}

#[test]
fn measured_and_held_out_scenes_are_apart() {
    let [measured, held_out] = [Measured::stored(), Measured::held_out()].map(|m| m.expect("parses"));
    assert!(held_out.rows.iter().all(|row| measured.rows.iter().all(|other| other.traits != row.traits)));
}

#[test]
fn a_smaller_error_never_has_a_worse_or_cheaper_plan() {
    let evidence = evidence();
    for metric in Metric::ALL {
        for traits in some() {
            let mut before: Option<Plan> = None;
            for share in [0.1, 0.05, 0.02, 0.01, 0.005, 0.002] {
                let asked = metric.unit(share);
                let plan = Plan::of(evidence, &Scene::default(), (&traits, None), asked, metric);
                let bound = plan.error().map(|[_, bound]| bound);
                assert!(plan.safe.is_some() || bound.is_some_and(|bound| bound <= asked), "{plan:?}");
                if let (Some(before), Some(cost)) = (&before, plan.cost()) {
                    let was = before.cost().expect("predicted");
                    assert!(cost.iter().sum::<f64>() >= was.iter().sum::<f64>(), "{traits:?} {asked}");
                }
                before = Some(plan);
            }
        }
    }
}

#[test]
fn plans_climb_until_there_are_paths() {
    let evidence = evidence();
    let mut plan = Plan::of(evidence, &Scene::default(), (&some()[0], None), 0.05, Metric::Luminance);
    let mut rungs = 0;
    while let Some(next) = plan.up(&Scene::default()) {
        plan = next;
        rungs += 1;
    }
    assert!(plan.candidate.is_none() && (2..12).contains(&rungs), "{rungs}");
    let scene = plan.scene(&Scene::default());
    assert_eq!((scene.method, scene.error), (Method::Paths, Some(0.05)));
}

#[test]
fn a_scene_outside_is_told_so_and_gets_the_safe_plan() {
    let evidence = evidence();
    let outside = |change: fn(&mut Scene), traits: &Traits| {
        let mut scene = Scene::default();
        change(&mut scene);
        let what = super::outside(&scene, traits);
        let plan = Plan::of(evidence, &scene, (traits, what), 0.01, Metric::Radiance);
        assert!(plan.prediction.is_none() && plan.error().is_none());
        let planned = plan.scene(&scene);
        planned.validate().expect("valid");
        match plan.safe {
            Some(Safe::Outside(what)) => (what, planned.method),
            other => panic!("{other:?}"),
        }
    };
    let day = traits(40.0, None, 0.0);
    assert_eq!(outside(|s| s.flat = true, &day), ("a planet that is a plane".into(), Method::Paths));
    assert_eq!(outside(|s| s.top_km = 60.0, &day).1, Method::Solved);
    let nm = |s: &mut Scene| s.wavelengths_nm = Wavelengths::new(vec![450.0, 550.0]).expect("valid");
    assert!(outside(nm, &day).0.contains("wavelengths"));
    assert!(outside(|_| {}, &traits(-9.0, None, 0.0)).0.contains("below -8 degrees"));
    assert_eq!(outside(|_| {}, &traits(-13.0, None, 0.0)).1, Method::Paths);
    assert!(outside(|_| {}, &traits(40.0, Some(Biome::Urban), 2.0)).0.contains("above 0.8"));
    assert!(outside(|_| {}, &Traits { altitude_km: 60.0, ..day.clone() }).0.contains("between 15 and 120 km"));
    assert_eq!(super::outside(&Scene::default(), &day), None);
}

#[test]
fn who_keeps_stokes_parameters_gets_polarised_light() {
    let evidence = evidence();
    let scene = Scene { polarisation: true, ..Scene::default() };
    let plan = Plan::of(evidence, &scene, (&some()[0], None), 0.5, Metric::Luminance);
    assert!(plan.candidate.is_some_and(|one| one.transfer.polarised));
    assert!(plan.scene(&scene).polarisation);
}

#[test]
fn a_planned_picture_has_the_asked_error() {
    let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
    let scene = Scene { width: Some(1), height: Some(1), ..Scene::default() };
    let evidence = evidence();
    let sky = |scene: &Scene| Sky::new(scene, &data).expect("a sky");
    let luminances = |sky: &Sky| -> Vec<f64> {
        let mut factors = vec![0.0; sky.wavelengths()];
        let mut of = |i| {
            sky.radiance(spiral(i, 40, [0.0, 1.0]), &Sampler::new(0, 0, 0), &mut factors);
            sky.colour().xyz(&factors)[1]
        };
        (0..40).map(&mut of).collect()
    };
    let exact = Scene { fineness: Some(Fineness::Fine), follow_polarisation: Some(true), ..scene.clone() };
    let right = luminances(&sky(&exact));
    let mean = right.iter().sum::<f64>() / 40.0;
    for asked in [0.05, 0.01] {
        let plan = Plan::of(evidence, &scene, (&traits(30.0, None, 0.0), None), asked, Metric::Luminance);
        let planned = plan.scene(&scene);
        let found = luminances(&sky(&planned));
        let square = right.iter().zip(&found).map(|(a, b)| (a - b).powi(2)).sum::<f64>() / 40.0;
        assert!(square.sqrt() / mean < asked, "{} of {asked}: {:?}", square.sqrt() / mean, plan.candidate);
    }
}

#[test]
fn every_grid_but_the_finest_is_a_rung() {
    for fineness in Fineness::ALL.into_iter().filter(|grid| *grid != Fineness::Finest) {
        for polarised in [false, true] {
            let transfer = Transfer { fineness: Some(fineness), polarised };
            assert_eq!(TRANSFERS[transfer.index()], transfer, "what is not among them is taken for the first");
        }
    }
}
