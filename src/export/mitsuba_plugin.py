"""A BSDF for Mitsuba 3, "pbnbrdf": a neural BRDF that pbnbrdf fitted to a material.

    import mitsuba
    mitsuba.set_variant("llvm_ad_rgb")      # or scalar_rgb, cuda_ad_rgb, ..._mono
    import gold                             # this file: registers the plugin for that variant
    bsdf = mitsuba.load_dict({"type": "pbnbrdf"})

Parameters, all optional:
    filename          a .safetensors file of pbnbrdf instead of the one beside this file
    alpha_u, alpha_v  roughness of the GGX lobe that directions are drawn from, along x and y, from
                      0.0001 to 1
    lobe_weight       fraction of the samples drawn from the lobe, 0 to 1; the rest is drawn with a
                      density proportional to the cosine

The defaults of the last three suit the network beside this file. For another network they are still
correct, but the image may be noisier.
The material reflects on the side of the normal only: wrap it in "twosided" for both sides. It works in
RGB and monochromatic modes. eval() includes the cosine, as in all of Mitsuba.
LLVM variants need LLVM 16 or later: LLVM 15 cannot compile an arc tangent for AVX-512.
"""
import array
import json
import os
import struct
import sys

import drjit as dr
import mitsuba as mi

NETWORK = os.fsdecode(@network@)
ALPHA_U = @alpha_u@
ALPHA_V = @alpha_v@
LOBE_WEIGHT = @lobe_weight@


def read_safetensors(path):
    """The metadata and, by name, the (shape, values) of the tensors."""
    with open(path, "rb") as file:
        data = file.read()
    if len(data) < 8:
        raise ValueError(f"{path}: not a safetensors file")
    begin = 8 + struct.unpack("<Q", data[:8])[0]
    header = json.loads(data[8:begin])
    metadata = header.pop("__metadata__", {})
    tensors = {}
    for name, entry in header.items():
        first, last = entry["data_offsets"]
        values = array.array({"F64": "d", "F32": "f"}[entry["dtype"]])
        values.frombytes(data[begin + first:begin + last])
        if sys.byteorder == "big":
            values.byteswap()
        tensors[name] = (entry["shape"], values)
    return metadata, tensors


class Network:
    """f(wi, wo) = max(0, exp(z) - 1), z the network's output at the encoded directions."""

    def __init__(self, path):
        metadata, tensors = read_safetensors(path)
        if metadata.get("format") != "pbnbrdf" or metadata.get("output") != "expm1":
            raise ValueError(f"{path}: not a network of pbnbrdf")
        if metadata["encoding"] not in ENCODINGS:
            raise ValueError(f"{path}: encoding={metadata['encoding']} is not one of "
                             + " | ".join(ENCODINGS))
        self.encode, self.is_isotropic = ENCODINGS[metadata["encoding"]]
        self.activate = ACTIVATIONS[metadata["activation"]]
        self.layers = []  # lists of (row of W, bias)
        while f"fc{len(self.layers) + 1}.weight" in tensors:
            name = f"fc{len(self.layers) + 1}"
            (rows, columns), weights = tensors[name + ".weight"]
            biases = tensors[name + ".bias"][1]
            self.layers.append([(list(weights[r * columns:(r + 1) * columns]), biases[r])
                                for r in range(rows)])

    def __call__(self, wi, wo):
        """Linear RGB in 1/sr. wi to the light, wo to the viewer, both above the horizon."""
        x = self.encode(wi, wo)
        for number, layer in enumerate(self.layers):
            y = []
            for row, bias in layer:
                total = mi.Float(bias)
                for weight, value in zip(row, x):
                    total = dr.fma(value, weight, total)
                y.append(total)
            x = y if number + 1 == len(self.layers) else [self.activate(value) for value in y]
        return mi.Color3f(*[reflectance(z) for z in x])


def expm1(x):
    """exp(x) - 1 as 2 sinh(x/2) exp(x/2): no digits are lost near 0."""
    return 2.0 * dr.sinh(0.5 * x) * dr.exp(0.5 * x)


def reflectance(z):
    return @reflectance@


@encoders@
# The function of each encoding, and whether it makes networks isotropic.
ENCODINGS = {@encodings@}
ACTIVATIONS = {@activations@}


