//! The lines along which light reaches a level, with everything about them that does not depend on the sun.

use super::Setup;
use super::line::{Rule, Spread, Stencil, crossings, quadrature};
use super::onward::Dipoles;
use super::orders::AZIMUTHS;
use crate::geometry::Place;
use crate::vectors::exp_minus;
use glam::DVec3;

/// Where a line crosses a level.
#[derive(Debug, Clone)]
pub(super) struct Node<const L: usize> {
    /// Which line, and which level.
    pub(super) line: usize,
    pub(super) level: usize,
    /// What the cosine of the sun's zenith angle here has of that at the line's beginning, and of the cosine between line and sun.
    pub(super) frame: [f32; 2],
    /// Cosine of the zenith angle of the direction looked in, here.
    pub(super) zenith: f32,
    /// S_lm at that angle of the moments that count here: of those with the orders m that azimuths tell apart, or of the first few.
    pub(super) harmonics: Vec<f32>,
    /// sum over the species of b_l times the weight of the node in the integral of transmittance times scattering coefficient,
    /// for l = 0 ..= degree.
    pub(super) sources: Vec<[f32; L]>,
    /// Of polarised light the weights for Q and U times alpha and beta ([`Dipoles`]).
    pub(super) dipoles: [[f32; L]; 2],
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
    pub(super) foot: Option<Foot<L>>,
}

/// The lines of a level, and where they cross levels: those of each level together, so that its moments are read once.
#[derive(Debug, Clone)]
pub(super) struct Lines<const L: usize> {
    pub(super) lines: Vec<Line<L>>,
    pub(super) nodes: Vec<Node<L>>,
}

impl<const L: usize> Lines<L> {
    pub(super) fn new(setup: &Setup<'_, L>, level: usize, zeniths: &[(f64, f64)]) -> Self {
        let mut nodes = Vec::new();
        let lines = zeniths.iter().enumerate().map(|(i, way)| line(setup, level, (i, *way), &mut nodes)).collect();
        nodes.sort_by_key(|node| node.level);
        Self { lines, nodes }
    }
}

/// Line number `index`, with the cosine of its zenith angle and its weight; its crossings go to `nodes`.
#[inline(always)]
fn line<const L: usize>(
    setup: &Setup<'_, L>,
    level: usize,
    (index, (zenith, weight)): (usize, (f64, f64)),
    nodes: &mut Vec<Node<L>>,
) -> Line<L> {
    let grid = setup.grid;
    let radius = grid.level_radius(level);
    let mut line = Line { zenith, weight, foot: None };
    let direction = DVec3::new(((1.0 - zenith) * (1.0 + zenith)).sqrt(), 0.0, zenith);
    let Some(chord) = setup.optics.columns.chord(Place::above(grid.levels[level]), direction) else { return line };
    let (from, to) = chord.ends();
    let places = crossings(&chord, &grid.levels, from);
    let width = setup.optics.moments.width();
    // Weights of each node in turn, by species.
    let species = setup.optics.species.len();
    let mut weights = vec![[0.0; L]; species * places.len()];
    let polarised = setup.optics.moments.polarised();
    let mut dipoles = vec![[0.0; L]; 2 * places.len()];
    let ahead = setup.optics.onward.along(Place::above(grid.levels[level]), direction);
    for (i, ends) in places.windows(2).enumerate() {
        let rule = Rule { fine: true, least: 1.0, bends: &grid.bends };
        let polynomials = Stencil::around(i, &places, &grid.walls).through(&places);
        let spread = Spread { polynomials, weights: &mut weights };
        let linear = polarised.then(|| Dipoles {
            to: Spread { polynomials, weights: &mut dipoles },
            optics: setup.optics,
            ahead: &ahead,
        });
        let mut spread = (spread, linear);
        if !quadrature(&chord, setup.optics, (ends[0].s, ends[1].s), rule, &mut spread) {
            break;
        }
    }
    let frame = |s: f64, r: f64| [(radius / r) as f32, ((s - from) / r) as f32];
    let mut harmonics = Vec::new();
    for ((place, weights), dipoles) in
        places.iter().zip(weights.chunks_exact(species.max(1))).zip(dipoles.as_chunks::<2>().0)
    {
        let Some(reach) = setup.optics.reach(weights) else { continue };
        let r = grid.level_radius(place.level);
        let zenith = (place.s / r).clamp(-1.0, 1.0);
        setup.optics.moments.at(zenith, &mut harmonics);
        let count = reach.count.min(setup.optics.moments.count_below(AZIMUTHS));
        let mut sources = vec![[0.0; L]; width];
        setup.optics.add_sources(weights, &mut sources);
        nodes.push(Node {
            line: index,
            level: place.level,
            frame: frame(place.s, r),
            zenith: zenith as f32,
            harmonics: harmonics[..count].iter().map(|&v| v as f32).collect(),
            sources,
            dipoles: dipoles.map(|row| row.map(|v| v as f32)),
        });
    }
    if chord.ends_on_ground() {
        let through = exp_minus(chord.total()).map(|t| t as f32);
        line.foot = Some(Foot { frame: frame(to, grid.radius), through });
    }
    line
}
