//! The instruction sets for which the solver of many spheres is compiled, and their choice at run time.

use pulp::{Simd, WithSimd};

/// An instruction set.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instructions {
    /// What every processor of this architecture has: one sphere at a time, several in turn.
    Plain,
    /// AVX2 and FMA: vectors of four.
    Avx2,
    /// AVX-512: vectors of eight.
    Avx512,
}

impl Instructions {
    /// Those of this processor, the plainest first.
    #[must_use]
    pub fn available() -> Vec<Self> {
        let all = [Self::Plain, Self::Avx2, Self::Avx512];
        all.into_iter().filter(|set| set.is_available()).collect()
    }

    /// The widest of this processor.
    #[must_use]
    pub fn best() -> Self {
        Self::available().last().copied().unwrap_or(Self::Plain)
    }

    /// Its name in flags.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Plain => "plain",
            Self::Avx2 => "avx2",
            Self::Avx512 => "avx512",
        }
    }

    /// The set of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        [Self::Plain, Self::Avx2, Self::Avx512].into_iter().find(|set| set.name() == name)
    }

    #[cfg(target_arch = "x86_64")]
    fn is_available(self) -> bool {
        match self {
            Self::Plain => true,
            Self::Avx2 => pulp::x86::V3::is_available(),
            Self::Avx512 => pulp::x86::V4::is_available(),
        }
    }

    #[cfg(not(target_arch = "x86_64"))]
    fn is_available(self) -> bool {
        self == Self::Plain
    }
}

impl std::fmt::Display for Instructions {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.name())
    }
}

/// Runs `job` with the instruction set asked for, or the plain one where this processor does not have it.
pub(super) fn run<J: WithSimd>(set: Instructions, job: J) -> J::Output {
    #[cfg(target_arch = "x86_64")]
    match set {
        Instructions::Avx2 => {
            if let Some(simd) = pulp::x86::V3::try_new() {
                return Simd::vectorize(simd, job);
            }
        }
        Instructions::Avx512 => {
            if let Some(simd) = pulp::x86::V4::try_new() {
                return Simd::vectorize(simd, job);
            }
        }
        Instructions::Plain => {}
    }
    Simd::vectorize(pulp::Scalar, job)
}
