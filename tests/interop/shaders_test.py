"""Exported WGSL, compiled by Naga, and HLSL, compiled by Slang, both run on a Vulkan driver by wgpu, against the
network in double precision, which weights_test.py compares with the library."""
import importlib.util
import os
import subprocess
import sys

from common import SKIP, all_networks, check, directions, np, path, program, require
import reference

os.environ.setdefault("XDG_RUNTIME_DIR", path("runtime"))  # drivers complain without one
wgpu, compute = require("wgpu", "wgpu.utils.compute")
slang = importlib.util.find_spec("slangtorch")  # imported, it would need torch
if slang is None:
    print("skipped: needs the Python package slangtorch; ./do peers installs it")
    sys.exit(SKIP)
slangc = os.path.join(slang.submodule_search_locations[0], "bin", "slangc")
if not any(a.info["backend_type"] == "Vulkan" for a in wgpu.gpu.enumerate_adapters_sync()):
    print("skipped: needs a Vulkan driver, e.g. Debian's mesa-vulkan-drivers")
    sys.exit(SKIP)

GROUP = 64
WGSL_MAIN = """
@group(0) @binding(0) var<storage, read> pairs: array<vec4<f32>>;
@group(0) @binding(1) var<storage, read_write> values: array<vec4<f32>>;
@compute @workgroup_size(64) fn main(@builtin(global_invocation_id) id: vec3<u32>) {
  values[id.x] = vec4<f32>(NAME_eval(pairs[2 * id.x].xyz, pairs[2 * id.x + 1].xyz), 1.0);
}
"""
HLSL_MAIN = """
[[vk::binding(0, 0)]] StructuredBuffer<float4> pairs;
[[vk::binding(1, 0)]] RWStructuredBuffer<float4> values;
[numthreads(64, 1, 1)] void main(uint3 id : SV_DispatchThreadID) {
  values[id.x] = float4(NAME_eval(pairs[2 * id.x].xyz, pairs[2 * id.x + 1].xyz), 1.0);
}
"""


def exported(name, network, format, main):
    """The exported functions with a compute shader that calls them."""
    file = path(f"{name}.{format}")
    program("export", f"--fit={network}", f"--format={format}", f"--out={file}")
    with open(file, encoding="utf-8") as text:
        return text.read() + main.replace("NAME", name)


def wgsl(name, network, kind=""):
    return exported(name, network, "wgsl" + kind, WGSL_MAIN)


def hlsl(name, network, kind=""):
    """HLSL, as HLSL and as Slang, translated to WGSL; the two are the same."""
    source, translated = path(f"{name}_main.hlsl"), path(f"{name}_main.wgsl")
    with open(source, "w", encoding="utf-8") as file:
        file.write(exported(name, network, "hlsl" + kind, HLSL_MAIN))
    texts = []
    for language in ("hlsl", "slang"):
        done = subprocess.run(
            [slangc, "-lang", language, source, "-entry", "main", "-stage", "compute", "-target",
             "wgsl", "-warnings-as-errors", "all", "-o", translated],
            capture_output=True, text=True)
        if done.returncode != 0 or "warning" in done.stderr:
            sys.exit(f"FAILED: {name} in {language}: {done.stderr}")
        with open(translated, encoding="utf-8") as file:
            texts.append(file.read())
    assert texts[0] == texts[1]
    return texts[0]


def run(shader, wi, wo):
    """N x 3 values of the pairs; N is a multiple of GROUP."""
    pairs = np.zeros((len(wi), 2, 4), np.float32)
    pairs[:, 0, :3], pairs[:, 1, :3] = wi, wo
    out = compute.compute_with_buffers({0: pairs}, {1: (len(wi), 4, "f")}, shader, n=len(wi) // GROUP)
    return np.frombuffer(out[1], np.float32).reshape(-1, 4)[:, :3]


wi, wo = directions(63 * GROUP)
for name, encoding, file in all_networks():
    expected = reference.evaluate(reference.read(file), wi, wo)
    assert (expected > 0).any() and (expected[:-4] == 0).any()
    # As formats.h promises.
    allowed = 3e-5 * expected + 3e-6
    if encoding == "merl":
        allowed = 1e-4 * (1 + expected)
    for language in (wgsl, hlsl):
        what = f"{name} in {language.__name__}"
        shader = language(name, file)
        values, exchanged = run(shader, wi, wo), run(shader, wo, wi)
        assert (values[-4:] == 0).all()  # below the horizon
        check(f"{what}, error over what is allowed", np.max(np.abs(values - expected) / allowed), 1)
        differ = np.count_nonzero(np.any(exchanged != values, axis=1))
        if encoding in reference.NOT_RECIPROCAL:
            assert differ > 1000  # the comparison can fail
        else:
            check(f"{what}, pairs that aren't reciprocal to the bit", differ, 0)
    if name == "merl_tanh":
        # Weights of half precision, which both languages get from the same program.
        halves = [run(language(name, file, "_half"), wi, wo) for language in (wgsl, hlsl)]
        assert (halves[0] != values).any()
        check(f"{name}, weights of half precision, languages apart over what is allowed",
              np.max(np.abs(halves[0] - halves[1]) / allowed), 1)
        check(f"{name}, change by weights of half precision over 1 + f",
              np.mean(np.abs(halves[0] - expected) / (1 + expected)), 1e-3)
