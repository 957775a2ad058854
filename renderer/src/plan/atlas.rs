//! The atlas of differences: what leaving each part of the model out changes, on scenes from day to twilight, from clear air to haze, and from space.

use super::Traits;
use super::evidence::likeness;
use std::fmt::Write;
use tables::views::Biome;

/// What a part of the model makes of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Difference {
    /// The part, and what stands in its place.
    pub term: String,
    /// Which part of the world the scene is of.
    pub regime: String,
    /// The scene.
    pub traits: Traits,
    /// Root mean squares over directions of the change of radiance and of luminance, over their means, and of CIEDE2000.
    pub change: [f64; 3],
}

/// All differences.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Atlas {
    /// Term by term.
    pub rows: Vec<Difference>,
}

const TITLE: &str = "# What leaving out parts of the model changes: rms over 64 directions, shares and CIEDE2000";
const HEADER: &str = "term,regime,aerosol,optical_depth_550nm,sun_elevation_deg,altitude_km,albedo,ozone_du,radiance,luminance,ciede2000";

impl Difference {
    /// Whether it is of the world, and not of how it is computed.
    #[must_use]
    pub fn is_of_the_world(&self) -> bool {
        const COMPUTED: [&str; 5] = ["orders", "further orders", "wavelengths", "quadrature", "tables"];
        !COMPUTED.iter().any(|start| self.term.starts_with(start))
    }
}

impl Atlas {
    /// The measurements that this program carries.
    ///
    /// # Errors
    /// A sentence, if the file is none: a test sees to it that this does not happen.
    pub fn stored() -> Result<Self, String> {
        Self::parse(include_str!("../../measured/atlas.csv"))
    }

    /// As the file has it: a title, a header, and a row for each term and scene.
    #[must_use]
    pub fn csv(&self) -> String {
        let mut csv = format!("{TITLE}\n{HEADER}\n");
        for Difference { term, regime, traits, change: [radiance, luminance, colour] } in &self.rows {
            let Traits { biome, optical_depth, sun_elevation_deg, altitude_km, albedo, ozone_du } = traits;
            // Writing to a string does not fail.
            let _ = writeln!(
                csv,
                "{term},{regime},{},{optical_depth:.4},{sun_elevation_deg},{altitude_km},{albedo},{ozone_du:.1},{radiance:.2e},{luminance:.2e},{colour:.2e}",
                biome.map_or("none", Biome::name)
            );
        }
        csv
    }

    /// Reads what [`Atlas::csv`] writes.
    ///
    /// # Errors
    /// A sentence with the line: another title or header, or a row that is none.
    pub fn parse(csv: &str) -> Result<Self, String> {
        let mut lines = csv.lines();
        if lines.next() != Some(TITLE) || lines.next() != Some(HEADER) {
            return Err("line 1 or 2: another title or header than that of this program's study".into());
        }
        let rows = (3..).zip(lines).map(|(at, line)| row(line).ok_or_else(|| format!("line {at}: not a difference")));
        Ok(Self { rows: rows.collect::<Result<_, _>>()? })
    }

    /// Of each term what it changes on the measured scene that is most like another.
    #[must_use]
    pub fn near(&self, traits: &Traits) -> Vec<&Difference> {
        let mut terms: Vec<&Difference> = Vec::new();
        for row in &self.rows {
            match terms.iter_mut().find(|other| other.term == row.term) {
                None => terms.push(row),
                Some(best) => {
                    if likeness(traits, &row.traits) > likeness(traits, &best.traits) {
                        *best = row;
                    }
                }
            }
        }
        terms
    }
}

fn row(line: &str) -> Option<Difference> {
    let fields: Vec<&str> = line.split(',').collect();
    let [term, regime, aerosol, numbers @ ..] = fields.as_slice() else { return None };
    let numbers: Vec<f64> = numbers.iter().map(|text| text.parse().ok()).collect::<Option<_>>()?;
    let [optical_depth, sun_elevation_deg, altitude_km, albedo, ozone_du, radiance, luminance, colour] = numbers[..]
    else {
        return None;
    };
    let biome = if *aerosol == "none" { None } else { Some(Biome::from_name(aerosol)?) };
    let traits = Traits { biome, optical_depth, sun_elevation_deg, altitude_km, albedo, ozone_du };
    let change = [radiance, luminance, colour];
    change.iter().all(|x| x.is_finite() && *x >= 0.0).then(|| Difference {
        term: (*term).to_owned(),
        regime: (*regime).to_owned(),
        traits,
        change,
    })
}
