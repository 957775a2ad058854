//! What columns of people's files may be called, in which units, and what they become: every unit of an own input is
//! converted here and nowhere else.
//!
//! A column is called after its quantity and its unit, `altitude_km`. Case does not matter, nor what stands between
//! the words: `Altitude (km)`, `number density [cm^-3]` and `irradiance W/m²/nm` are understood as well.

use tables::units::KM;

/// Planck's constant times the speed of light, J m (SI 2019, exact).
const PLANCK_LIGHT: f64 = 6.626_070_15e-34 * 299_792_458.0;

/// What a column may hold.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Quantity {
    /// Geometric altitude, m.
    Altitude,
    /// Geopotential altitude, m'.
    GeopotentialAltitude,
    /// Pressure of air, Pa.
    Pressure,
    /// Temperature, K.
    Temperature,
    /// Number density of air, m^-3.
    AirDensity,
    /// Partial pressure of ozone, Pa.
    OzonePressure,
    /// Mixing ratio of ozone by volume, 1.
    OzoneMixingRatio,
    /// Number density of ozone, m^-3.
    OzoneDensity,
    /// Wavelength, nm.
    Wavelength,
    /// Spectral irradiance, W m^-2 nm^-1.
    Irradiance,
    /// Albedo, 1.
    Albedo,
    /// Real part of a refractive index, 1.
    RealIndex,
    /// Imaginary part of a refractive index, 1; k >= 0 absorbs.
    ImaginaryIndex,
    /// Radius of particles, m.
    Radius,
    /// Median radius of a mode, m.
    MedianRadius,
    /// Geometric standard deviation of a mode, 1.
    SigmaG,
    /// Smallest radius of a mode, m.
    SmallestRadius,
    /// Largest radius of a mode, m.
    LargestRadius,
    /// Number density of particles, m^-3.
    Particles,
    /// Share in the number of particles, 1.
    Share,
    /// Particles per unit of ln r, m^-3.
    PerLnRadius,
    /// Particles per radius, m^-4.
    PerRadius,
    /// Amount of aerosol relative to that at the ground, 1.
    Relative,
}

/// How the number of a file becomes ours.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Conversion {
    /// factor x + offset.
    Linear { factor: f64, offset: f64 },
    /// Photons to energy: factor x h c / wavelength.
    Photons { factor: f64 },
}

/// A unit that a column may be in.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Unit {
    /// How names of columns end, the usual one first; empty where the quantity has no unit.
    endings: &'static [&'static str],
    /// As it is written in a sentence.
    pub(super) symbol: &'static str,
    conversion: Conversion,
}

const fn unit(endings: &'static [&'static str], symbol: &'static str, factor: f64) -> Unit {
    Unit { endings, symbol, conversion: Conversion::Linear { factor, offset: 0.0 } }
}

const LENGTHS: &[Unit] =
    &[unit(&["m", "metres", "meters"], "m", 1.0), unit(&["km", "kilometres", "kilometers"], "km", KM)];
const PRESSURES: &[Unit] =
    &[unit(&["pa"], "Pa", 1.0), unit(&["hpa", "mbar", "mb"], "hPa", 100.0), unit(&["kpa"], "kPa", 1e3)];
const TEMPERATURES: &[Unit] = &[
    unit(&["k", "kelvin"], "K", 1.0),
    Unit {
        endings: &["c", "degc", "deg_c", "celsius"],
        symbol: "C",
        conversion: Conversion::Linear { factor: 1.0, offset: 273.15 },
    },
];
const DENSITIES: &[Unit] =
    &[unit(&["m3", "per_m3", "1_m3"], "m^-3", 1.0), unit(&["cm3", "per_cm3", "1_cm3"], "cm^-3", 1e6)];
const OZONE_PRESSURES: &[Unit] = &[unit(&["mpa"], "mPa", 1e-3), unit(&["nbar"], "nbar", 1e-4)];
const MIXING_RATIOS: &[Unit] = &[unit(&["ppmv", "ppm"], "ppmv", 1e-6), unit(&["ppbv", "ppb"], "ppbv", 1e-9)];
const WAVELENGTHS: &[Unit] =
    &[unit(&["nm"], "nm", 1.0), unit(&["um", "micron", "microns", "micrometres", "micrometers"], "um", 1e3)];
