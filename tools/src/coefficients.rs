//! What others need of the air over a place, as a [`Sheet`]: number densities, cross-sections, coefficients, optical
//! depths and phase functions at altitudes and wavelengths, a row for each species and for their sums.

use crate::column::{Column, Parts, Place, Species};
use crate::data::Data;
use crate::sheet::{Series, Sheet, SheetError, Values};
use crate::sources::Sources;
use crate::text::shortest;
use rayon::prelude::*;
use std::f64::consts::PI;
use tables::TableError;
use tables::units::KM;

/// The most rows of a sheet.
const MOST_ROWS: usize = 2_000_000;

/// Names of the rows that are sums: of the aerosol's species, and of all.
const SUMS: [&str; 2] = ["aerosol", "total"];

/// Why there is no such sheet.
#[derive(Debug, thiserror::Error)]
pub enum CoefficientsError {
    /// A table cannot be read or asked.
    #[error(transparent)]
    Table(#[from] TableError),
    /// The sheet cannot be made.
    #[error(transparent)]
    Sheet(#[from] SheetError),
    /// Something outside what is possible.
    #[error("{name} {value} {unit}: {low} to {high} {unit} is possible")]
    Outside {
        /// What was asked for.
        name: &'static str,
        /// Its value.
        value: f64,
        /// Lowest value.
        low: f64,
        /// Highest value.
        high: f64,
        /// Their unit.
        unit: &'static str,
    },
    /// A species that is not there.
    #[error("no species is called {name:?} here: possible are {}", known.join(", "))]
    Species {
        /// The name.
        name: String,
        /// Names that there are.
        known: Vec<String>,
    },
    /// A humidity for an aerosol that has one state only.
    #[error("a humidity has no effect: no aerosol that takes up water here was asked for")]
    Humidity,
    /// More rows than anyone wants.
    #[error("{rows} rows: at most {MOST_ROWS} are possible")]
    TooMany {
        /// Rows asked for.
        rows: usize,
    },
}

/// Something to print.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Quantity {
    /// Number density N in m^-3.
    Density,
    /// Cross-section sigma of one particle in m^2.
    CrossSection,
    /// Coefficient N sigma in m^-1, single-scattering albedo and asymmetry parameter.
    Coefficient,
    /// Vertical optical depth above and below the altitude.
    OpticalDepth,
    /// Phase function in sr^-1.
    Phase,
}

impl Quantity {
    /// Every quantity, in the order of the columns.
    pub const ALL: [Self; 5] = [Self::Density, Self::CrossSection, Self::Coefficient, Self::OpticalDepth, Self::Phase];

    /// Its name in flags.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Density => "density",
            Self::CrossSection => "cross-section",
            Self::Coefficient => "coefficient",
            Self::OpticalDepth => "optical-depth",
            Self::Phase => "phase",
        }
    }

    /// The quantity of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quantity| quantity.name() == name)
    }
}

/// What is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// Geometric altitudes in km, 0 to 120.
    pub altitudes_km: Vec<f64>,
    /// Wavelengths in nm, 300 to 1000.
    pub wavelengths_nm: Vec<f64>,
    /// Scattering angles in degrees, 0 (forward) to 180, for [`Quantity::Phase`].
    pub angles_deg: Vec<f64>,
    /// The quantities.
    pub quantities: Vec<Quantity>,
    /// Names of the species to keep; all, and their sums, if empty.
    pub species: Vec<String>,
}

impl Request {
    fn wants(&self, quantity: Quantity) -> bool {
        self.quantities.contains(&quantity)
    }
}

/// One species, or a sum of some, at one altitude and wavelength.
#[derive(Debug, Clone, Default)]
struct Row {
    density: Option<f64>,
    cross_sections: Option<Parts>,
    coefficients: Parts,
    albedo: Option<f64>,
    asymmetry: Option<f64>,
    above: Parts,
    below: Parts,
    /// At each angle; `None` where nothing scatters.
    phase: Option<Vec<f64>>,
}

