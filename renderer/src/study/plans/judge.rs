//! Plans beside what is true, on scenes kept apart.

use crate::plan::{ASKED, Candidate, Evidence, Measured, Metric, Prediction, Row};
use crate::study::{Chart, Point};
use std::collections::BTreeSet;

/// Pixels of a picture.
const PIXELS: f64 = 256.0 * 256.0;

/// A plan for a measured scene.
struct Planned<'a> {
    row: &'a Row,
    metric: Metric,
    asked: f64,
    /// None: paths.
    candidate: Option<(usize, Candidate)>,
    prediction: &'a Prediction,
    margin: f64,
}

impl Planned<'_> {
    /// The true error; of paths that which they end with.
    fn true_error(&self) -> f64 {
        self.candidate.map_or(self.asked, |(i, _)| self.row.errors[i][self.metric as usize])
    }

    /// Core-seconds as measured.
    fn cost(&self) -> f64 {
        match self.candidate {
            Some((_, one)) => self.row.costs.of(one, PIXELS).iter().sum(),
            None => self.row.costs.of_paths(share(self.metric, self.asked), PIXELS),
        }
    }

    /// Core-seconds of the cheapest that truly meets the error, paths among them.
    fn least_cost(&self) -> f64 {
        let good =
            Candidate::all().enumerate().filter(|(i, _)| self.row.errors[*i][self.metric as usize] <= self.asked);
        let costs = good.map(|(_, one)| self.row.costs.of(one, PIXELS).iter().sum::<f64>());
        costs.fold(self.row.costs.of_paths(share(self.metric, self.asked), PIXELS), f64::min)
    }

    fn name(&self) -> String {
        self.candidate.map_or("paths".into(), |(_, one)| one.name())
    }

    /// The likely error and the bound.
    fn predicted(&self) -> [f64; 2] {
        self.candidate.map_or([self.asked; 2], |(i, _)| {
            [self.prediction.likely(i, self.metric), self.prediction.bound(i, self.metric, self.margin)]
        })
    }
}

fn share(metric: Metric, asked: f64) -> f64 {
    asked / metric.unit(1.0)
}

fn plan<'a>(evidence: &Evidence, row: &'a Row, prediction: &'a Prediction, metric: Metric, asked: f64) -> Planned<'a> {
    let margin = evidence.margin(metric);
    let chosen = prediction.choose(asked, (metric, margin), PIXELS, &|_| true);
    let candidate = chosen.and_then(|(i, _)| Some((i, Candidate::all().nth(i)?)));
    Planned { row, metric, asked, candidate, prediction, margin }
}

/// The least share of an error that is shown.
const LEAST: f64 = 1e-2;

/// What judged plans say, for people, and the points of a chart: in how many scenes the true error is so many times the asked one or more.
#[must_use]
pub fn judge(evidence: &Evidence, held_out: &Measured) -> (Vec<String>, Chart) {
    let predictions: Vec<Prediction> = held_out.rows.iter().map(|row| evidence.predict(&row.traits)).collect();
    let of = |metric: Metric, asked: f64| -> Vec<Planned<'_>> {
        held_out.rows.iter().zip(&predictions).map(|(row, p)| plan(evidence, row, p, metric, asked)).collect()
    };
    let mut lines = vec![format!(
        "{} scenes of {} atmospheres kept apart; planned by {} others",
        held_out.rows.len(),
        held_out.rows.iter().map(|row| row.atmosphere).collect::<BTreeSet<_>>().len(),
        evidence.scenes()
    )];
    let mut points = Vec::new();
    for metric in Metric::ALL {
        lines.push(format!(
            "{}, margin {:.1} standard deviations of the prediction",
            metric.name(),
            evidence.margin(metric)
        ));
        lines.push(
            "  asked            met      cost over least (median, 90th percentile, at most 2)  rungs  by paths".into(),
        );
        let mut rungs_of_all = BTreeSet::new();
        for level in ASKED {
            let asked = metric.unit(level);
            let plans = of(metric, asked);
            let count = plans.len() as f64;
            let met = plans.iter().filter(|plan| plan.true_error() <= asked).count() as f64 / count;
            let mut ratios: Vec<f64> = plans.iter().map(|plan| plan.cost() / plan.least_cost()).collect();
            ratios.sort_by(f64::total_cmp);
            let at = |share: f64| ratios[((ratios.len() - 1) as f64 * share).round() as usize];
            let twice = ratios.iter().filter(|ratio| **ratio <= 2.0).count() as f64 / count;
            let rungs: BTreeSet<String> = plans.iter().map(Planned::name).collect();
            let paths = plans.iter().filter(|plan| plan.candidate.is_none()).count();
            lines.push(format!(
                "  {:<15} {:>5.1} %  {:>6.2} {:>8.2} {:>7.0} %                               {:>3} {:>8}",
                metric.show(asked),
                100.0 * met,
                at(0.5),
                at(0.9),
                100.0 * twice,
                rungs.len(),
                paths
            ));
            rungs_of_all.extend(rungs);
            let mut shares: Vec<f64> = plans.iter().map(|plan| plan.true_error() / asked).collect();
            shares.sort_by(|a, b| b.total_cmp(a));
            points.extend((1..).zip(shares).map(|(k, share)| Point {
                panel: metric.name(),
                curve: format!("asked {} % (colour: units)", 100.0 * level),
                at: [share.max(LEAST), 100.0 * f64::from(k) / count],
            }));
        }
        lines.push(format!("  rungs: {}", rungs_of_all.into_iter().collect::<Vec<_>>().join(", ")));
    }
    lines.extend(table(&|i| {
        let (metric, asked) = (Metric::ALL[(i / 4) % 3], ASKED[i % 4]);
        let k = i * held_out.rows.len() / TWENTY;
        plan(evidence, &held_out.rows[k], &predictions[k], metric, metric.unit(asked))
    }));
    let axes = ["true error over the asked one", "scenes with as much or more / %"];
    (lines, Chart { title: "Plans for scenes kept apart: how often errors are met".into(), axes, points })
}

/// Scenes of the table.
const TWENTY: usize = 20;

/// A table of twenty plans.
fn table<'a>(of: &dyn Fn(usize) -> Planned<'a>) -> Vec<String> {
    let mut lines = vec![
        "twenty scenes, metrics and errors by turns; core-seconds as measured, beside the most exact table's".into(),
        "aerosol             depth   sun     km  albedo  asked             plan                  likely, with margin   true       core-s  exact".into(),
    ];
    let exact = Candidate::most_exact();
    for i in 0..TWENTY {
        let plan = of(i);
        let traits = &plan.row.traits;
        let [likely, bound] = plan.predicted().map(|error| plan.metric.show(error).replace(" CIEDE2000", ""));
        let true_error = plan.metric.show(plan.true_error()).replace(" CIEDE2000", "");
        let most = plan.row.costs.of(exact, PIXELS).iter().sum::<f64>();
        lines.push(format!(
            "{:<19} {:>5.3} {:>5.1} {:>6} {:>6.2}  {:<10} {:<6} {:<20} {:>8} {:>8} {:>9} {:>10.2} {:>6.1}",
            traits.biome.map_or("none", tables::views::Biome::name),
            traits.optical_depth,
            traits.sun_elevation_deg,
            (traits.altitude_km * 10.0).round() / 10.0,
            traits.albedo,
            plan.metric.name(),
            plan.metric.show(plan.asked).replace(" CIEDE2000", ""),
            plan.name(),
            likely,
            bound,
            true_error,
            plan.cost(),
            most
        ));
    }
    lines
}
