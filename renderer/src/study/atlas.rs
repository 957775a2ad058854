//! The atlas of differences: each part of the model is left out in turn, on thirty scenes.
//!
//! Both sides of a difference are found by one method without noise: usual tables, the isotropic closure where planes are asked for; or by the same paths,
//! where orders of scattering are counted.

use super::ladder::Regime;
use super::{directions, shown_apart};
use crate::atmosphere::{Depolarisation, Haze, HazePhase};
use crate::data::Data;
use crate::plan::{Atlas, Difference, Spectrum, Traits};
use crate::render::{RenderError, Sky};
use crate::sampling::Sampler;
use crate::scene::{Albedo, Scene, SunShape};
use crate::spectrum::{Between, Scheme, Wavelengths};
use crate::transport::{Fineness, Method};
use glam::DVec3;
use tables::views::{Biome, OzoneCrossSection};

/// (biome, optical depth or the type's own, albedo).
pub(super) const AIR: [(Option<Biome>, Option<f64>, f64); 5] = [
    (None, None, 0.1),
    (Some(Biome::Background), None, 0.1),
    (Some(Biome::MaritimeClean), None, 0.06),
    (Some(Biome::RemoteContinental), Some(0.15), 0.2),
    (Some(Biome::DesertDust), Some(0.4), 0.25),
];

/// (altitude in km, elevation of the sun in degrees).
pub(super) const PLACES: [(f64, f64); 6] =
    [(0.002, 60.0), (0.002, 25.0), (0.002, 8.0), (0.002, 1.0), (0.002, -4.0), (400.0, 45.0)];

/// Directions, and samples of each where paths are traced.
pub(super) const DIRECTIONS: u32 = 64;
const SAMPLES: u32 = 256;

/// A part of the model: how a scene has it, and how it is left out.
struct Term {
    name: &'static str,
    with: fn(&mut Scene),
    without: fn(&mut Scene),
}

const fn term(name: &'static str, with: fn(&mut Scene), without: fn(&mut Scene)) -> Term {
    Term { name, with, without }
}

/// Nothing beyond usual tables.
fn usual(_: &mut Scene) {}

fn closure(scene: &mut Scene) {
    (scene.method, scene.fineness, scene.steps) = (Method::Isotropic, None, Some(128));
}

fn paths(scene: &mut Scene) {
    (scene.method, scene.fineness) = (Method::Paths, None);
}

fn at(scene: &mut Scene, spectrum: Spectrum) {
    scene.wavelengths_nm = spectrum.wavelengths();
}

const TERMS: [Term; 25] = [
    term("ozone", usual, |s| s.ozone_du = Some(0.0)),
    term("ozone: the opposite month", usual, |s| s.month = (s.month + 5) % 12 + 1),
    term("ozone: latitude 5 for 45", usual, |s| s.latitude_deg = 5.0),
    term("aerosol", usual, |s| (s.biome, s.aod) = (None, None)),
    term("aerosol: humidity 50 % for 80", usual, |s| s.humidity_percent = Some(50.0)),
    term("aerosol: Henyey-Greenstein for Mie", usual, |s| s.phase = HazePhase::HenyeyGreenstein),
    term("depolarisation of air", usual, |s| s.depolarisation = Depolarisation::None),
    term("polarisation", |s| s.follow_polarisation = Some(true), usual),
    term("a round planet", closure, |s| {
        closure(s);
        s.flat = true;
    }),
    term("air above 86 km", usual, |s| s.top_km = 86.0),
    term("air above 60 km", usual, |s| s.top_km = 60.0),
    term("orders beyond the first", usual, |s| (s.method, s.fineness, s.steps) = (Method::Single, None, Some(128))),
    term("orders beyond the second", paths, |s| {
        paths(s);
        s.orders = Some(2);
    }),
    term("orders beyond the fourth", paths, |s| {
        paths(s);
        s.orders = Some(4);
    }),
    term("further orders: isotropic closure", usual, closure),
    term("light from the ground", usual, |s| s.albedo = Albedo::Grey(0.0)),
    term("the sun's disc: a point", usual, |s| s.sun_shape = SunShape::Point),
    term("limb darkening", usual, |s| s.sun_shape = SunShape::Even),
    term("wavelengths: 16 for 31", |s| at(s, Spectrum::Even31), usual),
    term("wavelengths: 8 for 16", usual, |s| at(s, Spectrum::Spread8)),
    term("wavelengths: 4 for 16", usual, |s| at(s, Spectrum::Seen4)),
    term("quadrature: a matrix of four", usual, |s| s.colour = Scheme::Four),
    term("quadrature: three as R G B", usual, |s| s.colour = Scheme::Rgb),
    term("tables: usual for fine", |s| s.fineness = Some(Fineness::Fine), usual),
    term("tables: coarse for usual", usual, |s| s.fineness = Some(Fineness::Coarse)),
];

