//! Where panels, axes, ticks and keys of a figure stand.

use super::PlotError;
use super::canvas::{Canvas, Frame, Place, Point};
use super::colours::{self, BLACK, GREY, GRID, WHITE};
use super::model::{Axis, Cells, Colour, Curve, Figure, Key, Label, Panel, Stroke};
use plotters::backend::DrawingBackend;

/// Width and height of a picture.
pub(super) const SIZE: (u32, u32) = (1600, 1000);

/// Sizes of texts.
const HEADING: f64 = 25.0;
const LABEL: f64 = 23.0;
const NUMBER: f64 = 20.0;

/// Room for the numbers and the label of an axis.
const LEFT: f64 = 116.0;
/// Room at the left of a panel whose axis there has neither label nor texts: it is its neighbour's.
const JOINED: f64 = 4.0;
const BELOW: f64 = 82.0;
const RIGHT: f64 = 34.0;
const ABOVE: f64 = 26.0;
/// What of it the label takes.
const LABEL_ROOM: f64 = 38.0;
/// Room for a line of heading.
const LINE: f64 = 36.0;
/// Room for the bar of a heat map: distance, width, and its numbers and label.
const BAR: (f64, f64, f64) = (30.0, 30.0, 110.0);
/// How far a cell reaches under the next one above and to the right, so that no seam shows.
const OVERLAP: f64 = 0.5;
/// Keys: height of a line, length of the sample, distance to the name and around.
const KEY_LINE: f64 = 30.0;
const SAMPLE: f64 = 46.0;
const GAP: f64 = 12.0;

/// Room that a panel needs around the frame of its axes.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Margins {
    left: f64,
    above: f64,
    right: f64,
    below: f64,
}

fn margins<B: DrawingBackend>(canvas: &Canvas<B>, panel: &Panel) -> Margins {
    let title = if panel.title.is_empty() { 0.0 } else { LINE };
    let beside = match (&panel.cells, panel.key) {
        (Some(cells), _) if cells.bar => BAR.0 + BAR.1 + BAR.2,
        (None, Key::Beside) => key_width(canvas, panel) + GAP,
        _ => 0.0,
    };
    // Numbers and label of the ordinate; names are wider than numbers.
    let widest = panel.y.names.iter().map(|(_, name)| canvas.text_width(name, NUMBER)).fold(0.0, f64::max);
    let joined = panel.y.label.is_empty() && ticks(&panel.y).iter().all(|tick| tick.text.as_deref() == Some(""));
    let left = match panel.y.label.as_str() {
        _ if joined => JOINED,
        "" => (LEFT - LABEL_ROOM).max(widest + 60.0),
        _ => LEFT.max(widest + 60.0),
    };
    let below = if panel.x.label.is_empty() { BELOW - LABEL_ROOM } else { BELOW };
    Margins { left, above: ABOVE + title, right: RIGHT + beside, below }
}

/// Draws a figure.
pub(super) fn draw<B: DrawingBackend>(canvas: &mut Canvas<B>, figure: &Figure) -> Result<(), PlotError> {
    let (width, height) = (f64::from(SIZE.0), f64::from(SIZE.1));
    canvas.rectangle(Frame { left: 0.0, top: 0.0, right: width, bottom: height }, WHITE, true)?;
    let mut top = 0.0;
    if !figure.title.is_empty() {
        canvas.text(&figure.title, (0.5 * width, 30.0), HEADING, BLACK, Place::Centred)?;
        top = LINE + 8.0;
    }
    top = draw_common_key(canvas, &figure.key, top, width)?;
    // What is left between the margins of all rows is shared equally by their frames; so across a row, by its shares.
    let rows: Vec<Vec<Margins>> =
        figure.rows.iter().map(|row| row.iter().map(|panel| margins(canvas, panel)).collect()).collect();
    let most = |row: &[Margins], of: fn(&Margins) -> f64| row.iter().map(of).fold(0.0, f64::max);
    let around: f64 = rows.iter().map(|row| most(row, |m| m.above) + most(row, |m| m.below)).sum();
    let frame_height = (height - top - around) / figure.rows.len().max(1) as f64;
    for (row, margins) in figure.rows.iter().zip(&rows) {
        top += most(margins, |m| m.above);
        let total: f64 = row.iter().map(|panel| panel.share).sum();
        let free = width - margins.iter().map(|m| m.left + m.right).sum::<f64>();
        let mut left = 0.0;
        for (panel, m) in row.iter().zip(margins) {
            let right = left + m.left + free * panel.share / total;
            let frame = Frame { left: left + m.left, top, right, bottom: top + frame_height };
            draw_panel(canvas, panel, frame, left)?;
            left = right + m.right;
        }
        top += frame_height + most(margins, |m| m.below);
    }
    Ok(())
}

