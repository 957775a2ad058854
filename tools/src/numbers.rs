//! Numbers as a user writes them: one, a list, a range, or a list of both.

use std::str::FromStr;

/// The most numbers that one flag can stand for.
const MOST: usize = 100_000;

/// Finite numbers, at least one, in the order in which they were written.
///
/// `5`; `0,1,2.5`; `0:80:1`, which is LOW:HIGH:STEP, with HIGH if a step falls on it; `0:2:0.5,5,10`. The numbers of a
/// range are those that its decimals name: `0:1:0.1` holds 0.3, not 3 times the double next to 0.1.
#[derive(Debug, Clone, PartialEq)]
pub struct Numbers(pub Vec<f64>);

/// Why a text stands for no numbers.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum NumbersError {
    /// Something that is neither a number nor a range.
    #[error("{found:?} is no number: write one (5), a list (0,1,2.5) or a range LOW:HIGH:STEP (0:80:1)")]
    NotANumber {
        /// The part that is not understood.
        found: String,
    },
    /// A range that is not of three parts.
    #[error("{found:?} is no range: write LOW:HIGH:STEP, such as 0:80:1")]
    NotThree {
        /// The range.
        found: String,
    },
    /// A range that leads nowhere.
    #[error("range {found:?}: LOW must not be above HIGH, and STEP must be above 0")]
    Nowhere {
        /// The range.
        found: String,
    },
    /// More numbers than anyone wants.
    #[error("range {found:?} has more than {MOST} numbers, the most that are possible")]
    TooMany {
        /// The range.
        found: String,
    },
}

impl FromStr for Numbers {
    type Err = NumbersError;

    fn from_str(text: &str) -> Result<Self, Self::Err> {
        let mut numbers = Vec::new();
        for part in text.split(',').map(str::trim) {
            if part.contains(':') {
                numbers.extend(range(part)?)
            } else {
                numbers.push(number(part)?)
            }
            if numbers.len() > MOST {
                return Err(NumbersError::TooMany { found: text.into() });
            }
        }
        Ok(Self(numbers))
    }
}

fn number(text: &str) -> Result<f64, NumbersError> {
    let number = text.parse::<f64>().ok().filter(|x| x.is_finite());
    number.ok_or_else(|| NumbersError::NotANumber { found: text.into() })
}

fn range(text: &str) -> Result<Vec<f64>, NumbersError> {
    let found = || text.to_owned();
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let [low_text, high_text, step_text] = parts[..] else { return Err(NumbersError::NotThree { found: found() }) };
    let (low, high, step) = (number(low_text)?, number(high_text)?, number(step_text)?);
    if low > high || step <= 0.0 {
        return Err(NumbersError::Nowhere { found: found() });
    }
    // A step may fall on HIGH but for rounding.
    let steps = ((high - low) / step + 1e-9).floor();
    if steps >= MOST as f64 {
        return Err(NumbersError::TooMany { found: found() });
    }
    // Counted in units of the last decimal, which are whole numbers.
    let unit = 10_f64.powi(decimals(low_text).max(decimals(step_text)));
    let (first, each) = ((low * unit).round(), (step * unit).round());
    let exact = first.abs().max(high.abs() * unit) < 2_f64.powi(53) && each >= 1.0;
    let value = |i: usize| {
        let i = i as f64;
        if exact { (first + i * each) / unit } else { (low + i * step).min(high) }
    };
    Ok((0..=steps as usize).map(value).collect())
}

/// Digits behind the point; 22, the most whose power of ten is a double, where there is an exponent.
fn decimals(text: &str) -> i32 {
    if text.contains(['e', 'E']) {
        return 22;
    }
    text.split_once('.').map_or(0, |(_, digits)| digits.len().min(22) as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Vec<f64> {
        text.parse::<Numbers>().expect("numbers").0
    }

    #[test]
    fn one_many_and_ranges_are_understood() {
        assert_eq!(parsed("550"), [550.0]);
        assert_eq!(parsed(" 0, 1,2.5"), [0.0, 1.0, 2.5]);
        assert_eq!(parsed("0:3:1"), [0.0, 1.0, 2.0, 3.0]);
        assert_eq!(parsed("0:1:0.4,7,-2:-1:1"), [0.0, 0.4, 0.8, 7.0, -2.0, -1.0]);
        assert_eq!(parsed("5:5:1"), [5.0]);
        assert_eq!(parsed("1e2:3e2:1e2"), [100.0, 200.0, 300.0]);
    }

    #[test]
    fn a_range_holds_the_decimals_that_it_names() {
        // 3 x 0.1 is 0.30000000000000004, and (1 - 0) / 0.1 steps fall on the end.
        assert_eq!(parsed("0:1:0.1"), [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0]);
        assert_eq!(parsed("300:1000:0.1").len(), 7001);
        assert_eq!(parsed("300:1000:0.1")[2507], 550.7);
    }

    #[test]
    fn what_is_not_understood_is_refused_with_what_would_be() {
        for (text, expected) in [
            ("", "\"\" is no number: write one (5), a list (0,1,2.5) or a range LOW:HIGH:STEP (0:80:1)"),
            ("1,,2", "\"\" is no number"),
            ("0-80", "\"0-80\" is no number"),
            ("nan", "\"nan\" is no number"),
            ("inf:2:1", "\"inf\" is no number"),
            ("0:80", "\"0:80\" is no range: write LOW:HIGH:STEP, such as 0:80:1"),
            ("0:80:1:2", "is no range"),
            ("80:0:1", "range \"80:0:1\": LOW must not be above HIGH"),
            ("0:80:0", "STEP must be above 0"),
            ("0:80:1e-6", "has more than 100000 numbers"),
        ] {
            let error = text.parse::<Numbers>().expect_err(text).to_string();
            assert!(error.contains(expected), "{text}: {error}");
        }
    }
}
