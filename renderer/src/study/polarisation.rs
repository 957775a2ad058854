//! What leaving polarisation out costs: how far scalar radiance is off over the dome of the sky.
//!
//! Scalar and polarised transfer follow the same paths ([`transport::both`]): sunlight scattered once is alike in both, and cancels.

use super::{Chart, Point};
use crate::atmosphere::{Columns, Medium, Tolerance};
use crate::bench::{medium, towards};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::light::SunDisc;
use crate::polarisation::Frame;
use crate::render::RenderError;
use crate::render::left_out::{ALBEDOS, Measured, Off, QUANTITIES, SUNS, WAVELENGTHS, aerosols};
use crate::sampling::{Sampler, spiral};
use crate::scene::SceneError;
use crate::spectrum::{Colour, Wavelengths};
use crate::transport::{self, Estimator, Problem};
use glam::DVec3;
use rayon::prelude::*;
use tables::units::{EARTH_RADIUS_M, KM};
use tables::views::Biome;

const SHAPE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

/// Wavelengths that a path carries.
const LANES: usize = WAVELENGTHS.len();

/// Directions of half the dome, even in solid angle: the other half is its mirror image.
const DIRECTIONS: u32 = 40;

/// Sequences of random numbers, and paths of each.
const REPLICATES: usize = 16;
const PATHS: u32 = 64;

/// Altitude of the observer in m, and those in km that are looked at in clear air beside it.
const EYE_M: f64 = 2.0;
const ALTITUDES_KM: [f64; 2] = [3.0, 10.0];

/// The albedo whose numbers are drawn.
const DRAWN: usize = 1;

/// Wavelengths by their numbers whose numbers are drawn.
const COLOURS: [usize; 4] = [1, 4, 7, 10];

/// Scalar radiance over polarised radiance, less 1, in a direction: of each sequence, of each quantity.
type Seen = [[f64; QUANTITIES]; REPLICATES];

/// What is looked at.
struct View<'a> {
    problem: Problem<'a, LANES>,
    from: Place,
    colour: &'a Colour,
}

impl View<'_> {
    fn direction(&self, index: u32) -> Seen {
        let DVec3 { x, y, z } = spiral(index, DIRECTIONS, [0.0, 1.0]);
        let direction = DVec3::new(x, y.abs(), z);
        let frame = Frame::new(direction, direction.any_orthonormal_vector());
        let (mut difference, mut radiance) = ([[0.0; QUANTITIES]; REPLICATES], [0.0; QUANTITIES]);
        for (replicate, difference) in (0..).zip(&mut difference) {
            let (mut scalar, mut polarised) = ([0.0; LANES], [0.0; LANES]);
            for point in 0..PATHS {
                let mut sampler = Sampler::sobol(0, u64::from(index), replicate, point);
                let seen = transport::both(Estimator::Paths, &self.problem, self.from, direction, frame, &mut sampler);
                for (j, pair) in seen.into_iter().enumerate() {
                    scalar[j] += pair.scalar;
                    polarised[j] += pair.stokes.i;
                }
            }
            let [scalar, polarised] = [scalar, polarised].map(|light| self.quantities(&light));
            for k in 0..QUANTITIES {
                difference[k] = scalar[k] - polarised[k];
                radiance[k] += polarised[k] / REPLICATES as f64;
            }
        }
        difference.map(|row| std::array::from_fn(|k| if radiance[k] > 0.0 { row[k] / radiance[k] } else { 0.0 }))
    }

    /// Luminance, and radiances.
    fn quantities(&self, light: &[f64; LANES]) -> [f64; QUANTITIES] {
        let luminance = self.colour.xyz(light)[1];
        std::array::from_fn(|k| if k == 0 { luminance } else { light[k - 1] })
    }

    fn measure(&self) -> [Off; QUANTITIES] {
        let seen: Vec<Seen> = (0..DIRECTIONS).into_par_iter().map(|index| self.direction(index)).collect();
        std::array::from_fn(|k| off(&seen.iter().map(|seen| seen.map(|row| row[k])).collect::<Vec<_>>()))
    }
}

/// How far directions are off, each by several sequences. Squares of means are less the square of their error; the direction
/// that half of the sequences find the worst is asked of the other half, so that no direction is the worst by its noise.
fn off(directions: &[[f64; REPLICATES]]) -> Off {
    let n = REPLICATES as f64;
    let moments = |values: &[f64; REPLICATES]| {
        let mean = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|x| (x - mean).powi(2)).sum();
        (mean, squares / (n * (n - 1.0)))
    };
    let squares: f64 = directions.iter().map(moments).map(|(mean, variance)| mean * mean - variance).sum();
    let half = |values: &[f64; REPLICATES], first: usize| values.iter().skip(first).step_by(2).sum::<f64>() / (0.5 * n);
    let worst_by =
        |first: usize| directions.iter().max_by(|a, b| half(a, first).abs().total_cmp(&half(b, first).abs())).copied();
    let found = [0, 1].map(|first| {
        let direction = worst_by(first).unwrap_or_default();
        (half(&direction, 1 - first).abs(), moments(&direction).1)
    });
    Off {
        rms: (squares / directions.len() as f64).max(0.0).sqrt(),
        worst: 0.5 * (found[0].0 + found[1].0),
        error: found[0].1.max(found[1].1).sqrt(),
    }
}

/// Measures from an altitude in m, the sun at an elevation in degrees.
fn measure(
    (medium, columns): (&Medium<LANES>, &Columns<LANES>),
    colour: &Colour,
    altitude_m: f64,
    sun: f64,
    albedo: f64,
) -> [Off; QUANTITIES] {
    let disc = SunDisc::beam(towards(90.0 - sun, 0.0));
    let (sun, albedo) = (Some(&disc), [albedo; LANES]);
    let problem =
        Problem { texture: None, shape: SHAPE, medium, columns, albedo, sun, environment: None, max_orders: None };
    View { problem, from: Place::above(altitude_m), colour }.measure()
}

