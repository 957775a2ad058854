//! Figures of aerosols.

use super::colours::{BLACK, BLUE, GREEN, GREY, ORANGE, SKY, VERMILION};
use super::grids::{self, against_km, altitudes, decades, dotted, points, sparse_wavelengths, wavelength_axis};
use super::model::{Axis, Colour, Curve, Figure, Key, Panel, Stroke};
use super::settings::words;
use super::{Plot, PlotError, Settings};
use crate::column::{Column, Parts, henyey_greenstein};
use crate::data::Data;
use crate::frame::Frame;
use crate::study::thesis::{ASYMMETRY, Thesis};
use tables::TableError;
use tables::views::Biome;

/// Altitude in km above which there is too little aerosol to show.
const TOP_KM: f64 = 40.0;

/// Concentration of a biome's aerosol against altitude, and the cross-sections of its mixture at the ground per
/// particle against wavelength.
pub(super) fn of_biome(
    data: Data<'_>,
    settings: &Settings,
    thesis: Option<&Thesis>,
    biome: Biome,
) -> Result<Plot, PlotError> {
    let column = Column::read(data, &settings.with(Some(biome)))?;
    let (z, nm) = (altitudes(&column), sparse_wavelengths());
    let (density, section) = (settings.units.density(), settings.units.cross_section());

    // Species, then their sum, then the thesis.
    let mut heights = vec![settings.units.altitude().column("altitude", &z)];
    let mut concentrations = Vec::new();
    let mut add = |name: String, column: &str, colour: Colour, stroke: Stroke, values: Vec<f64>| {
        heights.push(density.column(column, &values));
        concentrations.push(Curve::new(name, colour, against_km(&density.of(&values), &z)).stroke(stroke));
    };
    let all = z.iter().map(|&z| column.aerosol_density(z)).collect::<Result<_, _>>()?;
    add("all particles".into(), "concentration", BLACK, Stroke::Solid, all);
    // A single species is all particles.
    for species in column.aerosols().into_iter().filter(|_| column.aerosols().len() > 1) {
        let values = z.iter().map(|&z| column.density(species).at(z)).collect::<Result<_, _>>()?;
        let name = format!("concentration_{}", column.name(species));
        add(grids::words(&column, species), &name, grids::colour(&column, species), Stroke::Dashed, values);
    }
    if let Some(thesis) = thesis {
        let values = z.iter().map(|&z| thesis.particles_m3(biome, z)).collect::<Result<_, _>>()?;
        add(String::new(), "thesis_concentration", BLACK, Stroke::Dotted, values);
    }

    let at_ground = column.aerosol_density(0.0)?;
    let ours = spectrum(&nm, |w| Ok(column.aerosol_coefficients(w, 0.0)?.times(1.0 / at_ground)))?;
    let theirs = thesis.map(|thesis| spectrum(&nm, |w| thesis.particle_m2(biome, w))).transpose()?;
    let mut spectra = vec![("wavelength_nm".to_owned(), nm.clone())];
    let mut sections = Vec::new();
    for (prefix, pair, stroke) in [("", Some(&ours), Stroke::Solid), ("thesis_", theirs.as_ref(), Stroke::Dotted)] {
        let looks = [("scattering", BLUE), ("absorption", VERMILION)];
        for ((name, colour), values) in looks.into_iter().zip(pair.into_iter().flatten()) {
            spectra.push(section.column(&format!("{prefix}{name}"), values));
            let key = if prefix.is_empty() { name } else { "" };
            sections.push(Curve::new(key, colour, points(&nm, &section.of(values))).stroke(stroke));
        }
    }
    let named = concentrations.iter().chain(&sections).filter(|curve| !curve.name.is_empty());
    let mut key: Vec<Curve> = named.map(|curve| Curve { points: Vec::new(), ..curve.clone() }).collect();
    if theirs.is_some() {
        key.push(dotted());
    }
    let of = |curves: &[Curve], value: fn(&(f64, f64)) -> f64| -> Vec<f64> {
        curves.iter().flat_map(|curve| curve.points.iter().map(value)).collect()
    };
    let seen: Vec<f64> = {
        let inside = concentrations.iter().flat_map(|curve| &curve.points).filter(|(_, km)| *km <= TOP_KM);
        inside.map(|(value, _)| *value).collect()
    };
    let left = Panel::new(
        decades(&format!("concentration / {}", density.sign), &seen, 8),
        Axis::linear("altitude / km", 0.0, TOP_KM, 5.0),
        concentrations,
    )
    .key(Key::None);
    let label = format!("cross-section of a particle at the ground / {}", section.sign);
    let right = Panel::new(wavelength_axis(100.0), decades(&label, &of(&sections, |p| p.1), 16), sections);
    let right = right.key(Key::None);
    let title = format!("Aerosol: {} ({})", words(biome), settings.aerosol([&column]));
    let figure = Figure::new(title, vec![vec![left, right.share(1.1)]]).key(key);
    heights.extend(spectra);
    Ok(Plot { figure, frame: Frame::ragged(heights)? })
}

