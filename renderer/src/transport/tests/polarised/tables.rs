//! Solved tables of polarised light.

use super::*;
use crate::sampling::spiral;
use crate::transport::solved::{Panorama, Pixels, Resolution, Solved};

/// As fine as tests need.
const TEST: Resolution = Resolution { levels: 18, suns: 36, zeniths: [6, 4, 5], parts: 4, degree: 12, change: 2e-4 };

/// Observers, views and suns: by day, towards a low sun, in twilight and from space.
const VIEWS: [(f64, f64, f64, f64); 7] = [
    (2.0, 10.0, 0.0, 50.0),
    (2.0, 75.0, 120.0, 50.0),
    (2.0, 60.0, 250.0, 85.0),
    (3e3, 100.0, 40.0, 80.0),
    (1e6, 170.0, 60.0, 40.0),
    (1e6, 150.0, 100.0, 75.0),
    (2.0, 80.0, 30.0, 93.0),
];

/// A table of a medium over a ground.
fn table<const L: usize>(medium: &Medium<L>, albedo: f64, polarised: bool) -> Solved<L> {
    let new = if polarised { Solved::polarised } else { Solved::new };
    new(medium, EARTH, [albedo; L], &TEST).expect("round")
}

/// Largest distances of I, Q and U of a table from the path tracer, beyond so many of its standard errors, in shares of I.
fn beside_paths<const L: usize>(medium: &Medium<L>, paths: u32) -> [f64; 3] {
    let albedo = 0.3;
    let solved = table(medium, albedo, true);
    let columns = columns(medium, EARTH);
    let mut worst = [0.0_f64; 3];
    for (altitude, zenith, azimuth, sun_zenith) in VIEWS {
        let sun = SunDisc::beam(towards(sun_zenith, 0.0));
        let problem = sunlit((EARTH, medium), &columns, albedo, &sun);
        let (from, direction) = (Place::above(altitude), towards(zenith, azimuth));
        let found = solved.stokes(from, direction, level(direction), sun.direction(), false);
        let means = means(Estimator::Paths, &problem, from, direction, paths, 5);
        for (found, means) in found.iter().zip(means) {
            let radiance = means[0].0;
            for (k, (found, (mean, error))) in [found.i, found.q, found.u].into_iter().zip(means).enumerate() {
                assert!(
                    error < 8e-3 * radiance,
                    "{zenith}, sun {sun_zenith}, {k}: {error:e} of {radiance:e} tests nothing"
                );
                worst[k] = worst[k].max(((found - mean).abs() - 4.0 * error) / radiance);
            }
        }
    }
    worst
}

#[test]
fn tables_of_molecules_agree_with_paths() {
    // What the grid of this test leaves beyond 4 standard errors.
    let worst = beside_paths(&air(0.015), 20_000);
    assert!(worst.into_iter().all(|off| off < 2e-3), "{worst:?}");
}

#[test]
fn tables_with_particles_agree_with_paths_but_for_what_particles_scatter_again() {
    // Particles of optical depth 0.2 that polarise sunlight by 60 %, more than real ones: of what they scatter again degree 2 is kept alone.
    let worst = beside_paths(&hazy(), 20_000);
    assert!(worst[0] < 1e-2 && worst[1].max(worst[2]) < 3e-2, "{worst:?}");
}

#[test]
fn without_polarisation_a_polarised_table_is_a_scalar_one() {
    // Molecules with gamma = 1 scatter alike in all directions and polarise nothing; particles without a matrix leave nothing polarised.
    let top = 6e4;
    let component = |height: f64, scattering: f64, phase: Phase<1>| Component {
        density: super::exponential(height, top),
        scattering: [scattering],
        absorption: [0.0],
        phase,
    };
    let isotropic = || component(8e3, 3e-5, rayleigh(1.0));
    let particles = component(1.5e3, 1e-4, Phase::HenyeyGreenstein { g: [0.6] });
    for components in [vec![isotropic()], vec![isotropic(), particles]] {
        let medium = medium(components, top);
        let [scalar, vector] = [false, true].map(|polarised| table(&medium, 0.3, polarised));
        for (altitude, zenith, azimuth, sun_zenith) in VIEWS {
            let (from, direction, sun) = (Place::above(altitude), towards(zenith, azimuth), towards(sun_zenith, 0.0));
            let [right] = scalar.radiance(from, direction, sun, false);
            let [found] = vector.stokes(from, direction, level(direction), sun, false);
            // Single precision, and degree 2 of the particles where they are too few to count (found: 4e-6).
            assert!((found.i / right - 1.0).abs() < 2e-5, "{zenith}: {:e}, {right:e}", found.i);
            assert!(found.polarised() < 1e-6 * right, "{zenith}: {found:?}");
        }
    }
}

