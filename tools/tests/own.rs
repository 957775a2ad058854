//! People's own inputs: what is ours comes back as it was, and what is wrong is refused with its place.
#![allow(clippy::print_stdout, reason = "the figures found: cargo test -- --nocapture shows them")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;
use tables::units::DOBSON_UNIT_M2;
use tables::{Kind, Table, views};
use tools::aerosol::recipe::{Part, opac_species};
use tools::own::aerosol::{Distribution, Index, Modes, OwnAerosol, OwnProfile, OwnSizes, Vertical};
use tools::own::atmosphere::{Completed, Sounding};
use tools::own::ozone::{Completion, Sonde};
use tools::own::{Import, aerosol, albedo, atmosphere, ozone, sun};
use tools::profile::ozone::trapezoidal;
use tools::profile::standard_atmosphere::StandardAtmosphere;
use tools::raw::RawData;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

static RAW: LazyLock<RawData> =
    LazyLock::new(|| RawData::from_dir(&root().join("raw-data")).expect("raw-data/ is sound"));

fn ours(kind: Kind) -> Table {
    tools::build::table(&RAW, kind).expect("a table of raw-data/")
}

/// A CSV file of some columns.
fn csv<const N: usize>(header: &str, rows: impl IntoIterator<Item = [f64; N]>) -> String {
    let line = |row: [f64; N]| row.map(|x| x.to_string()).join(",");
    std::iter::once(header.to_owned()).chain(rows.into_iter().map(line)).collect::<Vec<_>>().join("\n")
}

fn sounding(text: &str) -> Sounding {
    Sounding::parse("sonde.csv", text.as_bytes(), &[], false).expect("a good sounding")
}

fn air(made: &Import) -> views::StandardAtmosphere {
    views::StandardAtmosphere::from_table(&made.table).expect("a view")
}

/// Rayleigh optical depth at 550 nm of all air.
fn rayleigh_depth(air: &views::StandardAtmosphere) -> f64 {
    let sigma = views::Rayleigh::from_table(&ours(Kind::Rayleigh)).expect("a view").cross_section_m2;
    let n = &air.number_density_m3;
    // Exact for a density whose logarithm is linear.
    let cells = n.axis().nodes.windows(2).zip(n.values().windows(2));
    let column: f64 = cells.map(|(z, n)| (z[1] - z[0]) * (n[1] - n[0]) / (n[1] / n[0]).ln()).sum();
    sigma.at(550.0).expect("inside") * column
}

#[test]
fn the_standard_atmosphere_as_a_radiosonde_to_30_km_comes_back() {
    let ours = views::StandardAtmosphere::from_table(&ours(Kind::StandardAtmosphere)).expect("a view");
    let nodes = &ours.temperature_k.axis().nodes;
    let values = |z: f64| [&ours.pressure_pa, &ours.temperature_k].map(|curve| curve.at(z).expect("inside"));
    let rows = nodes.iter().filter(|z| **z <= 30_000.0).map(|&z| [z, values(z)[0], values(z)[1]]);
    let made = atmosphere::table(&sounding(&csv("altitude_m,pressure_pa,temperature_k", rows)), &RAW.atmosphere)
        .expect("a table");
    let own = air(&made);
    let mut largest = 0.0_f64;
    for z in nodes {
        for (a, b) in [
            (&own.temperature_k, &ours.temperature_k),
            (&own.pressure_pa, &ours.pressure_pa),
            (&own.number_density_m3, &ours.number_density_m3),
        ] {
            largest = largest.max((a.at(*z).expect("inside") / b.at(*z).expect("inside") - 1.0).abs());
        }
    }
    let (depth, expected) = (rayleigh_depth(&own), rayleigh_depth(&ours));
    println!("sounding of the standard atmosphere: T, p, N within {largest:.1e}, optical depth {depth} for {expected}");
    // Levels are kept as they are, and beyond them nothing departs from the standard: last bits of ln and exp.
    assert!(largest < 1e-12, "{largest}");
    assert!((depth / expected - 1.0).abs() < 1e-12, "{depth} for {expected}");
}

