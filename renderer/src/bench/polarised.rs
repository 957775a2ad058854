//! What polarised transfer costs beside scalar transfer, what it changes, and how far off solved tables are.

use super::towards;
use crate::atmosphere::{Columns, Medium, Tolerance};
use crate::geometry::{Place, Shape};
use crate::light::SunDisc;
use crate::polarisation::{Frame, Stokes};
use crate::sampling::Sampler;
use crate::transport::{self, Estimator, Problem, Resolution, SolveError, Solved};
use glam::DVec3;
use std::time::Instant;
use tables::units::EARTH_RADIUS_M;

/// Directions: zenith angle and azimuth from the sun in degrees.
const VIEWS: [(f64, f64); 6] = [(5.0, 90.0), (30.0, 0.0), (45.0, 120.0), (60.0, 180.0), (75.0, 60.0), (85.0, 150.0)];

/// Sequences of random numbers whose spread is the error of one.
const REPLICATES: u64 = 32;

const SHAPE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

/// The ground's albedo.
const ALBEDO: f64 = 0.1;

/// Polarised beside scalar transfer by the same random numbers: means over directions and wavelengths.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Report {
    /// Seconds a path, scalar and polarised.
    pub seconds: [f64; 2],
    /// Mean square of the relative error of one sequence: scalar radiance, I, and the mean of Q and U over I.
    pub variance: [f64; 3],
    /// Largest degree of linear polarisation.
    pub degree: f64,
    /// Least and largest of scalar radiance over I, less 1.
    pub scalar: (f64, f64),
    /// Mean square of what a polarised solved table is off from these paths, as a share of I: I, and the mean of Q and U.
    pub solved: [f64; 2],
}

impl Report {
    /// What polarised radiance costs over scalar radiance of the same error.
    #[must_use]
    pub fn cost(&self) -> f64 {
        self.seconds[1] / self.seconds[0] * self.variance[1] / self.variance[0]
    }

    /// Mean square of the relative error of all paths: I, and the mean of Q and U.
    #[must_use]
    pub fn noise(&self) -> [f64; 2] {
        [self.variance[1], self.variance[2]].map(|variance| variance / (REPLICATES - 1) as f64)
    }
}

/// The solved table of polarised light that is put beside paths.
///
/// # Errors
/// As [`Solved::polarised`].
pub fn solve<const L: usize>(medium: &Medium<L>) -> Result<Solved<L>, SolveError> {
    Solved::polarised(medium, SHAPE, [ALBEDO; L], &Resolution::RENDER)
}

/// Traces sequences of `points` paths (a power of two) from the ground, on the current thread; the sun is a parallel beam. `solved` is
/// of the same medium.
#[must_use]
pub fn measure<const L: usize>(medium: &Medium<L>, solved: &Solved<L>, sun_zenith_deg: f64, points: u32) -> Report {
    let shape = SHAPE;
    let (columns, disc) = (Columns::new(medium, shape, Tolerance::RENDER), SunDisc::beam(towards(sun_zenith_deg, 0.0)));
    let problem = Problem {
        texture: None,
        shape,
        medium,
        columns: &columns,
        albedo: [ALBEDO; L],
        sun: Some(&disc),
        environment: None,
        max_orders: None,
    };
    let from = Place::above(2.0);
    let mut report = Report { scalar: (f64::INFINITY, f64::NEG_INFINITY), ..Report::default() };
    for (pixel, &(zenith, azimuth)) in (0_u64..).zip(&VIEWS) {
        let direction = towards(zenith, azimuth);
        let frame = Frame::new(direction, DVec3::Z.cross(direction).normalize());
        let samplers = |replicate| (0..points).map(move |point| Sampler::sobol(0, pixel, replicate, point));
        let mut moments = [[Moments::default(); 4]; L];
        let mut least = [f64::INFINITY; 2];
        for replicate in 0..REPLICATES {
            let mut sum = [[0.0; 4]; L];
            let start = Instant::now();
            for mut sampler in samplers(replicate) {
                let seen = transport::radiance(Estimator::Paths, &problem, from, direction, &mut sampler);
                for j in 0..L {
                    sum[j][0] += seen[j];
                }
            }
            let middle = Instant::now();
            for mut sampler in samplers(replicate) {
                let seen = transport::stokes(Estimator::Paths, &problem, from, direction, frame, &mut sampler);
                for j in 0..L {
                    let Stokes { i, q, u } = seen[j];
                    sum[j] = [sum[j][0], sum[j][1] + i, sum[j][2] + q, sum[j][3] + u];
                }
            }
            let seconds = [middle - start, middle.elapsed()].map(|time| time.as_secs_f64() / f64::from(points));
            least = [least[0].min(seconds[0]), least[1].min(seconds[1])];
            for j in 0..L {
                for k in 0..4 {
                    moments[j][k].add(sum[j][k] / f64::from(points));
                }
            }
        }
        let share = 1.0 / VIEWS.len() as f64;
        for (sum, seconds) in report.seconds.iter_mut().zip(least) {
            *sum += share * seconds;
        }
        let table = solved.stokes(from, direction, frame, disc.direction(), false);
        for ([scalar, i, q, u], table) in moments.into_iter().zip(table) {
            let share = share / L as f64;
            report.variance[0] += share * scalar.variance() / scalar.mean().powi(2);
            report.variance[1] += share * i.variance() / i.mean().powi(2);
            report.variance[2] += share * 0.5 * (q.variance() + u.variance()) / i.mean().powi(2);
            report.degree = report.degree.max(q.mean().hypot(u.mean()) / i.mean());
            let off = scalar.mean() / i.mean() - 1.0;
            report.scalar = (report.scalar.0.min(off), report.scalar.1.max(off));
            let [i, q, u] =
                [(table.i, i), (table.q, q), (table.u, u)].map(|(a, b)| ((a - b.mean()) / i.mean()).powi(2));
            report.solved[0] += share * i;
            report.solved[1] += share * 0.5 * (q + u);
        }
    }
    report
}

/// Sums of [`REPLICATES`] values and of their squares.
#[derive(Debug, Clone, Copy, Default)]
struct Moments {
    sum: f64,
    squares: f64,
}

impl Moments {
    fn add(&mut self, x: f64) {
        self.sum += x;
        self.squares += x * x;
    }

    fn mean(&self) -> f64 {
        self.sum / REPLICATES as f64
    }

    fn variance(&self) -> f64 {
        (self.squares / REPLICATES as f64 - self.mean().powi(2)).max(0.0)
    }
}
