//! What the linter says of right numbers (nothing), of the thesis', and of right ones with one thing wrong.

use super::*;
use std::collections::BTreeMap;
use tables::views::{Aerosol, AerosolSource, Biome};

fn root(path: &str) -> PathBuf {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/..")).join(path)
}

fn lines(findings: &[Finding]) -> String {
    findings.iter().map(|finding| format!("{finding}\n")).collect()
}

/// The cross-sections of the thesis with the labels of its code, "absorption" for what is scattering.
fn thesis() -> String {
    let text = std::fs::read_to_string(root("raw-data/aerosol-gavin-2020/cross-sections.csv")).expect("a file");
    let body: Vec<&str> = text.lines().filter(|line| !line.starts_with('#')).collect();
    let header = body[0].replace("scattering", "x").replace("absorption", "scattering").replace("_x_", "_absorption_");
    format!("{header}\n{}\n", body[1..].join("\n"))
}

/// Scattering and absorption of every biome of a source from its table, dry, as a CSV file in m^2.
fn right(source: AerosolSource) -> String {
    let mut header = String::from("wavelength_nm");
    let mut rows: BTreeMap<u32, String> = (300..=1000).step_by(25).map(|nm| (nm, nm.to_string())).collect();
    for biome in Biome::ALL {
        let path = root("data").join(Aerosol::file_name(source, biome));
        let aerosol = Aerosol::from_table(&tables::file::read(&path).expect("a table")).expect("an aerosol");
        let species = &aerosol.species[0];
        header += &format!(",{biome}_scattering_m2,{biome}_absorption_m2");
        for (nm, row) in &mut rows {
            let (e, s) = species.cross_sections(species.default_humidity_percent, f64::from(*nm)).expect("inside");
            *row += &format!(",{s:e},{:e}", (e - s).max(1e-30));
        }
    }
    format!("{header}\n{}\n", rows.into_values().collect::<Vec<_>>().join("\n"))
}

/// A CSV file with its fields changed, the header row being row 0.
fn changed(text: &str, change: impl Fn(usize, &mut Vec<String>)) -> String {
    let one = |(i, line): (usize, &str)| {
        let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
        change(i, &mut fields);
        fields.join(",") + "\n"
    };
    text.lines().enumerate().map(one).collect()
}

/// Whether a finding says that scattering and absorption of a biome are swapped.
fn says_swapped(findings: &[Finding], biome: Biome) -> bool {
    findings.iter().any(|f| f.subject.starts_with(biome.name()) && f.cause.contains("swapped"))
}

fn about(findings: &[Finding], biome: Biome) -> bool {
    findings.iter().any(|f| f.subject.starts_with(biome.name()))
}

#[test]
fn every_table_of_data_passes() {
    for path in files(&root("data")).expect("a folder") {
        let findings = lint(&path).expect("a table");
        assert!(findings.is_empty(), "{}", lines(&findings));
    }
}

#[test]
fn every_measured_input_passes_but_those_that_are_wrong_on_purpose() {
    for path in files(&root("raw-data")).expect("a folder") {
        let findings = lint(&path).expect("a CSV file");
        let wrong = ["aerosol-gavin-2020", "ozone-thesis"].iter().any(|name| path.to_string_lossy().contains(name));
        assert_eq!(findings.is_empty(), !wrong, "{}: {}", path.display(), lines(&findings));
    }
}

#[test]
fn each_biome_of_the_thesis_has_scattering_and_absorption_swapped() {
    let findings = lint_csv("a.csv", &thesis()).expect("CSV");
    for biome in Biome::ALL {
        assert!(says_swapped(&findings, biome), "{biome}: {}", lines(&findings));
    }
}

#[test]
fn other_names_and_units_hide_nothing() {
    type Form<'a> = &'a dyn Fn(&str, &str) -> String;
    let forms: [Form; 6] = [
        &|biome, what| format!("{biome}_{}", &what[..1]),
        &|biome, what| format!("{}_{biome}_cross_section_m2", &what[..3]),
        &|biome, what| format!("C_{}({}) [um2]", &what[..3], biome.replace('-', "_")),
        &|biome, what| format!("{}querschnitt_{biome}_km²", if what == "scattering" { "Streu" } else { "Absorptions" }),
        &|biome, what| format!("sigma_{}_{biome}", &what[..1]),
        &|biome, what| format!("{}{what}", biome.replace('-', "")),
    ];
    for form in forms {
        let text = changed(&thesis(), |row, fields| {
            for field in fields.iter_mut().skip(1).filter(|_| row == 0) {
                let (biome, rest) = field.split_once('_').expect("a biome");
                *field = form(biome, rest.split('_').next().expect("a quantity"));
            }
        });
        let findings = lint_csv("a.csv", &text).expect("CSV");
        for biome in Biome::ALL {
            assert!(says_swapped(&findings, biome), "{}: {biome}: {}", &text[..300], lines(&findings));
        }
    }
    // Names that say no biome: the laws of all particles tell.
    let text = changed(&thesis(), |row, fields| {
        for (i, field) in fields.iter_mut().enumerate().skip(1).filter(|_| row == 0) {
            *field = format!("type{}_{}", (i - 1) / 2, if i % 2 == 1 { "absorption" } else { "scattering" });
        }
    });
    let findings = lint_csv("a.csv", &text).expect("CSV");
    for i in 0..9 {
        let found = findings.iter().any(|f| f.subject == format!("type{i}") && f.cause.contains("swapped"));
        assert!(found, "type{i}: {}", lines(&findings));
    }
}

