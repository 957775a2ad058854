//! Radiances by other programs: plane-parallel layers and spherical atmospheres,
//! from the ground and from space, one order and all, clear and with aerosol.

#![allow(clippy::print_stdout, reason = "the figures found: cargo test -- --nocapture shows them")]

use airlight_tests::root;
use renderer::cases::{Effort, Method, Settings, Tier, read, run};
use renderer::transport::Estimator;
use std::collections::BTreeMap;

/// Answers every case of a file at 1 % (solved tables: what they offer, as exactly as they are) and compares: each within 4.5 errors (a false alarm in 3e-4 of all
/// runs of forty), and together by chi-square within `most`. Solved tables refuse with a reason that has `refused` in it, certificates of single orders, too.
fn agree(file: &str, refused: &str, most: f64) {
    let path = root().join("tests/reference").join(file);
    let text: serde_json::Value = serde_json::from_slice(&std::fs::read(&path).expect("read")).expect("JSON");
    let expected: BTreeMap<&str, (f64, f64)> = text["cases"]
        .as_array()
        .expect("cases")
        .iter()
        .map(|case| {
            let number = |key: &str| case[key].as_f64().expect("a number");
            (case["id"].as_str().expect("an id"), (number("value"), number("unc")))
        })
        .collect();
    let suite = read(&path).expect("cases");
    for method in
        [Method::Sampled(Estimator::Judge), Method::Sampled(Estimator::Paths), Method::Solved, Method::Certified]
    {
        let settings = Settings { tier: Tier::Full, method, effort: Effort::Error(0.01), seed: 1 };
        let report = run(&suite, &settings, &|_, _| {});
        let sampled = matches!(method, Method::Sampled(_));
        let known = |why: &str| why.contains(refused) || (method == Method::Certified && why.contains("all orders"));
        let sound = report.refusals.iter().all(|refusal| !sampled && known(&refusal.why));
        assert!(sound, "{:?}", report.refusals);
        assert_eq!(report.answers.len() + report.refusals.len(), expected.len());
        let (mut squares, mut largest) = (0.0, 0.0_f64);
        for answer in &report.answers {
            let (value, unc) = expected[answer.id.as_str()];
            let z = (answer.value - value) / answer.stderr.hypot(unc);
            squares += z * z;
            // A U of zero has no relative difference.
            if value != 0.0 {
                largest = largest.max((answer.value / value - 1.0).abs());
            }
            assert!(z.abs() < 4.5, "{method:?}, {}: {} +- {}, must be {value}", answer.id, answer.value, answer.stderr);
        }
        let percent = 100.0 * largest;
        println!(
            "{file}, {method:?}: chi-square {squares:.1} of {}, largest difference {percent:.1} %",
            report.answers.len()
        );
        assert!(squares < most, "{method:?}: chi-square {squares} of {}", report.answers.len());
    }
}

#[test]
fn radiances_agree_with_discrete_ordinates_and_quadrature() {
    // Chi-square with 20 degrees of freedom exceeds 45 with the probability 1e-3.
    agree("radiances.json", "round planet", 45.0);
}

#[test]
fn radiances_agree_with_other_renderers() {
    // Chi-square with 18 degrees of freedom exceeds 42 with the probability 1e-3.
    agree("renderers.json", "round planet", 42.0);
}

#[test]
fn stokes_parameters_agree_with_tables_and_a_vector_tracer() {
    // Chi-square with 26 degrees of freedom exceeds 54 with the probability 1e-3. Scalar transfer is off by up to 11 % there.
    agree("polarised.json", "round planet", 54.0);
}
