//! Conventions of other programs: which way their axes point, where in an environment map they look for a direction, and in which unit.
//!
//! Airlight's observer has x east, y north, z up; azimuth runs clockwise from north. Each program gets a map such that its own north is
//! Airlight's, and nothing is mirrored.
//!
//! | program | axes | a direction (x, y, z) is looked for at (u, v), v downwards | unit |
//! |---|---|---|---|
//! | Blender (Cycles) | right-handed, x east, y north, z up | u = 1/2 - atan2(y, x)/2pi, v = 1/2 - atan2(z, hypot(x, y))/pi | W m^-2 sr^-1 |
//! | Mitsuba 3 | right-handed, x east, y up, z south | u = atan2(x, -z)/2pi, v = acos(y)/pi | W m^-2 sr^-1 |
//! | pbrt-v4 | left-handed, x north, y east, z up | equal-area octahedron of (x, y, z) ([`Projection::EqualArea`](crate::camera::Projection::EqualArea)) | cd/m^2 |
//! | Unreal | left-handed, x north, y east, z up | u = 1/2 + atan2(x, -y)/2pi, v = acos(z)/pi | cd/m^2 |
//!
//! Sources. Blender: `direction_to_equirectangular` of `intern/cycles/kernel/camera/projection.h`. Mitsuba 3: `src/emitters/envmap.cpp`
//! (the same in its documentation: "the default up direction is +Y"). pbrt-v4: `ImageInfiniteLight::Le` of `src/pbrt/lights.h` and
//! `EqualAreaSphereToSquare` of `src/pbrt/util/math.cpp` (Clarberg 2008), rows from the top; that its cameras are left-handed says `LookAt` of
//! `src/pbrt/util/transform.cpp` (right = up x forward). Unreal: `LookupLongLat` and `TransformSideToWorldSpace` of
//! `TextureCompressorModule.cpp`, which exchange y and z before a map with y up is looked into.
//!
//! Units. The R, G and B of Airlight's own pictures are luminances: 0.2126 R + 0.7152 G + 0.0722 B is in cd/m^2. Unreal wants these. So does
//! pbrt-v4, which divides every light by what makes its illuminant one nit (`SpectrumToPhotometric`). For the others they are divided by 683
//! lm/W, the luminous efficacy of light of 555 nm: the light of that wavelength that is as bright, in W m^-2 sr^-1. Blender's exporter of
//! glTF has the same factor (`PBR_WATTS_TO_LUMENS`); in Mitsuba it is as good as any, as long as all lights of a scene have it.

use crate::scene::CameraKind;
use glam::DVec3;

/// lm/W of light of 540e12 Hz (SI, the definition of the candela).
pub const LUMENS_PER_WATT: f64 = 683.0;

/// A program that light is for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Program {
    /// Blender: world texture and sun lamp
    Blender,
    /// Mitsuba 3: envmap and directional
    Mitsuba,
    /// pbrt-v4: infinite and distant
    Pbrt,
    /// Unreal Engine 4 and 5: cubemap of a sky light, directional light
    Unreal,
}

