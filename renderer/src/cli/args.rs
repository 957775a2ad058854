//! Flags, and how they change a scene.

use super::words::{
    Asked, BiomeName, OzoneName, PhaseName, RenderMethod, ShardName, Switch, asked, biome, pixel, shard, share, time,
};
use crate::atmosphere::Depolarisation;
use crate::film::{Tone, White};
use crate::plan::Metric;
use crate::scene::{Albedo, CameraKind, Moment, Scene, SceneError, SunShape, word};
use crate::spectrum::{Scheme, Wavelengths};
use crate::transport::Fineness;
use clap::Args;
use std::path::PathBuf;
use std::time::Duration;
use tables::views::AerosolSource;

/// Flags of `airlight render`.
#[derive(Debug, Args)]
#[command(allow_negative_numbers = true)]
pub(super) struct RenderArgs {
    /// Scene to start from: TOML (`airlight scene new`), JSON, or the EXR file of a picture, which carries it; flags override it
    #[arg(value_name = "SCENE")]
    pub scene: Option<PathBuf>,
    /// Start from a scene of the gallery instead: `airlight scene new --list` lists them [default: none]
    #[arg(long, value_name = "NAME", conflicts_with_all = ["scene", "resume"], help_heading = "Files")]
    pub preset: Option<String>,
    #[command(flatten)]
    pub files: PictureArgs,
    /// A table of your own (`airlight-tools import`): it replaces, for this picture, the one of its kind in --data, or
    /// adds a ground for --albedo; once for each kind. Those of the scene are then left out [default: those of the scene]
    #[arg(long = "table", value_name = "FILE", help_heading = "Files")]
    pub tables: Vec<String>,
    /// Keep solved tables in this folder, by a checksum of all that they depend on, and take them from there: another sun, observer
    /// or camera then needs no solving [default: none are kept]
    #[arg(long, value_name = "DIR", help_heading = "Files")]
    pub keep_tables: Option<PathBuf>,
    /// Keep the state of the run in this file, each minute and at the end, for --resume and `airlight merge`
    /// [default: none; with --shard the picture's name with .state, with --resume its file]
    #[arg(long, value_name = "FILE", help_heading = "Files")]
    pub checkpoint: Option<PathBuf>,
    /// Go on with the run whose state is in this file; more samples may be asked for, the scene stays [default: a new run]
    #[arg(long, value_name = "FILE", conflicts_with = "scene", help_heading = "Files")]
    pub resume: Option<PathBuf>,

