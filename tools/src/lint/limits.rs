//! Physical ranges of single quantities, and spectra and profiles that are known well.

use super::aerosol::fall;
use super::finding::{Check, Finding};
use super::names::{Dimension, Quantity};
use super::sheet::{Block, Column, Sheet, coordinate, round};

/// Lowest and highest value, and lowest and highest value of the largest of a column; in SI.
struct Limits {
    values: (f64, f64),
    largest: (f64, f64),
}

/// The limits of a quantity; none where no value is impossible.
fn limits(column: &Column, sheet: &Sheet) -> Option<Limits> {
    let same = |low: f64, high: f64| Some(Limits { values: (low, high), largest: (low, high) });
    let with = |low, high, least| Some(Limits { values: (low, high), largest: (least, high) });
    match column.meaning.quantity {
        // The lowest temperature of the atmosphere is that of the mesopause, the highest that of the thermosphere.
        Quantity::Temperature => with(100.0, 2000.0, 150.0),
        Quantity::Pressure => same(1e-9, 1.1e5),
        Quantity::Altitude | Quantity::Geopotential => {
            with(-500.0, 1.1e6, if column.values.len() > 4 { 1e3 } else { 0.0 })
        }
        Quantity::Albedo => with(0.0, 1.0 + 1e-6, 0.01),
        Quantity::Reflectance => with(0.0, 1.0, 0.01),
        Quantity::Asymmetry => with(-1.0, 1.0, 0.05),
        Quantity::Angstrom => same(-1.0, 4.3),
        Quantity::OpticalDepth => same(0.0, 50.0),
        Quantity::IndexReal => with(0.05, 6.0, 1.05),
        Quantity::IndexImaginary => same(0.0, 20.0),
        // Bucholtz 1995: 1.080 at 200 nm to 1.047 at 1000 nm for air; 1.2 is beyond any gas of it.
        Quantity::King => with(1.0, 1.2, 1.02),
        Quantity::Depolarization => with(0.0, 0.2, 0.02),
        Quantity::Gamma => with(0.0, 0.1, 0.01),
        // The sun at 1 au has its largest irradiance, near 480 nm, of 2.1 W m^-2 nm^-1.
        Quantity::Irradiance => same(0.0, 3.0),
        Quantity::Matching(_) => with(0.0, 2.5, 0.9),
        // Ozone: from the hole over Antarctica to the most that was measured. Layers have parts of it.
        Quantity::Column if column.meaning.says("layer") => with(0.0, 700.0, 10.0),
        Quantity::Column => same(50.0, 700.0),
        Quantity::Spread => with(0.0, 200.0, 2.0),
        Quantity::MixingRatio if column.meaning.says("water") => with(0.0, 0.06, 1e-6),
        Quantity::MixingRatio if column.meaning.says("nitrogen") => with(0.0, 1e-6, 1e-11),
        Quantity::MixingRatio => with(0.0, 2e-5, if coordinate(&sheet.columns).is_some() { 2e-6 } else { 0.0 }),
        Quantity::Fraction => with(0.0, 1.0, 0.02),
        Quantity::Humidity => Some(Limits { values: (0.0, 1.0), largest: (0.0, 1.0) }),
        Quantity::ScaleHeight => with(100.0, 1.1e5, 300.0),
        // Wider than any mode of the atmosphere; of its logarithm to base 10.
        Quantity::Width if column.meaning.says("log10") => with(0.0, 0.9, 0.05),
        Quantity::Width => with(1.0, 8.0, 1.1),
        Quantity::Radius => with(1e-10, 2e-4, 1e-8),
        _ => None,
    }
}

