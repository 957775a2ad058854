//! How molecules scatter and absorb: refractive index and King factor of air, the
//! Rayleigh cross-section that follows, and the absorption of ozone by temperature.

pub mod king;
pub mod ozone;
pub mod rayleigh;
pub mod refractive_index;

use tables::TableError;

/// The error for a wavelength outside `low_nm..=high_nm`.
fn outside(wavelength_nm: f64, low_nm: f64, high_nm: f64) -> TableError {
    TableError::OutOfRange {
        axis: "wavelength".into(),
        value: wavelength_nm,
        low: low_nm,
        high: high_nm,
        unit: "nm".into(),
    }
}
