//! Wavelengths: which are simulated, how they are carried, and what colour they make.

mod colour;
mod scheme;
mod wavelengths;

pub use colour::{Colour, linear_srgb, luminance, xyz};
pub use scheme::Scheme;
pub use wavelengths::{MAX_WAVELENGTHS, Packet, SpectrumError, Wavelengths};
