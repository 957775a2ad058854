//! Airlight's tables as sheets, and the laws that join fields over different axes.

use super::aerosol::Layer;
use super::finding::{Check, Finding};
use super::names::{Dimension, Quantity};
use super::repair::Judged;
use super::sheet::{Block, Column, Sheet, Species, round};
use super::{aerosol, limits, smooth};
use tables::units::DOBSON_UNIT_M2;
use tables::views::{self, AerosolSource, Angles, Biome, COSINE, integral, suffix};
use tables::{Axis, Field, Interpolation, Kind, Table};

impl Judged for Table {
    fn names(&self) -> Vec<String> {
        self.fields.iter().map(|field| field.name.clone()).collect()
    }

    fn related(&self, i: usize, j: usize) -> bool {
        self.fields[i].axes.len() == self.fields[j].axes.len()
    }

    fn exchange(&mut self, i: usize, j: usize) -> bool {
        if self.fields[i].values.len() != self.fields[j].values.len() {
            return false;
        }
        let values = std::mem::take(&mut self.fields[i].values);
        self.fields[i].values = std::mem::replace(&mut self.fields[j].values, values);
        true
    }

    fn scale(&mut self, i: usize, factor: f64) {
        self.fields[i].values.iter_mut().for_each(|value| *value *= factor);
    }

    fn laws(&self) -> Vec<Finding> {
        let mut findings: Vec<Finding> = Vec::new();
        for sheet in sheets(self) {
            findings.extend(aerosol::laws(&sheet));
            findings.extend(limits::laws(&sheet));
        }
        findings.extend(match self.kind {
            Kind::Aerosol => phases(self),
            Kind::OzoneProfiles | Kind::OzoneLayers => columns(self),
            Kind::OzoneCrossSection => coefficients(self),
            Kind::Sun => limb(self),
            _ => Vec::new(),
        });
        if findings.is_empty() {
            findings.extend(view(self));
        }
        findings
    }
}

/// Values that leave the line of their neighbours.
pub(super) fn roughness(table: &Table) -> Vec<Finding> {
    sheets(table).iter().flat_map(smooth::laws).collect()
}

fn field<'a>(table: &'a Table, name: &str) -> Option<&'a Field> {
    table.fields.iter().find(|field| field.name == name)
}

fn axis<'a>(table: &'a Table, name: &str) -> Option<&'a Axis> {
    table.axes.iter().find(|axis| axis.name == name)
}

/// What the renderer's reading of the table refuses.
fn view(table: &Table) -> Option<Finding> {
    let refused = match table.kind {
        Kind::StandardAtmosphere => views::StandardAtmosphere::from_table(table).err(),
        Kind::Rayleigh => views::Rayleigh::from_table(table).err(),
        Kind::OzoneCrossSection => views::OzoneCrossSection::from_table(table).err(),
        Kind::OzoneProfiles => views::OzoneProfiles::from_table(table).err(),
        Kind::OzoneLayers => views::OzoneLayers::from_table(table).err(),
        Kind::Sun => views::Sun::from_table(table).err(),
        Kind::Observer => views::Observer::from_table(table).err(),
        Kind::GroundAlbedo => views::GroundAlbedo::from_table(table).err(),
        Kind::Aerosol => views::Aerosol::from_table(table).err(),
        Kind::SolvedSky => None,
    }?
    .to_string();
    let named: Vec<&str> = table.fields.iter().map(|f| f.name.as_str()).filter(|name| refused.contains(name)).collect();
    Some(Finding::new(
        Check::Columns,
        &named,
        refused,
        format!("a table of kind {} that the renderer takes", table.kind),
    ))
}

/// A sheet over one axis, or over blocks of it.
fn sheet(table: &Table, along: &Axis, quantity: Quantity, blocks: Vec<Block>, species: Option<Species>) -> Sheet {
    let nodes: Vec<f64> = blocks.iter().flat_map(|_| along.nodes.iter().copied()).collect();
    let column = Column::of_table(&along.name, quantity, Dimension::Length, "", &nodes);
    let (about, columns, lines) = (table.kind.to_string(), vec![column], Vec::new());
    let mut sheet = Sheet { about, columns, lines, blocks, nm: None, species };
    sheet.refresh();
    sheet
}

