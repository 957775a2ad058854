//! Exact answers, and agreement of the methods with each other.
//!
//! An estimate is accepted within five standard errors (probability of a false
//! alarm 6e-7 each) of the number that it must be; seeds are fixed, so a test passes
//! always or never.

use super::*;
use crate::atmosphere::{Component, Tolerance};
use crate::phase::{Phase, Tabulated};
use std::f64::consts::PI;
use std::sync::Arc;
use tables::{Axis, Curve, Interpolation, Outside, Scale};

pub(super) const RADIUS: f64 = 6_371_000.0;
pub(super) const EARTH: Shape = Shape::Sphere { radius_m: RADIUS };
const METHODS: [Estimator; 2] = [Estimator::Judge, Estimator::Paths];

pub(super) fn exponential(scale_height: f64, top: f64) -> Curve {
    let axis = Axis::uniform("altitude", "m", 0.0, top / 200.0, 201).expect("valid");
    let values = axis.nodes.iter().map(|z| (-z / scale_height).exp()).collect();
    Curve::new(axis, Scale::Logarithmic, values).expect("valid")
}

fn slab(bottom: f64, top: f64) -> Curve {
    let axis = Axis::new("altitude", "m", vec![bottom, top]).expect("valid");
    let axis = axis.between(Interpolation::Step).beyond(Outside::Zero);
    Curve::new(axis, Scale::Linear, vec![1.0, 1.0]).expect("valid")
}

pub(super) fn rayleigh<const L: usize>(gamma: f64) -> Phase<L> {
    Phase::Rayleigh { gamma: [gamma; L] }
}

pub(super) fn medium<const L: usize>(components: Vec<Component<L>>, top: f64) -> Medium<L> {
    Medium::new(components, top).expect("valid")
}

/// Molecules, haze and an absorbing layer, at four wavelengths of different load.
pub(super) fn mixed() -> Medium<4> {
    let top = 6e4;
    medium(
        vec![
            Component {
                density: exponential(8e3, top),
                scattering: [3e-5, 1.5e-5, 8e-6, 2e-6],
                absorption: [0.0; 4],
                phase: rayleigh(0.015),
            },
            Component {
                density: exponential(1.2e3, top),
                scattering: [1e-4, 9e-5, 8e-5, 7e-5],
                absorption: [1e-5; 4],
                phase: Phase::HenyeyGreenstein { g: [0.6, 0.65, 0.7, 0.76] },
            },
            Component {
                density: slab(2e4, 3e4),
                scattering: [0.0; 4],
                absorption: [0.0, 1e-6, 5e-6, 1e-6],
                phase: rayleigh(0.0),
            },
        ],
        top,
    )
}

pub(super) fn columns<const L: usize>(medium: &Medium<L>, shape: Shape) -> Columns<L> {
    Columns::new(medium, shape, Tolerance::RENDER)
}

pub(super) fn towards(zenith_deg: f64, azimuth_deg: f64) -> DVec3 {
    let (sin, cos) = zenith_deg.to_radians().sin_cos();
    let (sin_a, cos_a) = azimuth_deg.to_radians().sin_cos();
    DVec3::new(sin * cos_a, sin * sin_a, cos)
}

/// Mean and standard error of `n` estimates at each wavelength.
pub(super) fn estimate<const L: usize>(
    method: Estimator,
    problem: &Problem<'_, L>,
    from: Place,
    direction: DVec3,
    n: u32,
    seed: u64,
) -> [(f64, f64); L] {
    let (mut sum, mut squares) = ([0.0; L], [0.0; L]);
    for sample in 0..n {
        let estimate = radiance(method, problem, from, direction, &mut Sampler::new(seed, 0, u64::from(sample)));
        for j in 0..L {
            sum[j] += estimate[j];
            squares[j] += estimate[j] * estimate[j];
        }
    }
    let n = f64::from(n);
    std::array::from_fn(|j| {
        let mean = sum[j] / n;
        (mean, ((squares[j] / n - mean * mean).max(0.0) / (n - 1.0)).sqrt())
    })
}