/// What is seen of a scene.
struct Seen {
    wavelengths: Wavelengths,
    factors: Vec<Vec<f64>>,
    colours: Vec<[f64; 3]>,
}

/// Skies of an atmosphere that are made already, by the scene that they were made for.
type Skies = Vec<(Scene, Sky)>;

fn seen(
    data: &Data,
    skies: &mut Skies,
    scene: &Scene,
    first: &Scene,
    directions: &[DVec3],
) -> Result<Seen, RenderError> {
    let i = match skies.iter().position(|(known, _)| known == first) {
        Some(i) => i,
        None => {
            skies.push((first.clone(), Sky::new(first, data)?));
            skies.len() - 1
        }
    };
    let sky = &mut skies[i].1;
    sky.turn(scene)?;
    let samples = if sky.is_noiseless() { 1 } else { SAMPLES };
    let look = |(pixel, direction): (u64, &DVec3)| {
        let (mut sum, mut factors) = (vec![0.0; sky.wavelengths()], vec![0.0; sky.wavelengths()]);
        for sample in 0..samples {
            sky.radiance(*direction, &Sampler::sobol(1, pixel, 0, sample), &mut factors);
            sum.iter_mut().zip(&factors).for_each(|(sum, factor)| *sum += factor / f64::from(samples));
        }
        sum
    };
    let factors: Vec<Vec<f64>> = (0..).zip(directions).map(look).collect();
    let colours = factors.iter().map(|factors| sky.colour().xyz(factors)).collect();
    Ok(Seen { wavelengths: scene.wavelengths(), factors, colours })
}

/// Root mean squares of what differs: radiance at the wavelengths of the whole, luminance, colour.
fn change(ozone: &OzoneCrossSection, whole: &Seen, less: &Seen) -> Result<[f64; 3], RenderError> {
    let count = whole.factors.len() as f64;
    let nm = whole.wavelengths.nm();
    let between = Between::new(ozone, less.wavelengths.nm())?;
    let mut radiance = 0.0;
    for (j, &nm_j) in nm.iter().enumerate() {
        let weights = between.weights(nm_j)?;
        let filled = |factors: &Vec<f64>| weights.iter().zip(factors).map(|(w, v)| w * v).sum::<f64>();
        let mean = whole.factors.iter().map(|factors| factors[j]).sum::<f64>() / count;
        let square = whole.factors.iter().zip(&less.factors).map(|(a, b)| (a[j] - filled(b)).powi(2)).sum::<f64>();
        radiance += square / count / (mean * mean) / nm.len() as f64;
    }
    let [luminance, colour] = shown_apart(&whole.colours, &less.colours, &vec![1.0 / count; whole.colours.len()]);
    Ok([radiance.sqrt(), luminance, colour])
}

