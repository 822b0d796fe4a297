"""Where chosen particles of the fluid have been."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from warpsph.frame import Frame
from warpsph.scene.recordings import Paths as PathsSpec


class PathRecorder:
    """Follows the particles that were nearest to the seeds, from the sample at which they were chosen on."""

    needs: Mapping[str, tuple[str, ...]] = {"fluid": ("id", "position")}
    """Fields that a frame must carry, by kind of set."""

    def __init__(self, spec: PathsSpec) -> None:
        self._spec = spec
        self._seeds = np.array(spec.seeds)
        self._times: list[float] = []
        self._ids = np.empty(0, dtype=np.int64)
        self._places: list[np.ndarray] = []
        self._releases = 0

    def note(self, frame: Frame) -> None:
        """Choose particles, if it is time to, and note where those chosen so far are."""
        fluids = frame.of_kind("fluid")
        ids = np.concatenate([s.fields["id"] for s in fluids])
        position = np.concatenate([s.fields["position"] for s in fluids])
        due = self._next_release()
        if due is not None and frame.time >= due * (1.0 - 1e-9) and len(ids):
            self._choose(ids, position)
        if len(self._ids):
            self._times.append(frame.time)
            self._places.append(_places_of(self._ids, ids, position))

    @property
    def ids(self) -> np.ndarray:
        """Numbers of the particles (m,), in the order of their choice."""
        return self._ids

    @property
    def times(self) -> np.ndarray:
        """Times of the samples (n,) [s]."""
        return np.array(self._times)

    @property
    def positions(self) -> np.ndarray:
        """Positions (n, m, dimension) [m]; NaN before a particle was chosen and after it left."""
        shape = (len(self._places), len(self._ids), self._seeds.shape[1])
        positions = np.full(shape, np.nan)
        for sample, places in enumerate(self._places):
            positions[sample, : len(places)] = places
        return positions

    def save(self) -> dict[str, Any]:
        """What a run needs to go on."""
        return {
            "times": self.times,
            "ids": self._ids,
            "positions": self.positions,
            "releases": self._releases,
        }

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned."""
        self._times, self._ids = list(map(float, saved["times"])), np.array(saved["ids"])
        self._places, self._releases = list(np.array(saved["positions"])), int(saved["releases"])

    def _next_release(self) -> float | None:
        """Time of the next choice [s]."""
        if self._releases == 0:
            return self._spec.at
        return None if self._spec.every is None else self._spec.at + self._releases * self._spec.every

    def _choose(self, ids: np.ndarray, position: np.ndarray) -> None:
        distance = np.linalg.norm(position - self._seeds[:, None], axis=2)
        nearest = ids[distance.argmin(axis=1)]
        new = nearest[~np.isin(nearest, self._ids)]
        self._ids = np.concatenate([self._ids, new[np.sort(np.unique(new, return_index=True)[1])]])
        self._releases += 1


def _places_of(wanted: np.ndarray, ids: np.ndarray, position: np.ndarray) -> np.ndarray:
    """Positions (m, dimension) of the wanted particles, NaN of those that are not there."""
    order = np.argsort(ids)
    place = np.minimum(np.searchsorted(ids, wanted, sorter=order), len(ids) - 1)
    found = order[place]
    return np.where((ids[found] == wanted)[:, None], position[found], np.nan)
