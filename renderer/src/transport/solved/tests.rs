//! Laws of solved tables.

use super::super::tests::{EARTH, columns, estimate, exponential, medium, mixed, rayleigh, towards};
use super::first::{Scattering, Sunlight};
use super::folded::Folded;
use super::glow::Glow;
use super::guide::Way;
use super::line::Crossing;
use super::orders::Around;
use super::rays::Lines;
use super::solve::{First, Next, Setup};
use super::sources::Sources;
use super::*;
use crate::atmosphere::Component;
use crate::light::SunDisc;
use crate::phase::Phase;
use crate::sampling::spiral;
use crate::transport::{Estimator, Problem};
use crate::vectors::vectorised;
use pulp::NullaryFnOnce;
use tables::{Axis, Curve, Outside, Scale};

mod certified;

/// As fine as tests need.
const TEST: Resolution = Resolution { levels: 18, suns: 36, zeniths: [6, 4, 5], parts: 4, degree: 12, change: 5e-4 };

fn clear() -> Medium<2> {
    let top = 6e4;
    let molecules = Component {
        density: exponential(8e3, top),
        scattering: [2.5e-5, 5e-6],
        absorption: [0.0, 1e-7],
        phase: rayleigh(0.015),
    };
    medium(vec![molecules], top)
}

#[test]
fn planes_and_impossible_resolutions_are_refused() {
    let refused = Solved::new(&clear(), Shape::Flat, [0.1; 2], &TEST);
    assert!(matches!(refused, Err(SolveError::Refused(text)) if text.contains("round planet")));
    for resolution in [Resolution { levels: 3, ..TEST }, Resolution { degree: 25, ..TEST }] {
        let refused = Solved::new(&clear(), EARTH, [0.1; 2], &resolution);
        assert!(matches!(refused, Err(SolveError::Refused(text)) if text.contains("degrees up to 24")));
    }
}

#[test]
fn single_scattering_is_the_sum_along_the_line() {
    // The table's own transmittances are right to 2e-5, the quadrature of a view to a few 1e-5 by day and 3e-4 where the shadow's edge
    // crosses the line.
    beside_the_sum(
        &clear(),
        &[
            (0.0, 40.0, 60.0, 30.0, 1e-4),
            (0.0, 89.0, 180.0, 70.0, 1e-4),
            (0.0, 70.0, 0.0, 94.0, 5e-4),
            (0.0, 60.0, 180.0, 92.0, 5e-4),
            (2e4, 95.0, 90.0, 85.0, 5e-4),
            (2e5, 104.0, 20.0, 60.0, 5e-4),
        ],
    );
}

#[test]
fn single_scattering_is_that_sum_where_sunlight_touches_a_layer() {
    // Two kilometres of haze, of optical depth 0.1, end sharply: sunlight that passes just below their top loses much more than that just
    // above, and what it loses begins as a root, of which Gauss' rule leaves up to 1e-3.
    let top = 6e4;
    let axis = Axis::new("altitude", "m", vec![0.0, 2e3]).expect("valid").beyond(Outside::Zero);
    let layer = Curve::new(axis, Scale::Linear, vec![1.0; 2]).expect("valid");
    let haze = Component { density: layer, scattering: [5e-5, 4e-5], absorption: [5e-6; 2], phase: rayleigh(0.015) };
    let medium = medium(vec![clear().components()[0].clone(), haze], top);
    let suns = [(40.0, 60.0, 93.0), (70.0, 0.0, 94.0), (80.0, 180.0, 92.0), (20.0, 90.0, 95.0), (66.0, 45.0, 94.4)];
    beside_the_sum(&medium, &suns.map(|(zenith, azimuth, sun)| (0.0, zenith, azimuth, sun, 1e-3)));
}

