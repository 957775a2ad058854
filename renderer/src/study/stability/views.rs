//! Altitude of the observer and angle of the view, from the zenith past the horizon and the limb to the nadir, in clear air: radiance in each
//! direction beside certificates, which depend on no table.

use super::{ASKED_ERROR, Cell, MOST_ERROR, Map, Size, rms};
use crate::atmosphere::{Columns, Tolerance};
use crate::bench::{medium, towards};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::render::RenderError;
use crate::transport::{Certificate, Fan, Method, Resolution, Solved, Tables, rungs::Cheap, rungs::Rung};
use glam::DVec3;
use rayon::prelude::*;
use tables::units::{EARTH_RADIUS_M, KM};

const SHAPE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

/// Wavelengths in nm.
const NM: [f64; 4] = [400.0, 480.0, 560.0, 680.0];
const ALBEDO: [f64; 4] = [0.1; 4];

/// Altitudes of the observer in km.
const ALTITUDES: [f64; 14] =
    [0.002, 1.0, 5.0, 10.0, 20.0, 30.0, 40.0, 60.0, 80.0, 110.0, 200.0, 400.0, 2000.0, 36_000.0];
const FEW_ALTITUDES: [f64; 5] = [0.002, 10.0, 30.0, 400.0, 36_000.0];

/// Elevations of the sun at the observer, or above the middle of the Earth's disc as seen; its azimuth from the views in degrees.
const SUNS: [f64; 2] = [45.0, 0.0];
const AZIMUTH: f64 = 90.0;

/// Fans of a direction.
const FANS: (u32, u32) = (64, 8);

/// Where one looks.
#[derive(Debug, Clone, Copy, PartialEq)]
enum View {
    /// Zenith angle in degrees, at most 90.
    Up(f64),
    /// Past the Earth, with the lowest altitude of the line in km.
    Limb(f64),
    /// To the ground, with the zenith angle in degrees at which the line leaves it.
    Ground(f64),
}

const VIEWS: [View; 19] = [
    View::Up(0.0),
    View::Up(60.0),
    View::Up(80.0),
    View::Up(87.0),
    View::Up(89.5),
    View::Limb(90.0),
    View::Limb(70.0),
    View::Limb(60.0),
    View::Limb(50.0),
    View::Limb(40.0),
    View::Limb(30.0),
    View::Limb(20.0),
    View::Limb(10.0),
    View::Limb(3.0),
    View::Limb(0.1),
    View::Ground(89.9),
    View::Ground(87.0),
    View::Ground(60.0),
    View::Ground(0.0),
];

impl View {
    fn name(self) -> String {
        match self {
            Self::Up(zenith) => format!("up {zenith}°"),
            Self::Limb(km) => format!("limb {km} km"),
            Self::Ground(zenith) => format!("ground {zenith}°"),
        }
    }

    /// Its direction from an altitude in m; none where there is no such view. Lines that pass the Earth turn at the radius
    /// R + p = (R + h) sin(zenith angle); those to the ground arrive with R sin(their angle there) instead.
    fn direction(self, altitude_m: f64) -> Option<DVec3> {
        let radius = EARTH_RADIUS_M;
        let (turn, down) = match self {
            // Above the air there is nothing to see upwards.
            Self::Up(_) if altitude_m > 100.0 * KM => return None,
            Self::Up(zenith) => return Some(towards(zenith, 0.0)),
            Self::Limb(km) => (radius + km * KM, true),
            Self::Ground(zenith) => (radius * zenith.to_radians().sin(), true),
        };
        let sine = turn / (radius + altitude_m);
        (sine < 1.0 && down).then(|| DVec3::new(sine, 0.0, -((1.0 - sine) * (1.0 + sine)).sqrt()))
    }
}

/// Directions as high as one in the plane of x and z, to 30 degrees on both sides of it.
fn strip(direction: DVec3) -> [DVec3; 9] {
    std::array::from_fn(|i| {
        let (sin, cos) = (7.5 * (i as f64 - 4.0)).to_radians().sin_cos();
        DVec3::new(direction.x * cos, direction.x * sin, direction.z)
    })
}

