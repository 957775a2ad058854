//! What can be chosen: how light is followed, and at which wavelengths.

use crate::scene::Scene;
use crate::spectrum::Wavelengths;
use crate::transport::{Fineness, Method};

/// How light is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Transfer {
    /// Grid of the solved table; none of the isotropic closure.
    pub fineness: Option<Fineness>,
    /// Whether with its polarisation.
    pub polarised: bool,
}

const fn solved(fineness: Fineness, polarised: bool) -> Transfer {
    Transfer { fineness: Some(fineness), polarised }
}

/// All ways: the isotropic closure, and tables of seven grids, without and with polarisation.
pub const TRANSFERS: [Transfer; 15] = [
    Transfer { fineness: None, polarised: false },
    solved(Fineness::Coarse, false),
    solved(Fineness::Light, false),
    solved(Fineness::Usual, false),
    solved(Fineness::Middle, false),
    solved(Fineness::Good, false),
    solved(Fineness::Better, false),
    solved(Fineness::Fine, false),
    solved(Fineness::Coarse, true),
    solved(Fineness::Light, true),
    solved(Fineness::Usual, true),
    solved(Fineness::Middle, true),
    solved(Fineness::Good, true),
    solved(Fineness::Better, true),
    solved(Fineness::Fine, true),
];

/// Points on a line of sight of the isotropic closure.
const STEPS: u32 = 16;

impl Transfer {
    /// Its name in files and tables for people.
    #[must_use]
    pub fn name(self) -> String {
        match (self.fineness, self.polarised) {
            (None, _) => "isotropic".into(),
            (Some(fineness), false) => fineness.name().into(),
            (Some(fineness), true) => format!("{}-polarised", fineness.name()),
        }
    }

    /// Its place in [`TRANSFERS`].
    #[must_use]
    pub fn index(self) -> usize {
        TRANSFERS.iter().position(|one| *one == self).unwrap_or(0)
    }

    /// The scene with light followed so.
    #[must_use]
    pub fn of(self, scene: &Scene) -> Scene {
        let stokes = scene.polarisation || scene.filter_deg.is_some();
        Scene {
            method: if self.fineness.is_some() { Method::Solved } else { Method::Isotropic },
            fineness: self.fineness,
            steps: self.fineness.is_none().then_some(STEPS),
            follow_polarisation: (self.fineness.is_some() && !stokes).then_some(self.polarised),
            sky_type: None,
            spp: None,
            error: None,
            ..scene.clone()
        }
    }
}

/// Wavelengths of the spectrum that is taken for the whole: even ones from 380 to 780 nm.
pub const SPECTRUM: usize = 31;

/// At which wavelengths light is followed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spectrum {
    /// 447, 527, 593 and 660 nm: among the fours that X, Y and Z follow best from, by the covariance of [`crate::spectrum::Between`]
    Seen4,
    /// 407, 447, 500, 540, 567, 593, 620 and 673 nm: likewise of eights
    Seen8,
    /// 380, 433, 487, 540, 593, 647, 713 and 780 nm: likewise that radiances at sixteen follow from; transfers are compared at
    /// these, for what a grid is off varies slowly with wavelength
    Spread8,
    /// Sixteen from 380 to 780 nm
    Even16,
    /// All 31
    Even31,
}

impl Spectrum {
    /// All of them, the cheapest first.
    pub const ALL: [Self; 5] = [Self::Seen4, Self::Seen8, Self::Spread8, Self::Even16, Self::Even31];

    /// Places among the [`SPECTRUM`].
    #[must_use]
    pub fn places(self) -> Vec<usize> {
        match self {
            Self::Seen4 => vec![5, 11, 16, 21],
            Self::Seen8 => vec![2, 5, 9, 12, 14, 16, 18, 22],
            Self::Spread8 => vec![0, 4, 8, 12, 16, 20, 25, 30],
            Self::Even16 => (0..SPECTRUM).step_by(2).collect(),
            Self::Even31 => (0..SPECTRUM).collect(),
        }
    }

    /// The wavelengths.
    #[must_use]
    pub fn wavelengths(self) -> Wavelengths {
        if self == Self::Even16 {
            // The same, to the last bit, as those of a scene that says nothing.
            return Wavelengths::default();
        }
        let all = Wavelengths::visible(SPECTRUM).unwrap_or_default();
        // Increasing and in the range of the data, as all of them are.
        Wavelengths::new(self.places().into_iter().map(|i| all.nm()[i]).collect()).unwrap_or_default()
    }

    /// Its name in files and tables for people.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Seen4 => "4",
            Self::Seen8 => "8-seen",
            Self::Spread8 => "8",
            Self::Even16 => "16",
            Self::Even31 => "31",
        }
    }

    /// Wavelengths that are carried together, and in how many packets.
    #[must_use]
    pub fn lanes(self) -> (usize, usize) {
        match self {
            Self::Seen4 => (4, 1),
            Self::Seen8 | Self::Spread8 => (8, 1),
            Self::Even16 => (16, 1),
            Self::Even31 => (16, 2),
        }
    }
}

/// A rung: a way to follow light, at some wavelengths.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Candidate {
    /// How.
    pub transfer: Transfer,
    /// Where.
    pub spectrum: Spectrum,
}

impl Candidate {
    /// How many there are.
    pub const COUNT: usize = TRANSFERS.len() * Spectrum::ALL.len();

    /// All of them: each transfer at each spectrum.
    pub fn all() -> impl Iterator<Item = Self> {
        let at = |transfer| Spectrum::ALL.into_iter().map(move |spectrum| Self { transfer, spectrum });
        TRANSFERS.into_iter().flat_map(at)
    }

    /// The one with the smallest errors.
    #[must_use]
    pub fn most_exact() -> Self {
        Self { transfer: TRANSFERS[TRANSFERS.len() - 1], spectrum: Spectrum::Even31 }
    }

    /// Its name: transfer and wavelengths.
    #[must_use]
    pub fn name(self) -> String {
        format!("{}/{}", self.transfer.name(), self.spectrum.name())
    }

    /// The scene made so; `asked` is the relative error that its picture is to have, which lookup between few looks goes by.
    #[must_use]
    pub fn of(self, scene: &Scene, asked: f64) -> Scene {
        let table_error = asked.clamp(1e-5, 1.0);
        Scene { wavelengths_nm: self.spectrum.wavelengths(), table_error, ..self.transfer.of(scene) }
    }
}