/// Altitude, zenith angle and azimuth of a view, the sun's zenith angle, and how far single scattering may be from the sum over 20 000
/// midpoints with transmittances by quadrature instead of tables, as exact as six digits.
fn beside_the_sum(medium: &Medium<2>, cases: &[(f64, f64, f64, f64, f64)]) {
    let solved = Solved::new(medium, EARTH, [0.0; 2], &TEST).expect("round");
    let columns = columns(medium, EARTH);
    let n = 20_000;
    for &(altitude, zenith, azimuth, sun_zenith, tolerance) in cases {
        let (from, direction, sun) = (Place::above(altitude), towards(zenith, azimuth), towards(sun_zenith, 0.0));
        let found = solved.radiance(from, direction, sun, true);
        let chord = columns.chord(from, direction).expect("through the air");
        let (begin, end) = chord.ends();
        let (mut sum, step) = ([0.0; 2], (end - begin) / f64::from(n));
        let phase = medium.components()[0].phase.values(direction.dot(sun));
        let mut depth = [0.0; 2];
        for i in 0..n {
            let s = begin + (f64::from(i) + 0.5) * step;
            let place = from.advance(EARTH, direction, chord.travelled(s));
            let local = medium.local_at(place.altitude_m);
            let through = medium.transmittance(EARTH, place, sun);
            for j in 0..2 {
                let half = 0.5 * step * local.extinction[j];
                let passed = (-(depth[j] + half)).exp();
                sum[j] += step * local.scattering[j] * phase[j] * passed * through[j];
                depth[j] += 2.0 * half;
            }
        }
        for j in 0..2 {
            let off = found[j] / sum[j] - 1.0;
            assert!(off.abs() < tolerance, "{altitude} m, {zenith}, {azimuth}, sun {sun_zenith}: {off:e}");
        }
    }
}

#[test]
fn the_path_tracer_agrees() {
    // Molecules, haze and ozone over a bright ground. 5 standard errors, and what the grid of this test leaves: 0.4 % by day,
    // 1.5 % where the sun is 4 degrees below the horizon.
    let medium = mixed();
    let albedo = [0.5; 4];
    let solved = Solved::new(&medium, EARTH, albedo, &TEST).expect("round");
    let columns = columns(&medium, EARTH);
    for (altitude, zenith, azimuth, sun_zenith, paths, grid) in [
        (2.0, 10.0, 0.0, 50.0, 20_000, 4e-3),
        (2.0, 75.0, 120.0, 50.0, 20_000, 4e-3),
        (3e3, 100.0, 40.0, 80.0, 20_000, 4e-3),
        (1e6, 170.0, 0.0, 40.0, 20_000, 4e-3),
        (2.0, 80.0, 0.0, 94.0, 30_000, 1.5e-2),
    ] {
        let disc = SunDisc::beam(towards(sun_zenith, 0.0));
        let problem = Problem {
            texture: None,
            shape: EARTH,
            medium: &medium,
            columns: &columns,
            albedo,
            sun: Some(&disc),
            environment: None,
            max_orders: None,
        };
        let (from, direction) = (Place::above(altitude), towards(zenith, azimuth));
        let found = solved.radiance(from, direction, disc.direction(), false);
        let paths = estimate(Estimator::Paths, &problem, from, direction, paths, 3);
        for (j, (mean, error)) in paths.into_iter().enumerate() {
            let allowed = 5.0 * error + grid * mean;
            let off = found[j] - mean;
            assert!(off.abs() < allowed, "{zenith}, sun {sun_zenith}, {j}: {:e}, {mean:e} +- {error:e}", found[j]);
            assert!(error < 0.02 * mean, "an error of {error:e} tests nothing");
        }
    }
}

#[test]
fn the_table_knows_how_exact_it_is() {
    // Half the distance from the coarser solution, against the distance from one that is finer in everything.
    let medium = clear();
    let solved = Solved::new(&medium, EARTH, [0.3; 2], &Resolution::RENDER).expect("round");
    let coarse = solved.again(&Resolution::COARSE, None).expect("solved");
    let fine = solved
        .again(&Resolution { levels: 32, suns: 64, zeniths: [10, 7, 8], parts: 8, degree: 2, change: 5e-4 }, None)
        .expect("solved");
    for sun_zenith in [20.0, 80.0, 90.0, 95.0] {
        let (from, sun) = (Place::above(2.0), towards(sun_zenith, 0.0));
        let (stated, off) = (FINER * solved.difference(&coarse, from, sun), solved.difference(&fine, from, sun));
        assert!(off < 2.0 * stated && off > 0.02 * stated, "sun {sun_zenith}: off by {off:e}, states {stated:e}");
    }
}

#[test]
fn radiance_does_not_jump_at_the_top_or_on_the_ground() {
    let solved = Solved::new(&clear(), EARTH, [0.3; 2], &TEST).expect("round");
    let sun = towards(85.0, 0.0);
    for (a, b) in [(6e4 - 1e-3, 6e4 + 1e-3), (0.0, 1e-3)] {
        for zenith in [95.0, 100.0, 150.0, 180.0] {
            let [below, above] = [a, b].map(|h| solved.radiance(Place::above(h), towards(zenith, 30.0), sun, false)[0]);
            // A millimetre is 1e-7 of the scale height.
            assert!((below / above - 1.0).abs() < 1e-5, "{zenith} at {a} m: {below:e}, {above:e}");
        }
    }
}

