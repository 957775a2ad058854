//! Stokes parameters: laws that hold for every path, and agreement of the methods.

use super::*;
use crate::phase::Tabulated;
use crate::polarisation::{Scattering, Stokes};

mod tables;

/// A matrix of spheres of a kind, on 181 nodes: P12^2 + P33^2 + P34^2 = P11^2 with all three of them there, and straight
/// on and back P33 = +-P11 alone.
pub(in crate::transport) fn spheres<const L: usize>(forward: [f64; L]) -> Phase<L> {
    let cosines: Vec<f64> = (0..=180).map(|i| -f64::from(i).to_radians().cos()).collect();
    let values = cosines.iter().map(|c| forward.map(|k| (k * c).exp())).collect();
    let ratios = cosines.iter().map(|c| {
        let p12 = 0.6 * (c * c - 1.0);
        let rest = (1.0 - p12 * p12).sqrt();
        [Scattering::of_spheres(1.0, [p12, rest * c, rest * (1.0 - c * c).max(0.0).sqrt()]); L]
    });
    let table = Tabulated::new(cosines.clone(), values).and_then(|table| table.with_matrices(ratios.collect()));
    Phase::Tabulated(Arc::new(table.expect("sound")))
}

/// Molecules and particles at two wavelengths.
pub(in crate::transport) fn hazy() -> Medium<2> {
    let top = 6e4;
    let component = |height: f64, scattering: [f64; 2], absorption: [f64; 2], phase: Phase<2>| Component {
        density: super::exponential(height, top),
        scattering,
        absorption,
        phase,
    };
    let molecules = component(8e3, [3e-5, 1e-5], [0.0; 2], rayleigh(0.015));
    let particles = component(1.5e3, [1.5e-4, 1e-4], [1e-5; 2], spheres([1.0, 2.0]));
    medium(vec![molecules, particles], top)
}

fn air(gamma: f64) -> Medium<1> {
    let density = super::exponential(8e3, 6e4);
    medium(vec![Component { density, scattering: [3e-5], absorption: [0.0], phase: rayleigh(gamma) }], 6e4)
}

/// The frame of a direction with e1 horizontal.
pub(in crate::transport) fn level(direction: DVec3) -> Frame {
    Frame::new(direction, DVec3::Z.cross(direction).normalize())
}

/// Sums of estimates and of their squares.
#[derive(Debug, Default)]
struct Moments {
    count: f64,
    sum: f64,
    squares: f64,
}

impl Moments {
    fn add(&mut self, x: f64) {
        (self.count, self.sum, self.squares) = (self.count + 1.0, self.sum + x, self.squares + x * x);
    }

    fn mean(&self) -> f64 {
        self.sum / self.count
    }

    fn error(&self) -> f64 {
        ((self.squares / self.count - self.mean().powi(2)) / (self.count - 1.0)).sqrt()
    }
}

/// Mean and standard error of I, Q and U of `n` estimates at each wavelength, in the frame of [`level`].
pub(in crate::transport) fn means<const L: usize>(
    method: Estimator,
    problem: &Problem<'_, L>,
    from: Place,
    direction: DVec3,
    n: u32,
    seed: u64,
) -> [[(f64, f64); 3]; L] {
    let (mut sum, mut squares) = ([[0.0; 3]; L], [[0.0; 3]; L]);
    for sample in 0..n {
        let mut sampler = Sampler::new(seed, 0, u64::from(sample));
        let seen = stokes(method, problem, from, direction, level(direction), &mut sampler);
        for (j, Stokes { i, q, u }) in seen.into_iter().enumerate() {
            for (k, x) in [i, q, u].into_iter().enumerate() {
                sum[j][k] += x;
                squares[j][k] += x * x;
            }
        }
    }
    let n = f64::from(n);
    std::array::from_fn(|j| {
        std::array::from_fn(|k| {
            let mean = sum[j][k] / n;
            (mean, ((squares[j][k] / n - mean * mean).max(0.0) / (n - 1.0)).sqrt())
        })
    })
}

fn sunlit<'a, const L: usize>(
    (shape, medium): (Shape, &'a Medium<L>),
    columns: &'a Columns<L>,
    albedo: f64,
    sun: &'a SunDisc<L>,
) -> Problem<'a, L> {
    Problem {
        texture: None,
        shape,
        medium,
        columns,
        albedo: [albedo; L],
        sun: Some(sun),
        environment: None,
        max_orders: None,
    }
}

