//! Tables of aerosol: one for each source and biome, and those of one's own.

use super::{field, two_digits};
use crate::aerosol::bulk::Rule;
use crate::aerosol::library::Library;
use crate::aerosol::material::Substances;
use crate::aerosol::mixture::{Mixed, species};
use crate::aerosol::recipe::{Inputs, Part, Recipe, SpeciesRecipe, particles, recipe};
use crate::aerosol::{AerosolError, angles};
use crate::raw::RawData;
use tables::units::WAVELENGTH_RANGE_NM;
use tables::views::{AerosolSource, Angles, Biome, COSINE, Origin, WAVELENGTH, suffix};
use tables::{Axis, Field, Interpolation, Kind, Precision, Provenance, Scale, Table, TableError, Tolerance};

/// Step of the wavelength axis, nm: every other node is one of the refractive indices, which are linear between theirs,
/// and so have kinks where one parabola ends and the next begins.
const WAVELENGTH_STEP: f64 = 25.0;

/// Of the intervals between wavelengths, the interpolation is measured in every how many; odd, for first and second
/// halves of parabolas.
const MEASURED: usize = 5;

/// The optics of every kind of particles of some recipes.
pub(crate) struct Prepared {
    rule: Rule,
    axis: Axis,
    /// At the nodes of the axis, at all humidities.
    nodes: Library,
    /// Half-way between some of them, at the default humidities, to measure the interpolation.
    halves: Library,
}

fn refused(error: AerosolError) -> TableError {
    TableError::Inconsistent(error.to_string())
}

/// The recipes of these biomes.
pub(super) fn recipes(raw: &RawData, aerosols: &[(AerosolSource, Biome)]) -> Result<Vec<Recipe>, TableError> {
    let inputs = Inputs { opac: &raw.aerosol_opac, jaenicke: &raw.aerosol_jaenicke };
    aerosols.iter().map(|&(source, biome)| recipe(inputs, source, biome).map_err(refused)).collect()
}

/// What a recipe was made from.
pub(super) fn provenance(raw: &RawData, source: AerosolSource) -> Vec<Provenance> {
    let mut provenance = vec![
        raw.aerosol_opac.refractive_index.provenance.clone(),
        raw.aerosol_opac.components.provenance.clone(),
        raw.aerosol_opac.types.provenance.clone(),
        raw.aerosol_opac.layers.provenance.clone(),
    ];
    if source == AerosolSource::Jaenicke {
        provenance.push(raw.aerosol_jaenicke.modes.provenance.clone());
    }
    provenance
}

/// The axis of wavelengths.
pub(crate) fn wavelengths() -> Result<Axis, TableError> {
    let (low, high) = WAVELENGTH_RANGE_NM;
    let count = ((high - low) / WAVELENGTH_STEP) as usize + 1;
    Ok(Axis::uniform(WAVELENGTH.0, WAVELENGTH.1, low, WAVELENGTH_STEP, count)?.between(Interpolation::Parabolic))
}

/// Computes the optics of every kind of particles of these recipes.
pub(crate) fn prepare(substances: Substances<'_>, recipes: &[Recipe], rule: &Rule) -> Result<Prepared, TableError> {
    let axis = wavelengths()?;
    let between: Vec<f64> = axis.nodes.windows(2).step_by(MEASURED).map(|pair| 0.5 * (pair[0] + pair[1])).collect();
    let angles = angles::axis()?.nodes;
    let compute = || -> Result<(Library, Library), AerosolError> {
        let all = particles(substances, recipes, |s| &s.humidities)?;
        let nodes = Library::new(substances, all, &axis.nodes, &angles, rule)?;
        let usual = particles(substances, recipes, |s| std::slice::from_ref(&s.default_humidity))?;
        let halves = Library::new(substances, usual, &between, &angles, rule)?;
        Ok((nodes, halves))
    };
    let (nodes, halves) = compute().map_err(refused)?;
    Ok(Prepared { rule: *rule, axis, nodes, halves })
}

