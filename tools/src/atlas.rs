//! Differences that parts of the model make, in a CSV file as `airlight study atlas` writes it: a line `# title`, a header that begins with `term`, and a
//! row for each part and scene.

use crate::records::Records;
use csv::StringRecord;
use tables::excerpt;

/// Why a file is no atlas: file, line, and what is wrong.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}, line {line}: {what}")]
pub struct AtlasError {
    file: String,
    line: u64,
    what: String,
}

/// The columns that are drawn, as the header names them.
const COLUMNS: [&str; 5] = ["term", "regime", "radiance", "luminance", "ciede2000"];

/// The most rows.
const MOST_ROWS: usize = 100_000;

/// What a part of the model makes of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The part.
    pub term: String,
    /// Part of the world that the scene is of.
    pub regime: String,
    /// Changes of radiance and luminance, as shares, and CIEDE2000.
    pub change: [f64; 3],
}

/// Whether the text is of an atlas: its header begins with `term`.
#[must_use]
pub fn is_atlas(bytes: &[u8]) -> bool {
    bytes.split(|&b| b == b'\n').nth(1).unwrap_or_default().starts_with(b"term,")
}

/// The rows of a file of that name.
///
/// # Errors
/// [`AtlasError`] with the line: a column that is absent, a number that is none, no rows or too many.
pub fn parse(file: &str, bytes: &[u8]) -> Result<Vec<Row>, AtlasError> {
    let failed = |line: u64, what: String| AtlasError { file: file.into(), line, what };
    let text = std::str::from_utf8(bytes).map_err(|_| failed(1, "not UTF-8".into()))?;
    let (title, rest) = text.split_once('\n').unwrap_or((text, ""));
    if !title.starts_with("# ") {
        return Err(failed(1, format!("expected `# title`, found {}", excerpt(title))));
    }
    let (mut records, mut record) = (Records::new(rest), StringRecord::new());
    let mut columns: Option<[usize; 5]> = None;
    let mut rows = Vec::new();
    while let Some(line) = records.read(&mut record).map_err(|(line, what)| failed(line + 1, what))? {
        let line = line + 1;
        let fields: Vec<&str> = record.iter().collect();
        let Some(at) = columns else {
            let mut at = [0; 5];
            for (at, name) in at.iter_mut().zip(COLUMNS) {
                let found = fields.iter().position(|field| *field == name);
                *at = found.ok_or_else(|| failed(line, format!("there is no column {name}")))?;
            }
            columns = Some(at);
            continue;
        };
        if rows.len() == MOST_ROWS {
            return Err(failed(line, format!("more than {MOST_ROWS} rows")));
        }
        let field = |i: usize| fields.get(at[i]).copied().unwrap_or("");
        let mut change = [0.0; 3];
        for (i, value) in change.iter_mut().enumerate() {
            let number = field(2 + i).parse::<f64>().ok().filter(|v| v.is_finite() && *v >= 0.0);
            *value = number.ok_or_else(|| {
                failed(line, format!("expected a number of at least 0, found {}", excerpt(field(2 + i))))
            })?;
        }
        rows.push(Row { term: field(0).into(), regime: field(1).into(), change });
    }
    if rows.is_empty() {
        return Err(failed(3, "no rows".into()));
    }
    Ok(rows)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_read_by_the_names_of_their_columns() {
        let text = "# t\nterm,regime,albedo,radiance,luminance,ciede2000\nozone,day,0.1,0.01,0.02,0.5\n";
        assert!(is_atlas(text.as_bytes()) && !is_atlas(b"# t\npanel,curve,x,y\n"));
        let rows = parse("a.csv", text.as_bytes()).expect("an atlas");
        assert_eq!(rows, [Row { term: "ozone".into(), regime: "day".into(), change: [0.01, 0.02, 0.5] }]);
    }

    #[test]
    fn what_is_no_atlas_is_refused_with_its_line() {
        for (text, what) in [
            ("term,regime\n", "a.csv, line 1: expected `# title`"),
            ("# t\nterm,regime\n", "a.csv, line 2: there is no column radiance"),
            ("# t\nterm,regime,radiance,luminance,ciede2000\n", "a.csv, line 3: no rows"),
            ("# t\nterm,regime,radiance,luminance,ciede2000\na,day,1,NaN,1\n", "a.csv, line 3: expected a number"),
        ] {
            let error = parse("a.csv", text.as_bytes()).expect_err("refused").to_string();
            assert!(error.starts_with(what), "{error}");
        }
    }
}
