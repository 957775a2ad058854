//! The list of simulated wavelengths.

use serde::de::{Error, IgnoredAny, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};
use std::ops::Range;
use std::str::FromStr;
use tables::excerpt;
use tables::units::WAVELENGTH_RANGE_NM;

/// The most wavelengths in one list.
pub const MAX_WAVELENGTHS: usize = 1000;

/// First and last of equally spaced wavelengths in nm: where the eye sees.
const VISIBLE_NM: (f64, f64) = (380.0, 780.0);

/// The least step from one to the next, so that names to a picometre differ.
const MIN_STEP_NM: f64 = 0.002;

/// Increasing wavelengths in nm, 1 to [`MAX_WAVELENGTHS`] of them, within
/// [`WAVELENGTH_RANGE_NM`], at least 0.002 nm apart.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Wavelengths(Vec<f64>);

/// A list of wavelengths that cannot be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum SpectrumError {
    /// Too few or too many.
    #[error("{0} wavelengths; 1 to {MAX_WAVELENGTHS} are possible")]
    Count(usize),
    /// One outside the range of the data.
    #[error("wavelength {nm} nm; {low} to {high} nm are possible", low = WAVELENGTH_RANGE_NM.0, high = WAVELENGTH_RANGE_NM.1)]
    OutOfRange {
        /// It, in nm.
        nm: f64,
    },
    /// One not above the one before.
    #[error("wavelengths must increase by {MIN_STEP_NM} nm or more: {1} nm follows {0} nm")]
    NotIncreasing(f64, f64),
    /// Text that is neither a count nor a list.
    #[error("{0:?} is neither a number of wavelengths (16) nor a list in nm (450,550,650)")]
    Unreadable(String),
}

/// Consecutive wavelengths that one path carries together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Packet {
    /// Indices into the list.
    pub range: Range<usize>,
    /// Lanes of the packet, 1, 8 or 16; those beyond the range repeat it.
    pub lanes: usize,
}

impl Packet {
    /// Index into the list of a lane's wavelength.
    #[must_use]
    pub fn index(&self, lane: usize) -> usize {
        self.range.start + lane % self.range.len()
    }
}

impl Wavelengths {
    /// The list, checked.
    ///
    /// # Errors
    /// [`SpectrumError`] for a list that is empty, too long, not increasing, or
    /// outside [`WAVELENGTH_RANGE_NM`].
    pub fn new(nm: Vec<f64>) -> Result<Self, SpectrumError> {
        if nm.is_empty() || nm.len() > MAX_WAVELENGTHS {
            return Err(SpectrumError::Count(nm.len()));
        }
        let (low, high) = WAVELENGTH_RANGE_NM;
        if let Some(&bad) = nm.iter().find(|w| !(low..=high).contains(*w)) {
            return Err(SpectrumError::OutOfRange { nm: bad });
        }
        if let Some(pair) = nm.windows(2).find(|pair| pair[1] - pair[0] < MIN_STEP_NM) {
            return Err(SpectrumError::NotIncreasing(pair[0], pair[1]));
        }
        Ok(Self(nm))
    }

    /// `count` equally spaced wavelengths from 380 to 780 nm; one alone is 580 nm.
    ///
    /// # Errors
    /// [`SpectrumError::Count`] for none or more than [`MAX_WAVELENGTHS`].
    pub fn visible(count: usize) -> Result<Self, SpectrumError> {
        match count {
            1..=MAX_WAVELENGTHS => Self::new(evenly(count)),
            _ => Err(SpectrumError::Count(count)),
        }
    }

    /// The wavelengths in nm.
    #[must_use]
    pub fn nm(&self) -> &[f64] {
        &self.0
    }

    /// Shares the list out to as few packets of at most 16 as possible, as even as
    /// possible, with the least lanes of 1, 8, 16 that hold the largest of them.
    #[must_use]
    pub fn packets(&self) -> Vec<Packet> {
        let n = self.0.len();
        let size = n.div_ceil(n.div_ceil(16));
        let lanes = [1, 8, 16].into_iter().find(|&l| l >= size).unwrap_or(16);
        (0..n).step_by(size).map(|start| Packet { range: start..(start + size).min(n), lanes }).collect()
    }

    /// The wavelengths in nm of a packet, those of its range again and again: paths choose a lane to fly by, and none is to be chosen much more
    /// often than another.
    #[must_use]
    pub fn lanes<const L: usize>(&self, packet: &Packet) -> [f64; L] {
        std::array::from_fn(|lane| self.0[packet.index(lane)])
    }
}

