//! Wavelengths: which are simulated, how they are carried, and what colour they make.

mod between;
mod colour;
mod difference;
mod scheme;
mod temperature;
mod wavelengths;

pub use between::Between;
pub use colour::{Colour, linear_srgb, luminance, xyz};
pub use difference::{ciede2000, lab};
pub use scheme::Scheme;
pub use temperature::{ColourTemperature, Locus};
pub use wavelengths::{MAX_WAVELENGTHS, Packet, SpectrumError, Wavelengths};
