"""The published recipe: trains the neural BRDFs of two papers on a MERL table, with PyTorch.

  nbrdf    Sztrajman, Rainer, Ritschel, Weyrich. Neural BRDF Representation and Importance Sampling.
           Computer Graphics Forum 40(6), 2021.
  pbnbrdf  Sztrajman, Zhou, Rainer, Zhong, Oztireli, Mantiuk. Physically-based Neural BRDF. Equation
           and section numbers below are this paper's.

This is the baseline that pbnbrdf is compared with, so it is made to be fast: derivatives are
written by hand, each operation writes to memory that is allocated once, and TorchScript runs the
loop over the batches. README.md says how to run it, and what it does where the papers leave
something open.
"""
import argparse
import json
import math
import os
import pathlib
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from typing import Final, List


def configure_openblas():
    """OpenBLAS 0.3.21 takes processors that are newer than it for very old ones, so it is told
    which kernels to use. One thread, as more are slower with matrices this small. It reads these
    variables when it is loaded."""
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    cpuinfo = pathlib.Path("/proc/cpuinfo")
    flags = cpuinfo.read_text().split() if cpuinfo.exists() else []
    if "avx512bw" in flags and "avx512vl" in flags:
        os.environ.setdefault("OPENBLAS_CORETYPE", "SkylakeX")
    elif "avx2" in flags and "fma" in flags:
        os.environ.setdefault("OPENBLAS_CORETYPE", "Haswell")


configure_openblas()

import numpy as np  # noqa: E402
import torch  # noqa: E402
from torch import Tensor  # noqa: E402

# The published set-up; the rest of it are Trainer's constants and the defaults of the flags.
HIDDEN = 21
BATCH = 512
INITIAL_RANGE = 0.05
TRAINING_PART = 0.8

# What the papers leave open: see README.md.
CHROMATICITY_WEIGHT = ENERGY_WEIGHT = 1.0
INCIDENT, THETA_H, PHI_H = 2, 32, 16
DIRECTION_SETS = 64
MIN_LIT_PART = 0.01

# The layers in memory. One of a layer's inputs is the constant 1, so that biases are a column of
# the weights. Zeros fill up to a multiple of 8, as many numbers as a vector register holds.
INPUTS, UNITS = 8, 24
BIAS_COLUMNS = 6, HIDDEN, HIDDEN
SHAPES = (UNITS, INPUTS), (UNITS, UNITS), (3, UNITS)

# A sample: the network's inputs, cos_i, 1 - cos_i, 1 + f cos_i of each colour, 1 + |f cos_i|^2.
SAMPLE = [INPUTS, 1, 1, 3, 1]


class MerlTable:
    """A file of the MERL database: the numbers of bins of theta_h, theta_d and phi_d, then f of
    each colour. sqrt(theta_h) is divided evenly; 360 bins of phi_d are the whole circle, and any
    other number half of it. f is negative where it isn't known; keep = "known" makes it NaN there,
    and so every value that is interpolated from it."""

    def __init__(self, path, keep="red"):
        try:
            with open(path, "rb") as file:
                self.bins = [int(bins) for bins in np.fromfile(file, "<i4", 3)]
                stored = np.fromfile(file, "<f8")
        except OSError as error:
            sys.exit(f"{path}: can't be read: {error.strerror}")
        if len(self.bins) < 3 or min(self.bins) < 1 or len(stored) != 3 * math.prod(self.bins):
            sys.exit(f"{path}: not a MERL file: it hasn't the length that its header asks for")
        if not np.isfinite(stored).all():
            sys.exit(f"{path}: damaged MERL file: not all values are finite numbers")
        self.f = stored.reshape(3, -1).T * [1.0 / 1500.0, 1.15 / 1500.0, 1.66 / 1500.0]
        if keep == "known":
            self.f[self.f.min(1) < 0.0] = np.nan
        self.circle = 2.0 * math.pi if self.bins[2] == 360 else math.pi

    def interpolate(self, theta_h, theta_d, phi_d):
        """f, n x 3 in 1/sr, trilinear between the corners of a bin. The last bins of theta_h and
        theta_d have no upper corners and are constant."""
        quarter = 0.5 * math.pi
        position = np.sqrt(theta_h / quarter), theta_d / quarter, phi_d % self.circle / self.circle
        position = [x * bins for x, bins in zip(position, self.bins)]
        lower = [np.minimum(x.astype(int), bins - 1) for x, bins in zip(position, self.bins)]
        f = np.zeros((len(theta_h), 3))
        for corner in np.ndindex(2, 2, 2):
            h, d, p = [index + upper for index, upper in zip(lower, corner)]
            bin_h, bin_d = np.minimum(h, self.bins[0] - 1), np.minimum(d, self.bins[1] - 1)
            row = (bin_h * self.bins[1] + bin_d) * self.bins[2] + p % self.bins[2]
            weight = np.prod([1.0 - abs(x - k) for x, k in zip(position, (h, d, p))], axis=0)
            f += weight[:, None] * self.f[row]
        return f


