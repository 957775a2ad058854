//! A chart of points as a figure. An axis is logarithmic if its values are positive and span a factor of 20.

use super::colours::{BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION};
use super::model::{Axis, Colour, Curve, Figure, Key, Panel, Stroke};
use crate::chart::Chart;

/// Colours of curves, in turn; a second round is dashed.
const COLOURS: [Colour; 8] = [BLUE, VERMILION, GREEN, ORANGE, PURPLE, SKY, BLACK, GREY];

/// Panels side by side, in rows of at most three; curves of one name look alike in all of them and are named once.
#[must_use]
pub fn figure(chart: &Chart) -> Figure {
    let (axes, groups) = (&chart.axes, &chart.panels);
    let mut names: Vec<String> = Vec::new();
    for (name, _) in groups.iter().flat_map(|group| &group.curves) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    let look = |name: &str, points: Vec<(f64, f64)>| {
        let i = names.iter().position(|n| n == name).unwrap_or(0);
        let stroke = if i < COLOURS.len() { Stroke::Solid } else { Stroke::Dashed };
        Curve::new(name, COLOURS[i % COLOURS.len()], points).stroke(stroke)
    };
    let all = || groups.iter().flat_map(|group| &group.curves).flat_map(|(_, points)| points);
    let x = axis(&axes[0], all().map(|p| p.0));
    let key = names.iter().map(|name| look(name, Vec::new())).collect();
    let panels: Vec<Panel> = groups
        .iter()
        .map(|group| {
            let y = axis(&axes[1], group.curves.iter().flat_map(|(_, points)| points).map(|p| p.1));
            let mut curves = Vec::new();
            for (name, points) in &group.curves {
                // A line, and a disc at each point.
                curves.push(look(name, points.clone()));
                curves.push(look(name, points.clone()).stroke(Stroke::Marks));
            }
            Panel::new(x.clone(), y, curves).titled(group.name.as_str()).key(Key::None)
        })
        .collect();
    let across = panels.len().div_ceil(panels.len().div_ceil(3));
    Figure::new(chart.title.as_str(), panels.chunks(across).map(<[Panel]>::to_vec).collect()).key(key)
}

/// An axis that holds the values.
fn axis(label: &str, values: impl Iterator<Item = f64>) -> Axis {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
    if low > 0.0 && high / low > 20.0 {
        let (low, high) = (low.log10().floor(), high.log10().ceil());
        let decades = ((high - low) / 8.0).ceil().max(1.0);
        return Axis::logarithmic(label, 10_f64.powf(low), 10_f64.powf(high), decades as u32);
    }
    let width = (high - low).max(f64::MIN_POSITIVE.max(1e-9 * high.abs()));
    // One, two or five times a power of ten, at most eight times.
    let power = 10_f64.powf((width / 8.0).log10().floor());
    let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|step| width / step <= 8.0).unwrap_or(width);
    Axis::linear(label, (low / step).floor() * step, (high / step).ceil() * step, step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::chart;

    #[test]
    fn points_go_to_their_panels_and_axes_hold_them() {
        let text = "# Errors\npanel,curve,size / MB,error\na,\"one, two\",1,1e-3\na,x,100,0.5\nb,x,2,3\nb,x,3,4\n";
        let figure = figure(&chart::parse("c.csv", text.as_bytes()).expect("a chart"));
        assert_eq!((figure.title.as_str(), figure.rows.len(), figure.rows[0].len()), ("Errors", 1, 2));
        let [a, b] = [&figure.rows[0][0], &figure.rows[0][1]];
        assert_eq!((a.x.logarithmic, a.x.range, a.y.range), (true, (1.0, 100.0), (1e-3, 1.0)));
        assert_eq!((b.y.logarithmic, b.y.range), (false, (3.0, 4.0)));
        let names: Vec<&str> = figure.key.iter().map(|curve| curve.name.as_str()).collect();
        assert_eq!(names, ["one, two", "x"]);
        assert_eq!(b.curves[0].colour, a.curves[2].colour);
    }
}
