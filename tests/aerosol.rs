//! The aerosols of the tables, through the renderer's eyes, are in the amount that is asked for.

use airlight_tests::data;
use glam::DVec3;
use renderer::atmosphere::{
    Air, AirError, AirSettings, Amount, Depolarisation, Haze, HazePhase, HazeSettings, KOSCHMIEDER, OzoneSource,
};
use renderer::geometry::{Place, Shape};
use tables::units::EARTH_RADIUS_M;
use tables::views::{AerosolSource, Biome};

const EARTH: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

fn air() -> Air {
    let settings = AirSettings {
        month: 6,
        latitude_deg: 45.0,
        ozone_source: OzoneSource::McPetersLabow,
        ozone_du: Some(0.0),
        top_m: 120_000.0,
        depolarisation: Depolarisation::Measured,
    };
    Air::new(&data(), &settings).expect("air")
}

fn hazy(source: AerosolSource, biome: Biome, amount: Amount, humidity_percent: Option<f64>) -> Result<Air, AirError> {
    let (aerosol, _) = data().aerosol(source, biome).expect("a table for every biome and source");
    let clean = air();
    let settings = HazeSettings { humidity_percent, amount, phase: HazePhase::Mie };
    let haze = Haze::new(aerosol, settings, clean.ground_extinction()?)?;
    Ok(clean.with_haze(Some(haze)))
}

/// Vertical optical depth at 550 nm.
fn depth(air: &Air) -> f64 {
    air.medium(&[550.0]).expect("medium").optical_depth(EARTH, Place::above(0.0), DVec3::Z)[0]
}

#[test]
fn every_biome_of_both_sources_has_its_own_optical_depth_in_the_air() {
    for source in AerosolSource::ALL {
        for biome in Biome::ALL {
            let air_with = hazy(source, biome, Amount::Own, None).expect("hazy air");
            let stated = air_with.haze().expect("haze").optical_depth();
            let found = depth(&air_with) - depth(&air());
            // Quadrature along the vertical against the closed form of each profile: 1e-8 of the whole depth.
            assert!((found - stated).abs() < 1e-7 * (1.0 + stated), "{biome} after {source}: {found} for {stated}");
        }
    }
}

#[test]
fn every_biome_of_both_sources_knows_what_it_does_to_polarisation() {
    // Between the tables' wavelengths and humidities too. Whether a matrix is one of spheres is asked where it is read.
    for source in AerosolSource::ALL {
        for biome in Biome::ALL {
            let air = hazy(source, biome, Amount::Own, None).expect("hazy air");
            let medium = air.medium(&[312.0, 550.0, 987.0]).expect("a matrix of spheres");
            assert!(medium.polarises(), "{biome} after {source}");
        }
    }
}

#[test]
fn optical_depth_and_turbidity_scale_the_amount() {
    let own = hazy(AerosolSource::Opac, Biome::Urban, Amount::Own, None).expect("hazy");
    let own = own.haze().expect("haze").optical_depth();
    for (amount, expected) in [(Amount::OpticalDepth(0.3), 0.3), (Amount::Turbidity(2.5), 2.5 * own)] {
        let found = depth(&hazy(AerosolSource::Opac, Biome::Urban, amount, None).expect("hazy")) - depth(&air());
        assert!((found - expected).abs() < 1e-6, "{amount:?}: {found} for {expected}");
    }
}

#[test]
fn visibility_is_koschmieders_of_the_extinction_at_the_ground() {
    for km in [2.0, 23.0, 100.0] {
        let air = hazy(AerosolSource::Opac, Biome::Rural, Amount::VisibilityKm(km), None).expect("hazy");
        let [extinction] = air.medium(&[550.0]).expect("medium").extinction(0, 0.0);
        let found = KOSCHMIEDER / extinction / 1000.0;
        assert!((found / km - 1.0).abs() < 1e-6, "{found} km for {km}");
        assert!((air.haze().expect("haze").visibility_km() / km - 1.0).abs() < 1e-12);
    }
    let refused = hazy(AerosolSource::Opac, Biome::Rural, Amount::VisibilityKm(390.0), None);
    assert!(matches!(refused, Err(AirError::TooClear { .. })), "molecules alone end the view at some 340 km");
}

#[test]
fn humidity_swells_what_takes_up_water_and_is_refused_for_what_does_not() {
    let at = |percent| {
        let air = hazy(AerosolSource::Opac, Biome::MaritimeClean, Amount::Own, Some(percent)).expect("hazy");
        air.haze().expect("haze").optical_depth()
    };
    assert!(at(50.0) < at(80.0) && at(80.0) < at(95.0), "{} {} {}", at(50.0), at(80.0), at(95.0));
    let dry = hazy(AerosolSource::Jaenicke, Biome::Urban, Amount::Own, Some(80.0));
    assert!(matches!(dry, Err(AirError::Dry { .. })));
}
