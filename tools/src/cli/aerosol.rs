//! The subcommand `biomes`.

use clap::Args;
use serde_json::{Value, json};
use std::path::PathBuf;
use tables::units::KM;
use tables::views::{Aerosol, AerosolSource, Biome, REFERENCE_WAVELENGTH_NM};
use tools::raw::aerosol_gavin::AerosolGavin;

/// Arguments of `biomes`.
#[derive(Args)]
pub(super) struct BiomesArgs {
    /// Folder of the measured inputs, for what the thesis had
    #[arg(long, value_name = "DIR", default_value = "raw-data")]
    raw_data: PathBuf,
    /// Folder of the tables
    #[arg(long, value_name = "DIR", default_value = "data")]
    data: PathBuf,
    /// An array of JSON instead of a table in Markdown
    #[arg(long)]
    json: bool,
}

/// Bulk optics of an aerosol at the ground.
struct AtGround {
    /// m^-1 at 550 nm.
    extinction: f64,
    albedo: f64,
    asymmetry: f64,
    /// -d ln(extinction) / d ln(wavelength) between 440 and 870 nm.
    angstrom: f64,
}

fn at_ground(aerosol: &Aerosol) -> Result<AtGround, tables::TableError> {
    let (mut extinction, mut scattering, mut forward) = (0.0, 0.0, 0.0);
    for species in &aerosol.species {
        let density = species.number_density_m3.at(0.0)?;
        let optics = species.optics(species.default_humidity_percent, REFERENCE_WAVELENGTH_NM)?;
        extinction += density * optics.extinction_m2;
        scattering += density * optics.scattering_m2;
        forward += density * optics.scattering_m2 * optics.asymmetry;
    }
    let (blue, red) = (aerosol.ground_extinction(None, 440.0)?, aerosol.ground_extinction(None, 870.0)?);
    let angstrom = -(blue / red).ln() / (440.0_f64 / 870.0).ln();
    Ok(AtGround { extinction, albedo: scattering / extinction, asymmetry: forward / scattering, angstrom })
}

/// A row as JSON.
fn row(biome: Biome, source: &str, ground: &AtGround, depth: f64) -> Value {
    json!({
        "biome": biome.name(),
        "source": source,
        "extinction_at_ground_550nm_m_1": ground.extinction,
        "albedo_550nm": ground.albedo,
        "asymmetry_550nm": ground.asymmetry,
        "angstrom_440_870nm": ground.angstrom,
        "optical_depth_550nm": depth,
    })
}

/// Prints a table in Markdown, or as JSON.
pub(super) fn biomes(args: &BiomesArgs) -> Result<(), String> {
    let thesis = AerosolGavin::from_dir(&args.raw_data).map_err(|e| e.to_string())?;
    let mut rows = Vec::new();
    let mut text = String::from(
        "| biome | source | extinction at the ground, 550 nm (km^-1) | albedo | g | Angstrom exponent 440/870 nm | optical depth, 550 nm |\n\
         |---|---|---|---|---|---|---|\n",
    );
    for (biome, had) in Biome::ALL.into_iter().zip(&thesis.biomes.rows) {
        for source in AerosolSource::ALL {
            let path = args.data.join(Aerosol::file_name(source, biome));
            let read = || -> Result<_, tables::TableError> {
                let aerosol = Aerosol::from_table(&tables::file::read(&path)?)?;
                Ok((at_ground(&aerosol)?, aerosol.own_optical_depth()?))
            };
            let (ground, depth) = read().map_err(|e| e.at(&path).to_string())?;
            rows.push(row(biome, source.name(), &ground, depth));
            let AtGround { extinction, albedo, asymmetry, angstrom } = ground;
            text += &format!(
                "| {biome} | {source} | {:.5} | {albedo:.4} | {asymmetry:.4} | {angstrom:.2} | {depth:.4} |\n",
                extinction * KM
            );
        }
        // The scale height times the density at the ground and the background up to 86 km.
        let top = 86.0 * KM;
        let height = had
            .scale_height
            .map_or(top, |h| h * (1.0 - (-top / h).exp()) + top * had.background_density / had.base_density);
        let (extinction, albedo) = (had.ground_extinction, had.albedo);
        // It had one asymmetry, and one wavelength.
        let ground = AtGround { extinction, albedo, asymmetry: 0.76, angstrom: f64::NAN };
        rows.push(row(biome, "thesis", &ground, had.ground_extinction * height));
        text += &format!(
            "| {biome} | thesis | {:.5} | {:.4} | 0.76 | | {:.3} |\n",
            had.ground_extinction * KM,
            had.albedo,
            had.ground_extinction * height
        );
    }
    if args.json {
        text = serde_json::to_string_pretty(&rows).map_err(|e| e.to_string())? + "\n";
    }
    super::output::print(text.as_bytes())
}
