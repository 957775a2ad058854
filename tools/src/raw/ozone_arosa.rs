//! Ozone at Arosa, 47 degrees north: monthly column (Duetsch 1974) and its share in six
//! layers of 9 km (Ramanathan and Kulkarni 1953).

use super::{Column, RawError, Row, Source};
use std::path::Path;
use tables::units::{DOBSON_UNIT_M2, KM};

/// The files of `ozone-arosa/`.
#[derive(Debug, Clone, PartialEq)]
pub struct OzoneArosa {
    /// Column of the months 1 to 12.
    pub columns: Source<MonthlyColumn>,
    /// Layers from the ground upwards.
    pub layers: Source<LayerFraction>,
}

impl OzoneArosa {
    /// Reads the files below `raw_dir`.
    ///
    /// # Errors
    /// [`RawError`].
    pub fn from_dir(raw_dir: &Path) -> Result<Self, RawError> {
        Ok(Self {
            columns: Source::read(raw_dir, "ozone-arosa/monthly-column.csv")?.with_rows(12)?,
            layers: Source::read(raw_dir, "ozone-arosa/layer-fractions.csv")?.with_rows(6)?,
        })
    }
}

/// Mean column of one month.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MonthlyColumn {
    /// Month, 1 to 12.
    pub month: u8,
    /// Mean column, m^-2.
    pub column: f64,
    /// Standard deviation of the column, m^-2.
    pub standard_deviation: f64,
}

impl Row for MonthlyColumn {
    type Record = (u8, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::number("month", "1", 1.0, 12.0).key(),
            Column::number("total_column_du", "DU", 50.0, 700.0),
            Column::number("standard_deviation_du", "DU", 0.0, 200.0),
        ]
    }

    fn from_record((month, column_du, deviation_du): Self::Record) -> Self {
        Self { month, column: column_du * DOBSON_UNIT_M2, standard_deviation: deviation_du * DOBSON_UNIT_M2 }
    }
}

/// One layer and its share of the column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerFraction {
    /// Geometric altitude of the base, m.
    pub bottom: f64,
    /// Geometric altitude of the top, m.
    pub top: f64,
    /// Column of the layer in a total of 210 DU, m^-2.
    pub column: f64,
    /// Share of the total column as printed, rounded to 1e-7, 1.
    pub fraction: f64,
}

impl Row for LayerFraction {
    type Record = (f64, f64, f64, f64);

    fn columns() -> Vec<Column> {
        vec![
            Column::number("layer_bottom_km", "km", 0.0, 120.0).key(),
            Column::number("layer_top_km", "km", 0.0, 120.0),
            Column::number("layer_column_du_of_210", "DU", 0.0, 210.0),
            Column::number("column_fraction", "1", 0.0, 1.0),
        ]
    }

    fn from_record((bottom_km, top_km, column_du, fraction): Self::Record) -> Self {
        Self { bottom: bottom_km * KM, top: top_km * KM, column: column_du * DOBSON_UNIT_M2, fraction }
    }
}
