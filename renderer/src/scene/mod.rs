//! The description of one picture, checked before any work.
//!
//! A scene can be written as JSON and is carried by the pictures made from it. Keys are
//! the names of the fields; a key that is left out has its default, an unknown key is an error.

mod albedo;
mod file;
mod mitsuba;
mod moment;
mod names;
mod schema;
mod validate;

pub use albedo::{Albedo, AlbedoError, Spectrum};
pub use mitsuba::Imported;
pub use moment::{Moment, SunPlace};
pub(crate) use names::word;
pub use names::{CameraKind, SunShape};
pub use schema::schema;
pub use validate::SceneError;

use crate::atmosphere::{Amount, Depolarisation, HazePhase, HazeSettings, OzoneSource};
use crate::camera::{Camera, Projection, direction_at};
use crate::film::{Tone, White};
use crate::spectrum::{Scheme, Wavelengths};
use crate::transport::{Fineness, Method};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::path::{Component, Path};
use tables::units::{EARTH_RADIUS_M, KM};
use tables::views::{AerosolSource, Biome};

/// Samples per pixel where neither a number nor an error is asked for.
pub const DEFAULT_SPP: u32 = 64;

/// The most samples per pixel.
pub const MAX_SPP: u32 = 1_000_000_000;

/// The most samples of a block.
pub const MAX_BLOCK: u32 = 1024;

/// A run of samples of which the number is known has at least so many blocks, each of which is at most
/// [`LARGE_BLOCK`] samples.
const BLOCKS: u32 = 16;
const LARGE_BLOCK: u32 = 64;

