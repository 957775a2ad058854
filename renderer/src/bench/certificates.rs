//! What a certificate of polarised light costs beside one of radiance alone.

use super::{medium, towards, visible};
use crate::atmosphere::{Columns, Tolerance};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::polarisation::{Frame, Stokes};
use crate::render::RenderError;
use crate::sampling::spiral;
use crate::transport::{Certificate, Resolution, Solved};
use glam::DVec3;
use std::time::Instant;
use tables::units::EARTH_RADIUS_M;
use tables::views::Biome;

const WAVELENGTHS: usize = 8;

/// Directions of the dome, even in solid angle.
const DIRECTIONS: u32 = 16;

/// Fans in each direction and round, and rounds, of which the fastest counts.
const FANS: u32 = 8;
const ROUNDS: u64 = 16;

/// Certificates for one sun.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Report {
    /// Elevation of the sun in degrees.
    pub elevation_deg: f64,
    /// Seconds a fan, of radiance alone and of polarised light.
    pub seconds: [f64; 2],
    /// Mean square of the relative noise of one fan: radiance, I, Q and U, all over radiance.
    pub noise: [f64; 4],
}

impl Report {
    /// Cost of the same error of I, of Q and of U, each relative to I, over that of radiance by scalar transfer.
    #[must_use]
    pub fn cost(&self) -> [f64; 3] {
        let [scalar, parameters @ ..] = self.noise;
        parameters.map(|noise| self.seconds[1] / self.seconds[0] * noise / scalar)
    }
}

/// Certificates of both tables, the usual ones, of the atmosphere of a scene with that biome over a ground of albedo 0.1, from 2 m with
/// the sun at these elevations. On the current thread.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn measure(data: &Data, biome: Option<Biome>, elevations_deg: &[f64]) -> Result<Vec<Report>, RenderError> {
    let shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };
    let (medium, albedo) = (medium(data, biome, &visible())?, [0.1; WAVELENGTHS]);
    let scalar = Solved::new(&medium, shape, albedo, &Resolution::RENDER)?;
    let polarised = Solved::polarised(&medium, shape, albedo, &Resolution::RENDER)?;
    let columns = Columns::new(&medium, shape, Tolerance::RENDER);
    let from = Place::above(2.0);
    let reports = elevations_deg.iter().map(|&elevation_deg| {
        let sun = towards(90.0 - elevation_deg, 0.0);
        let [one, other] = [&scalar, &polarised].map(|table| Certificate::new(table, columns.clone(), from, sun));
        let mut report = Report { elevation_deg, ..Report::default() };
        for i in 0..DIRECTIONS {
            add(&mut report, (&one, &other), spiral(i, DIRECTIONS, [0.0, 1.0]), u64::from(i));
        }
        report
    });
    Ok(reports.collect())
}

/// Adds a direction to a report.
fn add(
    report: &mut Report,
    (scalar, polarised): (&Certificate<'_, WAVELENGTHS>, &Certificate<'_, WAVELENGTHS>),
    direction: DVec3,
    pixel: u64,
) {
    let frame = Frame::level(DVec3::Z, direction);
    let share = 1.0 / (f64::from(DIRECTIONS) * WAVELENGTHS as f64);
    let mut least = [f64::INFINITY; 2];
    for round in 0..ROUNDS {
        let start = Instant::now();
        let one = scalar.radiance(direction, scalar.fan(), FANS, round, pixel);
        let middle = Instant::now();
        let of = |seen: &Stokes| [seen.i, seen.q, seen.u];
        let other = polarised.stokes((direction, frame), of, (polarised.fan(), FANS), (round, pixel));
        let seconds = [middle - start, middle.elapsed()].map(|time| time.as_secs_f64() / f64::from(FANS));
        least = [least[0].min(seconds[0]), least[1].min(seconds[1])];
        for (noise, found) in report.noise.iter_mut().zip(std::iter::once(one).chain(other.into_iter().flatten())) {
            for j in 0..WAVELENGTHS {
                // The variance of a mean of fans, as that of one.
                *noise += share / ROUNDS as f64 * f64::from(FANS) * found.variance[j] / (one.mean[j] * one.mean[j]);
            }
        }
    }
    for (sum, seconds) in report.seconds.iter_mut().zip(least) {
        *sum += seconds / f64::from(DIRECTIONS);
    }
}
