//! Measurements for plans: what every candidate is off and costs on scenes spread over suns, observers, grounds and aerosols, and the judgement of plans
//! by scenes kept apart.

mod judge;
mod measure;
mod scenes;

pub use judge::judge;
pub use scenes::{Set, atmosphere};

use crate::data::Data;
use crate::plan::{Measured, Row};
use crate::render::RenderError;
use std::collections::BTreeSet;
use std::sync::Mutex;

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
    if let Some(number) = finished.iter().find(|&&number| !is_whole(set, number, &known)) {
        let what = format!("the scenes of atmosphere {number} are not this study's: start anew, without --resume");
        return Err(RenderError::Measured(what));
    }
    let rows = Mutex::new(known.rows);
    let done = Mutex::new(vec![0.0; atmospheres]);
    super::on_one_core_each(atmospheres, threads, &|number| {
        if finished.contains(&number) {
            return Ok(());
        }
        let step = |share: f64| {
            let mut done = done.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
            done[number] = share;
            progress(done.iter().sum::<f64>() / atmospheres as f64);
        };
        let made = measure::measure(data, set, number, &atmosphere(set, number), &step)?;
        // A thread that panicked takes the study with it.
        let mut rows = rows.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        rows.extend(made);
        rows.sort_by_key(|row| row.atmosphere);
        keep(&with_margins(rows.clone())?);
        Ok(())
    })?;
    let rows = rows.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    with_margins(rows)
}

/// Whether rows have the scenes of an atmosphere of a set, as exactly as a file tells.
fn is_whole(set: Set, number: usize, known: &Measured) -> bool {
    let rows: Vec<_> = known.rows.iter().filter(|row| row.atmosphere == number).collect();
    let scenes = atmosphere(set, number);
    let same = |(row, scene): (&&Row, &crate::scene::Scene)| {
        (row.traits.sun_elevation_deg - scene.sun_elevation_deg).abs() < 0.01
            && (row.traits.altitude_km - scene.altitude_km).abs() < 0.001
            && row.traits.biome == scene.biome
    };
    rows.len() == scenes.len() && rows.iter().zip(&scenes).all(same)
}

/// Rows, as a file has them, with the margins that these call for; none of a single atmosphere.
fn with_margins(rows: Vec<Row>) -> Result<Measured, RenderError> {
    let measured = Measured::parse(&Measured { rows, ..Measured::default() }.csv()).map_err(RenderError::Measured)?;
    let one = measured.rows.iter().all(|row| row.atmosphere == measured.rows[0].atmosphere);
    let margins = if one { Ok([0.0; 3]) } else { crate::plan::margins(&measured) };
    Ok(Measured { margins: margins.map_err(RenderError::Measured)?, ..measured })
}
