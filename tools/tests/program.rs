//! The program from outside: files, exit codes, sentences.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tables::{Kind, views};

fn raw_dir() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../raw-data")
}

/// An empty folder of this test's own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder for the test");
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// Runs the program; a build is one of everything but the aerosols, which take long, unless it says which.
fn run(arguments: &[&str], raw: &Path, data: &Path) -> Output {
    let names: Vec<String> = Kind::ALL.into_iter().map(Kind::file_name).collect();
    let only = arguments.first() == Some(&"build") && !arguments.contains(&"--only");
    let only = names.iter().filter(|_| only).flat_map(|name| ["--only", name]);
    Command::new(env!("CARGO_BIN_EXE_airlight-tools"))
        .args(arguments)
        .args(only)
        .arg("--raw-data")
        .arg(raw)
        .arg("--data")
        .arg(data)
        .output()
        .expect("the program starts")
}

fn words(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_build_is_clean_repeatable_and_its_damage_is_found() {
    let folder = Folder::new("build");
    let data = folder.0.join("data");
    let first = run(&["build"], &raw_dir(), &data);
    assert!(first.status.success(), "{}", words(&first));
    assert!(words(&first).contains(&format!("{} tables", Kind::ALL.len())), "{}", words(&first));
    let bytes = |kind: Kind| std::fs::read(data.join(kind.file_name())).expect("the table is there");
    let before: Vec<Vec<u8>> = Kind::ALL.into_iter().map(bytes).collect();

    let second = run(&["build", "--quiet"], &raw_dir(), &data);
    assert!(second.status.success() && second.stderr.is_empty(), "{}", words(&second));
    let after: Vec<Vec<u8>> = Kind::ALL.into_iter().map(bytes).collect();
    assert!(before == after, "a second build gave other bytes");

    let clean = run(&["build", "--check"], &raw_dir(), &data);
    assert!(clean.status.success(), "{}", words(&clean));

    // A value that is off by 1 %, a table that is missing, a damaged one, a file of nobody.
    let path = data.join(Kind::Rayleigh.file_name());
    let mut table = tables::file::read(&path).expect("sound");
    table.fields[0].values[250] *= 1.01;
    tables::file::write(&path, &table).expect("written");
    std::fs::remove_file(data.join(Kind::Sun.file_name())).expect("removed");
    let mut damaged = bytes(Kind::Observer);
    damaged[200] ^= 1;
    std::fs::write(data.join(Kind::Observer.file_name()), damaged).expect("written");
    std::fs::write(data.join("stray.txt"), "x").expect("written");
    let dirty = run(&["build", "--check"], &raw_dir(), &data);
    let found = words(&dirty);
    assert_eq!(dirty.status.code(), Some(1), "{found}");
    for expected in [
        "cross_section: 1 of 701 values beyond their tolerance, most at wavelength 550 nm",
        "the file is missing",
        "damaged: the header has CRC-32",
        "stray.txt",
    ] {
        assert!(found.contains(expected), "{expected:?} is not in {found}");
    }
    let last = found.lines().last().unwrap_or_default();
    assert!(last.starts_with("error: ") && last.contains("rayleigh.table, sun.table, observer.table"), "{last}");
}

#[test]
fn a_bad_input_gives_one_sentence_and_no_table() {
    let folder = Folder::new("bad-input");
    let (raw, data) = (folder.0.join("raw-data"), folder.0.join("data"));
    for source in std::fs::read_dir(raw_dir()).expect("raw-data/").flatten().filter(|e| e.path().is_dir()) {
        let to = raw.join(source.file_name());
        std::fs::create_dir_all(&to).expect("made");
        for file in std::fs::read_dir(source.path()).expect("listed").flatten() {
            std::fs::copy(file.path(), to.join(file.file_name())).expect("copied");
        }
    }
    let king = raw.join("bucholtz-1995/king-factor.csv");
    let text = std::fs::read_to_string(&king).expect("read");
    std::fs::write(&king, text.replace("550,1.049", "550,10.49")).expect("written");
    let output = run(&["build"], &raw, &data);
    assert_eq!(output.status.code(), Some(1));
    let expected = "error: raw data bucholtz-1995/king-factor.csv, line 38, column \"king_factor\": expected 1 to 1.2, found 10.49\n";
    assert_eq!(words(&output), expected);
    assert!(!data.exists(), "a failed build left a folder");

    let output = run(&["build"], &folder.0.join("nowhere"), &data);
    assert_eq!(output.status.code(), Some(1));
    assert!(words(&output).starts_with("error: raw data us-standard-atmosphere-1976/"), "{}", words(&output));
}

#[test]
fn tables_answer_through_their_views() {
    let folder = Folder::new("views");
    let output = run(&["build", "--quiet"], &raw_dir(), &folder.0);
    assert!(output.status.success(), "{}", words(&output));
    let read = |kind: Kind| tables::file::read(&folder.0.join(kind.file_name())).expect("sound");

    let rayleigh = views::Rayleigh::from_table(&read(Kind::Rayleigh)).expect("view");
    let sigma = rayleigh.cross_section_m2.at(550.0).expect("inside");
    // Bucholtz' table 2 has 4.509e-31 m^2, four digits.
    assert!((sigma / 4.509e-31 - 1.0).abs() < 4e-4, "{sigma}");

    let air = views::StandardAtmosphere::from_table(&read(Kind::StandardAtmosphere)).expect("view");
    let density = air.number_density_m3.at(86_000.0).expect("inside");
    // COESA 1976: 1.447e20 m^-3 at 86 km.
    assert!((density / 1.447e20 - 1.0).abs() < 4e-4, "{density}");

    // The trapezoidal sum is the integral of the linear interpolation; single precision rounds each
    // value by 6e-8.
    let ozone = views::OzoneProfiles::from_table(&read(Kind::OzoneProfiles)).expect("view");
    for month in 1..=12 {
        for latitude in [-85.0, -5.0, 45.0, 47.0, 85.0] {
            let profile = ozone.profile(month, latitude).expect("a month");
            let curve = &profile.number_density_m3;
            let column = tools::profile::ozone::trapezoidal(&curve.axis().nodes, curve.values());
            let relative = column / (profile.column_du * tables::units::DOBSON_UNIT_M2) - 1.0;
            assert!(relative.abs() < 1e-6, "month {month}, latitude {latitude}: {relative}");
        }
    }
    let hole = ozone.profile(10, -85.0).expect("October").column_du;
    assert!((hole - 152.0).abs() < 1.0, "the October ozone hole has about 152 DU: {hole}");

    let layers = views::OzoneLayers::from_table(&read(Kind::OzoneLayers)).expect("view");
    let april = layers.profile(4).expect("April").number_density_m3;
    // 384 DU x 111/210 over 9 km.
    let expected = 384.0 * tables::units::DOBSON_UNIT_M2 * 111.0 / 210.0 / 9000.0;
    let found = april.at(20_000.0).expect("inside");
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} against {expected}");
    assert_eq!(april.at(60_000.0).expect("zero outside"), 0.0);

    let cross_section = views::OzoneCrossSection::from_table(&read(Kind::OzoneCrossSection)).expect("view");
    // Serdyuchenko et al. 2014 at 600 nm and 293 K: 5.1e-25 m^2, the top of the Chappuis band.
    let found = cross_section.cross_section_m2(600.0, 293.0).expect("inside");
    assert!((4.9e-25..5.3e-25).contains(&found), "{found}");

    let sun = views::Sun::from_table(&read(Kind::Sun)).expect("view");
    let sum: f64 = sun.limb_coefficients(550.0).expect("inside").iter().sum();
    // Two rows of six coefficients with five decimals.
    assert!((sum - 1.0).abs() < 2.1e-5, "{sum}");
    let observer = views::Observer::from_table(&read(Kind::Observer)).expect("view");
    assert_eq!(observer.matching[1].at(300.0).expect("zero outside"), 0.0);
    let ground = views::GroundAlbedo::from_table(&read(Kind::GroundAlbedo)).expect("view");
    assert_eq!(ground.spectra.keys().map(String::as_str).collect::<Vec<_>>(), ["dry-soil", "ocean", "wet-soil"]);
}