impl Program {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Blender, Self::Mitsuba, Self::Pbrt, Self::Unreal];

    /// Its name.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Blender => "Blender",
            Self::Mitsuba => "Mitsuba 3",
            Self::Pbrt => "pbrt-v4",
            Self::Unreal => "Unreal Engine",
        }
    }

    /// Form of its maps.
    #[must_use]
    pub fn projection(self) -> CameraKind {
        if self == Self::Pbrt { CameraKind::EqualArea } else { CameraKind::Latlong }
    }

    /// The azimuth in degrees to which its map is turned: of the middle column, or of the first axis of the square.
    #[must_use]
    pub fn azimuth_deg(self) -> f64 {
        match self {
            Self::Blender => 90.0,
            Self::Mitsuba => 180.0,
            Self::Pbrt => 0.0,
            Self::Unreal => 270.0,
        }
    }

    /// A direction with x east, y north, z up in the program's axes.
    #[must_use]
    pub fn axes(self, DVec3 { x: east, y: north, z: up }: DVec3) -> DVec3 {
        match self {
            Self::Blender => DVec3::new(east, north, up),
            Self::Mitsuba => DVec3::new(east, up, -north),
            Self::Pbrt | Self::Unreal => DVec3::new(north, east, up),
        }
    }

    /// Luminance in cd/m^2 of a pixel (1, 1, 1) of its maps.
    #[must_use]
    pub fn white_luminance(self) -> f64 {
        match self {
            Self::Blender | Self::Mitsuba => LUMENS_PER_WATT,
            Self::Pbrt | Self::Unreal => 1.0,
        }
    }

    /// Units of the radiance of its maps and of the irradiance of its sun.
    #[must_use]
    pub fn units(self) -> [&'static str; 2] {
        match self {
            Self::Blender | Self::Mitsuba => ["W m^-2 sr^-1 at 683 lm/W", "W m^-2 at 683 lm/W"],
            Self::Pbrt | Self::Unreal => ["cd m^-2", "lx"],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Data;
    use crate::film::{Development, Picture, png};
    use crate::render::{Control, Sky, disc_layer, render};
    use crate::scene::Scene;
    use crate::spectrum::Wavelengths;
    use std::f64::consts::{FRAC_PI_4, PI, TAU};
    use std::path::Path;
    use std::sync::atomic::AtomicBool;

    /// Where a program looks for a direction in its own axes: (u, v), v downwards, written as its sources have it.
    fn lookup(program: Program, d: DVec3) -> [f64; 2] {
        match program {
            Program::Blender => [0.5 - d.y.atan2(d.x) / TAU, 1.0 - (d.z.atan2(d.x.hypot(d.y)) / PI + 0.5)],
            Program::Mitsuba => [(d.x.atan2(-d.z) / TAU).rem_euclid(1.0), d.y.acos() / PI],
            Program::Unreal => [(1.0 + d.x.atan2(-d.y) / PI) / 2.0, d.z.acos() / PI],
            // Clarberg 2008: r = sqrt(1 - |z|) and phi of the absolute values make a triangle, which is folded for z below 0.
            Program::Pbrt => {
                let r = (1.0 - d.z.abs()).sqrt();
                let turn = d.y.abs().atan2(d.x.abs()) / (2.0 * FRAC_PI_4);
                let (mut u, mut v) = (r - turn * r, turn * r);
                if d.z < 0.0 {
                    (u, v) = (1.0 - v, 1.0 - u);
                }
                [0.5 * (1.0 + u.copysign(d.x)), 0.5 * (1.0 + v.copysign(d.y))]
            }
        }
    }

    fn map(program: Program, sun: (f64, f64)) -> Scene {
        let side = if program == Program::Pbrt { [48, 48] } else { [96, 48] };
        Scene {
            camera: program.projection(),
            view_azimuth_deg: Some(program.azimuth_deg()),
            width: Some(side[0]),
            height: Some(side[1]),
            sun_azimuth_deg: sun.0,
            sun_elevation_deg: sun.1,
            wavelengths_nm: Wavelengths::new(vec![450.0, 550.0, 650.0]).expect("valid"),
            ..Scene::default()
        }
    }

    #[test]
    fn every_direction_is_where_the_program_looks_for_it() {
        for program in Program::ALL {
            let scene = map(program, (0.0, 30.0));
            let (camera, (width, height)) = (scene.camera(), scene.size());
            for i in 0..500 {
                // Even in height, golden in azimuth.
                let (z, turn) = (1.0 - (f64::from(i) + 0.5) / 250.0, 2.4 * f64::from(i));
                let d = DVec3::new((1.0 - z * z).sqrt() * turn.sin(), (1.0 - z * z).sqrt() * turn.cos(), z);
                let [u, v] = lookup(program, program.axes(d));
                let seen = camera.direction(u * f64::from(width), v * f64::from(height)).expect("the whole sphere");
                // Roundings, largest near the poles of acos.
                assert!(seen.distance(d) < 1e-7, "{program:?} {d}: {seen}");
            }
        }
    }

    #[test]
    fn the_sun_is_where_the_program_looks_for_it() {
        let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
        let never = AtomicBool::new(false);
        for (program, sun) in Program::ALL.into_iter().zip([(50.0, 35.0), (130.0, 20.0), (200.0, 50.0), (310.0, 40.0)])
        {
            let scene = map(program, sun);
            let sky = Sky::new(&scene, &data).expect("a sky");
            let film = render(&scene, &sky, Control { stop: &never, observe: &|_| {} }).expect("finite").film;
            let picture = Picture { film: &film, disc: &disc_layer(&scene, &sky), colour: sky.colour() };
            let (width, height) = scene.size();
            // The eight-bit picture exposed for the disc: all else is black.
            let pixels = png::pixels(&picture, &Development::new(scene.tone, scene.white, sky.sun_white(), 22.0));
            let brightest = (0..pixels.len() / 3).max_by_key(|i| pixels[3 * i + 1]).expect("pixels");
            let [u, v] = lookup(program, program.axes(scene.sun_direction()));
            let looked = (v * f64::from(height)) as usize * width as usize + (u * f64::from(width)) as usize;
            let apart = [brightest % width as usize, brightest / width as usize]
                .into_iter()
                .zip([looked % width as usize, looked / width as usize])
                .map(|(a, b)| a.abs_diff(b))
                .max();
            // A disc on the edge of two pixels may be brighter in the other.
            assert!(apart <= Some(1), "{program:?}: {brightest} {looked}");
        }
    }

    #[test]
    fn handedness_is_that_of_the_program() {
        for program in Program::ALL {
            let [e, n, u] = [DVec3::X, DVec3::Y, DVec3::Z].map(|d| program.axes(d));
            let right_handed = matches!(program, Program::Blender | Program::Mitsuba);
            assert_eq!(e.cross(n).dot(u), if right_handed { 1.0 } else { -1.0 }, "{program:?}");
        }
    }
}
