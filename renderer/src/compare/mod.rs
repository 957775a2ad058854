//! How far two pictures of one scene differ, and whether that is more than their noise.

mod picture;

pub use picture::{DIFFERING, Shown, difference_picture};

use crate::film::{Channels, tone};
use crate::spectrum::{ciede2000, luminance, xyz};
use std::collections::BTreeMap;

/// Why two pictures cannot be compared.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum Unlike {
    /// They have other pixels.
    #[error("the first is {} x {} pixels, the second {} x {}: render both at one size", a.0, a.1, b.0, b.1)]
    Size {
        /// Width and height of the first.
        a: (usize, usize),
        /// Of the second.
        b: (usize, usize),
    },
    /// They have no channel in common.
    #[error("they have no channel in common: the first has {a}, the second {b}")]
    Channels {
        /// Names of the first.
        a: String,
        /// Of the second.
        b: String,
    },
}

/// A difference in one pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worst {
    /// Column and row from the upper left.
    pub pixel: (usize, usize),
    /// How far the second lies above the first there, in the unit of its list.
    pub off: f64,
    /// The values of both there, in the unit of the channel.
    pub values: [f64; 2],
}

/// How many standard errors two pictures are apart: z = (b - a) / sqrt(e_a^2 + e_b^2), over the pixels in which one of the errors is known (a finite number
/// above 0; where the other is infinite, as of a picture without noise, it counts as 0).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scores {
    /// Root mean square, 1 if nothing but noise differs.
    pub rms: f64,
    /// Mean, 0 +- 1/sqrt(pixels) if nothing but noise differs.
    pub mean: f64,
    /// The largest, `off` being z.
    pub worst: Worst,
    /// In how many pixels.
    pub pixels: usize,
}

/// How a channel of the second picture differs from that of the first.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// Its name; `Y` is luminance, of R, G and B.
    pub channel: String,
    /// What differences are relative to: the mean over the pixels of the first picture's absolute values; of Q, U and V (S1, S2, S3)
    /// that of I at their wavelength; 1 of the degree of polarisation.
    pub scale: f64,
    /// Root mean square of the differences b - a over the scale.
    pub rms: f64,
    /// Mean of b - a over the scale.
    pub mean: f64,
    /// The largest |b - a|, `off` being (b - a) over the scale.
    pub worst: Worst,
    /// Beside the errors that the pictures store.
    pub scores: Option<Scores>,
    /// Pixels in which one picture or both are not finite; they count nowhere else.
    pub not_finite: usize,
}

/// How colours differ as a display shows them, both pictures by one exposure: units of CIEDE2000, of which 1 is about what an eye tells apart.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Colours {
    /// Mean over the pixels.
    pub mean: f64,
    /// What 95 % of the pixels do not exceed.
    pub most_of_95_percent: f64,
    /// The largest, with the luminances of both in cd/m^2.
    pub worst: Worst,
}

/// Two pictures beside each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Width and height in pixels.
    pub size: (usize, usize),
    /// By channel: R, G, B, Y, then all others in alphabetical order.
    pub differences: Vec<Difference>,
    /// Of pictures with R, G and B.
    pub colours: Option<Colours>,
    /// Channels that one of them lacks.
    pub only_one: Vec<String>,
}

/// Channels of errors begin so.
const ERROR: &str = "error.";

