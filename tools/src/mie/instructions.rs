//! The instruction sets for which the solver of many spheres is compiled, and their choice at run time.

use pulp::{NullaryFnOnce, Simd};

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

/// Vectors of doubles, with what the instruction sets do in ways of their own.
pub(super) trait Vectors: Simd {
    /// 1 / x in each lane, to a unit in the last place or two; x is neither 0 nor infinite.
    fn reciprocal(self, x: Self::f64s) -> Self::f64s;

    /// a b - c, rounded once where the instruction set can.
    fn mul_sub(self, a: Self::f64s, b: Self::f64s, c: Self::f64s) -> Self::f64s;

    /// c - a b, rounded once where the instruction set can.
    fn sub_mul(self, c: Self::f64s, a: Self::f64s, b: Self::f64s) -> Self::f64s;
}

impl Vectors for pulp::Scalar {
    #[inline(always)]
    fn reciprocal(self, x: f64) -> f64 {
        1.0 / x
    }

    #[inline(always)]
    fn mul_sub(self, a: f64, b: f64, c: f64) -> f64 {
        a * b - c
    }

    #[inline(always)]
    fn sub_mul(self, c: f64, a: f64, b: f64) -> f64 {
        c - a * b
    }
}

#[cfg(target_arch = "x86_64")]
impl Vectors for pulp::x86::V3 {
    #[inline(always)]
    fn reciprocal(self, x: Self::f64s) -> Self::f64s {
        self.div_f64s(self.splat_f64s(1.0), x)
    }

    #[inline(always)]
    fn mul_sub(self, a: Self::f64s, b: Self::f64s, c: Self::f64s) -> Self::f64s {
        pulp::cast(self.fma._mm256_fmsub_pd(pulp::cast(a), pulp::cast(b), pulp::cast(c)))
    }

    #[inline(always)]
    fn sub_mul(self, c: Self::f64s, a: Self::f64s, b: Self::f64s) -> Self::f64s {
        pulp::cast(self.fma._mm256_fnmadd_pd(pulp::cast(a), pulp::cast(b), pulp::cast(c)))
    }
}

#[cfg(target_arch = "x86_64")]
impl Vectors for pulp::x86::V4 {
    /// A division of eight lanes takes as long as two of four. An estimate y right to 2^-14, improved twice by
    /// Newton's y + y (1 - x y), which doubles the digits, does not wait for the divider.
    #[inline(always)]
    fn reciprocal(self, x: Self::f64s) -> Self::f64s {
        let one = self.splat_f64s(1.0);
        let mut y: Self::f64s = pulp::cast(self.avx512f._mm512_rcp14_pd(pulp::cast(x)));
        for _ in 0..2 {
            y = self.mul_add_e_f64s(y, self.sub_mul(one, x, y), y);
        }
        y
    }

    #[inline(always)]
    fn mul_sub(self, a: Self::f64s, b: Self::f64s, c: Self::f64s) -> Self::f64s {
        pulp::cast(self.avx512f._mm512_fmsub_pd(pulp::cast(a), pulp::cast(b), pulp::cast(c)))
    }

    #[inline(always)]
    fn sub_mul(self, c: Self::f64s, a: Self::f64s, b: Self::f64s) -> Self::f64s {
        pulp::cast(self.avx512f._mm512_fnmadd_pd(pulp::cast(a), pulp::cast(b), pulp::cast(c)))
    }
}

/// Work on vectors, written once for all instruction sets. All it calls is to be inlined.
pub(super) trait Work {
    /// Its result.
    type Output;

    /// Does it.
    fn with<S: Vectors>(self, simd: S) -> Self::Output;
}

/// Work as a function of one instruction set.
struct On<S, W>(S, W);

impl<S: Vectors, W: Work> NullaryFnOnce for On<S, W> {
    type Output = W::Output;

    #[inline(always)]
    fn call(self) -> W::Output {
        self.1.with(self.0)
    }
}

/// Does `work` with the instruction set asked for, or the plain one where this processor does not have it.
pub(super) fn run<W: Work>(set: Instructions, work: W) -> W::Output {
    #[cfg(target_arch = "x86_64")]
    match set {
        Instructions::Avx2 => {
            if let Some(simd) = pulp::x86::V3::try_new() {
                return simd.vectorize(On(simd, work));
            }
        }
        Instructions::Avx512 => {
            if let Some(simd) = pulp::x86::V4::try_new() {
                return simd.vectorize(On(simd, work));
            }
        }
        Instructions::Plain => {}
    }
    work.with(pulp::Scalar)
}