#[test]
fn the_published_profile_in_steps_of_a_kilometre_comes_back_nearly() {
    let levels = &RAW.atmosphere.profile.rows;
    let rows = levels.iter().filter(|l| l.altitude <= 30_000.0);
    let rows = rows.map(|l| [l.altitude / 1e3, l.pressure / 100.0, l.temperature - 273.15, l.number_density * 1e-6]);
    let text = csv("height (km),pressure [hPa],temperature [°C],number density cm^-3", rows);
    let made = atmosphere::table(&sounding(&text), &RAW.atmosphere).expect("a table");
    let ours = views::StandardAtmosphere::from_table(&ours(Kind::StandardAtmosphere)).expect("a view");
    let (depth, expected) = (rayleigh_depth(&air(&made)), rayleigh_depth(&ours));
    println!("sounding by 1 km: optical depth {depth} for {expected}");
    // The bend of the temperature at 11.02 km lies between two levels, which moves it by 0.13 K there: 6e-4 of the
    // density over some 500 m of 8 km, and the other way around it.
    assert!((depth / expected - 1.0).abs() < 2e-5, "{depth} for {expected}");
}

#[test]
fn a_warm_station_on_a_hill_is_completed_without_a_jump_and_in_balance() {
    let standard = StandardAtmosphere::new(&RAW.atmosphere).expect("sound");
    let text = "altitude_m,pressure_hpa,temperature_c\n450,963.2,18.4\n1500,852,11\n5600,508,-14.5\n12000,200.5,-56.1";
    let sounding = sounding(text);
    let completed = Completed::new(&sounding, &standard).expect("a profile");
    let at = |z: f64| completed.at(z).expect("inside");
    for level in [450.0, 12_000.0] {
        let (a, b) = (at(level - 1e-4), at(level + 1e-4));
        // 0.2 mm of height are 3e-8 of the pressure.
        assert!((a.pressure / b.pressure - 1.0).abs() < 5e-8 && (a.temperature - b.temperature).abs() < 1e-4);
    }
    assert!((at(450.0).pressure - 96_320.0).abs() < 1e-6 && (at(0.0).temperature - 294.48).abs() < 0.01);
    // Above the fade the temperature is the standard's, and the pressure stays another.
    let high = standard.at(40_000.0).expect("inside");
    assert!((at(40_000.0).temperature - high.temperature).abs() < 1e-9 && at(40_000.0).pressure != high.pressure);
    // dp/dz = -g rho outside the levels, by Simpson's rule over 100 m.
    for z in [0.0, 100.0, 300.0, 12_100.0, 20_500.0, 31_900.0, 45_000.0, 70_000.0] {
        let weight = |z: f64| 9.80665 * (6_356_766.0 / (6_356_766.0 + z)).powi(2) * at(z).mass_density;
        let expected = 100.0 / 6.0 * (weight(z) + 4.0 * weight(z + 50.0) + weight(z + 100.0));
        let found = at(z).pressure - at(z + 100.0).pressure;
        // The standard atmosphere is in balance to rounding; Simpson's rule over the kinks of the fade costs most.
        assert!((found / expected - 1.0).abs() < 1e-6, "{z} m: {found} for {expected} Pa");
    }
    let atmosphere::Departure { relative, lines } = completed.hydrostatic();
    assert!(relative.abs() < 0.02 && lines.1 <= 5, "{relative} {lines:?}");
}

