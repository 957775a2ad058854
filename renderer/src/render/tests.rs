//! Behaviour of whole pictures, on the tables of the repository.

mod earth;
mod polarised;
mod rungs;

use super::*;
use crate::data::Data;
use crate::scene::CameraKind;
use crate::spectrum::Wavelengths;
use crate::transport::Method;
use std::path::Path;
use std::time::Duration;

static NEVER: AtomicBool = AtomicBool::new(false);
const RUN: Control<'static> = Control { stop: &NEVER, observe: &|_| {} };

fn small() -> Scene {
    Scene {
        width: Some(12),
        height: Some(10),
        spp: Some(3),
        wavelengths_nm: Wavelengths::new(vec![450.0, 550.0, 650.0]).expect("valid"),
        method: Method::Paths,
        ..Scene::default()
    }
}

fn sky(scene: &Scene) -> Sky {
    scene.validate().expect("valid");
    let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
    Sky::new(scene, &data).expect("a sky")
}

#[test]
fn solved_pictures_have_no_noise_and_state_the_tables_error() {
    let scene = Scene { method: Method::Solved, spp: None, ..small() };
    let sky = sky(&scene);
    let picture = |seed| format!("{:?}", render(&Scene { seed, ..scene.clone() }, &sky, RUN).expect("finite").film);
    assert_eq!(picture(1), picture(2), "the middle of each pixel needs no random number");
    let error = sky.table_error().expect("solved");
    assert!(error > 1e-6 && error < 2e-3, "by day {error:e}");
}

#[test]
fn solved_pictures_are_certified() {
    let scene = Scene { method: Method::Solved, spp: None, ..small() };
    let verdict = certify(&scene, &sky(&scene), 0.01, &NEVER, &|_| {}).expect("solved");
    assert!(verdict.holds() && verdict.errors.len() == 1 && verdict.errors[0].mean.0.abs() < 0.01, "{verdict:?}");
    assert_eq!(
        Some(verdict),
        certify(&scene, &sky(&scene), 0.01, &NEVER, &|_| {}),
        "random numbers are a function of the seed"
    );
    let paths = small();
    assert_eq!(certify(&paths, &sky(&paths), 0.01, &NEVER, &|_| {}), None);
}

#[test]
fn a_sun_too_low_for_a_solved_table_is_refused() {
    let scene = Scene { method: Method::Solved, sun_elevation_deg: -18.0, ..small() };
    let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
    let error = Sky::new(&scene, &data).expect_err("dark").to_string();
    assert!(error.contains("--method paths") && error.contains("too low"), "{error}");
}

#[test]
fn any_number_of_threads_gives_the_same_picture() {
    let scene = small();
    let sky = sky(&scene);
    let picture = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let rendering = pool.install(|| render(&scene, &sky, RUN)).expect("finite");
        (format!("{:?}", rendering.film), pool.install(|| Summary::new(&sky, 7, &NEVER)))
    };
    assert_eq!(picture(1), picture(3));
}

#[test]
fn a_replayed_sample_is_the_one_in_the_picture() {
    let scene = Scene { spp: Some(1), ..small() };
    let sky = sky(&scene);
    let film = render(&scene, &sky, RUN).expect("finite").film;
    let (direction, factors) = replay(&scene, &sky, 7, 3, 0).expect("inside");
    assert!(direction.z > 0.0);
    for (index, factor) in factors.iter().enumerate() {
        assert_eq!(film.radiance(3 * 12 + 7, index).mean, factor * sky.irradiance_w_m2_nm()[index]);
    }
    assert!(replay(&scene, &sky, 0, 0, 0).is_none() && film.blocks(0) == 0, "the corner is outside the circle");
}

#[test]
fn a_picture_goes_on_until_its_error_is_reached_or_it_is_stopped() {
    let scene = Scene { spp: None, error: Some(0.2), ..small() };
    let sky = sky(&scene);
    let rendering = render(&scene, &sky, RUN).expect("finite");
    assert!(rendering.errors.relative <= 0.2 && rendering.end == End::Done, "{:?}", rendering.errors);
    let limited =
        render(&Scene { spp: Some(5), block: Some(1), error: Some(1e-5), ..small() }, &sky, RUN).expect("finite");
    assert_eq!((limited.film.most_blocks(), limited.end), (5, End::Done));
    let stop = AtomicBool::new(true);
    let stopped = render(&scene, &sky, Control { stop: &stop, observe: &|_| {} }).expect("finite");
    assert!(stopped.end == End::Stopped && stopped.film.most_blocks() == 0);
}

