//! Own tables from outside: pictures made with them, made again, and refused.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn data() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../data").canonicalize().expect("data/")
}

/// An empty folder of this test's own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(path.join("own")).expect("a folder for the test");
        std::fs::create_dir_all(path.join("out")).expect("a folder for the test");
        Self(path)
    }

    /// Copies a table of `data/` to `own/`.
    fn take(&self, from: &str, to: &str) {
        std::fs::copy(data().join(from), self.0.join("own").join(to)).expect("copied");
    }

    fn render(&self, arguments: &str) -> Output {
        // From space, where the sky overhead, which the closing lines tell of, is black at once.
        let small = ["--width", "4", "--height", "4", "--spp", "2", "--wavelengths", "450,550", "--altitude", "400"];
        let scene = arguments.split_whitespace().next().is_some_and(|word| word.contains('.'));
        Command::new(env!("CARGO_BIN_EXE_airlight"))
            .arg("render")
            .args(arguments.split_whitespace())
            .args(small.iter().filter(|_| !scene))
            .arg("--data")
            .arg(data())
            .current_dir(&self.0)
            .output()
            .expect("the program starts")
    }

    fn read(&self, name: &str) -> Vec<u8> {
        std::fs::read(self.0.join(name)).expect("a file")
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

fn said(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn refusal(output: &Output, code: i32) -> String {
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(code), "{words}");
    words
}

#[test]
fn a_picture_of_own_tables_is_made_again_while_they_are_the_same() {
    let folder = Folder::new("own-again");
    folder.take("aerosol-jaenicke-urban.table", "my haze.table");
    folder.take("sun.table", "star.table");
    std::fs::rename(folder.0.join("own/my haze.table"), folder.0.join("own/haze.table")).expect("renamed");
    let words = said(&folder.render("--table own/haze.table --table ./own/star.table --aod 0.2 -o out/a.exr"));
    for expected in
        ["own table   haze.table ", "own table   star.table ", "aerosol     urban (jaenicke), optical depth 0.200"]
    {
        assert!(words.contains(expected), "{expected:?} is not in {words}");
    }
    // From the current folder, and from another where the tables lie beside the picture.
    said(&folder.render("out/a.exr -o out/b.exr"));
    assert!(folder.read("out/a.exr") == folder.read("out/b.exr"), "the second picture is another");
    for name in ["haze.table", "star.table"] {
        std::fs::rename(folder.0.join("own").join(name), folder.0.join("out").join(name)).expect("moved");
    }
    said(&folder.render("out/a.exr -o out/c.exr --quiet"));
    // Another table of the same name.
    std::fs::copy(data().join("aerosol-jaenicke-rural.table"), folder.0.join("out/haze.table")).expect("copied");
    let words = refusal(&folder.render("out/a.exr -o out/d.exr"), 1);
    assert!(words.contains("its own table own/haze.table had the checksum ") && words.contains("--table"), "{words}");
    std::fs::remove_file(folder.0.join("out/haze.table")).expect("removed");
    let words = refusal(&folder.render("out/a.exr -o out/d.exr"), 1);
    assert!(words.contains("own/haze.table is neither in the current folder nor beside it"), "{words}");
    // Whoever names tables anew has the word.
    said(&folder.render("out/a.exr --table out/star.table --biome rural -o out/d.exr --quiet"));
    assert!(!folder.0.join("out/d.exr.tmp").exists() && folder.0.join("out/d.exr").exists());
}

#[test]
fn a_picture_holds_no_folder_outside_and_is_the_same_from_each() {
    let folder = Folder::new("own-portable");
    folder.take("sun.table", "star.table");
    let absolute = folder.0.join("own/star.table");
    let absolute = absolute.to_str().expect("UTF-8");
    said(&folder.render(&format!("--table {absolute} -o out/a.exr --quiet")));
    let bytes = folder.read("out/a.exr");
    let holds = |text: &str| bytes.windows(text.len()).any(|window| window == text.as_bytes());
    assert!(holds("\"tables\":[\"star.table\"]") && !holds(folder.0.to_str().expect("UTF-8")));
    std::fs::copy(absolute, folder.0.join("star.table")).expect("copied");
    said(&folder.render("--table star.table -o out/b.exr --quiet"));
    assert!(bytes == folder.read("out/b.exr"), "the folder of a table shows in the picture");
}

#[test]
fn own_tables_that_do_not_go_together_are_refused() {
    let folder = Folder::new("own-refused");
    for (from, to) in [
        ("sun.table", "a.table"),
        ("sun.table", "b.table"),
        ("aerosol-opac-rural.table", "haze.table"),
        ("ozone-profiles.table", "ozone.table"),
        ("ground-albedo.table", "ground.table"),
    ] {
        folder.take(from, to);
    }
    for (arguments, code, expected) in [
        (
            "--table own/a.table --table own/b.table",
            1,
            "a.table and own/b.table are both of the kind sun: a picture takes one",
        ),
        (
            "--table own/haze.table --biome urban",
            2,
            "haze.table is an aerosol, and so is the biome urban: leave one out",
        ),
        ("--table own/a.table --aod 0.2", 2, "aod says something of an aerosol: name its biome too"),
        ("--table own/haze.table --aerosol-source opac", 2, "aerosol-source says something of an aerosol"),
        (
            "--table own/ozone.table --ozone-source arosa",
            2,
            "ozone.table is ozone of the kind ozone-profiles, but the ozone source arosa",
        ),
        (
            "--table own/ground.table",
            1,
            "own/ground.table: there is a ground called \"dry-soil\" already: give it another name",
        ),
        ("--table own/none.table", 1, "own/none.table: cannot be read"),
    ] {
        let words = refusal(&folder.render(&format!("{arguments} -o out/x.exr")), code);
        assert!(words.contains(expected), "{arguments}: {words}");
    }
    std::fs::write(folder.0.join("own/text.table"), "wavelength_nm,albedo\n").expect("written");
    let words = refusal(&folder.render("--table own/text.table -o out/x.exr"), 1);
    assert!(words.contains("own/text.table: not an Airlight table"), "{words}");
    assert!(!folder.0.join("out/x.exr").exists());
}
