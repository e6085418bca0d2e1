"""What pbnbrdf writes opens with the official packages, and holds the network that it evaluates.

safetensors: a fit, evaluated in NumPy, against the program's values. Keras .h5 and NumPy .npy:
opened by h5py, by Keras itself and by NumPy, evaluated there.
"""
import importlib.abc
import importlib.util
import os
import sys
from unittest import mock

from common import all_networks, check, directions, library_values, np, path, program, random_layers
from common import require, write_network
import reference

h5py, = require("h5py")


def check_values(what, values, expected):
    check(what, np.max(np.abs(values - expected) / (1e-3 + expected)), 1e-9)


def unit_directions(count):
    """As double precision has them."""
    exact = [v.astype(np.float64) for v in directions(count)]
    return [v / np.linalg.norm(v, axis=1, keepdims=True) for v in exact]


def check_safetensors():
    # The mirror directions are left out: there the encoding amplifies that the program makes its
    # directions of length 1 once more.
    wi, wo = [v[1000:] for v in unit_directions(4000)]
    fit = path("fit.safetensors")
    program("fit", "--material=builtin:satin-gold", "--samples=500", "--max_iterations=5",
            "--terms=log", f"--out={fit}")
    for name, file in [("fit", fit), *[(name, file) for name, _, file in all_networks()]]:
        network = reference.read(file)
        values = reference.evaluate(network, wi, wo)
        assert np.count_nonzero(values) > 1000
        check_values(f"safetensors, {name}", values, library_values(file, wi, wo))


def relu_network(x, layers):
    """NBRDF's formula; kernels are in x out."""
    for n, (kernel, bias) in enumerate(layers, 1):
        x = x @ kernel.astype(np.float64) + bias
        x = np.maximum(x, 0) if n < len(layers) else np.maximum(np.exp(x) - 1, 0)
    return x


def exported_nbrdf():
    """A random network of NBRDF's kind as .safetensors, .h5 and .npy; inputs and their values."""
    file = path("nbrdf.safetensors")
    write_network(file, random_layers([21, 21], seed=5), "cartesian", "relu")
    program("export", f"--fit={file}", "--format=h5", f"--out={path('nbrdf.h5')}")
    program("export", f"--fit={file}", "--format=npy", f"--out={path('nbrdf_fc1.npy')}")
    wi, wo = [v[1000:-4] for v in unit_directions(4000)]
    return reference.encode("cartesian", wi, wo), library_values(file, wi, wo)


def check_h5py(inputs, expected):
    with h5py.File(path("nbrdf.h5")) as file:
        assert [name.decode() for name in file.attrs["layer_names"]] == [
            "dense_1", "dense_2", "dense_3", "lambda_1"]
        assert file.attrs["backend"] == "tensorflow" and file.attrs["keras_version"] == "2.2.4"
        layers = []
        for name in ("dense_1", "dense_2", "dense_3"):
            kernel, bias = [file[name][w.decode()] for w in file[name].attrs["weight_names"]]
            assert kernel.dtype == bias.dtype == np.dtype("<f4")
            layers.append((kernel[:], bias[:]))
        assert len(file["lambda_1"].attrs["weight_names"]) == 0
    check_values("h5py", relu_network(inputs, layers), expected)


def check_npy(inputs, expected):
    load = lambda name: np.load(path(f"nbrdf_{name}.npy"))
    layers = [(load(f"fc{n}"), load(f"b{n}")) for n in (1, 2, 3)]
    assert all(k.dtype == b.dtype == np.dtype("<f4") for k, b in layers)
    check_values("npy", relu_network(inputs, layers), expected)


class StandIns(importlib.abc.MetaPathFinder, importlib.abc.Loader):
    """Empty shells of the large packages that Keras' NumPy backend imports for convolutions and
    other layers, of which there are none here."""

    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in ("jax", "scipy"):
            return importlib.util.spec_from_loader(name, self, is_package=True)
        return None

    def create_module(self, spec):
        return mock.MagicMock()

    def exec_module(self, module):
        pass


def check_keras(inputs, expected):
    """NBRDF's own model, its weights loaded by Keras."""
    os.environ["KERAS_BACKEND"] = "numpy"
    sys.meta_path.append(StandIns())
    keras, = require("keras")
    model = keras.Sequential([
        keras.Input((6,)),
        keras.layers.Dense(21, activation="relu", name="dense_1"),
        keras.layers.Dense(21, activation="relu", name="dense_2"),
        keras.layers.Dense(3, name="dense_3"),
        keras.layers.Lambda(lambda x: keras.ops.exp(x) - 1, name="lambda_1")])
    model.load_weights(path("nbrdf.h5"))
    values = np.maximum(model.predict(inputs.astype(np.float32), verbose=0), 0)
    check("Keras, float32", np.max(np.abs(values - expected) / (1 + expected)), 1e-5)


check_safetensors()
inputs, expected = exported_nbrdf()
check_h5py(inputs, expected)
check_npy(inputs, expected)
check_keras(inputs, expected)
