"""Exchange at open boundaries: fluid enters the domain from buffers, leaves it into them, and leaves them behind.

A particle that enters leaves its place to a new one, a buffer's length behind it, so that a column of the buffer keeps
its spacing. What is behind a patch belongs to the buffer only where the flow on the patch goes out: a particle that has
entered and is pushed or shifted back has its successor already, and a second one would follow when it came out again. A
spacing behind the patch its place is taken for good, and it is removed.
"""

from functools import cache
from typing import Any, NamedTuple

import warp as wp

from warpsph_kernels.arithmetic import make_packing, make_separation
from warpsph_kernels.cells import REMOVED
from warpsph_kernels.options import FluidOptions
from warpsph_kernels.pair_terms import make_constants_struct
from warpsph_kernels.patch import (
    make_across,
    make_below_level,
    make_nearest_station,
    make_on_patch,
    make_patch_struct,
)

ENTERED, LEFT, REMOVED_BEHIND, RETURNED = range(4)
"""What can happen to a particle at a patch when lists are made: it enters the domain, leaves it into the buffer, or
leaves the buffer at its far end, or is removed a spacing behind a patch through which fluid enters."""
EVENTS = 4
BLOCK = 256
"""Particles whose events one thread counts."""


class ExchangeKernels(NamedTuple):
    """Kernels of the exchange, in the order of their use."""

    classify: Any
    count_events: Any
    gather_flagged: Any
    copy_words: Any
    bear: Any
    mark_removed: Any
    flag_tagged: Any


