use super::*;
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
    assert_eq!(none.species[0].matrix_cosines(), None);
    assert_eq!(none.species[0].matrix(0.0, 500.0).expect("inside"), None);
    table.axes.push(Axis::new(MATRIX_COSINE.0, MATRIX_COSINE.1, vec![-1.0, 1.0]).expect("valid"));
    let over = ["haze_humidity", "wavelength", "matrix_cosine"];
    for (end, sign) in suffix::MATRIX.into_iter().zip([1.0, -1.0, 0.5]) {
        assert!(Aerosol::from_table(&table).is_err(), "all three or none");
        let values = [0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.4].map(|v| sign * v).to_vec();
        table.fields.push(field(end, "1", &over, Scale::Linear, values));
    }
    let species = &Aerosol::from_table(&table).expect("valid").species[0];
    assert_eq!(species.matrix_cosines(), Some([-1.0, 1.0].as_slice()));
    let matrix = species.matrix(40.0, 550.0).expect("inside").expect("there");
    // A quarter of each corner.
    let expected = [1.0, -1.0, 0.5].map(|sign| sign * 0.35);
    for (found, expected) in [&matrix.p12, &matrix.p33, &matrix.p34].into_iter().zip(expected) {
        assert!(found[0] == 0.0 && (found[1] - expected).abs() < 1e-15, "{found:?} for {expected}");
    }
    table.fields.last_mut().expect("there").values[0] = 1.1;
    assert!(Aerosol::from_table(&table).is_err(), "a ratio above 1");
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
