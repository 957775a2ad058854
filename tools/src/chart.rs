//! Points of a chart in a CSV file, as `airlight study` writes it: a line `# title`, the header `panel,curve,X,Y` with
//! the names of the axes, and a row for each point.

use crate::records::Records;
use csv::StringRecord;
use tables::excerpt;

/// Why a file is no chart: file, line, and what is wrong.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{file}, line {line}: {what}")]
pub struct ChartError {
    file: String,
    line: u64,
    what: String,
}

/// The most panels, and the most curves of one.
const MOST_PANELS: usize = 12;
const MOST_CURVES: usize = 24;

/// The most points; each takes some 50 bytes.
const MOST_POINTS: usize = 10_000;

/// A chart.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Its heading.
    pub title: String,
    /// Names of the axes, with units.
    pub axes: [String; 2],
    /// Its panels, in the order of the file.
    pub panels: Vec<Panel>,
}

/// Points of one panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// What is plotted.
    pub name: String,
    /// Names and points of the curves, in the order of the file.
    pub curves: Vec<(String, Vec<(f64, f64)>)>,
}

/// The chart in a file of that name.
///
/// # Errors
/// [`ChartError`] with the line: no title, another header, a number that is none, a panel without points, or too many of them.
pub fn parse(file: &str, bytes: &[u8]) -> Result<Chart, ChartError> {
    let failed = |line: u64, what: String| ChartError { file: file.into(), line, what };
    let text = std::str::from_utf8(bytes).map_err(|_| failed(1, "not UTF-8".into()))?;
    let (title, rest) = text.split_once('\n').unwrap_or((text, ""));
    let title =
        title.strip_prefix("# ").ok_or_else(|| failed(1, format!("expected `# title`, found {}", excerpt(title))))?;
    let (mut records, mut record) = (Records::new(rest), StringRecord::new());
    let mut axes: Option<[String; 2]> = None;
    let mut panels: Vec<Panel> = Vec::new();
    let mut points = 0;
    while let Some(line) = records.read(&mut record).map_err(|(line, what)| failed(line + 1, what))? {
        let line = line + 1;
        let fields: Vec<&str> = record.iter().collect();
        let [panel, curve, x, y] = fields[..] else {
            return Err(failed(line, format!("expected 4 fields, found {}", fields.len())));
        };
        if axes.is_none() {
            if (panel, curve) != ("panel", "curve") {
                let found = excerpt(&format!("{panel},{curve}")).to_owned();
                return Err(failed(line, format!("expected the header panel,curve,X,Y, found {found}")));
            }
            axes = Some([x.to_owned(), y.to_owned()]);
            continue;
        }
        let number = |text: &str| {
            let number = text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
            number.ok_or_else(|| failed(line, format!("expected a number, found {}", excerpt(text))))
        };
        let at = (number(x)?, number(y)?);
        points += 1;
        if points > MOST_POINTS {
            return Err(failed(line, format!("more than {MOST_POINTS} points")));
        }
        add(&mut panels, panel, curve, at).map_err(|what| failed(line, what))?;
    }
    let axes = axes.ok_or_else(|| failed(2, "expected the header panel,curve,X,Y, found nothing".into()))?;
    if panels.is_empty() {
        return Err(failed(3, "no points".into()));
    }
    Ok(Chart { title: title.trim().to_owned(), axes, panels })
}

/// Adds a point to its curve.
fn add(panels: &mut Vec<Panel>, panel: &str, curve: &str, at: (f64, f64)) -> Result<(), String> {
    let at_panel = match panels.iter().position(|p| p.name == panel) {
        Some(i) => i,
        None if panels.len() == MOST_PANELS => return Err(format!("more than {MOST_PANELS} panels")),
        None => {
            panels.push(Panel { name: panel.to_owned(), curves: Vec::new() });
            panels.len() - 1
        }
    };
    let curves = &mut panels[at_panel].curves;
    match curves.iter().position(|(name, _)| name == curve) {
        Some(i) => curves[i].1.push(at),
        None if curves.len() == MOST_CURVES => return Err(format!("more than {MOST_CURVES} curves in a panel")),
        None => curves.push((curve.to_owned(), vec![at])),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_go_to_their_curves_in_order() {
        let text = "# Errors\npanel,curve,size / MB,error\na,\"one, two\",1,1e-3\na,x,100,0.5\nb,x,2,3\nb,x,3,4\n";
        let chart = parse("c.csv", text.as_bytes()).expect("a chart");
        assert_eq!((chart.title.as_str(), chart.axes), ("Errors", ["size / MB".to_owned(), "error".to_owned()]));
        let panel = |name: &str, curves: Vec<(&str, Vec<(f64, f64)>)>| Panel {
            name: name.into(),
            curves: curves.into_iter().map(|(name, points)| (name.into(), points)).collect(),
        };
        let a = panel("a", vec![("one, two", vec![(1.0, 1e-3)]), ("x", vec![(100.0, 0.5)])]);
        assert_eq!(chart.panels, [a, panel("b", vec![("x", vec![(2.0, 3.0), (3.0, 4.0)])])]);
    }

    #[test]
    fn what_is_no_chart_is_refused_with_its_line() {
        for (text, what) in [
            ("panel,curve,x,y\n", "c.csv, line 1: expected `# title`"),
            ("# t\n", "c.csv, line 2: expected the header"),
            ("# t\npanel,x,y\n", "c.csv, line 2: expected 4 fields, found 3"),
            ("# t\npanel,curve,x,y\n", "c.csv, line 3: no points"),
            ("# t\npanel,curve,x,y\na,b,1,NaN\n", "c.csv, line 3: expected a number, found NaN"),
        ] {
            let error = parse("c.csv", text.as_bytes()).expect_err(text).to_string();
            assert!(error.starts_with(what), "{error}");
        }
    }
}
