//! The isotropic closure of all orders: Hillaire 2020, "A scalable and production ready sky and atmosphere rendering technique",
//! section 5.5, on Airlight's own atmosphere, at every wavelength.
//!
//! Light scattered twice or more is taken for even in direction, and the air around a place for like the place itself. Then, p_u =
//! 1/(4 pi), at altitude h with the sun's cosine mu:
//!
//! L_2 = int L' p_u d omega       light of the second order that arrives (equations 5 and 6): L' along each direction the light of
//!                              sun and ground, scattered once evenly,
//! f = int L_f p_u d omega        the share of evenly emitted light that comes back (equations 7 and 8): L_f = int k_s T dt,
//! Psi = L_2 / (1 - f)          the geometric series of further orders (equations 9 and 10),
//!
//! and L = int T (k_s P T_sun + k_s Psi) ds. Psi is a table over h and mu, both even, linear between its nodes: 32 x 32, from 64
//! directions with 20 points each, as in the paper. The phase function of light scattered once is the whole one. Any sun, observer
//! and air; the ground reflects sunlight alone.

use super::march::{Air, At};
use crate::geometry::Place;
use crate::sampling::spiral;
use crate::vectors::exp_minus;
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Altitudes and cosines of the sun in the table.
const SIZE: usize = 32;

/// Directions around a node, and points along each.
const DIRECTIONS: u32 = 64;
const POINTS: u32 = 20;

/// An atmosphere and its field Psi.
#[derive(Debug)]
pub struct Isotropic<const L: usize> {
    pub(super) air: Air<L>,
    pub(super) further: Further<L>,
}

impl<const L: usize> Isotropic<L> {
    pub(super) fn new(air: Air<L>) -> Self {
        Self { further: Further::new(&air), air }
    }

    pub(super) fn radiance(&self, from: Place, direction: DVec3, sun: DVec3) -> [f64; L] {
        self.air.radiance((from, direction), sun, self.air.steps(), Some(&self.further))
    }

    /// Bytes of the tables.
    pub(super) fn bytes(&self) -> usize {
        8 * L * self.further.field.len() + self.air.columns().bytes()
    }
}

/// The field Psi of an atmosphere.
#[derive(Debug)]
pub(super) struct Further<const L: usize> {
    top_m: f64,
    /// Psi per unit solar irradiance in sr^-1 [altitude][cosine].
    field: Vec<[f64; L]>,
}

impl<const L: usize> Further<L> {
    pub(super) fn new(air: &Air<L>) -> Self {
        let top_m = air.medium().top_m();
        let rows = (0..SIZE).into_par_iter().map(|i| row(air, top_m * i as f64 / (SIZE - 1) as f64));
        Self { top_m, field: rows.collect::<Vec<_>>().concat() }
    }

    /// Psi at an altitude in m, where the sun has that cosine of zenith angle.
    pub(super) fn at(&self, altitude_m: f64, cosine: f64) -> [f64; L] {
        let last = (SIZE - 1) as f64;
        let place = |x: f64| {
            let at = x.clamp(0.0, 1.0) * last;
            let node = (at as usize).min(SIZE - 2);
            (node, at - node as f64)
        };
        let ((h, a), (c, b)) = (place(altitude_m / self.top_m), place(0.5 * (cosine + 1.0)));
        let node = |i: usize, k: usize| &self.field[i * SIZE + k];
        let corners = [node(h, c), node(h, c + 1), node(h + 1, c), node(h + 1, c + 1)];
        let shares = [(1.0 - a) * (1.0 - b), (1.0 - a) * b, a * (1.0 - b), a * b];
        let mut sum = [0.0; L];
        for (corner, share) in corners.into_iter().zip(shares) {
            for j in 0..L {
                sum[j] += share * corner[j];
            }
        }
        sum
    }
}

/// Psi at an altitude in m for all suns.
fn row<const L: usize>(air: &Air<L>, altitude_m: f64) -> Vec<[f64; L]> {
    let suns: Vec<DVec3> = (0..SIZE)
        .map(|k| {
            let cosine = 2.0 * k as f64 / (SIZE - 1) as f64 - 1.0;
            DVec3::new(((1.0 - cosine) * (1.0 + cosine)).max(0.0).sqrt(), 0.0, cosine)
        })
        .collect();
    let from = Place::above(altitude_m);
    let share = 1.0 / f64::from(DIRECTIONS);
    let (mut second, mut returned) = (vec![[0.0; L]; SIZE], [0.0; L]);
    for i in 0..DIRECTIONS {
        let direction = spiral(i, DIRECTIONS, [-1.0, 1.0]);
        let chord = air.march(from, direction, POINTS, |At { place, local, weight }| {
            let scattered: [f64; L] = std::array::from_fn(|j| share * weight[j] * local.scattering[j]);
            for j in 0..L {
                returned[j] += scattered[j];
            }
            for (sum, sun) in second.iter_mut().zip(&suns) {
                let Some(light) = air.sunlight(place, *sun) else { continue };
                for j in 0..L {
                    sum[j] += scattered[j] * light[j] / (4.0 * PI);
                }
            }
        });
        let Some(chord) = chord.filter(|chord| chord.ends_on_ground()) else { continue };
        let (through, foot) = (exp_minus(chord.total()), chord.foot(from, direction));
        for (sum, sun) in second.iter_mut().zip(&suns) {
            let light = air.reflected(foot, *sun);
            for j in 0..L {
                sum[j] += share * through[j] * light[j];
            }
        }
    }
    // The share that comes back is below 1 but for the rule's error, which thick air with coarse points could bring there.
    let series = returned.map(|f| 1.0 / (1.0 - f.min(0.99)));
    second.into_iter().map(|light| std::array::from_fn(|j| light[j] * series[j])).collect()
}
