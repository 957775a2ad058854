//! Where a field is tabulated: altitudes, zenith angles of the sun, directions.

use crate::atmosphere::Medium;
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, PI};

/// How fine a solution is; where phase functions have peaks, with four more altitudes and half as many more zenith angles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resolution {
    /// Number of altitudes.
    pub levels: usize,
    /// Number of zenith angles of the sun.
    pub suns: usize,
    /// Zenith angles of directions: above the level, between it and the horizon, below the horizon.
    pub zeniths: [usize; 3],
    /// Parts of the way between two levels on which singly scattered light is summed.
    pub parts: usize,
    /// Highest degree of the moments, where there is more than molecules.
    pub degree: usize,
    /// Relative change of the field by another order of scattering below which it counts as solved.
    pub change: f64,
}

/// A resolution by name: each takes one and a half times to twice as long as the one before, the last three times.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Fineness {
    /// What tells how exact the usual grid is
    Coarse,
    /// With more directions and moments than the coarse one
    Light,
    /// What pictures take
    Usual,
    /// With all moments
    Middle,
    /// With more levels and directions than the middle one
    Good,
    /// With more levels and suns than the good one
    Better,
    /// What reference cases take
    Fine,
    /// What the others are judged by
    Finest,
}

impl Fineness {
    /// All of them, from the coarsest.
    pub const ALL: [Self; 8] =
        [Self::Coarse, Self::Light, Self::Usual, Self::Middle, Self::Good, Self::Better, Self::Fine, Self::Finest];

    /// Its resolution.
    #[must_use]
    pub fn resolution(self) -> Resolution {
        match self {
            Self::Coarse => Resolution::COARSE,
            Self::Light => Resolution::LIGHT,
            Self::Usual => Resolution::RENDER,
            Self::Middle => Resolution::MIDDLE,
            Self::Good => Resolution::GOOD,
            Self::Better => Resolution::BETTER,
            Self::Fine => Resolution::FINE,
            Self::Finest => Resolution::FINEST,
        }
    }

    /// Its word in scene files and flags.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Coarse => "coarse",
            Self::Light => "light",
            Self::Usual => "usual",
            Self::Middle => "middle",
            Self::Good => "good",
            Self::Better => "better",
            Self::Fine => "fine",
            Self::Finest => "finest",
        }
    }
}

/// The places of the table.
#[derive(Debug, Clone)]
pub(super) struct Grid {
    /// Radius of the planet in m.
    pub(super) radius: f64,
    /// Altitudes in m, from the ground to the top.
    pub(super) levels: Vec<f64>,
    /// Levels at which scattering jumps so much that the field bends: no polynomial reaches over them.
    pub(super) walls: Vec<bool>,
    /// Altitudes in m between levels at which quadratures are divided.
    pub(super) bends: Vec<f64>,
    /// Altitudes in m of edges of layers, at which sunlight that touches them divides lines.
    pub(super) edges: Vec<f64>,
    pub(super) suns: Suns,
}

/// Zenith angles of the sun, even in u(chi) = chi / spacing + crowd x / sqrt(1 + x^2), x = (chi - centre) / width: widely
/// spaced by day, closely where the sun sets.
#[derive(Debug, Clone)]
pub(super) struct Suns {
    centre: f32,
    per_width: f32,
    per_spacing: f32,
    crowd: f32,
    first: f32,
    per_step: f32,
    /// The angles in radians.
    pub(super) nodes: Vec<f64>,
    /// Their sines and cosines.
    pub(super) sines_cosines: Vec<(f32, f32)>,
}

/// Places between the nodes of [`Suns`]: of each the first of four of them, and the weights of the first, second, third and
/// fourth; all weights 0 in the dark.
#[derive(Debug, Clone, Copy)]
pub(super) struct Between<const N: usize> {
    pub(super) first: [i32; N],
    pub(super) weights: [[f32; N]; 4],
}

