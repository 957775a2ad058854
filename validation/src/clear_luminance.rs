//! Luminance and illuminance of clear skies beside formulas of lighting engineering.
//!
//! Illuminances: IES 1984 (Recommended practice for the calculation of daylight availability, J. Illum. Eng. Soc. 13, 381), clear sky, fits to
//! measurements over years: the sun on a surface that faces it 127.5 klx exp(-0.21 / sin h), the sky on the level
//! 0.8 + 15.5 sin^0.5 h klx, h the sun's elevation. They are means; a single clear sky may be half or twice as bright in what the sky gives, and its
//! turbidity moves the sun by some 20 %. No uncertainty is stated.
//!
//! Distributions: the luminance over that of the zenith, beside the CIE standard clear sky (type 12 of CIE S 011/E:2003) and the all-weather model of
//! Perez et al. 1993, both as [`renderer::transport::rungs`] has them. Neither states an uncertainty.

use crate::judge::{percent, spread};
use crate::{Context, Section, ValidationError, Verdict};
use glam::DVec3;
use renderer::camera::direction_at;
use renderer::render::{Sky, Summary};
use renderer::sampling::Sampler;
use renderer::scene::Scene;
use renderer::study::{Chart, Point};
use renderer::transport::Method;
use std::sync::atomic::AtomicBool;
use tables::views::Biome;

/// Elevations of the sun in degrees.
const SUNS: [f64; 7] = [10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0];

/// Airs.
const AIRS: [(&str, Option<Biome>); 2] = [("clear air", None), ("rural aerosol, its own amount", Some(Biome::Rural))];

/// Directions nearer to the sun than so many degrees are left out of distributions.
const NEAR_DEG: f64 = 10.0;

/// Where distributions are compared: elevations from 10 to 80 degrees, azimuths every 30.
fn directions(sun: DVec3) -> Vec<DVec3> {
    let all = (1..=8).flat_map(|i| (0..12).map(move |k| (10.0 * f64::from(i), 30.0 * f64::from(k))));
    let all = all.map(|(elevation, azimuth): (f64, f64)| direction_at(azimuth.to_radians(), elevation.to_radians()));
    all.filter(|direction| direction.angle_between(sun).to_degrees() >= NEAR_DEG).collect()
}

/// Luminances in cd/m^2.
fn luminances(sky: &Sky, directions: &[DVec3]) -> Vec<f64> {
    let of = |&direction: &DVec3| {
        let mut values = vec![0.0; sky.values()];
        sky.radiance(direction, &Sampler::new(0, 0, 0), &mut values);
        sky.colour().xyz(&values)[1]
    };
    directions.iter().map(of).collect()
}

