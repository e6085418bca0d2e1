"""Small neural BRDFs that obey physics, fitted to measurements by nonlinear least squares.

    import pbnbrdf
    material = pbnbrdf.open("gold.binary")
    fit = pbnbrdf.fit(material)
    fit.save("gold.safetensors")

Directions are arrays of shape (..., 3): unit vectors in the shading frame, normal +z; wi points to the light, wo to the
viewer. Values are linear RGB in 1/sr, of shape (..., 3), without the cosine. What can't be used raises `Error`, a
ValueError, with the words of the command line, or a ValueError or TypeError that names the argument.
"""
from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _pbnbrdf
from ._pbnbrdf import Error

__version__: str = _pbnbrdf.version
__all__ = ["Brdf", "Error", "Fit", "Network", "Progress", "Sampler", "fit", "measure", "open"]


def _directions(name: str, value: ArrayLike) -> NDArray[Any]:
    """An array of float32 or float64, (..., 3)."""
    array = np.asarray(value)
    if array.dtype != np.float32:
        if array.dtype.kind not in "fiu":
            raise TypeError(f"{name}: an array of {array.dtype}; numbers are needed")
        array = array.astype(np.float64, copy=False)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{name}: shape {array.shape}; the last axis must have 3 components")
    return array


def _pairs(wi: ArrayLike, wo: ArrayLike) -> tuple[NDArray[Any], NDArray[Any], tuple[int, ...]]:
    """Both as rows of one type, and the shape that they had together."""
    wi, wo = _directions("wi", wi), _directions("wo", wo)
    if wi.dtype != wo.dtype:
        wi, wo = wi.astype(np.float64), wo.astype(np.float64)
    try:
        wi, wo = np.broadcast_arrays(wi, wo)
    except ValueError:
        raise ValueError(f"wi, wo: shapes {wi.shape} and {wo.shape} don't go together") from None
    shape = wi.shape[:-1]
    return np.ascontiguousarray(wi.reshape(-1, 3)), np.ascontiguousarray(wo.reshape(-1, 3)), shape


