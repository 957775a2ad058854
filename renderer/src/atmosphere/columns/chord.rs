//! One line through the tables.

use super::build::{between_weights, from_start_weights};
use super::{Columns, Rows};
use crate::geometry::{Place, Shape};
use crate::vectors::exp_minus;
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
    /// The two rows, and the share of the second.
    rows: Pair<'a, L>,
    /// The cell of altitude that the line starts from.
    lowest: usize,
    /// Distance of the line's start from the perigee: of the ground, or 0.
    origin: f64,
    /// Where the ray itself begins, perhaps outside the atmosphere.
    eye: f64,
    from: f64,
    to: f64,
    ground: bool,
    /// Optical depths at `from`.
    passed: [f64; L],
}

/// Two rows of a table: mean extinctions at their nodes, extinctions at their starts, and the share of the second row.
#[derive(Debug, Clone, Copy)]
struct Pair<'a, const L: usize> {
    means: [&'a [[f32; L]]; 2],
    starts: [&'a [f64; L]; 2],
    share: f64,
}

/// What a table says at a point of a chord.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Point<const L: usize> {
    /// Optical depth from the beginning of the chord.
    pub depth: [f64; L],
    /// Its derivative by the distance in m^-1: the extinction coefficient as the table has it.
    pub slope: [f64; L],
}

impl<const L: usize> Columns<L> {
    /// The chord of the ray from `place` in the unit `direction`; `None` if it never enters the atmosphere. A ray that
    /// begins on the ground and looks down has a chord without length.
    #[must_use]
    #[inline(always)]
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
                let chord = Chord {
                    columns: self,
                    perigee: (0.0, 0.0),
                    slant,
                    rows: self.ground.pair(self.altitudes.nodes().len(), 0, 0.0),
                    lowest: 0,
                    origin: 0.0,
                    eye,
                    from,
                    to,
                    ground: mu < 0.0,
                    passed: [0.0; L],
                };
                (to > from || chord.ground).then(|| chord.begun(h.min(top)))
            }
            Shape::Sphere { radius_m } => self.spherical(radius_m, h, mu),
        }
    }

    #[inline(always)]
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
        let (row, share) = table.locate(at);
        let to = if ground { -origin } else { end };
        let chord = Chord {
            columns: self,
            perigee: (perigee, radius + perigee),
            slant: 0.0,
            rows: table.pair(nodes, row, share),
            lowest: if cuts { 0 } else { self.altitudes.cell(perigee) },
            origin,
            eye,
            // Rounding can put an eye on the ground below it.
            from: match (cuts, ground) {
                (true, true) => from.min(to),
                (true, false) => from.max(origin),
                _ => from,
            },
            to,
            ground,
            passed: [0.0; L],
        };
        (to > chord.from || ground).then(|| chord.begun(h.min(top)))
    }

    /// Transmittance at each wavelength from `place` in the unit `direction` out to space; `None` if the planet is in the way.
    #[must_use]
    #[inline(always)]
    pub fn transmittance(&self, place: Place, direction: DVec3) -> Option<[f64; L]> {
        match self.chord(place, direction) {
            None => Some([1.0; L]),
            Some(chord) if chord.ground => None,
            Some(chord) => Some(exp_minus(chord.total())),
        }
    }
}

impl<const L: usize> Rows<L> {
    /// The row below `at`, and the share of the next.
    #[inline(always)]
    fn locate(&self, at: f64) -> (usize, f64) {
        let (row, share) = self.at.locate(at);
        let Some(jump) = self.under[row] else { return (row, share) };
        let [a, b] = [row, row + 1].map(|row| (jump - self.at.nodes()[row]).sqrt());
        (row, ((a - (jump - at).max(0.0).sqrt()) / (a - b)).clamp(0.0, 1.0))
    }

    /// Rows `row` and `row + 1`, each of `nodes` nodes.
    #[inline(always)]
    fn pair(&self, nodes: usize, row: usize, share: f64) -> Pair<'_, L> {
        let (a, b) = self.means[row * nodes..(row + 2) * nodes].split_at(nodes);
        Pair { means: [a, b], starts: [&self.starts[row], &self.starts[row + 1]], share }
    }
}

