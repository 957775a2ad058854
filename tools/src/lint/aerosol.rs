//! Laws of particles: extinction is scattering and absorption together, no particle absorbs as it would scatter,
//! and a named aerosol has an albedo and a size.

use super::finding::{Check, Finding};
use super::known::{KNOWN, Known};
use super::names::{Dimension, Quantity};
use super::sheet::{Block, Column, Sheet, round};
use tables::views::Biome;

pub(super) use super::known::Layer;

/// By how much an extinction for each particle may leave the range of a biome's tables.
const AMOUNT: f64 = 2.5;

/// By how much an extinction coefficient or number density may leave that range: amounts vary more than particles.
const LOAD: f64 = 10.0;

/// By how much the absorbed share, 1 - albedo, may leave that range, as factors down and up.
const ABSORBED: (f64, f64) = (3.0, 1.3);

/// Relative and absolute slack of sums of rounded numbers.
const ROUNDING: f64 = 0.01;

/// Steepest fall of absorption with wavelength, as an exponent. Small particles absorb as k / lambda, and the k of no
/// aerosol material falls faster than lambda^-2 over the whole visible; molecules and small particles scatter as
/// lambda^-4.
const STEEPEST_ABSORPTION: f64 = 3.3;

/// Least exponent with which scattering falls where the albedo is below a value. Spheres whose scattering does not
/// fall with wavelength are large, and half of what large ones take from the beam is diffraction; an albedo near
/// zero belongs to spheres that are small against the wavelength.
const LEAST_SCATTERING: [(f64, f64); 3] = [(0.1, 3.0), (0.3, 1.2), (0.45, 0.3)];

/// The columns about one kind of particles.
struct Group<'a> {
    sheet: &'a Sheet,
    subject: String,
    extinction: Option<&'a Column>,
    scattering: Option<&'a Column>,
    absorption: Option<&'a Column>,
    albedo: Option<&'a Column>,
    asymmetry: Option<&'a Column>,
}

/// Names of columns that are there.
fn names<'a>(columns: &[Option<&'a Column>]) -> Vec<&'a str> {
    columns.iter().flatten().map(|c| c.name.as_str()).collect()
}

/// Everything that the laws of particles find in a sheet.
pub(super) fn laws(sheet: &Sheet) -> Vec<Finding> {
    let optical = |c: &&Column| {
        matches!(
            c.meaning.quantity,
            Quantity::Extinction | Quantity::Scattering | Quantity::Absorption | Quantity::Albedo | Quantity::Asymmetry
        )
    };
    let mut subjects: Vec<&str> = Vec::new();
    for column in sheet.columns.iter().filter(optical) {
        if !subjects.contains(&column.meaning.subject.as_str()) {
            subjects.push(&column.meaning.subject);
        }
    }
    let mut findings = Vec::new();
    for subject in subjects {
        let find = |q: Quantity| sheet.columns.iter().find(|c| c.meaning.quantity == q && c.meaning.subject == subject);
        let group = Group {
            sheet,
            subject: subject.to_owned(),
            extinction: find(Quantity::Extinction),
            scattering: find(Quantity::Scattering),
            absorption: find(Quantity::Absorption),
            albedo: find(Quantity::Albedo),
            asymmetry: find(Quantity::Asymmetry),
        };
        for block in &sheet.blocks {
            findings.extend(group.laws(block));
        }
    }
    for column in sheet.columns.iter().filter(|c| c.meaning.quantity == Quantity::NumberDensity) {
        for block in &sheet.blocks {
            findings.extend(density(sheet, column, block));
        }
    }
    findings
}

/// What a biome is known to be: its lowest layer after each source, or the species of a table.
fn known(sheet: &Sheet, biome: Option<Biome>) -> Vec<&'static Known> {
    let of = |layer: Layer| match sheet.species {
        Some(species) => layer == species.layer,
        None => matches!(layer, Layer::Lowest(_, b) if Some(b) == biome),
    };
    KNOWN.iter().filter(|known| of(known.layer)).collect()
}

