//! Other programs read what is written here: tables, by the example in Python.

use std::path::{Path, PathBuf};
use std::process::Command;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

#[test]
#[expect(clippy::print_stdout, reason = "a test says what it could not do")]
fn the_example_in_python_reads_every_table() {
    if Command::new("python3").arg("--version").output().is_err() {
        println!("no python3 here: nothing was read");
        return;
    }
    let mut read = 0;
    for entry in std::fs::read_dir(root().join("data")).expect("a folder") {
        let path = entry.expect("an entry").path();
        let example = root().join("tests/python/read_table.py");
        let output = Command::new("python3").arg(example).arg(&path).output().expect("python3 runs");
        assert!(output.status.success(), "{}: {}", path.display(), String::from_utf8_lossy(&output.stderr));
        let table = tables::file::read(&path).expect("a table");
        let axes = table.axes.iter().map(|axis| (axis.name.as_str(), axis.nodes.clone()));
        let fields = table.fields.iter().map(|field| (field.name.as_str(), field.values.clone()));
        let expected: Vec<(&str, Vec<f64>)> = axes.chain(fields).collect();
        let text = String::from_utf8(output.stdout).expect("text");
        assert_eq!(text.lines().count(), expected.len(), "{}", path.display());
        for (line, (name, values)) in text.lines().zip(expected) {
            let words: Vec<&str> = line.split('\t').collect();
            let sum: f64 = words[3].parse().expect("a number");
            assert_eq!((words[0], words[2].parse()), (name, Ok(values.len())));
            // Both add doubles in order; newer Pythons compensate the rounding of their sums.
            let size: f64 = values.iter().map(|value| value.abs()).sum();
            assert!((sum - values.iter().sum::<f64>()).abs() <= 1e-12 * size, "{}: {line}", path.display());
        }
        read += 1;
    }
    assert_eq!(read, 26);
}
