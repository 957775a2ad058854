//! Mappings of tables of transmittance: even ones, those of Bruneton & Neyret 2008 and of Bruneton 2017, and mean extinctions with nodes by error;
//! against their size, by where one stands and looks. And the depth between two points of a ray, which is a difference.

use super::{Cell, Map, Size};
use crate::atmosphere::{AirError, Columns, GAUSS_4, Medium, Tolerance};
use crate::bench::towards;
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::render::RenderError;
use crate::study::columns::{self, Lookup, Texture, haze};
use rayon::prelude::*;
use tables::units::EARTH_RADIUS_M;

const SHAPE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

/// Texels of the textures, altitudes by directions: 4 KiB, 64 KiB, 256 KiB, 1 MiB.
const SIZES: [[usize; 2]; 4] = [[16, 64], [64, 256], [128, 512], [256, 1024]];

/// What mean extinctions are asked for, as fine as the textures are large.
const DEPTHS: [f64; 4] = [1e-2, 1e-3, 1e-4, 2e-5];

/// Altitudes in m, and angles in degrees above the horizon that is seen from there.
const PLACES: [(&str, f64); 4] = [("ground", 1.0), ("2 km", 1990.0), ("10 km", 1e4), ("top", 9.9e4)];
const ANGLES: [f64; 5] = [0.005, 0.1, 1.0, 10.0, 90.0];

/// Altitude in m from which rays start, distance along them of the first of two points, and distances between the two, in m.
const EYE_M: f64 = 1.0;
const ALONG_M: f64 = 2e4;
const DISTANCES: [f64; 7] = [1.0, 10.0, 100.0, 1e3, 1e4, 5e4, 2e5];
const ELEVATIONS: [f64; 6] = [0.0, 0.1, 1.0, 5.0, 20.0, 90.0];

/// The maps.
pub(super) fn make(_: &Data, size: Size, progress: &(dyn Fn(f64) + Sync)) -> Result<Vec<Map>, RenderError> {
    let medium = haze().map_err(AirError::from)?;
    let sizes = if size == Size::Full { SIZES.len() } else { 3 };
    let mut cells = Vec::new();
    for (map, name) in columns::MAPS {
        for (k, size) in SIZES.into_iter().enumerate().take(sizes) {
            cells.extend(of_table(&medium, &Lookup::Texture(Texture::new(map, size, &medium)), short(name), k + 1));
        }
    }
    progress(0.5);
    for (k, depth) in DEPTHS.into_iter().enumerate() {
        let table = Columns::new(&medium, SHAPE, Tolerance { depth });
        let rows = of_table(&medium, &Lookup::Columns(Box::new(table)), "mean extinctions", k + 1);
        // Tables keep absolutely what is asked of them, by half of one order (`transmittances_to_space_are_those_of_the_quadrature`).
        cells.extend(rows.into_iter().map(|cell| cell.bound(5.0 * depth)));
    }
    progress(0.8);
    Ok(vec![
        Map {
            name: "mappings".into(),
            title: "tables of transmittance, haze that ends at 2 km: largest error about that angle".into(),
            axes: ["fineness", "place, degrees above the horizon"],
            cells,
        },
        Map {
            name: "differences".into(),
            title: "relative error of the optical depth between two points, the first 20 km along a ray from 1 m"
                .into(),
            axes: ["distance between the points / m", "elevation of the ray / degrees"],
            cells: differences(&medium),
        },
    ])
}

/// What comes after the comma of a name, and what the map is of.
fn short(name: &str) -> &str {
    name.rsplit_once(", ").map_or(name, |(_, after)| after.trim_start_matches("map of "))
}

/// Largest errors near each angle at each place.
fn of_table(medium: &Medium<1>, lookup: &Lookup<'_>, name: &str, size: usize) -> Vec<Cell> {
    const AROUND: u32 = 8;
    let places = PLACES.iter().flat_map(|&(place, altitude)| ANGLES.map(|angle| (place, altitude, angle)));
    let places: Vec<_> = places.collect();
    let cells = places.into_par_iter().map(|(place, altitude, angle)| {
        let dip = (EARTH_RADIUS_M / (EARTH_RADIUS_M + altitude)).acos().to_degrees();
        let off = (0..AROUND).map(|i| {
            // From the angle down to half of it.
            let angle = angle * (1.0 - 0.5 * f64::from(i) / f64::from(AROUND));
            let direction = towards(90.0 + dip - angle, 0.0);
            let from = Place::above(altitude);
            (lookup.to_space(from, direction) - medium.transmittance(SHAPE, from, direction)[0]).abs()
        });
        Cell::new(name, [size.to_string(), format!("{place} {angle}°")]).found(off.fold(0.0, f64::max), 1e-9)
    });
    cells.collect()
}

