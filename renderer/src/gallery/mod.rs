//! The pictures of the gallery: figures of some panels, each panel a scene with a name. These scenes are the presets.

mod beyond;
mod make;
mod thesis;

pub use make::{Made, Work, make};

use crate::scene::{CameraKind, Scene};

/// A picture of one or more panels.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Its name, unique.
    pub name: &'static str,
    /// The figure of the thesis (Gavin 2020) to which it is the counterpart, if there is one.
    pub thesis: Option<&'static str>,
    /// What is to be seen, in the order of the panels.
    pub caption: &'static str,
    /// Panels beside each other; the rest in further rows.
    pub columns: usize,
    /// What has one exposure.
    pub exposure: Exposure,
    /// The panels, row by row.
    pub panels: Vec<Panel>,
}

/// What has one exposure, the median of the automatic ones of its pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Exposure {
    /// All panels.
    Figure,
    /// Those of a row.
    Row,
    /// Each panel its own.
    Panel,
}

/// A scene of a figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Its name as a preset, unique.
    pub name: String,
    /// What it is, in a line.
    pub line: String,
    /// The scene, without an exposure.
    pub scene: Scene,
    /// Its pictures, one beside the other.
    pub views: &'static [View],
}

/// What a picture shows of a scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// Colour.
    Colour,
    /// Degree of polarisation as grey: black 0, white 1.
    Degree,
    /// Angle of polarisation as hue: red horizontal, cyan vertical.
    Angle,
}

/// All figures: those of the thesis in its order, then others.
#[must_use]
pub fn figures() -> Vec<Figure> {
    let mut figures = thesis::figures();
    figures.extend(beyond::figures());
    figures
}

/// All panels.
#[must_use]
pub fn presets() -> Vec<Panel> {
    figures().into_iter().flat_map(|figure| figure.panels).collect()
}

/// The scene of a preset.
#[must_use]
pub fn preset(name: &str) -> Option<Scene> {
    presets().into_iter().find(|panel| panel.name == name).map(|panel| panel.scene)
}

impl Figure {
    /// Number of pictures, row by row.
    #[must_use]
    pub fn cells(&self) -> usize {
        self.panels.iter().map(|panel| panel.views.len()).sum()
    }

    /// The group of pictures that share their exposure with number `cell`.
    fn group(&self, cell: usize) -> usize {
        match self.exposure {
            Exposure::Figure => 0,
            Exposure::Row => cell / self.columns,
            Exposure::Panel => cell,
        }
    }

    /// With the longer side of each picture of so many pixels.
    #[must_use]
    pub fn sized(mut self, side: u32) -> Self {
        for panel in &mut self.panels {
            let (width, height) = panel.scene.size();
            // At least a pixel, at most `side`.
            let scaled = |length: u32| {
                let share = f64::from(length) / f64::from(width.max(height));
                (f64::from(side) * share).round().max(1.0) as u32
            };
            (panel.scene.width, panel.scene.height) = (Some(scaled(width)), Some(scaled(height)));
        }
        self
    }
}

/// A panel that shows colour.
fn panel(name: impl Into<String>, line: impl Into<String>, scene: Scene) -> Panel {
    Panel { name: name.into(), line: line.into(), scene, views: &[View::Colour] }
}

/// A fisheye of the whole sky, `side` pixels wide.
fn fisheye(side: u32, sun_elevation_deg: f64) -> Scene {
    Scene { sun_elevation_deg, width: Some(side), height: Some(side), spp: Some(4), ..Scene::default() }
}

/// A pinhole view of so many pixels, `fov_deg` wide. A level horizon needs one sample a pixel.
fn pinhole((width, height): (u32, u32), fov_deg: f64, sun_elevation_deg: f64) -> Scene {
    Scene {
        camera: CameraKind::Pinhole,
        fov_deg: Some(fov_deg),
        sun_elevation_deg,
        width: Some(width),
        height: Some(height),
        ..Scene::default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_preset_is_a_valid_scene_with_a_name_and_an_exposure_to_be_found() {
        for panel in presets() {
            panel.scene.validate().unwrap_or_else(|error| panic!("{}: {error}", panel.name));
            assert!(panel.scene.exposure_ev.is_none() && !panel.line.is_empty(), "{}", panel.name);
            let polarised = panel.views.iter().any(|view| *view != View::Colour);
            assert_eq!(panel.scene.polarisation, polarised, "{}", panel.name);
        }
    }

    #[test]
    fn names_are_unique_words() {
        let (figures, presets) = (figures(), presets());
        let names: Vec<&str> = figures.iter().map(|figure| figure.name).collect();
        let panels: Vec<&str> = presets.iter().map(|panel| panel.name.as_str()).collect();
        for names in [names, panels] {
            assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{names:?}");
            let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '-';
            assert!(names.iter().all(|name| name.chars().all(plain)), "{names:?}");
        }
    }

    #[test]
    fn figures_are_full_grids_of_equal_pictures() {
        for figure in figures() {
            assert!(figure.cells().is_multiple_of(figure.columns), "{}", figure.name);
            let first = figure.panels[0].scene.size();
            assert!(figure.panels.iter().all(|panel| panel.scene.size() == first), "{}", figure.name);
            let large = figure.sized(1024);
            let (width, height) = large.panels[0].scene.size();
            assert_eq!(width.max(height), 1024);
        }
    }

    #[test]
    fn figures_of_the_thesis_have_one_exposure_each() {
        let ours: Vec<&str> = figures().iter().filter_map(|figure| figure.thesis).collect();
        assert_eq!(ours, ["6.1", "6.2", "6.3", "6.4", "6.5", "6.6", "6.7", "6.8", "6.9"]);
        for figure in figures().iter().filter(|figure| figure.thesis.is_some()) {
            assert!((0..figure.cells()).all(|cell| figure.group(cell) == 0), "{}", figure.name);
        }
    }
}