impl Comparison {
    /// Compares `b` with `a`. Angles of polarisation, which turn, are left out; their Q and U are compared.
    ///
    /// # Errors
    /// [`Unlike`] if they differ in size or have no channel in common.
    pub fn new(a: &Channels, b: &Channels) -> Result<Self, Unlike> {
        if a.size != b.size {
            return Err(Unlike::Size { a: a.size, b: b.size });
        }
        let (a_all, b_all) = (with_luminance(a), with_luminance(b));
        let value = |name: &&String| !name.starts_with(ERROR) && name.as_str() != "AoLP";
        let mut names: Vec<&String> = a_all.keys().filter(value).filter(|name| b_all.contains_key(*name)).collect();
        if names.is_empty() {
            let list = |of: &Channels| of.samples.keys().cloned().collect::<Vec<_>>().join(", ");
            return Err(Unlike::Channels { a: list(a), b: list(b) });
        }
        let first = |name: &str| ["R", "G", "B", "Y"].iter().position(|own| *own == name).unwrap_or(4);
        names.sort_by_key(|name| (first(name), name.as_str()));
        let differences = names.iter().map(|name| {
            let errors = [&a_all, &b_all].map(|all| all.get(&format!("{ERROR}{name}")).map(Vec::as_slice));
            difference(name, a.size.0, (&a_all[*name], &b_all[*name]), errors, scale(name, &a_all))
        });
        let only_one = a.samples.keys().chain(b.samples.keys()).filter(value);
        let only_one = only_one.filter(|name| a.samples.contains_key(*name) != b.samples.contains_key(*name));
        Ok(Self {
            size: a.size,
            differences: differences.collect(),
            colours: colours(a, b),
            only_one: only_one.cloned().collect(),
        })
    }

    /// The largest relative root mean square difference of a channel; infinite if a pixel is not finite.
    #[must_use]
    pub fn most(&self) -> f64 {
        let of = |difference: &Difference| if difference.not_finite > 0 { f64::INFINITY } else { difference.rms };
        self.differences.iter().map(of).fold(0.0, f64::max)
    }
}

/// All channels in double precision, and the luminance Y.
fn with_luminance(picture: &Channels) -> BTreeMap<String, Vec<f64>> {
    let wide = |(name, values): (&String, &Vec<f32>)| (name.clone(), values.iter().copied().map(f64::from).collect());
    let mut all: BTreeMap<String, Vec<f64>> = picture.samples.iter().map(wide).collect();
    if let Some(rgb) = picture.rgb() {
        all.insert("Y".into(), rgb.into_iter().map(luminance).collect());
    }
    all
}

/// See [`Difference::scale`].
fn scale(name: &str, a: &BTreeMap<String, Vec<f64>>) -> f64 {
    if name == "DoLP" {
        return 1.0;
    }
    let intensity = ["S1.", "S2.", "S3."].iter().find_map(|own| name.strip_prefix(own)).map(|nm| format!("S0.{nm}"));
    let values = intensity.and_then(|name| a.get(&name)).or_else(|| a.get(name)).map_or(&[][..], Vec::as_slice);
    let finite = || values.iter().filter(|value| value.is_finite());
    finite().map(|value| value.abs()).sum::<f64>() / finite().count().max(1) as f64
}

/// One channel.
fn difference(
    name: &str,
    width: usize,
    (a, b): (&[f64], &[f64]),
    errors: [Option<&[f64]>; 2],
    scale: f64,
) -> Difference {
    let place = |index: usize| (index % width, index / width);
    let mut worst = Worst { pixel: (0, 0), off: 0.0, values: [0.0; 2] };
    let (mut count, mut sum, mut squares, mut not_finite) = (0.0, 0.0, 0.0, 0);
    let mut scores: Vec<(usize, f64)> = Vec::new();
    for (index, (&a, &b)) in a.iter().zip(b).enumerate() {
        if !a.is_finite() || !b.is_finite() {
            not_finite += 1;
            continue;
        }
        // Equal black pictures are equal.
        let off = if a == b { 0.0 } else { (b - a) / scale };
        (count, sum, squares) = (count + 1.0, sum + off, squares + off * off);
        if off.abs() > worst.off.abs() || count == 1.0 {
            worst = Worst { pixel: place(index), off, values: [a, b] };
        }
        let known = errors.into_iter().flatten().map(|errors| errors[index]).filter(|e| e.is_finite() && *e > 0.0);
        let variance: f64 = known.map(|error| error * error).sum();
        if variance > 0.0 {
            scores.push((index, (b - a) / variance.sqrt()));
        }
    }
    let over = |sum: f64| if count > 0.0 { sum / count } else { f64::NAN };
    let of = |index: usize, off: f64| Worst { pixel: place(index), off, values: [a[index], b[index]] };
    Difference {
        channel: name.into(),
        scale,
        rms: over(squares).sqrt(),
        mean: over(sum),
        worst,
        scores: scores_of(&scores).map(|(rms, mean, (index, off))| Scores {
            rms,
            mean,
            worst: of(index, off),
            pixels: scores.len(),
        }),
        not_finite,
    }
}

