//! A run that can go on: the film with all its digits, and what it is a film of. Little-endian:
//!
//! | offset | bytes | what |
//! |---|---|---|
//! | 0 | 8 | signature `89 41 49 52 53 0D 0A 1A` (`\x89AIRS\r\n\x1a`) |
//! | 8 | 4 | format version, u32, now 1 |
//! | 12 | 4 | CRC-32 (IEEE 802.3) of all that follows, u32 |
//! | 16 | 4 | H, length of the head, u32 |
//! | 20 | H | head: JSON in UTF-8, the fields of [`Head`] |
//! | 20 + H | | [`Film::write`] |

use super::{Part, Sky, receipt};
use crate::film::Film;
use crate::film::RawError;
use crate::scene::{Scene, SceneError};
use serde::{Deserialize, Serialize};
use tables::excerpt;

/// The first eight bytes of the file.
const SIGNATURE: [u8; 8] = [0x89, b'A', b'I', b'R', b'S', b'\r', b'\n', 0x1a];

/// The version written, and the only one read.
const VERSION: u32 = 1;

/// Bytes before the head.
const PREAMBLE: usize = 20;

/// The most bytes of a head.
const MAX_HEAD: usize = 1 << 20;

/// What a film is of.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Head {
    /// The program, as in the picture's attribute `airlight.version`.
    pub program: String,
    /// The scene, own tables by names that tell of no folder.
    pub scene: Scene,
    /// The tables that were used, as in [`receipt::TABLES`].
    pub tables: String,
    /// Whose blocks the film holds, in increasing order; no two overlap.
    pub parts: Vec<Part>,
}

/// A film and what it is of.
#[derive(Debug, Clone, PartialEq)]
pub struct State {
    /// What it is of.
    pub head: Head,
    /// The film.
    pub film: Film,
}

/// Why bytes are no state.
#[derive(Debug, thiserror::Error)]
pub enum StateError {
    /// They begin with something else.
    #[error("not the state of a run: it does not begin with the signature")]
    Foreign,
    /// A format of another program.
    #[error("state of format version {found}; this program reads {VERSION}")]
    Version {
        /// The version.
        found: u32,
    },
    /// Fewer bytes than a state has.
    #[error("truncated: {found} bytes are no whole state")]
    Truncated {
        /// Bytes there are.
        found: usize,
    },
    /// The checksum does not match.
    #[error("damaged: the CRC-32 is {found:08x}, {expected:08x} was stored")]
    Damaged {
        /// Stored.
        expected: u32,
        /// Of the bytes read.
        found: u32,
    },
    /// A head that is none.
    #[error("malformed head: {0}")]
    Head(String),
    /// A scene that cannot be.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// A film that cannot be.
    #[error(transparent)]
    Film(#[from] RawError),
}

impl Head {
    /// The head of a film that is made of a scene.
    #[must_use]
    pub fn new(scene: &Scene, sky: &Sky, parts: Vec<Part>) -> Self {
        Self { program: receipt::program(), scene: scene.portable(), tables: receipt::tables(sky), parts }
    }

    /// The bytes of a state with this head. Equal states give equal bytes.
    #[must_use]
    pub fn encode(&self, film: &Film) -> Vec<u8> {
        // Words, and numbers that a valid scene has.
        let head = serde_json::to_vec(self).unwrap_or_default();
        let mut bytes = Vec::new();
        bytes.extend_from_slice(&SIGNATURE);
        bytes.extend_from_slice(&VERSION.to_le_bytes());
        bytes.extend_from_slice(&[0; 4]);
        bytes.extend_from_slice(&(head.len() as u32).to_le_bytes());
        bytes.extend_from_slice(&head);
        film.write(&mut bytes);
        let checksum = crc32fast::hash(&bytes[16..]);
        bytes[12..16].copy_from_slice(&checksum.to_le_bytes());
        bytes
    }

    fn validate(&self) -> Result<(), StateError> {
        self.scene.validate()?;
        if self.parts.is_empty() || !self.parts.is_sorted() {
            return Err(StateError::Head("its parts are none, or not in order".into()));
        }
        match overlap(&self.parts) {
            Some((a, b)) => Err(StateError::Head(format!("{a} and {b} have blocks in common"))),
            None => Ok(()),
        }
    }
}

impl State {
    /// The state that `bytes` are. Memory is bounded by their length, whatever they claim.
    ///
    /// # Errors
    /// [`StateError`] of the first thing that is wrong.
    pub fn decode(bytes: &[u8]) -> Result<Self, StateError> {
        if !bytes.starts_with(&SIGNATURE) {
            return Err(StateError::Foreign);
        }
        let truncated = || StateError::Truncated { found: bytes.len() };
        let (preamble, rest) = bytes.split_at_checked(PREAMBLE).ok_or_else(truncated)?;
        let u32_at =
            |at: usize| u32::from_le_bytes([preamble[at], preamble[at + 1], preamble[at + 2], preamble[at + 3]]);
        if u32_at(8) != VERSION {
            return Err(StateError::Version { found: u32_at(8) });
        }
        let (expected, found) = (u32_at(12), crc32fast::hash(&bytes[16..]));
        if expected != found {
            return Err(StateError::Damaged { expected, found });
        }
        let length = u32_at(16) as usize;
        if length > MAX_HEAD {
            return Err(StateError::Head(format!("{length} bytes long, {MAX_HEAD} are possible")));
        }
        let (head, film) = rest.split_at_checked(length).ok_or_else(truncated)?;
        let head: Head = serde_json::from_slice(head).map_err(|e| StateError::Head(excerpt(&e.to_string())))?;
        head.validate()?;
        let (width, height) = head.scene.size();
        let film = Film::read(width, height, head.scene.channels(), head.scene.polarisation, film)?;
        Ok(Self { head, film })
    }
}

/// The first two parts that have blocks in common.
pub(super) fn overlap(parts: &[Part]) -> Option<(Part, Part)> {
    // In order of seeds, so that only those of one seed are compared.
    let mut parts = parts.to_vec();
    parts.sort();
    parts.chunk_by(|a, b| a.seed == b.seed).find_map(|same| {
        same.iter()
            .enumerate()
            .find_map(|(i, a)| same[i + 1..].iter().find(|b| a.shard.overlaps(b.shard)).map(|b| (*a, *b)))
    })
}
