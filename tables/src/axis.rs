//! An axis: increasing nodes, a rule between them and a rule outside them.

use crate::TableError;
use serde::{Deserialize, Serialize};

/// How the nodes of an axis are spaced.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Spacing {
    /// Equal steps: the interval of a coordinate is found by one division.
    Uniform,
    /// Any increasing nodes: the interval is found by bisection.
    Irregular,
}

/// What holds between two nodes of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Interpolation {
    /// Linear in the coordinate (of the value, or of its logarithm: see [`crate::Scale`]).
    Linear,
    /// The cubic in the coordinate through the four nearest nodes, two on either side but at the ends (of the value, or
    /// of its logarithm); through all nodes where there are fewer.
    Cubic,
    /// In each pair of intervals, counted from the first node, the parabola through their three nodes (of the value, or
    /// of its logarithm), so that it may have a kink at every other node; in a last interval without another, that
    /// through the last three; through all nodes where there are fewer.
    Parabolic,
    /// The value of a node holds from it up to the next node.
    Step,
    /// Only the nodes themselves can be asked for (months, names by index).
    Node,
}

impl Interpolation {
    /// Whether more than two nodes may make a value.
    #[must_use]
    pub fn is_curved(self) -> bool {
        matches!(self, Self::Cubic | Self::Parabolic)
    }
}

/// What holds outside the nodes of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Outside {
    /// The look-up is refused.
    Error,
    /// The value of the nearest node holds.
    Hold,
    /// The value is zero.
    Zero,
}

/// Named, increasing coordinates with their unit and rules.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// Name in the field's standard terms, such as `wavelength`.
    pub name: String,
    /// Unit of the nodes, such as `nm`; `1` when there is none.
    pub unit: String,
    /// Spacing of the nodes.
    pub spacing: Spacing,
    /// Rule between nodes.
    pub interpolation: Interpolation,
    /// Rule outside the nodes.
    pub outside: Outside,
    /// The nodes, finite and strictly increasing, at least one.
    pub nodes: Vec<f64>,
}

/// Where a coordinate lies on an axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    /// Index of the node at or below the coordinate.
    pub index: usize,
    /// Fraction of the way from that node to the next, in 0..=1; 0 at the last node.
    pub fraction: f64,
}

impl Axis {
    /// An axis with irregular spacing, linear between nodes, refusing outside;
    /// change the public fields for other rules.
    ///
    /// # Errors
    /// [`TableError::Inconsistent`] if the nodes are empty, not finite or not increasing.
    pub fn new(name: &str, unit: &str, nodes: Vec<f64>) -> Result<Self, TableError> {
        let axis = Self {
            name: name.into(),
            unit: unit.into(),
            spacing: Spacing::Irregular,
            interpolation: Interpolation::Linear,
            outside: Outside::Error,
            nodes,
        };
        axis.validate()?;
        Ok(axis)
    }

    /// An axis of `count` equal steps from `first`, node i = first + i * step.
    ///
    /// # Errors
    /// As [`Axis::new`].
    pub fn uniform(name: &str, unit: &str, first: f64, step: f64, count: usize) -> Result<Self, TableError> {
        let nodes = (0..count).map(|i| first + i as f64 * step).collect();
        Ok(Self { spacing: Spacing::Uniform, ..Self::new(name, unit, nodes)? })
    }

    /// The same axis with another rule between its nodes.
    #[must_use]
    pub fn between(self, interpolation: Interpolation) -> Self {
        Self { interpolation, ..self }
    }

    /// The same axis with another rule outside its nodes.
    #[must_use]
    pub fn beyond(self, outside: Outside) -> Self {
        Self { outside, ..self }
    }

    /// First and last node.
    #[must_use]
    pub fn range(&self) -> (f64, f64) {
        (self.nodes[0], self.nodes[self.nodes.len() - 1])
    }

    /// Checks that there are nodes, that they are finite and strictly
    /// increasing, and that a uniform axis has equal steps (to 1e-9 of a step).
    ///
    /// # Errors
    /// [`TableError::Inconsistent`] naming the axis and the node.
    pub fn validate(&self) -> Result<(), TableError> {
        let fail = |text: String| Err(TableError::Inconsistent(format!("axis {:?}: {text}", self.name)));
        let Some(&first) = self.nodes.first() else { return fail("no nodes".into()) };
        if let Some(i) = self.nodes.iter().position(|x| !x.is_finite()) {
            return fail(format!("node {i} is not finite"));
        }
        if let Some(i) = self.nodes.windows(2).position(|w| w[0] >= w[1]) {
            return fail(format!("node {} is not above node {i}", i + 1));
        }
        if self.spacing == Spacing::Uniform {
            let step = self.step();
            for (i, &x) in self.nodes.iter().enumerate() {
                if (x - (first + i as f64 * step)).abs() > 1e-9 * step {
                    return fail(format!("node {i} breaks the uniform spacing"));
                }
            }
        }
        Ok(())
    }

