//! Columns of numbers as a data frame, and its CSV.

use polars::prelude::{Column, CsvWriter, DataFrame, PolarsError, SerWriter};

/// Significant digits of a number in a CSV: more than any measured value has, fewer than change
/// with the last bits of a machine.
const DIGITS: usize = 7;

/// Named columns of equal length. What a figure shows, in the units that the names end with.
#[derive(Debug, Clone)]
pub struct Frame(DataFrame);

impl Frame {
    /// A frame of columns in their order. NaN stands for a missing value; the others are rounded to
    /// seven significant digits.
    ///
    /// # Errors
    /// [`PolarsError`] if lengths differ or a name is used twice.
    pub fn new<N: Into<String>>(columns: impl IntoIterator<Item = (N, Vec<f64>)>) -> Result<Self, PolarsError> {
        let columns = columns.into_iter().map(|(name, values)| {
            let values: Vec<Option<f64>> = values.into_iter().map(|v| (!v.is_nan()).then(|| rounded(v))).collect();
            Column::new(name.into().into(), values)
        });
        Ok(Self(DataFrame::new_infer_height(columns.collect())?))
    }

    /// The same frame with columns of texts before the others.
    ///
    /// # Errors
    /// As [`Frame::new`].
    pub fn labelled<N: Into<String>>(
        self,
        texts: impl IntoIterator<Item = (N, Vec<String>)>,
    ) -> Result<Self, PolarsError> {
        let texts = texts.into_iter().map(|(name, values)| Column::new(name.into().into(), values));
        Ok(Self(DataFrame::new_infer_height(texts.chain(self.0.columns().iter().cloned()).collect())?))
    }

    /// A frame of columns of different lengths: the shorter end in gaps.
    ///
    /// # Errors
    /// [`PolarsError`] if a name is used twice.
    pub fn ragged<N: Into<String>>(columns: Vec<(N, Vec<f64>)>) -> Result<Self, PolarsError> {
        let longest = columns.iter().map(|(_, values)| values.len()).max().unwrap_or(0);
        Self::new(columns.into_iter().map(|(name, mut values)| {
            values.resize(longest, f64::NAN);
            (name, values)
        }))
    }

    /// The columns.
    #[must_use]
    pub fn data(&self) -> &DataFrame {
        &self.0
    }

    /// The values of a column; a missing value is NaN.
    ///
    /// # Errors
    /// [`PolarsError`] if there is no such column.
    pub fn column(&self, name: &str) -> Result<Vec<f64>, PolarsError> {
        Ok(self.0.column(name)?.f64()?.iter().map(|value| value.unwrap_or(f64::NAN)).collect())
    }

    /// The texts of a column.
    ///
    /// # Errors
    /// [`PolarsError`] if there is no such column of texts.
    pub fn texts(&self, name: &str) -> Result<Vec<String>, PolarsError> {
        Ok(self.0.column(name)?.str()?.iter().map(|text| text.unwrap_or_default().to_owned()).collect())
    }

    /// The frame as CSV: a header row of the names, then the rows; a missing value is empty.
    ///
    /// # Errors
    /// [`PolarsError`].
    pub fn csv(&self) -> Result<Vec<u8>, PolarsError> {
        let mut bytes = Vec::new();
        CsvWriter::new(&mut bytes).finish(&mut self.0.clone())?;
        Ok(bytes)
    }
}

/// `value` to [`DIGITS`] significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.*e}", DIGITS - 1).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_frame_is_written_with_its_names_and_gaps() {
        let frame = Frame::new([("x_m", vec![0.0, 1.0 / 3.0]), ("y_m2", vec![f64::NAN, 4.5e-31])]).expect("equal");
        let text = String::from_utf8(frame.csv().expect("written")).expect("text");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines, ["x_m,y_m2", "0.0,", "0.3333333,4.5e-31"]);
        assert_eq!(frame.data().height(), 2);
        let y = frame.column("y_m2").expect("there");
        assert!(y[0].is_nan() && y[1] == 4.5e-31);
        assert!(frame.column("z").is_err());
    }

    #[test]
    fn texts_stand_before_numbers() {
        let frame = Frame::new([("x_m", vec![1.0, 2.5])]).expect("equal");
        let frame = frame.labelled([("what", vec!["a".to_owned(), "b".to_owned()])]).expect("equal");
        assert_eq!(frame.csv().expect("written"), b"what,x_m\na,1.0\nb,2.5\n");
        assert_eq!(frame.texts("what").expect("there"), ["a", "b"]);
        assert!(frame.texts("x_m").is_err() && frame.column("what").is_err());
    }

    #[test]
    fn columns_that_do_not_fit_are_refused() {
        assert!(Frame::new([("x", vec![0.0]), ("y", vec![])]).is_err());
        assert!(Frame::new([("x", vec![0.0]), ("x", vec![1.0])]).is_err());
    }
}
