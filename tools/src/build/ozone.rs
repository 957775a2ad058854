//! Tables of ozone: how it absorbs, and how much of it there is.

use super::air::{self, texts};
use super::{field, largest_relative, months};
use crate::molecular::ozone::{REFERENCE_TEMPERATURE_K, fit};
use crate::profile::ozone::{ClimatologicalProfile, arosa_densities, arosa_levels, climatology_levels, scaled};
use crate::profile::standard_atmosphere::StandardAtmosphere;
use crate::raw::RawData;
use crate::raw::ozone_mcpeters_labow::{BANDS, LATITUDES_DEG};
use tables::units::{DOBSON_UNIT_M2, WAVELENGTH_RANGE_NM};
use tables::views::{ALTITUDE, LATITUDE, MONTH, WAVELENGTH};
use tables::{Axis, Curve, Field, Interpolation, Kind, Outside, Precision, Scale, Table, TableError, Tolerance};

/// Relative error of a Dobson-unit column: published to 0.1 DU or 1 DU of some 300.
const COLUMN_ERROR: f64 = 1e-4;

/// Fields `sigma_0`, `sigma_1` and `sigma_2` against wavelength, and `reference_temperature`.
pub(super) fn cross_section(raw: &RawData) -> Result<Table, TableError> {
    let source = &raw.ozone_serdyuchenko.cross_sections;
    let (low, high) = WAVELENGTH_RANGE_NM;
    let fitted = fit(&source.rows, low, high);
    let axis = Axis::uniform(WAVELENGTH.0, WAVELENGTH.1, low, 1.0, fitted.polynomials.len())?;
    if fitted.polynomials.iter().zip(&axis.nodes).any(|(p, &node)| p.wavelength_nm != node) || axis.range().1 != high {
        let file = &source.provenance.file;
        return Err(TableError::Inconsistent(format!("{file} does not have every nm from {low} to {high}")));
    }
    let coefficient = |i: usize, unit: &str| {
        let values: Vec<f64> = fitted.polynomials.iter().map(|p| p.coefficients[i]).collect();
        // The difference of nearly equal sums: its last bits go with the largest of its terms, which
        // the largest coefficient bounds over a range of 50 K and more.
        let largest = values.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let absolute = 1e-13 * largest;
        Field {
            // The smallest are near the smallest normal number of single precision.
            precision: Precision::F64,
            tolerance: Tolerance { relative: 1e-12, absolute },
            ..field(&format!("sigma_{i}"), unit, &[WAVELENGTH.0], 0.0, values)
        }
    };
    let residual = fitted.residual;
    let settings = [
        ("cells", fitted.cells.to_string()),
        ("cells of noise set to zero", fitted.clamped.to_string()),
        ("fit", "least squares over 11 temperatures, 193 to 293 K".to_owned()),
        ("largest residual", format!("{:.1e} m^2", residual.largest)),
        ("rms residual", format!("{:.1e} m^2", residual.rms)),
        (
            "largest relative residual",
            format!(
                "{:.1e} at {} nm, in the noise of the gap between the bands",
                residual.largest_relative, residual.largest_relative_at_nm
            ),
        ),
        ("rms relative residual", format!("{:.1e}", residual.rms_relative)),
    ];
    Ok(Table {
        kind: Kind::OzoneCrossSection,
        title: "Ozone absorption cross-section as a parabola in temperature".into(),
        axes: vec![axis],
        fields: vec![
            coefficient(0, "m^2"),
            coefficient(1, "m^2 K^-1"),
            coefficient(2, "m^2 K^-2"),
            field("reference_temperature", "K", &[], 0.0, vec![REFERENCE_TEMPERATURE_K]),
        ],
        settings: settings.into_iter().map(|(key, value)| (key.to_owned(), value)).collect(),
        provenance: vec![source.provenance.clone()],
    })
}