/// Where a column leaves its limits.
fn range(sheet: &Sheet, column: &Column) -> Option<Finding> {
    if column.meaning.quantity == Quantity::Wavelength {
        let far = (0..column.values.len()).find(|row| !(50.0..=1e6).contains(&sheet.wavelength_nm(column, *row)))?;
        let found = format!("{} nm", round(sheet.wavelength_nm(column, far)));
        let finding = Finding::new(Check::Range, &[&column.name], found, "50 to 1000000 nm");
        return Some(finding.at(sheet.line(far), String::new()));
    }
    let Limits { values: (low, high), largest } = limits(column, sheet)?;
    let value = |row: usize| {
        let v = column.si(row);
        // Without a unit in the name humidities are in percent.
        if column.meaning.quantity == Quantity::Humidity && column.meaning.unit.is_none() { v / 100.0 } else { v }
    };
    let rows = (0..column.values.len()).filter(|row| value(*row).is_finite());
    let outside: Vec<usize> = rows.clone().filter(|row| !(low..=high).contains(&value(*row))).collect();
    let most = rows.map(value).fold(f64::NEG_INFINITY, f64::max);
    let unit = unit_of(column);
    if let Some(&row) = outside.iter().max_by(|a, b| value(**a).abs().total_cmp(&value(**b).abs())) {
        let found =
            format!("{}{unit}, and {} of {} rows outside", round(value(row)), outside.len(), column.values.len());
        let finding =
            Finding::new(Check::Range, &[&column.name], found, format!("{} to {}{unit}", round(low), round(high)));
        return Some(finding.at(sheet.line(row), sheet.at(row)));
    }
    (most.is_finite() && most < largest.0).then(|| {
        let found = format!("{}{unit} at most", round(most));
        Finding::new(Check::Range, &[&column.name], found, format!("at least {}{unit} somewhere", round(largest.0)))
    })
}

fn unit_of(column: &Column) -> &'static str {
    match column.meaning.quantity {
        Quantity::Temperature => " K",
        Quantity::Pressure => " Pa",
        Quantity::Altitude | Quantity::Geopotential | Quantity::ScaleHeight | Quantity::Radius => " m",
        Quantity::Column | Quantity::Spread => " DU",
        Quantity::Irradiance => " W m^-2 nm^-1",
        _ => "",
    }
}

/// Boltzmann's constant, J/K (SI).
const BOLTZMANN: f64 = 1.380_649e-23;

/// Mass of a mean molecule of air, kg: 28.9644 g/mol over Avogadro's constant (COESA 1976).
const AIR_MOLECULE_KG: f64 = 4.8096e-26;

/// Ozone absorption at 243 K: wavelength in nm and cross-section in m^2 (Serdyuchenko et al. 2014, means over 1 nm).
const OZONE: [(f64, f64); 32] = [
    (220.0, 1.77e-22),
    (230.0, 4.48e-22),
    (240.0, 8.25e-22),
    (255.0, 1.14e-21),
    (270.0, 7.92e-22),
    (280.0, 3.98e-22),
    (290.0, 1.37e-22),
    (300.0, 3.58e-23),
    (310.0, 8.80e-24),
    (320.0, 2.50e-24),
    (330.0, 4.08e-25),
    (340.0, 1.25e-25),
    (350.0, 1.23e-26),
    (360.0, 4.99e-27),
    (380.0, 2.17e-28),
    (400.0, 9.68e-28),
    (420.0, 3.52e-27),
    (450.0, 1.82e-26),
    (480.0, 7.55e-26),
    (500.0, 1.19e-25),
    (525.0, 2.14e-25),
    (550.0, 3.29e-25),
    (575.0, 4.74e-25),
    (602.0, 5.14e-25),
    (650.0, 2.43e-25),
    (700.0, 8.18e-26),
    (750.0, 4.11e-26),
    (800.0, 1.44e-26),
    (850.0, 1.11e-26),
    (900.0, 6.03e-27),
    (950.0, 2.17e-27),
    (1000.0, 5.42e-28),
];

