"""A sphere under the museum map, rendered by Mitsuba 3 with the exported plugin and by pbnbrdf.

TEST.py PROGRAM FOLDER DATA. The set-up is problems/scenes/sphere.json's, smaller. Mitsuba interpolates
between the map's texels, pbnbrdf doesn't: it shows at the windows behind the sphere, so the sphere
alone is compared, block by block.
"""
import importlib
import json
import os
import sys

from common import SKIP, check, np, path, program, require

mi, OpenEXR = require("mitsuba", "OpenEXR")

MUSEUM = os.path.join(sys.argv[3], "envmaps", "museum.exr")
SIZE, BLOCK, SAMPLES = 64, 8, 4096


def write_scene():
    scene = {
        "camera": {"origin": [0, 0, 2.2], "target": [0, 0, 0], "field_of_view": 30},
        "film": {"width": SIZE, "height": SIZE},
        "materials": {"surface": {"source": path("gold.safetensors")}},
        "shapes": [{"type": "sphere", "radius": 0.5, "material": "surface"}],
        "lights": [{"type": "environment", "file": MUSEUM}]}
    with open(path("sphere.json"), "w", encoding="utf-8") as file:
        json.dump(scene, file)


def ours():
    program("render", f"--scene={path('sphere.json')}", f"--out={path('sphere.exr')}",
            f"--samples_per_pixel={SAMPLES}")
    return OpenEXR.File(path("sphere.exr")).channels()["RGB"].pixels


def mitsubas(rotation=0):
    """rotation: of the map about +y, degrees."""
    T = mi.ScalarTransform4f
    scene = mi.load_dict({
        "type": "scene", "integrator": {"type": "path"},
        "light": {"type": "envmap", "filename": MUSEUM,
                  "to_world": T().rotate([0, 1, 0], rotation)},
        "sphere": {"type": "sphere", "radius": 0.5, "bsdf": {"type": "pbnbrdf"}},
        "sensor": {"type": "perspective", "fov": 30.0,
                   "to_world": T().look_at([0, 0, 2.2], [0, 0, 0], [0, 1, 0]),
                   "film": {"type": "hdrfilm", "width": SIZE, "height": SIZE, "pixel_format": "rgb",
                            "rfilter": {"type": "box"}},
                   "sampler": {"type": "independent", "sample_count": SAMPLES}}})
    return np.array(mi.render(scene, seed=1))


def blocks(image):
    """Means over blocks; black where the sphere, of a radius of 27.9 pixels, isn't."""
    y, x = np.mgrid[0:SIZE, 0:SIZE] + 0.5 - SIZE / 2
    sphere = image * (np.hypot(x, y) < 27)[..., None]
    return sphere.reshape(SIZE // BLOCK, BLOCK, SIZE // BLOCK, BLOCK, 3).mean(axis=(1, 3))


def difference(a, b):
    """Mean absolute one of the blocks, relative to their mean."""
    return np.mean(np.abs(blocks(a) - blocks(b))) / np.mean(blocks(a))


if not os.path.exists(MUSEUM):
    print(f"skipped: needs {MUSEUM}")
    sys.exit(SKIP)
program("fit", "--material=builtin:satin-gold", "--max_iterations=30", "--samples=5000",
        f"--out={path('gold.safetensors')}")
program("export", f"--fit={path('gold.safetensors')}", "--format=mitsuba",
        f"--out={path('gold.py')}")
mi.set_variant("llvm_ad_rgb")
sys.path.insert(0, sys.argv[2])
importlib.import_module("gold")
write_scene()
image, reference = ours(), mitsubas()
check("the sphere's mean", np.abs(blocks(image).mean() / blocks(reference).mean() - 1), 0.005)
check("its blocks", difference(reference, image), 0.01)
turned = difference(mitsubas(rotation=3), image)
print(f"its blocks, the map turned by 3 degrees: {turned:.3g}")
assert turned > 0.02  # the comparison can fail
