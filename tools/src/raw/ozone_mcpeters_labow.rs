//! Ozone climatology of McPeters, Labow and Logan, J. Geophys. Res. 112, D05308 (2007).

use super::{Column, Fault, RawError, Row, Source};
use std::path::Path;
use tables::units::{DOBSON_UNIT_M2, KM};

/// Number of latitude bands, each 10 degrees wide.
pub const BANDS: usize = 18;

/// Number of pressure altitudes, 0 to 60 km by 1 km.
pub const LEVELS: usize = 61;

/// Centres of the latitude bands in degrees, south to north: -85, -75, ... 85.
pub const LATITUDES_DEG: [f64; BANDS] =
    [-85.0, -75.0, -65.0, -55.0, -45.0, -35.0, -25.0, -15.0, -5.0, 5.0, 15.0, 25.0, 35.0, 45.0, 55.0, 65.0, 75.0, 85.0];

/// The files of `ozone-mcpeters-labow/`.
#[derive(Debug, Clone, PartialEq)]
pub struct OzoneMcPetersLabow {
    /// Mixing ratios: month 1 at every level, then month 2, and so on.
    pub mixing_ratio: Source<MixingRatio>,
    /// Columns of the months 1 to 12.
    pub columns: Source<MonthlyColumns>,
}

impl OzoneMcPetersLabow {
    /// Reads the files below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`], also if a month or level is missing.
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        let mixing_ratio: Source<MixingRatio> =
            Source::read(raw_dir, "ozone-mcpeters-labow/mixing-ratio.csv")?.with_rows(12 * LEVELS)?;
        for (i, row) in mixing_ratio.rows.iter().enumerate() {
            let expected = (i / LEVELS + 1, (i % LEVELS) as f64 * KM);
            if (usize::from(row.month), row.pressure_altitude) != expected {
                let fault = Fault::Unexpected {
                    expected: format!("month {} and {} km in data row {}", expected.0, expected.1 / KM, i + 1),
                    found: format!("month {} and {} km", row.month, row.pressure_altitude / KM),
                };
                return Err(RawError::new(&mixing_ratio.provenance.file, fault));
            }
        }
        Ok(Self { mixing_ratio, columns: Source::read(raw_dir, "ozone-mcpeters-labow/column.csv")?.with_rows(12)? })
    }
}

/// Mixing ratios of one month and level in every band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MixingRatio {
    /// Month, 1 to 12.
    pub month: u8,
    /// Pressure altitude z* = 16 km log10(1013.25 hPa / p), m.
    pub pressure_altitude: f64,
    /// Volume mixing ratio in each band of [`LATITUDES_DEG`], 1; zero where there are no data.
    pub mixing_ratios: [f64; BANDS],
}

/// Name of the column of a band: `vmr_ppmv_lat_s85` and so on.
fn band_names(prefix: &'static str) -> impl Iterator<Item = String> {
    LATITUDES_DEG
        .iter()
        .map(move |latitude| format!("{prefix}_lat_{}{}", if *latitude < 0.0 { 's' } else { 'n' }, latitude.abs()))
}

impl Row for MixingRatio {
    type Record = (u8, f64, [f64; BANDS]);

    fn columns() -> Vec<Column> {
        let keys =
            [Column::number("month", "1", 1.0, 12.0).key(), Column::number("altitude_km", "km", 0.0, 60.0).key()];
        let bands = band_names("vmr_ppmv").map(|name| Column::number(&name, "ppmv", 0.0, 15.0));
        keys.into_iter().chain(bands).collect()
    }

    fn from_record((month, altitude_km, ppmv): Self::Record) -> Self {
        Self { month, pressure_altitude: altitude_km * KM, mixing_ratios: ppmv.map(|x| x * 1e-6) }
    }
}

/// Columns of one month in every band.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonthlyColumns {
    /// Month, 1 to 12.
    pub month: u8,
    /// Total column in each band of [`LATITUDES_DEG`], m^-2.
    pub columns: [f64; BANDS],
}

impl Row for MonthlyColumns {
    type Record = (u8, [f64; BANDS]);

    fn columns() -> Vec<Column> {
        let month = Column::number("month", "1", 1.0, 12.0).key();
        let bands = band_names("column_du").map(|name| Column::number(&name, "DU", 50.0, 700.0));
        std::iter::once(month).chain(bands).collect()
    }

    fn from_record((month, columns_du): Self::Record) -> Self {
        Self { month, columns: columns_du.map(|x| x * DOBSON_UNIT_M2) }
    }
}
