//! What the tables of aerosol cost in radiance, against their size: how many wavelengths, angles and digits are enough.
//!
//! The radiance of an optically thin sky is proportional to the sum over what scatters of tau_s P_s(theta), tau_s the
//! optical depth of scattering, averaged over the sun's disc. Its error is what interpolation changes in this sum over the
//! sum, molecules included; each biome has its own amount and humidity. In a thicker sky, light that is scattered again has
//! forgotten most of the error of a phase function.

use super::{Part, Results, StudyError};
use crate::aerosol::angles::{MATRIX_STRIDE, cosines, degrees, finer, normalise};
use crate::aerosol::bulk::Rule;
use crate::aerosol::library::Library;
use crate::aerosol::mixture::{Mixed, species};
use crate::aerosol::recipe::{Inputs, Recipe, particles, recipe};
use crate::build;
use crate::frame::Frame;
use crate::raw::RawData;
use std::f64::consts::PI;
use std::path::Path;
use tables::units::WAVELENGTH_RANGE_NM;
use tables::views::{AerosolSource, Biome, Rayleigh, StandardAtmosphere};
use tables::{Kind, TableError};

/// Names of the parts.
pub(super) const PARTS: [&str; 3] = ["wavelengths", "angles", "by-angle"];

/// Steps of the wavelength axis in nm, whether the logarithm of phase functions is interpolated too, and where that is tried:
/// half-way between nodes that other steps need as well.
pub(super) const STEPS: [(f64, bool, &[f64]); 4] = [
    (50.0, false, &[325.0, 525.0]),
    (25.0, false, &[312.5, 337.5, 512.5, 537.5]),
    (25.0, true, &[312.5, 337.5, 512.5, 537.5]),
    (12.5, false, &[306.25, 318.75, 331.25, 506.25]),
];

/// Wavelengths in nm at which sets of angles are tried.
const ANGLES_AT: [f64; 2] = [300.0, 500.0];

/// Parts of an interval of the tables' angles in which the truth is computed, and of these every so manieth in a set.
const FINE: usize = 4;
pub(super) const STRIDES: [usize; 3] = [8, 4, 2];

/// Angular radius of the sun, degrees.
const SUN: f64 = 0.2666;

/// Optics of some particles at a wavelength: cross-section in m^2, phase function in sr^-1, ratios of the matrix.
#[derive(Clone)]
struct Scatterer {
    scattering: f64,
    phase: Vec<f64>,
    ratios: [Vec<f64>; 3],
}

impl From<&Mixed> for Scatterer {
    fn from(mixed: &Mixed) -> Self {
        Self { scattering: mixed.scattering, phase: mixed.phase.clone(), ratios: mixed.ratios.clone() }
    }
}

impl Scatterer {
    /// What a table says half-way between two wavelengths.
    fn half_way(a: &Self, b: &Self, cosines: &[f64], logarithmic: bool) -> Self {
        let mean = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| 0.5 * (a + b)).collect::<Vec<_>>();
        let phase = if logarithmic {
            let mut phase: Vec<f64> = a.phase.iter().zip(&b.phase).map(|(a, b)| (a * b).sqrt()).collect();
            let whole = tables::views::integral(cosines, &phase);
            phase.iter_mut().for_each(|value| *value /= whole);
            phase
        } else {
            mean(&a.phase, &b.phase)
        };
        let ratios = std::array::from_fn(|i| mean(&a.ratios[i], &b.ratios[i]));
        Self { scattering: (a.scattering * b.scattering).sqrt(), phase, ratios }
    }

    /// What a table says that has every so manieth of the angles.
    fn at_every(&self, stride: usize, cosines: &[f64]) -> Self {
        let every = |values: &[f64], stride: usize| values.iter().copied().step_by(stride).collect::<Vec<_>>();
        // Linear in the cosine between these.
        let spread = |values: &[f64], stride: usize| -> Vec<f64> {
            let between = |(i, c): (usize, &f64)| {
                let node = (i / stride).min(values.len() - 2);
                let (a, b) = (cosines[node * stride], cosines[(node + 1) * stride]);
                values[node] + (c - a) / (b - a) * (values[node + 1] - values[node])
            };
            cosines.iter().enumerate().map(between).collect()
        };
        let mut phase = every(&self.phase, stride);
        normalise(&every(cosines, stride), &mut phase);
        let matrix_stride = stride * MATRIX_STRIDE;
        let ratios = self.ratios.each_ref().map(|ratio| spread(&every(ratio, matrix_stride), matrix_stride));
        Self { scattering: self.scattering, phase: spread(&phase, stride), ratios }
    }

    /// What a table says that keeps so many binary digits.
    fn with_digits(&self, digits: u32) -> Self {
        let rounded = |value: &f64| {
            if *value == 0.0 {
                return 0.0;
            }
            let unit = 2.0_f64.powi(value.abs().log2().floor() as i32 + 1 - digits as i32);
            (value / unit).round() * unit
        };
        let all = |values: &Vec<f64>| values.iter().map(rounded).collect();
        Self { scattering: self.scattering, phase: all(&self.phase), ratios: self.ratios.each_ref().map(all) }
    }
}

