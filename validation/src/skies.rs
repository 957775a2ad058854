//! Measured skies: scans of clear skies over Ithaca NY (Kider et al. 2014, ACM TOG 33(6)), 81 directions each, spectral radiance in
//! W m^-2 sr^-1 nm^-1 as means over 10 nm from 360 to 1000 nm.
//!
//! The sun, the place and the month are known. What is not is fitted, day by day, on the scans themselves: the kind of aerosol
//! (OPAC's of the `KINDS`), its optical depth at 550 nm, and one grey albedo of the ground, by the least sum of squares of relative
//! differences L_model / L_measured - 1 over scans, directions and 16 wavelengths (`FIT_NM`). The model is tabulated at some amounts and two
//! albedos; between amounts it is a polynomial, between albedos a line, so that the best albedo of an amount follows in closed form.
//! Then the fitted sky is solved afresh, polarised, and compared band by band. The spread of the fits to single scans tells how well
//! the amount and the albedo are known.
//!
//! L = f(lambda) E(lambda) / d^2: f, the radiance factor, is smooth and solved at `NM`; E is the mean irradiance of the band, d the
//! distance of the sun in au.
//!
//! Clear skies are symmetric about the sun's vertical. The scans are so about an azimuth that is up to 20 degrees from the sun's, another one
//! in each scan, while the height of the sun agrees with the brightness about it. The turn of the instrument is therefore taken from the
//! symmetry of each scan (`Turn`), before and apart from the fit.
//!
//! Water vapour and oxygen are not modelled: bands that touch `MASKED` are left out. Directions within
//! `NEAR_DEG` of the sun are left out too: there the instrument's field of view and stray light count.
//! The scan of 2013-09-24T13:20 is left out: its brightest direction lies at the horizon, away from the sun. So is the first direction of every
//! scan, which is darker than both of its neighbours on the ring by a third or more, as if the instrument still looked elsewhere.
//!
//! Summed as Bruneton 2017 (IEEE TVCG 23, 2641; arXiv 1612.04336) sums it for eight models: the root mean square over directions and
//! wavelengths of the difference of spectral radiance, 360 to 720 nm, and of several scans the root of the mean of its squares. His wavelengths
//! are other ones and his directions all 81.

mod errors;
mod scans;

use crate::beam::MASKED;
use crate::judge::signed;
use crate::references::path;
use crate::{Context, Section, ValidationError};
use rayon::prelude::*;
use renderer::render::Sky;
use renderer::sampling::Sampler;
use renderer::scene::{Albedo, Scene};
use renderer::spectrum::Wavelengths;
use renderer::transport::Fineness;
use scans::{PLACE, Scan, Turn};
use std::collections::BTreeMap;
use tables::views::Biome;

/// The scan that is left out.
const LEFT_OUT: &str = "2013-09-24T13:20:00";

/// The kinds of aerosol among which the fit chooses.
const KINDS: [Biome; 5] =
    [Biome::RemoteContinental, Biome::Rural, Biome::Urban, Biome::MaritimeClean, Biome::DesertDust];

/// Wavelengths of the fit in nm: middles of bands.
const FIT_NM: [f64; 16] =
    [360.0, 380.0, 400.0, 420.0, 450.0, 480.0, 510.0, 540.0, 570.0, 610.0, 640.0, 670.0, 750.0, 780.0, 850.0, 880.0];

/// Wavelengths at which the fitted sky is solved, in nm.
const NM: (f64, f64, usize) = (360.0, 880.0, 27);

/// Optical depths and albedos at which the model is tabulated.
const AMOUNTS: [f64; 4] = [0.03, 0.1, 0.2, 0.35];
const ALBEDOS: [f64; 2] = [0.05, 0.35];

/// Optical depths that are tried: from the first, by the step, to the last.
const TRIED: (f64, f64, f64) = (0.01, 0.002, 0.4);

/// The least angle from the sun, and the most of the scale of Bruneton's sum, in degrees and nm.
const NEAR_DEG: f64 = 5.0;
const BRUNETON_NM: f64 = 720.0;

