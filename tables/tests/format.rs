//! The format: what is written is read, and nothing else is.

use std::collections::BTreeMap;
use tables::{
    Axis, Field, Interpolation, Kind, Outside, Precision, Provenance, Scale, Table, TableError, Tolerance, file,
};

/// A table with every feature: two axes, both precisions, a field without axes.
fn sample() -> Table {
    let field = |name: &str, axes: &[&str], precision, values: Vec<f64>| Field {
        name: name.into(),
        unit: "m^2".into(),
        axes: axes.iter().map(|a| (*a).to_string()).collect(),
        precision,
        scale: Scale::Linear,
        tolerance: Tolerance { relative: 1e-12, absolute: 0.0 },
        interpolation_error: Some(1e-4),
        values,
    };
    Table {
        kind: Kind::OzoneCrossSection,
        title: "A table for tests: é".into(),
        axes: vec![
            Axis::new("wavelength", "nm", vec![300.0, 301.5, 310.0]).expect("valid"),
            Axis::uniform("month", "1", 1.0, 1.0, 2).expect("valid").between(Interpolation::Node).beyond(Outside::Hold),
        ],
        fields: vec![
            field("a", &["wavelength"], Precision::F64, vec![1.0 / 3.0, -0.0, 1e-300]),
            field("b", &["month", "wavelength"], Precision::F32, vec![1.0, 2.0, 3.0, 4.5, -5.0, 6.0]),
            field("c", &[], Precision::F64, vec![243.0]),
        ],
        settings: BTreeMap::from([("reference".into(), "243 K".into())]),
        provenance: vec![Provenance {
            file: "x/y.csv".into(),
            title: "t".into(),
            citation: "c".into(),
            source: "s".into(),
            licence: "l".into(),
            sha256: "00".into(),
        }],
    }
}

fn bytes() -> Vec<u8> {
    file::encode(&sample()).expect("valid")
}

fn header_length(bytes: &[u8]) -> usize {
    u32::from_le_bytes(bytes[12..16].try_into().expect("four")) as usize
}

/// The same file with its header edited and lengths and checksums made right.
fn with_header(edit: impl Fn(&str) -> String) -> Vec<u8> {
    let bytes = bytes();
    let length = header_length(&bytes);
    let header = edit(std::str::from_utf8(&bytes[32..32 + length]).expect("UTF-8"));
    let mut new = bytes[..12].to_vec();
    new.extend_from_slice(&(header.len() as u32).to_le_bytes());
    new.extend_from_slice(&bytes[16..24]);
    new.extend_from_slice(&crc32fast::hash(header.as_bytes()).to_le_bytes());
    new.extend_from_slice(&bytes[28..32]);
    new.extend_from_slice(header.as_bytes());
    new.extend_from_slice(&bytes[32 + length..]);
    new
}

#[test]
fn a_table_comes_back_as_it_was() {
    assert_eq!(file::decode(&bytes()).expect("readable"), sample());
}

#[test]
fn equal_tables_give_equal_bytes() {
    assert_eq!(bytes(), bytes());
}

#[test]
fn single_precision_rounds_to_nearest() {
    let mut table = sample();
    table.fields[1].values[0] = 0.1;
    let back = file::decode(&file::encode(&table).expect("valid")).expect("readable");
    assert_eq!(back.fields[1].values[0], f64::from(0.1_f32));
}

#[test]
fn every_truncation_is_called_truncated() {
    let bytes = bytes();
    for length in 1..bytes.len() {
        let error = file::decode(&bytes[..length]).expect_err("half a table was read");
        assert!(matches!(error, TableError::Truncated { .. }), "{length} bytes: {error}");
    }
    assert!(matches!(file::decode(&[]), Err(TableError::Foreign)));
}

#[test]
fn every_flipped_bit_is_noticed() {
    let bytes = bytes();
    for at in 0..bytes.len() {
        for bit in 0..8 {
            let mut damaged = bytes.clone();
            damaged[at] ^= 1 << bit;
            assert!(file::decode(&damaged).is_err(), "bit {bit} of byte {at} changed and was not noticed");
        }
    }
}

#[test]
fn each_kind_of_wrong_file_is_named() {
    let bytes = bytes();
    let mut newer = bytes.clone();
    newer[8] = 2;
    assert!(matches!(file::decode(&newer), Err(TableError::Newer { found: 2, supported: 1 })));
    let mut longer = bytes.clone();
    longer.extend_from_slice(&[0; 3]);
    assert!(matches!(file::decode(&longer), Err(TableError::Trailing { extra: 3 })));
    assert!(matches!(file::decode(b"\x89PNG\r\n\x1a\n and more"), Err(TableError::Foreign)));
    let text_mode: Vec<u8> = bytes.iter().copied().filter(|&b| b != b'\r').collect();
    assert!(matches!(file::decode(&text_mode), Err(TableError::TextMode)));
    let mut header = bytes.clone();
    header[40] ^= 1;
    assert!(matches!(file::decode(&header), Err(TableError::Damaged { part: "header", .. })));
    let mut payload = bytes;
    let last = payload.len() - 1;
    payload[last] ^= 1;
    assert!(matches!(file::decode(&payload), Err(TableError::Damaged { part: "payload", .. })));
}

