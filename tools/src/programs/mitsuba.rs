//! For Mitsuba 3: of each wavelength a scene of plane layers, 1 unit = 1 km, that any variant renders.
//!
//! The medium is `heterogeneous`; its extinction and albedo are grids (`gridvolume`, whose values belong to the middles of cells), its phase
//! function a tree of `blendphase` over `tabphase`, one of each species, with grids of the shares of scattering.

use super::{KM, Layered, Layers, single};
use crate::text::shortest;
use std::fmt::Write;

/// Half the width of the layers in km, and how far below the ground they go.
const HALF_WIDTH_KM: f64 = 2000.0;
const BELOW_KM: f64 = 0.1;

pub(super) fn files(layers: &Layers) -> Vec<(String, Vec<u8>)> {
    (0..layers.wavelengths_nm.len()).flat_map(|w| scene(layers, w)).collect()
}

/// The scene of a wavelength, and its grids.
fn scene(layers: &Layers, w: usize) -> Vec<(String, Vec<u8>)> {
    let nm = shortest(layers.wavelengths_nm[w]);
    let per_km = |i: usize, of: fn(&Layered) -> &[Vec<f64>]| KM * layers.sum(w, i, of);
    let scattering: Vec<f64> = (0..layers.count).map(|i| per_km(i, |one| &one.scattering)).collect();
    let extinction: Vec<f64> = (0..layers.count).map(|i| scattering[i] + per_km(i, |one| &one.absorption)).collect();
    let ratio = |(a, b): (&f64, &f64)| if *b > 0.0 { a / b } else { 0.0 };
    let albedo: Vec<f64> = scattering.iter().zip(&extinction).map(ratio).collect();
    let mut files =
        vec![(format!("extinction-{nm}nm.vol"), volume(&extinction)), (format!("albedo-{nm}nm.vol"), volume(&albedo))];
    let phase = phase(layers, w, &nm, &mut files);
    let header: String = layers.header("1 unit = 1 km, extinction in km^-1, phase functions in sr^-1").join("\n     ");
    let text = format!(
        r#"<?xml version="1.0" encoding="utf-8"?>
<!-- {header} -->
<scene version="3.0.0">
  <!-- The sun's zenith angle and its azimuth from x to y in degrees, its irradiance; the ground's albedo; the view's zenith angle, azimuth
       and width in degrees; the observer's altitude in km; size, samples. -->
  <default name="sun_zenith" value="60"/>
  <default name="sun_azimuth" value="0"/>
  <default name="irradiance" value="1"/>
  <default name="albedo" value="0.1"/>
  <default name="view_zenith" value="0"/>
  <default name="view_azimuth" value="0"/>
  <default name="view_width" value="1"/>
  <default name="altitude" value="0.002"/>
  <default name="size" value="16"/>
  <default name="spp" value="256"/>
  <integrator type="volpath"><integer name="max_depth" value="-1"/><integer name="rr_depth" value="64"/></integrator>
  <medium type="heterogeneous" id="air">
{extinction}{albedo}{phase}  </medium>
  <emitter type="directional">
    <transform name="to_world"><lookat origin="0,0,0" target="0,0,-1" up="0,1,0"/><rotate y="1" angle="$sun_zenith"/><rotate z="1" angle="$sun_azimuth"/></transform>
    <spectrum name="irradiance" value="$irradiance"/>
  </emitter>
  <shape type="rectangle">
    <transform name="to_world"><scale x="{HALF_WIDTH_KM}" y="{HALF_WIDTH_KM}"/></transform>
    <bsdf type="diffuse"><spectrum name="reflectance" value="$albedo"/></bsdf>
  </shape>
  <shape type="cube">
    <transform name="to_world"><scale x="{HALF_WIDTH_KM}" y="{HALF_WIDTH_KM}" z="{half}"/><translate z="{middle}"/></transform>
    <bsdf type="null"/>
    <ref name="interior" id="air"/>
  </shape>
  <sensor type="perspective">
    <float name="fov" value="$view_width"/>
    <float name="near_clip" value="1e-4"/>
    <float name="far_clip" value="1e6"/>
    <transform name="to_world"><lookat origin="0,0,0" target="0,0,1" up="-1,0,0"/><rotate y="1" angle="$view_zenith"/><rotate z="1" angle="$view_azimuth"/><translate z="$altitude"/></transform>
    <ref name="medium" id="air"/>
    <film type="hdrfilm">
      <integer name="width" value="$size"/><integer name="height" value="$size"/>
      <string name="pixel_format" value="luminance"/><string name="component_format" value="float32"/>
      <rfilter type="box"/>
    </film>
    <sampler type="independent"><integer name="sample_count" value="$spp"/></sampler>
  </sensor>
</scene>
"#,
        extinction = grid(layers, "sigma_t", &format!("extinction-{nm}nm.vol")),
        albedo = grid(layers, "albedo", &format!("albedo-{nm}nm.vol")),
        half = 0.5 * (layers.top_km() + BELOW_KM),
        middle = 0.5 * (layers.top_km() - BELOW_KM),
    );
    files.push((format!("scene-{nm}nm.xml"), text.into_bytes()));
    files
}

