//! Against fields of dipoles, component by component.

use super::*;
use crate::sampling::{Sampler, around};

/// A complex vector: a field's amplitude.
type Field = [DVec3; 2];

/// Stokes parameters of a fully polarised field, from its components along e1 and e2, and V.
fn stokes([re, im]: Field, e1: DVec3, e2: DVec3) -> [f64; 4] {
    let ([a, b], [c, d]) = ([re.dot(e1), im.dot(e1)], [re.dot(e2), im.dot(e2)]);
    let (one, two) = (a * a + b * b, c * c + d * d);
    [one + two, one - two, 2.0 * (a * c + b * d), 2.0 * (b * c - a * d)]
}

fn direction(sampler: &mut Sampler) -> DVec3 {
    let [u, v] = sampler.uniform_2d();
    around(DVec3::Z, 2.0 * u - 1.0, v)
}

/// A direction, and both axes of a frame of it.
fn frame(sampler: &mut Sampler) -> (DVec3, DVec3, DVec3) {
    let d = direction(sampler);
    let e1 = around(d, 0.0, sampler.uniform());
    (d, e1, d.cross(e1))
}

fn field(sampler: &mut Sampler, e1: DVec3, e2: DVec3) -> Field {
    let [a, b, c, d] = sampler.four().map(|u| 2.0 * u - 1.0);
    [e1 * a + e2 * b, e1 * c + e2 * d]
}

/// The rows of an analyser times Stokes parameters.
fn seen(analyser: &Analyser, light: [f64; 4]) -> [f64; 3] {
    analyser.rows.map(|row| row.iter().zip(light).map(|(m, s)| m * s).sum())
}

#[track_caller]
fn close<const N: usize>(found: [f64; N], expected: [f64; N], tolerance: f64) {
    for (a, b) in found.iter().zip(expected) {
        assert!((a - b).abs() < tolerance, "{found:?}, must be {expected:?}");
    }
}

/// Spheres of a kind: P12^2 + P33^2 + P34^2 = P11^2, P12 = P34 = 0 and P33 = +-P11 straight on and back.
fn spheres(c: f64) -> Scattering {
    let p12 = 0.6 * (c * c - 1.0);
    let rest = (1.0 - p12 * p12).sqrt();
    let p11 = (1.0 + 0.8 * c) / (4.0 * PI);
    Scattering::of_spheres(p11, [p12, rest * c, rest * (1.0 - c * c).max(0.0).sqrt()].map(|ratio| ratio * p11))
}

#[test]
fn molecules_without_depolarisation_polarise_by_their_law() {
    for i in 0..=20 {
        let c = f64::from(i) / 10.0 - 1.0;
        let Natural { a1, b1 } = Scattering::rayleigh(0.0, c).natural();
        // Rounding: a few units of the last place of 1.
        assert!((-b1 / a1 - (1.0 - c * c) / (1.0 + c * c)).abs() < 1e-15, "{c}: {}", -b1 / a1);
    }
}

#[test]
fn depolarisation_is_the_ratio_of_the_two_components_at_a_right_angle() {
    for rho in [0.0, 0.0279, 0.1, 0.5] {
        let Natural { a1, b1 } = Scattering::rayleigh(rho / (2.0 - rho), 0.0).natural();
        // In the plane over perpendicular to it.
        assert!(((a1 + b1) / (a1 - b1) - rho).abs() < 1e-15, "{rho}");
    }
}

#[test]
fn a_frame_turns_as_the_components_of_a_field_do() {
    let mut sampler = Sampler::new(1, 0, 0);
    for _ in 0..50 {
        let (d, e1, e2) = frame(&mut sampler);
        let before = direction(&mut sampler);
        let light = field(&mut sampler, e1, e2);
        let (turn, plane) = Frame::new(d, e1).of_scattering(d, before);
        // The isotropic matrix of ones leaves light as it is but for the turn, so the analyser is the turn back.
        let one = Scattering { a1: 1.0, a2: 1.0, a3: 1.0, a4: 1.0, b1: 0.0, b2: 0.0 };
        let analyser = Analyser::OBSERVER.scattered(turn, &one);
        let [i, q, u, v] = stokes(light, e1, e2);
        let turned = stokes(light, plane.e2.cross(d), plane.e2);
        close(seen(&analyser, turned), [i, q, u], 1e-13);
        assert!((turned[3] - v).abs() < 1e-13);
        assert!(plane.e2.dot(d).abs() < 1e-14 && plane.e2.dot(before).abs() < 1e-14, "no plane of scattering");
        // The same plane again: no turn; straight on: none either.
        let (none, same) = plane.of_scattering(d, before);
        assert!((none.cos - 1.0).abs() < 1e-14 && none.sin.abs() < 1e-14 && same == plane);
        assert_eq!(plane.of_scattering(d, -d), (Turn { cos: 1.0, sin: 0.0 }, plane));
    }
}

