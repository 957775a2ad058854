//! The readers, each with sound inputs to start from.

use super::Form;
use crate::root;
use renderer::atmosphere::{Component, Medium};
use renderer::film::{Film, exr};
use renderer::geometry::Shape;
use renderer::phase::Phase;
use renderer::render::{Head, Part, Shard, State};
use renderer::scene::Scene;
use renderer::transport::{Resolution, Solved};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicU64, Ordering};
use tables::units::EARTH_RADIUS_M;
use tables::{Axis, Curve, Outside, Scale, Table, TableError, file, views};
use tools::mie_tasks::{Alike, Distributions};
use tools::own;
use tools::raw::{self, Source};

/// Bytes that a reader may take beside four times the file.
const FREE: usize = 1 << 20;

/// The same for what judges a file.
const JUDGED: usize = 1 << 26;

/// The same for what is read as a tree: the longest inputs are a quarter of a megabyte.
const TREE: usize = 1 << 24;

/// A reader.
pub struct Target {
    /// Its name in reports and on the command line.
    pub name: String,
    /// How its inputs are changed.
    pub form: Form,
    /// Whether the program has the whole file in memory all the time: then that counts too.
    pub held: bool,
    /// Bytes of memory that it may take beside four times the file.
    pub free: usize,
    /// Sound inputs.
    pub seeds: Vec<Vec<u8>>,
    /// Reads an input as the program does, and gives the sentence of a refusal.
    pub read: fn(&[u8]) -> Result<(), String>,
}