/// Draws the key of all panels from `top`, in lines that fit the width, and gives where it ends.
fn draw_common_key<B: DrawingBackend>(
    canvas: &mut Canvas<B>,
    key: &[Curve],
    top: f64,
    width: f64,
) -> Result<f64, PlotError> {
    if key.is_empty() {
        return Ok(top);
    }
    let entry = |curve: &Curve| SAMPLE + 3.0 * GAP + canvas.text_width(&curve.name, NUMBER);
    let widths: Vec<f64> = key.iter().map(entry).collect();
    // As few lines as hold them, equally many entries in each.
    let room = width - 2.0 * RIGHT;
    let fits = |lines: usize| widths.chunks(key.len().div_ceil(lines)).all(|line| line.iter().sum::<f64>() <= room);
    let lines = (1..=key.len()).find(|&lines| fits(lines)).unwrap_or(key.len());
    let mut y = top + 0.5 * KEY_LINE;
    let each = key.len().div_ceil(lines);
    for (line, widths) in key.chunks(each).zip(widths.chunks(each)) {
        let mut left = 0.5 * (width - widths.iter().sum::<f64>());
        for (curve, entry) in line.iter().zip(widths) {
            draw_sample(canvas, &curve.name, curve.colour, curve.stroke, (left, y))?;
            left += entry;
        }
        y += KEY_LINE;
    }
    Ok(y - 0.5 * KEY_LINE)
}

/// Draws a panel with its axes around the frame given; its label stands at `left`.
fn draw_panel<B: DrawingBackend>(
    canvas: &mut Canvas<B>,
    panel: &Panel,
    frame: Frame,
    left: f64,
) -> Result<(), PlotError> {
    if !panel.title.is_empty() {
        let middle = 0.5 * (frame.left + frame.right);
        canvas.text(&panel.title, (middle, frame.top - 20.0), LABEL, BLACK, Place::Centred)?;
    }
    let place = |x: f64, y: f64| -> Option<Point> {
        let (across, up) = (panel.x.fraction(x)?, panel.y.fraction(y)?);
        Some((frame.left + across * frame.width(), frame.bottom - up * frame.height()))
    };
    if let Some(cells) = &panel.cells {
        draw_cells(canvas, cells, frame, place)?;
    }
    draw_ticks(canvas, panel, frame)?;
    for area in &panel.areas {
        let cut = |y: f64| y.clamp(frame.top, frame.bottom);
        let edge = |of: fn(&(f64, f64, f64)) -> (f64, f64)| {
            let points = area.points.iter().map(of).filter_map(|(x, y)| place(x, y));
            points.map(|(x, y)| (x, cut(y))).collect::<Vec<Point>>()
        };
        let mut outline = edge(|p| (p.0, p.1));
        outline.extend(edge(|p| (p.0, p.2)).into_iter().rev());
        canvas.polygon(&outline, area.colour)?;
    }
    for curve in &panel.curves {
        let points: Vec<Option<Point>> = curve.points.iter().map(|&(x, y)| place(x, y)).collect();
        canvas.curve(&points, frame, curve.colour, curve.stroke)?;
    }
    let named = panel.labels.iter().filter_map(|label| Some((place(label.at.0, label.at.1)?, label)));
    draw_labels(canvas, &named.collect::<Vec<_>>(), frame)?;
    canvas.rectangle(frame, BLACK, false)?;
    canvas.text(&panel.x.label, (0.5 * (frame.left + frame.right), frame.bottom + 44.0), LABEL, BLACK, Place::Below)?;
    canvas.text(&panel.y.label, (left + 14.0, 0.5 * (frame.top + frame.bottom)), LABEL, BLACK, Place::Upwards)?;
    draw_key(canvas, panel, frame)
}

/// Size of the names of points, and their distance.
const NAME: f64 = 15.0;
const NAME_GAP: f64 = 8.0;

