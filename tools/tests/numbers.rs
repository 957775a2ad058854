//! `coefficients`, `export`, `inspect` and `sources` from outside: what they print, write and refuse.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The program in the folder of the project, where `data/` and `raw-data/` are.
fn program(arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_airlight-tools"));
    command.current_dir(root()).args(arguments);
    command
}

fn run(arguments: &[&str]) -> Output {
    program(arguments).output().expect("the program starts")
}

fn printed(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).expect("text")
}

fn refusal(arguments: &[&str]) -> String {
    let output = run(arguments);
    assert!(!output.status.success() && output.stdout.is_empty(), "{arguments:?} was taken");
    String::from_utf8(output.stderr).expect("text")
}

/// A path for a file of this test's own.
fn path(name: &str) -> String {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_file(&path);
    path.display().to_string()
}

#[test]
fn the_table_for_people_fits_in_a_terminal_and_names_its_sources() {
    let text = printed(&["coefficients", "--altitude", "0,5", "--wavelength", "400:700:100", "--biome", "urban"]);
    for expected in [
        "number density\n",
        "boundary_layer",
        "total",
        "rayleigh.table",
        "10.1364/AO.34.002765",
        "humidity of boundary_layer",
    ] {
        assert!(text.contains(expected), "{expected:?} is not in {text}");
    }
    let widest = text.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(120), "a line of {widest:?} characters");
}

#[test]
fn files_hold_what_is_printed_in_the_format_of_their_names() {
    let asked = ["coefficients", "--altitude", "0:2:1", "--species", "total", "--quantity", "coefficient"];
    let csv = printed(&[&asked[..], &["--format", "csv"]].concat());
    let (file, json) = (path("numbers.csv"), path("numbers.json"));
    assert!(printed(&[&asked[..], &["-o", &file]].concat()).is_empty());
    assert_eq!(std::fs::read_to_string(&file).expect("written"), csv);
    printed(&[&asked[..], &["-o", &json]].concat());
    let value: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(&json).expect("written")).expect("JSON");
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(csv.as_bytes());
    let column = reader.headers().expect("names").iter().position(|name| name == "extinction_coefficient_per_m");
    let rows: Vec<csv::StringRecord> = reader.records().collect::<Result<_, _>>().expect("rows");
    assert_eq!(rows.len(), 3);
    for (i, row) in rows.iter().enumerate() {
        let number: f64 = row[column.expect("there")].parse().expect("a number");
        assert_eq!(value["rows"][i]["extinction_coefficient_per_m"].as_f64(), Some(number));
    }
    // What the program writes it also reads.
    assert!(printed(&["inspect", &file]).contains("altitude_km"));
    if cfg!(feature = "parquet") {
        let parquet = path("numbers.parquet");
        printed(&[&asked[..], &["-o", &parquet]].concat());
        assert!(std::fs::read(&parquet).expect("written").starts_with(b"PAR1"));
    }
}

#[test]
fn exports_and_headers_are_json() {
    let table = "data/rayleigh.table";
    for arguments in
        [&["export", table, "--format", "json"][..], &["inspect", table, "--json"], &["sources", "--format", "json"]]
    {
        let value: serde_json::Value = serde_json::from_str(&printed(arguments)).expect("JSON");
        let checksum = value["tables"][0]["checksum"].as_str().expect("a checksum");
        assert_eq!(checksum.len(), 8, "{checksum}");
    }
    assert!(
        printed(&["export", table, "--bare"]).starts_with("wavelength_nm,cross_section_m2,king_factor,gamma\n300,")
    );
    assert!(printed(&["sources", "--format", "csv", "--raw-data", "raw-data"]).starts_with("file,title,citation,"));
}

#[test]
fn what_makes_no_sense_is_refused_in_one_sentence_and_leaves_no_file() {
    let file = path("refused.csv");
    for (arguments, expected) in [
        (&["coefficients", "--altitude", "130", "-o", &file][..], "error: altitude 130 km: 0 to 120 km is possible\n"),
        (
            &["coefficients", "--humidity", "50"],
            "error: --humidity says something of an aerosol: name its --biome too\n",
        ),
        (&["coefficients", "-o", "x.doc"], "error: x.doc: which format?"),
        (&["coefficients", "--format", "parquet"], "error: Parquet is not for reading: name a file with --output\n"),
        (&["coefficients", "--altitude", "0:80"], "\"0:80\" is no range: write LOW:HIGH:STEP, such as 0:80:1"),
        (&["export", "data/rayleigh.table", "--field", "x"], "error: data/rayleigh.table: no field is called \"x\""),
        (&["sources", "--data", "docs"], "error: docs: no table is there\n"),
        (&["inspect", "nowhere.csv"], "error: nowhere.csv: cannot be read"),
    ] {
        let found = refusal(arguments);
        assert!(found.contains(expected), "{arguments:?}: {found}");
    }
    assert!(!Path::new(&file).exists());
}

#[test]
fn a_reader_that_has_seen_enough_is_no_error() {
    // More than a pipe holds.
    for arguments in [&["coefficients", "--altitude", "0:120:0.1"][..], &["export", "data/ozone-profiles.table"]] {
        let mut child = program(arguments).stdout(Stdio::piped()).spawn().expect("the program starts");
        drop(child.stdout.take());
        assert!(child.wait().expect("it ends").success(), "{arguments:?}");
    }
}