fn one_block(axis: &Axis) -> Vec<Block> {
    vec![Block { rows: 0..axis.nodes.len(), label: String::new(), biome: None }]
}

/// The fields of a table over one axis, each with its quantity.
fn over(table: &Table, axis_name: &str, along: Quantity, fields: &[(&str, Quantity, Dimension)]) -> Option<Sheet> {
    let axis = axis(table, axis_name)?;
    let mut sheet = sheet(table, axis, along, one_block(axis), None);
    for (name, quantity, dimension) in fields {
        let there = field(table, name).filter(|f| f.values.len() == axis.nodes.len());
        sheet.columns.extend(there.map(|f| Column::of_table(name, *quantity, *dimension, "", &f.values)));
    }
    Some(sheet)
}

fn sheets(table: &Table) -> Vec<Sheet> {
    let one = |axis: &str, along: Quantity, fields: &[(&str, Quantity, Dimension)]| {
        over(table, axis, along, fields).into_iter().collect()
    };
    match table.kind {
        Kind::StandardAtmosphere => one(
            "altitude",
            Quantity::Altitude,
            &[
                ("temperature", Quantity::Temperature, Dimension::Temperature),
                ("pressure", Quantity::Pressure, Dimension::Pressure),
                ("number_density", Quantity::NumberDensity, Dimension::PerVolume),
            ],
        ),
        Kind::Rayleigh => one(
            "wavelength",
            Quantity::Wavelength,
            &[
                ("cross_section", Quantity::CrossSection, Dimension::Area),
                ("king_factor", Quantity::King, Dimension::One),
                ("gamma", Quantity::Gamma, Dimension::One),
            ],
        ),
        Kind::OzoneCrossSection => {
            one("wavelength", Quantity::Wavelength, &[("sigma_0", Quantity::CrossSection, Dimension::Area)])
        }
        Kind::Sun => {
            one("wavelength", Quantity::Wavelength, &[("irradiance", Quantity::Irradiance, Dimension::Irradiance)])
        }
        Kind::Observer => one(
            "wavelength",
            Quantity::Wavelength,
            &[
                ("x_bar", Quantity::Matching(0), Dimension::One),
                ("y_bar", Quantity::Matching(1), Dimension::One),
                ("z_bar", Quantity::Matching(2), Dimension::One),
            ],
        ),
        Kind::GroundAlbedo => grounds(table),
        Kind::Aerosol => species(table),
        Kind::OzoneProfiles | Kind::OzoneLayers | Kind::SolvedSky => Vec::new(),
    }
}

/// One sheet for all grounds whose wavelengths are the same.
fn grounds(table: &Table) -> Vec<Sheet> {
    let mut sheets: Vec<Sheet> = Vec::new();
    for field in &table.fields {
        let [name] = field.axes.as_slice() else { continue };
        let Some(axis) = axis(table, name).filter(|a| a.nodes.len() == field.values.len()) else { continue };
        let column = Column::of_table(&field.name, Quantity::Reflectance, Dimension::One, &field.name, &field.values);
        match sheets.iter_mut().find(|sheet| sheet.columns[0].values == axis.nodes) {
            Some(sheet) => sheet.columns.push(column),
            None => {
                let mut sheet = sheet(table, axis, Quantity::Wavelength, one_block(axis), None);
                sheet.columns.push(column);
                sheets.push(sheet);
            }
        }
    }
    sheets
}

/// The species of a table of an aerosol, with the layer that each is.
fn species_of(table: &Table) -> Vec<(&str, Species)> {
    let setting = |key: &str| table.settings.get(key).map(String::as_str).unwrap_or_default();
    let (Some(source), Some(biome)) = (AerosolSource::from_name(setting("source")), Biome::from_name(setting("biome")))
    else {
        return Vec::new();
    };
    let names = table.fields.iter().filter_map(|field| field.name.strip_suffix(suffix::NUMBER_DENSITY));
    let layer = |(i, name)| match name {
        "stratosphere" => Layer::Stratosphere,
        "transported_mineral" => Layer::TransportedMineral,
        "free_troposphere" if i > 0 => Layer::FreeTroposphere,
        _ => Layer::Lowest(source, biome),
    };
    names.enumerate().map(|(i, name)| (name, Species { biome, layer: layer((i, name)) })).collect()
}

