"""Does Blender's Cycles see the same sky in what is exported for it? Radiances of plane layers, beside those of Airlight's path tracer.

    pip install bpy OpenEXR                                    # 5.0.1 and 3.4 were tried
    cargo build --release --bin airlight --bin airlight-tools
    python3 tests/programs/in_blender.py target/release [SAMPLES] # from the repository's root; samples of a pixel, 256 of them

Prints the radiances of red, green and blue (650, 550, 450 nm) for a sun of irradiance 1, of both, with their standard errors, and fails
where they differ by more than four of these and 3 % together: Blender's molecules scatter without depolarisation, which is up to 1.5 %
of their light.
"""

import math
import sys
import tempfile
from pathlib import Path

import bpy
import numpy
import OpenEXR
import shared

SAMPLES = int(sys.argv[2]) if len(sys.argv) > 2 else 1024
NM = [650.0, 550.0, 450.0]
VIEWS = [(0.0, 0.0), (60.0, 30.0), (80.0, 180.0), (150.0, 90.0)]


def airlight(folder, biome, view):
    """Its spectral radiances over the sun's irradiance."""
    haze = ["--biome", biome, "--phase", "hg"] if biome != "none" else []
    shared.trace(folder / "sky.exr", ",".join(f"{nm:g}" for nm in reversed(NM)), haze, view, SAMPLES)
    (part,) = OpenEXR.File(str(folder / "sky.exr")).parts
    pictures = [numpy.asarray(part.channels[f"S0.{nm:g},000nm"].pixels, dtype=float) for nm in NM]
    return [shared.mean(picture / shared.irradiance(nm)) for picture, nm in zip(pictures, NM)]


def blender(folder, zenith, azimuth):
    """Cycles' picture of the exported air over a ground, with a sun of irradiance 1."""
    camera = bpy.context.scene.camera
    # A camera looks along -z, and its x is to the right: first down the zenith angle from above, then about z.
    camera.rotation_mode = "XYZ"
    camera.rotation_euler = (math.radians(180 - zenith), 0.0, math.radians(azimuth - 90))
    bpy.context.scene.render.filepath = str(folder / "cycles.exr")
    bpy.ops.render.render(write_still=True)
    (part,) = OpenEXR.File(str(folder / "cycles.exr")).parts
    pixels = part.channels["RGBA"].pixels if "RGBA" in part.channels else part.channels["RGB"].pixels
    return shared.mean(numpy.asarray(pixels, dtype=float)[..., 0])


def stage(module, channel):
    """The air of one colour, ground, sun, camera and the settings of Cycles: every order of scattering, no clamping, no filter."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    air = {"__name__": "air"}
    exec(compile(module.read_text(), str(module), "exec"), air)
    air["plane_layers"](channel=channel)
    bpy.ops.mesh.primitive_plane_add(size=4000.0)
    ground = bpy.data.materials.new("ground")
    ground.use_nodes = True
    ground.node_tree.nodes.clear()
    diffuse = ground.node_tree.nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (shared.ALBEDO, shared.ALBEDO, shared.ALBEDO, 1.0)
    output = ground.node_tree.nodes.new("ShaderNodeOutputMaterial")
    ground.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    bpy.context.object.data.materials.append(ground)
    # The lamp shines along -z; turned about y its light comes from +x.
    bpy.ops.object.light_add(type="SUN", rotation=(0.0, math.radians(shared.SUN_ZENITH), 0.0))
    bpy.context.object.data.energy, bpy.context.object.data.angle = 1.0, 0.0
    bpy.ops.object.camera_add(location=(0.0, 0.0, 0.002))
    camera = scene.camera = bpy.context.object
    camera.data.clip_start, camera.data.clip_end, camera.data.angle = 1e-4, 1e5, math.radians(1.0)
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.use_adaptive_sampling, cycles.use_denoising = "CPU", SAMPLES, False, False
    cycles.max_bounces = cycles.diffuse_bounces = cycles.volume_bounces = 64
    cycles.transparent_max_bounces, cycles.sample_clamp_indirect, cycles.min_light_bounces = 64, 0.0, 64
    cycles.pixel_filter_type, cycles.light_sampling_threshold = "BOX", 0.0
    scene.render.resolution_x = scene.render.resolution_y = shared.SIZE
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.view_settings.view_transform = "Raw"


worst = 0.0
print("aerosol      nm  zenith  azimuth   Blender              Airlight             difference")
for biome in ["none", "rural"]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        shared.run("airlight-tools", "export", "--for", "blender", "--biome", biome, "-o", name)
        found = []
        for channel in range(3):
            stage(folder / "air.py", channel)
            found.append([blender(folder, *view) for view in VIEWS])
        for k, view in enumerate(VIEWS):
            for channel, right in enumerate(airlight(folder, biome, view)):
                (a, da), (b, db) = found[channel][k], right
                words, share = shared.compared(found[channel][k], right, 0.03)
                worst = max(worst, share)
                print(
                    f"{biome:10}{NM[channel]:5.0f}{view[0]:7.0f}{view[1]:9.0f}   {a:.5f} +- {da:.5f}   {b:.5f} +- {db:.5f}   {words}",
                    flush=True,
                )
shared.ends(worst)
