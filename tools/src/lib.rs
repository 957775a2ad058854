//! Airlight's data tool: from measured inputs in `raw-data/` to the tables in `data/`.
//!
//! [`raw`] reads the sources and converts them to SI; [`molecular`] and [`profile`] compute;
//! [`build`] writes the tables; [`inspect`] puts one into words.

pub mod build;
pub mod inspect;
pub mod molecular;
pub mod profile;
pub mod raw;
