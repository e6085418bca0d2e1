"""The Python package: values, shapes, what it refuses, fits from arrays, and the module of torch."""
import gc
import importlib.util
import math
import os
import resource
import signal
import threading
import time

import numpy as np
import pytest

import pbnbrdf

QUICK = dict(samples=1000, max_iterations=30, hidden=[8], terms="log")


def directions(count, seed=1):
    """Pairs above the horizon."""
    rng = np.random.default_rng(seed)
    v = rng.normal(size=(2, count, 3))
    v /= np.linalg.norm(v, axis=-1, keepdims=True)
    v[..., 2] = np.abs(v[..., 2])
    return v[0], v[1]


@pytest.fixture(scope="module")
def gold():
    return pbnbrdf.open("builtin:satin-gold")


@pytest.fixture(scope="module")
def fit(gold):
    return pbnbrdf.fit(gold, **QUICK)


def test_values_have_the_shape_that_directions_have():
    diffuse = pbnbrdf.open("lambert:rho_d=0.5")
    wi, wo = directions(24)
    expected = np.full((4, 6, 3), 0.5 / math.pi)
    np.testing.assert_allclose(diffuse(wi.reshape(4, 6, 3), wo.reshape(4, 6, 3)), expected)
    assert diffuse([0, 0, 1], wo).shape == (24, 3)  # broadcast, and integers
    assert diffuse([0, 0, 1], [0, 0, 1]).shape == (3,)
    assert diffuse(np.zeros((0, 3)), np.zeros((0, 3))).shape == (0, 3)
    assert (diffuse([0, 0, -1], [0, 0, 1]) == 0).all()
    # Any order of axes in memory.
    np.testing.assert_array_equal(diffuse(np.asfortranarray(wi), wo[::-1]), expected.reshape(24, 3))


def test_single_precision_stays_so(fit):
    wi, wo = directions(1000)
    exact = fit(wi, wo)
    single = fit(wi.astype(np.float32), wo.astype(np.float32))
    assert single.dtype == np.float32 and exact.dtype == np.float64
    np.testing.assert_allclose(single, exact, rtol=2e-3, atol=1e-4)
    assert fit(wi.astype(np.float32), wo).dtype == np.float64


def test_fits_are_reciprocal_and_measured(gold, fit):
    wi, wo = directions(500)
    np.testing.assert_array_equal(fit(wi, wo), fit(wo, wi))
    measures = pbnbrdf.measure(fit, gold, samples=20000)
    assert measures["hrl"] == 0 and measures["energy"] == "certified"
    assert measures["mean_abs_log_error"] < 0.05
    assert fit.is_reciprocal and fit.is_isotropic
    assert fit.summary["history"][-1][2] < fit.summary["history"][0][2]
    assert "--hidden=8" in fit.summary["problem"]


def test_weights_are_views_that_outlive_the_fit(gold):
    fit = pbnbrdf.fit(gold, **QUICK)
    weights = fit.weights
    assert [w.shape for w in weights] == [(8, 7), (3, 9)]
    with pytest.raises(ValueError):
        weights[0][0, 0] = 1.0
    kept = weights[0].copy()
    del fit
    gc.collect()
    np.testing.assert_array_equal(weights[0], kept)


def test_files_go_round(fit, tmp_path):
    fit.save(tmp_path / "a.safetensors")
    again = pbnbrdf.open(tmp_path / "a.safetensors")
    assert isinstance(again, pbnbrdf.Network)
    wi, wo = directions(100)
    np.testing.assert_array_equal(again(wi, wo), fit(wi, wo))
    assert again.metadata["version"] == pbnbrdf.__version__
    fit.export("glsl", tmp_path / "a.glsl", name="gold")
    assert "vec3 gold_eval(" in (tmp_path / "a.glsl").read_text()
    fit.export("wgsl_half", tmp_path / "a.wgsl")
    assert "unpack2x16float" in (tmp_path / "a.wgsl").read_text()


def test_fits_arrays(gold):
    wi, wo = directions(3000)
    rgb = gold(wi, wo)
    fit = pbnbrdf.fit(wi=wi.reshape(30, 100, 3), wo=wo.reshape(30, 100, 3), rgb=rgb.reshape(30, 100, 3),
                      sigma=0.01, max_iterations=100, samples=3000)
    error = np.abs(np.log1p(fit(wi, wo) * wi[:, 2:]) - np.log1p(rgb * wi[:, 2:])).mean()
    assert error < 0.02
    grey = pbnbrdf.fit(wi=wi, wo=wo, rgb=rgb[:, 0], **QUICK)
    values = grey(wi, wo)
    assert grey.weights[-1].shape[0] == 1 and (values[:, 0] == values[:, 2]).all()


def test_samples_follow_the_density(gold):
    rng = np.random.default_rng(2)
    wi = np.broadcast_to([math.sin(0.7), 0.0, math.cos(0.7)], (200000, 3))
    wo, pdf = gold.sample(wi, rng.uniform(size=(200000, 2)))
    assert (wo[pdf > 0, 2] > 0).all() and np.mean(pdf > 0) > 0.9
    np.testing.assert_allclose(gold.pdf(wi, wo)[pdf > 0], pdf[pdf > 0], rtol=1e-6)
    drawn = pdf > 0
    estimate = (gold(wi, wo)[drawn] * (wo[drawn, 2] / pdf[drawn])[:, None]).sum(axis=0) / len(pdf)
    np.testing.assert_allclose(estimate, gold.albedo(wi[0]), rtol=0.02)