const IRRADIANCES: &[Unit] = &[
    unit(&["w_m2_nm", "w_m2_nm1"], "W m^-2 nm^-1", 1.0),
    unit(&["mw_m2_nm", "mw_m2_nm1"], "mW m^-2 nm^-1", 1e-3),
    unit(&["w_m2_um", "w_m2_um1"], "W m^-2 um^-1", 1e-3),
    Unit {
        endings: &["photons_s_m2_nm", "photons_s1_m2_nm1"],
        symbol: "photons s^-1 m^-2 nm^-1",
        conversion: Conversion::Photons { factor: 1.0 },
    },
    Unit {
        endings: &["photons_s_cm2_nm", "photons_s1_cm2_nm1"],
        symbol: "photons s^-1 cm^-2 nm^-1",
        conversion: Conversion::Photons { factor: 1e4 },
    },
];
const RATIOS: &[Unit] = &[unit(&["", "1"], "1", 1.0), unit(&["percent", "pct"], "percent", 1e-2)];
const NONE: &[Unit] = &[unit(&["", "1"], "1", 1.0)];
const RADII: &[Unit] = &[unit(&["um", "micron", "microns"], "um", 1e-6), unit(&["nm"], "nm", 1e-9)];
const DIAMETERS: &[Unit] = &[unit(&["um", "micron", "microns"], "um", 0.5e-6), unit(&["nm"], "nm", 0.5e-9)];
const PER_LOG10: &[Unit] = &[
    unit(&["cm3", "per_cm3"], "cm^-3", 1e6 / std::f64::consts::LN_10),
    unit(&["m3", "per_m3"], "m^-3", 1.0 / std::f64::consts::LN_10),
];
const PER_LN: &[Unit] = &[unit(&["cm3", "per_cm3"], "cm^-3", 1e6), unit(&["m3", "per_m3"], "m^-3", 1.0)];
const PER_RADIUS: &[Unit] = &[unit(&["cm3_um", "cm3_um1"], "cm^-3 um^-1", 1e12)];
const PER_DIAMETER: &[Unit] = &[unit(&["cm3_um", "cm3_um1"], "cm^-3 um^-1", 2e12)];

/// Words for a quantity with the units that go with them.
type Spelling = (&'static [&'static str], &'static [Unit]);

