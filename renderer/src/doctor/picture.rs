//! What a picture shows of itself.

use super::{Finding, Trouble};
use crate::film::{Channels, tone};
use crate::spectrum::luminance;

/// Shares of the pixels from which on they are the picture.
const BLOWN: f64 = 0.05;
const DARK: f64 = 0.5;

/// Luminance over display white that is still told from black in eight bits, and that of the sun's disc, which is to be white.
const BLACK: f64 = 1.0 / 255.0 / 12.92;
const DISC_CD_M2: f64 = 1e7;

/// Noise that is seen.
const NOISE: f64 = 0.05;

/// The numbers of a picture that tell what is wrong.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// Exposure that its PNG has, EV at ISO 100.
    pub exposure_ev: f64,
    /// Samples of each pixel, the fewest, if it says so.
    pub samples: Option<f64>,
    /// Whether it was made without noise.
    pub noiseless: bool,
    /// Whether it was stopped before its end.
    pub stopped: bool,
}

/// What is wrong with a picture.
///
/// # Errors
/// A sentence, if it has no R, G and B.
pub fn of_picture(channels: &Channels, seen: &Seen) -> Result<Vec<Finding>, String> {
    let rgb = channels.rgb().ok_or("a picture without the channels R, G and B")?;
    let all: Vec<f64> = rgb.into_iter().map(luminance).collect();
    let finite: Vec<f64> = all.iter().copied().filter(|y| y.is_finite()).collect();
    let mut found = Vec::new();
    let broken = all.len() - finite.len();
    if broken > 0 {
        let first = all.iter().position(|y| !y.is_finite()).unwrap_or(0);
        let (x, y) = (first % channels.size.0, first / channels.size.0);
        let what = format!("{broken} pixels are not finite, the first of them {x},{y}");
        found.push(Finding::new(
            Trouble::Broken,
            what,
            format!("airlight render PICTURE --pixel {x},{y} prints its samples"),
        ));
    }
    let lit: Vec<f64> = finite.iter().copied().filter(|y| *y > 0.0).collect();
    if lit.is_empty() {
        let what = format!("none of {} pixels has any light", all.len());
        found.push(Finding::new(
            Trouble::Black,
            what,
            "look elsewhere, or raise the sun: airlight doctor SCENE says which",
        ));
        return Ok(found);
    }
    found.extend(exposure(&lit, seen));
    found.extend(noise(channels, &all, seen));
    Ok(found)
}

/// Pixels that the PNG shows as white or black.
fn exposure(lit: &[f64], seen: &Seen) -> Vec<Finding> {
    let white = tone::white_cd_m2(seen.exposure_ev);
    let share = |count: usize| count as f64 / lit.len() as f64;
    let right = tone::automatic_ev(lit.iter().copied().filter(|y| *y < DISC_CD_M2));
    let remedy = format!("--exposure {right:.1}");
    let mut found = Vec::new();
    let blown = share(lit.iter().filter(|y| **y > white && **y < DISC_CD_M2).count());
    if blown > BLOWN {
        let what = format!("{:.0} % of the pixels are brighter than white, which is {white:.3e} cd/m2", 100.0 * blown);
        found.push(Finding::new(Trouble::BlownOut, what, remedy.clone()));
    }
    let dark = share(lit.iter().filter(|y| **y < BLACK * white).count());
    if dark > DARK {
        let what = format!(
            "{:.0} % of the pixels are darker than the PNG can tell from black, {:.3e} cd/m2",
            100.0 * dark,
            BLACK * white
        );
        found.push(Finding::new(Trouble::Black, what, remedy));
    }
    found
}

/// The standard error beside the light.
fn noise(channels: &Channels, all: &[f64], seen: &Seen) -> Option<Finding> {
    let errors = channels.samples.get("error.Y").filter(|_| !seen.noiseless)?;
    // Where nothing is shown both are 0.
    let pairs = all.iter().zip(errors).filter(|(y, error)| y.is_finite() && (**y > 0.0 || **error > 0.0));
    let known: Vec<(f64, f64)> = pairs.map(|(y, error)| (*y, f64::from(*error))).collect();
    if known.iter().any(|(_, error)| !error.is_finite()) {
        let what = "some pixels have fewer than two blocks of samples: their error is not known";
        return Some(Finding::new(Trouble::Noisy, what, "more samples: --spp 64"));
    }
    let count = known.len().max(1) as f64;
    let mean = known.iter().map(|(y, _)| y).sum::<f64>() / count;
    let rms = (known.iter().map(|(_, error)| error * error).sum::<f64>() / count).sqrt() / mean;
    let samples = seen.samples.unwrap_or(1.0);
    let stopped = if seen.stopped { "; it was stopped early" } else { "" };
    let what =
        format!("the noise is {:.1} % of the mean luminance (rms) with {samples:.0} samples{stopped}", 100.0 * rms);
    let needed = (samples * (rms / NOISE).powi(2)).ceil();
    let remedy = format!("--spp {needed} for {} %, or solved tables, which have none", 100.0 * NOISE);
    (rms > NOISE).then(|| Finding::new(Trouble::Noisy, what, remedy))
}
