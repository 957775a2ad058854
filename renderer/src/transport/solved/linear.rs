//! Linear polarisation: what molecules need of Q and U, and make of it.
//!
//! Let K(n) = (1/2) [I (1 - n n^T) + Q (e1 e1^T - e2 e2^T) + U (e1 e2^T + e2 e1^T)] be the coherency tensor of the light seen in a
//! direction n, e1 horizontal towards growing azimuth and e2 upwards. A dipole scatters C = int K d omega across the new direction:
//! I = 3/(8 pi) (tr C - n^T C n), Q = 3/(8 pi) (e1^T C e1 - e2^T C e2), U = 3/(8 pi) 2 e1^T C e2. Of C mirror symmetry leaves four numbers,
//! its trace and its parts along the symmetric traceless T_m whose n^T T_m n is S_2m(mu) cos(m phi). So the scheme is that of
//! radiance, with vector harmonics in place of Schmidt's: (1, 0, 0) and
//!
//! Y_2m = (S_2m cos(m phi), q_m cos(m phi), u_m sin(m phi)),
//! q = ((3/2) s^2, -sqrt(3) mu s, (sqrt(3)/2) (1 + mu^2)), u = (0, sqrt(3) s, -sqrt(3) mu),  s = sqrt(1 - mu^2):
//!
//! M_k = int (I, Q, U) . Y_k d omega, and molecules send k_s (b_0 M_0 Y_00 + b_2 sum_m M_2m Y_2m), b_0 and b_2 as of their phase function
//! (docs/polarisation.md). A line, its verticals and the planet's centre lie in one plane, so e1 and e2 are the same all along it. Aerosol
//! scatters radiance by its own moments and sends out radiance alone, but for what onward.rs says.

use super::Solved;
use super::grid::Between;
use super::harmonics::Moments;
use super::line::Crossing;
use super::orders::{Around, Batch, Field, Gathered, LANES, Turns, azimuth_cosines};
use super::rays::{Line, Node};
use super::sight::Lit;
use crate::geometry::Place;
use crate::polarisation::{Frame, horizontal};
use crate::vectors::add_scaled;
use glam::DVec3;
use std::f32::consts::PI;

/// Q and U.
pub(super) type Linear<const L: usize> = [[f32; L]; 2];

/// q_m and u_m for m = 0, 1, 2 at a zenith angle with the cosine mu.
pub(super) fn harmonics(mu: f64) -> [[f64; 3]; 2] {
    const ROOT: f64 = 1.732_050_807_568_877_2;
    let sine = ((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt();
    [[1.5 * sine * sine, -ROOT * mu * sine, 0.5 * ROOT * (1.0 + mu * mu)], [0.0, ROOT * sine, -ROOT * mu]]
}

/// q_m cos(m phi) and u_m sin(m phi) for m = 0, 1, 2.
#[inline(always)]
fn turned([q, u]: &[[f32; 3]; 2], cos: f32, sin: f32) -> [[f32; 3]; 2] {
    let (cos_2, sin_2) = (2.0 * cos * cos - 1.0, 2.0 * cos * sin);
    [[q[0], q[1] * cos, q[2] * cos_2], [0.0, u[1] * sin, u[2] * sin_2]]
}

/// Moments of all suns at a level.
struct Level<'a, const L: usize> {
    rows: &'a [[f32; L]],
    moments: &'a Moments,
}

impl<const L: usize> Level<'_, L> {
    /// alpha M_2m + (beta - alpha) I_2m at a place that lies between four suns, the first of them and their weights given.
    #[inline(always)]
    fn source(&self, first: usize, weights: [f32; 4], m: usize, [alpha, beta]: &[[f32; L]; 2]) -> [f32; L] {
        let mut sum = self.between(first, weights, 1 + m);
        for j in 0..L {
            sum[j] *= alpha[j];
        }
        if let Some(twin) = self.moments.twin(m) {
            let radiance = self.between(first, weights, twin);
            for j in 0..L {
                sum[j] += (beta[j] - alpha[j]) * radiance[j];
            }
        }
        sum
    }

    #[inline(always)]
    fn between(&self, first: usize, weights: [f32; 4], moment: usize) -> [f32; L] {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| &self.rows[(first + k) * self.moments.count() + moment]);
        let mut sum = [0.0; L];
        for j in 0..L {
            sum[j] = (weights[0] * a[j] + weights[1] * b[j]) + (weights[2] * c[j] + weights[3] * d[j]);
        }
        sum
    }
}

