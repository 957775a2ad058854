//! A packet of wavelengths of a sky, and how its radiance is found.

use super::RenderError;
use super::certify::{self, Certifies};
use super::sky::Shows;
use crate::atmosphere::{Air, Columns, Medium, Tolerance};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::ground::Texture;
use crate::light::{SunDisc, solar_angular_radius_at};
use crate::polarisation::{Frame, Stokes};
use crate::sampling::Sampler;
use crate::scene::{Scene, SceneError, SunShape};
use crate::spectrum::{Packet, Wavelengths};
use crate::transport::rungs::{Cheap, Stated};
use crate::transport::{
    self, Certificate, Estimator, Method, Panorama, Pixels, Problem, Resolution, SolveError, Solved, Tables, befitting,
};
use glam::DVec3;
use std::fmt::Debug;
use std::path::Path;
use tables::units::EARTH_RADIUS_M;

/// Error that a solved table may state at most.
pub(crate) const MOST_ERROR: f64 = 0.1;

/// Directions of a picture.
#[derive(Debug)]
pub(super) struct Wanted {
    /// Of many of its pixels, if it has many.
    pub(super) shown: Vec<DVec3>,
    /// For how many samples each of those stands.
    pub(super) each: usize,
    /// Of some, evenly, in which its tables are judged.
    pub(super) judged: Vec<DVec3>,
}

/// What a packet is made from.
pub(super) struct Parts<'a> {
    pub(super) wavelengths: &'a Wavelengths,
    pub(super) albedo: &'a [f64],
    pub(super) air: &'a Air,
    pub(super) data: &'a Data,
    pub(super) place: Place,
    pub(super) sun_direction: DVec3,
    pub(super) wanted: &'a Wanted,
    pub(super) scene: &'a Scene,
    /// Whether light is followed with its polarisation.
    pub(super) polarised: bool,
    pub(super) kept: Option<&'a Path>,
}

impl Parts<'_> {
    pub(super) fn carry<const L: usize>(&self, packet: &Packet) -> Result<Box<dyn Carrier>, RenderError> {
        let nm: [f64; L] = self.wavelengths.lanes(packet);
        let (scene, polarised) = (self.scene, self.polarised);
        let shape = if scene.flat { Shape::Flat } else { Shape::Sphere { radius_m: EARTH_RADIUS_M } };
        let medium = self.air.medium(&nm)?;
        if polarised && !medium.polarises() {
            return Err(SceneError::Refused(
                "a phase function without a scattering matrix (Henyey-Greenstein) leaves polarisation unknown: take \
                 --phase mie"
                    .into(),
            )
            .into());
        }
        let albedo = std::array::from_fn(|lane| self.albedo[packet.index(lane)]);
        let texture = scene.has_texture().then(|| {
            Texture::earth(scene.latitude_deg, scene.longitude_deg.unwrap_or(0.0), &nm).map_err(SceneError::Refused)
        });
        let texture = texture.transpose()?;
        let sun = match scene.sun_shape {
            SunShape::Disc => {
                SunDisc::new(&self.data.sun, &nm, self.sun_direction, solar_angular_radius_at(scene.sun_distance_au))?
            }
            SunShape::Even => {
                SunDisc::darkened(self.sun_direction, solar_angular_radius_at(scene.sun_distance_au), vec![[1.0; L]])
            }
            SunShape::Point => SunDisc::beam(self.sun_direction),
        };
        let means = match (scene.method.estimator(), scene.method) {
            (Some(estimator), _) => {
                Means::Estimated(estimator, Box::new(Columns::new(&medium, shape, Tolerance::RENDER)))
            }
            (None, Method::Solved) => {
                let view = (self.place, self.sun_direction, self.wanted.judged.as_slice());
                let sky = (&medium, shape, albedo, polarised);
                let grids = match scene.fineness {
                    None => Grids::Judged(Box::new(Tables::within(scene.table_error, view, sky, self.kept)?)),
                    Some(fineness) => Grids::Alone(Box::new(Solved::of(sky, &fineness.resolution(), self.kept)?)),
                };
                let asked = scene.table_error;
                let (error, seen) = seen(&grids, asked, (self.place, &sun), self.wanted)?;
                let black = if texture.is_some() {
                    let resolution = scene.fineness.map_or(Resolution::RENDER, |fineness| fineness.resolution());
                    let black = Solved::of((&medium, shape, [0.0; L], polarised), &resolution, self.kept)?;
                    Some(Black::new(black, (self.place, &sun), self.wanted)?)
                } else {
                    None
                };
                Means::Solved { grids, asked, error, seen, black }
            }
            (None, method) => Means::Cheap(Cheap::new(method, &medium, shape, albedo, scene.steps)),
        };
        let (max_orders, count) = (scene.orders, packet.range.len());
        Ok(Box::new(Lanes { means, shape, medium, albedo, texture, sun, polarised, max_orders, count }))
    }
}