#[test]
fn the_sun_in_the_picture_gives_the_sunlight_on_the_ground() {
    // A pinhole of 2 degrees: solid angle of a pixel (2 tan 1 / n)^2 cos^3, cos^3 within 5e-4 of 1 here.
    // A fisheye of 30 degrees: (30 degrees / n)^2 sinc; the sun in its middle, where sinc is 1.
    for (camera, fov_deg, n) in [(CameraKind::Pinhole, 2.0, 48), (CameraKind::Fisheye, 30.0, 40)] {
        let scene = Scene {
            camera,
            fov_deg: Some(fov_deg),
            view_azimuth_deg: Some(180.0),
            view_elevation_deg: Some(30.1),
            width: Some(n),
            height: Some(n),
            ..small()
        };
        let sky = sky(&scene);
        let pixel = fov_deg.to_radians() / f64::from(n);
        let mut irradiance = [0.0; 3];
        for factors in disc_layer(&scene, &sky).values() {
            for (sum, factor) in irradiance.iter_mut().zip(factors) {
                *sum += factor * pixel * pixel * 0.5;
            }
        }
        for (got, direct) in irradiance.iter().zip(sky.direct_irradiance()) {
            // The cosine is 1/2 within 4e-3 over the disc and even about its middle; the grid resolves
            // 1/32 of the radius, so the disc's area is right to about 1e-3.
            assert!((got / direct - 1.0).abs() < 3e-3, "{got} for {direct} with {camera:?}");
        }
    }
}

#[test]
fn direct_sunlight_follows_beer_and_lambert() {
    let scene = Scene { sun_elevation_deg: 90.0, ozone_du: Some(0.0), ..small() };
    // Without ozone the vertical optical depth at 550 nm is 0.0971 to 0.0972 (Bucholtz 1995).
    let direct = sky(&scene).direct_irradiance()[1];
    assert!((direct - (-0.0971_f64).exp()).abs() < 2e-4, "{direct}");
    let night = sky(&Scene { sun_elevation_deg: -1.0, ..small() });
    assert_eq!(night.direct_irradiance(), [0.0; 3]);
}

#[test]
fn above_the_atmosphere_the_zenith_is_black() {
    let scene = Scene { altitude_km: 400.0, ..small() };
    let sky = sky(&scene);
    let summary = Summary::new(&sky, 0, &NEVER);
    assert_eq!((summary.zenith_cd_m2.mean, summary.sky_lux.mean), (0.0, 0.0));
    // 133.1 klux above the atmosphere (G173), times sin 30 degrees; three wavelengths
    // carry a constant exactly.
    assert!((summary.sun_lux / 66_550.0 - 1.0).abs() < 5e-3, "{}", summary.sun_lux);
    // Seen from space the middle of the picture is the ground, lit through the air.
    let film = render(&scene, &sky, RUN).expect("finite").film;
    assert!(film.luminance(5 * 12 + 6).mean > 1000.0);
}

#[test]
fn progress_never_passes_the_whole() {
    let work = Work { first: 0, taken: 8, limit: 64, error: f64::INFINITY, wanted: None };
    assert!((work.fraction(8.0) - 0.25).abs() < 1e-12 && work.fraction(100.0) == 1.0);
    // Twice the wanted error after 8 blocks: 32 are needed.
    let work = Work { first: 0, taken: 8, limit: u32::MAX, error: 0.02, wanted: Some(0.01) };
    assert!((work.fraction(0.0) - 0.25).abs() < 1e-12);
    // A run that goes on from 4 has made 4 of the 28 that are left.
    assert!((Work { first: 4, ..work }.fraction(0.0) - 4.0 / 28.0).abs() < 1e-12);
    let late = Work { first: 2000, taken: 2000, limit: 5000, error: f64::INFINITY, wanted: Some(0.01) };
    assert!((0.0..=1.0).contains(&late.fraction(0.5)));
}

#[test]
fn passes_end_at_every_look_and_looks_grow_rarer() {
    let (mut taken, mut looks) = (0, Vec::new());
    while taken < 1 << 20 {
        let end = pass_end(taken, 50);
        assert!(end > taken && end - taken <= 50);
        taken = end;
        looks.extend(is_look(taken).then_some(taken));
    }
    assert_eq!(looks[..3], [16, 17, 18]);
    // 16 of each power of two.
    assert_eq!(looks.len(), 16 * 16 + 1);
    assert_eq!((pass_end(u32::MAX - 1, 5), pass_end(3, 1)), (u32::MAX, 4));
}