/// Skies over all biomes at some wavelengths and angles.
struct Skies {
    wavelengths: Vec<f64>,
    cosines: Vec<f64>,
    /// Angles whose mean over the sun's disc about an angle is taken, with their weights.
    disc: Vec<Vec<(usize, f64)>>,
    /// tau P of molecules at each wavelength and angle.
    molecules: Vec<Vec<f64>>,
    /// Of each sky the columns in m^-2 of its species and their optics at each wavelength.
    all: Vec<Vec<(f64, Vec<Scatterer>)>>,
}

/// Errors relative to the radiance.
#[derive(Debug, Clone, Copy, Default)]
struct Errors {
    /// Largest over angles, wavelengths and biomes.
    largest: f64,
    /// Root of the mean square over directions, largest over wavelengths and biomes.
    rms: f64,
    /// Largest of an element of the scattering matrix.
    matrix: f64,
}

impl Skies {
    fn new(raw: &RawData, recipes: &[Recipe], mut wavelengths: Vec<f64>, degrees: &[f64]) -> Result<Self, StudyError> {
        wavelengths.sort_by(f64::total_cmp);
        wavelengths.dedup();
        let cosines = cosines(degrees);
        let opac = &raw.aerosol_opac;
        let needed = particles(opac, recipes, |s| std::slice::from_ref(&s.default_humidity))?;
        let library = Library::new(opac, needed, &wavelengths, &cosines, &Rule::TABLES)?;
        let mut all = Vec::new();
        for recipe in recipes {
            let mut sky = Vec::new();
            for one in &recipe.species {
                let number: f64 = one.parts.iter().map(|(_, number)| number).sum();
                let mixed = species(opac, &library, one, one.default_humidity)?;
                sky.push((one.profile.curve("altitude", number)?.total(), mixed.iter().map(Scatterer::from).collect()));
            }
            all.push(sky);
        }
        let air = StandardAtmosphere::from_table(&build::table(raw, Kind::StandardAtmosphere)?)?;
        let rayleigh = Rayleigh::from_table(&build::table(raw, Kind::Rayleigh)?)?;
        let of_molecules = |&nm: &f64| -> Result<Vec<f64>, TableError> {
            let depth = air.number_density_m3.total() * rayleigh.cross_section_m2.at(nm)?;
            let gamma = rayleigh.gamma.at(nm)?;
            let factor = depth * 3.0 / (16.0 * PI * (1.0 + 2.0 * gamma));
            Ok(cosines.iter().map(|c| factor * ((1.0 + 3.0 * gamma) + (1.0 - gamma) * c * c)).collect())
        };
        let molecules = wavelengths.iter().map(of_molecules).collect::<Result<_, _>>()?;
        Ok(Self { wavelengths, disc: disc(degrees), cosines, molecules, all })
    }

    /// The optics at a wavelength among those by wavelength.
    fn at<'a>(&self, by_wavelength: &'a [Scatterer], nm: f64) -> &'a Scatterer {
        &by_wavelength[self.wavelengths.partition_point(|w| *w < nm)]
    }

    /// Relative errors of the radiance of a sky at each angle, and the largest of an element of the matrix, if a table says
    /// of a species at a wavelength what `found` does.
    fn errors(
        &self,
        sky: &[(f64, Vec<Scatterer>)],
        nm: f64,
        found: &impl Fn(&[Scatterer]) -> Scatterer,
    ) -> (Vec<f64>, f64) {
        let mut total = self.molecules[self.wavelengths.partition_point(|w| *w < nm)].clone();
        let mut wrong: [Vec<f64>; 4] = std::array::from_fn(|_| vec![0.0; total.len()]);
        for (column, by_wavelength) in sky {
            let (exact, found) = (self.at(by_wavelength, nm), found(by_wavelength));
            for i in 0..total.len() {
                let right = column * exact.scattering * exact.phase[i];
                let taken = column * found.scattering * found.phase[i];
                total[i] += right;
                wrong[0][i] += taken - right;
                for (wrong, (a, b)) in wrong[1..].iter_mut().zip(found.ratios.iter().zip(&exact.ratios)) {
                    wrong[i] += taken * a[i] - right * b[i];
                }
            }
        }
        let over_disc = |values: &[f64]| -> Vec<f64> {
            self.disc.iter().map(|mean| mean.iter().map(|(i, weight)| weight * values[*i]).sum()).collect()
        };
        let total = over_disc(&total);
        let relative = |wrong: Vec<f64>| over_disc(&wrong).iter().zip(&total).map(|(w, t)| (w / t).abs()).collect();
        let [phase, matrix @ ..]: [Vec<f64>; 4] = wrong.map(relative);
        (phase, matrix.iter().flatten().copied().fold(0.0, f64::max))
    }

    /// The errors over all skies at some wavelengths.
    fn judge(&self, tried: &[f64], found: impl Fn(&[Scatterer], f64) -> Scatterer) -> Errors {
        let mut worst = Errors::default();
        for (sky, &nm) in self.all.iter().flat_map(|sky| tried.iter().map(move |nm| (sky, nm))) {
            let (errors, matrix) = self.errors(sky, nm, &|species| found(species, nm));
            let squares: Vec<f64> = errors.iter().map(|e| e * e).collect();
            let rms = (tables::views::integral(&self.cosines, &squares) / (4.0 * PI)).sqrt();
            worst.largest = errors.into_iter().fold(worst.largest, f64::max);
            worst.rms = worst.rms.max(rms);
            worst.matrix = worst.matrix.max(matrix);
        }
        worst
    }
}

