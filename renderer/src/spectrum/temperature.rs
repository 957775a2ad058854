//! Colour as the temperature of the black body that it is most like.

use tables::TableError;
use tables::views::Observer;

/// Second radiation constant in m K that colour temperatures are stated with (CIE 15:2018, section 9.5).
const C2_M_K: f64 = 1.4388e-2;

/// Temperatures in K that are looked through, and the step from one to the next: what remains is found between two of them.
const RANGE_K: (f64, f64) = (1000.0, 100_000.0);
const STEP: f64 = 1.01;

/// Farther than this from the locus of black bodies a colour has no temperature (CIE 15:2018, section 9.5).
const MOST_DUV: f64 = 0.05;

/// Where the observer sees, in nm, and the step of the integral over it.
const SEEN_NM: (u32, u32) = (360, 830);

/// A correlated colour temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ColourTemperature {
    /// In K, 1000 to 100 000.
    pub kelvin: f64,
    /// Distance from the locus of black bodies in the CIE 1960 (u, v) diagram, -0.05 to 0.05: above 0 greener than a black body, below 0
    /// more purple (the sign of ANSI C78.377).
    pub duv: f64,
}

/// The colours of black bodies.
#[derive(Debug, Clone)]
pub struct Locus {
    /// Wavelengths in m, each with x-bar, y-bar, z-bar.
    matching: Vec<(f64, [f64; 3])>,
    /// Temperatures in K with their (u, v).
    nodes: Vec<(f64, [f64; 2])>,
}

impl Locus {
    /// The locus as an observer sees it, at temperatures 1 % apart.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] if the observer's table refuses a wavelength of 360 to 830 nm.
    pub fn new(observer: &Observer) -> Result<Self, TableError> {
        let at = |nm: u32| {
            let [x, y, z] = &observer.matching;
            let nm = f64::from(nm);
            Ok((1e-9 * nm, [x.at(nm)?, y.at(nm)?, z.at(nm)?]))
        };
        let matching = (SEEN_NM.0..=SEEN_NM.1).map(at).collect::<Result<_, TableError>>()?;
        let mut locus = Self { matching, nodes: Vec::new() };
        let count = ((RANGE_K.1 / RANGE_K.0).ln() / STEP.ln()).ceil() as i32;
        locus.nodes = (0..=count)
            .map(|i| {
                let kelvin = RANGE_K.0 * STEP.powi(i);
                (kelvin, locus.black_body(kelvin))
            })
            .collect();
        Ok(locus)
    }

    /// (u, v) of a black body: Planck's law, lambda^-5 / (exp(c2 / (lambda T)) - 1), over the observer.
    fn black_body(&self, kelvin: f64) -> [f64; 2] {
        let mut xyz = [0.0; 3];
        for (m, matching) in &self.matching {
            let radiance = (m * 1e6).powi(-5) / (C2_M_K / (m * kelvin)).exp_m1();
            xyz.iter_mut().zip(matching).for_each(|(sum, c)| *sum += radiance * c);
        }
        uv(xyz)
    }

