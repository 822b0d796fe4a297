"""Frames of a run, read back from its USD stage."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from pxr import Tf, Usd, UsdGeom

from warpsph.rendering.errors import RenderError

USD_FILE = "particles.usdc"

_TYPICAL_FRAMES = 24


@dataclass(frozen=True)
class RenderedSet:
    """One set at one time: position (n, 3) [m], diameter [m], value to colour by, (n,) or none, and velocity (n, 3)
    [m/s] where it was asked for."""

    name: str
    kind: str
    position: np.ndarray
    diameter: float
    value: np.ndarray | None
    velocity: np.ndarray | None = None


@dataclass(frozen=True)
class RenderedFrame:
    """All sets at one time [s]."""

    time: float
    sets: tuple[RenderedSet, ...]

    def of_kind(self, *kinds: str) -> tuple[RenderedSet, ...]:
        """Sets of these kinds that have particles."""
        return tuple(s for s in self.sets if s.kind in kinds and len(s.position))


class ParticleCache:
    """A USD stage of `UsdGeom.Points`, one prim a particle set.

    The prim's custom data `kind` says what the set is: fluid, boundary or structure. Particles that are
    nowhere, as after a run that diverged, are left out.
    """

    def __init__(self, path: Path) -> None:
        """Open a stage, or the one in a run directory. Raises RenderError if there are no particles."""
        self.path = path / USD_FILE if path.is_dir() else path
        self._stage = open_stage(self.path)
        self._sets = [UsdGeom.Points(prim) for prim in self._stage.Traverse() if prim.IsA(UsdGeom.Points)]
        self.codes = sorted({code for s in self._sets for code in s.GetPointsAttr().GetTimeSamples()})
        if not self.codes:
            raise RenderError(f"{self.path}: there are no frames of particles in it")

    @property
    def frame_rate(self) -> float:
        """Frames a simulated second [1/s]."""
        return float(self._stage.GetTimeCodesPerSecond())

    @property
    def up_axis(self) -> int:
        """1 for y, 2 for z."""
        return 2 if UsdGeom.GetStageUpAxis(self._stage) == UsdGeom.Tokens.z else 1

    @cached_property
    def is_plane(self) -> bool:
        """Whether everything lies at z = 0, as in two dimensions."""
        return all(not np.any(self._array(s.GetPointsAttr(), self.codes[0])[:, 2]) for s in self._sets)

    @property
    def fields(self) -> tuple[str, ...]:
        """Fields by which particles can be coloured."""
        primvars = {p.GetPrimvarName() for s in self._sets for p in UsdGeom.PrimvarsAPI(s).GetPrimvars()}
        return ("velocity", *sorted(primvars - {"displayColor", "displayOpacity"}))

    def unit(self, field: str) -> str:
        """Unit of a field as the stage states it; empty where it does not."""
        units = (self._attribute(s, field).GetCustomDataByKey("unit") for s in self._sets)
        return next((unit for unit in units if unit), "")

    def typical_frames(self) -> list[int]:
        """Indices of a few frames, spread over the run, the first and the last among them."""
        spread = np.linspace(0, len(self.codes) - 1, _TYPICAL_FRAMES)
        return [int(index) for index in np.unique(spread.round())]

    def frame(self, index: int, field: str, *, velocities: bool = False) -> RenderedFrame:
        """Frame number `index` (of `codes`) with a field to colour by; a vector or tensor field gives its magnitude."""
        code = self.codes[index]
        sets = tuple(self._set(s, code, field, velocities) for s in self._sets)
        return RenderedFrame(code / self.frame_rate, sets)

    def _set(self, points: UsdGeom.Points, code: float, field: str, velocities: bool) -> RenderedSet:
        widths = self._array(points.GetWidthsAttr(), code)
        position = self._array(points.GetPointsAttr(), code).reshape(-1, 3).astype(np.float64)
        value = self._values(points, code, field)
        velocity = self._array(points.GetVelocitiesAttr(), code) if velocities else None
        sound = np.isfinite(position).all(axis=1)
        if value is not None:
            sound &= np.isfinite(value)
        return RenderedSet(
            name=points.GetPrim().GetName(),
            kind=points.GetPrim().GetCustomDataByKey("kind") or "fluid",
            position=position[sound],
            diameter=float(widths[0]) if len(widths) else 0.0,
            value=None if value is None else value[sound],
            velocity=velocity[sound] if velocity is not None and len(velocity) else None,
        )

    def _values(self, points: UsdGeom.Points, code: float, field: str) -> np.ndarray | None:
        attribute = self._attribute(points, field)
        if not attribute or not attribute.HasValue():
            return None
        values = self._array(attribute, code).astype(np.float64)
        return np.sqrt(np.sum(values**2, axis=tuple(range(1, values.ndim)))) if values.ndim > 1 else values

    @staticmethod
    def _attribute(points: UsdGeom.Points, field: str) -> Usd.Attribute:
        if field == "velocity":
            return points.GetVelocitiesAttr()
        return UsdGeom.PrimvarsAPI(points).GetPrimvar(field).GetAttr()

    @staticmethod
    def _array(attribute: Usd.Attribute, code: float) -> np.ndarray:
        value = attribute.Get(code)
        return np.zeros((0, 3)) if value is None else np.asarray(value)


def open_stage(path: Path) -> Usd.Stage:
    """A stage to read. Raises RenderError."""
    if not path.is_file():
        allowed = f"a run directory that holds {USD_FILE}, or a USD file"
        raise RenderError(f"{path}: there is no such file; give {allowed}")
    try:
        return Usd.Stage.Open(str(path))
    except Tf.ErrorException as error:
        raise RenderError(f"{path}: this is no USD stage that can be read") from error
