//! Seconds of work, whatever else the machine does: as Linux tells them in /proc, elsewhere those that have gone by. And the time of day.

use std::sync::OnceLock;
use std::time::{Instant, SystemTime, UNIX_EPOCH};

fn gone_by() -> f64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Seconds that this thread has worked, from some beginning.
pub(crate) fn thread_s() -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let ns = told.and_then(|text| text.split(' ').next()?.parse::<f64>().ok());
    ns.map_or_else(gone_by, |ns| 1e-9 * ns)
}

/// Core-seconds that all threads of this process have worked, from some beginning, to a hundredth.
pub(crate) fn process_s() -> f64 {
    const PER_S: f64 = 100.0;
    let told = std::fs::read_to_string("/proc/self/stat").ok();
    // Behind the name in brackets: state, ten numbers, then the times of user and system.
    let ticks = told.and_then(|text| {
        let mut fields = text.rsplit_once(')')?.1.split_whitespace().skip(11);
        Some(fields.next()?.parse::<f64>().ok()? + fields.next()?.parse::<f64>().ok()?)
    });
    ticks.map_or_else(gone_by, |ticks| ticks / PER_S)
}

/// An instant in UTC to a second, as RFC 3339 writes it: `2026-06-21T18:30:00Z`. 1970 for what is before it.
///
/// The day by the civil calendar, counted in eras of 400 years = 146 097 days that begin on the first of March, so that a leap day ends a year; months
/// of the year from March have (153 m + 2) / 5 days before them.
pub(crate) fn utc(instant: SystemTime) -> String {
    let seconds = instant.duration_since(UNIX_EPOCH).map_or(0, |since| since.as_secs());
    let (days, second) = (seconds / 86_400 + 719_468, seconds % 86_400);
    let (era, day) = (days / 146_097, days % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let day = day - (153 * month + 2) / 5 + 1;
    let (year, month) = if month < 10 { (400 * era + year, month + 3) } else { (400 * era + year + 1, month - 9) };
    format!("{year:04}-{month:02}-{day:02}T{:02}:{:02}:{:02}Z", second / 3600, second / 60 % 60, second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn an_instant_has_its_date() {
        // As `date -u -d @S` has them: the end of a leap day, of a century without one, and of one with.
        let of = |seconds: u64| utc(UNIX_EPOCH + Duration::from_secs(seconds));
        assert_eq!(of(0), "1970-01-01T00:00:00Z");
        assert_eq!(of(951_868_799), "2000-02-29T23:59:59Z");
        assert_eq!(of(1_782_066_600), "2026-06-21T18:30:00Z");
        assert_eq!(of(4_107_542_400), "2100-03-01T00:00:00Z");
        assert_eq!(of(1_735_689_599), "2024-12-31T23:59:59Z");
    }

    #[test]
    fn work_takes_time() {
        let before = (thread_s(), process_s());
        let start = Instant::now();
        let mut sum = 0.0_f64;
        // Until this thread has worked for some hundredths.
        while thread_s() - before.0 < 0.03 && start.elapsed().as_secs() < 20 {
            sum = (0..10_000).fold(sum, |sum, i| sum + f64::from(i).sqrt());
        }
        assert!(sum > 0.0 && thread_s() - before.0 >= 0.03);
        assert!(process_s() >= before.1 + 0.01);
    }
}