#[test]
fn a_header_that_lies_is_refused_without_trusting_it() {
    let lies: [(&str, &str); 8] = [
        ("\"length\":3", "\"length\":4611686018427387904"),
        ("\"length\":3", "\"length\":0"),
        ("\"offset\":0", "\"offset\":18446744073709551615"),
        ("\"kind\":\"ozone-cross-section\"", "\"kind\":\"cheese\""),
        ("\"axes\":[\"wavelength\"]", "\"axes\":[\"wavelength\",\"wavelength\",\"wavelength\",\"wavelength\"]"),
        ("\"axes\":[\"wavelength\"]", "\"axes\":[\"nowhere\"]"),
        ("\"name\":\"b\"", "\"name\":\"a\""),
        ("\"title\"", "\"tattle\""),
    ];
    for (from, to) in lies {
        let bytes = with_header(|text| {
            assert!(text.contains(from), "the header has no {from}");
            text.replacen(from, to, 1)
        });
        let error = file::decode(&bytes).expect_err("a lie was believed");
        assert!(
            matches!(error, TableError::Header(_) | TableError::Inconsistent(_) | TableError::Missing { .. }),
            "{to}: {error}"
        );
    }
}

#[test]
fn every_rule_comes_back_and_an_unknown_one_is_refused() {
    for (rule, name) in [
        (Interpolation::Linear, "linear"),
        (Interpolation::Parabolic, "parabolic"),
        (Interpolation::Cubic, "cubic"),
        (Interpolation::Step, "step"),
        (Interpolation::Node, "node"),
    ] {
        let mut table = sample();
        table.axes[0].interpolation = rule;
        assert_eq!(file::decode(&file::encode(&table).expect("valid")).expect("sound"), table);
        let renamed = with_header(|text| text.replacen("\"linear\"", &format!("\"{name}\""), 1));
        assert_eq!(file::decode(&renamed).expect("a rule").axes[0].interpolation, rule);
    }
    let error = file::decode(&with_header(|text| text.replacen("\"linear\"", "\"quintic\"", 1))).expect_err("no rule");
    assert!(matches!(&error, TableError::Header(text) if text.contains("quintic")), "{error}");
}

#[test]
fn values_that_are_not_finite_are_neither_written_nor_read() {
    let mut table = sample();
    table.fields[0].values[1] = f64::NAN;
    assert!(matches!(file::encode(&table), Err(TableError::Inconsistent(_))));
    let mut bytes = bytes();
    let payload = 32 + header_length(&bytes);
    bytes[payload..payload + 8].copy_from_slice(&f64::INFINITY.to_le_bytes());
    let crc = crc32fast::hash(&bytes[payload..]);
    bytes[28..32].copy_from_slice(&crc.to_le_bytes());
    assert!(matches!(file::decode(&bytes), Err(TableError::Inconsistent(_))));
}

#[test]
fn a_write_that_fails_leaves_the_old_file_and_no_litter() {
    let folder = std::env::temp_dir().join(format!("airlight-format-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("temporary folder");
    let path = folder.join("t.table");
    file::write(&path, &sample()).expect("written");
    let before = std::fs::read(&path).expect("there");
    let mut bad = sample();
    bad.fields[0].values.pop();
    assert!(file::write(&path, &bad).is_err());
    // A folder in the way of the final name makes the rename fail.
    let blocked = folder.join("blocked");
    std::fs::create_dir_all(blocked.join("inside")).expect("folder");
    assert!(matches!(file::write(&blocked, &sample()), Err(TableError::Write { .. })));
    assert_eq!(std::fs::read(&path).expect("still there"), before);
    let names: Vec<_> = std::fs::read_dir(&folder).expect("listed").map(|e| e.expect("entry").file_name()).collect();
    assert_eq!(names.len(), 2, "litter: {names:?}");
    std::fs::remove_dir_all(&folder).expect("removed");
}

#[test]
fn errors_name_the_file() {
    let error = file::read(std::path::Path::new("no/such.table")).expect_err("absent");
    assert!(error.to_string().contains("such.table"), "{error}");
}

#[test]
fn axes_that_share_their_bytes_and_headers_beyond_the_limit_are_refused() {
    // Each node list alone fits; together they are longer than the payload.
    let axis = r#"{"name":"NAME","unit":"1","length":17,"spacing":"irregular","interpolation":"linear","outside":"error","offset":0},"#;
    let bytes = with_header(|text| {
        let many: String = (0..20).map(|i| axis.replace("NAME", &format!("n{i}"))).collect();
        text.replacen("\"axes\":[", &format!("\"axes\":[{many}"), 1)
    });
    let error = file::decode(&bytes).expect_err("the same bytes were read twenty times").to_string();
    assert!(error.contains("does not fit in the payload"), "{error}");

    let long = with_header(|text| text.to_owned() + &" ".repeat(file::MAX_HEADER));
    let error = file::decode(&long).expect_err("a long header was read").to_string();
    assert!(error.contains("65536 are possible"), "{error}");
    let mut table = sample();
    table.title = "x".repeat(file::MAX_HEADER);
    assert!(matches!(file::encode(&table), Err(TableError::Header(_))), "a long header was written");
}

#[test]
fn a_name_that_is_no_name_is_quoted_in_part() {
    let name = "n".repeat(60_000);
    let bytes = with_header(|text| text.replacen("\"name\":\"b\"", &format!("\"name\":\"{name}\""), 1));
    let error = file::decode(&bytes).expect_err("a name of 60 kB was taken").to_string();
    assert!(error.len() < 1000, "an error of {} bytes", error.len());
}
