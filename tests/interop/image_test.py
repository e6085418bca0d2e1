"""pbnbrdf compare agrees with the field's own packages.

flip-evaluator (by FLIP's authors) for FLIP and HDR-FLIP, scikit-image for PSNR and SSIM; OpenEXR's
own package writes the images. Gradients, noise and highlights far above 1, of even and odd sizes.
"""
import json
import subprocess
import sys

from common import check, np, path, require

flip, metrics, color, OpenEXR = require("flip_evaluator", "skimage.metrics", "skimage.color",
                                        "OpenEXR")


def write_exr(name, image):
    header = {"compression": OpenEXR.ZIP_COMPRESSION, "type": OpenEXR.scanlineimage}
    OpenEXR.File(header, {"RGB": image.astype(np.float32)}).write(path(name))
    return path(name)


def compare(reference, test):
    files = [write_exr("reference.exr", reference), write_exr("test.exr", test)]
    done = subprocess.run([sys.argv[1], "compare", *files, "--json"], capture_output=True, text=True)
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
    yield "unrelated", scene(70, 50, 30), scene(70, 50, 31)


def shown(image, exposure):
    """What a screen is given: linear in [0, 1]."""
    return np.clip(exposure * image.astype(np.float64), 0, 1)


def srgb(linear):
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def expected(reference, test):
    """All measures by NumPy and the packages."""
    luminance = reference.astype(np.float64) @ [0.21263900587151036, 0.715168678767756,
                                                0.07219231536073371]
    ascending = np.sort(luminance.ravel())
    exposure = 1 / ascending[int(np.ceil(0.99 * ascending.size)) - 1]
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
