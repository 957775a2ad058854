"""Does Blender's Cycles see the same sky in what is exported for it? Radiances of plane layers, beside those of Airlight's path tracer.

    pip install bpy OpenEXR                                    # 5.0.1 and 3.4 were tried
    cargo build --release --bin airlight --bin airlight-tools
    python3 tests/programs/in_blender.py target/release [SAMPLES] # from the repository's root; samples of a pixel, 256 of them

Prints the radiances of red, green and blue (650, 550, 450 nm) for a sun of irradiance 1, of both, with their standard errors, and fails
where they differ by more than four of these and 3 % together: Blender's molecules scatter without depolarisation, which is up to 1.5 %
of their light.
"""

import io
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import bpy
import numpy
import OpenEXR

PROGRAMS, SAMPLES = Path(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) > 2 else 1024
SIZE, SUN_ZENITH, ALBEDO, NM = 16, 60.0, 0.3, [650.0, 550.0, 450.0]
VIEWS = [(0.0, 0.0), (60.0, 30.0), (80.0, 180.0), (150.0, 90.0)]


def run(program, *words):
    return subprocess.run([PROGRAMS / program, *words], check=True, capture_output=True, text=True).stdout


def mean(pixels):
    """The mean over pixels that are as good as equal, and its standard error."""
    return pixels.mean(), pixels.std(ddof=1) / math.sqrt(pixels.size)


def airlight(folder, biome, irradiance, zenith, azimuth):
    """Its spectral radiances over the sun's irradiance."""
    haze = ["--biome", biome, "--phase", "hg"] if biome != "none" else []
    scene = ["--flat", "--method", "paths", "--wavelengths", ",".join(f"{nm:g}" for nm in reversed(NM)), *haze]
    sun = ["--sun-elevation", str(90 - SUN_ZENITH), "--sun-azimuth", "0", "--sun-shape", "point", "--albedo", str(ALBEDO)]
    view = ["--camera", "pinhole", "--fov", "1", f"--view-elevation={90 - zenith}", f"--view-azimuth={azimuth}"]
    size = ["--width", str(SIZE), "--height", str(SIZE), "--spp", str(SAMPLES), "--spectral", "--follow-polarisation=off"]
    run("airlight", "render", *scene, *sun, *view, *size, "--quiet", "-o", str(folder / "sky.exr"))
    (part,) = OpenEXR.File(str(folder / "sky.exr")).parts
    pictures = [numpy.asarray(part.channels[f"S0.{nm:g},000nm"].pixels, dtype=float) for nm in NM]
    return [mean(picture / sun) for picture, sun in zip(pictures, irradiance)]


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
    return mean(numpy.asarray(pixels, dtype=float)[..., 0])


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
    diffuse.inputs["Color"].default_value = (ALBEDO, ALBEDO, ALBEDO, 1.0)
    output = ground.node_tree.nodes.new("ShaderNodeOutputMaterial")
    ground.node_tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    bpy.context.object.data.materials.append(ground)
    # The lamp shines along -z; turned about y its light comes from +x.
    bpy.ops.object.light_add(type="SUN", rotation=(0.0, math.radians(SUN_ZENITH), 0.0))
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
    scene.render.resolution_x = scene.render.resolution_y = SIZE
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format, scene.render.image_settings.color_depth = "OPEN_EXR", "32"
    scene.view_settings.view_transform = "Raw"


rows = numpy.loadtxt(
    io.StringIO(run("airlight-tools", "export", "data/sun.table", "--field", "irradiance", "--bare")), delimiter=",", skiprows=1
)
irradiance = numpy.interp(NM, rows[:, 0], rows[:, 1])
worst = 0.0
print("aerosol      nm  zenith  azimuth   Blender              Airlight             difference")
for biome in ["none", "rural"]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run("airlight-tools", "export", "--for", "blender", "--biome", biome, "-o", name)
        found = []
        for channel in range(3):
            stage(folder / "air.py", channel)
            found.append([blender(folder, *view) for view in VIEWS])
        for k, (zenith, azimuth) in enumerate(VIEWS):
            for channel, (b, db) in enumerate(airlight(folder, biome, irradiance, zenith, azimuth)):
                a, da = found[channel][k]
                allowed = 4 * math.hypot(da, db) + 0.03 * b
                worst = max(worst, abs(a - b) / allowed)
                print(
                    f"{biome:10}{NM[channel]:5.0f}{zenith:7.0f}{azimuth:9.0f}   {a:.5f} +- {da:.5f}   {b:.5f} +- {db:.5f}"
                    f"   {100 * (a / b - 1):+.2f} +- {100 * math.hypot(da, db) / b:.2f} %",
                    flush=True,
                )
print(f"largest difference: {worst:.2f} of what is allowed")
sys.exit(1 if worst > 1 else 0)