    /// The correlated colour temperature of a colour in CIE XYZ (1931, 2 degrees; any unit): that of the black body whose (u, v) is
    /// nearest in the CIE 1960 diagram (CIE 15:2018, section 9.5), found among temperatures 1 % apart and then, between the neighbours
    /// of the nearest, by the golden section to 1e-6 of it. Duv is the distance, with the sign of v over the locus (Ohno 2014, "Practical use and calculation of CCT and Duv",
    /// LEUKOS 10(1), whose interpolation this search stands for).
    ///
    /// # Errors
    /// Why it has none: a phrase.
    pub fn nearest(&self, xyz: [f64; 3]) -> Result<ColourTemperature, String> {
        if !xyz.iter().all(|v| v.is_finite()) || xyz[1] <= 0.0 {
            return Err("no light".into());
        }
        let seen = uv(xyz);
        let to = |[u, v]: [f64; 2]| (seen[0] - u).hypot(seen[1] - v);
        let distances = self.nodes.iter().map(|(_, uv)| to(*uv));
        let nearest = distances.enumerate().min_by(|(_, a), (_, b)| a.total_cmp(b)).map_or(0, |(index, _)| index);
        if nearest == 0 {
            return Err(format!("redder than a black body of {} K", RANGE_K.0));
        }
        if nearest + 1 >= self.nodes.len() {
            return Err(format!("bluer than a black body of {} K", RANGE_K.1));
        }
        let (mut low, mut high) = (self.nodes[nearest - 1].0, self.nodes[nearest + 1].0);
        let golden = 0.5 * (5.0_f64.sqrt() - 1.0);
        while high - low > 1e-6 * low {
            let (a, b) = (high - golden * (high - low), low + golden * (high - low));
            if to(self.black_body(a)) < to(self.black_body(b)) { high = b } else { low = a }
        }
        let kelvin = 0.5 * (low + high);
        let foot = self.black_body(kelvin);
        let duv = to(foot).copysign(seen[1] - foot[1]);
        if duv.abs() > MOST_DUV {
            return Err(format!(
                "{:.3} from the locus of black bodies in (u, v); at most {MOST_DUV} has a temperature",
                duv.abs()
            ));
        }
        Ok(ColourTemperature { kelvin, duv })
    }
}

/// CIE 1960 (u, v) = (4 X, 6 Y) / (X + 15 Y + 3 Z).
fn uv([x, y, z]: [f64; 3]) -> [f64; 2] {
    let sum = x + 15.0 * y + 3.0 * z;
    [4.0 * x / sum, 6.0 * y / sum]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Data;
    use std::path::Path;

    fn locus() -> Locus {
        let data = Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables");
        Locus::new(&data.observer).expect("the observer sees")
    }

    fn of(locus: &Locus, [x, y]: [f64; 2]) -> Result<ColourTemperature, String> {
        locus.nearest([x / y, 1.0, (1.0 - x - y) / y])
    }

    #[test]
    fn standard_illuminants_have_their_published_temperatures() {
        let locus = locus();
        // x, y and correlated colour temperature of CIE 15:2018, tables T.3 and 9.1 (A: 2848 K x 1.4388 / 1.435; E by definition), and
        // the Duv of D65 and E in ANSI C78.377 and Ohno 2014. The chromaticities have 5 digits: 1 K at 6500 K.
        let published = [
            ([0.447_58, 0.407_45], 2855.5, 0.0),
            ([0.345_67, 0.358_51], 5001.0, 0.0033),
            ([0.312_72, 0.329_03], 6503.0, 0.0032),
            ([1.0 / 3.0, 1.0 / 3.0], 5455.0, -0.0044),
        ];
        for (xy, kelvin, duv) in published {
            let found = of(&locus, xy).expect("near the locus");
            assert!((found.kelvin - kelvin).abs() < 3.0 && (found.duv - duv).abs() < 1.5e-4, "{xy:?}: {found:?}");
        }
    }

    #[test]
    fn a_black_body_has_its_own_temperature() {
        let locus = locus();
        for kelvin in [1100.0, 3210.0, 25_000.0, 90_000.0] {
            let [u, v] = locus.black_body(kelvin);
            // The inverse of (u, v).
            let (x, y) = (3.0 * u / (2.0 * u - 8.0 * v + 4.0), 2.0 * v / (2.0 * u - 8.0 * v + 4.0));
            let found = of(&locus, [x, y]).expect("on the locus");
            // Distances of 1e-9 are the rounding of (u, v); towards 1e5 K the locus is short.
            assert!((found.kelvin / kelvin - 1.0).abs() < 1e-3 && found.duv.abs() < 1e-7, "{kelvin}: {found:?}");
        }
    }

    #[test]
    fn a_colour_without_a_temperature_says_why() {
        let locus = locus();
        let why = |xy| of(&locus, xy).expect_err("none");
        assert!(locus.nearest([0.0; 3]).expect_err("black").contains("no light"));
        assert!(why([0.22, 0.20]).contains("bluer than"));
        assert!(why([0.30, 0.60]).contains("from the locus"));
        assert!(why([0.70, 0.29]).contains("redder than"));
    }
}
