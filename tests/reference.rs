//! Radiances by other programs: plane-parallel layers and spherical atmospheres,
//! from the ground and from space, one order and all.

use airlight_tests::root;
use renderer::cases::{Effort, Settings, Tier, read, run};
use renderer::transport::Method;
use std::collections::BTreeMap;

#[test]
fn radiances_agree_with_other_programs() {
    let path = root().join("tests/reference/radiances.json");
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
    for method in [Method::Judge, Method::Paths] {
        let settings = Settings { tier: Tier::Full, method, effort: Effort::Error(0.02), seed: 1 };
        let report = run(&suite, &settings, &|_, _| {});
        assert_eq!(report.refusals, [], "{method:?}");
        assert_eq!(report.answers.len(), expected.len());
        let mut squares = 0.0;
        for answer in &report.answers {
            let (value, unc) = expected[answer.id.as_str()];
            let z = (answer.value - value) / answer.stderr.hypot(unc);
            squares += z * z;
            // Twenty cases twice: |z| > 4.5 has the probability 3e-4 in all.
            assert!(z.abs() < 4.5, "{method:?}, {}: {} +- {}, must be {value}", answer.id, answer.value, answer.stderr);
        }
        // Chi-square with 20 degrees of freedom exceeds 45 with the probability 1e-3.
        assert!(squares < 45.0, "{method:?}: chi-square {squares} of {}", expected.len());
    }
}