/// A scene of two rows of bands would be large; a stop after some rows leaves the same unevenness.
fn stopped_after(rows: u32, film: Film, scene: &Scene, sky: &Sky, extent: Extent) -> Rendering {
    let (stop, seen) = (AtomicBool::new(false), AtomicU32::new(0));
    let observe = |_| {
        if seen.fetch_add(1, Ordering::Relaxed) + 1 >= rows {
            stop.store(true, Ordering::Relaxed);
        }
    };
    go_on(film, scene, sky, extent, Control { stop: &stop, observe: &observe }, &mut |_| {}).expect("finite")
}

#[test]
fn a_run_that_goes_on_gives_the_bits_of_one_that_was_not_interrupted() {
    let whole = Scene { spp: Some(64), block: Some(2), ..small() };
    let sky = sky(&whole);
    let to_error = Scene { spp: None, error: Some(0.06), ..whole.clone() };
    for scene in [&whole, &to_error] {
        let expected = render(scene, &sky, RUN).expect("finite").film;
        // Over a state in bytes, after some rows of several passes, and after fewer samples.
        let mut film = empty(scene, &sky);
        for rows in [3, 14, 1] {
            let stopped = stopped_after(rows, film, scene, &sky, Extent::default());
            assert_eq!(stopped.end, End::Stopped);
            let head = Head::new(scene, &sky, vec![Part { seed: 0, shard: Shard::default() }]);
            film = State::decode(&head.encode(&stopped.film)).expect("a state").film;
            assert_eq!(film, stopped.film);
        }
        let fewer = Scene { spp: Some(film.most_blocks() * 2 + 4), error: None, ..scene.clone() };
        let film = go_on(film, &fewer, &sky, Extent::default(), RUN, &mut |_| {}).expect("finite").film;
        let film = go_on(film, scene, &sky, Extent::default(), RUN, &mut |_| {}).expect("finite").film;
        assert!(film == expected, "{} blocks, {} expected", film.most_blocks(), expected.most_blocks());
    }
}

#[test]
fn a_run_ends_with_its_time_and_can_be_repeated() {
    let scene = Scene { block: Some(1), spp: None, ..small() };
    let sky = sky(&scene);
    // Whatever the clock says: two blocks, if the time is up before the first.
    let over = Extent { deadline: Some(Instant::now()), ..Extent::default() };
    let rendering = go_on(empty(&scene, &sky), &scene, &sky, over, RUN, &mut |_| {}).expect("finite");
    assert_eq!(rendering.end, End::Time);
    let taken = rendering.film.most_blocks();
    assert!(taken >= 2 && rendering.film.least_blocks() == taken);
    let again = render(&Scene { spp: Some(taken), ..scene.clone() }, &sky, RUN).expect("finite");
    assert_eq!(again.film, rendering.film);
    // Samples that are taken before the time is up end it.
    let long = Extent { deadline: Instant::now().checked_add(Duration::from_secs(1000)), ..Extent::default() };
    let few = Scene { spp: Some(3), ..scene };
    assert_eq!(go_on(empty(&few, &sky), &few, &sky, long, RUN, &mut |_| {}).expect("finite").end, End::Done);
}

fn shard(index: u32, of: u32) -> Shard {
    Shard::new(index, of).expect("possible")
}

/// Film and head of a part.
fn part(scene: &Scene, sky: &Sky, shard: Shard) -> (Head, Film) {
    let film = go_on(empty(scene, sky), scene, sky, Extent { shard, deadline: None }, RUN, &mut |_| {});
    (Head::new(scene, sky, vec![Part { seed: scene.seed, shard }]), film.expect("finite").film)
}

fn merged(parts: &[(Head, Film)], order: &[usize]) -> Result<(Head, Film), MergeError> {
    let heads: Vec<_> = order.iter().map(|&i| (format!("{i}.state"), parts[i].0.clone())).collect();
    let plan = Merged::new(&heads)?.expect("some");
    let films: Vec<&Film> = plan.order.iter().map(|&at| &parts[order[at]].1).collect();
    let mut film = films[0].clone();
    films[1..].iter().for_each(|other| film.merge(other).expect("the same picture"));
    Ok((plan.head(&film), film))
}

/// Largest relative difference of means and errors of all wavelengths.
fn distance(a: &Film, b: &Film) -> f64 {
    let (width, height) = a.size();
    let values = (0..(width * height) as usize).flat_map(|pixel| (0..a.wavelengths()).map(move |k| (pixel, k)));
    values
        .filter(|(pixel, _)| a.blocks(*pixel) > 0)
        .map(|(pixel, k)| {
            let (x, y) = (a.radiance(pixel, k), b.radiance(pixel, k));
            (x.mean / y.mean - 1.0).abs().max((x.error / y.error - 1.0).abs())
        })
        .fold(0.0, f64::max)
}

