//! Small tables for unit tests, so that they need no files.

use tables::views::{Observer, OzoneCrossSection, Sun};
use tables::{Axis, Field, Kind, Outside, Precision, Scale, Table, Tolerance};

fn table(kind: Kind, axes: Vec<Axis>, fields: Vec<(&str, &str, &[&str], Vec<f64>)>) -> Table {
    let fields = fields
        .into_iter()
        .map(|(name, unit, axes, values)| Field {
            name: name.into(),
            unit: unit.into(),
            axes: axes.iter().map(|&a| a.into()).collect(),
            precision: Precision::F64,
            scale: Scale::Linear,
            tolerance: Tolerance { relative: 0.0, absolute: 0.0 },
            interpolation_error: None,
            values,
        })
        .collect();
    Table { kind, title: "test".into(), axes, fields, settings: [].into(), provenance: Vec::new() }
}

/// A sun of 1 W m^-2 nm^-1 with I(mu) = 0.4 + 0.6 mu, and an observer whose three functions are
/// one triangle about 550 nm, and ozone that absorbs nothing.
pub(crate) fn light() -> (Sun, Observer, OzoneCrossSection) {
    let axis = |name: &str, unit: &str, nodes: &[f64]| {
        Axis::new(name, unit, nodes.to_vec()).expect("valid").beyond(Outside::Hold)
    };
    let sun = table(
        Kind::Sun,
        vec![
            axis("wavelength", "nm", &[200.0, 2000.0]),
            axis("limb_wavelength", "nm", &[300.0, 1000.0]),
            axis("power", "1", &[0.0, 1.0]),
        ],
        vec![
            ("irradiance", "W m^-2 nm^-1", &["wavelength"], vec![1.0; 2]),
            ("limb_darkening", "1", &["limb_wavelength", "power"], vec![0.4, 0.6, 0.4, 0.6]),
        ],
    );
    let observer = table(
        Kind::Observer,
        vec![axis("wavelength", "nm", &[400.0, 550.0, 700.0])],
        ["x_bar", "y_bar", "z_bar"].map(|name| (name, "1", &["wavelength"] as &[&str], vec![0.0, 1.0, 0.0])).to_vec(),
    );
    let ozone = table(
        Kind::OzoneCrossSection,
        vec![axis("wavelength", "nm", &[200.0, 2000.0])],
        vec![
            ("sigma_0", "m^2", &["wavelength"], vec![0.0; 2]),
            ("sigma_1", "m^2 K^-1", &["wavelength"], vec![0.0; 2]),
            ("sigma_2", "m^2 K^-2", &["wavelength"], vec![0.0; 2]),
            ("reference_temperature", "K", &[], vec![240.0]),
        ],
    );
    (
        Sun::from_table(&sun).expect("a sun"),
        Observer::from_table(&observer).expect("an observer"),
        OzoneCrossSection::from_table(&ozone).expect("a cross-section"),
    )
}
