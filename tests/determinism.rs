//! Equal scenes give equal bytes, on one thread and on many.

use airlight_tests::data;
use renderer::render::{Control, Sky, render};
use renderer::scene::Scene;
use renderer::transport::Method;
use std::sync::atomic::AtomicBool;

/// Bit patterns of every mean and standard error of a small picture.
fn bits(threads: usize, scene: &Scene) -> Vec<u64> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    pool.install(|| {
        let sky = Sky::new(scene, &data()).expect("a valid scene");
        let stop = AtomicBool::new(false);
        let film = render(scene, &sky, Control { stop: &stop, observe: &|_| {} }).expect("a picture").film;
        let (width, height) = film.size();
        (0..(width * height) as usize)
            .flat_map(|pixel| (0..film.wavelengths()).map(move |k| (pixel, k)))
            .flat_map(|(pixel, k)| {
                let estimate = film.radiance(pixel, k);
                [estimate.mean.to_bits(), estimate.error.to_bits()]
            })
            .collect()
    })
}

#[test]
fn one_thread_and_many_give_the_same_bits() {
    for method in [Method::Judge, Method::Paths] {
        let scene = Scene { width: Some(16), height: Some(12), spp: Some(6), method, ..Scene::default() };
        let alone = bits(1, &scene);
        for threads in [2, 5] {
            assert!(alone == bits(threads, &scene), "{method:?} differs with {threads} threads");
        }
    }
}

#[test]
fn another_seed_gives_another_picture() {
    let scene = Scene { width: Some(8), height: Some(8), spp: Some(2), ..Scene::default() };
    assert!(bits(2, &scene) != bits(2, &Scene { seed: 1, ..scene.clone() }));
}
