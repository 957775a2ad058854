//! Which of a picture's blocks a run makes.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::str::FromStr;

/// The most shards of a picture.
const MOST: u32 = 1 << 16;

/// Part I of N of a picture: of every pixel the blocks whose number is I - 1 modulo N.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(try_from = "(u32, u32)", into = "(u32, u32)")]
pub struct Shard {
    of: u32,
    /// I - 1.
    offset: u32,
}

/// What a run with one seed has made.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// The seed.
    pub seed: u64,
    /// The shard.
    pub shard: Shard,
}

/// The whole picture.
impl Default for Shard {
    fn default() -> Self {
        Self { of: 1, offset: 0 }
    }
}

impl Shard {
    /// Shard `index`, from 1, of `of`.
    ///
    /// # Errors
    /// A sentence if there is no such shard, or there are more than 65536.
    pub fn new(index: u32, of: u32) -> Result<Self, String> {
        if (1..=MOST).contains(&of) && (1..=of).contains(&index) {
            Ok(Self { of, offset: index - 1 })
        } else {
            Err(format!("shard {index}/{of}: 1/N to N/N is possible, N from 1 to {MOST}"))
        }
    }

    /// Number in the whole picture of this shard's block `count`, both from 0.
    #[must_use]
    pub fn block(self, count: u32) -> u32 {
        count.saturating_mul(self.of).saturating_add(self.offset)
    }

    /// Of how many.
    #[must_use]
    pub fn of(self) -> u32 {
        self.of
    }

    /// How many of the first `blocks` blocks are this shard's.
    #[must_use]
    pub fn share(self, blocks: u32) -> u32 {
        blocks.saturating_sub(self.offset).div_ceil(self.of)
    }

    /// Blocks of the whole picture of which this shard has `count`, all shards alike.
    #[must_use]
    pub fn whole(self, count: u32) -> u32 {
        count.saturating_mul(self.of)
    }

    /// Whether some block belongs to both: the offsets are equal modulo the greatest common divisor.
    #[must_use]
    pub fn overlaps(self, other: Self) -> bool {
        let (mut a, mut b) = (self.of, other.of);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        self.offset % a == other.offset % a
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |part: &str| part.trim().parse().map_err(|_| "say I/N, such as 1/4".to_string());
        let (index, of) = text.split_once('/').ok_or("say I/N, such as 1/4")?;
        Self::new(number(index)?, number(of)?)
    }
}

impl fmt::Display for Shard {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.offset + 1, self.of)
    }
}

impl fmt::Display for Part {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "seed {}, shard {}", self.seed, self.shard)
    }
}

impl TryFrom<(u32, u32)> for Shard {
    type Error = String;

    fn try_from((index, of): (u32, u32)) -> Result<Self, String> {
        Self::new(index, of)
    }
}

impl From<Shard> for (u32, u32) {
    fn from(shard: Shard) -> Self {
        (shard.offset + 1, shard.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shards_share_all_blocks_out_and_no_block_twice() {
        for of in 1..=5 {
            for blocks in 0..=12 {
                let mut seen = vec![0; blocks as usize];
                for index in 1..=of {
                    let shard = Shard::new(index, of).expect("possible");
                    for count in 0..shard.share(blocks) {
                        seen[shard.block(count) as usize] += 1;
                    }
                    assert!(shard.block(shard.share(blocks)) >= blocks, "{shard} ends too early");
                }
                assert!(seen.iter().all(|&n| n == 1), "{seen:?}");
            }
        }
    }

    #[test]
    fn overlap_is_a_block_in_both() {
        let all = || (1..=6).flat_map(|of| (1..=of).map(move |index| Shard::new(index, of).expect("possible")));
        for a in all() {
            for b in all() {
                // Two progressions that meet do so within the product of their steps.
                let meet = (0..36).any(|i| (0..36).any(|j| a.block(i) == b.block(j)));
                assert_eq!(a.overlaps(b), meet, "{a} and {b}");
            }
        }
    }

    #[test]
    fn a_shard_that_is_none_is_refused() {
        assert_eq!("2/3".parse::<Shard>(), Shard::new(2, 3));
        for text in ["0/3", "4/3", "1/0", "1/65537", "1", "a/b", "-1/2", ""] {
            assert!(text.parse::<Shard>().is_err(), "{text}");
        }
    }
}
