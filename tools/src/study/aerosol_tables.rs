//! What the tables of aerosol cost in radiance, against their size: how many wavelengths, angles and digits are enough.
//!
//! The radiance of an optically thin sky is proportional to the sum over what scatters of tau_s P_s(theta), tau_s the
//! optical depth of scattering, averaged over the sun's disc. Its error is what interpolation changes in this sum over the
//! sum, molecules included; each biome has its own amount and humidity. In a thicker sky, light that is scattered again has
//! forgotten most of the error of a phase function. What the averages over sizes are not known to counts as an error of
//! interpolation: nodes and truth are averages of their own.

use super::{Part, Results, StudyError};
use crate::aerosol::angles::{axis, cosines, degrees, finer};
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
use tables::views::{AerosolSource, Angles, Biome, COSINE, Rayleigh, StandardAtmosphere, WAVELENGTH};
use tables::{Axis, Interpolation, Kind, Scale, TableError};

/// Names of the parts.
pub(super) const PARTS: [&str; 3] = ["wavelengths", "angles", "by-angle"];

/// A rule between nodes, and the scale of the phase function.
type Between = (Interpolation, Scale);
const LINES: Between = (Interpolation::Linear, Scale::Linear);
const LINES_OF_LOGARITHMS: Between = (Interpolation::Linear, Scale::Logarithmic);
const PARABOLAS: Between = (Interpolation::Parabolic, Scale::Logarithmic);
const CUBICS: Between = (Interpolation::Cubic, Scale::Logarithmic);

/// Steps of the wavelength axis in nm and the rules between its nodes.
const STEPS: [(f64, Between); 9] = [
    (50.0, LINES),
    (50.0, LINES_OF_LOGARITHMS),
    (50.0, CUBICS),
    (25.0, LINES),
    (25.0, LINES_OF_LOGARITHMS),
    (25.0, CUBICS),
    (25.0, (Interpolation::Parabolic, Scale::Linear)),
    (25.0, PARABOLAS),
    (12.5, LINES),
];

/// Where a step is tried: half-way between nodes, of which other steps need some as well.
fn tried(step: f64) -> Vec<f64> {
    let places: &[f64] = if step < 25.0 { &[300.0, 312.5, 500.0] } else { &[300.0, 325.0, 500.0, 525.0] };
    let mut tried: Vec<f64> = places.iter().map(|nm| (nm / step).floor() * step + 0.5 * step).collect();
    tried.dedup();
    tried
}

/// A wavelength in nm, and the nodes in nm from which a table makes it, with their weights.
struct Place {
    nm: f64,
    nodes: Vec<(f64, f64)>,
}

impl Place {
    fn on(axis: &Axis, nm: f64) -> Result<Self, TableError> {
        let nodes = axis.weights(nm)?.into_iter().map(|(i, weight)| (axis.nodes[i], weight)).collect();
        Ok(Self { nm, nodes })
    }

    /// All wavelengths of which the optics are needed.
    fn needed(&self) -> impl Iterator<Item = f64> {
        self.nodes.iter().map(|(node, _)| *node).chain([self.nm])
    }
}

/// Wavelengths in nm at which sets of angles are tried: those between nodes, so that wavelengths and angles are tried
/// together as well.
const ANGLES_AT: [f64; 2] = [312.5, 512.5];

/// Parts of an interval of the tables' angles in which the truth is computed, and of these every so manieth in a set.
const FINE: usize = 8;
const SETS: [(usize, Between); 6] =
    [(16, LINES), (16, CUBICS), (FINE, LINES), (FINE, PARABOLAS), (FINE, CUBICS), (4, LINES)];

