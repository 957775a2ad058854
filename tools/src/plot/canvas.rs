//! Lines, discs, rectangles and texts on a plotters backend, in units of the finished picture.

use super::PlotError;
use super::model::{Colour, Stroke};
use super::text::{self, Label};
use ab_glyph::FontRef;
use plotters::backend::DrawingBackend;
use plotters::style::{Color, RGBColor, ShapeStyle};
use plotters_backend::text_anchor::{HPos, VPos};

/// Device units in one unit of the picture: curves are drawn this much finer than a pixel.
pub(super) const FINENESS: u32 = 3;

/// A point: to the right and down from the top left corner.
pub(super) type Point = (f64, f64);

/// A rectangle by its edges.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    pub(super) left: f64,
    pub(super) top: f64,
    pub(super) right: f64,
    pub(super) bottom: f64,
}

/// Where a text lies relative to its anchor, and which way it runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Place {
    /// The anchor is at its left, half-way up.
    RightOf,
    /// The anchor is at its right, half-way up.
    LeftOf,
    /// The anchor is above its middle.
    Below,
    /// The anchor is its middle.
    Centred,
    /// The anchor is above its middle, and it runs upwards.
    Upwards,
}

/// A backend with what figures need of it.
pub(super) struct Canvas<B> {
    backend: B,
    font: FontRef<'static>,
    /// Whether each piece of a line is drawn alone, with a disc at the joints: bitmaps join thick
    /// pieces badly where a line turns sharply.
    piecewise: bool,
}

impl<B: DrawingBackend> Canvas<B> {
    pub(super) fn new(backend: B, piecewise: bool) -> Result<Self, PlotError> {
        let font = text::font().map_err(PlotError::drawing)?;
        Ok(Self { backend, font, piecewise })
    }

    /// Ends the picture.
    pub(super) fn finish(mut self) -> Result<(), PlotError> {
        self.backend.present().map_err(PlotError::drawing)
    }

    pub(super) fn text(
        &mut self,
        text: &str,
        at: Point,
        size: f64,
        colour: Colour,
        place: Place,
    ) -> Result<(), PlotError> {
        let anchor = match place {
            Place::RightOf => (HPos::Left, VPos::Center),
            Place::LeftOf => (HPos::Right, VPos::Center),
            Place::Below | Place::Upwards => (HPos::Center, VPos::Top),
            Place::Centred => (HPos::Center, VPos::Center),
        };
        let size = size * f64::from(FINENESS);
        let label = Label::new(&self.font, size, colour, anchor, place == Place::Upwards);
        self.backend.draw_text(text, &label, device(at)).map_err(PlotError::drawing)
    }

    /// Width of a text.
    pub(super) fn text_width(&self, text: &str, size: f64) -> f64 {
        Label::new(&self.font, size, (0, 0, 0), (HPos::Left, VPos::Top), false).width(text)
    }

    pub(super) fn rectangle(&mut self, frame: Frame, colour: Colour, filled: bool) -> Result<(), PlotError> {
        let Frame { left, top, right, bottom } = frame;
        if filled {
            let (a, b) = (device((left, top)), device((right, bottom)));
            return self.backend.draw_rect(a, b, &style(colour, 1.0), true).map_err(PlotError::drawing);
        }
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
        self.solid(&corners, colour, 1.2)
    }

    /// A straight line.
    pub(super) fn line(&mut self, a: Point, b: Point, colour: Colour, width: f64) -> Result<(), PlotError> {
        self.solid(&[a, b], colour, width)
    }

    pub(super) fn disc(&mut self, at: Point, radius: f64, colour: Colour) -> Result<(), PlotError> {
        let radius = (radius * f64::from(FINENESS)).round() as u32;
        self.backend.draw_circle(device(at), radius, &style(colour, 1.0), true).map_err(PlotError::drawing)
    }

    /// A filled polygon.
    pub(super) fn polygon(&mut self, corners: &[Point], colour: Colour) -> Result<(), PlotError> {
        let corners: Vec<(i32, i32)> = corners.iter().map(|&p| device(p)).collect();
        self.backend.fill_polygon(corners, &style(colour, 1.0)).map_err(PlotError::drawing)
    }

    /// A line of the given look through points, inside the frame only.
    pub(super) fn curve(
        &mut self,
        points: &[Option<Point>],
        frame: Frame,
        colour: Colour,
        stroke: Stroke,
    ) -> Result<(), PlotError> {
        const WIDTH: f64 = 2.2;
        const DOT: f64 = 3.0;
        if stroke == Stroke::Marks {
            for &point in points.iter().flatten().filter(|p| frame.holds(**p)) {
                self.disc(point, 4.4, colour)?;
            }
            return Ok(());
        }
        for run in clipped(points, frame) {
            match stroke {
                Stroke::Solid | Stroke::Marks | Stroke::Filled => self.solid(&run, colour, WIDTH)?,
                Stroke::Dashed => {
                    for dash in pieces(&run, 11.0, 6.0) {
                        self.solid(&dash, colour, WIDTH)?;
                    }
                }
                Stroke::Dotted => {
                    for dash in pieces(&run, DOT, 2.0 * DOT) {
                        self.solid(&dash, colour, DOT)?;
                    }
                }
            }
        }
        Ok(())
    }

