//! Counterparts of figures 6.1 to 6.9 of the thesis (Gavin 2020): ozone by month at the latitude of Arosa, whose columns it took.

use super::{Exposure, Figure, Panel, fisheye, panel, pinhole};
use crate::scene::{Albedo, Scene};
use tables::views::Biome;

/// Width and height of a fisheye in pixels.
const SIDE: u32 = 256;

/// The aerosols of figures 6.6 and 6.7.
const THREE: [Biome; 3] = [Biome::DesertDust, Biome::MaritimeMineral, Biome::PolarArctic];

/// In that month, over Arosa (46.8 degrees north), with that aerosol.
fn of(month: u8, biome: Option<Biome>, scene: Scene) -> Scene {
    Scene { month, latitude_deg: 46.8, biome, ..scene }
}

/// A figure with one exposure.
fn figure(
    number: &'static str,
    name: &'static str,
    caption: &'static str,
    columns: usize,
    panels: Vec<Panel>,
) -> Figure {
    Figure { name, thesis: Some(number), caption, columns, exposure: Exposure::Figure, panels }
}

/// All nine, in order.
pub(super) fn figures() -> Vec<Figure> {
    vec![limb(), earth(), horizon(), clear(), load(), kinds(), months(), twilight(), low_sun()]
}

fn limb() -> Figure {
    let scene = Scene { altitude_km: 400.0, spp: Some(4), ..pinhole((512, 256), 36.0, 12.0) };
    let panels = vec![panel("limb", "the limb of the Earth from 400 km", of(1, None, scene))];
    figure("6.1", "limb", "The limb of the Earth from 400 km without aerosol.", 1, panels)
}

fn earth() -> Figure {
    let of = |(name, aod): (&str, f64)| {
        let scene = Scene {
            altitude_km: 36_000.0,
            view_elevation_deg: Some(-90.0),
            aod: Some(aod),
            albedo: Albedo::Ground("ocean".into()),
            spp: Some(16),
            ..pinhole((192, 192), 18.6, 45.0)
        };
        let line = format!("the Earth from 36 000 km, desert dust of optical depth {aod} over an ocean");
        panel(format!("earth-{name}-dust"), line, of(1, Some(Biome::DesertDust), scene))
    };
    let panels = [("thin", 0.1), ("some", 0.5), ("dense", 2.0)].map(of).into();
    figure(
        "6.2",
        "earth",
        "The Earth from 36 000 km, all ocean, under desert dust of optical depth 0.1, 0.5 and 2 at 550 nm.",
        3,
        panels,
    )
}

fn horizon() -> Figure {
    let of = |(name, sun): (&str, f64)| {
        let scene = Scene { view_elevation_deg: Some(12.0), ..pinhole((320, 214), 70.0, sun) };
        let line = format!("towards the horizon below the sun at {sun} degrees, February");
        panel(format!("horizon-{name}-sun"), line, of(2, None, scene))
    };
    let panels = [("high", 60.0), ("low", 0.0)].map(of).into();
    figure(
        "6.3",
        "horizon",
        "Towards the horizon without aerosol in February, the sun at 60 and at 0 degrees.",
        2,
        panels,
    )
}

fn clear() -> Figure {
    let of = |(name, sun): (&str, f64)| {
        let line = format!("the sky without aerosol, the sun at {sun} degrees, January");
        panel(format!("clear-{name}"), line, of(1, None, fisheye(SIDE, sun)))
    };
    let panels = [("zenith-sun", 90.0), ("low-sun", 5.0), ("twilight", -5.0)].map(of).into();
    figure(
        "6.4",
        "clear",
        "The sky without aerosol in January, the sun at 90, 5 and -5 degrees: the last is all but black at the exposure of the others.",
        3,
        panels,
    )
}

fn load() -> Figure {
    let of = |(name, aod): (&str, f64)| {
        let scene = Scene { aod: Some(aod), ..fisheye(SIDE, 90.0) };
        let line = format!("desert dust of optical depth {aod}, the sun in the zenith");
        panel(format!("dust-load-{name}"), line, of(1, Some(Biome::DesertDust), scene))
    };
    let panels = [("1", 0.1), ("2", 0.4), ("3", 1.0), ("4", 2.5)].map(of).into();
    figure(
        "6.5",
        "dust-load",
        "Desert dust of optical depth 0.1, 0.4, 1 and 2.5 at 550 nm in January, the sun in the zenith.",
        4,
        panels,
    )
}

fn kinds() -> Figure {
    let of = |biome: Biome| {
        let line = format!("{biome}, the sun in the zenith");
        panel(format!("{biome}-zenith-sun"), line, of(1, Some(biome), fisheye(SIDE, 90.0)))
    };
    let caption = "Desert dust, maritime mineral and polar arctic aerosol of their own amounts in January, the sun in the zenith.";
    figure("6.6", "kinds", caption, 3, THREE.map(of).into())
}

fn months() -> Figure {
    let of = |(name, month): (&str, u8), biome: Biome| {
        let line = format!("{biome}, the sun at 30 degrees, month {month}");
        panel(format!("{biome}-{name}"), line, of(month, Some(biome), fisheye(SIDE, 30.0)))
    };
    let rows = [("january", 1), ("november", 11)];
    let panels = rows.into_iter().flat_map(|row| THREE.map(|biome| of(row, biome))).collect();
    figure(
        "6.7",
        "kinds-months",
        "Desert dust, maritime mineral and polar arctic aerosol, the sun at 30 degrees, in January (above) and November (below).",
        3,
        panels,
    )
}

fn twilight() -> Figure {
    let of = |(name, month): (&str, u8)| {
        let line = format!("background aerosol, the sun at -5 degrees, month {month}");
        panel(format!("twilight-{name}"), line, of(month, Some(Biome::Background), fisheye(SIDE, -5.0)))
    };
    let panels = [("january", 1), ("november", 11)].map(of).into();
    figure("6.8", "twilight", "Background aerosol, the sun at -5 degrees, in January and November.", 2, panels)
}

fn low_sun() -> Figure {
    let scene = Scene { aod: Some(0.3), view_elevation_deg: Some(15.0), ..pinhole((512, 288), 100.0, 4.0) };
    let panels = vec![panel(
        "dust-low-sun",
        "desert dust, the sun at 4 degrees, a wide lens",
        of(1, Some(Biome::DesertDust), scene),
    )];
    figure(
        "6.9",
        "dust-low-sun",
        "Desert dust of optical depth 0.3, the sun at 4 degrees, through a lens of 100 degrees.",
        1,
        panels,
    )
}
