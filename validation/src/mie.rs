//! Spheres beside arbitrary precision: 45 of them, x from 1e-6 to 1e6, in `tools/tests/reference/spheres.csv`.
//!
//! A double cannot be right in its last digits where the answer depends on digits of x and m that a double does not have. The
//! condition number kappa of a quantity is the relative change by a relative change of x, n or k; with eps = 1.1e-16 the
//! rule is: Q and g within max(1e-13, 20 kappa eps), Qback 1e-11, all of them 1e-11 beyond x = 2e5, where sums have many terms;
//! amplitudes within eps (50 scale + 20 kappa |S|), scale the sum of their absolute terms.

use crate::judge::{spread, within};
use crate::references::Sheet;
use crate::{Context, Section, ValidationError, Verdict};
use num_complex::Complex64;
use renderer::study::{Chart, Point};
use tools::mie::{RefractiveIndex, Solver};

/// Half the distance of doubles from 1 on.
const EPSILON: f64 = 1.1e-16;

/// Least relative tolerances: of Q and g, of Qback and beyond [`LARGE`].
const LEAST: (f64, f64) = (1e-13, 1e-11);

/// From this size parameter on sums have too many terms for 1e-13.
const LARGE: f64 = 2e5;

const ANGLES: [(&str, f64); 5] =
    [("0", 1.0), ("30", 0.866_025_403_784_438_6), ("90", 0.0), ("150", -0.866_025_403_784_438_6), ("180", -1.0)];

/// Errors of one quantity: the sphere, the relative error, and its share of what is allowed.
struct Errors {
    name: String,
    of: Vec<(usize, f64, f64)>,
}

/// Computes the section.
///
/// # Errors
/// [`ValidationError`] if the references cannot be read.
pub fn make(context: &Context<'_>) -> Result<Section, ValidationError> {
    let sheet = Sheet::read(&context.root.join("tools/tests/reference/spheres.csv"))?;
    let names = ["Qext", "Qsca", "Qabs", "Qback", "g"];
    let mut all: Vec<Errors> = names.iter().map(|name| Errors { name: (*name).into(), of: Vec::new() }).collect();
    all.extend(ANGLES.map(|(angle, _)| Errors { name: format!("amplitudes at {angle} degrees"), of: Vec::new() }));
    let mut solver = Solver::new();
    for row in 0..sheet.len() {
        let value = |name: &str| sheet.number(row, name);
        let (x, n, k) = (value("x")?, value("m_re")?, -value("m_im")?);
        let sphere = solver.sphere(RefractiveIndex::new(n, k)?, x)?;
        let q = sphere.efficiencies();
        for (i, found) in [q.extinction, q.scattering, q.absorption, q.backscatter, q.asymmetry].into_iter().enumerate()
        {
            let expected = value(names[i])?;
            // No absorption is as far off as its share of the extinction; there it need only be nothing to rounding.
            let (error, allowed) = if expected == 0.0 {
                ((found / q.extinction).abs(), 50.0 * EPSILON)
            } else {
                let least = if names[i] == "Qback" || x > LARGE { LEAST.1 } else { LEAST.0 };
                let kappa = value(&format!("kappa_{}", names[i]))?;
                ((found / expected - 1.0).abs(), (20.0 * kappa * EPSILON).max(least))
            };
            all[i].of.push((row, error, error / allowed));
        }
        for (i, (angle, cosine)) in ANGLES.into_iter().enumerate() {
            let s = sphere.amplitudes(cosine)?;
            // The file has n - ik, and so the conjugates.
            let part = |p: u8| -> Result<Complex64, ValidationError> {
                Ok(Complex64::new(value(&format!("S{p}_{angle}_re"))?, -value(&format!("S{p}_{angle}_im"))?))
            };
            let (s1, s2) = (part(1)?, part(2)?);
            let error = (s.s1 - s1).norm().max((s.s2 - s2).norm());
            let size = s1.norm().max(s2.norm());
            let allowed =
                EPSILON * (50.0 * value(&format!("scale_{angle}"))? + 20.0 * value(&format!("kS_{angle}"))? * size);
            all[names.len() + i].of.push((row, error / size.max(f64::MIN_POSITIVE), error / allowed));
        }
        (context.progress)((row + 1) as f64 / sheet.len() as f64);
    }
    report(&sheet, &all)
}

