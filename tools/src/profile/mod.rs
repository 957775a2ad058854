//! What there is of each substance at each altitude.

pub mod ozone;
pub mod standard_atmosphere;