/// Draws names beside their points: right, left, above or below, nearest first, where neither the frame nor a point nor a name that
/// stands already is in the way; a name without room is left out.
fn draw_labels<B: DrawingBackend>(
    canvas: &mut Canvas<B>,
    labels: &[(Point, &Label)],
    frame: Frame,
) -> Result<(), PlotError> {
    const DISC: f64 = 6.0;
    let around = |(x, y): Point, wide: f64, high: f64| Frame {
        left: x - wide,
        top: y - high,
        right: x + wide,
        bottom: y + high,
    };
    let meet = |a: &Frame, b: &Frame| a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
    let mut taken: Vec<Frame> = labels.iter().map(|(at, _)| around(*at, DISC, DISC)).collect();
    for &((x, y), label) in labels {
        let (wide, high) = (0.5 * canvas.text_width(&label.text, NAME), 0.5 * NAME);
        let side = wide + NAME_GAP;
        let places = (0..6).map(f64::from).flat_map(|row| {
            let off = row * NAME;
            [
                (side, -off),
                (-side, -off),
                (side, off),
                (-side, off),
                (0.0, -off - 2.0 * NAME_GAP),
                (0.0, off + 2.0 * NAME_GAP),
            ]
        });
        let mut boxes = places.map(|(dx, dy)| around((x + dx, y + dy), wide, high));
        let free = boxes.find(|name| {
            let inside = name.left > frame.left && name.right < frame.right && name.top > frame.top;
            inside && name.bottom < frame.bottom && !taken.iter().any(|other| meet(name, other))
        });
        let Some(name) = free else { continue };
        let middle = (0.5 * (name.left + name.right), 0.5 * (name.top + name.bottom));
        // A name that stands apart is led to its point.
        if (middle.1 - y).abs() > 2.5 * NAME_GAP {
            let edge = if middle.1 < y { name.bottom } else { name.top };
            canvas.line((x, y), (x.clamp(name.left, name.right), edge), label.colour, 0.7)?;
        }
        canvas.text(&label.text, middle, NAME, label.colour, Place::Centred)?;
        taken.push(name);
    }
    Ok(())
}

fn draw_ticks<B: DrawingBackend>(canvas: &mut Canvas<B>, panel: &Panel, frame: Frame) -> Result<(), PlotError> {
    let grid = panel.cells.is_none();
    for tick in ticks(&panel.x) {
        let x = frame.left + tick.fraction * frame.width();
        if grid && tick.text.is_some() {
            canvas.line((x, frame.top), (x, frame.bottom), GRID, 1.0)?;
        }
        canvas.line((x, frame.bottom), (x, frame.bottom + tick.length()), BLACK, 1.2)?;
        if let Some(text) = &tick.text {
            canvas.text(text, (x, frame.bottom + 12.0), NUMBER, BLACK, Place::Below)?;
        }
    }
    for tick in ticks(&panel.y) {
        let y = frame.bottom - tick.fraction * frame.height();
        if grid && tick.text.is_some() {
            canvas.line((frame.left, y), (frame.right, y), GRID, 1.0)?;
        }
        canvas.line((frame.left - tick.length(), y), (frame.left, y), BLACK, 1.2)?;
        if let Some(text) = tick.text.as_ref().filter(|text| !text.is_empty()) {
            canvas.text(text, (frame.left - 13.0, y), NUMBER, BLACK, Place::LeftOf)?;
        }
    }
    Ok(())
}

fn draw_cells<B: DrawingBackend>(
    canvas: &mut Canvas<B>,
    cells: &Cells,
    frame: Frame,
    place: impl Fn(f64, f64) -> Option<Point>,
) -> Result<(), PlotError> {
    for &((left, bottom, right, top), value) in &cells.values {
        let (Some(a), Some(b)) = (place(left, top), place(right, bottom)) else { continue };
        let colour = match cells.scale.fraction(value) {
            Some(shade) => colours::viridis(shade),
            None if value.is_infinite() => GREY,
            None => continue,
        };
        let cell = Frame { left: a.0, top: a.1 - OVERLAP, right: b.0 + OVERLAP, bottom: b.1 };
        canvas.rectangle(cell, colour, true)?;
        if cells.numbered {
            let middle = (0.5 * (a.0 + b.0), 0.5 * (a.1 + b.1));
            let text = number(value, &cells.scale);
            canvas.text(&text, middle, 0.85 * NUMBER, colours::on(colour), Place::Centred)?;
        }
    }
    if cells.bar { draw_bar(canvas, cells, frame) } else { Ok(()) }
}

/// The number of a cell: whole, or with two digits where colours go by factors.
fn number(value: f64, scale: &Axis) -> String {
    match value {
        value if !scale.logarithmic || value >= 10.0 => format!("{value:.0}"),
        value if value >= 1.0 => format!("{value:.1}"),
        value if value >= 0.01 => format!("{value:.2}"),
        _ => "0".into(),
    }
}