    /// How radiance is found [default: solved]
    #[arg(long, value_name = "METHOD", help_heading = "Sampling")]
    pub method: Option<RenderMethod>,
    /// Points on each line of sight of --method single, isotropic [default: 32] and oneil [default: 5], 2 to 4096
    #[arg(long, value_name = "N", help_heading = "Sampling")]
    pub steps: Option<u32>,
    /// Type of the CIE's standard sky of --method cie, 1 to 15 [default: 12, clear]
    #[arg(long, value_name = "1..15", help_heading = "Sampling")]
    pub sky_type: Option<u8>,
    /// The most scatterings and reflections of a path of --method paths or judge, 1 to 1000 [default: all]
    #[arg(long, value_name = "N", help_heading = "Sampling")]
    pub orders: Option<u32>,
    /// Samples per pixel, 1 to 10^9, rounded up to whole blocks; with --error or --time the most of them [default: 64; 1 of solved tables]
    #[arg(long, value_name = "N", help_heading = "Sampling")]
    pub spp: Option<u32>,
    /// Go on until sqrt(mean squared standard error) over mean radiance, the solar disc left
    /// out, is at most this, 1e-5 to 1: 1% or 0.01; 16 blocks of each pixel at least. With --auto, and of a plan, the error
    /// that the picture is to have at most [default: the samples of --spp, whatever the error]
    #[arg(long, value_name = "E", value_parser = asked, help_heading = "Sampling")]
    pub error: Option<Asked>,
    /// Plan: take the cheapest method, grid and wavelengths that meet --error by stored measurements (`airlight plan` says which and why),
    /// look at random pixels by unbiased paths, and go on with a more exact one if they show that it does not
    #[arg(long, requires = "error", conflicts_with_all = ["method", "steps", "orders", "spp", "time", "block", "shard", "resume", "checkpoint",
        "certify", "table_error", "fineness", "follow_polarisation", "pixel"], help_heading = "Sampling")]
    pub auto: bool,
    /// What the error of --auto and of a plan is of; of colour --error 1 is a unit of CIEDE2000 [default: radiance]
    #[arg(long, value_name = "METRIC", requires = "error", help_heading = "Sampling")]
    pub metric: Option<Metric>,
    /// Go on for so long, 1s to 1000h, in whole passes over the picture, two blocks of each pixel at least: 30s, 5m or
    /// 1.5h. The picture tells how many samples that were, so that it can be repeated [default: no limit]
    #[arg(long, value_name = "T", value_parser = time, help_heading = "Sampling")]
    pub time: Option<Duration>,
    /// Samples of a block, a power of two from 1 to 1024. Those of one block are spread evenly (Sobol), and errors come
    /// from the spread of blocks; 1 is pure chance [default: so that there are 16 blocks, at most 64; 4 with --time]
    #[arg(long, value_name = "N", help_heading = "Sampling")]
    pub block: Option<u32>,
    /// Make part I of N of the picture, for `airlight merge`: every Nth block of the samples (--spp counts the whole), N up to 65536. With env
    /// the launcher says which: an array of Slurm, srun, mpirun; names of files then end in -I-of-N, as the default name always does
    /// [default: the whole picture]
    #[arg(long, value_name = "I/N|env", value_parser = shard, help_heading = "Sampling")]
    pub shard: Option<ShardName>,
    /// Seed of the random numbers, 0 to 2^64 - 1 [default: 0]
    #[arg(long, value_name = "S", help_heading = "Sampling")]
    pub seed: Option<u64>,
    /// Threads, 1 to 1024; the picture does not depend on it [default: all processors]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), help_heading = "Sampling")]
    pub threads: Option<u16>,
    /// Look at 128 directions of the picture by unbiased estimates that end in the solved table, until it is clear with 95 %
    /// confidence whether the table's rms error is below E, 1e-5 to 1: with --polarisation that of I and those of Q and U relative to I,
    /// with --filter that of what passes [default without E: 0.1%]
    #[arg(long, value_name = "E", value_parser = share, num_args = 0..=1, default_missing_value = "0.1%", require_equals = true, help_heading = "Sampling")]
    pub certify: Option<f64>,
    /// Relative error (rms) that solved tables are to have, 1e-5 to 1: finer ones are solved until they state it, or there is none
    /// finer; with aerosol 0.2% takes some five times as long [default: 1%, with --certify at most half of what that asks]
    #[arg(long, value_name = "E", value_parser = share, help_heading = "Sampling")]
    pub table_error: Option<f64>,
    /// Grid on which tables are solved, whatever they would state; no other is solved that tells their error, which takes less time.
    /// `airlight plan` chooses one by measured errors [default: as --table-error asks]
    #[arg(long, value_name = "GRID", help_heading = "Sampling")]
    pub fineness: Option<Fineness>,
    /// Wavelengths: how many from 380 to 780 nm, 1 to 1000, or a list in nm, 300 to 1000,
    /// increasing (450,550,650; a single one as 550.0) [default: 16]
    #[arg(long, value_name = "N|LIST", help_heading = "Sampling")]
    pub wavelengths: Option<Wavelengths>,
    /// How wavelengths become colour, with any method that has a spectrum; rgb and four bring their own wavelengths [default: spectral]
    #[arg(long, value_name = "SCHEME", help_heading = "Sampling")]
    pub colour: Option<Scheme>,
    /// Print one sample of this pixel (from the upper left, 0,0) instead of a picture [default: the picture]
    #[arg(long, value_name = "X,Y", value_parser = pixel, help_heading = "Sampling")]
    pub pixel: Option<(u32, u32)>,
    /// Which sample --pixel prints
    #[arg(long, value_name = "N", default_value_t = 0, requires = "pixel", help_heading = "Sampling")]
    pub sample: u32,

    /// Width in pixels, 1 to 16384 [default: 256; latlong 512]
    #[arg(long, value_name = "W", help_heading = "Camera")]
    pub width: Option<u32>,
    /// Height in pixels, 1 to 16384 [default: 256]
    #[arg(long, value_name = "H", help_heading = "Camera")]
    pub height: Option<u32>,
    /// Projection [default: fisheye]
    #[arg(long, help_heading = "Camera")]
    pub camera: Option<CameraKind>,
    /// Field of view in degrees: of the fisheye's circle, 1 to 360 [default: 180], or of the
    /// pinhole's width, 0.01 to 179 [default: 60]
    #[arg(long, value_name = "DEG", help_heading = "Camera")]
    pub fov: Option<f64>,
    /// Azimuth of the view in degrees clockwise from north, -360 to 360; on top of a picture that
    /// looks straight up or down [default: the sun's; there 0, north]
    #[arg(long, value_name = "DEG", help_heading = "Camera")]
    pub view_azimuth: Option<f64>,
    /// Elevation of the view in degrees, -90 to 90 [default: fisheye 90, pinhole 0; from above the
    /// atmosphere fisheye -90, pinhole the ground's horizon]
    #[arg(long, value_name = "DEG", help_heading = "Camera")]
    pub view_elevation: Option<f64>,
    /// Keep the polarisation of light: Stokes parameters, degree and angle in the EXR, and a second PNG of degree and angle
    /// (NAME-polarisation.png). Solved tables know it nearly where there is aerosol, --method paths exactly
    /// [default: off; on without a word]
    #[arg(long, num_args = 0..=1, default_missing_value = "on", require_equals = true, help_heading = "Camera")]
    pub polarisation: Option<Switch>,
    /// Follow light with its polarisation, but keep radiance alone in the picture [default: on, unless leaving it out is known to cost less
    /// than --table-error, or --error of a traced picture; on without a word]
    #[arg(long, num_args = 0..=1, default_missing_value = "on", require_equals = true, help_heading = "Camera")]
    pub follow_polarisation: Option<Switch>,
    /// A polarising filter before the camera, its axis so many degrees from the horizontal of each pixel, anticlockwise as one
    /// looks, -360 to 360 [default: none]
    #[arg(long, value_name = "ANGLE", help_heading = "Camera")]
    pub filter: Option<f64>,
    /// Altitude of the observer in km above the ground, 0 to 1000000 [default: 0.002]
    #[arg(long, value_name = "KM", help_heading = "Camera")]
    pub altitude: Option<f64>,

    /// True elevation of the sun in degrees, -90 to 90 [default: 30]
    #[arg(long, value_name = "DEG", help_heading = "Sun, air and ground")]
    pub sun_elevation: Option<f64>,
    /// Azimuth of the sun in degrees clockwise from north, -360 to 360 [default: 180]
    #[arg(long, value_name = "DEG", help_heading = "Sun, air and ground")]
    pub sun_azimuth: Option<f64>,
    /// An instant that says where the sun stands at --latitude and --longitude, how far it is, and the month:
    /// 2026-06-21T18:30:00+02:00, or Z for UTC [default: none; the sun is where --sun-elevation has it]
    #[arg(long, value_name = "INSTANT", conflicts_with_all = ["sun_elevation", "sun_azimuth", "sun_distance", "month"], help_heading = "Sun, air and ground")]
    pub date: Option<Moment>,
    /// Longitude in degrees, east positive, -180 to 180, which --date needs, and for --albedo earth [default: 0 there]
    #[arg(long, value_name = "DEG", help_heading = "Sun, air and ground")]
    pub longitude: Option<f64>,
    /// Distance of the sun in astronomical units, 0.9 to 1.1 [default: 1]
    #[arg(long, value_name = "AU", help_heading = "Sun, air and ground")]
    pub sun_distance: Option<f64>,
    /// Whether the disc itself is drawn; it gives light either way [default: on]
    #[arg(long, help_heading = "Sun, air and ground")]
    pub sun_disc: Option<Switch>,
    /// Form of the sun as a light [default: disc]
    #[arg(long, value_name = "FORM", help_heading = "Sun, air and ground")]
    pub sun_shape: Option<SunShape>,
    /// Whether the planet is a plane, the layers without end, for --method paths, judge, single and isotropic; the sun then stands above
    /// the horizon [default: off; on without a word]
    #[arg(long, num_args = 0..=1, default_missing_value = "on", require_equals = true, help_heading = "Sun, air and ground")]
    pub flat: Option<Switch>,
    /// How molecules scatter [default: measured]
    #[arg(long, value_name = "HOW", help_heading = "Sun, air and ground")]
    pub depolarisation: Option<Depolarisation>,
    /// Top of the atmosphere in km, 1 to 120 [default: 120]
    #[arg(long, value_name = "KM", help_heading = "Sun, air and ground")]
    pub top: Option<f64>,
    /// Month, 1 to 12, which ozone goes by [default: 6]
    #[arg(long, value_name = "1..12", help_heading = "Sun, air and ground")]
    pub month: Option<u8>,
    /// Latitude in degrees, north positive, -90 to 90, which ozone goes by, and with --date the sun [default: 45]
    #[arg(long, value_name = "DEG", help_heading = "Sun, air and ground")]
    pub latitude: Option<f64>,
    /// Ozone column in Dobson units, 0 to 1000 [default: that of the month and latitude]
    #[arg(long, value_name = "DU", help_heading = "Sun, air and ground")]
    pub ozone: Option<f64>,
    /// Ozone profile: ml (McPeters-Labow, by month and latitude) or arosa (by month) [default: ml]
    #[arg(long, value_name = "SOURCE", help_heading = "Sun, air and ground")]
    pub ozone_source: Option<OzoneName>,
    /// Reflectance of the ground: 0 to 1; dry-soil, wet-soil, ocean, or one of a --table; earth, the map of the Earth, seen
    /// from above --latitude and --longitude; or a CSV file with the columns
    /// wavelength_nm,albedo [default: 0.1]
    #[arg(long, value_name = "X|NAME|FILE.csv", help_heading = "Sun, air and ground")]
    pub albedo: Option<Albedo>,

    #[command(flatten)]
    pub aerosol: AerosolArgs,
}