/// The fields of one species, gathered.
#[derive(Default)]
struct Columns {
    extinction: Vec<f64>,
    scattering: Vec<f64>,
    asymmetry: Vec<f64>,
    phase: Vec<f64>,
    ratios: [Vec<f64>; 3],
    cross_section_error: Vec<f64>,
    misplaced: Vec<f64>,
    phase_error: Vec<f64>,
    largest_correction: f64,
}

/// Largest deviation, at the default humidity, of what is interpolated half-way between wavelengths from what is
/// computed there: of cross-sections (relative), of g (absolute), of the phase function (relative), and of the
/// ratios of the matrix (absolute).
#[derive(Default)]
struct Halves {
    cross_sections: f64,
    asymmetry: f64,
    phase: f64,
    ratios: f64,
}

fn halves(prepared: &Prepared, nodes: &[Mixed], exact: &[Mixed]) -> Result<Halves, TableError> {
    let mut worst = Halves::default();
    for (&nm, exact) in prepared.halves.wavelengths_nm().iter().zip(exact) {
        let near: Vec<(&Mixed, f64)> = prepared.axis.weights(nm)?.iter().map(|&(i, w)| (&nodes[i], w)).collect();
        let found = |scale: Scale, value: &dyn Fn(&Mixed) -> f64| -> f64 {
            scale.back(near.iter().map(|(mixed, weight)| weight * scale.of(value(mixed))).sum())
        };
        let relative = |value: &dyn Fn(&Mixed) -> f64| (found(Scale::Logarithmic, value) / value(exact) - 1.0).abs();
        let absolute = |value: &dyn Fn(&Mixed) -> f64| (found(Scale::Linear, value) - value(exact)).abs();
        let cross_sections = relative(&|m| m.extinction).max(relative(&|m| m.scattering));
        worst.cross_sections = worst.cross_sections.max(cross_sections);
        worst.asymmetry = worst.asymmetry.max(absolute(&|m| m.asymmetry));
        for i in 0..exact.phase.len() {
            worst.phase = worst.phase.max(relative(&|m| m.phase[i]));
            let ratios = (0..3).map(|j| absolute(&|m| m.ratios[j][i]));
            worst.ratios = ratios.fold(worst.ratios, f64::max);
        }
    }
    Ok(worst)
}