/// A curve through points, linear in the logarithm; none outside.
fn through(points: &[(f64, f64)], x: f64) -> Option<f64> {
    let pair = points.windows(2).find(|p| (p[0].0..=p[1].0).contains(&x))?;
    let t = (x - pair[0].0) / (pair[1].0 - pair[0].0);
    Some(pair[0].1 * (pair[1].1 / pair[0].1).powf(t))
}

/// Rayleigh cross-section of air in m^2: 4.51e-31 at 550 nm (Bucholtz 1995), as wavelength^-4 (0.97 of it at 1000 nm,
/// 1.4 at 200 nm).
fn rayleigh(wavelength_nm: f64) -> f64 {
    4.51e-31 * (550.0 / wavelength_nm).powi(4)
}

/// Molecules in m^3 of air at 288.15 K and 1013.25 hPa (Bucholtz 1995).
const MOLECULES_M3: f64 = 2.54743e25;

/// A column whose values stand in a known ratio to a curve: the median of the ratio must lie within `slack` of 1.
fn against(
    sheet: &Sheet,
    column: &Column,
    slack: f64,
    what: &str,
    expected: impl Fn(usize) -> Option<f64>,
) -> Option<Finding> {
    let mut ratios: Vec<(f64, usize)> = (0..column.values.len())
        .filter_map(|row| Some((column.si(row) / expected(row)?, row)))
        .filter(|(ratio, _)| ratio.is_finite())
        .collect();
    ratios.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (ratio, row) = *ratios.get(ratios.len() / 2)?;
    if (1.0 / slack..=slack).contains(&ratio) {
        return None;
    }
    let found = format!("{}, {ratio:.2e} times what there should be in most rows", round(column.si(row)));
    let finding =
        Finding::new(Check::Range, &[&column.name], found, format!("about {} ({what})", round(expected(row)?)));
    Some(finding.at(sheet.line(row), sheet.at(row)).off_by(ratio))
}

/// The ranges of the columns and what is known of spectra and profiles.
pub(super) fn laws(sheet: &Sheet) -> Vec<Finding> {
    let mut findings: Vec<Finding> = sheet.columns.iter().filter_map(|column| range(sheet, column)).collect();
    findings.extend(molecular(sheet));
    findings.extend(air(sheet));
    findings.extend(light(sheet));
    findings.extend(ozone_amounts(sheet));
    findings.extend(matter(sheet));
    findings
}

/// Cross-sections of molecules.
fn molecular(sheet: &Sheet) -> Vec<Finding> {
    let mut findings = Vec::new();
    let Some(wavelengths) = &sheet.nm else { return findings };
    let ozone = sheet.is_about("ozone") || sheet.is_about("serdyuchenko");
    for column in &sheet.columns {
        let quantity = column.meaning.quantity;
        let area = column.meaning.dimension().is_none_or(|d| d == Dimension::Area);
        // Molecules that only scatter have no absorption beside it.
        let absorbs =
            |c: &Column| c.meaning.quantity == Quantity::Absorption && c.meaning.subject == column.meaning.subject;
        let bare = column.meaning.biome.is_none() && sheet.species.is_none() && !sheet.columns.iter().any(absorbs);
        if quantity == Quantity::CrossSection
            && area
            && (ozone || column.meaning.says("ozone") || column.meaning.says("serdyuchenko"))
        {
            findings.extend(against(sheet, column, 2.5, "ozone, Serdyuchenko et al. 2014", |row| {
                through(&OZONE, wavelengths[row])
            }));
        } else if matches!(quantity, Quantity::CrossSection | Quantity::Scattering)
            && bare
            && !ozone
            && !sheet.is_about("aerosol")
        {
            let points =
                wavelengths.iter().zip(&column.values).filter(|(l, v)| (200.0..1100.0).contains(*l) && **v > 0.0);
            let slope = fall(points.map(|(l, v)| (*l, *v)));
            if sheet.is_about("rayleigh") || sheet.is_about("bucholtz") || (3.8..4.5).contains(&slope) {
                let per = if area { 1.0 } else { MOLECULES_M3 };
                findings.extend(against(sheet, column, 1.5, "Rayleigh scattering of air, Bucholtz 1995", |row| {
                    Some(per * rayleigh(wavelengths[row]))
                }));
                if !(3.8..4.5).contains(&slope) {
                    let found = format!("a fall as wavelength^{:.2}", -slope);
                    findings.push(Finding::new(
                        Check::Range,
                        &[&column.name],
                        found,
                        "about wavelength^-4.1 (Rayleigh scattering)",
                    ));
                }
            }
        }
    }
    // rho from F = (6 + 3 rho) / (6 - 7 rho), gamma = rho / (2 - rho) (Bucholtz 1995).
    let (king, rho, gamma) =
        (sheet.find(Quantity::King), sheet.find(Quantity::Depolarization), sheet.find(Quantity::Gamma));
    let of_king = |row: usize| king.map(|c| 6.0 * (c.si(row) - 1.0) / (3.0 + 7.0 * c.si(row)));
    let of_rho = |row: usize| of_king(row).or_else(|| rho.map(|c| c.si(row)));
    findings.extend(rho.and_then(|c| worst(sheet, c, king, 0.03, "the King factor", of_king)));
    findings.extend(gamma.and_then(|c| {
        worst(sheet, c, king.or(rho), 0.03, "rho / (2 - rho)", |row| of_rho(row).map(|r| r / (2.0 - r)))
    }));
    findings
}

