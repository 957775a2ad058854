//! The readers, each with sound inputs to start from.

use super::Form;
use crate::root;
use renderer::film::exr;
use renderer::scene::Scene;
use std::path::Path;
use tables::{Table, TableError, file, views};
use tools::raw::{self, Source};

/// A reader.
pub struct Target {
    /// Its name in reports and on the command line.
    pub name: String,
    /// How its inputs are changed.
    pub form: Form,
    /// Whether the program has the whole file in memory all the time: then that counts too.
    pub held: bool,
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
        list.push(Target { name: name.into(), form, held, seeds, read });
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
    );
    let spheres = "id,x,m_re,m_im\n1,0.1,1.5,-0.01\n\"a,b\",1e3,1.33,0\n";
    add("mie cases", Form::Text, true, vec![spheres.into()], mie_cases);
    let scenes = ["clear-noon", "desert-dusk", "limb"].map(|name| file(&format!("scenes/{name}.json")));
    let full = Scene { width: Some(8), biome: Some(views::Biome::Urban), aod: Some(0.2), ..Scene::default() }
        .to_json()
        .into_bytes();
    add("scene", Form::Text, true, scenes.into_iter().chain([full.clone()]).collect(), scene);
    let picture =
        [b"\x76\x2f\x31\x01\x02\0\0\0compression\0compression\0\x01\0\0\0\x03", b"airlight.scene\0string\0".as_slice()];
    let length = (full.len() as u32).to_le_bytes();
    let picture = [picture.concat(), length.to_vec(), full, b"\0and pixels".to_vec()].concat();
    add("picture", Form::Binary, true, vec![picture], picture_scene);
    let cases = ["radiances", "renderers"].map(|name| file(&format!("tests/reference/{name}.json")));
    add("radiance cases", Form::Text, false, cases.into(), |bytes| {
        renderer::cases::parse(Path::new("input.json"), bytes).map(drop).map_err(|e| e.to_string())
    });
    list
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
