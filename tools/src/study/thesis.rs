//! Ozone and air as the code of a thesis had them (GitHub agavinm/atmosphere-renderer 30664c6a),
//! beside those from which the tables are made. Nothing but this study uses them.

use super::{StudyError, ragged};
use crate::frame::Frame;
use crate::profile::ozone::{ClimatologicalProfile, arosa_densities};
use crate::profile::standard_atmosphere::StandardAtmosphere;
use crate::raw::RawData;
use crate::raw::ozone_arosa::OzoneArosa;
use crate::raw::ozone_serdyuchenko::TEMPERATURES;
use crate::raw::ozone_thesis::OzoneThesis;
use crate::raw::us_standard_atmosphere::Constants;
use std::path::Path;
use tables::units::{DOBSON_UNIT_M2, KM, WAVELENGTH_RANGE_NM};
use tables::{Axis, Curve, Scale, TableError};

/// Molecules per square metre that the code took for a Dobson unit; it is 2.6868e20.
const THESIS_DOBSON_UNIT_M2: f64 = 2.96e20;

/// The month of the ozone compared: April, 384 DU at Arosa.
const MONTH: usize = 4;

/// The band of the climatology compared, centred at 45 degrees north.
const BAND: usize = 13;

/// Step and end in m of the altitudes.
const STEP_M: u32 = 100;
const TOP_M: u32 = 86_000;

/// Geopotential altitude in m' where the code's standard atmosphere ends; it goes on isothermally.
const LAYERS_END_M: f64 = 84_852.0;

/// Ozone profiles, the density of air, and ozone cross-sections.
pub(super) fn compare(raw_dir: &Path) -> Result<Frame, StudyError> {
    let raw = RawData::from_dir(raw_dir)?;
    let thesis = OzoneThesis::from_dir(raw_dir)?;
    let atmosphere = StandardAtmosphere::new(&raw.atmosphere)?;
    let altitudes: Vec<f64> = (0..=TOP_M / STEP_M).map(|i| f64::from(i * STEP_M)).collect();

    let column = raw.ozone_arosa.columns.rows[MONTH - 1].column;
    let layers = in_layers(&raw.ozone_arosa, &arosa_densities(&raw.ozone_arosa, column), &altitudes);
    let thesis_layers = in_layers(&raw.ozone_arosa, &thesis_densities(&raw.ozone_arosa, column), &altitudes);
    let profile = ClimatologicalProfile::new(&raw.ozone_mcpeters_labow, &atmosphere, MONTH, BAND)?;
    let climatology = altitudes.iter().map(|&z| profile.number_density(z)).collect::<Result<_, _>>()?;

    let mut departure = Vec::new();
    for &z in &altitudes {
        departure
            .push(thesis_mass_density(&atmosphere, &raw.atmosphere.values, z)? / atmosphere.at(z)?.mass_density - 1.0);
    }

    let (points, sparse): (Vec<f64>, Vec<f64>) =
        thesis.cross_sections.rows.iter().map(|row| (row.wavelength_nm, row.cross_section)).unzip();
    let sparse = Curve::new(Axis::new("wavelength", "nm", points)?, Scale::Linear, sparse)?;
    let (mut nm, mut measured, mut interpolated) = (Vec::new(), Vec::new(), Vec::new());
    let inside = WAVELENGTH_RANGE_NM.0..=WAVELENGTH_RANGE_NM.1;
    for row in raw.ozone_serdyuchenko.cross_sections.rows.iter().filter(|row| inside.contains(&row.wavelength_nm)) {
        nm.push(row.wavelength_nm);
        measured.push(row.cross_sections[TEMPERATURES - 1]);
        interpolated.push(sparse.at(row.wavelength_nm)?);
    }
    Ok(ragged(vec![
        ("altitude_m", altitudes),
        ("ozone_layers_m3", layers),
        ("ozone_climatology_m3", climatology),
        ("ozone_thesis_m3", thesis_layers),
        ("air_density_thesis_relative", departure),
        ("wavelength_nm", nm),
        ("ozone_measured_293k_m2", measured),
        ("ozone_thesis_m2", interpolated),
    ])?)
}