/// For each species its spectra by humidity, and its profile.
fn species(table: &Table) -> Vec<Sheet> {
    let mut sheets = Vec::new();
    for (name, species) in species_of(table) {
        let full = |end: &str| format!("{name}{end}");
        if let (Some(wavelength), Some(humidity)) = (axis(table, "wavelength"), axis(table, &full(suffix::HUMIDITY))) {
            let n = wavelength.nodes.len();
            let block = |(i, h): (usize, &f64)| Block {
                rows: i * n..(i + 1) * n,
                label: format!("{name}, humidity {} percent", round(*h)),
                biome: Some(species.biome),
            };
            let blocks: Vec<Block> = humidity.nodes.iter().enumerate().map(block).collect();
            let rows = blocks.len() * n;
            let mut spectra = sheet(table, wavelength, Quantity::Wavelength, blocks, Some(species));
            for (end, quantity, dimension) in [
                (suffix::EXTINCTION, Quantity::Extinction, Dimension::Area),
                (suffix::SCATTERING, Quantity::Scattering, Dimension::Area),
                (suffix::ASYMMETRY, Quantity::Asymmetry, Dimension::One),
            ] {
                let there = field(table, &full(end)).filter(|f| f.values.len() == rows);
                spectra.columns.extend(there.map(|f| Column::of_table(&f.name, quantity, dimension, "", &f.values)));
            }
            sheets.push(spectra);
        }
        let density = field(table, &full(suffix::NUMBER_DENSITY));
        if let (Some(altitude), Some(f)) = (axis(table, &full(suffix::ALTITUDE)), density)
            && altitude.nodes.len() == f.values.len()
        {
            let mut profile = sheet(table, altitude, Quantity::Altitude, one_block(altitude), Some(species));
            profile.blocks[0].label = name.to_owned();
            profile.columns.push(Column::of_table(
                &f.name,
                Quantity::NumberDensity,
                Dimension::PerVolume,
                "",
                &f.values,
            ));
            sheets.push(profile);
        }
    }
    sheets
}

/// Phase functions against their integral and the asymmetry parameter, default humidities, scattering matrices and
/// quadrature errors.
fn phases(table: &Table) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (name, _) in species_of(table) {
        let full = |end: &str| format!("{name}{end}");
        let of = |end: &str| field(table, &full(end));
        if let (Some(cosine), Some(phase), Some(g)) = (axis(table, COSINE.0), of(suffix::PHASE), of(suffix::ASYMMETRY))
        {
            findings.extend(phase_law(cosine, phase, g).map(|finding| finding.of(name)));
        }
        if let (Some(humidity), Some(default)) = (axis(table, &full(suffix::HUMIDITY)), of(suffix::DEFAULT_HUMIDITY)) {
            let on_axis = |value: &&f64| humidity.nodes.iter().any(|node| (node - **value).abs() < 1e-9);
            if let Some(value) = default.values.first().filter(|v| !on_axis(v)) {
                let nodes: Vec<String> = humidity.nodes.iter().map(|node| round(*node)).collect();
                let expected = format!("a humidity of its axis: {} percent", nodes.join(", "));
                let found = format!("{} percent", round(*value));
                let finding = Finding::new(Check::Range, &[&default.name], found, expected);
                findings.push(finding.of(name));
            }
        }
        findings.extend(matrix_laws(table, name));
    }
    findings.extend(quadrature_laws(table));
    findings
}