impl Row {
    /// Of one species.
    fn of(column: &Column, request: &Request, species: Species, nm: f64, m: f64) -> Result<Self, TableError> {
        let cross_sections = column.cross_sections(species, nm, m)?;
        let mut row = Self {
            density: Some(column.density(species).at(m)?),
            cross_sections: Some(cross_sections),
            coefficients: column.coefficients(species, nm, m)?,
            albedo: ratio(cross_sections.scattering, cross_sections.extinction()),
            asymmetry: column.asymmetry(species, nm)?,
            ..Self::default()
        };
        if request.wants(Quantity::OpticalDepth) {
            let (ground, top) = column.air().number_density_m3.axis().range();
            row.above = column.optical_depth(species, nm, (m, top))?;
            row.below = column.optical_depth(species, nm, (ground, m))?;
        }
        if request.wants(Quantity::Phase) {
            let cosines: Vec<f64> = request.angles_deg.iter().map(|angle| (angle * PI / 180.0).cos()).collect();
            row.phase = column.phase(species, nm, &cosines)?;
        }
        Ok(row)
    }

    /// Coefficients and optical depths add up; asymmetry and phase function are means weighted by scattering.
    fn sum(rows: &[Self]) -> Self {
        let coefficients: Parts = rows.iter().map(|row| row.coefficients).sum();
        let weighted = |value: &dyn Fn(&Self) -> Option<f64>| {
            let sum: f64 = rows.iter().filter_map(|row| Some(row.coefficients.scattering * value(row)?)).sum();
            ratio(sum, coefficients.scattering)
        };
        let angles = rows.iter().filter_map(|row| row.phase.as_ref()).map(Vec::len).max().unwrap_or(0);
        let phase = |angle: usize| weighted(&|row| Some(row.phase.as_ref()?[angle]));
        Self {
            density: None,
            cross_sections: None,
            coefficients,
            albedo: ratio(coefficients.scattering, coefficients.extinction()),
            asymmetry: weighted(&|row| row.asymmetry),
            above: rows.iter().map(|row| row.above).sum(),
            below: rows.iter().map(|row| row.below).sum(),
            phase: (0..angles).map(phase).collect::<Option<Vec<f64>>>().filter(|phase| !phase.is_empty()),
        }
    }
}

/// a / b; `None` of nothing.
fn ratio(a: f64, b: f64) -> Option<f64> {
    (b > 0.0).then(|| a / b)
}

