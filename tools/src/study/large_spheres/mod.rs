//! Large spheres of water: the phase function of a cloud, with corona, cloudbow and glory, and of drops of 0.5 mm, with
//! their rainbows beside what geometrical optics and Airy's theory say.
//!
//! Sun and air are left out: the light is a plane wave of one wavelength.

mod bows;
mod drops;
#[cfg(feature = "plot")]
mod figure;
#[cfg(test)]
mod tests;

#[cfg(feature = "plot")]
pub(super) use figure::figure;

use super::{Part, Results, StudyError};
use crate::aerosol::angles::cosines;
use crate::frame::Frame;
use crate::mie::RefractiveIndex;
use crate::raw::water::Water;
use bows::Bow;
use drops::{Averaged, Gamma, average};
use std::f64::consts::PI;
use std::path::Path;
use tables::views::integral;
use tables::{Axis, Curve, Scale, TableError};

/// Blue, green and red, nm.
const WAVELENGTHS_NM: [u32; 3] = [450, 550, 650];

/// Effective radius of the cloud, m.
const CLOUD_RADIUS: f64 = 10e-6;

/// Effective variances of the clouds: about what Hansen and Travis (1974) give for fair-weather cumulus, and nearly equal
/// drops as in thin wave clouds, where the rings are seen.
const CLOUDS: [(&str, f64); 2] = [(BROAD, 0.1), (NARROW, 0.01)];

/// The drops: the 0.5 mm are their diameter. Their standard deviation of 1 % is enough to blur the interference of rays
/// that do not make the bow, and far from enough to blur the supernumeraries.
const DROP_SIZES: Gamma = Gamma { radius: 0.25e-3, variance: 1e-4 };

/// Where the first bright ring of the glory is looked for, x times the distance from 180 degrees in rad.
const GLORY: (f64, f64) = (2.5, 5.0);

/// Steps of the size parameter. The light from both sides of a drop interferes with a period of some 1.5 and more.
const CLOUD_STEP: f64 = 0.05;
const DROP_STEP: f64 = 0.4;

/// Names of the parts and of what they hold.
const CLOUD: &str = "cloud";
const DROPS: &str = "drops";
const BROAD: &str = "cloud_broad";
const NARROW: &str = "cloud_narrow";

/// Runs of scattering angles of the cloud: up to this angle in degrees, by this step.
const CLOUD_RUNS: [(f64, f64); 6] = [(8.0, 0.05), (20.0, 0.2), (120.0, 0.5), (160.0, 0.1), (174.0, 0.2), (180.0, 0.02)];

/// The same of the drops.
const DROP_RUNS: [(f64, f64); 5] = [(4.0, 0.04), (20.0, 0.2), (115.0, 0.5), (145.0, 0.05), (180.0, 0.1)];

/// The angles of runs in degrees, from 0 to 180.
fn degrees(runs: &[(f64, f64)]) -> Vec<f64> {
    let mut angles = vec![0.0];
    let mut from = 0.0;
    for &(to, step) in runs {
        let steps = ((to - from) / step).round() as u32;
        angles.extend((1..=steps).map(|i| from + (to - from) * f64::from(i) / f64::from(steps)));
        from = to;
    }
    angles
}

/// Refractive index of water against wavelength: n linear, k by its logarithm.
struct Index {
    n: Curve,
    k: Curve,
}

impl Index {
    fn read(raw_dir: &Path) -> Result<Self, StudyError> {
        let rows = Water::from_dir(raw_dir)?.refractive_index.rows;
        let curve = |scale, values: Vec<f64>| -> Result<Curve, TableError> {
            Curve::new(
                Axis::new("wavelength", "nm", rows.iter().map(|row| row.wavelength_nm).collect())?,
                scale,
                values,
            )
        };
        Ok(Self {
            n: curve(Scale::Linear, rows.iter().map(|row| row.n).collect())?,
            k: curve(Scale::Logarithmic, rows.iter().map(|row| row.k).collect())?,
        })
    }

