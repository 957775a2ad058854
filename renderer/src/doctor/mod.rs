//! Why is a picture black, noisy, blown out or slow? Each finding has its number and a remedy.
//!
//! A scene is looked at before it is rendered, in a few directions by a coarse solved table ([`Looks`]); a picture by its pixels ([`Seen`]).

mod looks;
mod picture;
mod scene;
#[cfg(test)]
mod tests;

pub use looks::Looks;
pub use picture::{Seen, of_picture};
pub use scene::{of_scene, unreadable};

/// What is wrong with a picture, or would be.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Trouble {
    /// It cannot be made.
    Refused,
    /// It is dark or black.
    Black,
    /// It is overexposed.
    BlownOut,
    /// It is noisy, or its noise is not known.
    Noisy,
    /// Its colours are none.
    Colour,
    /// It takes long, or much memory.
    Slow,
    /// It holds what is no number.
    Broken,
}

impl Trouble {
    /// Its word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Refused => "refused",
            Self::Black => "black",
            Self::BlownOut => "blown out",
            Self::Noisy => "noisy",
            Self::Colour => "colour",
            Self::Slow => "slow",
            Self::Broken => "broken",
        }
    }
}

/// One reason, with its number, and what to do about it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// What it leads to.
    pub trouble: Trouble,
    /// What was found: a clause with its number and unit.
    pub what: String,
    /// What helps: a clause with the flags.
    pub remedy: String,
}

impl Finding {
    fn new(trouble: Trouble, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { trouble, what: what.into(), remedy: remedy.into() }
    }
}
