//! One sphere: coefficients, efficiencies, amplitudes.

use super::recurrence::{chi, differences, psi, ratios};
use super::{LARGEST_INSIDE, MieError, RefractiveIndex, SIZE_PARAMETERS, angular, terms};
use num_complex::Complex64;

/// Terms summed plainly before they are added to the total.
const BLOCK: usize = 128;

/// Efficiencies: cross-sections over the geometric one, pi r^2.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Efficiencies {
    /// Extinction, 2/x^2 sum (2n + 1) Re(a_n + b_n).
    pub extinction: f64,
    /// Scattering, 2/x^2 sum (2n + 1) (|a_n|^2 + |b_n|^2).
    pub scattering: f64,
    /// Absorption: not their difference, but a sum of positive terms (see [`crate::mie`]); 0 for k = 0.
    pub absorption: f64,
    /// Radar backscatter, 4 |S1(180 degrees)|^2 / x^2.
    pub backscatter: f64,
    /// Asymmetry parameter g, the mean cosine of the scattering angle; NaN for m = 1, which scatters nothing.
    pub asymmetry: f64,
}

impl Efficiencies {
    /// Those of a sphere that does nothing.
    pub(super) const NOTHING: Self =
        Self { extinction: 0.0, scattering: 0.0, absorption: 0.0, backscatter: 0.0, asymmetry: f64::NAN };

    /// From the sums over n of (2n + 1) (|a_n|^2 + |b_n|^2), of the same of what is absorbed, of half of the scattering
    /// times g, and of (2n + 1) (-1)^(n+1) (a_n - b_n), which is 2 S1(180 degrees).
    #[inline]
    pub(super) fn from_sums(x: f64, scattering: f64, absorption: f64, cosine: f64, back: [f64; 2]) -> Self {
        let scale = 2.0 / (x * x);
        Self {
            extinction: scale * (scattering + absorption),
            scattering: scale * scattering,
            absorption: scale * absorption,
            backscatter: (back[0] * back[0] + back[1] * back[1]) / (x * x),
            asymmetry: 2.0 * cosine / scattering,
        }
    }
}

/// Amplitudes at one angle: for unpolarised light the scattered intensity is
/// (|S1|^2 + |S2|^2) / 2 / (k r)^2 of the incident one, at the distance r and wave number k.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Amplitudes {
    /// Perpendicular to the plane of scattering: sum (2n + 1) / (n (n + 1)) (a_n pi_n + b_n tau_n).
    pub s1: Complex64,
    /// In the plane of scattering: sum (2n + 1) / (n (n + 1)) (a_n tau_n + b_n pi_n).
    pub s2: Complex64,
}

/// Solves spheres one after another and keeps its memory: after the largest sphere nothing is allocated.
#[derive(Debug, Clone, Default)]
pub struct Solver {
    psi: Vec<f64>,
    chi: Vec<f64>,
    ratios: Vec<Complex64>,
    differences: Vec<Complex64>,
    a: Vec<Complex64>,
    b: Vec<Complex64>,
    /// Scattered and absorbed part of each term, of a_n and b_n together.
    parts: Vec<(f64, f64)>,
}

/// A sphere that was solved.
#[derive(Debug, Clone, Copy)]
pub struct Sphere<'a> {
    x: f64,
    a: &'a [Complex64],
    b: &'a [Complex64],
    parts: &'a [(f64, f64)],
}

/// One coefficient from its C and its numerator p = C psi_n + psi_(n+1): the coefficient, |coefficient|^2, and its
/// absorbed part.
#[inline]
fn coefficient(c: Complex64, p: Complex64, chi: [f64; 2]) -> (Complex64, f64, f64) {
    let q = Complex64::new(c.re * chi[0] + chi[1], c.im * chi[0]);
    let below = Complex64::new(p.re + q.im, p.im - q.re);
    let weight = 1.0 / below.norm_sqr();
    let (scattered, absorbed) = (p.norm_sqr() * weight, -c.im * weight);
    (Complex64::new(scattered + absorbed, (p.im * below.re - p.re * below.im) * weight), scattered, absorbed)
}

