"""Does Blender see the sun of a map by `airlight light --for blender` where the map's JSON says, and the light that is in the map?

    pip install bpy OpenEXR                                    # 5.0.1 and 3.5 were tried
    cargo build --release --bin airlight
    python3 tests/programs/map_in_blender.py target/release    # from the repository's root

What is looked at, and when it fails: `look_at_suns` in shared.py.
"""

import bpy
import mathutils
import numpy
import OpenEXR
import shared


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


shared.look_at_suns("blender", render)
