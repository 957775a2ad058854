//! Figures of the studies, from their numbers.

use super::size_quadrature::{self, Quadrature};
use super::{Name, Part, aerosol_tables, large_spheres, mie_stability, phase_fits};
use crate::frame::Frame;
use crate::plot::colours::{BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION};
use crate::plot::model::{Axis, Colour, Curve, Figure, Key, Panel, Stroke};
use polars::prelude::PolarsError;
use tables::units::KM;
use tables::views::{Biome, REFERENCE_WAVELENGTH_NM};

/// The figure of a part of a study, from what [`super::make`] gave.
///
/// # Errors
/// [`PolarsError`] if the numbers are of another study.
pub fn figure(name: Name, part: &Part) -> Result<Figure, PolarsError> {
    match name {
        Name::Rayleigh => rayleigh(&part.frame),
        Name::Interpolation => interpolation(&part.frame),
        Name::Thesis => thesis(&part.frame),
        Name::MieStability => mie_stability::figure(part),
        Name::MieSpeed => mie_speed(part),
        Name::LargeSpheres => large_spheres::figure(part),
        Name::PhaseFits => phase_fits::figure(part),
        Name::SizeQuadrature => size_quadrature(part),
        Name::AerosolTables => aerosol_tables(part),
    }
}

/// Points of two columns, each in units of the factor given.
pub(super) fn points(
    frame: &Frame,
    (x, x_unit): (&str, f64),
    (y, y_unit): (&str, f64),
) -> Result<Vec<(f64, f64)>, PolarsError> {
    let (x, y) = (frame.column(x)?, frame.column(y)?);
    Ok(x.into_iter().zip(y).map(|(x, y)| (x / x_unit, y / y_unit)).collect())
}

/// The points of a function that holds its value from one ordinate to the next, corners included.
fn steps(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let corners = points.windows(2).flat_map(|pair| [pair[0], (pair[0].0, pair[1].1)]);
    corners.chain(points.last().copied()).collect()
}

fn rayleigh(frame: &Frame) -> Result<Figure, PolarsError> {
    let nm = ("wavelength_nm", 1.0);
    let axis = || Axis::linear("wavelength / nm", 200.0, 1000.0, 100.0);
    // Table 2 does not have every wavelength, and gaps would break its line.
    let printed = |column: (&str, f64)| -> Result<Vec<(f64, f64)>, PolarsError> {
        Ok(points(frame, nm, column)?.into_iter().filter(|(_, y)| y.is_finite()).collect())
    };
    let values = Panel::new(
        axis(),
        Axis::logarithmic("cross-section / m²", 1e-32, 1e-28, 1),
        vec![
            Curve::new("formula", BLUE, points(frame, nm, ("formula_m2", 1.0))?),
            Curve::new("table 2", BLACK, printed(("table_2_m2", 1.0))?).stroke(Stroke::Marks),
        ],
    );
    let percent = 0.01;
    let differences = Panel::new(
        axis(),
        Axis::linear("difference from the formula / %", -0.5, 0.5, 0.1),
        vec![
            Curve::new("fit (table 3)", VERMILION, points(frame, nm, ("fit_relative", percent))?),
            Curve::new("King factor of Bates", GREEN, points(frame, nm, ("bates_relative", percent))?)
                .stroke(Stroke::Dashed),
            Curve::new("table 2", BLACK, printed(("table_2_relative", percent))?).stroke(Stroke::Marks),
        ],
    );
    let title = "Rayleigh scattering by a molecule of air: Bucholtz' formula, table and fit";
    Ok(Figure::new(title, vec![vec![values, differences.share(1.2)]]))
}

