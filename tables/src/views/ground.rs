//! What the ground reflects.

use super::bounded;
use crate::{Curve, Kind, Table, TableError};
use std::collections::BTreeMap;

/// Albedo spectra by the name of the ground.
#[derive(Debug, Clone)]
pub struct GroundAlbedo {
    /// Lambertian albedo (0 to 1) against wavelength in nm, by name.
    pub spectra: BTreeMap<String, Curve>,
}

impl GroundAlbedo {
    /// Every field is a spectrum in unit 1, named as its ground, over an axis
    /// of its own in nm.
    ///
    /// # Errors
    /// [`TableError`] if the table is of another kind or a value is outside 0..=1.
    pub fn from_table(table: &Table) -> Result<Self, TableError> {
        table.expect_kind(Kind::GroundAlbedo)?;
        let (mut spectra, mut axes) = (BTreeMap::new(), BTreeMap::new());
        for field in &table.fields {
            let [axis] = field.axes.as_slice() else {
                return Err(TableError::Inconsistent(format!("field {:?} must be over one axis", field.name)));
            };
            let curve = table.curve_sharing(&field.name, "1", (axis, "nm"), &mut axes)?;
            spectra.insert(field.name.clone(), bounded(curve, &field.name, 0.0, 1.0)?);
        }
        Ok(Self { spectra })
    }
}
