//! What can be wrong with a table, each with what was expected and what was found.

use std::path::PathBuf;

/// A table that cannot be read, written, or used as what it was taken for.
#[derive(Debug, thiserror::Error)]
pub enum TableError {
    /// The operating system refused to read the file.
    #[error("{}: cannot be read: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The operating system refused to write the file; nothing is left under its name.
    #[error("{}: cannot be written: {source}", path.display())]
    Write {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: std::io::Error,
    },
    /// The first eight bytes are not those of a table.
    #[error("not an Airlight table: the file does not begin with the table signature")]
    Foreign,
    /// The file was passed through a text conversion that changed line ends.
    #[error("the table signature was altered by a text-mode transfer: copy the file in binary mode")]
    TextMode,
    /// A version that this program does not know.
    #[error("table format version {found} is newer than {supported}, the newest this program reads: update Airlight")]
    Newer {
        /// Version in the file.
        found: u32,
        /// Newest version known here.
        supported: u32,
    },
    /// Fewer bytes than the lengths in the file promise.
    #[error("truncated: {expected} bytes expected, {found} found")]
    Truncated {
        /// Bytes promised.
        expected: u64,
        /// Bytes there.
        found: u64,
    },
    /// More bytes than the lengths in the file promise.
    #[error("{extra} bytes after the end of the table")]
    Trailing {
        /// Surplus bytes.
        extra: u64,
    },
    /// A checksum that does not match: the file is damaged.
    #[error("damaged: the {part} has CRC-32 {found:08x}, {expected:08x} was stored")]
    Damaged {
        /// "header" or "payload".
        part: &'static str,
        /// Stored checksum.
        expected: u32,
        /// Checksum of the bytes read.
        found: u32,
    },
    /// A header that is not what the format says.
    #[error("malformed header: {0}")]
    Header(String),
    /// A header and a payload, or two parts of the header, that contradict each other.
    #[error("inconsistent table: {0}")]
    Inconsistent(String),
    /// A table of one kind where another was needed.
    #[error("table of kind {found} where {expected} is needed")]
    WrongKind {
        /// Kind needed.
        expected: String,
        /// Kind found.
        found: String,
    },
    /// An axis or field that the kind must have and the table lacks.
    #[error("no {what} named {name:?} in the table of kind {kind}")]
    Missing {
        /// "axis" or "field".
        what: &'static str,
        /// Its name.
        name: String,
        /// Kind of the table.
        kind: String,
    },
    /// A unit other than the one that the kind prescribes.
    #[error("{name:?} is in {found:?}, {expected:?} is needed")]
    WrongUnit {
        /// Axis or field.
        name: String,
        /// Unit needed.
        expected: String,
        /// Unit found.
        found: String,
    },
    /// A look-up outside an axis whose rule outside is to refuse.
    #[error("{axis} {value} is outside the table's range {low} to {high} {unit}")]
    OutOfRange {
        /// Name of the axis.
        axis: String,
        /// Coordinate asked for.
        value: f64,
        /// First node.
        low: f64,
        /// Last node.
        high: f64,
        /// Unit of the axis.
        unit: String,
    },
    /// An error in a named file.
    #[error("{}: {source}", path.display())]
    In {
        /// The file.
        path: PathBuf,
        /// What is wrong with it.
        source: Box<TableError>,
    },
}

impl TableError {
    /// Names the file that the error is about.
    #[must_use]
    pub fn at(self, path: &std::path::Path) -> Self {
        match self {
            named @ (Self::Read { .. } | Self::Write { .. } | Self::In { .. }) => named,
            other => Self::In { path: path.to_path_buf(), source: Box::new(other) },
        }
    }
}