impl Quantity {
    /// In a sentence.
    pub(super) fn what(self) -> &'static str {
        match self {
            Self::Altitude => "altitude",
            Self::GeopotentialAltitude => "geopotential altitude",
            Self::Pressure => "pressure",
            Self::Temperature => "temperature",
            Self::AirDensity => "number density",
            Self::OzonePressure => "ozone partial pressure",
            Self::OzoneMixingRatio => "ozone mixing ratio",
            Self::OzoneDensity => "ozone number density",
            Self::Wavelength => "wavelength",
            Self::Irradiance => "irradiance",
            Self::Albedo => "albedo",
            Self::RealIndex => "real part of the refractive index",
            Self::ImaginaryIndex => "imaginary part of the refractive index",
            Self::Radius => "radius",
            Self::MedianRadius => "median radius",
            Self::SigmaG => "geometric standard deviation",
            Self::SmallestRadius => "smallest radius",
            Self::LargestRadius => "largest radius",
            Self::Particles => "number density",
            Self::Share => "share in the number",
            Self::PerLnRadius => "particles by logarithm of the radius",
            Self::PerRadius => "particles by radius",
            Self::Relative => "relative amount",
        }
    }

    /// The least and the most that is sensible, in our unit.
    fn range(self) -> (f64, f64) {
        match self {
            Self::Altitude | Self::GeopotentialAltitude => (0.0, 120e3),
            Self::Pressure => (1e-4, 110e3),
            Self::Temperature => (120.0, 1000.0),
            Self::AirDensity => (1e16, 4e25),
            Self::OzonePressure => (0.0, 0.1),
            Self::OzoneMixingRatio => (0.0, 1e-4),
            Self::OzoneDensity => (0.0, 1e20),
            Self::Wavelength => (100.0, 100e3),
            Self::Irradiance => (0.0, 10.0),
            Self::Albedo | Self::Share => (0.0, 1.0),
            Self::RealIndex => (0.2, 5.0),
            Self::ImaginaryIndex => (0.0, 10.0),
            Self::Radius | Self::MedianRadius | Self::SmallestRadius | Self::LargestRadius => (1e-10, 1e-3),
            Self::SigmaG => (1.01, 10.0),
            Self::Particles => (0.0, 1e13),
            Self::PerLnRadius => (0.0, 1e15),
            Self::PerRadius => (0.0, 1e24),
            Self::Relative => (0.0, 1e6),
        }
    }

    /// How columns of it are called, the usual way first.
    fn spellings(self) -> &'static [Spelling] {
        match self {
            Self::Altitude => {
                &[(&["altitude", "height", "alt", "geometric_altitude", "geometric_height", "z"], LENGTHS)]
            }
            Self::GeopotentialAltitude => {
                &[(&["geopotential_altitude", "geopotential_height", "gph", "gpheight"], LENGTHS)]
            }
            Self::Pressure => &[(&["pressure", "air_pressure", "pres", "p"], PRESSURES)],
            Self::Temperature => &[(&["temperature", "air_temperature", "temp", "t"], TEMPERATURES)],
            Self::AirDensity => &[(&["number_density", "air_number_density"], DENSITIES)],
            Self::OzonePressure => {
                &[(&["ozone_partial_pressure", "o3_partial_pressure", "o3partialpressure"], OZONE_PRESSURES)]
            }
            Self::OzoneMixingRatio => {
                &[(&["ozone_mixing_ratio", "o3_mixing_ratio", "ozone_vmr", "o3_vmr", "ozone", "o3"], MIXING_RATIOS)]
            }
            Self::OzoneDensity => {
                &[(&["ozone_number_density", "o3_number_density", "number_density", "ozone", "o3"], DENSITIES)]
            }
            Self::Wavelength => &[(&["wavelength", "lambda", "wl"], WAVELENGTHS)],
            Self::Irradiance => &[(&["irradiance", "spectral_irradiance", "solar_irradiance", "flux"], IRRADIANCES)],
            Self::Albedo => &[(&["albedo", "reflectance"], RATIOS)],
            Self::RealIndex => &[(&["n", "m_re", "real"], NONE)],
            Self::ImaginaryIndex => &[(&["k", "m_im", "imaginary"], NONE)],
            Self::Radius => &[(&["radius", "r"], RADII), (&["diameter", "d"], DIAMETERS)],
            Self::MedianRadius => {
                &[(&["median_radius", "r_mod", "mode_radius"], RADII), (&["median_diameter"], DIAMETERS)]
            }
            Self::SigmaG => &[(&["sigma_g", "sigma", "geometric_standard_deviation", "gsd"], NONE)],
            Self::SmallestRadius => &[(&["smallest_radius", "r_min", "radius_min"], RADII)],
            Self::LargestRadius => &[(&["largest_radius", "r_max", "radius_max"], RADII)],
            Self::Particles => &[(&["number_density", "number", "concentration"], DENSITIES)],
            Self::Share => &[(&["number_share", "share", "number_fraction"], RATIOS)],
            Self::PerLnRadius => {
                &[(&["dn_dlogr", "dn_dlog10r", "dn_dlogd", "dn_dlog10d"], PER_LOG10), (&["dn_dlnr", "dn_dlnd"], PER_LN)]
            }
            Self::PerRadius => &[(&["dn_dr"], PER_RADIUS), (&["dn_dd"], PER_DIAMETER)],
            Self::Relative => &[(&["relative", "extinction_relative", "relative_extinction"], RATIOS)],
        }
    }

    /// The names of its columns: the usual word with the usual ending of each unit.
    pub(super) fn usual_names(self) -> Vec<String> {
        let of = |(words, units): &Spelling| -> Vec<String> {
            units.iter().map(|unit| joined(words[0], unit.endings[0])).collect()
        };
        self.spellings().iter().flat_map(of).collect()
    }

    /// Every name that is understood, with its unit.
    fn names(self) -> impl Iterator<Item = (String, Unit)> {
        self.spellings().iter().flat_map(|(words, units)| {
            let pairs = words.iter().flat_map(|word| units.iter().map(move |unit| (*word, *unit)));
            pairs.flat_map(|(word, unit)| unit.endings.iter().map(move |ending| (joined(word, ending), unit)))
        })
    }

    /// The unit of a column of this quantity that is called `name` (normalised), if it is one.
    pub(super) fn unit_of(self, name: &str) -> Option<Unit> {
        self.names().find(|(known, _)| known == name).map(|(_, unit)| unit)
    }

    /// Whether `name` (normalised) says this quantity and no unit.
    pub(super) fn lacks_unit(self, name: &str) -> bool {
        self.spellings().iter().any(|(words, _)| words.contains(&name))
    }

    /// The names of a column of this quantity in every unit that go with the words of `name`, or the usual ones.
    pub(super) fn nearest<'a>(quantities: &[Self], name: &str, store: &'a mut Vec<String>) -> Option<&'a str> {
        store.clear();
        store.extend(quantities.iter().flat_map(|quantity| quantity.names().map(|(known, _)| known)));
        tables::nearest(name, store.iter().map(String::as_str))
    }
}

