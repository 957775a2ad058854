//! Readers under mutated inputs: no panic, no hang, memory at most four times the file and 1 MiB, errors that are
//! sentences. Input i of a target is a pure function of (seed, target, i), so that any failure can be replayed.
//!
//! To add a reader, add a line to [`targets`].

pub mod memory;
mod mutate;
mod run;
mod targets;

pub use mutate::{Form, mutate};
pub use run::{Failure, Figures, Plan, Verdict, input, probe, replay_command, run};
pub use targets::{Target, targets};
