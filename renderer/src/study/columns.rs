//! What column tables lose: error of transmittance and of single scattering against size, beside maps that others use.
//!
//! Three skies of one wavelength: clear air at 450 nm, desert dust at 550 nm, and a haze of vertical optical depth 1
//! that ends sharply at 2 km. What is right is a quadrature without tables.

use super::{Chart, Point};
use crate::atmosphere::{AirError, Columns, Component, GAUSS_4, Medium, MediumError, Tolerance};
use crate::bench::towards;
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::phase::Phase;
use crate::render::{RenderError, Sky};
use crate::scene::Scene;
use crate::transport::Method;
use glam::DVec3;
use rayon::prelude::*;
use tables::units::EARTH_RADIUS_M;
use tables::views::Biome;
use tables::{Axis, Curve, Interpolation, Outside, Scale};

const SHAPE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

/// Changes of a transmittance that tables are asked for.
const TOLERANCES: [f64; 6] = [1e-2, 1e-3, 1e-4, 2e-5, 4e-6, 8e-7];

/// Texels of the textures, altitudes by directions.
const SIZES: [[usize; 2]; 4] = [[16, 64], [64, 256], [128, 512], [256, 1024]];

/// Altitudes in m from which rays start, and those of the eyes.
const STARTS: [f64; 8] = [0.0, 1.0, 300.0, 1999.0, 2001.0, 1e4, 4e4, 9e4];
const EYES: [f64; 3] = [1.0, 2001.0, 1e4];

/// Zenith angles in degrees of sight and sun for single scattering.
const SIGHTS: [f64; 5] = [0.0, 60.0, 80.0, 88.0, 89.9];
const SUNS: [f64; 4] = [30.0, 80.0, 90.0, 95.0];

/// Where others put the nodes of a texture of transmittances to space, by radius r and cosine mu of the zenith angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Map {
    /// Even in altitude and in mu from -0.2 to 1.
    Even,
    /// Even in the root of altitude and in atan((mu + 0.15) / 1.15 tan 1.5) / 1.5 (Bruneton & Neyret 2008, their program).
    Bruneton2008,
    /// Even in the distance to the horizon and in that to the top between its least and largest (Bruneton 2017).
    Bruneton2017,
}

/// All of them, with their names.
pub(super) const MAPS: [(Map, &str); 3] = [
    (Map::Even, "texture, even in altitude and cosine"),
    (Map::Bruneton2008, "texture, map of Bruneton & Neyret 2008"),
    (Map::Bruneton2017, "texture, map of Bruneton 2017"),
];

impl Map {
    /// Altitude in m and cosine at coordinates from 0 to 1, below a top in m.
    fn at(self, [u, v]: [f64; 2], top: f64) -> (f64, f64) {
        let radius = EARTH_RADIUS_M;
        match self {
            Self::Even => (u * top, -0.2 + 1.2 * v),
            Self::Bruneton2008 => (u * u * top, -0.15 + 1.15 * (1.5 * v).tan() / 1.5_f64.tan()),
            Self::Bruneton2017 => {
                let horizon = (top * (2.0 * radius + top)).sqrt();
                let rho = horizon * u;
                let r = (rho * rho + radius * radius).sqrt();
                let least = radius + top - r;
                let d = least + v * (rho + horizon - least);
                let mu = if d > 0.0 { (horizon * horizon - rho * rho - d * d) / (2.0 * r * d) } else { 1.0 };
                (r - radius, mu.clamp(-1.0, 1.0))
            }
        }
    }

    /// The coordinates of an altitude in m and a cosine.
    fn coordinates(self, h: f64, mu: f64, top: f64) -> [f64; 2] {
        let radius = EARTH_RADIUS_M;
        match self {
            Self::Even => [h / top, (mu + 0.2) / 1.2],
            Self::Bruneton2008 => [(h / top).sqrt(), ((mu + 0.15) / 1.15 * 1.5_f64.tan()).atan() / 1.5],
            Self::Bruneton2017 => {
                let horizon = (top * (2.0 * radius + top)).sqrt();
                let rho = (h * (2.0 * radius + h)).sqrt();
                let r = radius + h;
                let d = -r * mu + (r * r * (mu * mu - 1.0) + (radius + top).powi(2)).max(0.0).sqrt();
                let least = top - h;
                [rho / horizon, (d - least) / (rho + horizon - least)]
            }
        }
    }
}

/// A texture of transmittances to space in single precision, bilinear between its nodes.
pub(super) struct Texture {
    map: Map,
    size: [usize; 2],
    top: f64,
    texels: Vec<f32>,
}