impl Suns {
    /// `count` angles from 0 to where it is dark at the top of an atmosphere of scale height about a twelfth of `top`.
    pub(super) fn new(count: usize, radius: f64, top: f64) -> Self {
        // The sun sets there for the air that scatters most, and for the highest.
        let low = (radius / (radius + 0.1 * top)).acos();
        let (centre, width) = (FRAC_PI_2 + low, 2.6 * low);
        let last = (centre + 4.0 * width).min(PI);
        let spacing = 8.0_f64.to_radians();
        let crowd = 10.0;
        let u = |chi: f64| {
            let x = (chi - centre) / width;
            chi / spacing + crowd * x / (1.0 + x * x).sqrt()
        };
        let (first, end) = (u(0.0), u(last));
        let step = (end - first) / (count - 1) as f64;
        let nodes = (0..count).map(|i| {
            let wanted = first + step * i as f64;
            let (mut low, mut high) = (0.0, last);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if u(middle) < wanted { low = middle } else { high = middle }
            }
            if i == 0 { 0.0 } else { 0.5 * (low + high) }
        });
        let nodes: Vec<f64> = nodes.collect();
        Self {
            sines_cosines: nodes.iter().map(|chi| (chi.sin() as f32, chi.cos() as f32)).collect(),
            nodes,
            centre: centre as f32,
            per_width: (1.0 / width) as f32,
            per_spacing: (1.0 / spacing) as f32,
            crowd: crowd as f32,
            first: first as f32,
            per_step: (1.0 / step) as f32,
        }
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.nodes.len()
    }

    /// Between which nodes the angles with these cosines lie, for Lagrange's cubic.
    #[inline(always)]
    pub(super) fn locate<const N: usize>(&self, cosines: &[f32; N]) -> Between<N> {
        let mut between = Between { first: [0; N], weights: [[0.0; N]; 4] };
        let last = (self.nodes.len() - 1) as f32;
        for i in 0..N {
            let chi = acos(cosines[i]);
            let x = (chi - self.centre) * self.per_width;
            let u = chi * self.per_spacing + self.crowd * x / (1.0 + x * x).sqrt();
            let at = (u - self.first) * self.per_step;
            let (first, whole) = nearest((at - 1.5).max(0.0).min(last - 3.0));
            let x = at - whole;
            // The rounding of the last angle is not beyond it.
            let lit = if at <= last + 1e-2 { 1.0 } else { 0.0 };
            let (a, b, c) = (x - 1.0, x - 2.0, x - 3.0);
            let sixth = lit * (1.0 / 6.0);
            between.first[i] = first;
            between.weights[0][i] = -sixth * a * b * c;
            between.weights[1][i] = 0.5 * lit * x * b * c;
            between.weights[2][i] = -0.5 * lit * x * a * c;
            between.weights[3][i] = sixth * x * a * b;
        }
        between
    }
}

/// The whole number nearest to a number from 0 to 4e6, also as a float: added to 2^23 it is in the last bits.
#[inline(always)]
pub(super) fn nearest(x: f32) -> (i32, f32) {
    const SHIFT: f32 = 8_388_608.0;
    let shifted = x + SHIFT;
    ((shifted.to_bits() - SHIFT.to_bits()) as i32, shifted - SHIFT)
}

/// The angle with this cosine in radians, to 1e-7 and the rounding of the cosine (Abramowitz & Stegun 1964, 4.4.46).
#[inline(always)]
fn acos(c: f32) -> f32 {
    const A: [f32; 8] = [
        std::f32::consts::FRAC_PI_2,
        -0.214_598_8,
        0.088_978_99,
        -0.050_174_305,
        0.030_891_88,
        -0.017_088_126,
        0.006_670_09,
        -0.001_262_491_1,
    ];
    let x = c.abs().min(1.0);
    let sum = A[0] + x * (A[1] + x * (A[2] + x * (A[3] + x * (A[4] + x * (A[5] + x * (A[6] + x * A[7]))))));
    let angle = (1.0 - x).sqrt() * sum;
    if c < 0.0 { std::f32::consts::PI - angle } else { angle }
}

impl Grid {
    /// Places for a medium over a planet of that radius in m.
    pub(super) fn new<const L: usize>(medium: &Medium<L>, radius: f64, resolution: &Resolution) -> Self {
        let levels = levels(medium, resolution.levels);
        let mut bends = medium.bends();
        bends.retain(|bend| !levels.contains(bend));
        let jumps = medium.jumps();
        let is_wall = |i: usize| {
            const NEAR_M: f64 = 1e-3;
            let h = levels[i];
            let [below, above] = [-NEAR_M, NEAR_M].map(|off| medium.local_at(h + off).scattering);
            let room = 0.5 * (levels[(i + 1).min(levels.len() - 1)] - levels[i.saturating_sub(1)]);
            let bends = |(a, b): (&f64, &f64)| (a - b).abs() > (WALL.0 * a.max(*b)).max(WALL.1 / room);
            jumps.contains(&h) && below.iter().zip(&above).any(bends)
        };
        let walls = (0..levels.len()).map(is_wall).collect();
        let suns = Suns::new(resolution.suns, radius, medium.top_m());
        let edges = jumps.into_iter().take(MOST_EDGES).collect();
        Self { radius, levels, walls, bends, edges, suns }
    }

    /// Radius of a level in m.
    pub(super) fn level_radius(&self, level: usize) -> f64 {
        self.radius + self.levels[level]
    }