/// The number density of a named biome against its own.
fn density(sheet: &Sheet, column: &Column, block: &Block) -> Option<Finding> {
    let biome = match (column.meaning.biome, block.biome) {
        (Some(a), Some(b)) if a != b => return None,
        (a, b) => a.or(b),
    };
    let of = known(sheet, biome);
    // Several rows of a biome are its components or modes: their sum is the density.
    let along = super::sheet::coordinate(&sheet.columns).is_some();
    let molecules =
        sheet.find(Quantity::Pressure).is_some() || column.meaning.says("ozone") || column.meaning.says("air");
    // The floor of a profile beside its density at the ground.
    let floor = column.meaning.says("background") && sheet.blocks.iter().any(|b| b.biome.is_some());
    if molecules || floor || of.is_empty() || sheet.blocks.len() > 1 && !along && block.rows.len() > 1 {
        return None;
    }
    if !along
        && sheet.columns.iter().filter(|c| matches!(c.meaning.quantity, Quantity::Text | Quantity::Key)).count() > 1
        && sheet.columns.iter().any(|c| c.name == "component" || c.name == "mode")
    {
        return None;
    }
    let value = column.si(block.rows.start);
    let factor = match sheet.species.map(|s| s.layer) {
        None => LOAD,
        // The layer begins at 2 to 10 km, after the biome.
        Some(Layer::FreeTroposphere) => 4.0,
        Some(_) => AMOUNT,
    };
    let expected = of.iter().map(|k| k.density_m3);
    let (low, high) = expected.fold((f64::INFINITY, 0.0_f64), |(l, h), n| (l.min(n), h.max(n)));
    (value < low / factor || value > high * factor).then(|| {
        let found = format!("{value:.3e} m^-3");
        let expected = format!(
            "{:.2e} to {:.2e} m^-3, {factor} times either way of the densities of the tables",
            low / factor,
            high * factor
        );
        Finding::new(Check::Amount, &[&column.name], found, expected)
            .of(&label(biome, block))
            .at(sheet.line(block.rows.start), String::new())
            .warning()
    })
}

fn label(biome: Option<Biome>, block: &Block) -> String {
    biome.map_or_else(|| block.label.clone(), |b| b.name().to_owned())
}

