use super::*;
use std::collections::BTreeMap;
use tables::{Kind, Precision, Provenance, Scale, Tolerance};

fn sample() -> Table {
    let provenance = Provenance {
        file: "a/b.csv".into(),
        title: "t".into(),
        citation: "c".into(),
        source: "s".into(),
        licence: "l".into(),
        sha256: "00".into(),
    };
    let field = Field {
        name: "number_density".into(),
        unit: "m^-3".into(),
        axes: vec!["month".into(), "altitude".into()],
        precision: Precision::F64,
        scale: Scale::Linear,
        tolerance: Tolerance { relative: 1e-6, absolute: 0.0 },
        interpolation_error: Some(1e-3),
        values: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0],
    };
    Table {
        kind: Kind::OzoneLayers,
        title: "sample".into(),
        axes: vec![
            Axis::new("month", "1", vec![1.0, 2.0]).expect("valid"),
            Axis::new("altitude", "m", vec![0.0, 9e3, 18e3]).expect("valid"),
        ],
        fields: vec![field],
        settings: BTreeMap::from([("a".into(), "b".into())]),
        provenance: vec![provenance],
    }
}

/// The sentences of what differs after `change`.
fn after(change: impl Fn(&mut Table)) -> Vec<String> {
    let mut found = sample();
    change(&mut found);
    differences(&sample(), &found).iter().map(ToString::to_string).collect()
}

#[test]
fn a_table_does_not_differ_from_itself_or_within_its_tolerance() {
    assert!(after(|_| ()).is_empty());
    assert!(after(|t| t.fields[0].values[3] *= 1.0 + 0.9e-6).is_empty());
    assert!(after(|t| t.fields[0].interpolation_error = Some(1.05e-3)).is_empty());
}

#[test]
fn a_value_beyond_its_tolerance_is_placed() {
    let found = after(|t| {
        t.fields[0].values[0] *= 1.0 + 2e-6;
        t.fields[0].values[4] *= 1.01;
    });
    assert_eq!(
        found,
        ["number_density: 2 of 6 values beyond their tolerance, most at month 2, altitude 9000 m: \
          5e0 rebuilt, 5.05e0 found (relative 1.0e-2)"]
    );
}

#[test]
fn every_part_of_the_header_counts() {
    assert_eq!(after(|t| t.title = "other".into()), ["title: \"sample\" rebuilt, \"other\" found"]);
    let changed = after(|t| drop(t.settings.insert("a".into(), "c".into())));
    assert_eq!(changed, ["setting \"a\": \"b\" rebuilt, \"c\" found"]);
    let added = after(|t| drop(t.settings.insert("z".into(), "c".into())));
    assert_eq!(added, ["setting \"z\": none rebuilt, \"c\" found"]);
    assert_eq!(after(|t| t.provenance[0].sha256 = "ff".into()), ["SHA-256 of a/b.csv: 00 rebuilt, ff found"]);
    assert_eq!(after(|t| t.provenance[0].licence = "x".into()).len(), 1);
    assert_eq!(after(|t| t.provenance.clear()), ["inputs: a/b.csv rebuilt,  found"]);
    assert_eq!(after(|t| t.fields[0].unit = "DU".into()).len(), 1);
    assert_eq!(after(|t| t.axes[1].nodes[1] = 9001.0), ["node of axis \"altitude\": 9000 rebuilt, 9001 found"]);
    assert_eq!(after(|t| t.fields[0].interpolation_error = None).len(), 1);
    assert_eq!(after(|t| t.fields.clear()).len(), 1);
}
