//! The air over a place, as flags.

use clap::Args;
use std::path::PathBuf;
use tables::views::{AerosolSource, Biome};
use tools::column::Place;

/// Which air.
#[derive(Args)]
pub(super) struct PlaceArgs {
    /// Kind of aerosol, in its own amount
    #[arg(long, value_name = "NAME", default_value = NONE, value_parser = biome_names())]
    biome: String,
    /// Where its optics come from [default: opac]
    #[arg(long, value_name = "NAME", value_parser = AerosolSource::ALL.map(AerosolSource::name))]
    aerosol_source: Option<String>,
    /// Relative humidity in percent of the aerosol that takes up water, 0 to 99 [default: 80 in the boundary layer]
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true)]
    humidity: Option<f64>,
    /// Month, 1 to 12, which ozone goes by
    #[arg(long, value_name = "1..12", default_value_t = Place::default().month, value_parser = clap::value_parser!(u8).range(1..=12))]
    month: u8,
    /// Latitude in degrees, north positive, -90 to 90, which ozone goes by
    #[arg(long, value_name = "DEG", default_value_t = Place::default().latitude_deg, allow_negative_numbers = true)]
    latitude: f64,
    /// Folder of the tables
    #[arg(long, value_name = "DIR", default_value = "data")]
    pub(super) data: PathBuf,
}

/// What stands for no aerosol.
const NONE: &str = "none";

fn biome_names() -> clap::builder::PossibleValuesParser {
    Biome::ALL.map(Biome::name).into_iter().chain([NONE]).collect::<Vec<_>>().into()
}

impl PlaceArgs {
    /// The place.
    pub(super) fn place(&self) -> Result<Place, String> {
        let biome = Biome::from_name(&self.biome);
        let given = [("--aerosol-source", self.aerosol_source.is_some()), ("--humidity", self.humidity.is_some())];
        if let (None, Some((flag, _))) = (biome, given.into_iter().find(|(_, given)| *given)) {
            return Err(format!("{flag} says something of an aerosol: name its --biome too"));
        }
        let source = self.aerosol_source.as_deref().and_then(AerosolSource::from_name);
        Ok(Place {
            month: self.month,
            latitude_deg: self.latitude,
            biome,
            source: source.unwrap_or(Place::default().source),
            humidity_percent: self.humidity,
        })
    }
}