/// The table of a recipe, whose optics are prepared.
pub(crate) fn table(
    substances: Substances<'_>,
    prepared: &Prepared,
    made: &Recipe,
    provenance: Vec<Provenance>,
) -> Result<Table, TableError> {
    let cosine = angles::axis()?;
    let angles = Angles::new(&cosine)?;
    let mut axes = vec![prepared.axis.clone(), cosine];
    let mut fields = Vec::new();
    let (mut quadrature, mut misplaced, mut angle_error, mut correction) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
    let mut unmet = Vec::new();
    for recipe in &made.species {
        let mut columns = Columns::default();
        let mut between = Halves::default();
        for &humidity in &recipe.humidities {
            let mixed = species(substances, &prepared.nodes, recipe, humidity).map_err(refused)?;
            for one in &mixed {
                columns.extinction.push(one.extinction);
                columns.scattering.push(one.scattering);
                columns.asymmetry.push(one.asymmetry);
                columns.phase.extend(&one.phase);
                for (all, ratio) in columns.ratios.iter_mut().zip(&one.ratios) {
                    all.extend(ratio);
                }
                columns.cross_section_error.push(one.error.cross_sections);
                columns.misplaced.push(one.error.misplaced);
                columns.phase_error.push(one.error.phase);
                let logarithms: Vec<f64> = one.phase.iter().map(|p| p.ln()).collect();
                let (_, missed) = angles.phase(angles.between(Scale::Logarithmic, &logarithms));
                columns.largest_correction = columns.largest_correction.max(missed.abs());
            }
            if humidity == recipe.default_humidity {
                let exact = species(substances, &prepared.halves, recipe, humidity).map_err(refused)?;
                between = halves(prepared, &mixed, &exact)?;
            }
        }
        quadrature = columns.cross_section_error.iter().copied().fold(quadrature, f64::max);
        misplaced = columns.misplaced.iter().copied().fold(misplaced, f64::max);
        angle_error = columns.phase_error.iter().copied().fold(angle_error, f64::max);
        correction = correction.max(columns.largest_correction);
        unmet.extend(shortfalls(substances, prepared, recipe).map_err(refused)?);
        add_species(&mut axes, &mut fields, recipe, columns, &between)?;
    }
    let settings = [
        ("composition", made.composition.clone()),
        ("particles", "homogeneous spheres, mixed externally".to_owned()),
        ("size average", format!("nested rules in ln r, at least {} intervals", 4 * prepared.rule.first)),
        ("tolerance of size averages", prepared.rule.to_string()),
        ("tolerance not reached", if unmet.is_empty() { "nowhere".to_owned() } else { unmet.join("; ") }),
        ("largest quadrature error of a cross-section", format!("{:e}", two_digits(quadrature))),
        ("largest share of light misplaced by quadrature", format!("{:e}", two_digits(misplaced))),
        ("largest quadrature error of a phase function at an angle", format!("{:e}", two_digits(angle_error))),
        ("largest correction of a phase function to integral 1", format!("{:e}", two_digits(correction))),
        (
            "interpolation errors",
            format!("half-way between wavelengths, in every {MEASURED}th interval, at the default humidity"),
        ),
    ];
    let title = match &made.origin {
        Origin::Biome(source, biome) => format!("Aerosol of the biome {biome} after {source}"),
        Origin::Own(name) => format!("Aerosol {name}"),
    };
    Ok(Table {
        kind: Kind::Aerosol,
        title,
        axes,
        fields,
        settings: settings
            .into_iter()
            .chain(made.origin.settings())
            .map(|(key, value)| (key.to_owned(), value))
            .collect(),
        provenance,
    })
}

/// Where the averages over sizes of the parts of a species miss their tolerance: humidities and runs of wavelengths.
fn shortfalls(
    substances: Substances<'_>,
    prepared: &Prepared,
    recipe: &SpeciesRecipe,
) -> Result<Vec<String>, AerosolError> {
    let mut found: Vec<(String, Vec<String>)> = Vec::new();
    for (part, _) in &recipe.parts {
        let name = match part {
            Part::Component(name) => name.clone(),
            Part::Mode(mode) => format!("{} of {}", mode.material, mode.sizes.described()),
        };
        let (mut places, mut seen) = (Vec::new(), Vec::new());
        for &humidity in &recipe.humidities {
            let particles = part.particles(substances, humidity)?;
            // Particles that take up no water are the same at every humidity.
            if seen.contains(&particles) {
                continue;
            }
            let (optics, nodes) = (prepared.nodes.get(&particles)?, prepared.nodes.wavelengths_nm());
            let missed: Vec<usize> = (0..optics.len()).filter(|&w| !optics[w].reached).collect();
            // Runs of neighbours.
            for run in missed.chunk_by(|a, b| a + 1 == *b) {
                let (first, last) = (nodes[run[0]], nodes[run[run.len() - 1]]);
                let range = if first == last { format!("{first}") } else { format!("{first}-{last}") };
                places.push(format!("{range} nm at {} %", particles.humidity_percent));
            }
            seen.push(particles);
        }
        if !places.is_empty() {
            found.push((name, places));
        }
    }
    Ok(found.iter().map(|(name, places)| format!("{}, {name}: {}", recipe.name, places.join(", "))).collect())
}