def test_callback_hears_and_stops(gold):
    heard = []

    def callback(progress):
        heard.append(progress)
        return len(heard) < 5

    fit = pbnbrdf.fit(gold, callback=callback, samples=1000, terms="log")
    assert len(heard) == 5 and fit.summary["termination"] == "interrupted"
    assert heard[-1].error > 0 and heard[-1].seconds >= heard[0].seconds

    def fails(progress):
        raise RuntimeError("of the callback's own")

    with pytest.raises(RuntimeError, match="of the callback's own"):
        pbnbrdf.fit(gold, callback=fails, **QUICK)


def test_ctrl_c_ends_a_fit(gold):
    signal.signal(signal.SIGINT, signal.default_int_handler)  # shells make what runs in the background ignore it
    timer = threading.Timer(1.0, os.kill, (os.getpid(), signal.SIGINT))
    timer.start()
    start = time.monotonic()
    with pytest.raises(KeyboardInterrupt):
        pbnbrdf.fit(gold, samples=200000, max_iterations=100000, error_tolerance=0, function_tolerance=0)
    assert time.monotonic() - start < 30


def test_other_threads_go_on_while_it_fits(gold):
    ticks = []
    done = threading.Event()

    def tick():
        while not done.is_set():
            ticks.append(0)
            time.sleep(0.01)

    thread = threading.Thread(target=tick)
    thread.start()
    pbnbrdf.fit(gold, samples=20000, max_iterations=40, terms="log", error_tolerance=0)
    done.set()
    thread.join()
    assert len(ticks) > 10


@pytest.mark.parametrize("call, kind, words", [
    (lambda m: m([0, 0], [0, 0, 1]), ValueError, "wi: shape"),
    (lambda m: m([0, 0, 1], [[0, 0, 1.5]]), ValueError, "wo: row 0 is not a unit vector"),
    (lambda m: m([0, 0, math.nan], [0, 0, 1]), ValueError, "wi: row 0"),
    (lambda m: m(["a", "b", "c"], [0, 0, 1]), TypeError, "wi: an array of"),
    (lambda m: m(np.zeros((2, 3)), np.zeros((3, 3))), ValueError, "don't go together"),
    (lambda m: m.sample([0, 0, 1], [0.5]), ValueError, "u: shape"),
    (lambda m: m.sample([0, 0, 1], [0.5, 1.5]), ValueError, "u: row 0"),
    (lambda m: pbnbrdf.open("nowhere.binary"), pbnbrdf.Error, "nowhere.binary"),
    (lambda m: pbnbrdf.fit(m, hidden=0), pbnbrdf.Error, "hidden"),
    (lambda m: pbnbrdf.fit(m, nonsense=1), pbnbrdf.Error, "nonsense"),
    (lambda m: pbnbrdf.fit(), TypeError, "material"),
    (lambda m: pbnbrdf.fit(wi=[0, 0, 1], rgb=[1, 1, 1]), TypeError, "wo is missing"),
    (lambda m: pbnbrdf.fit(wi=[[0, 0, 1]], wo=[[0, 0, 1]], rgb=[[1, 1]]), ValueError, "rgb: shape"),
    (lambda m: pbnbrdf.fit(wi=[[0, 0, 1]], wo=[[0, 0, 1]], rgb=[[1, 1, math.inf]]), ValueError, "rgb: row 0"),
    (lambda m: pbnbrdf.fit(wi=[[0, 0, 1]], wo=[[0, 0, 1]], rgb=[[1, 1, 1]], sigma=-1), ValueError, "sigma"),
    (lambda m: pbnbrdf.fit(wi=np.zeros((0, 3)), wo=np.zeros((0, 3)), rgb=np.zeros((0, 3))), ValueError,
     "no measurements"),
    (lambda m: pbnbrdf.measure(m, m, samples=0), ValueError, "samples"),
])
def test_refuses(gold, call, kind, words):
    with pytest.raises(kind, match=words):
        call(gold)


def test_leaks_nothing(fit):
    wi, wo = directions(100000)
    for _ in range(5):
        fit(wi, wo)
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for _ in range(40):
        fit(wi, wo)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 20000  # kB; 40 results are 96 MB


@pytest.mark.skipif(importlib.util.find_spec("torch") is None, reason="needs torch")
@pytest.mark.parametrize("encoding", ["cartesian", "reciprocal", "multiscale", "elevations", "merl", "anisotropic",
                                      "nonreciprocal"])
def test_torch_has_the_same_values_and_gradients(encoding):
    import torch
    material = pbnbrdf.open("builtin:brushed-aluminium" if encoding == "anisotropic" else "builtin:satin-gold")
    fit = pbnbrdf.fit(material, encoding=encoding, **QUICK)
    module = fit.to_torch()
    wi, wo = directions(2000)
    wi[0] = wo[0] = [0.0, 0.0, 1.0]
    values = module(torch.from_numpy(wi), torch.from_numpy(wo))
    expected = fit(wi, wo)
    np.testing.assert_allclose(values.detach().numpy(), expected, rtol=1e-5, atol=1e-5)
    # A derivative with respect to a weight, by differences.
    loss = lambda: (module(torch.from_numpy(wi), torch.from_numpy(wo)) ** 2).mean()
    loss().backward()
    weight = module.layers[0].weight
    gradient, h = weight.grad[2, 3].item(), 1e-5
    with torch.no_grad():
        weight[2, 3] += h
        above = loss().item()
        weight[2, 3] -= 2 * h
        below = loss().item()
    assert math.isclose(gradient, (above - below) / (2 * h), rel_tol=1e-3, abs_tol=1e-7)
    assert torch.isfinite(weight.grad).all()