#[test]
fn what_polynomials_leave_of_the_dark_is_not_made_bright() {
    // A look with the sun behind its line, and next to nothing scattered once but with peaks below zero, as interpolation leaves it.
    let solved = Solved::new(&mixed(), EARTH, [0.3; 4], &TEST).expect("solved");
    let (from, direction, sun) = (Place::above(2.0), towards(70.0, 180.0), towards(94.0, 0.0));
    let sunlight = &solved.optics.columns;
    let mut seen = view::Look { solved: &solved, from, direction, sun, single: false, sunlight }.call();
    let whole: f64 = seen.once.iter().flatten().sum();
    seen.once = seen.once.map(|row| row.map(|_| 1e-9 * whole));
    seen.peaks = [-whole; 4];
    let light = solved.shade(&seen, direction.dot(sun), false);
    for (light, rest) in light.into_iter().zip(seen.rest) {
        assert!((light - rest).abs() < 1e-6 * rest, "{light:e} of {rest:e}");
    }
}

#[test]
fn where_a_solution_begins_makes_no_difference() {
    // Fields that begin at a coarser grid's, with moments of another degree or without its first order, are those that begin at their own
    // first order to what an order changes, in less orders.
    let medium = mixed();
    let alone = Solved::new(&medium, EARTH, [0.3; 4], &TEST).expect("solved");
    let coarse = Resolution { levels: 12, suns: 30, zeniths: [4, 3, 3], parts: 2, degree: 10, change: 5e-4 };
    let mut coarser = Solved::new(&medium, EARTH, [0.3; 4], &coarse).expect("solved");
    let air = (&medium, EARTH, [0.3; 4], false);
    let begun = Solved::begun(air, &TEST, Some(&coarser), None).expect("solved");
    coarser.first = None;
    let found_again = Solved::begun(air, &TEST, Some(&coarser), None).expect("solved");
    assert_eq!(begun.field.moments, found_again.field.moments);
    let [few, many] = [&begun, &alone].map(|solved| solved.convergence().0);
    assert!(few < many, "{few} and {many} orders");
    for sun_zenith in [20.0, 80.0, 92.0] {
        let off = begun.difference(&alone, Place::above(2.0), towards(sun_zenith, 0.0));
        assert!(off < TEST.change, "sun {sun_zenith}: {off:e}");
    }
    // Another order changes a solution by no more than it says.
    let (orders, change) = alone.again(&TEST, None).expect("solved").convergence();
    assert!(orders == 2 && change <= alone.convergence().1, "{orders} orders, {change:e}");
}

#[test]
fn threads_make_no_difference() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        let coarse = Resolution { levels: 10, suns: 20, zeniths: [4, 2, 3], parts: 2, degree: 6, change: 5e-4 };
        let solved = pool.install(|| Solved::new(&mixed(), EARTH, [0.2; 4], &coarse)).expect("round");
        solved.radiance(Place::above(2.0), towards(70.0, 10.0), towards(88.0, 0.0), false)
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn bright_and_dense_atmospheres_need_few_orders() {
    // Optical depth 2 over a ground of albedo 0.8: a plain iteration takes twenty orders for three digits.
    let top = 6e4;
    let haze =
        Component { density: exponential(8e3, top), scattering: [2.5e-4], absorption: [0.0], phase: rayleigh(0.0) };
    let solved = Solved::new(&medium(vec![haze], top), EARTH, [0.8], &TEST).expect("round");
    let (orders, residual) = solved.convergence();
    assert!(orders <= 14 && residual <= TEST.change, "{orders} orders, {residual:e}");
}