fn interpolation(frame: &Frame) -> Result<Figure, PolarsError> {
    let error = || Axis::logarithmic("relative error", 1e-9, 1e-1, 2);
    let altitude = |top: f64| Axis::linear("altitude / km", 0.0, top, 20.0);
    let up = |name: &str, column: &str, abscissa: &str, colour| -> Result<Curve, PolarsError> {
        Ok(Curve::new(name, colour, points(frame, (column, 1.0), (abscissa, KM))?))
    };
    let air = Panel::new(
        error(),
        altitude(120.0),
        vec![
            up("number density", "number_density_relative", "altitude_m", BLUE)?,
            up("pressure", "pressure_relative", "altitude_m", VERMILION)?,
            up("temperature", "temperature_relative", "altitude_m", GREEN)?,
        ],
    )
    .titled("air");
    let ozone = Panel::new(error(), altitude(120.0), vec![up("", "ozone_relative", "ozone_altitude_m", BLUE)?])
        .titled("ozone, June, 45° N")
        .key(Key::None);
    let spectrum = points(frame, ("wavelength_nm", 1.0), ("rayleigh_relative", 1.0))?;
    let rayleigh = Panel::new(
        Axis::linear("wavelength / nm", 300.0, 1000.0, 200.0),
        error(),
        vec![Curve::new("", BLUE, spectrum)],
    )
    .titled("Rayleigh cross-section")
    .key(Key::None);
    let title = "Error of interpolation half-way between the nodes of the tables";
    Ok(Figure::new(title, vec![vec![air.share(1.2), ozone, rayleigh]]))
}

fn thesis(frame: &Frame) -> Result<Figure, PolarsError> {
    let height = ("altitude_m", KM);
    let density = |name: &str, column: &str, colour| -> Result<Curve, PolarsError> {
        Ok(Curve::new(name, colour, points(frame, (column, 1e18), height)?))
    };
    let layers = |name: &str, column: &str, colour| -> Result<Curve, PolarsError> {
        let curve = density(name, column, colour)?;
        Ok(Curve { points: steps(&curve.points), ..curve })
    };
    let profiles = Panel::new(
        Axis::logarithmic("ozone, April / 10¹⁸ m⁻³", 1e-2, 1e3, 1),
        Axis::linear("altitude / km", 0.0, 100.0, 20.0),
        vec![
            density("climatology, 45° N", "ozone_climatology_m3", BLUE)?,
            layers("Arosa, six layers", "ozone_layers_m3", ORANGE)?,
            layers("thesis", "ozone_thesis_m3", GREY)?.stroke(Stroke::Dotted),
        ],
    );
    let nm = ("wavelength_nm", 1.0);
    let sections = Panel::new(
        Axis::linear("wavelength / nm", 300.0, 1000.0, 100.0),
        Axis::logarithmic("ozone cross-section / m²", 1e-28, 1e-22, 1),
        vec![
            Curve::new("measured, 293 K", VERMILION, points(frame, nm, ("ozone_measured_293k_m2", 1.0))?),
            Curve::new("thesis", GREY, points(frame, nm, ("ozone_thesis_m2", 1.0))?).stroke(Stroke::Dotted),
        ],
    );
    let air = Panel::new(
        Axis::linear("error of air density / %", -20.0, 0.0, 5.0),
        Axis::linear("altitude / km", 0.0, 90.0, 10.0),
        vec![
            Curve::new("", GREY, points(frame, ("air_density_thesis_relative", 0.01), height)?).stroke(Stroke::Dotted),
        ],
    )
    .key(Key::None);
    let title = "What the thesis' code had, beside what the tables are made from";
    let upper = vec![profiles, sections.share(1.2), air.share(0.9)];
    Ok(Figure::new(title, vec![upper, vec![extinctions(frame)?]]))
}

/// Extinction at the ground of each biome at 550 nm.
fn extinctions(frame: &Frame) -> Result<Panel, PolarsError> {
    let nm = frame.column("aerosol_wavelength_nm")?;
    let mut curves = Vec::new();
    for (name, source, colour) in
        [("OPAC", "opac", BLUE), ("Jaenicke", "jaenicke", ORANGE), ("thesis' code", "thesis", BLACK)]
    {
        let mut points = Vec::new();
        for (i, biome) in (1..).zip(Biome::ALL) {
            let values = frame.column(&format!("{biome}_{source}_per_m"))?;
            let green = nm.iter().zip(values).find(|(w, _)| **w == REFERENCE_WAVELENGTH_NM);
            points.extend(green.map(|(_, value)| (value * KM, f64::from(-i))));
        }
        curves.push(Curve::new(name, colour, points).stroke(Stroke::Marks));
    }
    let names = (1..).zip(Biome::ALL).map(|(i, biome)| (f64::from(-i), biome.name().to_owned())).collect();
    Ok(Panel::new(
        Axis::logarithmic("extinction at the ground, 550 nm / km⁻¹", 1e-3, 1e4, 1),
        Axis::linear("", -9.5, -0.5, 1.0).named(names),
        curves,
    )
    .key(Key::Beside))
}

