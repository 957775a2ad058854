//! The classical algorithms of Mie scattering, each ingredient with its choices, in any precision.
//!
//! They are the objects of a study and compute nothing else; Airlight solves by [`crate::mie`]. As there, m = n + ik and
//! the textbook's notation (Bohren & Huffman 1983, chapter 4). The coefficients are in the textbook's form
//!
//! a_n = ((D_n/m + n/x) psi_n - psi_(n-1)) / ((D_n/m + n/x) xi_n - xi_(n-1)), b_n the same with m D_n,
//!
//! with the logarithmic derivative D_n(z) = psi_n'(z) / psi_n(z) at z = mx and xi_n = psi_n - i chi_n.

use super::derivative::{self, divided};
use num_complex::{Complex, Complex64};
use num_traits::Float;

/// How D_n(z) is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Derivative {
    /// Upwards from cot z by squares of hyperbolic functions, which overflow.
    UpSquares,
    /// Upwards from cot z by a decaying exponential, which does not.
    UpExponential,
    /// Upwards where Wiscombe (1980) allows it, else as [`Self::Fraction`].
    UpWhereAllowed,
    /// Downwards from 0 at max(N, |z|) + 16 (Bohren & Huffman 1983, appendix A).
    DownFromLargest,
    /// Downwards from 0 at max(N, |z| + 8 |z|^(1/3)) + 16.
    Down,
    /// Downwards from the continued fraction of Lentz (1976) at N.
    Fraction,
}

/// How psi_n(x) is found; chi_n always upwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Radial {
    /// Upwards from sin x and sin x / x - cos x.
    Up,
    /// By downward ratios from the larger of psi_0 and psi_1.
    Down,
    /// Upwards while n < x, by downward ratios beyond.
    Mixed,
}

/// The number of terms N, rounded down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Terms {
    /// Wiscombe (1980): x + 4 x^(1/3) + 1 up to x = 8, x + 4.05 x^(1/3) + 2 below 4200, x + 4 x^(1/3) + 2 from there.
    Wiscombe,
    /// Bohren & Huffman (1983), appendix A: x + 4 x^(1/3) + 2.
    BohrenHuffman,
    /// x + 6 x^(1/3) + 3.
    Six,
    /// x + 7.2 x^(1/3) + 4.
    Full,
    /// x + 10.
    Ten,
}

impl Terms {
    fn count(self, x: f64) -> usize {
        let root = x.cbrt();
        let terms = match self {
            Self::Wiscombe if x <= 8.0 => x + 4.0 * root + 1.0,
            Self::Wiscombe if x < 4200.0 => x + 4.05 * root + 2.0,
            Self::Wiscombe | Self::BohrenHuffman => x + 4.0 * root + 2.0,
            Self::Six => x + 6.0 * root + 3.0,
            Self::Full => x + 7.2 * root + 4.0,
            Self::Ten => x + 10.0,
        };
        terms as usize
    }
}

/// How pi_n and tau_n are found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Angular {
    /// pi_(n+1) = ((2n + 1) mu pi_n - (n + 1) pi_(n-1)) / n, tau_n = n mu pi_n - (n + 1) pi_(n-1).
    Textbook,
    /// s = mu pi_n, t = s - pi_(n-1), pi_(n+1) = s + (1 + 1/n) t, tau_n = n t - pi_(n-1) (Wiscombe 1980).
    Wiscombe,
}

/// How the terms are added.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sums {
    /// One after the other.
    Plain,
    /// In blocks of 128, then the blocks.
    Blocked,
}

/// How absorption is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Absorption {
    /// Extinction less scattering.
    Difference,
    /// By the Wronskian, Re a_n - |a_n|^2 = -Im(D_n/m) / |(D_n/m + n/x) xi_n - xi_(n-1)|^2, and for b_n with m D_n.
    Wronskian,
}

/// What a_n and b_n are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Form {
    /// The logarithmic derivative, as in the textbook.
    Derivative,
    /// Ratios psi_n(z) / psi_(n-1)(z), with what cancels taken out, as in [`crate::mie`]; the choice of [`Derivative`] does
    /// not matter.
    Ratios,
}

/// One choice for each ingredient.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Recipe {
    pub(super) form: Form,
    pub(super) derivative: Derivative,
    pub(super) radial: Radial,
    pub(super) terms: Terms,
    pub(super) angular: Angular,
    pub(super) sums: Sums,
    pub(super) absorption: Absorption,
}