#[test]
fn thin_air_polarises_by_the_law_of_one_scattering() {
    // Optical depth 8e-4: further orders are some 1e-3 of the light. Across the plane of scattering (1 - c^2) / (1 + c^2).
    let density = super::exponential(8e3, 6e4);
    let thin = Component { density, scattering: [1e-7], absorption: [0.0], phase: rayleigh(0.0) };
    let solved = table(&medium(vec![thin], 6e4), 0.0, true);
    for (zenith, azimuth, sun_zenith) in [(0.0, 0.0, 60.0), (40.0, 60.0, 30.0), (70.0, 200.0, 50.0), (85.0, 90.0, 80.0)]
    {
        let (direction, sun) = (towards(zenith, azimuth), towards(sun_zenith, 0.0));
        let c = direction.dot(sun);
        let frame = Frame::new(direction, direction.cross(sun).normalize());
        let [found] = solved.stokes(Place::above(2.0), direction, frame, sun, false);
        let law = (1.0 - c * c) / (1.0 + c * c);
        assert!(
            (found.q / found.i - law).abs() < 4e-3 && (found.u / found.i).abs() < 4e-3,
            "{zenith}: {found:?}, {law}"
        );
    }
}

#[test]
fn a_table_has_no_more_polarised_light_than_light() {
    for (i, solved) in [table(&air(0.0), 0.0, true), table(&air(0.0), 0.8, true)].iter().enumerate() {
        for k in 0..400 {
            let direction = spiral(k, 400, [-1.0, 1.0]);
            for sun_zenith in [0.0, 60.0, 89.0, 95.0] {
                let frame = Frame::new(direction, direction.any_orthonormal_vector());
                let [seen] = solved.stokes(Place::above(2.0), direction, frame, towards(sun_zenith, 0.0), false);
                assert!(seen.polarised() <= seen.i, "table {i}, sun {sun_zenith}: {seen:?}");
            }
        }
    }
}

#[test]
fn at_the_zenith_light_does_not_depend_on_the_frame() {
    // A thousandth of a degree off the zenith, in any direction, and at it.
    let solved = table(&air(0.015), 0.3, true);
    let sun = towards(80.0, 0.0);
    let look = |zenith: f64, azimuth: f64| {
        let direction = towards(zenith, azimuth);
        let first = (DVec3::Y - direction * direction.y).normalize();
        solved.stokes(Place::above(2.0), direction, Frame::new(direction, first), sun, false)[0]
    };
    let at = look(0.0, 0.0);
    assert!(at.degree() > 0.3);
    for azimuth in [0.0, 50.0, 170.0, 300.0] {
        let off = look(1e-3, azimuth);
        let far = (off.i - at.i).abs().max((off.q - at.q).abs()).max((off.u - at.u).abs());
        assert!(far < 2e-4 * at.i, "{azimuth}: {off:?}, {at:?}");
    }
}

#[test]
fn a_panorama_shows_stokes_parameters() {
    // Nodes were left out where they are right to 5e-4 of I: elsewhere no worse than four times that.
    let solved = table(&hazy(), 0.3, true);
    let mut all: Vec<_> = (0..400).map(|i| spiral(i, 400, [-1.0, 1.0])).collect();
    all.push(DVec3::Z);
    for (altitude, sun_zenith) in [(2.0, 50.0), (2.0, 92.0), (4e5, 60.0)] {
        let (from, sun) = (Place::above(altitude), towards(sun_zenith, 30.0));
        let seen = Panorama::new(&solved, from, sun, 5e-4, Pixels { directions: &all, each: 1000 });
        let mut polarised = 0.0_f64;
        for &direction in &all {
            let frame = Frame::new(direction, direction.any_orthonormal_vector());
            let right = solved.stokes(from, direction, frame, sun, false);
            for (found, right) in seen.stokes(&solved, direction, frame).into_iter().zip(right) {
                let off = (found.i - right.i).abs().max((found.q - right.q).abs()).max((found.u - right.u).abs());
                assert!(off <= 2e-3 * right.i, "{altitude}, {direction}: {found:?}, {right:?}");
                polarised = polarised.max(right.degree());
            }
        }
        assert!(polarised > 0.3 && seen.looks() > 500, "{polarised}, {}", seen.looks());
    }
}