    fn solid(&mut self, points: &[Point], colour: Colour, width: f64) -> Result<(), PlotError> {
        let style = style(colour, width);
        let mut points: Vec<(i32, i32)> = points.iter().map(|&p| device(p)).collect();
        points.dedup();
        if !self.piecewise {
            return self.backend.draw_path(points, &style).map_err(PlotError::drawing);
        }
        for pair in points.windows(2) {
            self.backend.draw_path(pair.iter().copied(), &style).map_err(PlotError::drawing)?;
        }
        let joints = points.get(1..points.len().saturating_sub(1)).unwrap_or_default();
        for &joint in joints {
            self.backend.draw_circle(joint, style.stroke_width / 2, &style, true).map_err(PlotError::drawing)?;
        }
        Ok(())
    }
}

impl Frame {
    pub(super) fn width(self) -> f64 {
        self.right - self.left
    }

    pub(super) fn height(self) -> f64 {
        self.bottom - self.top
    }

    fn holds(self, (x, y): Point) -> bool {
        (self.left..=self.right).contains(&x) && (self.top..=self.bottom).contains(&y)
    }
}

fn device((x, y): Point) -> (i32, i32) {
    let scaled = |v: f64| (v * f64::from(FINENESS)).round() as i32;
    (scaled(x), scaled(y))
}

fn style((r, g, b): Colour, width: f64) -> ShapeStyle {
    let width = (width * f64::from(FINENESS)).round() as u32;
    RGBColor(r, g, b).stroke_width(width)
}

/// The runs of a line that lie inside the frame; a gap among the points ends a run.
fn clipped(points: &[Option<Point>], frame: Frame) -> Vec<Vec<Point>> {
    let mut runs: Vec<Vec<Point>> = Vec::new();
    for pair in points.windows(2) {
        let (Some(a), Some(b)) = (pair[0], pair[1]) else { continue };
        let Some((from, to)) = inside(a, b, frame) else { continue };
        match runs.last_mut() {
            Some(run) if run.last() == Some(&from) => run.push(to),
            _ => runs.push(vec![from, to]),
        }
    }
    runs
}

/// The part of the line from `a` to `b` that lies inside the frame: each edge narrows the range of
/// the parameter t of a + t (b - a) (Liang and Barsky, ACM Trans. Graph. 3, 1, 1984).
fn inside(a: Point, b: Point, frame: Frame) -> Option<(Point, Point)> {
    let (dx, dy) = (b.0 - a.0, b.1 - a.1);
    let edges = [(-dx, a.0 - frame.left), (dx, frame.right - a.0), (-dy, a.1 - frame.top), (dy, frame.bottom - a.1)];
    let (mut first, mut last) = (0.0_f64, 1.0_f64);
    for (out, room) in edges {
        if out == 0.0 {
            if room < 0.0 {
                return None;
            }
        } else if out < 0.0 {
            first = first.max(room / out);
        } else {
            last = last.min(room / out);
        }
    }
    // The ends themselves where they are inside, so that runs join.
    let at = |t: f64, end: Point, whole: f64| if t == whole { end } else { (a.0 + t * dx, a.1 + t * dy) };
    (first <= last).then(|| (at(first, a, 0.0), at(last, b, 1.0)))
}

/// A line cut into dashes with gaps between them.
fn pieces(line: &[Point], dash: f64, gap: f64) -> Vec<Vec<Point>> {
    let mut result: Vec<Vec<Point>> = Vec::new();
    let (mut drawing, mut left) = (true, dash);
    let mut current: Vec<Point> = line.first().copied().into_iter().collect();
    for pair in line.windows(2) {
        let (mut from, to) = (pair[0], pair[1]);
        loop {
            let length = (to.0 - from.0).hypot(to.1 - from.1);
            if length <= left {
                left -= length;
                if drawing {
                    current.push(to);
                }
                break;
            }
            let t = left / length;
            from = (from.0 + t * (to.0 - from.0), from.1 + t * (to.1 - from.1));
            if drawing {
                current.push(from);
                result.push(std::mem::take(&mut current));
            } else {
                current = vec![from];
            }
            drawing = !drawing;
            left = if drawing { dash } else { gap };
        }
    }
    if drawing && current.len() > 1 {
        result.push(current);
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Frame = Frame { left: 0.0, top: 0.0, right: 10.0, bottom: 10.0 };

    #[test]
    fn lines_end_at_the_frame_and_gaps_break_them() {
        let line = [Some((-5.0, 5.0)), Some((5.0, 5.0)), Some((5.0, 15.0)), None, Some((1.0, 1.0)), Some((2.0, 2.0))];
        let runs = clipped(&line, FRAME);
        assert_eq!(runs, [vec![(0.0, 5.0), (5.0, 5.0), (5.0, 10.0)], vec![(1.0, 1.0), (2.0, 2.0)]]);
        assert_eq!(inside((-1.0, 0.0), (-1.0, 9.0), FRAME), None);
        assert_eq!(inside((20.0, 0.0), (0.0, 20.0), FRAME), Some(((10.0, 10.0), (10.0, 10.0))));
    }

    #[test]
    fn dashes_and_gaps_share_the_length_around_corners() {
        let dashes = pieces(&[(0.0, 0.0), (3.0, 0.0), (3.0, 4.0)], 2.0, 2.0);
        assert_eq!(dashes, [vec![(0.0, 0.0), (2.0, 0.0)], vec![(3.0, 1.0), (3.0, 3.0)]]);
        assert!(pieces(&[], 1.0, 1.0).is_empty());
    }
}
