//! A layered medium at `L` wavelengths.

use crate::geometry::{End, Place, Ray, Segment, Shape};
use crate::lookup::Lookup;
use crate::phase::Phase;
use glam::DVec3;
use tables::{Curve, Interpolation, Outside, Scale, TableError};

/// The most components that one medium may have.
pub const MAX_COMPONENTS: usize = 12;

/// A species of scatterers or absorbers: one profile, one spectrum of
/// cross-sections. Both may be given in any pair of units whose product is m^-1.
#[derive(Debug, Clone)]
pub struct Component<const L: usize> {
    /// Number density in m^-3 against altitude in m. It may be negative where the
    /// component is a term of a sum (ozone's temperature polynomial).
    pub density: Curve,
    /// Scattering cross-section in m^2 at each wavelength.
    pub scattering: [f64; L],
    /// Absorption cross-section in m^2 at each wavelength.
    pub absorption: [f64; L],
    /// Where scattered light goes.
    pub phase: Phase<L>,
}

impl<const L: usize> Component<L> {
    /// Whether it scatters at any wavelength.
    #[must_use]
    #[inline]
    pub fn scatters(&self) -> bool {
        self.scattering.iter().any(|&sigma| sigma > 0.0)
    }
}

/// Why components do not make a medium.
#[derive(Debug, thiserror::Error)]
pub enum MediumError {
    /// Too many components, or a top that is not above the ground.
    #[error("{0}")]
    Impossible(String),
    /// The coefficients add up to less than nothing somewhere.
    #[error(
        "extinction is {value:e} per metre at {altitude_m} m, wavelength number {lane}: a coefficient cannot be negative"
    )]
    Negative {
        /// Sum of the extinction coefficients, m^-1.
        value: f64,
        /// Where, in m.
        altitude_m: f64,
        /// Which wavelength.
        lane: usize,
    },
    /// A profile that does not reach over the medium.
    #[error(transparent)]
    Profile(#[from] TableError),
}

/// The density of one component within one interval of altitude.
#[derive(Debug, Clone, Copy)]
struct Span {
    /// Density at the lower end, m^-3.
    bottom: f64,
    /// Linear: rise of the density over the interval; logarithmic: of its logarithm.
    rise: f64,
    scale: Scale,
}

impl Span {
    /// Derivative of the density by the fraction of the interval.
    fn slope(self, fraction: f64) -> f64 {
        match self.scale {
            Scale::Linear => self.rise,
            Scale::Logarithmic => self.rise * self.at(fraction),
        }
    }

    fn at(self, fraction: f64) -> f64 {
        match self.scale {
            Scale::Linear => self.bottom + fraction * self.rise,
            Scale::Logarithmic => self.bottom * (fraction * self.rise).exp(),
        }
    }
}

/// A run of intervals with bounds on the extinction in it.
#[derive(Debug, Clone)]
pub struct Shell<const L: usize> {
    /// First and last + 1 of its intervals.
    intervals: std::ops::Range<usize>,
    /// Largest extinction coefficient in the shell at each wavelength, m^-1.
    pub majorant: [f64; L],
    /// A lower bound of the extinction coefficient at each wavelength, m^-1.
    pub minorant: [f64; L],
    /// Largest of majorant - minorant over the wavelengths, m^-1.
    pub spread: f64,
}

/// Coefficients at a point.
#[derive(Debug, Clone, Copy)]
pub struct Local<const L: usize> {
    /// Density of each component, m^-3.
    pub densities: [f64; MAX_COMPONENTS],
    /// Extinction coefficient, m^-1.
    pub extinction: [f64; L],
    /// Scattering coefficient, m^-1.
    pub scattering: [f64; L],
}

/// An atmosphere at `L` wavelengths: components in intervals of altitude, and
/// shells of such intervals with bounds for tracking.
#[derive(Debug, Clone)]
pub struct Medium<const L: usize> {
    components: Vec<Component<L>>,
    /// Ends of the intervals, m: 0 to the top.
    nodes: Vec<f64>,
    finder: Lookup,
    /// Span of component c in interval i at [i * components + c].
    spans: Vec<Span>,
    shells: Vec<Shell<L>>,
    /// Ends of the shells, m.
    bounds: Vec<f64>,
}

