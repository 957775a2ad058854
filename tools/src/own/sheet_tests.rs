use super::*;

const SCHEMA: Schema = Schema {
    quantities: &[Quantity::Altitude, Quantity::Temperature, Quantity::ImaginaryIndex],
    words: Some("material"),
    sorted_by: &[(Quantity::Altitude, Order::Up)],
    remedy: "sort them",
    most_rows: 5,
};

fn parse(text: &str) -> Result<Sheet, RawError> {
    Sheet::parse("folder/my own.csv", text.as_bytes(), &["wind".into()], &SCHEMA)
}

fn sentence(text: &str) -> String {
    parse(text).expect_err("a bad input was taken").to_string()
}

#[test]
fn a_plain_file_is_read_and_converted() {
    let sheet = parse("Altitude (km),Temperature [°C],material\n0.5,-23.15,\"soot\"\n2,-73.15,ash\n").expect("good");
    assert_eq!(sheet.column(Quantity::Altitude), Some(&[500.0, 2000.0][..]));
    let temperatures = sheet.column(Quantity::Temperature).expect("a column");
    // One rounding.
    assert!(temperatures.iter().zip([250.0, 200.0]).all(|(a, b)| (a - b).abs() < 1e-13), "{temperatures:?}");
    assert_eq!((sheet.words(), sheet.rows(), sheet.line(1)), (&["soot".to_owned(), "ash".into()][..], 2, 3));
    let Provenance { file, title, citation, source, sha256, .. } = sheet.provenance;
    assert_eq!((file.as_str(), title.as_str()), ("my own.csv", "my own.csv"));
    assert_eq!((citation.as_str(), source.as_str(), sha256.len()), ("own input", "own input", 64));
}

#[test]
fn other_spreadsheets_and_remarks_are_read() {
    let plain = parse("altitude_m;temperature_k\n0;280\n10;279\n").expect("good");
    let text = "\u{feff}# title: my sonde\r\n# a remark\r\n\"altitude_m\"\t\"temperature_k\"\twind\r\n0\t280\tcalm\r\n\r\n# more\r\n10\t279\t\r\n";
    let other = parse(text).expect("good");
    assert_eq!(plain.columns, other.columns);
    assert_eq!((other.provenance.title.as_str(), other.line(1)), ("my sonde", 7));
}

#[test]
fn each_fault_is_named_with_its_place() {
    let known = "altitude_m, altitude_km, temperature_k, temperature_c, k, material";
    for (text, expected) in [
        ("", "my own.csv: expected at least one row, found none".to_owned()),
        ("altitude_m,temperature_k\n", "my own.csv: expected at least one row, found none".into()),
        (
            "altitude,temperature_k\n",
            format!(
                "my own.csv, line 1, column \"altitude\": expected one of {known}, or that it is left out (--ignore); \
                 name the unit of this one: altitude_m or altitude_km"
            ),
        ),
        (
            "# x\naltitude_m,tempersture_k\n",
            format!(
                "my own.csv, line 2, column \"tempersture_k\": expected one of {known}, or that it is left out \
                 (--ignore); did you mean temperature_k?"
            ),
        ),
        (
            "altitude_m,humidity\n",
            format!("my own.csv, line 1, column \"humidity\": expected one of {known}, or that it is left out (--ignore)"),
        ),
        (
            "altitude_m,height_km\n",
            "my own.csv, line 1, column \"height_km\": expected one column of altitude, found \"altitude_m\" and this \
             (leave one out)"
                .into(),
        ),
        (
            "altitude_m,temperature_k\n0,x\n",
            "my own.csv, line 2, column \"temperature_k\": expected a number, found \"x\"".into(),
        ),
        (
            "altitude_m,temperature_k\n0,\n",
            "my own.csv, line 2, column \"temperature_k\": expected a number, found \"\"".into(),
        ),
        (
            "altitude_m,temperature_k\n0,inf\n",
            "my own.csv, line 2, column \"temperature_k\": expected a finite number, found \"inf\"".into(),
        ),
        (
            "altitude_m,temperature_c\n0,280\n1,1280\n",
            "my own.csv, line 3, column \"temperature_c\": expected -153.15 to 726.85 C, found 1280".into(),
        ),
        (
            "altitude_m,temperature_k\n0,280\n5,280\n5,279\n",
            "my own.csv, line 4, column \"altitude_m\": expected more than in line 3, found 5: sort them".into(),
        ),
        (
            "altitude_m,temperature_k\n0\n",
            "my own.csv, line 2: malformed row: 1 fields where there are 2 columns".into(),
        ),
        ("altitude_m\n0\n1\n2\n3\n4\n5\n", "my own.csv, line 7: malformed row: it is one more than 5 rows".into()),
        (
            "altitude_m,k\n0,-0.01\n",
            "my own.csv, line 2, column \"k\": expected k >= 0: m = n + ik, k absorbs; change the sign of n - ik, found \
             -0.01"
                .into(),
        ),
    ] {
        assert_eq!(sentence(text), expected);
    }
    let error = Sheet::parse("a.csv", b"altitude_m\n\xff\n", &[], &SCHEMA).expect_err("not UTF-8").to_string();
    assert_eq!(error, "a.csv: expected UTF-8 text, found other bytes");
}

#[test]
fn a_long_line_or_field_is_refused_in_a_short_sentence() {
    let long = "9".repeat(LONGEST_LINE + 1);
    assert_eq!(sentence(&long), "my own.csv, line 1: expected lines of at most 16384 bytes, found one of 16385");
    let number = sentence(&format!("altitude_m\n{}\n", &long[..10_000]));
    assert!(number.contains("expected a number") && number.len() < 200, "{number}");
    // A name is quoted by its 450 first and 101 last characters; what is expected takes less than 200.
    let name = sentence(&format!("{}\n", "x".repeat(10_000)));
    assert!(name.contains("(10002 bytes)") && name.len() < 800, "{name}");
}

#[test]
fn a_column_that_is_needed_is_named_with_its_units() {
    let sheet = parse("altitude_m\n0\n").expect("good");
    let error = sheet.one_of(&[Quantity::Temperature]).expect_err("none").to_string();
    assert_eq!(error, "my own.csv: expected one column of temperature (temperature_k, temperature_c), found none");
}
