use super::*;
use std::path::Path;
use tables::views::{AerosolSource, Biome, integral};

fn data() -> Data<'static> {
    Data(Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../data")))
}

fn request(quantities: &[Quantity]) -> Request {
    Request {
        altitudes_km: vec![0.0],
        wavelengths_nm: vec![550.0],
        angles_deg: vec![0.0, 90.0],
        quantities: quantities.to_vec(),
        species: Vec::new(),
    }
}

fn hazy() -> Place {
    Place { biome: Some(Biome::Urban), ..Place::default() }
}

/// Values of a column in the rows of a species.
fn of(sheet: &Sheet, column: &str, species: &str) -> Vec<Option<f64>> {
    let values = |name: &str| &sheet.columns.iter().find(|c| c.name == name).unwrap_or_else(|| panic!("{name}")).values;
    let Values::Words(names) = values("species") else { panic!("species are words") };
    let Values::Numbers(numbers) = values(column) else { panic!("{column} is a number") };
    numbers.iter().zip(names).filter(|(_, name)| *name == species).map(|(number, _)| *number).collect()
}

fn one(sheet: &Sheet, column: &str, species: &str) -> f64 {
    of(sheet, column, species)[0].unwrap_or_else(|| panic!("{column} of {species}"))
}

#[test]
fn numbers_are_those_of_the_views_at_nodes() {
    let asked = Request { altitudes_km: vec![0.0, 30.0], wavelengths_nm: vec![400.0], ..request(&Quantity::ALL) };
    let sheet = sheet(data(), &Place::default(), &asked).expect("a sheet");
    let (air, rayleigh) = (data().air().expect("air"), data().rayleigh().expect("rayleigh"));
    let ozone = data().ozone_profiles().expect("ozone").profile(6, 45.0).expect("June").number_density_m3;
    for (i, m) in [0.0, 30e3].into_iter().enumerate() {
        // Each altitude has two angles, and so two rows.
        let density = |name| of(&sheet, "number_density_per_m3", name)[2 * i];
        assert_eq!(density("molecules"), air.number_density_m3.at(m).ok());
        assert_eq!(density("ozone"), ozone.at(m).ok());
        assert_eq!(density("total"), None);
        let sigma = data().ozone_cross_section().expect("cross-section");
        let expected = sigma.cross_section_m2(400.0, air.temperature_k.at(m).expect("inside")).ok();
        assert_eq!(of(&sheet, "absorption_cross_section_m2", "ozone")[2 * i], expected);
    }
    assert_eq!(
        one(&sheet, "scattering_cross_section_m2", "molecules"),
        rayleigh.cross_section_m2.at(400.0).expect("in")
    );
}

#[test]
fn coefficients_are_densities_times_cross_sections_and_add_up() {
    let asked = Request { altitudes_km: vec![0.0, 1.3, 11.0], ..request(&Quantity::ALL[..4]) };
    let sheet = sheet(data(), &hazy(), &asked).expect("a sheet");
    let Values::Words(names) = &sheet.columns[2].values else { panic!("species are words") };
    // A product and its quotient differ in the last bits.
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-14 * b.abs();
    let single: Vec<&String> = names[..names.len() / 3].iter().filter(|n| !SUMS.contains(&n.as_str())).collect();
    assert!(single.len() > 3, "{single:?}");
    for kind in ["scattering", "absorption", "extinction"] {
        let (sigma, beta) = (format!("{kind}_cross_section_m2"), format!("{kind}_coefficient_per_m"));
        for altitude in 0..3 {
            let value = |column: &str, name: &str| of(&sheet, column, name)[altitude];
            for name in &single {
                let product = value("number_density_per_m3", name).zip(value(&sigma, name)).map(|(n, s)| n * s);
                assert!(near(value(&beta, name).expect("there"), product.expect("there")), "{kind} of {name}");
            }
            let sum: f64 = single.iter().filter_map(|name| value(&beta, name)).sum();
            assert!(near(value(&beta, "total").expect("there"), sum), "{kind} at altitude {altitude}");
        }
    }
    for name in names {
        let value = |kind: &str| one(&sheet, &format!("{kind}_coefficient_per_m"), name);
        assert!(near(value("extinction"), value("scattering") + value("absorption")), "{name}");
    }
    let albedo =
        one(&sheet, "scattering_coefficient_per_m", "aerosol") / one(&sheet, "extinction_coefficient_per_m", "aerosol");
    assert!(near(one(&sheet, "single_scattering_albedo", "aerosol"), albedo));
}

