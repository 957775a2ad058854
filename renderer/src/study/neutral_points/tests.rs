//! Neutral points of a layer of Rayleigh scattering beside published tables, and how they move.

use super::*;
use crate::atmosphere::{Component, Medium};
use crate::phase::Phase;
use tables::{Axis, Curve, Interpolation, Outside, Scale};

/// Molecules without anisotropy: a homogeneous layer of 1 km, or air of scale height 8 km up to 60 km.
fn air(depth: f64, homogeneous: bool) -> Medium<1> {
    let (nodes, density): (Vec<f64>, Vec<f64>) = if homogeneous {
        (vec![0.0, 1e3], vec![1e-3; 2])
    } else {
        (0..=60).map(|km| 1e3 * f64::from(km)).map(|z| (z, (-z / 8e3).exp() / 8e3)).unzip()
    };
    let top = nodes[nodes.len() - 1];
    let axis = Axis::new("altitude", "m", nodes).expect("increasing").beyond(Outside::Zero);
    let (axis, scale) =
        if homogeneous { (axis.between(Interpolation::Step), Scale::Linear) } else { (axis, Scale::Logarithmic) };
    let density = Curve::new(axis, scale, density).expect("sound");
    let molecules =
        Component { density, scattering: [depth], absorption: [0.0], phase: Phase::Rayleigh { gamma: [0.0] } };
    Medium::new(vec![molecules], top).expect("sound")
}

