//! The Riccati-Bessel functions, each in the direction in which it is stable.

use num_complex::Complex64;

/// Size parameter from which psi and chi are carried upwards in twice the precision: the rounding of each step
/// stays in the phase of all later ones, some x 1e-16 at the end, which the backward amplitude of a large absorber
/// and the sum over a million terms feel.
const DOUBLED_FROM: f64 = super::VECTORS_UP_TO;

/// The order up to which psi_n(x) goes upwards, at most `last`. There is no zero of psi_n at or below x = n, so
/// beyond nothing is divided by a small number; below x = 2 the difference in psi_1 would cancel, and psi_0 has no
/// zero there.
pub(super) fn upward_to(x: f64, last: usize) -> usize {
    if x < 2.0 { 0 } else { (x as usize).min(last) }
}

/// The order from which ratios psi_n(x) / psi_(n-1)(x) up to n = `last` go downwards from 0: where psi is 1e-8 of
/// psi_last or less, so that the 0 is forgotten.
pub(super) fn start_outside(x: f64, last: usize) -> usize {
    last + (5.0 * x.cbrt()) as usize + 16
}

/// The order from which R_n(z), |z| = `size`, up to n = `last` goes downwards from 0: max(last, |z| + 8 |z|^(1/3)) + 16.
pub(super) fn start(size: f64, last: usize) -> usize {
    last.max((size + 8.0 * size.cbrt()) as usize) + 16
}

/// Fills `out` from n = 2 to `last` by f_(n+1) = (2n + 1)/x f_n - f_(n-1), from the first two, which are there.
fn upwards(x: f64, last: usize, out: &mut [f64]) {
    if x < DOUBLED_FROM {
        for n in 1..last {
            out[n + 1] = (2 * n + 1) as f64 / x * out[n] - out[n - 1];
        }
        return;
    }
    let (mut before, mut now) = ((out[0], 0.0), (out[1], 0.0));
    for n in 1..last {
        let odd = (2 * n + 1) as f64;
        let step = odd / x;
        let rest = (-step).mul_add(x, odd) / x;
        let product = step * now.0;
        let error = step.mul_add(now.0, -product) + (step * now.1 + rest * now.0);
        let sum = product - before.0;
        let other = sum - product;
        let lost = (product - (sum - other)) - (before.0 + other);
        let low = lost + (error - before.1);
        let high = sum + low;
        (before, now) = (now, (high, low - (high - sum)));
        out[n + 1] = high;
    }
}

/// psi_n(x) for n = 0 ..= `last`, x >= 1e-6: upwards while n <= x, psi_(n+1) = (2n + 1)/x psi_n - psi_(n-1), from
/// sin x and sin x / x - cos x; beyond by psi_n = r_n psi_(n-1), r_n = 1 / ((2n + 1)/x - r_(n+1)) downwards.
pub(super) fn psi(x: f64, last: usize, out: &mut Vec<f64>) {
    out.clear();
    out.resize(last + 1, 0.0);
    let (sin, cos) = x.sin_cos();
    out[0] = sin;
    let upper = upward_to(x, last);
    if upper >= 1 {
        out[1] = sin / x - cos;
        upwards(x, upper, out);
    }
    let mut ratio = 0.0;
    for n in (last + 1..=start_outside(x, last)).rev() {
        ratio = 1.0 / ((2 * n + 1) as f64 / x - ratio);
    }
    for n in (upper + 1..=last).rev() {
        ratio = 1.0 / ((2 * n + 1) as f64 / x - ratio);
        out[n] = ratio;
    }
    for n in upper + 1..=last {
        out[n] *= out[n - 1];
    }
}

/// chi_n(x) for n = 0 ..= `last`, upwards from cos x and cos x / x + sin x.
pub(super) fn chi(x: f64, last: usize, out: &mut Vec<f64>) {
    out.clear();
    out.resize(last + 1, 0.0);
    let (sin, cos) = x.sin_cos();
    out[0] = cos;
    if last >= 1 {
        out[1] = cos / x + sin;
    }
    upwards(x, last, out);
}

