//! Measurements for plans: what every candidate is off and costs on scenes spread over suns, observers, grounds and aerosols, and the judgement of plans
//! by scenes kept apart.

mod judge;
mod measure;
mod scenes;

pub use judge::judge;
pub(super) use measure::directions;
pub use scenes::{Set, atmosphere};

use crate::data::Data;
use crate::plan::{Measured, Row};
use crate::render::RenderError;
use std::collections::BTreeSet;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Measures the first `atmospheres` of a set, but for those that are `known`, with that many threads, each with atmospheres of its own, so that every time is
/// that of one core. Hands `keep` what there is after each atmosphere.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes, or what `keep` says.
pub fn measure(
    data: &Data,
    (set, atmospheres, known): (Set, usize, Measured),
    threads: usize,
    progress: &(dyn Fn(f64) + Sync),
    keep: &(dyn Fn(&Measured) + Sync),
) -> Result<Measured, RenderError> {
    let finished: BTreeSet<usize> = known.rows.iter().map(|row| row.atmosphere).collect();
    let (next, rows) = (AtomicUsize::new(0), Mutex::new(known.rows));
    let done = Mutex::new(vec![0.0; atmospheres]);
    let work = || -> Result<(), RenderError> {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= atmospheres {
                return Ok(());
            }
            if finished.contains(&number) {
                continue;
            }
            let step = |share: f64| {
                let mut done = done.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
                done[number] = share;
                progress(done.iter().sum::<f64>() / atmospheres as f64);
            };
            let scenes = atmosphere(set, number);
            let made = pool.install(|| measure::measure(data, set, number, &scenes, &step))?;
            // A thread that panicked takes the study with it.
            let mut rows = rows.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            rows.extend(made);
            rows.sort_by_key(|row| row.atmosphere);
            keep(&with_margins(rows.clone())?);
        }
    };
    std::thread::scope(|scope| {
        let workers: Vec<_> = (0..threads.max(1)).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|worker| match worker.join() {
            Ok(result) => result,
            Err(panic) => std::panic::resume_unwind(panic),
        })
    })?;
    let rows = rows.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    with_margins(rows)
}

/// Rows with the margins that they call for; none of a single atmosphere.
fn with_margins(rows: Vec<Row>) -> Result<Measured, RenderError> {
    let measured = Measured { rows, ..Measured::default() };
    let one = measured.rows.iter().all(|row| row.atmosphere == measured.rows[0].atmosphere);
    let margins = if one { Ok([0.0; 3]) } else { crate::plan::margins(&measured) };
    Ok(Measured { margins: margins.map_err(RenderError::Measured)?, ..measured })
}
