//! What is predicted of a scene, and the choice.

use super::evidence::Evidence;
use super::measured::Costs;
use super::{Candidate, Metric, Spectrum, Traits, Transfer};
use crate::render::PACKETS;
use crate::scene::Scene;
use crate::transport::{Fineness, Method};

/// An error as a metric counts it: a share, or units of CIEDE2000, of which one stands for one percent.
impl Metric {
    /// The number in the metric's unit.
    #[must_use]
    pub fn unit(self, share: f64) -> f64 {
        if self == Self::Colour { 100.0 * share } else { share }
    }
}

/// Variance left by the measured scenes, of 1 where there is none near, above which a scene counts as outside.
const FAR: f64 = 0.8;

/// Predicted errors and costs of a scene.
#[derive(Debug, Clone)]
pub struct Prediction {
    /// Of each candidate and metric, the natural logarithm of the error: mean and standard deviation.
    pub(super) errors: Vec<[(f64, f64); 3]>,
    /// Costs.
    pub costs: Costs,
    /// Share of the variance that the measured scenes leave, 0 to 1.
    pub far: f64,
}

impl Prediction {
    /// The error that a candidate has most likely.
    #[must_use]
    pub fn likely(&self, candidate: usize, metric: Metric) -> f64 {
        self.errors[candidate][metric as usize].0.exp()
    }

    /// The error so many standard deviations above that.
    #[must_use]
    pub fn bound(&self, candidate: usize, metric: Metric, margin: f64) -> f64 {
        let (mean, deviation) = self.errors[candidate][metric as usize];
        (mean + margin * deviation).exp()
    }

    /// The cheapest candidate for a picture of so many pixels whose bound meets an error, with its number; none if none does.
    fn cheapest(
        &self,
        asked: f64,
        (metric, margin): (Metric, f64),
        pixels: f64,
        allowed: &dyn Fn(Candidate) -> bool,
    ) -> Option<usize> {
        let all = Candidate::all().enumerate();
        let good = all.filter(|(i, one)| allowed(*one) && self.bound(*i, metric, margin) <= asked);
        good.map(|(i, one)| (i, self.costs.of(one, pixels).iter().sum::<f64>()))
            .min_by(|a, b| a.1.total_cmp(&b.1))
            .map(|(i, _)| i)
    }

    /// What a plan chooses, and whether its bound meets the error: if none does, the candidate of the least bound, should its likely error do so; else
    /// none.
    #[must_use]
    pub fn choose(
        &self,
        asked: f64,
        (metric, margin): (Metric, f64),
        pixels: f64,
        allowed: &dyn Fn(Candidate) -> bool,
    ) -> Option<(usize, bool)> {
        if let Some(i) = self.cheapest(asked, (metric, margin), pixels, allowed) {
            return Some((i, true));
        }
        let all = Candidate::all().enumerate().filter(|(_, one)| allowed(*one));
        let bound = |i: usize| self.bound(i, metric, margin);
        let (best, _) = all.min_by(|a, b| bound(a.0).total_cmp(&bound(b.0)))?;
        (self.likely(best, metric) <= asked).then_some((best, false))
    }
}

/// Why a plan is the safe one.
#[derive(Debug, Clone, PartialEq)]
pub enum Safe {
    /// The scene lies outside what was measured, and in what.
    Outside(String),
    /// No table is sure to be exact enough: the most exact one if it probably is, else paths.
    Exact,
}

/// What is to be done, and what is expected of it.
#[derive(Debug, Clone)]
pub struct Plan {
    /// What was asked, in the metric's unit.
    pub asked: f64,
    /// Of what.
    pub metric: Metric,
    /// What is chosen; none: paths until their own error is the asked one.
    pub candidate: Option<Candidate>,
    /// Why it is not the cheapest of those measured.
    pub safe: Option<Safe>,
    /// What is predicted of the scene; none outside what was measured.
    pub prediction: Option<Prediction>,
    /// The scene, as far as predictions go by it.
    pub traits: Traits,
    /// The margin in standard deviations.
    pub margin: f64,
    /// Pixels of the picture.
    pub pixels: f64,
}

