"""Does Mitsuba 3 see the sun of a map by `airlight light --for mitsuba` where the map's JSON says, and the light that is in the map?

    pip install mitsuba                                        # 3.9.1 was tried
    cargo build --release --bin airlight
    python3 tests/programs/map_in_mitsuba.py target/release    # from the repository's root

Looks along the direction to the sun: the brightest pixel of 31 x 31 over 10 degrees is to be the middle one, or beside it, and what is seen
within 10 degrees, less the sky at the edge of the picture, is to be the sun's irradiance of the JSON file within 3 %.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import mitsuba
import numpy

mitsuba.set_variant("scalar_rgb")


def scene(path, sensor, shapes):
    film = {"type": "hdrfilm", "width": 31, "height": 31, "pixel_format": "rgb", "component_format": "float32", "rfilter": {"type": "box"}}
    return mitsuba.load_dict(
        {
            "type": "scene",
            "integrator": {"type": "path"},
            "sky": {"type": "envmap", "filename": str(path)},
            "sensor": {**sensor, "film": film, "sampler": {"type": "independent", "sample_count": 256}},
            **shapes,
        }
    )


good = True
for azimuth in (130, 215, 350):
    with tempfile.TemporaryDirectory() as name:
        path = Path(name) / "sky.exr"
        words = ["--for", "mitsuba", "--sun-elevation", "20", "--sun-azimuth", str(azimuth), "--width", "1024"]
        subprocess.run([Path(sys.argv[1]) / "airlight", "light", *words, "--sun-disc", "on", "-o", path], check=True, capture_output=True)
        said = json.loads(path.with_suffix(".json").read_text())
        to_sun, sun = said["sun"]["direction_to_sun"], said["sun"]["normal_irradiance_rgb"]
        look = mitsuba.ScalarTransform4f().look_at(origin=[0, 0, 0], target=to_sun, up=[0, 1, 0])
        seen = numpy.array(mitsuba.render(scene(path, {"type": "perspective", "fov": 10, "to_world": look}, {})))
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
