use super::*;
use std::f64::consts::PI;

fn index(n: f64, k: f64) -> RefractiveIndex {
    RefractiveIndex::new(n, k).expect("a refractive index")
}

fn efficiencies(n: f64, k: f64, x: f64) -> Efficiencies {
    Solver::new().sphere(index(n, k), x).expect("in range").efficiencies()
}

#[test]
fn what_is_no_sphere_is_refused() {
    for (n, k) in [(0.0, 0.0), (-1.0, 0.0), (1.5, -0.1), (f64::NAN, 0.0), (1.5, f64::INFINITY)] {
        assert!(matches!(RefractiveIndex::new(n, k), Err(MieError::Index { .. })), "{n} + {k}i");
    }
    assert!(RefractiveIndex::new(1.5, -0.1).expect_err("k < 0").to_string().contains("k must not be negative"));
    let mut solver = Solver::new();
    for x in [0.0, -1.0, 9e-7, 1.1e6, f64::NAN, f64::INFINITY] {
        assert!(matches!(solver.sphere(index(1.5, 0.0), x), Err(MieError::Size { .. })), "x = {x}");
    }
    assert!(matches!(solver.sphere(index(11.0, 0.0), 1e6), Err(MieError::Inside { .. })));
    let sphere = solver.sphere(index(1.5, 0.0), 1.0).expect("in range");
    assert!(sphere.amplitudes(1.0 + 1e-15).is_err() && sphere.amplitudes(f64::NAN).is_err());
}

#[test]
fn a_sphere_of_its_surroundings_scatters_nothing() {
    let q = efficiencies(1.0, 0.0, 10.0);
    assert_eq!((q.extinction, q.scattering, q.absorption, q.backscatter), (0.0, 0.0, 0.0, 0.0));
    assert!(q.asymmetry.is_nan());
}

#[test]
fn without_absorption_extinction_is_scattering() {
    for (n, x) in [(1.33, 1e-6), (1.5, 0.3), (0.75, 10.0), (1.33, 1e3), (10.0, 50.0)] {
        let q = efficiencies(n, 0.0, x);
        assert!(q.absorption == 0.0 && q.extinction == q.scattering, "n = {n}, x = {x}: {q:?}");
    }
}

#[test]
fn weak_absorption_is_proportional_to_k() {
    // The first order in k; the second is 2 k x of it or less.
    for x in [0.01, 1.0, 20.0] {
        let (a, b) = (efficiencies(1.45, 1e-11, x).absorption, efficiencies(1.45, 1e-10, x).absorption);
        assert!((b / a - 10.0).abs() < 1e-7, "x = {x}: {b} over {a}");
    }
}

#[test]
fn extinction_is_the_forward_amplitude() {
    // Optical theorem: Qext = 4 / x^2 Re S(0).
    for (n, k, x) in [(1.33, 0.0, 3.0), (1.5, 0.1, 100.0), (0.2, 3.4, 5.0), (10.0, 10.0, 1e3), (1.55, 0.5, 0.01)] {
        let mut solver = Solver::new();
        let sphere = solver.sphere(index(n, k), x).expect("in range");
        let forward = sphere.amplitudes(1.0).expect("a cosine");
        let theorem = 4.0 / (x * x) * forward.s1.re;
        let q = sphere.efficiencies().extinction;
        // Rounding of sums of up to a thousand terms.
        assert!((theorem / q - 1.0).abs() < 1e-13 && forward.s1 == forward.s2, "{n} + {k}i, {x}: {theorem}, {q}");
    }
}

#[test]
fn the_scattered_light_adds_up_and_has_the_asymmetry_of_the_series() {
    // The intensity is a polynomial of degree 2N + 2 at most in the cosine: Gauss-Legendre is exact.
    for (n, k, x) in [(1.5, 0.01, 0.1), (1.33, 0.0, 10.0), (1.53, 0.0078, 60.0), (2.0, 1.0, 25.0)] {
        let mut solver = Solver::new();
        let sphere = solver.sphere(index(n, k), x).expect("in range");
        let q = sphere.efficiencies();
        let (mut whole, mut mean) = (0.0, 0.0);
        for (cosine, weight) in gauss_legendre(terms(x) + 4) {
            let s = sphere.amplitudes(cosine).expect("a cosine");
            let intensity = 0.5 * (s.s1.norm_sqr() + s.s2.norm_sqr());
            whole += weight * intensity;
            mean += weight * intensity * cosine;
        }
        // C_sca = 2 pi / k^2 times the integral; Q = C / (pi a^2).
        let scattering = 2.0 / (x * x) * whole;
        assert!((scattering / q.scattering - 1.0).abs() < 1e-12, "{n} + {k}i, {x}: {scattering}, {}", q.scattering);
        assert!((mean / whole - q.asymmetry).abs() < 1e-12, "{n} + {k}i, {x}: g {}, {}", mean / whole, q.asymmetry);
    }
}

