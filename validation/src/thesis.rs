//! The tables of the thesis (Gavin 2020) beside those of Airlight, correction by correction: what each changes.
//!
//! The thesis' numbers are those of [`tools::study::thesis`], errors included. Each row replaces one ingredient alone. What the ozone
//! does to a picture is shown by Airlight itself with 10.5 times the ozone, as far as scenes allow: 1000 DU.

use crate::judge::percent;
use crate::{Context, Section, ValidationError, Verdict};
use renderer::render::{Sky, Summary};
use renderer::scene::Scene;
use renderer::study::{Chart, Point};
use std::sync::atomic::AtomicBool;
use tables::units::DOBSON_UNIT_M2;
use tables::views::{AerosolSource, Biome};
use tools::column::{Column, Place, Species};
use tools::data::Data;
use tools::profile::standard_atmosphere::StandardAtmosphere;
use tools::raw::RawData;
use tools::study::thesis::Thesis;

/// The month of the comparison: April, 384 DU at Arosa.
const MONTH: u8 = 4;

/// Top of the thesis' air in m.
const TOP_M: f64 = 86e3;

/// Wavelengths in nm at which optical depths are given.
const WAVELENGTHS: [f64; 4] = [360.0, 450.0, 550.0, 650.0];

/// Sum of a density over the thesis' altitudes in steps of 100 m, midpoints.
fn column_of(density: impl Fn(f64) -> Result<f64, tables::TableError>) -> Result<f64, tables::TableError> {
    const STEP: f64 = 100.0;
    (0..(TOP_M / STEP) as u32).map(|i| Ok(STEP * density((f64::from(i) + 0.5) * STEP)?)).sum()
}

/// Computes the section.
///
/// # Errors
/// [`ValidationError`] if inputs or tables cannot be read.
pub fn make(context: &Context<'_>) -> Result<Section, ValidationError> {
    let raw_dir = context.root.join("raw-data");
    let data_dir = context.root.join("data");
    let (raw, thesis) = (RawData::from_dir(&raw_dir)?, Thesis::from_dir(&raw_dir)?);
    let mut section = Section::default();
    section.say(
        "Compared: the tables of the thesis (Gavin 2020, as its published code has them) with those that Airlight makes. The reference is here the \
         corrected table, and the difference is the thesis' error; no uncertainty applies. `airlight-tools study thesis` draws the same over \
         altitude and wavelength, `airlight-tools biomes` lists the aerosols, and [aerosols](aerosols.md) says how each error was found.",
    );
    air_and_ozone(&raw, &thesis, &data_dir, &mut section)?;
    aerosols(&raw, &thesis, &data_dir, &mut section)?;
    whole(&thesis, &data_dir, &mut section)?;
    pictures(context, &mut section)?;
    Ok(section)
}