/// The scattering matrix of a species: P33 is 1 ahead and -1 back, P12 and P34 vanish there, polarised light is at most all
/// (P12^2 + P33^2 + P34^2 <= 1, with equality for one sphere), and spheres do polarise.
fn matrix_laws(table: &Table, name: &str) -> Vec<Finding> {
    /// What rounding to single precision leaves.
    const ROUNDING: f64 = 1e-6;
    /// The least that P12 and P34 reach at some angle and wavelength; in the tables of `data/` it is 0.24.
    const LEAST: f64 = 0.02;
    let of = |end: &str| field(table, &format!("{name}{end}"));
    let Some(cosine) = axis(table, COSINE.0) else { return Vec::new() };
    let [Some(p12), Some(p33), Some(p34)] = suffix::MATRIX.map(of) else { return Vec::new() };
    let rows = |field: &'_ Field| field.values.chunks(cosine.nodes.len()).map(<[f64]>::to_vec).collect::<Vec<_>>();
    let mut findings = Vec::new();
    for (field, (back, ahead)) in [(p12, (0.0, 0.0)), (p33, (-1.0, 1.0)), (p34, (0.0, 0.0))] {
        let off = rows(field)
            .iter()
            .map(|row| (row[0] - back).abs().max((row[row.len() - 1] - ahead).abs()))
            .fold(0.0, f64::max);
        let largest = field.values.iter().fold(0.0, |a: f64, b| a.max(b.abs()));
        if off > ROUNDING || !(LEAST..=1.0 + ROUNDING).contains(&largest) {
            let found = format!("{} at most, and {} from what it is ahead and back", round(largest), round(off));
            let expected = format!("{LEAST} to 1, {back} at 180 degrees and {ahead} at 0");
            findings.push(Finding::new(Check::Range, &[&field.name], found, expected).of(name));
        }
    }
    let squares = p12.values.iter().zip(&p33.values).zip(&p34.values).map(|((a, b), c)| a * a + b * b + c * c);
    let largest = squares.fold(0.0, f64::max);
    if findings.is_empty() && largest > 1.0 + 3.0 * ROUNDING {
        let found = format!("a sum of squares of {}", round(largest));
        findings.push(Finding::new(Check::Identity, &[&p12.name, &p33.name, &p34.name], found, "at most 1").of(name));
    }
    findings
}

/// The errors of averages over sizes against the largest that the table's settings state.
fn quadrature_laws(table: &Table) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (end, setting) in [
        ("_cross_section_quadrature_error", "largest quadrature error of a cross-section"),
        ("_misplaced_by_quadrature", "largest share of light misplaced by quadrature"),
        ("_phase_quadrature_error", "largest quadrature error of a phase function at an angle"),
    ] {
        let Some(stated) = table.settings.get(setting).and_then(|text| text.parse::<f64>().ok()) else { continue };
        let largest = |field: &Field| field.values.iter().copied().fold(0.0, f64::max);
        let fields: Vec<&Field> = table.fields.iter().filter(|field| field.name.ends_with(end)).collect();
        let Some(worst) = fields.iter().max_by(|a, b| largest(a).total_cmp(&largest(b))) else { continue };
        // The setting has two digits.
        if (largest(worst) / stated - 1.0).abs() > 0.06 {
            let names: Vec<&str> = if largest(worst) > stated {
                vec![&worst.name]
            } else {
                fields.iter().map(|field| field.name.as_str()).collect()
            };
            let found = format!("{:.2e} at most", largest(worst));
            let expected = format!("{stated:e}, as the table's settings say");
            findings.push(Finding::new(Check::Identity, &names, found, expected));
        }
    }
    findings
}

/// The worst phase function of a species.
fn phase_law(cosine: &Axis, phase: &Field, asymmetry: &Field) -> Option<Finding> {
    /// What cubics between angles leave.
    const INTEGRAL: f64 = 1e-3;
    let angles = Angles::new(cosine).ok()?;
    let cosines = angles.cosines();
    let mut worst: Option<(f64, Finding)> = None;
    for (p, g) in phase.values.chunks(cosine.nodes.len()).zip(&asymmetry.values) {
        let nodes: Vec<f64> = p.iter().map(|p| phase.scale.of(*p)).collect();
        let (p, missed) = angles.phase(angles.between(phase.scale, &nodes));
        let whole = 1.0 + missed;
        let forward: Vec<f64> = cosines.iter().zip(p).map(|(c, p)| c * p).collect();
        let mean = integral(cosines, &forward);
        let (off, finding) = if missed.abs() > INTEGRAL {
            let found = format!("an integral over the sphere of {}", round(whole));
            (10.0 + (whole - 1.0).abs(), Finding::new(Check::Identity, &[&phase.name], found, "1"))
        } else {
            let found = format!("a mean cosine of {} and an asymmetry parameter of {}", round(mean), round(*g));
            (
                (mean - g).abs(),
                Finding::new(Check::Identity, &[&phase.name, &asymmetry.name], found, "the same, within 0.02"),
            )
        };
        if off > 0.02 && worst.as_ref().is_none_or(|(w, _)| off > *w) {
            worst = Some((off, finding));
        }
    }
    worst.map(|(_, finding)| finding)
}