impl Group<'_> {
    fn laws(&self, block: &Block) -> Vec<Finding> {
        let named = [self.extinction, self.scattering, self.absorption, self.albedo].into_iter().flatten();
        let biome = named.filter_map(|c| c.meaning.biome).next().or(block.biome);
        let subject = match (self.subject.is_empty(), block.label.is_empty()) {
            (_, true) => self.subject.clone(),
            (true, false) => block.label.clone(),
            (false, false) => format!("{}, {}", self.subject, block.label),
        };
        let known = known(self.sheet, biome);
        let mut findings = self.sums(block);
        let broken = !findings.is_empty();
        if !broken {
            findings.extend(self.exchange(block));
        }
        findings.extend(self.albedo(block, &known));
        findings.extend(self.amount(block, &known));
        findings.extend(self.asymmetry(block, &known));
        findings.into_iter().map(|finding| finding.of(&subject)).collect()
    }

    /// Extinction is scattering plus absorption, and the albedo is scattering over extinction: the worst row of each.
    fn sums(&self, block: &Block) -> Vec<Finding> {
        let mut findings = Vec::new();
        let same = |a: Option<&Column>, b: Option<&Column>| matches!((a, b), (Some(a), Some(b)) if a.meaning.dimension() == b.meaning.dimension());
        let mut worst = |columns: &[Option<&Column>], expected: &str, deviation: &dyn Fn(usize) -> (f64, f64, f64)| {
            let rows = block.rows.clone().map(|row| (row, deviation(row))).filter(|(_, d)| d.0 > 1.0);
            if let Some((row, (_, left, right))) = rows.clone().max_by(|a, b| a.1.0.total_cmp(&b.1.0)) {
                let found = format!(
                    "{} against {} in {} of {} rows",
                    round(left),
                    round(right),
                    rows.count(),
                    block.rows.len()
                );
                findings.push(
                    Finding::new(Check::Identity, &names(columns), found, expected)
                        .at(self.sheet.line(row), self.sheet.at(row)),
                );
            }
        };
        let (e, s, a, w) = (self.extinction, self.scattering, self.absorption, self.albedo);
        if let (Some(e), Some(s), Some(a)) = (e, s, a)
            && same(Some(e), Some(s))
            && same(Some(e), Some(a))
        {
            worst(&[Some(e), Some(s), Some(a)], "extinction = scattering + absorption within 1 %", &|row| {
                let (left, right) = (e.si(row), s.si(row) + a.si(row));
                ((left - right).abs() / (ROUNDING * left.abs().max(right.abs())), left, right)
            });
        } else {
            // The fields of a table are not rounded.
            let slack = if self.sheet.lines.is_empty() { 1e-12 } else { 1e-3 };
            for part in [s, a].into_iter().flatten() {
                if let Some(e) = e
                    && same(Some(e), Some(part))
                {
                    worst(&[Some(e), Some(part)], "no more scattering or absorption than extinction", &|row| {
                        let (left, right) = (e.si(row), part.si(row));
                        (if right > left * (1.0 + slack) { right / left } else { 0.0 }, left, right)
                    });
                }
            }
        }
        if let (Some(w), Some(s)) = (w, s) {
            let other = if same(e, Some(s)) { e } else { a.filter(|a| same(Some(*a), Some(s))) };
            if let Some(other) = other {
                let total = |row: usize| {
                    if e.is_some_and(|e| e.name == other.name) { other.si(row) } else { s.si(row) + other.si(row) }
                };
                worst(&[Some(w), Some(s), Some(other)], "albedo = scattering / extinction within 0.01", &|row| {
                    let (left, right) = (w.si(row), s.si(row) / total(row));
                    ((left - right).abs() / ROUNDING, left, right)
                });
            }
        }
        findings
    }

    /// Scattering and absorption of a row in SI, where two of extinction, scattering and absorption are there.
    fn parts(&self, row: usize) -> Option<(f64, f64)> {
        let value = |c: Option<&Column>| c.map(|c| c.si(row)).filter(|v| v.is_finite());
        let (e, s, a) = (value(self.extinction), value(self.scattering), value(self.absorption));
        match (e, s, a) {
            (_, Some(s), Some(a)) => Some((s, a)),
            (Some(e), Some(s), None) => Some((s, e - s)),
            (Some(e), None, Some(a)) => Some((e - a, a)),
            _ => None,
        }
    }

    fn columns_of_parts(&self) -> Vec<&str> {
        match (self.scattering, self.absorption) {
            (Some(_), Some(_)) => names(&[self.scattering, self.absorption]),
            _ => names(&[self.extinction, self.scattering, self.absorption]),
        }
    }

    /// Whether scattering and absorption behave as those of particles do, whatever the particles.
    fn exchange(&self, block: &Block) -> Option<Finding> {
        let wavelengths = self.sheet.nm.as_ref()?;
        let rows: Vec<(f64, f64, f64)> = block
            .rows
            .clone()
            .filter(|row| (380.0..=1050.0).contains(&wavelengths[*row]))
            .filter_map(|row| self.parts(row).map(|(s, a)| (wavelengths[row], s, a)))
            .filter(|(_, s, a)| *s > 0.0 && *a > 0.0)
            .collect();
        let (first, last) = (rows.first()?.0, rows.last()?.0);
        if rows.len() < 3 || last.max(first) < 1.4 * last.min(first) {
            return None;
        }
        let scattering = fall(rows.iter().map(|(l, s, _)| (*l, *s)));
        let absorption = fall(rows.iter().map(|(l, _, a)| (*l, *a)));
        let mut albedos: Vec<f64> = rows.iter().map(|(_, s, a)| s / (s + a)).collect();
        albedos.sort_by(f64::total_cmp);
        let albedo = albedos[albedos.len() / 2];
        let steep = absorption > STEEPEST_ABSORPTION && albedo < 0.999;
        let low = LEAST_SCATTERING.iter().find(|(below, least)| albedo < *below && scattering < *least);
        let rising = absorption < -0.6 && scattering > 1.0 && albedo < 0.9;
        if !(steep || low.is_some() || rising) {
            return None;
        }
        let found = format!(
            "albedo {}, scattering as wavelength^{:.2}, absorption as wavelength^{:.2}",
            round(albedo),
            -scattering,
            -absorption
        );
        let expected = match low {
            _ if steep => format!("absorption that falls no faster than wavelength^-{STEEPEST_ABSORPTION}"),
            Some((below, least)) => {
                format!("scattering that falls faster than wavelength^-{least} where the albedo is below {below}")
            }
            None => "absorption that does not rise where scattering falls".into(),
        };
        Some(Finding::new(Check::Exchange, &self.columns_of_parts(), found, expected))
    }

    /// The albedo against that of the named aerosol.
    fn albedo(&self, block: &Block, known: &[&Known]) -> Option<Finding> {
        let (low, high) =
            known.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), k| (l.min(k.albedo.0), h.max(k.albedo.1)));
        if known.is_empty() {
            return None;
        }
        // An albedo of 0.99 and more may as well be 1: there absorption is the least known.
        let high = if high > 0.99 { 1.001 } else { 1.0 - (1.0 - high) / ABSORBED.0 };
        let low = 1.0 - (1.0 - low).max(0.02) * ABSORBED.1;
        let mut columns = self.columns_of_parts();
        let mut values: Vec<f64> = Vec::new();
        for row in self.visible(block) {
            match (self.parts(row), self.albedo) {
                (Some((s, a)), _) => values.push(s / (s + a)),
                (None, Some(w)) => {
                    columns = vec![&w.name];
                    values.push(w.si(row));
                }
                _ => {}
            }
        }
        values.retain(|w| w.is_finite());
        values.sort_by(f64::total_cmp);
        let median = *values.get(values.len() / 2)?;
        (!(low..=high).contains(&median)).then(|| {
            let expected = format!("{} to {} for this aerosol", round(low), round(high.min(1.0)));
            Finding::new(Check::Albedo, &columns, format!("single-scattering albedo {}", round(median)), expected)
        })
    }

    /// Rows of a block from 300 to 1000 nm, or all of one that has no wavelengths.
    fn visible(&self, block: &Block) -> Vec<usize> {
        let wavelengths = &self.sheet.nm;
        block
            .rows
            .clone()
            .filter(|row| wavelengths.as_ref().is_none_or(|w| (299.0..=1001.0).contains(&w[*row])))
            .collect()
    }

    /// The extinction, or what there is of it, against that of the named aerosol: of one particle, or of all at
    /// the ground.
    fn amount(&self, block: &Block, known: &[&Known]) -> Option<Finding> {
        let total = |row: usize| match (self.parts(row), self.extinction, self.scattering) {
            (Some((s, a)), ..) => Some((s + a, 1.0)),
            (None, Some(e), _) => Some((e.si(row), 1.0)),
            // Alone, at least that part of the extinction.
            (None, None, Some(s)) => Some((s.si(row), 0.5)),
            _ => None,
        };
        let one = self.scattering.or(self.extinction).or(self.absorption)?;
        let wavelengths = &self.sheet.nm;
        let coefficient = match one.meaning.dimension()? {
            Dimension::Area => false,
            Dimension::PerLength => true,
            _ => return None,
        };
        let slack = if coefficient { LOAD } else { AMOUNT };
        let deviation = |known: &Known| -> Option<(f64, usize, f64)> {
            let mut worst: Option<(f64, usize, f64)> = None;
            for row in self.visible(block) {
                let wavelength = wavelengths.as_ref().map(|w| w[row]).or(one.meaning.at_nm)?;
                let Some((value, share)) = total(row).filter(|(v, _)| v.is_finite()) else { continue };
                let (low, high) = known.extinction(wavelength);
                let number = if coefficient { known.density_m3 } else { 1.0 };
                let (low, high) = (share * low * number / slack, high * number * slack);
                let off = if value < low { (low / value).ln() } else { (value / high).ln().max(0.0) };
                // The factor to the near end of the range itself.
                let factor = if value < low { value / (low * slack) } else { value * slack / high };
                if off > 0.0 && worst.is_none_or(|w| off > w.0) {
                    worst = Some((off, row, factor));
                }
            }
            worst.or(Some((0.0, block.rows.start, 1.0)))
        };
        let nearest = known.iter().filter_map(|k| deviation(k)).min_by(|a, b| a.0.total_cmp(&b.0))?;
        if nearest.0 == 0.0 {
            return None;
        }
        let (_, row, factor) = nearest;
        let at = wavelengths.as_ref().map(|w| w[row]).or(one.meaning.at_nm)?;
        let ranges: Vec<String> = known
            .iter()
            .map(|k| {
                let (low, high) = k.extinction(at);
                let number = if coefficient { k.density_m3 } else { 1.0 };
                format!("{:.2e} to {:.2e}", low * number, high * number)
            })
            .collect();
        let unit = if coefficient { "m^-1 at the ground" } else { "m^2 for each particle" };
        let found = format!("extinction {:.2e} {unit}, {} what there should be", total(row)?.0, times(factor));
        let expected = format!("{} {unit}, {slack} times either way", ranges.join(" or "));
        let columns = names(&[self.extinction, self.scattering, self.absorption]);
        let finding =
            Finding::new(Check::Amount, &columns, found, expected).at(self.sheet.line(row), self.sheet.at(row));
        Some(finding.off_by(factor).warning())
    }

    /// The asymmetry parameter against that of the named aerosol.
    fn asymmetry(&self, block: &Block, known: &[&Known]) -> Option<Finding> {
        let column = self.asymmetry?;
        let (low, high) =
            known.iter().fold((f64::INFINITY, -1.0_f64), |(l, h), k| (l.min(k.asymmetry.0), h.max(k.asymmetry.1)));
        if known.is_empty() {
            return None;
        }
        let (low, high) = (low - 0.1, (high + 0.1).min(0.99));
        let row = self.visible(block).into_iter().find(|row| !(low..=high).contains(&column.si(*row)))?;
        let expected = format!("{} to {} for this aerosol", round(low), round(high));
        let finding = Finding::new(Check::Range, &[&column.name], round(column.si(row)), expected);
        Some(finding.at(self.sheet.line(row), self.sheet.at(row)))
    }
}

/// A factor in words.
fn times(factor: f64) -> String {
    if factor >= 1.0 { format!("{} times", digits(factor)) } else { format!("1/{} of", digits(1.0 / factor)) }
}

fn digits(x: f64) -> String {
    if x < 100.0 {
        format!("{x:.2}")
    } else if x < 1e5 {
        format!("{x:.0}")
    } else {
        format!("{x:.1e}")
    }
}

/// The exponent a of a fall as wavelength^-a, by least squares in the logarithms.
pub(super) fn fall(points: impl Iterator<Item = (f64, f64)>) -> f64 {
    let logs: Vec<(f64, f64)> = points.map(|(x, y)| (x.ln(), y.ln())).collect();
    let n = logs.len() as f64;
    let (mx, my) = logs.iter().fold((0.0, 0.0), |(x, y), p| (x + p.0 / n, y + p.1 / n));
    let (xy, xx) = logs.iter().fold((0.0, 0.0), |(xy, xx), p| (xy + (p.0 - mx) * (p.1 - my), xx + (p.0 - mx).powi(2)));
    -xy / xx
}