fn joined(word: &str, ending: &str) -> String {
    if ending.is_empty() { word.into() } else { format!("{word}_{ending}") }
}

impl Unit {
    /// A number of the file in our unit. `wavelength_nm` counts for photons only.
    pub(super) fn convert(self, value: f64, wavelength_nm: f64) -> f64 {
        match self.conversion {
            Conversion::Linear { factor, offset } => factor * value + offset,
            Conversion::Photons { factor } => factor * value * PLANCK_LIGHT / (wavelength_nm * 1e-9),
        }
    }

    /// The sensible range of a quantity in this unit; of photons at 1000 nm, where they are most.
    pub(super) fn range(self, quantity: Quantity) -> (f64, f64) {
        let back = |value: f64| {
            let exact = match self.conversion {
                Conversion::Linear { factor, offset } => (value - offset) / factor,
                Conversion::Photons { factor } => value * 1e-6 / (factor * PLANCK_LIGHT),
            };
            // As somebody would write it.
            format!("{exact:.6e}").parse().unwrap_or(exact)
        };
        let (low, high) = quantity.range();
        (back(low), back(high))
    }
}

/// A column's name with what stands between the words as one underline, in lower case.
pub(super) fn normalise(name: &str) -> String {
    let mut plain = String::with_capacity(name.len());
    let mut letters = name.trim().chars().peekable();
    while let Some(letter) = letters.next() {
        match letter {
            'µ' | 'μ' => plain.push('u'),
            '²' => plain.push('2'),
            '³' => plain.push('3'),
            '%' => plain.push_str("_percent"),
            '°' | '^' | '⁻' => {}
            '-' if letters.peek().is_some_and(char::is_ascii_digit) => {}
            letter if letter.is_ascii_alphanumeric() => plain.push(letter.to_ascii_lowercase()),
            _ if plain.ends_with('_') => {}
            _ => plain.push('_'),
        }
    }
    plain.replace("__", "_").trim_matches('_').into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_understood_in_the_usual_variants() {
        for (name, plain) in [
            ("Altitude [m]", "altitude_m"),
            ("number_density_cm-3", "number_density_cm3"),
            ("dN/dlogr (cm^-3)", "dn_dlogr_cm3"),
            ("Irradiance W m-2 nm-1", "irradiance_w_m2_nm1"),
            ("flux_W/m²/µm", "flux_w_m2_um"),
            ("Temperature (°C)", "temperature_c"),
            ("albedo %", "albedo_percent"),
        ] {
            assert_eq!(normalise(name), plain);
        }
    }

    #[test]
    fn every_unit_becomes_ours() {
        let convert = |quantity: Quantity, name: &str, value: f64| {
            quantity.unit_of(name).expect("a known name").convert(value, 500.0)
        };
        // Each is exact in binary or one rounding.
        for (quantity, name, value, expected) in [
            (Quantity::Altitude, "height_km", 2.5, 2500.0),
            (Quantity::Pressure, "pressure_mbar", 500.0, 50_000.0),
            (Quantity::Temperature, "temp_c", -73.15, 200.0),
            (Quantity::AirDensity, "number_density_cm3", 2e19, 2e25),
            (Quantity::OzonePressure, "ozone_partial_pressure_mpa", 15.0, 0.015),
            (Quantity::OzoneMixingRatio, "ozone_ppbv", 40.0, 40e-9),
            (Quantity::Wavelength, "wavelength_um", 0.55, 550.0),
            (Quantity::Irradiance, "irradiance_w_m2_um", 1850.0, 1.85),
            (Quantity::Irradiance, "irradiance_mw_m2_nm", 1850.0, 1.85),
            // h c = 1.986445857e-25 J m (CODATA 2018).
            (Quantity::Irradiance, "irradiance_photons_s_cm2_nm", 1e14, 1.986_445_857e-25 / 500e-9 * 1e18),
            (Quantity::Albedo, "albedo_percent", 20.0, 0.2),
            (Quantity::Radius, "diameter_nm", 200.0, 1e-7),
            (Quantity::PerLnRadius, "dn_dlogd_cm3", 10.0_f64.ln(), 1e6),
            (Quantity::PerRadius, "dn_dd_cm3_um", 1.0, 2e12),
        ] {
            let found = convert(quantity, name, value);
            assert!((found / expected - 1.0).abs() < 1e-9, "{name}: {found} for {expected}");
        }
    }

    #[test]
    fn ranges_are_given_in_the_unit_of_the_file() {
        let unit = Quantity::Temperature.unit_of("temperature_c").expect("known");
        assert_eq!(unit.range(Quantity::Temperature), (-153.15, 726.85));
    }
}