def network_inputs(theta_h, d, reciprocal):
    """INPUTS rows: the half vector at phi_h = 0, the difference vector and 1. reciprocal: phi_d is
    doubled, section 4.1."""
    x, y, z = d
    if reciprocal:
        sine = np.maximum(np.hypot(x, y), 1e-30)  # of theta_d, not 0
        x, y = (x * x - y * y) / sine, 2.0 * x * y / sine
    zero = np.zeros_like(x)
    return np.stack([np.sin(theta_h), zero, np.cos(theta_h), x, y, z, zero + 1.0, zero])


def draw_samples(table, count, reciprocal, rng):
    """Columns as SAMPLE has them, of uniform angles, fewer than count: only where f is known."""
    theta_h, theta_d, phi_d = rng.random((3, count)) * math.pi * [[0.5], [0.5], [2.0]]
    f = table.interpolate(theta_h, theta_d, phi_d).T
    known = f[0] >= 0.0
    theta_h, theta_d, phi_d, f = theta_h[known], theta_d[known], phi_d[known], f[:, known]
    d = np.sin(theta_d) * np.cos(phi_d), np.sin(theta_d) * np.sin(phi_d), np.cos(theta_d)
    cos_i = np.clip(d[2] * np.cos(theta_h) - d[0] * np.sin(theta_h), 0.0, 1.0)
    lit = f * cos_i
    return torch.from_numpy(np.concatenate([
        network_inputs(theta_h, d, reciprocal), [cos_i, 1.0 - cos_i],
        1.0 + lit, [1.0 + (lit * lit).sum(0)]]).astype(np.float32))


def draw_directions(sets, rng):
    """For the integrals of eq. 5: network inputs, sets x INPUTS x n, and weights, sets x n x
    INCIDENT. f (3 x n) times a set's weights is the albedo of each colour and incident direction.

    Incident directions are stratified by solid angle. Outgoing ones are the mirror images about
    half vectors with theta_h = (pi/2) t^2, which are dense at the highlight, on a grid of t and
    phi_h that is shifted at random. d wo = 4 (wi.h) d wh."""
    shift = rng.random((3, sets, INCIDENT, 1, 1))
    cos_i = (np.arange(INCIDENT)[:, None, None] + shift[0]) / INCIDENT
    t = (np.arange(THETA_H)[:, None] + shift[1]) / THETA_H
    phi_h = (np.arange(PHI_H) + shift[2]) / PHI_H * 2.0 * math.pi
    cos_i, t, phi_h = np.broadcast_arrays(cos_i, t, phi_h)
    theta_h, sin_i = 0.5 * math.pi * t * t, np.sqrt(1.0 - cos_i * cos_i)
    sin_h, cos_h = np.sin(theta_h), np.cos(theta_h)
    x, y = sin_i * np.cos(phi_h), -sin_i * np.sin(phi_h)  # wi, turned by -phi_h about the normal
    d = x * cos_h - cos_i * sin_h, y, x * sin_h + cos_i * cos_h
    cos_o = np.maximum(2.0 * d[2] * cos_h - cos_i, 0.0)
    d_wh = sin_h * math.pi * t / THETA_H * 2.0 * math.pi / PHI_H
    weight = cos_o * 4.0 * np.maximum(d[2], 0.0) * d_wh
    weights = np.einsum("skij,kl->skijl", weight, np.eye(INCIDENT))
    inputs = np.moveaxis(network_inputs(theta_h, d, reciprocal=True), 0, 1)
    return (torch.from_numpy(inputs.reshape(sets, INPUTS, -1).astype(np.float32)),
            torch.from_numpy(weights.reshape(sets, -1, INCIDENT).astype(np.float32)))


def layers(flat):
    """Views of the three layers' matrices."""
    parts = flat.split([rows * columns for rows, columns in SHAPES])
    return [part.view(shape) for part, shape in zip(parts, SHAPES)]