#[track_caller]
fn agree((value, error): (f64, f64), expected: f64, what: &str) {
    // 1e-12: rounding, where an estimator has no variance.
    let allowed = 5.0 * error + 1e-12 * expected.abs();
    assert!((value - expected).abs() <= allowed, "{what}: {value:e} +- {error:e}, must be {expected:e}");
    assert!(error < 0.05 * expected.abs(), "{what}: an error of {error:e} tests nothing");
}

#[test]
fn an_absorbing_atmosphere_dims_the_environment_by_beer_lambert() {
    let (h, top, sigma) = (8e3, 6e4, 2e-5);
    let absorber =
        Component { density: exponential(h, top), scattering: [0.0], absorption: [sigma], phase: rayleigh(0.0) };
    let medium = medium(vec![absorber], top);
    for (shape, zenith) in [(EARTH, 0.0), (EARTH, 80.0), (EARTH, 88.0), (Shape::Flat, 70.0)] {
        // The optical depth by 200 000 midpoints along the chord, in radii.
        let mu = f64::cos(f64::to_radians(zenith));
        let length = match shape {
            Shape::Flat => top / mu,
            Shape::Sphere { .. } => -RADIUS * mu + (RADIUS * RADIUS * mu * mu + 2.0 * RADIUS * top + top * top).sqrt(),
        };
        let n = 200_000;
        let depth: f64 = (0..n)
            .map(|i| {
                let t = (f64::from(i) + 0.5) / f64::from(n) * length;
                let altitude = match shape {
                    Shape::Flat => t * mu,
                    Shape::Sphere { .. } => (RADIUS * RADIUS + 2.0 * RADIUS * mu * t + t * t).sqrt() - RADIUS,
                };
                sigma * (-altitude / h).exp() * length / f64::from(n)
            })
            .sum();
        for method in METHODS {
            let problem = Problem {
                texture: None,
                shape,
                medium: &medium,
                columns: &columns(&medium, shape),
                albedo: [0.0],
                sun: None,
                environment: Some([1.0]),
                max_orders: None,
            };
            let [found] = estimate(method, &problem, Place::above(0.0), towards(zenith, 0.0), 60_000, 1);
            // The judge has no tables; those of the paths are good to 2e-5.
            let (value, error) = found;
            let error = if method == Estimator::Paths { 4e-6 } else { error };
            agree((value, error), (-depth).exp(), &format!("{method:?}, {shape:?}, zenith {zenith}"));
        }
    }
}

#[test]
fn a_conservative_atmosphere_over_white_ground_returns_the_environment() {
    let top = 6e4;
    let molecules = Component {
        density: exponential(8e3, top),
        scattering: [3e-5, 1e-5],
        absorption: [0.0; 2],
        phase: rayleigh(0.02),
    };
    let haze = Component {
        density: exponential(1.5e3, top),
        scattering: [2e-4, 1e-4],
        absorption: [0.0; 2],
        phase: Phase::HenyeyGreenstein { g: [0.7, 0.8] },
    };
    let medium = medium(vec![molecules, haze], top);
    for shape in [EARTH, Shape::Flat] {
        for (altitude, zenith) in [(0.0, 20.0), (0.0, 87.0), (2e3, 130.0), (1e5, 150.0)] {
            for method in METHODS {
                let problem = Problem {
                    texture: None,
                    shape,
                    medium: &medium,
                    columns: &columns(&medium, shape),
                    albedo: [1.0; 2],
                    sun: None,
                    environment: Some([1.0; 2]),
                    max_orders: None,
                };
                let found = estimate(method, &problem, Place::above(altitude), towards(zenith, 0.0), 4_000, 2);
                for (lane, found) in found.into_iter().enumerate() {
                    agree(
                        found,
                        1.0,
                        &format!("{method:?}, {shape:?}, {altitude} m, zenith {zenith}, wavelength {lane}"),
                    );
                }
            }
        }
    }
}

/// A phase function with a forward peak and a back lobe, on coarse nodes.
fn peaked() -> Tabulated<1> {
    let nodes = [(-1.0, 0.3), (-0.9, 0.08), (0.0, 0.04), (0.6, 0.1), (0.9, 0.6), (0.99, 5.0), (1.0, 60.0)];
    let (cosines, values) = nodes.iter().map(|&(c, v)| (c, [v])).unzip();
    Tabulated::new(cosines, values).expect("sound")
}

