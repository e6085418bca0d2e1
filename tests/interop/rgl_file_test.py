"""Sources exported as RGL files in Mitsuba's own "measured" BSDF: its values against this project's reader, and the
densities of its samples by Mitsuba's chi-square test.
"""
import csv
import sys

from common import check, np, path, program, require

mi, = require("mitsuba")
import drjit as dr

SOURCES = ["builtin:satin-gold", "builtin:wall-plaster", "builtin:glossy-grey-paper", "builtin:brushed-copper",
           "builtin:rolled-brass"]


def direction(theta, phi):
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])


def own_values(file, angles):
    """f cos_o of `pbnbrdf eval`, N x 3, given theta_i, phi_i, theta_o, phi_o."""
    rows, values = path("directions.csv"), path("values.csv")
    with open(rows, "w", newline="") as out:
        writer = csv.writer(out)
        writer.writerow(["theta_i", "phi_i", "theta_o", "phi_o"])
        writer.writerows(angles.T.tolist())
    program("eval", f"--material={file}", f"--directions={rows}", f"--out={values}")
    with open(values) as lines:
        rgb = np.array([[float(row[c]) for c in "rgb"] for row in csv.DictReader(lines)])
    return rgb * np.cos(angles[2])[:, None]


def check_values(source, file, angles):
    bsdf = mi.load_dict({"type": "measured", "filename": file})
    si = dr.zeros(mi.SurfaceInteraction3f)
    si.wi = mi.Vector3f(np.ascontiguousarray(direction(angles[0], angles[1])))
    wo = mi.Vector3f(np.ascontiguousarray(direction(angles[2], angles[3])))
    values = np.array(bsdf.eval(mi.BSDFContext(), si, wo)).T.astype(np.float64)
    expected = own_values(file, angles)
    assert expected.max() > 0.1
    check(f"{source}, Mitsuba's values", np.max(np.abs(values - expected) / (0.01 + expected)), 0.01)


def check_density(source, file):
    for degrees in (5, 40, 75):
        wi = mi.Vector3f(direction(np.radians(degrees), 0.3).tolist())
        sample, pdf = mi.chi2.BSDFAdapter("measured", f'<string name="filename" value="{file}"/>', wi=wi)
        test = mi.chi2.ChiSquareTest(domain=mi.chi2.SphericalDomain(), sample_func=sample, pdf_func=pdf, sample_dim=3,
                                     res=201, ires=16, sample_count=400000)
        if not test.run(significance_level=1e-4, quiet=True):
            sys.exit(f"FAILED: {source} at {degrees} degrees: {test.messages}")
        print(f"{source}, chi-square test at {degrees} degrees: p = {test.p_value}")


rng = np.random.default_rng(1)
ANGLES = np.stack([rng.uniform(0, 1.5, 4000), rng.uniform(-np.pi, np.pi, 4000),
                   rng.uniform(0, 1.5, 4000), rng.uniform(-np.pi, np.pi, 4000)])
for material in SOURCES:
    exported = path(material.partition(":")[2] + ".bsdf")
    program("export", "--format=bsdf", f"--material={material}", f"--out={exported}")
    mi.set_variant("llvm_ad_rgb")
    check_values(material, exported, ANGLES)
    check_density(material, exported)
# A grey under a constant spectrum is as grey in a spectral variant.
SPECTRAL = path("grey_spectral.bsdf")
program("export", "--format=bsdf_spectral", "--material=builtin:glossy-grey-paper", f"--out={SPECTRAL}")
mi.set_variant("llvm_ad_spectral")
bsdf = mi.load_dict({"type": "measured", "filename": SPECTRAL})
si = dr.zeros(mi.SurfaceInteraction3f)
si.wi = mi.Vector3f(np.ascontiguousarray(direction(ANGLES[0], ANGLES[1])))
si.wavelengths = type(si.wavelengths)(430, 500, 570, 640)
values = np.array(bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(np.ascontiguousarray(direction(ANGLES[2], ANGLES[3])))))
expected = own_values(SPECTRAL, ANGLES)
check("grey, Mitsuba's spectra", np.max(np.abs(values.T - expected[:, :1]) / (0.01 + expected[:, :1])), 0.01)