#[test]
fn soundings_that_cannot_be_are_refused_with_figures() {
    let refused = |text: &str| {
        let parsed = Sounding::parse("sonde.csv", text.as_bytes(), &[], false);
        match parsed {
            Err(error) => error.to_string(),
            Ok(sounding) => atmosphere::table(&sounding, &RAW.atmosphere).expect_err("refused").to_string(),
        }
    };
    let header = "altitude_m,pressure_pa,temperature_k\n";
    for (rows, expected) in [
        (
            "0,101325,288\n1000,90000,281\n1000,90000,281\n",
            "sonde.csv, line 4, column \"altitude_m\": expected more than in line 3, found 1000: keep the ascent alone, \
             each level once, from the ground upwards",
        ),
        (
            "0,101325,288\n1000,102000,281\n",
            "sonde.csv, line 3, column \"pressure_pa\": expected less pressure than in line 2, found 1.02000e5 Pa after \
             1.01325e5 Pa",
        ),
        ("0,101325,288\n", "sonde.csv: expected two levels at least, found one"),
        ("0,101325,15\n1,101300,15\n", "sonde.csv, line 2, column \"temperature_k\": expected 120 to 1000 K, found 15"),
        (
            "0,1013.25,288\n1000,900,281\n",
            "sonde.csv, line 2, column \"pressure_pa\": expected 5.0662e4 to 2.0265e5 Pa at 0 m, half to twice the \
             standard atmosphere, found 1.0132e3 Pa",
        ),
        (
            "0,101325,288\n3000,60000,268\n6000,47000,249\n",
            "sonde.csv: expected pressures that fall as the weight of the air between, within 10 %, found +42.1 % from \
             line 2 to line 3",
        ),
    ] {
        assert_eq!(refused(&format!("{header}{rows}")), expected);
    }
    let three =
        "altitude_m,pressure_pa,temperature_k,number_density_m3\n0,101325,288.15,2.6e25\n1000,90000,281,2.3e25\n";
    assert_eq!(
        refused(three),
        "sonde.csv, line 2, column \"pressure_pa\": expected N k T = 1.03437e5 Pa within 1 %, found 1.01325e5 Pa"
    );
    let high = "gph_km,pressure_pa,temperature_k\n117,0.003,340\n118,0.0028,345\n";
    assert_eq!(
        refused(high),
        "sonde.csv, line 3, column \"gph_km\": expected a geopotential altitude of at most 117777 m', found 118000 m'"
    );
    assert!(refused("altitude_m,temperature_k\n0,288\n1,287\n").contains("one column of pressure or number density"));
}

fn completion(column_du: Option<f64>) -> Completion {
    Completion { month: 6, latitude_deg: 47.0, geopotential: false, column_du }
}

#[test]
fn the_climatology_as_a_sonde_to_30_km_has_its_column_again() {
    let climatology = views::OzoneProfiles::from_table(&ours(Kind::OzoneProfiles)).expect("a view");
    let profile = climatology.profile(6, 47.0).expect("June");
    let curve = &profile.number_density_m3;
    let standard = StandardAtmosphere::new(&RAW.atmosphere).expect("sound");
    let levels: Vec<(f64, f64)> = curve
        .axis()
        .nodes
        .iter()
        .copied()
        .zip(curve.values().iter().copied())
        .filter(|(z, _)| *z <= 30_000.0)
        .collect();
    let density = csv("altitude_m,ozone_number_density_m3", levels.iter().map(|&(z, n)| [z, n]));
    let ratio = csv(
        "altitude_km,o3_vmr_ppbv",
        levels.iter().map(|&(z, n)| [z / 1e3, 1e9 * n / standard.at(z).expect("inside").number_density]),
    );
    let partial = csv(
        "pressure_hpa,ozone_partial_pressure_mpa,temperature_k",
        levels.iter().map(|&(z, n)| {
            let air = standard.at(z).expect("inside");
            [air.pressure / 100.0, 1e3 * air.pressure * n / air.number_density, air.temperature]
        }),
    );
    for (what, text) in [("number density", density), ("mixing ratio", ratio), ("partial pressure", partial)] {
        let sonde = Sonde::parse("sonde.csv", text.as_bytes(), &[]).expect("a good sonde");
        let made = ozone::table(&sonde, &RAW, completion(None)).expect("a table");
        let own = views::OzoneProfiles::from_table(&made.table).expect("a view");
        assert!(own.is_single() && !climatology.is_single());
        // Any month and latitude.
        let found = own.profile(12, -80.0).expect("held");
        println!("{what}: {} DU for {} DU", found.column_du, profile.column_du);
        // The pressures go back to altitudes of the standard atmosphere, which the nodes are to a millimetre.
        assert!((found.column_du / profile.column_du - 1.0).abs() < 1e-6, "{what}: {}", found.column_du);
        let curve = &found.number_density_m3;
        let column = trapezoidal(&curve.axis().nodes, curve.values()) / DOBSON_UNIT_M2;
        assert!((column / found.column_du - 1.0).abs() < 1e-12, "{column}");
        assert!(made.notes[0].starts_with(&format!("ozone column {:.2} DU", found.column_du)), "{:?}", made.notes);
    }
}

