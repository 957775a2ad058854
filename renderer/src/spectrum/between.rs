//! Spectra of the sky between the wavelengths at which they are known.

use crate::cholesky::Cholesky;
use tables::TableError;
use tables::units::DOBSON_UNIT_M2;
use tables::views::OzoneCrossSection;

/// Radiance factors of all wavelengths from those of a few: the linear unbiased estimate with the least mean square error, for spectra of the covariance
/// below.
///
/// Light that reached the eye was scattered some times and went through some ozone and some air. On one way it has the spectrum
///
/// s(lambda) = u^p exp(-N sigma(lambda) - m tau(lambda)), u = 550 nm / lambda,
///
/// with the cross-section sigma of ozone and the vertical optical depth tau of molecules; p is 4 for molecules and less for particles and the ground. What
/// is seen is a sum over ways: the bands of ozone, narrower than any step between wavelengths that one would simulate, are in it as they are in s. So radiance
/// factors are taken for a random function of the covariance
///
/// C(lambda, lambda') = <s(lambda) s(lambda')> \[1 + a^2 exp(-(lambda - lambda')^2 / (2 l^2)) + eta^2 (1 if lambda = lambda')\],
///
/// the mean over p, N and m as below, each s as large as the others at 550 nm; a is how far the spectra of grounds and particles are from powers of
/// wavelength, smoothly over l, eta by how much each wavelength is off by itself. From values f_i at some wavelengths the estimate at another is sum w_i f_i with
///
/// w = C^-1 c + (1 - 1^T C^-1 c) / (1^T C^-1 1) C^-1 1, c_i = C(lambda, lambda_i):
///
/// ordinary kriging, with an unknown mean (Cressie 1993, Statistics for Spatial Data, section 3.2), so that a constant stays one. Beyond the first and the
/// last of them the estimate goes on for their mean step, at most 20 nm, and is held from there.
///
/// Where a list has wavelengths close together and a wide gap beside them, spectra of that covariance would follow from differences of the close ones, and
/// light that is not of it would be off by many times its size. eta is then raised until the weights in the middle of the widest gap are together at most
/// twelve times their sum.
#[derive(Debug, Clone)]
pub struct Between<'a> {
    ozone: &'a OzoneCrossSection,
    nodes: Vec<Shapes>,
    covariance: Cholesky,
    /// C^-1 1 over its sum.
    constant: Vec<f64>,
}

/// p: of light that particles reddened, of white light, of hazy sky, of molecules.
const POWERS: [f64; 4] = [-2.0, 0.0, 2.0, 4.0];

/// N in Dobson units: none, that of an overhead sun, of low ones, of twilight.
const OZONE_DU: [f64; 5] = [0.0, 300.0, 1e3, 3e3, 8e3];

/// Temperature in K of the air that has most ozone.
const TEMPERATURE_K: f64 = 223.0;

/// m, in vertical columns of air.
const AIR: [f64; 4] = [0.0, 1.0, 4.0, 16.0];

/// tau at 550 nm, and the power of u by which it goes: within 1.2 % of what receipts state of molecules to 120 km from 380 to 780 nm (0.446, at 550 nm
/// 0.0971, 0.0235).
const AIR_DEPTH: f64 = 0.0975;
const AIR_POWER: f64 = 4.08;

/// The wavelength in nm at which all s are equal.
const MIDDLE_NM: f64 = 550.0;

/// a, l in nm, and eta: what it is, and by which factor it is raised up to 1.
const ROUGH: f64 = 0.07;
const SMOOTH_NM: f64 = 50.0;
const ALONE: f64 = 1e-3;
const RAISED: f64 = 3.0;

/// The largest sum of the sizes of weights in the widest gap.
const LARGEST: f64 = 12.0;

/// How far beyond the ends spectra are estimated at most, in nm.
const REACH_NM: f64 = 20.0;

/// The factors of all s at a wavelength: by p, by N, by m.
#[derive(Debug, Clone)]
struct Shapes {
    nm: f64,
    powers: [f64; POWERS.len()],
    ozone: [f64; OZONE_DU.len()],
    air: [f64; AIR.len()],
}

impl Shapes {
    fn new(ozone: &OzoneCrossSection, nm: f64) -> Result<Self, TableError> {
        let u = MIDDLE_NM / nm;
        let sigma = ozone.cross_section_m2(nm, TEMPERATURE_K)? - ozone.cross_section_m2(MIDDLE_NM, TEMPERATURE_K)?;
        let tau = AIR_DEPTH * (u.powf(AIR_POWER) - 1.0);
        Ok(Self {
            nm,
            powers: POWERS.map(|p| u.powf(p)),
            ozone: OZONE_DU.map(|n| (-n * DOBSON_UNIT_M2 * sigma).exp()),
            air: AIR.map(|m| (-m * tau).exp()),
        })
    }