    fn at(&self, wavelength_nm: u32) -> Result<RefractiveIndex, StudyError> {
        let nm = f64::from(wavelength_nm);
        Ok(RefractiveIndex::new(self.n.at(nm)?, self.k.at(nm)?)?)
    }
}

/// Drops at one wavelength.
struct Solved {
    kind: &'static str,
    wavelength_nm: u32,
    sizes: Gamma,
    index: RefractiveIndex,
    averaged: Averaged,
}

impl Solved {
    /// Size parameter of the effective radius.
    fn x(&self) -> f64 {
        size_parameter(self.sizes.radius, self.wavelength_nm)
    }
}

fn size_parameter(radius: f64, wavelength_nm: u32) -> f64 {
    2.0 * PI * radius / (f64::from(wavelength_nm) * 1e-9)
}

/// The same drops at each wavelength.
fn solve(
    index: &Index,
    kind: &'static str,
    sizes: Gamma,
    degrees: &[f64],
    step: f64,
) -> Result<Vec<Solved>, StudyError> {
    let angles = drops::table(degrees, sizes, f64::from(WAVELENGTHS_NM[0]) * 1e-9)?;
    let one = |wavelength_nm: u32| -> Result<Solved, StudyError> {
        let index = index.at(wavelength_nm)?;
        let averaged = average(index, sizes, f64::from(wavelength_nm) * 1e-9, &angles, step)?;
        Ok(Solved { kind, wavelength_nm, sizes, index, averaged })
    };
    WAVELENGTHS_NM.into_iter().map(one).collect()
}

/// Where a curve over angles has its highest maximum inside `(from, to)` degrees; `None` if there is none. The place is
/// that of the parabola through the logarithms of three points. For a minimum give reciprocals.
fn highest(degrees: &[f64], values: &[f64], (from, to): (f64, f64)) -> Option<f64> {
    let inside = |i: &usize| from < degrees[*i] && degrees[*i] < to;
    let is_top = |i: &usize| values[*i] > values[i - 1] && values[*i] >= values[i + 1];
    let top = (1..degrees.len() - 1).filter(inside).filter(is_top).max_by(|a, b| values[*a].total_cmp(&values[*b]))?;
    let [left, middle, right] = [top - 1, top, top + 1].map(|i| (degrees[i] - degrees[top], values[i].ln()));
    let slope = |a: (f64, f64), b: (f64, f64)| (b.1 - a.1) / (b.0 - a.0);
    let (before, after) = (slope(left, middle), slope(middle, right));
    // The slope falls linearly from the middle of one interval to that of the next.
    Some(degrees[top] + 0.5 * left.0 + before / (before - after) * 0.5 * (right.0 - left.0))
}

/// Where a curve has its deepest minimum.
fn deepest(degrees: &[f64], values: &[f64], within: (f64, f64)) -> Option<f64> {
    highest(degrees, &values.iter().map(|value| 1.0 / value).collect::<Vec<_>>(), within)
}

/// A maximum of a bow.
struct BowFound<'a> {
    solved: &'a Solved,
    bow: Bow,
    /// 0 the bow itself, then the supernumeraries.
    maximum: usize,
    descartes_deg: f64,
    airy_deg: f64,
    mie_deg: Option<f64>,
}

/// Looks for that maximum of a bow between its neighbours after Airy; outside the first as far as it lies inside.
fn bow<'a>(solved: &'a Solved, phase: &[f64], degrees: &[f64], bow: Bow, maximum: usize) -> BowFound<'a> {
    let (n, x) = (solved.index.n(), solved.x());
    let inside = |s: f64| bow.inside_deg(n, bow.airy_shift_deg(n, x, s));
    let [here, after] = [maximum, maximum + 1].map(|i| bows::MAXIMA[i]);
    let before = if maximum == 0 { -3.0 * here } else { bows::MAXIMA[maximum - 1] };
    let ends = [inside(0.5 * (before + here)), inside(0.5 * (here + after))];
    BowFound {
        solved,
        bow,
        maximum,
        descartes_deg: bow.descartes_deg(n),
        airy_deg: inside(here),
        mie_deg: highest(degrees, phase, (ends[0].min(ends[1]), ends[0].max(ends[1]))),
    }
}

