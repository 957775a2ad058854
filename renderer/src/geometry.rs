//! Rays through concentric shells, in altitudes rather than radii.
//!
//! With r = R + h the distance t along a ray from altitude h_0 in a direction
//! of zenith cosine mu to altitude h solves t^2 + 2 b t + c = 0, where b = r_0 mu
//! and c = r_0^2 - r^2. Written as
//! c = (h_0 - h)(2R + h_0 + h)
//! it does not cancel for an eye a millimetre above the ground, and each root
//! is taken in the form that adds numbers of one sign. The room knows no
//! wavelength and no random number.

use glam::DVec3;

/// The form of the planet.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// A sphere of that radius in metres.
    Sphere {
        /// Radius of the surface, altitude 0.
        radius_m: f64,
    },
    /// A plane: plane-parallel layers without end.
    Flat,
}

/// A point: its altitude above the surface and the vertical there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Altitude in metres above the planet's surface.
    pub altitude_m: f64,
    /// Unit vector of the vertical. In the world frame of an observer this is z,
    /// with x east and y north.
    pub up: DVec3,
}

/// The smallest |mu| of a ray between planes; a level ray would never end.
const LEVEL: f64 = 1e-9;

impl Place {
    /// The place at altitude `altitude_m` on the vertical z.
    #[must_use]
    pub fn above(altitude_m: f64) -> Self {
        Self { altitude_m, up: DVec3::Z }
    }

    /// The place at distance `t` (m) in the unit `direction`.
    #[must_use]
    pub fn advance(self, shape: Shape, direction: DVec3, t: f64) -> Self {
        let altitude_m = Ray::new(shape, self, direction).altitude_m(t);
        let up = match shape {
            Shape::Flat => self.up,
            Shape::Sphere { radius_m } => (self.up * (radius_m + self.altitude_m) + direction * t).normalize(),
        };
        Self { altitude_m, up }
    }
}

/// How altitude goes along a ray: all that spherical symmetry leaves of it.
#[derive(Debug, Clone, Copy)]
pub struct Ray {
    shape: Shape,
    altitude_m: f64,
    mu: f64,
}

/// The part of a ray inside one layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Index of the layer between `bounds[layer]` and `bounds[layer + 1]`.
    pub layer: usize,
    /// Distance in metres at which the ray enters it.
    pub start_m: f64,
    /// Distance in metres at which the ray leaves it.
    pub end_m: f64,
}

/// Where a ray ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum End {
    /// On the surface, at that distance in metres.
    Ground(f64),
    /// In space.
    Space,
}

impl Ray {
    /// The ray from `place` in the unit `direction`.
    #[must_use]
    pub fn new(shape: Shape, place: Place, direction: DVec3) -> Self {
        let mu = place.up.dot(direction).clamp(-1.0, 1.0);
        let mu = match shape {
            Shape::Flat if mu.abs() < LEVEL => LEVEL.copysign(mu),
            _ => mu,
        };
        Self { shape, altitude_m: place.altitude_m, mu }
    }

    /// Altitude in metres at distance `t` in metres:
    /// h_0 + t (2 r_0 mu + t) / (r_0 + r(t)), r(t)^2 = r_0^2 + 2 r_0 mu t + t^2.
    #[must_use]
    pub fn altitude_m(&self, t: f64) -> f64 {
        match self.shape {
            Shape::Flat => self.altitude_m + self.mu * t,
            Shape::Sphere { radius_m } => {
                let r0 = radius_m + self.altitude_m;
                let gain = t * (2.0 * r0 * self.mu + t);
                self.altitude_m + gain / (r0 + (r0 * r0 + gain).max(0.0).sqrt())
            }
        }
    }

    /// (b, c, discriminant) of the distance to altitude `h`.
    fn quadratic(radius_m: f64, h0: f64, mu: f64, h: f64) -> (f64, f64, f64) {
        let b = (radius_m + h0) * mu;
        let c = (h0 - h) * (2.0 * radius_m + h0 + h);
        (b, c, b * b - c)
    }

