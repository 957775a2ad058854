//! Scattering of light by a homogeneous sphere (Mie 1908), in double precision.
//!
//! A plane wave of wavelength lambda meets a sphere of radius r and relative refractive index
//! m = n + ik ([`RefractiveIndex`]). With the size parameter x = 2 pi r / lambda, z = m x, and the
//! Riccati-Bessel functions psi_n(x) = x j_n(x), chi_n(x) = -x y_n(x), xi_n = psi_n - i chi_n
//! (Bohren & Huffman 1983, chapter 4; time factor exp(-i omega t)) the coefficients of the scattered wave are
//!
//! a_n = (C psi_n + psi_(n+1)) / (C xi_n + xi_(n+1)),  C = (n + 1) / x (1/m^2 - 1) - R_(n+1)(z) / m,
//! b_n = (C psi_n + psi_(n+1)) / (C xi_n + xi_(n+1)),  C = -m R_(n+1)(z),
//!
//! with the ratio R_n(z) = psi_n(z) / psi_(n-1)(z). These are the textbook's expressions with the
//! logarithmic derivative D_n(z) = (n + 1) / z - R_(n+1)(z) put in and the terms that cancel taken
//! out by hand, so that neither small x nor m near 1 loses digits and no power series is needed.
//! By the Wronskian psi_n chi_(n+1) - psi_(n+1) chi_n = 1,
//!
//! Re a_n = |a_n|^2 - Im C / |C xi_n + xi_(n+1)|^2, and so for b_n:
//!
//! scattering and absorption are each a sum of positive terms, and extinction is their sum.
//!
//! How each is computed, and why:
//!
//! - R_n(z) by downward recurrence, R_n = 1 / ((2n + 1)/z - R_(n+1)), from
//!   max(N, |z| + 8 |z|^(1/3)) + 16: it is stable downwards for every z, also where sines of z
//!   overflow. Starting at max(N, |z|) + 15, as much older code does, is wrong by up to 1 in the
//!   backward amplitude of large spheres that hardly absorb.
//! - psi_n(x) upwards while n <= x and by downward ratios beyond, where upward recurrence fails;
//!   chi_n(x) upwards, which is stable. Above x = 2000 both in twice the precision of a double: each
//!   rounding stays in the phase of all later orders.
//! - For an index near 1 (x |m - 1| < 1) the numerators are small differences: -G_(n+1) for b_n, and
//!   -((m^2 - 1) psi_n' + G_(n+1)) / m^2 for a_n, with G_n = m R_n(z) psi_(n-1)(x) - psi_n(x) by a recurrence of
//!   its own that has no difference in it: G_n = (R_n(z) / m) ((m^2 - 1) psi_(n-1)(x) + G_(n+1)).
//! - N = x + 7.2 x^(1/3) + 4 terms, where |a_n| falls below 1e-16. The rule of Wiscombe (1980),
//!   x + 4.05 x^(1/3) + 2, makes |a_n|^2 as small, which amplitudes and absorption do not forgive.
//! - The angular functions in the form of Wiscombe (1980), which is exact at 0 and 180 degrees.
//! - Sums in blocks, so that a million terms lose no more digits than a thousand.
//!
//! Valid for 1e-6 <= x <= 1e6, |m| x <= 1e7, n > 0, k >= 0; all else is a [`MieError`]. Relative
//! errors are those of the arithmetic, some 1e-15, times the condition of the case: near a narrow
//! resonance of width w, x/w; in the backward amplitude of large clear spheres up to x.
//!
//! [`Solver`] treats one sphere after another; [`Spheres`] many of one index at once: efficiencies, weighted sums with
//! the scattering matrix at angles, and Legendre moments.

mod angular;
mod instructions;
mod lanes;
mod legendre;
mod many;
mod recurrence;
mod sphere;

pub use angular::AngularTable;
pub use instructions::Instructions;
pub use legendre::gauss_legendre;
pub use many::{Spheres, Sums, VECTORS_UP_TO};
pub use sphere::{Amplitudes, Efficiencies, Solver, Sphere};

use num_complex::Complex64;
use std::fmt;

/// The range of size parameters, both ends allowed.
pub const SIZE_PARAMETERS: (f64, f64) = (1e-6, 1e6);

/// The largest |m| x.
pub const LARGEST_INSIDE: f64 = 1e7;

/// The refractive index m = n + ik of a sphere relative to the medium around it.
///
/// **k >= 0 absorbs**, everywhere in Airlight; a negative k is an error. (Sources that write
/// m = n - ik have the opposite time factor; their amplitudes are the complex conjugates.)
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RefractiveIndex {
    n: f64,
    k: f64,
}

impl RefractiveIndex {
    /// The index n + ik.
    ///
    /// # Errors
    /// [`MieError::Index`] unless n > 0 and k >= 0, both finite.
    pub fn new(n: f64, k: f64) -> Result<Self, MieError> {
        if n > 0.0 && k >= 0.0 && n.is_finite() && k.is_finite() {
            Ok(Self { n, k })
        } else {
            Err(MieError::Index { n, k })
        }
    }

    /// Real part.
    #[must_use]
    pub fn n(self) -> f64 {
        self.n
    }

    /// Imaginary part, which absorbs.
    #[must_use]
    pub fn k(self) -> f64 {
        self.k
    }

    /// Whether it is that of the surroundings, so that nothing happens.
    fn is_one(self) -> bool {
        self.n == 1.0 && self.k == 0.0
    }

    /// n + ik.
    #[must_use]
    pub fn to_complex(self) -> Complex64 {
        Complex64::new(self.n, self.k)
    }
}

/// What cannot be solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MieError {
    /// A refractive index that is none.
    Index {
        /// Real part.
        n: f64,
        /// Imaginary part.
        k: f64,
    },
    /// A size parameter out of range.
    Size {
        /// Size parameter.
        x: f64,
    },
    /// A sphere whose |m| x is out of range.
    Inside {
        /// Its |m| x.
        mx: f64,
    },
    /// A cosine that is none.
    Cosine {
        /// The cosine.
        cosine: f64,
    },
    /// A sphere with more terms than the table of angular functions was made for.
    Terms {
        /// Terms of the sphere.
        needed: usize,
        /// Terms of the table.
        available: usize,
    },
}

impl fmt::Display for MieError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Index { n, k } if *k < 0.0 => {
                write!(f, "refractive index {n} + ({k})i: k must not be negative; m = n + ik with k > 0 absorbs")
            }
            Self::Index { n, k } => {
                write!(f, "refractive index {n} + ({k})i: n > 0 and k >= 0 are needed, both finite")
            }
            Self::Size { x } => {
                write!(f, "size parameter {x}: {:e} to {:e} is possible", SIZE_PARAMETERS.0, SIZE_PARAMETERS.1)
            }
            Self::Inside { mx } => write!(f, "|m| x = {mx}: at most {LARGEST_INSIDE:e} is possible"),
            Self::Cosine { cosine } => write!(f, "{cosine} is not the cosine of an angle"),
            Self::Terms { needed, available } => {
                write!(f, "a sphere of {needed} terms with angular functions of {available} terms")
            }
        }
    }
}

impl std::error::Error for MieError {}

/// The number of terms N = x + 7.2 x^(1/3) + 4, rounded up, with which a sphere is solved.
#[must_use]
pub fn terms(x: f64) -> usize {
    (x + 7.2 * x.cbrt() + 4.0).ceil() as usize
}

#[cfg(test)]
mod tests;
