//! From radiance factors to colour.

use super::Wavelengths;
use tables::TableError;
use tables::units::LUMINOUS_EFFICACY_LM_W;
use tables::views::{Observer, Sun};

/// Weights that turn simulated radiance factors into CIE XYZ.
///
/// A radiance factor f = L / E is spectral radiance L (W m^-2 sr^-1 nm^-1) over the
/// sun's spectral irradiance E (W m^-2 nm^-1) above the atmosphere, in sr^-1. It is
/// smooth in wavelength where L, which has the Fraunhofer lines, is not; so f is
/// interpolated between the simulated wavelengths and E is not sampled but integrated:
///
/// X_c = 683 lm/W * integral of f(lambda) E(lambda) c(lambda) d lambda, c = x-bar, y-bar, z-bar,
///     = sum_i w_ci f_i, w_ci = 683 * integral of l_i E c d lambda,
///
/// l_i being the function that interpolates 1 at wavelength i and 0 at the others:
/// the cubic through the four nearest nodes, linear between two or three nodes, constant
/// for one. Beyond the first and last wavelength f is constant (never extrapolated): with
/// nodes from 380 to 780 nm the remainder of the observer's 360 to 830 nm has 0.01 % of
/// the response. 16 nodes agree with 401
/// within 2e-4 for f = lambda^-4 (see the tests). The bands of ozone are narrower than the step of
/// 27 nm: the illuminance by direct sunlight of 16 nodes is high by 3e-4 with the sun overhead, 7e-4 at
/// 30 degrees of elevation, 2e-3 at 10, 5e-3 at 2 and 7e-3 at 0; 41 nodes bring the last to 6e-4.
/// The integral is the trapezoidal rule at 0.5 nm, the finest spacing of the data.
#[derive(Debug, Clone, PartialEq)]
pub struct Colour {
    weights: Vec<[f64; 3]>,
}

/// Range and step of the integration in nm.
const FIRST_NM: f64 = 360.0;
const STEP_NM: f64 = 0.5;
const STEPS: u32 = 940;

impl Colour {
    /// The weights for radiance factors at `wavelengths` under `sun` as `observer` sees.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] if a table refuses a wavelength of 360 to 830 nm.
    pub fn new(sun: &Sun, observer: &Observer, wavelengths: &Wavelengths) -> Result<Self, TableError> {
        Self::weigh(wavelengths.nm(), |wavelength_nm| {
            let irradiance = sun.irradiance_w_m2_nm.at(wavelength_nm)?;
            let [x, y, z] = &observer.matching;
            Ok([x, y, z].map(|c| c.at(wavelength_nm).map(|c| c * irradiance)))
        })
    }

    /// From the XYZ of a radiance factor of 1 sr^-1 at each wavelength alone.
    #[must_use]
    pub fn weighed(weights: Vec<[f64; 3]>) -> Self {
        Self { weights }
    }

