//! The subcommand `coefficients`.

use super::files::OutputArgs;
use super::output;
use super::place::PlaceArgs;
use clap::Args;
use tools::coefficients::{self, Quantity, Request};
use tools::data::Data;
use tools::numbers::Numbers;
use tools::sheet::Format;

/// Arguments of `coefficients`.
#[derive(Args)]
pub(super) struct CoefficientsArgs {
    /// Geometric altitudes in km, 0 to 120: a number, a list (0,1,2.5), a range LOW:HIGH:STEP (0:80:1)
    #[arg(long, value_name = "KM", default_value = "0", allow_negative_numbers = true)]
    altitude: Numbers,
    /// Wavelengths in nm, 300 to 1000: a number, a list, a range
    #[arg(long, value_name = "NM", default_value = "550", allow_negative_numbers = true)]
    wavelength: Numbers,
    /// Quantities, separated by commas [default: all but phase; with --angle: phase]
    #[arg(long, value_name = "NAME", value_delimiter = ',', value_parser = quantity_names())]
    quantity: Vec<String>,
    /// Scattering angles of phase functions in degrees, 0 (forward) to 180: a number, a list, a range
    /// [default: 0:180:10]
    #[arg(long, value_name = "DEG", allow_negative_numbers = true)]
    angle: Option<Numbers>,
    /// Species to keep, separated by commas: molecules, ozone, those of the aerosol, aerosol (their sum), total
    /// [default: all]
    #[arg(long, value_name = "NAME", value_delimiter = ',')]
    species: Vec<String>,
    #[command(flatten)]
    place: PlaceArgs,
    #[command(flatten)]
    output: OutputArgs,
}

fn quantity_names() -> clap::builder::PossibleValuesParser {
    Quantity::ALL.map(Quantity::name).into()
}

/// Writes what is asked for.
pub(super) fn write(args: &CoefficientsArgs) -> Result<(), String> {
    let place = args.place.place()?;
    let quantities = match (&args.quantity[..], &args.angle) {
        ([], Some(_)) => vec![Quantity::Phase],
        ([], None) => Quantity::ALL.into_iter().filter(|quantity| *quantity != Quantity::Phase).collect(),
        (names, angle) => {
            let mut quantities = Quantity::ALL.to_vec();
            quantities.retain(|q| names.iter().any(|name| name == q.name()));
            if angle.is_some() && !quantities.contains(&Quantity::Phase) {
                quantities.push(Quantity::Phase);
            }
            quantities
        }
    };
    let angles = args.angle.clone().map_or_else(|| (0..=18).map(|i| 10.0 * f64::from(i)).collect(), |angles| angles.0);
    let request = Request {
        altitudes_km: args.altitude.0.clone(),
        wavelengths_nm: args.wavelength.0.clone(),
        angles_deg: angles,
        quantities,
        species: args.species.clone(),
    };
    let format = args.output.format(Format::Text)?;
    let sheet = coefficients::sheet(Data(&args.place.data), &place, &request).map_err(|e| e.to_string())?;
    let bytes = sheet.encode(format, args.output.bare).map_err(|e| e.to_string())?;
    output::put(&bytes, args.output.file())
}