#[test]
fn an_ozone_sonde_from_below_the_sea_level_of_the_standard_begins_at_the_ground() {
    let text = "pressure_hpa,ozone_ppbv\n1030,40\n900,45\n100,500\n";
    let sonde = Sonde::parse("sonde.csv", text.as_bytes(), &[]).expect("a good sonde");
    let profile = |column| {
        let made = ozone::table(&sonde, &RAW, completion(column)).expect("a table");
        views::OzoneProfiles::from_table(&made.table).expect("a view").profile(1, 0.0).expect("held")
    };
    let (own, scaled) = (profile(None), profile(Some(250.0)));
    assert!((scaled.column_du - 250.0).abs() < 1e-9, "{}", scaled.column_du);
    let (first, _) = own.number_density_m3.axis().range();
    let ground = own.number_density_m3.at(0.0).expect("inside") / 2.547e25;
    // Between 40 and 45 ppbv, a seventh of the way in altitude (-137 m to 989 m).
    assert!(first == 0.0 && (40e-9..42e-9).contains(&ground), "{first} m, {ground}");
}

#[test]
fn sondes_that_cannot_be_are_refused() {
    let refused = |text: &str, completion: Completion| match Sonde::parse("o3.csv", text.as_bytes(), &[]) {
        Err(error) => error.to_string(),
        Ok(sonde) => ozone::table(&sonde, &RAW, completion).expect_err("refused").to_string(),
    };
    for (text, expected) in [
        (
            "pressure_hpa,ozone_partial_pressure_mpa\n900,3\n950,3\n",
            "o3.csv, line 3, column \"pressure_hpa\": expected less than in line 2, found 950: keep the ascent alone, \
             each level once, from the ground upwards",
        ),
        (
            "altitude_m,ozone_ppmv,ozone_m3\n0,0.03,1e18\n",
            "o3.csv: expected one column of ozone partial pressure or ozone mixing ratio or ozone number density \
             (ozone_partial_pressure_mpa, ozone_partial_pressure_nbar, ozone_mixing_ratio_ppmv, \
             ozone_mixing_ratio_ppbv, ozone_number_density_m3, ozone_number_density_cm3), found \"ozone_ppmv\" and \
             \"ozone_m3\"",
        ),
        (
            "temperature_k,ozone_ppmv\n280,0.03\n",
            "o3.csv: expected one column of altitude or geopotential altitude or pressure (altitude_m, altitude_km, \
             geopotential_altitude_m, geopotential_altitude_km, pressure_pa, pressure_hpa, pressure_kpa), found none",
        ),
        (
            "altitude_m,ozone_ppmv\n0,0.03\n9000,0\n",
            "o3.csv, line 3, column \"ozone_ppmv\": expected ozone at the last level, where it is continued, found none",
        ),
        ("altitude_m,ozone_ppmv\n0,300\n", "o3.csv, line 2, column \"ozone_ppmv\": expected 0 to 100 ppmv, found 300"),
    ] {
        assert_eq!(refused(text, completion(None)), expected);
    }
    let good = "altitude_m,ozone_ppmv\n0,0.03\n9000,0.1\n";
    let bad = |change: fn(&mut Completion)| {
        let mut completion = completion(None);
        change(&mut completion);
        refused(good, completion)
    };
    assert_eq!(bad(|c| c.month = 13), "month is 13; 1 to 12 is possible");
    assert_eq!(bad(|c| c.latitude_deg = f64::NAN), "latitude is NaN; -90 to 90 degrees is possible");
    assert_eq!(bad(|c| c.column_du = Some(0.0)), "column is 0; 1 to 1000 DU is possible");
}

