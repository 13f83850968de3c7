"""Fits a sphere to a scene by gradients of torch: the gradient of a distance is the direction from the closest point.

    pip install ./bindings/python torch
    python bindings/python/recipes/torch_distance.py

On an NVIDIA card, with p2m built with the feature `cuda`, neither points nor answers leave the card. Elsewhere the same
code runs on the processor. The tests of the package run this script where torch is installed.
"""

from __future__ import annotations

from typing import Any

import torch
from scene import CARRIED
from torch.autograd.function import once_differentiable

import p2m


class Distance(torch.autograd.Function):
    """The distances of points from a scene, for an index on the device of the points."""

    @staticmethod
    def forward(ctx: Any, points: torch.Tensor, index: Any) -> torch.Tensor:
        here = points.detach().contiguous()
        answer = index.closest(here, fields=("distance", "point"))
        distance, closest = (torch.as_tensor(array, device=points.device) for array in answer)
        ctx.save_for_backward(here, distance, closest)
        return distance.to(points.dtype)

    @staticmethod
    @once_differentiable
    def backward(ctx: Any, gradient: torch.Tensor) -> tuple[torch.Tensor, None]:
        points, distance, closest = ctx.saved_tensors
        # On the surface a distance has no gradient; zero is one of its subgradients.
        direction = (points - closest) / torch.where(distance > 0.0, distance, 1.0)[..., None]
        return gradient[..., None] * direction.to(gradient.dtype), None


def main() -> None:
    index: Any = p2m.Index(p2m.read(CARRIED))
    device = "cpu"
    if torch.cuda.is_available():
        device, index = "cuda:0", index.to("cuda")
    generator = torch.Generator().manual_seed(1)
    directions = torch.nn.functional.normalize(torch.randn(2_000, 3, generator=generator, dtype=torch.float64))
    directions = directions.to(device)

    # The gradient is that of finite differences.
    points = (3.0 * directions[:100]).requires_grad_()
    assert torch.autograd.gradcheck(lambda points: Distance.apply(points, index), points, atol=1e-4)

    # The radius at which the mean square of distances is smallest.
    radius = torch.tensor(5.0, dtype=torch.float64, device=device, requires_grad=True)
    optimizer = torch.optim.Adam([radius], lr=0.1)
    losses = []
    for _ in range(100):
        optimizer.zero_grad()
        loss = (Distance.apply(radius * directions, index) ** 2).mean()
        loss.backward()
        optimizer.step()
        losses.append(loss.item())
    assert losses[-1] < 0.5 * losses[0]
    print(f"on {device}: mean square {losses[0]:.3f} at radius 5, {losses[-1]:.3f} at radius {radius.item():.3f}")


if __name__ == "__main__":
    main()
