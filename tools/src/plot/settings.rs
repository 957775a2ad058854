//! Which case a figure shows, in which units, and how a heading says so.

use super::PlotError;
use crate::column::{Column, Place};
use tables::units::{KM, WAVELENGTH_RANGE_NM};
use tables::views::{AerosolSource, Biome};

/// What figures show of all that the tables hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Month, latitude, source of aerosols and humidity. Its biome is none: `biomes` says which.
    pub place: Place,
    /// Biomes that are shown, none for clear air. A figure of one biome is made for each.
    pub biomes: Vec<Biome>,
    /// Wavelength in nm of the figures that show one.
    pub wavelength_nm: f64,
    /// Units of densities, cross-sections and coefficients.
    pub units: Units,
}

impl Default for Settings {
    /// Green light in June at 45 degrees north, every biome, in SI.
    fn default() -> Self {
        Self { place: Place::default(), biomes: Biome::ALL.to_vec(), wavelength_nm: 550.0, units: Units::Si }
    }
}

impl Settings {
    /// Refuses what the tables do not have.
    pub(super) fn validate(&self) -> Result<(), PlotError> {
        let (short, long) = WAVELENGTH_RANGE_NM;
        for (name, value, low, high) in [
            ("wavelength in nm", self.wavelength_nm, short, long),
            ("month", f64::from(self.place.month), 1.0, 12.0),
            ("latitude in degrees", self.place.latitude_deg, -90.0, 90.0),
            ("humidity in percent", self.place.humidity_percent.unwrap_or(0.0), 0.0, 99.0),
        ] {
            if !(low..=high).contains(&value) {
                return Err(PlotError::Outside { name, value, low, high });
            }
        }
        Ok(())
    }

    /// The place with a biome, or with clear air.
    pub(super) fn with(&self, biome: Option<Biome>) -> Place {
        Place { biome, ..self.place }
    }

    /// The case in words: "June, 45° N".
    pub(super) fn season(&self) -> String {
        let month = MONTHS[usize::from(self.place.month.clamp(1, 12)) - 1];
        format!("{month}, {}", latitude(self.place.latitude_deg))
    }

    /// Source and humidity of aerosols in words: "OPAC, 50 to 80 % humidity".
    pub(super) fn aerosol<'a>(&self, columns: impl IntoIterator<Item = &'a Column>) -> String {
        // The lowest species is the one that takes up water.
        let lowest = |column: &Column| column.aerosols().first().and_then(|&s| column.humidity_percent(s));
        let humidities: Vec<f64> = columns.into_iter().filter_map(lowest).collect();
        let low = humidities.iter().copied().fold(f64::INFINITY, f64::min);
        let high = humidities.iter().copied().fold(0.0, f64::max);
        match self.place.source {
            AerosolSource::Jaenicke => "Jaenicke, dry".into(),
            AerosolSource::Opac if low < high => format!("OPAC, {low} to {high} % humidity"),
            AerosolSource::Opac => format!("OPAC, {high} % humidity"),
        }
    }
}

/// A biome in words: "desert dust".
pub(super) fn words(biome: Biome) -> String {
    biome.name().replace('-', " ")
}

/// Units of what figures and their CSV hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Units {
    /// m^-3, m^2, m^-1.
    Si,
    /// Those of the thesis: km^-3, km^2, km^-1.
    Thesis,
}

/// A unit: what to multiply SI values with, its sign, and how it ends the name of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unit {
    pub(super) factor: f64,
    pub(super) sign: &'static str,
    pub(super) ending: &'static str,
}

impl Units {
    /// Both, the default first.
    pub const ALL: [Self; 2] = [Self::Si, Self::Thesis];

    /// The name by which they are asked for.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Si => "si",
            Self::Thesis => "thesis",
        }
    }

    /// The units of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|units| units.name() == name)
    }

    fn pick(self, si: &'static str, thesis: &'static str, factor: f64, endings: [&'static str; 2]) -> Unit {
        match self {
            Self::Si => Unit { factor: 1.0, sign: si, ending: endings[0] },
            Self::Thesis => Unit { factor, sign: thesis, ending: endings[1] },
        }
    }

    /// Of number densities.
    pub(super) fn density(self) -> Unit {
        self.pick("m⁻³", "km⁻³", KM * KM * KM, ["m3", "km3"])
    }

    /// Of cross-sections.
    pub(super) fn cross_section(self) -> Unit {
        self.pick("m²", "km²", 1.0 / (KM * KM), ["m2", "km2"])
    }

    /// Of coefficients.
    pub(super) fn coefficient(self) -> Unit {
        self.pick("m⁻¹", "km⁻¹", KM, ["per_m", "per_km"])
    }

    /// Of altitudes in a CSV; figures have km.
    pub(super) fn altitude(self) -> Unit {
        self.pick("m", "km", 1.0 / KM, ["m", "km"])
    }
}

impl Unit {
    /// SI values in this unit.
    pub(super) fn of(self, values: &[f64]) -> Vec<f64> {
        values.iter().map(|value| value * self.factor).collect()
    }

    /// A named column of SI values in this unit.
    pub(super) fn column(self, name: &str, values: &[f64]) -> (String, Vec<f64>) {
        (format!("{name}_{}", self.ending), self.of(values))
    }
}

/// Names of the months.
pub(super) const MONTHS: [&str; 12] = [
    "January",
    "February",
    "March",
    "April",
    "May",
    "June",
    "July",
    "August",
    "September",
    "October",
    "November",
    "December",
];

/// A latitude in words.
pub(super) fn latitude(degrees: f64) -> String {
    let side = if degrees < 0.0 { " S" } else { " N" };
    format!("{}°{}", degrees.abs(), if degrees == 0.0 { "" } else { side })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cases_in_words() {
        assert_eq!(Settings::default().season(), "June, 45° N");
        assert_eq!([latitude(-12.5), latitude(0.0)], ["12.5° S", "0°"]);
        assert_eq!(words(Biome::DesertDust), "desert dust");
    }

    #[test]
    fn settings_outside_the_tables_are_refused() {
        let with = |place: Place| Settings { place, ..Settings::default() };
        let ok = Place::default();
        assert!(with(ok).validate().is_ok());
        assert!(with(Place { month: 13, ..ok }).validate().is_err());
        assert!(Settings { wavelength_nm: f64::NAN, ..Settings::default() }.validate().is_err());
        let error = with(Place { latitude_deg: 91.0, ..ok }).validate().expect_err("outside");
        assert_eq!(error.to_string(), "latitude in degrees 91: -90 to 90 is possible");
        let error = with(Place { humidity_percent: Some(100.0), ..ok }).validate().expect_err("outside");
        assert_eq!(error.to_string(), "humidity in percent 100: 0 to 99 is possible");
    }

    #[test]
    fn the_units_of_the_thesis_are_kilometres() {
        let (si, thesis) = (Units::Si, Units::Thesis);
        // A particle in a cubic metre with a square metre each: 1 m^-1 = 1000 km^-1.
        let product = thesis.density().factor * thesis.cross_section().factor;
        assert!((product / thesis.coefficient().factor - 1.0).abs() < 1e-15);
        assert_eq!(thesis.density().column("n", &[1.0]), ("n_km3".to_owned(), vec![1e9]));
        assert_eq!(si.coefficient().column("n", &[2.0]), ("n_per_m".to_owned(), vec![2.0]));
        assert_eq!(Units::ALL.map(|units| Units::from_name(units.name())), Units::ALL.map(Some));
    }
}