/// Shells end where the extinction has changed so much that the null
/// collisions between its bounds would add this share of the vertical optical
/// depth. Smaller: more shells to cross; larger: more collisions to draw.
const SHELL_SPREAD: f64 = 5e-3;

impl<const L: usize> Medium<L> {
    /// A medium from the ground (altitude 0) to `top_m`.
    ///
    /// # Errors
    /// [`MediumError`] for more than [`MAX_COMPONENTS`], a top that is not positive and
    /// finite, a profile that refuses an altitude below the top, or coefficients
    /// that add up to less than zero (beyond rounding, -1e-12 of the largest).
    pub fn new(components: Vec<Component<L>>, top_m: f64) -> Result<Self, MediumError> {
        if components.len() > MAX_COMPONENTS {
            let text = format!("{} components, {MAX_COMPONENTS} are possible", components.len());
            return Err(MediumError::Impossible(text));
        }
        if !(top_m.is_finite() && top_m > 0.0) {
            return Err(MediumError::Impossible(format!(
                "the top of the atmosphere must be above the ground, not at {top_m} m"
            )));
        }
        let mut nodes: Vec<f64> = components.iter().flat_map(|c| c.density.axis().nodes.iter().copied()).collect();
        nodes.retain(|&z| z > 0.0 && z < top_m);
        nodes.extend([0.0, top_m]);
        nodes.sort_by(f64::total_cmp);
        nodes.dedup();
        let mut spans = Vec::with_capacity((nodes.len() - 1) * components.len());
        for ends in nodes.windows(2) {
            for component in &components {
                spans.push(span(&component.density, ends[0], ends[1])?);
            }
        }
        let finder = Lookup::new(nodes.clone());
        let mut medium = Self { components, nodes, finder, spans, shells: Vec::new(), bounds: Vec::new() };
        medium.lay_shells()?;
        Ok(medium)
    }

    /// Ends of the shells in m, from 0 to the top.
    #[must_use]
    pub fn bounds(&self) -> &[f64] {
        &self.bounds
    }

    /// Altitude of the top in m.
    #[must_use]
    pub fn top_m(&self) -> f64 {
        self.nodes[self.nodes.len() - 1]
    }

    /// The shells, lowest first.
    #[must_use]
    pub fn shells(&self) -> &[Shell<L>] {
        &self.shells
    }

    /// The components.
    #[must_use]
    pub fn components(&self) -> &[Component<L>] {
        &self.components
    }

    /// Whether every scatterer knows what it does to polarisation ([`Phase::has_matrix`]).
    #[must_use]
    pub fn polarises(&self) -> bool {
        self.components.iter().all(|c| !c.scatters() || c.phase.has_matrix())
    }

    /// Densities of all components in interval `i` at `fraction` of its height.
    #[inline(always)]
    pub(super) fn densities(&self, interval: usize, fraction: f64) -> [f64; MAX_COMPONENTS] {
        let count = self.components.len();
        let mut densities = [0.0; MAX_COMPONENTS];
        for (density, span) in densities.iter_mut().zip(&self.spans[interval * count..(interval + 1) * count]) {
            *density = span.at(fraction);
        }
        densities
    }

    /// Interval and fraction of an altitude inside shell `shell`; altitudes
    /// that rounding put outside it count as its nearest end.
    #[inline]
    fn locate(&self, shell: usize, altitude_m: f64) -> (usize, f64) {
        let range = &self.shells[shell].intervals;
        let inner = &self.nodes[range.start + 1..range.end];
        let interval = range.start + inner.partition_point(|&z| z <= altitude_m);
        let (a, b) = (self.nodes[interval], self.nodes[interval + 1]);
        (interval, ((altitude_m - a) / (b - a)).clamp(0.0, 1.0))
    }