#[test]
fn a_small_sphere_is_a_dipole() {
    // Rayleigh: Qsca = 8/3 x^4 |(m^2 - 1)/(m^2 + 2)|^2, Qabs = 4 x Im((m^2 - 1)/(m^2 + 2)), g of the order of x^2.
    for (n, k) in [(1.5, 0.0), (1.5, 0.1), (0.75, 0.0), (3.0, 2.0)] {
        let m2 = index(n, k).to_complex().powi(2);
        let factor = (m2 - 1.0) / (m2 + 2.0);
        let x: f64 = 1e-4;
        let q = efficiencies(n, k, x);
        // The next order is of the order |m|^2 x^2 relative.
        let tolerance = 20.0 * x * x;
        assert!(
            (q.scattering / (8.0 / 3.0 * x.powi(4) * factor.norm_sqr()) - 1.0).abs() < tolerance,
            "{n} + {k}i: {q:?}"
        );
        assert!((q.absorption - 4.0 * x * factor.im).abs() <= tolerance * q.absorption, "{n} + {k}i: {q:?}");
        assert!(q.asymmetry.abs() < 10.0 * x * x, "{n} + {k}i: {q:?}");
    }
}

#[test]
fn a_large_sphere_takes_out_twice_its_shadow() {
    // Q = 2 + 1.9924 x^(-2/3) for an absorber (Nussenzveig & Wiscombe 1980); the next term is of the order 1/x.
    let x: f64 = 1e4;
    let q = efficiencies(1.5, 0.1, x).extinction;
    assert!((q - 2.0 - 1.9924 * x.powf(-2.0 / 3.0)).abs() < 1.0 / x, "{q}");
}

/// Sizes on both sides of all that is decided by the size: upward recurrence, vectors, doubled precision.
fn sizes() -> Vec<f64> {
    (0..97).map(|i| 1e-3 * 1.17_f64.powi(i)).chain([1e-6, 1.999, 2.0, 2000.0, 2000.1]).collect()
}

#[test]
fn every_instruction_set_gives_what_single_spheres_do() {
    let mut single = Solver::new();
    for instructions in Instructions::available() {
        let mut many = Spheres::with(instructions);
        for (n, k) in [(1.5, 0.01), (1.33, 0.0), (0.75, 1e-6), (1.0001, 0.0), (10.0, 10.0), (0.1, 4.0)] {
            let found = many.efficiencies(index(n, k), &sizes()).expect("in range");
            for (x, q) in sizes().into_iter().zip(found) {
                let expected = single.sphere(index(n, k), x).expect("in range").efficiencies();
                let pairs = [
                    (q.extinction, expected.extinction),
                    (q.scattering, expected.scattering),
                    (q.asymmetry, expected.asymmetry),
                ];
                // Rounding, which the ripple of clear spheres passes on x times enlarged.
                let tolerance = 1e-13 + 2e-15 * x;
                for (found, expected) in pairs {
                    let sound = (found - expected).abs() <= tolerance * expected.abs();
                    assert!(sound, "{instructions}, {n} + {k}i, x = {x}: {found}, {expected}");
                }
                assert!((q.absorption - expected.absorption).abs() <= tolerance * expected.absorption);
                let back = (q.backscatter - expected.backscatter).abs() <= 100.0 * tolerance * expected.backscatter;
                assert!(back, "{instructions}, {n} + {k}i, x = {x}: {q:?}, {expected:?}");
            }
        }
    }
}

#[test]
fn sums_over_spheres_are_those_of_the_spheres() {
    let m = index(1.53, 0.008);
    let cosines: Vec<f64> = (0..=30).map(|i| (6.0 * f64::from(i)).to_radians().cos()).collect();
    let spheres: Vec<(f64, f64)> = (0..30).map(|i| (0.05 * 1.33_f64.powi(i), 1.0 + f64::from(i % 3))).collect();
    let angles = AngularTable::new(&cosines, terms(200.0)).expect("cosines");
    let mut solver = Solver::new();
    let mut expected = Sums::zero(cosines.len());
    for &(x, weight) in &spheres {
        let sphere = solver.sphere(m, x).expect("in range");
        let q = sphere.efficiencies();
        let s = cosines.iter().map(|c| sphere.amplitudes(*c).expect("a cosine"));
        let (one, two): (Vec<_>, Vec<_>) = s.map(|s| (s.s1, s.s2)).unzip();
        let element = |f: fn(Complex64, Complex64) -> f64| one.iter().zip(&two).map(|(a, b)| f(*a, *b)).collect();
        let area = PI * x * x;
        let one = Sums {
            extinction: area * q.extinction,
            scattering: area * q.scattering,
            absorption: area * q.absorption,
            forward: area * q.scattering * q.asymmetry,
            backscatter: area * q.backscatter,
            matrix: [
                element(|a, b| 0.5 * (a.norm_sqr() + b.norm_sqr())),
                element(|a, b| 0.5 * (b.norm_sqr() - a.norm_sqr())),
                element(|a, b| (a * b.conj()).re),
                element(|a, b| (b * a.conj()).im),
            ],
        };
        expected.add(&one, weight);
    }
    for instructions in Instructions::available() {
        let mut many = Spheres::with(instructions);
        let sums = many.sum(m, spheres.iter().copied(), &angles).expect("in range");
        for (found, expected) in [
            (sums.extinction, expected.extinction),
            (sums.absorption, expected.absorption),
            (sums.forward, expected.forward),
            (sums.backscatter, expected.backscatter),
        ] {
            // Other orders of sums and roundings, a hundred times 1e-16 and in the backward amplitude more.
            assert!((found / expected - 1.0).abs() < 1e-12, "{instructions}: {found} against {expected}");
        }
        for (found, expected) in sums.matrix.iter().zip(&expected.matrix) {
            for (j, (found, expected)) in found.iter().zip(expected).enumerate() {
                // S1 and S2 are half the sum and difference of S+ and S-: errors are relative to the intensity.
                let close = (found - expected).abs() < 1e-12 * sums.intensity()[j];
                assert!(close, "{instructions}, angle {j}: {found} against {expected}");
            }
        }
        let error = many.sum(m, [(300.0, 1.0)], &angles).expect_err("a table that is too small");
        assert!(matches!(error, MieError::Terms { needed, available } if needed > available));
    }
}

