//! For pbrt-v4: a medium of plane layers, `rgbgrid`, 1 unit = 1 km, z upwards.
//!
//! A medium of pbrt has one phase function, Henyey and Greenstein's: its g here is the mean over all scattering at the second wavelength.

use super::{KM, Layered, Layers, single};
use std::fmt::Write;

/// Half the width of the layers in km.
const HALF_WIDTH_KM: f64 = 2000.0;

pub(super) fn files(layers: &Layers) -> Vec<(String, Vec<u8>)> {
    let mut text = String::new();
    // Writing to a String does not fail.
    for line in layers.header("1 unit = 1 km, coefficients in km^-1") {
        let _ = writeln!(text, "# {line}");
    }
    let (count, top, g) = (layers.count, layers.top_km(), layers.asymmetry(1));
    let _ = write!(
        text,
        r#"# One phase function for all: Henyey and Greenstein's.
MakeNamedMedium "air"
  "string type" "rgbgrid"
  "integer nx" [ 1 ] "integer ny" [ 1 ] "integer nz" [ {count} ]
  "point3 p0" [ -{HALF_WIDTH_KM} -{HALF_WIDTH_KM} 0 ] "point3 p1" [ {HALF_WIDTH_KM} {HALF_WIDTH_KM} {top} ]
  "float g" [ {g:.6} ]
  "float scale" [ 1 ]
"#
    );
    let mut grid = |name: &str, of: fn(&Layered) -> &[Vec<f64>]| {
        let _ = writeln!(text, "  \"rgb {name}\" [");
        for i in 0..count {
            let [r, g, b] = [0, 1, 2].map(|w| single(KM * layers.sum(w, i, of)));
            let _ = writeln!(text, "    {r} {g} {b}");
        }
        let _ = writeln!(text, "  ]");
    };
    grid("sigma_s", |one| &one.scattering);
    grid("sigma_a", |one| &one.absorption);
    vec![("air.pbrt".into(), text.into_bytes())]
}
