//! The few constants and unit factors that both sides of a table need.

/// Molecules per square metre in one Dobson unit: a 1e-5 m layer of ideal gas
/// at 273.15 K and 1013.25 hPa, so 1e-5 m times the Loschmidt constant
/// 2.6867805e25 m^-3 (CODATA 2002; the 2018 value differs by 1e-7 relative).
pub const DOBSON_UNIT_M2: f64 = 2.686_780_5e20;

/// Luminous efficacy of monochromatic radiation at 540 THz, K_cd = 683 lm/W (SI).
pub const LUMINOUS_EFFICACY_LM_W: f64 = 683.0;

/// Mean radius of the Earth in metres, Airlight's default planet.
pub const EARTH_RADIUS_M: f64 = 6_371_000.0;

/// Metres in a kilometre.
pub const KM: f64 = 1000.0;

/// The lowest and highest wavelength in nm for which `data/` holds tables:
/// refractive indices of aerosols begin at 250 nm, the King factor ends at 1000 nm.
pub const WAVELENGTH_RANGE_NM: (f64, f64) = (300.0, 1000.0);

/// The highest altitude in metres for which `data/` holds tables.
pub const TOP_ALTITUDE_M: f64 = 120_000.0;
