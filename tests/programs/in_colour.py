"""Does a second reader find in a spectral picture what Airlight wrote? By `colour-science`, which knows the layout of Fichet et al. 2021.

    pip install colour-science OpenImageIO OpenEXR             # 0.4.7, 3.1 and 3.5 were tried
    cargo build --release --bin airlight
    python3 tests/programs/in_colour.py target/release         # from the repository's root

Renders a small polarised sky, and fails unless the reader finds the wavelengths, the unit, the kind and the handedness that were written,
the polarised part within the whole, and by its own colour matching functions (CIE 1931) the luminance of R, G and B to 1 %: those
come from the whole solar spectrum between the wavelengths, the reader knows its values every 5 nm.
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import colour
import numpy
import OpenEXR

COUNT = 81
with tempfile.TemporaryDirectory() as name:
    path = Path(name) / "sky.exr"
    words = ["--width", "24", "--height", "24", "--wavelengths", str(COUNT), "--spectral", "--polarisation", "--quiet"]
    subprocess.run([Path(sys.argv[1]) / "airlight", "render", *words, "-o", str(path)], check=True, capture_output=True)
    components, picture = colour.read_spectral_image_Fichet2021(str(path), additional_data=True)
    (part,) = OpenEXR.File(str(path)).parts
    rgb = numpy.asarray(part.channels["RGB"].pixels, dtype=float)

said = {attribute.name: attribute.value for attribute in picture.attributes}
stokes = [numpy.asarray(components[key][1], dtype=float) for key in ("S0", "S1", "S2", "S3")]
wavelengths = numpy.asarray(components["S0"][0])
polarised = numpy.sqrt(sum(component**2 for component in stokes[1:]))
# The trapezoidal rule over 5 nm.
observer = colour.MSDS_CMFS["CIE 1931 2 Degree Standard Observer"].copy().align(colour.SpectralShape(380, 780, 5)).values[:, 1]
luminance = 683.002 * numpy.trapezoid(stokes[0] * observer, wavelengths, axis=-1)
own = rgb @ [0.2126, 0.7152, 0.0722]
seen = own > 0
off = float(numpy.abs(luminance[seen] / own[seen] - 1).max())

found = {
    "wavelengths": (f"{wavelengths[0]:g} to {wavelengths[-1]:g} nm, {len(wavelengths)}", numpy.allclose(wavelengths, numpy.linspace(380, 780, COUNT), atol=1e-3)),
    "unit": (said.get("emissiveUnits"), said.get("emissiveUnits") == "W.m^-2.sr^-1.nm^-1"),
    "kind": (f"emissive {picture.is_emissive}, polarised {picture.is_polarised}", picture.is_emissive and picture.is_polarised),
    "handedness": (said.get("polarisationHandedness"), said.get("polarisationHandedness") == "right"),
    "polarised part": (f"at most {(polarised / numpy.maximum(stokes[0], 1e-30)).max():.3f}", bool((polarised <= stokes[0] * (1 + 1e-6)).all())),
    "luminance": (f"off by at most {100 * off:.2f} % in {int(seen.sum())} pixels", off < 1e-2),
}
for name, (what, good) in found.items():
    print(f"{name:16}{what:40}{'as written' if good else 'NOT as written'}")
sys.exit(0 if all(good for _, good in found.values()) else 1)
