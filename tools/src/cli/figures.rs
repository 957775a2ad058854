//! The subcommands `plot` and `study`.

#[cfg(feature = "study")]
use super::print;
use super::say;
use clap::Args;
use std::path::PathBuf;
use tools::data::Data;
#[cfg(feature = "plot")]
use tools::plot;
#[cfg(feature = "study")]
use tools::study;

/// What to draw, from which tables, to where.
#[cfg(feature = "plot")]
#[derive(Args)]
pub(super) struct PlotArgs {
    /// Folder of the tables
    #[arg(long, value_name = "DIR", default_value = "data")]
    data: PathBuf,
    /// Folder of the figures; made if it is not there
    #[arg(long, value_name = "DIR", default_value = "plots")]
    out: PathBuf,
    /// Wavelength in nm, for the figure that shows one
    #[arg(long, value_name = "NM", default_value_t = plot::Settings::default().wavelength_nm)]
    wavelength: f64,
    /// Month, 1 to 12, for the figures that show one
    #[arg(long, default_value_t = plot::Settings::default().month)]
    month: u8,
    /// Latitude in degrees, north positive, for the figures that show one
    #[arg(long, value_name = "DEG", default_value_t = plot::Settings::default().latitude_deg, allow_negative_numbers = true)]
    latitude: f64,
    /// Figures; all if none is named
    #[arg(value_name = "FIGURE", value_parser = figure_names())]
    figures: Vec<String>,
    /// Say nothing but errors
    #[arg(long)]
    quiet: bool,
}

#[cfg(feature = "plot")]
fn figure_names() -> clap::builder::PossibleValuesParser {
    plot::Name::ALL.map(plot::Name::as_str).into()
}

/// Draws figures.
#[cfg(feature = "plot")]
pub(super) fn draw(args: &PlotArgs) -> Result<(), String> {
    let settings = plot::Settings { wavelength_nm: args.wavelength, month: args.month, latitude_deg: args.latitude };
    let wanted = |name: &plot::Name| args.figures.is_empty() || args.figures.iter().any(|f| f == name.as_str());
    for name in plot::Name::ALL.into_iter().filter(wanted) {
        let made = plot::make(name, Data(&args.data), &settings).map_err(|e| e.to_string())?;
        let paths = plot::write(&made, name.as_str(), &args.out).map_err(|e| e.to_string())?;
        if !args.quiet {
            let paths = paths.map(|path| path.display().to_string());
            say(&paths.join("  "));
        }
    }
    Ok(())
}

/// What to compute, from which inputs, to where.
#[cfg(feature = "study")]
#[derive(Args)]
pub(super) struct StudyArgs {
    /// Folder of the measured inputs
    #[arg(long, value_name = "DIR", default_value = "raw-data")]
    raw_data: PathBuf,
    /// Folder of the tables, for the study of fitted phase functions
    #[arg(long, value_name = "DIR", default_value = "data")]
    data: PathBuf,
    /// Folder of the results; made if it is not there
    #[arg(long, value_name = "DIR", default_value = "plots")]
    out: PathBuf,
    /// Studies; all if none is named
    #[arg(value_name = "STUDY", value_parser = study_names())]
    studies: Vec<String>,
    /// Say nothing but errors
    #[arg(long)]
    quiet: bool,
}

#[cfg(feature = "study")]
fn study_names() -> clap::builder::PossibleValuesParser {
    study::Name::ALL.map(study::Name::as_str).into()
}

/// Computes studies, and draws them if the program can. What they say in words goes to standard output.
#[cfg(feature = "study")]
pub(super) fn study(args: &StudyArgs) -> Result<(), String> {
    let wanted = |name: &study::Name| args.studies.is_empty() || args.studies.iter().any(|s| s == name.as_str());
    for name in study::Name::ALL.into_iter().filter(wanted) {
        let results = study::make(name, &args.raw_data, Data(&args.data)).map_err(|e| e.to_string())?;
        let paths = study::write(name, &results, &args.out).map_err(|e| e.to_string())?;
        if !args.quiet {
            for remark in &results.remarks {
                print(&format!("{remark}\n"))?;
            }
            let paths: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
            say(&paths.join("  "));
        }
    }
    Ok(())
}
