"""@about@. Written by pbnbrdf: a torch.nn.Module, @name@.

    brdf = @name@()
    rgb = brdf(wi, wo)   # ... x 3 each: unit vectors, normal +z, to the light and to the viewer

Values are linear RGB in 1/sr, without the cosine; 0 where a direction isn't above the horizon. The weights are
parameters, in double precision until .float() says otherwise.
"""
import torch


def _maximum(a, b):
    return torch.clamp(a, min=b) if not torch.is_tensor(b) else torch.clamp(b, min=a) if not torch.is_tensor(a) \
        else torch.maximum(a, b)


def _minimum(a, b):
    return torch.clamp(a, max=b) if not torch.is_tensor(b) else torch.clamp(b, max=a) if not torch.is_tensor(a) \
        else torch.minimum(a, b)


def _where(condition, a, b):
    like = next(x for x in (a, b) if torch.is_tensor(x))
    return torch.where(condition, *(torch.as_tensor(x, dtype=like.dtype, device=like.device) for x in (a, b)))


def _encode(wi, wo):
    wi_x, wi_y, wi_z = wi.unbind(-1)
    wo_x, wo_y, wo_z = wo.unbind(-1)
@encode@    inputs = [torch.as_tensor(x, dtype=wi.dtype, device=wi.device) for x in (@inputs@)]
    return torch.stack(torch.broadcast_tensors(*inputs), -1)


class @name@(torch.nn.Module):
    def __init__(self):
        super().__init__()
        self.layers = torch.nn.ModuleList()
        for rows in _WEIGHTS:  # of each layer [W | b], out x (in + 1)
            values = torch.tensor(rows, dtype=torch.float64)
            layer = torch.nn.Linear(values.shape[1] - 1, values.shape[0], dtype=torch.float64)
            with torch.no_grad():
                layer.weight.copy_(values[:, :-1])
                layer.bias.copy_(values[:, -1])
            self.layers.append(layer)

    def forward(self, wi, wo):
        z = _encode(wi, wo)
        for layer in self.layers[:-1]:
            x = layer(z)
            z = @activate@
        z = self.layers[-1](z)
        lit = (wi[..., 2:] > 0) & (wo[..., 2:] > 0)
        return torch.where(lit, @reflectance@, torch.zeros_like(z))


_WEIGHTS = @weights@