/// Root mean square, mean, and the largest with its pixel.
fn scores_of(scores: &[(usize, f64)]) -> Option<(f64, f64, (usize, f64))> {
    let worst = *scores.iter().max_by(|(_, a), (_, b)| a.abs().total_cmp(&b.abs()))?;
    let mean = |of: fn(f64) -> f64| scores.iter().map(|(_, z)| of(*z)).sum::<f64>() / scores.len() as f64;
    Some((mean(|z| z * z).sqrt(), mean(|z| z), worst))
}

/// Colours by the exposure of the first picture ([`tone::automatic_white`]).
fn colours(a: &Channels, b: &Channels) -> Option<Colours> {
    let (a_rgb, b_rgb) = (a.rgb()?, b.rgb()?);
    let lit: Vec<f64> = a_rgb.iter().map(|rgb| luminance(*rgb)).filter(|y| y.is_finite() && *y > 0.0).collect();
    if lit.is_empty() {
        return None;
    }
    let white = tone::automatic_white(&lit);
    let shown = |rgb: [f64; 3]| tone::displayed(xyz(rgb), white);
    let mut all: Vec<(usize, f64)> = Vec::new();
    for (index, (a, b)) in a_rgb.iter().zip(&b_rgb).enumerate() {
        if a.iter().chain(b).all(|value| value.is_finite()) {
            all.push((index, ciede2000(shown(*a), shown(*b))));
        }
    }
    all.sort_by(|(i, x), (j, y)| x.total_cmp(y).then(j.cmp(i)));
    let &(index, off) = all.last()?;
    Some(Colours {
        mean: all.iter().map(|(_, off)| off).sum::<f64>() / all.len() as f64,
        most_of_95_percent: all[(all.len() - 1) * 95 / 100].1,
        worst: Worst {
            pixel: (index % a.size.0, index / a.size.0),
            off,
            values: [luminance(a_rgb[index]), luminance(b_rgb[index])],
        },
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A picture of 2 x 2 pixels with these channels.
    pub(super) fn picture(channels: &[(&str, [f32; 4])]) -> Channels {
        let samples = channels.iter().map(|(name, values)| ((*name).to_owned(), values.to_vec())).collect();
        Channels { size: (2, 2), samples }
    }

    fn of<'a>(comparison: &'a Comparison, channel: &str) -> &'a Difference {
        comparison.differences.iter().find(|difference| difference.channel == channel).expect("compared")
    }

    #[test]
    fn a_picture_is_equal_to_itself() {
        let a = picture(&[("R", [1.0, 2.0, 3.0, 0.0]), ("G", [1.0; 4]), ("B", [0.5; 4]), ("S0.550,000nm", [0.0; 4])]);
        let same = Comparison::new(&a, &a).expect("alike");
        assert_eq!((same.most(), same.colours.map(|colours| colours.worst.off)), (0.0, Some(0.0)));
        let names: Vec<&str> = same.differences.iter().map(|difference| difference.channel.as_str()).collect();
        assert_eq!(names, ["R", "G", "B", "Y", "S0.550,000nm"]);
    }

    #[test]
    fn differences_are_relative_to_the_mean_and_the_worst_pixel_is_named() {
        // The mean is 2; differences 0, 0, -0.4, 0.2: rms sqrt(0.2 / 4) / 2, mean -0.05 / 2, worst -0.2 in the lower left.
        let a = picture(&[("S0.550,000nm", [1.0, 2.0, 3.0, 2.0])]);
        let b = picture(&[("S0.550,000nm", [1.0, 2.0, 2.6, 2.2])]);
        let comparison = Comparison::new(&a, &b).expect("alike");
        let found = of(&comparison, "S0.550,000nm");
        // 32-bit samples.
        let near = |a: f64, b: f64| (a - b).abs() < 1e-6;
        assert!(near(found.rms, 0.05_f64.sqrt() / 2.0) && near(found.mean, -0.025), "{found:?}");
        assert!(found.worst.pixel == (0, 1) && near(found.worst.off, -0.2), "{found:?}");
        assert_eq!((found.scores, comparison.colours), (None, None));
    }

    #[test]
    fn scores_are_differences_over_both_errors() {
        let errors = |own: [f32; 4]| picture(&[("R", [10.0; 4]), ("G", [1.0; 4]), ("B", [1.0; 4]), ("error.R", own)]);
        let mut b = errors([4.0, 4.0, 0.0, 2.0]);
        b.samples.insert("R".into(), vec![15.0, 10.0, 11.0, 10.0]);
        // 3 and 4 are 5; an infinite error leaves that of the other; two that are not known have no score.
        let a = errors([3.0, f32::INFINITY, 0.0, 0.0]);
        let comparison = Comparison::new(&a, &b).expect("alike");
        let scores = of(&comparison, "R").scores.expect("errors are stored");
        assert_eq!((scores.pixels, scores.worst.pixel, scores.worst.off), (3, (0, 0), 1.0));
        assert!((scores.rms - (1.0_f64 / 3.0).sqrt()).abs() < 1e-12 && (scores.mean - 1.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn stokes_parameters_are_relative_to_intensity_and_angles_are_left_out() {
        let at = |q: f32| {
            picture(&[("S0.550,000nm", [4.0; 4]), ("S1.550,000nm", [q; 4]), ("AoLP", [q; 4]), ("DoLP", [0.25; 4])])
        };
        let comparison = Comparison::new(&at(0.0), &at(1.0)).expect("alike");
        assert_eq!(of(&comparison, "S1.550,000nm").rms, 0.25);
        assert_eq!(comparison.differences.len(), 3);
    }

    #[test]
    fn what_is_not_finite_is_never_within_a_bound() {
        let a = picture(&[("S0.550,000nm", [1.0; 4])]);
        let b = picture(&[("S0.550,000nm", [1.0, f32::NAN, 1.0, 1.0])]);
        let comparison = Comparison::new(&a, &b).expect("alike");
        assert_eq!((comparison.differences[0].not_finite, comparison.most()), (1, f64::INFINITY));
    }

    #[test]
    fn unlike_pictures_are_refused_with_both_sides() {
        let a = picture(&[("R", [1.0; 4])]);
        let wide = Channels { size: (4, 1), ..a.clone() };
        assert!(Comparison::new(&a, &wide).expect_err("size").to_string().contains("2 x 2 pixels, the second 4 x 1"));
        let other = picture(&[("Z", [1.0; 4])]);
        assert!(Comparison::new(&a, &other).expect_err("channels").to_string().contains("first has R, the second Z"));
    }

    #[test]
    fn a_colour_that_is_twice_as_bright_is_told() {
        let grey = |y: f32| picture(&[("R", [y; 4]), ("G", [y; 4]), ("B", [y; 4])]);
        let colours = Comparison::new(&grey(100.0), &grey(200.0)).expect("alike").colours.expect("colours");
        // 22 % and 44 % of white are L* 54.0 and 72.2; the mean L* of 63.1 has S_L = 1.185: 15.3 units.
        assert!((colours.mean - 15.3).abs() < 0.2 && colours.mean == colours.worst.off, "{colours:?}");
    }
}
