//! Behaviour of whole pictures, on the tables of the repository.

use super::*;
use crate::data::Data;
use crate::scene::CameraKind;
use crate::spectrum::Wavelengths;
use std::path::Path;

static NEVER: AtomicBool = AtomicBool::new(false);
const RUN: Control<'static> = Control { stop: &NEVER, observe: &|_| {} };

fn small() -> Scene {
    Scene {
        width: Some(12),
        height: Some(10),
        spp: Some(3),
        wavelengths_nm: Wavelengths::new(vec![450.0, 550.0, 650.0]).expect("valid"),
        ..Scene::default()
    }
}

fn sky(scene: &Scene) -> Sky {
    scene.validate().expect("valid");
    let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
    Sky::new(scene, &data).expect("a sky")
}

#[test]
fn any_number_of_threads_gives_the_same_picture() {
    let scene = small();
    let sky = sky(&scene);
    let picture = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let rendering = pool.install(|| render(&scene, &sky, RUN)).expect("finite");
        (format!("{:?}", rendering.film), pool.install(|| Summary::new(&sky, 7, &NEVER)))
    };
    assert_eq!(picture(1), picture(3));
}

#[test]
fn a_replayed_sample_is_the_one_in_the_picture() {
    let scene = Scene { spp: Some(1), ..small() };
    let sky = sky(&scene);
    let film = render(&scene, &sky, RUN).expect("finite").film;
    let (direction, factors) = replay(&scene, &sky, 7, 3, 0).expect("inside");
    assert!(direction.z > 0.0);
    for (index, factor) in factors.iter().enumerate() {
        assert_eq!(film.radiance(3 * 12 + 7, index).mean, factor * sky.irradiance_w_m2_nm()[index]);
    }
    assert!(replay(&scene, &sky, 0, 0, 0).is_none() && film.samples(0) == 0, "the corner is outside the circle");
}

#[test]
fn a_picture_goes_on_until_its_error_is_reached_or_it_is_stopped() {
    let scene = Scene { spp: None, error: Some(0.2), ..small() };
    let sky = sky(&scene);
    let rendering = render(&scene, &sky, RUN).expect("finite");
    assert!(rendering.errors.relative <= 0.2 && !rendering.stopped, "{:?}", rendering.errors);
    let limited = render(&Scene { spp: Some(5), error: Some(1e-5), ..small() }, &sky, RUN).expect("finite");
    assert_eq!((limited.film.most_samples(), limited.stopped), (5, false));
    let stop = AtomicBool::new(true);
    let stopped = render(&scene, &sky, Control { stop: &stop, observe: &|_| {} }).expect("finite");
    assert!(stopped.stopped && stopped.film.total_samples() == 0);
}

#[test]
fn the_sun_in_the_picture_gives_the_sunlight_on_the_ground() {
    // A pinhole of 2 degrees: solid angle of a pixel (2 tan 1 / n)^2 cos^3, cos^3 within 5e-4 of 1 here.
    // A fisheye of 30 degrees: (30 degrees / n)^2 sinc; the sun in its middle, where sinc is 1.
    for (camera, fov_deg, n) in [(CameraKind::Pinhole, 2.0, 48), (CameraKind::Fisheye, 30.0, 40)] {
        let scene = Scene {
            camera,
            fov_deg: Some(fov_deg),
            view_azimuth_deg: Some(180.0),
            view_elevation_deg: Some(30.1),
            width: Some(n),
            height: Some(n),
            ..small()
        };
        let sky = sky(&scene);
        let pixel = fov_deg.to_radians() / f64::from(n);
        let mut irradiance = [0.0; 3];
        for factors in disc_layer(&scene, &sky).values() {
            for (sum, factor) in irradiance.iter_mut().zip(factors) {
                *sum += factor * pixel * pixel * 0.5;
            }
        }
        for (got, direct) in irradiance.iter().zip(sky.direct_irradiance()) {
            // The cosine is 1/2 within 4e-3 over the disc and even about its middle; the grid resolves
            // 1/32 of the radius, so the disc's area is right to about 1e-3.
            assert!((got / direct - 1.0).abs() < 3e-3, "{got} for {direct} with {camera:?}");
        }
    }
}

#[test]
fn direct_sunlight_follows_beer_and_lambert() {
    let scene = Scene { sun_elevation_deg: 90.0, ozone_du: Some(0.0), ..small() };
    // Without ozone the vertical optical depth at 550 nm is 0.0971 to 0.0972 (Bucholtz 1995).
    let direct = sky(&scene).direct_irradiance()[1];
    assert!((direct - (-0.0971_f64).exp()).abs() < 2e-4, "{direct}");
    let night = sky(&Scene { sun_elevation_deg: -1.0, ..small() });
    assert_eq!(night.direct_irradiance(), [0.0; 3]);
}

#[test]
fn above_the_atmosphere_the_zenith_is_black() {
    let scene = Scene { altitude_km: 400.0, ..small() };
    let sky = sky(&scene);
    let summary = Summary::new(&sky, 0, &NEVER);
    assert_eq!((summary.zenith_cd_m2.mean, summary.sky_lux.mean), (0.0, 0.0));
    // 133.1 klux above the atmosphere (G173), times sin 30 degrees; three wavelengths
    // carry a constant exactly.
    assert!((summary.sun_lux / 66_550.0 - 1.0).abs() < 5e-3, "{}", summary.sun_lux);
    // Seen from space the middle of the picture is the ground, lit through the air.
    let film = render(&scene, &sky, RUN).expect("finite").film;
    assert!(film.luminance(5 * 12 + 6).mean > 1000.0);
}

#[test]
fn progress_never_passes_the_whole() {
    let work = Work { taken: 8, limit: 64, error: f64::INFINITY, wanted: None };
    assert!((work.fraction(8.0) - 0.25).abs() < 1e-12 && work.fraction(100.0) == 1.0);
    // Twice the wanted error after 8 samples: 32 are needed.
    let work = Work { taken: 8, limit: u32::MAX, error: 0.02, wanted: Some(0.01) };
    assert!((work.fraction(0.0) - 0.25).abs() < 1e-12);
}
