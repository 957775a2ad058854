//! Polarised light: its Stokes parameters, the frames that they refer to, and what scattering does to them.
//!
//! Radiance is followed backwards, so a direction d here is the one looked in: light travels along -d. A frame of that
//! light is a pair of unit vectors e1, e2 with e1 x e2 = d. With the field's components E1, E2 along them
//! I = <|E1|^2> + <|E2|^2>, Q = <|E1|^2> - <|E2|^2>, U = 2 Re <E1 E2*>, V = 2 Im <E1 E2*> up to the sign of its
//! convention, in W m^-2 sr^-1 (here per unit solar irradiance, sr^-1). With e1 = l and e2 = r this is the convention of Hovenier, van der Mee & Domke
//! 2004, sections 1.2 and 1.3, and of Bohren & Huffman 1983, section 2.11: r x l is the direction of travel.

use glam::DVec3;
use std::f64::consts::PI;
use std::ops::{Add, AddAssign, Mul};

/// Stokes parameters of what is seen. V is followed on the way, for it returns as U, and not reported.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Stokes {
    /// Radiance.
    pub i: f64,
    /// Radiance of linear polarisation along e1 less that along e2.
    pub q: f64,
    /// The same at 45 degrees: along e1 + e2 less along e1 - e2.
    pub u: f64,
}

impl Stokes {
    /// Radiance of the linearly polarised part, sqrt(Q^2 + U^2): at most I.
    #[must_use]
    pub fn polarised(&self) -> f64 {
        self.q.hypot(self.u)
    }

    /// Degree of linear polarisation, sqrt(Q^2 + U^2) / I, 0 to 1; 0 without light.
    #[must_use]
    pub fn degree(&self) -> f64 {
        if self.i > 0.0 { self.polarised() / self.i } else { 0.0 }
    }

    /// Angle of linear polarisation in degrees from e1 towards e2, 0 to 180 (180 left out); 0 of light that has none.
    #[must_use]
    pub fn angle_deg(&self) -> f64 {
        let angle = (0.5 * self.u.atan2(self.q)).to_degrees();
        // A hair below 0 rounds to 180, which is 0.
        let angle = if angle < 0.0 { angle + 180.0 } else { angle };
        if angle < 180.0 { angle } else { 0.0 }
    }

    /// The same light in a frame one of whose axes points the other way.
    #[must_use]
    pub fn mirrored(self) -> Self {
        Self { u: -self.u, ..self }
    }

    /// The same light in a frame that `turn` leads to.
    #[must_use]
    #[inline]
    pub fn turned(self, Turn { cos, sin }: Turn) -> Self {
        Self { i: self.i, q: self.q * cos + self.u * sin, u: self.u * cos - self.q * sin }
    }

    /// Radiance behind an ideal linear polariser whose axis is at `angle` (radians) from e1 towards e2:
    /// (I + Q cos 2a + U sin 2a) / 2.
    #[must_use]
    pub fn through(&self, angle: f64) -> f64 {
        let (sin, cos) = (2.0 * angle).sin_cos();
        0.5 * (self.i + self.q * cos + self.u * sin)
    }
}

impl Mul<f64> for Stokes {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self { i: self.i * factor, q: self.q * factor, u: self.u * factor }
    }
}

impl AddAssign for Stokes {
    #[inline]
    fn add_assign(&mut self, other: Self) {
        self.i += other.i;
        self.q += other.q;
        self.u += other.u;
    }
}

/// The frame of light that comes out of a direction d, by its second axis: e1 = e2 x d.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frame {
    e2: DVec3,
}

/// A turn of the frame about d by the angle eta, from e1 towards e2: with it
/// Q' = Q cos 2 eta + U sin 2 eta, U' = -Q sin 2 eta + U cos 2 eta
/// (Hovenier, van der Mee & Domke 2004, section 1.5). I and V stay.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    /// cos 2 eta.
    cos: f64,
    /// sin 2 eta.
    sin: f64,
}

/// The share of its polarising elements that a matrix may have too much, see [`Scattering::possible`].
const BEYOND: f64 = 0.02;

/// The square of the sine of an angle of scattering below which the plane of scattering is not told from rounding.
const STRAIGHT: f64 = 1e-20;

/// A horizontal unit vector across the unit `direction`, towards growing azimuth about the unit vector `up`; any that is across a
/// vertical direction.
#[must_use]
#[inline]
pub fn horizontal(up: DVec3, direction: DVec3) -> DVec3 {
    let across = up.cross(direction);
    if across.length_squared() > 1e-16 { across.normalize() } else { direction.any_orthonormal_vector() }
}

impl Frame {
    /// The frame of light out of the unit `direction` with e1 along the unit vector `first`, which is perpendicular to it.
    #[must_use]
    pub fn new(direction: DVec3, first: DVec3) -> Self {
        Self { e2: direction.cross(first) }
    }

