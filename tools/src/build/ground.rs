//! The table of grounds: albedo as published, on its own nodes.

use super::air::texts;
use super::field;
use crate::raw::RawData;
use crate::raw::ground_albedo::Albedo;
use tables::{Axis, Field, Kind, Outside, Table, TableError};

/// One field and one axis in nm for each ground: `dry-soil`, `wet-soil`, `ocean`.
pub(super) fn albedo(raw: &RawData) -> Result<Table, TableError> {
    let source = &raw.ground_albedo.spectra;
    let spectrum = |name: &str, value: fn(&Albedo) -> Option<f64>| -> Result<(Axis, Field), TableError> {
        let (wavelengths, values): (Vec<f64>, Vec<f64>) =
            source.rows.iter().filter_map(|row| Some((row.wavelength_nm, value(row)?))).unzip();
        let axis_name = format!("{name} wavelength");
        let axis = Axis::new(&axis_name, "nm", wavelengths)?.beyond(Outside::Hold);
        // Published to 4 decimals.
        Ok((axis, field(name, "1", &[&axis_name], 1e-4, values)))
    };
    let (axes, fields) = [
        spectrum("dry-soil", |row| row.dry_soil)?,
        spectrum("wet-soil", |row| row.wet_soil)?,
        spectrum("ocean", |row| Some(row.ocean))?,
    ]
    .into_iter()
    .unzip();
    let settings = [
        ("ocean", "reflection at a flat surface under diffuse light; no light from under water"),
        ("soils below 400 nm", "no data: the albedo at 400 nm holds"),
    ];
    Ok(Table {
        kind: Kind::GroundAlbedo,
        title: "Spectral albedo of grounds".into(),
        axes,
        fields,
        settings: texts(&settings),
        provenance: vec![source.provenance.clone()],
    })
}