/// Scattering and absorption at each wavelength.
fn spectrum(nm: &[f64], parts: impl Fn(f64) -> Result<Parts, TableError>) -> Result<[Vec<f64>; 2], TableError> {
    let parts = nm.iter().map(|&w| parts(w)).collect::<Result<Vec<_>, _>>()?;
    Ok([parts.iter().map(|p| p.scattering).collect(), parts.iter().map(|p| p.absorption).collect()])
}

/// Colour and look of a biome among the others: neighbours in kind share a colour and differ in look.
fn look(biome: Biome) -> (Colour, Stroke) {
    match biome {
        Biome::Background => (GREY, Stroke::Solid),
        Biome::DesertDust => (ORANGE, Stroke::Solid),
        Biome::MaritimeClean => (BLUE, Stroke::Solid),
        Biome::MaritimeMineral => (BLUE, Stroke::Dashed),
        Biome::PolarAntarctic => (SKY, Stroke::Solid),
        Biome::PolarArctic => (SKY, Stroke::Dashed),
        Biome::RemoteContinental => (GREEN, Stroke::Solid),
        Biome::Rural => (GREEN, Stroke::Dashed),
        Biome::Urban => (VERMILION, Stroke::Solid),
    }
}

/// Single-scattering albedo and asymmetry of the biomes' mixtures at the ground against wavelength; the albedo of the
/// thesis in a panel of its own, with the looks of the others: dots alone would not tell nine apart.
pub(super) fn albedo_asymmetry(
    data: Data<'_>,
    settings: &Settings,
    thesis: Option<&Thesis>,
) -> Result<Plot, PlotError> {
    let nm = sparse_wavelengths();
    let mut columns = vec![("wavelength_nm".to_owned(), nm.clone())];
    let (mut airs, mut key) = (Vec::new(), Vec::new());
    let mut curves: [Vec<Curve>; 3] = Default::default();
    let albedo = |parts: Parts| parts.scattering / parts.extinction();
    for &biome in &settings.biomes {
        let column = Column::read(data, &settings.with(Some(biome)))?;
        let (colour, stroke) = look(biome);
        key.push(Curve::new(words(biome), colour, Vec::new()).stroke(stroke));
        let mut add = |i: usize, name: String, stroke: Stroke, values: Vec<f64>| {
            curves[i].push(Curve::new("", colour, points(&nm, &values)).stroke(stroke));
            columns.push((name, values));
        };
        let own = |&w: &f64| Ok(albedo(column.aerosol_coefficients(w, 0.0)?));
        add(0, format!("{biome}_albedo"), stroke, nm.iter().map(own).collect::<Result<_, TableError>>()?);
        let g = nm.iter().map(|&w| column.aerosol_asymmetry(w, 0.0)).collect::<Result<_, _>>()?;
        add(2, format!("{biome}_asymmetry"), stroke, g);
        if let Some(thesis) = thesis {
            let had = |&w: &f64| Ok(albedo(thesis.particle_m2(biome, w)?));
            let values = nm.iter().map(had).collect::<Result<_, TableError>>()?;
            add(1, format!("thesis_{biome}_albedo"), stroke, values);
        }
        airs.push(column);
    }
    // Whole tenths, and a little room beyond them for curves that touch.
    let fitted = |label: &str, curves: &[Curve]| {
        let values = || curves.iter().flat_map(|curve| &curve.points).map(|point| point.1);
        let (low, high) = (values().fold(1.0, f64::min), values().fold(0.0, f64::max));
        Axis::linear(label, (low * 10.0).floor() / 10.0 - 0.01, (high * 10.0).ceil() / 10.0 + 0.01, 0.1)
    };
    let [own, had, mut asymmetry] = curves;
    let panel = |y: Axis, curves: Vec<Curve>| Panel::new(wavelength_axis(200.0), y, curves).key(Key::None);
    let g = fitted("asymmetry parameter g", &asymmetry);
    let mut row = vec![panel(fitted("single-scattering albedo", &own), own)];
    if thesis.is_some() {
        row.push(panel(fitted("albedo in the thesis' code (swapped)", &had), had));
        asymmetry.push(
            Curve::new("", BLACK, vec![(nm[0], ASYMMETRY), (nm[nm.len() - 1], ASYMMETRY)]).stroke(Stroke::Dotted),
        );
        let name = format!("g in the thesis' code, {ASYMMETRY}");
        key.push(Curve { name, colour: BLACK, ..dotted() });
        columns.push(("thesis_asymmetry".into(), vec![ASYMMETRY; nm.len()]));
    }
    row.push(panel(g, asymmetry));
    let title = format!("Aerosols at the ground ({})", settings.aerosol(&airs));
    Ok(Plot { figure: Figure::new(title, vec![row]).key(key), frame: Frame::new(columns)? })
}

