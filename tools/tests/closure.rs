//! Do the numbers close? Integrals, sums and independent tables that must agree.
#![allow(clippy::print_stdout, reason = "the figures found: cargo test -- --nocapture shows them")]

use std::path::{Path, PathBuf};
use tables::units::DOBSON_UNIT_M2;
use tools::molecular::{king, ozone, rayleigh};
use tools::profile::ozone as ozone_profile;
use tools::profile::standard_atmosphere::StandardAtmosphere;
use tools::raw::RawData;
use tools::raw::bucholtz::Quantity;

fn raw_dir() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../raw-data")
}

fn raw() -> RawData {
    RawData::from_dir(&raw_dir()).expect("raw-data/ is sound")
}

/// Simpson's rule over `steps` (even) steps.
fn simpson(low: f64, high: f64, steps: u32, f: impl Fn(f64) -> f64) -> f64 {
    let h = (high - low) / f64::from(steps);
    let weight = |i| if i == 0 || i == steps { 1.0 } else { f64::from(2 + 2 * (i % 2)) };
    (0..=steps).map(|i| weight(i) * f(low + f64::from(i) * h)).sum::<f64>() * h / 3.0
}

/// Integral of the function linear between points, from `low` to `high`, both nodes.
fn trapezoidal(points: impl Iterator<Item = (f64, f64)>, low: f64, high: f64) -> f64 {
    let (x, y): (Vec<f64>, Vec<f64>) = points.filter(|(x, _)| (low..=high).contains(x)).unzip();
    ozone_profile::trapezoidal(&x, &y)
}

#[test]
fn standard_atmosphere_agrees_with_its_published_profile() {
    let raw = raw();
    let atmosphere = StandardAtmosphere::new(&raw.atmosphere).expect("sound layers");
    let mut largest = [0.0_f64; 4];
    for level in &raw.atmosphere.profile.rows {
        let air = atmosphere.at(level.altitude).expect("below 120 km");
        let relative = [
            air.temperature / level.temperature,
            air.pressure / level.pressure,
            air.mass_density / level.mass_density,
            air.number_density / level.number_density,
        ];
        for (largest, relative) in largest.iter_mut().zip(relative) {
            *largest = largest.max((relative - 1.0).abs());
        }
    }
    println!("US76 against its profile, largest relative T, p, rho, N: {largest:?}");
    // The profile has 7 digits; temperature has 4 decimals.
    assert!(largest.iter().all(|&x| x < 1e-6), "{largest:?}");
}

#[test]
fn standard_atmosphere_layers_meet_and_stand_where_the_source_says() {
    let raw = raw();
    let atmosphere = StandardAtmosphere::new(&raw.atmosphere).expect("sound layers");
    for (layer, base) in raw.atmosphere.layers.rows.iter().zip(atmosphere.layer_bases()) {
        let at = atmosphere.at(base).expect("inside");
        // 7 digits of pressure, 5 decimals of a kilometre.
        assert!((at.pressure / layer.base_pressure - 1.0).abs() < 2e-7, "{} Pa at {base} m", at.pressure);
        assert!((base - layer.geometric_base).abs() < 0.0051, "{base} m");
        assert!((at.temperature - layer.base_temperature).abs() < 1e-9, "{} K at {base} m", at.temperature);
    }
    let (below, at) = (atmosphere.at(85_999.999_9).expect("layers"), atmosphere.at(86_000.0).expect("table"));
    // The 86 km row of the upper table has 7 digits.
    assert!((below.number_density / at.number_density - 1.0).abs() < 5e-7);
    assert!(atmosphere.at(-0.1).is_err() && atmosphere.at(120_000.1).is_err() && atmosphere.at(f64::NAN).is_err());
}

#[test]
fn rayleigh_formula_reproduces_bucholtz_table_2() {
    let raw = raw();
    let n_s = raw.atmosphere.values.standard_number_density;
    let air = rayleigh::Rayleigh::new(&raw.bucholtz, n_s).expect("sound table");
    let found = air.compare(&raw.bucholtz.cross_section.rows).expect("200 to 4000 nm");
    println!("Rayleigh formula against table 2: {found:?}");
    // Half a unit of the fourth digit is up to 0.05 % of a value that begins with 1.
    assert!(found.count == 80 && found.largest < 4e-4, "{found:?}");
    for row in &raw.bucholtz.cross_section.rows {
        let closure = row.scattering_coefficient / (row.cross_section * n_s) - 1.0;
        assert!(closure.abs() < 1e-3, "beta = sigma N_s fails by {closure} at {} nm", row.wavelength_nm);
    }
}

#[test]
fn rayleigh_fit_departs_from_table_2_as_stated() {
    let raw = raw();
    let fit = |wavelength_nm| rayleigh::fitted(&raw.bucholtz.fit.rows, Quantity::CrossSection, wavelength_nm);
    let found = rayleigh::departure(&raw.bucholtz.cross_section.rows, fit).expect("200 to 4000 nm");
    println!("Bucholtz' fit against table 2: {found:?}");
    assert!(found.largest < 4.4e-3 && found.largest_at_nm == 200.0, "{found:?}");
}