/// Solved tables.
#[derive(Debug)]
enum Grids<const L: usize> {
    /// With a coarser one that tells their error.
    Judged(Box<Tables<L>>),
    /// On a grid that was chosen, which states none.
    Alone(Box<Solved<L>>),
}

impl<const L: usize> Grids<L> {
    fn solved(&self) -> &Solved<L> {
        match self {
            Self::Judged(tables) => &tables.solved,
            Self::Alone(solved) => solved,
        }
    }
}

/// The same air over black ground, for a ground that is not uniform.
///
/// Over uniform ground of the albedo a the radiance is L(a) = L(0) + D a / (1 - a s), where s is the share of the light from the ground that
/// the air sends back to it: exactly so under a plane air. Two tables, L(0) and L(m) over the mean m of the map, say D; their irradiances
/// E(m) = E(0) / (1 - m s) at the place say s. What is seen is L(a) with the albedo of the ground looked at, or of the ground below the
/// point of the line that is nearest to it: light that the air has from the ground's neighbourhood is then that of ground like it.
#[derive(Debug)]
struct Black<const L: usize> {
    grids: Grids<L>,
    seen: Vec<Panorama<L>>,
}

impl<const L: usize> Black<L> {
    fn new(solved: Solved<L>, view: (Place, &SunDisc<L>), wanted: &Wanted) -> Result<Self, SolveError> {
        let mut black = Self { grids: Grids::Alone(Box::new(solved)), seen: Vec::new() };
        black.turn(view, wanted)?;
        Ok(black)
    }

    fn turn(&mut self, view: (Place, &SunDisc<L>), wanted: &Wanted) -> Result<(), SolveError> {
        // As exactly as a panorama is made at all, for differences of two are multiplied.
        (_, self.seen) = seen(&self.grids, 0.0, view, wanted)?;
        Ok(())
    }
}

/// The ground where a line of sight ends, or below the point of it that is nearest to the ground.
fn nearest_ground(shape: Shape, from: Place, direction: DVec3) -> Place {
    let below = Place { altitude_m: 0.0, up: from.up };
    let Shape::Sphere { radius_m } = shape else { return below };
    // In radii of the planet: |p + t d| = 1, or least.
    let start = from.up * (1.0 + from.altitude_m / radius_m);
    let towards = -start.dot(direction);
    if towards <= 0.0 {
        return below;
    }
    let perigee = start + direction * towards;
    let inside = (1.0 - perigee.length_squared()).max(0.0).sqrt();
    Place { altitude_m: 0.0, up: (perigee - direction * inside).normalize() }
}

/// The error that tables state for an observer and a sun, and what is seen with each of the suns that stand for the disc, as exactly as
/// befits that error, or the `asked` one of tables that state none.
fn seen<const L: usize>(
    grids: &Grids<L>,
    asked: f64,
    (place, sun): (Place, &SunDisc<L>),
    wanted: &Wanted,
) -> Result<(Option<f64>, Vec<Panorama<L>>), SolveError> {
    let error = match grids {
        Grids::Judged(tables) => Some(tables.error(place, sun.direction(), &wanted.judged)),
        Grids::Alone(_) => None,
    };
    if let Some(error) = error.filter(|error| error.is_nan() || *error > MOST_ERROR) {
        return Err(SolveError::Inexact(error));
    }
    let shown = befitting(error.unwrap_or(asked));
    let solved = grids.solved();
    let suns = solved.suns(place, sun).into_iter();
    let pixels = Pixels { directions: &wanted.shown, each: wanted.each };
    Ok((error, suns.map(|sun| Panorama::new(solved, place, sun, shown, pixels)).collect()))
}

/// A packet of wavelengths, whatever the number of its lanes; slices are as long as
/// the packet's range.
pub(super) trait Carrier: Debug + Send + Sync {
    fn radiance(&self, from: Place, direction: DVec3, sampler: &mut Sampler, factors: &mut [f64]);
    /// Hands the Stokes parameters of each lane to `see`.
    fn stokes(
        &self,
        from: Place,
        direction: DVec3,
        frame: Frame,
        sampler: &mut Sampler,
        see: &mut dyn FnMut(usize, Stokes),
    );
    fn add_disc(&self, from: Place, direction: DVec3, weight: f64, factors: &mut [f64]) -> bool;
    /// Adds to the irradiance of a surface with that normal.
    fn add_direct(&self, from: Place, normal: DVec3, u: [f64; 2], weight: f64, factors: &mut [f64]);
    fn table_error(&self) -> Option<f64>;
    fn is_solved(&self) -> bool;
    /// What a cheap method states of its own error.
    fn stated(&self, from: Place) -> Option<Stated>;
    fn is_noiseless(&self) -> bool;
    fn bytes(&self) -> usize;
    /// Turns to another observer and sun.
    fn turn(&mut self, from: Place, sun: DVec3, wanted: &Wanted) -> Result<(), SolveError>;
    /// A certificate of the solved table for its observer, of what is shown at so many wavelengths.
    fn certificate(&self, from: Place, shows: Shows, count: usize) -> Option<Box<dyn Certifies + '_>>;
}