/// What is compared of a sphere: the efficiencies of [`crate::mie::Efficiencies`] and S1 at 0 and 180 degrees.
#[derive(Debug, Clone, Copy)]
pub(super) struct Optics {
    pub(super) extinction: f64,
    pub(super) scattering: f64,
    pub(super) absorption: f64,
    pub(super) backscatter: f64,
    pub(super) asymmetry: f64,
    pub(super) forward: Complex64,
    pub(super) backward: Complex64,
}

/// A number in the precision wanted.
pub(super) fn real<T: Float>(value: f64) -> T {
    T::from(value).unwrap_or_else(T::nan)
}

/// A whole number in the precision wanted.
pub(super) fn whole<T: Float>(value: usize) -> T {
    real(value as f64)
}

/// A number in double precision.
fn double<T: Float>(value: T) -> f64 {
    value.to_f64().unwrap_or(f64::NAN)
}

impl Recipe {
    /// Solves the sphere of size parameter `x` and index n + ik. What overflows comes out as infinite or NaN.
    pub(super) fn solve<T: Float>(self, x: f64, (n, k): (f64, f64)) -> Optics {
        let last = self.terms.count(x);
        let m = Complex::new(real::<T>(n), real(k));
        let x = real::<T>(x);
        let inner = Inner::new(self, m, x, last);
        let psi = radial(self.radial, x, last + 1);
        let chi = upwards(last + 1, x, x.cos(), x.cos() / x + x.sin());

        let (mut total, mut ahead, mut back) = (Totals::default(), Pair::new(T::one()), Pair::new(-T::one()));
        let mut part = Totals::default();
        let mut previous = [Complex::new(T::zero(), T::zero()); 2];
        for n in 1..=last {
            let order = whole::<T>(n);
            let (factors, sign, other) = inner.factors(n, x);
            let xi = |n: usize| Complex::new(psi[n], -chi[n]);
            let mut absorbed = T::zero();
            let now = factors.map(|factor| {
                let below = factor * xi(n) + xi(other) * sign;
                absorbed = absorbed - factor.im / below.norm_sqr();
                divided(factor * psi[n] + psi[other] * sign, below)
            });
            part.add(order, previous, now, absorbed);
            let weight = (order + order + T::one()) / (order * (order + T::one()));
            for (angle, sum) in [(&mut ahead, &mut part.forward), (&mut back, &mut part.backward)] {
                let (pi, tau) = angle.advance(self.angular, order);
                *sum = *sum + (now[0] * pi + now[1] * tau) * weight;
            }
            previous = now;
            if self.sums == Sums::Blocked && n % 128 == 0 {
                total = total.with(std::mem::take(&mut part));
            }
        }
        total.with(part).optics(x, self.absorption)
    }
}

/// What the inside of the sphere gives to the coefficients.
struct Inner<T> {
    form: Form,
    m: Complex<T>,
    /// 1/m^2 - 1.
    contrast: Complex<T>,
    /// D_n(z), or psi_n(z) / psi_(n-1)(z), at index n.
    values: Vec<Complex<T>>,
}

impl<T: Float> Inner<T> {
    fn new(recipe: Recipe, m: Complex<T>, x: T, last: usize) -> Self {
        let one = T::one();
        let contrast = divided((-m + one) * (m + one), m * m);
        let values = match recipe.form {
            Form::Derivative => derivative::all(recipe.derivative, m, x, last),
            Form::Ratios => derivative::ratios(m * x, last + 1),
        };
        Self { form: recipe.form, m, contrast, values }
    }

    /// The factors C of a_n and b_n, the sign s and the order o of
    /// (C psi_n + s psi_o) / (C xi_n + s xi_o).
    fn factors(&self, n: usize, x: T) -> ([Complex<T>; 2], T, usize) {
        let m = self.m;
        match self.form {
            Form::Derivative => {
                let (d, over) = (self.values[n], whole::<T>(n) / x);
                ([divided(d, m) + over, d * m + over], -T::one(), n - 1)
            }
            Form::Ratios => {
                let (ratio, over) = (self.values[n + 1], whole::<T>(n + 1) / x);
                ([self.contrast * over - divided(ratio, m), -m * ratio], T::one(), n + 1)
            }
        }
    }
}

/// psi_n or chi_n for n = 0 ..= `last` upwards from its first two.
fn upwards<T: Float>(last: usize, x: T, zeroth: T, first: T) -> Vec<T> {
    let mut values = vec![zeroth, first];
    for n in 1..last {
        values.push(whole::<T>(2 * n + 1) / x * values[n] - values[n - 1]);
    }
    values
}

