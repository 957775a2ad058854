//! Cheap methods against closed forms and the finer rungs.

use super::*;
use crate::atmosphere::Component;
use crate::phase::Phase;
use crate::transport::{Resolution, Solved};
use std::f64::consts::PI;
use tables::units::{EARTH_RADIUS_M, KM};
use tables::{Axis, Curve, Interpolation, Outside, Scale};

const EARTH: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

/// Molecules of a scale height of 8 km up to 100 km, of those vertical optical depths.
fn molecules<const L: usize>(depths: [f64; L]) -> Medium<L> {
    let nodes: Vec<f64> = (0..=100).map(|i| f64::from(i) * KM).collect();
    let density = nodes.iter().map(|z| (-z / (8.0 * KM)).exp()).collect();
    let axis = Axis::new("altitude", "m", nodes).expect("valid").between(Interpolation::Linear).beyond(Outside::Zero);
    let density = Curve::new(axis, Scale::Logarithmic, density).expect("positive");
    let scattering = depths.map(|depth| depth / (8.0 * KM));
    let phase = Phase::Rayleigh { gamma: [0.0; L] };
    Medium::new(vec![Component { density, scattering, absorption: [0.0; L], phase }], 100.0 * KM).expect("a medium")
}

fn towards(zenith_deg: f64, azimuth_deg: f64) -> DVec3 {
    crate::camera::direction_at(azimuth_deg.to_radians(), (90.0 - zenith_deg).to_radians())
}

fn cheap<const L: usize>(method: Method, medium: &Medium<L>, shape: Shape, albedo: f64, steps: u32) -> Cheap<L> {
    Cheap::new(method, medium, shape, [albedo; L], Some(steps)).expect("a cheap method")
}

const VIEWS: [(f64, f64); 5] = [(0.0, 0.0), (45.0, 30.0), (75.0, 180.0), (88.0, 90.0), (120.0, 45.0)];

#[test]
fn every_method_is_on_the_ladder_once() {
    let names: std::collections::BTreeSet<_> = LADDER.iter().map(|rung| rung.name).collect();
    assert_eq!(names.len(), LADDER.len());
    for rung in &LADDER {
        assert_eq!(Rung::of(rung.method), rung);
        let word = serde_json::to_string(&rung.method).expect("a word");
        assert_eq!(word, format!("\"{}\"", rung.name), "scene files call it so");
        assert_eq!(serde_json::from_str::<Method>(&word).expect("reads"), rung.method);
    }
}

#[test]
fn rungs_refuse_on_both_sides_of_their_ranges() {
    let day = Conditions { sun_elevation_deg: 30.0, altitude_km: 0.002, turbidity: 3.0, polarised: false, flat: false };
    let refusal = |method, asked| Rung::of(method).covers(&asked).expect_err("refused").to_string();
    for rung in &LADDER {
        assert_eq!(rung.covers(&day), Ok(()), "{}", rung.name);
    }
    for method in [Method::Oneil, Method::Preetham, Method::HosekWilkie, Method::Cie] {
        let at = |sun_elevation_deg| Conditions { sun_elevation_deg, ..day };
        assert!(Rung::of(method).covers(&at(0.0)).is_ok() && refusal(method, at(-0.1)).contains("0 to 90 degrees"));
        let at = |altitude_km| Conditions { altitude_km, ..day };
        assert!(Rung::of(method).covers(&at(1.0)).is_ok() && refusal(method, at(1.1)).contains("on the ground"));
    }
    for (method, low, high) in [(Method::Preetham, 2.0, 6.0), (Method::HosekWilkie, 1.0, 10.0)] {
        let at = |turbidity| Conditions { turbidity, ..day };
        assert!([low, high].iter().all(|&t| Rung::of(method).covers(&at(t)).is_ok()));
        assert!([low - 0.01, high + 0.01].iter().all(|&t| refusal(method, at(t)).contains("turbidities from")));
    }
    assert!(refusal(Method::Single, Conditions { polarised: true, ..day }).contains("polarisation"));
    assert!(refusal(Method::Solved, Conditions { flat: true, ..day }).contains("round planet"));
    assert!(refusal(Method::Perez, Conditions { sun_elevation_deg: 0.9, ..day }).contains("1 to 90"));
}