/// The depth between two points: as a difference of columns, the columns rounded to single precision before, and from the quotient of two
/// transmittances to space out of a texture.
fn differences(medium: &Medium<1>) -> Vec<Cell> {
    let columns = Columns::new(medium, SHAPE, Tolerance::RENDER);
    let texture = Texture::new(columns::MAPS[2].0, SIZES[2], medium);
    let cells = ELEVATIONS.par_iter().flat_map_iter(|&elevation| {
        let (from, direction) = (Place::above(EYE_M), towards(90.0 - elevation, 0.0));
        let to_space = |along: f64| {
            let place = from.advance(SHAPE, direction, along);
            texture.to_space(place.altitude_m, place.up.dot(direction))
        };
        let mut cells = Vec::new();
        let Some(chord) = columns.chord(from, direction) else { return cells };
        let (begin, end) = chord.ends();
        for distance in DISTANCES {
            let ends = [ALONG_M, ALONG_M + distance];
            if begin + ends[1] > end {
                continue;
            }
            let right = between(medium, (from, direction), ends);
            let depths = ends.map(|along| chord.point(begin + along).depth[0]);
            let [first, second] = depths.map(|depth| depth as f32);
            let mut add = |name: &str, found: f64| {
                let off = (found / right - 1.0).abs();
                // A transmittance of zero tells nothing of the depth.
                let off = if off.is_finite() { off } else { f64::MAX };
                cells.push(Cell::new(name, [distance.to_string(), elevation.to_string()]).found(off, 1e-9));
            };
            add("columns, double precision", depths[1] - depths[0]);
            add("columns, single precision", f64::from(second - first));
            add("quotient of transmittances", (to_space(ends[1]) / to_space(ends[0])).ln());
        }
        cells
    });
    cells.collect()
}

/// Optical depth between two distances along a ray, by Gauss' rule on short pieces that end where the haze does.
fn between(medium: &Medium<1>, (from, direction): (Place, glam::DVec3), [begin, end]: [f64; 2]) -> f64 {
    const PARTS: u32 = 1000;
    let (r, mu) = (EARTH_RADIUS_M + from.altitude_m, from.up.dot(direction));
    let piece = |a: f64, b: f64| -> f64 {
        let half = 0.5 * (b - a) / f64::from(PARTS);
        let middles = (0..PARTS).map(|i| a + (2.0 * f64::from(i) + 1.0) * half);
        let nodes = middles.flat_map(|middle| GAUSS_4.map(|(x, weight)| (middle + half * x, weight * half)));
        let at = |t: f64| medium.local_at(from.advance(SHAPE, direction, t).altitude_m).extinction[0];
        nodes.map(|(t, weight)| weight * at(t)).sum()
    };
    let mut cuts = vec![begin];
    cuts.extend(medium.jumps().into_iter().map(|h| {
        let c = (h - from.altitude_m) * (2.0 * EARTH_RADIUS_M + h + from.altitude_m);
        c / (r * mu + (r * r * mu * mu + c).sqrt())
    }));
    cuts.retain(|cut| (begin..end).contains(cut));
    cuts.push(end);
    cuts.windows(2).map(|ends| piece(ends[0], ends[1])).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn worst(cells: &[Cell], method: &str, distance: &str) -> f64 {
        let here = cells.iter().filter(|cell| cell.method.starts_with(method) && cell.at[0] == distance);
        here.filter_map(|cell| cell.error).fold(0.0, f64::max)
    }

    #[test]
    fn columns_tell_neighbouring_points_apart() {
        // A metre, 20 km along a ray: both ends lie on one cubic. Single precision has 6e-8 of a depth of 1 for 2e-6.
        let cells = differences(&haze().expect("sound"));
        assert!(worst(&cells, "columns, double", "1") < 1e-4);
        let rounded = worst(&cells, "columns, single", "1");
        assert!((1e-3..0.1).contains(&rounded), "{rounded}");
        assert!(worst(&cells, "quotient", "1") > 0.1, "a texel is longer than a metre");
    }
}
