//! Measurements of plans as a file: what every candidate is off and costs on many scenes.

use super::{Candidate, Metric, TRANSFERS, Traits};
use std::fmt::Write;
use tables::views::Biome;

/// What things cost on a scene, in core-seconds on the machine that measured.
#[derive(Debug, Clone, PartialEq)]
pub struct Costs {
    /// Of each of [`TRANSFERS`] at eight wavelengths: what is made once for an atmosphere, and a look in one direction.
    pub solve_look_s: [[f64; 2]; TRANSFERS.len()],
    /// Of four and of thirty-one wavelengths over eight: what is made once, and a look; of coarse tables.
    pub lanes: [[f64; 2]; 2],
    /// Looks that all directions of a picture are found from, and what one of them takes of a look.
    pub panorama: [f64; 2],
    /// A polarised path at sixteen wavelengths, and the spread of its luminance: root mean square over the mean.
    pub path: [f64; 2],
}

/// How many numbers [`Costs`] are.
pub(super) const COSTS: usize = 2 * TRANSFERS.len() + 8;

impl Costs {
    /// As a list.
    #[must_use]
    pub fn values(&self) -> [f64; COSTS] {
        let mut all = self.solve_look_s.iter().chain(&self.lanes).chain([&self.panorama, &self.path]).flatten();
        std::array::from_fn(|_| all.next().copied().unwrap_or_default())
    }

    /// From a list.
    #[must_use]
    pub fn from_values(values: &[f64; COSTS]) -> Self {
        let pair = |i: usize| [values[2 * i], values[2 * i + 1]];
        let n = TRANSFERS.len();
        Self {
            solve_look_s: std::array::from_fn(pair),
            lanes: [pair(n), pair(n + 1)],
            panorama: pair(n + 2),
            path: pair(n + 3),
        }
    }

    /// Core-seconds of a picture of so many pixels by a candidate: solving, and the picture.
    #[must_use]
    pub fn of(&self, candidate: Candidate, pixels: f64) -> [f64; 2] {
        let [solve, look] = self.solve_look_s[candidate.transfer.index()];
        let [four, all] = self.lanes;
        let times = |i: usize| match candidate.spectrum.lanes() {
            (4, _) => four[i],
            (8, _) => 1.0,
            // Packets of sixteen take the same each.
            (_, packets) => 0.5 * packets as f64 * all[i],
        };
        // What a closure sees is not looked up.
        let [most, share] = self.panorama;
        let looks = if candidate.transfer.fineness.is_none() || pixels < PANORAMIC {
            pixels
        } else {
            pixels.min(most) + share * pixels
        };
        [solve * times(0), looks * look * times(1)]
    }

    /// Core-seconds of a picture of so many pixels by polarised paths whose luminance has that standard error.
    #[must_use]
    pub fn of_paths(&self, error: f64, pixels: f64) -> f64 {
        let [path, spread] = self.path;
        path * pixels * (spread / error).powi(2).max(64.0)
    }
}

/// Pictures of fewer pixels are looked at pixel by pixel.
const PANORAMIC: f64 = 4096.0;

/// One measured scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Which atmosphere: scenes of one share it.
    pub atmosphere: usize,
    /// What the scene is.
    pub traits: Traits,
    /// Its month and latitude in degrees.
    pub season: (u8, f64),
    /// What is off, of each [`Candidate`] and [`Metric`].
    pub errors: Vec<[f64; 3]>,
    /// What it costs.
    pub costs: Costs,
}

/// All that is measured.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Measured {
    /// Standard deviations by which predictions of each [`Metric`] from these scenes are raised ([`super::margins`]).
    pub margins: [f64; 3],
    /// Scene by scene, those of an atmosphere together.
    pub rows: Vec<Row>,
}

/// What comes before the margins in the first line of the file.
const MARGINS: &str = "# Plans: errors and costs by scene and rung; margins in standard deviations: ";

/// Columns before the costs.
const KEYS: &str =
    "atmosphere,aerosol,optical_depth_550nm,sun_elevation_deg,altitude_km,albedo,month,latitude_deg,ozone_du";

/// How many they are.
const KEY_COUNT: usize = 9;

impl Measured {
    /// The measurements that this program carries.
    ///
    /// # Errors
    /// A sentence, if the file is none: a test sees to it that this does not happen.
    pub fn stored() -> Result<Self, String> {
        Self::parse(include_str!("../../measured/plans.csv"))
    }

