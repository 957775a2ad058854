use super::*;
use crate::views::integral;
use crate::{Precision, Tolerance};
use std::collections::BTreeMap;
use std::f64::consts::PI;

fn field(name: &str, unit: &str, axes: &[&str], scale: Scale, values: Vec<f64>) -> Field {
    Field {
        name: format!("haze{name}"),
        unit: unit.into(),
        axes: axes.iter().map(|&axis| axis.into()).collect(),
        precision: Precision::F64,
        scale,
        tolerance: Tolerance { relative: 0.0, absolute: 0.0 },
        interpolation_error: None,
        values,
    }
}

/// One species: exponential with 2 km up to 4 km; two humidities, two wavelengths, isotropic or (1 + c) / 4 pi.
fn sample() -> Table {
    let axis = |name: &str, unit: &str, nodes: &[f64]| Axis::new(name, unit, nodes.to_vec()).expect("valid");
    let spectral = ["haze_humidity", "wavelength"];
    let (flat, tilted) = ([1.0; 3].map(|x: f64| x / (4.0 * PI)), [0.0, 1.0, 2.0].map(|x| x / (4.0 * PI)));
    Table {
        kind: Kind::Aerosol,
        title: "sample".into(),
        axes: vec![
            axis("wavelength", "nm", &[500.0, 600.0]),
            axis("cosine", "1", &[-1.0, 0.0, 1.0]),
            axis("haze_altitude", "m", &[0.0, 4000.0]).beyond(Outside::Zero),
            axis("haze_humidity", "percent", &[0.0, 80.0]),
        ],
        fields: vec![
            field(
                suffix::NUMBER_DENSITY,
                "m^-3",
                &["haze_altitude"],
                Scale::Logarithmic,
                vec![1e9, 1e9 * (-2.0_f64).exp()],
            ),
            field(suffix::DEFAULT_HUMIDITY, "percent", &[], Scale::Linear, vec![80.0]),
            field(suffix::EXTINCTION, "m^2", &spectral, Scale::Logarithmic, vec![4e-14, 1e-14, 16e-14, 4e-14]),
            field(suffix::SCATTERING, "m^2", &spectral, Scale::Logarithmic, vec![2e-14, 0.5e-14, 8e-14, 2e-14]),
            field(suffix::ASYMMETRY, "1", &spectral, Scale::Linear, vec![0.0, 0.0, 0.0, 1.0 / 3.0]),
            field(
                suffix::PHASE,
                "sr^-1",
                &["haze_humidity", "wavelength", "cosine"],
                Scale::Linear,
                [flat, flat, flat, tilted].concat(),
            ),
        ],
        settings: BTreeMap::from([("biome".into(), "urban".into()), ("source".into(), "opac".into())]),
        provenance: Vec::new(),
    }
}

#[test]
fn optical_depth_is_the_closed_form_of_an_exponential_layer() {
    let aerosol = Aerosol::from_table(&sample()).expect("valid");
    assert_eq!(aerosol.origin, Origin::Biome(AerosolSource::Opac, Biome::Urban));
    let column = 1e9 * 2000.0 * (1.0 - (-2.0_f64).exp());
    // At 550 nm the logarithms are half-way: sqrt(16 x 4) e-14.
    let depth = aerosol.own_optical_depth().expect("550 nm is inside");
    assert!((depth / (column * 8e-14) - 1.0).abs() < 1e-14, "{depth}");
    let ground = aerosol.ground_extinction(Some(0.0), 550.0).expect("inside");
    assert!((ground / (1e9 * 2e-14) - 1.0).abs() < 1e-14, "{ground}");
    assert_eq!(aerosol.species[0].number_density_m3.at(120e3).expect("zero above"), 0.0);
}

