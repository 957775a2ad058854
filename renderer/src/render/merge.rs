//! Runs with different seeds or shards as one picture.

use super::state::overlap;
use super::{Head, Part};
use crate::film::Film;
use crate::scene::MAX_SPP;

/// Why states cannot be put together.
#[derive(Debug, thiserror::Error)]
pub enum MergeError {
    /// They are of different pictures.
    #[error("{first} and {second} are not of the same picture: {difference}")]
    Different {
        /// Name of one.
        first: String,
        /// Name of another.
        second: String,
        /// In what they differ.
        difference: String,
    },
    /// Some blocks are in both.
    #[error("{first} and {second} have samples in common: {a}, and {b}")]
    Overlap {
        /// Name of one.
        first: String,
        /// Name of another.
        second: String,
        /// Its part.
        a: Part,
        /// The other's.
        b: Part,
    },
}

/// In which order films are to be merged, and what the whole is then of.
#[derive(Debug, Clone, PartialEq)]
pub struct Merged {
    /// Positions in the list of states, by their parts: the order of the list makes no difference.
    pub order: Vec<usize>,
    head: Head,
    /// Whether one run would make the same: then it has the same scene.
    one_run: bool,
}

impl Merged {
    /// Plans the merging of states, of which `heads` are the names and heads. At least one must be given.
    ///
    /// # Errors
    /// [`MergeError`] for the first two that are of different pictures, tables or programs, or have blocks in common.
    pub fn new(heads: &[(String, Head)]) -> Result<Option<Self>, MergeError> {
        let mut order: Vec<usize> = (0..heads.len()).collect();
        order.sort_by(|a, b| heads[*a].1.parts.cmp(&heads[*b].1.parts));
        let Some((name, head)) = order.first().map(|&first| &heads[first]) else { return Ok(None) };
        let mut merged = head.clone();
        merged.parts.clear();
        let mut one_run = true;
        for (other_name, other) in order.iter().map(|&index| &heads[index]) {
            if let Some(difference) = head.difference(other) {
                return Err(MergeError::Different { first: name.clone(), second: other_name.clone(), difference });
            }
            merged.parts.extend(&other.parts);
            one_run &= other.scene == head.scene;
        }
        merged.parts.sort();
        if let Some((a, b)) = overlap(&merged.parts) {
            let has = |part: Part| move |i: &usize| heads[*i].1.parts.contains(&part);
            let first = order.iter().position(|i| has(a)(i)).unwrap_or(0);
            // Equal parts are in two states.
            let second = order.iter().enumerate().position(|(at, i)| at != first && has(b)(i)).unwrap_or(0);
            let name = |at: usize| heads[order[at]].0.clone();
            return Err(MergeError::Overlap { first: name(first), second: name(second), a, b });
        }
        Ok(Some(Self { order, head: merged, one_run }))
    }

    /// What the merged film is of. The scene is that of the runs if they are shards of one; else it says how many
    /// samples there are, and the parts say whose.
    #[must_use]
    pub fn head(self, film: &Film) -> Head {
        let Self { mut head, one_run, .. } = self;
        if !one_run {
            let block = head.scene.block();
            let samples = film.most_blocks().saturating_mul(block).clamp(1, MAX_SPP);
            (head.scene.block, head.scene.spp, head.scene.error) = (Some(block), Some(samples), None);
        }
        head
    }
}

impl Head {
    /// What keeps samples of this and those of another from being of one picture, if anything.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<String> {
        if self.program != other.program {
            return Some(format!("one was made by {}, the other by {}", self.program, other.program));
        }
        if let Some(difference) = self.scene.difference(&other.scene) {
            return Some(difference);
        }
        let lines = |head: &Self| head.tables.lines().map(str::to_owned).collect::<Vec<_>>();
        let (ours, theirs) = (lines(self), lines(other));
        let differs =
            ours.iter().find(|line| !theirs.contains(line)).or(theirs.iter().find(|line| !ours.contains(line)));
        differs.map(|line| format!("only one was made with the table {line}"))
    }
}
