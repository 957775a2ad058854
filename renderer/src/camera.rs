//! Cameras: which direction a point of the picture looks in.
//!
//! Picture coordinates run right and down from the upper left corner; the
//! pixel (i, j) covers i..i+1 and j..j+1, so that its middle is (i + 1/2, j + 1/2).
//! Directions are in the observer's frame: x east, y north, z up; azimuth is
//! clockwise from north, elevation from the horizontal.

use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// The unit vector at azimuth and elevation in radians:
/// (cos e sin a, cos e cos a, sin e).
#[must_use]
pub fn direction_at(azimuth: f64, elevation: f64) -> DVec3 {
    let (sin_a, cos_a) = azimuth.sin_cos();
    let (sin_e, cos_e) = elevation.sin_cos();
    DVec3::new(cos_e * sin_a, cos_e * cos_a, sin_e)
}

/// How the sphere of directions is laid on the picture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Projection {
    /// Straight lines stay straight: the distance from the middle is tan theta.
    /// The field of view (radians, above 0, below pi) is that of the picture's width.
    Pinhole {
        /// Horizontal field of view in radians.
        field_of_view: f64,
    },
    /// The distance from the middle is the angle theta (equidistant fisheye). The
    /// field of view (radians, up to 2 pi) is that of the largest circle in the
    /// picture; outside the circle there is no direction.
    Fisheye {
        /// Field of view across the circle in radians.
        field_of_view: f64,
    },
    /// The whole sphere: azimuth across, increasing to the right, the view's azimuth in the
    /// middle column; elevation down, from the zenith in the first row to the nadir.
    LatLong,
    /// The whole sphere on a square, every pixel of the same solid angle (Clarberg 2008, "Fast equal-area mapping of the (hemi)sphere using
    /// SIMD"): with p, q from -1 to 1 across and down, r = 1 - |1 - |p| - |q||, z = +-(1 - r^2), above the horizon where |p| + |q| < 1,
    /// the angle from the nearest of the first and second axis to the other phi = (pi/4) (1 + (|q| - |p|)/r), and the first and
    /// second axis r sqrt(2 - r^2) (cos phi, sin phi) with the signs of p and q. The first axis is the horizontal direction of the view's
    /// azimuth, the second is 90 degrees clockwise from it. The zenith is in the middle, the nadir in the corners.
    EqualArea,
}

/// A projection, a size and an orientation.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    projection: Projection,
    width: f64,
    height: f64,
    azimuth: f64,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
}

impl Camera {
    /// A camera for a picture of `width` x `height` pixels that looks in the direction of
    /// `azimuth` and `elevation` (radians; [`Projection::LatLong`] and [`Projection::EqualArea`] heed the azimuth only).
    ///
    /// The vertical is up in the picture and right = forward x up. Where it looks straight
    /// up or down, the horizontal direction of `azimuth` is up in the picture: with azimuth 0
    /// north is on top, and east is on the left of a picture of the zenith, as on a star chart.
    #[must_use]
    pub fn new(projection: Projection, width: u32, height: u32, azimuth: f64, elevation: f64) -> Self {
        let forward = direction_at(azimuth, elevation);
        // 1e-9: below what a picture shows, above the rounding of degrees to radians.
        let vertical = elevation.abs() > FRAC_PI_2 - 1e-9;
        let top = if vertical { direction_at(azimuth, 0.0) } else { DVec3::Z };
        let right = forward.cross(top).normalize();
        let up = right.cross(forward);
        Self { projection, width: f64::from(width), height: f64::from(height), azimuth, forward, right, up }
    }

    /// The unit vector that the point (`px`, `py`) of the picture looks in; `None`
    /// outside the circle of a fisheye.
    #[must_use]
    pub fn direction(&self, px: f64, py: f64) -> Option<DVec3> {
        let x = px - 0.5 * self.width;
        let y = 0.5 * self.height - py;
        match self.projection {
            Projection::Pinhole { field_of_view } => {
                let scale = 2.0 * (0.5 * field_of_view).tan() / self.width;
                Some((self.forward + self.right * (x * scale) + self.up * (y * scale)).normalize())
            }
            Projection::Fisheye { field_of_view } => {
                let distance = x.hypot(y);
                let radius = 0.5 * self.width.min(self.height);
                if distance > radius {
                    return None;
                }
                if distance == 0.0 {
                    return Some(self.forward);
                }
                let (sin, cos) = (0.5 * field_of_view * distance / radius).sin_cos();
                let outward = (self.right * x + self.up * y) / distance;
                Some((self.forward * cos + outward * sin).normalize())
            }
            Projection::LatLong => Some(direction_at(self.azimuth + TAU * x / self.width, PI * y / self.height)),
            Projection::EqualArea => Some(self.equal_area(2.0 * x / self.width, -2.0 * y / self.height)),
        }
    }

