//! From a file of one's own to a picture: the renderer takes each kind of table as its own.

use airlight_tests::{Folder, data, root};
use renderer::atmosphere::OzoneSource;
use renderer::render::{Control, RenderError, Rendering, Sky, render};
use renderer::scene::{Albedo, Scene};
use renderer::spectrum::Wavelengths;
use std::sync::atomic::AtomicBool;
use tables::Kind;
use tools::own::aerosol::{Index, Modes, OwnAerosol, OwnProfile, OwnSizes};
use tools::own::{Import, aerosol, albedo, atmosphere, ozone, sun};
use tools::raw::RawData;

fn raw() -> RawData {
    RawData::from_dir(&root().join("raw-data")).expect("raw-data/ is sound")
}

/// A scene with this table, written to `folder`.
fn scene(folder: &Folder, made: &Import) -> Scene {
    let path = folder.path().join("own.table");
    made.write(&path).expect("written");
    Scene {
        width: Some(4),
        height: Some(4),
        spp: Some(16),
        wavelengths_nm: Wavelengths::new(vec![450.0, 550.0, 650.0]).expect("three"),
        tables: vec![path.to_str().expect("UTF-8").into()],
        ..Scene::default()
    }
}

fn picture(scene: &Scene) -> (Sky, Rendering) {
    let sky = Sky::new(scene, &data()).expect("a sky");
    let rendering = render(scene, &sky, Control { stop: &AtomicBool::new(false), observe: &|_| {} }).expect("finite");
    (sky, rendering)
}

/// Mean radiance of a pixel near the middle at each wavelength.
fn middle(scene: &Scene) -> Vec<f64> {
    let (_, rendering) = picture(scene);
    (0..3).map(|index| rendering.film.radiance(5, index).mean).collect()
}

fn without(scene: &Scene) -> Scene {
    Scene { tables: Vec::new(), ..scene.clone() }
}

#[test]
fn a_sun_of_twice_the_irradiance_makes_twice_the_radiance() {
    let (folder, raw) = (Folder::new("own-sun"), raw());
    let rows = raw.sun.spectrum.rows.iter().filter(|row| (300.0..=1000.0).contains(&row.wavelength_nm));
    let text: String = rows.map(|row| format!("{},{}\n", row.wavelength_nm, 2.0 * row.irradiance)).collect();
    let text = format!("wavelength_nm,irradiance_w_m2_nm\n{text}");
    let spectrum = sun::Spectrum::parse("twice.csv", text.as_bytes(), &[]).expect("a good spectrum");
    let scene = scene(&folder, &sun::table(&spectrum, &raw.sun).expect("a table"));
    for (own, ours) in middle(&scene).into_iter().zip(middle(&without(&scene))) {
        // The same paths; the committed table is in single precision.
        assert!((own / ours - 2.0).abs() < 1e-6, "{own} {ours}");
    }
    let (sky, _) = picture(&scene);
    let own: Vec<_> = sky.identities().iter().filter(|identity| identity.own).collect();
    assert_eq!(
        (own.len(), own[0].file.as_str(), own[0].title.as_str()),
        (1, "own.table", "Solar irradiance: twice.csv")
    );
    assert!(!sky.identities().iter().any(|identity| identity.file == "sun.table"), "the one it replaces is not used");
}

#[test]
fn every_kind_of_table_may_be_an_own_one() {
    let folder = Folder::new("own-kinds");
    let path = folder.path().join("own.table");
    for kind in Kind::ALL.into_iter().filter(|kind| *kind != Kind::GroundAlbedo) {
        std::fs::copy(root().join("data").join(kind.file_name()), &path).expect("copied");
        // The layers are taken by their own source alone.
        let arosa = kind == Kind::OzoneLayers;
        let ozone_source = if arosa { OzoneSource::Arosa } else { OzoneSource::McPetersLabow };
        let tables = vec![path.to_str().expect("UTF-8").to_owned()];
        let scene = Scene { ozone_source, tables, ..Scene::default() };
        let [own, ours] = [&scene, &without(&scene)].map(|scene| Sky::new(scene, &data()).expect("a sky"));
        assert_eq!(own.identities().iter().filter(|identity| identity.own && identity.kind == kind).count(), 1);
        assert_eq!(own.identities().len(), ours.identities().len(), "{kind} comes in place of another");
        let light = |sky: &Sky| sky.colour().xyz(&sky.direct_irradiance());
        assert_eq!(light(&own), light(&ours), "{kind}: the same numbers, the same sunlight");
        if !matches!(kind, Kind::OzoneProfiles | Kind::OzoneLayers) {
            continue;
        }
        let other = if arosa { OzoneSource::McPetersLabow } else { OzoneSource::Arosa };
        let error = Sky::new(&Scene { ozone_source: other, ..scene }, &data()).expect_err("not taken").to_string();
        assert!(error.contains("leave one out"), "{error}");
    }
}

