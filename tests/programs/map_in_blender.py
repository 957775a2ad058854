"""Does Blender see the sun of a map by `airlight light --for blender` where the map's JSON says, and the light that is in the map?

    pip install bpy OpenEXR                                    # 5.0.1 and 3.5 were tried
    cargo build --release --bin airlight
    python3 tests/programs/map_in_blender.py target/release    # from the repository's root

Looks along the direction to the sun: the brightest pixel of 31 x 31 over 10 degrees is to be the middle one, or beside it, and what is seen
within 10 degrees, less the sky at the edge of the picture, is to be the sun's irradiance of the JSON file within 3 %.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import bpy
import mathutils
import numpy
import OpenEXR


def render(path, to_sun):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    world = scene.world = bpy.data.worlds.new("sky")
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    nodes.clear()
    texture = nodes.new("ShaderNodeTexEnvironment")
    texture.image = bpy.data.images.load(str(path))
    texture.image.colorspace_settings.name = "Linear Rec.709"
    background, output = nodes.new("ShaderNodeBackground"), nodes.new("ShaderNodeOutputWorld")
    links.new(texture.outputs["Color"], background.inputs["Color"])
    links.new(background.outputs[0], output.inputs["Surface"])
    bpy.ops.object.camera_add()
    camera = scene.camera = bpy.context.object
    camera.rotation_mode, camera.data.angle = "QUATERNION", numpy.radians(10.0)
    camera.rotation_quaternion = mathutils.Vector(to_sun).to_track_quat("-Z", "Y")
    scene.render.engine, scene.cycles.device, scene.cycles.samples = "CYCLES", "CPU", 256
    scene.cycles.use_denoising, scene.cycles.use_adaptive_sampling, scene.cycles.pixel_filter_type = False, False, "BOX"
    scene.render.resolution_x = scene.render.resolution_y = 31
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.view_settings.view_transform = "Raw"
    scene.render.filepath = str(path.with_name("seen.exr"))
    bpy.ops.render.render(write_still=True)
    (part,) = OpenEXR.File(scene.render.filepath).parts
    pixels = part.channels["RGBA"].pixels if "RGBA" in part.channels else part.channels["RGB"].pixels
    return numpy.asarray(pixels, dtype=float)[..., :3]


good = True
for azimuth in (130, 215, 350):
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "sky.exr"
        words = ["--for", "blender", "--sun-elevation", "20", "--sun-azimuth", str(azimuth), "--width", "1024"]
        subprocess.run([Path(sys.argv[1]) / "airlight", "light", *words, "--sun-disc", "on", "-o", path], check=True, capture_output=True)
        said = json.loads(path.with_suffix(".json").read_text())
        to_sun, sun = said["sun"]["direction_to_sun"], said["sun"]["normal_irradiance_rgb"]
        seen = render(path, to_sun)
        row, column = numpy.unravel_index(seen[..., 1].argmax(), seen.shape[:2])
        # A pixel (x, y) of a plane at distance 1 is seen from it in the solid angle dx dy / (1 + x^2 + y^2)^(3/2).
        half = numpy.tan(numpy.radians(5.0))
        across = (numpy.arange(31) + 0.5) / 31 * 2 * half - half
        solid = (2 * half / 31) ** 2 / (1 + across[:, None] ** 2 + across[None, :] ** 2) ** 1.5
        sky = numpy.concatenate([seen[0], seen[-1], seen[:, 0], seen[:, -1]]).mean(axis=0)
        off = ((seen - sky) * solid[..., None]).sum(axis=(0, 1)) / sun - 1
        near = abs(row - 15) <= 1 and abs(column - 15) <= 1
        good &= bool(near and (abs(off) < 0.03).all())
        percent = ", ".join(f"{100 * value:+.1f}" for value in off)
        print(f"sun at azimuth {azimuth}: brightest pixel {row}, {column} of 31 x 31 (middle 15, 15); irradiance off by {percent} % (RGB)")
sys.exit(0 if good else 1)