impl Texture {
    pub(super) fn new(map: Map, size: [usize; 2], medium: &Medium<1>) -> Self {
        let top = medium.top_m();
        let texels = (0..size[0] * size[1])
            .into_par_iter()
            .map(|i| {
                let share = |k: usize, n: usize| k as f64 / (n - 1) as f64;
                let (h, mu) = map.at([share(i / size[1], size[0]), share(i % size[1], size[1])], top);
                let to_space = |mu| medium.transmittance(SHAPE, Place::above(h), towards_cosine(mu))[0] as f32;
                // The last node of a row is the horizon, which rounding may put below it.
                let grazing = map == Map::Bruneton2017 && i % size[1] + 1 == size[1];
                to_space(if grazing { mu + 1e-9 } else { mu })
            })
            .collect();
        Self { map, size, top, texels }
    }

    pub(super) fn to_space(&self, h: f64, mu: f64) -> f64 {
        let coordinates = self.map.coordinates(h, mu, self.top);
        let [(i, s), (j, t)] = std::array::from_fn(|axis| {
            let at = coordinates[axis].clamp(0.0, 1.0) * (self.size[axis] - 1) as f64;
            let cell = (at as usize).min(self.size[axis] - 2);
            (cell, at - cell as f64)
        });
        let texel = |i: usize, j: usize| f64::from(self.texels[i * self.size[1] + j]);
        let row = |i: usize| texel(i, j) + t * (texel(i, j + 1) - texel(i, j));
        row(i) + s * (row(i + 1) - row(i))
    }
}

/// What gives transmittances.
pub(super) enum Lookup<'a> {
    Columns(Box<Columns<1>>),
    Texture(Texture),
    /// Quadrature, and no table.
    Exact(&'a Medium<1>),
}

impl Lookup<'_> {
    fn bytes(&self) -> usize {
        match self {
            Self::Columns(columns) => columns.bytes(),
            Self::Texture(texture) => 4 * texture.texels.len(),
            Self::Exact(_) => 0,
        }
    }

    /// From a place to space.
    pub(super) fn to_space(&self, place: Place, direction: DVec3) -> f64 {
        match self {
            Self::Columns(columns) => columns.transmittance(place, direction).map_or(0.0, |through| through[0]),
            Self::Texture(texture) => texture.to_space(place.altitude_m, place.up.dot(direction)),
            Self::Exact(medium) => medium.transmittance(SHAPE, place, direction)[0],
        }
    }
}

/// A place on a line of sight with what does not depend on tables.
struct Node {
    place: Place,
    /// Distance from the eye in m, and the share of the integral in m.
    distance: f64,
    weight: f64,
    /// Optical depth from the eye.
    depth: f64,
    /// Scattering coefficient in m^-1.
    scattering: f64,
}

/// A line of sight from an eye upwards: nodes of a quadrature whose pieces end where the densities bend.
fn line(medium: &Medium<1>, eye: f64, direction: DVec3) -> Vec<Node> {
    const PARTS: usize = 4;
    let from = Place::above(eye);
    let mu = direction.z;
    let r = EARTH_RADIUS_M + eye;
    // t from t^2 + 2 r mu t - (h - eye)(2R + eye + h) = 0.
    let distance = |h: f64| {
        let c = (h - eye) * (2.0 * EARTH_RADIUS_M + eye + h);
        c / (r * mu + (r * r * mu * mu + c).sqrt())
    };
    let mut ends = vec![eye];
    let bends = medium.nodes().iter().filter(|&&z| z > eye);
    for &bend in bends {
        let last = ends[ends.len() - 1];
        // Closer at the eye, where a level line stays longest.
        ends.extend((1..=PARTS).map(|i| last + (bend - last) * (i as f64 / PARTS as f64).powi(2)));
    }
    let mut nodes = Vec::new();
    let mut depth = 0.0;
    for piece in ends.windows(2) {
        let [a, b] = [distance(piece[0]), distance(piece[1])];
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let local = |t: f64| medium.local_at(from.advance(SHAPE, direction, t).altitude_m);
        let piece_depth = |to: f64| -> f64 {
            let half = 0.5 * (to - a);
            GAUSS_4.iter().map(|(x, weight)| weight * half * local(a + half * (1.0 + x)).extinction[0]).sum()
        };
        for (x, weight) in GAUSS_4 {
            let t = middle + half * x;
            let place = from.advance(SHAPE, direction, t);
            nodes.push(Node {
                place,
                distance: t,
                weight: weight * half,
                depth: depth + piece_depth(t),
                scattering: local(t).scattering[0],
            });
        }
        depth += piece_depth(b);
    }
    nodes
}

