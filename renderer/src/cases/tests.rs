//! Cases with answers in closed form, and cases that must be refused.

use super::*;

fn suite(cases: &str) -> Suite {
    let text = format!(
        r#"{{"profiles": {{"thin": {{"z_km": [0, 10, 100], "scattering_per_km": [1e-4, 5e-5, 0], "absorption_per_km": [0, 0, 0]}}}}, "cases": [{cases}]}}"#
    );
    serde_json::from_str(&text).expect("valid JSON of the expected form")
}

fn case(id: &str, rest: &str) -> String {
    format!(
        r#"{{"id": "{id}", "sza_deg": 60, "albedo": 0.5, "orders": "all", "view_zenith_deg": 0, "view_dphi_deg": 0, {rest}}}"#
    )
}

fn answer(text: &str, effort: Effort) -> Report {
    let settings = Settings { tier: Tier::Full, method: Method::Sampled(Estimator::Paths), effort, seed: 1 };
    run(&suite(text), &settings, &|_, _| {})
}

const ABSORBER: &str = r#""geometry": "plane-parallel", "observer": "ground", "layers": [{"tau": 0.3, "ssa": 0.0, "phase": [[1.0, "rayleigh", 0.0]]}]"#;

#[test]
fn fluxes_of_an_absorbing_layer_are_closed_forms() {
    let cases = ["flux_down_direct_ground", "flux_up_ground", "flux_up_top"]
        .map(|q| case(q, &format!(r#""quantity": "{q}", {ABSORBER}"#)));
    let cases = cases.join(",");
    let report = answer(&cases, Effort::Error(0.003));
    assert_eq!(report.refusals, []);
    let direct = 0.5 * (-0.6_f64).exp();
    // Flux transmittance 2 E_3(tau) by midpoints: integral of 2 mu exp(-tau/mu).
    let n = 100_000;
    let flux: f64 =
        (0..n).map(|i| (f64::from(i) + 0.5) / f64::from(n)).map(|mu| 2.0 * mu * (-0.3 / mu).exp() / f64::from(n)).sum();
    for (found, expected) in report.answers.iter().zip([direct, 0.5 * direct, 0.5 * direct * flux]) {
        let allowed = 5.0 * found.stderr + 1e-9;
        assert!(
            (found.value - expected).abs() <= allowed,
            "{}: {} +- {}, must be {expected}",
            found.id,
            found.value,
            found.stderr
        );
        assert!(found.stderr <= 0.003 * expected, "{}: error {}", found.id, found.stderr);
    }
}

#[test]
fn certificates_answer_radiances_of_all_orders() {
    let rest = r#""quantity": "radiance", "geometry": "spherical", "profile": "thin", "phase": [[1.0, "rayleigh", 0.0]], "observer": "ground", "observer_alt_km": 0.0"#;
    let day = case("day", rest);
    let dark = case("dark", rest).replace(r#""sza_deg": 60"#, r#""sza_deg": 150"#);
    let single = case("single", rest).replace(r#""orders": "all""#, r#""orders": "1""#);
    let plane = case("plane", &format!(r#""quantity": "radiance", {ABSORBER}"#));
    let cases = [day.clone(), dark, single, plane].join(",");
    let settings = Settings { tier: Tier::Full, method: Method::Certified, effort: Effort::Error(0.003), seed: 1 };
    let report = run(&suite(&cases), &settings, &|_, _| {});
    let why: Vec<_> = report.refusals.iter().map(|refusal| refusal.why.as_str()).collect();
    assert_eq!(why, ["certificates are of all orders", "solved tables need a round planet"]);
    let [found, none] = report.answers.as_slice() else { panic!("{:?}", report.answers) };
    let paths = &answer(&day, Effort::Error(0.003)).answers[0];
    let allowed = 5.0 * found.stderr.hypot(paths.stderr);
    assert!((found.value - paths.value).abs() < allowed, "{} for {}", found.value, paths.value);
    assert!(found.stderr <= 0.0031 * found.value, "error {} of {}", found.stderr, found.value);
    // No relative error can be had of nothing: what is not resolved is the error.
    assert!(none.value.abs() < 1e-9 && none.stderr >= 1e-9 && none.stderr < 1e-8, "{none:?}");
    assert!(none.paths >= 2);
}

#[test]
fn thin_single_scattering_is_the_optical_depth_times_the_phase_function() {
    // tau = 1e-4 (5 + 5) + ... = 7.5e-4 + 2.25e-3 of a trapezoid each, both transmittances within 1 % of 1.
    let rest = r#""quantity": "radiance", "geometry": "spherical", "profile": "thin", "phase": [[1.0, "rayleigh", 0.0]], "observer": "ground", "observer_alt_km": 0.0"#;
    let report = answer(&case("thin", rest).replace(r#""orders": "all""#, r#""orders": "1""#), Effort::Error(0.003));
    let tau = 1e-4 * (0.5 * 10.0 * 1.5 + 0.5 * 90.0 * 0.5);
    let expected = tau * 3.0 / (16.0 * std::f64::consts::PI) * 1.25;
    let found = &report.answers[0];
    assert!((found.value / expected - 1.0).abs() < 0.01 + 5.0 * 0.003, "{} for {expected}", found.value);
}

#[test]
fn one_order_of_reflection_is_of_the_beam_alone() {
    let layer = ABSORBER.replace(r#""ssa": 0.0"#, r#""ssa": 1.0"#);
    let case = case("one", &format!(r#""quantity": "flux_up_ground", {layer}"#));
    let report = answer(&case.replace(r#""orders": "all""#, r#""orders": "1""#), Effort::Paths(10));
    let direct = 0.5 * (-0.6_f64).exp();
    // A closed form; rounding only.
    assert!((report.answers[0].value - 0.5 * direct).abs() < 1e-12, "{:?}", report.answers);
}

#[test]
fn what_is_not_offered_is_refused_with_a_reason() {
    let radiance = r#""quantity": "radiance", "geometry": "plane-parallel", "observer": "ground", "layers": [{"tau": 0.3, "ssa": 1.0, "phase": [[1.0, "rayleigh", 0.0]]}]"#;
    let cases = [
        case("vector", &format!(r#""polarization": "vector", {}"#, radiance.replace("rayleigh", "hg"))),
        case("stokes", &format!(r#""polarization": "scalar", {}"#, radiance.replace("\"radiance\"", "\"stokes_Q\""))),
        case("phase", &radiance.replace("rayleigh", "mie")),
        case("ssa", &radiance.replace(r#""ssa": 1.0"#, r#""ssa": 1.5"#)),
        case(
            "profile",
            r#""quantity": "radiance", "geometry": "spherical", "profile": "none", "observer": "ground", "observer_alt_km": 0"#,
        ),
        case("quantity", &radiance.replace("\"radiance\"", "\"colour\"")),
    ];
    let report = answer(&cases.join(","), Effort::Paths(10));
    assert_eq!(report.answers, []);
    for (refusal, word) in
        report.refusals.iter().zip(["no scattering matrix", "no Stokes", "mie", "ssa", "none", "colour"])
    {
        assert!(refusal.why.contains(word), "{}: {:?} does not say {word:?}", refusal.id, refusal.why);
    }
}

#[test]
fn darkness_ends() {
    // The sun below the horizon of a plane lights nothing.
    let rest = r#""quantity": "radiance", "geometry": "plane-parallel", "observer": "ground", "layers": [{"tau": 0.3, "ssa": 1.0, "phase": [[1.0, "rayleigh", 0.0]]}]"#;
    let report = answer(&case("night", rest).replace(r#""sza_deg": 60"#, r#""sza_deg": 120"#), Effort::Error(0.01));
    // Zero, known to what is not resolved at all.
    assert_eq!((report.answers[0].value, report.answers[0].stderr), (0.0, 1e-9));
    assert_eq!(report.refusals, []);
}

#[test]
fn csv_has_all_digits_and_the_header() {
    let answers = [Answer { id: "a".into(), value: 0.1 + 0.2, stderr: 1e-9, paths: 5 }];
    assert_eq!(to_csv(&answers), "id,value,stderr\na,3.0000000000000004e-1,1e-9\n");
}
