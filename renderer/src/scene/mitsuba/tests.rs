use super::*;
use crate::camera::direction_at;

/// A camera 3 m above the north pole that looks up, top of the picture towards -x; the sun towards +x, `elevation` degrees high.
fn file(elevation: f64, more: &str) -> String {
    let (sin, cos) = elevation.to_radians().sin_cos();
    let far = ASTRONOMICAL_UNIT_M / KM;
    let (x, z) = (far * cos, far * sin + 6356.769);
    format!(
        r#"<scene version="2.2.1">
  <default name="n" value="32"/> <!-- a comment -->
  <integrator type="volpath"><integer name="max_depth" value="128"/></integrator>
  <sensor type="fisheye">
    <transform name="to_world">
      <rotate z="1" angle="90"/>
      <translate z="6356.769"/>
    </transform>
    <float name="aperture" value="170"/>
    <sampler type="independent"><integer name="sample_count" value="$n"/></sampler>
    <film type="hdrfilm"><integer name="width" value="200"/><integer name="height" value="100"/></film>
  </sensor>
  <shape type="sphere">
    <float name="radius" value="696340"/>
    <point name="center" x="{x}" y="0" z="{z}"/>
    <emitter type="area"><spectrum name="radiance" value="770000"/></emitter>
  </shape>
  <medium type="atmosphere" id="air">
    <float name="earth_radius" value="6356.766"/>
    <string name="molecular_phase_function" value="rayleigh"/>
    <string name="aerosol_model" value="PolarArticAerosol"/>
    <float name="turbidity" value="2"/>
    <integer name="month" value="11"/>
    {more}
  </medium>
  <shape type="sphere">
    <float name="radius" value="6356.766"/>
    <bsdf type="diffuse"><rgb name="reflectance" value="0.3, 0.3, 0.3"/></bsdf>
  </shape>
  <shape type="sphere">
    <float name="radius" value="6442.766"/>
    <bsdf type="null"/>
    <ref id="air" name="interior"/>
  </shape>
</scene>
"#
    )
}

fn import(text: &str) -> Result<Imported, SceneError> {
    Scene::from_mitsuba(text, Path::new("."))
}

#[test]
fn a_scene_of_the_thesis_is_the_picture_that_it_describes() {
    let Imported { scene, notes } = import(&file(12.0, "")).expect("a scene");
    scene.validate().expect("possible");
    let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
    assert!(near(scene.sun_elevation_deg, 12.0) && near(scene.altitude_km, 0.003), "{scene:?}");
    assert!(near(scene.top_km, 86.0) && near(scene.fov_deg.unwrap_or_default(), 170.0));
    assert_eq!((scene.month, scene.biome, scene.turbidity), (11, Some(Biome::PolarArctic), Some(2.0)));
    assert_eq!((scene.size(), scene.albedo.clone()), ((200, 100), Albedo::Grey(0.3)));
    assert_eq!((scene.camera, scene.depolarisation), (CameraKind::Fisheye, Depolarisation::None));
    assert_eq!((scene.method, scene.sun_distance_au), (Method::Solved, 1.0));
    // The local y, which is up in pictures, is turned from y to -x, away from the sun: north on top.
    let up = scene.camera().direction(100.0, 20.0).expect("in the circle");
    assert!(up.dot(direction_at(0.0, 0.0)) > 0.5 && up.dot(scene.sun_direction()) < 0.0, "{up}");
    for word in ["32 samples", "128", "770000", "turbidity of 2", "6371"] {
        assert!(notes.iter().any(|note| note.contains(word)), "{word}: {notes:#?}");
    }
}