#[test]
fn single_scattering_between_planes_is_the_closed_form() {
    // From the ground, cosines mu of view and mu_s of the sun: L = P mu_s / (mu_s - mu) (e^(-tau/mu_s) - e^(-tau/mu)) (Chandrasekhar 1960). The midpoint rule
    // with 256 points leaves 1e-4.
    let medium = molecules([0.1, 0.4]);
    let single = cheap(Method::Single, &medium, Shape::Flat, 0.0, 256);
    let depth = medium.optical_depth(Shape::Flat, Place::above(0.0), DVec3::Z);
    let sun = towards(50.0, 0.0);
    for (zenith, azimuth) in [(0.0, 0.0), (30.0, 60.0), (70.0, 180.0)] {
        let direction = towards(zenith, azimuth);
        let found = single.radiance(Place::above(0.0), direction, sun);
        let phase = 3.0 / (16.0 * PI) * (1.0 + direction.dot(sun).powi(2));
        let (mu, mu_s) = (direction.z, sun.z);
        for j in 0..2 {
            let exact = phase * mu_s / (mu_s - mu) * ((-depth[j] / mu_s).exp() - (-depth[j] / mu).exp());
            assert!((found[j] / exact - 1.0).abs() < 2e-4, "{zenith}: {} for {exact}", found[j]);
        }
    }
}

#[test]
fn single_scattering_is_that_of_the_solved_tables() {
    // Another quadrature of the same integral, on a sphere, from the ground, from the middle of the air and from space.
    let medium = molecules([0.05, 0.3]);
    let single = cheap(Method::Single, &medium, EARTH, 0.3, 128);
    let other = Solved::single(&medium, EARTH, [0.3; 2]).expect("solved");
    for altitude in [2.0, 12.0 * KM, 400.0 * KM] {
        let from = Place::above(altitude);
        for (zenith, azimuth) in VIEWS.into_iter().chain([(107.5, 10.0), (160.0, 0.0)]) {
            let (direction, sun) = (towards(zenith, azimuth), towards(60.0, 0.0));
            let [a, b] = [single.radiance(from, direction, sun), other.radiance(from, direction, sun, true)];
            for j in 0..2 {
                assert!((a[j] - b[j]).abs() <= 1e-3 * b[j], "{altitude} m, {zenith} degrees: {} for {}", a[j], b[j]);
            }
        }
    }
}

#[test]
fn the_closure_of_thin_air_is_single_scattering_and_of_black_air_nothing_more() {
    let sun = towards(40.0, 0.0);
    let medium = molecules([1e-4]);
    let [single, closed] = [Method::Single, Method::Isotropic].map(|method| cheap(method, &medium, EARTH, 0.0, 32));
    for (zenith, azimuth) in &VIEWS[..4] {
        let direction = towards(*zenith, *azimuth);
        let [a, b] = [&single, &closed].map(|rung| rung.radiance(Place::above(2.0), direction, sun)[0]);
        // A second order of the optical depth along the horizon, 1e-4 x 20.
        assert!(b >= a && b / a - 1.0 < 2e-3, "{zenith}: {b} for {a}");
    }
}

#[test]
fn the_closure_comes_close_to_solved_tables_by_day() {
    // Molecules scatter nearly evenly, so it is within 7 % (worst at the horizon) where single scattering lacks up to half.
    let medium = molecules([0.1, 0.25]);
    let [single, closed] = [Method::Single, Method::Isotropic].map(|method| cheap(method, &medium, EARTH, 0.2, 64));
    let solved = Solved::new(&medium, EARTH, [0.2; 2], &Resolution::COARSE).expect("solved");
    let (from, sun) = (Place::above(2.0), towards(45.0, 0.0));
    let (mut off, mut lacking) = (0.0_f64, 0.0_f64);
    for (zenith, azimuth) in &VIEWS[..4] {
        let direction = towards(*zenith, *azimuth);
        let exact = solved.radiance(from, direction, sun, false);
        let [once, all] = [&single, &closed].map(|rung| rung.radiance(from, direction, sun));
        for j in 0..2 {
            off = off.max((all[j] / exact[j] - 1.0).abs());
            lacking = lacking.max(1.0 - once[j] / exact[j]);
        }
    }
    assert!(off < 0.08 && lacking > 0.2, "off by {off}, single scattering by {lacking}");
}

#[test]
fn oneils_planet_has_the_vertical_depths_of_the_air() {
    // Thin air seen at the zenith: P tau, but for the fit (1 - e^-0.00287) and for what his profile has above its top (e^-4); five points of
    // the midpoint rule over four scale heights leave 3 % more.
    let medium = molecules([1e-4]);
    let oneil = cheap(Method::Oneil, &medium, EARTH, 0.0, 64);
    let depth = medium.optical_depth(EARTH, Place::above(0.0), DVec3::Z)[0];
    let sun = towards(30.0, 0.0);
    let expected = 3.0 / (16.0 * PI) * (1.0 + sun.z * sun.z) * depth * (1.0 - (-4.0_f64).exp());
    let found = oneil.radiance(Place::above(2.0), DVec3::Z, sun)[0];
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} for {expected}");
    assert_eq!(oneil.radiance(Place::above(2.0), -DVec3::Z, sun), [0.0]);
}

#[test]
fn only_cheap_methods_are_made() {
    let medium = molecules([0.1]);
    for method in [Method::Solved, Method::Paths, Method::Judge, Method::Preetham] {
        assert!(Cheap::new(method, &medium, EARTH, [0.1], None).is_none());
    }
}
