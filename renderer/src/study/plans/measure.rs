//! What every candidate is off and costs on the scenes of one atmosphere.
//!
//! Transfers are compared at eight wavelengths ([`Spectrum::Spread8`]), since what a grid is off varies slowly with wavelength; the spectrum between them is that of
//! coarse tables at 31. With U(lambda) the latter and G(lambda_k) another transfer at the eight, G(lambda) = U(lambda) r(lambda) with r the cubic through
//! G / U at the eight; U is 1 in directions in which coarse tables are dark. The truth is T, of the finest polarised tables. What polarisation changes hardly depends on the grid: of all but the two coarsest grids
//! only polarised tables are solved, and radiances, times and looks without it follow by the ratios of light tables.

use super::scenes::Set;
use crate::clock::thread_s;
use crate::data::Data;
use crate::plan::{Candidate, Costs, Row, SPECTRUM, Spectrum, TRANSFERS, Traits, Transfer};
use crate::render::{RenderError, Sky};
use crate::sampling::Sampler;
use crate::scene::Scene;
use crate::spectrum::{Between, Colour, Wavelengths};
use crate::study::{cubic, shown_apart, towards_light};
use crate::transport::{Fineness, Method};
use glam::DVec3;

/// Radiance factors in sr^-1: of each direction, at each wavelength.
type Factors = Vec<Vec<f64>>;

/// What `work` gives, and the seconds that it takes this thread.
fn timed<T>(work: impl FnOnce() -> T) -> (T, f64) {
    let before = thread_s();
    let made = work();
    (made, thread_s() - before)
}

/// For how long looks are timed, and how many at most.
const LEAST_S: f64 = 0.015;
const MOST_LOOKS: usize = 2000;

/// A sky of an atmosphere, turned from scene to scene.
struct Turned {
    sky: Sky,
    solve_s: f64,
}

impl Turned {
    fn new(data: &Data, scene: &Scene) -> Result<Self, RenderError> {
        // Of one pixel, so that nothing is looked at yet.
        let scene = Scene { width: Some(1), height: Some(1), ..scene.clone() };
        let (sky, solve_s) = timed(|| Sky::new(&scene, data));
        Ok(Self { sky: sky?, solve_s })
    }

    /// What is seen of a scene in some directions, and the seconds of a look, a mean over even ones.
    fn look(&mut self, scene: &Scene, directions: &[DVec3], even: &[DVec3]) -> Result<(Factors, f64), RenderError> {
        self.sky.turn(&Scene { width: Some(1), height: Some(1), ..scene.clone() })?;
        let sampler = Sampler::new(0, 0, 0);
        let look = |direction: &DVec3| {
            let mut factors = vec![0.0; self.sky.wavelengths()];
            self.sky.radiance(*direction, &sampler, &mut factors);
            factors
        };
        let seen: Factors = directions.iter().map(look).collect();
        let (mut seconds, mut looks) = (0.0, 0);
        // The clock goes in steps of some thousandths.
        while seconds < LEAST_S && looks < MOST_LOOKS {
            seconds += timed(|| even.iter().map(look).collect::<Factors>()).1;
            looks += even.len();
        }
        Ok((seen, seconds / looks as f64))
    }
}

/// Weights of colour, of each spectrum in the order of [`Spectrum::ALL`].
struct Eyes {
    whole: Colour,
    /// Of each wavelength of the whole, the cubic through ratios at the eight.
    ratios: Vec<(usize, [f64; 4])>,
    spectra: Vec<Eye>,
}

/// What one of them makes of values at its places of the whole.
struct Eye {
    places: Vec<usize>,
    colour: Colour,
    /// Of each wavelength of the whole, the weights of the values.
    between: Vec<Vec<f64>>,
}

impl Eye {
    /// All of the whole.
    fn filled(&self, values: &[f64]) -> Vec<f64> {
        let at = |weights: &Vec<f64>| weights.iter().zip(values).map(|(w, v)| w * v).sum();
        self.between.iter().map(at).collect()
    }
}

impl Eyes {
    fn new(data: &Data) -> Result<Self, RenderError> {
        let whole = Wavelengths::visible(SPECTRUM).unwrap_or_default();
        let ozone = &data.ozone_cross_section;
        let of = |wavelengths: &Wavelengths| Colour::new(&data.sun, &data.observer, ozone, wavelengths);
        let eye = |one: Spectrum| {
            let wavelengths = one.wavelengths();
            let between = Between::new(ozone, wavelengths.nm())?;
            let between = whole.nm().iter().map(|&nm| between.weights(nm)).collect::<Result<_, _>>()?;
            Ok(Eye { places: one.places(), colour: of(&wavelengths)?, between })
        };
        let spectra = Spectrum::ALL.into_iter().map(eye).collect::<Result<_, RenderError>>()?;
        let eight = Spectrum::Spread8.wavelengths();
        let ratios = whole.nm().iter().map(|&nm| cubic(eight.nm(), nm)).collect();
        Ok(Self { whole: of(&whole)?, ratios, spectra })
    }

    fn eye(&self, spectrum: Spectrum) -> &Eye {
        &self.spectra[spectrum as usize]
    }

