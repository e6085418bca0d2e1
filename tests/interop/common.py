"""What the interop tests share: random networks, pairs of directions, and the program's values.

Each test is called as  TEST.py PROGRAM FOLDER  with a folder of its own to write to. Exit status
77: a package is missing, and the test is skipped.
"""
import importlib
import os
import struct
import subprocess
import sys

SKIP = 77
ACTIVATIONS = ["tanh", "relu"]
HIDDEN = [[21, 21], [5], [9, 16, 6]]


def require(*names):
    """The modules; ends the test as skipped if one isn't installed."""
    modules = []
    for name in names:
        try:
            modules.append(importlib.import_module(name))
        except ModuleNotFoundError as missing:
            print(f"skipped: needs the Python package {missing.name}; ./do peers installs it")
            sys.exit(SKIP)
    return modules


np, = require("numpy")


def program(*arguments):
    """Runs pbnbrdf."""
    done = subprocess.run([sys.argv[1], *arguments], capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"pbnbrdf {' '.join(arguments)}: {done.stderr}")


def path(name):
    os.makedirs(sys.argv[2], exist_ok=True)
    return os.path.join(sys.argv[2], name)


def random_layers(hidden, seed, outputs=3):
    """Lists of (W, out x in, and b), numbers of single precision."""
    rng = np.random.default_rng(seed)
    sizes = [6, *hidden, outputs]
    layers = []
    for n_in, n_out in zip(sizes, sizes[1:]):
        layers.append((rng.uniform(-0.6, 0.6, (n_out, n_in)), rng.uniform(-0.6, 0.6, n_out)))
    layers[-1][1][:] += 0.75  # most values are positive, not all
    return [tuple(x.astype(np.float32).astype(np.float64) for x in layer) for layer in layers]


def write_network(file, layers, encoding, activation):
    """A fitted network's file, written by the official package."""
    safetensors_numpy, = require("safetensors.numpy")
    tensors = {}
    for n, (w, b) in enumerate(layers, 1):
        tensors[f"fc{n}.weight"], tensors[f"fc{n}.bias"] = w, b
    safetensors_numpy.save_file(tensors, file, metadata={
        "format": "pbnbrdf", "encoding": encoding, "activation": activation, "output": "expm1"})


def encodings():
    """The names of all encodings, from the message about one that there isn't."""
    file = path("unknown.safetensors")
    write_network(file, random_layers([2], 0), "unknown", "tanh")
    done = subprocess.run([sys.argv[1], "info", file], capture_output=True, text=True)
    return done.stderr.partition("encoding=unknown is not one of ")[2].strip().split(" | ")


def all_networks():
    """(name, encoding, file) of each encoding with each activation, and of one with one channel."""
    for n, encoding in enumerate(encodings()):
        for k, activation in enumerate(ACTIVATIONS):
            name = f"{encoding}_{activation}"
            file = path(name + ".safetensors")
            seed = 2 * n + k
            write_network(file, random_layers(HIDDEN[seed % 3], seed), encoding, activation)
            yield name, encoding, file
    file = path("one_channel.safetensors")
    write_network(file, random_layers([7], 1, outputs=1), "merl", "tanh")
    yield "one_channel", "merl", file


def directions(count, seed=3):
    """wi and wo, N x 3 float32: at and near the mirror, grazing, below the horizon, random."""
    rng = np.random.default_rng(seed)
    wi, wo = [rng.normal(size=(count, 3)) for _ in range(2)]
    wi[:, 2], wo[:, 2] = np.abs(wi[:, 2]), np.abs(wo[:, 2])
    quarter = count // 4
    wo[:quarter] = wi[:quarter] * [-1, -1, 1]
    wo[:quarter] += rng.normal(size=(quarter, 3)) * 10.0 ** rng.uniform(-7, -1, (quarter, 1))
    wi[-8:-4, 2] *= 1e-4
    wi[-4:-2, 2] *= -1
    wo[-2:, 2] *= -1
    wi[-12:-10] = wo[-12:-10] = [0, 0, 1]
    wi[-10] = wo[-10]
    return [(v / np.linalg.norm(v, axis=1, keepdims=True)).astype(np.float32) for v in (wi, wo)]


def library_values(source, wi, wo):
    """pbnbrdf eval at the directions, which it makes of length 1 in double precision."""
    pairs, values = path("pairs.csv"), path("values.csv")
    np.savetxt(pairs, np.hstack([wi, wo]).astype(np.float64), delimiter=",", fmt="%.17g",
               header="wi_x,wi_y,wi_z,wo_x,wo_y,wo_z", comments="")
    program("eval", f"--material={source}", f"--directions={pairs}", f"--out={values}")
    return np.loadtxt(values, delimiter=",", skiprows=1)[:, -3:]


def check(what, worst, bound):
    """Prints how close it came; ends the test if it isn't below the bound (NaN isn't)."""
    print(f"{what}: {worst:.3g}, allowed {bound:.3g}")
    if not worst <= bound:
        sys.exit(f"FAILED: {what}")