@cache
def make_exchange_kernels(options: FluidOptions) -> ExchangeKernels:
    """Return the kernels of the exchange specialised for the options."""
    arithmetic = options.arithmetic
    real, vector, point = arithmetic.real, arithmetic.vector, arithmetic.point
    patch_type, constants_type = make_patch_struct(options), make_constants_struct(arithmetic)
    separation = make_separation(arithmetic, options.periodic)
    across, below_level, on_patch = make_across(options), make_below_level(options), make_on_patch(options)
    nearest_station = make_nearest_station(options)
    _, unpack = make_packing(arithmetic)
    module = options.module_of("exchange")

    @wp.kernel(module=module, enable_backward=False)
    def classify(
        offset: int,
        c: constants_type,
        patches: wp.array(dtype=patch_type),
        margin: real,
        imposed: wp.array(dtype=arithmetic.record),
        listed_position: wp.array(dtype=vector),
        tag: wp.array(dtype=wp.int32),
        event: wp.array(dtype=wp.int32),
        births: wp.array(dtype=wp.int32),
    ):
        """One fluid particle: its new tag, what happens to it (EVENTS k + event at patch k, else -1), and whether a
        particle takes its place at the far end of the buffer that it leaves inwards. `imposed`: velocity [m/s] and
        pressure on the patches. What comes over an inlet above its water level is carried back by the buffer, and has
        no successor there."""
        i = offset + wp.tid()
        x = listed_position[i]
        k = tag[i]
        happens = int(-1)
        born = int(0)
        if k >= 0:
            way = separation(x, patches[k].center, c.period)
            depth = wp.dot(way, patches[k].normal)
            if depth >= real(0.0):
                tag[i] = -1
                born = wp.where(below_level(patches[k], way) > real(0.0), 1, 0)
                happens = wp.static(EVENTS) * k + wp.static(ENTERED)
            elif depth < -patches[k].length:
                happens = wp.static(EVENTS) * k + wp.static(REMOVED_BEHIND)
        else:
            for j in range(patches.shape[0]):
                patch = patches[j]
                away = separation(x, patch.center, c.period)
                depth = wp.dot(away, patch.normal)
                behind = depth < real(0.0) and depth >= -patch.length
                s = across(patch, away)
                if happens < 0 and behind and on_patch(patch, s, margin):
                    speed = wp.dot(unpack(imposed[nearest_station(patch, s)]), patch.normal)
                    if speed < real(0.0) or below_level(patch, away) < real(0.0):
                        tag[i] = j
                        happens = wp.static(EVENTS) * j + wp.static(LEFT)
                    elif depth * c.inverse_spacing < real(-1.0):
                        happens = wp.static(EVENTS) * j + wp.static(RETURNED)
        event[i] = happens
        births[i] = born

    @wp.kernel(module=module, enable_backward=False)
    def count_events(
        offset: int,
        numbers: wp.array(dtype=wp.int32),
        event: wp.array(dtype=wp.int32),
        events: wp.array2d(dtype=wp.int32),
    ):
        """One block of particles: how often each event happens at each patch. `numbers`: particles, births."""
        block = offset + wp.tid()
        for j in range(events.shape[1]):
            events[block, j] = 0
        for i in range(wp.static(BLOCK) * block, wp.min(wp.static(BLOCK) * (block + 1), numbers[0])):
            if event[i] >= 0:
                events[block, event[i]] = events[block, event[i]] + 1

    @wp.kernel(module=module, enable_backward=False)
    def gather_flagged(
        offset: int,
        flag: wp.array(dtype=wp.int32),
        ends: wp.array(dtype=wp.int32),
        gathered: wp.array(dtype=wp.int32),
    ):
        """One particle: if it is flagged, write its index at its place among the flagged; `ends` sums the flags up."""
        i = offset + wp.tid()
        if flag[i] > 0:
            gathered[ends[i] - 1] = i

    @wp.kernel(module=module, enable_backward=False)
    def copy_words(
        offset: int,
        numbers: wp.array(dtype=wp.int32),
        parent: wp.array(dtype=wp.int32),
        words: wp.array2d(dtype=wp.uint32),
    ):
        """One new particle: all that its parent has."""
        i = offset + wp.tid()
        if i < numbers[1]:
            for k in range(words.shape[1]):
                words[numbers[0] + i, k] = words[parent[i], k]

    @wp.kernel(module=module, enable_backward=False)
    def bear(
        offset: int,
        numbers: wp.array(dtype=wp.int32),
        next_id: wp.array(dtype=wp.int64),
        patches: wp.array(dtype=patch_type),
        parent: wp.array(dtype=wp.int32),
        event: wp.array(dtype=wp.int32),
        tag: wp.array(dtype=wp.int32),
        id: wp.array(dtype=wp.int64),
        position: wp.array(dtype=point),
        listed_position: wp.array(dtype=vector),
    ):
        """One new particle: the place at the far end of the buffer, a number that no other has had, and its patch."""
        i = offset + wp.tid()
        if i < numbers[1]:
            new = numbers[0] + i
            k = event[parent[i]] // wp.static(EVENTS)
            position[new] = position[new] + patches[k].back
            listed_position[new] = listed_position[parent[i]] - patches[k].length * patches[k].normal
            id[new] = next_id[0] + wp.int64(i)
            tag[new] = k
            event[new] = -1

    @wp.kernel(module=module, enable_backward=False)
    def mark_removed(offset: int, event: wp.array(dtype=wp.int32), key: wp.array(dtype=wp.int32)):
        """One fluid particle before sorting: removed if it has left its buffer at the far end, or returned too far."""
        i = offset + wp.tid()
        if event[i] >= 0 and event[i] % wp.static(EVENTS) >= wp.static(REMOVED_BEHIND):
            key[i] = REMOVED

    @wp.kernel(module=module, enable_backward=False)
    def flag_tagged(offset: int, tag: wp.array(dtype=wp.int32), flag: wp.array(dtype=wp.int32)):
        """One fluid particle: 1 in a buffer, else 0."""
        i = offset + wp.tid()
        flag[i] = wp.where(tag[i] >= 0, 1, 0)

    return ExchangeKernels(
        classify, count_events, gather_flagged, copy_words, bear, mark_removed, flag_tagged
    )