fn draw_bar<B: DrawingBackend>(canvas: &mut Canvas<B>, cells: &Cells, frame: Frame) -> Result<(), PlotError> {
    let left = frame.right + BAR.0;
    let right = left + BAR.1;
    let bar = Frame { left, right, ..frame };
    let steps = 200;
    for i in 0..steps {
        let at = |i: u32| frame.bottom - f64::from(i) / f64::from(steps) * frame.height();
        let colour = colours::viridis((f64::from(i) + 0.5) / f64::from(steps));
        canvas.rectangle(Frame { top: at(i + 1) - OVERLAP, bottom: at(i), ..bar }, colour, true)?;
    }
    canvas.rectangle(bar, BLACK, false)?;
    for tick in ticks(&cells.scale) {
        let y = frame.bottom - tick.fraction * frame.height();
        canvas.line((right, y), (right + tick.length(), y), BLACK, 1.2)?;
        if let Some(text) = &tick.text {
            canvas.text(text, (right + 13.0, y), NUMBER, BLACK, Place::RightOf)?;
        }
    }
    if let Some(meaning) = &cells.infinite {
        let top = frame.bottom + 14.0;
        let sample = Frame { left, right, top, bottom: top + BAR.1 };
        canvas.rectangle(sample, GREY, true)?;
        canvas.rectangle(sample, BLACK, false)?;
        canvas.text(meaning, (right + 13.0, top + 0.5 * BAR.1), NUMBER, BLACK, Place::RightOf)?;
    }
    let middle = 0.5 * (frame.top + frame.bottom);
    canvas.text(&cells.scale.label, (right + 72.0, middle), LABEL, BLACK, Place::Upwards)
}

/// Name, colour and look of what has a name, from the top of the key: curves, then areas, the highest first.
fn named(panel: &Panel) -> Vec<(&str, Colour, Stroke)> {
    let curves = panel.curves.iter().map(|curve| (curve.name.as_str(), curve.colour, curve.stroke));
    let areas = panel.areas.iter().rev().map(|area| (area.name.as_str(), area.colour, Stroke::Filled));
    curves.chain(areas).filter(|(name, ..)| !name.is_empty()).collect()
}

fn key_width<B: DrawingBackend>(canvas: &Canvas<B>, panel: &Panel) -> f64 {
    let widest = named(panel).into_iter().map(|(name, ..)| canvas.text_width(name, NUMBER)).fold(0.0, f64::max);
    widest + SAMPLE + 3.0 * GAP
}

fn draw_key<B: DrawingBackend>(canvas: &mut Canvas<B>, panel: &Panel, frame: Frame) -> Result<(), PlotError> {
    let entries = named(panel);
    if entries.is_empty() || panel.key == Key::None {
        return Ok(());
    }
    let (width, height) = (key_width(canvas, panel), entries.len() as f64 * KEY_LINE + GAP);
    let (low, high) = (frame.bottom - GAP - height, frame.top + GAP);
    let (near, far) = (frame.left + GAP, frame.right - GAP - width);
    let (left, top) = match panel.key {
        Key::TopLeft => (near, high),
        Key::TopRight | Key::None => (far, high),
        Key::BottomLeft => (near, low),
        Key::BottomRight => (far, low),
        Key::Beside => (frame.right + GAP, frame.top),
    };
    let inside = Frame { left, top, right: left + width, bottom: top + height };
    if panel.key != Key::Beside {
        canvas.rectangle(inside, WHITE, true)?;
        canvas.rectangle(inside, GRID, false)?;
    }
    for (i, (name, colour, stroke)) in entries.into_iter().enumerate() {
        let y = top + 0.5 * GAP + (i as f64 + 0.5) * KEY_LINE;
        draw_sample(canvas, name, colour, stroke, (left, y))?;
    }
    Ok(())
}

/// One line of a key: a sample of the look, then the name.
fn draw_sample<B: DrawingBackend>(
    canvas: &mut Canvas<B>,
    name: &str,
    colour: Colour,
    stroke: Stroke,
    (left, y): Point,
) -> Result<(), PlotError> {
    let (start, end) = (left + GAP, left + GAP + SAMPLE);
    let around = Frame { left: start, top: y - 0.3 * KEY_LINE, right: end, bottom: y + 0.3 * KEY_LINE };
    match stroke {
        Stroke::Filled => canvas.rectangle(around, colour, true)?,
        Stroke::Marks => canvas.curve(&[Some((0.5 * (start + end), y))], around, colour, stroke)?,
        _ => canvas.curve(&[Some((start, y)), Some((end, y))], around, colour, stroke)?,
    }
    canvas.text(name, (end + GAP, y), NUMBER, BLACK, Place::RightOf)
}

