//! What parts of the model are worth: a heat map with the parts downwards, the regimes across, and a number in each cell.

use super::model::{Axis, Cells, Figure, Key, Panel};
use crate::atlas::Row;

/// What panels show: their titles, which number it is, and its unit over that of the file.
const PANELS: [(&str, usize, f64); 3] =
    [("radiance / %", 0, 100.0), ("luminance / %", 1, 100.0), ("colour / CIEDE2000", 2, 1.0)];

/// Ends of the scale of colours. What is smaller has the lower colour.
const SCALE: (f64, f64) = (0.01, 100.0);

/// The figure of an atlas: medians over the scenes of each regime.
#[must_use]
pub fn figure(rows: &[Row]) -> Figure {
    let (mut terms, mut regimes): (Vec<&str>, Vec<&str>) = (Vec::new(), Vec::new());
    for row in rows {
        if !terms.contains(&row.term.as_str()) {
            terms.push(&row.term);
        }
        if !regimes.contains(&row.regime.as_str()) {
            regimes.push(&row.regime);
        }
    }
    let panels = PANELS.iter().enumerate().map(|(i, panel)| self::panel(rows, (&terms, &regimes), *panel, i)).collect();
    let title = "What leaving out a part of the model changes: rms over directions, medians over scenes";
    Figure::new(title, vec![panels])
}

fn panel(
    rows: &[Row],
    (terms, regimes): (&[&str], &[&str]),
    (title, which, unit): (&str, usize, f64),
    i: usize,
) -> Panel {
    let middle = |k: usize| k as f64 + 0.5;
    let names = |texts: &[&str], shown: bool| -> Vec<(f64, String)> {
        let text = |text: &str| if shown { text.to_owned() } else { String::new() };
        texts.iter().enumerate().map(|(k, name)| (middle(k), text(name))).collect()
    };
    // The first term is on top.
    let upwards: Vec<&str> = terms.iter().rev().copied().collect();
    let below: Vec<&str> = regimes.iter().map(|regime| short(regime)).collect();
    let x = Axis::linear("", 0.0, regimes.len() as f64, 1.0).named(names(&below, true));
    let y = Axis::linear("", 0.0, terms.len() as f64, 1.0).named(names(&upwards, i == 0));
    let mut values = Vec::new();
    for (down, term) in upwards.iter().enumerate() {
        for (across, regime) in regimes.iter().enumerate() {
            let same = rows.iter().filter(|row| row.term == *term && row.regime == *regime);
            let value = median(same.map(|row| unit * row.change[which]).collect());
            let (left, bottom) = (across as f64, down as f64);
            values.push(((left, bottom, left + 1.0, bottom + 1.0), value));
        }
    }
    let scale = Axis::logarithmic("% or CIEDE2000", SCALE.0, SCALE.1, 1);
    let cells = Cells { bar: i + 1 == PANELS.len(), ..Cells::new(scale, values) };
    Panel { cells: Some(cells), ..Panel::new(x, y, Vec::new()).titled(title).key(Key::None) }
}

/// The word for a regime that goes below a column.
fn short(regime: &str) -> &str {
    match regime {
        "low sun" => "low",
        "twilight" => "dusk",
        other => other,
    }
}

/// The median; no number of none. What is nothing is shown as the least of the scale.
fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).map_or(f64::NAN, |value| value.max(1e-9))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_medians_with_the_first_term_on_top() {
        let row = |term: &str, regime: &str, luminance: f64| Row {
            term: term.into(),
            regime: regime.into(),
            change: [0.0, luminance, 1.0],
        };
        let rows = [
            row("ozone", "day", 0.01),
            row("ozone", "day", 0.03),
            row("ozone", "day", 0.02),
            row("disc", "space", 0.5),
        ];
        let figure = figure(&rows);
        let panel = &figure.rows[0][1];
        assert_eq!(panel.y.names[1], (1.5, String::new()));
        let cells = &panel.cells.as_ref().expect("cells").values;
        // Below: the disc by day (no scene) and from space; above: ozone.
        assert!(cells[0].1.is_nan() && (cells[1].1 - 50.0).abs() < 1e-9 && (cells[2].1 - 2.0).abs() < 1e-9);
        assert!(figure.rows[0][2].cells.as_ref().is_some_and(|cells| cells.bar));
    }
}