impl<const L: usize> Around<'_, L> {
    /// Adds Q and U of the sources of a node to those of its line, for each sun and azimuth.
    #[inline(always)]
    pub(super) fn polarise(&self, turns: &Turns, node: &Node<L>, field: &Field<L>, linear: &mut [Linear<L>]) {
        let harmonics = harmonics(f64::from(node.zenith)).map(|row| row.map(|v| v as f32));
        let (suns, count) = (self.suns.count(), self.moments.count());
        let rows = &field.moments[node.level * suns * count..][..suns * count];
        let level = Level { rows, moments: self.moments };
        for (batch, linear) in turns.batches.iter().zip(linear.as_chunks_mut::<LANES>().0) {
            let there = batch.there(node.frame);
            let place = self.suns.locate(&there);
            let cosines = batch.cosines(node.zenith, &there);
            for (i, [sum_q, sum_u]) in linear.iter_mut().enumerate() {
                let cos = cosines[i];
                let [q, u] = turned(&harmonics, cos, (1.0 - cos * cos).max(0.0).sqrt());
                let weights = place.weights.map(|weights| weights[i]);
                for m in 0..3 {
                    let source = level.source(place.first[i] as usize, weights, m, &node.dipoles);
                    add_scaled(sum_q, q[m], &source);
                    add_scaled(sum_u, u[m], &source);
                }
            }
        }
    }
}

impl Batch {
    /// Q and U of sunlight scattered once by dipoles, over b_2, along a line with the cosine `zenith`: with the sun in the direction s
    /// -(3/2) ((e1 . s)^2 - (e2 . s)^2) and -(3/2) 2 (e1 . s) (e2 . s). They are the same at all places of the line.
    #[inline(always)]
    pub(super) fn sunlight(&self, zenith: f32) -> [[f32; 2]; LANES] {
        let sine = ((1.0 - zenith) * (1.0 + zenith)).max(1e-12).sqrt();
        std::array::from_fn(|i| {
            let (height, towards) = (self.cosine[i], self.towards[i]);
            // s = towards d + along e2 + across e1, and on this half of the circle e1 points away from the sun.
            let along = (height - zenith * towards) / sine;
            let across = -((1.0 - towards) * (1.0 + towards) - along * along).max(0.0).sqrt();
            [-1.5 * (across * across - along * along), -3.0 * across * along]
        })
    }
}

impl<const L: usize> Gathered<L> {
    /// As [`Gathered::add`], of Q and U: what they add to the moments of molecules.
    #[inline(always)]
    pub(super) fn add_linear<const AZIMUTHS: usize>(&mut self, line: &Line<L>, linear: &[Linear<L>]) {
        let harmonics = harmonics(line.zenith).map(|row| row.map(|v| v as f32));
        let cosines = azimuth_cosines::<AZIMUTHS>();
        // Twice for the other half of the circle.
        let weight = line.weight as f32 * 2.0 * PI / AZIMUTHS as f32;
        let suns = self.ground.len();
        let count = self.moments.len() / suns;
        for (here, linear) in self.moments.chunks_exact_mut(count).zip(linear.as_chunks::<AZIMUTHS>().0) {
            for ([light_q, light_u], &cos) in linear.iter().zip(&cosines) {
                let [q, u] = turned(&harmonics, cos, (1.0 - cos * cos).max(0.0).sqrt());
                for m in 0..3 {
                    add_scaled(&mut here[1 + m], weight * q[m], light_q);
                    add_scaled(&mut here[1 + m], weight * u[m], light_u);
                }
            }
        }
    }
}

/// Cosine and sine of the azimuth of a direction from the sun's at a place with the vertical `up`; e1 = (-sin phi, cos phi, 0) is
/// horizontal there, and e1 x up = (cos phi, sin phi, 0).
#[inline(always)]
fn azimuth(e1: DVec3, up: DVec3, sun: DVec3) -> [f32; 2] {
    let (cos, sin) = (e1.cross(up).dot(sun), -e1.dot(sun));
    let across = cos.hypot(sin);
    if across > 1e-12 { [(cos / across) as f32, (sin / across) as f32] } else { [1.0, 0.0] }
}

