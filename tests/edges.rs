//! The edges of the stability maps (docs/stability.md), from both sides: within, a method keeps its bound; beyond, it refuses with a
//! sentence or states an error that the true one does not exceed by more than a factor of two.

use airlight_tests::data;
use glam::DVec3;
use renderer::render::{RenderError, Sky};
use renderer::sampling::{Sampler, spiral};
use renderer::scene::{CameraKind, Scene};
use renderer::spectrum::Wavelengths;
use renderer::transport::Method;
use tables::views::Biome;

/// One wavelength and a small picture.
fn small() -> Scene {
    let wavelengths_nm = Wavelengths::new(vec![500.0]).expect("one");
    // What is followed must not depend on the error that is asked.
    let follow_polarisation = Some(false);
    Scene { wavelengths_nm, width: Some(24), height: Some(24), follow_polarisation, ..Scene::default() }
}

fn sky(scene: &Scene) -> Result<Sky, RenderError> {
    scene.validate().expect("a scene that can be");
    Sky::new(scene, &data())
}

fn seen(sky: &Sky, direction: DVec3) -> f64 {
    let mut factors = vec![0.0; sky.wavelengths()];
    sky.radiance(direction, &Sampler::new(1, 0, 0), &mut factors);
    factors[0]
}

/// Rms difference of two skies over the mean of the second, in 64 directions above the horizon.
fn off(found: &Sky, right: &Sky) -> f64 {
    let directions: Vec<DVec3> = (0..64).map(|i| spiral(i, 64, [0.0, 1.0])).collect();
    off_in(found, right, &directions)
}

fn off_in(found: &Sky, right: &Sky, directions: &[DVec3]) -> f64 {
    let n = directions.len() as f64;
    let pairs = directions.iter().map(|&direction| (seen(found, direction), seen(right, direction)));
    let (squares, sum) = pairs.fold((0.0, 0.0), |(squares, sum), (a, b)| (squares + (a - b).powi(2), sum + b));
    (squares / n).sqrt() / (sum / n)
}

/// The usual tables and the finest.
fn solved(scene: &Scene) -> [Result<Sky, RenderError>; 2] {
    [1.0, 1e-5].map(|table_error| sky(&Scene { table_error, ..scene.clone() }))
}

#[test]
fn solved_tables_state_their_error_down_to_where_they_refuse() {
    for (elevation, most) in [(30.0, 1e-3), (0.0, 5e-3), (-6.0, 2e-2), (-12.0, 1e-1)] {
        let [usual, finest] = solved(&Scene { sun_elevation_deg: elevation, ..small() });
        let (usual, finest) = (usual.expect("answers"), finest.expect("answers"));
        let (stated, off) = (usual.table_error().expect("solved"), off(&usual, &finest));
        assert!(off < 2.0 * stated && off < most, "sun at {elevation}: off by {off:e}, states {stated:e}");
    }
    let error = sky(&Scene { sun_elevation_deg: -17.0, table_error: 1.0, ..small() }).expect_err("refused");
    assert!(error.to_string().contains("the sun is too low for it, or the air too thick"), "{error}");
}

#[test]
fn solved_tables_of_thick_soot_refuse() {
    let urban = |aod| Scene { biome: Some(Biome::Urban), aod: Some(aod), table_error: 1.0, ..small() };
    let thin = sky(&urban(0.5)).expect("answers").table_error().expect("solved");
    assert!(thin < 2e-2, "{thin:e}");
    let error = sky(&Scene { sun_elevation_deg: -12.0, ..urban(6.0) }).expect_err("refused");
    assert!(error.to_string().contains("too thick"), "{error}");
}

#[test]
fn pictures_of_the_limb_state_its_error_not_that_of_the_disc() {
    // Lines that turn at 40 km, where levels lie far apart, seen from 400 km; the Earth's disc is ten times as exact.
    let turn = |km: f64| ((6371.0 + km) / 6771.0_f64).acos().to_degrees();
    let limb = Scene {
        altitude_km: 400.0,
        sun_elevation_deg: 45.0,
        camera: CameraKind::Pinhole,
        fov_deg: Some(1.0),
        view_elevation_deg: Some(-turn(40.0)),
        ..small()
    };
    let disc = Scene { view_elevation_deg: Some(-90.0), ..limb.clone() };
    let [usual, finest] = solved(&limb).map(|sky| sky.expect("answers"));
    let camera = limb.camera();
    let directions: Vec<DVec3> = (0..24).filter_map(|y| camera.direction(12.0, f64::from(y) + 0.5)).collect();
    let (stated, off) = (usual.table_error().expect("solved"), off_in(&usual, &finest, &directions));
    let below = sky(&Scene { table_error: 1.0, ..disc }).expect("answers").table_error().expect("solved");
    assert!(off < 2.0 * stated, "off by {off:e}, states {stated:e}");
    assert!(stated > 2.0 * below, "states {stated:e} of the limb, {below:e} of the disc");
}

#[test]
fn cheap_methods_state_what_they_leave_out() {
    // Clear by day, haze, twilight: what single scattering and its closure state beside how far they are off solved tables.
    let hazy = Scene { biome: Some(Biome::Rural), aod: Some(0.4), ..small() };
    for (scene, single_most) in [
        (Scene { sun_elevation_deg: 40.0, ..small() }, 0.5),
        (Scene { sun_elevation_deg: -4.0, ..small() }, 0.8),
        (Scene { sun_elevation_deg: 20.0, ..hazy }, 0.9),
    ] {
        let right = sky(&Scene { table_error: 1.0, ..scene.clone() }).expect("answers");
        for method in [Method::Single, Method::Isotropic] {
            let found = sky(&Scene { method, ..scene.clone() }).expect("answers");
            let (stated, off) = (found.stated().expect("states"), off(&found, &right));
            let what = format!("{method:?}, sun at {}: off by {off:e}, states {stated:?}", scene.sun_elevation_deg);
            assert!(off < 2.0 * stated.whole() && off < single_most, "{what}");
        }
    }
    assert!(sky(&Scene { method: Method::Oneil, ..small() }).expect("answers").stated().is_none());
}

#[test]
fn few_points_on_a_line_are_seen() {
    // Two points are off by more than a tenth, 64 by less than a percent, and both say so.
    let single = |steps| sky(&Scene { method: Method::Single, sun_elevation_deg: 20.0, steps: Some(steps), ..small() });
    let best = single(2048).expect("answers");
    for (steps, low, high) in [(2, 0.02, 1.0), (64, 0.0, 5e-3)] {
        let few = single(steps).expect("answers");
        let (stated, off) = (few.stated().expect("states").points, off(&few, &best));
        assert!(off < 2.0 * stated && (low..high).contains(&off), "{steps}: off by {off:e}, states {stated:e}");
    }
}