#[test]
fn the_width_of_vectors_makes_no_difference() {
    // Each kernel as this processor's widest vectors compute it, and as it is compiled for any processor.
    let medium = mixed();
    let coarse = Resolution { levels: 10, suns: 20, zeniths: [4, 2, 3], parts: 2, degree: 6, change: 5e-4 };
    let solved = Solved::new(&medium, EARTH, [0.2; 4], &coarse).expect("round");
    let (from, direction, sun) = (Place::above(2.0), towards(70.0, 10.0), towards(88.0, 0.0));
    let sunlight = &solved.optics.columns;
    let look = view::Look { solved: &solved, from, direction, sun, single: false, sunlight };
    let seen = look.call();
    assert_eq!(solved.shade(&seen, direction.dot(sun), false), solved.radiance(from, direction, sun, false));
    let setup = Setup { grid: &solved.grid, optics: &solved.optics };
    let lines = Lines::new(&setup, 3, &solved.grid.zeniths(3, coarse.zeniths));
    let (sunlight, scattering) = (Sunlight::new(&setup, 2), Scattering::new(&setup));
    let first = || First { setup: &setup, level: 3, lines: &lines.lines, sunlight: &sunlight, scattering: &scattering };
    assert_eq!(first().call(), vectorised::<4, _>(first()));
    let (moments, suns) = (&solved.optics.moments, &solved.grid.suns);
    let next = || Next { around: Around { lines: &lines, moments, suns, reflected: [0.1; 4] }, field: &solved.field };
    assert_eq!(next().call(), vectorised::<4, _>(next()));
}

#[test]
fn layers_that_end_sharply_need_no_more_levels() {
    // Two kilometres of haze of optical depth 0.8 under clean air: the light's slope jumps with the scattering, and polynomials over the
    // jump are off by 1.1e-3 to 2.1e-3. Beside a grid with twice as many levels.
    let top = 6e4;
    let axis = Axis::new("altitude", "m", vec![0.0, 2e3]).expect("valid").beyond(Outside::Zero);
    let layer = Curve::new(axis, Scale::Linear, vec![1.0; 2]).expect("valid");
    let phase = Phase::HenyeyGreenstein { g: [0.6] };
    let haze = Component { density: layer, scattering: [4e-4], absorption: [4e-5], phase };
    let air = Component { density: exponential(8e3, top), scattering: [2e-5], absorption: [0.0], phase: rayleigh(0.0) };
    let medium = medium(vec![air, haze], top);
    let usual = Resolution { degree: 8, ..Resolution::RENDER };
    let solved = Solved::new(&medium, EARTH, [0.1], &usual).expect("round");
    let fine = solved.again(&Resolution { levels: 40, ..usual }, None).expect("solved");
    for zenith in [10.0, 40.0, 60.0] {
        let off = solved.difference(&fine, Place::above(2.0), towards(zenith, 0.0));
        assert!(off < 8e-4, "sun {zenith}: {off:e}");
    }
}

#[test]
fn the_asked_error_chooses_the_grid() {
    // Clear air at 2 m, whose tables state less by each step: with the sun at the horizon (by about a tenth of a percent on the usual grid).
    let (medium, from, sun) = (clear(), Place::above(2.0), towards(90.0, 0.0));
    let tables = |error: f64| {
        let tables = Tables::within(error, (from, sun, &[]), (&medium, EARTH, [0.1; 2], false), None).expect("solved");
        (tables.solved.resolutions.last().copied(), tables.error(from, sun, &[]))
    };
    let (usual, states) = tables(0.02);
    assert_eq!(usual, Some(Resolution::RENDER));
    assert!(states <= 0.02, "{states:e}");
    // Less than it states: the next; and whatever that states, no further where 0.3 % or more is asked.
    let (fine, finer) = tables(0.9 * states);
    assert_eq!(fine, Some(Resolution::FINE));
    assert!(finer < states, "{finer:e}, {states:e}");
    // Less than the next states, too: the last, also if that states more than was asked.
    let (finest, finest_states) = tables(0.5 * finer);
    assert_eq!(finest, Some(Resolution::FINEST));
    assert!(finest_states < finer, "{finest_states:e}, {finer:e}");
    assert_eq!(tables(1e-9).0, Some(Resolution::FINEST));
    // Next to no light: errors above 0.3 % may not be met on any grid, and the fine one is the last that is tried.
    let dark = towards(100.0, 0.0);
    let air = (&medium, EARTH, [0.1; 2], false);
    let of = |error: f64| Tables::within(error, (from, dark, &[]), air, None).expect("solved").solved.resolutions;
    assert_eq!(of(0.0031).last(), Some(&Resolution::FINE));
    assert_eq!(of(0.0029).last(), Some(&Resolution::FINEST));
}