    /// Those of scenes kept apart, by which plans are judged.
    ///
    /// # Errors
    /// As [`Measured::stored`].
    pub fn held_out() -> Result<Self, String> {
        Self::parse(include_str!("../../measured/held-out.csv"))
    }

    fn header() -> String {
        let mut header = String::from(KEYS);
        // Writing to a string does not fail.
        for transfer in TRANSFERS {
            let name = transfer.name();
            let _ = write!(header, ",{name}_solve_s,{name}_look_s");
        }
        header += ",4_over_8_solve,4_over_8_look,31_over_8_solve,31_over_8_look,panorama_looks,pixel_over_look,path_s,path_spread";
        for candidate in Candidate::all() {
            for metric in Metric::ALL {
                let _ = write!(header, ",{}_{}", candidate.name(), metric.name());
            }
        }
        header
    }

    /// As the file has it: a line with the margins, a header, and a row for each scene; errors of radiance and luminance are shares, of colour units of CIEDE2000.
    #[must_use]
    pub fn csv(&self) -> String {
        let [radiance, luminance, colour] = self.margins;
        let mut csv = format!("{MARGINS}{radiance:.2} {luminance:.2} {colour:.2}\n{}\n", Self::header());
        for row in &self.rows {
            let Traits { biome, optical_depth, sun_elevation_deg, altitude_km, albedo, ozone_du } = &row.traits;
            let (month, latitude) = row.season;
            let _ = write!(
                csv,
                "{},{},{optical_depth:.4},{sun_elevation_deg:.2},{altitude_km:.3},{albedo:.3},{month},{latitude:.1},{ozone_du:.1}",
                row.atmosphere,
                biome.map_or("none", Biome::name)
            );
            for value in row.costs.values().iter().chain(row.errors.iter().flatten()) {
                let _ = write!(csv, ",{value:.2e}");
            }
            csv.push('\n');
        }
        csv
    }

    /// Reads what [`Measured::csv`] writes.
    ///
    /// # Errors
    /// A sentence with the line: another header, or a row that is none.
    pub fn parse(csv: &str) -> Result<Self, String> {
        let mut lines = csv.lines();
        let margins = lines.next().and_then(|line| line.strip_prefix(MARGINS)).map(|numbers| {
            numbers.split(' ').filter_map(|text| text.parse().ok()).filter(|x| *x >= 0.0).collect::<Vec<f64>>()
        });
        let Some(&[radiance, luminance, colour]) = margins.as_deref() else {
            return Err("line 1: expected the margins of three metrics".into());
        };
        if lines.next() != Some(Self::header().as_str()) {
            return Err("line 2: another header than that of this program's study".into());
        }
        let mut rows: Vec<Row> = Vec::new();
        for (at, line) in (3..).zip(lines) {
            let row = row(line).ok_or_else(|| format!("line {at}: not a measured scene"))?;
            let same = |other: &Row| other.atmosphere == row.atmosphere;
            if rows.last().is_some_and(|last| !same(last)) && rows.iter().any(same) {
                return Err(format!("line {at}: atmosphere {} apart from its other scenes", row.atmosphere));
            }
            rows.push(row);
        }
        Ok(Self { margins: [radiance, luminance, colour], rows })
    }
}

fn row(line: &str) -> Option<Row> {
    let fields: Vec<&str> = line.split(',').collect();
    if fields.len() != KEY_COUNT + COSTS + 3 * Candidate::COUNT {
        return None;
    }
    let number = |i: usize| fields[i].parse::<f64>().ok().filter(|x| x.is_finite());
    let biome = match fields[1] {
        "none" => None,
        name => Some(Biome::from_name(name)?),
    };
    let traits = Traits {
        biome,
        optical_depth: number(2)?,
        sun_elevation_deg: number(3)?,
        altitude_km: number(4)?,
        albedo: number(5)?,
        ozone_du: number(8)?,
    };
    let positive = |i: usize| number(KEY_COUNT + i).filter(|x| *x >= 0.0);
    let values: Vec<f64> = (0..COSTS + 3 * Candidate::COUNT).map(positive).collect::<Option<_>>()?;
    let (costs, errors) = values.split_at(COSTS);
    Some(Row {
        atmosphere: fields[0].parse().ok()?,
        traits,
        season: (fields[6].parse().ok()?, number(7)?),
        errors: errors.chunks_exact(3).map(|chunk| [chunk[0], chunk[1], chunk[2]]).collect(),
        costs: Costs::from_values(costs.first_chunk()?),
    })
}
