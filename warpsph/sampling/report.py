"""How well the particles of a scene represent its shapes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import asdict
from typing import Any

import numpy as np

from warpsph.sampling.sets import SampledSet
from warpsph.scene.bounds import bounding_box
from warpsph.scene.schema import Boundary, Fluid, Scene
from warpsph.scene.structures import Structure
from warpsph.scene.volumes import volume_of


def shape_report(scene: Scene, sets: Iterable[SampledSet]) -> list[dict[str, Any]]:
    """A record of each set: what its shape encloses and how far that reaches, and the same of its particles.

    Keys: name, kind, shape; is_filled, which walls of layers are not; volume [m3, m2 in 2D] of the shape, None where it
    has no closed form; sampled_volume of all particles; extent [m] of the shape, low and high corner, None where it has
    no end; sampled_extent of the particles' cells; evenness of relaxed particles, else None (see `Evenness`).
    """
    return [_record(scene, particles) for particles in sets]


def _record(scene: Scene, particles: SampledSet) -> dict[str, Any]:
    body = _body(scene, particles)
    half, position = 0.5 * scene.spacing, particles.position
    corners = position.min(axis=0) - half, position.max(axis=0) + half
    return {
        "name": particles.name,
        "kind": particles.kind,
        "shape": body.shape.type,
        "is_filled": not isinstance(body, Boundary) or body.side == "solid",
        "volume": volume_of(body.shape),
        "sampled_volume": len(position) * particles.volume,
        "extent": _plain(bounding_box(body.shape)),
        "sampled_extent": _plain(corners),
        "evenness": None if particles.evenness is None else asdict(particles.evenness),
    }


def _body(scene: Scene, particles: SampledSet) -> Fluid | Boundary | Structure:
    match particles.kind:
        case "fluid":
            return scene.fluids[particles.name]
        case "boundary":
            return scene.boundaries[particles.name]
        case "structure":
            return scene.structures[particles.name]


def _plain(corners: tuple[np.ndarray, np.ndarray]) -> list[list[float]] | None:
    return [corner.tolist() for corner in corners] if np.isfinite(corners).all() else None