    /// Extinction coefficient in m^-1 at an altitude inside shell `shell`.
    #[must_use]
    pub fn extinction(&self, shell: usize, altitude_m: f64) -> [f64; L] {
        let (interval, fraction) = self.locate(shell, altitude_m);
        self.combine(&self.densities(interval, fraction))
    }

    /// Ends of the intervals in m: every profile is linear or exponential between two of them.
    pub(crate) fn nodes(&self) -> &[f64] {
        &self.nodes
    }

    /// Altitudes in m at which the density of a scatterer bends: its slope changes, over the shorter of the two intervals that meet
    /// there, by more than a fiftieth of the largest density around, of a scatterer that makes a thousandth of all or more.
    #[must_use]
    pub fn bends(&self) -> Vec<f64> {
        let count = self.components.len();
        let sigma: Vec<f64> = self.components.iter().map(|c| c.scattering.iter().sum()).collect();
        let bends = |i: usize| {
            let (low, high) = (self.nodes[i] - self.nodes[i - 1], self.nodes[i + 1] - self.nodes[i]);
            let spans = |k: usize| &self.spans[k * count..(k + 1) * count];
            let total: f64 = spans(i).iter().zip(&sigma).map(|(span, sigma)| span.at(0.0).max(0.0) * sigma).sum();
            spans(i - 1).iter().zip(spans(i)).zip(&sigma).any(|((below, above), sigma)| {
                let most = below.at(0.0).max(above.at(0.0)).max(above.at(1.0));
                let change = (above.slope(0.0) / high - below.slope(1.0) / low) * low.min(high);
                *sigma > 0.0 && most * sigma > 1e-3 * total && change.abs() > 0.02 * most
            })
        };
        (1..self.nodes.len() - 1).filter(|&i| bends(i)).map(|i| self.nodes[i]).collect()
    }

    /// Altitudes in m at which the density of a scatterer jumps by more than a hundredth of itself.
    #[must_use]
    pub fn jumps(&self) -> Vec<f64> {
        let count = self.components.len();
        let jumps = |i: usize| {
            let pairs = self.spans[(i - 1) * count..i * count].iter().zip(&self.spans[i * count..(i + 1) * count]);
            pairs.zip(&self.components).any(|((below, above), component)| {
                let (below, above) = (below.at(1.0), above.at(0.0));
                component.scatters() && (below - above).abs() > 0.01 * below.abs().max(above.abs())
            })
        };
        (1..self.nodes.len() - 1).filter(|&i| jumps(i)).map(|i| self.nodes[i]).collect()
    }

    /// Largest change of the logarithm of a density over an interval.
    pub(super) fn most_rise(&self, interval: usize) -> f64 {
        let count = self.components.len();
        let spans = &self.spans[interval * count..(interval + 1) * count];
        let exponential = spans.iter().filter(|span| span.scale == Scale::Logarithmic);
        exponential.map(|span| span.rise.abs()).fold(0.0, f64::max)
    }

    /// Extinction coefficient in m^-1 in interval `interval` at `fraction` of its height.
    pub(super) fn extinction_in(&self, interval: usize, fraction: f64) -> [f64; L] {
        self.combine(&self.densities(interval, fraction))
    }

    /// All coefficients at an altitude inside shell `shell`.
    #[must_use]
    pub fn local(&self, shell: usize, altitude_m: f64) -> Local<L> {
        let (interval, fraction) = self.locate(shell, altitude_m);
        self.local_in(interval, fraction)
    }

    /// All coefficients at an altitude in m; the nearest end of the medium for what lies outside.
    #[must_use]
    #[inline(always)]
    pub fn local_at(&self, altitude_m: f64) -> Local<L> {
        let (interval, fraction) = self.finder.locate(altitude_m);
        self.local_in(interval, fraction)
    }

    /// Densities of all components in m^-3 at an altitude in m, as [`Medium::local_at`].
    #[inline(always)]
    pub(crate) fn densities_at(&self, altitude_m: f64) -> [f64; MAX_COMPONENTS] {
        let (interval, fraction) = self.finder.locate(altitude_m);
        self.densities(interval, fraction)
    }

