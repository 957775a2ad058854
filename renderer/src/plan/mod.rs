//! Plans: the cheapest way to make a picture within an error, by stored measurements.
//!
//! `airlight study plans` measures, on scenes spread over suns, observers, grounds and aerosols, what every [`Candidate`] is off and costs.
//! From these measurements ([`Measured`]) errors and costs of another scene are predicted ([`Prediction`]), and [`Plan::of`] takes the cheapest
//! candidate that is predicted to meet the error, with a margin found by leaving each measured atmosphere out in turn.

mod atlas;
mod candidates;
mod evidence;
mod kriging;
mod measured;
mod outside;
mod predict;
#[cfg(test)]
mod tests;

pub use atlas::{Atlas, Difference};
pub use candidates::{Candidate, SPECTRUM, Spectrum, TRANSFERS, Transfer};
pub use evidence::{ASKED, Evidence, margins};
pub use measured::{Costs, Measured, Row};
pub use outside::outside;
pub use predict::{Plan, Prediction, Safe};

use crate::atmosphere::Haze;
use crate::render::Sky;
use crate::scene::{Albedo, Scene};
use serde::{Deserialize, Serialize};
use tables::units::{EARTH_RADIUS_M, KM};
use tables::views::Biome;

/// What an error is of. Each is a root mean square over directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum)]
#[serde(rename_all = "kebab-case")]
pub enum Metric {
    /// Spectral radiance at sixteen wavelengths from 380 to 780 nm, relative to its mean over the sky at each
    Radiance,
    /// Luminance, relative to its mean over the sky
    Luminance,
    /// Colour as a picture shows it, in units of CIEDE2000
    Colour,
}

impl Metric {
    /// All of them, in the order of [`Row::errors`].
    pub const ALL: [Self; 3] = [Self::Radiance, Self::Luminance, Self::Colour];

    /// Its word.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Radiance => "radiance",
            Self::Luminance => "luminance",
            Self::Colour => "colour",
        }
    }

    /// An error in words: percent, or units of CIEDE2000.
    #[must_use]
    pub fn show(self, error: f64) -> String {
        let digits = |value: f64| match value {
            v if v >= 10.0 => format!("{v:.0}"),
            v if v >= 1.0 => format!("{v:.1}"),
            v if v >= 0.1 => format!("{v:.2}"),
            v => format!("{v:.3}"),
        };
        match self {
            Self::Colour => format!("{} CIEDE2000", digits(error)),
            _ => format!("{} %", digits(100.0 * error)),
        }
    }
}

/// From above this altitude one looks all around, from below it above the horizon: where errors are measured.
pub const HIGH_KM: f64 = 1.0;

/// What errors and costs of a scene depend on, as far as the measurements tell scenes apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Traits {
    /// Kind of aerosol, or none.
    pub biome: Option<Biome>,
    /// Its vertical optical depth at 550 nm.
    pub optical_depth: f64,
    /// Elevation of the sun in degrees.
    pub sun_elevation_deg: f64,
    /// Altitude of the observer in km.
    pub altitude_km: f64,
    /// Albedo of the ground, the mean over its wavelengths.
    pub albedo: f64,
    /// Ozone in Dobson units.
    pub ozone_du: f64,
}

impl Traits {
    /// Of a scene; `sky` has its air and ground, whatever its method.
    #[must_use]
    pub fn of(scene: &Scene, sky: &Sky) -> Self {
        let albedo = match scene.albedo {
            Albedo::Grey(albedo) => albedo,
            Albedo::Ground(_) | Albedo::Spectrum(_) => sky.albedo().iter().sum::<f64>() / sky.albedo().len() as f64,
        };
        Self {
            biome: scene.biome,
            optical_depth: sky.air().haze().map_or(0.0, Haze::optical_depth),
            sun_elevation_deg: scene.sun_elevation_deg,
            altitude_km: scene.altitude_km,
            albedo,
            ozone_du: sky.air().ozone_du(),
        }
    }

    /// Coordinates in which errors are smooth, each in units of the distance over which they change: elevation of the sun, finest at the
    /// horizon; amount of aerosol; albedo; altitude in the air, and whether the ground is looked at from there; how much of the planet is seen, by
    /// the angle at its middle to its horizon; ozone.
    #[must_use]
    pub fn coordinates(&self) -> [f64; 7] {
        const TOP_KM: f64 = 120.0;
        const PLANET_KM: f64 = EARTH_RADIUS_M / KM;
        let seen = (PLANET_KM / (PLANET_KM + self.altitude_km)).acos();
        [
            ((self.sun_elevation_deg + 1.0) / 3.0).asinh(),
            (self.optical_depth / 0.05).ln_1p(),
            0.75 * self.albedo,
            1.05 * (self.altitude_km.min(TOP_KM) / 2.0).ln_1p(),
            0.7 * f64::from(u8::from(self.altitude_km > HIGH_KM)),
            seen.to_degrees() / 30.0,
            0.2 * self.ozone_du / 100.0,
        ]
    }

    /// Distance to another scene in these coordinates.
    fn distance(&self, other: &Self) -> f64 {
        let (x, y) = (self.coordinates(), other.coordinates());
        x.iter().zip(y).map(|(x, y)| (x - y).powi(2)).sum::<f64>().sqrt()
    }
}
