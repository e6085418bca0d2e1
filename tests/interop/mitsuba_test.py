"""Exported BSDFs in Mitsuba 3: values against the network in double precision, which
weights_test.py compares with the library, densities against samples, and a render.
"""
import importlib
import sys

from common import all_networks, check, directions, np, path, program, random_layers, require
from common import write_network
import reference

mi, = require("mitsuba")
import drjit as dr

GOLD = path("gold.safetensors")


def import_plugin(variant, name):
    """The plugin's module, registered for the variant."""
    mi.set_variant(variant)
    sys.path.insert(0, sys.argv[2])
    sys.modules.pop(name, None)
    return importlib.import_module(name)


def interaction(wi):
    si = dr.zeros(mi.SurfaceInteraction3f)
    si.wi = wi
    return si


def vectors(v):
    return mi.Vector3f(np.ascontiguousarray(v.T))


def to_numpy(value):
    """N x 3"""
    return np.array(value).T.astype(np.float64)


def check_error(what, values, expected):
    check(what, np.max(np.abs(values - expected) / (1 + expected)), 1e-4)


def check_values(name, file):
    """LLVM, at all pairs: eval, eval_pdf, and reciprocity of the network to the bit."""
    wi, wo = directions(4000)
    bsdf = mi.load_dict({"type": "pbnbrdf", "filename": file})
    # Mitsuba's wi points to the viewer, its wo to the light.
    si, context = interaction(vectors(wo)), mi.BSDFContext()
    values = to_numpy(bsdf.eval(context, si, vectors(wi)))
    expected = reference.evaluate(reference.read(file), wi, wo) * np.maximum(wi[:, 2:], 0)
    check_error(f"{name}, LLVM", values, expected)
    value, pdf = bsdf.eval_pdf(context, si, vectors(wi))
    assert np.array_equal(to_numpy(value), values)
    assert np.array_equal(np.array(pdf), np.array(bsdf.pdf(context, si, vectors(wi))))
    assert np.isfinite(np.array(pdf)).all()


def check_reciprocity(module, name, encoding, file):
    wi, wo = [vectors(v[:-4]) for v in directions(4000)]
    network = module.Network(file)
    there, back = np.array(network(wi, wo)), np.array(network(wo, wi))
    differ = np.count_nonzero(there.view(np.uint32) != back.view(np.uint32))
    if encoding in reference.NOT_RECIPROCAL:
        assert differ > 1000  # the comparison can fail
    else:
        check(f"{name}, LLVM, values that aren't reciprocal to the bit", differ, 0)


def check_scalar_values(name, file):
    """The scalar variant, at a few pairs of each kind."""
    wi, wo = [v[::200] for v in directions(4000)]
    bsdf = mi.load_dict({"type": "pbnbrdf", "filename": file})
    context = mi.BSDFContext()
    values = np.array([bsdf.eval(context, interaction(mi.Vector3f(o)), mi.Vector3f(i))
                       for i, o in zip(wi.tolist(), wo.tolist())], np.float64)
    expected = reference.evaluate(reference.read(file), wi, wo) * np.maximum(wi[:, 2:], 0)
    check_error(f"{name}, scalar", values, expected)


def adapter(parameters, degrees):
    """The plugin's functions sample and pdf as mitsuba.chi2 calls them."""
    extra = "".join(f'<string name="{key}" value="{value}"/>' for key, value in parameters.items())
    wi = mi.Vector3f(direction(degrees).tolist())
    return mi.chi2.BSDFAdapter("pbnbrdf", extra, wi=wi)


def follows(sample, pdf):
    """Whether the samples follow the density, which integrates to 1: Mitsuba's chi-square test."""
    test = mi.chi2.ChiSquareTest(domain=mi.chi2.SphericalDomain(), sample_func=sample, pdf_func=pdf,
                                 sample_dim=3, res=201, ires=16, sample_count=400000)
    passed = test.run(significance_level=1e-4, quiet=True)
    return passed, test.p_value, test.messages


def check_density(what, parameters, angles):
    for degrees in angles:
        passed, p_value, messages = follows(*adapter(parameters, degrees))
        print(f"{what}, chi-square test at {degrees} degrees: p = {p_value}")
        if not passed:
            sys.exit(f"FAILED: {what}: {messages}")


def check_that_the_test_can_fail(parameters):
    """The density of another material isn't that of the samples."""
    assert not follows(adapter({}, 30)[0], adapter(parameters, 30)[1])[0]