#[test]
fn one_order_of_scattering_is_the_integral_along_the_ray() {
    // L = integral of sum_s sigma_s p_s(cos) exp(-tau(0, t)) exp(-tau to the sun) dt over molecules and an
    // absorbing haze, with optical depths summed by midpoints in plain radii: nothing shared with the
    // tracer but the value of the haze's phase function.
    let (top, gamma) = (6e4, 0.015);
    let (air, air_height) = (2e-5, 8e3);
    let (haze, lost, haze_height) = (6e-5, 1e-5, 1.5e3);
    let mie = Phase::Tabulated(Arc::new(peaked()));
    let medium = medium(
        vec![
            Component {
                density: exponential(air_height, top),
                scattering: [air],
                absorption: [0.0],
                phase: rayleigh(gamma),
            },
            Component {
                density: exponential(haze_height, top),
                scattering: [haze],
                absorption: [lost],
                phase: mie.clone(),
            },
        ],
        top,
    );
    let sun = towards(60.0, 0.0);
    let disc = SunDisc::beam(sun);
    let densities = |z: f64| ((-z / air_height).exp(), (-z / haze_height).exp());
    let depth = |from: DVec3, direction: DVec3, length: f64, n: u32| -> f64 {
        (0..n)
            .map(|i| {
                let t = (f64::from(i) + 0.5) / f64::from(n) * length;
                let (a, h) = densities((from + direction * t).length() - RADIUS);
                (air * a + (haze + lost) * h) * length / f64::from(n)
            })
            .sum()
    };
    let exit = |from: DVec3, direction: DVec3| {
        let b = from.dot(direction);
        -b + (b * b + (RADIUS + top).powi(2) - from.length_squared()).sqrt()
    };
    for zenith in [0.0, 55.0, 85.0] {
        let view = towards(zenith, 20.0);
        let eye = DVec3::Z * (RADIUS + 1.0);
        let length = exit(eye, view);
        let cosine = view.dot(sun);
        let molecules =
            3.0 / (16.0 * PI * (1.0 + 2.0 * gamma)) * ((1.0 + 3.0 * gamma) + (1.0 - gamma) * cosine.powi(2));
        let particles = mie.value(0, cosine);
        let n = 2_000;
        let expected: f64 = (0..n)
            .map(|i| {
                // Midpoints of cells that grow with the square of their number, since the haze is low.
                let (s, step) = ((f64::from(i) + 0.5) / f64::from(n), 1.0 / f64::from(n));
                let (t, width) = (length * s * s, 2.0 * length * s * step);
                let point = eye + view * t;
                let tau = depth(eye, view, t, 400) + depth(point, sun, exit(point, sun), 1_000);
                let (a, h) = densities(point.length() - RADIUS);
                (air * a * molecules + haze * h * particles) * (-tau).exp() * width
            })
            .sum();
        for method in METHODS {
            let problem = Problem {
                texture: None,
                shape: EARTH,
                medium: &medium,
                columns: &columns(&medium, EARTH),
                albedo: [0.3],
                sun: Some(&disc),
                environment: None,
                max_orders: Some(1),
            };
            let (value, error) = estimate(method, &problem, Place::above(1.0), view, 60_000, 3)[0];
            // The midpoint sums are right to 3e-4.
            agree((value, error + 6e-5 * expected), expected, &format!("{method:?}, zenith {zenith}"));
        }
    }
}

#[test]
fn light_of_a_black_sky_ground_is_lambert_times_two_transmittances() {
    // One order seen from above a nearly empty atmosphere is the ground alone:
    // albedo / pi cos(60) exp(-tau (1 + 2)), tau = 1e-3 of absorption.
    let medium = medium(
        vec![Component { density: slab(0.0, 1e3), scattering: [0.0], absorption: [1e-6], phase: rayleigh(0.0) }],
        1e3,
    );
    let disc = SunDisc::beam(towards(60.0, 0.0));
    let expected = 0.4 / PI * 0.5 * (-3e-3_f64).exp();
    for method in METHODS {
        let problem = Problem {
            texture: None,
            shape: Shape::Flat,
            medium: &medium,
            columns: &columns(&medium, Shape::Flat),
            albedo: [0.4],
            sun: Some(&disc),
            environment: None,
            max_orders: Some(1),
        };
        let [(value, error)] = estimate(method, &problem, Place::above(1e3), -DVec3::Z, 2_000, 4);
        // The tables are in single precision: half a unit of it, of the depth 3e-3.
        agree((value, error + 3e-3 * 6e-8 * expected), expected, &format!("{method:?}"));
    }
}