/// Makes the atlas on the current thread pool.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn make(data: &Data, progress: &(dyn Fn(f64) + Sync)) -> Result<Atlas, RenderError> {
    let mut rows = Vec::new();
    let total = (AIR.len() * TERMS.len()) as f64;
    for (a, (biome, aod, albedo)) in AIR.into_iter().enumerate() {
        let mut skies = Skies::new();
        let base = Scene {
            follow_polarisation: Some(false),
            biome,
            aod,
            albedo: Albedo::Grey(albedo),
            fineness: Some(Fineness::Usual),
            sun_disc: false,
            width: Some(1),
            height: Some(1),
            ..Scene::default()
        };
        for (t, term) in TERMS.iter().enumerate() {
            for (altitude_km, sun_elevation_deg) in PLACES {
                let scene = Scene { altitude_km, sun_elevation_deg, ..base.clone() };
                let changed = |change: fn(&mut Scene), mut scene: Scene| {
                    change(&mut scene);
                    scene
                };
                let [whole, less] = [term.with, term.without].map(|change| changed(change, scene.clone()));
                // What says nothing of clear air, or has no plane below the sun.
                let says_nothing = biome.is_none() && term.name.starts_with("aerosol");
                if says_nothing || whole.validate().is_err() || less.validate().is_err() {
                    continue;
                }
                // Skies are made for the first place, and turned.
                let first = Scene { altitude_km: PLACES[0].0, sun_elevation_deg: PLACES[0].1, ..base.clone() };
                let [first_whole, first_less] = [term.with, term.without].map(|change| changed(change, first.clone()));
                let looks = directions(&scene, DIRECTIONS);
                let whole = seen(data, &mut skies, &whole, &first_whole, &looks)?;
                let less = seen(data, &mut skies, &less, &first_less, &looks)?;
                let sky = &skies[0].1;
                let depth = sky.air().haze().map_or(0.0, Haze::optical_depth);
                rows.push(Difference {
                    term: term.name.into(),
                    regime: Regime::of(&scene, depth).name().into(),
                    traits: Traits::of(&scene, sky),
                    change: change(&data.ozone_cross_section, &whole, &less)?,
                });
            }
            progress((a * TERMS.len() + t + 1) as f64 / total);
        }
    }
    let place = |name: &str| TERMS.iter().position(|term| term.name == name);
    rows.sort_by_key(|row| place(&row.term));
    Ok(Atlas { rows })
}

/// For people: of each term the medians over the scenes of each regime, luminance and colour.
#[must_use]
pub fn summary(atlas: &Atlas) -> Vec<String> {
    let regimes = Regime::ALL.map(Regime::name);
    let mut lines =
        vec![format!("{:<36}{}", "luminance / %, CIEDE2000", regimes.map(|name| format!("{name:>18}")).concat())];
    for term in &TERMS {
        let cells = regimes.map(|regime| {
            let of = |i: usize| {
                let same = atlas.rows.iter().filter(|row| row.term == term.name && row.regime == regime);
                let mut values: Vec<f64> = same.map(|row| row.change[i]).collect();
                values.sort_by(f64::total_cmp);
                values.get(values.len() / 2).copied()
            };
            match (of(1), of(2)) {
                (Some(luminance), Some(colour)) => format!("{:>10.2} {colour:>7.2}", 100.0 * luminance),
                _ => String::new(),
            }
        });
        lines.push(format!("{:<36}{}", term.name, cells.map(|cell| format!("{cell:>18}")).concat()));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn terms_have_names_of_their_own_and_make_valid_scenes() {
        let names: std::collections::BTreeSet<_> = TERMS.iter().map(|term| term.name).collect();
        assert_eq!(names.len(), TERMS.len());
        for term in &TERMS {
            assert!(!term.name.contains(','), "a field of a CSV file");
            for change in [term.with, term.without] {
                let mut scene = Scene {
                    biome: Some(Biome::Rural),
                    fineness: Some(Fineness::Usual),
                    width: Some(1),
                    ..Scene::default()
                };
                change(&mut scene);
                scene.validate().expect("valid");
            }
        }
    }

    #[test]
    fn changes_are_over_means() {
        let of = |factor: f64| Seen {
            wavelengths: Wavelengths::default(),
            factors: vec![vec![factor; 16], vec![2.0 * factor; 16]],
            colours: vec![[factor; 3], [2.0 * factor; 3]],
        };
        let [radiance, luminance, colour] = change(&crate::test_data::light().2, &of(1.0), &of(1.1)).expect("in range");
        // sqrt((0.1^2 + 0.2^2) / 2) over 1.5.
        assert!((radiance - 0.025_f64.sqrt() / 1.5).abs() < 1e-12 && (luminance - radiance).abs() < 1e-12);
        assert!(colour > 0.5);
    }
}
