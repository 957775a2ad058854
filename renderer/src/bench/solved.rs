//! What solved tables cost, and how far they are from the path tracer.

use super::{fisheye, medium, towards, visible};
use crate::atmosphere::{Columns, Tolerance};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::light::SunDisc;
use crate::render::RenderError;
use crate::sampling::Sampler;
use crate::transport::{self, Estimator, FINER, Panorama, Pixels, Problem, Resolution, Solved, befitting};
use glam::DVec3;
use rayon::prelude::*;
use std::time::Instant;
use tables::units::EARTH_RADIUS_M;
use tables::views::Biome;

/// Wavelengths, evenly over what is seen.
const WAVELENGTHS: usize = 16;

/// Zenith angles and azimuths of a dome that is made again and again, and how often.
const DOME: (u32, u32) = (160, 32);
const DOMES: u32 = 40;

/// Every which pixel of a picture is looked at itself.
const LOOKED_AT: usize = 23;

/// Directions of the dome: zenith angles in degrees, at this many azimuths each.
const ZENITHS: [f64; 9] = [2.0, 15.0, 30.0, 45.0, 60.0, 75.0, 83.0, 87.0, 89.5];
const AZIMUTHS: u32 = 6;

/// An atmosphere's solution.
#[derive(Debug)]
pub struct Report {
    /// Seconds to solve on the current thread pool, columns and a coarser table included; those of the coarser table, from which
    /// the other begins and its error follows.
    pub seconds: [f64; 2],
    /// Orders of scattering, and bytes of the table.
    pub size: (usize, usize),
    /// Domes of 160 zenith angles and 32 azimuths a second on the current thread pool, each with another sun 80 to 20 degrees high.
    pub domes_per_second: f64,
    /// Of each sun its distance from the path tracer.
    pub suns: Vec<Distance>,
}

/// How far the table is from the path tracer over the dome at the ground.
#[derive(Debug, Clone, Copy)]
pub struct Distance {
    /// Zenith angle of the sun in degrees.
    pub sun_zenith_deg: f64,
    /// Root mean square of relative differences; the part of it that is the path tracer's noise.
    pub rms: f64,
    /// That noise.
    pub noise: f64,
    /// Mean of relative differences: what the noise leaves of it is smaller by the root of the number of directions.
    pub mean: f64,
    /// Relative difference of the direction in which it is largest, mean over the wavelengths.
    pub worst: f64,
    /// [`FINER`] of the table's distance from a coarser one, as it is stated with pictures.
    pub stated: f64,
    /// A fisheye of 320 x 320 pixels, as exact as that.
    pub picture: Picture,
}

/// A picture from looks in few directions.
#[derive(Debug, Clone, Copy)]
pub struct Picture {
    /// Seconds of one thread.
    pub seconds: f64,
    /// Directions that were looked at for it.
    pub looks: usize,
    /// Relative differences to looks at pixels themselves: root mean square and the largest, all wavelengths of every 23rd pixel.
    pub off: [f64; 2],
}

