//! How fast Mie solvers are, and how right: those of `raw-data/mie-peers/`, measured side by side in one run, and the
//! classical variants of the stability study, measured as the study is made.

use super::mie_stability::{self, Timed};
use super::{Part, Results, StudyError};
use crate::frame::Frame;
use crate::raw::mie_peers::{MiePeers, Speed};
use std::path::Path;

/// Tasks of the peers: what its part is called, and its name in the file.
const TASKS: [(&str, &str); 2] = [("spheres", "a"), ("distributions", "b")];

/// Speeds and errors of both tasks; the variants are timed at the first.
pub(super) fn measure(raw_dir: &Path) -> Result<Results, StudyError> {
    let peers = MiePeers::from_dir(raw_dir)?.speeds;
    let mut results = Results { parts: Vec::new(), remarks: vec![format!("peers: {}", peers.provenance.source)] };
    for (part, task) in TASKS {
        let mut points: Vec<(String, f64, f64)> = peers
            .rows
            .iter()
            .filter(|row| row.task == task)
            .map(|Speed { solver, spheres_per_second, largest_relative_error, .. }| {
                (solver.clone(), *spheres_per_second, *largest_relative_error)
            })
            .collect();
        results.remarks.extend(beside(part, &points));
        if task == "a" {
            let timed = mie_stability::timed()?;
            points.extend(timed.into_iter().map(|Timed { key, spheres_per_second, largest_relative_error }| {
                (format!("variant {key}"), spheres_per_second, largest_relative_error)
            }));
        }
        let front: Vec<f64> = points.iter().map(|p| f64::from(u8::from(on_front(p, &points)))).collect();
        let frame = Frame::new([
            ("spheres_per_second", points.iter().map(|p| p.1).collect()),
            ("largest_relative_error", points.iter().map(|p| p.2).collect()),
            ("on_pareto_front", front),
        ])?;
        results
            .parts
            .push(Part { name: part, frame: frame.labelled([("solver", points.into_iter().map(|p| p.0).collect())])? });
    }
    Ok(results)
}

/// Whether no other point is both faster and at least as right, or righter and at least as fast.
fn on_front(one: &(String, f64, f64), all: &[(String, f64, f64)]) -> bool {
    !all.iter().any(|other| (other.1 > one.1 && other.2 <= one.2) || (other.1 >= one.1 && other.2 < one.2))
}

/// The speed of each of Airlight's instruction sets over that of the fastest other solver, in words.
fn beside(part: &str, points: &[(String, f64, f64)]) -> Vec<String> {
    let ours = |p: &&(String, f64, f64)| p.0.starts_with("Airlight");
    let Some(fastest) = points.iter().filter(|p| !ours(p)).max_by(|a, b| a.1.total_cmp(&b.1)) else {
        return Vec::new();
    };
    let line = |p: &(String, f64, f64)| {
        let (times, other) = (p.1 / fastest.1, &fastest.0);
        format!("{part}: {}: {:.3e} spheres/s, {times:.1} times {other}, error {:.0e}", p.0, p.1, p.2)
    };
    points.iter().filter(ours).map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_is_of_those_that_nothing_beats() {
        let points = [("a".to_owned(), 10.0, 1e-3), ("b".to_owned(), 5.0, 1e-6), ("c".to_owned(), 4.0, 1e-4)];
        let front: Vec<bool> = points.iter().map(|p| on_front(p, &points)).collect();
        assert_eq!(front, [true, true, false]);
    }
}
