"""Contact within the step of structures: forces, and lists that stay complete between two looks of the host."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from warpsph.physics.contact import MEMORY
from warpsph.solver.contact_assembly import ContactParts

MARGIN = 1.5
"""Growth of the largest speed that is allowed for between two looks."""


class ContactStepper:
    """Keeps the lists complete: nothing moves farther than half the skin from where it was listed.

    Lists look at what is near: it is chosen anew before anything has moved by half the leeway.
    """

    def __init__(self, parts: ContactParts) -> None:
        self._parts = parts
        self._model = parts.model
        self._moved = 0.0
        self._strayed = 0.0

    def raised(self, square: float) -> float:
        """The largest squared frequency of structures [1/s^2] with the springs of contact at their surfaces.

        A chain of masses m and springs k_s has omega^2 = 4 k_s / m. A spring K from its end to a wall, which is what
        the spring between two chains is to each in their antisymmetric modes, does not raise that up to K = 2 k_s; a
        stiffer one adds a mode at the end, of omega^2 = K^2 / (m (K - k_s)).
        """
        end, inner = self._parts.stiffness, 0.25 * square
        return square if end <= 2.0 * inner else end**2 / (end - inner)

    @property
    def depth(self) -> float:
        """Deepest penetration at the last look [m]."""
        return self._model.depth()

    def start(self) -> None:
        """Make lists of the present state, and find its forces."""
        self._list(anew=True)
        self._model.push()

    def push(self) -> None:
        """Find the forces of contact."""
        self._model.push()

    def allow(self, speed: float, dt: float, count: int) -> int:
        """Make new lists if need be; return how many of `count` steps of `dt` [s] they will surely do for."""
        stride, far_stride = MARGIN * self._stride(speed, dt), MARGIN * self._far_stride(speed, dt)
        strays = self._strayed + far_stride * count > self._half_leeway
        if strays or self._moved + stride * count > self._half_skin:
            self._list(anew=strays)
            stride = MARGIN * self._stride(speed, dt)
            rooms = ((self._half_skin, stride), (self._half_leeway - self._strayed, far_stride))
            count = min([count, *(max(int(room / way), 1) for room, way in rooms if way > 0.0)])
        return count

    def note(self, speed: float, dt: float, count: int) -> bool:
        """Note that steps have been made, at most so fast [m/s]; return whether the lists were complete all along."""
        moved = self._moved + self._stride(speed, dt) * count
        strayed = self._strayed + self._far_stride(speed, dt) * count
        complete = (moved <= self._half_skin and strayed <= self._half_leeway) or count == 1
        if complete:
            self._moved, self._strayed = moved, strayed
        return complete

    def memory(self) -> Mapping[str, np.ndarray]:
        """What friction remembers."""
        return self._model.memory()

    def remember(self, memory: Mapping[str, np.ndarray]) -> None:
        """Take back what friction has done since `memory`. The lists reach as far back as forward."""
        self._model.remember(memory)

    def save(self) -> dict[str, Any]:
        """What brings the same lists and slips back."""
        lists = {"contact_near": self._model.near, "contact_listed": self._model.listed}
        ways = {"contact_moved": self._moved, "contact_strayed": self._strayed}
        return lists | ways | {f"contact_{name}": values for name, values in self._model.memory().items()}

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned; the state of the structures has been restored."""
        self._model.list_again(np.asarray(saved["contact_near"]), np.asarray(saved["contact_listed"]))
        self._moved, self._strayed = float(saved["contact_moved"]), float(saved["contact_strayed"])
        self._model.sense()
        self._model.remember({name: np.asarray(saved[f"contact_{name}"]) for name in MEMORY})

    @property
    def _half_skin(self) -> float:
        return 0.5 * self._model.skin

    @property
    def _half_leeway(self) -> float:
        return 0.5 * self._model.leeway

    def _stride(self, speed: float, dt: float) -> float:
        """How far something that is near may move in a step [m]."""
        return self._far_stride(speed, dt) if self._model.moving_walls_near else speed * dt

    def _far_stride(self, speed: float, dt: float) -> float:
        """How far anything may move in a step [m]."""
        return max(speed, self._parts.wall_speed) * dt

    def _list(self, anew: bool) -> None:
        if anew:
            self._model.choose_near()
            self._strayed = 0.0
        self._model.place()
        self._model.list_pairs()
        self._moved = 0.0
