use super::*;
use crate::atmosphere::{Component, Medium};
use crate::geometry::Place;
use crate::phase::Phase;
use glam::DVec3;
use tables::{Axis, Curve, Interpolation, Outside, Scale};

const RADIUS: f64 = 6_371_000.0;
const TOP: f64 = 1e5;

fn component(density: Curve, extinction: [f64; 2]) -> Component<2> {
    Component { density, scattering: extinction, absorption: [0.0; 2], phase: Phase::Rayleigh { gamma: [0.0; 2] } }
}

fn exponential(scale_height: f64, top: f64) -> Curve {
    let axis = Axis::uniform("altitude", "m", 0.0, top / 100.0, 101).expect("valid").beyond(Outside::Zero);
    let values = axis.nodes.iter().map(|z| (-z / scale_height).exp()).collect();
    Curve::new(axis, Scale::Logarithmic, values).expect("valid")
}

/// Air, a low haze with a jump at 2 km, and a layer of ozone.
pub(super) fn medium() -> Medium<2> {
    hazy([2e-5, 3e-5])
}

/// The same with the extinction of the haze.
fn hazy(extinction: [f64; 2]) -> Medium<2> {
    let axis = Axis::new("altitude", "m", vec![1e4, 2.5e4, 4e4]).expect("valid").beyond(Outside::Zero);
    let ozone = Curve::new(axis, Scale::Linear, vec![0.0, 1.0, 0.0]).expect("valid");
    let axis = Axis::new("altitude", "m", vec![0.0, 2e3]).expect("valid").between(Interpolation::Step);
    let haze = Curve::new(axis.beyond(Outside::Zero), Scale::Linear, vec![1.0, 1.0]).expect("valid");
    Medium::new(
        vec![
            component(exponential(8e3, TOP), [2.7e-5, 5e-6]),
            component(exponential(1.2e3, TOP), [1e-4, 2e-4]),
            component(haze, extinction),
            component(ozone, [1e-7, 1e-6]),
        ],
        TOP,
    )
    .expect("valid")
}

fn direction(zenith_deg: f64) -> DVec3 {
    let (sin, cos) = zenith_deg.to_radians().sin_cos();
    DVec3::new(sin, 0.0, cos)
}

pub(super) const EARTH: Shape = Shape::Sphere { radius_m: RADIUS };

/// What is asked of a transmittance: 1e-4, and 1e-3 of it wherever it exceeds 1e-6.
fn close(table: f64, exact: f64) -> bool {
    let (table, exact) = ((-table).exp(), (-exact).exp());
    (table - exact).abs() <= 1e-4 && (exact < 1e-6 || (table - exact).abs() <= 1e-3 * exact)
}

#[test]
fn transmittances_to_space_are_those_of_the_quadrature() {
    // From the ground to space, between jumps and at them, all angles and the last arc minute above the horizon.
    let medium = medium();
    let columns = Columns::new(&medium, EARTH, Tolerance::RENDER);
    for altitude in [0.0, 1e-3, 1.0, 500.0, 1999.0, 2000.0, 2001.0, 1e4, 5e4, 99e3, 4e5] {
        let place = Place::above(altitude);
        let dip = (RADIUS / (RADIUS + altitude)).acos().to_degrees();
        let zeniths = (0..=360).map(|i| f64::from(i) / 2.0);
        let grazing = (0..=60).map(|i| 90.0 + dip - f64::from(i) / 3600.0);
        for zenith in zeniths.chain(grazing) {
            let exact = medium.optical_depth(EARTH, place, direction(zenith));
            let table = match columns.chord(place, direction(zenith)) {
                None => [0.0; 2],
                Some(chord) if chord.ends_on_ground() => [f64::INFINITY; 2],
                Some(chord) => chord.total(),
            };
            for (table, exact) in table.into_iter().zip(exact) {
                assert!(close(table, exact), "{altitude} m, zenith {zenith}: {table} for {exact}");
            }
        }
    }
}

#[test]
fn depths_along_a_chord_rise_by_their_slope_and_are_inverted() {
    let medium = medium();
    let columns = Columns::new(&medium, EARTH, Tolerance::RENDER);
    for (altitude, zenith) in
        [(0.0, 0.0), (0.0, 89.0), (1.0, 90.01), (5e3, 91.5), (4e5, 108.0), (4e5, 150.0), (8e4, 90.0)]
    {
        let place = Place::above(altitude);
        let chord = columns.chord(place, direction(zenith)).expect("meets the air");
        let (from, to) = chord.ends();
        const PARTS: u32 = 400;
        let at = |i: f64| from + (to - from) * i / f64::from(PARTS);
        let total = chord.total();
        for i in 0..PARTS {
            let (a, m, b) = (at(f64::from(i)), at(f64::from(i) + 0.5), at(f64::from(i) + 1.0));
            let (a, m, b) = (chord.point(a), chord.point(m), chord.point(b));
            for (j, total) in total.iter().enumerate() {
                // Simpson's rule, a fifth of the step's own depth where a density jumps within it.
                let rise = (to - from) / f64::from(PARTS) / 6.0 * (a.slope[j] + 4.0 * m.slope[j] + b.slope[j]);
                let off = (b.depth[j] - a.depth[j] - rise).abs();
                assert!(off <= 0.2 * rise + 1e-6 * total, "{altitude} m, zenith {zenith}, part {i}: {off} of {rise}");
            }
            for share in [0.1, 0.9] {
                let s = at(f64::from(i) + share);
                let depth = chord.point(s).depth[1];
                let back = chord.at_depth(1, depth).1.depth[1];
                // What the inversion leaves.
                assert!(
                    (back - depth).abs() <= 1e-7 * (1.0 + total[1]),
                    "{altitude} m, zenith {zenith}: {back} for {depth}"
                );
            }
        }
    }
}

