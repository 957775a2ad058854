//! One line through the tables.

use super::build::{mean_between, mean_from_start};
use super::{Columns, Rows};
use crate::atmosphere::MAX_COMPONENTS;
use crate::geometry::{Place, Shape};
use glam::DVec3;

/// The part of a ray inside the atmosphere, with its columns.
///
/// A point of it is named by its distance s in m from the perigee of the line, negative before the perigee; between
/// planes s is the signed distance from the ground along the line.
#[derive(Debug, Clone, Copy)]
pub struct Chord<'a, const L: usize> {
    columns: &'a Columns<L>,
    /// Altitude of the perigee in m, below 0 if the line cuts the planet; its radius in m.
    perigee: (f64, f64),
    /// Distance in m along the line for each metre of altitude, between planes.
    slant: f64,
    /// The two rows of means, and the share of the second.
    rows: (&'a [f32], &'a [f32], f64),
    /// The cell of altitude that the line starts from.
    lowest: usize,
    /// Distance of the line's start from the perigee: of the ground, or 0.
    origin: f64,
    /// Density at the start of the line.
    start_density: [f64; MAX_COMPONENTS],
    /// Where the ray itself begins, perhaps outside the atmosphere.
    eye: f64,
    from: f64,
    to: f64,
    ground: bool,
    /// Columns of the lanes at `from`.
    passed: Lanes,
}

/// What a table says at a point of a chord.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point<const L: usize> {
    /// Optical depth from the beginning of the chord.
    pub depth: [f64; L],
    /// Its derivative by the distance in m^-1: the extinction coefficient as the table has it.
    pub slope: [f64; L],
}

/// Columns of all lanes.
type Lanes = [f64; MAX_COMPONENTS];

impl<const L: usize> Columns<L> {
    /// The chord of the ray from `place` in the unit `direction`; `None` if it never enters the atmosphere. A ray that
    /// begins on the ground and looks down has a chord without length.
    #[must_use]
    #[inline]
    pub fn chord(&self, place: Place, direction: DVec3) -> Option<Chord<'_, L>> {
        let mu = place.up.dot(direction).clamp(-1.0, 1.0);
        let h = place.altitude_m;
        let top = self.top_m();
        match self.shape {
            Shape::Flat => {
                // As in `Ray`: a level line between planes would never end.
                let mu = if mu.abs() < 1e-9 { 1e-9_f64.copysign(mu) } else { mu };
                let slant = 1.0 / mu.abs();
                let to = if mu > 0.0 { top * slant } else { 0.0 };
                let eye = (h * slant).copysign(mu);
                let from = (h.min(top) * slant).copysign(mu);
                let rows = self.ground.pair(self.lanes, self.altitudes.nodes().len(), 0, 0.0);
                let chord = Chord {
                    columns: self,
                    perigee: (0.0, 0.0),
                    slant,
                    rows,
                    lowest: 0,
                    origin: 0.0,
                    start_density: self.ground.start(self.lanes, 0, 0.0),
                    eye,
                    from,
                    to,
                    ground: mu < 0.0,
                    passed: [0.0; MAX_COMPONENTS],
                };
                (to > from || chord.ground).then(|| chord.begun())
            }
            Shape::Sphere { radius_m } => self.spherical(radius_m, h, mu),
        }
    }

    #[inline]
    fn spherical(&self, radius: f64, h: f64, mu: f64) -> Option<Chord<'_, L>> {
        let top = self.top_m();
        let r0 = radius + h;
        let sine = ((1.0 - mu) * (1.0 + mu)).sqrt();
        // R + p = r_0 sin: p = h - r_0 (1 - sin), and 1 - sin = mu^2 / (1 + sin) does not cancel.
        let perigee = h - r0 * mu * mu / (1.0 + sine);
        if perigee >= top || (h >= top && mu >= 0.0) {
            return None;
        }
        let eye = r0 * mu;
        let end = ((top - perigee) * (2.0 * radius + top + perigee)).sqrt();
        let from = if h > top { -end } else { eye };
        let nodes = self.altitudes.nodes().len();
        let cuts = perigee < 0.0;
        let ground = cuts && mu < 0.0;
        let (table, at, origin) = if cuts {
            let origin = (-perigee * (2.0 * radius + perigee)).max(0.0).sqrt();
            (&self.ground, origin / radius, origin)
        } else {
            (&self.limb, perigee, 0.0)
        };
        let (row, share) = table.at.locate(at);
        let to = if ground { -origin } else { end };
        let chord = Chord {
            columns: self,
            perigee: (perigee, radius + perigee),
            slant: 0.0,
            rows: table.pair(self.lanes, nodes, row, share),
            lowest: if cuts { 0 } else { self.altitudes.cell(perigee) },
            origin,
            start_density: table.start(self.lanes, row, share),
            eye,
            // Rounding can put an eye on the ground below it.
            from: match (cuts, ground) {
                (true, true) => from.min(to),
                (true, false) => from.max(origin),
                _ => from,
            },
            to,
            ground,
            passed: [0.0; MAX_COMPONENTS],
        };
        (to > chord.from || ground).then(|| chord.begun())
    }

    /// Transmittance at each wavelength from `place` in the unit `direction` out to space; `None` if the planet is in the way.
    #[must_use]
    #[inline]
    pub fn transmittance(&self, place: Place, direction: DVec3) -> Option<[f64; L]> {
        match self.chord(place, direction) {
            None => Some([1.0; L]),
            Some(chord) if chord.ground => None,
            Some(chord) => Some(chord.total().map(|tau| (-tau).exp())),
        }
    }

    /// Optical depths of columns.
    #[inline]
    fn depths(&self, columns: &Lanes) -> [f64; L] {
        let mut depth = [0.0; L];
        for (column, sigma) in columns.iter().zip(&self.extinction) {
            for (depth, sigma) in depth.iter_mut().zip(sigma) {
                *depth += column * sigma;
            }
        }
        depth
    }
}