    /// The frame of light out of the unit `direction` with e1 horizontal where `up` is the vertical ([`horizontal`]).
    #[must_use]
    pub fn level(up: DVec3, direction: DVec3) -> Self {
        Self::new(direction, horizontal(up, direction))
    }

    /// The frame of a plane of scattering: of light that came out of `before` and was scattered so that it comes out of
    /// `direction`. Its e2 is the normal of the plane, the same before and after, and e1 lies in the plane.
    /// Also the turn to it from this frame, which is one of `direction`.
    ///
    /// Straight on and straight back any plane is one of scattering, and this frame's own is taken.
    #[must_use]
    #[inline]
    pub fn of_scattering(self, direction: DVec3, before: DVec3) -> (Turn, Self) {
        let normal = direction.cross(before);
        let square = normal.length_squared();
        if square < STRAIGHT {
            return (Turn { cos: 1.0, sin: 0.0 }, self);
        }
        let plane = Self { e2: normal * square.sqrt().recip() };
        (self.turn_to(plane, direction), plane)
    }

    /// The turn from this frame to another of the same direction.
    #[must_use]
    #[inline]
    pub fn turn_to(self, other: Self, direction: DVec3) -> Turn {
        // e2' = -e1 sin(eta) + e2 cos(eta), e1 = e2 x d.
        let (cos, sin) = (other.e2.dot(self.e2), direction.dot(self.e2.cross(other.e2)));
        let unit = (cos * cos + sin * sin).recip();
        Turn { cos: (cos * cos - sin * sin) * unit, sin: 2.0 * cos * sin * unit }
    }
}

/// Scattering matrix in sr^-1 of a macroscopically isotropic medium with mirror symmetry, referred to the plane of scattering:
/// ```text
/// | a1  b1   0   0 |
/// | b1  a2   0   0 |
/// |  0   0  a3  b2 |
/// |  0   0 -b2  a4 |
/// ```
/// (Hovenier, van der Mee & Domke 2004, section 2.4; Mishchenko, Travis & Lacis 2002, section 4.3). a1 is the phase function: its integral over the
/// sphere is 1.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[allow(missing_docs, reason = "the elements of the matrix above")]
pub struct Scattering {
    pub a1: f64,
    pub a2: f64,
    pub a3: f64,
    pub a4: f64,
    pub b1: f64,
    pub b2: f64,
}

impl Add for Scattering {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self {
            a1: self.a1 + other.a1,
            a2: self.a2 + other.a2,
            a3: self.a3 + other.a3,
            a4: self.a4 + other.a4,
            b1: self.b1 + other.b1,
            b2: self.b2 + other.b2,
        }
    }
}

impl Mul<f64> for Scattering {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self {
            a1: self.a1 * factor,
            a2: self.a2 * factor,
            a3: self.a3 * factor,
            a4: self.a4 * factor,
            b1: self.b1 * factor,
            b2: self.b2 * factor,
        }
    }
}

impl Scattering {
    /// Molecules with the depolarisation rho of natural light at 90 degrees, gamma = rho / (2 - rho), for the cosine c of the
    /// scattering angle: D times Rayleigh's matrix and 1 - D times the isotropic one that keeps I alone,
    /// D = (1 - rho) / (1 + rho / 2) = (1 - gamma) / (1 + 2 gamma). With k = 3 / (16 pi (1 + 2 gamma)):
    /// a1 = k ((1 + 3 gamma) + (1 - gamma) c^2), a2 = k (1 - gamma) (1 + c^2), b1 = -k (1 - gamma) (1 - c^2),
    /// a3 = 2 k (1 - gamma) c, b2 = 0. V alone knows better of its own: a4 = 2 k (1 - 3 gamma) c
    /// (Hansen & Travis 1974, section 2.3).
    #[must_use]
    #[inline]
    pub fn rayleigh(gamma: f64, c: f64) -> Self {
        let k = 3.0 / (16.0 * PI * (1.0 + 2.0 * gamma));
        let dipole = k * (1.0 - gamma);
        Self {
            a1: k * (1.0 + 3.0 * gamma) + dipole * c * c,
            a2: dipole * (1.0 + c * c),
            a3: 2.0 * dipole * c,
            a4: 2.0 * k * (1.0 - 3.0 * gamma) * c,
            b1: -dipole * (1.0 - c) * (1.0 + c),
            b2: 0.0,
        }
    }

    /// Spheres from P11, P12, P33 and P34 in sr^-1: P22 = P11 and P44 = P33 (Bohren & Huffman 1983, section 4.4.4).
    #[must_use]
    #[inline]
    pub fn of_spheres(p11: f64, [p12, p33, p34]: [f64; 3]) -> Self {
        Self { a1: p11, a2: p11, a3: p33, a4: p33, b1: p12, b2: p34 }
    }

