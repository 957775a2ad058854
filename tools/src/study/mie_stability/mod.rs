//! Where the classical algorithms of Mie scattering fail, and where ours does: relative errors over size parameter and
//! refractive index against arbitrary precision.
//!
//! One ingredient at a time is varied while the others are robust: how the logarithmic derivative D_n and psi_n are found,
//! how many terms are summed, how absorption is formed, in double and in single precision; beside them the limits of
//! small, large and faint spheres. The variants live here only.

mod agreement;
mod classical;
mod derivative;
#[cfg(feature = "plot")]
mod figure;
mod limits;
mod reference;
#[cfg(test)]
mod tests;
mod timing;
mod variants;

#[cfg(feature = "plot")]
pub(super) use figure::figure;

pub(super) use timing::{Timed, timed};

use super::{Part, Results, StudyError};
use crate::frame::Frame;
use agreement::Agreement;
use rayon::prelude::*;
use reference::{Scan, Sphere};
use variants::{Errors, Quantity, Variant};

/// Name of the part that compares over the spheres that reach to x = 1e6.
const LARGE: &str = "large";

/// The errors of a variant at every sphere, in order.
fn errors(variant: &Variant, spheres: &[Sphere]) -> Result<Vec<Errors>, StudyError> {
    spheres.par_iter().map(|sphere| Ok(variant.errors(sphere)?)).collect()
}

/// Errors of variants as a frame: x, n, k, and a column for each quantity of each variant.
fn frame(variants: &[Variant], errors: &[Vec<Errors>], spheres: &[Sphere]) -> Result<Frame, StudyError> {
    let parameter = |part: fn(&Sphere) -> f64| spheres.iter().map(part).collect::<Vec<_>>();
    let mut columns = vec![
        ("x".to_owned(), parameter(|sphere| sphere.x)),
        ("n".to_owned(), parameter(|sphere| sphere.n)),
        ("k".to_owned(), parameter(|sphere| sphere.k)),
    ];
    for (variant, errors) in variants.iter().zip(errors) {
        for quantity in Quantity::ALL.into_iter().filter(|&quantity| variant.has(quantity)) {
            columns.push((column(variant.key, quantity), errors.iter().map(|errors| errors.of(quantity)).collect()));
        }
    }
    Ok(Frame::new(columns)?)
}

/// The column of a quantity of a variant.
fn column(variant: &str, quantity: Quantity) -> String {
    format!("{variant}_{}", quantity.as_str())
}

/// The errors of every variant, and how well they agree with those of an independent program.
pub(super) fn compare() -> Result<Results, StudyError> {
    let grid = reference::grid()?;
    let scan = Scan::read(&grid)?;
    let (mut parts, mut remarks, mut total) = (Vec::new(), Vec::new(), Agreement::default());
    for group in variants::groups() {
        let found = group.variants.iter().map(|v| errors(v, &grid)).collect::<Result<Vec<_>, _>>()?;
        for (variant, errors) in group.variants.iter().zip(&found) {
            if let Some(agreement) = Agreement::of(variant, errors, &grid, &scan) {
                remarks.push(remark(variant.key, agreement));
                total = total.with(agreement);
            }
        }
        parts.push(Part { name: group.name, frame: frame(&group.variants, &found, &grid)? });
    }
    if total.cells != scan.len() {
        let reason = format!("{} of {} cells belong to no variant and sphere", scan.len() - total.cells, scan.len());
        return Err(StudyError::Reference { file: "mie-scan.csv", reason });
    }
    remarks.push(remark("all", total));
    let (spheres, variants) = (reference::spheres()?, variants::large());
    let found = variants.iter().map(|v| errors(v, &spheres)).collect::<Result<Vec<_>, _>>()?;
    parts.push(Part { name: LARGE, frame: frame(&variants, &found, &spheres)? });
    Ok(Results { parts, remarks })
}

/// An agreement in words.
fn remark(name: &str, agreement: Agreement) -> String {
    let Agreement { cells, agreeing, small, exceeding } = agreement;
    let percent = 100.0 * agreement.share();
    format!(
        "{name:<26} {agreeing:>5} of {cells:>5} errors above 1e-12 agree within a decade ({percent:.1} %); \
         {exceeding:>2} of {small:>5} below exceed 1e-11"
    )
}
