"""What a scene makes run: particle sets, passes, memory and step limits."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import warp as wp

from warpsph.particles.state import UNITS, arrays_of
from warpsph.physics.fluid import smoothing_length, step_viscosity
from warpsph.scene.schema import Scene
from warpsph.solver.assemble import Parts

TYPICAL_RATE = 1.0e6
"""Particle-steps a second of two CPU cores, for a first estimate."""


def describe(scene: Scene, parts: Parts, sets: Sequence[tuple[str, str, int]]) -> dict[str, Any]:
    """Return a plain description for people and programs; sizes in bytes, times in seconds."""
    fields = _fields(parts)
    limits = _step_limits(scene, float(parts.assembly.constants.sound_speed))
    particles = sum(count for _, _, count in sets)
    steps = math.ceil(scene.time.end / min(limits.values()))
    search, lists = parts.search.bytes, parts.search.list_bytes
    total = sum(field["bytes"] for field in fields) + search + lists
    return {
        "sets": [{"name": name, "kind": kind, "particles": count} for name, kind, count in sets],
        "particles": particles,
        "passes": _passes(parts),
        "pairs": _pairs(parts),
        "fields": fields,
        "list_bytes": lists,
        "search_bytes": search,
        "bytes_per_particle": total / max(particles, 1),
        "sound_speed_m_s": float(parts.assembly.constants.sound_speed),
        "step_limits_s": limits,
        "estimated_steps": steps,
        "estimated_wall_s": steps * particles / TYPICAL_RATE,
        "fluid_places": parts.assembly.layout.first_image,
    }


def _fields(parts: Parts) -> list[dict[str, Any]]:
    shared = (*arrays_of(parts.assembly.state), *arrays_of(parts.assembly.scratch))
    of_patches = parts.open_boundaries.model.own_arrays if parts.open_boundaries else {}
    groups = (*shared, *parts.fluid.arrays.items(), *_wall_arrays(parts).items(), *of_patches.items())
    return [{"name": name, "unit": UNITS[name], "bytes": int(array.capacity)} for name, array in groups]


def _wall_arrays(parts: Parts) -> dict[str, wp.array]:
    if parts.walls is None:
        return {}
    model, motion = parts.walls.model, parts.walls.motion
    return {**model.own_arrays, **motion.own_arrays, "wall_force": model.force}


def _passes(parts: Parts) -> list[str]:
    fluid, walls = parts.fluid.passes, parts.walls.model if parts.walls else None
    passes = ["choose step", "begin step", *fluid, "survey"]
    if parts.symmetry:
        passes.insert(passes.index("accelerate"), "mirror")
        passes.insert(passes.index("kick and drift") + 1, "mirror")
    if parts.open_boundaries:
        passes[passes.index("accelerate") : passes.index("accelerate")] = parts.open_boundaries.model.passes
    if walls is None:
        return passes
    names = {"dynamic": "wall pressure", "modified_dynamic": "mirror points of walls"}
    imposed = names.get(walls.method, "extrapolate to walls")
    passes.insert(passes.index("accelerate"), imposed)
    if walls.method == "dynamic":
        passes.insert(-1, "update wall density")
    if parts.walls and parts.walls.motion.moving:
        passes.insert(1, "move walls")
    return passes


def _pairs(parts: Parts) -> list[str]:
    walls = ["fluid - wall", "wall - fluid"] if parts.walls else []
    structures = ["fluid - structure", "structure - fluid"] if parts.faces else []
    return ["fluid - fluid", *walls, *structures]


def _step_limits(scene: Scene, sound_speed: float) -> dict[str, float]:
    h, cfl = smoothing_length(scene), scene.time.cfl
    gravity = math.hypot(*scene.gravity)
    limits = {"acoustic": cfl * h / sound_speed}
    if gravity > 0.0:
        limits["force"] = cfl * math.sqrt(h / gravity)
    viscosity = step_viscosity(scene, sound_speed)
    if viscosity > 0.0:
        limits["viscous"] = 0.125 * h * h / viscosity
    if scene.time.max_step is not None:
        limits["max_step"] = scene.time.max_step
    return limits