#[test]
fn optics_are_mixed_by_the_rules_of_their_fields() {
    let aerosol = Aerosol::from_table(&sample()).expect("valid");
    let optics = aerosol.species[0].optics(40.0, 550.0).expect("inside");
    assert!((optics.extinction_m2 / 4e-14 - 1.0).abs() < 1e-14 && (optics.scattering_m2 / 2e-14 - 1.0).abs() < 1e-14);
    assert!((optics.asymmetry - 1.0 / 12.0).abs() < 1e-15, "a quarter of one corner: {}", optics.asymmetry);
    assert!((integral(aerosol.species[0].cosines(), &optics.phase) - 1.0).abs() < 1e-15, "mixing keeps the integral");
    assert!((optics.phase[2] * 4.0 * PI - 1.25).abs() < 1e-15);
    assert!(aerosol.species[0].optics(81.0, 550.0).is_err() && aerosol.species[0].optics(80.0, 499.0).is_err());
}

#[test]
fn the_scattering_matrix_is_optional_and_mixed_as_the_phase_function() {
    let mut table = sample();
    let none = Aerosol::from_table(&table).expect("valid");
    assert_eq!(none.species[0].matrix(0.0, 500.0).expect("inside"), None);
    let over = ["haze_humidity", "wavelength", "cosine"];
    for (i, (end, sign)) in suffix::MATRIX.into_iter().zip([1.0, -1.0, 0.5]).enumerate() {
        assert!(i == 0 || Aerosol::from_table(&table).is_err(), "all three or none");
        let values = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.4, 0.0].map(|v| sign * v).to_vec();
        table.fields.push(field(end, "1", &over, Scale::Linear, values));
    }
    let species = &Aerosol::from_table(&table).expect("valid").species[0];
    let matrix = species.matrix(40.0, 550.0).expect("inside").expect("there");
    // A quarter of each corner.
    let expected = [1.0, -1.0, 0.5].map(|sign| sign * 0.35);
    for (found, expected) in [&matrix.p12, &matrix.p33, &matrix.p34].into_iter().zip(expected) {
        assert!(found[0] == 0.0 && (found[1] - expected).abs() < 1e-15, "{found:?} for {expected}");
    }
    table.fields.last_mut().expect("there").values[0] = 1.1;
    assert!(Aerosol::from_table(&table).is_err(), "a ratio above 1");
}

/// The sample with curved axes and three wavelengths, between which logarithms are parabolas: cross-sections as
/// exp(-x^2), x = (wavelength - 500 nm) / 100 nm, and the phase function exp(k c) k / (4 pi sinh k), k = 1 + x (2 - x).
fn curved() -> Table {
    let mut table = sample();
    let cosines: Vec<f64> = (0..=12).map(|i| -1.0 + f64::from(i) / 6.0).collect();
    let axis = |name: &str, unit: &str, nodes: Vec<f64>| Axis::new(name, unit, nodes).expect("valid");
    table.axes[0] = axis("wavelength", "nm", vec![500.0, 550.0, 600.0]).between(Interpolation::Parabolic);
    table.axes[1] = axis("cosine", "1", cosines.clone()).between(Interpolation::Cubic);
    let rows = |value: &dyn Fn(f64) -> f64| [0.0, 0.5, 1.0, 0.0, 0.5, 1.0].map(value).to_vec();
    table.fields[2].values = rows(&|x| 4e-14 * (-x * x).exp());
    table.fields[3].values = rows(&|x| 2e-14 * (-x * x).exp());
    table.fields[4].values = vec![0.5; 6];
    let phase = |x: f64| cosines.iter().map(|c| peaked(1.0 + x * (2.0 - x), *c)).collect::<Vec<_>>();
    table.fields[5].values = [0.0, 0.5, 1.0, 0.0, 0.5, 1.0].map(phase).concat();
    table.fields[5].scale = Scale::Logarithmic;
    table
}

/// exp(k c) k / (4 pi sinh k): its integral over the sphere is 1.
fn peaked(k: f64, c: f64) -> f64 {
    (k * c).exp() * k / (4.0 * PI * k.sinh())
}

