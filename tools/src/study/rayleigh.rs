//! The Rayleigh cross-section by Bucholtz' formula, his table 2, his fit (table 3), and with the
//! King factor of Bates.

use super::StudyError;
use crate::frame::Frame;
use crate::molecular::{king, rayleigh};
use crate::raw::bucholtz::{Bucholtz, Quantity};
use crate::raw::us_standard_atmosphere::UsStandardAtmosphere;
use std::path::Path;

/// Volume fraction of carbon dioxide in the air of Peck and Reeder.
const CARBON_DIOXIDE: f64 = 3.3e-4;

/// Up to this wavelength in nm every 2 nm is computed, and Bates' King factor is meant to hold; from
/// there only the rows of table 2.
const DENSE_UP_TO_NM: f64 = 1000.0;

/// Cross-sections against wavelength from 200 to 4000 nm, and each over the formula's, less 1.
pub(super) fn compare(raw_dir: &Path) -> Result<Frame, StudyError> {
    let raw = Bucholtz::from_dir(raw_dir)?;
    let standard = UsStandardAtmosphere::from_dir(raw_dir)?.values.standard_number_density;
    let air = rayleigh::Rayleigh::new(&raw, standard)?;
    let rows = &raw.cross_section.rows;

    let mut nm: Vec<f64> = (100..=DENSE_UP_TO_NM as u32 / 2).map(|i| f64::from(2 * i)).collect();
    nm.extend(rows.iter().map(|row| row.wavelength_nm));
    nm.sort_by(f64::total_cmp);
    nm.dedup();

    let mut columns: [Vec<f64>; 4] = Default::default();
    for &w in &nm {
        let formula = air.cross_section(w)?;
        let printed = rows.iter().find(|row| row.wavelength_nm == w).map_or(f64::NAN, |row| row.cross_section);
        let fit = rayleigh::fitted(&raw.fit.rows, Quantity::CrossSection, w)?;
        let bates = if w <= DENSE_UP_TO_NM {
            formula / air.king_factor().at(w)? * king::bates(w, CARBON_DIOXIDE)
        } else {
            f64::NAN
        };
        for (column, value) in columns.iter_mut().zip([formula, printed, fit, bates]) {
            column.push(value);
        }
    }
    let [formula, printed, fit, bates] = columns;
    let relative = |values: &[f64]| values.iter().zip(&formula).map(|(a, b)| a / b - 1.0).collect::<Vec<_>>();
    let relatives = [relative(&printed), relative(&fit), relative(&bates)];
    let [printed_relative, fit_relative, bates_relative] = relatives;
    Ok(Frame::new([
        ("wavelength_nm", nm),
        ("formula_m2", formula),
        ("table_2_m2", printed),
        ("fit_m2", fit),
        ("bates_m2", bates),
        ("table_2_relative", printed_relative),
        ("fit_relative", fit_relative),
        ("bates_relative", bates_relative),
    ])?)
}