    /// See [`Projection::EqualArea`].
    fn equal_area(&self, p: f64, q: f64) -> DVec3 {
        let above = 1.0 - (p.abs() + q.abs());
        let r = 1.0 - above.abs();
        let angle = if r > 0.0 { FRAC_PI_4 * (1.0 + (q.abs() - p.abs()) / r) } else { 0.0 };
        let level = r * (2.0 - r * r).max(0.0).sqrt();
        let (first, second) = (direction_at(self.azimuth, 0.0), direction_at(self.azimuth + FRAC_PI_2, 0.0));
        let across = first * angle.cos().copysign(p) + second * angle.sin().copysign(q);
        (across * level + DVec3::Z * (1.0 - r * r).copysign(above)).normalize()
    }

    /// The horizontal unit vector, towards growing azimuth, across what the point (`px`, `py`) of the picture looks in: to the
    /// right where the zenith is on top. For the zenith and the nadir themselves, and outside the circle of a fisheye, it is
    /// the picture's own horizontal.
    #[must_use]
    pub fn level(&self, px: f64, py: f64) -> DVec3 {
        let across = self.direction(px, py).map(|direction| direction.cross(DVec3::Z));
        across.and_then(DVec3::try_normalize).unwrap_or(self.right)
    }

    /// Half the angle, in radians, that contains the pixel (i, j) whatever its shape, with a
    /// margin: its corners' largest distance from its middle. `None` where the pixel's middle
    /// has no direction.
    #[must_use]
    pub fn pixel_radius(&self, i: u32, j: u32) -> Option<f64> {
        let (x, y) = (f64::from(i), f64::from(j));
        let middle = self.direction(x + 0.5, y + 0.5)?;
        let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
        let reach = corners
            .iter()
            .filter_map(|(dx, dy)| self.direction(x + dx, y + dy))
            .map(|corner| 2.0 * (0.5 * corner.distance(middle)).min(1.0).asin())
            .fold(0.0, f64::max);
        // The corners of a pixel that spans a good part of the sphere do not bound it.
        Some(if reach == 0.0 || reach > 0.25 * PI { PI } else { 1.25 * reach })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const N: DVec3 = DVec3::Y;
    const E: DVec3 = DVec3::X;

    fn cameras() -> [Camera; 3] {
        [Projection::Pinhole { field_of_view: 1.2 }, Projection::Fisheye { field_of_view: 3.0 }, Projection::LatLong]
            .map(|p| Camera::new(p, 64, 32, 0.7, 0.0))
    }

    fn close(a: DVec3, b: DVec3) -> bool {
        // A handful of roundings of unit vectors.
        a.distance(b) < 1e-14
    }

    #[test]
    fn the_middle_looks_forward() {
        for camera in cameras() {
            let middle = camera.direction(32.0, 16.0).expect("inside");
            assert!(close(middle, direction_at(0.7, 0.0)), "{camera:?}");
        }
    }

    #[test]
    fn looking_north_has_east_on_the_right_and_the_zenith_on_top() {
        for projection in [
            Projection::Pinhole { field_of_view: FRAC_PI_2 },
            Projection::Fisheye { field_of_view: PI },
            Projection::LatLong,
        ] {
            let camera = Camera::new(projection, 64, 64, 0.0, 0.0);
            let right = camera.direction(40.0, 32.0).expect("inside");
            let above = camera.direction(32.0, 24.0).expect("inside");
            assert!(right.dot(E) > 0.1 && right.z.abs() < 1e-12 && right.y > 0.0, "{projection:?}");
            assert!(above.z > 0.1 && above.x.abs() < 1e-12 && above.y > 0.0, "{projection:?}");
        }
    }

    #[test]
    fn a_fisheye_of_the_zenith_has_north_on_top_and_east_on_the_left() {
        let camera = Camera::new(Projection::Fisheye { field_of_view: PI }, 64, 64, 0.0, FRAC_PI_2);
        assert!(close(camera.direction(32.0, 0.0).expect("rim"), N));
        assert!(close(camera.direction(0.0, 32.0).expect("rim"), E));
        let down = Camera::new(Projection::Fisheye { field_of_view: PI }, 64, 64, 0.0, -FRAC_PI_2);
        assert!(close(down.direction(32.0, 0.0).expect("rim"), N));
        assert!(close(down.direction(64.0, 32.0).expect("rim"), E));
    }

    #[test]
    fn level_is_horizontal_across_the_view_and_towards_growing_azimuth() {
        for camera in cameras() {
            for (x, y) in [(32.0, 16.0), (35.0, 9.0), (28.0, 25.0)] {
                let (direction, level) = (camera.direction(x, y).expect("inside"), camera.level(x, y));
                let azimuth = direction.x.atan2(direction.y);
                // Roundings of unit vectors.
                assert!(close(level, direction_at(azimuth + FRAC_PI_2, 0.0)), "{camera:?}");
            }
        }
        // At the zenith itself it is across the picture's up.
        let camera = Camera::new(Projection::Fisheye { field_of_view: PI }, 64, 64, 0.0, FRAC_PI_2);
        assert!(camera.level(32.0, 32.0).cross(E).length() < 1e-14);
    }

    #[test]
    fn the_angle_of_a_fisheye_grows_linearly_and_ends_at_its_circle() {
        for degrees in [1.0_f64, 180.0, 360.0] {
            let field_of_view = degrees.to_radians();
            let camera = Camera::new(Projection::Fisheye { field_of_view }, 100, 80, 2.0, 0.4);
            let forward = camera.direction(50.0, 40.0).expect("middle");
            for k in 1..=40 {
                let d = camera.direction(50.0 + f64::from(k) * 0.6, 40.0 - f64::from(k) * 0.8).expect("inside");
                let angle = 2.0 * (0.5 * d.distance(forward)).asin();
                // asin near 1 (360 degrees) loses half the digits.
                assert!((angle - field_of_view * f64::from(k) / 80.0).abs() < 1e-7, "{degrees} {k}");
            }
            assert_eq!(camera.direction(50.0, -0.1), None);
            assert_eq!(camera.direction(5.0, 5.0), None);
        }
    }

    #[test]
    fn a_pinhole_spans_its_field_of_view_and_keeps_lines_straight() {
        let camera = Camera::new(Projection::Pinhole { field_of_view: 1.2 }, 60, 40, 0.3, 0.5);
        let [left, middle, right] = [0.0, 30.0, 60.0].map(|x| camera.direction(x, 20.0).expect("inside"));
        assert!((left.angle_between(right) - 1.2).abs() < 1e-12);
        let [a, b, c] = [0.0, 17.0, 60.0].map(|x| camera.direction(x, 7.0).expect("inside"));
        assert!(a.cross(b).dot(c).abs() < 1e-14, "points of one line lie in one plane");
        assert!(close(middle, direction_at(0.3, 0.5)));
    }

    #[test]
    fn pixels_of_a_latlong_picture_cover_the_sphere() {
        // The solid angle of a pixel is the product of two steps and cos e; with the exact
        // mean of cos over a row the sum is 4 pi, by midpoints it is larger by (pi/2n)^2/6.
        let (w, h) = (64, 32);
        let camera = Camera::new(Projection::LatLong, w, h, 1.0, 0.0);
        let mut sum = 0.0;
        for j in 0..h {
            for i in 0..w {
                let at = |dx: f64, dy: f64| camera.direction(f64::from(i) + dx, f64::from(j) + dy).expect("sphere");
                let (across, down) = (at(0.999, 0.5) - at(0.001, 0.5), at(0.5, 0.999) - at(0.5, 0.001));
                sum += across.cross(down).length() / (0.998 * 0.998);
            }
        }
        assert!((sum / (4.0 * PI) - 1.0).abs() < 1e-3, "{sum}");
        assert!(close(camera.direction(10.0, 0.0).expect("sphere"), DVec3::Z));
    }

    #[test]
    fn pixels_of_an_equal_area_picture_have_the_same_solid_angle() {
        let camera = Camera::new(Projection::EqualArea, 64, 64, 1.0, 0.0);
        let at = |x: f64, y: f64| camera.direction(x, y).expect("sphere");
        for (i, j) in [(0, 0), (31, 31), (5, 40), (20, 3), (63, 10), (33, 60)] {
            let (x, y, h) = (f64::from(i) + 0.3, f64::from(j) + 0.4, 1e-3);
            let (across, down) = (at(x + h, y) - at(x - h, y), at(x, y + h) - at(x, y - h));
            let angle = across.cross(down).length() / (4.0 * h * h);
            // Differences of this step leave 1e-6 where the map bends most, near the axes of the square.
            assert!((angle * 64.0 * 64.0 / (4.0 * PI) - 1.0).abs() < 1e-5, "{i} {j}: {angle}");
        }
        assert!(close(at(32.0, 32.0), DVec3::Z) && close(at(0.0, 64.0), -DVec3::Z));
        assert!(
            close(at(64.0, 32.0), direction_at(1.0, 0.0)) && close(at(32.0, 64.0), direction_at(1.0 + FRAC_PI_2, 0.0))
        );
    }

    #[test]
    fn a_pixel_lies_within_its_radius() {
        for camera in cameras() {
            for (i, j) in [(32, 16), (25, 8), (40, 1), (0, 0)] {
                let Some(radius) = camera.pixel_radius(i, j) else { continue };
                let middle = camera.direction(f64::from(i) + 0.5, f64::from(j) + 0.5).expect("middle");
                for k in 0..121 {
                    let (x, y) = (f64::from(i) + f64::from(k % 11) / 10.0, f64::from(j) + f64::from(k / 11) / 10.0);
                    let inside = camera.direction(x, y).is_none_or(|d| d.angle_between(middle) <= radius);
                    assert!(inside, "{i} {j} {k}");
                }
            }
        }
    }
}
