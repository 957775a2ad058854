use super::*;

#[derive(Debug, PartialEq)]
struct Sample {
    altitude_m: f64,
    albedo: Option<f64>,
}

impl Row for Sample {
    type Record = (f64, Option<f64>);

    fn columns() -> Vec<Column> {
        vec![Column::number("altitude_km", "km", 0.0, 120.0).key(), Column::optional("albedo", "1", 0.0, 1.0)]
    }

    fn from_record((altitude_km, albedo): Self::Record) -> Self {
        Self { altitude_m: altitude_km * tables::units::KM, albedo }
    }
}

const GOOD: &str = "# title: a title\n# citation: a paper: with a colon\n# source: here\n# retrieved: 2026-11-21\n\
    # licence: none\n# changes: none\n# unit altitude_km: km\n# unit albedo: 1\naltitude_km,albedo\n0,0.5\n2.5,\n";

fn parse(text: &str) -> Result<Source<Sample>, RawError> {
    Source::parse("folder/file.csv", text.as_bytes())
}

/// Replaces `from`, which must occur, and gives the error's sentence.
fn sentence(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from:?} is not in the sample");
    parse(&GOOD.replacen(from, to, 1)).expect_err("a bad input was taken").to_string()
}

#[test]
fn a_good_file_is_read_and_converted() {
    let source = parse(GOOD).expect("good");
    assert_eq!(
        source.rows,
        [Sample { altitude_m: 0.0, albedo: Some(0.5) }, Sample { altitude_m: 2500.0, albedo: None }]
    );
    assert_eq!(source.provenance.citation, "a paper: with a colon");
    assert_eq!(source.provenance.file, "folder/file.csv");
}

#[test]
fn line_ends_of_other_systems_are_read() {
    assert_eq!(parse(&GOOD.replace('\n', "\r\n")).expect("good").rows, parse(GOOD).expect("good").rows);
}

#[test]
fn the_checksum_is_sha_256_of_the_whole_file() {
    // FIPS 180-2, appendix B.1: SHA-256 of "abc"; here through the digest that the reader uses.
    let hex: String = Sha256::digest(b"abc").iter().map(|byte| format!("{byte:02x}")).collect();
    assert_eq!(hex, "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
    let (a, b) = (parse(GOOD).expect("good"), parse(&GOOD.replace("here", "there")).expect("good"));
    assert_eq!(a.provenance.sha256.len(), 64);
    assert_ne!(a.provenance.sha256, b.provenance.sha256, "a change of the header changes the checksum");
}

#[test]
fn each_fault_is_named_with_its_place() {
    let cases = [
        ("# licence: none\n", "", "folder/file.csv: expected a header line \"# licence: ...\", found none"),
        ("# licence: none\n", "# licence:\n", "folder/file.csv: expected a header line \"# licence: ...\", found none"),
        ("# retrieved: 2026-11-21\n", "", "folder/file.csv: expected a header line \"# retrieved: ...\", found none"),
        ("# source: here\n", "# source\n", "folder/file.csv, line 3: expected \"# key: value\", found \"source\""),
        (
            "altitude_km,albedo\n",
            "altitude_km,reflectance\n",
            "folder/file.csv, line 9, column \"albedo\": expected this name as column 2, found \"reflectance\"",
        ),
        (
            "altitude_km,albedo\n",
            "altitude_km\n",
            "folder/file.csv, line 9, column \"albedo\": expected this name as column 2, found \"\"",
        ),
        (
            "altitude_km,albedo\n",
            "altitude_km,albedo,extra\n",
            "folder/file.csv, line 9, column \"extra\": expected no further column",
        ),
        (
            "# unit altitude_km: km",
            "# unit altitude_km: m",
            "folder/file.csv, line 9, column \"altitude_km\": expected the unit \"km\", found \"m\"",
        ),
        ("# unit albedo: 1\n", "", "folder/file.csv, line 8, column \"albedo\": expected the unit \"1\", found \"\""),
        ("2.5,\n", "2.5\n", "folder/file.csv, line 11: malformed row: 1 fields where there are 2 columns"),
        ("2.5,\n", "2.5x,\n", "folder/file.csv, line 11, column \"altitude_km\": expected a number, found \"2.5x\""),
        ("2.5,\n", ",\n", "folder/file.csv, line 11, column \"altitude_km\": expected a number, found \"\""),
        (
            "2.5,\n",
            "NaN,\n",
            "folder/file.csv, line 11, column \"altitude_km\": expected a finite number, found \"NaN\"",
        ),
        ("0,0.5", "0,-0.5", "folder/file.csv, line 10, column \"albedo\": expected 0 to 1, found -0.5"),
        (
            "2.5,\n",
            "0.0,\n",
            "folder/file.csv, line 11, column \"altitude_km\": expected more than 0 of the row before, found 0.0",
        ),
        ("2.5,\n", "2500,\n", "folder/file.csv, line 11, column \"altitude_km\": expected 0 to 120 km, found 2500"),
        ("0,0.5\n2.5,\n", "", "folder/file.csv: expected at least one row, found none"),
        ("altitude_km,albedo\n0,0.5\n2.5,\n", "", "folder/file.csv: expected at least one row, found none"),
    ];
    for (from, to, expected) in cases {
        assert_eq!(sentence(from, to), expected, "with {to:?} for {from:?}");
    }
}

#[test]
fn bytes_that_are_no_text_are_refused() {
    let error = Source::<Sample>::parse("file.csv", b"# title: \xff\n").expect_err("not UTF-8");
    assert!(matches!(*error.fault, Fault::NotUtf8), "{error}");
}

#[test]
fn a_missing_file_is_named() {
    let error = Source::<Sample>::read(Path::new("no-such-folder"), "file.csv").expect_err("missing");
    assert!(matches!(*error.fault, Fault::Unreadable(_)), "{error}");
    assert!(error.to_string().starts_with("file.csv: cannot be read"), "{error}");
}

#[test]
fn the_number_of_rows_can_be_demanded() {
    assert!(parse(GOOD).expect("good").with_rows(2).is_ok());
    let error = parse(GOOD).expect("good").with_rows(3).expect_err("two rows");
    assert_eq!(error.to_string(), "folder/file.csv: expected 3 rows, found 2");
}

#[test]
fn keys_sort_the_rows_in_their_order() {
    #[derive(Debug)]
    struct Keyed;
    impl Row for Keyed {
        type Record = (String, f64, f64);
        fn columns() -> Vec<Column> {
            vec![
                Column::text("name").key(),
                Column::number("month", "1", 1.0, 12.0).key(),
                Column::number("altitude_km", "km", 0.0, 60.0).key(),
            ]
        }
        fn from_record(_: Self::Record) -> Self {
            Self
        }
    }
    let head = GOOD.split("# unit").next().expect("a beginning").to_owned()
        + "# unit name: text\n# unit month: 1\n# unit altitude_km: km\nname,month,altitude_km\n";
    let parse = |rows: &str| Source::<Keyed>::parse("k.csv", format!("{head}{rows}").as_bytes());
    assert_eq!(parse("a,1,0\na,1,1\na,2,0\nb,1,0\n").expect("sorted").rows.len(), 4);
    for (rows, column) in [("a,2,0\na,1,1\n", "month"), ("a,1,1\na,1,1\n", "altitude_km")] {
        let error = parse(rows).expect_err("not sorted");
        assert_eq!(error.column.as_deref(), Some(column), "{error}");
    }
}