/// The row of a column that is farthest from what another gives, if farther than `slack` (relative).
fn worst(
    sheet: &Sheet,
    column: &Column,
    other: Option<&Column>,
    slack: f64,
    what: &str,
    expected: impl Fn(usize) -> Option<f64>,
) -> Option<Finding> {
    let off = |row: usize| {
        let there = expected(row)?;
        let relative = (column.si(row) - there).abs() / there.abs().max(column.si(row).abs());
        (relative > slack).then_some((relative, row))
    };
    let rows: Vec<(f64, usize)> = (0..column.values.len()).filter_map(off).collect();
    let (_, row) = *rows.iter().max_by(|a, b| a.0.total_cmp(&b.0))?;
    let found = format!("{}, and {} of {} rows off", round(column.si(row)), rows.len(), column.values.len());
    let columns: Vec<&str> = std::iter::once(column).chain(other).map(|c| c.name.as_str()).collect();
    let expected = format!("{} by {what}, within {} %", round(expected(row)?), round(100.0 * slack));
    Some(Finding::new(Check::Identity, &columns, found, expected).at(sheet.line(row), sheet.at(row)))
}

/// Temperature, pressure and density of air.
fn air(sheet: &Sheet) -> Vec<Finding> {
    let mut findings = Vec::new();
    let find = |q: Quantity| sheet.find(q);
    let (temperature, pressure) = (find(Quantity::Temperature), find(Quantity::Pressure));
    let number = sheet.columns.iter().find(|c| {
        c.meaning.quantity == Quantity::NumberDensity
            && sheet.species.is_none()
            && !c.meaning.says("ozone")
            && pressure.is_some()
    });
    let mass = find(Quantity::MassDensity).filter(|_| pressure.is_some());
    if let Some(altitude) = find(Quantity::Altitude) {
        // Within a factor of 3 up to 120 km; no law above.
        let at_ground = |ground: f64| {
            move |row: usize| Some(ground * (-altitude.si(row) / 7000.0).exp()).filter(|_| altitude.si(row) < 1.21e5)
        };
        for (column, ground) in [(pressure, 101_325.0), (number, 2.55e25), (mass, 1.225)] {
            findings.extend(column.and_then(|c| against(sheet, c, 3.0, "air at that altitude", at_ground(ground))));
        }
        if let Some(geopotential) = find(Quantity::Geopotential) {
            // z R / (R + z), R the radius of the standard.
            let expected = |row: usize| {
                Some(altitude.si(row) * 6_356_766.0 / (6_356_766.0 + altitude.si(row))).filter(|z| *z > 0.0)
            };
            findings.extend(worst(sheet, geopotential, Some(altitude), 1e-3, "the geometric altitude", expected));
        }
    }
    if let (Some(t), Some(p), Some(n)) = (temperature, pressure, number) {
        let expected = |row: usize| Some(p.si(row) / (BOLTZMANN * t.si(row)));
        findings.extend(worst(sheet, n, Some(p), 0.02, "N = p / (k T)", expected).map(|mut finding| {
            finding.columns.push(t.name.clone());
            finding
        }));
    }
    if let (Some(rho), Some(n)) = (mass, number) {
        findings.extend(worst(
            sheet,
            rho,
            Some(n),
            0.2,
            "the number density times the mean mass of a molecule",
            |row| Some(n.si(row) * AIR_MOLECULE_KG),
        ));
    }
    if let Some(n) = number {
        for part in sheet.columns.iter().filter(|c| c.meaning.quantity == Quantity::MixingRatio) {
            let density =
                sheet.columns.iter().find(|c| c.meaning.quantity == Quantity::NumberDensity && c.meaning.says("ozone"));
            if let Some(density) = density.filter(|_| part.meaning.says("ozone")) {
                findings.extend(worst(
                    sheet,
                    density,
                    Some(part),
                    0.04,
                    "the mole fraction times the density of air",
                    |row| Some(part.si(row) * n.si(row)),
                ));
            }
        }
    }
    findings
}