/// For each angle in degrees (falling) the weights of the mean over the sun's disc about it, by 8 rings of equal area and 8
/// points on half of each; near the sun and opposite as in a plane.
fn disc(degrees: &[f64]) -> Vec<Vec<(usize, f64)>> {
    const POINTS: u32 = 8;
    let places = |angle: f64| {
        let (from_axis, opposite) = if angle > 90.0 { (180.0 - angle, true) } else { (angle, false) };
        (0..POINTS * POINTS).map(move |point| {
            let radius = SUN * ((f64::from(point / POINTS) + 0.5) / f64::from(POINTS)).sqrt();
            let azimuth = PI * (f64::from(point % POINTS) + 0.5) / f64::from(POINTS);
            let distance = (from_axis * from_axis + radius * radius + 2.0 * from_axis * radius * azimuth.cos()).sqrt();
            if opposite { 180.0 - distance } else { distance }
        })
    };
    let mean = |&angle: &f64| {
        let share = 1.0 / f64::from(POINTS * POINTS);
        let both = |place: f64| {
            let next = degrees.partition_point(|d| *d > place).clamp(1, degrees.len() - 1);
            let (a, b) = (degrees[next - 1].to_radians().cos(), degrees[next].to_radians().cos());
            let fraction = ((place.to_radians().cos() - a) / (b - a)).clamp(0.0, 1.0);
            [(next - 1, share * (1.0 - fraction)), (next, share * fraction)]
        };
        places(angle).flat_map(both).collect()
    };
    degrees.iter().map(mean).collect()
}

/// Megabytes of phase functions and matrices over all tables with so many wavelengths and angles, in single precision.
fn megabytes(recipes: &[Recipe], wavelengths: usize, angles: usize) -> f64 {
    let rows: usize = recipes.iter().flat_map(|recipe| &recipe.species).map(|s| s.humidities.len()).sum();
    let numbers = angles + 3 * ((angles - 1) / MATRIX_STRIDE + 1);
    (4 * rows * wavelengths * numbers) as f64 * 1e-6
}

/// A line and a row of numbers on a candidate.
fn told(words: &str, megabytes: f64, errors: Errors) -> (String, [f64; 4]) {
    let Errors { largest, rms, matrix } = errors;
    let line =
        format!("{words:<22} {megabytes:6.2} MB  largest error {largest:.1e}  rms {rms:.1e}  matrix {matrix:.1e}");
    (line, [megabytes, largest, rms, matrix])
}

/// A part of which each row is a candidate, after columns of its own.
fn part(name: &'static str, first: Vec<(&str, Vec<f64>)>, rows: &[[f64; 4]]) -> Result<Part, StudyError> {
    let column = |i: usize| rows.iter().map(|row| row[i]).collect::<Vec<_>>();
    let names = ["megabytes", "largest_error", "rms_error", "matrix_error"];
    let all = first.into_iter().chain(names.into_iter().enumerate().map(|(i, name)| (name, column(i))));
    Ok(Part { name, frame: Frame::new(all)? })
}

/// The column of a set of angles.
pub(super) fn column(stride: usize) -> String {
    format!("every_{stride}")
}

/// How many angles there are in a set.
pub(super) fn angles(stride: usize) -> usize {
    (finer(FINE as u32).len() - 1) / stride + 1
}

/// In words, a step of the wavelength axis.
pub(super) fn words(step: f64, logarithmic: bool) -> String {
    format!("{step} nm{}", if logarithmic { ", ln P" } else { "" })
}