fn scene(scan: &Scan, air: (Biome, f64, f64), nm: &[f64]) -> Result<Scene, ValidationError> {
    let (kind, aod, albedo) = air;
    Ok(Scene {
        sun_elevation_deg: scan.sun.elevation_deg,
        sun_azimuth_deg: scan.sun.azimuth_deg,
        month: scan.month()?,
        latitude_deg: PLACE.0,
        biome: Some(kind),
        aod: Some(aod),
        albedo: Albedo::Grey(albedo),
        wavelengths_nm: Wavelengths::new(nm.to_vec())?,
        width: Some(32),
        height: Some(32),
        ..Scene::default()
    })
}

/// Radiance factors in sr^-1 of the directions of some scans of one day, wavelength by wavelength.
fn factors(
    context: &Context<'_>,
    scans: &[&Scan],
    air: (Biome, f64, f64),
    nm: &[f64],
    rough: bool,
) -> Result<Vec<Vec<Vec<f64>>>, ValidationError> {
    let of = |scan: &Scan| -> Result<Scene, ValidationError> {
        let scene = scene(scan, air, nm)?;
        let (fineness, follow) = if rough { (Some(Fineness::Coarse), Some(false)) } else { (None, Some(true)) };
        Ok(Scene { fineness, follow_polarisation: follow, ..scene })
    };
    let Some(first) = scans.first() else { return Ok(Vec::new()) };
    let mut sky = Sky::new(&of(first)?, context.data)?;
    let mut all = Vec::new();
    for scan in scans {
        sky.turn(&of(scan)?)?;
        let sampler = Sampler::new(0, 0, 0);
        let seen = scan.looks.par_iter().map(|look| {
            let mut factors = vec![0.0; nm.len()];
            sky.radiance(look.direction, &sampler, &mut factors);
            factors
        });
        all.push(seen.collect());
    }
    Ok(all)
}

/// Mean irradiance of the bands in W m^-2 nm^-1 at the sun's distance.
fn irradiance(context: &Context<'_>, distance: f64, bands: &[f64]) -> Result<Vec<f64>, ValidationError> {
    let curve = &context.data.sun.irradiance_w_m2_nm;
    let mean = |&nm: &f64| {
        // Every nanometre, the ends by half.
        let sum: f64 = (-5..=5)
            .map(|i: i32| Ok(if i.abs() == 5 { 0.5 } else { 1.0 } * curve.at((nm + f64::from(i)).min(1000.0))?))
            .sum::<Result<f64, tables::TableError>>()?;
        Ok(sum / 10.0 / (distance * distance))
    };
    bands.iter().map(mean).collect()
}

/// One kind of aerosol: model over measurement, less nothing, as a + albedo b at each amount.
struct Tabulated {
    /// By amount, albedo, then scan, look and wavelength in one list.
    ratios: Vec<[Vec<f64>; 2]>,
    /// Where each scan begins.
    starts: Vec<usize>,
}

/// A fit: optical depth, albedo, and the rms of the relative differences.
#[derive(Debug, Clone, Copy)]
struct Fit {
    aod: f64,
    albedo: f64,
    rms: f64,
}

impl Tabulated {
    /// The best amount and albedo for a range of scans.
    fn fit(&self, scans: std::ops::Range<usize>) -> Fit {
        let range = self.starts[scans.start]..self.starts[scans.end];
        let tried = ((TRIED.2 - TRIED.0) / TRIED.1).round() as u32;
        let fits = (0..=tried).into_par_iter().map(|i| self.at(TRIED.0 + TRIED.1 * f64::from(i), range.clone()));
        let none = || Fit { aod: 0.0, albedo: 0.0, rms: f64::INFINITY };
        fits.reduce(none, |a, b| if (b.rms, b.aod) < (a.rms, a.aod) { b } else { a })
    }

    /// The best albedo of an amount: r = r_0 + t (r_1 - r_0) - 1 over the range, t where the sum of squares is least, albedos
    /// from 0 to 1.
    fn at(&self, aod: f64, range: std::ops::Range<usize>) -> Fit {
        let weights = lagrange(&AMOUNTS, aod);
        let (mut ab, mut bb) = (0.0, 0.0);
        let pair = |i: usize| {
            let mut sum = [0.0; 2];
            for (weight, ratios) in weights.iter().zip(&self.ratios) {
                sum[0] += weight * ratios[0][i];
                sum[1] += weight * ratios[1][i];
            }
            (sum[0] - 1.0, sum[1] - sum[0])
        };
        for i in range.clone() {
            let (a, b) = pair(i);
            ab += a * b;
            bb += b * b;
        }
        let width = ALBEDOS[1] - ALBEDOS[0];
        let albedo = (ALBEDOS[0] - width * ab / bb).clamp(0.0, 1.0);
        let t = (albedo - ALBEDOS[0]) / width;
        let squares: f64 = range.clone().map(pair).map(|(a, b)| (a + t * b).powi(2)).sum();
        Fit { aod, albedo, rms: (squares / range.len().max(1) as f64).sqrt() }
    }
}