fn report(sheet: &Sheet, all: &[Errors]) -> Result<Section, ValidationError> {
    let mut section = Section::default();
    section.say(&format!(
        "Compared: efficiencies, asymmetry and amplitudes of {} spheres with size parameters from 1e-6 to 1e6. Reference: arbitrary \
         precision (mpmath), each computed at two precisions above 60 digits that agree to 1e-30, so without uncertainty of their own. \
         What is allowed is what the last digits of x and m are worth, as `validation/src/mie.rs` says.",
        sheet.len()
    ));
    let mut rows = Vec::new();
    let mut failing = Vec::new();
    for errors in all {
        let (count, _, rms, worst) = spread(errors.of.iter().map(|(_, error, _)| *error));
        let share = errors.of.iter().map(|(.., share)| *share).fold(0.0, f64::max);
        rows.push(vec![
            errors.name.clone(),
            count.to_string(),
            format!("{rms:.0e}"),
            format!("{worst:.0e}"),
            format!("{share:.2}"),
        ]);
        for (row, error, share) in &errors.of {
            if !within(*share, 1.0) {
                failing.push(format!(
                    "{} at x = {}, m = {} - {}i: {error:.1e}, {share:.1} times what is allowed",
                    errors.name,
                    sheet.text(*row, "x")?,
                    sheet.text(*row, "m_re")?,
                    sheet.text(*row, "m_im")?
                ));
            }
        }
    }
    section.table(
        &["quantity", "spheres", "rms of relative errors", "largest", "largest share of what is allowed"],
        &rows,
    );
    section.say("Relative errors are large only where the answer hangs on digits of x and m beyond a double's: the last column counts.");
    fails(&mut section, &failing);
    let share = all.iter().flat_map(|errors| &errors.of).map(|(.., share)| *share).fold(0.0, f64::max);
    section.find(
        "spheres, x from 1e-6 to 1e6",
        format!(
            "{} spheres: at most {share:.2} of what the last digits allow, {} failures",
            sheet.len(),
            failing.len()
        ),
        "arbitrary precision",
        Verdict::of(failing.is_empty()),
    );
    let mut points = Vec::new();
    for errors in &all[..5] {
        let mut largest: Vec<(f64, f64)> = Vec::new();
        let of = errors.of.iter().map(|&(row, .., share)| Ok((sheet.number(row, "x")?, share)));
        for (x, share) in of.collect::<Result<Vec<_>, ValidationError>>()? {
            match largest.iter_mut().find(|at| at.0 == x) {
                Some(at) => at.1 = at.1.max(share),
                None => largest.push((x, share)),
            }
        }
        largest.sort_by(|a, b| a.0.total_cmp(&b.0));
        let panel = "largest of the spheres of a size";
        // An error of zero has no place on a logarithmic axis.
        points.extend(largest.into_iter().map(|(x, share)| Point {
            panel,
            curve: errors.name.clone(),
            at: [x, share.max(1e-4)],
        }));
    }
    let title = "Spheres beside arbitrary precision".into();
    section.chart("mie", Chart { title, axes: ["size parameter", "error over what is allowed"], points });
    Ok(section)
}

/// Names what fails, or says that nothing does.
pub(crate) fn fails(section: &mut Section, failing: &[String]) {
    if failing.is_empty() {
        section.say("None fails.");
        return;
    }
    for one in failing {
        section.text += &format!("- Fails: {one}.\n");
    }
    section.text.push('\n');
}