    /// Of factors that are X, Y and Z themselves in cd/m^2, as fitted skies give them.
    #[must_use]
    pub fn direct() -> Self {
        Self::weighed(vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    }

    /// XYZ of a radiance factor of 1 sr^-1 at every wavelength.
    #[must_use]
    pub fn white(&self) -> [f64; 3] {
        self.weights.iter().fold([0.0; 3], |sum, w| std::array::from_fn(|i| sum[i] + w[i]))
    }

    /// The weights for nodes in nm and E(lambda) c(lambda).
    fn weigh(
        nodes: &[f64],
        light: impl Fn(f64) -> Result<[Result<f64, TableError>; 3], TableError>,
    ) -> Result<Self, TableError> {
        let mut weights = vec![[0.0; 3]; nodes.len()];
        for k in 0..=STEPS {
            let wavelength_nm = FIRST_NM + STEP_NM * f64::from(k);
            let share = LUMINOUS_EFFICACY_LM_W * if k == 0 || k == STEPS { 0.5 * STEP_NM } else { STEP_NM };
            let [x, y, z] = light(wavelength_nm)?;
            let light = [x?, y?, z?];
            let (first, cardinal, used) = cardinals(nodes, wavelength_nm);
            for (weight, l) in weights[first..].iter_mut().zip(&cardinal[..used]) {
                for (w, e) in weight.iter_mut().zip(light) {
                    *w += share * l * e;
                }
            }
        }
        Ok(Self { weights })
    }

    /// CIE XYZ of the 1931 2 degree observer from the radiance factors in sr^-1 at the
    /// wavelengths; Y is luminance in cd/m^2. From irradiance factors (1) it is in lux.
    #[must_use]
    pub fn xyz(&self, factors: &[f64]) -> [f64; 3] {
        let mut xyz = [0.0; 3];
        for (weight, factor) in self.weights.iter().zip(factors) {
            for (sum, w) in xyz.iter_mut().zip(weight) {
                *sum += w * factor;
            }
        }
        xyz
    }
}

/// Weights by which values at increasing `nodes` become the value at x, as colours have it ([`Colour`]): the first node and its weight and those that
/// follow.
#[must_use]
pub fn between(nodes: &[f64], x: f64) -> (usize, Vec<f64>) {
    let (first, values, used) = cardinals(nodes, x);
    (first, values[..used].to_vec())
}

/// Steps that differ by more than this factor are joined by lines: a cubic through uneven nodes swings far
/// beyond their values.
const EVEN: f64 = 3.0;

/// The interpolating functions at x that are not zero: the index of the first node,
/// their values, and how many there are.
fn cardinals(nodes: &[f64], x: f64) -> (usize, [f64; 4], usize) {
    let last = nodes.len() - 1;
    if x <= nodes[0] || last == 0 {
        return (0, [1.0, 0.0, 0.0, 0.0], 1);
    }
    if x >= nodes[last] {
        return (last, [1.0, 0.0, 0.0, 0.0], 1);
    }
    let below = nodes.partition_point(|&node| node <= x) - 1;
    let around = below.saturating_sub(1).min(nodes.len().saturating_sub(4));
    let steps = nodes.windows(2).skip(around).take(3).map(|w| w[1] - w[0]);
    let (least, most) = steps.fold((f64::INFINITY, 0.0_f64), |(least, most), step| (least.min(step), most.max(step)));
    let (first, used) = if nodes.len() < 4 || most > EVEN * least { (below, 2) } else { (around, 4) };
    let near = &nodes[first..first + used];
    let mut values = [0.0; 4];
    for (i, value) in values[..used].iter_mut().enumerate() {
        *value = (0..used).filter(|&j| j != i).map(|j| (x - near[j]) / (near[i] - near[j])).product();
    }
    (first, values, used)
}

/// Rows R, G, B of the matrix from XYZ to linear sRGB, the inverse of the one whose columns
/// are the primaries of ITU-R BT.709 (x, y) = (0.64, 0.33), (0.30, 0.60), (0.15, 0.06) scaled
/// so that their sum is D65 (0.3127, 0.3290) with Y = 1 (IEC 61966-2-1:1999).
const SRGB_FROM_XYZ: [[f64; 3]; 3] = [
    [3.240_969_941_9, -1.537_383_177_6, -0.498_610_760_3],
    [-0.969_243_636_3, 1.875_967_501_5, 0.041_555_057_4],
    [0.055_630_079_7, -0.203_976_958_9, 1.056_971_514_2],
];

/// Luminance of the three primaries of sRGB.
const LUMINANCE: [f64; 3] = [0.212_639_005_9, 0.715_168_678_8, 0.072_192_315_4];

/// Linear sRGB in the unit of XYZ: white with Y = 1 cd/m^2 is (1, 1, 1). A colour
/// outside the gamut has a negative component; nothing is clipped.
#[must_use]
pub fn linear_srgb(xyz: [f64; 3]) -> [f64; 3] {
    SRGB_FROM_XYZ.map(|row| row[0] * xyz[0] + row[1] * xyz[1] + row[2] * xyz[2])
}

/// Columns X, Y, Z of the primaries of sRGB: the inverse of [`linear_srgb`]'s matrix, with luminances [`LUMINANCE`].
const XYZ_FROM_SRGB: [[f64; 3]; 3] = [
    [LUMINANCE[0] * 0.64 / 0.33, LUMINANCE[1] * 0.30 / 0.60, LUMINANCE[2] * 0.15 / 0.06],
    LUMINANCE,
    [LUMINANCE[0] * 0.03 / 0.33, LUMINANCE[1] * 0.10 / 0.60, LUMINANCE[2] * 0.79 / 0.06],
];

/// CIE XYZ of a linear sRGB colour, in its unit: the inverse of [`linear_srgb`].
#[must_use]
pub fn xyz(rgb: [f64; 3]) -> [f64; 3] {
    XYZ_FROM_SRGB.map(|row| row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2])
}

