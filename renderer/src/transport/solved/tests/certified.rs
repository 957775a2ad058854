//! Laws of certificates of polarised light.

use super::super::super::tests::polarised::{hazy, level, means};
use super::*;
use crate::polarisation::Stokes;
use crate::transport::radiation::Polarised;

/// I, Q and U.
fn all(seen: &Stokes) -> [f64; 3] {
    [seen.i, seen.q, seen.u]
}

/// As coarse as tables for certificates may be.
const COARSE: Resolution = Resolution { levels: 8, suns: 24, zeniths: [4, 2, 3], parts: 2, degree: 6, change: 5e-4 };

/// Tables of polarised light of one atmosphere: one finer and with more moments than certificates take; a coarse one; one 5 % too bright; and
/// one with wrong Q and U and wrong last moments.
fn spoiled(medium: &Medium<2>, albedo: [f64; 2]) -> [Solved<2>; 4] {
    let fine = Resolution { levels: 12, suns: 30, zeniths: [5, 3, 4], parts: 4, degree: 14, change: 5e-4 };
    let solved = |grid: &Resolution| Solved::polarised(medium, EARTH, albedo, grid).expect("round");
    let [fine, mut wrong] = [solved(&fine), solved(&fine)];
    let [coarse, mut bright] = [solved(&COARSE), solved(&COARSE)];
    for moment in bright.field.moments.iter_mut().chain(&mut bright.field.ground).flatten() {
        *moment *= 1.05;
    }
    let count = wrong.optics.moments.count();
    for moments in wrong.field.moments.chunks_exact_mut(count) {
        moments[2] = moments[2].map(|moment| -0.5 * moment);
    }
    spoil_last(&mut wrong);
    [fine, coarse, bright, wrong]
}

#[test]
fn certified_stokes_parameters_do_not_depend_on_the_table() {
    // Against polarised path tracing, with 4.5 standard errors of both: 1e-5 of false alarms for each of the 96 numbers. The particles have
    // all elements of a matrix; tables keep of what they make of Q and U the degree 2 alone.
    let albedo = [0.3; 2];
    let molecules = Component {
        density: exponential(8e3, 6e4),
        scattering: [4e-5, 1e-5],
        absorption: [0.0, 1e-7],
        phase: rayleigh(0.03),
    };
    let clear = (medium(vec![molecules], 6e4), [(1e6, 170.0, 10.0, 40.0), (2.0, 80.0, 30.0, 94.0)]);
    for (medium, views) in [clear, (hazy(), [(2.0, 75.0, 120.0, 50.0), (3e3, 100.0, 40.0, 80.0)])] {
        let columns = columns(&medium, EARTH);
        let tables = spoiled(&medium, albedo);
        for (altitude, zenith, azimuth, sun_zenith) in views {
            let sun = SunDisc::beam(towards(sun_zenith, 0.0));
            let problem = Problem {
                texture: None,
                shape: EARTH,
                medium: &medium,
                columns: &columns,
                albedo,
                sun: Some(&sun),
                environment: None,
                max_orders: None,
            };
            let (from, direction) = (Place::above(altitude), towards(zenith, azimuth));
            let paths = means(Estimator::Paths, &problem, from, direction, 5_000, 3);
            for (i, table) in tables.iter().enumerate() {
                let certificate = Certificate::new(table, columns.clone(), from, sun.direction());
                let look = (direction, level(direction));
                let found = certificate.stokes(look, all, (Fan::SMALL, 16), (1, 1)).expect("polarised");
                for (j, paths) in paths.iter().enumerate() {
                    for (k, (mean, error)) in paths.iter().enumerate() {
                        let allowed = 4.5 * (found[k].variance[j] + error * error).sqrt();
                        let off = found[k].mean[j] - mean;
                        let what = format!("table {i}, {zenith}, sun {sun_zenith}, {j}, parameter {k}");
                        assert!(off.abs() < allowed, "{what}: {off:e} of {mean:e}, {allowed:e}");
                        assert!(allowed < 0.25 * paths[0].0, "{what}: {allowed:e} of {:e} tests nothing", paths[0].0);
                    }
                }
            }
        }
    }
}

