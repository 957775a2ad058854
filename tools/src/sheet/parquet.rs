//! A sheet as Parquet.

use super::{Sheet, SheetError, Values};
use polars::prelude::{Column, DataFrame, KeyValueMetadata, ParquetWriter, PolarsError};

/// The key of a Parquet file's metadata under which a sheet says what it holds, as JSON.
const KEY: &str = "airlight";

impl Sheet {
    /// Columns of doubles and strings; settings, tables, sources, units and meanings as JSON under the key `airlight`
    /// of the file's metadata.
    pub(super) fn parquet(&self) -> Result<Vec<u8>, SheetError> {
        let failed = |e: PolarsError| SheetError::Malformed(format!("Parquet: {e}"));
        let columns = self.columns.iter().map(|column| match &column.values {
            Values::Numbers(values) => Column::new(column.name.as_str().into(), values),
            Values::Words(words) => Column::new(column.name.as_str().into(), words),
        });
        let mut frame = DataFrame::new_infer_height(columns.collect()).map_err(failed)?;
        let about = KeyValueMetadata::from_static(vec![(KEY.into(), self.about()?)]);
        let mut bytes = Vec::new();
        ParquetWriter::new(&mut bytes).with_key_value_metadata(Some(about)).finish(&mut frame).map_err(failed)?;
        Ok(bytes)
    }
}