    /// A transfer's factors at the whole spectrum, from those at the eight; where the usual ones are not all bright, the cubic through these.
    fn whole(&self, usual: &Factors, eight: &Factors) -> Factors {
        let places = &self.eye(Spectrum::Spread8).places;
        let even = vec![1.0; SPECTRUM];
        let one = |(usual, eight): (&Vec<f64>, &Vec<f64>)| {
            let usual = if usual.iter().all(|light| *light > 0.0) { usual } else { &even };
            let ratio = |(&place, &value): (&usize, &f64)| value / usual[place];
            let ratios: Vec<f64> = places.iter().zip(eight).map(ratio).collect();
            let at = |(u, (first, weights)): (&f64, &(usize, [f64; 4]))| {
                u * weights.iter().zip(&ratios[*first..]).map(|(w, r)| w * r).sum::<f64>()
            };
            usual.iter().zip(&self.ratios).map(at).collect()
        };
        usual.iter().zip(eight).map(one).collect()
    }

    /// What a transfer at one of the spectra is off: radiance, luminance, colour; `shares` are those of directions.
    fn errors(&self, (truth, shares): (&Factors, &[f64]), found: &Factors, spectrum: Spectrum) -> [f64; 3] {
        let eye = self.eye(spectrum);
        let few: Factors = found.iter().map(|factors| eye.places.iter().map(|&i| factors[i]).collect()).collect();
        let filled: Factors = few.iter().map(|factors| eye.filled(factors)).collect();
        let mut radiance = 0.0;
        let kept = Spectrum::Even16.places();
        for &j in &kept {
            let mean = truth.iter().zip(shares).map(|(t, share)| share * t[j]).sum::<f64>();
            let all = truth.iter().zip(&filled).zip(shares);
            let square = all.map(|((t, f), share)| share * (t[j] - f[j]).powi(2)).sum::<f64>();
            radiance += square / (mean * mean) / kept.len() as f64;
        }
        let right: Vec<[f64; 3]> = truth.iter().map(|factors| self.whole.xyz(factors)).collect();
        let seen: Vec<[f64; 3]> = few.iter().map(|factors| eye.colour.xyz(factors)).collect();
        let [luminance, colour] = shown_apart(&right, &seen, shares);
        [radiance.sqrt(), luminance, colour]
    }
}

/// Even directions, in which looks are timed and paths are traced.
const EVEN: u32 = 64;

/// Samples of a path in each direction, to see how far they spread.
const PATHS: u32 = 8;

/// Side of the picture whose looks are counted, and every which pixel each way is timed.
const SIDE: u32 = 256;
const STEP: usize = 4;

/// Whether a transfer is not solved, but follows from the one with polarisation.
fn follows(one: Transfer) -> bool {
    !one.polarised && !matches!(one.fineness, None | Some(Fineness::Coarse | Fineness::Light))
}

/// Measures the scenes of an atmosphere.
pub(super) fn measure(
    data: &Data,
    set: Set,
    number: usize,
    scenes: &[Scene],
    step: &dyn Fn(f64),
) -> Result<Vec<Row>, RenderError> {
    let eyes = Eyes::new(data)?;
    let eight = Spectrum::Spread8.wavelengths();
    let at = |transfer: Transfer, wavelengths: &Wavelengths| {
        Turned::new(data, &Scene { wavelengths_nm: wavelengths.clone(), ..transfer.of(&scenes[0]) })
    };
    let table = |fineness, polarised| Transfer { fineness: Some(fineness), polarised };
    let paths = Scene { method: Method::Paths, follow_polarisation: Some(true), ..scenes[0].clone() };
    // Besides: the truth, and coarse tables at all wavelengths and at four.
    let solutions = 3 + TRANSFERS.into_iter().filter(|one| !follows(*one)).count();
    let mut done = 0.0;
    let mut made = |transfer, wavelengths: &Wavelengths| {
        let made = at(transfer, wavelengths);
        done += 1.0;
        step(done / solutions as f64);
        made
    };
    let mut truth = made(table(Fineness::Finest, true), &eight)?;
    let mut whole = made(table(Fineness::Coarse, false), &Wavelengths::visible(SPECTRUM).unwrap_or_default())?;
    let mut four = made(table(Fineness::Coarse, false), &Spectrum::Seen4.wavelengths())?;
    let mut transfers = Vec::new();
    for one in TRANSFERS {
        transfers.push(if follows(one) { None } else { Some(made(one, &eight)?) });
    }
    let mut paths = Turned::new(data, &paths)?;
    let mut rows = Vec::new();
    for scene in scenes {
        let (directions, shares): (Vec<DVec3>, Vec<f64>) = towards_light(scene, set.directions()).into_iter().unzip();
        let even = crate::study::directions(scene, EVEN);
        let (detail, whole_look_s) = whole.look(scene, &directions, &even)?;
        let (_, four_look_s) = four.look(scene, &directions, &even)?;
        let right = eyes.whole(&detail, &truth.look(scene, &directions, &even)?.0);
        let mut looked: Vec<Option<(Factors, [f64; 2])>> = Vec::new();
        for transfer in &mut transfers {
            looked.push(match transfer {
                None => None,
                Some(one) => {
                    let (seen, look_s) = one.look(scene, &directions, &even)?;
                    Some((seen, [one.solve_s, look_s]))
                }
            });
        }
        let light = [false, true].map(|polarised| looked[table(Fineness::Light, polarised).index()].clone());
        let (mut errors, mut solve_look_s) = (Vec::new(), [[0.0; 2]; TRANSFERS.len()]);
        for (i, one) in TRANSFERS.into_iter().enumerate() {
            let polarised = Transfer { polarised: true, ..one }.index();
            let (seen, times) = match (&looked[i], &looked[polarised], &light) {
                (Some(own), ..) => own.clone(),
                (None, Some(with), [Some(scalar), Some(vector)]) => without(with, scalar, vector),
                _ => return Err(RenderError::Measured("tables without polarisation have none with it".into())),
            };
            solve_look_s[i] = times;
            let seen = eyes.whole(&detail, &seen);
            errors.extend(Spectrum::ALL.into_iter().map(|spectrum| eyes.errors((&right, &shares), &seen, spectrum)));
        }
        let [coarse_solve_s, coarse_look_s] = solve_look_s[table(Fineness::Coarse, false).index()];
        let light = table(Fineness::Light, false).index();
        let looks = match &mut transfers[light] {
            Some(one) => panorama(one, scene, solve_look_s[light][1])?,
            None => [0.0; 2],
        };
        let costs = Costs {
            solve_look_s,
            lanes: [
                [four.solve_s / coarse_solve_s, four_look_s / coarse_look_s],
                [whole.solve_s / coarse_solve_s, whole_look_s / coarse_look_s],
            ],
            panorama: looks,
            path: spread(&mut paths, scene, &even)?,
        };
        let traits = Traits::of(scene, &whole.sky);
        rows.push(Row { atmosphere: number, traits, season: (scene.month, scene.latitude_deg), errors, costs });
    }
    debug_assert!(rows.iter().all(|row| row.errors.len() == Candidate::COUNT));
    Ok(rows)
}