/// A map for each elevation of the sun.
pub(super) fn make(data: &Data, size: Size, progress: &(dyn Fn(f64) + Sync)) -> Result<Vec<Map>, RenderError> {
    let (altitudes, fans): (&[f64], u32) = match size {
        Size::Full => (&ALTITUDES, FANS.0),
        Size::Quick => (&FEW_ALTITUDES, FANS.1),
    };
    let medium = medium::<4>(data, None, &NM)?;
    let columns = Columns::new(&medium, SHAPE, Tolerance::RENDER);
    let best = Solved::new(&medium, SHAPE, ALBEDO, &Resolution::FINE)?;
    let high = (Place::above(2.0), towards(0.0, 0.0), &[] as &[_]);
    let tables = |error| Tables::within(error, high, (&medium, SHAPE, ALBEDO, false), None);
    let solved = [("solved: usual tables", tables(f64::INFINITY)?), ("solved: finest tables", tables(0.0)?)];
    let cheap = [Method::Isotropic, Method::Single]
        .into_iter()
        .filter_map(|method| Some((Rung::of(method).name, Cheap::new(method, &medium, SHAPE, ALBEDO, None)?)));
    let cheap: Vec<_> = cheap.collect();
    let mut maps = Vec::new();
    for (i, elevation) in SUNS.into_iter().enumerate() {
        let sun = towards(90.0 - elevation, AZIMUTH);
        let mut cells = Vec::new();
        for (k, &altitude) in altitudes.iter().enumerate() {
            let from = Place::above(altitude * KM);
            let certificate = Certificate::new(&best, columns.clone(), from, sun);
            let views: Vec<(View, DVec3)> =
                VIEWS.into_iter().filter_map(|view| Some((view, view.direction(from.altitude_m)?))).collect();
            let rows: Vec<Vec<Cell>> = views
                .par_iter()
                .map(|&(view, direction)| {
                    let right = certificate.radiance(direction, Fan::USUAL, fans, 1, 0);
                    let known = rms(&std::array::from_fn::<f64, 4, _>(|j| right.variance[j].sqrt() / right.mean[j]));
                    let off =
                        |found: [f64; 4]| rms(&std::array::from_fn::<f64, 4, _>(|j| found[j] / right.mean[j] - 1.0));
                    let cell = |name: &str| Cell::new(name, [altitude.to_string(), view.name()]);
                    let mut cells = Vec::new();
                    for (name, tables) in &solved {
                        let found = tables.solved.radiance(from, direction, sun, false);
                        // As a picture states that looks nowhere else.
                        let stated = tables.error(from, sun, &strip(direction));
                        cells.push(
                            cell(name).found(off(found), known).bound(ASKED_ERROR).stated(stated, stated > MOST_ERROR),
                        );
                    }
                    for (name, rung) in &cheap {
                        cells.push(cell(name).found(off(rung.radiance(from, direction, sun)), known));
                    }
                    cells
                })
                .collect();
            cells.extend(rows.into_iter().flatten());
            progress((i as f64 + (k + 1) as f64 / altitudes.len() as f64) / SUNS.len() as f64);
        }
        // From the zenith to the nadir.
        cells.sort_by_key(|cell| VIEWS.iter().position(|view| view.name() == cell.at[1]));
        maps.push(Map {
            name: format!("views-sun-{elevation}"),
            title: format!("clear air, sun at {elevation} degrees and {AZIMUTH} degrees aside: error of each direction, by certificates"),
            axes: ["altitude / km", "view"],
            cells,
        });
    }
    Ok(maps)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn views_are_where_their_names_put_them() {
        for altitude in [2.0, 3e4, 4e5, 3.6e7] {
            for view in VIEWS {
                let Some(direction) = view.direction(altitude) else { continue };
                let place = Place::above(altitude);
                let sine = direction.cross(place.up).length();
                let turn = (EARTH_RADIUS_M + altitude) * sine;
                let ground = crate::geometry::Ray::new(SHAPE, place, direction).meets_ground();
                // A millimetre: rounding of radii.
                match view {
                    View::Up(zenith) => assert!((direction.z - zenith.to_radians().cos()).abs() < 1e-12 && !ground),
                    View::Limb(km) => assert!((turn - EARTH_RADIUS_M - km * KM).abs() < 1e-3 && !ground),
                    View::Ground(zenith) => {
                        assert!((turn - EARTH_RADIUS_M * zenith.to_radians().sin()).abs() < 1e-3 && ground);
                    }
                }
            }
        }
        assert!(View::Limb(30.0).direction(2e4).is_none(), "a limb above the observer");
    }
}