    /// C of two different wavelengths.
    fn covariance(&self, other: &Self) -> f64 {
        let apart = (self.nm - other.nm) / SMOOTH_NM;
        self.product(other) * (1.0 + ROUGH * ROUGH * (-0.5 * apart * apart).exp())
    }

    /// The mean of s(lambda) s(lambda').
    fn product(&self, other: &Self) -> f64 {
        fn mean<const N: usize>(a: &[f64; N], b: &[f64; N]) -> f64 {
            a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>() / N as f64
        }
        mean(&self.powers, &other.powers) * mean(&self.ozone, &other.ozone) * mean(&self.air, &other.air)
    }
}

impl<'a> Between<'a> {
    /// From these wavelengths in nm, increasing, at least one.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] if the cross-section refuses one.
    pub fn new(ozone: &'a OzoneCrossSection, nodes_nm: &[f64]) -> Result<Self, TableError> {
        let nodes = nodes_nm.iter().map(|&nm| Shapes::new(ozone, nm)).collect::<Result<Vec<_>, _>>()?;
        let gaps = nodes_nm.windows(2).max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
        let widest = gaps.map(|ends| 0.5 * (ends[0] + ends[1]));
        let mut alone = ALONE;
        loop {
            let between = Self::with(ozone, nodes.clone(), alone);
            let size = match widest {
                Some(middle) => between.weights(middle)?.iter().map(|w| w.abs()).sum(),
                None => 1.0,
            };
            if size <= LARGEST || alone >= 1.0 {
                return Ok(between);
            }
            alone *= RAISED;
        }
    }

    /// With this eta.
    fn with(ozone: &'a OzoneCrossSection, nodes: Vec<Shapes>, alone: f64) -> Self {
        let covariance = Cholesky::new(nodes.len(), |i, j| {
            let (a, b) = (&nodes[i], &nodes[j]);
            a.covariance(b) + if i == j { alone * alone * a.product(a) } else { 0.0 }
        });
        let mut constant = covariance.solve(&vec![1.0; nodes.len()]);
        let sum: f64 = constant.iter().sum();
        constant.iter_mut().for_each(|w| *w /= sum);
        Self { ozone, nodes, covariance, constant }
    }

    /// Weights by which values at the wavelengths become that at another in nm; at one of them the value itself, of which the estimate close to it
    /// takes the part that is not off by itself.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] if the cross-section refuses it.
    pub fn weights(&self, nm: f64) -> Result<Vec<f64>, TableError> {
        if let Some(known) = self.nodes.iter().position(|node| node.nm == nm) {
            return Ok((0..self.nodes.len()).map(|i| if i == known { 1.0 } else { 0.0 }).collect());
        }
        let [weights] = self.integral([(nm, [1.0])])?;
        Ok(weights)
    }

