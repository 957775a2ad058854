//! How far the solved tables of a picture are from the truth, found by certificates in some of its directions.

use super::sky::{Shows, Sky};
use crate::atmosphere::Columns;
use crate::camera::Camera;
use crate::geometry::Place;
use crate::polarisation::{Frame, Stokes};
use crate::scene::Scene;
use crate::transport::{Certificate, Certified, Solved};
use glam::DVec3;
use rayon::prelude::*;
use std::fmt::Debug;
use std::sync::atomic::{AtomicBool, Ordering};

/// Directions in which a picture is looked at.
const DIRECTIONS: usize = 96;

/// Rays of a direction and a round that leave the line of sight, some fans of them; after how many rounds the error is looked at.
const RAYS: u32 = 2048;
const LOOKS: [u32; 9] = [1, 2, 3, 4, 5, 6, 8, 16, 64];

/// Standard errors that a number is below with 95 % confidence: of one look, and of each of [`LOOKS`] so that all together have it.
///
/// What noise adds to the mean square after m and after n > m rounds, (sum of m or n draws)^2 less the mean of that, has the correlation
/// m / n; where tables are off there is a part with the root of that, which is more. The greatest of nine normal numbers with the first is
/// above 2.44 in 5 % (`nine_looks_together_have_95_percent`), with more of it less often (Slepian 1962).
const ONE_LOOK: f64 = 1.645;
const NINE_LOOKS: f64 = 2.44;

/// How far tables are off, relative to radiance: in that, or in another Stokes parameter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Residual {
    /// Root mean square over directions and wavelengths, without the certificate's own noise.
    pub rms: f64,
    /// What it is below with 95 % confidence.
    pub most: f64,
    /// What it is above with 95 % confidence; 0 if it may be nothing.
    pub least: f64,
    /// Mean, and the standard error of that.
    pub mean: (f64, f64),
    /// Mean over the wavelengths of the error in the direction in which it is largest, and its standard error.
    pub worst: (f64, f64),
    /// That direction.
    pub worst_direction: DVec3,
}

/// What a certificate says about the tables of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// What was asked: whether every root mean square error is below it.
    pub asked: f64,
    /// Of radiance, which is what passes the filter if there is one; with Stokes parameters of I, Q and U, each relative to I.
    pub errors: Vec<Residual>,
    /// Directions, and fans in all.
    pub size: (usize, u64),
}

impl Verdict {
    /// Whether all errors are below what was asked, with 95 % confidence: if one is not, then its own bound says so, so that of several
    /// no more is asked than of one.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.most() <= self.asked
    }

    /// What the largest error is below.
    fn most(&self) -> f64 {
        self.errors.iter().map(|error| error.most).fold(0.0, f64::max)
    }

    /// Whether an error is above what was asked, with the same confidence.
    fn fails(&self) -> bool {
        self.errors.iter().any(|error| error.least > self.asked)
    }
}

/// Certificates of a packet of wavelengths: of radiance alone, or of I, Q and U, one row each.
pub(super) trait Certifies: Debug + Sync {
    /// What the table says in a direction at each wavelength.
    fn table(&self, direction: DVec3) -> Vec<Vec<f64>>;
    /// How many fans a round of a direction has.
    fn fans(&self) -> u32;
    /// Mean and variance at each wavelength, by so many.
    fn certified(&self, direction: DVec3, seed: u64, stream: u64) -> Vec<Vec<(f64, f64)>>;
}

/// A certificate of one packet, of which the first `count` lanes count.
#[derive(Debug)]
pub(super) struct Packet<'a, const L: usize> {
    pub(super) solved: &'a Solved<L>,
    pub(super) certificate: Certificate<'a, L>,
    /// What is shown; other than radiance only of a table of polarised light.
    pub(super) shows: Shows,
    pub(super) count: usize,
}