class NeuralBSDF(mi.BSDF):
    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        if mi.is_spectral or mi.is_polarized:
            raise RuntimeError("pbnbrdf: use a variant that is RGB or monochromatic, not polarized")
        if props.has_property("filename"):
            self.path = str(mi.file_resolver().resolve(props["filename"]))
        else:
            self.path = os.path.join(os.path.dirname(os.path.abspath(__file__)), NETWORK)
        self.network = Network(self.path)
        self.alpha_u = float(props.get("alpha_u", ALPHA_U))
        self.alpha_v = float(props.get("alpha_v", ALPHA_V))
        self.lobe_weight = float(props.get("lobe_weight", LOBE_WEIGHT))
        if not all(1e-4 <= alpha <= 1.0 for alpha in (self.alpha_u, self.alpha_v)):
            raise ValueError("pbnbrdf: alpha_u and alpha_v must be 0.0001 to 1")
        if not 0.0 <= self.lobe_weight <= 1.0:
            raise ValueError("pbnbrdf: lobe_weight must be 0 to 1")
        # The lobe serves to draw directions only; the material is one component.
        flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
        if not self.network.is_isotropic:
            flags |= mi.BSDFFlags.Anisotropic
        self.m_components = [flags]
        self.m_flags = flags

    def lobe(self):
        return mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.alpha_u, self.alpha_v, True)

    def lobe_pdf(self, wi, wo):
        total = wi + wo
        half = dr.normalize(dr.select(total.z > 0.0, total, mi.Vector3f(0.0, 0.0, 1.0)))
        pdf = self.lobe().pdf(wi, half) / (4.0 * dr.dot(wi, half))
        return dr.select(total.z > 0.0, pdf, 0.0)

    def is_active(self, ctx, si, wo, active):
        enabled = ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 0)
        cos_theta = mi.Frame3f.cos_theta
        return active & enabled & (cos_theta(si.wi) > 0.0) & (cos_theta(wo) > 0.0)

    def eval(self, ctx, si, wo, active=True):
        # si.wi points to the viewer. Importance travels the other way, which only networks that
        # aren't reciprocal can tell.
        light, viewer = (wo, si.wi) if ctx.mode == mi.TransportMode.Radiance else (si.wi, wo)
        value = self.network(light, viewer) * mi.Frame3f.cos_theta(wo)
        if mi.is_monochromatic:
            value = mi.Color1f(mi.luminance(value))
        return dr.select(self.is_active(ctx, si, wo, active), value, 0.0)

    def pdf(self, ctx, si, wo, active=True):
        # Reflections that end below the horizon are turned up.
        mirrored = mi.Vector3f(wo.x, wo.y, -wo.z)
        lobe = self.lobe_pdf(si.wi, wo) + self.lobe_pdf(si.wi, mirrored)
        cosine = mi.warp.square_to_cosine_hemisphere_pdf(wo)
        mixture = self.lobe_weight * lobe + (1.0 - self.lobe_weight) * cosine
        return dr.select(self.is_active(ctx, si, wo, active), mixture, 0.0)

    def eval_pdf(self, ctx, si, wo, active=True):
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

    def sample(self, ctx, si, sample1, sample2, active=True):
        normal, _ = self.lobe().sample(si.wi, sample2)
        reflected = mi.reflect(si.wi, normal)
        reflected.z = dr.abs(reflected.z)
        wo = dr.select(sample1 < self.lobe_weight, reflected,
                       mi.warp.square_to_cosine_hemisphere(sample2))
        value, pdf = self.eval_pdf(ctx, si, wo, active)
        bs = dr.zeros(mi.BSDFSample3f)
        bs.wo = wo
        bs.pdf = pdf
        bs.eta = 1.0
        bs.sampled_type = mi.UInt32(+mi.BSDFFlags.GlossyReflection)
        bs.sampled_component = mi.UInt32(0)
        drawn = self.is_active(ctx, si, wo, active) & (pdf > 0.0)
        return bs, dr.select(drawn, value / dr.select(drawn, pdf, 1.0), 0.0)

    def to_string(self):
        return (f"NeuralBSDF[{self.path}, alpha_u={self.alpha_u}, alpha_v={self.alpha_v}, "
                f"lobe_weight={self.lobe_weight}]")


mi.register_bsdf("pbnbrdf", lambda props: NeuralBSDF(props))
