//! What a scene may say.

use super::{Albedo, CameraKind, MAX_BLOCK, MAX_SPP, Scene};
use crate::film::Film;
use crate::spectrum::{Scheme, SpectrumError, Wavelengths};
use crate::transport::Method;
use tables::{TableError, excerpt, nearest};

/// The largest width and height in pixels.
const MAX_SIZE: f64 = 16_384.0;

/// The most memory that a film may take: 16 GiB.
const MAX_FILM_BYTES: u64 = 16 << 30;

/// Why a scene is refused.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// A number outside its range.
    #[error("{what} is {value}; {low} to {high}{unit} is possible")]
    OutOfRange {
        /// The flag without its dashes.
        what: &'static str,
        /// The number.
        value: f64,
        /// The least.
        low: f64,
        /// The most.
        high: f64,
        /// Unit after a space, or nothing.
        unit: &'static str,
    },
    /// A name that nothing has.
    #[error("{what} {name:?} is not known{hint}")]
    Unknown {
        /// The flag without its dashes.
        what: &'static str,
        /// The name.
        name: String,
        /// The nearest known name, or all of them.
        hint: String,
    },
    /// A choice that this version cannot render, or two that exclude each other.
    #[error("{0}")]
    Refused(String),
    /// Wavelengths that cannot be used.
    #[error(transparent)]
    Wavelengths(#[from] SpectrumError),
    /// A ground whose spectrum does not reach a wavelength.
    #[error("albedo {name}: {source}")]
    Ground {
        /// The ground.
        name: String,
        /// What the table says.
        source: TableError,
    },
    /// A line of a scene file that says nothing of a scene.
    #[error("line {line}: {what}")]
    File {
        /// Its number, from 1.
        line: usize,
        /// What is wrong, and what would be right.
        what: String,
    },
    /// Text that is no scene.
    #[error("not a scene: {}", excerpt(&.0.to_string()))]
    Malformed(#[from] serde_json::Error),
}

impl SceneError {
    /// A setting of an aerosol where there is none.
    pub(crate) fn no_aerosol(setting: &str) -> Self {
        Self::Refused(format!("{setting} says something of an aerosol: name its biome too"))
    }

    /// [`SceneError::Unknown`] with the nearest of the `known` names, or all of them if none is near.
    pub(super) fn unknown<'a>(
        what: &'static str,
        name: &str,
        known: impl IntoIterator<Item = &'a str> + Clone,
    ) -> Self {
        let hint = match nearest(name, known.clone()) {
            Some(near) => format!("; did you mean {near}?"),
            None => format!("; known are {}", known.into_iter().collect::<Vec<_>>().join(", ")),
        };
        Self::Unknown { what, name: excerpt(name), hint }
    }
}

impl Scene {
    /// Checks every number against its range and every choice against the others.
    ///
    /// # Errors
    /// The [`SceneError`] of the first thing that is wrong.
    pub fn validate(&self) -> Result<(), SceneError> {
        range("altitude", self.altitude_km, 0.0, 1e6, " km")?;
        range("top", self.top_km, 1.0, 120.0, " km")?;
        range("sun-elevation", self.sun_elevation_deg, -90.0, 90.0, " degrees")?;
        range("sun-azimuth", self.sun_azimuth_deg, -360.0, 360.0, " degrees")?;
        range("sun-distance", self.sun_distance_au, 0.9, 1.1, " au")?;
        optional("longitude", self.longitude_deg, -180.0, 180.0, " degrees")?;
        range("month", f64::from(self.month), 1.0, 12.0, "")?;
        range("latitude", self.latitude_deg, -90.0, 90.0, " degrees")?;
        optional("ozone", self.ozone_du, 0.0, 1000.0, " DU")?;
        match &self.albedo {
            Albedo::Grey(value) => range("albedo", *value, 0.0, 1.0, "")?,
            Albedo::Spectrum(spectrum) => spectrum.validate()?,
            Albedo::Ground(_) => {}
        }
        self.validate_aerosol()?;
        self.validate_view()?;
        self.validate_polarisation()?;
        self.validate_method()?;
        optional("exposure", self.exposure_ev, -30.0, 30.0, " EV")?;
        optional("spp", self.spp.map(f64::from), 1.0, f64::from(MAX_SPP), "")?;
        optional("error", self.error, 1e-5, 1.0, "")?;
        range("table error", self.table_error, 1e-5, 1.0, "")?;
        optional("block", self.block.map(f64::from), 1.0, f64::from(MAX_BLOCK), "")?;
        match self.block.filter(|block| !block.is_power_of_two()) {
            Some(block) => Err(SceneError::Refused(format!("block is {block}; a power of two is needed"))),
            None => Ok(()),
        }
    }

