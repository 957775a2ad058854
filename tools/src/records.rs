//! Rows of a CSV text, one at a time, each bounded: what is read never takes more memory than one row may have.

use csv::StringRecord;
use csv_core::ReadRecordResult;

/// The most bytes of one row.
pub const MAX_ROW: usize = 1 << 16;

/// The most fields of one row.
pub const MAX_FIELDS: usize = 512;

/// The rows of a text, the header row included; lines without anything are passed over.
pub struct Records<'a> {
    core: csv_core::Reader,
    rest: &'a [u8],
    fields: Vec<u8>,
    ends: Vec<usize>,
}

impl<'a> Records<'a> {
    /// The rows of `text`.
    #[must_use]
    pub fn new(text: &'a str) -> Self {
        Self {
            core: csv_core::Reader::new(),
            rest: text.as_bytes(),
            fields: vec![0; MAX_ROW],
            ends: vec![0; MAX_FIELDS],
        }
    }

    /// Reads the next row into `record` and gives the line where it begins, counted from 1; `None` after the last row.
    ///
    /// # Errors
    /// That line and what is wrong, for a row of more than [`MAX_ROW`] bytes or [`MAX_FIELDS`] fields.
    pub fn read(&mut self, record: &mut StringRecord) -> Result<Option<u64>, (u64, String)> {
        record.clear();
        let line = self.core.line();
        let (mut length, mut count) = (0, 0);
        loop {
            let (result, read, written, ended) =
                self.core.read_record(self.rest, &mut self.fields[length..], &mut self.ends[count..]);
            self.rest = &self.rest[read..];
            length += written;
            count += ended;
            match result {
                // Said once more with nothing to read, this ends the last row.
                ReadRecordResult::InputEmpty => {}
                ReadRecordResult::OutputFull => return Err((line, format!("a row of more than {MAX_ROW} bytes"))),
                ReadRecordResult::OutputEndsFull => {
                    return Err((line, format!("a row of more than {MAX_FIELDS} fields")));
                }
                ReadRecordResult::End => return Ok(None),
                ReadRecordResult::Record => break,
            }
        }
        let text = std::str::from_utf8(&self.fields[..length]).map_err(|e| (line, e.to_string()))?;
        let mut start = 0;
        for &end in &self.ends[..count] {
            record.push_field(&text[start..end]);
            start = end;
        }
        Ok(Some(line))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Line and fields.
    type Row = (u64, Vec<String>);

    fn rows(text: &str) -> Result<Vec<Row>, (u64, String)> {
        let (mut records, mut record, mut rows) = (Records::new(text), StringRecord::new(), Vec::new());
        while let Some(line) = records.read(&mut record)? {
            rows.push((line, record.iter().map(str::to_owned).collect()));
        }
        Ok(rows)
    }

    #[test]
    fn rows_are_those_of_the_csv_library() {
        for text in ["a,b\n1,2\n", "a\r\n\r\n1,\"x,\"\"y\"\"\nz\",é", "", "\n\n", "\u{feff}a,b\n,\n\"", "a\rb\r"] {
            let mut library = csv::ReaderBuilder::new().has_headers(false).flexible(true).from_reader(text.as_bytes());
            let expected: Vec<Row> = library
                .records()
                .map(|record| record.expect("text"))
                .map(|record| {
                    (record.position().map_or(0, csv::Position::line), record.iter().map(str::to_owned).collect())
                })
                .collect();
            assert_eq!(rows(text).expect("bounded"), expected, "{text:?}");
        }
    }

    #[test]
    fn a_row_without_end_is_refused_with_its_line() {
        let (line, why) = rows(&format!("a\n{}", ",".repeat(MAX_FIELDS))).expect_err("too many fields");
        assert_eq!((line, why.as_str()), (2, "a row of more than 512 fields"));
        let (line, why) = rows(&format!("a\n\"{}", "x\n".repeat(MAX_ROW))).expect_err("too long");
        assert_eq!((line, why.as_str()), (2, "a row of more than 65536 bytes"));
        assert!(rows(&"a,b\n".repeat(MAX_ROW)).is_ok(), "many short rows");
    }
}
