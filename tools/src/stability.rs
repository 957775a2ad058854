//! Maps of errors in a CSV file, as `airlight study stability` writes it: a line `# title`, a line `# name | title | x | y` for each map, a
//! header, and a row for each cell.

use crate::records::Records;
use csv::StringRecord;
use tables::excerpt;

/// Why a file has no maps: file, line, and what is wrong.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}, line {line}: {what}")]
pub struct StabilityError {
    file: String,
    line: u64,
    what: String,
}

/// The header.
const HEADER: [&str; 9] = ["map", "method", "x", "y", "error", "reference", "bound", "stated", "refused"];

/// The most maps, methods of a map, and places along an axis.
const MOST_MAPS: usize = 40;
const MOST_METHODS: usize = 12;
const MOST_PLACES: usize = 60;

/// A map.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// What its files are called by.
    pub name: String,
    /// What it shows.
    pub title: String,
    /// Names of the axes.
    pub axes: [String; 2],
    /// Places along each axis, in the order of the file.
    pub places: [Vec<String>; 2],
    /// Names and cells of its methods.
    pub methods: Vec<(String, Vec<Cell>)>,
}

/// A cell.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Which places along the axes.
    pub at: [usize; 2],
    /// Error found.
    pub error: Option<f64>,
    /// How exact that is.
    pub reference: Option<f64>,
    /// What the method is meant to keep.
    pub bound: Option<f64>,
    /// What it states.
    pub stated: Option<f64>,
    /// Whether it refuses.
    pub refused: bool,
}

/// Whether the text is of maps: its second line is behind `# `.
#[must_use]
pub fn is_stability(bytes: &[u8]) -> bool {
    bytes.split(|&b| b == b'\n').nth(1).unwrap_or_default().starts_with(b"# ")
}

