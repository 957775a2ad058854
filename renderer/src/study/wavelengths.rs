//! How many wavelengths a colour takes, and what is best taken for the spectrum between them.
//!
//! The skies of the [atlas](super::atlas), from coarse tables at every nanometre from 360 to 830: what is right is their integral, and few
//! wavelengths are some of them.

use super::atlas::{AIR, DIRECTIONS, PLACES};
use super::{Chart, Point, cubic, directions, shown_apart};
use crate::data::Data;
use crate::plan::Spectrum;
use crate::render::{RenderError, Sky};
use crate::sampling::Sampler;
use crate::scene::{Albedo, Scene, SceneError};
use crate::spectrum::{Colour, Wavelengths};
use crate::transport::Fineness;

/// Of the tables, in nm.
const FIRST_NM: f64 = 360.0;
const LAST_NM: f64 = 830.0;

/// Even wavelengths from 380 to 780 nm.
const COUNTS: [usize; 8] = [4, 6, 8, 11, 16, 24, 31, 61];

/// Names of the panels: luminance and colour by day, with a low sun, in twilight.
const PANELS: [[&str; 2]; 3] = [
    ["day: luminance / %", "day: CIEDE2000"],
    ["low sun: luminance / %", "low sun: CIEDE2000"],
    ["twilight: luminance / %", "twilight: CIEDE2000"],
];

/// Which of them each of [`PLACES`] is in: the sun at 60, 25, 8, 1 and -4 degrees, and day seen from space.
const PANEL: [usize; PLACES.len()] = [0, 0, 1, 1, 2, 0];

/// A way to a colour: its curve and abscissa, the wavelengths it looks at, and what it makes of them.
struct Way {
    curve: &'static str,
    wavelengths: Wavelengths,
    colour: Colour,
}

/// What is right, and all that are compared.
fn ways(data: &Data) -> Result<(Way, Vec<Way>), RenderError> {
    let terms = Colour::terms(&data.sun, &data.observer)?;
    let cubics = |wavelengths: &Wavelengths| {
        let mut weights = vec![[0.0; 3]; wavelengths.nm().len()];
        for (nm, seen) in &terms {
            let (first, shares) = cubic(wavelengths.nm(), *nm);
            for (weight, share) in weights[first..].iter_mut().zip(shares) {
                weight.iter_mut().zip(seen).for_each(|(w, c)| *w += share * c);
            }
        }
        Colour::weighed(weights)
    };
    let of = |wavelengths: &Wavelengths| Colour::new(&data.sun, &data.observer, &data.ozone_cross_section, wavelengths);
    let count = (LAST_NM - FIRST_NM) as u32 + 1;
    let all = Wavelengths::new((0..count).map(|i| FIRST_NM + f64::from(i)).collect()).map_err(SceneError::from)?;
    let whole = Way { curve: "every nanometre", colour: cubics(&all), wavelengths: all };
    let mut ways = Vec::new();
    for count in COUNTS {
        let even = Wavelengths::visible(count).map_err(SceneError::from)?;
        ways.push(Way { curve: "even, cubics between", colour: cubics(&even), wavelengths: even });
    }
    for count in COUNTS {
        let even = Wavelengths::visible(count).map_err(SceneError::from)?;
        ways.push(Way { curve: "even, as spectra of the sky are", colour: of(&even)?, wavelengths: even });
    }
    for chosen in [Spectrum::Seen4, Spectrum::Seen8] {
        let few = chosen.wavelengths();
        ways.push(Way { curve: "chosen, as spectra of the sky are", colour: of(&few)?, wavelengths: few });
    }
    Ok((whole, ways))
}

/// The chart: of each way the rms over the skies of what it is off.
///
/// # Errors
/// [`RenderError`] if the data do not have what it takes.
pub fn make(data: &Data, progress: &(dyn Fn(f64) + Sync)) -> Result<Chart, RenderError> {
    let (all, few) = ways(data)?;
    let mut squares = vec![[[0.0; 2]; PANELS.len()]; few.len()];
    for (a, (biome, aod, albedo)) in AIR.into_iter().enumerate() {
        let scene = |(altitude_km, sun_elevation_deg)| Scene {
            biome,
            aod,
            albedo: Albedo::Grey(albedo),
            fineness: Some(Fineness::Coarse),
            follow_polarisation: Some(false),
            sun_disc: false,
            width: Some(1),
            height: Some(1),
            wavelengths_nm: all.wavelengths.clone(),
            altitude_km,
            sun_elevation_deg,
            ..Scene::default()
        };
        let mut sky = Sky::new(&scene(PLACES[0]), data)?;
        for (place, panel) in PLACES.into_iter().zip(PANEL) {
            let share = 1.0 / (AIR.len() * PANEL.into_iter().filter(|&other| other == panel).count()) as f64;
            let scene = scene(place);
            sky.turn(&scene)?;
            let mut looked = Vec::new();
            for direction in directions(&scene, DIRECTIONS) {
                let mut factors = vec![0.0; sky.wavelengths()];
                sky.radiance(direction, &Sampler::new(0, 0, 0), &mut factors);
                looked.push(factors);
            }
            let right: Vec<[f64; 3]> = looked.iter().map(|factors| all.colour.xyz(factors)).collect();
            for (way, squares) in few.iter().zip(&mut squares) {
                let of = |factors: &Vec<f64>| {
                    let at = |&nm: &f64| {
                        let (i, share) = ((nm - FIRST_NM) as usize, (nm - FIRST_NM).fract());
                        (1.0 - share) * factors[i] + share * factors[(i + 1).min(factors.len() - 1)]
                    };
                    way.colour.xyz(&way.wavelengths.nm().iter().map(at).collect::<Vec<_>>())
                };
                let even = vec![1.0 / right.len() as f64; right.len()];
                let off = shown_apart(&right, &looked.iter().map(of).collect::<Vec<_>>(), &even);
                squares[panel].iter_mut().zip(off).for_each(|(sum, off)| *sum += share * off * off);
            }
        }
        progress((a + 1) as f64 / AIR.len() as f64);
    }
    let mut points = Vec::new();
    for metric in 0..2 {
        for (p, panels) in PANELS.into_iter().enumerate() {
            for (way, squares) in few.iter().zip(&squares) {
                let off = squares[p][metric].sqrt() * if metric == 0 { 100.0 } else { 1.0 };
                let at = [way.wavelengths.nm().len() as f64, off];
                points.push(Point { panel: panels[metric], curve: way.curve.to_owned(), at });
            }
        }
    }
    Ok(Chart {
        title: "Colours from few wavelengths: what they are off in five atmospheres".to_owned(),
        axes: ["number of wavelengths", "rms error / % or CIEDE2000"],
        points,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_makes_the_same_of_a_constant() {
        let data = Data::load(&std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
        let (all, few) = ways(&data).expect("in range");
        for way in &few {
            for (found, right) in way.colour.white().into_iter().zip(all.colour.white()) {
                // Rounding only.
                assert!((found / right - 1.0).abs() < 1e-12, "{} {}", way.curve, way.wavelengths.nm().len());
            }
        }
    }
}
