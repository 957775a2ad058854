//! The figure of optical depths.

use super::colours::{BLACK, GREY};
use super::grids::{self, dotted, from_zero, points, sparse_wavelengths, wavelength_axis};
use super::model::{Area, Axis, Curve, Figure, Key, Panel, Stroke, stacked};
use super::settings::words;
use super::{Plot, PlotError, Settings};
use crate::column::{Column, Species};
use crate::data::Data;
use crate::frame::Frame;
use crate::study::thesis::Thesis;
use tables::TableError;
use tables::units::TOP_ALTITUDE_M;
use tables::views::Biome;

/// From this wavelength in nm on the axis of a single panel holds everything, and that of many; ozone towers below.
const FITTED_FROM_NM: [f64; 2] = [315.0, 350.0];

/// Panels in a row.
const ACROSS: usize = 3;

/// What one panel shows.
struct Shown {
    areas: Vec<Area>,
    total: Vec<f64>,
    thesis: Option<Vec<f64>>,
}

/// Vertical optical depth of each species against wavelength, one on the other: a panel for each biome, or one with
/// the transmittance below.
pub(super) fn optical_depth(data: Data<'_>, settings: &Settings, thesis: Option<&Thesis>) -> Result<Plot, PlotError> {
    let biomes: Vec<Option<Biome>> = match settings.biomes.as_slice() {
        [] => vec![None],
        some => some.iter().copied().map(Some).collect(),
    };
    let nm = sparse_wavelengths();
    let mut columns = vec![("wavelength_nm".to_owned(), nm.clone())];
    let (mut airs, mut shown) = (Vec::new(), Vec::new());
    for &biome in &biomes {
        let air = Column::read(data, &settings.with(biome))?;
        shown.push(of_place(&air, biome, settings, thesis, &nm, &mut columns)?);
        airs.push(air);
    }
    let grid = biomes.len() > 1;
    let fitted = nm.partition_point(|w| *w < FITTED_FROM_NM[usize::from(grid)]);
    let highest = shown.iter().flat_map(|one| &one.total[fitted..]).copied().fold(0.0, f64::max);
    let du = airs.first().map_or(0.0, Column::ozone_du);
    let mut title = format!("Vertical optical depth, {}, {du:.0} DU of ozone", settings.season());
    if biomes.iter().any(Option::is_some) {
        title = format!("{title}; aerosols: {}", settings.aerosol(&airs));
    }
    let mut key: Vec<Curve> = Vec::new();
    // Of the place with the most species first, so that they stand in their order.
    let mut longest: Vec<&Shown> = shown.iter().collect();
    longest.sort_by_key(|one| std::cmp::Reverse(one.areas.len()));
    for area in longest.into_iter().flat_map(|one| &one.areas) {
        if key.iter().all(|entry| entry.name != area.name) {
            key.push(Curve::new(area.name.clone(), area.colour, Vec::new()).stroke(Stroke::Filled));
        }
    }
    if thesis.is_some() {
        key.push(Curve { name: "dotted: total of the thesis' code".into(), colour: BLACK, ..dotted() });
    }
    let mut rows: Vec<Vec<Panel>> = Vec::new();
    for (i, (&biome, one)) in biomes.iter().zip(&shown).enumerate() {
        let mut curves = vec![Curve::new("", BLACK, points(&nm, &one.total))];
        if let Some(had) = &one.thesis {
            curves.push(Curve::new("", BLACK, points(&nm, had)).stroke(Stroke::Dotted));
        }
        let below = !grid || i + ACROSS >= biomes.len();
        let x = wavelength_axis(if grid { 200.0 } else { 100.0 });
        let x = Axis { label: if below { x.label } else { String::new() }, ..x };
        let y = from_zero(if i % ACROSS == 0 { "optical depth" } else { "" }, highest);
        let mut name = biome.map_or("clear air".into(), words);
        if one.thesis.as_ref().is_some_and(|had| had.iter().all(|depth| *depth > y.range.1)) {
            let lowest = one.thesis.iter().flatten().copied().fold(f64::INFINITY, f64::min);
            name = format!("{name}, thesis over {:.0}", lowest.floor());
        }
        let panel = Panel::new(x, y, curves).areas(one.areas.clone()).key(Key::None).titled(name);
        match rows.last_mut() {
            Some(row) if row.len() < ACROSS => row.push(panel),
            _ => rows.push(vec![panel]),
        }
    }
    if let [one] = shown.as_slice() {
        rows.push(vec![transmittance(&nm, one)]);
    }
    Ok(Plot { figure: Figure::new(title, rows).key(key), frame: Frame::new(columns)? })
}

fn of_place(
    air: &Column,
    biome: Option<Biome>,
    settings: &Settings,
    thesis: Option<&Thesis>,
    nm: &[f64],
    columns: &mut Vec<(String, Vec<f64>)>,
) -> Result<Shown, TableError> {
    let (mut layers, mut total) = (Vec::new(), vec![0.0; nm.len()]);
    for species in air.species() {
        let depth = |&w: &f64| Ok(air.optical_depth(species, w, (0.0, TOP_ALTITUDE_M))?.extinction());
        let values: Vec<f64> = nm.iter().map(depth).collect::<Result<_, TableError>>()?;
        for (sum, value) in total.iter_mut().zip(&values) {
            *sum += value;
        }
        let (name, column) = match (species, biome) {
            (Species::Molecules, _) => ("scattering by molecules".into(), "molecular_scattering".to_owned()),
            (Species::Ozone, _) => ("absorption by ozone".into(), "ozone_absorption".to_owned()),
            (_, Some(biome)) => (grids::words(air, species), format!("{biome}_{}", air.name(species))),
            (_, None) => continue,
        };
        if columns.iter().all(|(name, _)| *name != column) {
            columns.push((column, values.clone()));
        }
        layers.push((name, grids::colour(air, species), values));
    }
    let prefix = biome.map_or(String::new(), |biome| format!("{biome}_"));
    columns.push((format!("{prefix}total"), total.clone()));
    let had = |thesis: &Thesis| -> Result<Vec<f64>, TableError> {
        nm.iter().map(|&w| thesis.optical_depth(settings.place.month, biome, w)).collect()
    };
    let thesis = thesis.map(had).transpose()?;
    if let Some(values) = &thesis {
        columns.push((format!("thesis_{prefix}total"), values.clone()));
    }
    Ok(Shown { areas: stacked(nm, layers), total, thesis })
}

/// exp(-tau) against wavelength.
fn transmittance(nm: &[f64], shown: &Shown) -> Panel {
    let through = |depths: &[f64]| points(nm, &depths.iter().map(|depth| (-depth).exp()).collect::<Vec<_>>());
    let mut curves = vec![Curve::new("", BLACK, through(&shown.total))];
    curves.extend(shown.thesis.as_ref().map(|had| Curve::new("", GREY, through(had)).stroke(Stroke::Dotted)));
    Panel::new(wavelength_axis(100.0), Axis::linear("vertical transmittance", 0.0, 1.0, 0.2), curves).key(Key::None)
}
