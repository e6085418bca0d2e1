"""experiments/peers/published_recipe.py trains what the papers say.

Its derivatives by hand against PyTorch's own, of losses written here as the papers have them; its
steps against torch.optim.Adam; its quadrature against a material of known albedo; and the program.

Called as  TEST.py PUBLISHED_RECIPE.py FOLDER  with a folder to write to. Exit status 77: PyTorch is
missing, and the test is skipped.
"""
import json
import math
import os
import subprocess
import sys

script, folder = sys.argv[1:3]
sys.path.insert(0, os.path.dirname(script))
try:
    import published_recipe as recipe
except ModuleNotFoundError as missing:
    print(f"skipped: needs the Python package {missing.name}, which Debian's python3-torch brings")
    sys.exit(77)
import numpy as np
import torch


def write_material(file, scale=1.0):
    """A MERL table of a diffuse part and a lobe, in colours, unknown below the horizon."""
    theta_h = 0.5 * math.pi * (np.arange(90) / 90.0)[:, None, None] ** 2
    theta_d = 0.5 * math.pi * np.arange(90)[:, None] / 90.0
    phi_d = math.pi * np.arange(180) / 180.0
    shared = np.cos(theta_h) * np.cos(theta_d)
    below = shared - abs(np.sin(theta_h) * np.sin(theta_d) * np.cos(phi_d)) <= 1e-4
    f = 0.1 + 2.0 * np.exp(-(np.tan(theta_h) / 0.3) ** 2) + 0.0 * theta_d + 0.0 * phi_d
    planes = [np.where(below, -1.0, scale * f * c * 1500.0 / s)
              for c, s in ((1.0, 1.0), (0.6, 1.15), (0.3, 1.66))]
    with open(file, "wb") as out:
        np.array([90, 90, 180], "<i4").tofile(out)
        np.array(planes, "<f8").tofile(out)


def samples_of(file, count, reciprocal):
    return recipe.draw_samples(recipe.MerlTable(file), count, reciprocal, np.random.default_rng(5))


def brdf(weights, inputs):
    """NBRDF's network; `weights` as recipe.layers has them."""
    w1, w2, w3 = recipe.layers(weights)
    hidden = torch.relu(w1[:21, :6] @ inputs[:6] + w1[:21, 6:7])
    hidden = torch.relu(w2[:21, :21] @ hidden + w2[:21, 21:22])
    return torch.relu(torch.exp(w3[:, :21] @ hidden + w3[:, 21:22]) - 1.0)


def log_term(weights, batch):
    """Eq. 6, mean over samples and colours."""
    cos_i, target = batch[8], batch[10:13] - 1.0
    return (torch.log(1.0 + brdf(weights, batch) * cos_i) - torch.log(1.0 + target)).abs().mean()


def chromaticity_term(weights, batch):
    """Eq. 7, mean over samples."""
    cos_i, target = batch[8], batch[10:13] - 1.0
    norm, target_norm = [(x * x).sum(0) for x in (brdf(weights, batch) * cos_i, target)]
    return (torch.log(1.0 + norm) - torch.log(1.0 + target_norm)).abs().mean()


def energy_term(weights, inputs, quadrature):
    """Eq. 5, mean over the colours: the outer integral is over the incident hemisphere, 2 pi."""
    albedo = brdf(weights, inputs) @ quadrature
    return 2.0 * math.pi * torch.relu(albedo - 1.0).mean()


def autograd_loss(weights, batch, directions, pbnbrdf):
    loss = log_term(weights, batch)
    if pbnbrdf:
        loss = loss + chromaticity_term(weights, batch) + energy_term(weights, *directions)
    return loss


def random_weights(seed, brightness=0.0):
    """In the padded layout, with zeros where there is no weight."""
    generator = torch.Generator().manual_seed(seed)
    weights = torch.zeros(sum(rows * columns for rows, columns in recipe.SHAPES))
    for w, columns in zip(recipe.layers(weights), recipe.BIAS_COLUMNS):
        rows = min(21, len(w))
        w[:rows, :columns + 1] = 0.4 * torch.randn(rows, columns + 1, generator=generator)
    recipe.layers(weights)[2][:, 21] += brightness
    return weights


def trainer_gradient(weights, batch, directions, pbnbrdf):
    trainer = recipe.Trainer(weights.float(), pbnbrdf)
    trainer.set_gradient(*batch.float().split(recipe.SAMPLE))
    if pbnbrdf:
        trainer.add_energy_gradient(*[x.float() for x in directions])
    return trainer.gradient.double() / (3 * recipe.BATCH)


def check(what, worst, bound):
    print(f"{what}: {worst:.3g}, allowed {bound:.3g}")
    if not worst <= bound:
        sys.exit(f"FAILED: {what}")


def directions_of(sets):
    return [x.double() for x in recipe.draw_directions(sets, np.random.default_rng(7))]


def check_gradients(material):
    """In float, against autograd in double, and that against differences."""
    for pbnbrdf in (False, True):
        batch = samples_of(material, 2000, pbnbrdf)[:, :recipe.BATCH].double()
        directions = [x[0] for x in directions_of(1)]
        for brightness in (-1.0, 1.0):  # without and with albedos above 1
            weights = random_weights(3, brightness).double().requires_grad_()
            loss = autograd_loss(weights, batch, directions, pbnbrdf)
            expected, = torch.autograd.grad(loss, weights)
            energy = float(energy_term(weights.detach(), *directions))
            assert energy > 0.1 if brightness > 0.0 else energy == 0.0, energy
            found = trainer_gradient(weights.detach(), batch, directions, pbnbrdf)
            what = f"gradient, pbnbrdf {pbnbrdf}, brightness {brightness}"
            check(what, float((found - expected).abs().max() / expected.abs().max()), 1e-5)
        step = 1e-6 * expected / expected.norm()
        with torch.no_grad():
            ends = [autograd_loss(weights + s * step, batch, directions, pbnbrdf) for s in (1, -1)]
        slope = float((ends[0] - ends[1]) / (2.0 * step.norm()))
        check("slope along it", abs(slope / float(expected.norm()) - 1.0), 1e-4)


