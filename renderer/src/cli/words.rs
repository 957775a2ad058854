//! What the values of flags may be.

use crate::atmosphere::{HazePhase, OzoneSource};
use crate::cases::{self, Tier};
use crate::plan::Metric;
use crate::render::Shard;
use crate::scene::word;
use crate::transport::{Estimator, Method};
use clap::ValueEnum;
use std::time::Duration;
use tables::views::Biome;

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum MethodName {
    /// Solved tables, with the error that they state
    Solved,
    /// Fans that end in the usual solved tables: unbiased
    Certified,
    /// Paths on column tables
    Paths,
    /// The brute-force judge
    Judge,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum RenderMethod {
    /// Solved tables: without noise, and they state their error
    Solved,
    /// Paths on column tables: unbiased
    Paths,
    /// The brute-force judge
    Judge,
    /// An isotropic closure of all orders but the first (Hillaire 2020)
    Isotropic,
    /// Light scattered once (Nishita et al. 1993)
    Single,
    /// O'Neil's exponential planet (2005): sun up, on the ground
    Oneil,
    /// Hosek & Wilkie's fitted clear sky (2012): sun up, on the ground, turbidity 1 to 10
    HosekWilkie,
    /// Preetham et al.'s fitted clear sky (1999): sun up, on the ground, turbidity 2 to 6
    Preetham,
    /// Perez et al.'s all-weather luminance (1993): sun above 1 degree, on the ground
    Perez,
    /// The CIE's standard skies' luminance (2003): sun up, on the ground
    Cie,
}

impl From<RenderMethod> for Method {
    fn from(name: RenderMethod) -> Self {
        match name {
            RenderMethod::Solved => Self::Solved,
            RenderMethod::Paths => Self::Paths,
            RenderMethod::Judge => Self::Judge,
            RenderMethod::Isotropic => Self::Isotropic,
            RenderMethod::Single => Self::Single,
            RenderMethod::Oneil => Self::Oneil,
            RenderMethod::HosekWilkie => Self::HosekWilkie,
            RenderMethod::Preetham => Self::Preetham,
            RenderMethod::Perez => Self::Perez,
            RenderMethod::Cie => Self::Cie,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum EstimatorName {
    Paths,
    Judge,
}

impl From<EstimatorName> for Estimator {
    fn from(name: EstimatorName) -> Self {
        match name {
            EstimatorName::Paths => Self::Paths,
            EstimatorName::Judge => Self::Judge,
        }
    }
}

impl From<MethodName> for cases::Method {
    fn from(name: MethodName) -> Self {
        match name {
            MethodName::Solved => Self::Solved,
            MethodName::Certified => Self::Certified,
            MethodName::Paths => Self::Sampled(Estimator::Paths),
            MethodName::Judge => Self::Sampled(Estimator::Judge),
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum TierName {
    Core,
    Full,
}

impl From<TierName> for Tier {
    fn from(name: TierName) -> Self {
        match name {
            TierName::Core => Self::Core,
            TierName::Full => Self::Full,
        }
    }
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum OzoneName {
    Ml,
    Arosa,
}

impl From<OzoneName> for OzoneSource {
    fn from(name: OzoneName) -> Self {
        match name {
            OzoneName::Ml => Self::McPetersLabow,
            OzoneName::Arosa => Self::Arosa,
        }
    }
}

#[derive(Debug, Clone, Copy, PartialEq, ValueEnum)]
pub(super) enum Switch {
    On,
    Off,
}

/// Which shard: as it is named, or as the launcher says.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum ShardName {
    Given(Shard),
    Env,
}

pub(super) fn shard(text: &str) -> Result<ShardName, String> {
    if text == "env" { Ok(ShardName::Env) } else { text.parse().map(ShardName::Given) }
}

/// A biome, or none of it.
#[derive(Debug, Clone, Copy)]
pub(super) struct BiomeName(pub(super) Option<Biome>);

pub(super) fn biome(text: &str) -> Result<BiomeName, String> {
    word::biome(text).map(BiomeName)
}

#[derive(Debug, Clone, Copy, ValueEnum)]
pub(super) enum PhaseName {
    Mie,
    Hg,
}

impl From<PhaseName> for HazePhase {
    fn from(name: PhaseName) -> Self {
        match name {
            PhaseName::Mie => Self::Mie,
            PhaseName::Hg => Self::HenyeyGreenstein,
        }
    }
}

/// A share: `1%` or `0.01`.
pub(super) fn share(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.strip_suffix('%') {
        Some(percent) => (percent, 0.01),
        None => (text, 1.0),
    };
    let value = number.trim().parse::<f64>().map_err(|_| "say 1% or 0.01".to_string())? * unit;
    // Rounded as written, so that 7% is 0.07.
    let value = format!("{value:.12}").parse().unwrap_or(value);
    if (1e-5..=1.0).contains(&value) { Ok(value) } else { Err("0.001% to 100% is possible".into()) }
}

/// An error that is asked for: as a share, and in units of CIEDE2000, of which `1` and `1%` are one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Asked {
    pub(super) share: f64,
    units: f64,
}

impl Asked {
    /// In the unit of a metric.
    pub(super) fn of(self, metric: Metric) -> f64 {
        if metric == Metric::Colour { self.units } else { self.share }
    }
}

/// As [`share`], or units of colour up to 100.
pub(super) fn asked(text: &str) -> Result<Asked, String> {
    let number = text.parse::<f64>().ok().filter(|units| (1.0..=100.0).contains(units));
    if let Some(units) = number {
        return Ok(Asked { share: units, units });
    }
    let share = share(text)?;
    Ok(Asked { share, units: if text.ends_with('%') { 100.0 * share } else { share } })
}

/// A whole number: `1000000` or `1e6`.
pub(super) fn count(text: &str) -> Result<u64, String> {
    let value = text.parse::<f64>().map_err(|_| "say 1000000 or 1e6".to_string())?;
    if (1.0..=1e15).contains(&value) && value.fract() == 0.0 {
        // Exact: below 2^53.
        Ok(value as u64)
    } else {
        Err("a whole number from 1 to 1e15 is possible".into())
    }
}

/// A time: `30s`, `5m` or `1.5h`.
pub(super) fn time(text: &str) -> Result<Duration, String> {
    let units = [("s", 1.0), ("m", 60.0), ("h", 3600.0)];
    let found = units.into_iter().find_map(|(unit, seconds)| Some((text.strip_suffix(unit)?, seconds)));
    let (number, unit) = found.ok_or("say 30s, 5m or 1.5h")?;
    let seconds = number.trim().parse::<f64>().map_err(|_| "say 30s, 5m or 1.5h".to_string())? * unit;
    if !(1.0..=3.6e6).contains(&seconds) {
        return Err("1s to 1000h is possible".into());
    }
    Duration::try_from_secs_f64(seconds).map_err(|error| error.to_string())
}

/// A pixel: `412,97`.
pub(super) fn pixel(text: &str) -> Result<(u32, u32), String> {
    let parts = text.split_once(',').ok_or("say X,Y")?;
    let number = |part: &str| part.trim().parse().map_err(|_| "say X,Y in whole numbers".to_string());
    Ok((number(parts.0)?, number(parts.1)?))
}
