"""Yardsticks of the machine: its memory bandwidth, and the SPH sum that one writes first in Warp."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import warp as wp
from warpsph_kernels.plain_sum import PlainConstants, plain_sum

from warpsph.frame import Frame, SetFrame
from warpsph.laws.smoothing import SMOOTHING_LAWS
from warpsph.scene.schema import Scene

COPIED = 64 * 2**20
"""Bytes that are copied to measure the bandwidth: more than a cache holds."""
LONGEST_SAMPLE = 20_000
"""Particles over which the plain sum is taken, of those that move."""


class PlainSum:
    """One force evaluation as the obvious Warp program makes it: `hash_grid_query` on one thread of the CPU.

    It finds the acceleration and the density rate of moving particles from all particles within the support, with the
    solver's default terms (`warpsph_kernels.plain_sum`). Particles lie in the order of the solver, which sorts them by
    cell; making the grid is not counted.

    Args:
        frame: particles with velocity, density and pressure where their sets have them.
        sound_speed: c0 [m/s].
    """

    def __init__(self, scene: Scene, frame: Frame, sound_speed: float) -> None:
        moving = (*frame.of_kind("fluid"), *frame.of_kind("structure"))
        sets = (*moving, *frame.of_kind("boundary"))
        rest_density = _rest_density(scene)
        self.count = min(sum(s.count for s in moving), LONGEST_SAMPLE)
        self._position = _padded([s.fields["position"] for s in sets])
        self._velocity = _padded([_field(s, "velocity", np.zeros_like(s.fields["position"])) for s in sets])
        self._density = _joined([_field(s, "density", np.full(s.count, rest_density)) for s in sets])
        self._pressure = _joined([_field(s, "pressure", np.zeros(s.count)) for s in sets])
        self._constants = _constants(scene, rest_density, sound_speed)
        total = len(self._density)
        self.acceleration = wp.zeros(total, dtype=wp.vec3, device="cpu")
        self.density_rate = wp.zeros(total, dtype=float, device="cpu")
        self.neighbours = wp.zeros(total, dtype=int, device="cpu")
        self._grid = wp.HashGrid(128, 128, 1 if scene.dimension == 2 else 128, device="cpu")
        self._grid.build(self._position, self._constants.radius)

    def run(self) -> float:
        """Take the sum once; return the seconds."""
        start = time.perf_counter()
        wp.launch(
            plain_sum,
            dim=self.count,
            inputs=[self._grid.id, self._constants, self._position, self._velocity, self._density],
            outputs=[self._pressure, self.acceleration, self.density_rate, self.neighbours],
            device="cpu",
        )
        return time.perf_counter() - start

    @property
    def mean_neighbours(self) -> float:
        """Neighbours within the support, over the particles of the sum."""
        return float(self.neighbours.numpy()[: self.count].mean())


def memory_bandwidth(device: str, threads: int, repeats: int = 5) -> float:
    """Bytes read and written a second by a copy: the best of a few, on all threads of a CPU together or on a GPU."""
    copy = _copy_on_cpu(threads) if wp.get_device(device).is_cpu else _copy_on_gpu(device)
    return 2.0 * COPIED / min(copy() for _ in range(repeats))


def _copy_on_cpu(threads: int) -> Callable[[], float]:
    source, target = np.ones(COPIED // 8), np.zeros(COPIED // 8)
    pairs = list(zip(np.array_split(source, threads), np.array_split(target, threads), strict=True))
    pool = ThreadPoolExecutor(threads)

    def copy() -> float:
        start = time.perf_counter()
        list(pool.map(lambda pair: np.copyto(pair[1], pair[0]), pairs))
        return time.perf_counter() - start

    return copy


def _copy_on_gpu(device: str) -> Callable[[], float]:
    source = wp.zeros(COPIED // 8, dtype=wp.float64, device=device)
    target = wp.zeros_like(source)

    def copy() -> float:
        wp.synchronize_device(device)
        start = time.perf_counter()
        wp.copy(target, source)
        wp.synchronize_device(device)
        return time.perf_counter() - start

    return copy


def _constants(scene: Scene, rest_density: float, sound_speed: float) -> PlainConstants:
    numerics, dim = scene.numerics, scene.dimension
    ratio = numerics.h_over_dp if scene.fluids else numerics.structure.h_over_dp
    c, h = PlainConstants(), ratio * scene.spacing
    c.radius, c.smoothing_length = numerics.support_over_h * h, h
    c.slope_norm = SMOOTHING_LAWS["wendland_c2"].alpha[dim] / h ** (dim + 2)
    c.mass, c.rest_density, c.sound_speed = rest_density * scene.spacing**dim, rest_density, sound_speed
    c.alpha = getattr(numerics.viscosity, "alpha", 0.0)
    c.delta = getattr(numerics.density_diffusion, "delta", 0.0)
    c.gravity = wp.vec3(*scene.gravity, *[0.0] * (3 - dim))
    return c


def _rest_density(scene: Scene) -> float:
    if scene.fluids:
        return next(iter(scene.fluids.values())).density
    return next(iter(scene.structures.values())).material.density


def _field(particles: SetFrame, name: str, instead: np.ndarray) -> np.ndarray:
    return np.asarray(particles.fields.get(name, instead))


def _padded(vectors: Sequence[np.ndarray]) -> wp.array:
    joined = np.concatenate(vectors)
    missing = np.zeros((len(joined), 3 - joined.shape[1]))
    return wp.array(np.hstack([joined, missing]).astype(np.float32), dtype=wp.vec3, device="cpu")


def _joined(values: Sequence[np.ndarray]) -> wp.array:
    return wp.array(np.concatenate(values).astype(np.float32), dtype=float, device="cpu")
