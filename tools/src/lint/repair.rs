//! Causes: the one exchange of two columns, or the one power of ten in a column, with which the most findings go away.

use super::finding::{Check, Finding};

/// What can be judged again after a change.
pub(super) trait Judged: Clone {
    /// Names of its columns or fields.
    fn names(&self) -> Vec<String>;
    /// Whether two columns could be taken for one another: of one quantity, or of one subject.
    fn related(&self, i: usize, j: usize) -> bool;
    /// Exchanges the numbers of two columns; false if they cannot be exchanged.
    fn exchange(&mut self, i: usize, j: usize) -> bool;
    /// Multiplies the numbers of a column.
    fn scale(&mut self, i: usize, factor: f64);
    /// The findings about what the numbers mean.
    fn laws(&self) -> Vec<Finding>;
}

/// Powers of ten that units differ by, and the first two that slip by a digit.
const POWERS: [i32; 12] = [3, -3, 6, -6, 2, -2, 1, -1, 9, -9, 12, -12];

fn weigh(findings: &[Finding]) -> u32 {
    findings.iter().map(|finding| finding.check.weight()).sum()
}

/// Indices of findings that are about the same columns, directly or through others.
fn clusters(findings: &[Finding]) -> Vec<Vec<usize>> {
    let mut clusters: Vec<(Vec<usize>, Vec<&str>)> = Vec::new();
    for (i, finding) in findings.iter().enumerate() {
        let mut joined = (vec![i], finding.columns.iter().map(String::as_str).collect::<Vec<_>>());
        let (with, without) =
            clusters.into_iter().partition(|(_, columns)| columns.iter().any(|c| joined.1.contains(c)));
        clusters = without;
        let with: Vec<(Vec<usize>, Vec<&str>)> = with;
        for (indices, columns) in with {
            joined.0.extend(indices);
            joined.1.extend(columns);
        }
        clusters.push(joined);
    }
    clusters.into_iter().map(|(indices, _)| indices).collect()
}

/// A change: in words, what remains after it, and how unlikely it is by itself.
struct Change {
    words: String,
    left: Vec<Finding>,
    unlikely: f64,
}

/// Whether a change takes away that scattering and absorption go together as in no particle.
fn settles(change: &Change, findings: &[Finding], cluster: &[usize]) -> bool {
    let of = |columns: &[String]| change.left.iter().any(|f| f.check == Check::Exchange && f.columns == columns);
    let mut impossible = cluster.iter().map(|f| &findings[*f]).filter(|f| f.check == Check::Exchange).peekable();
    impossible.peek().is_some() && impossible.all(|f| !of(&f.columns))
}

/// Gives each finding that a single change would remove that change as its cause. `findings` are those of the laws of
/// `judged`.
pub(super) fn explain<J: Judged>(judged: &J, findings: &mut [Finding]) {
    let base = weigh(findings);
    let names = judged.names();
    for cluster in clusters(findings) {
        let concerned: Vec<usize> =
            (0..names.len()).filter(|i| cluster.iter().any(|f| findings[*f].columns.contains(&names[*i]))).collect();
        let mut changes: Vec<Change> = Vec::new();
        for &i in &concerned {
            for j in (0..names.len()).filter(|j| *j > i || !concerned.contains(j)) {
                let mut changed = judged.clone();
                let near = concerned.contains(&j) || judged.related(i, j);
                if near && changed.exchange(i, j) {
                    let words = format!("{} and {} are swapped", names[i], names[j]);
                    let (left, within) = (changed.laws(), concerned.contains(&j));
                    // An exchange with a column of something else must put both right.
                    let named = |name: &String| left.iter().any(|f| f.columns.contains(name));
                    if within || !(named(&names[i]) || named(&names[j])) {
                        changes.push(Change { words, left, unlikely: if within { 0.0 } else { 0.5 } });
                    }
                }
            }
            for power in POWERS {
                let mut changed = judged.clone();
                changed.scale(i, 10.0_f64.powi(-power));
                let (size, kind) = (10.0_f64.powi(power.abs()), if power > 0 { "large" } else { "small" });
                let words = format!("{} is about {size} times too {kind}{}", names[i], units(power));
                changes.push(Change {
                    words,
                    left: changed.laws(),
                    unlikely: if power.abs() == 3 { 1.0 } else { 2.5 },
                });
            }
        }
        let own: u32 = cluster.iter().map(|f| findings[*f].check.weight()).sum();
        // What of the cluster a change leaves, or adds elsewhere.
        let rest = |change: &Change| (weigh(&change.left) + own).saturating_sub(base);
        let exchanged = |change: &Change| change.unlikely == 0.0 && settles(change, findings, &cluster);
        let changes: Vec<Change> = if changes.iter().any(|c| exchanged(c) && (rest(c) <= Check::Amount.weight()))
            || changes.iter().any(&exchanged) && !changes.iter().any(|c| c.unlikely >= 1.0 && rest(c) == 0)
        {
            changes.into_iter().filter(|c| exchanged(c) && rest(c) < own).collect()
        } else {
            changes.into_iter().filter(|c| 3 * rest(c) <= own).collect()
        };
        let cost = |change: &Change| f64::from(rest(change)) + change.unlikely;
        let Some(least) = changes.iter().map(cost).min_by(f64::total_cmp) else { continue };
        let changes: Vec<&Change> = changes.iter().filter(|change| cost(change) <= least).collect();
        for &index in &cluster {
            let finding = &mut findings[index];
            let gone = |change: &&&Change| {
                !change.left.iter().any(|left| {
                    left.check == finding.check && left.subject == finding.subject && left.columns == finding.columns
                })
            };
            let causes: Vec<&str> = changes.iter().filter(gone).map(|c| c.words.as_str()).take(3).collect();
            finding.cause = causes.join(", or ");
        }
    }
}

/// Slips of units that make a power of ten.
fn units(power: i32) -> &'static str {
    match power.abs() {
        2 => " (percent for parts of one, hPa for Pa, cm for m?)",
        3 => " (km for m, um for nm, km^-1 for m^-1?)",
        6 => " (km^2 for m^2, cm^-3 for m^-3, um for m?)",
        12 => " (um^2 for m^2?)",
        _ => "",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn findings_about_the_same_columns_are_one_cluster() {
        let about = |columns: &[&str]| Finding::new(Check::Range, columns, String::new(), "");
        let findings = [about(&["a", "b"]), about(&["c"]), about(&["b", "d"]), about(&["e", "c"])];
        let mut clusters = clusters(&findings);
        clusters.iter_mut().for_each(|c| c.sort_unstable());
        clusters.sort();
        assert_eq!(clusters, [vec![0, 2], vec![1, 3]]);
    }
}
