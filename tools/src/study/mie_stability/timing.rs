//! Speed of the variants, and their error where they are timed.

use super::variants::{self, Method, Variant};
use crate::mie::{MieError, RefractiveIndex, Spheres};
use std::time::{Duration, Instant};

/// A variant at 1000 spheres, x from 0.01 to 1000 in equal factors, m = 1.5 + 0.01i.
#[derive(Debug, Clone, Copy)]
pub(in crate::study) struct Timed {
    /// Its name.
    pub(in crate::study) key: &'static str,
    pub(in crate::study) spheres_per_second: f64,
    /// The largest of Qext, Qsca and g; infinite if a number is none.
    pub(in crate::study) largest_relative_error: f64,
}

/// For so long at least each variant is timed.
const AT_LEAST: Duration = Duration::from_millis(300);

/// The variants in the series' own form, on one thread, each with its error against [`crate::mie`], which is right to
/// 1e-14 at these spheres (see the peers' file, where it is compared with arbitrary precision). Slower than a solver
/// needs to be: they allocate for each sphere.
pub(in crate::study) fn timed() -> Result<Vec<Timed>, MieError> {
    let (n, k) = (1.5, 0.01);
    let x: Vec<f64> = (0..1000).map(|i| 0.01 * 1e5_f64.powf(f64::from(i) / 999.0)).collect();
    let exact = Spheres::new().efficiencies(RefractiveIndex::new(n, k)?, &x)?;
    let mut all: Vec<Variant> = variants::groups().into_iter().flat_map(|group| group.variants).collect();
    all.retain(|variant| matches!(variant.method, Method::Double(_) | Method::Single(_)));
    let mut result: Vec<Timed> = Vec::new();
    for variant in all {
        if result.iter().any(|timed| timed.key == variant.key) {
            continue;
        }
        let mut fastest = Duration::MAX;
        let mut error = 0.0_f64;
        let begin = Instant::now();
        while fastest == Duration::MAX || begin.elapsed() < AT_LEAST {
            let start = Instant::now();
            error = 0.0;
            for (&x, exact) in x.iter().zip(&exact) {
                let q = variant.solve(x, (n, k))?;
                let pairs = [
                    (q.extinction, exact.extinction),
                    (q.scattering, exact.scattering),
                    (q.asymmetry, exact.asymmetry),
                ];
                for (found, exact) in pairs {
                    let one = (found / exact - 1.0).abs();
                    error = if one.is_nan() { f64::INFINITY } else { error.max(one) };
                }
            }
            fastest = fastest.min(start.elapsed());
        }
        let spheres_per_second = x.len() as f64 / fastest.as_secs_f64();
        result.push(Timed { key: variant.key, spheres_per_second, largest_relative_error: error });
    }
    Ok(result)
}
