//! Slant columns: the optical depth between any two points of any ray, by one look-up.
//!
//! A ray through concentric shells is fixed by its perigee p, the lowest altitude of the line it lies on (below
//! zero if the line cuts the planet), and a point of it by the distance s from the perigee,
//! s^2 = (h - p)(2R + h + p). The column of a species between the perigee and the altitude h,
//! N(p, h) = int_0^s n(h(s')) ds',
//! has a branch at h = p (it begins like a root of h - p); the mean density on the way, N / s, has none and is what
//! the table holds, at nodes of h for each of many p. Between two rows it is linear in p; between two nodes of h it
//! is the cubic in h that has the right values and the right slopes at both ends, for the slope
//! d(N / s)/dh = (n - N / s) (ds/dh) / s follows from the density there. Lines that cut the planet have a table of their own: columns count from the ground, rows go by the cosine of the zenith angle
//! there.
//!
//! Nodes follow from the medium and from [`Tolerance`]: nodes of h where a profile jumps and wherever the cubic needs
//! them, rows wherever the middle of two is not their mean. Between planes all lines are alike, and the table is one row.

mod build;
mod chord;
#[cfg(test)]
mod tests;

pub use build::Tolerance;
pub use chord::{Chord, Point};

use super::lookup::Lookup;
use crate::geometry::Shape;

/// Columns of a medium at `L` wavelengths.
///
/// The table holds columns of species, or optical depths at the wavelengths where these are fewer: `lanes` numbers a node.
#[derive(Debug, Clone)]
pub struct Columns<const L: usize> {
    shape: Shape,
    /// Numbers at each node.
    lanes: usize,
    /// Extinction at each wavelength for each lane: optical depth is the sum over lanes of column times this.
    extinction: Vec<[f64; L]>,
    /// Altitudes of the nodes in m, from 0 to the top.
    altitudes: Lookup,
    /// Densities [cell][bottom, top][lane], each from inside the cell.
    densities: Vec<f64>,
    limb: Rows,
    ground: Rows,
}

/// Rows of mean densities.
#[derive(Debug, Clone)]
struct Rows {
    /// Perigee altitudes in m, or cosines at the ground.
    at: Lookup,
    /// Mean densities [row][node][lane].
    means: Vec<f32>,
    /// Density at the start of each row [row][lane].
    starts: Vec<f64>,
}

impl<const L: usize> Columns<L> {
    /// Numbers of (altitudes, rows above the ground, rows to the ground, numbers at a node).
    #[must_use]
    pub fn size(&self) -> [usize; 4] {
        [self.altitudes.nodes().len(), self.limb.at.nodes().len(), self.ground.at.nodes().len(), self.lanes]
    }

    /// Bytes of the tables.
    #[must_use]
    pub fn bytes(&self) -> usize {
        4 * (self.limb.means.len() + self.ground.means.len())
            + 8 * (self.limb.starts.len() + self.ground.starts.len() + self.densities.len())
    }

    /// Altitude of the top in m.
    #[must_use]
    pub fn top_m(&self) -> f64 {
        self.altitudes.last()
    }
}