#[test]
fn moments_that_no_grid_has_are_stated_most_with_a_low_sun() {
    // Whole from 6 to -2 degrees, half at 10 and -3.
    for (elevation, low) in [(90.0, 0.0), (14.0, 0.0), (10.0, 0.5), (6.0, 1.0), (-2.0, 1.0), (-3.0, 0.5), (-4.0, 0.0)] {
        let found = lowness(Place::above(2.0), towards(90.0 - elevation, 0.0));
        assert!((found - low).abs() < 1e-9, "{elevation}: {found}");
    }
    // A Henyey-Greenstein function has chi_l = g^l: of particles with g = 0.9 the share 0.9^(degree + 1) goes straight on.
    let top = 6e4;
    let phase = Phase::HenyeyGreenstein { g: [0.9] };
    let haze = Component { density: exponential(1e3, top), scattering: [1e-4], absorption: [0.0], phase };
    let air = Component { density: exponential(8e3, top), scattering: [1e-5], absorption: [0.0], phase: rayleigh(0.0) };
    let coarse = Resolution { levels: 10, suns: 20, zeniths: [4, 2, 3], parts: 2, degree: 6, change: 5e-4 };
    let optics = |parts| Solved::new(&medium(parts, top), EARTH, [0.1], &coarse).expect("round").optics;
    let [always, besides] = optics(vec![air.clone(), haze]).hidden(1.0);
    let expected = HIDDEN_OF_PARTICLES * 0.9_f64.powi(7);
    // The share is the moment by quadrature, to some 1e-4.
    assert!((besides[0] / expected - 1.0).abs() < 1e-3, "{besides:?}, {expected:e}");
    assert!(always[0] >= HIDDEN + besides[0], "{always:?}");
    assert_eq!(optics(vec![air]).hidden(1.0), [[0.0]; 2]);
}

#[test]
fn air_that_only_absorbs_leaves_the_ground() {
    let top = 6e4;
    let absorber =
        Component { density: exponential(8e3, top), scattering: [0.0], absorption: [1e-5], phase: rayleigh(0.0) };
    let medium = medium(vec![absorber], top);
    let solved = Solved::new(&medium, EARTH, [0.5], &TEST).expect("round");
    let (from, down, sun) = (Place::above(1e5), towards(180.0, 0.0), towards(30.0, 0.0));
    // Down and up by Beer and Lambert, to the columns' 1e-4.
    let [depth] = medium.optical_depth(EARTH, Place::above(0.0), towards(0.0, 0.0));
    let [slant] = medium.optical_depth(EARTH, Place::above(0.0), sun);
    let exact = 0.5 / std::f64::consts::PI * 30_f64.to_radians().cos() * (-depth - slant).exp();
    let [found] = solved.radiance(from, down, sun, false);
    assert!((found / exact - 1.0).abs() < 3e-4, "{found:e}, {exact:e}");
    assert_eq!(solved.radiance(Place::above(2.0), towards(20.0, 0.0), sun, false), [0.0]);
}

