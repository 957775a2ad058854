//! Airlight's data tool: from measured inputs in `raw-data/` to the tables in `data/`.
//!
//! [`raw`] reads the sources and converts them to SI; [`molecular`] and [`profile`] compute;
//! [`build`] writes the tables, and [`own`] some of people's own files; [`data`] reads them again, [`mod@column`] says
//! what they mean over one place, [`inspect`] puts one into words, [`coefficients`] and [`export`] give out numbers as a
//! [`sheet`] with its [`sources`], [`lint`] judges tables and CSV files; [`report`] puts all that there is to look at into one page; `study` compares and `plot` draws what the
//! tables hold, each behind a feature of its name.

pub mod aerosol;
pub mod atlas;
pub mod build;
pub mod chart;
pub mod coefficients;
pub mod column;
pub mod data;
pub mod export;
#[cfg(feature = "study")]
pub mod frame;
pub mod inspect;
pub mod ladder;
pub mod lint;
pub mod mie;
pub mod mie_cases;
pub mod mie_tasks;
pub mod molecular;
pub mod numbers;
pub mod own;
#[cfg(feature = "plot")]
pub mod plot;
pub mod profile;
pub mod programs;
pub mod raw;
pub mod records;
pub mod report;
pub mod sheet;
pub mod sources;
pub mod stability;
#[cfg(feature = "study")]
pub mod study;
pub mod text;