/// Rings of a cloud.
struct Rings<'a> {
    solved: &'a Solved,
    /// First dark ring of the corona, and that of a disc.
    corona_deg: Option<f64>,
    disc_deg: f64,
    bow: BowFound<'a>,
    /// First bright ring of the glory, and x times its distance from 180 degrees, in rad, in which glories are alike.
    glory_deg: Option<f64>,
    glory_abscissa: f64,
}

fn rings<'a>(solved: &'a Solved, degrees: &[f64]) -> Rings<'a> {
    let (phase, x) = (&solved.averaged.phase, solved.x());
    let disc_deg = bows::dark_ring_deg(size_parameter(solved.sizes.diffracting_radius(), solved.wavelength_nm));
    let glory_at = |u: f64| 180.0 - (u / x).to_degrees();
    let glory_deg = highest(degrees, phase, (glory_at(GLORY.1), glory_at(GLORY.0)));
    Rings {
        solved,
        corona_deg: deepest(degrees, phase, (0.7 * disc_deg, 1.3 * disc_deg)),
        disc_deg,
        bow: bow(solved, phase, degrees, Bow::Primary, 0),
        glory_deg,
        glory_abscissa: glory_deg.map_or(f64::NAN, |angle| x * (180.0 - angle).to_radians()),
    }
}

/// How far the two halves of the sizes differ: the largest relative difference beyond 1 degree and its place in degrees,
/// and the share of the light that goes elsewhere.
fn disagreement(averaged: &Averaged, degrees: &[f64]) -> (f64, f64, f64) {
    let [a, b] = &averaged.halves;
    let beyond = degrees.iter().zip(a.iter().zip(b)).filter(|(angle, _)| **angle > 1.0);
    let (worst, place) = beyond
        .map(|(angle, (a, b))| ((a / b - 1.0).abs(), *angle))
        .fold((0.0, 0.0), |worst, one| if one.0 > worst.0 { one } else { worst });
    // Angles grow and cosines fall.
    let moved: Vec<f64> = a.iter().zip(b).map(|(a, b)| (a - b).abs()).collect();
    (worst, place, -0.5 * integral(&cosines(degrees), &moved))
}

/// An angle in words.
fn words(angle_deg: Option<f64>) -> String {
    angle_deg.map_or_else(|| "none".to_owned(), |angle| format!("{angle:.2}°"))
}

impl Solved {
    /// What it is and how well it is known, in words.
    fn remark(&self, degrees: &[f64]) -> String {
        let (worst, place, misplaced) = disagreement(&self.averaged, degrees);
        format!(
            "{}, {} nm: x {:.0}, n {:.4}, g {:.4}; every other size alone: {:.2} % of the light elsewhere, at most \
             {:.1} % at one angle ({place:.2}°)",
            self.kind,
            self.wavelength_nm,
            self.x(),
            self.index.n(),
            self.averaged.asymmetry,
            100.0 * misplaced,
            100.0 * worst
        )
    }
}

impl Rings<'_> {
    fn remark(&self) -> String {
        let Solved { kind, wavelength_nm, .. } = self.solved;
        format!(
            "{kind}, {wavelength_nm} nm: first dark ring of the corona {}, of a disc {:.2}°; cloudbow {}, Airy {:.2}°; \
             first bright ring of the glory {}, x times its distance from 180° {:.2}",
            words(self.corona_deg),
            self.disc_deg,
            words(self.bow.mie_deg),
            self.bow.airy_deg,
            words(self.glory_deg),
            self.glory_abscissa
        )
    }
}

impl BowFound<'_> {
    fn remark(&self) -> String {
        let Solved { kind, wavelength_nm, .. } = self.solved;
        let what = if self.maximum == 0 { "bow" } else { "first supernumerary" };
        format!(
            "{kind}, {wavelength_nm} nm, {} {what}: Descartes {:.2}°, Airy {:.2}°, Mie {}, Mie - Airy {:+.3}°",
            self.bow.name(),
            self.descartes_deg,
            self.airy_deg,
            words(self.mie_deg),
            self.mie_deg.map_or(f64::NAN, |mie| mie - self.airy_deg)
        )
    }
}