fn add_species(
    axes: &mut Vec<Axis>,
    fields: &mut Vec<Field>,
    recipe: &SpeciesRecipe,
    columns: Columns,
    between: &Halves,
) -> Result<(), TableError> {
    let full = |end: &str| format!("{}{end}", recipe.name);
    let (altitude, humidity) = (full(suffix::ALTITUDE), full(suffix::HUMIDITY));
    let number: f64 = recipe.parts.iter().map(|(_, number)| number).sum();
    let density = recipe.profile.curve(&altitude, number)?;
    axes.push(density.axis().clone());
    axes.push(Axis::new(&humidity, "percent", recipe.humidities.clone())?);
    let spectral = [humidity.as_str(), WAVELENGTH.0];
    fields.push(Field {
        scale: density.scale(),
        ..field(&full(suffix::NUMBER_DENSITY), "m^-3", &[&altitude], 0.0, density.values().to_vec())
    });
    fields.push(field(&full(suffix::DEFAULT_HUMIDITY), "percent", &[], 0.0, vec![recipe.default_humidity]));
    let double = |end: &str, unit: &str, scale: Scale, error: f64, values: Vec<f64>| Field {
        precision: Precision::F64,
        scale,
        tolerance: Tolerance { relative: 1e-9, absolute: 0.0 },
        interpolation_error: Some(two_digits(error)),
        ..field(&full(end), unit, &spectral, 0.0, values)
    };
    let log = Scale::Logarithmic;
    fields.push(double(suffix::EXTINCTION, "m^2", log, between.cross_sections, columns.extinction));
    fields.push(double(suffix::SCATTERING, "m^2", log, between.cross_sections, columns.scattering));
    fields.push(double(suffix::ASYMMETRY, "1", Scale::Linear, between.asymmetry, columns.asymmetry));
    let over = [humidity.as_str(), WAVELENGTH.0, COSINE.0];
    fields.push(Field {
        // Beside the rounding of storage, backward amplitudes of large spheres pass on a few last bits of sines.
        tolerance: Tolerance { relative: 1e-6, absolute: 0.0 },
        interpolation_error: Some(two_digits(between.phase)),
        scale: Scale::Logarithmic,
        ..field(&full(suffix::PHASE), "sr^-1", &over, 1e-3, columns.phase)
    });
    for (end, values) in suffix::MATRIX.into_iter().zip(columns.ratios) {
        fields.push(Field {
            // Ratios near zero are differences.
            tolerance: Tolerance { relative: 1e-6, absolute: 1e-7 },
            interpolation_error: Some(two_digits(between.ratios)),
            ..field(&full(end), "1", &over, 1e-3, values)
        });
    }
    let errors = [
        ("_cross_section_quadrature_error", columns.cross_section_error),
        ("_misplaced_by_quadrature", columns.misplaced),
        ("_phase_quadrature_error", columns.phase_error),
    ];
    for (end, values) in errors {
        fields.push(Field {
            // Differences of nearly equal numbers: their last bits are the machine's.
            tolerance: Tolerance { relative: 0.1, absolute: 1e-9 },
            ..field(&full(end), "1", &spectral, 1.0, values)
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn wavelengths_meet_the_reference_wavelength_and_the_ends() {
        let (low, high) = WAVELENGTH_RANGE_NM;
        assert_eq!((high - low) % WAVELENGTH_STEP, 0.0);
        assert_eq!((tables::views::REFERENCE_WAVELENGTH_NM - low) % WAVELENGTH_STEP, 0.0);
    }

    #[test]
    fn all_aerosols_fit_into_what_data_may_hold() {
        let raw =
            RawData::from_dir(&std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../raw-data")).expect("sound");
        let inputs = Inputs { opac: &raw.aerosol_opac, jaenicke: &raw.aerosol_jaenicke };
        let all = AerosolSource::ALL.into_iter().flat_map(|s| Biome::ALL.map(|b| recipe(inputs, s, b)));
        let recipes = all.collect::<Result<Vec<_>, _>>().expect("recipes");
        let rows: usize = recipes.iter().flat_map(|r| &r.species).map(|s| s.humidities.len()).sum();
        let (wavelengths, angles) = (wavelengths().expect("sound").nodes.len(), angles::degrees().len());
        let bytes = 4 * rows * wavelengths * 4 * angles;
        // Phase functions and matrices; 10 MB less what all other numbers take.
        assert!(bytes < 9_500_000, "{bytes} bytes");
    }
}
