//! Where geometrical optics, Airy's theory and diffraction put the rings of a sphere of water.
//!
//! A ray that meets the sphere at the angle of incidence i and leaves it after p - 1 internal reflections is deviated
//! by D = 2 i - 2 p r + (p - 1) pi, sin i = n sin r. D is least where cos^2 i = (n^2 - 1) / (p^2 - 1) (Descartes): there
//! lies the bow. Beside that ray, at the distance v from it across the outgoing beam, the wavefront is the cubic
//! h v^3 / (3 a^2), a the radius,
//!
//! h = (p^2 - 1)^2 / p^2 (p^2 - n^2)^(1/2) / (n^2 - 1)^(3/2),
//!
//! so that the intensity at the angle delta inside the bow is that of Airy, Ai^2(-s), s = delta x^(2/3) / h^(1/3)
//! (Airy 1838; van de Hulst, Light scattering by small particles, 1957, section 13.2). Its maxima lie at the zeros of Ai'.

use std::f64::consts::PI;

/// s of the first maxima of Ai^2(-s): the bow and its supernumeraries (Abramowitz & Stegun 1964, table 10.13).
pub(super) const MAXIMA: [f64; 3] = [1.018_792_97, 3.248_197_58, 4.820_099_21];

/// First zero of J_1, the first dark ring of a disc (Abramowitz & Stegun 1964, table 9.5).
const FIRST_ZERO_OF_J1: f64 = 3.831_705_97;

/// A rainbow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Bow {
    /// Of one internal reflection.
    Primary,
    /// Of two.
    Secondary,
}

impl Bow {
    pub(super) const ALL: [Self; 2] = [Self::Primary, Self::Secondary];

    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Primary => "primary",
            Self::Secondary => "secondary",
        }
    }

    pub(super) fn internal_reflections(self) -> f64 {
        match self {
            Self::Primary => 1.0,
            Self::Secondary => 2.0,
        }
    }

    /// p, one more than the internal reflections.
    fn p(self) -> f64 {
        self.internal_reflections() + 1.0
    }

    /// The scattering angle in degrees of the ray that is deviated least, for drops of index n: 180 less the radius of
    /// the bow around the point opposite the sun.
    pub(super) fn descartes_deg(self, n: f64) -> f64 {
        let p = self.p();
        let i = ((n * n - 1.0) / (p * p - 1.0)).sqrt().acos();
        let r = (i.sin() / n).asin();
        let deviation = 2.0 * i - 2.0 * p * r + (p - 1.0) * PI;
        deviation.cos().acos().to_degrees()
    }

    /// h, the strength of the cubic.
    pub(super) fn cubic(self, n: f64) -> f64 {
        let square = self.p() * self.p();
        (square - 1.0).powi(2) / square * (square - n * n).sqrt() / (n * n - 1.0).powf(1.5)
    }

    /// How far inside Descartes' angle the place s of Airy's function lies, degrees.
    pub(super) fn airy_shift_deg(self, n: f64, x: f64, s: f64) -> f64 {
        (s * self.cubic(n).cbrt() * x.powf(-2.0 / 3.0)).to_degrees()
    }

    /// The scattering angle at `shift_deg` inside Descartes' angle: the light is deviated more than there, which is
    /// nearer to 180 degrees for the primary bow and farther for the secondary, past 180.
    pub(super) fn inside_deg(self, n: f64, shift_deg: f64) -> f64 {
        match self {
            Self::Primary => self.descartes_deg(n) + shift_deg,
            Self::Secondary => self.descartes_deg(n) - shift_deg,
        }
    }
}

/// The angle in degrees of the first dark ring around the light, of a disc of the size parameter x:
/// sin theta = 3.8317 / x, or 1.22 lambda / (2 r).
pub(super) fn dark_ring_deg(x: f64) -> f64 {
    (FIRST_ZERO_OF_J1 / x).asin().to_degrees()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bows_are_those_of_the_textbook() {
        // Van de Hulst 1957, section 13.2, for n = 4/3: 137.97 and 129.02 degrees from 42 degrees 2 minutes and 50
        // degrees 59 minutes, and h = 4.89 and 27.86.
        let n = 4.0 / 3.0;
        for (bow, angle, h) in [(Bow::Primary, 137.97, 4.89), (Bow::Secondary, 129.02, 27.86)] {
            assert!((bow.descartes_deg(n) - angle).abs() < 0.02, "{}", bow.descartes_deg(n));
            assert!((bow.cubic(n) - h).abs() < 0.005, "{}", bow.cubic(n));
        }
    }

    #[test]
    fn the_wavefront_beside_the_least_deviated_ray_is_the_cubic() {
        // Its slope D - D0 at v = a (sin i - sin i0) is h v^2 / a^2, the next term v^3.
        let n: f64 = 1.333;
        for bow in Bow::ALL {
            let p = bow.p();
            let deviation = |sine: f64| 2.0 * sine.asin() - 2.0 * p * (sine / n).asin();
            let least = ((p * p - n * n) / (p * p - 1.0)).sqrt();
            let v = 1e-3;
            let curved = 0.5 * (deviation(least + v) + deviation(least - v)) - deviation(least);
            // Of fourth order: v^2 times some 30.
            assert!((curved / (v * v) / bow.cubic(n) - 1.0).abs() < 1e-3, "{bow:?}: {}", curved / (v * v));
        }
    }

    #[test]
    fn the_first_dark_ring_is_that_of_a_disc() {
        // 1.22 lambda over the diameter, to three digits.
        let x = 1000.0;
        let expected = (1.22 * PI / x).to_degrees();
        assert!((dark_ring_deg(x) / expected - 1.0).abs() < 1e-3, "{}", dark_ring_deg(x));
    }
}
