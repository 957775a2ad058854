//! The logarithmic derivative D_n(z) of psi_n(z), in every way that has been used.

use super::classical::{Derivative, real, whole};
use num_complex::Complex;
use num_traits::Float;

/// p / q after Smith (1962): it overflows only where the quotient does.
pub(super) fn divided<T: Float>(p: Complex<T>, q: Complex<T>) -> Complex<T> {
    if q.re.abs() >= q.im.abs() {
        let (ratio, below) = (q.im / q.re, q.re + q.im / q.re * q.im);
        Complex::new((p.re + p.im * ratio) / below, (p.im - p.re * ratio) / below)
    } else {
        let (ratio, below) = (q.re / q.im, q.im + q.re / q.im * q.re);
        Complex::new((p.re * ratio + p.im) / below, (p.im * ratio - p.re) / below)
    }
}

/// 1 / q.
fn inverse<T: Float>(q: Complex<T>) -> Complex<T> {
    divided(Complex::new(T::one(), T::zero()), q)
}

/// D_n(mx) for n = 0 ..= `last`.
pub(super) fn all<T: Float>(how: Derivative, m: Complex<T>, x: T, last: usize) -> Vec<Complex<T>> {
    let z = m * x;
    let zero = Complex::new(T::zero(), T::zero());
    match how {
        Derivative::UpSquares => upwards(squares(z), z, last),
        Derivative::UpExponential => upwards(exponential(z), z, last),
        Derivative::UpWhereAllowed if upward_allowed(m, x) => upwards(exponential(z), z, last),
        Derivative::UpWhereAllowed | Derivative::Fraction => downwards(fraction(z, last), z, last, last),
        Derivative::DownFromLargest => downwards(zero, z, last.max(z.norm().to_usize().unwrap_or(0)) + 16, last),
        Derivative::Down => downwards(zero, z, safe_start(z, last), last),
    }
}

/// cot z = (sin a cos a - i sinh b cosh b) / (sin^2 a + sinh^2 b) of z = a + ib.
fn squares<T: Float>(z: Complex<T>) -> Complex<T> {
    let (sin, cos) = z.re.sin_cos();
    let (sinh, cosh) = (z.im.sinh(), z.im.cosh());
    let below = sin * sin + sinh * sinh;
    Complex::new(sin * cos / below, -sinh * cosh / below)
}

/// cot z = (2 t sin 2a - i (1 - t^2)) / (1 + t^2 - 2 t cos 2a) of z = a + ib, b >= 0, t = exp(-2b).
fn exponential<T: Float>(z: Complex<T>) -> Complex<T> {
    let (two, one) = (real::<T>(2.0), T::one());
    let t = (-two * z.im).exp();
    let (sin, cos) = (two * z.re).sin_cos();
    let below = one + t * t - two * t * cos;
    Complex::new(two * t * sin / below, -(one - t * t) / below)
}

/// Whether D_n may be computed upwards: k x < 13.78 n^2 - 10.8 n + 3.9 for 1 <= n <= 10 and k <= 10 (Wiscombe 1980).
fn upward_allowed<T: Float>(m: Complex<T>, x: T) -> bool {
    let ten = real(10.0);
    let limit = real::<T>(13.78) * m.re * m.re - real::<T>(10.8) * m.re + real(3.9);
    m.re >= T::one() && m.re <= ten && m.im <= ten && m.im * x < limit
}

/// D_n = 1 / (n/z - D_(n-1)) - n/z upwards.
fn upwards<T: Float>(zeroth: Complex<T>, z: Complex<T>, last: usize) -> Vec<Complex<T>> {
    let one_over = inverse(z);
    let mut values = vec![zeroth];
    for n in 1..=last {
        let order = one_over * whole::<T>(n);
        values.push(inverse(order - values[n - 1]) - order);
    }
    values
}

/// D_(n-1) = n/z - 1 / (D_n + n/z) downwards from the value at `start`.
fn downwards<T: Float>(first: Complex<T>, z: Complex<T>, start: usize, last: usize) -> Vec<Complex<T>> {
    let one_over = inverse(z);
    let mut values = vec![first; last + 1];
    let mut d = first;
    for n in (1..=start).rev() {
        if n <= last {
            values[n] = d;
        }
        let order = one_over * whole::<T>(n);
        d = order - inverse(d + order);
    }
    values[0] = d;
    values
}

/// psi_n(z) / psi_(n-1)(z) for n = 0 ..= `last` (of no meaning at 0), R_n = 1 / ((2n + 1)/z - R_(n+1)) downwards from 0
/// at max(last, |z| + 8 |z|^(1/3)) + 16.
pub(super) fn ratios<T: Float>(z: Complex<T>, last: usize) -> Vec<Complex<T>> {
    let one_over = inverse(z);
    let mut values = vec![Complex::new(T::zero(), T::zero()); last + 1];
    let mut ratio = values[0];
    for n in (1..=safe_start(z, last)).rev() {
        ratio = inverse(one_over * whole::<T>(2 * n + 1) - ratio);
        if n <= last {
            values[n] = ratio;
        }
    }
    values
}

/// The order from which downward recurrence forgets its start before max(last, |z|).
fn safe_start<T: Float>(z: Complex<T>, last: usize) -> usize {
    let size = z.norm();
    last.max((size + real::<T>(8.0) * size.cbrt()).to_usize().unwrap_or(0)) + 16
}

/// D_n(z) = J_(n-1/2)(z) / J_(n+1/2)(z) - n/z with the ratio as the continued fraction of Lentz (Appl. Opt. 15, 668,
/// 1976): the product of the ratios of its convergents, built from both ends at once.
fn fraction<T: Float>(z: Complex<T>, n: usize) -> Complex<T> {
    let one_over = inverse(z);
    let part = |i: usize| {
        let odd = whole::<T>(2 * (n + i) - 1);
        one_over * if i % 2 == 1 { odd } else { -odd }
    };
    let (mut above, mut below) = (part(2) + inverse(part(1)), part(2));
    let mut ratio = part(1) * divided(above, below);
    let mut i = 3;
    // Beyond |z| every step gains; a fraction of NaN ends at once.
    loop {
        (above, below) = (part(i) + inverse(above), part(i) + inverse(below));
        let step = divided(above, below);
        ratio = ratio * step;
        let change = (step - Complex::new(T::one(), T::zero())).norm();
        if change.is_nan() || change <= T::epsilon() {
            return ratio - one_over * whole::<T>(n);
        }
        i += 1;
    }
}