#[test]
fn the_sun_and_a_ground_give_back_themselves() {
    let table = ours(Kind::Sun);
    let inside = RAW.sun.spectrum.rows.iter().filter(|row| (300.0..=1000.0).contains(&row.wavelength_nm));
    let nm = csv("wavelength_nm,irradiance_w_m2_nm", inside.clone().map(|row| [row.wavelength_nm, row.irradiance]));
    let um = csv("lambda [µm];flux [W/m²/µm]", inside.map(|row| [row.wavelength_nm / 1e3, row.irradiance * 1e3]));
    for text in [nm, um.replace(',', ";")] {
        let spectrum = sun::Spectrum::parse("sun.csv", text.as_bytes(), &[]).expect("a good spectrum");
        let made = sun::table(&spectrum, &RAW.sun).expect("a table");
        let [own, ours] = [&made.table, &table].map(|table| views::Sun::from_table(table).expect("a view"));
        for (a, b) in own.irradiance_w_m2_nm.values().iter().zip(ours.irradiance_w_m2_nm.values()) {
            // The committed table has single precision.
            assert!((a - b).abs() <= 1e-7 * b, "{a} for {b}");
        }
        assert_eq!(own.limb_coefficients(550.0).expect("inside"), ours.limb_coefficients(550.0).expect("inside"));
    }
    let rows = RAW.ground_albedo.spectra.rows.iter();
    let text = csv("wavelength_nm,reflectance_percent", rows.map(|row| [row.wavelength_nm, 100.0 * row.ocean]));
    let spectrum = albedo::Spectrum::parse("sea.csv", text.as_bytes(), &[]).expect("a good spectrum");
    let made = albedo::table(&spectrum, "my sea").expect("a table");
    let own = &views::GroundAlbedo::from_table(&made.table).expect("a view").spectra["my sea"];
    for row in &RAW.ground_albedo.spectra.rows {
        assert!((own.at(row.wavelength_nm).expect("a node") - row.ocean).abs() < 1e-15);
    }
    assert!(own.at(200.0).is_err(), "nothing is extrapolated");
    for name in ["", "0.3", &"x".repeat(65)] {
        assert!(albedo::table(&spectrum, name).is_err(), "{name:?} was taken");
    }
}

#[test]
fn spectra_that_cannot_be_are_refused() {
    let sun = |text: &str| sun::Spectrum::parse("sun.csv", text.as_bytes(), &[]).expect_err("refused").to_string();
    assert_eq!(
        sun("wavelength_nm,irradiance_w_m2_nm\n350,1\n800,1\n"),
        "sun.csv: expected wavelengths over all of 300 to 1000 nm, since nothing is extrapolated, found 350 to 800 nm"
    );
    assert_eq!(
        sun("wavelength_nm,irradiance_w_m2_nm\n300,1\n800,1850\n"),
        "sun.csv, line 3, column \"irradiance_w_m2_nm\": expected 0 to 10 W m^-2 nm^-1, found 1850"
    );
    assert!(sun("wavelength_nm,irradiance_w_m2_nm\n300,0\n1000,0\n").contains("expected a sun that shines"));
    assert!(sun("wavelength_nm,irradiance\n300,0\n").contains("name the unit of this one: irradiance_w_m2_nm or"));
    let ground = albedo::Spectrum::parse("a.csv", b"wavelength_nm,albedo\n300,1.2\n", &[]).expect_err("refused");
    assert_eq!(ground.to_string(), "a.csv, line 2, column \"albedo\": expected 0 to 1, found 1.2");
}

fn index_of(material: &str, humidity: f64) -> Index {
    let rows = RAW.aerosol_opac.refractive_index.rows.iter();
    let rows = rows.filter(|row| row.material == material && row.humidity_percent == humidity);
    let rows = rows.filter(|row| row.wavelength_nm <= 1100.0).map(|row| [row.wavelength_nm / 1e3, row.n, row.k]);
    Index::parse("index.csv", csv("wavelength_um,n,k", rows).as_bytes(), &[]).expect("a good index")
}

