"""Principled models as glTF, checked by Khronos' validator, and as MaterialX, opened by its own package.

TEST.py PROGRAM FOLDER ...; the validator is a package of Node.js in .peers/node_modules.
"""
import json
import os
import shutil
import subprocess
import sys

from common import SKIP, path, program, require

mx, = require("MaterialX")
MODULES = os.path.join(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))),
                       ".peers", "node_modules")
if shutil.which("node") is None or not os.path.isdir(os.path.join(MODULES, "gltf-validator")):
    print("skipped: needs Node.js and gltf-validator, which ./do peers installs")
    sys.exit(SKIP)

EVERYTHING = ("principled:base_color=0.8/0.4/0.1,metallic=0.3,roughness=0.4,anisotropy=0.6,specular=0.7,"
              "specular_color=1.5/1/0.5,coat=0.6,coat_roughness=0.2,sheen_color=0.5/0.3/0.1,"
              "sheen_roughness=0.45")
VALIDATE = """
const bytes = new Uint8Array(require("fs").readFileSync(process.argv[1]));
require("gltf-validator").validateBytes(bytes).then(report => console.log(JSON.stringify(report)));
"""


def export(source, extension, name):
    file = path(name + extension)
    program("export", f"--material={source}", f"--format={'gltf' if extension == '.gltf' else 'materialx'}",
            f"--out={file}")
    return file


def gltf(source, name):
    """The only material of the file, which the validator has nothing against."""
    file = export(source, ".gltf", name)
    done = subprocess.run(["node", "-e", VALIDATE, file], capture_output=True, text=True, check=True,
                          env={**os.environ, "NODE_PATH": MODULES})
    issues = json.loads(done.stdout)["issues"]
    print(f"{name}.gltf: {issues['numErrors']} errors, {issues['numWarnings']} warnings")
    if issues["numErrors"] or issues["numWarnings"]:
        sys.exit(f"FAILED: {issues['messages']}")
    with open(file, encoding="utf-8") as text:
        material, = json.load(text)["materials"]
    assert material["name"] == name
    return material


def materialx(source, name):
    """The inputs of the only shader, each of which its definition knows."""
    document, library = mx.createDocument(), mx.createDocument()
    mx.readFromXmlFile(document, export(source, ".mtlx", name))
    mx.loadLibraries(mx.getDefaultDataLibraryFolders(), mx.getDefaultDataSearchPath(), library)
    document.importLibrary(library)
    valid, message = document.validate()
    if not valid:
        sys.exit(f"FAILED: {name}.mtlx: {message}")
    material = document.getNode(name)
    assert material.getCategory() == "surfacematerial"
    shader, = mx.getShaderNodes(material)
    known = {known.getName(): known.getType() for known in shader.getNodeDef().getActiveInputs()}
    values = {}
    for given in shader.getInputs():
        assert known[given.getName()] == given.getType(), given.getName()
        value = given.getValue()
        values[given.getName()] = list(value.asTuple()) if given.getType() == "color3" else value
    return values


def near(found, expected):
    found, expected = [v if isinstance(v, list) else [v] for v in (found, expected)]
    return len(found) == len(expected) and all(abs(a - b) < 1e-6 for a, b in zip(found, expected))


material = gltf(EVERYTHING, "everything")
base = material["pbrMetallicRoughness"]
assert base == {"baseColorFactor": [0.8, 0.4, 0.1, 1], "metallicFactor": 0.3, "roughnessFactor": 0.4}
assert material["extensions"] == {
    "KHR_materials_specular": {"specularFactor": 0.7, "specularColorFactor": [1.5, 1, 0.5]},
    "KHR_materials_anisotropy": {"anisotropyStrength": 0.6},
    "KHR_materials_clearcoat": {"clearcoatFactor": 0.6, "clearcoatRoughnessFactor": 0.2},
    "KHR_materials_sheen": {"sheenColorFactor": [0.5, 0.3, 0.1], "sheenRoughnessFactor": 0.45}}
inputs = materialx(EVERYTHING, "everything")
expected = {"base_color": [0.8, 0.4, 0.1], "metallic": 0.3, "roughness": 0.4, "specular": 0.7,
            "specular_color": [1.5, 1, 0.5], "anisotropy_strength": 0.6, "clearcoat": 0.6,
            "clearcoat_roughness": 0.2, "sheen_color": [0.5, 0.3, 0.1], "sheen_roughness": 0.45}
assert inputs.keys() == expected.keys() and all(near(inputs[k], expected[k]) for k in expected), inputs

assert "extensions" not in gltf("principled:metallic=1", "plain")  # what changes nothing is left out

# Another source: the nearest model, and how near it is.
gold = gltf("builtin:satin-gold", "gold")
assert near(gold["pbrMetallicRoughness"]["metallicFactor"], 1)
approximation = gold["extras"]["approximation"]
print(approximation)
assert approximation["material"] == "builtin:satin-gold"
assert 0 < approximation["mean_abs_log_error"] < 1e-3 and approximation["delta_e_mean"] < 0.1
assert 0 <= approximation["sphere_flip"] < 0.01
with open(export("builtin:satin-gold", ".mtlx", "gold_again"), encoding="utf-8") as text:
    assert f"<!-- sphere_flip: {approximation['sphere_flip']}" in text.read()
