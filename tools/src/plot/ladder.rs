//! Error against cost of every method, with the front of those that no other beats in both.

use super::colours::{BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION};
use super::model::{Axis, Colour, Curve, Figure, Key, Label, Panel, Stroke};
use crate::ladder::{Found, Row};

/// What is drawn upwards: its name, and which number it is.
type Quantity = (&'static str, fn(&Found) -> f64);

const QUANTITIES: [Quantity; 2] = [
    ("rms error of luminance / %", |found| 100.0 * found.luminance),
    ("mean colour difference CIEDE2000", |found| found.difference),
];

/// One setting of a method, as a point: geometric means over the scenes.
struct Point<'a> {
    method: &'a str,
    setting: &'a str,
    at: (f64, f64),
    scenes: usize,
}

/// Figures and what their names end in: of all scenes together, and of each regime. Only settings that cover all scenes of a figure are on its
/// front; those that cover some are drawn pale.
#[must_use]
pub fn figures(rows: &[Row]) -> Vec<(String, Figure)> {
    let mut regimes: Vec<&str> = Vec::new();
    for row in rows {
        if !regimes.contains(&row.regime.as_str()) {
            regimes.push(&row.regime);
        }
    }
    let of = |wanted: Option<&str>| -> Vec<&Row> {
        rows.iter().filter(|row| wanted.is_none_or(|regime| row.regime == regime)).collect()
    };
    let mut figures = vec![(String::new(), figure("all regimes", &of(None)))];
    figures.extend(
        regimes.iter().map(|regime| (format!("-{}", regime.replace(' ', "-")), figure(regime, &of(Some(regime))))),
    );
    figures
}

fn colour(method: &str) -> Colour {
    match method {
        "solved" => BLUE,
        "paths" => GREEN,
        "judge" => BLACK,
        "isotropic" => VERMILION,
        "single" => ORANGE,
        "oneil" => PURPLE,
        "hosek-wilkie" | "preetham" => SKY,
        _ => GREY,
    }
}

/// The colour half-way to white.
fn pale((r, g, b): Colour) -> Colour {
    let half = |v: u8| 255 - (255 - v) / 3;
    (half(r), half(g), half(b))
}

fn figure(name: &str, rows: &[&Row]) -> Figure {
    let panels = QUANTITIES.iter().map(|quantity| panel(quantity, rows)).collect();
    Figure::new(
        format!("The ladder of methods, {name}: geometric means over scenes (pale: of some scenes, not all)"),
        vec![panels],
    )
}

/// Geometric means of the settings on the scenes that they cover, and how many scenes there are.
fn points<'a>((_, value): &Quantity, rows: &[&'a Row]) -> (Vec<Point<'a>>, usize) {
    let mut seen: Vec<(&str, &str)> = Vec::new();
    let (mut points, mut most) = (Vec::new(), 0);
    for row in rows {
        let key = (row.method.as_str(), row.setting.as_str());
        if seen.contains(&key) {
            continue;
        }
        seen.push(key);
        let same = rows.iter().filter(|other| (other.method.as_str(), other.setting.as_str()) == key);
        most = most.max(same.clone().count());
        let found: Vec<&Found> = same.filter_map(|other| other.found.as_ref()).filter(|f| value(f) > 0.0).collect();
        if !found.is_empty() {
            let mean = |of: &dyn Fn(&Found) -> f64| {
                (found.iter().map(|f| of(f).max(1e-9).ln()).sum::<f64>() / found.len() as f64).exp()
            };
            let at = (mean(&|f| f.seconds), mean(&|f| value(f)));
            points.push(Point { method: key.0, setting: key.1, at, scenes: found.len() });
        }
    }
    (points, most)
}

/// Points that none is both cheaper and better than, from the cheapest.
fn front(mut points: Vec<(f64, f64)>) -> Vec<(f64, f64)> {
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.total_cmp(&b.1)));
    let mut front: Vec<(f64, f64)> = Vec::new();
    for point in points {
        if front.last().is_none_or(|best| point.1 < best.1) {
            front.push(point);
        }
    }
    front
}

fn panel(quantity: &Quantity, rows: &[&Row]) -> Panel {
    let (points, all) = points(quantity, rows);
    let whole = points.iter().filter(|point| point.scenes == all).map(|point| point.at).collect();
    let front = front(whole);
    let mut curves = vec![Curve::new("", GREY, front.clone()).stroke(Stroke::Dashed)];
    let mut labels = Vec::new();
    // What is on the front has its name first, and so the best place.
    let mut order: Vec<&Point<'_>> = points.iter().collect();
    order.sort_by_key(|point| !front.contains(&point.at));
    for point in order {
        let own = colour(point.method);
        let shown = if point.scenes == all { own } else { pale(own) };
        curves.push(Curve::new("", shown, vec![point.at]).stroke(Stroke::Marks));
        let text = match point.setting {
            "as published" => point.method.to_owned(),
            setting => format!("{} {setting}", point.method),
        };
        labels.push(Label { at: point.at, text, colour: own });
    }
    let (x, y) = (
        axis("core-seconds: tables and a picture of 64 x 64", points.iter().map(|p| p.at.0)),
        axis(quantity.0, points.iter().map(|p| p.at.1)),
    );
    Panel::new(x, y, curves).key(Key::None).labels(labels)
}

/// A logarithmic axis that holds the values.
fn axis(label: &str, values: impl Iterator<Item = f64>) -> Axis {
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
    let (low, high) = (low.log10().floor(), (1.2 * high).log10().ceil().max(low.log10().floor() + 1.0));
    Axis::logarithmic(label, 10_f64.powf(low), 10_f64.powf(high), 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats() {
        let points = vec![(1.0, 5.0), (2.0, 6.0), (3.0, 2.0), (3.0, 4.0), (10.0, 2.0), (20.0, 1.0)];
        assert_eq!(front(points), [(1.0, 5.0), (3.0, 2.0), (20.0, 1.0)]);
        assert!(front(Vec::new()).is_empty());
    }

    #[test]
    fn there_is_a_figure_of_all_and_one_of_each_regime() {
        let row = |regime: &str, method: &str, found| Row {
            regime: regime.into(),
            method: method.into(),
            setting: "as published".into(),
            found,
        };
        let found = |luminance| Some(Found { luminance, difference: 3.0, seconds: 0.5 });
        let rows = [
            row("day", "single", found(0.1)),
            row("day", "preetham", found(0.2)),
            row("low sun", "single", found(0.4)),
            row("low sun", "preetham", None),
        ];
        let figures = figures(&rows);
        let names: Vec<&str> = figures.iter().map(|(name, _)| name.as_str()).collect();
        assert_eq!(names, ["", "-day", "-low-sun"]);
        let all = &figures[0].1.rows[0][0];
        // sqrt(0.1 x 0.4) = 0.2, in percent; Preetham's sky covers one scene of two and is pale.
        assert!((all.labels[0].at.1 - 20.0).abs() < 1e-9 && all.labels[0].text == "single");
        assert_eq!(all.curves[2].colour, pale(SKY));
        assert_eq!(figures[2].1.rows[0][0].labels.len(), 1);
    }
}
