//! Slant columns: the optical depth between any two points of any ray, by one look-up.
//!
//! A ray through concentric shells is fixed by its perigee p, the lowest altitude of the line it lies on (below
//! zero if the line cuts the planet), and a point of it by the distance s from the perigee,
//! s^2 = (h - p)(2R + h + p). The optical depth between the perigee and the altitude h,
//! tau(p, h) = int_0^s sigma(h(s')) ds',
//! has a branch at h = p (it begins like a root of h - p); the mean extinction on the way, tau / s, has none and is what
//! the table holds, at nodes of h for each of many p. Between two rows it is linear in p; between two nodes of h it
//! is the cubic in h that has the right values and the right slopes at both ends, for the slope
//! d(tau / s)/dh = (sigma - tau / s) (ds/dh) / s follows from the extinction there. Lines that cut the planet have a
//! table of their own: depths count from the ground, rows go by the cosine of the zenith angle there.
//!
//! Nodes follow from the medium and from [`Tolerance`]: nodes of h where the extinction jumps and wherever the cubic needs
//! them, rows wherever the middle of two is not their mean. A line that turns just below a jump has a depth there that goes as the
//! root of the distance to the jump and would spoil all means above: above a jump they count from it, and rows below it go by that root. Between planes all lines are alike, and the table is one row.
//! The numbers are per wavelength, not per species: a look-up then needs no sum over species, and scenes have about as many
//! of one as of the other.

mod build;
mod chord;
#[cfg(test)]
mod tests;

pub use build::Tolerance;
pub use chord::{Chord, Point};

use crate::geometry::Shape;
use crate::lookup::Lookup;

/// Columns of a medium at `L` wavelengths.
#[derive(Debug, Clone)]
pub struct Columns<const L: usize> {
    shape: Shape,
    /// Altitudes of the nodes in m, from 0 to the top.
    altitudes: Lookup,
    /// Nodes at which the extinction jumps, and of every node the last of them below it, 0 if there is none.
    jumps: Vec<usize>,
    bases: Vec<usize>,
    /// Extinction coefficients [cell][bottom, top] in m^-1, each from inside the cell.
    extinction: Vec<[[f64; L]; 2]>,
    limb: Rows<L>,
    ground: Rows<L>,
}

/// Rows of mean extinctions.
#[derive(Debug, Clone)]
struct Rows<const L: usize> {
    /// Perigee altitudes in m, or cosines at the ground.
    at: Lookup,
    /// Altitude in m of the jump below which a row and the next lie: their share goes by the root of the distance to it.
    under: Vec<Option<f64>>,
    /// Mean extinction in m^-1 [row][node] from the start of the line, or from the last jump below the node if that is higher.
    means: Vec<[f32; L]>,
    /// Extinction at the start of each row.
    starts: Vec<[f64; L]>,
}

impl<const L: usize> Columns<L> {
    /// Numbers of (altitudes, rows above the ground, rows to the ground).
    #[must_use]
    pub fn size(&self) -> [usize; 3] {
        [self.altitudes.nodes().len(), self.limb.at.nodes().len(), self.ground.at.nodes().len()]
    }

    /// Bytes of the tables.
    #[must_use]
    pub fn bytes(&self) -> usize {
        4 * L * (self.limb.means.len() + self.ground.means.len())
            + 8 * L * (self.limb.starts.len() + self.ground.starts.len() + 2 * self.extinction.len())
    }

    /// Form of the planet.
    #[must_use]
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Altitude of the top in m.
    #[must_use]
    pub fn top_m(&self) -> f64 {
        self.altitudes.last()
    }
}