impl<const L: usize> Solved<L> {
    /// Moments of all suns at a level.
    fn level(&self, level: usize) -> Level<'_, L> {
        let (suns, moments) = (self.grid.suns.count(), &self.optics.moments);
        Level { rows: &self.field.moments[level * suns * moments.count()..][..suns * moments.count()], moments }
    }

    /// Q and U of the sources at a place between levels, each with its share, in a direction looked in, where the species scatter by these
    /// coefficients; and the frame of [`horizontal`], to which they are referred. Nothing but the peaks counts as not scattered,
    /// so that of particles all that is of degree 2 is there.
    #[inline(always)]
    pub(super) fn diffuse_linear(
        &self,
        levels: &[(usize, f32)],
        (place, direction, sun): (Place, DVec3, DVec3),
        scattering: &[[f64; L]],
    ) -> (Frame, Linear<L>) {
        let up = place.up;
        let e1 = horizontal(up, direction);
        let Between { first: [first], weights } = self.grid.suns.locate(&[up.dot(sun) as f32]);
        let [cos, sin] = azimuth(e1, up, sun);
        let harmonics = harmonics(up.dot(direction).clamp(-1.0, 1.0)).map(|row| row.map(|v| v as f32));
        let [q, u] = turned(&harmonics, cos, sin);
        let dipoles = self.optics.onward.scattered(scattering).map(|row| row.map(|v| v as f32));
        let mut sum = [[0.0; L]; 2];
        for &(level, share) in levels {
            let (level, weights) = (self.level(level), weights.map(|weight| share * weight[0]));
            for m in 0..3 {
                let source = level.source(first as usize, weights, m, &dipoles);
                add_scaled(&mut sum[0], q[m], &source);
                add_scaled(&mut sum[1], u[m], &source);
            }
        }
        (Frame::new(direction, e1), sum)
    }
}

impl<const L: usize> Lit<'_, L> {
    /// Adds Q and U of the sources at a crossing, referred to [`horizontal`], with the weights
    /// there times alpha and beta (onward.rs).
    #[inline(always)]
    pub(super) fn add_linear(&self, place: &Crossing, dipoles: &[[f64; L]; 2], sum: &mut [[f64; L]; 2]) {
        let grid = &self.sight.solved.grid;
        let dipoles = dipoles.map(|row| row.map(|v| v as f32));
        let up = self.position(place.s).normalize();
        let Between { first: [first], weights } = grid.suns.locate(&[up.dot(self.sun) as f32]);
        let [cos, sin] = azimuth(horizontal(self.sight.from.up, self.direction), up, self.sun);
        let zenith = (place.s / grid.level_radius(place.level)).clamp(-1.0, 1.0);
        let harmonics = harmonics(zenith).map(|row| row.map(|v| v as f32));
        let [q, u] = turned(&harmonics, cos, sin);
        let level = self.sight.solved.level(place.level);
        let [sum_q, sum_u] = sum;
        for m in 0..3 {
            let source = level.source(first as usize, weights.map(|weight| weight[0]), m, &dipoles);
            for j in 0..L {
                sum_q[j] += f64::from(q[m] * source[j]);
                sum_u[j] += f64::from(u[m] * source[j]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::grid::Suns;
    use super::super::orders::AZIMUTHS;
    use super::*;

    #[test]
    fn sunlight_scattered_once_is_a_sum_of_vector_harmonics() {
        // b_2 sum_m Y_2m(d) S_2m(sun) for the sun at azimuth 0; single precision.
        let suns = Suns::new(8, 6.371e6, 1e5);
        for zenith in [-0.9_f32, -0.2, 0.1, 0.7] {
            let turns = Turns::new::<AZIMUTHS>(f64::from(zenith), &suns);
            let harmonics = harmonics(f64::from(zenith)).map(|row| row.map(|v| v as f32));
            for (b, batch) in turns.batches.iter().enumerate() {
                for (lane, [q, u]) in batch.sunlight(zenith).into_iter().enumerate() {
                    let sun = (b * LANES + lane) / AZIMUTHS;
                    let mut schmidt = Vec::new();
                    Moments::new(2, false).at(suns.nodes[sun].cos(), &mut schmidt);
                    let cos = azimuth_cosines::<AZIMUTHS>()[lane % AZIMUTHS];
                    let rows = turned(&harmonics, cos, (1.0 - cos * cos).sqrt());
                    let [sum_q, sum_u] = rows.map(|row| (0..3).map(|m| row[m] * schmidt[1 + m] as f32).sum::<f32>());
                    assert!((q - sum_q).abs() < 2e-5 && (u - sum_u).abs() < 2e-3, "{q} {sum_q}, {u} {sum_u}");
                }
            }
        }
    }
}