/// R_n(z) = psi_n(z) / psi_(n-1)(z) for n = 1 ..= `last` at index n (index 0 is unused), by
/// R_n = 1 / ((2n + 1)/z - R_(n+1)) downwards from [`start`].
pub(super) fn ratios(z: Complex64, last: usize, out: &mut Vec<Complex64>) {
    out.clear();
    out.resize(last + 1, Complex64::ZERO);
    let inverse = z.inv();
    let mut ratio = Complex64::ZERO;
    let step = |n: usize, ratio: Complex64| {
        let odd = (2 * n + 1) as f64;
        reciprocal(Complex64::new(odd * inverse.re - ratio.re, odd * inverse.im - ratio.im))
    };
    for n in (last + 1..=start(z.norm(), last)).rev() {
        ratio = step(n, ratio);
    }
    for n in (1..=last).rev() {
        ratio = step(n, ratio);
        out[n] = ratio;
    }
}

/// G_n = m R_n(z) psi_(n-1)(x) - psi_n(x), z = m x, for n = 1 ..= `psi.len()` at index n, without the difference, for
/// m near 1: from the recurrences of both,
///
/// G_n = (R_n(z) / m) ((m^2 - 1) psi_(n-1)(x) + G_(n+1)),
///
/// downwards from 0, each step a factor 1/m: for x |m - 1| of order 1 or less. `ratios` reaches to `psi.len() - 1`.
pub(super) fn differences(
    m: Complex64,
    contrast: Complex64,
    ratios: &[Complex64],
    psi: &[f64],
    out: &mut Vec<Complex64>,
) {
    out.clear();
    out.resize(psi.len() + 1, Complex64::ZERO);
    let inverse = m.inv();
    for n in (1..psi.len()).rev() {
        out[n] = ratios[n] * inverse * (contrast * psi[n - 1] + out[n + 1]);
    }
}

/// 1/w; for w = 0, which a zero of psi can bring about, a number so large that the next step forgets it.
fn reciprocal(w: Complex64) -> Complex64 {
    let square = w.re * w.re + w.im * w.im;
    if square == 0.0 { Complex64::new(1e150, 0.0) } else { Complex64::new(w.re / square, -w.im / square) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn psi_and_chi_have_their_wronskian_at_every_order() {
        for x in [1e-6, 1e-3, 0.3, 1.99, 2.0, 3.7, 31.4, 1e3, 1e5] {
            let last = super::super::terms(x) + 1;
            let (mut p, mut c) = (Vec::new(), Vec::new());
            psi(x, last, &mut p);
            chi(x, last, &mut c);
            for n in 0..last {
                let wronskian = p[n] * c[n + 1] - p[n + 1] * c[n];
                // Rounding grows along the recurrence, with the root of the number of steps.
                let tolerance = 2e-15 * (1.0 + x.sqrt());
                assert!((wronskian - 1.0).abs() < tolerance, "x = {x}, n = {n}: {wronskian}");
            }
        }
    }

    #[test]
    fn ratios_reproduce_closed_forms_of_low_order() {
        // psi_1/psi_0 = 1/z - cot z, psi_2/psi_1 = 3/z - psi_0/psi_1, from elementary functions where
        // those neither cancel nor overflow.
        for z in
            [Complex64::new(2.3, 0.0), Complex64::new(4.0, 0.7), Complex64::new(0.9, 2.0), Complex64::new(40.0, 12.0)]
        {
            let mut r = Vec::new();
            ratios(z, 5, &mut r);
            let first = z.inv() - z.cos() / z.sin();
            let second = 3.0 / z - first.inv();
            // A few roundings of the closed form, which itself cancels by up to 10.
            assert!((r[1] - first).norm() < 1e-14 * first.norm(), "{z}: {} against {first}", r[1]);
            assert!((r[2] - second).norm() < 1e-13 * second.norm(), "{z}: {} against {second}", r[2]);
        }
    }

    #[test]
    fn ratios_of_a_strong_absorber_do_not_overflow() {
        // exp(1e6) is beyond any double; deep inside psi'/psi tends to -i, so R tends to i (1 + O(1/z)).
        let mut r = Vec::new();
        ratios(Complex64::new(1e6, 1e6), 3, &mut r);
        assert!((r[1] - Complex64::I).norm() < 1e-6 && r.iter().skip(1).all(|r| r.is_finite()), "{:?}", &r[1..]);
    }
}