def evaluate(weights, inputs):
    """f, 3 x n in 1/sr."""
    w1, w2, w3 = layers(weights)
    one = torch.eye(UNITS)[:, HIDDEN:HIDDEN + 1]
    hidden = torch.relu(w2 @ (torch.relu(w1 @ inputs) + one)) + one
    return torch.relu(torch.exp(w3 @ hidden) - 1.0)


def log_loss(weights, samples):
    """Eq. 6, mean over samples and colours."""
    inputs, cos_i, _, target, _ = samples.split(SAMPLE)
    predicted = 1.0 + evaluate(weights, inputs) * cos_i
    return float((torch.log(predicted) - torch.log(target)).abs().double().mean())


def draw_weights(inputs, rng):
    """Weights uniform in +-INITIAL_RANGE and biases 0, and how often they were drawn: again when a
    colour is black nearly everywhere, as it would stay so. relu(exp(z) - 1) has no slope at 0."""
    for draws in range(1, 1000):
        weights = torch.zeros(sum(rows * columns for rows, columns in SHAPES))
        for w, columns in zip(layers(weights), BIAS_COLUMNS):
            start = rng.uniform(-INITIAL_RANGE, INITIAL_RANGE, (min(HIDDEN, len(w)), columns))
            w[:len(start), :columns] = torch.from_numpy(start)
        if (evaluate(weights, inputs) > 0.0).float().mean(1).min() > MIN_LIT_PART:
            return weights, draws
    sys.exit("no start found of which no colour is black")


class Network(torch.nn.Module):
    """The network forward and backward over n samples, a column each."""

    def __init__(self, weights, gradient, n):
        super().__init__()
        w1, w2, self.w3 = layers(weights)
        self.w1, self.w2 = w1[:HIDDEN], w2[:HIDDEN]
        self.w2_back, self.w3_back = w2[:HIDDEN, :HIDDEN].t(), self.w3[:, :HIDDEN].t()
        self.gradient1, self.gradient2, self.gradient3 = layers(gradient)
        self.layer1, self.layer2, self.d_layer1, self.d_layer2 = [
            torch.zeros(UNITS, n) for _ in range(4)]
        self.layer1[HIDDEN] = self.layer2[HIDDEN] = 1.0
        self.layer1_back, self.layer2_back = self.layer1.t(), self.layer2.t()
        self.units1, self.units2 = self.layer1[:HIDDEN], self.layer2[:HIDDEN]
        self.d_units1, self.d_units2 = self.d_layer1[:HIDDEN], self.d_layer2[:HIDDEN]
        self.z, self.exp_z, self.d_z = [torch.zeros(3, n) for _ in range(3)]

    def forward(self, inputs):
        """Sets z, after a relu, and exp_z: relu(exp(z) - 1) = exp(relu(z)) - 1."""
        torch.mm(self.w1, inputs, out=self.units1).relu_()
        torch.mm(self.w2, self.layer1, out=self.units2).relu_()
        torch.mm(self.w3, self.layer2, out=self.z).relu_()
        torch.exp(self.z, out=self.exp_z)

    def backward(self, inputs, keep: float):
        """gradient = keep gradient + that of a loss whose derivative by z is d_z."""
        torch.ops.aten.threshold_backward(self.d_z, self.z, 0.0, grad_input=self.d_z)
        self.gradient3.addmm_(self.d_z, self.layer2_back, beta=keep)
        d_units2, d_units1 = self.d_units2, self.d_units1
        torch.mm(self.w3_back, self.d_z, out=d_units2)
        torch.ops.aten.threshold_backward(d_units2, self.units2, 0.0, grad_input=d_units2)
        self.gradient2.addmm_(self.d_layer2, self.layer1_back, beta=keep)
        torch.mm(self.w2_back, d_units2, out=d_units1)
        torch.ops.aten.threshold_backward(d_units1, self.units1, 0.0, grad_input=d_units1)
        self.gradient1.addmm_(self.d_layer1, inputs.t(), beta=keep)