/// Weights of the values at some nodes in the polynomial through them (Lagrange).
fn lagrange<const N: usize>(nodes: &[f64; N], x: f64) -> [f64; N] {
    std::array::from_fn(|i| (0..N).filter(|&k| k != i).map(|k| (x - nodes[k]) / (nodes[i] - nodes[k])).product())
}

/// Computes the section.
///
/// # Errors
/// [`ValidationError`] if the scans cannot be read, or a sky not be computed.
pub fn make(context: &Context<'_>) -> Result<Section, ValidationError> {
    let (mut scans, bands) = scans::read(context)?;
    let mut section = Section::default();
    section.say(&format!(
        "Compared: spectral radiance of clear skies, {} scans of {} directions over Ithaca NY on two days, means over 10 nm. Reference: Kider et al. \
         2014, which states no uncertainty; the absolute calibration of such instruments is known to some 5 %. The kind and amount of the \
         aerosol and one grey albedo of the ground are fitted to the scans of a day, so that what is compared is the shape, over the dome and over \
         wavelength, and the fit takes up errors of calibration too. Left out: bands where water vapour and oxygen absorb ({}), directions within {NEAR_DEG} \
         degrees of the sun, the first direction of every scan, which is darker than both its neighbours by a third or more, and the scan of {LEFT_OUT}, whose brightest direction is not near the sun.",
        scans.len(),
        scans.first().map_or(0, |scan| scan.looks.len()),
        MASKED.map(|(low, high)| format!("{low} to {high} nm")).join(", ")
    ));
    turns(&mut section, &mut scans, &bands);
    let mut days: BTreeMap<&str, Vec<&Scan>> = BTreeMap::new();
    for scan in &scans {
        days.entry(scan.day()).or_default().push(scan);
    }
    let mut all = Vec::new();
    let mut fits = Vec::new();
    for (k, (day, scans)) in days.iter().enumerate() {
        let progress = |share: f64| (context.progress)((k as f64 + share) / days.len() as f64);
        let (kind, fit) = fitted(context, &mut section, (day, scans), &bands, &progress)?;
        all.extend(errors::compare(context, scans, (kind, fit.aod, fit.albedo), &bands)?);
        fits.push(format!("{day}: {kind} {:.2}, albedo {:.2}", fit.aod, fit.albedo));
    }
    errors::report(&mut section, &scans, &bands, &all, &fits.join("; "));
    Ok(section)
}

/// Sets the sun of each scan in the azimuths of the file, and says how.
fn turns(section: &mut Section, scans: &mut [Scan], bands: &[f64]) {
    let mut rows = Vec::new();
    let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
    for scan in scans {
        let turn = Turn::of(scan, bands);
        rows.push(vec![
            scan.name(),
            format!("{:.1}", 90.0 - scan.sun.elevation_deg),
            format!("{:.1}", scan.sun.azimuth_deg),
            signed(turn.degrees, 0),
            format!("{:.0}", 100.0 * turn.asymmetry_as_stated),
            format!("{:.0}", 100.0 * turn.asymmetry),
        ]);
        scan.sun.azimuth_deg += turn.degrees;
        (least, most) = (least.min(turn.degrees), most.max(turn.degrees));
    }
    section.say(&format!(
        "### Which way the instrument looked\n\nA clear sky is symmetric about the sun's vertical. The scans are symmetric about an azimuth that is {} to {} degrees \
         from the sun's, clockwise. The turn of the instrument is therefore taken from the symmetry of each scan at 550 nm, with no model of the air; the sun's \
         zenith angle is that of the stated time. Asymmetry is the rms of the logarithm of left over right. Where it stays above 10 %, the sky was not clear \
         everywhere or the directions are wrong otherwise.",
        signed(least, 0),
        signed(most, 0)
    ));
    section.table(&["scan", "sun's zenith angle", "azimuth", "turn / degrees", "asymmetry % without", "with"], &rows);
}