/// The sun, the eye and grounds.
fn light(sheet: &Sheet) -> Vec<Finding> {
    let mut findings = Vec::new();
    let wavelengths = &sheet.nm;
    if let (Some(l), Some(column)) = (wavelengths, sheet.find(Quantity::Irradiance)) {
        // Near 550 nm, where no strong line is; 1.87 W m^-2 nm^-1 in ASTM G173 and E490.
        let near = |row: usize| Some(1.87).filter(|_| (540.0..560.0).contains(&l[row]));
        findings.extend(against(sheet, column, 1.2, "the sun at 1 au", near));
    }
    let matching: Vec<&Column> = (0..3).filter_map(|i| sheet.find(Quantity::Matching(i))).collect();
    if let (Some(l), [x, y, z]) = (wavelengths, matching.as_slice()) {
        let area = |c: &Column| (1..l.len()).map(|i| 0.5 * (l[i] - l[i - 1]) * (c.si(i) + c.si(i - 1))).sum::<f64>();
        for (c, (low, high)) in [(x, (585.0, 610.0)), (y, (540.0, 570.0)), (z, (435.0, 460.0))] {
            let peak = (0..l.len()).max_by(|a, b| c.si(*a).total_cmp(&c.si(*b))).map_or(0.0, |row| l[row]);
            if !(low..=high).contains(&peak) {
                findings.push(Finding::new(
                    Check::Range,
                    &[&c.name],
                    format!("the largest value at {peak} nm"),
                    format!("{low} to {high} nm"),
                ));
            }
            if !(104.0..=119.0).contains(&area(c)) {
                let found = format!("an integral of {} nm", round(area(c)));
                findings.push(Finding::new(
                    Check::Range,
                    &[&c.name],
                    found,
                    "about 106.9 nm, as for white light of equal energy (113.4 in the functions of 2006)",
                ));
            }
        }
    }
    let ground = |word: &str| {
        sheet.columns.iter().find(|c| c.meaning.quantity == Quantity::Reflectance && (c.name.contains(word)))
    };
    if let (Some(dry), Some(wet)) = (ground("dry"), ground("wet")) {
        let rows: Vec<usize> = (0..dry.values.len()).filter(|row| wet.si(*row) > dry.si(*row)).collect();
        if let Some(&row) = rows.first() {
            let found = format!("wet {} above dry {}", round(wet.si(row)), round(dry.si(row)));
            findings.push(
                Finding::new(Check::Identity, &[&dry.name, &wet.name], found, "a wet ground that is darker")
                    .at(sheet.line(row), sheet.at(row)),
            );
        }
    }
    for water in ["ocean", "sea", "water"] {
        if let Some(column) = ground(water) {
            // A flat sea under diffuse light: 0.066 (Burt 1954); foam and haze do not reach 0.3.
            findings.extend(against(sheet, column, 4.0, "diffuse light on water", |_| Some(0.066)));
        }
    }
    let limb: Vec<&Column> = (0..6).filter_map(|i| sheet.find(Quantity::Limb(i))).collect();
    if limb.len() == 6 {
        let names: Vec<&str> = limb.iter().map(|c| c.name.as_str()).collect();
        for row in 0..limb[0].values.len() {
            let sum: f64 = limb.iter().map(|c| c.si(row)).sum();
            if (sum - 1.0).abs() > 1e-3 {
                let finding = Finding::new(
                    Check::Identity,
                    &names,
                    format!("a sum of {}", round(sum)),
                    "1, the centre of the disc",
                );
                findings.push(finding.at(sheet.line(row), sheet.at(row)));
                break;
            }
            let mean: f64 = limb.iter().zip(2..).map(|(c, n)| 2.0 * c.si(row) / f64::from(n)).sum();
            let stated = sheet.find(Quantity::DiscMean).map(|c| c.si(row));
            let expected = stated.unwrap_or(mean.clamp(0.6, 0.95));
            if (mean - expected).abs() > 2e-3 {
                let names: Vec<&str> =
                    names.into_iter().chain(sheet.find(Quantity::DiscMean).map(|c| c.name.as_str())).collect();
                let finding = Finding::new(
                    Check::Identity,
                    &names,
                    format!("a mean over the disc of {}", round(mean)),
                    round(expected),
                );
                findings.push(finding.at(sheet.line(row), sheet.at(row)));
                break;
            }
        }
    }
    findings
}