#[test]
fn two_turns_are_the_turn_of_their_sum() {
    // cos and sin of 2 eta multiply as complex numbers do.
    let mut sampler = Sampler::new(2, 0, 0);
    for _ in 0..50 {
        let (d, e1, _) = frame(&mut sampler);
        let (one, other) = (direction(&mut sampler), direction(&mut sampler));
        let start = Frame::new(d, e1);
        let (a, middle) = start.of_scattering(d, one);
        let (b, end) = middle.of_scattering(d, other);
        let (both, straight) = start.of_scattering(d, other);
        assert_eq!(end, straight);
        let product = [a.cos * b.cos - a.sin * b.sin, a.sin * b.cos + a.cos * b.sin];
        close(product, [both.cos, both.sin], 1e-13);
    }
}

/// Directions of the vertices of an icosahedron, half of them: means over these axes are those over the sphere for
/// polynomials up to the fifth degree.
fn axes() -> [DVec3; 6] {
    let golden = 0.5 * (1.0 + 5.0_f64.sqrt());
    [(1.0, golden), (1.0, -golden)]
        .map(|(a, b)| [DVec3::new(0.0, a, b), DVec3::new(a, b, 0.0), DVec3::new(b, 0.0, a)])
        .concat()
        .try_into()
        .map(|axes: [DVec3; 6]| axes.map(DVec3::normalize))
        .expect("six")
}

#[test]
fn chains_of_molecules_scatter_as_dipoles_of_every_orientation() {
    // A molecule is a polarisability s + t n n about an axis n: it radiates the part of s E + t n (n . E) across the
    // direction. Its matrix is the mean over n of Stokes parameters, of the fourth degree in n.
    let mut sampler = Sampler::new(3, 0, 0);
    for (s, t) in [(1.0, 0.0), (1.0, 0.4), (0.6, -0.5), (0.0, 1.0)] {
        // Natural light along z, seen along x: the component in the plane of scattering is along z.
        let response = |field: DVec3, n: DVec3| field * s + n * (t * n.dot(field));
        let power = |along: DVec3| {
            let of = |field: DVec3| axes().iter().map(|&n| response(field, n).dot(along).powi(2)).sum::<f64>();
            of(DVec3::X) + of(DVec3::Y)
        };
        let rho = power(DVec3::Z) / power(DVec3::Y);
        let gamma = rho / (2.0 - rho);
        // All that is scattered: 8 pi / 3 of the mean square of the dipole.
        let total: f64 = 8.0 * PI / 3.0 * axes().iter().map(|&n| response(DVec3::X, n).length_squared()).sum::<f64>();
        for _ in 0..10 {
            let (d, e1, e2) = frame(&mut sampler);
            let (first, second) = (direction(&mut sampler), direction(&mut sampler));
            let [before1, before2] = [around(second, 0.0, 0.1), around(second, 0.0, 0.1).cross(second)];
            let light = field(&mut sampler, before1, before2);
            let mut expected = [0.0; 3];
            for a in axes() {
                for b in axes() {
                    let scatter = |field: Field, n: DVec3, towards: DVec3| {
                        field.map(|part| response(part, n)).map(|part| part - towards * towards.dot(part))
                    };
                    let out = scatter(scatter(light, a, first), b, d);
                    let [i, q, u, _] = stokes(out, e1, e2);
                    for (sum, s) in expected.iter_mut().zip([i, q, u]) {
                        *sum += s / (total * total);
                    }
                }
            }
            let (turn, plane) = Frame::new(d, e1).of_scattering(d, first);
            let analyser = Analyser::OBSERVER.scattered(turn, &Scattering::rayleigh(gamma, d.dot(first)));
            let (turn, plane) = plane.of_scattering(first, second);
            let analyser = analyser.scattered(turn, &Scattering::rayleigh(gamma, first.dot(second)));
            let found = seen(&analyser, stokes(light, plane.e2.cross(second), plane.e2));
            // Sums of 36 terms of order 0.1; rounding.
            close(found, expected, 1e-13);
        }
    }
}

