//! A field along one axis.

use crate::{Axis, Interpolation, Outside, Scale, TableError};
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
    /// finite, or a value on a logarithmic scale is not positive, and for an axis whose values more than two nodes make.
    pub fn new(axis: impl Into<Arc<Axis>>, scale: Scale, values: Vec<f64>) -> Result<Self, TableError> {
        let axis = axis.into();
        axis.validate()?;
        axis.refuse_curved()?;
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

    /// All values times a positive `factor`, which no scale minds.
    #[must_use]
    pub fn times(&self, factor: f64) -> Self {
        Self { values: self.values.iter().map(|value| factor * value).collect(), ..self.clone() }
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

    /// The integral over all nodes, exact for the interpolation: between two at the distance d, of values a
    /// and b, d (a + b) / 2, or d (b - a) / ln(b / a) on a logarithmic scale, or d a where a value holds up to the next.
    #[must_use]
    pub fn total(&self) -> f64 {
        let ends = self.axis.nodes.windows(2).zip(self.values.windows(2));
        ends.map(|(x, v)| (x[1] - x[0]) * self.mean(v[0], v[1])).sum()
    }

    /// The integral from `low` to `high`, by the rules between and outside the nodes, as [`Curve::total`].
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] where the axis refuses; so does an axis of [`Interpolation::Node`].
    pub fn integral(&self, low: f64, high: f64) -> Result<f64, TableError> {
        if low > high {
            return Ok(-self.integral(high, low)?);
        }
        let (first, last) = self.axis.range();
        for x in [low, high, 0.5 * (low + high)] {
            self.axis.locate(x)?;
        }
        let mut sum = 0.0;
        if self.axis.outside == Outside::Hold {
            sum += self.values[0] * (high.min(first) - low).max(0.0);
            sum += self.values[self.values.len() - 1] * (high - low.max(last)).max(0.0);
        }
        let (mut from, high) = (low.max(first), high.min(last));
        let inner = self.axis.nodes.iter().copied().filter(|&node| low < node && node < high);
        for to in inner.chain([high]).filter(|&to| to > low.max(first)) {
            sum += (to - from) * self.mean(self.at(from)?, self.at(to)?);
            from = to;
        }
        Ok(sum)
    }

    /// The mean between two places of one interval with these values.
    fn mean(&self, a: f64, b: f64) -> f64 {
        match self.axis.interpolation {
            Interpolation::Step | Interpolation::Node => a,
            // Of the curved rules there is no curve.
            Interpolation::Linear | Interpolation::Cubic | Interpolation::Parabolic => self.scale.mean(a, b),
        }
    }
}

impl Scale {
    /// What is interpolated: the value, or its logarithm.
    #[must_use]
    pub fn of(self, value: f64) -> f64 {
        match self {
            Self::Linear => value,
            Self::Logarithmic => value.ln(),
        }
    }

    /// The value of what was interpolated.
    #[must_use]
    pub fn back(self, interpolated: f64) -> f64 {
        match self {
            Self::Linear => interpolated,
            Self::Logarithmic => interpolated.exp(),
        }
    }

    /// The value at fraction `f` of the way from `a` to `b`.
    #[must_use]
    pub fn between(self, a: f64, b: f64, f: f64) -> f64 {
        match self {
            Self::Linear => a + f * (b - a),
            Self::Logarithmic => a * (f * (b / a).ln()).exp(),
        }
    }

    /// The mean over the way from `a` to `b`: (a + b) / 2, or (b - a) / ln(b / a).
    #[must_use]
    pub fn mean(self, a: f64, b: f64) -> f64 {
        match self {
            Self::Linear => 0.5 * (a + b),
            Self::Logarithmic => {
                let rise = (b / a).ln();
                if rise == 0.0 { a } else { a * rise.exp_m1() / rise }
            }
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
    fn integrals_are_those_of_the_interpolated_function() {
        let axis = Axis::new("altitude", "km", vec![0.0, 5.0, 20.0]).expect("valid");
        let values: Vec<f64> = axis.nodes.iter().map(|z| (-z / 8.0_f64).exp()).collect();
        let exponential = Curve::new(axis.clone(), Scale::Logarithmic, values.clone()).expect("valid");
        let exact = |low: f64, high: f64| 8.0 * ((-low / 8.0).exp() - (-high / 8.0).exp());
        for (low, high) in [(0.0, 20.0), (1.0, 2.0), (3.0, 19.0), (5.0, 5.0)] {
            let found = exponential.integral(low, high).expect("inside");
            // A few roundings of ln and exp.
            assert!((found - exact(low, high)).abs() < 1e-14, "{found} from {low} to {high}");
        }
        assert!((exponential.total() - exact(0.0, 20.0)).abs() < 1e-14);
        assert!(exponential.integral(-1.0, 3.0).is_err() && exponential.integral(0.0, 21.0).is_err());

        let held = Curve::new(axis.clone().beyond(Outside::Hold), Scale::Linear, vec![1.0, 3.0, 3.0]).expect("valid");
        assert_eq!(held.integral(-2.0, 22.0).expect("held"), 2.0 + 10.0 + 45.0 + 6.0);
        let zero = Curve::new(axis.clone().beyond(Outside::Zero), Scale::Linear, vec![1.0, 3.0, 3.0]).expect("valid");
        assert_eq!(zero.integral(-2.0, 22.0).expect("zero"), 10.0 + 45.0);
        assert_eq!(zero.integral(30.0, 40.0).expect("zero"), 0.0);
        let steps = axis.between(Interpolation::Step);
        let steps = Curve::new(steps, Scale::Linear, vec![1.0, 3.0, 7.0]).expect("valid");
        assert_eq!(steps.integral(4.0, 6.0).expect("inside"), 1.0 + 3.0);
        assert_eq!(steps.integral(6.0, 4.0).expect("inside"), -4.0);
    }

    #[test]
    fn values_that_do_not_fit_are_refused() {
        let axis = || Axis::new("x", "1", vec![0.0, 1.0]).expect("valid");
        assert!(Curve::new(axis(), Scale::Linear, vec![1.0]).is_err());
        assert!(Curve::new(axis(), Scale::Linear, vec![1.0, f64::INFINITY]).is_err());
        assert!(Curve::new(axis(), Scale::Logarithmic, vec![1.0, 0.0]).is_err());
        assert!(Curve::new(axis().between(Interpolation::Cubic), Scale::Linear, vec![1.0, 0.0]).is_err());
    }
}
