use super::*;
use std::path::Path;

fn read(file: &str) -> (Sources, Table) {
    let data = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../data"));
    Sources::of_file(&data.join(file)).expect("a table")
}

fn numbers<'a>(sheet: &'a Sheet, name: &str) -> Vec<&'a f64> {
    let column = sheet.columns.iter().find(|column| column.name == name).unwrap_or_else(|| panic!("{name}"));
    let Values::Numbers(values) = &column.values else { panic!("numbers are meant") };
    values.iter().flatten().collect()
}

#[test]
fn json_holds_every_node_and_value_of_a_table_exactly() {
    // Three axes and single precision; two species and double precision.
    for file in ["ozone-profiles.table", "aerosol-jaenicke-urban.table", "sun.table"] {
        let (sources, table) = read(file);
        let text = json(&table, &[], &sources).expect("JSON");
        let value: serde_json::Value = serde_json::from_str(&text).expect("JSON");
        let bits = |list: &serde_json::Value| {
            list.as_array().expect("a list").iter().map(|x| x.as_f64().expect("a number").to_bits()).collect::<Vec<_>>()
        };
        let expected = |values: &[f64]| values.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
        for (i, axis) in table.axes.iter().enumerate() {
            assert!(bits(&value["axes"][i]["nodes"]) == expected(&axis.nodes), "{file}: {}", axis.name);
        }
        for (i, field) in table.fields.iter().enumerate() {
            assert!(bits(&value["fields"][i]["values"]) == expected(&field.values), "{file}: {}", field.name);
        }
        assert_eq!(value["provenance"][0]["sha256"], table.provenance[0].sha256.as_str());
        assert_eq!(value["tables"][0]["file"], file);
    }
}

#[test]
fn rows_are_the_nodes_of_the_widest_field_and_the_others_repeat() {
    let (sources, table) = read("ozone-profiles.table");
    let sheet = sheet(&table, &[], sources).expect("a sheet");
    let (latitudes, altitudes) = (table.axes[1].nodes.len(), table.axes[2].nodes.len());
    assert_eq!(sheet.rows(), 12 * latitudes * altitudes);
    let row = (4 * latitudes + 7) * altitudes + 33;
    let at = |name: &str| *numbers(&sheet, name)[row];
    assert_eq!(
        (at("month"), at("latitude_deg"), at("altitude_m")),
        (5.0, table.axes[1].nodes[7], table.axes[2].nodes[33])
    );
    assert_eq!(at("number_density_per_m3"), table.fields[0].values[row]);
    assert_eq!(at("column_DU"), table.fields[1].values[4 * latitudes + 7]);
}

#[test]
fn fields_over_one_axis_stand_side_by_side() {
    let (sources, table) = read("rayleigh.table");
    let sheet = sheet(&table, &[], sources).expect("a sheet");
    let names: Vec<&str> = sheet.columns.iter().map(|column| column.name.as_str()).collect();
    assert_eq!(names, ["wavelength_nm", "cross_section_m2", "king_factor", "gamma"]);
    assert!(numbers(&sheet, "gamma").into_iter().eq(&table.fields[2].values));
}

#[test]
fn fields_that_do_not_go_together_are_chosen_by_name() {
    let (sources, table) = read("aerosol-jaenicke-urban.table");
    let species = table.fields[0].name.trim_end_matches(tables::views::suffix::NUMBER_DENSITY).to_owned();
    let error = sheet(&table, &[], sources.clone()).expect_err("several sets").to_string();
    assert!(error.contains("choose with --field") && error.contains(&format!("{species}_phase")), "{error}");
    let one = [format!("{species}_phase"), format!("{species}_extinction")];
    let sheet_of_one = sheet(&table, &one, sources.clone()).expect("a sheet");
    let phase = table.fields.iter().find(|field| field.name == one[0]).expect("there");
    assert!(numbers(&sheet_of_one, &format!("{species}_phase_per_sr")).into_iter().eq(&phase.values));
    let error = sheet(&table, &["x".into()], sources).expect_err("no such field").to_string();
    assert!(error.starts_with("no field is called \"x\": possible are "), "{error}");
}

#[test]
fn units_become_endings_of_names() {
    for (unit, ending) in
        [("1", ""), ("nm", "_nm"), ("m^2 K^-1", "_m2_per_K"), ("m^-3", "_per_m3"), ("W m^-2 nm^-1", "_W_per_m2_per_nm")]
    {
        assert_eq!(suffix(unit), ending);
    }
}
