//! What Airlight's data tool writes and its renderer reads.
//!
//! A [`Table`] is a titled set of [`Axis`] and [`Field`] with settings and
//! [`Provenance`]; [`mod@file`] turns it into bytes and back; [`Curve`] interpolates
//! along one axis by the rule which that axis names; [`views`] holds one typed,
//! validated reading per [`Kind`], so that no name of a field or unit is
//! spelled in two places. `docs/table-format.md` describes the bytes.
//!
//! Nothing here knows how a table is computed.

mod axis;
mod curve;
mod error;
mod excerpt;
pub mod file;
mod names;
mod table;
pub mod units;
pub mod views;

pub use axis::{Axis, Interpolation, Outside, Position, Spacing};
pub use curve::Curve;
pub use error::TableError;
pub use excerpt::excerpt;
pub use names::nearest;
pub use table::{Field, Kind, Precision, Provenance, Scale, Table, Tolerance};