/// Every reader of files that users may change.
///
/// # Panics
/// If a file of the project that serves as a seed is not there.
#[must_use]
pub fn targets() -> Vec<Target> {
    let mut list = Vec::new();
    let file = |path: &str| std::fs::read(root().join(path)).expect("a file of the project");
    let mut add = |name: &str, form, held, seeds, read| {
        list.push(Target { name: name.into(), form, held, free: FREE, seeds, read });
    };
    macro_rules! view {
        ($view:ident: $($seed:literal),+) => {
            add(
                concat!("table ", stringify!($view)), Form::Table, false,
                vec![$(file(concat!("data/", $seed, ".table"))),+],
                |bytes| table(bytes, views::$view::from_table),
            );
        };
    }
    view!(StandardAtmosphere: "standard-atmosphere");
    view!(Rayleigh: "rayleigh");
    view!(OzoneCrossSection: "ozone-cross-section");
    view!(OzoneProfiles: "ozone-profiles");
    view!(OzoneLayers: "ozone-layers");
    view!(Sun: "sun");
    view!(Observer: "observer");
    view!(GroundAlbedo: "ground-albedo");
    view!(Aerosol: "aerosol-jaenicke-urban", "aerosol-jaenicke-polar-arctic", "aerosol-opac-background");
    add("table inspect", Form::Table, false, vec![file("data/ozone-layers.table"), file("data/sun.table")], |bytes| {
        table(bytes, |table| Ok(tools::inspect::describe(table)))
    });
    macro_rules! source {
        ($($path:literal: $module:ident::$row:ident),+ $(,)?) => {$(
            add(
                concat!("raw ", $path), Form::Text, true, vec![file(concat!("raw-data/", $path, ".csv"))],
                |bytes| Source::<raw::$module::$row>::parse("input.csv", bytes).map(drop).map_err(|e| e.to_string()),
            );
        )+};
    }
    source!(
        "us-standard-atmosphere-1976/layers": us_standard_atmosphere::Layer,
        "us-standard-atmosphere-1976/constants": us_standard_atmosphere::ConstantRow,
        "us-standard-atmosphere-1976/molar-mass": us_standard_atmosphere::MolarMass,
        "us-standard-atmosphere-1976/profile": us_standard_atmosphere::Level,
        "us-standard-atmosphere-1976/to-120km": us_standard_atmosphere::ExtensionLevel,
        "bucholtz-1995/king-factor": bucholtz::KingFactor,
        "bucholtz-1995/cross-section": bucholtz::CrossSection,
        "bucholtz-1995/fit": bucholtz::Fit,
        "ozone-arosa/monthly-column": ozone_arosa::MonthlyColumn,
        "ozone-arosa/layer-fractions": ozone_arosa::LayerFraction,
        "ozone-mcpeters-labow/mixing-ratio": ozone_mcpeters_labow::MixingRatio,
        "ozone-mcpeters-labow/column": ozone_mcpeters_labow::MonthlyColumns,
        "ozone-serdyuchenko-2014/cross-section": ozone_serdyuchenko::CrossSections,
        "ozone-thesis/cross-section": ozone_thesis::CrossSection,
        "sun/spectrum": sun::Irradiance,
        "sun/limb-darkening": sun::LimbDarkening,
        "cie-1931/colour-matching": cie_1931::ColourMatching,
        "ground-albedo/spectra": ground_albedo::Albedo,
        "aerosol-opac-1998/refractive-index": aerosol_opac::RefractiveIndex,
        "aerosol-opac-1998/components": aerosol_opac::Component,
        "aerosol-opac-1998/types": aerosol_opac::TypeShare,
        "aerosol-opac-1998/layers": aerosol_opac::Layer,
        "aerosol-opac-1998/optics": aerosol_opac::ComponentOptics,
        "aerosol-opac-1998/types-at-ground": aerosol_opac::TypeAtGround,
        "aerosol-jaenicke-1993/modes": aerosol_jaenicke::Mode,
        "aerosol-gavin-2020/biomes": aerosol_gavin::Biome,
        "aerosol-gavin-2020/cross-sections": aerosol_gavin::CrossSections,
        "mie-peers/speed": mie_peers::Speed,
    );
    macro_rules! own {
        ($($name:literal: $path:path, $seed:literal);+ $(;)?) => {$(
            add(concat!("own ", $name), Form::Text, true, vec![$seed.into()], |bytes| {
                <$path>::parse("input.csv", bytes, &[]).map(drop).map_err(|e| e.to_string())
            });
        )+};
    }
    own!(
        "modes": own::aerosol::Modes, "median_radius_um,sigma_g,number_density_cm3\n0.07,1.7,800\n0.6,2.0,1.5\n";
        "sizes": own::aerosol::Distribution, "radius_um,dn_dlogr_cm3\n0.05,1200\n0.3,60\n1,2\n5,0.01\n";
        "index": own::aerosol::Index, "wavelength_nm,n,k\n300,1.50,0.02\n550,1.48,0.01\n1000,1.46,0.015\n";
        "layer": own::aerosol::Vertical, "altitude_km,relative\n0,1\n1.5,0.8\n3,0.05\n";
        "albedo": own::albedo::Spectrum, "wavelength_nm,albedo_percent\n350,2\n550,10\n680,4\n800,45\n";
        "ozone": own::ozone::Sonde, "pressure_hpa,ozone_partial_pressure_mpa,temperature_c\n1005,4.1,14\n30,14.0,-52\n";
        "sun": own::sun::Spectrum, "wavelength_um,irradiance_w_m2_um\n0.3,500\n0.5,1900\n0.7,1400\n1.0,740\n";
    );
    let sounding = "altitude_m,pressure_hpa,temperature_c\n450,963.2,18.4\n1500,852.0,11.0\n5600,508.0,-14.5\n";
    add("own sounding", Form::Text, true, vec![sounding.into()], |bytes| {
        own::atmosphere::Sounding::parse("input.csv", bytes, &[], true).map(drop).map_err(|e| e.to_string())
    });
    let judged =
        ["aerosol-gavin-2020/biomes", "bucholtz-1995/king-factor"].map(|name| file(&format!("raw-data/{name}.csv")));
    add("lint csv", Form::Text, true, judged.into(), |bytes| {
        let text = std::str::from_utf8(bytes).map_err(|e| e.to_string())?;
        tools::lint::lint_csv("input.csv", text).map(drop).map_err(|e| e.to_string())
    });
    add("lint table", Form::Table, false, vec![file("data/ozone-layers.table"), file("data/sun.table")], |bytes| {
        table(bytes, |table| Ok(tools::lint::lint_table(table)))
    });
    add("inspect csv", Form::Text, true, vec![file("raw-data/bucholtz-1995/king-factor.csv")], |bytes| {
        tools::inspect::describe_csv("input.csv", bytes).map(drop).map_err(|e| e.to_string())
    });
    let chart = "# Errors\npanel,curve,size / MB,error\na,\"one, two\",1,1e-3\na,x,100,0.5\nb,x,2,3\n";
    add("chart", Form::Text, true, vec![chart.into()], |bytes| {
        tools::chart::parse("input.csv", bytes).map(drop).map_err(|e| e.to_string())
    });
    let spheres = "id,x,m_re,m_im\n1,0.1,1.5,-0.01\n\"a,b\",1e3,1.33,0\n";
    add("mie cases", Form::Text, true, vec![spheres.into()], mie_cases);
    let spheres = "x,m_re,m_im\n0.1,1.5,-0.01\n1e3,1.5,-0.01\n";
    add("mie spheres", Form::Text, true, vec![spheres.into()], |bytes| {
        Alike::parse(text(bytes)?).map(drop).map_err(|e| e.to_string())
    });
    let sizes =
        r#"{"angles_deg": [0, 90], "a": {"wavelengths": [0.5], "r": [0.1, 1], "w": [2, 1], "m_re": 1.5, "m_im": 0}}"#;
    add("mie distributions", Form::Text, true, vec![sizes.into()], |bytes| {
        Distributions::parse(text(bytes)?).map(drop).map_err(|e| e.to_string())
    });
    let scenes = ["clear-noon", "desert-dusk", "limb"].map(|name| file(&format!("scenes/{name}.json")));
    let full = Scene { width: Some(8), biome: Some(views::Biome::Urban), aod: Some(0.2), ..Scene::default() }
        .to_json()
        .into_bytes();
    add("scene", Form::Text, true, scenes.into_iter().chain([full.clone()]).collect(), scene);
    let toml = vec![file("scenes/sunset.toml"), Scene::default().to_toml(true).into_bytes()];
    add("scene in TOML", Form::Text, true, toml, |bytes| {
        Scene::from_toml(text(bytes)?).and_then(|scene| scene.validate()).map_err(|e| e.to_string())
    });
    add("scene of the thesis", Form::Text, true, vec![file("scenes/thesis.xml")], |bytes| {
        let imported = Scene::from_mitsuba(text(bytes)?, Path::new("no such folder"));
        imported.and_then(|imported| imported.scene.validate()).map_err(|e| e.to_string())
    });
    let picture =
        [b"\x76\x2f\x31\x01\x02\0\0\0compression\0compression\0\x01\0\0\0\x03", b"airlight.scene\0string\0".as_slice()];
    let length = (full.len() as u32).to_le_bytes();
    let picture = [picture.concat(), length.to_vec(), full, b"\0and pixels".to_vec()].concat();
    add("picture", Form::Binary, true, vec![picture], picture_scene);
    add("state", Form::Binary, true, vec![run_state()], state);
    add("kept solved table", Form::Table, false, vec![kept_table()], kept);
    let cases = ["radiances", "renderers"].map(|name| file(&format!("tests/reference/{name}.json")));
    add("radiance cases", Form::Text, false, cases.into(), |bytes| {
        renderer::cases::parse(Path::new("input.json"), bytes).map(drop).map_err(|e| e.to_string())
    });
    // It does not read a file into something that is kept, but judges up to some thousand rows at a time, and holds all
    // that it finds in them.
    for target in list.iter_mut().filter(|target| target.name == "lint csv") {
        target.free = JUDGED;
    }
    // A tree takes some fifty times its text: a node for every few bytes.
    for target in list.iter_mut().filter(|target| matches!(target.name, "scene of the thesis" | "scene in TOML")) {
        target.free = TREE;
    }
    list
}

