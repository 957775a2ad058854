//! Exposures of frames that follow each other.

/// Width of the weights over the number of frames.
const WIDTH: f64 = 1.0 / 24.0;

/// The least width in frames.
const LEAST: f64 = 1.0;

/// Exposure values that follow those given without a jump: the means of their neighbours with the weights exp(-(i - j)^2 / (2 s^2)), normalised
/// to 1, s = n/24 frames of n, at least one. Exposure values are logarithms, so this is smooth to an eye.
///
/// Whatever is given, two neighbours differ by at most 2 phi(0) / s = 0.80 / s of the range of what is given (phi of the normal
/// distribution; 2, since at an end half the weights are missing): by 8 % of it for 240 frames. Values that go up or down go on doing so.
#[must_use]
pub fn smooth(exposures_ev: &[f64]) -> Vec<f64> {
    let count = exposures_ev.len();
    let width = (WIDTH * count as f64).max(LEAST);
    let mean = |i: usize| {
        let (mut sum, mut weights) = (0.0, 0.0);
        for (j, ev) in exposures_ev.iter().enumerate() {
            let apart = (i as f64 - j as f64) / width;
            let weight = (-0.5 * apart * apart).exp();
            sum += weight * ev;
            weights += weight;
        }
        sum / weights
    };
    (0..count).map(mean).collect()
}

/// The largest difference of two neighbours.
#[must_use]
pub fn steepest(values: &[f64]) -> f64 {
    values.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_jump_becomes_a_bounded_step_wherever_it_is() {
        for count in [2, 10, 48, 240] {
            let bound = 0.8 / (WIDTH * f64::from(count)).max(LEAST);
            for jump in 1..count {
                let given: Vec<f64> = (0..count).map(|i| if i < jump { 15.0 } else { 3.0 }).collect();
                let smooth = smooth(&given);
                // By the sum instead of the integral of the weights the bound is exceeded by less than 1 % from s = 1 on.
                assert!(steepest(&smooth) <= 1.01 * 12.0 * bound, "{count} {jump}: {}", steepest(&smooth));
                assert!(smooth.windows(2).all(|pair| pair[0] >= pair[1] - 1e-13), "{count} {jump}: goes down only");
            }
        }
    }

    #[test]
    fn flicker_goes_and_an_even_exposure_stays() {
        let flickering: Vec<f64> = (0..120).map(|i| if i % 2 == 0 { 9.9 } else { 10.1 }).collect();
        // A mean with s = 5 frames leaves exp(-(5 pi)^2 / 2) of an alternation, and some of it at the ends, where weights are missing:
        // at most half of one weight of the end, 0.1 / (5 sqrt(2 pi)).
        assert!(steepest(&smooth(&flickering)) < 0.01, "{}", steepest(&smooth(&flickering)));
        assert!(smooth(&[7.0; 9]).iter().all(|ev| (ev - 7.0).abs() < 1e-14));
        assert_eq!(smooth(&[4.0]), [4.0]);
        assert_eq!(steepest(&[4.0]), 0.0);
    }
}