/// Ozone columns, their spread, layers and profiles.
fn ozone_amounts(sheet: &Sheet) -> Vec<Finding> {
    let mut findings = Vec::new();
    let (column, spread) = (sheet.find(Quantity::Column), sheet.find(Quantity::Spread));
    if let (Some(c), Some(s)) = (column, spread)
        && let Some(row) = (0..c.values.len()).find(|row| s.si(*row) > 0.5 * c.si(*row))
    {
        let found = format!("a spread of {} DU of a column of {} DU", round(s.si(row)), round(c.si(row)));
        findings.push(
            Finding::new(Check::Identity, &[&c.name, &s.name], found, "a spread below half the column")
                .at(sheet.line(row), String::new()),
        );
    }
    let shares: Vec<&Column> = sheet.columns.iter().filter(|c| c.meaning.quantity == Quantity::Fraction).collect();
    if let (Some(c), Some(share)) = (column.filter(|c| c.meaning.says("layer")), shares.first()) {
        let total: f64 = (0..c.values.len()).map(|row| c.si(row)).sum();
        findings.extend(worst(sheet, share, Some(c), 1e-3, "its part of the sum of the layers", |row| {
            Some(c.si(row) / total)
        }));
    }
    // Mixing ratios of ozone are largest between 25 and 45 km.
    if let Some(altitude) = sheet.find(Quantity::Altitude) {
        let profile = |c: &&Column| {
            c.meaning.quantity == Quantity::MixingRatio && (c.meaning.says("ozone") || c.meaning.says("vmr"))
        };
        for c in sheet.columns.iter().filter(profile) {
            for block in &sheet.blocks {
                findings.extend(peak(sheet, c, altitude, block, (22e3, 50e3)));
            }
        }
    }
    findings
}