/// A mark on an axis.
#[derive(Debug, Clone, PartialEq)]
struct Tick {
    /// Where, 0 to 1.
    fraction: f64,
    /// Its number or name; none for a small tick.
    text: Option<String>,
}

impl Tick {
    fn length(&self) -> f64 {
        if self.text.is_some() { 8.0 } else { 4.0 }
    }
}

/// The ticks of an axis within its ends.
fn ticks(axis: &Axis) -> Vec<Tick> {
    // Room for the rounding of the ends.
    let visible = |value: f64| axis.fraction(value).filter(|f| (-1e-9..=1.0 + 1e-9).contains(f));
    let tick = |value: f64, text: Option<String>| visible(value).map(|fraction| Tick { fraction, text });
    if !axis.names.is_empty() {
        return axis.names.iter().filter_map(|(value, name)| tick(*value, Some(name.clone()))).collect();
    }
    let (low, high) = (axis.range.0.min(axis.range.1), axis.range.0.max(axis.range.1));
    if axis.logarithmic {
        let decades = axis.step.max(1.0) as i32;
        let (first, last) = (low.log10().floor() as i32, high.log10().ceil() as i32);
        return (first..=last)
            .flat_map(|power| {
                let numbered = power.rem_euclid(decades) == 0;
                let whole = tick(10_f64.powi(power), numbered.then(|| power_of_ten(power)));
                // Small ticks at 2 to 9 only where every decade has its number.
                let between = (2..10).filter(move |_| decades == 1);
                let small = between.filter_map(move |m| tick(f64::from(m) * 10_f64.powi(power), None));
                whole.into_iter().chain(small).collect::<Vec<_>>()
            })
            .collect();
    }
    // Room for the rounding of the ends here too.
    let (first, last) = ((low / axis.step - 1e-9).ceil() as i32, (high / axis.step + 1e-9).floor() as i32);
    let decimals = (-axis.step.log10()).ceil().max(0.0) as usize;
    // A step such as 0.25 needs a digit more than its size tells.
    let decimals = decimals + usize::from((axis.step * 10_f64.powi(decimals as i32)).fract() > 1e-9);
    (first..=last)
        .filter_map(|i| {
            let value = f64::from(i) * axis.step;
            tick(value, Some(format!("{value:.decimals$}").replace('-', "\u{2212}")))
        })
        .collect()
}

/// "10" with a raised exponent.
pub(crate) fn power_of_ten(exponent: i32) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        _ => c.to_digit(10).and_then(|d| char::from_u32(0x2070 + d)).unwrap_or(c),
    };
    std::iter::once("10".to_owned())
        .chain(std::iter::once(exponent.to_string().chars().map(raised).collect()))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(axis: &Axis) -> Vec<String> {
        ticks(axis).into_iter().filter_map(|tick| tick.text).collect()
    }

    #[test]
    fn ticks_have_the_digits_that_they_need() {
        assert_eq!(texts(&Axis::linear("", -0.5, 0.5, 0.25)), ["−0.50", "−0.25", "0.00", "0.25", "0.50"]);
        assert_eq!(texts(&Axis::linear("", 0.0, 120.0, 40.0)), ["0", "40", "80", "120"]);
        assert_eq!(texts(&Axis::linear("", 0.0, 2.4, 0.8)), ["0.0", "0.8", "1.6", "2.4"]);
        assert_eq!(texts(&Axis::logarithmic("", 1e-2, 2e1, 1)), ["10⁻²", "10⁻¹", "10⁰", "10¹"]);
        assert_eq!(texts(&Axis::logarithmic("", 1e16, 1e26, 4)), ["10¹⁶", "10²⁰", "10²⁴"]);
    }

    #[test]
    fn small_ticks_fill_each_decade() {
        let all = ticks(&Axis::logarithmic("", 1.0, 100.0, 1));
        assert_eq!(all.len(), 3 + 16);
        assert!(all.windows(2).all(|t| t[0].fraction < t[1].fraction));
    }

    #[test]
    fn names_stand_where_they_belong() {
        let axis = Axis::linear("", 0.0, 2.0, 1.0).named(vec![(1.0, "one".into()), (5.0, "five".into())]);
        assert_eq!(texts(&axis), ["one"]);
    }
}
