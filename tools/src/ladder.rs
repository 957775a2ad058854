//! Errors and costs of methods in a CSV file, as `airlight study ladder` writes it: a line `# title`, a header, and a row for each scene and setting.

use crate::records::Records;
use csv::StringRecord;
use tables::excerpt;

/// Why a file is no ladder: file, line, and what is wrong.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}, line {line}: {what}")]
pub struct LadderError {
    file: String,
    line: u64,
    what: String,
}

/// The columns that are drawn, as the header names them.
const REGIME: &str = "regime";
const METHOD: &str = "method";
const SETTING: &str = "setting";
const LUMINANCE: &str = "luminance_rms";
const DIFFERENCE: &str = "ciede2000";
const TABLES: &str = "tables_core_s";
const PICTURE: &str = "picture_core_s";

/// The most rows.
const MOST_ROWS: usize = 100_000;

/// Errors and costs of one setting on one scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Part of the world that the scene is of.
    pub regime: String,
    /// Method.
    pub method: String,
    /// How it is set.
    pub setting: String,
    /// What came out; nothing where the method does not cover the scene.
    pub found: Option<Found>,
}

/// Errors and costs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Found {
    /// Relative rms error of luminance.
    pub luminance: f64,
    /// Mean CIEDE2000.
    pub difference: f64,
    /// Core-seconds of tables and picture.
    pub seconds: f64,
}

/// Whether the text is of a ladder, not of a chart: its header begins with `regime`.
#[must_use]
pub fn is_ladder(bytes: &[u8]) -> bool {
    let header = bytes.split(|&b| b == b'\n').nth(1).unwrap_or_default();
    header.starts_with(b"regime,")
}

/// The rows of a file of that name.
///
/// # Errors
/// [`LadderError`] with the line: a column that is absent, a number that is none, no rows or too many.
pub fn parse(file: &str, bytes: &[u8]) -> Result<Vec<Row>, LadderError> {
    let failed = |line: u64, what: String| LadderError { file: file.into(), line, what };
    let text = std::str::from_utf8(bytes).map_err(|_| failed(1, "not UTF-8".into()))?;
    let (title, rest) = text.split_once('\n').unwrap_or((text, ""));
    if !title.starts_with("# ") {
        return Err(failed(1, format!("expected `# title`, found {}", excerpt(title))));
    }
    let (mut records, mut record) = (Records::new(rest), StringRecord::new());
    let mut columns: Option<([usize; 7], usize)> = None;
    let mut rows = Vec::new();
    while let Some(line) = records.read(&mut record).map_err(|(line, what)| failed(line + 1, what))? {
        let line = line + 1;
        let fields: Vec<&str> = record.iter().collect();
        let Some((at, width)) = columns else {
            let mut at = [0; 7];
            for (at, name) in at.iter_mut().zip([REGIME, METHOD, SETTING, LUMINANCE, DIFFERENCE, TABLES, PICTURE]) {
                let found = fields.iter().position(|field| *field == name);
                *at = found.ok_or_else(|| failed(line, format!("there is no column {name}")))?;
            }
            columns = Some((at, fields.len()));
            continue;
        };
        if fields.len() != width {
            return Err(failed(line, format!("expected {width} fields, found {}", fields.len())));
        }
        if rows.len() == MOST_ROWS {
            return Err(failed(line, format!("more than {MOST_ROWS} rows")));
        }
        let [regime, method, setting, numbers @ ..] = at.map(|i| fields[i]);
        let found = if numbers.iter().all(|field| field.is_empty()) {
            None
        } else {
            let mut values = [0.0; 4];
            for (value, field) in values.iter_mut().zip(numbers) {
                let number = field.trim().parse::<f64>().ok().filter(|v| v.is_finite() && *v >= 0.0);
                *value = number.ok_or_else(|| {
                    failed(line, format!("expected a number of at least 0, found {}", excerpt(field)))
                })?;
            }
            let [luminance, difference, tables, picture] = values;
            Some(Found { luminance, difference, seconds: tables + picture })
        };
        rows.push(Row { regime: regime.into(), method: method.into(), setting: setting.into(), found });
    }
    if rows.is_empty() {
        return Err(failed(3, "no rows".into()));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEADER: &str = "regime,method,setting,luminance_rms,ciede2000,tables_core_s,picture_core_s\n";

    #[test]
    fn rows_are_read_by_the_names_of_their_columns() {
        let text = format!("# t\n{HEADER}day,single,\"8 points\",0.1,2.5,0.25,0.5\nday,cie,type 12,,,,\n");
        assert!(is_ladder(text.as_bytes()) && !is_ladder(b"# t\npanel,curve,x,y\n"));
        let rows = parse("l.csv", text.as_bytes()).expect("a ladder");
        assert_eq!(rows[0].found, Some(Found { luminance: 0.1, difference: 2.5, seconds: 0.75 }));
        assert_eq!((rows[1].method.as_str(), rows[1].setting.as_str(), rows[1].found), ("cie", "type 12", None));
    }

    #[test]
    fn what_is_no_ladder_is_refused_with_its_line() {
        for (text, what) in [
            ("regime,method\n".to_owned(), "l.csv, line 1: expected `# title`"),
            ("# t\nregime,method\n".to_owned(), "l.csv, line 2: there is no column setting"),
            (format!("# t\n{HEADER}"), "l.csv, line 3: no rows"),
            (format!("# t\n{HEADER}day,single\n"), "l.csv, line 3: expected 7 fields, found 2"),
            (format!("# t\n{HEADER}day,a,b,0.1,NaN,1,1\n"), "l.csv, line 3: expected a number"),
        ] {
            let error = parse("l.csv", text.as_bytes()).expect_err("refused").to_string();
            assert!(error.starts_with(what), "{error}");
        }
    }
}