#[test]
fn a_view_along_the_horizon_keeps_its_side() {
    // From the same place towards +y, the sun towards +x: with the sun in the south a look to its left as seen from above, which is east.
    let sensor = r#"<sensor type="perspective">
    <transform name="to_world"><lookat origin="0, 0, 6356.769" target="0, 10, 6356.769" up="0, 0, 1"/></transform>
    <float name="fov" value="50"/><string name="fov_axis" value="y"/>
    <film type="hdrfilm"><integer name="width" value="200"/><integer name="height" value="100"/></film>
  </sensor>"#;
    let text = file(12.0, "");
    let (start, end) = (text.find("<sensor").expect("one"), text.find("</sensor>").expect("one") + 9);
    let text = format!("{}{sensor}{}", &text[..start], &text[end..]);
    let scene = import(&text).expect("a scene").scene;
    // +x south and z up make +y east.
    assert!((scene.view_azimuth_deg.unwrap_or_default() - 90.0).abs() < 1e-6, "{:?}", scene.view_azimuth_deg);
    assert!(scene.view_elevation_deg.unwrap_or(9.0).abs() < 1e-6);
    // tan of half the width's angle is twice that of the height's.
    let wide = 2.0 * (2.0 * 25.0_f64.to_radians().tan()).atan().to_degrees();
    assert!((scene.fov_deg.unwrap_or_default() - wide).abs() < 1e-6);
}

#[test]
fn the_file_may_be_in_any_unit() {
    let kilometres = import(&file(30.0, "")).expect("a scene").scene;
    // All lengths ten times as large.
    let mut text = file(30.0, "");
    let mut tenfold = String::new();
    for (i, part) in text.split('"').enumerate() {
        let number =
            part.parse::<f64>().ok().filter(|number| i % 2 == 1 && number.abs() > 1000.0 && *number != 770_000.0);
        tenfold.push_str(&number.map_or_else(|| part.to_owned(), |number| (10.0 * number).to_string()));
        tenfold.push('"');
    }
    text = tenfold.trim_end_matches('"').to_owned();
    let other = import(&text).expect("a scene").scene;
    assert!((other.altitude_km - kilometres.altitude_km).abs() < 1e-6, "{}", other.altitude_km);
    assert!((other.sun_elevation_deg - 30.0).abs() < 1e-6 && (other.top_km - 86.0).abs() < 1e-6);
}

#[test]
fn what_is_not_of_the_dialect_is_told_with_its_line() {
    let text = file(12.0, "");
    for (from, to, line, part) in [
        ("PolarArticAerosol", "PolarArcticAerosol", 21, "PolarArticAerosol"),
        ("name=\"month\"", "name=\"mont\"", 23, "mont"),
        ("type=\"volpath\"", "type=\"path\"", 3, "volpath"),
        ("$n", "$m", 10, "no default"),
        ("value=\"170\"", "value=\"wide\"", 9, "a number is needed"),
        ("<integrator", "<camera/><integrator", 3, "camera"),
        ("version=\"2.2.1\"", "version=\"3.0.0\"", 1, "2.x"),
        ("rotate z=\"1\"", "rotate", 6, "axis"),
        ("</scene>", "", 36, ""),
        ("type=\"hdrfilm\"", "type=\"ldrfilm\"", 11, "hdrfilm"),
        ("value=\"11\"", "value=\"13\"", 18, "month is 13"),
    ] {
        let broken = text.replacen(from, to, 1);
        assert_ne!(broken, text, "{from}");
        match import(&broken) {
            Err(SceneError::File { line: found, what }) => {
                assert!(found == line || from == "</scene>", "{from}: line {found}: {what}");
                assert!(what.contains(part), "{from}: {what}");
            }
            other => panic!("{from}: {other:?}"),
        }
    }
}

#[test]
fn a_file_may_include_another() {
    let folder = std::env::temp_dir().join(format!("airlight-include-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let text = file(12.0, "");
    let (start, end) = (text.find("<medium").expect("one"), text.find("</medium>").expect("one") + 9);
    let inner = format!("<scene version=\"2.0.0\"><default name=\"n\" value=\"1\"/>{}</scene>", &text[start..end]);
    std::fs::write(folder.join("air.xml"), inner).expect("written");
    let outer = format!("{}<include filename=\"air.xml\"/>{}", &text[..start], &text[end..]);
    let found = Scene::from_mitsuba(&outer, &folder);
    let missing = Scene::from_mitsuba(&outer.replace("air.xml", "none.xml"), &folder);
    std::fs::remove_dir_all(&folder).expect("removed");
    assert_eq!(found.expect("a scene"), import(&text).expect("a scene"));
    assert!(missing.is_err_and(|error| error.to_string().contains("none.xml")));
}