/// Speed against error: each peer with a mark of its own, the variants alike, and the front.
fn mie_speed(part: &Part) -> Result<Figure, PolarsError> {
    const COLOURS: [Colour; 7] = [BLUE, SKY, BLACK, VERMILION, ORANGE, PURPLE, GREEN];
    let solvers = part.frame.texts("solver")?;
    let found = points(&part.frame, ("spheres_per_second", 1.0), ("largest_relative_error", 1.0))?;
    let front = part.frame.column("on_pareto_front")?;
    let mut line: Vec<(f64, f64)> = found.iter().zip(&front).filter(|(_, on)| **on > 0.0).map(|(p, _)| *p).collect();
    line.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut curves = vec![Curve::new("Pareto front", GREY, line).stroke(Stroke::Dashed)];
    let (variants, peers): (Vec<_>, Vec<_>) =
        solvers.iter().zip(found).partition(|(solver, _)| solver.starts_with("variant"));
    if !variants.is_empty() {
        let points = variants.into_iter().map(|(_, point)| point).collect();
        curves.push(Curve::new("classical variants", GREY, points).stroke(Stroke::Marks));
    }
    for ((solver, point), colour) in peers.into_iter().zip(COLOURS.into_iter().cycle()) {
        curves.push(Curve::new(solver, colour, vec![point]).stroke(Stroke::Marks));
    }
    let panel = Panel::new(
        Axis::logarithmic("spheres per second on one core", 1e2, 1e7, 1),
        Axis::logarithmic("largest relative error", 1e-15, 10.0, 2),
        curves,
    );
    let what = match part.name {
        "spheres" => "Mie solvers: 1000 spheres, x from 0.01 to 1000, m = 1.5 + 0.01i",
        _ => "Mie solvers: two size distributions, 61 wavelengths, 181 angles",
    };
    Ok(Figure::new(what, vec![vec![panel.key(Key::Beside)]]))
}

fn size_quadrature(part: &Part) -> Result<Figure, PolarsError> {
    let (title, lowest) = if part.name == size_quadrature::PARTS[0] {
        ("Extinction, scattering and g of particles averaged over sizes, 300 nm: largest error", 1e-12)
    } else {
        ("Phase functions of particles averaged over sizes, 300 nm: largest relative error at an angle", 1e-10)
    };
    let panel = |(i, (key, _, _, words)): (usize, &(&str, &str, f64, &str))| -> Result<Panel, PolarsError> {
        let mut curves = Vec::new();
        let looks = [
            ("uniform, nested", GREY),
            ("periodic, nested", BLUE),
            ("gathered, nested", VERMILION),
            ("Clenshaw-Curtis", GREEN),
            ("Gauss-Legendre", BLACK),
        ];
        for (rule, (name, colour)) in Quadrature::ALL.into_iter().zip(looks) {
            let found = points(&part.frame, ("radii", 1.0), (&size_quadrature::column(key, rule), 1.0))?;
            // Rounding: the last digits of a sum that is exact.
            let shown = found.into_iter().map(|(n, error)| (n, error.max(lowest))).collect();
            curves.push(Curve::new(name, colour, shown));
        }
        let axes = (
            Axis::logarithmic("radii", 10.0, 10_000.0, 1),
            Axis::logarithmic(if i % 3 == 0 { "error" } else { "" }, lowest, 1.0, 2),
        );
        Ok(Panel::new(axes.0, axes.1, curves).titled(*words).key(if i + 1 == size_quadrature::PARTICLES.len() {
            Key::BottomLeft
        } else {
            Key::None
        }))
    };
    let panels = size_quadrature::PARTICLES.iter().enumerate().map(panel).collect::<Result<Vec<_>, _>>()?;
    Ok(Figure::new(title, panels.chunks(3).map(<[_]>::to_vec).collect()))
}