/// The phase function of all scatterers, and its grids: the first with its share against the rest, and so on.
fn phase(layers: &Layers, w: usize, nm: &str, files: &mut Vec<(String, Vec<u8>)>) -> String {
    let scatterers: Vec<&Layered> = layers.scatterers().collect();
    let mut text = String::new();
    let last = scatterers.len() - 1;
    // Writing to a String does not fail.
    for (k, one) in scatterers.iter().enumerate() {
        if k < last {
            let rest = |i: usize| scatterers[k + 1..].iter().map(|one| one.scattering[w][i]).sum::<f64>();
            let share = |i: usize| {
                let (here, rest) = (one.scattering[w][i], rest(i));
                if rest > 0.0 { rest / (here + rest) } else { 0.0 }
            };
            let file = format!("beyond-{}-{nm}nm.vol", one.name);
            let _ = write!(text, "    <phase type=\"blendphase\">\n{}", grid(layers, "weight", &file));
            files.push((file, volume(&(0..layers.count).map(share).collect::<Vec<_>>())));
        }
        let values: Vec<String> = one.phase[w].iter().map(|&value| single(value)).collect();
        let (name, values) = (&one.name, values.join(", "));
        let _ = writeln!(
            text,
            r#"    <phase type="tabphase"><!-- {name} --><string name="values" value="{values}"/></phase>"#
        );
    }
    text.push_str(&"    </phase>\n".repeat(last));
    text
}

/// What a file holds, over the layers.
fn grid(layers: &Layers, name: &str, file: &str) -> String {
    let (width, top) = (2.0 * HALF_WIDTH_KM, layers.top_km());
    format!(
        r#"    <volume type="gridvolume" name="{name}">
      <string name="filename" value="{file}"/>
      <boolean name="raw" value="true"/>
      <transform name="to_world"><scale x="{width}" y="{width}" z="{top}"/><translate x="-{HALF_WIDTH_KM}" y="-{HALF_WIDTH_KM}"/></transform>
    </volume>
"#
    )
}

/// A grid of one column of cells in Mitsuba's format, version 3: signature, encoding (1: 32-bit floats), cells along x, y and z, channels,
/// a box, then the cells, x fastest.
fn volume(cells: &[f64]) -> Vec<u8> {
    let mut bytes = b"VOL\x03".to_vec();
    for number in [1, 1, 1, cells.len() as i32, 1] {
        bytes.extend(number.to_le_bytes());
    }
    for end in [0.0_f32, 0.0, 0.0, 1.0, 1.0, 1.0] {
        bytes.extend(end.to_le_bytes());
    }
    bytes.extend(cells.iter().flat_map(|&cell| (cell as f32).to_le_bytes()));
    bytes
}