/// Ozone number densities in m^-3 of the six layers at Arosa as the code had them, for a column in
/// m^-2: a Dobson unit too large by 10 %, twice the share of the two layers at the top, and the
/// column of a layer of 9 km taken for the number in each km: 10.5 times the ozone there is.
fn thesis_densities(raw: &OzoneArosa, column: f64) -> Vec<f64> {
    let layers = &raw.layers.rows;
    let total: f64 = layers.iter().map(|layer| layer.column).sum();
    let share = |i: usize, column: f64| if i + 2 < layers.len() { column / total } else { 2.0 * column / total };
    let column = column / DOBSON_UNIT_M2 * THESIS_DOBSON_UNIT_M2;
    layers.iter().enumerate().map(|(i, layer)| column * share(i, layer.column) / KM).collect()
}

/// Densities of the layers at altitudes in m; zero above.
fn in_layers(raw: &OzoneArosa, densities: &[f64], altitudes: &[f64]) -> Vec<f64> {
    let layers = &raw.layers.rows;
    let at = |z: f64| layers.iter().position(|layer| (layer.bottom..layer.top).contains(&z));
    altitudes.iter().map(|&z| at(z).map_or(0.0, |i| densities[i])).collect()
}

/// Mass density in kg m^-3 that the code found at the geometric altitude z in m: that of the
/// geopotential altitude of the same number, 19 % too low at 86 km.
fn thesis_mass_density(atmosphere: &StandardAtmosphere, constants: &Constants, z: f64) -> Result<f64, TableError> {
    let r = constants.earth_radius;
    let geometric = |geopotential: f64| r * geopotential / (r - geopotential);
    if z <= LAYERS_END_M {
        return Ok(atmosphere.at(geometric(z))?.mass_density);
    }
    let end = atmosphere.at(geometric(LAYERS_END_M))?;
    let scale_height = end.pressure / (end.mass_density * constants.gravity);
    Ok(end.mass_density * (-(z - LAYERS_END_M) / scale_height).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn raw_dir() -> std::path::PathBuf {
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../raw-data")
    }

    #[test]
    fn the_ozone_is_ten_and_a_half_times_too_much() {
        let raw = OzoneArosa::from_dir(&raw_dir()).expect("sound");
        let column = raw.columns.rows[MONTH - 1].column;
        let sum: f64 =
            raw.layers.rows.iter().zip(thesis_densities(&raw, column)).map(|(l, n)| n * (l.top - l.bottom)).sum();
        // 9 x 2.96 / 2.6867805 x 222 / 210.
        assert!((sum / column - 10.4818).abs() < 1e-4, "{}", sum / column);
    }

    #[test]
    fn air_is_too_thin_high_up() {
        let raw = crate::raw::us_standard_atmosphere::UsStandardAtmosphere::from_dir(&raw_dir()).expect("sound");
        let atmosphere = StandardAtmosphere::new(&raw).expect("layers");
        let lack = |z: f64| {
            let thesis = thesis_mass_density(&atmosphere, &raw.values, z).expect("inside");
            1.0 - thesis / atmosphere.at(z).expect("inside").mass_density
        };
        assert_eq!(lack(0.0), 0.0);
        for (z, expected) in [(20e3, 0.010), (50e3, 0.048), (86e3, 0.189)] {
            assert!((lack(z) - expected).abs() < 0.002, "{} at {z} m", lack(z));
        }
    }

    #[test]
    fn sparse_points_miss_the_gap_between_the_bands() {
        let frame = compare(&raw_dir()).expect("computed");
        let column = |name| frame.column(name).expect("there");
        let (nm, measured, thesis) =
            (column("wavelength_nm"), column("ozone_measured_293k_m2"), column("ozone_thesis_m2"));
        for (wavelength, expected) in [(310.0, 2.6), (340.0, 65.0), (360.0, 280.0), (500.0, 1.4), (700.0, 1.9)] {
            let i = nm.iter().position(|&w| w == wavelength).expect("a whole nm");
            let ratio = thesis[i] / measured[i];
            // Expected values have two digits, some of them rounded from less.
            assert!((ratio / expected - 1.0).abs() < 0.05, "{ratio} at {wavelength} nm");
        }
    }
}