impl<const L: usize> Pair<'_, L> {
    /// Mean extinction up to node `k` at wavelength `j`.
    #[inline(always)]
    fn mean(&self, k: usize, j: usize) -> f64 {
        let [a, b] = self.means.map(|row| f64::from(row[k][j]));
        a + self.share * (b - a)
    }

    /// Mean extinctions up to node `k`.
    #[inline(always)]
    fn means(&self, k: usize) -> [f64; L] {
        let [a, b] = [&self.means[0][k], &self.means[1][k]];
        let mut means = [0.0; L];
        for j in 0..L {
            let (a, b) = (f64::from(a[j]), f64::from(b[j]));
            means[j] = a + self.share * (b - a);
        }
        means
    }

    /// Extinctions at the start of the line.
    #[inline(always)]
    fn begins(&self) -> [f64; L] {
        let [a, b] = self.starts;
        let mut begins = [0.0; L];
        for j in 0..L {
            begins[j] = a[j] + self.share * (b[j] - a[j]);
        }
        begins
    }

    /// Extinction at the start of the line at wavelength `j`.
    #[inline(always)]
    fn start(&self, j: usize) -> f64 {
        let [a, b] = self.starts.map(|start| start[j]);
        a + self.share * (b - a)
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

    /// The place at `s`, of the ray that begins at `from` in that direction; rounding puts it neither under the ground nor above the air.
    #[must_use]
    #[inline(always)]
    pub fn place(&self, from: Place, direction: DVec3, s: f64) -> Place {
        let mut place = from.advance(self.columns.shape, direction, self.travelled(s));
        place.altitude_m = place.altitude_m.clamp(0.0, self.columns.top_m());
        place
    }

    /// The place on the ground where the ray ends, if it does.
    #[must_use]
    #[inline(always)]
    pub fn foot(&self, from: Place, direction: DVec3) -> Place {
        let place = from.advance(self.columns.shape, direction, self.travelled(self.to).max(0.0));
        Place { altitude_m: 0.0, ..place }
    }

    /// Altitude in m of the perigee of the line, below 0 if it cuts the planet.
    #[must_use]
    pub fn perigee(&self) -> f64 {
        self.perigee.0
    }

    /// Altitude of a point in m.
    #[must_use]
    #[inline(always)]
    pub fn altitude(&self, s: f64) -> f64 {
        let (perigee, radius) = self.perigee;
        match self.columns.shape {
            Shape::Flat => s.abs() / self.slant,
            Shape::Sphere { .. } => perigee + s * s / (radius + (radius * radius + s * s).sqrt()),
        }
    }

    /// The chord with the optical depths of its beginning, which is at that altitude.
    #[inline(always)]
    fn begun(mut self, altitude: f64) -> Self {
        let distance = self.from.abs();
        if distance > self.origin {
            let cell = self.cell(self.columns.altitudes.cell(altitude).max(self.lowest));
            self.passed = self.depths(&cell, altitude, distance);
            if self.from < 0.0 {
                self.passed = self.passed.map(|depth| -depth);
            }
        }
        self
    }

    /// Optical depth of the whole chord: it ends on the ground, from which depths count, or at the last node.
    #[must_use]
    #[inline(always)]
    pub fn total(&self) -> [f64; L] {
        let last = self.columns.altitudes.nodes().len() - 1;
        if self.ground {
            return self.passed.map(|depth| -depth);
        }
        let base = self.columns.bases[last];
        let (length, means, before) = (self.to - self.base_distance(base), self.rows.means(last), self.before(base));
        let mut total = [0.0; L];
        for j in 0..L {
            total[j] = means[j] * length + (before[j] - self.passed[j]);
        }
        total
    }

    /// Optical depth from the beginning to a point of the chord, and its slope there.
    #[must_use]
    #[inline(always)]
    pub fn point(&self, s: f64) -> Point<L> {
        let distance = s.abs();
        let altitude = self.altitude(distance);
        let cell = self.cell(self.columns.altitudes.cell(altitude).max(self.lowest));
        self.seen_from_the_beginning(self.point_of_line(&cell, altitude, distance), s)
    }

    /// A point counted from the line's start, as one at `s` counted from the beginning of the chord.
    #[inline(always)]
    fn seen_from_the_beginning(&self, point: Point<L>, s: f64) -> Point<L> {
        let sign = if s < 0.0 { -1.0 } else { 1.0 };
        let mut point = point;
        for j in 0..L {
            point.depth[j] = sign * point.depth[j] - self.passed[j];
        }
        point
    }

    /// Distance in m from the perigee at which the line passes an altitude in m.
    #[must_use]
    #[inline(always)]
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
    #[inline(always)]
    fn node_distance(&self, k: usize) -> f64 {
        self.distance(self.columns.altitudes.nodes()[k])
    }

    /// Distance from the perigee of what means count from: a jump, or the start of the line if that is higher.
    #[inline(always)]
    fn base_distance(&self, base: usize) -> f64 {
        if base > self.lowest { self.node_distance(base) } else { self.origin }
    }

    /// Optical depths from the start of the line to a jump above it; 0 if it is below.
    #[inline(always)]
    fn before(&self, base: usize) -> [f64; L] {
        let mut sum = [0.0; L];
        let mut jump = base;
        while jump > self.lowest {
            let below = self.columns.bases[jump];
            let length = self.node_distance(jump) - self.base_distance(below);
            for (sum, mean) in sum.iter_mut().zip(self.rows.means(jump)) {
                *sum += mean * length;
            }
            jump = below;
        }
        sum
    }

    /// Cell `k` of this line; the lowest begins where the line does.
    #[inline(always)]
    fn cell(&self, k: usize) -> Cell {
        let nodes = self.columns.altitudes.nodes();
        let (from, to) = (nodes[k], nodes[k + 1]);
        let base = self.columns.bases[k + 1];
        let base_distance = self.base_distance(base);
        // Means count from the bottom of the cell if the line starts in it or a jump is there.
        let start = k == self.lowest || base == k;
        // Where a line turns close below the cell the slope of the mean at its bottom is lost to rounding.
        let close = start || (self.perigee.0 > 0.0 && from - self.perigee.0 < to - from);
        let from = if start { from.max(self.perigee.0) } else { from };
        let height = to - from;
        let low_length = if start { 0.0 } else { self.node_distance(k) - base_distance };
        // Height (ds/dh) / length; ds/dh = (R + h) / s.
        let factor = |h: f64, s: f64, length: f64| match self.columns.shape {
            _ if length <= 0.0 => 0.0,
            Shape::Flat => height * self.slant / length,
            Shape::Sphere { .. } => height * (self.perigee.1 + (h - self.perigee.0)) / (s * length),
        };
        let low_factor = if close { 0.0 } else { factor(from, low_length + base_distance, low_length) };
        let high_distance = self.node_distance(k + 1);
        let high_length = high_distance - base_distance;
        let high_factor = factor(to, high_distance, high_length);
        let per_height = if height > 0.0 { 1.0 / height } else { 0.0 };
        Cell {
            k,
            start,
            close,
            base,
            base_distance,
            from,
            per_height,
            low_length,
            low_factor,
            high_length,
            high_factor,
        }
    }

    /// What the ends of a cell have: means, and extinctions.
    #[inline(always)]
    fn ends_of(&self, cell: &Cell) -> [[f64; L]; 4] {
        let [at_low, at_high] = self.columns.extinction[cell.k];
        let low = match cell.start {
            true if cell.k == self.lowest => self.rows.begins(),
            true => at_low,
            false => self.rows.means(cell.k),
        };
        [low, self.rows.means(cell.k + 1), at_low, at_high]
    }

    /// Weights of the mean and of its derivative by the fraction t of a cell, for (low, high, extinction at either).
    #[inline(always)]
    fn weights(cell: &Cell, t: f64) -> [[f64; 4]; 2] {
        let (a, b) = (cell.low_factor, cell.high_factor);
        let both = if cell.close { from_start_weights(t) } else { between_weights(t) };
        // The slopes of the mean at the ends are factor (extinction - mean).
        both.map(|w| [w[0] - a * w[2], w[1] - b * w[3], a * w[2], b * w[3]])
    }

    /// Optical depths from the line's start to a distance from the perigee, where the altitude is `altitude`.
    #[inline(always)]
    fn depths(&self, cell: &Cell, altitude: f64, distance: f64) -> [f64; L] {
        let length = (distance - cell.base_distance).max(0.0);
        let [value, _] = Self::weights(cell, cell.fraction(altitude));
        let mut depth = [0.0; L];
        let [low, high, at_low, at_high] = self.ends_of(cell);
        let before = self.before(cell.base);
        for j in 0..L {
            let ends = [low[j], high[j], at_low[j], at_high[j]];
            depth[j] = before[j] + length * dot(value, ends);
        }
        depth
    }

    /// As [`Chord::depths`], with the slopes.
    #[inline(always)]
    fn point_of_line(&self, cell: &Cell, altitude: f64, distance: f64) -> Point<L> {
        let length = (distance - cell.base_distance).max(0.0);
        let [value, derivative] = Self::weights(cell, cell.fraction(altitude));
        // dh/ds = s / (R + h)
        let by_distance = cell.per_height
            * match self.columns.shape {
                Shape::Flat => 1.0 / self.slant,
                Shape::Sphere { .. } => distance / (self.perigee.1 + (altitude - self.perigee.0)),
            };
        let mut point = Point { depth: [0.0; L], slope: [0.0; L] };
        let [low, high, at_low, at_high] = self.ends_of(cell);
        let before = self.before(cell.base);
        for j in 0..L {
            let ends = [low[j], high[j], at_low[j], at_high[j]];
            let mean = dot(value, ends);
            point.depth[j] = before[j] + mean * length;
            point.slope[j] = mean + dot(derivative, ends) * length * by_distance;
        }
        point
    }

    /// The place s at which the optical depth from the beginning of the chord reaches `depth` at wavelength `hero`, the
    /// chord's end if it does not; and what the table says there.
    #[must_use]
    #[inline]
    pub fn at_depth(&self, hero: usize, depth: f64) -> (f64, Point<L>) {
        let target = self.passed[hero] + depth;
        // Before the perigee depths count backwards.
        let (distance, point) = self.invert(hero, target.abs());
        let s = distance.copysign(target);
        let within = s.clamp(self.from, self.to);
        (within, if within == s { self.seen_from_the_beginning(point, s) } else { self.point(within) })
    }

    /// Distance from the perigee at which the optical depth from the line's start is `target`, and the point there.
    #[inline]
    fn invert(&self, hero: usize, target: f64) -> (f64, Point<L>) {
        let nodes = self.columns.altitudes.nodes();
        // Between which jumps: the node and the depth from which means count, and the first node that is too far.
        let (mut low, mut high) = (self.lowest, nodes.len() - 1);
        let mut before = 0.0;
        for &jump in self.columns.jumps.iter().filter(|&&jump| jump > self.lowest) {
            let from = self.base_distance(self.columns.bases[jump]);
            let there = before + self.rows.mean(jump, hero) * (self.node_distance(jump) - from);
            if there > target {
                high = jump;
                break;
            }
            (low, before) = (jump, there);
        }
        // Whether the depth of node k is at most the target: mean (s - s_base) <= target, squared where s is a root.
        let target = target - before;
        let from = self.base_distance(low);
        let passed = |k: usize| {
            let mean = self.rows.mean(k, hero);
            match self.columns.shape {
                Shape::Flat => mean * (nodes[k] * self.slant - from) <= target,
                Shape::Sphere { .. } => {
                    let above = (nodes[k] - self.perigee.0).max(0.0);
                    let reach = target + mean * from;
                    mean * mean * (above * (2.0 * self.perigee.1 + above)) <= reach * reach
                }
            }
        };
        while high - low > 1 {
            let middle = (low + high) / 2;
            if passed(middle) { low = middle } else { high = middle }
        }
        let cell = self.cell(low);
        let [at_low, at_high] = &self.columns.extinction[low];
        let (bottom, slope_low) = if cell.start {
            (0.0, if low == self.lowest { self.rows.start(hero) } else { at_low[hero] })
        } else {
            (self.rows.mean(low, hero) * cell.low_length, at_low[hero])
        };
        let rise = self.rows.mean(low + 1, hero) * cell.high_length - bottom;
        let (mut least, mut most) = (cell.base_distance + cell.low_length, cell.base_distance + cell.high_length);
        let point = |s: f64| self.point_of_line(&cell, self.altitude(s), s);
        if rise <= 0.0 || target - bottom >= rise {
            return (most, point(most));
        }
        // The depth rises with the distance. The first guess is the cubic for s by depth with the right slopes at the ends, if these are slopes;
        // then Newton's rule, kept between ends that enclose the root.
        let share = ((target - bottom) / rise).max(0.0);
        let straight = most - least;
        let [slow, fast] = [slope_low, at_high[hero]].map(|slope| (rise / (slope * straight)).clamp(0.0, 3.0));
        let [w, _] = between_weights(share);
        let mut s = least + straight * (w[1] + slow * w[2] + fast * w[3]).clamp(0.0, 1.0);
        for _ in 0..60 {
            let here = point(s);
            let off = here.depth[hero] - before - target;
            if off.abs() <= INVERSION * rise {
                return (s, here);
            }
            if off > 0.0 {
                most = s
            } else {
                least = s
            }
            let next = s - off / here.slope[hero];
            s = if next > least && next < most { next } else { 0.5 * (least + most) };
        }
        (s, point(s))
    }
}

