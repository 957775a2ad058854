//! What interpolation misses half-way between the nodes of the tables.

use super::StudyError;
use crate::build;
use crate::frame::Frame;
use crate::molecular::rayleigh::Rayleigh;
use crate::profile::ozone::{ClimatologicalProfile, scaled};
use crate::profile::standard_atmosphere::StandardAtmosphere;
use crate::raw::RawData;
use std::path::Path;
use tables::{Curve, Kind, TableError, views};

/// The ozone profile studied: June, the band centred at 45 degrees north.
const MONTH: u8 = 6;
const BAND: usize = 13;
const LATITUDE_DEG: f64 = 45.0;

/// |interpolated / computed - 1| of air against altitude, of ozone in June at 45 degrees north
/// against altitude, and of the Rayleigh cross-section against wavelength, half-way between the nodes.
pub(super) fn at_half_nodes(raw_dir: &Path) -> Result<Frame, StudyError> {
    let raw = RawData::from_dir(raw_dir)?;
    let atmosphere = StandardAtmosphere::new(&raw.atmosphere)?;

    let air = views::StandardAtmosphere::from_table(&build::table(&raw, Kind::StandardAtmosphere)?)?;
    let heights = halves(&air.temperature_k);
    let temperature = errors(&air.temperature_k, |z| Ok(atmosphere.at(z)?.temperature))?;
    let pressure = errors(&air.pressure_pa, |z| Ok(atmosphere.at(z)?.pressure))?;
    let density = errors(&air.number_density_m3, |z| Ok(atmosphere.at(z)?.number_density))?;

    let profiles = views::OzoneProfiles::from_table(&build::table(&raw, Kind::OzoneProfiles)?)?;
    let ozone = profiles.profile(MONTH, LATITUDE_DEG)?.number_density_m3;
    let computed = ClimatologicalProfile::new(&raw.ozone_mcpeters_labow, &atmosphere, MONTH.into(), BAND)?;
    let column = raw.ozone_mcpeters_labow.columns.rows[usize::from(MONTH) - 1].columns[BAND];
    let factor = scaled(&computed, &ozone.axis().nodes, column)?.factor;
    let ozone_error = errors(&ozone, |z| Ok(computed.number_density(z)? * factor))?;

    let rayleigh = views::Rayleigh::from_table(&build::table(&raw, Kind::Rayleigh)?)?.cross_section_m2;
    let formula = Rayleigh::new(&raw.bucholtz, raw.atmosphere.values.standard_number_density)?;
    let rayleigh_error = errors(&rayleigh, |w| formula.cross_section(w))?;

    Ok(Frame::ragged(vec![
        ("altitude_m", heights),
        ("temperature_relative", temperature),
        ("pressure_relative", pressure),
        ("number_density_relative", density),
        ("ozone_altitude_m", halves(&ozone)),
        ("ozone_relative", ozone_error),
        ("wavelength_nm", halves(&rayleigh)),
        ("rayleigh_relative", rayleigh_error),
    ])?)
}

/// The places half-way between the nodes of a curve.
fn halves(curve: &Curve) -> Vec<f64> {
    curve.axis().nodes.windows(2).map(|pair| 0.5 * (pair[0] + pair[1])).collect()
}

/// |interpolated / computed - 1| there.
fn errors(curve: &Curve, computed: impl Fn(f64) -> Result<f64, TableError>) -> Result<Vec<f64>, TableError> {
    halves(curve).into_iter().map(|x| Ok((curve.at(x)? / computed(x)? - 1.0).abs())).collect()
}