    #[inline]
    fn local_in(&self, interval: usize, fraction: f64) -> Local<L> {
        let densities = self.densities(interval, fraction);
        let mut scattering = [0.0; L];
        for (component, density) in self.components.iter().zip(densities) {
            for (sum, sigma) in scattering.iter_mut().zip(&component.scattering) {
                *sum += density * sigma;
            }
        }
        Local { densities, extinction: self.combine(&densities), scattering }
    }

    /// Sum over the components of density (or column) times extinction cross-section.
    #[inline]
    fn combine(&self, densities: &[f64; MAX_COMPONENTS]) -> [f64; L] {
        let mut sum = [0.0; L];
        for (component, density) in self.components.iter().zip(densities) {
            for ((sum, scattering), absorption) in sum.iter_mut().zip(&component.scattering).zip(&component.absorption)
            {
                *sum += density * (scattering + absorption);
            }
        }
        sum
    }

    /// Column of each component in m^-2 between the start and the end of the
    /// ray inside the atmosphere, by four-point Gauss-Legendre quadrature in
    /// the distance within each interval of altitude; `None` if the planet is in the way.
    #[must_use]
    pub fn columns(&self, shape: Shape, place: Place, direction: DVec3) -> Option<[f64; MAX_COMPONENTS]> {
        let ray = Ray::new(shape, place, direction);
        let mut segments: Vec<Segment> = Vec::new();
        if let End::Ground(_) = ray.segments(&self.nodes, &mut segments) {
            return None;
        }
        let mut columns = [0.0; MAX_COMPONENTS];
        for Segment { layer, start_m, end_m } in segments {
            let (middle, half) = (0.5 * (start_m + end_m), 0.5 * (end_m - start_m));
            let (a, b) = (self.nodes[layer], self.nodes[layer + 1]);
            for (x, weight) in GAUSS_4 {
                let fraction = ((ray.altitude_m(middle + half * x) - a) / (b - a)).clamp(0.0, 1.0);
                for (column, density) in columns.iter_mut().zip(self.densities(layer, fraction)) {
                    *column += weight * half * density;
                }
            }
        }
        Some(columns)
    }

    /// Optical depth at each wavelength from `place` along the unit `direction`
    /// out to space, by [`Medium::columns`]; infinite if the planet is in the way.
    #[must_use]
    pub fn optical_depth(&self, shape: Shape, place: Place, direction: DVec3) -> [f64; L] {
        self.columns(shape, place, direction).map_or([f64::INFINITY; L], |columns| self.combine(&columns))
    }

    /// Transmittance exp(-optical depth) at each wavelength from `place` along
    /// `direction` out to space; zero if the planet is in the way.
    #[must_use]
    pub fn transmittance(&self, shape: Shape, place: Place, direction: DVec3) -> [f64; L] {
        self.optical_depth(shape, place, direction).map(|tau| (-tau).exp())
    }

    /// Bounds of the extinction in one interval. Every component is linear or
    /// exponential between the ends, so their sum is convex: its largest value is at
    /// an end. The sum of the linear ones is linear and that of the
    /// exponential ones is bounded below component by component.
    fn interval_bounds(&self, interval: usize) -> ([f64; L], [f64; L]) {
        let (bottom, top) = (self.densities(interval, 0.0), self.densities(interval, 1.0));
        let (at_bottom, at_top) = (self.combine(&bottom), self.combine(&top));
        let count = self.components.len();
        let (mut linear_bottom, mut linear_top, mut least) = (bottom, top, [0.0; MAX_COMPONENTS]);
        for (c, span) in self.spans[interval * count..(interval + 1) * count].iter().enumerate() {
            if span.scale == Scale::Logarithmic {
                least[c] = bottom[c].min(top[c]);
                (linear_bottom[c], linear_top[c]) = (0.0, 0.0);
            }
        }
        let (lines_bottom, lines_top, exponentials) =
            (self.combine(&linear_bottom), self.combine(&linear_top), self.combine(&least));
        let majorant = std::array::from_fn(|j| at_bottom[j].max(at_top[j]));
        let minorant = std::array::from_fn(|j| lines_bottom[j].min(lines_top[j]) + exponentials[j]);
        (majorant, minorant)
    }

