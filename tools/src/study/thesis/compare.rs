//! The thesis beside that from which the tables are made, and beside the tables' aerosols.

use super::super::StudyError;
use super::{TOP_M, Thesis};
use crate::column::{Column, Place};
use crate::data::Data;
use crate::frame::Frame;
use crate::profile::ozone::{ClimatologicalProfile, arosa_densities};
use crate::profile::standard_atmosphere::StandardAtmosphere;
use crate::raw::RawData;
use crate::raw::ozone_arosa::OzoneArosa;
use crate::raw::ozone_serdyuchenko::TEMPERATURES;
use std::path::Path;
use tables::TableError;
use tables::units::WAVELENGTH_RANGE_NM;
use tables::views::{AerosolSource, Biome};

/// The month of the ozone compared: April, 384 DU at Arosa.
const MONTH: u8 = 4;

/// The band of the climatology compared, centred at 45 degrees north.
const BAND: usize = 13;

/// Step in m of the altitudes.
const STEP_M: u32 = 100;

/// Step in nm of the aerosols' wavelengths, as in their tables.
const STEP_NM: f64 = 25.0;

/// Ozone profiles, the density of air, ozone cross-sections, and the extinction of every biome at the ground.
pub(in super::super) fn compare(raw_dir: &Path, data: Data<'_>) -> Result<Frame, StudyError> {
    let raw = RawData::from_dir(raw_dir)?;
    let thesis = Thesis::from_dir(raw_dir)?;
    let atmosphere = StandardAtmosphere::new(&raw.atmosphere)?;
    let altitudes: Vec<f64> = (0..=TOP_M as u32 / STEP_M).map(|i| f64::from(i * STEP_M)).collect();

    let column = raw.ozone_arosa.columns.rows[usize::from(MONTH) - 1].column;
    let layers = in_layers(&raw.ozone_arosa, &arosa_densities(&raw.ozone_arosa, column), &altitudes);
    let profile = ClimatologicalProfile::new(&raw.ozone_mcpeters_labow, &atmosphere, MONTH.into(), BAND)?;
    let climatology = altitudes.iter().map(|&z| profile.number_density(z)).collect::<Result<_, _>>()?;
    let (mut thesis_layers, mut departure) = (Vec::new(), Vec::new());
    for &z in &altitudes {
        thesis_layers.push(thesis.ozone_m3(MONTH, z)?);
        departure.push(thesis.molecules_m3(z)? / atmosphere.at(z)?.number_density - 1.0);
    }

    let (mut nm, mut measured, mut interpolated) = (Vec::new(), Vec::new(), Vec::new());
    let inside = WAVELENGTH_RANGE_NM.0..=WAVELENGTH_RANGE_NM.1;
    for row in raw.ozone_serdyuchenko.cross_sections.rows.iter().filter(|row| inside.contains(&row.wavelength_nm)) {
        nm.push(row.wavelength_nm);
        measured.push(row.cross_sections[TEMPERATURES - 1]);
        interpolated.push(thesis.ozone_m2(row.wavelength_nm)?);
    }
    let mut columns: Vec<(String, Vec<f64>)> = vec![
        ("altitude_m".into(), altitudes),
        ("ozone_layers_m3".into(), layers),
        ("ozone_climatology_m3".into(), climatology),
        ("ozone_thesis_m3".into(), thesis_layers),
        ("air_density_thesis_relative".into(), departure),
        ("wavelength_nm".into(), nm),
        ("ozone_measured_293k_m2".into(), measured),
        ("ozone_thesis_m2".into(), interpolated),
    ];
    columns.extend(extinctions(&thesis, data)?);
    Ok(Frame::ragged(columns)?)
}

/// Wavelengths, and for each biome the extinction coefficient at the ground in m^-1 of the thesis and of both
/// sources.
fn extinctions(thesis: &Thesis, data: Data<'_>) -> Result<Vec<(String, Vec<f64>)>, TableError> {
    let (low, high) = WAVELENGTH_RANGE_NM;
    let count = ((high - low) / STEP_NM) as u32;
    let nm: Vec<f64> = (0..=count).map(|i| low + f64::from(i) * STEP_NM).collect();
    let mut columns = vec![("aerosol_wavelength_nm".to_owned(), nm.clone())];
    for biome in Biome::ALL {
        let density = thesis.particles_m3(biome, 0.0)?;
        let had = |&w: &f64| Ok(density * thesis.particle_m2(biome, w)?.extinction());
        let values = nm.iter().map(had).collect::<Result<_, TableError>>()?;
        columns.push((format!("{biome}_thesis_per_m"), values));
        for source in AerosolSource::ALL {
            let column = Column::read(data, &Place { biome: Some(biome), source, ..Place::default() })?;
            let values = nm.iter().map(|&w| Ok(column.aerosol_coefficients(w, 0.0)?.extinction()));
            columns.push((format!("{biome}_{source}_per_m"), values.collect::<Result<_, TableError>>()?));
        }
    }
    Ok(columns)
}

/// Densities of the layers at altitudes in m; zero above.
fn in_layers(raw: &OzoneArosa, densities: &[f64], altitudes: &[f64]) -> Vec<f64> {
    let layers = &raw.layers.rows;
    let at = |z: f64| layers.iter().position(|layer| (layer.bottom..layer.top).contains(&z));
    altitudes.iter().map(|&z| at(z).map_or(0.0, |i| densities[i])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn compared() -> Frame {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
        compare(&root.join("raw-data"), Data(&root.join("data"))).expect("computed")
    }

    #[test]
    fn air_is_too_thin_high_up() {
        let frame = compared();
        let (z, departure) =
            (frame.column("altitude_m").expect("there"), frame.column("air_density_thesis_relative").expect("there"));
        for (altitude, expected) in [(0.0, 0.0), (20e3, 0.010), (50e3, 0.048), (86e3, 0.189)] {
            let i = z.iter().position(|&z| z == altitude).expect("a step");
            // Expected values are rounded to a thousandth; molecules differ from mass by as much above 80 km.
            assert!((-departure[i] - expected).abs() < 0.002, "{} at {altitude} m", departure[i]);
        }
    }

    #[test]
    fn extinction_was_wrong_by_another_factor_in_every_biome() {
        let frame = compared();
        let green = frame.column("aerosol_wavelength_nm").expect("there").iter().position(|&w| w == 550.0);
        let at = |name: String| frame.column(&name).expect("there")[green.expect("a node")];
        // Over Jaenicke's log-normals, two or three digits, computed apart from Airlight with miepython and without the
        // 2 cm^-3 that equation 3.9 adds to the densities (cm^-3) at the ground.
        for (biome, expected, density) in [
            (Biome::DesertDust, 876.0, 1866.2),
            (Biome::RemoteContinental, 930.0, 6100.3),
            (Biome::PolarArctic, 1980.0, 21.886),
            (Biome::PolarAntarctic, 2530.0, 21.886),
            (Biome::MaritimeMineral, 7.8, 202.66),
            (Biome::MaritimeClean, 6.7, 202.66),
            (Biome::Background, 0.69, f64::INFINITY),
            (Biome::Urban, 0.084, 136_810.0),
            (Biome::Rural, 0.072, 8787.0),
        ] {
            let factor = at(format!("{biome}_thesis_per_m")) / at(format!("{biome}_jaenicke_per_m"));
            let factor = factor * (1.0 + 2.0 / density);
            assert!((factor / expected - 1.0).abs() < 0.02, "{biome}: {factor}");
        }
    }

    #[test]
    fn sparse_points_miss_the_gap_between_the_bands() {
        let frame = compared();
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