#[test]
fn inspect_shows_a_table_and_refuses_what_is_none() {
    let folder = Folder::new("inspect");
    assert!(run(&["build", "--quiet"], &raw_dir(), &folder.0).status.success());
    let inspect = |file: &Path| {
        Command::new(env!("CARGO_BIN_EXE_airlight-tools"))
            .arg("inspect")
            .arg(file)
            .output()
            .expect("the program starts")
    };
    let shown = inspect(&folder.0.join(Kind::Rayleigh.file_name()));
    let text = String::from_utf8_lossy(&shown.stdout).into_owned();
    assert!(shown.status.success() && text.starts_with("rayleigh: "), "{text}");
    for expected in
        ["300 to 1000 nm", "cross_section", "raw-data/bucholtz-1995/king-factor.csv", "10.1364/AO.34.002765"]
    {
        assert!(text.contains(expected), "{expected:?} is not in {text}");
    }
    let shown = inspect(&raw_dir().join("bucholtz-1995/king-factor.csv"));
    let text = String::from_utf8_lossy(&shown.stdout).into_owned();
    for expected in ["10.1364/AO.34.002765", "36 rows", "wavelength_nm", "200.000 to 1000.00 nm"] {
        assert!(shown.status.success() && text.contains(expected), "{expected:?} is not in {text}");
    }
    let refused = inspect(&raw_dir().join("README.md"));
    assert_eq!(refused.status.code(), Some(1));
    assert!(words(&refused).contains("not an Airlight table"), "{}", words(&refused));
}

#[test]
fn an_aerosol_is_built_checked_and_read_back() {
    let folder = Folder::new("aerosol");
    let only = ["build", "--only", "aerosol-jaenicke-rural"];
    let built = run(&only, &raw_dir(), &folder.0);
    assert!(built.status.success() && words(&built).contains("1 tables"), "{}", words(&built));
    let name = views::Aerosol::file_name(views::AerosolSource::Jaenicke, views::Biome::Rural);
    let table = tables::file::read(&folder.0.join(&name)).expect("sound");
    let aerosol = views::Aerosol::from_table(&table).expect("view");
    // 0.03961 km^-1 of the log-normals, and the background of 2 in 8787 cm^-3.
    let ground = aerosol.ground_extinction(None, 550.0).expect("inside");
    assert!((ground / (0.03961e-3 * (1.0 + 2.0 / 8787.0)) - 1.0).abs() < 2e-3, "{ground}");
    let checked = run(&[&only[..], &["--check"]].concat(), &raw_dir(), &folder.0);
    assert!(checked.status.success() && words(&checked).contains("as rebuilt"), "{}", words(&checked));
    let none = run(&["build", "--only", "nothing"], &raw_dir(), &folder.0);
    assert!(words(&none).contains("no table is called nothing"), "{}", words(&none));
}