/// Does `work` with the problem of that air, the sun at an elevation in degrees, a black ground.
fn with<T>(
    medium: &Medium<1>,
    shape: Shape,
    sun_elevation: f64,
    max_orders: Option<u32>,
    work: impl Fn(&Problem<'_, 1>) -> T,
) -> T {
    let columns = Columns::new(medium, shape, Tolerance::RENDER);
    let disc = SunDisc::beam(towards(90.0 - sun_elevation, 0.0));
    let (sun, albedo) = (Some(&disc), [0.0]);
    work(&Problem { texture: None, shape, medium, columns: &columns, albedo, sun, environment: None, max_orders })
}

/// Four neighbours (mu, Q) about a zero of Q at the bottom of a layer of optical depth tau over black ground, the sun's cosine
/// mu0, at azimuth 0 or 180: Natraj, Li & Yung 2009, table of Q, downwards, whose incident flux is pi.
struct Published {
    tau: f64,
    mu0: f64,
    name: Name,
    q: [(f64, f64); 4],
}

#[rustfmt::skip]
const PUBLISHED: [Published; 5] = [
    Published { tau: 0.15, mu0: 0.6, name: Name::Babinet, q: [(0.64, -0.002_691_82), (0.72, -0.001_347_75), (0.84, 0.002_216_37), (0.92, 0.006_155_46)] },
    Published { tau: 0.15, mu0: 0.6, name: Name::Brewster, q: [(0.28, 0.002_990_69), (0.32, 0.000_878_04), (0.4, -0.001_808_27), (0.52, -0.003_285_19)] },
    Published { tau: 0.15, mu0: 0.1, name: Name::Arago, q: [(0.16, -0.004_487), (0.2, -0.002_592_4), (0.28, 0.000_499_41), (0.32, 0.001_805_98)] },
    Published { tau: 0.5, mu0: 0.2, name: Name::Arago, q: [(0.28, -0.002_599_87), (0.32, 0.000_168_63), (0.4, 0.005_692_19), (0.52, 0.013_536_78)] },
    Published { tau: 0.5, mu0: 0.6, name: Name::Brewster, q: [(0.1, 0.012_025_21), (0.16, 0.004_280_01), (0.2, -0.000_446_33), (0.28, -0.008_089_2)] },
];

impl Published {
    /// The zero in degrees along the sun's vertical: elevation as a cubic in Q (inverse interpolation), and how far from it the
    /// line between its two neighbours puts it.
    fn zero(&self) -> (f64, f64) {
        let points = self.q.map(|(mu, q)| (q, mu.asin().to_degrees()));
        let at_zero = |points: &[(f64, f64)]| -> f64 {
            let share = |i: usize| -> f64 {
                let others = (0..points.len()).filter(|&k| k != i);
                others.map(|k| points[k].0 / (points[k].0 - points[i].0)).product()
            };
            (0..points.len()).map(|i| points[i].1 * share(i)).sum()
        };
        let change = points.windows(2).position(|pair| pair[0].0 * pair[1].0 < 0.0).expect("a zero");
        let (cubic, line) = (at_zero(&points), at_zero(&points[change..change + 2]));
        (if self.name == Name::Arago { 180.0 - cubic } else { cubic }, (cubic - line).abs())
    }
}

#[test]
fn neutral_points_lie_where_published_tables_have_them() {
    for case in &PUBLISHED {
        let (expected, bend) = case.zero();
        let sun = case.mu0.asin().to_degrees();
        let found = with(&air(case.tau, true), Shape::Flat, sun, None, |problem| {
            zero(problem, Place::above(0.0), expected, 512)
        });
        let what = format!("tau {}, mu0 {}, {:?}: {found:?} for {expected} ({bend})", case.tau, case.mu0, case.name);
        let found = found[0].unwrap_or_else(|| panic!("{what}"));
        assert!(case.name.distance(&found, sun).is_some(), "{what}: another point");
        // The cubic is better than the line by a factor of five at least; and chance.
        let allowed = 0.2 * bend + 4.0 * found.error_deg + 0.05;
        assert!((found.along_deg - expected).abs() < allowed, "{what}, {allowed} allowed");
        assert!(found.error_deg < 0.8, "{what}: tests nothing");
    }
}

#[test]
fn light_scattered_once_has_no_neutral_points_but_at_the_sun_and_opposite() {
    for (shape, sun) in [(Shape::Flat, 20.0), (Shape::Sphere { radius_m: EARTH_RADIUS_M }, -3.0)] {
        with(&air(0.3, shape == Shape::Flat), shape, sun, Some(1), |problem| {
            // The last 40 degrees opposite a sun that has set are dark.
            for along in (1..140).step_by(3).map(f64::from) {
                let (q, error) = mean_and_error(ratios(problem, Place::above(0.0), along, 4).map(|ratio| ratio[0]));
                // Every path has (1 - c^2) / (1 + c^2), and Q and I of each sequence differ by the nodes' places.
                let c = (along - sun).to_radians().cos();
                assert!(
                    (q - (1.0 - c * c) / (1.0 + c * c)).abs() < 1e-12 + error,
                    "sun {sun}, {along}: {q} +- {error}"
                );
                assert!(q > 0.0 || (along - sun).abs() < 1.0, "sun {sun}, {along}: {q}");
            }
            let none = zero(problem, Place::above(0.0), sun + 17.0, 4);
            assert_eq!(none, [None], "sun {sun}");
        });
    }
}

#[test]
fn neutral_points_move_with_the_sun() {
    // As the sun sinks Babinet's point leaves it, and Arago's, once the sun is low, leaves the antisolar point.
    let shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };
    let medium = air(0.15, false);
    let distances = |name: Name, suns: &[(f64, f64)]| -> Vec<(f64, f64)> {
        let of = |&(sun, about): &(f64, f64)| {
            let along = if name == Name::Arago { 180.0 + sun - about } else { sun + about };
            let found = with(&medium, shape, sun, None, |problem| zero(problem, Place::above(0.0), along, 512));
            let found = found[0].unwrap_or_else(|| panic!("{name:?}, sun {sun}: none about {along}"));
            (name.distance(&found, sun).unwrap_or_else(|| panic!("{name:?}: {found:?}")), found.error_deg)
        };
        suns.iter().map(of).collect()
    };
    // The sun's elevation, and about where the point is.
    for distances in [
        distances(Name::Babinet, &[(60.0, 7.0), (35.0, 13.0), (8.0, 19.0)]),
        distances(Name::Arago, &[(0.0, 20.0), (-4.0, 22.0)]),
    ] {
        for pair in distances.windows(2) {
            let (grows, error) = (pair[1].0 - pair[0].0, pair[1].1.hypot(pair[0].1));
            assert!(grows > 3.0 * error, "{distances:?}: {grows} +- {error}");
        }
    }
}