fn air_and_ozone(
    raw: &RawData,
    thesis: &Thesis,
    data_dir: &std::path::Path,
    section: &mut Section,
) -> Result<(), ValidationError> {
    let column = Column::read(Data(data_dir), &Place { month: MONTH, latitude_deg: 47.0, ..Place::default() })?;
    let atmosphere = StandardAtmosphere::new(&raw.atmosphere)?;
    let dobson = |column: f64| column / DOBSON_UNIT_M2;
    let had = dobson(column_of(|z| thesis.ozone_m3(MONTH, z))?);
    let arosa = dobson(raw.ozone_arosa.columns.rows[usize::from(MONTH) - 1].column);
    let mut rows = vec![vec![
        "ozone column, April, Arosa".into(),
        format!("{had:.0} DU"),
        format!("{arosa:.0} DU"),
        format!("{:.2}", had / arosa),
        "a layer's column taken for its density per km, a Dobson unit too large by 10 %, two layers counted twice"
            .into(),
    ]];
    let ozone = |nm: f64| -> Result<f64, ValidationError> {
        let depth = column.optical_depth(Species::Ozone, nm, (0.0, TOP_M))?.absorption;
        Ok(depth / column_of(|z| column.density(Species::Ozone).at(z))?)
    };
    for nm in [310.0, 360.0, 450.0, 550.0, 600.0, 700.0] {
        let (had, right) = (thesis.ozone_m2(nm)?, ozone(nm)?);
        rows.push(vec![
            format!("ozone cross-section at {nm} nm"),
            format!("{had:.2e} m^2"),
            format!("{right:.2e} m^2"),
            format!("{:.2}", had / right),
            "32 points joined by lines, one temperature; a slipped decimal at 248 nm".into(),
        ]);
    }
    for km in [20.0, 50.0, 86.0] {
        let z: f64 = km * 1e3;
        let (had, right) = (thesis.molecules_m3(z)?, atmosphere.at(z.min(85_999.99))?.number_density);
        rows.push(vec![
            format!("density of air at {km} km"),
            format!("{had:.3e} m^-3"),
            format!("{right:.3e} m^-3"),
            format!("{:.3}", had / right),
            "geopotential altitudes taken for geometric ones".into(),
        ]);
    }
    let had = column_of(|z| thesis.molecules_m3(z))?;
    let right = column_of(|z| column.density(Species::Molecules).at(z))?;
    rows.push(vec![
        "column of air".into(),
        format!("{had:.4e} m^-2"),
        format!("{right:.4e} m^-2"),
        format!("{:.4}", had / right),
        "the same: little, for the air is low".into(),
    ]);
    let (mut largest, mut at) = (0.0_f64, 0.0);
    for i in 0..=700 {
        let nm = 300.0 + f64::from(i);
        let right = column.cross_sections(Species::Molecules, nm, 0.0)?.scattering;
        let error = thesis.rayleigh_m2(nm)? / right - 1.0;
        (largest, at) = if error.abs() > largest.abs() { (error, nm) } else { (largest, at) };
    }
    rows.push(vec![
        format!("Rayleigh cross-section, worst of 300 to 1000 nm ({at:.0} nm)"),
        String::new(),
        String::new(),
        format!("{:.4}", 1.0 + largest),
        "lines between the rows of Bucholtz' table 2".into(),
    ]);
    section.table(&["what", "thesis", "corrected", "thesis / corrected", "why"], &rows);
    section.find(
        "ozone of the thesis",
        format!("{:.1} times the column", dobson(column_of(|z| thesis.ozone_m3(MONTH, z))?) / arosa),
        "Duetsch 1974",
        Verdict::Corrected,
    );
    Ok(())
}

fn aerosols(
    raw: &RawData,
    thesis: &Thesis,
    data_dir: &std::path::Path,
    section: &mut Section,
) -> Result<(), ValidationError> {
    let mut rows = Vec::new();
    let mut points = Vec::new();
    let mut factors = Vec::new();
    for biome in Biome::ALL {
        let of = |source| Column::read(Data(data_dir), &Place { biome: Some(biome), source, ..Place::default() });
        let (opac, jaenicke) = (of(AerosolSource::Opac)?, of(AerosolSource::Jaenicke)?);
        let had = thesis.particle_m2(biome, 550.0)?;
        let density = thesis.particles_m3(biome, 0.0)?;
        let extinction = 1e3 * density * had.extinction();
        let at = |column: &Column| column.aerosol_coefficients(550.0, 0.0);
        let (ours, same) = (at(&opac)?, at(&jaenicke)?);
        let asymmetry = jaenicke.aerosol_asymmetry(550.0, 0.0)?;
        let albedo = |parts: tools::column::Parts| parts.scattering / parts.extinction();
        factors.push(extinction / (1e3 * same.extinction()));
        rows.push(vec![
            biome.to_string(),
            format!("{extinction:.4}"),
            format!("{:.5}", 1e3 * same.extinction()),
            format!("{:.3}", extinction / (1e3 * same.extinction())),
            format!("{:.5}", 1e3 * ours.extinction()),
            format!("{:.4}", albedo(had)),
            format!("{:.4}", 1.0 - albedo(had)),
            format!("{:.4}", albedo(same)),
            format!("0.76, {asymmetry:.3}"),
        ]);
        for i in 0..=28 {
            let nm = 300.0 + 25.0 * f64::from(i);
            let ratio = density * thesis.particle_m2(biome, nm)?.extinction()
                / jaenicke.aerosol_coefficients(nm, 0.0)?.extinction();
            points.push(Point { panel: "extinction at the ground", curve: biome.to_string(), at: [nm, ratio] });
        }
    }
    // Only to say which of the densities were mistyped.
    let slips =
        raw.aerosol_gavin.biomes.rows.iter().map(|row| format!("{} {:.4e}", row.biome, row.base_density * 1e-6));
    section.say(&format!(
        "Aerosols at the ground, 550 nm, extinction in km^-1. The thesis summed the cross-sections of three single spheres, without the width and the \
         weights of the log-normals; it swapped scattering and absorption (the albedo after swapping them back is one minus the albedo that it had), and took g = 0.76 \
         everywhere. Densities at the ground in cm^-3 as its code has them, slips included: {}.",
        slips.collect::<Vec<_>>().join(", ")
    ));
    section.table(
        &[
            "biome",
            "thesis",
            "same distributions (Jaenicke), corrected",
            "factor",
            "OPAC",
            "albedo: thesis",
            "swapped back",
            "corrected",
            "g: thesis, corrected",
        ],
        &rows,
    );
    let (low, high) = factors.iter().fold((f64::INFINITY, 0.0_f64), |(a, b), &f| (a.min(f), b.max(f)));
    section.find(
        "aerosols of the thesis",
        format!("extinction wrong by factors of {low:.3} to {high:.0}; scattering and absorption swapped"),
        "the same distributions by Mie scattering",
        Verdict::Corrected,
    );
    let title = "Aerosols of the thesis: extinction at the ground over the corrected one".into();
    section.chart("thesis", Chart { title, axes: ["wavelength / nm", "thesis / corrected"], points });
    Ok(())
}

