"""Exchange at open boundaries, when lists are made: fluid enters from buffers and leaves into them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import warp as wp
from warpsph_kernels.exchange import BLOCK, EVENTS, REMOVED_BEHIND, RETURNED, make_exchange_kernels

from warpsph.particles.launch import Pass
from warpsph.particles.neighbours import NeighbourSearch, Reordered
from warpsph.particles.state import HostTable, host_view
from warpsph.physics.assembly import Assembly
from warpsph.physics.open_boundary import OpenBoundaryModel
from warpsph.sampling.patches import EDGE_MARGIN


class ExchangeModel:
    """The passes of the exchange.

    counts: (patches, EVENTS) particles that have entered the domain, left it into the buffer, left the buffer at its
    far end, and returned too far into it; births: particles that have been made.

    Args:
        followers: all arrays that follow the order of the fluid.
    """

    def __init__(
        self,
        assembly: Assembly,
        search: NeighbourSearch,
        model: OpenBoundaryModel,
        followers: Sequence[Reordered],
        spacing: float,
    ) -> None:
        self._assembly, self._fluid, self._model = assembly, search.tables[0], model
        self.counts = np.zeros((len(model.patches), EVENTS), dtype=np.int64)
        self.births = 0
        self.next_id = int(host_view(assembly.state.id).max(initial=-1)) + 1
        device, places = assembly.launcher.device, assembly.layout.first_image
        self._event = wp.full(places, -1, dtype=wp.int32, device=device)
        self._parent = wp.zeros(places, dtype=wp.int32, device=device)
        blocks = max(-(-places // BLOCK), 1)
        self._events = wp.zeros((blocks, EVENTS * len(model.patches)), dtype=wp.int32, device=device)
        self._numbers_array = wp.zeros(2, dtype=wp.int32, device=device)
        self._next_id_array = wp.zeros(1, dtype=wp.int64, device=device)
        self._numbers, self._next_id = HostTable(self._numbers_array), HostTable(self._next_id_array)
        self._most = model.stations
        self._bind(search, followers, spacing)

    @property
    def places(self) -> int:
        """Places for fluid particles."""
        return self._assembly.layout.first_image

    @property
    def is_short_of_places(self) -> bool:
        """Whether two layers of particles at all patches would not fit any more; one exchange makes at most one."""
        return self.places - self._fluid.count < 2 * self._model.stations

    @property
    def removed(self) -> int:
        """Particles that have left buffers at their far ends, or returned too far into one."""
        return int(self.counts[:, [REMOVED_BEHIND, RETURNED]].sum())

    def save(self) -> dict[str, Any]:
        """What a checkpoint has to know beside arrays."""
        return {"next_id": self.next_id, "births": self.births, "exchanged": self.counts.copy()}

    def load(self, saved: Mapping[str, Any]) -> None:
        """Go on from what `save` returned."""
        self.next_id, self.births = int(saved["next_id"]), int(saved["births"])
        self.counts = np.array(saved["exchanged"], dtype=np.int64)

    def run(self) -> None:
        """Tag and untag the particles at patches, and make those that take the places of particles that have entered.

        The positions of the next lists have been taken. Particles at the far end are removed in the sort.
        """
        count = self._fluid.count
        if count == 0:
            return
        self._classify.run(count)
        flag, ends = self._model.flag, self._model.ends
        wp.utils.array_scan(flag[:count], ends[:count], inclusive=True)
        born = int(ends[count - 1 : count].numpy()[0])
        self._set_numbers(count, born)
        self._count_events.run(self._events.shape[0])
        self.counts += host_view(self._events).sum(axis=0, dtype=np.int64).reshape(self.counts.shape)
        if born:
            self._make(count, born)

    def mark_removed(self) -> None:
        """Mark the particles that leave, before the fluid is sorted."""
        self._mark.run(self._fluid.count)

    def _make(self, count: int, born: int) -> None:
        if count + born > self.places:
            raise RuntimeError(f"{born} particles enter at once where {self.places - count} places are left")
        self._most = max(self._most, born)
        self._gather.run(count)
        for copy in self._copies:
            copy.run(self._most)
        self._bear.run(self._most)
        self._fluid.count = count + born
        self.births += born
        self.next_id += born

    def _set_numbers(self, count: int, born: int) -> None:
        self._numbers.values[:] = count, born
        self._next_id.values[0] = self.next_id
        self._numbers.send()
        self._next_id.send()

    def _bind(self, search: NeighbourSearch, followers: Sequence[Reordered], spacing: float) -> None:
        a, model, bind = self._assembly, self._model, self._assembly.launcher.bind
        kernels, state, patches = make_exchange_kernels(a.options), a.state, model.device_patches
        margin = a.options.arithmetic.real(EDGE_MARGIN * spacing)
        self._classify = bind(
            "exchange",
            kernels.classify,
            a.constants,
            patches,
            margin,
            model.imposed,
            search.listed_position,
            model.tag,
            self._event,
            model.flag,
        )
        self._count_events = bind(
            "exchange", kernels.count_events, self._numbers_array, self._event, self._events
        )
        self._gather = bind("exchange", kernels.gather_flagged, model.flag, model.ends, self._parent)
        self._copies: list[Pass] = [
            bind("exchange", kernels.copy_words, self._numbers_array, self._parent, follower.words)
            for follower in followers
        ]
        self._bear = bind(
            "exchange",
            kernels.bear,
            self._numbers_array,
            self._next_id_array,
            patches,
            self._parent,
            self._event,
            model.tag,
            state.id,
            state.position,
            search.listed_position,
        )
        self._mark = bind("exchange", kernels.mark_removed, self._event, self._fluid.key)
