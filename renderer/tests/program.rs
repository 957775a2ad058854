//! The program from outside: what it does when nobody takes what it says.

use renderer::film::exr;
use renderer::render::receipt::RECEIPT;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// One sample of a small picture, whose numbers go to `out`.
fn sample(out: Stdio, err: Stdio) -> Output {
    Command::new(env!("CARGO_BIN_EXE_airlight"))
        .args(["render", "--width", "8", "--height", "8", "--pixel", "4,4", "-o"])
        .arg(Path::new(env!("CARGO_TARGET_TMPDIR")).join("sky.exr"))
        .current_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join(".."))
        .stdout(out)
        .stderr(err)
        .output()
        .expect("the program starts")
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_standard_output_is_one_sentence() {
    let full = || std::fs::File::options().write(true).open("/dev/full").expect("a device");
    let output = sample(full().into(), Stdio::piped());
    let words = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{words}");
    assert_eq!(words, "airlight: standard output: cannot be written: No space left on device (os error 28)\n");
    // Where standard error is full too, the exit code is all there is.
    assert_eq!(sample(full().into(), full().into()).status.code(), Some(1));
}

#[cfg(unix)]
#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    let (reader, writer) = std::io::pipe().expect("a pipe");
    drop(reader);
    let output = sample(writer.into(), Stdio::piped());
    let words = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && words.is_empty(), "{words}");
}

/// A folder of its own for one test, made with these files and no others.
fn folder(name: &str, files: &[(&str, &str)]) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    for (name, text) in files {
        std::fs::write(folder.join(name), text).expect("written");
    }
    folder
}

/// `airlight` with these words in a folder.
fn airlight(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_airlight")).args(words).current_dir(folder).output().expect("the program starts")
}

/// A picture of 4 x 4 pixels by single scattering at one wavelength, and more words.
fn small<'a>(words: &[&'a str]) -> Vec<&'a str> {
    let small = ["render", "--width", "4", "--height", "4", "--method", "single", "--steps", "2", "--wavelengths", "1"];
    [small.as_slice(), words].concat()
}

#[test]
fn a_receipt_takes_the_place_of_no_other_file() {
    let folder = folder("scene", &[("scene.json", "{\"month\": 3}")]);
    let output = airlight(&folder, &["render", "scene.json", "-o", "scene.exr"]);
    let sentence = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{sentence}");
    assert!(sentence.contains("scene.json") && sentence.contains("--no-receipt"), "{sentence}");
    assert_eq!(sentence.lines().count(), 1, "{sentence}");
}

#[test]
fn tables_are_found_from_any_folder() {
    // Single scattering of rural aerosol: every kind of table.
    let scene = r#"{"method": "single", "biome": "rural", "wavelengths_nm": [550]}"#;
    let folder = folder("anywhere", &[("scene.json", scene)]);
    let output = airlight(&folder, &["scene", "check", "scene.json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output = airlight(&folder, &["scene", "check", "scene.json", "--data", "."]);
    let sentence = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && sentence.contains("leave --data out"), "{sentence}");
}

#[test]
fn the_receipt_beside_a_picture_is_that_inside_with_files_and_time_last() {
    let folder = folder("receipt", &[]);
    let output = airlight(&folder, &small(&["--json"]));
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert_eq!(output.stdout, std::fs::read(folder.join("sky.json")).expect("a receipt"));
    let mut beside: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let picture = std::fs::read(folder.join("sky.exr")).expect("a picture");
    let inside = exr::text_attribute(&picture, RECEIPT).expect("an EXR file").expect("a receipt");
    let keys = beside.as_object_mut().expect("an object");
    let last: Vec<String> = keys.keys().rev().take(2).cloned().collect();
    assert_eq!(last, ["time", "files"]);
    keys.retain(|key, _| key != "time" && key != "files");
    assert_eq!(beside, serde_json::from_str::<Value>(inside).expect("JSON"));
}

#[test]
fn pictures_that_differ_by_more_than_is_asked_exit_with_one() {
    let folder = folder("compared", &[("none.exr", "no picture")]);
    for (name, sun) in [("a.exr", "30"), ("b.exr", "40")] {
        assert!(airlight(&folder, &small(&["--quiet", "--sun-elevation", sun, "-o", name])).status.success());
    }
    let code = |b: &str| airlight(&folder, &["compare", "a.exr", b, "--within", "1%"]).status.code();
    assert_eq!([code("a.exr"), code("b.exr"), code("none.exr")], [Some(0), Some(1), Some(2)]);
}

#[test]
fn programs_that_only_judge_are_silent_if_they_are_asked_to_be() {
    let scenes = [("fine.toml", "width = 8\nheight = 8\n"), ("dark.toml", "sun_elevation_deg = -40.0\n")];
    let folder = folder("judges", &scenes);
    for (words, findings) in [
        (["doctor", "fine.toml", "--quiet"], false),
        (["doctor", "dark.toml", "--quiet"], true),
        (["sweep", "--paths=2000", "--quiet"], false),
    ] {
        let output = airlight(&folder, &words);
        let said = String::from_utf8_lossy(&output.stdout);
        assert!(output.status.success() && output.stderr.is_empty(), "{words:?}: {said}");
        assert!(said.is_empty() != findings && !said.contains("seen  "), "{words:?}: {said}");
    }
}
