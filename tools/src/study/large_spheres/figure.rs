//! Figures of large spheres: the whole phase function, and below it where its rings are.

use super::{BROAD, CLOUD, DROPS, NARROW, WAVELENGTHS_NM, column};
use crate::frame::Frame;
use crate::plot::colours::{BLACK, BLUE, GREEN, VERMILION};
use crate::plot::model::{Axis, Colour, Curve, Figure, Key, Panel, Stroke};
use crate::study::Part;
use crate::study::figures::points;
use polars::prelude::PolarsError;

/// Colours of the wavelengths, near what they look like.
const COLOURS: [Colour; 3] = [BLUE, GREEN, VERMILION];

/// The figure of a part.
pub(in crate::study) fn figure(part: &Part) -> Result<Figure, PolarsError> {
    if part.name == CLOUD { cloud(&part.frame) } else { drops(&part.frame) }
}

/// Phase functions of a kind of drops, named by their wavelengths and `more`.
fn curves(frame: &Frame, kind: &str, more: &str, stroke: Stroke) -> Result<Vec<Curve>, PolarsError> {
    let one = |(nm, colour): (u32, Colour)| -> Result<Curve, PolarsError> {
        let points = points(frame, ("angle_deg", 1.0), (&column(kind, nm), 1.0))?;
        Ok(Curve::new(format!("{nm} nm{more}"), colour, points).stroke(stroke))
    };
    WAVELENGTHS_NM.into_iter().zip(COLOURS).map(one).collect()
}

/// Labels of axes.
const ANGLE: &str = "scattering angle / °";
const PHASE: &str = "phase function / sr⁻¹";

/// The whole phase function.
fn whole(curves: Vec<Curve>) -> Panel {
    Panel::new(Axis::linear(ANGLE, 0.0, 180.0, 20.0), Axis::logarithmic(PHASE, 5e-4, 1e3, 1), curves)
}

/// A vertical line.
fn line(name: &str, colour: Colour, at: f64, (low, high): (f64, f64), stroke: Stroke) -> Curve {
    Curve::new(name, colour, vec![(at, low), (at, high)]).stroke(stroke)
}

fn cloud(frame: &Frame) -> Result<Figure, PolarsError> {
    let both = || -> Result<Vec<Curve>, PolarsError> {
        let mut all = curves(frame, BROAD, ", variance 0.1", Stroke::Dotted)?;
        all.extend(curves(frame, NARROW, ", variance 0.01", Stroke::Solid)?);
        Ok(all)
    };
    let panel = |title: &str, (from, to, step): (f64, f64, f64), y: Axis| -> Result<Panel, PolarsError> {
        let x = Axis::linear(ANGLE, from, to, step);
        Ok(Panel::new(x, y, both()?).titled(title).key(Key::None))
    };
    let above = whole(both()?);
    let below = vec![
        panel("corona", (0.0, 8.0, 2.0), Axis::logarithmic(PHASE, 1e-1, 1e3, 1))?,
        panel("cloudbow", (130.0, 155.0, 5.0), Axis::linear("", 0.0, 0.04, 0.01))?,
        panel("glory", (174.0, 180.0, 1.0), Axis::linear("", 0.0, 0.06, 0.01))?,
    ];
    let title = "A cloud of water: gamma distribution of effective radius 10 µm";
    Ok(Figure::new(title, vec![vec![above], below]))
}

fn drops(frame: &Frame) -> Result<Figure, PolarsError> {
    let (nm, reflections) = (frame.column("wavelength_nm")?, frame.column("internal_reflections")?);
    let (descartes, airy) = (frame.column("descartes_deg")?, frame.column("airy_deg")?);
    let maximum = frame.column("maximum")?;
    let panel = |title: &str, of: f64, (from, to): (f64, f64), y: Axis| -> Result<Panel, PolarsError> {
        let mut all = curves(frame, DROPS, "", Stroke::Solid)?;
        for curve in &mut all {
            curve.name.clear();
        }
        let ends = y.range;
        for (wavelength, colour) in WAVELENGTHS_NM.into_iter().zip(COLOURS) {
            for i in (0..nm.len()).filter(|&i| nm[i] == f64::from(wavelength) && reflections[i] == of) {
                if maximum[i] == 0.0 {
                    all.push(line("", colour, descartes[i], ends, Stroke::Dashed));
                }
                all.push(line("", colour, airy[i], ends, Stroke::Dotted));
            }
        }
        // The key explains strokes, whatever their colour.
        for (name, stroke) in [("Descartes", Stroke::Dashed), ("Airy: bow, first supernumerary", Stroke::Dotted)] {
            all.push(Curve { points: Vec::new(), ..line(name, BLACK, 0.0, ends, stroke) });
        }
        Ok(Panel::new(Axis::linear(ANGLE, from, to, 1.0), y, all).titled(title))
    };
    let above = whole(curves(frame, DROPS, "", Stroke::Solid)?);
    let below = vec![
        panel("secondary bow", 2.0, (123.0, 131.0), Axis::linear(PHASE, 0.0, 0.016, 0.004))?.key(Key::TopLeft),
        panel("primary bow", 1.0, (136.0, 142.0), Axis::linear("", 0.0, 0.14, 0.02))?,
    ];
    let title = "Drops of water of 0.5 mm (diameter), standard deviation 1 %";
    Ok(Figure::new(title, vec![vec![above], below]))
}