/// How radiance is found, with the tables for it.
#[derive(Debug)]
enum Means<const L: usize> {
    Estimated(Estimator, Box<Columns<L>>),
    /// With the error that was asked, the one stated for this observer and this sun, and what is seen with each of the suns that stand for
    /// the disc.
    Solved {
        grids: Grids<L>,
        asked: f64,
        error: Option<f64>,
        seen: Vec<Panorama<L>>,
        /// Over a ground that is not uniform.
        black: Option<Black<L>>,
    },
    /// None behind a fitted sky, where only the sun is asked for.
    Cheap(Option<Cheap<L>>),
}

#[derive(Debug)]
struct Lanes<const L: usize> {
    means: Means<L>,
    shape: Shape,
    medium: Medium<L>,
    albedo: [f64; L],
    texture: Option<Texture<L>>,
    sun: SunDisc<L>,
    /// Whether light is followed with its polarisation.
    polarised: bool,
    max_orders: Option<u32>,
    /// Wavelengths of the packet, at most L.
    count: usize,
}

impl<const L: usize> Lanes<L> {
    fn problem<'a>(&'a self, columns: &'a Columns<L>) -> Problem<'a, L> {
        Problem {
            texture: self.texture.as_ref(),
            shape: self.shape,
            medium: &self.medium,
            columns,
            albedo: self.albedo,
            sun: Some(&self.sun),
            environment: None,
            max_orders: self.max_orders,
        }
    }

    /// What counts of the two tables over the map of the Earth, if that is the ground: see [`Black`].
    fn shares(&self, solved: &Solved<L>, black: &Black<L>, from: Place, look: (DVec3, DVec3)) -> [f64; L] {
        let Some(texture) = &self.texture else { return [1.0; L] };
        let (direction, sun) = look;
        let foot = nearest_ground(self.shape, from, direction);
        let albedo = texture.albedo(foot);
        let (over_mean, over_black) =
            (solved.ground_irradiance(foot, sun), black.grids.solved().ground_irradiance(foot, sun));
        std::array::from_fn(|j| {
            let mean = self.albedo[j];
            let back =
                if over_mean[j] > 0.0 { (1.0 - over_black[j] / over_mean[j]).clamp(0.0, 0.9) / mean } else { 0.0 };
            let reflects = |albedo: f64| albedo / (1.0 - (albedo * back).min(0.9));
            reflects(albedo[j]) / reflects(mean)
        })
    }

    /// What a cheap method sees; nothing in a fitted sky, which is seen elsewhere.
    fn cheaply(&self, cheap: Option<&Cheap<L>>, from: Place, direction: DVec3) -> [f64; L] {
        cheap.map_or([0.0; L], |cheap| cheap.radiance(from, direction, self.sun.direction()))
    }
}

impl<const L: usize> Carrier for Lanes<L> {
    fn radiance(&self, from: Place, direction: DVec3, sampler: &mut Sampler, factors: &mut [f64]) {
        let (estimator, columns) = match &self.means {
            Means::Estimated(estimator, columns) => (*estimator, columns),
            Means::Solved { grids, seen, black, .. } => {
                factors.fill(0.0);
                for (i, sun) in seen.iter().enumerate() {
                    let mut radiance = sun.radiance(grids.solved(), direction);
                    if let Some(black) = black {
                        let shares = self.shares(grids.solved(), black, from, (direction, sun.sun()));
                        let dark = black.seen[i].radiance(black.grids.solved(), direction);
                        for j in 0..L {
                            radiance[j] = dark[j] + shares[j] * (radiance[j] - dark[j]);
                        }
                    }
                    for (factor, radiance) in factors.iter_mut().zip(radiance) {
                        *factor += radiance / seen.len() as f64;
                    }
                }
                return;
            }
            Means::Cheap(cheap) => {
                let seen = self.cheaply(cheap.as_ref(), from, direction);
                factors.copy_from_slice(&seen[..factors.len()]);
                return;
            }
        };
        if self.polarised {
            // I is the same in every frame.
            let frame = Frame::new(direction, direction.any_orthonormal_vector());
            return self.stokes(from, direction, frame, sampler, &mut |lane, seen| factors[lane] = seen.i);
        }
        let estimate = transport::radiance(estimator, &self.problem(columns), from, direction, sampler);
        factors.copy_from_slice(&estimate[..factors.len()]);
    }

