//! From radiance factors to colour.

use super::{Between, Wavelengths};
use tables::TableError;
use tables::units::LUMINOUS_EFFICACY_LM_W;
use tables::views::{Observer, OzoneCrossSection, Sun};

/// Weights that turn simulated radiance factors into CIE XYZ.
///
/// A radiance factor f = L / E is spectral radiance L (W m^-2 sr^-1 nm^-1) over the
/// sun's spectral irradiance E (W m^-2 nm^-1) above the atmosphere, in sr^-1. It is
/// smooth in wavelength where L, which has the Fraunhofer lines, is not; so f is
/// estimated between the simulated wavelengths ([`Between`]) and E is not sampled but integrated:
///
/// X_c = 683 lm/W * integral of f(lambda) E(lambda) c(lambda) d lambda, c = x-bar, y-bar, z-bar,
///     = sum_i w_ci f_i, w_ci = 683 * integral of l_i E c d lambda,
///
/// l_i being what f is elsewhere if it is 1 at wavelength i and 0 at the others.
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
    /// The weights for radiance factors at `wavelengths` under `sun`, through air with ozone that absorbs so, as `observer` sees.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] if a table refuses a wavelength of 360 to 830 nm, or the cross-section one of `wavelengths`.
    pub fn new(
        sun: &Sun,
        observer: &Observer,
        ozone: &OzoneCrossSection,
        wavelengths: &Wavelengths,
    ) -> Result<Self, TableError> {
        let [x, y, z] = Between::new(ozone, wavelengths.nm())?.integral(Self::terms(sun, observer)?)?;
        Ok(Self { weights: (0..x.len()).map(|i| [x[i], y[i], z[i]]).collect() })
    }

    /// The integral as a sum: wavelengths in nm, and what a radiance factor of 1 sr^-1 at each adds to X, Y and Z.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] if a table refuses a wavelength of 360 to 830 nm.
    pub fn terms(sun: &Sun, observer: &Observer) -> Result<Vec<(f64, [f64; 3])>, TableError> {
        let term = |k: u32| {
            let wavelength_nm = FIRST_NM + STEP_NM * f64::from(k);
            let share = LUMINOUS_EFFICACY_LM_W * if k == 0 || k == STEPS { 0.5 * STEP_NM } else { STEP_NM };
            let light = share * sun.irradiance_w_m2_nm.at(wavelength_nm)?;
            let [x, y, z] = &observer.matching;
            let seen = [x.at(wavelength_nm)?, y.at(wavelength_nm)?, z.at(wavelength_nm)?];
            Ok((wavelength_nm, seen.map(|c| c * light)))
        };
        (0..=STEPS).map(term).collect()
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
    use crate::data::Data;
    use std::path::Path;
    use tables::units::DOBSON_UNIT_M2;

    fn data() -> Data {
        Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables")
    }

    fn colour(data: &Data, count: usize) -> (Colour, Wavelengths) {
        let wavelengths = Wavelengths::visible(count).expect("valid");
        let colour = Colour::new(&data.sun, &data.observer, &data.ozone_cross_section, &wavelengths);
        (colour.expect("in range"), wavelengths)
    }

    fn xyz(data: &Data, count: usize, f: impl Fn(f64) -> f64) -> [f64; 3] {
        let (colour, wavelengths) = colour(data, count);
        colour.xyz(&wavelengths.nm().iter().map(|&nm| f(nm)).collect::<Vec<_>>())
    }

    /// With f wherever it is asked for.
    fn integrated(data: &Data, f: impl Fn(f64) -> f64) -> [f64; 3] {
        let terms = Colour::terms(&data.sun, &data.observer).expect("in range");
        terms.into_iter().fold([0.0; 3], |sum, (nm, seen)| std::array::from_fn(|c| sum[c] + f(nm) * seen[c]))
    }

    fn worst(a: [f64; 3], b: [f64; 3]) -> f64 {
        (0..3).map(|c| (a[c] / b[c] - 1.0).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn few_wavelengths_integrate_a_molecular_sky() {
        let (data, rayleigh) = (data(), |nm: f64| (nm / 550.0).powi(-4));
        let exact = integrated(&data, rayleigh);
        // Most in Z, which few wavelengths see: 0.28, 0.053 and 0.005 % found.
        for (count, most) in [(8, 4e-3), (16, 8e-4), (41, 1e-4)] {
            let error = worst(xyz(&data, count, rayleigh), exact);
            assert!(error < most, "{count}: {error}");
        }
    }

    #[test]
    fn sixteen_wavelengths_integrate_twilight() {
        // Blue by ozone: 4000 Dobson units, and three columns of air, after single scattering.
        let data = data();
        let twilight = |nm: f64| {
            let sigma = data.ozone_cross_section.cross_section_m2(nm, 230.0).expect("in range");
            (nm / 550.0).powi(-4) * (-4000.0 * DOBSON_UNIT_M2 * sigma - 3.0 * 0.0975 * (nm / 550.0).powi(-4)).exp()
        };
        let exact = integrated(&data, twilight);
        // Found: 0.10 and 0.017 %. (Cubics between sixteen are off by 1.9 % of luminance in such skies: `airlight study wavelengths`.)
        let (eight, sixteen) = (worst(xyz(&data, 8, twilight), exact), worst(xyz(&data, 16, twilight), exact));
        assert!(eight < 0.002 && sixteen < 4e-4, "{eight} {sixteen}");
    }

    #[test]
    fn a_constant_factor_gives_the_same_colour_from_any_number_of_wavelengths() {
        let data = data();
        let exact = integrated(&data, |_| 0.3);
        for count in [1, 2, 3, 4, 5, 16, 40, 200] {
            // Its weights have the right sum: rounding only.
            let error = worst(xyz(&data, count, |_| 0.3), exact);
            assert!(error < 1e-12, "{count}: {error}");
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
