//! For Bevy 0.19: a Rust function that makes a `bevy_light::atmosphere::ScatteringMedium`, coefficients in m^-1.
//!
//! Every species is a term: its coefficients in the densest layer, a curve of the share of that at each altitude (of the falloff parameter
//! p = 1 - z / top), and its phase function at the second wavelength as a curve of the cosine.

use super::{Layered, Layers, single};
use std::fmt::Write;
use tables::units::EARTH_RADIUS_M;

/// Points of a curve of the altitude, and of a phase function.
const ALTITUDES: usize = 481;
const COSINES: usize = 1001;

pub(super) fn files(layers: &Layers) -> Vec<(String, Vec<u8>)> {
    let mut text = String::new();
    // Writing to a String does not fail.
    for line in layers.header("coefficients in m^-1, radii in m, phase functions in sr^-1") {
        let _ = writeln!(text, "// {line}");
    }
    let top = 1000.0 * layers.top_km();
    let _ = write!(
        text,
        r#"
use bevy_light::atmosphere::{{Falloff, PhaseFunction, ScatteringMedium, ScatteringTerm}};
use bevy_math::{{Vec3, curve::{{Curve, Interval, SampleAutoCurve}}}};

/// Radius of the planet and of the top of the air in m: `inner_radius` and `outer_radius` of `Atmosphere`.
pub const RADII_M: (f32, f32) = ({:?}, {:?});

/// The air, with curves of so many values.
pub fn air() -> ScatteringMedium {{
    let falloff = |values: &[f32]| Falloff::from_curve(SampleAutoCurve::new(Interval::UNIT, values.to_vec()).expect("points"));
    let cosines = Interval::new(-1.0, 1.0).expect("an interval");
    let phase = |values: &[f32]| PhaseFunction::from_curve(SampleAutoCurve::new(cosines, values.to_vec()).expect("points"));
    ScatteringMedium::new({ALTITUDES}, {COSINES}, [
"#,
        EARTH_RADIUS_M,
        EARTH_RADIUS_M + top,
    );
    for one in &layers.species {
        let densest = densest(one);
        let vector = |rows: &[Vec<f64>]| {
            let [r, g, b] = [0, 1, 2].map(|w| single(rows[w][densest]));
            format!("Vec3::new({r}, {g}, {b})")
        };
        let _ = write!(
            text,
            "        // {}\n        ScatteringTerm {{\n            absorption: {},\n            scattering: {},\n            falloff: falloff(&{:?}),\n            phase: {},\n        }},\n",
            one.name,
            vector(&one.absorption),
            vector(&one.scattering),
            shares(one, densest, layers.count),
            one.phase
                .get(1)
                .map_or_else(|| "PhaseFunction::Isotropic".into(), |phase| format!("phase(&{:?})", thinned(phase))),
        );
    }
    text.push_str("    ])\n}\n");
    vec![("air.rs".into(), text.into_bytes())]
}

/// Extinction at the second wavelength.
fn extinction(one: &Layered, layer: usize) -> f64 {
    one.scattering[1][layer] + one.absorption[1][layer]
}

/// The layer with most of it.
fn densest(one: &Layered) -> usize {
    let layers = 0..one.scattering[1].len();
    layers.max_by(|&a, &b| extinction(one, a).total_cmp(&extinction(one, b))).unwrap_or(0)
}

/// Shares of the densest layer from the top to the ground.
fn shares(one: &Layered, densest: usize, count: usize) -> Vec<f32> {
    let most = extinction(one, densest);
    let share = |k: usize| {
        // Between the middles of layers, linearly.
        let at = ((1.0 - k as f64 / (ALTITUDES - 1) as f64) * count as f64 - 0.5).clamp(0.0, (count - 1) as f64);
        let low = (at as usize).min(count - 2);
        let fraction = at - low as f64;
        let value = (1.0 - fraction) * extinction(one, low) + fraction * extinction(one, low + 1);
        if most > 0.0 { (value / most) as f32 } else { 0.0 }
    };
    (0..ALTITUDES).map(share).collect()
}

/// Every fourth value of a phase function as the mean over its neighbours, so that the integral stays.
fn thinned(phase: &[f64]) -> Vec<f32> {
    let every = (phase.len() - 1) / (COSINES - 1);
    let node = |i: usize| {
        let (mut sum, mut weights) = (0.0, 0.0);
        let (low, high) = ((i * every).saturating_sub(every), (i * every + every).min(phase.len() - 1));
        for (k, value) in phase.iter().enumerate().take(high + 1).skip(low) {
            let end = if k == 0 || k + 1 == phase.len() { 0.5 } else { 1.0 };
            let weight = end * (1.0 - (k as f64 - (i * every) as f64).abs() / every as f64);
            sum += weight * value;
            weights += weight;
        }
        (sum / weights) as f32
    };
    (0..COSINES).map(node).collect()
}
