//! Pictures of polarised light.

use super::*;
use crate::atmosphere::HazePhase;
use crate::camera::direction_at;
use crate::phase::Phase;
use crate::polarisation::{Scattering, Stokes};
use crate::sampling::Sampler;
use crate::scene::{Albedo, SunShape};
use glam::DVec3;
use tables::views::Biome;

fn polarised() -> Scene {
    Scene { polarisation: true, ..small() }
}

/// Stokes parameters of a pixel at wavelength `index`.
fn seen(film: &Film, pixel: usize, index: usize) -> Stokes {
    let [q, u] = film.polarised(pixel, index).expect("kept");
    Stokes { i: film.radiance(pixel, index).mean, q: q.mean, u: u.mean }
}

/// Pixels that show something, at each wavelength.
fn places(film: &Film) -> Vec<(usize, usize)> {
    let (width, height) = film.size();
    let pixels = (0..(width * height) as usize).filter(|&pixel| film.blocks(pixel) > 0);
    pixels.flat_map(|pixel| (0..film.wavelengths()).map(move |index| (pixel, index))).collect()
}

fn film(scene: &Scene) -> Film {
    render(scene, &sky(scene), RUN).expect("finite").film
}

#[test]
fn no_pixel_has_more_polarised_light_than_light() {
    let urban = Some(Biome::Urban);
    for (method, biome) in
        [(Method::Paths, urban), (Method::Paths, None), (Method::Judge, None), (Method::Solved, urban)]
    {
        let film = film(&Scene { method, biome, ..polarised() });
        let degrees = places(&film).into_iter().map(|(pixel, index)| seen(&film, pixel, index).degree());
        let most = degrees.fold(0.0, f64::max);
        // Equal but for rounding on every path.
        assert!(most > 0.3 && most <= 1.0 + 1e-9, "{method:?}, {biome:?}: {most}");
    }
}

#[test]
fn thin_air_polarises_across_the_plane_of_scattering() {
    // The lowest kilometre alone, whose optical depth at 1000 nm is 0.001: what is scattered twice is some thousandths.
    for (azimuth, elevation, method) in [
        (150.0, 10.0, Method::Paths),
        (230.0, 50.0, Method::Paths),
        (20.0, 30.0, Method::Solved),
        (270.0, 5.0, Method::Solved),
    ] {
        let scene = Scene {
            method,
            camera: CameraKind::Pinhole,
            fov_deg: Some(0.1),
            view_azimuth_deg: Some(azimuth),
            view_elevation_deg: Some(elevation),
            width: Some(1),
            height: Some(1),
            top_km: 1.0,
            albedo: Albedo::Grey(0.0),
            spp: Some(if method == Method::Solved { 1 } else { 256 }),
            wavelengths_nm: Wavelengths::new(vec![1000.0]).expect("valid"),
            ..polarised()
        };
        let sky = sky(&scene);
        let look = direction_at(f64::to_radians(azimuth), f64::to_radians(elevation));
        let medium = sky.air().medium(&[1000.0]).expect("in range");
        let gammas = medium.components().iter().find_map(|component| match component.phase {
            Phase::Rayleigh { gamma: [gamma] } if component.scatters() => Some(gamma),
            _ => None,
        });
        let gamma = gammas.expect("molecules");
        let Scattering { a1, b1, .. } = Scattering::rayleigh(gamma, look.dot(sky.sun_direction()));
        // The field is along the normal of the plane, from e1 to the right towards e2 upwards.
        let normal = look.cross(sky.sun_direction());
        let right = direction_at(f64::to_radians(azimuth + 90.0), 0.0);
        let angle = normal.dot(right.cross(look)).atan2(normal.dot(right));
        let (sin, cos) = (2.0 * angle).sin_cos();
        let Stokes { i, q, u } = seen(&render(&scene, &sky, RUN).expect("finite").film, 0, 0);
        let degree = -b1 / a1;
        assert!(
            i > 0.0 && (q / i - degree * cos).abs() < 0.01 && (u / i - degree * sin).abs() < 0.01,
            "{q} {u} of {i}"
        );
    }
}

#[test]
fn filters_at_right_angles_share_the_light() {
    let whole = film(&polarised());
    let behind = |angle| film(&Scene { filter_deg: Some(angle), ..small() });
    let (one, other) = (behind(25.0), behind(115.0));
    let mut apart = 0.0_f64;
    for (pixel, index) in places(&whole) {
        let all = seen(&whole, pixel, index);
        let [a, b] = [&one, &other].map(|film| film.radiance(pixel, index).mean);
        // The same paths: rounding.
        assert!(
            (a + b - all.i).abs() <= 1e-12 * all.i && (a - all.through(25_f64.to_radians())).abs() <= 1e-12 * all.i
        );
        apart = apart.max((a - b).abs() / all.i);
    }
    assert!(apart > 0.3, "a filter makes no difference");
    let disc = |filter_deg| {
        let scene = Scene { filter_deg, width: Some(64), height: Some(64), ..small() };
        disc_layer(&scene, &sky(&scene)).into_values().flatten().sum::<f64>()
    };
    assert!(disc(None) > 0.0 && (disc(Some(7.0)) / disc(None) - 0.5).abs() < 1e-12);
}