/// Scattering angles in degrees: finer towards the forward peak.
fn angles() -> Vec<f64> {
    let fine = (0..20).map(|i| f64::from(i) * 0.1);
    let medium = (4..20).map(|i| f64::from(i) * 0.5);
    fine.chain(medium).chain((10..=180).map(f64::from)).collect()
}

/// Panels in a row.
const ACROSS: usize = 3;

/// Phase functions of the biomes' mixtures at the ground at one wavelength, beside those of Henyey and Greenstein with
/// the same asymmetry, and with that of the thesis.
pub(super) fn phase_functions(data: Data<'_>, settings: &Settings, thesis: Option<&Thesis>) -> Result<Plot, PlotError> {
    let (degrees, nm) = (angles(), settings.wavelength_nm);
    let cosines: Vec<f64> = degrees.iter().map(|angle| angle.to_radians().cos()).collect();
    let hg = |g: f64| -> Vec<f64> { cosines.iter().map(|&c| henyey_greenstein(g, c)).collect() };
    let mut columns = vec![("angle_deg".to_owned(), degrees.clone())];
    let (mut airs, mut shown) = (Vec::new(), Vec::new());
    for &biome in &settings.biomes {
        let column = Column::read(data, &settings.with(Some(biome)))?;
        let (mie, g) = (column.aerosol_phase(nm, 0.0, &cosines)?, column.aerosol_asymmetry(nm, 0.0)?);
        columns.push((format!("{biome}_mie_per_sr"), mie.clone()));
        columns.push((format!("{biome}_henyey_greenstein_per_sr"), hg(g)));
        shown.push((biome, mie, g));
        airs.push(column);
    }
    if thesis.is_some() {
        columns.push(("thesis_henyey_greenstein_per_sr".into(), hg(ASYMMETRY)));
    }
    let values: Vec<f64> = shown.iter().flat_map(|(_, mie, _)| mie).copied().collect();
    let grid = shown.len() > 1;
    let mut rows: Vec<Vec<Panel>> = Vec::new();
    for (i, (biome, mie, g)) in shown.iter().enumerate() {
        let mut curves = vec![
            Curve::new("", BLUE, points(&degrees, mie)),
            Curve::new("", VERMILION, points(&degrees, &hg(*g))).stroke(Stroke::Dashed),
        ];
        if thesis.is_some() {
            curves.push(Curve::new("", BLACK, points(&degrees, &hg(ASYMMETRY))).stroke(Stroke::Dotted));
        }
        let below = !grid || i + ACROSS >= shown.len();
        let x = Axis::linear(if below { "scattering angle / °" } else { "" }, 0.0, 180.0, 30.0);
        let label = if i % ACROSS == 0 { "phase function / sr⁻¹" } else { "" };
        let panel = Panel::new(x, decades(label, &values, 8), curves).key(Key::None);
        let panel = panel.titled(format!("{}, g = {g:.3}", words(*biome)));
        match rows.last_mut() {
            Some(row) if row.len() < ACROSS => row.push(panel),
            _ => rows.push(vec![panel]),
        }
    }
    let mut key = vec![
        Curve::new("Mie", BLUE, Vec::new()),
        Curve::new("Henyey-Greenstein of the same g", VERMILION, Vec::new()).stroke(Stroke::Dashed),
    ];
    if thesis.is_some() {
        let name = format!("dotted: the thesis' code, Henyey-Greenstein, g = {ASYMMETRY}");
        key.push(Curve { name, colour: BLACK, ..dotted() });
    }
    let title = format!("Phase functions of aerosols at the ground at {nm} nm ({})", settings.aerosol(&airs));
    Ok(Plot { figure: Figure::new(title, rows).key(key), frame: Frame::new(columns)? })
}
