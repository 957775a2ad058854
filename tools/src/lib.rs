//! Airlight's data tool: from measured inputs in `raw-data/` to the tables in `data/`.
//!
//! [`raw`] reads the sources and converts them to SI; [`molecular`] and [`profile`] compute;
//! [`build`] writes the tables; [`own`] makes some of people's own files; [`inspect`] puts one into words; `plot` draws what the tables hold
//! and `study` compares, each behind a feature of its name.

pub mod aerosol;
pub mod build;
#[cfg(any(feature = "plot", feature = "study"))]
pub mod frame;
pub mod inspect;
pub mod mie;
pub mod mie_cases;
pub mod molecular;
pub mod own;
#[cfg(feature = "plot")]
pub mod plot;
pub mod profile;
pub mod raw;
#[cfg(feature = "study")]
pub mod study;
