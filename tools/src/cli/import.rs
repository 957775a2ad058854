//! The subcommand `import`.

use super::{say, size};
use clap::{Args, Subcommand};
use std::path::{Path, PathBuf};
use tables::units::KM;
use tools::own::aerosol::{Distribution, Index, Modes, OwnAerosol, OwnProfile, OwnSizes, Vertical};
use tools::own::atmosphere::Sounding;
use tools::own::ozone::{Completion, Sonde};
use tools::own::{Import, OwnError, aerosol, albedo, atmosphere, ozone, sun};
use tools::raw::RawData;
use tools::raw::us_standard_atmosphere::UsStandardAtmosphere;

/// Arguments of `import`.
#[derive(Args)]
pub(super) struct ImportArgs {
    #[command(subcommand)]
    kind: KindArgs,
    /// Table to write, for `airlight render --table`
    #[arg(short, long, value_name = "FILE.table", default_value = "own.table", global = true)]
    output: PathBuf,
    /// A column to leave out, by its name in the file; may be given more than once
    #[arg(long, value_name = "COLUMN", global = true)]
    ignore: Vec<String>,
    /// Folder of the measured inputs, for what the file does not say
    #[arg(long, value_name = "DIR", default_value = "raw-data", global = true)]
    raw_data: PathBuf,
    /// Say nothing but errors
    #[arg(long, global = true)]
    quiet: bool,
}

#[derive(Subcommand)]
enum KindArgs {
    /// Particles of your own sizes, refractive index and vertical profile, 300 to 1000 nm
    Aerosol(AerosolArgs),
    /// A radiosonde or another profile of air: altitude, temperature, pressure; completed to 120 km by the standard
    /// atmosphere
    Atmosphere {
        /// CSV: altitude_m|km, temperature_k|c, and pressure_pa|hpa|mbar|kpa or number_density_m3|cm3
        file: PathBuf,
        /// The altitudes are geopotential (as most radiosondes have them)
        #[arg(long)]
        geopotential: bool,
    },
    /// An ozone sonde; completed to 120 km by the climatology
    Ozone(OzoneArgs),
    /// A solar spectrum at 1 au over all of 300 to 1000 nm; limb darkening as in data/
    Sun {
        /// CSV: wavelength_nm|um and irradiance_w_m2_nm|mw_m2_nm|w_m2_um|photons_s_m2_nm|photons_s_cm2_nm
        file: PathBuf,
    },
    /// The albedo of a ground, for `airlight render --albedo NAME`
    Albedo {
        /// CSV: wavelength_nm|um and albedo (0 to 1) or albedo_percent
        file: PathBuf,
        /// Name of the ground
        #[arg(long)]
        name: String,
    },
}

#[derive(Args)]
struct AerosolArgs {
    /// CSV of log-normal modes: median_radius_um|nm, sigma_g, number_density_cm3|m3 or number_share, possibly
    /// smallest_radius_um, largest_radius_um and material [default: --sizes instead]
    #[arg(long, value_name = "CSV", required_unless_present = "sizes", conflicts_with = "sizes")]
    modes: Option<PathBuf>,
    /// CSV of a measured size distribution: radius_um|nm or diameter, and dn_dlogr_cm3 (decadic), dn_dlnr_cm3 or
    /// dn_dr_cm3_um [default: --modes instead]
    #[arg(long, value_name = "CSV")]
    sizes: Option<PathBuf>,
    /// CSV of a refractive index n + ik: wavelength_nm|um over all of 300 to 1000 nm, n, k >= 0; once for each material of
    /// the modes
    #[arg(long, value_name = "[MATERIAL=]CSV", required = true)]
    index: Vec<String>,
    /// Scale height in km, 0.05 to 99 (99: constant), of exp(-z / KM) from the ground to --top [default: --profile instead]
    #[arg(long, value_name = "KM", requires = "top", required_unless_present = "profile")]
    scale_height: Option<f64>,
    /// Where the aerosol ends, in km, 0.05 to 120 [default: as --profile has it]
    #[arg(long, value_name = "KM", requires = "scale_height")]
    top: Option<f64>,
    /// CSV of a vertical profile instead: altitude_m|km, and number_density_cm3|m3 or relative [default: --scale-height instead]
    #[arg(long, value_name = "CSV", conflicts_with = "scale_height")]
    profile: Option<PathBuf>,
    /// Particles per cm3 at the ground, 1e-6 to 1e7, where the modes are shares or to scale measured sizes [default: that of the files]
    #[arg(long, value_name = "CM-3")]
    number_density: Option<f64>,
    /// Name of the aerosol
    #[arg(long)]
    name: String,
}