/// Sunlight scattered once towards the eye per unit of the phase function, with that table.
fn single(lookup: &Lookup<'_>, nodes: &[Node], (eye, direction): (f64, DVec3), sun: DVec3) -> f64 {
    let from = Place::above(eye);
    let chord = match lookup {
        Lookup::Columns(columns) => columns.chord(from, direction),
        _ => None,
    };
    let whole = lookup.to_space(from, direction);
    nodes
        .iter()
        .map(|node| {
            let arrives = match (&chord, lookup) {
                (Some(chord), _) => (-chord.point(node.distance - chord.travelled(0.0)).depth[0]).exp(),
                // T from the eye to space over T from the point to space.
                (None, Lookup::Texture(_)) => whole / lookup.to_space(node.place, direction),
                _ => (-node.depth).exp(),
            };
            node.weight * node.scattering * arrives * lookup.to_space(node.place, sun)
        })
        .sum()
}

/// The largest errors of a table.
#[derive(Debug, Clone, Copy, Default)]
struct Errors {
    absolute: f64,
    relative: f64,
    single: f64,
}

impl Errors {
    fn worse(self, other: Self) -> Self {
        Self {
            absolute: self.absolute.max(other.absolute),
            relative: self.relative.max(other.relative),
            single: self.single.max(other.single),
        }
    }
}

/// What is right in one sky.
struct Right<'a> {
    medium: &'a Medium<1>,
    rays: Vec<(Place, DVec3, f64)>,
    sights: Vec<(f64, DVec3, Vec<Node>)>,
    single: Vec<f64>,
}

impl<'a> Right<'a> {
    fn new(medium: &'a Medium<1>) -> Self {
        let rays = STARTS.iter().flat_map(|&h| {
            let dip = (EARTH_RADIUS_M / (EARTH_RADIUS_M + h)).acos().to_degrees();
            let even = (0..=240).map(move |i| (90.0 + dip) * f64::from(i) / 240.0);
            // The last arc minute above the horizon by seconds.
            let grazing = (1..60).map(move |i| 90.0 + dip - f64::from(i) / 3600.0);
            even.chain(grazing).map(move |zenith| (Place::above(h), towards(zenith, 0.0)))
        });
        let rays: Vec<_> = rays.collect();
        let rays = rays
            .into_par_iter()
            .map(|(place, direction)| (place, direction, medium.transmittance(SHAPE, place, direction)[0]))
            .filter(|ray| ray.2 > 0.0)
            .collect();
        let sights: Vec<_> = EYES
            .iter()
            .flat_map(|&eye| SIGHTS.map(|zenith| (eye, towards(zenith, 0.0), line(medium, eye, towards(zenith, 0.0)))))
            .collect();
        let mut right = Self { medium, rays, sights, single: Vec::new() };
        right.single = right.singles(&Lookup::Exact(medium));
        right
    }

    /// Single scattering of every sight and sun.
    fn singles(&self, lookup: &Lookup<'_>) -> Vec<f64> {
        self.sights
            .par_iter()
            .flat_map_iter(|(eye, direction, nodes)| {
                SUNS.map(|zenith| single(lookup, nodes, (*eye, *direction), towards(zenith, 0.0)))
            })
            .collect()
    }

    fn errors(&self, lookup: &Lookup<'_>) -> Errors {
        let transmittance = |&(place, direction, exact): &(Place, DVec3, f64)| {
            let off = (lookup.to_space(place, direction) - exact).abs();
            Errors { absolute: off, relative: if exact > 1e-6 { off / exact } else { 0.0 }, single: 0.0 }
        };
        let rays = self.rays.iter().map(transmittance).fold(Errors::default(), Errors::worse);
        // Relative to the brightest sight under the same sun: a dark one would count for nothing seen.
        let singles = self.singles(lookup);
        let suns = SUNS.len();
        let off = (0..singles.len()).map(|i| {
            let exact = self.single[i];
            let brightest = self.single.iter().skip(i % suns).step_by(suns).fold(0.0, |a: f64, &b| a.max(b));
            if exact > 1e-4 * brightest { (singles[i] / exact - 1.0).abs() } else { 0.0 }
        });
        Errors { single: off.fold(0.0, f64::max), ..rays }
    }
}

