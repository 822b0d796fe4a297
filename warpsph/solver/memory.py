"""What a scene will take in memory, and whether the device has it: found before anything is allocated.

A fluid or wall particle has its state and scratch (`particles.state`), a place in the order of its cells, and a row of
neighbours. Rows are all of one length: a quarter more than the neighbours of a lattice within the search radius, and
longer where a particle turns out to have more. That bounds the lists: four bytes a place.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import warp as wp

from warpsph.particles.neighbours import first_capacity
from warpsph.sampling import SampledSet
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.schema import Scene

STRUCTURE_BYTES = {2: 500, 3: 1000}
"""Of a particle of a structure with its bonds, by dimension, at the default support."""


def refuse_what_does_not_fit(scene: Scene, sets: Sequence[SampledSet], device: wp.Device) -> None:
    """Raise SceneError if the particles of a scene need more memory than a device has left."""
    needed, free = estimated_bytes(scene, sets), free_memory(device)
    if free is None or needed <= free:
        return
    particles = sum(len(s.position) for s in sets)
    coarser = scene.spacing * (needed / free) ** (1.0 / scene.dimension)
    left = f"{device}, which has {free / 1e9:.3g} GB left"
    raise SceneError(
        [
            Problem.at(
                "spacing",
                f"{particles} particles need about {needed / 1e9:.3g} GB on {left}",
                f"about {coarser:.2g} m or more, or fewer particles",
                scene.spacing,
            )
        ]
    )


def estimated_bytes(scene: Scene, sets: Sequence[SampledSet]) -> float:
    """Bytes of all particles, their order and their neighbour lists."""
    structures = sum(len(s.position) for s in sets if s.kind == "structure")
    others = sum(len(s.position) for s in sets) - structures
    of_structures = structures * STRUCTURE_BYTES[scene.dimension]
    return others * fluid_particle_bytes(scene) + of_structures


def fluid_particle_bytes(scene: Scene) -> float:
    """Bytes of a fluid or wall particle with its row of neighbours, in what every fluid scene needs."""
    dim, real = scene.dimension, 4 if scene.numerics.precision == "single" else 8
    points, records, vectors, numbers = 2, 3, 2, 2  # position and its scratch; see `particles.state`
    own = points * 8 * dim + records * (dim + 1) * real + vectors * dim * real + numbers * real + 12
    order, cells = 4 * 4, 2 * 4
    row = 4 * (first_capacity(scene.search_radius / scene.spacing, dim) + 3)
    return own + order + cells + row


def free_memory(device: wp.Device) -> float | None:
    """Bytes that a device has left: of a CPU what its system can still give; None where it does not say."""
    if device.is_cuda:
        return float(device.free_memory)
    meminfo = Path("/proc/meminfo")
    if meminfo.exists():
        for line in meminfo.read_text().splitlines():
            if line.startswith("MemAvailable:"):
                return 1024.0 * float(line.split()[1])
    names = getattr(os, "sysconf_names", {})
    if "SC_AVPHYS_PAGES" in names:
        return float(os.sysconf("SC_AVPHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    return None
