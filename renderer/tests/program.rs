//! The program from outside: what it does when nobody takes what it says.

use std::path::Path;
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

/// `airlight` with these words in a folder of its own, which is made empty; the tables are those of the project.
fn airlight(folder: &str, files: &[(&str, &str)], words: &[&str]) -> Output {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    for (name, text) in files {
        std::fs::write(folder.join(name), text).expect("written");
    }
    Command::new(env!("CARGO_BIN_EXE_airlight")).args(words).current_dir(folder).output().expect("the program starts")
}

#[test]
fn a_receipt_takes_the_place_of_no_other_file() {
    let words = ["render", "scene.json", "-o", "scene.exr"];
    let output = airlight("receipt", &[("scene.json", "{\"month\": 3}")], &words);
    let sentence = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{sentence}");
    assert!(sentence.contains("scene.json") && sentence.contains("--no-receipt"), "{sentence}");
    assert_eq!(sentence.lines().count(), 1, "{sentence}");
}

#[test]
fn tables_are_found_from_any_folder() {
    // Single scattering of rural aerosol: every kind of table.
    let scene = r#"{"method": "single", "biome": "rural", "wavelengths_nm": [550]}"#;
    let output = airlight("anywhere", &[("scene.json", scene)], &["scene", "check", "scene.json"]);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let output = airlight("elsewhere", &[("scene.json", scene)], &["scene", "check", "scene.json", "--data", "."]);
    let sentence = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(1) && sentence.contains("leave --data out"), "{sentence}");
}
