//! The atmosphere of the tables: molecules, ozone of a month and a place, an aerosol.

use super::{Component, Haze, Medium, MediumError};
use crate::data::Data;
use crate::geometry::{Place, Shape};
use crate::phase::Phase;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use tables::units::EARTH_RADIUS_M;
use tables::views::{OzoneCrossSection, OzoneProfile, REFERENCE_WAVELENGTH_NM, Rayleigh, StandardAtmosphere};
use tables::{Axis, Curve, Interpolation, Outside, Scale, TableError};

/// Which measured ozone profile is taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum OzoneSource {
    /// McPeters-Labow climatology, by month and latitude.
    McPetersLabow,
    /// Monthly columns of Arosa (47 N) in the layers of Ramanathan & Kulkarni,
    /// as the thesis used; the latitude is then ignored.
    Arosa,
}

/// How molecules scatter.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize, clap::ValueEnum, schemars::JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Depolarisation {
    /// With the depolarisation of air (King factor of Bucholtz 1995)
    #[default]
    Measured,
    /// As spheres do: the phase function 3/(16 pi) (1 + cos^2), and cross-sections over the King factor
    None,
}

/// What chooses the molecular atmosphere.
#[derive(Debug, Clone, PartialEq)]
pub struct AirSettings {
    /// Month, 1 to 12.
    pub month: u8,
    /// Latitude in degrees, north positive, -90 to 90.
    pub latitude_deg: f64,
    /// Source of the ozone profile.
    pub ozone_source: OzoneSource,
    /// Vertical ozone column in Dobson units that the profile is scaled to;
    /// `None` leaves the source's own.
    pub ozone_du: Option<f64>,
    /// Top of the atmosphere in m.
    pub top_m: f64,
    /// How molecules scatter.
    pub depolarisation: Depolarisation,
}

/// Why no atmosphere can be made.
#[derive(Debug, thiserror::Error)]
pub enum AirError {
    /// A month, latitude, wavelength or altitude that the tables do not have.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Coefficients that make no medium.
    #[error(transparent)]
    Medium(#[from] MediumError),
    /// A source without ozone cannot be scaled to a column.
    #[error("the ozone profile of this source is empty and cannot be scaled to {0} DU")]
    NoOzone(f64),
    /// A humidity for an aerosol whose table has only one.
    #[error("humidity is {percent} %, but {aerosol} does not take up water: leave it out")]
    Dry {
        /// Where the aerosol comes from.
        aerosol: String,
        /// What was asked.
        percent: f64,
    },
    /// A visibility beyond that of clean air.
    #[error("visibility is {asked_km} km, but molecules alone allow no more than {clean_km:.0} km")]
    TooClear {
        /// What was asked.
        asked_km: f64,
        /// Visibility of molecules alone.
        clean_km: f64,
    },
}

/// Vertical optical depths (1) between the ground and the top of a scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Depths {
    /// Of scattering by molecules.
    pub molecules: f64,
    /// Of absorption by ozone.
    pub ozone: f64,
    /// Of scattering and absorption by aerosol.
    pub aerosol: f64,
}

/// Molecules and ozone against altitude, before any wavelength is chosen.
#[derive(Debug, Clone)]
pub struct Air {
    density: Curve,
    /// Ozone density times (T - T_0)^k for k = 0, 1, 2.
    ozone: [Curve; 3],
    ozone_du: f64,
    top_m: f64,
    depolarisation: Depolarisation,
    rayleigh: Rayleigh,
    cross_section: OzoneCrossSection,
    haze: Option<Haze>,
}

impl Air {
    /// Takes the month's ozone, scales it to the asked column, and multiplies
    /// it by powers of the air's temperature.
    ///
    /// The column that an asked amount refers to is the whole one: a lower top cuts it.
    ///
    /// # Errors
    /// [`AirError`] for a month, latitude or top that the tables do not reach.
    pub fn new(data: &Data, settings: &AirSettings) -> Result<Self, AirError> {
        let density = data.standard_atmosphere.number_density_m3.clone();
        // Asks the table itself whether it reaches so high.
        density.at(settings.top_m)?;
        let OzoneProfile { number_density_m3, column_du } = match settings.ozone_source {
            OzoneSource::McPetersLabow => data.ozone_profiles.profile(settings.month, settings.latitude_deg)?,
            OzoneSource::Arosa => data.ozone_layers.profile(settings.month)?,
        };
        let (scale, ozone_du) = match settings.ozone_du {
            None => (1.0, column_du),
            Some(asked) if column_du > 0.0 => (asked / column_du, asked),
            Some(asked) => return Err(AirError::NoOzone(asked)),
        };
        let ozone = ozone_terms(&data.standard_atmosphere, &data.ozone_cross_section, &number_density_m3, scale)?;
        Ok(Self {
            density,
            ozone,
            ozone_du,
            top_m: settings.top_m,
            depolarisation: settings.depolarisation,
            rayleigh: data.rayleigh.clone(),
            cross_section: data.ozone_cross_section.clone(),
            haze: None,
        })
    }