/// The picture if no name is given.
pub(super) const OUTPUT: &str = "sky.exr";

/// What is written of a picture, and from which tables.
#[derive(Debug, Args)]
#[command(next_help_heading = "Files")]
pub(super) struct PictureArgs {
    /// EXR file to write; the PNG and the receipt (JSON) have the same name
    #[arg(short, long, value_name = "FILE", default_value = OUTPUT)]
    pub output: PathBuf,
    /// Folder of the tables [default: those that the program carries]
    #[arg(long, value_name = "DIR")]
    pub data: Option<PathBuf>,
    /// Write no receipt (NAME.json) beside the picture; its EXR file holds one either way
    #[arg(long)]
    pub no_receipt: bool,
    /// Write the spectral channels too (S0.550,000nm in W m^-2 sr^-1 nm^-1)
    #[arg(long)]
    pub spectral: bool,
    /// Exposure of the PNG, EV at ISO 100, -30 to 30: 1.2 * 2^EV cd/m^2 is white [default: the mean
    /// logarithm of the luminance becomes 22 % of white]
    #[arg(long, value_name = "EV")]
    pub exposure: Option<f64>,
    /// Tone curve of the PNG [default: shoulder]
    #[arg(long, value_name = "CURVE")]
    pub tone: Option<Tone>,
    /// What the PNG shows as white: d65, e, sun (that above the air) or daylight of a colour temperature, 4000K to 25000K; colours are
    /// adapted by Bradford's transform [default: d65, as they are]
    #[arg(long, value_name = "WHITE")]
    pub white: Option<White>,
    /// Say nothing but errors
    #[arg(long)]
    pub quiet: bool,
    /// Print the receipt as JSON instead of words; of plan the plan, of light what is in its JSON file
    #[arg(long, conflicts_with = "quiet")]
    pub json: bool,
}

