"""Layers of wall particles that follow a curved or oblique surface, also of combined shapes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from warpsph.sampling.distance import signed_distance
from warpsph.sampling.layers import Layering, surface_layers
from warpsph.sampling.packing import CLOSEST, filled, thinned
from warpsph.sampling.pieces import Piece, pieces_of
from warpsph.scene.shapes import Mesh, Shape

_AGREES = 0.1


def has_layers(shape: Shape) -> bool:
    """Whether there are layers that follow all surfaces of a shape: those of meshes have none."""
    return not isinstance(shape, Mesh) and all(has_layers(part) for _, part in shape.parts())


def body_fitted_layers(shape: Shape, layering: Layering) -> np.ndarray:
    """Points (n, dimension) [m] in layers half a spacing, one and a half ... from the surface."""
    dimension = len(layering.anchor)
    pieces = list(pieces_of(shape, Piece(shape, 1.0, np.eye(dimension), np.zeros(dimension), False)))
    if len(pieces) == 1:
        return _piece_layers(pieces[0], layering)
    points = [_governed(shape, piece, _piece_layers(piece, layering), layering) for piece in pieces]
    return _joined(shape, pieces, np.concatenate(points), layering)


def _piece_layers(piece: Piece, layering: Layering) -> np.ndarray:
    local = replace(
        layering,
        spacing=layering.spacing / piece.scale,
        outward=layering.outward != piece.cut_out,
        anchor=piece.to_local(layering.anchor),
        limits=None if layering.limits is None else _local_limits(piece, layering.limits),
    )
    return piece.to_world(surface_layers(piece.primitive, local))


def _local_limits(piece: Piece, limits: tuple[np.ndarray, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Limits in a piece's coordinates that enclose the given ones."""
    corners = np.stack(np.meshgrid(*np.transpose(limits), indexing="ij"), axis=-1).reshape(-1, len(limits[0]))
    local = piece.to_local(corners)
    return local.min(axis=0), local.max(axis=0)


def _governed(shape: Shape, piece: Piece, points: np.ndarray, layering: Layering) -> np.ndarray:
    """The points of a piece's layers where the combined surface is this piece's."""
    difference = signed_distance(shape, points) - piece.signed_distance(points)
    return points[np.abs(difference) < _AGREES * layering.spacing]


def _joined(shape: Shape, pieces: list[Piece], points: np.ndarray, layering: Layering) -> np.ndarray:
    """Layers of several pieces, evened out along the lines where their surfaces meet."""
    spacing, side = layering.spacing, 1.0 if layering.outward else -1.0
    margin = _AGREES * spacing

    def between_layers(points: np.ndarray) -> np.ndarray:
        behind = side * signed_distance(shape, points)
        return (behind > 0.5 * spacing - margin) & (behind < layering.thickness - 0.5 * spacing + margin)

    order = np.argsort(np.abs(signed_distance(shape, points)).round(12), kind="stable")
    points = thinned(points[order], CLOSEST * spacing)
    reach = layering.thickness + spacing
    surfaces_near = sum((np.abs(piece.signed_distance(points)) < reach).astype(int) for piece in pieces)
    return filled(points, spacing, between_layers, near=surfaces_near > 1)
