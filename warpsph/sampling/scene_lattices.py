"""Which lattice each set of a scene lies on.

All sets whose faces have the same directions share one lattice, so that they fit together where they touch.
Its cells begin at a face of the first tank, else of the first fluid, else of the first other boundary; along
a periodic axis they begin at the period's lower end. A shape with curved or oblique faces uses the lattice
along the axes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from warpsph.sampling.axes import face_axes, same_axes
from warpsph.sampling.lattice import Lattice
from warpsph.sampling.walls import period_of
from warpsph.scene.bounds import bounding_box
from warpsph.scene.schema import Scene
from warpsph.scene.shapes import Shape


def lattices_of(scene: Scene) -> Mapping[str, Lattice]:
    """The lattice of every fluid and boundary, by its name."""
    shapes = _shapes_by_rank(scene)
    axes = {name: _lattice_axes(shape, scene.dimension) for name, shape in shapes.items()}
    frames = _distinct([np.eye(scene.dimension), *axes.values()])
    lattices = []
    for frame in frames:
        members = [shape for name, shape in shapes.items() if same_axes(axes[name], frame)]
        lattices.append(Lattice(scene.spacing, _origin(members, frame), frame))
    for axis, (low, _) in period_of(scene).items():
        lattices[0].origin[axis] = low
    return {name: next(one for one in lattices if same_axes(axes[name], one.rotation)) for name in shapes}


def _shapes_by_rank(scene: Scene) -> Mapping[str, Shape]:
    """All shapes by the name of their set: tanks first, then fluids, structures, and other boundaries."""
    boundaries = scene.boundaries.items()
    return {
        **{name: boundary.shape for name, boundary in boundaries if boundary.side == "outside"},
        **{name: fluid.shape for name, fluid in scene.fluids.items()},
        **{name: structure.shape for name, structure in scene.structures.items()},
        **{name: boundary.shape for name, boundary in boundaries if boundary.side != "outside"},
    }


def _lattice_axes(shape: Shape, dimension: int) -> np.ndarray:
    axes = face_axes(shape, dimension)
    return np.eye(dimension) if axes is None else axes


def _distinct(axes: Sequence[np.ndarray]) -> list[np.ndarray]:
    distinct: list[np.ndarray] = []
    for candidate in axes:
        if not any(same_axes(candidate, known) for known in distinct):
            distinct.append(candidate)
    return distinct


def _origin(shapes: Sequence[Shape], frame: np.ndarray) -> np.ndarray:
    """First finite end [m] of the shapes along each column of the frame, lower before upper; else zero."""
    ends = [end for shape in shapes for end in bounding_box(shape, frame)]
    return np.array([next((end[k] for end in ends if np.isfinite(end[k])), 0.0) for k in range(len(frame))])
