//! Inputs that are nearly right.

use renderer::sampling::Sampler;

/// What the bytes of a target are, which decides how they are changed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// A table: mostly with lengths and checksums made right again, so that the change gets past them.
    Table,
    /// Text with numbers: CSV, JSON.
    Text,
    /// Any bytes.
    Binary,
}

/// The most bytes of an input.
const MAX_LENGTH: usize = 1 << 20;

/// Numbers that readers fall over.
const NUMBERS: [&str; 26] = [
    "",
    "0",
    "-0",
    "-0.0",
    "-1",
    "1",
    "1e308",
    "-1e308",
    "1e309",
    "-1e309",
    "1e-320",
    "1e999999999999",
    "NaN",
    "inf",
    "-inf",
    "infinity",
    "0x10",
    "1_0",
    "--1",
    "1e",
    ".",
    "4294967296",
    "18446744073709551615",
    "18446744073709551616",
    "0.1000000000000000055511151231257827021181583404541015625",
    "99999999999999999999999999999999999999999999",
];

/// Pieces of text that readers fall over.
const PIECES: [&str; 24] = [
    ",",
    ",,,",
    "\"",
    "\"\"",
    "\n",
    "\r",
    "\r\n",
    "\0",
    "#",
    "# : \n",
    "# unit x: 1\n",
    "\u{feff}",
    "\u{202e}é𝄞",
    "[",
    "]",
    "{",
    "}",
    "{}",
    "[]",
    "null",
    "true",
    "\"\\ud800\"",
    "\"a\":",
    ":",
];

/// Input `index` of a target (`number` in the list) under `seed`: one of its seeds, changed in one or more places.
#[must_use]
pub fn mutate(form: Form, seeds: &[Vec<u8>], seed: u64, number: u64, index: u64) -> Vec<u8> {
    let mut dice = Dice(Sampler::new(seed, number, index));
    let Some(start) = seeds.get(dice.below(seeds.len())) else { return Vec::new() };
    let other = &seeds[dice.below(seeds.len())];
    let mut bytes = if form == Form::Table && !dice.one_in(8) {
        change_table(start, other, &mut dice)
    } else {
        let mut bytes = start.clone();
        change(&mut bytes, other, form == Form::Text, &mut dice);
        bytes
    };
    bytes.truncate(MAX_LENGTH);
    bytes
}

struct Dice(Sampler);

impl Dice {
    /// A whole number below `n`, 0 for none.
    fn below(&mut self, n: usize) -> usize {
        ((self.0.uniform() * n as f64) as usize).min(n.saturating_sub(1))
    }

    fn one_in(&mut self, n: usize) -> bool {
        self.below(n) == 0
    }

    fn pick<'a>(&mut self, list: &[&'a str]) -> &'a str {
        list[self.below(list.len())]
    }

    /// A length: short ones are likelier, by octaves.
    fn length(&mut self, most: usize) -> usize {
        let octave = self.below(most.max(1).ilog2() as usize + 1);
        (1 + self.below(1 << octave)).min(most)
    }

    /// A part of `length` bytes at most.
    fn span(&mut self, length: usize, most: usize) -> std::ops::Range<usize> {
        let start = self.below(length + 1);
        start..(start + self.length(most)).min(length)
    }
}