/// The maps of a file of that name.
///
/// # Errors
/// [`StabilityError`] with the line: another header, a map that was not announced or has no cells, a number that is none, too much of
/// something.
pub fn parse(file: &str, bytes: &[u8]) -> Result<Vec<Map>, StabilityError> {
    let failed = |line: u64, what: String| StabilityError { file: file.into(), line, what };
    let text = std::str::from_utf8(bytes).map_err(|_| failed(1, "not UTF-8".into()))?;
    let (title, mut rest) = text.split_once('\n').unwrap_or((text, ""));
    if !title.starts_with("# ") {
        return Err(failed(1, format!("expected `# title`, found {}", excerpt(title))));
    }
    let mut maps: Vec<Map> = Vec::new();
    let mut before = 1;
    while let Some((line, more)) = rest.strip_prefix("# ").and_then(|rest| rest.split_once('\n')) {
        before += 1;
        let parts: Vec<&str> = line.trim_end().split(" | ").collect();
        let [name, title, x, y] = parts[..] else {
            return Err(failed(before, format!("expected `# name | title | x | y`, found {}", excerpt(line))));
        };
        if !name.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c)) || maps.len() == MOST_MAPS {
            return Err(failed(
                before,
                format!("no name for a file, or more than {MOST_MAPS} maps: {}", excerpt(name)),
            ));
        }
        let (places, methods) = ([Vec::new(), Vec::new()], Vec::new());
        maps.push(Map { name: name.into(), title: title.into(), axes: [x.into(), y.into()], places, methods });
        rest = more;
    }
    let (mut records, mut record) = (Records::new(rest), StringRecord::new());
    let mut header = false;
    while let Some(line) = records.read(&mut record).map_err(|(line, what)| failed(line + before, what))? {
        let line = line + before;
        let fields: Vec<&str> = record.iter().collect();
        if !header {
            if fields != HEADER {
                let expected = HEADER.join(",");
                return Err(failed(
                    line,
                    format!("expected the header {expected}, found {}", excerpt(&fields.join(","))),
                ));
            }
            header = true;
            continue;
        }
        let [map, method, x, y, error, reference, bound, stated, refused] = fields[..] else {
            return Err(failed(line, format!("expected {} fields, found {}", HEADER.len(), fields.len())));
        };
        let number = |text: &str| -> Result<Option<f64>, StabilityError> {
            if text.is_empty() {
                return Ok(None);
            }
            let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite() && *number >= 0.0);
            let number = number.map(Some);
            number.ok_or_else(|| failed(line, format!("expected a number of at least 0, found {}", excerpt(text))))
        };
        let map = maps.iter_mut().find(|known| known.name == map);
        let map = map.ok_or_else(|| failed(line, format!("a map that was not announced: {}", excerpt(fields[0]))))?;
        let mut at = [0; 2];
        for ((at, places), place) in at.iter_mut().zip(&mut map.places).zip([x, y]) {
            *at = match places.iter().position(|known| known == place) {
                Some(i) => i,
                None if places.len() == MOST_PLACES => {
                    return Err(failed(line, format!("more than {MOST_PLACES} places along an axis")));
                }
                None => {
                    places.push(place.to_owned());
                    places.len() - 1
                }
            };
        }
        let cell = Cell {
            at,
            error: number(error)?,
            reference: number(reference)?,
            bound: number(bound)?,
            stated: number(stated)?,
            refused: match refused {
                "0" => false,
                "1" => true,
                other => return Err(failed(line, format!("expected 0 or 1, found {}", excerpt(other)))),
            },
        };
        let known = map.methods.iter().position(|(name, _)| name == method);
        if known.is_none() && map.methods.len() == MOST_METHODS {
            return Err(failed(line, format!("more than {MOST_METHODS} methods of a map")));
        }
        match known {
            Some(i) => map.methods[i].1.push(cell),
            None => map.methods.push((method.to_owned(), vec![cell])),
        }
    }
    match maps.iter().find(|map| map.methods.is_empty()) {
        Some(map) => Err(failed(before + 2, format!("no cells of the map {}", map.name))),
        None if maps.is_empty() => Err(failed(2, "no maps".into())),
        None => Ok(maps),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const HEAD: &str = "# t\n# m | Errors | sun | depth\nmap,method,x,y,error,reference,bound,stated,refused\n";

    #[test]
    fn cells_go_to_their_maps_and_methods() {
        let text =
            format!("{HEAD}m,\"a, b\",60,0,1e-3,1e-4,0.01,2e-3,0\nm,\"a, b\",0,0.1,,,,,1\nm,c,60,0.1,0.5,0,,,0\n");
        assert!(is_stability(text.as_bytes()) && !is_stability(b"# t\npanel,curve,x,y\n"));
        let maps = parse("s.csv", text.as_bytes()).expect("maps");
        assert_eq!((maps.len(), maps[0].title.as_str(), maps[0].methods.len()), (1, "Errors", 2));
        assert_eq!(maps[0].places, [vec!["60".to_owned(), "0".into()], vec!["0".into(), "0.1".into()]]);
        let cells = &maps[0].methods[0].1;
        assert_eq!((cells[0].error, cells[0].stated, cells[0].refused), (Some(1e-3), Some(2e-3), false));
        assert_eq!((cells[1].at, cells[1].error, cells[1].refused), ([1, 1], None, true));
    }

    #[test]
    fn what_has_no_maps_is_refused_with_its_line() {
        for (text, what) in [
            ("map\n".to_owned(), "s.csv, line 1: expected `# title`"),
            ("# t\n# m\n".to_owned(), "s.csv, line 2: expected `# name | title | x | y`"),
            ("# t\n# ../m | a | b | c\n".to_owned(), "s.csv, line 2: no name for a file"),
            ("# t\n# m | a | b | c\nmap,x\n".to_owned(), "s.csv, line 3: expected the header"),
            (HEAD.to_owned(), "s.csv, line 4: no cells of the map m"),
            (format!("{HEAD}n,a,0,0,,,,,0\n"), "s.csv, line 4: a map that was not announced"),
            (format!("{HEAD}m,a,0,0,NaN,,,,0\n"), "s.csv, line 4: expected a number"),
            (format!("{HEAD}m,a,0,0,,,,,2\n"), "s.csv, line 4: expected 0 or 1"),
            (format!("{HEAD}m,a,0\n"), "s.csv, line 4: expected 9 fields, found 3"),
        ] {
            let error = parse("s.csv", text.as_bytes()).expect_err("refused").to_string();
            assert!(error.starts_with(what), "{error}");
        }
    }
}
