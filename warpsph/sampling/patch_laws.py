"""What open boundaries prescribe at their stations over time."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
from scipy.interpolate import LinearNDInterpolator, NearestNDInterpolator

from warpsph.sampling.buffer_points import flow_of_columns
from warpsph.sampling.patches import Patch, patches_of
from warpsph.sampling.time_laws import smooth_ramp
from warpsph.scene.errors import Problem, SceneError
from warpsph.scene.expressions import evaluate, free_variables
from warpsph.scene.open_boundaries import (
    ExpressionVelocity,
    HistoryTable,
    OpenBoundary,
    ParabolicVelocity,
    TableVelocity,
    UniformVelocity,
)
from warpsph.scene.schema import Scene
from warpsph.scene.tables import TableError, read_columns
from warpsph.scene.types import AXES

_SPEED_SAMPLES = 256
_GOLDEN_RATIO = 0.5 * (np.sqrt(5.0) - 1.0)

Values = Callable[[float], np.ndarray]
"""Values (s, k) at the stations of a patch at a time [s]."""


class PatchLaw:
    """What a patch of a scene prescribes at its stations.

    Raises SceneError where a file cannot be used, or an expression is not finite at time zero.
    """

    def __init__(self, scene: Scene, patch: Patch) -> None:
        boundary, base_directory = scene.open_boundaries[patch.name], scene.base_directory
        key = f"open_boundaries.{patch.name}"
        self._scene, self._key, self._patch = scene, key, patch
        self._shape = (len(patch.stations), len(patch.center) + 1)
        self._places = patch.points(patch.stations)
        self._factor = _factor(boundary, key, base_directory)
        self._values: Values | None = None
        self.changes = False
        """Whether the values depend on the time."""
        if boundary.type == "velocity":
            self._values = self._velocity(boundary.velocity, base_directory)
        elif boundary.type == "pressure" and boundary.pressure is not None:
            self._values = self._pressure(boundary.pressure)
        self.changes = self.changes or self._factor is not None
        self.prescribes_velocity = boundary.type == "velocity"
        self(0.0)

    def __call__(self, time: float) -> np.ndarray:
        """Velocity and pressure (s, dimension + 1) [m/s, Pa] at the stations at a time [s]; zero if not prescribed."""
        out = np.zeros(self._shape)
        if self._values is None:
            return out
        values = self._values(time) * (1.0 if self._factor is None else self._factor(time))
        if self.prescribes_velocity:
            out[:, :-1] = values
        else:
            out[:, -1:] = values
        return out

    def _velocity(self, profile: object, base_directory: Path) -> Values:
        match profile:
            case UniformVelocity(speed=speed):
                return self._along_normal(np.full(self._shape[0], speed))
            case ParabolicVelocity():
                return self._along_normal(self._parabola(profile))
            case TableVelocity():
                return self._along_normal(self._tabulated(profile, base_directory))
            case ExpressionVelocity(value=components):
                return self._formulas(components, f"{self._key}.velocity.value")
        raise TypeError(f"no velocity is defined for {type(profile).__name__}")

    def _pressure(self, pressure: float | str) -> Values:
        if isinstance(pressure, str):
            return self._formulas((pressure,), f"{self._key}.pressure")
        return lambda time: np.full((self._shape[0], 1), pressure)

    def _along_normal(self, speed: np.ndarray) -> Values:
        velocity = np.outer(speed, self._patch.axes[:, 0])
        return lambda time: velocity

    def _parabola(self, profile: ParabolicVelocity) -> np.ndarray:
        """Speeds (s,) [m/s] of a parabola over the patch.

        Columns of particles sample it at their middles, which over n columns brings 1 / (2 n^2) more than its integral:
        it is scaled so that they bring the flow rate that is asked for.
        """
        patch = self._patch
        mean = profile.mean if profile.mean is not None else float(profile.flow_rate or 0.0) / patch.area
        part = patch.stations / patch.half
        if patch.is_disc:
            speed = 2.0 * mean * (1.0 - np.sum(part**2, axis=1))
        else:
            speed = mean * np.prod(1.5 * (1.0 - part**2), axis=1)
        brought = 0.0 if patch.has_level else flow_of_columns(self._scene, patch, speed)
        return speed if brought == 0.0 else speed * (mean * patch.area / brought)

    def _tabulated(self, profile: TableVelocity, base_directory: Path) -> np.ndarray:
        names = [*AXES[: len(self._patch.center)], profile.speed]
        *places, speed = _read(
            base_directory / profile.file, names, f"{self._key}.velocity.file", profile.file
        )
        across = self._patch.coordinates(np.column_stack(places))[:, 1:]
        stations = self._patch.stations
        if across.shape[1] == 1:
            order = np.argsort(across[:, 0])
            return np.interp(stations[:, 0], across[order, 0], speed[order])
        inside = LinearNDInterpolator(across, speed)(stations)
        return np.where(np.isnan(inside), NearestNDInterpolator(across, speed)(stations), inside)

    def _formulas(self, components: tuple[float | str, ...], key: str) -> Values:
        """Formulas at the stations; those off the patch take the values of their stand-ins."""
        places = self._places[self._patch.stand_ins]
        of_time = any(isinstance(c, str) and "t" in free_variables(c) for c in components)
        self.changes = self.changes or of_time

        def values(time: float) -> np.ndarray:
            variables = dict(zip(AXES, places.T, strict=False)) | {"t": time}
            columns = [
                evaluate(c, variables) if isinstance(c, str) else np.full(len(places), c) for c in components
            ]
            found = np.column_stack(columns)
            if not np.isfinite(found).all():
                message = f"it is not a finite number everywhere on the patch at t = {time:g} s"
                raise SceneError([Problem.at(key, message, "finite values", list(components))])
            return found

        if of_time:
            return values
        constant = values(0.0)
        return lambda time: constant


def patch_laws(scene: Scene) -> list[PatchLaw]:
    """What the patches of a scene prescribe, in its order."""
    return [PatchLaw(scene, patch) for patch in patches_of(scene)]


def expected_inflow(scene: Scene) -> float:
    """Largest speed [m/s] that open boundaries prescribe or that their pressures let expect, sqrt(2 p / rho).

    Times are spread by the golden ratio, so that no periodic history can hide between them.
    """
    density = next(iter(scene.fluids.values())).density if scene.fluids else 1.0
    fastest, pressures = 0.0, [0.0]
    times = scene.time.end * (np.arange(_SPEED_SAMPLES) * _GOLDEN_RATIO % 1.0)
    for law in patch_laws(scene):
        for time in times if law.changes else times[:1]:
            values = law(float(time))
            fastest = max(fastest, float(np.linalg.norm(values[:, :-1], axis=1).max()))
            pressures += [float(values[:, -1].min()), float(values[:, -1].max())]
    return fastest + float(np.sqrt(2.0 * (max(pressures) - min(pressures)) / density))


def _factor(boundary: OpenBoundary, key: str, base_directory: Path) -> Callable[[float], float] | None:
    """History times ramp as a function of time [s]; None where nothing changes over time."""
    history, ramp = getattr(boundary, "history", None), getattr(boundary, "ramp", 0.0)
    if history is None and ramp == 0.0:
        return None
    course = _course(history, key, base_directory)
    return lambda time: course(time) * smooth_ramp(time, ramp)[0]


def _course(history: str | HistoryTable | None, key: str, base_directory: Path) -> Callable[[float], float]:
    if history is None:
        return lambda time: 1.0
    if isinstance(history, str):
        return lambda time: float(evaluate(history, {"t": np.float64(time)}))
    time, value = _read(
        base_directory / history.file, [history.time, history.value], f"{key}.history.file", history.file
    )
    if history.repeat:
        return lambda at: float(np.interp(time[0] + (at - time[0]) % (time[-1] - time[0]), time, value))
    return lambda at: float(np.interp(at, time, value))


def _read(path: Path, names: list[str], key: str, file: str) -> tuple[np.ndarray, ...]:
    try:
        return read_columns(path, names)
    except TableError as error:
        allowed = f"a CSV file with the columns {', '.join(names)}"
        raise SceneError([Problem.at(key, str(error), allowed, file)]) from error