impl<const L: usize> Packet<'_, L> {
    fn stokes<const N: usize>(
        &self,
        (direction, frame): (DVec3, Frame),
        of: impl Fn(&Stokes) -> [f64; N],
        random: (u64, u64),
    ) -> Vec<Certified<L>> {
        let fans = (self.certificate.fan(), self.fans());
        self.certificate.stokes((direction, frame), of, fans, random).map_or(Vec::new(), Vec::from)
    }
}

fn parameters(seen: &Stokes) -> [f64; 3] {
    [seen.i, seen.q, seen.u]
}

/// What a filter lets pass: its axis is at an angle of the frame of pictures.
fn passed(angle: f64) -> impl Fn(&Stokes) -> [f64; 1] {
    move |seen| [seen.mirrored().through(angle)]
}

impl<const L: usize> Certifies for Packet<'_, L> {
    fn table(&self, direction: DVec3) -> Vec<Vec<f64>> {
        let (from, sun) = self.certificate.observer();
        let seen = || self.solved.stokes(from, direction, Frame::level(from.up, direction), sun, false);
        let row = |of: &dyn Fn(&Stokes) -> f64| seen()[..self.count].iter().map(of).collect();
        match self.shows {
            Shows::Radiance => vec![self.solved.radiance(from, direction, sun, false)[..self.count].to_vec()],
            Shows::Stokes => (0..3).map(|k| row(&|seen| parameters(seen)[k])).collect(),
            Shows::Filtered(angle) => vec![row(&|seen| passed(angle)(seen)[0])],
        }
    }

    fn fans(&self) -> u32 {
        RAYS / self.certificate.fan().first
    }

    fn certified(&self, direction: DVec3, seed: u64, stream: u64) -> Vec<Vec<(f64, f64)>> {
        let look = (direction, Frame::level(self.certificate.observer().0.up, direction));
        let found = match self.shows {
            Shows::Radiance if self.solved.is_polarised() => self.stokes(look, |seen| [seen.i], (seed, stream)),
            Shows::Radiance => {
                vec![self.certificate.radiance(direction, self.certificate.fan(), self.fans(), seed, stream)]
            }
            Shows::Stokes => self.stokes(look, parameters, (seed, stream)),
            Shows::Filtered(angle) => self.stokes(look, passed(angle), (seed, stream)),
        };
        found.iter().map(|found| (0..self.count).map(|j| (found.mean[j], found.variance[j])).collect()).collect()
    }
}

/// A direction with what is known of it.
struct Looked {
    direction: DVec3,
    /// Of radiance, or of I, Q and U, at each wavelength.
    table: Vec<Vec<f64>>,
    /// Sums over rounds of means and of their variances.
    sums: Vec<Vec<(f64, f64)>>,
}

/// Directions of a picture, spread evenly over its pixels (R_2 of Roberts 2018).
pub(super) fn spread(camera: &Camera, (width, height): (u32, u32)) -> impl Iterator<Item = DVec3> {
    const STEPS: [f64; 2] = [0.754_877_666_246_692_7, 0.569_840_290_998_053_3];
    // Of the whole sphere a small part may be seen.
    const TRIES: u32 = 20_000;
    (0..TRIES).filter_map(move |i| {
        let [x, y] = STEPS.map(|step| (0.5 + step * f64::from(i + 1)).fract());
        let pixel = |share: f64, size: u32| (share * f64::from(size)).floor() + 0.5;
        camera.direction(pixel(x, width), pixel(y, height))
    })
}