#[test]
fn curved_axes_are_exact_for_parabolas_of_logarithms() {
    let aerosol = Aerosol::from_table(&curved()).expect("valid");
    let species = &aerosol.species[0];
    assert_eq!(species.cosines().len(), 49);
    for nm in [500.0, 512.5, 550.0, 587.0] {
        let x = (nm - 500.0) / 100.0;
        let optics = species.optics(80.0, nm).expect("inside");
        assert!((optics.extinction_m2 / (4e-14 * (-x * x).exp()) - 1.0).abs() < 1e-12, "{nm}");
        assert!((integral(species.cosines(), &optics.phase) - 1.0).abs() < 1e-14, "{nm}");
        for (c, p) in species.cosines().iter().zip(&optics.phase) {
            // Lines between 49 cosines have up to 8e-4 too much of the whole; the factor of k, whose logarithm is no
            // parabola of x, goes with it.
            assert!((p / peaked(1.0 + x * (2.0 - x), *c) - 1.0).abs() < 2e-3, "{nm} nm, {c}");
        }
    }
}

#[test]
fn a_curved_phase_function_is_of_logarithms() {
    let refused = |change: &dyn Fn(&mut Table)| {
        let mut table = curved();
        change(&mut table);
        Aerosol::from_table(&table).is_err()
    };
    assert!(!refused(&|_| ()));
    assert!(refused(&|t| t.fields[5].scale = Scale::Linear), "a cubic of the value");
    assert!(refused(&|t| t.axes[1].interpolation = Interpolation::Linear), "a line of the logarithm");
    assert!(refused(&|t| t.axes[0].interpolation = Interpolation::Step), "a step between wavelengths");
    assert!(refused(&|t| t.fields[5].values[6] *= 1.1), "an integral that is not 1");
}

#[test]
fn impossible_tables_are_refused() {
    let refused = |change: &dyn Fn(&mut Table)| {
        let mut table = sample();
        change(&mut table);
        Aerosol::from_table(&table).is_err()
    };
    assert!(!refused(&|_| ()));
    assert!(refused(&|t| t.kind = Kind::Sun), "another kind");
    assert!(refused(&|t| t.fields[3].values[0] = 5e-14), "more scattering than extinction");
    assert!(refused(&|t| t.fields[5].values[0] *= 1.1), "a phase function without integral 1");
    assert!(refused(&|t| drop(t.settings.insert("biome".into(), "moon".into()))), "an unknown biome");
    assert!(refused(&|t| drop(t.settings.insert("source".into(), "own".into()))), "an own aerosol without a name");
    assert!(refused(&|t| drop(t.fields.remove(2))), "no extinction");
    assert!(refused(&|t| t.axes[2].outside = Outside::Hold), "aerosol up to any height");
    assert!(refused(&|t| t.fields[1].values[0] = 90.0), "a default humidity that is not there");
}

#[test]
fn an_origin_finds_its_way_through_the_settings_of_a_table() {
    for origin in [Origin::Biome(AerosolSource::Jaenicke, Biome::Rural), Origin::Own("volcano 7".into())] {
        let mut table = sample();
        table.settings = origin.settings().into_iter().map(|(key, value)| (key.into(), value)).collect();
        assert_eq!(Aerosol::from_table(&table).expect("valid").origin, origin);
    }
    assert_eq!(Origin::Own("volcano 7".into()).to_string(), "volcano 7 (own)");
}

#[test]
fn names_of_biomes_and_sources_find_their_way_back() {
    for biome in Biome::ALL {
        assert_eq!(Biome::from_name(biome.name()), Some(biome));
    }
    assert_eq!(AerosolSource::from_name("jaenicke"), Some(AerosolSource::Jaenicke));
    assert_eq!(Biome::from_name("none"), None);
    assert_eq!(Aerosol::file_name(AerosolSource::Opac, Biome::DesertDust), "aerosol-opac-desert-dust.table");
}
