"""The stability limit of structures, measured on the very particles of a run."""

from __future__ import annotations

import numpy as np

from warpsph.particles.state import host_view, write_array
from warpsph.physics.structure import StructureModel, arrays_in

ITERATIONS = 60
RELATIVE_STRETCH = 1e-3
"""Displacement of the probing mode, in lengths of the shortest bond: in the linear range, and well above rounding."""


def largest_frequency(model: StructureModel) -> float:
    """Return the largest angular frequency [1/s] of the structures about their present state, by power iteration.

    The force of a displacement e is -M omega^2 e in its eigenmode. From a mode at random, M^-1 K is applied again and
    again, and the Rayleigh quotient of the last mode, with the masses M as weights, is returned. It approaches the
    largest frequency from below, after so many iterations to a few per cent. The clock has to stand still.
    """
    kept = {name: np.array(host_view(array)) for name, array in arrays_in(model.state).items()}
    free = host_view(model.reference.free).astype(np.float64)
    mass = _relative_mass(model)
    size = RELATIVE_STRETCH * _shortest_bond(model)
    rest = _acceleration(model, kept["displacement"])
    mode = np.random.default_rng(0).normal(size=free.shape) * free
    square = 0.0
    for _ in range(ITERATIONS):
        largest = float(np.abs(mode).max(initial=0.0))
        if largest == 0.0:
            break
        mode *= size / largest
        response = (rest - _acceleration(model, kept["displacement"] + mode)) * free
        square = float(np.sum(mass * response * mode) / np.sum(mass * mode * mode))
        mode = response
    for name, array in arrays_in(model.state).items():
        write_array(array, kept[name])
    return float(np.sqrt(max(square, 0.0))) or _free_flight(model)


def _relative_mass(model: StructureModel) -> np.ndarray:
    """Mass of each particle over the largest, shape (n, 1)."""
    density = model.reference.materials.numpy()["density"][model.reference.structure.numpy()]
    mass = density.astype(np.float64) * model.reference.volume.numpy()
    return (mass / mass.max())[:, None]


def _acceleration(model: StructureModel, displacement: np.ndarray) -> np.ndarray:
    write_array(model.state.displacement, displacement)
    model.strain()
    model.accelerate()
    return np.array(host_view(model.state.acceleration))


def _shortest_bond(model: StructureModel) -> float:
    bonds, ends = model.reference.bonds.numpy(), model.reference.ends.numpy()
    present = np.arange(bonds.shape[1]) < ends[:, 1:]
    lengths = np.linalg.norm(bonds[present][:, :-1], axis=1)
    return float(lengths.min()) if lengths.size else _cell(model)


def _cell(model: StructureModel) -> float:
    return float(model.reference.volume.numpy()[0]) ** (1.0 / model.options.arithmetic.dimension)


def _free_flight(model: StructureModel) -> float:
    """Frequency of particles without bonds: that of a wave across their own cell."""
    p = model.reference.materials.numpy()
    speed = np.sqrt((p["lame"] + 2.0 * p["shear_modulus"]) / p["density"]).max()
    return float(2.0 * speed / _cell(model))