impl PictureArgs {
    /// Whether words go to standard output.
    pub(super) fn talks(&self) -> bool {
        !self.quiet && !self.json
    }
}

/// What kind of aerosol, and how much.
#[derive(Debug, Args)]
#[command(next_help_heading = "Aerosol")]
pub(super) struct AerosolArgs {
    /// Kind of aerosol: background, desert-dust, maritime-clean, maritime-mineral, polar-antarctic,
    /// polar-arctic, remote-continental, rural, urban or none [default: none]
    #[arg(long, value_name = "NAME", value_parser = biome)]
    pub biome: Option<BiomeName>,
    /// Where its optics come from: opac (Hess et al. 1998, plausible by day) or jaenicke (Jaenicke
    /// 1993 as in the thesis, hazy) [default: opac]
    #[arg(long, value_name = "NAME", value_parser = word::source)]
    pub aerosol_source: Option<AerosolSource>,
    /// Relative humidity in percent of the aerosol that takes up water, 0 to 99 [default: 80 in the
    /// boundary layer]
    #[arg(long, value_name = "PERCENT")]
    pub humidity: Option<f64>,
    /// Phase function of the aerosol: mie or hg (Henyey-Greenstein of the same asymmetry) [default: mie]
    #[arg(long, value_name = "NAME")]
    pub phase: Option<PhaseName>,
    /// Amount as vertical optical depth at 550 nm (of the whole column, whatever --top), 0 to 20
    /// [default: the type's own amount]
    #[arg(long, value_name = "X", conflicts_with_all = ["visibility", "turbidity"])]
    pub aod: Option<f64>,
    /// Amount as visibility at the ground in km, 0.05 to 400: 3.912 over the extinction at 550 nm,
    /// molecules included [default: as --aod]
    #[arg(long, value_name = "KM", conflicts_with = "turbidity")]
    pub visibility: Option<f64>,
    /// Amount as a multiple of the type's own, 0 to 1000 [default: 1]
    #[arg(long, value_name = "X")]
    pub turbidity: Option<f64>,
}