    /// Itself, if light of every state stays light, I^2 >= Q^2 + U^2 + V^2:
    /// (a3 + a4)^2 + 4 b2^2 <= (a1 + a2)^2 - 4 b1^2 and |a3 - a4| <= a1 - a2
    /// (Hovenier & van der Mee 1996; Hovenier, van der Mee & Domke 2004, appendix A). If rounding or interpolation has put it a little
    /// beyond, the nearest that is possible with all elements but a1 multiplied by one factor; `None` if this is below 0.98.
    #[must_use]
    pub fn possible(self) -> Option<Self> {
        let Self { a1, a2, a3, a4, b1, b2 } = self;
        let reach = (a3 + a4).hypot(2.0 * b1.hypot(b2)) - a2;
        let most = reach.max((a3 - a4).abs() + a2);
        let factor = if most > a1 { a1 / most } else { 1.0 };
        let sound = a1 >= 0.0 && (a1 + reach).is_finite() && factor >= 1.0 - BEYOND;
        sound.then(|| Self { a1, ..self * factor })
    }

    /// A phase function that loses all polarisation.
    #[must_use]
    #[inline]
    pub fn depolarising(p11: f64) -> Self {
        Self { a1: p11, ..Self::default() }
    }

    /// What it makes of natural light.
    #[must_use]
    #[inline]
    pub fn natural(&self) -> Natural {
        Natural { a1: self.a1, b1: self.b1 }
    }
}

/// Natural light once scattered: the first column (a1, b1, 0, 0) of [`Scattering`], I and Q referred to the plane of scattering.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[allow(missing_docs, reason = "the elements of the matrix of scattering")]
pub struct Natural {
    pub a1: f64,
    pub b1: f64,
}

impl Add for Natural {
    type Output = Self;
    #[inline]
    fn add(self, other: Self) -> Self {
        Self { a1: self.a1 + other.a1, b1: self.b1 + other.b1 }
    }
}

impl Mul<f64> for Natural {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self { a1: self.a1 * factor, b1: self.b1 * factor }
    }
}

/// What an observer sees of light somewhere on a path: the rows I, Q and U of the product of Mueller matrices from the light to the
/// observer, whose columns are the light's own I, Q, U and V in its frame.
///
/// The first element is positive and bounds all others, as in every Mueller matrix (Hovenier, van der Mee &
/// Domke 2004, appendix A).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Analyser {
    rows: [[f64; 4]; 3],
}

impl Mul<f64> for Analyser {
    type Output = Self;
    #[inline]
    fn mul(self, factor: f64) -> Self {
        Self { rows: self.rows.map(|row| row.map(|m| m * factor)) }
    }
}

impl Analyser {
    /// At the observer, in the observer's frame.
    pub const OBSERVER: Self = Self { rows: [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]] };

    /// What part of natural light is seen as radiance.
    #[must_use]
    #[inline]
    pub fn intensity(&self) -> f64 {
        self.rows[0][0]
    }

    /// Before a scattering by `matrix`, whose plane the frame turns to: M L(-eta) F.
    #[must_use]
    #[inline]
    pub fn scattered(&self, Turn { cos, sin }: Turn, matrix: &Scattering) -> Self {
        let Scattering { a1, a2, a3, a4, b1, b2 } = *matrix;
        Self {
            rows: self.rows.map(|[i, q, u, v]| {
                let (q, u) = (q * cos + u * sin, u * cos - q * sin);
                [i * a1 + q * b1, i * b1 + q * a2, u * a3 - v * b2, u * b2 + v * a4]
            }),
        }
    }

    /// Before a reflection that leaves no polarisation and the share `albedo` of the light.
    #[must_use]
    #[inline]
    pub fn reflected(&self, albedo: f64) -> Self {
        Self { rows: self.rows.map(|[i, ..]| [i * albedo, 0.0, 0.0, 0.0]) }
    }

    /// Natural light of radiance `light`.
    #[must_use]
    #[inline]
    pub fn natural(&self, light: f64) -> Stokes {
        let [i, q, u] = self.rows.map(|[i, ..]| i * light);
        Stokes { i, q, u }
    }

    /// Light without V, referred to the analyser's frame.
    #[must_use]
    #[inline]
    pub fn see(&self, light: &Stokes) -> Stokes {
        let [i, q, u] = self.rows.map(|[i, q, u, _]| i * light.i + q * light.q + u * light.u);
        Stokes { i, q, u }
    }

    /// Natural light once scattered, the plane of which the frame turns to, times `light`.
    #[must_use]
    #[inline]
    pub fn once_scattered(&self, Turn { cos, sin }: Turn, Natural { a1, b1 }: Natural, light: f64) -> Stokes {
        let (a1, cos, sin) = (a1 * light, b1 * cos * light, b1 * sin * light);
        let [i, q, u] = self.rows.map(|[i, q, u, _]| i * a1 + q * cos + u * sin);
        Stokes { i, q, u }
    }
}

#[cfg(test)]
mod tests;
