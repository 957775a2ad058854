use super::looks::Cost;
use super::*;
use crate::data::Data;
use crate::film::Channels;
use crate::scene::{Albedo, CameraKind, Scene};
use crate::spectrum::Wavelengths;
use crate::transport::Method;
use std::path::Path;

/// Looks at a sky of 1000 cd/m^2 all around.
fn looks() -> Looks {
    let cost = Cost { once_s: 0.1, picture_s: 0.4, spread: 0.6 };
    Looks { luminances: vec![1000.0; 144], to_ground: 0, cost: Ok(cost) }
}

/// The only finding: what it leads to, and in words.
fn only(scene: &Scene, looks: Option<&Looks>) -> (Trouble, String) {
    let findings = of_scene(scene, looks);
    let [Finding { trouble, what, remedy }] = &findings[..] else { panic!("{findings:?}") };
    (*trouble, format!("{what}: {remedy}"))
}

#[track_caller]
fn found((trouble, words): (Trouble, String), expected: Trouble, number: &str, flag: &str) {
    assert!(trouble == expected && words.contains(number) && words.contains(flag), "{trouble:?}: {words}");
}

#[test]
fn a_good_scene_has_nothing_wrong() {
    assert_eq!(of_scene(&Scene::default(), Some(&looks())), []);
}

#[test]
fn the_sun_below_astronomical_twilight_is_black() {
    let scene = |sun_elevation_deg, altitude_km| Scene { sun_elevation_deg, altitude_km, ..Scene::default() };
    found(only(&scene(-25.0, 0.0), None), Trouble::Black, "25.0 degrees", "--sun-elevation");
    assert_eq!(of_scene(&scene(-17.9, 0.0), None), []);
    // From 400 km the horizon lies 19.8 degrees lower.
    assert_eq!(of_scene(&scene(-25.0, 400.0), None), []);
}

#[test]
fn an_observer_below_the_ground_is_told() {
    let scene = Scene { altitude_km: -0.5, ..Scene::default() };
    found(only(&scene, None), Trouble::Refused, "0.5 km below", "--altitude");
}

#[test]
fn a_number_out_of_its_range_is_told() {
    let scene = Scene { top_km: 500.0, ..Scene::default() };
    found(only(&scene, None), Trouble::Refused, "500", "scene new");
}

#[test]
fn a_view_into_the_ground_is_told() {
    let scene = Scene { camera: CameraKind::Pinhole, view_elevation_deg: Some(-60.0), ..Scene::default() };
    found(only(&scene, Some(&Looks { to_ground: 140, ..looks() })), Trouble::Black, "140 of 144", "--view-elevation");
}

#[test]
fn a_view_past_the_planet_is_told_where_the_horizon_is() {
    let scene =
        Scene { camera: CameraKind::Pinhole, altitude_km: 400.0, view_elevation_deg: Some(40.0), ..Scene::default() };
    found(only(&scene, Some(&Looks { luminances: vec![0.0; 144], ..looks() })), Trouble::Black, "144 of 144", "-19.8");
}

#[test]
fn an_exposure_that_is_not_that_of_the_light_is_told() {
    // 1000 cd/m^2 are 22 % of white at log2(1000 / 0.264) = 11.9 EV.
    let scene = |ev| Scene { exposure_ev: Some(ev), ..Scene::default() };
    found(only(&scene(0.0), Some(&looks())), Trouble::BlownOut, "11.9 stops brighter", "--exposure 11.9");
    found(only(&scene(20.0), Some(&looks())), Trouble::Black, "8.1 stops darker", "--exposure 11.9");
    assert_eq!(of_scene(&scene(12.5), Some(&looks())), []);
}

#[test]
fn noise_of_few_paths_is_predicted() {
    let scene = |spp| Scene { method: Method::Paths, spp: Some(spp), ..Scene::default() };
    // 0.6 / sqrt(9) = 20 %; 5 % want 144.
    found(only(&scene(9), Some(&looks())), Trouble::Noisy, "20.0 %", "--spp 144");
    assert_eq!(of_scene(&scene(144), Some(&looks())), []);
}

#[test]
fn an_error_that_wants_too_many_paths_is_told() {
    let scene = Scene { method: Method::Paths, error: Some(1e-3), ..Scene::default() };
    // (0.6 / 0.001)^2.
    found(only(&scene, Some(&looks())), Trouble::Slow, "360000 samples", "--certify");
}

#[test]
fn a_long_run_is_predicted() {
    let cost = Cost { once_s: 1.0, picture_s: 4000.0, spread: 0.6 };
    found(
        only(&Scene::default(), Some(&Looks { cost: Ok(cost), ..looks() })),
        Trouble::Slow,
        "4001 core-seconds",
        "--shard",
    );
}

