//! Frames beside single pictures.

use super::*;
use crate::scene::CameraKind;
use crate::spectrum::Wavelengths;
use std::path::Path;

static NEVER: AtomicBool = AtomicBool::new(false);

#[test]
fn frames_of_one_solution_are_the_pictures_of_their_scenes() {
    let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
    let scene = Scene {
        camera: CameraKind::Pinhole,
        width: Some(12),
        height: Some(10),
        wavelengths_nm: Wavelengths::new(vec![450.0, 550.0, 650.0]).expect("valid"),
        ..Scene::default()
    };
    let course = Course::Tracks(vec!["sun_elevation_deg=20:4".parse().expect("a track")]);
    let frames = course.frames(&scene, 4).expect("valid");
    let mut sequence = Sequence::prepare(frames, &data, None, &NEVER, &|_| {}).expect("solved").expect("not stopped");
    assert_eq!(sequence.solved, 1, "by day the usual grid states less than 1 %");
    let film =
        |scene: &Scene, sky: &Sky| render(scene, sky, Control { stop: &NEVER, observe: &|_| {} }).expect("finite").film;
    for index in [0, 3] {
        let frame = sequence.frames[index].clone();
        sequence.sky.turn(&frame).expect("within the tables");
        let alone = Sky::new(&frame, &data).expect("a sky");
        assert_eq!(film(&frame, &sequence.sky), film(&frame, &alone), "frame {index}");
    }
    let exposures: Vec<f64> = sequence.frames.iter().map(|frame| frame.exposure_ev.expect("exposed")).collect();
    assert!(exposures.windows(2).all(|pair| pair[0] > pair[1]), "the sun goes down: {exposures:?}");
}