/// One picture.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Scene {
    /// Altitude of the observer above the ground in km, 0 to 1e6.
    pub altitude_km: f64,
    /// Top of the atmosphere in km, 1 to 120.
    pub top_km: f64,
    /// True elevation of the sun's centre at the observer in degrees, -90 to 90.
    pub sun_elevation_deg: f64,
    /// Azimuth of the sun in degrees clockwise from north, -360 to 360.
    pub sun_azimuth_deg: f64,
    /// Distance of the sun in astronomical units, 0.9 to 1.1: light goes with its square, the disc's width with it.
    #[serde(skip_serializing_if = "is_one")]
    pub sun_distance_au: f64,
    /// An instant that says where the sun stands at the place of latitude and longitude, how far it is, and the month:
    /// 2026-06-21T18:30:00+02:00.
    #[schemars(schema_with = "schema::date")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub date: Option<Moment>,
    /// Longitude in degrees, east positive, -180 to 180: with the date, or with the map of the Earth (0 if not given).
    #[serde(skip_serializing_if = "Option::is_none")]
    pub longitude_deg: Option<f64>,
    /// Whether the disc itself is drawn. The light is that of the disc either way.
    pub sun_disc: bool,
    /// Month, 1 to 12: which ozone.
    pub month: u8,
    /// Latitude in degrees, north positive, -90 to 90: which ozone.
    pub latitude_deg: f64,
    /// Which measured ozone.
    pub ozone_source: OzoneSource,
    /// Ozone column in Dobson units, 0 to 1000; the source's own if not given.
    pub ozone_du: Option<f64>,
    /// Kind of aerosol, or none.
    #[serde(with = "names::word::biome_or_none")]
    #[schemars(schema_with = "schema::biome")]
    pub biome: Option<Biome>,
    /// Whose optics the aerosol has.
    #[serde(with = "names::word::aerosol_source")]
    #[schemars(schema_with = "schema::aerosol_source")]
    pub aerosol_source: AerosolSource,
    /// Relative humidity in percent of the aerosol that takes up water, 0 to 99; its own if not given.
    pub humidity_percent: Option<f64>,
    /// Vertical optical depth of the aerosol at 550 nm, 0 to 20. This, the visibility
    /// and the turbidity exclude each other; without them the type's own amount.
    pub aod: Option<f64>,
    /// Visibility at the ground in km, 0.05 to 400.
    pub visibility_km: Option<f64>,
    /// How many times the type's own amount, 0 to 1000.
    pub turbidity: Option<f64>,
    /// Where the aerosol scatters to.
    pub phase: HazePhase,
    /// Own tables by their paths: each replaces, for this picture, the one of its kind; grounds are added.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub tables: Vec<String>,
    /// Reflectance of the ground: a number, 0 to 1; the name of a ground; earth, the map of the
    /// Earth, seen from above latitude and longitude; a CSV file (wavelength_nm,albedo); or its numbers,
    /// [[400.0, 0.02], [700.0, 0.3]].
    #[schemars(schema_with = "schema::albedo")]
    pub albedo: Albedo,
    /// Wavelengths in nm. Default: 16 from 380 to 780 nm.
    #[schemars(schema_with = "schema::wavelengths")]
    pub wavelengths_nm: Wavelengths,
    /// How wavelengths become colour; any but `spectral` brings its own wavelengths.
    #[serde(skip_serializing_if = "is_default")]
    pub colour: Scheme,
    /// Projection.
    pub camera: CameraKind,
    /// Field of view in degrees: of the width (pinhole, 0.01 to 179, default 60) or of
    /// the circle (fisheye, 1 to 360, default 180).
    pub fov_deg: Option<f64>,
    /// Azimuth of the view in degrees clockwise from north, -360 to 360. Default:
    /// the sun's; 0 for a fisheye that looks straight up or down.
    pub view_azimuth_deg: Option<f64>,
    /// Elevation of the view in degrees, -90 to 90. Default: inside the atmosphere 90 for a fisheye
    /// and 0 for a pinhole; from above it, -90 and the horizon of the ground.
    pub view_elevation_deg: Option<f64>,
    /// Width in pixels, 1 to 16384. Default 256; latlong 512.
    pub width: Option<u32>,
    /// Height in pixels, 1 to 16384. Default 256.
    pub height: Option<u32>,
    /// Exposure of the PNG, EV at ISO 100, -30 to 30; automatic if not given.
    pub exposure_ev: Option<f64>,
    /// Tone curve of the PNG.
    #[serde(skip_serializing_if = "is_default")]
    pub tone: Tone,
    /// What the PNG shows as white: `d65` (colours as they are), `e`, `sun` (that above the air) or daylight of a colour temperature, 4000 to 25 000 K: `5500K`.
    #[schemars(schema_with = "crate::film::white::schema")]
    #[serde(skip_serializing_if = "is_default")]
    pub white: White,
    /// Whether the picture keeps the Stokes parameters I, Q and U. Their frame: e1 horizontal, towards growing azimuth
    /// ([`Camera::level`]), e2 upwards.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub polarisation: bool,
    /// Whether light is followed with its polarisation though the picture keeps radiance alone, which it changes by up to some percent. If
    /// not given, it is by the methods that can, unless leaving it out is known to cost less than the error that is asked:
    /// `table_error` of solved pictures, `error` of traced ones.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub follow_polarisation: Option<bool>,
    /// Axis of a polarising filter before the camera in degrees from e1 towards e2, -360 to 360: the picture is what passes.
    /// This and `polarisation` exclude each other.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub filter_deg: Option<f64>,
    /// How radiance is found.
    #[schemars(schema_with = "schema::method")]
    pub method: Method,
    /// Points on each line of sight of the methods `single`, `isotropic` and `oneil`, 2 to 4096; the method's own number if not
    /// given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steps: Option<u32>,
    /// Type of the method `cie`, 1 to 15; 12, the clear sky, if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sky_type: Option<u8>,
    /// The most scatterings and reflections of a path, 1 to 1000; all if not given. For the methods `paths` and `judge`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub orders: Option<u32>,
    /// Whether molecules scatter as they do, or as if they were spheres.
    #[serde(skip_serializing_if = "is_default")]
    pub depolarisation: Depolarisation,
    /// Form of the sun as a light.
    #[serde(skip_serializing_if = "is_default")]
    pub sun_shape: SunShape,
    /// Whether the planet is a plane, the layers without end; the sun then stands above the horizon.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub flat: bool,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Samples per pixel, 1 to 10^9, rounded up to whole blocks; with `error` the most of them.
    pub spp: Option<u32>,
    /// Samples of a block, a power of two from 1 to 1024. Those of one block are spread evenly; errors come from the
    /// spread of blocks. Default: see [`Scene::block`].
    pub block: Option<u32>,
    /// Relative error at which to stop, 1e-5 to 1.
    pub error: Option<f64>,
    /// Relative error that a solved table is to have, 1e-5 to 1: finer ones are solved until they state it or there is none finer.
    pub table_error: f64,
    /// Grid on which tables are solved, with no other that tells their error; by `table_error` if not given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub fineness: Option<Fineness>,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            altitude_km: 0.002,
            top_km: 120.0,
            sun_elevation_deg: 30.0,
            sun_azimuth_deg: 180.0,
            sun_distance_au: 1.0,
            date: None,
            longitude_deg: None,
            sun_disc: true,
            month: 6,
            latitude_deg: 45.0,
            ozone_source: OzoneSource::McPetersLabow,
            ozone_du: None,
            biome: None,
            aerosol_source: AerosolSource::Opac,
            humidity_percent: None,
            aod: None,
            visibility_km: None,
            turbidity: None,
            phase: HazePhase::Mie,
            tables: Vec::new(),
            albedo: Albedo::Grey(0.1),
            wavelengths_nm: Wavelengths::default(),
            colour: Scheme::Spectral,
            camera: CameraKind::Fisheye,
            fov_deg: None,
            view_azimuth_deg: None,
            view_elevation_deg: None,
            width: None,
            height: None,
            exposure_ev: None,
            tone: Tone::default(),
            white: White::default(),
            polarisation: false,
            follow_polarisation: None,
            filter_deg: None,
            method: Method::Solved,
            steps: None,
            sky_type: None,
            orders: None,
            depolarisation: Depolarisation::Measured,
            sun_shape: SunShape::Disc,
            flat: false,
            seed: 0,
            spp: None,
            block: None,
            error: None,
            table_error: 0.01,
            fineness: None,
        }
    }
}