/// Computes the section.
///
/// # Errors
/// [`ValidationError`] if a sky cannot be computed.
pub fn make(context: &Context<'_>) -> Result<Section, ValidationError> {
    let mut section = Section::default();
    section.say(
        "Compared: illuminance by the sky and by the sun, luminance of the zenith, and the distribution of luminance over the dome. References: the \
         formulas of IES 1984 for clear skies (means of many; single skies are half to twice as bright), the CIE standard clear sky (type 12) and \
         Perez et al. 1993, each over its own zenith. None states an uncertainty, and none knows the aerosol of a sky: the figures stand for themselves.",
    );
    let mut points = Vec::new();
    for (k, (name, biome)) in AIRS.into_iter().enumerate() {
        let (mut rows, mut sky_errors, mut sun_errors) = (Vec::new(), Vec::new(), Vec::new());
        let mut shapes = [Vec::new(), Vec::new()];
        let scene =
            |elevation: f64, method: Method| Scene { sun_elevation_deg: elevation, biome, method, ..Scene::default() };
        let mut sky = Sky::new(&scene(SUNS[0], Method::Solved), context.data)?;
        for (i, elevation) in SUNS.into_iter().enumerate() {
            sky.turn(&scene(elevation, Method::Solved))?;
            let summary = Summary::new(&sky, 0, &AtomicBool::new(false));
            let normal = sky.colour().xyz(&sky.direct_irradiance_of(sky.sun_direction()))[1];
            let sine = elevation.to_radians().sin();
            let (ies_sky, ies_sun) = (800.0 + 15_500.0 * sine.sqrt(), 127_500.0 * (-0.21 / sine).exp());
            let looks = directions(sky.sun_direction());
            let ours = luminances(&sky, &looks);
            let mut row = vec![
                format!("{elevation}"),
                format!("{:.1}", summary.sky_lux.mean / 1e3),
                format!("{:.1}", ies_sky / 1e3),
                percent(summary.sky_lux.mean / ies_sky - 1.0, 0),
                format!("{:.1}", normal / 1e3),
                format!("{:.1}", ies_sun / 1e3),
                percent(normal / ies_sun - 1.0, 0),
                format!("{:.2}", summary.zenith_cd_m2.mean / 1e3),
            ];
            for (shape, method) in shapes.iter_mut().zip([Method::Cie, Method::Perez]) {
                let fitted = Sky::new(&scene(elevation, method), context.data)?;
                let theirs = luminances(&fitted, &looks);
                let zenith = luminances(&fitted, &[DVec3::Z])[0];
                let differences: Vec<f64> = ours
                    .iter()
                    .zip(&theirs)
                    .map(|(our, their)| our / summary.zenith_cd_m2.mean / (their / zenith) - 1.0)
                    .collect();
                let (_, bias, rms, _) = spread(differences.iter().copied());
                row.push(format!("{}, {:.0}", percent(bias, 0), 100.0 * rms));
                shape.extend(differences);
            }
            let mut point = |panel, curve: &str, value: f64| {
                points.push(Point { panel, curve: curve.into(), at: [elevation, value] })
            };
            point("sky / klx", name, summary.sky_lux.mean / 1e3);
            point("sun, facing it / klx", name, normal / 1e3);
            point("zenith / kcd m^-2", name, summary.zenith_cd_m2.mean / 1e3);
            if k == 0 {
                point("sky / klx", "IES 1984", ies_sky / 1e3);
                point("sun, facing it / klx", "IES 1984", ies_sun / 1e3);
            }
            rows.push(row);
            sky_errors.push(summary.sky_lux.mean / ies_sky - 1.0);
            sun_errors.push(normal / ies_sun - 1.0);
            (context.progress)((k as f64 + (i + 1) as f64 / SUNS.len() as f64) / AIRS.len() as f64);
        }
        section.say(&format!(
            "### {}{}\n\nThe last columns: bias and rms over the dome, {NEAR_DEG} degrees and more from the sun, of the luminance over that of the zenith.",
            name[..1].to_uppercase(),
            &name[1..]
        ));
        section.table(
            &[
                "sun / degrees",
                "sky / klx",
                "IES",
                "difference %",
                "sun, facing it / klx",
                "IES",
                "difference %",
                "zenith / kcd m^-2",
                "beside CIE 12: bias, rms %",
                "beside Perez: bias, rms %",
            ],
            &rows,
        );
        let ([_, cie_rms], [_, perez_rms]) = (
            {
                let (_, b, r, _) = spread(shapes[0].iter().copied());
                [b, r]
            },
            {
                let (_, b, r, _) = spread(shapes[1].iter().copied());
                [b, r]
            },
        );
        let ((count, sky_bias, sky_rms, _), (_, sun_bias, sun_rms, _)) = (spread(sky_errors), spread(sun_errors));
        section.find(
            format!("illuminance, {name}"),
            format!(
                "{count} suns: sky bias {} %, rms {:.0} %; sun bias {} %, rms {:.0} %",
                percent(sky_bias, 0),
                100.0 * sky_rms,
                percent(sun_bias, 0),
                100.0 * sun_rms
            ),
            "IES 1984",
            Verdict::Unstated,
        );
        section.find(
            format!("distribution of luminance, {name}"),
            format!("rms {:.0} % beside CIE type 12, {:.0} % beside Perez", 100.0 * cie_rms, 100.0 * perez_rms),
            "CIE S 011/E:2003; Perez et al. 1993",
            Verdict::Unstated,
        );
    }
    points.sort_by_key(|point| {
        ["sky / klx", "sun, facing it / klx", "zenith / kcd m^-2"].iter().position(|panel| *panel == point.panel)
    });
    let title = "Clear skies over the sun's elevation".into();
    section.chart("luminance", Chart { title, axes: ["sun elevation / degrees", "illuminance or luminance"], points });
    Ok(section)
}