    /// Weights by which values become sums over wavelengths in nm, each with as many factors as there are sums.
    ///
    /// # Errors
    /// [`TableError::OutOfRange`] if the cross-section refuses one.
    pub fn integral<const N: usize>(
        &self,
        terms: impl IntoIterator<Item = (f64, [f64; N])>,
    ) -> Result<[Vec<f64>; N], TableError> {
        let (first, last) = (self.nodes[0].nm, self.nodes[self.nodes.len() - 1].nm);
        let reach = REACH_NM.min((last - first) / (self.nodes.len() - 1).max(1) as f64);
        let mut covariances: [Vec<f64>; N] = std::array::from_fn(|_| vec![0.0; self.nodes.len()]);
        let mut whole = [0.0; N];
        for (nm, factors) in terms {
            let here = Shapes::new(self.ozone, nm.clamp(first - reach, last + reach))?;
            for (i, node) in self.nodes.iter().enumerate() {
                let covariance = node.covariance(&here);
                covariances.iter_mut().zip(factors).for_each(|(sums, factor)| sums[i] += factor * covariance);
            }
            whole.iter_mut().zip(factors).for_each(|(sum, factor)| *sum += factor);
        }
        let mut sums = covariances.map(|c| self.covariance.solve(&c));
        for (weights, whole) in sums.iter_mut().zip(whole) {
            let left = whole - weights.iter().sum::<f64>();
            weights.iter_mut().zip(&self.constant).for_each(|(w, constant)| *w += left * constant);
        }
        Ok(sums)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::data::Data;
    use crate::spectrum::Wavelengths;
    use std::path::Path;

    fn ozone() -> OzoneCrossSection {
        Data::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../data")).expect("tables").ozone_cross_section
    }

    /// The largest error of a spectrum from `count` wavelengths, over its largest value, from 380 to 780 nm.
    fn worst(count: usize, f: impl Fn(f64) -> f64) -> f64 {
        let (ozone, wavelengths) = (ozone(), Wavelengths::visible(count).expect("valid"));
        let between = Between::new(&ozone, wavelengths.nm()).expect("in range");
        let values: Vec<f64> = wavelengths.nm().iter().map(|&nm| f(nm)).collect();
        let (mut error, mut largest) = (0.0_f64, 0.0_f64);
        for nm in (380..=780).map(f64::from) {
            let weights = between.weights(nm).expect("in range");
            let found: f64 = weights.iter().zip(&values).map(|(w, v)| w * v).sum();
            error = error.max((found - f(nm)).abs());
            largest = largest.max(f(nm));
        }
        error / largest
    }

    #[test]
    fn bands_of_ozone_between_wavelengths_are_known() {
        // Twilight that has gone through 5000 Dobson units, at powers and columns that are not among those of the covariance. Found: 1.0 and 0.15 %
        // of the largest.
        let ozone = ozone();
        let twilight = |nm: f64| {
            let u = MIDDLE_NM / nm;
            let sigma = ozone.cross_section_m2(nm, 235.0).expect("in range");
            u.powf(3.0) * (-5000.0 * DOBSON_UNIT_M2 * sigma - 2.5 * AIR_DEPTH * u.powf(4.0)).exp()
        };
        let (eight, sixteen) = (worst(8, twilight), worst(16, twilight));
        assert!(eight < 0.02 && sixteen < 0.003, "{eight} {sixteen}");
    }

    #[test]
    fn spectra_without_ozone_are_smooth() {
        // A ground that is green, seen in white light: nothing that the covariance was made for. Found: 2.7 and 0.23 %.
        let green = |nm: f64| 0.1 + 0.2 * (-0.5 * ((nm - MIDDLE_NM) / 40.0).powi(2)).exp();
        let (sixteen, many) = (worst(16, green), worst(41, green));
        assert!(sixteen < 0.04 && many < 0.004, "{sixteen} {many}");
        let molecules = worst(16, |nm| (MIDDLE_NM / nm).powi(4));
        assert!(molecules < 2e-3, "{molecules}");
    }

    #[test]
    fn no_list_makes_much_of_small_differences() {
        let ozone = ozone();
        let close: Vec<f64> = (0..50).map(|i| 500.0 + 0.002 * f64::from(i)).collect();
        let lists = [vec![400.0, 550.0, 551.0, 660.0], vec![300.0, 301.0, 302.0, 1000.0], vec![450.0, 451.0], close];
        for nodes in &lists {
            let between = Between::new(&ozone, nodes).expect("in range");
            for nm in (320..900).map(f64::from) {
                let size: f64 = between.weights(nm).expect("in range").iter().map(|w| w.abs()).sum();
                // The bound in the widest gap, which its middle is near to, and as much again beyond the ends.
                assert!(size < 2.0 * LARGEST, "{size} at {nm} of {nodes:?}");
            }
        }
    }

    #[test]
    fn what_is_known_is_kept_and_what_is_far_is_as_at_the_ends() {
        let ozone = ozone();
        let nodes = [400.0, 550.0, 551.0, 660.0];
        let between = Between::new(&ozone, &nodes).expect("in range");
        assert_eq!(between.weights(551.0).expect("in range"), [0.0, 0.0, 1.0, 0.0]);
        assert_eq!(between.weights(830.0).expect("in range"), between.weights(660.0 + REACH_NM).expect("in range"));
        for nm in [300.0, 390.0, 480.0, 550.5, 600.0, 720.0] {
            let weights = between.weights(nm).expect("in range");
            // A constant stays one: rounding only.
            assert!((weights.iter().sum::<f64>() - 1.0).abs() < 1e-12, "{weights:?}");
        }
        assert!(between.weights(2000.0).is_ok() && Between::new(&ozone, &[2000.0]).is_err());
        assert_eq!(Between::new(&ozone, &[500.0]).expect("in range").weights(600.0).expect("in range"), [1.0]);
    }
}
