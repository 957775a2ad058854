//! Tables as bytes. Little-endian throughout:
//!
//! | offset | bytes | what |
//! |---|---|---|
//! | 0 | 8 | signature `89 41 49 52 4C 0D 0A 1A` (`\x89AIRL\r\n\x1a`) |
//! | 8 | 4 | format version, u32, now 1 |
//! | 12 | 4 | H, length of the header, u32, a multiple of 8 |
//! | 16 | 8 | P, length of the payload, u64 |
//! | 24 | 4 | CRC-32 (IEEE 802.3) of the header, u32 |
//! | 28 | 4 | CRC-32 of the payload, u32 |
//! | 32 | H | header: JSON in UTF-8, padded with spaces |
//! | 32 + H | P | payload: nodes of each axis (f64), then values of each field, in the header's order, each padded with zeros to a multiple of 8 |
//!
//! and nothing after it. `docs/table-format.md` has the header's keys.

use crate::{
    Axis, Field, Interpolation, Kind, Outside, Precision, Provenance, Scale, Spacing, Table, TableError, Tolerance,
    excerpt,
};
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;

mod replace;

pub use replace::{check_writable, is_temporary, replace};

/// The first eight bytes: not ASCII, with both kinds of line end and the end-of-file
/// character of old systems, so that any text conversion shows.
pub const SIGNATURE: [u8; 8] = [0x89, b'A', b'I', b'R', b'L', b'\r', b'\n', 0x1a];

/// The version written, and the newest read.
pub const VERSION: u32 = 1;

/// The most bytes of a header: five times what the largest table of `data/` needs. What a header becomes in
/// memory is up to 16 times its text; so it stays below 1 MiB.
pub const MAX_HEADER: usize = 1 << 16;

