//! What fills the air: coefficients at an altitude, their bounds in shells, and
//! the transmittance along a ray. No random number is drawn here.
//!
//! A coefficient is a number density times a cross-section, C(z) sigma(lambda),
//! and a [`Medium`] is a sum of such [`Component`]s: molecules, ozone (three, since its
//! cross-section is a polynomial in temperature), the species of an aerosol.

mod air;
mod columns;
mod haze;
mod medium;

pub use air::{Air, AirError, AirSettings, Depolarisation, Depths, OzoneSource};
pub use columns::{Chord, Columns, Point, Tolerance};
pub use haze::{Amount, Haze, HazePhase, HazeSettings, KOSCHMIEDER};
pub(crate) use medium::GAUSS_4;
pub use medium::{Component, Local, MAX_COMPONENTS, Medium, MediumError, Shell};
