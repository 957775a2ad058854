//! Henyey-Greenstein functions in place of the Mie phase functions of the biomes: what is fitted, and what each costs.
//!
//! The phase function of a biome is that of its whole column, each species weighted with its optical depth of
//! scattering, from the written tables at their default humidities.

#[cfg(feature = "plot")]
mod figure;
mod sky;
#[cfg(test)]
mod tests;

#[cfg(feature = "plot")]
pub(super) use figure::figure;

use super::{Part, Results, StudyError};
use crate::aerosol::fit::{Errors, Fit, Form, Observed, WORST_FROM_DEG};
use crate::column::{Column, Place};
use crate::data::Data;
use crate::frame::Frame;
use rayon::prelude::*;
use sky::{Sky, SkyError};
use tables::views::{AerosolSource, Biome, REFERENCE_WAVELENGTH_NM};

/// The asymmetry that the thesis gives to every aerosol.
const THESIS_G: f64 = 0.76;

/// Step of the wavelengths, nm.
const STEP_NM: u32 = 50;

/// Names of the parts: parameters and errors, phase functions at 550 nm, and what 0.76 costs at 550 nm.
const FITS: [&str; 2] = ["opac", "jaenicke"];
const FUNCTIONS: [&str; 2] = ["opac-functions", "jaenicke-functions"];
const COSTS: [&str; 2] = ["opac-costs", "jaenicke-costs"];

/// What stands in place of a phase function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Stand {
    /// One function of the thesis' asymmetry.
    Thesis,
    /// A fit.
    Fitted(Form),
}

impl Stand {
    const ALL: [Self; 6] = [
        Self::Thesis,
        Self::Fitted(Form::Single),
        Self::Fitted(Form::FittedSingle),
        Self::Fitted(Form::Moments),
        Self::Fitted(Form::Double),
        Self::Fitted(Form::FreeDouble),
    ];

    /// Its name in the CSV.
    fn key(self) -> &'static str {
        match self {
            Self::Thesis => "thesis",
            Self::Fitted(Form::Single) => "single",
            Self::Fitted(Form::FittedSingle) => "fitted_single",
            Self::Fitted(Form::Moments) => "moments",
            Self::Fitted(Form::Double) => "double",
            Self::Fitted(Form::FreeDouble) => "free_double",
        }
    }

    fn of(self, observed: &Observed<'_>) -> Option<Fit> {
        match self {
            Self::Thesis => Some(Fit::single(THESIS_G)),
            Self::Fitted(form) => observed.fit(form),
        }
    }
}

/// One stand-in for a biome's phase function at one wavelength.
struct Cost {
    stand: Stand,
    /// With its errors; none if there is no such fit.
    fit: Option<(Fit, Errors, SkyError)>,
}

/// A biome at one wavelength.
struct Case {
    biome: Biome,
    wavelength_nm: u32,
    sky: Sky,
    moments: [f64; 3],
    backward: f64,
    costs: Vec<Cost>,
}

impl Case {
    fn new(column: &Column, cosines: &[f64], biome: Biome, wavelength_nm: u32) -> Result<Self, StudyError> {
        let sky = Sky::new(column, f64::from(wavelength_nm), cosines)?;
        let observed = Observed::new(&sky.cosines, &sky.aerosol);
        let cost = |stand: Stand| Cost {
            stand,
            fit: stand.of(&observed).map(|fit| (fit, observed.errors(&fit), sky.error(&fit))),
        };
        let costs = Stand::ALL.into_iter().map(cost).collect();
        let (moments, backward) = (observed.moments(), observed.backward());
        Ok(Self { biome, wavelength_nm, moments, backward, costs, sky })
    }

    fn cost(&self, stand: Stand) -> Option<&(Fit, Errors, SkyError)> {
        self.costs.iter().find(|cost| cost.stand == stand).and_then(|cost| cost.fit.as_ref())
    }
}

/// Every biome of a source at every wavelength.
fn cases(data: Data<'_>, source: AerosolSource) -> Result<Vec<Case>, StudyError> {
    let mut jobs = Vec::new();
    for biome in Biome::ALL {
        let column = Column::read(data, &Place { biome: Some(biome), source, ..Place::default() })?;
        let cosines = data.aerosol(source, biome)?.species.first().map(|s| s.cosines().to_vec()).unwrap_or_default();
        jobs.extend((300..=1000).step_by(STEP_NM as usize).map(|nm| (column.clone(), cosines.clone(), biome, nm)));
    }
    jobs.par_iter().map(|(column, cosines, biome, nm)| Case::new(column, cosines, *biome, *nm)).collect()
}

/// Whether a case is at the wavelength of the figures.
fn is_reference(case: &Case) -> bool {
    f64::from(case.wavelength_nm) == REFERENCE_WAVELENGTH_NM
}

