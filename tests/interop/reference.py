"""The network once more, in NumPy and double precision, from what the official package reads.

Unlike the program's `values`, it takes directions as they are, also those that have length 1 in
single precision only: near the mirror direction that makes a difference.
"""
from common import np, require

safetensors, = require("safetensors")


def read(file):
    """(encoding, activation, [(W, b), ...])"""
    with safetensors.safe_open(file, framework="numpy") as opened:
        names = set(opened.keys())
        metadata = opened.metadata()
        layers = []
        while f"fc{len(layers) + 1}.weight" in names:
            name = f"fc{len(layers) + 1}"
            layers.append((opened.get_tensor(name + ".weight"), opened.get_tensor(name + ".bias")))
    assert metadata["format"] == "pbnbrdf" and metadata["output"] == "expm1"
    return metadata["encoding"], metadata["activation"], layers


NOT_RECIPROCAL = ("cartesian", "nonreciprocal")


def encode(encoding, wi, wo):
    """N x 6 inputs."""
    total = wi + wo
    length = np.linalg.norm(total, axis=1)
    h = total / np.where(length > 0, length, 1)[:, None]
    theta = np.arctan2(np.hypot(h[:, 0], h[:, 1]), h[:, 2])
    phi = np.arctan2(h[:, 1], h[:, 0])
    # d is the difference in the frame of h: turned by -phi about z, then by -theta about y.
    e = 0.5 * (wi - wo)
    x = np.cos(phi) * e[:, 0] + np.sin(phi) * e[:, 1]
    y = np.cos(phi) * e[:, 1] - np.sin(phi) * e[:, 0]
    x = np.cos(theta) * x - np.sin(theta) * e[:, 2]
    z = 0.5 * length
    s2, phi_d = x * x + y * y, np.arctan2(y, x)
    root, log = np.sqrt(theta / (np.pi / 2)), np.log(theta + 0.001) / 3
    u = np.modf(90 * root)[0]
    bend = 4 * u * (1 - u)
    sin, cos, zero = np.sin(theta), np.cos(theta), np.zeros_like(theta)
    c2, s2phi = s2 * np.cos(2 * phi_d), s2 * np.sin(2 * phi_d)
    turned = 2 * (phi_d + phi)
    s = np.sqrt(s2)
    columns = {
        "cartesian": (sin, zero, cos, x, y, z),
        "reciprocal": (sin, zero, cos, s * np.cos(2 * phi_d), s * np.sin(2 * phi_d), z),
        "multiscale": (sin, root, log, c2, s2phi, z),
        "elevations": (wi[:, 2] * wo[:, 2], root, log, c2, (wi[:, 2] + wo[:, 2]) / 2, z),
        "nonreciprocal": (wi[:, 2], root, log, c2, wo[:, 2], z),
        "merl": (bend, root, log, c2, s2phi, z),
        "anisotropic": (root**1.5 * np.cos(phi), root**1.5 * np.sin(phi), log,
                        s2 * np.cos(turned), s2 * np.sin(turned), z)}
    return np.stack(columns[encoding], axis=1)


def evaluate(network, wi, wo):
    """f at the directions, N x 3; 0 below the horizon."""
    encoding, activation, layers = network
    wi, wo = np.asarray(wi, np.float64), np.asarray(wo, np.float64)
    x = encode(encoding, wi, wo)
    for n, (w, b) in enumerate(layers, 1):
        x = x @ w.T + b
        if n < len(layers):
            x = np.tanh(x) if activation == "tanh" else np.maximum(x, 0)
    f = np.clip(np.expm1(np.minimum(x, 60)), 0, 1e12)
    f = np.where(((wi[:, 2] > 0) & (wo[:, 2] > 0))[:, None], f, 0)
    return np.repeat(f, 3 // f.shape[1], axis=1)
