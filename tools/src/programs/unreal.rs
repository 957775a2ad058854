//! For Unreal Engine: the properties of a `SkyAtmosphereComponent`, as JSON and as a script for the editor's Python.
//!
//! The component knows exponential profiles of molecules and of one aerosol, and a tent of what absorbs alone: each has the optical depths and
//! the mean altitude of the tables.

use super::fit::{Exponential, Tent};
use super::{KM, Layered, Layers, Role};
use serde_json::{Value, json};
use tables::units::EARTH_RADIUS_M;

pub(super) fn files(layers: &Layers) -> Vec<(String, Vec<u8>)> {
    let of = |role: Role| -> Vec<&Layered> { layers.species.iter().filter(|one| one.role == role).collect() };
    let (molecules, ozone, aerosol) = (of(Role::Molecules), of(Role::Ozone), of(Role::Aerosol));
    let top = layers.top_km();
    let depth = |species: &[&Layered], w: usize, part: fn(&Layered) -> &[Vec<f64>]| -> f64 {
        layers.step_m * species.iter().flat_map(|one| &part(one)[w]).sum::<f64>()
    };
    let scattering: fn(&Layered) -> &[Vec<f64>] = |one| &one.scattering;
    let absorption: fn(&Layered) -> &[Vec<f64>] = |one| &one.absorption;
    // A colour of at most 1, and what it is multiplied with.
    let colour = |values: [f64; 3]| -> (Value, f64) {
        let most = values.into_iter().fold(0.0, f64::max);
        let [r, g, b] = values.map(|value| if most > 0.0 { value / most } else { 0.0 });
        (json!({ "r": r, "g": g, "b": b }), most)
    };
    let air = Exponential::of(layers, &molecules);
    let (rayleigh, rayleigh_scale) = colour([0, 1, 2].map(|w| air.at_ground(depth(&molecules, w, scattering), top)));
    let tent = Tent::of(layers, &ozone);
    let (other, other_scale) = colour([0, 1, 2].map(|w| tent.at_tip(depth(&ozone, w, absorption))));
    let mut properties = json!({
        "bottom_radius": EARTH_RADIUS_M / KM,
        "atmosphere_height": top,
        "rayleigh_scattering": rayleigh,
        "rayleigh_scattering_scale": rayleigh_scale,
        "rayleigh_exponential_distribution": air.scale_km,
        "other_absorption": other,
        "other_absorption_scale": other_scale,
        "other_tent_distribution": { "tip_altitude": tent.tip_km, "tip_value": 1.0, "width": tent.half_km },
        "mie_scattering_scale": 0.0,
        "mie_absorption_scale": 0.0,
    });
    if !aerosol.is_empty() {
        let haze = Exponential::of(layers, &aerosol);
        let ground = |part| [0, 1, 2].map(|w| haze.at_ground(depth(&aerosol, w, part), top));
        let (mie, mie_scale) = colour(ground(scattering));
        let (absorbed, absorbed_scale) = colour(ground(absorption));
        let forward: f64 = aerosol.iter().map(|one| one.asymmetry[1] * one.scattering[1].iter().sum::<f64>()).sum();
        let all: f64 = aerosol.iter().flat_map(|one| &one.scattering[1]).sum();
        for (name, value) in [
            ("mie_scattering", mie),
            ("mie_scattering_scale", json!(mie_scale)),
            ("mie_absorption", absorbed),
            ("mie_absorption_scale", json!(absorbed_scale)),
            ("mie_anisotropy", json!(forward / all)),
            ("mie_exponential_distribution", json!(haze.scale_km)),
        ] {
            properties[name] = value;
        }
    }
    let about =
        layers.header("coefficients in km^-1, altitudes in km; profiles fitted (optical depth and mean altitude kept)");
    let file = json!({ "about": about, "SkyAtmosphereComponent": properties });
    let text = format!("{file:#}\n");
    let script = format!(
        r#"# {about}
# In the editor: py "sky_atmosphere.py" with a SkyAtmosphere in the level.
import json, os, unreal

with open(os.path.join(os.path.dirname(os.path.abspath(__file__)), "sky_atmosphere.json")) as file:
    properties = json.load(file)["SkyAtmosphereComponent"]
actors = unreal.get_editor_subsystem(unreal.EditorActorSubsystem).get_all_level_actors()
skies = [actor for actor in actors if isinstance(actor, unreal.SkyAtmosphere)]
if len(skies) != 1:
    raise RuntimeError(f"{{len(skies)}} SkyAtmosphere actors in the level: one is wanted")
component = skies[0].get_component_by_class(unreal.SkyAtmosphereComponent)
for name, value in properties.items():
    if name == "other_tent_distribution":
        tent = component.get_editor_property(name)
        for key, number in value.items():
            tent.set_editor_property(key, number)
        value = tent
    elif isinstance(value, dict):
        value = unreal.LinearColor(value["r"], value["g"], value["b"], 1.0)
    component.set_editor_property(name, value)
"#,
        about = about.join("\n# "),
    );
    vec![("sky_atmosphere.json".into(), text.into_bytes()), ("sky_atmosphere.py".into(), script.into_bytes())]
}