/// One to some changes of any kind.
fn change(bytes: &mut Vec<u8>, other: &[u8], text: bool, dice: &mut Dice) {
    loop {
        let kinds = if text { 16 } else { 9 };
        match dice.below(kinds) {
            0 | 1 if !bytes.is_empty() => {
                let at = dice.below(bytes.len());
                bytes[at] ^= 1 << dice.below(8);
            }
            2 if !bytes.is_empty() => {
                let at = dice.below(bytes.len());
                bytes[at] = dice.below(256) as u8;
            }
            3 => bytes.truncate(dice.below(bytes.len() + 1)),
            4 => {
                let span = dice.span(bytes.len(), 4096);
                bytes.drain(span);
            }
            5 => {
                // A part twice or many times over.
                let span = dice.span(bytes.len(), 256);
                let room = if dice.one_in(32) { 1 << 18 } else { 1 << 10 };
                let times = 1 + dice.below(room / span.len().max(1) + 1);
                let copy = bytes[span.clone()].repeat(times);
                bytes.splice(span.end..span.end, copy);
            }
            6 => {
                // The beginning of one, the end of another.
                bytes.truncate(dice.below(bytes.len() + 1));
                bytes.extend_from_slice(&other[dice.below(other.len() + 1)..]);
            }
            7 => {
                let from = dice.span(other.len(), 1024);
                let at = dice.below(bytes.len() + 1);
                bytes.splice(at..at, other[from].iter().copied());
            }
            8 if bytes.len() >= 8 => {
                // A length or an offset, often.
                let at = dice.below(bytes.len() - 7).min(if dice.one_in(2) { 64 } else { usize::MAX });
                let value = [0, 1, u64::MAX, 1 << 31, 1 << 32, i64::MAX as u64, 0x7ff0_0000_0000_0000][dice.below(7)];
                let width = [1, 2, 4, 8][dice.below(4)];
                bytes[at..at + width].copy_from_slice(&value.to_le_bytes()[..width]);
            }
            9..=11 => {
                let at = dice.below(bytes.len() + 1);
                if let Some(number) = number_after(bytes, at) {
                    bytes.splice(number, dice.pick(&NUMBERS).bytes());
                }
            }
            12 => {
                let at = dice.below(bytes.len() + 1);
                bytes.splice(at..at, dice.pick(&PIECES).bytes());
            }
            13 => {
                // A long field, or many empty ones, or deep nesting.
                let at = dice.below(bytes.len() + 1);
                let piece = dice.pick(&["9", "x", ",", "[", "{\"a\":", "0,", "\n", "#:\n", "\"", "é"]);
                let most = if dice.one_in(16) { 1 << 18 } else { 1 << 10 };
                let times = 1 + dice.length(most) / piece.len();
                bytes.splice(at..at, piece.repeat(times).into_bytes());
            }
            14 => {
                // Lines change places.
                let mut lines: Vec<&[u8]> = bytes.split_inclusive(|&b| b == b'\n').collect();
                let (a, b) = (dice.below(lines.len()), dice.below(lines.len()));
                if !lines.is_empty() {
                    lines.swap(a, b);
                    *bytes = lines.concat();
                }
            }
            15 => {
                // A line is gone.
                let mut lines: Vec<&[u8]> = bytes.split_inclusive(|&b| b == b'\n').collect();
                if !lines.is_empty() {
                    lines.remove(dice.below(lines.len()));
                    *bytes = lines.concat();
                }
            }
            _ => {}
        }
        if !dice.one_in(2) || bytes.len() > MAX_LENGTH {
            return;
        }
    }
}

/// Where the next number of a text stands.
fn number_after(bytes: &[u8], at: usize) -> Option<std::ops::Range<usize>> {
    let part = |b: &u8| b.is_ascii_digit() || b"+-.eE".contains(b);
    let start = at + bytes[at..].iter().position(u8::is_ascii_digit)?;
    let end = bytes[start..].iter().position(|b| !part(b)).map_or(bytes.len(), |n| start + n);
    Some(start..end)
}

/// A table with its header or payload changed and lengths and checksums that agree with them.
fn change_table(start: &[u8], other: &[u8], dice: &mut Dice) -> Vec<u8> {
    let (Some((header, payload)), Some((_, strange))) = (split(start), split(other)) else { return start.to_vec() };
    let (mut header, mut payload) = (header.to_vec(), payload.to_vec());
    match dice.below(4) {
        0 | 1 => change(&mut header, other, true, dice),
        2 => loop {
            // A value of either precision.
            let values = [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY, f64::MAX, 5e-324, 1e-3];
            let value = values[dice.below(values.len())];
            let at = 4 * dice.below(payload.len() / 4);
            if dice.one_in(2) {
                payload.splice(at..(at + 4).min(payload.len()), (value as f32).to_le_bytes());
            } else {
                payload.splice(at..(at + 8).min(payload.len()), value.to_le_bytes());
            }
            if dice.one_in(2) {
                break;
            }
        },
        _ => change(&mut payload, strange, false, dice),
    }
    let mut bytes = start[..12].to_vec();
    bytes.extend_from_slice(&(header.len() as u32).to_le_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(&crc32fast::hash(&header).to_le_bytes());
    bytes.extend_from_slice(&crc32fast::hash(&payload).to_le_bytes());
    bytes.extend_from_slice(&header);
    bytes.extend_from_slice(&payload);
    bytes
}

/// Header and payload of a sound table.
fn split(table: &[u8]) -> Option<(&[u8], &[u8])> {
    let length = u32::from_le_bytes(*table.get(12..)?.first_chunk::<4>()?) as usize;
    table.get(32..)?.split_at_checked(length)
}
