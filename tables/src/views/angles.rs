//! From the angles at which a table has phase functions to those between which they are lines.
//!
//! A table has few angles of a smooth function: between them the logarithm of the phase function is a cubic in the cosine.
//! Who renders draws directions from it, and evaluates it for each: this wants lines. So each interval is divided once,
//! when the optics of a species are asked for, and the lines get the integral 1.

use crate::{Axis, Interpolation, Outside, Scale, TableError};
use std::f64::consts::PI;

/// Equal steps of the angle into which an interval of a curved axis is divided.
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
    /// The angles from the axis of a table: its own if it is linear, and if it is curved more in between.
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
            Interpolation::Cubic | Interpolation::Parabolic => {
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
            Interpolation::Step | Interpolation::Node => refuse("be linear, parabolic or cubic"),
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

    /// A phase function from its values: lines between [`Angles::cosines`] whose integral over the sphere is 1. Also what
    /// the integral was before, less 1.
    #[must_use]
    pub fn phase(&self, mut values: Vec<f64>) -> (Vec<f64>, f64) {
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Nodes by steps of `step` degrees, finer ahead.
    fn axis(step: f64) -> Axis {
        let ahead = (0..10).map(|i| 0.1 * step * f64::from(i));
        let angles: Vec<f64> = ahead.chain((1..=180).map(|i| step * f64::from(i)).take_while(|a| *a < 180.0)).collect();
        let cosines = angles.iter().chain(&[180.0_f64]).rev().map(|a| a.to_radians().cos()).collect();
        Axis::new("cosine", "1", cosines).expect("sound")
    }

    /// Henyey and Greenstein with g = 0.9.
    fn henyey(c: f64) -> f64 {
        let g: f64 = 0.9;
        (1.0 - g * g) / (4.0 * PI * (1.0 + g * g - 2.0 * g * c).powf(1.5))
    }

    #[test]
    fn cubics_of_the_logarithm_are_as_good_as_many_lines() {
        let worst = |interpolation: Interpolation, scale: Scale| {
            let axis = axis(2.0).between(interpolation);
            let angles = Angles::new(&axis).expect("whole");
            let nodes: Vec<f64> = axis.nodes.iter().map(|c| scale.of(henyey(*c))).collect();
            let (phase, missed) = angles.phase(angles.between(scale, &nodes));
            assert!((integral(angles.cosines(), &phase) - 1.0).abs() < 1e-14);
            let curve = crate::Curve::new(
                Axis::new("cosine", "1", angles.cosines().to_vec()).expect("sound"),
                Scale::Linear,
                phase,
            )
            .expect("sound");
            let off = |i: u32| {
                let c = (f64::from(i) * PI / 1e4).cos();
                (curve.at(c).expect("inside") / henyey(c) - 1.0).abs()
            };
            ((0..=10_000).map(off).fold(0.0, f64::max), missed)
        };
        let (lines, cubics) =
            (worst(Interpolation::Linear, Scale::Linear), worst(Interpolation::Cubic, Scale::Logarithmic));
        // Lines between nodes are off by h^2 P'' / 8, those between a quarter of the steps by a sixteenth of it; the rest
        // is of the cubics.
        assert!(lines.0 > 1e-2 && cubics.0 < lines.0 / 8.0, "{lines:?}, {cubics:?}");
        assert!(lines.1 > 0.0 && cubics.1.abs() < lines.1 / 8.0, "{lines:?}, {cubics:?}");
    }

    #[test]
    fn the_angles_of_a_table_stay() {
        let axis = axis(5.0);
        assert_eq!(Angles::new(&axis).expect("whole").cosines(), axis.nodes);
        let angles = Angles::new(&axis.clone().between(Interpolation::Cubic)).expect("whole");
        assert_eq!((angles.cosines().len() - 1, angles.nodes()), (4 * (axis.nodes.len() - 1), axis.nodes.len()));
        assert!(angles.cosines().iter().step_by(4).eq(&axis.nodes));
        assert!(angles.cosines().windows(2).all(|pair| pair[0] < pair[1]));
        let values: Vec<f64> = axis.nodes.iter().map(|c| henyey(*c)).collect();
        assert!(angles.between(Scale::Linear, &values).iter().step_by(4).eq(&values));
    }

    #[test]
    fn axes_that_are_no_scattering_angles_are_refused() {
        let whole = Axis::new("cosine", "1", vec![-1.0, 0.0, 1.0]).expect("sound");
        assert!(Angles::new(&whole).is_ok());
        for wrong in [
            whole.clone().between(Interpolation::Step),
            whole.clone().beyond(Outside::Hold),
            Axis { unit: "deg".into(), ..whole.clone() },
            Axis { nodes: vec![-1.0, 0.0, 0.5], ..whole },
        ] {
            assert!(Angles::new(&wrong).is_err(), "{wrong:?}");
        }
    }
}