    fn validate_aerosol(&self) -> Result<(), SceneError> {
        optional("humidity", self.humidity_percent, 0.0, 99.0, " %")?;
        optional("aod", self.aod, 0.0, 20.0, "")?;
        optional("visibility", self.visibility_km, 0.05, 400.0, " km")?;
        optional("turbidity", self.turbidity, 0.0, 1000.0, "")?;
        let amounts = [self.aod, self.visibility_km, self.turbidity].into_iter().flatten().count();
        match self.aerosol_setting() {
            // Whether one of the own tables is an aerosol shows when they are read.
            Some(name) if self.biome.is_none() && self.tables.is_empty() => Err(SceneError::no_aerosol(name)),
            _ if amounts > 1 => Err(SceneError::Refused("aod, visibility and turbidity exclude each other".into())),
            _ => Ok(()),
        }
    }

    fn validate_polarisation(&self) -> Result<(), SceneError> {
        optional("filter", self.filter_deg, -360.0, 360.0, " degrees")?;
        if self.polarisation && self.filter_deg.is_some() {
            return Err(SceneError::Refused(
                "what has passed a filter is polarised along its axis: leave out polarisation or filter".into(),
            ));
        }
        Ok(())
    }

    /// What only some methods know.
    fn validate_method(&self) -> Result<(), SceneError> {
        let refuse = |text: String| Err(SceneError::Refused(text));
        optional("steps", self.steps.map(f64::from), 2.0, 4096.0, "")?;
        optional("sky-type", self.sky_type.map(f64::from), 1.0, 15.0, "")?;
        optional("orders", self.orders.map(f64::from), 1.0, 1000.0, "")?;
        if self.steps.is_some() && !matches!(self.method, Method::Single | Method::Isotropic | Method::Oneil) {
            return refuse("steps are those of a line of sight: take --method single, isotropic or oneil".into());
        }
        if self.sky_type.is_some() && self.method != Method::Cie {
            return refuse("a sky type is one of the CIE's fifteen: take --method cie".into());
        }
        if self.orders.is_some() && self.method.estimator().is_none() {
            return refuse("orders of scattering are counted along paths: take --method paths or judge".into());
        }
        if self.fineness.is_some() && self.method != Method::Solved {
            return refuse("fineness is that of solved tables: leave --method out".into());
        }
        if self.colour != Scheme::Spectral && self.wavelengths_nm != Wavelengths::default() {
            let (name, own) = (self.colour.name(), self.colour.wavelengths().unwrap_or_default());
            let own: Vec<String> = own.nm().iter().map(f64::to_string).collect();
            return refuse(format!(
                "colour {name} brings its own wavelengths ({} nm): leave out others",
                own.join(", ")
            ));
        }
        if self.colour != Scheme::Spectral && self.method.is_dome() {
            return refuse("fitted skies have a colour of their own: leave out --colour".into());
        }
        if self.flat && self.sun_elevation_deg <= 0.0 {
            return refuse("over a plane the sun stands above the horizon: its elevation must be above 0".into());
        }
        if self.has_texture() && (self.flat || !matches!(self.method, Method::Solved | Method::Paths | Method::Judge)) {
            return refuse("the map of the Earth lies on a sphere, for --method solved, paths or judge".into());
        }
        if self.flat && self.in_space() {
            return refuse("over a plane there is no space to look from: the altitude must be below the top".into());
        }
        Ok(())
    }

    fn validate_view(&self) -> Result<(), SceneError> {
        match self.camera {
            CameraKind::Fisheye => optional("fov", self.fov_deg, 1.0, 360.0, " degrees for a fisheye")?,
            CameraKind::Pinhole => optional("fov", self.fov_deg, 0.01, 179.0, " degrees for a pinhole")?,
            CameraKind::Latlong | CameraKind::EqualArea => {
                if self.fov_deg.is_some() || self.view_elevation_deg.is_some() {
                    return Err(SceneError::Refused(
                        "a latlong or equal-area picture always shows the whole sphere: leave out --fov and --view-elevation".into(),
                    ));
                }
            }
        }
        optional("view-azimuth", self.view_azimuth_deg, -360.0, 360.0, " degrees")?;
        optional("view-elevation", self.view_elevation_deg, -90.0, 90.0, " degrees")?;
        let (width, height) = self.size();
        range("width", f64::from(width), 1.0, MAX_SIZE, " pixels")?;
        range("height", f64::from(height), 1.0, MAX_SIZE, " pixels")?;
        if self.camera == CameraKind::EqualArea && width != height {
            return Err(SceneError::Refused(format!(
                "an equal-area picture is a square, not {width} x {height} pixels"
            )));
        }
        let bytes = Film::bytes(width, height, self.channels(), self.polarisation);
        if bytes > MAX_FILM_BYTES {
            let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
            return Err(SceneError::Refused(format!(
                "{width} x {height} pixels at {} wavelengths take {:.0} GiB; {:.0} GiB are possible",
                self.channels(),
                gib(bytes).ceil(),
                gib(MAX_FILM_BYTES)
            )));
        }
        Ok(())
    }
}

/// Refuses what is not in `low..=high`, NaN included.
fn range(what: &'static str, value: f64, low: f64, high: f64, unit: &'static str) -> Result<(), SceneError> {
    if (low..=high).contains(&value) {
        return Ok(());
    }
    Err(SceneError::OutOfRange { what, value, low, high, unit })
}

