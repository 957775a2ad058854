//! From the angles at which a table has phase functions to those between which they are lines.
//!
//! A table has few angles and a smooth function: the logarithm of the phase function is the cubic in the cosine through
//! the four nearest. Who renders draws directions from it, and evaluates it for each: this wants lines. So each interval
//! is divided once, when the optics of a species are asked for, and the lines get the integral 1.

use crate::{Axis, Interpolation, Outside, Scale, TableError};
use std::f64::consts::PI;

/// Equal steps of the angle into which an interval of a cubic axis is divided.
const PARTS: u32 = 4;

/// Angles from those of a table on.
#[derive(Debug, Clone, PartialEq)]
pub struct Angles {
    nodes: usize,
    cosines: Vec<f64>,
    /// Of each the nodes of the table that make its value; none if it has all of them.
    weights: Vec<Vec<(usize, f64)>>,
}

impl Angles {
    /// The angles from the axis of a table: its own if it is linear, and if it is cubic more in between.
    ///
    /// # Errors
    /// [`TableError::Inconsistent`] if its nodes, cosines of the scattering angle, do not reach from -1 to 1, or for
    /// another rule between or outside.
    pub fn new(axis: &Axis) -> Result<Self, TableError> {
        let refuse = |text: &str| Err(TableError::Inconsistent(format!("axis {:?} must {text}", axis.name)));
        if axis.unit != "1" || axis.outside != Outside::Error || axis.range() != (-1.0, 1.0) {
            return refuse("be in \"1\", reach from -1 to 1, and refuse outside");
        }
        let nodes = axis.nodes.len();
        match axis.interpolation {
            Interpolation::Linear => Ok(Self { nodes, cosines: axis.nodes.clone(), weights: Vec::new() }),
            Interpolation::Cubic => {
                let mut cosines = vec![axis.nodes[0]];
                for pair in axis.nodes.windows(2) {
                    let (from, to) = (pair[0].acos(), pair[1].acos());
                    let part = |i: u32| (from + (to - from) * f64::from(i) / f64::from(PARTS)).cos();
                    // Between angles that single precision would not tell apart there is nothing to add.
                    cosines.extend((1..PARTS).map(part).filter(|c| pair[0] < *c && *c < pair[1]));
                    cosines.push(pair[1]);
                }
                let weights = cosines.iter().map(|&c| axis.weights(c)).collect::<Result<_, _>>()?;
                Ok(Self { nodes, cosines, weights })
            }
            Interpolation::Step | Interpolation::Node => refuse("be linear or cubic"),
        }
    }

    /// Cosines of the angles, from -1 (backward) to 1 (forward).
    #[must_use]
    pub fn cosines(&self) -> &[f64] {
        &self.cosines
    }

    /// How many nodes the axis has.
    #[must_use]
    pub fn nodes(&self) -> usize {
        self.nodes
    }

    /// Values at [`Angles::cosines`] from those at the nodes of the table, which are logarithms on a logarithmic scale
    /// ([`Scale::of`]), by the rule of the axis.
    #[must_use]
    pub fn between(&self, scale: Scale, nodes: &[f64]) -> Vec<f64> {
        if self.weights.is_empty() {
            return nodes.iter().map(|value| scale.back(*value)).collect();
        }
        let value = |near: &Vec<(usize, f64)>| scale.back(near.iter().map(|(i, weight)| weight * nodes[*i]).sum());
        self.weights.iter().map(value).collect()
    }

    /// The phase function, from what a table has at its nodes: lines between [`Angles::cosines`] whose integral over the
    /// sphere is 1. Also what the integral would be without the last step, less 1.
    ///
    /// A line lies above a convex function, mostly ahead: scaled down as a whole, the function would be too low
    /// everywhere else. So on a cubic axis each value is lowered first by half the excess of the two cells beside it over
    /// half their width, the excess of a line over the cubic through the four nearest values, but not below 0.
    #[must_use]
    pub fn phase(&self, mut values: Vec<f64>) -> (Vec<f64>, f64) {
        if !self.weights.is_empty() {
            let excess: Vec<f64> = (0..values.len() - 1).map(|cell| excess(&self.cosines, &values, cell)).collect();
            for (i, value) in values.iter_mut().enumerate() {
                let cells = i.saturating_sub(1)..(i + 1).min(excess.len());
                let width = self.cosines[cells.end] - self.cosines[cells.start];
                *value = (*value - excess[cells].iter().sum::<f64>() / width).max(0.0);
            }
        }
        let whole = integral(&self.cosines, &values);
        values.iter_mut().for_each(|value| *value /= whole);
        (values, whole - 1.0)
    }
}

/// Integral over the sphere of a function linear between cosines: 2 pi times the trapezoidal sum.
#[must_use]
pub fn integral(cosines: &[f64], values: &[f64]) -> f64 {
    let cells = cosines.windows(2).zip(values.windows(2));
    PI * cells.map(|(c, v)| (c[1] - c[0]) * (v[0] + v[1])).sum::<f64>()
}

/// The integral over a cell of a line less that of the cubic through the four nearest nodes (or all, where there are fewer),
/// by Gauss-Legendre quadrature with two points, which is exact for cubics.
fn excess(cosines: &[f64], values: &[f64], cell: usize) -> f64 {
    let (a, b) = (cosines[cell], cosines[cell + 1]);
    let count = cosines.len().min(4);
    let first = cell.saturating_sub(1).min(cosines.len() - count);
    let near = first..first + count;
    let cubic = |c: f64| -> f64 {
        let factor = |i: usize, j: usize| (c - cosines[j]) / (cosines[i] - cosines[j]);
        let weight = |i: usize| near.clone().filter(|&j| j != i).map(|j| factor(i, j)).product::<f64>();
        near.clone().map(|i| weight(i) * values[i]).sum()
    };
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let offset = half / 3.0_f64.sqrt();
    half * (values[cell] + values[cell + 1] - cubic(middle - offset) - cubic(middle + offset))
}
