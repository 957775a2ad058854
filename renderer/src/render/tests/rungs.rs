//! Pictures by the cheaper methods, and scenes with parts of the model left out.

use super::*;
use crate::atmosphere::Depolarisation;
use crate::scene::SunShape;
use crate::spectrum::Scheme;
use crate::transport::rungs::LADDER;
use glam::DVec3;
use tables::views::Biome;

fn data() -> Data {
    Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables")
}

/// A hazy afternoon that every method covers.
fn covered(method: Method) -> Scene {
    Scene { biome: Some(Biome::RemoteContinental), aod: Some(0.2), method, spp: Some(1), ..small() }
}

#[test]
fn every_method_renders_what_it_covers_alike() {
    // Mean luminances of the dome within a factor of 1.6 of the paths' (of solved tables other tests know): all orders add a third or so.
    let mean = |method| {
        let scene = Scene { spp: Some(8), ..covered(method) };
        let rendering = render(&scene, &sky(&scene), RUN).expect("finite");
        let (width, height) = rendering.film.size();
        (0..(width * height) as usize).map(|pixel| rendering.film.luminance(pixel).mean).sum::<f64>()
    };
    let exact = mean(Method::Paths);
    for rung in LADDER.iter().filter(|rung| rung.method != Method::Solved) {
        let share = mean(rung.method) / exact;
        assert!((0.5..1.6).contains(&share), "{}: {share}", rung.name);
    }
}

#[test]
fn methods_refuse_scenes_outside_their_ranges() {
    let data = data();
    let refusal = |scene: Scene| Sky::new(&scene, &data).expect_err("refused").to_string();
    // Clean air has turbidity 1.
    assert!(refusal(Scene { method: Method::Preetham, ..small() }).contains("turbidities from 2 to 6"));
    assert!(Sky::new(&Scene { method: Method::HosekWilkie, ..small() }, &data).is_ok());
    let low = |method| Scene { sun_elevation_deg: -2.0, ..covered(method) };
    for method in [Method::Oneil, Method::HosekWilkie, Method::Preetham, Method::Perez, Method::Cie] {
        assert!(refusal(low(method)).contains("degrees of elevation, not at -2"), "{method:?}");
        let high = Scene { altitude_km: 12.0, ..covered(method) };
        assert!(refusal(high).contains("on the ground"), "{method:?}");
    }
    assert!(refusal(Scene { flat: true, ..covered(Method::Solved) }).contains("round planet"));
}

#[test]
fn a_fitted_sky_has_the_sun_of_the_air_and_no_noise() {
    let scene = covered(Method::Perez);
    let fitted = sky(&scene);
    let exact = sky(&covered(Method::Single));
    assert!(fitted.is_noiseless() && fitted.wavelengths() == 3 && fitted.table_error().is_none());
    let lux = |sky: &Sky| sky.colour().xyz(&sky.direct_irradiance())[1];
    // The same factors, by way of XYZ.
    assert!((lux(&fitted) / lux(&exact) - 1.0).abs() < 1e-9);
    let mut seen = [[0.0; 3]; 2];
    assert!(fitted.add_disc(fitted.sun_direction(), 1.0, &mut seen[0]));
    assert!(exact.add_disc(exact.sun_direction(), 1.0, &mut seen[1]));
    assert!((seen[0][1] / exact.colour().xyz(&seen[1])[1] - 1.0).abs() < 1e-9);
}

/// Radiance factors at the zenith, by paths without noise where orders are one: single scattering is by quadrature.
fn zenith(scene: &Scene) -> Vec<f64> {
    let sky = sky(scene);
    let mut factors = vec![0.0; sky.wavelengths()];
    sky.radiance(DVec3::Z, &crate::sampling::Sampler::new(1, 0, 0), &mut factors);
    factors
}

#[test]
fn parts_of_the_model_can_be_left_out() {
    let base = || Scene { method: Method::Single, steps: Some(256), ..small() };
    let ratio = |scene: Scene, lane: usize| zenith(&scene)[lane] / zenith(&base())[lane];
    // With F_k = 1.0491 and so gamma = 0.01445 at 550 nm, c = 0.5 at the zenith with the sun at 30 degrees, spheres scatter
    // (1 + c^2)(1 + 2 gamma) / (F_k ((1 + 3 gamma) + (1 - gamma) c^2)) = 0.9505 of what air does, and the optical depth, lower by 0.0046, lets
    // through 1.5 times that more.
    let without = ratio(Scene { depolarisation: Depolarisation::None, ..base() }, 1);
    assert!((without - 0.957).abs() < 2e-3, "{without}");
    // A plane: the sun at 30 degrees shines through sec z instead of Chapman's function, 2.000 for 1.994: 6e-4 of the transmitted light's exponent.
    let flat = ratio(Scene { flat: true, ..base() }, 1);
    assert!(flat < 1.0 && flat > 0.998, "{flat}");
    // A point instead of the disc changes single scattering at the zenith by the disc's size squared.
    let point = ratio(Scene { sun_shape: SunShape::Point, ..base() }, 1);
    assert!((point - 1.0).abs() < 1e-4, "{point}");
    // One order of paths is single scattering and the ground straight to the eye: none at the zenith. Quantiles at random leave noise.
    let once = sky(&Scene { method: Method::Paths, orders: Some(1), ..small() });
    let paths = |sample| {
        let mut factors = vec![0.0; once.wavelengths()];
        once.radiance(DVec3::Z, &crate::sampling::Sampler::sobol(1, 0, 0, sample), &mut factors);
        factors[1]
    };
    let mean = (0..256).map(paths).sum::<f64>() / 256.0;
    assert!((mean / zenith(&base())[1] - 1.0).abs() < 5e-3, "{mean}");
}

#[test]
fn few_wavelengths_go_with_any_method_that_has_a_spectrum() {
    let luminance = |colour: Scheme, method| {
        let wavelengths_nm = Wavelengths::default();
        let scene = Scene { colour, wavelengths_nm, ..covered(method) };
        let sky = sky(&scene);
        let mut factors = vec![0.0; sky.wavelengths()];
        sky.radiance(DVec3::Z, &crate::sampling::Sampler::new(1, 0, 0), &mut factors);
        (factors.len(), sky.colour().xyz(&factors)[1])
    };
    for method in [Method::Single, Method::Isotropic] {
        let (_, exact) = luminance(Scheme::Spectral, method);
        for (scheme, count) in [(Scheme::Rgb, 3), (Scheme::Four, 4)] {
            let (wavelengths, found) = luminance(scheme, method);
            assert!(wavelengths == count && (0.8..1.4).contains(&(found / exact)), "{scheme:?}: {}", found / exact);
        }
    }
}
