//! Paths through scenes drawn at random: whether any is not finite, negative or endless.
//!
//! A scene is a pure function of (seed, scene), a path of (seed, scene, path). The numbers of scenes are points of a Sobol
//! sequence, so that every range is covered evenly. Places where geometry and rounding are delicate are drawn
//! more often than chance would: the horizon, the vertical, the edge of the air, the ends of every range.

mod laws;
mod scene;
#[cfg(test)]
mod tests;

pub use laws::{Departure, LAW, Laws, laws};
pub use scene::{Scene, Sky};

use crate::atmosphere::{Columns, Medium, MediumError, Tolerance};
use crate::geometry::Place;
use crate::light::SunDisc;
use crate::sampling::Sampler;
use crate::transport::{self, Estimator, Problem};
use rayon::prelude::*;
use scene::{SHARE, towards};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};

/// Paths of one scene.
pub const PATHS: u64 = 1024;

/// A path of so many scatterings and reflections counts as endless.
pub const ENDLESS: u32 = 100_000;

/// Bad paths of one scene that are kept.
const KEPT: usize = 3;

/// What is wrong with a path.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// A radiance that is infinite or no number.
    NotFinite,
    /// A radiance below zero.
    Negative,
    /// [`ENDLESS`] orders.
    Endless,
    /// A panic.
    Panic,
    /// The scene's own air was refused, with that sentence.
    Refused(String),
}

/// A path with a fault.
#[derive(Debug, Clone, PartialEq)]
pub struct Bad {
    /// Number of the scene.
    pub scene: u64,
    /// Number of the path; 0 if all of the scene's have the fault.
    pub path: u64,
    /// What is wrong.
    pub fault: Fault,
}

/// What a sweep found.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Report {
    /// Scenes.
    pub scenes: u64,
    /// Paths traced.
    pub paths: u64,
    /// Bad ones among them.
    pub bad: u64,
    /// Some of the bad ones of each scene, in order.
    pub examples: Vec<Bad>,
    /// The most orders that a path had, or one more.
    pub most_orders: u32,
}

/// One path: its radiance per unit solar irradiance in sr^-1 at each wavelength, and how many orders it had.
#[derive(Debug, Clone, PartialEq)]
pub struct Traced {
    /// Radiances.
    pub radiance: Vec<f64>,
    /// Scatterings and reflections, or one more.
    pub orders: u32,
    /// What is wrong with it.
    pub fault: Option<Fault>,
}

/// A sky with its tables.
struct World<const L: usize> {
    medium: Medium<L>,
    columns: Columns<L>,
}

impl<const L: usize> World<L> {
    fn new(sky: &Sky) -> Result<Self, MediumError> {
        let medium = sky.medium()?;
        let columns = Columns::new(&medium, sky.shape, Tolerance::RENDER);
        Ok(Self { medium, columns })
    }

    /// The same, and a panic is a fault.
    fn guarded(sky: &Sky) -> Result<Self, Fault> {
        match catch_unwind(|| Self::new(sky)) {
            Ok(world) => world.map_err(|error| Fault::Refused(error.to_string())),
            Err(_) => Err(Fault::Panic),
        }
    }

    /// A path's radiance and its number of orders, in a scene with its sun.
    fn guarded_trace(
        &self,
        plan: &Plan,
        (drawn, sun): (&Scene, Option<&SunDisc<L>>),
        scene: u64,
        path: u64,
    ) -> Result<([f64; L], u32), Fault> {
        let traced = catch_unwind(AssertUnwindSafe(|| {
            let (from, direction) =
                (Place::above(drawn.altitude_m), towards(drawn.view_zenith_deg, drawn.view_azimuth_deg));
            let mut sampler = Sampler::sobol(plan.seed, scene, 0, path as u32);
            let problem = self.problem(drawn, sun);
            let radiance = transport::radiance(plan.method, &problem, from, direction, &mut sampler);
            // Sets 2n and 2n + 1 are those of order n; a path is at the last that it has used or the next.
            (radiance, sampler.set() / 2)
        }));
        traced.map_err(|_| Fault::Panic)
    }

    fn problem<'a>(&'a self, scene: &Scene, sun: Option<&'a SunDisc<L>>) -> Problem<'a, L> {
        Problem {
            texture: None,
            shape: scene.sky.shape,
            medium: &self.medium,
            columns: &self.columns,
            albedo: std::array::from_fn(|j| scene.albedo.powi(1 + j as i32)),
            sun,
            environment: scene.environment.then_some([1.0; L]),
            max_orders: Some(ENDLESS),
        }
    }
}