#[test]
fn radiance_is_the_same_in_every_frame() {
    let sky = sky(&Scene { biome: Some(Biome::DesertDust), ..polarised() });
    let (mut alone, mut values) = (vec![0.0; sky.wavelengths()], vec![0.0; sky.values()]);
    for (sample, direction) in (0..).zip([DVec3::Z, direction_at(1.0, 0.3), direction_at(4.0, 0.01)]) {
        let sampler = Sampler::new(1, 2, sample);
        sky.radiance(direction, &sampler, &mut alone);
        for level in [DVec3::X, DVec3::Y] {
            sky.look(direction, level, &sampler, &mut values);
            for (i, radiance) in values.iter().zip(&alone) {
                assert!((i - radiance).abs() <= 1e-12 * radiance, "{i} for {radiance}");
            }
        }
    }
}

#[test]
fn polarised_runs_go_on_and_merge() {
    let scene = Scene { spp: Some(12), block: Some(2), ..polarised() };
    let sky = sky(&scene);
    let whole = render(&scene, &sky, RUN).expect("finite").film;
    let stopped = stopped_after(4, empty(&scene, &sky), &scene, &sky, Extent::default());
    let head = Head::new(&scene, &sky, vec![Part { seed: 0, shard: Shard::default() }]);
    let kept = State::decode(&head.encode(&stopped.film)).expect("a state").film;
    assert_eq!(kept, stopped.film);
    assert!(go_on(kept, &scene, &sky, Extent::default(), RUN, &mut |_| {}).expect("finite").film == whole);
    let parts: Vec<_> = (1..=2).map(|index| part(&scene, &sky, shard(index, 2))).collect();
    let (_, merged) = merged(&parts, &[1, 0]).expect("one picture");
    for (pixel, index) in places(&whole) {
        let (a, b) = (seen(&whole, pixel, index), seen(&merged, pixel, index));
        // Sums of six numbers in another order.
        assert!((a.q - b.q).abs().max((a.u - b.u).abs()) <= 1e-12 * a.i);
    }
}

#[test]
fn a_phase_function_without_a_matrix_is_refused() {
    let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
    let dust = |phase| Scene { biome: Some(Biome::DesertDust), phase, ..polarised() };
    let error = Sky::new(&dust(HazePhase::HenyeyGreenstein), &data).expect_err("no matrix").to_string();
    assert!(error.contains("--phase mie"), "{error}");
    assert!(Sky::new(&dust(HazePhase::Mie), &data).is_ok());
}

#[test]
fn certificates_look_at_what_pictures_show() {
    // Single values of a point sun; the picture's come from polynomials in the direction, which are right to 2e-4 of I.
    let solved = Scene { method: Method::Solved, spp: None, sun_shape: SunShape::Point, ..polarised() };
    for scene in [solved.clone(), Scene { polarisation: false, filter_deg: Some(35.0), ..solved }] {
        let sky = sky(&scene);
        let packets = sky.certificates().expect("solved");
        let direction = DVec3::new(0.5, -0.3, 0.4).normalize();
        // Clockwise as seen from above: azimuth of pictures.
        let level = direction.cross(DVec3::Z).normalize();
        let mut shown = vec![0.0; sky.values()];
        sky.look(direction, level, &Sampler::new(0, 0, 0), &mut shown);
        let [packet] = packets.as_slice() else { panic!("one packet of three wavelengths") };
        let rows = packet.table(direction);
        assert_eq!(rows.len() * 3, shown.len());
        for (k, j) in (0..rows.len()).flat_map(|k| (0..3).map(move |j| (k, j))) {
            // U has the other sign in the picture's frame, which makes no difference to how far off it is.
            let sign = if k == 2 { -1.0 } else { 1.0 };
            let off = rows[k][j] - sign * shown[3 * k + j];
            assert!(off.abs() < 1e-3 * rows[0][j], "{k}, {j}: {:e}, {:e}", rows[k][j], shown[3 * k + j]);
        }
        let verdict = certify(&scene, &sky, 0.01, &NEVER, &|_| {}).expect("solved");
        assert!(verdict.holds() && verdict.errors.len() == rows.len(), "{verdict:?}");
    }
}