#[test]
fn tables_of_fewer_moments_have_their_sources() {
    // Without Legendre coefficients above the third, what a table's air scatters is what one of as many moments says: the same sums, but for
    // zeros.
    let (medium, albedo) = (hazy(), [0.3; 2]);
    let mut solved = Solved::polarised(&medium, EARTH, albedo, &COARSE).expect("round");
    let fewer = solved.up_to(3).expect("fewer than 6");
    assert!(fewer.up_to(3).is_none() && fewer.bytes() < solved.bytes() / 2);
    let optics = Arc::get_mut(&mut solved.optics).expect("its own");
    optics.species.iter_mut().for_each(|one| one.coefficients.truncate(4));
    let truth = columns(&medium, EARTH);
    for (altitude, zenith, azimuth, sun_zenith) in [(10.0, 80.0, 40.0, 60.0), (2e3, 120.0, 100.0, 95.0)] {
        let (place, sun, direction) = (Place::above(altitude), towards(sun_zenith, 0.0), towards(zenith, azimuth));
        let [all, few] = [&solved, &fewer].map(|solved| {
            let sources = Sources { solved, truth: &truth, scaled: None };
            let scattering = sources.scattering(altitude);
            sources.diffuse::<Polarised>(place, (direction, level(direction)), sun, &scattering, &mut Vec::new())
        });
        for (all, few) in all.iter().zip(&few) {
            for (all, few) in self::all(all).iter().zip(self::all(few)) {
                assert_eq!(*all, few);
                assert_ne!(few, 0.0);
            }
        }
    }
}

#[test]
fn certificates_of_polarised_light_state_their_errors() {
    // 200 certificates of 8 fans: their spread is what they state, within 4 standard errors of a spread. The last number is what a filter
    // passes, whose variance is not that of I, Q and U.
    let medium = hazy();
    let (from, direction, sun) = (Place::above(2.0), towards(60.0, 30.0), towards(70.0, 0.0));
    let table = Solved::polarised(&medium, EARTH, [0.3; 2], &COARSE).expect("round");
    let certificate = Certificate::new(&table, columns(&medium, EARTH), from, sun);
    let fan = Fan { first: 16, kept: 1, further: 16 };
    let of = |seen: &Stokes| [seen.i, seen.q, seen.u, seen.through(0.4)];
    let look = (direction, level(direction));
    let all: Vec<_> =
        (0..200).map(|seed| certificate.stokes(look, of, (fan, 8), (seed, 0)).expect("polarised")).collect();
    let n = all.len() as f64;
    for (k, j) in (0..4).flat_map(|k| [(k, 0), (k, 1)]) {
        let mean = all.iter().map(|one| one[k].mean[j]).sum::<f64>() / n;
        let spread = all.iter().map(|one| (one[k].mean[j] - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let stated = all.iter().map(|one| one[k].variance[j]).sum::<f64>() / n;
        assert!((spread / stated).sqrt().ln().abs() < 0.2, "{k}, {j}: {spread:e}, {stated:e}");
    }
}

#[test]
fn what_depolarises_is_certified_as_scalar_light() {
    // The same numbers draw the same fans, and a matrix of a1 alone is a phase function: what a table of polarised light leaves of the difference
    // is single precision, and Q and U are nothing.
    let medium = mixed();
    let haze = super::super::super::tests::medium(medium.components()[1..2].to_vec(), medium.top_m());
    let (from, direction, sun) = (Place::above(2.0), towards(60.0, 30.0), towards(70.0, 0.0));
    let table = Solved::polarised(&haze, EARTH, [0.3; 4], &COARSE).expect("round");
    let certificate = Certificate::new(&table, columns(&haze, EARTH), from, sun);
    let [i, q, u] = certificate
        .stokes((direction, level(direction)), all, (Fan::SMALL, 4), (1, 1))
        .expect("a table of polarised light");
    let scalar = certificate.radiance(direction, Fan::SMALL, 4, 1, 1);
    for j in 0..4 {
        assert!((i.mean[j] / scalar.mean[j] - 1.0).abs() < 1e-9, "{j}: {:e}, {:e}", i.mean[j], scalar.mean[j]);
        assert_eq!((q.mean[j], u.mean[j]), (0.0, 0.0));
    }
}

#[test]
fn a_table_without_polarisation_certifies_none() {
    let medium = hazy();
    let table = Solved::new(&medium, EARTH, [0.3; 2], &COARSE).expect("round");
    let certificate = Certificate::new(&table, columns(&medium, EARTH), Place::above(2.0), towards(70.0, 0.0));
    let view = towards(60.0, 30.0);
    assert_eq!(certificate.stokes((view, level(view)), all, (Fan::SMALL, 2), (1, 1)), None);
}