#[test]
fn methods_agree_at_every_wavelength_of_a_mixture() {
    let medium = mixed();
    let disc = SunDisc::beam(towards(70.0, 0.0));
    for (altitude, zenith, azimuth) in [(0.0, 30.0, 40.0), (0.0, 85.0, 180.0), (1e4, 100.0, 90.0), (4e5, 160.0, 0.0)] {
        let problem = Problem {
            texture: None,
            shape: EARTH,
            medium: &medium,
            columns: &columns(&medium, EARTH),
            albedo: [0.8, 0.3, 0.1, 0.05],
            sun: Some(&disc),
            environment: None,
            max_orders: None,
        };
        let from = Place::above(altitude);
        let judge = estimate(Estimator::Judge, &problem, from, towards(zenith, azimuth), 60_000, 5);
        let paths = estimate(Estimator::Paths, &problem, from, towards(zenith, azimuth), 20_000, 6);
        for lane in 0..4 {
            let (a, b) = (judge[lane], paths[lane]);
            agree((a.0, a.1.hypot(b.1)), b.0, &format!("{altitude} m, zenith {zenith}, wavelength {lane}"));
        }
    }
}

#[test]
fn wavelengths_carried_together_equal_wavelengths_alone() {
    let together = mixed();
    let disc4 = SunDisc::beam(towards(50.0, 0.0));
    let disc1 = SunDisc::beam(towards(50.0, 0.0));
    let view = towards(75.0, 120.0);
    let albedo = [0.8, 0.3, 0.1, 0.05];
    for method in METHODS {
        let problem = Problem {
            texture: None,
            shape: EARTH,
            medium: &together,
            columns: &columns(&together, EARTH),
            albedo,
            sun: Some(&disc4),
            environment: None,
            max_orders: None,
        };
        let all = estimate(method, &problem, Place::above(0.0), view, 40_000, 7);
        for lane in 0..4 {
            let components = together
                .components()
                .iter()
                .map(|c| Component {
                    density: c.density.clone(),
                    scattering: [c.scattering[lane]],
                    absorption: [c.absorption[lane]],
                    phase: match &c.phase {
                        Phase::Rayleigh { gamma } => Phase::Rayleigh { gamma: [gamma[lane]] },
                        Phase::HenyeyGreenstein { g } => Phase::HenyeyGreenstein { g: [g[lane]] },
                        Phase::Tabulated(_) => unreachable!("not in this mixture"),
                    },
                })
                .collect();
            let alone = medium(components, together.top_m());
            let problem = Problem {
                texture: None,
                shape: EARTH,
                medium: &alone,
                columns: &columns(&alone, EARTH),
                albedo: [albedo[lane]],
                sun: Some(&disc1),
                environment: None,
                max_orders: None,
            };
            let [one] = estimate(method, &problem, Place::above(0.0), view, 40_000, 8);
            agree((all[lane].0, all[lane].1.hypot(one.1)), one.0, &format!("{method:?}, wavelength {lane}"));
        }
    }
}

#[test]
fn an_empty_ray_gives_no_light() {
    let medium = mixed();
    let disc = SunDisc::beam(towards(30.0, 0.0));
    let problem = Problem {
        texture: None,
        shape: EARTH,
        medium: &medium,
        columns: &columns(&medium, EARTH),
        albedo: [0.5; 4],
        sun: Some(&disc),
        environment: None,
        max_orders: None,
    };
    for method in METHODS {
        let found = radiance(method, &problem, Place::above(4e5), DVec3::Z, &mut Sampler::new(1, 2, 3));
        assert_eq!(found, [0.0; 4], "{method:?} found light in empty space");
    }
}

pub(super) mod polarised;
