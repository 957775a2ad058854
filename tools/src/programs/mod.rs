//! The air over a place in the forms that other renderers read: coefficients of even layers, phase functions, fitted profiles.

mod bevy;
mod blender;
mod fit;
mod mitsuba;
mod pbrt;
mod unreal;

use crate::column::{Column, Species};
use crate::sources::Sources;
use crate::text::{shortest, six_digits};
use serde::Serialize;
use tables::TableError;
use tables::units::KM;

/// A renderer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Program {
    /// Mitsuba 3: a scene for each wavelength, with grids and tabulated phase functions.
    Mitsuba,
    /// pbrt-v4: one medium, `rgbgrid`, of three wavelengths.
    Pbrt,
    /// Blender 4.3 or later: a script that makes volume materials of three wavelengths.
    Blender,
    /// Unreal Engine: the properties of a `SkyAtmosphereComponent`.
    Unreal,
    /// Bevy 0.19: a Rust function that makes a `ScatteringMedium`.
    Bevy,
}

impl Program {
    /// Every program.
    pub const ALL: [Self; 5] = [Self::Mitsuba, Self::Pbrt, Self::Blender, Self::Unreal, Self::Bevy];

    /// Its name in flags.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Mitsuba => "mitsuba",
            Self::Pbrt => "pbrt",
            Self::Blender => "blender",
            Self::Unreal => "unreal",
            Self::Bevy => "bevy",
        }
    }

    /// The program of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|program| program.name() == name)
    }

    /// Wavelengths in nm if none are named: one, or those that stand for red, green and blue.
    #[must_use]
    pub fn wavelengths_nm(self) -> &'static [f64] {
        match self {
            Self::Mitsuba => &[550.0],
            Self::Pbrt | Self::Blender | Self::Unreal | Self::Bevy => &[650.0, 550.0, 450.0],
        }
    }

    /// Whether its wavelengths are red, green and blue.
    #[must_use]
    pub fn is_rgb(self) -> bool {
        self != Self::Mitsuba
    }
}

/// Why nothing can be exported.
#[derive(Debug, thiserror::Error)]
pub enum ProgramError {
    /// A table does not reach.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A program that takes red, green and blue.
    #[error("{program} takes three wavelengths, for red, green and blue: {found} were named")]
    NotRgb {
        /// Its name.
        program: &'static str,
        /// How many wavelengths were named.
        found: usize,
    },
    /// Layers of no use.
    #[error("layers of {step_km} km: {} to {} km are possible, a whole number of them in 120 km", LAYERS_KM.0, LAYERS_KM.1)]
    Layers {
        /// Their thickness in km.
        step_km: f64,
    },
}

/// Thinnest and thickest layers in km.
const LAYERS_KM: (f64, f64) = (0.01, 10.0);

/// Intervals of the cosine of the scattering angle in exported phase functions.
const COSINES: usize = 4000;

/// The air over a place in layers of equal thickness.
///
/// The coefficient of a layer is its optical depth over its thickness, so that vertical optical depths are those of the tables.
#[derive(Debug, Clone)]
pub struct Layers {
    /// Thickness of a layer in m.
    step_m: f64,
    /// How many there are, from the ground.
    count: usize,
    /// Wavelengths in nm.
    wavelengths_nm: Vec<f64>,
    /// Molecules, ozone, then those of the aerosol.
    species: Vec<Layered>,
    /// What the air is, as pairs of name and value.
    settings: Vec<(String, String)>,
    /// Where the numbers came from.
    sources: Sources,
}

/// What a species is to a renderer.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
enum Role {
    Molecules,
    Ozone,
    Aerosol,
}

/// One species in layers.
#[derive(Debug, Clone)]
struct Layered {
    name: String,
    role: Role,
    /// Scattering coefficient in m^-1: [wavelength][layer].
    scattering: Vec<Vec<f64>>,
    /// Absorption coefficient in m^-1: [wavelength][layer].
    absorption: Vec<Vec<f64>>,
    /// Asymmetry parameter of each wavelength; empty if it does not scatter.
    asymmetry: Vec<f64>,
    /// Phase function in sr^-1: [wavelength][node], nodes even in the cosine from -1 to 1 ([`hats`]); empty if it does not scatter.
    phase: Vec<Vec<f64>>,
}