    /// The same air with an aerosol in it.
    #[must_use]
    pub fn with_haze(self, haze: Option<Haze>) -> Self {
        Self { haze, ..self }
    }

    /// Its aerosol.
    #[must_use]
    pub fn haze(&self) -> Option<&Haze> {
        self.haze.as_ref()
    }

    /// Extinction coefficient of the molecules at the ground at 550 nm in m^-1.
    ///
    /// # Errors
    /// [`AirError::Table`] if the tables do not reach there.
    pub fn ground_extinction(&self) -> Result<f64, AirError> {
        Ok(self.density.at(0.0)? * self.rayleigh.cross_section_m2.at(REFERENCE_WAVELENGTH_NM)?)
    }

    /// Vertical optical depth of the molecules above the ground at 550 nm, whatever the top of the scene.
    ///
    /// # Errors
    /// [`AirError::Table`] if the tables do not reach there.
    pub fn molecular_depth(&self) -> Result<f64, AirError> {
        let nodes = &self.density.axis().nodes;
        let mut column = 0.0;
        // Densities are exponential between two nodes.
        for ends in nodes.windows(2) {
            let (a, b) = (self.density.at(ends[0])?, self.density.at(ends[1])?);
            let mean = if (a / b - 1.0).abs() < 1e-9 { a } else { (a - b) / (a / b).ln() };
            column += mean * (ends[1] - ends[0]);
        }
        Ok(column * self.rayleigh.cross_section_m2.at(REFERENCE_WAVELENGTH_NM)?)
    }

    /// Vertical optical depths between the ground and the top at a wavelength in nm: of each component its column times its
    /// cross-section, by [`Medium::columns`].
    ///
    /// # Errors
    /// [`AirError`] for a wavelength outside the tables.
    pub fn depths(&self, wavelength_nm: f64) -> Result<Depths, AirError> {
        let medium = self.medium(&[wavelength_nm])?;
        let columns = medium.columns(SPHERE, Place::above(0.0), DVec3::Z).unwrap_or_default();
        let of =
            |(component, column): (&Component<1>, &f64)| column * (component.scattering[0] + component.absorption[0]);
        let depths: Vec<f64> = medium.components().iter().zip(&columns).map(of).collect();
        // In the order of `medium`.
        let (gases, aerosol) = depths.split_at(1 + self.ozone.len());
        Ok(Depths { molecules: gases[0], ozone: gases[1..].iter().sum(), aerosol: aerosol.iter().sum() })
    }

    /// Air mass: the column of molecules from `place` along the unit `direction` to the top over that along the vertical of the place, 1 for the
    /// zenith. Rays are straight, without refraction, between spheres or, if `flat`, planes. `None` where the planet is in the way or no air is above.
    ///
    /// # Errors
    /// [`AirError`] if the tables do not reach.
    pub fn air_mass(&self, flat: bool, place: Place, direction: DVec3) -> Result<Option<f64>, AirError> {
        let medium = self.medium(&[REFERENCE_WAVELENGTH_NM])?;
        let shape = if flat { Shape::Flat } else { SPHERE };
        let column = |direction: DVec3| medium.columns(shape, place, direction).map(|columns| columns[0]);
        let overhead = column(place.up).filter(|overhead| *overhead > 0.0);
        Ok(overhead.and_then(|overhead| Some(column(direction)? / overhead)))
    }

    /// Vertical ozone column in Dobson units.
    #[must_use]
    pub fn ozone_du(&self) -> f64 {
        self.ozone_du
    }

    /// Top of the atmosphere in m.
    #[must_use]
    pub fn top_m(&self) -> f64 {
        self.top_m
    }

    /// The medium at `L` wavelengths in nm.
    ///
    /// # Errors
    /// [`AirError`] for a wavelength outside the tables.
    pub fn medium<const L: usize>(&self, wavelengths_nm: &[f64; L]) -> Result<Medium<L>, AirError> {
        let lanes = |curve: &Curve| -> Result<[f64; L], TableError> {
            let mut values = [0.0; L];
            for (value, &nm) in values.iter_mut().zip(wavelengths_nm) {
                *value = curve.at(nm)?;
            }
            Ok(values)
        };
        let (mut gamma, mut scattering) = (lanes(&self.rayleigh.gamma)?, lanes(&self.rayleigh.cross_section_m2)?);
        if self.depolarisation == Depolarisation::None {
            for j in 0..L {
                scattering[j] /= king_factor(gamma[j]);
            }
            gamma = [0.0; L];
        }
        let phase = Phase::Rayleigh { gamma };
        let molecules =
            Component { density: self.density.clone(), scattering, absorption: [0.0; L], phase: phase.clone() };
        let mut components = vec![molecules];
        for (density, sigma) in self.ozone.iter().zip(&self.cross_section.coefficients) {
            components.push(Component {
                density: density.clone(),
                scattering: [0.0; L],
                absorption: lanes(sigma)?,
                phase: phase.clone(),
            });
        }
        if let Some(haze) = &self.haze {
            components.extend(haze.components(wavelengths_nm)?);
        }
        Ok(Medium::new(components, self.top_m)?)
    }
}