#[test]
fn maritime_clean_by_its_own_modes_and_indices_is_the_built_table() {
    let opac = &RAW.aerosol_opac;
    let boundary_layer = &opac_species(opac, "maritime_clean").expect("a type")[0];
    let mut text =
        String::from("material,median_radius_um,sigma_g,smallest_radius_um,largest_radius_um,number_density_cm-3\n");
    let mut indices = Vec::new();
    for (part, number) in &boundary_layer.parts {
        let Part::Component(name) = part else { panic!("OPAC has components") };
        let row =
            opac.components.rows.iter().find(|c| c.component == *name && c.humidity_percent == 80.0).expect("80 %");
        let um = [row.median_radius * 1e6, row.sigma_g, row.smallest_radius * 1e6, row.largest_radius * 1e6];
        text += &format!("{name},{},{},{},{},{}\n", um[0], um[1], um[2], um[3], number * 1e-6);
        indices.push((name.clone(), index_of(&row.material, 80.0)));
    }
    let own = OwnAerosol {
        name: "sea".into(),
        sizes: OwnSizes::Modes(Modes::parse("modes.csv", text.as_bytes(), &[]).expect("good modes")),
        indices,
        profile: OwnProfile::Exponential { scale_height: 1000.0, top: 2000.0 },
        number_density: None,
    };
    let made = aerosol::table(&own).expect("a table");
    let found = views::Aerosol::from_table(&made.table).expect("a view");
    assert_eq!(found.origin, views::Origin::Own("sea".into()));
    let path = root().join("data/aerosol-opac-maritime-clean.table");
    let built = views::Aerosol::from_table(&tables::file::read(&path).expect("a table")).expect("a view");
    let [own, ours] = [&found, &built].map(|aerosol| &aerosol.species[0]);
    let mut largest = [0.0_f64; 3];
    for nm in (300..=1000).step_by(25).map(f64::from) {
        let (a, b) = (own.optics(0.0, nm).expect("inside"), ours.optics(80.0, nm).expect("inside"));
        largest[0] = largest[0].max((a.extinction_m2 / b.extinction_m2 - 1.0).abs());
        largest[0] = largest[0].max((a.scattering_m2 / b.scattering_m2 - 1.0).abs());
        largest[1] = largest[1].max((a.asymmetry - b.asymmetry).abs());
        let phase = a.phase.iter().zip(&b.phase).map(|(a, b)| (a / b - 1.0).abs());
        largest[2] = largest[2].max(phase.fold(0.0, f64::max));
    }
    println!(
        "maritime-clean: cross-sections within {:.1e}, g {:.1e}, phase {:.1e}",
        largest[0], largest[1], largest[2]
    );
    // The same rule at the same nodes: what is left is the rounding of micrometres, as the tables' own tolerances.
    assert!(largest[0] < 1e-9 && largest[1] < 1e-9 && largest[2] < 1e-6, "{largest:?}");
    let ground = 1.0 - own.number_density_m3.at(0.0).expect("inside") / ours.number_density_m3.at(0.0).expect("inside");
    assert!(ground.abs() < 1e-12, "{ground}");
    // The same bytes again.
    let bytes = |made: &Import| tables::file::encode(&made.table).expect("bytes");
    let again = OwnAerosol { name: "sea".into(), ..own_again(&text) };
    assert!(bytes(&aerosol::table(&again).expect("a table")) == bytes(&made), "a second run gave other bytes");
}

/// The same aerosol, read again.
fn own_again(text: &str) -> OwnAerosol {
    let modes = Modes::parse("modes.csv", text.as_bytes(), &[]).expect("good modes");
    let material = |name: &str| {
        let row = RAW.aerosol_opac.components.rows.iter().find(|c| c.component == name).expect("a component");
        index_of(&row.material, 80.0)
    };
    let names = modes.modes.iter().filter_map(|mode| mode.material.clone());
    OwnAerosol {
        name: String::new(),
        indices: names.map(|name| (name.clone(), material(&name))).collect(),
        sizes: OwnSizes::Modes(modes),
        profile: OwnProfile::Exponential { scale_height: 1000.0, top: 2000.0 },
        number_density: None,
    }
}

fn small(sizes: OwnSizes, number_density: Option<f64>) -> OwnAerosol {
    OwnAerosol {
        name: "small".into(),
        sizes,
        indices: vec![("dust".into(), index_of("mineral", 0.0))],
        profile: OwnProfile::Exponential { scale_height: 2000.0, top: 10_000.0 },
        number_density,
    }
}