const PREAMBLE: usize = 32;

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Header {
    kind: Kind,
    title: String,
    axes: Vec<AxisHeader>,
    fields: Vec<FieldHeader>,
    settings: BTreeMap<String, String>,
    provenance: Vec<Provenance>,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct AxisHeader {
    name: String,
    unit: String,
    length: usize,
    spacing: Spacing,
    interpolation: Interpolation,
    outside: Outside,
    offset: usize,
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct FieldHeader {
    name: String,
    unit: String,
    axes: Vec<String>,
    precision: Precision,
    scale: Scale,
    tolerance: Tolerance,
    interpolation_error: Option<f64>,
    offset: usize,
}

/// The bytes of a table. The same table gives the same bytes.
///
/// # Errors
/// [`TableError::Inconsistent`] if the table does not validate, [`TableError::Header`] if its header would be longer
/// than [`MAX_HEADER`].
pub fn encode(table: &Table) -> Result<Vec<u8>, TableError> {
    table.validate()?;
    let mut payload = Vec::new();
    let mut append = |values: &[f64], precision: Precision| {
        let offset = payload.len();
        for &value in values {
            match precision {
                Precision::F32 => payload.extend_from_slice(&(value as f32).to_le_bytes()),
                Precision::F64 => payload.extend_from_slice(&value.to_le_bytes()),
            }
        }
        payload.resize(payload.len().next_multiple_of(8), 0);
        offset
    };
    let axes = table
        .axes
        .iter()
        .map(|axis| AxisHeader {
            name: axis.name.clone(),
            unit: axis.unit.clone(),
            length: axis.nodes.len(),
            spacing: axis.spacing,
            interpolation: axis.interpolation,
            outside: axis.outside,
            offset: append(&axis.nodes, Precision::F64),
        })
        .collect();
    let fields = table
        .fields
        .iter()
        .map(|field| FieldHeader {
            name: field.name.clone(),
            unit: field.unit.clone(),
            axes: field.axes.clone(),
            precision: field.precision,
            scale: field.scale,
            tolerance: field.tolerance,
            interpolation_error: field.interpolation_error,
            offset: append(&field.values, field.precision),
        })
        .collect();
    let header = Header {
        kind: table.kind,
        title: table.title.clone(),
        axes,
        fields,
        settings: table.settings.clone(),
        provenance: table.provenance.clone(),
    };
    let mut header = serde_json::to_vec(&header).map_err(|e| TableError::Header(e.to_string()))?;
    header.resize(header.len().next_multiple_of(8), b' ');
    if header.len() > MAX_HEADER {
        return Err(too_long(header.len() as u64));
    }
    let header_length = header.len() as u32;

    let mut bytes = Vec::with_capacity(PREAMBLE + header.len() + payload.len());
    bytes.extend_from_slice(&SIGNATURE);
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    bytes.extend_from_slice(&header_length.to_le_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&crc32fast::hash(&header).to_le_bytes());
    bytes.extend_from_slice(&crc32fast::hash(&payload).to_le_bytes());
    bytes.extend_from_slice(&header);
    bytes.extend_from_slice(&payload);
    Ok(bytes)
}

/// The table that `bytes` hold. Checked in this order: signature, version,
/// lengths, checksums, header, sizes, nodes and values. Allocation is bounded by the
/// length of `bytes`, whatever they claim.
///
/// # Errors
/// The [`TableError`] of the first check that fails.
pub fn decode(bytes: &[u8]) -> Result<Table, TableError> {
    let (header, payload) = split(bytes)?;
    let header: Header = serde_json::from_slice(header).map_err(|e| TableError::Header(excerpt(&e.to_string())))?;
    // Axes and fields do not overlap, so together they are no longer than the payload.
    let mut budget = payload.len();
    let mut spend = |name: &str, length: usize, precision: Precision| {
        budget = budget
            .checked_sub(length.saturating_mul(precision.bytes()))
            .ok_or_else(|| TableError::Inconsistent(format!("{:?} does not fit in the payload", excerpt(name))))?;
        Ok::<(), TableError>(())
    };
    let mut axes = Vec::with_capacity(header.axes.len());
    for axis in header.axes {
        spend(&axis.name, axis.length, Precision::F64)?;
        let nodes = numbers(payload, axis.offset, axis.length, Precision::F64, &axis.name)?;
        axes.push(Axis {
            name: axis.name,
            unit: axis.unit,
            spacing: axis.spacing,
            interpolation: axis.interpolation,
            outside: axis.outside,
            nodes,
        });
    }
    let mut table = Table {
        kind: header.kind,
        title: header.title,
        axes,
        fields: Vec::with_capacity(header.fields.len()),
        settings: header.settings,
        provenance: header.provenance,
    };
    for field in header.fields {
        let mut length = 1_usize;
        for name in &field.axes {
            length = length.saturating_mul(table.axis(name)?.nodes.len());
        }
        spend(&field.name, length, field.precision)?;
        let values = numbers(payload, field.offset, length, field.precision, &field.name)?;
        table.fields.push(Field {
            name: field.name,
            unit: field.unit,
            axes: field.axes,
            precision: field.precision,
            scale: field.scale,
            tolerance: field.tolerance,
            interpolation_error: field.interpolation_error,
            values,
        });
    }
    table.validate()?;
    Ok(table)
}

/// Header and payload of `bytes`, lengths and checksums verified.
fn split(bytes: &[u8]) -> Result<(&[u8], &[u8]), TableError> {
    let found = bytes.len() as u64;
    let truncated = |expected: u64| TableError::Truncated { expected, found };
    if bytes.len() < SIGNATURE.len() || bytes[..8] != SIGNATURE {
        if !bytes.is_empty() && SIGNATURE.starts_with(bytes) {
            return Err(truncated(PREAMBLE as u64));
        }
        let altered = bytes.starts_with(b"\x89AIRL\n\x1a") || bytes.starts_with(b"\x89AIRL\r\r\n");
        return Err(if altered { TableError::TextMode } else { TableError::Foreign });
    }
    if bytes.len() < PREAMBLE {
        return Err(truncated(PREAMBLE as u64));
    }
    let u32_at = |at: usize| u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
    let version = u32_at(8);
    if version > VERSION {
        return Err(TableError::Newer { found: version, supported: VERSION });
    }
    if version == 0 {
        return Err(TableError::Header("format version 0 does not exist".into()));
    }
    let header_length = u64::from(u32_at(12));
    let payload_length = u64::from(u32_at(16)) | (u64::from(u32_at(20)) << 32);
    let expected = (PREAMBLE as u64).saturating_add(header_length).saturating_add(payload_length);
    if found < expected {
        return Err(truncated(expected));
    }
    if found > expected {
        return Err(TableError::Trailing { extra: found - expected });
    }
    if header_length > MAX_HEADER as u64 {
        return Err(too_long(header_length));
    }
    // Both lengths are now at most the length of `bytes`.
    let (header, payload) = bytes[PREAMBLE..].split_at(header_length as usize);
    for (part, content, at) in [("header", header, 24), ("payload", payload, 28)] {
        let (expected, found) = (u32_at(at), crc32fast::hash(content));
        if expected != found {
            return Err(TableError::Damaged { part, expected, found });
        }
    }
    Ok((header, payload))
}

fn too_long(length: u64) -> TableError {
    TableError::Header(format!("{length} bytes long, {MAX_HEADER} are possible"))
}

/// `length` numbers of the payload from `offset`.
fn numbers(
    payload: &[u8],
    offset: usize,
    length: usize,
    precision: Precision,
    name: &str,
) -> Result<Vec<f64>, TableError> {
    let bytes = length
        .checked_mul(precision.bytes())
        .and_then(|size| offset.checked_add(size))
        .and_then(|end| payload.get(offset..end))
        .ok_or_else(|| TableError::Inconsistent(format!("{:?} lies outside the payload", excerpt(name))))?;
    Ok(match precision {
        Precision::F32 => bytes.as_chunks::<4>().0.iter().map(|b| f64::from(f32::from_le_bytes(*b))).collect(),
        Precision::F64 => bytes.as_chunks::<8>().0.iter().map(|b| f64::from_le_bytes(*b)).collect(),
    })
}

/// CRC-32 of a table file's header and payload checksums together: a short
/// identity of the file that pictures carry. `None` for bytes too short to have one.
#[must_use]
pub fn checksum(bytes: &[u8]) -> Option<u32> {
    bytes.get(24..32).map(crc32fast::hash)
}

/// Reads the table in a file.
///
/// # Errors
/// Any [`TableError`], with the path.
pub fn read(path: &Path) -> Result<Table, TableError> {
    let bytes = std::fs::read(path).map_err(|source| TableError::Read { path: path.into(), source })?;
    decode(&bytes).map_err(|e| e.at(path))
}

/// Writes a table by [`replace`], so that the final name never holds half a file. Gives the size in bytes.
///
/// # Errors
/// [`TableError::Write`], with the temporary file removed, or [`TableError::Inconsistent`].
pub fn write(path: &Path, table: &Table) -> Result<u64, TableError> {
    let bytes = encode(table).map_err(|e| e.at(path))?;
    replace(path, &bytes).map_err(|source| TableError::Write { path: path.into(), source })?;
    Ok(bytes.len() as u64)
}
