//! A figure made: its panels rendered, exposed together and put side by side.

use super::{Figure, View};
use crate::data::Data;
use crate::film::{Development, Picture, png, tone};
use crate::polarisation::Stokes;
use crate::render::{Control, End, Progress, RenderError, Sky, disc_layer, render};
use crate::scene::{CameraKind, Scene};
use std::path::Path;

/// Pixels between two pictures, and the code of their grey.
const GAP: u32 = 4;
const GAP_GREY: u8 = 64;

/// A figure as it is shown.
#[derive(Debug, Clone, PartialEq)]
pub struct Made {
    /// Width and height in pixels.
    pub size: (u32, u32),
    /// Eight-bit sRGB, row by row.
    pub pixels: Vec<u8>,
    /// The exposure value of each picture, row by row.
    pub exposures_ev: Vec<f64>,
    /// The largest error that the tables of its panels state.
    pub table_error: f64,
}

/// What figures are made with.
#[derive(Clone, Copy)]
pub struct Work<'a> {
    /// The tables of matter.
    pub data: &'a Data,
    /// Where solved tables are kept, if they are.
    pub kept: Option<&'a Path>,
    /// What stops the work, and who hears of it: the fraction is that of the figure.
    pub control: Control<'a>,
}

/// A picture before it is exposed.
#[derive(Debug)]
struct Cell {
    size: (u32, u32),
    view: View,
    /// Linear sRGB in cd/m^2 with the disc, and luminance without it.
    rgb: Vec<[f64; 3]>,
    luminances: Vec<f64>,
    /// Where another view than colour is asked for.
    stokes: Vec<Stokes>,
    scene: Scene,
    sun_white: [f64; 3],
}

/// Makes a figure; `None` if it was stopped. Panels of the same air share their solved tables, where these state no more than the error that
/// the scene allows.
///
/// # Errors
/// [`RenderError`] of the first panel that cannot be rendered.
pub fn make(figure: &Figure, work: Work<'_>) -> Result<Option<Made>, RenderError> {
    let (mut cells, mut table_error) = (Vec::new(), 0.0_f64);
    let mut last: Option<(&Scene, Sky)> = None;
    for (index, panel) in figure.panels.iter().enumerate() {
        let scene = &panel.scene;
        let sky = turned(last.take(), scene, work)?;
        table_error = table_error.max(sky.table_error().unwrap_or(f64::INFINITY));
        let share = |part: f64| (index as f64 + part) / figure.panels.len() as f64;
        let observe = |progress: Progress| {
            (work.control.observe)(Progress { fraction: share(progress.fraction), ..progress });
        };
        let rendering = render(scene, &sky, Control { stop: work.control.stop, observe: &observe })?;
        if rendering.end == End::Stopped {
            return Ok(None);
        }
        let disc = disc_layer(scene, &sky);
        let picture = Picture { film: &rendering.film, disc: &disc, colour: sky.colour() };
        cells.extend(panel.views.iter().map(|view| Cell {
            size: scene.size(),
            view: *view,
            rgb: picture.rgbs().collect(),
            luminances: rendering.film.luminances().collect(),
            stokes: (0..rendering.film.pixels()).map_while(|pixel| picture.stokes(pixel)).collect(),
            scene: scene.clone(),
            sun_white: sky.sun_white(),
        }));
        last = Some((scene, sky));
    }
    Ok(Some(mounted(figure, &cells, table_error)))
}

/// A sky for a scene: the last one turned, if it has the same air and its tables are exact enough there too.
fn turned(last: Option<(&Scene, Sky)>, scene: &Scene, work: Work<'_>) -> Result<Sky, RenderError> {
    if let Some((_, mut sky)) = last.filter(|(before, _)| same_air(before, scene)) {
        // Turned to a view for which its tables are too far off, it is of neither scene.
        let exact = sky.turn(scene).is_ok() && sky.table_error().is_some_and(|error| error <= scene.table_error);
        if exact {
            return Ok(sky);
        }
    }
    Sky::kept(scene, work.data, work.kept)
}

/// Whether two scenes differ in sun, observer and camera alone.
fn same_air(a: &Scene, b: &Scene) -> bool {
    let [a, b] = [a, b].map(|scene| Scene {
        sun_elevation_deg: 0.0,
        sun_azimuth_deg: 0.0,
        altitude_km: 0.0,
        camera: CameraKind::Fisheye,
        fov_deg: None,
        view_azimuth_deg: None,
        view_elevation_deg: None,
        width: None,
        height: None,
        spp: None,
        ..scene.clone()
    });
    a == b
}