class Sampler:
    """Draws directions in proportion to what a material reflects: by tables of half vectors, and by the cosine."""

    def __init__(self, brdf: Brdf) -> None:
        self._sampler = _pbnbrdf.Sampler(brdf._brdf)

    def sample(self, wi: ArrayLike, u: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """(wo, pdf) of shapes (..., 3) and (...), for wi of shape (..., 3) and uniform numbers u in [0, 1) of shape
        (..., 2). pdf (1/sr) is 0, and wo of no use, where wi isn't above the horizon or the facet drawn reflects to below
        it: such a sample counts as 0."""
        wi = _directions("wi", wi).astype(np.float64)
        u = np.asarray(u, dtype=np.float64)
        if u.shape != (*wi.shape[:-1], 2):
            raise ValueError(f"u: shape {u.shape}; must be {(*wi.shape[:-1], 2)}")
        wo, pdf = self._sampler.sample(np.ascontiguousarray(wi.reshape(-1, 3)), np.ascontiguousarray(u.reshape(-1, 2)))
        return wo.reshape(wi.shape), pdf.reshape(wi.shape[:-1])

    def pdf(self, wi: ArrayLike, wo: ArrayLike) -> NDArray[np.float64]:
        """The density (1/sr) with which sample(wi) chooses wo, of shape (...)."""
        wi, wo, shape = _pairs(wi, wo)
        return self._sampler.pdf(wi.astype(np.float64), wo.astype(np.float64)).reshape(shape)


class Brdf:
    """A reflectance: what `open` read, or a fit."""

    def __init__(self, brdf: _pbnbrdf.Brdf) -> None:
        self._brdf = brdf
        self._sampler: Sampler | None = None

    def __call__(self, wi: ArrayLike, wo: ArrayLike) -> NDArray[Any]:
        """f(wi, wo) in 1/sr, (..., 3), from 0 on; 0 where a direction isn't above the horizon. wi and wo are
        broadcast against each other. Of two float32 arrays the result is float32, and computed so where that is
        faster; else it is float64."""
        wi, wo, shape = _pairs(wi, wo)
        return self._brdf.evaluate(wi, wo).reshape(*shape, 3)

    def albedo(self, wi: ArrayLike) -> NDArray[np.float64]:
        """The directional albedo, the integral of f cos_o over wo: (..., 3), by quadrature, within about 3e-4."""
        wi = _directions("wi", wi).astype(np.float64)
        return self._brdf.albedo(np.ascontiguousarray(wi.reshape(-1, 3))).reshape(wi.shape)

    def sample(self, wi: ArrayLike, u: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Sampler(self).sample(wi, u), of a sampler that is made once."""
        return self._own_sampler().sample(wi, u)

    def pdf(self, wi: ArrayLike, wo: ArrayLike) -> NDArray[np.float64]:
        """Sampler(self).pdf(wi, wo)."""
        return self._own_sampler().pdf(wi, wo)

    def _own_sampler(self) -> Sampler:
        if self._sampler is None:
            self._sampler = Sampler(self)
        return self._sampler

    @property
    def is_isotropic(self) -> bool:
        """Whether f stays the same when wi and wo turn together about the normal."""
        return self._brdf.is_isotropic

    @property
    def is_reciprocal(self) -> bool:
        """Whether f(wi, wo) = f(wo, wi) always."""
        return self._brdf.is_reciprocal

    def __repr__(self) -> str:
        return f"<pbnbrdf.{type(self).__name__}: {self._brdf.description}>"


class Network(Brdf):
    """A fitted network, or a published one."""

    @property
    def weights(self) -> list[NDArray[np.float64]]:
        """The matrices [W | b] of the layers, out x (in + 1): views of the network's own memory, to read."""
        return self._brdf.weights()

    @property
    def metadata(self) -> dict[str, str]:
        """What its file says about it."""
        return self._brdf.metadata()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a safetensors file: whole, or not at all."""
        self._brdf.save(os.fspath(path))

    def export(self, format: str, path: str | os.PathLike[str], name: str = "") -> None:
        """As pbnbrdf export, in every format but gltf and materialx, which hold no networks. name: of functions of source
        code; by default the file's."""
        self._brdf.export(format, os.fspath(path), name)

    def to_torch(self) -> Any:
        """A torch.nn.Module that is called as this is, with tensors, and has the weights as its parameters."""
        scope: dict[str, Any] = {"__name__": "pbnbrdf_torch"}
        exec(self._brdf.source("torch", "Network"), scope)
        return scope["Network"]()


class Progress:
    """Where a fit is: iteration, seconds, cost, and the mean absolute log error of samples that it doesn't see."""

    def __init__(self, iteration: int, seconds: float, cost: float, error: float) -> None:
        self.iteration, self.seconds, self.cost, self.error = iteration, seconds, cost, error


class Fit(Network):
    """What `fit` returns: the network, and how it was found."""

    def __init__(self, network: _pbnbrdf.Network, summary: dict[str, Any]) -> None:
        super().__init__(network)
        self.summary = summary
        """iterations, seconds, cost, samples_used, termination, message, max_albedo; history, a list of [iteration,
        seconds, error]; problem, the flags that repeat the fit."""


def open(source: str | os.PathLike[str], symmetrize: bool = False) -> Brdf:
    """Any source that the command line takes: a file, "builtin:satin-gold", "sgd:parameters.csv#nylon",
    "ggx:f0=0.04,alpha=0.1". symmetrize: the mean of f(wi, wo) and f(wo, wi), what a reciprocal fit aims at."""
    brdf = _pbnbrdf.symmetrized(os.fspath(source)) if symmetrize else _pbnbrdf.open(os.fspath(source))
    return Network(brdf) if isinstance(brdf, _pbnbrdf.Network) else Brdf(brdf)


def _measurements(wi: ArrayLike, wo: ArrayLike, rgb: ArrayLike, sigma: ArrayLike | None, isotropic: bool) -> Brdf:
    wi, wo, shape = _pairs(wi, wo)
    values = np.asarray(rgb, dtype=np.float64)
    if values.shape not in (shape, (*shape, 1), (*shape, 3)):
        raise ValueError(f"rgb: shape {values.shape}; must be {shape}, of one channel, or {(*shape, 3)}")
    channels = 3 if values.shape == (*shape, 3) else 1
    values = values.reshape(-1, channels)
    if len(values) == 0:
        raise ValueError("rgb: no measurements")
    if sigma is not None:
        sigma = np.ascontiguousarray(np.broadcast_to(np.asarray(sigma, dtype=np.float64), shape).reshape(-1))
    rows = np.ascontiguousarray(np.broadcast_to(values, (len(values), 3)))
    return Brdf(_pbnbrdf.from_arrays(wi.astype(np.float64), wo.astype(np.float64), rows, sigma, isotropic, channels))


def _field_text(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return ",".join(str(part) for part in value)
    return str(value)


def _progress_bar() -> Callable[[Progress], bool]:
    """A bar of tqdm, where that is installed."""
    try:
        from tqdm.auto import tqdm
    except ModuleNotFoundError:
        return lambda progress: True
    bar = tqdm(unit=" iterations")

    def show(progress: Progress) -> bool:
        bar.update(progress.iteration - bar.n)
        bar.set_postfix(error=f"{progress.error:.3g}")
        return True

    return show


def fit(material: Brdf | str | os.PathLike[str] | None = None, *, wi: ArrayLike | None = None,
        wo: ArrayLike | None = None, rgb: ArrayLike | None = None, sigma: ArrayLike | None = None,
        isotropic: bool = True, problem: str | os.PathLike[str] | Mapping[str, Any] | None = None,
        callback: Callable[[Progress], bool | None] | None = None, progress: bool = False, threads: int = 0,
        **fields: Any) -> Fit:
    """Fits a network to a material, or to measurements: wi and wo of shape (..., 3), rgb of shape (..., 3), or (...)
    of one channel, in 1/sr, and their standard deviation sigma, if it is known.

    problem: a file of flags, or their names and values; fields are more of them, as in
    fit(material, max_iterations=100, terms="log,energy"): pbnbrdf fit --help=all explains each.
    callback: called after each iteration; False ends the fit with the best network so far. progress: shows a bar, if
    tqdm is installed. Ctrl-C ends the fit, too, and raises KeyboardInterrupt.
    """
    arrays = (wi, wo, rgb)
    if (material is None) == all(array is None for array in arrays):
        raise TypeError("fit() takes either a material, or wi, wo and rgb")
    if material is None:
        for name, array in zip(("wi", "wo", "rgb"), arrays):
            if array is None:
                raise TypeError(f"fit(): {name} is missing")
        material = _measurements(wi, wo, rgb, sigma, isotropic)
    elif not isinstance(material, Brdf):
        material = open(material)
    file = ""
    if isinstance(problem, Mapping):
        fields = {**problem, **fields}
    elif problem is not None:
        file = os.fspath(problem)
    listeners = [f for f in (callback, _progress_bar() if progress else None) if f is not None]

    def listen(*numbers: float) -> bool:
        return all([listener(Progress(*numbers)) is not False for listener in listeners])

    network, summary = _pbnbrdf.fit(material._brdf, file, [[name, _field_text(value)] for name, value in fields.items()],
                                    threads, listen if listeners else None)
    return Fit(network, json.loads(summary))


def measure(fit: Brdf | str | os.PathLike[str], material: Brdf | str | os.PathLike[str], samples: int = 200000,
            seed: int = 1) -> dict[str, Any]:
    """What pbnbrdf measure --json prints: errors on held-out samples of the material, reciprocity, energy, colour."""
    fit = fit if isinstance(fit, Brdf) else open(fit)
    material = material if isinstance(material, Brdf) else open(material)
    if samples < 1:
        raise ValueError(f"samples: {samples}; must be >= 1")
    return json.loads(_pbnbrdf.measure(material._brdf, fit._brdf, samples, seed))
