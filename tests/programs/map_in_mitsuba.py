"""Does Mitsuba 3 see the sun of a map by `airlight light --for mitsuba` where the map's JSON says, and the light that is in the map?

    pip install mitsuba                                        # 3.9.1 was tried
    cargo build --release --bin airlight
    python3 tests/programs/map_in_mitsuba.py target/release    # from the repository's root

What is looked at, and when it fails: `look_at_suns` in shared.py.
"""

import mitsuba
import numpy
import shared

mitsuba.set_variant("scalar_rgb")


def render(path, to_sun):
    film = {"type": "hdrfilm", "width": 31, "height": 31, "pixel_format": "rgb", "component_format": "float32", "rfilter": {"type": "box"}}
    look = mitsuba.ScalarTransform4f().look_at(origin=[0, 0, 0], target=to_sun, up=[0, 1, 0])
    sensor = {"type": "perspective", "fov": 10, "to_world": look, "film": film, "sampler": {"type": "independent", "sample_count": 256}}
    sky = {"type": "envmap", "filename": str(path)}
    return numpy.array(mitsuba.render(mitsuba.load_dict({"type": "scene", "integrator": {"type": "path"}, "sky": sky, "sensor": sensor})))


shared.look_at_suns("mitsuba", render)