/// Solves a small atmosphere, or takes its table from a folder.
fn solve(folder: &Path) -> Result<(), String> {
    let axis = Axis::uniform("altitude", "m", 0.0, 1e4, 7).map_err(|e| e.to_string())?;
    let density = axis.nodes.iter().map(|z| (-z / 8e3).exp()).collect();
    let density = Curve::new(axis.beyond(Outside::Zero), Scale::Logarithmic, density).map_err(|e| e.to_string())?;
    let air =
        Component { density, scattering: [1e-5; 4], absorption: [0.0; 4], phase: Phase::Rayleigh { gamma: [0.0; 4] } };
    let medium = Medium::new(vec![air], 6e4).map_err(|e| e.to_string())?;
    let grid = Resolution { levels: 4, suns: 5, zeniths: [2, 1, 2], parts: 1, degree: 2, change: 0.1 };
    let shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };
    Solved::kept(&medium, shape, [0.1; 4], &grid, Some(folder)).map(drop).map_err(|e| e.to_string())
}

/// A folder of one call.
fn folder() -> PathBuf {
    static COUNT: AtomicU64 = AtomicU64::new(0);
    let count = COUNT.fetch_add(1, Ordering::Relaxed);
    let folder = std::env::temp_dir().join(format!("airlight-kept-{}-{count}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// The name and the bytes of the table that [`solve`] keeps.
fn kept_file() -> &'static (OsString, Vec<u8>) {
    static FILE: OnceLock<(OsString, Vec<u8>)> = OnceLock::new();
    FILE.get_or_init(|| {
        let folder = folder();
        solve(&folder).expect("solved");
        let file = std::fs::read_dir(&folder).expect("a folder").next().expect("a file").expect("a file");
        let kept = (file.file_name(), std::fs::read(file.path()).expect("a file"));
        std::fs::remove_dir_all(folder).expect("removed");
        kept
    })
}

fn kept_table() -> Vec<u8> {
    kept_file().1.clone()
}

/// Reads a kept table as the renderer does: by the name that its inputs give it.
fn kept(bytes: &[u8]) -> Result<(), String> {
    let folder = folder();
    std::fs::write(folder.join(&kept_file().0), bytes).expect("written");
    let read = solve(&folder);
    std::fs::remove_dir_all(folder).expect("removed");
    read
}

/// Decodes a table and makes a view of it, as `renderer::data` does, which gives the file back before the view is made.
fn table<V>(bytes: &[u8], view: fn(&Table) -> Result<V, TableError>) -> Result<(), String> {
    let bytes = bytes.to_vec();
    let table = file::decode(&bytes).map_err(|e| e.to_string())?;
    drop(bytes);
    view(&table).map(drop).map_err(|e| e.to_string())
}

fn text(bytes: &[u8]) -> Result<&str, String> {
    std::str::from_utf8(bytes).map_err(|e| e.to_string())
}

fn mie_cases(bytes: &[u8]) -> Result<(), String> {
    let cases = tools::mie_cases::Cases::new(text(bytes)?).map_err(|e| e.to_string())?;
    for case in cases {
        case.map_err(|e| e.to_string())?;
    }
    Ok(())
}

fn scene(bytes: &[u8]) -> Result<(), String> {
    Scene::from_json(text(bytes)?).and_then(|scene| scene.validate()).map_err(|e| e.to_string())
}

fn picture_scene(bytes: &[u8]) -> Result<(), String> {
    let json = exr::text_attribute(bytes, "airlight.scene").map_err(|e| e.to_string())?;
    scene(json.ok_or("a picture that carries no scene")?.as_bytes())
}

/// A state as `airlight render --checkpoint` writes it, of a small picture.
fn run_state() -> Vec<u8> {
    let scene = Scene { width: Some(3), height: Some(2), biome: Some(views::Biome::Urban), ..Scene::default() };
    let mut film = Film::new(3, 2, vec![1.5; scene.channels()], scene.polarisation);
    for row in &mut film.rows_mut() {
        row.add(1, &vec![0.25; scene.channels()], [1.0, 2.0, 3.0]);
    }
    let parts = (1..=2).filter_map(|index| Shard::new(index, 2).ok()).map(|shard| Part { seed: 1, shard }).collect();
    Head { program: "airlight".into(), scene, tables: "sun.table 00c0ffee Sun".into(), parts }.encode(&film)
}

/// Decodes a state whose checksum is made right, for nothing behind it would be seen otherwise.
fn state(bytes: &[u8]) -> Result<(), String> {
    let mut bytes = bytes.to_vec();
    if let Some((head, rest)) = bytes.split_at_mut_checked(16) {
        head[12..].copy_from_slice(&crc32fast::hash(rest).to_le_bytes());
    }
    State::decode(&bytes).map(drop).map_err(|e| e.to_string())
}
