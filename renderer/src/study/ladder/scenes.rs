//! What is looked at, and by which methods.

use crate::atmosphere::{Depolarisation, HazePhase};
use crate::scene::{Albedo, Scene, SunShape};
use crate::spectrum::{Scheme, Wavelengths};
use crate::transport::Method;
use crate::transport::rungs::Rung;
use tables::views::Biome;

/// How much of it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Size {
    /// Ten atmospheres, six scenes each, every setting.
    Full,
    /// Three atmospheres, and fewer settings, against references that are less fine.
    Quick,
}

/// Parts of the world in which methods do differently.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Regime {
    /// The sun at 10 degrees or higher, in air of an optical depth of aerosol below 0.25.
    Day,
    /// The sun from 0 to 10 degrees, in such air.
    LowSun,
    /// The sun below the horizon.
    Twilight,
    /// The sun above it, in thicker air.
    Haze,
    /// From above the air.
    Space,
}

impl Regime {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Day, Self::LowSun, Self::Twilight, Self::Haze, Self::Space];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Day => "day",
            Self::LowSun => "low sun",
            Self::Twilight => "twilight",
            Self::Haze => "haze",
            Self::Space => "space",
        }
    }

    /// That of a scene whose aerosol has that optical depth.
    #[must_use]
    pub fn of(scene: &Scene, optical_depth: f64) -> Self {
        match scene.sun_elevation_deg {
            _ if scene.in_space() => Self::Space,
            sun if sun < 0.0 => Self::Twilight,
            _ if optical_depth >= 0.25 => Self::Haze,
            sun if sun < 10.0 => Self::LowSun,
            _ => Self::Day,
        }
    }
}

/// Scenes of one air over one ground.
#[derive(Debug, Clone)]
pub(super) struct Atmosphere {
    pub(super) name: &'static str,
    pub(super) albedo: f64,
    pub(super) scenes: Vec<Scene>,
}

/// Pixels of the pictures' width and height.
const SIDE: u32 = 64;

/// (biome, optical depth or the type's own, albedo, month); what takes longest first.
const AIR: [(Option<Biome>, Option<f64>, f64, u8); 10] = [
    (Some(Biome::DesertDust), Some(0.4), 0.25, 6),
    (Some(Biome::Urban), None, 0.15, 9),
    (Some(Biome::MaritimeMineral), None, 0.06, 7),
    (Some(Biome::MaritimeClean), None, 0.06, 3),
    (Some(Biome::Rural), Some(0.3), 0.15, 5),
    (Some(Biome::RemoteContinental), None, 0.1, 6),
    (Some(Biome::PolarArctic), None, 0.8, 4),
    (Some(Biome::Background), None, 0.1, 10),
    (None, None, 0.1, 6),
    (None, None, 0.8, 1),
];

/// Elevations of the sun at the ground.
const SUNS: [f64; 5] = [60.0, 25.0, 8.0, 1.0, -4.0];

/// (altitude in km, elevation of the sun): by turns the sixth scene.
const ABOVE: [(f64, f64); 2] = [(12.0, 20.0), (400.0, 45.0)];

/// The atmospheres.
pub(super) fn atmospheres(size: Size) -> Vec<Atmosphere> {
    let all = AIR.into_iter().enumerate().map(|(i, (biome, aod, albedo, month))| {
        let base = Scene {
            follow_polarisation: Some(false),
            biome,
            aod,
            month,
            albedo: Albedo::Grey(albedo),
            width: Some(SIDE),
            height: Some(SIDE),
            sun_disc: false,
            ..Scene::default()
        };
        let ground = SUNS.into_iter().map(|sun_elevation_deg| Scene { sun_elevation_deg, ..base.clone() });
        let (altitude_km, sun_elevation_deg) = ABOVE[i % 2];
        let scenes = ground.chain([Scene { altitude_km, sun_elevation_deg, ..base.clone() }]).collect();
        Atmosphere { name: biome.map_or("none", Biome::name), albedo, scenes }
    });
    match size {
        Size::Full => all.collect(),
        // Haze, a little aerosol (also from space), and clear air.
        Size::Quick => {
            let all: Vec<_> = all.collect();
            [4, 5, 8].map(|i| all[i].clone()).to_vec()
        }
    }
}

/// A method and how it is set.
#[derive(Debug, Clone, Copy)]
pub(super) struct Setting {
    pub(super) name: &'static str,
    pub(super) change: fn(&mut Scene),
    /// Only in the full study.
    full: bool,
}

impl Setting {
    /// The scene as this setting has it.
    pub(super) fn of(&self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        (self.change)(&mut scene);
        scene
    }

    pub(super) fn method(&self) -> &'static str {
        Rung::of(self.of(&Scene::default()).method).name
    }
}

const fn setting(name: &'static str, change: fn(&mut Scene)) -> Setting {
    Setting { name, change, full: false }
}

const fn slow(name: &'static str, change: fn(&mut Scene)) -> Setting {
    Setting { name, change, full: true }
}

/// So many wavelengths, evenly from 380 to 780 nm; of 2 to 1000, as all here are.
fn wavelengths(scene: &mut Scene, count: usize) {
    scene.wavelengths_nm = Wavelengths::visible(count).unwrap_or_default();
}

/// Without an aerosol, and what is said of it.
fn without_aerosol(scene: &mut Scene) {
    (scene.biome, scene.aod) = (None, None);
}

