//! Runs of the program: scenes that cannot be are refused before any work, and a picture may be made in pieces.

use airlight_tests::{Folder, program, root};
use std::path::Path;
use std::process::{Command, Output};
use std::time::Duration;
use tables::file;

fn text(path: &Path) -> &str {
    path.to_str().expect("a path of ASCII")
}

/// `airlight` in the root of the project.
fn airlight(words: &[&str]) -> Command {
    let mut command = Command::new(program("airlight"));
    command.args(words).current_dir(root());
    command
}

fn output(words: &[&str]) -> Output {
    airlight(words).output().expect("runs")
}

fn done(words: &[&str]) {
    let output = output(words);
    assert!(output.status.success(), "{words:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// Copies `data/` but for one table, of which only 500 to 600 nm are kept.
fn narrowed(folder: &Folder, name: &str) {
    for entry in std::fs::read_dir(root().join("data")).expect("listed") {
        let path = entry.expect("entry").path();
        std::fs::copy(&path, folder.path().join(path.file_name().expect("a name"))).expect("copied");
    }
    let path = folder.path().join(name);
    let mut table = file::read(&path).expect("a table");
    let nodes = table.axis("wavelength").expect("there").nodes.clone();
    let kept = |index: &usize| (500.0..=600.0).contains(&nodes[*index]);
    let keep = |values: &[f64]| (0..nodes.len()).filter(kept).map(|i| values[i]).collect::<Vec<f64>>();
    for field in table.fields.iter_mut().filter(|field| field.axes == ["wavelength"]) {
        field.values = keep(&field.values);
    }
    for axis in table.axes.iter_mut().filter(|axis| axis.name == "wavelength") {
        axis.nodes = keep(&axis.nodes);
    }
    file::write(&path, &table).expect("written");
}

#[test]
fn what_cannot_be_is_one_sentence_before_any_work() {
    let folder = Folder::new("impossible");
    let (empty, short) = (folder.path().join("empty"), Folder::new("short"));
    std::fs::create_dir_all(&empty).expect("made");
    let (out, state) = (folder.path().join("sky.exr"), folder.path().join("a.state"));
    narrowed(&short, "rayleigh.table");
    std::fs::write(&state, "no state").expect("written");
    // So many samples that a refusal after the work would take hours.
    let refused = |flags: &str, cause: &str| {
        let words = ["render", "--spp", "1000000", "-o", text(&out)];
        let output = output(&words.into_iter().chain(flags.split_whitespace()).collect::<Vec<_>>());
        let sentence = String::from_utf8_lossy(&output.stderr);
        assert!(sentence.contains(cause) && !output.status.success(), "{flags}: {sentence}");
        assert!(sentence.starts_with("airlight: ") && sentence.lines().count() == 1, "{flags}: {sentence}");
        assert!(!out.exists(), "{flags}");
    };
    refused("--altitude=-1", "0 to 1000000 km");
    refused("--albedo 1.1", "albedo is 1.1; 0 to 1");
    refused("--width 0", "width is 0");
    refused("--block 3", "power of two");
    // 977 blocks.
    refused("--shard 1001/1001 --block 1024", "shard 1001/1001 would be empty");
    refused(&format!("--data {}", text(&empty)), "no table");
    refused(&format!("--data {}", text(short.path())), "rayleigh.table: wavelength 380 is outside the table's range");
    refused(&format!("--resume {}", text(&state)), "not the state of a run");
    refused(&format!("--checkpoint {}/x/y", text(&empty)), "no such folder");
    refused("--checkpoint a.exr", "not of the state");
}

#[cfg(unix)]
#[test]
fn a_run_stopped_by_ctrl_c_goes_on_to_the_same_bytes() {
    let folder = Folder::new("interrupted");
    let at = |name: &str| folder.path().join(name);
    let (whole, stopped, state) = (at("whole.exr"), at("stopped.exr"), at("run.state"));
    let scene = ["render", "--quiet", "--width", "24", "--height", "24", "--wavelengths", "4", "--spp", "64"];
    let with = |more: &[&str]| [scene.as_slice(), more].concat().into_iter().map(str::to_owned).collect::<Vec<_>>();
    let words = |list: &[String]| airlight(&list.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(words(&with(&["-o", text(&whole)])).status().expect("runs").success());
    let made = with(&["-o", text(&stopped), "--checkpoint", text(&state)]);
    // Longer until it is late enough for the program to heed it.
    let mut wait = Duration::from_millis(100);
    while !state.exists() {
        let mut run = words(&made).stderr(std::process::Stdio::null()).spawn().expect("starts");
        std::thread::sleep(wait);
        let _ = Command::new("kill").args(["-INT", &run.id().to_string()]).status().expect("kill runs");
        run.wait().expect("ended");
        wait *= 2;
    }
    done(&["render", "--quiet", "--resume", text(&state), "-o", text(&stopped)]);
    for end in ["exr", "png"] {
        let [a, b] = [&whole, &stopped].map(|path| std::fs::read(path.with_extension(end)).expect("there"));
        assert!(a == b, "the {end} files differ");
    }
}

#[test]
fn shards_merge_in_any_order_and_nothing_is_merged_twice() {
    let folder = Folder::new("shards");
    let at = |name: &str| folder.path().join(name);
    let names = ["1.exr", "2.exr", "3.exr"].map(at);
    for (path, shard) in names.iter().zip(["1/3", "2/3", "3/3"]) {
        let size = ["--width", "8", "--height", "8", "--wavelengths", "3", "--spp", "12", "--quiet"];
        done(&[["render", "--shard", shard, "-o", text(path)].as_slice(), size.as_slice()].concat());
    }
    let [a, b, c] = names.each_ref().map(|path| text(path));
    let (one, other) = (at("one.exr"), at("other.exr"));
    done(&["merge", a, b, c, "-o", text(&one), "--quiet"]);
    done(&["merge", c, a, b, "-o", text(&other), "--quiet"]);
    assert!(std::fs::read(one).expect("there") == std::fs::read(&other).expect("there"));
    let twice = output(&["merge", a, b, a, "-o", text(&other)]);
    assert!(String::from_utf8_lossy(&twice.stderr).contains("samples in common"));
    assert_eq!(twice.status.code(), Some(2));
}