#[test]
fn kept_tables_are_those_that_were_solved() {
    let folder = std::env::temp_dir().join(format!("airlight-kept-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let medium = mixed();
    let coarse = Resolution { levels: 10, suns: 20, zeniths: [4, 2, 3], parts: 2, degree: 6, change: 5e-4 };
    let solve = |albedo: f64| Solved::kept(&medium, EARTH, [albedo; 4], &coarse, Some(&folder));
    let files = || std::fs::read_dir(&folder).expect("a folder").map(|file| file.expect("a file").path());
    let look = |solved: &Solved<4>| solved.radiance(Place::above(2.0), towards(70.0, 10.0), towards(88.0, 0.0), false);
    let (first, again) = (solve(0.2).expect("solved"), solve(0.2).expect("read"));
    assert_eq!((look(&first), first.convergence()), (look(&again), again.convergence()));
    assert_eq!(files().count(), 1);
    let other = solve(0.3).expect("solved");
    assert_ne!(look(&first), look(&other));
    assert_eq!(files().count(), 2, "other inputs have another file");
    // What is damaged is said, and not replaced.
    let path = files().next().expect("a file");
    std::fs::write(&path, b"nothing").expect("written");
    let refused = [0.2, 0.3].map(solve).into_iter().find_map(Result::err).expect("refused").to_string();
    assert!(refused.contains(path.to_str().expect("text")), "{refused}");
    std::fs::remove_dir_all(&folder).expect("removed");
}

/// Tables of one atmosphere: one as good as tests need and with more moments than certificates take; a coarse one; one 5 % too bright; and one
/// without a moment, and with last moments a thousand times too large, which certificates leave out.
fn spoiled(medium: &Medium<4>, albedo: [f64; 4]) -> [Solved<4>; 4] {
    let sound = Resolution { degree: 14, ..TEST };
    let coarse = Resolution { levels: 10, suns: 26, zeniths: [4, 2, 3], parts: 2, degree: 6, change: 5e-4 };
    let [sound, coarse] = [sound, coarse].map(|grid| Solved::new(medium, EARTH, albedo, &grid).expect("round"));
    let (mut bright, mut wrong) =
        (sound.again(&TEST, None).expect("solved"), sound.again(&TEST, None).expect("solved"));
    for moment in bright.field.moments.iter_mut().chain(&mut bright.field.ground).flatten() {
        *moment *= 1.05;
    }
    let count = wrong.optics.moments.count();
    for moments in wrong.field.moments.chunks_exact_mut(count) {
        moments[1] = [0.0; 4];
    }
    spoil_last(&mut wrong);
    [sound, coarse, bright, wrong]
}

/// Makes the moments that certificates leave out a thousand times as large.
fn spoil_last<const L: usize>(solved: &mut Solved<L>) {
    let moments = &solved.optics.moments;
    for (moment, (l, _)) in solved.field.moments.iter_mut().zip(moments.pairs().iter().cycle()) {
        if *l > sources::DEGREE {
            *moment = moment.map(|value| 1e3 * value);
        }
    }
}

#[test]
fn certified_radiance_does_not_depend_on_the_table() {
    // Against the path tracer with 4.5 standard errors of both: 1e-5 of false alarms for each of the 128 numbers.
    let albedo = [0.3; 4];
    let top = 6e4;
    let molecules = Component {
        density: exponential(8e3, top),
        scattering: [4e-5, 2.5e-5, 1e-5, 5e-6],
        absorption: [0.0, 1e-7, 0.0, 0.0],
        phase: rayleigh(0.015),
    };
    for (medium, fans) in [(medium(vec![molecules], top), 16), (mixed(), 32)] {
        let columns = columns(&medium, EARTH);
        let tables = spoiled(&medium, albedo);
        for (altitude, zenith, azimuth, sun_zenith) in
            [(2.0, 75.0, 120.0, 50.0), (3e3, 100.0, 40.0, 80.0), (1e6, 170.0, 0.0, 40.0), (2.0, 80.0, 0.0, 94.0)]
        {
            let sun = SunDisc::beam(towards(sun_zenith, 0.0));
            let problem = Problem {
                texture: None,
                shape: EARTH,
                medium: &medium,
                columns: &columns,
                albedo,
                sun: Some(&sun),
                environment: None,
                max_orders: None,
            };
            let (from, direction) = (Place::above(altitude), towards(zenith, azimuth));
            let paths = estimate(Estimator::Paths, &problem, from, direction, 30_000, 3);
            for (i, table) in tables.iter().enumerate() {
                let certificate = Certificate::new(table, columns.clone(), from, sun.direction());
                let found = certificate.radiance(direction, Fan::SMALL, fans, 1, 1);
                for (j, (mean, error)) in paths.iter().enumerate() {
                    let allowed = 4.5 * (found.variance[j] + error * error).sqrt();
                    let off = found.mean[j] - mean;
                    assert!(off.abs() < allowed, "table {i}, {zenith}, sun {sun_zenith}, {j}: {off:e} of {mean:e}");
                    assert!(
                        allowed < 0.4 * mean,
                        "table {i}, {zenith}, sun {sun_zenith}, {j}: {allowed:e} tests nothing"
                    );
                }
            }
        }
    }
}

#[test]
fn distances_are_drawn_by_their_density() {
    // The integral of v^2 over the way, by what is drawn at even steps of u: of steps of v with the least density, 5 % of the mean,
    // 30 of 20 000 are left.
    let (medium, albedo) = (mixed(), [0.3; 4]);
    let columns = columns(&medium, EARTH);
    let solved = Solved::new(&medium, EARTH, albedo, &TEST).expect("round");
    let sources = Sources { solved: &solved, truth: &columns, scaled: None };
    let glow = Glow::new(&sources, &[0.02; 4]);
    for (altitude, zenith, sun_zenith) in [(2.0, 30.0, 60.0), (2.0, 89.0, 95.0), (25e3, 92.0, 95.0), (5e3, 150.0, 40.0)]
    {
        let (from, direction, sun) = (Place::above(altitude), towards(zenith, 20.0), towards(sun_zenith, 0.0));
        let chord = columns.chord(from, direction).expect("within the air");
        let way = Way::new(&chord, solved.grid.radius);
        let mut sum = 0.0;
        for i in 0..20_000 {
            let u = (f64::from(i) + 0.5) / 2e4;
            let (v, density) = glow.draw(&sources, (&chord, &way), (from, direction), sun, u);
            assert!((0.0..1.0).contains(&v) && density >= 0.05 * (1.0 - 1e-9), "{v} {density}");
            sum += v * v / density / 2e4;
        }
        assert!((sum - 1.0 / 3.0).abs() < 1e-3, "{zenith}: {sum}");
    }
}

#[test]
fn an_empty_table_is_certified_too() {
    // Without a table paths end by roulette alone: what it leaves out, light of three orders and more, is found nevertheless.
    let (medium, albedo) = (clear(), [0.3; 2]);
    let sound = Solved::new(&medium, EARTH, albedo, &TEST).expect("round");
    let mut empty = sound.again(&TEST, None).expect("solved");
    empty.field.moments.iter_mut().chain(&mut empty.field.ground).for_each(|moments| *moments = [0.0; 2]);
    let (from, direction, sun) = (Place::above(2.0), towards(75.0, 120.0), towards(50.0, 0.0));
    let right = sound.radiance(from, direction, sun, false);
    let certificate = Certificate::new(&empty, columns(&medium, EARTH), from, sun);
    let found = certificate.radiance(direction, Fan { first: 128, kept: 8, further: 64 }, 1024, 1, 1);
    // 4.5 standard errors, and 0.3 % of the sound table; paths that end with the table would lack 7 and 1 %.
    for (j, allowed) in [(0, 0.06), (1, 0.0095)] {
        let (off, error) = (found.mean[j] / right[j] - 1.0, found.variance[j].sqrt() / right[j]);
        assert!(off.abs() < 4.5 * error + 3e-3, "{j}: {off:e} +- {error:e}");
        assert!(4.5 * error + 3e-3 < allowed, "an error of {error:e} tests nothing");
    }
}

#[test]
fn certificates_state_their_errors() {
    // 200 certificates of 8 fans: their spread is what they state, within 4 standard errors of a spread.
    let medium = mixed();
    let (from, direction, sun) = (Place::above(2.0), towards(60.0, 30.0), towards(70.0, 0.0));
    let columns = columns(&medium, EARTH);
    let coarse = Resolution { levels: 10, suns: 20, zeniths: [4, 2, 3], parts: 2, degree: 6, change: 5e-4 };
    let table = Solved::new(&medium, EARTH, [0.3; 4], &coarse).expect("round");
    let certificate = Certificate::new(&table, columns, from, sun);
    let fan = Fan { first: 16, kept: 1, further: 16 };
    let all: Vec<_> = (0..200).map(|seed| certificate.radiance(direction, fan, 8, seed, 0)).collect();
    let n = all.len() as f64;
    for j in 0..4 {
        let mean = all.iter().map(|one| one.mean[j]).sum::<f64>() / n;
        let spread = all.iter().map(|one| (one.mean[j] - mean).powi(2)).sum::<f64>() / (n - 1.0);
        let stated = all.iter().map(|one| one.variance[j]).sum::<f64>() / n;
        assert!((spread / stated).sqrt().ln().abs() < 0.2, "{j}: {spread:e}, {stated:e}");
    }
}

#[test]
fn a_panorama_shows_what_looks_see() {
    // Nodes were left out where they are right to 5e-4: elsewhere no worse than four times that, and in the mean a fifth.
    let medium = mixed();
    let solved = Solved::new(&medium, EARTH, [0.3; 4], &TEST).expect("round");
    let all: Vec<_> = (0..600).map(|i| spiral(i, 600, [-1.0, 1.0])).collect();
    for (altitude, sun_zenith) in [(0.0, 50.0), (0.5, 50.0), (2.0, 93.0), (9e3, 75.0), (4e5, 60.0)] {
        let (from, sun) = (Place::above(altitude), towards(sun_zenith, 30.0));
        let seen = Panorama::new(&solved, from, sun, 5e-4, Pixels { directions: &all, each: 1000 });
        let (mut worst, mut sum, mut count) = (0.0_f64, 0.0, 0.0);
        for &direction in &all {
            let right = solved.radiance(from, direction, sun, false);
            for (found, right) in seen.radiance(&solved, direction).into_iter().zip(right) {
                if right != 0.0 {
                    let off = (found / right - 1.0).abs();
                    (worst, sum, count) = (worst.max(off), sum + off, count + 1.0);
                }
            }
        }
        assert!(worst < 2e-3 && sum / count < 1e-4, "{altitude}, {sun_zenith}: {worst:e}, {:e}", sum / count);
        assert!(seen.looks() > 500, "{altitude}, {sun_zenith}: only {} looks", seen.looks());
    }
}

#[test]
fn sums_over_degrees_give_the_sources_of_each_azimuth() {
    // At a level, by sums that all azimuths share and by those of each: to the rounding of a hundred single numbers.
    let solved = Solved::new(&mixed(), EARTH, [0.3; 4], &TEST).expect("round");
    let (level, zenith, species) = (3, 0.35, solved.optics.species.len());
    let altitude = solved.grid.levels[level];
    let scattering: Vec<[f64; 4]> = (0..species).map(|k| [1e-5, 2e-5, 3e-5, 1e-5 * (k + 1) as f64]).collect();
    let (mut folded, mut harmonics, mut weights) = (Folded::new(&solved, 1), Vec::new(), Vec::new());
    let reach = solved.optics.reach(&scattering).expect("they scatter");
    solved.optics.add_weights((&scattering, reach, zenith), &mut harmonics, &mut weights);
    let place = Crossing { level, s: zenith * (solved.grid.radius + altitude) };
    for there in [0.5, -0.03, 0.02, 0.5] {
        for azimuth in [0.0_f64, 1.0, 2.5] {
            let across = ((1.0 - zenith * zenith) * (1.0 - there * there)).sqrt();
            let cosines = [zenith, there, zenith * there + across * azimuth.cos()];
            let shared = folded.source(&solved, (0, &place, reach), cosines, &weights);
            let own = solved.diffuse(&[(level, 1.0)], cosines, &scattering, &mut harmonics);
            for (shared, own) in shared.iter().zip(own) {
                assert!(*shared > 0.0 && (shared / own - 1.0).abs() < 1e-5, "{there} {azimuth}: {shared:e} {own:e}");
            }
        }
    }
}

#[test]
fn light_near_the_sun_is_scattered_in_the_peak_again() {
    // Paths with nothing cut off, 3 and 8 degrees from the sun, in a haze of optical depth 0.5 with g = 0.9, of which degree 12 leaves
    // g^13 = 0.25 to the peak: 4.5 standard errors and 0.4 % of the table. Peaks that scatter once alone are off by more.
    let top = 6e4;
    let haze = Component {
        density: exponential(2e3, top),
        scattering: [2.5e-4, 1.25e-4],
        absorption: [0.0; 2],
        phase: crate::phase::Phase::HenyeyGreenstein { g: [0.9; 2] },
    };
    let medium = medium(vec![haze], top);
    let solved = Solved::new(&medium, EARTH, [0.0; 2], &TEST).expect("round");
    let mut once = Solved::new(&medium, EARTH, [0.0; 2], &TEST).expect("round");
    Arc::get_mut(&mut once.optics).expect("one owner").aureole = Aureole::none();
    let (columns, from, sun) = (columns(&medium, EARTH), Place::above(2.0), towards(40.0, 0.0));
    let beam = SunDisc::beam(sun);
    let problem = Problem {
        texture: None,
        shape: EARTH,
        medium: &medium,
        columns: &columns,
        albedo: [0.0; 2],
        sun: Some(&beam),
        environment: None,
        max_orders: None,
    };
    for (zenith, least) in [(43.0, 8e-3), (48.0, 4e-3)] {
        let direction = towards(zenith, 0.0);
        let [found, once] = [&solved, &once].map(|table| table.radiance(from, direction, sun, false));
        let paths = estimate(Estimator::Paths, &problem, from, direction, 60_000, 5);
        for (j, (mean, error)) in paths.into_iter().enumerate() {
            let (off, allowed) = (found[j] / mean - 1.0, 4.5 * error / mean + 4e-3);
            assert!(off.abs() < allowed && allowed < 1e-2, "{zenith}: {off:e} of {allowed:e}");
            assert!(once[j] / mean - 1.0 > least, "{zenith}: {:e}", once[j] / mean - 1.0);
        }
    }
}