/// Columns of the error by angle: sets of the tables' angles, and all interpolations together.
pub(super) const BY_ANGLE: [(&str, &str); 3] =
    [("lines", "lines between the angles of the tables"), ("cubics", "cubics"), ("together", "all together")];

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
    /// What a table says between wavelengths whose nodes have these weights. Logarithms do not keep the integral 1, which
    /// is made right in the end: by lines, which have too much of it, it is the mean of the nodes'.
    fn between(near: &[(&Self, f64)], cosines: &[f64], scale: Scale) -> Self {
        let mix = |scale: Scale, value: &dyn Fn(&Self) -> f64| -> f64 {
            scale.back(near.iter().map(|(node, weight)| weight * scale.of(value(node))).sum())
        };
        let mut phase: Vec<f64> = (0..cosines.len()).map(|i| mix(scale, &|node| node.phase[i])).collect();
        let integral = |phase: &[f64]| tables::views::integral(cosines, phase);
        let factor = mix(Scale::Linear, &|node| integral(&node.phase)) / integral(&phase);
        phase.iter_mut().for_each(|value| *value *= factor);
        let ratio = |j: usize| (0..cosines.len()).map(|i| mix(Scale::Linear, &|node| node.ratios[j][i])).collect();
        let scattering = mix(Scale::Logarithmic, &|node| node.scattering);
        Self { scattering, phase, ratios: [ratio(0), ratio(1), ratio(2)] }
    }

    /// What a table says that has every so manieth of the angles, from which `angles` lead on.
    fn at_every(&self, stride: usize, angles: &Angles, scale: Scale, cosines: &[f64]) -> Self {
        let refined = |values: &[f64], scale: Scale| {
            let nodes: Vec<f64> = values.iter().step_by(stride).map(|value| scale.of(*value)).collect();
            angles.between(scale, &nodes)
        };
        let lines = |values: Vec<f64>| -> Vec<f64> {
            let nodes = angles.cosines();
            let at = |c: &f64| {
                let next = nodes.partition_point(|node| node <= c).clamp(1, nodes.len() - 1);
                let (a, b) = (next - 1, next);
                values[a] + (c - nodes[a]) / (nodes[b] - nodes[a]) * (values[b] - values[a])
            };
            cosines.iter().map(at).collect()
        };
        let (phase, _) = angles.phase(refined(&self.phase, scale));
        let ratios = self.ratios.each_ref().map(|ratio| lines(refined(ratio, Scale::Linear)));
        Self { scattering: self.scattering, phase: lines(phase), ratios }
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
    names: Vec<String>,
    wavelengths: Vec<f64>,
    cosines: Vec<f64>,
    /// Angles whose mean over the sun's disc about an angle is taken, with their weights.
    disc: Vec<Vec<(usize, f64)>>,
    /// tau P of molecules at each wavelength and angle.
    molecules: Vec<Vec<f64>>,
    /// Of each sky the columns in m^-2 of its species and their optics at each wavelength.
    all: Vec<Vec<(f64, Vec<Scatterer>)>>,
}

/// Errors relative to the radiance, largest over wavelengths.
#[derive(Debug, Clone, Copy, Default)]
struct Errors {
    /// Largest over angles.
    largest: f64,
    /// Root of the mean square over directions.
    rms: f64,
    /// Largest of an element of the scattering matrix.
    matrix: f64,
}

impl Errors {
    fn or(self, other: Self) -> Self {
        Self {
            largest: self.largest.max(other.largest),
            rms: self.rms.max(other.rms),
            matrix: self.matrix.max(other.matrix),
        }
    }
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
        let names = recipes.iter().map(|recipe| recipe.origin.to_string()).collect();
        Ok(Self { names, wavelengths, disc: disc(degrees), cosines, molecules, all })
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

    /// The errors of each sky at some wavelengths.
    fn judge(&self, tried: &[Place], found: &dyn Fn(&[Scatterer], &Place) -> Scatterer) -> Vec<Errors> {
        let one = |sky: &Vec<(f64, Vec<Scatterer>)>, place: &Place| {
            let (errors, matrix) = self.errors(sky, place.nm, &|species| found(species, place));
            let squares: Vec<f64> = errors.iter().map(|e| e * e).collect();
            let rms = (tables::views::integral(&self.cosines, &squares) / (4.0 * PI)).sqrt();
            Errors { largest: errors.into_iter().fold(0.0, f64::max), rms, matrix }
        };
        let of = |sky| tried.iter().map(|place| one(sky, place)).fold(Errors::default(), Errors::or);
        self.all.iter().map(of).collect()
    }

