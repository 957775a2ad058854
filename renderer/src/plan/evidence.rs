//! From measured scenes to others.
//!
//! The logarithm of each candidate's error and of each cost is kriged over the traits of scenes. How far such a prediction may be off depends
//! on where it is made: where the sun sets errors turn, by day they hardly change. So every measured scene is predicted from the
//! atmospheres other than its own, and standard deviations are widened by the mean of (off / standard deviation)^2 of the scenes near by.

use super::kriging::{Fit, Kriging, Without};
use super::measured::{Costs, Measured};
use super::predict::Prediction;
use super::{Candidate, Metric, Traits};

/// Errors at which margins are found and plans are judged; of colour in hundreds of units.
pub const ASKED: [f64; 4] = [0.05, 0.02, 0.01, 0.005];

/// Share of plans at each error that are to meet it where an atmosphere is left out of the measurements: of a hundred scenes kept apart 95 then do
/// so nine times in ten (at most five failures where three are expected).
const SURE: f64 = 0.97;

/// Margins that are tried, in standard deviations of the prediction.
const MARGINS: (f64, f64) = (0.0, 4.0);
const MARGIN_STEPS: u32 = 80;

/// What an error or a cost below this is taken for: nothing is measured so closely.
const LEAST: f64 = 1e-6;

/// Distance in units of [`Traits::coordinates`] over which predictions are off alike, and how many scenes of a surprise of 1 count beside
/// those that are there: by the likelihood of what predictions are off, which the test `deviations_are_as_wide_as_predictions_are_off` has.
const NEAR: f64 = 0.3;
const AT_FIRST: f64 = 0.2;

/// Measurements, made ready to predict from.
#[derive(Debug, Clone)]
pub struct Evidence {
    traits: Vec<Traits>,
    kriging: Kriging,
    /// Of each candidate and metric, then of each cost.
    fits: Vec<Fit>,
    /// Scenes of one atmosphere after another, predicted from the others.
    without: Vec<Without>,
    /// [scene][candidate and metric]: the square of what such a prediction of an error is off, in its standard deviations.
    surprises: Vec<Vec<f64>>,
    /// Of each metric.
    margins: [f64; 3],
}

/// How alike two scenes are, 1 of equal ones: Matern's covariance of order 3/2 of their distance; less for aerosols of two kinds.
pub(super) fn likeness(a: &Traits, b: &Traits) -> f64 {
    const OTHER_KIND: f64 = 0.8;
    let r = 3.0_f64.sqrt() * a.distance(b) / REACH;
    let kind = if a.biome == b.biome { 1.0 } else { OTHER_KIND };
    kind * (1.0 + r) * (-r).exp()
}

/// Distance in units of [`Traits::coordinates`] over which errors are alike.
const REACH: f64 = 2.0;

impl Evidence {
    /// From measurements, with the margins that are stored with them.
    ///
    /// # Errors
    /// A sentence, if there are fewer than two scenes.
    pub fn new(measured: &Measured) -> Result<Self, String> {
        let rows = &measured.rows;
        if rows.len() < 2 {
            return Err("too few measured scenes to predict from".into());
        }
        let traits: Vec<Traits> = rows.iter().map(|row| row.traits.clone()).collect();
        let kriging = Kriging::new(rows.len(), |i, j| likeness(&traits[i], &traits[j]));
        let costs = rows[0].costs.values().len();
        let of = |value: &dyn Fn(usize) -> f64| {
            let values: Vec<f64> = (0..rows.len()).map(|i| value(i).max(LEAST).ln()).collect();
            Fit::new(&kriging, &values)
        };
        let errors = (0..3 * Candidate::COUNT).map(|k| of(&|i| rows[i].errors[k / 3][k % 3]));
        let all: Vec<_> = rows.iter().map(|row| row.costs.values()).collect();
        // What took less than the clock tells is taken for the mean of the others.
        let costs = (0..costs).map(|k| {
            let told: Vec<f64> = all.iter().map(|values| values[k]).filter(|value| *value > LEAST).collect();
            let mean = (told.iter().map(|value| value.ln()).sum::<f64>() / told.len().max(1) as f64).exp();
            of(&|i| if all[i][k] > LEAST { all[i][k] } else { mean })
        });
        let fits: Vec<Fit> = errors.chain(costs).collect();
        let mut without = Vec::new();
        for own in rows.chunk_by(|a, b| a.atmosphere == b.atmosphere) {
            let first = without.last().map_or(0, |last: &Without| last.points.end);
            without.push(kriging.without(first..first + own.len()));
        }
        let mut surprises = vec![vec![0.0; 3 * Candidate::COUNT]; rows.len()];
        for one in &without {
            for (k, fit) in fits[..3 * Candidate::COUNT].iter().enumerate() {
                for (i, (mean, deviation)) in one.points.clone().zip(one.predicted(fit)) {
                    surprises[i][k] = ((fit.values[i] - mean) / deviation).powi(2);
                }
            }
        }
        Ok(Self { traits, kriging, fits, without, surprises, margins: measured.margins })
    }

    /// Standard deviations by which a metric's predictions are raised.
    #[must_use]
    pub fn margin(&self, metric: Metric) -> f64 {
        self.margins[metric as usize]
    }

