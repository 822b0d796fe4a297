"""Whether triangles close to a surface with an inside, and which way they face."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components

from warpsph.geometry.errors import GeometryError
from warpsph.geometry.winding import signed_volume, winding_number

_REMEDY = (
    "a closed surface: join vertices and fill the holes in a modelling program (in Blender: Mesh, Merge by Distance; "
    "Mesh, Clean Up, Fill Holes) and export again"
)


@dataclass(frozen=True)
class _Edges:
    """The edges of a mesh: of each one its two ends (k, 2); of each side of a face its edge and way along it."""

    ends: np.ndarray
    edge: np.ndarray
    way: np.ndarray

    @classmethod
    def of(cls, faces: np.ndarray) -> _Edges:
        """Edges of faces (m, 3); edge and way have the shape (m, 3)."""
        sides = np.stack([faces, np.roll(faces, -1, axis=1)], axis=2)
        ends, edge = np.unique(np.sort(sides, axis=2).reshape(-1, 2), axis=0, return_inverse=True)
        way = np.where(sides[:, :, 0] < sides[:, :, 1], 1, -1)
        return cls(ends, edge.reshape(faces.shape), way)

    @property
    def count(self) -> np.ndarray:
        """Faces (k,) at each edge."""
        return np.bincount(self.edge.ravel(), minlength=len(self.ends))

    @property
    def is_balanced(self) -> bool:
        """Whether each edge is run along as often in one way as in the other."""
        return not np.bincount(self.edge.ravel(), weights=self.way.ravel()).any()


def refuse_open(vertices: np.ndarray, faces: np.ndarray) -> None:
    """Raise GeometryError where an edge has an odd number of faces: the surface has a hole or a loose sheet there."""
    edges = _Edges.of(faces)
    open_edges = edges.ends[edges.count % 2 == 1]
    if len(open_edges) == 0:
        return
    holes = len(np.unique(components(open_edges, len(vertices))[open_edges[:, 0]]))
    first = " to ".join(_at(vertices[end]) for end in open_edges[0])
    raise GeometryError(
        f"the surface is open along {len(open_edges)} of its {len(edges.ends)} edges, in {holes} "
        f"{'place' if holes == 1 else 'places'}, the first from {first} in the units of the file; needed is {_REMEDY}"
    )


def consistently_wound(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """The faces (m, 3), some of them reversed so that neighbours agree on which side is outside.

    A face as it is and reversed are two nodes of a graph in which those that agree across an edge are joined; each
    of its components is one of the two ways to wind a shell.
    """
    edges, m = _Edges.of(faces), len(faces)
    if edges.is_balanced:
        return faces
    order = np.argsort(edges.edge.ravel(), kind="stable")
    order = order[(edges.count == 2)[edges.edge.ravel()[order]]].reshape(-1, 2)
    first, second = order.T // 3
    alike = edges.way.ravel()[order].sum(axis=1) != 0
    pairs = np.stack([[first, second + m * alike], [first + m, second + m * ~alike]], axis=1)
    component = components(pairs.reshape(2, -1).T, 2 * m)
    as_is, reversed_ = component[:m], component[m:]
    result = np.where((as_is <= reversed_)[:, None], faces, faces[:, ::-1])
    if (as_is == reversed_).any() or not _Edges.of(result).is_balanced:
        place = _at(vertices[faces[np.argmax(as_is == reversed_), 0]])
        raise GeometryError(
            f"the triangles cannot agree on which side is outside, such as at {place} in the units of the file; needed "
            "is a surface without sheets that end on others (in Blender: Mesh, Clean Up, Delete Loose; Normals, "
            "Recalculate Outside)"
        )
    return result


def turned_outwards(vertices: np.ndarray, faces: np.ndarray) -> np.ndarray:
    """The faces (m, 3) of closed shells, turned so that volumes are positive.

    The whole surface is turned where its volume is negative; after that each shell that faces inwards although it lies
    in no other. Those within others bound cavities.
    """
    if signed_volume(vertices[faces]) < 0.0:
        faces = faces[:, ::-1]
    shell = components(np.concatenate([faces[:, :2], faces[:, 1:]]), len(vertices))[faces[:, 0]]
    result = faces.copy()
    for label in np.unique(shell):
        own = shell == label
        corners = vertices[faces]
        if signed_volume(corners[own]) < 0.0 and not round(winding_number(corners[~own], corners[own][0, 0])):
            result[own] = faces[own][:, ::-1]
    return result


def components(pairs: np.ndarray, count: int) -> np.ndarray:
    """The component (count,) of each node of a graph with the edges `pairs` (n, 2)."""
    graph = coo_matrix((np.ones(len(pairs), dtype=bool), tuple(pairs.T)), shape=(count, count))
    return np.asarray(connected_components(graph, directed=False)[1])


def _at(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{x:.6g}" for x in point) + ")"