/// Fields `number_density` by month, latitude and altitude, and `column` by month and latitude.
pub(super) fn profiles(raw: &RawData) -> Result<Table, TableError> {
    let climatology = &raw.ozone_mcpeters_labow;
    let atmosphere = StandardAtmosphere::new(&raw.atmosphere)?;
    let altitude = Axis::new(ALTITUDE.0, ALTITUDE.1, climatology_levels(&atmosphere)?)?;
    let (mut densities, mut columns_du) = (Vec::new(), Vec::new());
    let (mut lowest, mut highest) = (f64::MAX, 0.0_f64);
    let mut halves = Vec::new();
    for month in &climatology.columns.rows {
        for (band, &column) in month.columns.iter().enumerate().take(BANDS) {
            let profile = ClimatologicalProfile::new(climatology, &atmosphere, month.month.into(), band)?;
            let result = scaled(&profile, &altitude.nodes, column)?;
            (lowest, highest) = (lowest.min(result.factor), highest.max(result.factor));
            let curve = Curve::new(altitude.clone(), Scale::Linear, result.number_density.clone())?;
            for pair in altitude.nodes.windows(2) {
                let z = 0.5 * (pair[0] + pair[1]);
                halves.push((curve.at(z)?, profile.number_density(z)? * result.factor));
            }
            densities.extend(result.number_density);
            columns_du.push(column / DOBSON_UNIT_M2);
        }
    }
    let error = largest_relative(halves);
    let factors = format!("{lowest:.4} to {highest:.4}");
    let settings = [
        ("vertical coordinate", "pressure altitude 16 km log10(1013.25 hPa / p), through the standard atmosphere"),
        ("gaps at 0 and 1 km", "filled with the mixing ratio of the next level above"),
        ("above pressure altitude 60 km", "exponential, with the mean scale height from 55 to 60 km"),
        ("scaled to the published columns by", factors.as_str()),
    ];
    Ok(Table {
        kind: Kind::OzoneProfiles,
        title: "Ozone by month and latitude".into(),
        axes: vec![
            months()?,
            Axis::uniform(LATITUDE.0, LATITUDE.1, LATITUDES_DEG[0], 10.0, BANDS)?.beyond(Outside::Hold),
            altitude,
        ],
        fields: vec![
            Field {
                interpolation_error: Some(error),
                ..field("number_density", "m^-3", &[MONTH.0, LATITUDE.0, ALTITUDE.0], error, densities)
            },
            field("column", "DU", &[MONTH.0, LATITUDE.0], COLUMN_ERROR, columns_du),
        ],
        settings: texts(&settings),
        provenance: vec![climatology.mixing_ratio.provenance.clone(), climatology.columns.provenance.clone()]
            .into_iter()
            .chain(air::provenance(&raw.atmosphere))
            .collect(),
    })
}

/// Fields `number_density` by month and altitude, in steps, and `column` by month.
pub(super) fn layers(raw: &RawData) -> Result<Table, TableError> {
    let arosa = &raw.ozone_arosa;
    let altitude =
        Axis::new(ALTITUDE.0, ALTITUDE.1, arosa_levels(arosa))?.between(Interpolation::Step).beyond(Outside::Zero);
    let mut densities = Vec::new();
    for month in &arosa.columns.rows {
        densities.extend(arosa_densities(arosa, month.column));
        // The last node is the top of the last layer: nothing from there on.
        densities.push(0.0);
    }
    let columns_du = arosa.columns.rows.iter().map(|month| month.column / DOBSON_UNIT_M2).collect();
    let settings = [
        ("layers", "homogeneous, 9 km each: 9, 14, 111, 64, 6 and 6 of 210 parts of the column"),
        ("above 54 km", "none"),
    ];
    Ok(Table {
        kind: Kind::OzoneLayers,
        title: "Ozone at Arosa by month in six homogeneous layers".into(),
        axes: vec![months()?, altitude],
        fields: vec![
            field("number_density", "m^-3", &[MONTH.0, ALTITUDE.0], COLUMN_ERROR, densities),
            field("column", "DU", &[MONTH.0], COLUMN_ERROR, columns_du),
        ],
        settings: texts(&settings),
        provenance: vec![arosa.columns.provenance.clone(), arosa.layers.provenance.clone()],
    })
}