#[test]
fn optical_depth_decreases_upwards_and_is_that_of_bucholtz() {
    let asked = Request { altitudes_km: (0..=120).map(f64::from).collect(), ..request(&[Quantity::OpticalDepth]) };
    let sheet = sheet(data(), &Place::default(), &asked).expect("a sheet");
    let values = |column: &str, name: &str| of(&sheet, column, name).into_iter().flatten().collect::<Vec<f64>>();
    let (above, below) =
        (values("extinction_optical_depth_above", "total"), values("extinction_optical_depth_below", "total"));
    assert!(above.windows(2).all(|pair| pair[1] < pair[0]) && above[120] == 0.0);
    for (above_here, below_here) in above.iter().zip(&below) {
        // Sums of some hundred terms.
        assert!(((above_here + below_here) / above[0] - 1.0).abs() < 1e-12);
    }
    // Bucholtz 1995, table 5, US standard atmosphere at 550 nm: 0.0971, to half a digit.
    let rayleigh = one(&sheet, "scattering_optical_depth_above", "molecules");
    assert!((rayleigh - 0.0971).abs() < 5e-5, "{rayleigh}");
}

#[test]
fn the_phase_function_of_the_mixture_integrates_to_one_and_has_its_asymmetry() {
    let particles = data().aerosol(AerosolSource::Opac, Biome::Urban).expect("aerosol");
    let cosines = particles.species[0].cosines().to_vec();
    let angles: Vec<f64> = cosines.iter().map(|c| c.acos() * 180.0 / PI).collect();
    let asked = Request { angles_deg: angles, ..request(&[Quantity::Coefficient, Quantity::Phase]) };
    let sheet = sheet(data(), &hazy(), &asked).expect("a sheet");
    let phase: Vec<f64> = of(&sheet, "phase_per_sr", "aerosol").into_iter().flatten().collect();
    assert_eq!(phase.len(), cosines.len());
    // Tables in single precision, 6e-8; and a cosine that went through degrees is off by 1e-16, at a forward peak 1e-12.
    assert!((integral(&cosines, &phase) - 1.0).abs() < 1e-6, "{}", integral(&cosines, &phase));
    // Molecules are asymmetric in no direction: the total is the aerosol's, diluted by their share of scattering.
    let beta = |name| one(&sheet, "scattering_coefficient_per_m", name);
    let diluted = one(&sheet, "asymmetry", "aerosol") * beta("aerosol") / beta("total");
    assert!((one(&sheet, "asymmetry", "total") / diluted - 1.0).abs() < 1e-14);
}

#[test]
fn an_aerosol_of_one_species_stands_there_once() {
    for (source, expected) in [(AerosolSource::Jaenicke, 4), (AerosolSource::Opac, 7)] {
        let sheet = sheet(data(), &Place { source, ..hazy() }, &request(&[Quantity::Coefficient])).expect("a sheet");
        assert_eq!((sheet.rows(), of(&sheet, "asymmetry", "aerosol").len()), (expected, 1));
    }
}

#[test]
fn only_what_is_asked_for_is_there() {
    let asked = Request { species: vec!["total".into()], ..request(&[Quantity::Phase]) };
    let total = sheet(data(), &hazy(), &asked).expect("a sheet");
    let names: Vec<&str> = total.columns.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["altitude_km", "wavelength_nm", "species", "angle_deg", "phase_per_sr"]);
    assert_eq!(total.rows(), 2);
    // Ozone does not scatter, so it has no phase function.
    let all = sheet(data(), &Place::default(), &request(&[Quantity::Phase])).expect("a sheet");
    assert_eq!((all.rows(), of(&all, "phase_per_sr", "ozone").len()), (4, 0));
}

#[test]
fn what_is_not_possible_is_refused_with_what_is() {
    let refusal = |place: Place, change: fn(&mut Request)| {
        let mut asked = request(&Quantity::ALL);
        change(&mut asked);
        sheet(data(), &place, &asked).expect_err("refused").to_string()
    };
    let clear = Place::default;
    let humid =
        |biome, source, humidity| Place { biome: Some(biome), source, humidity_percent: Some(humidity), ..clear() };
    for (found, expected) in [
        (refusal(clear(), |r| r.altitudes_km.push(120.5)), "altitude 120.5 km: 0 to 120 km is possible"),
        (refusal(clear(), |r| r.wavelengths_nm.push(299.0)), "wavelength 299 nm: 300 to 1000 nm is possible"),
        (refusal(clear(), |r| r.angles_deg.push(-1.0)), "angle -1 degrees: 0 to 180 degrees is possible"),
        (
            refusal(Place { latitude_deg: 91.0, ..clear() }, |_| ()),
            "latitude 91 degrees: -90 to 90 degrees is possible",
        ),
        (
            refusal(clear(), |r| r.species.push("dust".into())),
            "no species is called \"dust\" here: possible are molecules, ozone, total",
        ),
        (refusal(humid(Biome::Urban, AerosolSource::Opac, 100.0), |_| ()), "humidity 100 %: 0 to 99 % is possible"),
        (refusal(humid(Biome::Urban, AerosolSource::Jaenicke, 50.0), |_| ()), "a humidity has no effect"),
        (refusal(clear(), |r| r.angles_deg = vec![0.0; 1_000_000]), "3000000 rows: at most 2000000 are possible"),
    ] {
        assert!(found.contains(expected), "{found}");
    }
}
