//! What each rung is, and what it covers.

use crate::transport::Method;

/// What a method is asked to do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// True elevation of the sun's centre at the observer in degrees.
    pub sun_elevation_deg: f64,
    /// Altitude of the observer in km.
    pub altitude_km: f64,
    /// Vertical optical depth at 550 nm of molecules and aerosol over that of molecules: 1 in clean air. (So defined by Preetham
    /// et al. 1999, section 2.)
    pub turbidity: f64,
    /// Whether light is followed with its polarisation.
    pub polarised: bool,
    /// Whether the planet is flat.
    pub flat: bool,
}

/// Why a method does not cover a scene: one sentence.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct Refusal(pub String);

/// A method and what is to be known of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rung {
    /// The method.
    pub method: Method,
    /// Its name in flags and files.
    pub name: &'static str,
    /// Paper, with equations or tables.
    pub source: &'static str,
    /// What of the light it leaves out or takes for something simpler.
    pub leaves_out: &'static str,
    /// Elevations of the sun in degrees.
    sun_deg: (f64, f64),
    /// Altitudes of the observer in km.
    altitude_km: (f64, f64),
    /// Turbidities.
    turbidity: (f64, f64),
    /// Whether it knows polarisation.
    polarised: bool,
    /// Whether it knows a flat planet.
    flat: bool,
}

const EVERY_SUN: (f64, f64) = (-90.0, 90.0);
const DAY: (f64, f64) = (0.0, 90.0);
const ANYWHERE: (f64, f64) = (0.0, f64::INFINITY);
const ANY_HAZE: (f64, f64) = (0.0, f64::INFINITY);
/// Where an observer on the ground stands.
const GROUND: (f64, f64) = (0.0, 1.0);

/// A method of the whole light, as far as ranges go.
const EXACT: Rung = Rung {
    method: Method::Judge,
    name: "judge",
    source: "delta and ratio tracking (Woodcock et al. 1965; Novak et al. 2014)",
    leaves_out: "nothing; noise",
    sun_deg: EVERY_SUN,
    altitude_km: ANYWHERE,
    turbidity: ANY_HAZE,
    polarised: true,
    flat: true,
};

/// A method of Airlight's atmosphere without polarisation.
const CLOSURE: Rung = Rung {
    method: Method::Isotropic,
    name: "isotropic",
    source: "Hillaire 2020, section 5.5, equations 5 to 10",
    leaves_out: "where light scattered twice or more comes from and goes to; what the sky sends to the ground",
    polarised: false,
    ..EXACT
};

/// A method for an observer on the ground by day.
const BY_DAY: Rung = Rung {
    method: Method::Oneil,
    name: "oneil",
    source: "O'Neil 2005 (GPU Gems 2, chapter 16)",
    leaves_out: "as single; ozone, every profile but one exponential of 40 km on a planet of Earth's size, the ground",
    sun_deg: DAY,
    altitude_km: GROUND,
    flat: false,
    ..CLOSURE
};

/// All methods, the most exact first.
pub const LADDER: [Rung; 10] = [
    EXACT,
    Rung {
        method: Method::Paths,
        name: "paths",
        source: "paths on column tables (docs/physics.md)",
        leaves_out: "2e-5 of transmittances; noise",
        ..EXACT
    },
    Rung {
        method: Method::Solved,
        name: "solved",
        source: "solved tables of moments (docs/solver.md)",
        leaves_out: "moments beyond the last, what lies between levels and suns",
        flat: false,
        ..EXACT
    },
    CLOSURE,
    Rung {
        method: Method::Single,
        name: "single",
        source: "Nishita et al. 1993, section 3",
        leaves_out: "all light scattered or reflected twice or more",
        ..CLOSURE
    },
    BY_DAY,
    Rung {
        method: Method::HosekWilkie,
        name: "hosek-wilkie",
        source: "Hosek & Wilkie 2012 (crate hw-skymodel: RGB)",
        leaves_out: "all of the atmosphere but turbidity; the ground's view",
        turbidity: (1.0, 10.0),
        ..BY_DAY
    },
    Rung {
        method: Method::Preetham,
        name: "preetham",
        source: "Preetham, Shirley & Smits 1999, appendix A.2",
        leaves_out: "all of the atmosphere but turbidity; the ground",
        turbidity: (2.0, 6.0),
        ..BY_DAY
    },
    Rung {
        method: Method::Perez,
        name: "perez",
        source: "Perez, Seals & Michalsky 1993, equations 1 to 8, table 1",
        leaves_out: "colour; all but clearness, brightness and illuminance, here those of isotropic",
        sun_deg: (1.0, 90.0),
        ..BY_DAY
    },
    Rung {
        method: Method::Cie,
        name: "cie",
        source: "CIE S 011/E:2003 (ISO 15469:2004), table 1",
        leaves_out: "colour; all but the type of sky and the luminance of the zenith, here that of isotropic",
        ..BY_DAY
    },
];

impl Rung {
    /// What is to be known of a method.
    #[must_use]
    pub fn of(method: Method) -> &'static Self {
        // Every method is on the ladder: `every_method_is_on_the_ladder_once`.
        LADDER.iter().find(|rung| rung.method == method).unwrap_or(&LADDER[0])
    }

    /// Whether the method does what is asked.
    ///
    /// # Errors
    /// [`Refusal`] with the first thing that it does not cover, and what it does.
    pub fn covers(&self, asked: &Conditions) -> Result<(), Refusal> {
        let refuse = |text: String| Err(Refusal(format!("method {} {text}", self.name)));
        let within = |value: f64, (low, high): (f64, f64)| (low..=high).contains(&value);
        if !within(asked.sun_elevation_deg, self.sun_deg) {
            let ((low, high), is) = (self.sun_deg, asked.sun_elevation_deg);
            return refuse(format!("takes the sun from {low} to {high} degrees of elevation, not at {is}"));
        }
        if !within(asked.altitude_km, self.altitude_km) {
            let (high, is) = (self.altitude_km.1, asked.altitude_km);
            return refuse(format!("takes observers on the ground, up to {high} km, not at {is} km"));
        }
        if !within(asked.turbidity, self.turbidity) {
            let ((low, high), is) = (self.turbidity, asked.turbidity);
            return refuse(format!(
                "takes turbidities from {low} to {high} (optical depth at 550 nm over that of molecules), not {is:.2}"
            ));
        }
        if asked.polarised && !self.polarised {
            return refuse("knows no polarisation: take --method solved or paths".into());
        }
        if asked.flat && !self.flat {
            return refuse("needs a round planet".into());
        }
        Ok(())
    }

    /// The ranges that it covers, for people: sun, observer, turbidity.
    #[must_use]
    pub fn range(&self) -> String {
        let sun = match self.sun_deg {
            EVERY_SUN => "every sun".to_owned(),
            (low, high) => format!("sun {low} to {high} degrees"),
        };
        let observer = if self.altitude_km == ANYWHERE { "anywhere" } else { "on the ground (to 1 km)" };
        let haze = match self.turbidity {
            ANY_HAZE => "any haze".to_owned(),
            (low, high) => format!("turbidity {low} to {high}"),
        };
        format!("{sun}, {observer}, {haze}")
    }
}
