//! The subcommands `plot` and `study`.

use super::output::print;
use super::say;
use clap::Args;
use std::path::PathBuf;
#[cfg(feature = "plot")]
use tables::views::{AerosolSource, Biome};
use tools::data::Data;
use tools::study;
#[cfg(feature = "plot")]
use tools::{atlas, chart, column::Place, ladder, plot, stability, study::thesis::Thesis};

/// What to draw, from which tables, to where.
#[cfg(feature = "plot")]
#[derive(Args)]
pub(super) struct PlotArgs {
    /// Folder of the tables
    #[arg(long, value_name = "DIR", default_value = "data")]
    data: PathBuf,
    /// Folder of the measured inputs, for what the thesis had
    #[arg(long, value_name = "DIR", default_value = "raw-data")]
    raw_data: PathBuf,
    /// Folder of the figures; made if it is not there
    #[arg(long, value_name = "DIR", default_value = "plots")]
    out: PathBuf,
    /// Kind of aerosol: background, desert-dust, maritime-clean, maritime-mineral, polar-antarctic, polar-arctic,
    /// remote-continental, rural, urban or none [default: all nine, a figure of one biome for each]
    #[arg(long, value_name = "NAME", value_parser = biome)]
    biome: Option<BiomeName>,
    /// Where its optics come from: opac (Hess et al. 1998) or jaenicke (Jaenicke 1993, as in the thesis)
    #[arg(long, visible_alias = "source", value_name = "NAME", default_value = "opac", value_parser = source)]
    aerosol_source: AerosolSource,
    /// Relative humidity in percent of the aerosol that takes up water, 0 to 99 [default: its own, 80 in the boundary
    /// layer]
    #[arg(long, value_name = "PERCENT", allow_negative_numbers = true)]
    humidity: Option<f64>,
    /// Wavelength in nm, 300 to 1000, for the figures that show one
    #[arg(long, value_name = "NM", default_value_t = plot::Settings::default().wavelength_nm, allow_negative_numbers = true)]
    wavelength: f64,
    /// Month, 1 to 12, which ozone goes by
    #[arg(long, value_name = "1..12", default_value_t = Place::default().month)]
    month: u8,
    /// Latitude in degrees, north positive, -90 to 90, which ozone goes by
    #[arg(long, value_name = "DEG", default_value_t = Place::default().latitude_deg, allow_negative_numbers = true)]
    latitude: f64,
    /// Units of densities, cross-sections and coefficients: si (m^-3, m^2, m^-1) or thesis (km^-3, km^2, km^-1)
    #[arg(long, value_name = "NAME", default_value = "si", value_parser = units)]
    units: plot::Units,
    /// Leave out what the thesis' code had, dotted elsewise
    #[arg(long)]
    no_thesis: bool,
    /// Figures; all if none is named
    #[arg(value_name = "FIGURE", value_parser = figure_names())]
    figures: Vec<String>,
    /// Say nothing but errors
    #[arg(long)]
    quiet: bool,
}

/// A biome or none.
#[cfg(feature = "plot")]
#[derive(Debug, Clone, Copy)]
struct BiomeName(Option<Biome>);

/// The item of that name, or a sentence with all that there are.
#[cfg(feature = "plot")]
fn one_of<T>(item: Option<T>, names: impl IntoIterator<Item = &'static str>) -> Result<T, String> {
    item.ok_or_else(|| format!("one of {}", names.into_iter().collect::<Vec<_>>().join(", ")))
}

#[cfg(feature = "plot")]
fn biome(name: &str) -> Result<BiomeName, String> {
    if name == "none" {
        return Ok(BiomeName(None));
    }
    let names = Biome::ALL.into_iter().map(Biome::name).chain(["none"]);
    one_of(Biome::from_name(name), names).map(|biome| BiomeName(Some(biome)))
}

#[cfg(feature = "plot")]
fn source(name: &str) -> Result<AerosolSource, String> {
    one_of(AerosolSource::from_name(name), AerosolSource::ALL.map(AerosolSource::name))
}

#[cfg(feature = "plot")]
fn units(name: &str) -> Result<plot::Units, String> {
    one_of(plot::Units::from_name(name), plot::Units::ALL.map(plot::Units::name))
}

#[cfg(feature = "plot")]
fn figure_names() -> clap::builder::PossibleValuesParser {
    plot::Name::ALL.map(plot::Name::as_str).into()
}

#[cfg(feature = "plot")]
impl PlotArgs {
    fn settings(&self) -> plot::Settings {
        let place = Place {
            month: self.month,
            latitude_deg: self.latitude,
            source: self.aerosol_source,
            humidity_percent: self.humidity,
            ..Place::default()
        };
        let biomes = self.biome.map_or(Biome::ALL.to_vec(), |name| name.0.into_iter().collect());
        plot::Settings { place, biomes, wavelength_nm: self.wavelength, units: self.units }
    }

