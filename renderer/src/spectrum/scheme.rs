//! From how few wavelengths, and how they become colour.

use super::{Colour, Wavelengths, linear_srgb, xyz};
use serde::{Deserialize, Serialize};
use tables::TableError;
use tables::units::LUMINOUS_EFFICACY_LM_W;
use tables::views::{Observer, OzoneCrossSection, Sun};

/// How radiance at a few wavelengths becomes colour, with any transport method.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Scheme {
    #[default]
    /// The scene's wavelengths, integrated with the sun's spectrum and the eye's response
    Spectral,
    /// 475, 510 and 650 nm stand for blue, green and red
    Rgb,
    /// 430, 490, 560 and 630 nm, by a published matrix
    Four,
}

/// Blue, green and red in nm: the wavelengths of Elek 2009, "Rendering parametrizable planetary atmospheres with multiple scattering in real-time",
/// whose Rayleigh coefficients 6.55, 17.3 and 23.0 x 10^-6 m^-1 go as (650, 510, 475 nm)^-4, and to which Elek & Kmoch 2010 compare spectra.
const RGB_NM: [f64; 3] = [475.0, 510.0, 650.0];

/// In nm, increasing.
const FOUR_NM: [f64; 4] = [430.0, 490.0, 560.0, 630.0];

/// Linear sRGB in W m^-2 sr^-1 of a spectral radiance of 1 W m^-2 sr^-1 nm^-1 at each of [`FOUR_NM`], and the sun's irradiance in W m^-2 nm^-1 that
/// goes with it: F. Garcia Linan 2023, "Production sky rendering" (shadertoy.com/view/msXXDS, MIT), constants `M` and
/// `sun_spectral_irradiance`.
const FOUR_SRGB: [[f64; 3]; 4] = [
    [8.572_844_237_945_445, -11.103_384_660_054_624, 117.475_852_775_664_78],
    [-38.914_283_926_142_75, 34.316_654_714_698_16, 29.890_448_071_976_28],
    [32.549_094_028_629_234, 91.298_014_171_997_85, -12.005_406_444_382_531],
    [137.672_389_239_975, -8.632_904_716_299_537, -1.718_156_739_193_137_2],
];
const FOUR_SUN: [f64; 4] = [1.307, 1.986, 1.828, 1.679];

impl Scheme {
    /// The wavelengths that it takes; none if it takes any.
    #[must_use]
    pub fn wavelengths(self) -> Option<Wavelengths> {
        let nm = match self {
            Self::Spectral => return None,
            Self::Rgb => RGB_NM.to_vec(),
            Self::Four => FOUR_NM.to_vec(),
        };
        // Increasing and in the range of the data: `schemes_have_wavelengths`.
        Wavelengths::new(nm).ok()
    }

    /// Its word in scene files and flags.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Spectral => "spectral",
            Self::Rgb => "rgb",
            Self::Four => "four",
        }
    }

    /// What colour radiance factors at `wavelengths` have, which are the scheme's own if it has any.
    ///
    /// `Rgb`: each is a primary of sRGB as bright as that of the sun above the air, so that a white cloud has the sun's own colour.
    ///
    /// # Errors
    /// As [`Colour::new`].
    pub fn colour(
        self,
        sun: &Sun,
        observer: &Observer,
        ozone: &OzoneCrossSection,
        wavelengths: &Wavelengths,
    ) -> Result<Colour, TableError> {
        match self {
            Self::Spectral => Colour::new(sun, observer, ozone, wavelengths),
            Self::Rgb => {
                let [red, green, blue] =
                    linear_srgb(Colour::new(sun, observer, ozone, &Wavelengths::default())?.white());
                Ok(Colour::weighed(vec![xyz([0.0, 0.0, blue]), xyz([0.0, green, 0.0]), xyz([red, 0.0, 0.0])]))
            }
            Self::Four => {
                let of = |(row, sun): (&[f64; 3], f64)| xyz(row.map(|v| LUMINOUS_EFFICACY_LM_W * sun * v));
                Ok(Colour::weighed(FOUR_SRGB.iter().zip(FOUR_SUN).map(of).collect()))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Data;
    use std::path::Path;

    fn xyz_of(scheme: Scheme, wavelengths: &Wavelengths, f: impl Fn(f64) -> f64) -> [f64; 3] {
        let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
        let colour =
            scheme.colour(&data.sun, &data.observer, &data.ozone_cross_section, wavelengths).expect("in range");
        colour.xyz(&wavelengths.nm().iter().map(|&nm| f(nm)).collect::<Vec<_>>())
    }

    #[test]
    fn schemes_have_wavelengths() {
        assert_eq!(Scheme::Rgb.wavelengths().map(|w| w.nm().len()), Some(3));
        assert_eq!(Scheme::Four.wavelengths().map(|w| w.nm().len()), Some(4));
        assert_eq!(Scheme::Spectral.wavelengths(), None);
    }

    #[test]
    fn few_wavelengths_come_near_to_the_colour_of_a_blue_sky() {
        let many = Wavelengths::visible(81).expect("valid");
        let rayleigh = |nm: f64| (nm / 550.0).powi(-4);
        let exact = xyz_of(Scheme::Spectral, &many, rayleigh);
        // What each is off by in luminance, found: 8 and 26 % (a green of 510 nm is too blue).
        for (scheme, least, most) in [(Scheme::Four, 0.02, 0.12), (Scheme::Rgb, 0.15, 0.35)] {
            let found = xyz_of(scheme, &scheme.wavelengths().expect("few"), rayleigh);
            let off = (found[1] / exact[1] - 1.0).abs();
            assert!((least..most).contains(&off), "{}: {found:?} for {exact:?}", scheme.name());
        }
    }

    #[test]
    fn red_green_and_blue_of_a_white_cloud_are_the_suns() {
        let exact = xyz_of(Scheme::Spectral, &Wavelengths::default(), |_| 0.2);
        let found = xyz_of(Scheme::Rgb, &Scheme::Rgb.wavelengths().expect("three"), |_| 0.2);
        // The matrix to sRGB and back has ten decimals.
        assert!((0..3).all(|i| (found[i] / exact[i] - 1.0).abs() < 1e-8), "{found:?} for {exact:?}");
    }
}
