//! Do the aerosols close? Published optics, optical depths, and the numbers of the thesis.
#![allow(clippy::print_stdout, reason = "the figures found: cargo test -- --nocapture shows them")]

use std::path::Path;
use std::sync::LazyLock;
use tables::views::{AerosolSource, Biome};
use tools::aerosol::angles::cosines;
use tools::aerosol::bulk::{Bulk, Rule, Tolerance};
use tools::aerosol::library::Library;
use tools::aerosol::material::index;
use tools::aerosol::mixture::{self, Mixed};
use tools::aerosol::recipe::{Inputs, Part, Profile, SpeciesRecipe, opac_species, recipe};
use tools::aerosol::thesis;
use tools::raw::RawData;
use tools::raw::aerosol_opac::ComponentOptics;

static RAW: LazyLock<RawData> = LazyLock::new(|| {
    RawData::from_dir(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../raw-data")).expect("raw-data/ is sound")
});

/// Good to 1e-3 in cross-sections, which is what is compared with publications.
const RULE: Rule = Rule { first: 50, absorbing: ROUGH, clear: ROUGH };
const ROUGH: Tolerance = Tolerance { cross_sections: 5e-4, phase: 1.0, most: 1600 };

fn inputs() -> Inputs<'static> {
    Inputs { opac: &RAW.aerosol_opac, jaenicke: &RAW.aerosol_jaenicke }
}

/// Optics of a species by wavelength at a humidity.
fn optics(species: &SpeciesRecipe, humidity: f64, wavelengths_nm: &[f64]) -> Vec<Mixed> {
    let opac = &RAW.aerosol_opac;
    let particles = species.parts.iter().map(|(part, _)| part.particles(opac, humidity).expect("a component"));
    let library = Library::new(opac, particles, wavelengths_nm, &[], &RULE).expect("spheres in range");
    mixture::species(opac, &library, species, humidity).expect("in the library")
}

fn number(species: &SpeciesRecipe) -> f64 {
    species.parts.iter().map(|(_, number)| number).sum()
}

/// Column over density at sea level, m.
fn depth_of(profile: &Profile) -> f64 {
    match *profile {
        Profile::Layer { bottom, top, scale_height } if scale_height >= 99e3 => top - bottom,
        Profile::Layer { bottom, top, scale_height } => {
            scale_height * ((-bottom / scale_height).exp() - (-top / scale_height).exp())
        }
        Profile::Levels { .. } => panic!("no type of OPAC is given by levels"),
        Profile::Floor { scale_height, floor, top } => scale_height * (1.0 - (-top / scale_height).exp()) + floor * top,
    }
}

#[test]
fn components_have_the_optics_that_opac_publishes() {
    let opac = &RAW.aerosol_opac;
    let mut wavelengths: Vec<f64> = opac.optics.rows.iter().map(|row| row.wavelength_nm).collect();
    wavelengths.sort_by(f64::total_cmp);
    wavelengths.dedup();
    let of = |row: &ComponentOptics| Part::Component(row.component.clone()).particles(opac, row.humidity_percent);
    let all = opac.optics.rows.iter().map(|row| of(row).expect("a component"));
    let library = Library::new(opac, all, &wavelengths, &[], &RULE).expect("spheres in range");
    let (mut count, mut largest, mut deviating) = (0, [0.0_f64; 3], Vec::new());
    for row in &opac.optics.rows {
        let at = wavelengths.iter().position(|w| *w == row.wavelength_nm).expect("one of them");
        let found = &library.get(&of(row).expect("a component")).expect("computed")[at];
        let closure = (found.scattering + found.absorption) / found.extinction - 1.0;
        assert!(closure.abs() < 1e-13, "extinction is scattering and absorption: {closure}");
        // The source cuts the angles of its coarse sea salt too short at high humidity.
        let excepted = row.component == "sscm" && row.humidity_percent >= 90.0;
        let errors = [
            (found.extinction / row.extinction - 1.0).abs(),
            (found.scattering / found.extinction - row.albedo).abs(),
            if excepted { 0.0 } else { (found.asymmetry - row.asymmetry).abs() },
        ];
        for (largest, error) in largest.iter_mut().zip(errors) {
            *largest = largest.max(error);
        }
        if errors.into_iter().zip([7e-3, 1e-3, 1e-2]).any(|(error, limit)| error > limit) {
            deviating.push(format!(
                "{} at {} % and {} nm: extinction {:.1e}, albedo {:.1e}, g {:.1e}",
                row.component, row.humidity_percent, row.wavelength_nm, errors[0], errors[1], errors[2]
            ));
        }
        count += 1;
    }
    println!(
        "OPAC, {count} rows: extinction within {:.1e}, albedo {:.1e}, g {:.1e}",
        largest[0], largest[1], largest[2]
    );
    assert!(deviating.is_empty(), "beyond 0.7 %, 0.001, 0.01: {deviating:#?}");
}

