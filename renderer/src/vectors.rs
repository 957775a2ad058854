//! Arithmetic on arrays in forms that compilers turn into vector instructions.

use pulp::NullaryFnOnce;
use std::ops::{AddAssign, Mul};
use std::sync::atomic::{AtomicU8, Ordering};

/// Which vectors are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Vectors {
    /// Those that every processor of the kind has.
    Plain,
    /// 256 bits (AVX2).
    Avx2,
    /// The widest of this processor.
    Widest,
}

static WIDEST: AtomicU8 = AtomicU8::new(Vectors::Widest as u8);

/// Takes no wider vectors from now on: for measurements. Results are the same.
pub(crate) fn take_at_most(vectors: Vectors) {
    WIDEST.store(vectors as u8, Ordering::Relaxed);
}

/// Does `work` on `L` wavelengths with the widest vectors of this processor; all that it calls is to be inlined. Nothing is fused or
/// reordered, so that the results do not depend on the width. One wavelength has nothing to fill vectors with.
pub(crate) fn vectorised<const L: usize, W: NullaryFnOnce>(work: W) -> W::Output {
    if const { L == 1 } {
        return work.call();
    }
    let widest = WIDEST.load(Ordering::Relaxed);
    if widest == Vectors::Plain as u8 {
        return work.call();
    }
    #[cfg(target_arch = "x86_64")]
    if widest == Vectors::Avx2 as u8
        && let Some(processor) = pulp::x86::V3::try_new()
    {
        return pulp::Simd::vectorize(processor, work);
    }
    pulp::Arch::new().dispatch(work)
}

/// Of single or double precision.
pub(crate) trait Number: Copy + Mul<Output = Self> + AddAssign {}

impl Number for f32 {}
impl Number for f64 {}

/// Adds products to a sum. (What is summed in place has to be copied: of arrays that might overlap no vectors are made.)
#[inline(always)]
pub(crate) fn add_product<T: Number, const L: usize>(sum: &mut [T; L], a: &[T; L], b: &[T; L]) {
    let (mut total, a, b) = (*sum, *a, *b);
    for j in 0..L {
        total[j] += a[j] * b[j];
    }
    *sum = total;
}

/// Adds `factor` times a row to a sum.
#[inline(always)]
pub(crate) fn add_scaled<T: Number, const L: usize>(sum: &mut [T; L], factor: T, row: &[T; L]) {
    let (mut total, row) = (*sum, *row);
    for j in 0..L {
        total[j] += factor * row[j];
    }
    *sum = total;
}

/// exp(-x) of each x >= -700, to 3e-13 relative; 0 above 700.
///
/// -x = k ln 2 + r with a whole k and |r| <= ln 2 / 2: the power series of exp(r) up to r^10, and 2^k by its exponent.
#[inline(always)]
pub(crate) fn exp_minus<const L: usize>(x: [f64; L]) -> [f64; L] {
    /// 1.5 x 2^52: added to a small number it leaves the nearest whole number in the last bits.
    const ROUND: f64 = 6_755_399_441_055_744.0;
    const LN2_HIGH: f64 = 0.693_147_180_369_123_8;
    const LN2_LOW: f64 = 1.908_214_929_270_587_7e-10;
    let mut result = [0.0; L];
    for j in 0..L {
        // No number stays none.
        let y = if x[j] > 700.0 { -700.0 } else { -x[j] };
        let shifted = y * std::f64::consts::LOG2_E + ROUND;
        let k = shifted - ROUND;
        let r = y - k * LN2_HIGH - k * LN2_LOW;
        let mut sum = 1.0 / 3_628_800.0;
        for inverse in [1.0 / 362_880.0, 1.0 / 40_320.0, 1.0 / 5040.0, 1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0]
        {
            sum = sum * r + inverse;
        }
        sum = ((sum * r + 0.5) * r + 1.0) * r + 1.0;
        // The last bits of `shifted` are k; the exponent of a double begins at bit 52 and counts from 1023.
        let power = f64::from_bits(shifted.to_bits().wrapping_add(1023) << 52);
        result[j] = if x[j] > 700.0 { 0.0 } else { sum * power };
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponentials_are_those_of_the_library() {
        for i in -20_000..20_000 {
            let x = f64::from(i) * 0.034_567;
            let [y] = exp_minus([x]);
            assert!((y / (-x).exp() - 1.0).abs() < 3e-13, "exp(-{x}): {y}, {}", (-x).exp());
        }
        assert_eq!(exp_minus([0.0, 701.0, f64::INFINITY]), [1.0, 0.0, 0.0]);
        assert!(exp_minus([f64::NAN])[0].is_nan());
    }
}