    /// Distance at which the descending ray reaches altitude `h`, not above
    /// its start; `None` if it turns upwards before.
    fn descent_m(&self, h: f64) -> Option<f64> {
        match self.shape {
            Shape::Flat => Some((h - self.altitude_m) / self.mu),
            Shape::Sphere { radius_m } => {
                let (b, c, discriminant) = Self::quadratic(radius_m, self.altitude_m, self.mu, h);
                (discriminant >= 0.0).then(|| c.max(0.0) / (discriminant.sqrt() - b))
            }
        }
    }

    /// Distance at which the ray, rising, passes altitude `h`.
    fn ascent_m(&self, h: f64) -> f64 {
        match self.shape {
            Shape::Flat => (h - self.altitude_m) / self.mu,
            Shape::Sphere { radius_m } => {
                let (b, c, discriminant) = Self::quadratic(radius_m, self.altitude_m, self.mu, h);
                let root = discriminant.max(0.0).sqrt();
                if b > 0.0 { (-c).max(0.0) / (b + root) } else { root - b }
            }
        }
    }

    /// Whether the ray meets the surface.
    #[must_use]
    pub fn meets_ground(&self) -> bool {
        self.mu < 0.0 && self.descent_m(0.0).is_some()
    }

    /// Appends to `segments` (cleared first) the parts of the ray in the layers
    /// between the increasing altitudes `bounds` in metres, from the surface
    /// (`bounds[0]` = 0) to the top, in the order met, and gives the end. Parts
    /// of no length are left out; a ray that misses the layers has no parts.
    pub fn segments(&self, bounds: &[f64], segments: &mut Vec<Segment>) -> End {
        segments.clear();
        let top = bounds.len() - 1;
        let mut t = 0.0;
        let mut layer = top - 1;
        let mut push = |layer: usize, t: &mut f64, end: f64| {
            if end > *t {
                segments.push(Segment { layer, start_m: *t, end_m: end });
                *t = end;
            }
        };
        if self.altitude_m >= bounds[top] {
            match self.descent_m(bounds[top]) {
                Some(entry) if self.mu < 0.0 => t = entry,
                _ => return End::Space,
            }
        } else {
            layer = bounds.partition_point(|&z| z <= self.altitude_m).saturating_sub(1);
        }
        if self.mu < 0.0 {
            while let Some(floor) = self.descent_m(bounds[layer]) {
                push(layer, &mut t, floor);
                if layer == 0 {
                    return End::Ground(t);
                }
                layer -= 1;
            }
        }
        while layer < top {
            push(layer, &mut t, self.ascent_m(bounds[layer + 1]));
            layer += 1;
        }
        End::Space
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const EARTH: Shape = Shape::Sphere { radius_m: 6_371_000.0 };

    fn direction(zenith_deg: f64) -> DVec3 {
        let (sin, cos) = zenith_deg.to_radians().sin_cos();
        DVec3::new(sin, 0.0, cos)
    }

    fn walk(shape: Shape, altitude_m: f64, zenith_deg: f64, bounds: &[f64]) -> (Vec<Segment>, End) {
        let mut segments = Vec::new();
        let end = Ray::new(shape, Place::above(altitude_m), direction(zenith_deg)).segments(bounds, &mut segments);
        (segments, end)
    }

    #[test]
    fn segments_join_and_each_lies_in_its_layer() {
        let bounds = [0.0, 1e3, 5e3, 2e4, 1e5];
        for altitude in [0.0, 1e-3, 2.0, 1e3, 7e3, 99e3, 1e5, 4e5, 3.6e7] {
            for step in 0..=720 {
                let zenith = f64::from(step) / 4.0;
                let (segments, end) = walk(EARTH, altitude, zenith, &bounds);
                let ray = Ray::new(EARTH, Place::above(altitude), direction(zenith));
                for pair in segments.windows(2) {
                    assert_eq!(pair[0].end_m, pair[1].start_m, "gap at {altitude} m, {zenith} degrees");
                    assert_eq!(
                        pair[0].layer.abs_diff(pair[1].layer),
                        1,
                        "layer skipped at {altitude} m, {zenith} degrees"
                    );
                }
                for s in &segments {
                    let middle = ray.altitude_m(0.5 * (s.start_m + s.end_m));
                    // A tenth of a millimetre: rounding of squares of 4e7 m over 1e7 m.
                    assert!(
                        middle > bounds[s.layer] - 1e-4 && middle < bounds[s.layer + 1] + 1e-4,
                        "middle at {middle} m outside layer {} from {altitude} m, {zenith} degrees",
                        s.layer
                    );
                }
                if let End::Ground(t) = end {
                    assert!(ray.altitude_m(t).abs() < 1e-4, "ground at {} m from {altitude} m", ray.altitude_m(t));
                }
                assert_eq!(matches!(end, End::Ground(_)), ray.meets_ground());
            }
        }
    }

    #[test]
    fn horizon_of_a_low_eye_is_where_the_closed_form_puts_it() {
        // The ray grazes the surface where cos(dip) = R / (R + h): sin(dip) = sqrt(h (2R + h)) / (R + h).
        let radius: f64 = 6_371_000.0;
        for altitude in [1e-3, 2.0, 100.0, 1e4, 4e5] {
            let dip = ((altitude * (2.0 * radius + altitude)).sqrt() / (radius + altitude)).asin().to_degrees();
            for (offset, ground) in [(1e-9, true), (-1e-9, false)] {
                let ray = Ray::new(EARTH, Place::above(altitude), direction(90.0 + dip + offset));
                assert_eq!(ray.meets_ground(), ground, "{altitude} m, {offset} degrees below the horizon");
            }
        }
    }

    #[test]
    fn vertical_rays_have_the_lengths_of_the_layers() {
        let (segments, end) = walk(EARTH, 0.0, 0.0, &[0.0, 1e3, 1e5]);
        assert_eq!(end, End::Space);
        assert!((segments[0].end_m - 1e3).abs() < 1e-9 && (segments[1].end_m - 1e5).abs() < 1e-7);
        let (segments, end) = walk(EARTH, 4e5, 180.0, &[0.0, 1e3, 1e5]);
        assert!((segments[0].start_m - 3e5).abs() < 1e-7, "entry {:?}", segments[0]);
        assert!(matches!(end, End::Ground(t) if (t - 4e5).abs() < 1e-7));
    }

    #[test]
    fn planes_are_crossed_at_height_over_cosine() {
        let (segments, end) = walk(Shape::Flat, 0.0, 60.0, &[0.0, 1e3, 3e3]);
        assert_eq!(end, End::Space);
        assert!((segments[0].end_m - 2e3).abs() < 1e-9 && (segments[1].end_m - 6e3).abs() < 1e-9);
        let (_, end) = walk(Shape::Flat, 3e3, 120.0, &[0.0, 1e3, 3e3]);
        assert!(matches!(end, End::Ground(t) if (t - 6e3).abs() < 1e-9));
    }

    #[test]
    fn advancing_keeps_the_altitude_of_the_ray() {
        let start = Place::above(2.0);
        let d = direction(89.9);
        for t in [1e-3, 1.0, 1e3, 1e6] {
            let place = start.advance(EARTH, d, t);
            let exact = (start.up * 6_371_002.0 + d * t).length() - 6_371_000.0;
            // The plain difference of radii rounds to 1e-9 m.
            assert!((place.altitude_m - exact).abs() < 5e-9 && (place.up.length() - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn a_ray_past_the_planet_misses_all_layers() {
        let (segments, end) = walk(EARTH, 1e7, 91.0, &[0.0, 1e5]);
        assert!(segments.is_empty() && end == End::Space);
    }
}