impl Plan {
    /// For a scene of these traits, which lies `outside` what was measured in something or not: the cheapest candidate that is predicted to meet
    /// `asked` (in the metric's unit); the most exact table outside; paths where tables do not go, or are not exact enough.
    #[must_use]
    pub fn of(
        evidence: &Evidence,
        scene: &Scene,
        (traits, outside): (&Traits, Option<String>),
        asked: f64,
        metric: Metric,
    ) -> Self {
        let (width, height) = scene.size();
        let pixels = f64::from(width) * f64::from(height);
        let margin = evidence.margin(metric);
        let (candidate, safe, prediction) = (None, None, None);
        let plan = Self { asked, metric, candidate, safe, prediction, traits: traits.clone(), margin, pixels };
        let prediction = evidence.predict(traits);
        let far = (prediction.far > FAR).then(|| "anything near it".to_owned());
        if let Some(what) = outside.or(far) {
            const DEEP_DEG: f64 = -12.0;
            let no_table = scene.flat || scene.orders.is_some() || traits.sun_elevation_deg < DEEP_DEG;
            let candidate = (!no_table).then(Candidate::most_exact);
            return Self { candidate, safe: Some(Safe::Outside(what)), ..plan };
        }
        let chosen = prediction.choose(asked, (metric, margin), pixels, &|one| suits(scene, one));
        let (candidate, sure) = chosen.map_or((None, false), |(i, sure)| (Candidate::all().nth(i), sure));
        let safe = (!sure).then_some(Safe::Exact);
        Self { candidate, safe, prediction: Some(prediction), ..plan }
    }

    /// The next rung up: the cheapest candidate whose bound is at most half of this one's; then paths; none above those.
    #[must_use]
    pub fn up(&self, scene: &Scene) -> Option<Self> {
        let candidate = self.candidate?;
        let next = self.prediction.as_ref().and_then(|prediction| {
            let now = Candidate::all().position(|one| one == candidate)?;
            let half = 0.5 * prediction.bound(now, self.metric, self.margin);
            prediction.cheapest(half.min(self.asked), (self.metric, self.margin), self.pixels, &|one| suits(scene, one))
        });
        let candidate = next.and_then(|i| Candidate::all().nth(i));
        let safe = candidate.is_none().then_some(Safe::Exact).or(self.safe.clone());
        Some(Self { candidate, safe, ..self.clone() })
    }

    /// What was asked as a share, a unit of CIEDE2000 as one percent.
    fn share(&self) -> f64 {
        (self.asked / self.metric.unit(1.0)).clamp(1e-5, 1.0)
    }

    /// The scene as it is planned.
    #[must_use]
    pub fn scene(&self, scene: &Scene) -> Scene {
        let share = self.share();
        match (self.candidate, &self.safe) {
            // What decides the wavelengths of a scene outside is the scene.
            (Some(one), Some(Safe::Outside(_))) => {
                let mut made = one.of(scene, share);
                if scene.wavelengths() != crate::spectrum::Wavelengths::default() {
                    made.wavelengths_nm.clone_from(&scene.wavelengths_nm);
                }
                let known = scene.phase == crate::atmosphere::HazePhase::Mie || scene.biome.is_none();
                made.follow_polarisation = made.follow_polarisation.map(|followed| followed && known);
                made
            }
            (Some(one), _) => one.of(scene, share),
            (None, _) => {
                let stokes = scene.polarisation || scene.filter_deg.is_some();
                let known = scene.phase == crate::atmosphere::HazePhase::Mie || scene.biome.is_none();
                Scene {
                    method: Method::Paths,
                    fineness: None,
                    steps: None,
                    spp: None,
                    error: Some(share),
                    follow_polarisation: (!stokes).then_some(known),
                    ..scene.clone()
                }
            }
        }
    }