#[test]
fn no_chain_makes_more_polarised_light_than_light() {
    let mut sampler = Sampler::new(4, 0, 0);
    for chain in 0..200 {
        let (mut d, e1, _) = frame(&mut sampler);
        let mut plane = Frame::new(d, e1);
        let mut analyser = Analyser::OBSERVER;
        for _ in 0..1 + chain % 6 {
            let before = direction(&mut sampler);
            let (turn, next) = plane.of_scattering(d, before);
            let c = d.dot(before);
            let rayleigh = Scattering::rayleigh(0.3 * sampler.uniform(), c);
            analyser = analyser.scattered(turn, &(spheres(c) * sampler.uniform() + rayleigh));
            (d, plane) = (before, next);
        }
        let seen = analyser.natural(1.0);
        assert!(seen.polarised() <= seen.i * (1.0 + 1e-12), "{seen:?}");
        let most = analyser.rows.iter().flatten().fold(0.0, |most: f64, m| most.max(m.abs()));
        assert!(most <= analyser.intensity() * (1.0 + 1e-12), "{analyser:?}");
    }
}

#[test]
fn light_scattered_once_is_the_first_column() {
    let mut sampler = Sampler::new(5, 0, 0);
    let (d, e1, _) = frame(&mut sampler);
    let (first, sun) = (direction(&mut sampler), direction(&mut sampler));
    let (turn, plane) = Frame::new(d, e1).of_scattering(d, first);
    let analyser = Analyser::OBSERVER.scattered(turn, &spheres(d.dot(first)));
    let (turn, _) = plane.of_scattering(first, sun);
    let matrix = spheres(first.dot(sun));
    let (whole, short) =
        (analyser.scattered(turn, &matrix).natural(2.0), analyser.once_scattered(turn, matrix.natural(), 2.0));
    close([short.i, short.q, short.u], [whole.i, whole.q, whole.u], 1e-15);
}

#[test]
fn a_ground_keeps_no_polarisation() {
    let analyser = Analyser::OBSERVER.reflected(0.3);
    assert_eq!(seen(&analyser, [1.0, 0.5, -0.2, 0.1]), [0.3, 0.0, 0.0]);
}

#[test]
fn matrices_a_little_beyond_what_is_possible_are_brought_back() {
    // Spheres of one size are at the limit, 0.36^2 + 0.48^2 + 0.8^2 = 1.
    let limit = Scattering::of_spheres(1.0, [0.36, 0.48, 0.8]);
    let within = limit.possible().expect("possible");
    assert!((within.b2 - limit.b2).abs() < 1e-15 && (within.a2 - limit.a2).abs() < 1e-15, "{within:?}");
    let beyond = Scattering::of_spheres(1.0, [0.3618, 0.4824, 0.804]);
    let back = beyond.possible().expect("nearly possible");
    // 2 f 1.005 = 1 + f.
    assert!(
        (back.a2 - 1.0 / 1.01).abs() < 1e-14 && back.a1 == 1.0 && (back.b1 / back.b2 - 0.45).abs() < 1e-14,
        "{back:?}"
    );
    assert!(Scattering::of_spheres(1.0, [0.9, 0.9, 0.0]).possible().is_none());
    assert!(Scattering { a2: 0.9, a3: 0.9, a4: -0.5, ..Scattering::depolarising(1.0) }.possible().is_none());
    for c in [-1.0, -0.3, 0.0, 0.8, 1.0] {
        for gamma in [0.0, 0.015, 0.5] {
            let molecules = Scattering::rayleigh(gamma, c);
            assert!(molecules.possible().is_some_and(|m| (m.a2 - molecules.a2).abs() < 1e-15), "{molecules:?}");
        }
    }
}

#[test]
fn a_filter_follows_the_law_of_malus() {
    for angle_deg in [0.0, 30.0, 90.0, 135.0, 179.0] {
        let (sin, cos) = f64::to_radians(2.0 * angle_deg).sin_cos();
        let light = Stokes { i: 3.0, q: 2.0 * cos, u: 2.0 * sin };
        assert!((light.degree() - 2.0 / 3.0).abs() < 1e-14 && (light.angle_deg() - angle_deg).abs() < 1e-12);
        for turn in [0.0, 20.0, 45.0, 90.0] {
            // Half of the natural part, and cos^2 of the polarised one.
            let expected = 0.5 + 2.0 * f64::to_radians(turn).cos().powi(2);
            assert!((light.through(f64::to_radians(angle_deg + turn)) - expected).abs() < 1e-14);
        }
    }
    assert_eq!((Stokes::default().degree(), Stokes::default().angle_deg()), (0.0, 0.0));
    // A hair below e1 is e1.
    assert_eq!(Stokes { i: 1.0, q: 1.0, u: -1e-40 }.angle_deg(), 0.0);
}