/// Ozone: the column of each profile, its amount and where it has its largest density.
fn columns(table: &Table) -> Vec<Finding> {
    let mut findings = Vec::new();
    let (Some(altitude), Some(density), Some(column)) =
        (axis(table, "altitude"), field(table, "number_density"), field(table, "column"))
    else {
        return findings;
    };
    let z = &altitude.nodes;
    for (stated, n) in column.values.iter().zip(density.values.chunks(z.len())) {
        let cell = |i: usize| {
            let height = z[i + 1] - z[i];
            if altitude.interpolation == Interpolation::Step { height * n[i] } else { 0.5 * height * (n[i] + n[i + 1]) }
        };
        let sum = (0..z.len() - 1).map(cell).sum::<f64>() / DOBSON_UNIT_M2;
        if (sum / stated - 1.0).abs() > 0.02 {
            let found = format!("a profile of {} DU and a column of {} DU", round(sum), round(*stated));
            findings.push(Finding::new(Check::Identity, &["number_density", "column"], found, "the same, within 2 %"));
            break;
        }
    }
    if let Some(value) = column.values.iter().find(|v| !(50.0..=700.0).contains(*v)) {
        findings.push(Finding::new(Check::Range, &["column"], format!("{} DU", round(*value)), "50 to 700 DU"));
    }
    for n in density.values.chunks(z.len()) {
        let (at, most) = n.iter().enumerate().fold((0, 0.0), |(i, m), (j, v)| if *v > m { (j, *v) } else { (i, m) });
        // Of the whole climatology the largest densities are 3e18 to 6e18 m^-3 between 15 and 28 km.
        if !(1e18..=1.5e19).contains(&most) || !(10e3..=32e3).contains(&z[at]) {
            let found = format!("a largest density of {most:.2e} m^-3 at {} m", round(z[at]));
            findings.push(Finding::new(
                Check::Range,
                &["number_density"],
                found,
                "1e18 to 1.5e19 m^-3 between 10 and 32 km",
            ));
            break;
        }
    }
    findings
}

/// Ozone: the polynomial in temperature.
fn coefficients(table: &Table) -> Vec<Finding> {
    let mut findings = Vec::new();
    // A kelvin changes the cross-section at 300 nm by 1e-3 to 1e-2 of it, and that change by a hundredth.
    for (name, low, high) in [("sigma_1", 5e-27, 5e-25), ("sigma_2", 2e-29, 2e-27)] {
        let Some(f) = field(table, name) else { continue };
        let most = f.values.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        if !(low..=high).contains(&most) {
            findings.push(Finding::new(
                Check::Range,
                &[name],
                format!("{most:.2e} at most"),
                format!("{low:e} to {high:e} at most"),
            ));
        }
    }
    if let Some(&t) = field(table, "reference_temperature").and_then(|f| f.values.first())
        && !(150.0..=320.0).contains(&t)
    {
        findings.push(Finding::new(
            Check::Range,
            &["reference_temperature"],
            format!("{} K", round(t)),
            "150 to 320 K",
        ));
    }
    findings
}

/// The sun: the coefficients of the limb darkening make 1 at the centre of the disc.
fn limb(table: &Table) -> Vec<Finding> {
    let (Some(powers), Some(limb)) = (axis(table, "power"), field(table, "limb_darkening")) else { return Vec::new() };
    let sums = limb.values.chunks(powers.nodes.len()).map(|row| row.iter().sum::<f64>());
    let worst = sums.max_by(|a, b| (a - 1.0).abs().total_cmp(&(b - 1.0).abs())).filter(|sum| (sum - 1.0).abs() > 1e-3);
    let finding = |sum: f64| {
        Finding::new(Check::Identity, &["limb_darkening"], format!("a sum of coefficients of {}", round(sum)), "1")
    };
    worst.map(finding).into_iter().collect()
}