#[test]
fn one_order_of_molecules_has_their_degree_across_the_plane_of_scattering() {
    let medium = air(0.0);
    for (shape, sun) in [(EARTH, towards(70.0, 0.0)), (Shape::Flat, towards(20.0, 0.0)), (EARTH, towards(92.0, 0.0))] {
        let (disc, columns) = (SunDisc::beam(sun), columns(&medium, shape));
        let problem = Problem { max_orders: Some(1), ..sunlit((shape, &medium), &columns, 0.0, &disc) };
        for view in [towards(5.0, 20.0), towards(60.0, 200.0), towards(85.0, 90.0)] {
            let c = view.dot(sun);
            let plane = Frame::new(view, (sun - view * c).normalize());
            for method in METHODS {
                let mut light = 0.0;
                for sample in 0..200 {
                    let mut sampler = Sampler::new(1, 0, sample);
                    let [Stokes { i, q, u }] = stokes(method, &problem, Place::above(0.0), view, plane, &mut sampler);
                    // Every path alike: rounding.
                    assert!((q + i * (1.0 - c * c) / (1.0 + c * c)).abs() <= 1e-13 * i && u.abs() <= 1e-13 * i);
                    light += i;
                }
                assert!(light > 0.0, "{method:?}: nothing was seen");
            }
        }
    }
}

#[test]
fn no_path_sees_more_polarised_light_than_light() {
    let medium = hazy();
    for shape in [EARTH, Shape::Flat] {
        let columns = columns(&medium, shape);
        for (zenith, from) in [(20.0, 0.0), (86.0, 0.0), (140.0, 6e4)] {
            let (disc, view) = (SunDisc::beam(towards(75.0, 0.0)), towards(zenith, 50.0));
            let problem = sunlit((shape, &medium), &columns, 0.5, &disc);
            for method in METHODS {
                let mut most = 0.0_f64;
                for sample in 0..2_000 {
                    let mut sampler = Sampler::new(2, 0, sample);
                    for seen in stokes(method, &problem, Place::above(from), view, level(view), &mut sampler) {
                        assert!(seen.polarised() <= seen.i * (1.0 + 1e-9), "{method:?}: {seen:?}");
                        most = most.max(seen.polarised() / seen.i);
                    }
                }
                assert!(most > 0.3, "{method:?}: nothing was polarised");
            }
        }
    }
}

#[test]
fn what_depolarises_is_scalar() {
    // The same numbers draw the same paths, and a matrix of a1 alone is a phase function: rounding.
    let medium = medium(
        vec![Component {
            density: super::exponential(2e3, 6e4),
            scattering: [1e-4, 5e-5],
            absorption: [1e-5; 2],
            phase: Phase::HenyeyGreenstein { g: [0.7, 0.6] },
        }],
        6e4,
    );
    assert!(!medium.polarises() && hazy().polarises());
    let (disc, columns, view) = (SunDisc::beam(towards(88.0, 0.0)), columns(&medium, EARTH), towards(60.0, 30.0));
    let problem = sunlit((EARTH, &medium), &columns, 0.4, &disc);
    for method in METHODS {
        for sample in 0..200 {
            let sampler = Sampler::new(3, 0, sample);
            let scalar = radiance(method, &problem, Place::above(10.0), view, &mut sampler.clone());
            let seen = stokes(method, &problem, Place::above(10.0), view, level(view), &mut sampler.clone());
            for (seen, scalar) in seen.into_iter().zip(scalar) {
                assert!((seen.i - scalar).abs() <= 1e-12 * scalar, "{method:?}: {seen:?} for {scalar}");
                assert_eq!((seen.q, seen.u), (0.0, 0.0));
            }
        }
    }
}