/// The planet.
const SPHERE: Shape = Shape::Sphere { radius_m: EARTH_RADIUS_M };

/// The King factor F_k = (6 + 3 rho) / (6 - 7 rho) by which depolarisation raises the cross-section, from gamma = rho / (2 - rho)
/// (Bucholtz 1995, equations 5 and 12).
fn king_factor(gamma: f64) -> f64 {
    let rho = 2.0 * gamma / (1.0 + gamma);
    (6.0 + 3.0 * rho) / (6.0 - 7.0 * rho)
}

/// The temperatures in K at which ozone's cross-section was measured (Serdyuchenko et al. 2014). Colder air (85
/// to 92 km) and warmer air (above 113 km) absorbs as at the nearest: there is next to no ozone, and a
/// polynomial beyond its data may turn negative.
const MEASURED_K: (f64, f64) = (193.0, 293.0);

/// N, N (T - T_0) and N (T - T_0)^2 on the nodes of both the ozone profile and the
/// temperature, linear between them. T runs linearly between its nodes, so on
/// the common nodes (at most 250 m apart) a product of the two differs from its chord by under 1e-4.
///
/// A profile in steps is carried as such, with the temperature of each step's middle;
/// its steps are divided at the nodes of the temperature.
fn ozone_terms(
    air: &StandardAtmosphere,
    cross_section: &OzoneCrossSection,
    profile: &Curve,
    scale: f64,
) -> Result<[Curve; 3], TableError> {
    let (low, high) = profile.axis().range();
    let temperature = &air.temperature_k;
    let mut nodes: Vec<f64> = temperature.axis().nodes.iter().copied().filter(|&z| z > low && z < high).collect();
    nodes.extend(&profile.axis().nodes);
    nodes.sort_by(f64::total_cmp);
    nodes.dedup();
    let steps = profile.axis().interpolation == Interpolation::Step;
    let mut terms: [Vec<f64>; 3] = Default::default();
    for (i, &z) in nodes.iter().enumerate() {
        let at = match nodes.get(i + 1) {
            Some(next) if steps => 0.5 * (z + next),
            _ => z,
        };
        let (coldest, warmest) = MEASURED_K;
        let dt = temperature.at(at)?.clamp(coldest, warmest) - cross_section.reference_temperature_k;
        let density = scale * profile.at(z)?;
        for (power, term) in (0..).zip(&mut terms) {
            term.push(density * dt.powi(power));
        }
    }
    let axis = Axis::new("altitude", "m", nodes)?.between(profile.axis().interpolation).beyond(Outside::Zero);
    let [a, b, c] = terms;
    let curve = |values| Curve::new(axis.clone(), Scale::Linear, values);
    Ok([curve(a)?, curve(b)?, curve(c)?])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::direction_at;
    use std::path::Path;
    use tables::units::KM;

    fn air() -> Air {
        let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
        let settings = AirSettings {
            month: 6,
            latitude_deg: 45.0,
            ozone_source: OzoneSource::McPetersLabow,
            ozone_du: Some(300.0),
            top_m: 120.0 * KM,
            depolarisation: Depolarisation::Measured,
        };
        Air::new(&data, &settings).expect("air")
    }

    #[test]
    fn optical_depths_are_those_of_the_columns() {
        let depths = air().depths(550.0).expect("in range");
        // Bucholtz 1995, table 3, has 0.0971 for the standard atmosphere. 300 DU of 2.687e20 m^-2 each times 3.4e-25 m^2 (Serdyuchenko
        // et al. 2014, 550 nm, 223 K) are 0.027; warmer and colder layers are within 3 % of it.
        assert!((depths.molecules / 0.0971 - 1.0).abs() < 2e-3, "{depths:?}");
        assert!((depths.ozone / 0.0270 - 1.0).abs() < 0.05, "{depths:?}");
        assert_eq!(depths.aerosol, 0.0);
    }

    #[test]
    fn air_mass_is_the_secant_high_up_and_that_of_kasten_and_young_lower_down() {
        let air = air();
        let at = |elevation: f64| {
            air.air_mass(false, Place::above(0.0), direction_at(0.0, elevation.to_radians())).expect("in range")
        };
        assert!((at(90.0).expect("above") - 1.0).abs() < 1e-12);
        // Kasten & Young 1989, equation 3, whose rays are refracted.
        for (elevation, published, tolerance) in [(30.0, 1.9943, 2e-3), (10.0, 5.586, 5e-3)] {
            let found = at(elevation).expect("above");
            assert!((found / published - 1.0).abs() < tolerance, "{elevation}: {found}");
        }
        assert_eq!(at(-1.0), None);
        let flat = air.air_mass(true, Place::above(0.0), direction_at(0.0, 5.0_f64.to_radians())).expect("in range");
        assert!((flat.expect("above") * 5.0_f64.to_radians().sin() - 1.0).abs() < 1e-9, "{flat:?}");
        assert_eq!(air.air_mass(false, Place::above(200.0 * KM), DVec3::Z).expect("in range"), None);
    }
}