    /// The largest error at each angle.
    fn by_angle(&self, tried: &[Place], found: &dyn Fn(&[Scatterer], &Place) -> Scatterer) -> Vec<f64> {
        let mut worst = vec![0.0_f64; self.cosines.len()];
        for (sky, place) in self.all.iter().flat_map(|sky| tried.iter().map(move |place| (sky, place))) {
            let (errors, _) = self.errors(sky, place.nm, &|species| found(species, place));
            worst.iter_mut().zip(errors).for_each(|(worst, error)| *worst = worst.max(error));
        }
        worst
    }

    /// What a table says of a species between its wavelengths.
    fn spectral(&self, species: &[Scatterer], place: &Place, scale: Scale) -> Scatterer {
        let near: Vec<(&Scatterer, f64)> =
            place.nodes.iter().map(|&(node, weight)| (self.at(species, node), weight)).collect();
        Scatterer::between(&near, &self.cosines, scale)
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
    (4 * rows * wavelengths * 4 * angles) as f64 * 1e-6
}

/// A candidate over all skies: a line of words, and a row of numbers.
struct Row {
    label: String,
    numbers: [f64; 6],
}

impl Row {
    /// `largest` and `matrix` also without the sky where they are largest.
    fn new(label: String, megabytes: f64, skies: &Skies, errors: &[Errors]) -> (Self, String) {
        let worst = errors.iter().copied().fold(Errors::default(), Errors::or);
        let at = (0..errors.len()).max_by(|a, b| errors[*a].largest.total_cmp(&errors[*b].largest)).unwrap_or(0);
        let others = errors.iter().enumerate().filter(|(sky, _)| *sky != at).map(|(_, error)| *error);
        let others = others.fold(Errors::default(), Errors::or);
        let line = format!(
            "{label:<36} {megabytes:6.2} MB  largest error {:.1e}  rms {:.1e}  matrix {:.1e}  without {}: {:.1e}  matrix {:.1e}",
            worst.largest, worst.rms, worst.matrix, skies.names[at], others.largest, others.matrix
        );
        let numbers = [megabytes, worst.largest, worst.rms, worst.matrix, others.largest, others.matrix];
        (Self { label, numbers }, line)
    }
}

/// The columns of a part of which each row is a candidate.
pub(super) const COLUMNS: [&str; 6] = [
    "megabytes",
    "largest_error",
    "rms_error",
    "matrix_error",
    "largest_error_but_one_biome",
    "matrix_error_but_one_biome",
];

fn part(name: &'static str, rows: Vec<Row>) -> Result<Part, StudyError> {
    let column = |i: usize| rows.iter().map(|row| row.numbers[i]).collect::<Vec<_>>();
    let frame = Frame::new(COLUMNS.iter().enumerate().map(|(i, name)| (*name, column(i))))?;
    let labels = rows.iter().map(|row| row.label.clone()).collect();
    Ok(Part { name, frame: frame.labelled([("candidate", labels)])? })
}

/// In words, a rule and a scale.
fn rule(between: Between) -> &'static str {
    match between {
        LINES => "lines",
        LINES_OF_LOGARITHMS => "lines of ln P",
        PARABOLAS => "parabolas of ln P",
        CUBICS => "cubics of ln P",
        (Interpolation::Parabolic, _) => "parabolas",
        _ => "another rule",
    }
}

/// The axis of wavelengths of a step.
fn wavelengths(step: f64, interpolation: Interpolation) -> Result<Axis, TableError> {
    let (low, high) = WAVELENGTH_RANGE_NM;
    let count = ((high - low) / step) as usize + 1;
    Ok(Axis::uniform(WAVELENGTH.0, WAVELENGTH.1, low, step, count)?.between(interpolation))
}

