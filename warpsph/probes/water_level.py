"""Height of the free surface at a vertical gauge."""

import math
from dataclasses import dataclass

import numpy as np

from warpsph.frame import Frame
from warpsph.probes.probe import Probe
from warpsph.probes.smoothing import Smoothing, particle_volume
from warpsph.scene.probes import WaterLevelProbe as WaterLevelSpec
from warpsph.scene.schema import Scene
from warpsph.scene.types import AXES

SAMPLES_PER_SPACING = 4
SMALLEST_OPENING = 0.1
"""A place with less free space around it is inside a wall."""

NARROWEST_PASSAGE = 0.4
"""A place is closed from above if it is less open than this times the place below: less than a half, because
beside a wall that ends above the bed the free space halves, and that is no lid."""


class WaterLevelProbe(Probe):
    """Top of the column of fluid that stands on the bed below the gauge, as a coordinate along the axis.

    With phi = sum_b V_b W_b over the particles of the fluids or of walls and structures, a place is wet where the fluid
    fills half of what the walls leave free around it, phi_fluid / (1 - phi_wall) >= 1/2; so the surface is
    found right, and to a fraction of the spacing, also beside a wall. The column begins at the lowest bed on
    which fluid rests and ends where it first turns dry: drops in the air above do not count. A dry gauge
    reads the height of its lowest bed. Without walls near the gauge the column begins at the lowest wet
    place; where there is none, the level is NaN.
    """

    def __init__(self, name: str, spec: WaterLevelSpec, scene: Scene) -> None:
        solids = dict.fromkeys(("boundary", "structure"), ("position", "volume"))
        needs = {"fluid": ("position", "density", "mass"), **solids}
        super().__init__(spec.columns(name, scene.dimension), needs)
        self._axis = _vertical_axis(scene) if spec.axis == "auto" else AXES.index(spec.axis)
        self._up = -1.0 if scene.gravity[self._axis] > 0.0 else 1.0
        horizontal = (axis for axis in range(scene.dimension) if axis != self._axis)
        self._gauge = tuple(zip(horizontal, spec.at, strict=True))
        self._smoothing = Smoothing.of(scene)
        self._step = scene.spacing / SAMPLES_PER_SPACING

    def evaluate(self, frame: Frame) -> tuple[float, ...]:
        """The level [m]."""
        return (self._up * level(self._profile(frame)),)

    def _profile(self, frame: Frame) -> "Profile":
        particles = [self._near_gauge(frame, kinds) for kinds in (("fluid",), ("boundary", "structure"))]
        reach = int(self._smoothing.support_radius / self._step) + 1
        lowest = [np.floor(height / self._step).astype(np.int64) for height, _, _ in particles]
        touched = [bottom[:, None] + np.arange(-reach, reach + 2) for bottom in lowest]
        samples = np.unique(np.concatenate([t.ravel() for t in touched]))
        filling = []
        for (height, distance, volume), near in zip(particles, touched, strict=True):
            r = np.hypot(near * self._step - height[:, None], distance[:, None])
            phi = volume[:, None] * self._smoothing.weight(r)
            filling.append(
                np.bincount(np.searchsorted(samples, near).ravel(), phi.ravel(), minlength=len(samples))
            )
        return Profile(samples, self._step, filling[0], filling[1], reach)

    def _near_gauge(self, frame: Frame, kinds: tuple[str, ...]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Height against gravity, distance from the gauge's line, and volume of the particles near it."""
        parts = [(np.empty(0), np.empty(0), np.empty(0))]
        for particle_set in frame.of_kind(*kinds):
            position = particle_set.fields["position"]
            near = self._smoothing.near(position, self._gauge)
            across = [self._smoothing.separation(position[near, a], x, a) for a, x in self._gauge]
            height = self._up * np.asarray(position[near, self._axis], dtype=np.float64)
            parts.append((height, np.linalg.norm(across, axis=0), particle_volume(particle_set, near)))
        height, distance, volume = (np.concatenate(columns) for columns in zip(*parts, strict=True))
        return height, distance, volume


@dataclass(frozen=True)
class Profile:
    """Filling along the gauge's line at heights samples * step [m].

    Heights that are left out have nothing near them, and neither have those on either side of a gap.
    """

    samples: np.ndarray
    step: float
    fluid: np.ndarray
    wall: np.ndarray
    reach: int

    def opening(self, shift: int = 0) -> np.ndarray:
        """Fraction that the walls leave free around the place `shift` samples above each sample."""
        place = np.searchsorted(self.samples, self.samples + shift)
        place = np.minimum(place, len(self.samples) - 1)
        found = self.samples[place] == self.samples + shift
        return np.where(found, 1.0 - self.wall[place], 1.0)

    def wetness(self) -> np.ndarray:
        """Fraction of the free space that fluid fills; zero inside walls that close the gauge from above."""
        opening = self.opening()
        passable = opening >= np.maximum(SMALLEST_OPENING, NARROWEST_PASSAGE * self.opening(-self.reach))
        return np.where(passable, self.fluid / np.maximum(opening, SMALLEST_OPENING), 0.0)

    def beds(self) -> np.ndarray:
        """Indices of the lowest samples above each upward face of the walls: half as open as far above."""
        is_open = self.opening() >= np.maximum(SMALLEST_OPENING, 0.5 * self.opening(self.reach))
        return np.flatnonzero(is_open[1:] & ~is_open[:-1]) + 1


def level(profile: Profile) -> float:
    """Top of the lowest column of fluid that rests on a bed [m]; see `WaterLevelProbe` for the rule."""
    wetness = profile.wetness()
    wet = wetness >= 0.5
    beds = profile.beds()
    if not len(beds):
        return _top_of_column(profile, wetness, int(np.argmax(wet))) if wet.any() else math.nan
    for bed in beds:
        resting = np.flatnonzero(wet[bed : bed + SAMPLES_PER_SPACING])
        if len(resting):
            return _top_of_column(profile, wetness, int(bed + resting[0]))
    return float(profile.samples[beds[0]] * profile.step)


def _top_of_column(profile: Profile, wetness: np.ndarray, start: int) -> float:
    """Height at which the fluid above a wet sample first turns dry, by linear interpolation."""
    top = start + int(np.argmin(wetness[start:] >= 0.5)) - 1
    here, above = wetness[top], wetness[top + 1]
    return float((profile.samples[top] + (here - 0.5) / (here - above)) * profile.step)


def _vertical_axis(scene: Scene) -> int:
    return int(np.argmax(np.abs(scene.gravity)))