fn aerosol_tables(part: &Part) -> Result<Figure, PolarsError> {
    const COLOURS: [Colour; 3] = [GREY, BLUE, GREEN];
    let frame = &part.frame;
    let error = |least: f64| Axis::logarithmic("error of radiance", least, 1e-1, 1);
    if part.name == aerosol_tables::PARTS[2] {
        let mut curves = Vec::new();
        for ((column, words), colour) in aerosol_tables::BY_ANGLE.into_iter().zip(COLOURS) {
            curves.push(Curve::new(words, colour, points(frame, ("scattering_angle_deg", 1.0), (column, 1.0))?));
        }
        let angle = Axis::linear("scattering angle / °", 0.0, 180.0, 30.0);
        let panel = Panel::new(angle, error(1e-5), curves).key(Key::TopRight);
        let title = "What angles cost: largest error of radiance over all biomes, 312.5 and 512.5 nm";
        return Ok(Figure::new(title, vec![vec![panel]]));
    }
    // A line for each candidate, the first at the top.
    let (names, sizes) = (frame.texts("candidate")?, frame.column("megabytes")?);
    let height = |i: usize| (names.len() - i) as f64 - 0.5;
    let curve = |name: &str, column: &str, colour| -> Result<Curve, PolarsError> {
        let points = frame.column(column)?.into_iter().enumerate().map(|(i, error)| (error, height(i))).collect();
        Ok(Curve::new(name, colour, points).stroke(Stroke::Marks))
    };
    let curves = vec![
        curve("largest", "largest_error", VERMILION)?,
        curve("largest but for one biome", "largest_error_but_one_biome", ORANGE)?,
        curve("root of the mean square", "rms_error", BLUE)?,
        curve("largest of the matrix", "matrix_error", GREEN)?,
    ];
    let named = names.iter().zip(&sizes).enumerate();
    let named = named.map(|(i, (name, size))| (height(i), format!("{name}, {size:.1} MB"))).collect();
    let candidates = Axis::linear("", 0.0, names.len() as f64, 1.0).named(named);
    let (of, least) =
        if part.name == aerosol_tables::PARTS[0] { ("wavelengths", 1e-5) } else { ("angles and digits", 1e-8) };
    let panel = Panel::new(error(least), candidates, curves).key(Key::Beside);
    Ok(Figure::new(format!("Aerosol tables: error of radiance between nodes, by {of}"), vec![vec![panel]]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A frame of these columns, each with the same rising numbers.
    fn frame(columns: impl IntoIterator<Item = String>) -> Frame {
        Frame::new(columns.into_iter().map(|name| (name, vec![1e-3, 1e-2, 1e-1]))).expect("equal lengths")
    }

    #[test]
    fn figures_of_long_studies_show_all_their_columns() {
        let mut columns = vec!["radii".to_owned()];
        for (key, ..) in size_quadrature::PARTICLES {
            columns.extend(Quadrature::ALL.map(|rule| size_quadrature::column(key, rule)));
        }
        for name in size_quadrature::PARTS {
            let figure = figure(Name::SizeQuadrature, &Part { name, frame: frame(columns.clone()) }).expect("drawn");
            let panels: Vec<&Panel> = figure.rows.iter().flatten().collect();
            assert_eq!(panels.len(), size_quadrature::PARTICLES.len());
            assert!(panels.iter().all(|panel| panel.curves.len() == Quadrature::ALL.len()));
        }
        let by_angle = aerosol_tables::BY_ANGLE.map(|(column, _)| column.to_owned());
        let others = aerosol_tables::COLUMNS.map(String::from);
        let all: Vec<String> = ["scattering_angle_deg".to_owned()].into_iter().chain(by_angle).chain(others).collect();
        for name in aerosol_tables::PARTS {
            let labels = ["a", "b", "c"].map(String::from).to_vec();
            let frame = frame(all.clone()).labelled([("candidate", labels)]).expect("equal lengths");
            let figure = figure(Name::AerosolTables, &Part { name, frame }).expect("drawn");
            let expected = if name == aerosol_tables::PARTS[2] { 3 } else { 4 };
            assert_eq!(figure.rows[0][0].curves.len(), expected, "{name}");
        }
        let part = Part { name: "", frame: frame(["radii".to_owned()]) };
        assert!(figure(Name::SizeQuadrature, &part).is_err(), "numbers of another study");
    }
}