impl Scene {
    /// Reads a scene from JSON; it is not validated yet.
    ///
    /// # Errors
    /// [`SceneError::Malformed`] with line and column.
    pub fn from_json(text: &str) -> Result<Self, SceneError> {
        Ok(serde_json::from_str(text)?)
    }

    /// The scene as JSON, one line. Defaults that depend on other choices stay open, so that flags laid
    /// over the scene of a picture find them as if it were new.
    #[must_use]
    pub fn to_json(&self) -> String {
        // A struct of numbers and words has no value that JSON lacks once validated.
        serde_json::to_string(self).unwrap_or_default()
    }

    /// The scene as a picture carries it: as [`Scene::to_json`], but of a table whose path is absolute or leads out of
    /// the current folder the name of the file alone, for no picture tells of its maker's folders.
    #[must_use]
    pub fn to_portable_json(&self) -> String {
        self.portable().to_json()
    }

    /// The scene without the folders of its maker, as [`Scene::to_portable_json`] has it.
    #[must_use]
    pub fn portable(&self) -> Self {
        let tables = self.tables.iter().map(|path| portable(path)).collect();
        Self { tables, ..self.clone() }
    }

    /// In what this scene and another differ so that their samples are not of one picture, if they do. Seed, samples,
    /// error, exposure, tone and white make no difference, blocks do; of own tables only the files can tell.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<String> {
        let [ours, theirs] = [self, other].map(|scene| {
            let (width, height) = scene.size();
            let (width, height, block) = (Some(width), Some(height), Some(scene.block()));
            let (spp, error, exposure_ev, tables) = (None, None, None, Vec::new());
            let (tone, white) = Default::default();
            let estimand =
                Self { width, height, block, seed: 0, spp, error, exposure_ev, tone, white, tables, ..scene.clone() };
            // As in `to_json`.
            serde_json::to_value(estimand).unwrap_or_default()
        });
        // Some keys are left out where they have their default.
        let mut keys = ours.as_object()?.keys().chain(theirs.as_object()?.keys());
        let key = keys.find(|key| ours.get(key) != theirs.get(key))?;
        let value = |scene: &serde_json::Value| scene.get(key).map_or("not given".into(), ToString::to_string);
        Some(format!("{key} is {} in one, {} in the other", value(&ours), value(&theirs)))
    }

    /// Whether light is followed with its polarisation, if the scene says so: what a picture keeps of it comes before what is followed.
    #[must_use]
    pub fn polarised(&self) -> Option<bool> {
        if self.polarisation || self.filter_deg.is_some() { Some(true) } else { self.follow_polarisation }
    }

    /// The error that is asked: of a solved table, or of a traced picture, which is that of a table if none is given.
    #[must_use]
    pub fn asked_error(&self) -> f64 {
        self.error.filter(|_| self.method != Method::Solved).unwrap_or(self.table_error)
    }

    /// The first setting that says something of an aerosol, by its flag without dashes.
    pub(crate) fn aerosol_setting(&self) -> Option<&'static str> {
        let given = [
            ("humidity", self.humidity_percent),
            ("aod", self.aod),
            ("visibility", self.visibility_km),
            ("turbidity", self.turbidity),
        ];
        given.into_iter().find_map(|(name, value)| value.map(|_| name))
    }

    /// Whether the observer is at or above the top of the atmosphere.
    #[must_use]
    pub fn in_space(&self) -> bool {
        self.altitude_km >= self.top_km
    }

    /// The wavelengths that are followed: the scene's, or those of its [`Scheme`].
    #[must_use]
    pub fn wavelengths(&self) -> Wavelengths {
        self.colour.wavelengths().unwrap_or_else(|| self.wavelengths_nm.clone())
    }

    /// Numbers of a pixel: one for each wavelength, or X, Y and Z of a fitted sky.
    #[must_use]
    pub fn channels(&self) -> usize {
        if self.method.is_dome() { 3 } else { self.wavelengths().nm().len() }
    }

    /// How much of the aerosol there is, and in which state.
    #[must_use]
    pub fn haze(&self) -> HazeSettings {
        let amount = match (self.aod, self.visibility_km, self.turbidity) {
            (Some(depth), ..) => Amount::OpticalDepth(depth),
            (_, Some(km), _) => Amount::VisibilityKm(km),
            (.., Some(factor)) => Amount::Turbidity(factor),
            _ => Amount::Own,
        };
        HazeSettings { humidity_percent: self.humidity_percent, amount, phase: self.phase }
    }

    /// Unit vector to the sun's centre in the observer's frame.
    #[must_use]
    pub fn sun_direction(&self) -> DVec3 {
        direction_at(self.sun_azimuth_deg.to_radians(), self.sun_elevation_deg.to_radians())
    }

    /// Width and height in pixels.
    #[must_use]
    pub fn size(&self) -> (u32, u32) {
        let width = if self.camera == CameraKind::Latlong { 512 } else { 256 };
        (self.width.unwrap_or(width), self.height.unwrap_or(256))
    }

    /// Samples of a block: as given, or the largest power of two, at most 64, of which the samples are 16 blocks. Where an
    /// error E is to be reached 1/(3 E^2) samples are expected: the relative spread of one is about 60 %.
    #[must_use]
    pub fn block(&self) -> u32 {
        let samples = match self.error {
            // At most 3.4e9, for the least error.
            Some(error) => (1.0 / (3.0 * error * error)) as u32,
            None => self.spp.unwrap_or(self.default_spp()),
        };
        self.block.unwrap_or_else(|| {
            let most = (samples / BLOCKS).clamp(1, LARGE_BLOCK);
            1 << most.ilog2()
        })
    }

    /// Samples per pixel if nothing is said of them: [`DEFAULT_SPP`], or one, at the pixel's middle, of a method without noise.
    #[must_use]
    pub fn default_spp(&self) -> u32 {
        if self.method.estimator().is_none() { 1 } else { DEFAULT_SPP }
    }

    fn field_of_view_deg(&self) -> f64 {
        self.fov_deg.unwrap_or(if self.camera == CameraKind::Pinhole { 60.0 } else { 180.0 })
    }

    /// Azimuth and elevation of the view in degrees.
    pub(crate) fn view_deg(&self) -> (f64, f64) {
        let elevation = self.view_elevation_deg.unwrap_or(match (self.camera, self.in_space()) {
            (CameraKind::Latlong | CameraKind::EqualArea, _) | (CameraKind::Pinhole, false) => 0.0,
            (CameraKind::Pinhole, true) => -horizon_dip(self.altitude_km * KM).to_degrees(),
            (CameraKind::Fisheye, false) => 90.0,
            (CameraKind::Fisheye, true) => -90.0,
        });
        let vertical = self.camera == CameraKind::Fisheye && elevation.abs() == 90.0;
        (self.view_azimuth_deg.unwrap_or(if vertical { 0.0 } else { self.sun_azimuth_deg }), elevation)
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> Camera {
        let field_of_view = self.field_of_view_deg().to_radians();
        let projection = match self.camera {
            CameraKind::Fisheye => Projection::Fisheye { field_of_view },
            CameraKind::Pinhole => Projection::Pinhole { field_of_view },
            CameraKind::Latlong => Projection::LatLong,
            CameraKind::EqualArea => Projection::EqualArea,
        };
        let (width, height) = self.size();
        let (azimuth, elevation) = self.view_deg();
        Camera::new(projection, width, height, azimuth.to_radians(), elevation.to_radians())
    }
}

