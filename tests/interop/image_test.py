"""pbnbrdf compare agrees with the field's own packages.

flip-evaluator (by FLIP's authors) for FLIP and HDR-FLIP, scikit-image for PSNR and SSIM; OpenEXR's
own package writes the images. Gradients, noise and highlights far above 1, of even and odd sizes.
LPIPS with random weights, which safetensors' own package writes, against the network in NumPy and,
where it is installed (./do peers doesn't), in PyTorch.
"""
import importlib.util
import json
import subprocess
import sys

from common import check, np, path, require

flip, metrics, color, OpenEXR, safetensors_numpy = require(
    "flip_evaluator", "skimage.metrics", "skimage.color", "OpenEXR", "safetensors.numpy")


def write_exr(name, image):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": image.astype(np.float32)}).write(path(name))
    return path(name)


def compare(reference, test, *flags):
    files = [write_exr("reference.exr", reference), write_exr("test.exr", test)]
    done = subprocess.run([sys.argv[1], "compare", *files, "--json", *flags], capture_output=True,
                          text=True)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def scene(height, width, seed):
    """A tinted gradient, a checkerboard of fine detail, and a highlight of 30."""
    rng = np.random.default_rng(seed)
    y, x = np.mgrid[0:height, 0:width]
    tint = rng.uniform(0.2, 1.0, 3)
    image = (x / width)[..., None] * tint + 0.2 * (y / height)[..., None]
    image += 0.3 * ((x // 5 + y // 7) % 2)[..., None] * rng.uniform(0, 1, 3)
    center = rng.uniform(0.3, 0.7, 2) * [height, width]
    distance = (y - center[0]) ** 2 + (x - center[1]) ** 2
    return (image + 30 * np.exp(-distance / 30.0)[..., None] * tint[::-1]).astype(np.float32)


def pairs():
    """(name, reference, test)."""
    rng = np.random.default_rng(9)
    for n, (height, width) in enumerate([(64, 96), (63, 45), (128, 128), (11, 20)]):
        reference = scene(height, width, n)
        noise = rng.normal(scale=0.05, size=reference.shape)
        yield f"noise {n}", reference, np.maximum(reference + noise, 0)
        yield f"tint {n}", reference, reference * [1.1, 0.95, 0.8]
        yield f"shift {n}", reference, np.roll(reference, 2, axis=1)
    reference = scene(80, 80, 20)
    yield "brighter highlights", reference, np.where(reference > 1, 3 * reference, reference)
    dark = reference * (np.mgrid[0:80, 0:80][0] < 50)[..., None]
    yield "black below", dark, np.maximum(dark + rng.normal(scale=0.02, size=dark.shape), 0)
    mostly_dark = reference * (np.mgrid[0:80, 0:80][0] < 30)[..., None]
    yield "median of 0", mostly_dark, 1.1 * mostly_dark
    yield "negative values", reference - 0.3, 1.1 * reference - 0.4
    yield "unrelated", scene(70, 50, 30), scene(70, 50, 31)


def shown(image, exposure):
    """What a screen is given: linear in [0, 1]."""
    return np.clip(exposure * image.astype(np.float64), 0, 1)


def srgb(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def display_exposure(reference):
    luminance = reference.astype(np.float64) @ [0.21263900587151036, 0.715168678767756,
                                                0.07219231536073371]
    ascending = np.sort(luminance.ravel())
    return 1 / ascending[int(np.ceil(0.99 * ascending.size)) - 1]


def expected(reference, test):
    """All measures by NumPy and the packages, but LPIPS."""
    exposure = display_exposure(reference)
    x, y = shown(reference, exposure), shown(test, exposure)
    a, b = srgb(x), srgb(y)
    error = test.astype(np.float64) - reference
    evaluate = lambda p, q, kind: flip.evaluate(
        p.astype(np.float32), q.astype(np.float32), kind, applyMagma=False)[1]
    lab = [color.xyz2lab(color.rgb2xyz(v)) for v in (a, b)]
    return {
        "mae": np.mean(np.abs(error)), "mse": np.mean(error ** 2),
        "rmse": np.sqrt(np.mean(error ** 2)),
        "psnr": metrics.peak_signal_noise_ratio(a, b, data_range=1),
        "ssim": metrics.structural_similarity(
            a, b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=1,
            channel_axis=-1),
        "flip": evaluate(a, b, "LDR"), "hdr_flip": evaluate(reference, test, "HDR"),
        "delta_e_2000": np.mean(color.deltaE_ciede2000(*lab))}


# scikit-image rounds the matrices and the white of XYZ: a few 1e-4 of Delta E.
ALLOWED = {"mae": 1e-6, "mse": 1e-6, "rmse": 1e-6, "psnr": 1e-4, "ssim": 1e-4, "flip": 1e-4,
           "hdr_flip": 1e-4, "delta_e_2000": 2e-3}
worst = dict.fromkeys(ALLOWED, 0.0)
for name, reference, test in pairs():
    test = test.astype(np.float32)
    ours, theirs = compare(reference, test), expected(reference, test)
    assert list(ours) == list(ALLOWED), list(ours)
    for key in ALLOWED:
        difference = abs(ours[key] - theirs[key])
        if key in ("mae", "mse", "rmse"):
            difference /= theirs[key]
        if not difference <= ALLOWED[key]:
            print(f"{name}, {key}: {ours[key]:.7g}, theirs {theirs[key]:.7g}")
        worst[key] = max(worst[key], difference)
for key, bound in ALLOWED.items():
    check(key, worst[key], bound)


# LPIPS. The convolutions: name in the package's state, shape of the kernels, stride, padding, and
# whether pooling comes before.
CONVOLUTIONS = [("net.slice1.0", (64, 3, 11, 11), 4, 2, False),
                ("net.slice2.3", (192, 64, 5, 5), 1, 2, True),
                ("net.slice3.6", (384, 192, 3, 3), 1, 1, True),
                ("net.slice4.8", (256, 384, 3, 3), 1, 1, False),
                ("net.slice5.10", (256, 256, 3, 3), 1, 1, False)]


def random_lpips_weights(seed, dtype):
    """By the package's names; heads and scaling layer included, as in its state."""
    rng = np.random.default_rng(seed)
    weights = {"scaling_layer.shift": np.array([-.030, -.088, -.188], dtype).reshape(1, 3, 1, 1),
               "scaling_layer.scale": np.array([.458, .448, .450], dtype).reshape(1, 3, 1, 1)}
    for k, (name, shape, *_) in enumerate(CONVOLUTIONS):
        deviation = np.sqrt(2 / np.prod(shape[1:]))
        weights[name + ".weight"] = rng.normal(scale=deviation, size=shape).astype(dtype)
        weights[name + ".bias"] = rng.normal(scale=0.1, size=shape[0]).astype(dtype)
        head = rng.uniform(0, 1, (1, shape[0], 1, 1)).astype(dtype)
        weights[f"lin{k}.model.1.weight"] = weights[f"lins.{k}.model.1.weight"] = head
    return weights


def windows(x, size, stride):
    """C x H x W to C x H' x W' x size x size."""
    return np.lib.stride_tricks.sliding_window_view(x, (size, size), (1, 2))[:, ::stride, ::stride]


def numpy_pool(x):
    return windows(x, 3, 2).max((3, 4))


def numpy_convolve(x, kernels, bias, stride, padding):
    padded = np.pad(x, ((0, 0), (padding, padding), (padding, padding)))
    patches = windows(padded, kernels.shape[2], stride)
    return np.einsum("chwij,ucij->uhw", patches, kernels, optimize=True) + bias[:, None, None]


def torch_layers():
    """The same two by PyTorch, or None."""
    if importlib.util.find_spec("torch") is None:
        return None
    import torch
    tensor = lambda a: torch.tensor(np.asarray(a, np.float64))
    pool = lambda x: torch.nn.functional.max_pool2d(tensor(x)[None], 3, 2)[0].numpy()
    convolve = lambda x, kernels, bias, stride, padding: torch.nn.functional.conv2d(
        tensor(x)[None], tensor(kernels), tensor(bias), stride, padding)[0].numpy()
    return pool, convolve


def lpips(a, b, weights, pool, convolve):
    """Of sRGB images in [0, 1], H x W x 3."""
    weights = {name: value.astype(np.float64) for name, value in weights.items()}
    pair = [(2 * v.transpose(2, 0, 1) - 1 - weights["scaling_layer.shift"][0])
            / weights["scaling_layer.scale"][0] for v in (a, b)]
    total = 0
    for k, (name, _, stride, padding, pooled) in enumerate(CONVOLUTIONS):
        pair = [pool(v) if pooled else v for v in pair]
        pair = [np.maximum(convolve(v, weights[name + ".weight"], weights[name + ".bias"], stride,
                                    padding), 0) for v in pair]
        units = [v / (np.sqrt(np.sum(v ** 2, axis=0)) + 1e-10) for v in pair]
        head = weights[f"lin{k}.model.1.weight"][0]
        total += np.mean(np.sum(head * (units[0] - units[1]) ** 2, axis=0))
    return total


layers = {"NumPy": (numpy_pool, numpy_convolve), "PyTorch": torch_layers()}
worst = {peer: 0.0 for peer, functions in layers.items() if functions}
for n, (height, width) in enumerate([(31, 31), (64, 96), (63, 45), (130, 71)]):
    reference, test = scene(height, width, 40 + n), scene(height, width, 50 + n)
    weights = random_lpips_weights(n, np.float32 if n % 2 == 0 else np.float64)
    safetensors_numpy.save_file(weights, path("alex.safetensors"))
    ours = compare(reference, test, "--lpips=" + path("alex.safetensors"))
    assert list(ours) == [*ALLOWED, "lpips"], list(ours)
    exposure = display_exposure(reference)
    display = [srgb(shown(v, exposure)) for v in (reference, test)]
    for peer in worst:
        theirs = lpips(*display, weights, *layers[peer])
        assert theirs > 0.01, theirs
        worst[peer] = max(worst[peer], abs(ours["lpips"] / theirs - 1))
for peer, difference in worst.items():
    check(f"lpips, relative, {peer}", difference, 1e-6)