#[test]
fn shards_merge_to_the_whole_picture_in_any_order() {
    let scene = Scene { spp: Some(26), block: Some(2), ..small() };
    let sky = sky(&scene);
    let whole = render(&scene, &sky, RUN).expect("finite").film;
    // 13 blocks: 4 and 4 in the thirds, and 5.
    let parts: Vec<_> = (1..=3).map(|index| part(&scene, &sky, shard(index, 3))).collect();
    let (head, film) = merged(&parts, &[0, 1, 2]).expect("one picture");
    assert_eq!(head.scene, scene, "shards of one run are its picture");
    assert_eq!((film.most_blocks(), film.least_blocks()), (13, 13));
    // Sums of 13 numbers in another order.
    assert!(distance(&film, &whole) < 1e-12, "{}", distance(&film, &whole));
    for order in [[1, 0, 2], [2, 1, 0], [1, 2, 0]] {
        assert!(merged(&parts, &order).expect("one picture") == (head.clone(), film.clone()), "{order:?}");
    }
    let pair = merged(&parts, &[2, 0]).expect("one picture");
    let both = merged(&[pair, parts[1].clone()], &[0, 1]).expect("one picture");
    assert!(distance(&both.1, &whole) < 1e-12 && both.0.parts == head.parts);
}

#[test]
fn seeds_merge_to_an_error_that_falls_as_their_root() {
    let scene = Scene { spp: Some(32), block: Some(1), ..small() };
    let sky = sky(&scene);
    let parts: Vec<_> = (0..4).map(|seed| part(&Scene { seed, ..scene.clone() }, &sky, Shard::default())).collect();
    let (head, film) = merged(&parts, &[3, 1, 0, 2]).expect("one picture");
    assert_eq!((head.scene.spp, head.scene.seed, head.parts.len()), (Some(128), 0, 4));
    let error = |film: &Film| film.errors().relative;
    let single = parts.iter().map(|(_, film)| error(film).powi(2)).sum::<f64>() / 4.0;
    // The variance of the variances of some 90 pixels is some percent.
    assert!((single / error(&film).powi(2) / 4.0 - 1.0).abs() < 0.1, "{}", single / error(&film).powi(2));
}

#[test]
fn what_is_not_of_one_picture_is_not_merged() {
    let scene = Scene { spp: Some(4), block: Some(1), ..small() };
    let sky = sky(&scene);
    let parts = [
        part(&scene, &sky, shard(1, 2)),
        part(&scene, &sky, shard(3, 4)),
        part(&Scene { sun_azimuth_deg: 90.0, seed: 1, ..scene.clone() }, &sky, Shard::default()),
        part(&Scene { block: Some(2), seed: 2, ..scene.clone() }, &sky, Shard::default()),
    ];
    let refusal = |order: &[usize]| merged(&parts, order).expect_err("refused").to_string();
    // Shard 3/4 has every other block of shard 1/2.
    assert_eq!(
        refusal(&[1, 0]),
        "0.state and 1.state have samples in common: seed 0, shard 1/2, and seed 0, shard 3/4"
    );
    assert!(refusal(&[0, 0]).contains("samples in common"));
    assert_eq!(
        refusal(&[2, 0]),
        "0.state and 2.state are not of the same picture: sun_azimuth_deg is 180.0 in one, 90.0 in the other"
    );
    assert!(refusal(&[0, 3]).contains("block is 1 in one, 2 in the other"));
    let mut other = parts[0].clone();
    other.0.tables = other.0.tables.replacen("standard", "nonstandard", 1);
    other.0.parts[0].seed = 5;
    let text = merged(&[parts[0].clone(), other], &[0, 1]).expect_err("other tables").to_string();
    assert!(text.contains("only one was made with the table"), "{text}");
}

#[test]
fn a_damaged_state_is_refused_whatever_is_damaged() {
    let scene = Scene { width: Some(2), height: Some(2), ..small() };
    let sky = sky(&scene);
    let (head, film) = part(&scene, &sky, Shard::default());
    let bytes = head.encode(&film);
    assert_eq!(State::decode(&bytes).expect("sound"), State { head, film });
    for at in 0..bytes.len() {
        let mut damaged = bytes.clone();
        damaged[at] ^= 1;
        assert!(State::decode(&damaged).is_err(), "byte {at}");
        assert!(State::decode(&bytes[..at]).is_err(), "{at} bytes");
    }
    assert!(State::decode(&[bytes, vec![0]].concat()).is_err());
}
