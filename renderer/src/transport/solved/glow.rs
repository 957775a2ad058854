//! Where on a line light comes from: a density of distances, drawn for each line itself from small tables.
//!
//! At equal steps of a [`Way`] the light that arrives is about
//! sum_k beta_k(h) (p_k T(h, mu) + M_k(h, mu)) e^-tau ds/dv: beta_k a species' scattering coefficient and p_k its phase function of sunlight,
//! T the sunlight that arrives, M_k what it makes of other light, tau by the extinction at the steps. All but p_k are those of a group of
//! wavelengths that the air takes about as much from: of all together, light of the shortest would come from much too far away.

use super::guide::{EVEN, Way};
use super::line::MOST_SPECIES;
use super::sources::Sources;
use crate::atmosphere::Chord;
use crate::geometry::Place;
use crate::transport::radiation::Scalar;
use glam::DVec3;
use rayon::prelude::*;

/// Altitudes and zenith angles of the sun for which light is tabulated, altitudes for which air is.
const ROWS: usize = 64;
const SUNS: usize = 256;
const LAYERS: usize = 2048;

/// Cosines of the sun's zenith angle lie evenly in mu / (|mu| + this): closest where the sun sets.
const LOW: f64 = 0.3;

/// Distances.
const DISTANCES: usize = 32;

/// Groups of wavelengths, even in the logarithm of the extinction at the ground.
const GROUPS: usize = 2;

/// Light and air of a table, of which only proportions count: sums and means over the wavelengths of each group.
#[derive(Debug)]
pub(super) struct Glow {
    radius: f64,
    top: f64,
    /// [altitude][sun]: sums, by shares of a norm.
    light: Vec<[Light; GROUPS]>,
    /// [altitude]: mean extinction in m^-1.
    extinction: Vec<[f32; GROUPS]>,
    /// [altitude][species]: mean scattering coefficients in m^-1.
    scattering: Vec<[f32; GROUPS]>,
    /// Which species are molecules.
    molecular: Vec<bool>,
}

/// Directions from which other light comes to be scattered: towards the sun, across, away from it, all level, up and down.
const LOOKS: usize = 5;

/// Light at a place.
#[derive(Debug, Clone, Copy)]
struct Light {
    /// Sunlight that arrives.
    sun: f32,
    /// What molecules make of other light, per scattering coefficient.
    molecular: f32,
    /// What the commonest particles make of it, looked at in each direction.
    particles: [f32; LOOKS],
}

/// A line looked along.
#[derive(Debug, Clone, Copy)]
struct Looked {
    /// The mean over wavelengths of each species' phase function of sunlight.
    phases: [f32; MOST_SPECIES],
    /// Shares of the directions of [`LOOKS`].
    looks: [f32; LOOKS],
}

impl Looked {
    /// Along `direction` from a place with that vertical, with the sun there.
    #[inline(always)]
    fn new<const L: usize>(sources: &Sources<'_, L>, up: DVec3, direction: DVec3, sun: DVec3) -> Self {
        let mut phases = [0.0; MOST_SPECIES];
        let cosine = direction.dot(sun);
        for (mean, one) in phases.iter_mut().zip(&sources.optics().species) {
            let values = one.phase.values(cosine);
            *mean = ((0..L).map(|j| values[j] * one.whole[j]).sum::<f64>() / L as f64) as f32;
        }
        let rises = direction.dot(up);
        let level = (1.0 - sun.dot(up).powi(2)).max(1e-12);
        let towards = cosine - rises * sun.dot(up);
        let towards = towards * towards.abs() / level;
        let across = 1.0 - rises * rises - towards.abs();
        let looks = [towards, across, -towards, rises * rises.abs(), -rises * rises.abs()];
        Self { phases, looks: looks.map(|share| share.max(0.0) as f32) }
    }
}

/// The group of each wavelength, by its extinction.
fn groups<const L: usize>(extinction: &[f64; L]) -> [usize; L] {
    let logarithms = extinction.map(|one| one.max(1e-300).ln());
    let (least, most) = logarithms
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), &one| (least.min(one), most.max(one)));
    let width = (most - least).max(1e-9) / GROUPS as f64;
    logarithms.map(|one| (((one - least) / width) as usize).min(GROUPS - 1))
}