#[test]
fn a_biome_put_right_is_no_longer_named_and_the_others_are() {
    for (i, biome) in Biome::ALL.into_iter().enumerate() {
        let exchanged = changed(&thesis(), |row, fields| {
            if row > 0 {
                fields.swap(1 + 2 * i, 2 + 2 * i);
            }
        });
        let findings = lint_csv("a.csv", &exchanged).expect("CSV");
        for other in Biome::ALL {
            assert_eq!(says_swapped(&findings, other), other != biome, "{biome}, {other}: {}", lines(&findings));
        }
        // The right cross-sections of either source, in km^2, at the wavelengths that both files have.
        for source in AerosolSource::ALL {
            let right = right(source);
            let rows: BTreeMap<&str, Vec<&str>> = right
                .lines()
                .skip(1)
                .map(|l| (l.split(',').next().unwrap_or_default(), l.split(',').collect()))
                .collect();
            let thesis = thesis();
            let kept: Vec<&str> = thesis
                .lines()
                .enumerate()
                .filter(|(row, l)| *row == 0 || rows.contains_key(l.split(',').next().unwrap_or_default()))
                .map(|(_, l)| l)
                .collect();
            let text = changed(&kept.join("\n"), |row, fields| {
                if row == 0 {
                    fields.swap(1 + 2 * i, 2 + 2 * i);
                } else {
                    for j in [1 + 2 * i, 2 + 2 * i] {
                        let m2: f64 = rows[fields[0].as_str()][j].parse().expect("a number");
                        fields[j] = format!("{:e}", m2 * 1e-6);
                    }
                }
            });
            let findings = lint_csv("a.csv", &text).expect("CSV");
            for other in Biome::ALL {
                assert_eq!(about(&findings, other), other != biome, "{source} {biome}, {other}: {}", lines(&findings));
            }
        }
    }
}

#[test]
fn right_cross_sections_pass_and_one_thing_wrong_with_them_is_named() {
    for source in AerosolSource::ALL {
        let right = right(source);
        let findings = lint_csv("a.csv", &right).expect("CSV");
        assert!(findings.is_empty(), "{source}: {}", lines(&findings));
        for (i, biome) in Biome::ALL.into_iter().enumerate() {
            let (s, a) = (1 + 2 * i, 2 + 2 * i);
            let swapped = changed(&right, |row, fields| {
                if row > 0 {
                    fields.swap(s, a);
                }
            });
            let findings = lint_csv("a.csv", &swapped).expect("CSV");
            assert!(says_swapped(&findings, biome), "{source} {biome}: {}", lines(&findings));
            for (column, factor) in [(s, 1e3), (s, 1e-3), (s, 1e6), (s, 1e-2), (s, 1e2), (a, 1e6)] {
                let scaled = changed(&right, |row, fields| {
                    if row > 0 {
                        let value: f64 = fields[column].parse().expect("a number");
                        fields[column] = format!("{:e}", value * factor);
                    }
                });
                let findings = lint_csv("a.csv", &scaled).expect("CSV");
                // The clear aerosols of Jaenicke absorb 1e-8 to 1e-4 of what they scatter, which no law bounds from below,
                // and a hundredth of his background is OPAC's.
                let jaenicke = source == AerosolSource::Jaenicke;
                let clear = jaenicke && matches!(biome, Biome::Background | Biome::MaritimeClean) && column == a;
                let other = jaenicke && biome == Biome::Background && factor == 1e-2;
                assert!(
                    about(&findings, biome) || clear || other,
                    "{source} {biome} {column} {factor}: {}",
                    lines(&findings)
                );
            }
        }
    }
}