class Trainer(torch.nn.Module):
    """Adam on the sum of the losses. The gradient is kept times 3 BATCH, which is what a sum over
    samples and colours has, as Adam's steps don't depend on its scale."""

    step: Final[float] = 5e-4  # published, as is epsilon; beta1 and beta2 are the usual ones
    beta1: Final[float] = 0.9
    beta2: Final[float] = 0.999
    epsilon: Final[float] = 1e-15 * 3.0 * BATCH
    norm_scale: Final[float] = CHROMATICITY_WEIGHT * 3.0 * 2.0  # 2: of a square
    energy_scale: Final[float] = ENERGY_WEIGHT * BATCH * 2.0 * math.pi / INCIDENT

    def __init__(self, weights, pbnbrdf: bool):
        super().__init__()
        self.pbnbrdf, self.steps = pbnbrdf, 0
        self.weights = weights.clone()
        self.gradient, self.mean, self.square, self.root = [
            torch.zeros_like(weights) for _ in range(4)]
        self.at_samples = Network(self.weights, self.gradient, BATCH)
        self.at_directions = Network(self.weights, self.gradient, INCIDENT * THETA_H * PHI_H)
        self.predicted, self.slope, self.squares = [torch.zeros(3, BATCH) for _ in range(3)]
        self.norm, self.norm_slope = torch.zeros(1, BATCH), torch.zeros(1, BATCH)

    @torch.jit.export
    def set_gradient(self, inputs, cos_i, rest, target, target_norm):
        """To that of eqs. 6 and 7. |log(a) - log(b)| has slope sign(a - b) / a: no logarithm."""
        network, predicted, slope = self.at_samples, self.predicted, self.slope
        network.forward(inputs)
        torch.mul(network.exp_z, cos_i, out=network.d_z)  # the derivative of f cos_i by z
        torch.add(network.d_z, rest, out=predicted)  # 1 + f cos_i = exp(z) cos_i + 1 - cos_i
        torch.sub(predicted, target, out=slope).sign_().div_(predicted)
        if self.pbnbrdf:
            lit, norm, norm_slope = predicted.sub_(1.0), self.norm, self.norm_slope
            torch.mul(lit, lit, out=self.squares)
            torch.sum(self.squares, [0], True, out=norm).add_(1.0)
            torch.sub(norm, target_norm, out=norm_slope).sign_().div_(norm).mul_(self.norm_scale)
            slope.addcmul_(lit, norm_slope)
        network.d_z.mul_(slope)
        network.backward(inputs, 0.0)

    @torch.jit.export
    def add_energy_gradient(self, inputs, weights):
        """That of eq. 5, mean over the colours. It is 0 while no albedo exceeds 1."""
        network = self.at_directions
        network.forward(inputs)
        albedo = torch.addmm(weights.sum(0), network.exp_z, weights, beta=-1.0)
        if float(albedo.max()) > 1.0:
            torch.mm((albedo > 1.0).float(), weights.t(), out=network.d_z)
            network.d_z.mul_(network.exp_z).mul_(self.energy_scale)
            network.backward(inputs, 1.0)

    @torch.jit.export
    def adam(self):
        self.steps += 1
        correction = math.sqrt(1.0 - math.pow(self.beta2, float(self.steps)))
        step = self.step * correction / (1.0 - math.pow(self.beta1, float(self.steps)))
        self.mean.lerp_(self.gradient, 1.0 - self.beta1)
        self.square.mul_(self.beta2).addcmul_(self.gradient, self.gradient, value=1.0 - self.beta2)
        torch.sqrt(self.square, out=self.root).add_(self.epsilon * correction)
        self.weights.addcdiv_(self.mean, self.root, value=-step)

    @torch.jit.export
    def epoch(self, samples: List[List[Tensor]], directions: List[List[Tensor]]):
        """Lists of batches of each part of SAMPLE, and of sets as draw_directions returns them."""
        inputs, cos_i, rest, target, target_norm = samples
        for i in range(len(inputs)):
            self.set_gradient(inputs[i], cos_i[i], rest[i], target[i], target_norm[i])
            if self.pbnbrdf:
                k = i % len(directions[0])
                self.add_energy_gradient(directions[0][k], directions[1][k])
            self.adam()


