"""Does Mitsuba 3 see the same sky in what is exported for it? Radiances of plane layers, beside those of Airlight's path tracer.

    pip install mitsuba                                        # 3.9.1 was tried
    cargo build --release --bin airlight --bin airlight-tools
    python3 tests/programs/in_mitsuba.py target/release [SAMPLES] # from the repository's root; samples of a pixel, 256 of them

Prints the spectral radiances (mW m^-2 sr^-1 nm^-1) of both with their standard errors, and fails where they differ by more than four
of these and 0.5 % together: that is left to layers of 100 m, to 4000 intervals of the phase functions, and to single precision. The last
columns are the core-seconds that both would take to a standard error of 1 %, Airlight's with all that it does before it traces.
"""

import resource
import sys
import tempfile
import time
from pathlib import Path

import mitsuba
import numpy
import shared

mitsuba.set_variant("scalar_rgb")
SAMPLES = sys.argv[2] if len(sys.argv) > 2 else "1024"


def airlights(folder, biome, nm, view):
    shared.trace(folder / "sky.exr", f"{nm:.1f}", ["--biome", biome], view, SAMPLES)
    picture = mitsuba.Bitmap(str(folder / "sky.exr"))
    names = [field.name for field in picture.struct_()]
    (at,) = [i for i, name in enumerate(names) if name.startswith("S0.") and "rror" not in name]
    return shared.mean(1e3 * numpy.array(picture)[..., at])


def mitsubas(folder, nm, irradiance, view):
    settings = dict(sun_zenith=shared.SUN_ZENITH, irradiance=1e3 * irradiance, albedo=shared.ALBEDO, size=shared.SIZE, spp=SAMPLES)
    settings |= dict(view_zenith=view[0], view_azimuth=view[1])
    scene = mitsuba.load_file(str(folder / f"scene-{nm:g}nm.xml"), **{key: str(value) for key, value in settings.items()})
    return shared.mean(mitsuba.render(scene))


def timed(work, *words):
    """What is found, and the core-seconds that it would take to a standard error of 1 %."""

    def cores():
        other = resource.getrusage(resource.RUSAGE_CHILDREN)
        return time.process_time() + other.ru_utime + other.ru_stime

    start = cores()
    value, error = work(*words)
    return (value, error), (cores() - start) * (100 * error / value) ** 2


worst = 0.0
print("aerosol       nm  zenith  azimuth   Mitsuba             Airlight            difference         core-seconds to 1 %")
for biome, nm in [("none", 450.0), ("rural", 550.0), ("desert-dust", 650.0)]:
    with tempfile.TemporaryDirectory() as name:
        shared.run("airlight-tools", "export", "--for", "mitsuba", "--biome", biome, "--wavelength", nm, "-o", name)
        irradiance = shared.irradiance(nm)
        for view in [(0.0, 0.0), (60.0, 30.0), (80.0, 180.0), (150.0, 90.0)]:
            found, their_s = timed(mitsubas, Path(name), nm, irradiance, view)
            right, our_s = timed(airlights, Path(name), biome, nm, view)
            words, share = shared.compared(found, right, 0.005)
            worst = max(worst, share)
            print(
                f"{biome:12}{nm:5.0f}{view[0]:7.0f}{view[1]:9.0f}   {found[0]:8.3f} +- {found[1]:5.3f}"
                f"   {right[0]:8.3f} +- {right[1]:5.3f}   {words}   {their_s:8.3f} {our_s:8.3f}",
                flush=True,
            )
shared.ends(worst)