/// A profile that has its largest value elsewhere than it should.
pub(super) fn peak(
    sheet: &Sheet,
    column: &Column,
    altitude: &Column,
    block: &Block,
    at: (f64, f64),
) -> Option<Finding> {
    let row = block.rows.clone().max_by(|a, b| column.si(*a).total_cmp(&column.si(*b)))?;
    let top = block.rows.clone().map(|row| altitude.si(row)).fold(0.0, f64::max);
    if top < at.1 || (at.0..=at.1).contains(&altitude.si(row)) {
        return None;
    }
    let found = format!("the largest value at {} m", round(altitude.si(row)));
    let finding = Finding::new(Check::Range, &[&column.name], found, format!("{} to {} m", round(at.0), round(at.1)));
    Some(finding.of(&block.label).at(sheet.line(row), String::new()))
}

/// A material, its range of n and its range of k.
type Material = (&'static str, (f64, f64), (f64, f64));

/// n and k of aerosol materials from 400 to 800 nm, dry to 99 % humidity: the range of OPAC (Hess et al. 1998).
const MATERIALS: [Material; 6] = [
    ("soot", (1.75, 1.75), (0.43, 0.46)),
    ("water_soluble", (1.341, 1.53), (3.1e-4, 1.0e-2)),
    ("mineral", (1.53, 1.53), (4e-3, 1.3e-2)),
    ("insoluble", (1.52, 1.53), (8e-3, 8e-3)),
    ("sea_salt", (1.33, 1.50), (1.1e-9, 2.0e-6)),
    ("sulfate", (1.332, 1.44), (1.2e-9, 1.6e-7)),
];

/// Refractive indices and sizes.
fn matter(sheet: &Sheet) -> Vec<Finding> {
    let mut findings = Vec::new();
    let (n, k) = (sheet.find(Quantity::IndexReal), sheet.find(Quantity::IndexImaginary));
    if let (Some(l), Some(n), Some(k)) = (&sheet.nm, n, k) {
        for block in &sheet.blocks {
            let material = MATERIALS.iter().find(|(name, ..)| block.label.split(',').next() == Some(name));
            let rows: Vec<usize> = block.rows.clone().filter(|row| (400.0..=800.0).contains(&l[*row])).collect();
            let middle = |c: &Column| {
                let mut values: Vec<f64> = rows.iter().map(|row| c.si(*row)).filter(|v| v.is_finite()).collect();
                values.sort_by(f64::total_cmp);
                values.get(values.len() / 2).copied()
            };
            // Without a name: solids and liquids that transmit visible light, and soot.
            let &(_, real, imaginary) = material.unwrap_or(&("", (1.25, 2.2), (1e-10, 0.5)));
            for (c, (low, high), slack) in [(n, real, 1.1), (k, imaginary, 5.0)] {
                let Some(value) = middle(c) else { continue };
                if value < low / slack || value > high * slack {
                    let expected = format!("{} to {} from 400 to 800 nm", round(low / slack), round(high * slack));
                    findings.push(Finding::new(Check::Range, &[&c.name], round(value), expected).of(&block.label));
                }
            }
        }
    }
    // Smallest, median and largest radius of a distribution.
    let radius =
        |word: &str| sheet.columns.iter().find(|c| c.meaning.quantity == Quantity::Radius && c.meaning.says(word));
    let triple = [radius("min"), radius("mod").or_else(|| radius("median")), radius("max")];
    for pair in triple.windows(2) {
        if let [Some(a), Some(b)] = pair
            && let Some(row) = (0..a.values.len()).find(|row| a.si(*row) >= b.si(*row))
        {
            let found = format!("{} m and {} m", round(a.si(row)), round(b.si(row)));
            findings.push(
                Finding::new(Check::Identity, &[&a.name, &b.name], found, "radii that grow from column to column")
                    .at(sheet.line(row), String::new()),
            );
        }
    }
    findings
}
