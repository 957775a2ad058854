use super::*;
use std::path::PathBuf;
use std::sync::LazyLock;
use tables::views::integral;

/// The cases of OPAC, made once for all tests.
static OPAC: LazyLock<Vec<Case>> = LazyLock::new(|| {
    let folder: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "data"].iter().collect();
    cases(Data(&folder), AerosolSource::Opac).expect("sound tables")
});

fn at_550(biome: Biome) -> &'static Case {
    OPAC.iter().find(|case| is_reference(case) && case.biome == biome).expect("a case")
}

#[test]
fn the_asymmetry_is_that_of_the_mie_series() {
    let folder: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "data"].iter().collect();
    for case in OPAC.iter().filter(|case| is_reference(case)) {
        let aerosol = Data(&folder).aerosol(AerosolSource::Opac, case.biome).expect("a table");
        let (mut forward, mut depth) = (0.0, 0.0);
        for species in &aerosol.species {
            let optics = species.optics(species.default_humidity_percent, 550.0).expect("inside");
            let own = species.column_m2() * optics.scattering_m2;
            depth += own;
            forward += own * optics.asymmetry;
        }
        // Straight lines between the angles: the tables correct their integral by up to 3e-3.
        assert!((case.moments[0] - forward / depth).abs() < 3e-3, "{}: {}", case.biome, case.moments[0]);
        assert!((integral(&case.sky.cosines, &case.sky.aerosol) - 1.0).abs() < 1e-12);
    }
}

#[test]
fn fits_of_more_parameters_are_closer_in_the_norm_that_is_fitted() {
    for case in OPAC.iter() {
        let left = |form| case.cost(Stand::Fitted(form)).expect("a fit").1.logarithmic;
        let (single, fitted) = (left(Form::Single), left(Form::FittedSingle));
        let (double, free) = (left(Form::Double), left(Form::FreeDouble));
        // Of the search: 1e-12 of the square.
        let room = 1.0 + 1e-6;
        assert!(
            fitted <= single * room && free <= double * room && double < fitted,
            "{} {}",
            case.biome,
            case.wavelength_nm
        );
        let thesis = case.cost(Stand::Thesis).expect("always").1.logarithmic;
        assert!(fitted <= thesis * room, "{} {}", case.biome, case.wavelength_nm);
    }
}

#[test]
fn one_asymmetry_for_all_costs_most_where_it_is_far_from_the_truth() {
    let misplaced = |biome, stand| at_550(biome).cost(stand).expect("always").1.misplaced;
    let own = Stand::Fitted(Form::Single);
    // g is 0.68 in the background and 0.69 in towns; 0.756 over the clean sea.
    for biome in [Biome::Background, Biome::Urban] {
        assert!(misplaced(biome, Stand::Thesis) > 2.0 * misplaced(biome, own), "{biome}");
    }
    let ratio = misplaced(Biome::MaritimeClean, Stand::Thesis) / misplaced(Biome::MaritimeClean, own);
    assert!((ratio - 1.0).abs() < 0.1, "{ratio}");
}

#[test]
fn the_sky_of_the_same_phase_function_is_the_same() {
    // An aerosol that is a Henyey-Greenstein function.
    let truth = Fit { g1: 0.8, g2: -0.5, weight: 0.95 };
    let mut sky = at_550(Biome::Rural).sky.clone();
    sky.aerosol = sky.cosines.iter().map(|&mu| truth.phase(mu)).collect();
    let same = sky.error(&truth);
    assert_eq!((same.rms, same.mean), (0.0, 0.0));
    // Twice the phase function everywhere adds the aerosol's share to the sky, which is below 1 but not small.
    for p in &mut sky.aerosol {
        *p *= 0.5;
    }
    let twice = sky.error(&truth);
    assert!((0.2..1.0).contains(&twice.mean) && (twice.mean..1.0).contains(&twice.rms), "{twice:?}");
}