    /// Mean step between nodes; 1 for a single node.
    fn step(&self) -> f64 {
        let (low, high) = self.range();
        if self.nodes.len() > 1 { (high - low) / (self.nodes.len() - 1) as f64 } else { 1.0 }
    }

    /// Finds a coordinate between the two nodes that make its value; `None` where the rule outside is
    /// [`Outside::Zero`].
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] outside an axis that refuses, for a coordinate
    /// between the nodes of an [`Interpolation::Node`] axis, and for NaN; [`TableError::Inconsistent`] for a
    /// curved axis ([`Interpolation::is_curved`]), whose values are made by more nodes: see [`Axis::weights`].
    pub fn locate(&self, x: f64) -> Result<Option<Position>, TableError> {
        self.refuse_curved()?;
        self.interval(x)
    }

    /// Refuses a curved axis where two nodes make a value.
    pub(crate) fn refuse_curved(&self) -> Result<(), TableError> {
        if self.interpolation.is_curved() {
            return Err(TableError::Inconsistent(format!("axis {:?} must be linear, a step or nodes", self.name)));
        }
        Ok(())
    }

    /// As [`Axis::locate`], of any axis.
    fn interval(&self, x: f64) -> Result<Option<Position>, TableError> {
        let (low, high) = self.range();
        let refuse =
            || TableError::OutOfRange { axis: self.name.clone(), value: x, low, high, unit: self.unit.clone() };
        if x.is_nan() {
            return Err(refuse());
        }
        let last = self.nodes.len() - 1;
        if x < low || x > high {
            return match self.outside {
                Outside::Error => Err(refuse()),
                Outside::Zero => Ok(None),
                Outside::Hold => Ok(Some(Position { index: if x < low { 0 } else { last }, fraction: 0.0 })),
            };
        }
        let guess = match self.spacing {
            Spacing::Uniform => ((x - low) / self.step()) as usize,
            Spacing::Irregular => self.nodes.partition_point(|&node| node <= x).saturating_sub(1),
        };
        // Rounding in the division can miss the interval by one either way.
        let mut index = guess.min(last);
        if index > 0 && self.nodes[index] > x {
            index -= 1;
        } else if index < last && self.nodes[index + 1] <= x {
            index += 1;
        }
        if index == last {
            return Ok(Some(Position { index, fraction: 0.0 }));
        }
        let (a, b) = (self.nodes[index], self.nodes[index + 1]);
        let fraction = match self.interpolation {
            Interpolation::Linear | Interpolation::Cubic | Interpolation::Parabolic => (x - a) / (b - a),
            Interpolation::Step => 0.0,
            Interpolation::Node if x == a => 0.0,
            Interpolation::Node => return Err(refuse()),
        };
        Ok(Some(Position { index, fraction }))
    }

    /// The nodes that make the value at a coordinate, with weights that add up to 1: v(x) = sum of w_i v_i, or
    /// ln v(x) = sum of w_i ln v_i on a logarithmic scale. On a curved axis the weights are
    /// Lagrange's, w_i = product over j of (x - x_j) / (x_i - x_j), and one or two of them are negative. A node itself stands alone.
    /// Empty where the rule outside is [`Outside::Zero`].
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] as [`Axis::locate`].
    pub fn weights(&self, x: f64) -> Result<Vec<(usize, f64)>, TableError> {
        let Some(Position { index, fraction }) = self.interval(x)? else { return Ok(Vec::new()) };
        if fraction == 0.0 {
            return Ok(vec![(index, 1.0)]);
        }
        let (first, count) = match self.interpolation {
            Interpolation::Cubic => (index.saturating_sub(1), 4),
            Interpolation::Parabolic => (index - index % 2, 3),
            Interpolation::Linear | Interpolation::Step | Interpolation::Node => (index, 2),
        };
        let count = count.min(self.nodes.len());
        let first = first.min(self.nodes.len() - count);
        let near = first..first + count;
        let weight = |i: usize| {
            let factor = |j: usize| (x - self.nodes[j]) / (self.nodes[i] - self.nodes[j]);
            near.clone().filter(|&j| j != i).map(factor).product::<f64>()
        };
        Ok(near.clone().map(|i| (i, weight(i))).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn km(nodes: &[f64]) -> Axis {
        Axis::new("altitude", "km", nodes.to_vec()).expect("valid")
    }

    #[test]
    fn every_node_is_found_exactly_on_uniform_and_irregular_axes() {
        // 0.1 is not a binary fraction, so this meets the rounding of the division.
        let uniform = Axis::uniform("x", "1", 0.3, 0.1, 701).expect("valid");
        let irregular = Axis { spacing: Spacing::Irregular, ..uniform.clone() };
        for axis in [uniform, irregular] {
            for (i, &x) in axis.nodes.iter().enumerate() {
                let at = axis.locate(x).expect("inside").expect("not zero");
                assert_eq!((at.index, at.fraction), (i, 0.0), "node {i} of the {:?} axis", axis.spacing);
            }
        }
    }

    #[test]
    fn position_rebuilds_the_coordinate() {
        let axis = km(&[0.0, 0.5, 2.0, 7.0]);
        for i in 0..=700 {
            let x = f64::from(i) / 100.0;
            let Position { index, fraction } = axis.locate(x).expect("inside").expect("some");
            let next = axis.nodes.get(index + 1).copied().unwrap_or(axis.nodes[index]);
            let back = axis.nodes[index] + fraction * (next - axis.nodes[index]);
            assert!((back - x).abs() < 1e-14, "{x} came back as {back}");
        }
    }

    #[test]
    fn weights_rebuild_what_their_rule_is_exact_for() {
        let nodes = [0.0, 0.5, 2.0, 7.0, 7.5];
        let cubic = |x: f64| 3.0 - x + 0.5 * x * x - 0.1 * x * x * x;
        for (rule, count, truth) in [
            (Interpolation::Linear, 5, (|x| 3.0 - x) as fn(f64) -> f64),
            (Interpolation::Cubic, 5, cubic),
            // A kink at the third of five nodes, where the second pair of intervals begins; four nodes have no second pair.
            (Interpolation::Parabolic, 5, |x| if x < 2.0 { 4.0 - x * x } else { 4.0 - 2.0 * x + (x - 2.0) * x }),
            (Interpolation::Parabolic, 4, |x| 3.0 - x + 0.5 * x * x),
            // Parabolas, lines and a constant through fewer nodes.
            (Interpolation::Cubic, 3, |x| 3.0 - x + 0.5 * x * x),
            (Interpolation::Cubic, 2, |x| 3.0 - x),
            (Interpolation::Parabolic, 2, |x| 3.0 - x),
            (Interpolation::Cubic, 1, |_| 3.0),
        ] {
            let axis = km(&nodes[..count]).between(rule);
            for i in 0..=100 {
                let x = axis.range().1 * f64::from(i) / 100.0;
                let weights = axis.weights(x).expect("inside");
                let value: f64 = weights.iter().map(|(i, w)| w * truth(nodes[*i])).sum();
                let whole: f64 = weights.iter().map(|(_, w)| w).sum();
                // Rounding of weights of up to some tens.
                assert!((value - truth(x)).abs() < 1e-12 && (whole - 1.0).abs() < 1e-13, "{rule:?}, {count}: {x}");
            }
            for (i, &x) in axis.nodes.iter().enumerate() {
                assert_eq!(axis.weights(x).expect("inside"), [(i, 1.0)], "a node stands for itself");
            }
            assert!(axis.weights(-0.1).is_err() && axis.beyond(Outside::Zero).weights(-0.1).expect("zero").is_empty());
        }
        for curved in [Interpolation::Cubic, Interpolation::Parabolic] {
            assert!(km(&nodes).between(curved).locate(1.0).is_err(), "two nodes do not make a curve");
        }
        let steps = km(&nodes).between(Interpolation::Step);
        assert_eq!(steps.weights(1.9).expect("inside"), [(1, 1.0)]);
    }

    #[test]
    fn rules_outside_are_kept() {
        let axis = km(&[1.0, 2.0]);
        assert!(matches!(axis.locate(0.9), Err(TableError::OutOfRange { .. })));
        assert!(axis.locate(f64::NAN).is_err());
        let held = axis.clone().beyond(Outside::Hold);
        assert_eq!(held.locate(9.0).expect("held").map(|p| p.index), Some(1));
        assert_eq!(axis.beyond(Outside::Zero).locate(9.0).expect("zero"), None);
    }

    #[test]
    fn a_node_axis_refuses_what_lies_between() {
        let months = Axis::uniform("month", "1", 1.0, 1.0, 12).expect("valid").between(Interpolation::Node);
        assert_eq!(months.locate(12.0).expect("node").map(|p| p.index), Some(11));
        assert!(months.locate(1.5).is_err());
    }

    #[test]
    fn bad_nodes_are_refused() {
        for nodes in [vec![], vec![1.0, 1.0], vec![2.0, 1.0], vec![0.0, f64::NAN]] {
            assert!(Axis::new("x", "1", nodes.clone()).is_err(), "{nodes:?} was taken");
        }
        let axis = Axis { spacing: Spacing::Uniform, ..km(&[0.0, 1.0, 3.0]) };
        assert!(axis.validate().is_err(), "unequal steps were taken for uniform");
    }
}
