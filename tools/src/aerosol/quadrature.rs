//! Nested rules for averages over sizes: each has the nodes of the one before and as many between them.

use super::size::Sizes;
use crate::mie::RefractiveIndex;
use std::f64::consts::TAU;

/// Least k with which spheres of any size give a smooth integrand: their resonances are damped.
const DAMPED: f64 = 0.1;

/// Largest size parameter up to which clear spheres do: narrow resonances need larger ones.
const WIDE_RESONANCES: f64 = 20.0;

/// Least k of particles that absorb: it damps the narrowest resonances.
pub const ABSORBING: f64 = 5e-3;

/// Power p of the radius: nodes are gathered where r^p n(ln r) is largest. Between cross-sections (2) and what the largest
/// spheres do ahead (4).
const GATHERED_AT: f64 = 3.0;

/// Half the width of the gathering in standard deviations of ln r.
const GATHERED_WITHIN: f64 = 1.2;

/// How the nodes of a nested rule lie between the limits, which are 0 and 1 here: the integral of f over 0..1 is
/// about h sum w_i f(u_i), i = 0 ..= 1/h, the trapezoidal rule in t = i h of f(u(t)) du/dt. `study size-quadrature`
/// compares them with each other and with rules that are not nested.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Nodes {
    /// u = t, w = 1: the trapezoidal rule itself. A limit where the integrand does not vanish leaves an error of h^2.
    Uniform,
    /// u = t - sin(2 pi t) / (2 pi), w = 1 - cos(2 pi t) (the second transformation of Sidi 1993): the integrand becomes
    /// periodic so far that a limit where it does not vanish leaves an error of h^6, not of h^2. The limits have no weight.
    Periodic,
    /// u = centre + width tan(a t + b), the quantiles of a Cauchy distribution: nodes are dense about the centre and rare
    /// where a rough integrand has no weight, with an error of h^2 from the limits.
    Gathered {
        /// Where the nodes are densest, 0 to 1.
        centre: f64,
        /// Distance from there at which they are half as dense, above 0.
        width: f64,
    },
}

impl Nodes {
    /// What suits spheres of index `m` with these sizes between two limits of ln r, at a wave number in m^-1: `Periodic`
    /// where the integrand is smooth (k >= 0.1, or x <= 20 up to the limit), [`Nodes::gathered`] where narrow resonances make it
    /// rough (k < 0.005), `Uniform` between.
    #[must_use]
    pub fn suiting(m: RefractiveIndex, sizes: &Sizes, (low, high): (f64, f64), wave_number: f64) -> Self {
        if m.k() >= DAMPED || wave_number * high.exp() <= WIDE_RESONANCES {
            Self::Periodic
        } else if m.k() >= ABSORBING {
            Self::Uniform
        } else {
            Self::gathered(sizes, (low, high))
        }
    }

    /// `Gathered` about ln r_m + 3 s^2 of a log-normal, or the limit next to it, within 1.2 s; `Uniform` for measured sizes,
    /// whose density has corners anywhere.
    #[must_use]
    pub fn gathered(sizes: &Sizes, (low, high): (f64, f64)) -> Self {
        let Sizes::LogNormal(sizes) = sizes else { return Self::Uniform };
        let centre = (sizes.peak(GATHERED_AT) - low) / (high - low);
        Self::Gathered { centre: centre.clamp(0.0, 1.0), width: GATHERED_WITHIN * sizes.deviation() / (high - low) }
    }

    /// Node `i` of 0 ..= `intervals` and its weight: (u_i, w_i).
    #[must_use]
    pub fn node(self, i: u32, intervals: u32) -> (f64, f64) {
        let t = f64::from(i) / f64::from(intervals);
        let end = if i == 0 || i == intervals { 0.5 } else { 1.0 };
        match self {
            Self::Uniform => (t, end),
            Self::Periodic => (t - (TAU * t).sin() / TAU, 1.0 - (TAU * t).cos()),
            Self::Gathered { centre, width } => {
                let first = (-centre / width).atan();
                let whole = ((1.0 - centre) / width).atan() - first;
                let tangent = (first + whole * t).tan();
                (centre + width * tangent, end * whole * width * (1.0 + tangent * tangent))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::size::LogNormal;
    use super::*;

    const ALL: [Nodes; 3] = [Nodes::Uniform, Nodes::Periodic, Nodes::Gathered { centre: 0.7, width: 0.2 }];

    fn integral(nodes: Nodes, intervals: u32, f: impl Fn(f64) -> f64) -> f64 {
        let sum: f64 = (0..=intervals).map(|i| nodes.node(i, intervals)).map(|(u, w)| w * f(u)).sum();
        sum / f64::from(intervals)
    }

    #[test]
    fn errors_at_the_limits_fall_by_their_orders() {
        // The integral of exp(u) is e - 1; it vanishes at neither limit.
        let exact = 1.0_f64.exp_m1();
        for (nodes, intervals, order) in [(ALL[0], 32, 2), (ALL[1], 16, 6), (ALL[2], 64, 2)] {
            let error = |n| integral(nodes, n, f64::exp) / exact - 1.0;
            let fall = error(intervals) / error(2 * intervals);
            // The next power of h is some percent of the first.
            assert!((fall / 2.0_f64.powi(order) - 1.0).abs() < 0.1, "{nodes:?}: falls by {fall}");
        }
    }

    #[test]
    fn each_rule_has_the_nodes_of_the_one_before() {
        for nodes in ALL {
            for i in 0..=50 {
                assert_eq!(nodes.node(i, 50), nodes.node(2 * i, 100), "{nodes:?}, node {i}");
            }
            // Rounding of a tangent.
            assert!(nodes.node(0, 50).0.abs() < 1e-15 && (nodes.node(50, 50).0 - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn gathered_nodes_are_half_as_dense_at_their_width() {
        let density = |u: f64| {
            let count = (0..=100_000).filter(|&i| (ALL[2].node(i, 100_000).0 - u).abs() < 0.01).count();
            count as f64
        };
        // Counts of thousands over a hundredth on either side.
        assert!((density(0.5) / density(0.7) - 0.5).abs() < 0.01);
    }

    #[test]
    fn absorbers_and_small_spheres_are_smooth() {
        let index = |k| RefractiveIndex::new(1.5, k).expect("an index");
        let sizes = Sizes::from(LogNormal::new(1e-6, 2.0, 1e-9, 1e-4).expect("sound"));
        let limits = (1e-9_f64.ln(), 1e-4_f64.ln());
        assert_eq!(Nodes::suiting(index(0.4), &sizes, limits, 1e7), Nodes::Periodic);
        assert_eq!(Nodes::suiting(index(1e-8), &sizes, limits, 1e5), Nodes::Periodic);
        assert_eq!(Nodes::suiting(index(0.03), &sizes, limits, 1e7), Nodes::Uniform);
        let Nodes::Gathered { centre, .. } = Nodes::suiting(index(1e-8), &sizes, limits, 1e7) else {
            panic!("clear and large");
        };
        let s = 2.0_f64.ln();
        assert!((centre * 1e5_f64.ln() - 1e3_f64.ln() - 3.0 * s * s).abs() < 1e-12, "{centre}");
    }
}