impl Solver {
    /// A solver with no memory yet.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Solves the sphere of size parameter `x` and index `m`.
    ///
    /// # Errors
    /// [`MieError::Size`] or [`MieError::Inside`] beyond [`SIZE_PARAMETERS`] and [`LARGEST_INSIDE`].
    pub fn sphere(&mut self, m: RefractiveIndex, x: f64) -> Result<Sphere<'_>, MieError> {
        if !(SIZE_PARAMETERS.0..=SIZE_PARAMETERS.1).contains(&x) {
            return Err(MieError::Size { x });
        }
        let index = m.to_complex();
        let z = index * x;
        if z.norm() > LARGEST_INSIDE {
            return Err(MieError::Inside { mx: z.norm() });
        }
        let count = terms(x);
        self.a.clear();
        self.b.clear();
        self.parts.clear();
        if m.is_one() {
            self.a.resize(count, Complex64::ZERO);
            self.b.resize(count, Complex64::ZERO);
            self.parts.resize(count, (0.0, 0.0));
            return Ok(Sphere { x, a: &self.a, b: &self.b, parts: &self.parts });
        }
        psi(x, count + 1, &mut self.psi);
        chi(x, count + 1, &mut self.chi);
        ratios(z, count + 1, &mut self.ratios);
        let matched = is_matched(m, x);
        let against = square_less_one(m);
        if matched {
            differences(index, against, &self.ratios, &self.psi, &mut self.differences);
        }
        let inverse = index.inv();
        let contrast = contrast(m) / x;
        for n in 1..=count {
            let (psi, chi) = ([self.psi[n], self.psi[n + 1]], [self.chi[n], self.chi[n + 1]]);
            let ratio = self.ratios[n + 1];
            let (of_a, of_b) = (contrast * (n + 1) as f64 - inverse * ratio, -index * ratio);
            let (above_a, above_b) = if matched {
                let slope = (n + 1) as f64 / x * psi[0] - psi[1];
                let difference = self.differences[n + 1];
                (-(against * slope + difference) * inverse * inverse, -difference)
            } else {
                let above = |c: Complex64| Complex64::new(c.re * psi[0] + psi[1], c.im * psi[0]);
                (above(of_a), above(of_b))
            };
            let (a, a_scattered, a_absorbed) = coefficient(of_a, above_a, chi);
            let (b, b_scattered, b_absorbed) = coefficient(of_b, above_b, chi);
            self.a.push(a);
            self.b.push(b);
            self.parts.push((a_scattered + b_scattered, a_absorbed + b_absorbed));
        }
        Ok(Sphere { x, a: &self.a, b: &self.b, parts: &self.parts })
    }
}

/// Whether the numerators of a_n and b_n are small differences, of the order of x |m - 1|, and G_n serves better.
pub(super) fn is_matched(m: RefractiveIndex, x: f64) -> bool {
    let distance = (m.to_complex() - 1.0).norm();
    distance < 0.1 && x * distance < 1.0
}

/// m^2 - 1 without cancellation.
fn square_less_one(m: RefractiveIndex) -> Complex64 {
    let (n, k) = (m.n(), m.k());
    Complex64::new((n - 1.0) * (n + 1.0) - k * k, 2.0 * n * k)
}

/// 1/m^2 - 1 without cancellation: its real part as (1 - m)(1 + m)/m^2, its imaginary part as -2nk / |m|^4.
pub(super) fn contrast(m: RefractiveIndex) -> Complex64 {
    let (n, k) = (m.n(), m.k());
    let norm = (n * n + k * k) * (n * n + k * k);
    let numerator = (1.0 - n) * (1.0 + n) + k * k;
    let square = (n - k) * (n + k);
    Complex64::new((numerator * square - 4.0 * n * n * k * k) / norm, -2.0 * n * k / norm)
}

impl<'a> Sphere<'a> {
    /// Size parameter.
    #[must_use]
    pub fn size_parameter(&self) -> f64 {
        self.x
    }

    /// a_n, the electric coefficients; a_1 first.
    #[must_use]
    pub fn a(&self) -> &'a [Complex64] {
        self.a
    }

    /// b_n, the magnetic coefficients; b_1 first.
    #[must_use]
    pub fn b(&self) -> &'a [Complex64] {
        self.b
    }

    /// Efficiencies and asymmetry.
    #[must_use]
    pub fn efficiencies(&self) -> Efficiencies {
        let (mut scattering, mut absorption, mut cosine, mut back) = (0.0, 0.0, 0.0, Complex64::ZERO);
        for start in (0..self.a.len()).step_by(BLOCK) {
            let (mut s, mut q, mut c, mut r) = (0.0, 0.0, 0.0, Complex64::ZERO);
            for i in start..(start + BLOCK).min(self.a.len()) {
                let n = (i + 1) as f64;
                let odd = 2.0 * n + 1.0;
                let (a, b, (scattered, absorbed)) = (self.a[i], self.b[i], self.parts[i]);
                s += odd * scattered;
                q += odd * absorbed;
                c += odd / (n * (n + 1.0)) * dot(a, b);
                if let (Some(&next_a), Some(&next_b)) = (self.a.get(i + 1), self.b.get(i + 1)) {
                    c += n * (n + 2.0) / (n + 1.0) * (dot(a, next_a) + dot(b, next_b));
                }
                let difference = (a - b) * odd;
                r += if i % 2 == 0 { difference } else { -difference };
            }
            scattering += s;
            absorption += q;
            cosine += c;
            back += r;
        }
        Efficiencies::from_sums(self.x, scattering, absorption, cosine, [back.re, back.im])
    }

    /// Amplitudes at the angle whose cosine is `cosine`.
    ///
    /// # Errors
    /// [`MieError::Cosine`] outside -1..=1.
    pub fn amplitudes(&self, cosine: f64) -> Result<Amplitudes, MieError> {
        let mut functions = angular::Functions::new(cosine)?;
        let (mut s1, mut s2) = (Complex64::ZERO, Complex64::ZERO);
        for (a, b) in self.a.chunks(BLOCK).zip(self.b.chunks(BLOCK)) {
            let (mut t1, mut t2) = (Complex64::ZERO, Complex64::ZERO);
            for (&a, &b) in a.iter().zip(b) {
                let weight = functions.weight();
                let (pi, tau) = functions.advance();
                t1 += (a * pi + b * tau) * weight;
                t2 += (a * tau + b * pi) * weight;
            }
            s1 += t1;
            s2 += t2;
        }
        Ok(Amplitudes { s1, s2 })
    }
}

/// Re(a b*).
fn dot(a: Complex64, b: Complex64) -> f64 {
    a.re * b.re + a.im * b.im
}