    /// Cosines of the zenith angles of directions at a level, with their weights.
    pub(super) fn zeniths(&self, level: usize, counts: [usize; 3]) -> Vec<(f64, f64)> {
        let [above, between, below] = counts;
        let r = self.level_radius(level);
        let ratio = self.radius / r;
        let horizon = -((1.0 - ratio) * (1.0 + ratio)).max(0.0).sqrt();
        let mut all = Vec::with_capacity(above + between + below);
        // With mu = end + span x^2 the nodes crowd where radiance bends: at the level, at the horizon.
        let mut stretch = |count: usize, end: f64, span: f64| {
            for (x, weight) in gauss(count) {
                let x = 0.5 * (1.0 + x);
                all.push((end + span * x * x, weight * span.abs() * x));
            }
        };
        stretch(above, 0.0, 1.0);
        if horizon < 0.0 {
            stretch(between, horizon, -horizon);
        }
        stretch(below, horizon, -(1.0 + horizon));
        all
    }
}

/// Most edges of layers that divide lines.
const MOST_EDGES: usize = 8;

/// By which share of itself the scattering coefficient changes at a wall, and by which optical depth of the way to the next level.
const WALL: (f64, f64) = (0.3, 0.01);

/// Altitudes at equal steps of a measure that goes half with a power of the altitude, half with the scatterers below;
/// where the density of a scatterer jumps, there is a level.
fn levels<const L: usize>(medium: &Medium<L>, count: usize) -> Vec<f64> {
    const FINE: usize = 2000;
    let top = medium.top_m();
    let altitude = |i: usize| top * (i as f64 / FINE as f64).powi(3);
    let mut below = vec![0.0];
    let mut sum = 0.0;
    for i in 0..FINE {
        let (a, b) = (altitude(i), altitude(i + 1));
        let local = medium.local_at(0.5 * (a + b));
        sum += (b - a) * local.scattering.iter().sum::<f64>();
        below.push(sum);
    }
    let measure = |i: usize| {
        let share = altitude(i) / top;
        let scatterers = if sum > 0.0 { below[i] / sum } else { 0.0 };
        0.55 * share.powf(0.4) + 0.45 * scatterers
    };
    let mut levels = Vec::with_capacity(count);
    let mut i = 0;
    for k in 0..count {
        let wanted = k as f64 / (count - 1) as f64 * measure(FINE);
        while i + 1 < FINE && measure(i + 1) < wanted {
            i += 1;
        }
        let (a, b) = (measure(i), measure(i + 1));
        let fraction = if b > a { ((wanted - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        levels.push(altitude(i) + fraction * (altitude(i + 1) - altitude(i)));
    }
    levels[0] = 0.0;
    levels[count - 1] = top;
    for jump in medium.jumps() {
        let nearest = (1..count - 1).min_by(|&a, &b| (levels[a] - jump).abs().total_cmp(&(levels[b] - jump).abs()));
        if let Some(nearest) = nearest
            && jump > levels[nearest - 1]
            && jump < levels[nearest + 1]
        {
            levels[nearest] = jump;
        }
    }
    levels
}

/// Nodes and weights of Gauss' and Legendre's rule on -1 to 1, by Newton's method on the Legendre polynomial.
pub(super) fn gauss(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    let node = |i: usize| {
        let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..20 {
            let (mut before, mut value) = (1.0, x);
            for l in 2..=count {
                let l = l as f64;
                (before, value) = (value, ((2.0 * l - 1.0) * x * value - (l - 1.0) * before) / l);
            }
            slope = n * (before - x * value) / (1.0 - x * x);
            x -= value / slope;
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gauss_integrates_polynomials() {
        for count in 1..=12 {
            for power in 0..2 * count {
                let sum: f64 = gauss(count).iter().map(|(x, w)| w * x.powi(power as i32)).sum();
                let exact = if power % 2 == 0 { 2.0 / (power as f64 + 1.0) } else { 0.0 };
                assert!((sum - exact).abs() < 1e-13, "{count} nodes, power {power}: {sum}");
            }
        }
    }

    #[test]
    fn cubics_of_the_suns_place_are_met() {
        let suns = Suns::new(36, 6.371e6, 1e5);
        for (i, chi) in suns.nodes.iter().enumerate() {
            let Between { first: [first], weights } = suns.locate(&[chi.cos() as f32]);
            for power in 0..4 {
                let at = |k: i32| (f64::from(k) - 10.0).powi(power);
                let sum: f64 = (0..4).map(|k| f64::from(weights[k as usize][0]) * at(first + k)).sum();
                // Single precision: 1e-7 of the sum of the terms, and of the cosine near 1.
                let allowed = 2e-4 * (1.0 + at(i as i32).abs());
                assert!((sum - at(i as i32)).abs() < allowed, "node {i}, power {power}: {sum}");
            }
        }
    }
}