/// What paths are traced, and how.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plan {
    /// Seed of scenes and paths.
    pub seed: u64,
    /// Number of paths; the last scene has what is left.
    pub paths: u64,
    /// How they are traced.
    pub method: Estimator,
}

impl Plan {
    /// Traces all paths. `progress` is told the share that is done, from any thread. The report does not depend on
    /// the number of threads.
    #[must_use]
    pub fn run(&self, progress: &(dyn Fn(f64) + Sync)) -> Report {
        let done = AtomicU64::new(0);
        let block = SHARE * PATHS;
        (0..self.paths.div_ceil(block))
            .into_par_iter()
            .map(|number| {
                let paths = block.min(self.paths - number * block);
                let report = match Sky::new(self.seed, number) {
                    sky if sky.wavelengths_nm.len() == 1 => self.block::<1>(&sky, number, paths),
                    sky => self.block::<4>(&sky, number, paths),
                };
                let done = done.fetch_add(paths, Ordering::Relaxed) + paths;
                progress(done as f64 / self.paths as f64);
                report
            })
            .reduce(Report::default, Report::with)
    }

    /// The scenes that share sky number `number`, up to so many paths.
    fn block<const L: usize>(&self, sky: &Sky, number: u64, paths: u64) -> Report {
        let mut report = Report::default();
        let world = World::<L>::guarded(sky);
        for scene in number * SHARE..number * SHARE + paths.div_ceil(PATHS) {
            let paths = PATHS.min(paths - (scene - number * SHARE) * PATHS);
            report.scenes += 1;
            report.paths += paths;
            let world = match &world {
                Ok(world) => world,
                Err(fault) => {
                    report.bad += paths;
                    report.examples.push(Bad { scene, path: 0, fault: fault.clone() });
                    continue;
                }
            };
            let drawn = Scene::under(sky.clone(), self.seed, scene);
            let sun = drawn.sun();
            let mut kept = 0;
            for path in 0..paths {
                let fault = match world.guarded_trace(self, (&drawn, sun.as_ref()), scene, path) {
                    Ok((radiance, orders)) => {
                        report.most_orders = report.most_orders.max(orders);
                        fault(&radiance, orders)
                    }
                    Err(fault) => Some(fault),
                };
                if let Some(fault) = fault {
                    report.bad += 1;
                    if kept < KEPT {
                        report.examples.push(Bad { scene, path, fault });
                        kept += 1;
                    }
                }
            }
        }
        report
    }

    /// One path by itself, as it was in the sweep; what is wrong with it if something is.
    ///
    /// # Errors
    /// A [`Fault`] without a radiance: a refused scene or a panic.
    pub fn replay(&self, scene: u64, path: u64) -> Result<Traced, Fault> {
        let drawn = Scene::new(self.seed, scene);
        match drawn.sky.wavelengths_nm.len() {
            1 => self.retrace::<1>(&drawn, scene, path),
            _ => self.retrace::<4>(&drawn, scene, path),
        }
    }

    fn retrace<const L: usize>(&self, drawn: &Scene, scene: u64, path: u64) -> Result<Traced, Fault> {
        let world = World::<L>::guarded(&drawn.sky)?;
        let (radiance, orders) = world.guarded_trace(self, (drawn, drawn.sun().as_ref()), scene, path)?;
        Ok(Traced { radiance: radiance.to_vec(), orders, fault: fault(&radiance, orders) })
    }
}

impl Report {
    /// Both together, `next` coming after.
    fn with(mut self, next: Self) -> Self {
        self.examples.extend(next.examples);
        Self {
            scenes: self.scenes + next.scenes,
            paths: self.paths + next.paths,
            bad: self.bad + next.bad,
            examples: self.examples,
            most_orders: self.most_orders.max(next.most_orders),
        }
    }
}

/// What is wrong with an estimate.
fn fault(radiance: &[f64], orders: u32) -> Option<Fault> {
    if radiance.iter().any(|r| !r.is_finite()) {
        Some(Fault::NotFinite)
    } else if radiance.iter().any(|&r| r < 0.0) {
        Some(Fault::Negative)
    } else {
        (orders >= ENDLESS).then_some(Fault::Endless)
    }
}