    /// The figures asked for; all that the case allows if none is named.
    fn names(&self, settings: &plot::Settings) -> Vec<plot::Name> {
        let wanted = |name: &plot::Name| match self.figures.as_slice() {
            [] => !(settings.biomes.is_empty() && name.needs_biome()),
            named => named.iter().any(|figure| figure == name.as_str()),
        };
        plot::Name::ALL.into_iter().filter(wanted).collect()
    }
}

/// Draws figures.
#[cfg(feature = "plot")]
pub(super) fn draw(args: &PlotArgs) -> Result<(), String> {
    let settings = args.settings();
    let thesis = || Thesis::from_dir(&args.raw_data).map_err(|e| e.to_string());
    let thesis = if args.no_thesis { None } else { Some(thesis()?) };
    for name in args.names(&settings) {
        let made = plot::make(name, Data(&args.data), &settings, thesis.as_ref()).map_err(|e| e.to_string())?;
        for (stem, plot) in made {
            let paths = plot::write(&plot, &stem, &args.out).map_err(|e| e.to_string())?;
            if !args.quiet {
                let paths = paths.map(|path| path.display().to_string());
                say(&paths.join("  "));
            }
        }
    }
    Ok(())
}

/// What to draw.
#[cfg(feature = "plot")]
#[derive(Args)]
pub(super) struct ChartArgs {
    /// CSV files: a line `# title`, the header panel,curve,X,Y with the names of the axes, and a row for each point; or the rows of
    /// `airlight study ladder`, which make a chart of all regimes and one of each; or those of `airlight study stability`, a figure of
    /// each map; or of `airlight study atlas`
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Say nothing but errors
    #[arg(long)]
    quiet: bool,
}

/// Draws charts of points beside their files.
#[cfg(feature = "plot")]
pub(super) fn chart(args: &ChartArgs) -> Result<(), String> {
    for file in &args.files {
        let name = file.display().to_string();
        let bytes = std::fs::read(file).map_err(|e| format!("{name}: cannot be read: {e}"))?;
        let figures = if atlas::is_atlas(&bytes) {
            let rows = atlas::parse(&name, &bytes).map_err(|e| e.to_string())?;
            vec![(String::new(), plot::atlas::figure(&rows))]
        } else if ladder::is_ladder(&bytes) {
            plot::ladder::figures(&ladder::parse(&name, &bytes).map_err(|e| e.to_string())?)
        } else if stability::is_stability(&bytes) {
            let maps = stability::parse(&name, &bytes).map_err(|e| e.to_string())?;
            maps.iter().map(|map| (format!("-{}", map.name), plot::stability::figure(map))).collect()
        } else {
            vec![(String::new(), plot::chart::figure(&chart::parse(&name, &bytes).map_err(|e| e.to_string())?))]
        };
        for (end, figure) in figures {
            let mut stem = file.with_extension("").into_os_string();
            stem.push(end);
            for (ending, bytes) in [("svg", plot::svg(&figure)), ("png", plot::png(&figure))] {
                let mut path = stem.clone();
                path.push(format!(".{ending}"));
                let path = PathBuf::from(path);
                if !args.quiet {
                    super::output::announce(&path);
                }
                tables::file::replace(&path, &bytes.map_err(|e| e.to_string())?)
                    .map_err(|e| format!("{}: cannot be written: {e}", path.display()))?;
                if !args.quiet {
                    say(&path.display().to_string());
                }
            }
        }
    }
    Ok(())
}

/// What to compute, from which inputs, to where.
#[derive(Args)]
pub(super) struct StudyArgs {
    /// Folder of the measured inputs
    #[arg(long, value_name = "DIR", default_value = "raw-data")]
    raw_data: PathBuf,
    /// Folder of the tables, for the studies that are about them
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

fn study_names() -> clap::builder::PossibleValuesParser {
    study::Name::ALL.map(study::Name::as_str).into()
}

/// Computes studies, and draws them if the program can. What they say in words goes to standard output.
pub(super) fn study(args: &StudyArgs) -> Result<(), String> {
    let wanted = |name: &study::Name| args.studies.is_empty() || args.studies.iter().any(|s| s == name.as_str());
    for name in study::Name::ALL.into_iter().filter(wanted) {
        let results = study::make(name, &args.raw_data, Data(&args.data)).map_err(|e| e.to_string())?;
        let paths = study::write(name, &results, &args.out).map_err(|e| e.to_string())?;
        if !args.quiet {
            for remark in &results.remarks {
                print(format!("{remark}\n").as_bytes())?;
            }
            let paths: Vec<String> = paths.iter().map(|path| path.display().to_string()).collect();
            say(&paths.join("  "));
        }
    }
    Ok(())
}