#[test]
fn scalar_and_polarised_transfer_along_one_path_are_those_of_paths_of_their_own() {
    // Light of two orders at most meets no roulette that differs: every path alike, but for rounding.
    let medium = hazy();
    let (disc, columns, view) = (SunDisc::beam(towards(80.0, 0.0)), columns(&medium, EARTH), towards(60.0, 30.0));
    let problem = sunlit((EARTH, &medium), &columns, 0.4, &disc);
    let short = Problem { max_orders: Some(2), ..problem };
    for method in METHODS {
        for sample in 0..200 {
            let sampler = Sampler::new(11, 0, sample);
            let scalar = radiance(method, &short, Place::above(10.0), view, &mut sampler.clone());
            let stokes = stokes(method, &short, Place::above(10.0), view, level(view), &mut sampler.clone());
            let pairs = both(method, &short, Place::above(10.0), view, level(view), &mut sampler.clone());
            for (pair, (scalar, stokes)) in pairs.into_iter().zip(scalar.into_iter().zip(stokes)) {
                assert!((pair.scalar - scalar).abs() <= 1e-12 * scalar, "{method:?}: {pair:?} for {scalar}");
                assert!((pair.stokes.i - stokes.i).abs() <= 1e-12 * stokes.i, "{method:?}: {pair:?} for {stokes:?}");
                assert!((pair.stokes.q - stokes.q).abs() <= 1e-12 * stokes.i, "{method:?}: {pair:?} for {stokes:?}");
            }
        }
    }
    // All orders: the means of either agree, and the difference has less noise than the radiance.
    let problem = sunlit((EARTH, &medium), &columns, 0.4, &disc);
    let n = 20_000;
    let (mut scalar, mut own, mut difference) = (Moments::default(), Moments::default(), Moments::default());
    for sample in 0..n {
        let sampler = Sampler::new(12, 0, sample);
        let [pair, _] = both(Estimator::Paths, &problem, Place::above(10.0), view, level(view), &mut sampler.clone());
        let [alone, _] = radiance(Estimator::Paths, &problem, Place::above(10.0), view, &mut sampler.clone());
        scalar.add(pair.scalar);
        own.add(alone);
        difference.add(pair.scalar - pair.stokes.i);
    }
    let error = scalar.error().hypot(own.error());
    assert!((scalar.mean() - own.mean()).abs() < 5.0 * error, "{scalar:?}, {own:?}");
    assert!(difference.error() < 0.5 * scalar.error(), "{difference:?}, {scalar:?}");
}

#[test]
fn natural_light_from_everywhere_stays_natural() {
    // Without absorption and over white ground every direction has I = 1, Q = U = 0: the mean over the sphere of b1 cos 2 eta is 0.
    let top = 6e4;
    let component = |height, scattering: f64, phase| Component {
        density: super::exponential(height, top),
        scattering: [scattering],
        absorption: [0.0],
        phase,
    };
    let medium = medium(vec![component(8e3, 2e-5, rayleigh(0.015)), component(1.5e3, 1e-4, spheres([1.0]))], top);
    for (shape, zenith) in [(EARTH, 87.0), (Shape::Flat, 50.0)] {
        let columns = columns(&medium, shape);
        let problem = Problem {
            texture: None,
            shape,
            medium: &medium,
            columns: &columns,
            albedo: [1.0],
            sun: None,
            environment: Some([1.0]),
            max_orders: None,
        };
        for method in METHODS {
            let [found] = means(method, &problem, Place::above(0.0), towards(zenith, 0.0), 10_000, 4);
            for (k, (value, error)) in found.into_iter().enumerate() {
                let expected = if k == 0 { 1.0 } else { 0.0 };
                assert!(
                    (value - expected).abs() < 5.0 * error,
                    "{method:?}, {shape:?}, parameter {k}: {value} +- {error}"
                );
                assert!(error < 0.03, "{method:?}: an error of {error} tests nothing");
            }
        }
    }
}

#[test]
fn methods_agree_in_every_parameter() {
    let (molecules, mixture) = (air(0.015), hazy());
    let disc = SunDisc::beam(towards(70.0, 0.0));
    let disc2 = SunDisc::beam(towards(70.0, 0.0));
    // The second looks past the limb, 20 km above it.
    for (shape, altitude, zenith, azimuth) in [
        (EARTH, 0.0, 30.0, 40.0),
        (EARTH, 4e5, 109.4, 60.0),
        (Shape::Flat, 0.0, 75.0, 250.0),
        (Shape::Flat, 6e4, 150.0, 90.0),
    ] {
        let (from, view) = (Place::above(altitude), towards(zenith, azimuth));
        let one = columns(&molecules, shape);
        let two = columns(&mixture, shape);
        let (one, two) = (sunlit((shape, &molecules), &one, 0.3, &disc), sunlit((shape, &mixture), &two, 0.3, &disc2));
        let both = |method, n, seed| {
            let [a] = means(method, &one, from, view, n, seed);
            let [b, c] = means(method, &two, from, view, n, seed);
            [a, b, c]
        };
        let (judge, paths) = (both(Estimator::Judge, 40_000, 5), both(Estimator::Paths, 15_000, 6));
        for (lane, (judge, paths)) in judge.into_iter().zip(paths).enumerate() {
            let radiance = paths[0].0;
            for (k, (a, b)) in judge.into_iter().zip(paths).enumerate() {
                let error = a.1.hypot(b.1);
                let what = format!("{shape:?}, {altitude} m, zenith {zenith}, {lane}, parameter {k}");
                assert!((a.0 - b.0).abs() < 5.0 * error, "{what}: {a:?}, {b:?}");
                assert!(error < 0.04 * radiance, "{what}: an error of {error:e} of {radiance:e} tests nothing");
            }
            let polarised = paths[1].0.hypot(paths[2].0);
            assert!(polarised > 0.03 * radiance, "{shape:?}, zenith {zenith}: nothing is polarised");
        }
    }
}

