//! Numbers and lines for people to read.

use std::fmt::Write;

/// Six significant digits, in powers of ten where they are shorter to read.
#[must_use]
pub fn six_digits(x: f64) -> String {
    let powers = format!("{x:.5e}");
    // What rounding made of it decides: 0.99999999 has the digits of 1.
    let exponent: i32 = powers.split_once('e').and_then(|(_, e)| e.parse().ok()).unwrap_or(0);
    if x == 0.0 || (-3..6).contains(&exponent) { format!("{x:.*}", (5 - exponent).max(0) as usize) } else { powers }
}

/// The shortest digits that give the double back, without a point where there is nothing behind it.
#[must_use]
pub fn shortest(x: f64) -> String {
    if x == 0.0 || (1e-4..1e15).contains(&x.abs()) { format!("{x}") } else { format!("{x:e}") }
}

/// The widest column that is aligned; longer cells stick out.
const WIDEST: usize = 2000;

/// Rows in columns two spaces apart, each line after `indent` spaces. Cells are flush left, in the columns for which
/// `right` holds flush right.
#[must_use]
pub fn aligned(rows: &[Vec<String>], indent: usize, right: impl Fn(usize) -> bool) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |i: usize| {
        rows.iter().filter_map(|row| row.get(i)).map(|cell| cell.chars().count()).max().unwrap_or(0).min(WIDEST)
    };
    let widths: Vec<usize> = (0..columns).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let cell = |(i, (cell, &width)): (usize, (&String, &usize))| {
            if right(i) { format!("{cell:>width$}") } else { format!("{cell:width$}") }
        };
        let cells: Vec<String> = row.iter().zip(&widths).enumerate().map(cell).collect();
        let _ = writeln!(text, "{:indent$}{}", "", cells.join("  ").trim_end()); // writing to a String does not fail
    }
    text
}

/// Words in lines of at most `width` characters, the lines after the first behind `indent` spaces; a longer word has
/// a line of its own. The first line begins where `used` characters already stand.
#[must_use]
pub fn wrapped(words: &str, used: usize, indent: usize, width: usize) -> String {
    let mut text = String::new();
    let mut at = used;
    for word in words.split_whitespace() {
        let length = word.chars().count();
        let begins = text.is_empty();
        if !begins && at + 1 + length > width {
            let _ = write!(text, "\n{:indent$}", "");
            at = indent;
        } else if !begins {
            text.push(' ');
            at += 1;
        }
        text += word;
        at += length;
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_six_digits() {
        for (x, expected) in [
            (101_325.0, "101325"),
            (0.05, "0.0500000"),
            (0.001_093_21, "0.00109321"),
            (999_999.7, "1.00000e6"),
            (9.999_999, "10.0000"),
            (2.546_972e25, "2.54697e25"),
            (-288.15, "-288.150"),
            (0.0, "0.00000"),
        ] {
            assert_eq!(six_digits(x), expected);
        }
    }

    #[test]
    fn the_shortest_digits_give_the_number_back() {
        for (x, expected) in [(550.0, "550"), (0.1, "0.1"), (4.5e-31, "4.5e-31"), (2.5e25, "2.5e25"), (-3.0, "-3")] {
            assert_eq!(shortest(x), expected);
        }
        for x in [1.0 / 3.0, 1e15 / 7.0, 1e-4 / 3.0, f64::MIN_POSITIVE, f64::MAX, f64::from(0.1_f32)] {
            assert_eq!(shortest(x).parse::<f64>().expect("a number").to_bits(), x.to_bits());
        }
    }

    #[test]
    fn lines_are_aligned_and_wrapped() {
        let rows = [vec!["a".into(), "1".into()], vec!["bcd".into(), "12".into()]];
        assert_eq!(aligned(&rows, 1, |i| i == 1), " a     1\n bcd  12\n");
        assert_eq!(wrapped("one two three four", 2, 4, 12), "one two\n    three\n    four");
    }
}