/// Largest error of the cross-sections and g, and of the differential cross-section at any angle.
fn deviations(found: &Bulk, exact: &Bulk) -> [f64; 2] {
    let relative = |a: f64, b: f64| (a / b - 1.0).abs();
    let optics = relative(found.extinction, exact.extinction).max(relative(found.scattering, exact.scattering));
    let pairs = found.matrix[0].iter().zip(&exact.matrix[0]);
    let phase = pairs.map(|(a, b)| relative(*a, *b)).fold(0.0, f64::max);
    [optics.max((found.asymmetry - exact.asymmetry).abs()), phase]
}

#[test]
fn averages_reach_their_tolerance_and_estimates_cover_their_errors() {
    // Against four times as many radii as the longest of the rules, between the limits of the distributions themselves.
    let nothing = Tolerance { cross_sections: 0.0, phase: 0.0, most: 12_800 };
    let fine = Rule { first: 50, absorbing: nothing, clear: nothing };
    let shorter = |tolerance: Tolerance| Tolerance { most: 3200, ..tolerance };
    let Rule { first, absorbing, clear } = Rule::TABLES;
    let rule = Rule { first, absorbing: shorter(absorbing), clear: shorter(clear) };
    let opac = &RAW.aerosol_opac;
    let kinds = [
        ("soot", 0.0),
        ("inso", 0.0),
        ("minm", 0.0),
        ("miam", 0.0),
        ("mitr", 0.0),
        ("waso", 0.0),
        ("waso", 90.0),
        ("suso", 0.0),
        ("ssam", 80.0),
    ];
    let all: Vec<_> = kinds
        .iter()
        .map(|(name, humidity)| Part::Component((*name).into()).particles(opac, *humidity).expect("a component"))
        .collect();
    let angles = cosines(&[180.0, 178.0, 160.0, 140.0, 120.0, 90.0, 60.0, 30.0, 10.0, 3.0, 1.0, 0.0]);
    let wavelengths = [400.0, 600.0, 1000.0];
    let by = |rule: &Rule| Library::new(opac, all.clone(), &wavelengths, &angles, rule).expect("spheres in range");
    let (found, exact) = (by(&rule), by(&fine));
    let (mut count, mut covered, mut unmet) = (0, 0, 0);
    for particles in &all {
        let pairs = found.get(particles).expect("computed").iter().zip(exact.get(particles).expect("computed"));
        for ((found, exact), nm) in pairs.zip(wavelengths) {
            let errors = deviations(found, exact);
            let estimates = [found.error.cross_sections, found.error.phase];
            let m = index(opac, &particles.material, particles.humidity_percent, nm).expect("an index");
            let wanted = rule.tolerance(m);
            unmet += usize::from(!found.reached);
            for ((error, estimate), wanted) in
                errors.into_iter().zip(estimates).zip([wanted.cross_sections, wanted.phase])
            {
                count += 1;
                covered += usize::from(error <= estimate);
                let told = format!("{} at {nm} nm: error {error:e}, estimate {estimate:e}", particles.material);
                // An estimate that fails fails by little.
                assert!(!found.reached || error <= 2.0 * wanted, "{told}");
                if error > estimate {
                    println!("{told}");
                }
            }
        }
    }
    println!("{covered} of {count} estimates cover the error; {unmet} of {} averages miss their tolerance", count / 2);
    assert!(20 * covered >= 19 * count, "{covered} of {count}");
    // Clear sea salt at least, so that what is not reached is among the tests.
    assert!(unmet > 0 && unmet < 10, "{unmet}");
}

#[test]
fn types_have_their_published_optical_depths() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/reference/opac-optical-depths.csv");
    let reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_path(file);
    let published: Vec<(String, f64)> =
        reader.expect("there").deserialize().collect::<Result<_, _>>().expect("names and numbers");
    assert_eq!(published.len(), 10);
    for (name, expected) in published {
        let depth: f64 = opac_species(&RAW.aerosol_opac, &name)
            .expect("a type")
            .iter()
            .map(|s| optics(s, s.default_humidity, &[550.0])[0].extinction * number(s) * depth_of(&s.profile))
            .sum();
        println!("{name}: optical depth {depth:.4}, published {expected}");
        // Within 1 %, and half a unit of the third decimal of what is published.
        assert!((depth - expected).abs() < 0.01 * expected.max(0.05), "{name}: {depth} against {expected}");
    }
}

/// Extinction at the ground in km^-1, albedo, g and Angstrom exponent of a biome at 550 nm.
fn ground(source: AerosolSource, biome: Biome) -> [f64; 4] {
    let made = recipe(inputs(), source, biome).expect("a recipe");
    let wavelengths = [440.0, 550.0, 870.0];
    let mut sums = [[0.0; 3]; 3];
    for species in &made.species {
        // A floor comes on top; what is compared is the distribution itself.
        if matches!(species.profile, Profile::Layer { bottom, .. } if bottom > 0.0) {
            continue;
        }
        for (sum, at) in sums.iter_mut().zip(optics(species, species.default_humidity, &wavelengths)) {
            let n = number(species);
            sum[0] += n * at.extinction;
            sum[1] += n * at.scattering;
            sum[2] += n * at.scattering * at.asymmetry;
        }
    }
    let angstrom = -(sums[0][0] / sums[2][0]).ln() / (wavelengths[0] / wavelengths[2]).ln();
    [sums[1][0] * 1e3, sums[1][1] / sums[1][0], sums[1][2] / sums[1][1], angstrom]
}