def albedo(network, viewer):
    """The integral of f cos over the light's directions: midpoint rule in the half vector."""
    n_theta, n_phi = 400, 200
    u = (np.arange(n_theta) + 0.5) / n_theta
    theta, phi = np.meshgrid(np.pi / 2 * u**2, 2 * np.pi * (np.arange(n_phi) + 0.5) / n_phi,
                             indexing="ij")
    cell = np.sin(theta) * np.pi * np.sqrt(theta / (np.pi / 2)) / n_theta * 2 * np.pi / n_phi
    h = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], axis=-1)
    along = h @ viewer
    light = 2 * along[..., None] * h - viewer
    solid_angle = 4 * np.maximum(along, 0) * cell * np.maximum(light[..., 2], 0)
    f = reference.evaluate(network, light.reshape(-1, 3), np.broadcast_to(viewer, (h.size // 3, 3)))
    return (f * solid_angle.reshape(-1, 1)).sum(axis=0)


def direction(degrees):
    return np.array([np.sin(np.radians(degrees)), 0, np.cos(np.radians(degrees))])


def check_samples(what, bsdf, network):
    """Weights are eval / pdf, and their mean is the albedo."""
    count = 400000
    for degrees in (10, 70):
        viewer = direction(degrees)
        expected_mean = albedo(network, viewer)
        sampler = mi.load_dict({"type": "independent"})
        sampler.seed(degrees, count)
        si, context = interaction(mi.Vector3f(viewer.tolist())), mi.BSDFContext()
        bs, weight = bsdf.sample(context, si, sampler.next_1d(), sampler.next_2d())
        value, pdf = bsdf.eval_pdf(context, si, bs.wo)
        weights, drawn = to_numpy(weight), np.array(bs.pdf) > 0
        expected = to_numpy(value)[drawn] / np.array(pdf, np.float64)[drawn, None]
        check(f"{what}, weights at {degrees} degrees", np.max(np.abs(weights[drawn] - expected)
                                                             / (1 + expected)), 1e-5)
        assert not weights[~drawn].any()
        standard_error = weights.std(axis=0) / np.sqrt(count)
        deviations = np.abs(weights.mean(axis=0) - expected_mean) / standard_error
        print(f"{what}, albedo at {degrees} degrees: {expected_mean}, deviation of one weight",
              weights.std(axis=0))
        check(f"{what}, standard errors that the mean is off", deviations.max(), 5)


def sphere_scene(integrator, samples=64):
    """A sphere in white light from everywhere."""
    return mi.load_dict({
        "type": "scene", "integrator": {"type": integrator, "max_depth": 2},
        "light": {"type": "constant", "radiance": {"type": "rgb", "value": [1.0, 1.0, 1.0]}},
        "sphere": {"type": "sphere", "bsdf": {"type": "pbnbrdf"}},
        "sensor": {"type": "perspective", "fov": 20.0,
                   "to_world": mi.ScalarTransform4f().look_at([0, 0, 8], [0, 0, 0], [0, 1, 0]),
                   "film": {"type": "hdrfilm", "width": 16, "height": 16, "pixel_format": "rgb",
                            "rfilter": {"type": "box"}},
                   "sampler": {"type": "independent", "sample_count": samples}}})


def render(variant, samples=64):
    import_plugin(variant, "gold")
    return np.array(mi.render(sphere_scene("path", samples), seed=1))


def check_render():
    """The sphere's middle, seen at up to 20 degrees or so, is as bright as the albedo there."""
    expected = albedo(reference.read(GOLD), direction(10))
    for variant in ("scalar_rgb", "llvm_ad_rgb"):
        image = render(variant)
        assert image.shape == (16, 16, 3) and np.isfinite(image).all()
        middle = image[6:10, 6:10].mean(axis=(0, 1))
        check(f"render, {variant}, middle {middle}", np.max(np.abs(middle / expected - 1)), 0.03)


def check_gradients(name, file):
    """Of a weighted sum of values with respect to some weights, against differences of the reference."""
    wi, wo = directions(500)
    bsdf = mi.load_dict({"type": "pbnbrdf", "filename": file})
    parameters = mi.traverse(bsdf)
    dr.enable_grad(parameters["weights"])
    parameters.update()
    values = bsdf.eval(mi.BSDFContext(), interaction(vectors(wo)), vectors(wi))
    check_error(f"{name}, weights that may change", to_numpy(values),
                reference.evaluate(reference.read(file), wi, wo) * np.maximum(wi[:, 2:], 0))
    dr.backward(dr.sum(dr.sum(values)))
    gradient = np.array(dr.grad(parameters["weights"]))

    encoding, activation, layers = reference.read(file)
    size, first = 1e-5, 0
    for w, b in layers:
        for unit, source in ((0, 0), (len(b) - 1, w.shape[1])):  # a weight, and a bias
            sums = []
            for change in (-size, size):
                array, at = (b, unit) if source == w.shape[1] else (w, (unit, source))
                kept = array[at]
                array[at] = kept + change
                sums.append((reference.evaluate((encoding, activation, layers), wi, wo)
                             * np.maximum(wi[:, 2:], 0)).sum())
                array[at] = kept
            difference = (sums[1] - sums[0]) / (2 * size)
            found = gradient[first + unit * (w.shape[1] + 1) + source]
            check(f"{name}, derivative {difference}", abs(found - difference) / (1 + abs(difference)),
                  1e-3)
        first += w.size + b.size


def check_gradient_of_an_image():
    """A fit can be refined by a renderer: the image's mean grows with an output's bias as differences say."""
    scene = sphere_scene("prb")
    parameters = mi.traverse(scene)
    key, = [name for name in parameters.keys() if name.endswith("weights")]
    start = np.array(parameters[key])
    step = np.zeros_like(start)
    step[-1] = 1.0  # the bias of blue

    def mean(change):
        parameters[key] = mi.Float(start + np.float32(change) * step)
        parameters.update()
        return np.array(mi.render(scene, seed=2)).mean(dtype=np.float64)

    difference = (mean(0.01) - mean(-0.01)) / 0.02
    parameters[key] = mi.Float(start)
    dr.enable_grad(parameters[key])
    parameters.update()
    dr.backward(dr.mean(mi.render(scene, parameters, seed=2), axis=None))
    found = np.array(dr.grad(parameters[key]))[-1]
    check(f"an image's derivative {difference}", abs(found / difference - 1), 0.03)


def check_modes():
    """One channel is the luminance; spectra have the colours of RGB variants."""
    import_plugin("llvm_ad_mono", "gold")
    wi, wo = directions(400)
    bsdf = mi.load_dict({"type": "pbnbrdf"})
    value = bsdf.eval(mi.BSDFContext(), interaction(vectors(wo)), vectors(wi))
    rgb = reference.evaluate(reference.read(GOLD), wi, wo) * np.maximum(wi[:, 2:], 0)
    check_error("gold, one channel", np.array(value)[0], rgb @ [0.212671, 0.715160, 0.072169])
    expected = render("llvm_ad_rgb").mean(axis=(0, 1))
    for variant in ("llvm_ad_spectral", "scalar_spectral"):
        image = render(variant, samples=1024).mean(axis=(0, 1))
        check(f"render, {variant}, {image}, in RGB {expected}", np.max(np.abs(image / expected - 1)),
              0.02)
    import_plugin("llvm_ad_spectral_polarized", "gold")
    try:
        mi.load_dict({"type": "pbnbrdf"})
        sys.exit("FAILED: a polarized variant takes the plugin")
    except RuntimeError as error:
        assert "isn't polarized" in str(error), error


def check_unknown_encoding():
    """A file that names an encoding of another version."""
    file = path("old.safetensors")
    write_network(file, random_layers([3], 1), "bilateral", "tanh")
    try:
        mi.load_dict({"type": "pbnbrdf", "filename": file})
        sys.exit("FAILED: the plugin takes an encoding that it doesn't know")
    except RuntimeError as error:
        assert "encoding=bilateral is not one of cartesian | " in str(error), error


program("fit", "--material=builtin:satin-gold", "--samples=1000", "--max_iterations=20",
        "--terms=log", f"--out={GOLD}")
program("export", f"--fit={GOLD}", "--format=mitsuba", f"--out={path('gold.py')}")
networks = list(all_networks())

plugin = import_plugin("llvm_ad_rgb", "gold")
check_values("gold", path("gold_weights.safetensors"))
for name, encoding, file in networks:
    check_values(name, file)
    check_reciprocity(plugin, name, encoding, file)
check_density("gold", {}, (0, 45, 80))
anisotropic, = [file for name, _, file in networks if name == "anisotropic_tanh"]
program("export", f"--fit={anisotropic}", "--format=mitsuba", f"--out={path('turned.py')}")
other = {"filename": anisotropic, "proposal": path("turned_proposal.safetensors")}
check_density("anisotropic", other, (0, 30, 85))
check_density("random, drawn as gold", {"filename": networks[0][2]}, (30,))
check_that_the_test_can_fail(other)
check_samples("gold", mi.load_dict({"type": "pbnbrdf"}), reference.read(GOLD))
check_gradients("gold", GOLD)
check_gradients("anisotropic", anisotropic)
check_gradient_of_an_image()

import_plugin("scalar_rgb", "gold")
check_scalar_values("gold", GOLD)
check_unknown_encoding()
for name, _, file in networks:
    check_scalar_values(name, file)
check_render()
check_modes()
