"""Does Mitsuba 3 see the same sky in what is exported for it? Radiances of plane layers, beside those of Airlight's path tracer.

    pip install mitsuba                                        # 3.9.1 was tried
    cargo build --release --bin airlight --bin airlight-tools
    python3 tests/programs/in_mitsuba.py target/release [SAMPLES] # from the repository's root; samples of a pixel, 256 of them

Prints the spectral radiances (mW m^-2 sr^-1 nm^-1) of both with their standard errors, and fails where they differ by more than four
of these and 0.5 % together: that is left to layers of 100 m, to 4000 intervals of the phase functions, and to single precision. The last
columns are the core-seconds that both would take to a standard error of 1 %, Airlight's with all that it does before it traces.
"""

import io
import math
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import mitsuba
import numpy

mitsuba.set_variant("scalar_rgb")
PROGRAMS, SAMPLES = Path(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else "1024"
SIZE, SUN_ZENITH, ALBEDO = "16", 60.0, "0.3"


def run(program, *words):
    return subprocess.run([PROGRAMS / program, *words], check=True, capture_output=True, text=True).stdout


def mean(pixels):
    """The mean over pixels that are as good as equal, and its standard error."""
    pixels = numpy.asarray(pixels, dtype=float).ravel()
    return 1e3 * pixels.mean(), 1e3 * pixels.std(ddof=1) / math.sqrt(pixels.size)


def airlight(folder, biome, nm, zenith, azimuth):
    scene = ["--flat", "--method", "paths", "--biome", biome, "--wavelengths", f"{nm:.1f}", "--albedo", ALBEDO]
    sun = ["--sun-elevation", str(90 - SUN_ZENITH), "--sun-azimuth", "0", "--sun-shape", "point", "--follow-polarisation=off"]
    view = ["--camera", "pinhole", "--fov", "1", f"--view-elevation={90 - zenith}", f"--view-azimuth={azimuth}"]
    size = ["--width", SIZE, "--height", SIZE, "--spp", SAMPLES, "--spectral"]
    run("airlight", "render", *scene, *sun, *view, *size, "--quiet", "-o", str(folder / "sky.exr"))
    picture = mitsuba.Bitmap(str(folder / "sky.exr"))
    names = [field.name for field in picture.struct_()]
    (at,) = [i for i, name in enumerate(names) if name.startswith("S0.") and "rror" not in name]
    return mean(numpy.array(picture)[..., at])


def cores():
    """Core-seconds of this process and of those that it has waited for."""
    other = resource.getrusage(resource.RUSAGE_CHILDREN)
    return time.process_time() + other.ru_utime + other.ru_stime


def mitsubas(folder, nm, irradiance, zenith, azimuth):
    settings = dict(sun_zenith=SUN_ZENITH, irradiance=irradiance, albedo=ALBEDO, view_zenith=zenith, view_azimuth=azimuth)
    settings |= dict(size=SIZE, spp=SAMPLES)
    scene = mitsuba.load_file(str(folder / f"scene-{nm:g}nm.xml"), **{key: str(value) for key, value in settings.items()})
    return mean(mitsuba.render(scene))


sun = numpy.loadtxt(io.StringIO(run("airlight-tools", "export", "data/sun.table", "--field", "irradiance", "--bare")), delimiter=",", skiprows=1)
worst = 0.0
print("aerosol       nm  zenith  azimuth   Mitsuba             Airlight            difference         core-seconds to 1 %")
for biome, nm in [("none", 450.0), ("rural", 550.0), ("desert-dust", 650.0)]:
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        run("airlight-tools", "export", "--for", "mitsuba", "--biome", biome, "--wavelength", str(nm), "-o", name)
        irradiance = numpy.interp(nm, sun[:, 0], sun[:, 1])
        for zenith, azimuth in [(0.0, 0.0), (60.0, 30.0), (80.0, 180.0), (150.0, 90.0)]:
            start = cores()
            a, da = mitsubas(folder, nm, irradiance, zenith, azimuth)
            middle = cores()
            b, db = airlight(folder, biome, nm, zenith, azimuth)
            times = [(middle - start) * (100 * da / a) ** 2, (cores() - middle) * (100 * db / b) ** 2]
            allowed = 4 * math.hypot(da, db) + 0.005 * b
            worst = max(worst, abs(a - b) / allowed)
            print(
                f"{biome:12}{nm:5.0f}{zenith:7.0f}{azimuth:9.0f}   {a:8.3f} +- {da:5.3f}   {b:8.3f} +- {db:5.3f}"
                f"   {100 * (a / b - 1):+.2f} +- {100 * math.hypot(da, db) / b:.2f} %   {times[0]:8.3f} {times[1]:8.3f}",
                flush=True,
            )
print(f"largest difference: {worst:.2f} of what is allowed")
sys.exit(1 if worst > 1 else 0)
