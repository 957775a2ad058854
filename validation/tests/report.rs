//! The committed report holds what its quick sections find, and its references are whole.

use airlight_validation::references::{Sheet, path};
use airlight_validation::{Context, Name, report};
use renderer::data::Data;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

#[test]
fn the_committed_report_is_what_its_quick_sections_find() {
    let root = root();
    let data = Data::load(&root.join("data")).expect("data/ is sound");
    let context = Context { root: &root, data: &data, quick: false, progress: &|_| {} };
    // Those that cost less than a second and do not show errors of rounding, which processors have in common only by kind;
    // `airlight-validate --check` has all.
    let all = report::sections(&context, &[Name::Opac, Name::Rayleigh], &|_| {}).expect("made");
    let page = std::fs::read_to_string(root.join("docs/validation.md")).expect("read");
    assert_eq!(report::missing(&page, &all), []);
    for (name, chart) in report::charts(&all) {
        let written = std::fs::read_to_string(root.join("plots").join(&name)).expect("read");
        assert!(written == chart.csv(), "plots/{name} is not what is found");
    }
}

#[test]
fn references_have_the_rows_that_their_readme_says() {
    for (file, rows, column) in [
        ("direct-beam.csv", 801, "direct_w_m2_nm"),
        ("sky-scans.csv", 11 * 81, "L550nm_W_m2_sr_nm"),
        ("twilight-zenith.csv", 5, "a0"),
    ] {
        let sheet = Sheet::read(&path(&root(), file)).expect("sound");
        assert_eq!(sheet.len(), rows, "{file}");
        assert!(sheet.column(column).expect("numbers").iter().all(|&x| x > 0.0), "{file}: {column}");
    }
}

#[test]
fn a_cell_that_is_no_number_is_named() {
    let path = std::env::temp_dir().join(format!("airlight-validation-{}.csv", std::process::id()));
    std::fs::write(&path, "# remark\na,b\n1,2\n3,x\n").expect("written");
    let sheet = Sheet::read(&path).expect("CSV");
    let [cell, column] = [sheet.number(1, "b"), sheet.number(0, "c")].map(|r| r.expect_err("no number").to_string());
    std::fs::remove_file(&path).expect("removed");
    assert!(cell.ends_with("row 2: b: expected a number, found x"), "{cell}");
    assert!(column.ends_with("row 1: no column c"), "{column}");
}