/// Vertical optical depths of everything together.
fn whole(thesis: &Thesis, data_dir: &std::path::Path, section: &mut Section) -> Result<(), ValidationError> {
    let mut rows = Vec::new();
    for biome in std::iter::once(None).chain(Biome::ALL.map(Some)) {
        let column =
            Column::read(Data(data_dir), &Place { month: MONTH, latitude_deg: 47.0, biome, ..Place::default() })?;
        let mut row = vec![biome.map_or_else(|| "clear".to_owned(), |biome| biome.to_string())];
        for nm in WAVELENGTHS {
            let mut depth = 0.0;
            for species in column.species() {
                depth += column.optical_depth(species, nm, (0.0, TOP_M))?.extinction();
            }
            row.push(format!("{:.3}, {depth:.3}", thesis.optical_depth(MONTH, biome, nm)?));
        }
        rows.push(row);
    }
    section.say(
        "Vertical optical depths of everything together, in April: those of the thesis, those of Airlight (OPAC).",
    );
    let header = WAVELENGTHS.map(|nm| format!("{nm} nm"));
    let mut names = vec!["air"];
    names.extend(header.iter().map(String::as_str));
    section.table(&names, &rows);
    Ok(())
}

/// What ozone alone does to a clear sky.
fn pictures(context: &Context<'_>, section: &mut Section) -> Result<(), ValidationError> {
    let mut rows = Vec::new();
    for (i, elevation) in [30.0, 5.0, -4.0].into_iter().enumerate() {
        let seen = |ozone_du: f64| -> Result<([f64; 3], f64), ValidationError> {
            let scene =
                Scene { sun_elevation_deg: elevation, ozone_du: Some(ozone_du), month: MONTH, ..Scene::default() };
            let sky = Sky::new(&scene, context.data)?;
            let mut factors = vec![0.0; sky.wavelengths()];
            let sampler = renderer::sampling::Sampler::new(0, 0, 0);
            sky.radiance(glam::DVec3::Z, &sampler, &mut factors);
            let lux = Summary::new(&sky, 0, &AtomicBool::new(false)).sky_lux.mean;
            Ok((sky.colour().xyz(&factors), lux))
        };
        let (right, more) = (seen(384.0)?, seen(1000.0)?);
        let chromaticity = |[x, y, z]: [f64; 3]| format!("{:.4}, {:.4}", x / (x + y + z), y / (x + y + z));
        rows.push(vec![
            format!("{elevation}"),
            format!("{:.4e}", right.0[1]),
            percent(more.0[1] / right.0[1] - 1.0, 1),
            percent(more.1 / right.1 - 1.0, 1),
            chromaticity(right.0),
            chromaticity(more.0),
        ]);
        (context.progress)(0.2 + 0.8 * (i + 1) as f64 / 3.0);
    }
    section.say(
        "What too much ozone does to a clear sky: the zenith and the illuminance of the sky with 384 DU, and the change with 1000 DU, the most that \
         scenes take, a quarter of what the thesis had.",
    );
    section.table(
        &[
            "sun / degrees",
            "zenith, 384 DU / cd m^-2",
            "with 1000 DU %",
            "illuminance of the sky %",
            "zenith x, y with 384 DU",
            "with 1000 DU",
        ],
        &rows,
    );
    Ok(())
}
