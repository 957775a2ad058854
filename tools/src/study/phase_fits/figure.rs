//! Figures of fitted phase functions.

use super::{COSTS, FUNCTIONS, Stand, column};
use crate::aerosol::fit::Form;
use crate::frame::Frame;
use crate::plot::colours::{BLACK, BLUE, GREEN, ORANGE, PURPLE, VERMILION};
use crate::plot::model::{Axis, Colour, Curve, Figure, Key, Panel, Stroke};
use crate::study::Part;
use crate::study::figures::points;
use polars::prelude::PolarsError;
use tables::views::Biome;

/// What is compared where there is no room for all.
const SHOWN: [Stand; 3] = [Stand::Thesis, Stand::Fitted(Form::Single), Stand::Fitted(Form::Double)];

/// Panels of a row.
const ACROSS: usize = 3;

impl Stand {
    /// Its name in keys.
    fn words(self) -> &'static str {
        match self {
            Self::Thesis => "thesis: g = 0.76",
            Self::Fitted(Form::Single) => "HG, g of Mie",
            Self::Fitted(Form::FittedSingle) => "HG, g fitted",
            Self::Fitted(Form::Moments) => "two HG, moments",
            Self::Fitted(Form::Double) => "two HG, g of Mie",
            Self::Fitted(Form::FreeDouble) => "two HG, free",
        }
    }

    fn colour(self) -> Colour {
        match self {
            Self::Thesis => VERMILION,
            Self::Fitted(Form::Single) => BLUE,
            Self::Fitted(Form::FittedSingle) => PURPLE,
            Self::Fitted(Form::Moments) => ORANGE,
            Self::Fitted(Form::Double) => GREEN,
            Self::Fitted(Form::FreeDouble) => BLACK,
        }
    }
}

/// The figure of a part.
pub(in crate::study) fn figure(part: &Part) -> Result<Figure, PolarsError> {
    let source = if part.name.starts_with("opac") { "OPAC" } else { "Jaenicke" };
    if FUNCTIONS.contains(&part.name) {
        functions(&part.frame, source)
    } else if COSTS.contains(&part.name) {
        costs(&part.frame, source)
    } else {
        errors(&part.frame, source)
    }
}

/// A panel for each biome: labels of axes only at the left and below. The key is shared out, two names to a panel from
/// that of the index `key_from` on.
fn grid(
    y: &Axis,
    x: &Axis,
    curves: impl Fn(Biome) -> Result<Vec<Curve>, PolarsError>,
    key_from: usize,
) -> Result<Vec<Vec<Panel>>, PolarsError> {
    let mut panels = Vec::new();
    for (i, biome) in Biome::ALL.into_iter().enumerate() {
        let (mut x, mut y, mut curves) = (x.clone(), y.clone(), curves(biome)?);
        if i % ACROSS > 0 {
            y.label.clear();
        }
        if i + ACROSS < Biome::ALL.len() {
            x.label.clear();
        }
        for (j, curve) in curves.iter_mut().enumerate() {
            if i < key_from || j / 2 != i - key_from {
                curve.name.clear();
            }
        }
        panels.push(Panel::new(x, y, curves).titled(biome.name()));
    }
    Ok(panels.chunks(ACROSS).map(<[Panel]>::to_vec).collect())
}

fn functions(frame: &Frame, source: &str) -> Result<Figure, PolarsError> {
    let curves = |biome: Biome| -> Result<Vec<Curve>, PolarsError> {
        let of = |what: &str| points(frame, ("angle_deg", 1.0), (&column(biome, what), 1.0));
        let mut all = vec![Curve::new("Mie", BLACK, of("mie")?)];
        for stand in SHOWN {
            let stroke = if stand == Stand::Thesis { Stroke::Dotted } else { Stroke::Dashed };
            all.push(Curve::new(stand.words(), stand.colour(), of(stand.key())?).stroke(stroke));
        }
        Ok(all)
    };
    let x = Axis::linear("scattering angle / °", 0.0, 180.0, 30.0);
    let rows = grid(&Axis::logarithmic("P / sr⁻¹", 3e-3, 1e2, 1), &x, curves, 0)?;
    Ok(Figure::new(format!("Phase functions of the biomes at 550 nm ({source}) and Henyey-Greenstein fits"), rows))
}