/// All settings: the methods, from exact to rough; then the usual one with one part of the model left out.
const SETTINGS: [Setting; 43] = [
    slow("4 samples", |s| (s.method, s.spp) = (Method::Judge, Some(4))),
    slow("4 samples", |s| (s.method, s.spp) = (Method::Paths, Some(4))),
    setting("16 samples", |s| (s.method, s.spp) = (Method::Paths, Some(16))),
    slow("64 samples", |s| (s.method, s.spp) = (Method::Paths, Some(64))),
    slow("finest tables", |s| s.table_error = 1e-5),
    setting("usual tables", |s| s.table_error = 1.0),
    slow("11 wavelengths", |s| {
        s.table_error = 1.0;
        wavelengths(s, 11);
    }),
    slow("6 wavelengths", |s| {
        s.table_error = 1.0;
        wavelengths(s, 6);
    }),
    setting("4 wavelengths", |s| {
        s.table_error = 1.0;
        wavelengths(s, 4);
    }),
    setting("colour four", |s| (s.table_error, s.colour) = (1.0, Scheme::Four)),
    setting("four integrated", |s| {
        s.table_error = 1.0;
        s.wavelengths_nm = Scheme::Four.wavelengths().unwrap_or_default();
    }),
    setting("colour rgb", |s| (s.table_error, s.colour) = (1.0, Scheme::Rgb)),
    setting("8 points", |s| (s.method, s.steps) = (Method::Isotropic, Some(8))),
    slow("16 points", |s| (s.method, s.steps) = (Method::Isotropic, Some(16))),
    setting("32 points", |s| s.method = Method::Isotropic),
    slow("128 points", |s| (s.method, s.steps) = (Method::Isotropic, Some(128))),
    setting("4 wavelengths", |s| {
        s.method = Method::Isotropic;
        wavelengths(s, 4);
    }),
    setting("colour four", |s| (s.method, s.colour) = (Method::Isotropic, Scheme::Four)),
    setting("colour rgb", |s| (s.method, s.colour) = (Method::Isotropic, Scheme::Rgb)),
    setting("8 points", |s| (s.method, s.steps) = (Method::Single, Some(8))),
    slow("16 points", |s| (s.method, s.steps) = (Method::Single, Some(16))),
    setting("32 points", |s| s.method = Method::Single),
    slow("128 points", |s| (s.method, s.steps) = (Method::Single, Some(128))),
    slow("4 wavelengths", |s| {
        s.method = Method::Single;
        wavelengths(s, 4);
    }),
    slow("colour four", |s| (s.method, s.colour) = (Method::Single, Scheme::Four)),
    setting("colour rgb", |s| (s.method, s.colour) = (Method::Single, Scheme::Rgb)),
    setting("5 points", |s| s.method = Method::Oneil),
    slow("20 points", |s| (s.method, s.steps) = (Method::Oneil, Some(20))),
    setting("colour rgb", |s| (s.method, s.colour) = (Method::Oneil, Scheme::Rgb)),
    setting("as published", |s| s.method = Method::HosekWilkie),
    setting("as published", |s| s.method = Method::Preetham),
    setting("as published", |s| s.method = Method::Perez),
    setting("type 12", |s| s.method = Method::Cie),
    slow("type 13", |s| (s.method, s.sky_type) = (Method::Cie, Some(13))),
    slow("without ozone", |s| (s.table_error, s.ozone_du) = (1.0, Some(0.0))),
    slow("ozone of the opposite month", |s| (s.table_error, s.month) = (1.0, (s.month + 5) % 12 + 1)),
    slow("without aerosol", |s| {
        s.table_error = 1.0;
        without_aerosol(s);
    }),
    slow("phase hg", |s| (s.table_error, s.phase) = (1.0, HazePhase::HenyeyGreenstein)),
    slow("depolarisation none", |s| (s.table_error, s.depolarisation) = (1.0, Depolarisation::None)),
    slow("albedo 0", |s| (s.table_error, s.albedo) = (1.0, Albedo::Grey(0.0))),
    slow("top 60 km", |s| (s.table_error, s.top_km) = (1.0, 60.0)),
    slow("sun a point", |s| (s.table_error, s.sun_shape) = (1.0, SunShape::Point)),
    slow("flat", |s| (s.method, s.flat, s.spp) = (Method::Paths, true, Some(64))),
];

/// The settings.
pub(super) fn settings(size: Size) -> Vec<Setting> {
    SETTINGS.into_iter().filter(|setting| size == Size::Full || !setting.full).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn settings_have_names_of_their_own_and_make_valid_scenes() {
        let names: std::collections::BTreeSet<_> = SETTINGS.iter().map(|s| (s.method(), s.name)).collect();
        assert_eq!(names.len(), SETTINGS.len());
        for atmosphere in atmospheres(Size::Full) {
            assert_eq!(atmosphere.scenes.len(), 6);
            for setting in &SETTINGS {
                // A scene with the sun above the horizon: over a plane there is no other.
                setting.of(&atmosphere.scenes[0]).validate().expect("valid");
            }
        }
        assert_eq!(atmospheres(Size::Quick).len(), 3);
        let flat = SETTINGS[SETTINGS.len() - 1].of(&atmospheres(Size::Full)[0].scenes[4]);
        assert!(flat.validate().is_err());
    }
}
