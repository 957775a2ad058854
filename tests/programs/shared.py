"""What the scripts of this folder have in common: Airlight's programs, one view of plane layers, and where a picture shows the sun."""

import io
import json
import math
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy

PROGRAMS = Path(sys.argv[1])
SUN_ZENITH, ALBEDO, SIZE = 60.0, 0.3, 16


def run(program, *words):
    """What a program prints."""
    return subprocess.run([PROGRAMS / program, *map(str, words)], check=True, capture_output=True, text=True).stdout


def irradiance(nm):
    """The sun's spectral irradiance at 1 au in W m^-2 nm^-1."""
    text = run("airlight-tools", "export", "data/sun.table", "--field", "irradiance", "--bare")
    sun = numpy.loadtxt(io.StringIO(text), delimiter=",", skiprows=1)
    return numpy.interp(nm, sun[:, 0], sun[:, 1])


def trace(path, nm, air, view, samples):
    """Airlight's picture, by paths, of one degree of plane layers; the view by its zenith angle and its azimuth from the sun."""
    scene = ["--flat", "--method", "paths", "--albedo", ALBEDO, "--follow-polarisation=off", "--wavelengths", nm, *air]
    sun = [f"--sun-elevation={90 - SUN_ZENITH}", "--sun-azimuth", 0, "--sun-shape", "point"]
    camera = ["--camera", "pinhole", "--fov", 1, f"--view-elevation={90 - view[0]}", f"--view-azimuth={view[1]}"]
    size = ["--width", SIZE, "--height", SIZE, "--spp", samples, "--spectral", "--quiet", "-o", path]
    run("airlight", "render", *scene, *sun, *camera, *size)


def mean(pixels):
    """The mean over pixels that are as good as equal, and its standard error."""
    pixels = numpy.asarray(pixels, dtype=float).ravel()
    return pixels.mean(), pixels.std(ddof=1) / math.sqrt(pixels.size)


def compared(found, right, share):
    """The difference of two means with their errors, in words, and over four standard errors and a share of the second together."""
    (a, da), (b, db) = found, right
    words = f"{100 * (a / b - 1):+.2f} +- {100 * math.hypot(da, db) / b:.2f} %"
    return words, abs(a - b) / (4 * math.hypot(da, db) + share * b)


def ends(worst):
    """Says how far the worst comparison went, and fails beyond what is allowed."""
    print(f"largest difference: {worst:.2f} of what is allowed")
    sys.exit(1 if worst > 1 else 0)


def look_at_suns(program, render):
    """Has a program show 31 x 31 pixels, 10 degrees of the map of `airlight light --for`, about three suns. Fails unless the brightest pixel is
    the middle one, or beside it, and what is seen less the sky at the picture's edge is the sun's irradiance of the JSON file within 3 %."""
    good = True
    for azimuth in (130, 215, 350):
        with tempfile.TemporaryDirectory() as name:
            path = Path(name) / "sky.exr"
            sun = ["--sun-elevation", 20, "--sun-azimuth", azimuth, "--sun-disc", "on"]
            run("airlight", "light", "--for", program, *sun, "--width", 1024, "-o", path)
            said = json.loads(path.with_suffix(".json").read_text())["sun"]
            seen = render(path, said["direction_to_sun"])
        row, column = map(int, numpy.unravel_index(seen[..., 1].argmax(), seen.shape[:2]))
        # A pixel (x, y) of a plane at distance 1 is seen from it in the solid angle dx dy / (1 + x^2 + y^2)^(3/2).
        half = numpy.tan(numpy.radians(5.0))
        across = (numpy.arange(31) + 0.5) / 31 * 2 * half - half
        solid = (2 * half / 31) ** 2 / (1 + across[:, None] ** 2 + across[None, :] ** 2) ** 1.5
        sky = numpy.concatenate([seen[0], seen[-1], seen[:, 0], seen[:, -1]]).mean(axis=0)
        off = ((seen - sky) * solid[..., None]).sum(axis=(0, 1)) / said["normal_irradiance_rgb"] - 1
        good &= abs(row - 15) <= 1 and abs(column - 15) <= 1 and bool((abs(off) < 0.03).all())
        percent = ", ".join(f"{100 * value:+.1f}" for value in off)
        print(f"sun at azimuth {azimuth}: brightest pixel {row}, {column} of 31 x 31 (middle 15, 15); irradiance off by {percent} % (RGB)")
    sys.exit(0 if good else 1)