#[test]
fn depolarisation_and_gamma_follow_from_the_king_factor() {
    for row in &raw().bucholtz.king_factor.rows {
        let rho = king::depolarisation(row.king_factor);
        let gamma = king::gamma(rho);
        // One unit of the fifth decimal: a row's last digit is off by one at 230 nm.
        assert!((rho - row.depolarisation).abs() < 1.1e-5, "rho {rho} at {} nm", row.wavelength_nm);
        assert!((gamma - row.gamma).abs() < 1.1e-5, "gamma {gamma} at {} nm", row.wavelength_nm);
        // Bucholtz took his King factors from Bates; they are rounded to 0.001.
        let bates = king::bates(row.wavelength_nm, 3e-4);
        assert!((bates - row.king_factor).abs() < 2e-3, "Bates {bates} at {} nm", row.wavelength_nm);
    }
}

#[test]
fn rayleigh_optical_depth_of_the_standard_atmosphere_is_the_published_one() {
    let raw = raw();
    let atmosphere = StandardAtmosphere::new(&raw.atmosphere).expect("sound layers");
    let density = |z: f64| atmosphere.at(z).expect("inside").number_density;
    let column = simpson(0.0, 86_000.0, 8600, density);
    let air = rayleigh::Rayleigh::new(&raw.bucholtz, raw.atmosphere.values.standard_number_density).expect("sound");
    let depth = column * air.cross_section(550.0).expect("inside");
    let fit = rayleigh::fitted(&raw.bucholtz.fit.rows, Quantity::OpticalDepthUs76, 550.0).expect("inside");
    println!("air column {column:.6e} m^-2, Rayleigh optical depth at 550 nm {depth:.6}, Bucholtz' fit {fit:.6}");
    assert!((depth - 0.0971).abs() < 5e-5, "0.0971 is published to four decimals: {depth}");
    // The fit itself is good to 0.1 % here.
    assert!((depth / fit - 1.0).abs() < 1e-3, "{depth} against {fit}");
    // Hydrostatics: the air above weighs p_0, with gravity falling as the inverse square. Mass per
    // area times g_0, about 0.3 % more than p_0 / g_0 for a scale height of 8 km.
    let weight = simpson(0.0, 86_000.0, 8600, |z| {
        let r = raw.atmosphere.values.earth_radius;
        atmosphere.at(z).expect("inside").mass_density * raw.atmosphere.values.gravity * (r / (r + z)).powi(2)
    });
    let expected = raw.atmosphere.values.pressure - atmosphere.at(85_999.99).expect("inside").pressure;
    println!("weight of the air below 86 km over its pressure difference - 1: {:.1e}", weight / expected - 1.0);
    assert!((weight / expected - 1.0).abs() < 1e-7, "{weight} Pa against {expected} Pa");
}

#[test]
fn ozone_cross_section_polynomial_fits_its_measurements() {
    let raw = raw();
    let rows = &raw.ozone_serdyuchenko.cross_sections.rows;
    let everywhere = ozone::fit(rows, 214.0, 1099.0);
    println!("ozone 214-1099 nm: {} cells, {} clamped", everywhere.cells, everywhere.clamped);
    assert_eq!(everywhere.clamped, 214, "cells of noise in the whole source");
    for (name, low, high, rms) in [
        ("table", 300.0, 1000.0, 0.06),
        ("Huggins", 310.0, 340.0, 0.007),
        ("gap", 345.0, 440.0, 0.15),
        ("Chappuis", 450.0, 750.0, 0.004),
        ("Wulf", 750.0, 1000.0, 0.04),
    ] {
        let fit = ozone::fit(rows, low, high);
        let lowest = fit
            .polynomials
            .iter()
            .flat_map(|p| (187..=293).map(move |t| (p.at(f64::from(t)), p.wavelength_nm, t)))
            .min_by(|a, b| a.0.total_cmp(&b.0));
        println!("ozone {name} {low}-{high} nm: clamped {}, {:?}, lowest {lowest:?}", fit.clamped, fit.residual);
        // What was found: a parabola is good to the noise where ozone matters.
        assert!(fit.residual.rms_relative < rms, "{name}: {:?}", fit.residual);
        // Noise at 382 nm lets a parabola touch zero below the lowest temperature measured.
        assert!(lowest.is_some_and(|(sigma, _, _)| sigma > -1e-29), "{name}: {lowest:?}");
    }
}

#[test]
fn ozone_cross_section_agrees_with_other_measurements() {
    let raw = raw();
    let rows = &raw.ozone_serdyuchenko.cross_sections.rows;
    let at_293 = |wavelength_nm: f64| {
        rows.iter().find(|row| row.wavelength_nm == wavelength_nm).map(|row| row.cross_sections[10])
    };
    // 1.1329e-21 m^2 at the mercury line of 253.65 nm (Hodges et al., Metrologia 56, 034001, 2019, at
    // 296 K). Serdyuchenko et al. give 2 to 3 % as their uncertainty.
    let mercury = at_293(253.0).zip(at_293(254.0)).map(|(a, b)| a + 0.65 * (b - a)).expect("measured");
    println!("ozone at 253.65 nm: {mercury:.4e} m^2");
    assert!((mercury / 1.1329e-21 - 1.0).abs() < 0.03, "{mercury}");
}

