//! Limits of small, large and faint spheres: formulas for the efficiencies without a series.

use num_complex::Complex64;

/// Qext, and Qsca where the limit has one of its own.
type Pair = (f64, Option<f64>);

/// A limit by its formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Limit {
    /// The induced dipole: Qsca = 8/3 x^4 |L|^2, Qabs = 4 x Im L, L = (m^2 - 1) / (m^2 + 2) (Rayleigh 1871).
    Rayleigh,
    /// a_1, b_1 and a_2 as fractions in x^2 (Wiscombe 1980, small-particle limit).
    ThreeTerms,
    /// Qext = 2: what is hit, and as much again diffracted.
    Geometric,
    /// Qext = 2 + 1.9924 x^(-2/3): with the edge (van de Hulst 1957).
    Edge,
    /// Anomalous diffraction (van de Hulst 1957), for |m - 1| << 1 and x >> 1.
    AnomalousDiffraction,
}

impl Limit {
    /// The efficiencies of the sphere of size parameter `x` and index m = n + ik; `None` where the formula is not meant:
    /// the fractions beyond x = 1, the large spheres below x = 3, anomalous diffraction with a phase lag below 1e-6.
    pub(super) fn efficiencies(self, x: f64, m: Complex64) -> Option<Pair> {
        match self {
            Self::Rayleigh => Some(rayleigh(x, m)),
            Self::ThreeTerms => (x <= 1.0).then(|| three_terms(x, m)),
            Self::Geometric => (x >= 3.0).then_some((2.0, None)),
            Self::Edge => (x >= 3.0).then(|| (2.0 + 1.9924 * x.powf(-2.0 / 3.0), None)),
            Self::AnomalousDiffraction => {
                let lag = 2.0 * x * (m - 1.0).norm();
                (lag > 1e-6).then(|| (anomalous_diffraction(x, m), None))
            }
        }
    }
}

fn rayleigh(x: f64, m: Complex64) -> Pair {
    let square = m * m;
    let l = (square - 1.0) / (square + 2.0);
    let scattering = 8.0 / 3.0 * x.powi(4) * l.norm_sqr();
    (scattering + 4.0 * x * l.im, Some(scattering))
}

fn three_terms(x: f64, m: Complex64) -> Pair {
    let (i, x2, square) = (Complex64::I, x * x, m * m);
    let contrast = square - 1.0;
    // a_1, b_1 and a_2 over x^3.
    let numerator = 1.0 - 0.1 * x2 + (4.0 * square + 5.0) * (x2 * x2 / 1400.0);
    let denominator = square + 2.0 + (1.0 - 0.7 * square) * x2
        - (8.0 * square * square - 385.0 * square + 350.0) * (x2 * x2 / 1400.0)
        - i * 2.0 / 3.0 * contrast * (x * x2) * (1.0 - 0.1 * x2);
    let a1 = -i * 2.0 / 3.0 * contrast * numerator / denominator;
    let b1 = -i * (x2 / 45.0) * contrast * (1.0 + (2.0 * square - 5.0) * (x2 / 70.0))
        / (1.0 - (2.0 * square - 5.0) * (x2 / 30.0));
    let a2 =
        -i * (x2 / 15.0) * contrast * (1.0 - x2 / 14.0) / (2.0 * square + 3.0 - (2.0 * square - 7.0) * (x2 / 14.0));
    let scattering = 6.0 * x2 * x2 * (a1.norm_sqr() + b1.norm_sqr() + 5.0 / 3.0 * a2.norm_sqr());
    let extinction = 6.0 * x * (a1 + b1 + 5.0 / 3.0 * a2).re;
    (extinction, Some(scattering))
}

/// Qext = 2 - 4 e^(-rho tan b) (cos b / rho) (sin(rho - b) + (cos b / rho) cos(rho - 2b)) + 4 (cos b / rho)^2 cos 2b with the
/// phase lag rho = 2x(n - 1) and tan b = k / (n - 1), as van de Hulst has it: its terms cancel for a small lag.
fn anomalous_diffraction(x: f64, m: Complex64) -> f64 {
    let lag = 2.0 * x * (m.re - 1.0);
    let angle = (m.im / (m.re - 1.0)).atan();
    let ratio = angle.cos() / lag;
    let decay = (-lag * angle.tan()).exp();
    2.0 - 4.0 * decay * ratio * (lag - angle).sin() - 4.0 * decay * ratio * ratio * (lag - 2.0 * angle).cos()
        + 4.0 * ratio * ratio * (2.0 * angle).cos()
}
