use super::*;

/// Numbers that are hard to write, words that want quotes, and a gap.
fn sheet() -> Sheet {
    let series = |name: &str, unit: &str, group, values| Series {
        name: name.into(),
        label: name.into(),
        unit: unit.into(),
        meaning: format!("what {name} means"),
        group,
        values,
    };
    let numbers = vec![Some(1.0 / 3.0), None, Some(-1.7e-309), Some(f64::MAX), Some(0.1 + 0.2)];
    let words = ["a", "b,c", "d\"e", "", "f"].map(String::from).to_vec();
    let columns = vec![
        series("x_nm", "nm", None, Values::Numbers((0..5).map(|i| Some(f64::from(i) * 0.1)).collect())),
        series("word", "text", None, Values::Words(words)),
        series("y_m2", "m^2", Some("values"), Values::Numbers(numbers)),
    ];
    Sheet::new("a title".into(), vec![("month".into(), "6\nx".into())], Sources::default(), columns).expect("a sheet")
}

fn bits(values: &Values) -> Vec<Option<u64>> {
    let Values::Numbers(values) = values else { panic!("numbers are meant") };
    values.iter().map(|value| value.map(f64::to_bits)).collect()
}

#[test]
fn csv_gives_every_number_and_word_back() {
    let sheet = sheet();
    let bytes = sheet.encode(Format::Csv, false).expect("CSV");
    let text = String::from_utf8(bytes.clone()).expect("text");
    assert!(text.starts_with("# title: a title\n# month: 6 x\n# unit x_nm: nm\n"), "{text}");
    let mut reader = csv::ReaderBuilder::new().comment(Some(b'#')).from_reader(&bytes[..]);
    assert_eq!(reader.headers().expect("a header"), vec!["x_nm", "word", "y_m2"]);
    let rows: Vec<csv::StringRecord> = reader.records().collect::<Result<_, _>>().expect("rows");
    for column in [0, 2] {
        let read = rows.iter().map(|row| row[column].parse::<f64>().ok().map(f64::to_bits)).collect::<Vec<_>>();
        assert_eq!(read, bits(&sheet.columns[column].values));
    }
    assert_eq!(rows.iter().map(|row| &row[1]).collect::<Vec<_>>(), ["a", "b,c", "d\"e", "", "f"]);
    let bare = sheet.encode(Format::Csv, true).expect("CSV");
    assert!(bare.starts_with(b"x_nm,word,y_m2\n") && text.ends_with(std::str::from_utf8(&bare).expect("text")));
}

#[test]
fn json_gives_every_number_and_word_back() {
    let sheet = sheet();
    let bytes = sheet.encode(Format::Json, false).expect("JSON");
    let value: serde_json::Value = serde_json::from_slice(&bytes).expect("JSON");
    assert_eq!(value["settings"]["month"], "6\nx");
    assert_eq!(value["columns"][2]["unit"], "m^2");
    let rows = value["rows"].as_array().expect("rows");
    for (name, column) in [("x_nm", 0), ("y_m2", 2)] {
        let read = rows.iter().map(|row| row[name].as_f64().map(f64::to_bits)).collect::<Vec<_>>();
        assert_eq!(read, bits(&sheet.columns[column].values));
    }
    assert_eq!(rows[2]["word"], "d\"e");
    assert!(rows[1]["y_m2"].is_null());
}

#[cfg(feature = "parquet")]
#[test]
fn parquet_gives_every_number_and_word_back() {
    use polars::prelude::{ParquetReader, SerReader};
    let sheet = sheet();
    let bytes = sheet.encode(Format::Parquet, false).expect("Parquet");
    let mut reader = ParquetReader::new(std::io::Cursor::new(bytes));
    let metadata = reader.get_metadata().expect("metadata").clone();
    let pairs = metadata.key_value_metadata().as_ref().expect("pairs");
    let about = pairs.iter().find(|pair| pair.key == "airlight").and_then(|pair| pair.value.clone()).expect("ours");
    let about: serde_json::Value = serde_json::from_str(&about).expect("JSON");
    assert_eq!(about["columns"][0]["meaning"], "what x_nm means");
    let frame = reader.finish().expect("a frame");
    for (name, column) in [("x_nm", 0), ("y_m2", 2)] {
        let read = frame.column(name).expect(name).f64().expect("doubles").iter().map(|x| x.map(f64::to_bits));
        assert_eq!(read.collect::<Vec<_>>(), bits(&sheet.columns[column].values));
    }
    let words = frame.column("word").expect("word").str().expect("strings").iter().flatten().collect::<Vec<_>>();
    assert_eq!(words, ["a", "b,c", "d\"e", "", "f"]);
}

#[test]
fn text_has_blocks_of_aligned_columns_without_what_is_missing() {
    let text = String::from_utf8(sheet().encode(Format::Text, true).expect("text")).expect("text");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(
        lines[..4],
        [
            "values",
            "                 x_nm  word           y_m2",
            "                   nm                  m^2",
            "                    0  a          0.333333"
        ]
    );
    assert!(!text.contains("b,c"), "a row without a value is shown: {text}");
}

#[test]
fn formats_go_by_the_ending_of_a_name() {
    assert_eq!(Format::of_file(Path::new("a/b.JSON")).expect("known"), Format::Json);
    assert_eq!(Format::of_file(Path::new("b.txt")).expect("known"), Format::Text);
    for name in ["a.text", "a.xlsx", "csv"] {
        let error = Format::of_file(Path::new(name)).expect_err(name).to_string();
        assert!(error.starts_with(&format!("{name}: which format?")), "{error}");
    }
}

#[test]
fn columns_that_do_not_fit_are_refused() {
    let refused = |change: fn(&mut Vec<Series>)| {
        let mut columns = sheet().columns;
        change(&mut columns);
        Sheet::new(String::new(), Vec::new(), Sources::default(), columns).expect_err("no sheet").to_string()
    };
    assert!(refused(|columns| columns[1].values = Values::Words(Vec::new())).contains("differ in length"));
    assert!(refused(|columns| columns[0].name = "y_m2".into()).contains("two columns are called \"y_m2\""));
    assert!(refused(|columns| columns[0].values = Values::Numbers(vec![Some(f64::NAN); 5])).contains("not finite"));
    assert!(refused(Vec::clear).contains("without columns"));
}