fn optional(what: &'static str, value: Option<f64>, low: f64, high: f64, unit: &'static str) -> Result<(), SceneError> {
    value.map_or(Ok(()), |value| range(what, value, low, high, unit))
}

#[cfg(test)]
mod tests {
    use super::*;
    use tables::views::Biome;

    fn refusal(change: impl FnOnce(&mut Scene)) -> String {
        let mut scene = Scene::default();
        change(&mut scene);
        scene.validate().expect_err("refused").to_string()
    }

    #[test]
    fn the_default_scene_is_valid() {
        Scene::default().validate().expect("valid");
        Scene { altitude_km: 35_786.0, ..Scene::default() }.validate().expect("space is fine");
    }

    #[test]
    fn a_number_outside_is_refused_with_the_range() {
        assert_eq!(refusal(|s| s.sun_elevation_deg = 91.0), "sun-elevation is 91; -90 to 90 degrees is possible");
        assert_eq!(refusal(|s| s.altitude_km = -0.001), "altitude is -0.001; 0 to 1000000 km is possible");
        assert_eq!(refusal(|s| s.month = 13), "month is 13; 1 to 12 is possible");
        assert_eq!(refusal(|s| s.albedo = Albedo::Grey(1.1)), "albedo is 1.1; 0 to 1 is possible");
        assert_eq!(refusal(|s| s.fov_deg = Some(361.0)), "fov is 361; 1 to 360 degrees for a fisheye is possible");
        assert_eq!(refusal(|s| s.spp = Some(0)), "spp is 0; 1 to 1000000000 is possible");
        assert_eq!(refusal(|s| s.block = Some(2048)), "block is 2048; 1 to 1024 is possible");
        assert_eq!(refusal(|s| s.width = Some(0)), "width is 0; 1 to 16384 pixels is possible");
        for nan in [f64::NAN, f64::INFINITY] {
            assert!(refusal(|s| s.latitude_deg = nan).contains("-90 to 90"));
            assert!(refusal(|s| s.ozone_du = Some(nan)).contains("0 to 1000 DU"));
        }
    }

    #[test]
    fn what_cannot_be_rendered_is_refused_with_a_sentence() {
        assert!(refusal(|s| s.aod = Some(0.1)).contains("name its biome"));
        let twice = |s: &mut Scene| (s.biome, s.aod, s.turbidity) = (Some(Biome::Urban), Some(0.1), Some(2.0));
        assert!(refusal(twice).contains("exclude each other"));
        let latlong = |s: &mut Scene| (s.camera, s.fov_deg) = (CameraKind::Latlong, Some(90.0));
        assert!(refusal(latlong).contains("whole sphere"));
        assert!(refusal(|s| s.block = Some(48)).contains("power of two"));
        let large = |s: &mut Scene| (s.width, s.height) = (Some(16_384), Some(16_384));
        assert!(refusal(large).contains("GiB"));
        let both = |s: &mut Scene| (s.polarisation, s.filter_deg) = (true, Some(0.0));
        assert!(refusal(both).contains("leave out"));
        assert_eq!(refusal(|s| s.filter_deg = Some(361.0)), "filter is 361; -360 to 360 degrees is possible");
    }

    #[test]
    fn what_only_some_methods_know_is_refused_by_the_others() {
        assert!(refusal(|s| s.steps = Some(20)).contains("--method single"));
        assert!(refusal(|s| (s.method, s.steps) = (Method::Single, Some(1))).contains("2 to 4096"));
        assert!(refusal(|s| s.sky_type = Some(3)).contains("--method cie"));
        assert!(refusal(|s| (s.method, s.sky_type) = (Method::Cie, Some(16))).contains("1 to 15"));
        assert!(refusal(|s| s.orders = Some(2)).contains("--method paths"));
        assert!(refusal(|s| (s.method, s.orders) = (Method::Paths, Some(0))).contains("1 to 1000"));
        let few = Wavelengths::visible(4).expect("valid");
        assert!(refusal(|s| (s.colour, s.wavelengths_nm) = (Scheme::Four, few)).contains("430, 490, 560, 630 nm"));
        assert!(refusal(|s| (s.colour, s.method) = (Scheme::Rgb, Method::Preetham)).contains("--colour"));
        assert!(refusal(|s| (s.flat, s.sun_elevation_deg) = (true, 0.0)).contains("above 0"));
        assert!(refusal(|s| (s.flat, s.altitude_km) = (true, 120.0)).contains("below the top"));
        Scene { colour: Scheme::Rgb, method: Method::Single, steps: Some(20), ..Scene::default() }
            .validate()
            .expect("valid");
    }

    #[test]
    fn an_unknown_name_is_answered_with_the_nearest() {
        let known = ["dry-soil", "ocean"];
        let text = |name| SceneError::unknown("albedo", name, known).to_string();
        assert_eq!(text("oceann"), "albedo \"oceann\" is not known; did you mean ocean?");
        assert_eq!(text("q"), "albedo \"q\" is not known; known are dry-soil, ocean");
    }
}
