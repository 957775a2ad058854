//! Scenes spread over all that plans are for.

use crate::sampling::Sampler;
use crate::scene::{Albedo, Scene};
use tables::views::Biome;

/// Which scenes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Set {
    /// Those that plans are predicted from.
    Measured,
    /// Others, by which plans are judged.
    HeldOut,
}

impl Set {
    /// Atmospheres, and scenes of each.
    #[must_use]
    pub fn size(self) -> (usize, usize) {
        match self {
            Self::Measured => (240, 6),
            Self::HeldOut => (17, 6),
        }
    }

    /// Directions in which a scene is looked at, and the share of the way round that their azimuths are shifted by. Much of an error is where even
    /// ones hardly come, at the horizon and the limb: `study::towards_light`.
    #[must_use]
    pub fn directions(self) -> (u32, f64) {
        match self {
            Self::Measured => (256, 0.0),
            Self::HeldOut => (256, 0.5),
        }
    }

    fn seed(self) -> u64 {
        match self {
            Self::Measured => 0x0a12,
            Self::HeldOut => 0x4e1d,
        }
    }
}

/// Elevations of the sun go evenly with asinh((elevation + 1) / 3): densest at the horizon.
fn elevation(share: f64, (lowest, highest): (f64, f64)) -> f64 {
    let s = |elevation: f64| ((elevation + 1.0) / 3.0).asinh();
    3.0 * (s(lowest) + share * (s(highest) - s(lowest))).sinh() - 1.0
}

const SUNS: (f64, f64) = (-8.0, 90.0);
/// From space the ground below is looked at, in the sun or in twilight.
const SUNS_FROM_SPACE: (f64, f64) = (-6.0, 90.0);

/// Least and largest optical depth of aerosol, between which its logarithm is even.
const DEPTHS: (f64, f64) = (0.02, 0.8);

/// Scenes of one atmosphere over one ground: of ten one is clear, the others have the nine kinds of aerosol in turn.
#[must_use]
pub fn atmosphere(set: Set, number: usize) -> Vec<Scene> {
    let mut random = Sampler::new(set.seed(), number as u64, 0);
    let mut even = |low: f64, high: f64| low + (high - low) * random.uniform();
    let biome = number.checked_rem(10).filter(|kind| *kind > 0).map(|kind| Biome::ALL[kind - 1]);
    let depth = even(DEPTHS.0.ln(), DEPTHS.1.ln()).exp();
    let base = Scene {
        biome,
        aod: biome.map(|_| round(depth, 1e3)),
        // Dark grounds are the usual ones.
        albedo: Albedo::Grey(round(0.9 * even(0.0, 1.0).powi(2), 1e3)),
        month: 1 + even(0.0, 12.0).min(11.0) as u8,
        latitude_deg: even(-75.0, 75.0).round(),
        sun_disc: false,
        ..Scene::default()
    };
    let (_, count) = set.size();
    let scenes = (0..count).map(|i| {
        let share = (i as f64 + even(0.0, 1.0)) / count as f64;
        // Of seven in turn five are at the ground, one in the air, one in space; of those kept apart the last two of six may be anywhere.
        let place = match set {
            Set::Measured => [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 2.0][(number * count + i) % 7],
            Set::HeldOut => {
                if i >= 4 {
                    even(0.0, 3.0).floor()
                } else {
                    0.0
                }
            }
        };
        let altitude_km = match place {
            0.0 => 0.002,
            1.0 => round(even(0.5_f64.ln(), 15.0_f64.ln()).exp(), 1e3),
            _ => even(130.0_f64.ln(), 36_000.0_f64.ln()).exp().round(),
        };
        let suns = if altitude_km > 100.0 { SUNS_FROM_SPACE } else { SUNS };
        // The suns of a held-out atmosphere are anywhere.
        let share = if set == Set::HeldOut { even(0.0, 1.0) } else { share };
        Scene { altitude_km, sun_elevation_deg: round(elevation(share, suns), 1e2), ..base.clone() }
    });
    scenes.collect()
}

fn round(value: f64, steps: f64) -> f64 {
    (value * steps).round() / steps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_are_valid_and_the_two_sets_are_apart() {
        let all = |set: Set| -> Vec<Scene> { (0..set.size().0).flat_map(|i| atmosphere(set, i)).collect() };
        let (measured, held_out) = (all(Set::Measured), all(Set::HeldOut));
        assert!(held_out.len() >= 100 && measured.len() >= 700);
        for scene in measured.iter().chain(&held_out) {
            scene.validate().expect("valid");
        }
        assert!(held_out.iter().all(|scene| !measured.contains(scene)));
        let low = |scenes: &[Scene]| scenes.iter().filter(|scene| scene.sun_elevation_deg < 0.0).count();
        assert!(low(&held_out) > 15 && low(&measured) > 150, "{} {}", low(&held_out), low(&measured));
    }

    #[test]
    fn every_kind_of_aerosol_is_looked_at_from_everywhere() {
        // Of 24 atmospheres of 6 scenes a seventh is in the air and as much in space: 20 or 21; a sixth of all has each share of the suns.
        let (atmospheres, count) = Set::Measured.size();
        let mut seen = vec![[0; 2]; 10 + count];
        for number in 0..atmospheres {
            for (i, scene) in atmosphere(Set::Measured, number).iter().enumerate() {
                for row in [number % 10, 10 + i] {
                    seen[row][0] += usize::from((0.1..100.0).contains(&scene.altitude_km));
                    seen[row][1] += usize::from(scene.altitude_km > 100.0);
                }
            }
        }
        for (row, places) in seen.iter().enumerate() {
            let least = if row < 10 { 20 } else { 34 };
            assert!(places.iter().all(|&count| count >= least), "{row}: {places:?}");
        }
    }
}