/// Directions of a picture that see light.
fn directions(camera: &Camera, size: (u32, u32), packets: &[Box<dyn Certifies + '_>]) -> Vec<Looked> {
    spread(camera, size).filter_map(|direction| look(direction, packets)).take(DIRECTIONS).collect()
}

/// Looks at 96 directions of a picture of solved tables until it is clear, with 95 % confidence, whether their root mean square error
/// is below `asked`, that of each Stokes parameter if the picture has them, or each has had 64 rounds, or `stop` is set. The sun is the
/// middle of its disc. `None` if the picture has no solved tables or sees no light.
#[must_use]
pub fn certify(
    scene: &Scene,
    sky: &Sky,
    asked: f64,
    stop: &AtomicBool,
    observe: &(dyn Fn(f64) + Sync),
) -> Option<Verdict> {
    let packets = sky.certificates()?;
    let mut all = directions(&scene.camera(), scene.size(), &packets);
    if all.is_empty() {
        return None;
    }
    let (mut round, mut verdict) = (0, None);
    for rounds in LOOKS {
        while round < rounds && !(stop.load(Ordering::Relaxed) && round > 0) {
            go_round(&mut all, &packets, scene.seed, round);
            round += 1;
        }
        let judged = judge(&all, (round, packets[0].fans()), asked, NINE_LOOKS);
        observe(judged.most());
        let clear = judged.holds() || judged.fails();
        verdict = Some(judged);
        if clear || round < rounds {
            break;
        }
    }
    verdict
}

/// One more round of fans in every direction.
fn go_round(all: &mut [Looked], packets: &[Box<dyn Certifies + '_>], seed: u64, round: u32) {
    all.par_iter_mut().enumerate().for_each(|(i, looked)| {
        let stream = (i as u64) << 32 | u64::from(round);
        let found = joined(packets.iter().map(|packet| packet.certified(looked.direction, seed, stream)));
        for (sum, one) in looked.sums.iter_mut().flatten().zip(found.into_iter().flatten()) {
            sum.0 += one.0;
            sum.1 += one.1;
        }
    });
}

/// The rows of all packets, each longer by those of the next.
fn joined<T>(packets: impl Iterator<Item = Vec<Vec<T>>>) -> Vec<Vec<T>> {
    let mut all: Vec<Vec<T>> = Vec::new();
    for rows in packets {
        all.resize_with(rows.len(), Vec::new);
        all.iter_mut().zip(rows).for_each(|(all, row)| all.extend(row));
    }
    all
}

/// The verdict of so many rounds on a table for an observer and a sun, in directions that see light; `None` if none does. The
/// `columns` are those of the air with nothing cut off.
#[must_use]
pub fn certify_table<const L: usize>(
    solved: &Solved<L>,
    columns: Columns<L>,
    (from, sun): (Place, DVec3),
    directions: &[DVec3],
    rounds: u32,
) -> Option<Verdict> {
    let certificate = Certificate::new(solved, columns, from, sun);
    let shows = if solved.is_polarised() { Shows::Stokes } else { Shows::Radiance };
    let packets: [Box<dyn Certifies + '_>; 1] = [Box::new(Packet { solved, certificate, shows, count: L })];
    let mut all: Vec<Looked> = directions.iter().filter_map(|&direction| look(direction, &packets)).collect();
    for round in 0..rounds {
        go_round(&mut all, &packets, 0, round);
    }
    (!all.is_empty() && rounds > 0).then(|| judge(&all, (rounds, packets[0].fans()), f64::INFINITY, ONE_LOOK))
}

/// A direction and what the tables say of it; `None` in the dark.
fn look(direction: DVec3, packets: &[Box<dyn Certifies + '_>]) -> Option<Looked> {
    let table = joined(packets.iter().map(|packet| packet.table(direction)));
    let sums = table.iter().map(|row| vec![(0.0, 0.0); row.len()]).collect();
    table[0].iter().all(|&light| light > 0.0).then_some(Looked { direction, table, sums })
}

/// The verdict after some rounds of so many fans, the bounds so many standard errors above.
fn judge(all: &[Looked], (rounds, fans): (u32, u32), asked: f64, confident: f64) -> Verdict {
    let rows = all.first().map_or(0, |looked| looked.table.len());
    Verdict {
        asked,
        errors: (0..rows).map(|row| residual(all, row, (rounds, fans), confident)).collect(),
        size: (all.len(), all.len() as u64 * u64::from(rounds * fans)),
    }
}

/// The error of one row of what is shown, relative to the first.
///
/// Of each direction, x^2 - v is a square of the table's error e without bias: x the mean of all fans, v its variance; a mean over wavelengths.
/// How far the mean over directions may be off is told by their spread. But squares are skewed: where by chance few are large, both the mean and
/// the spread are too small. So its multiple c for the upper bound is raised by g (1 + 2 c^2) / (6 sqrt(n)) with the skewness g of the n
/// directions (Johnson 1978, Modified t tests and confidence intervals for asymmetrical populations), and the bound is at least c times
/// what the fans' own variances make of it, 2 v^2 + 4 e^2 v for each direction: `bounds_hold_in_95_percent`.
fn residual(all: &[Looked], row: usize, (rounds, fans): (u32, u32), confident: f64) -> Residual {
    let n = f64::from(rounds);
    // E(v^2) of so many degrees of freedom is more than the square of the mean.
    let freedom = n * f64::from(fans.max(2) - 1);
    let freedom = freedom / (freedom + 2.0);
    let first = all.first().map_or(DVec3::Z, |looked| looked.direction);
    let (mut worst, mut worst_direction) = ((0.0_f64, 0.0_f64), first);
    // Of each direction, means over wavelengths: error, squared error without what noise adds, and that.
    let rows: Vec<[f64; 3]> = all
        .iter()
        .map(|looked| {
            let count = looked.table[row].len() as f64;
            let (mut off, mut square, mut added, mut deviation) = (0.0, 0.0, 0.0, 0.0);
            let values = looked.table[row].iter().zip(&looked.sums[row]).zip(&looked.table[0]);
            for ((table, (mean, variance)), radiance) in values {
                let truth = mean / n;
                let (relative, noise) = ((table - truth) / radiance, variance / (n * n) / (radiance * radiance));
                off += relative / count;
                square += (relative * relative - noise) / count;
                added += noise / count;
                // Wavelengths share their paths: errors add up.
                deviation += noise.sqrt() / count;
            }
            if off.abs() > worst.0.abs() {
                (worst, worst_direction) = ((off, deviation), looked.direction);
            }
            [off, square, added]
        })
        .collect();
    let size = rows.len() as f64;
    let mean_of = |k: usize| rows.iter().map(|row| row[k]).sum::<f64>() / size;
    let moment = |k: usize, power: i32| {
        let mean = mean_of(k);
        rows.iter().map(|row| (row[k] - mean).powi(power)).sum::<f64>() / size
    };
    let spread = |k: usize| (moment(k, 2) / (size - 1.0).max(1.0)).sqrt();
    let square = mean_of(1);
    let known = square.max(0.0);
    let by_noise: f64 = rows.iter().map(|[.., v]| 2.0 * v * v * freedom + 4.0 * known * v).sum();
    let (by_noise, by_spread) = (by_noise.sqrt() / size, spread(1));
    let skewness = (moment(1, 3) / moment(1, 2).max(1e-300).powf(1.5)).max(0.0);
    let raised = confident + skewness * (1.0 + 2.0 * confident * confident) / (6.0 * size.sqrt());
    Residual {
        rms: known.sqrt(),
        most: (known + (raised * by_spread).max(confident * by_noise)).sqrt(),
        least: (square - confident * by_spread.max(by_noise)).max(0.0).sqrt(),
        mean: (mean_of(0), spread(0)),
        worst,
        worst_direction,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::Sampler;
    use std::f64::consts::TAU;

    /// Tables that are off by 1 in each of 96 directions, whose fans have so many times that noise, more or less by `uneven`: the share of
    /// certificates that say at one of their looks that it is less than 0.998.
    fn falsely_held(noise: f64, uneven: f64, fans: u32) -> f64 {
        const CERTIFICATES: u64 = 500;
        let held = (0..CERTIFICATES).filter(|&seed| {
            let mut sampler = Sampler::new(seed, 7, u64::from(fans));
            let mut normal = || {
                let [u, v] = sampler.uniform_2d();
                (-2.0 * (1.0 - u).ln()).sqrt() * (TAU * v).cos()
            };
            let noises: Vec<f64> = (0..DIRECTIONS).map(|_| noise * (uneven * normal()).exp()).collect();
            let looked = || Looked { direction: DVec3::Z, table: vec![vec![1000.0]], sums: vec![vec![(0.0, 0.0)]] };
            let mut all: Vec<Looked> = noises.iter().map(|_| looked()).collect();
            let mut round = 0;
            for rounds in LOOKS.into_iter().filter(|&rounds| rounds < 64) {
                for (one, noise) in all.iter_mut().zip(&noises) {
                    for _ in round..rounds {
                        let drawn: Vec<f64> = (0..fans).map(|_| 999.0 + noise * normal()).collect();
                        let count = f64::from(fans);
                        let mean = drawn.iter().sum::<f64>() / count;
                        let squares: f64 = drawn.iter().map(|one| (one - mean).powi(2)).sum();
                        one.sums[0][0].0 += mean;
                        one.sums[0][0].1 += squares / (count * (count - 1.0));
                    }
                }
                round = rounds;
                let judged = judge(&all, (round, fans), 0.998e-3, NINE_LOOKS);
                if judged.holds() || judged.fails() {
                    return judged.holds();
                }
            }
            false
        });
        held.count() as f64 / CERTIFICATES as f64
    }

    #[test]
    fn bounds_hold_in_95_percent() {
        // Of 500 a share of 5 % is known to 1 %.
        for (noise, uneven, fans) in [(2.0, 0.0, 2), (3.0, 0.0, 4), (2.0, 0.5, 2), (2.0, 0.5, 4), (1.0, 0.8, 4)] {
            let share = falsely_held(noise, uneven, fans);
            assert!(share <= 0.06, "{noise} {uneven} {fans}: {share}");
        }
    }

    #[test]
    fn nine_looks_together_have_95_percent() {
        // Numbers whose correlation is the ratio of rounds are a chain. Of 200 000 a share of 5 % is known to 0.05 %: three of its errors,
        // and as much for the constant's last digit.
        const CHAINS: u32 = 200_000;
        let mut sampler = Sampler::new(1, 2, 3);
        let mut normal = || {
            let [u, v] = sampler.uniform_2d();
            (-2.0 * (1.0 - u).ln()).sqrt() * (TAU * v).cos()
        };
        let above = (0..CHAINS).filter(|_| {
            let (mut one, mut greatest) = (normal(), f64::NEG_INFINITY);
            for (before, after) in LOOKS.iter().zip(LOOKS.iter().skip(1)) {
                greatest = one.max(greatest);
                let kept = f64::from(*before) / f64::from(*after);
                one = kept * one + (1.0 - kept * kept).sqrt() * normal();
            }
            one.max(greatest) > NINE_LOOKS
        });
        let share = above.count() as f64 / f64::from(CHAINS);
        assert!((0.0475..0.0515).contains(&share), "{share}");
    }

    #[test]
    fn verdicts_take_the_noise_out() {
        // Tables 1 % too bright, with a noise of 3 % in each of many directions.
        let looked = |i: usize| {
            let noise = 0.03 * if i.is_multiple_of(2) { 1.0 } else { -1.0 };
            let truth = 1.0 - 0.01 + noise;
            Looked {
                direction: DVec3::Z,
                table: vec![vec![1.0], vec![0.5]],
                sums: vec![vec![(4.0 * truth, 16.0 * 0.03 * 0.03)], vec![(4.0 * 0.48, 0.0)]],
            }
        };
        let all: Vec<_> = (0..100).map(looked).collect();
        let verdict = judge(&all, (4, 4), 0.1, ONE_LOOK);
        let [i, q] = [verdict.errors[0], verdict.errors[1]];
        assert!((i.rms - 0.01).abs() < 1e-9 && (i.mean.0 - 0.01).abs() < 1e-12, "{verdict:?}");
        assert!(verdict.holds() && i.most > 0.012, "{verdict:?}");
        // The second row is off by 0.02, of the first's 1, without noise.
        assert!((q.rms - 0.02).abs() < 1e-12 && (q.most - q.rms).abs() < 1e-12, "{verdict:?}");
        assert!(!judge(&all, (4, 4), 0.019, ONE_LOOK).holds() && judge(&all, (4, 4), 0.019, ONE_LOOK).fails());
    }
}