/// Errors of radiance and sizes by wavelengths at the tables' angles, by angles, and by angle.
pub(super) fn compare(raw_dir: &Path) -> Result<Results, StudyError> {
    let raw = RawData::from_dir(raw_dir)?;
    let inputs = Inputs { opac: &raw.aerosol_opac, jaenicke: &raw.aerosol_jaenicke };
    let made = AerosolSource::ALL.into_iter().flat_map(|s| Biome::ALL.map(|b| recipe(inputs, s, b)));
    let recipes = made.collect::<Result<Vec<Recipe>, _>>()?;
    let mut remarks = Vec::new();

    let places = |step: f64, interpolation: Interpolation, tried: &[f64]| -> Result<Vec<Place>, TableError> {
        let axis = wavelengths(step, interpolation)?;
        tried.iter().map(|nm| Place::on(&axis, *nm)).collect()
    };
    let steps = STEPS.map(|(step, between)| places(step, between.0, &tried(step)));
    let steps = steps.into_iter().collect::<Result<Vec<_>, _>>()?;
    let needed = steps.iter().flatten().flat_map(Place::needed).collect();
    let skies = Skies::new(&raw, &recipes, needed, &degrees())?;
    let mut rows = Vec::new();
    for ((step, between), places) in STEPS.into_iter().zip(&steps) {
        let errors = skies.judge(places, &|species, place| skies.spectral(species, place, between.1));
        let size = megabytes(&recipes, wavelengths(step, between.0)?.nodes.len(), skies.cosines.len());
        let (row, line) = Row::new(format!("{step} nm, {}", rule(between)), size, &skies, &errors);
        remarks.push(line);
        rows.push(row);
    }
    let mut parts = vec![part(PARTS[0], rows)?];

    let fine = finer(FINE as u32);
    let of_tables = build::aerosol::wavelengths()?;
    let count = of_tables.nodes.len();
    let places = ANGLES_AT.into_iter().map(|nm| Place::on(&of_tables, nm)).collect::<Result<Vec<_>, _>>()?;
    let needed = places.iter().flat_map(Place::needed).collect();
    let skies = Skies::new(&raw, &recipes, needed, &fine)?;
    let set = |(stride, (interpolation, _)): (usize, Between)| -> Result<Angles, TableError> {
        let nodes = skies.cosines.iter().copied().step_by(stride).collect();
        Angles::new(&Axis::new(COSINE.0, COSINE.1, nodes)?.between(interpolation))
    };
    let (mut rows, mut by_angle) = (Vec::new(), vec![("scattering_angle_deg".to_owned(), fine)]);
    for (stride, between) in SETS {
        let angles = set((stride, between))?;
        let found = |species: &[Scatterer], p: &Place| {
            skies.at(species, p.nm).at_every(stride, &angles, between.1, &skies.cosines)
        };
        let size = megabytes(&recipes, count, angles.nodes());
        let label = format!("{} angles, {}", angles.nodes(), rule(between));
        let (row, line) = Row::new(label, size, &skies, &skies.judge(&places, &found));
        remarks.push(line);
        rows.push(row);
        if stride == FINE && between != PARABOLAS {
            let column = BY_ANGLE[usize::from(between == CUBICS)].0;
            by_angle.push((column.to_owned(), skies.by_angle(&places, &found)));
        }
    }
    let size = megabytes(&recipes, count, degrees().len());
    for (digits, bits) in [(11, 16.0), (24, 32.0)] {
        let errors = skies.judge(&places, &|species, place| skies.at(species, place.nm).with_digits(digits));
        let size = size * bits / 32.0;
        let (row, line) = Row::new(format!("{digits} binary digits"), size, &skies, &errors);
        remarks.push(line);
        rows.push(row);
    }
    // What the tables say, from their own nodes.
    let angles = Angles::new(&axis()?)?;
    let together = |species: &[Scatterer], place: &Place| {
        let between = skies.spectral(species, place, Scale::Logarithmic);
        between.at_every(FINE, &angles, Scale::Logarithmic, &skies.cosines).with_digits(24)
    };
    let errors = skies.judge(&places, &together);
    let (row, line) = Row::new("the tables, all together".into(), size, &skies, &errors);
    remarks.push(line);
    rows.push(row);
    by_angle.push((BY_ANGLE[2].0.to_owned(), skies.by_angle(&places, &together)));
    parts.push(part(PARTS[1], rows)?);
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
