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

/// A panel for each biome: axes with labels and numbers only at the left and below.
fn grid(
    y: &Axis,
    x: &Axis,
    curves: impl Fn(Biome) -> Result<Vec<Curve>, PolarsError>,
    key: Key,
) -> Result<Vec<Vec<Panel>>, PolarsError> {
    let mut panels = Vec::new();
    for (i, biome) in Biome::ALL.into_iter().enumerate() {
        let mut y = y.clone();
        if i % ACROSS > 0 {
            y.label.clear();
        }
        let mut x = x.clone();
        if i + ACROSS < Biome::ALL.len() {
            x.label.clear();
        }
        let key = if i == 0 { key } else { Key::None };
        panels.push(Panel::new(x, y, curves(biome)?).titled(biome.name()).key(key));
    }
    Ok(panels.chunks(ACROSS).map(<[Panel]>::to_vec).collect())
}

fn functions(frame: &Frame, source: &str) -> Result<Figure, PolarsError> {
    let shown = [Stand::Thesis, Stand::Fitted(Form::Single), Stand::Fitted(Form::Double)];
    let curves = |biome: Biome| -> Result<Vec<Curve>, PolarsError> {
        let of = |what: &str| points(frame, ("angle_deg", 1.0), (&column(biome, what), 1.0));
        let mut all = vec![Curve::new("Mie", BLACK, of("mie")?)];
        for stand in shown {
            let stroke = if stand == Stand::Thesis { Stroke::Dotted } else { Stroke::Dashed };
            all.push(Curve::new(stand.words(), stand.colour(), of(stand.key())?).stroke(stroke));
        }
        Ok(all)
    };
    let x = Axis::linear("scattering angle / °", 0.0, 180.0, 30.0);
    let rows = grid(&Axis::logarithmic("P / sr⁻¹", 1e-2, 1e2, 1), &x, curves, Key::TopRight)?;
    Ok(Figure { title: format!("Phase functions of the biomes at 550 nm ({source}) and Henyey-Greenstein fits"), rows })
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
            let stroke = if stand == Stand::Thesis { Stroke::Dotted } else { Stroke::Solid };
            Ok(Curve::new(stand.words(), stand.colour(), points).stroke(stroke))
        };
        Stand::ALL.into_iter().map(one).collect()
    };
    let x = Axis::linear("wavelength / nm", 300.0, 1000.0, 100.0);
    let mut rows = grid(&Axis::linear("rms of ln(fit / Mie)", 0.0, 1.0, 0.2), &x, curves, Key::None)?;
    if let Some(last) = rows.first_mut().and_then(|row| row.last_mut()) {
        last.key = Key::Beside;
    }
    Ok(Figure {
        title: format!("Error of Henyey-Greenstein fits to the phase functions of the biomes ({source})"),
        rows,
    })
}

fn costs(frame: &Frame, source: &str) -> Result<Figure, PolarsError> {
    let shown = [Stand::Thesis, Stand::Fitted(Form::Single), Stand::Fitted(Form::Double)];
    let count = Biome::ALL.len();
    // The first biome at the top.
    let height = |i: usize| (count - i) as f64 - 0.5;
    let names: Vec<(f64, String)> =
        Biome::ALL.into_iter().enumerate().map(|(i, biome)| (height(i), biome.name().to_owned())).collect();
    let panel = |column: &str, x: Axis, first: bool| -> Result<Panel, PolarsError> {
        let values = frame.column(column)?;
        let mut curves = Vec::new();
        for (offset, stand) in [0.25, 0.0, -0.25].into_iter().zip(shown) {
            let mut ends = Vec::new();
            for (i, biome) in Biome::ALL.into_iter().enumerate() {
                for row in chosen(frame, biome, stand)? {
                    let (value, y) = (100.0 * values[row], height(i) + offset);
                    curves.push(Curve::new("", stand.colour(), vec![(0.0, y), (value, y)]));
                    ends.push((value, y));
                }
            }
            curves.push(Curve::new(stand.words(), stand.colour(), ends).stroke(Stroke::Marks));
        }
        let names =
            if first { names.clone() } else { names.iter().map(|(place, _)| (*place, String::new())).collect() };
        let key = if first { Key::BottomRight } else { Key::None };
        Ok(Panel::new(x, Axis::linear("", 0.0, count as f64, 1.0).named(names), curves).key(key))
    };
    let row = vec![
        panel("misplaced", Axis::linear("light misplaced / %", 0.0, 30.0, 5.0), true)?,
        panel("backward_error", Axis::linear("error of the backward share / %", -8.0, 8.0, 2.0), false)?,
        panel("sky_rms", Axis::linear("rms error of the sky / %", 0.0, 60.0, 10.0), false)?,
    ];
    let title = format!("What one g for all costs at 550 nm ({source}); sky: single scattering, sun at 30°");
    Ok(Figure { title, rows: vec![row] })
}
