//! The zenith in twilight beside Patat, Ugolnikov & Postylyakov 2006 (A&A 455, 385): surface brightness over Cerro Paranal in the bands U, B, V, R and I, by
//! parabolas in the sun's zenith angle from 95 to 105 degrees.
//!
//! The magnitude of a square second of arc is that of the sun, less 2.5 log10 of the light that comes from it over the light that comes
//! from the sun above the air: m = m_sun - 2.5 log10(f omega), f the radiance factor in sr^-1, omega = 2.3504e-11 sr. V of the sun is -26.76 (Torres 2010, AJ
//! 140, 1158), its colours are those that Patat et al. quote: U-B 0.13, B-V 0.65, V-R 0.52, V-I 0.81. A band is the mean of f at three wavelengths, its
//! middle and half a width to either side by 1 : 2 : 1 (Bessell 2005, ARA&A 43, 293: effective wavelengths and widths), which costs some 0.05 mag.
//!
//! Airlight has no airglow, no stars, no zodiacal light and no third light of towns: the comparison ends at 10 degrees of depression. The
//! ground there is the sphere at sea level, the observer 2.635 km above it; ozone is that of the climatology in June at 24.6 S.

use crate::judge::{spread, within};
use crate::references::{Sheet, path};
use crate::{Context, Section, ValidationError, Verdict};
use glam::DVec3;
use renderer::render::Sky;
use renderer::sampling::Sampler;
use renderer::scene::{Albedo, Scene};
use renderer::spectrum::Wavelengths;
use renderer::study::{Chart, Point};
use renderer::transport::Fineness;
use tables::views::Biome;

/// Bands: name, middle and width in nm, magnitude of the sun.
const BANDS: [(&str, f64, f64, f64); 5] = [
    ("U", 366.0, 65.0, -25.98),
    ("B", 436.0, 89.0, -26.11),
    ("V", 545.0, 84.0, -26.76),
    ("R", 641.0, 158.0, -27.28),
    ("I", 798.0, 154.0, -27.57),
];

/// A square second of arc in sr.
const SQUARE_SECOND: f64 = 2.3504e-11;

/// Depressions of the sun in degrees.
const DEPRESSIONS: [f64; 6] = [5.0, 6.0, 7.0, 8.0, 9.0, 10.0];

/// Airs: name, aerosol and its optical depth from sea level.
const AIRS: [(&str, Option<(Biome, f64)>); 2] =
    [("clear", None), ("remote continental 0.05", Some((Biome::RemoteContinental, 0.05)))];

/// Uncertainties in magnitudes that are not the observations': of the sun, and of bands by three wavelengths.
const OURS: f64 = 0.06;

/// Brightness of the zenith in the bands, mag arcsec^-2.
fn zenith(context: &Context<'_>, air: Option<(Biome, f64)>) -> Result<Vec<[f64; 5]>, ValidationError> {
    let mut nm: Vec<f64> =
        BANDS.iter().flat_map(|&(_, middle, width, _)| [middle - 0.5 * width, middle, middle + 0.5 * width]).collect();
    let order = nm.clone();
    nm.sort_by(f64::total_cmp);
    let scene = |depression: f64| -> Result<Scene, ValidationError> {
        Ok(Scene {
            altitude_km: 2.635,
            sun_elevation_deg: -depression,
            latitude_deg: -24.6,
            albedo: Albedo::Grey(0.15),
            biome: air.map(|air| air.0),
            aod: air.map(|air| air.1),
            wavelengths_nm: Wavelengths::new(nm.clone())?,
            follow_polarisation: Some(true),
            fineness: Some(if context.quick { Fineness::Usual } else { Fineness::Fine }),
            width: Some(16),
            height: Some(16),
            ..Scene::default()
        })
    };
    let mut sky = Sky::new(&scene(DEPRESSIONS[0])?, context.data)?;
    let mut all = Vec::new();
    for depression in DEPRESSIONS {
        sky.turn(&scene(depression)?)?;
        let mut factors = vec![0.0; nm.len()];
        sky.radiance(DVec3::Z, &Sampler::new(0, 0, 0), &mut factors);
        let at = |wanted: f64| nm.iter().position(|&nm| nm == wanted).map_or(f64::NAN, |i| factors[i]);
        all.push(std::array::from_fn(|b| {
            let factor = 0.25 * (at(order[3 * b]) + 2.0 * at(order[3 * b + 1]) + at(order[3 * b + 2]));
            BANDS[b].3 - 2.5 * (factor * SQUARE_SECOND).log10()
        }));
    }
    Ok(all)
}