def check_steps(material):
    """TorchScript's epoch of four batches against torch.optim.Adam."""
    samples = samples_of(material, 5000, True)[:, :4 * recipe.BATCH]
    directions = recipe.draw_directions(3, np.random.default_rng(7))
    weights = random_weights(4, brightness=1.0).requires_grad_()
    trainer = torch.jit.script(recipe.Trainer(weights.detach(), True))
    optimizer = torch.optim.Adam([weights], lr=5e-4, eps=1e-15)
    parts = [list(part.split(recipe.BATCH, 1)) for part in samples.split(recipe.SAMPLE)]
    trainer.epoch(parts, [list(x.unbind()) for x in directions])
    for n, batch in enumerate(samples.split(recipe.BATCH, 1)):
        optimizer.zero_grad()
        autograd_loss(weights, batch, [x[n % 3] for x in directions], True).backward()
        optimizer.step()
    moved = 4 * 5e-4
    check("Adam", float((trainer.weights - weights).abs().max()) / moved, 1e-3)


def check_quadrature():
    """A Lambertian f = 1/pi has albedo 1, at each incident direction."""
    _, weights = directions_of(200)
    check("albedo of a set", float((weights.sum(1) / math.pi - 1.0).abs().max()), 0.05)
    check("mean albedo", float(abs(weights.sum(1).mean() / math.pi - 1.0)), 2e-3)


def check_reciprocity():
    """phi_d + pi is phi_d for pbnbrdf, and not for nbrdf."""
    theta_h, theta_d = np.full(5, 0.3), np.full(5, 0.8)
    phi_d = np.linspace(0.1, 3.0, 5)
    one, other = [(np.sin(theta_d) * np.cos(p), np.sin(theta_d) * np.sin(p), np.cos(theta_d))
                  for p in (phi_d, phi_d + math.pi)]
    for reciprocal in (True, False):
        inputs = [recipe.network_inputs(theta_h, d, reciprocal) for d in (one, other)]
        assert (abs(inputs[0] - inputs[1]).max() < 1e-12) == reciprocal, inputs


def check_table(material):
    """f at corners of bins; samples where it isn't known are dropped."""
    table = recipe.MerlTable(material)
    h, d, p = np.array([[0, 3, 30], [0, 40, 20], [0, 7, 179]])
    found = table.interpolate(0.5 * math.pi * (h / 90.0) ** 2, 0.5 * math.pi * d / 90.0,
                              math.pi * (p + 1e-9) / 180.0 + math.pi)
    expected = table.f[(h * 90 + d) * 180 + p]
    check("corners", np.abs(found / expected - 1.0).max(), 1e-6)
    counts = []
    for keep, smallest in (("red", 1.0 - 2e-3), ("known", 1.0 + 1e-4)):
        table = recipe.MerlTable(material, keep)
        samples = recipe.draw_samples(table, 20000, False, np.random.default_rng(5))
        lit = samples[:, samples[8] > 0.01]
        assert float(lit[10:13].min()) >= smallest, lit[10:13].min()
        counts.append(samples.size(1))
    assert 11000 < counts[1] < counts[0] < 14000, counts


def train(method, threads, material):
    """Two epochs: the summary, the trace, the folder of the weights."""
    out, trace = f"{folder}/{method}", f"{folder}/{method}.csv"
    done = subprocess.run([sys.executable, script, "--material", material, "--method", method,
                           "--epochs", "2", "--samples", "40000", "--threads", str(threads),
                           "--out", out, "--trace", trace], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"FAILED: {done.stderr}")
    return json.loads(done.stdout), np.genfromtxt(trace, delimiter=",", names=True), out


def check_program(material):
    """The losses fall, and the files are as the comparison reads them."""
    for method in ("nbrdf", "pbnbrdf"):
        summary, trace, out = train(method, 2, material)
        assert abs(summary["train_seconds"] - trace["seconds"][-1]) < 1e-3
        assert list(trace["epoch"]) == [1, 2] and np.all(np.diff(trace["seconds"]) > 0.0)
        for loss in ("train_loss", "test_loss"):
            assert trace[loss][1] < 0.9 * trace[loss][0], trace[loss]
            assert abs(trace[loss][1] - summary[loss]) < 1e-7
        arrays = [np.load(f"{out}/{name}{n}.npy") for n in (1, 2, 3) for name in ("fc", "b")]
        shapes = [(6, 21), (21,), (21, 21), (21,), (21, 3), (3,)]
        assert [x.shape for x in arrays] == shapes and all(x.dtype == "<f4" for x in arrays)
    one_thread, _, _ = train(method, 1, material)
    assert one_thread["test_loss"] == summary["test_loss"]


def check_errors():
    bad = f"{folder}/bad.binary"
    with open(bad, "wb") as file:
        np.array([90, 90, 180], "<i4").tofile(file)
    for file, expected in ((bad, "not a MERL file"), (f"{folder}/absent", "can't be read")):
        try:
            recipe.MerlTable(file)
        except SystemExit as error:
            message = str(error)
        assert file in message and expected in message, message


os.makedirs(folder, exist_ok=True)
merl_file = f"{folder}/material.binary"
write_material(merl_file)
check_gradients(merl_file)
check_steps(merl_file)
check_quadrature()
check_reciprocity()
check_table(merl_file)
check_program(merl_file)
check_errors()