/// The rows of a frame with this biome and form.
fn chosen(frame: &Frame, biome: Biome, stand: Stand) -> Result<Vec<usize>, PolarsError> {
    let (biomes, forms) = (frame.texts("biome")?, frame.texts("form")?);
    Ok((0..biomes.len()).filter(|&i| biomes[i] == biome.name() && forms[i] == stand.key()).collect())
}

fn errors(frame: &Frame, source: &str) -> Result<Figure, PolarsError> {
    let (nm, values) = (frame.column("wavelength_nm")?, frame.column("logarithmic_rms")?);
    let curves = |biome: Biome| -> Result<Vec<Curve>, PolarsError> {
        let one = |stand: Stand| -> Result<Curve, PolarsError> {
            let points = chosen(frame, biome, stand)?.into_iter().map(|i| (nm[i], values[i])).collect();
            // Dashes let a curve be seen on which another nearly lies.
            let stroke = match stand {
                Stand::Thesis => Stroke::Dotted,
                Stand::Fitted(Form::FittedSingle | Form::FreeDouble) => Stroke::Dashed,
                Stand::Fitted(_) => Stroke::Solid,
            };
            Ok(Curve::new(stand.words(), stand.colour(), points).stroke(stroke))
        };
        Stand::ALL.into_iter().map(one).collect()
    };
    let x = Axis::linear("wavelength / nm", 300.0, 1000.0, 200.0);
    // Room for the key in the second row, whose errors are small.
    let top = above(&values, 0.2).max(1.0);
    let step = if top > 1.0 { 0.4 } else { 0.2 };
    let rows = grid(&Axis::linear("rms of ln(fit / Mie)", 0.0, top, step), &x, curves, ACROSS)?;
    Ok(Figure::new(format!("Error of Henyey-Greenstein fits to the phase functions of the biomes ({source})"), rows))
}

/// The next multiple of a step above all values.
fn above(values: &[f64], step: f64) -> f64 {
    (values.iter().copied().filter(|value| value.is_finite()).fold(0.0, f64::max) / step).ceil() * step
}

fn costs(frame: &Frame, source: &str) -> Result<Figure, PolarsError> {
    let count = Biome::ALL.len();
    // The first biome at the top.
    let height = |i: usize| (count - i) as f64 - 0.5;
    let names: Vec<(f64, String)> =
        Biome::ALL.into_iter().enumerate().map(|(i, biome)| (height(i), biome.name().to_owned())).collect();
    let panel = |column: &str, label: &str, (step, signed): (f64, bool)| -> Result<Panel, PolarsError> {
        let percent: Vec<f64> = frame.column(column)?.into_iter().map(|value| 100.0 * value).collect();
        let (mut curves, mut largest) = (Vec::new(), Vec::new());
        for (offset, stand) in [0.25, 0.0, -0.25].into_iter().zip(SHOWN) {
            let mut ends = Vec::new();
            for (i, biome) in Biome::ALL.into_iter().enumerate() {
                for row in chosen(frame, biome, stand)? {
                    let (value, y) = (percent[row], height(i) + offset);
                    curves.push(Curve::new("", stand.colour(), vec![(0.0, y), (value, y)]));
                    ends.push((value, y));
                    largest.push(value.abs());
                }
            }
            curves.push(Curve::new(stand.words(), stand.colour(), ends).stroke(Stroke::Marks));
        }
        let end = above(&largest, step);
        let x = Axis::linear(label, if signed { -end } else { 0.0 }, end, step);
        // Room for the key below.
        let y = Axis::linear("", -1.7, count as f64, 1.0);
        let first = column == "misplaced";
        let names = names.iter().map(|(at, name)| (*at, if first { name.clone() } else { String::new() })).collect();
        let key = if first { Key::BottomRight } else { Key::None };
        Ok(Panel::new(x, y.named(names), curves).key(key))
    };
    let wide = if source == "OPAC" { 5.0 } else { 20.0 };
    let row = vec![
        panel("misplaced", "light misplaced / %", (wide, false))?,
        panel("backward_error", "error of the backward share / %", (2.0, true))?,
        panel("sky_rms", "rms error of the sky / %", (wide, false))?,
    ];
    let title = format!("What one g for all costs at 550 nm ({source}); sky: single scattering, sun at 30°");
    Ok(Figure::new(title, vec![row]))
}