/// Computes the section.
///
/// # Errors
/// [`ValidationError`] if the reference cannot be read, or a sky not be solved.
pub fn make(context: &Context<'_>) -> Result<Section, ValidationError> {
    let sheet = Sheet::read(&path(context.root, "twilight-zenith.csv"))?;
    let mut section = Section::default();
    section.say(&format!(
        "Compared: surface brightness of the zenith, magnitudes of a square second of arc, with the sun 5 to 10 degrees below the horizon. Reference: \
         observations at Cerro Paranal, 2635 m (Patat et al. 2006, table 1), uncertain by the rms of the observations about the fit, 0.12 to 0.40 mag; ours by \
         {OURS} mag for the magnitude of the sun and the width of the bands. Airlight has no airglow, stars or zodiacal light: near 10 degrees the \
         observations contain them (22.3, 22.6, 21.6, 20.9, 19.7 mag at night), by these numbers 1 to 7 % of their light there."
    ));
    let mut points = Vec::new();
    for (k, (name, air)) in AIRS.into_iter().enumerate() {
        let found = zenith(context, air)?;
        let (mut rows, mut failing, mut differences, mut z_squares) = (Vec::new(), Vec::new(), Vec::new(), 0.0);
        for (b, &(band, ..)) in BANDS.iter().enumerate() {
            let number = |column: &str| sheet.number(b, column);
            let (a, sigma) = ([number("a0")?, number("a1")?, number("a2")?], number("sigma")?.hypot(OURS));
            let mut row = vec![band.to_owned()];
            let mut here = Vec::new();
            for (i, depression) in DEPRESSIONS.into_iter().enumerate() {
                let x = depression - 5.0;
                let reference = a[0] + x * (a[1] + x * a[2]);
                let difference = found[i][b] - reference;
                row.push(format!("{:.2} ({difference:+.2})", found[i][b]));
                here.push(difference);
                z_squares += (difference / sigma).powi(2);
                let point = |curve: String, y| Point { panel: band, curve, at: [depression, y] };
                points.push(point(name.to_owned(), found[i][b]));
                if k == 0 {
                    points.push(point("Patat et al. 2006".into(), reference));
                }
                if !within(difference, 2.0 * sigma) {
                    failing.push(format!(
                        "{band} at {depression} degrees: {difference:+.2} mag, {:+.1} uncertainties",
                        difference / sigma
                    ));
                }
            }
            let slope = (found[5][b] - found[0][b]) / 5.0;
            let (_, bias, ..) = spread(here.iter().copied());
            row.push(format!("{bias:+.2}"));
            row.push(format!("{slope:.2}, {:.2}", number("slope")?));
            differences.extend(here);
            rows.push(row);
        }
        section.say(&format!("### {name}\n\nFound, and the difference from the observations (positive: fainter); slopes in mag a degree from 5 to 10, found and observed."));
        let header = DEPRESSIONS.map(|d| format!("{d} degrees"));
        let mut names = vec!["band"];
        names.extend(header.iter().map(String::as_str));
        names.extend(["mean difference", "slopes"]);
        section.table(&names, &rows);
        crate::mie::fails(&mut section, &failing);
        let (count, bias, rms, worst) = spread(differences);
        section.find(
            format!("zenith in twilight, 5 to 10 degrees, {name}"),
            format!(
                "{count} values: bias {bias:+.2} mag, rms {rms:.2}, worst {worst:+.2}, rms z {:.2}; {} beyond two uncertainties",
                (z_squares / f64::from(count as u32)).sqrt(),
                failing.len()
            ),
            "Patat et al. 2006",
            Verdict::of(failing.is_empty()),
        );
        (context.progress)((k + 1) as f64 / AIRS.len() as f64);
    }
    points.sort_by_key(|point| BANDS.iter().position(|band| band.0 == point.panel));
    let title = "Surface brightness of the zenith in twilight".into();
    section.chart(
        "twilight",
        Chart { title, axes: ["depression of the sun / degrees", "mag / square second of arc"], points },
    );
    Ok(section)
}
