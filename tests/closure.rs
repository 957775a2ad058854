//! The committed tables, through the renderer's eyes, add up to published numbers.

use airlight_tests::data;
use glam::DVec3;
use renderer::atmosphere::{Air, AirSettings, Depolarisation, OzoneSource};
use renderer::geometry::{Place, Shape};
use tables::units::{DOBSON_UNIT_M2, EARTH_RADIUS_M};

const EARTH: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

fn settings() -> AirSettings {
    AirSettings {
        month: 6,
        latitude_deg: 45.0,
        ozone_source: OzoneSource::McPetersLabow,
        ozone_du: None,
        top_m: 120_000.0,
        depolarisation: Depolarisation::Measured,
    }
}

#[test]
fn rayleigh_optical_depth_to_86_km_is_bucholtz_own() {
    // Bucholtz 1995, table 5, US Standard Atmosphere 1976 at 550 nm: 0.0971 to three digits.
    let air = Air::new(&data(), &AirSettings { top_m: 86_000.0, ozone_du: Some(0.0), ..settings() }).expect("air");
    let medium = air.medium(&[550.0]).expect("medium");
    let [tau] = medium.optical_depth(EARTH, Place::above(0.0), DVec3::Z);
    assert!((tau - 0.0971).abs() < 5e-5, "Rayleigh optical depth {tau} at 550 nm");
}

#[test]
fn ozone_in_the_medium_is_the_column_that_is_asked_for() {
    // Single precision in the table and linear interpolation of both factors: 1e-5.
    for (month, ozone_source, ozone_du) in [
        (6, OzoneSource::McPetersLabow, None),
        (10, OzoneSource::McPetersLabow, Some(220.0)),
        (4, OzoneSource::Arosa, None),
        (4, OzoneSource::Arosa, Some(500.0)),
    ] {
        let air = Air::new(&data(), &AirSettings { month, ozone_source, ozone_du, ..settings() }).expect("air");
        let medium = air.medium(&[600.0]).expect("medium");
        let columns = medium.columns(EARTH, Place::above(0.0), DVec3::Z).expect("upwards");
        let du = columns[1] / DOBSON_UNIT_M2;
        assert!((du / air.ozone_du() - 1.0).abs() < 1e-5, "{du} DU for {}", air.ozone_du());
        if let Some(asked) = ozone_du {
            assert!((air.ozone_du() - asked).abs() < 1e-12, "{} DU for {asked}", air.ozone_du());
        }
    }
}

#[test]
fn arosa_in_april_has_384_dobson_units() {
    // Duetsch 1974. (The tables that this project corrects acted as 4025 DU.)
    let air =
        Air::new(&data(), &AirSettings { month: 4, ozone_source: OzoneSource::Arosa, ..settings() }).expect("air");
    assert_eq!(air.ozone_du(), 384.0);
}

#[test]
fn ozone_dims_the_overhead_sun_by_the_published_depth_in_the_chappuis_band() {
    // 300 DU = 8.06e22 m^-2 times 5.0e-25 to 5.2e-25 m^2 (600 nm; Serdyuchenko et al. 2014) is 0.040 to 0.042.
    let air = Air::new(&data(), &AirSettings { ozone_du: Some(300.0), ..settings() }).expect("air");
    let with = air.medium(&[600.0]).expect("medium").optical_depth(EARTH, Place::above(0.0), DVec3::Z)[0];
    let air = Air::new(&data(), &AirSettings { ozone_du: Some(0.0), ..settings() }).expect("air");
    let without = air.medium(&[600.0]).expect("medium").optical_depth(EARTH, Place::above(0.0), DVec3::Z)[0];
    let depth = with - without;
    assert!((0.040..0.042).contains(&depth), "ozone optical depth {depth} at 600 nm");
}
