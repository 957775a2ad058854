//! Seconds of work, whatever else the machine does: as Linux tells them in /proc, elsewhere those that have gone by.

use std::sync::OnceLock;
use std::time::Instant;

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

#[cfg(test)]
mod tests {
    use super::*;

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