/// The column of a kind of drops at a wavelength.
fn column(kind: &str, wavelength_nm: u32) -> String {
    format!("{kind}_{wavelength_nm}nm_per_sr")
}

/// Phase functions against the angle, and beside them the columns of what was found.
fn frame(degrees: &[f64], solved: &[Solved], found: Vec<(&str, Vec<f64>)>) -> Result<Frame, StudyError> {
    let phases: Vec<_> =
        solved.iter().map(|one| (column(one.kind, one.wavelength_nm), one.averaged.phase.clone())).collect();
    let mut columns = vec![("angle_deg", degrees.to_vec())];
    columns.extend(phases.iter().map(|(name, phase)| (name.as_str(), phase.clone())));
    columns.extend(found);
    Ok(Frame::ragged(columns)?)
}

/// Values of a list as a column; what was not found is missing.
fn values<T>(list: &[T], value: impl Fn(&T) -> Option<f64>) -> Vec<f64> {
    list.iter().map(|one| value(one).unwrap_or(f64::NAN)).collect()
}

/// Phase functions of clouds and of drops, and where their rings are.
pub(super) fn compare(raw_dir: &Path) -> Result<Results, StudyError> {
    let (index, over_cloud, over_drops) = (Index::read(raw_dir)?, degrees(&CLOUD_RUNS), degrees(&DROP_RUNS));
    let mut clouds = Vec::new();
    for (kind, variance) in CLOUDS {
        clouds.extend(solve(&index, kind, Gamma { radius: CLOUD_RADIUS, variance }, &over_cloud, CLOUD_STEP)?);
    }
    let drops = solve(&index, DROPS, DROP_SIZES, &over_drops, DROP_STEP)?;
    let rings: Vec<Rings<'_>> = clouds.iter().map(|one| rings(one, &over_cloud)).collect();
    let wanted = drops.iter().flat_map(|one| Bow::ALL.map(|b| [0, 1].map(|maximum| (one, b, maximum)))).flatten();
    let bows: Vec<BowFound<'_>> = wanted.map(|(one, b, i)| bow(one, &one.averaged.phase, &over_drops, b, i)).collect();

    let mut remarks: Vec<String> = clouds.iter().map(|one| one.remark(&over_cloud)).collect();
    remarks.extend(drops.iter().map(|one| one.remark(&over_drops)));
    remarks.extend(rings.iter().map(Rings::remark));
    remarks.extend(bows.iter().map(BowFound::remark));
    let of_rings = vec![
        ("effective_variance", values(&rings, |r| Some(r.solved.sizes.variance))),
        ("wavelength_nm", values(&rings, |r| Some(f64::from(r.solved.wavelength_nm)))),
        ("corona_deg", values(&rings, |r| r.corona_deg)),
        ("disc_deg", values(&rings, |r| Some(r.disc_deg))),
        ("bow_deg", values(&rings, |r| r.bow.mie_deg)),
        ("bow_airy_deg", values(&rings, |r| Some(r.bow.airy_deg))),
        ("glory_deg", values(&rings, |r| r.glory_deg)),
        ("glory_abscissa", values(&rings, |r| Some(r.glory_abscissa))),
    ];
    let of_bows = vec![
        ("wavelength_nm", values(&bows, |b| Some(f64::from(b.solved.wavelength_nm)))),
        ("internal_reflections", values(&bows, |b| Some(b.bow.internal_reflections()))),
        ("maximum", values(&bows, |b| Some(b.maximum as f64))),
        ("descartes_deg", values(&bows, |b| Some(b.descartes_deg))),
        ("airy_deg", values(&bows, |b| Some(b.airy_deg))),
        ("mie_deg", values(&bows, |b| b.mie_deg)),
    ];
    let parts = vec![
        Part { name: CLOUD, frame: frame(&over_cloud, &clouds, of_rings)? },
        Part { name: DROPS, frame: frame(&over_drops, &drops, of_bows)? },
    ];
    Ok(Results { parts, remarks })
}
