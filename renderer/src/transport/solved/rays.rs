//! The lines along which light reaches a level, with everything about them that does not depend on the sun.

use super::Setup;
use super::line::{Rule, Spread, Stencil, crossings, quadrature};
use crate::geometry::Place;
use crate::vectors::exp_minus;
use glam::DVec3;

/// Where a line crosses a level.
#[derive(Debug, Clone)]
pub(super) struct Node {
    /// Which level.
    pub(super) level: usize,
    /// What the cosine of the sun's zenith angle here has of that at the line's beginning, and of the cosine between line and sun.
    pub(super) frame: [f32; 2],
    /// Cosine of the zenith angle of the direction looked in, here.
    pub(super) zenith: f32,
    /// S_lm at that angle of the moments that count here: of all, or of the first few.
    pub(super) harmonics: Vec<f32>,
}

/// The ground at the end of a line.
#[derive(Debug, Clone)]
pub(super) struct Foot<const L: usize> {
    /// As of a [`Node`].
    pub(super) frame: [f32; 2],
    /// Transmittance from there.
    pub(super) through: [f32; L],
}

/// One direction looked in from a level.
#[derive(Debug, Clone)]
pub(super) struct Line<const L: usize> {
    /// Cosine of its zenith angle, and the weight of the interval of cosines for which it stands.
    pub(super) zenith: f64,
    pub(super) weight: f64,
    pub(super) nodes: Vec<Node>,
    /// sum over the species of b_l times the weight of a node in the integral of transmittance times scattering
    /// coefficient: degree + 1 of each node.
    pub(super) sources: Vec<[f32; L]>,
    pub(super) foot: Option<Foot<L>>,
}

/// The lines of a level.
pub(super) fn lines<const L: usize>(setup: &Setup<'_, L>, level: usize, zeniths: &[(f64, f64)]) -> Vec<Line<L>> {
    zeniths.iter().map(|&(zenith, weight)| line(setup, level, zenith, weight)).collect()
}

#[inline(always)]
fn line<const L: usize>(setup: &Setup<'_, L>, level: usize, zenith: f64, weight: f64) -> Line<L> {
    let grid = setup.grid;
    let radius = grid.level_radius(level);
    let mut line = Line { zenith, weight, nodes: Vec::new(), sources: Vec::new(), foot: None };
    let direction = DVec3::new(((1.0 - zenith) * (1.0 + zenith)).sqrt(), 0.0, zenith);
    let Some(chord) = setup.optics.columns.chord(Place::above(grid.levels[level]), direction) else { return line };
    let (from, to) = chord.ends();
    let places = crossings(&chord, &grid.levels, from);
    let width = setup.optics.moments.degree() + 1;
    // Weights of each node in turn, by species.
    let species = setup.optics.species.len();
    let mut weights = vec![[0.0; L]; species * places.len()];
    for (i, ends) in places.windows(2).enumerate() {
        let rule = Rule { fine: true, least: 1.0, bends: &grid.bends };
        let stencil = Stencil::around(i, places.len());
        let mut spread = Spread { places: &places, stencil, weights: &mut weights };
        if !quadrature(&chord, setup.optics, (ends[0].s, ends[1].s), rule, &mut spread) {
            break;
        }
    }
    let frame = |s: f64, r: f64| [(radius / r) as f32, ((s - from) / r) as f32];
    let mut harmonics = Vec::new();
    for (place, weights) in places.iter().zip(weights.chunks_exact(species.max(1))) {
        let Some(reach) = setup.optics.reach(weights) else { continue };
        let r = grid.level_radius(place.level);
        let zenith = (place.s / r).clamp(-1.0, 1.0);
        setup.optics.moments.at(zenith, &mut harmonics);
        line.nodes.push(Node {
            level: place.level,
            frame: frame(place.s, r),
            zenith: zenith as f32,
            harmonics: harmonics[..reach.count].iter().map(|&v| v as f32).collect(),
        });
        let first = line.sources.len();
        line.sources.resize(first + width, [0.0; L]);
        setup.optics.add_sources(weights, &mut line.sources[first..]);
    }
    if chord.ends_on_ground() {
        let through = exp_minus(chord.total()).map(|t| t as f32);
        line.foot = Some(Foot { frame: frame(to, grid.radius), through });
    }
    line
}
