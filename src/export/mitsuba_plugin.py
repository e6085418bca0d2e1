"""A BSDF for Mitsuba 3, "pbnbrdf": a neural BRDF that pbnbrdf fitted to a material.

    import mitsuba
    mitsuba.set_variant("llvm_ad_rgb")      # or scalar_rgb, cuda_ad_rgb, llvm_ad_spectral, ..._mono
    import gold                             # this file: registers the plugin for that variant
    bsdf = mitsuba.load_dict({"type": "pbnbrdf"})

Parameters, all optional:
    filename   a .safetensors file of pbnbrdf instead of the one beside this file
    proposal   the tables that directions are drawn with, instead of those beside this file; with those of another
               material the image is still correct, but may be noisier

mitsuba.traverse() gives the weights as "weights", one array, layer by layer, for each unit those of its inputs and
its bias. They are differentiable, so that a fit can be refined by a renderer. Until they are changed they are constants
of the compiled kernels, which is faster.

The material reflects on the side of the normal only: wrap it in "twosided" for both sides. eval() includes the
cosine, as in all of Mitsuba. In spectral modes the colours become spectra that are seen as the same colours under D65.
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
PROPOSAL = os.fsdecode(@proposal@)


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
        tensors[name] = (entry["shape"], list(values))
    return metadata, tensors


def polynomial(x, coefficients):
    """coefficients[0] + coefficients[1] x + ..."""
    total = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        total = dr.fma(total, x, coefficient)
    return total


def tanh(x):
    """Error below 4e-7; cheaper than dr.tanh."""
    x = dr.clip(x, -@tanh_most@, @tanh_most@)
    x2 = x * x
    return x * polynomial(x2, @tanh_numerator@) / polynomial(x2, @tanh_denominator@)


def expm1(x):
    """exp(x) - 1 for x >= 0; by its series where digits would be lost."""
    series = x * polynomial(x, [1.0, 1.0 / 2.0, 1.0 / 6.0, 1.0 / 24.0, 1.0 / 120.0, 1.0 / 720.0])
    return dr.select(x < 0.25, series, dr.exp(x) - 1.0)


def reflectance(z):
    return @reflectance@


@encoders@
# The function of each encoding, and whether it makes networks isotropic.
ENCODINGS = {@encodings@}
ACTIVATIONS = {@activations@}


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
        self.units = []  # of each layer
        weights = []
        while f"fc{len(self.units) + 1}.weight" in tensors:
            name = f"fc{len(self.units) + 1}"
            (rows, columns), values = tensors[name + ".weight"]
            self.units.append(rows)
            for row, bias in enumerate(tensors[name + ".bias"][1]):
                weights += values[row * columns:(row + 1) * columns] + [bias]
        self.constants = weights  # None where `weights` are to be asked
        self.weights = None if mi.Float is float else mi.Float(weights)

    def weight(self, number):
        if self.constants:
            return self.constants[number]
        return dr.gather(mi.Float, self.weights, mi.UInt32(number))

    def unit(self, x, first):
        """Of the weights from `first` on."""
        total = self.weight(first + len(x))
        for n, value in enumerate(x):
            total = dr.fma(value, self.weight(first + n), total)
        return total

    def __call__(self, wi, wo):
        """Linear RGB in 1/sr. wi to the light, wo to the viewer, both above the horizon."""
        x = self.encode(wi, wo)
        first = 0
        for layer, units in enumerate(self.units):
            size = len(x) + 1
            y = [self.unit(x, first + n * size) for n in range(units)]
            first += units * size
            x = y if layer + 1 == len(self.units) else [self.activate(value) for value in y]
        values = [reflectance(z) for z in x]
        return mi.Color3f(*(values if len(values) == 3 else 3 * values))


def look_up(table, index):
    """table[index]; a table is a list in scalar variants."""
    return table[index] if isinstance(table, list) else dr.gather(mi.Float, table, index)


def to_table(values):
    return list(values) if mi.Float is float else mi.Float(values)


def aliases(cells):
    """For cells drawn with all alike: the probability with which each stays, else it is the other one (Vose 1991)."""
    total = sum(cells)
    left = [cell * len(cells) / total for cell in cells]
    stays, others = [1.0] * len(cells), list(range(len(cells)))
    less = [k for k, value in enumerate(left) if value < 1.0]
    more = [k for k, value in enumerate(left) if value >= 1.0]
    while less and more:
        poor, rich = less.pop(), more[-1]
        stays[poor], others[poor] = left[poor], rich
        left[rich] -= 1.0 - left[poor]
        if left[rich] < 1.0:
            less.append(more.pop())
    return stays, others


class Proposal:
    """Draws directions in proportion to what the material reflects: from a cosine, and from tables of half vectors
    for some incident directions, between which it interpolates. The cells of a table are rings of equal size in
    log(1 + (1 - cos_h) / spread), and sectors of phi_h: from the plane of incidence on, the same on both sides, or, of
    anisotropic materials, all around.
    """

    def __init__(self, path):
        tensors = read_safetensors(path)[1]
        (self.azimuths, self.cosines, self.rings, self.sectors), cells = tensors["cells"]
        self.spread, = tensors["spread"][1]
        self.log = dr.log(1.0 + 1.0 / self.spread)
        self.cells, self.cosine_share = to_table(cells), to_table(tensors["cosine_share"][1])
        self.size = self.rings * self.sectors  # of a table
        stays, others = [], []
        for first in range(0, len(cells), self.size):
            for table, more in zip((stays, others), aliases(cells[first:first + self.size])):
                table += more
        self.stays, self.others = to_table(stays), to_table(others)

    def incident_around(self, wi):
        """The incident directions of the tables around wi: their numbers, their shares, whose sum is 1, and whether
        both directions are to be turned by pi about the normal."""
        position = dr.clip(wi.z * self.cosines - 1.0, 0.0, self.cosines - 1.0)
        low = dr.minimum(mi.UInt32(position), self.cosines - 2)
        high_share = position - mi.Float(low)
        rows = [(mi.UInt32(0), mi.Float(1.0), mi.Bool(False))]
        if self.azimuths > 1:
            turns = dr.atan2(wi.y, wi.x) / dr.pi
            place = (turns + 2.0) * self.azimuths - 0.5  # turning by 2 pi keeps it above 0
            first = mi.UInt32(place)
            share = place - mi.Float(first)
            rows = [(azimuth % self.azimuths, row_share, (azimuth // self.azimuths) % 2 == 1)
                    for azimuth, row_share in ((first, 1.0 - share), (first + 1, share))]
        for azimuth, share, is_turned in rows:
            number = azimuth * self.cosines + low
            yield number, share * (1.0 - high_share), is_turned
            yield number + 1, share * high_share, is_turned

    def axis(self, wi):
        """The x axis of the tables' frame: the plane of incidence, or that of the material."""
        if self.azimuths > 1:
            return mi.Float(1.0), mi.Float(0.0)
        length2 = wi.x * wi.x + wi.y * wi.y
        scale = dr.rsqrt(dr.maximum(length2, 1e-20))
        is_tilted = length2 > 1e-20
        return dr.select(is_tilted, wi.x * scale, 1.0), dr.select(is_tilted, wi.y * scale, 0.0)

    def pdf(self, wi, wo):
        half = dr.normalize(wi + wo)
        depth = (half.x * half.x + half.y * half.y) / (1.0 + half.z)  # 1 - cos_h
        ring = mi.UInt32(dr.log(1.0 + depth / self.spread) * (self.rings / self.log))
        x, y = self.axis(wi)
        phi = dr.atan2(x * half.y - y * half.x, x * half.x + y * half.y)
        if self.azimuths > 1:
            turn = dr.select(phi < 0.0, phi + 2.0 * dr.pi, phi) / (2.0 * dr.pi)
        else:
            turn = dr.abs(phi) / dr.pi
        sector = dr.minimum(mi.UInt32(turn * self.sectors), self.sectors - 1)
        ring = dr.minimum(ring, self.rings - 1)

        cosine, cell = mi.Float(0.0), mi.Float(0.0)
        for number, share, is_turned in self.incident_around(wi):
            turned = dr.select(is_turned, (sector + self.sectors // 2) % self.sectors, sector)
            cosine_share = look_up(self.cosine_share, number)
            index = (number * self.rings + ring) * self.sectors + turned
            cosine += share * cosine_share
            cell += share * (1.0 - cosine_share) * look_up(self.cells, index)
        per_half_vector = cell * (self.size / (2.0 * dr.pi * self.log))
        return (cosine * wo.z / dr.pi
                + per_half_vector / ((self.spread + depth) * 4.0 * dr.dot(wi, half)))

    def sample(self, wi, sample1, sample2):
        """wo; below the horizon if the facet drawn reflects to there."""
        number, is_turned = mi.UInt32(0), mi.Bool(False)
        below, chosen_below, chosen_share = mi.Float(0.0), mi.Float(0.0), mi.Float(0.0)
        for incident, share, turned in self.incident_around(wi):
            chosen = (sample1 >= below) & (share > 0.0)
            number = dr.select(chosen, incident, number)
            is_turned = dr.select(chosen, turned, is_turned)
            chosen_below = dr.select(chosen, below, chosen_below)
            chosen_share = dr.select(chosen, share, chosen_share)
            below = below + share
        # What the choice leaves of sample1 is uniform again.
        is_cosine = sample1 - chosen_below < chosen_share * look_up(self.cosine_share, number)

        inside = sample2.x * self.size
        cell = dr.minimum(mi.UInt32(inside), self.size - 1)
        inside -= mi.Float(cell)
        share = look_up(self.stays, number * self.size + cell)
        other = mi.UInt32(look_up(self.others, number * self.size + cell))
        stays = inside < share
        cell = dr.select(stays, cell, other)
        inside = (dr.select(stays, inside, inside - share)
                  / dr.maximum(dr.select(stays, share, 1.0 - share), 1e-20))
        is_other_side = is_turned
        sectors_turn = 2.0 * dr.pi
        if self.azimuths == 1:
            sectors_turn = dr.pi
            is_other_side = inside < 0.5
            inside = dr.select(is_other_side, 2.0 * inside, 2.0 * inside - 1.0)
        ring, sector = cell // self.sectors, cell % self.sectors

        u = (mi.Float(ring) + sample2.y) / self.rings
        depth = dr.minimum(self.spread * (dr.exp(u * self.log) - 1.0), 1.0)
        sine = dr.sqrt(depth * (2.0 - depth))
        sin_phi, cos_phi = dr.sincos((mi.Float(sector) + inside) * (sectors_turn / self.sectors))
        sign = dr.select(is_other_side, -1.0, 1.0)
        sin_phi = sin_phi * sign
        if self.azimuths > 1:
            cos_phi = cos_phi * sign
        x, y = self.axis(wi)
        half = mi.Vector3f(sine * (x * cos_phi - y * sin_phi), sine * (y * cos_phi + x * sin_phi),
                           1.0 - depth)
        return dr.select(is_cosine, mi.warp.square_to_cosine_hemisphere(sample2),
                      mi.reflect(wi, half))


# Spectra that are seen as red, green and blue under D65, at wavelengths from @first_wavelength@ nm on in steps of
# @wavelength_step@ nm.
PRIMARIES = @primaries@


def spectrum_at(color, wavelength, tables):
    place = dr.clip((wavelength - @first_wavelength@) / @wavelength_step@, 0.0,
                    len(PRIMARIES[0]) - 1.001)
    first = mi.UInt32(place)
    fraction = place - mi.Float(first)
    total = mi.Float(0.0)
    for channel, table in enumerate(tables):
        total += color[channel] * dr.lerp(look_up(table, first), look_up(table, first + 1), fraction)
    return dr.maximum(total, 0.0)


class NeuralBSDF(mi.BSDF):
    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        if mi.is_polarized:
            raise RuntimeError("pbnbrdf: use a variant that isn't polarized")
        self.path = self.file(props, "filename", NETWORK)
        self.network = Network(self.path)
        self.proposal = Proposal(self.file(props, "proposal", PROPOSAL))
        self.primaries = [to_table(values) for values in PRIMARIES]
        # The material is one component.
        flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide
        if not self.network.is_isotropic:
            flags |= mi.BSDFFlags.Anisotropic
        self.m_components = [flags]
        self.m_flags = flags

    @staticmethod
    def file(props, name, beside):
        if props.has_property(name):
            return str(mi.file_resolver().resolve(props[name]))
        return os.path.join(os.path.dirname(os.path.abspath(__file__)), beside)

    def traverse(self, callback):
        if self.network.weights is not None:
            callback.put("weights", self.network.weights, mi.ParamFlags.Differentiable)

    def parameters_changed(self, keys):
        self.network.constants = None

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
        elif mi.is_spectral:
            value = mi.Spectrum([spectrum_at(value, wavelength, self.primaries)
                                 for wavelength in si.wavelengths])
        return dr.select(self.is_active(ctx, si, wo, active), value, 0.0)

    def pdf(self, ctx, si, wo, active=True):
        return dr.select(self.is_active(ctx, si, wo, active), self.proposal.pdf(si.wi, wo), 0.0)

    def eval_pdf(self, ctx, si, wo, active=True):
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

    def sample(self, ctx, si, sample1, sample2, active=True):
        wo = self.proposal.sample(si.wi, sample1, sample2)
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
        return f"NeuralBSDF[{self.path}]"


mi.register_bsdf("pbnbrdf", lambda props: NeuralBSDF(props))
