//! How an answer is judged beside a reference, both with their uncertainties.
//!
//! Of an answer v with the standard error s and a reference r with the uncertainty u (one standard deviation): the relative error is
//! (v - r) / |r|, and z = (v - r) / sqrt(s^2 + u^2), which is spread like a normal deviate if both are honest. Stokes parameters
//! Q and U may be zero; their relative errors are those of the radiance I of the same direction.

/// The largest |z| of a case that does not fail: 6e-7 of honest cases lie beyond.
pub const WORST_Z: f64 = 5.0;

/// The largest rms of z of a group that does not fail, and the least number of cases for which it says something: 1 within 0.1.
pub const GROUP_Z: (f64, usize) = (1.2, 50);

/// An answer beside its reference.
#[derive(Debug, Clone, PartialEq)]
pub struct Compared {
    /// The case.
    pub id: String,
    /// The answer and its standard error.
    pub found: (f64, f64),
    /// The reference and its uncertainty.
    pub reference: (f64, f64),
    /// What relative errors refer to.
    pub scale: f64,
}

impl Compared {
    /// (v - r) / scale; 0 where the scale is 0.
    #[must_use]
    pub fn relative(&self) -> f64 {
        if self.scale == 0.0 { 0.0 } else { (self.found.0 - self.reference.0) / self.scale.abs() }
    }

    /// The combined uncertainty over the scale; infinite where the scale is 0.
    #[must_use]
    pub fn uncertainty(&self) -> f64 {
        self.found.1.hypot(self.reference.1) / self.scale.abs()
    }

    /// (v - r) / sqrt(s^2 + u^2); 0 if both agree exactly.
    #[must_use]
    pub fn z(&self) -> f64 {
        let difference = self.found.0 - self.reference.0;
        if difference == 0.0 { 0.0 } else { difference / self.found.1.hypot(self.reference.1) }
    }

    /// Whether it is further off than [`WORST_Z`], or no number.
    #[must_use]
    pub fn fails(&self) -> bool {
        !within(self.z(), WORST_Z)
    }
}

/// What many of them have in common.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// How many.
    pub count: usize,
    /// Mean relative error, weighed by the inverse square of the uncertainty.
    pub bias: f64,
    /// Its uncertainty.
    pub bias_error: f64,
    /// Root mean square of the relative errors.
    pub rms: f64,
    /// The largest of them by its absolute value.
    pub worst: f64,
    /// Root mean square of z.
    pub rms_z: f64,
    /// The largest |z|.
    pub max_z: f64,
}

impl Statistics {
    /// Of some cases; zeros of none.
    #[must_use]
    pub fn of(cases: &[&Compared]) -> Self {
        let n = cases.len().max(1) as f64;
        let (mut weights, mut bias, mut squares, mut z_squares) = (0.0, 0.0, 0.0, 0.0);
        let (mut worst, mut max_z) = (0.0_f64, 0.0_f64);
        for case in cases {
            let (relative, z) = (case.relative(), case.z());
            let weight = case.uncertainty().powi(-2);
            if weight.is_finite() {
                weights += weight;
                bias += weight * relative;
            }
            squares += relative * relative;
            z_squares += z * z;
            worst = if relative.abs() > worst.abs() { relative } else { worst };
            max_z = max_z.max(z.abs());
        }
        let known = if weights > 0.0 { weights } else { 1.0 };
        Self {
            count: cases.len(),
            bias: bias / known,
            bias_error: known.powf(-0.5),
            rms: (squares / n).sqrt(),
            worst,
            rms_z: (z_squares / n).sqrt(),
            max_z,
        }
    }

    /// Whether z is spread too widely for a group of its size.
    #[must_use]
    pub fn fails(&self) -> bool {
        self.count >= GROUP_Z.1 && self.rms_z > GROUP_Z.0
    }
}

/// Whether an error is no larger than a limit; one that is no number is not.
#[must_use]
pub fn within(error: f64, limit: f64) -> bool {
    error.abs() <= limit
}

/// Count, mean, root mean square and largest absolute value of numbers.
#[must_use]
pub fn spread(values: impl IntoIterator<Item = f64>) -> (usize, f64, f64, f64) {
    let (mut count, mut sum, mut squares, mut worst) = (0, 0.0, 0.0, 0.0_f64);
    for value in values {
        count += 1;
        sum += value;
        squares += value * value;
        worst = if value.abs() > worst.abs() { value } else { worst };
    }
    let n = f64::from(count.max(1));
    (count as usize, sum / n, f64::sqrt(squares / n), worst)
}

/// A share in percent with a sign, to so many decimals.
#[must_use]
pub fn percent(share: f64, decimals: usize) -> String {
    signed(100.0 * share, decimals)
}

/// A number with its sign, to so many decimals; a zero has none.
#[must_use]
pub fn signed(value: f64, decimals: usize) -> String {
    let text = format!("{value:+.decimals$}");
    if text.trim_start_matches(['+', '-']).chars().all(|c| c == '0' || c == '.') { text[1..].to_owned() } else { text }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn case(found: f64, stderr: f64, reference: f64, unc: f64) -> Compared {
        Compared { id: String::new(), found: (found, stderr), reference: (reference, unc), scale: reference }
    }

    #[test]
    fn z_and_bias_are_those_worked_by_hand() {
        // 2 + 0.10 with errors 0.03 and 0.04: z = 0.1 / 0.05. 4 - 0.2 with 0.06 and 0.08: z = -2, both relative errors 5 % with
        // uncertainties of 2.5 %.
        let (high, low) = (case(2.1, 0.03, 2.0, 0.04), case(3.8, 0.06, 4.0, 0.08));
        assert!((high.z() - 2.0).abs() < 1e-12 && (low.z() + 2.0).abs() < 1e-12);
        let found = Statistics::of(&[&high, &low]);
        assert_eq!(found.count, 2);
        // Rounding only, here and below.
        assert!(found.bias.abs() < 1e-12 && (found.bias_error - 0.025 / 2.0_f64.sqrt()).abs() < 1e-12);
        assert!((found.rms - 0.05).abs() < 1e-12 && (found.rms_z - 2.0).abs() < 1e-12);
        // Three times as well known, the first weighs 9 times as much: bias 5 % (9 - 1) / (9 + 1).
        let well = case(2.1, 0.01, 2.0, 0.04 / 3.0);
        assert!((Statistics::of(&[&well, &low]).bias - 0.04).abs() < 1e-12);
    }

    #[test]
    fn what_is_off_or_no_number_fails() {
        assert!(!case(1.0, 0.1, 1.5, 0.0).fails());
        assert!(case(1.0, 0.1, 1.51, 0.0).fails() && case(f64::NAN, 0.1, 1.0, 0.0).fails());
        // Exactly the reference, both without error, is no failure; and a difference without error is one.
        assert!(!case(1.0, 0.0, 1.0, 0.0).fails() && case(1.1, 0.0, 1.0, 0.0).fails());
    }
}