/// Measures everything that is stored, and draws some of it: clear air and the nine biomes from 2 m, and clear air from higher up.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn make(data: &Data, progress: &(dyn Fn(f64) + Sync)) -> Result<(Chart, Measured), RenderError> {
    let wavelengths = Wavelengths::new(WAVELENGTHS.to_vec()).map_err(SceneError::from)?;
    let colour = Colour::new(&data.sun, &data.observer, &data.ozone_cross_section, &wavelengths)?;
    let columns_of = |biome: Option<Biome>| -> Result<_, RenderError> {
        let medium = medium(data, biome, &WAVELENGTHS)?;
        let columns = Columns::new(&medium, SHAPE, Tolerance::RENDER);
        Ok((medium, columns))
    };
    let steps = (aerosols().len() * SUNS.len() * ALBEDOS.len() + ALTITUDES_KM.len() * SUNS.len()) as f64;
    let mut done = 0.0;
    let mut step = || {
        done += 1.0;
        progress(done / steps);
    };
    let mut sky = None;
    let measured = Measured::by(|aerosol, sun, albedo| {
        let (medium, columns) = match &sky {
            Some((of, medium, columns)) if *of == aerosol => (medium, columns),
            _ => {
                let (medium, columns) = columns_of(aerosol)?;
                let (_, medium, columns) = sky.insert((aerosol, medium, columns));
                (&*medium, &*columns)
            }
        };
        step();
        Ok::<_, RenderError>(measure((medium, columns), &colour, EYE_M, sun, albedo))
    })?;
    let mut points = points(&measured);
    let (medium, columns) = columns_of(None)?;
    for km in ALTITUDES_KM {
        for sun in SUNS {
            let off = measure((&medium, &columns), &colour, km * KM, sun, ALBEDOS[DRAWN]);
            points.push(Point { panel: OTHERS, curve: format!("clear, {km} km up"), at: [sun, 100.0 * off[0].rms] });
            step();
        }
    }
    let chart = Chart {
        title: "What leaving polarisation out costs: scalar over polarised transfer (from the ground, albedo 0.3 unless it is said)".to_owned(),
        axes: ["sun elevation / degrees", "relative difference / %"],
        points,
    };
    Ok((chart, measured))
}

const BY_AEROSOL: [&str; 3] =
    ["luminance, rms over the dome", "luminance, worst direction", "luminance, error of the worst"];
const BY_COLOUR: [&str; 2] = ["radiance, rms over the dome", "radiance, worst direction"];
const OTHERS: &str = "luminance, rms by ground, altitude";

/// What is drawn of the measurements.
fn points(measured: &Measured) -> Vec<Point> {
    let mut points = Vec::new();
    let mut add = |panel, curve: &str, sun: usize, value: f64| {
        points.push(Point { panel, curve: curve.to_owned(), at: [SUNS[sun], 100.0 * value] });
    };
    let suns = || 0..SUNS.len();
    for (panel, part) in (0..).zip(BY_AEROSOL).map(|(part, panel): (usize, _)| (panel, part)) {
        for (aerosol, biome) in aerosols().into_iter().enumerate() {
            let curve = biome.map_or("clear", Biome::name);
            for sun in suns() {
                let Off { rms, worst, error } = measured.of(aerosol, sun, DRAWN)[0];
                add(panel, curve, sun, [rms, worst, error][part]);
            }
        }
    }
    for (part, panel) in BY_COLOUR.into_iter().enumerate() {
        for colour in COLOURS {
            for sun in suns() {
                let Off { rms, worst, .. } = measured.of(0, sun, DRAWN)[1 + colour];
                add(panel, &format!("clear, {} nm", WAVELENGTHS[colour]), sun, [rms, worst][part]);
            }
        }
    }
    for (k, albedo) in ALBEDOS.into_iter().enumerate() {
        let curve = if k == DRAWN { "clear".to_owned() } else { format!("clear, albedo {albedo}") };
        for sun in suns() {
            add(OTHERS, &curve, sun, measured.of(0, sun, k)[0].rms);
        }
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_neither_an_error_of_the_sky_nor_its_worst_direction() {
        // Directions off by +-5 % but one by 30 %, with noise of 4 % a sequence: 1 % a direction.
        let noise = |i: u64| 0.04 * 12.0_f64.sqrt() * (Sampler::new(1, 0, i).uniform() - 0.5);
        let directions = |value: &dyn Fn(u64) -> f64| -> Vec<[f64; REPLICATES]> {
            (0..200).map(|i| std::array::from_fn(|r| value(i) + noise(i * 100 + r as u64))).collect()
        };
        let values = |i: u64| match i {
            7 => -0.3,
            i if i.is_multiple_of(2) => 0.05,
            _ => -0.05,
        };
        let found = off(&directions(&values));
        // sqrt(0.05^2 + (0.3^2 - 0.05^2) / 200) = 0.0542; without the noise taken off 0.0551.
        assert!((found.rms - 0.0542).abs() < 8e-4, "{found:?}");
        assert!((found.worst - 0.3).abs() < 0.03 && (found.error - 0.01).abs() < 0.005, "{found:?}");
        // Noise alone has an rms of 0.01, and the largest of 200 means of eight would be 0.04.
        let found = off(&directions(&|_| 0.0));
        assert!(found.rms < 7e-3 && found.worst < 0.03, "{found:?}");
    }
}