#[derive(Args)]
struct OzoneArgs {
    /// CSV: altitude_m|km or pressure_pa|hpa|mbar|kpa or both, ozone_partial_pressure_mpa, ozone_mixing_ratio_ppmv or
    /// ozone_number_density_m3|cm3, and possibly temperature_k|c
    file: PathBuf,
    /// Month, 1 to 12, of the climatology above the last level
    #[arg(long, value_name = "1..12")]
    month: u8,
    /// Latitude in degrees, north positive, -90 to 90, of the climatology above the last level
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    latitude: f64,
    /// Scale all of it to this column in Dobson units, 1 to 1000 [default: as measured]
    #[arg(long, value_name = "DU")]
    column: Option<f64>,
    /// The altitudes are geopotential
    #[arg(long)]
    geopotential: bool,
}

/// Makes a table of somebody's own input.
pub(super) fn import(args: &ImportArgs) -> Result<(), String> {
    let made = table(args)?;
    if !args.quiet {
        super::output::announce(&args.output);
    }
    let bytes = made.write(&args.output).map_err(|e| e.at(&args.output).to_string())?;
    if !args.quiet {
        for note in &made.notes {
            say(note);
        }
        say(&format!("{}  {}  {}: {}", args.output.display(), size(bytes), made.table.kind, made.table.title));
    }
    Ok(())
}

fn table(args: &ImportArgs) -> Result<Import, String> {
    let raw = |error: tools::raw::RawError| format!("raw data {error}");
    let ignored = args.ignore.as_slice();
    let made = match &args.kind {
        KindArgs::Aerosol(own) => aerosol::table(&own.read(ignored)?),
        KindArgs::Atmosphere { file, geopotential } => {
            let sounding = parsed(file, |name, bytes| Sounding::parse(name, bytes, ignored, *geopotential))?;
            atmosphere::table(&sounding, &UsStandardAtmosphere::from_dir(&args.raw_data).map_err(raw)?)
        }
        KindArgs::Ozone(own) => {
            let sonde = parsed(&own.file, |name, bytes| Sonde::parse(name, bytes, ignored))?;
            let completion = Completion {
                month: own.month,
                latitude_deg: own.latitude,
                geopotential: own.geopotential,
                column_du: own.column,
            };
            ozone::table(&sonde, &RawData::from_dir(&args.raw_data).map_err(raw)?, completion)
        }
        KindArgs::Sun { file } => {
            let spectrum = parsed(file, |name, bytes| sun::Spectrum::parse(name, bytes, ignored))?;
            sun::table(&spectrum, &tools::raw::sun::Sun::from_dir(&args.raw_data).map_err(raw)?)
        }
        KindArgs::Albedo { file, name } => {
            albedo::table(&parsed(file, |name, bytes| albedo::Spectrum::parse(name, bytes, ignored))?, name)
        }
    };
    made.map_err(|e: OwnError| e.to_string())
}

/// Reads a file through `parse`.
fn parsed<T>(file: &Path, parse: impl Fn(&str, &[u8]) -> Result<T, tools::raw::RawError>) -> Result<T, String> {
    let bytes = std::fs::read(file).map_err(|e| format!("{}: cannot be read: {e}", file.display()))?;
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    parse(&name, &bytes).map_err(|e| e.to_string())
}

impl AerosolArgs {
    fn read(&self, ignored: &[String]) -> Result<OwnAerosol, String> {
        let sizes = match (&self.modes, &self.sizes) {
            (Some(file), _) => OwnSizes::Modes(parsed(file, |name, bytes| Modes::parse(name, bytes, ignored))?),
            (None, Some(file)) => {
                OwnSizes::Distribution(parsed(file, |name, bytes| Distribution::parse(name, bytes, ignored))?)
            }
            (None, None) => return Err("say the sizes with --modes or --sizes".into()),
        };
        let mut indices: Vec<(String, Index)> = Vec::new();
        for text in &self.index {
            let (material, file) = text.split_once('=').unwrap_or(("particles", text));
            if indices.iter().any(|(known, _)| known == material) {
                return Err(format!("two refractive indices of {material}: name each with --index MATERIAL=CSV"));
            }
            let index = parsed(Path::new(file), |name, bytes| Index::parse(name, bytes, ignored))?;
            indices.push((material.into(), index));
        }
        let profile = match (&self.profile, self.scale_height, self.top) {
            (Some(file), ..) => OwnProfile::Levels(parsed(file, |name, bytes| Vertical::parse(name, bytes, ignored))?),
            (None, Some(scale_height), Some(top)) => {
                OwnProfile::Exponential { scale_height: scale_height * KM, top: top * KM }
            }
            _ => return Err("say where the particles are with --scale-height and --top, or with --profile".into()),
        };
        let number_density = self.number_density.map(|per_cm3| per_cm3 * 1e6);
        Ok(OwnAerosol { name: self.name.clone(), sizes, indices, profile, number_density })
    }
}