/// Fits a day and says so.
fn fitted(
    context: &Context<'_>,
    section: &mut Section,
    (day, scans): (&str, &[&Scan]),
    bands: &[f64],
    progress: &dyn Fn(f64),
) -> Result<(Biome, Fit), ValidationError> {
    let at: Vec<usize> = FIT_NM.iter().filter_map(|nm| bands.iter().position(|band| band == nm)).collect();
    let sun = irradiance(context, scans.first().map_or(1.0, |scan| scan.sun.distance_au), &FIT_NM)?;
    let mut starts = vec![0];
    for scan in scans {
        let far = scan.looks.iter().filter(|look| scan.far(look)).count();
        starts.push(starts[starts.len() - 1] + far * FIT_NM.len());
    }
    let mut best: Option<(Biome, Fit, Tabulated)> = None;
    let mut rows = Vec::new();
    for (k, kind) in KINDS.into_iter().enumerate() {
        let mut ratios = Vec::new();
        for (i, aod) in AMOUNTS.into_iter().enumerate() {
            let mut pair = [Vec::new(), Vec::new()];
            for (list, albedo) in pair.iter_mut().zip(ALBEDOS) {
                let seen = factors(context, scans, (kind, aod, albedo), &FIT_NM, true)?;
                for (scan, seen) in scans.iter().zip(seen) {
                    for (look, seen) in scan.looks.iter().zip(seen).filter(|(look, _)| scan.far(look)) {
                        list.extend((0..FIT_NM.len()).map(|j| seen[j] * sun[j] / look.radiance[at[j]]));
                    }
                }
            }
            ratios.push(pair);
            progress(0.9 * (k as f64 + (i + 1) as f64 / AMOUNTS.len() as f64) / KINDS.len() as f64);
        }
        let tabulated = Tabulated { ratios, starts: starts.clone() };
        let fit = tabulated.fit(0..scans.len());
        rows.push(vec![
            kind.to_string(),
            format!("{:.3}", fit.aod),
            format!("{:.2}", fit.albedo),
            format!("{:.1}", 100.0 * fit.rms),
        ]);
        if best.as_ref().is_none_or(|(_, found, _)| fit.rms < found.rms) {
            best = Some((kind, fit, tabulated));
        }
    }
    let Some((kind, fit, tabulated)) = best else {
        let what = "there are no kinds of aerosol to fit".to_owned();
        return Err(ValidationError::Reference { path: path(context.root, "sky-scans.csv"), what });
    };
    section.say(&format!("### Fit of {day}\n\nThe best of each kind, {} scans together:", scans.len()));
    section.table(&["kind", "optical depth at 550 nm", "albedo", "rms of relative differences %"], &rows);
    let singles: Vec<Fit> = (0..scans.len()).map(|i| tabulated.fit(i..i + 1)).collect();
    let deviation = |value: &dyn Fn(&Fit) -> f64| {
        let mean = singles.iter().map(value).sum::<f64>() / singles.len() as f64;
        let squares: f64 = singles.iter().map(|fit| (value(fit) - mean).powi(2)).sum();
        (squares / (singles.len().max(2) - 1) as f64).sqrt()
    };
    section.say(&format!(
        "Taken: {kind}, optical depth {:.3} +- {:.3}, albedo {:.2} +- {:.2}; the uncertainty is the standard deviation of the fits to single scans of that kind.",
        fit.aod,
        deviation(&|fit| fit.aod),
        fit.albedo,
        deviation(&|fit| fit.albedo)
    ));
    if fit.albedo == 0.0 {
        section.say("The albedo stands at its limit, 0: the measured sky is darker, where the ground counts, than any ground makes it.");
    }
    Ok((kind, fit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_fit_uses_bands_without_absorption() {
        assert!(FIT_NM.iter().all(|&nm| !scans::masked(nm)));
    }

    #[test]
    fn weights_reproduce_a_cubic() {
        let cubic = |x: f64| 1.0 + x * (2.0 + x * (3.0 + x * 4.0));
        let weights = lagrange(&AMOUNTS, 0.27);
        let found: f64 = weights.iter().zip(AMOUNTS).map(|(w, x)| w * cubic(x)).sum();
        // Rounding of four terms.
        assert!((found - cubic(0.27)).abs() < 1e-12, "{found}");
    }
}