/// The sheet of a request: by altitude, wavelength, species and, with phase functions, angle.
///
/// Rows of a species have all its quantities. The row `aerosol`, where there is one, sums those of the aerosol, and
/// `total` all: their coefficients and optical depths are sums, albedo, asymmetry and phase function those of the
/// mixture (weighted by scattering); they have no number density and no cross-section. Optical depths are vertical,
/// `above` from the altitude to 120 km, `below` from the ground to it.
///
/// # Errors
/// [`CoefficientsError`] naming what is possible.
pub fn sheet(data: Data<'_>, place: &Place, request: &Request) -> Result<Sheet, CoefficientsError> {
    let column = Column::read(data, place)?;
    check(&column, place, request)?;
    let species = column.species();
    let mut names: Vec<&str> = species.iter().map(|&s| column.name(s)).collect();
    // An aerosol of one species that is called so is its own sum.
    let sums = if column.aerosols().is_empty() || names.contains(&SUMS[0]) { &SUMS[1..] } else { &SUMS[..] };
    names.extend(sums);
    if let Some(name) = request.species.iter().find(|name| !names.contains(&name.as_str())) {
        let known = names.iter().map(|&name| name.into()).collect();
        return Err(CoefficientsError::Species { name: name.clone(), known });
    }
    let kept = |i: usize| request.species.is_empty() || request.species.iter().any(|name| name == names[i]);
    let angles = if request.wants(Quantity::Phase) { request.angles_deg.len() } else { 1 };
    let count = (0..names.len()).filter(|&i| kept(i)).count();
    let rows = request.altitudes_km.len().saturating_mul(request.wavelengths_nm.len()) * count * angles;
    if rows > MOST_ROWS {
        return Err(CoefficientsError::TooMany { rows });
    }

    let places: Vec<(f64, f64)> =
        request.altitudes_km.iter().flat_map(|&km| request.wavelengths_nm.iter().map(move |&nm| (km, nm))).collect();
    let rows: Result<Vec<Vec<Row>>, TableError> = places
        .par_iter()
        .map(|&(km, nm)| {
            let one = |&s: &Species| Row::of(&column, request, s, nm, km * KM);
            let mut rows = species.iter().map(one).collect::<Result<Vec<_>, _>>()?;
            let aerosol = Row::sum(&rows[2..]);
            let total = Row::sum(&rows);
            rows.extend((sums.len() == SUMS.len()).then_some(aerosol));
            rows.push(total);
            Ok(rows)
        })
        .collect();
    let rows = rows?;
    let mut lines = Vec::new();
    for ((km, nm), rows) in places.iter().zip(&rows) {
        for (i, row) in rows.iter().enumerate().filter(|&(i, _)| kept(i)) {
            // A table of phase functions alone has no lines for what does not scatter.
            if request.quantities != [Quantity::Phase] || row.phase.is_some() {
                lines.extend((0..angles).map(|angle| Line { km: *km, nm: *nm, name: names[i], angle, row }));
            }
        }
    }
    let sources = Sources::of(data.0, &place.table_files())?;
    Ok(Sheet::new(title(request), settings(&column, place)?, sources, columns(request, &lines))?)
}

fn check(column: &Column, place: &Place, request: &Request) -> Result<(), CoefficientsError> {
    let within = |name, values: &[f64], (low, high): (f64, f64), unit| match values
        .iter()
        .find(|value| !(low..=high).contains(*value))
    {
        None => Ok(()),
        Some(&value) => Err(CoefficientsError::Outside { name, value, low, high, unit }),
    };
    let (ground, top) = column.air().number_density_m3.axis().range();
    within("latitude", &[place.latitude_deg], (-90.0, 90.0), "degrees")?;
    within("altitude", &request.altitudes_km, (ground / KM, top / KM), "km")?;
    within("wavelength", &request.wavelengths_nm, column.wavelength_range_nm(), "nm")?;
    within("angle", &request.angles_deg, (0.0, 180.0), "degrees")?;
    if let Some(humidity) = place.humidity_percent {
        within("humidity", &[humidity], (0.0, 99.0), "%")?;
        if !column.aerosols().iter().any(|&s| column.humidity_percent(s) == Some(humidity)) {
            return Err(CoefficientsError::Humidity);
        }
    }
    Ok(())
}

fn title(request: &Request) -> String {
    let names: Vec<&str> = request.quantities.iter().map(|quantity| quantity.name()).collect();
    format!("The air over one place: {}", names.join(", "))
}

/// What the air over a place is, as pairs of name and value: month, latitude, ozone in Dobson units, aerosol and its humidities.
///
/// # Errors
/// [`TableError`] if a table does not reach.
pub fn settings(column: &Column, place: &Place) -> Result<Vec<(String, String)>, TableError> {
    let mut settings = vec![
        ("month".into(), place.month.to_string()),
        ("latitude".into(), format!("{} degrees north", shortest(place.latitude_deg))),
        ("ozone".into(), format!("{:.1} DU", column.ozone_du())),
    ];
    let Some(biome) = place.biome else {
        settings.push(("aerosol".into(), "none".into()));
        return Ok(settings);
    };
    settings.push(("aerosol".into(), format!("{biome} after {}", place.source)));
    for species in column.aerosols() {
        if let Some(humidity) = column.humidity_percent(species) {
            settings.push((format!("humidity of {}", column.name(species)), format!("{} %", shortest(humidity))));
        }
    }
    Ok(settings)
}