    /// How many scenes were measured.
    #[must_use]
    pub fn scenes(&self) -> usize {
        self.traits.len()
    }

    /// What is predicted of a scene.
    #[must_use]
    pub fn predict(&self, traits: &Traits) -> Prediction {
        let k: Vec<f64> = self.traits.iter().map(|other| likeness(traits, other)).collect();
        let variance = self.kriging.variance(&k);
        let of = |fit: usize| self.fits[fit].at(&k, variance);
        self.prediction(&of, &self.widening(traits, None), variance)
    }

    /// Of every measured scene what the other atmospheres predict.
    fn left_out(&self) -> Vec<Prediction> {
        let predictions = self.without.iter().flat_map(|one| {
            let all: Vec<_> = self.fits.iter().map(|fit| one.predicted(fit)).collect();
            one.points.clone().enumerate().map(move |(at, scene)| {
                let widening = self.widening(&self.traits[scene], Some(one));
                self.prediction(&|fit| all[fit][at], &widening, one.variances[at])
            })
        });
        predictions.collect()
    }

    /// By how much standard deviations of errors are wider at a scene than the covariance has it, from all measured scenes `but` some. (What
    /// those are off was found with these among the others.)
    fn widening(&self, traits: &Traits, but: Option<&Without>) -> Vec<f64> {
        let (mut sums, mut all) = (vec![AT_FIRST; 3 * Candidate::COUNT], AT_FIRST);
        for (i, (other, surprises)) in self.traits.iter().zip(&self.surprises).enumerate() {
            if but.is_some_and(|but| but.points.contains(&i)) {
                continue;
            }
            let weight = (-0.5 * (traits.distance(other) / NEAR).powi(2)).exp();
            all += weight;
            sums.iter_mut().zip(surprises).for_each(|(sum, surprise)| *sum += weight * surprise);
        }
        sums.iter().map(|sum| (sum / all).sqrt()).collect()
    }

    /// From the mean and standard deviation `of` each fit, those of errors to be widened.
    fn prediction(&self, of: &dyn Fn(usize) -> (f64, f64), widening: &[f64], far: f64) -> Prediction {
        let error = |fit: usize| {
            let (mean, deviation) = of(fit);
            (mean, deviation * widening[fit])
        };
        let errors = (0..Candidate::COUNT).map(|i| [error(3 * i), error(3 * i + 1), error(3 * i + 2)]).collect();
        let costs = std::array::from_fn(|i| of(3 * Candidate::COUNT + i).0.exp());
        Prediction { errors, costs: Costs::from_values(&costs), far }
    }
}

/// Margins of the metrics: every scene is predicted from the atmospheres other than its own, and for each of [`ASKED`] a rung is chosen for it as a
/// plan would; the margin is the least with which 97 % of the choices at each error meet it.
///
/// # Errors
/// A sentence, if there are fewer than two atmospheres.
pub fn margins(measured: &Measured) -> Result<[f64; 3], String> {
    let evidence = Evidence::new(measured)?;
    if evidence.without.len() < 2 {
        return Err("one measured atmosphere alone, and none to predict it from".into());
    }
    let left_out = evidence.left_out();
    Ok(Metric::ALL.map(|metric| margin(metric, measured, &left_out)))
}

/// Pixels of the pictures for which margins are found.
const PIXELS: f64 = 256.0 * 256.0;

/// The least margin with which [`SURE`] of the choices for scenes predicted from others meet what was asked, at each error.
fn margin(metric: Metric, measured: &Measured, left_out: &[Prediction]) -> f64 {
    let met = |margin: f64| {
        let scenes = measured.rows.len() as f64;
        ASKED.iter().all(|&share| {
            let asked = metric.unit(share);
            let good = measured.rows.iter().zip(left_out).filter(|(row, prediction)| {
                // Paths, which are taken where there is no other, meet what they are asked for.
                let chosen = prediction.choose(asked, (metric, margin), PIXELS, &|_| true);
                chosen.is_none_or(|(i, _)| row.errors[i][metric as usize] <= asked)
            });
            good.count() as f64 >= SURE * scenes
        })
    };
    let (low, high) = MARGINS;
    let mut margins = (0..=MARGIN_STEPS).map(|i| low + (high - low) * f64::from(i) / f64::from(MARGIN_STEPS));
    margins.find(|margin| met(*margin)).unwrap_or(high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn deviations_are_as_wide_as_predictions_are_off() {
        // Minus the mean logarithm of the density of what is off, but for a constant. Of normal numbers with other deviations by a factor w
        // it is wrong by (w^2 - 1) / 2 - ln w: 0.2 for w = 1.6.
        let evidence = Evidence::new(&Measured::stored().expect("parses")).expect("enough");
        let (mut plain, mut widened, mut count) = (0.0, 0.0, 0.0);
        for one in &evidence.without {
            for scene in one.points.clone() {
                let widening = evidence.widening(&evidence.traits[scene], Some(one));
                for (surprise, wide) in evidence.surprises[scene].iter().zip(widening) {
                    plain += 0.5 * surprise;
                    widened += wide.ln() + 0.5 * surprise / (wide * wide);
                    count += 1.0;
                }
            }
        }
        assert!(widened / count < plain / count - 0.2, "{} {}", widened / count, plain / count);
    }
}