#[inline(always)]
fn dot(a: [f64; 4], b: [f64; 4]) -> f64 {
    (a[0] * b[0] + a[1] * b[1]) + (a[2] * b[2] + a[3] * b[3])
}

/// How exactly a depth is met, as a share of that of the cell: the density of what is drawn is off by about as much.
const INVERSION: f64 = 1e-7;

/// A cell of altitude on one line.
struct Cell {
    k: usize,
    /// Whether the line or its means start in it.
    start: bool,
    /// Whether the line turns so close below that the mean's slope at the bottom is not used.
    close: bool,
    /// The jump from which means count, if it is above the line's start, and the distance of either from the perigee.
    base: usize,
    base_distance: f64,
    /// Its lower end in m, and 1 / height.
    from: f64,
    per_height: f64,
    /// Distances of its ends from the base.
    low_length: f64,
    high_length: f64,
    /// height (ds/dh) / length, the length from the base: what turns extinction - mean into the derivative of the mean by the fraction of the cell.
    low_factor: f64,
    high_factor: f64,
}

impl Cell {
    /// The fraction of the height below an altitude; the upper end of a cell without height.
    #[inline(always)]
    fn fraction(&self, altitude: f64) -> f64 {
        if self.per_height > 0.0 { ((altitude - self.from) * self.per_height).clamp(0.0, 1.0) } else { 1.0 }
    }
}
