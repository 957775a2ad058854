//! A figure before it is drawn: panels, axes, curves, cells and keys.

/// Colour as red, green and blue, 0 to 255, in sRGB.
pub type Colour = (u8, u8, u8);

/// Rows of panels, from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Heading above all panels; empty for none.
    pub title: String,
    /// Names below the heading, side by side, for curves that panels have in common. Only names and looks count.
    pub key: Vec<Curve>,
    /// Rows whose panels are equally high and stand side by side.
    pub rows: Vec<Vec<Panel>>,
}

impl Figure {
    /// A figure without a key of its own.
    #[must_use]
    pub fn new(title: impl Into<String>, rows: Vec<Vec<Panel>>) -> Self {
        Self { title: title.into(), key: Vec::new(), rows }
    }

    /// The same figure with a key for all panels.
    #[must_use]
    pub fn key(self, key: Vec<Curve>) -> Self {
        Self { key, ..self }
    }
}

/// Two axes and what is drawn between them.
#[derive(Debug, Clone, PartialEq)]
pub struct Panel {
    /// Text above the panel; empty for none.
    pub title: String,
    /// The axis below.
    pub x: Axis,
    /// The axis at the left.
    pub y: Axis,
    /// Width between the axes relative to the other panels of the row.
    pub share: f64,
    /// Cells of a heat map, drawn first.
    pub cells: Option<Cells>,
    /// Areas, drawn next, the first at the bottom.
    pub areas: Vec<Area>,
    /// Curves, the first at the bottom.
    pub curves: Vec<Curve>,
    /// Names beside points, drawn last, the first with the best place.
    pub labels: Vec<Label>,
    /// Where the names of the curves stand.
    pub key: Key,
}

impl Panel {
    /// A panel of full width with a key inside at the top right.
    #[must_use]
    pub fn new(x: Axis, y: Axis, curves: Vec<Curve>) -> Self {
        let (title, cells, areas) = (String::new(), None, Vec::new());
        Self { title, x, y, share: 1.0, cells, areas, curves, labels: Vec::new(), key: Key::TopRight }
    }

    /// The same panel with a text above it.
    #[must_use]
    pub fn titled(self, title: impl Into<String>) -> Self {
        Self { title: title.into(), ..self }
    }

    /// The same panel with another width relative to its neighbours.
    #[must_use]
    pub fn share(self, share: f64) -> Self {
        Self { share, ..self }
    }

    /// The same panel with areas below its curves.
    #[must_use]
    pub fn areas(self, areas: Vec<Area>) -> Self {
        Self { areas, ..self }
    }

    /// The same panel with names beside points.
    #[must_use]
    pub fn labels(self, labels: Vec<Label>) -> Self {
        Self { labels, ..self }
    }

    /// The same panel with its key elsewhere.
    #[must_use]
    pub fn key(self, key: Key) -> Self {
        Self { key, ..self }
    }
}

/// The name of a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Label {
    /// (x, y) of the point in the units of the axes.
    pub at: (f64, f64),
    /// The name.
    pub text: String,
    /// Colour.
    pub colour: Colour,
}

/// Where the names of the curves stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Key {
    /// Nowhere.
    None,
    /// Inside, at the top left.
    TopLeft,
    /// Inside, at the top right.
    TopRight,
    /// Inside, at the bottom left.
    BottomLeft,
    /// Inside, at the bottom right.
    BottomRight,
    /// Outside, to the right.
    Beside,
}

/// One axis of a panel.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Quantity and unit; a space for none, nothing for none and no room.
    pub label: String,
    /// What the lower and upper end stand for; both positive on a logarithmic axis.
    pub range: (f64, f64),
    /// Whether equal lengths are equal factors.
    pub logarithmic: bool,
    /// Distance between numbered ticks: a difference, or decades on a logarithmic axis.
    pub step: f64,
    /// Texts at chosen places instead of numbers.
    pub names: Vec<(f64, String)>,
}

impl Axis {
    /// An axis with a numbered tick at every multiple of `step`.
    #[must_use]
    pub fn linear(label: &str, low: f64, high: f64, step: f64) -> Self {
        Self { label: label.into(), range: (low, high), logarithmic: false, step, names: Vec::new() }
    }

    /// A logarithmic axis with a number at every `decades` powers of ten.
    #[must_use]
    pub fn logarithmic(label: &str, low: f64, high: f64, decades: u32) -> Self {
        Self { logarithmic: true, step: f64::from(decades), ..Self::linear(label, low, high, 1.0) }
    }