/// What a table with polarisation would see and take without it, by two light ones.
fn without(
    (seen, times): &(Factors, [f64; 2]),
    (scalar, scalar_times): &(Factors, [f64; 2]),
    (vector, vector_times): &(Factors, [f64; 2]),
) -> (Factors, [f64; 2]) {
    let ratio = |a: f64, b: f64| if b > 0.0 { a / b } else { 1.0 };
    let rows = seen.iter().zip(scalar).zip(vector).map(|((seen, scalar), vector)| {
        seen.iter().zip(scalar).zip(vector).map(|((seen, s), v)| seen * ratio(*s, *v)).collect()
    });
    (rows.collect(), std::array::from_fn(|i| times[i] * ratio(scalar_times[i], vector_times[i])))
}

/// Looks that a picture is found from, and what a pixel takes of one.
fn panorama(turned: &mut Turned, scene: &Scene, look_s: f64) -> Result<[f64; 2], RenderError> {
    let scene = Scene { width: Some(SIDE), height: Some(SIDE), ..scene.clone() };
    let (turn, seconds) = timed(|| turned.sky.turn(&scene));
    turn?;
    let camera = scene.camera();
    let some = || (0..SIDE).step_by(STEP);
    let middles = some().flat_map(|y| some().map(move |x| (f64::from(x) + 0.5, f64::from(y) + 0.5)));
    let pixels: Vec<DVec3> = middles.filter_map(|(x, y)| camera.direction(x, y)).collect();
    let mut factors = vec![0.0; turned.sky.wavelengths()];
    let ((), glances) = timed(|| {
        for direction in &pixels {
            turned.sky.radiance(*direction, &Sampler::new(0, 0, 0), &mut factors);
        }
    });
    Ok([seconds / look_s, glances / pixels.len() as f64 / look_s])
}

/// Seconds of a polarised path, and the root of the mean square over directions of the spread of its luminance over the mean of all.
fn spread(paths: &mut Turned, scene: &Scene, directions: &[DVec3]) -> Result<[f64; 2], RenderError> {
    paths.sky.turn(scene)?;
    let mut factors = vec![0.0; paths.sky.wavelengths()];
    let (mut mean, mut variance) = (0.0, 0.0);
    let ((), seconds) = timed(|| {
        for (pixel, direction) in (0_u64..).zip(directions) {
            let (mut sum, mut squares) = (0.0, 0.0);
            for sample in 0..PATHS {
                paths.sky.radiance(*direction, &Sampler::sobol(1, pixel, 0, sample), &mut factors);
                let y = paths.sky.colour().xyz(&factors)[1];
                (sum, squares) = (sum + y, squares + y * y);
            }
            let n = f64::from(PATHS);
            mean += sum / n / directions.len() as f64;
            variance += (squares - sum * sum / n) / (n - 1.0) / directions.len() as f64;
        }
    });
    Ok([seconds / f64::from(PATHS) / directions.len() as f64, variance.sqrt() / mean])
}