/// A row of the sheet.
struct Line<'a> {
    km: f64,
    nm: f64,
    name: &'a str,
    angle: usize,
    row: &'a Row,
}

fn columns(request: &Request, lines: &[Line<'_>]) -> Vec<Series> {
    type Value<'a> = &'a dyn Fn(&Line<'_>) -> Option<f64>;
    let key = |name: &str, label: &str, unit: &str, meaning: &str, value: Value<'_>| Series {
        name: name.into(),
        label: label.into(),
        unit: unit.into(),
        meaning: meaning.into(),
        group: None,
        values: Values::Numbers(lines.iter().map(value).collect()),
    };
    let mut columns = vec![
        key("altitude_km", "altitude", "km", "geometric altitude", &|line| Some(line.km)),
        key("wavelength_nm", "wavelength", "nm", "wavelength in vacuum", &|line| Some(line.nm)),
        Series {
            values: Values::Words(lines.iter().map(|line| line.name.into()).collect()),
            ..key("species", "species", "text", "kind of particle, or sum over some", &|_| None)
        },
    ];
    let mut add = |group: &'static str, name: &str, label: &str, unit: &str, meaning: &str, value: Value<'_>| {
        columns.push(Series { group: Some(group), ..key(name, label, unit, meaning, value) });
    };
    if request.wants(Quantity::Density) {
        add("number density", "number_density_per_m3", "particles", "m^-3", "particles per volume", &|line| {
            line.row.density
        });
    }
    type Part = fn(&Parts) -> f64;
    let parts: [(&str, Part); 3] = [
        ("scattering", |parts| parts.scattering),
        ("absorption", |parts| parts.absorption),
        ("extinction", |parts| parts.extinction()),
    ];
    if request.wants(Quantity::CrossSection) {
        for (part, value) in parts {
            let (name, meaning) = (format!("{part}_cross_section_m2"), format!("{part} cross-section of one particle"));
            add("cross-section", &name, part, "m^2", &meaning, &|line| line.row.cross_sections.as_ref().map(value));
        }
    }
    if request.wants(Quantity::Coefficient) {
        for (part, value) in parts {
            let (name, meaning) = (format!("{part}_coefficient_per_m"), format!("{part} coefficient"));
            add("coefficient", &name, part, "m^-1", &meaning, &|line| Some(value(&line.row.coefficients)));
        }
        let meaning = "scattered share of what is taken from a beam";
        add("coefficient", "single_scattering_albedo", "albedo", "1", meaning, &|line| line.row.albedo);
        let meaning = "mean cosine of the scattering angle";
        add("coefficient", "asymmetry", "asymmetry", "1", meaning, &|line| line.row.asymmetry);
    }
    if request.wants(Quantity::OpticalDepth) {
        let group = "vertical optical depth up to 120 km; below: extinction down to the ground";
        for (part, value) in parts {
            let name = format!("{part}_optical_depth_above");
            let meaning = format!("vertical optical depth of {part} from the altitude to 120 km");
            add(group, &name, part, "1", &meaning, &|line| Some(value(&line.row.above)));
        }
        let meaning = "vertical optical depth of extinction from the ground to the altitude";
        let value: Value<'_> = &|line| Some(line.row.below.extinction());
        add(group, "extinction_optical_depth_below", "below", "1", meaning, value);
    }
    if request.wants(Quantity::Phase) {
        let meaning = "scattering angle, 0 forward";
        let angle: Value<'_> = &|line| request.angles_deg.get(line.angle).copied();
        add("phase function", "angle_deg", "angle", "degrees", meaning, angle);
        let meaning = "phase function, its integral over the sphere 1";
        let value: Value<'_> = &|line| line.row.phase.as_ref().map(|phase| phase[line.angle]);
        add("phase function", "phase_per_sr", "phase", "sr^-1", meaning, value);
    }
    columns
}

#[cfg(test)]
mod tests;