impl Rows {
    /// Rows `row` and `row + 1`.
    #[inline]
    fn pair(&self, lanes: usize, nodes: usize, row: usize, share: f64) -> (&[f32], &[f32], f64) {
        let length = lanes * nodes;
        let (a, b) = self.means[row * length..(row + 2) * length].split_at(length);
        (a, b, share)
    }

    #[inline]
    fn start(&self, lanes: usize, row: usize, share: f64) -> Lanes {
        let (a, b) = self.starts[row * lanes..(row + 2) * lanes].split_at(lanes);
        let mut start = [0.0; MAX_COMPONENTS];
        for (start, (a, b)) in start.iter_mut().zip(a.iter().zip(b)) {
            *start = a + share * (b - a);
        }
        start
    }
}

impl<const L: usize> Chord<'_, L> {
    /// First and last point inside the atmosphere.
    #[must_use]
    pub fn ends(&self) -> (f64, f64) {
        (self.from, self.to)
    }

    /// Whether the chord ends on the ground.
    #[must_use]
    pub fn ends_on_ground(&self) -> bool {
        self.ground
    }

    /// Distance in m of a point from the beginning of the ray.
    #[must_use]
    #[inline]
    pub fn travelled(&self, s: f64) -> f64 {
        s - self.eye
    }

    /// Altitude of a point in m.
    #[must_use]
    #[inline]
    pub fn altitude(&self, s: f64) -> f64 {
        let (perigee, radius) = self.perigee;
        match self.columns.shape {
            Shape::Flat => s.abs() / self.slant,
            Shape::Sphere { .. } => perigee + s * s / (radius + (radius * radius + s * s).sqrt()),
        }
    }

    /// The chord with the columns of its beginning.
    #[inline]
    fn begun(mut self) -> Self {
        self.passed = self.column_and_slope(self.from).0;
        self
    }

    /// Optical depth of the whole chord: it ends on the ground, from which columns count, or at the last node.
    #[must_use]
    #[inline]
    pub fn total(&self) -> [f64; L] {
        let last = self.columns.altitudes.nodes().len() - 1;
        let length = if self.ground { 0.0 } else { self.to - self.origin };
        let mut column = [0.0; MAX_COMPONENTS];
        for (lane, column) in column.iter_mut().enumerate().take(self.columns.lanes) {
            *column = self.node_mean(last, lane) * length - self.passed[lane];
        }
        self.columns.depths(&column)
    }

    /// Optical depth from the beginning to a point of the chord, and its slope there.
    #[must_use]
    #[inline]
    pub fn point(&self, s: f64) -> Point<L> {
        let (mut column, slope) = self.column_and_slope(s);
        for (column, passed) in column.iter_mut().zip(&self.passed) {
            *column -= passed;
        }
        Point { depth: self.columns.depths(&column), slope: self.columns.depths(&slope) }
    }

    /// Distance in m from the perigee at which the line passes an altitude in m.
    #[must_use]
    #[inline]
    pub fn distance(&self, h: f64) -> f64 {
        let (perigee, radius) = self.perigee;
        match self.columns.shape {
            Shape::Flat => h * self.slant,
            // (h - p)(2R + h + p) = (h - p)((R + p) + (R + p) + (h - p))
            Shape::Sphere { .. } => {
                let above = (h - perigee).max(0.0);
                (above * (2.0 * radius + above)).sqrt()
            }
        }
    }

    /// Distance of node `k` from the perigee.
    #[inline]
    fn node_distance(&self, k: usize) -> f64 {
        self.distance(self.columns.altitudes.nodes()[k])
    }

    /// Mean density of a lane up to node `k`.
    #[inline]
    fn node_mean(&self, k: usize, lane: usize) -> f64 {
        let i = k * self.columns.lanes + lane;
        let (a, b, share) = self.rows;
        let (a, b) = (f64::from(a[i]), f64::from(b[i]));
        a + share * (b - a)
    }

    /// ds/dh where the altitude is `h` and the distance from the perigee is `s`.
    #[inline]
    fn stretch(&self, h: f64, s: f64) -> f64 {
        match self.columns.shape {
            Shape::Flat => self.slant,
            Shape::Sphere { .. } => (self.perigee.1 + (h - self.perigee.0)) / s,
        }
    }

    /// Cell `k` of this line; the lowest begins where the line does.
    #[inline]
    fn cell(&self, k: usize) -> Cell {
        let nodes = self.columns.altitudes.nodes();
        let (from, to) = (nodes[k], nodes[k + 1]);
        let start = k == self.lowest;
        // Where a line turns just below the cell, the mean from there has a slope that rounding or a jump make as steep as
        // one over that distance; the mean from the bottom of the cell has not.
        let turned = k == self.lowest + 1 && self.perigee.0 > 0.0 && from - self.perigee.0 < to - from;
        let from = if start { from.max(self.perigee.0) } else { from };
        let height = to - from;
        let low_length = if start { 0.0 } else { self.node_distance(k) - self.origin };
        let skipped = if turned { low_length } else { 0.0 };
        let slope = |h: f64, k: usize| {
            let s = self.node_distance(k);
            let length = s - self.origin - skipped;
            (length + skipped, if length > 0.0 { height * self.stretch(h, s) / length } else { 0.0 })
        };
        let low_factor = if start || turned { 0.0 } else { slope(from, k).1 };
        let (high_length, high_factor) = slope(to, k + 1);
        Cell { k, start, skipped, from, height, low_length, low_factor, high_length, high_factor }
    }

    /// Mean density up to the fraction t of a cell, from where the cell's means count, and its derivative by t.
    #[inline]
    fn mean(&self, cell: &Cell, lane: usize, t: f64) -> [f64; 2] {
        let lanes = self.columns.lanes;
        let densities = &self.columns.densities[2 * cell.k * lanes..2 * (cell.k + 1) * lanes];
        let high = self.node_mean(cell.k + 1, lane);
        if cell.skipped > 0.0 {
            let column = high * cell.high_length - self.skipped(cell, lane);
            let high = column / (cell.high_length - cell.skipped);
            return mean_from_start(t, densities[lane], (high, (densities[lanes + lane] - high) * cell.high_factor));
        }
        let high = (high, (densities[lanes + lane] - high) * cell.high_factor);
        if cell.start {
            mean_from_start(t, self.start_density[lane], high)
        } else {
            let low = self.node_mean(cell.k, lane);
            mean_between(t, (low, (densities[lane] - low) * cell.low_factor), high)
        }
    }

    /// Column of a lane below a cell whose means count from its bottom.
    #[inline]
    fn skipped(&self, cell: &Cell, lane: usize) -> f64 {
        if cell.skipped > 0.0 { self.node_mean(cell.k, lane) * cell.skipped } else { 0.0 }
    }

    /// Column of each lane from the line's start to |s|, with the sign of s, and the densities there.
    #[inline]
    fn column_and_slope(&self, s: f64) -> (Lanes, Lanes) {
        let distance = s.abs();
        let (mut columns, mut slopes) = ([0.0; MAX_COMPONENTS], [0.0; MAX_COMPONENTS]);
        let altitude = self.altitude(distance);
        let cell = self.cell(self.columns.altitudes.cell(altitude).max(self.lowest));
        let length = (distance - self.origin - cell.skipped).max(0.0);
        let (t, by_distance) = self.fraction(&cell, altitude, distance);
        for lane in 0..self.columns.lanes {
            let [mean, slope] = self.mean(&cell, lane, t);
            columns[lane] = self.skipped(&cell, lane) + mean * length;
            slopes[lane] = mean + slope * length * by_distance;
        }
        if s < 0.0 {
            columns.iter_mut().for_each(|c| *c = -*c);
        }
        (columns, slopes)
    }

    /// Fraction t of a cell's height, and dt/ds.
    #[inline]
    fn fraction(&self, cell: &Cell, altitude: f64, distance: f64) -> (f64, f64) {
        if cell.height <= 0.0 {
            return (1.0, 0.0);
        }
        let t = ((altitude - cell.from) / cell.height).clamp(0.0, 1.0);
        let by_distance = match self.columns.shape {
            Shape::Flat => 1.0 / self.slant,
            Shape::Sphere { .. } => distance / (self.perigee.1 + (altitude - self.perigee.0)),
        };
        (t, by_distance / cell.height)
    }

    /// The point at which the optical depth from the beginning of the chord reaches `depth` at wavelength `hero`; the
    /// chord's end if it does not.
    #[must_use]
    pub fn at_depth(&self, hero: usize, depth: f64) -> f64 {
        let target = self.hero(hero, &self.passed) + depth;
        // Before the perigee columns count backwards.
        let s = self.invert(hero, target.abs()).copysign(target);
        s.clamp(self.from, self.to)
    }

    #[inline]
    fn hero(&self, hero: usize, columns: &Lanes) -> f64 {
        columns.iter().zip(&self.columns.extinction).map(|(column, sigma)| column * sigma[hero]).sum()
    }

    /// Distance from the perigee at which the optical depth from the line's start is `target`.
    #[inline]
    fn invert(&self, hero: usize, target: f64) -> f64 {
        let columns = self.columns;
        let node_depth = |k: usize| {
            let length = self.node_distance(k) - self.origin;
            let density: f64 =
                (0..columns.lanes).map(|lane| self.node_mean(k, lane) * columns.extinction[lane][hero]).sum();
            density * length
        };
        // The last node whose depth is not above the target.
        let (mut low, mut high) = (self.lowest, columns.altitudes.nodes().len() - 1);
        while high - low > 1 {
            let middle = (low + high) / 2;
            if node_depth(middle) <= target { low = middle } else { high = middle }
        }
        let cell = self.cell(low);
        // The depth rises with the distance: Newton, kept between ends that enclose the root.
        let (mut least, mut most) = (self.origin + cell.low_length, self.origin + cell.high_length);
        let bottom = if cell.start { 0.0 } else { node_depth(low) };
        let rise = node_depth(low + 1) - bottom;
        if rise <= 0.0 || target - bottom >= rise {
            return most;
        }
        let skipped = if cell.skipped > 0.0 { bottom } else { 0.0 };
        let mut s = least + (most - least) * ((target - bottom) / rise).max(0.0);
        for _ in 0..60 {
            let altitude = self.altitude(s);
            let (t, by_distance) = self.fraction(&cell, altitude, s);
            let length = (s - self.origin - cell.skipped).max(0.0);
            let (mut mean, mut slope) = (0.0, 0.0);
            for (lane, sigma) in columns.extinction.iter().enumerate() {
                let [value, derivative] = self.mean(&cell, lane, t);
                mean += value * sigma[hero];
                slope += derivative * sigma[hero];
            }
            let off = skipped + mean * length - target;
            if off.abs() <= 1e-10 * rise {
                break;
            }
            if off > 0.0 {
                most = s
            } else {
                least = s
            }
            let next = s - off / (mean + slope * length * by_distance);
            s = if next > least && next < most { next } else { 0.5 * (least + most) };
        }
        s
    }
}

/// A cell of altitude on one line.
struct Cell {
    k: usize,
    /// Whether the line starts in it.
    start: bool,
    /// Distance from the line's start to where the cell's means count from: 0, or its bottom.
    skipped: f64,
    /// Its lower end in m, and its height.
    from: f64,
    height: f64,
    /// Distances of its ends from the line's start.
    low_length: f64,
    high_length: f64,
    /// height (ds/dh) / length: what turns density - mean into the derivative of the mean by the fraction of the cell.
    low_factor: f64,
    high_factor: f64,
}