/// 16 wavelengths from 380 to 780 nm.
impl Default for Wavelengths {
    fn default() -> Self {
        Self(evenly(16))
    }
}

/// `count` equally spaced wavelengths from end to end of the visible; the middle for one.
fn evenly(count: usize) -> Vec<f64> {
    let (first, last) = VISIBLE_NM;
    match count {
        1 => vec![0.5 * (first + last)],
        _ => (0..count).map(|i| first + (last - first) * i as f64 / (count - 1) as f64).collect(),
    }
}

/// From a list of numbers, of which no more are kept than may be.
impl<'de> Deserialize<'de> for Wavelengths {
    fn deserialize<D: Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        struct List;
        impl<'de> Visitor<'de> for List {
            type Value = Wavelengths;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a list of wavelengths in nm")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Wavelengths, A::Error> {
                let mut nm = Vec::new();
                while nm.len() < MAX_WAVELENGTHS
                    && let Some(next) = list.next_element()?
                {
                    nm.push(next);
                }
                let mut count = nm.len();
                while list.next_element::<IgnoredAny>()?.is_some() {
                    count += 1;
                }
                if count > nm.len() {
                    return Err(Error::custom(SpectrumError::Count(count)));
                }
                Wavelengths::new(nm).map_err(Error::custom)
            }
        }
        from.deserialize_seq(List)
    }
}

/// `16` is a count (see [`Wavelengths::visible`]); a comma or a decimal point
/// makes it a list in nm: `450,550,650`, `550.0`, `550,`.
impl FromStr for Wavelengths {
    type Err = SpectrumError;

    fn from_str(text: &str) -> Result<Self, SpectrumError> {
        if let Ok(count) = text.trim().parse() {
            return Self::visible(count);
        }
        let list = text.trim().strip_suffix(',').unwrap_or(text);
        let number = |part: &str| part.trim().parse().map_err(|_| SpectrumError::Unreadable(excerpt(text)));
        Self::new(list.split(',').map(number).collect::<Result<_, _>>()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Vec<f64>, SpectrumError> {
        text.parse().map(|w: Wavelengths| w.nm().to_vec())
    }

    #[test]
    fn a_count_or_a_list_is_read() {
        assert_eq!(parse("3"), Ok(vec![380.0, 580.0, 780.0]));
        assert_eq!(parse("1"), Ok(vec![580.0]));
        assert_eq!(parse("450, 550,650.5"), Ok(vec![450.0, 550.0, 650.5]));
        assert_eq!(parse("550,"), parse("550.0"));
        assert_eq!(parse("401").map(|w| (w.len(), w[1], w[400])), Ok((401, 381.0, 780.0)));
    }

    #[test]
    fn what_cannot_be_a_list_is_refused() {
        assert_eq!(parse("0"), Err(SpectrumError::Count(0)));
        assert_eq!(parse("1001"), Err(SpectrumError::Count(1001)));
        assert_eq!(parse("280,550"), Err(SpectrumError::OutOfRange { nm: 280.0 }));
        assert_eq!(parse("550,450"), Err(SpectrumError::NotIncreasing(550.0, 450.0)));
        assert!(matches!(parse("400,NaN"), Err(SpectrumError::OutOfRange { .. })));
        assert!(matches!(parse("blue"), Err(SpectrumError::Unreadable(_))));
        assert!(matches!(parse(""), Err(SpectrumError::Unreadable(_))));
    }

    #[test]
    fn packets_cover_the_list_once_with_the_fewest_lanes() {
        for (count, packets, lanes) in
            [(1, 1, 1), (2, 1, 8), (5, 1, 8), (9, 1, 16), (16, 1, 16), (17, 2, 16), (40, 3, 16), (401, 26, 16)]
        {
            let wavelengths = Wavelengths::visible(count).expect("valid");
            let got = wavelengths.packets();
            assert_eq!((got.len(), got[0].lanes), (packets, lanes), "{count} wavelengths");
            let covered: Vec<usize> = got.iter().flat_map(|p| p.range.clone()).collect();
            assert_eq!(covered, (0..count).collect::<Vec<_>>());
        }
        let five = Wavelengths::visible(5).expect("valid");
        let lanes: [f64; 8] = five.lanes(&five.packets()[0]);
        assert_eq!(lanes, [380.0, 480.0, 580.0, 680.0, 780.0, 380.0, 480.0, 580.0]);
    }
}