#[test]
fn wavelengths_carried_together_are_polarised_as_alone() {
    let together = hazy();
    let (disc2, disc1) = (SunDisc::beam(towards(91.0, 0.0)), SunDisc::beam(towards(91.0, 0.0)));
    let view = towards(70.0, 60.0);
    let columns2 = columns(&together, EARTH);
    let all =
        means(Estimator::Paths, &sunlit((EARTH, &together), &columns2, 0.3, &disc2), Place::above(0.0), view, 8_000, 7);
    for lane in 0..2 {
        let lane_of = |c: &Component<2>| Component {
            density: c.density.clone(),
            scattering: [c.scattering[lane]],
            absorption: [c.absorption[lane]],
            phase: match &c.phase {
                Phase::Rayleigh { gamma } => Phase::Rayleigh { gamma: [gamma[lane]] },
                _ => spheres([[1.0, 2.0][lane]]),
            },
        };
        let alone = medium(together.components().iter().map(lane_of).collect(), together.top_m());
        let columns1 = columns(&alone, EARTH);
        let problem = sunlit((EARTH, &alone), &columns1, 0.3, &disc1);
        let [one] = means(Estimator::Paths, &problem, Place::above(0.0), view, 8_000, 8);
        for (a, b) in all[lane].into_iter().zip(one) {
            let error = a.1.hypot(b.1);
            assert!((a.0 - b.0).abs() < 5.0 * error, "wavelength {lane}: {a:?}, {b:?}");
            assert!(error < 0.03 * one[0].0, "an error of {error:e} tests nothing");
        }
    }
}

#[test]
fn a_view_in_the_sun_s_plane_has_no_u() {
    let medium = hazy();
    for (shape, sun) in [(EARTH, 60.0), (EARTH, 93.0), (Shape::Flat, 60.0)] {
        let (disc, columns) = (SunDisc::beam(towards(sun, 0.0)), columns(&medium, shape));
        let problem = sunlit((shape, &medium), &columns, 0.3, &disc);
        let mut most = 0.0_f64;
        for azimuth in [0.0, 180.0] {
            for [(radiance, _), (q, _), (u, error)] in
                means(Estimator::Paths, &problem, Place::above(0.0), towards(20.0, azimuth), 8_000, 9)
            {
                assert!(u.abs() < 5.0 * error, "{shape:?}, sun {sun}, azimuth {azimuth}: {u} +- {error}");
                assert!(error < 0.03 * radiance, "an error of {error:e} of {radiance:e} tests nothing");
                most = most.max(q.abs() / radiance);
            }
        }
        assert!(most > 0.1, "{shape:?}, sun {sun}: nothing is polarised");
    }
}

/// Wigner's d^l_mn(theta) by its finite sum (Edmonds 1957, equation 4.1.15).
fn wigner(l: i32, m: i32, n: i32, theta: f64) -> f64 {
    let factorial = |k: i32| (1..=k).map(f64::from).product::<f64>();
    let (sin, cos) = (0.5 * theta).sin_cos();
    let root = [l + m, l - m, l + n, l - n].map(factorial).iter().product::<f64>().sqrt();
    (0..=2 * l)
        .filter(|&k| l + n - k >= 0 && l - k - m >= 0 && k - n + m >= 0)
        .map(|k| {
            let below = [l + n - k, k, l - k - m, k - n + m].map(factorial).iter().product::<f64>();
            let sign = if (k - n + m) % 2 == 0 { 1.0 } else { -1.0 };
            sign * root / below * cos.powi(2 * l - 2 * k + n - m) * sin.powi(2 * k - n + m)
        })
        .sum()
}

/// Spheroids of Siewert 2000, problem IIA: coefficients alpha2, alpha1, beta1, alpha4, beta2, alpha3 in generalised spherical
/// functions, l = 0 to 11.
const SPHEROIDS: [[f64; 12]; 6] = [
    [0.0, 0.0, 3.726079, 2.202868, 1.190694, 0.391203, 0.105556, 0.020484, 0.003097, 0.000366, 3.5e-5, 3e-6],
    [1.0, 2.104031, 2.095158, 1.414939, 0.703593, 0.235001, 0.064039, 0.012837, 0.00201, 0.000246, 2.4e-5, 2e-6],
    [0.0, 0.0, -0.116688, -0.20937, -0.227137, -0.144524, -0.05264, -0.0124, -0.002093, -0.000267, -2.7e-5, -2e-6],
    [0.915207, 2.095727, 2.008624, 1.436545, 0.706244, 0.238475, 0.056448, 0.009703, 0.001267, 0.00013, 1.1e-5, 1e-6],
    [0.0, 0.0, 0.065456, 0.221658, 0.097752, 0.052458, 0.009239, 0.001411, 0.000133, 1.1e-5, 1e-6, 0.0],
    [0.0, 0.0, 3.615946, 2.240516, 1.139473, 0.365605, 0.082779, 0.013649, 0.001721, 0.000172, 1.4e-5, 1e-6],
];

