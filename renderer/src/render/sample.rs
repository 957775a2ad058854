//! One sample of a pixel.

use super::Sky;
use crate::camera::Camera;
use crate::sampling::Sampler;
use crate::scene::Scene;
use glam::DVec3;

/// Which sample: number `sample` of a pixel whose blocks are of `block` samples.
#[derive(Debug, Clone, Copy)]
pub(super) struct Index {
    pub(super) seed: u64,
    pub(super) block: u32,
    pub(super) sample: u32,
}

impl Index {
    /// The stream of the sample in a pixel. The samples of a block are the first points of one scrambled Sobol sequence;
    /// blocks of one sample are independent random points.
    fn sampler(self, pixel: u64) -> Sampler {
        match self.block {
            1 => Sampler::new(self.seed, pixel, u64::from(self.sample)),
            m => Sampler::sobol(self.seed, pixel, u64::from(self.sample / m), self.sample % m),
        }
    }
}

/// What [`Sky::look`] gave (sr^-1) for one sample of pixel (`x`, `y`) of a valid scene, as the picture took it, and the
/// direction it looked in; `None` where the picture shows nothing.
#[must_use]
pub fn replay(scene: &Scene, sky: &Sky, x: u32, y: u32, sample: u32) -> Option<(DVec3, Vec<f64>)> {
    let camera = scene.camera();
    if !is_shown(&camera, x, y) {
        return None;
    }
    let mut values = vec![0.0; sky.values()];
    let index = Index { seed: scene.seed, block: scene.block(), sample };
    let direction = take(sky, &camera, (scene.size().0, x, y), index, &mut values);
    Some((direction, values))
}

/// Whether the picture shows something at pixel (`x`, `y`): at its middle.
pub(super) fn is_shown(camera: &Camera, x: u32, y: u32) -> bool {
    camera.direction(f64::from(x) + 0.5, f64::from(y) + 0.5).is_some()
}

/// One sample of pixel (`x`, `y`) of a picture of some width, and the direction it looked in: without noise the first
/// looks at the pixel's middle.
pub(super) fn take(
    sky: &Sky,
    camera: &Camera,
    (width, x, y): (u32, u32, u32),
    index: Index,
    values: &mut [f64],
) -> DVec3 {
    let mut sampler = index.sampler(u64::from(y) * u64::from(width) + u64::from(x));
    let middle = if sky.is_noiseless() && index.sample == 0 {
        camera.direction(f64::from(x) + 0.5, f64::from(y) + 0.5)
    } else {
        None
    };
    let direction = middle.unwrap_or_else(|| within(camera, x, y, &mut sampler));
    sky.look(direction, camera.level(f64::from(x) + 0.5, f64::from(y) + 0.5), &sampler, values);
    direction
}

/// A direction uniformly distributed over the part of the pixel that lies in the picture: the first two numbers of the
/// camera's set, at random if they miss. The pixel's middle does not, so half of all draws or nearly so are good, and
/// sixty-four bad ones in a row do not happen.
fn within(camera: &Camera, x: u32, y: u32, sampler: &mut Sampler) -> DVec3 {
    let at = |[u, v]: [f64; 2]| camera.direction(f64::from(x) + u, f64::from(y) + v);
    let [u, v, ..] = sampler.four();
    at([u, v]).or_else(|| (0..64).find_map(|_| at(sampler.uniform_2d()))).or_else(|| at([0.5, 0.5])).unwrap_or(DVec3::Z)
}