/// A frame of a row for each stand-in of each case.
fn fits(cases: &[&Case]) -> Result<Frame, StudyError> {
    let rows: Vec<(&Case, &Cost)> =
        cases.iter().flat_map(|case| case.costs.iter().map(move |cost| (*case, cost))).collect();
    let texts = |text: fn(&Case, &Cost) -> &'static str| -> Vec<String> {
        rows.iter().map(|(case, cost)| text(case, cost).to_owned()).collect()
    };
    let of_case = |value: fn(&Case) -> f64| -> Vec<f64> { rows.iter().map(|(case, _)| value(case)).collect() };
    let of_fit = |value: fn(&(Fit, Errors, SkyError)) -> f64| -> Vec<f64> {
        rows.iter().map(|(_, cost)| cost.fit.as_ref().map_or(f64::NAN, value)).collect()
    };
    let frame = Frame::new([
        ("wavelength_nm", of_case(|case| f64::from(case.wavelength_nm))),
        ("mie_g", of_case(|case| case.moments[0])),
        ("mie_chi_2", of_case(|case| case.moments[1])),
        ("mie_chi_3", of_case(|case| case.moments[2])),
        ("mie_backward", of_case(|case| case.backward)),
        ("g1", of_fit(|(fit, ..)| fit.g1)),
        // A single function has no second.
        ("g2", of_fit(|(fit, ..)| if fit.weight < 1.0 { fit.g2 } else { f64::NAN })),
        ("weight", of_fit(|(fit, ..)| fit.weight)),
        ("relative_rms", of_fit(|(_, errors, _)| errors.relative)),
        ("logarithmic_rms", of_fit(|(_, errors, _)| errors.logarithmic)),
        ("worst_relative_from_10_deg", of_fit(|(_, errors, _)| errors.worst)),
        ("misplaced", of_fit(|(_, errors, _)| errors.misplaced)),
        ("backward_error", of_fit(|(_, errors, _)| errors.backward)),
        ("sky_rms", of_fit(|(.., sky)| sky.rms)),
        ("sky_mean", of_fit(|(.., sky)| sky.mean)),
    ])?;
    let labels = [("biome", texts(|case, _| case.biome.name())), ("form", texts(|_, cost| cost.stand.key()))];
    Ok(frame.labelled(labels)?)
}

/// The column of a stand-in for a biome's phase function, or of that itself.
fn column(biome: Biome, what: &str) -> String {
    format!("{}_{what}_per_sr", biome.name().replace('-', "_"))
}

/// Phase functions and their stand-ins against the angle.
fn functions(cases: &[&Case]) -> Result<Frame, StudyError> {
    let mut columns = Vec::new();
    for case in cases {
        if columns.is_empty() {
            let degrees = case.sky.cosines.iter().map(|mu| mu.acos().to_degrees()).collect();
            columns.push(("angle_deg".to_owned(), degrees));
        }
        columns.push((column(case.biome, "mie"), case.sky.aerosol.clone()));
        for (stand, (fit, ..)) in case.costs.iter().filter_map(|cost| Some((cost.stand, cost.fit.as_ref()?))) {
            let values = case.sky.cosines.iter().map(|&mu| fit.phase(mu)).collect();
            columns.push((column(case.biome, stand.key()), values));
        }
    }
    Ok(Frame::new(columns)?)
}

/// What the thesis' asymmetry costs in a biome, in words.
fn remark(source: AerosolSource, case: &Case) -> Option<String> {
    let (_, thesis, sky) = case.cost(Stand::Thesis)?;
    let (own, single, own_sky) = case.cost(Stand::Fitted(Form::Single))?;
    let (double, two, double_sky) = case.cost(Stand::Fitted(Form::Double))?;
    let percent = |value: f64| 100.0 * value;
    Some(format!(
        "{source} {}, {} nm: g = {:.3}, and 0.76 misplaces {:.1} % of the light, {:+.1} % of it backward, sky {:+.1} % \
         (rms {:.1} %); HG of that g misplaces {:.1} %, sky rms {:.1} %; two (g {:.3} and {:.3}, weight {:.3}) {:.1} %, \
         sky rms {:.1} %",
        case.biome,
        case.wavelength_nm,
        own.g1,
        percent(thesis.misplaced),
        percent(thesis.backward),
        percent(sky.mean),
        percent(sky.rms),
        percent(single.misplaced),
        percent(own_sky.rms),
        double.g1,
        double.g2,
        double.weight,
        percent(two.misplaced),
        percent(double_sky.rms),
    ))
}

/// A form over all biomes and wavelengths, in words.
fn summary(source: AerosolSource, cases: &[Case], stand: Stand) -> String {
    let found: Vec<&(Fit, Errors, SkyError)> = cases.iter().filter_map(|case| case.cost(stand)).collect();
    let mean_and_largest = |value: fn(&(Fit, Errors, SkyError)) -> f64| {
        let values = || found.iter().map(|cost| 100.0 * value(cost).abs());
        let mean = values().sum::<f64>() / found.len().max(1) as f64;
        format!("{mean:.1} ({:.0})", values().fold(0.0, f64::max))
    };
    format!(
        "{source} {:<13} in {:>3} of {} cases, mean (largest) in %: rms of ln {}, misplaced {}, backward {}, worst from \
         {WORST_FROM_DEG}° {}, sky rms {}",
        stand.key(),
        found.len(),
        cases.len(),
        mean_and_largest(|(_, errors, _)| errors.logarithmic),
        mean_and_largest(|(_, errors, _)| errors.misplaced),
        mean_and_largest(|(_, errors, _)| errors.backward),
        mean_and_largest(|(_, errors, _)| errors.worst),
        mean_and_largest(|(.., sky)| sky.rms),
    )
}

/// Fits of every biome, source and wavelength, and what they cost.
pub(super) fn compare(data: Data<'_>) -> Result<Results, StudyError> {
    let (mut parts, mut remarks) = (Vec::new(), Vec::new());
    for (i, source) in AerosolSource::ALL.into_iter().enumerate() {
        let cases = cases(data, source)?;
        let (all, reference): (Vec<&Case>, Vec<&Case>) =
            (cases.iter().collect(), cases.iter().filter(|case| is_reference(case)).collect());
        remarks.extend(reference.iter().filter_map(|case| remark(source, case)));
        remarks.extend(Stand::ALL.into_iter().map(|stand| summary(source, &cases, stand)));
        parts.push(Part { name: FITS[i], frame: fits(&all)? });
        parts.push(Part { name: FUNCTIONS[i], frame: functions(&reference)? });
        parts.push(Part { name: COSTS[i], frame: fits(&reference)? });
    }
    Ok(Results { parts, remarks })
}