    fn lay_shells(&mut self) -> Result<(), MediumError> {
        let intervals = self.nodes.len() - 1;
        let bounds: Vec<_> = (0..intervals).map(|i| self.interval_bounds(i)).collect();
        let mut depth = [0.0; L];
        for (i, (majorant, _)) in bounds.iter().enumerate() {
            for (sum, sigma) in depth.iter_mut().zip(majorant) {
                *sum += sigma * (self.nodes[i + 1] - self.nodes[i]);
            }
        }
        for (i, (majorant, minorant)) in bounds.iter().enumerate() {
            for lane in 0..L {
                if minorant[lane] < -1e-12 * majorant[lane].abs().max(depth[lane] / self.top_m()) {
                    return Err(MediumError::Negative { value: minorant[lane], altitude_m: self.nodes[i], lane });
                }
            }
        }
        let largest = depth.iter().copied().fold(0.0, f64::max);
        let spread = |majorant: &[f64; L], minorant: &[f64; L]| {
            majorant.iter().zip(minorant).map(|(a, b)| a - b).fold(0.0, f64::max)
        };
        let mut start = 0;
        while start < intervals {
            let (mut majorant, mut minorant) = bounds[start];
            let mut end = start + 1;
            while end < intervals {
                let (upper, lower) = &bounds[end];
                let wider: [f64; L] = std::array::from_fn(|j| majorant[j].max(upper[j]));
                let lower: [f64; L] = std::array::from_fn(|j| minorant[j].min(lower[j]));
                if spread(&wider, &lower) * (self.nodes[end + 1] - self.nodes[start]) > SHELL_SPREAD * largest {
                    break;
                }
                (majorant, minorant) = (wider, lower);
                end += 1;
            }
            self.bounds.push(self.nodes[start]);
            self.shells.push(Shell { intervals: start..end, majorant, minorant, spread: spread(&majorant, &minorant) });
            start = end;
        }
        self.bounds.push(self.top_m());
        Ok(())
    }
}

