//! Airlight beside published and independent answers: each section compares one thing with one kind of reference, and
//! [`report`] makes `docs/validation.md` of them.
//!
//! The references are in `validation/references/` and, where tables are made of the same publications, in `raw-data/` and
//! `tools/tests/reference/`.

pub mod beam;
pub mod clear_luminance;
pub mod judge;
pub mod mie;
pub mod opac;
pub mod rayleigh;
pub mod references;
pub mod report;
pub mod rt;
pub mod skies;
pub mod thesis;
pub mod twilight;

use renderer::data::Data;
use renderer::study::Chart;
use std::path::{Path, PathBuf};

/// What a section is given.
#[derive(Clone, Copy)]
pub struct Context<'a> {
    /// The root of the project, with `data/`, `raw-data/` and `validation/`.
    pub root: &'a Path,
    /// The tables of `data/`.
    pub data: &'a Data,
    /// Whether a part stands for the whole: core cases, fewer samples.
    pub quick: bool,
    /// Hears the share of the section that is done.
    pub progress: &'a (dyn Fn(f64) + Sync),
}

impl std::fmt::Debug for Context<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Context").field("root", &self.root).field("quick", &self.quick).finish_non_exhaustive()
    }
}

/// How a finding stands to the uncertainty of its reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// No further off than the stated uncertainties allow.
    Within,
    /// Further off.
    Not,
    /// Not an error of Airlight: what the thesis had.
    Corrected,
    /// The reference states none, or what is compared is not the same thing: the figure stands for itself.
    Unstated,
}

impl Verdict {
    /// [`Verdict::Within`] if it holds, else [`Verdict::Not`].
    #[must_use]
    pub fn of(holds: bool) -> Self {
        if holds { Self::Within } else { Self::Not }
    }

    /// In the words of the report.
    #[must_use]
    pub fn words(self) -> &'static str {
        match self {
            Self::Within => "within the stated uncertainty",
            Self::Not => "**not within it**",
            Self::Corrected => "an error of the thesis, corrected",
            Self::Unstated => "no uncertainty stated",
        }
    }
}

/// A line of the table at the head of the report.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// What was compared.
    pub what: String,
    /// What was found.
    pub found: String,
    /// Beside what.
    pub beside: String,
    /// How it stands.
    pub verdict: Verdict,
}

/// A section of the report.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// Markdown below its heading.
    pub text: String,
    /// Its lines in the table at the head.
    pub findings: Vec<Finding>,
    /// Its charts: what stands between `validation-` and `.csv` in the file's name, and the points.
    pub charts: Vec<(&'static str, Chart)>,
}

impl Section {
    /// Adds a line to the table at the head of the report.
    pub fn find(&mut self, what: impl Into<String>, found: impl Into<String>, beside: &str, verdict: Verdict) {
        self.findings.push(Finding { what: what.into(), found: found.into(), beside: beside.into(), verdict });
    }

    /// Adds a paragraph.
    pub fn say(&mut self, paragraph: &str) {
        self.text += paragraph.trim();
        self.text += "\n\n";
    }

    /// Adds a table.
    pub fn table(&mut self, header: &[&str], rows: &[Vec<String>]) {
        self.text += &format!("| {} |\n|{}\n", header.join(" | "), "---|".repeat(header.len()));
        for row in rows {
            self.text += &format!("| {} |\n", row.join(" | "));
        }
        self.text.push('\n');
    }

    /// Adds a chart and the line that shows it.
    pub fn chart(&mut self, name: &'static str, chart: Chart) {
        self.text += &format!("![{}](../plots/validation-{name}.png)\n\n", chart.title);
        self.charts.push((name, chart));
    }
}

/// The sections, in the order of the report.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Name {
    /// [`rt`].
    Rt,
    /// [`mie`].
    Mie,
    /// [`opac`].
    Opac,
    /// [`rayleigh`].
    Rayleigh,
    /// [`beam`].
    Beam,
    /// [`skies`].
    Skies,
    /// [`clear_luminance`].
    Luminance,
    /// [`twilight`].
    Twilight,
    /// [`thesis`].
    Thesis,
}

impl Name {
    /// All of them.
    pub const ALL: [Self; 9] = [
        Self::Rt,
        Self::Mie,
        Self::Opac,
        Self::Rayleigh,
        Self::Beam,
        Self::Skies,
        Self::Luminance,
        Self::Twilight,
        Self::Thesis,
    ];

    /// Its name on the command line.
    #[must_use]
    pub fn as_str(self) -> &'static str {
        match self {
            Self::Rt => "rt",
            Self::Mie => "mie",
            Self::Opac => "opac",
            Self::Rayleigh => "rayleigh",
            Self::Beam => "beam",
            Self::Skies => "skies",
            Self::Luminance => "luminance",
            Self::Twilight => "twilight",
            Self::Thesis => "thesis",
        }
    }

    /// Its heading.
    #[must_use]
    pub fn title(self) -> &'static str {
        match self {
            Self::Rt => "Radiative transfer",
            Self::Mie => "Spheres",
            Self::Opac => "Aerosols of OPAC",
            Self::Rayleigh => "Rayleigh scattering",
            Self::Beam => "Direct sunlight",
            Self::Skies => "Measured skies",
            Self::Luminance => "Luminance and illuminance of clear skies",
            Self::Twilight => "The zenith in twilight",
            Self::Thesis => "The tables of the thesis",
        }
    }

    /// Computes it.
    ///
    /// # Errors
    /// [`ValidationError`] if a reference or a table cannot be read, or a scene not be computed.
    pub fn make(self, context: &Context<'_>) -> Result<Section, ValidationError> {
        match self {
            Self::Rt => rt::make(context),
            Self::Mie => mie::make(context),
            Self::Opac => opac::make(context),
            Self::Rayleigh => rayleigh::make(context),
            Self::Beam => beam::make(context),
            Self::Skies => skies::make(context),
            Self::Luminance => clear_luminance::make(context),
            Self::Twilight => twilight::make(context),
            Self::Thesis => thesis::make(context),
        }
    }
}

/// Why a section cannot be computed.
#[derive(Debug, thiserror::Error)]
pub enum ValidationError {
    /// A reference cannot be read.
    #[error("{}: {what}", path.display())]
    Reference {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the line if there is one.
        what: String,
    },
    /// Cases cannot be read.
    #[error(transparent)]
    Cases(#[from] renderer::cases::CasesError),
    /// A scene cannot be computed.
    #[error(transparent)]
    Render(#[from] renderer::render::RenderError),
    /// A scene is refused.
    #[error(transparent)]
    Scene(#[from] renderer::scene::SceneError),
    /// Wavelengths are refused.
    #[error(transparent)]
    Spectrum(#[from] renderer::spectrum::SpectrumError),
    /// The air of a scene.
    #[error(transparent)]
    Air(#[from] renderer::atmosphere::AirError),
    /// A table cannot be read, or does not reach.
    #[error(transparent)]
    Table(#[from] tables::TableError),
    /// A measured input cannot be read.
    #[error(transparent)]
    Raw(#[from] tools::raw::RawError),
    /// Numbers of the thesis.
    #[error(transparent)]
    Study(#[from] tools::study::StudyError),
    /// Aerosol optics.
    #[error(transparent)]
    Aerosol(#[from] tools::aerosol::AerosolError),
    /// A sphere out of range.
    #[error(transparent)]
    Mie(#[from] tools::mie::MieError),
}