/// The exposure value of each picture: the median of the automatic ones of all those that share it.
fn exposures_ev(figure: &Figure, cells: &[Cell]) -> Vec<f64> {
    let own: Vec<f64> = cells.iter().map(|cell| tone::automatic_ev(cell.luminances.iter().copied())).collect();
    let of = |group: usize| {
        let mut ours: Vec<f64> =
            (0..own.len()).filter(|cell| figure.group(*cell) == group).map(|cell| own[cell]).collect();
        ours.sort_by(f64::total_cmp);
        // Of an even number the mean of the two in the middle.
        0.5 * (ours[(ours.len() - 1) / 2] + ours[ours.len() / 2])
    };
    let groups = (0..cells.len()).map(|cell| figure.group(cell)).max().map_or(0, |last| last + 1);
    let of: Vec<f64> = (0..groups).map(of).collect();
    (0..cells.len()).map(|cell| of[figure.group(cell)]).collect()
}

/// All pictures side by side, with a thin line between.
fn mounted(figure: &Figure, cells: &[Cell], table_error: f64) -> Made {
    let exposures_ev = exposures_ev(figure, cells);
    let (width, height) = cells.first().map_or((1, 1), |cell| cell.size);
    let (columns, rows) = (figure.columns as u32, cells.len().div_ceil(figure.columns) as u32);
    let size = (columns * (width + GAP) - GAP, rows * (height + GAP) - GAP);
    let mut pixels = vec![GAP_GREY; 3 * size.0 as usize * size.1 as usize];
    for (index, (cell, exposure_ev)) in cells.iter().zip(&exposures_ev).enumerate() {
        let (column, row) = ((index % figure.columns) as u32, (index / figure.columns) as u32);
        let bytes = cell.bytes(*exposure_ev);
        for (y, line) in bytes.chunks_exact(3 * width as usize).enumerate() {
            let y = (row * (height + GAP)) as usize + y;
            let first = 3 * (y * size.0 as usize + (column * (width + GAP)) as usize);
            pixels[first..first + line.len()].copy_from_slice(line);
        }
    }
    Made { size, pixels, exposures_ev, table_error }
}

impl Cell {
    /// Its pixels at an exposure value.
    fn bytes(&self, exposure_ev: f64) -> Vec<u8> {
        match self.view {
            View::Colour => Development::new(self.scene.tone, self.scene.white, self.sun_white, exposure_ev)
                .bytes(self.size.0, self.rgb.iter().copied()),
            View::Degree => self.stokes.iter().flat_map(png::degree_bytes).collect(),
            View::Angle => self.stokes.iter().flat_map(png::angle_bytes).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gallery::{Exposure, panel};

    fn cell(luminance: f64) -> Cell {
        Cell {
            size: (2, 1),
            view: View::Colour,
            rgb: vec![[luminance; 3]; 2],
            luminances: vec![luminance; 2],
            stokes: Vec::new(),
            scene: Scene::default(),
            sun_white: [1.0; 3],
        }
    }

    fn figure(columns: usize, exposure: Exposure, count: usize) -> Figure {
        let one = || panel("a", "a", Scene { width: Some(2), height: Some(1), ..Scene::default() });
        let panels = (0..count).map(|_| one()).collect();
        Figure { name: "test", thesis: None, caption: "", columns, exposure, panels }
    }

    #[test]
    fn pictures_share_the_exposure_of_their_figure_or_row() {
        let cells = [1.0, 4.0, 16.0, 64.0].map(cell);
        // 22 % of 1.2 cd/m^2 is EV 0.
        let ev = |luminance: f64| (luminance / 0.264).log2();
        let near = |exposure: Exposure, expected: [f64; 4]| {
            let got = exposures_ev(&figure(2, exposure, 4), &cells);
            assert!(got.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "{exposure:?}: {got:?}");
        };
        near(Exposure::Figure, [ev(8.0); 4]);
        let dark = [1e-3, 4.0, 16.0].map(cell);
        let median = exposures_ev(&figure(3, Exposure::Figure, 3), &dark);
        assert!((median[0] - ev(4.0)).abs() < 1e-12, "{median:?}");
        near(Exposure::Row, [ev(2.0), ev(2.0), ev(32.0), ev(32.0)]);
        near(Exposure::Panel, [1.0, 4.0, 16.0, 64.0].map(ev));
    }

    #[test]
    fn pictures_stand_side_by_side_with_a_line_between() {
        let made = mounted(&figure(2, Exposure::Figure, 4), &[0.0, 1e6, 1e6, 0.0].map(cell), 0.0);
        assert_eq!(made.size, (8, 6));
        let grey = |x: usize, y: usize| made.pixels[3 * (y * 8 + x)];
        let row = |y: usize| [0, 1, 2, 5, 6, 7].map(|x| grey(x, y));
        assert_eq!(row(0)[..4], [0, 0, GAP_GREY, GAP_GREY]);
        assert!(row(0)[4] > 200 && row(5)[0] > 200 && row(5)[4] == 0, "{:?} {:?}", row(0), row(5));
        assert_eq!(row(3), [GAP_GREY; 6]);
    }

    #[test]
    fn air_is_the_same_whoever_looks_at_it() {
        let scene = Scene::default();
        let turned = Scene { sun_elevation_deg: -5.0, altitude_km: 400.0, width: Some(9), ..scene.clone() };
        assert!(same_air(&scene, &turned));
        assert!(!same_air(&scene, &Scene { month: 7, ..scene.clone() }));
    }
}