/// Samples of a block where the time decides: few, so that it is kept.
const TIMED_BLOCK: u32 = 4;

impl RenderArgs {
    /// The scene of the flags laid over `base`, validated.
    pub(super) fn scene(&self, base: Scene) -> Result<Scene, SceneError> {
        let biome = self.aerosol.biome.map_or(base.biome, |name| name.0);
        let chosen =
            [("aerosol-source", self.aerosol.aerosol_source.is_some()), ("phase", self.aerosol.phase.is_some())];
        let tables = if self.tables.is_empty() { base.tables } else { self.tables.clone() };
        // An own aerosol has a phase function too, but no source to choose.
        let needs_biome = |flag: &str| tables.is_empty() || flag == "aerosol-source";
        if let (None, Some((flag, _))) = (biome, chosen.iter().find(|(flag, given)| *given && needs_biome(flag))) {
            return Err(SceneError::no_aerosol(flag));
        }
        // An amount on the command line replaces that of the scene, of whichever kind; so does no aerosol at all.
        let none = biome.is_none() && self.aerosol.biome.is_some();
        let amount = none || self.aerosol.aod.or(self.aerosol.visibility).or(self.aerosol.turbidity).is_some();
        // The error of a plan is none of samples.
        let planned = self.auto || self.metric.is_some();
        // So does an effort.
        let effort = self.spp.is_some() || self.error.is_some() || self.time.is_some();
        let timed = self.time.filter(|_| self.error.is_none()).map(|_| TIMED_BLOCK);
        // The sun on the command line replaces the date of the scene.
        let moved = self.sun_elevation.or(self.sun_azimuth).or(self.sun_distance).is_some() || self.month.is_some();
        let scene = Scene {
            altitude_km: self.altitude.unwrap_or(base.altitude_km),
            top_km: self.top.unwrap_or(base.top_km),
            sun_elevation_deg: self.sun_elevation.unwrap_or(base.sun_elevation_deg),
            sun_azimuth_deg: self.sun_azimuth.unwrap_or(base.sun_azimuth_deg),
            sun_distance_au: self.sun_distance.unwrap_or(base.sun_distance_au),
            date: self.date.or(base.date.filter(|_| !moved)),
            longitude_deg: self.longitude.or(base.longitude_deg),
            sun_disc: self.sun_disc.map_or(base.sun_disc, |switch| switch == Switch::On),
            month: self.month.unwrap_or(base.month),
            latitude_deg: self.latitude.unwrap_or(base.latitude_deg),
            ozone_source: self.ozone_source.map_or(base.ozone_source, Into::into),
            ozone_du: self.ozone.or(base.ozone_du),
            biome,
            aerosol_source: self.aerosol.aerosol_source.unwrap_or(base.aerosol_source),
            humidity_percent: self.aerosol.humidity.or(base.humidity_percent.filter(|_| !none)),
            aod: self.aerosol.aod.or(base.aod.filter(|_| !amount)),
            visibility_km: self.aerosol.visibility.or(base.visibility_km.filter(|_| !amount)),
            turbidity: self.aerosol.turbidity.or(base.turbidity.filter(|_| !amount)),
            phase: self.aerosol.phase.map_or(base.phase, Into::into),
            tables,
            albedo: self.albedo.clone().unwrap_or(base.albedo),
            wavelengths_nm: self.wavelengths.clone().unwrap_or(base.wavelengths_nm),
            camera: self.camera.unwrap_or(base.camera),
            fov_deg: self.fov.or(base.fov_deg),
            view_azimuth_deg: self.view_azimuth.or(base.view_azimuth_deg),
            view_elevation_deg: self.view_elevation.or(base.view_elevation_deg),
            width: self.width.or(base.width),
            height: self.height.or(base.height),
            exposure_ev: self.files.exposure.or(base.exposure_ev),
            tone: self.files.tone.unwrap_or(base.tone),
            white: self.files.white.unwrap_or(base.white),
            // Either replaces the other of the scene.
            polarisation: self
                .polarisation
                .map_or(base.polarisation && self.filter.is_none(), |switch| switch == Switch::On),
            follow_polarisation: self
                .follow_polarisation
                .map(|switch| switch == Switch::On)
                .or(base.follow_polarisation),
            filter_deg: self.filter.or(base.filter_deg.filter(|_| self.polarisation != Some(Switch::On))),
            colour: self.colour.unwrap_or(base.colour),
            method: self.method.map_or(base.method, Into::into),
            steps: self.steps.or(base.steps),
            sky_type: self.sky_type.or(base.sky_type),
            orders: self.orders.or(base.orders),
            depolarisation: self.depolarisation.unwrap_or(base.depolarisation),
            sun_shape: self.sun_shape.unwrap_or(base.sun_shape),
            flat: self.flat.map_or(base.flat, |switch| switch == Switch::On),
            seed: self.seed.unwrap_or(base.seed),
            spp: self.spp.or(base.spp.filter(|_| !effort)),
            block: self.block.or(base.block).or(timed),
            error: self.error.filter(|_| !planned).map(|error| error.share).or(base.error.filter(|_| !effort)),
            table_error: self.table_error.unwrap_or_else(|| certifiable(self.certify, base.table_error)),
            fineness: self.fineness.or(base.fineness.filter(|_| self.table_error.is_none())),
        };
        let scene = scene.settled()?;
        scene.validate()?;
        Ok(scene)
    }
}