/// Solves the atmosphere of a scene with that biome, and compares it for each sun with `paths` paths in each direction
/// of a dome; the sun is a parallel beam.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn measure(data: &Data, biome: Option<Biome>, suns: &[f64], paths: u64) -> Result<Report, RenderError> {
    let shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };
    let (medium, albedo) = (medium(data, biome, &visible())?, [0.1; WAVELENGTHS]);
    let start = Instant::now();
    let coarse = Solved::new(&medium, shape, albedo, &Resolution::COARSE)?;
    let first = start.elapsed().as_secs_f64();
    let solved = coarse.again(&Resolution::RENDER, None)?;
    let seconds = [start.elapsed().as_secs_f64(), first];
    let from = Place::above(2.0);
    let (directions, alone) = (fisheye(), rayon::ThreadPoolBuilder::new().num_threads(1).build()?);
    let wanted: Vec<_> = directions.iter().step_by(20).copied().collect();
    let picture = |sun: DVec3, stated: f64| {
        let start = Instant::now();
        let seen = Panorama::new(&solved, from, sun, befitting(stated), Pixels { directions: &wanted, each: 20 });
        std::hint::black_box(directions.iter().map(|direction| seen.radiance(&solved, *direction)[0]).sum::<f64>());
        let seconds = start.elapsed().as_secs_f64();
        let (mut squares, mut worst, mut count) = (0.0, 0.0_f64, 0.0);
        for direction in directions.iter().step_by(LOOKED_AT) {
            let right = solved.radiance(from, *direction, sun, false);
            for (found, right) in seen.radiance(&solved, *direction).into_iter().zip(right) {
                let off = (found / right - 1.0).abs();
                (squares, worst, count) = (squares + off * off, worst.max(off), count + 1.0);
            }
        }
        let off: f64 = squares / count;
        Picture { seconds, looks: seen.looks(), off: [off.sqrt(), worst] }
    };
    let shown = befitting(FINER * solved.difference(&coarse, from, towards(60.0, 0.0)));
    let dome: Vec<_> = (0..DOME.0 * DOME.1)
        .map(|i| {
            towards(89.9 * f64::from(i / DOME.1) / f64::from(DOME.0), 180.0 * f64::from(i % DOME.1) / f64::from(DOME.1))
        })
        .collect();
    let start = Instant::now();
    for frame in 0..DOMES {
        let sun = towards(10.0 + 60.0 * f64::from(frame) / f64::from(DOMES), 0.0);
        let seen = Panorama::new(&solved, from, sun, shown, Pixels { directions: &dome, each: 1 });
        std::hint::black_box(dome.par_iter().map(|direction| seen.radiance(&solved, *direction)[0]).sum::<f64>());
    }
    let domes_per_second = f64::from(DOMES) / start.elapsed().as_secs_f64();
    let columns = Columns::new(&medium, shape, Tolerance::RENDER);
    let distances = suns.iter().map(|&sun_zenith_deg| {
        let sun = towards(sun_zenith_deg, 0.0);
        let disc = SunDisc::beam(sun);
        let problem = Problem {
            texture: None,
            shape,
            medium: &medium,
            columns: &columns,
            albedo,
            sun: Some(&disc),
            environment: None,
            max_orders: None,
        };
        let directions: Vec<DVec3> = ZENITHS
            .iter()
            .flat_map(|&zenith| {
                (0..AZIMUTHS).map(move |k| towards(zenith, 180.0 * (f64::from(k) + 0.5) / f64::from(AZIMUTHS)))
            })
            .collect();
        let rows: Vec<_> = directions
            .par_iter()
            .enumerate()
            .map(|(pixel, &direction)| {
                let (mean, variance) = estimate(&problem, from, direction, pixel as u64, paths);
                let table = solved.radiance(from, direction, sun, false);
                let relative = |j: usize| table[j] / mean[j] - 1.0;
                let squares = (0..WAVELENGTHS).map(|j| relative(j).powi(2)).sum::<f64>() / WAVELENGTHS as f64;
                let noise =
                    (0..WAVELENGTHS).map(|j| variance[j] / (mean[j] * mean[j])).sum::<f64>() / WAVELENGTHS as f64;
                let off = (0..WAVELENGTHS).map(relative).sum::<f64>() / WAVELENGTHS as f64;
                (squares, noise, off)
            })
            .collect();
        let stated = FINER * solved.difference(&coarse, from, sun);
        let picture = alone.install(|| picture(sun, stated));
        let mean = |of: &dyn Fn(&(f64, f64, f64)) -> f64| rows.iter().map(of).sum::<f64>() / rows.len() as f64;
        Distance {
            sun_zenith_deg,
            rms: mean(&|row| row.0).sqrt(),
            noise: mean(&|row| row.1).sqrt(),
            mean: mean(&|row| row.2),
            worst: rows.iter().map(|row| row.2).fold(0.0, |a: f64, b| if b.abs() > a.abs() { b } else { a }),
            stated,
            picture,
        }
    });
    let size = (solved.convergence().0, solved.bytes());
    Ok(Report { seconds, size, domes_per_second, suns: distances.collect() })
}

/// Mean and its variance, from 32 scrambled Sobol sequences.
fn estimate<const L: usize>(
    problem: &Problem<'_, L>,
    from: Place,
    direction: DVec3,
    pixel: u64,
    paths: u64,
) -> ([f64; L], [f64; L]) {
    const SEQUENCES: u64 = 32;
    let points = paths.div_ceil(SEQUENCES);
    let (mut sums, mut squares) = ([0.0; L], [0.0; L]);
    for sequence in 0..SEQUENCES {
        let mut sum = [0.0; L];
        for point in 0..points {
            let mut sampler = Sampler::sobol(1, pixel, sequence, point as u32);
            let radiance = transport::radiance(Estimator::Paths, problem, from, direction, &mut sampler);
            sum.iter_mut().zip(radiance).for_each(|(sum, one)| *sum += one / points as f64);
        }
        for j in 0..L {
            sums[j] += sum[j];
            squares[j] += sum[j] * sum[j];
        }
    }
    let n = SEQUENCES as f64;
    let variance = std::array::from_fn(|j| (squares[j] / n - (sums[j] / n).powi(2)).max(0.0) / (n - 1.0));
    (sums.map(|sum| sum / n), variance)
}
