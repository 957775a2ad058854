//! A field along one axis.

use crate::{Axis, Scale, TableError};
use std::sync::Arc;

/// Values over one axis, looked up by the axis' own rules.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    axis: Arc<Axis>,
    scale: Scale,
    values: Vec<f64>,
}

impl Curve {
    /// A curve through `values` at the nodes of `axis`, which curves may share.
    ///
    /// # Errors
    /// [`TableError::Inconsistent`] if the lengths differ, a value is not
    /// finite, or a value on a logarithmic scale is not positive.
    pub fn new(axis: impl Into<Arc<Axis>>, scale: Scale, values: Vec<f64>) -> Result<Self, TableError> {
        let axis = axis.into();
        axis.validate()?;
        let fail = |text: String| Err(TableError::Inconsistent(format!("curve over {:?}: {text}", axis.name)));
        if axis.nodes.len() != values.len() {
            return fail(format!("{} values for {} nodes", values.len(), axis.nodes.len()));
        }
        if let Some(i) = values.iter().position(|v| !v.is_finite()) {
            return fail(format!("value {i} is not finite"));
        }
        if scale == Scale::Logarithmic && values.iter().any(|&v| v <= 0.0) {
            return fail("a value on a logarithmic scale is not positive".into());
        }
        Ok(Self { axis, scale, values })
    }

    /// The axis.
    #[must_use]
    pub fn axis(&self) -> &Axis {
        &self.axis
    }

    /// Whether values or their logarithms are interpolated.
    #[must_use]
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// The values at the nodes.
    #[must_use]
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// The value at coordinate `x`, in the field's unit: between nodes a and b,
    /// at the fraction f, v = (1-f) v_a + f v_b, or v_a^(1-f) v_b^f on a
    /// logarithmic scale.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] where the axis refuses.
    pub fn at(&self, x: f64) -> Result<f64, TableError> {
        let Some(at) = self.axis.locate(x)? else { return Ok(0.0) };
        let a = self.values[at.index];
        if at.fraction == 0.0 {
            return Ok(a);
        }
        Ok(self.scale.between(a, self.values[at.index + 1], at.fraction))
    }
}

impl Scale {
    /// The value at fraction `f` of the way from `a` to `b`.
    #[must_use]
    pub fn between(self, a: f64, b: f64, f: f64) -> f64 {
        match self {
            Self::Linear => a + f * (b - a),
            Self::Logarithmic => a * (f * (b / a).ln()).exp(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_logarithmic_curve_reproduces_an_exponential() {
        let axis = Axis::uniform("altitude", "km", 0.0, 5.0, 5).expect("valid");
        let values = axis.nodes.iter().map(|z| (-z / 8.0_f64).exp()).collect();
        let curve = Curve::new(axis, Scale::Logarithmic, values).expect("valid");
        for i in 0..=200 {
            let z = f64::from(i) / 10.0;
            let exact = (-z / 8.0).exp();
            let got = curve.at(z).expect("inside");
            // A few roundings of ln and exp.
            assert!((got / exact - 1.0).abs() < 1e-14, "{got} for {exact} at {z}");
        }
    }

    #[test]
    fn a_linear_curve_reproduces_a_line_and_its_nodes() {
        let axis = Axis::new("x", "1", vec![0.0, 1.0, 4.0]).expect("valid");
        let curve = Curve::new(axis, Scale::Linear, vec![1.0, 3.0, 9.0]).expect("valid");
        assert_eq!(curve.at(4.0).expect("node"), 9.0);
        assert!((curve.at(2.5).expect("inside") - 6.0).abs() < 1e-15);
    }

    #[test]
    fn values_that_do_not_fit_are_refused() {
        let axis = || Axis::new("x", "1", vec![0.0, 1.0]).expect("valid");
        assert!(Curve::new(axis(), Scale::Linear, vec![1.0]).is_err());
        assert!(Curve::new(axis(), Scale::Linear, vec![1.0, f64::INFINITY]).is_err());
        assert!(Curve::new(axis(), Scale::Logarithmic, vec![1.0, 0.0]).is_err());
    }
}