/// The skies.
fn skies(data: &Data) -> Result<[Medium<1>; 3], RenderError> {
    let sky = |biome, nm: f64| -> Result<Medium<1>, RenderError> {
        let scene = Scene { biome, method: Method::Paths, ..Scene::default() };
        Ok(Sky::new(&scene, data)?.air().medium(&[nm])?)
    };
    Ok([sky(None, 450.0)?, sky(Some(Biome::DesertDust), 550.0)?, haze().map_err(AirError::from)?])
}

/// Molecules of scale height 8 km and optical depth 0.2, and a haze of optical depth 1 up to 2 km.
pub(super) fn haze() -> Result<Medium<1>, MediumError> {
    const TOP_M: f64 = 1e5;
    let component = |density, scattering| Component {
        density,
        scattering: [scattering],
        absorption: [0.0],
        phase: Phase::Rayleigh { gamma: [0.0] },
    };
    let axis = Axis::uniform("altitude", "m", 0.0, 1e3, 101)?.beyond(Outside::Zero);
    let air = axis.nodes.iter().map(|z| (-z / 8e3).exp()).collect();
    let air = Curve::new(axis, Scale::Logarithmic, air)?;
    let axis = Axis::new("altitude", "m", vec![0.0, 2e3])?.between(Interpolation::Step).beyond(Outside::Zero);
    let layer = Curve::new(axis, Scale::Linear, vec![1.0, 1.0])?;
    Medium::new(vec![component(air, 2.5e-5), component(layer, 5e-4)], TOP_M)
}

fn towards_cosine(mu: f64) -> DVec3 {
    DVec3::new(((1.0 - mu) * (1.0 + mu)).max(0.0).sqrt(), 0.0, mu)
}

/// Computes the study: for each kind of table and size the largest errors of the three skies. `progress` is told the share that is done.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn make(data: &Data, progress: &(dyn Fn(f64) + Sync)) -> Result<Chart, RenderError> {
    let skies = skies(data)?;
    let right: Vec<Right<'_>> = skies.iter().map(Right::new).collect();
    let mut points = Vec::new();
    let steps = TOLERANCES.len() + MAPS.len() * SIZES.len();
    let mut done = 0;
    let mut add = |curve: &str, table: &dyn Fn(&Medium<1>) -> Lookup<'static>| {
        let (mut bytes, mut errors) = (0, Errors::default());
        for right in &right {
            let lookup = table(right.medium);
            bytes = bytes.max(lookup.bytes());
            errors = errors.worse(right.errors(&lookup));
        }
        for (panel, value) in [
            ("transmittance, largest absolute error", errors.absolute),
            ("transmittance above 1e-6, largest relative error", errors.relative),
            ("single scattering, largest relative error", errors.single),
        ] {
            points.push(Point { panel, curve: curve.to_owned(), at: [bytes as f64 / 1e6, value] });
        }
        done += 1;
        progress(f64::from(done) / steps as f64);
    };
    for depth in TOLERANCES {
        add("mean extinctions, nodes by error (Airlight)", &|medium| {
            Lookup::Columns(Box::new(Columns::new(medium, SHAPE, Tolerance { depth })))
        });
    }
    for (map, name) in MAPS {
        for size in SIZES {
            add(name, &|medium| Lookup::Texture(Texture::new(map, size, medium)));
        }
    }
    points.sort_by_key(|point| point.panel);
    Ok(Chart {
        title: "Tables of transmittance: largest error of three skies against size".to_owned(),
        axes: ["largest table of one wavelength / MB", "error"],
        points,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn maps_and_their_inverses_agree() {
        for (map, name) in MAPS {
            for at in [[0.1, 0.2], [0.5, 0.9], [0.93, 0.4], [0.02, 0.6]] {
                let (h, mu) = map.at(at, 1e5);
                let back = map.coordinates(h, mu, 1e5);
                // Distances near the horizon are differences of radii.
                assert!((0..2).all(|i| (back[i] - at[i]).abs() < 1e-6), "{name}: {at:?} {back:?}");
            }
        }
    }

    #[test]
    fn the_renderers_tables_keep_what_is_asked_of_them() {
        // Transmittances to 1e-4 and 1e-3, single scattering to 2e-4, where the haze ends sharply.
        let medium = haze().expect("sound");
        let columns = Columns::new(&medium, SHAPE, Tolerance::RENDER);
        let errors = Right::new(&medium).errors(&Lookup::Columns(Box::new(columns)));
        assert!(errors.absolute < 1e-4 && errors.relative < 1e-3 && errors.single < 2e-4, "{errors:?}");
    }
}