    /// How many paths may judge the picture at random pixels: what a core does in the larger of one second and a fifth of the picture's cost, less what
    /// they need before the first. The least number outside what was measured.
    #[must_use]
    pub fn checking_paths(&self) -> u64 {
        const LEAST: u64 = 4096;
        const SAFETY: f64 = 0.7;
        const BEFORE_S: f64 = 0.2;
        let (Some(prediction), Some(cost)) = (&self.prediction, self.cost()) else { return LEAST };
        let seconds = SAFETY * (0.2 * cost.iter().sum::<f64>()).max(1.0) - BEFORE_S;
        let [path_s, _] = prediction.costs.path;
        // Radiance is asked at sixteen wavelengths.
        let packets = if self.metric == Metric::Radiance { 1 } else { PACKETS };
        LEAST.max((seconds / (path_s * packets as f64)) as u64)
    }

    /// What is left out, what of it is likely to be off, and what would be with it.
    #[must_use]
    pub fn left_out(&self) -> Vec<(String, [f64; 2])> {
        let (Some(prediction), Some(chosen)) = (&self.prediction, self.candidate) else { return Vec::new() };
        let likely = |one: Candidate| {
            let i = Candidate::all().position(|other| other == one);
            i.map_or(f64::NAN, |i| prediction.likely(i, self.metric))
        };
        let Candidate { transfer, spectrum } = chosen;
        let with = |transfer: Transfer, spectrum: Spectrum| [likely(chosen), likely(Candidate { transfer, spectrum })];
        let fine = Transfer { fineness: Some(Fineness::Fine), ..transfer };
        let mut lines = Vec::new();
        match transfer.fineness {
            None => lines.push((
                "where light scattered twice or more comes from and goes to".into(),
                with(Transfer { polarised: false, ..fine }, spectrum),
            )),
            Some(Fineness::Fine | Fineness::Finest) => {}
            Some(fineness) => {
                let [own, most] = [fineness, Fineness::Fine].map(Fineness::resolution);
                lines.push((
                    format!(
                        "levels, suns and moments of finer tables ({} of {} levels, {} of {} suns)",
                        own.levels, most.levels, own.suns, most.suns
                    ),
                    with(fine, spectrum),
                ));
            }
        }
        if !transfer.polarised {
            lines.push((
                "polarisation".into(),
                with(Transfer { fineness: transfer.fineness.or(Some(Fineness::Coarse)), polarised: true }, spectrum),
            ));
        }
        // Radiance is asked at sixteen wavelengths.
        let all = if self.metric == Metric::Radiance { Spectrum::Even16 } else { Spectrum::Even31 };
        if spectrum != all && spectrum != Spectrum::Even31 {
            let count = spectrum.places().len();
            lines.push((format!("wavelengths ({count} of {})", all.places().len()), with(transfer, all)));
        }
        lines
    }

    /// Predicted error: likely, and with the margin.
    #[must_use]
    pub fn error(&self) -> Option<[f64; 2]> {
        let (prediction, candidate) = (self.prediction.as_ref()?, self.candidate?);
        let i = Candidate::all().position(|one| one == candidate)?;
        Some([prediction.likely(i, self.metric), prediction.bound(i, self.metric, self.margin)])
    }

    /// Predicted core-seconds: what is made once, and the picture.
    #[must_use]
    pub fn cost(&self) -> Option<[f64; 2]> {
        let costs = &self.prediction.as_ref()?.costs;
        Some(match self.candidate {
            Some(one) => costs.of(one, self.pixels),
            None => [0.0, costs.of_paths(self.share(), self.pixels)],
        })
    }
}

/// Whether a candidate gives what a picture keeps: Stokes parameters want polarised light.
fn suits(scene: &Scene, candidate: Candidate) -> bool {
    candidate.transfer.polarised || !(scene.polarisation || scene.filter_deg.is_some())
}
