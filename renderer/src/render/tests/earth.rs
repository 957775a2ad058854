//! The map of the Earth under the air.

#![allow(clippy::print_stdout, reason = "the figures found: cargo test -- --nocapture shows them")]

use super::*;
use crate::scene::Albedo;

/// A view down on the map, from the tables.
fn down(altitude_km: f64, (latitude_deg, longitude_deg): (f64, f64), fov_deg: f64, side: u32) -> Scene {
    Scene {
        altitude_km,
        latitude_deg,
        longitude_deg: Some(longitude_deg),
        albedo: Albedo::Ground("earth".into()),
        sun_elevation_deg: 50.0,
        camera: CameraKind::Pinhole,
        fov_deg: Some(fov_deg),
        view_elevation_deg: Some(-90.0),
        width: Some(side),
        height: Some(side),
        spp: None,
        method: Method::Solved,
        ..small()
    }
}

#[test]
fn tables_show_wide_lands_and_seas_as_paths_do() {
    // The Sahara, the open Atlantic and the ice of Greenland, in one pixel of half a degree: 7 km, less than a pixel of the map.
    for place in [(22.0, 12.0), (30.0, -45.0), (74.0, -40.0)] {
        let scene = down(800.0, place, 0.5, 1);
        let solved = render(&scene, &sky(&scene), RUN).expect("finite").film;
        let scene = Scene { method: Method::Paths, spp: Some(4096), ..scene };
        let paths = render(&scene, &sky(&scene), RUN).expect("finite").film;
        for index in 0..3 {
            let (table, traced) = (solved.radiance(0, index).mean, paths.radiance(0, index));
            let (off, noise) = (table / traced.mean - 1.0, traced.error / traced.mean);
            // The ground within the ten or twenty kilometres that the air mixes differs a little from that in the pixel.
            assert!(off.abs() < 0.02 + 4.0 * noise, "{place:?} {index}: {off} +- {noise}");
        }
    }
}

#[test]
#[ignore = "a minute: cargo test -p renderer --lib the_whole_earth -- --ignored --nocapture prints what docs/earth.md says"]
fn the_whole_earth_by_tables_is_that_of_paths() {
    let scene = down(36_000.0, (15.0, -20.0), 20.0, 24);
    // Both look anywhere in the pixel, for coasts run through it.
    let solved = Scene { spp: Some(256), ..scene.clone() };
    let solved = render(&solved, &sky(&solved), RUN).expect("finite").film;
    let paths = Scene { method: Method::Paths, spp: Some(2048), ..scene };
    let paths = render(&paths, &sky(&paths), RUN).expect("finite").film;
    for (index, nm) in [450, 550, 650].into_iter().enumerate() {
        let all: Vec<_> =
            (0..24 * 24).map(|pixel| (solved.radiance(pixel, index).mean, paths.radiance(pixel, index))).collect();
        let brightest = all.iter().map(|(_, traced)| traced.mean).fold(0.0, f64::max);
        // By day: light above a tenth of the brightest.
        let day: Vec<_> = all.iter().filter(|(_, traced)| traced.mean > 0.1 * brightest).collect();
        let of = |f: &dyn Fn(f64, f64) -> f64| {
            day.iter().map(|(table, traced)| f(table / traced.mean - 1.0, traced.error / traced.mean)).sum::<f64>()
                / day.len() as f64
        };
        let (mean, square, noise) = (of(&|off, _| off), of(&|off, _| off * off), of(&|_, noise| noise * noise));
        let rms = (square - noise).max(0.0).sqrt();
        println!(
            "{nm} nm: {} pixels, mean {:+.2} %, rms {:.2} % beside noise of {:.2} %",
            day.len(),
            100.0 * mean,
            100.0 * rms,
            100.0 * noise.sqrt()
        );
        assert!(rms < 0.05, "{nm}: {rms}");
    }
}

#[test]
fn the_map_is_refused_where_nobody_knows_it() {
    let scene = Scene { albedo: Albedo::Ground("earth".into()), method: Method::Single, ..small() };
    assert!(scene.validate().expect_err("one order").to_string().contains("--method solved"));
    let scene = Scene { flat: true, method: Method::Paths, ..scene };
    assert!(scene.validate().expect_err("flat").to_string().contains("sphere"));
}