#[test]
fn wavelengths_that_make_no_colour_are_told() {
    let scene =
        |nm: &[f64]| Scene { wavelengths_nm: Wavelengths::new(nm.to_vec()).expect("valid"), ..Scene::default() };
    found(only(&scene(&[300.0, 320.0, 340.0, 360.0]), None), Trouble::Colour, "300 to 360 nm", "--wavelengths 16");
    found(only(&scene(&[450.0, 550.0]), None), Trouble::Colour, "2 wavelengths", "--spectral");
}

#[test]
fn what_is_slow_by_its_nature_is_told() {
    let judge = Scene { method: Method::Judge, spp: Some(7), ..Scene::default() };
    found(only(&judge, None), Trouble::Slow, "7 samples", "--method paths");
    let map = Scene { albedo: Albedo::Ground("earth".into()), ..Scene::default() };
    found(only(&map, None), Trouble::Slow, "65536 pixels", "--albedo");
    let many = Scene { wavelengths_nm: Wavelengths::visible(401).expect("valid"), ..Scene::default() };
    found(only(&many, None), Trouble::Slow, "26 packets", "--wavelengths 16");
    let exact = Scene { table_error: 1e-4, ..Scene::default() };
    found(only(&exact, None), Trouble::Slow, "0.01 %", "--table-error");
    // 4096^2 pixels of 16 wavelengths and 4 colours, 16 bytes each, and a count.
    let large = Scene { width: Some(4096), height: Some(4096), ..Scene::default() };
    found(only(&large, None), Trouble::Slow, "5.4 GB", "fewer pixels");
}

/// A picture of 2 x 2 grey pixels with these errors of luminance.
fn picture(y: [f32; 4], error: [f32; 4]) -> Channels {
    let samples = [("R", y), ("G", y), ("B", y), ("error.Y", error)];
    Channels { size: (2, 2), samples: samples.map(|(name, values)| (name.to_owned(), values.to_vec())).into() }
}

fn of(y: [f32; 4], error: [f32; 4], exposure_ev: f64) -> Vec<(Trouble, String)> {
    let seen = Seen { exposure_ev, samples: Some(16.0), noiseless: false, stopped: false };
    let findings = of_picture(&picture(y, error), &seen).expect("a picture");
    findings.into_iter().map(|Finding { trouble, what, remedy }| (trouble, format!("{what}: {remedy}"))).collect()
}

#[test]
fn pictures_show_what_is_wrong_with_them() {
    let one = |all: Vec<(Trouble, String)>| {
        let [one] = &all[..] else { panic!("{all:?}") };
        one.clone()
    };
    // White is 1.2 cd/m^2 at 0 EV.
    assert_eq!(of([0.3; 4], [0.003; 4], 0.0), []);
    found(one(of([0.0; 4], [0.0; 4], 0.0)), Trouble::Black, "4 pixels", "sun");
    found(one(of([300.0; 4], [3.0; 4], 0.0)), Trouble::BlownOut, "100 %", "--exposure 10.2");
    found(one(of([1e-4; 4], [1e-6; 4], 0.0)), Trouble::Black, "100 %", "--exposure -11.4");
    // 20 %, four times 5 %: sixteen times the samples.
    found(one(of([0.3; 4], [0.06; 4], 0.0)), Trouble::Noisy, "20.0 %", "--spp 256");
    found(one(of([0.3; 4], [0.0, 0.0, 0.0, f32::INFINITY], 0.0)), Trouble::Noisy, "two blocks", "--spp");
    found(one(of([0.3, 0.3, f32::NAN, 0.3], [0.003; 4], 0.0)), Trouble::Broken, "0,1", "--pixel 0,1");
    let nameless = Channels { samples: [("Z".to_owned(), vec![1.0; 4])].into(), ..picture([0.0; 4], [0.0; 4]) };
    assert!(of_picture(&nameless, &Seen { exposure_ev: 0.0, samples: None, noiseless: true, stopped: false }).is_err());
}

#[test]
fn looks_see_the_ground_and_the_light_of_a_scene() {
    let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
    let scene = Scene {
        flat: true,
        method: Method::Paths,
        camera: CameraKind::Pinhole,
        view_elevation_deg: Some(-60.0),
        ..Scene::default()
    };
    let looks = Looks::take(&scene, &data).expect("looks");
    assert_eq!((looks.to_ground, looks.luminances.len()), (144, 144));
    // A tenth of some 5e4 lux over pi, by sunlight alone.
    assert!((500.0..5000.0).contains(&looks.mean()), "{}", looks.mean());
    assert!(looks.cost.expect_err("not measured").contains("plane"));
}
