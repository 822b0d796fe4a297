"""Solids from mesh files."""

from __future__ import annotations

from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import Field, PrivateAttr, ValidationInfo, field_validator

from warpsph.geometry.mesh import TriangleMesh
from warpsph.scene.errors import Problem
from warpsph.scene.file_shapes import FileShape, Stamp, directory_of, stamp_of
from warpsph.scene.types import FileName
from warpsph.scene.units import LengthUnit, in_metres


class Mesh(FileShape):
    """The inside of a closed surface of triangles from an STL, OBJ, PLY or USD file; three dimensions only.

    Shells within others that face inwards bound cavities; shells that overlap count as one solid. Particles follow the
    surface with `placement: relaxed`, of the fluid as of what it meets there.
    """

    type: Literal["mesh"] = "mesh"
    unit: Literal["auto"] | LengthUnit = "auto"
    """Length of one unit of the file: km, m, dm, cm, mm, um, ft, in, or a number [m]; auto: metersPerUnit of a USD
    stage, the metre for all other files. Default: auto."""
    up: Literal["y", "z"] | None = None
    """Axis of the scene that the up axis of a USD stage becomes; null: z. Only for USD. Default: null."""
    prim: Annotated[str, Field(pattern="^/")] | None = None
    """Path of the prim below which the meshes of a USD stage are taken; null: all. Only for USD. Default: null."""
    file: FileName
    """File of the surface: .stl, .obj, .ply, .usd, .usda, .usdc or .usdz; it must be closed."""

    _surface: TriangleMesh = PrivateAttr()

    @field_validator("file")
    @classmethod
    def _bounds_a_solid(cls, file: str, info: ValidationInfo) -> str:
        given = {key: info.data[key] for key in ("unit", "up", "prim") if key in info.data}
        if len(given) == 3:  # else one of them has been refused
            _surface_of(directory_of(info.context) / file, **given)
        return file

    def model_post_init(self, context: Any, /) -> None:
        super().model_post_init(context)
        self._surface = _surface_of(self._directory / self.file, self.unit, self.up, self.prim)

    @property
    def surface(self) -> TriangleMesh:
        """The surface, in metres."""
        return self._surface

    def dimension_problems(self, dimension: int) -> Iterator[Problem]:
        return self._exists_only_in(3, dimension, "a polygon, which may come from a file,")


def _surface_of(
    path: Path, unit: Literal["auto"] | LengthUnit, up: str | None, prim: str | None
) -> TriangleMesh:
    """The closed surface of a file [m]. Raises GeometryError."""
    return _read(path, stamp_of(path), unit, up, prim)


@lru_cache(maxsize=16)
def _read(
    path: Path, stamp: Stamp | None, unit: Literal["auto"] | LengthUnit, up: str | None, prim: str | None
) -> TriangleMesh:
    """The same; a file that has not changed is read once, however many shapes name it."""
    # The readers take a good part of a second to import, and few scenes need them.
    from warpsph.geometry.mesh_files import read_mesh

    mesh, own_unit = read_mesh(path, prim, up)
    return mesh.scaled(own_unit if unit == "auto" else in_metres(unit))
