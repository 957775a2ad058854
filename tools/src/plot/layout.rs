//! Where panels, axes, ticks and keys of a figure stand.

use super::PlotError;
use super::canvas::{Canvas, Frame, Place, Point};
use super::colours::{self, BLACK, GREY, GRID, WHITE};
use super::model::{Axis, Cells, Curve, Figure, Key, Panel, Stroke};
use plotters::backend::DrawingBackend;

/// Width and height of a picture.
pub(super) const SIZE: (u32, u32) = (1600, 1000);

/// Sizes of texts.
const HEADING: f64 = 25.0;
const LABEL: f64 = 23.0;
const NUMBER: f64 = 20.0;

/// Room for the numbers and the label of an axis.
const LEFT: f64 = 116.0;
/// The widest texts of an axis that fit there, and the room that wider ones need beside their width.
const TEXTS: f64 = 62.0;
const AROUND: f64 = 64.0;
/// Room at the left of a panel whose axis there has neither label nor texts: it is its neighbour's.
const JOINED: f64 = 4.0;
const BELOW: f64 = 82.0;
const RIGHT: f64 = 34.0;
const ABOVE: f64 = 26.0;
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

/// Draws a figure.
pub(super) fn draw<B: DrawingBackend>(canvas: &mut Canvas<B>, figure: &Figure) -> Result<(), PlotError> {
    let (width, height) = (f64::from(SIZE.0), f64::from(SIZE.1));
    canvas.rectangle(Frame { left: 0.0, top: 0.0, right: width, bottom: height }, WHITE, true)?;
    let mut top = 0.0;
    if !figure.title.is_empty() {
        canvas.text(&figure.title, (0.5 * width, 30.0), HEADING, BLACK, Place::Centred)?;
        top = LINE + 8.0;
    }
    let row_height = (height - top) / figure.rows.len().max(1) as f64;
    for row in &figure.rows {
        let total: f64 = row.iter().map(|panel| panel.share).sum();
        let extra: Vec<f64> = row.iter().map(|panel| left_room(canvas, panel) - LEFT + bar_room(panel)).collect();
        let shared = width - extra.iter().sum::<f64>();
        let mut left = 0.0;
        for (panel, extra) in row.iter().zip(extra) {
            let right = left + extra + shared * panel.share / total;
            draw_panel(canvas, panel, Frame { left, top, right, bottom: top + row_height })?;
            left = right;
        }
        top += row_height;
    }
    Ok(())
}

/// Room at the left of a panel.
fn left_room<B: DrawingBackend>(canvas: &Canvas<B>, panel: &Panel) -> f64 {
    let widths = ticks(&panel.y).into_iter().filter_map(|tick| tick.text).map(|text| canvas.text_width(&text, NUMBER));
    let widest = widths.fold(0.0, f64::max);
    match widest {
        0.0 if panel.y.label.is_empty() => JOINED,
        narrow if narrow <= TEXTS => LEFT,
        wide => wide + AROUND,
    }
}

/// Room for the bar of a panel's heat map.
fn bar_room(panel: &Panel) -> f64 {
    if panel.cells.as_ref().is_some_and(|cells| cells.bar) { BAR.0 + BAR.1 + BAR.2 } else { 0.0 }
}

/// Draws a panel with its axes into the room given.
fn draw_panel<B: DrawingBackend>(canvas: &mut Canvas<B>, panel: &Panel, room: Frame) -> Result<(), PlotError> {
    let title = if panel.title.is_empty() { 0.0 } else { LINE };
    let key_width = key_width(canvas, panel);
    let beside = match (&panel.cells, panel.key) {
        (None, Key::Beside) => key_width + GAP,
        _ => bar_room(panel),
    };
    let frame = Frame {
        left: room.left + left_room(canvas, panel),
        top: room.top + ABOVE + title,
        right: room.right - RIGHT - beside,
        bottom: room.bottom - BELOW,
    };
    if title > 0.0 {
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
    for curve in &panel.curves {
        let points: Vec<Option<Point>> = curve.points.iter().map(|&(x, y)| place(x, y)).collect();
        canvas.curve(&points, frame, curve.colour, curve.stroke)?;
    }
    canvas.rectangle(frame, BLACK, false)?;
    canvas.text(&panel.x.label, (0.5 * (frame.left + frame.right), frame.bottom + 44.0), LABEL, BLACK, Place::Below)?;
    canvas.text(&panel.y.label, (room.left + 14.0, 0.5 * (frame.top + frame.bottom)), LABEL, BLACK, Place::Upwards)?;
    draw_key(canvas, panel, frame, key_width)
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
            canvas.text(&format!("{value:.0}"), middle, 0.85 * NUMBER, colours::on(colour), Place::Centred)?;
        }
    }
    if cells.bar { draw_bar(canvas, cells, frame) } else { Ok(()) }
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

/// Curves that have a name, from the top of the key.
fn named(panel: &Panel) -> impl Iterator<Item = &Curve> {
    panel.curves.iter().filter(|curve| !curve.name.is_empty())
}

fn key_width<B: DrawingBackend>(canvas: &Canvas<B>, panel: &Panel) -> f64 {
    let widest = named(panel).map(|curve| canvas.text_width(&curve.name, NUMBER)).fold(0.0, f64::max);
    widest + SAMPLE + 3.0 * GAP
}

fn draw_key<B: DrawingBackend>(
    canvas: &mut Canvas<B>,
    panel: &Panel,
    frame: Frame,
    width: f64,
) -> Result<(), PlotError> {
    let lines = named(panel).count();
    if lines == 0 || panel.key == Key::None {
        return Ok(());
    }
    let height = lines as f64 * KEY_LINE + GAP;
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
    for (i, curve) in named(panel).enumerate() {
        let y = top + 0.5 * GAP + (i as f64 + 0.5) * KEY_LINE;
        let (start, end) = ((left + GAP, y), (left + GAP + SAMPLE, y));
        let sample = match curve.stroke {
            Stroke::Marks => vec![Some((0.5 * (start.0 + end.0), y))],
            _ => vec![Some(start), Some(end)],
        };
        canvas.curve(&sample, inside, curve.colour, curve.stroke)?;
        canvas.text(&curve.name, (end.0 + GAP, y), NUMBER, BLACK, Place::RightOf)?;
    }
    Ok(())
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
