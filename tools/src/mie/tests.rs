use super::*;
use std::f64::consts::PI;

fn index(n: f64, k: f64) -> RefractiveIndex {
    RefractiveIndex::new(n, k).expect("a refractive index")
}

fn efficiencies(n: f64, k: f64, x: f64) -> Efficiencies {
    Solver::new().sphere(index(n, k), x).expect("in range").efficiencies()
}

/// Nodes and weights of Gauss-Legendre quadrature on -1..1, by Newton's method on P_n.
fn gauss_legendre(n: usize) -> Vec<(f64, f64)> {
    let node = |i: usize| {
        let mut x = (PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut p, mut previous) = (1.0, 0.0);
            for k in 0..n {
                let k = k as f64;
                (p, previous) = (((2.0 * k + 1.0) * x * p - k * previous) / (k + 1.0), p);
            }
            slope = n as f64 * (x * p - previous) / (x * x - 1.0);
            x -= p / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..n).map(node).collect()
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

#[test]
fn sums_over_spheres_are_those_of_the_spheres() {
    let m = index(1.53, 0.008);
    let cosines = [-1.0, -0.3, 0.0, 0.2, 0.9, 0.99, 1.0];
    let spheres: Vec<(f64, f64)> = (0..21).map(|i| (0.05 * 1.5_f64.powi(i), 1.0 + f64::from(i % 3))).collect();
    let angles = AngularTable::new(&cosines, terms(200.0)).expect("cosines");
    let sums = sum(m, spheres.iter().copied(), &angles, &mut Solver::new()).expect("in range");
    let mut solver = Solver::new();
    let mut expected = Sums::zero(cosines.len());
    for &(x, weight) in &spheres {
        let sphere = solver.sphere(m, x).expect("in range");
        let q = sphere.efficiencies();
        let intensity = |c: &f64| {
            let s = sphere.amplitudes(*c).expect("a cosine");
            0.5 * (s.s1.norm_sqr() + s.s2.norm_sqr())
        };
        let one = Sums {
            extinction: PI * x * x * q.extinction,
            scattering: PI * x * x * q.scattering,
            absorption: PI * x * x * q.absorption,
            forward: PI * x * x * q.scattering * q.asymmetry,
            intensity: cosines.iter().map(intensity).collect(),
        };
        expected.add(&one, weight);
    }
    let pairs = sums.intensity.iter().zip(&expected.intensity).chain([
        (&sums.extinction, &expected.extinction),
        (&sums.absorption, &expected.absorption),
        (&sums.forward, &expected.forward),
    ]);
    for (found, expected) in pairs {
        // The sums are in another order, and S1 and S2 are half the sum and difference of S+ and S-.
        assert!((found / expected - 1.0).abs() < 1e-12, "{found} against {expected}");
    }
    assert!(matches!(
        sum(m, [(300.0, 1.0)], &angles, &mut solver),
        Err(MieError::Terms { needed, available }) if needed > available
    ));
}

#[test]
fn a_solver_remembers_nothing_of_the_sphere_before() {
    let mut solver = Solver::new();
    let first = solver.sphere(index(1.33, 0.0), 500.0).expect("in range").efficiencies();
    let _ = solver.sphere(index(1.5, 0.3), 3.0).expect("in range");
    assert_eq!(solver.sphere(index(1.33, 0.0), 500.0).expect("in range").efficiencies(), first);
}