impl Glow {
    pub(super) fn new<const L: usize>(sources: &Sources<'_, L>, norm: &[f64; L]) -> Self {
        let solved = sources.solved;
        let species = &sources.optics().species;
        let levels = &solved.grid.levels;
        let top = levels[levels.len() - 1];
        // Not quite the top, where there is nothing.
        let altitude = |i: usize, count: usize| (top * (i as f64 / (count - 1) as f64).powi(2)).min(0.999 * top);
        let medium = &solved.optics.medium;
        let groups = groups(&medium.local_at(0.0).extinction);
        let sum = |of: &dyn Fn(usize) -> f64| -> [f64; GROUPS] {
            let mut sums = [0.0; GROUPS];
            (0..L).for_each(|j| sums[groups[j]] += of(j));
            sums
        };
        let counts = sum(&|_| 1.0).map(|count| count.max(1.0));
        let mean = |of: &dyn Fn(usize) -> f64| -> [f32; GROUPS] {
            let sums = sum(of);
            std::array::from_fn(|g| (sums[g] / counts[g]) as f32)
        };
        let light = |row: usize| {
            let place = Place::above(altitude(row, ROWS));
            let here = sources.scattering(place.altitude_m);
            let mut harmonics = Vec::new();
            let commonest = (0..species.len())
                .filter(|&k| !species[k].is_molecular())
                .max_by(|&a, &b| here[a].iter().sum::<f64>().total_cmp(&here[b].iter().sum()));
            let molecules = species.iter().position(|one| one.is_molecular());
            let of_sun = |i: usize| {
                let x = (2.0 * i as f64 / (SUNS - 1) as f64 - 1.0) / (1.0 + LOW);
                let mu = LOW * x / (1.0 - x.abs());
                let sun = DVec3::new(((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt(), 0.0, mu);
                let mut scattered = |k: usize, direction: DVec3| {
                    let mut one = [[0.0; L]; MOST_SPECIES];
                    one[k] = [1.0; L];
                    let seen = sources.diffuse::<Scalar>(place, (direction, ()), sun, &one, &mut harmonics);
                    sum(&|j| seen[j].max(0.0) / norm[j])
                };
                let arrives = sources.columns().transmittance(place, sun).unwrap_or([0.0; L]);
                let arrives = sum(&|j| arrives[j] / norm[j]);
                let molecular = molecules.map_or([0.0; GROUPS], |k| scattered(k, DVec3::Y));
                let looks = [DVec3::X, DVec3::Y, -DVec3::X, DVec3::Z, -DVec3::Z];
                let particles = looks.map(|look| commonest.map_or([0.0; GROUPS], |k| scattered(k, look)));
                std::array::from_fn(|g| Light {
                    sun: arrives[g] as f32,
                    molecular: molecular[g] as f32,
                    particles: particles.map(|look| look[g] as f32),
                })
            };
            (0..SUNS).map(of_sun).collect::<Vec<_>>()
        };
        let layers = || (0..LAYERS).map(|layer| altitude(layer, LAYERS));
        let extinction = |h: f64| {
            let extinction = medium.local_at(h).extinction;
            mean(&|j| extinction[j])
        };
        let scattering = |h: f64| sources.scattering(h).into_iter().take(species.len()).map(|one| mean(&|j| one[j]));
        Self {
            radius: solved.grid.radius,
            top,
            light: (0..ROWS).into_par_iter().flat_map_iter(light).collect(),
            extinction: layers().map(extinction).collect(),
            scattering: layers().flat_map(scattering).collect(),
            molecular: species.iter().map(|one| one.is_molecular()).collect(),
        }
    }

    /// A place on the way from `place` in `direction`: v, and its density, which is even in each of equal steps of v.
    #[inline(always)]
    pub(super) fn draw<const L: usize>(
        &self,
        sources: &Sources<'_, L>,
        (chord, way): (&Chord<'_, L>, &Way),
        (place, direction): (Place, DVec3),
        sun: DVec3,
        u: f64,
    ) -> (f64, f64) {
        let looked = Looked::new(sources, place.up, direction, sun);
        const N: usize = DISTANCES;
        let Way { lowest, first, last, radius } = *way;
        let perigee = chord.perigee();
        let (begin, rise) = (first as f32, ((last - first) / N as f64) as f32);
        let (above_perigee, perigees) = ((lowest - perigee) as f32, 2.0 * (radius + perigee) as f32);
        let (lowest, radius, height) = (lowest as f32, radius as f32, 1.0 / self.top as f32);
        let along = (place.up.dot(sun) * (self.radius + place.altitude_m)) as f32;
        let (across, offset) = (direction.dot(sun) as f32, chord.travelled(0.0) as f32);
        let (mut nodes, mut layers, mut steps) = ([0; N], [0; N], [0.0; N]);
        for i in 0..N {
            let q = begin + (i as f32 + 0.5) * rise;
            let (altitude, above) = (lowest + q * q, above_perigee + q * q);
            let distance = (above * (perigees + above)).sqrt().max(1.0);
            let r = radius + altitude;
            // ds = 2 q (R + h) / s dq, as in Way.
            steps[i] = 2.0 * q.abs() * r / distance * rise;
            let mu = ((along + across * (distance.copysign(q) + offset)) / r).clamp(-1.0, 1.0);
            let sunward = mu / (mu.abs() + LOW as f32) * (1.0 + LOW as f32) + 1.0;
            let root = (altitude * height).clamp(0.0, 1.0).sqrt();
            let row = (root * (ROWS - 1) as f32 + 0.5) as i32;
            nodes[i] = row * SUNS as i32 + (sunward * (0.5 * (SUNS - 1) as f32) + 0.5) as i32;
            layers[i] = (root * (LAYERS - 1) as f32 + 0.5) as i32;
        }
        let (mut lights, mut depths) = ([[0.0; N]; GROUPS], [[0.0; N]; GROUPS]);
        let mut depth = [0.0; GROUPS];
        for i in 0..N {
            let layer = layers[i] as usize;
            let species = self.molecular.len();
            for (g, light) in self.light[nodes[i] as usize].iter().enumerate() {
                let particles: f32 = (0..LOOKS).map(|k| looked.looks[k] * light.particles[k]).sum();
                let mut source = 0.0;
                for k in 0..species {
                    let other = if self.molecular[k] { light.molecular } else { particles };
                    source += self.scattering[layer * species + k][g] * (looked.phases[k] * light.sun + other);
                }
                lights[g][i] = source * steps[i];
                let passed = self.extinction[layer][g] * steps[i];
                depths[g][i] = depth[g] + 0.5 * passed;
                depth[g] += passed;
            }
        }
        // Not less than exp(-tau): (1 + tau / 16)^-16.
        let mut masses = [0.0; N];
        for (lights, depths) in lights.iter().zip(&depths) {
            for i in 0..N {
                let through = 1.0 / (1.0 + depths[i] / 16.0);
                masses[i] += lights[i] * through.powi(16);
            }
        }
        // Where a layer ends within a step its middle says too little.
        let mut smooth = [0.0; N];
        smooth[0] = 0.75 * masses[0] + 0.25 * masses[1];
        smooth[N - 1] = 0.75 * masses[N - 1] + 0.25 * masses[N - 2];
        for i in 1..N - 1 {
            smooth[i] = 0.5 * masses[i] + 0.25 * (masses[i - 1] + masses[i + 1]);
        }
        let sum: f32 = smooth.iter().sum();
        let (scale, even) = if sum > 0.0 && sum.is_finite() {
            (f64::from(1.0 - EVEN as f32) / f64::from(sum), EVEN / N as f64)
        } else {
            (0.0, 1.0 / N as f64)
        };
        let mut rest = u;
        for (i, &mass) in smooth.iter().enumerate() {
            let share = scale * f64::from(mass) + even;
            if rest < share || i == N - 1 {
                let within = (rest / share).clamp(0.0, 1.0 - 1e-9);
                return ((i as f64 + within) / N as f64, share * N as f64);
            }
            rest -= share;
        }
        (u, 1.0)
    }
}