/// Nodes in -1..1 and weights of the four-point Gauss-Legendre rule.
pub(crate) const GAUSS_4: [(f64, f64); 4] = [
    (-0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
    (-0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];

/// A curve within the interval from `a` to `b`, between whose ends the curve
/// has no node, from its one-sided limits.
fn span(curve: &Curve, a: f64, b: f64) -> Result<Span, TableError> {
    let (low, high) = curve.axis().range();
    let constant = |bottom: f64| Span { bottom, rise: 0.0, scale: Scale::Linear };
    let outside = a >= high || b <= low;
    if outside && curve.axis().outside == Outside::Zero {
        return Ok(constant(0.0));
    }
    if outside || curve.axis().interpolation != Interpolation::Linear {
        return Ok(constant(curve.at(0.5 * (a + b))?));
    }
    let (bottom, top) = (curve.at(a)?, curve.at(b)?);
    Ok(match curve.scale() {
        Scale::Linear => Span { bottom, rise: top - bottom, scale: Scale::Linear },
        Scale::Logarithmic => Span { bottom, rise: (top / bottom).ln(), scale: Scale::Logarithmic },
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use tables::Axis;

    const RADIUS: f64 = 6_371_000.0;
    const EARTH: Shape = Shape::Sphere { radius_m: RADIUS };

    fn component(density: Curve, scattering: f64, absorption: f64) -> Component<1> {
        Component {
            density,
            scattering: [scattering],
            absorption: [absorption],
            phase: Phase::Rayleigh { gamma: [0.0] },
        }
    }

    fn exponential(scale_height: f64, top: f64, steps: usize) -> Curve {
        let axis = Axis::uniform("altitude", "m", 0.0, top / steps as f64, steps + 1).expect("valid");
        let values = axis.nodes.iter().map(|z| (-z / scale_height).exp()).collect();
        Curve::new(axis, Scale::Logarithmic, values).expect("valid")
    }

    #[test]
    fn vertical_optical_depth_of_an_exponential_atmosphere_is_the_closed_form() {
        let (h, top) = (8e3, 1e5);
        let medium = Medium::new(vec![component(exponential(h, top, 50), 1e-5, 2e-5)], top).expect("valid");
        let exact = 3e-5 * h * (1.0 - (-top / h).exp());
        let [tau] = medium.optical_depth(EARTH, Place::above(0.0), DVec3::Z);
        // Four Gauss points on exp over a quarter of a scale height: 1e-10.
        assert!((tau / exact - 1.0).abs() < 1e-9, "{tau} for {exact}");
    }

    #[test]
    fn optical_depth_of_a_homogeneous_shell_is_the_chord() {
        let top = 5e4;
        let axis = Axis::new("altitude", "m", vec![0.0, top]).expect("valid").between(Interpolation::Step);
        let medium = Medium::new(
            vec![component(Curve::new(axis, Scale::Linear, vec![1.0, 1.0]).expect("valid"), 0.0, 1e-6)],
            top,
        )
        .expect("valid");
        for zenith in [0.0_f64, 30.0, 60.0, 85.0, 89.9, 90.0] {
            let (sin, cos) = zenith.to_radians().sin_cos();
            let chord = -RADIUS * cos + (RADIUS * RADIUS * cos * cos + 2.0 * RADIUS * top + top * top).sqrt();
            let [tau] = medium.optical_depth(EARTH, Place::above(0.0), DVec3::new(sin, 0.0, cos));
            // The plain chord above cancels to 1e-9.
            assert!((tau / (1e-6 * chord) - 1.0).abs() < 1e-8, "{tau} at zenith {zenith}");
        }
        assert!(medium.optical_depth(EARTH, Place::above(10.0), -DVec3::Z)[0].is_infinite());
    }

    #[test]
    fn bounds_hold_everywhere_and_shells_cover_the_medium() {
        let ozone = Axis::new("altitude", "m", vec![5e3, 2e4, 4e4]).expect("valid").beyond(Outside::Zero);
        let ozone = Curve::new(ozone, Scale::Linear, vec![0.0, 1.0, 0.0]).expect("valid");
        let medium =
            Medium::new(vec![component(exponential(8e3, 1e5, 100), 1e-5, 0.0), component(ozone, 0.0, 3e-6)], 1e5)
                .expect("valid");
        assert_eq!((medium.bounds()[0], medium.top_m()), (0.0, 1e5));
        for (k, shell) in medium.shells().iter().enumerate() {
            let (a, b) = (medium.bounds()[k], medium.bounds()[k + 1]);
            for i in 0..=200 {
                let [sigma] = medium.extinction(k, a + (b - a) * f64::from(i) / 200.0);
                // Rounding only.
                assert!(sigma <= shell.majorant[0] * (1.0 + 1e-14), "majorant of shell {k} broken");
                assert!(sigma >= shell.minorant[0] * (1.0 - 1e-14), "minorant of shell {k} broken");
            }
        }
    }

    #[test]
    fn a_step_profile_keeps_its_jump() {
        let axis = Axis::new("altitude", "m", vec![0.0, 1e3, 2e3])
            .expect("valid")
            .between(Interpolation::Step)
            .beyond(Outside::Zero);
        let curve = Curve::new(axis, Scale::Linear, vec![1.0, 5.0, 5.0]).expect("valid");
        let medium = Medium::new(vec![component(curve, 1e-4, 0.0)], 3e3).expect("valid");
        let depth = 1e-4 * (1e3 + 5e3);
        let [tau] = medium.optical_depth(Shape::Flat, Place::above(0.0), DVec3::Z);
        assert!((tau - depth).abs() < 1e-12, "{tau} for {depth}");
    }

    #[test]
    fn negative_extinction_is_refused() {
        let medium = Medium::new(vec![component(exponential(8e3, 1e5, 100), 0.0, -1e-5)], 1e5);
        assert!(matches!(medium, Err(MediumError::Negative { .. })));
    }
}
