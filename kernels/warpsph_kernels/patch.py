"""Patches of open boundaries as device code sees them."""

from functools import cache
from typing import Any

import warp as wp

from warpsph_kernels.options import FluidOptions

FULL = 1.0e30
"""Height of the water level where none is given [m]: all places lie below it."""


@cache
def make_patch_struct(options: FluidOptions) -> Any:
    """Return the struct of a patch.

    In run coordinates [m]: center, normal and two directions across it (the second zero in 2D), half lengths across (of
    a disc the radius), length of the buffer, `back` from the interface to the far end; numbers and cell edges of its
    stations, and the first of them; reference pressure [Pa], relaxation [1], averaging time [s]; where a water level is
    given, the direction up (else zero) and the height of the level over the center (else FULL).
    """
    arithmetic = options.arithmetic
    real, vector = arithmetic.real, arithmetic.vector
    pair = wp.types.vector(2, real)
    counts = wp.types.vector(2, wp.int32)

    class OpenPatch:
        pass

    OpenPatch.__annotations__ = {
        "center": vector,
        "normal": vector,
        "first": vector,
        "second": vector,
        "half": pair,
        "length": real,
        "back": arithmetic.point,
        "cell": pair,
        "counts": counts,
        "first_station": wp.int32,
        "is_disc": wp.int32,
        "kind": wp.int32,
        "pressure": real,
        "relaxation": real,
        "averaging_time": real,
        "area": real,
        "up": vector,
        "level": real,
    }
    return wp.struct(OpenPatch)


@cache
def make_across(options: FluidOptions) -> Any:
    """Return the device function `across(patch, away) -> pair`: coordinates across a patch of a way from its center."""
    vector = options.arithmetic.vector
    pair = wp.types.vector(2, options.arithmetic.real)
    patch_type = make_patch_struct(options)

    def across(patch: patch_type, away: vector):
        s = pair()
        s[0] = wp.dot(away, patch.first)
        s[1] = wp.dot(away, patch.second)
        return s

    return wp.func(across)


@cache
def make_below_level(options: FluidOptions) -> Any:
    """Return the device function `below_level(patch, away) -> real`: depth [m] below the water level of a patch of a
    place that lies `away` from its center."""
    patch_type, vector = make_patch_struct(options), options.arithmetic.vector

    def below_level(patch: patch_type, away: vector):
        return patch.level - wp.dot(away, patch.up)

    return wp.func(below_level)


@cache
def make_on_patch(options: FluidOptions) -> Any:
    """Return the device function `on_patch(patch, s, margin) -> bool`: whether coordinates across lie on the patch or
    within `margin` [m] of it."""
    real = options.arithmetic.real
    pair = wp.types.vector(2, real)
    patch_type = make_patch_struct(options)

    def on_patch(patch: patch_type, s: pair, margin: real):
        inside = wp.abs(s[0]) <= patch.half[0] + margin and wp.abs(s[1]) <= patch.half[1] + margin
        if patch.is_disc > 0:
            inside = wp.length(s) <= patch.half[0] + margin
        return inside

    return wp.func(on_patch)


@cache
def make_nearest_station(options: FluidOptions) -> Any:
    """Return the device function `nearest_station(patch, s) -> int`: the station nearest to coordinates across."""
    dim, real = options.arithmetic.dimension, options.arithmetic.real
    pair, counts_type = wp.types.vector(2, real), wp.types.vector(2, wp.int32)
    patch_type = make_patch_struct(options)

    def nearest_station(patch: patch_type, s: pair):
        at = counts_type()
        for k in range(wp.static(dim - 1)):
            cell = int(wp.floor((s[k] + patch.half[k]) / patch.cell[k]))
            at[k] = wp.clamp(cell, 0, patch.counts[k] - 1)
        return patch.first_station + at[0] * patch.counts[1] + at[1]

    return wp.func(nearest_station)
