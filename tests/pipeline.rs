//! From raw data to a picture, and the committed tables are what the raw data make.

use airlight_tests::{Folder, data, root};
use renderer::data::Data;
use renderer::render::{Control, Sky, render};
use renderer::scene::Scene;
use renderer::spectrum::Wavelengths;
use std::sync::atomic::AtomicBool;
use tables::Kind;
use tables::views::{AerosolSource, Biome};
use tools::aerosol::bulk::Rule;
use tools::build::{Target, build_some};

/// Every table but most aerosols, which take longer: `airlight-tools build --check` compares them all.
fn targets() -> Vec<Target> {
    let aerosol = Target::Aerosol(AerosolSource::Jaenicke, Biome::RemoteContinental);
    Kind::ALL.into_iter().map(Target::Single).chain([aerosol]).collect()
}

fn build(folder: &Folder) {
    build_some(&root().join("raw-data"), folder.path(), &targets(), &Rule::TABLES, |_| {}).expect("built");
}

fn small() -> Scene {
    Scene {
        width: Some(8),
        height: Some(8),
        spp: Some(64),
        wavelengths_nm: Wavelengths::visible(8).expect("eight"),
        ..Scene::default()
    }
}

/// Luminance of the middle of a small picture, cd m^-2.
fn zenith_luminance(data: &Data, scene: &Scene) -> f64 {
    let sky = Sky::new(scene, data).expect("a valid scene");
    let rendering =
        render(scene, &sky, Control { stop: &AtomicBool::new(false), observe: &|_| {} }).expect("a picture");
    [27, 28, 35, 36].map(|pixel| rendering.film.luminance(pixel).mean).iter().sum::<f64>() / 4.0
}

#[test]
fn a_build_from_raw_data_gives_tables_that_render_as_the_committed_ones() {
    let folder = Folder::new("pipeline");
    build(&folder);
    let fresh = Data::load(folder.path()).expect("readable");
    let hazy = Scene {
        biome: Some(Biome::RemoteContinental),
        aerosol_source: AerosolSource::Jaenicke,
        aod: Some(0.2),
        ..small()
    };
    for scene in [small(), hazy] {
        let (a, b) = (zenith_luminance(&fresh, &scene), zenith_luminance(&data(), &scene));
        // Same paths, tables equal to their tolerances (last bits).
        assert!((a / b - 1.0).abs() < 1e-4, "{a} and {b} cd/m2");
    }
}

#[test]
fn a_second_build_gives_the_same_bytes() {
    let folders = [Folder::new("twice-a"), Folder::new("twice-b")];
    folders.iter().for_each(build);
    for entry in std::fs::read_dir(folders[0].path()).expect("listed") {
        let name = entry.expect("entry").file_name();
        let [a, b] = [0, 1].map(|i| std::fs::read(folders[i].path().join(&name)).expect("read"));
        assert!(a == b, "{name:?} differs between two builds");
    }
}

#[test]
fn the_clear_sky_has_the_colours_and_levels_of_the_sky() {
    // Sun at 60 degrees, no aerosol: zenith between 1000 and 5000 cd/m2, red over blue (linear sRGB) 0.2
    // to 0.4 (0.26 to 0.29 for a noon sky by independent renderers).
    let scene = Scene { sun_elevation_deg: 60.0, ..small() };
    let sky = Sky::new(&scene, &data()).expect("a valid scene");
    let rendering =
        render(&scene, &sky, Control { stop: &AtomicBool::new(false), observe: &|_| {} }).expect("a picture");
    let [red, _, blue] = rendering.film.rgb(27).map(|estimate| estimate.mean);
    let luminance = rendering.film.luminance(27).mean;
    assert!((1000.0..5000.0).contains(&luminance), "zenith at {luminance} cd/m2");
    assert!((0.2..0.4).contains(&(red / blue)), "red over blue {}", red / blue);
}