    fn stokes(
        &self,
        from: Place,
        direction: DVec3,
        frame: Frame,
        sampler: &mut Sampler,
        see: &mut dyn FnMut(usize, Stokes),
    ) {
        let seen = match &self.means {
            Means::Estimated(estimator, columns) => {
                transport::stokes(*estimator, &self.problem(columns), from, direction, frame, sampler)
            }
            Means::Solved { grids, seen, black, .. } => {
                let mut sum = [Stokes::default(); L];
                let weight = (seen.len() as f64).recip();
                for (i, sun) in seen.iter().enumerate() {
                    let mut shares = [1.0; L];
                    if let Some(black) = black {
                        shares = self.shares(grids.solved(), black, from, (direction, sun.sun()));
                        let dark = black.seen[i].stokes(black.grids.solved(), direction, frame);
                        for j in 0..L {
                            sum[j] += dark[j] * (weight * (1.0 - shares[j]));
                        }
                    }
                    let seen = sun.stokes(grids.solved(), direction, frame);
                    for j in 0..L {
                        sum[j] += seen[j] * (weight * shares[j]);
                    }
                }
                sum
            }
            // These know natural light alone, and scenes with polarisation refuse them.
            Means::Cheap(cheap) => {
                self.cheaply(cheap.as_ref(), from, direction).map(|i| Stokes { i, ..Stokes::default() })
            }
        };
        seen.into_iter().take(self.count).enumerate().for_each(|(lane, seen)| see(lane, seen));
    }

    fn table_error(&self) -> Option<f64> {
        match &self.means {
            Means::Solved { error, .. } => *error,
            Means::Estimated(..) | Means::Cheap(_) => None,
        }
    }

    fn is_solved(&self) -> bool {
        matches!(self.means, Means::Solved { .. })
    }

    fn stated(&self, from: Place) -> Option<Stated> {
        let Means::Cheap(Some(cheap)) = &self.means else { return None };
        cheap.stated(from, self.sun.direction())
    }

    fn is_noiseless(&self) -> bool {
        !matches!(self.means, Means::Estimated(..))
    }

    fn bytes(&self) -> usize {
        match &self.means {
            Means::Estimated(_, columns) => columns.bytes(),
            Means::Solved { grids, .. } => grids.solved().bytes(),
            Means::Cheap(cheap) => cheap.as_ref().map_or(0, Cheap::bytes),
        }
    }

    fn certificate(&self, from: Place, shows: Shows, count: usize) -> Option<Box<dyn Certifies + '_>> {
        let Means::Solved { grids, .. } = &self.means else { return None };
        let solved = grids.solved();
        let columns = Columns::new(&self.medium, self.shape, Tolerance::RENDER);
        let certificate = Certificate::new(solved, columns, from, self.sun.direction());
        Some(Box::new(certify::Packet { solved, certificate, shows, count }))
    }

    fn turn(&mut self, from: Place, sun: DVec3, wanted: &Wanted) -> Result<(), SolveError> {
        self.sun.turn(sun);
        if let Means::Solved { grids, asked, error, seen: panoramas, black } = &mut self.means {
            (*error, *panoramas) = seen(grids, *asked, (from, &self.sun), wanted)?;
            if let Some(black) = black {
                black.turn((from, &self.sun), wanted)?;
            }
        }
        Ok(())
    }

    fn add_disc(&self, from: Place, direction: DVec3, weight: f64, factors: &mut [f64]) -> bool {
        let Some(disc) = self.sun.radiance(direction) else { return false };
        let transmittance = self.medium.transmittance(self.shape, from, direction);
        for ((factor, radiance), transmittance) in factors.iter_mut().zip(disc).zip(transmittance) {
            *factor += weight * radiance * transmittance;
        }
        true
    }

    fn add_direct(&self, from: Place, normal: DVec3, u: [f64; 2], weight: f64, factors: &mut [f64]) {
        let (direction, darkening) = self.sun.sample(u);
        let cosine = direction.dot(normal);
        if cosine <= 0.0 {
            return;
        }
        let transmittance = self.medium.transmittance(self.shape, from, direction);
        for ((factor, darkening), transmittance) in factors.iter_mut().zip(darkening).zip(transmittance) {
            *factor += weight * cosine * darkening * transmittance;
        }
    }
}