/// Whether a choice is the default one, which files leave out.
fn is_default<T: Copy + PartialEq + Default>(choice: &T) -> bool {
    *choice == T::default()
}

/// Whether a distance is the usual one, which files leave out.
fn is_one(distance: &f64) -> bool {
    *distance == 1.0
}

/// A relative path that stays below its folder, with forward slashes; of any other the name of the file.
fn portable(path: &str) -> String {
    let parts: Vec<_> = Path::new(path).components().filter(|part| *part != Component::CurDir).collect();
    let below = parts.iter().all(|part| matches!(part, Component::Normal(_)));
    let kept = if below { &parts[..] } else { &parts[parts.len().saturating_sub(1)..] };
    kept.iter().map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
}

/// How far the horizon lies below the horizontal in radians, seen from `altitude_m`:
/// sin dip = sqrt(h (2R + h)) / (R + h).
pub(crate) fn horizon_dip(altitude_m: f64) -> f64 {
    let radius = EARTH_RADIUS_M + altitude_m;
    ((altitude_m * (EARTH_RADIUS_M + radius)).sqrt() / radius).asin()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_of_a_scene_reads_back_as_the_same_picture() {
        let scene = Scene { albedo: Albedo::Ground("ocean".into()), error: Some(0.02), ..Scene::default() };
        let read = Scene::from_json(&scene.to_json()).expect("reads");
        assert_eq!(read, scene);
    }

    #[test]
    fn a_short_scene_has_defaults_and_an_unknown_key_is_named() {
        let scene = Scene::from_json(r#"{"month": 3, "albedo": 0.5}"#).expect("reads");
        assert_eq!(scene, Scene { month: 3, albedo: Albedo::Grey(0.5), ..Scene::default() });
        let error = Scene::from_json(r#"{"sun_elevaton_deg": 3}"#).expect_err("unknown").to_string();
        assert!(error.contains("sun_elevaton_deg") && error.contains("line 1"), "{error}");
    }

    #[test]
    fn samples_make_at_least_sixteen_blocks() {
        let paths = || Scene { method: Method::Paths, ..Scene::default() };
        let of = |spp| Scene { spp, ..paths() }.block();
        assert_eq!([None, Some(1), Some(31), Some(32), Some(100), Some(5000)].map(of), [4, 1, 1, 2, 4, 64]);
        let of = |error| Scene { error: Some(error), spp: Some(9), ..paths() }.block();
        // 1/(3 E^2) = 33, 133, 833 and 3333 samples.
        assert_eq!([0.5, 0.1, 0.05, 0.02, 0.01, 1e-5].map(of), [1, 2, 8, 32, 64, 64]);
        assert_eq!(Scene { block: Some(128), ..paths() }.block(), 128);
        assert_eq!(Scene::default().block(), 1, "one sample, at the pixel's middle");
    }

    #[test]
    fn scenes_of_one_picture_may_differ_in_seed_and_effort() {
        let default = || Scene { method: Method::Paths, ..Scene::default() };
        let scene = default();
        let (tone, white) = (Tone::Filmic, White::Sun);
        let other = Scene { seed: 7, error: Some(0.1), block: Some(4), width: Some(256), tone, white, ..default() };
        assert_eq!(scene.difference(&other), None);
        let other = Scene { sun_elevation_deg: 29.0, ..default() };
        assert_eq!(scene.difference(&other).as_deref(), Some("sun_elevation_deg is 30.0 in one, 29.0 in the other"));
        assert!(scene.difference(&Scene { spp: Some(1), ..default() }).expect("blocks").contains("block is 4"));
        let other = Scene { polarisation: true, ..default() };
        assert_eq!(scene.difference(&other).as_deref(), Some("polarisation is not given in one, true in the other"));
        assert!(other.difference(&scene).is_some());
    }

    #[test]
    fn a_picture_tells_nothing_of_the_folders_of_its_maker() {
        let of = |path: &str| {
            let scene = Scene { tables: vec![path.into()], ..Scene::default() };
            Scene::from_json(&scene.to_portable_json()).expect("reads").tables
        };
        assert_eq!(of("/home/somebody/haze.table"), ["haze.table"]);
        assert_eq!(of("../elsewhere/haze.table"), ["haze.table"]);
        assert_eq!(of("./own/haze.table"), ["own/haze.table"]);
        let json = Scene::default().to_json();
        let newer = [
            "tables",
            "polarisation",
            "filter_deg",
            "colour",
            "steps",
            "sky_type",
            "orders",
            "depolarisation",
            "sun_shape",
            "flat",
            "fineness",
            "follow_polarisation",
            "tone",
            "white",
        ];
        assert!(newer.iter().all(|key| !json.contains(key)), "an old scene reads as before");
    }

    #[test]
    fn views_have_the_documented_defaults() {
        let view = |scene: Scene| scene.view_deg();
        assert_eq!(view(Scene::default()), (0.0, 90.0));
        let space = Scene { altitude_km: 400.0, ..Scene::default() };
        assert_eq!(view(space.clone()), (0.0, -90.0));
        assert_eq!(view(Scene { camera: CameraKind::Pinhole, ..Scene::default() }), (180.0, 0.0));
        let (_, limb) = view(Scene { camera: CameraKind::Pinhole, ..space });
        // acos(6371 / 6771) = 19.79 degrees.
        assert!((limb + 19.79).abs() < 0.01, "{limb}");
        assert_eq!(Scene { camera: CameraKind::Latlong, ..Scene::default() }.size(), (512, 256));
    }
}