#[test]
fn biomes_of_opac_are_within_what_is_published() {
    // Extinction (km^-1), albedo and g of the types at 550 nm and 80 %: Hess, Koepke & Schult 1998, table 4, to the
    // digits printed; Angstrom exponents: ranges of the AERONET climatology of such places (Dubovik et al., J. Atmos. Sci.
    // 59, 590, 2002, table 1: urban 1.0 to 2.5, desert -0.1 to 0.9, oceanic 0 to 1.55 of Lanai).
    let published = [
        (Biome::DesertDust, (0.145, 0.888, 0.729), (-0.1, 0.9)),
        (Biome::MaritimeClean, (0.090, 0.997, 0.772), (0.0, 1.55)),
        (Biome::PolarAntarctic, (0.011, 1.000, 0.784), (0.0, 2.0)),
        (Biome::PolarArctic, (0.023, 0.887, 0.721), (0.0, 2.0)),
        (Biome::RemoteContinental, (0.026, 0.972, 0.709), (1.0, 2.5)),
        (Biome::Rural, (0.075, 0.925, 0.703), (1.0, 2.5)),
        (Biome::Urban, (0.353, 0.817, 0.689), (1.0, 2.5)),
    ];
    for (biome, (extinction, albedo, asymmetry), (low, high)) in published {
        let found = ground(AerosolSource::Opac, biome);
        println!("opac {biome}: {found:?}");
        // A unit of the third decimal.
        assert!((found[0] - extinction).abs() < 1e-3 && (found[1] - albedo).abs() < 1e-3, "{biome}: {found:?}");
        assert!((found[2] - asymmetry).abs() < 2e-3 && (low..=high).contains(&found[3]), "{biome}: {found:?}");
    }
}

#[test]
fn biomes_of_jaenicke_are_what_their_distributions_make() {
    // Computed apart from Airlight, with miepython, from the same distributions, indices and shares; 4 digits.
    let expected = [
        (Biome::Background, 0.2298, 1.0000, 0.7625),
        (Biome::DesertDust, 1.631, 0.6575, 0.8699),
        (Biome::MaritimeClean, 0.02347, 1.0000, 0.7391),
        (Biome::MaritimeMineral, 0.02605, 0.7571, 0.7320),
        (Biome::PolarAntarctic, 0.001253, 0.9990, 0.7108),
        (Biome::PolarArctic, 0.001544, 0.8080, 0.6830),
        (Biome::RemoteContinental, 0.04425, 0.9173, 0.6012),
        (Biome::Rural, 0.03961, 0.8711, 0.6608),
        (Biome::Urban, 0.3008, 0.6440, 0.6231),
    ];
    for (biome, extinction, albedo, asymmetry) in expected {
        let found = ground(AerosolSource::Jaenicke, biome);
        println!("jaenicke {biome}: {found:?}");
        // Quadratures over sizes of both, and where each cuts the largest.
        assert!((found[0] / extinction - 1.0).abs() < 3e-3, "{biome}: {found:?}");
        assert!((found[1] - albedo).abs() < 1.5e-3 && (found[2] - asymmetry).abs() < 4e-3, "{biome}: {found:?}");
    }
}

#[test]
fn the_numbers_of_the_thesis_follow_from_its_recipe() {
    // Root mean square of ln(scattering by the recipe / scattering of the thesis), 300 to 750 nm, as found: single
    // spheres at the median radii, unweighted. The shares of mixtures were recovered from these very numbers.
    let gavin = &RAW.aerosol_gavin;
    for (i, (biome, limit)) in
        Biome::ALL.into_iter().zip([0.002, 0.002, 0.15, 0.05, 0.03, 0.05, 0.25, 0.002, 0.016]).enumerate()
    {
        let rows = gavin.cross_sections.rows.iter().filter(|row| (300.0..=750.0).contains(&row.wavelength_nm));
        let logarithms = rows.map(|row| {
            let (scattering, _) =
                thesis::cross_sections(&RAW.aerosol_opac, &RAW.aerosol_jaenicke, biome, row.wavelength_nm)
                    .expect("in range");
            (scattering / row.biomes[i].0).ln()
        });
        let (count, sum) = logarithms.fold((0.0, 0.0), |(n, s), x: f64| (n + 1.0, s + x * x));
        let rms = (sum / count).sqrt();
        let right = ground(AerosolSource::Jaenicke, biome)[0];
        let had = gavin.biomes.rows[i].ground_extinction * 1e3;
        println!("{biome}: recipe over thesis, rms {rms:.3}; extinction of the thesis over right {:.3e}", had / right);
        assert!(rms < limit, "{biome}: {rms}");
    }
}