impl Layers {
    /// Of a column of air, at wavelengths in nm, in layers of `step_km` up to the top of the tables.
    ///
    /// # Errors
    /// [`ProgramError::Layers`], and [`ProgramError::Table`] for wavelengths outside the tables.
    pub fn new(
        column: &Column,
        (wavelengths_nm, step_km): (&[f64], f64),
        settings: Vec<(String, String)>,
        sources: Sources,
    ) -> Result<Self, ProgramError> {
        let (ground_m, top_m) = column.air().number_density_m3.axis().range();
        let step_m = step_km * KM;
        let count = ((top_m - ground_m) / step_m).round();
        let possible = (LAYERS_KM.0..=LAYERS_KM.1).contains(&step_km);
        if !possible || (count * step_m - (top_m - ground_m)).abs() > 1e-6 * step_m {
            return Err(ProgramError::Layers { step_km });
        }
        let count = count as usize;
        let of = |species: Species| -> Result<Layered, TableError> {
            let mut layered = Layered {
                name: column.name(species).into(),
                role: match species {
                    Species::Molecules => Role::Molecules,
                    Species::Ozone => Role::Ozone,
                    Species::Aerosol(_) => Role::Aerosol,
                },
                scattering: Vec::new(),
                absorption: Vec::new(),
                asymmetry: Vec::new(),
                phase: Vec::new(),
            };
            for &nm in wavelengths_nm {
                let layer = |i: usize| {
                    let low = ground_m + step_m * i as f64;
                    column.optical_depth(species, nm, (low, (low + step_m).min(top_m))).map(|d| d.times(1.0 / step_m))
                };
                let layers = (0..count).map(layer).collect::<Result<Vec<_>, _>>()?;
                layered.scattering.push(layers.iter().map(|parts| parts.scattering).collect());
                layered.absorption.push(layers.iter().map(|parts| parts.absorption).collect());
                layered.asymmetry.extend(column.asymmetry(species, nm)?);
                let (nodes, means) = hats();
                if let Some(phase) = column.phase(species, nm, &nodes)? {
                    layered.phase.push(means(&phase));
                }
            }
            Ok(layered)
        };
        let species = column.species().into_iter().map(of).collect::<Result<_, _>>()?;
        Ok(Self { step_m, count, wavelengths_nm: wavelengths_nm.to_vec(), species, settings, sources })
    }

    /// Top in km.
    fn top_km(&self) -> f64 {
        self.step_m * self.count as f64 / KM
    }

    /// The species that scatter.
    fn scatterers(&self) -> impl Iterator<Item = &Layered> {
        self.species.iter().filter(|one| !one.phase.is_empty())
    }

    /// Sum over the species of one of their numbers, at a wavelength and layer.
    fn sum(&self, wavelength: usize, layer: usize, of: impl Fn(&Layered) -> &[Vec<f64>]) -> f64 {
        self.species.iter().map(|one| of(one)[wavelength][layer]).sum()
    }

    /// Vertical optical depth of a species: scattering and absorption.
    fn optical_depth(&self, one: &Layered, wavelength: usize) -> f64 {
        self.step_m * one.scattering[wavelength].iter().chain(&one.absorption[wavelength]).sum::<f64>()
    }

    /// Asymmetry parameter of all scattering at a wavelength, weighted by scattering optical depth.
    fn asymmetry(&self, wavelength: usize) -> f64 {
        let (mut forward, mut all) = (0.0, 0.0);
        for one in self.scatterers() {
            let depth: f64 = one.scattering[wavelength].iter().sum();
            forward += depth * one.asymmetry[wavelength];
            all += depth;
        }
        if all > 0.0 { forward / all } else { 0.0 }
    }