#[test]
fn an_own_ground_is_found_by_its_name() {
    let folder = Folder::new("own-ground");
    let spectrum = albedo::Spectrum::parse("s.csv", b"wavelength_nm,albedo\n440,0.2\n660,0.2\n", &[]).expect("good");
    let named = Albedo::Ground("playa".into());
    let scene = Scene { albedo: named.clone(), ..scene(&folder, &albedo::table(&spectrum, "playa").expect("a table")) };
    let grey = Scene { albedo: Albedo::Grey(0.2), ..without(&scene) };
    assert_eq!(middle(&scene), middle(&grey), "the same reflectance, the same picture");
    let reaching = Scene { wavelengths_nm: Wavelengths::new(vec![400.0, 500.0]).expect("two"), ..scene.clone() };
    let error = Sky::new(&reaching, &data()).expect_err("beyond its wavelengths").to_string();
    assert!(error.contains("albedo playa") && error.contains("440 to 660 nm"), "{error}");
    let misspelt = Scene { albedo: Albedo::Ground("plaia".into()), ..scene };
    let error = Sky::new(&misspelt, &data()).expect_err("misspelt").to_string();
    assert!(error.contains("did you mean playa?"), "{error}");
    assert!(Sky::new(&Scene { albedo: named, ..grey }, &data()).is_err(), "without its table it is not known");
}

#[test]
fn an_own_ozone_profile_holds_everywhere() {
    let (folder, raw) = (Folder::new("own-ozone"), raw());
    let text = "altitude_km,ozone_partial_pressure_mpa\n0,3\n10,3\n20,14\n30,9\n";
    let sonde = ozone::Sonde::parse("sonde.csv", text.as_bytes(), &[]).expect("a good sonde");
    let completion = ozone::Completion { month: 2, latitude_deg: 60.0, geopotential: false, column_du: Some(411.0) };
    let scene = scene(&folder, &ozone::table(&sonde, &raw, completion).expect("a table"));
    let (sky, _) = picture(&scene);
    assert!(sky.any_place() && (sky.air().ozone_du() - 411.0).abs() < 1e-9, "{}", sky.air().ozone_du());
    let elsewhere = Scene { month: 10, latitude_deg: -85.0, ..scene.clone() };
    assert_eq!(middle(&scene), middle(&elsewhere));
    let (sky, _) = picture(&Scene { ozone_du: Some(100.0), ..scene });
    assert_eq!(sky.air().ozone_du(), 100.0);
}

#[test]
fn an_own_atmosphere_scatters_by_its_own_pressure() {
    let (folder, raw) = (Folder::new("own-air"), raw());
    // A plateau seen as sea level: 1 % less pressure at the same temperature is 1 % less air everywhere.
    let standard = data().standard_atmosphere;
    let rows: String = (0..=30)
        .map(|km| {
            let z = f64::from(km) * 1e3;
            let [p, t] = [&standard.pressure_pa, &standard.temperature_k].map(|curve| curve.at(z).expect("inside"));
            format!("{z},{},{t}\n", 0.99 * p)
        })
        .collect();
    let text = format!("altitude_m,pressure_pa,temperature_k\n{rows}");
    let sounding = atmosphere::Sounding::parse("low.csv", text.as_bytes(), &[], false).expect("a good sounding");
    let scene = scene(&folder, &atmosphere::table(&sounding, &raw.atmosphere).expect("a table"));
    let extinction = |scene: &Scene| picture(scene).0.air().ground_extinction().expect("inside");
    let ratio = extinction(&scene) / extinction(&without(&scene));
    // Two tables in single precision.
    assert!((ratio - 0.99).abs() < 1e-6, "{ratio}");
    assert!(middle(&scene).iter().zip(middle(&without(&scene))).all(|(own, ours)| *own != ours));
}

#[test]
fn an_own_aerosol_takes_the_place_of_a_biome() {
    let folder = Folder::new("own-aerosol");
    let own = OwnAerosol {
        name: "plume".into(),
        sizes: OwnSizes::Modes(
            Modes::parse("m.csv", b"median_radius_um,sigma_g,number_density_cm3\n0.1,1.6,500\n", &[]).expect("good"),
        ),
        indices: vec![(
            "ash".into(),
            Index::parse("i.csv", b"wavelength_nm,n,k\n300,1.5,0.01\n1000,1.5,0.01\n", &[]).expect("good"),
        )],
        profile: OwnProfile::Exponential { scale_height: 2000.0, top: 12_000.0 },
        number_density: None,
    };
    let made = aerosol::table(&own).expect("a table");
    let scene = scene(&folder, &made);
    let (sky, _) = picture(&scene);
    let haze = sky.air().haze().expect("haze");
    let expected =
        tables::views::Aerosol::from_table(&made.table).expect("a view").own_optical_depth().expect("550 nm");
    assert_eq!((haze.optical_depth(), haze.origin().to_string().as_str()), (expected, "plume (own)"));
    let (sky, _) = picture(&Scene { aod: Some(0.5), ..scene.clone() });
    assert!((sky.air().haze().expect("haze").optical_depth() - 0.5).abs() < 1e-12);
    let wet = Sky::new(&Scene { humidity_percent: Some(80.0), ..scene }, &data());
    assert!(
        matches!(&wet, Err(RenderError::Air(error)) if error.to_string().contains("plume (own) does not take up water"))
    );
}
