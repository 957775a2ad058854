//! Pictures beyond the thesis.

use super::{Exposure, Figure, Panel, View, fisheye, panel, pinhole};
use crate::scene::Scene;
use crate::spectrum::Scheme;
use tables::views::Biome;

pub(super) fn figures() -> Vec<Figure> {
    vec![biomes(), blue_hours(), suns(), belt(), ascent(), ozone(), polarisation(), rungs()]
}

fn figure(name: &'static str, caption: &'static str, columns: usize, exposure: Exposure, panels: Vec<Panel>) -> Figure {
    Figure { name, thesis: None, caption, columns, exposure, panels }
}

fn biomes() -> Figure {
    let of = |biome: Biome| {
        let scene = Scene { biome: Some(biome), ..fisheye(192, 30.0) };
        panel(format!("biome-{biome}"), format!("{biome} of its own amount, the sun at 30 degrees"), scene)
    };
    let caption = "The nine biomes, each of its own amount, the sun at 30 degrees: background, desert dust, maritime clean; maritime \
                   mineral, polar antarctic, polar arctic; remote continental, rural, urban. One exposure.";
    figure("biomes", caption, 3, Exposure::Figure, Biome::ALL.map(of).into())
}

fn blue_hours() -> Figure {
    let of = |month: u8| {
        let scene = Scene { month, ..fisheye(160, -6.0) };
        panel(format!("blue-hour-{month}"), format!("the blue hour, the sun at -6 degrees, month {month}"), scene)
    };
    let caption = "The blue hour, the sun at -6 degrees, 45 degrees north: January to December, six a row. One exposure; only ozone differs.";
    figure("blue-hours", caption, 6, Exposure::Figure, (1..=12).map(of).collect())
}

fn suns() -> Figure {
    let of = |step: u32| {
        let elevation = 60.0 - 6.0 * f64::from(step);
        let name = if elevation < 0.0 { format!("sun-below-{}", -elevation) } else { format!("sun-{elevation}") };
        panel(name, format!("the sky without aerosol, the sun at {elevation} degrees"), fisheye(128, elevation))
    };
    let caption =
        "The sky without aerosol, the sun from 60 to -12 degrees in steps of 6. Each with an exposure of its own.";
    figure("suns", caption, 13, Exposure::Panel, (0..13).map(of).collect())
}

fn belt() -> Figure {
    let of = |(name, sun): (&str, f64)| {
        let scene = Scene {
            biome: Some(Biome::MaritimeClean),
            aod: Some(0.05),
            view_azimuth_deg: Some(0.0),
            view_elevation_deg: Some(10.0),
            ..pinhole((384, 144), 70.0, sun)
        };
        panel(
            format!("belt-of-venus-{name}"),
            format!("away from the sun at {sun} degrees: the shadow of the Earth below the Belt of Venus"),
            scene,
        )
    };
    let caption = "The Belt of Venus: away from the sun at 0, -1, -2, -3, -4 and -5 degrees the blue-grey shadow of the Earth rises \
                   under a pink band. Each with an exposure of its own.";
    let panels = [("0", 0.0), ("1", -1.0), ("2", -2.0), ("3", -3.0), ("4", -4.0), ("5", -5.0)].map(of).into();
    figure("belt-of-venus", caption, 2, Exposure::Panel, panels)
}

fn ascent() -> Figure {
    let of = |altitude_km: f64| {
        let scene = Scene {
            altitude_km,
            biome: Some(Biome::RemoteContinental),
            // The horizon of the ground, acos(R / (R + h)) below the horizontal.
            view_elevation_deg: Some(-(6371.0 / (6371.0 + altitude_km)).acos().to_degrees()),
            spp: Some(4),
            ..pinhole((192, 144), 60.0, 25.0)
        };
        let scene = Scene { view_azimuth_deg: Some(90.0), ..scene };
        panel(format!("ascent-{altitude_km}"), format!("towards the horizon from {altitude_km} km"), scene)
    };
    let caption = "Towards the horizon from 0, 5, 10, 20, 40, 80, 160 and 400 km, the sun 25 degrees high on the right. One exposure.";
    let panels = [0.0, 5.0, 10.0, 20.0, 40.0, 80.0, 160.0, 400.0].map(of).into();
    figure("ascent", caption, 4, Exposure::Figure, panels)
}

fn ozone() -> Figure {
    let of = |(name, sun): (&str, f64), (what, ozone_du): (&str, f64)| {
        let scene = Scene { ozone_du: Some(ozone_du), ..fisheye(256, sun) };
        panel(format!("{what}-{name}"), format!("{ozone_du} DU of ozone, the sun at {sun} degrees"), scene)
    };
    let rows = [("low-sun", 2.0), ("blue-hour", -5.0)];
    let both = [("ozone", 340.0), ("no-ozone", 0.0)];
    let caption = "With 340 DU of ozone (left) and without (right), the sun at 2 (above) and -5 degrees (below): the blue of twilight is \
                   ozone's. One exposure a row.";
    let panels = rows.into_iter().flat_map(|row| both.map(|amount| of(row, amount))).collect();
    figure("ozone", caption, 2, Exposure::Row, panels)
}

fn polarisation() -> Figure {
    let sky = || fisheye(256, 15.0);
    let seen = Panel {
        views: &[View::Colour, View::Degree, View::Angle],
        ..panel("polarised", "polarised light, the sun at 15 degrees", Scene { polarisation: true, ..sky() })
    };
    let filtered = |filter: f64| {
        let scene = Scene { filter_deg: Some(filter), ..sky() };
        panel(format!("filter-{filter}"), format!("through a filter at {filter} degrees from the horizontal"), scene)
    };
    let caption = "Polarised light, the sun at 15 degrees: the sky, its degree of polarisation (black 0, white 1) and its angle (red \
                   horizontal, cyan vertical); below, through filters at 0, 45 and 90 degrees from the horizontal of each pixel. One exposure.";
    let mut panels = vec![seen];
    panels.extend([0.0, 45.0, 90.0].map(filtered));
    figure("polarisation", caption, 3, Exposure::Figure, panels)
}

fn rungs() -> Figure {
    let of = |(name, sun): (&str, f64), (what, colour): (&str, Scheme)| {
        let scene = Scene { colour, ..fisheye(192, sun) };
        panel(format!("{what}-{name}"), format!("{} wavelengths, the sun at {sun} degrees", colour.name()), scene)
    };
    let rows = [("day", 30.0), ("sunset", 0.0), ("dusk", -6.0)];
    let schemes = [("spectral", Scheme::Spectral), ("rgb", Scheme::Rgb), ("four", Scheme::Four)];
    let caption = "Sixteen wavelengths, three that stand for red, green and blue, and four by a published matrix, the sun at 30, 0 and \
                   -6 degrees. One exposure a row.";
    let panels = rows.into_iter().flat_map(|row| schemes.map(|scheme| of(row, scheme))).collect();
    figure("rungs", caption, 3, Exposure::Row, panels)
}