#[test]
fn a_log_normal_given_as_a_table_of_radii_is_the_log_normal() {
    let modes = Modes::parse("modes.csv", b"median_radius_um,sigma_g,share,r_min_um,r_max_um\n0.1,1.6,1,0.01,2\n", &[]);
    let log_normal = small(OwnSizes::Modes(modes.expect("good modes")), Some(1e9));
    let density =
        |r: f64| (-0.5 * ((r / 0.1).ln() / 1.6_f64.ln()).powi(2)).exp() / (r * 1.6_f64.ln() * 2.506_628_274_631);
    let radii = (0..=200).map(|i| 0.01 * 200.0_f64.powf(f64::from(i) / 200.0));
    let text = csv("radius_um,dn_dr_cm-3_um-1", radii.map(|r| [r, 1000.0 * density(r)]));
    let measured = Distribution::parse("sizes.csv", text.as_bytes(), &[]).expect("good sizes");
    // 1000 per cm3 but for what the limits leave out (1e-6), and the chords of the table, h^2 / (12 s^2) of each piece.
    assert!((measured.sizes.number() / 1e9 - 1.0).abs() < 4e-4, "{}", measured.sizes.number());
    let tabulated = small(OwnSizes::Distribution(measured), None);
    let optics = |own: &OwnAerosol| {
        let table = aerosol::table(own).expect("a table").table;
        let aerosol = views::Aerosol::from_table(&table).expect("a view");
        (aerosol.own_optical_depth().expect("550 nm"), aerosol.species[0].optics(0.0, 550.0).expect("550 nm"))
    };
    let ((a, exact), (b, found)) = (optics(&log_normal), optics(&tabulated));
    println!("tabulated log-normal: optical depth {b} for {a}, g {} for {}", found.asymmetry, exact.asymmetry);
    assert!((b / a - 1.0).abs() < 1e-3 && (found.asymmetry - exact.asymmetry).abs() < 1e-3);
}

#[test]
fn a_vertical_profile_gives_the_number_at_the_ground_or_only_the_shape() {
    let modes = |column: &str| {
        let text = format!("median_radius_nm,sigma_g,{column}\n50,1.5,1\n");
        OwnSizes::Modes(Modes::parse("modes.csv", text.as_bytes(), &[]).expect("good modes"))
    };
    let vertical = |text: &str| Vertical::parse("layer.csv", text.as_bytes(), &[]).expect("a good profile");
    let at = |own: &OwnAerosol, z: f64| {
        let table = aerosol::table(own).expect("a table").table;
        views::Aerosol::from_table(&table).expect("a view").species[0].number_density_m3.at(z).expect("zero outside")
    };
    let absolute = OwnAerosol {
        profile: OwnProfile::Levels(vertical("altitude_km,number_density_cm3\n0.2,800\n1,400\n3,0\n")),
        ..small(modes("share"), None)
    };
    // The first level holds down to the ground, and between two of which one is empty it is linear.
    for (z, expected) in [(0.0, 800e6), (1000.0, 400e6), (2000.0, 200e6), (3500.0, 0.0)] {
        assert!((at(&absolute, z) - expected).abs() < 1.0, "{z} m: {}", at(&absolute, z));
    }
    let relative = OwnAerosol {
        profile: OwnProfile::Levels(vertical("altitude_km,relative_percent\n0,100\n2,25\n")),
        ..small(modes("share"), Some(1e9))
    };
    assert!((at(&relative, 1000.0) / 0.5e9 - 1.0).abs() < 1e-12, "its logarithm is linear");
    let refused = |own: OwnAerosol| aerosol::table(&own).expect_err("refused").to_string();
    assert!(refused(OwnAerosol { number_density: Some(1e9), ..absolute }).contains("leave out --number-density"));
    assert!(refused(small(modes("share"), None)).contains("shares only"));
    assert!(refused(small(modes("number_density_cm3"), Some(1e9))).contains("leave out --number-density"));
    assert!(refused(small(modes("share"), Some(1e20))).contains("number-density is 100000000000000; 0.000001 to"));
    let two = vec![("a".to_owned(), index_of("mineral", 0.0)), ("b".to_owned(), index_of("soot", 0.0))];
    assert!(refused(OwnAerosol { indices: two, ..small(modes("share"), Some(1e9)) }).contains("materials a, b"));
    let named = Modes::parse("m.csv", b"material,median_radius_um,sigma_g,share\na,0.1,2,1\n", &[]).expect("good");
    let spare = vec![("a".to_owned(), index_of("mineral", 0.0)), ("b".to_owned(), index_of("soot", 0.0))];
    let spare = OwnAerosol { indices: spare, ..small(OwnSizes::Modes(named.clone()), Some(1e9)) };
    assert_eq!(refused(spare), "there is a refractive index of \"b\", but no particles of it");
    let other = small(OwnSizes::Modes(named), Some(1e9));
    assert_eq!(refused(other), "material \"a\" has no refractive index; there are dust");
    let high = OwnProfile::Exponential { scale_height: 2000.0, top: 130e3 };
    assert!(refused(OwnAerosol { profile: high, ..small(modes("share"), Some(1e9)) }).contains("top is 130"));
}