/// The error that tables are to have: half of what is to be shown, so that it can be.
fn certifiable(shown: Option<f64>, otherwise: f64) -> f64 {
    shown.map_or(otherwise, |shown| otherwise.min((0.5 * shown).max(1e-5)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::atmosphere::OzoneSource;
    use clap::Parser;

    #[derive(Debug, Parser)]
    struct Program {
        #[command(flatten)]
        args: RenderArgs,
    }

    fn scene(flags: &str) -> Result<Scene, String> {
        let words = ["airlight"].into_iter().chain(flags.split_whitespace());
        let program = Program::try_parse_from(words).map_err(|e| e.to_string())?;
        program.args.scene(Scene::default()).map_err(|e| e.to_string())
    }

    #[test]
    fn no_flags_are_the_default_scene() {
        assert_eq!(scene(""), Ok(Scene::default()));
    }

    #[test]
    fn flags_say_what_they_are_named_after() {
        let got =
            scene("--sun-elevation -5 --error 2% --albedo ocean --sun-disc off --ozone-source arosa").expect("valid");
        let expected = Scene {
            sun_elevation_deg: -5.0,
            error: Some(0.02),
            albedo: Albedo::Ground("ocean".into()),
            sun_disc: false,
            ozone_source: OzoneSource::Arosa,
            ..Scene::default()
        };
        assert_eq!(got, expected);
        assert_eq!(scene("--error 0.02").map(|s| s.error), scene("--error 2%").map(|s| s.error));
        assert_eq!(scene("--wavelengths 450,550").map(|s| s.wavelengths_nm.nm().to_vec()), Ok(vec![450.0, 550.0]));
    }

    #[test]
    fn wrong_flags_are_refused_with_what_is_possible() {
        let refusal = |flags| scene(flags).expect_err("refused");
        assert!(refusal("--camera fishey").contains("fisheye"));
        assert!(refusal("--biome urbn").contains("urban"));
        assert!(refusal("--aod 0.1").contains("name its biome"));
        assert!(refusal("--biome urban --humidity 120").contains("0 to 99 %"));
        assert!(refusal("--aod 0.1 --turbidity 3").contains("cannot be used with"));
        assert!(refusal("--sun-elevation 100").contains("-90 to 90 degrees"));
        assert!(refusal("--error 200%").contains("0.001% to 100%"));
        assert!(refusal("--wavelengths 200,300").contains("300 to 1000 nm"));
        assert!(refusal("--threads 0").contains("1..=1024"));
        assert!(refusal("--time 30").contains("30s, 5m"));
        assert!(refusal("--time 0s").contains("1s to 1000h") && refusal("--time nans").contains("1s to 1000h"));
        assert!(refusal("--shard 3/2").contains("1/N to N/N"));
        assert!(refusal("--block 3").contains("power of two"));
        assert!(refusal("--resume a.state scene.json").contains("cannot be used with"));
        assert!(refusal("--polarisation --filter 30").contains("leave out"));
    }

    #[test]
    fn a_filter_and_polarisation_replace_each_other() {
        let base = scene("--polarisation").expect("valid");
        let over = |base: &Scene, flags: &str| {
            let words = ["airlight"].into_iter().chain(flags.split_whitespace());
            let scene = Program::try_parse_from(words).expect("flags").args.scene(base.clone()).expect("valid");
            (scene.polarisation, scene.filter_deg)
        };
        assert_eq!(over(&base, ""), (true, None));
        assert_eq!(over(&base, "--filter 30"), (false, Some(30.0)));
        assert_eq!(over(&base, "--polarisation=off"), (false, None));
        let filtered = scene("--filter 30 --method judge").expect("valid");
        assert_eq!(over(&filtered, ""), (false, Some(30.0)));
        assert_eq!(over(&filtered, "--polarisation"), (true, None));
    }

    #[test]
    fn an_effort_replaces_that_of_the_scene() {
        let base = Scene { spp: Some(9), block: Some(2), ..Scene::default() };
        let over = |flags: &str| {
            let words = ["airlight"].into_iter().chain(flags.split_whitespace());
            let scene = Program::try_parse_from(words).expect("flags").args.scene(base.clone()).expect("valid");
            (scene.spp, scene.error, scene.block)
        };
        assert_eq!(over(""), (Some(9), None, Some(2)));
        assert_eq!(over("--error 1%"), (None, Some(0.01), Some(2)));
        assert_eq!(over("--time 1.5h --block 16"), (None, None, Some(16)));
        assert_eq!(time("1.5h"), Ok(Duration::from_secs(5400)));
        assert_eq!(scene("--time 1m").map(|scene| scene.block()), Ok(TIMED_BLOCK));
    }
}
