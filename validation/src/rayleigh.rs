//! Molecules beside Bucholtz 1995 (Appl. Opt. 34, 2765), whose formula and King factors the tables are made of, and beside
//! Bodhaine et al. 1999 (J. Atmos. Oceanic Technol. 16, 1854), who took others.
//!
//! Cross-sections are compared with Bucholtz' table 2 (four digits). Optical depths are those of the written tables, over
//! the standard atmosphere up to its top, beside Bucholtz' fit for it (table 3, good to 0.4 %) and beside equation 30 of
//! Bodhaine et al. for the ground at 45 degrees, 1013.25 hPa and 360 ppm CO2:
//!
//! tau = 0.0021520 (1.0455996 - 341.29061 x^-2 - 0.90230850 x^2) / (1 + 0.0027059889 x^-2 - 85.968563 x^2), x the wavelength in um,
//!
//! which is good to 0.01 % of their own calculation from 250 to 850 nm. The two publications differ in the King factor and in the
//! column of air by a few tenths of a percent, which stands for the uncertainty: 0.5 %.

use crate::judge::{percent, spread, within};
use crate::{Context, Section, ValidationError, Verdict};
use renderer::study::{Chart, Point};
use tools::column::{Column, Place, Species};
use tools::data::Data;
use tools::molecular::rayleigh::{Rayleigh, fitted};
use tools::raw::RawData;
use tools::raw::bucholtz::Quantity;

/// Agreement of cross-sections: half a unit of the fourth digit of a number that begins with 1.
const DIGITS: f64 = 5e-4;

/// Agreement of optical depths.
const DEPTHS: f64 = 5e-3;

/// Optical depth by Bodhaine et al. 1999, equation 30, at a wavelength in nm.
fn bodhaine(nm: f64) -> f64 {
    let square = (nm / 1e3).powi(2);
    0.002_152_0 * (1.045_599_6 - 341.290_61 / square - 0.902_308_50 * square)
        / (1.0 + 0.002_705_988_9 / square - 85.968_563 * square)
}

/// Computes the section.
///
/// # Errors
/// [`ValidationError`] if inputs or tables cannot be read.
pub fn make(context: &Context<'_>) -> Result<Section, ValidationError> {
    let raw = RawData::from_dir(&context.root.join("raw-data"))?;
    let formula = Rayleigh::new(&raw.bucholtz, raw.atmosphere.values.standard_number_density)?;
    let mut section = Section::default();
    section.say(
        "Compared: cross-sections, and vertical optical depths of the tables of `data/`. References: Bucholtz 1995 (table 2, four digits; \
         table 3, the fit of the optical depth of the US standard atmosphere, good to 0.4 %) and Bodhaine et al. 1999 (equation 30). They differ among \
         themselves by some tenths of a percent; 0.5 % is taken for agreement of optical depths, half of the fourth digit for \
         cross-sections.",
    );
    let rows = &raw.bucholtz.cross_section.rows;
    let mut cross_sections = Vec::new();
    for row in rows {
        cross_sections.push((row.wavelength_nm, formula.cross_section(row.wavelength_nm)? / row.cross_section - 1.0));
    }
    let (count, bias, rms, worst) = spread(cross_sections.iter().map(|c| c.1));
    let failing: Vec<String> = cross_sections
        .iter()
        .filter(|c| !within(c.1, DIGITS))
        .map(|(nm, error)| format!("{nm} nm: {} %", percent(*error, 3)))
        .collect();
    section.say(&format!(
        "Cross-sections, {count} wavelengths from 200 to 4000 nm: bias {} %, rms {:.3} %, worst {} %.",
        percent(bias, 3),
        100.0 * rms,
        percent(worst, 3)
    ));
    crate::mie::fails(&mut section, &failing);
    section.find(
        "Rayleigh cross-sections",
        format!("{count} wavelengths: rms {:.3} %, worst {} %", 100.0 * rms, percent(worst, 3)),
        "Bucholtz 1995, table 2",
        Verdict::of(failing.is_empty()),
    );
    let column = Column::read(Data(&context.root.join("data")), &Place::default())?;
    let top = column.density(Species::Molecules).axis().nodes.last().copied().unwrap_or_default();
    let (mut table, mut points, mut errors, mut failing) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for i in 0..=28 {
        let nm = 300.0 + 25.0 * f64::from(i);
        let depth = column.optical_depth(Species::Molecules, nm, (0.0, top))?.scattering;
        let fit = fitted(&raw.bucholtz.fit.rows, Quantity::OpticalDepthUs76, nm)?;
        let references = [("Bucholtz 1995", fit), ("Bodhaine et al. 1999", bodhaine(nm))];
        for (curve, reference) in references {
            let error = depth / reference - 1.0;
            errors.push(error);
            points.push(Point { panel: "optical depth", curve: curve.into(), at: [nm, 100.0 * error] });
            if !within(error, DEPTHS) {
                failing.push(format!("{nm} nm beside {curve}: {} %", percent(error, 2)));
            }
        }
        if i % 4 == 0 || nm == 550.0 {
            let [(_, bucholtz), (_, other)] = references;
            table.push(vec![
                format!("{nm}"),
                format!("{depth:.5}"),
                format!("{bucholtz:.5}"),
                percent(depth / bucholtz - 1.0, 2),
                format!("{other:.5}"),
                percent(depth / other - 1.0, 2),
            ]);
        }
    }
    section.table(
        &["wavelength / nm", "optical depth", "Bucholtz 1995", "difference %", "Bodhaine et al. 1999", "difference %"],
        &table,
    );
    crate::mie::fails(&mut section, &failing);
    let (count, bias, rms, worst) = spread(errors);
    section.find(
        "Rayleigh optical depths, 300 to 1000 nm",
        format!("{count} values: bias {} %, rms {:.2} %, worst {} %", percent(bias, 2), 100.0 * rms, percent(worst, 2)),
        "Bucholtz 1995; Bodhaine et al. 1999",
        Verdict::of(failing.is_empty()),
    );
    let title = "Rayleigh optical depth beside two publications".into();
    section.chart("rayleigh", Chart { title, axes: ["wavelength / nm", "difference / %"], points });
    Ok(section)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_optical_depth_of_green_light_is_the_known_one() {
        // 0.0971 at 550 nm in Bucholtz' table 5, to four decimals; Bodhaine's differs by less than 0.2 %.
        assert!((bodhaine(550.0) - 0.0971).abs() < 2e-4, "{}", bodhaine(550.0));
    }
}