#[test]
fn ozone_profiles_integrate_to_their_columns() {
    let raw = raw();
    let atmosphere = StandardAtmosphere::new(&raw.atmosphere).expect("sound layers");
    let altitudes = ozone_profile::climatology_levels(&atmosphere).expect("up to 120 km");
    assert_eq!((altitudes[0], altitudes[altitudes.len() - 1]), (0.0, 120_000.0));
    let mut grid_error = 0.0_f64;
    // South of 80 degrees the two lowest levels are inside the ice sheet: filling them adds up to
    // 2.7 % there, which the scaling takes out again.
    let (mut low, mut high, mut lowest_at_pole) = (f64::MAX, 0.0_f64, f64::MAX);
    for month in 1..=12 {
        for band in 0..18 {
            let column = raw.ozone_mcpeters_labow.columns.rows[month - 1].columns[band];
            let profile =
                ozone_profile::ClimatologicalProfile::new(&raw.ozone_mcpeters_labow, &atmosphere, month, band)
                    .expect("data");
            let scaled = ozone_profile::scaled(&profile, &altitudes, column).expect("a column");
            if band == 0 {
                lowest_at_pole = lowest_at_pole.min(scaled.factor);
            } else {
                (low, high) = (low.min(scaled.factor), high.max(scaled.factor));
            }
            let fine = simpson(0.0, 120_000.0, 4800, |z| profile.number_density(z).expect("inside")) * scaled.factor;
            grid_error = grid_error.max((fine / column - 1.0).abs());
        }
    }
    println!("McPeters-Labow: factor to the published column {low:.5} to {high:.5}, at 85 S from {lowest_at_pole:.5}");
    println!("McPeters-Labow: the grid changes a column by up to {grid_error:.1e}");
    // Between nodes the table is linear where the profile is a linear mixing ratio times falling air:
    // up to (1/7)^2 / 6 of a layer where the mixing ratio doubles over a step. Scaling takes it out.
    assert!(grid_error < 2e-3, "{grid_error}");
    // The climatology integrates with constant gravity; real gravity is 0.6 to 0.8 % less where the
    // ozone is, so the columns come out higher by that much.
    assert!(low > 0.985 && high < 0.997 && lowest_at_pole > 0.965, "{low} to {high}, {lowest_at_pole}");
    for month in &raw.ozone_arosa.columns.rows {
        let densities = ozone_profile::arosa_densities(&raw.ozone_arosa, month.column);
        let sum: f64 = raw.ozone_arosa.layers.rows.iter().zip(&densities).map(|(l, n)| n * (l.top - l.bottom)).sum();
        // Sums of six terms.
        assert!((sum / month.column - 1.0).abs() < 1e-14, "month {}", month.month);
    }
    for layer in &raw.ozone_arosa.layers.rows {
        assert!((layer.column / DOBSON_UNIT_M2 / 210.0 - layer.fraction).abs() < 6e-8, "{layer:?}");
    }
}

#[test]
fn solar_spectrum_integrates_to_its_band_irradiance() {
    let raw = raw();
    let points = raw.sun.spectrum.rows.iter().map(|row| (row.wavelength_nm, row.irradiance));
    let band = trapezoidal(points, 360.0, 830.0);
    println!("solar irradiance 360 to 830 nm: {band:.3} W m^-2");
    assert!((band - 734.8).abs() < 0.05, "734.8 W m^-2 is stated to one decimal: {band}");
}

#[test]
fn limb_darkening_is_one_at_the_centre_and_has_its_printed_mean() {
    let (mut sum_error, mut mean_error) = (0.0_f64, 0.0_f64);
    for row in &raw().sun.limb_darkening.rows {
        sum_error = sum_error.max((row.relative_intensity(1.0) - 1.0).abs());
        mean_error = mean_error.max((row.computed_disc_mean() - row.disc_mean).abs());
    }
    println!("limb darkening: sums off 1 by up to {sum_error:.1e}, means by {mean_error:.1e}");
    // Six coefficients of five decimals; means of four decimals.
    assert!(sum_error < 2.1e-5 && mean_error < 1.0e-4, "{sum_error}, {mean_error}");
}

#[test]
fn colour_matching_functions_have_their_sums() {
    let rows = raw().cie_1931.colour_matching.rows;
    let sums = [0, 1, 2].map(|i| rows.iter().map(|row| row.xyz[i]).sum::<f64>());
    println!("CIE 1931 sums: {sums:?}");
    for (sum, expected) in sums.into_iter().zip([106.865, 106.857, 106.892]) {
        assert!((sum - expected).abs() < 5e-4, "{sum} against {expected}");
    }
    let peak = rows.iter().max_by(|a, b| a.xyz[1].total_cmp(&b.xyz[1])).map(|row| row.wavelength_nm);
    assert_eq!(peak, Some(555.0));
}