/// The pairs of fields of one table that cannot be told apart by their numbers: errors of quadrature, which are of one
/// order in every species, densities that are nearly the same, and elements of scattering matrices.
fn undecidable(a: &str, b: &str) -> bool {
    let error = |name: &str| name.ends_with("_quadrature_error") || name.ends_with("_misplaced_by_quadrature");
    // Of maritime-mineral: 600 and 570 particles in a cubic centimetre.
    let alike = (a, b) == ("boundary_layer_number_density", "free_troposphere_number_density");
    // P12 and P34 both vanish ahead and back, and each is much the same in every species.
    let side = |name: &str| name.ends_with("_p12") || name.ends_with("_p34");
    let diagonal = |name: &str| name.ends_with("_p33");
    error(a) && error(b) || alike || side(a) && side(b) || diagonal(a) && diagonal(b)
}

/// The scales that cannot be told: of errors that are not the largest of their table, a smaller one.
fn undecidable_scale(name: &str, factor: f64) -> bool {
    factor < 1.0
        && undecidable(name, name)
        && (name.ends_with("_quadrature_error") || name.ends_with("_misplaced_by_quadrature"))
}

#[test]
fn each_field_scaled_and_each_pair_of_fields_swapped_is_named() {
    let mut missed = Vec::new();
    for path in files(&root("data")).expect("a folder") {
        let table = tables::file::read(&path).expect("a table");
        let name = path.file_name().expect("a name").to_string_lossy().into_owned();
        // Without the search for causes, which names no less.
        let named = |changed: &Table, fields: &[&str]| {
            changed.laws().iter().any(|f| fields.iter().any(|field| f.columns.iter().any(|c| c == field)))
        };
        for (i, field) in table.fields.iter().enumerate() {
            if field.values.iter().all(|v| *v == 0.0) {
                continue;
            }
            for factor in [1e3, 1e-3] {
                let mut changed = table.clone();
                changed.scale(i, factor);
                if !undecidable_scale(&field.name, factor) && !named(&changed, &[&field.name]) {
                    missed.push(format!("{name}: {} times {factor}", field.name));
                }
            }
            for (j, other) in table.fields.iter().enumerate().skip(i + 1) {
                let mut changed = table.clone();
                if field.values != other.values
                    && !undecidable(&field.name, &other.name)
                    && changed.exchange(i, j)
                    && !named(&changed, &[&field.name, &other.name])
                {
                    missed.push(format!("{name}: {} and {}", field.name, other.name));
                }
            }
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}

#[test]
fn a_slipped_decimal_and_a_wrong_digit_are_named_with_their_row() {
    let findings = lint(&root("raw-data/ozone-thesis/cross-section.csv")).expect("CSV");
    let [one] = findings.as_slice() else { panic!("{}", lines(&findings)) };
    assert_eq!((one.at.as_str(), one.check), ("248 nm", Check::Smoothness));
    assert!(one.cause.contains("decimal slipped by 10^-1"), "{one}");

    // The digit of the number density at 1 km that stood wrong in a printed profile: 4 %.
    let text = std::fs::read_to_string(root("raw-data/us-standard-atmosphere-1976/profile.csv")).expect("a file");
    let wrong = text.replace("2.31132e+25", "2.40132e+25");
    let findings = lint_csv("profile.csv", &wrong).expect("CSV");
    assert!(findings.iter().any(|f| f.at == "1000 m" && f.check == Check::Smoothness), "{}", lines(&findings));
    assert!(findings.iter().any(|f| f.at == "1000 m" && f.check == Check::Identity), "{}", lines(&findings));
}

#[test]
fn the_form_of_a_file_is_judged() {
    let of = |text: &str| lint_csv("a.csv", text).expect("CSV");
    let has = |text: &str, check: Check, line: u64| {
        let findings = of(text);
        assert!(findings.iter().any(|f| f.check == check && f.line == Some(line)), "{text}: {}", lines(&findings));
    };
    has("wavelength_nm,king_factor\n500,1.049\n1500,1.047\n1500,1.047\n", Check::Order, 4);
    has("wavelength_nm,king_factor\n500,1.049\n600,x\n700,1.048\n800,1.047\n900,1.047\n950,1.047\n", Check::Missing, 3);
    has("wavelength_nm,king_factor\n500,1.049\n600,\n700,1.048\n", Check::Missing, 3);
    has("wavelength_nm,king_factor\n500,1.049\n600\n", Check::Columns, 3);
    let contradiction = "# unit cross_section_m2: cm^2\nwavelength_nm,cross_section_m2\n550,4.5e-31\n";
    assert!(of(contradiction).iter().any(|f| f.check == Check::Columns));
    let nameless = of("wavelength_nm,b1,b2\n500,1,2\n600,2,3\n");
    assert!(nameless.iter().any(|f| f.check == Check::Columns), "{}", lines(&nameless));
    // The z of a colour-matching function is no altitude.
    let colours = of("wavelength_nm,x_bar,y_bar,z_bar\n445,0.35,0.03,1.78\n555,0.51,1.0,0.01\n600,1.06,0.63,0.0\n");
    assert!(!colours.iter().any(|f| f.found.contains(" m ")), "{}", lines(&colours));
    assert!(matches!(lint_csv("a.csv", ""), Err(SheetError::Empty)));
    assert!(matches!(lint_csv("a.csv", "1,2\n3,4\n"), Err(SheetError::NoHeader(1))));
}

#[test]
fn columns_of_measured_inputs_scaled_or_swapped_are_named() {
    let read = |path: &str| std::fs::read_to_string(root("raw-data").join(path)).expect("a file");
    let mut missed = Vec::new();
    for (path, pairs, scaled) in [
        ("us-standard-atmosphere-1976/profile.csv", vec![(2, 3), (3, 5), (4, 5), (0, 1)], vec![1, 2, 3, 4, 5]),
        ("us-standard-atmosphere-1976/to-120km.csv", vec![(1, 2), (3, 4)], vec![1, 2, 3, 4]),
        ("bucholtz-1995/cross-section.csv", vec![(1, 2)], vec![0, 1, 2]),
        ("bucholtz-1995/king-factor.csv", vec![(1, 2), (2, 3)], vec![1, 2, 3]),
        ("cie-1931/colour-matching.csv", vec![(1, 2), (2, 3), (1, 3)], vec![1, 2, 3]),
        ("aerosol-opac-1998/refractive-index.csv", vec![(3, 4)], vec![2, 3, 4]),
        ("aerosol-opac-1998/optics.csv", vec![(3, 4), (4, 5), (3, 5), (6, 7)], vec![3, 4, 5, 6, 7]),
        ("aerosol-opac-1998/types-at-ground.csv", vec![(3, 4)], vec![2, 3, 4]),
        ("aerosol-opac-1998/components.csv", vec![(3, 5), (5, 6)], vec![3, 4, 5, 6]),
        ("ozone-serdyuchenko-2014/cross-section.csv", vec![], vec![1, 5, 11]),
        ("ozone-mcpeters-labow/column.csv", vec![], vec![1, 9, 18]),
        ("ozone-mcpeters-labow/mixing-ratio.csv", vec![(1, 5)], vec![2, 10, 19]),
        ("ozone-arosa/monthly-column.csv", vec![(1, 2)], vec![1, 2]),
        ("ozone-arosa/layer-fractions.csv", vec![(2, 3)], vec![2, 3]),
        ("ground-albedo/spectra.csv", vec![(1, 2)], vec![1, 2, 3]),
        ("sun/spectrum.csv", vec![], vec![0, 1]),
        ("sun/limb-darkening.csv", vec![(1, 2), (3, 4), (5, 6)], vec![1, 2, 7]),
    ] {
        let text = read(path);
        let names: Vec<String> =
            text.lines().find(|l| !l.starts_with('#')).expect("a header").split(',').map(str::to_owned).collect();
        let number = |line: &str| line.split(',').any(|f| f.parse::<f64>().is_ok()) && !line.starts_with('#');
        let edit = |change: &dyn Fn(&mut Vec<String>)| -> String {
            let one = |line: &str| {
                let mut fields: Vec<String> = line.split(',').map(str::to_owned).collect();
                if number(line) {
                    change(&mut fields);
                }
                fields.join(",") + "\n"
            };
            text.lines().map(one).collect()
        };
        let mut judge = |what: String, changed: &str, columns: &[usize]| {
            let findings = lint_csv(path, changed).expect("CSV");
            if !findings.iter().any(|f| columns.iter().any(|c| f.columns.contains(&names[*c]))) {
                missed.push(format!("{path}: {what}: {}", lines(&findings)));
            }
        };
        for (a, b) in pairs {
            judge(format!("{} and {}", names[a], names[b]), &edit(&|fields| fields.swap(a, b)), &[a, b]);
        }
        for column in scaled {
            for factor in [1e3, 1e-3] {
                let scale = |fields: &mut Vec<String>| {
                    if let Ok(value) = fields[column].parse::<f64>() {
                        fields[column] = format!("{:e}", value * factor);
                    }
                };
                judge(format!("{} times {factor}", names[column]), &edit(&scale), &[column]);
            }
        }
    }
    assert!(missed.is_empty(), "{}", missed.join("\n"));
}