    /// The same axis with texts instead of numbers.
    #[must_use]
    pub fn named(self, names: Vec<(f64, String)>) -> Self {
        Self { names, ..self }
    }

    /// Where a value lies between the ends, 0 to 1 inside; `None` for one that has no place there.
    #[must_use]
    pub fn fraction(&self, value: f64) -> Option<f64> {
        let (low, high) = self.range;
        let fraction =
            if self.logarithmic { (value / low).ln() / (high / low).ln() } else { (value - low) / (high - low) };
        fraction.is_finite().then_some(fraction)
    }
}

/// How a curve is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// An unbroken line.
    Solid,
    /// Dashes.
    Dashed,
    /// Dots.
    Dotted,
    /// A disc at each point and no line.
    Marks,
    /// In keys alone: a filled area.
    Filled,
}

/// Points with the look that they share.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Name in the key; empty for none.
    pub name: String,
    /// Colour.
    pub colour: Colour,
    /// Look.
    pub stroke: Stroke,
    /// (x, y) in the units of the axes. A point that has no place on them breaks the line.
    pub points: Vec<(f64, f64)>,
}

impl Curve {
    /// An unbroken line.
    #[must_use]
    pub fn new(name: impl Into<String>, colour: Colour, points: Vec<(f64, f64)>) -> Self {
        Self { name: name.into(), colour, stroke: Stroke::Solid, points }
    }

    /// The same curve with another look.
    #[must_use]
    pub fn stroke(self, stroke: Stroke) -> Self {
        Self { stroke, ..self }
    }
}

/// What lies between two curves over the same abscissae, filled.
#[derive(Debug, Clone, PartialEq)]
pub struct Area {
    /// Name in the key; empty for none.
    pub name: String,
    /// Colour.
    pub colour: Colour,
    /// (x, lower y, upper y) in the units of the axes, cut off at the ends of the ordinate. Points that have no place
    /// are left out.
    pub points: Vec<(f64, f64, f64)>,
}

/// Areas that lie on each other, the first on the abscissa: each as high as its values at `x`.
#[must_use]
pub fn stacked(x: &[f64], layers: impl IntoIterator<Item = (String, Colour, Vec<f64>)>) -> Vec<Area> {
    let mut floor = vec![0.0; x.len()];
    let mut areas = Vec::new();
    for (name, colour, values) in layers {
        let mut points = Vec::new();
        for ((&x, low), value) in x.iter().zip(&mut floor).zip(values) {
            points.push((x, *low, *low + value));
            *low += value;
        }
        areas.push(Area { name, colour, points });
    }
    areas
}

/// Cells of a heat map.
#[derive(Debug, Clone, PartialEq)]
pub struct Cells {
    /// What the colours show: quantity, unit, range and ticks. Values beyond its ends have the colour of the end.
    pub scale: Axis,
    /// Rectangles (left, bottom, right, top) in the units of the axes, with their values, from the
    /// bottom left upwards. NaN leaves a cell empty.
    pub values: Vec<((f64, f64, f64, f64), f64)>,
    /// Whether each cell bears its value.
    pub numbered: bool,
    /// Whether a bar of the colours stands beside the panel.
    pub bar: bool,
    /// What an infinite value means, under the bar; the cell is grey.
    pub infinite: Option<String>,
}

impl Cells {
    /// Cells that bear their values, with a bar of their colours beside them.
    #[must_use]
    pub fn new(scale: Axis, values: Vec<((f64, f64, f64, f64), f64)>) -> Self {
        Self { scale, values, numbered: true, bar: true, infinite: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_lie_on_each_other() {
        let layer = |name: &str, values: [f64; 2]| (name.to_owned(), (0, 0, 0), values.to_vec());
        let areas = stacked(&[0.0, 1.0], [layer("a", [1.0, 2.0]), layer("b", [0.5, 0.0])]);
        assert_eq!(areas[0].points, [(0.0, 0.0, 1.0), (1.0, 0.0, 2.0)]);
        assert_eq!(areas[1].points, [(0.0, 1.0, 1.5), (1.0, 2.0, 2.0)]);
    }

    #[test]
    fn places_on_axes() {
        assert_eq!(Axis::linear("z", 10.0, 20.0, 5.0).fraction(15.0), Some(0.5));
        let log = Axis::logarithmic("N", 1.0, 1e4, 1);
        assert!((log.fraction(1e3).expect("inside") - 0.75).abs() < 1e-15);
        assert_eq!(log.fraction(0.0), None);
        assert_eq!(log.fraction(f64::NAN), None);
    }
}