/// Luminance Y = 0.2126 R + 0.7152 G + 0.0722 B of a linear sRGB colour, in its unit.
#[must_use]
pub fn luminance(rgb: [f64; 3]) -> f64 {
    LUMINANCE[0] * rgb[0] + LUMINANCE[1] * rgb[1] + LUMINANCE[2] * rgb[2]
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Gaussian lobes like the matching functions (the shape of Wyman, Sloan & Shirley 2013)
    /// times a 5772 K spectrum with lines.
    fn light(nm: f64) -> [f64; 3] {
        let lobe = |centre: f64, below: f64, above: f64| {
            let t = (nm - centre) / if nm < centre { below } else { above };
            (-0.5 * t * t).exp()
        };
        let planck = 1.9 * (500.0 / nm).powi(5) * ((14_388e3 / (500.0 * 5772.0_f64)).exp() - 1.0)
            / ((14_388e3 / (nm * 5772.0)).exp() - 1.0);
        let lines = 1.0 - 0.2 * (nm * 0.9).sin().powi(8);
        [
            1.056 * lobe(599.8, 37.9, 31.0) + 0.362 * lobe(442.0, 16.0, 26.7) - 0.065 * lobe(501.1, 20.4, 26.2),
            0.821 * lobe(568.8, 46.9, 40.5) + 0.286 * lobe(530.9, 16.3, 31.1),
            1.217 * lobe(437.0, 11.8, 36.0) + 0.681 * lobe(459.0, 26.0, 13.8),
        ]
        .map(|c| c * planck * lines)
    }

    fn colour(count: usize) -> (Colour, Wavelengths) {
        let wavelengths = Wavelengths::visible(count).expect("valid");
        (Colour::weigh(wavelengths.nm(), |nm| Ok(light(nm).map(Ok))).expect("no table"), wavelengths)
    }

    fn xyz(count: usize, f: impl Fn(f64) -> f64) -> [f64; 3] {
        let (colour, wavelengths) = colour(count);
        colour.xyz(&wavelengths.nm().iter().map(|&nm| f(nm)).collect::<Vec<_>>())
    }

    fn worst(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|c| (a[c] / b[c] - 1.0).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn uneven_wavelengths_do_not_amplify() {
        // The largest sum of |l_i| of a cubic through even nodes is 1.63, at the ends.
        for nodes in [[400.0, 550.0, 551.0, 552.0], [300.0, 301.0, 302.0, 1000.0], [400.0, 410.0, 440.0, 470.0]] {
            for k in 0..=1400 {
                let (_, values, used) = cardinals(&nodes, 300.0 + 0.5 * f64::from(k));
                let (sum, size) = values[..used].iter().fold((0.0, 0.0), |(s, a), v| (s + v, a + v.abs()));
                assert!((sum - 1.0).abs() < 1e-12 && size < 3.0, "{nodes:?}: {values:?}");
            }
        }
    }

    #[test]
    fn sixteen_wavelengths_integrate_a_molecular_sky_like_401() {
        let rayleigh = |nm: f64| (nm / 550.0).powi(-4);
        // Cubic interpolation at h = 27 nm: f'''' h^4 3/128 = 4e-4 f at 400 nm in the middle of
        // an interval, 2/3 of that on average. 1.6e-4 measured, in Z.
        let error = worst(xyz(16, rayleigh), xyz(401, rayleigh));
        assert!(error < 2e-4, "{error}");
        // Nine nodes, 50 nm apart: (50/27)^4 = 12 times that.
        let error = worst(xyz(9, rayleigh), xyz(401, rayleigh));
        assert!(error < 2.5e-3, "{error}");
    }

    #[test]
    fn holding_the_ends_of_the_spectrum_costs_little() {
        // Reference: nodes over all the observer's range.
        let nodes: Vec<f64> = (0..=470).map(|i| 360.0 + f64::from(i)).collect();
        let all = Colour::weigh(&nodes, |nm| Ok(light(nm).map(Ok))).expect("no table");
        let exact = all.xyz(&nodes.iter().map(|nm| (nm / 550.0).powi(-4)).collect::<Vec<_>>());
        // Beyond 380 and 780 nm lies 1e-4 of the observer's response, and f changes by a quarter at most.
        let error = worst(xyz(401, |nm| (nm / 550.0).powi(-4)), exact);
        assert!(error < 1e-4, "{error}");
    }

    #[test]
    fn a_constant_factor_gives_the_same_colour_from_any_number_of_wavelengths() {
        let reference = xyz(401, |_| 0.3);
        for count in [1, 2, 3, 4, 5, 16, 40] {
            // The interpolating functions sum to one: rounding only.
            assert!(worst(xyz(count, |_| 0.3), reference) < 1e-12, "{count}");
        }
    }

    #[test]
    fn interpolation_is_exact_for_cubics_on_uneven_nodes() {
        let nodes = [300.0, 340.0, 380.0, 450.0, 540.0, 640.0];
        let cubic = |x: f64| 1.0 + x * (2.0 - x * (3.0 - 0.5 * x));
        for x in [301.0, 345.0, 379.0, 420.0, 500.0, 600.0, 639.0] {
            let (first, values, used) = cardinals(&nodes, x);
            let got: f64 = (0..used).map(|i| values[i] * cubic(nodes[first + i] / 500.0)).sum();
            assert!((got - cubic(x / 500.0)).abs() < 1e-12, "{got} at {x}");
        }
    }

    #[test]
    fn the_matrix_belongs_to_the_primaries_and_the_white() {
        let xyz = |(x, y): (f64, f64), luminance: f64| [x / y, 1.0, (1.0 - x - y) / y].map(|v| v * luminance);
        // The matrix has ten decimals.
        let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-9);
        assert!(close(linear_srgb(xyz((0.3127, 0.3290), 1.0)), [1.0; 3]));
        for (i, primary) in [(0.64, 0.33), (0.30, 0.60), (0.15, 0.06)].into_iter().enumerate() {
            let mut unit = [0.0; 3];
            unit[i] = 1.0;
            let rgb = linear_srgb(xyz(primary, LUMINANCE[i]));
            assert!(close(rgb, unit), "{rgb:?}");
        }
        assert!((luminance([1.0; 3]) - 1.0).abs() < 1e-9);
        let there_and_back = linear_srgb(super::xyz([0.2, -0.1, 0.7]));
        assert!(close(there_and_back, [0.2, -0.1, 0.7]), "{there_and_back:?}");
    }
}