/// psi_n(x) for n = 0 ..= `last`.
fn radial<T: Float>(how: Radial, x: T, last: usize) -> Vec<T> {
    let (zeroth, first) = (x.sin(), x.sin() / x - x.cos());
    let mut psi = upwards(last, x, zeroth, first);
    // The last order that is taken from the upward recurrence.
    let upper = match how {
        Radial::Up => return psi,
        Radial::Down => usize::from(first.abs() > zeroth.abs()),
        Radial::Mixed if x < real(2.0) => 0,
        Radial::Mixed => last.min(x.to_usize().unwrap_or(0)),
    };
    // From where psi is 1e-8 of psi_last or less, so that starting with 0 is forgotten.
    let start = last + (real::<T>(5.0) * x.cbrt()).to_usize().unwrap_or(0) + 16;
    let mut ratio = T::zero();
    let mut ratios = vec![T::zero(); last + 1];
    for n in (1..=start).rev() {
        ratio = T::one() / (whole::<T>(2 * n + 1) / x - ratio);
        if n <= last {
            ratios[n] = ratio;
        }
    }
    for n in upper + 1..=last {
        psi[n] = ratios[n] * psi[n - 1];
    }
    psi
}

/// pi_n and pi_(n-1) at one cosine.
struct Pair<T> {
    cosine: T,
    current: T,
    below: T,
}

impl<T: Float> Pair<T> {
    fn new(cosine: T) -> Self {
        Self { cosine, current: T::one(), below: T::zero() }
    }

    /// pi_n and tau_n, and on to n + 1.
    fn advance(&mut self, how: Angular, n: T) -> (T, T) {
        let (one, pi, below) = (T::one(), self.current, self.below);
        let s = self.cosine * pi;
        let (tau, next) = match how {
            Angular::Textbook => (n * s - (n + one) * below, ((n + n + one) * s - (n + one) * below) / n),
            Angular::Wiscombe => {
                let t = s - below;
                (n * t - below, s + t + t / n)
            }
        };
        (self.below, self.current) = (pi, next);
        (pi, tau)
    }
}

/// Sums over terms.
#[derive(Clone, Copy)]
struct Totals<T> {
    extinction: T,
    scattering: T,
    absorption: T,
    cosine: T,
    radar: Complex<T>,
    forward: Complex<T>,
    backward: Complex<T>,
}

impl<T: Float> Default for Totals<T> {
    fn default() -> Self {
        let (zero, none) = (T::zero(), Complex::new(T::zero(), T::zero()));
        Self {
            extinction: zero,
            scattering: zero,
            absorption: zero,
            cosine: zero,
            radar: none,
            forward: none,
            backward: none,
        }
    }
}

impl<T: Float> Totals<T> {
    fn add(&mut self, n: T, before: [Complex<T>; 2], [a, b]: [Complex<T>; 2], absorbed: T) {
        let one = T::one();
        let odd = n + n + one;
        let dot = |p: Complex<T>, q: Complex<T>| p.re * q.re + p.im * q.im;
        self.extinction = self.extinction + odd * (a.re + b.re);
        self.scattering = self.scattering + odd * (a.norm_sqr() + b.norm_sqr());
        self.absorption = self.absorption + odd * absorbed;
        self.cosine = self.cosine
            + (n - one) * (n + one) / n * (dot(before[0], a) + dot(before[1], b))
            + odd / (n * (n + one)) * dot(a, b);
        let sign = if (n * real(0.5)).fract() == T::zero() { one } else { -one };
        self.radar = self.radar + (a - b) * (sign * odd);
    }

    fn with(self, part: Self) -> Self {
        Self {
            extinction: self.extinction + part.extinction,
            scattering: self.scattering + part.scattering,
            absorption: self.absorption + part.absorption,
            cosine: self.cosine + part.cosine,
            radar: self.radar + part.radar,
            forward: self.forward + part.forward,
            backward: self.backward + part.backward,
        }
    }

    fn optics(self, x: T, absorption: Absorption) -> Optics {
        let two = real::<T>(2.0);
        let scale = two / (x * x);
        let (extinction, scattering) = (scale * self.extinction, scale * self.scattering);
        let absorption = match absorption {
            Absorption::Difference => extinction - scattering,
            Absorption::Wronskian => scale * self.absorption,
        };
        let amplitude = |s: Complex<T>| Complex64::new(double(s.re), double(s.im));
        Optics {
            extinction: double(extinction),
            scattering: double(scattering),
            absorption: double(absorption),
            backscatter: double(self.radar.norm_sqr() / (x * x)),
            asymmetry: double(two * self.cosine / self.scattering),
            forward: amplitude(self.forward),
            backward: amplitude(self.backward),
        }
    }
}