#[test]
fn planes_are_crossed_at_depth_over_cosine() {
    let medium = medium();
    let columns = Columns::new(&medium, Shape::Flat, Tolerance::RENDER);
    for (altitude, zenith) in [(0.0, 0.0), (0.0, 60.0), (3e3, 80.0), (TOP, 120.0), (500.0, 95.0)] {
        let place = Place::above(altitude);
        let chord = columns.chord(place, direction(zenith)).expect("meets the air");
        let down = zenith > 90.0;
        assert_eq!(chord.ends_on_ground(), down);
        let above = medium.optical_depth(Shape::Flat, place, DVec3::Z);
        let whole = medium.optical_depth(Shape::Flat, Place::above(0.0), DVec3::Z);
        for (lane, table) in chord.total().into_iter().enumerate() {
            let vertical = if down { whole[lane] - above[lane] } else { above[lane] };
            let exact = vertical / direction(zenith).z.abs();
            assert!(close(table, exact), "{altitude} m, zenith {zenith}: {table} for {exact}");
        }
    }
}

#[test]
fn tables_hold_for_planets_of_any_size() {
    // A hundred kilometres and ten million.
    let medium = medium();
    for radius_m in [1e5, 1e10] {
        let shape = Shape::Sphere { radius_m };
        let columns = Columns::new(&medium, shape, Tolerance::RENDER);
        for altitude in [0.0, 1.0, 3e3, 5e4] {
            for i in 0..=180 {
                let (place, zenith) = (Place::above(altitude), f64::from(i));
                let exact = medium.optical_depth(shape, place, direction(zenith));
                let table = match columns.chord(place, direction(zenith)) {
                    Some(chord) if chord.ends_on_ground() => [f64::INFINITY; 2],
                    Some(chord) => chord.total(),
                    None => [0.0; 2],
                };
                for (table, exact) in table.into_iter().zip(exact) {
                    assert!(
                        close(table, exact),
                        "radius {radius_m}, {altitude} m, zenith {zenith}: {table} for {exact}"
                    );
                }
            }
        }
    }
}

#[test]
fn lines_that_turn_just_below_a_node_have_the_depths_of_the_quadrature() {
    // From above the turn, where the columns count back to it: by rounding, and by more, below a jump and below other nodes.
    let medium = medium();
    for radius_m in [1e5, RADIUS, 1e9] {
        let shape = Shape::Sphere { radius_m };
        let columns = Columns::new(&medium, shape, Tolerance::RENDER);
        let nodes = columns.altitudes.nodes();
        for &node in nodes[1..nodes.len() - 1].iter().step_by(5).chain(&[2e3]) {
            for below in [1e-12, 1e-9, 2e-6, 1e-3, 0.1, 3.0, 20.0].into_iter().filter(|&below| below < node) {
                for above in [1e-3, 1.0, 30.0, 300.0] {
                    let (p, h) = (node.next_down().min(node - below), node + above);
                    let sine = (radius_m + p) / (radius_m + h);
                    let cosine = -((h - p) * (2.0 * radius_m + h + p)).sqrt() / (radius_m + h);
                    let direction = DVec3::new(sine, 0.0, cosine);
                    let chord = columns.chord(Place::above(h), direction).expect("meets the air");
                    let exact = medium.optical_depth(shape, Place::above(h), direction);
                    for (table, exact) in chord.total().into_iter().zip(exact) {
                        assert!(
                            close(table, exact),
                            "{radius_m}, {below} below {node}, {above} above: {table} for {exact}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn a_thick_layer_that_ends_sharply_is_crossed_right_on_the_largest_planets() {
    // Depths to 1e4 below the jump, so lines that leave it and those that have left it differ by all of it.
    let medium = hazy([2.4e-3, 1e-3]);
    for radius_m in [RADIUS, 1e9, 5.3e9, 1e10] {
        let shape = Shape::Sphere { radius_m };
        let columns = Columns::new(&medium, shape, Tolerance::RENDER);
        for below in [1e-3, 0.1, 1.0, 10.0, 60.0, 300.0, 1000.0, 1900.0] {
            let p: f64 = 2000.0 - below;
            for h in [p + 0.3 * below, 2000.0 - 1e-3, 2000.0, 2001.0, 2100.0, 3000.0, 2e4, 9e4] {
                for sign in [-1.0, 1.0] {
                    let sine = (radius_m + p) / (radius_m + h);
                    let cosine = sign * ((h - p) * (2.0 * radius_m + h + p)).sqrt() / (radius_m + h);
                    let direction = DVec3::new(sine, 0.0, cosine);
                    let chord = columns.chord(Place::above(h), direction).expect("meets the air");
                    let exact = medium.optical_depth(shape, Place::above(h), direction);
                    for (table, exact) in chord.total().into_iter().zip(exact) {
                        assert!(close(table, exact), "{radius_m}, {below} below, at {h} ({sign}): {table} for {exact}");
                    }
                }
            }
        }
    }
}
