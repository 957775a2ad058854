use super::*;
use crate::column::Place;
use crate::data::Data;
use std::path::Path;
use tables::views::{self, Biome};

fn layers(program: Program, biome: Option<Biome>) -> Layers {
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../data"));
    let place = Place { biome, ..Place::default() };
    let column = Column::read(Data(folder), &place).expect("tables");
    let sources = Sources::of(folder, &place.table_files()).expect("sources");
    Layers::new(&column, (program.wavelengths_nm(), 0.5), Vec::new(), sources).expect("layers")
}

fn texts(files: Vec<(String, Vec<u8>)>) -> Vec<(String, String)> {
    files.into_iter().map(|(name, bytes)| (name, String::from_utf8_lossy(&bytes).into_owned())).collect()
}

#[test]
fn layers_keep_optical_depths_and_phase_functions_their_integrals() {
    let layers = layers(Program::Bevy, Some(Biome::DesertDust));
    let folder = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../data"));
    let place = Place { biome: Some(Biome::DesertDust), ..Place::default() };
    let column = Column::read(Data(folder), &place).expect("tables");
    let even: Vec<f64> = (0..=COSINES).map(|i| -1.0 + 2.0 * i as f64 / COSINES as f64).collect();
    for (one, species) in layers.species.iter().zip(column.species()) {
        for (w, nm) in [650.0, 550.0, 450.0].into_iter().enumerate() {
            let exact = column.optical_depth(species, nm, (0.0, 120e3)).expect("inside").extinction();
            // Rounding of a sum over 240 layers.
            assert!((layers.optical_depth(one, w) / exact - 1.0).abs() < 1e-12, "{} at {nm} nm", one.name);
            if let Some(phase) = one.phase.get(w) {
                // Dust's peak is a few hundredths of a degree wide, a part of the last interval: 2e-3 of the energy is between the
                // places asked.
                let integral = views::integral(&even, phase);
                assert!((integral - 1.0).abs() < 2e-3, "{} at {nm} nm: {integral}", one.name);
            }
        }
    }
}

#[test]
fn hats_keep_the_integral_of_a_narrow_peak() {
    // Henyey and Greenstein's function of g = 0.95, whose peak is half as high after 3 degrees: seven nodes wide.
    let (cosines, means) = hats();
    let values: Vec<f64> = cosines.iter().map(|&c| crate::column::henyey_greenstein(0.95, c)).collect();
    let even: Vec<f64> = (0..=COSINES).map(|i| -1.0 + 2.0 * i as f64 / COSINES as f64).collect();
    let means = means(&values);
    // Linear pieces of an eighth of 5e-4, 6e-5 beside a width of 1.3e-3: second derivatives leave 1e-4.
    assert!((views::integral(&even, &means) - 1.0).abs() < 2e-4);
    let weighted: Vec<f64> = means.iter().zip(&even).map(|(value, c)| value * c).collect();
    assert!((views::integral(&even, &weighted) - 0.95).abs() < 2e-4);
}

#[test]
fn grids_of_mitsuba_have_a_cell_for_each_layer() {
    let layers = layers(Program::Mitsuba, Some(Biome::Urban));
    let files = layers.files(Program::Mitsuba).expect("files");
    let grid = &files.iter().find(|(name, _)| name == "extinction-550nm.vol").expect("a grid").1;
    assert_eq!((&grid[..4], grid.len()), (&b"VOL\x03"[..], 48 + 4 * 240));
    let cells: Vec<f32> = grid[48..].as_chunks::<4>().0.iter().map(|bytes| f32::from_le_bytes(*bytes)).collect();
    let depth: f64 = cells.iter().map(|&cell| 0.5 * f64::from(cell)).sum();
    let exact: f64 = layers.species.iter().map(|one| layers.optical_depth(one, 0)).sum();
    // Single precision.
    assert!((depth / exact - 1.0).abs() < 1e-6, "{depth} for {exact}");
    let scene = &texts(files).into_iter().find(|(name, _)| name == "scene-550nm.xml").expect("a scene").1;
    // One phase function for each scatterer, and a blend less.
    let count = layers.scatterers().count();
    assert_eq!((scene.matches("\"tabphase\"").count(), scene.matches("\"blendphase\"").count()), (count, count - 1));
}

#[test]
fn programs_of_three_colours_refuse_other_numbers() {
    let layers = layers(Program::Mitsuba, None);
    for program in Program::ALL.into_iter().filter(|program| program.is_rgb()) {
        let error = layers.files(program).expect_err("one wavelength").to_string();
        assert!(error.contains("three wavelengths"), "{error}");
    }
}

#[test]
fn fitted_profiles_keep_optical_depths() {
    let layers = layers(Program::Unreal, Some(Biome::Rural));
    let files = texts(layers.files(Program::Unreal).expect("files"));
    let file: serde_json::Value = serde_json::from_str(&files[0].1).expect("JSON");
    let of = |name: &str| file["SkyAtmosphereComponent"][name].clone();
    let (scale, colour) = (of("rayleigh_scattering_scale").as_f64(), of("rayleigh_scattering")["g"].as_f64());
    let height = of("rayleigh_exponential_distribution").as_f64().expect("a number");
    let ground = scale.expect("a number") * colour.expect("a number");
    let depth = ground * height * (1.0 - (-120.0 / height).exp());
    let exact = layers.optical_depth(&layers.species[0], 1);
    assert!((depth / exact - 1.0).abs() < 1e-9, "{depth} for {exact}");
    // An atmosphere of about 8 km.
    assert!((6.5..9.0).contains(&height), "{height} km");
}

#[test]
fn what_is_written_names_tables_and_units() {
    for program in Program::ALL {
        let files = texts(layers(program, Some(Biome::Urban)).files(program).expect("files"));
        let said = |text: &str| files.iter().any(|(_, file)| file.contains(text));
        let units = if program == Program::Bevy { "m^-1" } else { "km^-1" };
        assert!(said("rayleigh.table") && said(units) && said("vertical optical depth of ozone"), "{}", program.name());
    }
}
