//! A method beside what is right.

use super::Found;
use super::reference::{Right, WAVELENGTHS};
use super::scenes::Setting;
use crate::data::Data;
use crate::film::tone;
use crate::render::{RenderError, Sky};
use crate::sampling::Sampler;
use crate::scene::Scene;
use crate::spectrum::{Wavelengths, ciede2000};
use glam::DVec3;
use std::time::Instant;

/// Errors and costs of a setting on the scenes of one air and ground; nothing where it does not cover one.
pub(super) fn measure(
    data: &Data,
    setting: &Setting,
    scenes: &[Scene],
    right: &[Right],
    step: &dyn Fn(),
) -> Result<Vec<Option<Found>>, RenderError> {
    let mut kept: Option<(Sky, f64)> = None;
    let mut found = Vec::new();
    for (scene, right) in scenes.iter().zip(right) {
        let scene = setting.of(scene);
        found.push(of_scene(data, &scene, right, &mut kept)?);
        step();
    }
    Ok(found)
}

fn of_scene(
    data: &Data,
    scene: &Scene,
    right: &Right,
    kept: &mut Option<(Sky, f64)>,
) -> Result<Option<Found>, RenderError> {
    if scene.validate().is_err() {
        return Ok(None);
    }
    // What belongs to the atmosphere is made once: of one pixel, so that nothing is looked at yet. A fitted sky belongs to its sun.
    if kept.is_none() || scene.method.is_dome() {
        let start = Instant::now();
        match Sky::new(&Scene { width: Some(1), height: Some(1), ..scene.clone() }, data) {
            Ok(sky) => *kept = Some((sky, start.elapsed().as_secs_f64())),
            Err(error) => return refused(error),
        }
    }
    let Some((sky, tables_s)) = kept.as_mut() else { return Ok(None) };
    let start = Instant::now();
    if !scene.method.is_dome()
        && let Err(error) = sky.turn(scene)
    {
        return refused(error);
    }
    let samples = if sky.is_noiseless() { 1 } else { scene.spp.unwrap_or(scene.default_spp()) };
    let directions = right.pixels.iter().map(|(direction, _)| *direction);
    let picture: Vec<[f64; 3]> =
        directions.enumerate().map(|(i, direction)| sky.colour().xyz(&look(sky, direction, i, samples))).collect();
    let picture_s = start.elapsed().as_secs_f64();
    let seen: Vec<Vec<f64>> = right
        .directions
        .iter()
        .enumerate()
        .map(|(i, direction)| look(sky, *direction, right.pixels.len() + i, samples))
        .collect();
    let (difference, exposure_ev) = appearance(&picture, right);
    Ok(Some(Found {
        radiance: radiance(&seen, scene, right),
        luminance_rms: luminance(&seen, sky, right),
        ciede2000: difference,
        exposure_ev,
        tables_s: *tables_s,
        picture_s,
        bytes: sky.bytes(),
    }))
}

/// A method that does not cover a scene has nothing; any other failure is one.
fn refused(error: RenderError) -> Result<Option<Found>, RenderError> {
    match error {
        RenderError::Refused(_) | RenderError::Solve(_) => Ok(None),
        other => Err(other),
    }
}

/// Mean of that many samples of a direction.
fn look(sky: &Sky, direction: DVec3, pixel: usize, samples: u32) -> Vec<f64> {
    let mut sum = vec![0.0; sky.wavelengths()];
    let mut factors = sum.clone();
    for sample in 0..samples {
        sky.radiance(direction, &Sampler::sobol(1, pixel as u64, 0, sample), &mut factors);
        sum.iter_mut().zip(&factors).for_each(|(sum, factor)| *sum += factor / f64::from(samples));
    }
    sum
}

/// Rms over the means, and the worst direction, at wavelengths that the reference has too.
fn radiance(seen: &[Vec<f64>], scene: &Scene, right: &Right) -> Option<[f64; 2]> {
    let count = scene.wavelengths().nm().len();
    let even = Wavelengths::visible(count).is_ok_and(|even| even == scene.wavelengths());
    if !even || scene.method.is_dome() || !(WAVELENGTHS - 1).is_multiple_of(count - 1) {
        return None;
    }
    let stride = (WAVELENGTHS - 1) / (count - 1);
    let directions = seen.len() as f64;
    let (mut squares, mut lit) = (0.0, 0.0);
    for j in 0..count {
        let mean = right.radiances.iter().map(|r| r[stride * j]).sum::<f64>() / directions;
        if mean > 0.0 {
            let off = |(a, b): (&Vec<f64>, &Vec<f64>)| (a[j] - b[stride * j]).powi(2);
            squares += seen.iter().zip(&right.radiances).map(off).sum::<f64>() / (directions * mean * mean);
            lit += 1.0;
        }
    }
    let worst = seen.iter().zip(&right.radiances).map(|(a, b)| {
        let off = |j: usize| if b[stride * j] > 0.0 { a[j] / b[stride * j] - 1.0 } else { 0.0 };
        ((0..count).map(off).sum::<f64>() / count as f64).abs()
    });
    Some([(squares / lit).sqrt(), worst.fold(0.0, f64::max)])
}

/// Rms of luminance over its mean.
fn luminance(seen: &[Vec<f64>], sky: &Sky, right: &Right) -> f64 {
    let mean = right.colours.iter().map(|xyz| xyz[1]).sum::<f64>() / right.colours.len() as f64;
    let off = |(seen, right): (&Vec<f64>, &[f64; 3])| (sky.colour().xyz(seen)[1] - right[1]).powi(2);
    (seen.iter().zip(&right.colours).map(off).sum::<f64>() / right.colours.len() as f64).sqrt() / mean
}

/// Mean CIEDE2000 of the pictures as they would be shown, both exposed for the right one, and that exposure.
fn appearance(picture: &[[f64; 3]], right: &Right) -> (f64, f64) {
    let lit: Vec<f64> = right.pixels.iter().map(|(_, xyz)| xyz[1]).filter(|y| *y > 0.0).collect();
    let white = tone::automatic_white(&lit);
    let shown = |colour: [f64; 3]| tone::displayed(colour, white);
    let differences = picture.iter().zip(&right.pixels).filter(|(_, (_, exact))| exact[1] > 0.0);
    let sum: f64 = differences.map(|(found, (_, exact))| ciede2000(shown(*found), shown(*exact))).sum();
    (sum / lit.len() as f64, (white / tone::white_cd_m2(0.0)).log2())
}
