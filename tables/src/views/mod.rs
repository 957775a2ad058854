//! One typed reading per kind of table. A view is made with `from_table`, which
//! checks the kind, the fields, their units and their range once; its methods
//! then speak physics.
//!
//! The names and units of axes and fields stand here and nowhere else; whoever
//! builds a table of a kind makes it so that its view accepts it.

mod aerosol;
mod air;
mod angles;
mod ground;
mod light;
mod ozone;

pub use aerosol::{
    Aerosol, AerosolSource, Biome, COSINE, Matrix, Optics, Origin, REFERENCE_WAVELENGTH_NM, Species, suffix,
};
pub use air::{Rayleigh, StandardAtmosphere};
pub use angles::{Angles, integral};
pub use ground::GroundAlbedo;
pub use light::{Observer, Sun};
pub use ozone::{OzoneCrossSection, OzoneLayers, OzoneProfile, OzoneProfiles};

use crate::{Curve, Table, TableError};

/// The wavelength axis of most tables: its name and unit.
pub const WAVELENGTH: (&str, &str) = ("wavelength", "nm");
/// The altitude axis: its name and unit. Geometric, above the planet's sphere.
pub const ALTITUDE: (&str, &str) = ("altitude", "m");
/// The month axis: 1 January to 12 December, each the middle of its month.
pub const MONTH: (&str, &str) = ("month", "1");
/// The latitude axis: degrees, north positive.
pub const LATITUDE: (&str, &str) = ("latitude", "deg");

/// Refuses a curve with a value outside `low..=high`.
fn bounded(curve: Curve, name: &str, low: f64, high: f64) -> Result<Curve, TableError> {
    match curve.values().iter().find(|v| !(low..=high).contains(*v)) {
        None => Ok(curve),
        Some(v) => Err(TableError::Inconsistent(format!("field {name:?} holds {v}, {low} to {high} is possible"))),
    }
}

/// The one value of a field without axes.
fn scalar(table: &Table, name: &str, unit: &str) -> Result<f64, TableError> {
    Ok(table.field(name, unit, &[])?.values[0])
}
