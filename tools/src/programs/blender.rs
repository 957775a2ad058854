//! For Blender 4.3 or later: a script that makes a volume material and, if it is run as it is, plane layers with it; 1 unit = 1 km.
//!
//! Each species that scatters has an image of one row, its coefficients against altitude as shares of the largest, that a scattering node
//! multiplies with that largest; what all absorb has one of its own. Molecules scatter by Blender's Rayleigh phase function, aerosol by Henyey and Greenstein's of its g at
//! the second wavelength.

use super::{KM, Layers, Role};
use serde_json::json;
use tables::units::EARTH_RADIUS_M;

pub(super) fn files(layers: &Layers) -> Vec<(String, Vec<u8>)> {
    let scatterers: Vec<_> = layers
        .scatterers()
        .map(|one| {
            json!({
                "name": one.name,
                "rayleigh": one.role == Role::Molecules,
                "g": one.asymmetry,
                "scattering": shares(layers, |w, i| one.scattering[w][i]),
            })
        })
        .collect();
    let absorption = shares(layers, |w, i| layers.sum(w, i, |one| &one.absorption));
    let (top, radius) = (layers.top_km(), EARTH_RADIUS_M / KM);
    let data = json!({ "top": top, "radius": radius, "scatterers": scatterers, "absorption": absorption });
    let about = layers.header("1 unit = 1 km, coefficients in km^-1").join("\n# ");
    let text = format!("# {about}\n{SCRIPT_HEAD}DATA = json.loads(\"\"\"{data}\"\"\")\n{SCRIPT}");
    vec![("air.py".into(), text.into_bytes())]
}

/// The largest coefficient in km^-1, and the shares of it from the ground to the top, red, green and blue in turn.
fn shares(layers: &Layers, coefficient: impl Fn(usize, usize) -> f64) -> serde_json::Value {
    let places = (0..layers.count).flat_map(|i| (0..3).map(move |w| (w, i)));
    let coefficients: Vec<f64> = places.map(|(w, i)| coefficient(w, i)).collect();
    let peak = coefficients.iter().copied().fold(0.0, f64::max);
    // Seven digits of single precision.
    let share = |value: &f64| if peak > 0.0 { (value / peak * 1e8).round() / 1e8 } else { 0.0 };
    json!({ "peak": KM * peak, "shares": coefficients.iter().map(share).collect::<Vec<f64>>() })
}

const SCRIPT_HEAD: &str = r#"# In Blender: Scripting > Open > Run, or `blender --python air.py`. As a module: material(), plane_layers().
# Cycles seems to mix the phase functions of several species alike for red, green and blue. Where that matters, in haze, render three grey
# pictures with channel=0, 1 and 2, which also have their own g, and put them together.
import json

import bpy

"#;

const SCRIPT: &str = r#"

def image(name, shares, channel):
    """A row of pixels, the ground first, that textures read between their middles; of one channel grey."""
    made = bpy.data.images.new(name, width=len(shares) // 3, height=1, alpha=False, float_buffer=True, is_data=True)
    made.use_half_precision = False
    pixels = []
    for i in range(0, len(shares), 3):
        colour = shares[i : i + 3] if channel is None else [shares[i + channel]] * 3
        pixels += [*colour, 1.0]
    made.pixels.foreach_set(pixels)
    made.pack()
    return made


def material(planet=False, channel=None):
    """The air as a volume: altitude is z, or, of a planet about the origin, the distance from it less its radius. Of one channel, or all."""
    made = bpy.data.materials.new("Airlight air")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()

    def node(kind, **settings):
        one = nodes.new(kind)
        for key, value in settings.items():
            setattr(one, key, value)
        return one

    position = node("ShaderNodeNewGeometry").outputs["Position"]
    if planet:
        length = node("ShaderNodeVectorMath", operation="LENGTH")
        links.new(position, length.inputs[0])
        above = node("ShaderNodeMath", operation="SUBTRACT")
        links.new(length.outputs["Value"], above.inputs[0])
        above.inputs[1].default_value = DATA["radius"]
        altitude = above.outputs[0]
    else:
        split = node("ShaderNodeSeparateXYZ")
        links.new(position, split.inputs[0])
        altitude = split.outputs["Z"]
    share = node("ShaderNodeMath", operation="DIVIDE")
    links.new(altitude, share.inputs[0])
    share.inputs[1].default_value = DATA["top"]
    place = node("ShaderNodeCombineXYZ")
    links.new(share.outputs[0], place.inputs["X"])
    place.inputs["Y"].default_value = 0.5

    def profile(name, part):
        texture = node("ShaderNodeTexImage", interpolation="Linear", extension="EXTEND")
        texture.image = image(name, part["shares"], channel)
        links.new(place.outputs[0], texture.inputs["Vector"])
        return texture.outputs["Color"]

    volumes = []
    for one in DATA["scatterers"]:
        volume = node("ShaderNodeVolumeScatter")
        volume.phase = "RAYLEIGH" if one["rayleigh"] else "HENYEY_GREENSTEIN"
        if not one["rayleigh"]:
            volume.inputs["Anisotropy"].default_value = one["g"][1 if channel is None else channel]
        links.new(profile(one["name"], one["scattering"]), volume.inputs["Color"])
        volume.inputs["Density"].default_value = one["scattering"]["peak"]
        volumes.append(volume.outputs[0])
    # The node absorbs what its colour lacks of white.
    volume = node("ShaderNodeVolumeAbsorption")
    lack = node("ShaderNodeVectorMath", operation="SUBTRACT")
    lack.inputs[0].default_value = (1.0, 1.0, 1.0)
    links.new(profile("absorption", DATA["absorption"]), lack.inputs[1])
    links.new(lack.outputs[0], volume.inputs["Color"])
    volume.inputs["Density"].default_value = DATA["absorption"]["peak"]
    volumes.append(volume.outputs[0])
    # In pairs: Cycles counts closures of a chain of sums as if each doubled them.
    while len(volumes) > 1:
        both = node("ShaderNodeAddShader")
        links.new(volumes.pop(0), both.inputs[0])
        links.new(volumes.pop(0), both.inputs[1])
        volumes.append(both.outputs[0])
    links.new(volumes[0], node("ShaderNodeOutputMaterial").inputs["Volume"])
    return made


def plane_layers(half_width=2000.0, top=50.0, channel=None):
    """A box of air from a little below z = 0, where the ground belongs, so many km to each side and high: Cycles looks for the densest air
    in 128 layers of the box, which is right if they are thin, and less than a thousandth of the air is above 50 km."""
    below = 0.1
    bpy.ops.mesh.primitive_cube_add(size=1.0, location=(0.0, 0.0, (top - below) / 2))
    box = bpy.context.object
    box.name = "Airlight air"
    box.scale = (2.0 * half_width, 2.0 * half_width, top + below)
    box.data.materials.append(material(channel=channel))
    return box


if __name__ == "__main__":
    plane_layers()
"#;