def epochs(samples, pbnbrdf, seed):
    """Yields what Trainer.epoch takes: the samples in a new random order, and new directions."""
    rng, generator = np.random.default_rng([seed, 2]), torch.Generator().manual_seed(seed)
    count = samples.size(1)
    while True:
        with torch.inference_mode():
            order = torch.randperm(count, generator=generator)[:count // BATCH * BATCH]
            parts = samples.index_select(1, order).split(SAMPLE)
            sets = draw_directions(DIRECTION_SETS, rng) if pbnbrdf else []
            batches = [list(part.split(BATCH, 1)) for part in parts]
        yield batches, [list(x.unbind()) for x in sets]


def train(weights, training, heldout, options):
    """The trained weights, and for each epoch its number, the seconds of training until its end,
    the loss of some training samples and that of the held-out ones. Measuring isn't timed."""
    pbnbrdf = options.method == "pbnbrdf"
    warm_up = torch.jit.script(Trainer(weights, pbnbrdf))  # compiles what the other one runs
    for _ in range(3):
        warm_up.epoch(*next(epochs(training[:, :2 * BATCH], pbnbrdf, seed=0)))
    trainer = torch.jit.script(Trainer(weights, pbnbrdf))
    trace, seconds, start = [], 0.0, time.perf_counter()
    source = epochs(training, pbnbrdf, options.seed)
    upcoming = next(source)
    with ThreadPoolExecutor(1) as second_thread:
        for epoch in range(1, options.epochs + 1):
            more, threads = epoch < options.epochs, options.threads > 1
            job = second_thread.submit(next, source) if more and threads else None
            trainer.epoch(*upcoming)
            if more:
                upcoming = job.result() if job else next(source)
            seconds += time.perf_counter() - start
            if options.trace or not more:
                seen = training[:, :heldout.size(1)]
                losses = log_loss(trainer.weights, seen), log_loss(trainer.weights, heldout)
                trace.append((epoch, seconds, *losses))
            start = time.perf_counter()
    return trainer.weights, trace


def write_weights(weights, folder):
    """fcN.npy (inputs x outputs) and bN.npy, as NBRDF's plugin for Mitsuba reads them."""
    os.makedirs(folder, exist_ok=True)
    for n, (w, columns) in enumerate(zip(layers(weights), BIAS_COLUMNS), 1):
        w = w[:HIDDEN].numpy()
        np.save(f"{folder}/fc{n}.npy", np.ascontiguousarray(w[:, :columns].T))
        np.save(f"{folder}/b{n}.npy", np.ascontiguousarray(w[:, columns]))


def parse_options():
    parser = argparse.ArgumentParser(description="Trains a published neural BRDF on a MERL table.")
    parser.add_argument("--material", required=True, help="a file of the MERL database")
    parser.add_argument("--method", required=True, choices=["nbrdf", "pbnbrdf"])
    parser.add_argument("--out", help="folder for the weights, fc1.npy, b1.npy and so on")
    parser.add_argument("--trace", help="CSV file for the seconds and losses of each epoch")
    parser.add_argument("--epochs", type=int, default=100)
    parser.add_argument("--samples", type=int, default=800000, help="drawn, known or not")
    parser.add_argument("--keep", choices=["red", "known"], default="red",
                        help="red: samples whose interpolated red isn't negative, as published; "
                        "known: those between known values only")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--threads", type=int, default=2, help="2: one prepares the next epoch")
    options = parser.parse_args()
    if options.epochs < 1 or options.seed < 0:
        parser.error("epochs must be at least 1, and the seed not negative")
    return options


@torch.inference_mode()
def main():
    options = parse_options()
    start = time.perf_counter()
    torch.set_num_threads(1)
    torch.set_flush_denormal(True)
    table, rng = MerlTable(options.material, options.keep), np.random.default_rng([options.seed, 1])
    training_count = round(TRAINING_PART * options.samples)
    training, heldout = [draw_samples(table, count, options.method == "pbnbrdf", rng)
                         for count in (training_count, options.samples - training_count)]
    if training.size(1) < 2 * BATCH or heldout.size(1) == 0:
        sys.exit(f"{options.material}: too few samples are known, {training.size(1)} to train on")
    weights, draws = draw_weights(training[:INPUTS, :4096], rng)
    weights, trace = train(weights, training, heldout, options)
    _, seconds, train_loss, test_loss = trace[-1]
    if not math.isfinite(test_loss):
        sys.exit(f"{options.material}: training diverged")
    if options.trace:
        with open(options.trace, "w") as file:
            file.write("epoch,seconds,train_loss,test_loss\n")
            file.writelines("%d,%.4f,%.8f,%.8f\n" % row for row in trace)
    if options.out:
        write_weights(weights, options.out)
    print(json.dumps({
        "method": options.method, "keep": options.keep, "seed": options.seed,
        "epochs": options.epochs, "threads": options.threads, "starts": draws,
        "train_samples": training.size(1), "test_samples": heldout.size(1),
        "train_loss": train_loss, "test_loss": test_loss,
        "train_seconds": seconds, "other_seconds": time.perf_counter() - start - seconds,
        "torch": torch.__version__, "kernels": os.environ.get("OPENBLAS_CORETYPE", "")}, indent=1))


if __name__ == "__main__":
    main()