/// Errors of radiance and sizes by wavelengths at the tables' angles, by angles at nodes of wavelength, and by angle.
pub(super) fn compare(raw_dir: &Path) -> Result<Results, StudyError> {
    let raw = RawData::from_dir(raw_dir)?;
    let inputs = Inputs { opac: &raw.aerosol_opac, jaenicke: &raw.aerosol_jaenicke };
    let made = AerosolSource::ALL.into_iter().flat_map(|s| Biome::ALL.map(|b| recipe(inputs, s, b)));
    let recipes = made.collect::<Result<Vec<Recipe>, _>>()?;
    let mut remarks = Vec::new();

    let around = |&(step, _, tried): &(f64, bool, &'static [f64])| {
        tried.iter().flat_map(move |nm| [nm - 0.5 * step, *nm, nm + 0.5 * step])
    };
    let skies = Skies::new(&raw, &recipes, STEPS.iter().flat_map(around).collect(), &degrees())?;
    let mut rows = Vec::new();
    for (step, logarithmic, tried) in STEPS {
        let errors = skies.judge(tried, |species, nm| {
            let [a, b] = [nm - 0.5 * step, nm + 0.5 * step].map(|nm| skies.at(species, nm));
            Scatterer::half_way(a, b, &skies.cosines, logarithmic)
        });
        let (low, high) = WAVELENGTH_RANGE_NM;
        let count = ((high - low) / step) as usize + 1;
        let (line, row) = told(&words(step, logarithmic), megabytes(&recipes, count, skies.cosines.len()), errors);
        remarks.push(line);
        rows.push(row);
    }
    let steps = STEPS.iter().map(|(step, ..)| *step).collect();
    let logarithmic = STEPS.iter().map(|(_, logarithmic, _)| f64::from(u8::from(*logarithmic))).collect();
    let mut parts = vec![part(PARTS[0], vec![("step_nm", steps), ("logarithmic", logarithmic)], &rows)?];

    for digits in [11, 24] {
        let errors = skies.judge(&ANGLES_AT, |species, nm| skies.at(species, nm).with_digits(digits));
        remarks.push(told(&format!("{digits} binary digits"), f64::NAN, errors).0.replace("   NaN MB", "         "));
    }

    let fine = finer(FINE as u32);
    let skies = Skies::new(&raw, &recipes, ANGLES_AT.to_vec(), &fine)?;
    let (mut rows, mut by_angle) = (Vec::new(), vec![("scattering_angle_deg".to_owned(), fine)]);
    for stride in STRIDES {
        let found = |species: &[Scatterer], nm: f64| skies.at(species, nm).at_every(stride, &skies.cosines);
        let errors = skies.judge(&ANGLES_AT, found);
        let (line, row) = told(&format!("{} angles", angles(stride)), megabytes(&recipes, 29, angles(stride)), errors);
        remarks.push(line);
        rows.push(row);
        let mut worst = vec![0.0_f64; skies.cosines.len()];
        for (sky, nm) in skies.all.iter().flat_map(|sky| ANGLES_AT.map(|nm| (sky, nm))) {
            let (errors, _) = skies.errors(sky, nm, &|species| found(species, nm));
            worst.iter_mut().zip(errors).for_each(|(worst, error)| *worst = worst.max(error));
        }
        by_angle.push((column(stride), worst));
    }
    parts.push(part(PARTS[1], vec![("angles", STRIDES.map(|s| angles(s) as f64).to_vec())], &rows)?);
    parts.push(Part { name: PARTS[2], frame: Frame::new(by_angle)? });
    Ok(Results { parts, remarks })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_over_the_disc_keeps_lines_and_smooths_points() {
        let angles = finer(4);
        let disc = disc(&angles);
        let mean = |values: &[f64], i: usize| disc[i].iter().map(|(j, weight)| weight * values[*j]).sum::<f64>();
        let at = |angle: f64| angles.iter().position(|a| (a - angle).abs() < 1e-9).expect("one of them");
        // Linear in the angle: its mean about an angle is the value there; the spread in azimuth adds r^2 / (4 theta).
        for angle in [20.0, 90.0, 160.0] {
            assert!((mean(&angles, at(angle)) - angle).abs() < 1e-3, "{angle}");
        }
        // The mean distance from the centre of a disc is 2/3 of its radius; 64 points.
        assert!((mean(&angles, at(0.0)) / SUN - 2.0 / 3.0).abs() < 5e-3);
    }

    #[test]
    fn digits_are_those_of_single_precision() {
        let one = Scatterer {
            scattering: 1.0,
            phase: vec![1.0 / 3.0, 2.0e-5 / 7.0],
            ratios: [vec![-0.1], vec![0.0], vec![1.0]],
        };
        let single = one.with_digits(24);
        assert_eq!(single.phase, [f64::from(1.0_f32 / 3.0), f64::from((2.0e-5 / 7.0) as f32)]);
        assert_eq!((single.ratios[0][0], single.ratios[1][0]), (f64::from(-0.1_f32), 0.0));
    }
}