    /// What the files say of themselves: lines without a mark of comment.
    fn header(&self, units: &str) -> Vec<String> {
        let list = |values: &[f64]| values.iter().map(|&value| shortest(value)).collect::<Vec<_>>().join(", ");
        let mut lines = vec![
            "Airlight: the air over a place".into(),
            format!(
                "wavelengths: {} nm; {} layers of {} m",
                list(&self.wavelengths_nm),
                self.count,
                shortest(self.step_m)
            ),
            format!("units: {units}"),
        ];
        lines.extend(self.settings.iter().map(|(name, value)| format!("{name}: {value}")));
        for one in &self.species {
            let depths: Vec<f64> = (0..self.wavelengths_nm.len()).map(|w| self.optical_depth(one, w)).collect();
            let depths: Vec<_> = depths.into_iter().map(six_digits).collect();
            lines.push(format!("vertical optical depth of {}: {}", one.name, depths.join(", ")));
        }
        lines.extend(self.sources.tables.iter().map(|table| format!("table: {} {:08x}", table.file, table.checksum)));
        lines
    }

    /// The files for a program, with their names.
    ///
    /// # Errors
    /// [`ProgramError::NotRgb`].
    pub fn files(&self, program: Program) -> Result<Vec<(String, Vec<u8>)>, ProgramError> {
        let found = self.wavelengths_nm.len();
        if program.is_rgb() && found != 3 {
            return Err(ProgramError::NotRgb { program: program.name(), found });
        }
        Ok(match program {
            Program::Mitsuba => mitsuba::files(self),
            Program::Pbrt => pbrt::files(self),
            Program::Blender => blender::files(self),
            Program::Unreal => unreal::files(self),
            Program::Bevy => bevy::files(self),
        })
    }
}

/// Cosines at which a phase function is asked for, and what makes of its values there those at even nodes: the mean of the function
/// weighted with the hat of each node, 1 there and 0 at its neighbours. What is linear between the nodes then has the same integral.
/// Every interval is asked at seven places between its ends, more densely towards cosine 1, for Simpson's rule.
fn hats() -> (Vec<f64>, impl Fn(&[f64]) -> Vec<f64>) {
    const PARTS: usize = 8;
    let step = 2.0 / COSINES as f64;
    // The narrowest peaks lie in the last interval: there the places crowd towards its end.
    let share = |i: usize, k: usize| {
        let x = k as f64 / PARTS as f64;
        if i + 1 == COSINES { 1.0 - (1.0 - x) * (1.0 - x) } else { x }
    };
    let mut places = Vec::with_capacity(COSINES * PARTS + 1);
    for i in 0..COSINES {
        places.extend((0..PARTS).map(|k| (i, share(i, k))));
    }
    places.push((COSINES - 1, 1.0));
    let cosines = places.iter().map(|(i, x)| (-1.0 + step * (*i as f64 + x)).clamp(-1.0, 1.0)).collect();
    let means = move |values: &[f64]| {
        let mut sums = vec![0.0; COSINES + 1];
        for i in 0..COSINES {
            for k in 0..PARTS {
                let (a, b) = (share(i, k), share(i, k + 1));
                let (p, q) = (values[i * PARTS + k], values[i * PARTS + k + 1]);
                // Of what is linear between a and b, times x and times 1 - x, exactly.
                let (whole, up) = ((b - a) * 0.5 * (p + q), (b - a) / 6.0 * (p * (2.0 * a + b) + q * (a + 2.0 * b)));
                sums[i + 1] += up;
                sums[i] += whole - up;
            }
        }
        let last = sums.len() - 1;
        (0..=last).map(|i| if i == 0 || i == last { 2.0 * sums[i] } else { sums[i] }).collect()
    };
    (cosines, means)
}

/// A number with the digits of single precision.
fn single(value: f64) -> String {
    format!("{:e}", value as f32)
}

#[cfg(test)]
mod tests;
