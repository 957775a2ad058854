//! One line on the terminal that is written over again and again.

use std::io::{IsTerminal, Write};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// Longest pause between two looks of a person who waits.
const EVERY: Duration = Duration::from_millis(100);

/// A line on standard error, if that is a terminal and not to be quiet.
pub(super) struct Line {
    start: Instant,
    /// When the line was last written; `None` if it never is.
    last: Option<Mutex<Instant>>,
}

impl Line {
    pub(super) fn new(quiet: bool) -> Self {
        let start = Instant::now();
        let shown = !quiet && std::io::stderr().is_terminal();
        Self { start, last: shown.then(|| Mutex::new(start)) }
    }

    /// Time since the line was made.
    pub(super) fn elapsed(&self) -> Duration {
        self.start.elapsed()
    }

    /// Shows the fraction done, what `text` says, and the time left. From any thread; most calls do nothing.
    pub(super) fn show(&self, fraction: f64, text: impl FnOnce(f64) -> String) {
        let Some(last) = &self.last else { return };
        let Ok(mut last) = last.try_lock() else { return };
        if last.elapsed() < EVERY {
            return;
        }
        *last = Instant::now();
        let elapsed = self.start.elapsed().as_secs_f64();
        let left = if fraction > 0.0 { duration(elapsed * (1.0 - fraction) / fraction) } else { "?".into() };
        let line = format!("{:3.0} %  {}  {left} left", 100.0 * fraction, text(elapsed));
        // Progress that cannot be shown is no reason to stop.
        let _ = write!(std::io::stderr(), "\r\x1b[K{line}");
    }

    /// Wipes the line.
    pub(super) fn clear(&self) {
        if self.last.is_some() {
            let _ = write!(std::io::stderr(), "\r\x1b[K");
        }
    }
}

/// A number of seconds for people.
pub(super) fn duration(seconds: f64) -> String {
    // Saturates; a year-long guess needs no digits.
    let whole = seconds.round() as u64;
    match whole {
        0..10 => format!("{seconds:.1} s"),
        10..120 => format!("{whole} s"),
        120..7200 => format!("{} min {} s", whole / 60, whole % 60),
        _ => format!("{} h {} min", whole / 3600, whole % 3600 / 60),
    }
}

/// A number of bytes for people.
pub(super) fn size(bytes: usize) -> String {
    let bytes = bytes as f64;
    match bytes {
        0.0..1e3 => format!("{bytes} B"),
        1e3..1e6 => format!("{:.0} kB", bytes / 1e3),
        _ => format!("{:.1} MB", bytes / 1e6),
    }
}

/// A share in percent with two significant digits.
pub(super) fn percent(share: f64) -> String {
    if !share.is_finite() {
        return "unknown".into();
    }
    let value = 100.0 * share;
    let decimals = if value <= 0.0 { 0.0 } else { (1.0 - value.log10().floor()).clamp(0.0, 6.0) };
    format!("{value:.*} %", decimals as usize)
}

/// A quantity with three significant digits: 12 300, 4.56, 1.2e-5.
pub(super) fn amount(value: f64) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let digits = value.abs().log10().floor();
    if !(-3.0..9.0).contains(&digits) {
        return format!("{value:.2e}");
    }
    let step = 10.0_f64.powf(digits - 2.0);
    let decimals = (2.0 - digits).max(0.0) as usize;
    format!("{:.decimals$}", (value / step).round() * step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_shown_with_the_digits_that_matter() {
        assert_eq!([0.05, 0.0123, 0.000_456, 1.0].map(percent), ["5.0 %", "1.2 %", "0.046 %", "100 %"]);
        assert_eq!(percent(f64::INFINITY), "unknown");
        assert_eq!([73_456.0, 456.7, 4.567, 0.0045, 0.0].map(amount), ["73500", "457", "4.57", "0.00450", "0"]);
        assert_eq!([3.21, 65.4, 185.0, 9000.0].map(duration), ["3.2 s", "65 s", "3 min 5 s", "2 h 30 min"]);
        assert_eq!([12, 45_678, 3_456_789].map(size), ["12 B", "46 kB", "3.5 MB"]);
    }
}