#[test]
fn spheres_solved_one_by_one_are_summed_in_their_lanes() {
    // More than a vector holds, and one left over, beyond the size of vectors and with an index near 1.
    let cosines: Vec<f64> = (0..=12).map(|i| (15.0 * f64::from(i)).to_radians().cos()).collect();
    let angles = AngularTable::new(&cosines, terms(2100.0)).expect("cosines");
    for (m, first, step) in [(index(1.33, 0.01), 2001.0, 11.0), (index(1.0001, 1e-5), 0.1, 100.0)] {
        let spheres: Vec<(f64, f64)> = (0..9).map(|i| (first + step * f64::from(i), 1.0 + f64::from(i))).collect();
        let mut solver = Solver::new();
        let mut expected = vec![0.0; cosines.len()];
        for &(x, weight) in &spheres {
            let sphere = solver.sphere(m, x).expect("in range");
            for (sum, c) in expected.iter_mut().zip(&cosines) {
                let s = sphere.amplitudes(*c).expect("a cosine");
                *sum += 0.5 * weight * (s.s1.norm_sqr() + s.s2.norm_sqr());
            }
        }
        for instructions in Instructions::available() {
            let sums = Spheres::with(instructions).sum(m, spheres.iter().copied(), &angles).expect("in range");
            for (j, (found, expected)) in sums.intensity().iter().zip(&expected).enumerate() {
                // Terms as large as n cancel to amplitudes of some hundreds: roundings are enlarged some thousand times.
                assert!((found / expected - 1.0).abs() < 1e-10, "{instructions}, {m:?}, {j}: {found}, {expected}");
            }
        }
    }
}

#[test]
fn a_scattering_matrix_of_one_sphere_is_pure() {
    // S11^2 = S12^2 + S33^2 + S34^2 (Bohren & Huffman 1983, section 4.4.1).
    let cosines: Vec<f64> = (0..=36).map(|i| (5.0 * f64::from(i)).to_radians().cos()).collect();
    let angles = AngularTable::new(&cosines, terms(30.0)).expect("cosines");
    let sums = Spheres::new().sum(index(1.4, 0.02), [(30.0, 1.0)], &angles).expect("in range");
    for j in 0..cosines.len() {
        let [s11, s12, s33, s34] = [0, 1, 2, 3].map(|i| sums.matrix[i][j]);
        let sum = s12 * s12 + s33 * s33 + s34 * s34;
        assert!((sum / (s11 * s11) - 1.0).abs() < 1e-13, "angle {j}: {sum}, {s11}");
    }
}

#[test]
fn many_spheres_come_back_in_their_order_and_bad_ones_are_named() {
    let mut many = Spheres::new();
    let found = many.efficiencies(index(1.5, 0.0), &[3.0, 0.5, 2500.0, 0.5]).expect("in range");
    assert!(found[1] == found[3] && found[0].extinction > found[1].extinction, "{found:?}");
    assert!(many.efficiencies(index(1.5, 0.0), &[]).expect("nothing to do").is_empty());
    let error = many.efficiencies(index(1.5, 0.0), &[1.0, -3.0]).expect_err("no size");
    assert_eq!(error, MieError::Size { x: -3.0 });
    assert!(matches!(many.efficiencies(index(1e4, 0.0), &[2e3]), Err(MieError::Inside { .. })));
    let same = many.efficiencies(index(1.0, 0.0), &[1.0]).expect("in range")[0];
    assert!(same.extinction == 0.0 && same.asymmetry.is_nan());
}

#[test]
fn a_solver_remembers_nothing_of_the_sphere_before() {
    let mut solver = Solver::new();
    let first = solver.sphere(index(1.33, 0.0), 500.0).expect("in range").efficiencies();
    let _ = solver.sphere(index(1.5, 0.3), 3.0).expect("in range");
    assert_eq!(solver.sphere(index(1.33, 0.0), 500.0).expect("in range").efficiencies(), first);
}