/// The layer of that problem: optical depth 1 in 1 km.
fn spheroids() -> Medium<1> {
    let angles: Vec<f64> = (0..=720).map(|i| PI - f64::from(i) * PI / 720.0).collect();
    let matrix = |&theta: &f64| {
        let sum = |m: i32, n: i32, of: &dyn Fn(usize) -> f64| -> f64 {
            (0..12_usize)
                .filter(|&l| l as i32 >= m.abs().max(n.abs()))
                .map(|l| of(l) * wigner(l as i32, m, n, theta))
                .sum()
        };
        let [alpha2, alpha1, beta1, alpha4, beta2, alpha3] = SPHEROIDS;
        // P^l_02 is d^l_02 with the sign that makes of the problem's beta1 its own P12.
        let (plus, minus) = (sum(2, 2, &|l| alpha2[l] + alpha3[l]), sum(2, -2, &|l| alpha2[l] - alpha3[l]));
        Scattering {
            a1: sum(0, 0, &|l| alpha1[l]),
            a2: 0.5 * (plus + minus),
            a3: 0.5 * (plus - minus),
            a4: sum(0, 0, &|l| alpha4[l]),
            b1: sum(0, 2, &|l| beta1[l]),
            b2: sum(0, 2, &|l| beta2[l]),
        }
    };
    let matrices: Vec<Scattering> = angles.iter().map(matrix).collect();
    let mut cosines: Vec<f64> = angles.iter().map(|theta| theta.cos()).collect();
    (cosines[0], cosines[720]) = (-1.0, 1.0);
    let table = Tabulated::new(cosines, matrices.iter().map(|m| [m.a1]).collect()).expect("sound");
    let table = table.with_matrices(matrices.iter().map(|m| [*m * m.a1.recip()]).collect()).expect("possible");
    let (albedo, depth) = (0.973_527, 1e-3);
    let layer = Component {
        density: slab(0.0, 1e3),
        scattering: [albedo * depth],
        absorption: [(1.0 - albedo) * depth],
        phase: Phase::Tabulated(Arc::new(table)),
    };
    medium(vec![layer], 1e3)
}

#[test]
fn spheroids_agree_with_discrete_ordinates() {
    // Siewert 2000, tables 2 to 9: pi times I, Q and U per unit irradiance, the sun's cosine 0.6, a black ground. Q there is of light in the
    // meridian plane less that across it, which is -Q in the frame of `level`, and its azimuth runs the other way.
    let expected = [
        (1e3, -0.2, 0.0, [0.751295, -0.0638561, 0.0]),
        (1e3, -0.6, -90.0, [0.106628, 0.00431252, -0.00687877]),
        (0.0, 0.2, 0.0, [0.850181, -0.0119181, 0.0]),
        (0.0, 0.4, -90.0, [0.217953, 0.00892357, -0.0159356]),
        (0.0, 0.9, 180.0, [0.108352, -0.00745424, 0.0]),
    ];
    let medium = spheroids();
    let (disc, columns) = (SunDisc::beam(towards(0.6_f64.acos().to_degrees(), 0.0)), columns(&medium, Shape::Flat));
    let problem = sunlit((Shape::Flat, &medium), &columns, 0.0, &disc);
    for (altitude, cosine, azimuth, [i, q, u]) in expected {
        let view = towards(f64::acos(cosine).to_degrees(), azimuth);
        let [found] = means(Estimator::Paths, &problem, Place::above(altitude), view, 150_000, 10);
        for (k, ((value, error), expected)) in found.into_iter().zip([i, -q, u]).enumerate() {
            let (value, error) = (PI * value, PI * error);
            // The lines of the table: 1e-4 of I.
            let allowed = 5.0 * error + 1e-4 * i;
            assert!(
                (value - expected).abs() < allowed,
                "cosine {cosine}, azimuth {azimuth}, parameter {k}: {value} +- {error} for {expected}"
            );
            assert!(error < 5e-3 * i, "an error of {error:e} of {i} tests nothing");
        }
    }
}