#[test]
fn parts_of_an_aerosol_that_cannot_be_are_refused() {
    let refused = |error: Option<tools::raw::RawError>| error.expect("refused").to_string();
    let modes = |text: &str| refused(Modes::parse("m.csv", text.as_bytes(), &[]).err());
    assert_eq!(
        modes("median_radius_um,sigma_g,share\n0.1,2,0.5\n0.2,2,0.4\n"),
        "m.csv: expected shares in the number that add up to 1, found 0.9"
    );
    assert_eq!(
        modes("median_radius_um,sigma_g,number_density_cm3\n0.1,0.7,1\n"),
        "m.csv, line 2, column \"sigma_g\": expected 1.01 to 10, found 0.7"
    );
    assert_eq!(
        modes("median_radius_um,sigma_g,share,r_min_um,r_max_um\n0.1,2,1,5,1\n"),
        "m.csv, line 2, column \"r_max_um\": expected a largest radius above the smallest, found 5e0 to 1e0 um"
    );
    let index = |text: &str| refused(Index::parse("i.csv", text.as_bytes(), &[]).err());
    assert_eq!(
        index("wavelength_nm,n,k\n300,1.5,-0.01\n"),
        "i.csv, line 2, column \"k\": expected k >= 0: m = n + ik, k absorbs; change the sign of n - ik, found -0.01"
    );
    assert_eq!(
        index("wavelength_nm,n,k\n400,1.5,0\n1000,1.5,0\n"),
        "i.csv: expected wavelengths over all of 300 to 1000 nm, since nothing is extrapolated, found 400 to 1000 nm"
    );
    let sizes = |text: &str| refused(Distribution::parse("s.csv", text.as_bytes(), &[]).err());
    assert_eq!(
        sizes("radius_um,dn_dlogr_cm3\n0.1,5\n0.1,4\n"),
        "s.csv, line 3, column \"radius_um\": expected more than in line 2, found 0.1: give each radius once, smallest first"
    );
    assert!(sizes("radius_um,dn_dlogr_cm3\n0.1,0\n0.2,0\n").contains("two radii or more with particles"));
    let vertical = |text: &str| refused(Vertical::parse("v.csv", text.as_bytes(), &[]).err());
    assert!(vertical("altitude_km,relative\n0,0\n1,1\n").contains("expected more than 0 at the lowest altitude"));
    assert!(vertical("altitude_km,relative\n0,1\n").contains("two altitudes at least"));
}

fn run(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_airlight-tools"))
        .args(arguments)
        .arg("--raw-data")
        .arg(root().canonicalize().expect("the root").join("raw-data"))
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

#[test]
fn the_program_writes_the_same_bytes_twice_and_nothing_of_a_bad_file() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("own");
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(folder.join("in")).expect("a folder for the test");
    std::fs::write(folder.join("in/grass.csv"), "wavelength_nm,albedo,site\n400,0.03,a\n800,0.5,b\n").expect("written");
    let grass = ["import", "albedo", "in/grass.csv", "--name", "grass", "-o"];
    let bad = run(&[&grass[..], &["bad.table"]].concat(), &folder);
    let words = String::from_utf8_lossy(&bad.stderr).into_owned();
    assert_eq!(bad.status.code(), Some(1), "{words}");
    assert!(words.starts_with("error: grass.csv, line 1, column \"site\": expected one of wavelength_nm"), "{words}");
    assert!(!folder.join("bad.table").exists());
    for name in ["a.table", "b.table"] {
        let good = run(&[&grass[..], &[name, "--ignore", "site"]].concat(), &folder);
        assert!(good.status.success() && good.stdout.is_empty(), "{}", String::from_utf8_lossy(&good.stderr));
    }
    let [a, b] = ["a.table", "b.table"].map(|name| std::fs::read(folder.join(name)).expect("written"));
    assert!(a == b, "two runs gave other bytes");
    let table = tables::file::read(&folder.join("a.table")).expect("sound");
    assert!(table.provenance[0].is_own() && table.provenance[0].file == "grass.csv", "{:?}", table.provenance);
    let _ = std::fs::remove_dir_all(&folder);
}
