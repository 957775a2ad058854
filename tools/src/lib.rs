//! Airlight's data tool: from measured inputs in `raw-data/` to the tables in `data/`.
//!
//! [`raw`] reads the sources and converts them to SI; [`molecular`] and [`profile`] compute;
//! [`build`] writes the tables; [`data`] reads them again, [`column`] says what they mean over one place, [`inspect`]
//! puts one into words; `study` compares and `plot` draws what the tables hold, each behind a feature of its name.

pub mod aerosol;
pub mod build;
pub mod column;
pub mod data;
#[cfg(feature = "study")]
pub mod frame;
pub mod inspect;
pub mod mie;
pub mod mie_cases;
pub mod molecular;
#[cfg(feature = "plot")]
pub mod plot;
pub mod profile;
pub mod raw;
#[cfg(feature = "study")]
pub mod study;
